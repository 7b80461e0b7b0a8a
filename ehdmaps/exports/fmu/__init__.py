"""Target `fmu`: a bearing as a Functional Mock-up Unit, by the kernel in C.

| module | idea |
|---|---|
| `variables` | inputs, parameters and outputs of the unit, and what it says of itself |
| `description` | the model description of FMI 2.0 and of FMI 3.0 |
| `binaries` | compiling the sources for this machine, and for other systems by ziglang |
| `unit` | the sources, binaries and texts in one file |
| `target` | the unit of a map |

The files `*.c` and `*.h` are the unit, `motion.c` and `variables.h` what it has of cylindrical rollers alone; the
folder `headers` has those of the standard, with their licence.
"""

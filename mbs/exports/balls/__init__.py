"""Ball bearings as C sources and as Functional Mock-up Units: `mbs bearing 7208B ... -o NAME.c`, or `NAME.fmu`.

| module | idea |
|---|---|
| `speed_laws` | laws of the contacts over the speed: one table for all speeds |
| `source` | the bearing in C: templates, in which its mathematics is, and its numbers |
| `unit` | the bearing as a unit, by the kernel in C |

The files `ball_*.c` and `ball_bearing.h` are `mbs.bearings.balls` in C, with the laws of `contact_law`; those of the
folder `unit_files` make a unit of it, in place of their namesakes of `ehdmaps.exports.fmu`. Tapered rollers,
`mbs.exports.tapered`, share laws and unit.
"""

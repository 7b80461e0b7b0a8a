"""Bearings of tapered rollers, NJ and NUP as C sources and Functional Mock-up Units, as `mbs.exports.balls` are.

| module | idea |
|---|---|
| `source` | the bearing in C: templates, in which its mathematics is, and its numbers |
| `unit` | the bearing as a unit, by the kernel in C |

The files `tapered_*.c` and `tapered_bearing.h` are `mbs.bearings.tapered` in C; laws over speed and unit are those of
balls.
"""

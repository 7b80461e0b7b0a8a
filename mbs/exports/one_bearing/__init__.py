"""Bearings that carry axial load as C sources and Functional Mock-up Units: `mbs bearing 7208B ... -o NAME.c`.

| module | idea |
|---|---|
| `kind` | what differs between kinds of bearings: a row |
| `balls`, `rollers` | the rows: ball bearings; tapered rollers, NJ, NUP, NCF, NNCF |
| `speed_laws` | laws of the contacts over the speed: one table for all speeds |
| `source` | the bearing in C: templates, in which its mathematics is, and its numbers |
| `unit` | the bearing as a unit, by the kernel in C |

The files `*_bearing.c`, `*_films.c` and their headers are the bearing as callers see it, around the kernel of
`ehdmaps/kernel/c`; those of the folder `unit_files` make a unit of it, in place of their namesakes of
`ehdmaps.exports.fmu`.
"""

"""A user force of Simpack over the kernel in C: a folder of sources that the user compiles.

| module | idea |
|---|---|
| `target` | the target `simpack` |

`simpack.f90` is the user routine, `bearing_slot.c` keeps the bearings by the number of the element that asks, and
`film_history.c` says which of its calls are steps in time.
"""

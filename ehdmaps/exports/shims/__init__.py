"""User routines of Adams, RecurDyn and Simpack over the kernel in C: a folder of sources that the user compiles.

| module | idea |
|---|---|
| `target` | the targets `adams`, `recurdyn` and `simpack` |

`bearing_slot.c` is what Adams and Simpack share: bearings by the number of the element that asks.
"""

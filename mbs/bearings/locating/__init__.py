"""Bearings that carry axial load, balls or rollers with ribs: what they have in common.

| module | idea |
|---|---|
| `normal_law` | load, stiffness and damping of a contact over its approach, and of both of an element, for the kernel |
| `film_memory` | films with memory in time: springs in series with dampers beside that law |
| `film_tables` | these laws over the speed, for compiled runs |
| `locating_force` | force, stiffness and damping by the pose of the inner ring; what a kind has of its own |
| `locating_element` | the bearing of any kind in a machine, at the speed that the system has |
| `locating_point` | one bearing alone at an operating point |
| `locating_block` | such bearings in compiled runs |

What a kind has of its own, its balance, kinematics, films and findings, is in `mbs.bearings.balls` and
`mbs.bearings.tapered`.
"""

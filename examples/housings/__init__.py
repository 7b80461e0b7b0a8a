"""Housings of the shipped systems: drawn and meshed by gmsh, solved by CalculiX, reduced to a few coordinates.

======================== ==================================================================
`examples.housings.designs`   what each housing is: dimensions, material, seats, feet, sensors
`examples.housings.geometry`  its solid and the mesh of second-order tetrahedra (gmsh)
`examples.housings.mesh`      the mesh as arrays: nodes, elements, surface, volume
`examples.housings.deck`      the input deck of CalculiX
`examples.housings.solve`     running CalculiX: mass and stiffness, and its own frequencies
`examples.housings.make`      the story: mesh, matrices, reduction, provenance
`examples.housings.picture`   what the mesh looks like
`examples.housings.command`   what ``python -m examples.housings`` does with its arguments
======================== ==================================================================

From the root of a clone ``python -m examples.housings NAME`` makes a shipped file anew. Only this package needs gmsh
and CalculiX; a system reads the reduced files and needs neither.
"""

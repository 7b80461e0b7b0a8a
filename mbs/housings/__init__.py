"""Housings of the shipped systems: drawn and meshed by gmsh, solved by CalculiX, reduced to a few coordinates.

======================== ==================================================================
`mbs.housings.designs`   what each housing is: dimensions, material, seats, feet, sensors
`mbs.housings.geometry`  its solid and the mesh of second-order tetrahedra (gmsh)
`mbs.housings.mesh`      the mesh as arrays: nodes, elements, surface, volume
`mbs.housings.deck`      the input deck of CalculiX
`mbs.housings.solve`     running CalculiX: mass and stiffness, and its own frequencies
`mbs.housings.make`      the story: mesh, matrices, reduction, provenance
`mbs.housings.picture`   what the mesh looks like
`mbs.housings.command`   what ``python -m mbs.housings`` does with its arguments
======================== ==================================================================

``python -m mbs.housings NAME`` makes a shipped file anew. Only this package needs gmsh and CalculiX; a system reads
the reduced files and needs neither.
"""

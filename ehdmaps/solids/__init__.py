"""Solids of a bearing by finite elements: how far roller and rings yield under the load of a contact.

It runs off-line, once per bearing, and gives a few numbers: what reads or uses them needs neither gmsh nor CalculiX.

`ehdmaps.solids.sections`   roller, rings and their seats as dimensions
`ehdmaps.solids.mesh`       gmsh, where it is installed
`ehdmaps.solids.calculix`   CalculiX, where it is installed: running a deck
"""

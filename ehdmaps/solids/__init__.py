"""Solids of a bearing by finite elements: how far roller and rings yield under the load of a contact.

It runs off-line, once per bearing, and gives a few numbers: what reads or uses them needs neither gmsh nor CalculiX.

`sections`             roller, rings and their seats as dimensions
`calculix`             CalculiX, where it is installed: running a deck

Roller and rings in the plane, and their structural law `fe`:

`mesh_plane`           triangles by gmsh, graded to the contact
`plane`                how far a body yields under Hertz' pressure of any width (scikit-fem)
`law`                  from these numbers to the approach over the load
`plane_bearing`        both contacts of a bearing, also by CalculiX, how good they are, all as plain values

A roller of finite length:

`finite_line`          how bodies of finite depth with free ends yield beside a force
`slices`               what slices of a roller know of their neighbours, as a matrix
"""

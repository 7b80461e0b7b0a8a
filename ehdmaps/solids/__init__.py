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

`three_d`              pressures over width and length, from half spaces and free ends
`slices`               what slices of a roller know of their neighbours, as a matrix
`three_d_bricks`       bricks of roller and raceway: mesh, stiffness, how far their surface yields
`three_d_reference`    the contact by finite elements, also by CalculiX, and its shipped results
`three_d_compare`      pressures over the length beside the finite elements
"""

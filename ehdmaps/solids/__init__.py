"""Solids of a bearing by finite elements: how far roller and rings yield under the load of a contact.

It runs off-line, once per bearing, and gives a few numbers: what reads or uses them needs neither gmsh nor CalculiX.

`ehdmaps.solids.sections`   roller, rings and their seats as dimensions
`ehdmaps.solids.mesh`       gmsh, where it is installed
`ehdmaps.solids.calculix`   CalculiX, where it is installed: running a deck

Roller and rings in the plane, and their structural law `fe`:

`ehdmaps.solids.mesh_plane`      triangles, graded to the contact
`ehdmaps.solids.plane`           how far a body yields under Hertz' pressure of any width (scikit-fem)
`ehdmaps.solids.law`             from these numbers to the approach over the load
`ehdmaps.solids.plane_contact`   the contact by CalculiX, with no pressure assumed
`ehdmaps.solids.plane_bearing`   both contacts of a bearing, and the studies that tell how good they are
`ehdmaps.solids.plane_record`    all of it as plain values, as it is written and shipped

A roller of finite length:

`ehdmaps.solids.three_d`              pressures over width and length, from half spaces and free ends
`ehdmaps.solids.slices`               what slices of a roller know of their neighbours, as a matrix
`ehdmaps.solids.three_d_mesh`         bricks of roller and raceway
`ehdmaps.solids.three_d_elements`     stiffness of bricks
`ehdmaps.solids.three_d_compliance`   how far their surface yields
`ehdmaps.solids.three_d_contact`      forces between surfaces that touch
`ehdmaps.solids.three_d_reference`    the contact by finite elements, and its shipped results
`ehdmaps.solids.three_d_calculix`     the same bricks in CalculiX
`ehdmaps.solids.three_d_make`         all cases of a bearing, made anew
`ehdmaps.solids.three_d_compare`      pressures over the length beside the finite elements
"""

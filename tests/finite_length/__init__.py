"""A roller of finite length by finite elements in three dimensions, the reference for what the product has of it.

===========  ===============================================================================
solution     pressures over width and length, from half spaces of finite depth with free ends
slice_loads  loads of slices, coupled and on their own
bricks       bricks of roller and raceway: mesh, stiffness, how far their surface yields
reference    the contact by finite elements, also by CalculiX, and its kept results in `data`
compare      solution and slices beside the finite elements
report       what is found, in words
figure       what is found, as a figure
===========  ===============================================================================

`python -m tests.finite_length NU308` prints all cases of a bearing.
"""

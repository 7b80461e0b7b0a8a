"""Scenes: what a scene file says, how it is read, and a model made of it.

The modules in the order of the data:

=============  ====================================================================================
reader         a scene file becomes a `Scene`; nothing is computed
fields         how the values of a file are read: places, vectors, directions
flexible, ...  one kind of table each, how it is read and built: shafts and bodies of finite elements,
               `bearings` with `profiles`, `balls`, `gears`, `matrices`, loads that turn (`turning`)
specs          what a scene says of bodies and bearings: plain frozen values
scene          the scene itself; it may be made of specs, without a file
kinds          the machine elements that a scene may have, one row each
bodies         bodies are built, each content once
map_set        maps of a scene: each bearing takes the one that was made for it
contact_laws   the contact law in force; `table_law`: that of points which a user has
subject        a scene with its law, as they are chosen: by names of laws, and by maps
choices        what commands choose of a scene, one row each
assembly       scene and law become a `Model`, or a list of all problems
=============  ====================================================================================

Nothing is imported here: take the functions from `mbs`, or from their modules.
"""

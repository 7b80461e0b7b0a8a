"""Tapered roller bearings of a scene: a table [[bearings]] with the designation of one.

==========  ===========================================================
`reading`   the table becomes a `mbs.scene.specs.TaperedSpec`
`element`   its law, what is wrong about it, and the element of a system
==========  ===========================================================
"""

"""Tapered roller bearings of a scene, and NJ and NUP by their ribs: a table [[bearings]] with the designation of one.

==========  ===========================================================
`ribs`      NJ and NUP as their ribs hold them
`reading`   the table becomes a `mbs.scene.specs.TaperedSpec`
`films`     films of its lines over the speed
`element`   its law, what is wrong about it, and the element of a system
==========  ===========================================================
"""

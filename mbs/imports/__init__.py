"""Rotors as other programs save them, to scenes.

The modules in the order of the data:

==========  ===================================================================================
ross_file   a file of ROSS 2.x becomes plain values; what is not taken is refused, all at once
ross_scene  the values become the text of a scene
==========  ===================================================================================
"""

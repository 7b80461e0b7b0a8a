"""Shafts of a scene, as tables of sections, discs and places.

The modules in the order of the data:

==========  =======================================================================================
standing    bearings stand on a shaft by their position; weight is on
rows        the sections of a shaft, in the scene or in a CSV file
tables      a table [[shafts]] is read and becomes a body
new         a commented scene of a shaft to begin with, `new.toml`
==========  =======================================================================================
"""

"""Roller bearings that only a catalogue describes: needles, tapered rollers, ribs.

====================  =================================================================================================
`ratings`             static and dynamic ratings of ISO 76 and ISO 281, and the rollers that both ratings tell
`needle_catalogue`    needle roller bearings and cages by designation
`tapered_geometry`    geometry of a tapered roller bearing: cones, apex, rib, speeds
`ribbed_geometry`     cylindrical roller bearings NJ and NUP, whose ribs carry axial load
`tapered_catalogue`   tapered roller bearings by designation
====================  =================================================================================================
"""

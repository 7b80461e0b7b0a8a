"""Designations of rolling bearings: what was typed, in the words of a catalogue.

===============  =====================================================================================================
`reader`         kind, plain name and class of radial clearance of a designation, for every kind that is served
`clearance`      the classes C2 to C5 of ISO 5753-1, and what of them a bearing has that states no clearance
`estimates`      how far the parts of an estimated inner geometry may be off, by its own words
`tables`         rows of catalogues and standards, from a file
`families`       kinds of bearings that are known and not served, in words; balls where lines are asked for
===============  =====================================================================================================
"""

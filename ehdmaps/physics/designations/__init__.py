"""Designations of rolling bearings, in the words of a catalogue, and of oils by their class.

===============  =====================================================================================================
`reader`         kind, plain name and class of radial clearance of a designation, for every kind that is served;
                 rows of catalogues and standards, from a file
`affixes`        what stands before and behind a designation, by a file: told, counted, or refused
`clearance`      the classes C2 to C5 of ISO 5753-1, and what of them a bearing has that states no clearance
`estimates`      how far the parts of an estimated inner geometry may be off, by its own words
`oil_class`      classes of ISO 3448 with a viscosity index, and what is assumed of such oils
`families`       kinds of bearings that are known and not served, in words; balls where lines are asked for
===============  =====================================================================================================
"""

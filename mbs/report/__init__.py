"""A report of a scene as one file of HTML: the machine in operation, its bearings, modes and Campbell diagram.

The modules in the order in which data pass through them:

============  ====================================================================================
examination   scene and law -> everything that the report tells
machine       the machine, what limits its law, and warnings, in sentences; its maps with the operating points
sketch        the machine to scale, and the masses of its bodies
solid         the machine in space, for shapes that move
safety        pressure, least load, film and life of each bearing beside what is allowed
bearings      loads of the rollers around each bearing, pressures, films, stiffness and damping
located       the same of bearings that carry axial load
speeds        critical speeds with their margins to operation; what loads that turn do
transfer      levels and modes of the paths from inputs to sensors, dry beside films
campbell      the table of modes; frequencies over speed with the orders that excite them, or the levels of a run
scene_report  the whole document: its questions in their order
============  ====================================================================================

Pages, tables and charts are those of `ehdmaps.report`. Nothing is imported here: take the names from their modules.
"""

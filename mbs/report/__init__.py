"""A report of a scene as one file of HTML: the machine in operation, its bearings, modes and Campbell diagram.

The modules in the order in which data pass through them:

============  ====================================================================================
examination   scene and law -> everything that the report tells
machine       the machine, what limits its law, and warnings, in sentences; its maps with the operating points
bearings      loads of the rollers around each bearing, pressures, films, stiffness and damping
campbell      the table of modes; frequencies over speed with the orders that excite them, or the levels of a run
scene_report  the whole document
============  ====================================================================================

Pages, tables and charts are those of `ehdmaps.report`. Nothing is imported here: take the names from their modules.
"""

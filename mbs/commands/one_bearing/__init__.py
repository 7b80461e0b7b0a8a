"""`mbs bearing`: one bearing without a scene.

=================  =====================================================================================
values             loads, speeds, directions and choices, every problem noted
shared             loads and speeds together, refusals, damper, oil, surfaces
given, cylindrical  cylindrical rollers and needles: a designation or a file, maps and films
family             what differs between bearings that carry axial load: a row each
balls, ribs        the rows: ball bearings; tapered rollers, NJ and NUP
rolling            their request, points and files
files, linear_files  files for other programs
=================  =====================================================================================
"""

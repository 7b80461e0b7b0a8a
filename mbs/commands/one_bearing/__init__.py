"""`mbs bearing`: one bearing without a scene.

===================  =================================================================================
shared               loads, speeds and choices, refusals, damper, oil, surfaces; every problem noted
cylindrical          cylindrical rollers and needles: a designation or a file, maps and films
family               what differs between bearings that carry axial load: a row each
balls, ribs          the rows: ball bearings; tapered rollers, NJ and NUP
rolling              their request, points and files
files, linear_files  files for other programs
===================  =================================================================================
"""

"""One bearing without a scene, of any family: what `mbs bearing` and `mbs.library` compute, and exports ask for.

========================  ============================================================================
family                    what differs between families of bearings, a row each; what is asked of one
cylindrical, balls, ribs  the rows: cylindrical rollers and needles; ball bearings; tapered, NJ, NUP
shared                    options of all: loads, speeds, choices, law, oil; every problem noted
request                   the request of any family, its points and files
bands                     what is not known of a point
files, linear_files       files for other programs
========================  ============================================================================
"""

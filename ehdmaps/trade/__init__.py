"""Speed against accuracy, as it was measured: one record for contacts, maps and systems, and how it is shown.

The modules in the order in which data pass through them:

=======  ================================================================================
record   `Trade`: choices with their cost, and the errors of what a user looks at
pareto   which choices no other one beats in both cost and error
text     printed tables
data     labelled dataset, and JSON
figure   one picture, with the front of the best choices
files    netCDF file and picture, by the rule of all files that are written
=======  ================================================================================

What is measured is no part of it: contacts and maps are in `ehdmaps.jobs`, systems in `mbs.analyses`.
"""

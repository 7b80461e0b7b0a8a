"""From a job to a map file: films read from the film table or solved, laws checked, everything kept on the way.

=================  ===================================================================================
tasks              `Job` -> `LineTask`, units of work with their keys; lines that a contact law needs
store              results by key in a file beside the map; survives kill -9
sweep              tasks -> results, over all cores, past dead workers and Ctrl-C
status             how far a map is: a bar, lines, a small file for others
log                what happened in all runs that worked on a map, in a file beside it
sampling           random operating points of a job
table_films        films of a map from the film table, or why not
table_law          laws without a file of a map
correction_design  where a dearer solver is asked for what a cheaper one gets wrong
correction         films of one solver corrected by few points of a dearer one
law_check          the contact laws against fresh solves
spacing            errors of contact laws between the points of a map
assemble           results -> dataset of the map, isolated holes filled from their neighbours
report             statuses by cause, error estimates, correction, in lines
generate           the whole story: job -> map file, or a map in memory
points_asked       whether a command is about a map of points
points_map         that map: films of both contacts of a ball bearing, read from the table of points
batch              a batch file: bearings x oils x overrides
batch_generate     its maps, and these as a table
=================  ===================================================================================
"""

"""Making of the film table of points, and of maps of points of ball bearings, which are read from it.

==========  ======================================================================================================
lines       films along loads, solved from light to heavy, in the forms of the table
heavy       numbers beyond the loads that grids resolve, and by how much they may be wrong
errors      what is read between nodes against what is solved; stated errors scaled by finer solutions
table       nodes, the middles of cells, finer points: the table
asked       whether a command is about a map of points
points_map  the map: films of both contacts over load of a ball, speed and temperature, with holes; its file
==========  ======================================================================================================
"""

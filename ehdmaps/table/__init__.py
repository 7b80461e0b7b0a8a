"""Films without solving: one table for the line contacts of all bearings, materials and oils of a family.

==============  ================================================================================================
coordinates     zeta, L or P, alpha and bend: what the films of the family depend on; which films these are
fields          the numbers of the table: their units, and the forms in which they are smooth
interpolation   between the nodes, and beyond the ends
nodes           values and measured errors of one part of a table, and how it is read
oils            an oil's isotherm in these coordinates
films           `FilmTable.films`: films of points in SI with their errors
file            the shipped file
solver          `TableSolver`: says of a map that its films are read, and what solves beside them
==============  ================================================================================================
"""

"""Films of point contacts without solving: one table for the balls of all bearings, of any steel and oil of a family.

==============  ================================================================================================
nodes           zeta, L, kappa and two numbers of the oil; values and errors at the nodes, and how they are read
films           `PointTable.films`: films of points in SI with their errors, each with a status
file            the shipped file
==============  ================================================================================================
"""

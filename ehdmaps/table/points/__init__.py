"""Films of point contacts without solving: one table for the balls of all bearings, of any steel and oil of a family.

==============  ================================================================================================
coordinates     what the films of the family depend on: zeta, L, kappa, and two numbers of the oil; units
nodes           values and errors at the nodes, holes, and how they are read
films           `PointTable.films`: films of points in SI with their errors, each with a status
file            the shipped file
==============  ================================================================================================
"""

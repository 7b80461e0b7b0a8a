"""Maps of points: films of both contacts of a ball bearing over load of a ball, speed and temperature.

==============  ================================================================================================
asked           whether a command is about points
points_map      the map: read from the film table of points, with errors, statuses and holes; its file
==============  ================================================================================================
"""

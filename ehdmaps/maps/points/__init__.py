"""Films of points on oil layers and between rough surfaces, from flooded films of smooth ones.

======  =====================================================
rough   asperities and film of a point share the load
layers  both in their order, over load
law     `PointLaw`: contact law of a ball, read from the film table of points
======  =====================================================
"""

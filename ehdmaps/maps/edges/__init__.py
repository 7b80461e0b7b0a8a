"""Contact laws at the ends of their map, and beyond its speeds and temperatures.

======================  ==================================================================
reach                   loads at each speed and temperature between which points are known
continued               films below the lowest speed and outside the temperatures
======================  ==================================================================
"""

"""Point contacts and the balls that have them, without a film.

==============  ====================================================================================
ellipse         dry point contact of Hertz: ellipticity, semi-axes, pressure, approach, stiffness
==============  ====================================================================================

Nothing is imported here: take the names from their modules.
"""

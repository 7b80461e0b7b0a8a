"""Point contacts and the balls that have them, without a film.

==============  ====================================================================================
ellipse         dry point contact of Hertz: ellipticity, semi-axes, pressure, approach, stiffness
film_formulas   published films of elliptical contacts: Hamrock and Dowson
ball_geometry   `BallGeometry`: curvatures, groove centres, free contact angle, speeds of rolling
ball_catalogue  `BallGeometry` estimated from a designation and its static rating
==============  ====================================================================================

Nothing is imported here: take the names from their modules.
"""

"""Bearings of a scene that carry axial load: a table [[bearings]] with the designation of one.

============  =====================================================================
`reading`     the table becomes a `BallSpec` or a `TaperedSpec` of `mbs.scene.specs`
`ribs`        NJ and NUP as their ribs hold them
`ball_films`  films of balls over the speed
`line_films`  films of the lines of rollers over the speed
`element`     their laws, what is wrong about them, and the element of a system
============  =====================================================================
"""

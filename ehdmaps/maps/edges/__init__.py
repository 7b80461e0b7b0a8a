"""Contact laws beyond the speeds and temperatures of their map.

======================  ==========================================================
continued               films below the lowest speed and outside the temperatures
======================  ==========================================================
"""

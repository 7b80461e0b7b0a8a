"""Pressures, films and the cost of rolling, of bearings whose rolling elements are in balance.

===============  =======================================================================
`ball_report`    balls: dry Hertz, films of points, rolling by strips of lines
`roller_report`  tapered rollers, and rollers between ribs: films of lines at the middle
===============  =======================================================================
"""

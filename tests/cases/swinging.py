"""A scene without elements: a mass on a spring, shaken while it runs up."""

from __future__ import annotations

SWINGING = """
schema = 1
title = "A mass on a spring"
[operation]
speed = "1000 rpm"
temperature = "40 degC"
[[bodies]]
name = "mass"
freedoms = ["y", "z"]
position = ["0 mm", "0 mm", "0 mm"]
cylinders = [{ from = "-10 mm", to = "10 mm", diameter = "100 mm" }]
[[springs]]
name = "spring"
on = "mass"
stiffness = { y = "5e7 N/m", z = "2e7 N/m" }
damping = { y = "300 N s/m", z = "300 N s/m" }
[[loads]]
name = "shaker"
on = "mass"
force = ["0 N", "1 N", "0 N"]
frequency = "1.05 kHz"
[[sensors]]
name = "S1"
on = "mass"
direction = "y"
quantity = "acceleration"
[runup]
from = "500 rpm"
to = "2000 rpm"
duration = "1 s"
step = "20 us"
[campbell]
highest = "2 kHz"
"""

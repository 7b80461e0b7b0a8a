"""Stiffness of fast dry ball bearings by each hypothesis on the axis of the balls, with traction and Harris' criterion.

`python -m tests.benchmarks.ball_hypotheses`: a row a bearing, a column a hypothesis with K along the load and axial
[N/um] and the largest traction over load at a raceway; then Harris' criterion of the default, and K with balls of fixed
speed over that of free ones.
"""

from __future__ import annotations

import dataclasses
import math

from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import HYPOTHESES
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_point import BallPoint
from mbs.bearings.balls.laws import dry_law

CASES = (
    ("6208", 0.0, 2000.0, 30e3),
    ("6208", 2000.0, 500.0, 3e3),
    ("6208", 2000.0, 500.0, 10e3),
    ("7014C", 0.0, 500.0, 10e3),
    ("7208B", 0.0, 1000.0, 10e3),
    ("7208B", 1000.0, 3000.0, 15e3),
)
"""Designation, radial and axial load [N], speed [rpm]."""

RPM = math.pi / 30.0


def main() -> None:
    """Print the table."""
    print(f"| bearing, radial + axial load, rpm | {' | '.join(HYPOTHESES)} | criterion | balls held |")
    print(f"|{'---|' * (len(HYPOTHESES) + 3)}")
    for name, radial, axial, rpm in CASES:
        found = []
        for hypothesis in HYPOTHESES:
            geometry = dataclasses.replace(ball_estimate(name).with_clearance(0.0), hypothesis=hypothesis)
            force = BallForce(geometry, dry_law(geometry))
            found.append(BallPoint.at(force, (axial, radial, 0.0), rpm * RPM))
        cells = [
            f"{1e-6 * one.stiffness[1, 1]:.1f}, {1e-6 * one.stiffness[0, 0]:.1f} ({one.gyroscopic_traction:.2f})"
            for one in found
        ]
        first = found[0]
        held = first.force(first.pose, inner_speed=first.inner_speed, cage_speed=first.cage_speed)[1]
        more = ", ".join(f"{100.0 * (held[i, i] / first.stiffness[i, i] - 1.0):+.1f} %" for i in (1, 0))
        load = " + ".join(f"{value:g}" for value in (radial, axial))
        print(f"| {name}, {load} N, {rpm:g} | {' | '.join(cells)} | {first.race_control:.2f} | {more} |")


if __name__ == "__main__":
    main()

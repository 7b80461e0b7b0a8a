"""Torque of films, drilling and ribs of four bearings over speed and load, beside SKF's catalogue formula.

`python -m tests.benchmarks.bearing_torques`: FVA 3 at 60 degC; radial load with an axial one of a third of it (7208B
0.9, 32208 1.2 of it, NU308 none). Rows have the rolling torque flooded with heat in the
inlet, on layers of 10, 2 and 0.7 um, what slides at a traction of 0.05, and M_rr and M_sl by the formula, with its
factors of inlet heat and of a low oil bath [N mm].

Formulas of G_rr and G_sl: SKF, Rolling bearings, table "Geometric and load dependent variables". Their constants: of
series 62 as in two open programs, of 72 BE, 322 and NU 3 from memory, not checked.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ehdmaps.jobs.make.table_law import table_map
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import LAYERS, FilmConditions, OilSupply
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.rollers.tapered_catalogue import tapered_estimate
from mbs.analyses.bearing_point import bearing_points
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_point import BallPoint
from mbs.bearings.balls.ball_report import ball_contacts
from mbs.bearings.balls.laws import dry_law
from mbs.bearings.bearing import Bearing
from mbs.bearings.films import MapFilms
from mbs.bearings.laws import hertz
from mbs.bearings.tapered.roller_report import roller_contacts
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.bearings.tapered.tapered_point import TaperedPoint
from mbs.scene.locating.ball_films import FilmsOfPoints
from mbs.scene.locating.line_films import FilmsOfLines, OilOfLines

OIL, KELVIN = Lubricant.named("FVA3"), 333.15
LOADS, RPM = (500.0, 2000.0, 6000.0), (1000.0, 4000.0, 10000.0)
SUPPLIES = tuple(FilmConditions(True, OilSupply(layer)) for layer in LAYERS.values())
TRACTION = 0.05


def skf(name: str, radial: float, axial: float, rpm: float) -> tuple[float, float]:
    """M_rr with its factors, and M_sl, of the formula [N mm]."""
    d, D = 40.0, {"NU308": 90.0}.get(name, 80.0)
    mean, viscosity = 0.5 * (d + D), 1e6 * OIL.at(KELVIN).viscosity / OIL.at(KELVIN).density
    if name == "6208":
        tilt = math.sin(math.radians(24.6 * (axial / 19000.0) ** 0.24))
        rolling = 3.9e-7 * mean**1.96 * (radial + 1.7 / tilt * axial) ** 0.54
        sliding = 3.23e-3 * mean**-0.145 * (radial**5 + 36.5 * mean**1.5 / tilt * axial**4) ** (1.0 / 3.0)
        space = 3.1
    elif name == "7208B":
        thrown = 1.9e-12 * mean**4 * rpm**2
        rolling = 5.03e-7 * mean**1.97 * (radial + thrown + 1.97 * axial) ** 0.54
        sliding = 1.3e-2 * mean**0.26 * ((radial + thrown) ** (4.0 / 3.0) + 0.68 * axial ** (4.0 / 3.0))
        space = 4.4
    elif name == "32208":
        rolling = 2.27e-6 * mean**2.38 * (radial + 10.9 * 1.6 * axial) ** 0.31
        sliding = 0.018 * mean**0.82 * (radial + 2.0 * 1.6 * axial)
        space = 6.0
    else:
        rolling = 1.09e-6 * mean**2.41 * radial**0.31
        sliding = 0.0015 * mean * radial
        space = 5.1
    heat = 1.0 / (1.0 + 1.84e-9 * (rpm * mean) ** 1.28 * viscosity**0.64)
    starved = math.exp(-3e-8 * viscosity * rpm * (d + D) * math.sqrt(space / (2.0 * (D - d))))
    traction = {"32208": 0.002, "NU308": 0.02}.get(name, TRACTION)
    return heat * starved * rolling * (viscosity * rpm) ** 0.6, traction * sliding


def torques(name: str, radial: float, axial: float, speed: float) -> tuple[list[float], float]:
    """Rolling torque of each supply, and torque of what slides [N mm]."""
    if name == "NU308":
        bearing = Bearing(replace(BearingGeometry.named(name), diametral_clearance=20e-6))
        found = []
        emap = table_map(bearing.geometry, OIL, inlet_heat=True)
        for conditions in SUPPLIES:
            films = MapFilms(emap, conditions.supply)
            point = bearing_points(bearing, hertz(bearing), films, [(radial, 0.0)], [speed], KELVIN)[0][0]
            found.append(1e3 * point.loss.torque)
        return found, 0.0
    if name == "32208":
        tapered = TaperedForce(tapered_estimate(name))
        at = TaperedPoint.at(tapered, (axial, radial, 0.0), speed)
        losses = [
            roller_contacts(
                tapered, at.elements, FilmsOfLines(tapered.geometry, OilOfLines("table", OIL, KELVIN, 40.0, one)),
                (speed, 0.0),
            )[1]
            for one in SUPPLIES
        ]  # fmt: skip
    else:
        geometry = ball_estimate(name)
        balls = BallForce(geometry, dry_law(geometry))
        ball = BallPoint.at(balls, (axial, radial, 0.0), speed)
        losses = [
            ball_contacts(balls, ball.elements, FilmsOfPoints(geometry, OIL, KELVIN, one), (speed, 0.0))[1]
            for one in SUPPLIES
        ]
    return [1e3 * loss.torque for loss in losses], 1e3 * losses[0].sliding_torque


def main() -> None:
    """Print the table."""
    print("bearing  load, N   rpm   flooded  10 um   2 um 0.7 um  sliding   SKF M_rr   M_sl")
    for name, ratio in (("6208", 1.0 / 3.0), ("7208B", 0.9), ("32208", 1.2), ("NU308", 0.0)):
        for load in LOADS:
            for rpm in RPM:
                rolling, sliding = torques(name, load, ratio * load, rpm * np.pi / 30.0)
                told = "".join(f"{value:7.0f}" for value in rolling)
                formula = skf(name, load, ratio * load, rpm)
                print(
                    f"{name:7s} {load:8.0f} {rpm:6.0f} {told} {sliding:8.0f} {formula[0]:10.0f} {formula[1]:6.0f}",
                    flush=True,
                )


if __name__ == "__main__":
    main()

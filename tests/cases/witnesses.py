"""Measured and makers' data beside what this program says with its defaults. Nothing is fitted to any of them.

The data are in tests/data/witness, each file with its source, units and conditions.
"""

from __future__ import annotations

import csv
import dataclasses
import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import root

from ehdmaps.arrays import FloatArray
from ehdmaps.electrics import point_capacitance
from ehdmaps.electrics.dielectric import VACUUM
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.ellipse import Ellipse, ellipticity
from ehdmaps.physics.solids import Material
from ehdmaps.point import solve
from ehdmaps.point.two_grids import Resolution, solve_groups
from ehdmaps.table.points.file import shipped_point_table
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_point import BallPoint
from mbs.bearings.balls.laws import dry_law
from mbs.life import ball_reference_life
from tests.cases.points import point_problem

FOLDER = Path(__file__).parents[1] / "data" / "witness"
STEEL_ON_GLASS = 2.0 / ((1.0 - 0.3**2) / 210e9 + (1.0 - 0.21**2) / 70e9)
"""E' of the rig [Pa]."""

KELVIN = 273.15
LOOSE_GROOVES = 0.52, 0.53
"""Grooves that other makers grind: the loose end of what a designation leaves open."""


@dataclass(frozen=True, eq=False)
class Series:
    """Numbers of a source beside ours.

    Attributes
    ----------
    name, unit : str
        What is compared, and the unit of both.
    labels : tuple of str
        Each point in words.
    theirs, ours : array (n,)
        Numbers of the source, and ours.
    """

    name: str
    unit: str
    labels: tuple[str, ...]
    theirs: FloatArray
    ours: FloatArray

    @property
    def ratio(self) -> FloatArray:
        """Ours over theirs, (n,)."""
        return self.ours / self.theirs


def rows(name: str) -> list[dict[str, str]]:
    """Rows of a file of witnesses."""
    with (FOLDER / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def pair_rigidity(geometry: BallGeometry, preload: float) -> float:
    """Axial stiffness of a pair at rest under its preload, twice that of one bearing [N/m]."""
    return 2.0 * float(BallPoint.at(BallForce(geometry, dry_law(geometry)), (preload, 0.0, 0.0), 0.0).stiffness[0, 0])


@cache
def gmn_pairs() -> tuple[Series, Series]:
    """Axial rigidity of pairs 70, 72 by GMN's catalogue beside estimates: with our grooves, and loose ones."""
    table = [row for row in rows("gmn_pair_rigidity") if row["designation"][:2] != "71"]
    theirs = np.array([float(row["pair_axial_rigidity_N_per_um"]) for row in table])
    labels = tuple(f"{row['designation']} {row['preload_N']} N" for row in table)
    estimates = [ball_estimate(row["designation"]) for row in table]
    loose = [
        dataclasses.replace(one, inner_conformity=LOOSE_GROOVES[0], outer_conformity=LOOSE_GROOVES[1])
        for one in estimates
    ]
    preloads = [float(row["preload_N"]) for row in table]
    names = (
        "axial rigidity of pairs, GMN",
        f"the same with grooves {LOOSE_GROOVES[0]:g}, {LOOSE_GROOVES[1]:g}",
    )
    ours = (
        np.array([1e-6 * pair_rigidity(*each) for each in zip(bearings, preloads, strict=True)])
        for bearings in (estimates, loose)
    )
    first, second = (Series(name, "N/um", labels, theirs, each) for name, each in zip(names, ours, strict=True))
    return first, second


@cache
def thin_pairs() -> tuple[Series, ...]:
    """The same of 718 and 719 by GMN, of 719 by NSK."""

    def of(file: str, whose: str, series: str) -> Series:
        table = [row for row in rows(file) if row["designation"].startswith(series)]
        theirs = np.array([float(row["pair_axial_rigidity_N_per_um"]) for row in table])
        labels = tuple(f"{row['designation']} {row['preload_N']} N" for row in table)
        ours = [1e-6 * pair_rigidity(ball_estimate(row["designation"]), float(row["preload_N"])) for row in table]
        return Series(f"axial rigidity of pairs {series}, {whose}", "N/um", labels, theirs, np.array(ours))

    gmn, nsk = "gmn_pair_rigidity", "nsk_pair_rigidity"
    return of(gmn, "GMN", "719"), of(nsk, "NSK", "719"), of(gmn, "GMN", "718")


@cache
def measured_films() -> tuple[Series, ...]:
    """Central films of FVA 3 by interferometry beside those of the film table, a series for each temperature."""
    ball = Ellipse(9.525e-3, 9.525e-3, STEEL_ON_GLASS)
    table, oil = shipped_point_table(), Lubricant.named("FVA3")
    found = []
    for series in ("T20", "T40", "T80"):
        points = [row for row in rows("fva3_films") if row["series"] == series]
        load, speed, celsius, theirs = (
            np.array([float(row[name]) for row in points])
            for name in ("load_N", "speed_m_per_s", "oil_degC", "central_film_nm")
        )
        films = table.films(ball, oil, load, speed, celsius + KELVIN)
        labels = tuple(f"{u:.3g} m/s {t:.1f} degC" for u, t in zip(speed, celsius, strict=True))
        name = f"film of FVA 3 at {celsius.mean():.0f} degC, interferometry"
        found.append(Series(name, "nm", labels, theirs, 1e9 * films.central_film))
    return tuple(found)


@cache
def centre_line() -> tuple[Series, ...]:
    """Mourier's films along the centre line, measured and computed: the plateau, and the smallest film at the exit."""
    oil = Lubricant.roelands(viscosity=0.25, pressure_viscosity=22e-9, density=850.0)
    solution = solve(Ellipse(12.5e-3, 12.5e-3, 110e9), oil, 15.0, 0.09, 313.15)
    assert solution.field is not None
    line = CubicSpline(1e6 * solution.field.x, 1e9 * solution.field.film[:, 0])
    exit_film = float(line(np.linspace(100.0, 150.0, 2001)).min())
    found = []
    for kind, words in (("experiment", "interferometry"), ("authors_simulation", "their simulation")):
        place, theirs = (
            np.array([float(row[name]) for row in rows("mourier_centre_line") if row["kind"] == kind])
            for name in ("x_um", "film_nm")
        )
        inside = np.abs(place) < PLATEAU
        labels = tuple(f"x {x:.0f} um" for x in place[inside])
        name = f"film along a centre line, {words}"
        found += [
            Series(name, "nm", labels, theirs[inside], line(place[inside])),
            Series(f"its smallest film, {words}", "nm", ("exit",), theirs.min(keepdims=True), np.array([exit_film])),
        ]
    return tuple(found)


@cache
def measured_capacitance() -> tuple[Series, ...]:
    """Capacitance of a ball on glass, FVA 3, beside that by the table of points, and by the plates of Hertz."""
    ball, oil, points = (
        Ellipse(9.525e-3, 9.525e-3, STEEL_ON_GLASS),
        Lubricant.named("FVA3"),
        rows("contact_capacitance"),
    )
    labels, theirs, ours, plates = [], [], [], []
    for row in points:
        kelvin, speed = float(row["oil_degC"]) + KELVIN, float(row["speed_m_per_s"])
        permittivity = float(row["relative_permittivity"])
        found = point_capacitance(ball, oil, RIG_LOAD, speed, kelvin, permittivity, RIG_GAP)
        films = shipped_point_table().films(ball, oil, RIG_LOAD, speed, kelvin)
        a, b = ball.semi_axes(RIG_LOAD)
        labels.append(f"{speed:.3g} m/s {row['oil_degC']} degC")
        theirs.append(float(row["capacitance_pF"]))
        ours.append(1e12 * float(found.capacitance))
        plates.append(1e12 * VACUUM * permittivity * math.pi * float(a * b / films.central_film))
    names = "capacitance of a contact", "the same by the plates of Hertz"
    first, second = (
        Series(name, "pF", tuple(labels), np.array(theirs), np.array(each))
        for name, each in zip(names, (ours, plates), strict=True)
    )
    return first, second


HAMROCK_DOWSON = {1: 3.367, 1.25: 4.105, 1.5: 4.565, 2: 5.255, 3: 6.091, 4: 6.636, 6: 6.969, 8: 7.048}
"""Computed minimum films, 1e6 h_min/Rx, by their ellipticity k: J. Lubr. Technol. 99, 1977, 264-276.

From memory: no print of the table was found. The fit that the authors made of them is that of the paper's abstract."""


@cache
def hamrock_dowson() -> Series:
    """Smallest films that Hamrock and Dowson computed beside solved ones; k = 1.03 (Ry/Rx)^0.64 is theirs."""
    ours, speed = [], 2.0 * 0.1683e-11  # U with the sum of speeds
    for k in HAMROCK_DOWSON:
        kappa = 1.0 if k == 1 else float(ellipticity((k / 1.03) ** (-1.0 / 0.64)))
        problem = point_problem(0.1106e-6 / speed**0.75, 4522.0 * speed**0.25, kappa, 1.98e-8)
        found = solve_groups(problem, Resolution()).numbers
        ours.append(1e6 * found.minimum_film * problem.moes * speed**0.5)
    labels = tuple(f"k {k:g}" for k in HAMROCK_DOWSON)
    theirs = np.array(list(HAMROCK_DOWSON.values()))
    return Series("smallest films, Hamrock and Dowson", "1e-6 Rx", labels, theirs, np.array(ours))


RIG_LOAD, RIG_GAP = 20.0, 1.9e-3
"""Load of the rig [N], and gap at a fifth of the ball's radius from the axis [m], where the oil is taken to end."""

PLATEAU = 100.0
"""Half of the plateau of the film [um]; the Hertz circle has 136.5 um."""

_X, _Y, _TILT = 0, 1, 5


@cache
def iso_16281() -> tuple[Series, ...]:
    """Displacements, tilt and life of ISO/TS 16281 by a commercial program."""
    numbers: dict[str, list[tuple[str, float, float]]] = {}
    for row in rows("iso16281_ball"):
        pose, life = _solved({name: float(text) if text else math.nan for name, text in row.items()})
        for name, scale, value in (
            ("axial_displacement_um", 1e6, pose[_X]),
            ("radial_displacement_um", 1e6, pose[_Y]),
            ("tilt_mrad", 1e3, pose[_TILT]),
            ("L10r_1e6", 1.0, life),
        ):
            if row[name]:
                numbers.setdefault(name, []).append((f"case {row['case']}", float(row[name]), scale * value))
    found = []
    for name, each in numbers.items():
        labels, theirs, ours = zip(*each, strict=True)
        quantity, _, unit = name.rpartition("_")
        words = f"{quantity.replace('_', ' ')}, ISO/TS 16281"
        found.append(Series(words, unit, labels, np.array(theirs), np.array(ours)))
    return tuple(found)


def _solved(case: dict[str, float]) -> tuple[FloatArray, float]:
    """Pose of the inner ring, and L10r, of a case of the commercial program."""
    geometry = BallGeometry("6305", 11.5e-3, 43.5e-3, 7, 0.52, 0.53, 0.0, 1e-6 * case["radial_clearance_um"])
    force = BallForce(geometry, dry_law(geometry, Material(210e9, 0.3)))
    loads = {_X: case["axial_N"], _Y: case["radial_N"], _TILT: 0.0}
    free = [way for way in loads if loads[way] or (way == _TILT and not math.isnan(case["tilt_mrad"]))]
    target = np.array([loads.get(way, 0.0) for way in range(6)])

    def pose_of(values: FloatArray) -> FloatArray:
        pose = np.zeros(6)
        pose[free] = 1e-3 * values
        return pose

    def left(values: FloatArray) -> FloatArray:
        return np.asarray((force(pose_of(values), inner_speed=0.0)[0] + target)[free])

    start = [{_X: 0.14, _Y: 0.02, _TILT: 2.7}[way] for way in free]  # mm and mrad
    values = root(left, start, tol=1e-13).x
    assert np.max(np.abs(left(values))) < 1e-6
    pose = pose_of(values)
    return pose, ball_reference_life(geometry, force.loads(pose, inner_speed=0.0).load, 23400.0).life

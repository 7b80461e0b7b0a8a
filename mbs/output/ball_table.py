"""Points of a ball bearing in words, as a labelled dataset, and as CSV: the same words as for roller bearings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.units import DAMPER, FILM, PRESSURE, RPM, SPRING, TEMPERATURE
from mbs.bearings.balls.ball_element import MachineBalls, Settled
from mbs.bearings.balls.ball_findings import ball_pressures
from mbs.bearings.balls.ball_motion import ball_motion
from mbs.bearings.balls.ball_point import BallPoint
from mbs.bearings.films import SIDES
from mbs.output.bearing_table import hole_line, lambda_line, shown, smallest, unsound_lines, warning_lines, write_csv
from mbs.output.files import described
from mbs.output.state_text import beside_class
from mbs.scene.fields import DEGREE, FORCE, MICROMETRE

if TYPE_CHECKING:
    import xarray as xr

    from mbs.model.equilibrium import Equilibrium
    from mbs.scene.assembly import Model

Points = Sequence[Sequence[BallPoint]]
"""By load, then by speed."""


@dataclass(frozen=True)
class BallDescription:
    """Description that all points of a result have in common.

    Attributes
    ----------
    law, films : str
        Law of the contacts and source of the films, in words.
    direction : float
        Direction of the radial load, from y towards z [deg].
    temperature, roughness : float
        [K], [m].
    tilts : bool
        Whether the inner ring tilts freely.
    assumed : tuple of str
        What was not given.
    """

    law: str
    films: str
    direction: float
    temperature: float
    roughness: float
    tilts: bool
    assumed: tuple[str, ...]


_ROW = (
    ("stiffness_along", "N/m", "stiffness of the bearing along the radial load"),
    ("stiffness_across", "N/m", "stiffness of the bearing across the radial load"),
    ("stiffness_axial", "N/m", "stiffness of the bearing along its axis"),
    ("damping_along", "N s/m", "damping of the bearing along the radial load, low-frequency limit"),
    ("damping_across", "N s/m", "damping of the bearing across the radial load, low-frequency limit"),
    ("damping_axial", "N s/m", "damping of the bearing along its axis, low-frequency limit"),
    ("displacement_along", "m", "inner ring against the outer one, along the radial load"),
    ("displacement_across", "m", "inner ring against the outer one, across the radial load"),
    ("displacement_axial", "m", "inner ring against the outer one, along the axis"),
    ("tilt_y", "rad", "tilt of the inner ring about y"),
    ("tilt_z", "rad", "tilt of the inner ring about z"),
    ("entrainment_speed", "m/s", "mean of the two surface speeds"),
    ("cage_speed", "rad/s", "speed of the cage, mean of the balls by their loads"),
    ("centrifugal_load", "N", "largest centrifugal load of a ball"),
    ("gyroscopic_traction", "1", "largest traction that holds a gyroscopic moment, over the load at the outer raceway"),
    ("highest_ball_load", "N", "load of the most loaded ball on the inner raceway"),
    ("loaded_balls", "1", "balls that carry more than 1 % of the highest load"),
    ("film_parameter", "1", "Lambda, smallest film over the combined rms roughness"),
)
_ERRORS = (
    ("film_offset_error", "1", "largest stated error of the film offset"),
    ("central_film_error", "1", "largest stated error of the central film"),
    ("minimum_film_error", "1", "largest stated error of the smallest film"),
    ("damping_error", "1", "largest stated error of the damping"),
)
_SIDE = (
    ("hertz_pressure", "Pa", "largest Hertz pressure"),
    ("central_film", "m", "smallest central film"),
    ("minimum_film", "m", "smallest film"),
    ("contact_angle", "rad", "mean contact angle, by the loads"),
    ("contact_speed", "m/s", "entrainment speed, mean by the loads"),
    ("slip", "m/s", "largest slip of the ring against a ball in the middle"),
    ("spin", "rad/s", "largest drilling of the ring against a ball, about the normal"),
    *_ERRORS,
)


def ball_row(point: BallPoint, roughness: float) -> dict[str, float]:
    """Numbers of a point that do not depend on the contact, by name, SI."""
    if point.failed:
        return {name: math.nan for name, _, _ in _ROW}
    values = (
        *point.along_across(point.stiffness),
        *point.along_across(point.damping),
        *(point.axes @ point.pose[:3]),
        point.pose[0],
        point.pose[4],
        point.pose[5],
        point.entrainment_speed,
        point.cage_speed,
        point.centrifugal_load,
        point.gyroscopic_traction,
        float(point.balls.load[0].max()),
        point.loaded,
        point.smallest_film / roughness,
    )
    return {name: float(value) for (name, _, _), value in zip(_ROW, values, strict=True)}


def _side_row(point: BallPoint) -> dict[str, tuple[float, float]]:
    """Numbers of the inner and the outer contacts, by name, SI."""
    if point.failed:
        return {name: (math.nan, math.nan) for name, _, _ in _SIDE}
    return {
        "hertz_pressure": (float(point.pressure[0].max()), float(point.pressure[1].max())),
        "central_film": (smallest(point.central_film[0]), smallest(point.central_film[1])),
        "minimum_film": (smallest(point.minimum_film[0]), smallest(point.minimum_film[1])),
        "contact_angle": (point.balls.mean_angle(0), point.balls.mean_angle(1)),
        **_motion_row(point),
        **{name: (float(a), float(b)) for (name, _, _), (a, b) in zip(_ERRORS, point.film_errors.T, strict=True)},
    }


def _motion_row(point: BallPoint) -> dict[str, tuple[float, float]]:
    """Entrainment, slip and spin of the loaded contacts, inner and outer."""
    motion, carries = point.motion, point.balls.load > 0.0
    speeds = motion.mean(point.balls).tolist()
    slip, spin = (np.where(carries, np.abs(values), 0.0).max(axis=1).tolist() for values in (motion.slip, motion.spin))
    return {"contact_speed": (speeds[0], speeds[1]), "slip": (slip[0], slip[1]), "spin": (spin[0], spin[1])}


def ball_dataset(description: BallDescription, points: Points) -> xr.Dataset:
    """Dataset over load and speed, with loads and contact angles of all balls.

    Parameters
    ----------
    description : BallDescription
        What they have in common.
    points : sequence of sequence of BallPoint
        Points by load, then by speed.
    """
    import xarray as xr  # a third of a second, which points for people do not need

    dims = ("load", "speed")
    rows = [[ball_row(point, description.roughness) for point in line] for line in points]
    variables: dict[str, Any] = {
        name: (dims, np.array([[row[name] for row in line] for line in rows]), {"units": unit, "long_name": words})
        for name, unit, words in _ROW
    }
    sides = [[_side_row(point) for point in line] for line in points]
    for name, unit, words in _SIDE:
        values = np.array([[row[name] for row in line] for line in sides])
        variables[name] = ((*dims, "contact"), values, {"units": unit, "long_name": f"{words} of the contact"})
    for name, unit, words, array in (
        ("ball_load", "N", "load of the contact of the ball", "load"),
        ("ball_contact_angle", "rad", "contact angle of the ball", "contact_angle"),
    ):
        values = np.array([[getattr(point.balls, array) for point in line] for line in points])
        variables[name] = ((*dims, "contact", "ball"), values, {"units": unit, "long_name": words})
    for name, unit, words in (
        ("slip", "m/s", "speed of the ring less that of the ball in the middle of the contact"),
        ("spin", "rad/s", "drilling of the ring less that of the ball, about the normal"),
    ):
        values = np.array([[getattr(point.motion, name) for point in line] for line in points])
        variables[f"ball_{name}"] = ((*dims, "contact", "ball"), values, {"units": unit, "long_name": words})
    values = np.array([[point.balls.speed for point in line] for line in points])
    around = {"units": "rad/s", "long_name": "speed of the ball around the axis of the bearing"}
    variables["ball_speed"] = ((*dims, "ball"), values, around)
    for name, words, unit in (
        ("stiffness", "stiffness, -d force/d pose", "N/m, N/rad; N m/m, N m/rad"),
        ("damping", "damping, -d force/d velocity", "N s/m, N s/rad; N m s/m, N m s/rad"),
    ):
        values = np.array([[getattr(point, name) for point in line] for line in points])
        attributes = {"units": unit, "long_name": f"{words}, in x, y, z, theta_x, theta_y, theta_z"}
        variables[f"{name}_matrix"] = ((*dims, "force", "motion"), values, attributes)
    outside = np.array([["; ".join(point.problems) for point in line] for line in points], dtype=np.str_)
    variables["outside"] = (dims, outside, {"units": "1", "long_name": "why the laws do not hold at the point"})
    first = points[0][0]
    freedoms = ["x", "y", "z", "theta_x", "theta_y", "theta_z"]
    coordinates = {
        "load": ("load", [line[0].size for line in points], {"units": "N", "long_name": "radial load"}),
        "speed": ("speed", [p.inner_speed for p in points[0]], {"units": "rad/s", "long_name": "inner ring's speed"}),
        "contact": ("contact", list(SIDES), {"units": "1", "long_name": "contact of a ball with this raceway"}),
        "ball": ("ball", first.balls.angle, {"units": "rad", "long_name": "angle of the ball, y towards z"}),
        "force": ("force", freedoms, {"units": "1", "long_name": "force or moment"}),
        "motion": ("motion", freedoms, {"units": "1", "long_name": "displacement or tilt"}),
    }
    return described(xr.Dataset(variables, coords=coordinates), **_attributes(description, points))


def _attributes(description: BallDescription, points: Points) -> dict[str, Any]:
    """Attributes that describe the dataset."""
    first = points[0][0]
    everything = [point for line in points for point in line]
    geometry = {f"bearing_{name}": value for name, value in first.force.geometry.record().items() if name != "name"}
    return {
        "bearing": first.force.geometry.name,
        **geometry,
        "bearing_law": description.law,
        "films": description.films,
        "load_direction_deg": description.direction,
        "axial_load_N": first.axial,
        "outer_speed_rad_s": first.outer_speed,
        "temperature_K": description.temperature,
        "roughness_m": description.roughness,
        "tilts": int(description.tilts),
        "assumed": "; ".join(description.assumed),
        "warnings": "\n".join(dict.fromkeys(line for point in everything for line in (*point.problems, *point.notes))),
    }


def write_ball_csv(dataset: xr.Dataset, path: str) -> None:
    """Write a row for each load and speed, in SI.

    Raises
    ------
    InputError
        If it may not be replaced, or cannot be written.
    """
    write_csv(dataset, path, "ball bearing", _ROW, _SIDE)


def ball_text(description: BallDescription, points: Points) -> list[str]:
    """Lines that describe all points, and warn.

    Parameters
    ----------
    description : BallDescription
        What they have in common.
    points : sequence of sequence of BallPoint
        Points by load, then by speed.
    """
    everything = [point for line in points for point in line]
    lines = ball_heading(description, everything[0])
    if len(everything) == 1:
        lines += _page(everything[0], description) + _balls(everything[0])
    else:
        lines += _table(everything, description)
    return unsound_lines(everything) + lines + warning_lines(everything)


def ball_heading(description: BallDescription, point: BallPoint) -> list[str]:
    """Tell what was computed, and what of it was assumed or estimated."""
    geometry = point.force.geometry
    lines = [
        f"{geometry.title}: law {description.law}; {description.films}",
        f"  {geometry.balls} balls of {1e3 * geometry.ball_diameter:.4g} mm on {1e3 * geometry.pitch_diameter:.4g} mm, "
        f"grooves {geometry.inner_conformity:.4g} and {geometry.outer_conformity:.4g}, contact angle "
        f"{DEGREE.value(geometry.contact_angle):.4g} deg, clearance {MICROMETRE.text(geometry.clearance)}"
        f"{beside_class(geometry)}",
        f"  {TEMPERATURE.text(description.temperature)}, load at {description.direction:.4g} deg from y (a ball) "
        f"towards z, inner ring {'tilts freely' if description.tilts else 'does not tilt'}",
        f"  assumed: {', '.join(description.assumed) or 'nothing'}",
    ]
    return lines + ([f"  {geometry.estimated}"] if geometry.estimated else [])


def _page(point: BallPoint, description: BallDescription) -> list[str]:
    """The numbers of one point."""
    row, roughness = ball_row(point, description.roughness), MICROMETRE.text(description.roughness)
    sides = _side_row(point)

    def three(label: str, unit: str, name: str, factor: float) -> str:
        values = [factor * row[f"{name}_{way}"] for way in ("along", "across", "axial")]
        largest = max(map(abs, values))
        shown = [0.0 if abs(value) < 1e-9 * largest else value for value in values]
        return f"  {label:32s} {unit:8s} " + " ".join(f"{value:12.5g}" for value in shown)

    def two(label: str, unit: str, name: str, factor: float) -> str:
        return f"  {label:32s} {unit:8s} " + " ".join(f"{shown(_clean(factor * value)):>12s}" for value in sides[name])

    outer = f", outer ring {RPM.text(point.outer_speed)}" if point.outer_speed else ""
    lines = [
        f"{FORCE.text(point.size, 6)} radial and {FORCE.text(point.axial, 6)} axial on the inner ring at "
        f"{RPM.text(point.inner_speed)}{outer}: entrainment speed {point.entrainment_speed:.4g} m/s",
        f"  {'':32s} {'':8s} {'along':>12s} {'across':>12s} {'axial':>12s}",
        three("inner ring moves by", "um", "displacement", 1e6),
        three("stiffness", SPRING.unit, "stiffness", SPRING.factor),
        three("damping, low-frequency limit", DAMPER.unit, "damping", DAMPER.factor),
    ]
    if description.tilts:
        lines.append(
            f"  {'tilt about y and z':32s} {'mrad':8s} {1e3 * row['tilt_y']:12.5g} {1e3 * row['tilt_z']:12.5g}"
        )
    return [
        *lines,
        f"  {'':32s} {'':8s} {'inner':>12s} {'outer':>12s} raceway",
        two("Hertz pressure", PRESSURE.unit, "hertz_pressure", 1e-9),
        two("mean contact angle", "deg", "contact_angle", DEGREE.factor),
        two("entrainment speed", "m/s", "contact_speed", 1.0),
        two("slip in the middle", "m/s", "slip", 1.0),
        two("spin of the ring on the ball", "rad/s", "spin", 1.0),
        two("smallest central film", FILM.unit, "central_film", 1e6),
        two("smallest film", FILM.unit, "minimum_film", 1e6),
        *(
            [
                two("stated error of film offset", "%", "film_offset_error", 100.0),
                two("stated error of smallest film", "%", "minimum_film_error", 100.0),
                two("stated error of contact damping", "%", "damping_error", 100.0),
            ]
            if np.any(np.isfinite(point.film_errors))
            else []
        ),
        lambda_line(row["film_parameter"], roughness),
        f"  cage {RPM.text(point.cage_speed)}, centrifugal load of a ball up to {FORCE.text(point.centrifugal_load)}, "
        f"gyroscopic traction up to {point.gyroscopic_traction:.2g} of the load at the outer raceway",
    ]


def _balls(point: BallPoint) -> list[str]:
    """A line for each loaded ball."""
    balls, pressure = point.balls, point.pressure
    hidden = "; the others not shown" if point.loaded < balls.angle.size else ""
    lines = [
        f"  {point.loaded} of {balls.angle.size} balls carry more than 1 % of the highest load{hidden}",
        f"  {'ball':>6s} {'angle':>7s} {'load, N':>19s} {'contact angle, deg':>21s} {'Hertz pressure, GPa':>21s}",
        f"  {'':>6s} {'deg':>7s} {'inner':>9s} {'outer':>9s} {'inner':>11s} {'outer':>9s} {'inner':>11s} {'outer':>9s}",
    ]
    for index in np.argsort(balls.angle):
        if balls.load[0, index] <= 0.01 * balls.load[0].max():
            continue
        angles = [DEGREE.value(float(side[index])) for side in balls.contact_angle]
        lines.append(
            f"  {index:6d} {math.degrees(balls.angle[index]):7.1f} {balls.load[0, index]:9.5g} "
            f"{balls.load[1, index]:9.5g} {_clean(angles[0]):11.4g} {_clean(angles[1]):9.4g} "
            f"{1e-9 * pressure[0, index]:11.3g} {1e-9 * pressure[1, index]:9.3g}"
        )
    return lines


def _table(points: list[BallPoint], description: BallDescription) -> list[str]:
    """A line for each point."""
    lines = [
        f"{'load':>10s} {'speed':>8s} {'K along':>9s} {'across':>9s} {'axial':>9s} {'c along':>9s} {'balls':>6s} "
        f"{'highest':>9s} {'angles':>13s} {'Hertz':>7s} {'smallest':>9s} {'Lambda':>7s}",
        f"{'N':>10s} {'rpm':>8s} {SPRING.unit:>9s} {SPRING.unit:>9s} {SPRING.unit:>9s} {DAMPER.unit:>9s} "
        f"{'loaded':>6s} {'N':>9s} {'deg':>13s} {'GPa':>7s} {'film, um':>9s}",
    ]
    for point in points:
        if point.failed:
            lines.append(hole_line(point.size, point.inner_speed))
            continue
        row = ball_row(point, description.roughness)
        inner, outer = (_clean(DEGREE.value(point.balls.mean_angle(side))) for side in (0, 1))
        lines.append(
            f"{point.size:10.5g} {RPM.value(point.inner_speed):8.5g} {SPRING.value(row['stiffness_along']):9.4g} "
            f"{SPRING.value(row['stiffness_across']):9.4g} {SPRING.value(row['stiffness_axial']):9.4g} "
            f"{DAMPER.value(row['damping_along']):9.4g} {point.loaded:6d} {row['highest_ball_load']:9.5g} "
            f"{inner:6.1f} {outer:6.1f} {1e-9 * float(point.pressure.max()):7.4g} "
            f"{shown(1e6 * point.smallest_film, 4):>9s} {shown(row['film_parameter'], 3):>7s}"
            f"{' !' if point.problems else ''}"
        )
    return lines


def _clean(angle: float) -> float:
    """Zero in place of round-off."""
    return 0.0 if abs(angle) < 1e-9 else angle


_WAYS = ("x", "y", "z")


def _moving(at: Settled) -> list[str]:
    """A line on the speeds of balls that roll; none at rest."""
    inner, outer = at.conditions["inner_speed"], at.conditions["outer_speed"]
    if inner == outer:
        return []
    motion, carries = ball_motion(at.force, at.balls, inner, outer), at.balls.load > 0.0
    slip, spin = (np.where(carries, np.abs(values), 0.0).max(axis=1) for values in (motion.slip, motion.spin))
    return [
        f"  cage {RPM.text(at.balls.cage_speed)}; slip up to {_clean(slip[0]):.3g} m/s inner, {_clean(slip[1]):.3g} "
        f"outer; spin up to {_clean(spin[0]):.4g} rad/s inner, {_clean(spin[1]):.4g} outer"
    ]


def ball_lines(model: Model, balance: Equilibrium) -> list[str]:
    """Lines on each ball bearing: its load, contact angles, loads of the balls, stiffness and damping.

    Parameters
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium of its system.
    """
    lines = []
    for index, connected in enumerate(model.system.elements):
        element = connected.element
        if not isinstance(element, MachineBalls):
            continue
        at = element.settled(connected.transform @ balance.displacement, balance.operation)
        force, loads = balance.forces[index], at.balls.load
        angles = [math.degrees(at.balls.mean_angle(side)) for side in (0, 1)]
        parts = (
            ", ".join(f"{axis} {factor * matrix[k, k]:.5g}" for k, axis in enumerate(_WAYS)) + f" {unit}"
            for matrix, factor, unit in (
                (balance.element_stiffness[index], SPRING.factor, SPRING.unit),
                (balance.element_damping[index], DAMPER.factor, DAMPER.unit),
            )
        )
        pressures = ball_pressures(at.force, at.balls).max(axis=1)
        lines += [
            f"{element.name}: {force[0]:.5g} N along x, {math.hypot(force[1], force[2]):.5g} N across it on the inner "
            f"ring; contact angle {angles[0]:.4g} deg inner, {angles[1]:.4g} outer",
            f"  {at.balls.loaded} of {loads.shape[1]} balls loaded, {loads[0].min():.4g} to "
            f"{loads[0].max():.5g} N at the inner raceway; Hertz pressure up to {PRESSURE.value(pressures[0]):.4g} "
            f"inner, {PRESSURE.text(pressures[1])} outer",
            *_moving(at),
            "  K " + "; C ".join(parts),
        ]
    return lines

"""Points of a bearing of rollers and ribs in words, as a labelled dataset, as CSV, in the words of other bearings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.physics.rollers.ribbed_geometry import RibbedGeometry
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from ehdmaps.units import DAMPER, FILM, PRESSURE, RPM, SPRING, TEMPERATURE
from mbs.bearings.films import SIDES
from mbs.bearings.tapered.roller_findings import line_pressures
from mbs.bearings.tapered.tapered_element import TaperedElement
from mbs.bearings.tapered.tapered_point import RIB_FRICTION, TaperedPoint
from mbs.model.findings import CARRIES
from mbs.output.bearing_table import hole_line, lambda_line, shown, smallest, unsound_lines, warning_lines, write_csv
from mbs.output.files import described
from mbs.output.state_text import beside_class
from mbs.scene.fields import DEGREE, FORCE, MICROMETRE

if TYPE_CHECKING:
    import xarray as xr

    from mbs.model.equilibrium import Equilibrium
    from mbs.scene.assembly import Model

Points = Sequence[Sequence[TaperedPoint]]
"""By load, then by speed."""


@dataclass(frozen=True)
class TaperedDescription:
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
    ("damping_along", "N s/m", "damping of the bearing along the radial load"),
    ("damping_across", "N s/m", "damping of the bearing across the radial load"),
    ("damping_axial", "N s/m", "damping of the bearing along its axis"),
    ("displacement_along", "m", "inner ring against the outer one, along the radial load"),
    ("displacement_across", "m", "inner ring against the outer one, across the radial load"),
    ("displacement_axial", "m", "inner ring against the outer one, along the axis"),
    ("tilt_y", "rad", "tilt of the inner ring about y"),
    ("tilt_z", "rad", "tilt of the inner ring about z"),
    ("entrainment_speed", "m/s", "mean of the two surface speeds in the middle of a roller"),
    ("cage_speed", "rad/s", "speed of the cage, in pure rolling"),
    ("centrifugal_load", "N", "centrifugal load of a roller"),
    ("loaded_rollers", "1", "rollers that carry more than 1 % of the highest load"),
    ("highest_roller_load", "N", "load of the most loaded roller on the inner raceway"),
    ("highest_rib_load", "N", "highest load of the rib"),
    ("rib_pressure", "Pa", "largest Hertz pressure at the rib"),
    ("rib_film", "m", "smallest central film at the rib"),
    ("rib_sliding_speed", "m/s", "sliding speed at the rib"),
    ("rib_power", "W", "power of all rib contacts with a friction of 0.05"),
    ("film_parameter", "1", "Lambda, smallest film over the combined rms roughness"),
    ("equivalent_load", "N", "dynamic equivalent reference load of ISO/TS 16281"),
    ("reference_life", "1", "basic reference rating life L10r in millions of turns"),
)
_SIDE = (
    ("hertz_pressure", "Pa", "largest Hertz pressure"),
    ("central_film", "m", "smallest central film"),
    ("minimum_film", "m", "smallest film"),
)


def tapered_row(point: TaperedPoint, roughness: float) -> dict[str, float]:
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
        point.loaded,
        float(point.rollers.load[0].max()),
        float(point.rollers.load[2].max()),
        float(point.rib_pressure.max()),
        smallest(point.rib_film),
        point.sliding_speed,
        point.rib_power,
        point.smallest_film / roughness,
        point.equivalent_load,
        point.life,
    )
    return {name: float(value) for (name, _, _), value in zip(_ROW, values, strict=True)}


def _side_row(point: TaperedPoint) -> dict[str, tuple[float, float]]:
    """Numbers of the inner and the outer contacts, by name, SI."""
    if point.failed:
        return {name: (math.nan, math.nan) for name, _, _ in _SIDE}
    return {
        "hertz_pressure": (float(point.pressure[0].max()), float(point.pressure[1].max())),
        "central_film": (smallest(point.central_film[0]), smallest(point.central_film[1])),
        "minimum_film": (smallest(point.minimum_film[0]), smallest(point.minimum_film[1])),
    }


def tapered_dataset(description: TaperedDescription, points: Points) -> xr.Dataset:
    """Dataset over load and speed, with the loads of all rollers.

    Parameters
    ----------
    description : TaperedDescription
        What they have in common.
    points : sequence of sequence of TaperedPoint
        Points by load, then by speed.
    """
    import xarray as xr  # a third of a second, which points for people do not need

    dims = ("load", "speed")
    rows = [[tapered_row(point, description.roughness) for point in line] for line in points]
    variables: dict[str, Any] = {
        name: (dims, np.array([[row[name] for row in line] for line in rows]), {"units": unit, "long_name": words})
        for name, unit, words in _ROW
    }
    sides = [[_side_row(point) for point in line] for line in points]
    for name, unit, words in _SIDE:
        values = np.array([[row[name] for row in line] for line in sides])
        variables[name] = ((*dims, "contact"), values, {"units": unit, "long_name": f"{words} of the contact"})
    loads = np.array([[point.rollers.load for point in line] for line in points])
    variables["roller_load"] = (
        (*dims, "contact", "roller"),
        loads[:, :, :2],
        {"units": "N", "long_name": "load of the contact of the roller"},
    )
    variables["rib_load"] = ((*dims, "roller"), loads[:, :, 2], {"units": "N", "long_name": "load of the rib"})
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
        "contact": ("contact", list(SIDES), {"units": "1", "long_name": "contact of a roller with this raceway"}),
        "roller": ("roller", first.rollers.angle, {"units": "rad", "long_name": "angle of the roller, y towards z"}),
        "force": ("force", freedoms, {"units": "1", "long_name": "force or moment"}),
        "motion": ("motion", freedoms, {"units": "1", "long_name": "displacement or tilt"}),
    }
    everything = [point for line in points for point in line]
    geometry = {f"bearing_{name}": value for name, value in first.force.geometry.record().items() if name != "name"}
    described_by: dict[str, Any] = {
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
    return described(xr.Dataset(variables, coords=coordinates), **described_by)


def write_tapered_csv(dataset: xr.Dataset, path: str) -> None:
    """Write a row for each load and speed, in SI.

    Raises
    ------
    InputError
        If it may not be replaced, or cannot be written.
    """
    write_csv(dataset, path, "bearing of rollers and ribs", _ROW, _SIDE)


def tapered_text(description: TaperedDescription, points: Points) -> list[str]:
    """Lines that describe all points, and warn.

    Parameters
    ----------
    description : TaperedDescription
        What they have in common.
    points : sequence of sequence of TaperedPoint
        Points by load, then by speed.
    """
    everything = [point for line in points for point in line]
    lines = tapered_heading(description, everything[0])
    if len(everything) == 1:
        lines += _page(everything[0], description) + _rollers(everything[0])
    else:
        lines += _table(everything, description)
    return unsound_lines(everything) + lines + warning_lines(everything)


def tapered_heading(description: TaperedDescription, point: TaperedPoint) -> list[str]:
    """Tell what was computed, and what of it was assumed or estimated.

    Parameters
    ----------
    description : TaperedDescription
        What all points have in common.
    point : TaperedPoint
        One of them.
    """
    force = point.force
    geometry = force.geometry
    return [
        f"{geometry.title}: law {description.law}; {description.films}",
        f"  {geometry.rollers} rollers of {1e3 * geometry.roller_diameter:.4g} x {1e3 * geometry.roller_length:.4g} mm "
        f"on {1e3 * geometry.pitch_diameter:.4g} mm; {_angles(geometry)}",
        f"  profile {force.profile}, {force.positions.size} slices, {TEMPERATURE.text(description.temperature)}, load "
        f"at {description.direction:.4g} deg from y (a roller) towards z, inner ring "
        f"{'tilts freely' if description.tilts else 'does not tilt'}",
        f"  assumed: {', '.join(description.assumed) or 'nothing'}",
        *([f"  {geometry.estimated}"] if geometry.estimated else []),
    ]


def _angles(geometry: TaperedGeometry) -> str:
    """Contact angle and cones, or ribs."""
    if isinstance(geometry, RibbedGeometry):
        return (
            f"clearance {1e6 * geometry.diametral_clearance:.4g} um{beside_class(geometry)}; ribs carry "
            f"{geometry.ways}, open by {DEGREE.value(geometry.rib_angle):.3g} deg against spherical ends (assumed)"
        )
    angles = [DEGREE.value(x) for x in (geometry.cup_angle, geometry.half_cone_angle, geometry.cone_angle)]
    return (
        f"contact angle {angles[0]:.4g} deg, half cone angle of the rollers {angles[1]:.3g} deg, cone "
        f"{angles[2]:.4g} deg"
    )


def _page(point: TaperedPoint, description: TaperedDescription) -> list[str]:
    """The numbers of one point."""
    row, roughness = tapered_row(point, description.roughness), MICROMETRE.text(description.roughness)
    sides = _side_row(point)

    def three(label: str, unit: str, name: str, factor: float) -> str:
        values = [factor * row[f"{name}_{way}"] for way in ("along", "across", "axial")]
        largest = max(map(abs, values))
        clean = [0.0 if abs(value) < 1e-8 * largest else value for value in values]
        return f"  {label:32s} {unit:8s} " + " ".join(f"{value:12.5g}" for value in clean)

    def two(label: str, unit: str, name: str, factor: float) -> str:
        return f"  {label:32s} {unit:8s} " + " ".join(f"{shown(factor * value):>12s}" for value in sides[name])

    outer = f", outer ring {RPM.text(point.outer_speed)}" if point.outer_speed else ""
    tilts = f"  {'tilt about y and z':32s} {'mrad':8s} {1e3 * row['tilt_y']:12.5g} {1e3 * row['tilt_z']:12.5g}"
    return [
        f"{FORCE.text(point.size, 6)} radial and {FORCE.text(point.axial, 6)} axial on the inner ring at "
        f"{RPM.text(point.inner_speed)}{outer}: entrainment speed {point.entrainment_speed:.4g} m/s",
        f"  {'':32s} {'':8s} {'along':>12s} {'across':>12s} {'axial':>12s}",
        three("inner ring moves by", "um", "displacement", 1e6),
        three("stiffness", SPRING.unit, "stiffness", SPRING.factor),
        three("damping", DAMPER.unit, "damping", DAMPER.factor),
        *([tilts] if description.tilts else []),
        f"  {'':32s} {'':8s} {'inner':>12s} {'outer':>12s} raceway",
        two("Hertz pressure", PRESSURE.unit, "hertz_pressure", 1e-9),
        two("smallest central film", FILM.unit, "central_film", 1e6),
        two("smallest film", FILM.unit, "minimum_film", 1e6),
        lambda_line(row["film_parameter"], roughness),
        f"  rib: up to {FORCE.text(row['highest_rib_load'])} and {1e-9 * row['rib_pressure']:.3g} GPa, slides with "
        f"{point.sliding_speed:.3g} m/s, film {shown(1e6 * row['rib_film'], 3)} um (order of magnitude); "
        f"{point.rib_power:.3g} W at a friction of {RIB_FRICTION:g}, assumed",
        f"  cage {RPM.text(point.cage_speed)}, centrifugal load of a roller {FORCE.text(point.centrifugal_load)}",
        f"  equivalent load {FORCE.text(point.equivalent_load)}, L10r {point.life:.4g} million turns (ISO/TS 16281)",
    ]


def _rollers(point: TaperedPoint) -> list[str]:
    """A line for each loaded roller."""
    rollers, pressure = point.rollers, point.pressure
    hidden = "; the others not shown" if point.loaded < rollers.angle.size else ""
    lines = [
        f"  {point.loaded} of {rollers.angle.size} rollers carry more than 1 % of the highest load{hidden}",
        f"  {'roller':>6s} {'angle':>7s} {'load, N':>29s} {'off the middle, mm':>21s} {'Hertz pressure, GPa':>21s}",
        f"  {'':>6s} {'deg':>7s} {'inner':>9s} {'outer':>9s} {'rib':>9s} {'inner':>11s} {'outer':>9s} {'inner':>11s} "
        f"{'outer':>9s}",
    ]
    for index in np.argsort(rollers.angle):
        if rollers.load[0, index] <= 0.01 * rollers.load[0].max():
            continue
        off = 1e3 * rollers.centre[:, index]
        lines.append(
            f"  {index:6d} {math.degrees(rollers.angle[index]):7.1f} {rollers.load[0, index]:9.5g} "
            f"{rollers.load[1, index]:9.5g} {rollers.load[2, index]:9.4g} {off[0]:11.3g} {off[1]:9.3g} "
            f"{1e-9 * pressure[0, index]:11.3g} {1e-9 * pressure[1, index]:9.3g}"
        )
    return lines


def _table(points: list[TaperedPoint], description: TaperedDescription) -> list[str]:
    """A line for each point."""
    lines = [
        f"{'load':>10s} {'speed':>8s} {'K along':>9s} {'across':>9s} {'axial':>9s} {'c along':>9s} {'rollers':>7s} "
        f"{'highest':>9s} {'rib':>8s} {'Hertz':>7s} {'smallest':>9s} {'Lambda':>7s} {'P_ref':>9s}",
        f"{'N':>10s} {'rpm':>8s} {SPRING.unit:>9s} {SPRING.unit:>9s} {SPRING.unit:>9s} {DAMPER.unit:>9s} "
        f"{'loaded':>7s} {'N':>9s} {'N':>8s} {'GPa':>7s} {'film, um':>9s} {'':>7s} {'N':>9s}",
    ]
    for point in points:
        if point.failed:
            lines.append(hole_line(point.size, point.inner_speed))
            continue
        row = tapered_row(point, description.roughness)
        lines.append(
            f"{point.size:10.5g} {RPM.value(point.inner_speed):8.5g} {SPRING.value(row['stiffness_along']):9.4g} "
            f"{SPRING.value(row['stiffness_across']):9.4g} {SPRING.value(row['stiffness_axial']):9.4g} "
            f"{DAMPER.value(row['damping_along']):9.4g} {point.loaded:7d} {row['highest_roller_load']:9.5g} "
            f"{row['highest_rib_load']:8.4g} {1e-9 * float(point.pressure.max()):7.4g} "
            f"{shown(1e6 * point.smallest_film, 4):>9s} {shown(row['film_parameter'], 3):>7s} "
            f"{row['equivalent_load']:9.5g}{' !' if point.problems else ''}"
        )
    return lines


_WAYS = ("x", "y", "z")


def tapered_lines(model: Model, balance: Equilibrium) -> list[str]:
    """Lines on each tapered roller bearing: its load, loads of the rollers, stiffness and damping.

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
        if not isinstance(element, TaperedElement):
            continue
        rollers = element.rollers(connected.transform @ balance.displacement, balance.operation)
        force, cone = balance.forces[index], rollers.load[0]
        pressures = line_pressures(element.force_at(balance.operation), rollers).max(axis=1)
        parts = (
            ", ".join(f"{axis} {factor * matrix[k, k]:.5g}" for k, axis in enumerate(_WAYS)) + f" {unit}"
            for matrix, factor, unit in (
                (balance.element_stiffness[index], SPRING.factor, SPRING.unit),
                (balance.element_damping[index], DAMPER.factor, DAMPER.unit),
            )
        )
        lines += [
            f"{element.name}: {force[0]:.5g} N along x, {math.hypot(force[1], force[2]):.5g} N across it on the inner "
            f"ring; {np.count_nonzero(cone > CARRIES * cone.max())} of {cone.size} rollers loaded, up to "
            f"{cone.max():.5g} N at the inner raceway, rib up to {rollers.load[2].max():.4g} N; Hertz pressure up to "
            f"{PRESSURE.value(pressures[0]):.4g} inner, {PRESSURE.text(pressures[1])} outer",
            "  K " + "; C ".join(parts),
        ]
    return lines

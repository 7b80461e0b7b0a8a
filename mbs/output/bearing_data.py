"""Points of a bearing as a labelled dataset, and as netCDF and CSV files."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.outputs import MARK, TABLE, Kind, write_text
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.roughness import Surface
from mbs.bearings.bearing import Bearing
from mbs.bearings.contact_report import BearingPoint
from mbs.bearings.films import SIDES
from mbs.bearings.thermal import BearingState
from mbs.output.files import RESULT, described
from mbs.scene.contact_laws import surface_label

if TYPE_CHECKING:
    import xarray as xr

WIDE_RANGE = 20.0
"""A range of loads whose end is further above its beginning is spaced, and drawn, in the logarithm."""

Points = Sequence[Sequence[BearingPoint]]
"""By load, then by speed."""


@dataclass(frozen=True, eq=False)
class BearingDescription:
    """What all points of a result have in common, in words and numbers.

    Attributes
    ----------
    bearing : Bearing
        Geometry with its clearance, profile, slices.
    law, films : str
        Law and films, in words.
    supply : OilSupply
        Oil supply of the contacts.
    surface : Surface
        Surfaces of the contacts, whose load film and asperities share where they are rough.
    oil : Lubricant
        The oil.
    direction : float
        Direction of the load, from y towards z [deg].
    temperature, roughness : float
        [K], [m].
    assumed : tuple of str
        What was not given.
    state : BearingState or None
        Temperatures of the raceways, and what they make of the clearance; None where both have `temperature`.
    """

    bearing: Bearing
    law: str
    films: str
    supply: OilSupply
    surface: Surface
    oil: Lubricant
    direction: float
    temperature: float
    roughness: float
    assumed: tuple[str, ...]
    state: BearingState | None = None


def result_kind(path: str | None) -> Kind:
    """What a result is written as, by the ending of its name."""
    if path is not None and Path(path).suffix.lower() == ".csv":
        return TABLE
    return dataclasses.replace(RESULT, endings=(".nc", ".csv"))


_ROW = (
    ("stiffness_along", "N/m", "stiffness of the bearing along the load"),
    ("stiffness_across", "N/m", "stiffness of the bearing across the load"),
    ("damping_along", "N s/m", "damping of the bearing along the load, low-frequency limit"),
    ("damping_across", "N s/m", "damping of the bearing across the load, low-frequency limit"),
    ("displacement_along", "m", "inner ring against the outer one, along the load"),
    ("displacement_across", "m", "inner ring against the outer one, across the load"),
    ("entrainment_speed", "m/s", "mean of the two surface speeds"),
    ("highest_roller_load", "N", "load of the most loaded roller"),
    ("loaded_rollers", "1", "rollers that carry more than 1 % of the highest roller load"),
    ("film_parameter", "1", "Lambda, smallest film over the combined rms roughness"),
    ("rolling_torque", "N m", "torque that rolling takes; none without a map that has rolling forces"),
    ("rolling_power", "W", "power that the films of all rollers take"),
)
_SIDE = (
    ("hertz_pressure", "Pa", "largest Hertz pressure"),
    ("max_pressure", "Pa", "largest pressure, that of the film where a map knows it"),
    ("central_film", "m", "smallest central film"),
    ("minimum_film", "m", "smallest film"),
)


def bearing_row(point: BearingPoint, roughness: float) -> dict[str, float]:
    """Numbers of a point that do not depend on the contact, by name, SI."""
    stiffness, damping = point.along_across(point.stiffness), point.along_across(point.damping)
    moved = point.axes @ point.displacement
    values = (
        *stiffness,
        *damping,
        *moved,
        point.entrainment_speed,
        float(point.rollers.load.max()),
        point.loaded,
        point.film_parameter(roughness),
        point.loss.torque,
        point.loss.total,
    )
    return {name: float(value) for (name, _, _), value in zip(_ROW, values, strict=True)}


def bearing_dataset(description: BearingDescription, points: Points) -> xr.Dataset:
    """Dataset over load and speed, with the loads of all rollers and the slices of the most loaded one.

    Parameters
    ----------
    description : BearingDescription
        What they have in common.
    points : sequence of sequence of BearingPoint
        Points by load, then by speed.
    """
    import xarray as xr  # a third of a second, which points for people do not need

    dims = ("load", "speed")
    rows = [[bearing_row(point, description.roughness) for point in line] for line in points]
    variables: dict[str, Any] = {
        name: (dims, np.array([[row[name] for row in line] for line in rows]), {"units": unit, "long_name": words})
        for name, unit, words in _ROW
    }
    shares = [[point.film_share(description.surface, description.oil) for point in line] for line in points]
    variables["film_share"] = (
        dims,
        np.array(shares),
        {"units": "1", "long_name": "share of the film in the load of the most loaded roller; 1 for smooth surfaces"},
    )
    for name, unit, words in _SIDE:
        values = np.array([[getattr(point.contacts, name) for point in line] for line in points])
        variables[name] = ((*dims, "contact"), values, {"units": unit, "long_name": f"{words} of the contact"})
    loads = np.array([[point.rollers.load for point in line] for line in points])
    variables["roller_load"] = ((*dims, "roller"), loads, {"units": "N", "long_name": "load of the roller"})
    variables["slice_load"] = (
        (*dims, "slice"),
        np.array([[point.rollers.load_per_length[point.most_loaded] for point in line] for line in points]),
        {"units": "N/m", "long_name": "load per length of the most loaded roller on the inner raceway"},
    )
    for name, unit, words in _SIDE:
        slices = np.array(
            [[[getattr(side, name)[p.most_loaded] for side in p.contacts.sides] for p in line] for line in points]
        )
        plain = words.replace("largest ", "").replace("smallest ", "")
        attributes = {"units": unit, "long_name": f"{plain}, along the most loaded roller"}
        variables[f"slice_{name}"] = ((*dims, "contact", "slice"), slices, attributes)
    outside = np.array([["; ".join(point.problems) for point in line] for line in points], dtype=np.str_)
    variables["outside"] = (dims, outside, {"units": "1", "long_name": "why the laws do not hold at the point"})
    first = points[0][0]
    coordinates = {
        "load": ("load", [line[0].size for line in points], {"units": "N", "long_name": "load on the inner ring"}),
        "speed": ("speed", [p.speed for p in points[0]], {"units": "rad/s", "long_name": "speed of the inner ring"}),
        "contact": ("contact", list(SIDES), {"units": "1", "long_name": "contact of a roller with this raceway"}),
        "roller": ("roller", first.rollers.angle, {"units": "rad", "long_name": "angle of the roller, y towards z"}),
        "slice": ("slice", first.rollers.position, {"units": "m", "long_name": "place along the roller"}),
    }
    return described(xr.Dataset(variables, coords=coordinates), **_attributes(description, points))


def _attributes(description: BearingDescription, points: Points) -> dict[str, Any]:
    """What the dataset says of itself."""
    bearing, geometry = description.bearing, description.bearing.geometry
    everything = [point for line in points for point in line]
    return {
        "bearing": geometry.name,
        "bearing_law": description.law,
        "films": description.films,
        "oil_supply": description.supply.label,
        "surface": surface_label(description.surface),
        "load_direction_deg": description.direction,
        "temperature_K": description.temperature,
        **_warm(description.state),
        "diametral_clearance_m": geometry.diametral_clearance,
        "roughness_m": description.roughness,
        "profile": str(bearing.profile),
        "slices": bearing.slices,
        "slices_coupled": int(bearing.coupled),
        "assumed": "; ".join(description.assumed),
        "warnings": "\n".join(dict.fromkeys(line for point in everything for line in (*point.problems, *point.notes))),
    }


def _warm(state: BearingState | None) -> dict[str, float]:
    """Attributes of a bearing whose rings have temperatures of their own."""
    if state is None:
        return {}
    return {
        "inner_raceway_temperature_K": state.inner,
        "outer_raceway_temperature_K": state.outer,
        "stated_clearance_m": state.clearance.stated,
    }


def write_csv(dataset: xr.Dataset, path: str) -> None:
    """Write a row for each load and speed, in SI.

    Raises
    ------
    InputError
        If it may not be replaced, or cannot be written.
    """
    about = {key: value for key, value in dataset.attrs.items() if key != "warnings"}
    head = [
        f"# table {MARK}: one bearing at operating points, SI",
        *(f"# {key}: {value}" for key, value in about.items()),
    ]
    columns = ["load [N]", "speed [rad/s]", *(f"{name} [{unit}]" for name, unit, _ in _ROW)]
    columns += [f"{name}_{side} [{unit}]" for name, unit, _ in _SIDE for side in SIDES]
    lines = [*head, ",".join([*columns, "outside"])]
    for i, load in enumerate(dataset["load"].values):
        for j, speed in enumerate(dataset["speed"].values):
            here = dataset.isel(load=i, speed=j)
            numbers = [load, speed, *(float(here[name]) for name, _, _ in _ROW)]
            numbers += [float(here[name].sel(contact=side)) for name, _, _ in _SIDE for side in SIDES]
            # Quoted: the cause has commas.
            cause = str(here["outside"].values).replace('"', "'")
            lines.append(",".join([*(_number(number) for number in numbers), f'"{cause}"' if cause else ""]))
    write_text(path, "\n".join(lines) + "\n", TABLE)


def _number(value: float) -> str:
    """A number; empty where there is none."""
    return "" if math.isnan(value) else f"{value:.9g}"

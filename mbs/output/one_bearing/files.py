"""Points of one bearing of any kind as a labelled dataset, as netCDF and CSV files."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.outputs import MARK, TABLE, write_text
from mbs.bearings.films import SIDES
from mbs.model.body import FREEDOMS
from mbs.output.files import described, write_dataset
from mbs.output.one_bearing.kind import Description, Kind, Number, Points, Row, row_of

if TYPE_CHECKING:
    import xarray as xr

    from mbs.unknowns.looks import Band


def write_points(
    kind: Kind, description: Description, points: Points, path: str, bands: Mapping[str, Band] | None = None
) -> str:
    """Write a result, and return what was written in words.

    Parameters
    ----------
    kind : Kind
        Kind of the bearing.
    description : Description
        What the points have in common.
    points : sequence of sequence
        Points by load, then by speed.
    path : str
        The file: .csv, or netCDF.
    bands : mapping of str to Band, optional
        Bands of what is not known of the only point, by the names of variables; netCDF alone has them.

    Raises
    ------
    InputError
        If it may not be replaced, or cannot be written.
    """
    dataset = point_dataset(kind, description, points)
    if Path(path).suffix.lower() == ".csv":
        write_csv(kind, kind.numbers_of(description), [dataset], path)
    else:
        for name, band in (bands or {}).items():
            from mbs.unknowns.bounds import with_bounds

            dataset = with_bounds(dataset, name, band, (0, 0))
        write_dataset(dataset, Path(path))
    return f"{path}: written"


def point_dataset(kind: Kind, description: Description, points: Points) -> xr.Dataset:
    """Dataset over load and speed, with the loads of all rolling elements.

    Parameters
    ----------
    kind : Kind
        Kind of the bearing.
    description : Description
        What the points have in common.
    points : sequence of sequence
        Points by load, then by speed.
    """
    import xarray as xr  # a third of a second, which points for people do not need

    first, everything = points[0][0], [point for line in points for point in line]
    rows = [[row_of(kind, description, point) for point in line] for line in points]

    def of_points(number: Number) -> FloatArray:
        return np.array([[number.of(point, description) for point in line] for line in points])

    dims = ("load", "speed")
    variables: dict[str, Any] = {
        **{name: (dims, values, about) for name, values, about in _of_rows(kind.numbers_of(description), rows)},
        **{name: ((*dims, "contact"), values, about) for name, values, about in _of_rows(kind.sides, rows, _BOTH)},
        **{
            one.name: ((*dims, *one.dims), of_points(one), {"units": one.unit, "long_name": one.words})
            for one in (*kind.each, *(_MATRICES if kind.axial else ()))
        },
    }
    outside = np.array([["; ".join(point.problems) for point in line] for line in points], dtype=np.str_)
    told = {"units": "1", "long_name": "why the laws do not hold at the point"}
    variables["outside"] = (("load", "speed"), outside, told)
    for old, new in kind.old_names.items():
        dims, values, attributes = variables[new]
        variables[old] = (dims, values, {**attributes, "comment": f"copy of {new}: the next release has no {old}"})
    element, angles = kind.element, first.elements.angle
    freedoms = {
        "force": ("force", list(FREEDOMS), {"units": "1", "long_name": "force or moment"}),
        "motion": ("motion", list(FREEDOMS), {"units": "1", "long_name": "displacement or tilt"}),
    }
    coordinates: dict[str, Any] = {
        "load": (
            "load",
            [line[0].size for line in points],
            {"units": "N", "long_name": "radial load on the inner ring"},
        ),
        "speed": (
            "speed",
            [p.inner_speed for p in points[0]],
            {"units": "rad/s", "long_name": "speed of the inner ring"},
        ),
        "contact": ("contact", list(SIDES), {"units": "1", "long_name": f"contact of a {element} with this raceway"}),
        element: (element, angles, {"units": "rad", "long_name": f"angle of the {element}, y towards z"}),
        **kind.coordinates(first),
        **(freedoms if kind.axial else {}),
    }
    loaded = {"axial_load_N": first.axial, "outer_speed_rad_s": first.outer_speed} if kind.axial else {}
    about: dict[str, Any] = {
        "bearing": first.geometry.name,
        **kind.attributes(description, first),
        "bearing_law": description.law,
        "films": description.films,
        "load_direction_deg": description.direction,
        **loaded,
        "temperature_K": description.temperature,
        "roughness_m": description.roughness,
        **({"tilts": int(description.tilts)} if kind.axial else {}),
        "assumed": "; ".join(description.assumed),
        "warnings": "\n".join(dict.fromkeys(line for point in everything for line in (*point.problems, *point.notes))),
    }
    return described(xr.Dataset(variables, coords=coordinates), **about)


_BOTH = " of the contact"

_FREEDOMS = f", in {', '.join(FREEDOMS)}"
_STIFFNESS, _DAMPING = f"stiffness, -d force/d pose{_FREEDOMS}", f"damping, -d force/d velocity{_FREEDOMS}"
_PLANE = ("force", "motion")
_MATRICES = (
    Number("stiffness_matrix", "N/m, N/rad; N m/m, N m/rad", _STIFFNESS, lambda p, _: p.stiffness, _PLANE),
    Number("damping_matrix", "N s/m, N s/rad; N m s/m, N m s/rad", _DAMPING, lambda p, _: p.damping, _PLANE),
)


def _of_rows(
    numbers: Sequence[Number], rows: Sequence[Sequence[Row]], more: str = ""
) -> list[tuple[str, FloatArray, dict[str, str]]]:
    """Names, values by load and speed, and attributes of numbers."""
    return [
        (
            one.name,
            np.array([[row[one.name] for row in line] for line in rows]),
            {"units": one.unit, "long_name": one.words + more},
        )
        for one in numbers
    ]


def write_csv(kind: Kind, numbers: Sequence[Number], datasets: Sequence[xr.Dataset], path: str) -> None:
    """Write a row for each load and speed, in SI.

    Parameters
    ----------
    kind : Kind
        Kind of the bearing.
    numbers : sequence of Number
        Single numbers of a point.
    datasets : sequence of xarray.Dataset
        Points of a bearing over load and speed, of one or more temperatures or lines of a history.
    path : str
        The file.

    Raises
    ------
    InputError
        If it may not be replaced, or cannot be written.
    """
    first = datasets[0]
    about = {key: value for key, value in first.attrs.items() if key != "warnings"}
    unlike = [key for key, value in about.items() if any(one.attrs.get(key) != value for one in datasets)]
    about.update(dict.fromkeys(unlike, "several, see the column"))
    head = [
        f"# table {MARK}: one {kind.words} at operating points, SI",
        *(f"# {key}: {value}" for key, value in about.items()),
        *(f"# {old}: copy of {new}: the next release has no {old}" for old, new in kind.old_names.items()),
    ]
    single = [*((number.name, number.unit) for number in numbers)]
    copies = [(old, first[old].attrs["units"]) for old in kind.old_names]
    names = ["load [N]", "speed [rad/s]", *(f"{name} [{unit}]" for name, unit in single)]
    names += [f"{side.name}_{contact} [{side.unit}]" for side in kind.sides for contact in SIDES]
    lines = [*head, ",".join([*names, *(f"{name} [{unit}]" for name, unit in copies), "outside"])]
    places = itertools.product(datasets, range(first.sizes["load"]), range(first.sizes["speed"]))
    for here in (dataset.isel(load=i, speed=j) for dataset, i, j in places):
        values = [float(here[name]) for name in ("load", "speed", *(name for name, _ in single))]
        values += [float(here[side.name].sel(contact=contact)) for side in kind.sides for contact in SIDES]
        values += [float(here[name]) for name, _ in copies]
        # Quoted: the cause has commas.
        cause = str(here["outside"].values).replace('"', "'")
        fields = ["" if math.isnan(value) else f"{value:.9g}" for value in values]
        lines.append(",".join([*fields, f'"{cause}"' if cause else ""]))
    write_text(path, "\n".join(lines) + "\n", TABLE)

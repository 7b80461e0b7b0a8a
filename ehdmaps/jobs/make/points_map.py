"""A map of points: what the film table of points has of both contacts of a ball bearing, as a labelled dataset.

Unlike maps of line contacts its loads are forces, those of one ball, and its films are read alone: a point that the
table does not hold has a status, its reason in words, and no numbers.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from ehdmaps.arrays import variable
from ehdmaps.errors import InputError, MapError, Problems
from ehdmaps.jobs.make.points_asked import ENDING, MADE
from ehdmaps.netcdf_structure import DAMAGE, structure_problem
from ehdmaps.outputs import MADE_AS, dataset_kind, written_aside
from ehdmaps.physics.heat import INLET_HEAT, ISOTHERMAL, heat_data
from ehdmaps.physics.hertz import POINT_LIMIT
from ehdmaps.physics.lubricant import DEFAULT_OIL, Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import Status, usable_points
from ehdmaps.table.file import CHECKSUM
from ehdmaps.table.points.file import shipped_point_table
from ehdmaps.table.points.films import CAUSES, NUMBERS
from ehdmaps.version import version

KIND = dataset_kind("a map of points of ehdmaps", MADE, (ENDING,))

DIMS = ("contact", "load", "entrainment_speed", "temperature")

SIDES = ("inner", "outer")

LIGHTEST, LOADS = 1.0, 32
"""Lightest load [N], and how many there are; the heaviest one has the inner contact at the static limit."""

SPEEDS = (0.0, *np.round(np.geomspace(0.1, 20.0, 12), 4).tolist())
TEMPERATURES = (293.15, 313.15, 333.15, 353.15, 373.15, 393.15)
"""Entrainment speeds [m/s], and temperatures [K] where the oil has a state."""

_UNITS = {
    "approach": ("m", "approach of ball and raceway"),
    "film_offset": ("m", "dry less lubricated approach at equal load"),
    "stiffness": ("N/m", "stiffness of the contact, in the limit of slow motion"),
    "damping": ("N s/m", "damping of the contact, in the limit of slow motion"),
    "film_compliance": ("m/N", "compliance of the contact less that of the dry one"),
    "loss_compliance": ("m s/N", "damping over the square of the stiffness"),
    "central_film": ("m", "film at the centre"),
    "minimum_film": ("m", "smallest film"),
    "max_pressure": ("Pa", "largest pressure"),
}


@dataclass(frozen=True, eq=False)
class PointsRequest:
    """Question of a map of points.

    Attributes
    ----------
    bearing : BallGeometry
        The bearing.
    oil : Lubricant
        The oil.
    loads : int
        How many loads.
    speeds, temperatures : tuple of float
        Entrainment speeds [m/s], and temperatures [K]; those at which the oil has a state where they are left out.
    inlet_heat : bool
        Whether heat in the inlet thins the films, by its rule (`ehdmaps.physics.point.inlet_heat`).
    """

    bearing: BallGeometry
    oil: Lubricant
    loads: int = LOADS
    speeds: tuple[float, ...] = SPEEDS
    temperatures: tuple[float, ...] = ()
    inlet_heat: bool = False

    @classmethod
    def named(cls, bearing: str, oil: str | None = None) -> PointsRequest:
        """Request by names.

        Parameters
        ----------
        bearing : str
            Designation, such as "6208"; behind commas an oil where no other is given, and inlet-heat or isothermal.
        oil : str, optional
            Name of the oil.

        Raises
        ------
        InputError
            With every problem.
        """
        name, *parts = (part.strip() for part in bearing.split(","))
        heat = parts.pop() == INLET_HEAT if parts and parts[-1] in (INLET_HEAT, ISOTHERMAL) else False
        beside, problems = ", ".join(parts), Problems()
        if beside and oil is not None:
            problems.append(f"--oil: got {oil!r:.60} beside {beside!r:.60}; allowed: one of the two")
        found: list[Any] = []
        oil_name = beside if beside else DEFAULT_OIL if oil is None else oil
        for option, read, text in (("--bearing", ball_estimate, name), ("--oil", Lubricant.named, oil_name)):
            with problems.after(f"{option}: "):
                found.append(read(text))
        problems.check()
        if heat:
            heat_data(found[1], STEEL)
        return replace(cls(*found), inlet_heat=heat)

    @property
    def file_name(self) -> str:
        """Name of the map's file."""
        plain = "".join(letter if letter.isalnum() or letter in "-." else "_" for letter in self.oil.title)
        reach = self.bearing.clearance_range
        beside = f"_{reach.name}" if reach is not None and reach.typed else ""
        return f"{self.bearing.name}{beside}_{plain}{f'_{INLET_HEAT}' * self.inlet_heat}.nc"


def points_map(request: PointsRequest) -> xr.Dataset:
    """Read the map.

    Parameters
    ----------
    request : PointsRequest
        Bearing and oil.

    Returns
    -------
    xarray.Dataset
        Numbers and errors over `DIMS`, SI; status, and the number of its cause.
    """
    contacts = request.bearing.contacts(STEEL)
    heaviest = float((POINT_LIMIT / contacts[0].max_pressure(1.0)) ** 3)
    loads = np.geomspace(LIGHTEST, heaviest, request.loads)
    speeds, temperatures = np.array(request.speeds), np.array(request.temperatures or _held(request.oil))
    table = shipped_point_table()
    at, heat = (loads[:, None, None], speeds[:, None], temperatures), request.inlet_heat
    films = [table.films(contact, request.oil, *at, inlet_heat=heat) for contact in contacts]

    def stacked(values: list[Any], units: str, words: str) -> Any:
        return variable(DIMS, np.stack(values), units, words)

    variables: dict[str, Any] = {}
    for name in NUMBERS:
        unit, words = _UNITS[name]
        variables[name] = stacked([getattr(one, name) for one in films], unit, words)
        variables[f"{name}_error"] = stacked([one.errors[name] for one in films], "1", f"error of {words}, relative")
    variables["status"] = stacked([one.status for one in films], "", "status of the point")
    flags = {"flag_values": [int(each) for each in Status], "flag_meanings": " ".join(each.word for each in Status)}
    variables["status"][-1].update(flags)
    causes = "cause of the status, a number of the attribute causes; 0 for a plain film"
    variables["cause"] = stacked([one.cause for one in films], "", causes)
    coordinates = {
        "contact": variable("contact", list(SIDES), "", "contact of a ball with this raceway"),
        "load": variable("load", loads, "N", "load of a ball"),
        "entrainment_speed": variable("entrainment_speed", speeds, "m/s", "mean of both surface speeds"),
        "temperature": variable("temperature", temperatures, "K", "temperature of both surfaces"),
    }
    attributes = {
        MADE_AS: MADE,
        "title": f"films of the point contacts of {request.bearing.title}, {request.oil.title}"
        f"{', inlet heat' * request.inlet_heat}",
        "physics": INLET_HEAT if request.inlet_heat else ISOTHERMAL,
        "bearing": json.dumps(request.bearing.record()),
        "causes": json.dumps(CAUSES),
        "estimated": request.bearing.estimated or "",
        "lubricant": json.dumps(request.oil.record()),
        "lubricant_verified": int(request.oil.verified),
        "ellipticities": [contact.ellipticity for contact in contacts],
        "film_table_of_points": table.attributes[CHECKSUM],
        "software": version(),
    }
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)


def _held(oil: Lubricant) -> tuple[float, ...]:
    """Temperatures at which the oil has a state; all of them where it has none."""
    found = []
    for temperature in TEMPERATURES:
        try:
            oil.at(temperature)
        except InputError:
            continue
        found.append(temperature)
    return tuple(found) or TEMPERATURES


def usable(dataset: xr.Dataset) -> xr.DataArray:
    """Tell which points have numbers.

    Parameters
    ----------
    dataset : xarray.Dataset
        A map of points.
    """
    return dataset["status"].copy(data=usable_points(dataset["status"].values))


def reasons(dataset: xr.Dataset) -> npt.NDArray[np.str_]:
    """Causes of the status in words, over `DIMS`.

    Parameters
    ----------
    dataset : xarray.Dataset
        A map of points.
    """
    words: npt.NDArray[np.str_] = np.array(json.loads(dataset.attrs["causes"]))
    return np.asarray(words[dataset["cause"].values])


def write_points_map(dataset: xr.Dataset, path: Path) -> None:
    """Write a map.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map.
    path : Path
        File that is written.

    Raises
    ------
    InputError
        If it cannot be written, or something else stands there.
    """
    packed = {name: {"zlib": True, "complevel": 4} for name in dataset.data_vars}
    with written_aside(path, KIND) as aside:
        dataset.to_netcdf(aside, engine="netcdf4", mode="w", encoding=packed)


def read_points_map(path: Path) -> xr.Dataset:
    """Read a map.

    Parameters
    ----------
    path : Path
        File that is read.

    Raises
    ------
    MapError
        If it cannot be read, or lacks what such a map has.
    """
    try:
        if damage := structure_problem(path):
            raise OSError(damage)
        with xr.open_dataset(path, engine="netcdf4") as file:
            dataset = file.load()
    except DAMAGE as error:
        raise MapError(f"{path}: cannot be read ({error!s:.300}); make it again by `ehdmaps generate`") from error
    wanted = {*NUMBERS, *(f"{name}_error" for name in NUMBERS), "status", "cause"}
    lacks = [] if "causes" in dataset.attrs else ["causes"]
    lacks += sorted(wanted - set(map(str, dataset.data_vars)))
    shaped = all(dataset[name].dims == DIMS for name in wanted - set(lacks))
    if dataset.attrs.get(MADE_AS) != MADE or lacks or not shaped:
        what = f"lacks {', '.join(lacks[:3])}" if lacks else "has other dims, or is no such map"
        raise MapError(f"{path}: {what}; expected a map of points; make it again by `ehdmaps generate`")
    return dataset

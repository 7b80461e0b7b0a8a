"""Many operating points at once: dataset in, dataset out, with the variables of a map file."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.jobs.make.assemble import only_usable, package_versions, with_structure
from ehdmaps.jobs.make.store import NoStore
from ehdmaps.jobs.make.sweep import sweep
from ehdmaps.jobs.make.tasks import LONGEST_LINE, LineTask, solver_version
from ehdmaps.maps import schema
from ehdmaps.maps.records import contacts_json, record_json
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.provenance import code_hash

AXES = ("load", "entrainment_speed", "temperature")
"""What an operating point is made of."""

_MOST_NAMED = 5
"""Points that a message names."""


def solve_points(
    contacts: Sequence[LineContact], lubricant: Lubricant, points: xr.Dataset, solver: ContactSolver, workers: int = 1
) -> xr.Dataset:
    """Solve contacts at many operating points.

    Parameters
    ----------
    contacts : sequence of LineContact
        Contacts with different names.
    lubricant : Lubricant
        The oil.
    points : xarray.Dataset
        Load [N/m], entrainment_speed [m/s] and temperature [K], as coordinates or variables over any dims. Each over a
        dim of its own gives all combinations, as in a map; all over one dim gives single points; a number stands for
        all points.
    solver : ContactSolver
        What solves them; picklable where there is more than one worker.
    workers : int
        Number of processes.

    Returns
    -------
    xarray.Dataset
        A dataset over contact and the dims of the points: the variables of a map file. A point without a solution has
        NaN, a status and a reason. Loads over a dim of their own are solved one from the other, as in a map.

    Raises
    ------
    InputError
        With every value that is missing or not possible.
    """
    values, dims = _broadcast(points)
    _check(contacts, lubricant, values)
    lines = _lines(points, dims, values[0].shape, 1 if solver.slow else LONGEST_LINE)
    tasks = [
        (index, line, LineTask(contact, lubricant, *_line(values, line), solver))
        for index, contact in enumerate(contacts)
        for line in lines
    ]
    results = sweep([task for _, _, task in tasks], NoStore(), workers).arrays
    films: dict[str, npt.NDArray[Any]] = {}
    for index, line, task in tasks:
        for name, array in results[task.key].items():
            if name not in films:
                dtype = object if array.dtype.kind == "U" else array.dtype
                films[name] = np.empty((len(contacts), values[0].size), dtype=dtype)
            films[name][index, line] = array

    shape = (len(contacts), *values[0].shape)
    structured = with_structure(only_usable(films), contacts, values[0].ravel())
    solved = {name: array.reshape(shape) for name, array in structured.items()}
    return _dataset(points, ("contact", *dims), [contact.name for contact in contacts], solved).assign_attrs(
        _attributes(contacts, lubricant, solver)
    )


def _broadcast(points: xr.Dataset) -> tuple[tuple[FloatArray, FloatArray, FloatArray], tuple[Hashable, ...]]:
    """Load, speed and temperature of all points, of one shape, and the dims of that."""
    missing = [name for name in AXES if name not in points]
    if missing:
        raise InputError([f"points, {name}: missing; allowed: a number, or an array over any dims" for name in missing])
    if "contact" in points.dims:
        raise InputError("points: got the dim contact; allowed: other dims; it is added for the contacts")
    load, speed, temperature = xr.broadcast(*(points[name] for name in AXES))
    return (_floats(load), _floats(speed), _floats(temperature)), load.dims


def _floats(entry: xr.DataArray) -> FloatArray:
    """The numbers of an array."""
    return np.asarray(entry.values, dtype=np.float64)


def _check(
    contacts: Sequence[LineContact], lubricant: Lubricant, values: tuple[FloatArray, FloatArray, FloatArray]
) -> None:
    """Refuse points outside of what solvers take, and temperatures at which the oil has no data."""
    names = [contact.name for contact in contacts]
    problems = Problems()
    if not names or len(set(names)) < len(names):
        problems.append(f"contacts: got {', '.join(names) or 'none'}; allowed: at least one, with names apart")
    if not values[0].size:
        problems.append("points: got none; allowed: at least one")
    for load, speed, temperature in zip(*(value.ravel().tolist() for value in values), strict=True):
        with problems.after("points, "):
            OperatingPoint(load, speed, temperature)
            lubricant.at(temperature)
    if problems:
        raise InputError(list(dict.fromkeys(problems))[:_MOST_NAMED])


def _lines(points: xr.Dataset, dims: tuple[Hashable, ...], shape: tuple[int, ...], longest: int) -> list[list[int]]:
    """Flat indices of the points of each line: along the load's own dim where it has one, else single points."""
    numbers = np.arange(int(np.prod(shape))).reshape(shape)
    own = points["load"].dims
    shared = {*points["entrainment_speed"].dims, *points["temperature"].dims}
    if len(own) != 1 or own[0] in shared:
        return [[number] for number in numbers.ravel().tolist()]
    rows = np.moveaxis(numbers, dims.index(own[0]), -1).reshape(-1, shape[dims.index(own[0])]).tolist()
    return [row[start : start + longest] for row in rows for start in range(0, len(row), longest)]


def _line(values: tuple[FloatArray, FloatArray, FloatArray], line: list[int]) -> tuple[tuple[float, ...], float, float]:
    """Loads, speed and temperature of a line."""
    load, speed, temperature = (value.ravel() for value in values)
    return tuple(load[line].tolist()), float(speed[line[0]]), float(temperature[line[0]])


def _dataset(
    points: xr.Dataset, dims: tuple[Hashable, ...], names: list[str], solved: dict[str, npt.NDArray[Any]]
) -> xr.Dataset:
    """Put the results beside the points, with the units and names of a map file."""
    given = points.set_coords([name for name in AXES if name not in points.coords])
    built = given.drop_vars(list(given.data_vars)).assign_coords(contact=("contact", np.array(names, dtype=object)))
    for name in ("contact", *AXES):
        built[name].attrs = schema.variable(name).attributes()
    entries = {name: schema.variable(name) for name in solved}
    return built.assign(
        {
            name: (dims, solved[name] if entry.dtype == "str" else solved[name].astype(entry.dtype), entry.attributes())
            for name, entry in entries.items()
        }
    )


def _attributes(contacts: Sequence[LineContact], lubricant: Lubricant, solver: ContactSolver) -> dict[str, str]:
    """Provenance: what the points were solved with."""
    return {
        "title": f"operating points, {lubricant.title}, by the solver {solver.name}",
        "solver": solver.name,
        "solver_settings": record_json(solver.settings()),
        "solver_version": solver_version(solver),
        "contacts": contacts_json(contacts),
        "lubricant": record_json(lubricant.record()),
        "package_versions": record_json(package_versions()),
        schema.CODE: code_hash(),
    }

"""Results of the tasks -> dataset of the map: places, structure, holes filled from neighbours, provenance."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.tasks import ERRORS_OF_SOME, FOUND_BY_SOME, LineTask, solver_version, with_later_fields
from ehdmaps.maps import schema
from ehdmaps.maps.records import MODEL_ERRORS, contacts_json, derived, record_json
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.solution import ContactSolver, usable_points
from ehdmaps.provenance import code_hash
from ehdmaps.version import version

if TYPE_CHECKING:
    import xarray as xr

    from ehdmaps.jobs.make.correction import Correction
    from ehdmaps.jobs.make.store import Arrays


def isolated_holes(usable: BoolArray) -> tuple[BoolArray, BoolArray]:
    """Find the holes that can be filled.

    Parameters
    ----------
    usable : array, dims (contact, load, entrainment_speed, temperature)
        Whether a point has values.

    Returns
    -------
    along_load, along_speed : arrays of bool
        Holes with usable neighbours on both sides along the load axis; and of the others (those at the ends
        of the load axis among them) the ones with usable neighbours along the speed axis.
    """
    along_load = ~usable & _both_neighbours(usable, axis=1)
    along_speed = ~usable & ~along_load & _both_neighbours(usable, axis=2)
    return along_load, along_speed


def filled(values: FloatArray, holes: BoolArray, axis: int, coordinate: FloatArray) -> FloatArray:
    """Interpolate between the two neighbours along one axis.

    Log-log where coordinate and both neighbours are positive, since films and losses are nearly power laws;
    linear in the value elsewhere.

    Parameters
    ----------
    values : array
        Values with NaN in the holes.
    holes : array of bool
        Points to fill; neither at an end of the axis.
    axis : int
        Axis of the neighbours.
    coordinate : array
        Rising values of that axis.

    Returns
    -------
    array
        Copy of `values` with the holes filled.

    Examples
    --------
    >>> line = np.array([1.0, np.nan, 16.0])
    >>> float(filled(line, np.isnan(line), 0, np.array([1.0, 2.0, 4.0]))[1])
    4.0
    """
    moved = np.moveaxis(values, axis, 0)
    result = moved.copy()
    place = np.nonzero(np.moveaxis(holes, axis, 0))
    at, rest = place[0], place[1:]
    before, after = moved[(at - 1, *rest)], moved[(at + 1, *rest)]
    x0, x, x1 = coordinate[at - 1], coordinate[at], coordinate[at + 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(x0 > 0, np.log(x / x0) / np.log(x1 / x0), (x - x0) / (x1 - x0))
        logarithmic = np.exp((1 - share) * np.log(before) + share * np.log(after))
    result[place] = np.where((before > 0) & (after > 0), logarithmic, (1 - share) * before + share * after)
    return np.moveaxis(result, 0, axis)


def _both_neighbours(usable: BoolArray, axis: int) -> BoolArray:
    """True where both neighbours along an axis are usable; False at its ends."""
    moved = np.moveaxis(usable, axis, 0)
    both = np.zeros_like(moved)
    both[1:-1] = moved[:-2] & moved[2:]
    return np.moveaxis(both, 0, axis)


_PACKAGES = ("ehdmaps", "numpy", "scipy", "numba", "xarray", "netCDF4", "PyFoam")
_FILLED_FIELDS = (
    "film_offset",
    "film_compliance",
    "loss_compliance",
    "central_film",
    "minimum_film",
    "max_pressure",
    "rolling_force",
    "mass_flow",
    *FOUND_BY_SOME,
)
_ALWAYS = ("status", "reason", "iterations", "solve_seconds", "viscosity_extrapolated")
"""Fields of a film that a hole keeps."""


def assemble(job: Job, solver: ContactSolver, films: Mapping[str, npt.NDArray[Any]]) -> xr.Dataset:
    """Build the dataset of a map.

    Parameters
    ----------
    job : Job
        What was asked for.
    solver : ContactSolver
        What solved it.
    films : mapping of str to array
        Films of its points by the names of `FilmSolution`, in the shape of the map; see `placed`.

    Returns
    -------
    xarray.Dataset
        The map as the schema wants it, with provenance; isolated holes filled if the job says so.
    """
    values = assembled(job, films)
    coordinates = {
        "contact": [contact.name for contact in job.contacts],
        "load": job.loads,
        "entrainment_speed": job.entrainment_speeds,
        "temperature": job.temperatures,
    }
    return schema.dataset(coordinates, values, _attributes(job, solver))


def assembled(job: Job, films: Mapping[str, npt.NDArray[Any]]) -> dict[str, npt.NDArray[Any]]:
    """Variables of a map by name, without the dataset; arguments as of `assemble`."""
    films = only_usable(films)
    holes_filled = np.zeros(job.shape, dtype=bool)
    if job.fill == "neighbours":
        films, holes_filled = _fill(job, films)
    values = with_structure(films, job.contacts, np.array(job.loads)[:, None, None])
    return values | {"filled": holes_filled.astype(np.int8)}


def with_correction(
    dataset: xr.Dataset, job: Job, correction: Correction, corrector: ContactSolver, lines_of: str = ""
) -> xr.Dataset:
    """The map of a job whose films are corrected, or those of its lines: with its model errors, and what corrected it.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map, as `assemble` makes it of corrected films.
    job : Job
        What was asked for.
    correction : Correction
        The correction.
    corrector : ContactSolver
        The dearer solver.
    lines_of : str
        Name of the solver of the lines, where these alone are corrected, by points of the map.
    """
    from ehdmaps.jobs.make.correction import FILMS, Films, Place

    errors, loads = np.zeros((len(MODEL_ERRORS), *job.shape)), np.array(job.loads)
    for i, contact in enumerate(job.contacts):
        for j, speed in enumerate(job.entrainment_speeds):
            for k, temperature in enumerate(job.temperatures if speed > 0.0 else ()):
                films = Films.of({name: dataset[name].values[i, :, j, k] for name in FILMS})
                place = Place.of(contact, job.lubricant, loads, speed, temperature)
                errors[:, i, :, j, k] = correction.model_errors(films, place)
    known = np.isfinite(dataset["film_offset"].values)
    values = {name: np.where(known, error, np.nan) for name, error in zip(MODEL_ERRORS, errors, strict=True)}
    made_by = {
        "solver": corrector.name,
        "settings": corrector.settings(),
        "version": solver_version(corrector),
        **({"lines": lines_of} if lines_of else {}),
        **correction.record,
    }
    variables = {name: schema.typed(schema.variable(name), array) for name, array in values.items()}
    return dataset.assign(variables).assign_attrs(
        {
            **corrector.provenance,
            **({} if lines_of else {"title": f"{dataset.attrs['title']}, corrected by {corrector.name}"}),
            schema.CORRECTION: record_json(made_by),
        }
    )


def placed(job: Job, tasks: Sequence[LineTask], results: Mapping[str, Arrays]) -> dict[str, npt.NDArray[Any]]:
    """Put the films of every task in their place.

    Parameters
    ----------
    job : Job
        What was asked for.
    tasks : sequence of LineTask
        All of them.
    results : mapping
        Arrays by key of the task.
    """
    films: dict[str, npt.NDArray[Any]] = {}
    for task in tasks:
        contact, start, speed, temperature = task.place
        for name, line in with_later_fields(results[task.key]).items():
            if name not in films:
                films[name] = np.empty(job.shape, dtype=object if line.dtype.kind == "U" else line.dtype)
            films[name][contact, start : start + task.points, speed, temperature] = line
    return films


def only_usable(films: Mapping[str, npt.NDArray[Any]]) -> dict[str, npt.NDArray[Any]]:
    """Films with NaN for the numbers of points that are not usable."""
    usable = usable_points(films["status"])
    return {name: array if name in _ALWAYS else np.where(usable, array, np.nan) for name, array in films.items()}


def _fill(job: Job, films: dict[str, npt.NDArray[Any]]) -> tuple[dict[str, npt.NDArray[Any]], BoolArray]:
    """Fill isolated holes; their error estimates stay NaN, since nobody estimated them."""
    along_load, along_speed = isolated_holes(usable_points(films["status"]))
    result = dict(films)
    for name in _FILLED_FIELDS:
        for holes, axis, coordinate in ((along_load, 1, job.loads), (along_speed, 2, job.entrainment_speeds)):
            if holes.any():
                # From the solved values only: a filled point never fills another.
                result[name] = np.where(holes, filled(films[name], holes, axis, np.array(coordinate)), result[name])
    return result, along_load | along_speed


def with_structure(
    films: Mapping[str, npt.NDArray[Any]], contacts: Sequence[LineContact], loads: FloatArray
) -> dict[str, npt.NDArray[Any]]:
    """Add the structural part to films.

    Parameters
    ----------
    films : mapping of str to array (contacts, ...)
        Arrays by the names of `FilmSolution`.
    contacts : sequence of LineContact
        The contacts.
    loads : array
        w [N/m], that broadcasts to the films of one contact.

    Returns
    -------
    dict
        Arrays of that shape by the names of the map's variables.
    """
    values = dict(films) | derived(contacts, loads, films)
    # As in `ContactSolution`: of the signs only that of the loss against the film compliance is kept.
    values["loss_compliance_error"] = films["loss_compliance_error"] * np.copysign(1.0, films["film_compliance_error"])
    for name in ("film_offset_error", "film_compliance_error"):
        values[name] = np.abs(films[name])
    some = (*FOUND_BY_SOME, *ERRORS_OF_SOME)
    unknown = [name for name in some if name in values and not np.any(np.isfinite(values[name]))]
    return {entry.name: values[entry.name] for entry in schema.table() if entry.name in values.keys() - unknown}


def _attributes(job: Job, solver: ContactSolver) -> dict[str, Any]:
    """Return the provenance: a map alone is enough to repeat it."""
    return {
        "Conventions": "CF-1.10",
        "title": f"EHD map of {job.title}, {job.lubricant.title}, by the solver {solver.name}",
        "schema_version": schema.SCHEMA_VERSION,
        "job_name": job.name,
        "job_toml": job.text,
        "job_sha256": job.sha256,
        **({schema.ASSUMED: ", ".join(job.assumed)} if job.assumed else {}),
        "solver": solver.name,
        "solver_settings": record_json(solver.settings()),
        "solver_version": solver_version(solver),
        **solver.provenance,
        "structural_law": job.contacts[0].structural_law,
        "structural_scaling": job.contacts[0].structural_scaling,
        "fill": job.fill,
        "contacts": contacts_json(job.contacts),
        "geometry": record_json(job.bearing.record() if job.bearing else None),
        "lubricant": record_json(job.lubricant.record()),
        "lubricant_verified": int(job.lubricant.verified),
        **({} if job.supply is None else {schema.OIL_SUPPLY: record_json(job.supply)}),
        **({} if job.surface is None else {schema.SURFACE: record_json(job.surface)}),
        "package_versions": record_json(package_versions()),
        schema.CODE: code_hash(),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
    }


def package_versions() -> dict[str, str]:
    """Return the versions under the numbers: ours with the state of its sources."""
    return {"python": platform.python_version(), **{package: version(package) for package in _PACKAGES}}

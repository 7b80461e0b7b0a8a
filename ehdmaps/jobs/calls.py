"""Python functions that do the same as the commands: `ehdmaps.generate`, `compare`, `solve`, `solve_points`,
`frequency_response`.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from os import PathLike, fspath
from pathlib import Path

import numpy as np
import xarray as xr

from ehdmaps.errors import InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make import generate as generating
from ehdmaps.jobs.make.batch import SUMMARY, Batch, is_batch, read_batch
from ehdmaps.jobs.make.batch_generate import generate_batch as many_maps
from ehdmaps.jobs.make.batch_generate import make_folder, table_dataset, write_table
from ehdmaps.jobs.make.sweep import Progress
from ehdmaps.jobs.make.table_films import unserved
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.show import compare as comparing
from ehdmaps.jobs.solve import points as many
from ehdmaps.jobs.solve.spectrum import spectrum_dataset
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.outputs import MAP, TABLE, Output, check_outputs
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolution, ContactSolver, contact_solution


def generate(
    job: Job | str | PathLike[str],
    output: str | PathLike[str] | None = None,
    *,
    solver: str | ContactSolver | None = None,
    workers: int | None = 1,
    fresh: bool = False,
    progress: Callable[[int], Progress] | None = None,
    tolerance: float | None = None,
    check: bool = False,
    corrector: ContactSolver | None = None,
    executor: Executor | None = None,
) -> xr.Dataset:
    """Make a map.

    With an output file it works as the command does: what its store beside the file has already is taken over, so that
    an interrupted run goes on. Without one everything stays in memory, and films that the film table has not are those
    of the points alone: `EHDMap(dataset).law` then interpolates between them. Give an output file and open it for a law
    with refinement lines.

    Parameters
    ----------
    job : Job, str or path
        A job, the path of a job file or of a map file, or the name of a shipped job ("nu308").
    output : str or path, optional
        The map file.
    solver : str or ContactSolver, optional
        Solver in place of the job's: a solver, or a name, for its default settings with the physics and shear of the
        job.
    workers : int or None
        Number of processes; None for all cores. A script that uses more than one needs the usual
        ``if __name__ == "__main__":``.
    fresh : bool
        Drop the store of the output file first.
    progress : callable, optional
        Takes the number of points, gives the `Progress` to tell.
    tolerance : float, optional
        Share of stiffness, damping and film offset that the contact laws may be wrong by, 0.01 say, at 99 % of random
        points and 95 % of those in the damping valley; the attributes `law_...` say what fresh solves found. It needs
        an output file.
    check : bool
        Whether laws that read the film table are held against fresh solves, as those of solved films are.
    corrector : ContactSolver, optional
        Solver in place of the one that the job names in `corrected_by`.
    executor : concurrent.futures.Executor, optional
        What solves the points in place of processes that are started here, with ``workers`` of no account then: a pool
        of threads or processes, or that of a cluster, such as dask's ``Client().get_executor()``. It stays open.

    Returns
    -------
    xarray.Dataset
        The map.

    Raises
    ------
    InputError, StoreError, MapError, WorkerError
        With what to do; everything solved is kept where there is an output file.
    """
    name = solver if isinstance(solver, str) else None
    chosen = _with_solver(job, name) if isinstance(job, Job) else read_job(job, name)
    made_by = None if isinstance(solver, str) else solver
    if output is None:
        if tolerance is not None:
            raise InputError("tolerance: got one without output; allowed: with an output file, whose laws are checked")
        if unserved(chosen, solvers.complete(made_by or solvers.of_map(chosen))):
            chosen = dataclasses.replace(chosen, backbone="none")
        return generating.generate_in_memory(
            chosen, workers, progress, made_by, corrector, executor, check=check
        ).dataset
    check_outputs([Output("output", Path(output), MAP)], [] if isinstance(job, Job) else [fspath(job)])
    generated = generating.generate(
        chosen, Path(output), workers, fresh, progress, made_by, corrector, executor, tolerance=tolerance, check=check
    )
    return generated.dataset


def generate_batch(
    batch: Batch | str | PathLike[str],
    folder: str | PathLike[str] | None = None,
    *,
    workers: int | None = 1,
    fresh: bool = False,
    progress: Callable[[int], Progress] | None = None,
    executor: Executor | None = None,
) -> xr.Dataset:
    """Make the maps of a batch, as the command does: what is there and is the same is kept, and a run goes on.

    Parameters
    ----------
    batch : Batch, str or path
        A batch, or the path of a batch file.
    folder : str or path, optional
        Folder of the maps; one named after the batch if left out.
    workers, fresh, progress
        The same as for `generate`.
    executor : concurrent.futures.Executor, optional
        What solves the points in place of processes that are started here. Maps are put together here, by `workers`.

    Returns
    -------
    xarray.Dataset
        The table of the maps over `map`, their names: file, bearing, oil, override, state (made, kept or failed), films
        (shared or own), points without a solution, what laws miss, why it failed, and numbers of the first contact at
        the middle of the axes, with units.

    Raises
    ------
    InputError, StoreError, WorkerError
        If nothing can be made at all; a map that fails is told in the table.
    """
    if not isinstance(batch, Batch) and not is_batch(batch):
        raise InputError(
            f"batch: got {fspath(batch)!r:.200}, which is no batch file; allowed: TOML with a table [batch]"
        )
    chosen = batch if isinstance(batch, Batch) else read_batch(batch, to_run=True)
    place = Path(folder or chosen.name)
    make_folder(place)
    read = [] if isinstance(batch, Batch) else [fspath(batch)]
    check_outputs([Output("summary", place / SUMMARY, TABLE)], read)
    result = many_maps(chosen, place, workers, fresh, progress, executor)
    write_table(result, place)
    return table_dataset(result)


def _with_solver(job: Job, name: str | None) -> Job:
    """The job with another solver: the same physics where it knows them, else its default settings."""
    if name is None or name == job.solver:
        return job
    kept = solvers.carried(job.solver_options, _known(name))
    return dataclasses.replace(job, solver=name, solver_options=kept, corrected_by=None)


def compare(
    first: EHDMap | xr.Dataset | str | PathLike[str], second: EHDMap | xr.Dataset | str | PathLike[str]
) -> comparing.Comparison:
    """Compare two maps: on the points that they share, and where these are not all of one of them, between points.

    Between points films are read as contact laws read them, at random points of the range that both maps have. A
    dataset on its own has no refinement lines: give the file, or the `EHDMap`, of a map that has them.

    Parameters
    ----------
    first, second : EHDMap, xarray.Dataset, str or path
        The maps, or their files.

    Returns
    -------
    Comparison
        Relative differences, point by point and summed up.

    Raises
    ------
    MapError
        If a file is no map, or they have no contact or range of an axis in common.
    """
    a, first_name = _opened(first, "first")
    b, second_name = _opened(second, "second")
    return comparing.compare(a, b, (first_name, second_name))


def _opened(source: EHDMap | xr.Dataset | str | PathLike[str], name: str) -> tuple[EHDMap | xr.Dataset, str]:
    """A map, and what it is called."""
    if isinstance(source, EHDMap | xr.Dataset):
        return source, name
    return open_map(source), fspath(source)


def solve(
    contact: LineContact,
    lubricant: Lubricant,
    point: OperatingPoint,
    solver: str | ContactSolver = "reynolds",
) -> ContactSolution:
    """Solve one contact at one operating point; for many of them see `solve_points`.

    Parameters
    ----------
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil.
    point : OperatingPoint
        Load, entrainment speed and temperature.
    solver : str or ContactSolver
        Name of a solver with its default settings ("hertz", "formula", "reynolds", "openfoam"), or a solver; one of
        your own inherits from `ehdmaps.physics.solution.ContactSolverDefaults`.

    Returns
    -------
    ContactSolution
        The solution with its status: numbers are NaN where it is not usable.

    Raises
    ------
    InputError
        For a solver that does not exist or lacks a member of `ContactSolver`.
    """
    (film,) = _solver(solver).solve_line(contact, lubricant, (point.load,), point.entrainment_speed, point.temperature)
    return contact_solution(film, contact, point)


def solve_points(
    contact: LineContact | Sequence[LineContact],
    lubricant: Lubricant,
    points: xr.Dataset,
    solver: str | ContactSolver = "reynolds",
    *,
    workers: int = 1,
) -> xr.Dataset:
    """Solve one contact or several at many operating points.

    Parameters
    ----------
    contact : LineContact or sequence of LineContact
        The contacts; `BearingGeometry.contacts` gives those of a bearing.
    lubricant : Lubricant
        The oil.
    points : xarray.Dataset
        load [N/m], entrainment_speed [m/s] and temperature [K] over any dims. Each over a dim of its own gives all
        combinations, as in a map; all over one dim gives single points; a number stands for all points.
    solver : str or ContactSolver
        Name of a solver with its default settings, or a solver.
    workers : int
        Number of processes. A script that uses more than one needs the usual ``if __name__ == "__main__":``.

    Returns
    -------
    xarray.Dataset
        A dataset over contact and the dims of the points: the variables of a map file. A point without a solution has
        NaN, a status and a reason.

    Raises
    ------
    InputError
        For a solver that does not exist or lacks a member of `ContactSolver`, and with every value that is missing or
        not possible.
    """
    contacts = (contact,) if isinstance(contact, LineContact) else tuple(contact)
    return many.solve_points(contacts, lubricant, points, _solver(solver), workers)


def frequency_response(
    contact: LineContact | Sequence[LineContact],
    lubricant: Lubricant,
    point: OperatingPoint,
    frequencies: Sequence[float] | np.ndarray,
    solver: str | ContactSolver = "reynolds",
) -> xr.Dataset:
    """Response of one contact or several to a small oscillation, at many frequencies from one solution.

    Parameters
    ----------
    contact : LineContact or sequence of LineContact
        The contacts; `BearingGeometry.contacts` gives those of a bearing.
    lubricant : Lubricant
        The oil.
    point : OperatingPoint
        Load, entrainment speed and temperature.
    frequencies : sequence of float or ndarray, shape (k,)
        [Hz], > 0.
    solver : str or ContactSolver
        Name of a solver with its default settings, or a solver. Films of "hertz" and "formula" have no memory: the same
        film compliance and loss compliance at each frequency.

    Returns
    -------
    xarray.Dataset
        Response over contact and frequency, per unit length: `dynamic_stiffness` K = k + i omega c of film and solids,
        complex [N/m2], its parts `stiffness` [N/m2] and `damping` [N s/m2], `film_compliance` S, complex [m2/N], and
        `film_stiffness` 1/S, complex [N/m2], with 1/K = d(delta_el)/dw + S; estimated relative numerical errors;
        `omega_b_over_u`. Over contact: `slow_stiffness` and `slow_damping`, which a map has, `status` and `reason`. A
        contact without a solution has NaN.

    Raises
    ------
    InputError
        For frequencies that are not allowed, and for a solver that does not exist or lacks a member of `ContactSolver`.
    """
    contacts = (contact,) if isinstance(contact, LineContact) else tuple(contact)
    return spectrum_dataset(contacts, lubricant, point, frequencies, _solver(solver))


def _solver(solver: str | ContactSolver) -> ContactSolver:
    """The solver, made by its name."""
    return solvers.build(_known(solver), {}) if isinstance(solver, str) else solvers.complete(solver)


def _known(name: str) -> str:
    """Refuse the name of a solver that does not exist."""
    if name not in solvers.SOLVER_NAMES:
        raise InputError(f"solver: got {name!r}; allowed: {', '.join(solvers.SOLVER_NAMES)}")
    return name

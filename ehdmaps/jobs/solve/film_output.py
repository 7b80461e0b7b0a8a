"""Files with the film itself, beside the numbers of `ehdmaps solve`: its fields, and a page of pictures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ehdmaps.errors import Problems
from ehdmaps.extras import lacking
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.outputs import FIELDS, FIGURE, Output, output_problems
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.solution import ContactSolver, FilmSolution
from ehdmaps.units import LOAD, SPEED, TEMPERATURE


@dataclass(frozen=True)
class FilmOutputs:
    """The files that are asked for, checked before anything is solved.

    Attributes
    ----------
    fields : Path or None
        VTU or XDMF; with more than one contact the name of each is added.
    plot : Path or None
        The page of pictures.
    """

    fields: Path | None
    plot: Path | None

    def solve(self, solver: ContactSolver, job: Job, point: OperatingPoint) -> tuple[list[FilmSolution], list[str]]:
        """Solve a point for every contact and write the files.

        Parameters
        ----------
        solver : ContactSolver
            A solver with film fields.
        job : Job
            The job.
        point : OperatingPoint
            Load, speed and temperature.

        Returns
        -------
        films : list of FilmSolution
            One a contact.
        written : list of str
            What was written, in words.
        """
        from ehdmaps.jobs.solve.plots import FilmRow, films_figure, write_page
        from ehdmaps.openfoam.fields import write_fields
        from ehdmaps.openfoam.solver import OpenFoamSolver

        assert isinstance(solver, OpenFoamSolver)
        films: list[FilmSolution] = []
        rows: list[FilmRow] = []
        written: list[str] = []
        for contact in job.contacts:
            film, grid = solver.solve_fields(contact, job.lubricant, point, with_fields=True)
            films.append(film)
            if grid is None or grid.fields is None:
                written.append(f"{contact.name}: {film.status.word}, no film to write")
                continue
            if self.fields is not None:
                path = _fields_path(self.fields, contact.name, len(job.contacts))
                write_fields(grid.fields, path)
                written.append(f"{path}: written")
            half = float(half_width(point.load, contact.radius, contact.reduced_modulus))
            rows.append(FilmRow(contact.name, half, solver.surface_speeds(point.entrainment_speed), grid))
        if self.plot is not None and rows:
            temperature = TEMPERATURE.text(point.temperature).replace("degC", "°C")
            heading = (
                f"{job.title}, {job.lubricant.title}: {LOAD.text(point.load)}, {SPEED.text(point.entrainment_speed)}, "
                f"{temperature}; OpenFOAM, {solver.flow.replace('_', ' ')}"
            )
            write_page(self.plot, films_figure, rows, heading)
            written.append(f"{self.plot}: written")
        return films, written


def film_outputs(job: Job, fields: str | None, plot: str | None, read: str) -> FilmOutputs | None:
    """Check which files are asked for; None if there are none.

    Parameters
    ----------
    job : Job
        The job.
    fields : str or None
        File for the film's fields, if asked for.
    plot : str or None
        File for the figure, if asked for.
    read : str
        File of the job, which is not to be replaced.

    Raises
    ------
    InputError
        If the solver has no fields, a file may not be written, or the package that writes fields is missing; `read` is
        the file of the job.
    """
    problems = Problems(
        f"{option}: the solver {job.solver!r} has no fields across the film; allowed: with --solver openfoam{also}"
        for option, name, also in (
            ("--fields", fields, ""),
            ("--plot", plot, ", or --frequency FROM TO POINTS beside it"),
        )
        if name is not None and not solvers.SOLVERS[job.solver].keeps_cases
    )
    files = [Output("--plot", plot, FIGURE)]
    if fields is not None:
        problems += lacking("openfoam", "meshio", "--fields")
        contacts = [contact.name for contact in job.contacts]
        files += [Output("--fields", _fields_path(Path(fields), name, len(contacts)), FIELDS) for name in contacts]
    if not problems:
        problems += output_problems(files, [read])
    problems.check()
    if fields is None and plot is None:
        return None
    return FilmOutputs(Path(fields) if fields else None, Path(plot) if plot else None)


def _fields_path(path: Path, contact: str, contacts: int) -> Path:
    """Return the file of a contact."""
    return path.with_name(f"{path.stem}-{contact}{path.suffix}") if contacts > 1 and path.name else path

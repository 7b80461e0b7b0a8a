"""Files with the film itself, beside the numbers of `ehdmaps solve`: its fields, and a page of pictures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.operating_point import OperatingPoint
from ehdmaps.physics.solution import ContactSolver, FilmSolution
from ehdmaps.units import LOAD, SPEED, TEMPERATURE

PICTURES = (".png", ".pdf", ".svg")
"""Endings of a page of pictures."""


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

    def solve(
        self, solver: ContactSolver, job: Job, point: OperatingPoint, frequency: float
    ) -> tuple[list[FilmSolution], list[str]]:
        """Solve a point for every contact and write the files.

        Returns
        -------
        films : list of FilmSolution
            One a contact.
        written : list of str
            What was written, in words.
        """
        from ehdmaps.jobs.film_plot import FilmRow, plot_films
        from ehdmaps.openfoam.fields import write_fields
        from ehdmaps.openfoam.solver import OpenFoamSolver

        assert isinstance(solver, OpenFoamSolver)
        films: list[FilmSolution] = []
        rows: list[FilmRow] = []
        written: list[str] = []
        for contact in job.contacts:
            film, grid = solver.solve_fields(contact, job.lubricant, point, frequency, with_fields=True)
            films.append(film)
            if grid is None or grid.fields is None:
                written.append(f"{contact.name}: {film.status.word}, no film to write")
                continue
            if self.fields is not None:
                path = self.fields
                if len(job.contacts) > 1:
                    path = path.with_name(f"{path.stem}-{contact.name}{path.suffix}")
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
            try:
                plot_films(rows, heading, self.plot)
            except OSError as error:
                raise InputError(
                    f"--plot: {self.plot} cannot be written ({error.strerror}); "
                    "allowed: a file in a folder that may be written"
                ) from error
            written.append(f"{self.plot}: written")
        return films, written


def film_outputs(job: Job, fields: str | None, plot: str | None) -> FilmOutputs | None:
    """Check which files are asked for; None if there are none.

    Raises
    ------
    InputError
        If the solver has no fields, or a file has an unknown ending or no folder.
    """
    problems = []
    asked = {"--fields": (fields, (".vtu", ".xdmf")), "--plot": (plot, PICTURES)}
    for option, (name, endings) in asked.items():
        if name is None:
            continue
        path = Path(name)
        if not solvers.SOLVERS[job.solver].keeps_cases:
            problems.append(
                f"{option}: the solver {job.solver!r} has no fields across the film; allowed: with --solver openfoam"
            )
        elif path.suffix not in endings or not path.parent.is_dir():
            problems.append(f"{option}: got {name}; allowed: a {', '.join(endings)} file in a folder that exists")
    if problems:
        raise InputError(problems)
    if fields is None and plot is None:
        return None
    return FilmOutputs(Path(fields) if fields else None, Path(plot) if plot else None)

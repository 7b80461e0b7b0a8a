"""One point contact by `ehlFoam`: film, approach, stiffness and damping on two meshes, with a status.

A second solver of the equations of `ehdmaps.point`, with which it shares the oil and the ellipse alone: columns of
finite volume, mass conserved where the film ruptures, steps by a Krylov space. Isothermal, Newtonian, flooded, smooth,
rolling across the long axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiling import cpu_seconds
from ehdmaps.errors import InputError, Problems, SolverError
from ehdmaps.openfoam.case import working_case
from ehdmaps.openfoam.fields import FilmFields, read_point_fields
from ehdmaps.openfoam.installation import Installation, case_problems, installation
from ehdmaps.openfoam.point_case import (
    PointColumns,
    PointParameters,
    PointResults,
    read_point_columns,
    read_point_results,
)
from ehdmaps.openfoam.run import RunError, TimeLimit, log_tail, run
from ehdmaps.physics.closed_form import CONTINUUM, NO_CONTINUUM, THICK_NOTE, THIN_FILM_LIMIT, too_thick
from ehdmaps.physics.hertz import LARGEST_PRESSURE
from ehdmaps.physics.lubricant import Lubricant, LubricantState
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.point.film_formulas import hamrock_dowson_central, kapitza_film, point_groups
from ehdmaps.physics.rheology import wall_stress_note
from ehdmaps.physics.solution import Estimate, PointNumbers, Status, peak_sampling_error

ELLIPTICITIES = (1.0, 12.0)
"""Ellipticities that are solved; a little below a circle is one."""

LOAD_NUMBERS, LARGEST_OIL_NUMBER = (3.0, 2e4), 40.0
"""Moes' M and L that are tried; not every point is solved: circles fail above M of some thousands."""

MOST_ERROR = 0.3
"""Stated error of central film, film offset or stiffness above which both meshes tell different stories."""

MOST_COLUMNS = 8000
"""Columns of a mesh: each deflects each."""

COARSE = 1.5
"""Cells each way of the fine mesh over those of the coarse one."""

_CIRCLE = 1e-6


@dataclass(frozen=True, eq=False)
class PointFilm(PointNumbers):
    """One point contact by finite volumes.

    Attributes
    ----------
    status, reason
        Typed status, and its cause in words (empty for plain convergence).
    mesh : tuple of int
        Columns along the motion, lines beside it, rows across the film.
    columns : PointColumns or None
        The film over its columns.
    fields : FilmFields or None
        Fields in the cells, where asked for.
    """

    status: Status
    reason: str
    mesh: tuple[int, int, int] = (0, 0, 0)
    columns: PointColumns | None = field(default=None, repr=False)
    fields: FilmFields | None = field(default=None, repr=False)


@dataclass(frozen=True)
class OpenFoamPointSolver:
    """Point contacts by `ehlFoam`, a few seconds each.

    Attributes
    ----------
    columns, lines, rows : int
        Cells along the motion, beside it over half of the contact, and across the film.
    timeout : float
        Time of a point after which it is stopped and failed [s].
    keep_cases : Path or None
        Folder in which the cases are kept, with their fields.
    installed : Installation
        The programs; found if left out.

    Raises
    ------
    InputError
        If a setting is outside its range, or OpenFOAM or `ehlFoam` is missing.
    """

    columns: int = 96
    lines: int = 36
    rows: int = 6
    timeout: float = 120.0
    keep_cases: Path | None = None
    installed: Installation = field(default_factory=installation)

    def __post_init__(self) -> None:
        limits = {"columns": (36, 216), "lines": (18, 81), "rows": (2, 64), "timeout": (0.1, 1e6)}
        problems = Problems(
            f"openfoam point solver, {name}: got {getattr(self, name)!r}; allowed: {low:g} to {high:g}"
            for name, (low, high) in limits.items()
            if not low <= getattr(self, name) <= high
        )
        if not problems and self.columns * self.lines > MOST_COLUMNS:
            got = f"{self.columns} x {self.lines}"
            problems.append(f"openfoam point solver, columns, lines: got {got}; allowed: {MOST_COLUMNS} in all")
        problems += case_problems("openfoam point solver", self.keep_cases)
        problems.check()

    def solve(
        self,
        ellipse: Ellipse,
        lubricant: Lubricant,
        load: float,
        entrainment_speed: float,
        temperature: float,
        with_fields: bool = False,
        name: str = "point",
    ) -> PointFilm:
        """Solve one point contact; a point without a solution has a status that says so, and no numbers.

        Parameters
        ----------
        ellipse : Ellipse
            Radii and elastic modulus of the contact.
        lubricant : Lubricant
            The oil.
        load : float
            F [N].
        entrainment_speed : float
            Mean u of the two surface speeds, in the direction of x [m/s].
        temperature : float
            Temperature of both surfaces [K].
        with_fields : bool
            Whether to read the fields of the fine mesh.
        name : str
            Name of the folder, if cases are kept.

        Raises
        ------
        InputError
            If the oil has no temperature like that.
        """
        state = lubricant.at(temperature)
        refused = _beyond_reach(ellipse, load, entrainment_speed)
        if refused:
            return PointFilm(Status.OUTSIDE_VALIDITY, refused)
        M, L = point_groups(ellipse, state, load, entrainment_speed)
        refused = _beyond_groups(M, L)
        mesh = (self.columns, self.lines, self.rows)
        if refused:
            return PointFilm(Status.OUTSIDE_VALIDITY, refused, load_number=M, oil_number=L)
        asked = PointParameters(
            ellipse,
            load,
            entrainment_speed,
            state,
            _expected_film(ellipse, load, M, L),
            *mesh,
            write_fields=with_fields or self.keep_cases is not None,
        )
        began = cpu_seconds()
        try:
            results, columns, fields = self._run(asked, name, with_fields)
        except InputError as error:
            return PointFilm(Status.OUTSIDE_VALIDITY, str(error), load_number=M, oil_number=L)
        except SolverError as error:
            seconds = cpu_seconds() - began
            status, steps = (error.status, error.iterations) if isinstance(error, RunError) else (Status.FAILED, 0)
            return PointFilm(status, str(error), mesh, load_number=M, oil_number=L, steps=steps, solve_seconds=seconds)
        seconds = cpu_seconds() - began
        return _film(asked, (M, L), results, columns, fields, seconds)

    def _run(
        self, asked: PointParameters, name: str, with_fields: bool
    ) -> tuple[PointResults, PointColumns, FilmFields | None]:
        """One run in a folder of its own."""
        environment, limit = self.installed.full_environment(), TimeLimit(self.timeout)
        mesh = (asked.columns, asked.lines, asked.rows)
        folder = f"{name}_{'x'.join(map(str, mesh))}"
        with working_case(self.installed.template, asked.text(), folder, self.keep_cases) as case:
            log = run(self.installed.solver, case, environment, limit)
            try:
                results = read_point_results(case)
                if results.status is Status.CONVERGED:
                    fields = read_point_fields(case, *mesh) if with_fields else None
                    return results, read_point_columns(case, asked.columns, asked.lines), fields
            except SolverError as error:
                raise RunError(f"{error}; {log_tail(log)}") from error
            reason = f"ehlFoam {results.status.word}: {results.reason}; {log_tail(log)}"
            raise RunError(reason, results.status, results.iterations)


def _beyond_reach(ellipse: Ellipse, load: float, speed: float) -> str:
    """Reason why a contact is not tried; empty if it is."""
    if not (math.isfinite(load) and math.isfinite(speed) and load > 0.0 and speed > 0.0):
        return f"load {load:.4g} N, speed {speed:.4g} m/s: no film to solve by finite volumes; allowed: both above 0"
    peak, kappa = float(ellipse.max_pressure(load)), ellipse.ellipticity
    if not peak <= LARGEST_PRESSURE:
        return f"Hertz pressure {peak / 1e9:.3g} GPa above {LARGEST_PRESSURE / 1e9:g} GPa"
    if not ELLIPTICITIES[0] - _CIRCLE <= kappa <= ELLIPTICITIES[1]:
        return (
            f"ellipticity {kappa:.4g} outside of {ELLIPTICITIES[0]:g} to {ELLIPTICITIES[1]:g}, that of finite volumes"
        )
    return ""


def _beyond_groups(M: float, L: float) -> str:
    """Reason why groups are not tried; empty if they are."""
    if not LOAD_NUMBERS[0] <= M <= LOAD_NUMBERS[1]:
        return f"M = {M:.3g} outside of {LOAD_NUMBERS[0]:g} to {LOAD_NUMBERS[1]:g}, that of finite volumes"
    if not L <= LARGEST_OIL_NUMBER:
        return f"L = {L:.3g} above {LARGEST_OIL_NUMBER:g}, that of finite volumes"
    return ""


def _expected_film(ellipse: Ellipse, load: float, M: float, L: float) -> float:
    """Film h Rx/a^2 for which a mesh is laid at first: the thicker one of two formulas."""
    a = float(ellipse.semi_axes(load)[0]) / ellipse.rolling_radius
    # (a/Rx)^3 = q U^(3/4), and M, L in the groups of Hamrock and Dowson with U of twice the mean speed
    scale = 3.0 * M / (math.pi * ellipse.ellipticity * float(ellipse.numbers.pressure_factor))
    root = a**2 / scale ** (2.0 / 3.0)  # U^(1/2)
    kappa = max(ellipse.ellipticity, 1.0)
    elastic = hamrock_dowson_central(root**2 / 2.0, M * root**1.5, L / root**0.5, kappa)
    rigid = kapitza_film(M, float(ellipse.numbers.curvature_ratio)) * root
    return float(max(float(elastic), rigid) / a**2)


def _film(
    asked: PointParameters,
    moes: tuple[float, float],
    results: PointResults,
    columns: PointColumns,
    fields: FilmFields | None,
    seconds: float,
) -> PointFilm:
    """Numbers of the fine mesh, with errors from what both meshes differ by, or a refusal."""
    ellipse, load, state = asked.ellipse, asked.load, asked.oil
    left = 1.0 / (COARSE**2 - 1.0)

    def error(pair: tuple[float, ...]) -> float:
        """Error that a scheme of second order leaves on the fine mesh."""
        return left * abs(pair[1] - pair[0]) / max(abs(pair[1]), 1e-300)

    offset, central = results.film_offset[1], results.central_film[1]
    compliance, loss = results.compliance[1], results.loss_compliance[1]
    # of both films either may change its sign
    offset_error = error(results.film_offset)
    central_error = max(error(results.central_film), offset_error)
    # both change sign over load and oil: their differences say little alone
    compliance_error = max(1.5 * error(results.compliance), 0.5 * central_error)
    loss_error = max(2.0 * error(results.loss_compliance), 2.0 * central_error)
    least_error = error(results.minimum_film) + _between(columns.film)
    peak_error = error(results.max_pressure) + peak_sampling_error(columns.x, columns.pressure[:, 0], cusp=True)
    thick = too_thick(offset, ellipse.rolling_radius) or ellipse.too_wide(offset)
    errors = {"central film": central_error, "film offset": offset_error, "stiffness": compliance_error}
    worst, most = max(errors.items(), key=lambda each: each[1])
    physical = min(central, results.minimum_film[1], compliance) > 0.0
    mesh = (asked.columns, asked.lines, asked.rows)
    if thick or not physical or not most <= MOST_ERROR:
        reason = thick or f"not resolved: both meshes differ by {100.0 * most:.0f} % in the {worst}"
        return PointFilm(
            Status.OUTSIDE_VALIDITY,
            reason if physical or thick else "not resolved: no film, or no stiffness",
            mesh,
            load_number=moes[0],
            oil_number=moes[1],
            steps=results.iterations,
            solve_seconds=seconds,
        )
    status, notes = Status.CONVERGED, []
    if offset / ellipse.rolling_radius > THIN_FILM_LIMIT:
        status = Status.ASYMPTOTE
        notes.append(THICK_NOTE)
    notes.append(wall_stress_note(columns.x, columns.pressure[:, 0], columns.film[:, 0]))
    if results.minimum_film[1] < CONTINUUM:
        notes.append(NO_CONTINUUM)
    film_compliance = compliance - 1.0 / float(ellipse.stiffness(load))
    approach = float(ellipse.approach(load)) - offset
    return PointFilm(
        status,
        "; ".join(filter(None, notes)),
        mesh,
        load_number=moes[0],
        oil_number=moes[1],
        approach=Estimate(approach, offset_error * offset / max(abs(approach), 1e-300)),
        film_offset=Estimate(offset, offset_error),
        central_film=Estimate(central, central_error),
        minimum_film=Estimate(results.minimum_film[1], least_error),
        max_pressure=Estimate(results.max_pressure[1], peak_error),
        stiffness=Estimate(1.0 / compliance, compliance_error),
        damping=Estimate(loss / compliance**2, loss_error + 2.0 * compliance_error),
        film_compliance=Estimate(film_compliance, compliance_error * compliance / max(abs(film_compliance), 1e-300)),
        loss_compliance=Estimate(loss, loss_error),
        steps=results.iterations,
        solve_seconds=seconds,
        viscosity_extrapolated=_extrapolated(results.max_pressure[1] * (1.0 + peak_error), state),
        columns=columns,
        fields=fields,
    )


def _extrapolated(pressure: float, state: LubricantState) -> bool:
    """Tell whether a pressure lies beyond the fit of the viscosity."""
    return pressure > state.fitted_pressure


def _between(film: FloatArray) -> float:
    """Share of the smallest of all films by which one between columns may be smaller, as parabolas have it."""
    i, j = np.unravel_index(int(np.argmin(film)), film.shape)
    least, drop = float(film[i, j]), 0.0
    for line, k in ((film[:, j], int(i)), (film[i], int(j))):
        if 0 < k < line.size - 1:
            drop += float(line[k - 1] + line[k + 1] - 2.0 * line[k]) / 8.0
    return drop / least

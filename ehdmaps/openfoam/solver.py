"""The solver `openfoam`: every point on two grids by `ehlFoam`, a C++ solver of the film between elastic surfaces."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Protocol

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiling import cpu_seconds
from ehdmaps.errors import InputError, Problems, SolverError
from ehdmaps.openfoam.grid_solver import GridSolution, GridSolver
from ehdmaps.openfoam.grids import Grids, with_rows
from ehdmaps.openfoam.installation import Installation, case_problems, installation
from ehdmaps.openfoam.parameters import FLOWS, Flow, Heat, Mesh, Parameters, Start, isotherms
from ehdmaps.openfoam.results import FilmTable
from ehdmaps.openfoam.run import RunError, TimeLimit
from ehdmaps.physics.closed_form import THIN_FILM_LIMIT, HertzSolver, too_thick
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.films import film_times_rise, moes_central, rolling_force_of_inlet
from ehdmaps.physics.heat import ISOTHERMAL, THERMAL, extreme_note, heat_data
from ehdmaps.physics.hertz import DRY_COMPLIANCE, LARGEST_PRESSURE, half_width, max_pressure
from ehdmaps.physics.lubricant import Lubricant, LubricantState
from ehdmaps.physics.moes import film_from_moes, moes_groups
from ehdmaps.physics.rheology import ShearLaw, shear_law, wall_stress_note
from ehdmaps.physics.solution import (
    ContactSolverDefaults,
    FilmSolution,
    FilmSpectrum,
    Status,
    no_spectrum,
    peak_sampling_error,
    slow_spectrum,
)
from ehdmaps.physics.spectrum import neighbours, read_beside

CAVITATION_RANGE = 1e-6
"""Pressure over which liquid turns into the cavitated mixture, over the largest of the film (about)."""

LONGEST_INLET, LEAST_LENGTHS = 0.5, 3.0
"""Inlet with all stresses: where `ehlFoam` cuts it, over the radius, and its least length over sqrt(2 h R)."""

INLET_LIMITS = (5.0, 1e5)
"""Least and longest inlet over sqrt(2 h R); the film upstream of it is known in closed form."""

PARAMETER_VERSION = 9
"""Raised when a change of this package changes numbers: results of another version are not taken over."""

PHYSICS = (ISOTHERMAL, THERMAL)
"""What the solver may know of heat."""


class Guess(Protocol):
    """Guess that a start offers: a film, and places where the columns of cells should stand."""

    @property
    def x(self) -> FloatArray:
        """Positions from the contact centre [m]."""
        ...

    @property
    def pressure(self) -> FloatArray:
        """Pressure there [Pa]."""
        ...

    @property
    def central_film(self) -> float:
        """Film at the centre [m]."""
        ...

    @property
    def expected_film(self) -> float:
        """Film H = h R/b^2 about which a grid is laid."""
        ...

    @property
    def spike_position(self) -> float:
        """Pressure spike from the contact centre [b]."""
        ...

    @property
    def spike_width(self) -> float:
        """Width of the finest cells around it [b]; 0 where there is none."""
        ...


Starter = Callable[[LineContact, Lubricant, float, float, float, ShearLaw, float], Guess | None]
"""From contact, lubricant, load [N/m], entrainment speed [m/s], temperature [K], law of shear and slide-to-roll ratio
to a start; None where it has none."""


@dataclass(frozen=True)
class OpenFoamSolver(ContactSolverDefaults):
    """Film-resolved line contact with elastic surfaces; a point costs seconds.

    Each point is solved on a grid of half the cells each way, then on the grid itself from there; a third of the
    difference is the error estimate, as for a scheme of second order, and all of it of film and loss compliance, which
    come closer by half with twice the columns. With heat rows cost most, up to 3 % of a film: a thin one is also solved
    on half the columns with as many rows, and twice as many where it needs them; what the rows change is taken off, and
    counts as error, see `ehdmaps.openfoam.grids`.

    Attributes
    ----------
    flow : {"thin_film", "full_stress"}
        Stress of thin films, or all of it with the pressure across the film.
    columns, rows : int
        Cells along and across the film.
    physics : {"isothermal", "thermal"}
        Whether the film has the temperature of the surfaces, or the energy of the film is solved with the flow.
    shear : {"newtonian", "eyring", "carreau", "limiting"}
        Law of the shear stress, see `ehdmaps.physics.rheology`.
    shear_stress, limiting_ratio, carreau_exponent : float, optional
        tau0 [Pa], Lambda and n of that law; its defaults if left out.
    slide_to_roll : float
        (u_upper - u_lower)/u.
    inlet_length : float
        Length of the inlet in units of sqrt(2 h R).
    tolerance : float
        Relative, of the balances.
    max_iterations : int
        Number of iterations after which a run counts as stagnated.
    starter : callable, optional
        Gives a start to each point; without one it starts from the dry contact.
    timeout : float
        Time of a point, all grids together, after which it is stopped and failed, without that in which it waits for a
        processor [s].
    keep_cases : Path, optional
        Folder in which the cases of all runs are kept, with their fields.
    installed : Installation
        The programs; found if left out.

    Raises
    ------
    InputError
        If a setting is outside its range, or OpenFOAM or `ehlFoam` is missing.
    """

    flow: Flow = "thin_film"
    columns: int = 400
    rows: int = 6
    physics: str = ISOTHERMAL
    shear: str = "newtonian"
    shear_stress: float | None = None
    limiting_ratio: float | None = None
    carreau_exponent: float | None = None
    slide_to_roll: float = 0.0
    inlet_length: float = 20.0
    tolerance: float = 1e-9
    max_iterations: int = 100
    starter: Starter | None = None
    timeout: float = 120.0
    keep_cases: Path | None = None
    installed: Installation = field(default_factory=installation)

    slow = True

    def __post_init__(self) -> None:
        limits = {
            "columns": (40, 4000),
            "rows": (4, 64),
            "slide_to_roll": (-2.0, 2.0),
            "inlet_length": INLET_LIMITS,
            "tolerance": (1e-13, 1e-3),
            "max_iterations": (1, 100_000),
            "timeout": (0.1, 1e6),
        }
        problems = Problems(
            f"openfoam solver, {name}: got {getattr(self, name)!r}; allowed: {low:g} to {high:g}; "
            "leave it out for the default"
            for name, (low, high) in limits.items()
            if not low <= getattr(self, name) <= high
        )
        problems += [
            f"openfoam solver, {name}: got {getattr(self, name)}; allowed: an even number; its half is the coarse grid"
            for name in ("columns", "rows")
            if getattr(self, name) % 2
        ]
        problems += [
            f"openfoam solver, {name}: got {getattr(self, name)!r:.60}; allowed: {', '.join(words)}"
            for name, words in (("flow", FLOWS), ("physics", PHYSICS))
            if getattr(self, name) not in words
        ]
        if self.physics == THERMAL and not abs(self.slide_to_roll) < 2.0:
            problems.append(
                f"openfoam solver, slide_to_roll: got {self.slide_to_roll!r} with physics thermal; allowed: between -2 "
                "and 2 without both, since a surface that stands has no steady temperature"
            )
        with problems.after("openfoam solver, "):
            self.shear_law()
        problems += case_problems("openfoam solver", self.keep_cases)
        problems.check()

    def shear_law(self) -> ShearLaw:
        """Law of the shear stress, in Pa."""
        return shear_law(self.shear, self.shear_stress, self.limiting_ratio, self.carreau_exponent)

    @property
    def name(self) -> str:
        """Name of the solver."""
        return "openfoam"

    @property
    def version(self) -> str:
        """Text that tells results of one build from those of the next."""
        return f"{PARAMETER_VERSION}; {self.installed.version}"

    @property
    def provenance(self) -> dict[str, str]:
        """Further attributes of a map: OpenFOAM and the build."""
        return {"openfoam_version": self.installed.openfoam_version, "openfoam_build": self.installed.build}

    def settings(self) -> dict[str, float | int | str]:
        """Everything that changes the numbers; a longer timeout only makes more of them."""
        own = {"limiting_ratio": self.limiting_ratio, "carreau_exponent": self.carreau_exponent}
        law = self.shear_law()
        return {
            "flow": self.flow,
            "columns": self.columns,
            "rows": self.rows,
            **({} if self.physics == ISOTHERMAL else {"physics": self.physics}),
            "shear": self.shear,
            "shear_stress": 0.0 if self.shear == "newtonian" else law.stress,
            **{key: value for key, value in own.items() if value is not None},
            "slide_to_roll": self.slide_to_roll,
            "inlet_length": self.inlet_length,
            "tolerance": self.tolerance,
            "max_iterations": self.max_iterations,
            "start": "hertz" if self.starter is None else "reynolds",
        }

    def solve_line(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSolution, ...]:
        """Films at each load, each on its own; arguments as of `ContactSolver.solve_line`.

        A run that fails is a point with a status and its cause.
        """
        return tuple(
            self.solve_fields(contact, lubricant, OperatingPoint(load, entrainment_speed, temperature))[0]
            for load in loads
        )

    def film_spectrum(
        self, contact: LineContact, lubricant: Lubricant, point: OperatingPoint, frequencies: FloatArray
    ) -> FilmSpectrum:
        """Film of one point over frequency, from one run a grid; arguments as of `ContactSolver.film_spectrum`.

        Errors are those of columns and rows at the same frequency, as at rest, or what the Krylov space leaves of the
        equations.
        """
        where, index = np.unique(neighbours(frequencies), return_inverse=True)
        film, grids = self._solve(contact, lubricant, point, tuple(where.tolist()))
        if not film.status.usable:
            return no_spectrum(film, frequencies)
        if grids is None:
            return slow_spectrum(film, frequencies)
        compliance, *errors = grids.number(lambda grid: grid.results.complex_compliance[1:], order=1)
        errors = errors if grids.rows else errors[:1]
        index = index.reshape(frequencies.size, -1)
        read = [read_beside(error, where, index, frequencies) for error in errors]
        # at very high frequencies the Krylov space ends before its residual is small
        at_rest = abs(film.film_compliance) + 4.0 * DRY_COMPLIANCE / contact.reduced_modulus
        left = at_rest * np.array(grids.fine.results.response_residual)[1:][index[:, :1]]
        return FilmSpectrum(film, frequencies, compliance[index[:, 0]], np.hstack([*read, left, 1j * left]))

    def solve_fields(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        point: OperatingPoint,
        with_fields: bool = False,
    ) -> tuple[FilmSolution, GridSolution | None]:
        """Solve one point.

        Parameters
        ----------
        contact, lubricant, point
            What is solved.
        with_fields : bool
            Whether to read the fields of the fine grid.

        Returns
        -------
        film : FilmSolution
            Solution of the film, with status and cause where it failed.
        grid : GridSolution or None
            What the run on the fine grid gave; None where there is none.
        """
        film, grids = self._solve(contact, lubricant, point, (), with_fields)
        return film, None if grids is None else grids.fine

    def _solve(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        point: OperatingPoint,
        frequencies: tuple[float, ...],
        with_fields: bool = False,
    ) -> tuple[FilmSolution, Grids | None]:
        """One point with its responses at rest and at some frequencies [Hz]: film and grids."""
        if point.entrainment_speed == 0.0:
            (dry,) = HertzSolver().solve_line(contact, lubricant, (point.load,), 0.0, point.temperature)
            still = replace(dry, rolling_force=0.0, mass_flow=0.0, rolling_force_error=0.0, mass_flow_error=0.0)
            return replace(still, status=Status.ASYMPTOTE, reason="no entrainment: dry contact"), None
        peak = float(max_pressure(point.load, contact.radius, contact.reduced_modulus))
        if not peak <= LARGEST_PRESSURE:
            reason = f"Hertz pressure {peak / 1e9:.3g} GPa above {LARGEST_PRESSURE / 1e9:g} GPa"
            return FilmSolution(Status.OUTSIDE_VALIDITY, reason), None
        state = lubricant.at(point.temperature)
        began = cpu_seconds()
        stage, done = "coarse grid", 0
        try:
            fine = self.parameters(contact, lubricant, point, frequencies)
            limit = TimeLimit(self.timeout)  # from here: the first start of a process may compile for minutes
            short = self._inlet_too_short(contact, point, fine.mesh)
            if short:
                return FilmSolution(Status.OUTSIDE_VALIDITY, short), None
            halved = replace(fine, columns=fine.columns // 2, rows=fine.rows // 2)
            name = _case_name(contact, point)
            grids = GridSolver(self.installed, self.keep_cases)
            try:
                coarse = grids.solve(halved, name, False, limit)
            except RunError:
                if self.slide_to_roll == 0.0 or self.starter is None:
                    raise
                # the solver lets a film slide more and more, if it has the start of one that rolls
                fine = self.parameters(contact, lubricant, point, frequencies, rolling_start=True)
                halved = replace(fine, columns=fine.columns // 2, rows=fine.rows // 2)
                coarse = grids.solve(halved, name, False, limit)
            done = coarse.results.iterations
            stage = "fine grid"
            if self.physics == THERMAL and self.flow == "thin_film":
                solved = with_rows(grids, coarse, fine, name, with_fields, limit)
            else:
                solved = Grids(coarse, grids.solve(fine, name, with_fields, limit, coarse.start))
        except InputError as error:
            return FilmSolution(Status.OUTSIDE_VALIDITY, str(error)), None
        except SolverError as error:
            seconds = cpu_seconds() - began
            status, iterations = Status.FAILED, done
            if isinstance(error, RunError):
                status, iterations = error.status, done + error.iterations
            return FilmSolution(status, f"{stage}: {error}", iterations=iterations, solve_seconds=seconds), None
        seconds = cpu_seconds() - began
        newtonian = self.shear == "newtonian"
        return _film(contact, state, point.entrainment_speed, solved, seconds, newtonian), solved

    def parameters(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        point: OperatingPoint,
        frequencies: tuple[float, ...] = (),
        rolling_start: bool = False,
    ) -> Parameters:
        """Return the parameters of a run on the fine grid, with the starter's start if there is one.

        Parameters
        ----------
        contact : LineContact
            The contact.
        lubricant : Lubricant
            The oil.
        point : OperatingPoint
            Load, speed and temperature.
        frequencies : tuple of float
            Frequencies of small oscillations [Hz]; the low-frequency limit comes first in any case.
        rolling_start : bool
            Whether the start is that of pure rolling.
        """
        state = lubricant.at(point.temperature)
        guess = self.starter and self.starter(
            contact,
            lubricant,
            point.load,
            point.entrainment_speed,
            point.temperature,
            self.shear_law(),
            0.0 if rolling_start else self.slide_to_roll,
        )
        mesh = Mesh(film=_expected_film(contact, state, point), inlet_length=self.inlet_length)
        start = None
        if guess is not None:
            mesh = replace(
                mesh,
                film=guess.expected_film,
                spike_position=guess.spike_position,
                spike_width=guess.spike_width,
            )
            start = Start(guess.x, guess.pressure, guess.central_film)
        lower, upper = self.surface_speeds(point.entrainment_speed)
        peak = float(max_pressure(point.load, contact.radius, contact.reduced_modulus))
        return Parameters(
            reduced_radius=contact.radius,
            reduced_modulus=contact.reduced_modulus,
            load=point.load,
            lower_speed=lower,
            upper_speed=upper,
            oil=state,
            cavitation_range=CAVITATION_RANGE * peak / (1.0 + math.sqrt(2.0 * mesh.film)),
            mesh=mesh,
            columns=self.columns,
            rows=self.rows,
            flow=self.flow,
            shear=self.shear_law(),
            heat=self._heat(contact, lubricant, point.temperature),
            start=start,
            frequencies=(0.0, *frequencies),
            max_iterations=self.max_iterations,
            tolerance=self.tolerance,
        )

    def _heat(self, contact: LineContact, lubricant: Lubricant, temperature: float) -> Heat | None:
        """Data that the energy of the film is solved with; None where it is not."""
        if self.physics == ISOTHERMAL:
            return None
        return Heat(temperature, heat_data(lubricant, contact.material), isotherms(lubricant, temperature))

    def _inlet_too_short(self, contact: LineContact, point: OperatingPoint, mesh: Mesh) -> str:
        """Reason why a film is too thick for all stresses, whose inlet is cut; empty where it is not."""
        thickness = (
            mesh.film * (float(half_width(point.load, contact.radius, contact.reduced_modulus)) / contact.radius) ** 2
        )
        if self.flow == "thin_film" or 2.0 * thickness * LEAST_LENGTHS**2 < LONGEST_INLET**2:
            return ""
        lengths = LONGEST_INLET / math.sqrt(2.0 * thickness)
        return (
            f"film of {thickness:.2g} of the radius: {LONGEST_INLET:g} radii, where full_stress begins, are only "
            f"{lengths:.2g} lengths sqrt(2 h R) of inlet, below {LEAST_LENGTHS:g}; take flow thin_film"
        )

    def surface_speeds(self, entrainment_speed: float) -> tuple[float, float]:
        """Speeds of the lower and the upper surface [m/s]."""
        half = 0.5 * self.slide_to_roll
        return entrainment_speed * (1.0 - half), entrainment_speed * (1.0 + half)


def _case_name(contact: LineContact, point: OperatingPoint) -> str:
    """Name of a kept case."""
    place = f"w{point.load:.6g}_u{point.entrainment_speed:.6g}_T{point.temperature:.6g}"
    return f"{re.sub('[^A-Za-z0-9]', '_', contact.name)}_{place}"


def _expected_film(contact: LineContact, state: LubricantState, point: OperatingPoint) -> float:
    """Film H = h R/b^2 after Moes, for a grid without a better guess."""
    alpha, modulus = state.pressure_viscosity.pressure_viscosity, contact.reduced_modulus
    speed, radius = point.entrainment_speed, contact.radius
    M, L = moes_groups(point.load, speed, state.viscosity, alpha, radius, modulus)
    film = film_from_moes(moes_central(M, max(L, 1e-6)), speed, state.viscosity, radius, modulus)
    return float(film * radius / half_width(point.load, radius, modulus) ** 2)


def _film(
    contact: LineContact, state: LubricantState, speed: float, grids: Grids, seconds: float, newtonian: bool
) -> FilmSolution:
    """The solution with its errors, those of columns and of rows.

    To that of the largest pressure comes what a spike may rise above the columns beside it.
    """
    fine = grids.fine

    def along(index: int) -> tuple[float, float, float]:
        """Rolling force or mass flow, and its errors."""
        return grids.number(lambda grid: _rolling_force_and_flow(contact, state, speed, grid.film)[index])

    def of(name: str, order: int = 2) -> tuple[float, float, float]:
        """A number of the results, at rest, and its errors."""
        return grids.number(lambda grid: _at_rest(grid, name), order)

    def relative(value: float, columns: float, rows: float) -> float:
        """Error, > 0 where more columns lower the value."""
        return (columns + math.copysign(abs(rows), columns)) / value if value else math.nan

    rolling, flow = along(0), along(1)
    offset = of("film_offset")
    # from 400 to 1600 columns they come closer to those of the Reynolds equation by half each time, films by a quarter
    compliance, loss = (of(name, order=1) for name in ("film_compliance", "loss_compliance"))
    central, minimum, peak = of("central_film"), of("minimum_film"), of("max_pressure")
    hottest, surface = of("film_temperature"), of("surface_temperature")
    refused = too_thick(offset[0], contact.radius)
    if refused:
        return FilmSolution(Status.OUTSIDE_VALIDITY, refused, solve_seconds=seconds)
    status, notes = Status.CONVERGED, grids.notes
    if offset[0] / contact.radius > THIN_FILM_LIMIT:
        status = Status.ASYMPTOTE
        notes.append("film thicker than 1 % of the radius: the gap is that of a parabola")
    elif loss[0] < 0.0:
        notes.append("negative damping at the valley; a contact law takes zero")
    if newtonian:
        notes.append(wall_stress_note(fine.film.x, fine.film.pressure, fine.film.film))
    notes.append(extreme_note(surface[0], central[0]))
    largest_error = abs(relative(*peak)) + peak_sampling_error(fine.film.x, fine.film.pressure, cusp=True)
    return FilmSolution(
        status=status,
        reason="; ".join(filter(None, notes)),
        film_offset=offset[0],
        film_compliance=compliance[0],
        loss_compliance=loss[0],
        central_film=central[0],
        minimum_film=minimum[0],
        max_pressure=peak[0],
        rolling_force=rolling[0],
        mass_flow=flow[0],
        traction=of("traction")[0],
        wall_stress=of("wall_stress")[0],
        film_offset_error=relative(*offset),
        film_compliance_error=relative(*compliance),
        loss_compliance_error=relative(*loss),
        central_film_error=abs(relative(*central)),
        minimum_film_error=abs(relative(*minimum)),
        max_pressure_error=largest_error,
        rolling_force_error=abs(relative(*rolling)),
        mass_flow_error=abs(relative(*flow)),
        film_temperature=hottest[0],
        surface_temperature=surface[0],
        film_temperature_error=sum(map(abs, hottest[1:])),
        surface_temperature_error=sum(map(abs, surface[1:])),
        iterations=grids.iterations,
        solve_seconds=seconds,
        viscosity_extrapolated=peak[0] * (1.0 + largest_error) > state.fitted_pressure,
    )


def _at_rest(grid: GridSolution, name: str) -> float:
    """A number of a run; of those over frequency the first, at rest."""
    value = getattr(grid.results, name)
    return float(value[0] if isinstance(value, tuple) else value)


def _rolling_force_and_flow(
    contact: LineContact, state: LubricantState, speed: float, film: FilmTable
) -> tuple[float, float]:
    """Rolling force [N/m] and mass flow [kg/(m s)] of one grid; of the flows of all columns the one in the middle."""
    flow = float(np.median(film.flux))
    before = rolling_force_of_inlet(
        -float(film.x[0]),
        float(film.film[0]),
        flow / (state.density * speed),
        12.0 * state.viscosity * speed,
        contact.radius,
    )
    return film_times_rise(film.film, film.pressure) + before, flow

"""The solver `reynolds`: operating points in SI, one line of loads after another.

The groups of a point go to `line`, which knows no units; what comes back is scaled by b, p_H, b^2/R and b/u. What numba
compiles is loaded by the first solve: a solver that only stands behind the film table needs none of it.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiling import stopwatch
from ehdmaps.ehl.limits import SETTING_LIMITS, USUAL_DENSITY, GridShape, Resolution
from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.closed_form import (
    HEAVIEST_LOAD_NUMBER,
    LIGHTEST_LOAD_NUMBER,
    THICK_NOTE,
    THICKEST_FILM,
    THIN_FILM_LIMIT,
    too_thick,
)
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.heat import (
    INLET_HEAT,
    ISOTHERMAL,
    PHYSICS,
    THERMAL,
    extreme_note,
    heat_data,
    heated,
    heated_spectrum,
    inlet_heat,
)
from ehdmaps.physics.hertz import LARGEST_PRESSURE, half_width, max_pressure
from ehdmaps.physics.lubricant import Lubricant, LubricantState
from ehdmaps.physics.moes import moes_groups
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.rheology import CARREAU, LIMITING, NEWTONIAN, FilmProfile, ShearLaw, shear_law, wall_stress_note
from ehdmaps.physics.solution import (
    ContactSolverDefaults,
    FilmSolution,
    FilmSpectrum,
    Status,
    natural_to_hertz,
    no_spectrum,
    slow_spectrum,
)

if TYPE_CHECKING:
    from ehdmaps.ehl.group_solution import GroupSolution
    from ehdmaps.ehl.profile import Profile
    from ehdmaps.ehl.reynolds import LineProblem

LARGEST_OIL_NUMBER = 150.0
"""Moes' L above which no solve is tried."""

MOST_SLIP_OF_A_RULE = 0.1
"""Slide-to-roll ratio up to which sliding changes a film with heat by less than the rule of inlet heat is wrong by."""

NEWTONIAN_LAW = ShearLaw()


THINNEST_LAYER = 1e-6
"""Oil layer [b^2/R] below which the place of the meniscus, and the film, are below round-off of the deflection."""


@dataclass(frozen=True)
class SuppliedFilm:
    """The film of a contact that gets its oil from a layer, see `ReynoldsSolver.supplied_film`.

    Attributes
    ----------
    film : FilmSolution
        The film; film compliance and loss compliance are those with the meniscus held where it is.
    flow_ratio : float
        Oil that goes through the contact over what the flooded one takes; 1 where the layer brings enough, NaN where
        nothing flows or the flooded film has no solution.
    meniscus : float
        Distance of the meniscus before the contact centre [m], below zero behind it; inf where the contact is flooded,
        NaN where there is no solution.
    supplied_compliance : float
        Film compliance at a given layer [m2/N], the meniscus following until all of the layer goes through again; NaN
        where the contact is flooded or has no solution. It may be negative.
    profile : FilmProfile or None
        Pressure and film along the contact, from the meniscus on; None where there is no film or no solution.
    """

    film: FilmSolution
    flow_ratio: float = math.nan
    meniscus: float = math.nan
    supplied_compliance: float = math.nan
    profile: FilmProfile | None = None


@dataclass(frozen=True)
class ReynoldsSolver(ContactSolverDefaults):
    """Finite-difference solver of the steady line contact and of its linear response.

    Piezoviscous, compressible, with Reynolds' cavitation condition at the exit; isothermal and Newtonian unless chosen
    otherwise; fully flooded, but for `supplied_film`, which takes an oil layer before the contact.

    Attributes
    ----------
    density : float
        Cells per e-fold of distance from inlet, exit and spike; 6.5 gives about 90 cells a contact.
    inlet_length : float, optional
        Length of the inlet in units of sqrt(2 h R); left out it is 200 at the default density, and goes with the square
        of the density.
    tolerance : float
        Newton tolerance on the last (quadratic) step.
    thickest_film : float
        Largest h/R that is no refusal; infinite for lines that stand for their groups only.
    physics : {"isothermal", "inlet-heat", "thermal"}
        What films know of heat: nothing, that of the inlet by the rule of `ehdmaps.physics.heat`, or temperatures
        of film and surfaces, solved for besides.
    shear : str
        Law of shear, one of `ehdmaps.physics.rheology.SHEARS`.
    shear_stress, limiting_ratio, carreau_exponent : float, optional
        Numbers of the law, see `ehdmaps.physics.rheology.shear_law`.
    slide_to_roll : float
        (u_upper - u_lower)/u, -2 to 2.

    Raises
    ------
    InputError
        If a setting is outside its range.
    """

    density: float = USUAL_DENSITY
    inlet_length: float | None = None
    tolerance: float = 1e-6
    thickest_film: float = THICKEST_FILM
    physics: str = ISOTHERMAL
    shear: str = "newtonian"
    shear_stress: float | None = None
    limiting_ratio: float | None = None
    carreau_exponent: float | None = None
    slide_to_roll: float = 0.0

    def __post_init__(self) -> None:
        problems = Problems(
            f"reynolds solver, {name}: got {getattr(self, name)!r}; allowed: {low:g} to {high:g}; "
            "leave it out for the default"
            for name, (low, high) in SETTING_LIMITS.items()
            if (name, self.inlet_length) != ("inlet_length", None) and not low <= getattr(self, name) <= high
        )
        if self.physics not in PHYSICS:
            problems.append(f"reynolds solver, physics: got {self.physics!r:.60}; allowed: {', '.join(PHYSICS)}")
        if self.physics == INLET_HEAT and abs(self.slide_to_roll) > MOST_SLIP_OF_A_RULE:
            problems.append(
                f"reynolds solver, slide_to_roll: got {self.slide_to_roll:g} with physics {INLET_HEAT}, whose rule "
                f"knows no heat of sliding; allowed: {-MOST_SLIP_OF_A_RULE:g} to {MOST_SLIP_OF_A_RULE:g}"
            )
        with problems.after("reynolds solver, "):
            shear_law(self.shear, self.shear_stress, self.limiting_ratio, self.carreau_exponent)
        problems.check()

    @property
    def name(self) -> str:
        """Name of the solver."""
        return "reynolds"

    @cached_property
    def shear_law(self) -> ShearLaw:
        """Law of shear in SI."""
        return shear_law(self.shear, self.shear_stress, self.limiting_ratio, self.carreau_exponent)

    @property
    def wants_backbone(self) -> bool:
        """A map of this solver gets the lines that a contact law needs besides: they cost seconds."""
        return True

    @property
    def natural_frequencies(self) -> tuple[float, ...]:
        """Octaves over which the complex stiffness of a contact goes from that of slow motion to that of a locked film.

        They cost a sixth of a map's time. Maps of films with temperatures have none of them: they would take as long
        as these films. `film_spectrum` answers for those too.
        """
        return (0.5, 1.0, 2.0, 4.0, 8.0) if self.physics != THERMAL else ()

    @cached_property
    def resolution(self) -> Resolution:
        """The same settings, as the solve in groups takes them."""
        return Resolution(density=self.density, inlet_length=self.inlet_length, tolerance=self.tolerance)

    def settings(self) -> dict[str, float | int | str]:
        """Everything that changes the numbers."""
        shape = GridShape()
        return {
            "density": self.density,
            "inlet_length": self.resolution.inlet,
            "tolerance": self.tolerance,
            "grid_shape": f"{shape}",
            **({} if self.thickest_film == THICKEST_FILM else {"thickest_film": self.thickest_film}),
            **({} if self.physics == ISOTHERMAL else {"physics": self.physics}),
            **self._flow_settings,
        }

    @property
    def _flow_settings(self) -> dict[str, float | str]:
        """Settings of shear and heat where they change anything."""
        law = self.shear_law
        settings: dict[str, float | str] = {} if self.slide_to_roll == 0.0 else {"slide_to_roll": self.slide_to_roll}
        if law.form == NEWTONIAN:
            return settings
        settings |= {"shear": self.shear, "shear_stress": law.stress}
        if law.form == LIMITING:
            settings["limiting_ratio"] = law.ratio
        if law.form == CARREAU:
            settings["carreau_exponent"] = law.exponent
        return settings

    def _problem(
        self, contact: LineContact, lubricant: Lubricant, point: OperatingPoint, known: LubricantState | None = None
    ) -> tuple[LineProblem, float, float]:
        """Groups of one operating point, see `line_problem`; `known` is the oil there, where it is known already."""
        state, load, speed = known or lubricant.at(point.temperature), point.load, point.entrainment_speed
        problem, M, L = line_problem(contact, state, load, speed, self.shear_law, self.slide_to_roll)
        if self.physics != THERMAL:
            return problem, M, L
        half = float(half_width(load, contact.radius, contact.reduced_modulus))
        peak = float(max_pressure(load, contact.radius, contact.reduced_modulus))
        walls = speed * np.array([1.0 - 0.5 * self.slide_to_roll, 1.0 + 0.5 * self.slide_to_roll])
        data = heat_data(lubricant, contact.material)
        from ehdmaps.ehl.column import heat_groups

        heat = heat_groups(lubricant, data, point.temperature, half, contact.radius, peak, walls)
        return problem._replace(heat=heat), M, L

    def solve_line(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSolution, ...]:
        """Films at each load, each from the one before it; arguments as of `ContactSolver.solve_line`."""
        solved = self._solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        films = (film for film, _ in solved)
        if self.physics != INLET_HEAT:
            return tuple(films)
        points = (OperatingPoint(load, entrainment_speed, temperature) for load in loads)
        return tuple(
            heated(film, inlet_heat(contact, lubricant, point)) for film, point in zip(films, points, strict=True)
        )

    def line_spectra(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSpectrum, ...]:
        """The same films, each over frequency from its one solution; arguments as of `ContactSolver.line_spectra`."""
        solved = self._solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        if self.physics == THERMAL:
            return tuple(slow_spectrum(film, np.empty(0)) for film, _ in solved)
        spectra = []
        for load, (film, groups) in zip(loads, solved, strict=True):
            point = OperatingPoint(load, entrainment_speed, temperature)
            frequencies = natural_to_hertz(self.natural_frequencies, film, contact, point)
            spectrum = self._spectrum(contact, lubricant, point, film, groups, frequencies)
            spectra.append(self._with_inlet_heat(spectrum, contact, lubricant, point))
        return tuple(spectra)

    def _solve_line(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> Iterator[tuple[FilmSolution, GroupSolution | None]]:
        """Films at each load, each from the one before it, with their solutions in groups."""
        previous: Profile | None = None
        state = lubricant.at(temperature) if loads and entrainment_speed != 0.0 else None
        for load in loads:
            point = OperatingPoint(load, entrainment_speed, temperature)
            film, groups = self._solve(contact, lubricant, point, previous, state)
            previous = previous if groups is None else groups.profile
            yield film, groups

    def film_spectrum(
        self, contact: LineContact, lubricant: Lubricant, point: OperatingPoint, frequencies: FloatArray
    ) -> FilmSpectrum:
        """Film of one point over frequency, from one solution; arguments as of `ContactSolver.film_spectrum`."""
        film, groups = self._solve(contact, lubricant, point, None)
        spectrum = self._spectrum(contact, lubricant, point, film, groups, frequencies)
        return self._with_inlet_heat(spectrum, contact, lubricant, point)

    def _with_inlet_heat(
        self, spectrum: FilmSpectrum, contact: LineContact, lubricant: Lubricant, point: OperatingPoint
    ) -> FilmSpectrum:
        """An isothermal film over frequency, with heat in its inlet where that is asked for."""
        if self.physics != INLET_HEAT:
            return spectrum
        return heated_spectrum(spectrum, inlet_heat(contact, lubricant, point))

    def _spectrum(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        point: OperatingPoint,
        film: FilmSolution,
        groups: GroupSolution | None,
        frequencies: FloatArray,
    ) -> FilmSpectrum:
        """A solved film over frequency."""
        if not film.status.usable:
            return no_spectrum(film, frequencies)
        if groups is None:
            return slow_spectrum(film, frequencies)
        load, speed = point.load, point.entrainment_speed
        _, M, L = self._problem(contact, lubricant, point)
        half = float(half_width(load, contact.radius, contact.reduced_modulus))
        from ehdmaps.ehl.line import group_spectrum

        response = group_spectrum(M, L, groups, 2.0 * math.pi * frequencies * half / speed)
        unit = 4.0 / contact.reduced_modulus  # b/(p_H R)
        return FilmSpectrum(film, frequencies, unit * response.compliance, unit * response.errors)

    def film_profile(
        self, contact: LineContact, lubricant: Lubricant, point: OperatingPoint
    ) -> tuple[FilmSolution, FilmProfile | None]:
        """Solve one point, with pressure and film along it; None for these where there is no film or no solution.

        Parameters
        ----------
        contact : LineContact
            The contact.
        lubricant : Lubricant
            The oil.
        point : OperatingPoint
            Load, speed and temperature.
        """
        self._without_a_rule("profile of a film")
        film, groups = self._solve(contact, lubricant, point, None)
        return film, _profile_in_si(film, groups, contact, point.load)

    def supplied_film(
        self, contact: LineContact, lubricant: Lubricant, point: OperatingPoint, supply: OilSupply
    ) -> SuppliedFilm:
        """Solve one point behind an oil layer; where the layer brings enough, the film is that of `solve_line`.

        Where it does not, all of the layer goes through the contact, and the place of the inlet's meniscus follows from
        that. There is no side flow.

        Parameters
        ----------
        contact : LineContact
            The contact.
        lubricant : Lubricant
            The oil.
        point : OperatingPoint
            Load, speed and temperature.
        supply : OilSupply
            Oil layer before the contact.
        """
        from ehdmaps.ehl.meniscus import starved_groups
        from ehdmaps.ehl.newton import CONVERGED

        self._without_a_rule("film behind an oil layer")
        state = lubricant.at(point.temperature)
        film, flooded = self._solve(contact, lubricant, point, None)
        # a flooded film that is refused for its thickness still says how much oil it takes
        if flooded is None or flooded.outcome != CONVERGED:
            return SuppliedFilm(film)
        half = float(half_width(point.load, contact.radius, contact.reduced_modulus))
        peak = float(max_pressure(point.load, contact.radius, contact.reduced_modulus))
        layer = supply.oil_layer * contact.radius / half**2
        ratio = layer / flooded.mass_flow
        if ratio >= 1.0:
            profile = _profile_in_si(film, flooded, contact, point.load)
            return SuppliedFilm(film, flow_ratio=1.0, meniscus=math.inf, profile=profile)
        if layer < THINNEST_LAYER:
            reason = f"{supply.label}: {layer:.3g} b^2/R, below {THINNEST_LAYER:g} it is lost in round-off"
            return SuppliedFilm(FilmSolution(Status.OUTSIDE_VALIDITY, reason), ratio)
        if self.physics == THERMAL:
            reason = f"{supply.label}, {ratio:.3g} of the flooded flow: starved films are isothermal ones only"
            return SuppliedFilm(FilmSolution(Status.OUTSIDE_VALIDITY, reason), ratio)
        _, M, L = self._problem(contact, lubricant, point, state)
        watch = stopwatch()
        starved = starved_groups(M, L, self.resolution, layer, flooded)
        seconds = film.solve_seconds + watch()
        groups = starved.solution
        if groups.outcome != CONVERGED:
            reason = f"{supply.label}, {ratio:.3g} of the flooded flow: no place found for the meniscus"
            unsolved = FilmSolution(Status.STAGNATED, reason, iterations=groups.steps, solve_seconds=seconds)
            return SuppliedFilm(unsolved, ratio)
        film = _in_si(groups, contact, state, half, peak, point.entrainment_speed, seconds)
        return SuppliedFilm(
            film,
            flow_ratio=ratio,
            meniscus=-half * starved.meniscus,
            supplied_compliance=starved.supplied_compliance * half / (peak * contact.radius),
            profile=_profile_in_si(film, groups, contact, point.load),
        )

    def _without_a_rule(self, what: str) -> None:
        """Refuse what the rule of heat in the inlet says nothing of."""
        if self.physics == INLET_HEAT:
            raise InputError(
                f"reynolds solver, physics: got {INLET_HEAT!r} for the {what}, of which its rule says nothing; "
                f"allowed: {ISOTHERMAL}"
            )

    def _solve(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        point: OperatingPoint,
        previous: Profile | None,
        known: LubricantState | None = None,
    ) -> tuple[FilmSolution, GroupSolution | None]:
        """One point, and its solution in groups where it was solved; `known` is the oil there, where it is known."""
        load, speed = point.load, point.entrainment_speed
        peak = float(max_pressure(load, contact.radius, contact.reduced_modulus))
        if speed == 0.0:
            return dry_film(peak, "no entrainment: dry contact"), None
        state = known or lubricant.at(point.temperature)
        problem, M, L = self._problem(contact, lubricant, point, state)
        beyond = _beyond_reach(peak, M, L)
        if beyond:
            return FilmSolution(Status.OUTSIDE_VALIDITY, beyond), None
        from ehdmaps.ehl.line import solve_groups
        from ehdmaps.ehl.newton import CONVERGED, DIVERGED

        watch = stopwatch()
        groups = solve_groups(problem, M, L, self.resolution, previous)
        seconds = watch()
        if groups.outcome != CONVERGED:
            word = "diverged" if groups.outcome == DIVERGED else "stagnated"
            status = Status.DIVERGED if groups.outcome == DIVERGED else Status.STAGNATED
            reason = f"Newton {word} at M = {M:.4g}, L = {L:.4g} on every grid tried"
            return FilmSolution(status, reason, iterations=groups.steps, solve_seconds=seconds), groups
        half = float(half_width(load, contact.radius, contact.reduced_modulus))
        film = _in_si(groups, contact, state, half, peak, speed, seconds)
        refused = too_thick(film.film_offset, contact.radius, self.thickest_film)
        if refused:
            film = FilmSolution(
                Status.OUTSIDE_VALIDITY, refused, iterations=film.iterations, solve_seconds=film.solve_seconds
            )
        return film, groups


def line_problem(
    contact: LineContact,
    state: LubricantState,
    load: float,
    speed: float,
    shear: ShearLaw = NEWTONIAN_LAW,
    slide_to_roll: float = 0.0,
) -> tuple[LineProblem, float, float]:
    """Groups of one operating point: those of the equations, and Moes' M and L.

    Parameters
    ----------
    contact : LineContact
        The contact.
    state : LubricantState
        The oil at the temperature of the point.
    load : float
        w [N/m].
    speed : float
        u [m/s].
    shear : ShearLaw
        Law of shear in SI.
    slide_to_roll : float
        (u_upper - u_lower)/u.
    """
    from ehdmaps.ehl.reynolds import LineProblem

    alpha = state.pressure_viscosity.pressure_viscosity
    peak = float(max_pressure(load, contact.radius, contact.reduced_modulus))
    M, L = moes_groups(load, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
    half = float(half_width(load, contact.radius, contact.reduced_modulus))
    # an absurd point has none, and is refused for its groups
    stress = max(state.viscosity * speed * contact.radius / half**2, sys.float_info.min)
    wedge = 3.0 * math.pi**2 / (8.0 * M * M)
    return LineProblem(wedge, state.isotherm(peak), shear.scaled(stress, peak), slide_to_roll), float(M), L


def dry_film(peak: float, reason: str) -> FilmSolution:
    """The limit u = 0: no film, no loss, Hertz' pressure."""
    return FilmSolution(
        status=Status.ASYMPTOTE,
        reason=reason,
        film_offset=0.0,
        film_compliance=0.0,
        loss_compliance=0.0,
        central_film=0.0,
        minimum_film=0.0,
        max_pressure=peak,
        rolling_force=0.0,
        mass_flow=0.0,
        film_offset_error=0.0,
        film_compliance_error=0.0,
        loss_compliance_error=0.0,
        central_film_error=0.0,
        minimum_film_error=0.0,
        max_pressure_error=0.0,
        rolling_force_error=0.0,
        mass_flow_error=0.0,
        traction=0.0,
        wall_stress=0.0,
    )


def _profile_in_si(
    film: FilmSolution, groups: GroupSolution | None, contact: LineContact, load: float
) -> FilmProfile | None:
    """Pressure and film along a contact; None where there is no film or no solution."""
    profile = None if groups is None else groups.profile
    if profile is None or not film.status.usable:
        return None
    half = float(half_width(load, contact.radius, contact.reduced_modulus))
    peak = float(max_pressure(load, contact.radius, contact.reduced_modulus))
    return FilmProfile(half * profile.position, peak * profile.pressure, half**2 / contact.radius * profile.film)


def _beyond_reach(peak: float, M: float, L: float) -> str:
    """Reason why a point is not even tried; empty if it is."""
    if not (math.isfinite(M) and math.isfinite(L) and M > 0.0):
        return f"groups M = {M:.4g}, L = {L:.4g} are not finite: load, speed or viscosity is absurd"
    if peak > LARGEST_PRESSURE:
        return f"Hertz pressure {peak / 1e9:.3g} GPa above {LARGEST_PRESSURE / 1e9:g} GPa"
    if M < LIGHTEST_LOAD_NUMBER:
        return f"M = {M:.3g} below {LIGHTEST_LOAD_NUMBER:g}: the elastic deflection is below round-off of the film"
    if M > HEAVIEST_LOAD_NUMBER:
        return f"M = {M:.3g} above {HEAVIEST_LOAD_NUMBER:g}: the film is below round-off of the elastic deflection"
    if L > LARGEST_OIL_NUMBER:
        return f"L = {L:.3g} above {LARGEST_OIL_NUMBER:g}"
    return ""


def _in_si(
    groups: GroupSolution,
    contact: LineContact,
    state: LubricantState,
    half: float,
    peak: float,
    speed: float,
    seconds: float,
) -> FilmSolution:
    """Scale films by b^2/R, the compliance by b/(p_H R), the loss by b^2/(p_H R u), the rolling force by p_H b^2/R."""
    profile = groups.profile
    assert profile is not None
    newtonian = profile.problem.shear.form == NEWTONIAN
    heat = profile.problem.heat
    film = half * half / contact.radius
    compliance = half / (peak * contact.radius)
    status, notes = Status.CONVERGED, []
    thickness = groups.film_offset * film / contact.radius
    if thickness > THIN_FILM_LIMIT:
        status = Status.ASYMPTOTE
        notes.append(THICK_NOTE)
    elif groups.loss < 0.0:
        kind = " of an isothermal, Newtonian film" if newtonian and profile.warmth is None else ""
        notes.append(f"negative damping at the valley{kind}; a contact law takes zero")
    stress = state.viscosity * speed / film
    if newtonian:
        notes.append(wall_stress_note(profile.position * half, profile.pressure * peak, profile.film * film))
    # isothermal films have the NaN of the others: films without temperatures are equal
    hottest = math.nan if math.isnan(groups.surface_rise) else heat.temperature + groups.surface_rise
    notes.append(extreme_note(hottest, groups.central_film * film))
    return FilmSolution(
        status=status,
        reason="; ".join(filter(None, notes)),
        film_offset=groups.film_offset * film,
        film_compliance=groups.film_compliance * compliance,
        loss_compliance=groups.loss * compliance * half / speed,
        central_film=groups.central_film * film,
        minimum_film=groups.minimum_film * film,
        max_pressure=groups.max_pressure * peak,
        rolling_force=groups.rolling_force * film * peak,
        mass_flow=groups.mass_flow * film * state.density * speed,
        film_offset_error=groups.film_offset.error,
        film_compliance_error=groups.film_compliance.error,
        loss_compliance_error=groups.loss.error,
        central_film_error=groups.central_film.error,
        minimum_film_error=groups.minimum_film.error,
        max_pressure_error=groups.max_pressure.error,
        rolling_force_error=groups.rolling_force.error,
        mass_flow_error=groups.mass_flow.error,
        film_temperature=math.nan if math.isnan(groups.film_rise) else heat.temperature + groups.film_rise,
        surface_temperature=hottest,
        film_temperature_error=groups.film_rise_error,
        surface_temperature_error=groups.surface_rise_error,
        traction=profile.traction * stress * half,
        wall_stress=profile.wall_stress * stress,
        iterations=groups.steps,
        solve_seconds=seconds,
        viscosity_extrapolated=groups.max_pressure * peak * (1.0 + groups.max_pressure.error) > state.fitted_pressure,
    )

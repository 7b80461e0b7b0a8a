"""Result of a solver: the film of one contact at one operating point, and the contact made of film and solids.

A solver knows the film only (`FilmSolution`, and over frequency `FilmSpectrum`). `contact_solution` adds the structural
part, which is the same law for every solver, and gives the numbers of the map (`ContactSolution`).

The largest pressure of a film is that of a grid point. Where a cold or loaded oil makes a sharp spike, its tip is 1e-5
half-widths wide and less: it stands higher on every finer grid. `peak_sampling_error` bounds by how much. Against grids
of two to four times the density of cells, and tips resolved to 1e-6 half-widths, it did so at 252 of 254 spikes (FVA 3
and an oil ISO VG 320 at 0 to 120 degC, NU308 and N1014; the oils of `tests.benchmarks.bench_spikes`). Where it is above
`SHARP`, what was missing was a quarter of it in the median, less than half of it at 85 %, and 130 % of the pressure at
most; elsewhere 4 % of the pressure at most.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from enum import IntEnum
from typing import Protocol

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray
from ehdmaps.physics.contact import LineContact, OperatingPoint, structured
from ehdmaps.physics.hertz import natural_time
from ehdmaps.physics.lubricant import Lubricant

SHARP = 0.1
"""Stated error of a largest pressure above which that is missing of the tip of a sharp spike."""


def tip_words(error: float) -> str:
    """Say what a largest pressure lacks of the tip of a sharp spike; empty where there is none.

    Parameters
    ----------
    error : float
        Stated error of the pressure, or the largest one of several; NaN where none is known.

    Examples
    --------
    >>> tip_words(1.0516)
    'largest pressure: of a grid point; the tip of a sharp spike is higher, by 105 % at most, mostly less than half'
    >>> tip_words(0.01)
    ''
    """
    if not error > SHARP:
        return ""
    missing = f"by {100.0 * error:.0f} % at most, mostly less than half"
    return f"largest pressure: of a grid point; the tip of a sharp spike is higher, {missing}"


def peak_sampling_error(position: FloatArray, pressure: FloatArray, cusp: bool) -> float:
    """Share of the largest sampled pressure by which the peak between the places may rise above it.

    Parameters
    ----------
    position, pressure : array (n,)
        Rising places, and pressures there that are not negative; any units.
    cusp : bool
        Whether a peak may be a cusp, as the pressure spike of a piezoviscous oil is: half a step at the steeper of the
        slopes beside each local maximum then bounds it. Else the parabola through three places gives it.

    Examples
    --------
    The parabola 1 - x^2, sampled beside its top:

    >>> x = np.array([-0.9, -0.4, 0.1, 0.6])
    >>> round(0.99 * (1.0 + peak_sampling_error(x, 1.0 - x * x, cusp=False)), 12)
    1.0
    """
    tops = 1 + np.flatnonzero((pressure[1:-1] >= pressure[:-2]) & (pressure[1:-1] >= pressure[2:]))
    highest = float(np.max(pressure))
    if tops.size == 0 or highest <= 0.0:
        return 0.0
    top = highest
    for i in tops:
        left, right = position[i] - position[i - 1], position[i + 1] - position[i]
        rise, fall = (pressure[i] - pressure[i - 1]) / left, (pressure[i + 1] - pressure[i]) / right
        slope, curvature = (rise * right + fall * left) / (left + right), 2.0 * (fall - rise) / (left + right)
        above = 0.0
        if cusp:
            above = 0.5 * max(rise * right, -fall * left)
        elif curvature < 0.0:
            above = -0.5 * slope**2 / min(curvature, -1e-300)
        top = max(top, float(pressure[i] + above))
    return top / highest - 1.0


class Estimate(float):
    """A number with its estimated numerical error, relative to it.

    It is the number: what is reckoned from it is a plain one, whose error has to be found anew.

    Parameters
    ----------
    value : float
        The number.
    error : float
        Error over its size; NaN where that is not known.

    Examples
    --------
    >>> film = Estimate(0.45e-6, 0.02)
    >>> film, film.error, type(2.0 * film) is float
    (4.5e-07, 0.02, True)
    """

    __slots__ = ("_error",)
    _error: float

    def __new__(cls, value: float, error: float) -> Estimate:
        """Keep both."""
        self = super().__new__(cls, value)
        self._error = float(error)
        return self

    @property
    def error(self) -> float:
        """Error over its size."""
        return self._error

    def __reduce__(self) -> tuple[type[Estimate], tuple[float, float]]:
        """For other processes."""
        return Estimate, (float(self), self._error)


UNKNOWN = Estimate(math.nan, math.nan)
"""A number that was not found."""


class Status(IntEnum):
    """Outcome of solving a point; the values are the flag_values of the map file."""

    CONVERGED = 0
    ASYMPTOTE = 1
    STAGNATED = 2
    DIVERGED = 3
    OUTSIDE_VALIDITY = 4
    FAILED = 5

    @property
    def usable(self) -> bool:
        """Tell whether the numbers of such a point may be used."""
        return self in (Status.CONVERGED, Status.ASYMPTOTE)

    @property
    def word(self) -> str:
        """The status as written in files and tables."""
        return self.name.lower()


def usable_points(status: npt.ArrayLike) -> BoolArray:
    """True where the numbers of points may be used, in the shape of their statuses.

    Parameters
    ----------
    status : array_like of int
        Values of `Status`.
    """
    return np.isin(status, [int(each) for each in Status if each.usable])


@dataclass(frozen=True, eq=False, kw_only=True)
class PointNumbers:
    """Numbers of a point contact, by whichever solver, with their errors; NaN where the status is not usable.

    Attributes
    ----------
    load_number, oil_number : float
        Moes' M and L.
    approach : float
        Dry approach less the film offset [m], > 0 when the bodies come together.
    film_offset : float
        h_eff, dry less lubricated approach at equal load [m].
    stiffness : float
        k = dF/d(approach) [N/m], in the limit of slow motion.
    damping : float
        c [N s/m], in the same limit.
    film_compliance : float
        1/k - 1/k_dry [m/N].
    loss_compliance : float
        c/k^2 [m s/N].
    central_film, minimum_film : float
        h at the centre, smallest h [m].
    max_pressure : float
        [Pa]; by finite volumes the largest mean of a column.
    steps : int
        Newton steps, all grids and starts together.
    solve_seconds : float
        Processor time.
    viscosity_extrapolated : bool
        The pressure left the range in which the viscosity law was fitted.
    """

    load_number: float = math.nan
    oil_number: float = math.nan
    approach: Estimate = UNKNOWN
    film_offset: Estimate = UNKNOWN
    stiffness: Estimate = UNKNOWN
    damping: Estimate = UNKNOWN
    film_compliance: Estimate = UNKNOWN
    loss_compliance: Estimate = UNKNOWN
    central_film: Estimate = UNKNOWN
    minimum_film: Estimate = UNKNOWN
    max_pressure: Estimate = UNKNOWN
    steps: int = 0
    solve_seconds: float = 0.0
    viscosity_extrapolated: bool = False


@dataclass(frozen=True)
class FilmSolution:
    """The film of one contact: what lubrication adds to the dry solids. NaN where the status is not usable.

    Attributes
    ----------
    status, reason
        Typed status, and its cause in words (empty for plain convergence).
    film_offset : float
        h_eff = dry minus lubricated approach at equal load [m].
    film_compliance : float
        -d(h_eff)/dw = 1/k - 1/k_dry [m2/N], in the limit of slow motion.
    loss_compliance : float
        c/k^2 [m2 s/N], in the same limit.
    central_film, minimum_film : float
        h at the contact centre, smallest h [m].
    max_pressure : float
        [Pa].
    rolling_force : float
        Int h dp/dx dx, what both walls feel together against pure rolling [N/m]; the film takes the power
        rolling_force u per length. See `ehdmaps.physics.films`.
    mass_flow : float
        Mass of oil that goes through the contact, per length and time [kg/(m s)].
    film_offset_error, film_compliance_error, loss_compliance_error : float
        Estimated numerical errors, relative to the value beside them; positive where the value is too large, so that
        errors of compliance and loss that come from one cause can cancel in the damping. NaN where the solver states
        none.
    central_film_error, minimum_film_error, max_pressure_error, rolling_force_error, mass_flow_error : float
        The same without a sign.
    traction : float
        Force between the surfaces from sliding, the mean of both walls, of the sign of the slide-to-roll ratio [N/m];
        zero in pure rolling, NaN where the solver does not find it.
    wall_stress : float
        Largest shear stress at a wall [Pa]; NaN where the solver does not find it.
    film_temperature, surface_temperature : float
        Highest temperature in the film and of its surfaces [K]; NaN of an isothermal film.
    film_temperature_error, surface_temperature_error : float
        Their estimated numerical errors [K].
    iterations : int
        Newton steps (or the solver's own count), all grids together.
    solve_seconds : float
        Processor time without that of compiling [s].
    viscosity_extrapolated : bool
        The pressure left the range in which the viscosity law was fitted.
    """

    status: Status
    reason: str = ""
    film_offset: float = math.nan
    film_compliance: float = math.nan
    loss_compliance: float = math.nan
    central_film: float = math.nan
    minimum_film: float = math.nan
    max_pressure: float = math.nan
    rolling_force: float = math.nan
    mass_flow: float = math.nan
    film_offset_error: float = math.nan
    film_compliance_error: float = math.nan
    loss_compliance_error: float = math.nan
    central_film_error: float = math.nan
    minimum_film_error: float = math.nan
    max_pressure_error: float = math.nan
    rolling_force_error: float = math.nan
    mass_flow_error: float = math.nan
    traction: float = math.nan
    wall_stress: float = math.nan
    film_temperature: float = math.nan
    surface_temperature: float = math.nan
    film_temperature_error: float = math.nan
    surface_temperature_error: float = math.nan
    iterations: int = 0
    solve_seconds: float = 0.0
    viscosity_extrapolated: bool = False


@dataclass(frozen=True)
class FilmSpectrum:
    """The film of one contact over frequency.

    Attributes
    ----------
    film : FilmSolution
        The film in the limit of slow motion, with status and reason.
    frequencies : ndarray, shape (k,)
        [Hz], > 0.
    compliance : ndarray, shape (k,)
        Film compliance S, complex [m2/N]: its imaginary part is minus omega times the loss compliance. NaN where the
        film has no solution.
    errors : ndarray, shape (k, m)
        Estimates of the numerical error of S, complex and signed [m2/N]; of m estimates the one with the largest effect
        counts. NaN where the solver states none.
    """

    film: FilmSolution
    frequencies: FloatArray
    compliance: ComplexArray
    errors: ComplexArray

    @property
    def largest_error(self) -> FloatArray:
        """Largest estimate of the error at each frequency, relative to the magnitude of S, shape (k,)."""
        largest, size = np.max(np.abs(self.errors), axis=1), np.abs(self.compliance)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(largest == 0.0, 0.0, largest / size)


@dataclass(frozen=True)
class ContactSolution(FilmSolution):
    """One point of a map: films, approach, stiffness and damping of one contact, per unit length.

    Attributes
    ----------
    approach : float
        delta_el(w) - h_eff [m], > 0 when the bodies come together.
    stiffness : float
        k = dw/d(approach) [N/m2].
    damping : float
        c [N s/m2].
    stiffness_error, damping_error : float
        Estimated relative numerical errors.

    The other attributes are those of `FilmSolution`; errors have no sign here but that of the loss, which is positive
    where it has the sign of the error of the film compliance: the two can cancel in the damping.
    """

    approach: float = math.nan
    stiffness: float = math.nan
    damping: float = math.nan
    stiffness_error: float = math.nan
    damping_error: float = math.nan


class ContactSolverDefaults(Protocol):
    """Answers that most solvers give about themselves, to inherit from: a quick solver, known by its sources.

    A solver overrides what is different for it, by a property or by an attribute of its class such as ``slow = True``.
    """

    @property
    def slow(self) -> bool:
        """True where a point takes seconds or more: each is then a task of its own, and is kept at once."""
        return False

    @property
    def version(self) -> str | None:
        """Mark that tells results of one version from those of the next; None for a hash of the solver's sources."""
        return None

    @property
    def wants_backbone(self) -> bool:
        """Tell whether its maps get the lines that a contact law needs besides."""
        return False

    @property
    def natural_frequencies(self) -> tuple[float, ...]:
        """omega sqrt(b^2 + 2 h R)/u at which the backbone of its maps holds the film compliance; none if empty."""
        return ()

    @property
    def provenance(self) -> Mapping[str, str]:
        """Further attributes of its maps, by name."""
        return {}

    def film_spectrum(
        self: ContactSolver,
        contact: LineContact,
        lubricant: Lubricant,
        point: OperatingPoint,
        frequencies: FloatArray,
    ) -> FilmSpectrum:
        """Film of one point that oscillates a little, over frequency; one without a memory is the same at each.

        Parameters
        ----------
        contact : LineContact
            The contact.
        lubricant : Lubricant
            The oil.
        point : OperatingPoint
            Load, speed and temperature.
        frequencies : ndarray, shape (k,)
            [Hz], > 0.
        """
        (film,) = self.solve_line(contact, lubricant, (point.load,), point.entrainment_speed, point.temperature)
        return slow_spectrum(film, frequencies)

    def line_spectra(
        self: ContactSolver,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSpectrum, ...]:
        """Films of `solve_line`, each over `natural_frequencies`.

        Parameters
        ----------
        contact, lubricant, loads, entrainment_speed, temperature
            The arguments of `ContactSolver.solve_line`.
        """
        spectra = []
        for load, film in zip(
            loads, self.solve_line(contact, lubricant, loads, entrainment_speed, temperature), strict=True
        ):
            point = OperatingPoint(load, entrainment_speed, temperature)
            at = natural_to_hertz(self.natural_frequencies, film, contact, point)
            found = self.film_spectrum(contact, lubricant, point, at) if film.status.usable else no_spectrum(film, at)
            spectra.append(replace(found, film=film))
        return tuple(spectra)


class ContactSolver(ContactSolverDefaults, Protocol):
    """Interface of every solver: films along a line of loads, so that a point may start from the one before it.

    `solve_line` never raises for a point that does not converge: it returns the status. It is deterministic: the same
    line gives the same numbers, whatever was solved before.

    A solver has every member; a class that inherits from `ContactSolverDefaults` writes `name`, `solve_line` and
    `settings` only, and `film_spectrum` where its films have a memory.
    """

    @property
    def name(self) -> str:
        """Name of the solver, as in a job file."""
        ...

    def solve_line(
        self,
        contact: LineContact,
        lubricant: Lubricant,
        loads: tuple[float, ...],
        entrainment_speed: float,
        temperature: float,
    ) -> tuple[FilmSolution, ...]:
        """Films at each load [N/m], in the order given, at one speed [m/s] and temperature [K].

        Parameters
        ----------
        contact : LineContact
            The contact.
        lubricant : Lubricant
            The oil.
        loads : tuple of float
            Loads w [N/m], in the order in which the films are returned.
        entrainment_speed : float
            u [m/s].
        temperature : float
            Temperature of both surfaces [K].
        """
        ...

    def settings(self) -> dict[str, float | int | str]:
        """Everything that changes the numbers, by name; goes into the map's attributes and the store's key."""
        ...


def natural_to_hertz(
    natural: tuple[float, ...], film: FilmSolution, contact: LineContact, point: OperatingPoint
) -> FloatArray:
    """Frequencies [Hz] of natural frequencies omega sqrt(b^2 + 2 h R)/u; NaN where the film has no solution.

    Parameters
    ----------
    natural : tuple of float
        Natural frequencies.
    film : FilmSolution
        The film at rest.
    contact, point
        What it belongs to.
    """
    modulus = contact.reduced_modulus
    time = natural_time(point.load, film.film_offset, point.entrainment_speed, contact.radius, modulus)
    return np.array(natural) / (2.0 * math.pi * time)


def slow_spectrum(film: FilmSolution, frequencies: FloatArray) -> FilmSpectrum:
    """Spectrum of a film whose film compliance and loss compliance do not depend on frequency.

    Parameters
    ----------
    film : FilmSolution
        The film.
    frequencies : ndarray, shape (k,)
        [Hz].
    """
    rate = 2j * math.pi * frequencies
    error = film.film_compliance * film.film_compliance_error
    lost = film.loss_compliance * film.loss_compliance_error
    return FilmSpectrum(
        film,
        frequencies,
        np.asarray(film.film_compliance - rate * film.loss_compliance, dtype=np.complex128),
        np.asarray(error - rate * lost, dtype=np.complex128)[:, None],
    )


def no_spectrum(film: FilmSolution, frequencies: FloatArray) -> FilmSpectrum:
    """Spectrum of a film that has no solution: NaN.

    Parameters
    ----------
    film : FilmSolution
        The film with its status and reason.
    frequencies : ndarray, shape (k,)
        [Hz].
    """
    nothing = np.full(frequencies.size, complex(math.nan, math.nan))
    return FilmSpectrum(film, frequencies, nothing, nothing[:, None])


def contact_solution(film: FilmSolution, contact: LineContact, point: OperatingPoint) -> ContactSolution:
    """Add the structural part to a film, in the limit of slow motion.

    See `ehdmaps.physics.contact`; for other frequencies `ehdmaps.physics.spectrum`.

    Parameters
    ----------
    film : FilmSolution
        Film of one contact.
    contact : LineContact
        The contact, with its structural law.
    point : OperatingPoint
        Load, speed and temperature of the film.
    """
    solids = structured(
        contact,
        point.load,
        film.film_offset,
        film.film_compliance,
        film.loss_compliance,
        film.film_compliance_error,
        film.loss_compliance_error,
    )
    of_film = {entry.name: getattr(film, entry.name) for entry in fields(FilmSolution)}
    errors = {
        "film_offset_error": abs(film.film_offset_error),
        "film_compliance_error": abs(film.film_compliance_error),
        "loss_compliance_error": film.loss_compliance_error * math.copysign(1.0, film.film_compliance_error),
        "stiffness_error": solids.stiffness_error,
        "damping_error": solids.damping_error,
    }
    return ContactSolution(
        **{**of_film, **errors}, approach=solids.approach, stiffness=solids.stiffness, damping=solids.damping
    )

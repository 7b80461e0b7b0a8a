"""A bearing in operation: its fits and what they leave of its clearance, and the balance of its heat.

Fits
----
A ring that is pressed on a shaft grows at its raceway, one that is pressed into a housing shrinks there. Ring, shaft
and housing are taken as cylinders of one length in plane stress (Lame's thick rings): the inner ring from its seat to
its raceway, the outer ring from its raceway to its seat. With the interference I of the diameters, the pressure
between an inside cylinder (diameters a to s, E_1, nu_1) and an outside one (s to b, E_2, nu_2) is

    p = I / {s [((b^2 + s^2)/(b^2 - s^2) + nu_2)/E_2 + ((s^2 + a^2)/(s^2 - a^2) - nu_1)/E_1]},

the outside diameter b grows by 2 p b s^2/(E_2 (b^2 - s^2)), and the bore a shrinks by 2 p a s^2/(E_1 (s^2 - a^2)).

A diameter d grows by alpha d (T - 20 degC). Rings have the temperature of their raceways, and their seats have it too;
rollers have the mean of both raceways. Left out: the growth of rings by their rotation, lobing, and the roughness of
seats, which flattens and takes some micrometres of interference.

Heat
----
Half of the heat of each contact goes into its raceway, half into the roller, which hands it on to both raceways evenly;
what is added to the friction of the films goes into both raceways evenly. From there it flows

    from the inner raceway to the shaft      G_s (T_i - T_s)
    from the outer raceway to the housing    G_h (T_o - T_h)
    from each raceway into the oil           G_f (T_i - T_f) and G_f (T_o - T_f)
    between the raceways, over the rollers   G_b (T_i - T_o)

and the oil, well mixed inside the bearing, carries W (T_f - T_in) away, W = rho c_p Q with its flow Q. All conductances
are stated [W/K]; none is known here. Temperatures are steady.

Films that get warmer lose viscosity and with it friction, so that the balance has one solution. It may have none where
a bearing loses its clearance as it warms: preload and friction then grow faster than heat is carried away.

References
----------
S. Timoshenko, J. N. Goodier, Theory of Elasticity, McGraw-Hill, 1951, "Stress distribution symmetrical about an axis".
T. A. Harris, M. N. Kotzalas, Essential Concepts of Bearing Technology, CRC, 2007, "Interference fitting and clearance".
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError, Problems
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.units import LENGTH, TEMPERATURE

REFERENCE_TEMPERATURE = 293.15
"""Where clearances and interferences are measured [K]: 20 degC, ISO 1."""

STEEL_EXPANSION = 11.7e-6
"""Coefficient of thermal expansion of bearing steel [1/K]; Harris and Kotzalas."""

EXPANSIONS = (-1e-5, 1e-4)
"""Coefficients of expansion that an input may state [1/K]."""


def pressed_on(
    inside: Material, outside: Material, bore: float, seat: float, outer: float, interference: float
) -> tuple[float, float]:
    """Effect of the press fit of two cylinders: growth of the outside diameter, and shrinkage of the bore [m].

    Parameters
    ----------
    inside, outside : Material
        Materials of both cylinders.
    bore, seat, outer : float
        Diameters a < s < b [m]; a = 0 for a solid shaft.
    interference : float
        I [m], of the diameters; <= 0 is a loose fit, which does nothing.

    Examples
    --------
    The inner ring of an NU308, pressed on a solid shaft of steel: 77 % of the interference arrive at the raceway.

    >>> growth, _ = pressed_on(STEEL, STEEL, 0.0, 40e-3, 52e-3, 10e-6)
    >>> round(1e6 * growth, 2)
    7.69
    """
    if interference <= 0.0:
        return 0.0, 0.0
    ring = (outer**2 + seat**2) / (outer**2 - seat**2) + outside.poisson_ratio
    core = (seat**2 + bore**2) / (seat**2 - bore**2) - inside.poisson_ratio
    pressure = interference / (seat * (ring / outside.youngs_modulus + core / inside.youngs_modulus))
    growth = 2.0 * pressure * outer * seat**2 / (outside.youngs_modulus * (outer**2 - seat**2))
    shrinkage = 2.0 * pressure * bore * seat**2 / (inside.youngs_modulus * (seat**2 - bore**2))
    return growth, shrinkage


@dataclass(frozen=True)
class Seat:
    """Seat of a ring: a shaft, or a housing.

    Attributes
    ----------
    interference : float
        Interference of the diameters of ring and seat at 20 degC [m]; negative for a loose fit.
    diameter : float
        Diameter of the seat [m].
    far_diameter : float
        Bore of the shaft, 0 for a solid one; or outside diameter of the housing [m].
    material : Material
        Material of shaft or housing.
    expansion : float
        Coefficient of thermal expansion of shaft or housing [1/K].
    """

    interference: float
    diameter: float
    far_diameter: float
    material: Material = STEEL
    expansion: float = STEEL_EXPANSION

    def interference_at(self, temperature: float, ring_expansion: float, *, holds: bool) -> float:
        """Interference where ring and seat are warm [m].

        Parameters
        ----------
        temperature : float
            Temperature of both [K].
        ring_expansion : float
            Coefficient of thermal expansion of the ring [1/K].
        holds : bool
            Whether the seat holds the ring inside it, as a housing does.
        """
        apart = (self.expansion - ring_expansion) * self.diameter * (temperature - REFERENCE_TEMPERATURE)
        return self.interference + (-apart if holds else apart)


@dataclass(frozen=True)
class Mounting:
    """Mounting of a bearing, and expansion of its rings.

    Attributes
    ----------
    shaft, housing : Seat or None
        What the inner and the outer ring sit on; None where the fit is part of the stated clearance.
    expansion : float
        Coefficient of thermal expansion of rings and rollers [1/K].
    """

    shaft: Seat | None = None
    housing: Seat | None = None
    expansion: float = STEEL_EXPANSION

    def problems(self, geometry: BearingGeometry) -> list[str]:
        """In which dimensions seats and rings do not fit together.

        Parameters
        ----------
        geometry : BearingGeometry
            Raceways of the bearing.
        """
        inner, outer = geometry.inner_raceway_diameter, geometry.outer_raceway_diameter
        problems = []
        if self.shaft is not None and not 0.0 <= self.shaft.far_diameter < self.shaft.diameter < inner:
            problems.append(
                f"fit of the inner ring: got a bore of {LENGTH.text(self.shaft.far_diameter)} and a seat of "
                f"{LENGTH.text(self.shaft.diameter)}; allowed: bore < seat < inner raceway, {LENGTH.text(inner)}"
            )
        if self.housing is not None and not outer < self.housing.diameter < self.housing.far_diameter:
            problems.append(
                f"fit of the outer ring: got a seat of {LENGTH.text(self.housing.diameter)} and a housing of "
                f"{LENGTH.text(self.housing.far_diameter)} outside; allowed: outer raceway, {LENGTH.text(outer)} < "
                "seat < outside of the housing"
            )
        return problems


@dataclass(frozen=True)
class Clearance:
    """The diametral clearance of a bearing in operation.

    Attributes
    ----------
    stated : float
        Clearance of the bearing at 20 degC, before it is mounted [m].
    by_temperature, by_fits : float
        What the expansion of raceways and rollers, and what the fits add to it [m].
    """

    stated: float
    by_temperature: float = 0.0
    by_fits: float = 0.0

    @property
    def operating(self) -> float:
        """In operation [m]; negative where the rollers are preloaded."""
        return self.stated + self.by_temperature + self.by_fits


def operating_clearance(
    geometry: BearingGeometry, mounting: Mounting, inner: float, outer: float, ring: Material = STEEL
) -> Clearance:
    """The clearance of a mounted bearing with warm rings.

    Parameters
    ----------
    geometry : BearingGeometry
        Raceways, rollers, and the stated clearance.
    mounting : Mounting
        Fits and expansion.
    inner, outer : float
        Temperatures of inner and outer ring [K].
    ring : Material
        Material of the rings.

    Raises
    ------
    InputError
        If seats and rings do not fit together.

    Examples
    --------
    An inner ring that is 5 K warmer than the outer one takes alpha d_m 5 K of an NU308's clearance:

    >>> clearance = operating_clearance(BearingGeometry.named("NU308"), Mounting(), 328.15, 323.15)
    >>> round(1e6 * clearance.by_temperature, 3)
    -3.861
    """
    problems = mounting.problems(geometry)
    if problems or not (math.isfinite(inner) and math.isfinite(outer)):
        raise InputError(problems or [f"temperatures of the rings: got {inner!r} and {outer!r} K; allowed: finite"])
    warm_inner, warm_outer = inner - REFERENCE_TEMPERATURE, outer - REFERENCE_TEMPERATURE
    raceways = geometry.outer_raceway_diameter * warm_outer - geometry.inner_raceway_diameter * warm_inner
    rollers = 2.0 * geometry.roller_diameter * 0.5 * (warm_inner + warm_outer)
    fits = 0.0
    if (seat := mounting.shaft) is not None:
        tight = seat.interference_at(inner, mounting.expansion, holds=False)
        fits -= pressed_on(
            seat.material, ring, seat.far_diameter, seat.diameter, geometry.inner_raceway_diameter, tight
        )[0]
    if (seat := mounting.housing) is not None:
        tight = seat.interference_at(outer, mounting.expansion, holds=True)
        fits -= pressed_on(
            ring, seat.material, geometry.outer_raceway_diameter, seat.diameter, seat.far_diameter, tight
        )[1]
    return Clearance(geometry.diametral_clearance, mounting.expansion * (raceways - rollers), fits)


@dataclass(frozen=True)
class BearingHeat:
    """Friction of a bearing and where it goes, all in W.

    Attributes
    ----------
    rolling : float
        Friction of the films, or of Palmgren's viscous torque in their place.
    added : float
        What the scene adds.
    to_shaft, to_housing, to_oil : float
        Heat that goes there; negative where it comes from there.
    """

    rolling: float
    added: float
    to_shaft: float
    to_housing: float
    to_oil: float

    @property
    def friction(self) -> float:
        """All of the friction [W]."""
        return self.rolling + self.added

    @property
    def left(self) -> float:
        """Friction that nothing carries away [W]: what the balance is not closed by."""
        return self.friction - self.to_shaft - self.to_housing - self.to_oil


@dataclass(frozen=True)
class BearingState:
    """A bearing in operation.

    Attributes
    ----------
    name : str
        Name of the bearing.
    inner, outer : float
        Temperatures of the raceways [K].
    clearance : Clearance
        Diametral clearance.
    oil : float
        Temperature of the oil in the bearing [K]; NaN where no oil flows through it.
    heat : BearingHeat or None
        Friction and where it goes; None where the temperatures are given.
    """

    name: str
    inner: float
    outer: float
    clearance: Clearance
    oil: float = math.nan
    heat: BearingHeat | None = None

    @property
    def film_temperature(self) -> float:
        """Temperature of the law [K]: the mean of both raceways."""
        return 0.5 * (self.inner + self.outer)


HOTTEST = 473.15
"""Highest temperature of a raceway [K]: 200 degC, where bearing steel loses its hardness."""

RESIDUAL = 1e-10
"""Heat that is left of a balance that counts as closed, as a part of the friction."""

_LONGEST_STEP = 10.0
_SHORTEST_STEP = 1e-9
_PROBE = 0.05
_ROUNDS = 100
_QUICK = 0.1
_ROUND_OFF = 1e-13
_TEMPERATURES = ("shaft_temperature", "housing_temperature", "oil_inlet")


@dataclass(frozen=True)
class GivenTemperatures:
    """Temperatures of the raceways that are known.

    Attributes
    ----------
    inner, outer : float or None
        Temperatures of the inner and of the outer raceway [K]; None for that of the operation.
    """

    inner: float | None = None
    outer: float | None = None

    def warmed(self, kelvin: float) -> GivenTemperatures:
        """The same where all that is given is warmer [K]."""
        return _warmed(self, ("inner", "outer"), kelvin)


@dataclass(frozen=True)
class HeatPaths:
    """Paths by which the heat of a bearing leaves, and the friction that it has.

    Attributes
    ----------
    shaft, housing : float
        Conductances from the inner raceway to the shaft and from the outer one to the housing [W/K].
    shaft_temperature, housing_temperature, oil_inlet : float or None
        Temperatures of shaft, of housing, and of the oil that comes in [K]; None for that of the operation.
    oil_flow : float
        W = rho c_p Q of the oil that flows through the bearing [W/K].
    raceways_to_oil : float
        Conductance from each raceway to the oil [W/K].
    between_raceways : float
        Conductance between the raceways [W/K].
    load_friction : float
        f1 of a torque f1 F d_m that is added, with the radial force F and the mean diameter d_m.
    constant_power : float
        Friction that is added at any speed but rest [W].
    palmgren : float or None
        f0 of Palmgren's viscous torque, which takes the place of the rolling of the films; None for the films.

    Raises
    ------
    InputError
        With every value that is not possible, and for a raceway without any path.
    """

    shaft: float = 0.0
    housing: float = 0.0
    shaft_temperature: float | None = None
    housing_temperature: float | None = None
    oil_flow: float = 0.0
    oil_inlet: float | None = None
    raceways_to_oil: float = 0.0
    between_raceways: float = 0.0
    load_friction: float = 0.0
    constant_power: float = 0.0
    palmgren: float | None = None

    def __post_init__(self) -> None:
        problems = Problems(
            f"{entry.name}: got {value!r}; allowed: a finite number >= 0"
            for entry in dataclasses.fields(self)
            if (value := getattr(self, entry.name)) is not None and not (math.isfinite(value) and value >= 0.0)
        )
        problems += [] if problems else self._path_problems()
        problems.check()

    def _path_problems(self) -> list[str]:
        """Paths that lead nowhere."""
        if (self.oil_flow > 0.0) != (self.raceways_to_oil > 0.0):
            return [
                f"oil_flow, raceways_to_oil: got {self.oil_flow:g} and {self.raceways_to_oil:g} W/K; allowed: both or "
                "neither: what the oil carries away, and how well it takes heat from a raceway"
            ]
        both = self.shaft > 0.0 and self.housing > 0.0
        either = self.between_raceways > 0.0 and self.shaft + self.housing > 0.0
        if not (self.oil_flow or both or either):
            return [
                "got a raceway from which no heat can flow; allowed: shaft and housing; or oil_flow with "
                "raceways_to_oil; or one of shaft and housing with between_raceways; all above 0 W/K"
            ]
        return []

    def within(self, temperature: float) -> HeatPaths:
        """The same where shaft, housing and oil without a temperature of their own have this one [K]."""
        missing = {name: temperature for name in _TEMPERATURES if getattr(self, name) is None}
        return dataclasses.replace(self, **missing)

    def warmed(self, kelvin: float) -> HeatPaths:
        """The same where all that is given is warmer [K]."""
        return _warmed(self, _TEMPERATURES, kelvin)

    @property
    def network(self) -> tuple[FloatArray, FloatArray]:
        """G (2, 2) [W/K] and s (2,) [W] of Q = G T - s: heat into the raceways at their temperatures T, oil included.

        Raises
        ------
        InputError
            If shaft, housing or oil have no temperature.
        """
        shaft, housing, inlet = self._around
        oil = self.oil_flow + 2.0 * self.raceways_to_oil
        shared = self.raceways_to_oil**2 / oil if oil else 0.0
        between = self.between_raceways + shared
        own = self.raceways_to_oil + self.between_raceways - shared
        conductance = np.array([[self.shaft + own, -between], [-between, self.housing + own]])
        from_oil = self.raceways_to_oil * self.oil_flow * inlet / oil if oil else 0.0
        return conductance, np.array([self.shaft * shaft + from_oil, self.housing * housing + from_oil])

    @property
    def _around(self) -> tuple[float, float, float]:
        """Temperatures of shaft, housing and of the oil that comes in [K]."""
        shaft, housing, inlet = self.shaft_temperature, self.housing_temperature, self.oil_inlet
        if shaft is None or housing is None or inlet is None:
            raise InputError("heat paths, temperatures: got none of shaft, housing or oil; allowed: after within(T)")
        return shaft, housing, inlet

    def oil_temperature(self, raceways: FloatArray) -> float:
        """Temperature of the oil in the bearing [K], between raceways (2,) [K]; NaN without a flow.

        Parameters
        ----------
        raceways : array, shape (2,)
            Inner and outer [K].
        """
        if not self.oil_flow:
            return math.nan
        taken = self.raceways_to_oil * float(raceways.sum())
        return (self.oil_flow * self._around[2] + taken) / (self.oil_flow + 2.0 * self.raceways_to_oil)

    def flows(self, raceways: FloatArray) -> tuple[float, float, float]:
        """Heat to the shaft, to the housing, and away with the oil [W].

        Parameters
        ----------
        raceways : array, shape (2,)
            Inner and outer [K].
        """
        shaft, housing, inlet = self._around
        warmer = self.oil_temperature(raceways) - inlet if self.oil_flow else 0.0
        inner, outer = raceways.tolist()
        return self.shaft * (inner - shaft), self.housing * (outer - housing), self.oil_flow * warmer


_Thermal = TypeVar("_Thermal", GivenTemperatures, HeatPaths)


def _warmed(thermal: _Thermal, names: Sequence[str], kelvin: float) -> _Thermal:
    """The same with some of its temperatures higher, as far as it has them [K]."""
    given = {name: value + kelvin for name in names if (value := getattr(thermal, name)) is not None}
    return dataclasses.replace(thermal, **given)


def heat_of_contacts(inner: float, outer: float, added: float) -> FloatArray:
    """Heat into inner and outer raceway (2,) [W].

    Parameters
    ----------
    inner, outer : float
        Heat of the contacts with the inner and with the outer raceway [W].
    added : float
        Further heat [W].
    """
    rollers = 0.25 * (inner + outer) + 0.5 * added
    return np.array([0.5 * inner + rollers, 0.5 * outer + rollers])


def steady_temperatures(
    names: Sequence[str], paths: Sequence[HeatPaths], heat: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """Temperatures of the raceways at which all heat is carried away, shape (bearings, 2) [K].

    Parameters
    ----------
    names : sequence of str
        Names of the bearings, for messages.
    paths : sequence of HeatPaths
        Heat paths of each bearing, with all temperatures.
    heat : callable
        Heat into the raceways (bearings, 2) [W] at their temperatures (bearings, 2) [K].

    Raises
    ------
    AnalysisError
        For a bearing that runs away, and where the balance does not settle.

    Notes
    -----
    Newton, beginning without friction. How the heat of a bearing follows both of its temperatures is found by two
    probes, with all bearings at once; their small influence on each other is left to the iteration. Where Newton's step
    is too long, or leads uphill because friction grows faster than its heat is carried away, it is an implicit step in
    time instead, in which the heat that is left warms the raceways. So a bearing warms up to its first balance, or on
    until it is too hot.
    """
    conductances, sources = (np.array(part) for part in zip(*(entry.network for entry in paths), strict=True))
    temperatures: FloatArray = np.linalg.solve(conductances, sources[..., None])[..., 0]
    slopes, before = np.zeros_like(conductances), math.inf
    for _ in range(_ROUNDS):
        given = heat(temperatures)
        left = given + sources - np.einsum("bij,bj->bi", conductances, temperatures)
        closed = RESIDUAL * np.abs(given).sum(axis=1) + _ROUND_OFF * np.abs(sources).sum(axis=1)
        worst = float(np.max(np.abs(left) / closed[:, None]))
        if worst <= 1.0:
            return temperatures
        if worst > _QUICK * before or not math.isfinite(before):
            slopes = _slopes(heat, temperatures, given)
        before = worst
        steps: FloatArray = np.array([_step(*pair) for pair in zip(conductances - slopes, left, strict=True)])
        temperatures = temperatures + steps
        hot = int(np.argmax(temperatures.max(axis=1)))
        if temperatures[hot].max() > HOTTEST:
            slope = conductances[hot] - slopes[hot]
            raise _too_hot(names[hot], slope, float(given[hot].sum()), float(left[hot].sum()))
        if float(np.abs(steps).max()) < _SHORTEST_STEP:
            return temperatures
    raise AnalysisError(
        f"bearing {names[int(np.argmax(np.abs(left).max(axis=1)))]!r}: its heat balance does not settle: "
        f"{np.abs(left).max():.3g} W are left after {_ROUNDS} steps; check its heat paths, or give its temperatures"
    )


def _too_hot(name: str, slope: FloatArray, friction: float, left: float) -> AnalysisError:
    """Make the error for a bearing without a balance: it runs away, or heat has too narrow a way out."""
    words = "thermal run-away" if np.linalg.eigvals(slope).real.min() <= 0.0 else "too hot"
    return AnalysisError(
        f"bearing {name!r}: {words}: no heat balance below {TEMPERATURE.text(HOTTEST)}, where its friction of "
        f"{friction:.4g} W is {left:.4g} W more than its heat paths carry away; give it more conduction or oil, or "
        "more clearance or looser fits if it loses its clearance as it warms"
    )


def _slopes(heat: Callable[[FloatArray], FloatArray], temperatures: FloatArray, here: FloatArray) -> FloatArray:
    """Slopes of the heat of each bearing over its own temperatures, shape (bearings, 2, 2) [W/K]."""
    columns = []
    for side in range(2):
        probe = temperatures.copy()
        probe[:, side] += _PROBE
        columns.append((heat(probe) - here) / _PROBE)
    return np.stack(columns, axis=2)


def _step(slope: FloatArray, left: FloatArray) -> FloatArray:
    """Step (2,) [K]: Newton's, or as far as heat that is left would warm the raceways in a time, both limited.

    (slope + sigma) step = left is an implicit step in time, with a heat capacity over sigma; Newton's without it.
    """
    least = float(np.linalg.eigvals(slope).real.min())
    sigma = 0.0 if least > 0.0 else -2.0 * least + 1e-3 * float(np.abs(slope).max())
    while True:
        step = np.linalg.solve(slope + sigma * np.eye(2), left)
        longest = float(np.abs(step).max())
        if longest <= _LONGEST_STEP:
            return np.asarray(step)
        sigma = max(2.0 * sigma, 0.1 * float(np.abs(slope).max()))

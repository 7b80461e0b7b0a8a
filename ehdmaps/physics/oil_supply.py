"""Oil that a contact gets: flooded, or a layer on the surfaces before it; a starved contact in closed form.

A flooded contact takes as much oil as its film needs. On a layer, no more can pass than the layer brings: the film of a
light load, which would be thicker, is capped by it, and a roller that finds a gap wider than the layer runs dry. There
is no side flow, so a layer stands for what is left of the oil before the contact in the steady state.

The layers of the named kinds of lubrication are estimates, from the side flow of a layer against its supply and from
the torque of a catalogue bearing in oil; within a kind they scatter by a factor of two or more. Who knows the layer
gives its thickness.

The closed form is the starved line contact between rigid surfaces: what a given flow of oil leaves of film and forces.
A layer of oil brings the flow u m to the contact, both walls at u, and the film begins at the meniscus, with no
pressure. With the gap h = h0 + x^2/(2R), p' = 12 eta u (h - m)/h^3 and the free exit of Reynolds (p = 0 at h = m), the
load is

    w = 6 eta u R r/m,        r = (1 - m/h_in)^2,

h_in the gap at the meniscus. The flooded contact has r = 1 and m = 1.2257 h0, so that r is the flow m over that of the
flooded contact at the same load. Everything else hangs on r alone. Towards r = 0 the gap goes to m itself, and the load
to nothing: w = 54 eta u R (m - h0)^2/m^3. A gap wider than the layer carries no load.

The ratios here are to the flooded contact at the same load, speed and viscosity. They are the limit of light
loads, in which alone a roller bearing starves at layers above 1 um; the numerical solution of an isothermal contact at
0.5 N/mm gives .902/.614/.218 for the film and .77/.32/.05 for the loss compliance at r = .9/.6/.2, this one
.902/.613/.217 and .771/.324/.052.

References
----------
M. T. van Zoelen, C. H. Venner, P. M. Lugt, "Prediction of film thickness decay in starved elasto-hydrodynamically
lubricated contacts using a thin layer flow model", Proc. IMechE Part J 223, 2009, 541 (the balance of side flow and
supply; its formula is known here from later work only).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebfit, chebval

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.physics.surface import SMOOTH, Surface

LAYERS: Mapping[str, float] = MappingProxyType(
    {"flooded": math.inf, "oil bath": 10e-6, "oil air": 2e-6, "grease": 0.7e-6}
)
"""Oil layer before a contact, of both surfaces together [m], by kind of lubrication."""

THINNEST, THICKEST = 1e-9, 1e-3
"""Oil layers that are taken [m]: a nanometre is a molecule; a millimetre floods every contact of a roller."""


@dataclass(frozen=True)
class OilSupply:
    """Oil supply of the contacts of a bearing.

    Attributes
    ----------
    oil_layer : float
        Thickness of the oil before each contact, of both surfaces together [m]; inf where it is flooded.
    lubrication : str, optional
        Kind of lubrication that the layer was taken from, one of `LAYERS`; empty for a layer that was given.

    Raises
    ------
    InputError
        If the layer is out of its limits, or there is no such lubrication.
    """

    oil_layer: float = math.inf
    lubrication: str = ""

    def __post_init__(self) -> None:
        if self.lubrication and self.lubrication not in LAYERS:
            raise InputError(f"supply, lubrication: got {self.lubrication!r}; allowed: {', '.join(LAYERS)}")
        if not (THINNEST <= self.oil_layer <= THICKEST or self.oil_layer == math.inf):
            raise InputError(
                f"supply, oil_layer: got {self.oil_layer!r} m; allowed: {THINNEST:g} to {THICKEST:g} m, or inf"
            )

    @classmethod
    def named(cls, lubrication: str) -> OilSupply:
        """Supply of a kind of lubrication.

        Parameters
        ----------
        lubrication : {"flooded", "oil bath", "oil air", "grease"}
            Kind of lubrication.

        Raises
        ------
        InputError
            If there is no such kind.
        """
        if lubrication not in LAYERS:
            raise InputError(f"supply, lubrication: got {lubrication!r}; allowed: {', '.join(LAYERS)}")
        return cls(LAYERS[lubrication], lubrication)

    @property
    def flooded(self) -> bool:
        """True where the contacts take all the oil that they need."""
        return self.oil_layer == math.inf

    @property
    def short(self) -> str:
        """Shortest name, for legends: the kind of lubrication, or the layer."""
        return self.lubrication or self.label

    @property
    def label(self) -> str:
        """Name for tables and messages."""
        if self.flooded:
            return "flooded"
        layer = f"oil layer {1e6 * self.oil_layer:.3g} um"
        return f"{self.lubrication} ({layer})" if self.lubrication else layer


FLOODED = OilSupply(math.inf, "flooded")
"""Contacts that take all the oil that they need."""


@dataclass(frozen=True)
class FilmConditions:
    """Conditions of the films of a bearing, points and lines alike.

    They act in this order: heat thins the flooded film, the layer caps what is left, asperities share its load.

    Attributes
    ----------
    inlet_heat : bool
        Whether heat in the inlet thins the films, by its rule (`ehdmaps.physics.heat`).
    supply : OilSupply
        Oil before each contact.
    surface : Surface
        Surfaces of the contacts.

    Examples
    --------
    >>> FilmConditions(True, OilSupply(2e-6)).words
    'inlet heat, oil layer 2 um'
    """

    inlet_heat: bool = False
    supply: OilSupply = FLOODED
    surface: Surface = SMOOTH

    @property
    def plain(self) -> bool:
        """True of flooded contacts between smooth surfaces."""
        return self.supply.flooded and self.surface.smooth

    @property
    def heat_words(self) -> str:
        """Heat that films know of, for people."""
        return "inlet heat" if self.inlet_heat else "isothermal"

    @property
    def words(self) -> str:
        """The conditions for people; smooth surfaces are not told."""
        rough = "" if self.surface.smooth else f", {self.surface.label}"
        return f"{self.heat_words}, {self.supply.label}{rough}"


PLAIN = FilmConditions()
"""Isothermal, flooded films between smooth surfaces."""


RIGID_FLOW = 1.2257484409676
"""Flow m of the flooded rigid contact over its smallest gap h0; h0 over the gap of a dry layer is its inverse."""

CORNER = 8.0
"""Exponent of the corner where the flow of the flooded contact is as much as the layer, see `passing`."""

_DEGREE = 18
_ORDER = 24
_HALVINGS = 50


_ALL = 1e10
"""Flow over layer above which only the layer passes, to round-off."""


def passing(flow: FloatArray | float, layer: float | FloatArray) -> FloatArray:
    """Part r of the flooded contact's flow that a layer lets through, its corner rounded; both in m.

    Parameters
    ----------
    flow : float or array
        Flow of the flooded contact over density at rest and speed [m], > 0.
    layer : float or array
        Oil layer [m], > 0; inf lets everything through.

    Examples
    --------
    >>> [round(float(r), 4) for r in passing(np.array([1e-7, 1e-6, 1e-5]), 1e-6)]
    [1.0, 0.917, 0.1]
    """
    ratio = np.asarray(flow, dtype=np.float64) / layer
    with np.errstate(over="ignore", divide="ignore"):
        # of a contact that hardly carries the power overflows: only the layer passes
        passed: FloatArray = np.where(ratio > _ALL, 1.0 / ratio, (1.0 + ratio**CORNER) ** (-1.0 / CORNER))
    return passed


def film_ratio(root: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Film of the starved contact over r times that of the flooded one, and its derivative by s; see `passing`.

    Parameters
    ----------
    root : array
        s = sqrt(r), r the flow over that of the flooded contact at the same load; <= 1. Below 0, where there is no
        load, the ratios go on straight.

    Examples
    --------
    >>> [round(float(film), 4) for film in film_ratio(np.sqrt([0.0, 0.2, 0.6, 0.9, 1.0]))[0]]
    [1.2257, 1.0839, 1.0213, 1.0023, 1.0]
    """
    place = np.sqrt(1.0 - np.clip(root, 0.0, 1.0))
    slopes = 2.0 * _derivatives()[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        slope: FloatArray = np.where(place > 0.0, -0.5 * chebval(2.0 * place - 1.0, slopes) / place, 0.0)
    return _ratio(root, 0), slope


def damping_ratio(root: FloatArray) -> FloatArray:
    """c of the starved contact, its meniscus held, over that of the flooded one, times s^(3/2): 1.654 at s = 0.

    Parameters
    ----------
    root : array
        s, as of `film_ratio`.
    """
    return _ratio(root, 1)


def compliance_ratio(root: FloatArray) -> FloatArray:
    """Film compliance of the starved contact, its meniscus held, over that of the flooded one, over s^2.

    The loss compliance has the ratio of c times the square of this one.

    Parameters
    ----------
    root : array
        s, as of `film_ratio`.

    Examples
    --------
    >>> s = np.sqrt([0.2, 0.6, 0.9])
    >>> [round(float(ratio), 3) for ratio in compliance_ratio(s) * s**2]
    [0.105, 0.427, 0.82]
    """
    return _ratio(root, 4)


def rolling_ratio(root: FloatArray, exponent: FloatArray | float = 1.0) -> FloatArray:
    """Rolling force of the starved contact over that of the flooded one; 0 at s = 0.

    Between rigid surfaces it is one closed form (exponent 1), in the inlet of a heavily loaded contact another one
    (exponent 0), `loaded_rolling_ratio`; between them the power of one times that of the other.

    Parameters
    ----------
    root : array
        s, as of `film_ratio`.
    exponent : float or array
        -d ln(m)/d ln(w) of the flow of the flooded contact, 0 to 1: how far the contact is from rigid surfaces.

    Examples
    --------
    >>> [round(float(force), 3) for force in rolling_ratio(np.sqrt([0.0, 0.2, 0.6, 0.9, 1.0]))]
    [0.0, 0.133, 0.375, 0.666, 1.0]
    """
    rigid = np.maximum(root, 0.0) ** 1.5 * _ratio(root, 2)
    loaded: FloatArray = rigid**exponent * loaded_rolling_ratio(root) ** (1.0 - np.asarray(exponent))
    return loaded


def loaded_rolling_ratio(root: FloatArray) -> FloatArray:
    """Rolling force of a starved, heavily loaded contact over that of the flooded one, by Grubin's inlet.

    The Hertzian gap before the contact is h = m (1 + x^1.5) in units of its own, and the reduced pressure is 1/alpha at
    the contact. With J(X) = Int_0^X x^1.5/(1 + x^1.5)^3 dx up to the meniscus X, r^(4/3) = J(X)/J(inf), and the force,
    Int (h - m) dp, goes with r^(-1/3) Int_0^X x^3/(1 + x^1.5)^3 J(X)/J(x) dx. Within 1e-3.

    Parameters
    ----------
    root : array
        s, as of `film_ratio`.

    Examples
    --------
    >>> [round(float(force), 2) for force in loaded_rolling_ratio(np.sqrt([0.0, 0.25, 0.5, 0.9, 1.0]))]
    [0.0, 0.02, 0.08, 0.38, 1.0]
    """
    ratios, forces, _ = _grubin()
    flow = np.clip(np.asarray(root, dtype=np.float64), 0.0, 1.0) ** 2
    found: FloatArray = np.interp(flow, ratios, forces)
    return found


def edge_compliance(
    root: FloatArray, exponent: FloatArray, film: FloatArray, load: FloatArray, half: FloatArray, radius: float
) -> FloatArray:
    """Film compliance that a loaded contact has besides, as a heavier load moves its edge to the held meniscus [m2/N].

    With the gap m + kappa y^1.5 at y before the Hertz zone, kappa = 2 sqrt(2 b)/(3 R), the meniscus at y = X l,
    l = (m/kappa)^(2/3), and r of X as of `loaded_rolling_ratio`, A = d ln r/d ln X: at a held meniscus, with kappa as
    it is, dX/X = -db/(X l) - (2/3) dm/m with db/b = dw/(2 w), so that the film falls by

        (h/w) A b/(2 X l)/(1 + 2 A/3),

    which is taken times 1 - n: rigid surfaces have no edge. The loss of what the moved edge lets through is that times
    b/u, half the time it takes through the zone.

    Parameters
    ----------
    root : array
        s, as of `film_ratio`.
    exponent : array
        n = -d ln(h)/d ln(w) of the flooded film, 0 to 1.
    film, load, half : array
        Film h on the layer [m], w [N/m], > 0, and half-width b of the dry contact [m].
    radius : float
        R [m].
    """
    ratios, _, edges = _grubin()
    moved = np.interp(np.clip(np.asarray(root, dtype=np.float64), 0.0, 1.0) ** 2, ratios, edges)
    length = (1.5 * film * radius / np.sqrt(2.0 * half)) ** (2.0 / 3.0)
    found: FloatArray = (1.0 - exponent) * film / load * half / length * moved
    return found


@cache
def _grubin() -> tuple[FloatArray, FloatArray, FloatArray]:
    """r, ratio of the forces, and A/(2 X (1 + 2 A/3)) of Grubin's inlet, for menisci from the contact to far away."""
    t = np.concatenate((np.linspace(0.0, 2.0, 4001)[:-1], np.geomspace(2.0, 1e4, 8001)))  # x = t^2
    inlet = _integral(2.0 * t**4 / (1.0 + t**3) ** 3, t)
    with np.errstate(invalid="ignore", divide="ignore"):
        part = np.where(t > 0.0, 2.0 * t**7 / (1.0 + t**3) ** 3 / inlet, 0.0)
    ratios = (inlet / inlet[-1]) ** 0.75
    with np.errstate(invalid="ignore", divide="ignore"):
        forces = np.where(t > 0.0, ratios ** (-1.0 / 3.0) * inlet * _integral(part, t), 0.0)
        steep = 0.75 * t**5 / (1.0 + t**3) ** 3 / inlet  # X J'/J over 4/3
        edges = steep / (2.0 * t**2 * (1.0 + 2.0 * steep / 3.0))
    edges[0] = edges[1]  # it grows without bound towards a meniscus at the contact, where no film is left
    return ratios, forces / forces[-1], edges


def _integral(values: FloatArray, places: FloatArray) -> FloatArray:
    """Integral from the first place on, by the trapezoidal rule."""
    steps = 0.5 * (values[1:] + values[:-1]) * np.diff(places)
    return np.concatenate(([0.0], np.cumsum(steps)))


def pressure_ratio(root: FloatArray) -> FloatArray:
    """Largest pressure of the starved contact over that of the flooded one, times s^(3/2): 1.492 at s = 0.

    Parameters
    ----------
    root : array
        s, as of `film_ratio`.
    """
    return _ratio(root, 3)


def _ratio(root: FloatArray, which: int) -> FloatArray:
    """One of the polynomials; below s = 0 its tangent."""
    polynomial = _polynomials()[:, which]
    place = np.sqrt(1.0 - np.clip(root, 0.0, 1.0))
    end = float(_derivatives()[:, which].sum())  # all Chebyshev polynomials are one there
    ratio: FloatArray = chebval(2.0 * place - 1.0, polynomial) - end * np.minimum(root, 0.0)
    return ratio


@cache
def _polynomials() -> FloatArray:
    """The five ratios, free of their powers of s, over 2 sqrt(1 - s) - 1, in which the end at s = 1 is smooth."""
    place = 0.5 + 0.5 * np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))
    solved = np.stack([_solved(float(1.0 - z**2)) for z in place]) / _solved(1.0)
    return np.asarray(chebfit(2.0 * place - 1.0, solved, _DEGREE), dtype=np.float64)


@cache
def _derivatives() -> FloatArray:
    """Derivatives of the five by their argument."""
    return np.asarray(chebder(_polynomials()), dtype=np.float64)


def _solved(s: float) -> tuple[float, ...]:
    """Film, c, rolling force, pressure and compliance over what they go with in s, in units of their own, at s > 0.

    In units of h0 and sqrt(2 R h0), with x = tan(theta): the pressure is zero at the meniscus and at the exit x_e,
    where h is m = 1 + x_e^2, and h_in is m/(1 - s).
    """

    def ends(exit_square: float) -> tuple[float, float]:
        return -math.atan2(math.sqrt(exit_square + s), math.sqrt(1.0 - s)), math.atan(math.sqrt(exit_square))

    def rise(share: float) -> float:
        theta, weight = _nodes(*ends(share * s))
        return float(weight @ ((np.sin(theta) ** 2 - share * s * np.cos(theta) ** 2) * np.cos(theta) ** 2))

    low, high = 0.2, 0.4  # a third at s = 0, 0.2257 at s = 1; the pressure at the exit falls with it
    for _ in range(_HALVINGS):
        share = 0.5 * (low + high)
        low, high = (share, high) if rise(share) > 0.0 else (low, share)
    square = s * share
    inlet, outlet = ends(square)
    flow = 1.0 + square
    theta, weight = _nodes(inlet, outlet)
    x, inverse = np.tan(theta), np.cos(theta) ** 2
    area = float(weight @ inverse**2)
    mean = (weight @ (x * inverse**2)) / area
    squeeze = float(weight @ ((x - mean) ** 2 * inverse**2))
    force = float(weight @ (np.sin(theta) ** 2 - square * inverse))
    theta, weight = _nodes(inlet, -outlet)
    pressure = float(weight @ ((np.sin(theta) ** 2 - square * np.cos(theta) ** 2) * np.cos(theta) ** 2))
    return (
        1.0 / flow,
        squeeze * (flow / s) ** 1.5,
        force * math.sqrt(flow) / s**2.5,
        pressure * (flow / s) ** 1.5,
        1.0 / (flow * _load_exponent(inlet, flow, s, area)),
    )


def _load_exponent(inlet: float, flow: float, s: float, area: float) -> float:
    """-d ln(w)/d ln(h0) at a meniscus that is held, from w h0 = 24 eta u R s^2/(4 m); `area` is Int dx/h^3."""
    part = 1.0 - s  # m/h_in
    at, inverse = -math.tan(inlet), math.cos(inlet) ** 2  # 1/h_in
    if inverse < 1e-30:
        return 1.0
    change = (1.0 - part) * inverse**2 / area  # dm/dx_in
    per_inlet = 2.0 * (2.0 * at * part * inverse - change * inverse) / s - change / flow
    return 1.0 + 0.5 * at * per_inlet


def _nodes(low: float, high: float) -> tuple[FloatArray, FloatArray]:
    """Places and weights of a quadrature over an angle."""
    place, weight = _gauss()
    half = 0.5 * (high - low)
    return low + half * (1.0 + place), half * weight


@cache
def _gauss() -> tuple[FloatArray, FloatArray]:
    """Gauss' places and weights on (-1, 1)."""
    return np.polynomial.legendre.leggauss(_ORDER)

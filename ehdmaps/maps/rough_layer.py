"""Asperities of rough surfaces, and the load that they share with the film.

The heights of both surfaces together are Gaussian, with the combined root mean square roughness sigma. Where the mean
planes are x sigma apart, asperities carry the pressure of Greenwood and Tripp, and the gap that is open to the oil,
averaged, is sigma (phi(x) + x Phi(x)): it never vanishes, while the mean planes may come to overlap, x < 0.

The load is shared so that both leave the same gap on average. A film that carries the share g of the pressure on the
Hertz shape is the film of the modulus g E' under the load g w (Johnson, Greenwood and Poon): Moes' groups become M
sqrt(g) and L g^(3/4), and lengths count by g^(-1/2),

    h_f(g) = h_f(1) g^(-1/2) H(M sqrt(g), L g^(3/4))/H(M, L) g^(-n),    n = 0.12 M^2/(M^2 + 9),

with Moes' film formula H, whose own exponents are too small by n where a real oil is not one of Barus. The film between
smooth surfaces h_f(1) is that of the map. Asperities leave the same film on average, and carry the rest:

    h_f(g) = sigma (phi(x) + x Phi(x)),    p_a(x) = (1 - g) (pi/4) p_H,

solved for the share g and the distance x of the mean planes in sigma; x sigma takes the place of the film offset, and
the loss of the film counts by g^2. Where the film is thick, g is 1 and nothing changes; without a film g is 0, and x is
that of the rough dry contact. The mean planes may come to overlap, x < 0: there the share is out of the range of the
theory, see below, and the rule no more than a smooth way to the rough dry contact.

The scaled film lies within -5 and +12 % of films that `reynolds` solves with the modulus g E' for g >= 0.3 (rms of 60
points with FVA 3, M 0.1 to 200, L 3 to 35, to g = 0.1: 4 %; with the textbooks' exponent g^(-0.16) instead: 32 %).

Load sharing holds while the mean planes of both surfaces are apart. Where they overlap, the gap that is open to the
oil on average is less than 0.4 of the roughness, and most of it lies in pockets between asperities that touch, through
which no film flows as between smooth walls. And at a given distance asperities carry a given pressure, so that the film
is left with the rest of a heavy load, however thin it is. At a given load the mean planes meet at one share of the
film, see `least_share`: below it shares are a guess.

References
----------
J. A. Greenwood, J. H. Tripp, "The contact of two nominally flat rough surfaces", Proc. IMechE 185, 1970, 625.
K. L. Johnson, J. A. Greenwood, S. Y. Poon, "A simple theory of asperity contact in elastohydrodynamic lubrication",
Wear 19, 1972, 91. Moes' film formula: `ehdmaps.physics.films`.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from functools import cache, lru_cache
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline
from scipy.special import erfcx, gamma, ndtr, pbdv

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.kernel import library
from ehdmaps.kernel.record import Record, at, numbers
from ehdmaps.maps.contact_curve import FilmSamples, dry_slope
from ehdmaps.maps.film_field import groups_at
from ehdmaps.maps.schema import DIMS
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.surface import Surface

if TYPE_CHECKING:
    import xarray as xr

_SHARPNESS = 4.0


def asperity_integral(order: float, distance: npt.ArrayLike) -> FloatArray:
    """Integral of (s - x)^n over the Gaussian heights s > x, F_n(x).

    Its derivative by x is -n F_(n-1)(x). By the parabolic cylinder function, Gamma(n + 1)/sqrt(2 pi) exp(-x^2/4)
    D_(-n-1)(x): within 2e-9 of its value for -35 <= x <= 20.

    Parameters
    ----------
    order : float
        n > -1: 5/2 for the load of asperities, 2 for the area of their spots.
    distance : float or array
        x, distance of the mean planes in sigma, of either sign.

    Examples
    --------
    >>> f"{float(asperity_integral(2.5, 0.0)):.4f}"
    '0.6166'
    """
    x = np.asarray(distance, dtype=np.float64)
    values, _ = pbdv(-order - 1.0, x)
    return np.asarray(gamma(order + 1.0) / math.sqrt(2.0 * math.pi) * np.exp(-0.25 * x * x) * values)


def asperity_pressure(
    surface: Surface, distance: npt.ArrayLike, reduced_modulus: float
) -> tuple[FloatArray, FloatArray]:
    """Mean pressure that asperities carry [Pa], and its derivative by the distance in sigma.

    Elastic asperities carry p_e = (16 sqrt(2) pi/15) (eta sigma beta)^2 sqrt(sigma/beta) (E'/2) F_5/2(x). The spots in
    which they touch take the part pi^2 (eta sigma beta)^2 F_2(x) of the area; they carry no more than the hardness,
    p_p. The pressure is (p_e^-4 + p_p^-4)^(-1/4), the smaller one with a smooth bend between.

    Parameters
    ----------
    surface : Surface
        A rough one.
    distance : float or array
        x, distance of the mean planes in sigma, of either sign; -35 to 20.
    reduced_modulus : float
        E' [Pa].
    """
    spots = surface.asperity_product**2
    stiff = 16.0 * math.sqrt(2.0) / 15.0 * math.pi * spots * math.sqrt(surface.asperity_slope) * 0.5 * reduced_modulus
    yielding = surface.hardness * math.pi**2 * spots
    elastic, plastic = stiff * asperity_integral(2.5, distance), yielding * asperity_integral(2.0, distance)
    by_elastic = -2.5 * stiff * asperity_integral(1.5, distance)
    by_plastic = -2.0 * yielding * asperity_integral(1.0, distance)
    ratio = elastic / plastic
    below = (1.0 + ratio**_SHARPNESS) ** (-1.0 / _SHARPNESS)
    pressure = elastic * below
    log_slope = (by_elastic / elastic + ratio**_SHARPNESS * by_plastic / plastic) / (1.0 + ratio**_SHARPNESS)
    return np.asarray(pressure), np.asarray(pressure * log_slope)


def mean_gap(distance: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Mean of the open gap in sigma, phi(x) + x Phi(x), and its derivative Phi(x).

    It is x where the surfaces are far apart, 0.399 where the mean planes meet, and above zero everywhere. Its relative
    error is that of rounding times 1 + x^2.

    Parameters
    ----------
    distance : float or array
        x, distance of the mean planes in sigma, of either sign; above -37, where the gap underflows.

    Examples
    --------
    >>> gap, _ = mean_gap([-2.0, 0.0, 3.0])
    >>> [f"{value:.4f}" for value in gap]
    ['0.0085', '0.3989', '3.0004']
    """
    x = np.asarray(distance, dtype=np.float64)
    height = np.exp(-0.5 * x * x) / math.sqrt(2.0 * math.pi)
    # phi(x) + x Phi(x) would cancel below zero
    deep = height * (1.0 + x * math.sqrt(0.5 * math.pi) * erfcx(-np.minimum(x, 0.0) / math.sqrt(2.0)))
    return np.asarray(np.where(x < 0.0, deep, height + x * ndtr(x))), np.asarray(ndtr(x))


OIL_EXPONENT, FULL_FROM = 0.12, 3.0
"""n of the scaled film where it is elastic, and the load number M where half of it is reached."""

LEAST_PRESSURE = 1e3
"""Pressure below which asperities are not asked [Pa], a hundredth of the air's: the Gaussian has no highest one."""

WHOLE_TO, GONE_BELOW = 10.0, 1e3
"""How far the film goes on below the lowest mapped speed, and where it is gone.

At a tenth of the lowest speed, films of loaded contacts are some nanometres; nobody knows one of a thousandth.
"""

TEMPERATURE_REACH = 40.0
"""How far films go on beyond the temperatures of a map with the policy `asymptote`, at most [K]."""

_FARTHEST, _DEEPEST = 14.0, -35.0
LOG_STEP = 0.02
"""Step of the tables of asperities in ln of their pressure."""

_THICK = 8.0
_LEAST_OIL_NUMBER = 1e-6
_LEAST_SHARE = 1e-3


class Asperities(NamedTuple):
    """Distance of the mean planes and mean gap over ln of the pressure of asperities, at even steps; cubics.

    Attributes
    ----------
    start : float
        First ln of the pressure, in Pa.
    distance, distance_slope : array (n,)
        x, and dx/d ln p.
    log_gap, log_gap_slope : array (n,)
        ln of the mean gap in sigma, and its derivative by ln p.
    """

    start: float
    distance: FloatArray
    distance_slope: FloatArray
    log_gap: FloatArray
    log_gap_slope: FloatArray


@lru_cache(maxsize=8)  # one table serves all contacts of a surface and a material; nobody writes into it
def asperities_of(surface: Surface, reduced_modulus: float) -> Asperities:
    """Asperities of a surface at even steps of ln p; within 1e-8 of x between x = -35 and 14.

    Parameters
    ----------
    surface : Surface
        A rough one.
    reduced_modulus : float
        E' [Pa].
    """
    # dense where the pressure falls off fast
    x = np.linspace(_FARTHEST, _DEEPEST, 4901)
    pressure, _ = asperity_pressure(surface, x, reduced_modulus)
    gap, _ = mean_gap(x)
    logs = np.log(pressure)
    even = np.arange(logs[0], logs[-1], LOG_STEP)
    distance = CubicSpline(logs, x)(even)
    at_even, by_distance = asperity_pressure(surface, distance, reduced_modulus)
    # one Newton step takes the distance to the pressure itself
    distance -= (np.log(at_even) - even) * at_even / by_distance
    at_even, by_distance = asperity_pressure(surface, distance, reduced_modulus)
    slope = at_even / by_distance
    gap, by_gap = mean_gap(distance)
    return Asperities(float(even[0]), distance, slope, np.log(gap), by_gap / gap * slope)


class RoughRecord(Record):
    """`ehd_rough_data` in C: asperities, the roughness, and how films share the load."""

    _fields_: ClassVar = [
        ("nodes", ctypes.c_int64),
        ("start", ctypes.c_double),
        ("step", ctypes.c_double),
        *((name, numbers) for name in ("distance", "distance_slope", "log_gap", "log_gap_slope")),
        *((name, ctypes.c_double) for name in ("sigma", "thick", "oil_exponent", "full_from")),
    ]
    shapes: ClassVar = dict.fromkeys(("distance", "distance_slope", "log_gap", "log_gap_slope"), ("nodes",))

    @classmethod
    def of(cls, asperities: Asperities, sigma: float) -> RoughRecord:
        """Make it of the asperities of a surface.

        Parameters
        ----------
        asperities : Asperities
            Asperities of the surface.
        sigma : float
            Roughness of the surface [m].
        """
        arrays = {name: np.ascontiguousarray(value) for name, value in asperities._asdict().items() if name != "start"}
        return cls(
            nodes=asperities.distance.size, start=asperities.start, step=LOG_STEP, **arrays,
            sigma=sigma, thick=_THICK, oil_exponent=OIL_EXPONENT, full_from=FULL_FROM,
        )  # fmt: skip


@cache
def _share() -> Callable[..., None]:
    """The function of the C library that shares the load."""
    pointer, count = ctypes.c_void_p, ctypes.c_int64
    library.checked(RoughRecord, "ehd_rough_data")
    return library.function("ehd_rough_share", pointer, count, count, *[pointer] * 9, result=None)


def _part_left(speed: FloatArray) -> FloatArray:
    """Part of the film that is left at a speed, in lowest mapped speeds: that of a law of smooth surfaces."""
    place = np.minimum(speed * WHOLE_TO, 1.0)
    return np.asarray(place**3 * (10.0 - place * (15.0 - 6.0 * place)))


@dataclass(frozen=True)
class SharedFilm:
    """Film between rough surfaces, over g = w^(1/3); arrays (n, n_u, n_T).

    Attributes
    ----------
    offset : array
        Distance of the mean planes, what the film offset becomes [m]; below zero where they overlap.
    slope : array
        Its derivative by the root.
    share : array
        Share of the film in the load, 0 to 1.
    """

    offset: FloatArray
    slope: FloatArray
    share: FloatArray


@dataclass(frozen=True)
class SmoothContact:
    """Films between smooth surfaces at some loads, and the solids; arrays (n,).

    Attributes
    ----------
    load, film : array
        w [N/m], > 0, and film offset [m].
    film_compliance, loss, solids : array
        Film compliance [m2/N], loss compliance [m2 s/N], and compliance of the solids [m2/N].
    """

    load: FloatArray
    film: FloatArray
    film_compliance: FloatArray
    loss: FloatArray
    solids: FloatArray


@dataclass(frozen=True)
class RoughLayer:
    """Load sharing in one contact; calling it takes films between smooth surfaces to those between rough ones.

    Attributes
    ----------
    surface : Surface
        A rough one.
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil.
    slowest : float
        Lowest mapped entrainment speed [m/s]: the film is whole down to a tenth of it, and fades below as that of a law
        of smooth surfaces; at a thousandth it is gone.
    """

    surface: Surface
    contact: LineContact
    lubricant: Lubricant
    slowest: float

    @property
    def least_root(self) -> float:
        """Cube root of the load at which asperities are asked no less than `LEAST_PRESSURE`."""
        contact = self.contact
        at_one = 0.25 * math.pi * float(max_pressure(1.0, contact.radius, contact.reduced_modulus))
        return float((LEAST_PRESSURE / at_one) ** (2.0 / 3.0))

    def __call__(self, film: FilmSamples, speeds: FloatArray, temperatures: FloatArray) -> FilmSamples:
        """Film between rough surfaces, in the place of that between smooth ones.

        Parameters
        ----------
        film : FilmSamples
            Film between smooth surfaces.
        speeds, temperatures : array (n_u,), (n_T,)
            Entrainment speeds [m/s], > 0, and temperatures [K].
        """
        part = _part_left(speeds / self.slowest)[:, None]
        found = self.shared(film.root, part * film.offset, part * film.slope, speeds, temperatures)
        # of smooth surfaces c at equal load fades as the film does
        dry = dry_slope(self.contact, film.root)
        faded = part * ((dry - part * film.slope) / (dry - film.slope)) ** 2
        left = np.where(part < 1.0, faded, 1.0) * found.share**2
        return FilmSamples(film.root, found.offset, found.slope, film.loss * np.maximum(left, _LEAST_SHARE**2))

    def shared(
        self, root: FloatArray, film: FloatArray, slope: FloatArray, speeds: FloatArray, temperatures: FloatArray
    ) -> SharedFilm:
        """Share the load between film and asperities.

        Parameters
        ----------
        root : array (n, n_u, n_T)
            Cube root of the load; none at and below zero, where asperities are held at `LEAST_PRESSURE`.
        film, slope : array (n, n_u, n_T)
            Film offset between smooth surfaces [m], and its derivative by the root; 0 where there is none.
        speeds, temperatures : array (n_u,), (n_T,)
            Entrainment speeds [m/s], and temperatures [K].
        """
        contact, modulus, sigma = self.contact, self.contact.reduced_modulus, self.surface.roughness
        # p ~ w^(1/2) of Hertz above the least pressure, and so that it still rises where there is no load
        least = self.least_root
        logs = math.log(LEAST_PRESSURE) + 1.5 * np.arcsinh(0.5 * root / least)
        by_root = 1.5 / np.sqrt(root**2 + 4.0 * least**2)
        # p_H = sqrt(w E'/(2 pi R))
        per_square = 2.0 * math.pi * contact.radius / modulus * (4.0 / math.pi) ** 2
        loads, oils = np.zeros((2, speeds.size, temperatures.size))
        moving = speeds > 0.0
        units, groups = groups_at(contact, self.lubricant, speeds[moving], temperatures)
        loads[moving], oils[moving] = np.log(units * per_square), np.log(np.maximum(groups, _LEAST_OIL_NUMBER))
        out = np.empty((3, *film.shape))
        samples = [np.broadcast_to(values, film.shape).copy() for values in (root, logs, by_root)]
        samples += [loads, oils, np.ascontiguousarray(film), np.ascontiguousarray(slope), np.empty((2, loads.size))]
        data = RoughRecord.of(asperities_of(self.surface, modulus), sigma)
        _share()(data.address, film.shape[0], loads.size, *map(at, samples), at(out))
        return SharedFilm(out[0], out[1], out[2])


FILM_PARAMETER, FILM_SHARE, MEAN_DISTANCE = "film_parameter", "film_share", "mean_distance"
"""Names of the three variables."""

OVERLAP = "the mean planes of the rough surfaces overlap: out of the range of load sharing, the film's share is a guess"
"""What is said where a film carries a load and the distance of the mean planes is below zero."""

DEEPEST_MEANT = -2.0
"""Distance of the mean planes over the roughness that is a gap: there it is 2 % of that of mean planes that meet."""


class MeanPlanes(Enum):
    """Places of the mean planes of rough surfaces to each other; the value is what is said of it."""

    APART = ""
    OVERLAP = OVERLAP
    MERGED = (
        "the mean planes of the rough surfaces overlap by more than twice the roughness, asperities are pressed flat: "
        "no theory of single asperities holds, k and c are no more than a smooth course"
    )

    @classmethod
    def of(cls, share: float, distance: float) -> MeanPlanes:
        """By share of the film and distance of the mean planes over the roughness; apart where one is NaN."""
        if distance < DEEPEST_MEANT:
            return cls.MERGED
        return cls.OVERLAP if share > 0.0 and distance < 0.0 else cls.APART


BOUNDARY, MIXED = 1.0, 3.0
"""Lambda below which lubrication is usually called boundary, and mixed. What asperities carry there is `film_share`."""

LEAST_SPEED = 1e-9
"""Speed that stands for a standstill where one above zero is needed [m/s]."""


def rough_variables(
    dataset: xr.Dataset, contacts: tuple[LineContact, ...], lubricant: Lubricant, surface: Surface
) -> xr.Dataset:
    """Lambda and the film's share at all points of a map.

    Parameters
    ----------
    dataset : xarray.Dataset
        The map, of smooth surfaces.
    contacts : tuple of LineContact
        Its contacts.
    lubricant : Lubricant
        Its oil.
    surface : Surface
        A rough one.

    Returns
    -------
    xarray.Dataset
        `film_parameter`, minimum film between smooth surfaces over the roughness, and `film_share`, the part of the
        load that the film carries by `ehdmaps.maps.rough_layer`; `mean_distance`, the distance of the mean planes over
        the roughness. NaN where a point has no solution.
    """
    import xarray as xr

    ordered = dataset.transpose(*DIMS, ...)
    loads, speeds, temperatures = (ordered[name].values.astype(np.float64) for name in DIMS[1:])
    share, distance = np.empty((2, *(ordered.sizes[name] for name in DIMS)))
    for i, contact in enumerate(contacts):
        layer = RoughLayer(surface, contact, lubricant, max(float(speeds[-1]), LEAST_SPEED))
        film = ordered["film_offset"].values[i]
        share[i], distance[i] = load_sharing(layer, film, loads, speeds, temperatures)
    variables = {
        FILM_PARAMETER: (
            ordered["minimum_film"].values / surface.roughness,
            "Lambda, minimum film between smooth surfaces over the combined rms roughness",
        ),
        FILM_SHARE: (share, "part of the load that the film carries, the rest is carried by asperities"),
        MEAN_DISTANCE: (distance, "distance of the mean planes over the combined rms roughness"),
    }
    return xr.Dataset(
        {name: (DIMS, values, {"units": "1", "long_name": words}) for name, (values, words) in variables.items()},
        {name: ordered[name] for name in DIMS},
    )


def load_sharing(
    layer: RoughLayer, film: FloatArray, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Share of the film of one contact, and distance of the mean planes over the roughness, (n, n_u, n_T) each.

    Parameters
    ----------
    layer : RoughLayer
        The contact with its rough surfaces.
    film : array (n, n_u, n_T)
        Film offset between smooth surfaces [m]; NaN where it is not known, 0 at standstill.
    loads, speeds, temperatures : array (n,), (n_u,), (n_T,)
        [N/m], [m/s], [K].
    """
    known = np.isfinite(film)
    solid = np.where(known, film, 0.0)
    root = np.broadcast_to(np.cbrt(loads)[:, None, None], film.shape)
    shared = layer.shared(root, solid, np.zeros(film.shape), speeds, temperatures)
    distance = shared.offset / layer.surface.roughness
    return np.where(known, shared.share, np.nan), np.where(known, distance, np.nan)


def overlapping(share: FloatArray, distance: FloatArray) -> BoolArray:
    """True where a film carries a load while the mean planes overlap: `load_sharing` out of its range.

    Parameters
    ----------
    share, distance : array
        What `load_sharing` gives. Without a film asperities carry everything, and nothing is shared.
    """
    return np.asarray((share > 0.0) & (distance < 0.0))


def least_share(layer: RoughLayer, loads: FloatArray) -> FloatArray:
    """Share of the film at which the mean planes meet, (n,); below zero where the load is too light for that.

    Parameters
    ----------
    layer : RoughLayer
        The contact with its rough surfaces.
    loads : array (n,)
        [N/m], > 0.
    """
    contact = layer.contact
    pressures = 0.25 * np.pi * np.asarray(max_pressure(loads, contact.radius, contact.reduced_modulus))
    carried, _ = asperity_pressure(layer.surface, 0.0, contact.reduced_modulus)
    return np.asarray(1.0 - carried / pressures)


def sharing_effect(layer: RoughLayer, smooth: SmoothContact, speed: float, temperature: float) -> FloatArray:
    """k and c of a rough contact over those of the smooth one at equal load, (2, n); of c NaN without damping.

    Parameters
    ----------
    layer : RoughLayer
        The contact with its rough surfaces.
    smooth : SmoothContact
        Film of the contact between smooth surfaces.
    speed, temperature : float
        u [m/s], >= 0, and T [K].

    Notes
    -----
    A film sample is known by the cube root g of its load: slope dh/dg = -3 g^2 s, and the loss 9 g times that of the
    film.
    """
    root = np.cbrt(smooth.load)[:, None, None]
    film, gives, lost = (values[:, None, None] for values in (smooth.film, smooth.film_compliance, smooth.loss))
    samples = FilmSamples(root, film, -3.0 * root**2 * gives, 9.0 * root * lost)
    rough = layer(samples, np.array([speed]), np.array([temperature]))
    compliance = -(rough.slope / (3.0 * root**2))[:, 0, 0]
    stiffness = (smooth.solids + smooth.film_compliance) / (smooth.solids + compliance)
    with np.errstate(invalid="ignore", divide="ignore"):
        damping = rough.loss[:, 0, 0] / samples.loss[:, 0, 0] * stiffness**2
    return np.array([stiffness, damping])

"""Life of a rolling bearing: ISO/TS 16281 by the loads of its elements, and the factor of ISO 281 for oil and dirt.

Every contact of an element with a raceway has a load at which the raceway lives a million turns (its rating). The loads
of all elements that pass a place of the ring that turns against the load are a mean of the power 3 for points and 4
for lines; of the ring that stands still, of the power 10/3 and 9/2. The lives of both rings, and of all slices of a
roller, add up as chances of survival. The basic reference life L10r holds for 90 % of bearings, in millions of turns;
the equivalent load P_ref is the one with which the dynamic rating C gives it, L10r = (C/P_ref)^p.

P_ref does not depend on C. L10r goes with its power p, 3 for balls and 10/3 for rollers, and makers' ratings lie up to
15 % above those of ISO 281 by inner geometry, which are used where none is given.

The modified life is a_ISO L10r. a_ISO follows from the viscosity ratio kappa and from e_C C_u/P_ref: how clean the oil
is, and how far the load is above the limit of fatigue.

Left out: stress by fits and hoop stress, skidding, rings of other steel.

References
----------
ISO/TS 16281:2008, Rolling bearings - Methods for calculating the modified reference rating life for universally
loaded bearings. ISO 281:2007, Rolling bearings - Dynamic load ratings and rating life: clause 9, annexes A and B.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError

if TYPE_CHECKING:
    from ehdmaps.physics.point.ball_geometry import BallGeometry

Elements = Literal["ball", "roller"]
"""Kinds of rolling elements that ISO 281 tells apart."""

MOST = 50.0
"""Largest a_ISO."""

LEAST_RATIO, MOST_RATIO = 0.1, 4.0
"""Viscosity ratios between which a_ISO is given; above, that of the upper end holds."""

CLEAN, CONTAMINATED = 0.8, 0.3
"""Contamination factors e_C of ISO 281 (mean diameters below 100 mm): filtered oil, and slight contamination."""

_REDUCTION = 0.83
"""lambda nu of radial roller bearings."""


class ReferenceLife(NamedTuple):
    """Life of ISO/TS 16281.

    Attributes
    ----------
    load : float
        Dynamic equivalent reference load P_ref [N].
    life : float
        Basic reference rating life L10r in millions of turns; infinite without load.
    """

    load: float
    life: float


def ball_reference_life(
    geometry: BallGeometry, loads: FloatArray, dynamic_rating: float, *, inner_turns: bool = True
) -> ReferenceLife:
    """Life of a ball bearing.

    Parameters
    ----------
    geometry : BallGeometry
        The bearing.
    loads : array (2, Z)
        Loads of all balls at the inner and the outer raceway [N].
    dynamic_rating : float
        C [N].
    inner_turns : bool
        Whether the inner ring turns against the load.
    """
    inner, outer = geometry.inner_conformity, geometry.outer_conformity
    # ratio of the ratings of both raceways: curvatures across and along rolling
    both = 1.044 * ((1.0 - geometry.gamma) / (1.0 + geometry.gamma)) ** 1.72
    both *= (inner / outer * (2.0 * outer - 1.0) / (2.0 * inner - 1.0)) ** 0.41
    rows = len(geometry.rows)
    of_ball, inner_part, outer_part = (geometry.ball_rows * math.cos(geometry.contact_angle)) ** 0.7, 0.407, 0.389
    if geometry.thrust:  # whose rating is axial
        of_ball, inner_part, outer_part = 1.0, 1.0, 1.0
    ball = dynamic_rating / (geometry.balls * of_ball)
    capacities = (
        ball / inner_part * (1.0 + both ** (10.0 / 3.0)) ** 0.3,
        ball / outer_part * (1.0 + both ** (-10.0 / 3.0)) ** 0.3,
    )
    powers = (3.0, 10.0 / 3.0) if inner_turns else (10.0 / 3.0, 3.0)
    total = 0.0
    for side, power, rating in zip(loads, powers, capacities, strict=True):
        means = np.mean(side.reshape(rows, -1) ** power, axis=1) ** (1.0 / power)  # of each row
        total += float(np.sum((means / rating) ** (10.0 / 3.0)))
    return _with_life(dynamic_rating, total, 0.9, 3.0)


def roller_reference_life(
    slices: FloatArray,
    dynamic_rating: float,
    gamma: float,
    angle: float,
    *,
    inner_turns: bool = True,
    edges: bool = True,
    rows: int = 1,
) -> ReferenceLife:
    """Life of a bearing with rollers.

    Parameters
    ----------
    slices : array (2, Z, n)
        Loads of the slices of the inner and the outer contact of all rollers [N].
    dynamic_rating : float
        C [N].
    gamma : float
        D cos(alpha)/d_m.
    angle : float
        Contact angle alpha [rad].
    inner_turns : bool
        Whether the inner ring turns against the load.
    edges : bool
        Whether loads count with the factor of the standard for stress at the ends of a roller, 2.3 at the last of many
        slices. C allows for ends; without the factor straight rollers live three times as long.
    rows : int
        Number of rows, of whose rollers one stands behind the other in `slices`.
    """
    count, number = slices.shape[1] // rows, slices.shape[2]
    if edges:
        slices = slices * _ends(number)
    both = (1.038 * ((1.0 - gamma) / (1.0 + gamma)) ** (143.0 / 108.0)) ** 4.5
    roller = dynamic_rating / (_REDUCTION * count * math.cos(angle) * rows ** (7.0 / 9.0))
    inner = roller / 0.378 * (1.0 + both) ** (2.0 / 9.0)
    outer = roller / 0.364 * (1.0 + 1.0 / both) ** (2.0 / 9.0)
    powers = (4.0, 4.5) if inner_turns else (4.5, 4.0)
    total = 0.0
    for loads, capacity, power in zip(slices, (inner, outer), powers, strict=True):
        of_row = loads.reshape(rows, count, number)
        mean = np.mean(of_row**power, axis=1) ** (1.0 / power)
        total += float(np.sum((mean / (capacity * number ** (-7.0 / 9.0))) ** 4.5))
    return _with_life(dynamic_rating, total, 8.0 / 9.0, 10.0 / 3.0)


def _ends(number: int) -> FloatArray:
    """Factors of the loads of slices for the stress at the ends of a roller."""
    if number < _FEWEST:
        return np.ones(number)
    place = np.abs(2.0 * np.arange(1, number + 1) - number - 1.0) / (2.0 * number - 2.0)
    with np.errstate(divide="ignore"):  # in the middle: none
        return np.asarray(1.0 - 0.01 / np.log(1.985 * place))


_FEWEST = 2
"""Slices that have ends."""


def _with_life(rating: float, total: float, slope: float, power: float) -> ReferenceLife:
    """Load and life by the sum of the chances to fail; `slope` is that of Weibull's distribution, inverted."""
    life = total**-slope if total > 0.0 else math.inf
    return ReferenceLife(float(rating * life ** (-1.0 / power)), life)


def life_of_history(shares: Sequence[float], lives: Sequence[float]) -> float:
    """Life under operating points that take turns, 1/L = sum of q_i/L_i, in the unit of the lives.

    Parameters
    ----------
    shares : sequence of float
        Shares q_i of the revolutions, not of the time: each is time x speed. They sum to one.
    lives : sequence of float
        Lives at the points.

    Raises
    ------
    InputError
        For shares below zero, or that do not sum to one, and for lives that are not above zero.

    Examples
    --------
    >>> life_of_history([0.5, 0.5], [100.0, 300.0])
    150.0
    """
    if len(shares) != len(lives) or not shares:
        raise InputError(f"life, history: got {len(shares)} shares and {len(lives)} lives; allowed: one each")
    if not (all(share >= 0.0 for share in shares) and abs(math.fsum(shares) - 1.0) < 1e-6):
        raise InputError(f"life, shares: got {list(shares)!r:.80}; allowed: >= 0, with a sum of 1, of the revolutions")
    if not all(life > 0.0 for life in lives):
        raise InputError(f"life, lives: got {list(lives)!r:.80}; allowed: above 0")
    total = math.fsum(share / life for share, life in zip(shares, lives, strict=True))
    return 1.0 / total if total > 0.0 else math.inf


def required_viscosity(speed: float, pitch_diameter: float) -> float:
    """Reference kinematic viscosity nu_1 of ISO 281 [m2/s].

    Parameters
    ----------
    speed : float
        Speed of one ring against the other [rad/s], of either sign, not zero.
    pitch_diameter : float
        d_m [m].

    Examples
    --------
    60 mm at 1500 rpm:

    >>> round(1e6 * required_viscosity(157.08, 60e-3), 1)
    15.0
    """
    rpm, pitch = abs(speed) * 30.0 / math.pi, 1e3 * pitch_diameter
    if rpm < 1000.0:
        return float(1e-6 * 45000.0 * rpm**-0.83 / math.sqrt(pitch))
    return float(1e-6 * 4500.0 / math.sqrt(rpm * pitch))


def ratio_of_films(film_parameter: float) -> float:
    """Viscosity ratio that a film stands for, kappa = Lambda^1.3 (ISO 281).

    Parameters
    ----------
    film_parameter : float
        Lambda, the film over the combined rms roughness of both surfaces.
    """
    return float(film_parameter**1.3)


_LIFE_NUMBERS = ((0.4, 2.2649, 1.3993, 0.054381), (1.0, 1.9987, 1.2348, 0.19087), (math.inf, 1.9987, 1.2348, 0.071739))
"""Ends of ranges of kappa; b for balls and for rollers, and e of the power of kappa."""


def a_iso(kappa: float, contamination: float, kind: Elements) -> float:
    """Life modification factor a_ISO of radial bearings; NaN for a kappa below 0.1, where ISO 281 has none.

    Parameters
    ----------
    kappa : float
        Viscosity ratio; above 4 that of 4 holds.
    contamination : float
        e_C C_u/P: contamination factor times fatigue load limit over equivalent load, >= 0.
    kind : {"ball", "roller"}
        Kind of the rolling elements.

    Raises
    ------
    InputError
        For numbers out of these limits, or another kind.

    Examples
    --------
    >>> round(a_iso(2.0, 0.1, "ball"), 3), round(a_iso(2.0, 0.1, "roller"), 3)
    (4.202, 0.516)
    """
    if kind not in ("ball", "roller"):
        raise InputError(f"a_ISO, kind: got {kind!r:.40}; allowed: ball, roller")
    if not (kappa >= 0.0 and 0.0 <= contamination < math.inf):
        raise InputError(
            f"a_ISO: got kappa {kappa!r}, e_C C_u/P {contamination!r}; allowed: kappa >= 0, finite e_C C_u/P >= 0"
        )
    if kappa < LEAST_RATIO:
        return math.nan
    ratio = min(kappa, MOST_RATIO)
    _, ball, roller, exponent = next(row for row in _LIFE_NUMBERS if ratio < row[0])
    if kind == "ball":
        base = 1.0 - (2.5671 - ball / ratio**exponent) ** 0.83 * contamination ** (1.0 / 3.0)
        power = -9.3
    else:
        base = 1.0 - (1.5859 - roller / ratio**exponent) * contamination**0.4
        power = -9.185
    return min(0.1 * base**power, MOST) if base > 0.0 else MOST


def fatigue_limit(static_rating: float, pitch_diameter: float, kind: Elements) -> float:
    """Fatigue load limit C_u by the static rating [N], the estimate of ISO 281.

    Parameters
    ----------
    static_rating : float
        C0 [N].
    pitch_diameter : float
        d_m [m].
    kind : {"ball", "roller"}
        Kind of the rolling elements.
    """
    over, power = (22.0, 0.5) if kind == "ball" else (8.2, 0.3)
    return static_rating / over * math.pow(min(1.0, 0.1 / pitch_diameter), power)

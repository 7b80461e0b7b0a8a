"""Frequencies at which a rolling bearing repeats itself: turns of cage and elements, and passes of its raceways.

In pure rolling, with gamma = D cos(alpha)/d_m, Z elements whose axes lean by alpha, and ring speeds w_i and w_o,

    cage             w_c = (w_i (1 - gamma) + w_o (1 + gamma))/2          fundamental train frequency (FTF)
    outer raceway    Z |w_c - w_o|                                        a defect there is passed so often (BPFO)
    inner raceway    Z |w_i - w_c|                                        (BPFI)
    element          |w_i - w_o| (1/gamma - gamma) cos(alpha)/2           about its own axis (BSF); a defect of it
                                                                          meets both raceways, twice as often

Balls that slip, or run at other contact angles than the nominal one, change them by some per cent.

References
----------
R. B. Randall, J. Antoni, Rolling element bearing diagnostics - a tutorial, Mechanical Systems and Signal Processing 25,
2011, 485-520, equations 1 to 4.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol


class Rolling(Protocol):
    """Geometry of a bearing of any kind, as far as pure rolling goes."""

    @property
    def gamma(self) -> float:
        """D cos(alpha)/d_m."""
        ...

    @property
    def lean(self) -> float:
        """Cosine of the angle between the axes of elements and bearing."""
        ...


class Passes(NamedTuple):
    """Speeds at which a bearing repeats itself [rad/s], each >= 0.

    Attributes
    ----------
    cage : float
        Speed of the cage.
    outer, inner : float
        Passes of a place of the outer and of the inner raceway.
    element : float
        Speed of an element about its own axis, against the cage.
    """

    cage: float
    outer: float
    inner: float
    element: float


def passes_of(geometry: Rolling, elements: int, inner_speed: float, outer_speed: float = 0.0) -> Passes:
    """Speeds at which a bearing repeats itself.

    Parameters
    ----------
    geometry : Rolling
        Geometry of a bearing of any kind.
    elements : int
        Number of rolling elements.
    inner_speed, outer_speed : float
        Speeds of the rings [rad/s]; with multiples of a speed the results are multiples, orders.

    Examples
    --------
    NU308, per turn of its inner ring:

    >>> from ehdmaps.physics.bearing import BearingGeometry
    >>> [round(order, 3) for order in passes_of(BearingGeometry.named("NU308"), 12, 1.0)]
    [0.394, 4.727, 7.273, 2.251]
    """
    gamma = geometry.gamma
    cage = 0.5 * (inner_speed * (1.0 - gamma) + outer_speed * (1.0 + gamma))
    turns = 0.5 * abs(inner_speed - outer_speed) * (1.0 / gamma - gamma) * geometry.lean
    return Passes(abs(cage), elements * abs(cage - outer_speed), elements * abs(inner_speed - cage), turns)

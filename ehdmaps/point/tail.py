"""The far inlet of a point contact: pressure where the gap is that of a rigid paraboloid, in similarity form.

Far from the contact the gap is H = H0 + r^2 q/2 with q = cos^2 t + D sin^2 t, t the angle from the direction that lies
ahead (x < 0). The pressures of rolling and of squeezing by dH/dT fall with the third and fourth power of the distance,

    P = lambda r R(t)/H^2,      P = -lambda (dH/dT) S(t)/H^2,

where R = f q^2/4 and S = g q^2/4 follow from Reynolds' equation with Q = q^3/8:

    (Q f')' - 9 Q f = -cos t,      (Q g')' - 8 Q g = -1,      f'(0) = g'(0) = 0.

f ends, with its slope, at an angle beyond the side where the film breaks, for a circle at pi - atan 3; there g is zero.
With the film broken at the side itself, t = pi/2, R would be cos t/(3 + 2 D): Kapitza's closed form. The pressures are
the boundary values at the end of the grid; their load outside of it is a term of the load balance, and their deflection
of the contact, the same over all of it, one of H0. A pressure cut off to zero there leaves an error that falls with the
length of the inlet to the first power only: with four half-widths of inlet 2 % of the film, and 28 % of its compliance,
at M = 20, L = 10.

References
----------
P. L. Kapitza, Hydrodynamic theory of lubrication during rolling, Zh. Tekh. Fiz. 25, 1955, 747-762.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.compiled import njit

_ANGLES = 3000


class Similarity(NamedTuple):
    """Shapes of the far pressures over the angle.

    Attributes
    ----------
    angle : ndarray, shape (k,)
        t, 0 to pi.
    rolling, squeezing : ndarray, shape (k,)
        R and S; zero where the film is broken.
    """

    angle: FloatArray
    rolling: FloatArray
    squeezing: FloatArray


class Tail(NamedTuple):
    """Far pressures at the nodes of a grid, and what they do outside of it, over lambda.

    Attributes
    ----------
    far : ndarray of bool, shape (n, m)
        Nodes at the end of the grid with such a pressure.
    rolling, squeezing : ndarray, shape (n, m)
        r R and S at these nodes, zero at the others.
    about : ndarray, shape (n, m)
        r R at all nodes.
    load : tuple of float
        Expansion of the load of rolling in powers of H0: constant, linear, quadratic.
    squeeze : float
        Load by dH/dT of one, at H0 = 0; negative.
    deflection, squeeze_deflection : float
        Deflection at the contact by the tail of rolling, and by that of dH/dT of one, both over lambda g/pi.
    """

    far: BoolArray
    rolling: FloatArray
    squeezing: FloatArray
    about: FloatArray
    load: tuple[float, float, float]
    squeeze: float
    deflection: float
    squeeze_deflection: float

    def loads(self, height: float) -> tuple[float, float]:
        """Load of the tail of rolling at H0, and its derivative by H0, over lambda.

        Parameters
        ----------
        height : float
            H0.
        """
        first, second, third = self.load
        return first + height * (second + height * third), second + 2.0 * third * height


@lru_cache(maxsize=64)
def similarity(curvature_ratio: float) -> Similarity:
    """Solve for the shapes of the far pressures.

    Parameters
    ----------
    curvature_ratio : float
        Ratio D of the reduced radii.

    Examples
    --------
    A circle: 4 R = f = 4/5 cos t + c cosh 3 t, with f = f' = 0 at pi - atan 3.

    >>> circle = similarity(1.0)
    >>> end = math.pi - math.atan(3.0)
    >>> c = -0.8 * math.cos(end) / math.cosh(3.0 * end)
    >>> exact = 0.2 * np.cos(circle.angle) + 0.25 * c * np.cosh(3.0 * circle.angle)
    >>> bool(np.max(np.abs(circle.rolling - np.where(circle.angle < end, exact, 0.0))) < 1e-5)
    True
    """
    step = math.pi / _ANGLES
    angle = np.asarray((np.arange(_ANGLES) + 0.5) * step, dtype=np.float64)
    stiff = _bend(angle, curvature_ratio) ** 3 / 8.0
    faces = _bend(np.arange(1, _ANGLES) * step, curvature_ratio) ** 3 / 8.0 / step
    between = np.r_[faces, 0.0] + np.r_[0.0, faces]
    ahead = np.cos(angle) * step
    own, right = _eliminated(between + 9.0 * stiff * step, faces, ahead)
    end = _ANGLES // 2 + 1  # at the first angle without pressure none would follow
    while end < _ANGLES - 1 and faces[end - 1] * right[end - 1] / own[end - 1] + ahead[end] > 0.0:
        end += 1
    f = _solved(own, faces, right, end - 1)
    squeezed, same = _eliminated(between + 8.0 * stiff * step, faces, np.full(_ANGLES, step))
    g = _solved(squeezed, faces, same, end - 1)
    quarter = 0.25 * _bend(angle, curvature_ratio) ** 2
    return Similarity(angle, f * quarter, g * quarter)


def far_tail(x: FloatArray, y: FloatArray, curvature_ratio: float) -> Tail:
    """Far pressures of a grid.

    Parameters
    ----------
    x, y : ndarray, shape (n,), (m,)
        Nodes along and across [a].
    curvature_ratio : float
        Ratio D of the reduced radii.
    """
    shape = similarity(curvature_ratio)
    place = np.arctan2(y[None, :], -x[:, None])
    edge = np.zeros(place.shape, dtype=bool)
    edge[0] = edge[:, -1] = True
    edge[-1] = False
    about = np.interp(place, shape.angle, shape.rolling) * np.hypot(x[:, None], y[None, :])
    rolling = np.where(edge, about, 0.0)
    squeezing = np.where(edge, np.interp(place, shape.angle, shape.squeezing), 0.0)
    ahead, aside = np.cos(shape.angle), np.sin(shape.angle)
    distance = np.minimum(np.where(ahead > 0.0, -x[0], -x[-1]) / ahead, y[-1] / aside)
    bend = _bend(shape.angle, curvature_ratio)
    share = 2.0 * math.pi / _ANGLES  # both halves
    flux, squeezed = 4.0 * share * shape.rolling / bend**2, 4.0 * share * shape.squeezing / bend**2
    load = (
        float(np.sum(flux / distance)),
        float(-np.sum(flux * 4.0 / (3.0 * bend * distance**3))),
        float(np.sum(flux * 12.0 / (5.0 * bend**2 * distance**5))),
    )
    return Tail(
        far=rolling > 0.0,
        rolling=rolling,
        squeezing=squeezing,
        about=about,
        load=load,
        squeeze=-float(np.sum(squeezed / (2.0 * distance**2))),
        deflection=float(np.sum(flux / (2.0 * distance**2))),
        squeeze_deflection=-float(np.sum(squeezed / (3.0 * distance**3))),
    )


def _bend(angle: Any, curvature_ratio: float) -> FloatArray:
    """Curvature q of the gap over the angle."""
    return np.asarray(np.cos(angle) ** 2 + curvature_ratio * np.sin(angle) ** 2)


@njit
def _eliminated(own: FloatArray, faces: FloatArray, right: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Pivots and right-hand sides of three-band equations, each without the angle before: the same for any end."""
    own, right = own.copy(), right.copy()
    for i in range(1, own.size):
        factor = faces[i - 1] / own[i - 1]
        own[i] -= factor * faces[i - 1]
        right[i] += factor * right[i - 1]
    return own, right


@njit
def _solved(own: FloatArray, faces: FloatArray, right: FloatArray, end: int) -> FloatArray:
    """Solve eliminated equations of the angles before an end, the others zero."""
    found = np.zeros(own.size)
    for i in range(end - 1, -1, -1):
        found[i] = (right[i] + faces[min(i, faces.size - 1)] * found[min(i + 1, own.size - 1)]) / own[i]
    return found

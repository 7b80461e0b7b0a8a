"""A roller of finite length on its raceway: how bodies of finite depth with free end faces yield beside a force.

A half space yields by 1/distance; what the finite depth of a body changes is smooth, and is added. End faces of the
roller are free: pressures mirrored there take their shear stresses away, and a published factor on the mirrored
pressures what is left of their normal stresses. The raceway goes on beyond the ends, or ends with the roller too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import j0

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import Problems
from ehdmaps.physics.solids import STEEL, Material

_LONGEST_WAVE_DEPTHS = 24.0


@dataclass(frozen=True)
class FiniteLine:
    """A roller on a raceway.

    Attributes
    ----------
    radius : float
        Reduced radius R [m].
    length : float
        Length L of the roller [m].
    roller_depth : float
        Distance of the middle plane of the roller from the contact [m], half its diameter: the plane keeps flat, as
        between two raceways.
    race_depth : float
        Depth of the raceway's body on a flat ground without friction [m].
    material : Material
        Material of both bodies.
    flush : bool
        Whether the raceway ends where the roller does; else it goes on.

    Raises
    ------
    InputError
        With every length that is not positive.
    """

    radius: float
    length: float
    roller_depth: float
    race_depth: float
    material: Material = STEEL
    flush: bool = False

    def __post_init__(self) -> None:
        problems = Problems()
        for name in ("radius", "length", "roller_depth", "race_depth"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                problems.append(f"finite line, {name}: got {value!r} m; allowed: finite and > 0")
        problems.check()

    @property
    def body_compliance(self) -> float:
        """(1 - nu^2)/(pi E) of each body [m2/N]: a force on a half space moves it by this over the distance."""
        return (1.0 - self.material.poisson_ratio**2) / (math.pi * self.material.youngs_modulus)

    def half_width(self, load: float) -> float:
        """Half-width of Hertz [m] at a load per length [N/m]."""
        return math.sqrt(8.0 * load * self.radius * self.body_compliance)

    def half_width_of(self, pressure: float) -> float:
        """Half-width of Hertz [m] at a largest pressure [Pa]."""
        return 4.0 * math.pi * self.radius * self.body_compliance * pressure


def layer_response(s: FloatArray) -> FloatArray:
    """Response of a layer on a flat ground without friction over that of a half space, by wave number times depth.

    (cosh 2s - 1)/(sinh 2s + 2s): s/2 for long waves, where the layer yields as in plane strain compression, and 1 for
    short ones (K. L. Johnson, Contact Mechanics, Cambridge, 1985, section 5.8).

    Parameters
    ----------
    s : array
        Wave number times depth, > 0.
    """
    decayed = np.exp(-2.0 * s)
    return np.asarray((1.0 - decayed) ** 2 / (1.0 - decayed**2 + 4.0 * s * decayed))


@lru_cache(maxsize=1)
def _depth_spline() -> CubicSpline:
    """Values of `depth_term` for distances of up to `_LONGEST_WAVE_DEPTHS` depths."""
    # The integrand is flat beyond 20, and its waves are longer than the steps of the rule.
    x, weights = np.polynomial.legendre.leggauss(16)
    edges = np.linspace(0.0, 24.0, 193)
    half = 0.5 * np.diff(edges)
    s = (edges[:-1, None] + half[:, None] * (1.0 + x)).ravel()
    w = (half[:, None] * weights).ravel() * (layer_response(s) - 1.0)
    ratio = np.linspace(0.0, _LONGEST_WAVE_DEPTHS, 1201)
    return CubicSpline(ratio, j0(ratio[:, None] * s) @ w)


def depth_term(distance: FloatArray, depth: float) -> FloatArray:
    """Term that is added to 1/distance, the response of a half space to a force, for a layer of a depth [1/m].

    Far away the sum of both is zero: a layer does not yield a few depths beside a force.

    Parameters
    ----------
    distance : array
        Distance from the force along the surface [m].
    depth : float
        Depth of the layer [m].
    """
    ratio = np.abs(distance) / depth
    spline = _depth_spline()
    near = spline(np.minimum(ratio, _LONGEST_WAVE_DEPTHS)) / depth
    far = ratio > _LONGEST_WAVE_DEPTHS
    return np.asarray(np.where(far, -1.0 / np.where(far, np.abs(distance), 1.0), near))


def mirror_factor(material: Material) -> float:
    """Factor on pressures mirrored at a free end face; with 1 the face bears no shear stress, but normal stress.

    psi = 1.29 - (0.08 - 0.5 nu)/(1 - nu).

    References
    ----------
    R. Guilbault, A fast correction for elastic quarter-space applied to 3D modeling of edge contact problems,
    J. Tribol. 133 (2011) 031402.

    Examples
    --------
    >>> round(mirror_factor(STEEL), 3)
    1.39
    """
    nu = material.poisson_ratio
    return 1.29 - (0.08 - 0.5 * nu) / (1.0 - nu)

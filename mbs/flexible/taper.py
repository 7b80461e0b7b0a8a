"""Beam element whose round section changes along its length: cones, and layers that are conical.

Stiffness is that of the exact static solution: the flexibility of the bent, sheared, stretched and twisted element is
integrated along it, so that loads at nodes move a cone without error whatever the length of its elements. The shapes
of that solution carry the mass, as those of a cylinder do in `mbs.flexible.beam`; of a section that does not change,
the matrices are the same as there.

References
----------
R. D. Cook, D. S. Malkus, M. E. Plesha, R. J. Witt, Concepts and Applications of Finite Element Analysis, 4th ed.,
Wiley, 2002, chapter 2: stiffness from flexibility.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.flexible.beam import CrossSection, over_both_planes

Along = Callable[[float], CrossSection]
"""Section of an element at a part of its length, 0 to 1."""

_POINTS = 16
"""Gauss points of an element; in a variable in which the diameter of a sharp cone grows by equal factors, not steps."""


class ElementMatrices(NamedTuple):
    """Matrices of an element, shape (12, 12) each, in the freedoms of `mbs.flexible.beam`.

    Attributes
    ----------
    mass, gyroscopic, stiffness : array, shape (12, 12)
        Matrices as of `element_mass`, `element_gyroscopic` and `element_stiffness`.
    """

    mass: FloatArray
    gyroscopic: FloatArray
    stiffness: FloatArray


def tapered_element(along: Along, length: float) -> ElementMatrices:
    """Mass, gyroscopic matrix and stiffness of an element whose section changes.

    Parameters
    ----------
    along : callable
        Section at a part of the length, 0 to 1; stiff everywhere.
    length : float
        [m].
    """
    grading = _Grading.of(along)
    nodes, weights = np.polynomial.legendre.leggauss(_POINTS)
    v, w = 0.5 * (1.0 + nodes), 0.5 * weights
    s, steps = grading.place(v), length * w * grading.rate(v)
    here = [along(part) for part in s.tolist()]
    # Integrals from the first node to each Gauss point, and over all of the length, by points of their own.
    softness = [_softness(along, grading, end, length, v, w) for end in [*v.tolist(), 1.0]]
    whole = softness[-1]
    flexibility = np.array(
        [
            [whole.shear + length**2 * whole.bend[0] - 2.0 * length * whole.bend[1] + whole.bend[2], 0.0],
            [length * whole.bend[0] - whole.bend[1], whole.bend[0]],
        ]
    )
    flexibility[0, 1] = flexibility[1, 0]
    # Deflection and rotation of the second node beyond rigid motion with the first.
    bent = np.array([[-1.0, -length, 1.0, 0.0], [0.0, -1.0, 0.0, 1.0]])
    loads = np.linalg.solve(flexibility, bent)
    plane = bent.T @ loads
    deflection, rotation = np.empty((_POINTS, 4)), np.empty((_POINTS, 4))
    stretch, twist = np.empty((_POINTS, 2)), np.empty((_POINTS, 2))
    for index, (part, soft) in enumerate(zip(s.tolist(), softness, strict=False)):
        x = part * length
        first, turned = np.array([1.0, x, 0.0, 0.0]), np.array([0.0, 1.0, 0.0, 0.0])
        # Moment at t: loads[1] + loads[0] (length - t).
        by_force = length * soft.bend[0] - soft.bend[1]
        rotation[index] = turned + by_force * loads[0] + soft.bend[0] * loads[1]
        lever = x * by_force - length * soft.bend[1] + soft.bend[2]
        deflection[index] = first + (lever + soft.shear) * loads[0] + (x * soft.bend[0] - soft.bend[1]) * loads[1]
        stretch[index] = [1.0 - soft.axial / whole.axial, soft.axial / whole.axial]
        twist[index] = [1.0 - soft.torsion / whole.torsion, soft.torsion / whole.torsion]
    mass, rotary = (steps * np.array([getattr(one, key) for one in here]) for key in ("mass", "rotary"))
    bar = np.array([[1.0, -1.0], [-1.0, 1.0]])
    return ElementMatrices(
        *over_both_planes(
            plane_mass=(deflection.T * mass) @ deflection + (rotation.T * rotary) @ rotation,
            plane_rotary=(rotation.T * (2.0 * rotary), rotation),
            plane_stiffness=plane,
            bars=(_half_lumped(stretch, mass), _half_lumped(twist, 2.0 * rotary)),
            springs=(bar / whole.axial, bar / whole.torsion),
        )
    )


class _Softness(NamedTuple):
    """Integrals from the first node to a place: of 1, t and t^2 over E I, and of 1 over kappa G A, E A and G J."""

    bend: tuple[float, float, float]
    shear: float
    axial: float
    torsion: float


@dataclass(frozen=True)
class _Grading:
    """Places along an element by a variable from 0 to 1 in which its diameter grows by about equal factors."""

    ratio: float

    @classmethod
    def of(cls, along: Along) -> _Grading:
        """By the stiffness of both ends."""
        ratio = (along(1.0).bending / along(0.0).bending) ** 0.25
        return cls(1.0 if abs(ratio - 1.0) < _EVEN else ratio)

    def place(self, v: FloatArray) -> FloatArray:
        """Part of the length."""
        return v if self.ratio == 1.0 else (self.ratio**v - 1.0) / (self.ratio - 1.0)

    def rate(self, v: FloatArray) -> FloatArray:
        """Derivative of the part of the length."""
        if self.ratio == 1.0:
            return np.ones_like(v)
        return np.asarray(math.log(self.ratio) * self.ratio**v / (self.ratio - 1.0))


_EVEN = 1e-6
"""Ratio of diameters, from 1, below which places are not graded: round-off would be more than it brings."""


def _softness(along: Along, grading: _Grading, end: float, length: float, v: FloatArray, w: FloatArray) -> _Softness:
    """Integrate up to a value of the graded variable."""
    s = grading.place(end * v)
    parts = [along(part) for part in s.tolist()]
    steps, places = end * length * w * grading.rate(end * v), length * s
    bending = steps / np.array([part.bending for part in parts])
    shear, axial, torsion = (
        float(np.sum(steps / np.array([getattr(part, key) for part in parts]))) for key in ("shear", "axial", "torsion")
    )
    moments = [float(np.sum(bending * places**power)) for power in range(3)]
    return _Softness((moments[0], moments[1], moments[2]), shear, axial, torsion)


def _half_lumped(shapes: FloatArray, weights: FloatArray) -> FloatArray:
    """Mean of the consistent and the lumped inertia along or about x, as of a cylinder; shape (2, 2)."""
    consistent = (shapes.T * weights) @ shapes
    return np.asarray(0.5 * (consistent + np.diag(consistent.sum(axis=1))))

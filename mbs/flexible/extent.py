"""How heavy and how large a finite-element body is, from its matrices and mesh alone: a wrong unit is seen there.

A body that moves without turning has the kinetic energy of its mass, whatever its elements: t' M t with t = 1 at all
displacements of one direction. A slow turn, which moves each node by theta x r, gives the first moments likewise.
Nodes that are fixed are not in the matrices: their share of the mass, and of the centre, is missing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.flexible.finite_elements import FiniteElementModel
from mbs.flexible.plan import UNIT_SYSTEMS
from mbs.model.body import lever_arm

DENSITIES = (1.0, 25e3)
"""Mean density over the box [kg/m3]: osmium has 22.6e3; a frame of rods in a large box has some kilograms."""

SIZES = (1e-3, 50.0)
"""Longest side of the box [m]."""

_FLAT = 1e-3
"""Sides of a box below this part of the longest one: plates and beams of no thickness have no density."""

_TO_SI = {"SI": (1.0, 1.0), "mm-t-s": (1e-3, 1e3)}
"""Length and mass of each system of units."""


@dataclass(frozen=True, eq=False)
class Extent:
    """Mass and size of a body.

    Attributes
    ----------
    mass : float
        Mass without the share of fixed nodes [kg].
    centre : array, shape (3,)
        Centre of that mass [m].
    lower, upper : array, shape (3,)
        Corners of the box around all nodes of the mesh [m].
    """

    mass: float
    centre: FloatArray
    lower: FloatArray
    upper: FloatArray

    @property
    def longest(self) -> float:
        """Longest side of the box [m]."""
        return float(np.max(self.upper - self.lower))

    @property
    def density(self) -> float | None:
        """Mass over the volume of the box [kg/m3]; None where the box is flat."""
        sides = self.upper - self.lower
        return float(self.mass / np.prod(sides)) if np.all(sides > _FLAT * self.longest) else None

    def warnings(self, units: str) -> tuple[str, ...]:
        """Say what no body is like, and which units would make it one.

        Parameters
        ----------
        units : str
            One of UNIT_SYSTEMS: what the files were taken for.

        Returns
        -------
        tuple of str
            One sentence; none where size and density can be.
        """
        wrong = _absurd(self.longest, self.density)
        if not wrong:
            return ()
        others = [name for name in UNIT_SYSTEMS if name != units and not _absurd(*self._as(units, name))]
        advice = "; ".join(f'units = "{name}" would give {_shown(*self._as(units, name))}' for name in others)
        return (
            f'{wrong} with units = "{units}"; allowed: {SIZES[0]:g} to {SIZES[1]:g} m, {DENSITIES[0]:g} to '
            f"{DENSITIES[1]:g} kg/m3; {advice or 'no units of this program fit: check mesh and matrices'}",
        )

    def _as(self, units: str, others: str) -> tuple[float, float | None]:
        """Longest side and density if the numbers of the files were of other units."""
        length, mass = (_TO_SI[others][k] / _TO_SI[units][k] for k in range(2))
        return self.longest * length, None if self.density is None else self.density * mass / length**3


def extent(model: FiniteElementModel) -> Extent:
    """Find mass, centre and box of a body.

    Parameters
    ----------
    model : FiniteElementModel
        The body; at least one node has a position.

    Returns
    -------
    Extent
        The centre along an axis is NaN where no displacement across it is free.
    """
    motion = np.zeros((model.size, 6))
    for row, (node, direction) in enumerate(zip(model.nodes.tolist(), model.directions.tolist(), strict=True)):
        if model.has_position(node):
            motion[row] = lever_arm(model.position(node).tolist())[direction]
        else:  # it moves along as the others do; of its turn nothing is known
            motion[row, direction] = 1.0
    inertia = motion.T @ (model.mass @ motion)
    masses = np.diag(inertia)[:3]
    # Force along an axis for a turn about another one, both ways: y with theta_z and z with theta_y for x.
    moments = [(1, 5, 2, 4), (2, 3, 0, 5), (0, 4, 1, 3)]
    centre = [
        (inertia[a, b] - inertia[c, d]) / (masses[a] + masses[c]) if masses[a] + masses[c] > 0.0 else np.nan
        for a, b, c, d in moments
    ]
    return Extent(
        float(np.max(masses)), np.array(centre), np.min(model.positions, axis=0), np.max(model.positions, axis=0)
    )


def _absurd(longest: float, density: float | None) -> str:
    """Size and density where one of them is that of no body; else nothing."""
    sane = SIZES[0] <= longest <= SIZES[1] and (density is None or DENSITIES[0] <= density <= DENSITIES[1])
    return "" if sane else f"got {_shown(longest, density)}"


def _shown(longest: float, density: float | None) -> str:
    """Size and density in words."""
    mean = "" if density is None else f" and {density:.3g} kg/m3 over it"
    return f"a box of {longest:.3g} m{mean}"

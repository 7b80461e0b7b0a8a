"""A pair of spur or helical gears on parallel shafts, as an element of a system; `mbs.gears.pair` describes the pair.

The gears act on each other with one force along the common normal of the flanks, at the pitch point in the middle of
their faces. Of helical gears the normal leans out of the transverse section, so that the force has an axial part, which
also tilts each gear by its pitch radius. What the teeth bend and flatten is the mesh stiffness, which varies with the
number of pairs in contact, and the transmission error is what the flanks lack of involutes. Friction, the resistance of
the face width to tilting of the gears against each other, and the parts of the bodies that turn about x by more than
small angles besides their prescribed spin are left out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import Problems
from mbs.gears.gear_kernel import BY_RATE, FORCE, SLOPE, MeshData, mesh_energy, mesh_force, mesh_powers
from mbs.gears.pair import PLACED, GearPair
from mbs.model.elements import ElementDefaults, Excitation, Forces, Operation, Port, Powers

HARMONICS = 5
"""Multiples of the meshing order that are worth following."""

_DISTANCE = ("m (z1 + z2)/2", "m (z1 + z2)/(2 cos(helix_angle))", "with the profile shifts")

SPINS = 1e-6
"""How far the ratio of the spins may be off, as a part of it."""


@dataclass(frozen=True, eq=False)
class GearMesh(ElementDefaults):
    """A gear pair in a system; make it by `gear_mesh`.

    Attributes
    ----------
    pair : GearPair
        Geometry, stiffness, error.
    rows : array, shape (2, 12)
        Compression of the driving and of the other flank by the displacements of both gears.
    spin : float
        Speed of the first gear as a multiple of the system's.
    varying : bool
        Whether stiffness and transmission error follow the angle; else the stiffness is the mean, the error zero.
    """

    pair: GearPair
    rows: FloatArray
    spin: float
    varying: bool = True

    @property
    def name(self) -> str:
        """For messages and results."""
        return self.pair.name

    @property
    def ports(self) -> tuple[Port, ...]:
        """The absolute displacements of both gears."""
        return Port(self.pair.on), Port(self.pair.against)

    @property
    def order(self) -> float:
        """Tooth meshes for each turn of the system."""
        return abs(self.pair.teeth[0] * self.spin)

    @property
    def excitation(self) -> Excitation | None:
        """The meshing of the teeth; None for gears that stand."""
        return Excitation(self.order, HARMONICS, rank=2) if self.order > 0.0 else None

    def steady(self) -> GearMesh:
        """The mesh with its mean stiffness and without error, for linear analyses."""
        return replace(self, varying=False)

    @cached_property
    def arrays(self) -> tuple[FloatArray, FloatArray]:
        """Constants and series, shapes (5,) and (4, harmonics), see `mbs.gears.gear_kernel`."""
        pair = self.pair
        constants = [pair.mean_stiffness, pair.damping, pair.backlash, pair.teeth[0] * self.spin, pair.phase]
        return np.array(constants), pair.series if self.varying else np.zeros((4, 0))

    @cached_property
    def _data(self) -> MeshData:
        """The mesh for `mbs.gears.gear_kernel`."""
        constants, series = self.arrays
        series = np.ascontiguousarray(series, dtype=np.float64)
        return MeshData(harmonics=series.shape[1], constants=constants, series=series)

    def flanks(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> FloatArray:
        """Force [N], stiffness [N/m] and damping [N s/m] of the driving and of the other flank, shape (2, 3).

        Parameters
        ----------
        displacement : ndarray
            Displacements of both ports, shape (12,) [m], [rad].
        velocity : ndarray
            Their rates, shape (12,) [m/s], [rad/s].
        operation : Operation
            Speed, angle and time.
        """
        motion, rate = self.rows @ displacement, self.rows @ velocity
        return mesh_force(self._data, operation.angle, operation.speed, motion, rate)

    def evaluate(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> Forces:
        """Force on both gears, stiffness and damping, see `Element.evaluate`."""
        flanks = self.flanks(displacement, velocity, operation)
        driving, other = self._squares
        return Forces(
            -flanks[:, FORCE] @ self.rows,
            flanks[0, SLOPE] * driving + flanks[1, SLOPE] * other,
            flanks[0, BY_RATE] * driving + flanks[1, BY_RATE] * other,
        )

    def powers(
        self, states: Any, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> Powers:
        """Power that its flanks dissipate, and power that stiffness and error bring in, see `Element.powers`."""
        motion, rate = self.rows @ displacement, self.rows @ velocity
        return Powers(*mesh_powers(self._data, operation.angle, operation.speed, motion, rate))

    def stored(self, states: Any, displacement: FloatArray, operation: Operation) -> float:
        """Energy of its flanks [J], see `Element.stored`."""
        return mesh_energy(self._data, operation.angle, self.rows @ displacement)

    @cached_property
    def _squares(self) -> tuple[FloatArray, FloatArray]:
        """B^T B of both flanks, exactly symmetric."""
        return np.outer(self.rows[0], self.rows[0]), np.outer(self.rows[1], self.rows[1])


def gear_mesh(
    pair: GearPair, position1: Sequence[float], position2: Sequence[float], spin1: float, spin2: float
) -> GearMesh:
    """Put a gear pair between two places.

    With c from the first centre to the second and t = x cross c, the driving flank has the normal
    n = cos(alpha) t + sin(alpha) c on the second gear and the compression

        n . (u1 - u2) + r_b1 theta_x1 + r_b2 theta_x2 - e,

    the other flank n' = -cos(alpha) t + sin(alpha) c, both rotations with the opposite sign, and - backlash + e. Angles
    alpha are working ones, of the transverse section. Helical flanks, with the base helix angle beta_b, have
    n = cos(alpha) t + sin(alpha) c - tan(beta_b) x and n' = -cos(alpha) t + sin(alpha) c + tan(beta_b) x: n . u is a
    motion in the transverse section still, and the tilts of a gear count with the moment of the axial part about its
    centre. With the tangential force F_t on the pitch circle the axial one is F_t tan(beta), the radial one
    F_t tan(alpha_n)/cos(beta) (G. Niemann, H. Winter, Maschinenelemente 2, Springer 2003).

    Parameters
    ----------
    pair : GearPair
        What meshes.
    position1, position2 : sequence of float, shape (3,)
        Positions of the places [m].
    spin1, spin2 : float
        Spins of their bodies, as multiples of the system's speed.

    Raises
    ------
    InputError
        If the gears are not in one plane or not at their centre distance, or do not turn as their teeth ask for.
    """
    distance = np.asarray(position2, dtype=np.float64) - np.asarray(position1, dtype=np.float64)
    apart, wanted = math.hypot(distance[1], distance[2]), pair.centre_distance
    where = f"gear pair {pair.name!r}"
    rule = _DISTANCE[2 if pair.profile_shift else bool(pair.helix_angle)]
    problems = Problems()
    if not abs(distance[0]) <= PLACED:
        problems.append(
            f"{where}: the middles of the gears are {distance[0] * 1e3:.6g} mm apart along x; allowed: one plane"
        )
    if not abs(apart - wanted) <= PLACED:
        problems.append(
            f"{where}: the centres are {apart * 1e3:.7g} mm apart; allowed: {rule} = "
            f"{wanted * 1e3:.7g} mm; "
            "move one of the shafts, and the seats of its bearings with it"
        )
    needed = -spin1 * pair.teeth[0] / pair.teeth[1]
    if not (math.isfinite(spin1) and abs(spin2 - needed) <= SPINS * abs(needed)):
        problems.append(
            f"{where}: the spins are {spin1!r} and {spin2!r}; allowed: {needed:.15g} for the second gear, by the teeth"
        )
    problems.check()
    towards = np.array([0.0, distance[1], distance[2]]) / apart
    along = np.array([0.0, -towards[2], towards[1]])
    angle, lean = pair.working_pressure_angle, math.tan(pair.base_helix_angle)
    first, second = pair.pitch_radii
    rows = np.zeros((2, 12))
    for row, side in zip(rows, (1.0, -1.0), strict=True):
        normal = side * math.cos(angle) * along + math.sin(angle) * towards
        normal[0] = -side * lean
        row[:3], row[6:9] = normal, -normal
        # the pitch point moves with both gears
        row[3:6], row[9:] = np.cross(first * towards, normal), np.cross(second * towards, normal)
    return GearMesh(pair, rows, spin1)

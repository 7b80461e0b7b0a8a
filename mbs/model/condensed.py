"""Bearings whose rolling elements are in balance: their dynamic stiffness, and how it changes with place and law.

A rolling element is moved by D (m,), what the inner ring does to it, and by its own V (m,), without mass against small
motions. Contact j feels h_j.(D, V) and answers an oscillation e^(s t) with z_j(s). With the stiffness G by which loads
turn,

    H(s) = sum_j z_j(s) h_j h_j' + G,    Z(s) = H_dd - H_dv H_vv^-1 H_vd,

and a small change dH of it, by places, loads or laws, makes

    dZ = L' dH R,    R = (1, -H_vv^-1 H_vd),    L' = (1, -H_dv H_vv^-1),

exactly to first order. D follows the pose of the inner ring, so that a bearing sums over its rolling elements.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray

LAW_CHANGES = ("stiffness", "damping", "film")
"""Kinds of errors of a law: of k and of c at the load, and of the thickness of films."""

DIRECTIONS = ("x", "y", "z", "theta_x", "theta_y", "theta_z", *LAW_CHANGES)
"""Directions of change of a bearing: those of its pose, then those of its law."""


class Contacts(NamedTuple):
    """Contacts of Z rolling elements, J each: numbers, or their derivatives by q directions with a first axis more.

    Attributes
    ----------
    feel : array (Z, J, 2 m)
        Vectors h.
    turning : array (Z, 2 m, 2 m)
        Stiffness G by which loads turn [N/m].
    stiffness, damping : array (Z, J)
        k [N/m] and c [N s/m] of slow motion.
    shares : array (Z, J, r)
        Parts of c that dampers have which stand in series with springs: z = k + s c sum_r share_r/(1 + s time_r).
    times : array (Z, J, r)
        Their times [s]; 0 without a spring.
    """

    feel: FloatArray
    turning: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    shares: FloatArray
    times: FloatArray


@dataclass(frozen=True, eq=False)
class Condensed:
    """A bearing with the errors of its law.

    Attributes
    ----------
    contacts : Contacts
        Contacts at rest.
    slopes : Contacts
        Their derivatives by `DIRECTIONS`: by the pose of the inner ring [m] or [rad], and by a law that is wrong by its
        bounds, once, at a held pose. Rolling elements follow in balance, with all that they make the cage do.
    pose : array (Z, m, 6)
        D by the pose.
    forces : array (9, 6)
        Derivatives of the force on the inner ring by the same directions [N], [N m].
    relaxes : bool
        Whether z(s) holds at any frequency, or stiffness and damping of slow motion do.
    natural : array (Z, J) or None
        Natural times of the contacts [s], 0 of dry ones; None where `left_out` says more.
    left_out : callable or None
        Part of z(s) that films with memory miss at frequencies s (k,) [1/s], and its possible error, as parts of z,
        (k, Z, J) each; None where it is not known.
    """

    contacts: Contacts
    slopes: Contacts
    pose: FloatArray
    forces: FloatArray
    relaxes: bool
    natural: FloatArray | None = None
    left_out: Callable[[ComplexArray], tuple[ComplexArray, FloatArray]] | None = None

    @cached_property
    def stiffness(self) -> FloatArray:
        """K of slow motion at held speeds of the rings, shape (6, 6)."""
        (left,), (right,) = self._ends(np.zeros(1, dtype=np.complex128), *self._whole)[:2]
        return np.asarray(np.einsum("zma,zmn,znb->ab", left, self._at_rest, right).real)

    @cached_property
    def damping(self) -> FloatArray:
        """C of slow motion, shape (6, 6)."""
        (left,), (right,) = self._ends(np.zeros(1, dtype=np.complex128), *self._whole)[:2]
        feel, c = self.contacts.feel, self.contacts.damping
        return np.asarray(np.einsum("zja,zj,zjb->ab", (feel @ left).real, c, (feel @ right).real))

    @cached_property
    def changes_of_slow_motion(self) -> tuple[FloatArray, FloatArray]:
        """Derivatives of K and C by the directions, shape (9, 6, 6) each."""
        (left,), (right,) = (part.real for part in self._ends(np.zeros(1, dtype=np.complex128), *self._whole)[:2])
        at, by = self.contacts, self.slopes
        m = self.pose.shape[1]
        own = self._at_rest[:, m:, m:]
        half = np.swapaxes(by.feel, -1, -2) @ (at.stiffness[..., None] * at.feel)
        moved = half + np.swapaxes(half, -1, -2) + by.turning
        moved += np.swapaxes(at.feel, -1, -2) @ (by.stiffness[..., None] * at.feel)
        after, before = moved @ right, np.swapaxes(moved, -1, -2) @ left
        by_stiffness = np.einsum("zma,qzmb->qab", left, after)
        more_right, more_left = np.zeros_like(after), np.zeros_like(before)
        more_right[:, :, m:] = -np.linalg.solve(own, after[:, :, m:])
        more_left[:, :, m:] = -np.linalg.solve(np.swapaxes(own, -1, -2), before[:, :, m:])
        felt_left, felt_right = at.feel @ left, at.feel @ right
        more_left, more_right = by.feel @ left + at.feel @ more_left, by.feel @ right + at.feel @ more_right
        by_damping = np.einsum("zja,qzj,zjb->qab", felt_left, by.damping, felt_right, optimize=True)
        by_damping += np.einsum("qzja,zj,zjb->qab", more_left, at.damping, felt_right, optimize=True)
        by_damping += np.einsum("zja,zj,qzjb->qab", felt_left, at.damping, more_right, optimize=True)
        return by_stiffness, by_damping

    def changes(self, s: ComplexArray) -> ComplexArray:
        """Derivatives of Z(s) by the directions at frequencies s (k,) [1/s], shape (9, k, 6, 6)."""
        return self.changes_along(s, *self._whole)

    def changes_along(self, s: ComplexArray, left: ComplexArray, right: ComplexArray) -> ComplexArray:
        """The same between motions of the ring, left' dZ(s) right, shape (9, k, a, b).

        Parameters
        ----------
        s : array, shape (k,)
            Complex frequencies [1/s].
        left, right : array, shape (k, 6, a), (k, 6, b)
            Motions at each of them.
        """
        if not self.relaxes:
            by_stiffness, by_damping = self.changes_of_slow_motion
            slow = by_stiffness[:, None] + s[:, None, None] * by_damping[:, None]
            return np.asarray(np.swapaxes(left, -1, -2) @ slow @ right)
        at, by = self.contacts, self.slopes
        before, after, z = self._ends(s, left, right)
        felt_left, felt_right = at.feel @ before, at.feel @ after
        place = s[:, None, None, None]
        slow = place / (1.0 + place * at.times)
        shared = at.damping[..., None] * at.shares
        dampers = by.damping[..., None] * at.shares + at.damping[..., None] * by.shares
        change = by.stiffness[:, None] + np.sum(slow * dampers[:, None] - slow**2 * shared * by.times[:, None], axis=-1)
        products = felt_left[..., :, None] * felt_right[..., None, :]
        k, a, b = s.size, left.shape[-1], right.shape[-1]
        flat = np.ascontiguousarray(np.swapaxes(change, 0, 1)).reshape(k, len(DIRECTIONS), -1)
        found = (flat @ products.reshape(k, -1, a * b)).reshape(k, len(DIRECTIONS), a, b)
        turns = np.flatnonzero(np.any(by.feel, axis=(1, 2, 3)) | np.any(by.turning, axis=(1, 2, 3)))
        if turns.size:
            size = at.feel.shape[-1]
            outer = (by.feel[turns][..., :, None] * at.feel[..., None, :]).reshape(turns.size, *z.shape[1:], size**2)
            # (k, Z, 1, J) with (Z, J, q size^2)
            by_place = np.moveaxis(outer, 0, 2).reshape(*z.shape[1:], -1)
            half = (z[:, :, None, :] @ by_place).reshape(k, -1, turns.size, size, size)
            moved = half + np.swapaxes(half, -1, -2) + np.moveaxis(by.turning[turns], 0, 1)
            ends = np.swapaxes(before, -1, -2)[:, :, None] @ moved @ after[:, :, None]
            found[:, turns] += ends.sum(axis=1)
        return np.ascontiguousarray(np.swapaxes(found, 0, 1))

    def parts_along(
        self, s: ComplexArray, left: ComplexArray, right: ComplexArray, parts: tuple[ComplexArray, ...]
    ) -> tuple[ComplexArray, ...]:
        """Changes of left' Z(s) right by parts of the z(s) of all contacts, to first order, shape (k, a, b) each.

        Parameters
        ----------
        s, left, right
            The same as of `changes_along`.
        parts : tuple of array, shape (k, Z, J)
            Changes of z over z.
        """
        before, after, z = self._ends(s, left, right)
        products = (self.contacts.feel @ before)[..., :, None] * (self.contacts.feel @ after)[..., None, :]
        flat = products.reshape(s.size, z.shape[1] * z.shape[2], -1)
        shape = (s.size, *products.shape[-2:])
        return tuple(((z * part).reshape(s.size, 1, -1) @ flat).reshape(shape) for part in parts)

    @property
    def _whole(self) -> tuple[ComplexArray, ComplexArray]:
        """All motions of the ring, on both sides."""
        every = np.eye(6, dtype=np.complex128)[None]
        return every, every

    @cached_property
    def _at_rest(self) -> FloatArray:
        """H at s = 0, shape (Z, 2 m, 2 m)."""
        at = self.contacts
        return np.asarray(np.swapaxes(at.feel, 1, 2) @ (at.stiffness[..., None] * at.feel) + at.turning)

    def _ends(
        self, s: ComplexArray, left: ComplexArray, right: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """Motions (D, V) of the rolling elements, (k, Z, 2 m, a) on the left, (.., b) on the right, and z (k, Z, J)."""
        at = self.contacts
        place = s[:, None, None, None]
        z = at.stiffness + at.damping * np.sum(place * at.shares / (1.0 + place * at.times), axis=-1)
        matrix = np.swapaxes(at.feel, 1, 2) @ (z[..., None] * at.feel) + at.turning
        m = self.pose.shape[1]
        by_left, by_right = (
            self.pose @ np.broadcast_to(part, (s.size, *part.shape[1:]))[:, None] for part in (left, right)
        )
        whole = np.zeros((s.size, at.feel.shape[0], m, m)) + matrix[:, :, m:, m:]
        follow = np.linalg.solve(whole, matrix[:, :, m:, :m] @ by_right)
        lead = np.linalg.solve(np.swapaxes(whole, -1, -2), np.swapaxes(matrix[:, :, :m, m:], -1, -2) @ by_left)
        before, after = np.concatenate([by_left, -lead], axis=-2), np.concatenate([by_right, -follow], axis=-2)
        return np.asarray(before), np.asarray(after), np.asarray(z)


def none_moved(contacts: Contacts, directions: int) -> Contacts:
    """Derivatives that are zero, by some directions.

    Parameters
    ----------
    contacts : Contacts
        Contacts of which they are.
    directions : int
        How many.
    """
    return Contacts(*(np.zeros((directions, *part.shape)) for part in contacts))

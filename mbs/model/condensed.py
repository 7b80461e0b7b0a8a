"""Bearings whose rolling elements are in balance: their dynamic stiffness, and how it changes with place and law.

With contacts as in `mbs.model.contacts`, each of which answers an oscillation e^(s t) with z_j(s), an element has

    H(s) = sum_j z_j(s) h_j h_j' + G,    Z(s) = H_dd - H_dv H_vv^-1 H_vd,

and a small change dH of it, by places, loads or laws, makes

    dZ = L' dH R,    R = (1, -H_vv^-1 H_vd),    L' = (1, -H_dv H_vv^-1),

exactly to first order. D follows the ports of the bearing, the pose of its inner ring, or both rings and rollers that
are bodies, so that a bearing sums over its rolling elements.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray
from mbs.model.contacts import LAW_CHANGES, Contacts, Slopes


@dataclass(frozen=True, eq=False)
class Condensed:
    """A bearing for small motions, with the errors of its law.

    Attributes
    ----------
    contacts : Contacts
        Contacts at rest; of films with memory, whether or not they are looked at.
    pose : array (Z, m, p)
        D by the p ports.
    relaxes : bool
        Whether z(s) holds at any frequency, or stiffness and damping of slow motion do.
    slopes : Slopes or None
        Derivatives of contacts and forces by the ports, then by `mbs.model.contacts.LAW_CHANGES`, or by changes that
        have parts of all of these; None of laws that state no errors.
    natural : array (Z, J) or None
        Natural times of the contacts [s], 0 of dry ones; None where `left_out` says more.
    left_out : callable or None
        Part of z(s) that films with memory miss at frequencies s (k,) [1/s], and its possible error, as parts of z,
        (k, Z, J) each; None where it is not known.
    held_by : str
        Name of what holds that, for people.
    which : array (Z,), of int, or None
        Places of these rolling elements among all of the bearing; None for all of them.
    raceways : int or None
        How many contacts of an element are with raceways, the first ones; None for all.
    """

    contacts: Contacts
    pose: FloatArray
    relaxes: bool
    slopes: Slopes | None = None
    natural: FloatArray | None = None
    left_out: Callable[[ComplexArray], tuple[ComplexArray, FloatArray]] | None = None
    held_by: str = "map"
    which: IntArray | None = None
    raceways: int | None = None

    @property
    def stated(self) -> Slopes:
        """See `slopes`, of a law that states its errors."""
        assert self.slopes is not None
        return self.slopes

    def direction(self, kind: str) -> int:
        """Place among the directions of `slopes` of a kind of error of the law, one of `LAW_CHANGES`."""
        return int(self.pose.shape[2]) + LAW_CHANGES.index(kind)

    def with_changes(self, weights: FloatArray) -> Condensed:
        """The same by changes that have parts of the directions, weights (changes, directions)."""
        return dataclasses.replace(self, slopes=self.stated.combined(weights))

    @cached_property
    def stiffness(self) -> FloatArray:
        """K of slow motion at held speeds of the rings, shape (p, p)."""
        (left,), (right,) = self._ends(np.zeros(1, dtype=np.complex128), *self._whole)[:2]
        return np.asarray(np.einsum("zma,zmn,znb->ab", left, self._at_rest, right, optimize=True).real)

    @cached_property
    def damping(self) -> FloatArray:
        """C of slow motion, shape (p, p)."""
        (left,), (right,) = self._ends(np.zeros(1, dtype=np.complex128), *self._whole)[:2]
        feel, c = self.contacts.feel, self.contacts.damping
        return np.asarray(np.einsum("zja,zj,zjb->ab", (feel @ left).real, c, (feel @ right).real, optimize=True))

    @cached_property
    def changes_of_slow_motion(self) -> tuple[FloatArray, FloatArray]:
        """Derivatives of K and C by the q directions, shape (q, p, p) each."""
        (left,), (right,) = (part.real for part in self._ends(np.zeros(1, dtype=np.complex128), *self._whole)[:2])
        at, by = self.contacts, self.stated.contacts
        m = self.pose.shape[1]
        own = self._at_rest[:, m:, m:]
        half = np.swapaxes(by.feel, -1, -2) @ (at.stiffness[..., None] * at.feel)
        moved = half + np.swapaxes(half, -1, -2) + by.turning
        moved += np.swapaxes(at.feel, -1, -2) @ (by.stiffness[..., None] * at.feel)
        after, before = moved @ right, np.swapaxes(moved, -1, -2) @ left
        by_stiffness = np.einsum("zma,qzmb->qab", left, after, optimize=True)
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
        """Derivatives of Z(s) by the q directions at frequencies s (k,) [1/s], shape (q, k, p, p)."""
        return self.changes_along(s, *self._whole)

    def changes_along(self, s: ComplexArray, left: ComplexArray, right: ComplexArray) -> ComplexArray:
        """The same between motions of the ports, left' dZ(s) right, shape (q, k, a, b).

        Parameters
        ----------
        s : array, shape (k,)
            Complex frequencies [1/s].
        left, right : array, shape (k, p, a), (k, p, b)
            Motions at each of them, or the same ones at all, (1, p, a), (1, p, b).
        """
        if not self.relaxes:
            by_stiffness, by_damping = self.changes_of_slow_motion
            slow = by_stiffness[:, None] + s[:, None, None] * by_damping[:, None]
            return np.asarray(np.swapaxes(left, -1, -2) @ slow @ right)
        at, by = self.contacts, self.stated.contacts
        before, after, z = self._ends(s, left, right)
        place = s[:, None, None, None]
        slow = place / (1.0 + place * at.times)
        shared = at.damping[..., None] * at.shares
        dampers = by.damping[..., None] * at.shares + at.damping[..., None] * by.shares
        change = by.stiffness[:, None] + np.sum(slow * dampers[:, None] - slow**2 * shared * by.times[:, None], axis=-1)
        moved = self._on_elements(np.swapaxes(change, 0, 1))
        turns = np.flatnonzero(np.any(by.feel, axis=(1, 2, 3)) | np.any(by.turning, axis=(1, 2, 3)))
        if turns.size:
            # (1, q, Z, n, J) with (k, 1, Z, J, n)
            half = np.swapaxes(by.feel[turns], -1, -2)[None] @ (z[..., None] * at.feel)[:, None]
            moved[:, turns] += half + np.swapaxes(half, -1, -2) + by.turning[turns]
        return np.ascontiguousarray(np.swapaxes(_between(before, moved, after), 0, 1))

    def by_approach(self, s: ComplexArray, count: int) -> ComplexArray:
        """Forces on the ports by approaches added to contacts with the raceways, shape (k, count, 2, p) [N/m].

        Parameters
        ----------
        s : array, shape (k,)
            Complex frequencies [1/s].
        count : int
            Number of rolling elements of the bearing; on those that are not here there is none.
        """
        at, m = self.contacts, self.pose.shape[1]
        if not self.relaxes and np.any(at.times):
            slow = dataclasses.replace(self, contacts=at._replace(times=np.zeros_like(at.times)))
            return slow.by_approach(s, count)
        before, _, z = self._ends(s, *self._whole)
        felt = -np.einsum("kzna,zjn,kzj->kzja", before, at.feel, z, optimize=True)[:, :, : self.raceways]
        # contacts with both raceways in series feel D alone, those with the outer one V alone
        inner = np.any(at.feel[..., :m], axis=-1)[:, : self.raceways]
        outer = np.ones_like(inner) if at.feel.shape[-1] == m else ~inner
        found = np.zeros((s.size, count, 2, self.pose.shape[2]), dtype=np.complex128)
        where = np.arange(count) if self.which is None else self.which
        for side, on in enumerate((inner, outer)):
            found[:, where, side] = np.sum(felt * on[:, :, None], axis=2)
        return found

    def parts_along(
        self, s: ComplexArray, left: ComplexArray, right: ComplexArray, part: ComplexArray, size: FloatArray
    ) -> tuple[ComplexArray, ComplexArray]:
        """Changes of left' Z(s) right by changes of the z(s) of all contacts, to first order, shape (k, a, b) each.

        Parameters
        ----------
        s, left, right
            The same as of `changes_along`.
        part, size : array, shape (k, Z, J)
            Changes of z, as parts of it; others, as parts of its size: of one phase for all contacts.
        """
        before, after, z = self._ends(s, left, right)
        changes = np.stack([z * part, np.abs(z) * size], axis=1)
        missing, possible = np.moveaxis(_between(before, self._on_elements(changes), after), 1, 0)
        return missing, possible

    def _on_elements(self, change: ComplexArray) -> ComplexArray:
        """Changes of H of the rolling elements, (k, q, Z, n, n), by those of the z of their contacts, (k, q, Z, J)."""
        feel = self.contacts.feel
        k, q, count, size = change.shape
        outer = (feel[..., :, None] * feel[..., None, :]).reshape(count, size, -1)
        found = np.moveaxis(change, 2, 0).reshape(count, k * q, size) @ outer
        return np.asarray(np.moveaxis(found.reshape(count, k, q, *feel.shape[-1:] * 2), 0, 2))

    @property
    def _whole(self) -> tuple[ComplexArray, ComplexArray]:
        """All motions of the ports, on both sides."""
        every = np.eye(self.pose.shape[2], dtype=np.complex128)[None]
        return every, every

    @cached_property
    def _at_rest(self) -> FloatArray:
        """H at s = 0, shape (Z, n, n)."""
        return self.contacts.at_rest

    def _ends(
        self, s: ComplexArray, left: ComplexArray, right: ComplexArray
    ) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """Motions (D, V) of the rolling elements, (k, Z, n, a) on the left, (.., b) on the right, and z (k, Z, J)."""
        at = self.contacts
        place = s[:, None, None, None]
        z = at.stiffness + at.damping * np.sum(place * at.shares / (1.0 + place * at.times), axis=-1)
        matrix = np.swapaxes(at.feel, 1, 2) @ (z[..., None] * at.feel) + at.turning
        m = self.pose.shape[1]
        by_left, by_right = (
            self.pose @ np.broadcast_to(part, (s.size, *part.shape[1:]))[:, None] for part in (left, right)
        )
        whole = matrix[:, :, m:, m:]
        follow = np.linalg.solve(whole, matrix[:, :, m:, :m] @ by_right)
        lead = np.linalg.solve(np.swapaxes(whole, -1, -2), np.swapaxes(matrix[:, :, :m, m:], -1, -2) @ by_left)
        before, after = np.concatenate([by_left, -lead], axis=-2), np.concatenate([by_right, -follow], axis=-2)
        return np.asarray(before), np.asarray(after), np.asarray(z)


def _between(before: ComplexArray, moved: ComplexArray, after: ComplexArray) -> ComplexArray:
    """Sums of left' dH right over the rolling elements, (k, q, a, b), by dH (k, q, Z, n, n)."""
    k, q, count, n, _ = moved.shape
    right = (moved @ after[:, None]).reshape(k, q, count * n, -1)
    left = np.swapaxes(before.reshape(k, count * n, -1), 1, 2)
    return np.asarray(left[:, None] @ right)

"""Contacts of rolling elements in balance, at rest: how elements follow a ring, how films relax, how laws change.

A rolling element is moved by D (m,), what the ports of its bearing do to it, and by its own V, without mass against
small motions; slices of cylindrical rollers have no V. Contact j feels h_j.(D, V) and has a spring k, and dampers in
series with springs. With the stiffness G by which loads turn, it stands in

    H = sum_j k_j h_j h_j' + G,

in which V is in balance. Speed makes G of balls unsymmetrical. `mbs.model.condensed` has the same at any frequency.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.model.relaxation import Relaxation, relaxing

LAW_CHANGES = ("stiffness", "damping", "film")
"""Kinds of errors of a law: of k and of c at the load, and of the thickness of films."""

_LEAST = 1e-9
"""Part of the damping of a bearing below which dampers stay without springs."""


class Contacts(NamedTuple):
    """Contacts of Z rolling elements, J each: numbers, or their derivatives by q directions with a first axis more.

    Attributes
    ----------
    feel : array (Z, J, n)
        Vectors h, by the m of D and the n - m of V.
    turning : array (Z, n, n)
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

    @property
    def at_rest(self) -> FloatArray:
        """H, shape (Z, n, n)."""
        return np.asarray(np.swapaxes(self.feel, -1, -2) @ (self.stiffness[..., None] * self.feel) + self.turning)


class Followed(NamedTuple):
    """Rolling elements that follow the ports of their bearing, one by one, and then films that are thicker.

    Attributes
    ----------
    motion : array (p + 1, Z, n)
        D and V.
    approach : array (p + 1, Z, J)
        Approaches of the contacts [m].
    force : array (p + 1, p)
        Force on the ports [N], [N m].
    """

    motion: FloatArray
    approach: FloatArray
    force: FloatArray


class LawSlopes(NamedTuple):
    """Law of contacts nearby: derivatives of its numbers by the approach, and by how much they may be wrong.

    Attributes
    ----------
    stiffness, damping : array (Z, J)
        Derivatives of k and c.
    shares, times : array (Z, J, r)
        Those of the parts of the dampers and of their times.
    by_stiffness, by_damping : array (Z, J)
        Bounds of k and c, as parts of them.
    thicker : array (Z, J)
        Bound of the film [m].
    """

    stiffness: FloatArray
    damping: FloatArray
    shares: FloatArray
    times: FloatArray
    by_stiffness: FloatArray
    by_damping: FloatArray
    thicker: FloatArray


class Slopes(NamedTuple):
    """Derivatives of a bearing by q directions: its p ports [m] or [rad], then a law that is wrong by its bounds, once.

    The law changes at held ports. Rolling elements follow in balance, with all that they make the cage do.

    Attributes
    ----------
    contacts : Contacts
        Derivatives of the contacts.
    forces : array (q, p)
        Those of the force on the ports [N], [N m].
    """

    contacts: Contacts
    forces: FloatArray

    def combined(self, weights: FloatArray) -> Slopes:
        """Derivatives by changes that have parts of the directions, weights (changes, q)."""
        return Slopes(Contacts(*(np.tensordot(weights, part, 1) for part in self.contacts)), weights @ self.forces)


def film_directions(ports: int) -> list[int]:
    """Directions of `Slopes` in which rolling elements move: those of the ports, and that of films.

    Parameters
    ----------
    ports : int
        How many ports there are.
    """
    return [*range(ports), ports + LAW_CHANGES.index("film")]


def followed(contacts: Contacts, pose: FloatArray, thicker: FloatArray) -> Followed:
    """Rolling elements in balance where the ports of their bearing move, and where films are thicker, to first order.

    Parameters
    ----------
    contacts : Contacts
        Contacts at rest.
    pose : array (Z, m, p)
        D by the ports.
    thicker : array (Z, J)
        Films [m].
    """
    feel, k, whole = contacts.feel, contacts.stiffness, contacts.at_rest
    count, m, ports = pose.shape
    ring, film = np.zeros((ports + 1, count, m)), np.zeros((ports + 1, *k.shape))
    ring[:ports], film[ports] = np.moveaxis(pose, 2, 0), thicker
    pushed = whole[:, m:, :m] @ ring[..., None] + np.swapaxes(feel[..., m:], 1, 2) @ (k * film)[..., None]
    motion = np.concatenate([ring, -np.linalg.solve(whole[:, m:, m:], pushed)[..., 0]], axis=-1)
    approach = (feel @ motion[..., None])[..., 0] + film
    load = np.swapaxes(feel, 1, 2) @ (k * approach)[..., None] + contacts.turning @ motion[..., None]
    return Followed(motion, approach, -np.einsum("zmi,qzm->qi", pose, load[..., :m, 0]))


def law_slopes(contacts: Contacts, moved: Followed, law: LawSlopes, *, locked: bool) -> Slopes:
    """Derivatives of contacts whose normals and levers stand still.

    Parameters
    ----------
    contacts : Contacts
        Contacts at rest.
    moved : Followed
        Rolling elements that follow, with the films of the law thicker.
    law : LawSlopes
        The law.
    locked : bool
        Whether contacts whose k or c is wrong keep the stiffness of their locked film, k + c/theta, with one damper
        each; else their times.
    """
    ports = moved.force.shape[1]
    where, stiffer, damped = film_directions(ports), ports, ports + 1
    k, c = contacts.stiffness, contacts.damping
    slopes, forces = none_moved(contacts, ports + len(LAW_CHANGES)), np.zeros((ports + len(LAW_CHANGES), ports))
    forces[where] = moved.force
    slopes.stiffness[where], slopes.damping[where] = law.stiffness * moved.approach, law.damping * moved.approach
    slopes.shares[where], slopes.times[where] = (part * moved.approach[..., None] for part in (law.shares, law.times))
    slopes.stiffness[stiffer], slopes.damping[damped] = law.by_stiffness * k, law.by_damping * c
    if locked:
        softer = np.where(c > 0.0, slopes.stiffness[stiffer] / np.where(c > 0.0, c, 1.0), 0.0)
        slopes.times[stiffer] = contacts.times**2 * softer[..., None]
        slopes.times[damped] = contacts.times * law.by_damping[..., None]
    return Slopes(slopes, forces)


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


def relaxation(contacts: Contacts, pose: FloatArray, films: int | None = None) -> Relaxation:
    """Springs in series with dampers that a bearing is, Z J r of them; those that do not relax have no stiffness.

    With the approaches of the dampers by D in slow motion, Xi = h_d - h_v H_vv^-1 H_vd, and with diagonal matrices of
    their c and theta, small motions of D see

        Z(s) = K + s C - s^2 Xi' c^(1/2) T (1 + s T)^-1 c^(1/2) Xi,    T = theta + c^(1/2) h_v H_vv^-1 h_v' c^(1/2),

    T the compliance that the dampers feel while the rolling element is in balance: its eigenvalues are the times of as
    many springs in series with dampers, which is what `mbs.model.relaxation` takes. T has no difference of numbers, so
    that none is negative. K and C are those of the bearing, exactly. Where speed makes H unsymmetrical, T comes from
    the symmetric part of H_vv, and Xi is the mean of what goes in and what comes back: that changes nothing at low
    frequency.

    Parameters
    ----------
    contacts : Contacts
        Contacts at rest.
    pose : array (Z, m, p)
        D by the ports of the bearing.
    films : int, optional
        Number of contacts of each rolling element, the first ones, that have films, in place of all J.
    """
    m, r, own = pose.shape[1], contacts.shares.shape[-1], contacts.at_rest[:, pose.shape[1] :, pose.shape[1] :]
    first = slice(films if films is None else films * r)
    damping, times, ends = (part[:, first] for part in _slow_dampers(contacts, m))
    relaxes = (damping > 0.0) & (times > 0.0)
    root = np.sqrt(np.where(relaxes, damping, 0.0))[..., None]
    felt = root * np.repeat(contacts.feel[..., m:], r, axis=1)[:, first]
    compliance = felt @ np.linalg.solve(0.5 * (own + np.swapaxes(own, 1, 2)), np.swapaxes(felt, 1, 2))
    places = np.arange(root.shape[1])
    compliance[:, places, places] += np.where(relaxes, times, 1.0)
    theta, turns = np.linalg.eigh(0.5 * (compliance + np.swapaxes(compliance, 1, 2)))
    seen = np.swapaxes(turns, 1, 2) @ (root * ends)
    taken = np.sum((seen * _sizes(contacts.feel, m)) ** 2, axis=2)
    keeps = taken > _LEAST * taken.sum()
    longest = float(theta[keeps].max()) if np.any(keeps) else 1.0
    rows = np.where(keeps[..., None], seen / np.sqrt(theta)[..., None] @ pose, 0.0)
    return Relaxation(rows.reshape(-1, pose.shape[2]), np.where(keeps, theta, longest).reshape(-1))


def slow_springs(contacts: Contacts, pose: FloatArray) -> Relaxation:
    """Springs in series with dampers of all contacts one by one, as they move in slow motion: for estimates.

    Parameters
    ----------
    contacts, pose
        The same as of `relaxation`.
    """
    damping, times, ends = _slow_dampers(contacts, pose.shape[1])
    return relaxing((ends @ pose).reshape(-1, pose.shape[2]), damping.reshape(-1), times.reshape(-1))


def _slow_dampers(contacts: Contacts, m: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Dampers of each rolling element: c and theta (Z, J r), and Xi (Z, J r, m)."""
    feel, whole, r = contacts.feel, contacts.at_rest, contacts.shares.shape[-1]
    own, into, back = whole[:, m:, m:], whole[:, m:, :m], np.swapaxes(whole[:, :m, m:], 1, 2)
    follow = 0.5 * (np.linalg.solve(own, into) + np.linalg.solve(np.swapaxes(own, 1, 2), back))
    ends = feel[..., :m] - feel[..., m:] @ follow
    damping, times = contacts.damping[..., None] * contacts.shares, contacts.times
    flat = (feel.shape[0], feel.shape[1] * r)
    return damping.reshape(flat), times.reshape(flat), np.repeat(ends, r, axis=1)


def _sizes(feel: FloatArray, m: int) -> FloatArray:
    """Weights of the m motions of D by which they are beside each other: a tilt, the third, at the longest lever."""
    lever = np.abs(feel[..., m - 1]).max(initial=0.0) if m > 2 else 1.0
    return np.array([1.0, 1.0, 1.0 / (lever or 1.0)][:m])

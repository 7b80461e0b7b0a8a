"""Rollers that are bodies, in compiled runs: where each stands between the rings, and what its contacts answer.

A bearing feels the displacements y, z of both rings, the tilts of the inner ring against the outer one, and the radial
place of each roller, which nothing else touches: see `mbs.model.blocks.Kind.alone`. Approaches are those of
`mbs.bearings.roller_contacts`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import njit
from mbs.bearings.rings import Rings, gather_rings
from mbs.bearings.roller_element import RollerElement
from mbs.model.blocks import Answers, Member, Moment

INNER, OUTER = 0, 1
"""Contacts of a roller."""

_FELT = 6
_TILTS = 4


class Rollers(NamedTuple):
    """Bearings with rollers that are bodies as arrays, one row a bearing.

    Attributes
    ----------
    rings : Rings
        What does not change; clearance and profiles are those of both contacts of a roller together.
    alone : array (bearings,), of int
        Place of the first roller of each among what all elements feel.
    outward : array (bearings,)
        Centrifugal force of a roller by the square of the speed [N s2/rad2].
    films_of : array (bearings, 2), of int
        Films of the inner and of the outer contacts.
    """

    rings: Rings
    alone: IntArray
    outward: FloatArray
    films_of: IntArray


class Place(NamedTuple):
    """Where a roller stands, and how it moves.

    Attributes
    ----------
    cos, sin : float
        Direction of the roller.
    approach, rate : (float, float)
        Approach in the middle of the inner and of the outer contact [m], without the profile, and its rate [m/s].
    tilt, tilt_rate : float
        How both grow along the roller.
    """

    cos: float
    sin: float
    approach: tuple[float, float]
    rate: tuple[float, float]
    tilt: float
    tilt_rate: float


class Contact(NamedTuple):
    """What a contact of a roller answers: sums over its slices.

    Attributes
    ----------
    load, moment : float
        Sum of the loads [N], and of the loads times the places of the slices [N m].
    flat, mixed, tilted : float
        Sum of the slopes by_q k + by_v c, and of these times the places, once and twice.
    """

    load: float
    moment: float
    flat: float
    mixed: float
    tilted: float


@njit(error_model="numpy")
def place_of(rollers: Rollers, b: int, j: int, cage: tuple[float, float], motion: FloatArray) -> Place:
    """Where a roller stands.

    Parameters
    ----------
    rollers : Rollers
        All bearings.
    b, j : int
        Which bearing, and which of its rollers.
    cage : (float, float)
        Cosine and sine of the angle of its first roller.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    """
    rings = rollers.rings
    i, own = rings.firsts[b], rollers.alone[b] + j
    c = cage[0] * rings.cos[b, j] - cage[1] * rings.sin[b, j]
    s = cage[1] * rings.cos[b, j] + cage[0] * rings.sin[b, j]
    x, v = motion[0], motion[1]
    # Half the clearance of the bearing, which is that of both contacts.
    lost = 0.5 * rings.sizes[b, 0]
    return Place(
        c,
        s,
        (x[i] * c + x[i + 1] * s - x[own] - lost, x[own] - x[i + 2] * c - x[i + 3] * s - lost),
        (v[i] * c + v[i + 1] * s - v[own], v[own] - v[i + 2] * c - v[i + 3] * s),
        0.5 * (x[i + 5] * c - x[i + 4] * s),
        0.5 * (v[i + 5] * c - v[i + 4] * s),
    )


@njit(error_model="numpy")
def begin_answer(rollers: Rollers, b: int, moment: Moment, answers: Answers) -> None:
    """Begin the answer of a bearing: centrifugal forces of its rollers, and nothing else yet.

    Parameters
    ----------
    rollers : Rollers
        All bearings.
    b : int
        Which one.
    moment : Moment
        The moment, for the speed.
    answers : Answers
        Answers of all elements, filled.
    """
    rings = rollers.rings
    first, own, count = rings.firsts[b], rollers.alone[b], rings.rollers[b]
    force, slopes = answers.force, answers.slopes
    force[first : first + _FELT] = 0.0
    slopes[first : first + _FELT, first : first + _FELT] = 0.0
    outward = rollers.outward[b] * moment.speed * moment.speed
    for r in range(own, own + count):
        force[r] = outward
        slopes[r, r] = 0.0
        slopes[r, first : first + _FELT] = 0.0
        slopes[first : first + _FELT, r] = 0.0


@njit(error_model="numpy")
def add_contact(rollers: Rollers, b: int, j: int, side: int, place: Place, contact: Contact, answers: Answers) -> None:
    """Add what a contact of a roller does to the ring and to the roller.

    Parameters
    ----------
    rollers : Rollers
        All bearings.
    b, j, side : int
        Which bearing, which of its rollers, and which contact.
    place : Place
        Place of the roller.
    contact : Contact
        Sums over the slices.
    answers : Answers
        Answers of all elements.
    """
    first, own = rollers.rings.firsts[b], rollers.alone[b] + j
    sign = 1.0 if side == INNER else -1.0
    ring = first + 2 * side
    at = (ring, ring + 1, first + _TILTS, first + _TILTS + 1, own)
    flat = (sign * place.cos, sign * place.sin, 0.0, 0.0, -sign)
    tilted = (0.0, 0.0, -0.5 * place.sin, 0.5 * place.cos, 0.0)
    for p in range(5):
        answers.force[at[p]] -= flat[p] * contact.load + tilted[p] * contact.moment
        by_flat = flat[p] * contact.flat + tilted[p] * contact.mixed
        by_tilt = flat[p] * contact.mixed + tilted[p] * contact.tilted
        for q in range(5):
            answers.slopes[at[p], at[q]] += by_flat * flat[q] + by_tilt * tilted[q]


@njit(error_model="numpy")
def outward_power(rollers: Rollers, b: int, moment: Moment, motion: FloatArray) -> float:
    """Power of the centrifugal forces on the rollers of a bearing [W].

    Parameters
    ----------
    rollers, b, moment, motion
        What `place_of` and `begin_answer` take.
    """
    own, total = rollers.alone[b], 0.0
    for r in range(own, own + rollers.rings.rollers[b]):
        total += motion[1, r]
    power: float = total * rollers.outward[b] * moment.speed * moment.speed
    return power


def feels(element: RollerElement) -> FloatArray:
    """Rows of what a bearing feels of its rings, shape (6, 12 + Z)."""
    rows = np.zeros((_FELT, element.contacts.size))
    for row, place in enumerate((1, 2, 7, 8)):
        rows[row, place] = 1.0
    for row, place in ((_TILTS, 4), (_TILTS + 1, 5)):
        rows[row, place], rows[row, place + 6] = 1.0, -1.0
    return rows


def alone(element: RollerElement) -> FloatArray:
    """Rows of the radial places of its rollers, shape (Z, 12 + Z)."""
    size = element.contacts.size
    return np.asarray(np.eye(size)[12:])


def gather_rollers(members: Sequence[Member], films_of: Iterable[int]) -> Rollers:
    """The arrays of some bearings, and which film each of their contacts has, inner and outer one after the other."""
    plains = [member.element.plain for member in members]
    rings = gather_rings([member._replace(element=member.element.plain) for member in members], [0] * len(members))
    films = np.array(list(films_of), dtype=np.int64).reshape(len(members), 2)
    return Rollers(
        rings=rings._replace(films_of=films[:, INNER].copy()),
        alone=np.array([member.alone for member in members], dtype=np.int64),
        outward=np.array([plain.rates[2] * plain.bearing.geometry.roller_length for plain in plains], dtype=np.float64),
        films_of=films,
    )

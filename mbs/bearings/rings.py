"""Bearings of a compiled run as arrays: what does not change of them, and how their rings and rollers move.

One class of arrays holds massless rollers, whose contacts have one side, and rollers as bodies, whose contacts have
two. Blocks with and without memory of the films share it; `mbs.bearings.bearing_block` and `mbs.bearings.memory_block`
add what each slice needs. Rings that cannot tilt against each other press slices of the same depth alike: each depth is
looked at once, with the number of such slices as its weight, and neither tilts nor moments are computed
(`mbs.bearings.bearing_kernel`). With memory it is both of a pair left and right of the middle, whatever the profile:
slices take the parabolas of their films anew in turn, and with one slice a roller all of them would have the same turn.

A bearing whose rollers are bodies feels the displacements y, z of both rings, the tilts of the inner ring against the
outer one, and the radial place of each roller, which nothing else touches: see `mbs.model.blocks.Kind.alone`.
Approaches are those of `mbs.bearings.roller_contacts`.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.compiled import njit
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement, RollerElement
from mbs.bearings.cylinder import Cylinder, cylinder_of
from mbs.bearings.laws import FlatLaw
from mbs.bearings.slices import RingMotion, Shape, Sizes, sizes_of
from mbs.bearings.speed_tables import shared
from mbs.model.blocks import Answers, Member, Moment

FELT = np.array([1, 2, 4, 5])
"""Displacements of its port that a bearing feels: y, z, theta_y, theta_z."""

LEVEL = 2
"""How many of them one feels whose rings do not tilt: the first ones."""

_TILTS = FELT[LEVEL:]

_FELT, _TILT_PLACE = 6, 4
"""How many displacements of both rings a bearing feels whose rollers are bodies, and where the tilts are among them."""

_SAME = 12
"""Digits of the deepest profile to which depths are the same."""

_NO_DEPTH, _ROUND_OFF = 1e-30, 1e-12


class Rings(NamedTuple):
    """Bearings as arrays, one row a bearing; rows of slices and rollers are as long as the longest.

    A contact of a roller has one side, where both contacts in series stand for a massless roller, or two, the inner and
    the outer one of a roller that is a body. All bearings of a block have as many.

    Attributes
    ----------
    firsts, places : array (bearings,), of int
        First of what each feels, its place among all elements.
    films_of : array (bearings, sides), of int
        Film of each contact.
    rollers, slices : array (bearings,), of int
        How many each has.
    start_angles, cage_rates : array (bearings,)
        Angle of the first roller [rad], and cage angle by that of the system.
    sizes : array (bearings, 6)
        `Sizes` in their order; clearance and profiles are those of both contacts of a roller together.
    positions, profiles : array (bearings, n)
        Slices, see `Shape` [m].
    cos, sin : array (bearings, Z)
        Directions of the rollers, see `Shape`.
    felt : array (bearings,), of int
        How many displacements of rings each feels: 4, 2 of rings that do not tilt, 6 with rollers as bodies.
    weights : array (bearings, n)
        How many slices each slice stands for; 1 where rings tilt.
    alone : array (bearings,), of int
        Place of the first roller among what all elements feel, where rollers are bodies.
    outward : array (bearings,)
        Centrifugal force of a roller that is a body by the square of the speed [N s2/rad2].
    """

    firsts: IntArray
    places: IntArray
    films_of: IntArray
    rollers: IntArray
    slices: IntArray
    start_angles: FloatArray
    cage_rates: FloatArray
    sizes: FloatArray
    positions: FloatArray
    profiles: FloatArray
    cos: FloatArray
    sin: FloatArray
    felt: IntArray
    weights: FloatArray
    alone: IntArray
    outward: FloatArray

    @property
    def most_slices(self) -> int:
        """Slices of all rollers together, of the bearing that has most."""
        return int(np.max(self.rollers * self.slices, initial=0))


@njit(error_model="numpy", forceinline=True)
def cage_of(rings: Rings, b: int, moment: Moment) -> tuple[float, float]:
    """Cosine and sine of the angle of the first roller of a bearing, with the arguments as for `motion_of`."""
    angle = rings.start_angles[b] + rings.cage_rates[b] * moment.angle
    return math.cos(angle), math.sin(angle)


@njit(error_model="numpy", forceinline=True)
def motion_of(rings: Rings, b: int, moment: Moment, motion: FloatArray) -> RingMotion:
    """Motion of the inner ring of a bearing against the outer one.

    Parameters
    ----------
    rings : Rings
        All bearings.
    b : int
        Which one.
    moment : Moment
        The moment, for the angle of the cage.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    """
    i, x, y = rings.firsts[b], motion[0], motion[1]
    c, s = cage_of(rings, b, moment)
    if rings.felt[b] == LEVEL:
        return RingMotion(x[i], x[i + 1], 0.0, 0.0, y[i], y[i + 1], 0.0, 0.0, c, s)
    return RingMotion(x[i], x[i + 1], x[i + 2], x[i + 3], y[i], y[i + 1], y[i + 2], y[i + 3], c, s)


@njit(error_model="numpy", forceinline=True)
def shape_of(rings: Rings, b: int) -> Shape:
    """Return the data of a bearing that do not change."""
    z, n = rings.rollers[b], rings.slices[b]
    return Shape(
        sizes_of(rings.sizes[b]), rings.positions[b][:n], rings.profiles[b][:n], rings.cos[b][:z], rings.sin[b][:z]
    )


@njit(error_model="numpy", forceinline=True)
def answer_ring(first: int, felt: int, moment: Moment, out: FloatArray, answers: Answers) -> None:
    """Put force, stiffness and damping of a bearing among the answers of all elements.

    Parameters
    ----------
    first, felt : int
        First of what the bearing feels, and how many.
    moment : Moment
        Weights of the slopes.
    out : array (13, 6)
        Force, six rows of stiffness, six rows of damping.
    answers : Answers
        Answers of all elements, filled.
    """
    for i in range(felt):
        k = FELT[i]
        answers.force[first + i] = out[0, k]
        for j in range(felt):
            slope = moment.by_q * out[1 + k, FELT[j]] + moment.by_v * out[7 + k, FELT[j]]
            answers.slopes[first + i, first + j] = slope


@njit(error_model="numpy", forceinline=True)
def turned_by(first: int, pairs: int, motion: FloatArray, answers: Answers) -> float:
    """Moment that a bearing asks of its cage [N m]: sum of y f_z - z f_y over pairs of what it feels, tilts likewise.

    Turning cage and rings together does no work, so that what the cage needs is what the rings give.

    Parameters
    ----------
    first, pairs : int
        First of what the bearing feels, and how many pairs it feels.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    answers : Answers
        Answers of all elements.
    """
    total = 0.0
    for i in range(first, first + 2 * pairs, 2):
        total += motion[0, i] * answers.force[i + 1] - motion[0, i + 1] * answers.force[i]
    return total


def feels(element: BearingElement | RollerElement) -> FloatArray:
    """Rows of what a bearing feels of its rings: (4, 6), (2, 6) without tilts, (6, 12 + Z) with rollers as bodies."""
    if not isinstance(element, RollerElement):
        return np.asarray(np.eye(6)[FELT[: _felt(element)]])
    rows = np.zeros((_FELT, element.contacts.size))
    for row, place in enumerate((1, 2, 7, 8)):
        rows[row, place] = 1.0
    for row, place in ((_TILT_PLACE, 4), (_TILT_PLACE + 1, 5)):
        rows[row, place], rows[row, place + 6] = 1.0, -1.0
    return rows


def alone(element: RollerElement) -> FloatArray:
    """Rows of the radial places of its rollers, shape (Z, 12 + Z)."""
    return np.asarray(np.eye(element.contacts.size)[12:])


def placed(element: BearingElement, transform: FloatArray) -> BearingElement:
    """A bearing as it stands in a system: whether its rings can tilt against each other; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    element : BearingElement
        The bearing.
    transform : array, shape (6, n)
        Displacement of the inner ring against the outer one by the coordinates.
    """
    depths = element.bearing.profile_depths
    # A profile that is not the same on both sides makes moments, which runs record.
    mirrored = np.all(np.abs(depths - depths[::-1]) <= _ROUND_OFF * np.max(np.abs(depths)))
    if np.any(transform[_TILTS]) or not mirrored:
        return element
    return dataclasses.replace(element, tilts=False)


class Folding(NamedTuple):
    """Slices of the same depth, which rings that do not tilt press alike.

    Attributes
    ----------
    firsts : array (k,), of int
        First slice of each depth.
    groups : array (n,), of int
        Which depth each slice has.
    weights : array (k,)
        How many slices each depth has.
    """

    firsts: IntArray
    groups: IntArray
    weights: FloatArray


def folding_of(element: BearingElement) -> Folding:
    """Choose the slices of a bearing to compute: all where its rings tilt, else one of each depth, or of each pair."""
    depths = element.bearing.profile_depths
    each = np.arange(depths.size)
    if element.tilts:
        return Folding(each, each, np.ones(depths.size))
    if element.films == "memory":
        alike = np.asarray(np.minimum(each, each[::-1]), dtype=np.float64)
    else:
        alike = np.round(depths / max(float(np.max(np.abs(depths))), _NO_DEPTH), _SAME)
    _, firsts, groups, counts = np.unique(alike, return_index=True, return_inverse=True, return_counts=True)
    return Folding(firsts, groups.reshape(-1), counts.astype(np.float64))


def _felt(element: BearingElement | RollerElement) -> int:
    """Number of displacements of rings that a bearing feels."""
    if isinstance(element, RollerElement):
        return _FELT
    return FELT.size if element.tilts else LEVEL


class Alike(NamedTuple):
    """Contacts with the same law at the same conditions, which share its tables.

    Attributes
    ----------
    bearing : Bearing
        That of the first of them.
    law : FlatLaw
        The law.
    temperature : float
        [K].
    rates : (float, float)
        Entrainment speed for each speed of the system, and centrifugal load for its square.
    """

    bearing: Bearing
    law: FlatLaw
    temperature: float
    rates: tuple[float, float]


def alike_contacts(members: Sequence[Member]) -> tuple[IntArray, list[Alike]]:
    """Film of each contact of some bearings, shape (bearings, sides), and what the contacts of each film share."""
    contacts = []
    for element in (member.element for member in members):
        massless = plain(element)
        # The centrifugal load of rollers that are bodies acts on them, and not in their contacts.
        rates = massless.rates[1], 0.0 if isinstance(element, RollerElement) else massless.rates[2]
        contacts += [Alike(massless.bearing, law, massless.temperature, rates) for law in element.flat_laws]
    films_of, firsts = shared((id(one.law.law), one.temperature, *one.rates) for one in contacts)
    sides = len(contacts) // len(members) if members else 1
    return _whole(films_of).reshape(len(members), sides), [contacts[first] for first in firsts]


def plain(element: BearingElement | RollerElement) -> BearingElement:
    """The bearing with massless rollers."""
    return element.plain if isinstance(element, RollerElement) else element


def strict(members: Sequence[Member]) -> BoolArray:
    """True where a law of a bearing refuses loads above its map, shape (bearings,)."""
    return np.array([any(law.law.outside == "error" for law in m.element.flat_laws) for m in members], dtype=np.bool_)


def gather_rings(members: Sequence[Member], films_of: IntArray) -> Rings:
    """The arrays of some bearings, and which film each of their contacts has."""
    plains: list[BearingElement] = [plain(member.element) for member in members]
    shapes = [cylinder_of(element.bearing) for element in plains]
    folds = [folding_of(element) for element in plains]
    return Rings(
        firsts=_whole(member.first for member in members),
        places=_whole(member.place for member in members),
        films_of=films_of,
        rollers=_whole(shape.rollers for shape in shapes),
        slices=_whole(fold.firsts.size for fold in folds),
        start_angles=np.array([element.start_angle for element in plains], dtype=np.float64),
        cage_rates=np.array([element.rates[0] for element in plains], dtype=np.float64),
        sizes=np.array([_sizes(shape) for shape in shapes], dtype=np.float64).reshape(len(shapes), 6),
        positions=_padded([one.given("position")[fold.firsts] for one, fold in zip(shapes, folds, strict=True)]),
        profiles=_padded([one.given("profile")[fold.firsts] for one, fold in zip(shapes, folds, strict=True)]),
        cos=_padded([shape.given("cosine") for shape in shapes]),
        sin=_padded([shape.given("sine") for shape in shapes]),
        felt=_whole(_felt(member.element) for member in members),
        weights=_padded([fold.weights for fold in folds]),
        alone=_whole(member.alone for member in members),
        outward=np.array([plain.rates[2] * plain.bearing.geometry.roller_length for plain in plains], dtype=np.float64),
    )


def _sizes(shape: Cylinder) -> Sizes:
    """Sizes of a bearing for compiled code."""
    return Sizes(*(getattr(shape, name) for name in Sizes._fields))


def _padded(rows: Sequence[FloatArray]) -> FloatArray:
    """Rows of several lengths as one array, with zeros behind."""
    padded = np.zeros((len(rows), max((row.size for row in rows), default=0)))
    for place, row in zip(padded, rows, strict=True):
        place[: row.size] = row
    return padded


def _whole(numbers: Iterable[int]) -> IntArray:
    """Whole numbers as an array."""
    return np.array(list(numbers), dtype=np.int64)


class Place(NamedTuple):
    """Place of a roller, and its motion.

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
    """Answer of a contact of a roller: sums over its slices.

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
def place_of(rings: Rings, b: int, j: int, cage: tuple[float, float], motion: FloatArray) -> Place:
    """Find where a roller stands.

    Parameters
    ----------
    rings : Rings
        All bearings.
    b, j : int
        Which bearing, and which of its rollers.
    cage : (float, float)
        Cosine and sine of the angle of its first roller.
    motion : array (2, m)
        Displacements and their rates, among what all elements feel.
    """
    i, own = rings.firsts[b], rings.alone[b] + j
    c = cage[0] * rings.cos[b, j] - cage[1] * rings.sin[b, j]
    s = cage[1] * rings.cos[b, j] + cage[0] * rings.sin[b, j]
    x, v = motion[0], motion[1]
    # Half the clearance of the bearing, which is that of both contacts.
    half_clearance = 0.5 * rings.sizes[b, 0]
    return Place(
        c,
        s,
        (x[i] * c + x[i + 1] * s - x[own] - half_clearance, x[own] - x[i + 2] * c - x[i + 3] * s - half_clearance),
        (v[i] * c + v[i + 1] * s - v[own], v[own] - v[i + 2] * c - v[i + 3] * s),
        0.5 * (x[i + 5] * c - x[i + 4] * s),
        0.5 * (v[i + 5] * c - v[i + 4] * s),
    )


@njit(error_model="numpy")
def begin_answer(rings: Rings, b: int, moment: Moment, answers: Answers) -> None:
    """Begin the answer of a bearing: centrifugal forces of its rollers, and nothing else yet.

    Parameters
    ----------
    rings : Rings
        All bearings.
    b : int
        Which one.
    moment : Moment
        The moment, for the speed.
    answers : Answers
        Answers of all elements, filled.
    """
    first, own, count = rings.firsts[b], rings.alone[b], rings.rollers[b]
    force, slopes = answers.force, answers.slopes
    force[first : first + _FELT] = 0.0
    slopes[first : first + _FELT, first : first + _FELT] = 0.0
    outward = rings.outward[b] * moment.speed * moment.speed
    for r in range(own, own + count):
        force[r] = outward
        slopes[r, r] = 0.0
        slopes[r, first : first + _FELT] = 0.0
        slopes[first : first + _FELT, r] = 0.0


@njit(error_model="numpy")
def add_contact(rings: Rings, b: int, j: int, side: int, place: Place, contact: Contact, answers: Answers) -> None:
    """Add what a contact of a roller does to the ring and to the roller.

    Parameters
    ----------
    rings : Rings
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
    first, own = rings.firsts[b], rings.alone[b] + j
    sign = 1.0 - 2.0 * side
    ring = first + 2 * side
    at = (ring, ring + 1, first + _TILT_PLACE, first + _TILT_PLACE + 1, own)
    flat = (sign * place.cos, sign * place.sin, 0.0, 0.0, -sign)
    tilted = (0.0, 0.0, -0.5 * place.sin, 0.5 * place.cos, 0.0)
    for p in range(5):
        answers.force[at[p]] -= flat[p] * contact.load + tilted[p] * contact.moment
        by_flat = flat[p] * contact.flat + tilted[p] * contact.mixed
        by_tilt = flat[p] * contact.mixed + tilted[p] * contact.tilted
        for q in range(5):
            answers.slopes[at[p], at[q]] += by_flat * flat[q] + by_tilt * tilted[q]


@njit(error_model="numpy")
def outward_power(rings: Rings, b: int, moment: Moment, motion: FloatArray) -> float:
    """Power of the centrifugal forces on the rollers of a bearing [W]; none on massless ones.

    Parameters
    ----------
    rings, b, moment, motion
        What `place_of` and `begin_answer` take.
    """
    if rings.films_of.shape[1] == 1:
        return 0.0
    own, total = rings.alone[b], 0.0
    for r in range(own, own + rings.rollers[b]):
        total += motion[1, r]
    power: float = total * rings.outward[b] * moment.speed * moment.speed
    return power

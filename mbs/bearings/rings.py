"""Bearings of a compiled run as arrays: what does not change of them, and how their rings and rollers move.

One class of arrays holds massless rollers, whose contacts have one side, and rollers as bodies, whose contacts have
two. Blocks with and without memory of the films share it; `mbs.bearings.bearing_block` and `mbs.bearings.memory_block`
add what each slice needs. Rings that cannot tilt against each other press slices of the same depth alike: each depth is
looked at once, with the number of such slices as its weight, and neither tilts nor moments are computed (`cylinder.c`
of `ehdmaps.kernel`). With memory it is both of a pair left and right of the middle, whatever the profile:
slices take the parabolas of their films anew in turn, and with one slice a roller all of them would have the same turn.

A bearing whose rollers are bodies feels the displacements y, z of both rings, the tilts of the inner ring against the
outer one, and the radial place of each roller, which nothing else touches: see `mbs.model.blocks.Kind.alone`.
Approaches are those of `mbs.bearings.roller_contacts`.
"""

from __future__ import annotations

import ctypes
import dataclasses
from collections.abc import Iterable, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.kernel.library import checked
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import FELT, LEVEL, BearingElement, RingElement
from mbs.bearings.cylinder import cylinder_of
from mbs.bearings.deviating.tables import gathered
from mbs.bearings.laws import FlatLaw
from mbs.bearings.roller_element import RollerElement
from mbs.bearings.speed_tables import shared
from mbs.model.blocks import Member

_TILTS = FELT[LEVEL:]

_SIZES = "half_clearance", "slice_length", "most_travel", "most_tilt", "half_length", "least_profile"
"""Numbers of `mbs.bearings.cylinder.Cylinder` in `Rings.sizes`."""

_SAME = 12
"""Digits of the deepest profile to which depths are the same."""

_NO_DEPTH, _ROUND_OFF = 1e-30, 1e-12


_WHOLE = ("firsts", "places", "films_of", "rollers", "slices", "felt", "alone")
_OF_ROLLERS = ("cosine", "sine", "row_places")
_REAL = ("start_angles", "cage_rates", "sizes", "positions", "profiles", "weights", *_OF_ROLLERS, "outward")


class Rings(Record):
    """Bearings as C has them, one row a bearing; rows of slices and rollers are as long as the longest: `ehd_rings`.

    A contact of a roller has one side, where both contacts in series stand for a massless roller, or two, the inner and
    the outer one of a roller that is a body. All bearings of a block have as many.

    Attributes
    ----------
    count, sides, most_rollers, most_slices : int
        How many bearings, and contacts of a roller; lengths of the rows of rollers and slices.
    firsts, places : array (bearings,), of int
        First of what each feels, its place among all elements.
    films_of : array (bearings, sides), of int
        Film of each contact.
    rollers, slices : array (bearings,), of int
        How many each has.
    start_angles, cage_rates : array (bearings,)
        Angle of the first roller [rad], and cage angle by that of the system.
    sizes : array (bearings, 6)
        Half the clearance, length of a slice, most travel [m], most tilt [rad], half the length of a roller, least
        profile [m]; clearance and profiles are those of both contacts of a roller together.
    positions, profiles : array (bearings, n)
        Places of the slices along the roller, and twice the profile there [m]; the last one is no slice.
    cosine, sine : array (bearings, Z)
        Directions of the rollers in the cage.
    row_places : array (bearings, Z)
        Places of their rows along x [m].
    felt : array (bearings,), of int
        How many displacements of rings each feels: 4, 2 of rings that do not tilt, 6 with rollers as bodies.
    weights : array (bearings, n)
        How many slices each slice stands for; 1 where rings tilt, and the last one is no slice.
    alone : array (bearings,), of int
        Place of the first roller among what all elements feel, where rollers are bodies.
    outward : array (bearings,)
        Centrifugal force of a roller that is a body by the square of the speed [N s2/rad2].
    deviations : address or None
        Deviations of each bearing from its form, see `mbs.bearings.deviating.tables`.
    """

    deviating: Any = None
    _fields_ = (
        *((name, ctypes.c_int64) for name in ("count", "sides", "most_rollers", "most_slices")),
        *((name, integers) for name in _WHOLE),
        *((name, numbers) for name in _REAL),
        ("deviations", ctypes.c_void_p),
    )
    shapes: ClassVar = {
        **dict.fromkeys((*_WHOLE, "start_angles", "cage_rates", "outward"), ("count",)),
        "films_of": ("count", "sides"),
        "sizes": ("count", len(_SIZES)),
        **dict.fromkeys(("positions", "profiles", "weights"), ("count", "most_slices")),
        **dict.fromkeys(_OF_ROLLERS, ("count", "most_rollers")),
    }

    @property
    def most(self) -> int:
        """Slices of all rollers together, of the bearing that has most."""
        return int(np.max(self.given("rollers") * self.given("slices"), initial=0))


def feels(element: RingElement) -> FloatArray:
    """Rows of what a bearing feels of its rings, for `mbs.model.blocks.Kind`."""
    return element.felt_rows


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
        plain, rates = element.plain, element.contact_rates
        contacts += [Alike(plain.bearing, law, plain.temperature, rates) for law in element.flat_laws]
    films_of, firsts = shared((id(one.law.law), one.temperature, *one.rates) for one in contacts)
    sides = len(contacts) // len(members) if members else 1
    return _whole(films_of).reshape(len(members), sides), [contacts[first] for first in firsts]


def strict(members: Sequence[Member]) -> BoolArray:
    """True where a law of a bearing refuses loads above its map, shape (bearings,)."""
    return np.array([any(law.law.outside == "error" for law in m.element.flat_laws) for m in members], dtype=np.bool_)


def gather_rings(members: Sequence[Member], films_of: IntArray) -> Rings:
    """The arrays of some bearings, and which film each of their contacts has."""
    plains: list[BearingElement] = [member.element.plain for member in members]
    shapes = [cylinder_of(element.bearing) for element in plains]
    folds = [folding_of(element) for element in plains]
    positions, profiles = (
        _padded([np.append(one.given(name)[fold.firsts], 0.0) for one, fold in zip(shapes, folds, strict=True)])
        for name in ("position", "profile")
    )
    cosine, sine, row = (_padded([shape.given(name) for shape in shapes]) for name in ("cosine", "sine", "row"))
    count, sides = films_of.shape
    kept, deviations = gathered([element.deviation_data for element in plains])
    rings = checked(Rings, "ehd_rings")(
        count=count,
        sides=sides,
        most_rollers=cosine.shape[1],
        most_slices=positions.shape[1],
        firsts=_whole(member.first for member in members),
        places=_whole(member.place for member in members),
        films_of=films_of,
        rollers=_whole(shape.rollers for shape in shapes),
        slices=_whole(fold.firsts.size for fold in folds),
        start_angles=np.array([element.start_angle for element in plains], dtype=np.float64),
        cage_rates=np.array([element.rates[0] for element in plains], dtype=np.float64),
        sizes=np.array([[getattr(one, name) for name in _SIZES] for one in shapes]).reshape(count, len(_SIZES)),
        positions=positions,
        profiles=profiles,
        cosine=cosine,
        sine=sine,
        row_places=row,
        felt=_whole(feels(member.element).shape[0] for member in members),
        weights=_padded([np.append(fold.weights, 0.0) for fold in folds]),
        alone=_whole(member.alone for member in members),
        outward=np.array([plain.rates[2] * plain.bearing.geometry.roller_length for plain in plains], dtype=np.float64),
        deviations=deviations,
    )
    rings.deviating = kept
    return rings


def _padded(rows: Sequence[FloatArray]) -> FloatArray:
    """Rows of several lengths as one array, with zeros behind."""
    padded = np.zeros((len(rows), max((row.size for row in rows), default=0)))
    for place, row in zip(padded, rows, strict=True):
        place[: row.size] = row
    return padded


def _whole(numbers: Iterable[int]) -> IntArray:
    """Whole numbers as an array."""
    return np.array(list(numbers), dtype=np.int64)

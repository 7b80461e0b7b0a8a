"""Bands of what is not known in words: values with the digits that they deserve, bounds, what decides them.

Commands, reports and figures say these things alike, by the functions here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ehdmaps.arrays import IntArray
from ehdmaps.units import DAMPER, FILM, PRESSURE, SPRING
from mbs.scene.scene import Scene
from mbs.settings import ROUND_OFF
from mbs.unknowns.words import missing_words

if TYPE_CHECKING:
    from mbs.linearised.modes import Modes
    from mbs.unknowns.looks import Band, Term
    from mbs.unknowns.of_modes import ModeBands
    from mbs.unknowns.unknown import Unknown

HEAD = "90 % of what is not known"
"""Heading of bounds."""

DECIDED = "decided by; and the band if the first, of all bearings, were exact"
"""Heading of what decides bands, and of what stating it would give."""

_LEAST_SHARE = 0.05
"""Share of the strain energy below which a part of a mode is not named."""

LOPSIDED = 0.1
"""Part of the larger side of a band below which the smaller one makes no more digits."""

MOST_DIGITS = 6
"""Digits of a number whose band is narrower: no machine is known to more."""

SMALL = 1e-5
"""Size below which numbers are written with an exponent."""


def deserved(value: float, side: float) -> str:
    """A number with two digits of a side of its band; with six digits where nothing is open.

    Parameters
    ----------
    value : float
        The number, or a bound of it.
    side : float
        The smaller side of its band, in the same unit.

    Examples
    --------
    >>> deserved(268.384, 11.9), deserved(0.000923, 0.00031), deserved(21714.0, 950.0), deserved(2.5, 0.0)
    ('268', '0.00092', '21710', '2.5')
    >>> deserved(14.99816, 1e-7), deserved(3.5204e-9, 1e-12)
    ('14.9982', '3.5204e-09')
    """
    if not math.isfinite(value):
        return "-"
    if abs(value) <= ROUND_OFF:
        return "0"
    if not (math.isfinite(side) and side > 0.0):
        return f"{value:.6g}"
    first = math.floor(math.log10(abs(value)))
    places = min(1 - math.floor(math.log10(side)), MOST_DIGITS - 1 - first)
    rounded = round(value, places)
    if rounded and abs(rounded) < SMALL:
        return f"{rounded:.{max(places + first, 0)}e}"
    return f"{rounded:.{max(places, 0)}f}" if rounded else "0"


def side_of(band: Band, place: int) -> float:
    """Side of a band by whose digits it is written: the smaller one, but at least a tenth of the other."""
    sides = float(band.rise[place]), float(band.fall[place])
    return max(min(sides), LOPSIDED * max(sides))


def value_text(band: Band, place: int) -> str:
    """A value with the digits that it deserves."""
    return deserved(float(band.value[place]), side_of(band, place))


def bounds_text(band: Band, place: int) -> str:
    """Both bounds of a value, such as ``203 to 279``; with a word where it is unsure."""
    side = side_of(band, place)
    low, high = (deserved(float(bound[place]), side) for bound in (band.low, band.high))
    if low == high:
        return low
    return f"{low} to {high}{' unsure' if band.unsure[place] else ''}"


def term_words(terms: Sequence[Term]) -> str:
    """Terms that decide a band: their names of terms, those of one kind of several bearings together.

    Examples
    --------
    >>> none = np.zeros(1)
    >>> from mbs.unknowns.looks import Term
    >>> term_words([Term(name, "clearance", none, none) for name in ("clearance of left", "clearance of right")])
    'clearance of left and right'
    """
    kinds: dict[str, list[str]] = {}
    for term in terms:
        kind, of, bearing = term.name.partition(" of ")
        kinds.setdefault(kind, []).extend([bearing] * bool(of))
    return ", ".join(f"{kind} of {' and '.join(names)}" if names else kind for kind, names in kinds.items())


def exact_text(band: Band, place: int, relative: str = "") -> str:
    """Words on what decides a value, and its bounds if the largest of that were stated exactly.

    Parameters
    ----------
    band : Band
        Bands of several values.
    place : int
        Which of them.
    relative : str
        Unit of a level, whose bounds are then told as its changes.
    """
    terms = band.largest(place)
    if not terms:
        return "nothing"
    if relative:
        less = band.without(terms[0].group)
        return f"{term_words(terms)}; -{less.fall[place]:.1f} to +{less.rise[place]:.1f} {relative}"
    return f"{term_words(terms)}; {bounds_text(band.without(terms[0].group), place)}"


def about_lines(scene: Scene, unknowns: Sequence[Unknown], bands: Mapping[str, Band] | None = None) -> list[str]:
    """Lines on what alternatives change, and on what bands do not hold; what they hold is in the head of a result.

    Parameters
    ----------
    scene : Scene
        The scene.
    unknowns : sequence of Unknown
        What is held open of it.
    bands : mapping of str to Band
        Bands by what these are of, in words, for what alternatives change.
    """
    if not scene.has_bearings:
        return []
    lines = [f"  {HEAD}: what the head says is held open; {missing_words(scene, unknowns)}"]
    held = {one.name: one.held for one in unknowns}
    changes: dict[str, list[str]] = {}
    for name, band in (bands or {}).items():
        for term in band.beside:
            changes.setdefault(term.name, []).append(f"{name} {_changes(band, term)}")
    return [f"  {name} {held.get(name, '')}: {', '.join(parts)}" for name, parts in changes.items()] + lines


def _changes(band: Band, term: Term) -> str:
    """Range of the changes of values by an alternative, in parts of them; of levels in dB."""
    change = term.rise - term.fall
    level = band.signed is not None and bool(np.all(band.signed))
    with np.errstate(divide="ignore", invalid="ignore"):
        parts = np.atleast_1d(change if level else 100.0 * change / np.abs(band.value))
    known = parts[np.isfinite(parts)]
    if not known.size:
        return "not known"
    low, high = (f"{end:+.2g}" for end in (known.min(), known.max()))
    return f"{low if low == high else f'{low} to {high}'} {'dB' if level else '%'}"


def lost_lines(band: Band, names: Sequence[str]) -> Iterator[str]:
    """A line on values that looks did not find again, and one for each unknown that could not be looked at.

    Parameters
    ----------
    band : Band
        Bands of several values.
    names : sequence of str
        What these are called.
    """
    lost = [f"{names[k]} in {band.lost[k]}" for k in np.flatnonzero(band.lost).tolist()]
    if lost:
        yield f"  not found again, and so left out of its band: {', '.join(lost)} of {band.looks} looks"
    for reason in band.refused:
        yield f"  not in the bands: {reason}"


def mode_lines(found: Modes, shown: IntArray, bands: ModeBands) -> list[str]:
    """Table of modes with their bands, and another of what decides these.

    Parameters
    ----------
    found : Modes
        The modes.
    shown : array of int
        Which of them are shown.
    bands : ModeBands
        Their bands.
    """
    lines = [f"  mode  frequency/Hz   {HEAD:26s} numerics    damping ratio   {'90 %':28s} numerics    strain energy"]
    decided = []
    for k in shown:
        place, numerics = bands.place(int(k)), [math.nan, math.nan] if found.bands is None else found.bands[:2]
        cells = []
        own: tuple[tuple[Band, float], ...] = (
            (bands.frequency, float(found.frequency[k])),
            (bands.damping_ratio, float(found.damping_ratio[k])),
        )
        for (band, value), size, wide in zip(own, numerics, (26, 28), strict=True):
            text = f"{value:.4g}" if place is None else value_text(band, place)
            bounds = "-" if place is None else bounds_text(band, place)
            error = "-" if found.bands is None else deserved(float(np.asarray(size)[k]), float(np.asarray(size)[k]))
            cells += [text, f"{bounds:{wide}s}", f"{error:<9s}"]
        lines.append(
            f"  {k + 1:4d} {cells[0]:>13s}   {cells[1]} {cells[2]} {cells[3]:>15s}   {cells[4]} {cells[5]}   "
            f"{share_words(found, k)}"
        )
        if place is not None:
            words = [exact_text(band, place) for band, _ in own]
            decided.append(f"  {k + 1:4d}  {words[0]:62s} {words[1]}")
    if decided:
        lines += [
            "  decided by; and the band if the first, of all bearings, were exact",
            f"  mode  {'frequency/Hz':62s} damping ratio",
        ]
    names = [f"mode {k + 1}" for k in bands.chosen]
    return [*lines, *decided, *lost_lines(bands.frequency, names)]


class Quantity(NamedTuple):
    """A number with its band, for the table of bands.

    Attributes
    ----------
    of, name, unit : str
        Bearing or other part, quantity, and unit.
    band : Band
        Band of the one value, in this unit.
    """

    of: str
    name: str
    unit: str
    band: Band


def quantity_lines(quantities: Sequence[Quantity]) -> list[str]:
    """Table of numbers with their bands and what decides these; values that are not there are left out.

    Parameters
    ----------
    quantities : sequence of Quantity
        The numbers.
    """
    there = [one for one in quantities if np.isfinite(one.band.value) and one.band.value != 0.0]
    if not there:
        return []
    wide = max(len(one.of) for one in there)
    stated = [bool(np.isfinite(one.band.numerics)) for one in there]
    column = "numerics   " if any(stated) else ""
    lines = [f"  {'':{wide}s}  {'':20s} {'value':>9s}   {HEAD:26s}  {column}{DECIDED}"]
    for last, one in zip([None, *there], there, strict=False):
        of = "" if last is not None and last.of == one.of else one.of
        band = one.band.of(None)
        numerics = f"{deserved(size := float(band.numerics[0]), size):9s}  " if column else ""
        lines.append(
            f"  {of:{wide}s}  {f'{one.name}, {one.unit}':20s} {value_text(band, 0):>9s}   {bounds_text(band, 0):26s}  "
            f"{numerics}{exact_text(band, 0)}"
        )
    if column and not all(stated):
        lines.append(
            "  numerics -: no errors of pressures and loads are stated, nor any by a law or by films that have none"
        )
    return lines


def bearing_quantities(names: Sequence[str], bands: Mapping[str, Band]) -> Iterator[Quantity]:
    """Numbers of the bearings of a machine at rest: K and C along the axes, pressure, film and load.

    Parameters
    ----------
    names : sequence of str
        Names of the bearings, in the order of the bands.
    bands : mapping of str to Band
        Bands by the names of the variables of statics.
    """
    for index, name in enumerate(names):
        for letter, variable, shown in (("K", "bearing_stiffness", SPRING), ("C", "bearing_damping", DAMPER)):
            for k, axis in enumerate("xyz"):
                yield Quantity(
                    name, f"{letter} {axis}", shown.unit, bands[variable].of((index, k, k)).scaled(shown.factor)
                )
        for words, variable, shown in (("pressure", "hertz_pressure", PRESSURE), ("film", "minimum_film", FILM)):
            if variable in bands:
                worst = int(np.argmax(bands[variable].value[index] * (1.0 if words == "pressure" else -1.0)))
                yield Quantity(name, words, shown.unit, bands[variable].of((index, worst)).scaled(shown.factor))
        if "highest_raceway_load" in bands:
            yield Quantity(name, "highest load", "N", bands["highest_raceway_load"].of(index))


def contact_notes(names: Sequence[str], bands: Mapping[str, Band]) -> list[str]:
    """A line for each bearing on what its highest load, pressure and smallest film may be, for figures.

    Parameters
    ----------
    names, bands
        The same as of `bearing_quantities`.
    """
    words: dict[str, list[str]] = {}
    for one in bearing_quantities(names, bands):
        if one.name[1:2] != " " and np.isfinite(one.band.value):  # no matrix
            words.setdefault(one.of, []).append(f"{one.name} {bounds_text(one.band.of(None), 0)} {one.unit}")
    return [f"{name}, {HEAD}: {', '.join(told)}" for name, told in words.items()]


def share_words(found: Modes, mode: int) -> str:
    """Return the parts that have most of the strain energy of a mode.

    Parameters
    ----------
    found : Modes
        The modes.
    mode : int
        Which one, from 0 on.
    """
    order = np.argsort(-found.shares[:, mode], kind="stable")
    shares = [
        f"{found.parts[i]} {100.0 * found.shares[i, mode]:.3g} %"
        for i in order
        if found.shares[i, mode] >= _LEAST_SHARE
    ]
    return ", ".join(shares) or "none"

"""Points of a bearing in words: a page for one point, a table for more."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from ehdmaps.units import DAMPER, FILM, PRESSURE, RPM, SPRING, TEMPERATURE
from mbs.bearings.bearing import Bearing
from mbs.bearings.contact_report import BearingPoint
from mbs.bearings.films import SIDES
from mbs.output.bearing_data import BearingDescription, Points, bearing_row
from mbs.output.state_text import flooded_note, loss_words, state_words
from mbs.scene.contact_laws import surface_label
from mbs.scene.fields import FORCE, MICROMETRE

_PLACES = 11

REGIMES = ((1.0, "boundary: the surfaces touch"), (3.0, "mixed: asperities touch"), (math.inf, "full film"))
"""What is usually said of Lambda below these values."""


def bearing_text(description: BearingDescription, points: Points) -> list[str]:
    """Lines that describe all points, and warn.

    Parameters
    ----------
    description : BearingDescription
        What they have in common.
    points : sequence of sequence of BearingPoint
        Points by load, then by speed.
    """
    everything = [point for line in points for point in line]
    lines = bearing_heading(description)
    if len(everything) == 1:
        lines += _page(everything[0], description) + _rollers(everything[0])
        lines += _along(everything[0]) if description.bearing.coupled else []
    else:
        lines += _table(everything, description)
    torque = max((point.loss.torque for point in everything), default=math.nan)
    return lines + flooded_note(torque, [description.supply]) + _warnings(everything)


def bearing_heading(description: BearingDescription) -> list[str]:
    """What was computed, and what of it was assumed."""
    bearing = description.bearing
    clearance = f"clearance {MICROMETRE.text(bearing.geometry.diametral_clearance)}"
    state = clearance if description.state is None else state_words(description.state)
    return [
        f"{bearing.geometry.title}: law {description.law}; {description.films}",
        f"  {TEMPERATURE.text(description.temperature)}, {state}, profile {bearing.profile}, {_slices(bearing)}, "
        f"load at {description.direction:.4g} deg from y (a roller) towards z, {surface_label(description.surface)}",
        f"  assumed: {', '.join(description.assumed) or 'nothing'}",
    ]


def _slices(bearing: Bearing) -> str:
    """Number of slices, and whether they are coupled."""
    return f"{bearing.slices} {'coupled ' if bearing.coupled else ''}slices"


def _page(point: BearingPoint, description: BearingDescription) -> list[str]:
    """The numbers of one point."""
    row, roughness = bearing_row(point, description.roughness), MICROMETRE.text(description.roughness)
    contacts = point.contacts

    def pair(label: str, unit: str, along: float, across: float) -> str:
        return f"  {label:32s} {unit:8s} {_clean(along, across):12.5g} {_clean(across, along):12.5g}"

    return [
        f"{FORCE.text(point.size, 6)} on the inner ring at {RPM.text(point.speed)}: entrainment speed "
        f"{point.entrainment_speed:.4g} m/s",
        f"  {'':32s} {'':8s} {'along':>12s} {'across':>12s} the load",
        pair("inner ring moves by", "um", 1e6 * row["displacement_along"], 1e6 * row["displacement_across"]),
        pair("stiffness", SPRING.unit, *(SPRING.factor * row[f"stiffness_{way}"] for way in ("along", "across"))),
        pair(
            "damping, low-frequency limit",
            DAMPER.unit,
            *(DAMPER.factor * row[f"damping_{way}"] for way in ("along", "across")),
        ),
        f"  {'':32s} {'':8s} {'inner':>12s} {'outer':>12s} raceway",
        _sides("Hertz pressure", PRESSURE.unit, 1e-9 * contacts.hertz_pressure),
        *(
            []
            if np.array_equal(contacts.max_pressure, contacts.hertz_pressure)
            else [_sides("film pressure with spike", PRESSURE.unit, 1e-9 * contacts.max_pressure)]
        ),
        _sides("smallest central film", FILM.unit, 1e6 * contacts.central_film),
        _sides("smallest film", FILM.unit, 1e6 * contacts.minimum_film),
        f"  Lambda {row['film_parameter']:.3g} (smallest film over {roughness} of roughness; "
        f"{regime(row['film_parameter'])})" + _share_words(point, description),
        f"  {loss_words(point.loss)}",
    ]


def _share_words(point: BearingPoint, description: BearingDescription) -> str:
    """What the film carries of the load of the most loaded roller; nothing for smooth surfaces."""
    if description.surface.smooth:
        return ""
    share, overlap = point.load_sharing(description.surface, description.oil)
    if math.isnan(share):
        return ""
    words = f"; the film carries {share:.0%} of the load of the most loaded roller"
    if not overlap:
        return words
    from ehdmaps.maps.rough_films import OVERLAP

    return f"{words}\n  {OVERLAP}"


def regime(film_parameter: float) -> str:
    """What is usually said of a film parameter Lambda.

    Examples
    --------
    >>> regime(0.5), regime(2.0), regime(5.0)
    ('boundary: the surfaces touch', 'mixed: asperities touch', 'full film')
    """
    if math.isnan(film_parameter):
        return "no film is known"
    return next(words for limit, words in REGIMES if film_parameter < limit or limit == math.inf)


def _sides(label: str, unit: str, values: Iterable[float]) -> str:
    """A line of an inner and an outer value."""
    return f"  {label:32s} {unit:8s} " + " ".join(f"{_shown(value):>12s}" for value in values)


def _rollers(point: BearingPoint) -> list[str]:
    """A line for each loaded roller."""
    rollers, contacts = point.rollers, point.contacts
    lines = [
        f"  {point.loaded} of {rollers.load.size} rollers carry more than 1 % of the highest load"
        f"{'; the others not shown' if point.loaded < rollers.load.size else ''}",
        f"  {'roller':>6s} {'angle':>7s} {'load':>9s} {'Hertz pressure, GPa':>21s} {'smallest film, um':>21s}",
        f"  {'':>6s} {'deg':>7s} {'N':>9s} " + f"{SIDES[0]:>11s}{SIDES[1]:>10s} " * 2,
    ]
    for index in np.argsort(rollers.angle):
        if rollers.load[index] <= 0.01 * rollers.load.max():
            continue
        pressures = [1e-9 * float(np.max(side.hertz_pressure[index])) for side in contacts.sides]
        films = [1e6 * _smallest(side.minimum_film[index]) for side in contacts.sides]
        lines.append(
            f"  {index:6d} {math.degrees(rollers.angle[index]):7.1f} {rollers.load[index]:9.5g} "
            f"{_shown(pressures[0], 3):>11s}{_shown(pressures[1], 3):>10s} "
            f"{_shown(films[0], 3):>11s}{_shown(films[1], 3):>10s}"
        )
    return [line.rstrip() for line in lines]


def _along(point: BearingPoint) -> list[str]:
    """Load and pressures along the most loaded roller, at some of its slices, both ends among them."""
    rollers, index = point.rollers, point.most_loaded
    count = rollers.position.size
    shown = np.unique(np.linspace(0, count - 1, min(count, _PLACES)).round().astype(int))
    rows = [
        ("place, mm", 1e3 * rollers.position, "8.2f"),
        ("load per length, N/mm", 1e-3 * rollers.load_per_length[index], "8.1f"),
        *(
            (f"{name} Hertz pressure, GPa", 1e-9 * side.hertz_pressure[index], "8.3f")
            for name, side in zip(SIDES, point.contacts.sides, strict=True)
        ),
    ]
    return [
        "  along the most loaded roller",
        *(f"  {words:27s}" + "".join(f"{values[i]:{form}}" for i in shown) for words, values, form in rows),
    ]


def _table(points: list[BearingPoint], description: BearingDescription) -> list[str]:
    """A line for each point."""
    rough = not description.surface.smooth
    lines = [
        f"{'load':>10s} {'speed':>8s} {'K along':>9s} {'across':>9s} {'c along':>9s} {'rollers':>7s} {'highest':>9s} "
        f"{'Hertz':>7s} {'smallest':>9s} {'Lambda':>7s} {'rolling':>8s}" + (f" {'film':>6s}" if rough else ""),
        f"{'N':>10s} {'rpm':>8s} {SPRING.unit:>9s} {SPRING.unit:>9s} {DAMPER.unit:>9s} {'loaded':>7s} {'N':>9s} "
        f"{'GPa':>7s} {'film, um':>9s} {'':>7s} {'N mm':>8s}" + (f" {'share':>6s}" if rough else ""),
    ]
    for point in points:
        row = bearing_row(point, description.roughness)
        share = f" {point.film_share(description.surface, description.oil):6.3f}" if rough else ""
        lines.append(
            f"{point.size:10.5g} {RPM.value(point.speed):8.5g} {SPRING.value(row['stiffness_along']):9.4g} "
            f"{SPRING.value(row['stiffness_across']):9.4g} {DAMPER.value(row['damping_along']):9.4g} {point.loaded:7d} "
            f"{row['highest_roller_load']:9.5g} {1e-9 * float(point.contacts.hertz_pressure.max()):7.4g} "
            f"{_shown(1e6 * float(np.min(point.contacts.minimum_film)), 4):>9s} {_shown(row['film_parameter'], 3):>7s} "
            f"{_shown(1e3 * row['rolling_torque'], 4):>8s}{share}{' !' if point.problems else ''}"
        )
    return lines


def _warnings(points: list[BearingPoint]) -> list[str]:
    """Each warning and note once, with how many points it is about."""
    lines = []
    for word, name in (("warning", "problems"), ("note", "notes")):
        # The number in a sentence differs from point to point; the first one is shown.
        groups: dict[str, list[str]] = {}
        for point in points:
            for sentence in getattr(point, name):
                groups.setdefault(without_numbers(sentence), []).append(sentence)
        for sentences in groups.values():
            more = f" ({len(sentences)} of {len(points)} points, the last of them here)" if len(points) > 1 else ""
            lines.append(f"{word}: {sentences[-1]}{more}")
    return lines


def without_numbers(sentence: str) -> str:
    """A sentence without its numbers, by which warnings of one kind are known.

    Examples
    --------
    >>> without_numbers("5.1 GPa is too much") == without_numbers("40 GPa is too much")
    True
    """
    return "".join(letter for letter in sentence if not (letter.isdigit() or letter in ".-+"))


def _smallest(values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    """Smallest number; NaN if there is none."""
    known = values[np.isfinite(values)]
    return float(known.min()) if known.size else math.nan


def _clean(value: float, beside: float) -> float:
    """Zero in place of what is round-off beside another value."""
    return 0.0 if abs(value) < 1e-9 * abs(beside) else value


def _shown(value: float, digits: int = 5) -> str:
    """A number; a dash where there is none."""
    return "-" if math.isnan(value) else f"{value:.{digits}g}"

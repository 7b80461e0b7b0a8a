"""Points of a cylindrical roller bearing: what `mbs.output.one_bearing.kind` asks of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.hertz import LINE_LIMIT
from ehdmaps.units import DAMPER, PRESSURE, SPRING, TEMPERATURE
from mbs.bearings.contact_report import BearingPoint
from mbs.bearings.films import SIDES
from mbs.bearings.thermal import BearingState
from mbs.output.one_bearing.kind import (
    Column,
    Curves,
    Description,
    Kind,
    Number,
    Pair,
    columns_of,
    numbers_of,
    shown,
    smallest,
)
from mbs.output.state_text import beside_class, flooded_note, largest_torque, loss_words, state_words
from mbs.scene.contact_laws import surface_label
from mbs.scene.fields import MICROMETRE

_PLACES = 11
"""Places along a roller that are shown at most."""


def _side(name: str, words: str) -> Number:
    """A pair of the contacts."""
    unit = "m" if name.endswith("film") else "Pa"
    return Number(name, unit, words, lambda point, _: getattr(point.contacts, name))


_SIDES = (
    _side("hertz_pressure", "largest Hertz pressure"),
    _side("max_pressure", "largest pressure, that of the film where a map knows it"),
    _side("central_film", "smallest central film"),
    _side("minimum_film", "smallest film"),
)


def _share(point: BearingPoint, description: Description) -> float:
    """Share of the film in the load of the most loaded roller."""
    assert description.oil is not None
    return point.film_share(description.surface, description.oil)


_TORQUE = "torque that rolling takes; none without a map that has rolling forces"
_FILM_SHARE = "share of the film in the load of the most loaded roller; 1 for smooth surfaces"
_NUMBERS = (
    *numbers_of([], axial=False),
    Number("rolling_torque", "N m", _TORQUE, lambda point, _: point.loss.torque),
    Number("rolling_power", "W", "power that the films of all rollers take", lambda point, _: point.loss.total),
    Number("film_share", "1", _FILM_SHARE, _share),
)


def _along_side(side: Number) -> Number:
    """Values of the slices of the most loaded roller, from those of the contacts."""
    plain = side.words.replace("largest ", "").replace("smallest ", "")

    def read(point: BearingPoint, _: Description) -> list[FloatArray]:
        return [getattr(contact, side.name)[point.most_loaded] for contact in point.contacts.sides]

    return Number(f"slice_{side.name}", side.unit, f"{plain}, along the most loaded roller", read, ("contact", "slice"))


_SLICE_LOAD = "load per length of the most loaded roller on the inner raceway"
_EACH = (
    Number("roller_load", "N", "load of the roller", lambda point, _: point.elements.load, ("roller",)),
    Number("slice_load", "N/m", _SLICE_LOAD, lambda p, _: p.elements.load_per_length[p.most_loaded], ("slice",)),
    *map(_along_side, _SIDES),
)


def _attributes(description: Description, point: BearingPoint) -> dict[str, Any]:
    """Attributes on supply, surfaces, clearance and slices."""
    bearing = point.bearing
    assert description.supply is not None
    return {
        "oil_supply": description.supply.label,
        "surface": surface_label(description.surface),
        **_warm(description.state),
        "diametral_clearance_m": bearing.geometry.diametral_clearance,
        "profile": str(bearing.profile),
        "slices": bearing.slices,
        "slices_coupled": int(bearing.coupled),
    }


def _warm(state: BearingState | None) -> dict[str, float]:
    """Attributes of a bearing whose rings have temperatures of their own."""
    if state is None:
        return {}
    return {
        "inner_raceway_temperature_K": state.inner,
        "outer_raceway_temperature_K": state.outer,
        "stated_clearance_m": state.clearance.stated,
    }


def _about(description: Description, point: BearingPoint) -> list[str]:
    """A line on temperature, clearance, slices and load."""
    bearing = point.bearing
    clearance = f"clearance {MICROMETRE.text(bearing.geometry.diametral_clearance)}{beside_class(bearing.geometry)}"
    state = clearance if description.state is None else state_words(description.state)
    slices = f"{bearing.slices} {'coupled ' if bearing.coupled else ''}slices"
    rows = bearing.geometry.row_words
    return [
        *([f"{bearing.geometry.rolling_elements} rollers{rows}"] if rows else []),
        f"{TEMPERATURE.text(description.temperature)}, {state}, profile {bearing.profile}, {slices}, "
        f"load at {description.direction:.4g} deg from y (a roller) towards z, {surface_label(description.surface)}",
    ]


def _pairs(point: BearingPoint) -> tuple[list[Pair], list[Pair]]:
    """A line on the pressure of the film where it has a spike."""
    spiked = not np.array_equal(point.contacts.max_pressure, point.contacts.hertz_pressure)
    return [Pair("film pressure with spike", PRESSURE, "max_pressure")] * spiked, []


def _share_words(point: BearingPoint, description: Description) -> str:
    """Share that the film carries of the load of the most loaded roller; nothing for smooth surfaces."""
    if description.surface.smooth:
        return ""
    assert description.oil is not None
    share, planes = point.load_sharing(description.surface, description.oil)
    if math.isnan(share):
        return ""
    words = f"; the film carries {share:.0%} of the load of the most loaded roller"
    return f"{words}\n  {planes}" if planes else words


def asperity_band(corners: Sequence[BearingPoint]) -> list[str]:
    """K and C with the softest and with the stiffest usual asperities."""
    if not corners:
        return []
    both = [(display, point.along_across(getattr(point, name))) for point in corners for display, name in _MATRICES]
    values = [display.value(float(value)) for display, diagonal in both for value in diagonal[:2]]
    soft, stiff = values[:4], values[4:]
    k, k_across, c, c_across = (f"{a:.4g} to {b:.4g}" for a, b in zip(soft, stiff, strict=True))
    return [
        "  asperities are seldom known; with the softest to the stiffest usual ones stiffness is "
        f"{k} along, {k_across} {SPRING.unit} across, damping {c} along, {c_across} {DAMPER.unit} across"
    ]


_MATRICES = ((SPRING, "stiffness"), (DAMPER, "damping"))


def _remarks(points: Sequence[BearingPoint], description: Description) -> list[str]:
    """A note on flooded contacts, where they cost torque."""
    assert description.supply is not None
    torque = largest_torque(point.loss for point in points if not point.failed)
    return flooded_note(torque, [description.supply])


def _of_one(point: BearingPoint, index: int) -> str:
    """Load, pressures and films of a roller."""
    sides = point.contacts.sides
    pressures = [shown(1e-9 * float(np.max(side.hertz_pressure[index])), 3) for side in sides]
    films = [shown(1e6 * smallest(side.minimum_film[index]), 3) for side in sides]
    both = " ".join(f"{inner:>11s}{outer:>10s}" for inner, outer in (pressures, films))
    return f"{point.elements.load[index]:9.5g} {both}"


def _along(point: BearingPoint) -> list[str]:
    """Load and pressures along the most loaded roller, at some of its slices, both ends among them."""
    rollers, index = point.elements, point.most_loaded
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


def _curves(point: BearingPoint) -> Curves:
    """Load, pressures and films along the most loaded roller."""
    rollers, index, sides = point.elements, point.most_loaded, point.contacts.sides
    return Curves(
        f"along the most loaded roller, at {math.degrees(rollers.angle[index]):.4g}\N{DEGREE SIGN}",
        "place along the roller, mm",
        "load per\nlength, N/mm",
        1e3 * rollers.position,
        1e-3 * rollers.load_per_length[[index]],
        *(np.array([getattr(side, name)[index] for side in sides]) for name in _CURVES),
    )


_CURVES = ("hertz_pressure", "central_film", "minimum_film")


CYLINDRICAL = Kind(
    element="roller",
    words="bearing",
    static_limit=LINE_LIMIT,
    axial=False,
    numbers=_NUMBERS,
    sides=_SIDES,
    each=_EACH,
    columns=columns_of(
        "roller",
        [],
        [
            Column("rolling", "N mm", 8, lambda row: shown(1e3 * row["rolling_torque"], 4)),
            Column("film", "share", 6, lambda row: f"{row['film_share']:.3f}", rough=True),
        ],
        axial=False,
    ),
    about=_about,
    closing=lambda point, row: [loss_words(point.loss)],
    heads=(
        f"{'load':>9s} {'Hertz pressure, GPa':>21s} {'smallest film, um':>21s}",
        f"{'N':>9s} " + f"{SIDES[0]:>11s}{SIDES[1]:>10s} " * 2,
    ),
    of_one=_of_one,
    pairs=_pairs,
    attributes=_attributes,
    coordinates=lambda point: {
        "slice": ("slice", point.elements.position, {"units": "m", "long_name": "place along the roller"})
    },
    curves_of=_curves,
    beside_lambda=_share_words,
    last=lambda point: _along(point) if point.bearing.coupled else [],
    remarks=_remarks,
)
"""Cylindrical roller bearings and needle bearings."""

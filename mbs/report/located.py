"""Each bearing of a report that carries axial load: loads of its rolling elements, pressures, films, K and C."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import typeset
from ehdmaps.physics.surface import Surface
from ehdmaps.report.chart import number, shown
from ehdmaps.report.page import Markup, joined, pairs, table, tag
from ehdmaps.units import DAMPER, FILM, PRESSURE, SPRING, Display
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.contact_report import BearingContacts, RollingLoss
from mbs.bearings.locating.locating_force import LocatingForce, Settled
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.output.one_bearing.located import located
from mbs.output.state_text import DAMPINGS, STIFFNESSES, life_lines, loss_words
from mbs.report.examination import Examination
from mbs.scene.fields import FORCE

_SHOWN = (0, 1, 2, 4, 5)
_NAMES = ("x", "y", "z", "θx", "θy", "θz")
_ROUND_OFF = 1e-8


class _Told(NamedTuple):
    """Words of a kind alone: rows before and behind its loads, and columns of each rolling element."""

    first: tuple[tuple[str, str], ...]
    last: tuple[tuple[str, str], ...]
    columns: tuple[tuple[str, tuple[str, ...]], ...]


def _balls(at: Settled, contacts: BearingContacts) -> _Told:
    """Contact angles of balls, and what each carries."""
    means = [number(clean(math.degrees(at.loads.mean_angle(side)))) for side in (0, 1)]
    angles = [[number(clean(float(one))) for one in side] for side in np.degrees(at.loads.contact_angle)]
    pressures = [[number(PRESSURE.value(float(one))) for one in side.hertz_pressure[:, 0]] for side in contacts.sides]
    heads = "contact angle inner, °", "outer, °", "Hertz pressure inner, GPa", "outer, GPa"
    columns = tuple((head, tuple(each)) for head, each in zip(heads, (*angles, *pressures), strict=True))
    return _Told((("mean contact angle", f"{means[0]} inner, {means[1]} ° outer"),), (), columns)


def _rollers(at: Settled, _: BearingContacts) -> _Told:
    """Loads of the ribs."""
    ribs = at.loads.load[2]
    columns = (("ribs, N", tuple(number(float(one), 4) for one in ribs)),)
    return _Told((), (("highest load of the ribs", shown(FORCE, float(ribs.max()))),), columns)


_OWN: dict[type[LocatingForce], Callable[[Settled, BearingContacts], _Told]] = {
    BallForce: _balls,
    TaperedForce: _rollers,
}
"""By class of the force."""


def located_bearings(found: Examination) -> Iterator[Markup]:
    """Yield what is said of each bearing that carries axial load.

    Parameters
    ----------
    found : Examination
        What was found.
    """
    model, balance, statics = found.model, found.statics.balance, found.statics
    first = len(model.bearings)
    matrices = ("Stiffness K", balance.element_stiffness), ("Damping C", balance.element_damping)
    for (place, element, at), contacts, loss in zip(
        located(model, balance), statics.contacts[first:], statics.losses[first:], strict=True
    ):
        force, loads, one = balance.forces[place], at.loads.load[:2], element.rolling_element
        own = _OWN[type(at.force)](at, contacts)
        across = shown(FORCE, math.hypot(*force[1:3]))
        rows = [
            ("force on the inner ring", f"{number(force[0], 4)} N along x, {across} across"),
            *own.first,
            (f"loaded {one}s", f"{at.loads.loaded} of {loads.shape[1]} (above 1 % of the highest load)"),
            (f"highest {one} load", shown(FORCE, float(loads[0].max()))),
            *own.last,
            *contact_rows(contacts, loss),
            *(("life", line.strip()) for line in life_lines(element, at.force.geometry, at.loads, balance.operation)),
        ]
        each = [
            (
                f"{clean(math.degrees(float(at.loads.angle[j]))):.4g}",
                *(number(float(side[j]), 4) for side in loads),
                *(column[j] for _, column in own.columns),
            )
            for j in np.argsort(at.loads.angle)
        ]
        heads = ("angle, °", "load inner, N", "outer, N", *(head for head, _ in own.columns))
        yield joined(
            tag("h3", f"Bearing {element.name}, {element.force.geometry.name}"),
            pairs((name, typeset(value)) for name, value in rows),
            table(heads, each, f"{one.capitalize()}s, from y towards z", ()),
            tag("div", *(located_matrix(words, of_all[place]) for words, of_all in matrices), class_="matrices"),
        )


def contact_rows(
    contacts: BearingContacts, loss: RollingLoss, elements: str = "elements", surface: Surface | None = None
) -> list[tuple[str, str]]:
    """Rows on pressures, films and the torque of a bearing.

    Parameters
    ----------
    contacts : BearingContacts
        Contacts of the bearing.
    loss : RollingLoss
        What rolling costs in it.
    elements : str
        What rolls, in the plural.
    surface : Surface, optional
        Surfaces of its raceways, where films of rough ones are known.
    """
    rows = [
        ("Hertz pressure", PRESSURE, contacts.hertz_pressure),
        ("central film", FILM, contacts.central_film),
        ("smallest film", FILM, contacts.minimum_film),
    ]
    if surface is not None and not surface.smooth:
        rows.append(("film parameter Λ", Display(""), contacts.minimum_film / surface.roughness))
    told = ("rolling", loss_words(loss, elements).removeprefix("rolling "))
    return [*((words, _pair(display, values)) for words, display, values in rows), told]


def _pair(display: Display, values: FloatArray) -> str:
    """A value of the inner and one of the outer contact."""
    if not np.isfinite(values).all():
        return "none known"
    inner, outer = (number(display.value(float(value))) for value in values)
    return f"{inner} inner, {f'{outer} {display.unit}'.rstrip()} outer"


def located_matrix(words: str, matrix: FloatArray, shown_freedoms: Sequence[int] = _SHOWN) -> Markup:
    """A matrix (6, 6) as a table.

    Parameters
    ----------
    words : str
        Name of the matrix: "Stiffness K" or "Damping C".
    matrix : array (6, 6)
        Matrix on the inner ring [N/m] or [N s/m], and the like for rotations.
    shown_freedoms : sequence of int
        Freedoms that are shown.
    """
    units, display = (STIFFNESSES, SPRING) if words.startswith("S") else (DAMPINGS, DAMPER)
    values = display.factor * matrix
    scale = np.sqrt(np.abs(np.diag(values)))
    rows = [
        (_NAMES[i], *(f"{clean(float(values[i, k]), float(scale[i] * scale[k])):.4g}" for k in shown_freedoms))
        for i in shown_freedoms
    ]
    return table(("", *(_NAMES[i] for i in shown_freedoms)), rows, f"{words} in {typeset(units)}")


def clean(value: float, scale: float = 1.0) -> float:
    """The value, or 0 where it is round-off of a scale.

    Parameters
    ----------
    value, scale : float
        Value, and what it is small beside.
    """
    return 0.0 if abs(value) < _ROUND_OFF * scale else float(value)

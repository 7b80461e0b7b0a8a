"""Each ball bearing of a report: loads and contact angles of its balls, pressures, stiffness and damping."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import typeset
from ehdmaps.report.chart import number, shown
from ehdmaps.report.page import Markup, joined, pairs, table, tag
from ehdmaps.units import DAMPER, FILM, PRESSURE, SPRING, Display
from mbs.bearings.balls.ball_element import MachineBalls
from mbs.bearings.contact_report import BearingContacts, RollingLoss
from mbs.output.state_text import DAMPINGS, STIFFNESSES, loss_words
from mbs.report.examination import Examination
from mbs.scene.fields import FORCE

_SHOWN = (0, 1, 2, 4, 5)
_NAMES = ("x", "y", "z", "θy", "θz")
_ROUND_OFF = 1e-8


def balls(found: Examination) -> Iterator[Markup]:
    """Yield what is said of each ball bearing.

    Parameters
    ----------
    found : Examination
        What was found.
    """
    model, balance = found.model, found.statics.balance
    for element, place, contacts, loss in zip(
        model.on_rings, model.ring_places, found.statics.contacts, found.statics.losses, strict=True
    ):
        if not isinstance(element, MachineBalls):
            continue
        at = element.settled(model.system.elements[place].transform @ balance.displacement, balance.operation)
        force, loads, angles = balance.forces[place], at.balls.load, np.degrees(at.balls.contact_angle)
        pressures = [side.hertz_pressure[:, 0] for side in contacts.sides]
        means = [number(_clean(math.degrees(at.balls.mean_angle(side)))) for side in (0, 1)]
        rows = [
            (
                "force on the inner ring",
                f"{number(force[0], 4)} N along x, {shown(FORCE, math.hypot(*force[1:3]))} across",
            ),
            ("mean contact angle", f"{means[0]} inner, {means[1]} ° outer"),
            ("loaded balls", f"{np.count_nonzero(loads[0] > 0.0)} of {loads.shape[1]}"),
            ("highest ball load", shown(FORCE, float(loads[0].max()))),
            *contact_rows(contacts, loss),
        ]
        each = [
            (
                f"{_clean(math.degrees(float(at.balls.angle[j]))):.4g}",
                *(number(float(side[j]), 4) for side in loads),
                *(number(_clean(float(side[j]))) for side in angles),
                *(number(PRESSURE.value(float(side[j]))) for side in pressures),
            )
            for j in np.argsort(at.balls.angle)
        ]
        places = ("angle, °", "load inner, N", "outer, N", "contact angle inner, °", "outer, °")
        heads = (*places, "Hertz pressure inner, GPa", "outer, GPa")
        matrices = ("Stiffness K", balance.element_stiffness), ("Damping C", balance.element_damping)
        yield joined(
            tag("h3", f"Bearing {element.name}, {element.force.geometry.name}"),
            pairs((name, typeset(value)) for name, value in rows),
            table(heads, each, "Balls, from y towards z", ()),
            tag("div", *(located_matrix(words, of_all[place]) for words, of_all in matrices), class_="matrices"),
        )


def contact_rows(contacts: BearingContacts, loss: RollingLoss) -> list[tuple[str, str]]:
    """Rows on pressures, films and the torque of a bearing.

    Parameters
    ----------
    contacts : BearingContacts
        Contacts of the bearing.
    loss : RollingLoss
        What rolling costs in it.
    """
    return [
        (words, _pair(display, values))
        for words, display, values in (
            ("Hertz pressure", PRESSURE, contacts.hertz_pressure),
            ("central film", FILM, contacts.central_film),
            ("smallest film", FILM, contacts.minimum_film),
        )
    ] + [("rolling", loss_words(loss, "elements").removeprefix("rolling "))]


def _pair(display: Display, values: FloatArray) -> str:
    """A value of the inner and one of the outer contact."""
    if not np.isfinite(values).all():
        return "none known"
    inner, outer = (number(display.value(float(value))) for value in values)
    return f"{inner} inner, {outer} {display.unit} outer"


def located_matrix(words: str, matrix: FloatArray) -> Markup:
    """A matrix on the inner ring, without the turning about its axis.

    Parameters
    ----------
    words : str
        Name, such as "Stiffness K" or "Damping C".
    matrix : ndarray, shape (6, 6)
        The matrix.
    """
    units, display = (STIFFNESSES, SPRING) if words.startswith("S") else (DAMPINGS, DAMPER)
    values = display.factor * matrix
    scale = np.sqrt(np.abs(np.diag(values)))
    rows = [
        (_NAMES[i], *(f"{_clean(float(values[row, k]), float(scale[row] * scale[k])):.4g}" for k in _SHOWN))
        for i, row in enumerate(_SHOWN)
    ]
    return table(("", *_NAMES), rows, f"{words} in {typeset(units)}")


def _clean(value: float, scale: float = 1.0) -> float:
    """Zero in place of what is left by round-off."""
    return 0.0 if abs(value) < _ROUND_OFF * scale else value

"""Each bearing of a report: loads of its rollers around it, pressures, films, stiffness and damping."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.figures import typeset
from ehdmaps.report.chart import number, shown
from ehdmaps.report.page import Markup, joined, pairs, table, tag
from ehdmaps.units import SPEED
from mbs.bearings.films import ContactState
from mbs.bearings.force_at_point import RollerLoads
from mbs.model.on_rings import ring_matrices
from mbs.output.state_text import life_lines
from mbs.report.examination import Examination
from mbs.report.located import clean, contact_rows, located_matrix
from mbs.scene.assembly import ring_motions
from mbs.scene.fields import FORCE

_SHOWN = (1, 2, 4, 5)
_LEAST_LOAD = 0.01
_MIDDLE, _PITCH, _LONGEST = 172.0, 62.0, 62.0
"""Middle, pitch circle and longest bar of a drawing [px]."""


def bearings(found: Examination) -> Iterator[Markup]:
    """Yield what is said of each bearing.

    Parameters
    ----------
    found : Examination
        What was found.
    """
    model, balance = found.model, found.statics.balance
    for index, (bearing, motion) in enumerate(ring_motions(model, balance.displacement)):
        force, contacts = balance.forces[index], found.statics.contacts[index]
        rollers = bearing.loads(motion, balance.operation)
        matrices = ring_matrices(balance.element_stiffness[index], balance.element_damping[index])
        size = float(np.hypot(force[1], force[2]))
        moves = 1e6 * motion[1:3]
        path = float(np.hypot(*moves))
        inner, outer = contacts.sides
        lives = life_lines(bearing, bearing.bearing.geometry, rollers, balance.operation)
        rows = [
            ("force on the inner ring", f"{shown(FORCE, size)} (y {_part(force[1], size)}, z {_part(force[2], size)})"),
            (
                "inner ring moves by",
                f"{_part(moves[0], path)} um in y, {_part(moves[1], path)} um in z against the outer one",
            ),
            ("entrainment speed", shown(SPEED, float(bearing.entrainment_speed(balance.operation)))),
            ("loaded rollers", f"{loaded(rollers).size} of {rollers.load.size} (above 1 % of the highest load)"),
            ("highest roller load", shown(FORCE, float(rollers.load.max()))),
            *contact_rows(contacts, found.statics.losses[index], "rollers", model.surface),
            *(("life", line.strip()) for line in lives),
        ]
        title = f"Loads of the rollers of bearing {index + 1}"
        yield joined(
            tag("h3", f"Bearing {bearing.name}"),
            tag(
                "div",
                tag("div", pairs((name, typeset(value)) for name, value in rows), _roller_table(rollers, inner, outer)),
                tag(
                    "figure",
                    roller_drawing(rollers, -force[1:3], f"bearing-{index}", title),
                    tag("p", _says(rollers), class_="says"),
                ),
                class_="beside",
            ),
            tag(
                "div",
                *(
                    located_matrix(words, matrix, _SHOWN)
                    for words, matrix in zip(("Stiffness K", "Damping C"), matrices, strict=True)
                ),
                class_="matrices",
            ),
        )


def roller_drawing(rollers: RollerLoads, load: FloatArray, name: str, title: str) -> Markup:
    """Return the loads of the rollers as bars around the bearing.

    Parameters
    ----------
    rollers : RollerLoads
        The rollers.
    load : ndarray, shape (2,)
        Load on the inner ring along y and z [N].
    name : str
        Name of the drawing: letters, digits and hyphens.
    title : str
        What it shows.
    """
    most = max(float(rollers.load.max()), 1e-300)
    radius = min(0.42 * 2.0 * np.pi * _PITCH / rollers.angle.size, 12.0)
    parts = [
        tag("circle", cx=_MIDDLE, cy=_MIDDLE, r=size, class_=kind)
        for size, kind in (
            (_PITCH - radius, "outline"),
            (_PITCH + radius, "outline"),
            (_PITCH + radius + _LONGEST, "grid"),
            (_PITCH + radius + _LONGEST / 2.0, "grid"),
        )
    ]
    for angle, value in zip(rollers.angle.tolist(), rollers.load.tolist(), strict=True):
        y, z = math.cos(angle), -math.sin(angle)
        words = f"{math.degrees(angle):.4g}°: {shown(FORCE, value)}"
        begin, end = _PITCH + radius, _PITCH + radius + _LONGEST * value / most
        parts.append(
            tag(
                "g",
                tag("title", words),
                tag("circle", cx=_at(y * _PITCH), cy=_at(z * _PITCH), r=radius, class_="roller"),
                tag("path", d=f"M{_at(y * begin)} {_at(z * begin)}L{_at(y * end)} {_at(z * end)}", class_="load")
                if value > 0.0
                else None,
            )
        )
    outside = _PITCH + radius + _LONGEST
    parts += [
        *_arrow(load),
        tag("text", "y, 0°", x=_MIDDLE + outside + 4.0, y=_MIDDLE + 4.0),
        tag("text", "z, 90°", x=_MIDDLE, y=_MIDDLE - outside - 5.0, text_anchor="middle"),
        tag("text", f"{shown(FORCE, most)}", x=_MIDDLE, y=_MIDDLE + outside + 14.0, text_anchor="middle"),
    ]
    return tag(
        "svg",
        tag("title", title, id=f"{name}-title"),
        tag("desc", _says(rollers), id=f"{name}-desc"),
        *parts,
        viewBox=f"0 0 {2.0 * _MIDDLE:g} {2.0 * _MIDDLE + 6.0:g}",
        role="img",
        aria_labelledby=f"{name}-title {name}-desc",
    )


def _arrow(load: FloatArray) -> Iterator[Markup]:
    """The load on the inner ring, from the middle outwards."""
    size = float(np.hypot(*load))
    if size <= 0.0:
        return
    y, z = float(load[0]) / size, -float(load[1]) / size
    tip, neck = 40.0, 31.0
    yield tag("path", d=f"M{_MIDDLE:g} {_MIDDLE:g}L{_at(y * neck)} {_at(z * neck)}", class_="arrow")
    corners = [(y * tip, z * tip), (y * neck - 5.0 * z, z * neck + 5.0 * y), (y * neck + 5.0 * z, z * neck - 5.0 * y)]
    yield tag("path", d="M" + "L".join(f"{_at(a)} {_at(b)}" for a, b in corners) + "z", class_="arrow-head")


def _at(offset: float) -> str:
    """A place in the drawing."""
    return f"{_MIDDLE + offset:.1f}"


def _says(rollers: RollerLoads) -> str:
    """Tell what the drawing says."""
    carrying = loaded(rollers)
    if not carrying.size:
        return "No roller is loaded."
    most = int(np.argmax(rollers.load))
    share = 100.0 * float(rollers.load[most] / rollers.load.sum())
    angle = float(clean(math.degrees(float(rollers.angle[most]))))
    return (
        f"{carrying.size} of {rollers.load.size} rollers carry more than 1 % of the highest load. "
        f"The one at {angle:.4g}° carries most, "
        f"{shown(FORCE, float(rollers.load[most]))}, {share:.0f} % of all. The outer circle stands for that load, "
        "the arrow for the load on the inner ring."
    )


def _roller_table(rollers: RollerLoads, inner: ContactState, outer: ContactState) -> Markup:
    """The loaded rollers, in the order of their angles."""
    films = bool(np.isfinite(inner.minimum_film).any())
    rows = []
    carrying = loaded(rollers)
    for k in carrying[np.argsort(rollers.angle[carrying])]:
        pressures = [number(1e-9 * float(side.hertz_pressure[k].max())) for side in (inner, outer)]
        smallest = [_film(side.minimum_film[k]) for side in (inner, outer)] if films else []
        angle = f"{clean(math.degrees(float(rollers.angle[k]))):.4g}"
        rows.append((angle, number(float(rollers.load[k]), 4), *pressures, *smallest))
    heads = ("angle, °", "load, N", "Hertz pressure inner, GPa", "outer, GPa")
    more = (typeset("smallest film inner, um"), typeset("outer, um")) if films else ()
    return table((*heads, *more), rows, "Loaded rollers, from y towards z", ())


def loaded(rollers: RollerLoads) -> IntArray:
    """Return the rollers that carry more than 1 % of the highest load: films press a little on all others.

    Parameters
    ----------
    rollers : RollerLoads
        The rollers.
    """
    return np.flatnonzero(rollers.load > _LEAST_LOAD * float(rollers.load.max()))


def _film(values: FloatArray) -> str:
    """The smallest film of a roller [um]."""
    known = values[np.isfinite(values)]
    return number(1e6 * float(known.min())) if known.size else "-"


def _part(value: float, scale: float = 1.0) -> str:
    """A part of a vector."""
    return number(clean(value, scale), 4)

"""Each bearing of tapered rollers, or of rollers between ribs, of a report: loads, pressures, films, K and C."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ehdmaps.figures import typeset
from ehdmaps.report.chart import number, shown
from ehdmaps.report.page import Markup, joined, pairs, table, tag
from mbs.bearings.tapered.tapered_element import TaperedElement
from mbs.model.findings import CARRIES
from mbs.report.balls import contact_rows, located_matrix
from mbs.report.examination import Examination
from mbs.scene.fields import FORCE


def tapered(found: Examination) -> Iterator[Markup]:
    """Yield what is said of each of them.

    Parameters
    ----------
    found : Examination
        What was found.
    """
    model, balance = found.model, found.statics.balance
    for entry, place, contacts, loss in zip(
        model.on_rings, model.ring_places, found.statics.contacts, found.statics.losses, strict=True
    ):
        if not isinstance(entry, TaperedElement):
            continue
        rollers = entry.rollers(model.system.elements[place].transform @ balance.displacement, balance.operation)
        force, cone = balance.forces[place], rollers.load[0]
        rows = [
            (
                "force on the inner ring",
                f"{number(force[0], 4)} N along x, {shown(FORCE, math.hypot(*force[1:3]))} across",
            ),
            ("loaded rollers", f"{np.count_nonzero(cone > CARRIES * cone.max())} of {cone.size}"),
            ("highest roller load", shown(FORCE, float(cone.max()))),
            ("highest load of the ribs", shown(FORCE, float(rollers.load[2].max()))),
            *contact_rows(contacts, loss),
        ]
        each = [
            (f"{math.degrees(float(rollers.angle[j])):.4g}", *(number(float(side[j]), 4) for side in rollers.load))
            for j in np.argsort(rollers.angle)
        ]
        matrices = ("Stiffness K", balance.element_stiffness), ("Damping C", balance.element_damping)
        yield joined(
            tag("h3", f"Bearing {entry.name}, {entry.force.geometry.name}"),
            pairs((name, typeset(value)) for name, value in rows),
            table(("angle, °", "load inner, N", "outer, N", "ribs, N"), each, "Rollers, from y towards z", ()),
            tag("div", *(located_matrix(words, of_all[place]) for words, of_all in matrices), class_="matrices"),
        )

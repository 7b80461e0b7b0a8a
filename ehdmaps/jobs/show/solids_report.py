"""Findings of finite elements on a bearing, in words, and the structural laws side by side."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ehdmaps.jobs.solids import solids_keys
from ehdmaps.physics.approach import FE_LOAD, STRUCTURAL_LAWS, StructuralLaw
from ehdmaps.physics.bearing import BearingGeometry, with_law
from ehdmaps.physics.contact import LineContact
from ehdmaps.units import FILM, LOAD, STIFFNESS

COMPARED_LOADS = (1e3, 1e4, 3e4, 1e5, 3e5, 1e6)
"""Loads at which the laws stand side by side [N/m]."""

_WIDE = 32


def solids_text(record: Mapping[str, Any], bearing: BearingGeometry) -> str:
    """Tell what was found, and the lines that a job takes.

    Parameters
    ----------
    record : mapping
        See `ehdmaps.solids.plane_bearing.bearing_record`.
    bearing : BearingGeometry
        The bearing.
    """
    return "\n".join(_lines(record, bearing))


def _lines(record: Mapping[str, Any], bearing: BearingGeometry) -> Iterator[str]:
    """The text, line by line."""
    contacts = record["contacts"]
    yield f"{bearing.title}: {sections_words(record['sections'])}"
    if bearing.estimated:
        yield f"  {bearing.estimated}"
    yield ""
    yield _row("", contacts)
    yield _row(f"approach at {LOAD.text(FE_LOAD)}", [FILM.text(c["fe_approach"], 5) for c in contacts.values()])
    yield _row("  share of the roller", [f"{c['roller_share']:.1%}" for c in contacts.values()])
    yield _row("  by plane stress, a bound", [FILM.text(c["plane_stress_approach"], 5) for c in contacts.values()])
    yield _row("  yields at the next roller", [f"{c['neighbour_share']:.2%}" for c in contacts.values()])
    yield _row("curvature of the gap", [f"{c['gap_curvature']:+.1g}" for c in contacts.values()])
    low, high = (next(iter(contacts.values()))["loads"][place] for place in (0, -1))
    yield _row("law against its series, delta", [f"{c['approach_error']:.2g}" for c in contacts.values()])
    yield _row("  of the stiffness", [f"{c['compliance_error']:.2g}" for c in contacts.values()])
    yield f"  series from {LOAD.text(low, 2)} to {LOAD.text(high, 2)}"
    if all("convergence" in c for c in contacts.values()):
        yield from _convergence({name: c["convergence"] for name, c in contacts.items()})
    if all("contact_check" in c for c in contacts.values()):
        checks = [f"{c['contact_check']['difference']:.2g}" for c in contacts.values()]
        yield _row("CalculiX' contact, load", checks)
    if "seats" in record:
        yield ""
        yield "approach on other seats (D, d: outside diameter and bore of the bearing)"
        for label, approaches in record["seats"].items():
            yield _row(f"  {label}", [FILM.text(approaches[name], 5) for name in contacts])
    yield ""
    yield from job_lines({name: c["fe_approach"] for name, c in contacts.items()})


def job_lines(approaches: Mapping[str, float]) -> Iterator[str]:
    """Yield the lines that a job takes.

    Parameters
    ----------
    approaches : mapping of str to float
        Approaches by finite elements by the names of the contacts [m].
    """
    yield "for the job, in place of structural_law of [solver], beside what its [solids] says already:"
    yield "[solids]"
    yield 'law = "fe"'
    for key, text in solids_keys({name: float(f"{value:.7g}") for name, value in approaches.items()}).items():
        yield f'{key} = "{text}"'


def sections_words(sections: Mapping[str, Any]) -> str:
    """Say which bodies were solved.

    Parameters
    ----------
    sections : mapping
        Record of `ehdmaps.solids.sections.Sections`.
    """
    mm = {key: f"{1e3 * value:.5g}" for key, value in sections.items() if key.endswith(("bore", "diameter"))}
    roller = f"roller {mm['roller_diameter']} mm"
    if sections["roller_bore"]:
        roller += f" with a bore of {mm['roller_bore']} mm"
    rings = (
        f"rings {mm['bore']}/{mm['inner_raceway_diameter']} mm and "
        f"{mm['outer_raceway_diameter']}/{mm['outside_diameter']} mm"
    )
    if sections["seat"] == "rigid":
        return f"{roller}, {rings}, rigid seats"
    shaft = f"shaft with a bore of {mm['shaft_bore']} mm" if sections["shaft_bore"] else "solid shaft"
    return f"{roller}, {rings}, {shaft}, housing held at {mm['housing_diameter']} mm"


def _convergence(contacts: Mapping[str, Mapping[str, Any]]) -> Iterator[str]:
    """Lines of the three meshes."""
    yield "approach by element size over distance from the contact"
    first = next(iter(contacts.values()))
    for place, grading in enumerate(first["gradings"]):
        yield _row(f"  {grading:g}", [FILM.text(one["approaches"][place], 7) for one in contacts.values()])
    yield _row("  limit (Richardson)", [FILM.text(one["limit"], 7) for one in contacts.values()])
    yield _row("  order", [f"{one['order']:.2f}" for one in contacts.values()])


def _row(label: str, values: Any) -> str:
    """One line of the table."""
    return f"{label:{_WIDE}s}" + "".join(f"  {value:>14s}" for value in values)


def compared_laws(contact: LineContact, bearing: BearingGeometry, loads: Sequence[float]) -> dict[str, dict[str, Any]]:
    """Stiffness of the solids of one contact by every structural law, and its difference from the law fe.

    Parameters
    ----------
    contact : LineContact
        A contact that knows its approach by finite elements.
    bearing : BearingGeometry
        Bearing of the contact.
    loads : sequence of float
        w [N/m].

    Returns
    -------
    dict
        Stiffness [N/m2], approach [m] and relative differences of both from fe, lists over the loads, by the names of
        the laws.
    """
    values = {}
    w = np.array(loads)
    names: tuple[StructuralLaw, ...] = ("fe", *(name for name in STRUCTURAL_LAWS if name != "fe"))
    for name in names:
        line = with_law(contact, name, bearing)
        values[name] = (1.0 / line.structural_compliance(w), line.structural_approach(w))
    stiffness, approach = values["fe"]
    return {
        name: {
            "stiffness": k.tolist(),
            "stiffness_difference": (k / stiffness - 1.0).tolist(),
            "approach": delta.tolist(),
            "approach_difference": (delta / approach - 1.0).tolist(),
        }
        for name, (k, delta) in values.items()
    }


def compared_text(contacts: Mapping[str, Mapping[str, Mapping[str, Any]]], loads: Sequence[float], title: str) -> str:
    """Tables of the structural laws, one a contact.

    Parameters
    ----------
    contacts : mapping
        What `compared_laws` gives, by the names of the contacts.
    loads : sequence of float
        w [N/m].
    title : str
        The bearing.
    """
    lines = [f"{title}: stiffness of the solids of one contact, and its difference from fe"]
    for name, laws in contacts.items():
        lines += [
            "",
            f"{name + ' contact':14s}" + f"{'fe':>20s}" + "".join(f"{law:>12s}" for law in laws if law != "fe"),
        ]
        for place, load in enumerate(loads):
            row = f"  {LOAD.text(load, 4):>12s}{STIFFNESS.text(laws['fe']['stiffness'][place], 4):>20s}"
            others = (one["stiffness_difference"][place] for law, one in laws.items() if law != "fe")
            lines.append(row + "".join(f"{value:>+12.1%}" for value in others))
    lines += ["", "  of the approach:"]
    for name, laws in contacts.items():
        for place, load in enumerate(loads):
            row = f"  {name:7s}{LOAD.text(load, 4):>10s}{FILM.text(laws['fe']['approach'][place], 4):>15s}"
            others = (one["approach_difference"][place] for law, one in laws.items() if law != "fe")
            lines.append(row + "".join(f"{value:>+12.1%}" for value in others))
    return "\n".join(lines)

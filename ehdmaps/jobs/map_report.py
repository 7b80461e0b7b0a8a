"""A report of a map, as one file to send: what it holds, how stiff and how lubricated, where it ends, and how sure."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ehdmaps.errors import MapError
from ehdmaps.figures import typeset
from ehdmaps.jobs.correction_report import correction_lines
from ehdmaps.jobs.describe import (
    backbone_lines,
    geometry_rows,
    oil_rows,
    provenance_rows,
    roughness_lines,
    stated_rows,
)
from ehdmaps.jobs.map_charts import MapCurves, Operated, contact_charts, shown_speed, shown_temperature
from ehdmaps.jobs.map_limits import limits
from ehdmaps.jobs.plot import contact_words, what_is_mapped
from ehdmaps.jobs.report import AXES, NONE_STATED, error_rows, holes, law_rows, span, tip_line
from ehdmaps.maps.emap import EHDMap
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.program import plain
from ehdmaps.report.chart import shown
from ehdmaps.report.page import Markup, Section, document, joined, pairs, sentences, table, tag
from ehdmaps.units import DAMPING, FILM, LOAD, SPEED, STIFFNESS, TEMPERATURE
from ehdmaps.version import version


def map_report(emap: EHDMap, name: str, command: str) -> str:
    """Return the report of a map.

    Parameters
    ----------
    emap : EHDMap
        The map.
    name : str
        Name of its file.
    command : str
        Command line that asks for it.

    Raises
    ------
    MapError
        If its contacts, its bearing or its oil do not read.
    """
    what, oil = what_is_mapped(emap)
    created = plain(emap.dataset.attrs.get("created", "an unknown time"))
    of = MapCurves(emap)
    sections = [
        Section("summary", "In short", [sentences(map(typeset, in_short(of)))]),
        Section("job", "Job and oil", [job(emap, "map")]),
        *curve_sections(of, (), "map"),
        Section("limits", "Where the map is limited, and why", [limits(emap, "map")]),
        Section("accuracy", "How accurate it is", [accuracy(emap)]),
        Section("provenance", "Provenance", [provenance(emap, name), written_by(command)]),
    ]
    lead = f"Map file {name}, made {created}. All values are per unit length of contact."
    return document(typeset(f"EHD contact map of {what}, {oil}"), lead, sections)


def in_short(of: MapCurves) -> Iterator[str]:
    """Yield what a reader has to know first.

    Parameters
    ----------
    of : MapCurves
        The map.
    """
    emap = of.emap
    ranges = ", ".join(span(emap.dataset[name].values, display) for name, display in AXES)
    yield f"The map covers {ranges} (temperature of the raceways)."
    temperature, speed = shown_temperature(of, ()), shown_speed(of, ())
    loads = of.loads[[0, of.loads.size // 2, -1]]
    at = f"{shown(SPEED, speed)} and {TEMPERATURE.text(temperature)}"
    for contact in emap.contacts:
        found = {
            name: of.values(name, contact, speed, temperature, loads)
            for name in ("stiffness", "damping", "minimum_film")
        }
        if not all(np.isfinite(values).all() for values in found.values()):
            yield f"{contact_words(contact.name)}: at {at} some loads have no solution."
            continue
        dry = 1.0 / contact.structural_compliance(loads)
        softer = 100.0 * (1.0 - found["stiffness"][1] / dry[1])
        film = f", {softer:.3g} % below that of the dry contact" if found["minimum_film"][1] > 0.0 else ""
        yield (
            f"{contact_words(contact.name)}: at {shown(LOAD, float(loads[1]))}, {at} the stiffness is "
            f"{shown(STIFFNESS, float(found['stiffness'][1]))}{film}, the damping "
            f"{shown(DAMPING, float(found['damping'][1]))}, the minimum film "
            f"{shown(FILM, float(found['minimum_film'][1]))}."
        )
    lost, total = holes(emap.dataset), emap.dataset["status"].size
    yield f"{total - lost} of {total} points are solved; {_usable(emap)}."
    if emap.surface.smooth:
        yield "No roughness is stated, so that there is no film parameter Lambda; --roughness gives one."
    else:
        yield from (f"{line.strip()[0].upper()}{line.strip()[1:]}." for line in roughness_lines(emap))
    checked = dict(law_rows(emap.dataset)).get("film compliance error")
    errors = [f"{label} {found[1]:.2g}" for label, found in error_rows(emap.dataset) if found is not None][:4]
    if errors:
        yield f"Estimated relative errors of 95 % of the points are at most: {', '.join(errors)}."
    if checked:
        yield f"Relative error of the film compliance of the contact laws against fresh solves: {checked}."
    if not emap.lubricant.verified:
        yield "The data of the oil are not verified."


def _usable(emap: EHDMap) -> str:
    """Whether a law can be made."""
    try:
        emap.check_usable()
    except MapError:
        return "no contact law can be made from the map"
    return "contact laws can be made from the map"


def job(emap: EHDMap, prefix: str) -> Markup:
    """Return bearing, oil and what is stated about surfaces and supply.

    Parameters
    ----------
    emap : EHDMap
        The map.
    prefix : str
        Begins the names of drawings.
    """
    what, oil = what_is_mapped(emap)
    notes = [text for text in (emap.bearing.estimated if emap.bearing else "", emap.lubricant.estimated or "") if text]
    words = joined(
        tag("h3", what),
        pairs((name, typeset(value)) for name, value in geometry_rows(emap)),
        tag("h3", typeset(oil)),
        pairs((name, typeset(value)) for name, value in (*oil_rows(emap.lubricant), *stated_rows(emap))),
        *(tag("p", typeset(f"Note: {note}"), class_="warning") for note in notes),
    )
    if emap.bearing is None:
        return words
    drawn = tag(
        "figure",
        cross_section(emap.bearing, f"{prefix}-bearing"),
        tag("p", "Raceways and rollers to scale; the clearance is too small to be seen.", class_="says"),
    )
    return tag("div", tag("div", words), drawn, class_="beside")


def cross_section(bearing: BearingGeometry, name: str) -> Markup:
    """Return a drawing of raceways and rollers, to scale.

    Parameters
    ----------
    bearing : BearingGeometry
        The bearing.
    name : str
        Name of the drawing.
    """
    inner, outer = bearing.inner_raceway_diameter / 2.0, bearing.outer_raceway_diameter / 2.0
    unit, ring = 100.0 / outer, 0.12 * outer
    pitch, angles = (inner + outer) / 2.0, 2.0 * np.pi * np.arange(bearing.rollers) / bearing.rollers
    rollers = [
        tag("circle", cx=f"{120.0 + unit * pitch * np.cos(a):.1f}", cy=f"{120.0 - unit * pitch * np.sin(a):.1f}",
            r=unit * bearing.roller_diameter / 2.0, class_="roller")
        for a in angles
    ]  # fmt: skip
    circles = [
        tag("circle", cx="120", cy="120", r=unit * radius, class_="outline")
        for radius in (max(inner - ring, 0.3 * inner), inner, outer, outer + ring)
    ]
    return tag(
        "svg",
        tag("title", f"Cross-section of the bearing with {bearing.rollers} rollers", id=f"{name}-title"),
        *circles,
        *rollers,
        viewBox="0 0 240 240",
        role="img",
        aria_labelledby=f"{name}-title",
    )


def curve_sections(
    of: MapCurves, operated: Sequence[Operated], prefix: str, title: str = "", capped: bool | None = None
) -> list[Section]:
    """Return a section of curves for each contact.

    Parameters
    ----------
    of : MapCurves
        The map.
    operated : sequence of Operated
        Operating points of a machine that uses the map; may be empty.
    prefix : str
        Begins the names of sections and charts.
    title : str
        Ends the headings.
    capped : bool or None
        Whether an oil supply caps the films in use; as the map's job states it if None.
    """
    known = (
        "Lines are the contact laws of the map, dots its solved points."
        if of.field is not None
        else "Lines join the solved points (dots): the map makes no contact law."
    )
    if of.field is not None and not of.emap.surface.smooth:
        known += " Lines of k, c and approach are of rough surfaces, dots and films of smooth ones."
    if capped or (capped is None and not of.emap.supply.flooded):
        known += " All curves and dots are of flooded contacts; the oil supply that is stated gives thinner films."
    marked = " Red curves and diamonds are the machine in operation." if operated else ""
    return [
        Section(
            f"{prefix}-{contact.name}",
            f"{contact_words(contact.name)}: stiffness, damping, approach, films{title}",
            [tag("p", known + marked), contact_charts(of, contact, operated, f"{prefix}-{contact.name}")],
        )
        for contact in of.emap.contacts
    ]


def accuracy(emap: EHDMap) -> Markup:
    """Return the error estimates of the points, and the check of the laws.

    Parameters
    ----------
    emap : EHDMap
        The map.
    """
    dataset = emap.dataset
    rows = [
        (label, *(f"{value:.2g}" for value in found)) if found else (label, NONE_STATED, "", "")
        for label, found in error_rows(dataset)
    ]
    parts: list[Markup] = [
        table(("quantity", "median", "95 % of points", "largest"), rows, "Estimated relative errors of the points")
    ]
    if tip := tip_line(dataset):
        parts.append(tag("p", f"{tip[0].upper()}{tip[1:]}."))
    law = list(law_rows(dataset))
    if law:
        parts.append(table(("check", "found"), law, "Contact laws at random points against fresh solves", (0, 1)))
    else:
        parts.append(tag("p", "The contact laws of this map were not checked against fresh solves."))
    if lines := list(correction_lines(dataset)):
        parts += [tag("h3", typeset(lines[0])), sentences(typeset(line.strip()) for line in lines[1:])]
    if emap.backbone is not None:
        first, *more = backbone_lines(emap.backbone)
        parts += [tag("h3", typeset(first[0].upper() + first[1:])), sentences(typeset(line.strip()) for line in more)]
    return joined(*parts)


def provenance(emap: EHDMap, name: str) -> Markup:
    """Return how a map came about, with the text of its job.

    Parameters
    ----------
    emap : EHDMap
        The map.
    name : str
        Name of its file.
    """
    attributes = emap.dataset.attrs
    made = plain(attributes.get("created", "at an unknown time"))
    rows = [("map", f"{name}, schema {attributes['schema_version']}, made {made}"), *provenance_rows(attributes)]
    text = str(attributes.get("job_toml", ""))
    return joined(
        pairs(rows),
        tag("details", tag("summary", "The job, as it was"), tag("pre", text)) if text else None,
    )


def written_by(command: str) -> Markup:
    """Return which program wrote a report, and by which command.

    Parameters
    ----------
    command : str
        The command line.
    """
    return pairs([("report written by", f"ehdmaps {version()}"), ("command", tag("code", command))])

"""A report of a map, as one file to send: what it holds, how stiff and how lubricated, where it ends, and how sure."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from ehdmaps.arrays import IntArray
from ehdmaps.errors import MapError
from ehdmaps.figures import spread, typeset
from ehdmaps.jobs.make.report import (
    AXES,
    NONE_STATED,
    against,
    correction_lines,
    error_rows,
    extrapolated_lines,
    holes,
    law_rows,
    spacing_lines,
    status_rows,
    tip_line,
)
from ehdmaps.jobs.show.budget_chart import budget_section
from ehdmaps.jobs.show.describe import (
    backbone_lines,
    geometry_rows,
    oil_rows,
    provenance_rows,
    roughness_lines,
    stated_rows,
)
from ehdmaps.jobs.show.map_charts import MapCurves, Operated, contact_charts, shown_speed, shown_temperature
from ehdmaps.jobs.show.plot import contact_words, what_is_mapped
from ehdmaps.jobs.supply import supply_words
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solution import Status, usable_points
from ehdmaps.program import plain
from ehdmaps.report.chart import number, shown
from ehdmaps.report.page import Markup, Section, document, joined, pairs, sentences, table, tag
from ehdmaps.trade.record import Trade
from ehdmaps.units import DAMPING, FILM, LOAD, SPEED, STIFFNESS, TEMPERATURE, point_text, span
from ehdmaps.version import version

MOST_TEMPERATURES = 6

_STATES = (
    ("usable", "solved"),
    ("doubtful", "solved, with a remark or with extrapolated viscosity"),
    ("limit", "limit of thin films (asymptote)"),
    ("filled", "no solution, filled from neighbours"),
    ("lost", "no solution"),
)
"""Classes of points and their words, in rising order of concern but for the limit."""

_LEFT, _TOP, _ACROSS, _ALONG = 46.0, 20.0, 250.0, 120.0


def limits(emap: EHDMap, prefix: str) -> Markup:
    """Return the content of the section.

    Parameters
    ----------
    emap : EHDMap
        The map.
    prefix : str
        Begins the names of the drawings: letters, digits and hyphens.
    """
    groups = list(status_rows(emap.dataset, emap.surface.roughness))
    rows = []
    for group in groups:
        rows.append((group.words, f"{group.count}", f"{100.0 * group.share:.2f}", "", typeset(group.where)))
        rows += [("", f"{cause.count}", "", typeset(cause.text), typeset(cause.where)) for cause in group.causes]
    return joined(
        sentences(map(typeset, _sentences(emap))),
        _key(),
        tag("div", *_drawings(emap, prefix), class_="charts small"),
        table(
            ("status", "points", "%", "cause", "where"),
            rows,
            "Points by status and cause",
            texts=(0, 3, 4),
        ),
    )


def _sentences(emap: EHDMap) -> Iterator[str]:
    """Yield what limits the map, in sentences."""
    dataset = emap.dataset
    ranges = ", ".join(span(dataset[name].values, display) for name, display in AXES)
    yield (
        f"The map covers {ranges} (temperature of the raceways). Beyond that a contact law refuses, or where it is "
        "asked to, holds its edge."
    )
    missing, filled = holes(dataset), int(np.count_nonzero(dataset["filled"].values))
    total = dataset["status"].size
    if missing:
        yield (
            f"Without a solution: {missing} of {total} points; isolated and filled from neighbours: {filled} of these."
        )
    else:
        yield f"All {total} points have a solution."
    try:
        emap.check_usable()
    except MapError as error:
        yield f"No contact law can be made from this map: {error}."
    else:
        reach = emap.reach()
        yield "Contact laws can be made from this map" + ("." if reach.whole else f": {reach.text}.")
    beyond = next(iter(extrapolated_lines(dataset)), None)
    if beyond:
        yield f"{_sentence(beyond)}: the oil is less certain there than the solution."
    if emap.low_loads is not None:
        yield f"At low loads {emap.low_loads.text}."
    stated = emap.supply if schema.OIL_SUPPLY in dataset.attrs else None
    yield f"Oil supply: {supply_words(stated)}."
    thin = _thinnest(dataset)
    if thin:
        yield thin


def _sentence(line: str) -> str:
    """A line with a capital at its beginning."""
    words = line.strip()
    return words[:1].upper() + words[1:]


def _thinnest(dataset: xr.Dataset) -> str:
    """The thinnest film, and where it is."""
    film = dataset["minimum_film"].transpose(*schema.DIMS)
    values = np.where(film.values > 0.0, film.values, np.nan)
    if not np.isfinite(values).any():
        return ""
    at = film.isel(dict(zip(schema.DIMS, np.unravel_index(int(np.nanargmin(values)), values.shape), strict=True)))
    place = point_text(*(float(at[name]) for name in schema.DIMS[1:]))
    return f"The thinnest film is {1e6 * float(at):.3g} um: {at['contact'].item()} contact at {place}."


def _states(dataset: xr.Dataset) -> IntArray:
    """The class of each point, as its place in `_STATES`, (contact, load, speed, temperature)."""
    ordered = dataset.transpose(*schema.DIMS, ...)
    status, filled = ordered["status"].values, ordered["filled"].values.astype(bool)
    reason = np.vectorize(bool, otypes=[bool])(ordered["reason"].values)
    unsolved = ~usable_points(status)
    limit = status == int(Status.ASYMPTOTE)
    doubtful = reason | ordered["viscosity_extrapolated"].values.astype(bool)
    return np.select([unsolved & ~filled, unsolved, limit, doubtful], [4, 3, 2, 1], 0)


def _drawings(emap: EHDMap, prefix: str) -> Iterator[Markup]:
    """A drawing of the points over load and speed for each contact and some temperatures."""
    dataset, states = emap.dataset, _states(emap.dataset)
    axis = dataset["temperature"].values
    for contact in range(states.shape[0]):
        for index in spread(axis.size, MOST_TEMPERATURES):
            name = str(dataset["contact"].values[contact])
            title = f"{name} contact, {typeset(TEMPERATURE.text(float(axis[index])))}"
            drawn = _drawing(dataset, states[contact, :, :, index], title, f"{prefix}-limits-{contact}-{index}")
            yield tag("figure", drawn, tag("figcaption", title))


def _drawing(dataset: xr.Dataset, states: IntArray, title: str, name: str) -> Markup:
    """One drawing: a cell for each load and speed; equal neighbours are one cell."""
    loads, speeds = dataset["load"].values, dataset["entrainment_speed"].values
    width, height = _ACROSS / loads.size, _ALONG / speeds.size
    cells = []
    for row in range(speeds.size):
        # where the state changes, a new cell begins
        line = states[:, row]
        for columns in np.split(np.arange(loads.size), np.flatnonzero(np.diff(line)) + 1):
            state = int(line[columns[0]])
            low, high = loads[columns[0]], loads[columns[-1]]
            words = f"{span(np.array([low, high]), LOAD)}, {SPEED.text(float(speeds[row]))}: {_STATES[state][1]}"
            cells.append(
                tag(
                    "rect", tag("title", words), x=f"{_LEFT + columns[0] * width:.1f}",
                    y=f"{_TOP + (speeds.size - 1 - row) * height:.1f}", width=f"{columns.size * width:.2f}",
                    height=f"{height:.2f}", class_=_STATES[state][0],
                )
            )  # fmt: skip
    bottom = _TOP + _ALONG
    return tag(
        "svg",
        tag("title", f"States of the points: {title}", id=f"{name}-title"),
        *cells,
        tag("rect", x=_LEFT, y=_TOP, width=_ACROSS, height=_ALONG, class_="frame"),
        *(
            tag("text", number(LOAD.value(float(loads[i]))), x=f"{_LEFT + (i + 0.5) * width:.1f}", y=bottom + 14.0,
                text_anchor="middle")
            for i in sorted({0, loads.size // 2, loads.size - 1})
        ),
        *(
            tag("text", f"{float(speeds[i]):.3g}", x=_LEFT - 4.0,
                y=f"{_TOP + (speeds.size - 0.5 - i) * height + 4.0:.1f}", text_anchor="end")
            for i in sorted({0, speeds.size // 2, speeds.size - 1})
        ),
        tag("text", f"load, {LOAD.unit}", x=_LEFT + _ACROSS / 2.0, y=bottom + 29.0, text_anchor="middle"),
        tag("text", "m/s", x=_LEFT - 4.0, y=_TOP - 7.0, text_anchor="end"),
        viewBox=f"0 0 {_LEFT + _ACROSS + 14.0:g} {bottom + 34.0:g}",
        role="img",
        aria_labelledby=f"{name}-title",
    )  # fmt: skip


def _key() -> Markup:
    """Key to the colours."""
    entries = [
        tag(
            "li",
            tag("svg", tag("rect", x="1", y="1", width="24", height="10", class_=name), viewBox="0 0 26 12",
                class_="key", aria_hidden="true"),
            tag("span", words),
        )
        for name, words in _STATES
    ]  # fmt: skip
    return tag("ul", *entries, class_="legend")


def map_report(emap: EHDMap, name: str, command: str, budget: Trade | str | None = None) -> str:
    """Return the report of a map.

    Parameters
    ----------
    emap : EHDMap
        The map.
    name : str
        Name of its file.
    command : str
        Command line that asks for it.
    budget : Trade or str, optional
        Error budget of the map, or why there is none, see `ehdmaps.jobs.budget.measured`.

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
        *([] if budget is None else [budget_section(budget)]),
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
        numbers = {
            name: of.values(name, contact, speed, temperature, loads)
            for name in ("stiffness", "damping", "minimum_film")
        }
        if not all(np.isfinite(values).all() for values in numbers.values()):
            yield f"{contact_words(contact.name)}: at {at} some loads have no solution."
            continue
        dry = 1.0 / contact.structural_compliance(loads)
        softer = 100.0 * (1.0 - numbers["stiffness"][1] / dry[1])
        film = f", {softer:.3g} % below that of the dry contact" if numbers["minimum_film"][1] > 0.0 else ""
        yield (
            f"{contact_words(contact.name)}: at {shown(LOAD, float(loads[1]))}, {at} the stiffness is "
            f"{shown(STIFFNESS, float(numbers['stiffness'][1]))}{film}, the damping "
            f"{shown(DAMPING, float(numbers['damping'][1]))}, the minimum film "
            f"{shown(FILM, float(numbers['minimum_film'][1]))}."
        )
    missing, total = holes(emap.dataset), emap.dataset["status"].size
    yield f"{total - missing} of {total} points are solved; {_usable(emap)}."
    if emap.surface.smooth:
        yield "No roughness is stated, so that there is no film parameter Lambda; --roughness gives one."
    else:
        yield from (f"{_sentence(line)}." for line in roughness_lines(emap))
    checked = dict(law_rows(emap.dataset)).get("film compliance error")
    errors = [f"{label} {numbers[1]:.2g}" for label, numbers in error_rows(emap.dataset) if numbers is not None][:4]
    if errors:
        yield f"Estimated relative errors of 95 % of the points are at most: {', '.join(errors)}."
    if checked:
        yield f"Relative error of the film compliance of the contact laws against {against(emap.dataset)}: {checked}."
    if not emap.lubricant.verified:
        yield "The data of the oil are not verified."


def _usable(emap: EHDMap) -> str:
    """Say whether a law can be made."""
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
        (label, *(f"{value:.2g}" for value in numbers)) if numbers else (label, NONE_STATED, "", "")
        for label, numbers in error_rows(dataset)
    ]
    parts: list[Markup] = [
        table(("quantity", "median", "95 % of points", "largest"), rows, "Estimated relative errors of the points")
    ]
    if tip := tip_line(dataset):
        parts.append(tag("p", f"{tip[0].upper()}{tip[1:]}."))
    law = list(law_rows(dataset))
    if law:
        words = f"Contact laws at random points against {against(dataset)}"
        parts.append(table(("check", "found"), law, words, (0, 1)))
    elif lines := list(spacing_lines(dataset)):
        parts += [tag("h3", typeset(f"{lines[0][0].upper()}{lines[0][1:]}")), tag("pre", "\n".join(lines[1:]))]
    else:
        parts.append(tag("p", "The contact laws of this map were not checked."))
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

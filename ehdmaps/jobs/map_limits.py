"""Where a map is limited and why, for a report: drawings of its points by state, a table of causes, and sentences."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from ehdmaps.arrays import IntArray
from ehdmaps.errors import MapError
from ehdmaps.figures import typeset
from ehdmaps.jobs.report import AXES, extrapolated_lines, holes, span, status_rows
from ehdmaps.jobs.supply import supply_words
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap
from ehdmaps.physics.solution import Status
from ehdmaps.report.chart import number
from ehdmaps.report.page import Markup, joined, sentences, table, tag
from ehdmaps.units import LOAD, SPEED, TEMPERATURE

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
    """What limits the map, in sentences."""
    dataset = emap.dataset
    ranges = ", ".join(span(dataset[name].values, display) for name, display in AXES)
    yield (
        f"The map covers {ranges} (temperature of the raceways). Beyond that a contact law refuses, or where it is "
        "asked to, holds its edge."
    )
    lost, filled = holes(dataset), int(np.count_nonzero(dataset["filled"].values))
    total = dataset["status"].size
    if lost:
        yield f"Without a solution: {lost} of {total} points; isolated and filled from neighbours: {filled} of these."
    else:
        yield f"All {total} points have a solution."
    try:
        emap.check_usable()
    except MapError as error:
        yield f"No contact law can be made from this map: {error}."
    else:
        yield "Contact laws can be made from this map."
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
    i, j, k, m = np.unravel_index(int(np.nanargmin(values)), values.shape)
    return (
        f"The thinnest film is {1e6 * values[i, j, k, m]:.3g} um: {dataset['contact'].values[i]} contact at "
        f"{LOAD.text(float(dataset['load'].values[j]))}, "
        f"{SPEED.text(float(dataset['entrainment_speed'].values[k]))}, "
        f"{TEMPERATURE.text(float(dataset['temperature'].values[m]))}."
    )


def _states(dataset: xr.Dataset) -> IntArray:
    """The class of each point, as its place in `_STATES`, (contact, load, speed, temperature)."""
    ordered = dataset.transpose(*schema.DIMS, ...)
    status, filled = ordered["status"].values, ordered["filled"].values.astype(bool)
    reason = np.vectorize(bool, otypes=[bool])(ordered["reason"].values)
    lost = ~np.isin(status, [int(known) for known in Status if known.usable])
    limit = status == int(Status.ASYMPTOTE)
    doubtful = reason | ordered["viscosity_extrapolated"].values.astype(bool)
    return np.select([lost & ~filled, lost, limit, doubtful], [4, 3, 2, 1], 0)


def _drawings(emap: EHDMap, prefix: str) -> Iterator[Markup]:
    """A drawing of the points over load and speed for each contact and some temperatures."""
    dataset, states = emap.dataset, _states(emap.dataset)
    axis = dataset["temperature"].values
    chosen = sorted({round(i) for i in np.linspace(0, axis.size - 1, min(axis.size, MOST_TEMPERATURES))})
    for contact in range(states.shape[0]):
        for index in chosen:
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
    """What the colours mean."""
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

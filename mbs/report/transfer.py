"""Transfer paths of a report: levels of sensors by inputs, and their modes, dry beside films, in decibels."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import COLOURS, typeset
from ehdmaps.report.axis import linear_axis, log_axis
from ehdmaps.report.chart import WIDE, Chart, Curve, figure, known, number
from ehdmaps.report.page import Markup, joined, table, tag
from mbs.analyses.lsa import LsaResult
from mbs.linearised.linear import response_display
from mbs.linearised.peaks import Linearised, by_laws, peaks_of_modes
from mbs.output.page import frequency_scale
from mbs.unknowns.of_modes import banded

MOST_MODES = 12
"""Modes of a table, those of the highest peaks."""

MOST_PATHS = 6
"""Paths that are drawn; all are in the table of levels."""


def transfer(found: Sequence[LsaResult], names: Mapping[int, str]) -> Iterator[Markup]:
    """Yield the levels of all paths from an input to a sensor, then the modes and the curve of each.

    Parameters
    ----------
    found : sequence of LsaResult
        Responses with films, then dry where that is another law.
    names : mapping of int to str
        Names of the modes with films, by their indices.
    """
    first, scene = found[0], found[0].model.scene
    paths = [(s, i) for s in range(len(scene.sensors)) for i in range(len(scene.inputs))]
    span = f"{number(float(first.frequencies[0]))} to {number(float(first.frequencies[-1]))} Hz"
    rows = []
    for s, i in paths:
        display = response_display(scene.sensors[s], scene.inputs[i])
        means = [_mean(entry.frequencies, np.abs(entry.responses[:, s, i])) for entry in found]
        cells = [number(display.value(mean)) for mean in means]
        rows.append(
            (
                f"{scene.inputs[i].name} to {scene.sensors[s].name}",
                typeset(display.unit),
                *cells,
                *([_decibels(means[0], means[1])] if len(means) > 1 else []),
            )
        )
    laws = ("with films", "dry", "films against dry, dB") if len(found) > 1 else ("response",)
    yield table(("path", "unit", *laws), rows, f"Root mean square over {span}", (0, 1))
    seen = banded(first.modes, float(first.frequencies[-1]))
    linearised = [Linearised(entry.balance, entry.modes) for entry in found]
    frequencies, heights = by_laws(linearised, scene.inputs, scene.sensors, seen)
    places, own = peaks_of_modes(first.modes, seen, first.frequencies, np.abs(first.responses))
    for s, i in paths[:MOST_PATHS]:
        shown = sorted(set(own[(places[:, 1] == s) & (places[:, 2] == i)].tolist()))
        highest = sorted(sorted(shown, key=lambda k: -heights[0, s, i, k])[:MOST_MODES])
        yield _path(found, (s, i), [(seen[k], frequencies[:, k], heights[:, s, i, k]) for k in highest], names)
    if len(paths) > MOST_PATHS:
        yield tag("p", f"{len(paths) - MOST_PATHS} more paths are not drawn; mbs lsa has them.")


def _path(
    found: Sequence[LsaResult],
    path: tuple[int, int],
    modes: Sequence[tuple[int, FloatArray, FloatArray]],
    names: Mapping[int, str],
) -> Markup:
    """Modes and curve of a path."""
    s, i = path
    scene = found[0].model.scene
    sensor, entry = scene.sensors[s], scene.inputs[i]
    display = response_display(sensor, entry)
    title = f"{entry.name} to {sensor.name}"
    rows = []
    for mode, frequency, height in modes:
        cells = []
        for k in range(len(found)):
            cells += [known(float(frequency[k]), 4), known(display.value(float(height[k])))]
        if len(found) > 1:
            cells.append(_decibels(float(height[0]), float(height[1])))
        rows.append((f"{mode + 1}", names.get(int(mode), ""), *cells))
    unit = typeset(display.unit)
    law = ("frequency, Hz", f"height, {unit}")
    dry = (*(f"{word} dry" for word in law), "films against dry, dB") if len(found) > 1 else ()
    heads = ("mode", "where", *law, *dry)
    curves = [
        Curve(
            ("with films", "dry")[k] if len(found) > 1 else "response",
            display.factor * np.abs(one.responses[:, s, i]),
            (COLOURS[0], COLOURS[7])[k],
            ("", "5 3")[k],
        )
        for k, one in enumerate(found)
    ]
    frequencies = found[0].frequencies
    axis = log_axis if frequency_scale(frequencies) == "log" else linear_axis
    chart = Chart(
        f"transfer-{s + 1}-{i + 1}",
        f"{title}: {sensor.quantity}",
        "",
        axis("frequency", "Hz", frequencies),
        log_axis(sensor.quantity, unit, np.concatenate([curve.values for curve in curves]), floor=1e-6, room=1.5),
        frequencies,
        curves,
        frame=WIDE,
    )
    return joined(
        tag("h3", title),
        table(heads, rows, "Modes that have a peak", (0, 1)) if rows else tag("p", "No mode has a peak there."),
        tag("div", figure(chart), class_="single"),
    )


def _mean(frequencies: FloatArray, size: FloatArray) -> float:
    """Root mean square over the frequencies, each with the width that it stands for."""
    width = frequencies[-1] - frequencies[0]
    if not width > 0.0:
        return float(size[0])
    return float(np.sqrt(np.trapezoid(size**2, frequencies) / width))


def _decibels(value: float, beside: float) -> str:
    """A value beside another in decibels; a dash where there is none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = 20.0 * np.log10(value / beside)
    return f"{apart:+.1f}" if np.isfinite(apart) else "-"

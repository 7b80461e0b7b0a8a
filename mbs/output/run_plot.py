"""Figures of a run in time: bearing forces and displacements, signals of sensors, amplitudes about chosen speeds."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.lines import Line2D

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.figures import COLOURS, typeset, write_heading
from ehdmaps.units import RPM
from mbs.model.on_rings import ring_motion
from mbs.output.page import grid, headed, left_out, shade, shade_handle, whole_numbers
from mbs.scene.assembly import Model
from mbs.spectral.spectra import AmplitudeSpectrum
from mbs.timedata.records import TimeData, TimeRecord
from mbs.transient.run import Recording

MOST_SENSORS = 6
"""Rows that are drawn."""

_POINTS = 3000
"""Of a line across a panel: more are drawn as least and largest value of each part."""

_PREFIXES = ((1e-1, "", 1.0), (1e-4, "m", 1e3), (1e-7, "µ", 1e6), (0.0, "n", 1e9))


def signal_panels(
    figure: FigureBase,
    records: Sequence[TimeRecord],
    spectra: Sequence[Sequence[Sequence[AmplitudeSpectrum]]] = (),
) -> list[Axes]:
    """Draw up to `MOST_SENSORS` sensors into a figure or a part of one; the panels over time are returned.

    Parameters
    ----------
    figure : FigureBase
        Figure, or part of one, that is drawn into.
    records : sequence of TimeRecord
        A run each, of the same channels.
    spectra : sequence of sequence of sequence of AmplitudeSpectrum
        Spectra about each speed, of each run, of each sensor; a column a speed.
    """
    sensors = records[0].sensors[:MOST_SENSORS]
    rows, columns = len(sensors), 1 + len(spectra)
    # Constrained layout ties columns of one grid together: each column its own width.
    axes = figure.subplots(rows, columns, squeeze=False, width_ratios=[1.3, *[1.0] * len(spectra)])
    for row, channel in enumerate(sensors):
        columns_of = [record.column(channel) for record in records]
        prefix, factor = _prefix(columns_of)
        unit = typeset(f"{prefix}{channel.unit}")
        for record, values, colour in zip(records, columns_of, COLOURS, strict=False):
            time, course = _envelope(record.time, factor * values)
            # What moves least lies on top.
            axes[row, 0].plot(time, course, color=colour, lw=0.5, zorder=2.0 + 1.0 / (1.0 + factor * np.ptp(values)))
        axes[row, 0].set_ylabel(f"{channel.name}\n{channel.recorded}, {unit}", fontsize=7.5)
        for column, about in enumerate(spectra, start=1):
            panel = axes[row, column]
            for of_run, colour in zip(about, COLOURS, strict=False):
                amplitude = of_run[row].amplitude
                panel.semilogy(of_run[row].frequencies, factor * amplitude, color=colour, lw=0.7)
            _decades(panel)
            if row == 0:
                panel.set_title(f"amplitude at {RPM.text(about[0][row].speed)}", fontsize=8)
            panel.set_ylabel(unit, fontsize=7.5)
    for panel in axes[-1, 1:]:
        panel.set_xlabel("frequency, Hz", fontsize=8)
    axes[-1, 0].set_xlabel("time, s", fontsize=8)
    for panel in axes.flat:
        grid(panel)
        panel.tick_params(labelsize=7)
        if panel.get_subplotspec().rowspan.stop < rows:
            panel.tick_params(labelbottom=False)
    for row in range(1, rows):
        for panel, above in zip(axes[row], axes[0], strict=True):
            panel.sharex(above)
    handles = [
        Line2D([], [], color=colour, lw=1.2, label=typeset(record.label))
        for record, colour in zip(records, COLOURS, strict=False)
    ]
    left_out(figure, handles if records[1:] else [], len(records[0].sensors) - rows)
    return list(axes[:, 0])


def _prefix(columns: Sequence[FloatArray]) -> tuple[str, float]:
    """Prefix and factor with which the largest of some values is a readable number."""
    largest = max(float(np.max(np.abs(column))) for column in columns)
    return next((name, factor) for least, name, factor in _PREFIXES if largest >= least)


def _envelope(time: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """A course with least and largest value of each part of it, where it has more points than are seen."""
    if values.size <= 2 * _POINTS:
        return time, values
    size = values.size // _POINTS
    kept = values[: size * (values.size // size)].reshape(-1, size)
    middles = time[: kept.size].reshape(-1, size)[:, size // 2]
    return np.repeat(middles, 2), np.column_stack([kept.min(axis=1), kept.max(axis=1)]).ravel()


def _decades(panel: Axes) -> None:
    """At most six decades below the highest amplitude: what lies deeper is nothing."""
    highest = max((float(np.max(line.get_ydata())) for line in panel.lines), default=0.0)
    lowest = min((float(np.min(line.get_ydata())) for line in panel.lines), default=0.0)
    if highest > 0.0:
        panel.set_ylim(max(lowest, 1e-6 * highest), 2.0 * highest)


_WIDTH, _COLUMN, _HEIGHT = 9.0, 2.6, 5.8
_SENSOR, _MARGIN, _SPECTRUM = 1.25, 0.9, 3.4
"""Height of the row of a sensor, of what is around all rows, and width of a column of spectra [inch]."""

_LEAST_SPAN = 1e-6
"""Of an axis, as a part of its largest value: less is round-off."""

_LENGTHS = ((1e-6, "µm", 1e6), (1e-9, "nm", 1e9), (0.0, "pm", 1e12))
_FORCES = ((1e4, "kN", 1e-3), (1e-1, "N", 1.0), (0.0, "mN", 1e3))


def run_figure(
    model: Model,
    run: Recording,
    below: float = 0.0,
    words: str = "",
    others: Sequence[tuple[Model, Recording]] = (),
    records: Sequence[TimeRecord] = (),
    spectra: Sequence[Sequence[Sequence[AmplitudeSpectrum]]] = (),
) -> Figure:
    """Bearing force, displacement of the inner ring and speed over time; every bearing in panels of its own.

    Of one law a bearing has a colour, of several laws each law has one. The signals of the sensors are below.

    Parameters
    ----------
    model : Model
        What ran.
    run : Recording
        The run.
    below : float
        Speed [rad/s] below which the film fades to the dry contact: these times are shaded.
    words : str
        What the shade means, for the legend.
    others : sequence of (Model, Recording)
        The same run with other laws.
    records : sequence of TimeRecord
        Signals of each law; none are drawn without.
    spectra : sequence of sequence of sequence of AmplitudeSpectrum
        Amplitudes about each speed, of each law, of each sensor.
    """
    columns, sensors = max(len(model.bearings), 1), min(len(records[0].sensors), MOST_SENSORS) if records else 0
    width = max(_WIDTH, _COLUMN * columns, _SPECTRUM * (len(spectra) + 1) if sensors else 0.0)
    height = _HEIGHT + (_SENSOR * sensors + _MARGIN if sensors else 0.0)
    figure = headed(model, "", (width, height), "laws side by side" if others else None)
    upper: FigureBase = figure
    lower: FigureBase | None = None
    if sensors:
        upper, lower = np.ravel(figure.subfigures(2, 1, squeeze=False, height_ratios=(_HEIGHT, height - _HEIGHT)))
    axes = upper.subplots(3, columns, sharex=True, sharey="row", squeeze=False)
    everything = [(model, run), *others]
    forces = [[np.hypot(f[:, 1], f[:, 2]) for f in one.forces[: len(model.bearings)]] for _, one in everything]
    places = [[_place(one, index) for index in range(len(model.bearings))] for _, one in everything]
    force_unit, force_factor = _unit([force for part in forces for force in part], _FORCES)
    length_unit, length_factor = _unit([place for part in places for place in part], _LENGTHS)
    for law, (_, one) in enumerate(everything):
        for index, bearing in enumerate(model.bearings):
            colour = COLOURS[(law if others else index) % len(COLOURS)]
            for row, values in enumerate((force_factor * forces[law][index], length_factor * places[law][index])):
                # What moves least lies on top.
                order = 2.0 + 1.0 / (1.0 + float(np.ptp(values)))
                axes[row, index].plot(one.time, values, color=colour, lw=0.8, zorder=order)
            axes[0, index].set_title(bearing.name, fontsize=9)
    for panel in axes[2]:
        panel.plot(run.time, run.speed * RPM.factor, color="0.2", lw=1.0)
        panel.set_xlabel("time, s")
    axes[0, 0].set_ylabel(f"bearing force, {force_unit}")
    axes[1, 0].set_ylabel(f"inner ring against\nthe outer one, {length_unit}")
    axes[2, 0].set_ylabel("speed, rpm")
    for panel in axes[:2].ravel():
        panel.set_visible(bool(model.bearings))
    for panel in axes.ravel():
        _room(panel)
        whole_numbers(panel)
        grid(panel)
    panels = axes.ravel().tolist()
    if lower is not None:
        panels += signal_panels(lower, records, spectra)
    if np.any(slow := np.abs(run.speed) < below):
        _shade(figure, panels, run.time, slow, words)
    return figure


def signals_figure(data: TimeData, spectra: Sequence[Sequence[Sequence[AmplitudeSpectrum]]] = ()) -> Figure:
    """Signals of recorded runs over time, with their amplitudes about chosen speeds.

    Parameters
    ----------
    data : TimeData
        The runs.
    spectra : sequence of sequence of sequence of AmplitudeSpectrum
        Amplitudes about each speed, of each run, of each sensor.
    """
    rows = min(len(data.records[0].sensors), MOST_SENSORS)
    size = (max(_WIDTH, _SPECTRUM * (len(spectra) + 1)), 1.4 * _SENSOR * rows + _MARGIN)
    figure = Figure(figsize=size, layout="constrained")
    write_heading(figure, data.title or data.records[0].label, 10)
    signal_panels(figure, data.records, spectra)
    return figure


def _place(run: Recording, index: int) -> FloatArray:
    """Radial displacement of the inner ring of a bearing against the outer one [m]."""
    motion = ring_motion(run.motions[index])
    return np.asarray(np.hypot(motion[:, 1], motion[:, 2]))


def _unit(values: Sequence[FloatArray], units: Sequence[tuple[float, str, float]]) -> tuple[str, float]:
    """Unit and factor in which the largest of some values has a readable number."""
    largest = max((float(part.max(initial=0.0)) for part in values), default=0.0)
    chosen = next(entry for entry in units if largest >= entry[0]) if largest > 0.0 else units[0]
    return chosen[1], chosen[2]


def _room(panel: Axes) -> None:
    """Widen an axis that would show round-off."""
    low, high = panel.get_ylim()
    least = _LEAST_SPAN * max(abs(low), abs(high))
    if high - low < least:
        middle = 0.5 * (low + high)
        panel.set_ylim(middle - 0.5 * least, middle + 0.5 * least)


def _shade(figure: Figure, panels: Sequence[Axes], time: FloatArray, slow: BoolArray, words: str) -> None:
    """Shade the times at which the film fades, and say so."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], slow.astype(np.int64), [0]])))
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        for panel in panels:
            shade(panel, float(time[begin]), float(time[min(end, time.size - 1)]))
    figure.legend(handles=[shade_handle(words)], loc="outside lower center", fontsize=8, frameon=False)

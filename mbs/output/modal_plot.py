"""Figure of a modal identification: responses with their fit, coherence, stabilisation diagram."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ehdmaps.figures import COLOURS, typeset, write_heading
from ehdmaps.units import MOTIONS, Display
from mbs.modal.records import Channel
from mbs.modal.result import ModalFit

_SIZE = (9.0, 8.5)
_MOST_ROWS = 5
"""Responses drawn: those with the most energy; more would hide each other."""

_MARKS = {"rfp": ("o", "rational fraction polynomials"), "lscf": ("^", "p-LSCF")}
_UNITS = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s2", "force": "N", "unknown": ""}


def fit_figure(title: str, fits: Sequence[ModalFit]) -> Figure:
    """Magnitude and phase of the responses with the fit, their coherence, and the poles over the order.

    Parameters
    ----------
    title : str
        Heading of the page.
    fits : sequence of ModalFit
        Fits of the same responses; the lines of the fit are those of the first one.
    """
    first = fits[0]
    figure = Figure(figsize=_SIZE, layout="constrained")
    write_heading(figure, f"{title}\n{_summary(first)}", 10)
    shown = _shown_rows(first)
    known = np.any(np.isfinite(first.responses.coherence[shown]))
    units = list(dict.fromkeys(_display(*first.responses.pairs[row]).unit for row in shown))
    heights = [*[3.0 / len(units) ** 0.5] * len(units), 1.4, *([1.0] if known else []), 2.2]
    axes = list(figure.subplots(len(heights), 1, sharex=True, height_ratios=heights))
    magnitudes = dict(zip(units, axes, strict=False))
    _responses(magnitudes, axes[len(units)], first, shown)
    if known:
        _coherence(axes[len(units) + 1], first, shown)
    _diagram(axes[-1], fits)
    for panel in axes:
        for frequency in first.frequency:
            panel.axvline(frequency, color="0.75", lw=0.7, zorder=0)
        panel.grid(color="0.9", lw=0.5)
        panel.set_axisbelow(True)
        panel.tick_params(labelsize=8)
    axes[0].set_xlim(first.responses.frequency[0], first.responses.frequency[-1])
    axes[-1].set_xlabel("frequency, Hz")
    return figure


def _responses(magnitudes: dict[str, Axes], phase: Axes, fit: ModalFit, shown: Sequence[int]) -> None:
    """Measured responses as pale lines, the fit over them."""
    frequency = fit.responses.frequency
    fine = np.unique(np.concatenate([np.linspace(frequency[0], frequency[-1], 4000), *_near(fit)]))
    made = fit.synthesise(fine)
    for row, colour in zip(shown, COLOURS, strict=False):
        measured = fit.responses.response[row]
        display = _display(*fit.responses.pairs[row])
        magnitude = magnitudes[display.unit]
        label = f"{fit.responses.labels[row]}, {100.0 * fit.error[row]:.2g} % left"
        magnitude.semilogy(frequency, display.factor * np.abs(measured), color=colour, lw=2.2, alpha=0.35)
        magnitude.semilogy(fine, display.factor * np.abs(made[row]), color=colour, lw=0.9, label=label)
        phase.plot(frequency, np.degrees(np.angle(measured)), ".", color=colour, ms=1.2, alpha=0.35)
        phase.plot(fine, _broken(np.degrees(np.angle(made[row]))), color=colour, lw=0.9)
    for unit, magnitude in magnitudes.items():
        magnitude.set_ylabel(f"response, {unit}")
        magnitude.legend(fontsize=8, frameon=False, title="pale: measured, thin: fit", title_fontsize=8)
    phase.set(ylabel="phase, degrees", yticks=[-180, -90, 0, 90, 180])


def _coherence(panel: Axes, fit: ModalFit, shown: Sequence[int]) -> None:
    """Coherence of each response."""
    for row, colour in zip(shown, COLOURS, strict=False):
        panel.plot(fit.responses.frequency, fit.responses.coherence[row], color=colour, lw=0.7)
    panel.set(ylabel=f"coherence,\n{fit.responses.hits} hits", ylim=(0.0, 1.05))


def _diagram(panel: Axes, fits: Sequence[ModalFit]) -> None:
    """Poles over the order: stable ones filled."""
    highest = 1
    for fit, colour in zip(fits, ("0.1", COLOURS[1]), strict=False):
        mark, name = _MARKS[fit.method]
        # The window is taken out, so that the poles stand over the peaks.
        poles = np.array([entry.pole for entry in fit.candidates]) + fit.responses.decay
        orders = np.array([entry.order for entry in fit.candidates])
        stable = np.array([entry.stable for entry in fit.candidates], dtype=bool)
        frequency = np.abs(poles) / (2.0 * np.pi)
        panel.plot(frequency[stable], orders[stable], mark, color=colour, ms=3.5, label=f"{name}: stable")
        panel.plot(frequency[~stable], orders[~stable], mark, color=colour, ms=2.5, mfc="none", mew=0.4, alpha=0.5)
        highest = max(highest, int(orders.max()))
    panel.set(ylabel="order, pole pairs\n(hollow: not stable)", ylim=(0, highest + 1))
    panel.legend(fontsize=8, frameon=True, framealpha=0.9, edgecolor="none", loc="lower right")


def _near(fit: ModalFit) -> list[np.ndarray[tuple[int], np.dtype[np.float64]]]:
    """Frequencies around each mode, close enough to draw its peak."""
    low, high = fit.responses.frequency[0], fit.responses.frequency[-1]
    found = []
    for pole in fit.poles:
        centre, width = abs(pole) / (2.0 * np.pi), max(abs(pole.real), 1e-6 * abs(pole)) / (2.0 * np.pi)
        found.append(np.clip(centre + width * np.linspace(-8.0, 8.0, 161), low, high))
    return found


def _broken(phase: np.ndarray[tuple[int], np.dtype[np.float64]]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Phase with gaps where it jumps from -180 to 180 degrees."""
    broken = phase.copy()
    broken[1:][np.abs(np.diff(phase)) > 180.0] = np.nan
    return broken


def _shown_rows(fit: ModalFit) -> list[int]:
    """Rows that are drawn."""
    energy = np.sum(np.abs(fit.responses.response) ** 2, axis=1)
    return sorted(np.argsort(-energy, kind="stable")[:_MOST_ROWS].tolist())


def _display(sensor: Channel, reference: Channel) -> Display:
    """How a response is shown."""
    unit = _UNITS[sensor.quantity].replace("m", "rad", 1) if sensor.rotational else _UNITS[sensor.quantity]
    shown = MOTIONS.get(unit, Display(unit or "1"))
    return Display(f"{typeset(shown.unit)}/{'(N m)' if reference.rotational else 'N'}", shown.factor)


def _summary(fit: ModalFit) -> str:
    """The modes in a line."""
    modes = [f"{f:.5g} Hz, ζ {100.0 * z:.3g} %" for f, z in zip(fit.frequency[:5], fit.damping_ratio[:5], strict=True)]
    return "; ".join(modes) + (" ..." if fit.poles.size > 5 else "")

"""`mbs modal-fit`: frequencies and damping ratios from measured or simulated hammer hits or frequency responses."""

from __future__ import annotations

import argparse
import dataclasses
import math
from pathlib import Path

import numpy as np

from ehdmaps.errors import InputError, Problems, problems_after
from ehdmaps.outputs import FIGURE, Output, output_problems, write_figure
from ehdmaps.units import quantity
from mbs.modal.estimation import Estimate, estimate, needed_decay
from mbs.modal.fit import identify
from mbs.modal.records import Responses
from mbs.modal.result import ModalFit, fit_dataset
from mbs.modal.uff import UFF, Measurement, read_uff, write_uff
from mbs.output.files import RESULT, described, write_dataset

TOLERANCE = 0.2
"""Largest part of a response that a fit may leave, rms over rms, before the status says so."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Estimate the responses where there are hits, fit them, and say what was found."""
    band, decay, windowed = _options(arguments)
    measured = _declared(read_uff(Path(arguments.file)), windowed, arguments)
    responses, lines = _responses(measured, arguments, decay)
    fit = identify(responses, band, arguments.order, arguments.modes, refined=not arguments.no_refine)
    inside = fit.responses
    lines = [
        f"{arguments.file}: {measured.title or 'no title'}",
        *(f"  {note}" for note in measured.notes),
        *lines,
        f"{len(inside.pairs)} responses, {inside.frequency.size} lines from {inside.frequency[0]:.6g} Hz to "
        f"{inside.frequency[-1]:.6g} Hz",
        *_table(fit),
    ]
    poor = _poor(fit)
    lines += [*_overlaps(fit), *poor, *_write(arguments, measured, responses, fit)]
    return "\n".join(lines), 1 if poor else 0


def _declared(measured: Measurement, windowed: float | None, arguments: argparse.Namespace) -> Measurement:
    """The records with the window that an analyser has put on them: its time constant, or what it leaves, negative."""
    if windowed is None:
        return measured

    def decay(duration: float) -> float:
        return 1.0 / windowed if windowed > 0.0 else -math.log(-windowed) / duration

    hits = tuple(
        dataclasses.replace(entry, decay=decay(entry.duration), force_decays="force" in arguments.windowed[1:])
        for entry in measured.hits
    )
    responses = measured.responses
    if responses is not None:
        spacing = float(np.diff(responses.frequency).mean())
        responses = dataclasses.replace(responses, decay=decay(1.0 / spacing))
    return dataclasses.replace(measured, hits=hits, responses=responses)


def _windowed(text: str) -> float:
    """A time constant [s], or minus the part that a window leaves at the end of a record."""
    if text.rstrip().endswith("%"):
        try:
            part = float(text.rstrip()[:-1]) / 100.0
        except ValueError:
            part = 0.0
        if not 0.0 < part < 1.0:
            raise InputError(f"got {text!r:.40}; allowed: above 0 %, below 100 %")
        return -part
    constant = quantity(text, "s")
    if not constant > 0.0:
        raise InputError(f"got {text!r:.40}; allowed: above 0 s")
    return constant


def _options(
    arguments: argparse.Namespace,
) -> tuple[tuple[float, float] | None, float | None, float | None]:
    """Read band and windows, and check the outputs; a decay of None is found from the records."""
    problems = Problems()
    ends = []
    for text in arguments.band or ():
        with problems.after("--band: "):
            ends.append(quantity(text, "Hz"))
    if len(ends) == 2 and not 0.0 <= ends[0] < ends[1]:
        problems.append(
            f"--band: got {arguments.band[0]!r:.40} to {arguments.band[1]!r:.40}; allowed: rising, from 0 Hz on"
        )
    decay: float | None = None
    if arguments.window_decay == "none":
        decay = 0.0
    elif arguments.window_decay is not None:
        with problems, problems_after("--window-decay: ", ", or none"):
            constant = quantity(arguments.window_decay, "s")
            if not constant > 0.0:
                raise InputError(f"got {arguments.window_decay!r:.40}; allowed: above 0 s")
            decay = 1.0 / constant
    windowed: float | None = None
    if arguments.windowed is not None:
        with problems, problems_after("--windowed: ", ", or what it leaves at the end, as 1 %"):
            windowed = _windowed(arguments.windowed[0])
        if arguments.windowed[1:] not in ([], ["force"]):
            problems.append(f"--windowed: got {' '.join(arguments.windowed[1:])!r:.40} behind the time; allowed: force")
    files = (
        ("-o", arguments.output, RESULT),
        ("--plot", arguments.plot, FIGURE),
        ("--responses", arguments.responses, UFF),
    )
    problems += output_problems([Output(*file) for file in files], [arguments.file])
    problems.check()
    return (ends[0], ends[1]) if ends else None, decay, windowed


def _responses(
    measured: Measurement, arguments: argparse.Namespace, decay: float | None
) -> tuple[Responses, list[str]]:
    """Responses of the file, or those estimated from its hits, and lines on how."""
    if not measured.hits:
        if measured.responses is None:
            raise InputError(f"{arguments.file}: has coherences only; allowed: frequency responses, or hits")
        if decay is not None and arguments.windowed is not None:
            raise InputError("--window-decay, --windowed: got both for frequency responses; allowed: one of them")
        found = measured.responses if decay is None else dataclasses.replace(measured.responses, decay=decay)
        window = f", exponential window of {1.0 / found.decay:.4g} s taken out of the damping" if found.decay else ""
        return found, [f"  frequency responses of the file{window}"]
    if decay is None:
        decay = max(needed_decay(entry.response, entry.step) for entry in measured.hits)
        why = "; responses had not decayed" if decay else ""
    else:
        why = ""
    made = estimate(measured.hits, arguments.estimator, decay)
    lines = [
        f"  hits at {entry.reference.label}: {used} of {entry.force.shape[0]} averaged, {entry.duration:.4g} s each"
        for entry, used in zip(measured.hits, made.used, strict=True)
    ]
    lines += _rejections(made)
    through = measured.hits[0].decay
    if through:
        on = "force and responses" if measured.hits[0].force_decays else "the responses"
        lines.append(f"  {on} have been through a window of {1.0 / through:.4g} s, taken out of the damping")
    window = (
        f"exponential window of {1.0 / decay:.4g} s on force and response, taken out again{why}" if decay else "none"
    )
    lines.append(f"  estimator {arguments.estimator.upper()}; window: {window}")
    if min(made.used) < 2:
        lines.append("  warning: a single hit has no coherence: all lines count alike")
    return made.responses, lines


def _rejections(made: Estimate) -> list[str]:
    """Lines on hits that were left out, and on those that bounced."""
    left_out = [
        f"  hit {one.hit} at {one.reference.label} left out: {one.reason}, {one.detail}" for one in made.rejected
    ]
    return left_out + [
        f"  hit {one.hit} at {one.reference.label} bounced: {one.detail}, taken with it" for one in made.bounced
    ]


def _table(fit: ModalFit) -> list[str]:
    """Lines of the modes of a fit."""
    orders = max(entry.order for entry in fit.candidates)
    how = "refined to the least error" if fit.refined else "medians over the orders"
    lines = [
        f"p-LSCF, orders 1 to {orders}, poles {how}",
        "  mode   frequency/Hz        +-   damping ratio        +-   orders      (+-: standard uncertainty"
        f"{'; 0 orders: in what other modes left' if 0 in fit.counts else ''})",
    ]
    for k in range(fit.poles.size):
        lines.append(
            f"  {k + 1:4d} {fit.frequency[k]:14.7g} {fit.frequency_uncertainty[k]:9.2g} {fit.damping_ratio[k]:15.5g} "
            f"{fit.damping_uncertainty[k]:9.2g} {fit.counts[k]:8d}"
        )
    return lines + [
        f"  {label}: {100.0 * error:.3g} % left (rms)"
        for label, error in zip(fit.responses.labels, fit.error, strict=True)
    ]


def _poor(fit: ModalFit) -> list[str]:
    """Lines on responses that a fit does not explain."""
    return [
        f"warning: p-LSCF leaves {100.0 * error:.3g} % of {label}, more than {100.0 * TOLERANCE:.3g} %: "
        "noise, or modes that are missing; average more hits, or narrow the band"
        for label, error in zip(fit.responses.labels, fit.error, strict=True)
        if error > TOLERANCE
    ]


def _overlaps(fit: ModalFit) -> list[str]:
    """Lines on modes that lie within each other's half widths, whose damping is hard to tell apart."""
    lines = []
    for k in range(fit.poles.size - 1):
        apart = float(fit.poles[k + 1].imag - fit.poles[k].imag)
        wide = float(-fit.poles[k].real - fit.poles[k + 1].real)
        if apart < wide:
            lines.append(
                f"warning: modes {k + 1} and {k + 2} are {apart / (2.0 * np.pi):.3g} Hz apart, with half widths of "
                f"{wide / (2.0 * np.pi):.3g} Hz together: their damping ratios depend on each other"
            )
    return lines


def _write(arguments: argparse.Namespace, measured: Measurement, responses: Responses, fit: ModalFit) -> list[str]:
    """Write what is asked for; a line for each file."""
    lines = []
    if arguments.output:
        about = {"title": measured.title, "source": Path(arguments.file).name, "estimator": arguments.estimator}
        write_dataset(described(fit_dataset(fit), **about), Path(arguments.output))
        lines.append(f"{arguments.output}: written")
    if arguments.responses:
        write_uff(Path(arguments.responses), Measurement(measured.title, (), responses))
        lines.append(f"{arguments.responses}: written")
    if arguments.plot:
        from mbs.output.modes_plot import fit_figure

        write_figure(fit_figure(measured.title or Path(arguments.file).name, fit), arguments.plot)
        lines.append(f"{arguments.plot}: written")
    return lines

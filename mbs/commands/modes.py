"""`mbs modes`: complex modes at the operating speed."""

from __future__ import annotations

import argparse
import math

import numpy as np

from ehdmaps.arrays import IntArray
from ehdmaps.errors import InputError
from mbs.analyses.modes import modes
from mbs.commands.auto import Looked, analysed
from mbs.commands.cases import load_model
from mbs.commands.common import band_lines, clean, film_lines, free_words, heading, outside_at, read_option, write
from mbs.commands.reach import fade_lines
from mbs.linearised.modes import Modes
from mbs.output.modes_plot import modes_figure
from mbs.scene.assembly import Model
from mbs.scene.campbell import HIGHEST_HIGHEST, LOWEST_HIGHEST
from mbs.scene.fields import HERTZ, MILLISECOND
from mbs.scene.scene import Scene

HIGHEST = 10e3
"""Highest frequency shown of a scene that asks for no responses [Hz]."""

_LEAST_SHARE = 0.05


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Find the modes."""
    done = analysed(arguments, _asked, lambda asked: modes(asked[0]), lambda asked: Looked(asked[0].scene, asked[1]))
    result, highest = done.result, _highest(arguments, done.result.model.scene, [])
    model, found = result.model, result.modes
    free, overdamped, swinging = _kinds(found)
    shown = swinging[found.frequency[swinging] <= highest]
    above = swinging[found.frequency[swinging] > highest]
    notes = [*_free(free), *_above(found, above, highest)]
    figure = None
    if arguments.plot:
        limit = min((entry.frequency for entry in result.errors), default=math.inf)
        figure = modes_figure(model, found, shown, limit, "; ".join([*notes, *_overdamped_count(overdamped)]))
    outside = outside_at(model, result.balance)
    lines = [
        *done.lines,
        *heading(model, model.scene.speed),
        *_table(found, shown),
        *band_lines(model),
        *_overdamped(found, overdamped),
        *(f"  {note}" for note in notes),
        *_lost(found),
        *film_lines(result.errors, found.frequency[shown]),
        *(fade_lines(model, np.array([model.scene.speed])) if model.scene.speed else []),
        *outside,
        *write(arguments, result.dataset, figure),
    ]
    return "\n".join(lines), 1 if outside else done.status


def _asked(arguments: argparse.Namespace) -> tuple[Model, float]:
    """The model, and the highest frequency to show [Hz]; all problems at once."""
    problems: list[str] = []
    try:
        model = load_model(arguments)
    except InputError as error:
        problems += error.problems
        model = None
    highest = _highest(arguments, None if model is None else model.scene, problems)
    if problems or model is None:
        raise InputError(tuple(dict.fromkeys(problems)))
    return model, highest


def _highest(arguments: argparse.Namespace, scene: Scene | None, problems: list[str]) -> float:
    """The highest frequency to show [Hz]."""
    text = getattr(arguments, "highest", None)
    highest = read_option("--highest", text, "Hz", (LOWEST_HIGHEST, HIGHEST_HIGHEST), HERTZ, problems)
    return max(scene.frequencies if scene else (), default=HIGHEST) if highest is None else highest


def _kinds(found: Modes) -> tuple[IntArray, IntArray, IntArray]:
    """Which modes are free, which creep back without oscillating, and which oscillate."""
    free = found.free
    creeping = (found.eigenvalues.imag <= 0.0) & ~free
    return np.flatnonzero(free), np.flatnonzero(creeping), np.flatnonzero(~free & ~creeping)


def _table(found: Modes, shown: IntArray) -> list[str]:
    """Lines of modes: frequency, damping ratio, and the parts that have most of the strain energy."""
    bands = found.bands
    wide = "" if bands is None else "        +-"
    lines = [
        f"  mode   frequency/Hz{wide}   damping ratio{wide}   strain energy        (frequency: |eigenvalue|/(2 pi))"
    ]
    for k in shown:
        ratio = clean(found.damping_ratio[k])
        by = ("", "") if bands is None else (f"{bands.frequency[k]:10.2g}", f"{bands.damping_ratio[k]:10.2g}")
        lines.append(f"  {k + 1:4d} {found.frequency[k]:14.6g}{by[0]} {ratio:15.4g}{by[1]}   {_shares(found, k)}")
    return lines


def _shares(found: Modes, mode: int) -> str:
    """The parts that have most of the strain energy of a mode."""
    order = np.argsort(-found.shares[:, mode], kind="stable")
    shares = [
        f"{found.parts[i]} {100.0 * found.shares[i, mode]:.3g} %"
        for i in order
        if found.shares[i, mode] >= _LEAST_SHARE
    ]
    return ", ".join(shares) or "none"


def _overdamped(found: Modes, which: IntArray) -> list[str]:
    """Lines of motions that creep back: how long they take, and where the strain energy is."""
    if not which.size:
        return []
    lines = ["  overdamped (no oscillation): time to fall to 1/e"]
    for k in which:
        decay = -float(found.eigenvalues[k].real)
        time = MILLISECOND.text(1.0 / decay) if decay > 0.0 else "grows"
        lines.append(f"  {k + 1:4d} {time:>14}                   {_shares(found, k)}")
    return lines


def _overdamped_count(which: IntArray) -> list[str]:
    """How many motions creep back."""
    return [f"{which.size} overdamped motions not drawn"] if which.size else []


def _free(which: IntArray) -> list[str]:
    """A line for all free motions."""
    return [free_words(which.size)] if which.size else []


def _lost(found: Modes) -> list[str]:
    """Lines on what films that relax leave without a mode."""
    lines = []
    if found.among_films:
        lines.append(
            "  motions without oscillation that are as quick as films relax cannot be told from these: not shown"
        )
    lines += [
        f"warning: the mode near {HERTZ.text(abs(entry.eigenvalue) / (2.0 * math.pi), 5)} could not be brought to the "
        f"films of its own frequency ({entry.reason.value}); it is not shown"
        for entry in found.lost
    ]
    return lines


def _above(found: Modes, which: IntArray, highest: float) -> list[str]:
    """A line on modes that are not shown."""
    if not which.size:
        return []
    last = HERTZ.text(float(found.frequency[which].max()), 5)
    return [f"{which.size} more modes above {HERTZ.text(highest, 5)}, up to {last}, not shown (--highest)"]

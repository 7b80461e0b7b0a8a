"""`mbs lsa`: state space and frequency responses at the equilibrium."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import Problems
from ehdmaps.exports.mat import KIND
from ehdmaps.outputs import FIGURE, Output, output_problems
from ehdmaps.units import written
from mbs.analyses.case import Case
from mbs.analyses.lsa import LsaResult, LsaSettings, lsa_dataset, lsa_figure, lsa_of, lsa_problems
from mbs.analyses.reach import fade_lines, outside_at
from mbs.analyses.soundness import Judged
from mbs.commands.auto import analysed
from mbs.commands.cases import files_read, load_cases
from mbs.commands.common import Looked, read_cage_angles, with_bands, write
from mbs.linearised.linear import peak_places, response_display
from mbs.linearised.peaks import Linearised, by_laws, peaks_of_modes
from mbs.output.band_text import (
    DECIDED,
    HEAD,
    about_lines,
    bounds_text,
    exact_text,
    lost_lines,
    value_text,
)
from mbs.output.excitation.table import line_rows
from mbs.output.files import RESULT
from mbs.output.model_text import band_lines, film_lines, heading
from mbs.output.reduction_text import reduction_lines
from mbs.output.state_space_file import write_spaces
from mbs.planning.question import at_one_speed
from mbs.scene.assembly import Model
from mbs.unknowns.held_open import held_open_of
from mbs.unknowns.of_modes import banded as may_be_shown
from mbs.unknowns.of_peaks import PeakBands

MOST_COMPARED_CASES = 8
"""That can be told apart in a figure."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Linearise, and compute the responses over the frequencies of the scene, with each law."""
    problems = Problems()
    settings = LsaSettings(cage_angles=read_cage_angles(arguments, problems))
    banded = with_bands(arguments, problems)
    problems.check()
    done = analysed(
        arguments,
        _asked,
        lambda cases: list(zip([c.label for c in cases], lsa_of([c.model for c in cases], settings), strict=True)),
        _looks_at,
    )
    found = done.result
    labels, results = [label for label, _ in found], [entry for _, entry in found]
    judged = Judged([(label, entry.findings) for label, entry in found])
    banded = banded and not found[1:] and results[0].model.scene.has_bearings
    figure = lsa_figure(labels, results, banded) if arguments.plot else None
    lines = [*judged.first, *done.lines]
    outside: list[str] = []
    for label, entry in found:
        outside += [line for line in outside_at(entry.model, entry.balance) if line not in outside]
        lines += _report(entry, label if found[1:] else "", banded)
    lines += _by_laws(labels, results) if found[1:] else []
    dataset = judged.marked(results[0].bounded() if banded else lsa_dataset(labels, results))
    lines += [*judged.last, *outside, *write(arguments, dataset, figure)]
    if file := getattr(arguments, "state_space", None):
        write_spaces(Path(file), found)
        lines.append(f"{file}: written")
    return "\n".join(lines), 1 if outside or judged.status else 0


def _asked(arguments: argparse.Namespace) -> list[Case]:
    """A case for each law, map, kind of films, oil supply and clearance."""
    file = getattr(arguments, "state_space", None)
    problems = Problems()
    cases: list[Case] = []
    with problems:
        cases = load_cases(arguments, needs=lsa_problems, most=MOST_COMPARED_CASES)
    if file is not None:
        read = files_read(arguments, cases[0].model.scene if cases else None)
        outputs = [Output("-o", arguments.output, RESULT), Output("--plot", arguments.plot, FIGURE)]
        problems += output_problems([*outputs, Output("--state-space", file, KIND)], read)
    problems.check()
    return cases


def _looks_at(cases: list[Case]) -> Looked:
    """The scene at its operating speed, and the highest frequency of the responses."""
    scene = cases[0].model.scene
    return Looked(at_one_speed(scene), max(scene.frequencies, default=0.0))


def _report(found: LsaResult, label: str, banded: bool) -> list[str]:
    """Lines of one case; its label is empty if it is the only one."""
    model, scene, frequencies = found.model, found.model.scene, found.frequencies
    return [
        *heading(model, scene.speed),
        *([f"  case: {label}"] if label else []),
        f"state space: {found.space.A.shape[0]} states, {len(scene.inputs)} inputs, {len(scene.sensors)} outputs; "
        f"{found.asked} frequencies, and {frequencies.size - found.asked} more around lightly "
        "damped modes",
        *(_peak_bands(model, found) if banded else _peaks(model, found)),
        *line_rows(found.lines, scene.sensors),
        *band_lines(model, found.film_share, banded),
        *_reduction(found),
        *film_lines(found.errors, frequencies),
        *(fade_lines(model, np.array([scene.speed])) if scene.speed else []),
    ]


def _reduction(found: LsaResult) -> list[str]:
    """Lines on what the reduction of bodies leaves out of the modes up to the highest frequency."""
    modes = found.modes
    seen = (modes.frequency <= found.frequencies.max()) & (modes.eigenvalues.imag > 0.0)
    part = None if modes.reduction is None else modes.reduction.of(seen)
    return reduction_lines(found.balance.system, modes.frequency[seen], modes.damping_ratio[seen], part)


def _peak_bands(model: Model, found: LsaResult) -> list[str]:
    """Lines of the peaks of each response, with what is not known of them and what decides that."""
    bands, lines = found.bands, []
    for s, sensor in enumerate(model.scene.sensors):
        for i, entry in enumerate(model.scene.inputs):
            display = response_display(sensor, entry)
            size = display.factor * np.abs(found.responses[:, s, i])
            begin = f"  {sensor.name} ({sensor.quantity}, {display.unit}) by {entry.name}: "
            rows = []
            for k in peak_places(size).tolist():
                place = bands.place(k, s, i)
                if place is None:
                    rows.append(
                        f"  {found.frequencies[k]:9.5g} {'-':20s} {written(size[k]):>9s}   - (of no single mode)"
                    )
                    continue
                low, high = (10.0 ** ((end[place] - bands.level.value[place]) / 20.0) * size[k] for end in _ends(bands))
                reach = f"{written(low, 2)} to {written(high, 2)}"
                rows.append(
                    f"  {value_text(bands.frequency, place):>9s} {bounds_text(bands.frequency, place):20s} "
                    f"{written(size[k], 2):>9s}   {reach:20s} {exact_text(bands.level, place, 'dB')}"
                )
            heads = f"peaks: frequency/Hz, {HEAD}; size, 90 %; level {DECIDED}"
            lines += [begin + heads, *rows] if rows else [begin + "no peak"]
    names = [f"peak {k + 1}" for k in range(bands.places.shape[0])]
    told = {"frequency of peaks": bands.frequency, "level": bands.level}
    return [*lines, *lost_lines(bands.frequency, names), *about_lines(model.scene, held_open_of(model), told)]


def _ends(bands: PeakBands) -> tuple[FloatArray, FloatArray]:
    """Bounds of the levels."""
    return bands.level.low, bands.level.high


def _by_laws(labels: Sequence[str], results: Sequence[LsaResult]) -> list[str]:
    """Tables of the modes of the first law: frequency and height of each response by each law, and its differences."""
    first, scene = results[0], results[0].model.scene
    sizes = np.abs(first.responses)
    seen = may_be_shown(first.modes, float(first.frequencies[-1]))
    laws = [Linearised(entry.balance, entry.modes) for entry in results]
    frequencies, heights = by_laws(laws, scene.inputs, scene.sensors, seen)
    of_peaks, own = peaks_of_modes(first.modes, seen, first.frequencies, sizes)
    lines = []
    for s, sensor in enumerate(scene.sensors):
        for i, entry in enumerate(scene.inputs):
            display = response_display(sensor, entry)
            shown = sorted(set(own[(of_peaks[:, 1] == s) & (of_peaks[:, 2] == i)].tolist()))
            if not shown:
                continue
            lines += [
                f"{sensor.name} ({sensor.quantity}, {display.unit}) by {entry.name}: modes that have a peak by "
                f"{labels[0]}, and the same by the others, in Hz and as heights, with their differences",
                f"  {'mode':>4s}  {labels[0]:>19.19s}" + "".join(f"  {label:>37.37s}" for label in labels[1:]),
            ]
            for k in shown:
                frequency, height = frequencies[:, k], display.factor * heights[:, s, i, k]
                cells = "".join(map(_beside_first, frequency[1:], height[1:], [frequency[0]] * 9, [height[0]] * 9))
                lines.append(f"  {seen[k] + 1:4d}  {frequency[0]:9.5g} {height[0]:9.3g}{cells}")
    return lines


def _beside_first(frequency: float, height: float, known: float, high: float) -> str:
    """Frequency and height of a mode by a law, beside those by the first."""
    if not np.isfinite(frequency):
        return f"  {'no mode of this shape':>37s}"
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = 20.0 * np.log10(height / high)
    level = f"{apart:+.1f} dB" if np.isfinite(apart) else "-"
    return f"  {frequency:9.5g} {100.0 * (frequency / known - 1.0):+7.2f} % {height:8.3g} {level:>9s}"


def _peaks(model: Model, found: LsaResult) -> list[str]:
    """Lines of the peaks of each response, with the bands of their levels."""
    lines = []
    frequencies, responses, bands = found.frequencies, found.responses, found.level_error
    for s, sensor in enumerate(model.scene.sensors):
        for i, entry in enumerate(model.scene.inputs):
            display = response_display(sensor, entry)
            size = display.factor * np.abs(responses[:, s, i])
            shown = [
                f"{frequencies[k]:.5g} Hz ({size[k]:.3g}{'' if bands is None else f' +- {bands[k, s, i]:.2g} dB'})"
                for k in peak_places(size)
            ]
            lines.append(
                f"  {sensor.name} ({sensor.quantity}, {display.unit}) by {entry.name}: "
                + (f"peaks at {', '.join(shown)}" if shown else "no peak")
            )
    return lines

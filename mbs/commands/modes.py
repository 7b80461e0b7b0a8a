"""`mbs modes`: complex modes at the operating speed."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np

from ehdmaps.arrays import IntArray
from ehdmaps.choices import read_option
from ehdmaps.errors import InputError, Problems
from ehdmaps.extras import lacking
from ehdmaps.outputs import FIGURE, Output, output_problems, write_text
from ehdmaps.units import RPM
from mbs.analyses.modes import ModesResult, modes
from mbs.analyses.reach import fade_lines, outside_at
from mbs.analyses.soundness import Judged
from mbs.commands.auto import analysed
from mbs.commands.cases import files_read, load_model
from mbs.commands.common import Looked, read_cage_angles, with_bands, write, write_plot
from mbs.linearised.mode_names import mode_names
from mbs.linearised.modes import Modes
from mbs.linearised.shapes import skeleton
from mbs.output.band_text import about_lines, mode_lines, share_words
from mbs.output.files import RESULT
from mbs.output.model_text import LITTLE_DAMPING, OTHER_DAMPING, band_lines, clean, film_law_line, film_lines, heading
from mbs.output.reduction_text import reduction_lines
from mbs.output.result_text import above_lines, free_lines, kinds
from mbs.output.shapes.shapes_file import MOST_SHAPES as MOST_WRITTEN
from mbs.output.shapes.shapes_file import SHAPES, series_files, write_shapes
from mbs.output.shapes.shapes_page import MOST_SHAPES as MOST_MOVING
from mbs.output.shapes.shapes_page import PAGE, is_page, shapes_page
from mbs.planning.question import at_one_speed
from mbs.scene.assembly import Model
from mbs.scene.fields import HERTZ, MILLISECOND
from mbs.scene.scene import Scene
from mbs.settings import HIGHEST_HIGHEST, LOWEST_HIGHEST
from mbs.unknowns.held_open import held_open_of

HIGHEST = 10e3
"""Highest frequency shown of a scene that asks for no responses [Hz]."""

_LAST = 100_000


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Find the modes."""
    done = analysed(
        arguments,
        _asked,
        lambda asked: modes(asked[0], cage_angles=asked[2], highest=asked[1]),
        lambda asked: Looked(at_one_speed(asked[0].scene), asked[1]),
    )
    result, highest = done.result, _highest(arguments, done.result.model.scene, Problems())
    model, found = result.model, result.modes
    bands = result.bands_to(highest) if with_bands(arguments, []) and model.scene.has_bearings else None
    free, overdamped, swinging = kinds(found)
    shown = swinging[found.frequency[swinging] <= highest]
    above = swinging[found.frequency[swinging] > highest]
    notes = [*free_lines(free, model.system), *above_lines(found, above, highest)]
    figure = result.plot(highest, bands) if arguments.plot else None
    outside, judged = outside_at(model, result.balance), Judged([("", result.findings)])
    lines = [
        *judged.first,
        *done.lines,
        *heading(model, model.scene.speed),
        *(_table(found, shown) if bands is None else mode_lines(found, shown, bands)),
        *([f"  {OTHER_DAMPING}"] if np.any(found.damping_ratio[shown] < LITTLE_DAMPING) else []),
        *(about_lines(model.scene, held_open_of(model), bands.told) if bands is not None else []),
        *band_lines(model, 0.0 if found.bands is None else found.bands.film_share, bands is not None),
        *(film_law_line(model, found.film_law is not None) if bands is None else []),
        *reduction_lines(
            result.balance.system,
            found.frequency[shown],
            found.damping_ratio[shown],
            None if found.reduction is None else found.reduction.of(shown),
        ),
        *_overdamped(found, overdamped),
        *(f"  {note}" for note in notes),
        *_lost(found),
        *film_lines(result.errors, found.frequency[shown]),
        *(fade_lines(model, np.array([model.scene.speed])) if model.scene.speed else []),
        *judged.last,
        *outside,
        *write(arguments, result.dataset if bands is None else bands.into(result.dataset), figure),
        *_write_shapes(arguments, result, shown),
    ]
    return "\n".join(lines), 1 if outside or judged.status else 0


def _asked(arguments: argparse.Namespace) -> tuple[Model, float, int]:
    """The model, the highest frequency to show [Hz], and the cage angles; all problems at once."""
    problems = Problems()
    model: Model | None = None
    with problems:
        model = load_model(arguments)
    highest = _highest(arguments, None if model is None else model.scene, problems)
    problems += _shape_problems(arguments, model)
    cage_angles = read_cage_angles(arguments, problems)
    with_bands(arguments, problems)
    if problems or model is None:
        raise InputError(problems)
    return model, highest, cage_angles


def _shape_problems(arguments: argparse.Namespace, model: Model | None) -> list[str]:
    """List problems with pictures and files of shapes."""
    picture, file = getattr(arguments, "shapes", None), getattr(arguments, "shapes_file", None)
    numbers = getattr(arguments, "shape_modes", None)
    problems = Problems()
    if numbers:
        if picture is None and file is None:
            problems.append("--shape-modes: stands without --shapes and --shapes-file; allowed: with one of them")
        wrong = [text for text in numbers if not (text.isascii() and text.isdigit() and 1 <= int(text[:9]) <= _LAST)]
        problems += [f"--shape-modes: got {text!r:.40}; allowed: numbers of modes from 1 on" for text in wrong]
        if picture is not None and not is_page(picture):
            from mbs.output.modes_plot import MOST_SHAPES

            if len(numbers) > MOST_SHAPES:
                problems.append(f"--shape-modes: got {len(numbers)} modes for a picture; allowed: up to {MOST_SHAPES}")
    if file is not None:
        problems += lacking("flexible", "meshio", "--shapes-file")
    read = files_read(arguments, model.scene if model else None)
    series = series_files(Path(file)) if file is not None and Path(file).suffix.lower() == ".pvd" else []
    outputs = [
        Output("-o", getattr(arguments, "output", None), RESULT),
        Output("--plot", getattr(arguments, "plot", None), FIGURE),
        Output("--shapes", picture, PAGE if picture is not None and is_page(picture) else FIGURE),
        Output("--shapes-file", file, SHAPES),
        *(Output("--shapes-file", path, SHAPES) for path in series),
    ]
    return problems + (output_problems(outputs, read) if picture or file else [])


def _write_shapes(arguments: argparse.Namespace, result: ModesResult, shown: IntArray) -> list[str]:
    """Write the pictures and files of shapes that are asked for; a line for each."""
    picture, file = getattr(arguments, "shapes", None), getattr(arguments, "shapes_file", None)
    if picture is None and file is None:
        return []
    given = [int(text) - 1 for text in getattr(arguments, "shape_modes", None) or ()]
    there = [mode for mode in given if mode < result.modes.frequency.size]
    lines = [
        f"warning: --shape-modes: mode {mode + 1} is not there; the last one is {result.modes.frequency.size}"
        for mode in given
        if mode not in there
    ]
    wanted = there if given else [int(mode) for mode in shown]
    bones = skeleton(result.model.system)
    if file is not None:
        beside = len(write_shapes(Path(file), result.modes, bones, wanted)) - 1
        more = f", with {beside} files of the series" if beside else ""
        lines.append(f"{file}: written, {min(len(wanted), MOST_WRITTEN)} modes{more}")
    if picture is not None and is_page(picture):
        (head, *words) = heading(result.model, result.model.scene.speed)
        names = mode_names(result.balance, result.modes, kinds(result.modes)[2])
        write_text(picture, shapes_page(head, " ".join(words).strip(), result.modes, bones, wanted, names), PAGE)
        lines.append(f"{picture}: written, {min(len(wanted), MOST_MOVING)} modes")
    elif picture is not None:
        from mbs.output.modes_plot import MOST_SHAPES, shapes_figure

        drawn = wanted[:MOST_SHAPES]
        at = RPM.text(result.model.scene.speed)
        lines += write_plot(shapes_figure(result.model, result.modes, bones, drawn, at), picture)
        if len(drawn) < len(wanted):
            lines.append(f"  {picture}: modes {', '.join(str(mode + 1) for mode in drawn)}; others by --shape-modes")
    return lines


def _highest(arguments: argparse.Namespace, scene: Scene | None, problems: Problems) -> float:
    """The highest frequency to show [Hz]."""
    text = getattr(arguments, "highest", None)
    highest = read_option("--highest", text, "Hz", (LOWEST_HIGHEST, HIGHEST_HIGHEST), HERTZ, problems)
    return max(scene.frequencies if scene else (), default=HIGHEST) if highest is None else highest


def _table(found: Modes, shown: IntArray) -> list[str]:
    """Lines of modes: frequency, damping ratio, and the parts that have most of the strain energy."""
    bands, law = found.bands, found.film_law
    wide = ("" if bands is None else "        +-") + ("" if law is None else "  film law")
    lines = [
        f"  mode   frequency/Hz{wide}   damping ratio{wide}   strain energy        (frequency: |eigenvalue|/(2 pi))"
    ]
    for k in shown:
        by = ["", ""]
        if bands is not None:
            own = float(found.frequency[k])
            relative = clean(bands.frequency[k] / own) if own > 0.0 else 0.0
            by = [f"{own * relative:10.2g}", f"{clean(bands.damping_ratio[k]):10.2g}"]
        if law is not None:
            by = [text + _part(part[k]) for text, part in zip(by, law, strict=True)]
        ratio = clean(found.damping_ratio[k])
        lines.append(f"  {k + 1:4d} {found.frequency[k]:14.6g}{by[0]} {ratio:15.4g}{by[1]}   {share_words(found, k)}")
    return lines


def _part(value: float) -> str:
    """Part that the film law leaves out, in its column; a dash where the first order says nothing."""
    return f"{value:+10.2g}" if math.isfinite(value) else f"{'-':>10s}"


def _overdamped(found: Modes, which: IntArray) -> list[str]:
    """Lines of motions that creep back: how long they take, and where the strain energy is."""
    if not which.size:
        return []
    lines = ["  overdamped (no oscillation): time to fall to 1/e"]
    for k in which:
        decay = -float(found.eigenvalues[k].real)
        time = MILLISECOND.text(1.0 / decay) if decay > 0.0 else "grows"
        lines.append(f"  {k + 1:4d} {time:>14}                   {share_words(found, k)}")
    return lines


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

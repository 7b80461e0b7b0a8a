"""`mbs identify`: clearance, preload, temperature, stiffness and damping of seats from what was measured."""

from __future__ import annotations

import argparse
import dataclasses
import math
from collections.abc import Callable
from pathlib import Path

from ehdmaps.errors import AnalysisError, InputError, Problems
from ehdmaps.extras import lacking
from ehdmaps.outputs import FIGURE, Output, output_problems, write_text
from ehdmaps.units import quantity
from mbs.analyses.modes import modes
from mbs.commands.cases import load_model
from mbs.commands.common import Told, chosen_workers, read_cage_angles, write
from mbs.commands.scenes.new import NEW
from mbs.identification.explained import MOST_CHI2
from mbs.identification.found import Identified
from mbs.identification.identify import identify, identify_plan, would_tell
from mbs.identification.measured import Measured, MeasuredModes
from mbs.identification.reading import Reading, read_measured
from mbs.linearised.pairs import partners
from mbs.output.band_text import bounds_text, value_text
from mbs.output.files import RESULT
from mbs.output.identified.text import apart_lines, found_lines, plan_lines
from mbs.output.model_text import heading
from mbs.scene.assembly import Model
from mbs.scene.reader import read_scene

MOST_SHOWN = 8
"""Modes of which bands stand side by side."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Find the unknowns, or plan what to measure."""
    model, measured, notes, angles = _asked(arguments)
    head = heading(model, model.scene.speed)
    if arguments.plan:
        unknowns, steps = identify_plan(model, arguments.free, _speeds(arguments), angles, _progress)
        return "\n".join([*head, *plan_lines(unknowns, steps)]), 0
    with chosen_workers(arguments) as workers:
        found = identify(model, measured, arguments.free, angles, progress=_progress, workers=workers)
    poor = found.fit.chi2 > MOST_CHI2
    lines = [*head, *(f"  {note}" for note in notes), *found_lines(found), *apart_lines(found, would_tell(found))]
    if poor:
        lines.append(
            f"warning: chi2 {found.fit.chi2:.3g}: the machine of the scene is not the one that was measured, or hits "
            "and sensors are elsewhere; no value above is a result"
        )
    if found.stopped:
        lines.append("warning: stopped; the best so far")
    lines += write(arguments, found.dataset, found.plot() if arguments.plot else None)
    status = 1 if poor or found.at_bounds else 0
    if arguments.scene_file and not poor:
        try:
            lines += _write_scene(arguments, model, found, measured)
        except (AnalysisError, InputError) as error:  # what was found is not lost by it
            lines += [f"warning: {problem}" for problem in str(error).splitlines()]
            status = 1
    return "\n".join(lines), 130 if found.stopped else status


def _progress(part: str) -> Callable[[int, int], None]:
    """Progress on stderr."""
    return Told(part)


def _asked(arguments: argparse.Namespace) -> tuple[Model, list[Measured], list[str], int]:
    """Model, measurements, what is to be said of these, and cage angles; all problems at once."""
    problems = Problems()
    model: Model | None = None
    with problems:
        model = load_model(arguments)
    angles = read_cage_angles(arguments, problems)
    files = arguments.measured or []
    if not files and not arguments.plan:
        problems.append('--measured: got none; allowed: such as --measured hits.uff "1500 rpm", or --plan without')
    if not arguments.free:
        problems.append("--free: got none; allowed: such as --free clearance --free temperature")
    outputs = [
        Output("-o", arguments.output, RESULT),
        Output("--plot", arguments.plot, FIGURE),
        Output("--scene", arguments.scene_file, NEW),
    ]
    problems += output_problems(outputs, [arguments.scene, *(one[0] for one in files)])
    if arguments.scene_file:
        problems += lacking("modal", "tomlkit", "--scene")
    reading = Reading()
    with problems:
        reading = _reading(arguments)
    measured: list[Measured] = []
    notes: list[str] = []
    for group in files if not arguments.plan else []:
        with problems:
            if len(group) > 2:
                raise InputError(f"--measured: got {' '.join(group)!r:.80}; allowed: a file and a speed")
            speed = quantity(group[1], "rad/s") if len(group) > 1 else None
            if model is not None:
                own, said = read_measured(Path(group[0]), speed, model.scene, reading)
                measured += own
                notes += said
    if problems or model is None:
        raise InputError(problems)
    return model, measured, notes, angles


def _reading(arguments: argparse.Namespace) -> Reading:
    """Choices of how files are read."""
    names = {}
    for text in arguments.channel or ():
        name, equals, own = text.partition("=")
        if not equals or not name or not own:
            raise InputError(f"--channel: got {text!r:.60}; allowed: NAME_IN_FILE=NAME_IN_SCENE")
        names[name] = own
    band = 0.0, math.inf
    if arguments.band:
        band = quantity(arguments.band[0], "Hz"), quantity(arguments.band[1], "Hz")
        if not 0.0 <= band[0] < band[1]:
            raise InputError(f"--band: got {' to '.join(arguments.band)!r:.60}; allowed: rising, from 0 Hz on")
    return Reading(names, arguments.averages, band)


def _speeds(arguments: argparse.Namespace) -> tuple[float, ...]:
    """Speeds that a plan may choose: those behind --measured, whose files need not be there."""
    return tuple(quantity(group[-1], "rad/s") for group in arguments.measured or ())


def _write_scene(arguments: argparse.Namespace, model: Model, found: Identified, measured: list[Measured]) -> list[str]:
    """Write the scene with what was found; bands of its modes before and after, side by side."""
    path = Path(arguments.scene_file)
    write_text(path, found.scene_text(read_scene(arguments.scene)), NEW)
    lines = [f"{path}: written"]
    if not model.scene.has_bearings:
        return lines
    highest = max(
        float((one.frequency if isinstance(one, MeasuredModes) else one.frequencies).max()) for one in measured
    )
    after = model.again(dataclasses.replace(read_scene(path), speed=model.scene.speed))
    both = [modes(one, highest=highest) for one in (model, after)]
    bands = [one.bands_to(highest) for one in both]
    partner = partners(both[0].balance.system, both[0].modes.shapes, both[1].balance.system, both[1].modes.shapes)
    lines.append("  bands of modes, 90 % of what is not known:  before               with what was found")
    for place, mode in enumerate(bands[0].chosen[:MOST_SHOWN].tolist()):
        other = bands[1].place(int(partner[mode]))
        words = (
            "-"
            if other is None
            else f"{value_text(bands[1].frequency, other)}: {bounds_text(bands[1].frequency, other)}"
        )
        own = f"{value_text(bands[0].frequency, place)}: {bounds_text(bands[0].frequency, place)}"
        lines.append(f"    {mode + 1:4d}  frequency, Hz   {own:>30s}   {words:>30s}")
    return lines

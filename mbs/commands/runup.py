"""`mbs runup`: integrate the nonlinear system in time over its speed profile, from its equilibrium."""

from __future__ import annotations

import argparse

import numpy as np
from matplotlib.figure import Figure

from ehdmaps.arrays import FloatArray
from ehdmaps.units import RPM
from mbs.analyses.reach import Fade, axes_outside, fade_of
from mbs.analyses.runup import runup
from mbs.commands.auto import Looked, analysed
from mbs.commands.cases import load_model
from mbs.commands.common import Told, film_course, heading, held_lines, write
from mbs.commands.reach import fade_lines, outside_lines
from mbs.output.energy_text import drive_lines, energy_lines
from mbs.output.run_plot import run_figure
from mbs.scene.assembly import Model
from mbs.transient.run import Recording


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Run, and say what was found."""
    done = analysed(arguments, load_model, lambda model: runup(model, progress=Told("step")), _looks_at)
    found = done.result
    model, result, outside = found.model, found.record, found.record.outside
    fade = fade_of(model)
    figure = _figure(model, result, fade) if arguments.plot else None
    first, last = (RPM.text(float(speed)) for speed in (result.speed[0], result.speed[-1]))
    lines = [
        *done.lines,
        *heading(model),
        *held_lines(model),
        f"from {first} to {last} in {found.course.duration:.4g} s: {result.steps} steps, {result.halved} taken back, "
        f"{result.iterations / max(result.steps, 1):.3g} Newton iterations a step, "
        f"{1e6 * found.seconds / max(result.steps, 1):.0f} us a step",
        *(f"note: {line}" for line in result.notes),
    ]
    for bearing, force in zip(model.bearings, result.forces, strict=False):
        size = np.hypot(force[:, 1], force[:, 2])
        lines.append(
            f"{bearing.name}: {size[0]:.5g} N at the beginning, {size.min():.5g} to {size.max():.5g} N, "
            f"{size[-1]:.5g} N at the end; largest change from sample to sample {_changes(size, result.speed, fade)}; "
            f"{outside[bearing.name]} calls outside the map"
        )
    lines += drive_lines(result.drive) + energy_lines(result.energy)
    lines += fade_lines(model, result.speed, "the run")
    fastest = float(np.abs(result.speed).max())
    lines += outside_lines(outside, "{} calls outside the map", axes_outside(model, fastest))
    # The equilibria of this line are no part of the run, whose calls were counted above.
    lines += film_course(model, (float(result.speed[0]), float(result.speed[-1])))
    lines += write(arguments, found.dataset, figure)
    return "\n".join(lines), 1 if any(outside.values()) else done.status


def _looks_at(model: Model) -> Looked:
    """What the run looks at; frequencies up to those of a Campbell diagram."""
    return Looked(model.scene, model.scene.campbell.highest)


def _changes(size: FloatArray, speed: FloatArray, fade: Fade | None) -> str:
    """Largest change of a force from sample to sample, inside and outside the fade below the map."""
    change = np.abs(np.diff(size))
    slow = np.zeros(speed.size, dtype=np.bool_) if fade is None else fade.below(speed)
    inside = slow[1:] | slow[:-1]
    if fade is None or not inside.any():
        return f"{change.max(initial=0.0):.3g} N"
    words = f"{change[inside].max():.3g} N below {RPM.text(fade.speed)}, where the film fades"
    if inside.all():
        return words
    worst = int(np.argmax(np.where(inside, -1.0, change)))
    return f"{words}, and {change[worst]:.3g} N above, at {RPM.text(float(abs(speed[worst])))}"


def _figure(model: Model, result: Recording, fade: Fade | None) -> Figure:
    """The figure, with the fade shaded."""
    if fade is None:
        return run_figure(model, result)
    words = (
        f"below {fade.source} (below {RPM.text(fade.speed)}, entrainment speed {fade.entrainment_speed:.4g} m/s): "
        "the film fades to the dry contact"
    )
    return run_figure(model, result, fade.speed, words)

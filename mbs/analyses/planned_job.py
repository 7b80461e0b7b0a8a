"""The job that covers what a scene needs of a contact map."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping

from ehdmaps.errors import InputError
from ehdmaps.jobs.job import Job, check_oil
from ehdmaps.jobs.job_text import Entry, bearing_keys, lubricant_keys, table_lines
from ehdmaps.jobs.problem import LOAD_AXIS, SPEED_AXIS, AxisRule
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.units import LOAD, SPEED, TEMPERATURE, Display, quantity
from mbs.analyses import planning
from mbs.analyses.planning import Needed
from mbs.scene.scene import Scene

LOADS_PER_DECADE, SPEEDS_PER_DECADE = 6, 5
"""As close as in the shipped jobs; contact laws choose lines of their own besides."""

FEWEST = 4
LAW_CHECK = 500


def planned_job(scene: Scene, needed: Needed, name: str = "plan", solver: Mapping[str, Entry] | None = None) -> Job:
    """The job that covers what the bearings of one geometry need, read back by the reader of jobs.

    Parameters
    ----------
    scene : Scene
        Scene with a lubricant.
    needed : Needed
        The ranges.
    name : str
        Name of the job.
    solver : mapping, optional
        Further keys of [solver].

    Raises
    ------
    InputError
        With everything that a job does not allow, or cannot say.
    """
    text = _job_text(scene, needed, solver)
    job = parse_job(text, name, f"the job for {', '.join(needed.bearings)}", to_run=True)
    check_oil(_lubricant(scene), job)
    return job


def _job_text(scene: Scene, needed: Needed, solver: Mapping[str, Entry] | None) -> str:
    """Text of the job that covers what the bearings of one geometry need; geometry, oil and temperature are theirs."""
    geometry = next(entry.geometry for entry in scene.bearings if entry.name == needed.bearings[0])
    lines = [
        f"# What {_plain(scene.name)} needs of a contact map, for {_plain(', '.join(needed.bearings))}.",
        f"# Largest load of a slice at rest {LOAD.text(needed.static_load)}; the highest load of the map is "
        f"{needed.load[1] / needed.static_load:.3g} times that.",
        "",
        "schema = 1",
        *table_lines("bearing", bearing_keys(geometry)),
        *table_lines("lubricant", lubricant_keys(_lubricant(scene))),
        "",
        "[grid]",
        f"load = {_axis(needed.load, LOAD, LOAD_AXIS, LOADS_PER_DECADE)}",
        f"entrainment_speed = {_axis(needed.entrainment_speed, SPEED, SPEED_AXIS, SPEEDS_PER_DECADE)}",
        f'temperature = ["{_temperature(scene.temperature)}"]',
        "",
        "[solver]",
        'name = "reynolds"',
        'structural_law = "iso16281"',
        f"law_check = {LAW_CHECK}",
        *(f"{key} = {json.dumps(value)}" for key, value in (solver or {}).items()),
        "",
    ]
    return "\n".join(lines)


def _lubricant(scene: Scene) -> Lubricant:
    """The oil of a scene."""
    if scene.lubricant is None:
        raise InputError(f"{scene.name}: got no [lubricant], which a map is made for; add the table to the scene")
    return scene.lubricant


def _temperature(value: float) -> str:
    """A temperature in degC, as people write it, where it reads back as the same value."""
    text = f"{TEMPERATURE.value(value):.10g} {TEMPERATURE.unit}"
    return text if quantity(text, "K") == value else f"{value!r} K"


def _axis(ends: tuple[float, float], display: Display, rule: AxisRule, per_decade: int) -> str:
    """An axis of a job that covers a range."""
    low, high = planning.outward(*(display.value(max(end, rule.low)) for end in ends))
    if low == high:
        return f'["{low:g} {display.unit}"]'
    points = max(FEWEST, math.ceil(per_decade * math.log10(high / low)) + 1)
    return f'{{ from = "{low:g} {display.unit}", to = "{high:g} {display.unit}", points = {points}, spacing = "log" }}'


def _plain(text: str) -> str:
    """A text that may stand in a comment."""
    return "".join(letter if letter.isprintable() else " " for letter in text)

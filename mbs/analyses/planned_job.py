"""The text of the job that covers what a scene needs of a contact map."""

from __future__ import annotations

import json
import math
import tomllib

from ehdmaps.jobs.axes import LOAD_AXIS, SPEED_AXIS, AxisRule
from ehdmaps.units import LOAD, SPEED, Display
from mbs.analyses import planning
from mbs.analyses.planning import Needed
from mbs.scene.scene import Scene

LOADS_PER_DECADE, SPEEDS_PER_DECADE = 6, 5
"""As close as in the shipped jobs; contact laws choose lines of their own besides."""

FEWEST = 4
LAW_CHECK = 500


def job_text(scene: Scene, needed: Needed) -> str:
    """Text of the job that covers what the bearings of one geometry need.

    Parameters
    ----------
    scene : Scene
        Scene with a lubricant; geometry, oil and temperature are copied from its text.
    needed : Needed
        The ranges.
    """
    values = tomllib.loads(scene.text)
    index = next(i for i, entry in enumerate(scene.bearings) if entry.name == needed.bearings[0])
    tables = {"bearing": values["bearings"][index]["geometry"], "lubricant": values["lubricant"]}
    lines = [
        f"# What {_plain(scene.name)} needs of a contact map, for {_plain(', '.join(needed.bearings))}.",
        f"# Largest load of a slice at rest {LOAD.text(needed.static_load)}; the highest load of the map is "
        f"{needed.load[1] / needed.static_load:.3g} times that.",
        "",
        "schema = 1",
    ]
    for name, table in tables.items():
        lines += ["", f"[{name}]", *(f"{key} = {_toml(value)}" for key, value in table.items())]
    return "\n".join(
        [
            *lines,
            "",
            "[grid]",
            f"load = {_axis(needed.load, LOAD, LOAD_AXIS, LOADS_PER_DECADE)}",
            f"entrainment_speed = {_axis(needed.entrainment_speed, SPEED, SPEED_AXIS, SPEEDS_PER_DECADE)}",
            f"temperature = [{_toml(values['operation']['temperature'])}]",
            "",
            "[solver]",
            'name = "reynolds"',
            'structural_law = "iso16281"',
            f"law_check = {LAW_CHECK}",
            "",
        ]
    )


def _axis(ends: tuple[float, float], display: Display, rule: AxisRule, per_decade: int) -> str:
    """An axis of a job that covers a range."""
    low, high = planning.outward(*(display.value(max(end, rule.low)) for end in ends))
    if low == high:
        return f'["{low:g} {display.unit}"]'
    points = max(FEWEST, math.ceil(per_decade * math.log10(high / low)) + 1)
    return f'{{ from = "{low:g} {display.unit}", to = "{high:g} {display.unit}", points = {points}, spacing = "log" }}'


def _toml(value: object) -> str:
    """A string, number or table of them in TOML."""
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {_toml(entry)}' for key, entry in value.items())} }}"
    if isinstance(value, str):
        # JSON escapes all that TOML wants escaped, but for this one.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return repr(value)


def _plain(text: str) -> str:
    """A text that may stand in a comment."""
    return "".join(letter if letter.isprintable() else " " for letter in text)

"""Commented scenes to begin an own machine with: a shaft on two bearings, or a shipped machine as it stands."""

from __future__ import annotations

import json
import os
import re
from importlib import resources
from itertools import accumulate, pairwise
from pathlib import Path
from string import Template

from ehdmaps.errors import InputError
from mbs.flexible.shaft_parts import Section
from mbs.scene.shafts.rows import csv_sections

MACHINES = {"drive": "electric_drive", "gearbox": "two_stage", "spindle": "spindle"}
"""Scenes that ship and need no other file, by what they are of."""

_ROWS = ((60, 50), (120, 60), (160, 55), (60, 50))
"""Length and diameter of the sections of a new shaft [mm]."""

_SMALLEST, _LARGEST = 20, 100
"""Bores of the bearings of series 2 that the catalogue has [mm]."""


def new_machine(what: str, target: Path) -> str:
    """Text of a shipped scene, whose commands name the new file.

    Parameters
    ----------
    what : str
        One of MACHINES.
    target : Path
        File for which the text is made.
    """
    text = (resources.files("mbs") / "systems" / f"{MACHINES[what]}.toml").read_text(encoding="utf-8")
    command = re.compile(rf"^(# +mbs \w+ ){MACHINES[what]}\b", re.MULTILINE)
    return command.sub(lambda found: f"{found[1]}{target.name}", text)


def new_shaft(target: Path, sections: Path | None = None) -> str:
    """Text of a new scene.

    Parameters
    ----------
    target : Path
        File for which the text is made; the path of the sections in it begins there.
    sections : Path, optional
        A file of sections; bearings sit in the middle of its first and last one. A shaft of four if left out.

    Raises
    ------
    InputError
        If the file is no table of sections.
    """
    if sections is None:
        rows = ",\n".join(f'    {{ length = "{length} mm", diameter = "{diameter} mm" }}' for length, diameter in _ROWS)
        ends = [0, *accumulate(length for length, _ in _ROWS)]
        shaft = [
            Section(1e-3 * begin, 1e-3 * end, 1e-3 * diameter)
            for (begin, end), (_, diameter) in zip(pairwise(ends), _ROWS, strict=True)
        ]
        words = f"sections = [                            # one after the other; a hollow one has a bore\n{rows},\n]"
    else:
        shaft = csv_sections(sections)
        words = f"sections = {_quoted(os.path.relpath(sections, target.parent))}"
    return _filled(target, shaft, words)


def _filled(target: Path, shaft: list[Section], sections: str) -> str:
    """The text, with bearings and a wheel where the shaft has room for them."""
    total = shaft[-1].end
    places = [0.5 * (shaft[k].begin + shaft[k].end) for k in (0, -1)] if shaft[1:] else [0.1 * total, 0.9 * total]
    middle = 0.5 * total
    seat = next(part.diameter for part in shaft if part.end >= middle)
    template = Template((resources.files("mbs.scene.shafts") / "new.toml").read_text(encoding="utf-8"))
    return template.substitute(
        file=target.name,
        title=_quoted(f"{target.stem}: shaft on two bearings"),
        sections=sections,
        left=_millimetres(places[0]),
        right=_millimetres(places[1]),
        left_bearing=_designation(shaft[0].diameter),
        right_bearing=_designation(shaft[-1].diameter),
        wheel=_millimetres(middle),
        wheel_diameter=_millimetres(4.0 * seat),
        wheel_width=_millimetres(0.5 * seat),
        wheel_bore=_millimetres(seat),
    )


def _designation(diameter: float) -> str:
    """Bearing of series 2 whose bore comes next to the diameter of its seat [m]."""
    bore = min(max(5 * round(200.0 * diameter), _SMALLEST), _LARGEST)
    return f"NU2{bore // 5:02d}"


def _millimetres(value: float) -> str:
    """Length as a scene has it [m]."""
    return f"{1e3 * value:.6g} mm"


def _quoted(text: str) -> str:
    """Text as a string of TOML."""
    if not text.isprintable():
        raise InputError(f"got the name {text!r:.200}; allowed: printable characters; rename the file")
    return json.dumps(text, ensure_ascii=False)

"""`mbs new`: a commented scene to begin an own machine with; nothing that is there is overwritten."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.errors import InputError, Problems
from ehdmaps.outputs import Kind, Output, output_problems, write_text
from mbs.scene.shafts.new import MACHINES, new_machine, new_shaft

NEW = Kind("a file that may be replaced", (".toml",), lambda path: False)
"""Scenes that people go on with: none is ever replaced."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Write the scene."""
    target = Path(arguments.output or f"{arguments.what}.toml")
    sections = None if arguments.csv is None else Path(arguments.csv)
    problems, text = Problems(), ""
    with problems.after("--csv: "):
        if arguments.what not in MACHINES:
            text = new_shaft(target, sections)
        elif sections is None:
            text = new_machine(arguments.what, target)
        else:
            raise InputError(
                f"got it beside {arguments.what}; allowed: `mbs new shaft --csv {sections}`, or, in a [[shafts]] of "
                f'the {arguments.what}, sections = "{sections}"'
            )
    problems += output_problems([Output("-o", target, NEW)], [] if sections is None else [sections])
    problems.check()
    write_text(target, text, NEW)
    return f"{target}: written; change its numbers, then: mbs check {target}", 0

"""`mbs new`: a commented scene to begin an own machine with; nothing that is there is overwritten."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.outputs import Kind, Output, output_problems, write_text
from mbs.scene.shafts.new import MACHINES, new_machine, new_shaft

NEW = Kind("a file that may be replaced", (".toml",), lambda path: False)
"""Scenes that people go on with: none is ever replaced."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Write the scene."""
    target = Path(arguments.output or f"{arguments.what}.toml")
    sections = None if arguments.csv is None else Path(arguments.csv)
    problems, text = [], ""
    try:
        if arguments.what in MACHINES:
            if sections is not None:
                problems.append(
                    f"--csv: got it beside {arguments.what}; allowed: `mbs new shaft --csv {sections}`, or, in a "
                    f'[[shafts]] of the {arguments.what}, sections = "{sections}"'
                )
            text = new_machine(arguments.what, target)
        else:
            text = new_shaft(target, sections)
    except InputError as error:
        problems += [f"--csv: {problem}" for problem in error.problems]
    problems += output_problems([Output("-o", target, NEW)], [] if sections is None else [sections])
    if problems:
        raise InputError(problems)
    write_text(target, text, NEW)
    return f"{target}: written; change its numbers, then: mbs check {target}", 0

"""`mbs import`: a scene of a rotor that another program saved; nothing that is there is overwritten."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.errors import Problems, problems_after
from ehdmaps.outputs import Output, output_problems, write_text
from mbs.commands.scenes.new import NEW
from mbs.imports.ross_file import read_ross
from mbs.imports.ross_scene import ross_scene, summary
from mbs.scene.assembly import assemble
from mbs.scene.reader import parse_scene


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Read the rotor, write the scene, and make sure that it stands."""
    source = Path(arguments.rotor)
    target = Path(arguments.output or f"{source.stem}_scene.toml")
    problems, text, words = Problems(), "", ""
    with problems:
        rotor = read_ross(source)
        with problems_after(f"{source}: "):
            text, words = ross_scene(rotor, target.name, source.stem), summary(rotor)
            assemble(parse_scene(text, target.stem, "as a scene"))
    problems += output_problems([Output("-o", target, NEW)], [source])
    problems.check()
    write_text(target, text, NEW)
    return f"{target}: written, of {words}; then: mbs check {target}", 0

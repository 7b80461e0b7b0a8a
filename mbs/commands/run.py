"""`mbs run`: every analysis for which the scene has a table, with films that `--auto` may choose.

Results, figures and texts of all of them are written into one folder.
"""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path

from ehdmaps.choices import texts_of
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.outputs import Kind, Output, check_outputs, write_text
from mbs.analyses.campbell import campbell_problems
from mbs.scene.choices import OPTIONS
from mbs.scene.reader import read_scene
from mbs.scene.scene import Scene

_TOLD_ONCE = ("auto: ", "note: ")

MARK = "mbs run"
TEXT = Kind("a text of mbs run", (".txt",), lambda path: path.read_bytes().startswith(MARK.encode()))
"""Texts that are replaced only if they were written by this command."""


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Do all of them; what has no result does not stop the others."""
    scene = read_scene(arguments.scene)
    folder = _folder(arguments.output or f"{Path(arguments.scene).stem}_results")
    planned = {name: arguments.parse(_words(arguments, scene, name, folder)) for name in _analyses(scene)}
    lines, status = [f"{scene.title}: {', '.join(planned)}"], 0
    refused, told = 0, set[str]()
    for name, one in planned.items():
        try:
            text, found = importlib.import_module(f"mbs.commands.{name}").run(one)
        except (InputError, AnalysisError) as error:
            refused += isinstance(error, InputError)
            if refused == len(planned):
                raise
            text, found = "\n".join(f"warning: no result: {line}" for line in str(error).splitlines()), 1
        status = max(status, found)
        # The same plan, the same verdicts and the same note on films are told once.
        shown = [line for line in text.splitlines() if line not in told or not line.startswith(_TOLD_ONCE)]
        told.update(text.splitlines())
        lines += ["", f"=== mbs {name} {arguments.scene}", *shown]
        path = folder / f"{name}.txt"
        write_text(path, f"{MARK} {arguments.scene}: {name}\n{text}\n", TEXT)
        lines.append(f"{path}: written")
    return "\n".join(lines), status


def _analyses(scene: Scene) -> list[str]:
    """The analyses for which a scene has what they need, in the order in which a machine is examined."""
    found = ["statics", "modes"]
    if scene.frequencies and scene.inputs and scene.sensors:
        found.append("lsa")
    if scene.sweep is not None:
        found.append("sweep")
        if any(body.spin for body in scene.bodies):
            found.append("critical")
    if scene.run_up is not None:
        found.append("runup" if campbell_problems(scene, scene.campbell) else "campbell")
    return found


def _folder(given: str) -> Path:
    """The folder of the results, which is made where it is not there."""
    folder = Path(given)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"-o: got {given!r:.200}; allowed: a folder ({error.strerror or error})") from error
    return folder


def _words(arguments: argparse.Namespace, scene: Scene, name: str, folder: Path) -> list[str]:
    """The command line of one analysis."""
    words = [name, arguments.scene]
    for choice in OPTIONS:
        for text in texts_of(arguments, choice):
            words += [f"--{choice.name}", text]
    if arguments.auto_tolerance is not None:
        words += ["--auto-tolerance", arguments.auto_tolerance]
    if arguments.auto:
        words.append("--auto")
    if arguments.bands is not None and name not in ("campbell", "runup"):
        words += ["--bands", arguments.bands]
    check_outputs([Output("-o", folder / f"{name}.txt", TEXT)])
    # The figure of statics is one of rollers.
    figure = ["--plot", str(folder / f"{name}.png")] if name != "statics" or scene.bearings else []
    return [*words, "-o", str(folder / f"{name}.nc"), *figure]

"""`--auto` of a command: its options, the physics that a scene requires, the analysis with it, lines that say so."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar

from ehdmaps.choices import PHYSICS, SHEAR, texts_of
from ehdmaps.errors import InputError
from ehdmaps.jobs.make.batch_generate import folder_problem, make_folder
from ehdmaps.jobs.make.status import progress
from ehdmaps.jobs.make.store import store_path
from ehdmaps.program import tell
from ehdmaps.units import LOAD, SPEED, TEMPERATURE
from mbs.commands.common import Done, Looked
from mbs.planning.auto import MOST_TOLERANCE, Automatic, AutoSettings, MadeMap, settled
from mbs.planning.plan import no_lubricant
from mbs.planning.ranges import MARGIN
from mbs.planning.verdicts import TOLERANCE, Verdict, up_to
from mbs.scene.choices import CHOICES, OPTIONS, Subject, named_law
from mbs.scene.map_set import TABLE_LAW
from mbs.scene.reader import read_scene
from mbs.scene.scene import Scene

A = TypeVar("A")
R = TypeVar("R")

_CONTRARY = ("map", "structural_law")
"""Options that stand for a map that is there."""

_STATED = ("films", "film memory", "oil supply")
"""Physics of films that a command has, or has as the scene states it, unless `--auto` finds that it does not matter."""

_OF_FILMS = tuple(choice for choice in OPTIONS if choice.concerned in ("films", "relaxing"))
"""Choices that a law without films does not take."""


def with_own_maps(
    arguments: argparse.Namespace,
    ask: Callable[[argparse.Namespace], A],
    analyse: Callable[[A], R],
    looks_at: Callable[[A], Looked],
) -> Done[R]:
    """The analysis of a command with the physics that is chosen for it.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    ask, analyse, looks_at : callable
        See `mbs.commands.auto.analysed`.

    Raises
    ------
    InputError
        With every problem of the arguments; before a map is made.
    """
    scene, looked, settings = _asked(arguments, ask, looks_at)

    def of_subject(subject: Subject) -> R:
        return analyse(ask(_with(arguments, subject)))

    try:
        found = settled(scene, of_subject, settings, progress, looked.scene)
    except KeyboardInterrupt:
        stores = ", ".join(str(path) for path in sorted(settings.folder.glob(f"{store_path(Path('*.nc'))}")))
        if stores:
            tell(f"\nstopped; what is solved of a map is kept ({stores}): the same command goes on from there")
        raise
    warned = any(one.unmet for one in found.made) or any(verdict.warns for verdict in found.verdicts)
    return Done(found.result, (*_lines(found),), 1 if warned else 0)


def read_tolerance(arguments: argparse.Namespace, problems: list[str]) -> float:
    """Read --auto-tolerance: a part of a stiffness or damping, such as "5 %", or of a level, such as "1 dB".

    A run-up that has a --tolerance of its levels alone has that.

    A level at a resonance goes with 1/c, one held by stiffness with 1/k, so that a decibel is a change of k or c by
    12 %.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of a command.
    problems : list of str
        Appended to.
    """
    own, of_levels = (getattr(arguments, key, None) for key in ("auto_tolerance", "tolerance"))
    option, text = ("--tolerance", of_levels) if own is None else ("--auto-tolerance", own)
    if text is None:
        return TOLERANCE
    number, _, unit = text.strip().partition(" ")
    try:
        value = float(number)
        part = {"%": value / 100.0, "dB": math.pow(10.0, value / 20.0) - 1.0}[unit.strip()]
    except (KeyError, ValueError, OverflowError):
        part = math.nan
    if not 0.0 < part <= MOST_TOLERANCE * (1.0 + 1e-9):
        problems.append(f"{option}: got {text!r:.40}; allowed: above 0 up to 900 % or 20 dB, such as '5 %' or '1 dB'")
        return TOLERANCE
    return min(part, MOST_TOLERANCE)


def _asked(
    arguments: argparse.Namespace, ask: Callable[[argparse.Namespace], A], looks_at: Callable[[A], Looked]
) -> tuple[Scene, Looked, AutoSettings]:
    """Scene, what is looked at, and settings; all problems at once, before anything is made."""
    problems = [
        f"--{option.replace('_', '-')}: stands beside --auto, which has films of its own; leave one of them out"
        for option in _CONTRARY
        if getattr(arguments, option, None)
    ]
    tolerance = read_tolerance(arguments, problems)
    problems += [
        f"--{name}: got {len(texts)} of them; allowed with --auto: one, as each has a plan"
        for name in ("clearance", "temperature", "roughness")
        if len(texts := texts_of(arguments, CHOICES[name])) > 1
    ]
    folder = Path(getattr(arguments, "maps", None) or ".")
    if problem := folder_problem(folder, "--maps"):
        problems.append(problem)
    looked, scene = None, None
    try:
        scene = _with_surface(read_scene(arguments.scene), arguments)
        if scene.lubricant is None:
            problems.append(f"{scene.name}: {no_lubricant(scene)}; add the table to the scene")
        else:
            looked = looks_at(ask(_stand_in(arguments, scene)))
    except InputError as error:
        problems += error.problems
    for choice in (*_OF_FILMS, PHYSICS, SHEAR):
        choice.values(texts_of(arguments, choice), problems)
    if problems or scene is None or looked is None:
        raise InputError(tuple(dict.fromkeys(problems)))
    make_folder(folder, "--maps")
    return scene, looked, _settings(arguments, tolerance, folder, looked.highest)


def _with_surface(scene: Scene, arguments: argparse.Namespace) -> Scene:
    """The scene with the roughness that was asked for: what it requires depends on it."""
    rough = CHOICES["roughness"]
    for surface in rough.values(texts_of(arguments, rough), [])[:1]:
        scene = rough.change(Subject(scene, named_law("hertz", scene)), surface).scene
    return scene


def _stand_in(arguments: argparse.Namespace, scene: Scene) -> argparse.Namespace:
    """The arguments with a law that is made in a moment in place of the map, to see what is wrong about the others."""
    needs_films = any(entry.centrifugal and not entry.rollers_as_bodies for entry in scene.bearings)
    law = "formula" if needs_films else "hertz"
    without = {choice.key: None for choice in _OF_FILMS if hasattr(arguments, choice.key)}
    there = _with(arguments, Subject(scene, named_law(law, scene)))
    return argparse.Namespace(**{**vars(there), **without})


def _settings(arguments: argparse.Namespace, tolerance: float, folder: Path, highest: float) -> AutoSettings:
    """The settings; films and supply that were asked for are taken where one is."""

    def first(name: str) -> Any:
        choice = CHOICES[name]
        return next(iter(choice.values(texts_of(arguments, choice), [])), None)

    films = first("films")
    return AutoSettings(
        tolerance=tolerance,
        highest=highest,
        folder=folder,
        clearance=first("clearance"),
        films=films,
        supply=first("supply"),
        physics=getattr(arguments, "physics", None),
        shear=getattr(arguments, "shear", None),
    )


def _with(arguments: argparse.Namespace, subject: Subject) -> argparse.Namespace:
    """The arguments with a scene and a law in place of those that are to be read."""
    return argparse.Namespace(**{**vars(arguments), "subject": subject})


def _lines(found: Automatic[Any]) -> list[str]:
    """Lines on what was made, what is on, and what is not met."""
    maps = found.subject.law.maps
    read = found.subject.law.name == TABLE_LAW if maps is None else any(emap.from_table for emap in maps.maps)
    lines = [*(["auto: films from the film table"] if read else []), *map(_map_line, found.made)]
    lines += [f"{'warning: ' if verdict.warns else ''}auto: {verdict.line}" for verdict in found.verdicts]
    lines.append(_without(found))
    return lines + [f"warning: auto: {one.path}: {line}" for one in found.made for line in one.unmet]


def _map_line(made: MadeMap) -> str:
    """A line on a map: where it is, what it covers."""
    data = made.emap.dataset
    load, speed, kelvin = (data[name].values for name in ("load", "entrainment_speed", "temperature"))
    sweep = made.sweep
    counts = (
        "made before, covers this" if sweep is None else f"{sweep.solved} points solved, {sweep.taken_over} taken over"
    )
    margin = "" if sweep is None else f" ({MARGIN:g} times the largest load at rest)"
    return (
        f"auto: {made.path}: {counts}; {LOAD.value(load[0]):.3g} to {LOAD.text(load[-1])}{margin}, "
        f"{SPEED.value(speed[0]):.3g} to {SPEED.text(speed[-1])}, {TEMPERATURE.text(kelvin[0])}"
    )


def _without(found: Automatic[Any]) -> str:
    """A line on what the same command gives without `--auto`."""

    def named(verdicts: Iterable[Verdict]) -> str:
        return ", ".join(dict.fromkeys(f"{verdict.physics} ({up_to(verdict.size)})" for verdict in verdicts))

    judged = [verdict for verdict in found.verdicts if not math.isnan(verdict.size) and not verdict.asked]
    only = named(verdict for verdict in judged if verdict.on and verdict.solver)
    more = named(verdict for verdict in judged if verdict.on is False and verdict.physics in _STATED)
    parts = [*([f"leaves out {only}"] if only else []), *([f"has {more}"] if more else [])]
    return f"auto: the same command without --auto {' and '.join(parts) or 'has the same physics'}"

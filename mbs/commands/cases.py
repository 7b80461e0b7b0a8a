"""Cases that a command compares: what is chosen of a scene (`mbs.scene.choices`), in every combination.

Each law of --law and each map of --map counts as one law; maps for different types of bearing make one law together
(`mbs.scene.map_set`). Each other option of `OPTIONS` may be given more than once, too.
"""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ehdmaps.choices import SUPPLY, texts_of
from ehdmaps.errors import InputError, Problems
from ehdmaps.outputs import FIGURE, Kind, Output, output_problems
from mbs.analyses.case import Case, common_clearance
from mbs.output.files import RESULT
from mbs.scene.assembly import Model
from mbs.scene.choices import CHOICES, LACKS, LAWS, LOCATED_LACK, OPTIONS, SceneChoice
from mbs.scene.contact_laws import NO_LAW, ContactLaws, law_in_force, table_path
from mbs.scene.reader import read_scene
from mbs.scene.scene import Scene
from mbs.scene.subject import LawChoice, Subject, named_law, opened_maps
from mbs.settings import SweepRange

MOST_CASES = 24

_COMPARING = "lsa, sweep, critical, runup, campbell and hammer compare more"

Needs = Callable[[Scene], Iterable[str]]
"""Tells what a scene lacks for an analysis."""


def load_model(arguments: argparse.Namespace) -> Model:
    """Read scene, law or map, and clearance of a command that takes one of each; all problems at once.

    Parameters
    ----------
    arguments : argparse.Namespace
        The same as for `load_cases`.

    Raises
    ------
    InputError
        With every problem.
    """
    return load_cases(arguments, several=False)[0].model


def load_cases(
    arguments: argparse.Namespace,
    several: bool = True,
    kind: Kind = RESULT,
    *,
    needs: Needs | None = None,
    speeds: SweepRange | None = None,
    most: int = MOST_CASES,
) -> list[Case]:
    """Read scene, laws, maps, clearances and load factors into models; all problems at once.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments with `scene`, `output`, `plot`, and the keys of `mbs.scene.choices.OPTIONS`: each a text, a list of
        texts, None, or left out.
    several : bool
        Whether laws and maps stand side by side; else a law goes before a map.
    kind : Kind
        Kind of file that -o writes.
    needs : callable, optional
        What a scene lacks for the analysis, by sentences; it is said before laws are made, which takes time.
    speeds : SweepRange, optional
        Speeds that are looked at instead of [sweep] of the scene.
    most : int
        How many models stand side by side at most, such as those that can be told apart in a figure.

    Raises
    ------
    InputError
        With every problem.
    """
    problems = Problems()
    scene = _read_scene(arguments, problems)
    if not several:
        problems += _one_each(arguments)
    found = _combined(arguments, scene, problems, several)
    problems += _output_problems(arguments, scene, kind)
    if len(found) > most:
        options = ", ".join(f"--{choice.name}" for choice in OPTIONS if texts_of(arguments, choice))
        problems.append(f"{options}: got {len(found)} combinations; allowed: up to {most} side by side")
    lacking = list(needs(scene)) if scene is not None and needs is not None else []
    problems += lacking
    if scene is None or len(found) > most or lacking:
        raise InputError(problems)
    laws = {one.subject.law.label for one in found}
    cases = []
    for one in found:
        subject = one.subject
        if speeds is not None:
            subject = dataclasses.replace(subject, scene=dataclasses.replace(subject.scene, sweep=speeds))
        try:
            model = subject.model()
        except InputError as error:
            problems += scene_problems(scene, error)
            continue
        words = [*([subject.law.label] if len(laws) > 1 or not one.words else []), *one.words]
        factor, angle = one.values.get("load-factor", 1.0), one.values.get("start-angle")
        cases.append(Case(", ".join(words), model, common_clearance(model), factor, angle, subject))
    problems.check()
    return cases


def read_compared(
    arguments: argparse.Namespace, problems: Problems, kind: Kind = RESULT
) -> tuple[Scene | None, list[LawChoice], float | None]:
    """Read the scene with what is chosen of it, its laws, and one clearance; the command builds its models itself.

    Parameters
    ----------
    arguments : argparse.Namespace
        The same as for `load_cases`.
    problems : Problems
        What is wrong is appended.
    kind : Kind
        Kind of file that -o writes.
    """
    scene = _read_scene(arguments, problems)
    of_laws = (*LAWS, "structural-law", "films", "supply")
    problems += [
        f"--{choice.name}: got {len(texts)} of them; allowed: one, and others by --vary {choice.name}"
        for choice in OPTIONS
        if choice.name not in of_laws and len(texts := texts_of(arguments, choice)) > 1
    ]
    found = _combined(arguments, scene, problems)
    problems += _output_problems(arguments, scene, kind)
    if not found:
        return scene, [], None
    first = found[0].subject
    return first.scene, [one.subject.law for one in found], first.clearance


def read_dry(arguments: argparse.Namespace, problems: Problems) -> tuple[Scene | None, float | None]:
    """Read the scene with what is chosen of it beside its law, once each, and the clearance.

    Parameters
    ----------
    arguments : argparse.Namespace
        The same as for `load_cases`.
    problems : Problems
        What is wrong is appended.
    """
    scene = _read_scene(arguments, problems)
    problems += _one_each(arguments)
    values = _values(arguments, problems)
    if scene is None:
        return None, None
    subject = combinations([Subject(scene, named_law("hertz", scene))], values, problems)[0].subject
    return subject.scene, subject.clearance


def _one_each(arguments: argparse.Namespace) -> list[str]:
    """List problems with options that a command takes once."""
    problems = [
        f"--{choice.name}: got {len(texts)} of them; allowed: one; {_COMPARING}"
        for choice in OPTIONS
        if choice.name != "map" and len(texts := texts_of(arguments, choice)) > 1
    ]
    return problems


def _combined(
    arguments: argparse.Namespace, scene: Scene | None, problems: Problems, several: bool = True
) -> list[Combination]:
    """Everything that was chosen, in every combination; nothing where the scene could not be read.

    Where laws do not stand side by side, a law goes before a map.
    """
    values = _values(arguments, problems)
    if scene is None:
        return []
    laws = _laws(arguments, scene, values, problems)
    if not several:
        if sum(law.maps is not None for law in laws) > 1:
            problems.append(
                f"--map: got {len(values['map'])} of them, several for one type of bearing; allowed: one for each type "
                f"of bearing; {_COMPARING}"
            )
        laws = laws[:1] if values["law"] else laws
    return combinations([Subject(scene, law) for law in laws], values, problems)


def _values(arguments: argparse.Namespace, problems: Problems) -> dict[str, list[Any]]:
    """Values that are given for the choices, by their names."""
    speed = CHOICES["speed"]
    # Commands that look at several speeds have an option of the same name, FROM TO POINTS.
    one_speed = isinstance(getattr(arguments, speed.key, None), str)
    taken = (*OPTIONS, speed) if one_speed else OPTIONS
    return {choice.name: choice.values(texts_of(arguments, choice), problems) for choice in taken}


def _laws(
    arguments: argparse.Namespace, scene: Scene, values: dict[str, list[Any]], problems: Problems
) -> list[LawChoice]:
    """The laws that are meant: those named, and each set of maps; without either films from the film table."""
    names, paths, laws = values["law"], values["map"], list[LawChoice]()
    for name in names:
        if name == "map" and paths:
            continue
        with problems:
            laws.append(named_law(name, scene))
    if paths:
        laws += opened_maps(paths, scene, problems)
    if not (laws or names or paths):
        with problems:
            laws.append(named_law(None, scene))
    return laws


def _read_scene(arguments: argparse.Namespace, problems: Problems) -> Scene | None:
    """Read the scene; None where problems were noted."""
    with problems:
        return read_scene(arguments.scene)
    return None


def files_read(arguments: argparse.Namespace, scene: Scene | None) -> list[str | Path]:
    """All files that a command reads, over which it must not write: scene, maps, tables of laws, and what they name.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    scene : Scene or None
        The scene that was read.
    """
    tables = [path for law in texts_of(arguments, CHOICES["law"]) if (path := table_path(law)) is not None]
    maps = texts_of(arguments, CHOICES["map"])
    return [arguments.scene, *maps, *tables, *(scene.files if scene else ())]


def _output_problems(arguments: argparse.Namespace, scene: Scene | None, kind: Kind) -> list[str]:
    """List problems with the files that are written."""
    read = files_read(arguments, scene)
    problems = scene_output_problems(arguments.scene, read, arguments.output, arguments.plot, kind)
    waterfall = getattr(arguments, "waterfall", None)
    outputs = [Output("--plot", arguments.plot, FIGURE), Output("--waterfall", waterfall, FIGURE)]
    return problems + (output_problems(outputs, read) if waterfall else [])


def scene_problems(scene: Scene, error: InputError) -> list[str]:
    """List problems with a scene, under its name; problems of an option say that themselves."""
    return [problem if problem.startswith("--") else f"{scene.name}: {problem}" for problem in error.problems]


def scene_output_problems(
    scene: str,
    read: Iterable[str | Path] = (),
    output: str | None = None,
    plot: str | None = None,
    kind: Kind = RESULT,
) -> list[str]:
    """List problems with -o and --plot: said before anything is computed, so that no result is lost by it.

    Parameters
    ----------
    scene : str
        Scene as it was given: a shipped system or a file.
    read : iterable of str or Path
        Further files that the command reads: maps, and those that the scene names.
    output, plot : str, optional
        What -o and --plot name.
    kind : Kind
        Kind of file that -o writes.
    """
    return output_problems([Output("-o", output, kind), Output("--plot", plot, FIGURE)], [scene, *read])


@dataclass(frozen=True, eq=False)
class Combination:
    """A subject that was chosen, among others.

    Attributes
    ----------
    subject : Subject
        Scene and law; the label of the law tells it from the other laws.
    words : tuple of str
        What tells it from others of the same law.
    values : mapping of str to object
        What was chosen of the scene, by the names of the choices.
    """

    subject: Subject
    words: tuple[str, ...] = ()
    values: Mapping[str, Any] = field(default_factory=dict)


def combinations(
    subjects: Sequence[Subject], values: Mapping[str, Sequence[Any]], problems: Problems
) -> list[Combination]:
    """Combine subjects with all values that were chosen; a law that a choice does not concern stands once.

    Parameters
    ----------
    subjects : sequence of Subject
        Scene with each of the laws.
    values : mapping of str to sequence
        Values of the other choices, by their names; left out: nothing was chosen.
    problems : Problems
        What is wrong is appended.
    """
    found = [Combination(subject if subjects[1:] else _with_label(subject)) for subject in subjects]
    for choice in CHOICES.values() if found else ():  # why there is no law is said already
        several = values.get(choice.name, ()) if choice.name not in LAWS else ()
        if choice.name == SUPPLY.name and not several:
            found = [dataclasses.replace(one, subject=_with_stated_supply(one.subject)) for one in found]
        if not several:
            continue
        if choice.concerned in LACKS and not any(choice.concerns(one.subject) for one in found):
            got, scene = ", ".join(map(choice.text, several)), found[0].subject.scene
            of_others = not scene.bearings and scene.located and choice.concerned not in ("relaxing", "heat")
            lacks = LOCATED_LACK if of_others else LACKS[choice.concerned]
            problems.append(f"--{choice.name}: got {got} {lacks}")
            continue
        found = [entry for one in found for entry in _each(one, choice, several, problems)]
    return found


def _with_label(subject: Subject) -> Subject:
    """A subject whose law is not called dry where the scene has no roller bearing; several laws keep their names."""
    if subject.scene.has_bearings or subject.law.has_films:
        return subject
    return dataclasses.replace(subject, law=dataclasses.replace(subject.law, label=NO_LAW))


def _each(one: Combination, choice: SceneChoice, several: Sequence[Any], problems: Problems) -> list[Combination]:
    """A combination with each value of a choice."""
    if len(several) > 1 and not choice.concerns(one.subject):
        return [one]
    found = []
    for value in several:
        subject: Subject | None = None
        with problems.after(f"--{choice.name}: "):
            subject = choice.chosen(one.subject, value)
        if subject is None:
            continue
        words = choice.words(value)
        if subject.law is one.subject.law:
            told = (words,) if len(several) > 1 else ()
            found.append(Combination(subject, (*one.words, *told), {**one.values, choice.name: value}))
            continue
        if words and subject.law.may_relax and (len(several) > 1 or not choice.usual(value)):
            law = dataclasses.replace(subject.law, label=f"{subject.law.label}, {words}")
            subject = dataclasses.replace(subject, law=law)
        found.append(Combination(subject, one.words, one.values))
    return found


def _with_stated_supply(subject: Subject) -> Subject:
    """A subject whose law is called by the oil supply that scene or map state."""
    law = subject.law
    words = ContactLaws(law_in_force(law.name, law.maps, subject.scene)[0], subject.scene, law.maps).supply_label
    return dataclasses.replace(subject, law=dataclasses.replace(law, label=law.label + words)) if words else subject

"""Cases that a command compares: contact laws and maps, clearances, load factors, in every combination.

Each law of --law and each map of --map counts as one law; maps for different types of bearing make one law together
(`mbs.scene.map_set`); of laws with films, each kind of --films and each oil supply
of --supply. The clearances of --clearance, the factors of --load-factor and the angles of --start-angle may each be
given more than once, too.
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from ehdmaps.errors import EhdmapsError, InputError
from ehdmaps.jobs.show.opening import open_given
from ehdmaps.outputs import FIGURE, Kind, Output, output_problems
from ehdmaps.units import closest
from mbs.analyses.case import Case, LawChoice, Subject, common_clearance
from mbs.commands.options import NO_MAP, read_clearance, read_supplies, read_varied, varied_key
from mbs.model.relaxation import DEFAULT_FILMS, Films
from mbs.output.files import RESULT
from mbs.scene.assembly import Model
from mbs.scene.contact_laws import FILM_WORDS, TABLE_LAW, ContactLaws, choose_law, law_label, table_path
from mbs.scene.fields import DEGREE, MICROMETRE
from mbs.scene.map_set import MapSet, map_sets
from mbs.scene.reader import read_scene
from mbs.scene.scene import Scene
from mbs.settings import SweepRange

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap

FILMS = ("memory", "slow", "dry")
"""What --films takes: films that relax, those of slow motion, and none."""

MOST_CASES = 24

Needs = Callable[[Scene], Iterable[str]]
"""Tells what a scene lacks for an analysis."""


def load_model(arguments: argparse.Namespace, kind: Kind = RESULT, needs: Needs | None = None) -> Model:
    """Read scene, law or map, and clearance of a command that takes one of each; all problems at once.

    Parameters
    ----------
    arguments : argparse.Namespace
        The same as for `load_cases`.
    kind : Kind
        Kind of file that -o writes.
    needs : callable, optional
        The same as for `load_cases`.

    Raises
    ------
    InputError
        With every problem.
    """
    return load_cases(arguments, several=False, kind=kind, needs=needs)[0].model


def load_cases(
    arguments: argparse.Namespace,
    several: bool = True,
    kind: Kind = RESULT,
    *,
    needs: Needs | None = None,
    speeds: SweepRange | None = None,
) -> list[Case]:
    """Read scene, laws, maps, clearances and load factors into models; all problems at once.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments with `scene`, `output`, `plot`, and `law`, `map`, `structure`, `films`, `supply`, `clearance`,
        `load_factor`, `start_angle`: each a text, a list of texts (but for `structure`), None, or left out.
    several : bool
        Whether laws and maps stand side by side; else a law goes before a map.
    kind : Kind
        Kind of file that -o writes.
    needs : callable, optional
        What a scene lacks for the analysis, by sentences; it is said before laws are made, which takes time.
    speeds : SweepRange, optional
        Speeds that are looked at instead of [sweep] of the scene.

    Raises
    ------
    InputError
        With every problem.
    """
    problems: list[str] = []
    scene = _read_scene(arguments, problems)
    laws = _named_laws(arguments, scene, problems)
    if not several:
        problems += [
            f"--{option}: got {len(given)} of them; allowed: one; lsa, sweep, critical, runup, campbell and hammer "
            "compare more"
            for option in ("law", "clearance", "films", "supply")
            if len(given := _given(arguments, option)) > 1
        ]
        if sum(law.maps is not None for law in laws) > 1:
            problems.append(
                f"--map: got {len(_given(arguments, 'map'))} of them, several for one type of bearing; allowed: one "
                "for each type of bearing; lsa, sweep, critical, runup, campbell and hammer compare more"
            )
        if _ready(arguments) is not None and _given(arguments, "law"):
            problems.append("--law: stands beside --auto, whose law is that of a map; leave one of them out")
        laws = laws[:1] if _given(arguments, "law") else laws
    if hasattr(arguments, "films"):
        laws = _with_films(laws, _given(arguments, "films"), problems)
    else:
        # A command that does not ask for films has those of slow motion, whatever the default.
        laws = [dataclasses.replace(law, films="slow") for law in laws]
    laws = _with_supplies(laws, _given(arguments, "supply"), scene, problems)
    clearances = [read_clearance(text, problems) for text in _given(arguments, "clearance")] or [None]
    factors = [read_varied("load-factor", text, problems) for text in _given(arguments, "load_factor")] or [None]
    angles = [read_varied("start-angle", text, problems) for text in _given(arguments, "start_angle")] or [None]
    problems += _output_problems(arguments, scene, kind)
    count = len(laws) * len(clearances) * len(factors) * len(angles)
    if count > MOST_CASES:
        problems.append(
            f"--law, --map, --films, --supply, --clearance, --load-factor, --start-angle: got {count} combinations; "
            f"allowed: at most {MOST_CASES}"
        )
    lacking = list(needs(scene)) if scene is not None and needs is not None else []
    problems += lacking
    if scene is None or count > MOST_CASES or lacking:
        raise InputError(tuple(dict.fromkeys(problems)))
    scene = scene if speeds is None else dataclasses.replace(scene, sweep=speeds)
    cases = []
    for law, clearance, factor, angle in itertools.product(laws, clearances, factors, angles):
        try:
            subject = Subject(scene, law, clearance)
            for key, value in (("load-factor", factor), ("start-angle", angle)):
                subject = subject if value is None else varied_key(key).change(subject, value)
            model = subject.model()
        except InputError as error:
            problems += scene_problems(scene, error)
            continue
        words = [
            *([law.label] if len(laws) > 1 or count == 1 else []),
            *([MICROMETRE.text(clearance)] if len(clearances) > 1 and clearance is not None else []),
            *([f"{factor:g} x load"] if len(factors) > 1 else []),
            *([f"cage at {DEGREE.text(float(angle))}"] if len(angles) > 1 and angle is not None else []),
        ]
        turned = None if angle is None else float(angle)
        cases.append(Case(", ".join(words), model, common_clearance(model), float(factor or 1.0), turned, subject))
    if problems:
        raise InputError(tuple(dict.fromkeys(problems)))
    return cases


def read_compared(
    arguments: argparse.Namespace, problems: list[str], kind: Kind = RESULT
) -> tuple[Scene | None, list[LawChoice], float | None]:
    """Read scene, laws with their films and oil supplies, and one clearance of a command that builds its models itself.

    Parameters
    ----------
    arguments : argparse.Namespace
        The same as for `load_cases`.
    problems : list of str
        What is wrong is appended.
    kind : Kind
        Kind of file that -o writes.
    """
    scene = _read_scene(arguments, problems)
    laws = _with_films(_named_laws(arguments, scene, problems), _given(arguments, "films"), problems)
    laws = _with_supplies(laws, _given(arguments, "supply"), scene, problems)
    clearances = [read_clearance(text, problems) for text in _given(arguments, "clearance")]
    if len(clearances) > 1:
        problems.append(f"--clearance: got {len(clearances)} of them; allowed: one, and others by --vary clearance")
    problems += _output_problems(arguments, scene, kind)
    return scene, laws, clearances[0] if clearances else None


def _read_scene(arguments: argparse.Namespace, problems: list[str]) -> Scene | None:
    """Read the scene; None where problems were noted. A subject that stands ready has it."""
    if (subject := _ready(arguments)) is not None:
        return subject.scene
    try:
        return read_scene(arguments.scene)
    except InputError as error:
        problems += error.problems
        return None


def _named_laws(arguments: argparse.Namespace, scene: Scene | None, problems: list[str]) -> list[LawChoice]:
    """The laws of --law and --map; a subject that stands ready has the first one."""
    structure = getattr(arguments, "structure", None)
    if (subject := _ready(arguments)) is None:
        return _laws(_given(arguments, "law"), _given(arguments, "map"), structure, scene, problems)
    named = _given(arguments, "law")
    return [subject.law, *(_laws(named, [], None, scene, problems) if named else ())]


def _ready(arguments: argparse.Namespace) -> Subject | None:
    """Scene and law that stand ready in place of those to be read, as `--auto` puts them there."""
    subject: Subject | None = getattr(arguments, "subject", None)
    return subject


def _output_problems(arguments: argparse.Namespace, scene: Scene | None, kind: Kind) -> list[str]:
    """List problems with the files that are written."""
    tables = [path for law in _given(arguments, "law") if (path := table_path(law)) is not None]
    read: list[str | Path] = [*_given(arguments, "map"), *tables, *(scene.files if scene else ())]
    return scene_output_problems(arguments.scene, read, arguments.output, arguments.plot, kind)


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


def _given(arguments: argparse.Namespace, name: str) -> list[str]:
    """List the values given for an option, however often."""
    value = getattr(arguments, name, None)
    return [] if value is None else [value] if isinstance(value, str) else list(value)


def _laws(
    names: list[str], paths: list[str], structure: str | None, scene: Scene | None, problems: list[str]
) -> list[LawChoice]:
    """The laws that are meant: those named, and each set of maps; without either films from the film table."""
    if structure is not None and not paths:
        problems.append(NO_MAP.format(structure))
    for option, texts in (("--law", names), ("--map", paths)):
        problems += [
            f"{option}: got {text!r:.60} twice; allowed: each once"
            for text in sorted(set(texts))
            if texts.count(text) > 1
        ]
    laws = [_law(name, scene, problems) for name in names if name != "map" or not paths]
    laws += [
        LawChoice(label, "map", maps)
        for label, maps in _labelled_sets(read_maps(paths, structure, problems), scene, problems)
    ]
    if names or paths:
        return laws
    with_films = scene is not None and scene.lubricant is not None and scene.bearings
    return [_law(TABLE_LAW if with_films else "hertz", scene, problems)]


def _law(name: str, scene: Scene | None, problems: list[str]) -> LawChoice:
    """A law by its name; that of the film table brings its maps."""
    if name == TABLE_LAW and scene is not None:
        from mbs.scene.table_maps import table_maps  # with the solver, for what the table does not know

        try:
            maps = table_maps(scene)
        except InputError as error:
            problems += error.problems
        else:
            return LawChoice(law_label("map", maps), "map", maps)
    return LawChoice(law_label(name), name)


def read_maps(paths: list[str], structure: str | None, problems: list[str]) -> list[tuple[str, EHDMap]]:
    """Read the maps of --map, each with the name of its file; what is wrong about one is noted, and it is left out.

    Parameters
    ----------
    paths : list of str
        What was given.
    structure : str or None
        What was given for --structure.
    problems : list of str
        Appended to.
    """
    found: list[tuple[str, EHDMap]] = []
    for path in paths:
        try:
            found.append((Path(path).stem, open_given(path, structure)))
        except InputError as error:
            problems += error.problems
        except EhdmapsError as error:
            problems += [f"--map: {line}" for line in str(error).splitlines()]
    return found


def _labelled_sets(
    maps: list[tuple[str, EHDMap]], scene: Scene | None, problems: list[str]
) -> list[tuple[str, MapSet]]:
    """The sets that some maps make, each with a label that tells it from the others."""
    try:
        sets = map_sets(maps, None if scene is None else scene.bearings)
    except InputError as error:
        problems += error.problems
        return []
    labels = [law_label("map", one) for _, one in sets]
    return [
        (label if labels.count(label) == 1 else f"{label} {words}", one)
        for (words, one), label in zip(sets, labels, strict=True)
    ]


def _with_films(laws: list[LawChoice], given: list[str], problems: list[str]) -> list[LawChoice]:
    """Each law that has films with the films that are meant, or dry; laws without films as they are.

    A law that stands ready has its kind of films already, which stays where none is given.
    """
    wrong = [text for text in given if text not in FILMS]
    problems += [f"--films: got {text!r:.60}{closest(text, FILMS)}; allowed: {', '.join(FILMS)}" for text in wrong]
    twice = sorted(text for text in set(given) if given.count(text) > 1)
    problems += [f"--films: got {text!r:.60} twice; allowed: each once" for text in twice]
    if wrong or twice or not given:
        return laws
    having = [law for law in laws if law.name in ("map", "formula")]
    if not having:
        problems.append(
            f"--films: got {', '.join(given)} without a law that has films; allowed: with --map, --law table or formula"
        )
    found: list[LawChoice] = []
    for law in laws:
        found += [_filmed(law, text, len(given) > 1) for text in given] if law in having else [law]
    # One dry law stands for all maps, and for --law hertz.
    return [law for index, law in enumerate(found) if law.label not in {other.label for other in found[:index]}]


def _filmed(law: LawChoice, films: str, compared: bool) -> LawChoice:
    """A law with its films."""
    if films == "dry":
        return LawChoice(law_label("hertz"), "hertz")
    kind: Films = "memory" if films == "memory" else "slow"
    label = f"{law.label}, {FILM_WORDS[kind]}" if compared or kind != DEFAULT_FILMS else law.label
    return dataclasses.replace(law, label=label, films=kind)


def _with_supplies(
    laws: list[LawChoice], given: list[str], scene: Scene | None, problems: list[str]
) -> list[LawChoice]:
    """Each law that has films with the oil supplies that are meant; of scene and map where none is given."""
    supplies = read_supplies(given, problems)
    if given and not any(law.has_films for law in laws):
        problems.append(
            f"--supply: got {', '.join(given)} without a law that has films; allowed: with --map, --law table or "
            "formula"
        )
    if not given:
        return [law if scene is None else _labelled(law, _stated_label(law, scene)) for law in laws]
    found: list[LawChoice] = []
    for law in laws:
        if not law.has_films:
            found.append(law)
            continue
        for supply in supplies:
            words = f", {supply.short}" if len(given) > 1 or not supply.flooded else ""
            found.append(dataclasses.replace(_labelled(law, words), supply=supply))
    return found


def _stated_label(law: LawChoice, scene: Scene) -> str:
    """Part of the label of a law on the oil supply that scene or map state."""
    return ContactLaws(choose_law(law.name, law.maps), scene, law.maps).supply_label


def _labelled(law: LawChoice, words: str) -> LawChoice:
    """A law with more words in its label."""
    return dataclasses.replace(law, label=law.label + words)

"""The command line of a program as a table in TOML: what each command does, its arguments, and what --help says.

Rows of `arguments` are what `argparse` takes, with the `name` of the argument or its options, and a `type` by its name
in `READERS`. A text in place of a row is a set that several commands take. Choices of a file, such as
`ehdmaps.choices.MAP_CHOICES`, and groups of [shared] stand anywhere on the command line; a command says in `shared`
which of them it takes. A list of rows are arguments of which one at most is given.
"""

from __future__ import annotations

import argparse
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, partial
from importlib import resources
from typing import Any

from ehdmaps.choices import Choice, add_choices
from ehdmaps.program import Parser, Program, count

READERS: Mapping[str, Callable[[str], Any]] = {
    "count": count,
    "whole": partial(count, least=0, most=999_999_999),
    "int": int,
    "float": float,
}
"""Readers of values, by their names in a table."""


@cache
def _table(package: str) -> Mapping[str, Any]:
    """Table of a program, in the file `commands.toml` of its package."""
    return tomllib.loads((resources.files(package) / "commands.toml").read_text(encoding="utf-8"))


def program(
    package: str, choices: Iterable[Choice[Any]], file: str, *, several: bool, **words: str
) -> tuple[Program, dict[str, Parser]]:
    """Make the parser of a program, and those of its commands by their names.

    Parameters
    ----------
    package : str
        Package whose file `commands.toml` is the table.
    choices : iterable of Choice
        Choices that commands share.
    file : str
        What states them where they are left out: a scene, a job.
    several : bool
        Whether a choice may be given more than once.
    **words : str
        Further texts for {word}.
    """
    table = _table(package)
    texts = {**table.get("words", {}), **words}
    top = Program(table["program"], table["description"], table["epilog"], table["renamed"])
    add_choices(top.shared, choices, file, several=several)
    for title, rows in table["shared"].items():
        group = top.shared.add_argument_group(title)
        _add_all(group, rows, {}, texts)
    groups = {str(group.title): [one.dest for one in group._group_actions] for group in top.shared._action_groups}
    commands = {}
    for name, row in table["commands"].items():
        taken = list(_taken(row.get("shared", ()), groups))
        told = _filled(row["words"], texts), taken, row.get("more", ""), row.get("epilog", "")
        commands[name] = command = top.add_command(row["group"], name, *told)
        _add_all(command, row["arguments"], table["sets"], texts)
        if "parts" in row:
            parts = command.add_subparsers(dest="part", required=True, metavar="PART")
            for part, of in row["parts"].items():
                _add_all(parts.add_parser(part, help=of["words"]), of["arguments"], table["sets"], texts)
    return top, commands


def _taken(names: Iterable[str], groups: Mapping[str, list[str]]) -> Iterator[str]:
    """Keys of the shared options that a command takes."""
    keys = [key for name in names for key in groups.get(name, [name])]
    left_out = {key[1:] for key in keys if key.startswith("-")}
    return (key for key in keys if key not in left_out and not key.startswith("-"))


def _add_all(
    command: argparse._ActionsContainer,
    rows: Iterable[Any],
    sets: Mapping[str, list[Any]],
    texts: Mapping[str, str],
) -> None:
    """Add arguments, those of sets, and those that exclude each other."""
    for row in rows:
        if isinstance(row, str):
            _add_all(command, sets[row], sets, texts)
        elif isinstance(row, list):
            _add_all(command.add_mutually_exclusive_group(), row, sets, texts)
        else:
            _add(command, row, texts)


def _add(command: argparse._ActionsContainer, row: Mapping[str, Any], texts: Mapping[str, str]) -> None:
    """Add an argument."""
    names = [row["name"]] if isinstance(row["name"], str) else row["name"]
    settings: dict[str, Any] = {key: value for key, value in row.items() if key != "name"}
    if isinstance(row.get("metavar"), list):
        settings["metavar"] = tuple(row["metavar"])
    if "type" in settings:
        settings["type"] = READERS[settings["type"]]
    if "help" in settings:
        settings["help"] = _filled(settings["help"], texts).replace("%", "%%")
    command.add_argument(*names, **settings)


def _filled(text: str, texts: Mapping[str, str]) -> str:
    """A text with those that it names."""
    for word, meaning in texts.items():
        text = text.replace(f"{{{word}}}", meaning)
    return text

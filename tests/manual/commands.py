"""The page of commands: what --help says, by groups, with the options as tables."""

from __future__ import annotations

import argparse

from ehdmaps.exports.target import find, registered
from ehdmaps.jobs import cli as of_maps
from ehdmaps.program import Program
from mbs import cli as of_machines

_HEAD = """# Commands

All commands of `ehdmaps` and `mbs` with their options, as `--help` prints them. Options that many commands share stand
at the end of each program. A quantity may have any unit of its kind: `"500 rpm"`, `"8.33 Hz"`. This page is made by
`python -m tests.manual --write`.
"""


def commands_page() -> str:
    """Commands of both programs."""
    return _HEAD + "".join(_program(parser) for parser in (of_maps.parser(), of_machines.parser()))


def _program(top: Program) -> str:
    """A program: its commands by groups, then the options that they share."""
    parts = [f"\n## {top.prog}\n\n{top.description} {top.epilog}\n"]
    for group, commands in top._groups.items():
        parts.append(f"\n### {top.prog}: {group}\n")
        parts += [_command(top, name, words) for name, words in commands]
    parts.append(f"\n### Options that commands of {top.prog} share\n")
    parts += [_options(group._group_actions, top.shared) for group in top.shared._action_groups]
    return "".join(parts)


def _command(top: Program, name: str, words: str) -> str:
    """A command: what it takes, its own options, and the names of those that it shares."""
    command = top._commands.choices[name]
    given = [_argument(action) for action in command._actions if not action.option_strings and not _parts(action)]
    text = f"\n#### {' '.join([top.prog, name, *given])}\n\n{words[0].upper()}{words[1:]}.\n"
    text += _options(command._actions, command)
    for action in command._actions:
        for part, parser in _parts(action).items():
            known = [_argument(one) for one in parser._actions if not one.option_strings]
            helped = next(choice.help for choice in action._choices_actions if choice.dest == part)
            text += f"\n`{' '.join([top.prog, name, part, *known])}`: {helped}.\n{_options(parser._actions, parser)}"
    if name == "export":
        text += _targets()
    if takes := [f"`{option}`" for key, option in top._shared_options().items() if key in top._takes[name]]:
        every = len(takes) == len(top._shared_options())
        text += f"\nShared options: {'all' if every else ', '.join(takes)}.\n"
    return text


def _targets() -> str:
    """Targets of `ehdmaps export`, and their options: each once, with the targets that have it."""
    lines = ["", "| target | what it is |", "|---|---|"]
    owners: dict[str, list[str]] = {}
    for name in registered():
        target, parser = find(name), argparse.ArgumentParser(add_help=False)
        target.add_arguments(parser)
        lines.append(f"| `{name}` | {target.summary} |")
        for row in _rows(parser._actions, parser):
            owners.setdefault(row, []).append(name)
    lines += ["", "| option | what it does | of |", "|---|---|---|"]
    return "\n".join([*lines, *(f"{row} {', '.join(names)} |" for row, names in owners.items()), ""])


def _parts(action: argparse.Action) -> dict[str, argparse.ArgumentParser]:
    """Commands below a command."""
    return dict(action.choices) if isinstance(action, argparse._SubParsersAction) else {}


def _argument(action: argparse.Action) -> str:
    """An argument without an option, as usage lines show it."""
    name = str(action.metavar or action.dest)
    return {"?": f"[{name}]", "*": f"[{name} ...]", "+": f"{name} [{name} ...]"}.get(str(action.nargs), name)


def _options(actions: list[argparse.Action], parser: argparse.ArgumentParser) -> str:
    """A table of options, and of arguments that have words; empty without any."""
    rows = _rows(actions, parser)
    return "\n".join(["", "| option | what it does |", "|---|---|", *rows, ""]) if rows else ""


def _rows(actions: list[argparse.Action], parser: argparse.ArgumentParser) -> list[str]:
    """Rows of a table of options."""
    rows = []
    for action in actions:
        if isinstance(action, argparse._HelpAction | argparse._SubParsersAction) or not action.help:
            continue
        names = ", ".join(action.option_strings)
        value = "" if action.nargs == 0 else f" {parser._get_formatter()._format_args(action, action.dest.upper())}"
        shown = f"{names}{value}" if names else _argument(action)
        words = parser._get_formatter()._expand_help(action).replace("|", "\\|")
        rows.append(f"| `{shown}` | {'required: ' if names and action.required else ''}{words} |")
    return rows

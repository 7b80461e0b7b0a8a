"""Parsers of the programs: commands in groups, options that many commands share, old names."""

from __future__ import annotations

import argparse
import re

import pytest

import ehdmaps.jobs.cli
import mbs.cli
from ehdmaps.program import Program, complain

MOST_OPTIONS = 224
"""Options of both programs in all, a shared one once: what a user has to choose from."""


def program() -> Program:
    """A program of two commands, one of which takes a shared option."""
    top = Program("prog", "What it does.", "How it ends.", {"--speeds": "--speed FROM TO POINTS"})
    group = top.shared.add_argument_group("choices", "in place of the file")
    group.add_argument("--oil", action="append", help="of all bearings")
    top.add_command("look", "show", "what it holds", ["oil"], "; more than once").add_argument("file")
    top.add_command("laboratory", "try", "the extremes").add_argument("--load")
    return top


def refused(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """What is said of a command line that is refused."""
    with pytest.raises(SystemExit) as ended:
        program().parse_args(words)
    assert ended.value.code == 2
    return capsys.readouterr().err


@pytest.mark.parametrize("words", [["show", "a", "--oil", "VG 46"], ["--oil", "VG 46", "show", "a"]])
def test_a_shared_option_stands_anywhere(words):
    arguments = program().parse_args(words)
    assert (arguments.command, arguments.file, arguments.oil) == ("show", "a", ["VG 46"])


def test_a_command_has_no_more_than_it_takes():
    assert not hasattr(program().parse_args(["try"]), "oil")
    assert program().parse_args(["show", "a"]).oil is None


def test_what_a_command_does_not_take(capsys):
    assert "prog try has no --oil; allowed: with show" in refused(capsys, "try", "--oil", "x")


def test_old_and_unknown_names(capsys):
    assert "unrecognized arguments: --speeds 1; --speeds is --speed FROM TO POINTS now" in refused(
        capsys, "try", "--speeds", "1"
    )
    assert refused(capsys, "try", "--weight").endswith("unrecognized arguments: --weight\n")
    assert "expected one argument" in refused(capsys, "show", "a", "--oil")


def test_shared_options_are_not_abbreviated():
    """--lo of a command is its --load, and never a shared option that begins alike."""
    assert program().parse_args(["try", "--lo", "5"]).load == "5"


def test_help_goes_by_groups(capsys):
    with pytest.raises(SystemExit):
        program().parse_args(["--help"])
    text = capsys.readouterr().out
    places = [text.index(words) for words in ("What it does.", "look:", "show", "laboratory:", "--oil", "How it ends.")]
    assert places == sorted(places)
    with pytest.raises(SystemExit):
        program().parse_args(["show", "--help"])
    assert "Also, as `prog --help` explains: --oil; more than once" in capsys.readouterr().out


def options(parser: argparse.ArgumentParser) -> list[str]:
    """Options of a parser and its commands, but for help."""
    found = []
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            found += [option for command in action.choices.values() for option in options(command)]
        elif action.option_strings and "--help" not in action.option_strings:
            found.append(action.option_strings[-1])
    return found


def test_options_are_few():
    programs = mbs.cli.parser(), ehdmaps.jobs.cli.parser()
    assert sum(len(options(top)) + len(options(top.shared)) for top in programs) < MOST_OPTIONS


@pytest.mark.parametrize("top", [mbs.cli.parser(), ehdmaps.jobs.cli.parser()], ids=["mbs", "ehdmaps"])
def test_each_command_stands_in_a_group(top):
    text = top.format_help()
    (commands,) = (action for action in top._actions if isinstance(action, argparse._SubParsersAction))
    assert all(re.search(rf"^  {name} ", text, re.MULTILINE) for name in commands.choices)


@pytest.mark.parametrize(
    ("main", "words", "said"),
    [
        (mbs.cli.main, "sweep gearbox --speeds 1 2 3", "--speeds is --speed FROM TO POINTS now"),
        (mbs.cli.main, "modes gearbox --tolerance 5%", "--tolerance is --auto-tolerance"),
        (mbs.cli.main, "modes gearbox --structure palmgren", "--structure is --structural-law now"),
        (ehdmaps.jobs.cli.main, "generate nu308 --tolerance 1%", "--tolerance is --law-tolerance of generate now"),
        (
            ehdmaps.jobs.cli.main,
            "solve nu308 --load 1N/mm --speed 1m/s --temperature 40degC --frequencies 1Hz 2Hz 2",
            "--frequencies is --frequency FROM TO POINTS now",
        ),
    ],
)
def test_old_names_are_told(main, words, said, capsys):
    with pytest.raises(SystemExit) as ended:
        main(words.split())
    assert ended.value.code == 2
    assert said in capsys.readouterr().err


def test_a_long_list_of_problems_ends(capsys):
    complain("mbs check", [f"problem {number}" for number in range(57)])
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "mbs check: 57 problems"
    assert lines[20:] == ["  problem 19", "  ... and 37 more"]
    complain("mbs check", ["one"] * 20)
    assert "more" not in capsys.readouterr().err

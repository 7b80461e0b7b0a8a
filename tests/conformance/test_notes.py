"""The same fact is told by the same words, and ends with the same status, by every command and of every kind."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable
from dataclasses import dataclass, replace

import pytest

from mbs import assemble, parse_scene, statics
from tests.cases.commands import run
from tests.conformance.machines import BACK, KINDS, NEEDLE, NJ, NN, NU, NUP, PUSHED, TAPERED, Machine

DRY = "hertz:1.25e-5 s"


@functools.cache
def heavy(kind: Machine, pressure: float) -> str:
    """The machine under a load by which its largest Hertz pressure is near a value [Pa]."""
    load = 3e4
    for _ in range(12):
        text = kind.text(tuple(load * way for way in kind.heavy))
        found = float(statics(assemble(parse_scene(text, "a", "a.toml"), DRY)).dataset["hertz_pressure"].max())
        if abs(found / pressure - 1.0) < 0.05:
            return text
        load *= (pressure / found) ** 2.3
    raise AssertionError(f"{kind.name}: no load with {pressure:g} Pa")


IDLE = {
    "cylindrical": NU.replace("10 um", "200 um"),
    "rollers as bodies": NU.replace("10 um", "200 um") + '\nrollers = "bodies"',
    "needle": NEEDLE.replace("10 um", "200 um"),
    "double row cylindrical": NN.replace("10 um", "200 um"),
    "deep groove": 'bearing = "6208"\ndiametral_clearance = "200 um"',
    "hybrid, thin section": 'bearing = "61912"\ndiametral_clearance = "200 um"',
    "two rows, four-point": 'bearing = "QJ208"\ndiametral_clearance = "200 um"',
    "self-aligning": 'bearing = "1208"\ndiametral_clearance = "200 um"',
    "thrust": 'bearing = "51208"\naxial_offset = "-250 um"',
    "angular contact": 'bearing = "7208B"\naxial_offset = "-250 um"',
    "tapered": 'bearing = "32208"\naxial_offset = "-100 um"',
    "ribbed NUP": NUP.replace("10 um", "200 um") + '\naxial_clearance = "400 um"',
    "ribbed NJ, NNCF": NJ.replace("10 um", "200 um") + '\naxial_offset = "-100 um"',
}
"""A bearing of each kind that nothing loads, between two that hold the rotor."""


def idle(kind: Machine) -> str:
    """A rotor on a pair, with a bearing that carries nothing."""
    pair = (("left", f"{TAPERED}\n{PUSHED}"), ("right", f"{TAPERED}\n{BACK}"))
    return replace(kind, bearings=(*pair, ("middle", IDLE[kind.name])), axial=True).text()


@dataclass(frozen=True)
class Fact:
    """A row: a fact, the machine of a kind in which it is so, the words that tell it, and the exit status."""

    name: str
    text: Callable[[Machine], str]
    words: str
    status: int


FACTS = (
    Fact(
        "overload",
        lambda kind: heavy(kind, 5.2e9),
        r"warning: (left|right)_\d: Hertz pressure of [\d.]+ GPa \((inner|outer) raceway\) is above 4(\.2)? GPa, the "
        "static limit of ISO 76: permanent deformation; elastic contacts and films no longer hold",
        1,
    ),
    Fact(
        "crushed",
        lambda kind: heavy(kind, 7.8e9),
        r"error: the figures below mean nothing: .*Hertz pressure of [\d.]+ GPa( \((inner|outer) raceway\))? is above "
        "7 GPa, the hardness of bearing steel, which no contact carries",
        1,
    ),
    Fact(
        "no load",
        idle,
        r"warning: middle_2: no (ball|roller) carries load: nothing holds the shaft there, preload is lost",
        0,
    ),
)

STATICS = ("statics",)
COMMANDS = (
    ("modes",),
    ("lsa",),
    ("sweep", "--workers", "1"),
    ("critical",),
    ("hammer", "--hits", "1", "--duration", "20 ms", "--workers", "1", "-o", "hits.uff"),
)


@pytest.mark.parametrize("fact", FACTS, ids=lambda fact: fact.name)
@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind.films], ids=lambda kind: kind.name)
def test_fact(kind, fact, capsys, tmp_path, monkeypatch):
    """The words are those of every kind and command: each kind has those of `mbs statics`, and of two more in turn."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "machine.toml").write_text(fact.text(kind), encoding="utf-8")
    wrong, turn = [], KINDS.index(kind) + 2 * FACTS.index(fact)
    for name, *options in (STATICS, COMMANDS[turn % len(COMMANDS)], COMMANDS[(turn + 2) % len(COMMANDS)]):
        status, out, err = run(capsys, name, "machine.toml", "--law", DRY, *options)
        if status != fact.status or not re.search(fact.words, out):
            told = [line for line in (out + err).splitlines() if re.match("warning|error|mbs", line)]
            wrong.append((name, status, told[:4]))
    assert not wrong

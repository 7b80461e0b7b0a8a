"""A kind of bearing that nobody has: pads on springs. What it takes to have it in every analysis at rest."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import math
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import mbs
from ehdmaps.physics.solids import STEEL
from mbs import assemble, modes, parse_scene, statics
from mbs.bearings.contact_report import BearingContacts, loss_of
from mbs.bearings.films import ContactState
from mbs.bearings.locating.locating_force import LocatingForce, directions
from mbs.model.elements import Operation
from mbs.model.findings import Cause, Gauge
from mbs.output.one_bearing import located
from mbs.scene import kinds
from mbs.scene.locating import element as of_scenes
from mbs.scene.specs import LocatingSpec
from tests.conformance.machines import HEAD, TAIL

STIFFNESS, ANGLE, PADS = 2e8, 0.5, 12

NAMED = {
    "one_bearing/balls.py",
    "one_bearing/ribs.py",
    "exports/exudyn.py",  # a file for another program, of balls alone
    "exports/one_bearing/balls.py",
    "exports/one_bearing/rollers.py",
    "output/one_bearing/located.py",
    "report/located.py",
    "scene/locating/element.py",
    "transient/kinds.py",  # with a block in C: without one, runs call it from Python
}
"""Files of `mbs` that name forces of one kind, outside of the room of the kind: its rows."""


@dataclass(frozen=True)
class Pads:
    """The catalogue: a geometry."""

    name: str = "P12"
    kind: str = "pad bearing"
    title: str = "P12"
    estimated: None = None
    pitch_diameter: float = 60e-3
    contact_angle: float = ANGLE
    clearance: None = None

    def cage_speed(self, inner_speed, outer_speed=0.0):
        return 0.5 * (inner_speed + outer_speed)

    def entrainment_speed(self, inner_speed, outer_speed=0.0):
        return 0.5 * self.pitch_diameter * (inner_speed - outer_speed)


class PadForce(LocatingForce):
    """The kinematics, and the balance, which is a spring for each pad."""

    rolling_element, dry_law = "pad", None

    def __init__(self):
        self.geometry, self.material, self.angles = Pads(), STEEL, directions(PADS)
        self.film_loads, self.held = (0.0, math.inf), None
        self.shape = SimpleNamespace(most_travel=1e-3, most_tilt=1e-2)
        self._load = np.zeros(PADS)

    def _evaluated(self, pose, cage_angle, inner_speed, outer_speed, cage_speed):
        place, feel = self._six(pose, "pose"), np.zeros((PADS, 6))
        at = self.angles + cage_angle
        feel[:, 0], feel[:, 1], feel[:, 2] = (
            math.sin(ANGLE), math.cos(ANGLE) * np.cos(at), math.cos(ANGLE) * np.sin(at),
        )  # fmt: skip
        self._load = STIFFNESS * np.maximum(feel @ place, 0.0)
        stiffness = feel.T @ (STIFFNESS * (self._load > 0.0)[:, None] * feel)
        return -feel.T @ self._load, stiffness, 1e-5 * stiffness

    def loads(self, pose, *, cage_angle=0.0, inner_speed=0.0, outer_speed=0.0):
        self._evaluated(pose, cage_angle, inner_speed, outer_speed, None)
        load = np.array([self._load, self._load])
        return SimpleNamespace(angle=self.angles + cage_angle, load=load, largest=load.max(), loaded=PADS)

    @property
    def last_loads(self):
        return np.array([self._load, self._load])

    def gauge(self, loads):
        return Gauge("pad", loads.load, np.full(2, 1e9), 4e9)

    def felt(self, loads, films, speeds):
        values = loads.load[0][:, None]
        side = ContactState(1e6 * values, 1e6 * values, *np.full((3, PADS, 1), np.nan), 0.0 * values)
        return BearingContacts(side, side), loss_of(np.full((2, PADS), np.nan), loads.load[0], 1.0)

    def condensed(self, loads, conditions, relaxes):
        return None  # without films

    def works(self, speeds, last):
        return 0.0, 0.0

    def stored(self, rows):
        return float(np.sum(rows[:, 0] ** 2)) / (2.0 * STIFFNESS)


@dataclass(frozen=True)
class PadSpec(LocatingSpec):
    """What a scene holds of it."""

    elements = f"{PADS} pads"


@pytest.fixture
def model(monkeypatch):
    """A machine with two of them, by a row in each table."""
    row = next(kind for kind in kinds.KINDS if kind.word == "ball bearing")
    monkeypatch.setattr(kinds, "KINDS", (*kinds.KINDS, dataclasses.replace(row, word="pad bearing", spec=PadSpec)))
    balls = next(iter(of_scenes._KINDS.values()))
    pads = dataclasses.replace(balls, words=lambda spec: spec.geometry.kind, force=lambda spec, damper: PadForce())
    monkeypatch.setitem(of_scenes._KINDS, PadSpec, pads)
    monkeypatch.setitem(located._WORDS, PadForce, lambda at: (f"{PADS} pads", []))
    text = HEAD.format(name="pads", freedoms='["x", "y", "z"]') + TAIL.replace("{load}", '["3 kN", "1 kN", "0 N"]')
    scene = parse_scene(text, "pads", "pads.toml")
    each = [PadSpec(side, f"rotor:{side}", "ground", Pads()) for side in ("left", "right")]
    return assemble(dataclasses.replace(scene, elements=each), "hertz")


def test_a_new_kind_is_in_statics_and_modes(model):
    """Loads of the pads carry the force; results have the names of all kinds; a load on no pad is told."""
    found = statics(model)
    loads = found.dataset["highest_raceway_load"].values
    np.testing.assert_allclose(found.dataset["bearing_force"].values.sum(axis=0), [-3e3, -1e3, 0.0], atol=1e-6)
    assert loads[0] == loads[1] > 1.5e3 / PADS / math.sin(ANGLE)
    assert found.dataset["loaded_elements"].values.tolist() == [PADS, PADS]
    assert model.law == "pad bearings dry Hertz"
    lines = located.located_lines(found.model, found.balance)
    assert lines[0] == f"left: -1500 N along x, 500 N across it on the inner ring; {PADS} pads"
    element = model.on_rings[0]
    loose = element.gauge(np.array([-1e-5, 0.0, 0.0, 0.0, 0.0, 0.0]), Operation()).findings
    assert [(one.cause, one.words.split(":")[0]) for one in loose] == [(Cause.UNLOADED, "no pad carries load")]
    along = modes(model).modes.frequency.min()
    # two bearings along x, each PADS sin^2 k, carry 8 kg; across they are stiffer
    assert along == pytest.approx(
        math.sqrt(2 * PADS * STIFFNESS * math.sin(ANGLE) ** 2 / 8.0) / (2.0 * math.pi), rel=1e-3
    )


def test_a_new_kind_takes_few_lines():
    """Its catalogue, its kinematics and what a scene holds of it, beside three rows: 50 lines of code are enough."""
    lines = 0
    for part in (Pads, PadForce, PadSpec):
        text = ast.unparse(ast.parse(inspect.getsource(part)))  # without comments, blanks and folds
        docstrings = text.count('"""') // 2
        lines += len([line for line in text.splitlines() if line.strip()]) - docstrings
    assert lines <= 50


def test_a_step_in_time_is_that_of_rest(model):
    element, at = model.on_rings[0], Operation(100.0, 0.3, 0.0)
    motion, velocity = np.array([2e-5, 1e-5, 0.0, 0.0, 0.0, 0.0]), np.array([0.0, 1e-3, 0.0, 0.0, 0.0, 0.0])
    answer, states = element.advance(None, motion, velocity, at)
    wanted = element.evaluate(motion, velocity, at)
    np.testing.assert_array_equal(answer.force, wanted.force)
    assert element.stored(states, motion, at) == pytest.approx(
        -0.5 * element.force(motion, cage_angle=0.15)[0] @ motion
    )
    assert element.powers(states, answer.force, motion, velocity, at).dissipated > 0.0


def test_elements_of_a_kind_are_named_in_their_rows_alone():
    """Whoever asks which kind an element is does not say it where all kinds are meant."""
    root, found = Path(mbs.__file__).parent, set()
    for path in root.rglob("*.py"):
        place = path.relative_to(root).as_posix()
        if place.startswith("bearings/"):
            continue
        names = {node.id for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.Name)}
        texts = {node.value for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.Constant)}
        if {"BallForce", "TaperedForce"} & (names | {text for text in texts if isinstance(text, str)}):
            found.add(place)
    assert found == NAMED

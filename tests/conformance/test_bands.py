"""Bands of bearings of every kind: derivatives beside machines solved again with laws that are wrong on purpose."""

from __future__ import annotations

import dataclasses
import math
from collections import OrderedDict
from types import SimpleNamespace

import numpy as np
import pytest

from ehdmaps.maps.law_errors import LawBounds, LawChange
from ehdmaps.maps.law_films import LawAtPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.table.points.response import read_response
from mbs import assemble, parse_scene
from mbs.analyses.campbell import law_changes, with_changed_laws
from mbs.analyses.film_errors import film_errors
from mbs.analyses.modes import modes
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.films import ball_films
from mbs.bearings.balls.response import ContactResponse
from mbs.linearised.bands import law_bands
from mbs.linearised.dynamic import dynamic_slope, dynamic_stiffness, newton
from mbs.linearised.linear import (
    frequency_response,
    input_matrix,
    responses,
    seen_of_loads,
    sensor_matrix,
)
from mbs.linearised.modes import state_modes, undamped_modes
from mbs.linearised.sweep import along_load
from mbs.model.elements import OnRings, Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.on_rings import NO_MAP
from tests.conformance.machines import KINDS, MIXED

SCENE = """
schema = 1
[operation]
speed = "6000 rpm"
temperature = "60 degC"
[lubricant]
name = "FVA3"
[[bodies]]
name = "rotor"
freedoms = ["x", "y", "z", "theta_y", "theta_z"]
spin = 1
mass = "8 kg"
polar_inertia = "0.02 kg m^2"
transverse_inertia = "0.2 kg m^2"
frames = { left = ["-60 mm", "0 mm", "0 mm"], right = ["60 mm", "0 mm", "0 mm"] }
[[loads]]
name = "pull"
on = "rotor"
force = ["200 N", "-500 N", "150 N"]
[[inputs]]
name = "push"
on = "rotor:left"
direction = "y"
[[sensors]]
name = "seen"
on = "rotor:right"
direction = "z"
quantity = "acceleration"
"""


def bearing(name, kind, at, more=""):
    return f'[[bearings]]\nname = "{name}"\nbearing = "{kind}"\ninner = "rotor:{at}"\nouter = "ground"\n{more}\n'


PAIR = bearing("left", "7208B", "left", 'axial_offset = "6 um"') + bearing(
    "right", "7208B", "right", 'mirrored = true\naxial_offset = "-6 um"'
)
FREQUENCIES = np.geomspace(30.0, 3e3, 5)
FILM, PART = 1e-12, 1e-5
"""Steps of films [m] and of damping: beside the changes of places and laws over a film, and beside 1, they are so small
that central differences leave round-off alone, of about 1e-5 in eigenvalues that are found to 1e-10."""


@pytest.fixture
def even(monkeypatch):
    """Laws whose k, c and films may be wrong by the whole of them, and by 1 m, at any load."""
    monkeypatch.setattr(ContactResponse, "bounds", lambda self, load: tuple(np.ones((3, load.size))))
    monkeypatch.setattr(LawAtPoint, "bounds", lambda self, load: LawBounds(*np.ones((3, load.size))))


class Changed:
    """Films of a bearing by the speeds of its rings, whose laws are changed."""

    def __init__(self, films, change):
        self.films, self.change = films, change

    def __call__(self, *speeds):
        return self.change(self.films(*speeds))


def wrong(system, name, film, damping):
    """The system with thicker films [m] and relatively more damping of a bearing in balance."""

    def changed(law):
        sides = {}
        for side in ("inner", "outer"):
            one = getattr(law, side)
            table = one.table.copy()
            table[:, 2] += math.log1p(damping)
            sides[side] = one._replace(table=table, centre=one.centre - film)
        if getattr(law, "points", ()):  # of lines, whose natural times grow with the damping, at the same spring
            change = LawChange(damping=damping, film=film)
            sides["points"] = tuple(one.law.changed(change).at(*one.conditions[:2]) for one in law.points)
        return dataclasses.replace(law, **sides)

    elements = [connected.element for connected in system.elements]
    for index, element in enumerate(elements):
        if element.name == name:
            made = {"_made": OrderedDict()} if hasattr(element, "balls") else {}
            elements[index] = dataclasses.replace(element, films=Changed(element.films, changed), **made)
    return system.with_elements(elements)


class Base:
    """A machine at rest, and what its bands are to be."""

    def __init__(self, text, films, scene=SCENE):
        self.scene = parse_scene(scene + text, "rotor", "rotor.toml")
        self.model = assemble(self.scene, "table", films=films)
        self.operation = Operation(self.scene.speed)
        self.balance = equilibrium(self.model.system, self.operation, tolerance=1e-13)
        self.laws = law_bands(self.balance)
        states = state_modes(self.balance, undamped_modes(self.balance))
        n, kept = self.model.system.size, np.flatnonzero(states.oscillates)
        self.shapes, self.left = states.right[:n, kept], states.left[kept, n : 2 * n]
        self.values = self.eigenvalues(self.balance, states.eigenvalues[kept])
        self.found = self.laws.eigenvalue_changes(self.values, self.shapes, self.left)
        where = self.scene.inputs, self.scene.sensors
        self.direct = frequency_response(self.balance, *where, FREQUENCIES)
        self.back = seen_of_loads(self.balance, states, self.scene.sensors, FREQUENCIES, self.laws.ports)
        self.motion = self.laws.ports @ responses(self.balance, self.scene.inputs, FREQUENCIES)

    def eigenvalues(self, balance, start):
        found = [newton(balance, complex(value), self.shapes[:, k]) for k, value in enumerate(start)]
        return np.array(found)

    def told(self, system):
        """Eigenvalues, sizes of responses, k and c along the loads, undamped frequencies of a system solved again."""
        balance = equilibrium(system, self.operation, self.balance.displacement, tolerance=1e-13)
        answer = frequency_response(balance, self.scene.inputs, self.scene.sensors, FREQUENCIES)
        undamped = undamped_modes(balance).frequency
        return self.eigenvalues(balance, self.values), np.abs(answer), along_load(balance)[1:], undamped

    def check(self, change, one, other, step):
        """Central differences of two systems beside the derivatives by a change."""
        eigenvalues, sizes, sides, undamped = (
            (a - b) / (2.0 * step) for a, b in zip(self.told(one), self.told(other), strict=True)
        )
        found, only = self.found[change], self.laws.only(change)
        assert np.max(np.abs(eigenvalues - found)) < 2e-4 * np.abs(found).max()
        band, _ = only.of_responses(FREQUENCIES, self.motion, self.back, self.direct)
        np.testing.assert_allclose(np.abs(sizes), band, atol=2e-4 * band.max())
        own = only.of_bearings()
        known = np.isfinite(own)
        np.testing.assert_allclose(np.abs(sides)[known], own[known], atol=2e-4 * own[known].max())
        at_rest = undamped_modes(self.balance)
        found = only.of_undamped(at_rest.frequency, at_rest.shapes)
        np.testing.assert_allclose(
            np.abs(undamped), found, atol=2e-4 * found.max() + 1e-12 * at_rest.frequency.max() / step
        )
        assert np.isfinite(self.laws.of_undamped(at_rest.frequency, at_rest.shapes)).all()
        assert np.isfinite(only.eigenvalue_changes(self.values, self.shapes, self.left)).all()

    def change_of(self, name, kind):
        """Place of a change of a bearing."""
        elements = [connected.element for connected in self.model.system.elements]
        (index,) = (index for index, element in enumerate(elements) if getattr(element, "name", "") == name)
        return self.laws.change_of(index, kind)

    def check_bearing(self, name):
        """Damping and films of a bearing in balance."""
        for kind, step in (("damping", PART), ("film", FILM)):
            change = self.change_of(name, kind)
            way = (0.0, step) if kind == "damping" else (step, 0.0)
            systems = [wrong(self.model.system, name, sign * way[0], sign * way[1]) for sign in (1.0, -1.0)]
            self.check(change, *systems, step)


def test_a_pair_of_ball_bearings_with_memory(even):
    base = Base(PAIR, "memory")
    base.check_bearing("left")
    base.check_bearing("right")


MACHINES = [machine for machine in (*KINDS, *MIXED) if machine.films and "idle" not in machine.name]


BOTH = ("cylindrical", "rollers as bodies", "deep groove", "tapered", "ribbed NUP", "all kinds")
CELLS = [
    pytest.param(machine, films, id=f"{machine.name}-{films}")
    for place, machine in enumerate(MACHINES)
    for films in (("slow", "memory") if machine.name in BOTH else (("slow", "memory")[place % 2],))
]
"""Elements of each kind with both films; machines of others, which have the same elements, with one of them in turn."""


@pytest.mark.parametrize(("machine", "films"), CELLS)
def test_bands_are_those_of_machines_solved_again(machine, films, even):
    """Damping and films of every bearing of every kind, beside each other: eigenvalues of machines solved again.

    The films of cylindrical rollers come from tables of approaches, with kinks in their curvature: 2 %. Springs of
    films of lines with memory are straight between the rows of their tables: 1 %. Others are smooth over the steps,
    and leave what `FILM` and `PART` say."""
    base = Machine(machine.text(), films)
    for name in base.names:
        of_films = ("film", 1e-10, 2e-2) if name in base.sliced else ("film", FILM, 1e-2 if films == "memory" else 2e-4)
        for kind, step, within in (("damping", PART, 2e-4), of_films):
            base.check_eigenvalues(name, kind, base.change_of(name, kind), step, within)


class Machine(Base):
    """A machine of the list with films of the table, and its bands."""

    def __init__(self, text, films):
        super().__init__("", films, scene=text)
        self.names = [entry.name for entry in self.model.on_rings]
        self.sliced = {entry.name for entry in self.model.bearings}

    def changed(self, name, kind, step):
        """The system with one law that is wrong by a step."""
        film, damping = (step, 0.0) if kind == "film" else (0.0, step)
        if name not in self.sliced:
            return wrong(self.model.system, name, film, damping)
        elements = {connected.element.name: connected.element for connected in self.model.system.elements}
        wrongs = dict.fromkeys(self.sliced, LawChange()) | {name: LawChange(damping=damping, film=film)}
        changes = {key: (change,) * len(elements[key].film_laws) for key, change in wrongs.items()}
        return with_changed_laws(self.model, changes, (1.0, 1.0, 1.0)).system

    def check_eigenvalues(self, name, kind, change, step, within):
        """Central differences beside the derivative."""
        ends = []
        for sign in (1.0, -1.0):
            balance = equilibrium(
                self.changed(name, kind, sign * step), self.operation, self.balance.displacement, tolerance=1e-13
            )
            ends.append(self.eigenvalues(balance, self.values))
        found = self.found[change]
        # eigenvectors of the few states of films say little of motions near critical damping, or beyond 10 kHz
        swings = (self.values.imag > np.abs(self.values.real)) & (np.abs(self.values) < 2.0 * math.pi * 10e3)
        difference = np.abs((ends[0] - ends[1]) / (2.0 * step) - found)[swings].max()
        assert difference < within * np.abs(found[swings]).max(), (name, kind)


def test_stiffness_at_held_loads(even):
    """Under an axial load all balls are alike: laws that turn about the approach at rest keep the loads."""
    model = assemble(parse_scene(SCENE + PAIR, "rotor", "rotor.toml"), "table")
    element = model.system.elements[model.system.select(OnRings)[0]].element
    operation, place = Operation(model.scene.speed), np.array([3e-6, 0.0, 0.0, 0.0, 0.0, 0.0])
    condensed = element.small_motions(place, operation)
    at = element.settled(place, operation)
    np.testing.assert_allclose(condensed.stiffness, at.force(at.pose, **at.conditions)[1], rtol=1e-9, atol=1.0)
    found = []
    for part in (PART, -PART):
        sides = {}
        for i, side in enumerate(("inner", "outer")):
            law, rest = getattr(at.force.law, side), at.loads.approach[i, 0]
            sides[side] = law._replace(centre=(law.centre + part * rest) / (1 + part), scale=law.scale / (1 + part))
        other = BallForce(at.force.geometry, dataclasses.replace(at.force.law, **sides))
        found.append(other(at.pose, **at.conditions)[1:])
    by_hand = (np.array(found[0]) - np.array(found[1])) / (2.0 * PART)
    for hand, changes in zip(by_hand, condensed.changes_of_slow_motion, strict=True):
        size = np.abs(np.diag(hand))[[0, 1, 4]].max()
        np.testing.assert_allclose(changes[condensed.direction("stiffness")], hand, atol=1e-5 * size)


def test_bands_are_told_and_dry_or_standing_bearings_have_none():
    scene = parse_scene(SCENE + PAIR, "rotor", "rotor.toml")
    model = assemble(scene, "table")
    result = modes(model, Operation(scene.speed))
    # the table states about 1 % of k and c: half of that of a frequency at most, and some by thicker films, with heat
    # in the inlet a third of its effect besides
    part = result.modes.bands.frequency / result.modes.frequency
    assert part.min() > 0.0 and part.max() < 0.03
    assert "film table of points" in result.dataset.attrs["bands"]
    assert law_changes(model, [scene.speed]) is None
    assert modes(model, Operation(0.0)).modes.bands is None
    dry = modes(assemble(scene, "hertz:1e-5 s"), Operation(scene.speed))
    assert dry.modes.bands is None and dry.dataset.attrs["bands"] == NO_MAP


def test_rings_in_their_clearance_hardly_have_bands():
    """Films fill some of the gap: all loads are tiny, and nothing divides by them."""
    model = assemble(
        parse_scene(SCENE + PAIR.replace("6 um", "-2 um").replace("--", ""), "rotor", "rotor.toml"), "table"
    )
    element = model.system.elements[model.system.select(OnRings)[0]].element
    condensed = element.small_motions(np.zeros(6), Operation(model.scene.speed))
    assert np.all(np.isfinite(condensed.changes(np.array([1j, 1e4j]))))
    assert np.all(np.isfinite(condensed.stated.forces))


def test_springs_of_balls_leave_out_what_the_table_holds_besides():
    """Beside the table's own reader; straight between 8 frequencies an octave: a quarter of 7e-4 of Z, that of 4."""
    geometry = ball_estimate("6208")
    response = ball_films(geometry, Lubricant.named("FVA3"), 4.0, 333.15, solves=False).inner.response
    node = response.loads.size // 2
    films, load = response.films, response.loads[node : node + 1]
    one = {name: getattr(films, name)[[node]] for name in ("stiffness", "damping", "frequencies")}
    one |= {name: getattr(films, f"{name}")[[node]] for name in ("response_stiffness", "response_damping")}
    errors = {name: part[[node]] for name, part in films.errors.items()}
    frequencies = np.array([0.1, 0.5, 0.9, 1.7, 3.1, 6.0, 7.9]) * 2.0 * films.frequencies[node, 0]
    table = read_response(SimpleNamespace(**one, errors=errors), frequencies)
    s = 2j * np.pi * frequencies
    springs = response.springs(load)
    own = one["stiffness"] + one["damping"] * (s[:, None] / (1.0 + s[:, None] * springs.times)) @ springs.shares[0]
    held = table.stiffness + s * table.damping
    part, doubt = response.left_out(load, s)
    np.testing.assert_allclose(own * (1.0 + part[:, 0]), held, rtol=2e-4)
    # the table's errors of k and c of slow motion are in bands already: less than what the reader states, never below 0
    stated = np.hypot(table.stiffness_error * table.stiffness, table.damping_error * held.imag) / np.abs(held)
    assert np.all(doubt[:, 0] >= 0.0) and np.all(doubt[:, 0] < stated)
    # slow motion is exact, and beyond the table part and doubt together grow with the frequency
    far = [sum(np.abs(side[0, 0]) for side in response.left_out(load, way * s[-1:])) for way in (10.0, 20.0)]
    np.testing.assert_allclose(far[1], 2.0 * far[0], rtol=1e-12)
    assert abs(response.left_out(load, 1e-6 * s)[0][0, 0]) < 1e-12


@pytest.mark.parametrize("films", ["memory", "slow"])
def test_estimated_errors_of_films_of_balls(films):
    """Along the load beside Z of contacts that have a thousandth of the part, and springs that are all or none."""
    scene = parse_scene(SCENE + PAIR, "rotor", "rotor.toml")
    model, operation = assemble(scene, "table", films=films), Operation(scene.speed)
    balance = equilibrium(model.system, operation)
    entry, _ = film_errors(model, balance.displacement, operation)
    frequencies = np.array([500.0, 4000.0])
    s = 2j * np.pi * frequencies
    connected = model.system.elements[model.system.select(OnRings)[0]]
    ports = connected.transform @ balance.displacement
    condensed = connected.element.small_motions(ports, operation)
    force = balance.forces[model.system.select(OnRings)[0]]
    along = np.r_[force[:3] / np.linalg.norm(force[:3]), 0.0, 0.0, 0.0]

    def stiffness(factors, at):
        whole = dataclasses.replace(condensed, contacts=condensed.contacts._replace(stiffness=factors))
        before, after, z = whole._ends(at, *whole._whole)
        before, after = before @ along, after @ along
        felt = [whole.contacts.feel @ side[..., None] for side in (before, after)]
        by_contacts = (z * felt[0][..., 0] * felt[1][..., 0]).sum(axis=(1, 2))
        return by_contacts + np.einsum("kzm,zmn,kzn->k", before, whole.contacts.turning, after)

    part, doubt = condensed.left_out(s)
    k = condensed.contacts.stiffness
    z = condensed._ends(s, *condensed._whole)[2]
    for i, at in enumerate(s):
        step = 1e-3
        own, changed, wrong = (
            stiffness(k + step * change, s[i : i + 1])[0]
            for change in (0.0 * k, z[i] * part[i], np.abs(z[i]) * doubt[i])
        )
        missing, possible = (changed - own) / step, abs(wrong - own) / step
        relaxed = connected.element.film_relaxation(ports, operation).more(s[i : i + 1])[0]
        besides = along @ relaxed @ along if films == "slow" else 0.0
        expected = (abs(missing + besides) + possible) / abs(own + missing)
        # first order in a part of up to 3 % by a thousandth, and traction that is symmetric in the springs
        assert entry.error(frequencies)[i] == pytest.approx(expected, rel=2e-3), at
    assert entry.error(np.array([1e-3]))[0] < 1e-6


def test_what_films_leave_out_moves_modes_and_responses():
    """The parts of both bearings by null vectors of Z, and by Z with a thousandth of them more."""
    base = Base(PAIR, "memory")
    balance, laws, step = base.balance, base.laws, 1e-3
    bearings = tuple(
        dataclasses.replace(one, condensed=dataclasses.replace(one.condensed, left_out=Without(one.condensed.left_out)))
        for one in laws.films.bearings
    )
    films = dataclasses.replace(laws.films, bearings=bearings)

    def missing(s):
        every = np.eye(6, dtype=np.complex128)[None]
        return sum(one.transform.T @ one.left_out(s, every, every)[0] @ one.transform for one in bearings)

    found, doubt = films.eigenvalue_changes(base.values, base.shapes, base.left)
    assert not np.any(doubt) and np.any(laws.films.eigenvalue_changes(base.values, base.shapes, base.left)[1])
    for value, change in zip(base.values, found, strict=True):
        s = np.array([value])
        left, _, right = np.linalg.svd(dynamic_stiffness(balance, s)[0])
        left, right = left[:, -1].conj(), right[-1].conj()
        slope = left @ dynamic_slope(balance, s)[0] @ right
        assert change == pytest.approx(-(left @ missing(s)[0] @ right) / slope, rel=1e-4)  # eigenvectors of few states
    s = 2j * np.pi * FREQUENCIES
    sizes = []
    for part in (step, -step):
        whole = dynamic_stiffness(balance, s) + part * missing(s)
        motion = np.linalg.solve(whole, input_matrix(balance, base.scene.inputs)[None].astype(np.complex128))
        sizes.append(np.abs(s[:, None, None] ** 2 * (sensor_matrix(balance, base.scene.sensors) @ motion)))
    only = dataclasses.replace(laws, films=films)
    by_films = only.of_responses(FREQUENCIES, base.motion, base.back, base.direct)[1]
    # splines between 12 places a decade: the part has kinks where it is read straight
    np.testing.assert_allclose(by_films, np.abs(sizes[0] - sizes[1]) / (2.0 * step), atol=1e-2 * by_films.max())


class Without:
    """What films leave out, without its possible error."""

    def __init__(self, left_out):
        self.left_out = left_out

    def __call__(self, s):
        part, doubt = self.left_out(s)
        return part, np.zeros_like(doubt)

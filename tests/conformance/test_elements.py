"""Claims on the bearing of each kind as an element: derivatives, work, lift-off, memory, extremes of speed, no numbers.

Each claim is a function of a kind; where it is red for one, the kind is wrong.
"""

from __future__ import annotations

import functools
import math
from typing import NamedTuple

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from mbs import assemble, parse_scene
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from tests.cases.programs import DOES_NOT_APPLY
from tests.conformance.machines import KINDS

DRY, FILMS = "hertz:1.25e-5 s", "table"
SPEED = 150.0
"""[rad/s]"""

RPM = math.pi / 30.0


class Bench(NamedTuple):
    """The first bearing of a machine, the displacements of its ports at rest, and the operation."""

    element: object
    rest: np.ndarray
    operation: Operation

    def force(self, displacement, velocity=0.0):
        return self.element.evaluate(displacement, velocity + np.zeros_like(displacement), self.operation).force

    @property
    def free(self):
        """Displacements at which nothing touches."""
        free = np.zeros_like(self.rest)
        free[0] = -getattr(self.element, "axial_offset", 0.0)
        return free


@functools.cache
def model(kind, law):
    return assemble(parse_scene(kind.text(), "machine", "machine.toml"), law if kind.films else DRY)


@functools.cache
def bench(kind, law, speed):
    system, operation = model(kind, law).system, Operation(speed)
    connected = system.elements[0]
    rest = equilibrium(system, operation, tolerance=1e-12).displacement
    return Bench(connected.element, connected.transform @ rest, operation)


def quotients(call, steps):
    """Central differences of a function of the ports about zero, by column."""
    columns = []
    for i, step in enumerate(steps):
        way = np.zeros(steps.size)
        way[i] = step
        columns.append((call(way) - call(-way)) / (2.0 * step))
    return np.array(columns).T


def derivatives(kind):
    """K and C are difference quotients. Steps of 2 nm leave 1e-4 where slices and balls bend, and the cage of a fast
    ball bearing follows its contact angles, of which K knows nothing: 1e-3."""
    for law, speed, within in ((DRY, 0.0, 2e-4), (FILMS, SPEED, 2e-3)):
        at = bench(kind, law, speed)
        answer = at.element.evaluate(at.rest, np.zeros_like(at.rest), at.operation)
        steps = np.full(at.rest.size, 2e-9)
        steps[[3, 4, 5]] = 5e-8
        if at.rest.size > 6:
            steps[[9, 10, 11]] = 5e-8
        size = np.sqrt(np.abs(np.diag(answer.stiffness)))
        size = np.maximum(size, 1e-6 * size.max())
        found = -quotients(lambda way, at=at: at.force(at.rest + way), steps)
        assert np.max(np.abs(found - answer.stiffness) / np.outer(size, size)) < within
        found = -quotients(lambda way, at=at: at.force(at.rest, way), 1e3 * steps)
        size = np.sqrt(np.abs(np.diag(answer.damping)))
        size = np.maximum(size, 1e-6 * size.max())
        assert np.max(np.abs(found - answer.damping) / np.outer(size, size)) < within


def definite(kind):
    """At rest and dry: the force has a convex potential, and dampers take power. Round-off of the balances."""
    at = bench(kind, DRY, 0.0)
    answer = at.element.evaluate(at.rest, np.zeros_like(at.rest), at.operation)
    for matrix in (answer.stiffness, answer.damping):
        size = np.sqrt(np.abs(np.diag(matrix)))
        size[size == 0.0] = 1.0
        scaled = matrix / np.outer(size, size)
        assert np.max(np.abs(scaled - scaled.T)) < 1e-8
        assert np.linalg.eigvalsh(0.5 * (scaled + scaled.T)).min() > -1e-8


def closed_paths(kind):
    """Around a loop at rest, on which contacts part and come back, forces do no work; error of the trapezoids. With
    dampers the same loop takes energy at each step."""
    at, turn = bench(kind, DRY, 0.0), 2.0 * math.pi / 1000 * np.arange(1001)
    path = at.free + np.outer(0.5 * (1.0 + np.cos(turn)), at.rest - at.free)
    path[:, 1] += 15e-6 * np.sin(turn)
    path[:, 2] += 10e-6 * np.sin(2.0 * turn + 0.3)
    path[:, 5] += 1e-4 * np.sin(turn + 1.0)
    answers = [at.element.evaluate(place, np.zeros_like(place), at.operation) for place in path]
    forces, moved = np.array([answer.force for answer in answers]), np.diff(path, axis=0)
    work = np.sum(0.5 * (forces[1:] + forces[:-1]) * moved, axis=1)
    assert np.abs(work).sum() > 1e-6
    assert abs(work.sum()) < 1e-4 * np.abs(work).sum()
    taken = [step @ answer.damping @ step for step, answer in zip(moved, answers[1:], strict=True)]
    assert min(taken) >= -1e-12 * max(taken) and max(taken) > 0.0


def lifts_off(kind):
    """On the way to where nothing touches forces go to zero without a step: no more than K times the way."""
    at, places = bench(kind, DRY, 0.0), np.linspace(0.0, 1.0, 301)
    path = at.rest + np.outer(places, at.free - at.rest)
    answers = [at.element.evaluate(place, np.zeros_like(place), at.operation) for place in path]
    forces, way = np.array([answer.force for answer in answers]), (path[1] - path[0])
    steepest = max(np.abs(answer.stiffness @ way).max() for answer in answers)
    assert np.abs(forces[0]).max() > 50.0
    assert np.abs(np.diff(forces, axis=0)).max() < 1.1 * steepest
    assert np.abs(forces[-1]).max() < 1e-6 * np.abs(forces[0]).max()
    size = np.sqrt(np.abs(np.diag(answers[0].stiffness)))
    size[size == 0.0] = np.inf
    assert np.max(np.abs(answers[-1].stiffness) / np.outer(size, size)) < 1e-2


def remembers(kind):
    """Small oscillations in time have the Z(s) of linear analyses, K + s C + what relaxes, at a low and a high
    frequency: 80 steps a period leave 5e-4 of what relaxes, tables of springs the rest. Slow films are another law."""
    at = bench(kind, FILMS, SPEED)
    rest = at.element.evaluate(at.rest, np.zeros_like(at.rest), at.operation)
    relaxation = at.element.relaxation(at.rest, at.operation)
    direction = np.zeros_like(at.rest)
    direction[[1, 2]] = 1.0, 0.5
    size, count, periods = 1e-9, 80, 3
    differs = 0.0
    for frequency in (200.0, 4000.0):
        states, forces = None, []
        turns = 2.0 * math.pi / count * np.arange(periods * count + 1)
        for i, turn in enumerate(turns):
            time = i / (count * frequency)
            place = at.rest + size * math.sin(turn) * direction
            answer, states = at.element.advance(states, place, np.zeros_like(place), Operation(SPEED, 0.0, time))
            forces.append(answer.force)
        last = slice(-count, None)
        moved = np.array(forces)[last] - forces[0]
        found = -2j * np.exp(-1j * turns[last]) @ moved / (count * size)
        s = 2j * math.pi * frequency
        slow = (rest.stiffness + s * rest.damping) @ direction
        linear = slow + relaxation.more(np.array([s]))[0] @ direction
        assert np.max(np.abs(found - linear)) < 5e-3 * np.max(np.abs(linear)), frequency
        differs = max(differs, float(np.max(np.abs(slow - linear)) / np.max(np.abs(linear))))
    assert differs > 0.01


def creeps(kind):
    """From rest over 1e-3 rpm to 60 rpm there is a balance, and films fade to dry contacts: K is that at rest but
    for what tables of lines leave out below 100 N/m: of slices that hardly touch, 1 %."""
    system = model(kind, FILMS).system
    found = []
    for rpm in (0.0, 1e-3, 1.0, 60.0):
        balance = equilibrium(system, Operation(rpm * RPM))
        assert np.all(np.isfinite(balance.displacement))
        found.append(np.diag(balance.element_stiffness[0])[:6])
    rest, slow = found[0], found[1]
    assert np.max(np.abs(slow - rest) / np.abs(rest).max()) < 1e-2
    assert np.all(np.array(found)[:, 1] > 0.0)


def refuses_no_numbers(kind):
    """A motion that is no number is called so, by every kind, and not a preload that is lost."""
    for law in (DRY, FILMS):
        at = bench(kind, law, SPEED)
        for ask in (at.element.evaluate, functools.partial(at.element.advance, None)):
            wrong = at.rest.copy()
            wrong[1] = math.nan
            with pytest.raises((AnalysisError, InputError), match="finite"):
                ask(wrong, np.zeros_like(wrong), at.operation)


def goes_on_after_a_refusal(kind):
    """A refused call leaves no trace: the next one has the force of a bearing that was never asked."""
    at = bench(kind, DRY, 0.0)
    before = at.force(at.rest)
    wrong = at.rest.copy()
    wrong[2] = math.inf
    with pytest.raises((AnalysisError, InputError)):
        at.force(wrong)
    np.testing.assert_allclose(at.force(at.rest), before, rtol=1e-9, atol=1e-9 * np.abs(before).max())


def forgets_what_was_asked(kind):
    """Statics, and the force, K and C there, are to the last digit those of a machine that was asked nothing before. A
    call at one pose starts from where the last one left the elements: round-off of their balances, which K and C have
    some thousand times."""
    law, operation = FILMS if kind.films else DRY, Operation(SPEED)

    def answers(system):
        rest = equilibrium(system, operation).displacement
        place = system.elements[0].transform @ rest
        return place, (rest, *system.elements[0].element.evaluate(place, 0.0 * place, operation)[:3])

    text = parse_scene(kind.text(), "machine", "machine.toml")
    new, asked = assemble(text, law).system, assemble(text, law).system
    place, expected = answers(new)
    for speed, part in ((20.0, 1.0), (0.0, 0.5), (2.0 * SPEED, 0.7)):
        rest = equilibrium(asked, Operation(speed)).displacement
        for one in asked.elements:
            where = part * (one.transform @ rest)
            one.element.evaluate(where, 0.0 * where, Operation(speed, 0.2))
    for alone, after in zip(
        new.elements[0].element.evaluate(place, 0.0 * place, operation)[:3],
        asked.elements[0].element.evaluate(place, 0.0 * place, operation)[:3],
        strict=True,
    ):
        np.testing.assert_allclose(after, alone, rtol=0.0, atol=1e-11 * np.abs(alone).max())
    for alone, after in zip(expected, answers(asked)[1], strict=True):
        np.testing.assert_array_equal(after, alone)


def passes(kind):
    """A part of a pitch further on it is the bearing of the machine that has turned so far, in films and forces."""
    at = bench(kind, FILMS, SPEED)
    part, still = 0.3, np.zeros_like(at.rest)
    turned = at.operation._replace(angle=part * 2.0 * math.pi / at.element.excitation.order)
    expected = at.element.evaluate(at.rest, still, turned).force
    if kind.name == "rollers as bodies":  # a mean over cage angles would make one of a loaded roller and a free one
        assert at.element.passed(part) is at.element
        return
    found = at.element.passed(part).evaluate(at.rest, still, at.operation).force
    # of balls and tapered rollers under preload the force hardly knows where they stand
    assert np.abs(found - expected).max() < 1e-3 * np.abs(found - at.force(at.rest)).max()


CLAIMS = (
    derivatives,
    definite,
    closed_paths,
    lifts_off,
    remembers,
    creeps,
    refuses_no_numbers,
    goes_on_after_a_refusal,
    forgets_what_was_asked,
    passes,
)
WITH_CONTACTS = (definite, closed_paths, lifts_off, remembers, creeps, passes)
"""Claims that bearings by matrices do not make: they have no contacts, and may do work on closed paths."""


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: claim.__name__)
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_claim(kind, claim):
    if not kind.films and claim in WITH_CONTACTS:
        pytest.skip(f"{DOES_NOT_APPLY}: by matrices, no contacts")
    claim(kind)

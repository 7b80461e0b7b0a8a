"""An element of one's own, defined here: in compiled runs by a block of its own, and from Python without one."""

from __future__ import annotations

import ctypes
import dataclasses
import math
import os
import subprocess
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numba import cfunc, types

from ehdmaps.errors import AnalysisError
from ehdmaps.kernel import building
from ehdmaps.kernel.record import Record, integers, numbers
from mbs.bearings.bearing_element import RingElement
from mbs.model.blocks import FOUND, NO_SOLUTION, Kind, SteadyBlock
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import ElementDefaults, Forces, Load, Port, Sensor, Spring
from mbs.model.profiles import Harmonic, SpeedProfile
from mbs.model.system import System
from mbs.output.results import run_dataset
from mbs.settings import Settings
from mbs.transient.kinds import KINDS, kind_of
from mbs.transient.run import Options, run

Y, Z = np.eye(6)[1], np.eye(6)[2]
MASS = Inertia(2.0, 0.01, 0.02)


class Cubic(ElementDefaults):
    """A spring along y, f = -(k y + b y^3) (1 + part sin angle), with a damper: it follows the angle of the system."""

    def __init__(self, name, on, against="ground", k=1e5, b=1e13, c=40.0, part=0.3):
        self.name, self.ports = name, (Port(on, against),)
        self.k, self.b, self.c, self.part = k, b, c, part

    def evaluate(self, displacement, velocity, operation):
        y, factor = displacement[1], 1.0 + self.part * math.sin(operation.angle)
        force = -(self.k * y + self.b * y**3) * factor - self.c * velocity[1]
        slope = (self.k + 3.0 * self.b * y * y) * factor
        return Forces(force * Y, slope * np.outer(Y, Y), self.c * np.outer(Y, Y), bool(abs(y) > 2e-4))


class Cubics(NamedTuple):
    """Cubic springs as arrays; `numbers` has k, b, c, part."""

    firsts: np.ndarray
    places: np.ndarray
    numbers: np.ndarray


def cubics_answer(cubics, moment, motion, answers):
    """Forces and slopes, in Python."""
    for i in range(cubics.firsts.size):
        first = cubics.firsts[i]
        k, b, c, part = cubics.numbers[i, 0], cubics.numbers[i, 1], cubics.numbers[i, 2], cubics.numbers[i, 3]
        y, rate = motion[0, first], motion[1, first]
        if not abs(y) < 1.0:
            return NO_SOLUTION
        factor = 1.0 + part * math.sin(moment.angle)
        answers.force[first] = -(k * y + b * y**3) * factor - c * rate
        answers.slopes[first, first] = moment.by_q * (k + 3.0 * b * y * y) * factor + moment.by_v * c
        answers.outside[cubics.places[i]] += abs(y) > 2e-4
    return FOUND


def gathered(members):
    """The block of some springs."""
    return SteadyBlock(
        Cubics(
            np.array([member.first for member in members], dtype=np.int64),
            np.array([member.place for member in members], dtype=np.int64),
            np.array([[m.element.k, m.element.b, m.element.c, m.element.part] for m in members]).reshape(-1, 4),
        )
    )


CUBICS = Kind(answer=cubics_answer, feels=lambda element: Y[None, :], gather=gathered)


class CubicsInC(Record):
    """Cubic springs as C has them."""

    _fields_ = (("count", ctypes.c_int64), ("firsts", integers), ("places", integers), ("numbers", numbers))


def gathered_for_c(members):
    """The block of some springs."""
    cubics = gathered(members).arrays
    return SteadyBlock(CubicsInC(count=cubics.firsts.size, **cubics._asdict()))


IN_C = r"""
#include "run/block.h"

typedef struct cubics { int64_t count, *firsts, *places; double *numbers; } cubics;

int cubics_answer(void *data, const ehd_moment *at, const double *motion, ehd_answers *answers) {
    const cubics *all = data;
    for (int64_t i = 0; i < all->count; i++) {
        const int64_t first = all->firsts[i];
        const double *n = all->numbers + 4 * i, y = motion[first], rate = motion[answers->m + first];
        const double factor = 1.0 + n[3] * sin(at->angle);
        if (!(fabs(y) < 1.0)) return EHD_NO_SOLUTION;
        answers->force[first] = -(n[0] * y + n[1] * y * y * y) * factor - n[2] * rate;
        answers->slopes[first * (answers->m + 1)] = at->by_q * (n[0] + 3.0 * n[1] * y * y) * factor + at->by_v * n[2];
        answers->outside[all->places[i]] += fabs(y) > 2e-4;
    }
    return EHD_FOUND;
}
"""


@pytest.fixture(scope="module")
def in_c(tmp_path_factory):
    """Cubic springs in C, compiled with the header of blocks."""
    folder = tmp_path_factory.mktemp("cubics")
    (folder / "cubics.c").write_text(IN_C, encoding="ascii")
    compiler = building.usable_compiler(os.environ)
    options = [f"-I{building.SOURCES}", "-std=c99", "-O2", "-shared", "-fPIC", "cubics.c", "-o", "cubics.so", "-lm"]
    subprocess.run([*compiler, *options], cwd=folder, check=True)
    answer = ctypes.CDLL(str(Path(folder) / "cubics.so")).cubics_answer
    return dataclasses.replace(CUBICS, answer=answer, gather=gathered_for_c)


def gathered_for_numba(members):
    """The block of some springs, as one row of numbers: how many, m, and of each first, place, k, b, c, part."""
    cubics = gathered(members).arrays
    rows = np.column_stack((cubics.firsts, cubics.places, cubics.numbers))
    return SteadyBlock(np.concatenate(([rows.shape[0], members[0].among], rows.ravel())))


@pytest.fixture(scope="module")
def in_numba():
    """Cubic springs by `numba.cfunc`: structs are read as the pointers and numbers that they begin with."""
    number = types.CPointer(types.float64)

    @cfunc(types.int32(number, number, number, types.CPointer(number)))
    def answer(data, at, motion, answers):
        force, slopes, m = answers[0], answers[1], int(data[1])
        for i in range(int(data[0])):
            first, k, b, c, part = (
                int(data[2 + 6 * i]),
                data[4 + 6 * i],
                data[5 + 6 * i],
                data[6 + 6 * i],
                data[7 + 6 * i],
            )
            y, factor = motion[first], 1.0 + part * math.sin(at[3])
            if not abs(y) < 1.0:
                return NO_SOLUTION
            force[first] = -(k * y + b * y**3) * factor - c * motion[m + first]
            slopes[first * (m + 1)] = at[4] * (k + 3.0 * b * y * y) * factor + at[5] * c
        return FOUND

    return dataclasses.replace(CUBICS, answer=answer, gather=gathered_for_numba)


SENSORS = (Sensor("y", "a", Y), Sensor("z", "b", Z, "acceleration"))
SETTINGS = Settings(2e-5, 1e-4, residual=1e-13)
RAMP = SpeedProfile.ramp(20.0, 200.0, 0.1)


@pytest.fixture
def known(monkeypatch):
    """The kind is listed."""
    monkeypatch.setitem(KINDS, Cubic, CUBICS)


def machine(cubic=Cubic):
    """Two bodies, one spring of one's own to the ground and one between them."""
    bodies = [rigid_body(name, [MASS], ["y", "z"]) for name in ("a", "b")]
    springs = [Spring(f"s{name}", name, "ground", np.diag([0.0, 1e4, 2e6, 0.0, 0.0, 0.0])) for name in ("a", "b")]
    shaker = Load("shaker", "a", 150.0 * (Y + 0.2 * Z), profile=Harmonic(60.0))
    return System(bodies, springs, [shaker], [cubic("first", "a"), cubic("second", "b", "a", k=3e5)])


@pytest.mark.parametrize("way", ["python", "in_c", "in_numba"])
def test_a_block_of_ones_own_runs_compiled_as_python_does(way, monkeypatch, request):
    """Both make the same steps; they differ by what Newton leaves over, 1e-13 of the forces, grown over the run."""
    monkeypatch.setitem(KINDS, Cubic, CUBICS if way == "python" else request.getfixturevalue(way))
    system = machine()
    compiled, reference = (
        run(system, RAMP, 0.03, SETTINGS, SENSORS, options=Options(compiled=c)) for c in (True, False)
    )
    assert compiled.compiled == compiled.steps == reference.steps == 1500
    assert (reference.compiled, compiled.notes, reference.notes) == (0, (), ())
    for found in (
        reference,
        *((compiled,) if way != "in_numba" else ()),
    ):  # evaluations beyond 0.2 mm; both begin Newton elsewhere, so not as many
        assert 0 < found.outside["second"] < found.outside["first"] <= found.iterations
    pairs = zip(
        (*compiled.signals.T, *compiled.forces, *compiled.motions),
        (*reference.signals.T, *reference.forces, *reference.motions),
        strict=True,
    )
    for got, wanted in pairs:
        np.testing.assert_allclose(got, wanted, rtol=0.0, atol=1e-9 * np.abs(wanted).max())
    linear = run(machine(lambda *a, **k: Cubic(*a, **{**k, "b": 0.0})), RAMP, 0.03, SETTINGS, SENSORS)
    assert np.abs(linear.signals[:, 0] - compiled.signals[:, 0]).max() > 0.1 * np.abs(compiled.signals[:, 0]).max()


def test_without_a_block_it_runs_in_python_and_says_so():
    found = run(machine(), RAMP, 2e-3, SETTINGS, SENSORS)
    assert found.compiled == 0
    (note,) = found.notes
    assert note == (
        "first (Cubic), second (Cubic): no compiled block, so every step runs in Python, which is many times slower; a "
        "kind of element gets one by mbs.transient.kinds"
    )


def test_it_is_no_bearing():
    system = machine()
    assert system.select(RingElement) == ()
    assert system.select(Cubic) == (0, 1)
    dataset = run_dataset(system, run(system, RAMP, 1e-3, SETTINGS, options=Options(states=True)))
    assert dataset.sizes["bearing"] == 0


def test_a_class_that_inherits_is_another_kind(known):
    """Its forces may be others: they are not taken for those of its parent."""

    class Harder(Cubic):
        pass

    assert kind_of(Cubic("c", "a")) is CUBICS
    assert kind_of(Harder("c", "a")) is None


def test_what_a_python_function_raises_ends_the_run(monkeypatch):
    def raises(cubics, moment, motion, answers):
        raise KeyError("no such spring")

    monkeypatch.setitem(KINDS, Cubic, dataclasses.replace(CUBICS, answer=raises))
    with pytest.raises(KeyError, match="no such spring"):
        run(machine(), RAMP, 1e-3, SETTINGS)


@pytest.mark.parametrize("way", ["accept", "powers"])
def test_python_functions_are_told_of_steps(way, monkeypatch):
    """Of each one in turn; what they raise ends the run."""
    times = []

    def told(cubics, moment, *more):
        times.append(moment.time)
        if way == "powers":
            more[2][:, :2] = 1.0, 2.0
        if moment.time > 6e-4:
            raise ValueError("enough")

    class Stateful(SteadyBlock):
        def states(self):
            return [None, None]

        def resume(self, states):
            pass

    monkeypatch.setitem(
        KINDS, Cubic, dataclasses.replace(CUBICS, gather=lambda m: Stateful(gathered(m).arrays), **{way: told})
    )
    system = machine()
    with pytest.raises(ValueError, match="enough"):
        run(system, RAMP, 1e-2, SETTINGS)
    np.testing.assert_allclose(times, 2e-5 * np.arange(1, len(times) + 1), rtol=1e-12)
    assert len(times) >= 30
    if way == "powers":
        energy = run(system, RAMP, 4e-4, SETTINGS).energy
        assert energy.elements[0].driven is None  # it does not say what it stores


def test_a_compiled_step_without_answer_is_halved(known):
    """The spring is thrown further than it has an answer for: no step of any size leads back."""
    with pytest.raises(AnalysisError, match="no solution at"):
        run(machine(), RAMP, 1e-2, SETTINGS, velocity=np.array([1e6, 0.0, 0.0, 0.0]))

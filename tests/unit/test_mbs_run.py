"""Runs: what is recorded, what is refused, what counts; the parts of the compiled loop."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.linalg

from ehdmaps.errors import AnalysisError, InputError, OutsideMapError
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_block import Films
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.cylinder import LawNumbers
from mbs.bearings.laws import FlatLaw, hertz
from mbs.bearings.speed_tables import NODES, STEP, SpeedTables, SpeedWindow
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import ElementDefaults, Forces, Load, Operation, Port, Sensor, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.model.system import System
from mbs.settings import Settings
from mbs.transient.compiled_run import LinearPart
from mbs.transient.kinds import kind_of
from mbs.transient.run import CHUNK, Options, run
from mbs.transient.stepping import Method
from tests.cases.bearings import TEMPERATURE, integrate, map_law
from tests.cases.c_functions import eliminate

REST = SpeedProfile.constant(0.0)
MASS = Inertia(2.0, 0.01, 0.02)
OMEGA = 500.0


def along(**freedoms):
    order = ("x", "y", "z", "theta_x", "theta_y", "theta_z")
    return np.array([freedoms.get(key, 0.0) for key in order])


def oscillator(loads=(), elements=()):
    spring = Spring("s", "a", "ground", np.diag(along(y=2.0 * OMEGA**2, z=1e6)))
    return System([rigid_body("a", [MASS], ["y", "z"])], [spring], loads, elements)


def shaft(law=None, load=500.0, clearance=20e-6):
    """A shaft on one bearing, held against tilting."""
    bearing = Bearing.named("NU308", clearance=clearance).with_slices(15)
    force = BearingForce(bearing, law or hertz(bearing, 100.0))
    element = BearingElement("bearing", "shaft", "ground", bearing, force, TEMPERATURE)
    body = rigid_body("shaft", [MASS], ["y", "z", "theta_y", "theta_z"], spin=1.0)
    held = Spring("held", "shaft", "ground", np.diag(along(y=1e4, z=1e4, theta_y=1e5, theta_z=1e5)))
    return System([body], [held], [Load("weight", "shaft", along(y=load))], [element])


class Foreign(ElementDefaults):
    """An element that compiled code does not know: a spring in y."""

    name = "foreign"
    ports = (Port("a"),)

    def evaluate(self, displacement, velocity, operation):
        K = np.diag(along(y=1e5))
        return Forces(-K @ displacement, K, np.zeros((6, 6)))


class TestRecording:
    def test_sensors_see_what_they_say(self):
        sensors = [
            Sensor("d", "a", along(y=1.0)),
            Sensor("v", "a", along(y=2.0), "velocity"),
            Sensor("a", "ground", along(y=1.0), "acceleration", against="a"),
        ]
        start = np.array([1e-3, -2e-3])
        found = run(oscillator(), REST, 0.01, Settings(1e-4, 2e-4), sensors, start)
        whole = integrate(oscillator(), REST, 0.01, Settings(1e-4, 2e-4), start)
        expected = (
            whole.states.displacement[:, 0],
            2.0 * whole.states.velocity[:, 0],
            -whole.states.acceleration[:, 0],
        )
        np.testing.assert_allclose(found.signals, np.stack(expected, axis=1), rtol=1e-12, atol=1e-18)
        np.testing.assert_allclose(found.time, np.arange(51) * 2e-4, rtol=1e-14)
        assert found.forces == ()
        assert found.motions == ()
        assert found.outside == {}
        assert (found.steps, found.halved, found.compiled, found.notes) == (100, 0, 100, ())

    def test_elements_in_their_ports(self):
        system = shaft()
        start = equilibrium(system, Operation(50.0)).displacement
        found = run(system, SpeedProfile.constant(50.0), 2e-3, Settings(2e-5, 1e-4), (), start)
        whole = integrate(system, SpeedProfile.constant(50.0), 2e-3, Settings(2e-5, 1e-4), start)
        transform = system.elements[0].transform
        np.testing.assert_allclose(found.motions[0], whole.states.displacement @ transform.T, rtol=1e-12, atol=1e-20)
        np.testing.assert_array_equal(found.forces[0], whole.forces[0])
        element = system.elements[0].element
        for i in (0, 7, 20):
            operation = Operation(50.0, found.angle[i], found.time[i])
            force, _, _, _ = element.evaluate(found.motions[0][i], transform @ whole.states.velocity[i], operation)
            np.testing.assert_allclose(found.forces[0][i], force, rtol=1e-8, atol=1e-8 * 500.0)  # Newton leaves 1e-10

    @pytest.mark.parametrize("per_sample", [1, 7, CHUNK + 3])
    def test_samples_lie_anywhere_in_the_chunks(self, per_sample):
        h = 1e-5
        duration = 2.0 * per_sample * h if per_sample > CHUNK else 300 * per_sample * h
        seen = []
        found = run(
            oscillator(), REST, duration, Settings(h, per_sample * h, 1.0), [Sensor("d", "a", along(y=1.0))],
            np.array([1e-3, 0.0]), progress=seen.append,
        )  # fmt: skip
        # The trapezoidal rule turns the phase by 2 atan(omega h/2) a step.
        phase = 2.0 * math.atan(0.5 * OMEGA * h) * per_sample * np.arange(found.time.size)
        np.testing.assert_allclose(found.signals[:, 0], 1e-3 * np.cos(phase), atol=1e-11)
        assert seen == list(range(1, found.time.size))

    def test_elements_that_are_not_known_run_in_python(self):
        system = oscillator(elements=[Foreign()])
        assert kind_of(system.elements[0].element) is None
        found = run(
            system, REST, 0.01, Settings(1e-4, 1e-3, 1.0), [Sensor("d", "a", along(y=1.0))], np.array([1e-3, 0])
        )
        assert found.compiled == 0
        (note,) = found.notes
        assert note.startswith("foreign (Foreign): no compiled block, so every step runs in Python")
        phase = 2.0 * math.atan(0.5 * math.sqrt(OMEGA**2 + 5e4) * 1e-4) * 10 * np.arange(11)
        np.testing.assert_allclose(found.signals[:, 0], 1e-3 * np.cos(phase), atol=1e-11)  # Newton's rest

    def test_springs_that_are_not_symmetric_run_in_python(self):
        """Cross-coupling, as of a seal: there are no real modes, and the mass whirls outwards."""
        cross = np.diag(along(y=2.0 * OMEGA**2, z=2.0 * OMEGA**2))
        cross[1, 2], cross[2, 1] = 1e4, -1e4
        system = System([rigid_body("a", [MASS], ["y", "z"])], [Spring("s", "a", "ground", cross)])
        sensors = [Sensor(key, "a", along(**{key: 1.0})) for key in ("y", "z")]
        found = run(system, REST, 0.2, Settings(1e-4, 1e-3, 1.0), sensors, np.array([1e-3, 0.0]))
        assert found.compiled == 0
        assert found.notes[0].startswith("the stiffness is not symmetric, so every step runs in Python")
        first_order = np.block([[np.zeros((2, 2)), np.eye(2)], [-cross[1:3, 1:3] / 2.0, np.zeros((2, 2))]])
        exact = np.array([scipy.linalg.expm(first_order * t)[:2, 0] * 1e-3 for t in found.time])
        assert np.abs(exact[-50:]).max() > 1.4e-3  # it grows
        # The trapezoidal rule is behind by (omega h)^2/12 of the phase: 0.02 rad at the end.
        np.testing.assert_allclose(found.signals, exact, atol=0.025 * 1.5e-3)


class TestRefusals:
    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            ({"duration": math.nan}, r"duration: got nan s; allowed: finite and > 0"),
            ({"duration": -1.0}, r"duration: got -1.0 s; allowed: finite and > 0"),
            ({"duration": math.inf}, r"duration: got inf s; allowed: finite and > 0"),
            ({"duration": 1e12}, r"sample: got 0.001 s over 1000000000000.0 s, which makes 1e\+15 samples"),
            ({"displacement": np.zeros(3)}, r"displacement: got \(3,\); allowed: 2 finite numbers"),
            ({"displacement": np.array([math.nan, 0.0])}, r"displacement: got numbers that are not finite"),
            ({"velocity": np.array([math.inf, 0.0])}, r"velocity: got numbers that are not finite"),
        ],
    )
    @pytest.mark.parametrize("compiled", [True, False])
    def test_hostile(self, arguments, message, compiled):
        given = {"duration": 0.01, **arguments}
        sensors = [Sensor("d", "a", along(y=1.0))]
        with pytest.raises(InputError, match=message):
            run(
                oscillator(), REST, settings=Settings(1e-3, 1e-3), sensors=sensors, options=Options(compiled=compiled),
                **given,
            )  # fmt: skip

    def test_a_run_that_leaves_all_reason(self):
        """A ring shot through its bearing: no step of any size has a solution within it."""
        system = shaft()
        with pytest.raises(AnalysisError, match=r"no solution at .* s with steps of"):
            run(system, REST, 0.1, Settings(1e-3, 1e-3), velocity=np.array([1e6, 0.0, 0.0, 0.0]))


class TestOutsideTheMap:
    def test_loads_above_the_map_are_counted_alike(self):
        """Each evaluation with a slice above the mapped load counts, in compiled code as in Python."""
        counts = []
        for compiled in (True, False):
            system = shaft(map_law(), load=2e5)
            start = equilibrium(system, Operation(60.0)).displacement
            settings = Settings(2e-5, 1e-4, residual=1e-13)
            found = run(
                system, SpeedProfile.constant(60.0), 4e-4, settings, (), start, options=Options(compiled=compiled)
            )
            counts.append(found)
        assert counts[0].compiled == counts[0].steps
        # Newton begins elsewhere, so that iterations differ; one more is that of the first acceleration.
        assert all(found.outside["bearing"] == found.iterations + 1 for found in counts)
        np.testing.assert_allclose(counts[0].forces[0], counts[1].forces[0], rtol=1e-9, atol=1e-4)

    def test_speeds_above_the_map_are_counted_in_compiled_code(self):
        system = shaft(map_law())
        fast = 1.2 * map_law().speed_range[1] / system.elements[0].element.rates[1]
        start = equilibrium(system, Operation(fast)).displacement
        for speed in (SpeedProfile.constant(fast), SpeedProfile.ramp(fast, 1.01 * fast, 1.0)):
            found = run(system, speed, 1e-3, Settings(2e-5, 1e-4), (), start)
            assert found.compiled == found.steps
            assert found.outside["bearing"] == found.iterations + 1 > found.steps  # one for the first acceleration

    def test_an_error_where_the_law_wants_one(self):
        system = shaft(map_law("error"))
        fast = 1.2 * map_law().speed_range[1] / system.elements[0].element.rates[1]
        with pytest.raises(OutsideMapError, match="entrainment_speed"):
            run(system, SpeedProfile.constant(fast), 1e-3, Settings(2e-5, 1e-4))
        with pytest.raises(OutsideMapError, match="entrainment_speed"):
            run(system, SpeedProfile.ramp(0.8 * fast, 5.0 * fast, 1e-2), 1e-2, Settings(2e-5, 1e-4))


class TestSpeedTables:
    def tables(self):
        bearing = Bearing.named("NU308", clearance=0.0).with_slices(5)
        tables = SpeedTables(bearing, FlatLaw(map_law()), TEMPERATURE, (1.0, 0.0))
        tables.cells, tables.numbers = np.zeros((NODES + 1, 2 * 448, 8)), np.zeros((NODES + 1, len(LawNumbers._fields)))
        return tables

    def test_places_are_straight_in_the_logarithm(self):
        speeds = np.array([0.5, -0.7, 0.7, 2.0])
        nodes, weights = self.tables().places(speeds)
        np.testing.assert_allclose((nodes + weights) * STEP, np.log(np.abs(speeds) / 0.3), atol=1e-12)
        assert np.all((weights >= 0.0) & (weights < 1.0))

    def test_window_is_as_wide_as_it_can_be(self):
        tables = self.tables()
        speeds = np.exp(np.arange(200) * 0.5 * STEP)
        nodes, weights = tables.places(speeds)
        done, looked = 0, 0
        while done < speeds.size:
            part = slice(done, None)
            slots, sound, outside = tables.prepare(speeds[part], nodes[part], weights[part])
            assert sound.all()
            assert not outside.any()
            np.testing.assert_array_equal(slots, nodes[done : done + slots.size] % NODES)
            done += slots.size
            looked += 1
        assert looked == math.ceil(100 / (NODES - 1))

    @pytest.mark.parametrize("jump", [0.3, 0.05, 3.0])
    def test_jumping_to_and_fro_keeps_no_stale_table(self, jump):
        """After any history the tables are those that a fresh start makes."""
        tables = self.tables()
        for base in (0.9, 0.9 * math.exp(jump * STEP * NODES), 0.9, 0.95, 0.9):
            speeds = base * np.exp(np.linspace(0.0, 0.3, 20) * STEP * NODES)
            nodes, weights = tables.places(speeds)
            slots, _, _ = tables.prepare(speeds, nodes, weights)
            fresh = self.tables()
            fresh.prepare(speeds, nodes, weights)
            for slot in {*slots.tolist(), *((slots + 1) % NODES).tolist()}:
                np.testing.assert_array_equal(tables.cells[slot], fresh.cells[slot])
                np.testing.assert_array_equal(tables.numbers[slot], fresh.numbers[slot])
            tables.prepare(*(np.full(1, value) for value in (base, 0, 0.0)))  # one speed alone, in between

    def test_a_faded_film_has_one_table(self):
        """Its weight is the part of the film, from which a call makes the same table at any speed below the map."""
        tables = self.tables()
        speeds = np.array([0.0, 1e-3, 0.2, 0.29, 0.31])
        nodes, weights = tables.places(speeds)
        films = Films([tables])
        slots, sound, _ = tables.prepare(speeds, nodes, weights)
        assert slots.tolist() == [NODES] * 4
        assert sound.all()
        element = BearingForce(Bearing.named("NU308", clearance=0.0).with_slices(5), map_law())
        for speed, weight in zip(speeds[1:4], weights[1:4], strict=True):
            own, (numbers, cells) = element.at(speed, TEMPERATURE), films.blend(0, NODES, weight)
            np.testing.assert_array_equal(numbers, own.numbers)
            np.testing.assert_array_equal(cells, own.cells)
        slots, sound, _ = tables.prepare(speeds[4:], nodes[4:], weights[4:])
        assert slots.size == 1
        assert sound.all()

    def test_nodes_are_even_in_the_speed_below_the_lowest(self):
        window = SpeedWindow(1e-3, 8, 0.3)
        speeds = np.array([0.0, 0.1, 0.3, 0.4])
        nodes, weights = window.places(speeds)
        np.testing.assert_allclose(
            (nodes + weights) * 1e-3, [-1.0, 0.1 / 0.3 - 1.0, 0.0, math.log(0.4 / 0.3)], atol=1e-12
        )
        np.testing.assert_allclose(
            [window.speed_of(node) for node in (-1000, -500, 0, 100)], [0.0, 0.15, 0.3, 0.3 * math.exp(0.1)]
        )


class TestAlgebra:
    def test_solve(self):
        rng = np.random.default_rng(2)
        for n in (0, 1, 2, 18):
            matrix, right = rng.normal(size=(n, n)), rng.normal(size=n)
            if n > 1:
                matrix[0, 0] = 0.0  # needs a pivot
            expected = np.linalg.solve(matrix, right)
            assert eliminate(matrix.copy(), right)
            np.testing.assert_allclose(right, expected, rtol=1e-9)

    @pytest.mark.parametrize("wrong", [0.0, math.nan, math.inf])
    def test_solve_says_that_it_cannot(self, wrong):
        assert not eliminate(np.full((2, 2), wrong), np.ones(2))

    def test_expansion_over_the_speed(self):
        """As good as it is said to be up to the speed to which it is said to be good, and wrong well beyond."""
        rng = np.random.default_rng(4)
        n, h = 12, 1e-4
        gyroscopic = rng.normal(size=(n, n)) * 0.5
        gyroscopic -= gyroscopic.T
        damping = np.diag(rng.uniform(0.0, 100.0, n))
        values = rng.uniform(0.0, 1e8, n)
        ports = rng.normal(size=(3, n))
        part = LinearPart(values, damping, gyroscopic, ports, np.zeros((0, n)), Method(0.8))
        speeds = np.linspace(20.0, 40.0, 4001)
        linear, count = part.about(h, speeds)
        assert 1 < count < speeds.size
        by_q, by_v = Method(0.8).weights(h)

        def error(speed):
            exact = np.linalg.inv(np.eye(n) + by_q * np.diag(values) + by_v * (damping + speed * gyroscopic))
            x, by, (zeroth, first, second) = rng.normal(size=n), speed - linear.reference, linear.given("inverse")
            out = (zeroth + by * (first + by * second)) @ x
            return np.linalg.norm(out - exact @ x) / np.linalg.norm(exact @ x)

        assert error(speeds[count - 1]) < 1e-12
        assert error(speeds[-1]) > 1e-12
        again, _ = part.about(h, speeds[:count])
        assert again is linear
        moved, further = part.about(h, speeds[count:])
        assert moved.reference > linear.reference
        assert further >= count

    def test_no_gyroscopic_terms_are_good_for_all_speeds(self):
        part = LinearPart(
            np.ones(2), np.zeros((2, 2)), np.zeros((2, 2)), np.ones((1, 2)), np.zeros((0, 2)), Method(0.8)
        )
        linear, count = part.about(1e-3, np.array([0.0, 1e6, -1e6]))
        assert count == 3
        assert not linear.turning

"""The shipped systems against closed forms, an independent bearing sum, momentum, energy, and themselves in time.

The bearing sum of ISO 16281 is written again here, with other code, so that the element and the assembly of the system
are both checked by it.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from scipy.linalg import eigh

from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.linearised.linear import frequency_response, responses
from mbs.linearised.modes import modes, undamped_modes
from mbs.linearised.sweep import sweep
from mbs.model.elements import ElementDefaults, Input, Load, Operation, Sensor
from mbs.model.equilibrium import equilibrium
from mbs.model.on_rings import ring_matrices
from mbs.model.profiles import Harmonic, SpeedProfile
from mbs.model.system import System
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene
from mbs.settings import Settings
from tests.cases.bearings import integrate

RPM = math.pi / 30.0
NU308 = read_scene("nu308_rigid")
RADIAL = np.array([0.0, 1.0, 1.0, 0.0, 0.0, 0.0]) / math.sqrt(2.0)
TANGENTIAL = np.array([0.0, 1.0, -1.0, 0.0, 0.0, 0.0]) / math.sqrt(2.0)


def with_slices(scene, slices):
    return scene.with_bearings(dataclasses.replace(entry, slices=slices) for entry in scene.bearings)


class IsoBearing:
    """ISO 16281 written out: c_L = 35948 L^(8/9) in N and mm, profile of DIN 26281, midpoint slices."""

    def __init__(self, rollers, diameter, length, slices, clearance=0.0):
        self.x = ((np.arange(slices) + 0.5) / slices - 0.5) * length
        self.lost = clearance / 2.0 - 2.0 * 0.00035 * diameter * np.log(1.0 - (2.0 * self.x / length) ** 2)
        self.phi = 2.0 * np.pi * np.arange(rollers) / rollers
        self.c = 35948.0 * (1e3 * length) ** (8.0 / 9.0) * 1e3 ** (10.0 / 9.0) / slices

    def approach(self, y, z, theta_y, theta_z):
        cos, sin = np.cos(self.phi)[:, None], np.sin(self.phi)[:, None]
        return np.maximum(y * cos + z * sin + self.x * (theta_z * cos - theta_y * sin) - self.lost, 0.0)

    def energy(self, pose):
        return float(np.sum(9.0 / 19.0 * self.c * self.approach(*pose) ** (19.0 / 9.0)))

    def radial_force(self, displacement, angle):
        """Force along a direction for a displacement along it."""
        along = np.cos(self.phi - angle)[:, None]
        delta = np.maximum(displacement * along - self.lost, 0.0)
        return float(np.sum(self.c * delta ** (10.0 / 9.0) * along))

    def stiffness(self, pose):
        """K of y z theta_y theta_z from second differences of the energy."""
        h = np.array([1e-10, 1e-10, 1e-8, 1e-8])
        K = np.empty((4, 4))
        for i in range(4):
            for j in range(4):
                di, dj = np.eye(4)[i] * h[i], np.eye(4)[j] * h[j]
                corners = [pose + di + dj, pose + di - dj, pose - di + dj, pose - di - dj]
                e = [self.energy(corner) for corner in corners]
                K[i, j] = (e[0] - e[1] - e[2] + e[3]) / (4.0 * h[i] * h[j])
        return K


@pytest.fixture(scope="module")
def film_models():
    """NU308 with the film formula, by clearance; the law is made once, as it takes some seconds."""
    loose = assemble(NU308, "formula", clearance=20e-6, films="slow")
    tight = assemble(NU308, "hertz")
    bearings = [
        dataclasses.replace(entry, force=BearingForce(entry.bearing, other.force.law))
        for entry, other in zip(tight.bearings, loose.bearings, strict=True)
    ]
    system = System(tight.system.bodies, NU308.springs, NU308.loads, bearings)
    return {0.0: dataclasses.replace(tight, system=system, bearings=tuple(bearings), law=loose.law), 20e-6: loose}


@pytest.fixture(scope="module")
def model(film_models):
    return film_models[20e-6]


class TestNU308:
    def test_equilibrium_is_the_preload(self):
        balance = equilibrium(assemble(NU308, "hertz").system, Operation(500 * RPM))
        for forces in balance.forces:
            # the springs of the rings carry nothing, and Newton leaves 1e-10
            np.testing.assert_allclose(forces[1:3], -100.0, rtol=1e-8)

    def test_place_and_stiffness_agree_with_the_independent_sum(self):
        balance = equilibrium(assemble(NU308, "hertz").system, Operation())
        iso = IsoBearing(12, 14e-3, 15e-3, 41)
        motion = balance.system.relative("shaft:left", "ring_left") @ balance.displacement
        assert iso.radial_force(float(np.hypot(motion[1], motion[2])), math.pi / 4.0) == pytest.approx(
            141.42136, rel=1e-7
        )
        K = balance.element_stiffness[0]
        # 1.747e8 and 1.157e8 N/m for this direction, to the digits given
        assert float(RADIAL @ K @ RADIAL) == pytest.approx(1.747e8, rel=5e-4)
        assert float(TANGENTIAL @ K @ TANGENTIAL) == pytest.approx(1.157e8, rel=5e-4)

    def test_stiffness_rises_with_the_load(self):
        found = []
        for load in (100.0, 150.0, 200.0):
            loads = tuple(
                dataclasses.replace(entry, force=np.array([0.0, load, load, 0.0, 0.0, 0.0])) for entry in NU308.loads
            )
            scene = with_slices(dataclasses.replace(NU308, loads=loads), 401)
            K = equilibrium(assemble(scene, "hertz").system, Operation()).element_stiffness[0]
            found.append(RADIAL @ K @ RADIAL)
        # 16.0 % and 28.8 % with very many slices; the slices of 401 leave some tenths of a per cent
        assert found[1] / found[0] - 1.0 == pytest.approx(0.16, abs=0.006)
        assert found[2] / found[0] - 1.0 == pytest.approx(0.288, abs=0.01)

    def test_shaft_mode(self):
        """4771 Hz was found by the thesis for a shaft whose mass it does not print: 5 %."""
        found = modes(equilibrium(assemble(NU308, "hertz").system, Operation(500 * RPM)))
        shaft = np.argmin(np.abs(found.frequency - 4771.0))
        assert found.frequency[shaft] == pytest.approx(4771.0, rel=0.05)
        translation = self._mode_along(RADIAL, found)
        assert found.frequency[translation] == pytest.approx(4771.0, rel=0.05)
        bearings = [part.startswith("bearing") for part in found.parts]
        assert found.shares[bearings][:, translation].sum() > 0.99

    @staticmethod
    def _mode_along(direction, found):
        """The mode in which shaft and rings move against each other along a direction."""
        system = assemble(NU308, "hertz").system
        ends = [system.relative(f"shaft:{side}", f"ring_{side}") for side in ("left", "right")]
        together = sum(direction @ end @ found.shapes for end in ends)
        return int(np.argmax(np.abs(together) / np.linalg.norm(found.shapes, axis=0)))

    def test_frequencies_agree_with_the_independent_sum(self):
        """200 slices in both; what is left is the error of the stiffness there."""
        model = assemble(with_slices(NU308, 200), "hertz")
        balance = equilibrium(model.system, Operation())
        iso = IsoBearing(12, 14e-3, 15e-3, 200)
        pose = (model.system.relative("shaft:left", "ring_left") @ balance.displacement)[[1, 2, 4, 5]]
        K = iso.stiffness(pose)
        # Shaft y z theta_y theta_z at x = -70 and 70 mm, then both rings.
        shaft = [math.pi / 4 * 0.04**2 * 0.216 * 7850, math.pi / 4 * (0.052**2 - 0.04**2) * 0.023 * 7850]
        mass = shaft[0] + 2.0 * shaft[1]
        tilt = shaft[0] * (0.04**2 / 16 + 0.216**2 / 12) + 2.0 * shaft[1] * (
            (0.052**2 + 0.04**2) / 16 + 0.023**2 / 12 + 0.07**2
        )
        ring = math.pi / 4 * (0.09**2 - 0.08**2) * 0.023 * 7850
        M = np.diag([mass, mass, tilt, tilt, ring, ring, ring, ring])
        total = np.diag([0.0] * 4 + [1e5] * 4)
        for x, first in ((-0.07, 4), (0.07, 6)):
            T = np.zeros((4, 8))
            T[:, :4] = [[1, 0, 0, x], [0, 1, -x, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
            T[0, first] = T[1, first + 1] = -1.0
            total += T.T @ K @ T
        expected = np.sqrt(eigh(total, M, eigvals_only=True)) / (2.0 * np.pi)
        # Second differences of an energy with kinks at slice edges: 0.1 % in K.
        np.testing.assert_allclose(undamped_modes(balance).frequency, expected, rtol=2e-3)

    @pytest.mark.parametrize("clearance", [0.0, 20e-6])
    @pytest.mark.parametrize("law", ["hertz", "formula", "constant:hertz", "constant:reynolds", "constant:cfd"])
    def test_runs_with_every_law(self, law, clearance, film_models):
        model = film_models[clearance] if law == "formula" else assemble(NU308, law, clearance=clearance)
        balance = equilibrium(model.system, Operation(500 * RPM))
        for forces in balance.forces:
            assert np.hypot(forces[1], forces[2]) == pytest.approx(141.42, rel=1e-3)
        found = modes(balance)
        assert np.all(found.damping_ratio > -1e-9)
        assert not any(balance.outside.values())

    def test_turning_everything_about_the_axis_changes_nothing(self):
        """Loads and the start angle turned by a third of a pitch and more; the springs are alike all round."""
        turn = 0.7
        rotation = np.eye(6)
        c, s = math.cos(turn), math.sin(turn)
        rotation[1:3, 1:3] = rotation[4:6, 4:6] = [[c, -s], [s, c]]
        stiffness = np.zeros((6, 6))
        stiffness[1:3, 1:3] = [[3e5, 4e4], [4e4, 1e5]]
        straight = dataclasses.replace(
            NU308, springs=tuple(dataclasses.replace(entry, stiffness=stiffness) for entry in NU308.springs)
        )
        turned = dataclasses.replace(
            straight,
            springs=tuple(
                dataclasses.replace(entry, stiffness=rotation @ stiffness @ rotation.T) for entry in straight.springs
            ),
            loads=tuple(dataclasses.replace(entry, force=rotation @ entry.force) for entry in NU308.loads),
        ).with_bearings(dataclasses.replace(entry, start_angle=turn) for entry in NU308.bearings)
        first, second = (
            equilibrium(assemble(scene, "hertz", clearance=10e-6).system, Operation()) for scene in (straight, turned)
        )
        at_left = [
            balance.system.relative("shaft:left", "ring_left") @ balance.displacement for balance in (first, second)
        ]
        np.testing.assert_allclose(at_left[1], rotation @ at_left[0], rtol=1e-9, atol=1e-15)
        np.testing.assert_allclose(undamped_modes(second).frequency, undamped_modes(first).frequency, rtol=1e-8)

    @pytest.mark.parametrize("clearance", [0.0, 20e-6])
    @pytest.mark.parametrize("law", ["hertz", "constant:cfd", "formula"])
    def test_equilibrium_is_found_from_zero_gap_and_overload(self, law, clearance, film_models):
        system = film_models[clearance].system if law == "formula" else assemble(NU308, law, clearance=clearance).system
        operation = Operation(500 * RPM)
        expected = equilibrium(system, operation).displacement
        gap, overload, tilted = (np.zeros(system.size) for _ in range(3))
        gap[:4] = -3e-6
        overload[:2] = 3e-4
        tilted[2:4] = 3e-3
        for start in (gap, overload, tilted):
            found = equilibrium(system, operation, start)
            # Newton leaves 1e-10 of the largest force on mounts of 1e5 N/m.
            np.testing.assert_allclose(found.displacement, expected, rtol=1e-6, atol=1e-12)

    def test_forces_and_moments_balance(self):
        """What the springs to the ground take is what is not inside the system: nothing, for preloads between rings."""
        model = assemble(NU308, "hertz", clearance=20e-6)
        balance = equilibrium(model.system, Operation())
        # Rigid translations y and z, and tilts of the whole machine about its middle.
        rows = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
        rigid = np.array(
            [
                *rows,
                *([[1, 0, 0, -0.07], [0, 1, 0.07, 0]]),
                *([[1, 0, 0, 0.07], [0, 1, -0.07, 0]]),
            ]
        )
        # The outer rings cannot tilt: the moment that they hold is the bearing's own.
        for connected, force in zip(balance.system.elements, balance.forces, strict=True):
            inside = rigid.T @ connected.transform.T @ force
            np.testing.assert_allclose(inside[:2], 0.0, atol=1e-11)
            np.testing.assert_allclose(inside[2:], force[4:6], atol=1e-11)
        np.testing.assert_allclose(rigid.T @ balance.system.loads(0.0), 0.0, atol=1e-12)


class FixedAngle(SpeedProfile):
    """A speed without a turning cage: what a linear analysis takes."""

    def at(self, time):
        return self.course(time), 0.0


class TestLinearAgainstTime:
    @pytest.mark.parametrize("frequency", [200.0, 1300.0, 4000.0])
    def test_response(self, model, frequency):
        """Small enough to be linear, started on the linear response."""
        operation = Operation(500 * RPM)
        balance = equilibrium(model.system, operation)
        amplitude = 0.5
        entry = Input("E", "shaft:left", RADIAL)
        load = Load("E", "shaft:left", amplitude * RADIAL, profile=Harmonic(frequency))
        system = System(model.system.bodies, NU308.springs, (*NU308.loads, load), model.bearings)
        x = -1j * amplitude * responses(balance, [entry], np.array([frequency]))[0, :, 0]
        omega = 2.0 * np.pi * frequency
        step = 1.0 / frequency / 200.0
        run = integrate(
            system,
            FixedAngle(SpeedProfile.constant(operation.speed).course),
            6.0 / frequency,
            Settings(step, step, 1.0),
            balance.displacement + x.real,
            (1j * omega * x).real,
        )
        sensor = Sensor("S", "shaft:left", RADIAL, against="ring_left")
        linear = frequency_response(balance, [entry], [sensor], np.array([frequency]))[0, 0, 0]
        seen = run.states.displacement @ (sensor.direction @ system.relative("shaft:left", "ring_left"))
        late = run.time > 1.0 / frequency
        basis = np.stack([np.sin(omega * run.time), np.cos(omega * run.time), np.ones_like(run.time)], axis=1)[late]
        fit = np.linalg.lstsq(basis, seen[late], rcond=None)[0]
        assert complex(fit[0], fit[1]) / amplitude == pytest.approx(linear, rel=0.01)

    def test_stiffness_is_the_derivative_of_the_force_in_time(self, model):
        operation = Operation(500 * RPM)
        balance = equilibrium(model.system, operation)
        kick = np.zeros(model.system.size)
        kick[:2] = 1e-4
        h = 1e-7
        run = integrate(
            model.system,
            FixedAngle(SpeedProfile.constant(operation.speed).course),
            200 * h,
            Settings(h, h, 1.0),
            balance.displacement,
            kick,
        )
        element, i = model.bearings[0], 100
        T = model.system.elements[0].transform
        _, K, C, _ = element.evaluate(T @ run.states.displacement[i], T @ run.states.velocity[i], operation)
        slope = (run.forces[0][i + 1] - run.forces[0][i - 1]) / (2.0 * h)
        expected = -K @ T @ run.states.velocity[i] - C @ T @ run.states.acceleration[i]
        np.testing.assert_allclose(slope[1:3], expected[1:3], rtol=1e-4)


class TestEnergy:
    STEP = 1e-7

    def test_undamped_run_keeps_its_energy(self):
        """1e5 steps of 0.1 us, spectral radius 1: 1e-6 of the peak kinetic energy, with the energy of the ISO sum."""
        model = assemble(NU308, "hertz")
        balance = equilibrium(model.system, Operation())
        start = balance.displacement.copy()
        start[:2] += 5e-8
        run = integrate(
            model.system, SpeedProfile.constant(0.0), 1e5 * self.STEP, Settings(self.STEP, 200 * self.STEP, 1.0), start
        )
        assert run.steps == 100_000
        iso = IsoBearing(12, 14e-3, 15e-3, 41)
        kinetic = 0.5 * np.einsum("ti,ij,tj->t", run.states.velocity, model.system.mass, run.states.velocity)
        loads = model.system.loads(0.0)
        potential = []
        for q in run.states.displacement:
            energy = 0.5 * q @ model.system.stiffness @ q - q @ loads
            for connected in model.system.elements:
                energy += iso.energy((connected.transform @ q)[[1, 2, 4, 5]])
            potential.append(energy)
        total = kinetic + np.array(potential)
        assert np.abs(total - total[0]).max() < 1e-6 * kinetic.max()


class HardSwitch(ElementDefaults):
    """Dry below a speed, film above it: the negative control."""

    def __init__(self, dry, film, at):
        self.name, self.ports, self.dry, self.film, self.at = film.name, film.ports, dry, film, at

    def evaluate(self, displacement, velocity, operation):
        element = self.film if operation.speed >= self.at else self.dry
        return element.evaluate(displacement, velocity, operation)


class TestRunUp:
    @pytest.fixture
    def switched(self, model):
        bearings = [HardSwitch(entry.with_laws([_hertz(entry.bearing)]), entry, 500 * RPM) for entry in model.bearings]
        return System(model.system.bodies, NU308.springs, NU308.loads, bearings)

    @staticmethod
    def _place(system, displacement):
        motion = displacement @ system.relative("shaft:left", "ring_left").T
        return np.hypot(motion[:, 1], motion[:, 2])

    @pytest.mark.parametrize("clearance", [20e-6, 0.0])
    def test_equilibria_move_no_faster_than_the_film_grows(self, film_models, clearance):
        """From 30 rpm on the film grows less than in proportion to the speed.

        Below it fades to the dry contact in a step of fifth degree, whose steepest slope is 15/8 of its mean slope.
        """
        system = film_models[clearance].system

        def lifted(rpm):
            """How far films move the shaft [m]."""
            place = self._place(system, sweep(system, np.concatenate([[0.0], rpm]) * RPM).displacement)
            return np.abs(place[1:] - place[0])

        fading = lifted(np.arange(1.0, 31.0))
        assert np.diff(fading, prepend=0.0).max() < 15.0 / 8.0 * fading[-1] / 30.0
        for rpm in (np.arange(31.0, 130.0, 3.0), np.arange(130.0, 2001.0, 30.0)):
            film = lifted(rpm)
            assert np.all(np.abs(np.diff(film)) < film[:-1] / rpm[:-1] * np.diff(rpm))

    def test_hard_switch_jumps(self, switched):
        result = sweep(switched, np.array([499.0, 501.0]) * RPM)
        place = self._place(switched, result.displacement)
        approach = place[0] - 10e-6
        assert abs(place[1] - place[0]) / 2.0 > 0.01 * approach

    def test_steps_of_the_force_halve_with_the_time_step(self, model, switched):
        """From 495 to 505 rpm: smooth with the law, a jump with the switch."""
        largest = {}
        for name, system in (("law", model.system), ("switch", switched)):
            for step in (2e-5, 1e-5):
                speed = SpeedProfile.ramp(495 * RPM, 505 * RPM, 0.004)
                start = equilibrium(system, Operation(495 * RPM))
                run = integrate(system, speed, 0.004, Settings(step, step), start.displacement)
                size = np.hypot(run.forces[0][:, 1], run.forces[0][:, 2])
                largest[name, step] = np.abs(np.diff(size)).max()
        assert largest["law", 1e-5] == pytest.approx(0.5 * largest["law", 2e-5], rel=0.1)
        assert largest["switch", 1e-5] > 0.8 * largest["switch", 2e-5]
        assert largest["switch", 1e-5] > 100.0 * largest["law", 1e-5]


def _hertz(bearing: Bearing):
    from mbs.bearings import laws

    return laws.hertz(bearing)


class TestFrequencyOverSpeed:
    @pytest.mark.parametrize(("clearance", "direction"), [(0.0, 1.0), (20e-6, -1.0)])
    def test_rises_without_clearance_and_falls_with_it(self, clearance, direction, film_models):
        """The shaft mode along the load, 200 to 2000 rpm."""
        result = sweep(film_models[clearance].system, np.linspace(200.0, 2000.0, 7) * RPM)
        along = result.undamped.frequency[:, -1]
        assert np.all(np.sign(np.diff(along)) == direction)


def test_bearing_element_follows_speed_and_angle():
    bearing = Bearing.named("NU308", clearance=0.0)
    element = BearingElement(
        "b", "a", "ground", bearing, BearingForce(bearing, _hertz(bearing)), 313.15, start_angle=0.1
    )
    operation = Operation(speed=100.0, angle=2.0)
    assert element.cage_angle(operation) == pytest.approx(0.1 + bearing.cage_angle(2.0))
    assert element.entrainment_speed(operation) == pytest.approx(bearing.geometry.entrainment_speed(100.0))
    assert element.centrifugal_load(operation) == 0.0
    felt = dataclasses.replace(element, centrifugal=True)
    assert felt.centrifugal_load(operation) == pytest.approx(bearing.centrifugal_load(100.0))


class TestN1014:
    SCENE = read_scene("n1014_rigid")

    def _peaks(self, law):
        """Frequency and height of the two largest peaks of the response of the outer ring, fine about each."""
        balance = equilibrium(assemble(self.SCENE, law).system, Operation(self.SCENE.speed))
        found = []
        for low, high in ((150.0, 700.0), (2000.0, 8000.0)):
            frequencies = np.linspace(low, high, 4001)
            size = np.abs(frequency_response(balance, self.SCENE.inputs, self.SCENE.sensors, frequencies))[:, 0, 0]
            top = int(np.argmax(size))
            assert 0 < top < 4000
            found.append((float(frequencies[top]), float(size[top])))
        frequencies = np.array(self.SCENE.frequencies)
        size = np.abs(frequency_response(balance, self.SCENE.inputs, self.SCENE.sensors, frequencies))[:, 0, 0]
        inner = (size[1:-1] > size[:-2]) & (size[1:-1] > size[2:])
        # Rollers at the edge of the load zone give small ones besides; an undamped peak is as high as the grid has it.
        second = size[(frequencies > 2000.0) & (frequencies < 8000.0)].max()
        assert np.count_nonzero(inner & (size[1:-1] > 0.2 * second)) == 2
        return found

    def test_two_peaks_in_the_order_of_the_stiffness(self):
        first, second = zip(*(self._peaks(f"constant:{name}") for name in ("reynolds", "cfd", "hertz")), strict=True)
        for peaks in (first, second):
            frequency, height = zip(*peaks, strict=True)
            assert frequency[0] < frequency[1] < frequency[2]
            # c of 24, 15 and 0 N s/m
            assert height[0] < height[1] < height[2]

    @pytest.mark.parametrize("clearance", [0.0, 20e-6])
    @pytest.mark.parametrize("law", ["hertz", "constant:hertz", "constant:reynolds", "constant:cfd"])
    def test_statics_are_those_of_contacts_in_series(self, law, clearance):
        """Rollers as bodies against massless rollers; both contacts are alike, so they agree to what Newton leaves."""
        places, stiffness = [], []
        for bodies in (True, False):
            scene = self.SCENE.with_bearings(
                dataclasses.replace(entry, rollers_as_bodies=bodies) for entry in self.SCENE.bearings
            )
            balance = equilibrium(assemble(scene, law, clearance=clearance).system, Operation(scene.speed))
            places.append(balance.displacement[:6])
            stiffness.append(ring_matrices(balance.element_stiffness[0], balance.element_damping[0])[0])
            assert balance.forces[0][1] == pytest.approx(-100.0, rel=1e-9)
        np.testing.assert_allclose(places[0], places[1], rtol=1e-6, atol=1e-13)
        np.testing.assert_allclose(stiffness[0][1:3, 1:3], stiffness[1][1:3, 1:3], rtol=1e-5, atol=1.0)

    @pytest.mark.slow
    def test_film_laws_of_each_contact_give_the_statics_of_the_series(self):
        """Rigid rollers balance as a whole, slices in series each for itself: alike but for unlike contacts."""
        model = assemble(self.SCENE, "formula")
        balance = equilibrium(model.system, model.operation)
        motion = model.system.relative("shaft", "outer_ring") @ balance.displacement
        plain = model.bearings[0]
        f, K, _, _ = plain.evaluate(motion, np.zeros(6), model.operation)
        assert f[1] == pytest.approx(-100.0, rel=2e-3)
        rings, _ = ring_matrices(balance.element_stiffness[0], balance.element_damping[0])
        assert rings[1, 1] == pytest.approx(K[1, 1], rel=2e-3)
        assert not any(balance.outside.values())

    def test_centrifugal_load_of_rollers_that_are_bodies_is_carried_by_the_outer_contacts(self):
        scene = self.SCENE.with_bearings(dataclasses.replace(entry, centrifugal=True) for entry in self.SCENE.bearings)
        model = assemble(scene, "hertz", clearance=20e-6)
        balance = equilibrium(model.system, model.operation)
        plain = model.bearings[0]
        each = plain.bearing.centrifugal_load(scene.speed) * plain.bearing.geometry.roller_length
        outward = balance.displacement[model.system.own("bearing_rollers")]
        # An unloaded roller lies on the outer race, pressed there by its centrifugal load alone.
        assert each == pytest.approx(plain.bearing.roller_mass * 45.5e-3 * (3.0 / 45.5e-3) ** 2, rel=1e-3)
        angle = plain.start_angle + 2.0 * np.pi * np.arange(24) / 24.0
        ring = balance.displacement[model.system.own("outer_ring")]
        assert np.all(outward - ring[0] * np.cos(angle) - ring[1] * np.sin(angle) > 5e-6)
        np.testing.assert_allclose(balance.forces[0][6:8] + balance.forces[0][:2], 0.0, atol=1e-6)

    def test_undamped_heights_are_those_of_no_damping(self):
        """Hertz in place of the dry constant: no damping at all."""
        found = modes(equilibrium(assemble(self.SCENE, "hertz").system, Operation(self.SCENE.speed)))
        assert np.abs(found.damping_ratio[found.frequency > 1.0]).max() < 1e-9

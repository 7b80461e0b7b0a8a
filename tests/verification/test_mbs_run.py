"""Compiled runs against the reference in Python, closed forms, and the laws that they blend."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import OutsideMapError
from mbs.bearings import speed_tables
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_block import Films
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.laws import hertz
from mbs.bearings.speed_tables import SpeedTables
from mbs.gears.gear import GearPair, gear_mesh
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation, Sensor, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Course, Harmonic, SpeedProfile
from mbs.model.system import System
from mbs.settings import Settings
from mbs.transient.run import Options, run
from mbs.transient.stepping import Method
from tests.cases.bearings import TEMPERATURE, integrate, map_law

RPM = math.pi / 30.0
TEETH = (21, 23)
PAIR = GearPair(
    name="mesh",
    on="shaft_1",
    against="shaft_2",
    teeth=TEETH,
    module=4.5e-3,
    pressure_angle=math.radians(20.0),
    face_width=25e-3,
    stiffness=14e9,
    backlash=1e-4,
    damping=1e3,
    transmission_error=(1e-6,),
)
CENTRE = np.array([0.0, 99e-3 * math.cos(0.4), 99e-3 * math.sin(0.4)])
# A heavy disc aside from the gear: its gyroscopic moment at 2000 rpm is some per cent of the bearings' stiffness.
PARTS = [Inertia(3.0, 4e-3, 5e-3), Inertia(6.0, 0.3, 0.16, offset=0.15)]


def gearbox(law=None, clearance=20e-6, centrifugal=False, loads=()):
    """Two rigid shafts on two NU308 each, with a gear mesh between them."""
    bearing = Bearing.named("NU308", clearance=clearance).with_slices(21)
    chosen = hertz(bearing, 50.0) if law is None else law
    freedoms = ["y", "z", "theta_x", "theta_y", "theta_z"]
    bodies, elements, springs = [], [], []
    for k, (place, spin) in enumerate(((np.zeros(3), 1.0), (CENTRE, -TEETH[0] / TEETH[1])), start=1):
        frames = {"left": (-0.08, 0.0, 0.0), "right": (0.08, 0.0, 0.0)}
        bodies.append(rigid_body(f"shaft_{k}", PARTS, freedoms, place, frames, spin))
        springs.append(Spring(f"soft_{k}", f"shaft_{k}", "ground", np.diag([0.0, 1e5, 1e5, 0.0, 1e3, 1e3])))
        elements += [
            BearingElement(
                name=f"{side}_{k}",
                inner=f"shaft_{k}:{side}",
                outer="ground",
                bearing=bearing,
                force=BearingForce(bearing, chosen),
                temperature=TEMPERATURE,
                inner_spin=spin,
                centrifugal=centrifugal,
            )
            for side in frames
        ]
    springs.append(Spring("brake", "shaft_2", "ground", np.diag([0.0, 0.0, 0.0, 2e4, 0.0, 0.0])))
    drive = Load("drive", "shaft_1", np.array([0.0, 0.0, 0.0, 82.0, 0.0, 0.0]))
    mesh = gear_mesh(PAIR, (0.0,) * 3, CENTRE.tolist(), 1.0, -TEETH[0] / TEETH[1])
    return System(bodies, springs, [drive, *loads], [*elements, mesh])


BOTH = (Options(), Options(compiled=False))
SENSORS = (
    Sensor("d", "shaft_1:left", np.array([0.0, 1.0, 0.0, 0.0, 0.0, 0.0])),
    Sensor("v", "shaft_2", np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]), "velocity", "shaft_1"),
    Sensor("a", "shaft_2:right", np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]), "acceleration"),
)


def both(system, speed, duration, settings):
    """The compiled run and the reference, from the equilibrium."""
    start = equilibrium(system, Operation(speed.at(0.0)[0])).displacement
    found = [run(system, speed, duration, settings, SENSORS, start, options=how) for how in BOTH]
    assert found[1].compiled == 0
    assert found[0].steps == found[1].steps
    return found


def compare(found, tolerance):
    """Everything that is recorded, each relative to its largest value."""
    first, second = found
    np.testing.assert_array_equal(first.time, second.time)
    np.testing.assert_array_equal(first.angle, second.angle)
    pairs = [
        *zip(first.signals.T, second.signals.T, strict=True),
        *zip(first.forces, second.forces, strict=True),
        *zip(first.motions, second.motions, strict=True),
    ]
    for got, wanted in pairs:
        np.testing.assert_allclose(got, wanted, rtol=0.0, atol=tolerance * np.abs(wanted).max())


class TestAgainstTheReference:
    """Both make the same steps: they differ by what Newton leaves over, 1e-13 of the forces, grown over the run."""

    SETTINGS = Settings(2e-5, 1e-4, residual=1e-13)

    @pytest.mark.parametrize(
        "speed",
        [
            SpeedProfile.ramp(0.0, 2000.0 * RPM, 0.02),
            SpeedProfile.constant(1000.0 * RPM),
            SpeedProfile(Course((0.0, 0.01, 0.02), (500.0 * RPM, -800.0 * RPM, 300.0 * RPM))),
        ],
    )
    def test_dry_gearbox(self, speed):
        found = both(gearbox(), speed, 0.02, self.SETTINGS)
        assert found[0].compiled == found[0].steps == 1000
        assert np.ptp(found[0].forces[-1][:, 7]) > 10.0  # the mesh is at work
        compare(found, 1e-9)

    @pytest.mark.parametrize("law", [None, "films"])
    def test_standstill(self, law):
        """Where the law of a map is the dry one."""
        system = gearbox(law and map_law())
        start = equilibrium(system, Operation()).displacement + 1e-7
        settings = self.SETTINGS
        rest = SpeedProfile.constant(0.0)
        found = [run(system, rest, 4e-3, settings, SENSORS, start, options=how) for how in BOTH]
        assert found[0].compiled == found[0].steps
        compare(found, 1e-9)

    def test_dry_gearbox_with_varying_loads(self):
        load = Load("shaker", "shaft_2:right", np.array([0.0, 300.0, 0.0, 0.0, 0.0, 0.0]), profile=Harmonic(700.0, 0.3))
        course = Load(
            "push", "shaft_1", np.array([0.0, 0.0, 500.0, 0.0, 0.0, 0.0]), profile=Course((0.0, 0.005), (0.0, 1.0))
        )
        found = both(gearbox(loads=[load, course]), SpeedProfile.ramp(0.0, 2000.0 * RPM, 0.02), 0.01, self.SETTINGS)
        compare(found, 1e-9)

    def test_dry_gearbox_with_a_damper(self):
        """In proportion to the stiffness, and without a step taken back at lift-off, where the tangent is steep."""
        system = gearbox(hertz(Bearing.named("NU308", clearance=0.0), damping_time=1.25e-5))
        found = both(system, SpeedProfile.ramp(0.0, 2000.0 * RPM, 0.02), 0.01, self.SETTINGS)
        assert found[0].compiled == found[0].steps
        assert found[0].halved == found[1].halved == 0
        compare(found, 1e-9)

    def test_films_at_one_speed(self):
        found = both(gearbox(map_law()), SpeedProfile.constant(1000.0 * RPM), 0.01, self.SETTINGS)
        assert found[0].compiled == found[0].steps
        compare(found, 1e-9)

    def test_gyroscopic_terms_matter_in_this(self):
        """The negative control: without them the shafts move elsewhere by far more than what is compared above."""
        spinning = gearbox()
        still = gearbox()
        still.gyroscopic[:] = 0.0
        speed = SpeedProfile.ramp(0.0, 2000.0 * RPM, 0.02)
        start = equilibrium(spinning, Operation()).displacement
        with_them, without = (run(system, speed, 0.02, self.SETTINGS, SENSORS, start) for system in (spinning, still))
        moved = np.abs(with_them.signals - without.signals).max(axis=0) / np.abs(with_them.signals).max(axis=0)
        assert moved.min() > 1e-4

    def test_error_control(self):
        """The same steps are halved; those in compiled code begin with other guesses, so Newton leaves other rests."""
        system = gearbox()
        settings = Settings(4e-5, 4e-4, tolerance=2e-10, residual=1e-13)
        start = equilibrium(system, Operation()).displacement.copy()
        start[0] += 2e-6
        speed = SpeedProfile.constant(1000.0 * RPM)
        found = [run(system, speed, 4e-3, settings, SENSORS, start, options=how) for how in BOTH]
        assert found[0].halved == found[1].halved > 5
        assert found[0].steps == found[1].steps
        compare(found, 1e-9)

    def test_through_loss_of_contact(self):
        """A rattling mesh without torque; hits at 1e-7 m of contact let rounding grow a little more."""
        system = gearbox()
        start = np.zeros(system.size)
        velocity = np.zeros(system.size)
        velocity[2] = -4.0
        settings = Settings(1e-5, 5e-5, residual=1e-13)
        speed = SpeedProfile.constant(500.0 * RPM)
        found = [run(system, speed, 12e-3, settings, SENSORS, start, velocity, options=how) for how in BOTH]
        pushes = np.linalg.norm(found[0].forces[-1], axis=1)
        assert np.any(pushes == 0.0)
        assert np.count_nonzero(np.diff((pushes > 0.0).astype(int)) > 0) >= 3
        compare(found, 1e-6)


class TestFilmsOverSpeed:
    """Where the speed changes, compiled code reads blended tables."""

    def test_run_up_with_films(self):
        """The blend leaves 4e-8 of forces (see below); accelerations are those of steps of 4e-8 here and there."""
        system = gearbox(map_law())
        speed = SpeedProfile.ramp(300.0 * RPM, 1500.0 * RPM, 0.1)
        first, second = both(system, speed, 0.02, Settings(2e-5, 1e-4, residual=1e-13))
        assert first.compiled == first.steps
        for got, wanted in zip((*first.forces, *first.motions), (*second.forces, *second.motions), strict=True):
            np.testing.assert_allclose(got, wanted, rtol=0.0, atol=1e-6 * np.abs(wanted).max())

    def test_fading_films(self):
        """Below the map both read the same table of what is left of the film; above it the blend leaves its 4e-8."""
        system = gearbox(map_law())
        slowest = 0.3 / system.elements[2].element.rates[1]  # of the second shaft, which is slower
        settings = Settings(2e-5, 1e-4, residual=1e-13)
        speed = SpeedProfile(Course((0.0, 0.002, 0.003), (1.05 * slowest, 0.98 * slowest, 1.05 * slowest)))
        first, second = both(system, speed, 0.003, settings)
        assert first.compiled == first.steps
        for got, wanted in zip((*first.forces, *first.motions), (*second.forces, *second.motions), strict=True):
            np.testing.assert_allclose(got, wanted, rtol=0.0, atol=1e-6 * np.abs(wanted).max())

    @pytest.mark.parametrize("centrifugal", [False, True])
    def test_from_rest(self, centrifugal):
        """They differ by what Newton leaves over, as above; at rest itself one law is a formula, the other a table."""
        system = gearbox(map_law(), centrifugal=centrifugal)
        slowest = 0.3 / system.elements[0].element.rates[1]
        found = both(system, SpeedProfile.ramp(1e-3, 0.95 * slowest, 2e-3), 2e-3, Settings(2e-5, 1e-4, residual=1e-13))
        assert found[0].compiled == found[0].steps
        compare(found, 1e-9)

    @pytest.mark.parametrize("outside", ["clamp", "asymptote"])
    @pytest.mark.parametrize("part", [0.0, 0.5, 3.0])
    def test_loads_above_the_map(self, outside, part):
        """Slices beyond the hold are its tangent in both; each evaluation with one is counted."""
        system = gearbox(map_law(outside), loads=[Load("push", "shaft_1", np.array([0.0, 4e5, 0.0, 0.0, 0.0, 0.0]))])
        slowest = 0.3 / system.elements[0].element.rates[1]
        found = both(system, SpeedProfile.constant(part * slowest), 1e-3, Settings(2e-5, 1e-4, residual=1e-13))
        assert found[0].compiled == found[0].steps
        counted = [list(each.outside.values()) for each in found]
        assert min(counted[0][:2]) >= found[0].steps
        assert max(counted[0][2:]) == max(counted[1][2:]) == 0
        for got, wanted in zip(
            (*found[0].forces, *found[0].motions), (*found[1].forces, *found[1].motions), strict=True
        ):
            np.testing.assert_allclose(got, wanted, rtol=0.0, atol=1e-9 * np.abs(wanted).max())

    def test_a_strict_law_refuses_loads_above_its_map(self):
        """In compiled runs as in Python."""
        system = gearbox(map_law("error"))
        push = Load("push", "shaft_1", np.array([0.0, 4e5, 0.0, 0.0, 0.0, 0.0]), profile=Course((0.0, 1e-4), (0, 1)))
        pushed = gearbox(map_law("error"), loads=[push])
        speed = SpeedProfile.constant(1000.0 * RPM)
        start = equilibrium(system, Operation(speed.at(0.0)[0])).displacement
        for how in BOTH:
            with pytest.raises(OutsideMapError, match="bearing force, load: got about"):
                run(pushed, speed, 2e-3, Settings(2e-5, 1e-4), SENSORS, start, options=how)

    def test_centrifugal_loads(self):
        system = gearbox(map_law(), centrifugal=True)
        speed = SpeedProfile.ramp(600.0 * RPM, 700.0 * RPM, 0.1)
        first, second = both(system, speed, 0.001, Settings(2e-5, 1e-4, residual=1e-13))
        assert first.compiled == first.steps
        for got, wanted in zip(first.forces, second.forces, strict=True):
            np.testing.assert_allclose(got, wanted, rtol=0.0, atol=1e-6 * np.abs(wanted).max())

    @staticmethod
    def blended(force, speeds):
        """Numbers and cells at the first of some speeds, and whether there are tables."""
        tables = SpeedTables(force.bearing, force.flat_law, TEMPERATURE, (1.0, 0.0))
        films = Films([tables])
        nodes, weights = tables.places(speeds)
        slots, sound, _ = tables.prepare(speeds, nodes, weights)
        assert sound.all()
        return films.blend(0, int(slots[0]), float(weights[0]))

    def errors(self, count):
        """Largest errors of force, stiffness and damping at random poses and speeds."""
        force = BearingForce(Bearing.named("NU308", clearance=20e-6).with_slices(21), map_law())
        rng = np.random.default_rng(1)
        worst = np.zeros(3)
        for u in rng.uniform(0.31, 2.9, count):
            point = force.at(u, TEMPERATURE)
            pose, velocity = np.zeros(6), np.array([0.0, 1e-3, 1e-3, 0.0, 0.0, 0.0])
            pose[1:3], pose[4:6] = rng.uniform(12e-6, 30e-6, 2), rng.uniform(-1e-4, 1e-4, 2)
            fresh = np.vstack(point(pose, velocity))
            numbers, cells = self.blended(force, np.array([u, 1.0001 * u]))
            point.numbers[:], point.cells[:] = numbers, cells
            mixed = np.vstack(point(pose, velocity))
            for i, rows in enumerate((slice(0, 1), slice(1, 7), slice(7, 13))):
                error = np.abs(mixed[rows] - fresh[rows]).max() / np.abs(fresh[rows]).max()
                worst[i] = max(worst[i], error)
        return worst

    def test_blend_is_as_good_as_it_is_said_to_be(self, monkeypatch):
        """Some 1e-8 at the distance of nodes that is used, and of second order in it."""
        fine = self.errors(40)
        assert fine.max() < 1e-7
        monkeypatch.setattr(speed_tables, "STEP", 8e-3)
        coarse = self.errors(40)
        # 64 by the order; random places between the nodes scatter around that.
        assert np.all(coarse > 20.0 * fine)
        assert np.all(coarse < 200.0 * fine)


def oscillator(frequency):
    """A mass on a spring."""
    omega = 2.0 * math.pi * frequency
    spring = Spring("s", "a", "ground", np.diag([0.0, 2.0 * omega**2, 0.0, 0.0, 0.0, 0.0]))
    return System([rigid_body("a", [Inertia(2.0, 0.01, 0.02)], ["y"])], [spring])


class TestPeriod:
    @pytest.mark.parametrize(
        ("radius", "part"), [(1.0, 1.0 / 12.0), (0.8, 1.0 / 12.0 + 3.0 / 8.0 / 81.0), (0.5, 0.125)]
    )
    def test_is_longer_by_the_stated_part(self, radius, part):
        """The phase after ten periods, with omega h = 0.1: the next order is 1 % of the error, and the fit as much."""
        frequency = 5e3
        omega = 2.0 * math.pi * frequency
        h = 0.1 / omega
        found = integrate(
            oscillator(frequency),
            SpeedProfile.constant(0.0),
            10.0 / frequency,
            Settings(h, h, radius),
            np.array([1e-6]),
        )
        phase = np.unwrap(np.angle(found.states.displacement[:, 0] - 1j * found.states.velocity[:, 0] / omega))
        seen = np.polyfit(found.time, phase, 1)[0]
        assert omega / seen - 1.0 == pytest.approx(part * 0.01, rel=0.05)

    def test_method_is_of_the_spectral_radius(self):
        """At a very long step the amplification has the modulus of the spectral radius, three times."""
        for radius in (0.0, 0.3, 0.8, 1.0):
            method, h, omega = Method(radius), 1.0, 1e5
            by_q, by_v = method.weights(h)
            columns = []
            for q, v, a, carried in np.eye(4):
                known = (method.alpha_f * a - method.alpha_m * carried) / (1.0 - method.alpha_m)
                q0 = q + h * v + h * h * ((0.5 - method.beta) * carried + method.beta * known)
                v0 = v + h * ((1.0 - method.gamma) * carried + method.gamma * known)
                new = -(omega**2) * q0 / (1.0 + omega**2 * by_q)
                columns.append([q0 + by_q * new, v0 + by_v * new, new, known + method.ratio * new])
            largest = np.abs(np.linalg.eigvals(np.array(columns).T)).max()
            # A triple eigenvalue moves with the cube root of round-off.
            assert largest == pytest.approx(radius, abs=2e-3)


class TestOrder:
    def test_gearbox_is_of_second_order(self):
        """Steps small enough for the mesh; half of them leaves a quarter of the error, against a sixteenth."""
        system = gearbox()
        speed = SpeedProfile.constant(1000.0 * RPM)
        start = equilibrium(system, Operation(1000.0 * RPM)).displacement
        found = [
            run(system, speed, 2e-3, Settings(h, 2e-4, 0.8, residual=1e-13), SENSORS, start).forces[-1]
            for h in (4e-6, 2e-6, 2.5e-7)
        ]
        errors = [np.abs(forces - found[2]).max() for forces in found[:2]]
        # The finest is in error by 1/64 of the second.
        assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)

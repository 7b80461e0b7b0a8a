"""The gear mesh against geometry, balance of forces, Fourier series, and an independent integrator."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from mbs.gears.gear import gear_mesh
from mbs.gears.gear_kernel import TOUCH
from mbs.gears.pair import GearPair, contact_ratio, pair_harmonics
from mbs.gears.relief import Relief, course_under_load
from mbs.gears.teeth import tooth_stiffness
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.model.system import System
from mbs.settings import Settings
from tests.cases.bearings import integrate

ALPHA = math.radians(20.0)
PAIR = GearPair(
    name="mesh",
    on="one",
    against="two",
    teeth=(21, 23),
    module=4.5e-3,
    pressure_angle=ALPHA,
    face_width=25e-3,
    stiffness=14e9,
    backlash=1e-4,
    damping=0.0,
)
SPIN2 = -21.0 / 23.0
GEAR = Inertia(1.2, 1.3e-3, 0.7e-3)


class TestGeometry:
    @pytest.mark.parametrize("teeth", [(21, 23), (30, 30), (18, 90)])
    def test_contact_ratio_by_the_tip_circles(self, teeth):
        """Where the line of action leaves the tip circles, found by bisection on coordinates; over the base pitch."""

        def reach(z, sign):
            """Distance from the pitch point along the line of action at which the tip circle of a gear is met."""
            low, high = 0.0, 10.0
            for _ in range(200):
                middle = 0.5 * (low + high)
                point = np.array([sign * 0.5 * z + middle * math.sin(ALPHA) * sign, middle * math.cos(ALPHA)])
                low, high = (middle, high) if np.hypot(*point) < 0.5 * z + 1.0 else (low, middle)
            return low

        length = reach(teeth[0], 1.0) + reach(teeth[1], 1.0)
        assert contact_ratio(teeth, ALPHA) == pytest.approx(length / (math.pi * math.cos(ALPHA)), rel=1e-12)

    def test_the_first_example_of_iso_tr_6336_30(self):
        """ISO/TR 6336-30:2017, example 1, by the numbers that the open program Drivetrain of G. Reboucas quotes of it.

        Its basic rack is D of ISO 53 with a dedendum of 1.4 modules, ours A with 1.25.
        """
        pair = dataclasses.replace(
            PAIR,
            teeth=(17, 103),
            module=8e-3,
            helix_angle=math.radians(15.8),
            profile_shift=(0.145, 0.0),
            face_width=0.1,
            stiffness=None,
        )
        rack = (1.0 + 0.5 * (1.2 - 1.4)) / (1.0 + 0.5 * (1.2 - 1.25))
        single = rack * 1e-9 * tooth_stiffness(pair.teeth, (0.145, 0.0), pair.helix_angle)
        assert single == pytest.approx(12.37047, rel=1e-6)  # its digits, as of F_t
        assert 9e3 / (0.5 * pair.transverse_module * 17) == pytest.approx(127352.0, abs=0.5)
        assert pair.centre_distance == pytest.approx(0.5, abs=5e-6)  # shifts to three digits
        at, awt = pair.transverse_pressure_angle, pair.working_pressure_angle
        base = math.asin(math.sin(pair.helix_angle) * math.cos(ALPHA))
        zone = math.sqrt(2.0 * math.cos(base) * math.cos(awt) / (math.cos(at) ** 2 * math.sin(awt)))
        assert zone == pytest.approx(2.39533, abs=1e-4)  # of that distance
        # tip diameters are not quoted: ours are shortened by 0.02 mm
        assert rack * 1e-9 * pair.mean_stiffness / pair.face_width == pytest.approx(17.46485, rel=1e-3)
        assert pair.contact_ratios[0] == pytest.approx((17.46485 / 12.37047 - 0.25) / 0.75, rel=1e-3)

    @pytest.mark.parametrize("ratio", [1.0, 1.25, 1.58, 2.4, 3.0])
    def test_harmonics_are_those_of_the_number_of_pairs(self, ratio):
        """Pairs counted one by one over a pitch; the midpoint rule with 2e5 points leaves 1e-5 at the jumps."""
        n = 200_000
        place = (np.arange(n) + 0.5) / n - 0.5
        # Pair m is in contact while its place on the path, centred, lies within +- ratio/2 pitches.
        centre = 0.0 if math.floor(ratio) % 2 == 0 else 0.5
        pairs = sum((np.abs(place + centre + m) < 0.5 * ratio).astype(float) for m in range(-6, 7))
        assert np.mean(pairs) == pytest.approx(ratio, rel=1e-5)
        for j, amplitude in enumerate(pair_harmonics(ratio, 7), start=1):
            cosine = 2.0 * np.mean(pairs * np.cos(2.0 * math.pi * j * place)) / ratio
            sine = 2.0 * np.mean(pairs * np.sin(2.0 * math.pi * j * place)) / ratio
            assert amplitude == pytest.approx(cosine, abs=3e-5)
            assert sine == pytest.approx(0.0, abs=3e-5)


def gear_stage(torque, angle=0.7, pair=PAIR, stiffness=2e8):
    """Two gears on springs, the second held about x; a torque on the first."""
    place = 99e-3 * np.array([0.0, math.cos(angle), math.sin(angle)])
    freedoms = ["y", "z", "theta_x", "theta_y", "theta_z"]
    bodies = [
        rigid_body("one", [GEAR], freedoms, spin=1.0),
        rigid_body("two", [GEAR], freedoms, position=place, spin=SPIN2),
    ]
    mount = np.diag([0.0, stiffness, stiffness, 0.0, 1e5, 1e5])
    held = np.diag([0.0, stiffness, stiffness, 1e6, 1e5, 1e5])
    springs = [Spring("mount_one", "one", "ground", mount), Spring("mount_two", "two", "ground", held)]
    load = Load("torque", "one", np.array([0.0, 0.0, 0.0, torque, 0.0, 0.0]))
    mesh = gear_mesh(pair, (0.0, 0.0, 0.0), place, 1.0, SPIN2)
    return System(bodies, springs, [load], [mesh]), place


def lacking(approach, gaps, each, force):
    """Force of springs that close one after the other, less what is carried."""
    return each * np.sum(np.maximum(approach - gaps, 0.0)) - force


class TestUnderLoad:
    def test_a_relief_for_the_load_turns_evenly(self):
        """Harris 1958: linear relief over the double contact, as large as one pair yields, leaves no error."""
        ratio, pitch, stiffness, force = 1.6, 9e-3, 4e8, 3000.0
        amount, length = force * ratio / stiffness, 0.6 * pitch
        relief = Relief((amount, amount), (length, length))
        for part in (1.0, 0.5):
            course = course_under_load(relief, (ratio, 0.0), pitch, stiffness, part * force)
            moved = part * force / (stiffness * course.stiffness) + course.error
            # round-off; at half the load some of the relief is left as an error
            assert (np.ptp(moved) < 1e-12 * amount) == (part == 1.0)

    @pytest.mark.parametrize("ratios", [(1.6, 0.0), (1.43, 0.83), (2.2, 1.3)])
    def test_relief_by_integrating_the_lines_of_contact(self, ratios):
        """The approach that carries the load, by a root of the force of finely divided lines."""
        transverse, overlap = ratios
        pitch, stiffness, force = 9e-3, 4e8, 2500.0
        amounts, lengths = (12e-6, 5e-6), (2.5e-3, 1.5e-3)
        course = course_under_load(Relief(amounts, lengths), ratios, pitch, stiffness, force)
        part, slices = transverse % 1.0, 301 if overlap else 1
        for k in range(0, course.error.size, course.error.size // 8):
            gaps = []
            for lag in overlap * (np.arange(slices) / max(slices - 1, 1) - 0.5) if overlap else [0.0]:
                s = ((k / course.error.size + lag + 0.5 * part) % 1.0) * pitch
                while s < transverse * pitch:
                    from_end = transverse * pitch - s
                    relief = amounts[1] * max(1.0 - s / lengths[1], 0.0)
                    gaps.append(relief + amounts[0] * max(1.0 - from_end / lengths[0], 0.0))
                    s += pitch
            moved = brentq(lacking, 0.0, 1e-3, (np.array(gaps), stiffness / transverse / slices, force), xtol=1e-15)
            # slices of the face: 33 there, 301 here
            assert force / (stiffness * course.stiffness[k]) + course.error[k] == pytest.approx(moved, rel=0.01)

    def test_flanks_are_softer_under_little_load(self):
        """ISO 6336-1, 9.3.2: (w/100 N/mm)^0.25 below 100 N/mm, none above."""
        pair = dataclasses.replace(PAIR, stiffness=None)
        loads = [dataclasses.replace(pair, tangential_force=w * 1e3 * pair.face_width) for w in (25.0, 100.0, 400.0)]
        factors = [one.mean_stiffness / pair.mean_stiffness for one in loads]
        np.testing.assert_allclose(factors, [0.25**0.25, 1.0, 1.0], rtol=1e-12)


class TestStatics:
    @pytest.mark.parametrize("torque", [82.0, -82.0, 1e-3, 1e4])
    def test_force_is_torque_over_base_radius(self, torque):
        system, place = gear_stage(torque)
        balance = equilibrium(system, Operation())
        rb1, rb2 = 0.5 * 21 * 4.5e-3 * math.cos(ALPHA), 0.5 * 23 * 4.5e-3 * math.cos(ALPHA)
        force = balance.forces[0]
        wanted = abs(torque) / rb1
        # Newton leaves 1e-10 of the largest force.
        assert np.linalg.norm(force[6:9]) == pytest.approx(wanted, rel=1e-8)
        towards = place / np.linalg.norm(place)
        along = np.cross([1.0, 0.0, 0.0], towards)
        # Apart from each other by F sin(alpha), along by F cos(alpha) in the direction of the torque.
        assert force[6:9] @ towards == pytest.approx(wanted * math.sin(ALPHA), rel=1e-8)
        assert force[6:9] @ along == pytest.approx(math.copysign(wanted, torque) * math.cos(ALPHA), rel=1e-8)
        assert force[9] == pytest.approx(-torque * rb2 / rb1, rel=1e-8)

    def test_forces_and_moments_balance(self):
        """Reactions of the mounts, with the torque, about the first centre."""
        system, place = gear_stage(82.0)
        balance = equilibrium(system, Operation())
        reactions = [
            -np.diag([0.0, 2e8, 2e8, about, 1e5, 1e5]) @ system.relative(name) @ balance.displacement
            for name, about in (("one", 0.0), ("two", 1e6))
        ]
        np.testing.assert_allclose(sum(r[:3] for r in reactions), 0.0, atol=1e-8 * 1847.0)
        moments = reactions[0][3:] + reactions[1][3:] + np.cross(place, reactions[1][:3])
        np.testing.assert_allclose(moments, [-82.0, 0.0, 0.0], atol=1e-8 * 82.0)

    def test_stiffness_of_the_mesh_in_turning(self):
        """With stiff mounts a torque turns the first gear by T/(rb^2 k); TOUCH/2 is the stated offset of contact."""
        even = dataclasses.replace(PAIR, harmonics=0)
        turns = [
            equilibrium(gear_stage(torque, 0.7, even, 1e13)[0], Operation()).displacement[2] for torque in (82.0, 164.0)
        ]
        rb1, rb2 = PAIR.base_radii
        compliance = 1.0 / (14e9 * 25e-3 * rb1**2) + (rb2 / rb1) ** 2 / 1e6
        # 2e-4: mounts of 1e13 N/m against the mesh of 3.5e8 N/m.
        assert turns[1] - turns[0] == pytest.approx(82.0 * compliance, rel=2e-4)
        assert turns[0] == pytest.approx(82.0 * compliance + 0.5 * TOUCH / rb1, rel=2e-4)

    def test_stiffness_and_error_are_those_of_the_angle(self):
        """At each angle the mesh gives way by F/k(phase) and stands e farther: a constant F shows both."""
        wavy = dataclasses.replace(PAIR, harmonics=(0.3, 0.1), transmission_error=(5e-7,))
        rb1, rb2 = PAIR.base_radii
        system, _ = gear_stage(82.0, 0.7, wavy, 1e13)
        for angle in (0.0, 0.03, 0.1, 0.2):
            phase = 21.0 * angle
            k = 14e9 * 25e-3 * (1.0 + 0.3 * math.cos(phase) + 0.1 * math.cos(2.0 * phase))
            turn = equilibrium(system, Operation(0.0, angle)).displacement[2]
            offset = 5e-7 * math.cos(phase) + 0.5 * TOUCH
            expected = 82.0 / rb1**2 / k + 82.0 * (rb2 / rb1) ** 2 / 1e6 + offset / rb1
            assert turn == pytest.approx(expected, rel=2e-4)  # the mounts, as above


HELIX = math.radians(17.0)
HELICAL = dataclasses.replace(PAIR, helix_angle=HELIX, module=3e-3, face_width=30e-3, damping=1e3)


def helical_mesh(hand=1.0, angle=0.7):
    """A helical pair with the second centre at an angle from y; the centre of that gear."""
    pair = dataclasses.replace(HELICAL, helix_angle=hand * HELIX)
    place = pair.centre_distance * np.array([0.0, math.cos(angle), math.sin(angle)])
    return gear_mesh(pair, (0.0, 0.0, 0.0), place, 1.0, SPIN2), place


class TestHelical:
    @pytest.mark.parametrize(("hand", "turn"), [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0)])
    def test_forces_are_those_of_the_textbook(self, hand, turn):
        """F_t tan(beta) axially, F_t tan(alpha_n)/cos(beta) apart, and the moment of the axial force about the centre.

        A right-handed gear that drives with a torque +x pushes itself along +x: right-hand rule of the thrust.
        """
        mesh, place = helical_mesh(hand)
        motion = np.zeros(12)
        motion[3] = turn * 6e-3  # more than the backlash: the first gear turns by itself, and presses a flank
        force = mesh.evaluate(motion, np.zeros(12), Operation(0.0)).force
        towards = place / np.linalg.norm(place)
        along = np.cross([1.0, 0.0, 0.0], towards)
        first, second = HELICAL.pitch_radii
        tangential = force[6:9] @ along
        assert first == pytest.approx(0.5 * 21 * 3e-3 / math.cos(HELIX), rel=1e-14)
        assert math.copysign(1.0, tangential) == turn
        size = abs(tangential)
        assert force[6:9] @ towards == pytest.approx(size * math.tan(ALPHA) / math.cos(HELIX), rel=1e-12)
        assert force[0] == pytest.approx(hand * turn * size * math.tan(HELIX), rel=1e-12)
        assert force[3] == pytest.approx(-tangential * first, rel=1e-12)
        # the whole force over the tangential one, by the normal section
        assert np.linalg.norm(force[:3]) == pytest.approx(size / (math.cos(ALPHA) * math.cos(HELIX)), rel=1e-12)
        for moment, arm, part in ((force[3:6], first, force[:3]), (force[9:], -second, force[6:9])):
            np.testing.assert_allclose(moment, np.cross(arm * towards, part), atol=1e-12 * size * second)
        assert np.linalg.norm(force[4:6]) == pytest.approx(abs(force[0]) * first, rel=1e-12)

    def test_momentum_and_angular_momentum_balance(self):
        mesh, place = helical_mesh()
        rng = np.random.default_rng(3)
        for _ in range(5):
            force = mesh.evaluate(1e-4 * rng.standard_normal(12), rng.standard_normal(12), Operation(3.0, 0.2)).force
            np.testing.assert_allclose(force[:3] + force[6:9], 0.0, atol=1e-12 * np.abs(force).max())
            moment = force[3:6] + force[9:] + np.cross(place, force[6:9])
            np.testing.assert_allclose(moment, 0.0, atol=1e-12 * np.abs(force).max())

    def test_force_is_the_slope_of_the_energy(self):
        """The second method: central differences of the stored energy by all twelve displacements, 1e-8 apart."""
        mesh, _ = helical_mesh()
        motion = 1e-5 * np.random.default_rng(1).standard_normal(12) + 2e-3 * np.eye(12)[3]
        operation = Operation(0.0, 0.3)
        slopes = []
        for unit in np.eye(12):
            high, low = (mesh.stored(None, motion + side * 1e-8 * unit, operation) for side in (1.0, -1.0))
            slopes.append((high - low) / 2e-8)
        force = mesh.evaluate(motion, np.zeros(12), operation).force
        # round-off of the energy, 1e-16 of it over 1e-8
        np.testing.assert_allclose(force, -np.array(slopes), rtol=1e-6, atol=1e-6 * np.abs(force).max())

    def test_a_turn_and_the_travel_along_the_helix_belong_together(self):
        """A gear that moves along x by s as it turns by s tan(beta)/r, a screw on its helix, meets no resistance."""
        mesh, _ = helical_mesh()
        screw = np.zeros(12)
        screw[0], screw[3] = 1.0, math.tan(HELIX) / HELICAL.pitch_radii[0]
        np.testing.assert_allclose(mesh.rows @ screw, 0.0, atol=1e-15)

    def test_harmonics_are_those_of_the_mean_over_the_face(self):
        """Spur slices that lag along the face, averaged; the midpoint rule with 2000 slices leaves 1e-6."""
        transverse, overlap = HELICAL.contact_ratios
        assert overlap == pytest.approx(30e-3 * math.sin(HELIX) / (math.pi * 3e-3), rel=1e-14)
        lag = 2.0 * math.pi * overlap * ((np.arange(2000) + 0.5) / 2000 - 0.5)
        for order, (spur, helical) in enumerate(
            zip(pair_harmonics(transverse, 6), pair_harmonics(transverse, 6, overlap), strict=True), start=1
        ):
            assert helical == pytest.approx(spur * np.mean(np.cos(order * lag)), abs=1e-6)
        assert max(np.abs(pair_harmonics(transverse, 6, 2.0))) < 1e-15  # whole overlaps leave nothing

    def test_contact_ratio_is_that_of_the_transverse_section(self):
        """Tip circles of the normal addendum, on coordinates of the transverse section, by Pythagoras."""
        angle = math.atan(math.tan(ALPHA) / math.cos(HELIX))
        module = 3e-3 / math.cos(HELIX)
        reach = -0.5 * 44 * module * math.sin(angle)
        for z in (21, 23):
            tip, base = 0.5 * z * module + 3e-3, 0.5 * z * module * math.cos(angle)
            reach += math.sqrt(tip**2 - base**2)
        assert HELICAL.contact_ratios[0] == pytest.approx(reach / (math.pi * module * math.cos(angle)), rel=1e-12)

    def test_a_spur_pair_is_a_helical_pair_of_angle_zero(self):
        mesh = gear_mesh(PAIR, (0.0, 0.0, 0.0), (0.0, 99e-3, 0.0), 1.0, SPIN2)
        assert not np.any(mesh.rows[:, [0, 4, 5, 6, 10, 11]])
        assert PAIR.contact_ratios[1] == 0.0


def single(pair, torque=0.0, stiffness=0.0):
    """One gear that only turns, against a gear that does not give way."""
    bodies = [rigid_body("one", [GEAR], ["theta_x"], spin=1.0)]
    springs = [Spring("twist", "one", "ground", np.diag([0.0, 0.0, 0.0, stiffness, 0.0, 0.0]))] if stiffness else []
    loads = [Load("torque", "one", np.array([0.0, 0.0, 0.0, torque, 0.0, 0.0]))]
    mesh = gear_mesh(dataclasses.replace(pair, against="ground"), (0.0,) * 3, (0.0, 0.099, 0.0), 1.0, SPIN2)
    return System(bodies, springs, loads, [mesh])


class TestParametricExcitation:
    @pytest.mark.parametrize("ratio", [2.0, 1.0, 0.37])
    def test_against_an_independent_integrator(self, ratio):
        """A damped Mathieu oscillator with transmission error, at and off its resonances.

        Reference: DOP853 with rtol 1e-11. Second order: half the step leaves a quarter of the error, 10 % around it
        for higher orders; both extrapolated leave what is of fourth order.
        """
        pair = dataclasses.replace(PAIR, harmonics=(0.1, 0.05), damping=4e3, transmission_error=(1e-6,))
        inertia, rb, torque = GEAR.polar, PAIR.base_radii[0], 400.0
        omega = math.sqrt(14e9 * 25e-3 * rb**2 / inertia)
        speed = ratio * omega / 21.0
        system = single(pair, torque)
        start = equilibrium(system, Operation(speed)).displacement
        duration = 12.0 * 2.0 * math.pi / omega

        def motion(t, y):
            phase = 21.0 * speed * t
            k = 14e9 * 25e-3 * (1.0 + 0.1 * math.cos(phase) + 0.05 * math.cos(2.0 * phase))
            gap = rb * y[0] - 1e-6 * math.cos(phase)
            rate = rb * y[1] + 1e-6 * 21.0 * speed * math.sin(phase)
            return [y[1], (torque - rb * (k * (gap - 0.5 * TOUCH) + 4e3 * rate)) / inertia]

        course = solve_ivp(
            motion, (0.0, duration), [start[0], 0.0], "DOP853", rtol=1e-11, atol=1e-18, max_step=duration / 100
        ).y[0]
        assert rb * course.min() > 1e-6 + TOUCH  # it stays in whole contact, so that `motion` is its equation
        exact = course[-1]
        found = []
        for steps in (2000, 4000):
            h = duration / steps
            run = integrate(system, SpeedProfile.constant(speed), duration, Settings(h, duration, 1.0), start)
            found.append(run.states.displacement[-1, 0])
        scale = float(start[0])
        errors = [abs(value - exact) / scale for value in found]
        assert errors[0] < 3e-3
        assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
        assert abs((4.0 * found[1] - found[0]) / 3.0 - exact) / scale < 0.02 * errors[0]


class TestSeparation:
    """A gear rattles between both flanks of its mate."""

    SPEED = 3.0

    def rattle(self, damping):
        pair = dataclasses.replace(PAIR, harmonics=0, damping=damping)
        system = single(pair, stiffness=50.0)
        h = 2e-7
        run = integrate(system, SpeedProfile.constant(0.0), 8e-3, Settings(h, h, 1.0), velocity=np.array([self.SPEED]))
        mesh = system.elements[0].element
        flanks = run.states.displacement @ (system.elements[0].transform.T @ mesh.rows.T)
        depth = np.maximum(flanks - np.array([0.0, PAIR.backlash]), 0.0)
        s = np.minimum(depth, TOUCH)
        k = 14e9 * 25e-3
        # Of the stated law at rest: k s^3/(6 TOUCH) within TOUCH, k (depth - TOUCH/2)^2/2 and a constant beyond.
        beyond = 0.5 * k * ((depth - 0.5 * TOUCH) ** 2 - 0.25 * TOUCH**2) * (depth > TOUCH)
        energy = 0.5 * GEAR.polar * run.states.velocity[:, 0] ** 2 + 25.0 * run.states.displacement[:, 0] ** 2
        energy += (k * s**3 / (6.0 * TOUCH) + beyond).sum(axis=1)
        return run, depth, energy

    def test_keeps_its_energy_without_damping(self):
        _, depth, energy = self.rattle(0.0)
        strikes = np.count_nonzero(np.diff((depth > 0.0).astype(int), axis=0) > 0, axis=0)
        assert strikes.min() >= 3
        # The steps of 0.2 us across the edges of the contact, 5 nm long at this speed: some 1e-4 a strike.
        assert np.abs(energy / energy[0] - 1.0).max() < 2e-3

    def test_only_loses_energy_with_damping(self):
        run, depth, energy = self.rattle(2e3)
        assert np.diff(energy).max() < 1e-3 * energy[0]  # as above, in a single step
        assert energy[-1] < 0.9 * energy[0]
        apart = np.all(depth == 0.0, axis=1)
        assert apart.any()
        np.testing.assert_array_equal(run.forces[0][apart], 0.0)
        # The push of each flank, from the force that it leaves on the first gear: never a pull.
        pushes = -run.forces[0] @ np.linalg.pinv(single(PAIR).elements[0].element.rows)
        assert pushes.min() > -1e-9 * pushes.max()

"""Bodies, springs and elements put together; the equilibrium; modes and responses against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from mbs.linearised.linear import frequency_response, state_space, with_peaks
from mbs.linearised.modes import modes, undamped_modes
from mbs.model.body import Inertia, lever_arm, rigid_body
from mbs.model.elements import Input, Load, Operation, Port, Sensor, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Constant, Course, HalfSine, Harmonic, SpeedProfile
from mbs.model.system import System
from tests.cases.elements import MASS, OneSided, force, stiff

ROUND_OFF = 1e-12


class TestBody:
    def test_cylinder_has_the_inertia_of_the_textbooks(self):
        part = Inertia.cylinder(0.0, 0.2, 0.07, 0.02, density=7850.0)
        mass = 7850.0 * math.pi / 4.0 * (0.07**2 - 0.02**2) * 0.2
        assert part.mass == pytest.approx(mass, rel=ROUND_OFF)
        assert part.polar == pytest.approx(mass * (0.07**2 + 0.02**2) / 8.0, rel=ROUND_OFF)
        assert part.transverse == pytest.approx(part.polar / 2.0 + mass * 0.2**2 / 12.0, rel=ROUND_OFF)
        assert part.offset == pytest.approx(0.1)

    def test_two_halves_are_one_cylinder(self):
        whole = rigid_body("a", [Inertia.cylinder(-0.1, 0.1, 0.05)], ["y", "z", "theta_y", "theta_z"])
        halves = rigid_body(
            "a", [Inertia.cylinder(-0.1, 0.0, 0.05), Inertia.cylinder(0.0, 0.1, 0.05)], ["y", "z", "theta_y", "theta_z"]
        )
        np.testing.assert_allclose(halves.mass, whole.mass, rtol=ROUND_OFF, atol=1e-15)
        np.testing.assert_allclose(halves.gyroscopic, whole.gyroscopic, rtol=ROUND_OFF)

    def test_centre_of_mass_aside_couples_translation_and_tilt(self):
        body = rigid_body("a", [Inertia(2.0, 0.01, 0.02, offset=0.1)], ["y", "theta_z"])
        np.testing.assert_allclose(body.mass, [[2.0, 0.2], [0.2, 0.02 + 2.0 * 0.01]])

    def test_two_point_masses_apart_have_a_moment_of_inertia(self):
        body = rigid_body("a", [Inertia(2.0, 0.0, 0.0, 0.1), Inertia(2.0, 0.0, 0.0, -0.1)], ["y", "theta_z"])
        np.testing.assert_allclose(body.mass, [[4.0, 0.0], [0.0, 0.04]], atol=ROUND_OFF)

    def test_lever_arm_is_the_cross_product(self):
        rotation, offset = np.array([0.1, -0.2, 0.3]), np.array([0.5, 0.7, -0.4])
        moved = lever_arm(offset) @ np.array([0, 0, 0, *rotation])
        np.testing.assert_allclose(moved[:3], np.cross(rotation, offset), rtol=ROUND_OFF)

    @pytest.mark.parametrize(
        ("make", "message"),
        [
            (lambda: Inertia(0.0, 1.0, 1.0), "mass: got 0.0 kg; allowed: finite and > 0"),
            (lambda: Inertia(1.0, -1.0, 1.0), "polar: got -1.0 kg m2; allowed: finite and >= 0"),
            (lambda: rigid_body("a", [Inertia(1.0, 0.0, 0.0)], ["y", "theta_z"]), "got theta_z, about which its parts"),
            (
                lambda: rigid_body("a", [Inertia(1.0, 0.0, 1.0)], ["theta_x"]),
                "got theta_x, about which its parts have no",
            ),
            (lambda: Inertia(1.0, 3.0, 1.0), "at most twice the transverse"),
            (lambda: Inertia(1.0, 1.0, 1.0, math.nan), "offset: got nan m; allowed: finite"),
            (lambda: Inertia.cylinder(0.0, 1.0, 0.05, 0.06), "0 <= bore < diameter"),
            (lambda: rigid_body("a", [MASS], ["y", "w"]), "freedoms: got 'w'; allowed: x, y"),
            (lambda: rigid_body("a", [MASS], ["y", "y"]), "each once"),
            (lambda: rigid_body("a", [MASS], []), "freedoms: got none"),
            (lambda: rigid_body("a", [], ["y"]), "parts: got none"),
            (lambda: rigid_body("a", [MASS], ["y"], frames={"centre": (0, 0, 0)}), "'centre' is there already"),
        ],
    )
    def test_what_is_no_body_is_refused(self, make, message):
        with pytest.raises(InputError, match=message.replace("(", r"\(")):
            make()


class TestSystem:
    def test_problems_come_all_at_once(self):
        body = rigid_body("a", [MASS], ["y"])
        far = rigid_body("b", [MASS], ["y"], position=(0.1, 0.0, 0.0))
        with pytest.raises(InputError) as caught:
            System(
                [body, far],
                [Spring("a", "c", "ground", stiff(y=1.0)), Spring("s", "a", "b", stiff(y=1.0))],
                [Load("l", "a:tip", force(y=1.0))],
            )
        text = "\n".join(caught.value.problems)
        assert "'a': is there twice" in text
        assert "spring 'a': got the body 'c'" in text
        assert "load 'l': got the frame 'tip' of 'a'; allowed: centre" in text
        assert "a and b are 100 mm apart; allowed: the same point" in text

    def test_an_element_says_whether_it_excites(self):
        class Old:
            name, ports = "old", (Port("a"),)

        with pytest.raises(InputError, match=r"'old', excitation: missing; .*\.model\.elements\.ElementDefaults"):
            System([rigid_body("a", [MASS], ["y"])], (), (), [Old()])
        with pytest.raises(InputError, match="bodies: got none"):
            System([])

    def test_internal_forces_do_no_work_on_a_rigid_motion(self):
        """Linear and angular momentum: springs, loads and elements between bodies balance to round-off."""
        rng = np.random.default_rng(1)
        full = ["x", "y", "z", "theta_x", "theta_y", "theta_z"]
        first = rigid_body("first", [MASS], full, frames={"joint": (0.3, 0.1, -0.2)})
        second = rigid_body("second", [MASS], full, position=(0.5, 0.0, 0.0), frames={"joint": (-0.2, 0.1, -0.2)})
        random = rng.normal(size=(6, 6))
        system = System(
            [first, second],
            [Spring("s", "first:joint", "second:joint", random @ random.T, np.eye(6))],
            [Load("l", "first:joint", rng.normal(size=6), "second:joint")],
            [OneSided("c", "first:joint", "second:joint", k=1.0, gap=-10.0)],
        )
        rigid = np.vstack([lever_arm(body.frames["centre"].position) for body in system.bodies])
        motion = rng.normal(size=12)
        connected = system.elements[0]
        contact = connected.transform.T @ connected.evaluate(motion, motion, Operation()).force
        assert np.abs(contact).max() > 1e-3
        for forces in (system.stiffness @ motion, system.damping @ motion, system.loads(0.0), contact):
            np.testing.assert_allclose(rigid.T @ forces, 0.0, atol=1e-13 * max(np.abs(forces).max(), 1.0))

    def test_gyroscopic_terms_conserve_angular_momentum(self):
        """A free spinning body precesses at I_p Omega/I_t."""
        body = rigid_body("a", [MASS], ["theta_y", "theta_z"], spin=2.0)
        balance = equilibrium(System([body]), Operation(speed=30.0))
        found = modes(balance)
        assert found.frequency.max() == pytest.approx(0.01 * 60.0 / 0.02 / (2.0 * math.pi), rel=1e-12)
        assert np.abs(found.shares).max(initial=0.0) == 0.0

    def test_profiles(self):
        ramp = SpeedProfile.ramp(0.0, 100.0, 2.0)
        assert ramp.at(1.0) == (50.0, 25.0)
        assert ramp.at(3.0) == (100.0, 200.0)
        assert SpeedProfile.constant(7.0).at(2.0) == (7.0, 14.0)
        assert Course((0.0, 1.0), (1.0, 3.0))(0.5) == 2.0
        assert Course((1.0, 2.0), (1.0, 3.0))(0.0) == 1.0
        assert Harmonic(1.0)(0.25) == pytest.approx(1.0)
        assert Constant()(5.0) == 1.0
        for make, message in (
            (lambda: Course((0.0,), (1.0, 2.0)), "1 times and 2 values"),
            (lambda: Course((1.0, 0.0), (1.0, 2.0)), "allowed: finite and rising"),
            (lambda: SpeedProfile(Course((1.0,), (1.0,))), "allowed: 0 s"),
        ):
            with pytest.raises(InputError, match=message):
                make()


class TestStatics:
    SPRING = (Spring("s", "a", "ground", stiff(y=10.0)),)

    @pytest.mark.parametrize("start", [0.0, -1e-3, 1e-3, 5e-6])
    @pytest.mark.parametrize("gap", [0.0, 2e-5])
    def test_a_contact_is_found_from_anywhere(self, start, gap):
        body = rigid_body("a", [MASS], ["y"])
        system = System([body], (), [Load("l", "a", force(y=100.0))], [OneSided("c", "a", gap=gap)])
        balance = equilibrium(system, Operation(), start=np.array([start]))
        assert balance.displacement[0] == pytest.approx(gap + (100.0 / 1e12) ** (2.0 / 3.0), rel=1e-9)
        assert balance.residual < 1e-9
        assert balance.parts["c"][0, 0] == pytest.approx(1.5e12 * (100.0 / 1e12) ** (1.0 / 3.0), rel=1e-9)

    def test_what_moves_freely_under_a_load_is_said(self):
        body = rigid_body("a", [MASS], ["y", "z"])
        system = System([body], self.SPRING, [Load("l", "a", force(z=1.0))])
        with pytest.raises(AnalysisError, match=r"1 N remain on a\.z .*something moves freely under its load"):
            equilibrium(system, Operation())

    def test_a_load_that_varies_counts_at_its_time(self):
        body = rigid_body("a", [MASS], ["y"])
        system = System([body], self.SPRING, [Load("l", "a", force(y=1.0), profile=Course((0.0, 1.0), (0.0, 1e-4)))])
        assert equilibrium(system, Operation()).displacement[0] == 0.0
        assert equilibrium(system, Operation(time=0.5)).displacement[0] == pytest.approx(5e-6)


class TestLinear:
    def oscillator(self, c=3.0):
        body = rigid_body("a", [MASS], ["y"])
        return equilibrium(System([body], [Spring("s", "a", "ground", stiff(y=5e4), stiff(y=c))]), Operation())

    def test_one_mass(self):
        found = modes(self.oscillator())
        omega = math.sqrt(5e4 / 2.0)
        assert found.frequency == pytest.approx([omega / (2.0 * math.pi)], rel=1e-12)
        assert found.damping_ratio == pytest.approx([3.0 / (2.0 * 2.0 * omega)], rel=1e-10)
        assert found.shares == pytest.approx(np.array([[1.0]]))
        plain = undamped_modes(self.oscillator())
        assert plain.frequency == pytest.approx(found.frequency, rel=1e-12)
        assert plain.damping_ratio == pytest.approx(found.damping_ratio, rel=1e-10)

    def test_an_overdamped_freedom_has_two_real_eigenvalues(self):
        found = modes(self.oscillator(c=4000.0))
        assert found.eigenvalues.imag == pytest.approx([0.0, 0.0])
        assert found.damping_ratio == pytest.approx([1.0, 1.0])

    @pytest.mark.parametrize(("quantity", "order"), [("displacement", 0), ("velocity", 1), ("acceleration", 2)])
    def test_response_of_one_mass(self, quantity, order):
        balance = self.oscillator()
        frequencies = np.array([1.0, 25.0, 400.0])
        omega = 2.0 * np.pi * frequencies
        inputs = [Input("E", "a", force(y=1.0))]
        sensors = [Sensor("S", "a", force(y=1.0), quantity)]
        expected = (1j * omega) ** order / (5e4 + 3j * omega - 2.0 * omega**2)
        np.testing.assert_allclose(
            frequency_response(balance, inputs, sensors, frequencies)[:, 0, 0], expected, rtol=1e-12
        )
        space = state_space(balance, inputs, sensors)
        by_space = [(space.C @ np.linalg.solve(1j * w * np.eye(2) - space.A, space.B) + space.D)[0, 0] for w in omega]
        np.testing.assert_allclose(by_space, expected, rtol=1e-11)

    def test_sensors_subtract(self):
        bodies = [rigid_body(name, [MASS], ["y"]) for name in ("a", "b")]
        springs = [Spring("s", "a", "b", stiff(y=1e4)), Spring("g", "b", "ground", stiff(y=2e4))]
        balance = equilibrium(System(bodies, springs), Operation())
        sensors = [
            Sensor("d", "a", force(y=1.0), against="b"),
            Sensor("a", "a", force(y=1.0)),
            Sensor("b", "b", force(y=1.0)),
        ]
        response = frequency_response(balance, [Input("E", "a", force(y=1.0))], sensors, np.array([7.0]))[0, :, 0]
        assert response[0] == pytest.approx(response[1] - response[2], rel=1e-12)
        found = modes(balance)
        assert found.parts == ("s", "g")
        np.testing.assert_allclose(found.shares.sum(axis=0), 1.0, rtol=1e-12)


def test_an_axis_gets_the_peaks_that_it_steps_over():
    """Height 1/(2 zeta) of a freedom whose peak is a thousandth of the step of the axis wide."""
    ratio, omega = 1e-4, 2.0 * np.pi * 505.0
    eigenvalue = omega * complex(-ratio, np.sqrt(1.0 - ratio**2))
    coarse = np.linspace(100.0, 1000.0, 10)
    axis = with_peaks(
        coarse, np.array([eigenvalue, -200.0 + 0j, 1j * omega * 1.5, omega * (0.3 + 1j), 10.0 * eigenvalue])
    )
    assert axis.size == coarse.size + 11
    assert np.all(np.isin(coarse, axis))
    assert np.all(np.diff(axis) > 0.0)
    s = 2j * np.pi * axis
    height = np.max(np.abs(omega**2 / (s**2 + 2.0 * ratio * omega * s + omega**2)))
    # between the place of the free vibration and that of the highest response, zeta^2 apart
    assert height == pytest.approx(1.0 / (2.0 * ratio), rel=1e-6)
    assert with_peaks(np.zeros(0), np.array([eigenvalue])).size == 0


def test_a_blow_is_added_to_the_loads():
    body = rigid_body("body", [Inertia(2.0, 1e-3, 2e-3)], ("y", "z"))
    plain = System([body], loads=[Load("weight", "body", np.array([0.0, 0.0, -20.0, 0.0, 0.0, 0.0]))])
    struck = plain.with_load(np.array([100.0, 0.0]), HalfSine(1e-3, 2e-4))
    for time, factor in ((0.0, 0.0), (1.05e-3, np.sqrt(0.5)), (1.1e-3, 1.0), (1.2e-3, 0.0), (1.0, 0.0)):
        np.testing.assert_allclose(struck.loads(time), [100.0 * factor, -20.0], atol=1e-9)  # sine of pi, rounded
    np.testing.assert_allclose(plain.loads(1.1e-3), [0.0, -20.0])

"""Critical speeds, unbalance response and bearings by matrices: beside ROSS and closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from mbs import SweepRange, SweepSettings, assemble, critical, parse_scene
from mbs.linearised.critical import order_responses
from mbs.linearised.modes import modes
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.settings import Settings
from mbs.transient.run import Options, run
from tests.cases.rotors import DISC, FAN, OVERHUNG, fan, overhung

RPM = math.pi / 30.0


class TestBesideRoss:
    """An overhung rotor on cross-coupled bearings whose matrices change with the speed, and the shipped one."""

    @pytest.fixture(scope="class", params=["overhung", "fan"])
    @staticmethod
    def machine(request):
        make, case, place = {
            "overhung": (overhung, OVERHUNG, "shaft:disc"),
            "fan": (fan, FAN, "rotor:wheel"),
        }[request.param]
        return assemble(make()), case, place

    def test_critical_speeds(self, machine):
        model, case, _ = machine
        fastest = 1.02 * max(case["critical_speeds"]) * RPM
        found = critical(model, SweepSettings(SweepRange(10.0, fastest, 20))).found
        bending = [entry for entry in found if not math.isnan(entry.whirl)]
        # Coarser elements of the shipped shaft are left, as `largest_element` chooses them for its cut-off: 1e-5.
        np.testing.assert_allclose([c.speed / RPM for c in bending], case["critical_speeds"], rtol=5e-5)
        np.testing.assert_allclose([c.damping_ratio for c in bending], case["critical_damping_ratios"], rtol=1e-4)
        # Backward before forward.
        assert [c.whirl > 0.0 for c in bending] == [False, True] * (len(bending) // 2)

    def test_unbalance_response(self, machine):
        model, case, place = machine
        speeds = np.array(case["response_speeds"]) * RPM
        (response,) = order_responses(lambda speed: model.system, speeds)
        found = response.motion @ model.system.relative(place)[1:3].T
        wanted = np.array(case["amplitudes"]) @ np.array([[1, 0], [1j, 0], [0, 1], [0, 1j]])
        # Beside a resonance, 0.65 % away, an error of 4e-6 in its frequency is one of 7e-4.
        np.testing.assert_allclose(found, wanted, rtol=1e-3, atol=1e-6 * np.abs(wanted).max())

    def test_forces_that_are_drawn_between_two_speeds(self, machine):
        """By a stiffness that is the same at all speeds, gyroscopic terms and inertia they are exact to round-off."""
        model, case, _ = machine
        ends = np.array([case["response_speeds"][0], case["response_speeds"][-1]]) * RPM
        (coarse,) = order_responses(lambda speed: model.system, ends, drawn=8)
        (fine,) = order_responses(lambda speed: model.system, np.linspace(*ends, 9))
        np.testing.assert_allclose(coarse.drawn_speeds, np.linspace(*ends, 9), rtol=1e-12)
        assert np.abs(fine.forces).max() > 0.0
        np.testing.assert_allclose(coarse.drawn_forces, fine.forces, atol=1e-7 * np.abs(fine.forces).max())


MASS, STIFFNESS, DAMPING = 2.0, 2e5, 40.0
NATURAL = math.sqrt(STIFFNESS / MASS)

SEAL = """
[[springs]]
name = "seal"
on = "disc"
speeds = ["0 rad/s", "2000 rad/s"]
stiffness = { y_z = ["0 N/m", "4e4 N/m"], z_y = ["0 N/m", "-4e4 N/m"] }
"""
SLOPE = 20.0


class TestJeffcott:
    def test_unbalance_of_a_closed_form(self):
        text = DISC + '[[unbalances]]\nname = "u"\non = "disc"\nmass = "20 g"\nradius = "10 mm"\n'
        found = critical(assemble(parse_scene(text, "jeffcott", "jeffcott")), SweepSettings(SweepRange(50.0, 600.0, 8)))
        ratio = found.speeds / NATURAL
        zeta = DAMPING / (2.0 * math.sqrt(MASS * STIFFNESS))
        wanted = 2e-4 / MASS * ratio**2 / np.hypot(1.0 - ratio**2, 2.0 * zeta * ratio)
        axes = found.dataset["orbit_major"].sel(order=1.0, place="disc:centre").values
        np.testing.assert_allclose(axes, wanted, rtol=1e-9)
        # Circles with the spin.
        np.testing.assert_allclose(found.dataset["orbit_minor"].values.ravel(), wanted, rtol=1e-9)
        assert [c.speed for c in found.found] == pytest.approx([NATURAL * math.sqrt(1.0 - zeta**2)] * 2, rel=1e-7)

    @pytest.mark.parametrize("points", [2, 3, 40])
    def test_modes_close_together_keep_apart_at_coarse_speeds(self, points):
        """Softest near the crossing, both lie below what is between the ends: k(speed)/m = speed^2 + (c/2m)^2."""
        soft = {"y": "0", "z": "500"}
        rows = ", ".join(f'{axis} = ["1e5 N/m", "{low} N/m", "1e5 N/m"]' for axis, low in soft.items())
        speeds = [0.0, NATURAL, 2.0 * NATURAL]
        table = f'[[springs]]\nname = "s"\non = "disc"\nspeeds = {[f"{speed!r} rad/s" for speed in speeds]}\n'
        model = assemble(parse_scene(f"{DISC}{table}stiffness = {{ {rows} }}\n", "soft", "soft"))
        found = critical(model, SweepSettings(SweepRange(20.0, 600.0, points))).found

        def apart(speed, low):
            stiffness = STIFFNESS + np.interp(speed, speeds, [1e5, low, 1e5])
            return stiffness / MASS - speed**2 - (0.5 * DAMPING / MASS) ** 2

        wanted = [brentq(apart, 300.0, 340.0, args=(float(low),)) for low in soft.values()]
        assert [one.speed for one in found] == pytest.approx(wanted, rel=1e-6)  # 1e-7 of the frequency

    @pytest.mark.parametrize(("zeta", "peak"), [(0.69, True), (0.72, False)])
    def test_a_mode_without_a_peak_has_no_critical_speed(self, zeta, peak):
        # Closed form: r^2/|1 - r^2 + 2 i zeta r| has a largest value at finite r for zeta below 1/sqrt(2) only.
        damping = f"{2.0 * zeta * MASS * NATURAL:.17g} N s/m"
        text = DISC.replace("40 N s/m", damping) + '[[unbalances]]\nname = "u"\non = "disc"\nmoment = "200 g mm"\n'
        found = critical(assemble(parse_scene(text, "damped", "damped")), SweepSettings(SweepRange(20.0, 4000.0, 40)))
        assert bool(found.found) is peak
        largest = int(np.argmax(found.dataset["orbit_major"].sel(order=1.0, place="disc:centre").values))
        assert (largest < found.speeds.size - 1) is peak

    @pytest.mark.parametrize(("part", "grows"), [(0.98, False), (1.02, True)])
    def test_whirl_sets_in_where_cross_coupling_beats_damping(self, part, grows):
        # m s^2 + c s + k - i kc = 0 has a root on the imaginary axis at kc = c sqrt(k/m).
        system = assemble(parse_scene(DISC + SEAL, "seal", "seal")).system
        threshold = DAMPING * NATURAL / SLOPE
        found = modes(equilibrium(system, Operation(part * threshold)))
        assert bool(min(found.damping_ratio) < 0.0) is grows
        wanted = np.roots([MASS, DAMPING, STIFFNESS - 1j * SLOPE * part * threshold])
        for value in wanted[wanted.imag > 0.0]:
            assert np.min(np.abs(found.eigenvalues - value)) <= 1e-9 * abs(value)

    @pytest.mark.parametrize("compiled", [True, False])
    def test_whirl_in_time(self, compiled):
        system = assemble(parse_scene(DISC + SEAL, "seal", "seal")).system
        speed = 2.0 * DAMPING * NATURAL / SLOPE
        start = np.array([1e-6, 0.0])
        record = run(
            system,
            SpeedProfile.constant(speed),
            0.2 if compiled else 0.02,
            Settings(2e-5, 1e-3, 1.0),
            displacement=start,
            options=Options(states=True, compiled=compiled),
        )
        # y + i z follows m s^2 + c s + k - i kc, from rest by both roots.
        roots = np.roots([MASS, DAMPING, STIFFNESS - 1j * SLOPE * speed])
        parts = np.linalg.solve(np.array([[1.0, 1.0], roots]), [1e-6, 0.0])
        whirl = (parts * np.exp(np.multiply.outer(record.time, roots))).sum(axis=1)
        found = record.states.displacement
        size = np.abs(whirl).max()
        # The trapezoidal rule: phase (w h)^2/12 w t, 1e-4 here, and growth likewise.
        np.testing.assert_allclose(found[:, 0], whirl.real, atol=5e-4 * size)
        np.testing.assert_allclose(found[:, 1], whirl.imag, atol=5e-4 * size)
        energy = record.energy
        assert energy.driven > 0.0
        assert energy.relative_residual <= 1e-4


def test_energy_of_a_table_over_a_run_up():
    text = (
        DISC
        + SEAL.replace("y_z", 'y = ["1e5 N/m", "-5e4 N/m"], y_z').replace("20 N s/m", "")
        + '[[unbalances]]\nname = "u"\non = "disc"\nmoment = "200 g mm"\n'
    )
    system = assemble(parse_scene(text, "table", "table")).system
    record = run(system, SpeedProfile.ramp(0.0, 400.0, 0.1), 0.1, Settings(1e-5, 1e-4, 1.0))
    # What is left is the trapezoidal rule, of the samples for what the speed brings.
    assert record.energy.relative_residual <= 1e-3
    assert sum(element.by_speed for element in record.energy.elements) < 0.0


def test_negative_stiffness_in_statics_and_beyond_a_table():
    text = (
        DISC
        + """
[[loads]]
name = "f"
on = "disc"
force = ["0 N", "30 N", "0 N"]
[[springs]]
name = "pull"
on = "disc"
stiffness = { y = "-5e4 N/m" }
"""
    )
    q = equilibrium(assemble(parse_scene(text, "pull", "pull")).system, Operation()).displacement
    assert q[0] == pytest.approx(30.0 / 1.5e5, rel=1e-9)
    q = equilibrium(
        assemble(parse_scene(text.replace('"-5e4', '"-5e5'), "pull", "pull")).system, Operation()
    ).displacement
    assert q[0] == pytest.approx(-30.0 / 3e5, rel=1e-9)
    found = equilibrium(assemble(parse_scene(text + SEAL, "seal", "seal")).system, Operation(3000.0))
    assert found.outside == {"seal": True}
    np.testing.assert_allclose(found.displacement, np.linalg.solve([[1.5e5, 4e4], [-4e4, 2e5]], [30.0, 0.0]), rtol=1e-9)

"""The energy balance of runs: against closed forms, of each element along a path, and how it falls with the step."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbs import assemble, read_scene
from mbs.gears.gear import GearMesh
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Harmonic, SpeedProfile
from mbs.model.system import System
from mbs.output.result_text import energy_lines
from mbs.output.results import run_dataset, with_energy
from mbs.settings import Settings
from mbs.transient.run import WITH_STATES, Options, run
from tests.cases.elements import OneSided, stiff

MASS, STIFFNESS, DAMPING = 2.0, 2e7, 300.0
STANDING = SpeedProfile.constant(0.0)


def oscillator(damping=DAMPING, loads=(), elements=()):
    body = rigid_body("m", [Inertia(MASS, 0.01, 0.02)], ("y",))
    spring = Spring("s", "m", "ground", stiff(y=STIFFNESS), stiff(y=damping))
    return System([body], [spring], loads, elements)


def steps(h, spectral_radius=0.8):
    return Settings(step=h, sample=h, spectral_radius=spectral_radius)


@pytest.mark.parametrize("compiled", [True, False])
class TestOscillator:
    def test_decay_dissipates_what_the_closed_form_loses(self, compiled):
        h, end, start = 1e-5, 5e-3, 1e-5
        found = run(oscillator(), STANDING, end, steps(h, 1.0), displacement=np.array([start]),
                    options=Options(compiled=compiled)).energy  # fmt: skip
        decay = DAMPING / (2.0 * MASS)
        ringing = math.sqrt(STIFFNESS / MASS - decay**2)
        c, s = math.cos(ringing * end), math.sin(ringing * end)
        fading = start * math.exp(-decay * end)
        q, v = fading * (c + decay / ringing * s), -fading * (ringing + decay**2 / ringing) * s
        first = 0.5 * STIFFNESS * start**2
        lost = first - 0.5 * STIFFNESS * q**2 - 0.5 * MASS * v**2
        # The trapezoidal rule takes (omega h)^2/12 = 8e-5 of the frequency, and so of the phase.
        assert found.parts["s"] == pytest.approx(lost, rel=1e-3)
        assert found.stored == pytest.approx(-lost, rel=1e-3)
        assert found.loads == found.put_in == 0.0
        # Rounding of 500 steps.
        assert abs(found.numerical) < 1e-12 * first
        assert abs(found.residual) < 1e-12 * first

    def test_what_the_method_takes_is_what_an_undamped_motion_loses(self, compiled):
        start = np.array([1e-5])
        options = Options(states=True, compiled=compiled)
        for h, part in ((2e-5, 2.4e-5), (2e-4, 0.009)):
            record = run(oscillator(0.0), STANDING, 0.02, steps(h), displacement=start, options=options)
            q, v = record.states.displacement[-1, 0], record.states.velocity[-1, 0]
            first = 0.5 * STIFFNESS * 1e-10
            lost = first - 0.5 * STIFFNESS * q**2 - 0.5 * MASS * v**2
            # Rounding.
            assert record.energy.numerical == pytest.approx(lost, abs=1e-12 * first)
            assert record.energy.numerical > 0.3 * part * first

    def test_a_load_puts_in_what_the_damper_takes_in_resonance(self, compiled):
        omega, size, end = math.sqrt(STIFFNESS / MASS), 50.0, 0.3 if compiled else 0.06
        load = Load("l", "m", np.array([0.0, size, 0, 0, 0, 0]), profile=Harmonic(omega / (2.0 * math.pi)))
        h = 2e-5
        found = run(oscillator(loads=[load]), STANDING, end, steps(h, 1.0), options=Options(compiled=compiled)).energy
        # A velocity F/c (1 - e^-at) sin(omega t) grows, a = c/(2 m): F^2/(2 c) of power, less the beginning.
        a = DAMPING / (2.0 * MASS)
        grown = end - 2.0 * (1.0 - math.exp(-a * end)) / a + (1.0 - math.exp(-2.0 * a * end)) / (2.0 * a)
        # The phase: the damper takes (a/omega) of it, the step (omega h)^2/12 omega/a = 0.014, its square 2e-4.
        assert found.parts["s"] == pytest.approx(size**2 / (2.0 * DAMPING) * grown, rel=0.02)
        assert found.loads == pytest.approx(found.parts["s"] + found.stored, rel=1e-10)


def test_a_method_that_takes_much_is_warned_of():
    found = run(oscillator(), STANDING, 5e-3, steps(1e-4, 0.0), displacement=np.array([1e-5])).energy
    assert any(line.startswith("  warning: the method of integration took") for line in energy_lines(found))
    nothing = run(oscillator(), STANDING, 1e-3, steps(1e-4)).energy
    assert energy_lines(nothing)[-1] == "  no energy went through"


def test_an_element_that_does_not_say_has_its_work_named_and_no_residual():
    contact = OneSided("stop", "m", gap=2e-6)
    found = run(oscillator(elements=[contact]), STANDING, 2e-3, steps(1e-5), displacement=np.array([1e-5])).energy
    (entry,) = found.elements
    assert not entry.told
    assert found.put_in == entry.work
    assert "stop, which does not say what it stores" in energy_lines(found)[0]
    assert abs(found.residual) < 1e-9 * found.through


@pytest.fixture(scope="module")
def model():
    return assemble(read_scene("nu308_rigid"), law="hertz:1.25e-5 s")


class TestBearings:
    @pytest.mark.parametrize("compiled", [True, False])
    def test_the_residual_falls_with_the_square_of_the_step(self, model, compiled):
        speed, size = 100.0, model.system.size
        start = equilibrium(model.system, Operation(speed)).displacement
        left = []
        for h in (2e-5, 1e-5):
            record = run(
                model.system, SpeedProfile.constant(speed), 2e-3, steps(h), displacement=start,
                velocity=np.full(size, 2e-3), options=Options(compiled=compiled),
            )  # fmt: skip
            energy = record.energy
            assert all(entry.dissipated > 0.0 for entry in energy.elements)
            left.append(energy.relative_residual)
        # Second order: a quarter; separation within a step leaves some of it at first order.
        assert left[1] < 0.5 * left[0] < 0.5e-2

    def test_both_ways_agree(self, model):
        start = equilibrium(model.system, Operation(100.0)).displacement
        found = [
            run(model.system, SpeedProfile.constant(100.0), 1e-3, steps(1e-5), displacement=start,
                velocity=np.full(model.system.size, 1e-3), options=Options(compiled=compiled)).energy
            for compiled in (True, False)
        ]  # fmt: skip
        first, second = (np.array([e.loads, e.driven, e.dissipated, e.stored, e.numerical]) for e in found)
        # What Newton leaves over.
        assert first == pytest.approx(second, abs=1e-7 * found[0].through)

    def test_lines_and_dataset(self, model):
        start = equilibrium(model.system, Operation(100.0)).displacement
        record = run(model.system, SpeedProfile.constant(100.0), 1e-3, steps(1e-4), displacement=start,
                     velocity=np.full(model.system.size, 1e-2), options=WITH_STATES)  # fmt: skip
        lines = energy_lines(record.energy)
        assert "turning of bearing_left" in lines[0]
        data = with_energy(run_dataset(model.system, record), record.energy)
        came, went, stayed = (float(data[name].sum()) for name in ("energy_in", "energy_out", "energy_stored"))
        assert came - went - stayed == pytest.approx(float(data.energy_residual), abs=1e-12 * record.energy.through)
        assert float(data.energy_out.sel(energy_out_term="integration")) == record.energy.numerical


def test_powers_of_gear_flanks_are_those_of_their_force_along_a_path():
    model = assemble(read_scene("gearbox"), law="hertz")
    (mesh,) = (entry.element for entry in model.system.elements if isinstance(entry.element, GearMesh))
    random = np.random.default_rng(5)
    for _ in range(10):
        base, swing = 2e-6 * random.standard_normal((2, 12))
        speed, ringing, dt = 300.0, 5e3, 1e-8

        def at(time, base=base, swing=swing, speed=speed, ringing=ringing):
            x, v = base + swing * math.sin(ringing * time), ringing * swing * math.cos(ringing * time)
            op = Operation(speed, speed * time, time)
            force = mesh.evaluate(x, v, op).force
            return force @ v, mesh.powers(None, force, x, v, op), mesh.stored(None, x, op)

        time = 1e-3 * random.random()
        work, powers, _ = at(time)
        rate = (at(time + dt)[2] - at(time - dt)[2]) / (2.0 * dt)
        size = abs(work) + abs(powers.driven) + powers.dissipated + abs(rate)
        assert powers.dissipated >= 0.0
        # The difference quotient, of second order in ringing dt = 5e-5, and its rounding.
        assert work == pytest.approx(powers.driven - powers.dissipated - rate, abs=1e-5 * size + 1e-12)

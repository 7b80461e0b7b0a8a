"""Unbalances, excitations by orders, and weight: in equilibrium and in run-ups, beside closed forms."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ehdmaps.errors import InputError
from mbs import assemble, parse_scene, read_scene
from mbs.analyses.sensors import excited_orders
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.model.system import load_by_gravity
from mbs.settings import Settings
from mbs.transient.run import Options, run

RPM = math.pi / 30.0
MASS, STIFFNESS, DAMPING = 2.0, 2e5, 40.0

JEFFCOTT = """
schema = 1
[operation]
speed = "3000 rpm"
temperature = "40 degC"
[[bodies]]
name = "disc"
freedoms = ["y", "z"]
spin = {spin}
mass = "2 kg"
polar_inertia = "0.01 kg m^2"
transverse_inertia = "0.005 kg m^2"
[[springs]]
name = "shaft"
on = "disc"
stiffness = {{ y = "2e5 N/m", z = "2e5 N/m" }}
damping = {{ y = "40 N s/m", z = "40 N s/m" }}
{more}
"""

UNBALANCE = '[[unbalances]]\nname = "u"\non = "disc"\nmoment = "200 g mm"\nangle = "30 deg"'
RIPPLE = '[[excitations]]\nname = "e"\non = "disc"\nforce = ["0 N", "3 N", "0 N"]\norder = 2\nphase = "10 deg"'
RADIAL = f'{RIPPLE}\nof = "disc"\nover_speed = "square"\nreference_speed = "1000 rpm"'


def scene(more="", spin=1):
    return parse_scene(JEFFCOTT.format(more=more, spin=spin), "jeffcott", "jeffcott")


class TestRunUps:
    # From rest to 6000 rpm in 0.2 s: the rate of the speed is half of the square of the speed after 0.02 s.
    RATE, DURATION = 6000.0 * RPM / 0.2, 0.2

    def both(self, more, spin, load, compiled=True):
        """Motion along y and z by the run, and by an integrator of high order; a short run in Python."""
        duration = self.DURATION if compiled else 0.03
        system = assemble(scene(more, spin)).system
        speed = SpeedProfile.ramp(0.0, self.RATE * self.DURATION, self.DURATION)
        record = run(system, speed, duration, Settings(2e-5, 1e-3, 1.0), options=Options(True, compiled))

        def slope(time, state):
            w, angle = self.RATE * time, 0.5 * self.RATE * time**2
            return [*state[2:], *((load(w, angle) - STIFFNESS * state[:2] - DAMPING * state[2:]) / MASS)]

        exact = solve_ivp(slope, (0.0, duration), np.zeros(4), "DOP853", record.time, rtol=1e-10, atol=1e-16)
        return record.states.displacement, exact.y[:2].T

    @pytest.mark.parametrize(("spin", "compiled"), [(1.0, True), (-1.5, True), (-1.5, False)])
    def test_unbalance_pulls_outwards_and_back(self, spin, compiled):
        moment, begin = 2e-4, math.radians(30.0)

        def load(w, angle):
            here = spin * angle + begin
            outwards, along = np.array([np.cos(here), np.sin(here)]), np.array([-np.sin(here), np.cos(here)])
            return moment * ((spin * w) ** 2 * outwards - spin * self.RATE * along)

        found, exact = self.both(UNBALANCE, spin, load, compiled)
        # The trapezoidal rule lengthens periods by (w h)^2/12, 3e-6 at 50 Hz; up to 2.5 orders of it 1e-4.
        np.testing.assert_allclose(found, exact, atol=3e-4 * np.abs(exact).max())

    @pytest.mark.parametrize(
        ("more", "size", "order"),
        [
            (RIPPLE, lambda w: 3.0, 2.0),
            (RADIAL, lambda w: 3.0 * (w / (1000.0 * RPM)) ** 2, 3.0),
        ],
    )
    def test_orders_of_system_and_body(self, more, size, order):
        def load(w, angle):
            return np.array([size(w) * math.sin(order * angle + math.radians(10.0)), 0.0])

        found, exact = self.both(more, 1.5, load)
        np.testing.assert_allclose(found, exact, atol=1e-3 * np.abs(exact).max())

    def test_energy_closes(self):
        system = assemble(scene(f"{UNBALANCE}\n{RADIAL}")).system
        record = run(system, SpeedProfile.ramp(0.0, 600.0, 0.1), 0.1, Settings(1e-4, 1e-3))
        assert record.energy.loads > 1e-3
        assert abs(record.energy.residual) <= 1e-10 * record.energy.loads


class TestWeight:
    def test_sag_and_no_part_of_the_unbalance(self):
        text = JEFFCOTT.format(more=UNBALANCE, spin=1).replace(
            '"40 degC"', '"40 degC"\ngravity = ["0 m/s^2", "-9.81 m/s^2", "3 m/s^2"]'
        )
        found = equilibrium(assemble(parse_scene(text, "sag", "sag")).system, Operation())
        np.testing.assert_allclose(found.displacement, np.array([-9.81, 3.0]) * MASS / STIFFNESS, rtol=1e-9)

    def test_beam_sags_as_a_closed_form(self):
        # Sag in the middle of a beam on its ends: 5 q L^4/(384 E I) and by shear q L^2/(8 G A k), k by Cowper.
        shaft = """
[[shafts]]
name = "beam"
freedoms = ["y", "z", "theta_y", "theta_z"]
sections = [{ from = "0 m", to = "1 m", diameter = "40 mm" }]
frames = { left = "0 m", middle = "0.5 m", right = "1 m" }
cutoff = "5 kHz"
[[springs]]
name = "left"
on = "beam:left"
stiffness = { y = "1e12 N/m", z = "1e12 N/m" }
[[springs]]
name = "right"
on = "beam:right"
stiffness = { y = "1e12 N/m", z = "1e12 N/m" }
"""
        text = JEFFCOTT.format(more=shaft, spin=1).replace(
            '"40 degC"', '"40 degC"\ngravity = ["0 m/s^2", "-10 m/s^2", "0 m/s^2"]'
        )
        system = assemble(parse_scene(text, "beam", "beam")).system
        q = equilibrium(system, Operation()).displacement
        area, second = math.pi * 0.02**2, math.pi * 0.02**4 / 4.0
        line = 7850.0 * area * 10.0
        poisson = 0.3
        shear = line / (8.0 * 210e9 / (2.0 * (1.0 + poisson)) * area * 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson))
        sag = 5.0 * line / (384.0 * 210e9 * second) + shear
        # Beam elements are exact at their nodes for loads at nodes; a spread load by consistent masses is 1e-4 off.
        assert -(system.relative("beam:middle") @ q)[1] == pytest.approx(sag, rel=3e-4)
        forces = [1e12 * float((system.relative(f"beam:{end}") @ q)[1]) for end in ("left", "right")]
        assert sum(forces) == pytest.approx(-line, rel=1e-6)

    def test_body_off_its_position_with_a_held_freedom(self):
        text = JEFFCOTT.format(more="", spin=1).replace('freedoms = ["y", "z"]', 'freedoms = ["theta_z"]')
        text = text.replace(
            'mass = "2 kg"\npolar_inertia = "0.01 kg m^2"\ntransverse_inertia = "0.005 kg m^2"',
            'cylinders = [{ from = "0 mm", to = "200 mm", diameter = "50 mm", density = "8000 kg/m^3" }]',
        ).replace('{ y = "2e5 N/m", z = "2e5 N/m" }', '{ theta_z = "1e3 N m/rad" }')
        text = text.replace('damping = { y = "40 N s/m", z = "40 N s/m" }', "")
        body = assemble(parse_scene(text, "arm", "arm")).system.bodies[0]
        mass = 8000.0 * math.pi * 0.025**2 * 0.2
        np.testing.assert_allclose(load_by_gravity(body), [[0.0, 0.1 * mass, 0.0]])


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ('[[unbalances]]\nname = "u"\non = "disc"', "moment: missing; allowed: mass times radius"),
        ('[[unbalances]]\nname = "u"\non = "disc"\nmass = "1 g"', "mass and radius go together"),
        (f'{UNBALANCE}\nmass = "1 g"', "stands beside mass or radius"),
        (UNBALANCE.replace('"disc"', '"disk"'), "unbalance 'u': got the body 'disk' .did you mean 'disc'"),
        (UNBALANCE.replace('"disc"', '"ground"'), "ground does not spin"),
        (UNBALANCE.replace('"disc"', '"disc:x"\nat = "1 mm"'), "which is a place already"),
        (f'{RIPPLE}\nof = "shaft"', "excitation 'e', of: got the body 'shaft'; allowed: disc"),
        (f'{RIPPLE}\nreference_speed = "1000 rpm"', "stands without over_speed"),
        (RIPPLE.replace("order = 2", 'order = 2\nover_speed = "square"'), "reference_speed: missing"),
        (RIPPLE.replace("order = 2", "order = 0"), "order: got 0"),
        (RIPPLE.replace('"0 N", "3 N"', '"3 N", "0 N"'), "no freedom moves its place"),
        (RIPPLE.replace('force = ["0 N", "3 N", "0 N"]', ""), "force: missing"),
    ],
)
def test_refused(more, message):
    with pytest.raises(InputError, match=message):
        assemble(scene(more))


def test_body_without_spin_is_refused():
    with pytest.raises(InputError, match="disc does not spin, so that its orders"):
        assemble(scene(f'{RIPPLE}\nof = "disc"', spin=0))


def test_place_along_a_body():
    assert assemble(scene(f'{UNBALANCE}\nat = "10 mm"')).system.bodies[0].frames["u"].position[0] == 0.01
    with pytest.raises(InputError, match="has a frame of that name"):
        assemble(
            scene(f'{UNBALANCE}\nat = "10 mm"\n[[unbalances]]\nname = "u"\non = "disc"\nmoment = "1 g mm"\nat = "0 m"')
        )


def test_a_campbell_diagram_follows_the_orders_of_turning_loads():
    """Those of rollers stay; an order of less than one period a turn is left to --orders."""
    system = assemble(read_scene("overhung_rotor")).system

    def orders(*loads, turns=100.0):
        return excited_orders(SimpleNamespace(system=SimpleNamespace(elements=system.elements, turning=loads)), turns)

    rollers = [order for order, _ in orders()]
    assert [order for order, _ in orders(*system.turning)] == sorted([*rollers, 1.0, 5.0])
    assert (1.0, "1") in orders(*system.turning)
    assert orders(SimpleNamespace(order=-0.25)) == orders()
    assert orders(SimpleNamespace(order=-2.0))[0] == (2.0, "2")
    # In 10 turns the unbalance has too few periods for the windows of all; the blades have 50.
    assert [order for order, _ in orders(*system.turning, turns=10.0)] == sorted([*rollers, 5.0])

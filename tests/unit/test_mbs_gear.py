"""The gear pair: what is refused, the reader of its table, the rows of the mesh, its derivatives."""

from __future__ import annotations

import dataclasses
import math
import re
import tomllib
from importlib import resources

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.jobs.table import Table
from mbs.gears.gear import gear_mesh
from mbs.gears.gear_kernel import TOUCH
from mbs.gears.pair import GearPair, contact_ratio, pair_harmonics
from mbs.gears.relief import Relief
from mbs.model.body import Inertia
from mbs.model.elements import Operation
from mbs.scene.gears import read_gears, spins_by_teeth
from mbs.scene.reader import parse_scene
from mbs.scene.specs import RigidSpec
from tests.cases.c_functions import flank_force

ALPHA = math.radians(20.0)
PAIR = GearPair(
    name="mesh",
    on="shaft_1:gear",
    against="shaft_2:gear",
    teeth=(21, 23),
    module=4.5e-3,
    pressure_angle=ALPHA,
    face_width=25e-3,
    stiffness=14e9,
    backlash=1e-4,
    damping=1e3,
    transmission_error=(5e-7, 1e-7),
    transmission_error_phases=(0.3,),
)
SPIN2 = -21.0 / 23.0


def mesh(angle=0.0, **changes):
    """The pair with the second centre at an angle from y."""
    second = 99e-3 * np.array([0.0, math.cos(angle), math.sin(angle)])
    return gear_mesh(dataclasses.replace(PAIR, **changes), (0.0, 0.0, 0.0), second, 1.0, SPIN2)


class TestPair:
    @pytest.mark.parametrize(
        ("changes", "message"),
        [
            ({"teeth": (21, 4)}, "teeth: got 4; allowed: whole numbers, 5 to 10000"),
            ({"teeth": (21.5, 23)}, "teeth: got 21.5"),
            ({"teeth": (21, 23, 25)}, "teeth: got 3 numbers; allowed: two"),
            ({"module": 0.0}, "module: got 0.0 m; allowed: finite and > 0"),
            ({"face_width": -1.0}, "face_width: got -1.0 m; allowed: finite and > 0"),
            ({"stiffness": math.inf}, "stiffness: got inf N/m"),
            ({"damping": -1.0}, "damping: got -1.0 N s/m; allowed: finite and >= 0"),
            ({"backlash": math.nan}, "backlash: got nan m; allowed: finite and >= 0"),
            ({"pressure_angle": 20.0}, "pressure_angle: got 20.0 rad; allowed: 1 to 45 deg"),
            ({"phase": math.nan}, "phase: got nan rad"),
            ({"helix_angle": 1.0}, "helix_angle: got 1.0 rad; allowed: -45 to 45 deg"),
            ({"harmonics": -1}, "harmonics: got -1; allowed: 0 to 50, or a list"),
            ({"harmonics": 51}, "harmonics: got 51; allowed: 0 to 50, or a list"),
            ({"harmonics": (math.nan,)}, "harmonics: got "),
            ({"harmonics": (0.995,)}, "stiffness falls to 0.005 of the mean; allowed: at least 0.01"),
            ({"harmonics": (0.3,), "harmonic_phases": (0.0, 1.0)}, "harmonic_phases: got 2 for 1 amplitudes"),
            ({"transmission_error": (math.inf,)}, "transmission_error: got "),
            ({"transmission_error_phases": (0.0,) * 3}, "transmission_error_phases: got 3 for 2 amplitudes"),
            ({"teeth": (8, 60)}, "a tip reaches below the other's base circle"),
            ({"teeth": (60, 60), "pressure_angle": math.radians(45.0), "module": 1e-3}, None),
            ({"profile_shift": (0.3,)}, "profile_shift: got x1 = (0.3,) alone; allowed: x1 and x2, or x1 and the"),
            ({"profile_shift": (9.0, 0.0)}, "profile_shift: got (9.0, 0.0); allowed: x1 and x2 from -2 to 2"),
            ({"profile_shift": (math.nan, 0.0)}, "profile_shift: got (nan, 0.0)"),
            ({"profile_shift": (0.1, 0.1, 0.1)}, "profile_shift: got (0.1, 0.1, 0.1)"),
            ({"profile_shift": (-1.5, -1.5)}, "with which the teeth do not mesh; allowed: a larger sum"),
            ({"working_distance": 0.1}, "working_distance: got 100 mm; allowed with these profile shifts: 99 mm"),
            ({"working_distance": 0.05}, "working_distance: got 50 mm; allowed: above the sum of the base radii"),
            ({"working_distance": math.nan}, "working_distance: got nan mm"),
            ({"profile_shift": (0.1,), "working_distance": 1.0}, "up to twice the distance without profile shift, 99"),
            ({"tip_diameters": (0.01, 0.2)}, "tip_diameters: got (0.01, 0.2) m; allowed: two, above the base circles"),
            ({"tip_diameters": (0.1,)}, "tip_diameters: got (0.1,) m; allowed: two"),
            ({"tangential_force": -1.0}, "tangential_force: got -1.0 N; allowed: finite and > 0"),
            ({"relief": Relief((1e-5, 1e-5))}, "tip_relief: stands without the load; allowed: with tangential_force"),
        ],
    )
    def test_refuses(self, changes, message):
        if message is None:
            dataclasses.replace(PAIR, **changes)
            return
        with pytest.raises(InputError) as caught:
            dataclasses.replace(PAIR, **changes)
        assert message in str(caught.value)

    def test_names_all_problems_at_once(self):
        with pytest.raises(InputError) as caught:
            dataclasses.replace(PAIR, module=0.0, damping=-1.0, backlash=-1.0)
        assert len(caught.value.problems) == 3

    def test_refuses_a_relief_that_no_tooth_has(self):
        for amounts, lengths in (((1e-5,), ()), ((2e-3, 0.0), ()), ((math.nan, 0.0), ())):
            with pytest.raises(InputError, match=r"gear pair, tip_relief: got .* allowed: two, those of both gears"):
                Relief(amounts, lengths)
        with pytest.raises(InputError, match=r"gear pair, relief_length: got .* allowed: two above 0, or none"):
            Relief((1e-5, 1e-5), (1e-3, 0.0))

    def test_few_teeth_need_harmonics_of_their_own(self):
        assert dataclasses.replace(PAIR, teeth=(8, 60), harmonics=(0.2,)).stiffness_harmonics == (0.2,)

    def test_no_continuous_mesh(self):
        with pytest.raises(InputError, match=r"which makes 0.9.*; allowed: at least 1"):
            contact_ratio((40, 40), math.radians(20.0), addendum=0.5)

    def test_not_a_number_is_no_angle(self):
        with pytest.raises(InputError, match="base circle"):
            contact_ratio((21, 23), math.nan)

    def test_no_harmonics_is_a_constant_stiffness(self):
        assert dataclasses.replace(PAIR, harmonics=0).stiffness_harmonics == ()
        assert pair_harmonics(2.0, 3) == pytest.approx((0.0, 0.0, 0.0), abs=1e-16)


SHIFTED = dataclasses.replace(PAIR, teeth=(12, 24), module=3e-3, profile_shift=(0.6, 0.36))


class TestProfileShift:
    def test_a_published_pair(self):
        """KHK's worked example, 12 and 24 teeth of 3 mm, x 0.6 and 0.36; 1e-5 and 1e-4 are the digits printed."""
        assert math.degrees(SHIFTED.working_pressure_angle) == pytest.approx(26.0886, rel=1e-5)
        assert 1e3 * SHIFTED.centre_distance == pytest.approx(56.4999, rel=2e-6)
        assert [2e3 * r for r in SHIFTED.pitch_radii] == pytest.approx([37.667, 75.333], rel=1.5e-5)
        assert [2e3 * r for r in SHIFTED.base_radii] == pytest.approx([33.8289, 67.6579], rel=2e-6)
        assert [1e3 * tip for tip in SHIFTED.tips] == pytest.approx([44.840, 79.400], rel=1e-5)
        assert SHIFTED.contact_ratios[0] == pytest.approx(1.202, rel=4e-4)

    def test_the_same_by_its_distance(self):
        """The same table begins with 56.500 mm: the angle is 26.0888 degrees, the sum of the shifts 0.960."""
        pair = dataclasses.replace(SHIFTED, profile_shift=(0.6,), working_distance=56.5e-3)
        assert math.degrees(pair.working_pressure_angle) == pytest.approx(26.0888, rel=1e-5)
        assert pair.shifts == pytest.approx((0.6, 0.36), abs=1e-3)
        assert pair.centre_distance == pytest.approx(56.5e-3, rel=1e-12)
        both = dataclasses.replace(pair, profile_shift=pair.shifts)
        assert both.contact_ratios == pytest.approx(pair.contact_ratios, rel=1e-10)

    def test_a_published_helical_pair(self):
        """KHK's example of 12 and 60 teeth, 3 mm, 30 degrees, x1 0.09809: 23.1126 degrees, 125.000 mm."""
        pair = dataclasses.replace(
            PAIR, teeth=(12, 60), module=3e-3, helix_angle=math.radians(30.0), profile_shift=(0.09809, 0.0)
        )
        assert math.degrees(pair.working_pressure_angle) == pytest.approx(23.1126, rel=2e-6)
        assert 1e3 * pair.centre_distance == pytest.approx(125.0, rel=1e-6)

    def test_shifts_that_cancel_change_tips_alone(self):
        pair = dataclasses.replace(PAIR, profile_shift=(0.3, -0.3))
        assert pair.centre_distance == PAIR.centre_distance and pair.pitch_radii == PAIR.pitch_radii
        assert [tip - plain for tip, plain in zip(pair.tips, PAIR.tips, strict=True)] == pytest.approx(
            [0.6 * 4.5e-3, -0.6 * 4.5e-3], rel=1e-12
        )

    def test_contact_ratio_by_counting_along_the_line_of_action(self):
        """Both tip circles cut the common tangent of the base circles; found on coordinates, by the given tips."""
        first, second = SHIFTED.base_radii
        a = SHIFTED.centre_distance
        tangent = math.sqrt(a**2 - (first + second) ** 2)  # between the points where it leaves the base circles
        place = np.linspace(0.0, tangent, 2_000_001)
        inside = (np.hypot(first, place) <= 0.5 * SHIFTED.tips[0]) & (
            np.hypot(second, tangent - place) <= 0.5 * SHIFTED.tips[1]
        )
        pitch = math.pi * SHIFTED.transverse_module * math.cos(SHIFTED.transverse_pressure_angle)
        length = np.count_nonzero(inside) * tangent / 2e6
        assert SHIFTED.contact_ratios[0] == pytest.approx(length / pitch, rel=1e-5)  # steps of the count
        given = dataclasses.replace(SHIFTED, tip_diameters=(44.0e-3, 79.0e-3))
        assert given.contact_ratios[0] < SHIFTED.contact_ratios[0]

    @pytest.mark.parametrize("helix", [0.0, 0.3])
    def test_turning_without_slip_compresses_nothing(self, helix):
        """Rolling involutes: turning by the teeth keeps the compression, one alone moves by its base radius."""
        pair = dataclasses.replace(SHIFTED, helix_angle=helix, tip_diameters=None)
        second = pair.centre_distance * np.array([0.0, math.cos(0.4), math.sin(0.4)])
        rows = gear_mesh(pair, (0.0,) * 3, second, 1.0, -0.5).rows
        turn = np.zeros(12)
        turn[3], turn[9] = 1.0, -0.5
        np.testing.assert_allclose(rows @ turn, 0.0, atol=1e-15)
        np.testing.assert_allclose(rows[:, 3], [pair.base_radii[0], -pair.base_radii[0]], rtol=1e-12)
        with pytest.raises(InputError, match=r"the centres are 54 mm apart; allowed: with the profile shifts = 5"):
            gear_mesh(pair, (0.0,) * 3, (0.0, 54e-3, 0.0), 1.0, -0.5)

    def test_the_stiffness_of_iso_6336(self):
        """The regression written out for 21 and 23 teeth, and what shifted teeth add; usual pairs have 14 to 20."""
        plain = dataclasses.replace(PAIR, stiffness=None)
        single = 0.8 * 0.975 / (0.04723 + 0.15551 / 21 + 0.25791 / 23)
        expected = single * (0.75 * plain.contact_ratios[0] + 0.25)
        assert 1e-9 * plain.mean_stiffness / plain.face_width == pytest.approx(expected, rel=1e-12)
        assert 14.0 < expected < 20.0
        assert plain.estimate.startswith("mesh: mesh stiffness 17") and PAIR.estimate == ""
        stiffer = dataclasses.replace(plain, profile_shift=(0.4, 0.4)).mean_stiffness / plain.mean_stiffness
        assert 0.85 < stiffer < 1.05  # thicker teeth, fewer of them in contact
        mirrored = dataclasses.replace(plain, teeth=(23, 21)).mean_stiffness
        assert mirrored == pytest.approx(plain.mean_stiffness, rel=1e-12)


class TestSpins:
    SHAFT = RigidSpec("one", [Inertia(1.0, 1.0, 1.0)], ["theta_x"])

    def spins(self, typed, *pairs, **default):
        bodies = [dataclasses.replace(self.SHAFT, name=name, spin=spin) for name, spin in default.items()]
        meshes = [
            dataclasses.replace(PAIR, on=f"{one}:gear", against=f"{other}:gear", teeth=teeth)
            for one, other, *teeth in pairs
        ]
        return {body.name: body.spin for body in spins_by_teeth(bodies, meshes, typed)}

    def test_through_a_chain_from_any_end(self):
        chain = ("a", "b", 20, 40), ("b", "c", 21, 63)
        assert self.spins({"a"}, *chain, a=3.0, b=0.0, c=0.0) == {"a": 3.0, "b": -1.5, "c": 0.5}
        assert self.spins({"c"}, *chain, a=0.0, b=0.0, c=0.5) == {"a": 3.0, "b": -1.5, "c": 0.5}

    def test_what_is_typed_stays(self):
        assert self.spins({"a", "b"}, ("a", "b", 20, 40), a=1.0, b=-0.7) == {"a": 1.0, "b": -0.7}

    def test_a_shaft_by_lengths_turns_with_the_system_where_nothing_else_is_said(self):
        assert self.spins(set(), ("a", "b", 20, 40), a=1.0, b=1.0, d=0.0) == {"a": 1.0, "b": -0.5, "d": 0.0}
        assert self.spins({"b"}, ("a", "b", 20, 40), a=1.0, b=1.0) == {"a": -2.0, "b": 1.0}

    def test_in_a_scene(self):
        text = (resources.files("mbs") / "systems" / "gearbox.toml").read_text(encoding="utf-8")
        where = resources.files("mbs") / "systems"
        without = re.sub(r"(?m)^spin = -.*\n", "", text)
        assert without != text
        scenes = [parse_scene(each, "gearbox", "gearbox", where) for each in (text, without)]
        first, second = ([body.spin for body in scene.bodies] for scene in scenes)
        assert first == pytest.approx(second, rel=1e-12)


class TestPlacing:
    @pytest.mark.parametrize(
        ("place", "spin", "message"),
        [
            ((0.0, 0.1, 0.0), SPIN2, "the centres are 100 mm apart; allowed: m (z1 + z2)/2 = 99 mm"),
            ((2e-3, 0.099, 0.0), SPIN2, "the middles of the gears are 2 mm apart along x; allowed: one plane"),
            ((0.0, 0.099, 0.0), 21.0 / 23.0, "allowed: -0.91304347826087 for the second gear"),
            ((0.0, 0.099, 0.0), math.nan, "the spins are 1.0 and nan"),
            ((0.0, math.nan, 0.0), SPIN2, "the centres are nan mm apart"),
        ],
    )
    def test_refuses(self, place, spin, message):
        with pytest.raises(InputError) as caught:
            gear_mesh(PAIR, (0.0, 0.0, 0.0), place, 1.0, spin)
        assert message in str(caught.value)

    def test_spin_that_is_no_number(self):
        with pytest.raises(InputError, match=r"the spins are nan and 1.0"):
            gear_mesh(PAIR, (0.0, 0.0, 0.0), (0.0, 0.099, 0.0), math.nan, 1.0)

    def test_a_decimal_spin_will_do(self):
        assert gear_mesh(PAIR, (0.0,) * 3, (0.0, 0.099, 0.0), -2.0, 1.82608696).order == 42.0

    @pytest.mark.parametrize("angle", [0.0, 1.0, 2.5, -1.2])
    def test_rolling_together_compresses_nothing(self, angle):
        """Turns in the ratio of the teeth, and a common translation, leave both flanks as they are."""
        rows = mesh(angle).rows
        turned = np.zeros(12)
        turned[3], turned[9] = 1.0, SPIN2
        moved = np.tile([0.3, -0.7, 0.9, 0.0, 0.0, 0.0], 2)
        np.testing.assert_allclose(rows @ turned, 0.0, atol=1e-16)  # round-off
        np.testing.assert_allclose(rows @ moved, 0.0, atol=1e-16)

    @pytest.mark.parametrize("angle", [0.0, 1.0, 2.5, -1.2])
    def test_force_acts_at_the_pitch_point(self, angle):
        """The force on each gear, put at the pitch point, has the moment that the element gives."""
        element = mesh(angle)
        towards = np.array([0.0, math.cos(angle), math.sin(angle)])
        arms = [np.array(radius * sign * towards) for radius, sign in zip((47.25e-3, 51.75e-3), (1, -1), strict=True)]
        for row, side in zip(element.rows, (1.0, -1.0), strict=True):
            assert np.linalg.norm(row[:3]) == pytest.approx(1.0, rel=1e-14)
            np.testing.assert_array_equal(row[:3], -row[6:9])
            for first, arm in zip((0, 6), arms, strict=True):
                moment = np.cross(arm, -row[first : first + 3])
                np.testing.assert_allclose(moment, -row[first + 3 : first + 6], atol=1e-16)
            along = np.cross([1.0, 0.0, 0.0], towards)
            assert row[:3] @ along == pytest.approx(side * math.cos(ALPHA), rel=1e-14)
            assert row[:3] @ towards == pytest.approx(math.sin(ALPHA), rel=1e-14)


class TestElement:
    def test_ports_and_order(self):
        element = mesh()
        assert [(port.on, port.against) for port in element.ports] == [
            ("shaft_1:gear", "ground"),
            ("shaft_2:gear", "ground"),
        ]
        assert element.name == "mesh"
        assert element.order == 21.0

    @pytest.mark.parametrize("compression", [-1e-6, 0.4 * TOUCH, 5e-6, -1.03e-4])
    @pytest.mark.parametrize("rate", [0.0, 2e-3, -1e-3, -3.0])
    def test_derivatives(self, compression, rate):
        """Central differences; 1e-6 is their error with steps of a part of TOUCH, 1e-5 N that of round-off."""
        element = mesh(0.7)
        operation = Operation(50.0, 0.123, 0.0)
        row = element.rows[0]
        rng = np.random.default_rng(5)
        q, v = compression * row / (row @ row), rate * row / (row @ row)
        _, K, C, _ = element.evaluate(q, v, operation)
        for matrix, step, place in ((K, 1e-3 * TOUCH, 0), (C, 1e-3 * max(abs(rate), 1e-3), 1)):
            np.testing.assert_array_equal(matrix, matrix.T)
            direction = rng.normal(size=12)
            direction *= step / np.max(np.abs(element.rows @ direction))
            forces = []
            for side in (1.0, -1.0):
                motion = [q.copy(), v.copy()]
                motion[place] += side * direction
                forces.append(element.evaluate(*motion, operation)[0])
            change = (forces[1] - forces[0]) / 2.0
            np.testing.assert_allclose(matrix @ direction, change, rtol=1e-5, atol=1e-6 * np.abs(change).max() + 1e-12)

    @pytest.mark.parametrize("rate", [0.0, 1e-3, -1e-3, 0.3, -0.3])
    def test_flank_is_continuous_and_never_pulls(self, rate):
        """Force and slopes at the ends of the branches: steps of 1e-9 TOUCH change them by as little."""
        places = [0.0, TOUCH, *(np.linspace(0.01, 3.0, 300) * TOUCH)]
        at = [flank_force(place, rate, 3.5e8, 1e3) for place in places]
        assert min(force for force, _, _ in at) >= 0.0
        for place in (0.0, TOUCH):
            low = flank_force(place - 1e-9 * TOUCH, rate, 3.5e8, 1e3)
            high = flank_force(place + 1e-9 * TOUCH, rate, 3.5e8, 1e3)
            scales = 3.5e8 * TOUCH + 1e3 * abs(rate), 3.5e8 + 1e3 * abs(rate) / TOUCH, 1e3
            for below, above, scale in zip(low, high, scales, strict=True):
                assert above == pytest.approx(below, abs=1e-8 * scale)

    def test_at_rest_the_force_rises_with_compression(self):
        forces = [flank_force(place, 0.0, 3.5e8, 1e3)[0] for place in np.linspace(-TOUCH, 5.0 * TOUCH, 100)]
        assert np.all(np.diff(forces) >= 0.0)

    def test_play_between_the_flanks(self):
        element = mesh(transmission_error=(), transmission_error_phases=())
        turn = np.zeros(12)
        turn[3] = 1.0 / element.pair.base_radii[0]
        for compression, flank in ((1e-6, 0), (-0.5e-4, None), (-1.01e-4, 1)):
            forces = element.flanks(compression * turn, np.zeros(12), Operation())[:, 0]
            assert [i for i in range(2) if forces[i] > 0.0] == ([] if flank is None else [flank])

    def test_steady_is_the_mean_over_a_mesh(self):
        """Evenly spaced angles give the mean of a trigonometric series without error, but for round-off."""
        element = mesh()
        turn = np.zeros(12)
        turn[3] = 1e-5 / element.pair.base_radii[0]
        angles = np.arange(64) / 64 * 2.0 * math.pi / 21.0
        found = [element.flanks(turn, np.zeros(12), Operation(0.0, angle))[0, 1] for angle in angles]
        steady = element.steady().flanks(turn, np.zeros(12), Operation(10.0, 0.05))[0]
        assert np.mean(found) == pytest.approx(steady[1], rel=1e-13)
        assert steady[1] == pytest.approx(14e9 * 25e-3, rel=1e-15)
        assert steady[0] == pytest.approx(14e9 * 25e-3 * (1e-5 - 0.5 * TOUCH), rel=1e-12)

    def test_transmission_error_moves_the_flank(self):
        """A flank that lacks e is compressed by e less; its rate counts as a rate of compression."""
        plain = mesh(transmission_error=(), transmission_error_phases=(), harmonics=0)
        wavy = mesh(harmonics=0)
        operation = Operation(100.0, 0.02)
        phase = 21.0 * operation.angle
        e = 5e-7 * math.cos(phase + 0.3) + 1e-7 * math.cos(2.0 * phase)
        rate = -21.0 * 100.0 * (5e-7 * math.sin(phase + 0.3) + 2e-7 * math.sin(2.0 * phase))
        turn = np.zeros(12)
        turn[3] = 1.0 / plain.pair.base_radii[0]
        expected = plain.flanks((1e-5 - e) * turn, -rate * turn, operation)[0]
        np.testing.assert_allclose(wavy.flanks(1e-5 * turn, 0.0 * turn, operation)[0], expected, rtol=1e-12)


TABLE = """
name = "mesh"
on = "shaft_1:gear"
against = "shaft_2:gear"
teeth = [21, 23]
module = "4.5 mm"
pressure_angle = "20 deg"
face_width = "25 mm"
stiffness = "14 N/(um mm)"
damping = "1e3 N s/m"
harmonics = 5
transmission_error = ["0.5 um", "0.1 um"]
transmission_error_phases = ["0.3 rad"]
backlash = "0.1 mm"
"""


def read(text, **changes):
    problems: list[str] = []
    values = {**tomllib.loads(text), **changes}
    section = Table({key: value for key, value in values.items() if value is not None}, "[[gears]] mesh", problems)
    section.get("name")
    pair = read_gears(section, "mesh")
    section.close()
    return pair, problems


class TestReader:
    def test_reads_a_pair(self):
        pair, problems = read(TABLE)
        assert problems == []
        for field in dataclasses.fields(GearPair):
            got, wanted = getattr(pair, field.name), getattr(PAIR, field.name)
            assert got == (wanted if isinstance(wanted, str | None) else pytest.approx(wanted, rel=1e-14))

    def test_short_table(self):
        pair, problems = read(
            TABLE, damping=None, harmonics=None, transmission_error=None, transmission_error_phases=None
        )
        assert problems == []
        assert pair.damping == 0.0
        assert len(pair.stiffness_harmonics) == 5
        assert pair.transmission_error == ()

    @pytest.mark.parametrize(
        ("changes", "message"),
        [
            ({"on": None}, "on: missing; allowed: a place"),
            ({"against": None}, "against: missing; allowed: a place"),
            ({"against": 3}, "against: got 3; allowed: a place"),
            ({"teeth": [21]}, "teeth: got [21]; allowed: two whole numbers from 5"),
            ({"teeth": [21, True]}, "teeth: got [21, True]"),
            ({"teeth": [21, 10**30]}, "teeth: got [21, 1000"),
            ({"teeth": "21"}, "teeth: got '21'"),
            ({"teeth": None}, "teeth: missing"),
            ({"module": 4.5}, "module: got 4.5 without a unit"),
            ({"module": "4.5 m"}, "module: got '4.5 m'; allowed: 0.01 mm to 1000 mm"),
            ({"pressure_angle": "20 rad"}, "pressure_angle: got '20 rad'; allowed: 1 deg to 45 deg"),
            ({"face_width": "-1 mm"}, "face_width: got '-1 mm'"),
            ({"stiffness": "14 N/um"}, "stiffness: got the unit 'N/um'"),
            ({"backlash": None}, "backlash: missing"),
            ({"profile_shift": 0.3}, "profile_shift: got 0.3; allowed: x1 and x2, such as [0.3, -0.1], or [x1] alone"),
            ({"profile_shift": [0.1, "x"]}, "profile_shift: got a list of 2 entries; allowed: x1 and x2"),
            ({"profile_shift": [0.2]}, "profile_shift: got x1 = (0.2,) alone"),
            ({"working_distance": 99}, "working_distance: got 99 without a unit"),
            ({"damping": "-1 N s/m"}, "damping: got '-1 N s/m'; allowed: 0 N s/m"),
            ({"harmonics": 51}, "harmonics: got 51; allowed: a whole number from 0 to 50"),
            ({"harmonics": True}, "harmonics: got True"),
            ({"harmonics": [0.3, "x"]}, "harmonics: got [0.3, 'x']"),
            ({"harmonics": [math.nan]}, "harmonics: got [nan]"),
            ({"harmonics": [0.1] * 1000}, "harmonics: got [0.1"),
            ({"harmonics": [1.0]}, "harmonics: got amplitudes whose stiffness falls to 0 of the mean"),
            ({"transmission_error": "0.5 um"}, "transmission_error: got '0.5 um'; allowed: a list"),
            ({"transmission_error": ["1 m"]}, "transmission_error[0]: got '1 m'; allowed: -10000 um"),
            ({"transmission_error_phases": ["1 deg"] * 3}, "got 3 for 2 amplitudes; allowed: as many"),
            ({"phase": "nan deg"}, "phase: got 'nan deg'"),
            ({"teeths": 1}, "teeths: unknown key (did you mean 'teeth'?)"),
        ],
    )
    def test_hostile(self, changes, message):
        _, problems = read(TABLE, **changes)
        assert any(message in problem and problem.startswith("[[gears]] mesh") for problem in problems), problems

    def test_all_problems_at_once(self):
        pair, problems = read(TABLE, teeth=[1], module="x", backlash=7)
        assert pair is None
        assert len(problems) == 3

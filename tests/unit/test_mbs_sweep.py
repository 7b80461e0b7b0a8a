"""Parts of the sweep over speed: matching, tracks, ranges, cases, the dataset and the figure; and hostile input."""

from __future__ import annotations

import argparse
import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.jobs.table import Table
from mbs.bearings.bearing_element import RingElement
from mbs.commands import sweep as command
from mbs.commands.cases import load_cases
from mbs.linearised.averaged import steady_system
from mbs.linearised.sweep import along_load, sweep
from mbs.linearised.tracking import Match, ModeSet, assurance, compose, match, tracks
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Forces, Input, Operation, Port, Sensor, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.system import System
from mbs.output.sweep_data import RESPONSES, VARIABLES, sweep_dataset
from mbs.output.sweep_plot import sweep_figure
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene, read_sweep
from mbs.settings import SweepRange

RPM = math.pi / 30.0
Y = np.array([0.0, 1.0, 0.0, 0.0, 0.0, 0.0])


def orthonormal(values, shapes):
    return ModeSet(np.asarray(values, dtype=np.complex128), shapes, shapes.T)


def turned(angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


class TestMatching:
    VALUES = (1j, 2j, 3j)

    def test_modes_are_followed_by_their_shape(self):
        before, after = (orthonormal(self.VALUES, shapes) for shapes in (np.eye(3), np.eye(3)[:, [2, 0, 1]]))
        found = match(before, after)
        np.testing.assert_array_equal(found.chosen, [1, 2, 0])
        np.testing.assert_array_equal(found.assurance, 1.0)

    def test_assurance_is_the_square_of_the_cosine(self):
        found = assurance(orthonormal(self.VALUES, np.eye(3)), orthonormal(self.VALUES, turned(0.3)))
        c, s = math.cos(0.3) ** 2, math.sin(0.3) ** 2
        np.testing.assert_allclose(found, [[c, s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]], atol=1e-15)

    def test_assignment_is_the_best_of_all_and_not_the_greediest(self):
        """Greedy takes 0.6 first and is left with 0.3 and nothing; 0.55 and 0.5 are better."""
        left = np.sqrt([[0.6, 0.55], [0.5, 1e-9]])
        first = ModeSet(np.array([1j, 2j]), np.eye(2), left)
        second = ModeSet(np.array([1j, 2j]), np.eye(2), left.T)
        np.testing.assert_allclose(assurance(first, second), left**2, atol=1e-15)
        np.testing.assert_array_equal(match(first, second).chosen, [1, 0])

    def test_equal_modes_are_compared_as_a_group(self):
        """Any mixture of two equal modes is a mode: 45 degrees must not look like half a mode."""
        equal, apart = [1j, 1j, 3j], [1j, 1.1j, 3j]
        for before, after in ((equal, equal), (equal, apart), (apart, equal)):
            found = match(orthonormal(before, np.eye(3)), orthonormal(after, turned(math.pi / 4.0)), 0.9)
            np.testing.assert_allclose(found.assurance, 1.0, rtol=1e-12)
            np.testing.assert_array_equal(found.chosen, [0, 1, 2])
        assert match(orthonormal(apart, np.eye(3)), orthonormal(apart, turned(0.7))).assurance[0] < 0.6

    def test_damped_modes_that_are_nearly_parallel_are_told_apart(self):
        """Right vectors with a cosine of 0.9999: left vectors see the difference."""
        right = np.array([[1.0, 1.0], [0.0, 0.0141]])
        same = ModeSet(np.array([-1 + 1j, -1 + 1.1j]), right, np.linalg.inv(right))
        np.testing.assert_allclose(assurance(same, same), np.eye(2), atol=1e-12)

    def test_what_is_unlike_ends(self):
        before, after = orthonormal([1j], np.eye(3)[:, :1]), orthonormal([1j], np.eye(3)[:, 1:2])
        found = match(before, after, 0.5)
        np.testing.assert_array_equal(found.chosen, [-1])
        np.testing.assert_array_equal(match(before, after).chosen, [0])

    def test_fewer_and_more_modes(self):
        three, two = orthonormal(self.VALUES, np.eye(3)), orthonormal([1j, 3j], np.eye(3)[:, [0, 2]])
        np.testing.assert_array_equal(match(three, two, 0.5).chosen, [0, -1, 1])
        np.testing.assert_array_equal(match(two, three, 0.5).chosen, [0, 2])
        none = orthonormal([], np.zeros((3, 0)))
        np.testing.assert_array_equal(match(three, none).chosen, [-1, -1, -1])
        assert match(none, three).chosen.size == 0

    def test_tracks(self):
        """One mode ends after the first point, another one begins at the third."""
        steps = [
            Match(np.array([1, -1, 0]), np.ones(3), 2),
            Match(np.array([0, 2]), np.ones(2), 3),
            Match(np.array([2, -1, 1]), np.ones(3), 3),
        ]
        np.testing.assert_array_equal(
            tracks(3, steps),
            [[0, 1, 2, -1, -1], [1, -1, 0, -1, -1], [2, -1, 0, 1, -1], [1, -1, 2, -1, 0]],
        )

    def test_steps_in_a_row_are_one_step(self):
        steps = [
            Match(np.array([1, -1, 0]), np.array([0.9, 0.1, 0.8]), 2),
            Match(np.array([0, 2]), np.array([0.7, 0.95]), 3),
        ]
        found = compose(steps)
        np.testing.assert_array_equal(found.chosen, [2, -1, 0])
        np.testing.assert_array_equal(found.assurance, [0.9, 0.1, 0.7])
        assert found.size == 3
        gone = compose([steps[0], Match(np.array([-1, -1]), np.zeros(2), 0), Match(np.zeros(0, int), np.zeros(0), 4)])
        np.testing.assert_array_equal(gone.chosen, [-1, -1, -1])
        assert gone.size == 4


class Film(RingElement):
    """A bearing along y that holds a preload."""

    def __init__(self, stiffness=1e6, name="film", load=100.0, damping=10.0):
        self.name, self.ports = name, (Port("a"),)
        self.stiffness, self.load, self.damping = stiffness, load, damping

    def evaluate(self, displacement, velocity, operation):
        k, c = self.stiffness * np.outer(Y, Y), self.damping * np.outer(Y, Y)
        return Forces(-k @ displacement - self.load * Y, k, c)


class Mesh(Film):
    """Another stiffness at every angle, with a mean."""

    def steady(self):
        return Film(2.0 * self.stiffness, self.name, self.load)


def one_mass(element):
    body = rigid_body("a", [Inertia(2.0, 0.01, 0.02)], ["y", "z"])
    return System([body], [Spring("s", "a", "ground", np.diag([0.0, 1e5, 2e5, 0.0, 0.0, 0.0]))], (), [element])


class TestSweep:
    @pytest.mark.parametrize(
        ("speeds", "frequencies", "angles", "message"),
        [
            ([], [], 1, "speeds: got 0 values; allowed: 1 to 2000 finite ones"),
            ([math.nan], [], 1, "speeds: got 1 values"),
            ([math.inf, 1.0], [], 1, "allowed: 1 to 2000 finite ones"),
            ([[1.0, 2.0]], [], 1, "in a row"),
            (np.ones(2001), [], 1, "speeds: got 2001 values"),
            ([1.0], [-1.0], 1, "frequencies: got 1 values; allowed: finite ones from 0 Hz on"),
            ([1.0], [math.nan], 1, "frequencies: got 1 values"),
            (np.ones(2000), np.ones(10**5), 1, "got 2000 speeds, 100000 frequencies and 1 pairs"),
            ([1.0], [], 0, "cage angles: got 0; allowed: a whole number from 1 to 1000"),
            ([1.0], [], 10**9, "cage angles: got 1000000000"),
        ],
    )
    def test_what_is_no_sweep_is_refused(self, speeds, frequencies, angles, message):
        with pytest.raises(InputError, match=message):
            sweep(one_mass(Film()), speeds, 0.0, [Input("E", "a", Y)], [Sensor("S", "a", Y)], frequencies, angles)

    def test_cages_of_all_bearings_start_at_another_angle(self):
        cases = load_cases(given(start_angle=["0 deg", "7.5 deg"]))
        assert [case.label for case in cases] == ["cage at 0 deg", "cage at 7.5 deg"]
        for case, angle in zip(cases, (0.0, math.radians(7.5)), strict=True):
            assert case.start_angle == pytest.approx(angle)
            assert [entry.start_angle for entry in case.model.bearings] == [pytest.approx(angle)] * 2

    def test_problems_come_all_at_once(self):
        with pytest.raises(InputError) as caught:
            sweep(one_mass(Film()), np.array([math.nan]), frequencies=np.array([-1.0]), cage_angles=-1)
        assert len(caught.value.problems) == 3

    def test_a_law_that_is_not_finite_is_said(self):
        with pytest.raises(AnalysisError, match=r"at 5 rad/s: .* damping at the equilibrium is not finite"):
            sweep(one_mass(Film(damping=math.nan)), np.array([5.0]))

    def test_the_speed_without_equilibrium_is_said(self):
        body = rigid_body("a", [Inertia(2.0, 0.01, 0.02)], ["y"])
        with pytest.raises(AnalysisError, match=r"at 7 rad/s: no equilibrium after"):
            sweep(System([body], (), (), [Film(0.0)]), np.array([7.0]))

    def test_no_response_of_a_free_motion_at_rest(self):
        body = rigid_body("a", [Inertia(2.0, 0.01, 0.02)], ["y", "z"])
        free = System([body], [Spring("s", "a", "ground", np.diag([0.0, 1e5, 0.0, 0.0, 0.0, 0.0]))])
        pieces = [Input("E", "a", Y)], [Sensor("S", "a", Y)]
        with pytest.raises(AnalysisError, match="just that of an undamped or free motion"):
            sweep(free, np.array([1.0]), 0.0, *pieces, np.array([0.0]))
        found = sweep(free, np.array([1.0]), 0.0, *pieces, np.array([5.0])).responses.values[0, 0, 0, 0]
        assert found == pytest.approx(1.0 / (1e5 - 2.0 * (10.0 * math.pi) ** 2), rel=1e-12)

    def test_gear_meshes_count_with_their_mean(self):
        system = one_mass(Mesh())
        assert steady_system(one_mass(Film())).elements[0].element.stiffness == 1e6
        steady = steady_system(system)
        assert steady.elements[0].element.stiffness == 2e6
        assert system.elements[0].element.stiffness == 1e6
        plain = one_mass(Film())
        assert steady_system(plain) is plain
        found = sweep(system, np.array([1.0])).undamped.frequency[0]
        np.testing.assert_allclose(np.sort(found), np.sqrt([1e5, 1.05e6]) / (2.0 * np.pi), rtol=1e-12)

    def test_without_inputs_there_are_no_responses(self):
        result = sweep(one_mass(Film()), np.array([1.0, 2.0]))
        assert result.responses.values.shape == (2, 0, 0, 0)
        np.testing.assert_array_equal(result.responses.error, 0.0)

    def test_the_same_speed_twice_and_speeds_that_fall(self):
        result = sweep(one_mass(Film()), np.array([3.0, 3.0, 1.0]))
        assert result.undamped.frequency.shape == (3, 2)
        np.testing.assert_allclose(result.undamped.assurance, 1.0, rtol=1e-12)

    def test_a_bearing_along_its_force(self):
        found = along_load(equilibrium(one_mass(Film()), Operation(1.0)))
        # 100 N is shared with the spring of 1e5 N/m beside 1e6 N/m.
        np.testing.assert_allclose(found[:, 0], [100.0 * 1e5 / 1.1e6, 1e6, 10.0], rtol=1e-9)
        idle = along_load(equilibrium(one_mass(Film(load=0.0)), Operation(1.0)))
        assert idle[0, 0] == 0.0
        assert np.all(np.isnan(idle[1:, 0]))

    def test_an_idle_bearing_is_no_obstacle(self):
        result = sweep(one_mass(Film(load=0.0)), np.array([1.0, 2.0]), cage_angles=2)
        assert np.all(np.isnan(result.bearings.stiffness))


class TestRange:
    def test_speeds(self):
        np.testing.assert_allclose(SweepRange(0.0, 10.0, 5).speeds, [0.0, 2.5, 5.0, 7.5, 10.0])

    @pytest.mark.parametrize(
        ("values", "message"),
        [
            ((1.0, 1.0, 5), "got 1 to 1 rad/s; allowed: rising"),
            ((-1.0, 1.0, 5), "from 0 rpm on"),
            ((0.0, math.nan, 5), "got 0 to nan rad/s"),
            ((0.0, math.inf, 5), "got 0 to inf rad/s"),
            ((0.0, 1.0, 1), "points: got 1; allowed: a whole number from 2 to 2000"),
            ((0.0, 1.0, 10**9), "points: got 1000000000"),
        ],
    )
    def test_what_is_no_range_is_refused(self, values, message):
        with pytest.raises(InputError, match=message):
            SweepRange(*values)

    def test_is_read(self):
        problems = []
        found = read_sweep(Table({"from": "500 rpm", "to": "2500 rpm", "points": 40}, "[sweep]", problems))
        assert not problems
        assert found.points == 40
        np.testing.assert_allclose([found.begin, found.end], np.array([500.0, 2500.0]) * RPM)

    @pytest.mark.parametrize(
        ("values", "message"),
        [
            ({"from": "9 rpm", "to": "5 rpm", "points": 4}, r"\[sweep\]: from, to: got .*allowed: rising"),
            ({"from": "9 kg", "to": "50 rpm", "points": 4}, r"\[sweep\] from: .*kg"),
            ({"from": "9 rpm", "to": "50 rpm", "points": 1}, r"\[sweep\] points: got 1; allowed"),
            ({"from": "9 rpm", "to": "50 rpm"}, r"\[sweep\] points: missing"),
            ({"from": "-9 rpm", "to": "50 rpm", "points": 4}, r"\[sweep\] from: got"),
            ({}, r"\[sweep\] to: missing"),
        ],
    )
    def test_problems_are_noted(self, values, message):
        problems = []
        assert read_sweep(Table(values, "[sweep]", problems)) is None
        with pytest.raises(InputError, match=message):
            raise InputError(problems)


def given(**options):
    plain = {"scene": "nu308_rigid", "output": None, "plot": None, "speed": None, "cage_angles": None}
    unset = {"waterfall": None, "law": None, "map": None, "clearance": None, "load_factor": None}
    return argparse.Namespace(**{**plain, **unset, "workers": 1, "executor": None, **options})


class TestCases:
    def test_every_combination(self):
        cases = load_cases(given(law=["hertz", "constant:cfd"], clearance=["0 um", "20 um"], load_factor=["1", "1.5"]))
        assert len(cases) == 8
        assert cases[0].label == "dry Hertz, 0 um, 1 x load"
        assert cases[-1].label == "constant cfd, 20 um, 1.5 x load"
        last = cases[-1]
        assert (last.clearance, last.load_factor) == (20e-6, 1.5)
        np.testing.assert_allclose(last.model.scene.loads[0].force[1:3], 150.0)
        np.testing.assert_allclose(cases[0].model.scene.loads[0].force[1:3], 100.0)

    @pytest.mark.slow
    def test_one_case_has_the_name_of_its_law(self):
        (case,) = load_cases(given(law="hertz"))
        assert case.label == "dry Hertz"
        (case,) = load_cases(given())
        assert case.label == "film table"
        (case,) = load_cases(
            argparse.Namespace(scene="nu308_rigid", output=None, plot=None, law="constant:cfd", map=None)
        )
        assert case.label == "constant cfd"
        assert math.isclose(case.clearance, 0.0)

    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("options", "message"),
        [
            ({"law": ["hertz", "hertz"]}, "--law: got 'hertz' twice"),
            ({"law": ["map"]}, "--law: got 'map' without a map"),
            ({"law": ["herz"]}, "--law: got 'herz'"),
            ({"map": ["a.nc", "a.nc"]}, "--map: got 'a.nc' twice"),
            ({"map": ["nowhere.nc"]}, "--map: nowhere.nc: cannot be read"),
            ({"map": ["nowhere.nc"], "films": ["memory"]}, "--map: nowhere.nc: cannot be read"),
            ({"clearance": ["20 kg"]}, "--clearance: "),
            ({"clearance": ["1 m"]}, "--clearance: got '1 m'; allowed: within"),
            ({"clearance": ["nan um"]}, "--clearance: "),
            ({"load_factor": ["x"]}, "--load-factor: got 'x'; allowed: above 0"),
            ({"load_factor": ["nan"]}, "--load-factor: got 'nan'"),
            ({"load_factor": ["inf"]}, "--load-factor: got 'inf'"),
            ({"load_factor": ["-1"]}, "--load-factor: got '-1'"),
            ({"load_factor": ["0"]}, "--load-factor: got '0'"),
            ({"start_angle": ["1 kg"]}, "--start-angle: got the unit 'kg'"),
            ({"start_angle": ["400 deg"]}, "--start-angle: got '400 deg'; allowed: a turn either way"),
            ({"clearance": [f"{k} um" for k in range(5)], "load_factor": list("12345")}, "got 25 combinations"),
            ({"scene": "nowhere"}, "shipped system"),
            ({"output": "nowhere/at/all.nc"}, "is no folder"),
        ],
    )
    def test_what_makes_no_case_is_refused(self, options, message):
        with pytest.raises(InputError) as caught:
            load_cases(given(**options))
        assert any(message in problem for problem in caught.value.problems), caught.value.problems

    def test_problems_come_all_at_once(self):
        with pytest.raises(InputError) as caught:
            command.run(
                given(
                    law=["herz"],
                    clearance=["2 kg"],
                    load_factor=["x"],
                    plot="no/where.png",
                    speed=["9 rpm", "5 kg", "x"],
                    cage_angles="many",
                )
            )
        text = "\n".join(caught.value.problems)
        for words in (
            "'herz'",
            "'kg'",
            "--load-factor: got 'x'",
            "is no folder",
            "--speed, POINTS: got 'x'",
            "angles: got 'many'",
        ):
            assert words in text


class TestCommand:
    def test_a_case_without_equilibrium_is_named(self, tmp_path):
        text = read_scene("nu308_rigid").text.replace('against = "ring_left"\nforce', "force")
        text = text.replace('stiffness = { y = "1e5 N/m", z = "1e5 N/m" }', 'stiffness = { x = "1e5 N/m" }')
        path = tmp_path / "free.toml"
        path.write_text(text)
        with pytest.raises(AnalysisError, match=r"dry Hertz: at 10\.472 rad/s: no equilibrium"):
            command.run(given(scene=str(path), law="hertz", speed=["100 rpm", "200 rpm", "2"]))


@pytest.fixture(scope="module")
def two_sweeps():
    """Damped so strongly at one speed that no bearing mode oscillates, and dry."""
    scene = read_scene("nu308_rigid")
    frequencies = np.geomspace(10.0, 1e4, 20)
    speeds = np.array([500.0, 1000.0]) * RPM
    dry = sweep(assemble(scene, "hertz").system, speeds, 0.0, scene.inputs, scene.sensors, frequencies)
    strong = dataclasses.replace(scene, laws={"strong": (2e7, 1e5)})
    wet = sweep(assemble(strong, "constant:strong").system, speeds, 0.0, scene.inputs, scene.sensors, frequencies)
    return [dry, wet]


class TestResults:
    def test_dataset(self, two_sweeps):
        data = sweep_dataset(two_sweeps, ["dry", "wet"], ["a", "b"], [0.0, math.nan], [1.0, 1.0])
        for name, variable in data.data_vars.items():
            assert "long_name" in variable.attrs, name
            assert "units" in variable.attrs or variable.dtype.kind in "OUS", name
        assert data["frequency"].dims == ("case", "speed", "mode")
        assert data["response_real"].shape == (2, 2, 20, 2, 1)
        # Cases have different numbers of oscillating modes: the rest is NaN.
        counts = [entry.damped.eigenvalues.shape[1] for entry in two_sweeps]
        assert counts[1] < counts[0] == data.sizes["complex_mode"]
        assert np.all(np.isnan(data["complex_frequency"].sel(case="wet")[:, counts[1] :]))
        np.testing.assert_allclose(data["energy_share"].sum("part"), 1.0, rtol=1e-9)
        np.testing.assert_array_equal(data["frequency"].sel(case="dry"), two_sweeps[0].undamped.frequency)
        of_cases = ("law", "clearance", "load_factor")
        of_responses = (*(entry.name for entry in RESPONSES), "quantity")
        assert tuple(data.data_vars) == (*(entry.name for entry in VARIABLES), *of_cases, *of_responses)
        for entry in (*VARIABLES, *RESPONSES):
            assert data[entry.name].dims == entry.dims
            assert data[entry.name].attrs == {"units": entry.units, "long_name": entry.long_name}

    @pytest.mark.slow
    def test_figure(self, two_sweeps, tmp_path):
        figure = sweep_figure("a title", "40 degC", two_sweeps, ["0 um", "20 um"])
        figure.savefig(tmp_path / "a.png")
        # Five panels, two maps and their scale.
        assert len(figure.axes) == 8

    def test_figure_without_bearings_and_responses(self, tmp_path):
        body = rigid_body("a", [Inertia(2.0, 0.01, 0.02)], ["y"])
        result = sweep(System([body], [Spring("s", "a", "ground", 1e5 * np.outer(Y, Y))]), np.array([1.0, 2.0]))
        figure = sweep_figure("a title", "40 degC", [result], ["dry"])
        figure.savefig(tmp_path / "a.png")
        assert len(figure.axes) == 5
        data = sweep_dataset([result], ["dry"], ["a"], [0.0], [1.0])
        assert data.sizes["bearing"] == 0

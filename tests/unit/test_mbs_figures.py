"""What the figures and texts of run-ups, modes, responses and sweeps show: labels, lines, bands."""

from __future__ import annotations

import argparse
import copy
import dataclasses
import math

import numpy as np
import pytest
from matplotlib.colors import to_hex

from ehdmaps.errors import InputError
from mbs.analyses.film_errors import film_course, film_errors, notable_from
from mbs.analyses.reach import Fade, axes_outside, fade_lines, fade_of, outside_lines, share_below
from mbs.bearings.bearing_force import BearingForce
from mbs.commands import modes as modes_command
from mbs.commands.runup import _changes
from mbs.linearised.linear import frequency_response
from mbs.linearised.modes import Modes, modes
from mbs.linearised.sweep import sweep
from mbs.linearised.tracking import numbers
from mbs.linearised.validity import FilmError, memory_error
from mbs.model.equilibrium import equilibrium
from mbs.output.model_text import film_lines
from mbs.output.modes_plot import modes_figure
from mbs.output.page import SHADE
from mbs.output.response_plot import Curves, comparison_figure, response_figure
from mbs.output.result_text import kinds
from mbs.output.run_plot import run_figure
from mbs.output.sweep_plot import sweep_figure
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene
from mbs.transient.run import Recording, States
from tests.cases.bearings import map_law
from tests.cases.pictures import cut_off

RPM = np.pi / 30.0
LOWEST = 0.3
"""Of the entrainment speeds of the small map [m/s]."""


@pytest.fixture(scope="module")
def dry():
    return assemble(read_scene("nu308_rigid"), "hertz")


@pytest.fixture(scope="module")
def films(dry):
    """The same bearings with the law of a small map."""
    bearings = tuple(
        dataclasses.replace(bearing, temperature=330.0, force=BearingForce(bearing.bearing, map_law()))
        for bearing in dry.bearings
    )
    elements = tuple(
        dataclasses.replace(connected, element=bearing)
        for connected, bearing in zip(dry.system.elements, bearings, strict=True)
    )
    system = copy.copy(dry.system)
    system.elements = elements
    return dataclasses.replace(dry, system=system, bearings=bearings, law="map of NU308, test")


def texts(figure):
    """All that is written in a figure."""
    figure.draw_without_rendering()
    legends = [legend for axes in figure.axes if (legend := axes.get_legend()) is not None] + list(figure.legends)
    for part in figure.subfigs:
        legends += part.legends
    words = [text.get_text() for legend in legends for text in legend.get_texts()]
    words += [text.get_text() for axes in figure.axes for text in (*axes.texts, axes.title, axes.xaxis.label)]
    return [*words, figure.get_suptitle(), figure.get_supxlabel()]


def bands(axes):
    """Ranges of the horizontal axis that are shaded."""
    return [
        (patch.get_x(), patch.get_x() + patch.get_width())
        for patch in axes.patches
        if to_hex(patch.get_facecolor()) == SHADE
    ]


class TestReach:
    def test_a_law_without_films_has_no_fade(self, dry):
        assert fade_of(dry) is None
        assert share_below(dry, np.array([0.0, 1.0])) == 0.0
        assert fade_lines(dry, np.array([0.0, 1.0])) == []
        assert np.all(np.isnan(notable_from(dry, np.array([10.0]))))

    def test_films_begin_where_the_fastest_rings_reach_the_lowest_speed(self, films):
        fade = fade_of(films)
        assert fade.entrainment_speed == LOWEST
        assert films.bearings[0].rates[1] * fade.speed == pytest.approx(LOWEST)
        assert fade.source == "the map"
        np.testing.assert_array_equal(fade.below([0.0, -0.5 * fade.speed, fade.speed]), [True, True, False])

    def test_a_share_of_the_speeds_and_its_line(self, films):
        fade = fade_of(films)
        speeds = np.linspace(0.0, 4.0, 9) * fade.speed
        assert share_below(films, speeds) == pytest.approx(2.0 / 9.0)
        assert fade_lines(films, speeds, "the run") == [
            f"warning: 0 to {fade.speed / RPM:.4g} rpm lie below the map (22 % of the run; entrainment speed below "
            "0.3 m/s): the film fades to the dry contact there"
        ]
        assert fade_lines(films, speeds[2:]) == []

    def test_a_single_speed(self, films):
        (line,) = fade_lines(films, np.array([10.0 * RPM]))
        assert line.startswith("warning: 10 rpm lies below the map (entrainment speed below 0.3 m/s, ")

    def test_the_film_formula_has_no_map(self, films):
        assert (
            fade_of(dataclasses.replace(films, law="film formula moes, FVA3")).source == "the table of the film formula"
        )

    def test_changes_inside_and_outside_the_fade(self):
        size, speed = np.array([1.0, 6.0, 7.0, 9.0]), np.array([0.0, 1.0, 2.0, 3.0])
        assert _changes(size, speed, None) == "5 N"
        assert _changes(size, speed, Fade(0.5, 0.05, "the map")).startswith("5 N below 4.775 rpm")
        assert _changes(size, speed, Fade(0.5, 0.05, "the map")).endswith(
            ", where the film fades, and 2 N above, at 19.1 rpm"
        )
        assert _changes(size, speed, Fade(9.0, 0.05, "the map")) == "5 N below 85.94 rpm, where the film fades"
        # Never in the fade: one number.
        assert _changes(size, speed + 1.0, Fade(0.5, 0.05, "the map")) == "5 N"

    def test_calls_outside_are_said_in_one_form(self):
        axes = {"a": "entrainment speed of 5 m/s is outside the map (0.3 to 4 m/s)"}
        lines = outside_lines({"a": 3, "b": 0}, "lies outside the map at {} of 9 speeds", axes, "dry")
        assert lines == [
            "warning: dry: a: lies outside the map at 3 of 9 speeds (entrainment speed of 5 m/s is outside the map "
            "(0.3 to 4 m/s)), where the law is held at its edge; make a map that reaches there"
        ]

    def test_the_table_of_a_film_formula_is_no_map(self):
        (line,) = outside_lines({"a": 1}, "lies outside the map", {}, sources={"a": "the table of the film formula"})
        assert line.startswith("warning: a: lies outside the table of the film formula, where the law is held at its")
        assert line.endswith("; a map may reach there, `mbs plan` writes its job")

    def test_the_axis_that_is_left_is_named_with_its_value(self, films):
        bearing = films.bearings[0]
        law = bearing.force.law
        (low, high), load = law.speed_range, law.load_range[1]
        inside, fast = 0.5 * high / bearing.rates[1], 3.0 * high / bearing.rates[1]
        assert axes_outside(films, fast)[bearing.name] == (
            f"entrainment speed of {3.0 * high:.4g} m/s is outside the map ({low:.4g} to {high:.4g} m/s)"
        )
        loads = {bearing.name: 2.0 * load}
        assert axes_outside(films, inside, loads)[bearing.name] == (
            f"load per length of {2e-3 * load:.4g} N/mm is outside the map ({1e-3 * law.load_range[0]:.4g} to "
            f"{1e-3 * load:.4g} N/mm)"
        )
        # loads of a run are not recorded: what is left over is the load
        assert axes_outside(films, inside)[bearing.name] == f"a load above {1e-3 * load:.4g} N/mm, where the map ends"


class TestWords:
    def test_films_of_slow_motion_are_said_to_be_wrong(self):
        """One slice of k = c = spring = 1 and theta = 1 ms: Z = k + s c - s^2 theta^2/(1 + s theta)."""
        entry = FilmError("a", "slow", False, 1.0, 1e-3, np.array([1.0]), *[np.array([1e-3])] * 2)
        s = 2j * math.pi * 100.0
        more = -((s * 1e-3) ** 2) / (1.0 + s * 1e-3)
        assert entry.at(100.0) == pytest.approx(abs(more) / abs(1.0 + s * 1e-3 + more))
        (line,) = film_lines([entry], [50.0, 100.0])
        assert line.startswith("warning: a: slow films; estimated error of the dynamic stiffness along the ")
        assert (
            f"load at 100 Hz: {100.0 * entry.at(100.0):.2g} %, from {entry.frequency:.4g} Hz on more than 5 %" in line
        )
        assert line.endswith("; with --films memory films follow at their own frequency")
        (line,) = film_lines([entry], [1.0], " and 500 rpm")
        assert line.startswith("a: slow films; ") and "load at 1 Hz and 500 rpm: " in line

    def test_films_with_memory_have_an_error_too(self):
        entry = FilmError("a", "memory", False, 1.0, 1e-3, np.array([1.0, 0.0]), *[np.array([1e-3, 1.0])] * 2)
        # omega T = 1 of the only slice that relaxes
        (line,) = film_lines([entry], [1e3 / (2.0 * math.pi)])
        assert line.startswith("a: films with memory; estimated error") and line.endswith(": 1.5 %")
        (line,) = film_lines([entry], [30e3 / (2.0 * math.pi)])
        assert line.startswith("warning: a: films with memory; ") and ": 7.9 %, from " in line
        assert line.endswith(" Hz on more than 5 %")

    def test_errors_of_films_with_memory_rise_with_the_frequency(self):
        found = memory_error(np.geomspace(1e-3, 1e3, 100))
        assert np.all(np.diff(found) > 0.0)
        # between two points that were measured
        assert 0.015 < memory_error(np.array([2.0]))[0] < 0.031

    def test_at_rest_there_is_no_film(self):
        entry = FilmError("a", "slow", True, 1.0, 0.0, np.array([0.0]), *[np.array([1.0])] * 2)
        assert entry.at(1e4) == 0.0 and entry.frequency == math.inf
        (line,) = film_lines([entry], [1e4])
        assert line == "warning: a: at rest no film: the stiffness is that of dry contacts, no damping"

    def test_a_course_names_both_ends(self, films):
        (line,) = film_course(films, (500.0 * RPM, 1000.0 * RPM))
        assert line.startswith("slow films: dynamic stiffness along the load with an estimated error of up ")
        assert "Hz at 500 rpm" in line and "Hz at 1000 rpm" in line
        assert film_course(films, (0.0,)) == []

    def test_the_films_that_are_asked_for(self, films):
        place = equilibrium(films.system, films.operation).displacement
        slow, memory = (film_errors(films, place, films.operation, kind) for kind in ("slow", "memory"))
        assert [entry.films for entry in slow + memory] == ["slow"] * 2 + ["memory"] * 2
        assert memory[0].frequency > slow[0].frequency > 0.0

    def test_limits_rise_with_the_speed(self, films):
        limits = notable_from(films, np.array([500.0, 1000.0]) * RPM)
        assert 0.0 < limits[0] < limits[1]


def trajectory(model, force, speed=None):
    """A run whose bearings have a given force along y [N], and stand at 1 nm."""
    count = force.size
    zeros = np.zeros((count, model.system.size))
    forces = np.zeros((count, 12))
    forces[:, 1] = force
    rings = np.zeros((count, 12))
    rings[:, 1] = np.sqrt(2.0) * 1e-12
    time = np.linspace(0.0, 1.0, count)
    place = zeros.copy()
    place[:, :] = 1e-9
    speed = time * 100.0 if speed is None else speed
    return Recording(
        time=time,
        speed=speed,
        angle=speed,
        signals=np.zeros((count, 0)),
        signal_time=time,
        signal_speed=speed,
        signal_angle=speed,
        forces=(forces, 2.0 * forces),
        motions=(rings, rings),
        steps=count - 1,
        halved=0,
        iterations=count,
        outside={},
        compiled=0,
        notes=(),
        states=States(place, zeros, zeros),
        account=lambda: pytest.fail("a figure asked for the energy balance"),
    )


class TestRunFigure:
    FORCE = 141.42 + 1e-4 * np.sin(np.arange(50.0))

    def test_every_bearing_has_panels_of_its_own(self, dry):
        figure = run_figure(dry, trajectory(dry, self.FORCE))
        axes = figure.axes
        assert [panel.get_title() for panel in axes[:2]] == ["bearing_left", "bearing_right"]
        for panel, factor in zip(axes[:2], (1.0, 2.0), strict=True):
            (line,) = panel.lines
            np.testing.assert_allclose(line.get_ydata(), factor * self.FORCE)
        assert [panel.get_ylabel() for panel in axes[::2]] == [
            "bearing force, N",
            "inner ring against\nthe outer one, pm",
            "speed, rpm",
        ]
        assert not any(bands(panel) for panel in axes)

    def test_no_axis_hides_an_offset(self, dry):
        figure = run_figure(dry, trajectory(dry, self.FORCE))
        figure.draw_without_rendering()
        assert [panel.yaxis.get_offset_text().get_text() for panel in figure.axes] == [""] * 6

    def test_round_off_is_not_blown_up(self, dry):
        figure = run_figure(dry, trajectory(dry, 141.42 + 1e-12 * self.FORCE))
        low, high = figure.axes[0].get_ylim()
        assert high - low >= 1e-6 * 141.0

    @pytest.mark.parametrize(("size", "unit"), [(5e4, "kN"), (3.0, "N"), (1e-3, "mN"), (0.0, "kN")])
    def test_units_are_readable(self, dry, size, unit):
        figure = run_figure(dry, trajectory(dry, np.full(9, size)))
        assert figure.axes[0].get_ylabel() == f"bearing force, {unit}"

    def test_what_lies_below_the_map_is_shaded_and_said(self, dry):
        run = trajectory(dry, self.FORCE)
        figure = run_figure(dry, run, 25.0, "below the map: film fades")
        for panel in figure.axes:
            ((begin, end),) = bands(panel)
            assert begin == 0.0
            assert run.speed[run.time < end].max() < 25.0 <= run.speed[run.time >= end].min()
        assert "below the map: film fades" in texts(figure)

    def test_every_slow_part_is_shaded(self, dry):
        speed = 30.0 + 30.0 * np.cos(np.linspace(0.0, 4.0 * np.pi, 50))
        figure = run_figure(dry, trajectory(dry, self.FORCE, speed), 10.0, "slow")
        assert len(bands(figure.axes[0])) == 2


@pytest.fixture(scope="module")
def found(dry):
    return modes(equilibrium(dry.system, dry.operation))


class TestModes:
    def test_only_the_modes_shown_are_drawn(self, dry, found):
        figure = modes_figure(dry, found, np.array([0, 2, 3]), 3000.0, "5 more")
        (panel,) = figure.axes
        labels = [text.get_text().split("\n") for text in panel.get_xticklabels()]
        assert [label[0] for label in labels] == ["1:", "3:", "4:"]
        assert labels[0][1] == f"{found.frequency[0]:.5g} Hz"
        assert panel.get_xlabel().endswith("\n5 more")
        assert panel.get_ylim()[0] == 0.0 and 100.0 in panel.get_yticks()
        assert not bands(panel)

    def test_modes_above_the_limit_are_marked(self, dry, found):
        limit = 0.5 * (found.frequency[3] + found.frequency[4])
        figure = modes_figure(dry, found, np.arange(8), limit)
        assert bands(figure.axes[0]) == [(3.5, 7.5)]
        assert any("estimated error" in text for text in texts(figure))

    def test_many_labels_stand_apart(self, dry, found):
        many = Modes(np.tile(found.eigenvalues, 20), np.tile(found.shapes, 20), found.parts, np.tile(found.shares, 20))
        figure = modes_figure(dry, many, np.arange(160))
        assert len(figure.axes[0].get_xticks()) <= 60

    def test_free_and_overdamped_motions_are_told_apart(self):
        values = np.array([0.0, -1e-9, -50.0, 3j - 0.1, 1e4j - 1.0])
        shares = np.array([[0.0, 0.0, 1.0, 1.0, 1.0]])
        found = kinds(Modes(values, np.eye(5), ("spring",), shares))
        assert [list(kind) for kind in found] == [[0, 1], [2], [3, 4]]

    def given(self, **more):
        names = ("law", "map", "clearance", "output", "plot", "highest")
        return argparse.Namespace(
            **{**dict.fromkeys(names), "scene": "n1014_rigid", "workers": 1, "executor": None, **more}
        )

    def test_text_has_the_modes_up_to_the_highest_frequency(self):
        text, status = modes_command.run(self.given(law="hertz", highest="1 kHz", cage_angles="1"))
        assert status == 0
        rows = [line for line in text.splitlines() if line[:6].strip().isdigit() and "rpm" not in line]
        assert [int(row.split()[0]) for row in rows] == [1, 2, 3, 4]
        assert "  26 more modes above 1000 Hz, up to 29546 Hz, not shown (--highest)" in text
        # Damping ratios of round-off are none.
        assert all(row.split()[2] == "0" for row in rows)

    def test_the_default_is_the_highest_frequency_of_the_responses(self):
        text, _ = modes_command.run(self.given(law="hertz"))
        assert "12 more modes above 10000 Hz" in text

    @pytest.mark.slow
    def test_free_motions_are_one_line_and_creeping_ones_apart(self, tmp_path):
        scene = read_scene("nu308_rigid").text
        spring = 'stiffness = { y = "1e5 N/m"'
        changed = scene.replace(spring, f'damping = {{ y = "1e6 N s/m" }}\n{spring}', 1)
        assert changed != scene
        path = tmp_path / "damped.toml"
        path.write_text(changed)
        text, _ = modes_command.run(self.given(scene=str(path), films="slow"))
        assert "overdamped (no oscillation): time to fall to 1/e" in text
        assert " ms " in text

    @pytest.mark.slow
    def test_bad_input_comes_all_at_once(self):
        with pytest.raises(InputError) as caught:
            modes_command.run(self.given(highest="0.1 Hz", clearance="5 kg"))
        text = str(caught.value)
        assert "--highest: got '0.1 Hz'; allowed: 1 Hz to 1e+06 Hz" in text and "--clearance" in text
        with pytest.raises(InputError, match=r"--highest: got the unit 'm'"):
            modes_command.run(self.given(highest="3 m"))


@pytest.fixture(scope="module")
def responses(dry):
    frequencies = np.geomspace(10.0, 1e4, 400)
    balance = equilibrium(dry.system, dry.operation)
    return frequencies, frequency_response(balance, dry.scene.inputs, dry.scene.sensors, frequencies)


class TestResponseFigure:
    def test_phase_of_an_undamped_system_does_not_flicker(self, dry, responses):
        figure = response_figure(dry, Curves("a", *responses))
        phase = np.concatenate([line.get_ydata() for line in figure.axes[-1].lines])
        # Only 0 and 180 degrees: -180 is the same as 180, and is drawn as that.
        assert np.nanmin(phase) > -1.0

    def test_lines_break_where_the_phase_passes_180_degrees(self, dry):
        frequencies = np.linspace(1.0, 2.0, 50)
        turning = (frequencies * np.exp(-6j * np.pi * frequencies))[:, None, None] * np.ones((1, 2, 1))
        figure = response_figure(dry, Curves("a", frequencies, turning))
        line = figure.axes[-1].lines[0].get_ydata()
        assert np.count_nonzero(np.isnan(line)) == 3
        assert np.nanmax(np.abs(np.diff(line))) < 270.0

    def test_frequencies_above_the_limit_are_shaded(self, dry, responses):
        figure = response_figure(dry, Curves("a", *responses, 500.0), ["contacts lift off"])
        for panel in figure.axes:
            ((begin, end),) = bands(panel)
            assert (begin, end) == (500.0, panel.get_xlim()[1])
        assert any("estimated error" in text for text in texts(figure))
        assert "contacts lift off" in texts(figure)
        assert not any(bands(panel) for panel in response_figure(dry, Curves("a", *responses, math.inf)).axes)

    def test_cases_side_by_side_have_a_legend_and_lines_where_their_films_end(self, dry, responses):
        figure = comparison_figure(dry, [Curves("a", *responses, 500.0), Curves("b", *responses)], ["lifts"])
        words = texts(figure)
        assert (
            "a (from the upright line at 500 Hz on: estimated error of the films above 5 %)" in words and "b" in words
        )
        assert any("laws side by side" in word for word in words)
        assert not any(bands(panel) for panel in figure.axes)
        upright = [line for line in figure.axes[0].lines if list(line.get_xdata()) == [500.0, 500.0]]
        assert len(upright) == 1


@pytest.fixture(scope="module")
def result(dry):
    scene = dry.scene
    speeds = np.linspace(0.0, 1000.0, 5) * RPM
    return sweep(dry.system, speeds, 0.0, scene.inputs, scene.sensors, np.geomspace(10.0, 1e4, 20))


class TestSweepFigure:
    def test_limit_shade_names_and_numbers(self, result):
        limit = np.linspace(100.0, 1000.0, 5)
        figure = sweep_figure("title", "law a; clearance 0 um", [result], ["a"], [limit], 100.0 * RPM)
        frequency, change, *middle = figure.axes[:5]
        assert figure.get_suptitle() == "title\nlaw a; clearance 0 µm"
        for panel in (frequency, figure.axes[5]):
            assert any(np.array_equal(line.get_ydata(), limit) for line in panel.lines)
        for panel in (frequency, change, *middle):
            ((begin, end),) = bands(panel)
            assert end == pytest.approx(100.0) and begin == panel.get_xlim()[0]
        words = texts(figure)
        assert "above the line: estimated error of the films above 5 %" in words
        assert "below 100 rpm: below the map, film fades to dry" in words
        assert "k, c of bearing_left" in words and "k, c of bearing_right" in words
        numbered = {int(text.get_text()) for text in frequency.texts}
        shown = np.flatnonzero(result.undamped.bearing_share.max(axis=0) >= 0.05) + 1
        assert numbered and numbered <= set(shown.tolist())

    def test_nothing_is_marked_for_dry_bearings(self, result):
        figure = sweep_figure("title", "law", [result], ["a"])
        assert not any("estimated error" in word or "below" in word for word in texts(figure) if word)
        assert not any(bands(panel) for panel in figure.axes)

    @pytest.mark.slow
    def test_names_of_bearings_lie_off_the_curves_and_on_the_page(self, result):
        of, count = result.bearings, 20
        wide = {
            part.name: np.repeat(values[:, :1], count, axis=1)
            for part in dataclasses.fields(of)
            if isinstance(values := getattr(of, part.name), np.ndarray)
        }
        names = tuple(f"{k}, a bearing with a name that is much too long for a legend" for k in range(count))
        many = dataclasses.replace(result, bearings=dataclasses.replace(of, names=names, **wide))
        figure = sweep_figure("title", "law", [many], ["a"])
        figure.draw_without_rendering()
        (legend,) = figure.subfigs[1].legends
        box = legend.get_window_extent()
        assert len(legend.get_texts()) >= count
        assert all(box.y1 <= panel.get_window_extent().y0 for panel in figure.axes[2:5])
        assert all(panel.get_window_extent().height > 100.0 for panel in figure.axes[2:5])
        assert cut_off(figure) == []

    def test_round_off_is_no_change_and_no_offset(self, result):
        figure = sweep_figure("title", "law", [result], ["a"])
        figure.draw_without_rendering()
        low, high = figure.axes[1].get_ylim()
        assert low <= -0.01 and high >= 0.01
        assert all(panel.yaxis.get_offset_text().get_text() == "" for panel in figure.axes[:5])

    def test_complex_modes_have_the_numbers_of_undamped_ones(self, result):
        np.testing.assert_array_equal(np.sort(result.damped.number), np.arange(result.damped.number.size))
        order = np.argsort(result.damped.number)
        # Without damping both are the same, but for the gyroscopic terms of a rigid shaft.
        np.testing.assert_allclose(
            result.damped.frequency[0, order], result.undamped.frequency[0, result.damped.number[order]], rtol=1e-9
        )


def test_a_mode_that_comes_back_has_its_number_again():
    near = np.array([[0.1, 0.9], [0.8, 0.2]])
    order = np.array([[0, 1, -1], [0, -1, -1], [0, -1, 1]])
    plain = np.array([[0, 1], [0, 1], [0, 1]])
    np.testing.assert_array_equal(numbers(order, plain, [near, near, near]), [1, 0, 0])


def test_a_sweep_draws_the_responses_of_all_cases():
    model = assemble(read_scene("nu308_rigid"), "hertz")
    ports, frequencies = (model.scene.inputs, model.scene.sensors), np.array([100.0, 1000.0, 2000.0])
    entry = sweep(model.system, np.array([100.0, 200.0]), 0.0, *ports, frequencies)
    labels = [f"case {number}" for number in range(10)]
    figure = sweep_figure("a machine", "side by side", [entry] * 10, labels)
    assert [panel.get_title() for panel in figure.axes if panel.get_title()] == labels

"""Units of ball bearings whose films have a memory, by FMPy: against the element in time, linear analyses, energy."""

from __future__ import annotations

import dataclasses
import math
import tomllib
from unittest import mock

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu

from ehdmaps.errors import SolverError
from ehdmaps.exports.fmu.binaries import platforms
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FilmConditions, OilSupply
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.surface import Surface
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_point import BallPoint
from mbs.bearings.balls.films import ball_films
from mbs.bearings.balls.laws import dry_law
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.cli import main
from mbs.model.elements import Operation
from mbs.one_bearing.balls import BALL_BEARINGS
from mbs.one_bearing.files import Export, write_export
from mbs.output.one_bearing.kind import Description
from tests.cases.ball_runs import driven
from tests.cases.fmu import FIVE, POSE, Unit, stepped
from tests.unit.test_ball_relaxing import by_hand

SPEED, WARM, STEP = 3000.0 * math.pi / 30.0, 333.15, 5e-6
FELT = [0, 1, 2, 4, 5]
PLACE = np.array([95e-6, -3e-6, 1e-6, 0.0, 2e-5, -4e-5])
REAL = FilmConditions(inlet_heat=True, supply=OilSupply(2e-6), surface=Surface(0.1e-6))
"""Films with heat, which is the default, on an oil layer, between rough surfaces."""
REAL_WORDS = ("--supply", "2 um", "--roughness", "0.1 um")


@pytest.fixture(scope="module")
def element():
    geometry = ball_estimate("6208")
    u = geometry.entrainment_speed(SPEED)
    law = ball_films(geometry, Lubricant.named("FVA3"), u, WARM, solves=False, conditions=REAL).law

    def films(inner, outer):
        return law

    return LocatingElement("b", "i", "o", BallForce(geometry, dry_law(geometry)), films=films, memory="memory")


@pytest.fixture(scope="module")
def units(tmp_path_factory):
    folder = tmp_path_factory.mktemp("films")
    words = ("--load", "1 kN", "--axial", "2 kN", "--temperature", "60 degC", "--speed", "3000 rpm", "--law", "table")
    with mock.patch("ehdmaps.exports.fmu.unit.platforms", return_value=platforms()[:1]):
        for name in ("2.fmu", "3.fmi3.fmu"):
            assert main(["bearing", "6208", *words, *REAL_WORDS, "--films", "memory", "-o", str(folder / name)]) == 0
    return {name[0]: folder / name for name in ("2.fmu", "3.fmi3.fmu")}


@pytest.fixture(scope="module")
def unpacked(units, tmp_path_factory):
    return {fmi: Unit(units[fmi], tmp_path_factory.mktemp(f"unit{fmi}")) for fmi in units}


@pytest.mark.parametrize("fmi", ["2", "3"])
def test_unit_in_time_is_the_element(units, unpacked, element, fmi):
    """Up to 60 um within 0.2 ms, so that balls lift off: both end in the balance of the balls to 1e-9, and the last
    speed of the cage is found to 1e-8."""
    assert validate_fmu(str(units[fmi])) == []
    turn = np.linspace(0.0, 4.0 * math.pi, 81)
    path = PLACE + np.outer(np.sin(turn), [-60e-6, 20e-6, 10e-6, 0.0, 1e-4, -5e-5])
    wanted, least = driven(element, SPEED, path, STEP)
    found = stepped(unpacked[fmi], path[:, FELT], SPEED, STEP)
    assert least < 1e-3 * np.abs(wanted).max()
    slow = np.array([element.evaluate(place, np.zeros(6), Operation(SPEED)).force[FELT] for place in path[::8]])
    largest = np.abs(wanted).max(axis=0)
    assert np.all(np.abs(wanted[::8] - slow).max(axis=0) > 5e-3 * largest)
    np.testing.assert_array_less(np.abs(found - wanted).max(axis=0), 1e-7 * largest)


def test_small_oscillations_are_those_of_linear_analyses(unpacked, element):
    """As in runs of the package: the step, of second order, leaves 3e-4 of Z."""
    count, periods, size = 80, 8, 1e-9
    hertz, turn = 1.0 / (count * STEP), 2.0 * math.pi / count * np.arange(periods * count + 1)
    path = np.tile(PLACE, (turn.size, 1))
    path[:, 1] += size * np.sin(turn)
    last = slice(-2 * count, None)
    forces = stepped(unpacked["2"], path[:, FELT], SPEED, STEP)
    found = -1j * (forces[last] * np.exp(-1j * turn[last])[:, None]).sum(axis=0) / (count * size)
    operation, s = Operation(SPEED), 2j * math.pi * hertz
    rest = element.evaluate(PLACE, np.zeros(6), operation)
    linear = (rest.stiffness + s * rest.damping)[1, 1]
    linear += element.relaxation(PLACE, operation).more(np.array([s]))[0, 1, 1]
    assert abs(found[1] / linear - 1.0) < 4e-4


def test_closed_paths_take_energy_and_long_steps_are_many(unpacked):
    """Work of the second round, by the trapezoidal rule; a step of 20 us is four of 5 us along a straight line."""
    turn = 2.0 * math.pi / 100 * np.arange(201)
    path = PLACE + np.outer(np.sin(turn), [-40e-6, 0.0, 0.0, 0.0, 0.0, 0.0])
    path[:, 1] += 5e-6 * np.cos(2.0 * turn)
    forces = stepped(unpacked["2"], path[:, FELT], SPEED, STEP)
    work = -0.5 * (forces[101:] + forces[100:-1]) * np.diff(path[100:, FELT], axis=0)
    assert work.sum() > 1e-3 * np.abs(work).sum()
    coarse = path[::4]
    fine = np.array([np.interp(np.arange(201) / 4.0, np.arange(51), column) for column in coarse.T]).T
    long = stepped(unpacked["2"], coarse[:, FELT], SPEED, 4.0 * STEP)
    np.testing.assert_allclose(long[1:], stepped(unpacked["2"], fine[:, FELT], SPEED, STEP)[4::4], rtol=1e-7, atol=1e-6)


def test_states_are_kept_and_rest_is_that_of_the_export(units, unpacked):
    """FMPy's own loop begins in equilibrium; a state that was kept gives the same steps; no Model Exchange."""
    found = simulate_fmu(str(units["2"]), stop_time=1e-4, output_interval=2e-5)
    np.testing.assert_allclose(found["force.x"], -2000.0, rtol=1e-6)
    unit = unpacked["2"]
    assert unit.description.modelExchange is None
    model, seen = unit.stepped([*POSE, "speed.inner"], [*PLACE[FELT], SPEED]), []
    kept = model.getFMUState()
    for _ in range(2):
        unit.put(model, POSE, list(PLACE[FELT] + np.array([2e-6, 0.0, 0.0, 0.0, 0.0])))
        model.doStep(0.0, STEP)
        seen.append(unit.get(model, FIVE))
        model.setFMUState(kept)
    model.freeFMUState(kept)
    np.testing.assert_array_equal(*seen)
    model.freeInstance()


@pytest.mark.parametrize("rpm", [("3000",), ("3000", "6000", "2")])
def test_file_for_ross_is_contacts_in_series(tmp_path, rpm):
    """K and C of one speed over frequency, and of several at their turning, against complex stiffness by hand: its
    traction is not symmetrical, which moves K by less than 1e-5."""
    output, rows = tmp_path / "b.toml", [0, 11, 34] if len(rpm) == 1 else [0, 1]
    words = f"bearing 6208 --load 1kN --axial 2kN --temperature 60degC --law table --films memory -o {output} --speed"
    assert main([*words.split(), *(f"{value} rpm" if float(value) > 10.0 else value for value in rpm)]) == 0
    (written,) = tomllib.loads(output.read_text()).values()
    geometry = ball_estimate("6208")
    for row in rows:
        at = written["frequency"][row]
        speed = at if len(rpm) > 1 else SPEED
        u = geometry.entrainment_speed(speed)
        law = ball_films(geometry, Lubricant.named("FVA3"), u, WARM, solves=False, conditions=FilmConditions(True)).law
        point = BallPoint.at(BallForce(geometry, law), (2000.0, 1000.0, 0.0), speed)
        balls = point.force.loads(point.pose, inner_speed=speed)
        z = by_hand(point.force, balls, speed, 1j * max(at, 1e-3))
        for term, axis in (("xx", 1), ("yy", 2), ("zz", 0)):
            found = written[f"k{term}"][row] + 1j * max(at, 1e-3) * written[f"c{term}"][row]
            assert abs(found / z[axis, axis] - 1.0) < 1e-5
            assert found.imag == pytest.approx(z[axis, axis].imag, rel=1e-3)


@pytest.mark.parametrize(("law", "output"), [("hertz", "x.c"), ("table", "x.nc")])
def test_memory_is_for_units_with_films(capsys, law, output):
    words = (
        "bearing",
        "6208",
        "--load",
        "1 kN",
        "--speed",
        "3000 rpm",
        "--law",
        law,
        "--films",
        "memory",
        "-o",
        output,
    )
    assert main(list(words)) == 2
    assert "allowed: with --law table and -o NAME.c, NAME.fmu, NAME.toml" in capsys.readouterr().err


def test_solved_films_have_no_memory():
    geometry = ball_estimate("6208")
    law = ball_films(geometry, Lubricant.named("FVA3"), geometry.entrainment_speed(SPEED), WARM, solves=False).law
    force = BallForce(geometry, dataclasses.replace(law, responses=()))
    point = BallPoint.at(force, (2000.0, 1000.0, 0.0), SPEED)
    description = Description("films", "", 0.0, WARM, 0.3e-6, False, ())
    given = Export(BALL_BEARINGS, force, description, [point], 0.0, lambda u: force.law, True)
    for name in ("x.toml", "x.c"):
        with pytest.raises(SolverError, match="no response over frequency"):
            write_export(name, given)

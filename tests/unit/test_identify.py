"""`mbs identify`: words of unknowns, files of measurements, wrong channels, scenes with what was found."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs import parse_scene, read_scene
from mbs.identification.certainty import Certainty, Trial, covariance
from mbs.identification.explained import OtherLaw, wrong_channels
from mbs.identification.found import Identified
from mbs.identification.free import read_free
from mbs.identification.machine import Machine, looked
from mbs.identification.measured import MeasuredModes, MeasuredResponses, noise_of
from mbs.identification.reading import Reading, read_measured
from mbs.identification.search import Fit, Question, jacobian_at, residual_of
from tests.cases.identify_twins import ROTOR, RPM, balls

LINES = np.arange(50.0, 1500.0, 50.0)


@pytest.fixture(scope="module")
def drive():
    """The electric drive at one cage angle, and its responses without noise at 6000 rpm."""
    twin = balls(angles=1)
    rows = tuple((sensor, twin.scene.inputs[0]) for sensor in twin.scene.sensors[:2])
    shape = LINES.size, len(rows)
    empty = MeasuredResponses("twin", 6000.0 * RPM, LINES, np.ones(shape, complex), np.full(shape, 0.02), rows)
    values = [twin.hidden[one.name] for one in twin.free]
    response = np.exp(looked(twin.machine, twin.scene, twin.free, values, empty))
    return twin, dataclasses.replace(empty, response=response)


def fit_of(twin, *measured) -> Fit:
    """A fit that ended at the hidden values."""
    question = twin.question(measured)
    parts = (twin.truth - question.low) / question.width
    return Fit(question, parts, *jacobian_at(question, parts), (0.0,), 1)


def test_unknowns_of_a_scene() -> None:
    found = read_free(["clearance", "temperature", "alpha", "pull.force", "foot_left.damping"], read_scene(ROTOR))
    assert [one.name for one in found] == [
        "left.clearance",
        "right.clearance",
        "temperature",
        "alpha",
        "pull.force",
        "foot_left.damping.y",
        "foot_left.damping.z",
    ]
    assert [one.log for one in found] == [False, False, False, True, True, True, True]


@pytest.mark.parametrize(
    ("word", "low", "high", "value"),
    [
        ("left.clearance = 5 um to 40 um", 5e-6, 40e-6, 12e-6),
        ("temperature = 20 degC to 90 degC", 293.15, 363.15, 320.0),
        ("foot_right.stiffness.z = 1e8 N/m to 1e9 N/m", 1e8, 1e9, 3e8),
        ("rotor.damping_ratio", 0.0002, 0.02, 0.005),
    ],
)
def test_an_unknown_goes_into_the_scene_and_back(word, low, high, value) -> None:
    scene = read_scene(ROTOR)
    (one,) = read_free([word], scene)
    assert (one.low, one.high) == pytest.approx((low, high))
    (again,) = read_free([one.name], one.change(scene, value))
    assert again.start == pytest.approx(value, rel=1e-12)
    assert one.value(one.coordinate(value)) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["clearence"], "got 'clearence' (did you mean 'clearance'?)"),
        (["left.stiffness"], "allowed: clearance, left.clearance, right.clearance, temperature"),
        (["foot_left.stiffness.x"], "foot_left has stiffness along y, z"),
        (["temperature = 40 degC"], "allowed: a range"),
        (["left.clearance = 40 um to 5 um"], "it rises"),
        (["rotor.damping_ratio = 0 to 0.1"], "allowed: above 0"),
        ([], "got nothing to find"),
    ],
)
def test_words_that_are_no_unknown(words, told) -> None:
    with pytest.raises(InputError) as caught:
        read_free(words, read_scene(ROTOR))
    assert told in str(caught.value)


def test_what_is_known_beforehand() -> None:
    text = ROTOR.read_text(encoding="utf-8").replace('"25 um"', '"25 um +- 3 um"').replace('"30 um"', '"30 um +- 0 um"')
    scene = parse_scene(text, "rotor", "here")
    (left,) = read_free(["left.clearance"], scene)
    assert left.prior == pytest.approx((25e-6, 3e-6 / math.sqrt(3.0)))
    with pytest.raises(InputError, match="stated to be exact"):
        read_free(["right.clearance"], scene)


def test_responses_of_a_table_are_those_of_the_scene(tmp_path) -> None:
    path = tmp_path / "frf.csv"
    path.write_text(
        "frequency [Hz],Left_Z/hammer real [mm/s2/N],Left_Z/hammer imag [mm/s2/N],Left_Z/hammer coherence [1]\n"
        "100,1000,0,0.99\n200,0,2000,0.98\n300,3000,0,0.97\n"
    )
    reading = Reading({"hammer": "hit_z"}, averages=10)
    (found,), notes = read_measured(path, 100.0, read_scene(ROTOR), reading)
    assert isinstance(found, MeasuredResponses)
    assert [(sensor.name, sensor.quantity, entry.name) for sensor, entry in found.rows] == [
        ("left_z", "acceleration", "hit_z")
    ]
    assert found.response[:, 0] == pytest.approx([1.0, 2.0j, 3.0])  # mm/s2 are a thousandth of m/s2
    assert not notes


def test_modes_of_a_table_by_speed(tmp_path) -> None:
    path = tmp_path / "modes.csv"
    path.write_text("speed [rpm],frequency [Hz],damping ratio [%]\n1000,200,1\n2000,310,3\n2000,210,2\n")
    found, notes = read_measured(path, None, read_scene(ROTOR), Reading())
    assert [(one.speed / RPM, one.frequency.tolist()) for one in found if isinstance(one, MeasuredModes)] == [
        (pytest.approx(1000.0), [200.0]),
        (pytest.approx(2000.0), [210.0, 310.0]),
    ]
    assert found[1].damping_ratio == pytest.approx([0.02, 0.03])
    assert "paired by their frequencies" in notes[0]


@pytest.mark.parametrize(
    ("text", "speed", "told"),
    [
        ("frequency [Hz],a/b real [m/s2/N]\n1,1\n2,2\n", 1.0, "a/b has real; allowed: real and imag"),
        ("frequency [Hz],a/b real [m/N],a/b imag [m/N]\n1,1,1\n2,1,1\n", 1.0, "no sensor is called 'a'"),
        ("frequency [Hz],a/b real [V],a/b imag [V]\n1,1,1\n2,1,1\n", 1.0, "got the unit 'V'"),
        ("frequency [Hz],a [m]\n1,1\n", 1.0, "got 'a'; allowed: SENSOR/INPUT real"),
        ("time [s],a/b real [m/N]\n1,1\n", 1.0, "0 columns of a frequency"),
        ("frequency [Hz],damping ratio [1]\n1,1\n", None, "has no speeds"),
        ("speed [rpm],frequency [Hz]\n1,-1\n", None, "row 1: got numbers of a mode"),
        ("speed [rpm],frequency [Hz]\n1,nan\n", None, "row 1: got numbers of a mode"),
        (
            "frequency [Hz],left_z/hit_z real [m/s2/N],left_z/hit_z imag [m/s2/N]\n1,1,1\n2,1,1\n",
            None,
            "without a speed",
        ),
    ],
)
def test_tables_that_are_refused(tmp_path, text, speed, told) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_measured(path, speed, read_scene(ROTOR), Reading())
    assert told in str(caught.value)


def test_noise_of_averages_is_that_of_many_draws() -> None:
    """Deviation by coherence beside that of known noise; of 8 hits its mean over 500 lines is known to 10 %."""
    rng = np.random.default_rng(2)
    hits, lines, size = 8, 500, 0.2
    force = rng.normal(size=(hits, lines)) + 1j * rng.normal(size=(hits, lines))
    noise = size * (rng.normal(size=(hits, lines)) + 1j * rng.normal(size=(hits, lines)))
    response = 3.0 * force + noise
    cross, powers = (
        np.mean(force.conj() * response, axis=0),
        [np.mean(np.abs(x) ** 2, axis=0) for x in (force, response)],
    )
    H, coherence = cross / powers[0], np.abs(cross) ** 2 / (powers[0] * powers[1])
    told = noise_of(H[:, None], coherence[:, None], hits)[:, 0]
    # The mean of 1/(sum of 8 squares) is 8/7 of 1/(its mean).
    true = size / 3.0 / math.sqrt(hits) * math.sqrt(8.0 / 7.0)
    assert np.sqrt(np.mean(told**2)) == pytest.approx(true, rel=0.1)
    assert np.std(np.abs(H / 3.0 - 1.0)) < 2.0 * true


def test_residuals_are_ratios_and_know_no_branch(drive) -> None:
    _, measured = drive
    turned = dataclasses.replace(measured, response=measured.response * np.exp(0.01j))
    around = np.log(measured.response) + 2j * math.pi  # the same response, another branch of its logarithm
    assert np.abs(residual_of(around, measured)).max() < 1e-9
    assert residual_of(around, turned)[LINES.size * 2 :] == pytest.approx(-0.01 * math.sqrt(2.0) / 0.02, rel=1e-9)


@pytest.mark.parametrize(("factor", "words"), [(-1.0, "sign of the other"), (1000.0, "another unit"), (1.0, None)])
def test_channels_that_are_not_what_they_are_called(drive, factor, words) -> None:
    twin, measured = drive
    wrong = measured.response.copy()
    wrong[:, 1] *= factor
    found = wrong_channels(fit_of(twin, dataclasses.replace(measured, response=wrong)))
    assert len(found) == (words is not None)
    if words is not None:
        assert words in found[0].words and found[0].channel.startswith(f"{measured.rows[1][0].name} by")


def test_unknowns_that_nothing_depends_on_are_not_told() -> None:
    jacobian = np.array([[1.0, 1.0, 0.0], [2.0, 2.0 + 1e-6, 0.0]])
    deviation, correlation = covariance(jacobian, np.array([1.0, 1.0, 2.0]))
    assert deviation[2] > 100.0 and abs(correlation[0, 1]) > 0.99
    sure = Certainty(deviation, correlation, (Trial("a", np.array([[3.0, 0.0, -4.0]])),), 0.5)
    assert sure.groups() == [[0, 1]] and 2 in sure.untold(np.array([1.0, 1.0, 2.0]))
    assert sure.rise[0] == pytest.approx(math.hypot(2.0 * deviation[0], 3.0))
    assert sure.fall[0] == pytest.approx(2.0 * deviation[0])


@pytest.mark.parametrize(
    ("films", "damper", "told"),
    [(1.0, 9.0, "films"), (9.0, 1.0, "a constant damper"), (1.0, 1.005, "not told"), (3.0, 9.0, "not told")],
)
def test_the_law_that_explains(films, damper, told) -> None:
    assert OtherLaw(films, damper, 1e-5, 1000).explained_by == told


def test_the_scene_with_what_was_found(tmp_path) -> None:
    pytest.importorskip("tomlkit")
    scene = read_scene(ROTOR)
    words = ["left.clearance", "temperature", "pull.force", "foot_left.stiffness.z", "rotor.damping_ratio"]
    free = read_free(words, scene)
    values = [18e-6, 331.15, 1200.0, 1.5e8, 0.004]
    question = Question(Machine(None, 1), scene, free, ())  # type: ignore[arg-type]
    parts = (np.array([one.coordinate(v) for one, v in zip(free, values, strict=True)]) - question.low) / question.width
    count = len(free)
    fit = Fit(question, parts, np.zeros(9), np.zeros((9, count)), (0.0,), 1)
    found = Identified(fit, Certainty(np.array([5e-7, 0.5, 0.02, 0.01, 0.1]), np.eye(count), (), 1.0))
    again = parse_scene(found.scene_text(scene), "found", "here")
    assert [one.start for one in read_free(words[:-1], again)] == pytest.approx(values[:-1], rel=1e-4)
    assert next(body.damping_ratio for body in again.bodies if body.name == "rotor") == pytest.approx(0.004)
    assert again.tolerances["clearance of left"].size == pytest.approx(1e-6)
    assert again.tolerances["temperature"].size == pytest.approx(1.0)
    assert again.tolerances["load"].size == pytest.approx(0.041, abs=1e-3)
    assert "# Values" not in found.scene_text(scene) and found.scene_text(scene).count("[[bearings]]") == 2

"""Speeds of the inner ring, on the command line and on the axis of a job: what a map holds stays entrainment speed."""

import json
import math

import pytest

from ehdmaps.errors import InputError
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.bearing import BearingGeometry

from .test_job_reader import CONTACT, GOOD, NAMED

NU308 = BearingGeometry.named("NU308")
SPEEDS = 'entrainment_speed = ["0.5 m/s", "1 m/s"]'
POINT = ["solve", "nu308", "--load", "50 N/mm", "--temperature", "40 degC", "--solver", "formula"]


def parse(speeds, text=GOOD):
    assert SPEEDS in text
    return parse_job(text.replace(SPEEDS, speeds), name="job", where="job.toml")


def test_inner_speed_is_the_inverse_of_entrainment_speed():
    assert NU308.entrainment_speed(NU308.inner_speed(1.7)) == pytest.approx(1.7, rel=1e-14)  # round-off


def test_a_point_may_be_given_in_rpm(capsys):
    assert main([*POINT, "--speed", "500 rpm", "--json"]) == 0
    (inner, _) = json.loads(capsys.readouterr().out)
    speed = NU308.entrainment_speed(500 * math.pi / 30)
    assert inner["entrainment_speed"] == pytest.approx(speed, rel=1e-14)  # round-off
    assert main([*POINT, "--speed", "500 rpm"]) == 0
    place = capsys.readouterr().out.splitlines()[1]
    assert place == f"50 N/mm, {speed:.6g} m/s (inner ring 500 rpm, outer ring fixed), 40 degC"


def test_the_table_tells_the_ring_speed_of_an_entrainment_speed(capsys):
    assert main([*POINT, "--speed", "1.7 m/s"]) == 0
    rpm = NU308.inner_speed(1.7) * 30 / math.pi
    assert f"1.7 m/s (inner ring {rpm:.6g} rpm, outer ring fixed)" in capsys.readouterr().out


def test_rpm_are_refused_where_nothing_turns(tmp_path, capsys):
    path = tmp_path / "contact.toml"
    path.write_text(GOOD.replace(NAMED, CONTACT).replace("iso16281", "half_space"))
    arguments = ["solve", str(path), *POINT[2:6]]
    assert main([*arguments, "--speed", "500 rpm"]) == 2
    assert "--speed: got '500 rpm'; allowed: m/s, since the job has a bare contact" in capsys.readouterr().err
    assert main([*arguments, "--speed", "1 m/s"]) == 0
    assert capsys.readouterr().out.splitlines()[1] == "50 N/mm, 1 m/s, 40 degC"


@pytest.mark.parametrize("speed", ["-500 rpm", "200000 rpm"])
def test_rpm_have_limits(speed, capsys):
    assert main([*POINT, f"--speed={speed}"]) == 2
    assert f"--speed: got {speed!r}; allowed: 0 rpm to 121203 rpm" in capsys.readouterr().err


def test_an_axis_may_be_given_in_rpm():
    job = parse('inner_ring_speed = ["500 rpm", "1500 rpm"]')
    expected = [NU308.entrainment_speed(n * math.pi / 30) for n in (500, 1500)]
    assert job.entrainment_speeds == pytest.approx(expected, rel=1e-14)  # quantities are read to 15 digits
    spaced = parse('inner_ring_speed = { from = "100 rpm", to = "1600 rpm", points = 3, spacing = "log" }')
    slow = NU308.entrainment_speed(100 * math.pi / 30)
    assert spaced.entrainment_speeds == pytest.approx((slow, 4 * slow, 16 * slow), rel=1e-12)  # round-off of exp


@pytest.mark.parametrize(
    ("speeds", "text"),
    [
        ('inner_ring_speed = ["1 m/s"]', r"inner_ring_speed\[0\]: got the unit 'm/s'; .* rad/s, such as \"500 rpm\""),
        (SPEEDS + '\ninner_ring_speed = ["500 rpm"]', r"inner_ring_speed: stands beside entrainment_speed; allowed: o"),
        (
            'inner_ring_speed = ["500 rpm", "2e5 rpm"]',
            r"got 200000 rpm; allowed: up to 121203 rpm for this bearing",
        ),
    ],
)
def test_wrong_axes_in_rpm(speeds, text):
    with pytest.raises(InputError, match=text):
        parse(speeds)


def test_an_axis_in_rpm_needs_a_bearing():
    bare = GOOD.replace(NAMED, CONTACT).replace("iso16281", "half_space")
    with pytest.raises(InputError, match=r"inner_ring_speed: got no bearing to turn; allowed: with a \[bearing\]; giv"):
        parse('inner_ring_speed = ["500 rpm"]', bare)

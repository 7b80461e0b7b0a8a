"""Parts of the reports of machines: margins, names of modes, discs to scale, texts of charts that stand apart."""

from __future__ import annotations

import math
import re
from types import SimpleNamespace

import numpy as np
import pytest

from ehdmaps.physics.point.ball_ratings import ball_dynamic_rating
from ehdmaps.report.axis import linear_axis
from ehdmaps.report.chart import WIDE, Chart, Curve, drawing
from mbs import SweepRange, SweepSettings, assemble, critical, modes, parse_scene, statics
from mbs.linearised.critical import CriticalSpeed
from mbs.linearised.mode_names import mode_names, ordinal
from mbs.model.body import Inertia
from mbs.report.campbell import _names
from mbs.report.examination import Examination
from mbs.report.safety import safety_of
from mbs.report.sketch import ring_of, sketch
from mbs.report.solid import dressed
from mbs.report.speeds import asked_margin, critical_table, unbalance_parts
from mbs.unknowns.looks import Band
from tests.cases.reports import Report

ROTOR = """
schema = 1
title = "rotor on two ball bearings"
[operation]
speed = "3000 rpm"
temperature = "40 degC"
[[shafts]]
name = "rotor"
freedoms = ["x", "y", "z", "theta_x", "theta_y", "theta_z"]
sections = [{ length = "300 mm", diameter = "30 mm" }]
discs = [{ from = "130 mm", to = "170 mm", diameter = "120 mm", bore = "30 mm" }]
frames = { a = "20 mm", b = "280 mm" }
[[bearings]]
name = "A"
bearing = "6206"
inner = "rotor:a"
outer = "ground"
diametral_clearance = "5 um"
axial_offset = "20 um"
[[bearings]]
name = "B"
bearing = "6206"
inner = "rotor:b"
outer = "ground"
diametral_clearance = "5 um"
axial_offset = "-20 um"
[[springs]]
name = "brake"
on = "rotor:b"
stiffness = { theta_x = "1 N m/rad" }
"""


@pytest.fixture(scope="module")
def model():
    """The rotor with dry contacts."""
    return assemble(parse_scene(ROTOR, "rotor", "rotor"), "hertz")


def test_modes_are_named_by_where_their_energy_is(model):
    found = modes(model)
    swinging = np.flatnonzero(found.modes.eigenvalues.imag > 0.0)
    names = mode_names(found.balance, found.modes, swinging)
    told = list(names.values())
    assert told[0] == "on brake"  # the rotor turns upon its soft brake
    bending = [name for name in told if "bending" in name]
    # in two planes each, first come first; whirl by gyroscopic terms, or in a plane
    assert all(name.startswith("first bending of rotor") for name in bending[:2])
    assert bending[2].startswith("second bending of rotor")
    assert any(name.startswith("axial of") for name in told) or any("stretching" in name for name in told)
    bare = mode_names(found.balance, found.modes, swinging, whirl=False)
    assert all(names[k].startswith(bare[k]) for k in names)
    assert (ordinal(1), ordinal(10), ordinal(11)) == ("first", "tenth", "11th")


def test_safety_is_that_of_ratings_and_catalogues(model):
    found = Examination(statics(model), "", "", None)
    for one, spec in zip(safety_of(found), model.scene.located, strict=True):
        # 1 % of C by the inner geometry; C follows from load and life, to round-off
        assert one.least == pytest.approx(0.01 * ball_dynamic_rating(spec.geometry), rel=1e-9)
        assert one.static_limit == pytest.approx(4.2e9)
        assert one.hours == pytest.approx(one.revolutions * 1e6 / 60.0 / 3000.0)
        assert math.isnan(one.film)  # dry


def test_the_margin_of_api_617():
    # sharp resonances: 17 % below and 27 % above; amplification 10, and one below 2.5
    assert asked_margin(0.0, above=False) == pytest.approx(0.17)
    assert asked_margin(1e-9, above=True) == pytest.approx(0.27)
    assert asked_margin(0.05, above=True) == pytest.approx(0.10 + 0.17 * (1.0 - 1.0 / 8.5))
    assert asked_margin(0.21, above=True) == 0.0


def test_critical_speeds_stand_beside_operation(model):
    assert model.scene.operating_range == pytest.approx((100.0 * math.pi,) * 2)
    speeds = np.array([900.0, 2900.0, 3000.0, 4500.0]) * math.pi / 30.0
    found = [CriticalSpeed(1.0, s, complex(-1e-3 * s, s), math.nan, 0) for s in speeds.tolist()]
    result = SimpleNamespace(model=model, found=found, sweep=SimpleNamespace(speeds=np.array([0.0, 600.0])))
    report = Report(str(critical_table(result, ["one", "two", "three", ""])))
    for words in ("70 % below", "3.33 % below", "inside", "50 % above", "mode 1"):
        assert words in report.words
    assert "Too near to operation: 2900 rpm (two, order 1); 3000 rpm (three, order 1)." in report.words
    assert "No load that turns is stated: orders are the spins of the bodies." in report.words
    result.sweep.speeds = np.array([0.0, 350.0])  # operation is 314 rad/s, and API 617 may ask for 27 % above
    assert "margin above, up to 3810 rpm, was not: let [sweep] reach it." in str(critical_table(result, [""] * 4))


def test_a_disc_is_drawn_as_it_was_given(model):
    (spec,) = (spec for spec in model.scene.bodies if spec.name == "rotor")
    assert ring_of(spec, spec.discs[0]) == pytest.approx((0.13, 0.17, 0.03, 0.12))
    drawn = Report(str(sketch(model)))
    mass = Inertia.cylinder(0.0, 0.3, 0.03).mass, Inertia.cylinder(0.0, 0.04, 0.12, 0.03).mass
    assert f"{sum(mass):.4g} kg, {mass[1]:.3g} kg of it discs" in drawn.words
    heights = {}
    for path in drawn.named("path"):
        numbers = np.array(re.findall(r"-?\d+\.\d", str(path["d"])), dtype=float).reshape(-1, 2)
        heights.setdefault(path["class"], []).append(np.ptp(numbers[:, 1]))
    # to scale, to a tenth of a pixel: half a shaft of 30 mm, and a ring from 30 to 120 mm
    assert heights["disc"][0] / heights["shaft"][0] == pytest.approx(3.0, abs=0.02)


def test_surfaces_of_shafts_move_with_them(model):
    bones = dressed(model)
    whole = np.zeros(model.system.size)
    whole[model.system.coordinates.index("rotor.a.y")] = whole[model.system.coordinates.index("rotor.b.y")] = 1.0
    moved = bones.transforms @ whole
    used = np.unique(bones.triangles)
    # all of it, as a rigid body; round-off of static shapes
    np.testing.assert_allclose(moved[used], np.tile([0.0, 1.0, 0.0], (used.size, 1)), atol=1e-9)
    radii = np.hypot(bones.points[used, 1], bones.points[used, 2])
    assert sorted({round(float(radius), 6) for radius in radii}) == [0.015, 0.06]


def test_texts_of_curves_stand_apart():
    x = np.linspace(0.0, 10.0, 5)
    curves = [
        Curve("", slope * x, "#000", read=False, note=f"BPFO of bearing {slope}") for slope in (1.0, 1.001, 1.002)
    ]
    chart = Chart(
        "c", "t", "", linear_axis("x", "", x), linear_axis("y", "", np.array([0.0, 8.0])), x, curves, frame=WIDE
    )
    found = re.findall(
        r'<text x="([0-9.]+)" y="([0-9.]+)" text-anchor="end" class="note">(BPFO[^<]*)<', str(drawing(chart))
    )
    assert len(found) == 3
    boxes = [(float(right) - 6.2 * len(words), float(right), float(y)) for right, y, words in found]
    for i, (left, right, y) in enumerate(boxes):
        assert left > 0.0
        assert all(right < a or left > b or abs(y - row) > 11.0 for a, b, row in boxes[:i])


def test_a_text_of_a_curve_is_not_crossed_by_another():
    """A flat curve lies where the text of a rising one would stand first; its box is 12 px high, of 6.2 px a letter."""
    x = np.linspace(0.0, 10.0, 5)
    curves = [Curve("", x, "#000", read=False, note="BPFO A"), Curve("", np.full(5, 10.3), "#00f", read=False)]
    axes = linear_axis("x", "", x), linear_axis("y", "", np.array([0.0, 12.0]))
    chart = Chart("c", "t", "", *axes, x, curves, frame=WIDE)
    (found,) = re.findall(r'<text x="([0-9.]+)" y="([0-9.]+)" text-anchor="end" class="note">', str(drawing(chart)))
    flat = float(WIDE.along(axes[1], np.array([10.3]))[0])
    assert not float(found[1]) - 12.0 < flat < float(found[1]) + 3.0


def test_names_of_one_order_share_their_word():
    assert _names(["BPFO A", "BPFO B", "mesh"]) == "BPFO A, B; mesh"


@pytest.mark.slow
def test_the_largest_responses_stand_with_their_bands():
    """Each about the value of its row, as far as it was made to reach; without bands no such column."""
    text = ROTOR + '[[unbalances]]\nname = "u"\non = "rotor:a"\nmoment = "30 g mm"\n[[sensors]]\nname = "s"\n'
    text += 'on = "rotor:b"\ndirection = "y"\nquantity = "displacement"\n'
    found = critical(assemble(parse_scene(text, "rotor", "rotor"), "hertz"), SweepSettings(SweepRange(200.0, 400.0, 2)))
    values = found._row(found.responses)
    reach = np.linspace(0.1, 0.2, values.size) * values
    band = Band(values, reach, (), np.zeros(values.size, dtype=np.int64), signed=np.ones(values.size, dtype=np.bool_))
    found.__dict__["bands"] = SimpleNamespace(responses=band)
    cells = [text for tag, text in Report(str(unbalance_parts(found, banded=True))).texts if tag in ("td", "th")]
    first = next(k for k, words in enumerate(cells) if words == "sensor s")
    columns = cells.index("sensor s") - next(k for k, words in enumerate(cells) if words.startswith("at "))
    rows = [cells[k : k + columns + 1] for k in range(first, len(cells), columns + 1)]
    assert len(rows) == 3  # the sensor, both bearings
    for _, _, largest, words in rows:
        value, (low, high) = float(largest.split()[0]), map(float, words.split(" to "))
        part = (value - low) / value
        assert high - value == pytest.approx(value - low, abs=0.02 * value) and 0.08 < part < 0.22  # three digits
    assert "not known" not in str(unbalance_parts(found))

"""Deviations of bearings from their form: tables in C, what they do to contacts, the energy that they bring in."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from mbs import assemble, parse_scene
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.deviating.tables import Deviations, Spall, Wave, deviation_data, spectrum
from mbs.bearings.laws import hertz
from mbs.linearised.excitation import excited
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.settings import Settings
from mbs.transient.run import run
from tests.conformance.machines import ANGULAR, NU, TABLE, Machine, alike, preloaded

Z = 10
EVEN = BearingGeometry(
    name="even",
    inner_raceway_diameter=52.8e-3,
    outer_raceway_diameter=79.2e-3,
    roller_diameter=13.2e-3,
    roller_length=14e-3,
    rollers=Z,
    diametral_clearance=-10e-6,
)
"""Gamma is 0.2, so that the cage makes 2 and the rollers 12 turns in 5 of the shaft, and spectra have no leakage."""


def data(*waves, spalls=(), sizes=(), outer=0.0):
    """Tables of a bearing whose inner ring turns once with the system."""
    places = 2.0 * math.pi * np.arange(Z) / Z
    given = Deviations(waves, spalls, sizes)
    return deviation_data(given, EVEN, (1.0, outer), 0.3, places), places


def test_tables_are_the_waves_at_any_angle():
    """Approach and rate against cosines of each part's own angle: cubics through values and slopes leave h^4/384
    of a wave, h 2 pi/32 or less, and h^3 sqrt(3)/216 of its slope."""
    waves = Wave("inner", 7, 2e-7, 0.4), Wave("outer", 60, 1e-7, -1.0), Wave("elements", 3, 5e-8, 0.2, element=4)
    made, places = data(*waves, sizes=(0.0, 4e-7), outer=-0.5)
    speed, turns = 120.0, (0.5 * (1.0 - 0.2) - 0.25 * (1.0 + 0.2), 1.0, -0.5, 0.75 * (5.0 - 0.2))
    for angle in (0.0, 1.7, -400.3):
        cage = 0.3 + places + turns[0] * angle
        wanted = np.zeros((Z, 2, 2))
        for side, (waves_of, n, phase) in enumerate(((2e-7, 7, 0.4), (1e-7, 60, -1.0))):
            turn = n * (cage - turns[1 + side] * angle) + phase
            wanted[:, side, 0] = waves_of * np.cos(turn)
            wanted[:, side, 1] = -waves_of * n * (turns[0] - turns[1 + side]) * speed * np.sin(turn)
            own = 3.0 * (turns[3] * angle + (math.pi if side == 0 else 0.0)) + 0.2
            wanted[3, side] += 5e-8 * np.cos(own), -5e-8 * 3.0 * turns[3] * speed * np.sin(own)
            wanted[1, side, 0] += 2e-7
        found = made.at(angle, speed)
        np.testing.assert_allclose(found[..., 0], wanted[..., 0], atol=4e-6 * 1e-7)
        steepest = 1e-7 * 60.0 * abs(turns[0] - turns[2]) * speed
        np.testing.assert_allclose(found[..., 1], wanted[..., 1], rtol=0.0, atol=6.1e-5 * steepest)


def test_a_spall_is_as_long_as_its_arc_and_no_deeper_than_rollers_reach():
    length = 2e-3
    made, _ = data(spalls=(Spall("outer", 1.0, length, 1e-3),))
    steps = 16000
    path = np.array([made.at(angle, 0.0)[0, 1, 0] for angle in np.arange(steps) * 2.0 * math.pi * 2.5 / steps])
    # a roller that stands on both edges is length^2/(8 R) below them
    assert -path.min() == pytest.approx(length**2 / (8.0 * 6.6e-3), rel=1e-3)  # samples
    inside = np.count_nonzero(path) / steps * math.pi * 79.2e-3
    assert inside == pytest.approx(length, rel=0.02)  # ends are flat, and below round-off


def test_a_spectrum_is_the_same_by_its_seed():
    one, same, other = (spectrum("outer", (2, 9), 1e-6, 1.0, seed, [None]) for seed in (1, 1, 2))
    assert one == same != other
    assert [wave.amplitude * wave.waves for wave in one] == pytest.approx([2e-6] * 8)


BEARING = Bearing(EVEN, slices=3)
FORCE = BearingForce(BEARING, hertz(BEARING))


def lines(*deviating, samples=640):
    """Force of a centred, preloaded bearing over five turns, y + i z by signed order in fifths [N]."""
    element = BearingElement("own", "a", "b", BEARING, FORCE, 330.0, deviations=Deviations(*deviating))
    angles, still = 10.0 * math.pi * np.arange(samples) / samples, np.zeros(6)
    found = np.array([element.advance(None, still, still, Operation(1.0, angle))[0].force for angle in angles])
    return np.fft.fft(found[:, 1] + 1j * found[:, 2]) / samples


SMALL = 1e-12
"""Amplitude [m]: what waves do is linear to 1e-6, their part of the overlap."""


@pytest.mark.parametrize("part", ["inner", "outer"])
@pytest.mark.parametrize("waves", [2, Z - 2, Z - 1, Z, Z + 1, 2 * Z - 1, 2 * Z, 2 * Z + 1])
def test_a_centred_ring_is_moved_by_waves_beside_multiples_of_the_rollers_alone(part, waves):
    """n = k Z +- 1, at k BPFI +- 1 or k BPFO, forward or backward; all else is below -80 dB, where round-off is."""
    found, reference = np.abs(lines((Wave(part, waves, SMALL),))), SMALL * FORCE(np.zeros(6))[1][1, 1]
    k = round(waves / Z)
    side = waves - k * Z
    if abs(side) == 1:
        place = round(5.0 * (6.0 * k * side + 1.0 if part == "inner" else -4.0 * k * side)) % found.size
        assert found[place] == pytest.approx(reference, rel=1e-4)
        found[place] = 0.0
    assert found.max() < 1e-4 * reference


def held(keys, moved, orders):
    """Largest line of the force of a preloaded NU308 with films at orders, forward or backward, at a held place [N]."""
    tight = NU.replace('"10 um"', '"-10 um"') + '\nprofile = "straight"'
    text = Machine("one", alike(tight), axial=False).text((0.0, 0.0, 0.0))
    model = assemble(
        parse_scene(text.replace('name = "left_0"\n', f'name = "left_0"\n{keys}\n'), "one", "one"), "table"
    )
    element = next(entry.element for entry in model.system.elements if entry.element.name == "left_0")
    turns, samples = 120, 120 * 32
    angles, pose = 2.0 * math.pi * turns * np.arange(samples) / samples, np.array([0.0, 0.0, moved, 0.0, 0.0, 0.0])
    found = np.array([element.advance(None, pose, np.zeros(6), Operation(100.0, at))[0].force for at in angles])
    window = np.blackman(samples) ** 2
    seen = (found[:, 1] + 1j * found[:, 2] - np.mean(found[:, 1] + 1j * found[:, 2])) * window / np.sum(window)
    return max(abs(np.sum(seen * np.exp(1j * sign * order * angles))) for order in orders for sign in (1.0, -1.0))


def test_a_loaded_bearing_feels_other_waves_and_the_passing_of_its_rollers():
    """15 um off the middle Z waves of 0.1 um are at BPFI, and the perfect bearing makes BPFO: -10 and -7 dB beside
    Z + 1 waves of the centred one, by a prototype of its own with another temperature of the oil: to 1.5 dB."""
    geometry = BearingGeometry.named("NU308")
    pitch = 0.5 * (geometry.inner_raceway_diameter + geometry.outer_raceway_diameter)
    outer_pass = 0.5 * geometry.rollers * (1.0 - geometry.roller_diameter / pitch)
    inner_pass = geometry.rollers - outer_pass
    wave = 'waviness = [{{ on = "inner", waves = {}, amplitude = "0.1 um" }}]'
    reference = held(wave.format(geometry.rollers + 1), 0.0, [inner_pass + 1.0])
    loaded = held(wave.format(geometry.rollers), -15e-6, [inner_pass])
    passing = held("waviness = []", -15e-6, [outer_pass])
    assert 20.0 * math.log10(loaded / reference) == pytest.approx(-10.0, abs=1.5)
    assert 20.0 * math.log10(passing / reference) == pytest.approx(-7.0, abs=1.5)
    assert held(wave.format(geometry.rollers), 0.0, [inner_pass]) < 1e-4 * reference


def test_other_rollers_are_at_the_cage_and_at_twice_their_own_speed():
    """FTF 0.4; two waves of one roller at 2 x 2.4 -+ 0.4, three waves at nothing: the contacts cancel."""
    larger = np.abs(lines((), (), (SMALL,)))
    assert np.argmax(larger) == 2 and np.sort(larger)[-2] < 1e-4 * larger.max()
    two, three = (np.abs(lines((Wave("elements", n, SMALL, element=1),))) for n in (2, 3))
    # e^(+-4.8 i) e^(0.4 i): orders 5.2 and -4.4
    assert sorted(np.argsort(two)[-2:]) == [26, two.size - 22] and np.sort(two)[-3] < 1e-4 * two.max()
    assert three.max() < 1e-4 * two.max()


SMALL_WAVES = """
waviness = [{ on = "inner", waves = 13, amplitude = "0.01 um" }, { on = "inner", waves = 12, amplitude = "0.05 um" }, \
{ on = "outer", waves = 11, amplitude = "0.01 um" }]
size_difference = ["0.02 um"]
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("bearings", "law"),
    [(alike(NU.replace('"10 um"', '"-10 um"')), "table"), (preloaded(ANGULAR), "hertz:1e-4 s")],
    ids=["cylindrical", "angular contact"],
)
def test_small_deviations_do_in_time_what_linear_analyses_say(bearings, law):
    """Lines of the difference of two runs, by least squares at their orders: within 1 % of the largest of each bearing.

    The parts that the passing of elements modulates are of second order, and left out.
    """
    machine = Machine("one", bearings, axial=len(bearings[0][1]) < 60)
    perfect = machine.text((0.0, -100.0, 20.0))
    wavy = perfect.replace('name = "left_0"\n', f'name = "left_0"\n{SMALL_WAVES}')
    models = [assemble(parse_scene(text, "one", "one"), law) for text in (perfect, wavy)]
    speed, (sensor,) = 157.0, models[0].scene.sensors
    start = equilibrium(models[0].system, Operation(speed)).displacement
    runs = [
        run(
            one.system,
            SpeedProfile.constant(speed),
            0.8,
            Settings(step=2e-5, sample=1e-4),
            sensors=[sensor],
            displacement=start,
        )
        for one in models
    ]
    found = excited(lambda _: models[1].system, [speed], [sensor], 4)
    orders = sorted({line.order for line in found.lines})
    late = runs[0].time > 0.4  # what the beginning has set in motion is gone
    angle, moved = runs[0].angle[late], (runs[1].signals - runs[0].signals)[late, 0]
    parts = np.concatenate([[np.cos(order * angle), -np.sin(order * angle)] for order in orders]).T
    fitted = np.linalg.lstsq(parts, moved)[0].reshape(-1, 2) @ np.array([1.0, 1j])
    wanted = np.zeros(len(orders), dtype=np.complex128)
    for line, seen in zip(found.lines, found.seen[0, :, 0], strict=True):
        wanted[orders.index(line.order)] += seen if line.source != "passing" else 0.0
    assert np.count_nonzero(np.abs(wanted) > 0.01 * np.abs(wanted).max()) >= 2
    np.testing.assert_allclose(fitted, wanted, atol=0.01 * np.abs(wanted).max())


def test_what_a_scene_says_wrongly_is_said():
    waves = (
        '{ on = "inner", waves = 0, amplitude = "1 um" }, { on = "outer", waves = 2, amplitude = "1 um", element = 1 }'
    )
    keys = f"waviness = [{waves}]\nsize_difference = {['1 um'] * 13}"
    text = Machine("one", (("middle", f"{NU}\n{keys}"), ("left", f"{TABLE}\nspall = []")), axial=False).text()
    with pytest.raises(InputError) as error:
        parse_scene(text, "one", "one")
    said = " ".join(error.value.problems)
    assert "waves: got 0; allowed: a whole number from 1 to 1000, or a list of the first and the last one" in said
    assert 'element: got 1 beside on = "outer"; allowed: with on = "elements"' in said
    assert "allowed: a list of at most 12 lengths, one an element" in said
    assert "spall: has no effect on a bearing by matrices; allowed: bearings with rolling elements" in said

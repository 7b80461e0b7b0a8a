"""Bearings with coupled slices: against the method in Python, derivatives, energy, refusals."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest

import mbs
from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.solids.slices import without_ends
from mbs import cli
from mbs.bearings import laws
from mbs.bearings.bearing import MOST_COUPLED, Bearing
from mbs.bearings.bearing_block import BEARINGS
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.scene.assembly import assemble
from mbs.scene.reader import parse_scene
from tests.finite_length.slice_loads import coupled_loads

SCENE = Path(mbs.__file__).parent / "systems" / "nu308_rigid.toml"

PLAIN = Bearing.named("NU308", clearance=20e-6, slices=21)
COUPLED = dataclasses.replace(PLAIN, coupled=True)
POSE = np.array([0.0, 25e-6, 5e-6, 0.0, 4e-4, 2e-4])
FILMS = {"entrainment_speed": 1.7, "temperature": 313.15}
DRY = laws.hertz(PLAIN, damping_time=1e-5)


@pytest.fixture(scope="module")
def film() -> BearingForce:
    """A coupled bearing with films."""
    ranges = {"load": (1e3, 2e6), "entrainment_speed": (1.5, 2.0), "temperature": (313.0, 314.0)}
    return BearingForce(COUPLED, laws.formula(PLAIN, Lubricant.named("FVA3"), **ranges, outside="clamp"))


def test_rollers_bear_what_the_method_in_python_finds():
    """Two methods of Newton for the same equations: their tolerances, 1e-9."""
    force = BearingForce(COUPLED, DRY)
    alone, found = BearingForce(PLAIN, DRY).rollers(POSE), force.rollers(POSE)
    length = PLAIN.geometry.roller_length

    def law(approach: FloatArray) -> tuple[FloatArray, FloatArray]:
        load, slope, _ = DRY.evaluate(approach, np.zeros_like(approach))
        return load / length, slope / length

    for j in range(PLAIN.geometry.rollers):
        load, _ = coupled_loads(alone.approach[j], law, without_ends(COUPLED.coupling))
        np.testing.assert_allclose(found.load_per_length[j], load, rtol=1e-8, atol=1e-6)
    assert found.load_per_length.max() > 1e5
    # a tilted roller bears more where its neighbours bear less: the coupling matters
    assert np.abs(found.load_per_length - alone.load_per_length).max() > 0.05 * alone.load_per_length.max()
    total = force(POSE)[0]
    c, s = np.cos(found.angle), np.sin(found.angle)
    expected = [-found.load @ c, -found.load @ s, found.moment @ s, -found.moment @ c]
    np.testing.assert_allclose(total[[1, 2, 4, 5]], expected, rtol=1e-10)


@pytest.mark.parametrize("dry", [True, False])
def test_stiffness_and_damping_are_the_derivatives_of_the_force(dry, film):
    """Central differences at rest: 1e-5 of the largest of a row, their own error."""
    force, at = (BearingForce(COUPLED, DRY), {}) if dry else (film, FILMS)
    _, stiffness, damping = force(POSE, **at)
    for matrix in (stiffness, damping):
        np.testing.assert_allclose(matrix, matrix.T, rtol=1e-9, atol=1e-12 * matrix.max())
    for i in (1, 2, 4, 5):
        step = np.zeros(6)
        step[i] = 1e-9
        slope = (force(POSE - step, **at)[0] - force(POSE + step, **at)[0]) / 2e-9
        np.testing.assert_allclose(slope, stiffness[i], atol=1e-5 * np.abs(stiffness[i]).max())
        slope = (force(POSE, -1e4 * step, **at)[0] - force(POSE, 1e4 * step, **at)[0]) / 2e-5
        np.testing.assert_allclose(slope, damping[i], atol=1e-5 * np.abs(damping[i]).max())


def test_the_work_of_a_path_is_the_stored_energy_and_dampers_take_up(film):
    """Gauss' rule over a path with contacts that open: 1e-4 of the energy; power of any motion from round-off on."""
    element = BearingElement("bearing", "inner", "outer", COUPLED, BearingForce(COUPLED, DRY), 313.15)
    operation, first = Operation(0.0), np.array([0.0, 5e-6, 0.0, 0.0, 0.0, 0.0])
    places, weights = np.polynomial.legendre.leggauss(12)
    work = 0.0
    for cell in range(8):
        for place, weight in zip(places, weights, strict=True):
            pose = first + (POSE - first) * (cell + 0.5 * (1.0 + place)) / 8.0
            work -= weight / 16.0 * float(element.evaluate(pose, np.zeros(6), operation).force @ (POSE - first))
    stored = [element.stored(None, pose, operation) for pose in (first, POSE)]
    assert None not in stored
    assert stored[1] - stored[0] == pytest.approx(work, rel=1e-4)
    random = np.random.default_rng(1)
    rest = film(POSE, **FILMS)[0]
    for _ in range(20):
        velocity = np.array([0.0, 0.1, 0.1, 0.0, 1.0, 1.0]) * random.standard_normal(6)
        moving = film(POSE, velocity, **FILMS)[0]
        assert (moving - rest) @ velocity <= 1e-9


def test_slices_at_low_speed_call_the_law_itself(film):
    """Below the lowest speed of the law no table holds it; the force is continuous from there: 1 %."""
    here, above = (film(POSE, entrainment_speed=u, temperature=313.15)[0] for u in (1.45, 1.55))
    assert np.abs(here - above).max() < 0.01 * np.abs(above).max()


def test_what_cannot_be_coupled_is_refused(film):
    """Every message."""
    with pytest.raises(
        InputError, match=rf"bearing, slices: got 200 that are coupled; allowed: at most {MOST_COUPLED}"
    ):
        dataclasses.replace(COUPLED, slices=200)
    with pytest.raises(InputError, match=r"bearing 'b', films: got coupled slices with films that have a memory"):
        BearingElement("b", "inner", "outer", COUPLED, film, 313.15, films="memory")
    with pytest.raises(InputError, match=r"bearing force, advance: got coupled slices with films that have a memory"):
        film.advance(None, POSE, 1e-5, **FILMS)
    far = np.array([0.0, 5e-3, 0.0, 0.0, 0.0, 0.0])
    narrow = dataclasses.replace(COUPLED, slices=MOST_COUPLED)
    with pytest.raises(AnalysisError, match=r"bearing force, coupled slices: no loads of a roller at the pose"):
        BearingForce(narrow, DRY)(far)


def test_a_scene_couples_slices_of_slow_films():
    """The key of [[bearings]], what goes with it, and the run of a scene: its element has no compiled block."""
    text = re.sub(r"slices = 41.*", "slices = 11", SCENE.read_text("utf-8"))
    changed = text.replace("slices = 11", "slices = 11\nslices_coupled = true")
    scene, plain = (parse_scene(given, "scene", "scene.toml") for given in (changed, text))
    assert [entry.slices_coupled for entry in (*scene.bearings, *plain.bearings)] == [True, True, False, False]
    models = [assemble(given, "hertz") for given in (scene, plain)]
    found = [equilibrium(model.system, Operation(50.0)).element_stiffness[0][1, 1] for model in models]
    # 141 N between both rings: the short contacts of a light load are stiffer
    assert 1.05 < found[0] / found[1] < 1.3
    assert [BEARINGS.takes(model.bearings[0]) for model in models] == [False, True]
    for change, words in (
        ("slices_coupled = 1", "slices_coupled: got 1; allowed: true, false"),
        ("slices_coupled = true\nrollers = 'bodies'", "slices_coupled: got true with rollers = 'bodies'"),
    ):
        with pytest.raises(InputError, match=re.escape(words)):
            parse_scene(text.replace("slices = 11", f"slices = 11\n{change}", 1), "scene", "scene.toml")
    with pytest.raises(InputError, match=r"slices: got 300 with slices_coupled; allowed: at most 100"):
        parse_scene(changed.replace("slices = 11", "slices = 300"), "scene", "scene.toml")
    with pytest.raises(InputError, match=r"--films: got coupled slices with films .*; so has bearing_left"):
        assemble(scene, "formula", films="memory")


@pytest.mark.slow
def test_one_bearing_prints_what_is_along_its_roller(capsys):
    """The command `mbs bearing --coupled`; more slices than can be coupled are refused."""
    arguments = ["bearing", "NU308", "--load", "5 kN", "--speed", "0 rpm", "--profile", "straight", "--slices", "11"]
    assert cli.main([*arguments, "--coupled"]) == 0
    text = capsys.readouterr().out
    assert "11 coupled slices" in text and "along the most loaded roller" in text
    loads = [float(part) for part in next(line for line in text.splitlines() if "N/mm  " in line).split()[4:]]
    assert loads == pytest.approx(loads[::-1]) and loads[0] > 1.02 * loads[5]
    assert cli.main([*arguments[:-1], "200", "--coupled"]) == 2
    assert "--slices" in capsys.readouterr().err

"""`--auto` and `mbs plan` of machines without maps, on balls: verdicts beside analyses with each choice."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solids import STEEL
from mbs import assemble, parse_scene, read_scene
from mbs.bearings.locating.normal_law import contact, load_approach
from mbs.bearings.tapered.line_film import cylinder_of
from mbs.budget.linear_look import LinearReference, linear_look
from mbs.model.equilibrium import equilibrium
from mbs.planning.auto import AutoSettings, settled
from mbs.planning.criteria import closed_contact, memory_change
from mbs.planning.of_table import change_of_matrix
from mbs.planning.plan import plan
from mbs.planning.question import at_one_speed
from mbs.planning.verdicts import heat_verdict, visited
from mbs.scene.choices import Subject, named_law
from tests.cases import commands
from tests.unit.test_tapered_scenes import O_PAIR, WEIGHT, text


@pytest.fixture(scope="module")
def drive():
    """The shipped rotor at its operating speed, with warm oil."""
    return dataclasses.replace(at_one_speed(read_scene("electric_drive")), temperature=373.15)


@pytest.fixture(scope="module")
def chosen(drive):
    """The subject that is chosen for it."""
    return settled(drive, lambda subject: subject)


def verdicts(found):
    """Verdicts by what they are on."""
    return {verdict.physics: verdict for verdict in found.verdicts}


def test_contacts_of_verdicts_are_those_of_the_law(drive):
    (seen,) = plan(drive).seen
    loads, element = np.array([5.0, 50.0, 500.0]), assemble(drive, "table").balls[0]
    speed = element.entrainment_rate * drive.speed
    law = element.law_at(drive.speed)
    for state, side in zip(seen.states(drive.lubricant, loads, speed), (law.inner, law.outer), strict=True):
        at = [contact(side, load_approach(side, load)) for load in loads.tolist()]
        # the law's table of 400 nodes between the same values: its straight and cubic pieces
        np.testing.assert_allclose(state.stiffness, [k for _, k, _ in at], rtol=2e-3)
        np.testing.assert_allclose(state.damping, [c for _, _, c in at], rtol=5e-3)


def test_what_is_called_negligible_changes_less_than_is_said(drive, chosen):
    found = verdicts(chosen)
    assert found["films"].on and not found["film memory"].on
    assert 0.0 < found["film memory"].size < 0.05
    law = named_law("table", drive)
    slow, memory = (
        linear_look(Subject(drive, dataclasses.replace(law, films=films)).model()) for films in ("slow", "memory")
    )
    dry = linear_look(Subject(drive, named_law("hertz", drive)).model())
    left_out = LinearReference.of(memory, max(drive.frequencies)).beside(slow)
    assert 0.0 < np.max(np.abs(left_out.damping)) < found["film memory"].size
    films = LinearReference.of(slow, max(drive.frequencies)).beside(dry)
    # a frequency moves by half of what stiffness does
    assert 0.0 < np.max(np.abs((1.0 + films.frequency) ** 2 - 1.0)) < found["films"].errors[0]
    assert chosen.subject.law.name == "table" and chosen.subject.law.films == "slow"


def test_a_tolerance_that_admits_no_damping_takes_dry_contacts(drive):
    found = settled(drive, lambda subject: subject, AutoSettings(tolerance=9.0))
    assert not verdicts(found)["films"].on and found.subject.law.name == "hertz"
    assert "dry" in verdicts(found)["film memory"].words


def test_films_that_the_table_has_not_are_left_out_and_said(drive):
    cold = dataclasses.replace(drive, temperature=273.15)
    found = settled(cold, lambda subject: subject)
    verdict = verdicts(found)["films"]
    assert not verdict.on and verdict.warns and "the film table has none at 6000 rpm" in verdict.words
    assert found.subject.law.name == "hertz"
    with pytest.raises(AnalysisError, match="auto, --films: got slow; the film table has none"):
        settled(cold, lambda subject: subject, AutoSettings(films="slow"))


def test_what_is_not_known_of_points_is_not_judged(drive, chosen):
    for name in ("oil supply", "limiting shear stress"):
        assert "not judged of points" in verdicts(chosen)[name].words
    with pytest.raises(InputError, match="--physics: got thermal for bearings whose films are read"):
        settled(drive, lambda subject: subject, AutoSettings(physics="thermal"))
    with pytest.raises(InputError, match="films of ball bearings are flooded"):
        settled(drive, lambda subject: subject, AutoSettings(supply=OilSupply(1e-6)))
    hot = dataclasses.replace(drive, lubricant=Lubricant.named("FVA3"), temperature=313.15)
    heat = verdicts(settled(hot, lambda subject: subject))["inlet heating"]
    assert heat.warns and "films of points would be thinner by up to" in heat.words


def test_memory_of_a_point_grows_with_frequency(drive):
    (seen,) = plan(drive).seen
    state = seen.states(drive.lubricant, np.array([100.0]), 9.0)[0]
    sizes = [float(memory_change(state, frequency)[0]) for frequency in (10.0, 100.0, 1e3, 1e4)]
    assert np.all(np.diff(sizes) > 0.0) and sizes[0] < 1e-3


def test_a_change_along_any_motion_is_seen():
    own = np.diag([1.0, 100.0, 100.0, 0.0, 1.0, 1.0])
    other = own.copy()
    other[0, 0] = 1.3
    assert change_of_matrix(other, own, 1.0) == pytest.approx(0.3)
    # a motion that nothing holds has no change
    own[0, 0] = 0.0
    assert change_of_matrix(other, own, 1.0) == pytest.approx(0.0, abs=1e-12)


def test_plan_tells_what_is_seen_and_writes_no_job(capsys, tmp_path):
    status, out, _ = commands.run(capsys, "plan", "electric_drive")
    assert status == 0 and "largest load of a ball at rest" in out
    assert "in the film table of points, which answers: no map" in out and "nothing to write" in out
    fastest = read_scene("electric_drive").sweep.end
    element = assemble(read_scene("electric_drive"), "hertz").balls[0]
    assert f"{element.entrainment_rate * fastest:.4g} m/s" in out
    status, _, err = commands.run(capsys, "plan", "electric_drive", "-o", str(tmp_path / "job.toml"))
    assert status == 2 and "there is no map to make" in " ".join(err.split())
    assert not list(tmp_path.iterdir())


def test_rollers_are_planned_and_balls_beside_them_told():
    given = read_scene("nu2210_shaft")
    head, _, right = given.text.rpartition("geometry = { estimate")
    mixed = head + 'bearing = "6210"\n\n[[inputs' + right.partition("[[inputs")[2]
    found = plan(at_one_speed(parse_scene(mixed, "mixed", "mixed.toml")))
    (rollers,), (balls,) = found.needed, found.seen
    assert (rollers.bearings, balls.bearings) == (("left",), ("right",))
    balance = equilibrium(found.model.system, found.model.operation)
    radial = np.linalg.norm(balance.forces[found.model.ring_places[1]][1:3])
    # Stribeck's factor without clearance, 4.37; unbalance, and the angle at which a ball is just below the load, add
    assert 4.2 < balls.static_load * balls.geometry.balls / radial < 5.0
    assert [job.bearing.name for job in found.jobs()] == ["NU2210"]


def test_lines_of_tapered_rollers_have_heat_and_shear_left_out_of_the_table():
    scene = dataclasses.replace(
        parse_scene(text(**O_PAIR, more=WEIGHT), "rotor", "rotor.toml"), lubricant=Lubricant.named("FVA3")
    )
    (seen,) = plan(scene).seen
    there = visited(seen, scene.lubricant, 1e-6)
    assert there.of_lines and not there.has_map and seen.display.unit == "N/mm"
    # the same closed contacts as of a cylindrical roller bearing with these lines
    line = cylinder_of(seen.geometry).contacts(STEEL, "iso16281")[0]
    same = closed_contact(line, scene.lubricant, there.states[0].load, there.states[0].speed, seen.temperature)
    np.testing.assert_array_equal(there.states[0].stiffness, same.stiffness)
    heat = heat_verdict(there)
    assert heat.on and heat.solver  # of_table leaves it out, as no map has it

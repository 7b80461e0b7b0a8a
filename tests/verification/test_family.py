"""Maps read from lines that several bearings share, against solves of their own points."""

import os

import numpy as np
import pytest

import ehdmaps
from ehdmaps.errors import MapError
from ehdmaps.jobs import batch_generate, family_maps
from ehdmaps.jobs.batch import parse_batch
from ehdmaps.jobs.batch_generate import generate_batch
from ehdmaps.jobs.batch_plan import plan_batch
from ehdmaps.jobs.describe import describe
from ehdmaps.jobs.family import own_part
from ehdmaps.jobs.family_maps import Solved
from ehdmaps.jobs.law_points import COMPLIANCE_BARS, DAMPING_BARS
from ehdmaps.jobs.refinement import line_field
from ehdmaps.jobs.store import Store
from ehdmaps.jobs.sweep import SweepResult, sweep
from ehdmaps.jobs.tasks import LineTask, line_tasks
from ehdmaps.maps import schema
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.solution import Status
from tests.cases.batches import batch_text

LISTS = 'bearings = ["NU308", "N1014"]\nestimates = ["NU206"]\noils = ["FVA3"]\nchecked = 1'
BATCH = parse_batch(batch_text(LISTS, "reynolds", "law_check = 20\n"), "cat", "cat.toml")
READ = {"film_offset": 1e-3, "central_film": 1e-3, "minimum_film": 1e-3, "rolling_force": 5e-3, "mass_flow": 1e-3}
"""What reading between lines may miss: steps of 0.45 in ln M at heavy loads, where the pressures turn to Hertz'."""

THREE = len(BATCH.members)


@pytest.fixture(scope="module")
def store_file(tmp_path_factory):
    """A store with the lines of the family, solved once for all tests."""
    path = tmp_path_factory.mktemp("family") / "cat.batch.store"
    with Store(path) as store:
        sweep(tuple(plan_batch(BATCH).tasks()), store, workers=1)
    return path


@pytest.fixture(scope="module")
def solved(store_file):
    (shared,) = plan_batch(BATCH).shared
    with Store(store_file) as store:
        return Solved(shared.family, {task.key: store.get(task.key) for task in shared.family.tasks}, {})


@pytest.mark.parametrize("member", range(THREE))
def test_points_that_are_read_are_those_that_are_solved(solved, member):
    job, solver = solved.family.jobs[member], solved.family.solver
    loads = np.array(job.loads)
    within_error = []
    for task in line_tasks(job, solver):
        contact, speed = task.contact, task.entrainment_speed
        found, known = solved.films.read(task)
        fresh = task.run()
        assert known.all()
        np.testing.assert_array_equal(found["status"], fresh["status"])
        k = 1.0 / (contact.structural_compliance(loads) + fresh["film_compliance"])
        wrong = np.abs(found["film_compliance"] - fresh["film_compliance"])
        # the bars of contact laws: what reading between lines may miss
        assert np.all((wrong <= COMPLIANCE_BARS[0] * fresh["film_compliance"]) | (wrong * k <= COMPLIANCE_BARS[1]))
        width = half_width(loads, contact.radius, contact.reduced_modulus)
        wrong = np.abs(found["loss_compliance"] - fresh["loss_compliance"]) * k**2
        small = DAMPING_BARS[1] * k * width / speed
        assert np.all((wrong <= DAMPING_BARS[0] * fresh["loss_compliance"] * k**2) | (wrong <= small))
        for name, part in READ.items():
            np.testing.assert_allclose(found[name], fresh[name], rtol=part, err_msg=name)
            error = np.abs(found[f"{name}_error"]) + np.abs(fresh[f"{name}_error"])
            within_error += (np.abs(found[name] / fresh[name] - 1.0) <= error).tolist()
    assert np.mean(within_error) > 0.95  # estimates, no bounds


def test_the_part_of_a_member_reads_as_the_whole(solved):
    films = solved.films
    for job in solved.family.jobs:
        group = own_part(films.group, films.reference, job)
        speeds, temperatures = np.array(job.entrainment_speeds), np.array(job.temperatures)
        loads = np.array(job.loads)[:, None, None] * np.ones((speeds.size, temperatures.size))
        at = loads, speeds, temperatures
        for contact in job.contacts:
            whole, part = (line_field(job, lines, contact).films(contact.name, *at) for lines in (films.group, group))
            # the same lines and weights: round-off of logarithms
            np.testing.assert_allclose(part, whole, rtol=1e-12)


def test_a_point_beyond_the_lines_or_without_speed_is_solved(solved):
    job, solver = solved.family.jobs[0], solved.family.solver
    contact = job.contacts[0]
    heavy = LineTask(contact, job.lubricant, (100.0 * job.loads[-1],), job.entrainment_speeds[0], 313.15, solver)
    assert not solved.films.read(heavy)[1].any()
    light = LineTask(contact, job.lubricant, (1.0,), 200.0, 313.15, solver)  # thicker than the solver takes
    assert not solved.films.read(light)[1].any()
    rest = LineTask(contact, job.lubricant, job.loads, 0.0, 313.15, solver)
    found, known = solved.films.read(rest)
    assert not known.any()
    made = family_maps._with_solved(rest, found, known)
    assert set(made["status"]) == {int(Status.ASYMPTOTE)}
    np.testing.assert_array_equal(made["film_offset"], rest.run()["film_offset"])


def test_maps_of_a_family_make_laws_and_say_what_they_are(store_file, tmp_path, monkeypatch):
    folder = tmp_path / "maps"
    folder.mkdir()
    os.link(store_file, folder / "cat.batch.store")
    result = generate_batch(BATCH, folder, workers=1)
    assert [(outcome.state, outcome.films, outcome.lost) for outcome in result.outcomes] == [("made", "shared", 0)] * 3
    assert result.sweep.solved == 0
    checked = 0
    for outcome in result.outcomes:
        emap = ehdmaps.open_map(outcome.output)
        assert emap.film_field().contacts == ("inner", "outer")  # lines that a law can be made from
        assert '"members": 3' in emap.dataset.attrs[schema.FAMILY]
        assert "points read from refinement lines" in describe(emap, "map.nc")
        checked += "law_check_points" in emap.dataset.attrs
    assert checked == 1
    again = generate_batch(BATCH, folder, workers=1)
    assert {outcome.state for outcome in again.outcomes} == {"kept"}


def test_members_whose_lines_cannot_be_read_are_made_on_their_own(tmp_path, monkeypatch):
    def refuse(*_):
        raise MapError("too few points")

    monkeypatch.setattr(family_maps, "FamilyFilms", refuse)
    family_maps._kept.clear()
    text = batch_text('bearings = ["NU308", "N1014"]\noils = ["FVA3"]\nchecked = 0', "reynolds")
    small = parse_batch(text.replace('"2 m/s"', '"0.6 m/s"'), "cat", "cat.toml")
    monkeypatch.setattr(batch_generate, "sweep", quick_sweep)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(batch_generate._Run, "alone", lambda self, one: one.member.name)
        run = batch_generate.generate_batch(small, tmp_path / "maps", workers=1)
    assert run.outcomes == ("NU308_FVA3", "N1014_FVA3")


def quick_sweep(tasks, store, *rest):
    """Results of tasks without solving them."""
    return SweepResult({task.key: task.failed("not solved") for task in tasks})

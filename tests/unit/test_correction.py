"""Films of one solver corrected by few points of a dearer one: smooth function, design, map, laws, failures, job."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError, MapError
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.job import CorrectedBy, Job
from ehdmaps.jobs.make import generate as generating
from ehdmaps.jobs.make.correction import FILMS, Films, Place, _slow_change, correction, error_of
from ehdmaps.jobs.make.correction_design import VALLEY, candidates, places_of, spread_out
from ehdmaps.jobs.make.sampling import draw, draw_in_valley
from ehdmaps.jobs.make.tasks import LineTask
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.smooth import Smooth
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.hertz import natural_time
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import ContactSolver, ContactSolverDefaults, FilmSolution, Status
from tests.cases.jobs import LINE, map_job, spaced

RATIOS = (0.97, 0.97, 0.97**2)
"""Of film offset and compliance, and of the loss: one factor, which leaves a derivative a derivative."""

TEXT = map_job(spaced("1 N/mm", "500 N/mm", 6), spaced("0.2 m/s", "5 m/s", 3), '["30 degC", "60 degC", "90 degC"]')
ASKED = TEXT + 'corrected_by = "reynolds"\ncorrection_points = 8\n'


@dataclass(frozen=True)
class Scaled(ContactSolverDefaults):
    """Another solver whose films are thinner by a factor; it gives up below a speed, and counts what it solved."""

    of: ContactSolver
    ratios: tuple[float, float, float] = RATIOS
    slowest: float = 0.0
    solved: tuple[list[float], ...] = ()
    wants_backbone: bool = False
    name: str = "scaled"

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        for seen in self.solved:
            seen.extend(loads)
        if entrainment_speed < self.slowest:
            return tuple(FilmSolution(Status.STAGNATED, f"slower than {self.slowest:g} m/s") for _ in loads)
        films = self.of.solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        by = dict(zip(FILMS, self.ratios, strict=True)) | {"central_film": self.ratios[0]}
        return tuple(
            replace(film, **{name: getattr(film, name) * ratio for name, ratio in by.items()}) for film in films
        )

    def settings(self):
        return {"ratio": self.ratios[0], "slowest": self.slowest}


def job_of(text=ASKED):
    return parse_job(text, "test", "test.toml")


def in_memory(tasks):
    return {task.key: task.run() for task in tasks}


# the smooth function


def wave(places):
    return 0.3 + 0.1 * np.sin(1.5 * places[:, 0]) + 0.05 * places[:, 1], 0.15 * np.cos(1.5 * places[:, 0])


RANGES = np.array([4.0, 2.0, 100.0])


def observed(count, noise=0.0):
    rng = np.random.default_rng(7)
    places = rng.uniform(size=(count, 3)) * RANGES
    values = np.array(wave(places))
    values[0] += noise * rng.normal(size=count)
    return Smooth.fitted(places, RANGES, values, np.ones((2, count)))


def test_what_is_predicted_for_a_point_left_out_is_what_the_others_say():
    smooth = observed(9, noise=1e-3)
    keep = np.arange(9) != 4
    others = replace(
        smooth, places=smooth.places[keep], observed=smooth.observed[:, keep], doubts=smooth.doubts[:, keep]
    )
    # Round-off of a matrix whose condition the constant makes a million.
    assert smooth.left_out[:, 4] == pytest.approx(others.at(smooth.places[[4]])[:, 0], rel=1e-6)


def test_value_and_slope_belong_together_and_come_closer_with_more_points():
    held_out = np.random.default_rng(8).uniform(size=(100, 3)) * RANGES
    step, errors = np.array([1e-4, 0.0, 0.0]), []
    for count in (4, 16, 64):
        smooth = observed(count)
        value, slope = smooth.at(held_out)
        quotient = (smooth.at(held_out + step)[0] - smooth.at(held_out - step)[0]) / 2e-4
        np.testing.assert_allclose(
            slope, quotient, atol=1e-5
        )  # of the quotient: round-off of the weights over its step
        errors.append(float(np.std(value - wave(held_out)[0])))
    assert all(later < 0.2 * earlier for earlier, later in pairwise(errors))
    assert errors[-1] < 1e-3 * 0.3


def test_the_spread_is_the_error_of_leaving_out_larger_by_what_was_chosen_and_has_the_noise_of_what_is_doubtful():
    smooth, here = observed(24, noise=1e-3), np.array([[2.0, 1.0, 50.0]])
    assert smooth.chosen == 5 and smooth.freedom == 24 / 19
    spread = [smooth.spread(here, np.array([[1.0], [doubt]])) for doubt in (1.0, 2.0, 3.0)]
    # A doubt counts by its square.
    assert 5.0 * (spread[1] - spread[0]) == pytest.approx(3.0 * (spread[2] - spread[1]), rel=1e-6, abs=1e-12)
    assert spread[2][0, 1, 1] > spread[0][0, 1, 1] > 0.0
    held_out = np.random.default_rng(8).uniform(size=(200, 3)) * RANGES
    sizes = np.abs(smooth.at(held_out)[0] - wave(held_out)[0])
    stated = np.sqrt(smooth.spread(held_out, np.ones((2, 200)))[:, 0, 0])
    # Deviations hold two thirds of the errors, and more by the noise that the function itself has not.
    assert np.mean(sizes <= stated) > 0.6 and np.mean(sizes <= 2.0 * stated) > 0.9
    assert np.median(stated) < 5e-3  # the noise is 1e-3


def test_a_constant_under_noise_is_its_mean():
    rng = np.random.default_rng(3)
    places, noise = rng.uniform(size=(40, 3)) * RANGES, 0.01 * rng.normal(size=40)
    sure = np.ones((2, 40))
    found = Smooth.fitted(places, RANGES, np.array([0.2 + noise, 0.01 * rng.normal(size=40)]), sure)
    alone = found.alike((0.2 + noise)[None], sure[:1])
    assert alone.chosen == 1 and np.all(alone.lengths == found.lengths)
    for one in (found, alone):
        value = one.at(rng.uniform(size=(50, 3)) * RANGES)[0]
        # Four deviations of a mean of 40; what wiggles along with the noise stays below its own size.
        assert abs(np.mean(value) - 0.2) < 4.0 * 0.01 / np.sqrt(40.0)
        assert np.std(value) < 0.01


# design


def test_first_points_fill_the_range():
    among = candidates(job_of())
    chosen = spread_out(among, 16)
    assert len(set(chosen)) == 16
    rng = np.random.default_rng(1)
    farthest = [
        np.max(np.min(among.apart(among.places[some]), axis=1))
        for some in (chosen, *(rng.permutation(len(among.points))[:16] for _ in range(5)))
    ]
    assert farthest[0] < min(farthest[1:])
    assert among.shares(among.places[chosen]).sum() == pytest.approx(1.0, rel=1e-12)  # round-off


def test_a_place_is_made_of_the_groups_of_the_film():
    """Contacts of one bearing at equal M and L have one place: u/R equal, and the load as R."""
    inner, outer = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")
    oil = Lubricant.named("FVA3")
    ratio = outer.radius / inner.radius
    one = places_of(inner, oil, np.array([1e4]), 1.0, 330.0)
    other = places_of(outer, oil, np.array([1e4 * ratio]), ratio, 330.0)
    np.testing.assert_allclose(one, other, rtol=1e-12)  # round-off
    more = places_of(inner, oil, np.array([1e4, 1e4 * np.e]), 1.0, 330.0)
    assert np.diff(VALLEY * np.sinh(more[:, 0])) == pytest.approx(1.0, rel=1e-12)  # round-off


def test_a_job_of_standstill_has_nothing_to_correct(tmp_path):
    job = replace(job_of(), entrainment_speeds=(0.0,))
    with pytest.raises(
        MapError, match="0 of 0 points have a solution by both; at least 4 are needed; no map is written"
    ):
        generating.generate(job, tmp_path / "a.nc", 1)


# correction


def test_a_solver_that_differs_by_a_factor_is_recovered():
    cheap, dear = FormulaSolver(), Scaled(FormulaSolver())
    job = job_of()
    made = correction(job, cheap, dear, 8, in_memory)
    assert made.record["asked"] == made.record["usable"] == len(made.record["points"]) == 8
    rng = np.random.default_rng(5)
    for point in (draw(job, rng) for _ in range(20)):
        films = [
            LineTask(point.contact, job.lubricant, (point.load,), point.speed, point.temperature, solver)
            for solver in (cheap, dear)
        ]
        arrays, wanted = (task.run() for task in films)
        found = made.corrected(films[0], arrays)
        # The least variance of a smooth function: differences of 1e-7; the loss counts arsinh, of which it is a part.
        for name, tolerance in (("film_offset", 1e-6), ("film_compliance", 1e-6), ("central_film", 1e-6)):
            assert found[name][0] == pytest.approx(wanted[name][0], rel=tolerance)
    assert made.record["before"]["film_offset"]["median"] == pytest.approx(1.0 / 0.97 - 1.0, rel=1e-9)
    assert made.record["leave_one_out"]["film_offset"]["largest"] < 1e-6


def test_corrected_film_compliance_is_the_derivative_of_the_corrected_film_offset():
    job, cheap, dear = job_of(), FormulaSolver(), ReynoldsSolver(density=4.0)
    made = correction(job, cheap, dear, 12, in_memory)
    step = 1e-5
    for load, speed in ((3e3, 1.0), (3e4, 0.3), (3e5, 4.0)):
        loads = (load * (1.0 - step), load, load * (1.0 + step))
        task = LineTask(job.contacts[0], job.lubricant, loads, speed, 333.15, cheap)
        found = made.corrected(task, task.run())
        quotient = -(found["film_offset"][2] - found["film_offset"][0]) / (2.0 * step * load)
        # Of the quotient: round-off over its step, and the square of the step over the width of the valley.
        assert found["film_compliance"][1] == pytest.approx(quotient, rel=1e-6)


@pytest.fixture(scope="module")
def held_out():
    """Errors at points that no correction has seen, by the number of its points, and what these say of themselves."""
    job, cheap, dear = job_of(), FormulaSolver(), ReynoldsSolver(density=4.0)
    rng = np.random.default_rng(11)
    points = [draw(job, rng) for _ in range(64)]
    points += [point for _ in range(32) if (point := draw_in_valley(job, rng)) is not None][:16]
    tasks = [
        [LineTask(p.contact, job.lubricant, (p.load,), p.speed, p.temperature, solver) for solver in (cheap, dear)]
        for p in points
    ]
    solved = [[task.run() for task in pair] for pair in tasks]
    found = {}
    for count in (0, 8, 16, 32):
        made = correction(job, cheap, dear, count, in_memory) if count else None
        errors, stated = [], []
        for (task, _), (arrays, truth) in zip(tasks, solved, strict=True):
            contact, loads = task.contact, np.array(task.loads)
            where = Place.of(contact, task.lubricant, loads, task.entrainment_speed, task.temperature)
            films = Films.of(made.corrected(task, arrays) if made else arrays)
            error = error_of(where, films, Films.of(truth))
            errors.append([error[name][0] for name in ("film_offset", "stiffness", "damping")])
            if made:
                stated.append(made.model_errors(films, where)[0][0])
        found[count] = np.abs(errors), np.array(stated), made
    return found


def test_errors_at_held_out_points_fall_with_the_number_of_points(held_out):
    """By more than a hundred for films and 30 for k over a formula; c, whose valley the formula lacks, by ten."""
    medians = [np.median(held_out[count][0], axis=0) for count in (0, 8, 16, 32)]
    assert np.all(medians[1] < 0.5 * medians[0])
    assert np.all(medians[2] < medians[1])
    assert np.all(medians[3] < medians[2])
    assert np.all(medians[3] < medians[0] / [30.0, 10.0, 10.0])


def test_errors_of_leaving_out_are_those_at_held_out_points(held_out):
    """Within a factor of four of the true ones: medians of 16 and 32 sizes, which scatter over a decade."""
    for count in (16, 32):
        errors, _, made = held_out[count]
        for column, name in enumerate(("film_offset", "stiffness", "damping")):
            left_out = made.record["leave_one_out"][name]["median"]
            assert 0.25 < left_out / np.median(errors[:, column]) < 4.0


def test_model_errors_are_standard_deviations(held_out):
    """Two thirds of the errors should be below one of them, and 95 % below two; they are chosen from 32 points."""
    errors, stated, _ = held_out[32]
    assert 0.5 < np.mean(errors[:, 1] <= stated) < 0.98
    assert np.mean(errors[:, 1] <= 2.0 * stated) > 0.8


@dataclass(frozen=True)
class Noisy(Scaled):
    """Another solver that differs by noise alone, of 2 % in every film."""

    seed: int = 0

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        films = self.of.solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        rng = np.random.default_rng([self.seed, int(1e3 * loads[0]), int(1e6 * entrainment_speed)])
        noises = 1.0 + 0.02 * rng.normal(size=(len(films), 3))
        return tuple(
            replace(film, **{name: getattr(film, name) * by for name, by in zip(FILMS, noise, strict=True)})
            for film, noise in zip(films, noises, strict=True)
        )

    def settings(self):
        return {"seed": self.seed}


@pytest.mark.slow
def test_a_correction_that_leaving_out_does_not_bear_out_is_not_applied():
    """Nothing is to be learned from noise; by chance a mean of twelve looks like something, once in six."""
    job, cheap = job_of(), FormulaSolver()
    found = [correction(job, cheap, Noisy(cheap, seed=seed), 12, in_memory) for seed in range(4)]
    idle = [made for made in found if made.applied == (False, False)]
    assert len(idle) >= 2
    made = idle[0]
    assert made.record["not_applied"] == ["film_offset", "loss_compliance"]
    task = LineTask(job.contacts[0], job.lubricant, (2e4,), 1.0, 333.15, cheap)
    found = made.corrected(task, arrays := task.run())
    assert found["loss_compliance"] == pytest.approx(arrays["loss_compliance"], rel=1e-12)  # round-off of arsinh
    assert found["film_offset"] == arrays["film_offset"]
    films, where = Films.of(found), Place.of(task.contact, job.lubricant, np.array([2e4]), 1.0, 333.15)
    of_k, _ = made.model_errors(films, where)
    # The noise of the film compliance is 2 %, and what that is of k: noise in k is taken as that of light loads.
    share = films.compliance / (films.compliance + task.contact.structural_compliance(2e4))
    assert 0.02 * share[0] < of_k[0] < 0.05


def test_the_response_changes_as_its_slow_film_does():
    """To first order in frequency with film and loss compliance of its own time; not at all where it is locked."""
    contact = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
    loads = np.array([5e3, 5e4])
    old = Films(np.array([4e-7, 3e-7]), np.array([5e-12, 1e-12]), np.array([1e-15, 5e-16]))
    new = Films(*(0.8 * values for values in old))
    slow = 1e-5
    task = LineTask(contact, Lubricant.named("FVA3"), (5e3, 5e4), 1.5, 330.0, FormulaSolver(), (slow, 1e5))
    change = _slow_change(task, loads, old, new)
    times = [natural_time(loads, film.offset, 1.5, contact.radius, contact.reduced_modulus) for film in (old, new)]
    expected = [film.compliance - 1j * slow * film.loss / time for film, time in zip((old, new), times, strict=True)]
    # Of second order in the frequency.
    np.testing.assert_allclose(change[:, 0], expected[1] - expected[0], rtol=1e-8)
    assert np.all(np.abs(change[:, 1]) < 1e-4 * np.abs(change[:, 0]))


# maps


@pytest.mark.slow
def test_a_corrected_map_says_so_and_goes_on_where_it_was_interrupted(tmp_path, capsys):
    path, solved = tmp_path / "a.nc", []
    job, dear = job_of(), Scaled(FormulaSolver(), solved=(solved,))
    first = generating.generate(job, path, 1, corrector=dear)
    assert len(solved) == 8
    path.unlink()
    again = generating.generate(job, path, 1, corrector=dear)
    assert len(solved) == 8 and again.sweep.solved == 0
    for name in (*FILMS, "stiffness_model_error", "damping_model_error"):
        assert again.dataset[name].equals(first.dataset[name])
    emap = open_map(path)
    direct = generating.generate_in_memory(replace(job, corrected_by=None), 1, solver=Scaled(FormulaSolver())).dataset
    # The least variance of a smooth function, 1e-7.
    for name, tolerance in (("stiffness", 1e-6), ("film_offset", 1e-6)):
        np.testing.assert_allclose(emap.dataset[name], direct[name], rtol=tolerance)
    assert emap.dataset.attrs["schema_version"] == schema.SCHEMA_VERSION
    assert emap.dataset["stiffness_model_error"].dims == schema.DIMS
    record = json.loads(emap.dataset.attrs["correction"])
    assert (record["solver"], record["asked"], record["usable"]) == ("scaled", 8, 8)
    assert emap.dataset.attrs["title"].endswith("by the solver formula, corrected by scaled")
    assert main(["show", str(path)]) == 0
    shown = capsys.readouterr().out
    assert "correction by scaled (ratio 0.97, slowest 0.0)" in shown and "leaving out each point" in shown
    for change in ({"before": 3}, {"settings": []}, {"points": [{"status": "failed"}]}):
        damaged = emap.dataset.assign_attrs(correction=json.dumps(record | change))
        with pytest.raises(MapError, match="attribute correction is not as `ehdmaps generate` writes it"):
            from ehdmaps.jobs.show.describe import describe

            describe(EHDMap(damaged), "a.nc")


def test_model_errors_follow_the_structural_law():
    """That of k is k times that of the film compliance, which is the film's own."""
    job = job_of()
    dataset = generating.generate_in_memory(job, 1, corrector=ReynoldsSolver(density=4.0)).dataset
    emap = EHDMap(dataset)
    other = emap.with_structure("half_space").dataset
    of_film = [d["stiffness_model_error"] / d["stiffness"] for d in (dataset, other)]
    np.testing.assert_allclose(of_film[0], of_film[1], rtol=1e-12)  # round-off
    assert not np.allclose(dataset["damping_model_error"], other["damping_model_error"], rtol=1e-4)
    back = EHDMap(other).with_structure("iso16281").dataset
    for name in ("stiffness_model_error", "damping_model_error"):
        np.testing.assert_allclose(back[name], dataset[name], rtol=1e-6)  # round-off of a root of a difference


def test_laws_of_a_corrected_map_are_those_of_the_dearer_solver(tmp_path):
    """Both maps with a backbone: the law of the corrected one is that of films thinner by the factor."""
    text = LINE.replace('"0 m/s", ', "").replace('"formula"', '"reynolds"')
    job = job_of(text + 'density = 4.0\ncorrected_by = "openfoam"\ncorrection_points = 6\n')
    solver = ReynoldsSolver(density=4.0)
    made = generating.generate(job, tmp_path / "a.nc", 1, corrector=Scaled(solver))
    assert made.backbone is not None
    direct = generating.generate(
        replace(job, corrected_by=None), tmp_path / "b.nc", 1, solver=Scaled(solver, wants_backbone=True)
    )
    for name in FILMS:
        # As above. Losses differ by a factor, and their arsinh by less where it is linear: a tenth in the valley.
        tolerance = 0.1 if name == "loss_compliance" else 1e-6
        np.testing.assert_allclose(made.backbone[name], direct.backbone[name], rtol=tolerance)
    approach = np.array([1e-6, 2e-6])
    laws = [open_map(tmp_path / name).law("line") for name in ("a.nc", "b.nc")]
    found, wanted = (np.array(law(approach, 0.0, 1.0, 313.15)) for law in laws)
    np.testing.assert_allclose(found[:2], wanted[:2], rtol=1e-5)
    np.testing.assert_allclose(found[2], wanted[2], rtol=0.01)
    assert laws[0].at(1.0, 313.15).memory is not None


def test_points_that_fail_are_counted_and_named(tmp_path, capsys, monkeypatch):
    dear = Scaled(FormulaSolver(), slowest=0.5)
    made = generating.generate(job_of(), tmp_path / "a.nc", 1, corrector=dear)
    record = json.loads(made.dataset.attrs["correction"])
    failed = [point for point in record["points"] if point["status"] == "stagnated"]
    assert 0 < len(failed) == record["asked"] - record["usable"] < 5
    assert all(point["entrainment_speed"] < 0.5 and point["reason"] == "slower than 0.5 m/s" for point in failed)
    from ehdmaps.jobs.make.generate import summary

    text = summary(made, tmp_path / "a.nc")
    assert f"8 points, {8 - len(failed)} of them with a solution by both solvers" in text
    assert "slower than 0.5 m/s" in text and " m/s, " in text

    from ehdmaps.jobs import solvers

    real = solvers.build
    monkeypatch.setattr(solvers, "build", lambda name, options: dear if name == "reynolds" else real(name, options))
    job = tmp_path / "job.toml"
    job.write_text(ASKED)
    assert main(["generate", str(job), "-o", str(tmp_path / "b.nc"), "--workers", "1"]) == 1
    assert "correction by scaled" in capsys.readouterr().out


def test_without_enough_points_there_is_no_map(tmp_path):
    dear, path = Scaled(FormulaSolver(), slowest=1e9), tmp_path / "a.nc"
    with pytest.raises(
        MapError, match="correction of formula by scaled: 0 of 8 points have a solution by both"
    ) as error:
        generating.generate(job_of(), path, 1, corrector=dear)
    text = str(error.value)
    assert "the first" in text and "8 stagnated: slower than 1e+09 m/s" in text and "delete corrected_by" in text
    assert not path.exists() and (tmp_path / "a.nc.store").exists()
    with pytest.raises(InputError, match="corrector: got one for a job without corrected_by"):
        generating.generate(job_of(TEXT), path, 1, corrector=dear)


# the job


def test_a_job_says_by_what_it_is_corrected():
    job = job_of(TEXT + 'corrected_by = "openfoam"\n[correction]\nflow = "full_stress"\nrows = 8\n')
    assert job.corrected_by == CorrectedBy("openfoam", 16, {"flow": "full_stress", "rows": 8})
    assert job_of(TEXT).corrected_by is None
    assert parse_job(job.text, "test", "test.toml", solver="hertz").corrected_by is None
    names = ("bearing", "lubricant", "loads", "entrainment_speeds", "temperatures")
    given = {name: getattr(job, name) for name in names}
    built = Job.build(
        **given,
        solver="formula",
        corrected_by="openfoam",
        correction_points=16,
        correction_options={"flow": "full_stress", "rows": 8},
    )
    assert (
        built.corrected_by == job.corrected_by and parse_job(built.text, "again", "").corrected_by == job.corrected_by
    )
    with pytest.raises(InputError, match="correction_options: got some without corrected_by"):
        Job.build(**given, correction_options={"rows": 8})


@pytest.mark.parametrize(
    ("added", "message"),
    [
        ('corrected_by = "cfd"', "corrected_by: got 'cfd'; allowed: 'formula', 'reynolds', 'openfoam'"),
        ('corrected_by = "hertz"', "corrected_by: got 'hertz'; allowed: 'formula', 'reynolds', 'openfoam'"),
        ("correction_points = 8", "correction_points: stands without corrected_by"),
        ("[correction]\nrows = 8", "correction: stands without corrected_by"),
        ('corrected_by = "formula"', "corrected_by: got 'formula', the solver of the map with the same keys"),
        (
            'corrected_by = "reynolds"\ncorrection_points = 3',
            "correction_points: got 3; allowed: a whole number from 4 to",
        ),
        ('corrected_by = "reynolds"\n[correction]\nrows = 8', r"\[correction\] rows: unknown key"),
        ('corrected_by = "reynolds"\n[correction]\ndensity = -1.0', r"\[correction\] density: got -1"),
    ],
)
def test_what_a_job_may_not_say_of_its_correction(added, message):
    with pytest.raises(InputError, match=message):
        job_of(f"{TEXT}{added}\n")


def test_a_dry_map_has_no_film_to_correct():
    with pytest.raises(InputError, match="corrected_by: stands beside name = 'hertz', which has no film to correct"):
        job_of(ASKED.replace('"formula"', '"hertz"'))


def test_check_says_what_a_correction_costs(tmp_path, capsys):
    path = tmp_path / "job.toml"
    path.write_text(ASKED)
    assert main(["check", str(path)]) == 0
    said = capsys.readouterr().out
    assert "108 of the map, 0 for its contact laws, 8 for its correction" in said
    assert said.count("  time    about") == 1 and "\n    reynolds             8 points, " in said


def test_what_a_correcting_solver_lacks_is_a_problem_of_the_job(tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("EHDMAPS_OPENFOAM", str(tmp_path / "nothing"))
    path = tmp_path / "job.toml"
    path.write_text(TEXT + 'corrected_by = "openfoam"\n')
    assert main(["check", str(path)]) == 2
    assert "[solver] corrected_by: got 'openfoam', which needs more than is here" in capsys.readouterr().err

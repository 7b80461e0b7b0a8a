"""Assembling, writing, opening, describing, comparing and drawing a map."""

import json
import math
import re
from dataclasses import dataclass, fields, replace

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import MapError
from ehdmaps.exports.map_curves import curves, law_field
from ehdmaps.jobs import solvers
from ehdmaps.jobs.make.assemble import assemble, placed
from ehdmaps.jobs.make.generate import generate, summary, write_map
from ehdmaps.jobs.make.law_check import STANDS_ON_LINES, STANDS_ON_POINTS, unmet
from ehdmaps.jobs.make.report import ERRORS, holes, status_rows
from ehdmaps.jobs.make.tasks import LATER_FIELDS, LONGEST_LINE, LineTask, line_tasks, solver_version
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.show.compare import compare, comparison_json, comparison_text
from ehdmaps.jobs.show.describe import describe
from ehdmaps.jobs.show.plot import page_legend, plot_map
from ehdmaps.maps import schema
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.reading import validate
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.closed_form import FormulaSolver, HertzSolver
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import ContactSolverDefaults, FilmSolution, Status, contact_solution
from ehdmaps.provenance import code_hash
from tests.cases.jobs import DRY, LINE, SMALL, spaced


@dataclass(frozen=True)
class Holey(ContactSolverDefaults):
    """The formula solver with points that do not converge."""

    lost: tuple[float, ...] = ()
    slow: bool = False
    version: str | None = None
    name: str = "holey"

    def solve_line(self, contact, lubricant, loads, entrainment_speed, temperature):
        films = FormulaSolver().solve_line(contact, lubricant, loads, entrainment_speed, temperature)
        return tuple(
            FilmSolution(Status.STAGNATED, f"step {load:g} too small", film_offset=1.0)
            if self._hit(load, entrainment_speed)
            else film
            for load, film in zip(loads, films, strict=True)
        )

    def _hit(self, load, speed):
        return speed == 1.0 and any(abs(load / lost - 1) < 1e-9 for lost in self.lost)

    def settings(self):
        return {}


class Stated(Holey):
    """The same with errors of 1 %."""

    def solve_line(self, *line):
        errors = {field.name: 0.01 for field in fields(FilmSolution) if field.name.endswith("_error")}
        films = super().solve_line(*line)
        return tuple(replace(film, **errors) if film.status.usable else film for film in films)


def job_of(text=SMALL, **changes):
    return replace(parse_job(text, "test", "test.toml"), **changes)


def made(job, solver=None):
    chosen = solver or solvers.build(job.solver, job.solver_options)
    tasks = line_tasks(job, chosen)
    return assemble(job, chosen, placed(job, tasks, {task.key: task.run() for task in tasks}))


def test_every_point_is_in_its_place():
    job = job_of()
    dataset = made(job)
    validate(dataset)
    assert dataset["stiffness"].dims == schema.DIMS
    for i, j, k, n in [(0, 0, 0, 0), (1, 6, 2, 1), (0, 3, 1, 0)]:
        (film,) = FormulaSolver().solve_line(
            job.contacts[i], job.lubricant, (job.loads[j],), job.entrainment_speeds[k], job.temperatures[n]
        )
        point = OperatingPoint(job.loads[j], job.entrainment_speeds[k], job.temperatures[n])
        expected = contact_solution(film, job.contacts[i], point)
        for name in ("approach", "film_offset", "stiffness", "damping", "minimum_film"):
            assert dataset[name].values[i, j, k, n] == getattr(expected, name)


def test_long_axes_are_cut_into_tasks_that_meet():
    text = SMALL.replace("points = 7", f"points = {2 * LONGEST_LINE + 5}")
    job = job_of(text)
    tasks = line_tasks(job, FormulaSolver())
    assert max(task.points for task in tasks) == LONGEST_LINE
    assert sum(task.points for task in tasks) == job.points
    assert np.isfinite(made(job)["stiffness"].values).all()


def test_slow_solvers_get_one_point_a_task():
    tasks = line_tasks(job_of(), Holey(slow=True))
    assert {task.points for task in tasks} == {1}
    assert all(task.slow for task in tasks)
    assert len(tasks) == job_of().points


def test_the_key_holds_what_changes_the_numbers_and_nothing_else():
    job = job_of()
    task = line_tasks(job, FormulaSolver())[0]
    same = replace(task, place=(1, 2, 3, 4), contact=replace(task.contact, structural_law="palmgren", name="x"))
    assert same.key == task.key
    others = [
        replace(task, loads=task.loads[:-1]),
        replace(task, entrainment_speed=7.0),
        replace(task, temperature=300.0),
        replace(task, contact=job.contacts[1]),
        replace(task, lubricant=replace(job.lubricant, density_15=900.0)),
        replace(task, solver=HertzSolver()),
        replace(task, solver=FormulaSolver("pan-hamrock")),
        replace(task, solver=Holey()),
        replace(task, solver=Holey(version="2")),
    ]
    assert len({task.key, *(other.key for other in others)}) == 10


def test_the_key_holds_the_heat_of_the_solids_where_films_know_heat():
    class Warm(Holey):
        def settings(self):
            return {**super().settings(), "physics": "thermal"}

    task = line_tasks(job_of(), Holey())[0]
    other = replace(task.contact, material=replace(STEEL, conductivity=30.0))
    assert replace(task, contact=other).key == task.key
    assert replace(task, contact=other, solver=Warm()).key != replace(task, solver=Warm()).key


def test_keys_of_a_solver_with_a_version_of_its_own_stay_what_they_are():
    """What took days is taken over by the next version of ehdmaps: the key is that of the maps of schema 1."""
    solver = Holey(slow=True, version="7")
    contact = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
    task = LineTask(contact, Lubricant.named("FVA3"), (1e4, 2e4), 1.0, 313.15, solver)
    assert task.key == "6b51b7f5cb74e33a3cf90e49454553e8cdc732b968e6395327c87cdac130eea8"


def test_results_from_before_there_was_a_rolling_force_are_taken_over_without_it():
    """Their points have none, the others theirs: what is stored is never left out nor made up."""
    job = job_of()
    tasks = line_tasks(job, HertzSolver())
    results = {task.key: task.run() | {"rolling_force": np.full(task.points, 2.0)} for task in tasks}
    old = results[tasks[0].key]
    for name in LATER_FIELDS:
        del old[name]
    values = assemble(job, HertzSolver(), placed(job, tasks, results))["rolling_force"].values
    assert np.count_nonzero(np.isnan(values)) == tasks[0].points
    assert set(values[np.isfinite(values)]) == {2.0}


def test_a_solver_s_own_version_counts_instead_of_the_sources():
    assert solver_version(Holey(version="7")) == "7"
    assert solver_version(FormulaSolver()) == code_hash()


def test_an_isolated_hole_is_filled_and_says_so():
    job = job_of()
    dataset, truth = made(job, Holey((job.loads[3],))), made(job)
    here = {"load": 3, "entrainment_speed": 1}
    assert (dataset["status"].isel(here) == int(Status.STAGNATED)).all()
    assert (dataset["filled"].isel(here) == 1).all()
    assert str(dataset["reason"].isel(here).values[0, 0]).startswith("step 31622.8 too small")
    assert np.isnan(dataset["film_offset_error"].isel(here)).all()
    assert int(dataset["filled"].sum()) == holes(dataset) == 4
    # A step of 3.2 in load over the bend of the film: the interpolation is good to some 10 %, not more.
    ratio = dataset["film_offset"].isel(here) / truth["film_offset"].isel(here)
    assert np.allclose(ratio, 1.0, atol=0.15)
    contact = job.contacts[0]
    approach = contact.structural_approach(job.loads[3]) - dataset["film_offset"].values[0, 3, 1, 0]
    assert dataset["approach"].values[0, 3, 1, 0] == pytest.approx(approach, rel=1e-14)
    rest = dataset["status"] == int(Status.CONVERGED)
    assert np.array_equal(dataset["stiffness"].where(rest), truth["stiffness"].where(rest), equal_nan=True)


@pytest.mark.parametrize(("fill", "lost"), [("none", slice(3, 4)), ("neighbours", slice(3, 5))])
def test_other_holes_hold_no_numbers(fill, lost):
    text = SMALL.replace('"0.5 m/s", "1 m/s", "2 m/s"', '"0.5 m/s", "1 m/s"')  # the lost speed is at the edge
    job = job_of(text, fill=fill)
    dataset = made(job, Stated(job.loads[lost]))
    hole = dataset["status"] == int(Status.STAGNATED)
    assert int(hole.sum()) == 4 * len(job.loads[lost])
    assert int(dataset["filled"].sum()) == 0
    for name in ("approach", "film_offset", "stiffness", "damping", "central_film", "max_pressure", "stiffness_error"):
        assert np.isnan(dataset[name].values[hole.values]).all()
        assert np.isfinite(dataset[name].values[~hole.values]).all()


def test_structural_scaling_is_recorded_for_other_materials():
    text = SMALL.replace("[grid]", '[material]\nyoungs_modulus = "105 GPa"\n[grid]')
    assert made(job_of(text)).attrs["structural_scaling"] == pytest.approx(2.0**0.9, rel=1e-12)  # round-off
    assert made(job_of()).attrs["structural_scaling"] == 1.0
    assert made(job_of(LINE)).attrs["structural_scaling"] == 1.0


def test_a_map_file_comes_back_whole(tmp_path):
    dataset = made(job_of(), Holey((1000.0, 1e6)))
    path = tmp_path / "a.nc"
    write_map(dataset, path)
    again = open_map(path).dataset
    xr.testing.assert_equal(again, dataset)
    assert again.attrs == dataset.attrs
    assert again["status"].attrs["flag_meanings"] == "converged asymptote stagnated diverged outside_validity failed"
    assert again["status"].attrs["flag_values"].tolist() == [0, 1, 2, 3, 4, 5]
    for name in (entry.name for entry in schema.table() if entry.required):
        assert again[name].attrs["units"] and again[name].attrs["long_name"]
    assert [p.name for p in tmp_path.iterdir()] == ["a.nc"]
    assert open_map(path).backbone is None


class WithBackbone(FormulaSolver):
    """Closed formulas that ask for a backbone."""

    wants_backbone = True


@pytest.fixture(scope="module")
def with_backbone(tmp_path_factory):
    """A whole map with its group, without a solve; pressures on both sides of 0.6 GPa."""
    path = tmp_path_factory.mktemp("map") / "a.nc"
    return generate(job_of(), path, workers=1, solver=WithBackbone()), path


def test_a_group_is_written_with_the_map(with_backbone):
    emap = open_map(with_backbone[1])
    response = {entry.name for entry in schema.response_rows(schema.SCHEMA_VERSION)}
    rows = {entry.name for entry in schema.table(schema.BACKBONE) if not entry.name.startswith(schema.OWN)}
    assert set(emap.backbone.variables) == rows - response  # isothermal: both contacts share their lines
    told = describe(emap, "a.nc")
    assert "refinement lines of the contact law (group backbone)" in told
    assert "response over frequency: none; films in time lock by a closed formula" in told


@pytest.mark.slow
def test_extrapolated_viscosity_is_said_everywhere(with_backbone, page, tmp_path, monkeypatch):
    """Of FVA 3 a reach of 0.6 GPa is assumed, which the formulas' Hertz pressure passes between 31 and 100 N/mm."""
    generated, path = with_backbone
    emap = open_map(path)
    beyond = emap.dataset["max_pressure"].values > 0.6e9
    assert np.array_equal(emap.dataset["viscosity_extrapolated"].values.astype(bool), beyond)
    assert 0 < beyond.sum() < beyond.size
    share = (
        f"viscosity extrapolated: {beyond.sum()} points, {100.0 * beyond.mean():.2f} %, with pressures above 0.6 GPa"
    )
    for text in (describe(emap, "a.nc"), summary(generated, path)):
        assert share in text
        assert "inner and outer, 100 to 1000 N/mm, 0.5 to 2 m/s, 20 to 40 degC" in text
    assert "at some speed above 0.6 GPa: how far the viscosity law reaches is assumed, not stated" in page
    # of an oil whose data are stated to reach so far the range beyond is hatched
    record = {**json.loads(emap.dataset.attrs["lubricant"]), "fitted_pressure_stated": True, "label": "VG 46"}
    stated = EHDMap(emap.dataset.assign_attrs(lubricant=json.dumps(record)))
    assert "viscosity extrapolated: at some speed above 0.6 GPa" in drawn(stated, tmp_path, monkeypatch)
    assert f"{share}, up to which VG 46 is stated" in describe(stated, "a.nc")
    light = EHDMap(made(job_of(SMALL.replace("1000 N/mm", "10 N/mm"))))
    assert "extrapolated" not in describe(light, "a.nc")


def test_curves_between_the_points_are_those_of_the_laws(with_backbone):
    emap = open_map(with_backbone[1])
    loads = np.geomspace(2e3, 9e5, 30)
    by_name = {contact.name: contact for contact in emap.contacts}
    for kind, names in (("inner", ["inner"]), ("series", ["inner", "outer"])):
        found = curves(law_field(emap), tuple(by_name[name] for name in names), loads, 0.7, 305.0)
        w, k, c = emap.law(kind)(found.approach, 0.0, 0.7, 305.0)
        # 1e-4, 1e-3, 1e-2: tabulation of the law, largest next to the lowest loads
        np.testing.assert_allclose(w, loads, rtol=1e-4)
        np.testing.assert_allclose(k, found.stiffness, rtol=1e-3)
        np.testing.assert_allclose(c, found.damping, rtol=1e-2)


def drawn(emap, folder, monkeypatch):
    """Texts of the page."""
    import matplotlib as mpl

    monkeypatch.setitem(mpl.rcParams, "svg.fonttype", "none")
    plot_map(emap, folder / "page.svg")
    return (folder / "page.svg").read_text()


@pytest.fixture(scope="module")
def page(with_backbone, tmp_path_factory):
    """Texts of the page of the whole map."""
    with pytest.MonkeyPatch.context() as patch:
        return drawn(open_map(with_backbone[1]), tmp_path_factory.mktemp("page"), patch)


@pytest.mark.slow
def test_the_page_explains_only_what_it_shows(page, tmp_path, monkeypatch):
    text = page
    for part in ("approach, µm", "between the points (dots): films of the contact laws", "dry (structural law alone)"):
        assert part in text
    for part in ("asymptote", "zero or negative", "no solution", "filled"):
        assert part not in text
    assert "between the points" not in drawn(EHDMap(made(job_of())), tmp_path, monkeypatch)


def test_describe_has_the_units_of_engineers(with_backbone):
    text = describe(open_map(with_backbone[1]), "a.nc")
    for part in (
        "raceway diameters    52 mm inner, 80 mm outer",
        "rollers              12, 14 mm diameter, 15 mm long",
        "inner contact        reduced radius 5.5152 mm",
        "Young's modulus 210 GPa, Poisson's ratio 0.3",
        "84.54 mPa s at 40 degC, 9.861 mPa s at 100 degC",
        "22.36 1/GPa at 40 degC",
        "reach 0.6 GPa assumed",
        "film formula moes",
        "content              as made (sha256 ",
    ):
        assert part in text
    assert "{" not in text
    assert "GridShape" not in text
    settings = json.dumps({"grid_shape": "GridShape(inlet=1.0, exit_width=0.45)", "density": 6.5})
    text = describe(EHDMap(made(job_of()).assign_attrs(solver_settings=settings)), "a.nc")
    assert "grid shape inlet 1.0, exit width 0.45" in text
    assert "content              may have been changed since: the map has no checksum" in text


def test_error_estimates_of_films_and_pressure_are_in_the_map():
    names = ("central_film_error", "minimum_film_error", "max_pressure_error")
    stated = made(job_of(), Stated((job_of().loads[3],)))
    assert all(int(np.isnan(stated[name]).sum()) == 4 and stated[name].attrs["units"] == "1" for name in names)
    assert "\n  max pressure                     0.01" in describe(EHDMap(stated), "a.nc")
    older = EHDMap(stated.drop_vars(list(names)))
    assert "\n  max pressure              none stated\n" in describe(older, "a.nc").split("accuracy")[1]


@pytest.mark.slow
def test_a_map_says_where_no_errors_are_stated(tmp_path):
    dataset = made(job_of(), FormulaSolver())
    assert all(np.isnan(dataset[name]).all() for name in ERRORS)
    accuracy = describe(EHDMap(dataset), "a.nc").split("accuracy")[1]
    assert accuracy.count("none stated") == len(ERRORS) and not re.search(r"\bnan\b", accuracy)
    plot_map(EHDMap(dataset), tmp_path / "a.svg")
    assert "stimated relative error" not in (tmp_path / "a.svg").read_text()


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), RuntimeError("NetCDF: HDF error")])
def test_a_full_disk_leaves_the_good_map_alone(tmp_path, monkeypatch, error):
    path = tmp_path / "a.nc"
    dataset = made(job_of())
    write_map(dataset, path)
    before = path.read_bytes()

    def half_written(self, target, **_):
        target.write_bytes(b"half")
        raise error

    monkeypatch.setattr(xr.Dataset, "to_netcdf", half_written)
    with pytest.raises(MapError, match=r"a\.nc: cannot be written .*what was solved is kept"):
        write_map(dataset, path)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["a.nc"]


def test_a_file_that_is_no_map(tmp_path):
    (tmp_path / "a.nc").write_text("hello")
    with pytest.raises(MapError, match="cannot be read"):
        open_map(tmp_path / "a.nc")
    xr.Dataset({"x": ("y", [1.0])}).to_netcdf(tmp_path / "b.nc")
    with pytest.raises(MapError, match="has no attribute schema_version"):
        open_map(tmp_path / "b.nc")


def test_validate_lists_every_problem():
    dataset = made(job_of())
    broken = dataset.drop_vars(["damping", "loss_compliance"]).assign_coords(load=dataset["load"].values[::-1])
    broken["stiffness"].attrs["units"] = "N/mm"
    broken["status"] = broken["status"] + 9
    broken["approach"] = broken["approach"].isel(load=0)
    del broken.attrs["lubricant"]
    with pytest.raises(MapError) as raised:
        validate(broken, "a.nc")
    text = str(raised.value)
    for part in (
        "a.nc: attribute lubricant is missing",
        "coordinate load has units None",
        "coordinate load does not rise",
        "variable loss_compliance is missing",
        "variable stiffness has units 'N/mm'; expected 'N m-2'",
        "variable approach has dims",
        "status holds [9]",
    ):
        assert part in text
    dataset.attrs["schema_version"] = 99
    with pytest.raises(MapError, match=r"schema_version is 99; this ehdmaps reads 1 to 8; .*newer one: update"):
        validate(dataset)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.drop_vars("load"), "coordinate load is missing"),
        (lambda d: d.assign_coords(contact=["a", "b"]), "contact holds a, b; expected inner, outer or line"),
        (lambda d: d.isel(load=slice(0)), "coordinate load is empty"),
    ],
)
def test_validate_refuses_broken_axes(change, message):
    with pytest.raises(MapError, match=message):
        validate(change(made(job_of())))


def test_describe_says_what_is_in_the_map():
    job = job_of()
    text = describe(EHDMap(made(job, Holey((job.loads[3], job.loads[0])))), "a.nc")
    for part in (
        "axes (84 points)",
        "load                     7  1 to 1000 N/mm",
        "temperature              2  20 to 40 degC, of the raceways",
        "stagnated               8    9.52 %",
        "8 x step 1000 too small (numbers differ)",
        "inner and outer, 1 to 31.62 N/mm, 1 m/s, 20 to 40 degC",
        "8 are isolated and filled from their neighbours",
        "estimated relative error       median       95 %    largest",
        "solver               holey",
        "(law vogel)",
    ):
        assert part in text


def test_points_that_failed_for_one_cause_count_together_whatever_their_logs_say():
    job = job_of()
    dataset = made(job, Holey((job.loads[3], job.loads[0])))
    reasons = dataset["reason"].values.astype(object).ravel()
    for number, index in enumerate(np.flatnonzero(reasons != "")):
        kind = ("chord", "Newton")[number % 2]
        reasons[index] = f"did not end; last lines of the log: {kind} step {number}; log /tmp/{number}.log"
    dataset["reason"] = dataset["reason"].dims, reasons.reshape(dataset["reason"].shape)
    (cause,) = (cause for group in status_rows(dataset) for cause in group.causes)
    assert cause.count == 8
    assert cause.text == "did not end; last lines of the log: chord step 0; log /tmp/0.log"


def test_describe_warns_of_an_oil_without_a_source():
    assert "NOT VERIFIED" in describe(EHDMap(made(job_of(SMALL.replace("FVA3", "Spirax MA 80W")))), "a.nc")


def test_compare_finds_the_difference_and_its_place():
    first = made(job_of())
    second = first.copy(deep=True)
    second["damping"].values[1, 6, 2, 1] *= 1.25
    second.attrs["solver"] = "other"
    found = compare(first, second, ("a.nc", "b.nc"))
    text = comparison_text(found)
    assert "differ in solver" in text
    assert "84 points in common, 84 of them solved in both" in text
    (line,) = [line for line in text.splitlines() if line.startswith("  damping")]
    assert line.split()[1:5] == ["0", "0", "+0.25", "0"]
    assert line.endswith("outer, 1000 N/mm, 2 m/s, 40 degC")
    (line,) = [line for line in text.splitlines() if line.startswith("  stiffness")]
    assert line.split()[1:4] == ["0", "0", "0"]
    # A quotient of two numbers of this size is right to rounding.
    assert float(found.relative["damping"].sel(contact="outer").max()) == pytest.approx(0.25, rel=1e-12)
    assert np.count_nonzero(found.relative["damping"]) == 1
    (damping,) = [entry for entry in found.differences if entry.variable == "damping"]
    assert damping.place == {"contact": "outer", "load": 1e6, "entrainment_speed": 2.0, "temperature": 313.15}
    assert (damping.points, damping.largest, damping.worst) == (84, pytest.approx(0.25, rel=1e-12), damping.largest)
    assert math.isnan(damping.over_stated) and "none stated" in text  # a formula has no numerical error
    assert found.between is None
    record = json.loads(comparison_json(found))
    (told,) = [entry for entry in record["differences"] if entry["variable"] == "damping"]
    assert told["worst"] == damping.worst and told["over_stated"] is None and record["between"] is None


def test_compare_holds_differences_beside_what_both_maps_state():
    """Films that are 3 % lower in B where both state 1 %, of values of nearly one size: 0.03/(0.01 + 0.01 0.97)."""
    first = made(job_of(), Stated())
    second = first.copy(deep=True)
    second["film_offset"].values *= 0.97
    second["central_film"].values *= 1.001
    found = {entry.variable: entry for entry in compare(first, second, ("a", "b")).differences}
    offset, central = found["film_offset"], found["central_film"]
    # rounding of the quotients
    assert (offset.bias, offset.worst) == (pytest.approx(-0.03, rel=1e-12), pytest.approx(-0.03, rel=1e-12))
    assert (offset.over_stated, offset.beyond_stated) == (pytest.approx(0.03 / 0.0197, rel=1e-12), 1.0)
    assert (central.over_stated, central.beyond_stated) == (pytest.approx(0.001 / 0.02001, rel=1e-9), 0.0)
    text = comparison_text(compare(first, second, ("a", "b")))
    (line,) = [line for line in text.splitlines() if line.startswith("  film_offset")]
    assert "-0.03      -0.03       1.5, 100% > 1" in line


def test_compare_takes_common_points_only():
    first = made(job_of())
    second = made(job_of(SMALL.replace('"1 m/s", "2 m/s"', '"1 m/s", "3 m/s"')))
    assert "56 points in common, 56 of them solved in both (A has 84, B 84)" in comparison_text(
        compare(first, second, ("a", "b"))
    )
    holey = made(job_of(), Holey((job_of().loads[3],)))
    assert "56 points in common, 52 of them solved in both" in comparison_text(compare(holey, second, ("a", "b")))


def test_compare_leaves_zeros_out_and_says_so():
    text = comparison_text(compare(made(job_of(), HertzSolver()), made(job_of()), ("a", "b")))
    assert "damping                   no point to compare  (84 points where A is zero left out)" in text


@pytest.mark.slow
def test_maps_that_share_some_points_or_none_are_compared_between_them():
    """The same formula on other axes. Bar: 1e-3 of a film.

    Of temperatures 20 K apart a reading between them is 1.2 % off, of speeds an octave apart 0.12 %; a quarter and half
    of these distances leave a sixteenth and a quarter, at order two.
    """
    temperatures = '"20 degC", "25 degC", "30 degC", "35 degC", "40 degC"'
    close = SMALL.replace('"20 degC", "40 degC"', temperatures)
    close = close.replace('"0.5 m/s", "1 m/s", "2 m/s"', '"0.5 m/s", "0.7 m/s", "1 m/s", "1.4 m/s", "2 m/s"')
    first = made(job_of(close))
    part = made(job_of(close.replace('"2 m/s"', '"3 m/s"')))
    none = made(job_of(close.replace(temperatures, '"22 degC", "27 degC", "32 degC", "37 degC"')))
    for second, common in ((part, 280), (none, 0)):
        found = compare(first, second, ("a", "b"))
        assert found.common == common and found.between is not None and not found.not_between
        ranges = found.between.ranges
        assert ranges["load"] == (1e3, 1e6) and ranges["entrainment_speed"] == (0.5, 2.0)
        for entry in found.between.differences:
            assert entry.points == 300 and math.isnan(entry.over_stated)
        films = {entry.variable: entry for entry in found.between.differences}
        assert films["film_offset"].largest < 1e-3
        assert 0.0 < films["film_offset"].largest == abs(films["film_offset"].worst)
        assert "rolling_force" not in films  # formulas have none
        text = comparison_text(found)
        assert "300 random points (seed 1) of the common range, 1 N/mm to 1000 N/mm, 0.5 m/s to 2 m/s, " in text
    assert compare(first, none, ("a", "b")).between.differences == found.between.differences
    assert json.loads(comparison_json(found))["between"]["seed"] == 1
    dry = compare(made(job_of(), HertzSolver()), none, ("a", "b")).between
    assert {entry.variable: entry.left_out for entry in dry.differences}["film_offset"] == 300


def test_compare_says_why_nothing_is_compared_between_points():
    holey = made(job_of(fill="none"), Holey(job_of().loads[1:]))
    holey["status"].values[:, 1:] = int(Status.STAGNATED)
    second = made(job_of(SMALL.replace('"1 m/s", "2 m/s"', '"1 m/s", "3 m/s"')))
    found = compare(holey, second, ("a", "b"))
    assert found.between is None and found.common == 56
    assert "nothing is compared between them: a: " in comparison_text(found)
    apart = made(job_of(SMALL.replace('"20 degC", "40 degC"', '"25 degC"')))
    with pytest.raises(MapError, match="a: "):
        compare(holey, apart, ("a", "b"))


def test_compare_looks_between_points_where_both_maps_are_known():
    holey = made(job_of(fill="none"), Holey(job_of().loads[4:]))
    second = made(job_of(SMALL.replace('"1 m/s", "2 m/s"', '"1 m/s", "3 m/s"')))
    found = compare(holey, second, ("a", "b"))
    assert found.between is not None
    reach, places = EHDMap(holey).reach(("inner",)), found.between.places
    ends = [reach.loads_at(float(place["entrainment_speed"]), float(place["temperature"]))[1] for place in places]
    assert 50 < len(places) < 300
    assert all(float(place["load"]) <= end for place, end in zip(places, ends, strict=True))


def test_compare_refuses_maps_without_a_common_contact_or_range():
    first = made(job_of())
    with pytest.raises(MapError, match="contacts are inner, outer and line; allowed: maps that share a contact"):
        compare(first, made(job_of(LINE)), ("a", "b"))
    other = made(job_of(SMALL.replace('"20 degC", "40 degC"', '"50 degC"')))
    with pytest.raises(MapError, match=r"no temperature in common \(2 values, 20 to 40 degC, against 1, 50 degC\)"):
        compare(first, other, ("a", "b"))


ONE_TEMPERATURE = SMALL.replace('"20 degC", "40 degC"', '"20 degC"')
"""Half the panels of the page."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "solver"),
    [
        (ONE_TEMPERATURE.replace(spaced("1 N/mm", "1000 N/mm", 7), '["50 N/mm"]'), None),
        (LINE, HertzSolver()),
        (ONE_TEMPERATURE, Holey((1e3, 1e4, 31622.776601683792), version="1")),
    ],
    ids=["one load", "one contact, dry", "holes"],
)
def test_every_kind_of_map_can_be_drawn(tmp_path, text, solver):
    plot_map(EHDMap(made(job_of(text), solver)), tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_the_page_names_what_it_shows(tmp_path, monkeypatch):
    import matplotlib as mpl

    monkeypatch.setitem(mpl.rcParams, "svg.fonttype", "none")
    plot_map(EHDMap(made(job_of(), Holey((1e6,)))), tmp_path / "a.svg")
    text = (tmp_path / "a.svg").read_text()
    for part in (
        "EHD contact map: NU308, oil FVA3",
        "structural law iso16281",
        "stiffness k, N/(µm mm)",
        "damping c, N s/mm²",
        "central film, µm",
        "entrainment speed, m/s",
        "load, N/mm",
        "20 °C",
        "no solution, filled from neighbours",
        "80 converged, 4 stagnated, 4 filled",
    ):
        assert part in text


def test_a_long_legend_stays_on_the_page():
    """By what is drawn: the right edge in pixels. Versions of the library differ in the width of letters."""
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    figure = Figure(figsize=(11.7, 8.3))
    for words, columns in (("short", {3}), ("asymptote: film thicker than 1 % of the radius " * 2, {1, 2})):
        legend = page_legend(figure, [Line2D([], [], label=words) for _ in range(4)])
        assert legend._ncols in columns and legend.get_window_extent().x1 <= figure.bbox.x1


def test_unmet_bars_are_said_with_what_helps():
    dataset = made(job_of())
    worse = dataset.assign_attrs(law_damping_within_bar=0.98, law_valley_damping_within_bar=0.96)
    missed = "unmet: damping of the contact laws is within its bar at 98.0% of the points over the map; wanted 99%"
    assert unmet(worse, True) == [missed, STANDS_ON_LINES]
    assert unmet(worse, False) == [missed, STANDS_ON_POINTS]
    assert unmet(dataset.assign_attrs(law_refused="holes"), True) == ["no contact law: holes"]
    assert unmet(dataset, True) == unmet(dataset, False) == []


def test_the_check_of_dry_laws_holds_no_numbers_of_nothing(tmp_path):
    generated = generate(job_of(DRY, law_check=20), tmp_path / "dry.nc", workers=1)
    found = {name: value for name, value in generated.dataset.attrs.items() if name.startswith("law_")}
    assert (
        found["law_film_compliance_error"] == found["law_valley_film_compliance_error"] == "none: no film to relate to"
    )
    assert found["law_damping_error"] == "none: no damping above zero to relate to"
    # 1/k and c are held to their second bars, which are no shares of the film's
    assert all(value == 1.0 for name, value in found.items() if name.endswith("_within_bar"))
    for text in (summary(generated, tmp_path / "dry.nc"), describe(EHDMap(generated.dataset), "dry.nc")):
        assert not re.search(r"\bnan\b|e\+\d\d\d", text)


def test_provenance_is_enough_to_know_the_contacts():
    contacts = json.loads(made(job_of()).attrs["contacts"])
    assert [contact["name"] for contact in contacts] == ["inner", "outer"]
    assert contacts[0]["material"] == {"density": 7850.0, "poisson_ratio": 0.3, "youngs_modulus": 210e9}

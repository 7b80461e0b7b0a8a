"""Films and laws straight from the film table: beside the table itself, fresh solves, and laws from solved lines."""

from __future__ import annotations

import json
from dataclasses import replace
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

import ehdmaps
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import MapError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make import law_check
from ehdmaps.jobs.make.generate import Generated, generate, generate_in_memory, not_served
from ehdmaps.jobs.make.law_check import EDGE_SHARE, REFUSED
from ehdmaps.jobs.make.report import films_lines, law_lines
from ehdmaps.jobs.make.table_films import unserved
from ehdmaps.jobs.show.describe import describe
from ehdmaps.maps import schema
from ehdmaps.maps.compilation import OF_TABLE
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.film_field import RIGID
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.table_field import TableField, table_lines
from ehdmaps.physics.catalogue import estimate
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import contact_solution
from ehdmaps.table.checked import FILE, checked_text
from ehdmaps.table.file import CHECKSUM, film_table, shipped_tables
from tests.benchmarks import table_checked

BEARING = estimate("NU206")
CONTACTS = BEARING.contacts(STEEL, "iso16281")
OIL = Lubricant.roelands(density=870.0, viscosity_40=68e-6, viscosity_100=9e-6, pressure_viscosity=19e-9)
RANGES = (200.0, 8e5), (0.1, 8.0), (303.15, 383.15)
FIELD = TableField(CONTACTS, OIL, *RANGES)
SPEEDS, TEMPERATURES = np.array([0.13, 1.1, 6.7]), np.array([305.0, 341.3, 380.0])
LOADS = np.broadcast_to(np.geomspace(250.0, 7e5, 40)[:, None, None], (40, 3, 3)).copy()


def job(**changes: object) -> Job:
    axes = {
        "loads": np.geomspace(*RANGES[0], 12),
        "entrainment_speeds": np.geomspace(*RANGES[1], 5),
        "temperatures": np.linspace(*RANGES[2], 3),
    }
    made = Job.build(lubricant=OIL, bearing=BEARING, structural_law="iso16281", name="nu206", **axes)
    return replace(made, **changes)


def _why(asked: Job) -> str:
    return unserved(asked, solvers.of_map(asked))


def test_films_between_nodes_are_those_of_the_table() -> None:
    """Film offset within 5e-4, the errors of the table; compliances within 2e-3 of that of the whole contact."""
    for contact in CONTACTS:
        offset, compliance, _ = FIELD.films(contact.name, LOADS, SPEEDS, TEMPERATURES)
        u, T = np.meshgrid(SPEEDS, TEMPERATURES, indexing="ij")
        read = film_table(OIL).films(contact, OIL, LOADS, u, T, others=False, thickest_film=np.inf)
        np.testing.assert_allclose(offset, read.film_offset, rtol=5e-4)
        whole = contact.structural_compliance(LOADS) + read.film_compliance
        assert np.max(np.abs(compliance - read.film_compliance) / whole) < 2e-3


def test_the_film_compliance_is_the_derivative_of_the_film_offset() -> None:
    """Central differences with a step of 1e-4 of the load are wrong by 1e-6 of the film's slope at most."""
    step = 1e-4
    (heavier, *_), (lighter, *_) = (FIELD.films("inner", LOADS * x, SPEEDS, TEMPERATURES) for x in (1 + step, 1 - step))
    offset, compliance, loss = FIELD.films("inner", LOADS, SPEEDS, TEMPERATURES)
    slope = -(heavier - lighter) / (2.0 * step * LOADS)
    assert np.max(np.abs(slope - compliance) * LOADS / offset) < 1e-5
    assert np.all(loss > 0.0)


def test_lines_go_on_smoothly_above_the_map() -> None:
    """Beyond the highest load films go on straight in logarithms: no jump, and no kink, where the map ends."""
    loads = np.geomspace(6e5, 1.2e6, 400)[:, None, None]
    offset, compliance, loss = FIELD.films("outer", loads, SPEEDS[1:2], TEMPERATURES[1:2])
    for values in (np.log(offset), compliance * loads / offset, np.log(loss)):
        second = np.diff(values[:, 0, 0], 2)
        assert np.max(np.abs(second)) < 1e-4


def test_films_that_the_table_does_not_have_are_told() -> None:
    # L above 150: a cold oil at a speed that no bearing has
    field = TableField(CONTACTS, OIL, RANGES[0], (0.1, 5e5), RANGES[2])
    with pytest.raises(MapError, match=r"film table: .* at .* N/mm, .* m/s, .* degC; have the films solved"):
        field.films("inner", LOADS[:, :1, :1], np.array([5e5]), np.array([303.15]))
    assert _why(job(entrainment_speeds=(0.1, 5e5))).startswith("film table: ")
    assert _why(job(loads=(1e3,), entrainment_speeds=(1.0,), temperatures=(320.0,))) != ""


@pytest.mark.slow
def test_a_law_of_the_table_is_that_of_fresh_solves() -> None:
    """k within 0.1 % and c within 5 % of max(c, 0.02 k b/u), the bars of laws whose films are read."""
    contact = CONTACTS[1]
    law = ContactLaw("outer", (contact,), OIL, FIELD, "error", OF_TABLE)
    random, solver = np.random.default_rng(8), ReynoldsSolver(density=14.0, inlet_length=700.0)
    wrong_k, wrong_c = [], []
    for _ in range(40):
        w, u = np.exp(random.uniform(np.log([3e2, 0.1]), np.log([5e5, 8.0]))).tolist()
        T = float(random.uniform(*RANGES[2]))
        (film,) = solver.solve_line(contact, OIL, (w,), u, T)
        solved = contact_solution(film, contact, OperatingPoint(w, u, T))
        _, k, c = law(solved.approach, 0.0, u, T)
        unit = 0.02 * solved.stiffness * float(half_width(w, contact.radius, contact.reduced_modulus)) / u
        wrong_k.append(abs(float(k) / solved.stiffness - 1.0))
        wrong_c.append(abs(float(c) - max(solved.damping, 0.0)) / max(solved.damping, unit))
    assert np.quantile(wrong_k, 0.95) < 1e-3
    assert np.quantile(wrong_c, 0.95) < 0.05


@pytest.mark.slow
def test_a_map_of_the_table_has_no_lines_and_all_laws(tmp_path: Path) -> None:
    checked = job(law_check=20)
    assert _why(checked) == ""
    plain = generate(checked, tmp_path / "plain.nc", workers=1)
    assert plain.sweep.solved == 0  # its laws are held against the table, which was held against fresh solves
    told = "\n".join([*law_lines(plain.dataset), *films_lines(plain.dataset)])
    assert "at random points against the film table" in told and "against fresh solves at 1200 random points" in told
    assert plain.dataset.attrs["law_damping_within_bar"] == 1.0
    made = generate(checked, tmp_path / "nu206.nc", workers=1, check=True)
    assert made.backbone is None
    # the check of its laws, within the map and beyond both kinds of edges, and nothing else
    assert made.sweep.solved == 20 + 2 * round(EDGE_SHARE * 20)
    emap = open_map(tmp_path / "nu206.nc")
    assert emap.from_table and emap.known_between
    attributes = emap.dataset.attrs
    assert attributes["law_film_compliance_within_bar"] == attributes["law_damping_within_bar"] == 1.0
    assert f"films: {checked.points} points read from the film table, as the films of the laws are; none solved" in (
        describe(emap, "nu206.nc")
    )
    assert emap.low_loads is not None and emap.low_loads.guessed == 0.0
    for kind in ("series", "inner", "outer"):
        law = emap.law(kind, "asymptote")  # type: ignore[arg-type]
        w, k, c = law(np.linspace(-1e-6, 20e-6, 50), 0.0, 2.0, 330.0)
        assert np.all(np.diff(w) > 0.0) and np.all(k > 0.0) and np.all(c > 0.0)
    tampered = EHDMap(emap.dataset.assign_attrs({schema.FILM_TABLE: "0"}), None)
    with pytest.raises(MapError, match="was changed"):
        tampered.dataset.to_netcdf(tmp_path / "other.nc")
        open_map(tmp_path / "other.nc")


@pytest.mark.slow
def test_the_record_of_the_release_is_what_a_check_finds() -> None:
    """The bound, 5 % of each quantile: round-off of solves whose Newton steps end at 1e-6 or so of a film."""
    record = json.loads((resources.files("ehdmaps.table") / FILE).read_text())
    name, made = next(iter(table_checked.jobs()))
    row, found = record["maps"][name], table_checked.checked(made)
    assert row.keys() == found.keys()
    for key, value in found.items():
        if key.endswith("_error"):
            assert numbers(value) == pytest.approx(numbers(row[key]), rel=0.05), key
        else:
            assert value == row[key]


def numbers(text: str) -> list[float]:
    """Median, quantiles and largest of an attribute."""
    return [float(part.split()[-1]) for part in text.split(",")]


def test_the_shipped_table_has_a_record() -> None:
    checksum = shipped_tables().attributes[CHECKSUM]
    assert "1200 random points of 12 maps" in checked_text(checksum)
    assert checked_text("of another table") == ""


@pytest.mark.parametrize(("misses", "served"), [(0, True), (2, True), (4, True), (8, False)])
def test_a_map_is_not_solved_for_misses_that_chance_has(misses, served, monkeypatch) -> None:
    """Of films that miss a bar at 1 % of all points, 4 and more of 100 points miss it once in 54 draws, 8 in 1e5."""
    rows = [(None, None, "", number < misses) for number in range(100)]
    monkeypatch.setattr(law_check, "_between", lambda *_: iter(rows))
    assert law_check.films_met(None, None, {}) is served


@pytest.mark.slow
def test_a_map_in_memory_is_read_and_one_that_is_to_be_solved_is_its_points() -> None:
    """As a file would be: without one, a user waited for solves of all points."""
    job = Job.build(
        bearing=BEARING,
        lubricant=OIL,
        loads=(1e3, 1e4, 1e5),
        entrainment_speeds=(1.0, 3.0),
        temperatures=(313.15, 333.15),
    )
    read = ehdmaps.generate(job)
    assert schema.FILM_TABLE in read.attrs
    load, stiffness, damping = EHDMap(read).law("series")(4e-6, 0.0, 2.0, 320.0)
    assert load > 0.0 and stiffness > 0.0 and damping > 0.0
    solved = ehdmaps.generate(replace(job, solver_options={"films": "solved"}))
    assert schema.FILM_TABLE not in solved.attrs and schema.UNSERVED not in solved.attrs
    assert EHDMap(solved).backbone is None


def small() -> Job:
    return job(loads=(1e4, 1e5), entrainment_speeds=(1.0, 2.0), temperatures=(330.0, 340.0), law_check=5)


@pytest.fixture(scope="module")
def solved() -> Generated:
    """A map by solved lines, which takes seconds."""
    return generate_in_memory(replace(small(), solver_options={"films": "solved"}), workers=1)


@pytest.mark.slow
def test_memory_layers_and_rolling_forces_of_the_table_are_those_of_solved_lines(solved: Generated) -> None:
    """Rolling force, mass flow and layers within 1 %: lines read and lines solved. Factors of locked films are fits, no
    closer than the stated errors of the responses ask: within 12 %."""
    read = generate_in_memory(replace(small(), solver_options={"films": "table"}), workers=1)
    maps = EHDMap(read.dataset, read.backbone), EHDMap(solved.dataset, solved.backbone)
    assert maps[0].from_table and not maps[1].from_table
    layered = [emap.law("inner", supply=OilSupply(2e-7)) for emap in maps]
    delta = np.linspace(1e-6, 2.5e-6, 20)
    for one, other in zip(layered[0](delta, 0.0, 1.3, 333.0), layered[1](delta, 0.0, 1.3, 333.0), strict=True):
        np.testing.assert_allclose(one, other, rtol=0.01)
    flooded = [emap.law("inner") for emap in maps]
    factors = [law.locked_factors(1.3, 333.0)[2] for law in flooded]
    np.testing.assert_allclose(*factors, rtol=0.12)
    rolling = [emap.rolling_film for emap in maps]
    for name in ("rolling_force", "mass_flow"):
        loads = np.geomspace(2.0, 9e4, 9)
        np.testing.assert_allclose(*(getattr(film, name)("inner", loads, 1.3, 333.0) for film in rolling), rtol=0.01)


def test_lines_of_the_table_reach_down_to_rigid_films() -> None:
    lines, reference = table_lines(CONTACTS, OIL, *RANGES)
    assert reference.radius == CONTACTS[0].radius
    assert set(np.unique(lines["status"])) <= {0, 1, schema.NOT_NEEDED}
    assert lines["zeta"][0] <= RIGID
    known = np.isfinite(lines["film_compliance_real"]).all(axis=-1)
    np.testing.assert_array_equal(known, lines["status"] != schema.NOT_NEEDED)


def test_films_that_no_newtonian_oil_has_are_told() -> None:
    """As the solver tells it, beside the pressure at the same place: a cold loaded contact, and a warm one."""
    contact = CONTACTS[0]
    for w, u, T, told in ((2e5, 3.0, 303.15, True), (2e4, 0.5, 380.0, False)):
        (solved,) = ReynoldsSolver().solve_line(contact, OIL, (w,), u, T)
        read = film_table(OIL).films(contact, OIL, w, u, T)
        for reason in (solved.reason, str(read.reason)):
            assert ("no oil is Newtonian there" in reason) == told, reason


def test_a_map_of_an_isoviscous_oil_makes_laws() -> None:
    thin = Lubricant.barus(viscosity=2e-3, pressure_viscosity=0.0, density=870.0)
    made = generate_in_memory(job(lubricant=thin, law_check=0, solver_options={"films": "table"}), workers=1)
    emap = EHDMap(made.dataset)
    assert emap.from_table and emap.lubricant == thin
    w, k, c = emap.law("inner", "clamp")(5e-6, 0.0, 2.0, 330.0)
    assert w > 0.0 and k > 0.0 and c > 0.0


def test_why_a_map_is_solved_is_what_its_check_found() -> None:
    """Solves of nine thousand points were blamed on bars that no law had missed: there was none."""
    assert not_served({REFUSED: "the reason"}) == "film table: makes no law (the reason)"
    assert "miss their bars" in not_served({})


@pytest.mark.slow
def test_a_map_whose_films_miss_their_bars_is_solved(monkeypatch: pytest.MonkeyPatch, solved: Generated) -> None:
    monkeypatch.setattr("ehdmaps.jobs.make.generate._served", lambda *_: False)
    made = generate_in_memory(small(), workers=1)
    assert made.backbone is not None and schema.FILM_TABLE not in made.dataset.attrs
    assert "miss their bars" in made.dataset.attrs[schema.UNSERVED]
    assert not EHDMap(made.dataset, made.backbone).from_table
    assert made.dataset.drop_vars("solve_seconds").equals(solved.dataset.drop_vars("solve_seconds"))
    assert made.backbone is not None and made.backbone.equals(solved.backbone)

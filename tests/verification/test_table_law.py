"""Contact laws from the film table beside laws from solved lines, and the table as a solver beside `reynolds`."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import ehdmaps
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.report import films_lines
from ehdmaps.jobs.solvers import build
from ehdmaps.jobs.table_law import law
from ehdmaps.jobs.tolerance import check_tolerance
from ehdmaps.maps.emap import open_map
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.table.solver import TableSolver
from mbs import assemble, read_scene, statics
from mbs.cli import main
from tests.cases.jobs import FINE
from tests.conftest import made_map

OIL = Lubricant.named("FVA3")
LINE = LineContact("line", 6e-3, STEEL, "half_space", reference_depth=6e-3)
narrow_law = partial(law, LINE, OIL, loads=(2e3, 4e5), entrainment_speeds=(0.5, 3.0), temperatures=(320.0, 345.0))


@pytest.mark.slow
def test_a_law_from_the_table_is_that_from_solved_lines() -> None:
    """Load within 0.05 %, stiffness too at 99 of 100 points and within 0.15 % at all; damping within 2 % of itself or
    of 0.02 k b/u: the errors of the table. The largest are those of the mapping of FVA 3, see its benchmark."""
    read, solved = narrow_law(outside="clamp"), narrow_law(outside="clamp", solver=ReynoldsSolver())
    random = np.random.default_rng(4)
    n = 400
    delta = random.uniform(0.0, 20e-6, n)
    u, T = np.exp(random.uniform(np.log(0.5), np.log(3.0), n)), random.uniform(320.0, 345.0, n)
    (w, k, c), (w0, k0, c0) = read(delta, 0.0, u, T), solved(delta, 0.0, u, T)
    within = (w0 > 2e3) & (w0 < 4e5)
    assert np.count_nonzero(within) > 100
    assert np.max(np.abs(w / w0 - 1.0)[within]) < 5e-4
    assert np.quantile(np.abs(k / k0 - 1.0)[within], 0.99) < 5e-4
    assert np.max(np.abs(k / k0 - 1.0)[within]) < 1.5e-3
    half = np.sqrt(8.0 * w0 * LINE.radius / (np.pi * LINE.reduced_modulus))
    wrong = np.abs(c - c0) / np.maximum(c0, 0.02 * k0 * half / u)
    assert np.quantile(wrong[within], 0.95) < 0.02


def test_a_kind_that_there_is_not_is_refused() -> None:
    with pytest.raises(InputError, match="kind: got 'series'; allowed: line"):
        narrow_law(kind="series")
    with pytest.raises(InputError, match="kind: got 'line'; allowed: series, inner, outer"):
        ehdmaps.law(ehdmaps.BearingGeometry.named("NU308"), OIL, "line")


@pytest.mark.slow
def test_a_machine_runs_on_the_table_as_on_a_map(reynolds_map: str) -> None:
    """Stiffness within 0.1 % and damping within 2 %: the errors of table and map."""
    scene = read_scene("nu308_rigid")
    read, solved = statics(assemble(scene, "table")), statics(assemble(scene, "map", reynolds_map))
    assert read.model.label == "film table"
    assert solved.model.label == "Reynolds map"
    for name, bound in (("stiffness", 1e-3), ("damping", 0.02)):
        one, other = (found.dataset[f"bearing_{name}"].values[:, :2, :2] for found in (read, solved))
        assert np.max(np.abs(one - other)) < bound * np.max(np.abs(other))


@pytest.mark.slow
@pytest.mark.parametrize("speed", ["1500 rpm", "0 rpm"])
def test_a_bearing_has_films_without_a_map(speed: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bearing", "NU308", "--law", "table", "--load", "5 kN", "--speed", speed]) == 0
    head = capsys.readouterr().out.splitlines()[0]
    assert head == "NU308: law film table, FVA3; films of the map, FVA3, flooded"


def test_what_the_law_of_the_table_needs(small_map: str, capsys: pytest.CaptureFixture[str]) -> None:
    bare = replace(read_scene("nu308_rigid"), lubricant=None)
    with pytest.raises(InputError, match=r"--law: got 'table', but nu308_rigid has no \[lubricant\]; add the table"):
        assemble(bare, "table")
    with pytest.raises(InputError, match="--law: got 'table', but nu308_rigid has no bearings; leave it out"):
        assemble(replace(bare, lubricant=OIL, elements=()), "table")
    asked = ["bearing", "NU308", "--law", "table", "--map", small_map, "--load", "5 kN", "--speed", "800 rpm"]
    assert main(asked) == 2
    assert "--law: got 'table' with a map; allowed: hertz or map with --map" in capsys.readouterr().err


def test_the_table_as_a_solver_reads_what_it_knows_and_has_the_rest_solved() -> None:
    """Films within a per mille; a load beyond its pressures is refused by the other solver's words."""
    reynolds = ReynoldsSolver()
    loads = (5e3, 1e5, 5e7)
    read = TableSolver(reynolds).line_spectra(LINE, OIL, loads, 1.5, 330.0)
    solved = reynolds.line_spectra(LINE, OIL, loads, 1.5, 330.0)
    for one, other in zip(read[:2], solved[:2], strict=True):
        assert one.film.iterations == 0
        assert one.film.film_offset == pytest.approx(other.film.film_offset, rel=1e-3)
        assert one.film.rolling_force == pytest.approx(other.film.rolling_force, rel=5e-3)
        assert np.allclose(one.frequencies, other.frequencies, rtol=1e-3)
        assert np.allclose(one.compliance, other.compliance, rtol=0.02)
    assert read[2].film.status == solved[2].film.status
    assert read[2].film.reason == solved[2].film.reason
    assert "film_table" in TableSolver(reynolds).settings()
    assert TableSolver(reynolds).solve_line(LINE, OIL, loads, 1.5, 330.0)[0] == read[0].film


def test_films_with_heat_are_all_solved() -> None:
    """The table knows none of them."""
    warm = ReynoldsSolver(physics="inlet-heat")
    (film,) = TableSolver(warm).solve_line(LINE, OIL, (1e5,), 1.5, 330.0)
    (same,) = warm.solve_line(LINE, OIL, (1e5,), 1.5, 330.0)
    assert film.film_offset == same.film_offset


READ = FINE.replace('name = "reynolds"\n', 'name = "reynolds"\nfilms = "table"\n').replace(
    "law_check = 0", "law_check = 40"
)


@pytest.mark.slow
def test_a_map_with_films_from_the_table_is_that_of_solved_films(reynolds_map: str, tmp_path: Path) -> None:
    """Within the errors that both state; its laws are checked by fresh solves."""
    read, solved = open_map(made_map(tmp_path, READ, statuses=(0, 1))).dataset, open_map(reynolds_map).dataset
    assert read.attrs["films_read"] > 4 * read.attrs["films_solved"] > 0
    assert "films_read" not in solved.attrs
    usable = (read["status"] <= 1) & (solved["status"] <= 1)
    assert float(usable.mean()) > 0.95
    for name in ("central_film", "film_offset"):
        apart = np.abs(read[name] / solved[name] - 1.0)
        stated = np.abs(read[f"{name}_error"]) + np.abs(solved[f"{name}_error"])
        assert float((apart <= stated).where(usable).mean()) > 0.95
        assert float(apart.where(usable).median()) < 1e-3  # the grid of the map that was solved
    settings = json.loads(read.attrs["solver_settings"])
    assert settings["density"] == 10.0 and "film_table" in settings
    (line,) = films_lines(read)
    assert line.startswith(f"films: {read.attrs['films_read']} of points and lines read from the film table")
    assert not list(films_lines(solved))


def test_a_tolerance_and_films_with_heat_take_no_table(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'tolerance: the job has \[solver\] films = "table"'):
        check_tolerance(parse_job(READ, "a", "a.toml"), TableSolver(ReynoldsSolver()), 0.01)
    words = r"\[solver\] films: got 'table'; film table: knows nothing of heat in the film \(physics = thermal\)"
    with pytest.raises(InputError, match=words):
        build("reynolds", {"films": "table", "physics": "thermal"})

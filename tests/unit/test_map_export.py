"""Curves of a map as a table, and what `solve` says about errors and extrapolation."""

from __future__ import annotations

import csv
import json

import netCDF4
import numpy as np
import pytest

from ehdmaps.jobs.cli import main
from ehdmaps.jobs.make.generate import generate
from ehdmaps.jobs.reader import parse_job
from ehdmaps.maps.emap import open_map
from ehdmaps.physics.closed_form import FormulaSolver, HertzSolver
from tests.cases.jobs import LINE, SMALL


class WithBackbone(FormulaSolver):
    """Closed formulas that ask for a backbone."""

    wants_backbone = True


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("export") / "map.nc"
    generate(parse_job(SMALL, "map", "map.toml"), path, workers=1, solver=WithBackbone())
    return path


def rows(path):
    """Comment, header and numbers of a table."""
    with path.open(newline="") as file:
        comment = file.readline()
        header, *lines = csv.reader(file)
    return comment, header, np.array(lines, dtype=float)


@pytest.mark.parametrize("contact", ["series", "inner"])
def test_the_table_holds_the_curves_of_the_law(path, tmp_path, capsys, contact):
    out = tmp_path / "curves.csv"
    options = ["--speed", "0.7 m/s", "--temperature", "35 degC", "--contact", contact, "--points", "40"]
    assert main(["export", str(path), "-o", str(out), *options]) == 0
    assert capsys.readouterr().out == f"{out}: written\n"
    comment, header, numbers = rows(out)
    assert comment.startswith("# made by ehdmaps: map.nc, EHD map of NU308, FVA3")
    names = ["entrainment_speed [m/s]", "temperature [K]", "load [N/m]", "approach [m]", "film_offset [m]"]
    films = [] if contact == "series" else ["central_film [m]", "minimum_film [m]"]
    assert header == [*names, "stiffness [N/m2]", "damping [N s/m2]", *films]
    assert numbers.shape == (40, len(header))
    u, T, load, approach, _, stiffness, damping = numbers.T[:7]
    assert (u == 0.7).all() and (T == 308.15).all()
    assert (load[0], load[-1]) == (1e3, 1e6)
    w, k, c = open_map(path).law(contact)(approach, 0.0, u, T)
    # 1e-4, 1e-3, 1e-2: tabulation of the law, largest next to the lowest loads
    np.testing.assert_allclose(w[1:-1], load[1:-1], rtol=1e-4)
    np.testing.assert_allclose(k[1:-1], stiffness[1:-1], rtol=1e-3)
    np.testing.assert_allclose(c[1:-1], damping[1:-1], rtol=1e-2)


def test_the_whole_map_is_exported_and_its_films_are_those_of_its_points(path, tmp_path):
    out = tmp_path / "curves.csv"
    assert main(["export", str(path), "-o", str(out), "--contact", "outer", "--points", "7"]) == 0
    _, _, numbers = rows(out)
    dataset = open_map(path).dataset.sel(contact="outer").transpose("temperature", "entrainment_speed", "load")
    assert len(numbers) == dataset["status"].size
    for column, name in ((7, "central_film"), (8, "minimum_film")):
        # round-off of the logarithms, and ten digits
        np.testing.assert_allclose(numbers[:, column], dataset[name].values.ravel(), rtol=1e-9)


@pytest.mark.parametrize("solver", [FormulaSolver(), HertzSolver()])
def test_a_bare_contact_and_a_standstill(tmp_path, solver):
    path = tmp_path / "line.nc"
    generate(parse_job(LINE, "line", "line.toml"), path, workers=1, solver=solver)
    assert main(["export", str(path), "--points", "5"]) == 0
    _, header, numbers = rows(tmp_path / "line.csv")
    assert "minimum_film [m]" in header
    still = numbers[numbers[:, 0] == 0.0]
    assert len(still) == 5 and (still[:, [4, 6, 7, 8]] == 0.0).all() and (still[:, 5] > 0.0).all()
    moving = numbers[numbers[:, 0] == 1.0]
    assert ((moving[:, 7] > 0.0) == isinstance(solver, FormulaSolver)).all()


def test_what_cannot_be_exported_is_told(path, tmp_path, capsys):
    options = ["--speed", "9 m/s", "--temperature", "warm", "--contact", "line", "--points", "1"]
    assert main(["export", str(path), "-o", str(tmp_path / "a.csv"), *options]) == 2
    told = capsys.readouterr().err
    for part in (
        "4 problems",
        "--speed: got '9 m/s'; allowed in this map: 0.5 m/s to 2 m/s",
        "--temperature: got 'warm'",
        "--contact: got 'line'; allowed in this map: series, inner, outer",
        "--points: got 1; allowed: 2 to 1024",
    ):
        assert part in told
    (tmp_path / "mine.csv").write_text("1,2\n")
    for name in ("mine.csv", "a.txt"):
        assert main(["export", str(path), "-o", str(tmp_path / name)]) == 2
        assert f"{tmp_path / name}" in capsys.readouterr().err
    assert (tmp_path / "mine.csv").read_text() == "1,2\n"


def test_texts_are_characters_that_old_programs_read(path):
    with netCDF4.Dataset(path) as file:
        file.set_auto_chartostring(False)
        for name in ("contact", "reason"):
            assert file[name].dtype == np.dtype("S1")
            assert file[name].dimensions[-1] == f"{name}_length"
            assert file[name].getncattr("_Encoding") == "utf-8"
        assert bytes(file["contact"][1].tobytes()) == b"outer"
    assert open_map(path).dataset["contact"].values.tolist() == ["inner", "outer"]


def test_solve_tells_that_no_error_is_stated_and_extrapolation(capsys):
    point = ["--load", "300 N/mm", "--speed", "1 m/s", "--temperature", "40 degC"]
    assert main(["solve", "nu308", "--solver", "hertz", *point, "--json"]) == 0
    for record in json.loads(capsys.readouterr().out):
        assert record["central_film_error"] is record["minimum_film_error"] is record["max_pressure_error"] is None
    assert main(["solve", "nu308", "--solver", "formula", *point]) == 0
    printed = capsys.readouterr().out
    assert "  error of damping                       none stated   none stated\n" in printed
    assert main(["solve", "nu308", "--solver", "formula", *point, "--frequency", "1 Hz", "10 Hz", "2"]) == 0
    over_frequency = capsys.readouterr().out
    assert over_frequency.count(" none stated") == 12 and "nan" not in over_frequency
    for name in ("inner", "outer"):
        assert f"  {name}: viscosity extrapolated: pressure above 0.6 GPa, the reach that is assumed" in printed
    assert "  error of max pressure " in printed
    assert main(["solve", "nu308", "--solver", "formula", "--load", "3 N/mm", *point[2:]]) == 0
    assert "extrapolated" not in capsys.readouterr().out

"""The command line as a person or a script meets it."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from ehdmaps import errors
from ehdmaps.jobs import cli, solvers
from ehdmaps.maps.emap import open_map
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.solution import FilmSolution, Status
from tests.cases.jobs import map_job, spaced

TEXT = map_job(spaced("1 N/mm", "1000 N/mm", 6), '["0.5 m/s", "1 m/s"]', '["40 degC", "60 degC"]')
COLD = TEXT.replace("1 N/mm", "0.1 N/mm").replace('"40 degC"', '"0 degC", "40 degC"')
POINT = ["--load", "40 N", "--length", "0.45 mm", "--speed", "3.297 m/s", "--temperature", "40 degC"]
TIMES = ["solve_seconds"]


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(Path(errors.__file__).parents[1]))  # for commands in their own process
    (tmp_path / "mine.toml").write_text(TEXT)
    return tmp_path


def run(capsys, *arguments):
    """Return exit status, stdout and stderr of a command."""
    status = cli.main(arguments)
    captured = capsys.readouterr()
    return status, captured.out, captured.err


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_generate_takes_several_jobs_and_looks_at_all_of_them_first(here, capsys):
    (here / "other.toml").write_text(TEXT.replace("NU308", "N1014"))
    status, _, err = run(capsys, "generate", "mine.toml", "nowhere.toml", "mine.toml", "-o", "one.nc")
    assert status == 2
    assert "-o: stands beside several jobs; allowed: with one" in err
    assert "nowhere.toml" in err
    status, _, err = run(capsys, "generate", "mine.toml", "mine.toml")
    assert "mine.toml: its map mine.nc is that of another job, too" in err
    assert names(here) == ["mine.toml", "other.toml"]
    status, out, _ = run(capsys, "generate", "mine.toml", "other.toml", "--workers", "1")
    assert status == 0
    assert [open_map(name).bearing.name for name in ("mine.nc", "other.nc")] == ["NU308", "N1014"]
    assert out.count("solved now, 0 without a solution") == 2
    status, _, err = run(capsys, "generate", "mine.nc", "other.toml")
    assert "mine.nc is a map itself; give its job" in err


def test_generate_show_plot_compare(here, capsys):
    status, out, err = run(capsys, "generate", "mine.toml", "--workers", "1")
    assert status == 0
    assert "points: 0 taken over, 48 solved now, 0 without a solution" in out
    assert err.splitlines()[0] == "0 of 48 points taken over"
    assert names(here) == ["mine.nc", "mine.nc.log", "mine.nc.store", "mine.toml"]

    status, out, _ = run(capsys, "show", "mine.nc")
    assert (status, out.splitlines()[0]) == (0, "EHD map of NU308, FVA3, by the solver formula")

    status, out, _ = run(capsys, "plot", "mine.nc")
    assert (status, out) == (0, "mine.png: written\n")
    status, out, _ = run(capsys, "plot", "mine.nc", "-o", "page.pdf")
    assert (status, (here / "page.pdf").read_bytes()[:4]) == (0, b"%PDF")

    assert run(capsys, "generate", "mine.toml", "-o", "dry.nc", "--solver", "hertz", "--workers", "1")[0] == 0
    status, out, _ = run(capsys, "compare", "mine.nc", "dry.nc")
    assert status == 0
    assert "48 points in common, 48 of them solved in both" in out
    status, out, _ = run(capsys, "compare", "mine.nc", "dry.nc", "--json")
    record = json.loads(out)
    assert (status, record["solved"], record["differing"]) == (0, 48, ["solver", "solver_settings"])
    (film,) = [entry for entry in record["differences"] if entry["variable"] == "film_offset"]
    assert (film["bias"], film["worst"], film["largest"]) == (-1.0, -1.0, 1.0)  # the dry map has no film


def test_generate_goes_on_and_fresh_begins_again(here, capsys):
    run(capsys, "generate", "mine.toml", "--workers", "1")
    first = open_map(here / "mine.nc").dataset
    assert "48 taken over, 0 solved now" in run(capsys, "generate", "mine.toml", "--workers", "1")[1]
    xr.testing.assert_identical(open_map(here / "mine.nc").dataset.drop_attrs(), first.drop_attrs())
    assert "0 taken over, 48 solved now" in run(capsys, "generate", "mine.toml", "--workers", "1", "--fresh")[1]


def test_a_changed_job_solves_only_what_is_new(here, capsys):
    run(capsys, "generate", "mine.toml", "--workers", "1")
    (here / "mine.toml").write_text(TEXT.replace('"60 degC"', '"60 degC", "80 degC"').replace("iso16281", "palmgren"))
    assert "48 taken over, 24 solved now" in run(capsys, "generate", "mine.toml", "--workers", "1")[1]


@pytest.mark.slow
def test_a_map_alone_repeats_itself(here, capsys):
    run(capsys, "generate", "mine.toml", "-o", "a.nc", "--solver", "hertz")
    (here / "mine.toml").unlink()
    assert run(capsys, "generate", "a.nc", "-o", "again.nc", "--workers", "1")[0] == 0
    first, again = open_map(here / "a.nc").dataset, open_map(here / "again.nc").dataset
    assert again.attrs["solver"] == "hertz"
    xr.testing.assert_identical(again.drop_vars(TIMES).drop_attrs(), first.drop_vars(TIMES).drop_attrs())
    assert {key for key in first.attrs if first.attrs[key] != again.attrs[key]} <= {"created"}
    status, _, err = run(capsys, "generate", "a.nc")
    assert status == 2
    assert "-o: missing; a.nc is a map itself" in err


class Light(FormulaSolver):
    """The formula solver, giving up above 100 N/mm."""

    def solve_line(self, contact, lubricant, loads, *further, **options):
        films = super().solve_line(contact, lubricant, loads, *further, **options)
        lost = FilmSolution(Status.OUTSIDE_VALIDITY, "too heavy")
        return tuple(lost if load > 1e5 else film for load, film in zip(loads, films, strict=True))


def test_points_without_a_solution_make_status_1(here, capsys, monkeypatch):
    monkeypatch.setattr(solvers, "build", lambda *_: Light())
    status, out, _ = run(capsys, "generate", "mine.toml", "--workers", "1")
    assert status == 1
    assert "16 without a solution" in out
    assert "outside_validity       16   33.33 %" in out
    assert "16 x too heavy" in out
    assert int(np.isnan(open_map(here / "mine.nc").dataset["stiffness"].values).sum()) == 16


@pytest.mark.parametrize("command", ["generate", "check"])
def test_bad_input_lists_everything_and_writes_nothing(here, capsys, command):
    (here / "mine.toml").write_text(TEXT.replace("NU308", "NU3").replace("FVA3", "FVA9").replace("1 N/mm", "1 N"))
    status, out, err = run(capsys, command, "mine.toml")
    assert (status, out) == (2, "")
    assert err.startswith(f"ehdmaps {command}: 3 problems\n")
    for part in ("NU3", "FVA9", "got the unit 'N'"):
        assert part in err
    assert names(here) == ["mine.toml"]


@pytest.mark.parametrize(
    ("output", "message"),
    [
        ("missing/a.nc", "missing is no folder"),
        ("mine.toml/a.nc", "mine.toml is no folder"),
        (".", "a folder; allowed"),
    ],
)
def test_an_output_that_cannot_be_written(here, capsys, output, message):
    status, _, err = run(capsys, "generate", "mine.toml", "-o", output)
    assert (status, names(here)) == (2, ["mine.toml"])
    assert message in err


@pytest.mark.parametrize("name", ["a\rb", "a\u2028b", "a\x1b[31mb"])
def test_a_job_whose_name_no_map_can_carry_is_refused_at_once(here, capsys, name):
    (here / "mine.toml").rename(here / f"{name}.toml")
    for command in (["generate"], ["generate", "-o", "good.nc"], ["check"]):
        status, out, err = run(capsys, *command, f"{name}.toml")
        assert (status, out, names(here)) == (2, "", [f"{name}.toml"])
        assert f"is called {name!r}; allowed: printable characters, which its map can carry; rename it" in err


def test_a_backslash_in_a_name_is_refused_at_once(here, capsys):
    (here / "mine.toml").rename(here / "a\\b.toml")
    (here / "c\\d").mkdir()
    before = names(here)
    for command in (["generate"], ["generate", "-o", "c\\d/e.nc"]):
        status, out, err = run(capsys, *command, "a\\b.toml")
        assert (status, out, names(here)) == (2, "", before)
        assert "allowed: no backslash in names of files and folders" in err
    status, _, _ = run(capsys, "generate", "a\\b.toml", "-o", "good.nc", "--workers", "1")
    assert status == 0 and open_map("good.nc").dataset.attrs["job_name"] == "a\\b"


def test_two_runs_of_a_job_have_one_checksum(here, capsys):
    text = map_job(spaced("1 N/mm", "100 N/mm", 3), '["0.5 m/s"]', '["40 degC"]', solver="reynolds")
    (here / "solved.toml").write_text(f'{text}backbone = "none"\nfilms = "solved"\n')
    sums = []
    for name in ("one.nc", "two.nc"):
        assert run(capsys, "generate", "solved.toml", "-o", name, "--workers", "1")[0] == 0
        sums.append(open_map(name).dataset)
    assert sums[0]["solve_seconds"].values.tolist() != sums[1]["solve_seconds"].values.tolist()
    assert sums[0].attrs["content_sha256"] == sums[1].attrs["content_sha256"]


def test_a_folder_is_no_map_to_look_for(here, capsys):
    status, _, err = run(capsys, "status", "mine.toml", "-o", ".")
    assert status == 2
    assert "-o: got ., which is a folder; allowed: a map; a folder goes with a batch" in err


def test_a_broken_store_leaves_the_good_map_alone(here, capsys):
    run(capsys, "generate", "mine.toml", "--workers", "1")
    good = (here / "mine.nc").read_bytes()
    with (here / "mine.nc.store").open("r+b") as store:  # its header is whole
        store.seek(4096)
        store.write(b"garbage" * 1000)
    status, _, err = run(capsys, "generate", "mine.toml", "--workers", "1")
    assert status == 2
    assert "is not a readable store" in err and "--fresh" in err
    assert (here / "mine.nc").read_bytes() == good
    assert run(capsys, "generate", "mine.toml", "--workers", "1", "--fresh")[0] == 0


def test_a_full_disk_while_the_map_is_written(here, capsys, monkeypatch):
    run(capsys, "generate", "mine.toml", "--workers", "1")
    good = (here / "mine.nc").read_bytes()

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(xr.Dataset, "to_netcdf", full)
    status, _, err = run(capsys, "generate", "mine.toml", "--workers", "1", "--fresh")
    assert status == 2
    assert "No space left on device" in err
    assert (here / "mine.nc").read_bytes() == good
    monkeypatch.undo()
    monkeypatch.chdir(here)
    assert "48 taken over, 0 solved now" in run(capsys, "generate", "mine.toml", "--workers", "1")[1]


def test_check_estimates(here, capsys):
    status, out, _ = run(capsys, "check", "mine.toml")
    assert status == 0
    assert "points  48" in out and "time    about" in out and "memory  about" in out
    assert names(here) == ["mine.toml"]


def test_solve_prints_a_table(capsys):
    status, out, _ = run(capsys, "solve", "n1014", *POINT, "--solver", "formula")
    assert status == 0
    speed = "3.297 m/s (inner ring 1397.58 rpm, outer ring fixed)"
    assert out.splitlines()[1] == f"88.89 N/mm, {speed}, 40 degC, slice of 0.45 mm (40 N)"
    assert "k x length" in out


def test_solve_json_is_the_contract_s(capsys):
    status, out, _ = run(capsys, "solve", "n1014", *POINT, "--solver", "formula", "--json")
    inner, outer = json.loads(out)
    assert (status, inner["contact"], outer["contact"]) == (0, "inner", "outer")
    assert set(inner) >= {
        "approach", "film_offset", "stiffness", "damping", "central_film", "minimum_film", "max_pressure",
        "film_offset_error", "film_compliance_error", "stiffness_error", "damping_error", "iterations",
        "solve_seconds", "viscosity_extrapolated", "M", "L", "hertz_half_width", "hertz_pressure",
        "load_per_length", "status", "reason",
    }  # fmt: skip
    assert inner["status"] == "converged"
    assert inner["load_per_length"] == pytest.approx(40 / 0.45e-3, rel=1e-12)
    assert inner["temperature"] == 313.15


def test_the_length_converts_the_load_and_nothing_else(capsys):
    one = json.loads(run(capsys, "solve", "n1014", *POINT, "--solver", "formula", "--json")[1])
    two = json.loads(
        run(
            capsys,
            "solve",
            "n1014",
            "--load",
            "80 N",
            "--length",
            "0.9 mm",
            *POINT[4:],
            "--solver",
            "formula",
            "--json",
        )[1]
    )
    for a, b in zip(one, two, strict=True):
        a.pop("solve_seconds"), b.pop("solve_seconds")
    assert one == two


def test_solve_takes_a_load_per_length_and_a_frequency(capsys):
    status, out, _ = run(
        capsys,
        "solve",
        "n1014",
        "--load",
        "88 N/mm",
        *POINT[4:],
        "--frequency",
        "1 kHz",
        "--solver",
        "formula",
        "--json",
    )
    assert status == 0
    assert {(record["load_per_length"], record["frequency"]) for record in json.loads(out)} == {(88000.0, 1000.0)}


def test_solve_over_frequency(capsys, here):
    point = ["--load", "62 N", "--length", "0.7 mm", "--speed", "1.7 m/s", "--temperature", "40 degC"]
    asked = ["solve", "nu308", *point, "--frequency", "10 Hz", "20 kHz", "5"]
    status, out, err = run(capsys, *asked, "--plot", "z.png")
    assert (status, err.strip().splitlines()[-1]) == (0, "z.png: written")
    assert (here / "z.png").is_file()
    assert out.count("converged; slow motion: k 3") == 2 and out.count(" N/(um mm), c ") == 2
    status, out, _ = run(capsys, *asked, "--json")
    inner, outer = json.loads(out)
    assert (inner["contact"], outer["contact"]) == ("inner", "outer")
    assert inner["frequency"] == pytest.approx(np.geomspace(10.0, 2e4, 5).tolist())
    assert inner["M"] == pytest.approx(4.63, abs=0.01)
    _, single, _ = run(capsys, "solve", "nu308", *point, "--frequency", "20 kHz", "--json")
    # the same frequency, alone and among others: the Krylov space differs by round-off
    assert json.loads(single)[0]["stiffness"] == pytest.approx(inner["stiffness"][-1], rel=1e-9)
    assert json.loads(single)[0]["damping"] == pytest.approx(inner["damping"][-1], rel=1e-6)
    status, out, _ = run(capsys, "solve", "nu308", *point, "--frequency", "20 kHz")
    assert "oscillating at 20000 Hz" in out


def test_solve_over_the_slide_to_roll_ratio(capsys):
    asked = ["solve", "nu308", "--load", "50 N/mm", "--temperature", "60 degC", "--speed", "2 m/s"]
    asked += ["--slide-to-roll", "0.001", "1", "4"]
    status, out, _ = run(capsys, *asked)
    assert status == 0 and "eyring: 6 MPa; limiting: 2 MPa + 0.05 p" in out
    assert "  rolling force          N/m " in out and "  mass flow              g/(m s) " in out
    status, out, _ = run(capsys, *asked, "--shear-stress", "4 MPa", "--limiting-ratio", "0.04", "--json")
    inner, _ = json.loads(out)
    assert (inner["eyring_stress"], inner["limiting_ratio"]) == (4e6, 0.04)
    assert inner["slide_to_roll"] == pytest.approx([1e-3, 1e-2, 1e-1, 1.0])
    # bounded by the limiting stress everywhere, and by nothing
    assert inner["traction_limiting"][-1] < 0.04 < inner["traction_newtonian"][-1]
    status, out, _ = run(capsys, *asked, "--speed", "0 m/s")
    assert status == 0 and out.splitlines()[-1].split() == ["1", *"------"]


def test_solve_behind_an_oil_layer(capsys):
    asked = ["solve", "nu308", "--load", "5 N/mm", "--temperature", "60 degC", "--speed", "2 m/s", "--supply"]
    status, out, _ = run(capsys, *asked, "0.5 um")
    assert status == 0 and "oil supply: oil layer 0.5 um" in out
    inner, outer = (line.split() for line in out.splitlines()[-2:])
    assert inner[0] == "inner" and outer[0] == "outer" and float(outer[1]) < float(inner[1]) < 1.0
    status, out, _ = run(capsys, *asked, "0.5 um", "--json")
    record = json.loads(out)[0]
    assert record["oil_layer"] == 5e-7 and record["flow_ratio"] == pytest.approx(float(inner[1]), rel=1e-3)
    assert record["meniscus"] == pytest.approx(1e-6 * float(inner[2]), rel=1e-3)
    assert record["central_film"] < 5e-7 and record["film_compliance"] > 0.0 > record["supplied_compliance"]
    status, out, _ = run(capsys, *asked, "flooded", "--json")
    record = json.loads(out)[0]
    assert record["flow_ratio"] == 1.0 and record["meniscus"] is None and record["oil_layer"] is None
    del asked[-1]
    assert record["film_offset"] == json.loads(run(capsys, *asked, "--json")[1])[0]["film_offset"]
    status, out, _ = run(capsys, *asked, "--speed", "0 m/s", "--supply", "grease")
    assert status == 0 and out.splitlines()[-1].split() == ["outer", "-", "-"]
    status, _, err = run(capsys, *asked, "--supply", "much", "--solver", "formula", "--frequency", "1 Hz")
    assert status == 2 and "knows no meniscus" in err and "stands beside --frequency" in err and "'much'" in err


def test_solve_over_frequency_without_a_solution(capsys):
    point = ["--load", "10000 N/mm", "--speed", "1e-8 m/s", "--temperature", "40 degC"]
    status, out, _ = run(capsys, "solve", "nu308", *point, "--frequency", "10 Hz", "20 kHz", "5")
    assert status == 1
    assert out.count("outside_validity") == 2


def test_solve_at_a_standstill_has_no_groups(capsys):
    status, out, _ = run(
        capsys,
        "solve",
        "n1014",
        "--load",
        "88 N/mm",
        "--speed",
        "0 m/s",
        "--temperature",
        "40 degC",
        "--solver",
        "formula",
    )
    assert status == 0
    assert "asymptote" in out
    assert [line.split() for line in out.splitlines() if line.startswith("  M ")] == [["M", "-", "-"]]


def test_solve_says_when_there_is_no_solution(capsys, monkeypatch):
    monkeypatch.setattr(solvers, "build", lambda *_: Light())
    heavy = ["solve", "n1014", "--load", "101 N/mm", *POINT[4:]]
    status, out, _ = run(capsys, *heavy, "--json")
    records = json.loads(out)
    assert status == 1
    assert [record["status"] for record in records] == ["outside_validity", "outside_validity"]
    assert all(record["stiffness"] is None and record["reason"] == "too heavy" for record in records)
    table = run(capsys, *heavy)[1]
    assert "inner: too heavy" in table
    lines = [line for line in table.splitlines() if line.startswith(("  status", "  Hertz", "    "))]
    assert lines[1].split() == ["status", "outside_validity", "outside_validity"]
    assert len({len(line) for line in lines}) == 1  # the columns stand below one another


@pytest.mark.parametrize(
    ("arguments", "messages"),
    [
        (
            ["nu3o8", "--load", "40 x", "--speed", "-1 m/s", "--temperature", "40"],
            [
                "did you mean 'nu308'?",
                "--load: got the unit 'x'",
                "--speed: got '-1 m/s'",
                "--temperature: got '40' without",
            ],
        ),
        (["nu308", *POINT[:4], "--speed", "1 m/s", "--temperature", "-20 degC"], ["--temperature: lubricant 'FVA3'"]),
        (
            ["nu308", "--load", "1 kN", "--length", "0.001 mm", *POINT[4:]],
            ["--load over --length: got 1e+06 N/mm; allowed: 0.001 N/mm"],
        ),
        (["nu308", "--load", "40 N", *POINT[4:]], ["--length: missing; a load in N needs the length that carries it"]),
        (["nu308", "--load", "nan N/mm", *POINT[4:]], ["--load: got 'nan N/mm', which does not start with a number"]),
        (["nu308", "--load", "nan", *POINT[2:]], ["allowed: a number with a unit of N, such as"]),
        (["nu308", *POINT, "--frequency", "500 rpm"], ["--frequency: got the unit 'rpm'"]),
        (["nu308", *POINT, "--solver", "foo"], ["--solver: got 'foo'; allowed: hertz"]),
    ],
)
def test_solve_lists_every_problem(capsys, arguments, messages):
    status, out, err = run(capsys, "solve", *arguments)
    assert (status, out) == (2, "")
    assert all(message in err for message in messages)
    assert err.startswith(f"ehdmaps solve: {len(messages)} problem")


@pytest.mark.slow
def test_tradeoff_prints_its_tables_and_writes_its_files(here, capsys):
    text = TEXT.replace('"formula"', '"reynolds"\ndensity = 3.0')  # which takes less time
    Path("mine.toml").write_text(text.replace("NU308", "NJ 2207 ECP").replace("FVA3", "ISO VG 150, VI 140"))
    arguments = ["tradeoff", "mine.toml", "--points", "1", "--seed", "4", "--openfoam", "0"]
    status, out, err = run(capsys, *arguments, "--all", "-o", "t.nc", "--plot", "t.png")
    assert status == 0
    # 200 at the default density 6.5, and with its square
    assert "1 random points, seed 4: " in out and "reference: reynolds, density 12, inlet length 681." in out
    assert "  reynolds, density 4.2 " in out and "openfoam: left out, as asked" in out
    assert "t.nc: written" in err and Path("t.png").stat().st_size > 0
    status, out, _ = run(capsys, *arguments, "--json")
    record = json.loads(out)
    with xr.open_dataset("t.nc") as dataset:
        assert dataset["choice"].values.tolist() == [choice["label"] for choice in record["choices"]]
        found = [choice["errors"].get("stiffness", {}).get("largest", np.nan) for choice in record["choices"]]
        np.testing.assert_array_equal(dataset["largest"].sel(quantity="stiffness"), found)  # one seed, one result
    status, _, err = run(capsys, "tradeoff", "mine.toml", "-o", "mine.toml")
    assert status == 2 and "-o: got mine.toml, which would be written over mine.toml, which is read" in err


@pytest.mark.parametrize("command", [["show", "none.nc"], ["plot", "none.nc"], ["compare", "none.nc", "none.nc"]])
def test_a_map_that_is_not_there(here, capsys, command):
    status, _, err = run(capsys, *command)
    assert status == 2
    assert "none.nc: cannot be read" in err


@pytest.mark.parametrize(
    ("output", "message"),
    [
        ("missing/page.png", "-o: got missing/page.png, but missing is no folder; allowed: a file in a folder"),
        ("page.xyz", "-o: got page.xyz; allowed: a file that ends in .png, .pdf, .svg"),
        ("folder.png", "-o: got folder.png, which is a folder; allowed: a file in it"),
        ("folder", "-o: got folder; allowed: a file that ends in .png, .pdf, .svg"),
        ("photo.png", "-o: got photo.png, which is there and is not a figure of ehdmaps"),
    ],
)
def test_a_picture_that_cannot_be_written(here, capsys, output, message):
    run(capsys, "generate", "mine.toml", "--workers", "1")
    (here / "folder").mkdir()
    (here / "folder.png").mkdir()
    (here / "photo.png").write_bytes(b"somebody's")
    before = names(here)
    status, _, err = run(capsys, "plot", "mine.nc", "-o", output)
    assert (status, names(here)) == (2, before)
    assert message in err
    assert (here / "photo.png").read_bytes() == b"somebody's"


@pytest.mark.slow
def test_a_picture_that_fails_leaves_the_old_one(here, capsys, monkeypatch):
    run(capsys, "generate", "mine.toml", "--workers", "1")
    assert run(capsys, "plot", "mine.nc")[0] == 0
    good = (here / "mine.png").read_bytes()

    def full(_, file, **__):
        Path(file).write_bytes(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("matplotlib.figure.Figure.savefig", full)
    status, _, err = run(capsys, "plot", "mine.nc")
    assert status == 2
    assert "mine.png: cannot be written (No space left on device)" in err
    assert (here / "mine.png").read_bytes() == good


def test_generate_writes_over_nothing_but_maps(here, capsys):
    os.mkfifo(here / "pipe")
    (here / "letter.nc").write_text("Dear Sir")
    os.link(here / "mine.toml", here / "hard")
    for output, message in (
        ("mine.toml", "-o: got mine.toml, which would be written over mine.toml, which is read"),
        ("hard", "-o: got hard, which would be written over mine.toml, which is read"),
        ("pipe", "-o: got pipe, which is no regular file"),
        ("letter.nc", "-o: got letter.nc, which is there and is not a map of ehdmaps"),
    ):
        before = names(here)
        status, _, err = run(capsys, "generate", "mine.toml", "--workers", "1", "-o", output)
        assert (status, names(here)) == (2, before), output
        assert message in err
    assert (here / "mine.toml").read_text() == TEXT
    assert (here / "letter.nc").read_text() == "Dear Sir"
    assert (here / "pipe").is_fifo()
    for _ in range(2):  # a map over a map
        assert run(capsys, "generate", "mine.toml", "--workers", "1")[0] == 0
    status, _, err = run(capsys, "generate", "mine.nc", "--workers", "1", "-o", "mine.nc")
    assert status == 2 and "written over mine.nc, which is read" in err


@pytest.mark.parametrize("workers", ["0", "-1", "two", "99999", "9" * 1000])
def test_a_wrong_number_of_workers(capsys, workers):
    with pytest.raises(SystemExit) as raised:
        cli.main(["generate", "nu308", "--workers", workers])
    assert raised.value.code == 2
    assert "allowed: a whole number from 1 to 1024" in capsys.readouterr().err


def test_ctrl_c_in_any_command_is_quiet(capsys, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("ehdmaps.jobs.commands.show.open_given", interrupted)
    assert run(capsys, "show", "a.nc") == (130, "", "\nstopped\n")


@pytest.mark.slow
def test_a_reader_that_closes_the_pipe_is_no_error(here, capsys):
    run(capsys, "generate", "mine.toml", "--workers", "1")
    show = subprocess.Popen(
        [sys.executable, "-m", "ehdmaps.jobs.cli", "show", "mine.nc"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    show.stdout.close()
    err = show.stderr.read()
    show.stderr.close()
    assert (show.wait(), err) == (0, b"")


def test_help_loads_no_heavy_library():
    script = (
        "import sys\nfrom ehdmaps.jobs import cli\n"
        "try:\n    cli.main(['--help'])\nexcept SystemExit:\n    pass\n"
        "heavy = {'numpy', 'scipy', 'numba', 'xarray', 'matplotlib', 'pint', 'PyFoam', 'netCDF4'} & set(sys.modules)\n"
        "sys.exit(f'loaded {heavy}' if heavy else 0)\n"
    )
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (found.returncode, found.stderr) == (0, "")
    for command in ("generate", "check", "show", "plot", "solve", "compare", "tradeoff", "status"):
        assert command in found.stdout

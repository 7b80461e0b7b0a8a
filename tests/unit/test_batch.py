"""Batch files: what is read, what is refused, what becomes of members that fail, and of a run that goes on."""

import csv
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from ehdmaps.errors import DiskFullError, InputError, WorkerError
from ehdmaps.jobs import cli
from ehdmaps.jobs.make import batch_generate
from ehdmaps.jobs.make.batch import MOST_MEMBERS, is_batch, parse_batch, read_batch
from ehdmaps.jobs.make.batch_generate import generate_batch, plan_batch
from ehdmaps.jobs.reader import parse_job
from tests.cases.batches import SMALL_LISTS, batch_text
from tests.cases.jobs import SMALL

EXAMPLE = Path(__file__).parents[2] / "examples" / "catalogue.toml"

OIL = (
    '{ label = "own", viscosity_law = "barus", viscosity = "80 mPa s", pressure_viscosity = "20 1/GPa", '
    'density = "880 kg/m^3" }'
)
ROUGH = '[[overrides]]\nname = "plain"\n[[overrides]]\nname = "rough"\nsurface = { roughness = "0.2 um" }\n'


def read(text):
    return parse_batch(text, "cat", "cat.toml")


def rows(folder):
    with (folder / "summary.csv").open() as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def test_a_batch_is_the_product_of_bearings_oils_and_overrides():
    text = batch_text(f'bearings = ["NU308"]\nestimates = ["NU206"]\noils = ["FVA3", {OIL}]', more=ROUGH)
    batch = read(text)
    assert [member.name for member in batch.members] == [
        f"{bearing}_{oil}_{override}"
        for bearing in ("NU308", "NU206")
        for oil in ("FVA3", "own")
        for override in ("plain", "rough")
    ]
    member = batch.members[-1]
    assert (member.bearing, member.oil, member.override) == ("NU206", "own", "rough")
    assert member.job.surface.roughness == pytest.approx(0.2e-6)
    assert batch.members[-2].job.surface is None
    again = parse_job(member.job.text, member.name, "text")  # the text of a member is a job file
    assert again == member.job


def test_an_override_replaces_keys_of_a_table_and_leaves_the_others():
    more = '[[overrides]]\nname = "warm"\ngrid = { temperature = ["80 degC"] }\n'
    (member,) = read(batch_text('bearings = ["NU308"]\noils = ["FVA3"]', more=more)).members
    assert member.job.temperatures == (353.15,)
    assert len(member.job.loads) == 4


@pytest.mark.parametrize(
    ("lists", "told"),
    [
        ("oils = ['FVA3']", "bearings: missing; allowed: a list of names"),
        ("bearings = ['NU308']", "oils: missing"),
        ("bearings = []\noils = ['FVA3']", "bearings: got an empty list; allowed: at least one"),
        ("bearings = 'NU308'\noils = ['FVA3']", "bearings: got 'NU308'; allowed: a list of names"),
        (
            "bearings = ['NU999']\noils = ['FVA3']",
            r"cat.toml, NU999_FVA3: \[bearing\] name: bearing designation: got 'NU999'",
        ),
        ("bearings = ['NU308', 'nu308']\noils = ['FVA3']", "got 'nu308' again; allowed: each name once"),
        ("bearings = ['NU308']\nestimates = ['NU308']\noils = ['FVA3']", "estimates: got 'NU308', which bearings has"),
        ("bearings = ['../NU308']\noils = ['FVA3']", "got '../NU308', which becomes a part of a file's name"),
        ("bearings = [3]\noils = ['FVA3']", r"bearings\[0\]: got 3; allowed: a name in quotes"),
        ("bearings = [{ rollers = 3 }]\noils = ['FVA3']", "has no label; allowed: a table with one"),
        ("bearings = ['NU308']\noils = ['FVA3']\nfilm = 'own'", "film: unknown key"),
        ("bearings = ['NU308']\noils = ['FVA3']\nfilms = 'own'", "films: is no key of .batch. any more"),
        ("bearings = ['NU308']\noils = ['FVA3']\nchecked = -1", "checked: got -1; allowed: a whole number from 0"),
        (
            "bearings = ['{0}']\noils = ['{0}']".format("A" * 100),
            "its name has more than 120 characters; give shorter labels",
        ),
    ],
)
def test_lists_that_are_refused(lists, told):
    with pytest.raises(InputError, match=told):
        read(batch_text(lists))


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ("[[overrides]]\nsurface = { roughness = '1 um' }\n", r"overrides\[0\]: name: got None; allowed"),
        ("[[overrides]]\nname = 'a/b'\n", r"overrides\[0\]: name: got 'a/b'; allowed"),
        ("[[overrides]]\nname = 'a'\n[[overrides]]\nname = 'A'\n", "got 'A' again; allowed: each name once"),
        ("[[overrides]]\nname = 'a'\nbearing = { name = 'N1014' }\n", "bearing: got a table of 1 entries; allowed"),
        ("[[overrides]]\nname = 'a'\ngrid = 3\n", "grid: got 3; allowed: a table"),
        ("[overrides]\nname = 'a'\n", "overrides: got a table of 1 entries; allowed: tables"),
        ("[bearing]\nname = 'NU308'\n", r"bearing: stands beside \[batch\], which lists them"),
        ("[[overrides]]\nname = 'a'\ngrid = { load = 1979-05-27 }\n", "load: got '1979-05-27'; allowed"),
        ("[[overrides]]\nname = 'a'\ngrid = { 'a b' = 1 }\n", "a b: unknown key"),
        ("[grit]\n", "grit: unknown key .did you mean 'grid'"),
    ],
)
def test_tables_that_are_refused(more, told):
    with pytest.raises(InputError, match=told):
        read(batch_text(SMALL_LISTS, more=more))


def test_too_many_members_are_refused_before_any_is_read():
    names = ", ".join(f"'B{i}'" for i in range(1000))
    with pytest.raises(InputError, match=f"1000 bearings x 1000 oils x 1 overrides = 1000000 maps.*{MOST_MEMBERS}"):
        read(batch_text(f"bearings = [{names}]\noils = [{names}]"))


def test_a_problem_of_all_members_is_told_once():
    with pytest.raises(InputError) as caught:
        read(batch_text(SMALL_LISTS).replace("iso16281", "iso"))
    (problem,) = caught.value.problems
    assert problem.startswith("cat.toml, NU308_FVA3 and 1 more: [solver] structural_law: got 'iso'")


def test_a_name_of_the_file_that_no_map_could_have_is_refused():
    with pytest.raises(InputError, match="is called 'a b'; allowed: a name of letters"):
        parse_batch(batch_text(SMALL_LISTS), "a b", "a b.toml")


def test_what_is_a_batch_file_and_what_is_none(tmp_path):
    (tmp_path / "batch.toml").write_text(batch_text(SMALL_LISTS))
    (tmp_path / "job.toml").write_text(SMALL)
    (tmp_path / "none.toml").write_text("[batch")
    assert is_batch(tmp_path / "batch.toml")
    for name in ("job.toml", "none.toml", "absent.toml", "."):
        assert not is_batch(tmp_path / name)
    assert not is_batch("nu308")


def test_maps_of_a_batch_are_those_of_their_jobs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cat.toml").write_text(batch_text(SMALL_LISTS))
    assert cli.main(["generate", "cat.toml", "--workers", "1"]) == 0
    assert "cat: 2 maps: 2 made" in capsys.readouterr().out
    (tmp_path / "job.toml").write_text(read(batch_text(SMALL_LISTS)).members[0].job.text)
    assert cli.main(["generate", "job.toml", "-o", "own.nc", "--workers", "1"]) == 0
    with xr.open_dataset("own.nc") as own, xr.open_dataset("cat/NU308_FVA3.nc") as made:
        for name in ("approach", "stiffness", "damping", "minimum_film"):
            np.testing.assert_array_equal(own[name].values, made[name].values)  # the same solves
    first, second = rows(tmp_path / "cat")
    assert (first["map"], first["state"], first["films"]) == ("NU308_FVA3.nc", "made", "solved")
    assert float(second["stiffness [N/m2]"]) > 1e9
    # again: kept, and nothing is solved
    capsys.readouterr()
    assert cli.main(["generate", "cat.toml", "--workers", "1"]) == 0
    assert "2 kept" in capsys.readouterr().out
    assert cli.main(["status", "cat.toml"]) == 0
    assert "finished; see cat/summary.csv" in capsys.readouterr().out


def test_a_member_that_fails_does_not_stop_the_others(tmp_path, capsys):
    (tmp_path / "cat.toml").write_text(batch_text(SMALL_LISTS))
    folder = tmp_path / "maps"
    folder.mkdir()
    (folder / "NU308_FVA3.nc").write_text("somebody's notes")
    command = ["generate", str(tmp_path / "cat.toml"), "-o", str(folder), "--workers", "1"]
    assert cli.main(command) == 1
    told = capsys.readouterr().out
    assert "1 made, 1 failed" in told
    assert "is there and is not a map of ehdmaps" in told
    assert (folder / "NU308_FVA3.nc").read_text() == "somebody's notes"
    assert [row["state"] for row in rows(folder)] == ["failed", "made"]
    # nor is a map replaced that another command made
    (folder / "NU308_FVA3.nc").unlink()
    (tmp_path / "job.toml").write_text(SMALL)
    made = ["generate", str(tmp_path / "job.toml"), "-o", str(folder / "NU308_FVA3.nc"), "--workers", "1"]
    assert cli.main(made) == 0
    before = (folder / "NU308_FVA3.nc").read_bytes()
    assert cli.main(command) == 1
    assert "is a map that this batch did not make" in capsys.readouterr().out
    assert (folder / "NU308_FVA3.nc").read_bytes() == before


def test_equal_lines_of_equal_contacts_are_solved_once(tmp_path):
    batch = read(batch_text('bearings = ["NU308"]\noils = ["FVA3"]', more=ROUGH))
    result = generate_batch(batch, tmp_path / "maps", workers=1)
    assert result.status == 0
    assert (result.sweep.solved, result.sweep.taken_over) == (16, 16)


def test_a_change_of_the_file_makes_the_maps_that_it_changes(tmp_path):
    folder = tmp_path / "maps"
    generate_batch(read(batch_text(SMALL_LISTS)), folder, workers=1)
    more = batch_text(SMALL_LISTS.replace('"N1014"', '"N1014", { name = "N1014", label = "wide" }'))
    states = [outcome.state for outcome in generate_batch(read(more), folder, workers=1).outcomes]
    assert states == ["kept", "kept", "made"]
    whole = (folder / "NU308_FVA3.nc").read_bytes()
    (folder / "NU308_FVA3.nc").write_bytes(whole[: len(whole) // 2])  # a copy that stopped half-way is none of a map
    damaged, *_ = generate_batch(read(more), folder, workers=1).outcomes
    assert (damaged.state, "is not a map of ehdmaps" in damaged.reason) == ("failed", True)
    (folder / "NU308_FVA3.nc").unlink()
    hot = more.replace("40 degC", "50 degC")
    assert {outcome.state for outcome in generate_batch(read(hot), folder, workers=1).outcomes} == {"made"}


@pytest.mark.parametrize("option", [["--fresh-films"], ["--keep-cases"], ["nu308"]])
def test_what_a_batch_does_not_take(option, tmp_path, capsys):
    (tmp_path / "cat.toml").write_text(batch_text(SMALL_LISTS))
    assert cli.main(["generate", str(tmp_path / "cat.toml"), *option]) == 2
    assert "stands beside a batch file" in capsys.readouterr().err


def test_a_folder_that_cannot_be_made(tmp_path, capsys):
    (tmp_path / "cat.toml").write_text(batch_text(SMALL_LISTS))
    (tmp_path / "maps").write_text("a file")
    assert cli.main(["generate", str(tmp_path / "cat.toml"), "-o", str(tmp_path / "maps")]) == 2
    assert "which is no folder and cannot be made; allowed: a folder for the maps" in capsys.readouterr().err
    for name in ("a\\b", "a\nb"):
        assert cli.main(["generate", str(tmp_path / "cat.toml"), "-o", str(tmp_path / name)]) == 2
        assert "b'" in (err := capsys.readouterr().err) and "; rename it" in err
        assert not (tmp_path / name).exists()


def test_which_maps_are_read_from_the_film_table_and_checked():
    heat = "[[overrides]]\nname = 'a'\n[[overrides]]\nname = 'heat'\nsolver = { physics = 'inlet-heat' }\n"
    lists = 'estimates = ["NU206", "NU205", "NU210"]\noils = ["FVA3"]\nchecked = 1'
    plan = plan_batch(read(batch_text(lists, "reynolds", f"law_check = 20\n{heat}")))
    read_ones = [planned for planned in plan if planned.reads]
    assert [planned.member.override for planned in read_ones] == ["a"] * 3
    assert [planned.job.law_check for planned in read_ones] == [0, 20, 0]  # NU205 has the smallest radius
    assert all(planned.job.law_check == 20 for planned in plan if not planned.reads)
    assert len({planned.fingerprint for planned in plan}) == 6
    assert not any(planned.reads for planned in plan_batch(read(batch_text(SMALL_LISTS))))  # formulas


def test_the_example_is_a_catalogue_of_five_oils():
    batch = read_batch(EXAMPLE)
    assert len(batch.members) == 1000
    plan = plan_batch(batch)
    assert all(planned.reads for planned in plan)
    assert sum(planned.job.law_check > 0 for planned in plan) == 5 * batch.checked


def test_check_tells_what_is_solved_and_other_commands_refuse_a_batch(tmp_path, capsys):
    source = str(tmp_path / "cat.toml")
    (tmp_path / "cat.toml").write_text(batch_text(SMALL_LISTS))
    assert cli.main(["check", source]) == 0
    told = capsys.readouterr().out
    assert "2 maps, from NU308_FVA3 to N1014_FVA3" in told
    assert "2 maps are solved at their own points" in told
    assert "points  32 to solve" in told
    assert cli.main(["solids", source]) == 2
    assert "is a batch file, of many jobs; allowed: one job" in capsys.readouterr().err


@pytest.mark.parametrize("error", [WorkerError("worker processes die", kept=1), DiskFullError("no room")])
def test_what_ends_all_maps_is_no_failure_of_each(tmp_path, monkeypatch, error):
    def dying(*_, **__):
        raise error

    monkeypatch.setattr(batch_generate, "generate", dying)
    with pytest.raises(type(error), match=str(error)):
        generate_batch(read(batch_text(SMALL_LISTS)), tmp_path / "maps", workers=1)

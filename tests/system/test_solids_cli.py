"""`ehdmaps solids` as a person meets it; the solution itself is that of tests/verification/test_solids_plane.py."""

import json
import re
import tomllib
from importlib import resources

import pytest

from ehdmaps.jobs import cli
from ehdmaps.jobs.commands import solids
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solids import STEEL
from tests.cases.jobs import map_job

TEXT = map_job('["1 N/mm", "10 N/mm"]', '["0.5 m/s"]', '["40 degC"]')


SHIPPED = json.loads((resources.files("ehdmaps.physics") / "shipped" / "NU308.json").read_text("utf-8"))


@pytest.fixture
def solved(monkeypatch):
    """Have what comes with the package in place of a solution, and hear what was asked for."""
    asked = []

    def found(bearing, sections, *, meshes, contact, tell):
        asked.append((sections.roller_bore, meshes, contact))
        return {key: value for key, value in SHIPPED.items() if key not in ("program", "command")}

    monkeypatch.setattr(solids, "bearing_record", found)
    return asked


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(TEXT)
    return tmp_path


def test_laws_side_by_side_without_a_solution(monkeypatch, capsys):
    monkeypatch.setattr(solids, "bearing_record", None)
    assert cli.main(["solids", "nu308", "--compare"]) == 0
    out = capsys.readouterr().out
    assert re.search(r"inner contact +fe +iso16281 +palmgren +half_space\n +1 N/mm +23\.62 N/\(um mm\) +-9\.6%", out)
    assert cli.main(["solids", "nu308", "--compare", "--json"]) == 0
    laws = json.loads(capsys.readouterr().out)["laws"]
    inner, _ = BearingGeometry.named("NU308").contacts(STEEL, "palmgren")
    k = 1.0 / inner.structural_compliance(1e5)
    assert laws["inner"]["palmgren"]["stiffness"][3] == pytest.approx(k, rel=1e-12)


def test_what_is_printed_is_what_a_job_takes(here, solved, capsys):
    assert cli.main(["solids", "mine.toml", "--mesh-convergence", "-o", "found.json"]) == 0
    assert solved == [(0.0, True, False)]
    out = capsys.readouterr().out
    assert "solid shaft, housing held at 135 mm" in out
    assert re.search(r"CalculiX' contact, load +0\.000", out)
    table = out[out.index("[solids]\n") :]
    assert tomllib.loads(table)["solids"]["law"] == "fe"
    law = re.search(r'structural_law = "\w+"\n', TEXT)
    job = parse_job(TEXT.replace(law[0], "") + table, "mine", "mine.toml")
    known = SHIPPED["contacts"]
    for contact in job.contacts:
        assert contact.structural_law == "fe"
        assert contact.fe_approach == pytest.approx(known[contact.name]["fe_approach"], rel=1e-6)  # digits
    record = json.loads((here / "found.json").read_text())
    assert record["command"] == "ehdmaps solids mine --mesh-convergence"
    assert cli.main(["solids", "mine.toml", "-o", "found.json"]) == 0  # its own file may be replaced


def test_a_job_that_lacks_its_approaches_can_be_solved(here, solved, capsys):
    (here / "hollow.toml").write_text(TEXT + '[solids]\nroller_bore = "6 mm"\n')
    assert cli.main(["solids", "hollow.toml", "--compare"]) == 0  # not known yet, so solved
    assert solved == [(6e-3, False, False)]


def test_a_picture(here, capsys):
    pytest.importorskip("gmsh", exc_type=ImportError)
    (here / "own.toml").write_text(TEXT + '[solids]\ninner_approach = "3 um"\nouter_approach = "3 um"\n')
    assert cli.main(["solids", "own.toml", "--compare", "--plot", "page.png"]) == 0
    assert (here / "page.png").read_bytes()[1:4] == b"PNG"


def test_a_bare_contact_has_no_rings(here, capsys):
    bare = '[contact]\nradius = "5 mm"\nroller_length = "10 mm"\n'
    (here / "bare.toml").write_text(re.sub(r"\[bearing\]\n(.*\n)+?(?=\[|\n)", bare, TEXT))
    assert cli.main(["solids", "bare.toml"]) == 2
    assert "bare.toml: has [contact]; allowed: a job with [bearing]" in capsys.readouterr().err

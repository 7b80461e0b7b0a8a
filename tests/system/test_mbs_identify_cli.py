"""`mbs identify` as a person meets it: from a simulated hammer test to values, files and a scene."""

from __future__ import annotations

import pytest
import xarray as xr

import mbs.cli
from mbs import read_scene
from tests.cases.identify_twins import ROTOR


def run(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    """Exit status and what was printed."""
    status = mbs.cli.main(list(words))
    out, err = capsys.readouterr()
    return status, out, err


@pytest.fixture
def rotor(tmp_path, monkeypatch):
    """A rotor in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rotor.toml").write_text(ROTOR.read_text(encoding="utf-8"), encoding="utf-8")
    return tmp_path


@pytest.mark.slow
def test_from_hits_to_a_scene(rotor, capsys) -> None:
    pytest.importorskip("pyuff")
    (rotor / "drive.toml").write_text(read_scene("electric_drive").text, encoding="utf-8")
    test = ("hammer", "drive.toml", "--clearance", "11 um", "--highest", "1.5 kHz", "-o", "hits.uff")
    assert run(capsys, *test)[0] == 0
    words = (
        "identify",
        "drive.toml",
        "--measured",
        "hits.uff",
        "6000 rpm",
        "--free",
        "clearance",
        "--cage-angles",
        "1",
    )
    status, out, _ = run(capsys, *words, "-o", "f.nc", "--plot", "f.png", "--scene", "f.toml")
    assert status == 0, out
    assert "8 hits at middle_y" in out and "f.toml: written" in out and "with what was found" in out
    with xr.open_dataset("f.nc") as found:
        for name in ("drive.clearance", "end.clearance"):
            assert abs(found["found"].sel(unknown=name) - 11e-6) < 1e-6
        assert found.attrs["explained_by"] == "films"
    again = read_scene("f.toml")
    assert {"clearance of drive", "clearance of end"} <= set(again.tolerances)
    assert run(capsys, *words, "--scene", "drive.toml")[0] == 2  # what was read is not overwritten


def test_a_plan_needs_nothing_measured(rotor, capsys) -> None:
    words = ("identify", "rotor.toml", "--plan", "--free", "left.clearance", "--free", "temperature")
    status, out, _ = run(capsys, *words, "--measured", "no.uff", "3000 rpm", "--cage-angles", "1")
    assert status == 0
    assert "1. " in out and "by a hit at hit_" in out and "3000 rpm" in out and "told apart" in out


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--free", "clearance"], "--measured: got none"),
        (["--measured", "a.csv", "0 rpm"], "--free: got none"),
        (["--measured", "a.csv", "0 rpm", "--free", "clearance"], "a.csv: cannot be read"),
        (["--measured", "a.csv", "fast", "--free", "clearance"], "got 'fast'"),
        (["--measured", "a.csv", "0 rpm", "--free", "clearance", "--channel", "x"], "NAME_IN_FILE=NAME_IN_SCENE"),
        (["--measured", "a.csv", "0 rpm", "--free", "clearance", "--band", "9 Hz", "1 Hz"], "allowed: rising"),
        (["--plan", "--free", "everything"], "--free: got 'everything'"),
    ],
)
def test_bad_input(rotor, capsys, words, told) -> None:
    status, _, err = run(capsys, "identify", "rotor.toml", *words)
    assert status == 2
    assert told in err

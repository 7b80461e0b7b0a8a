"""Labels: shown instead of names, and nothing else."""

import json

import numpy as np
import pytest

import ehdmaps
from ehdmaps.errors import InputError
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.make.status import about
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from mbs import cli as bearing_cli

from .test_job_reader import BY_HAND, GOOD, NAMED, NAMED_OIL, OIL


def labelled(bearing, oil, text=GOOD):
    return text.replace("[bearing]\n", f'[bearing]\nlabel = "{bearing}"\n').replace(
        "[lubricant]\n", f'[lubricant]\nlabel = "{oil}"\n'
    )


def parse(text):
    return parse_job(text, name="job", where="job.toml")


@pytest.mark.parametrize("text", [GOOD, GOOD.replace(NAMED, BY_HAND).replace(NAMED_OIL, OIL)], ids=["named", "own"])
def test_a_label_is_shown_and_changes_nothing_else(text):
    plain, job = parse(text), parse(labelled("gearbox, bearing A", "Öl 32", text))
    assert (job.title, job.lubricant.title) == ("gearbox, bearing A", "Öl 32")
    assert (plain.title, plain.lubricant.title) == (plain.bearing.name, plain.lubricant.name)
    assert job.bearing == plain.bearing and hash(job.bearing) == hash(plain.bearing)
    assert job.lubricant == plain.lubricant
    assert job.contacts == plain.contacts


def test_status_and_the_page_of_a_bearing_have_the_labels(tmp_path, capsys):
    text = labelled("gearbox, bearing A", "Öl 32", GOOD.replace(NAMED_OIL, OIL))
    assert about(parse(text)).startswith("gearbox, bearing A, Öl 32, solver ")
    path = tmp_path / "job.toml"
    path.write_text(text, encoding="utf-8")
    for law in ("hertz", "formula"):
        assert bearing_cli.main(["bearing", str(path), "--load", "6 kN", "--speed", "900 rpm", "--law", law]) == 0
        head, *_, last = capsys.readouterr().out.splitlines()
        assert head.startswith("gearbox, bearing A: law ") and "Öl 32" in head and "own oil" not in head
        assert "viscosity of Öl 32 is extrapolated above 0.6 GPa" in last


@pytest.mark.parametrize("label", ["", "   ", "x" * 61, "a\\nb", "a\\u0007", "a\\u202eb"])
def test_labels_that_no_title_could_take(label):
    with pytest.raises(InputError) as caught:
        parse(labelled(label, label))
    assert len(caught.value.problems) == 2
    for problem, table in zip(caught.value.problems, ("bearing", "lubricant"), strict=True):
        assert f"[{table}] label: got" in problem
        assert "allowed: 1 to 60 printable characters on one line" in problem


def test_a_label_is_a_text():
    with pytest.raises(InputError, match=r"\[bearing\] label: got 308; allowed: 1 to 60 .*, in quotes"):
        parse(GOOD.replace("[bearing]\n", "[bearing]\nlabel = 308\n"))
    with pytest.raises(InputError, match=r"bearing 'NU308', label: got '\\n' \(1 characters\); allowed: 1 to 60"):
        BearingGeometry("NU308", 52e-3, 80e-3, 14e-3, 15e-3, 12, 0.0, label="\n")
    with pytest.raises(InputError, match=r"lubricant 'FVA3', label: got '\\n' \(1 characters\); allowed: 1 to 60"):
        Lubricant("FVA3", True, Lubricant.named("FVA3").viscosity, Lubricant.named("FVA3").pressure_viscosity, 880.0,
                  label="\n")  # fmt: skip


def test_a_changed_label_takes_over_every_point(tmp_path, capsys):
    """The store knows physics alone; the maps differ in what is shown and in nothing that was solved."""
    path, first, second = tmp_path / "job.toml", tmp_path / "map.nc", tmp_path / "again.nc"
    path.write_text(labelled("A", "oil A"))
    assert main(["generate", str(path), "-o", str(first), "--workers", "1"]) == 0
    assert "points: 0 taken over, 40 solved now" in capsys.readouterr().out
    second.with_name("again.nc.store").write_bytes(first.with_name("map.nc.store").read_bytes())
    path.write_text(labelled("B", "oil B"))
    assert main(["generate", str(path), "-o", str(second), "--workers", "1"]) == 0
    assert "points: 40 taken over, 0 solved now" in capsys.readouterr().out
    old, new = ehdmaps.open_map(first), ehdmaps.open_map(second)
    assert old.dataset.attrs["title"] == "EHD map of A, oil A, by the solver formula"
    assert new.dataset.attrs["title"] == "EHD map of B, oil B, by the solver formula"
    assert json.loads(new.dataset.attrs["geometry"])["label"] == "B" == new.bearing.label
    assert json.loads(new.dataset.attrs["lubricant"])["label"] == "oil B" == new.lubricant.label
    assert main(["compare", str(first), str(second)]) == 0
    assert "made from the same settings" in capsys.readouterr().out
    for name, values in old.dataset.data_vars.items():
        np.testing.assert_array_equal(values, new.dataset[name])


def test_a_map_without_labels_has_none_in_its_records(tmp_path):
    path, made = tmp_path / "job.toml", tmp_path / "map.nc"
    path.write_text(GOOD)
    assert main(["generate", str(path), "-o", str(made), "--workers", "1"]) == 0
    emap = ehdmaps.open_map(made)
    for record in ("geometry", "lubricant"):
        assert "label" not in json.loads(emap.dataset.attrs[record])
    assert emap.bearing == BearingGeometry.named("NU308")

"""Some panels of a map, as a figure and as what is drawn in CSV."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

import ehdmaps
from ehdmaps.jobs.cli import main
from tests.cases.commands import without_note


def test_what_is_drawn_is_written(small_map, tmp_path, capsys):
    """Points are those of the map; curves between them those of its law, at which its stiffness is a derivative."""
    table, emap = tmp_path / "a.csv", ehdmaps.open_map(small_map)
    kelvin = float(emap.dataset["temperature"].values[-1])
    ask = ["plot", str(small_map), "--quantity", "stiffness, central_film", "--contact", "outer"]
    ask += ["--temperature", f"{kelvin} K"]
    assert main([*ask, "-o", str(table)]) == 0
    with open(table, encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    assert {(row["contact"], float(row["temperature [K]"])) for row in rows} == {("outer", kelvin)}
    here = emap.dataset.sel(contact="outer", temperature=kelvin)
    for name, unit in (("stiffness", "N m-2"), ("central_film", "m")):
        of_map = [row for row in rows if row["quantity"] == name and row["of"] == "map"]
        assert {(row["unit"], row["status"]) for row in of_map} == {(unit, "converged")}
        found = np.array([float(row["value"]) for row in of_map]).reshape(here.sizes["entrainment_speed"], -1)
        np.testing.assert_allclose(found, here[name].values.T, rtol=1e-8)
    law, speed = emap.law("outer"), f"{float(here['entrainment_speed'][1]):.9g}"
    curve = [row for row in rows if row["of"] == "contact law" and row["entrainment_speed [m/s]"] == speed][10:-10:40]
    loads, k = (np.array([float(row[key]) for row in curve]) for key in ("load [N/m]", "value"))
    at = law.at(float(speed), kelvin)
    step = 1e-4 * loads
    slope = 2.0 * step / np.array([at.approach(w + h) - at.approach(w - h) for w, h in zip(loads, step, strict=True)])
    np.testing.assert_allclose(k, slope, rtol=2e-2)  # of cells of the law between its rows
    assert main([*ask, "-o", str(tmp_path / "a.svg")]) == 0
    drawn = (tmp_path / "a.svg").read_text(encoding="utf-8")
    assert "outer" in drawn and "<!-- inner" not in drawn
    assert Path(table).read_text(encoding="utf-8").startswith("# table made by ehdmaps")
    assert main([*ask, "-o", str(table)]) == 0  # its own may be replaced


def test_panels_that_there_are_not(small_map, tmp_path, capsys):
    words = ["--quantity", "stiffnesz", "--contact", "both", "--temperature", "300 degC", "-o", str(tmp_path / "a.png")]
    assert main(["plot", str(small_map), *words]) == 2
    said = without_note(capsys.readouterr().err)
    assert "--quantity: got 'stiffnesz' (did you mean 'stiffness'?); allowed: stiffness, damping" in said
    assert "--contact: got 'both'; allowed: inner, outer" in said
    assert main(["plot", str(small_map), "--temperature", "300 degC", *words[-2:]]) == 2
    assert "--temperature: got '300 degC'; allowed: those of the map, 20 degC" in capsys.readouterr().err
    assert main(["plot", str(small_map), "--roughness", "0.2 um", "--contact", "inner", *words[-2:]]) == 2
    assert "--roughness: got it with --quantity" in capsys.readouterr().err

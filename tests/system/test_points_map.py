"""Maps of points: `ehdmaps generate`, `show`, `plot` and `export` of a ball bearing."""

from __future__ import annotations

import csv
import dataclasses
import math

import numpy as np
import pytest
import xarray as xr
from scipy.io import loadmat

import ehdmaps
from ehdmaps.errors import MapError
from ehdmaps.jobs import cli
from ehdmaps.jobs.make.points_map import PointsRequest, points_map, reasons, usable
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.solids import STEEL
from ehdmaps.table.points.file import shipped_point_table
from ehdmaps.table.points.films import NUMBERS


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The map of a 6208 with ISO VG 46, made once by the command."""
    path = tmp_path_factory.mktemp("points") / "balls.nc"
    assert cli.main(["generate", "6208, ISO VG 46", "-o", str(path)]) == 1  # points without a film
    return path


def run(capsys, *arguments):
    status = cli.main([str(argument) for argument in arguments])
    captured = capsys.readouterr()
    return status, captured.out, captured.err


def test_numbers_are_those_of_the_table(made):
    """Any point of the file against the table: the same numbers and words."""
    with xr.open_dataset(made) as data:
        assert dict(data.sizes) == {"contact": 2, "load": 32, "entrainment_speed": 13, "temperature": 6}
        outer, oil = ball_estimate("6208").contacts(STEEL)[1], Lubricant.named("ISO VG 46")
        for i, j, k in ((14, 8, 2), (31, 1, 0), (3, 0, 1), (20, 12, 5)):
            here = data.isel(contact=1, load=i, entrainment_speed=j, temperature=k)
            point = (float(here[name]) for name in ("load", "entrainment_speed", "temperature"))
            films = shipped_point_table().films(outer, oil, *point)
            for name in NUMBERS:
                np.testing.assert_array_equal(here[name], getattr(films, name))
                np.testing.assert_array_equal(here[f"{name}_error"], films.errors[name])
            assert reasons(data)[1, i, j, k] == films.reason
        known = usable(data)
        assert 0.95 < float(known.mean()) < 1.0
        wide = np.char.startswith(reasons(data), "film wider than 0.6 of the ball's radius")
        assert 0.02 < wide.mean() < 0.03  # the lightest loads at the highest speeds
        assert bool((data["stiffness"].notnull() == known).all())  # no number without a status, and none missing
        assert bool((data["film_offset"].where(known, 1.0) >= 0.0).all())


def test_it_is_shown_drawn_and_exported(made, tmp_path, capsys):
    status, out, _ = run(capsys, "show", made)
    assert status == 0 and "map of points: films of the point contacts of 6208, ISO VG 46" in out
    assert "without: film thicker than" in out
    assert run(capsys, "plot", made, "-o", tmp_path / "page.svg")[0] == 0
    assert (tmp_path / "page.svg").stat().st_size > 30_000
    assert run(capsys, "export", made, "-o", tmp_path / "films.csv")[0] == 0
    rows = list(csv.reader((tmp_path / "films.csv").read_text(encoding="utf-8").splitlines()[1:]))
    assert len(rows) == 1 + 2 * 32 * 13 * 6
    named = [dict(zip(rows[0], row, strict=True)) for row in rows[1:]]
    film = rows[0].index("film_offset [m]")
    assert all(bool(row[film]) or row[-1] for row in rows[1:])
    assert {row["contact"] for row in named} == {"inner", "outer"}


def test_it_is_exported_for_matlab_and_at_one_point(made, tmp_path, capsys):
    assert run(capsys, "export", made, "--to", "mat", "-o", tmp_path / "films.mat")[0] == 0
    held = loadmat(tmp_path / "films.mat", simplify_cells=True)["map"]
    with xr.open_dataset(made) as data:
        np.testing.assert_array_equal(held["inner"]["stiffness"], data["stiffness"].sel(contact="inner"))
        np.testing.assert_array_equal(held["load"], data["load"])
    one = ("--speed", "2.9 m/s", "--temperature", "61 degC", "--contact", "outer", "--points", "9")
    assert run(capsys, "export", "6208", *one, "-o", tmp_path / "one.csv")[0] == 0
    rows = list(csv.DictReader((tmp_path / "one.csv").read_text(encoding="utf-8").splitlines()[1:]))
    assert len(rows) == 9 and {row["contact"] for row in rows} == {"outer"}
    films = shipped_point_table().films(
        ball_estimate("6208").contacts(STEEL)[1], Lubricant.named("FVA3"), float(rows[4]["load [N]"]), 2.9, 334.15
    )
    assert float(rows[4]["stiffness [N/m]"]) == pytest.approx(float(films.stiffness), rel=1e-5)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("generate", "6208", "--solver", "hertz"), "--solver: is one of line contacts"),
        (
            ("export", "6208", "--to", "c"),
            "--to: got 'c' for point contacts; allowed: csv, mat; K and C of the bearing: mbs bearing -o",
        ),
        (
            ("export", "6208", "--contact", "series"),
            "--contact: got 'series' for point contacts; allowed: ",
        ),
        (("export", "6208", "--speed", "9 km/s"), "--speed: got '9 km/s'; allowed: "),
        (("export", "MADE", "--speed", "3 m/s"), "--speed: stands beside a map of points; allowed: with --bearing"),
        (("generate", "6208", "--oil", "butter"), "--oil: "),
        (("plot", "MADE", "--oil", "ISO VG 46"), "--oil: got 'ISO VG 46' beside a map"),
        (("generate", "6208", "-o", "films.txt"), "allowed: a file that ends in .nc"),
    ],
)
def test_what_it_does_not_take_is_refused(made, tmp_path, monkeypatch, capsys, arguments, words):
    monkeypatch.chdir(tmp_path)
    status, _, err = run(capsys, *(made if argument == "MADE" else argument for argument in arguments))
    assert status == 2 and words in err
    assert not list(tmp_path.iterdir())


def test_heat_in_the_inlet_is_asked_for_behind_the_oil(tmp_path):
    """Numbers are those of heated films of the table; the file says its physics."""
    request = PointsRequest.named("6208, ISO VG 46, inlet-heat")
    assert request.file_name == "6208_ISO_VG_46_inlet-heat.nc" and not PointsRequest.named("6208").inlet_heat
    request = dataclasses.replace(request, loads=3, speeds=(0.0, 5.0), temperatures=(313.15,))
    warm, cold = (points_map(dataclasses.replace(request, inlet_heat=heat)) for heat in (True, False))
    assert (warm.attrs["physics"], cold.attrs["physics"]) == ("inlet-heat", "isothermal")
    outer = request.bearing.contacts(STEEL)[1]
    films = shipped_point_table().films(outer, request.oil, warm["load"].values, 5.0, 313.15, inlet_heat=True)
    for name in NUMBERS:
        np.testing.assert_array_equal(warm[name].values[1, :, 1, 0], getattr(films, name))
    assert np.nanmax(warm["central_film"].values[:, :, 1] / cold["central_film"].values[:, :, 1]) < 0.95


def test_it_is_no_map_of_lines_and_a_damaged_one_is_refused(made, tmp_path, capsys):
    with pytest.raises(MapError, match="is a map of points; expected a map of line contacts"):
        ehdmaps.open_map(made)
    with xr.open_dataset(made) as data:
        data.drop_vars("damping_error").to_netcdf(tmp_path / "lacks.nc")
    status, _, err = run(capsys, "show", tmp_path / "lacks.nc")
    assert status == 2 and "lacks damping_error; expected a map of points" in err


def test_an_angular_contact_bearing_has_one_too():
    request = PointsRequest.named("7208B")
    assert request.file_name == "7208B_FVA3.nc"
    data = points_map(request)
    angle = math.radians(40.0)
    assert ball_estimate("7208B").contact_angle == pytest.approx(angle)
    assert float(usable(data).mean()) > 0.9

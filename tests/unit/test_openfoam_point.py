"""Points by `openfoam` with a stand-in for ehlFoam: its file, statuses, errors, refusals, fields, and the command."""

import json
import math
import tempfile
from dataclasses import replace

import numpy as np
import pytest

from ehdmaps.errors import InputError, SolverError
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.solve import cfd_points
from ehdmaps.openfoam.fields import read_point_fields, write_fields
from ehdmaps.openfoam.point import OpenFoamPointSolver
from ehdmaps.openfoam.point_case import PointParameters, read_point_columns, read_point_results
from ehdmaps.openfoam.pyfoam import parse
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.point.film_formulas import kapitza_film
from ehdmaps.physics.solution import Status
from tests.cases import openfoam_fake

BALL = Ellipse(10e-3, 10e-3, 230.769e9)
OIL = Lubricant.named("FVA3")
PLACE = (20.0, 1.0, 333.15)
MESH = (36, 18, 2)


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """Folder of a fake build, in which ehlFoam does what `set_mode` says."""
    folder = tmp_path / "build"
    for key, value in openfoam_fake.build(folder).items():
        monkeypatch.setenv(key, value)
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    return folder


def solver(**changes):
    return OpenFoamPointSolver(**dict(zip(("columns", "lines", "rows"), MESH, strict=True)) | changes)


def parameters(**changes):
    asked = PointParameters(BALL, 20.0, 1.0, OIL.at(333.15), 0.3, *MESH)
    return replace(asked, **changes)


def test_the_file_says_all_numbers_exactly(tmp_path):
    (tmp_path / "ehlProperties").write_text(parameters().text())
    said = parse(tmp_path / "ehlProperties")
    state = OIL.at(333.15)
    assert (said["reducedRadius"], said["transverseRadius"], said["reducedModulus"]) == (10e-3, 10e-3, 230.769e9)
    assert (said["load"], said["lowerSpeed"], said["upperSpeed"]) == (20.0, 1.0, 1.0)
    assert said["viscosity"]["viscosity"] == state.viscosity
    assert said["density"] == {"type": "DowsonHigginson", "density": state.density}
    assert (said["columns"], said["lines"], said["rows"], said["mesh"]["film"]) == (*MESH, 0.3)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("load", math.nan, "ehlProperties, load: got nan; allowed: a finite number"),
        ("entrainment_speed", "1; #calc", "ehlProperties, lowerSpeed: got '1; #calc'; allowed: a finite number"),
        ("lines", 0, "ehlProperties, lines: got 0; allowed: a whole number >= 1"),
        ("write_fields", "true", "ehlProperties, writeFields: got 'true'; allowed: true or false"),
    ],
)
def test_nothing_but_numbers_is_written(key, value, message):
    with pytest.raises(InputError) as caught:
        parameters(**{key: value}).text()
    assert str(caught.value) == message


def test_a_point_with_its_errors(fake, tmp_path):
    film = solver().solve(BALL, OIL, *PLACE)
    assert (film.status, film.steps, film.mesh) == (Status.CONVERGED, 9, MESH)
    # meshes of 2/3 of the cells, second order: 0.8 of the 1 % that they differ by
    assert film.central_film.error == pytest.approx(0.008)
    assert film.approach.error == pytest.approx(0.008 * 1e-7 / film.approach)
    # stiffness and loss are not to be as good as one difference says
    assert film.stiffness.error == pytest.approx(0.012)
    assert film.damping.error == pytest.approx(0.016 + 0.024)
    assert film.minimum_film.error == pytest.approx(0.008)  # the film is flat: nothing smaller between its columns
    assert 0.008 < film.max_pressure.error < 0.05
    assert film.approach == pytest.approx(BALL.approach(20.0) - 1e-7)
    assert film.stiffness == 1e8
    assert film.damping == pytest.approx(1e3)
    assert film.film_compliance == pytest.approx(1e-8 - 1.0 / BALL.stiffness(20.0))
    assert film.columns.pressure.shape == MESH[:2]
    assert film.fields is None
    assert list((tmp_path / "temporary").iterdir()) == []


@pytest.mark.parametrize(
    ("mode", "status", "reason"),
    [
        ("stagnated", Status.STAGNATED, "ehlFoam stagnated: steps are cut to nothing; last lines"),
        ("diverged", Status.DIVERGED, "ehlFoam diverged"),
        ("fatal", Status.FAILED, "ehlFoam ended with status 1; last lines of the log: viscosity is negative"),
        ("segv", Status.FAILED, "ehlFoam crashed with signal 11"),
        ("hang", Status.FAILED, "ehlFoam did not end within the 0."),
        ("nothing", Status.FAILED, "results"),
        ("nan", Status.FAILED, "filmOffset"),
        ("unresolved", Status.OUTSIDE_VALIDITY, "not resolved: both meshes differ by 80 % in the central film"),
        ("soft", Status.OUTSIDE_VALIDITY, "not resolved: no film, or no stiffness"),
        ("thicker", Status.OUTSIDE_VALIDITY, "film"),
        ("thick", Status.ASYMPTOTE, "film thicker than 1 % of the radius"),
        ("faint", Status.CONVERGED, ""),
    ],
)
def test_ends_are_typed(fake, mode, status, reason):
    openfoam_fake.set_mode(fake, mode)
    film = solver(timeout=0.3 if mode == "hang" else 20.0).solve(BALL, OIL, *PLACE)
    assert film.status is status, film.reason
    assert reason in film.reason
    assert film.status.usable == math.isfinite(film.central_film) == math.isfinite(film.stiffness)


def test_what_is_not_tried(fake):
    def refused(ellipse, load=20.0, speed=1.0):
        film = solver().solve(ellipse, OIL, load, speed, 333.15)
        assert film.status is Status.OUTSIDE_VALIDITY
        assert math.isnan(film.central_film)
        return film.reason

    assert refused(BALL, load=0.0).startswith("load 0 N, speed 1 m/s: no film")
    assert refused(BALL, speed=math.nan).startswith("load 20 N, speed nan m/s: no film")
    assert refused(BALL, load=1e7).startswith("Hertz pressure")
    assert refused(BALL, load=1e-3).startswith("M = ")
    assert refused(BALL, speed=1e6).startswith("M = ")
    assert refused(BALL, speed=1e-6).startswith("M = ")
    assert refused(Ellipse(10e-3, 2e-3, 230.769e9)).startswith("ellipticity 0.3")
    assert refused(Ellipse(1e-3, 2.0, 230.769e9)).startswith("ellipticity")
    assert openfoam_fake.starts(fake) == []


def test_settings_outside_their_range(fake):
    with pytest.raises(InputError) as caught:
        OpenFoamPointSolver(columns=3, lines=1000, rows=1, timeout=math.nan)
    assert [problem.split(":")[0] for problem in caught.value.problems] == [
        f"openfoam point solver, {name}" for name in ("columns", "lines", "rows", "timeout")
    ]
    with pytest.raises(InputError, match="got 216 x 81; allowed: 8000 in all"):
        OpenFoamPointSolver(columns=216, lines=81)


def test_the_cells_of_a_film_for_paraview(fake, tmp_path):
    import meshio

    film = solver(keep_cases=tmp_path / "cases").solve(BALL, OIL, *PLACE, with_fields=True)
    columns, lines, rows = MESH
    assert film.fields.corners.shape == (columns * lines * rows, 8)
    corners = film.fields.points[film.fields.corners]
    # cells stand as those of OpenFOAM: rows first, then along the motion; corners turn about +z, the lower face first
    middle = corners.mean(axis=1)
    assert middle[1, 2] > middle[0, 2]
    assert middle[rows, 0] > middle[0, 0]
    assert middle[columns * rows, 1] > middle[0, 1]
    edges = [corners[:, k] - corners[:, 0] for k in (1, 3, 4)]
    volume = np.einsum("ij,ij->i", np.cross(edges[0], edges[1]), edges[2])
    a = (3 * 20.0 * 10e-3 / (2 * 230.769e9)) ** (1 / 3)
    assert volume.sum() == pytest.approx(3 * a * 2 * a * 1e-7)  # the block of the fake
    write_fields(film.fields, tmp_path / "film.vtu")
    written = meshio.read(tmp_path / "film.vtu")
    np.testing.assert_array_equal(written.cell_data["p"][0], np.arange(film.fields.p.size))
    (case,) = (tmp_path / "cases").iterdir()
    assert case.name == "point_36x18x2"
    with pytest.raises(SolverError, match="got a mesh of 2109 points; allowed: 2223, as asked"):
        read_point_fields(case, 38, 18, 2)
    with pytest.raises(SolverError, match="allowed: 650 lines of finite numbers under x y pressure film"):
        read_point_columns(case, 65, 10)
    (case / "results").write_text((case / "results").read_text().replace("compliance (", "compliance (1 "))
    with pytest.raises(SolverError, match=r"compliance: got .*; allowed: 2 finite numbers in brackets"):
        read_point_results(case)


def test_the_command_solves_both_contacts_of_a_ball(fake, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(cfd_points, "OpenFoamPointSolver", solver)
    point = ["solve", "6208", "--load", "100 N", "--speed", "3000 rpm", "--temperature", "60 degC"]
    files = ["--fields", "film.vtu", "--keep-cases", "cases"]
    assert main([*point, "--solver", "openfoam", "--json", *files]) == 0
    out, err = capsys.readouterr()
    inner, outer = json.loads(out)
    assert [inner["contact"], outer["contact"]] == ["inner", "outer"]
    assert inner["central_film"] == 1e-7
    assert inner["central_film_error"] == pytest.approx(0.008)
    assert "inner: half of the contact on 36 x 18 columns of 2 cells; film-inner.vtu: written" in err
    assert sorted(path.name for path in (tmp_path / "cases").iterdir()) == ["inner_36x18x2", "outer_36x18x2"]
    openfoam_fake.set_mode(fake, "stagnated")
    assert main([*point, "--solver", "openfoam"]) == 1
    assert "inner: ehlFoam stagnated: steps are cut to nothing" in capsys.readouterr().out


def test_a_picture_has_the_middle_of_the_film(fake):
    """Beside it the fake's pressure is even, a parabola: what is put at y = 0 is exact."""
    solution, said = cfd_points.CfdPoints(solver(), None).solve("inner", BALL, OIL, *PLACE)
    field = solution.field
    assert said == "inner: half of the contact on 36 x 18 columns of 2 cells"
    assert field.y[0] == 0.0 and field.pressure.shape == (36, 19)
    peak, a = 0.3 * 230.769e9 / 10e-3, (3 * 20.0 * 10e-3 / (2 * 230.769e9)) ** (1 / 3)
    assert field.pressure[:, 0] == pytest.approx(peak * a * np.maximum(1 - (field.x / a) ** 2, 0.0), rel=1e-6)


def test_options_of_the_other_solver_are_refused(fake, capsys):
    point = ["solve", "6208", "--load", "100 N", "--speed", "3 m/s", "--temperature", "60 degC"]
    assert main([*point, "--solver", "openfoam", "--films", "table", "--frequency", "100Hz"]) == 2
    err = capsys.readouterr().err
    assert "--frequency: stands beside --solver openfoam" in err
    assert "--films: got table beside --solver openfoam" in err
    assert main([*point, "--fields", "a.vtu", "--keep-cases", "b"]) == 2
    err = capsys.readouterr().err
    assert "--fields: is one of OpenFOAM; allowed: with --solver openfoam" in err
    assert "--keep-cases: is one of OpenFOAM; allowed: with --solver openfoam" in err
    assert main([*point, "--solver", "openfoam", "--fields", "a.txt"]) == 2
    assert "--fields" in capsys.readouterr().err
    assert main([*point, "--solver", "formula"]) == 2
    assert "allowed: reynolds, openfoam for the balls of a bearing" in capsys.readouterr().err


def test_kapitzas_film_carries_its_load():
    """The load of p = 12 eta u |x|/((3 + 2 D) h^2) by quadrature over a paraboloid; its steps leave 1e-3."""
    D, M = 0.4, 2.0
    h = kapitza_film(M, D)
    # lengths in Rx U^(1/4), films in Rx U^(1/2); pressures so that M is the load: 12 eta u = 6 U E' Rx
    x, y = np.meshgrid(np.sinh(np.linspace(0.0, 12.0, 401)), np.sinh(np.linspace(0.0, 12.0, 401)), indexing="ij")
    pressure = 6.0 * x / ((3.0 + 2.0 * D) * (h + 0.5 * x**2 + 0.5 * D * y**2) ** 2)
    load = 2.0 * np.trapezoid(np.trapezoid(pressure, y[0], axis=1), x[:, 0])
    assert load == pytest.approx(M, rel=1e-3)

"""Points by `ehlFoam`: against the other solver, in their balances, on meshes, by OpenFOAM's tools; what is refused."""

from __future__ import annotations

import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.openfoam.installation import Installation, installation
from ehdmaps.openfoam.point import OpenFoamPointSolver, PointFilm
from ehdmaps.openfoam.point_case import PointParameters, read_point_columns, read_point_results
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import Ellipse, curvature_ratio
from ehdmaps.physics.solution import Status
from ehdmaps.point import solve
from tests.cases import openfoam_runs
from tests.cases.programs import needed

pytestmark = pytest.mark.openfoam

TEMPLATE = Path(__file__).parents[2] / "openfoam_cases" / "lineContact"
OIL = Lubricant.named("FVA3")
CELSIUS_60 = 333.15
MESH = (48, 20, 4)
BALL = Ellipse(5e-3, 5e-3 / float(curvature_ratio(3.0)), 230.769e9)
PLACE = (0.23, 0.0295, CELSIUS_60)
"""A light ball on a groove: M 30, L 5, ellipticity 3."""


def solver(**changes: object) -> OpenFoamPointSolver:
    return OpenFoamPointSolver(**dict(zip(("columns", "lines", "rows"), MESH, strict=True)) | changes)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> tuple[PointFilm, Path]:
    """The point with its fields, and its case."""
    folder = tmp_path_factory.mktemp("point")
    film = solver(keep_cases=folder).solve(BALL, OIL, *PLACE, with_fields=True)
    assert film.status is Status.CONVERGED, film.reason
    (case,) = folder.iterdir()
    return film, case


def test_the_other_solver_finds_the_same(kept: tuple[PointFilm, Path]) -> None:
    """Within the errors that both state; k and films of 0.5 % of either are a mesh's error."""
    film, _ = kept
    other = solve(BALL, OIL, *PLACE)
    assert (film.load_number, film.oil_number) == (other.load_number, other.oil_number)
    for name in ("central_film", "minimum_film", "max_pressure", "film_offset", "approach", "stiffness", "damping"):
        bar = getattr(film, name).error + getattr(other, name).error
        assert abs(getattr(film, name) / getattr(other, name) - 1.0) < bar < 0.08, name
    for name in ("central_film", "film_offset", "stiffness"):
        assert getattr(film, name) == pytest.approx(getattr(other, name), rel=5e-3), name


def test_balances_of_the_film(kept: tuple[PointFilm, Path]) -> None:
    """Mass of columns and cells, and the load, to what Newton's method leaves."""
    film, case = kept
    results = read_point_results(case)
    assert results.mass_defect < 1e-8
    assert results.load_defect < 1e-8
    continuity = re.search(r"cellContinuity (\S+);", (case / "results").read_text())
    assert continuity is not None and float(continuity[1]) < 1e-8
    assert film.fields is not None and film.columns is not None
    # cells hold the load of half the contact, but for 2 % that a film as thick as this carries outside of the mesh
    corners = film.fields.points[film.fields.corners]
    areas = np.ptp(corners[..., 0], axis=1) * np.ptp(corners[..., 1], axis=1) / MESH[2]
    assert 2.0 * float(film.fields.p @ areas) == pytest.approx(PLACE[0], rel=0.03)
    assert film.fields.p.max() == pytest.approx(film.max_pressure, rel=1e-9)


def test_velocities_are_those_of_the_pressure(kept: tuple[PointFilm, Path]) -> None:
    """Poiseuille's parabola on the surfaces' speed, of each row the mean over it; 1 % of u is central differences'."""
    film, _ = kept
    assert film.fields is not None and film.columns is not None
    columns, lines, rows = MESH
    along = film.fields.U.reshape(lines, columns, rows, 3)[0, :, :, 0]
    viscosity = film.fields.mu.reshape(lines, columns, rows)[0, :, 0]
    x, p, h = film.columns.x, film.columns.pressure[:, 0], film.columns.film[:, 0]
    a = float(BALL.semi_axes(PLACE[0])[0])
    inside = (x > -1.5 * a) & (x < 0.2 * a)
    driven = along.mean(axis=1) - PLACE[1]
    assert np.abs(driven[inside]).max() > 0.2 * PLACE[1]  # not all of it is dragged
    expected = -(h**2) / (12.0 * viscosity) * np.gradient(p, x)
    np.testing.assert_allclose(driven[inside], expected[inside], atol=0.01 * PLACE[1])
    # means of 6 y (1 - y) over four rows; films of a cell and of its faces differ by what is allowed
    shape = np.array([0.625, 1.375, 1.375, 0.625])
    np.testing.assert_allclose(along[inside] - PLACE[1], np.outer(driven[inside], shape), atol=3e-3 * PLACE[1])


def test_tools_of_openfoam_take_the_mesh(kept: tuple[PointFilm, Path], installed: Installation) -> None:
    """Closed cells in upper triangular order, the six patches; that films are long and thin is all that it says."""
    _, case = kept
    check = needed("checkMesh")
    said = openfoam_runs.program(installed, check, case).stdout
    assert "Upper triangular ordering OK" in said
    assert "Boundary openness" in said and said.count(" OK.") > 10
    assert re.findall(r"\*\*\*(.*?),", said) == ["High aspect ratio cells found"]


def test_stated_errors_hold_on_a_finer_mesh(kept: tuple[PointFilm, Path]) -> None:
    """A mesh of half the cell, of a quarter of the error; the stated ones are not to be exceeded by half."""
    film, _ = kept
    fine = solver(columns=96, lines=40, rows=2).solve(BALL, OIL, *PLACE)
    for name in ("central_film", "film_offset", "stiffness", "minimum_film"):
        changed = abs(getattr(film, name) / getattr(fine, name) - 1.0)
        assert changed < 1.5 * getattr(film, name).error < 0.02, name
        assert getattr(fine, name).error < 0.7 * getattr(film, name).error, name


@pytest.fixture(scope="module")
def installed() -> Installation:
    return installation()


@pytest.fixture(scope="module")
def template_copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    case = tmp_path_factory.mktemp("bad") / "case"
    shutil.copytree(TEMPLATE, case, ignore=shutil.ignore_patterns("polyMesh", "1"))
    return case


def _said(installed: Installation, case: Path, text: str) -> str:
    (case / "constant" / "ehlProperties").write_text(text)
    return openfoam_runs.program(installed, installed.solver, case).stdout


GOOD = PointParameters(BALL, PLACE[0], PLACE[1], OIL.at(CELSIUS_60), 0.6, 36, 18, 2)
BAD = {
    "too many columns": (r"columns +\d+", "columns 2000", "columns, lines: got 2000 x 18, allowed are 8000 columns"),
    "too few lines": (r"lines +\d+", "lines 3", "lines: got 3, allowed are 12 to 8000"),
    "an ellipse along the motion": (
        r"transverseRadius [^;]*", "transverseRadius 1e-3",
        "got 0.005, 0.001, allowed are radii of an ellipse across the motion that is 1 to 20",
    ),
    "no radius": (r"transverseRadius [^;]*", "transverseRadius 0", "transverseRadius: got 0, allowed are numbers"),
    "another law of shear": (
        "type +Newtonian", "type Eyring; stress 5e6", "shear: got Eyring, allowed for a point is Newtonian"
    ),
    "all stresses": ("flow +thinFilm", "flow fullStress", "flow: got fullStress, allowed for a point is thinFilm"),
    "heat": ("writeFields +false;", "heat { }", "heat: is one of line contacts, allowed for a point are none"),
    "a start": ("writeFields +false;", "start { }", "start: is one of line contacts"),
    "surfaces against each other": ("lowerSpeed +", "lowerSpeed -", "allowed are speeds with a mean above 0"),
    "negative load": (r"\nload +", "\nload -", "load: got -0.23, allowed are numbers above 0"),
    "no film": (r"\n    film [^;]*", "\n    film 0", "film: got 0, allowed are numbers above 0"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_a_bad_dictionary_is_told(name: str, installed: Installation, template_copy: Path) -> None:
    old, new, message = BAD[name]
    text = GOOD.text()
    assert re.search(old, text)
    said = " ".join(_said(installed, template_copy, re.sub(old, new, text, count=1)).split())
    assert "FOAM FATAL IO ERROR" in said
    assert message in said, said[-600:]


def test_a_scheme_that_would_not_be_read_is_refused(installed: Installation, template_copy: Path) -> None:
    schemes = template_copy / "system" / "fvSchemes"
    before = schemes.read_text()
    schemes.write_text(before + "\ninterpolationSchemes { default cubic; }\n")
    try:
        assert 'interpolationSchemes, default: got "cubic"' in " ".join(
            _said(installed, template_copy, GOOD.text()).split()
        )
    finally:
        schemes.write_text(before)


def test_a_film_without_a_solution_is_a_status(installed: Installation, template_copy: Path) -> None:
    """A heavy circle on few columns, and a viscosity beyond all numbers: no crash, and no number is left."""
    circle = replace(BALL, transverse_radius=BALL.rolling_radius)
    heavy = replace(GOOD, ellipse=circle, load=6000.0, entrainment_speed=1e-3, film=0.002)
    absurd = re.sub(
        r"viscosity\n\{[^}]*\}", "viscosity { type Barus; viscosity 0.1; pressureViscosity 1e-5; }", GOOD.text()
    )
    for text in (heavy.text(), absurd):
        said = _said(installed, template_copy, text)
        assert "End" in said[-10:]
        results = read_point_results(template_copy)
        assert results.status in (Status.STAGNATED, Status.DIVERGED)
        assert results.reason
        assert np.isnan(results.central_film).all()


def test_the_table_is_that_of_the_fine_mesh(kept: tuple[PointFilm, Path]) -> None:
    film, case = kept
    columns = read_point_columns(case, *MESH[:2])
    assert columns.film.min() == pytest.approx(film.minimum_film, rel=1e-11)
    assert np.all(np.diff(columns.x) > 0) and np.all(np.diff(columns.y) > 0)
    broken = columns.liquid_fraction < 1.0
    assert broken[-1, : MESH[1] // 2].all() and not broken[columns.x < 0, 0].any()
    assert columns.pressure[broken].max() == 0.0

"""What `ehlFoam` says of a bad dictionary, and the case folder as somebody uses it by hand."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.openfoam.fields import read_fields, write_fields
from ehdmaps.openfoam.installation import Installation, installation
from ehdmaps.openfoam.results import read_film, read_results
from ehdmaps.openfoam.solver import OpenFoamSolver
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import Status
from tests.cases import openfoam_runs
from tests.cases.programs import needed

pytestmark = pytest.mark.openfoam

TEMPLATE = Path(__file__).parents[2] / "openfoam_cases" / "lineContact"
COLUMNS, ROWS = 60, 6

# what is replaced by what in a good file, what the message says, and where: a line, or the span of the file
BAD = {
    "unknown viscosity law": ("type +Roelands", "type Rolands", "Unknown viscosityLaw type Rolands", "viscosity"),
    "unknown density law": ("type +DowsonHigginson", "type Dowson", "Unknown densityLaw type Dowson", "density"),
    "unknown shear law": (
        "type +Newtonian;", "type Newton; stress 1e6;", "Unknown shearLaw type Newton", "shear"
    ),
    "shear law without its stress": ("type +Newtonian", "type Eyring", "Entry 'stress' not found", "shear"),
    "unknown flow": ("flow +thinFilm", "flow thickFilm", "Unknown flow type thickFilm", None),
    "missing entry": (r"\nload [^;]*;", "", "Entry 'load' not found", None),
    "missing entry of a law": (r"\n    viscosity .*", "", "Entry 'viscosity' not found", "viscosity"),
    "missing law": (r"\nviscosity\n[^}]*}", "", "Entry 'viscosity' not found", None),
    "negative load": (r"\nload +", "\nload -", "load: got -18742.*allowed are numbers above 0", None),
    "load that is no number": (r"\nload [^;]*", "\nload nan", "expected scalar value, found on line 13: .*nan", "load"),
    "infinite load": (r"\nload [^;]*", "\nload inf", "expected scalar value, found on line 13: .*inf", "load"),
    "no expected film": (r"\n    film [^;]*", "\n    film 0", "film: got 0, allowed are numbers above 0", "mesh"),
    "negative inlet": (r"inletLength [^;]*", "inletLength -3", "inletLength: got -3", "mesh"),
    "surfaces that roll against each other": (
        "lowerSpeed +", "lowerSpeed -", "lowerSpeed, upperSpeed: got .*allowed are speeds with a mean above 0", None
    ),
    "lists of two lengths": (
        r"\n    x +//[^(]*\(\s+\S+", "\n    x (", r"x, pressure: got lists of \d+ and \d+, allowed", "start"
    ),
    "frequency that is no number": (
        r"frequencies +\([^)]*\)", "frequencies (nan)", "expected scalar value", "response.frequencies"
    ),
    "one row": ("rows +6;", "rows 1;", "rows: got 1, allowed are 2 and more", None),
    "open bracket": (r"\nload +", "\nload {", "expected }", None),
}  # fmt: skip


@pytest.fixture(scope="module")
def installed() -> Installation:
    return installation()


@pytest.fixture(scope="module")
def good() -> str:
    return openfoam_runs.parameters(5.0, 5.0, COLUMNS, ROWS).text()


@pytest.fixture(scope="module")
def template_copy(installed: Installation, good: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    case = tmp_path_factory.mktemp("dictionary") / "case"
    shutil.copytree(installed.template, case, ignore=shutil.ignore_patterns("polyMesh"))
    (case / "constant" / "ehlProperties").write_text(good)
    return case


def _fatal(installed: Installation, case: Path, text: str) -> str:
    """Run ehlFoam with a bad dictionary; what it says after the banner."""
    properties = case / "constant" / "ehlProperties"
    properties.write_text(text)
    (case / "results").unlink(missing_ok=True)
    ended = openfoam_runs.program(installed, installed.solver, case)
    assert ended.returncode == 1
    if (case / "results").exists():  # what is read only after the solve: nobody may take it for a solution
        assert "status" not in (case / "results").read_text()
    assert "--> FOAM FATAL" in ended.stdout
    return ended.stdout[ended.stdout.index("--> FOAM FATAL") :]


def _replaced(good: str, pattern: str, by: str) -> str:
    text, count = re.subn(pattern, lambda _: by, good, count=1)
    assert count == 1
    return text


@pytest.mark.parametrize("name", BAD)
def test_bad_entry(name: str, installed: Installation, template_copy: Path, good: str) -> None:
    pattern, by, message, entry = BAD[name]
    said = _fatal(installed, template_copy, _replaced(good, pattern, by))
    assert said.startswith("--> FOAM FATAL IO ERROR")
    assert re.search(message, said)
    place = re.escape(str(template_copy / "constant" / "ehlProperties")) + ("" if entry is None else rf"\.{entry}")
    assert re.search(rf"file: {place} (at line \d+|from line \d+ to line \d+)", said)


# what a case may have for other programs of OpenFOAM, where it is added, and what the message says
UNREAD = {
    "fields with boundary conditions": ("0/p", "", "fields of the start: got .*/0/p\", allowed are none"),
    "function objects": ("system/controlDict", "functions { }", "functions: got them with writeFields false"),
    "interpolation": (
        "system/fvSchemes", "interpolationSchemes { default cubic; }",
        'interpolationSchemes, default: got "cubic", allowed is default linear',
    ),
    "a scheme of one term": (
        "system/fvSchemes", "divSchemes { div(phi,U) Gauss upwind; }",
        r'divSchemes, div\(phi,U\): got "Gauss upwind", allowed is default none',
    ),
    "a linear solver": ("system/fvSolution", "solvers { p { solver PCG; } }", "solvers: ehlFoam solves all equations"),
}  # fmt: skip


@pytest.mark.parametrize("name", UNREAD)
def test_what_would_not_be_read_is_refused(name: str, installed: Installation, template_copy: Path, good: str) -> None:
    where, added, message = UNREAD[name]
    path = template_copy / where
    before = path.read_text() if path.exists() else None
    path.parent.mkdir(exist_ok=True)
    path.write_text(f"{before or ''}\n{added}\n")
    try:
        assert re.search(message, _fatal(installed, template_copy, good))
    finally:
        path.unlink() if before is None else path.write_text(before)


FUNCTIONS = """
functions
{
    walls
    {
        type            surfaceFieldValue;
        libs            (fieldFunctionObjects);
        regionType      patch;
        name            lower;
        fields          (p);
        operation       areaIntegrate;
        writeFields     false;
    }
}
"""


def test_function_objects_run_on_the_fields(installed: Installation, template_copy: Path, good: str) -> None:
    """One of OpenFOAM's own finds the load on the lower surface."""
    control = template_copy / "system" / "controlDict"
    before = control.read_text()
    (template_copy / "constant" / "ehlProperties").write_text(
        _replaced(good, r"writeFields +false", "writeFields true")
    )
    control.write_text(before + FUNCTIONS)
    try:
        ended = openfoam_runs.program(installed, installed.solver, template_copy)
    finally:
        control.write_text(before)
    assert ended.returncode == 0, ended.stdout[-500:]
    (table,) = (template_copy / "postProcessing" / "walls").rglob("*.dat")
    time, force = map(float, table.read_text().splitlines()[-1].split())
    assert time == 1.0
    depth = 1e-6
    load = re.search(r"\nload +([^;]*);", good)
    assert load is not None
    assert force / depth == pytest.approx(float(load[1]), rel=1e-3)  # oil upstream of the inlet carries 2e-4
    fields = read_fields(template_copy)
    widths = np.ptp(fields.points[fields.corners][:, :, 0], axis=1)
    # faces are larger than their projections by half of the square of the surface's slope; 10 digits of the points
    assert force / depth == pytest.approx(float(fields.p @ widths) / ROWS, rel=1e-5)


def test_numbers_that_overflow_are_a_status(installed: Installation, template_copy: Path, good: str) -> None:
    """Not a floating point exception, on which OpenFOAM aborts: a viscosity far beyond the largest number."""
    (template_copy / "constant" / "ehlProperties").write_text(
        _replaced(good, r"viscosity\n\{[^}]*\}", "viscosity { type Barus; viscosity 0.1; pressureViscosity 1e-5; }")
    )
    ended = openfoam_runs.program(installed, installed.solver, template_copy)
    assert ended.returncode == 0, ended.stdout[-500:]
    assert read_results(template_copy).status in (Status.DIVERGED, Status.STAGNATED)


def test_a_kept_case_by_hand_gives_the_same_again(installed: Installation, tmp_path: Path) -> None:
    solver = OpenFoamSolver(columns=100, rows=4, installed=installed, keep_cases=tmp_path / "kept")
    contact, *_ = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")
    (film,) = solver.solve_line(contact, Lubricant.named("FVA3"), (2e4,), 2.0, 333.15)
    (case,) = (tmp_path / "kept").glob("*_100x4")
    for name in ("results", "film.dat"):
        (case / name).unlink()
    ended = subprocess.run(["sh", "Allrun"], cwd=case, capture_output=True, text=True, timeout=120.0, check=False)
    assert ended.returncode == 0, ended.stderr
    assert read_results(case).central_film == film.central_film
    subprocess.run([case / "Allclean"], cwd=tmp_path, timeout=20.0, check=True)
    assert not (case / "results").exists() and not (case / "1").exists()


def test_case_by_hand(installed: Installation, tmp_path: Path) -> None:
    case = tmp_path / "lineContact"
    shutil.copytree(TEMPLATE, case, ignore=shutil.ignore_patterns("polyMesh", "1", "results", "film.dat", "log.*"))
    before = sorted(path.relative_to(case) for path in case.rglob("*"))
    ended = subprocess.run([case / "Allrun"], cwd=tmp_path, capture_output=True, text=True, timeout=120.0, check=False)
    assert ended.returncode == 0, ended.stderr
    assert "converged" in ended.stdout
    results = read_results(case)
    assert results.status is Status.CONVERGED
    assert read_film(case, 400).film.min() == pytest.approx(results.minimum_film, rel=0.01)  # half a column between
    assert {path.name for path in (case / "1").iterdir()} >= {"p", "U", "mu", "rho", "liquidFraction"}

    fields = read_fields(case)
    assert fields.p.size == 400 * 6
    assert fields.p.max() == pytest.approx(results.max_pressure, rel=1e-6)  # digits in the files
    write_fields(fields, tmp_path / "film.vtu")
    assert (tmp_path / "film.vtu").stat().st_size > 0
    to_vtk = needed("foamToVTK")
    ended = openfoam_runs.program(installed, to_vtk, case)
    assert ended.returncode == 0, ended.stdout[-2000:]
    (written,) = (case / "VTK").rglob("internal.vtu")
    import meshio

    data = meshio.read(written).cell_data
    assert {"p", "U", "mu", "rho", "liquidFraction"} <= set(data)
    assert data["p"][0].max() == pytest.approx(results.max_pressure, rel=1e-5)  # single precision
    shutil.rmtree(case / "VTK")

    assert subprocess.run([case / "Allclean"], check=False).returncode == 0
    assert sorted(path.relative_to(case) for path in case.rglob("*")) == before

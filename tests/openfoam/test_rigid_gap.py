"""The flow in the film of a converged contact, solved again by a stock solver of OpenFOAM on the same mesh.

simpleFoam knows nothing of elasticity, of cavitation or of thin films: it is given the mesh of the film upstream of its
rupture, the speeds of the surfaces and the pressures at both ends. Mass flux and pressure in between are its own.
"""

from __future__ import annotations

import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.arrays import FloatArray
from ehdmaps.openfoam.fields import read_fields
from ehdmaps.openfoam.installation import Installation, installation
from ehdmaps.openfoam.parameters import Mesh
from tests.cases import openfoam_runs
from tests.cases.programs import needed

pytestmark = pytest.mark.openfoam

ROWS = 12

HEADER = "FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"

CONTROL = """
application simpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 3000; deltaT 1;
writeControl timeStep; writeInterval 3000; writeFormat ascii; writePrecision 14; timePrecision 8;
"""

BLOCK = f"""
scale 1;
vertices ((0 0 0) (0 1 0) (0 1 1) (0 0 1) (1 0 0) (1 1 0) (1 1 1) (1 0 1));
blocks (hex (0 1 2 3 4 5 6 7) ({ROWS} 1 COLUMNS) simpleGrading (1 1 1));
edges (); mergePatchPairs ();
boundary
(
    inlet {{ type patch; faces ((0 1 2 3)); }}
    outlet {{ type patch; faces ((4 5 6 7)); }}
    lower {{ type wall; faces ((0 4 7 3)); }}
    upper {{ type wall; faces ((1 5 6 2)); }}
    frontAndBack {{ type empty; faces ((0 1 5 4) (3 2 6 7)); }}
);
"""
"""A block that ehlFoam's own is numbered like."""

SCHEMES = """
ddtSchemes { default steadyState; }
gradSchemes { default Gauss linear; }
divSchemes { default none; div(phi,U) Gauss linear; div((nuEff*dev2(T(grad(U))))) Gauss linear; }
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }
"""

SOLUTION = """
solvers
{
    p { solver PCG; preconditioner DIC; tolerance 1e-14; relTol 1e-3; }
    U { solver PBiCGStab; preconditioner DILU; tolerance 1e-14; relTol 1e-3; }
}
SIMPLE { consistent yes; nNonOrthogonalCorrectors 0; residualControl { p 1e-9; U 1e-9; } }
relaxationFactors { equations { U 0.95; } }
"""


def _write(case: Path, name: str, kind: str, text: str) -> None:
    path = case / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEADER.format(kind=kind, name=path.name) + text)


def _numbers(path: Path, width: int) -> FloatArray:
    """The list of numbers or vectors in a file of OpenFOAM."""
    found = re.search(r"\n(\d+)\s*\n\(\n", text := path.read_text())
    assert found is not None
    words = text[found.end() :].translate(str.maketrans("()", "  ")).split(None, int(found[1]) * width)
    return np.array(words[: int(found[1]) * width], dtype=float).reshape(-1, width)


def _vectors(values: FloatArray) -> str:
    return "(" + " ".join("({:.15g} {:.15g} {:.15g})".format(*value) for value in values) + ")"


def _mesh(case: Path, solved: Path, columns: int, installed: Installation) -> FloatArray:
    """The first columns of a solved mesh; returns its points, shape (columns + 1, 2, rows + 1, 3)."""
    shutil.copytree(installed.template / "system", case / "system")
    _write(case, "system/blockMeshDict", "dictionary", BLOCK.replace("COLUMNS", str(columns)))
    assert openfoam_runs.program(installed, "blockMesh", case).returncode == 0
    points = _numbers(solved / "constant" / "polyMesh" / "points", 3).reshape(-1, 2, ROWS + 1, 3)[: columns + 1]
    _write(case, "constant/polyMesh/points", "vectorField", f"{points.size // 3}\n{_vectors(points.reshape(-1, 3))}")
    return points


def _inlet_pressure(solved: Path) -> float:
    """Pressure that ehlFoam gives the inlet, of the film before it [Pa]."""
    found = re.search(r"inlet\s*\{[^}]*value\s+uniform\s+(\S+);", (solved / "1" / "p").read_text())
    assert found is not None
    return float(found[1])


def _wall_speeds(points: FloatArray, case: Path, patch: str, speed: float) -> str:
    """A surface that moves along itself, face by face in the order of its patch."""
    edge = points[:, 0, 0 if patch == "lower" else -1]
    along = np.diff(edge, axis=0)
    along *= speed / np.linalg.norm(along, axis=1, keepdims=True)
    boundary = (case / "constant" / "polyMesh" / "boundary").read_text()
    first = re.search(rf"\b{patch}\b[^}}]*nFaces\s+(\d+);[^}}]*startFace\s+(\d+);", boundary)
    assert first is not None
    owner = _numbers(case / "constant" / "polyMesh" / "owner", 1)[:, 0].astype(int)
    faces = owner[int(first[2]) : int(first[2]) + int(first[1])] // ROWS
    return f"{patch} {{ type fixedValue; value nonuniform List<vector> {len(faces)} {_vectors(along[faces])}; }}"


def _differences(folder: Path, columns: int) -> tuple[float, float, float]:
    """What simpleFoam has else: pressure over the peak pressure, mass flux, and how much its flux varies along x."""
    installed = installation()
    simple_foam = needed("simpleFoam")
    settings = openfoam_runs.parameters(0.02, 0.0, columns, ROWS, flow="full_stress", slide_to_roll=0.5)
    mesh = Mesh(film=settings.mesh.film, inlet_length=10.0)
    found = openfoam_runs.run(replace(settings, mesh=mesh), keep=folder)
    solved = next(folder.glob("case*"))
    pressure = read_fields(solved).p.reshape(columns, ROWS).mean(axis=1)
    peak = float(pressure.max())

    # the cut: where the pressure has fallen to a tenth, well before the film ruptures
    cut = int(np.flatnonzero(pressure > 0.1 * peak)[-1]) + 1
    assert (found.film.liquid_fraction[: cut + 3] >= 1.0).all()
    case = folder / "simple"
    points = _mesh(case, solved, cut, installed)
    before, behind = found.film.x[cut - 1], found.film.x[cut]
    weight = (points[-1, 0, 0, 0] - before) / (behind - before)
    at_cut = (1.0 - weight) * pressure[cut - 1] + weight * pressure[cut]

    at_inlet = _inlet_pressure(solved)
    density, viscosity = settings.oil.density, settings.oil.viscosity
    walls = " ".join(
        _wall_speeds(points, case, patch, speed)
        for patch, speed in (("lower", settings.lower_speed), ("upper", settings.upper_speed))
    )
    _write(
        case,
        "0/U",
        "volVectorField",
        f"dimensions [0 1 -1 0 0]; internalField uniform ({settings.lower_speed:.15g} 0 0);\n"
        "boundaryField { inlet { type zeroGradient; } outlet { type zeroGradient; }"
        f" {walls} frontAndBack {{ type empty; }} }}",
    )
    _write(
        case,
        "0/p",
        "volScalarField",
        "dimensions [0 2 -2 0 0]; internalField uniform 0;\n"
        f"boundaryField {{ inlet {{ type fixedValue; value uniform {at_inlet / density:.15g}; }}"
        f" outlet {{ type fixedValue; value uniform {at_cut / density:.15g}; }}"
        " lower { type zeroGradient; } upper { type zeroGradient; } frontAndBack { type empty; } }",
    )
    # simpleFoam takes the gradient at a wall from the cell beside it: pressure drives 1 + 2/rows^2 of the flux of a
    # parabola: 3/2 at the walls, 1/2 of the midpoint rule. An oil more viscous by that gives it the parabola's flux.
    nu = viscosity / density * (1.0 + 2.0 / ROWS**2)
    oil = f"transportModel Newtonian; nu [0 2 -1 0 0] {nu:.15g};"
    _write(case, "constant/transportProperties", "dictionary", oil)
    _write(case, "constant/turbulenceProperties", "dictionary", "simulationType laminar;")
    _write(case, "system/controlDict", "dictionary", CONTROL)
    _write(case, "system/fvSchemes", "dictionary", SCHEMES)
    _write(case, "system/fvSolution", "dictionary", SOLUTION)
    assert "SIMPLE solution converged" in openfoam_runs.program(installed, simple_foam, case).stdout

    last = max((path for path in case.iterdir() if path.name.isdigit()), key=lambda path: int(path.name))
    its_pressure = density * _numbers(last / "p", 1)[:, 0].reshape(cut, ROWS).mean(axis=1)
    flux = density * _numbers(last / "phi", 1)[:, 0]
    owner = _numbers(case / "constant" / "polyMesh" / "owner", 1)[: flux.size, 0].astype(int) // ROWS
    neighbour = _numbers(case / "constant" / "polyMesh" / "neighbour", 1)[:, 0].astype(int) // ROWS
    along = owner != neighbour
    its_flux = np.bincount(owner[along], flux[along]) / np.ptp(points[..., 2])
    return (
        float(np.abs(its_pressure - pressure[:cut]).max()) / peak,
        float(its_flux.mean() / found.film.flux[0]) - 1.0,
        float(np.ptp(its_flux) / its_flux.mean()),
    )


def test_pressure_and_flux_of_simple_foam(tmp_path: Path) -> None:
    differences = {}
    for columns in (120, 240):
        folder = tmp_path / str(columns)
        folder.mkdir()
        differences[columns] = _differences(folder, columns)
        pressure, flux, variation = differences[columns]
        # iteration error of simpleFoam, which has to be small beside what is compared
        assert variation < 1e-6
        # discretisation: across the film both have the flux of a parabola; along it they differ by how fluxes are taken
        # to the faces, and in the half column before the cut, where velocity has zero gradient: O(1/columns^2)
        assert pressure < 5e-3
        assert abs(flux) < 1e-3
    # of second order 4; 3 leaves room for the cut, which does not stand at the same place
    assert differences[240][0] < differences[120][0] / 3.0

"""Flow between two surfaces by simpleFoam, a stock solver of OpenFOAM that knows convection, and no thin films."""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.openfoam.installation import Installation, installation
from tests.cases import openfoam_runs

HEADER = "FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"

CONTROL = """
application simpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 3000; deltaT 1;
writeControl timeStep; writeInterval 3000; writeFormat ascii; writePrecision 14; timePrecision 8;
"""

BLOCK = """
scale 1;
vertices ((0 0 0) (0 1 0) (0 1 1) (0 0 1) (1 0 0) (1 1 0) (1 1 1) (1 0 1));
blocks (hex (0 1 2 3 4 5 6 7) (ROWS 1 COLUMNS) simpleGrading (1 1 1));
edges (); mergePatchPairs ();
boundary
(
    inlet { type patch; faces ((0 1 2 3)); }
    outlet { type patch; faces ((4 5 6 7)); }
    lower { type wall; faces ((0 4 7 3)); }
    upper { type wall; faces ((1 5 6 2)); }
    frontAndBack { type empty; faces ((0 1 5 4) (3 2 6 7)); }
);
"""
"""A block that ehlFoam's own is numbered like."""

SCHEMES = """
ddtSchemes { default steadyState; }
gradSchemes { default Gauss linear; }
divSchemes { default none; div(phi,U) Gauss CONVECTION; div((nuEff*dev2(T(grad(U))))) Gauss linear; }
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
relaxationFactors { equations { U RELAXED; } }
"""


@dataclass(frozen=True)
class GapFlow:
    """Pressure, the mean of each column, shape (columns,) [Pa], and mass flux between columns [kg/(m s)]."""

    pressure: FloatArray
    flux: FloatArray


def numbers(path: Path, width: int) -> FloatArray:
    """The list of numbers or vectors in a file of OpenFOAM."""
    found = re.search(r"\n(\d+)\s*\n\(\n", text := path.read_text())
    assert found is not None
    words = text[found.end() :].translate(str.maketrans("()", "  ")).split(None, int(found[1]) * width)
    return np.array(words[: int(found[1]) * width], dtype=float).reshape(-1, width)


def gap_flow(
    case: Path,
    points: FloatArray,
    speeds: tuple[float, float],
    ends: tuple[float, float],
    density: float,
    viscosity: float,
    *,
    convection: str = "linear",
    relaxed: float = 0.95,
    program: str | Path = "simpleFoam",
) -> GapFlow:
    """Solve the steady flow of an incompressible oil.

    Parameters
    ----------
    case : Path
        New folder.
    points : ndarray, shape (columns + 1, 2, rows + 1, 3)
        Corners of the cells, from inlet to outlet and from the lower to the upper surface [m].
    speeds, ends : tuple of float
        Of the lower and the upper surface along themselves [m/s]; pressures at inlet and outlet [Pa].
    density, viscosity : float
        [kg/m3], [Pa s].
    convection, relaxed : str, float
        Interpolation of the velocity that is carried, and the share of its steps.
    program : str or Path
        simpleFoam.
    """
    installed = installation()
    columns, rows = points.shape[0] - 1, points.shape[2] - 1
    _mesh(case, points, installed)
    walls = " ".join(
        _wall_speeds(points, case, patch, speed) for patch, speed in zip(("lower", "upper"), speeds, strict=True)
    )
    _write(
        case,
        "0/U",
        "volVectorField",
        f"dimensions [0 1 -1 0 0]; internalField uniform ({speeds[0]:.15g} 0 0);\n"
        "boundaryField { inlet { type zeroGradient; } outlet { type zeroGradient; }"
        f" {walls} frontAndBack {{ type empty; }} }}",
    )
    _write(
        case,
        "0/p",
        "volScalarField",
        "dimensions [0 2 -2 0 0]; internalField uniform 0;\n"
        f"boundaryField {{ inlet {{ type fixedValue; value uniform {ends[0] / density:.15g}; }}"
        f" outlet {{ type fixedValue; value uniform {ends[1] / density:.15g}; }}"
        " lower { type zeroGradient; } upper { type zeroGradient; } frontAndBack { type empty; } }",
    )
    # simpleFoam takes the gradient at a wall from the cell beside it: pressure drives 1 + 2/rows^2 of the flux of a
    # parabola: 3/2 at the walls, 1/2 of the midpoint rule. An oil more viscous by that gives it the parabola's flux.
    nu = viscosity / density * (1.0 + 2.0 / rows**2)
    oil = f"transportModel Newtonian; nu [0 2 -1 0 0] {nu:.15g};"
    _write(case, "constant/transportProperties", "dictionary", oil)
    _write(case, "constant/turbulenceProperties", "dictionary", "simulationType laminar;")
    _write(case, "system/controlDict", "dictionary", CONTROL)
    _write(case, "system/fvSchemes", "dictionary", SCHEMES.replace("CONVECTION", convection))
    _write(case, "system/fvSolution", "dictionary", SOLUTION.replace("RELAXED", f"{relaxed:g}"))
    assert "SIMPLE solution converged" in openfoam_runs.program(installed, program, case).stdout

    last = max((path for path in case.iterdir() if path.name.isdigit()), key=lambda path: int(path.name))
    pressure = density * numbers(last / "p", 1)[:, 0].reshape(columns, rows).mean(axis=1)
    flux = density * numbers(last / "phi", 1)[:, 0]
    owner = numbers(case / "constant" / "polyMesh" / "owner", 1)[: flux.size, 0].astype(int) // rows
    neighbour = numbers(case / "constant" / "polyMesh" / "neighbour", 1)[:, 0].astype(int) // rows
    along = owner != neighbour
    return GapFlow(pressure, np.bincount(owner[along], flux[along]) / np.ptp(points[..., 2]))


def _write(case: Path, name: str, kind: str, text: str) -> None:
    path = case / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEADER.format(kind=kind, name=path.name) + text)


def _vectors(values: FloatArray) -> str:
    return "(" + " ".join("({:.15g} {:.15g} {:.15g})".format(*value) for value in values) + ")"


def _mesh(case: Path, points: FloatArray, installed: Installation) -> None:
    """A block of so many cells, with its points where they are wanted."""
    shutil.copytree(installed.template / "system", case / "system")
    cells = BLOCK.replace("COLUMNS", str(points.shape[0] - 1)).replace("ROWS", str(points.shape[2] - 1))
    _write(case, "system/blockMeshDict", "dictionary", cells)
    assert openfoam_runs.program(installed, "blockMesh", case).returncode == 0
    _write(case, "constant/polyMesh/points", "vectorField", f"{points.size // 3}\n{_vectors(points.reshape(-1, 3))}")


def _wall_speeds(points: FloatArray, case: Path, patch: str, speed: float) -> str:
    """A surface that moves along itself, face by face in the order of its patch."""
    edge = points[:, 0, 0 if patch == "lower" else -1]
    along = np.diff(edge, axis=0)
    along *= speed / np.linalg.norm(along, axis=1, keepdims=True)
    boundary = (case / "constant" / "polyMesh" / "boundary").read_text()
    first = re.search(rf"\b{patch}\b[^}}]*nFaces\s+(\d+);[^}}]*startFace\s+(\d+);", boundary)
    assert first is not None
    owner = numbers(case / "constant" / "polyMesh" / "owner", 1)[:, 0].astype(int)
    faces = owner[int(first[2]) : int(first[2]) + int(first[1])] // (points.shape[2] - 1)
    return f"{patch} {{ type fixedValue; value nonuniform List<vector> {len(faces)} {_vectors(along[faces])}; }}"

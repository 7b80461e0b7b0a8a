"""The flow in the film of a converged contact, solved again by a stock solver of OpenFOAM on the same mesh.

simpleFoam knows nothing of elasticity, of cavitation or of thin films: it is given the mesh of the film upstream of its
rupture, the speeds of the surfaces and the pressures at both ends. Mass flux and pressure in between are its own.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.openfoam.fields import read_fields
from ehdmaps.openfoam.parameters import Mesh
from tests.cases import openfoam_runs
from tests.cases.programs import needed
from tests.cases.simple_gap import gap_flow, numbers

pytestmark = pytest.mark.openfoam

ROWS = 12


def _inlet_pressure(solved: Path) -> float:
    """Pressure that ehlFoam gives the inlet, of the film before it [Pa]."""
    found = re.search(r"inlet\s*\{[^}]*value\s+uniform\s+(\S+);", (solved / "1" / "p").read_text())
    assert found is not None
    return float(found[1])


def _differences(folder: Path, columns: int) -> tuple[float, float, float]:
    """What simpleFoam has else: pressure over the peak pressure, mass flux, and how much its flux varies along x."""
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
    points = numbers(solved / "constant" / "polyMesh" / "points", 3).reshape(-1, 2, ROWS + 1, 3)[: cut + 1]
    before, behind = found.film.x[cut - 1], found.film.x[cut]
    weight = (points[-1, 0, 0, 0] - before) / (behind - before)
    at_cut = (1.0 - weight) * pressure[cut - 1] + weight * pressure[cut]

    flow = gap_flow(
        folder / "simple",
        points,
        (settings.lower_speed, settings.upper_speed),
        (_inlet_pressure(solved), at_cut),
        settings.oil.density,
        settings.oil.viscosity,
        program=simple_foam,
    )
    return (
        float(np.abs(flow.pressure - pressure[:cut]).max()) / peak,
        float(flow.flux.mean() / found.film.flux[0]) - 1.0,
        float(np.ptp(flow.flux) / flow.flux.mean()),
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

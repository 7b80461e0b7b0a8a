"""The oil of ehlFoam is the oil of Python: viscosity and density in the cells of a solved film, law by law."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.openfoam.fields import read_fields
from ehdmaps.physics.lubricant import Lubricant
from tests.cases import openfoam_runs

pytestmark = pytest.mark.openfoam

STATED = {"viscosity": openfoam_runs.VISCOSITY, "density": 880.0}
FREE_VOLUME = {
    "doolittle_slope": 3.5,
    "occupied_fraction": 0.66,
    "occupied_expansion": -7e-4,
    "volume_expansion": 8e-4,
    "bulk_modulus": 8.7e9,
    "bulk_modulus_decay": 6.3e-3,
    "bulk_modulus_slope": 11.0,
    "reference_temperature": 313.15,
}
OILS = {
    "barus": Lubricant.barus(**STATED, pressure_viscosity=openfoam_runs.ALPHA, density_law="incompressible"),
    "roelands": openfoam_runs.ROELANDS,
    "fva3": Lubricant.fva3(**STATED, pressure_viscosity=openfoam_runs.ALPHA),
    "tait-doolittle": Lubricant.own("tait-doolittle", FREE_VOLUME, **STATED),
}


@pytest.mark.parametrize("temperature", [313.15, 353.15])
@pytest.mark.parametrize("law", OILS)
def test_viscosity_and_density_of_the_cells(law: str, temperature: float, tmp_path: Path) -> None:
    oil = OILS[law].at(temperature)
    solution = openfoam_runs.run(replace(openfoam_runs.parameters(10.0, 5.0), oil=oil), keep=tmp_path)
    (case,) = [path.parent for path in tmp_path.rglob("constant") if path.is_dir()]
    fields = read_fields(case)
    liquid = fields.liquid_fraction == 1.0
    p = np.maximum(fields.p[liquid], 0.0)
    assert p.max() > 2e8 and solution.results is not None
    # ten digits of p, mu and rho in the fields: ln eta changes by up to 20 * 5e-11 with the digits of p
    np.testing.assert_allclose(fields.mu[liquid], oil.viscosity_at(p), rtol=2e-9)
    np.testing.assert_allclose(fields.rho[liquid], oil.density * oil.density_ratio(p), rtol=2e-10)

"""The oil of ehlFoam is the oil of Python, law by law: viscosity, density, shear stress; and in the cells of a film."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ehdmaps.arrays import FloatArray
from ehdmaps.openfoam.fields import read_fields
from ehdmaps.openfoam.parameters import Parameters
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rheology import CARREAU, EYRING, LIMITING, ShearLaw, yielding
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
TEMPERATURES = (313.15, 353.15)
PRESSURES = np.array([0.0, 1e5, 1e7, 1e8, 3e8, 7e8, 1.1e9, 2e9])
"""Up to where all laws are finite; the free-volume law goes on along its tangent from about 1 GPa."""

RATES = np.array([0.0, 1.0, 1e3, 1e5, 1e7, 1e9])
STRESS = 5e6
SHEAR_LAWS = {
    "newtonian": ShearLaw(),
    "eyring": ShearLaw(EYRING, STRESS),
    "carreau": ShearLaw(CARREAU, STRESS, exponent=0.4),
    "limiting": ShearLaw(LIMITING, STRESS, ratio=0.05),
}


@pytest.fixture(scope="module")
def settings() -> Parameters:
    return openfoam_runs.parameters(10.0, 5.0)


def _table(case: Path, settings: Parameters) -> FloatArray:
    """Viscosity, density and stress of a case's oil at all pressures and rates, shape (pressures, rates, 3)."""
    table = openfoam_runs.table(settings, case, "laws", pressure=PRESSURES, rate=RATES)
    np.testing.assert_array_equal(table[:, 0], np.repeat(PRESSURES, RATES.size))
    np.testing.assert_array_equal(table[:, 1], np.tile(RATES, PRESSURES.size))
    return table[:, 2:].reshape(PRESSURES.size, RATES.size, 3)


@pytest.mark.parametrize("law", OILS)
def test_viscosity_and_density(law: str, settings: Parameters, tmp_path: Path) -> None:
    for temperature in TEMPERATURES:
        oil = OILS[law].at(temperature)
        viscosity, density, stress = _table(tmp_path / str(temperature), replace(settings, oil=oil)).transpose(2, 1, 0)
        # round-off of ln eta, which is some tens at most
        np.testing.assert_allclose(viscosity[0], oil.viscosity_at(PRESSURES), rtol=1e-12)
        np.testing.assert_allclose(density[0], oil.density * oil.density_ratio(PRESSURES), rtol=1e-14)
        np.testing.assert_allclose(stress, RATES[:, None] * viscosity, rtol=1e-15)


@pytest.mark.parametrize("name", SHEAR_LAWS)
def test_shear_stress(name: str, settings: Parameters, tmp_path: Path) -> None:
    law = SHEAR_LAWS[name]
    viscosity, _, stress = _table(tmp_path / "case", replace(settings, shear=law)).transpose(2, 0, 1)
    newton = viscosity * RATES
    assert newton.max() > 1e9 * STRESS and newton[newton > 0.0].min() < 1e-6 * STRESS
    expected = [
        [stress * yielding(law, stress, p)[0] for stress in line]
        for p, line in zip(PRESSURES.tolist(), newton.tolist(), strict=True)
    ]
    # round-off of ln eta and of powers of up to 1e18 by the exponent of the limiting law beyond its bound
    np.testing.assert_allclose(stress, expected, rtol=1e-12)


def test_viscosity_and_density_of_the_cells(settings: Parameters, tmp_path: Path) -> None:
    oil = OILS["fva3"].at(TEMPERATURES[0])
    openfoam_runs.run(replace(settings, oil=oil, columns=60, rows=6), keep=tmp_path)
    (case,) = [path.parent for path in tmp_path.rglob("constant") if path.is_dir()]
    fields = read_fields(case)
    liquid = fields.liquid_fraction == 1.0
    p = np.maximum(fields.p[liquid], 0.0)
    assert p.max() > 2e8
    # ten digits of p, mu and rho in the fields: ln eta changes by up to 20 * 5e-11 with the digits of p
    np.testing.assert_allclose(fields.mu[liquid], oil.viscosity_at(p), rtol=2e-9)
    np.testing.assert_allclose(fields.rho[liquid], oil.density * oil.density_ratio(p), rtol=2e-10)

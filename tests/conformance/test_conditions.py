"""Heat, oil supply and roughness reach the films of every kind of bearing, alone and together, and are not lost."""

from __future__ import annotations

import dataclasses
from unittest import mock

import numpy as np
import pytest

from ehdmaps.physics import heat
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.surface import SMOOTH, Surface
from mbs.analyses.statics import statics
from mbs.scene.assembly import Model, assemble
from mbs.scene.reader import parse_scene
from tests.conformance.machines import KINDS, Machine

OIL = {"density": 880.0, "viscosity_40": 100e-6, "viscosity_100": 11e-6, "pressure_viscosity": 2e-8}
LAYER, ROUGH = OilSupply(0.3e-6), Surface(0.8e-6)
ALONE = {
    "cylindrical": ("heat", "supply", "surface"),
    "deep groove": ("heat", "supply", "surface"),
    "tapered": ("heat",),
}
"""What each kind has alone: films of tapered rollers are those of lines, which cylindrical ones have."""

WITH_FILMS = [machine for machine in KINDS if machine.name in ALONE]


def made(
    machine: Machine,
    warm: bool | None = False,
    supply: OilSupply = FLOODED,
    surface: Surface = SMOOTH,
    **oil: float | str | None,
) -> Model:
    """The machine with films of the table and its own oil, at 6000 rpm; `oil` are other numbers of that."""
    text = machine.text().replace('speed = "1500 rpm"', 'speed = "6000 rpm"')
    scene = dataclasses.replace(parse_scene(text, machine.name, "machine.toml"), surface=surface)
    scene = dataclasses.replace(scene, lubricant=Lubricant.barus(**OIL, **{"thermal_conductivity": 0.13, **oil}))
    return assemble(scene, "table", supply=supply, inlet_heat=warm)


def matrices(model: Model) -> np.ndarray:
    """K and C of all bearings in equilibrium."""
    found = statics(model).dataset
    return np.stack([found["bearing_stiffness"].values, found["bearing_damping"].values])


@pytest.mark.slow
@pytest.mark.parametrize("machine", WITH_FILMS, ids=lambda machine: machine.name)
def test_conditions_change_films_and_are_kept(machine):
    """Each alone changes K or C of every bearing, by more than 1e-4 of it: nothing is switched off silently. Heat is on
    by default, off and said so of an oil whose conductivity nobody knows, and nothing where no oil heats up. A model
    that is made again of its own scene has all of them, to round-off of the equilibrium."""
    plain = matrices(made(machine))
    each = {"heat": {"warm": True}, "supply": {"supply": LAYER}, "surface": {"surface": ROUGH}}
    for name in ALONE[machine.name]:
        found = matrices(made(machine, **each[name]))
        for bearing in range(plain.shape[1]):
            change = np.abs(found - plain)[:, bearing].max(axis=(1, 2)) / np.abs(plain[:, bearing]).max(axis=(1, 2))
            assert change.max() > 1e-4, (name, bearing)
    heated = made(machine, True)
    assert made(machine, None).law == heated.law and "inlet heat" in heated.law
    unknown = made(machine, None, thermal_conductivity=None)
    assert "isothermal" in unknown.law and np.array_equal(matrices(unknown), plain)
    with mock.patch.object(heat, "HEATING", 0.0):
        none = matrices(made(machine, True, heat_capacity=2000.5))  # which the rule does not know
    np.testing.assert_allclose(none, plain, rtol=1e-9, atol=1e-9 * np.abs(plain).max())  # of the equilibrium
    model = made(machine, True, LAYER, ROUGH)
    again = model.again(model.scene)
    assert again.law == model.law
    np.testing.assert_allclose(matrices(again), matrices(model), rtol=1e-6, atol=1e-6)

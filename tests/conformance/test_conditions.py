"""Heat, oil supply and roughness reach the films of every kind of bearing, alone and together, and are not lost."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.surface import SMOOTH, Surface
from mbs.analyses.statics import statics
from mbs.scene.assembly import Model, assemble
from mbs.scene.reader import parse_scene
from tests.conformance.machines import KINDS, Machine

LAYER, ROUGH = OilSupply(0.3e-6), Surface(0.8e-6)
ALONE = {
    "cylindrical": ("heat", "supply", "surface"),
    "deep groove": ("heat", "supply", "surface"),
    "tapered": ("heat",),
}
"""What each kind has alone: films of tapered rollers are those of lines, which cylindrical ones have."""

WITH_FILMS = [machine for machine in KINDS if machine.name in ALONE]


def made(machine: Machine, heat: bool = False, supply: OilSupply = FLOODED, surface: Surface = SMOOTH) -> Model:
    """The machine with films of the table, at 6000 rpm."""
    text = machine.text().replace('speed = "1500 rpm"', 'speed = "6000 rpm"')
    scene = dataclasses.replace(parse_scene(text, machine.name, "machine.toml"), surface=surface)
    return assemble(scene, "table", supply=supply, inlet_heat=heat)


def matrices(model: Model) -> np.ndarray:
    """K and C of all bearings in equilibrium."""
    found = statics(model).dataset
    return np.stack([found["bearing_stiffness"].values, found["bearing_damping"].values])


@pytest.mark.slow
@pytest.mark.parametrize("machine", WITH_FILMS, ids=lambda machine: machine.name)
def test_conditions_change_films_and_are_kept(machine):
    """Each alone changes K or C of every bearing, by more than 1e-4 of it: nothing is switched off silently. A model
    that is made again of its own scene has all of them, to round-off of the equilibrium."""
    plain = matrices(made(machine))
    each = {"heat": {"heat": True}, "supply": {"supply": LAYER}, "surface": {"surface": ROUGH}}
    for name in ALONE[machine.name]:
        found = matrices(made(machine, **each[name]))
        for bearing in range(plain.shape[1]):
            change = np.abs(found - plain)[:, bearing].max(axis=(1, 2)) / np.abs(plain[:, bearing]).max(axis=(1, 2))
            assert change.max() > 1e-4, (name, bearing)
    model = made(machine, True, LAYER, ROUGH)
    again = model.again(model.scene)
    assert again.law == model.law
    np.testing.assert_allclose(matrices(again), matrices(model), rtol=1e-6, atol=1e-6)

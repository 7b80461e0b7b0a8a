"""Inertia to first order against a solver that carries momentum, and against the contact that is pressed together."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from ehdmaps.physics.contact import OperatingPoint
from tests.cases.inertia import RigidGap, inertia
from tests.cases.moes import load_and_speed
from tests.cases.openfoam_runs import ALPHA, CONTACT, ISOVISCOUS, ISOVISCOUS_L, TEMPERATURE, VISCOSITY
from tests.cases.programs import needed


@pytest.mark.openfoam
@pytest.mark.parametrize(("lengths", "reynolds"), [(3.0, 0.1), (8.0, 1e-3)])
def test_load_of_a_rigid_gap_by_simple_foam(tmp_path: Path, lengths: float, reynolds: float) -> None:
    film, radius = 5e-6, 5e-3
    length = math.sqrt(2.0 * film * radius)
    gap = RigidGap(film, radius, lengths * length, 1e3, 1e3 * film * film / (reynolds * length), speed=1.0)
    assert gap.reynolds == pytest.approx(reynolds, rel=1e-12)
    first = gap.first_order()
    # near the film inertia sucks, in a long inlet it presses
    assert (first > 0.0) == (lengths > 5.0)
    # second order in Re*, and the grid, from which the change of the load has 5 % with half the columns
    assert gap.by_simple_foam(tmp_path, 200, 12, needed("simpleFoam")) == pytest.approx(first, rel=0.03)


def test_film_of_a_contact_that_is_hardly_pressed_together() -> None:
    load, speed = load_and_speed(0.01, ISOVISCOUS_L, VISCOSITY, ALPHA, CONTACT.radius, CONTACT.reduced_modulus)
    point, state = OperatingPoint(load, speed, TEMPERATURE), ISOVISCOUS.at(TEMPERATURE)
    different = {}
    for lengths in (8.0, 16.0):
        without = inertia(CONTACT, ISOVISCOUS, point, 0.0)
        assert without is not None
        inlet = lengths * math.sqrt(2.0 * without.central_film * CONTACT.radius)
        found = inertia(CONTACT, ISOVISCOUS, point, inlet)
        assert found is not None
        gap = RigidGap(found.central_film, CONTACT.radius, inlet, state.density, state.viscosity, speed)
        # the load of a rigid film goes with 1/h: the film takes up what the load of the gap would gain
        different[lengths] = abs(found.film / gap.first_order() - 1.0)
    # the gap has no pressure at its inlet, where the contact has some: of the order of lengths^-2
    assert different[8.0] < 0.06
    assert different[16.0] < different[8.0] / 3.0

"""How the damping of a contact falls with the frequency: what the limit omega b/u = 0.3 stands for."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.ehl.line import Resolution, _response
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.moes import moes_groups
from ehdmaps.physics.operating_point import OperatingPoint
from ehdmaps.physics.solution import contact_solution
from tests.cases.ehl import solved
from tests.cases.laws import CONTACTS, OIL

SOLIDS = 1.75
"""Compliance of one contact of an NU308 between film and ring after ISO 16281, at 65 N/mm, in units of 4/E'."""


@pytest.mark.parametrize(("M", "L"), [(2.0, 5.0), (20.0, 10.0)])
def test_damping_falls_with_the_frequency(M: float, L: float) -> None:
    """c = Im(1/S)/Omega of film and solids in series, over its low-frequency limit: as the reference page says."""
    profile = solved(M, L).profile
    assert profile is not None
    slow = _response(profile, Resolution(), 0.0)
    limit = slow.loss / (slow.compliance + SOLIDS) ** 2
    found = []
    for frequency in (0.3, 0.5, 1.0, 2.0):
        response = _response(profile, Resolution(), frequency)
        total = complex(response.compliance + SOLIDS, -frequency * response.loss)
        found.append((1.0 / total).imag / frequency / limit)
    # The ranges that are stated, for M 2 to 50 and L 5 to 14.
    for value, (low, high) in zip(found, ((0.87, 0.95), (0.7, 0.85), (0.28, 0.46), (-0.05, 0.2)), strict=True):
        assert low < value < high
    assert np.all(np.diff(found) < 0.0)


def test_negative_damping_is_not_small_at_high_L() -> None:
    """Bottom of the valley at L = 47 with FVA 3: c of film and solids is -0.29 k b/u."""
    contact, temperature, speed = CONTACTS[0], 293.15, 9.0
    state = OIL.at(temperature)
    alpha = state.pressure_viscosity.pressure_viscosity
    M, L = moes_groups(1.0, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
    assert pytest.approx(47.0, abs=0.2) == float(L)
    ratios = []
    for part in (0.9, 0.98, 1.01, 1.15):
        load = float(part * 2.2 / (1.0 + L / 12.0) / M)
        (film,) = ReynoldsSolver().solve_line(contact, OIL, (load,), speed, temperature)
        found = contact_solution(film, contact, OperatingPoint(load, speed, temperature))
        width = half_width(load, contact.radius, contact.reduced_modulus)
        ratios.append(found.damping * speed / (found.stiffness * width))
    # 0.02: how well two loads meet the bottom, and the grid error of damping there
    assert min(ratios) == pytest.approx(-0.29, abs=0.02)
    assert ratios[0] > 0.0 and ratios[-1] > 0.0

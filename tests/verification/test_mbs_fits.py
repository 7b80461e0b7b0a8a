"""Fits and warm rings: Lame's thick rings beside catalogues and finite elements, clearances beside numbers by hand."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solids import STEEL, Material
from mbs.bearings.thermal import Mounting, Seat, operating_clearance, pressed_on

NU308 = dataclasses.replace(BearingGeometry.named("NU308"), diametral_clearance=30e-6)
IRON = Material(110e9, 0.26)
ALUMINIUM = Material(70e9, 0.33)
COLD, WARM = 293.15, 333.15


def by_elements(inside, outside, bore, seat, outer, interference, elements=400):
    """Growth of the outside and shrinkage of the bore [m], by linear finite elements of the radius in plane stress."""
    radii = [np.linspace(0.5 * a, 0.5 * b, elements + 1) for a, b in ((bore, seat), (seat, outer))]
    nodes = np.concatenate(radii)
    stiffness = np.zeros((nodes.size, nodes.size))
    for first, material in ((0, inside), (elements + 1, outside)):
        plane = material.youngs_modulus / (1.0 - material.poisson_ratio**2)
        law = plane * np.array([[1.0, material.poisson_ratio], [material.poisson_ratio, 1.0]])
        for i in range(first, first + elements):
            (low, high), middle = nodes[i : i + 2], nodes[i : i + 2].mean()
            strains = np.array([[-1.0 / (high - low), 1.0 / (high - low)], [0.5 / middle, 0.5 / middle]])
            stiffness[i : i + 2, i : i + 2] += strains.T @ law @ strains * middle * (high - low)
    # The surfaces of the seat differ by half of the interference of the diameters, and their forces are opposite.
    tied = np.delete(np.eye(nodes.size), elements + 1, axis=1)
    tied[elements + 1, elements] = 1.0
    gap = np.zeros(nodes.size)
    gap[elements + 1] = 0.5 * interference
    free = tied
    if bore == 0.0:
        free = tied[:, 1:]
    moved = free @ np.linalg.solve(free.T @ stiffness @ free, -free.T @ stiffness @ gap) + gap
    return 2.0 * moved[-1], -2.0 * moved[0]


@pytest.mark.parametrize(
    ("inside", "outside", "bore", "seat", "outer"),
    [
        (STEEL, STEEL, 0.0, 40e-3, 52e-3),
        (STEEL, STEEL, 25e-3, 40e-3, 52e-3),
        (STEEL, IRON, 80e-3, 90e-3, 130e-3),
        (STEEL, ALUMINIUM, 80e-3, 90e-3, 100e-3),
    ],
)
def test_press_fits_beside_finite_elements(inside, outside, bore, seat, outer):
    """1e-4: the elements, whose error falls with the square of their number."""
    found = pressed_on(inside, outside, bore, seat, outer, 10e-6)
    np.testing.assert_allclose(found, by_elements(inside, outside, bore, seat, outer, 10e-6), rtol=1e-4, atol=1e-12)


def test_press_fits_beside_the_formulas_of_catalogues():
    """Of one material, Poisson's ratio drops out: I k (1 - k0^2)/(1 - k^2 k0^2), k = d/F, k0 = bore/d; round-off."""
    for bore in (0.0, 20e-3, 30e-3):
        k, k0 = 40.0 / 52.0, bore / 40e-3
        expected = 10e-6 * k * (1.0 - k0**2) / (1.0 - (k * k0) ** 2)
        assert pressed_on(STEEL, STEEL, bore, 40e-3, 52e-3, 10e-6)[0] == pytest.approx(expected, rel=1e-12)
    h, h0 = 80.0 / 90.0, 90.0 / 130.0
    expected = 10e-6 * h * (1.0 - h0**2) / (1.0 - (h * h0) ** 2)
    assert pressed_on(STEEL, STEEL, 80e-3, 90e-3, 130e-3, 10e-6)[1] == pytest.approx(expected, rel=1e-12)


def test_a_loose_fit_does_nothing():
    assert pressed_on(STEEL, STEEL, 0.0, 40e-3, 52e-3, -5e-6) == (0.0, 0.0)


def test_warm_rings_by_hand():
    """All numbers by hand, in um: 11.7e-6 times diameter times warmth."""
    even = operating_clearance(NU308, Mounting(), WARM, WARM)
    assert even.by_temperature == pytest.approx(0.0, abs=1e-12)  # 80 - 52 - 2 * 14 = 0: a scaled bearing
    found = operating_clearance(NU308, Mounting(), WARM, WARM - 5.0)
    # 80 * 35 - 52 * 40 - 28 * 37.5 = -330 mm K
    assert 1e6 * found.by_temperature == pytest.approx(-11.7e-6 * 330e3, rel=1e-12)
    assert found.operating == pytest.approx(30e-6 - 3.861e-6, rel=1e-12)


def test_fits_by_hand():
    """The seat of an aluminium housing grows away from its ring: 90 mm * (23.8 - 11.7)e-6 * 40 K = 43.56 um."""
    shaft = Seat(10e-6, 40e-3, 0.0)
    cold = operating_clearance(NU308, Mounting(shaft=shaft), COLD, COLD)
    assert 1e6 * cold.by_fits == pytest.approx(-10.0 * 40.0 / 52.0, rel=1e-12)
    warm = operating_clearance(NU308, Mounting(shaft=shaft), WARM, WARM)
    assert warm.by_fits == pytest.approx(cold.by_fits, rel=1e-12)  # steel on steel
    housing = Seat(50e-6, 90e-3, 120e-3, ALUMINIUM, 23.8e-6)
    found = [operating_clearance(NU308, Mounting(housing=housing), at, at).by_fits for at in (COLD, WARM, WARM + 10.0)]
    whole = -pressed_on(STEEL, ALUMINIUM, 80e-3, 90e-3, 120e-3, 50e-6)[1]
    np.testing.assert_allclose(found, [whole, whole * (50.0 - 43.56) / 50.0, 0.0], rtol=1e-9, atol=1e-15)


@pytest.mark.parametrize(
    ("mounting", "words"),
    [
        (Mounting(shaft=Seat(0.0, 53e-3, 0.0)), "seat of 53 mm; allowed: bore < seat < inner raceway, 52 mm"),
        (Mounting(shaft=Seat(0.0, 40e-3, 41e-3)), "a bore of 41 mm"),
        (Mounting(housing=Seat(0.0, 79e-3, 120e-3)), "a seat of 79 mm and a housing of 120 mm outside"),
    ],
)
def test_rings_that_do_not_fit_are_refused(mounting, words):
    with pytest.raises(InputError, match=words):
        operating_clearance(NU308, mounting, WARM, WARM)
    with pytest.raises(InputError, match="temperatures of the rings: got nan"):
        operating_clearance(NU308, Mounting(), float("nan"), WARM)

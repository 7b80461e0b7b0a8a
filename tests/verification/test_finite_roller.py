"""Rollers of finite length: limits of lines and of ellipses, the dry contact, finer grids, ends."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import ehdmaps
from ehdmaps.errors import InputError
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.solids import STEEL, reduced_modulus
from ehdmaps.physics.surface import CrownedProfile
from ehdmaps.point import solve
from ehdmaps.point.finite_roller import FiniteRoller, RollerSolution, solve_roller
from ehdmaps.point.roller_grid import dry_compliance, dry_contact, roller_grid
from ehdmaps.point.two_grids import Resolution

OIL, RADIUS, LENGTH, MODULUS = Lubricant.named("FVA3"), 5.5e-3, 14e-3, reduced_modulus(STEEL, STEEL)
ROUNDED = CrownedProfile.of_drop(10e-6, LENGTH, 0.9 * LENGTH)
SPEED, KELVIN = 2.0, 333.15
SMALL = Resolution((28, 16), (36, 21))


def solved(profile, load: float, resolution: Resolution | None = None) -> RollerSolution:
    roller = FiniteRoller(RADIUS, LENGTH, MODULUS, profile)
    grids = (resolution,) if resolution else ()
    found = solve_roller(roller, OIL, load, SPEED, KELVIN, *grids)
    assert found.status.word == "converged" and found.reason == ""
    return found


def test_the_dry_contact_of_a_parabola_is_that_of_hertz() -> None:
    """An ellipse of kappa 5 in the groups of the line with its pressure; the grid's error of order two."""
    ellipse, load = Ellipse(RADIUS, 60e-3, MODULUS), 100.0
    half, across = ellipse.semi_axes(load)
    peak = float(ellipse.max_pressure(load))
    unit = 4.0 * RADIUS * peak / MODULUS  # half-width of the line with that pressure
    grid = roller_grid(
        lambda y: 0.5 * y**2 * RADIUS / ellipse.transverse_radius,
        2.0 * across / unit,
        [across / unit],
        (40, 20),
        4.0,
        1.0,
        half / unit,
    )
    found = dry_contact(grid.kernel, grid.parabola, grid.weights, load / (peak * unit**2))
    assert found is not None
    assert float(np.max(found.pressure)) == pytest.approx(1.0, rel=0.01)
    assert -found.height * unit**2 / RADIUS == pytest.approx(float(ellipse.approach(load)), rel=0.002)
    compliance = dry_compliance(grid, load / (peak * unit**2)) / (peak * RADIUS)
    assert 1.0 / compliance == pytest.approx(float(ellipse.stiffness(load)), rel=0.01)


def test_the_smallest_film_lies_where_the_straight_part_ends() -> None:
    """Small grids: the film there is a sixth below that across the middle, with a stated error of some per cent."""
    found = solved(ROUNDED, 1000.0, Resolution((30, 16), (36, 20)))
    assert 0.8 < found.minimum_film / found.middle_film < 0.9 and found.minimum_film.error < 0.1
    assert 0.9 * 0.5 * LENGTH < found.minimum_place < 0.5 * LENGTH
    field = found.field
    assert field is not None
    along = np.trapezoid(field.pressure, field.x, axis=0)
    assert 2.0 * float(np.trapezoid(along, field.y)) == pytest.approx(1000.0, rel=2e-3)  # the inlet before the grid


@pytest.mark.slow
@pytest.mark.parametrize("profile", [ROUNDED, CrownedProfile.of_drop(10e-6, LENGTH)])
def test_its_middle_is_a_line_at_its_own_load(profile) -> None:
    """The film of a line by another solver, at the load per length of the middle: stated errors are 1.5 and 3 %."""
    found = solved(profile, 1500.0)
    field = found.field
    assert field is not None
    load = float(np.trapezoid(field.pressure[:, 0], field.x))
    contact = LineContact("line", RADIUS, STEEL, "iso16281", LENGTH)
    line = ehdmaps.solve(contact, OIL, OperatingPoint(load, SPEED, KELVIN), solver="reynolds")
    assert found.central_film == pytest.approx(line.central_film, rel=found.central_film.error)
    assert found.middle_film == pytest.approx(line.minimum_film, rel=found.middle_film.error)
    assert found.central_film.error < 0.02 and found.middle_film.error < 0.04


@pytest.mark.slow
def test_a_large_crown_is_an_ellipse() -> None:
    """The solver of ellipses, whose dry contact is in closed form: each within both stated errors."""
    radius = 0.12
    found = solved(lambda y: 0.5 * y * y / radius, 200.0)
    ellipse = Ellipse(RADIUS, radius, MODULUS)
    other = solve(ellipse, OIL, 200.0, SPEED, KELVIN)
    assert ellipse.semi_axes(200.0)[1] < 0.15 * 0.5 * LENGTH
    for name in ("central_film", "minimum_film", "film_offset", "stiffness", "damping", "max_pressure"):
        both = getattr(found, name).error + getattr(other, name).error
        assert getattr(found, name) == pytest.approx(getattr(other, name), rel=both), name
    assert found.dry_stiffness == pytest.approx(float(ellipse.stiffness(200.0)), rel=0.015)  # contact on the grid


@pytest.mark.slow
def test_finer_grids_stay_within_the_stated_errors() -> None:
    """At the rounded end too; the film that is squeezed there is the hardest of all."""
    found, finer = solved(ROUNDED, 500.0, SMALL), solved(ROUNDED, 500.0)
    for name in ("central_film", "middle_film", "minimum_film", "film_offset", "stiffness", "damping"):
        assert getattr(found, name) == pytest.approx(getattr(finer, name), rel=getattr(found, name).error), name


@pytest.mark.slow
def test_the_film_compliance_is_the_slope_of_the_film_offset() -> None:
    """A tangent against a quotient over 20 % of load, within the error that is stated of the tangent."""
    lower, found, upper = (solved(ROUNDED, load, SMALL) for load in (450.0, 500.0, 550.0))
    slope = (lower.film_offset - upper.film_offset) / 100.0
    assert slope == pytest.approx(found.film_compliance, rel=found.film_compliance.error)
    assert found.film_compliance.error < 0.5


def test_what_is_not_solved_says_why() -> None:
    roller = FiniteRoller(RADIUS, LENGTH, MODULUS, ROUNDED)
    for load, speed, words in ((1e-3, 2.0, "length over width"), (100.0, 50.0, "M = "), (2e6, 2.0, "length over")):
        found = solve_roller(roller, OIL, load, speed, KELVIN)
        assert not found.status.usable and words in found.reason and math.isnan(found.minimum_film)
    assert "Hertz pressure" in solve_roller(roller, OIL, 3e5, SPEED, KELVIN).reason
    loaded = dataclasses.replace(roller, profile=CrownedProfile.of_drop(1e-6, LENGTH))
    found = solve_roller(loaded, OIL, 3000.0, SPEED, KELVIN, Resolution((24, 12), (30, 15)))
    assert found.status.word == "stagnated" and "the dry contact reaches the end of the roller" in found.reason
    for values, words in (((0.0, 2.0), "load: got 0.0"), ((10.0, math.nan), "entrainment_speed: got nan")):
        with pytest.raises(InputError, match=words):
            solve_roller(roller, OIL, *values, KELVIN)
    with pytest.raises(InputError, match=r"resolution: got cells \(34, 12\) and \(34, 16\); allowed: more"):
        solve_roller(roller, OIL, 10.0, 2.0, KELVIN, Resolution((34, 12), (34, 16)))
    with pytest.raises(InputError, match=r"(?s)radius: got -1.0 m.*length: got 0.0 m"):
        FiniteRoller(-1.0, 0.0, MODULUS, ROUNDED)
    with pytest.raises(InputError, match="profile: got no depth at every place"):
        solve_roller(dataclasses.replace(roller, profile=lambda y: np.zeros(3)), OIL, 500.0, SPEED, KELVIN)

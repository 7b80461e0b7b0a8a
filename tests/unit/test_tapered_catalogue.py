"""Tapered roller bearings by designation, and the geometry of their cones."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.rollers import tapered_catalogue as catalogue
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from ehdmaps.physics.solids import STEEL

GEOMETRY = TaperedGeometry("32208", 10e-3, 15e-3, 60e-3, 17, math.radians(14.0))


def test_estimates_meet_the_ratings_and_the_pressure_centre_of_the_catalogue() -> None:
    for name in catalogue.tapered_designations():
        geometry, entry = catalogue.tapered_estimate(name), catalogue.tapered_boundary(name)
        dynamic, static = catalogue.tapered_ratings(geometry)
        assert static == pytest.approx(entry.static_rating, rel=1e-12)  # round-off
        assert dynamic == pytest.approx(entry.dynamic_rating, rel=2e-3)  # the number of rollers is rounded
        # the length follows without looking at the widths: it must fit between them
        assert 0.6 * entry.cup_width < geometry.roller_length < 0.98 * entry.cup_width
        assert geometry.roller_length * math.cos(geometry.axis_angle) < 0.8 * entry.cone_width
        # not used by the estimate: the rollers lie up to 2.8 mm nearer to the large end than the middle of the cup,
        # of those above 80 mm up to 0.135 of its width
        beyond = entry.pressure_centre - 0.5 * entry.cup_width - geometry.pressure_centre
        assert 0.0 < beyond < (3e-3 if entry.bore <= 80e-3 else 0.135 * entry.cup_width)
        # rings of at least a twelfth of the section
        inner, outer = geometry.raceway_diameters
        section = entry.outside_diameter - entry.bore
        assert inner > entry.bore + section / 6.0 and outer < entry.outside_diameter - section / 6.0


def test_cones_have_one_apex_and_roll() -> None:
    radii = [0.5 * diameter for diameter in GEOMETRY.raceway_diameters]
    angles = GEOMETRY.cone_angle, GEOMETRY.cup_angle
    where = [radius / math.tan(angle) for radius, angle in zip(radii, angles, strict=True)]
    half, sine = 0.5 * GEOMETRY.roller_diameter, math.sin(GEOMETRY.axis_angle)
    places = [where[0] - half * sine, where[1] + half * sine]  # middles of both contacts lie beside the roller's
    # Newton's method to round-off: apexes within 1e-12 of their distance
    assert places[0] == pytest.approx(places[1], rel=1e-12)
    assert places[0] == pytest.approx(GEOMETRY.apex_distance * math.cos(GEOMETRY.axis_angle), rel=1e-12)
    # surfaces move alike at both contacts, at any place, by the formula of rotation
    inner, outer = 300.0, -40.0
    cage, roller = GEOMETRY.cage_speed(inner, outer), GEOMETRY.roller_speed(inner, outer)
    u = GEOMETRY.entrainment_speed(inner, outer)
    assert (inner - cage) * radii[0] == pytest.approx(u, rel=1e-12)
    assert (cage - outer) * radii[1] == pytest.approx(u, rel=1e-12)
    assert -roller * half == pytest.approx(u, rel=1e-12)


def test_the_rib_slides_by_its_height_alone() -> None:
    rib, end = GEOMETRY.rib_speeds(300.0)
    cage = GEOMETRY.cage_speed(300.0)
    # both turn about the line through the apex that rolls: the sliding speed is their relative spin times the height
    height = 0.125 * GEOMETRY.roller_diameter
    relative = (300.0 - cage) * math.cos(GEOMETRY.axis_angle) - GEOMETRY.roller_speed(300.0)
    assert rib - end == pytest.approx(relative * height, rel=1e-12)
    contact = GEOMETRY.rib_contact(STEEL)
    assert contact.ellipticity < 1.0 and GEOMETRY.rib_angle < GEOMETRY.axis_angle


def test_no_angle_is_a_cylinder() -> None:
    plain = TaperedGeometry("plain", 10e-3, 15e-3, 60e-3, 17, 0.0)
    assert (plain.half_cone_angle, plain.cone_angle, plain.rib_angle) == (0.0, 0.0, 0.0)
    assert plain.rib_contact(STEEL) is None
    assert plain.roller_mass(STEEL) == pytest.approx(STEEL.density * math.pi / 4.0 * 10e-3**2 * 15e-3, rel=1e-14)
    inner, outer = (plain.radius_at(2e-3, side) for side in (0, 1))
    assert (inner, outer) == pytest.approx((5e-3 * (1.0 - 1.0 / 6.0), 5e-3 * (1.0 + 1.0 / 6.0)), rel=1e-14)


def test_mass_and_radii_of_cones() -> None:
    places = np.linspace(-7.5e-3, 7.5e-3, 2001)
    radius = 5e-3 - places * math.tan(GEOMETRY.half_cone_angle)
    mass = STEEL.density * math.pi * float(np.trapezoid(radius**2, places))
    assert GEOMETRY.roller_mass(STEEL) == pytest.approx(mass, rel=1e-6)  # trapezoidal rule
    # radii grow in proportion to the distance from the apex
    share = 1.0 - 5e-3 / GEOMETRY.apex_distance
    assert GEOMETRY.radius_at(5e-3, 1) == pytest.approx(share * GEOMETRY.radius_at(0.0, 1), rel=1e-13)


def test_wrong_geometries_and_designations_are_refused() -> None:
    with pytest.raises(InputError) as caught:
        TaperedGeometry("", -1.0, math.nan, 60e-3, 2, 1.0)
    text = str(caught.value)
    for words in (
        "has no name",
        "roller_diameter: got -1.0 m",
        "roller_length: got nan m",
        "from -45 to 45 deg",
        ">= 3",
    ):
        assert words in text
    with pytest.raises(InputError, match="got 30, which overlap"):
        TaperedGeometry("a", 10e-3, 15e-3, 60e-3, 30, 0.2)
    with pytest.raises(InputError, match="rollers that reach the apex"):
        TaperedGeometry("a", 10e-3, 200e-3, 60e-3, 15, 0.5)
    with pytest.raises(InputError, match=r"rib_height: got a contact -4[.]74 mm from the roller's axis"):
        TaperedGeometry("a", 10e-3, 15e-3, 60e-3, 17, 0.244, rib_height=10e-3)
    with pytest.raises(InputError, match="end_radius: got 300 mm; allowed: less than the rib's own radius"):
        TaperedGeometry("a", 10e-3, 15e-3, 60e-3, 17, 0.244, end_radius=0.3)
    with pytest.raises(InputError, match=r"got '32299' \(did you mean '322\d\d'\?\); allowed: 302, 303"):
        catalogue.tapered_estimate("32299")

"""One bearing at an operating point: against ISO constants, Hertz, Stribeck, the example of the README, and a scene."""

from __future__ import annotations

import dataclasses
import math
import re

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.jobs.make.table_law import table_map
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from mbs.analyses.bearing_point import bearing_point, bearing_points
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.contact_report import fading, heated, outside_map
from mbs.bearings.films import FormulaFilms, MapFilms
from mbs.model.equilibrium import equilibrium
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene
from tests.cases.bearings import map_law

OIL = Lubricant.named("FVA3")
WARM = 313.15


def dry_point(name, load, speed=100.0, **options):
    bearing = Bearing.named(name, **{"clearance": 0.0, **options})
    films = FormulaFilms(bearing.geometry.contacts(STEEL, "iso16281"), OIL)
    return bearing_point(BearingForce(bearing, laws.hertz(bearing)), films, load, speed, WARM)


@pytest.mark.parametrize(
    ("name", "load", "stiffness"),
    [("N1014", 1e3, 796.9), ("N1014", 1e4, 1003.2), ("NU308", 2e3, 689.0), ("NU308", 2e4, 867.4)],
)
def test_radial_stiffness_by_the_constants_of_iso_16281(name, load, stiffness):
    point = dry_point(name, (load, 0.0), profile="straight")
    found, across, _ = point.along_across(point.stiffness)
    assert 1e-6 * found == pytest.approx(stiffness, rel=1e-4)  # four digits of the reference
    # Stribeck's number of a bearing without clearance: 4.08 for any number of rollers
    assert point.elements.load.max() * point.bearing.geometry.rollers / load == pytest.approx(4.08, abs=0.01)
    assert 0.0 < across < found
    # Q_j = Q_max cos(phi)^(10/9), the load distribution of Stribeck with the exponent of the line contact
    expected = point.elements.load.max() * np.maximum(np.cos(point.elements.angle), 0.0) ** (10.0 / 9.0)
    np.testing.assert_allclose(point.elements.load, expected, atol=1e-6 * load)  # of the equilibrium


def test_hertz_pressure_and_films_are_those_of_the_most_loaded_roller():
    point = dry_point("NU308", (2e3, 0.0), profile="straight", speed=50.0 * math.pi)
    w = point.elements.load.max() / 15e-3
    geometry, modulus = point.bearing.geometry, 210e9 / (1.0 - 0.3**2)
    for side, radius in enumerate((geometry.inner_radius, geometry.outer_radius)):
        width = math.sqrt(8.0 * w * radius / (math.pi * modulus))
        assert point.contacts.hertz_pressure[side] == pytest.approx(2.0 * w / (math.pi * width), rel=1e-9)
    assert point.entrainment_speed == pytest.approx(2.475, rel=1e-3)  # digits
    assert point.film_parameter(0.3e-6) == pytest.approx(point.contacts.minimum_film[0] / 0.3e-6)


def test_a_load_in_any_direction_is_carried():
    one = dry_point("NU308", (800.0, 600.0), clearance=20e-6)
    force = BearingForce(one.bearing, laws.hertz(one.bearing))
    f, K, _ = force(one.pose)
    np.testing.assert_allclose(f[1:3], [-800.0, -600.0], rtol=1e-9)  # of the equilibrium
    along = np.array([0.8, 0.6])
    np.testing.assert_allclose(one.along_across(one.stiffness)[0], along @ K[1:3, 1:3] @ along, rtol=1e-12)


@pytest.mark.parametrize("name", ["NU308", "N1014"])
@pytest.mark.parametrize("clearance", [-20e-6, 0.0, 20e-6, 1e-3])
@pytest.mark.parametrize("load", [1e-3, 1.0, 1e4, 1e7])
def test_an_equilibrium_is_found_from_any_load_and_clearance(name, clearance, load):
    for angle in (0.0, 0.1, math.pi / 12.0):
        given = (load * math.cos(angle), load * math.sin(angle))
        point = dry_point(name, given, clearance=clearance)
        carried = point.elements.load @ np.stack([np.cos(point.elements.angle), np.sin(point.elements.angle)], axis=1)
        np.testing.assert_allclose(carried, given, atol=1e-7 * load)  # of the equilibrium


def test_with_films_too():
    bearing = Bearing.named("NU308", clearance=20e-6)
    films = FormulaFilms(bearing.geometry.contacts(STEEL, "iso16281"), OIL)
    ((slow, fast),) = bearing_points(bearing, map_law(), films, [(1e3, 0.0)], [10.0, 100.0], 330.0)
    assert np.all(slow.along_across(slow.damping)[:2] > 0.0)
    assert fast.pose[1] < slow.pose[1]  # thicker films hold the rings further apart
    ((rest,),) = bearing_points(bearing, map_law(), films, [(1e3, 0.0)], [0.0], 330.0)
    dry = bearing_point(BearingForce(bearing, laws.hertz(bearing)), films, (1e3, 0.0), 0.0, 330.0)
    (k, expected), size = (one.stiffness[1:3, 1:3] for one in (rest, dry)), np.max(dry.stiffness[1:3, 1:3])
    np.testing.assert_allclose(k, expected, rtol=1e-6, atol=1e-12 * size)  # table; round-off
    assert not np.any(rest.damping) and rest.film_parameter(1e-6) == 0.0


def test_one_roller_that_carries_all_is_said():
    point = dry_point("NU308", (5.0, 0.0), clearance=1e-3)
    assert point.loaded == 1
    assert point.notes == (
        "one roller carries all: nothing holds the ring across the load, where its position is arbitrary",
    )


def test_overload_is_said():
    assert dry_point("NU308", (9e4, 0.0)).problems == ()
    crushed = dry_point("NU308", (1e6, 0.0))
    hardness, problem = crushed.problems
    assert crushed.unsound == (hardness,) and "the hardness of bearing steel, which no contact carries" in hardness
    assert problem.startswith("Hertz pressure of 12.")
    assert "above 4 GPa, the static limit of ISO 76: permanent deformation" in problem
    with pytest.raises(AnalysisError, match=r"no equilibrium of NU308 under 1e\+08 N: .* beyond what the bearing can"):
        dry_point("NU308", (1e8, 0.0))


def test_extrapolated_viscosity_is_said():
    assert dry_point("NU308", (100.0, 0.0)).notes == ()
    (note,) = dry_point("NU308", (1e4, 0.0), 10.0).notes
    assert note.startswith("the viscosity of FVA3 is extrapolated above 0.6 GPa (largest pressure 1.4")


def test_outside_the_map_is_said_by_axis_and_value():
    law = map_law()
    high, (slow, quick), (cold, hot) = law.load_range[1], law.speed_range, law.temperature_range
    assert outside_map(law, 0.5 * high, 0.5 * slow, cold) == []  # below the lowest load and speed a film fades
    found = "\n".join(outside_map(law, 2.0 * high, 2.0 * quick, hot + 10.0))
    for words in (
        f"load per length of {2e-3 * high:.4g} N/mm is outside the map",
        f"entrainment speed of {2.0 * quick:.4g} m/s is outside",
        f"temperature of {hot + 10.0 - 273.15:.4g} degC is outside",
    ):
        assert words in found
    assert outside_map(laws.hertz(Bearing.named("NU308", clearance=0.0)), 1e9, 1e3, 1e3) == []


def test_a_film_that_fades_is_said():
    law = map_law()
    slow = law.speed_range[0]
    assert (
        fading(law, slow) == fading(law, 0.0) == fading(laws.hertz(Bearing.named("NU308", clearance=0.0)), 1e-3) == ""
    )
    assert fading(law, 0.5 * slow).startswith(
        f"entrainment speed of {0.5 * slow:.4g} m/s is below the lowest mapped one, {slow:.4g} m/s: stiffness"
    )


def test_films_that_inlet_heating_thins_are_said():
    (note,) = dry_point("NU308", (200.0, 0.0), speed=300.0).notes
    # below the 16 % of loaded contacts, 1/(1 + 0.241 QL^0.64) by Wilson and Sheu at QL = 4.31e-3 4.73^2/0.134 = 0.719
    found = re.fullmatch(r"films are isothermal: heat in the inlet makes them about (\d+) % thinner at .*load", note)
    assert 8 < int(found[1]) < 16
    inner = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
    assert heated(inner, None, 2e4, 5.0, WARM) == heated(inner, Lubricant.named("FVA3"), 0.0, 5.0, WARM) == ""


@pytest.mark.parametrize("heat", [False, True])
def test_films_of_a_map_with_heat_are_not_called_isothermal(heat):
    emap = table_map(BearingGeometry.named("NU308"), Lubricant.named("FVA3"), inlet_heat=heat)
    bearing = Bearing.named("NU308", clearance=20e-6)
    force = BearingForce(bearing, emap.law("series"))
    notes = "".join(bearing_point(force, MapFilms(emap), (2000.0, 0.0), 300.0, WARM).notes)
    assert ("films are isothermal" in notes) is not heat


@pytest.mark.parametrize("load", [(0.0, 0.0), (math.nan, 1.0), (1.0,), (math.inf, 0.0)])
def test_loads_that_are_none_are_refused(load):
    with pytest.raises(InputError, match=r"bearing point, load: got .* N; allowed: two finite numbers, y and z"):
        dry_point("NU308", load)


def test_the_point_is_that_of_a_scene():
    model = assemble(read_scene("nu308_rigid"), "hertz")
    balance = equilibrium(model.system, model.operation)
    motion = model.system.relative(model.bearings[0].inner, model.bearings[0].outer) @ balance.displacement
    force = balance.forces[0][1:3]
    point = bearing_point(
        model.bearings[0].force,
        model.bearings[0].source,
        -force,
        model.scene.speed,
        model.scene.temperature,
    )
    np.testing.assert_allclose(point.pose[1:3], motion[1:3], rtol=1e-8)  # of both equilibria
    np.testing.assert_allclose(point.stiffness[1:3, 1:3], balance.element_stiffness[0][1:3, 1:3], rtol=1e-7)


def test_a_point_cannot_be_changed():
    with pytest.raises(dataclasses.FrozenInstanceError):
        dry_point("NU308", (1e3, 0.0)).speed = 0.0

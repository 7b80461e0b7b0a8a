"""The film table of points: against solved points, its ends, holes, refusals, its file; how it is made."""

from __future__ import annotations

import math
import shutil
from importlib import resources
from pathlib import Path

import netCDF4
import numpy as np
import pytest

import ehdmaps
from ehdmaps.errors import InputError, MapError, OutsideMapError
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ellipse import Ellipse, elliptic_numbers
from ehdmaps.physics.solids import STEEL as MATERIAL
from ehdmaps.physics.solution import Status
from ehdmaps.point import solve
from ehdmaps.table.file import shipped_tables
from ehdmaps.table.points.file import SHIPPED, read_point_table, shipped_point_table
from ehdmaps.table.points.films import NUMBERS
from ehdmaps.table.points.nodes import ERRORS, FIELDS, HOLE, PointAxes, point_load_number
from ehdmaps.table.points.response import read_response
from examples.tables import point_errors as errors
from examples.tables import point_heavy as heavy
from examples.tables import point_lines as lines
from examples.tables import points as maker
from examples.tables.files import write_point_table
from examples.tables.point_lines import SolvedPoint

STEEL = 230.769e9
OIL = Lubricant.roelands(viscosity=0.02, pressure_viscosity=2e-8, density=870.0)
WARM = 313.15
CONTACT = Ellipse(5e-3, 120e-3, STEEL)


@pytest.fixture(scope="module")
def table():
    return shipped_point_table()


@pytest.mark.parametrize(
    ("load", "speed", "oil"), [(8.0, 6.0, OIL), (150.0, 3.0, OIL), (40.0, 1.5, Lubricant.named("FVA3"))]
)
def test_numbers_are_those_of_solved_points(table, load, speed, oil):
    """Within what table and solver state together; response at the natural frequencies too."""
    films = table.films(CONTACT, oil, load, speed, WARM)
    held = films.frequencies
    found = solve(CONTACT, oil, load, speed, WARM, np.sort(np.r_[held, np.sqrt(held[1:] * held[:-1])]))
    assert films.usable and found.status.usable and not films.reason
    assert films.load_number == pytest.approx(found.load_number, rel=1e-12)
    assert films.oil_number == pytest.approx(found.oil_number, rel=1e-12)
    for name in NUMBERS:
        value, stated = getattr(found, name), float(films.errors[name]) + getattr(found, name).error
        assert abs(float(getattr(films, name)) - value) <= stated * abs(value), name
    read = read_response(films, found.response.frequencies)
    for name in ("stiffness", "damping"):
        value, stated = getattr(found.response, name), getattr(read, f"{name}_error")
        stated = stated + getattr(found.response, f"{name}_error")
        assert np.all(np.abs(getattr(read, name) - value) <= stated * np.abs(value)), name
        np.testing.assert_allclose(getattr(read, name)[::2], getattr(films, f"response_{name}"), rtol=1e-12)
    assert films.errors["film_offset"] < 0.02 and films.errors["stiffness"] < 0.1


def test_a_line_over_load_is_passive_and_monotone(table):
    """From rigid to heavy: load rises with the approach, damping is positive, films fall, k goes to that of Hertz."""
    loads = np.geomspace(0.11, 400.0, 400)
    films = table.films(CONTACT, OIL, loads, 5.0, WARM)
    assert np.all(films.usable)
    assert np.all(np.diff(films.approach) > 0.0) and np.all(films.damping > 0.0)
    assert np.all(np.diff(films.film_offset) < 0.0) and np.all(films.minimum_film > 0.0)
    assert np.all(films.response_damping > 0.0)
    dry = CONTACT.stiffness(loads)
    assert films.stiffness[-1] / dry[-1] == pytest.approx(1.0, abs=0.05)
    # the slope of the approach is the compliance: quotients of 5 % of load, 1e-3
    quotient = np.diff(films.approach) / np.diff(loads)
    between = 1.0 / np.sqrt(films.stiffness[1:] * films.stiffness[:-1])
    assert np.median(np.abs(quotient / between - 1.0)) < 2e-3


def test_light_loads_are_rigid(table):
    """Below the lowest node films go with F^-2, damping with F^2: the closed form of a rigid contact."""
    loads = np.array([0.11, 0.22])
    films = table.films(CONTACT, OIL, loads, 5.0, WARM)
    assert films.film_offset[1] / films.film_offset[0] == pytest.approx(0.25, rel=1e-9)
    assert films.damping[1] / films.damping[0] == pytest.approx(4.0, rel=1e-9)
    assert np.all(films.errors["damping"] >= 0.0)


@pytest.mark.parametrize(
    ("contact", "oil", "load", "speed", "temperature", "words"),
    [
        (CONTACT, OIL, 0.0, 1.0, WARM, "no load: the bodies do not meet"),
        (CONTACT, OIL, -1.0, 1.0, WARM, "absurd"),
        (CONTACT, OIL, math.nan, 1.0, WARM, "absurd"),
        (CONTACT, OIL, 1e9, 1.0, WARM, "Hertz pressure above"),
        (CONTACT, OIL, 5.0, 1e-3, WARM, "L outside"),
        (CONTACT, OIL, 2e4, 0.01, WARM, "beyond its highest loads"),
        (CONTACT, OIL, 1e-9, 5.0, WARM, "below its lowest loads"),
        (CONTACT, OIL, 1e-3, 5.0, WARM, "film thicker than"),
        (Ellipse(5e-3, 2e-3, STEEL), OIL, 10.0, 5.0, WARM, "ellipticity outside"),
        (Ellipse(5e-3, 5.0, STEEL), OIL, 10.0, 5.0, WARM, "ellipticity outside"),
        (Ellipse(5e-3, 60e-3, STEEL), Lubricant.named("FVA3"), 80.0, 20.0, 293.15, "no solution"),
        (CONTACT, Lubricant.roelands(viscosity=0.02, pressure_viscosity=3e-9, density=870.0), 10.0, 5.0, WARM, "oils"),
    ],
)
def test_what_the_table_has_not_is_told(table, contact, oil, load, speed, temperature, words):
    """A typed status with its reason and no number at all."""
    films = table.films(contact, oil, load, speed, temperature)
    assert words in str(films.reason) and int(films.status) == int(Status.OUTSIDE_VALIDITY)
    assert all(math.isnan(float(getattr(films, name))) and math.isnan(float(films.errors[name])) for name in NUMBERS)


def test_surfaces_at_rest_are_dry(table):
    films = table.films(CONTACT, OIL, 50.0, 0.0, WARM)
    assert int(films.status) == int(Status.ASYMPTOTE) and films.reason == "no entrainment: dry contact"
    assert films.stiffness == CONTACT.stiffness(50.0) and films.approach == CONTACT.approach(50.0)
    assert films.damping == films.central_film == films.film_offset == 0.0


def test_heavy_contacts_are_continued_and_holes_are_few(table):
    """Beyond the heaviest load that is solved all cells are continued, below zeta of 3 none; holes have L above 38."""
    zeta, hole, continued = table.nodes.axes.zeta[:-1], table.nodes.codes[..., 0] == HOLE, table.nodes.continued
    assert np.all(continued[zeta > maker.SOLVED - 0.1]) and not np.any(continued[zeta < heavy.HEAVY - 0.5])
    assert np.count_nonzero(hole) < 0.02 * hole.size and not np.any(hole[:, :-1])
    loads = np.geomspace(30.0, 3000.0, 60)
    films = table.films(CONTACT, OIL, loads, 0.3, WARM)
    assert np.all(films.usable) and films.status[-1] == int(Status.ASYMPTOTE)
    assert "numbers go on from lighter loads" in str(films.reason[-1])
    assert np.all(np.diff(films.approach) > 0.0) and np.all(films.damping > 0.0)
    assert films.errors["film_offset"][-1] > 3.0 * films.errors["film_offset"][0]


def test_films_of_heavy_contacts_are_those_of_lines(table):
    """Central films to M of a million against the film table of lines at the same width and pressure: 2 %, and 6 % far
    beyond what was solved, where both say as much.
    """
    loads, lines_ = np.geomspace(30.0, 3000.0, 12), shipped_tables().of(OIL)
    films = table.films(CONTACT, OIL, loads, 0.3, WARM)
    for i, load in enumerate(loads):
        a, peak = float(CONTACT.semi_axes(load)[0]), float(CONTACT.max_pressure(load))
        line = LineContact("line", STEEL * a / (4.0 * peak), MATERIAL, "iso16281", 1e-2)
        found = lines_.films(line, OIL, 0.5 * math.pi * a * peak, 0.3, WARM)
        solved = int(films.status[i]) == int(Status.CONVERGED)
        assert float(films.central_film[i]) == pytest.approx(float(found.central_film), rel=0.02 if solved else 0.06)


def test_what_is_continued_lies_within_what_is_stated():
    """Lines that bend, of which the heavier half is unknown: the bend that is left is told by the lines cut short."""
    zeta = np.r_[np.arange(0.0, 6.1, 0.5), 8.0]
    bends = np.linspace(-0.004, 0.004, 9)
    values = np.repeat((-0.1 * zeta[:, None] + bends * zeta[:, None] ** 2)[:, :, None], len(FIELDS), axis=2)
    stated = np.full((zeta.size, bends.size, len(ERRORS)), 1e-3)
    known = values.copy()
    values[zeta > 5.1] = math.nan
    found = heavy.continued_lines(zeta, values, stated)
    offset = found.values[..., 0] - known[..., 0]
    assert np.array_equal(found.continued, np.repeat((zeta > 5.1)[:, None], bends.size, axis=1))
    assert np.all(offset[zeta < 5.1] == 0.0) and np.max(np.abs(offset)) > 0.01
    near = (zeta > 5.1) & (zeta < 6.5)
    assert np.all(np.abs(offset[near]) <= (found.stated + found.growth)[near, :, 0] + 1e-12)


def test_law_is_the_table(table):
    """Load of each approach of the isothermal table, to cubics over load; slopes by quotients; at rest Hertz."""
    law = ehdmaps.law("6208", "FVA3", kind="inner", inlet_heat=False)
    contact = law.contacts[0]
    loads = np.geomspace(5.0, 2000.0, 7)
    films = table.films(contact, law.lubricant, loads, 3.0, WARM)
    load, stiffness, damping = law(films.approach, 0.0, 3.0, WARM)
    np.testing.assert_allclose(load, loads, rtol=1e-4)
    np.testing.assert_allclose(stiffness, films.stiffness, rtol=2e-3)
    np.testing.assert_allclose(damping, films.damping, rtol=5e-3)
    series = ehdmaps.law("6208", "FVA3", inlet_heat=False)
    assert len(series.contacts) == 2
    ahead, back = (series(films.approach + way * 1e-10, 1e-4, 3.0, WARM)[0] for way in (1.0, -1.0))
    np.testing.assert_allclose((ahead - back) / 2e-10, series(films.approach, 1e-4, 3.0, WARM)[1], rtol=1e-5)
    assert law(1e-6, -1.0, 3.0, WARM) == (0.0, 0.0, 0.0)  # never a tension
    dry = law(contact.approach(50.0), 1.0, 0.0, WARM)
    assert dry == pytest.approx((50.0, float(contact.stiffness(50.0)), 0.0), rel=1e-12)
    for wrong, error, words in (
        (lambda: law(1e-6, 0.0, 500.0, WARM), OutsideMapError, "L outside"),
        (lambda: law(math.nan, 0.0, 1.0, WARM), InputError, "no finite number"),
        (lambda: ehdmaps.law("6208", "FVA3", kind="line"), InputError, "allowed: series, inner, outer"),
        (lambda: ehdmaps.law("6208", "FVA3", solver=1), InputError, "got a solver; allowed: none, films are read"),
    ):
        with pytest.raises(error, match=words):
            wrong()


def test_solving_again_gives_the_nodes_of_the_shipped_file(table):
    """To the rounding of the file, 2^-16, and that of Newton from another start, 1e-5."""
    axes, (i, j, k) = table.nodes.axes, (17, 2, 3)
    oil = float(np.exp(axes.alpha[1])), float(axes.bend[1])
    (point,) = lines.solve_point_line(axes.zeta[i : i + 1], math.exp(axes.size[j]), math.exp(axes.shape[k]), *oil)
    np.testing.assert_allclose(table.nodes.values[i, j, k, 1, 1], point.values, atol=5e-5)


def test_file_is_small_and_a_changed_one_is_refused(tmp_path, table):
    with resources.as_file(resources.files("ehdmaps.table.points").joinpath(SHIPPED)) as shipped:
        assert shipped.stat().st_size < 300_000
        copy = Path(shutil.copy(shipped, tmp_path / "copy.nc"))
    with netCDF4.Dataset(copy, "a") as file:
        file["values"][0, 0, 0, 0, 0, 0] = 1.0
    with pytest.raises(MapError, match="was changed since it was made"):
        read_point_table(copy)
    (tmp_path / "none.nc").write_bytes(b"no table")
    with pytest.raises(MapError, match="cannot be read as a film table of points"):
        read_point_table(tmp_path / "none.nc")


def test_a_table_is_made_read_again_and_states_its_errors(tmp_path, monkeypatch):
    """Films by a formula in place of the solver: nodes are read to the rounding of the file, 2^-16, a point between
    them within what is stated; cells around the one node without a film are holes, and no others.
    """
    axes = PointAxes(
        np.array([0.0, 0.6, 1.1, 1.5, 2.0]), np.log([8.0, 10.0, 12.0, 15.0]), np.log([4.0, 5.0, 6.0, 7.0]),
        np.log([10e-9, 30e-9]), np.array([0.0, 1.0]),
    )  # fmt: skip

    def line(zeta, oil_number, ellipticity, alpha, bend):
        missing = (zeta > 1.9) & (ellipticity < 4.1) & (oil_number < 8.1) & (alpha < 1.1e-8) & (bend < 0.1)
        return [None if no else formula(z, oil_number, ellipticity, bend) for z, no in zip(zeta, missing, strict=True)]

    def formula(zeta, oil_number, ellipticity, bend):
        shape = math.log(ellipticity) * math.log(oil_number) + 0.1 * bend
        values = shape - 0.3 * np.arange(1.0, 16.0) * math.sin(0.7 * zeta)
        kappa, M = ellipticity, float(point_load_number(zeta, np.asarray(oil_number), np.asarray(ellipticity)))
        numbers = elliptic_numbers(kappa)
        g = float(numbers.pressure_factor)
        dry = 2.0 * float(numbers.integral) / (math.pi * kappa) / np.cbrt(3.0 * M / (math.pi * kappa * g))
        slope = -0.21 * math.cos(0.7 * zeta) * math.exp(values[0]) / M
        return SolvedPoint(values, -math.log(dry - slope), np.full(len(ERRORS), 1e-3))

    monkeypatch.setattr(maker, "solve_point_line", line)
    made = maker.make_point_table(axes, finer=0)
    write_point_table(tmp_path / "made.nc", made)
    nodes = read_point_table(tmp_path / "made.nc").nodes
    assert np.array_equal(nodes.values, made.nodes.values) and np.array_equal(nodes.codes, made.nodes.codes)
    holes = np.argwhere(nodes.codes[..., 0] == HOLE)
    assert holes.tolist() == [[3, 0, 0, 0, 0]]
    for place, most in (((0.6, math.log(10.0), math.log(6.0)), 4e-5), ((0.8, math.log(11.0), math.log(5.5)), 1.0)):
        at = tuple(np.array([x]) for x in (*place, math.log(10e-9), 0.0))
        wanted = formula(place[0], math.exp(place[1]), math.exp(place[2]), 0.0)
        wrong = errors.read_errors(nodes, at, [wanted])[0]
        stated, hole = nodes.errors(nodes.place(*at[:3], at[3:]))
        assert not hole[0] and np.all(wrong <= stated[0])
        assert wrong[: len(FIELDS)].max() < most


def test_no_smallest_film_is_above_the_central_one(table):
    """Both are cubics between nodes, which cross for up to 5 % of the loads and speeds of a ball."""
    contact = ball_estimate("7014C").contacts(MATERIAL)[0]
    heaviest = (4.2e9 / float(contact.max_pressure(1.0))) ** 3
    loads, speeds = np.geomspace(heaviest / 3000.0, heaviest, 40), np.geomspace(0.02, 20.0, 40)
    films = table.films(contact, Lubricant.named("ISO VG 32"), loads[:, None], speeds, 353.15)
    here = films.usable
    smallest, central = films.minimum_film[here], films.central_film[here]
    assert np.all(smallest <= central)
    alike = smallest == central
    assert np.any(alike)
    errors = films.errors
    assert np.all(errors["minimum_film"][here][alike] >= errors["central_film"][here][alike])


def test_films_wider_than_a_ball_are_refused():
    """A ball far from its ring: sqrt(2 Ry h) above 0.6 Dw/2, which is 31 um at the inner ring of a 7208B."""
    geometry = ball_estimate("7208B")
    contact = geometry.contacts(MATERIAL)[0]
    assert contact.widest_film == pytest.approx(31.2e-6, rel=2e-3)
    speed = geometry.entrainment_speed(20e3 * math.pi / 30.0)
    oil = Lubricant.named("ISO VG 32")
    loads = np.array([0.1, 2.0, 2.5, 20.0])
    films = shipped_point_table().films(contact, oil, loads, speed, 343.15)
    assert films.usable.tolist() == [False, False, True, True]
    assert np.all(films.film_offset[2:] < contact.widest_film)
    assert "wider than 0.6 of the ball's radius" in films.reason[1]
    # without a body whose radius is known, the paraboloid is all that there is
    bare = Ellipse(contact.rolling_radius, contact.transverse_radius, contact.reduced_modulus)
    assert shipped_point_table().films(bare, oil, 2.0, speed, 343.15).film_offset > contact.widest_film
    assert contact.too_wide(40e-6).startswith(
        "film of 40 um is wider than 0.6 of the ball's radius, which is so from 31.2 um"
    )
    assert not contact.too_wide(30e-6)
    with pytest.raises(InputError, match=r"ellipse, body_radius: got 0\.0 m"):
        Ellipse(1e-3, 1e-2, STEEL, 0.0)

"""The backbone of a map: its lines cover what a law reads, and what is read is what a fresh solve gives."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
import xarray as xr

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import MapError
from ehdmaps.maps.backbone import (
    FILMS,
    BackboneField,
    lagrange,
)
from ehdmaps.maps.backbone_plan import BackbonePlan, plan_backbone
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups, valley_load_number
from ehdmaps.physics.solids import STEEL
from tests.cases.moes import load_and_speed

OIL = Lubricant.named("FVA3")
CONTACTS = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")
LOADS, SPEEDS, TEMPERATURES = (3e3, 1e5), (0.5, 2.0), (323.15, 343.15)
SOLVER = ReynoldsSolver()


def _groups(contact: LineContact, load: float, speed: float, temperature: float) -> tuple[float, float]:
    state = OIL.at(temperature)
    alpha = state.pressure_viscosity.pressure_viscosity
    M, L = moes_groups(load, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
    return float(M), L


def _plan() -> BackbonePlan:
    plan = plan_backbone(CONTACTS, OIL, LOADS, SPEEDS, TEMPERATURES)
    assert plan is not None
    return plan


@cache
def _group(plan: BackbonePlan) -> xr.Dataset:
    values = np.full((3, len(plan.zeta), len(plan.speeds), len(plan.temperatures)), np.nan)
    for line in plan.lines:
        first, j, k = line.place
        for i, film in enumerate(SOLVER.solve_line(plan.contact, OIL, line.loads, line.speed, line.temperature)):
            assert film.status.usable
            values[:, first + i, j, k] = film.film_offset, film.film_compliance, film.loss_compliance
    dims = ("zeta", "reference_speed", "temperature")
    coordinates = dict(zip(dims, (list(plan.zeta), list(plan.speeds), list(plan.temperatures)), strict=True))
    return xr.Dataset({n: (dims, v) for n, v in zip(FILMS, values, strict=True)}, coords=coordinates)


def _field(plan: BackbonePlan, group: xr.Dataset) -> BackboneField:
    return BackboneField(group, plan.contact, CONTACTS, OIL, LOADS, SPEEDS, TEMPERATURES)


def test_contacts_of_one_temperature_collapse_exactly() -> None:
    """Equal M and L at one temperature: inner and outer contact have the same Moes film, to round-off."""
    inner, outer = CONTACTS
    state = OIL.at(313.15)
    M, L = _groups(inner, 2e4, 1.0, 313.15)
    alpha = state.pressure_viscosity.pressure_viscosity
    load, speed = load_and_speed(M, L, state.viscosity, alpha, outer.radius, outer.reduced_modulus)
    one = SOLVER.solve_line(inner, OIL, (2e4,), 1.0, 313.15)[0]
    two = SOLVER.solve_line(outer, OIL, (load,), speed, 313.15)[0]
    ratio = outer.radius / inner.radius
    # 1e-9: round-off through a system of condition 1e6
    assert two.film_offset / ratio == pytest.approx(one.film_offset, rel=1e-9)
    assert two.film_compliance == pytest.approx(one.film_compliance, rel=1e-8)
    assert two.loss_compliance == pytest.approx(one.loss_compliance, rel=1e-8)


def test_lines_cover_what_is_read() -> None:
    """Every line that a point of the map is mixed from has the point's zeta between its ends."""
    plan = _plan()
    ends = {
        line.place[1:]: (plan.zeta[line.place[0]], plan.zeta[line.place[0] + len(line.loads) - 1])
        for line in plan.lines
    }
    rng = np.random.default_rng(4)
    for _ in range(300):
        contact = CONTACTS[rng.integers(2)]
        load, speed = (float(np.exp(rng.uniform(*np.log(r)))) for r in (LOADS, SPEEDS))
        temperature = float(rng.uniform(*TEMPERATURES))
        M, L = _groups(contact, load, speed, temperature)
        zeta = math.log(M / float(valley_load_number(L)))
        rows, _ = lagrange(np.log(plan.speeds), math.log(speed * plan.contact.radius / contact.radius))
        columns, _ = lagrange(np.array(plan.temperatures), temperature)
        for j in rows:
            for k in columns:
                low, high = ends[(int(j), int(k))]
                assert low <= zeta <= high


@pytest.mark.slow
def test_field_against_fresh_solves() -> None:
    plan = _plan()
    field = _field(plan, _group(plan))
    rng = np.random.default_rng(8)
    for _ in range(40):
        contact = CONTACTS[rng.integers(2)]
        load, speed = (float(np.exp(rng.uniform(*np.log(r)))) for r in (LOADS, SPEEDS))
        temperature = float(rng.uniform(*TEMPERATURES))
        film = SOLVER.solve_line(contact, OIL, (load,), speed, temperature)[0]
        read = field.films(contact.name, np.array([[[load]]]), np.array([speed]), np.array([temperature]))
        offset, compliance, loss = (float(values[0, 0, 0]) for values in read)
        total = contact.structural_compliance(load) + film.film_compliance
        half = math.sqrt(8.0 * load * contact.radius / (math.pi * contact.reduced_modulus))
        # interpolation, and the grid error of both solves (1e-4 in offset, 3 % of compliance at worst)
        assert offset == pytest.approx(film.film_offset, rel=3e-4)
        assert compliance == pytest.approx(film.film_compliance, rel=0.02, abs=2e-4 * total)
        assert loss == pytest.approx(max(film.loss_compliance, 0.0), rel=0.03, abs=1e-3 * total * half / speed)
        assert loss > 0.0


def test_field_is_smooth_and_exact_in_its_slope() -> None:
    plan = _plan()
    field = _field(plan, _group(plan))
    loads = np.geomspace(*LOADS, 4001)[:, None, None]
    speed, temperature = np.array([1.0]), np.array([333.15])
    offset, compliance, loss = (v[:, 0, 0] for v in field.films("inner", loads, speed, temperature))
    quotient = -np.gradient(offset, loads[:, 0, 0])
    # second-order differences over 0.09 % of load
    assert compliance[1:-1] == pytest.approx(quotient[1:-1], rel=2e-3, abs=1e-4 * np.max(quotient))
    assert np.all(loss > 0.0)
    # no kinks: second differences of the logs vary slowly
    assert np.max(np.abs(np.diff(np.log(offset), 3))) < 1e-6


def test_a_line_without_points_is_refused() -> None:
    plan = _plan()
    shape = (len(plan.zeta), len(plan.speeds), len(plan.temperatures))
    dims = ("zeta", "reference_speed", "temperature")
    coordinates = dict(zip(dims, (list(plan.zeta), list(plan.speeds), list(plan.temperatures)), strict=True))
    group = xr.Dataset({n: (dims, np.full(shape, np.nan)) for n in FILMS}, coords=coordinates)
    with pytest.raises(MapError, match=r"backbone: 0 solved points at reference speed .* at least 8 are needed"):
        _field(plan, group)


def test_the_lines_hang_on_the_ends_of_the_axes_alone() -> None:
    """What `ehdmaps generate` tells where a law misses its bars: points of the map between the ends change nothing."""
    axes = (np.linspace(*ends, 9).tolist() for ends in (LOADS, SPEEDS, TEMPERATURES))
    assert plan_backbone(CONTACTS, OIL, *axes) == _plan()


def test_no_backbone_at_rest() -> None:
    assert plan_backbone(CONTACTS, OIL, LOADS, (0.0,), TEMPERATURES) is None

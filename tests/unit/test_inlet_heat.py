"""Heat in the inlet as a layer over isothermal films: limits, rules, refusals, and films with temperatures."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError
from ehdmaps.jobs.make.table_law import table_map
from ehdmaps.maps.emap import EHDMap
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.heat import INLET_HEAT, UNNOTICED, InletHeat, heated, inlet_heat, inlet_heat_factor
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.inlet_heat import equal_line, point_heats
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import FilmSolution, Status
from ehdmaps.point.solver import heated_solution, solve
from ehdmaps.table.points.file import shipped_point_table
from ehdmaps.table.points.films import NUMBERS, PointFilms

INNER, OUTER = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")
OIL = Lubricant.named("FVA3")
FAST = OperatingPoint(200e3, 10.0, 373.15)


def test_the_factor_is_that_of_wilson_and_sheu_for_loaded_contacts():
    """Another fit of the same thing, of contacts around M = 10: 2.5 % is what published factors differ by."""
    for loading in (0.01, 0.1, 0.5, 1.0, 2.0):
        published = 1.0 / (1.0 + 0.241 * loading**0.64)
        assert inlet_heat_factor(10.0, loading) == pytest.approx(published, abs=0.025)


def test_the_factor_falls_with_load_and_loading_from_one():
    assert inlet_heat_factor(5.0, 0.0) == 1.0
    assert inlet_heat_factor(1e-9, 1.0) == pytest.approx(1.0, abs=1e-8)  # 0.215 M/0.23
    factors = [inlet_heat_factor(5.0, loading) for loading in np.geomspace(1e-4, 3.0, 9)]
    assert np.all(np.diff(factors) < 0.0)
    assert np.all(np.diff([inlet_heat_factor(M, 1.0) for M in np.geomspace(1e-2, 1e2, 9)]) < 0.0)


@pytest.mark.parametrize(
    ("load", "speed", "celsius", "film", "compliance", "loss"),
    [
        # of isothermal films, by a prototype with temperatures in the film; contacts of N1014 and NU308, oil FVA 3
        (95.5e3, 12.49, 74.2, 0.871, 1.059, 0.758),
        (39.1e3, 10.0, 98.0, 0.952, 1.020, 0.903),
        (86.1e3, 10.53, 108.0, 0.957, 0.999, 0.900),
        (9.6e3, 12.5, 90.0, 0.934, 0.968, 0.926),
        (5.1e3, 15.39, 99.0, 0.941, 0.974, 0.966),
        (4.0e3, 2.74, 38.0, 0.956, 0.975, 0.961),
    ],
)
def test_the_rule_is_within_what_it_says_of_films_with_temperatures(load, speed, celsius, film, compliance, loss):
    radius = {
        95.5e3: 8.4848e-3,
        39.1e3: 4.0549e-3,
        86.1e3: 5.5152e-3,
        9.6e3: 5.5152e-3,
        5.1e3: 5.5152e-3,
        4.0e3: 4.9451e-3,
    }
    contact = dataclasses.replace(INNER, radius=radius[load])
    heat = inlet_heat(contact, OIL, OperatingPoint(load, speed, celsius + 273.15))
    assert heat.factor == pytest.approx(film, rel=heat.film_error)
    assert heat.factor**heat.exponent == pytest.approx(loss, rel=heat.loss_error)
    (cold,), (warm,) = (
        ReynoldsSolver(physics=physics).solve_line(contact, OIL, (load,), speed, celsius + 273.15)
        for physics in ("isothermal", INLET_HEAT)
    )
    assert warm.film_compliance / cold.film_compliance == pytest.approx(compliance, rel=heat.loss_error)


def test_reynolds_films_with_heat_are_isothermal_ones_times_the_factors():
    (cold,), (warm,) = (
        ReynoldsSolver(physics=physics).solve_line(INNER, OIL, (FAST.load,), FAST.entrainment_speed, FAST.temperature)
        for physics in ("isothermal", INLET_HEAT)
    )
    heat = inlet_heat(INNER, OIL, FAST)
    assert 0.9 < heat.factor < 0.95
    assert warm.film_offset == pytest.approx(heat.factor**0.9 * cold.film_offset, rel=1e-12)
    for name in ("central_film", "minimum_film", "rolling_force", "mass_flow"):
        assert getattr(warm, name) == pytest.approx(heat.factor * getattr(cold, name), rel=1e-12)
    assert warm.loss_compliance == pytest.approx(heat.factor**heat.exponent * cold.loss_compliance, rel=1e-12)
    step = 1e-3
    low, high = ReynoldsSolver(physics=INLET_HEAT).solve_line(
        INNER, OIL, (FAST.load * (1.0 - step), FAST.load * (1.0 + step)), FAST.entrainment_speed, FAST.temperature
    )
    quotient = (low.film_offset - high.film_offset) / (2.0 * step * FAST.load)
    # two solves whose grids differ by a part of a cell
    assert warm.film_compliance == pytest.approx(quotient, rel=0.02)
    same = ("max_pressure", "film_offset_error", "loss_compliance_error", "status")
    assert all(getattr(warm, name) == getattr(cold, name) for name in same)
    assert math.isnan(warm.film_temperature)
    assert "inlet heat by a formula: film x 0.9" in warm.reason
    (spectrum,) = ReynoldsSolver(physics=INLET_HEAT).line_spectra(
        INNER, OIL, (FAST.load,), FAST.entrainment_speed, FAST.temperature
    )
    (plain,) = ReynoldsSolver().line_spectra(INNER, OIL, (FAST.load,), FAST.entrainment_speed, FAST.temperature)
    assert spectrum.film.film_offset == warm.film_offset
    thinner = heat.factor**0.9
    moved = warm.film_compliance - thinner * cold.film_compliance
    np.testing.assert_allclose(spectrum.compliance.real, thinner * plain.compliance.real + moved, rtol=1e-12)
    np.testing.assert_allclose(spectrum.compliance.imag, heat.factor**heat.exponent * plain.compliance.imag, rtol=1e-12)


def test_laws_of_the_film_table_have_heat_by_the_same_rule():
    ranges = {"loads": (1e3, 3e5), "entrainment_speeds": (1.0, 12.0), "temperatures": (353.15, 393.15)}
    geometry = BearingGeometry.named("NU308")
    cold, warm = (table_map(geometry, OIL, **ranges, inlet_heat=heat) for heat in (False, True))
    speeds, kelvins = np.array([FAST.entrainment_speed]), np.array([FAST.temperature])
    step = np.array([1.0 - 1e-4, 1.0, 1.0 + 1e-4])
    loads = (FAST.load * step)[:, None, None]
    plain, found = (emap.film_field().films("inner", loads, speeds, kelvins) for emap in (cold, warm))
    heat = inlet_heat(INNER, OIL, FAST)
    assert 0.9 < heat.factor < 0.95
    factors = [(new / old)[1, 0, 0] for new, old in zip(found, plain, strict=True)]
    # lines of both are joined by splines through the same nodes
    assert (factors[0], factors[2]) == pytest.approx((heat.factor**0.9, heat.loss_factor), rel=1e-4)
    slope = -(found[0][2] - found[0][0]) / (loads[2] - loads[0])
    np.testing.assert_allclose(found[1][1], slope, rtol=1e-6)
    forces, flows = (
        [getattr(emap.rolling_film, name)("inner", FAST.load, 10.0, FAST.temperature) for emap in (cold, warm)]
        for name in ("rolling_force", "mass_flow")
    )
    assert [new / old for old, new in (forces, flows)] == pytest.approx([heat.factor] * 2, rel=1e-9)
    # the rule may be wrong by what it says, and so bands know it
    errors = [emap.dataset["loss_compliance_error"].sel(contact="inner").values[-1, -1, 0] for emap in (cold, warm)]
    at = OperatingPoint(3e5, 12.0, 353.15)
    assert errors[1] - errors[0] == pytest.approx(inlet_heat(INNER, OIL, at).loss_error, rel=1e-3)
    assert warm.inlet_heat and EHDMap(warm.dataset).inlet_heat and not EHDMap(cold.dataset).inlet_heat


def test_heat_of_the_table_is_refused_where_the_table_does_not_serve():
    with pytest.raises(InputError, match=r"^inlet heat of .*: its films have to be solved .*; allowed: films of the"):
        table_map(INNER, OIL, solver=ReynoldsSolver(shear="eyring"), inlet_heat=True)


def test_settings_name_the_physics_only_where_it_is_not_the_default():
    assert "physics" not in ReynoldsSolver().settings()
    assert ReynoldsSolver(physics=INLET_HEAT).settings()["physics"] == INLET_HEAT
    with pytest.raises(InputError, match="physics: got 'warm'; allowed: isothermal, inlet-heat"):
        ReynoldsSolver(physics="warm")


def test_it_is_refused_where_no_factor_holds():
    def refused(load, speed, celsius):
        return inlet_heat(INNER, OIL, OperatingPoint(load, speed, celsius + 273.15)).refused

    assert "loading QL = 9.77 above 8" in refused(50e3, 18.0, 41.0)
    assert "below 0.2 at a loading QL = 1.01 above 0.5" in refused(3e3, 10.0, 60.0)
    assert "from the bottom of the damping valley" in refused(19e3, 6.05, 52.0)
    assert refused(19e3, 0.6, 52.0) == ""  # as near the bottom, but no heat to speak of
    assert refused(200e3, 10.0, 100.0) == ""
    film = FilmSolution(Status.CONVERGED, film_offset=1e-6, solve_seconds=2.0)
    lost = heated(film, InletHeat(0.8, "no factor", 0.0, 2.0, 0.1, 0.1))
    assert (lost.status, lost.reason, lost.solve_seconds) == (Status.OUTSIDE_VALIDITY, "no factor", 2.0)
    failed = FilmSolution(Status.FAILED, "why")
    assert heated(failed, InletHeat(0.8, "", 0.0, 2.0, 0.1, 0.1)) is failed


def test_standstill_and_slow_films_have_no_heat():
    still = inlet_heat(INNER, OIL, OperatingPoint(1e4, 0.0, 313.15))
    assert (still.factor, still.refused, still.note) == (1.0, "", "")
    slow = inlet_heat(OUTER, OIL, OperatingPoint(1e5, 0.2, 333.15))
    assert slow.factor > UNNOTICED
    assert slow.note == ""


def test_what_the_rule_says_nothing_of_is_refused():
    solver = ReynoldsSolver(physics=INLET_HEAT)
    with pytest.raises(InputError, match="'inlet-heat' for the profile of a film, of which its rule says nothing"):
        solver.film_profile(INNER, OIL, FAST)
    with pytest.raises(InputError, match="'inlet-heat' for the film behind an oil layer"):
        solver.supplied_film(INNER, OIL, FAST, OilSupply(1e-6))
    unknown = dataclasses.replace(OIL, thermal_conductivity=None)
    with pytest.raises(InputError, match="thermal_conductivity: got none; films with heat need it"):
        inlet_heat(INNER, unknown, FAST)


def test_heat_is_told_by_speed_and_oil_and_not_by_the_contact():
    """At equal M and L the loading differs between contacts: films with heat are no functions of M and L."""
    points = [
        OperatingPoint(FAST.load * c.radius / INNER.radius, FAST.entrainment_speed * c.radius / INNER.radius, 373.15)
        for c in (INNER, OUTER)
    ]
    state = OIL.at(373.15)
    groups = [
        moes_groups(p.load, p.entrainment_speed, state.viscosity, 1.6e-8, c.radius, c.reduced_modulus)
        for p, c in zip(points, (INNER, OUTER), strict=True)
    ]
    np.testing.assert_allclose(groups[0], groups[1], rtol=1e-12)
    factors = [inlet_heat(c, OIL, p).factor for c, p in zip((INNER, OUTER), points, strict=True)]
    assert factors[0] - factors[1] > 0.02


class TestPoints:
    """Point contacts: the inner contact of a 7208B at 3 to 300 N, 12 m/s, 80 degC."""

    ELLIPSE = ball_estimate("7208B").contacts(STEEL)[0]
    LOADS = np.geomspace(3.0, 300.0, 7)
    AT = 12.0, 353.15

    def films(self, oil: Lubricant, inlet_heat: bool, loads: np.ndarray = LOADS) -> PointFilms:
        return shipped_point_table().films(self.ELLIPSE, oil, loads, *self.AT, inlet_heat=inlet_heat)

    def test_without_heat_numbers_are_isothermal(self):
        """An oil that conducts all heat away: film compliance and the response go through 1/k, which loses digits."""
        cold, still = self.films(OIL, False), self.films(dataclasses.replace(OIL, thermal_conductivity=1e30), True)
        for name in (*NUMBERS, "response_stiffness", "response_damping"):
            np.testing.assert_allclose(getattr(still, name), getattr(cold, name), rtol=1e-9, err_msg=name)
            np.testing.assert_allclose(still.errors[name], cold.errors[name], rtol=1e-9, err_msg=name)

    def test_laws_can_be_made_of_it(self):
        """Film compliance is the slope of the film offset over the load, 1/k and c/k^2 belong to k and c."""
        step = 1e-4
        low, warm, high = (self.films(OIL, True, self.LOADS * factor) for factor in (1.0 - step, 1.0, 1.0 + step))
        slope = (low.film_offset - high.film_offset) / (2.0 * step * self.LOADS)
        np.testing.assert_allclose(warm.film_compliance, slope, rtol=1e-4)  # the table's own cubics
        np.testing.assert_allclose(1.0 / warm.stiffness, 1.0 / self.ELLIPSE.stiffness(self.LOADS) + slope, rtol=1e-5)
        np.testing.assert_allclose(warm.loss_compliance, warm.damping / warm.stiffness**2, rtol=1e-12)
        np.testing.assert_allclose(warm.approach, self.ELLIPSE.approach(self.LOADS) - warm.film_offset, rtol=1e-9)

    def test_films_are_thinner_and_say_how_sure_they_are(self):
        cold, warm = self.films(OIL, False), self.films(OIL, True)
        heat = point_heats(self.ELLIPSE, OIL, self.LOADS, *(np.full(7, x) for x in self.AT))
        assert np.all((heat.factor > 0.8) & (heat.factor < 0.96)) and np.all(np.diff(heat.factor) < 0.0)
        for name in ("central_film", "minimum_film"):
            np.testing.assert_allclose(getattr(warm, name), heat.factor * getattr(cold, name), rtol=1e-12)
        for name in NUMBERS[1:-1]:
            assert np.all(warm.errors[name] > cold.errors[name]), name
        np.testing.assert_array_equal(warm.load_number, cold.load_number)
        np.testing.assert_array_equal(warm.max_pressure, cold.max_pressure)

    def test_the_equal_line_has_the_pressure_of_the_ellipse(self):
        state, u = OIL.at(self.AT[1]), self.AT[0]
        modulus, radius = self.ELLIPSE.reduced_modulus, self.ELLIPSE.rolling_radius
        number = 2.0 * state.viscosity * u / (modulus * radius)
        M = self.LOADS / (modulus * radius**2) * number**-0.75
        load = 2.0 * np.pi * radius * self.ELLIPSE.max_pressure(self.LOADS) ** 2 / modulus  # Hertz' line
        line, _ = moes_groups(load, u, state.viscosity, 1.6e-8, radius, modulus)
        np.testing.assert_allclose(equal_line(self.ELLIPSE, M), line, rtol=1e-12)

    def test_solved_films_have_the_same_rule(self):
        load = 60.0
        cold = solve(self.ELLIPSE, OIL, load, *self.AT)
        warm, read = heated_solution(cold, OIL), self.films(OIL, True, np.array([load]))
        heat = point_heats(self.ELLIPSE, OIL, *(np.array([x]) for x in (load, *self.AT))).of(0)
        assert warm.central_film == pytest.approx(heat.factor * cold.central_film, rel=1e-12)
        assert "inlet heat by a formula: film x 0." in warm.reason
        for name in ("film_offset", "stiffness", "damping"):  # the numerics of both
            wrong = getattr(cold, name).error + self.films(OIL, False, np.array([load])).errors[name][0]
            assert getattr(warm, name) == pytest.approx(getattr(read, name)[0], rel=1.5 * wrong), name
        dry = solve(self.ELLIPSE, OIL, load, 0.0, self.AT[1])
        assert heated_solution(dry, OIL) is dry

    def test_an_oil_of_unknown_conductivity_is_refused(self):
        with pytest.raises(InputError, match="thermal_conductivity: got none; films with heat need it"):
            self.films(dataclasses.replace(OIL, thermal_conductivity=None), True)

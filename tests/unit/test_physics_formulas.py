"""Hertz, groups, film, damping and heating formulas: scaling, monotony, derivatives, limits, messages."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ehdmaps.errors import InputError
from ehdmaps.physics import films, hertz, moes
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.films import dietl_damping
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from tests.cases.moes import load_and_speed

ROUND_OFF = 1e-12
ALPHA, ETA, RADIUS, MODULUS = 2.2e-8, 0.08, 5.5e-3, 230.77e9

load_numbers = st.floats(-4.0, 6.0).map(lambda exponent: 10.0**exponent)
oil_numbers = st.one_of(st.just(0.0), st.floats(0.01, 150.0))


# --- Hertz -----------------------------------------------------------------------------------------------


def test_hertz_identities():
    w = 1e5
    b, p_h = hertz.half_width(w, RADIUS, MODULUS), hertz.max_pressure(w, RADIUS, MODULUS)
    assert p_h == pytest.approx(2 * w / (math.pi * b), rel=ROUND_OFF)
    assert p_h == pytest.approx(MODULUS * b / (4 * RADIUS), rel=ROUND_OFF)


def test_hertz_pressure_carries_the_load():
    """Midpoint rule on 20001 points: 1e-5 bounds its error at the vertical ends."""
    w = 1e5
    b, p_h = hertz.half_width(w, RADIUS, MODULUS), hertz.max_pressure(w, RADIUS, MODULUS)
    edges = np.linspace(-1.5 * b, 1.5 * b, 20002)
    x = 0.5 * (edges[1:] + edges[:-1])
    assert hertz.pressure(x, b, p_h).sum() * (edges[1] - edges[0]) == pytest.approx(w, rel=1e-5)
    assert hertz.pressure(np.array([-1.2 * b, 0.0, b]), b, p_h).tolist() == [0.0, p_h, 0.0]


def test_hertz_gap():
    b = 1e-4
    x = np.array([0.0, 0.5, -1.0, 2.0, -2.0, 1000.0]) * b
    gap = hertz.gap(x, b, RADIUS) / (b**2 / (2 * RADIUS))
    assert gap[:3].tolist() == [0.0, 0.0, 0.0]
    assert gap[3] == gap[4] == pytest.approx(2 * math.sqrt(3) - math.log(2 + math.sqrt(3)), rel=ROUND_OFF)
    assert gap[5] == pytest.approx(1000.0**2 - math.log(2000.0) - 0.5, rel=1e-12)  # next term 1e-6/8e6


@given(load=st.floats(1.0, 1e6), factor=st.floats(0.1, 10.0))
def test_hertz_scaling(load, factor):
    assert hertz.half_width(factor * load, factor * RADIUS, MODULUS) == pytest.approx(
        factor * hertz.half_width(load, RADIUS, MODULUS), rel=ROUND_OFF
    )
    assert hertz.max_pressure(factor * load, factor * RADIUS, MODULUS) == pytest.approx(
        hertz.max_pressure(load, RADIUS, MODULUS), rel=ROUND_OFF
    )


# --- groups ----------------------------------------------------------------------------------------------


def test_moes_groups_by_hand():
    M, L = moes.moes_groups(1e5, 1.5, ETA, ALPHA, RADIUS, MODULUS)
    speed_number = ETA * 3.0 / (MODULUS * RADIUS)
    assert pytest.approx(1e5 / (MODULUS * RADIUS) / math.sqrt(speed_number), rel=ROUND_OFF) == M
    assert pytest.approx(ALPHA * MODULUS * speed_number**0.25, rel=ROUND_OFF) == L
    film = moes.film_from_moes(5.0, 1.5, ETA, RADIUS, MODULUS)
    assert film == pytest.approx(5.0 * RADIUS * math.sqrt(speed_number), rel=ROUND_OFF)


@given(load=st.floats(1.0, 1e6), speed=st.floats(1e-3, 50.0))
def test_groups_and_back(load, speed):
    M, L = moes.moes_groups(load, speed, ETA, ALPHA, RADIUS, MODULUS)
    back = load_and_speed(M, L, ETA, ALPHA, RADIUS, MODULUS)
    assert back == pytest.approx((load, speed), rel=1e-11)  # fourth powers of round-off


@given(load=st.floats(1.0, 1e6), speed=st.floats(1e-3, 50.0))
def test_both_sets_of_groups_say_the_same(load, speed):
    M, L = moes.moes_groups(load, speed, ETA, ALPHA, RADIUS, MODULUS)
    U, W, G = moes.dowson_groups(load, speed, ETA, ALPHA, RADIUS, MODULUS)
    assert pytest.approx(W / math.sqrt(2 * U), rel=ROUND_OFF) == M
    assert pytest.approx(G * (2 * U) ** 0.25, rel=ROUND_OFF) == L


@given(factor=st.floats(0.1, 10.0))
def test_groups_do_not_change_with_the_size_of_the_contact(factor):
    """Lengths and speeds times a factor at the same stresses: the groups stay."""
    small = moes.moes_groups(1e5, 1.5, ETA, ALPHA, RADIUS, MODULUS)
    large = moes.moes_groups(factor * 1e5, factor * 1.5, ETA, ALPHA, factor * RADIUS, MODULUS)
    assert large == pytest.approx(small, rel=ROUND_OFF)


# --- films -----------------------------------------------------------------------------------------------


@given(M=load_numbers, L=oil_numbers)
def test_moes_slope_is_the_derivative(M, L):
    """Central differences in ln M with step 1e-4: truncation 1e-8, round-off 1e-12."""
    H, slope = films.moes_central_and_slope(M, L)
    up, down = films.moes_central(M * math.exp(1e-4), L), films.moes_central(M * math.exp(-1e-4), L)
    assert slope * M / H == pytest.approx((math.log(up) - math.log(down)) / 2e-4, rel=1e-6, abs=1e-9)


@given(M=load_numbers, L=oil_numbers)
def test_moes_film_thins_with_load_and_thickens_with_the_oil_number(M, L):
    H, slope = films.moes_central_and_slope(M, L)
    assert math.isfinite(H)
    assert H > 0 > slope
    assert films.moes_central(M, L + 1.0) > H


@given(M=load_numbers, L=oil_numbers)
def test_moes_formula_as_printed(M, L):
    """The printed sum of powers, where it neither overflows nor divides by zero."""
    if L == 0.0:
        L = 0.01
    h_ri, h_ei, h_rp, h_ep = 3 / M, 2.621 * M**-0.2, 1.287 * L ** (2 / 3), 1.311 * M**-0.125 * L**0.75
    s = (7 + 8 * math.exp(-2 * h_ei / h_ri)) / 5
    isoviscous = (h_ri ** (7 / 3) + h_ei ** (7 / 3)) ** (3 * s / 7)
    piezoviscous = (h_rp**-3.5 + h_ep**-3.5) ** (-2 * s / 7)
    assert films.moes_central(M, L) == pytest.approx((isoviscous + piezoviscous) ** (1 / s), rel=1e-12)


@pytest.mark.parametrize(
    ("M", "L", "limit"),
    [
        (1e-4, 0.0, 3e4),  # rigid isoviscous
        (1e6, 0.0, 2.621 * 1e6**-0.2),  # elastic isoviscous
        (1e6, 150.0, 1.311 * 1e6**-0.125 * 150**0.75),  # elastic piezoviscous
    ],
)
def test_moes_regimes(M, L, limit):
    """1 % bounds what the other regimes still add at these ends."""
    assert films.moes_central(M, L) == pytest.approx(limit, rel=0.01)


def test_formulas_take_arrays():
    M = np.array([1e-4, 1.0, 1e6])
    H, slope = films.moes_central_and_slope(M, 10.0)
    for index, value in enumerate(M):
        assert (H[index], slope[index]) == pytest.approx(films.moes_central_and_slope(value, 10.0), rel=ROUND_OFF)
    for formula in (
        films.dowson_higginson_minimum,
        films.dowson_toyoda_central,
        films.pan_hamrock_central,
    ):
        W = np.array([1e-5, 1e-4])
        assert formula(1e-11, W, 5000.0)[1] == pytest.approx(formula(1e-11, 1e-4, 5000.0), rel=ROUND_OFF)
        assert type(formula(1e-11, 1e-4, 5000.0)) is float
    assert type(films.moes_central(1.0, 10.0)) is float


@pytest.mark.parametrize(
    ("formula", "speed", "load", "material"),
    [
        (films.dowson_higginson_minimum, 0.70, -0.13, 0.54),
        (films.dowson_toyoda_central, 0.69, -0.10, 0.56),
        (films.pan_hamrock_central, 0.692, -0.166, 0.470),
    ],
)
def test_exponents_of_the_power_laws(formula, speed, load, material):
    base = formula(1e-11, 3e-5, 5000.0)
    assert formula(2e-11, 3e-5, 5000.0) / base == pytest.approx(2**speed, rel=ROUND_OFF)
    assert formula(1e-11, 6e-5, 5000.0) / base == pytest.approx(2**load, rel=ROUND_OFF)
    assert formula(1e-11, 3e-5, 10000.0) / base == pytest.approx(2**material, rel=ROUND_OFF)


# --- damping ---------------------------------------------------------------------------------------------


def test_damping_constants():
    unit = {"film": 1e-3, "viscosity": 2.0, "radius": 1e-3}
    assert films.rolling_film_damping(**unit) == pytest.approx(2 * 6.548, rel=1e-4)  # four printed digits


@given(film=st.floats(1e-8, 1e-4), factor=st.floats(1.1, 10.0))
def test_damping_falls_with_the_film_to_the_power_of_one_and_a_half(film, factor):
    thin, thick = (films.rolling_film_damping(times * film, ETA, RADIUS) for times in (1.0, factor))
    assert thin / thick == pytest.approx(factor**1.5, rel=ROUND_OFF)


def test_dietl_damping_is_that_of_loaded_contacts():
    """Equation 23 at 1.8 kN on a roller of an NU308: 3 % is twice the share of the film in the compliance."""
    bearing, oil = BearingGeometry.named("NU308"), Lubricant.named("FVA3")
    contact = bearing.contacts(STEEL, "iso16281")[0]
    solver = FormulaSolver(damping="dietl", inlet_length_factor=2.0)
    film = solver.solve_line(contact, oil, (1.8e5,), 1.7, 313.15)[0]
    compliance = float(contact.structural_compliance(1.8e5)) + film.film_compliance
    state = oil.at(313.15)
    numbers = state.viscosity, state.pressure_viscosity.pressure_viscosity, contact.radius, contact.reduced_modulus
    whole = dietl_damping(1.8e5, 1.7, *numbers, bearing.roller_length, 2.0)
    assert film.loss_compliance / compliance**2 * bearing.roller_length == pytest.approx(whole, rel=0.03)
    assert solver.settings()["damping"] == "dietl"
    rigid = FormulaSolver().solve_line(contact, oil, (1.8e5,), 1.7, 313.15)[0]
    assert rigid.loss_compliance < 0.1 * film.loss_compliance
    bare = LineContact("line", 5e-3, STEEL, "half_space", reference_depth=5e-3)
    with pytest.raises(InputError, match="damping: got 'dietl' for 'line', whose length is not known"):
        solver.solve_line(bare, oil, (1e5,), 1.7, 313.15)

"""Laws beyond the edges of their map, against fresh solutions and against what they must join."""

import itertools
import math

import numpy as np
import pytest

import ehdmaps
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import MapError
from ehdmaps.maps.compilation import OF_TABLE
from ehdmaps.maps.edges.continued import ContinuedField, continued_field
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.outside_calls import Excursion
from ehdmaps.maps.table_field import TableField
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.solution import ContactSolution, contact_solution
from ehdmaps.physics.surface import SMOOTH, Surface
from tests.cases.laws import CONTACTS, OIL

LOADS, SPEEDS, TEMPERATURES = (1e3, 1e6), (0.3, 3.0), (303.15, 363.15)
INNER, OUTER = CONTACTS

SOLVER = ReynoldsSolver(density=14, inlet_length=700)


class Thicker:
    """Films of the table, thicker and lossier by constants: those of another solver, of which no table knows."""

    def __init__(self, field: TableField) -> None:
        self.field = field
        self.contacts, self.dry = field.contacts, False
        self.load_range, self.speed_range = field.load_range, field.speed_range
        self.temperature_range = field.temperature_range
        self.first_loads, self.ends = field.first_loads, field.ends

    def films(self, contact, loads, speeds, temperatures):
        offset, compliance, loss = self.field.films(contact, loads, speeds, temperatures)
        return 1.07 * offset, 1.07 * compliance, 1.2 * loss


def table_field(contacts: tuple[LineContact, ...] = (INNER, OUTER)) -> TableField:
    return TableField(contacts, OIL, LOADS, SPEEDS, TEMPERATURES)


def law_of(field: FilmField, kind="inner", outside="asymptote", continued=True, **what) -> ContactLaw:
    contacts = (INNER, OUTER) if kind == "series" else (INNER,)
    going_on = continued_field(field, contacts, OIL) if continued else None
    return ContactLaw(kind, contacts, OIL, field, outside, OF_TABLE, continued=going_on, **what)


@pytest.fixture(scope="module")
def plain() -> ContactLaw:
    return law_of(table_field((INNER,)))


def fresh(load: float, speed: float, temperature: float) -> ContactSolution:
    (film,) = SOLVER.solve_line(INNER, OIL, (load,), speed, temperature)
    return contact_solution(film, INNER, OperatingPoint(load, speed, temperature))


POINTS = [
    *((w, u, 313.15) for u in (0.15, 0.04) for w in (2e3, 2e4, 3e5)),
    *((w, 1.0, T) for T in (283.15, 383.15) for w in (2e3, 2e4, 3e5)),
    (5e4, 0.1, 383.15),
]


@pytest.mark.parametrize(("load", "speed", "temperature"), POINTS)
def test_fresh_solutions_are_met_outside_the_map(plain, load, speed, temperature):
    solved = fresh(load, speed, temperature)
    at = plain.at(speed, temperature)
    low, high = solved.approach - 5e-6, solved.approach + 5e-6
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if at(middle, 0.0)[0] < load else (low, middle)
    _, k, c = at(low, 0.0)
    # what films read from the table are good to, see the check of laws: 1e-3 of k, 5 % of c
    assert k == pytest.approx(solved.stiffness, rel=1e-3)
    unit = solved.stiffness * float(half_width(load, INNER.radius, INNER.reduced_modulus)) / speed
    # a law has no damping below zero
    damping = max(solved.damping, 0.0)
    assert c == pytest.approx(damping, rel=0.05, abs=1e-3 * unit)
    assert low == pytest.approx(solved.approach, abs=0.01 * solved.film_offset)
    errors = plain.continued.errors("inner", np.array([load]), speed, temperature)
    own = solved.stiffness_error or 0.0, solved.damping_error or 0.0
    assert abs(k / solved.stiffness - 1.0) <= errors.stiffness[0] + own[0] + 3e-4  # that of the table of a law
    if damping > 1e-2 * unit:
        assert abs(c / damping - 1.0) <= errors.damping[0] + own[1] + 3e-3
        assert errors.damping[0] < 0.5


def test_what_was_mapped_stays(plain):
    without = law_of(table_field((INNER,)), outside="error", continued=False)
    again = law_of(table_field((INNER,)), outside="error")
    rng = np.random.default_rng(2)
    n = 3000
    u, T = np.exp(rng.uniform(*np.log(SPEEDS), n)), rng.uniform(*TEMPERATURES, n)
    delta = rng.uniform(0.0, 15e-6, n)
    before = law_of(table_field((INNER,)), "inner", "clamp", continued=False)(delta, 0.0, u, T)
    inside = (before[0] > LOADS[0]) & (before[0] < LOADS[1])
    arguments = delta[inside], 0.0, u[inside], T[inside]
    before, after, beyond = without(*arguments), again(*arguments), plain(*arguments)
    # the error of the table of a law: nodes beyond the edge take the place of its end conditions
    for found in (after, beyond):
        for one, other, error in zip(before[:2], found[:2], (5e-4, 3e-3), strict=True):
            np.testing.assert_allclose(other, one, rtol=error)
    away = u[inside] > 1.5 * SPEEDS[0]
    np.testing.assert_allclose(after[0][away], before[0][away], rtol=2e-5)


def test_a_speed_below_the_map_is_told_and_refused_by_no_policy():
    law = law_of(table_field((INNER,)), outside="error")
    law(5e-6, 0.0, 0.1, 333.15)
    assert law.excursions == (Excursion("entrainment_speed", "below", 1, 0.1, 0.3),)
    assert law.excursions[0].text == "entrainment_speed 0.1 m/s below the map, which begins at 0.3 m/s"
    assert not any(law.outside_counts.values())


def test_temperatures_are_counted_outside_the_map_though_films_go_on(plain):
    plain.reset_counts()
    warm, held = plain(5e-6, 0.0, 1.0, [TEMPERATURES[1] + 20.0, TEMPERATURES[1]])[2]
    assert plain.outside_counts == {"load": 0, "entrainment_speed": 0, "temperature": 1}
    assert warm < 0.7 * held  # the oil is thinner there
    cold, hot = plain.continued.reach
    assert cold < TEMPERATURES[0] - 30.0
    assert hot > TEMPERATURES[1] + 30.0
    far, edge = (plain.at(1.0, T)(5e-6, 0.0) for T in (hot + 50.0, hot))
    assert far == edge


def test_the_limit_of_small_roughness_is_the_smooth_law():
    field = table_field((INNER,))
    smooth, rough = (law_of(field, outside="clamp", surface=surface) for surface in (SMOOTH, Surface(1e-9)))
    T = 303.15
    for u, load in itertools.product(SPEEDS[0] * np.array([2.0, 0.5, 0.15, 0.11]), (1e4, 1e5)):
        answers = []
        for law in (smooth, rough):
            at, low, high = law.at(u, T), -1e-6, 3e-5
            for _ in range(60):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if at(middle, 0.0)[0] < load else (low, middle)
            answers.append((low, *at(low, 0.0)[1:]))
        # asperities of 1 nm, the finest ones, where films have 30 nm and more; the error of both tables
        assert answers[1] == pytest.approx(answers[0], rel=5e-3), (u, load)


def test_damping_rises_as_the_speed_falls(plain):
    def damping(u: float) -> float:
        at, low, high = plain.at(u, 313.15), -1e-6, 3e-5
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if at(middle, 0.0)[0] < 1e5 else (low, middle)
        return float(at(low, 0.0)[2])

    found = [damping(u) for u in np.geomspace(0.03, 0.3, 9)]
    assert np.all(np.diff(found) < 0.0)


def test_films_of_another_solver_join_the_edge_and_keep_their_difference():
    field = continued_field(Thicker(table_field()), (INNER, OUTER), OIL)  # type: ignore[arg-type]
    table = table_field()
    assert isinstance(field, ContinuedField)
    loads = np.geomspace(2e3, 5e5, 7)[:, None, None] * np.ones((1, 3, 3))
    u, T = np.array([0.05, 0.2, 1.0]), np.array([293.15, 333.15, 380.15])
    found, known = field.films("inner", loads, u, T), table.films("inner", loads, u, T)
    # lines of other speeds are laid to other loads, where their values are bent to meet
    np.testing.assert_allclose(found[0], 1.07 * known[0], rtol=3e-4)
    np.testing.assert_allclose(found[1], 1.07 * known[1], rtol=5e-3, atol=2e-17)
    # asinh keeps a loss between its difference and its ratio
    assert np.all((found[2] > known[2]) & (found[2] < 1.5 * known[2]))
    below, at = (field.films("inner", loads[:, :1, :1], np.array([s]), T[1:2]) for s in (0.3 * (1 - 1e-9), 0.3))
    # a loss that is continued is lifted a second time where it is near its floor
    for one, other, error in zip(below, at, (1e-6, 1e-6, 2e-3), strict=True):
        np.testing.assert_allclose(one, other, rtol=error)
    step = 1e-5
    lighter, heavier = (field.films("inner", loads * math.exp(x), u, T)[0] for x in (-step, step))
    np.testing.assert_allclose(found[1], (lighter - heavier) / (2.0 * step * loads), rtol=1e-5)
    wrong = field.errors("inner", loads[:, 0, 0], 0.1, 333.15)
    assert np.all(wrong.damping > 0.05)  # all of the difference counts, and more


def test_an_oil_that_no_table_knows_goes_on_by_the_trends_of_the_map():
    origin = Thicker(table_field((INNER,)))
    field = ContinuedField(origin, (INNER,), OIL, None)  # type: ignore[arg-type]
    loads = np.geomspace(2e3, 5e5, 5)
    np.testing.assert_array_equal(
        field.films("inner", loads[:, None, None], np.array([0.1]), np.array([333.15])),
        origin.films("inner", loads[:, None, None], np.array([0.1]), np.array([333.15])),
    )
    near, far = (field.errors("inner", loads, u, 333.15).damping for u in (0.25, 0.05))
    assert np.all(near < far)


def test_below_whole_films_and_beyond_the_reach_all_of_the_film_counts_as_wrong(plain):
    loads = np.array([1e4, 1e5])
    for u, T in ((0.01, 333.15), (1.0, plain.continued.reach[1] + 5.0)):
        wrong = plain.continued.errors("inner", loads, u, T)
        np.testing.assert_array_equal(wrong.damping, 1.0)


ROUGH = Surface(2e-7)
LAWS = [
    ("inner", "clamp", 2e-7, ROUGH),
    ("inner", "asymptote", math.inf, ROUGH),
    ("series", "asymptote", 5e-6, SMOOTH),
]
"""A thin layer, a thick one and none, rough and smooth, one of them in a series."""


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "outside", "layer", "surface"), LAWS)
def test_every_law_can_be_made_and_is_monotone_and_passive(kind, outside, layer, surface):
    supply = FLOODED if math.isinf(layer) else OilSupply(layer)
    law = law_of(table_field((INNER, OUTER)), kind, outside, supply=supply, surface=surface)
    table = law.plain_table
    slow, fast = (table.lowest_speed, table.highest_speed) if outside == "asymptote" else SPEEDS
    delta = np.linspace(-3e-5, 2e-5, 201)
    for u in (slow, math.sqrt(slow * fast), fast):
        for T in (table.lowest_temperature, 333.15, table.highest_temperature):
            w, k, c = law_at(law, u, T)(delta, 0.0)
            inside = w < LOADS[1]
            assert np.all(np.diff(w[inside]) >= 0.0)
            assert np.all(k[inside] >= 0.0)
            assert np.all(c[inside] >= 0.0)
            assert np.any(w > 0.0)


def law_at(law, u, T):
    point = law.at(u, T)

    def held(delta, rate):
        highest = delta[np.searchsorted([point_load(point, d) for d in delta], 0.9 * LOADS[1]) - 1]
        return tuple(np.asarray(x) for x in point(np.minimum(delta, highest), rate))

    return held


def point_load(point, delta):
    return point._made.forces(np.array([float(delta)]), np.zeros(1))[0][0, 0]


class Ending:
    """Films of the table that end outside the map: beyond `fastest`, and beyond some degrees of its temperatures."""

    def __init__(self, field: TableField, fastest: float, degrees: float) -> None:
        self.field, self.fastest, self.degrees = field, fastest, degrees
        self.contacts, self.dry = field.contacts, False
        self.load_range, self.speed_range = field.load_range, field.speed_range
        self.temperature_range = field.temperature_range
        self.first_loads, self.ends = field.first_loads, field.ends

    def films(self, contact, loads, speeds, temperatures):
        cold, hot = self.temperature_range
        if (
            max(speeds) > self.fastest
            or min(temperatures) < cold - self.degrees
            or max(temperatures) > hot + self.degrees
        ):
            raise MapError("no films there")
        return self.field.films(contact, loads, speeds, temperatures)


@pytest.mark.parametrize(
    ("fastest", "degrees", "share"), [(1e3, 1e3, 1.0), (15.0, 1e3, 0.5), (1e3, 15.0, 0.25), (3.0001, 0.001, 0.0)]
)
def test_a_law_holds_the_edge_where_there_are_no_films(plain, fastest, degrees, share):
    """Nobody asked for the nodes of a table beyond the map: without films there the law is held nearer to the map."""
    field = table_field((INNER,))
    ending = Ending(field, fastest, degrees)
    continued = ContinuedField(ending, (INNER,), OIL, None)
    law = ContactLaw("inner", (INNER,), OIL, ending, "asymptote", OF_TABLE, continued=continued)
    table = law.plain_table
    assert table.highest_speed == pytest.approx(SPEEDS[1] * 10.0**share, rel=1e-12)
    assert law.continued.reach == (table.lowest_temperature, table.highest_temperature)
    assert table.highest_temperature == pytest.approx(TEMPERATURES[1] + 40.0 * share, abs=1e-9)
    arguments = np.linspace(1e-6, 15e-6, 60), 0.0, np.linspace(0.3, 3.0, 60), np.linspace(304.0, 363.0, 60)
    for one, other, rtol in zip(law(*arguments), plain(*arguments), (5e-4, 3e-3, 3e-2), strict=True):
        np.testing.assert_allclose(one, other, rtol=rtol)  # nodes beyond the edge in place of its end conditions
    beyond = law(8e-6, 0.0, 20.0 * SPEEDS[1], TEMPERATURES[1] + 60.0)
    at_reach = law(8e-6, 0.0, table.highest_speed, table.highest_temperature)
    np.testing.assert_allclose(beyond, at_reach, rtol=1e-12)


def test_a_law_without_films_in_its_map_is_refused():
    with pytest.raises(MapError, match="no films there"):
        ending = Ending(table_field((INNER,)), 2.0, 1e3)
        ContactLaw("inner", (INNER,), OIL, ending, "asymptote", OF_TABLE, continued=None)


OILS = [("NU207", "ISO VG 7"), ("N1014", "ISO VG 3200")]
"""The thinnest class that has an index, and the thickest."""


@pytest.mark.slow
@pytest.mark.parametrize(("bearing", "oil"), OILS)
def test_every_kind_and_policy_of_shipped_classes_makes_a_law(bearing, oil):
    """With the ranges of who says nothing, far beyond which each is asked."""
    made = {
        (kind, outside): ehdmaps.law(bearing, oil, kind, outside=outside)
        for kind, outside in (("series", "error"), ("series", "asymptote"), ("outer", "clamp"))
    }
    approach = np.linspace(-5e-6, 40e-6, 60)[:, None, None]
    u, T = np.geomspace(1e-3, 300.0, 9)[:, None], np.linspace(250.0, 450.0, 7)
    for (_, outside), law in made.items():
        cold, hot = law.temperature_range
        inside = approach[:20], 0.0, np.array([0.06, 0.5, 2.0])[:, None], np.linspace(cold, hot, 4)
        for w, k, c in (law(*inside), *(() if outside == "error" else (law(approach, 0.0, u, T),))):
            assert np.all(np.isfinite(w)) and np.all(np.isfinite(k)) and np.all(np.isfinite(c))
            assert np.all(np.diff(w, axis=0) >= 0.0) and np.all(k >= 0.0) and np.all(c >= 0.0)

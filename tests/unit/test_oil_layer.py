"""Contact laws on an oil layer: the rigid closed form, both limits, and what every law has to be."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import ehdmaps
from ehdmaps.jobs.job import Job
from ehdmaps.maps.contact_curve import ContactCurve
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.oil_layer import oil_layer
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.films import rolling_film_damping
from ehdmaps.physics.oil_supply import FLOODED, RIGID_FLOW, OilSupply, compliance_ratio, damping_ratio, film_ratio
from tests.cases.laws import CONTACTS, OIL, SMALL_FIELD, ValleyField

SPEED, WARM = np.array([1.0]), np.array([320.0])
ETA = OIL.at(320.0).viscosity
LIGHT = dataclasses.replace(SMALL_FIELD, load_range=(100.0, 1e6), depth=0.0)


@dataclasses.dataclass(frozen=True)
class RigidField(ValleyField):
    """Films between rigid surfaces at all loads."""

    def films(self, contact, loads, speeds, temperatures):
        radius = self.line_contacts[self.contacts.index(contact)].radius
        film = 6.0 * ETA * speeds[:, None] * radius / (RIGID_FLOW * loads)
        compliance = film / loads
        return film, compliance, rolling_film_damping(film, ETA, radius) * compliance**2


RIGID = RigidField(load_range=(300.0, 1e6), speed_range=(0.3, 3.0), temperature_range=(313.15, 343.15))


def law(layer, field=LIGHT, kind="series", contacts=CONTACTS):
    supply = FLOODED if layer is None else OilSupply(layer)
    return ContactLaw(kind, contacts, OIL, field, "clamp", supply=supply)


def layered(field, layer, root, contact=CONTACTS[0], speed=SPEED):
    curve = ContactCurve(field, contact, speed, WARM)
    first = np.cbrt(field.load_range[0])
    column = root[:, None, None]
    inside = column[root >= first]
    flooded = curve.below(column[root < first]).then(curve.mapped(inside**3))
    return curve, flooded, oil_layer(contact, layer, curve.tail, None, speed, WARM)(flooded)


@pytest.mark.parametrize("layer", [1e-6, 5e-6])
def test_film_of_rigid_surfaces_is_the_closed_form(layer):
    """Gap and c at r up to 0.7 are those of the starved rigid contact, above and below the lowest mapped load.

    The corner takes 0.8 % off r at 0.7. s is rounded by 0.2^4/(8 r^(4/3)): 2 % at r = 0.03, where it takes 6 % of the
    gap; c goes with s^(-3/2).
    """
    at_layer = 6.0 * ETA * CONTACTS[0].radius / layer
    r = np.array([0.03, 0.1, 0.3, 0.5, 0.7])
    _, _, film = layered(RIGID, layer, np.cbrt(r * at_layer))
    s = np.sqrt(r)
    gap = layer / RIGID_FLOW * film_ratio(s)[0]
    np.testing.assert_allclose(film.offset[:, 0, 0], gap, rtol=8e-3)
    # Film and structure in series: c = b/(S + s)^2.
    load = film.load[:, 0, 0]
    flooded = 6.0 * ETA * CONTACTS[0].radius / (RIGID_FLOW * load)
    held = compliance_ratio(s) * r * flooded / load
    c = rolling_film_damping(flooded, ETA, CONTACTS[0].radius) * damping_ratio(s) * s**-1.5
    c *= (held / (CONTACTS[0].structural_compliance(load) + held)) ** 2
    curve = ContactCurve(RIGID, CONTACTS[0], SPEED, WARM).with_structure(film)
    np.testing.assert_allclose((curve.loss_ratio * film.load)[:, 0, 0], c, rtol=3.5e-2)


@pytest.mark.parametrize("layer", [1e-9, 3e-7, 5e-6, 2e-5, 1e-4, 1e-3])
def test_slopes_are_derivatives_and_the_curve_rises(layer):
    """Film and its slope over g, from below lift-off to above the map; 1e-5 of the steepest slope: of the quotient."""
    first = np.cbrt(LIGHT.load_range[0])
    root = np.concatenate((np.linspace(-0.1, 0.999, 300) * first, np.linspace(1.0001, 8.0, 300) * first))
    step = 1e-5
    curve, _, film = layered(LIGHT, layer, root)
    _, _, high = layered(LIGHT, layer, root + step)
    _, _, low = layered(LIGHT, layer, root - step)
    quotient = (high.offset - low.offset) / (2.0 * step)
    inner = slice(1, -1)
    steepest = np.max(np.abs(film.slope))
    np.testing.assert_allclose(film.slope[inner], quotient[inner], rtol=1e-4, atol=1e-5 * steepest)
    whole = curve.with_structure(film)
    assert np.all(np.diff(whole.approach[:, 0, 0]) > 0.0)
    assert np.all(whole.loss_ratio > 0.0)


def test_the_film_joins_at_the_lowest_load_and_never_exceeds_the_layer():
    first = np.cbrt(LIGHT.load_range[0])
    for layer in (2e-6, 5e-6, 5e-5):
        _, flooded, film = layered(LIGHT, layer, first * np.array([1.0 - 1e-9, 1.0]))
        assert film.offset[0] == pytest.approx(film.offset[1], rel=1e-7)
        assert film.slope[0] == pytest.approx(film.slope[1], rel=1e-6)
        assert film.loss[0] == pytest.approx(film.loss[1], rel=1e-6)
        _, flooded, film = layered(LIGHT, layer, first * np.linspace(0.0, 1.0, 200))
        assert np.all(film.offset <= layer * (1.0 + 1e-12))
        assert np.all(film.offset <= flooded.offset * (1.0 + 1e-12))


def test_without_load_the_film_is_the_layer():
    """1 nm to a fifth of the fade: to the rounding of the two ends, (layer/fade)^8/8."""
    for layer in (1e-9, 1e-6, 2e-5):
        _, _, film = layered(LIGHT, layer, np.array([0.0]))
        assert film.offset[0, 0, 0] == pytest.approx(layer, rel=1e-6)


def test_a_thick_layer_is_no_layer():
    """The film goes over into the flooded one as the layer grows: ten times the end of the fade leaves 1e-8."""
    first = np.cbrt(LIGHT.load_range[0])
    root = np.linspace(-0.2, 5.0, 200) * first
    errors = []
    for layer in (1e-4, 3e-4, 1e-3):
        curve, flooded, film = layered(LIGHT, layer, root)
        errors.append(float(np.max(np.abs(film.offset / flooded.offset - 1.0))))
        c, wanted = (curve.with_structure(part).loss_ratio * part.load for part in (film, flooded))
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 1e-8
    np.testing.assert_allclose(c, wanted, rtol=1e-4, atol=2e-6 * np.max(wanted))


def test_a_flooded_law_is_the_law_without_a_supply():
    plain, flooded = (
        ContactLaw("inner", CONTACTS[:1], OIL, LIGHT, "clamp"),
        law(None, kind="inner", contacts=CONTACTS[:1]),
    )
    np.testing.assert_array_equal(plain.table.own.coefficients, flooded.table.own.coefficients)
    np.testing.assert_array_equal(plain.table.own.place, flooded.table.own.place)
    assert plain.supply is FLOODED


@pytest.fixture(scope="module", params=[1e-9, 5e-7, 5e-6, 1e-3])
def some_law(request):
    return law(request.param)


def test_law_is_smooth_rising_and_passive(some_law):
    """Over random points with extremes; 2e-3: quotients of a cubic spline whose third derivative jumps."""
    rng = np.random.default_rng(7)
    layer = some_law.supply.oil_layer
    n = 20_000
    speed = np.exp(rng.uniform(np.log(0.3), np.log(3.0), n))
    kelvin = rng.uniform(*LIGHT.temperature_range, n)
    end = 2.0 * min(layer, 1e-4)
    delta = np.where(rng.random(n) < 0.7, -end * rng.uniform(0.0, 1.05, n), rng.uniform(-1e-6, 1e-5, n))
    w, k, c = some_law(delta, 0.0, speed, kelvin)
    assert np.all(w >= 0.0) and np.all(k >= 0.0) and np.all(c >= 0.0)
    assert np.all(np.isfinite([w, k, c]))
    if layer < 1e-4:  # thicker ones end with the fade of the flooded contact, which follows its film
        assert np.all(w[delta < -1.03 * end] == 0.0)
    step = 1e-4 * 0.1e-6
    above, below = (some_law(delta + sign * step, 0.0, speed, kelvin)[0] for sign in (1.0, -1.0))
    np.testing.assert_allclose((above - below) / (2.0 * step), k, rtol=2e-3, atol=1e-3 * np.max(k))
    # Through speed and temperature no jump either: a thousandth of a step of the table.
    near = some_law(delta, 0.0, speed * (1.0 + 1e-7), kelvin + 1e-6)[0]
    assert np.max(np.abs(near - w) / (w + 1.0)) < 1e-4


def test_law_at_rest_is_dry(some_law):
    dry = law(None).at(0.0, 320.0)
    delta = np.linspace(-1e-5, 1e-5, 41)
    np.testing.assert_allclose(some_law.at(0.0, 320.0)(delta, 0.0 * delta)[0], dry(delta, 0.0 * delta)[0], atol=1e-12)
    slowest, zero = some_law.at(1e-6, 320.0), np.zeros(1)
    np.testing.assert_allclose(slowest(zero + 1e-6, zero)[0], dry(zero + 1e-6, zero)[0], rtol=1e-6)


def test_table_follows_its_samples():
    """Load and stiffness between the nodes of the table: 0.5 % of w, 5 % of k where the layer makes its corner."""
    layer = 3e-6
    it = law(layer)
    for speed, kelvin in ((0.47, 317.3), (2.1, 338.8)):
        total = None
        us, temperatures = np.array([speed]), np.array([kelvin])
        root = np.linspace(0.3, 1.0, 80)[:-1] * np.cbrt(LIGHT.load_range[0])
        loads = np.geomspace(*LIGHT.load_range, 200)
        for contact in CONTACTS:
            curve = ContactCurve(LIGHT, contact, us, temperatures)
            flooded = curve.below(root[:, None, None]).then(curve.mapped(loads[:, None, None]))
            film = oil_layer(contact, layer, curve.tail, None, us, temperatures)(flooded)
            whole = curve.with_structure(film)
            total = whole if total is None else total + whole
        w, k, c = it.at(speed, kelvin)(total.approach[:, 0, 0], np.zeros(film.root.shape[0]))
        at_layer = 6.0 * OIL.at(kelvin).viscosity * speed * CONTACTS[0].radius / layer
        wanted = film.load[:, 0, 0]
        some = wanted > 0.1 * at_layer
        np.testing.assert_allclose(w[some], wanted[some], rtol=5e-3)
        stiff = 3.0 * np.cbrt(wanted) ** 2 / total.slope[:, 0, 0]
        np.testing.assert_allclose(k[some], stiff[some], rtol=5e-2)
        np.testing.assert_allclose(c[some], (total.loss_ratio[:, 0, 0] * wanted)[some], rtol=5e-2)


def test_films_with_memory_stand_on_the_layered_law():
    """Settled films carry the load of the law; a sudden step meets at least its stiffness, and takes energy."""
    at = law(2e-6).at(1.0, 320.0)
    delta = np.array([-3.5e-6, -2e-6, 0.0, 4e-6])
    memory = at.memory
    state = memory.settled(delta)
    w, k, _ = at(delta, 0.0 * delta)
    np.testing.assert_allclose(state.load, w, rtol=2e-3)
    sudden = memory.advance(state, delta + 1e-9, 1e-9)[0]
    assert np.all(sudden - state.load >= 0.99e-9 * k)
    work = 0.0
    for i in range(400):
        following = delta + 5e-7 * np.sin(2.0 * np.pi * (i + 1) / 100.0)
        before = delta + 5e-7 * np.sin(2.0 * np.pi * i / 100.0)
        load = state.load
        new, _, state = memory.advance(state, following, 1e-5)
        work += 0.5 * (new + load) * (following - before) if i >= 300 else 0.0
    assert np.all(work > 0.0)


def test_the_flow_of_a_map_along_loads_is_that_of_its_contact():
    """Whatever was asked before, a layer is fed as `RollingFilm.flow` says; a spline over a tenth of ln(w): 1e-4."""
    job = Job.build(
        bearing=BearingGeometry.named("NU308"), lubricant=OIL, loads=np.geomspace(2e3, 4e5, 5),
        entrainment_speeds=(0.5, 3.0), temperatures=(320.0, 345.0), law_check=0, name="nu308",
    )  # fmt: skip
    flows = ehdmaps.EHDMap(ehdmaps.generate(job)).rolling_film
    speeds, kelvins, load = np.array([0.7, 2.0]), np.array([325.0, 340.0]), 3.1e4
    first = np.full((2, 2), 2.5e3)
    for own in (speeds, speeds, speeds[::-1]):
        for contact in ("inner", "outer"):
            found = np.exp(flows.flow_film(contact, first, own, kelvins).at(np.full((1, 2, 2), np.log(load)))[0][0])
            wanted = [[float(flows.flow(contact, load, u, T)) for T in kelvins] for u in own]
            np.testing.assert_allclose(found, wanted, rtol=1e-4)

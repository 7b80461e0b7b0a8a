"""One gate for all kinds of bearings: the same cause, words and status for the same fact."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.hertz import LINE_LIMIT, POINT_LIMIT
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.solids import STEEL
from mbs import assemble, critical, lsa, modes, parse_scene, statics, sweep
from mbs.analyses.lsa import LsaSettings
from mbs.analyses.soundness import Judged, findings_at_rest
from mbs.analyses.sweep import SweepSettings
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.ball_point import BallPoint
from mbs.bearings.balls.laws import dry_law
from mbs.linearised.validity import lifting
from mbs.model.elements import OnRings, Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.findings import Cause, Severity, worst_of
from mbs.settings import SweepRange

SCENE = """
schema = 1
[operation]
speed = "100 rpm"
temperature = "60 degC"
[[bodies]]
name = "rotor"
freedoms = {freedoms}
spin = 1
mass = "8 kg"
[[loads]]
name = "pull"
on = "rotor"
force = {force}
[[inputs]]
name = "push"
on = "rotor"
direction = "y"
amplitude = "{amplitude}"
[[sensors]]
name = "seen"
on = "rotor"
direction = "y"
quantity = "displacement"
[linear]
frequencies = {{ from = "1 Hz", to = "2 Hz", points = 2, spacing = "log" }}
"""
HEAVY = {"cylindrical": (6e5, 0.0), "rollers as bodies": (6e5, 0.0), "deep groove": (1.2e5, 1e3)}
"""Radial and axial loads that no contact carries; of others both are 300 kN."""

BEARING = '[[bearings]]\nname = "{name}"\nbearing = "{kind}"\ninner = "rotor"\nouter = "ground"\n{more}\n'

KINDS = {
    "cylindrical": ("NU308", "", False, "roller", LINE_LIMIT),
    "rollers as bodies": ("NU308", 'rollers = "bodies"', False, "roller", LINE_LIMIT),
    "needle": ("NA4905", "", False, "roller", LINE_LIMIT),
    "deep groove": ("6208", "", True, "ball", POINT_LIMIT),
    "angular contact": ("7208B", "", True, "ball", POINT_LIMIT),
    "tapered": ("32208", "", True, "roller", LINE_LIMIT),
    "ribs one way": ("NJ308", "", True, "roller", LINE_LIMIT),
    "ribs": ("NUP308", "", True, "roller", LINE_LIMIT),
}


def machine(kind, radial, axial, *, law="hertz", amplitude="1 N", more="", others=""):
    name, own, locates, _, _ = KINDS[kind]
    freedoms = '["x", "y", "z"]' if locates else '["y", "z"]'
    force = f'["{axial} N", "{radial} N", "0 N"]' if locates else f'["0 N", "{radial} N", "0 N"]'
    bearing = BEARING.format(name="left", kind=name, more=f"{own}\n{more}")
    text = SCENE.format(freedoms=freedoms, force=force, amplitude=amplitude) + bearing + others
    return assemble(parse_scene(text, "rotor", "rotor.toml"), law)


@pytest.mark.parametrize("kind", KINDS)
def test_overload_has_one_cause_and_one_sentence(kind):
    _, _, _, element, limit = KINDS[kind]
    crushed = machine(kind, *HEAVY.get(kind, (3e5, 3e5)))
    heavy = statics(crushed)
    graves = {one.cause: one for one in heavy.findings}
    assert {Cause.PRESSURE, Cause.OVERLOAD} <= set(graves)
    assert graves[Cause.PRESSURE].words.endswith(
        "GPa is above 7 GPa, the hardness of bearing steel, which no contact carries"
    )
    assert graves[Cause.OVERLOAD].words.endswith(
        f"raceway) is above {1e-9 * limit:g} GPa, the static limit of ISO 76: permanent deformation; elastic contacts "
        "and films no longer hold"
    )
    assert heavy.dataset.attrs["unsound"].startswith("left: Hertz pressure of ")
    assert "the static limit of ISO 76" in heavy.dataset.attrs["warnings"]
    judged = Judged([("", heavy.findings)])
    assert judged.status == 1 and judged.first[0].startswith("error: the figures below mean nothing: left: Hertz ")
    assert {one.cause for one in modes(crushed).findings} == set(graves)
    quiet = statics(machine(kind, 1e3, 1e3))
    assert not {Cause.PRESSURE, Cause.OVERLOAD, Cause.UNLOADED} & {one.cause for one in quiet.findings}
    assert "unsound" not in quiet.dataset.attrs
    (entry,) = quiet.model.on_rings
    motion = quiet.model.system.relative(entry.inner, entry.outer) @ quiet.balance.displacement
    assert entry.gauge(motion, quiet.balance.operation).element == element


@pytest.mark.parametrize("kind", KINDS)
def test_what_the_gauge_says_is_what_the_forces_are(kind):
    """Loads of all elements along the load make up the force: the gauge shares no sum with the force."""
    found = statics(machine(kind, 2e3, 1e3))
    (entry,), (index,) = found.model.on_rings, found.balance.system.select(OnRings)
    motion = found.model.system.relative(entry.inner, entry.outer) @ found.balance.displacement
    gauge = entry.gauge(motion, found.balance.operation)
    np.testing.assert_allclose(
        entry.element_loads(motion, found.balance.operation), gauge.load[0], rtol=1e-9, atol=1e-6
    )
    element = found.balance.system.elements[index]
    ports = element.transform @ found.balance.displacement
    same = element.element.gauge(ports, found.balance.operation)
    np.testing.assert_allclose(same.load, gauge.load, rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(same.pressure, gauge.pressure, rtol=1e-12)
    assert np.all(gauge.load[0].sum() >= 0.99 * 2e3)


@pytest.mark.parametrize("kind", KINDS)
def test_bearings_that_carry_nothing_say_so(kind):
    """Rings apart: along for those that have a contact angle, else within the clearance."""
    name, _, _, element, _ = KINDS[kind]
    apart = {"7208B": 'axial_offset = "-40 um"', "32208": 'axial_offset = "-40 um"'}
    more = apart.get(name, 'diametral_clearance = "40 um"')
    loose = machine(kind, 1e3, 1e3, more=more)
    still = np.zeros(loose.system.size)
    found = [one for one in findings_at_rest(loose, still, Operation(0.0)) if one.cause is Cause.UNLOADED]
    assert [one.told for one in found] == [
        f"left: no {element} carries load: nothing holds the shaft there, preload is lost"
    ]
    assert Judged([("", found)]).status == 0 and Judged([("", found)]).last == [f"warning: {found[0].told}"]


@pytest.mark.parametrize("kind", [kind for kind, row in KINDS.items() if row[2]])
def test_loads_without_films_have_one_cause_and_one_sentence(kind):
    """Bearings that carry axial load, above and below the loads for which their films were made."""
    (bearing,) = machine(kind, 2e3, 1e3).on_rings
    force = bearing.force
    load = np.full((2, force.angles.size), 100.0)
    assert force.reach_of(load) is None  # dry
    force.film_loads = (1.0, 1e3)
    assert force.reach_of(load) is None
    begin = "films are known from 1 to 1000 N; contacts carry up to "
    load[0, 0] = 2e3
    found = force.reach_of(load)
    assert (found.cause, found.severity.status, found.excess) == (Cause.REACH, 1, 2.0)
    assert (
        found.words == f"{begin}2000 N, and 0 less than that: their films go on along straight lines in the logarithms"
    )
    load[0, 0], load[1, :2] = 10.0, 0.5
    load[1, 2:] = 10.0
    found = force.reach_of(load[1:])
    assert (found.cause, found.severity.status) == (Cause.FILM, 0)
    assert found.words.startswith(f"{begin}10 N, and 2 less than that")


@pytest.mark.parametrize("kind", KINDS)
def test_a_motion_that_is_no_number_is_no_lost_preload(kind):
    """Every kind refuses it as what it is, at rest and in time."""
    made = machine(kind, 2e3, 1e3)
    (place,) = made.ring_places
    connected = made.system.elements[place]
    still = np.zeros(connected.transform.shape[0])
    for answer in (
        lambda motion: connected.element.evaluate(motion, still, Operation(10.0)),
        lambda motion: connected.element.advance(None, motion, still, Operation(10.0)),
    ):
        with pytest.raises(InputError, match="finite numbers"):
            answer(np.full_like(still, np.nan))


def test_severities_follow_from_the_cause():
    graves = {cause: cause.severity for cause in Cause}
    assert graves[Cause.PRESSURE] is Severity.UNSOUND and graves[Cause.SLIDING] is Severity.NOTE
    assert {grave.status for grave in graves.values()} == {0, 1}
    assert (Severity.BEYOND.word, Severity.WARNING.word) == ("warning", "warning")


def test_the_worst_of_several_places():
    crushed = [statics(machine("cylindrical", load, 0.0)).findings for load in (5e4, 4e5, 2e5)]
    over = worst_of(crushed, ["1 rpm", "2 rpm", "3 rpm"], "speeds")
    (one,) = [one for one in over if one.cause is Cause.OVERLOAD]
    assert one.words.endswith("(at 2 of 3 speeds, here at 2 rpm)")
    assert worst_of([()], ["1 rpm"], "speeds") == ()


@pytest.mark.parametrize("height", [0.17, 0.2, 0.25])
def test_shoulder_of_a_6208(height, monkeypatch):
    """The axial load at which the ellipse of Hertz ends where the groove does, by one angle of both contacts alone."""
    monkeypatch.setattr("mbs.bearings.balls.ball_findings.SHOULDERS", (height, 0.35))
    geometry = ball_estimate("6208").with_clearance(0.0)
    force = BallForce(geometry, dry_law(geometry, STEEL))

    def told(load):
        found = BallPoint.at(force, (load, 0.0, 0.0), 0.0).findings
        return Cause.SHOULDER in [one.cause for one in found]

    low, high = 1e3, 1e5
    while high > 1.001 * low:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if told(middle) else (middle, high)
    # the same by hand: both contacts of a ball at one angle, without speed
    inner, outer = geometry.contacts(STEEL)
    distance = (geometry.inner_conformity + geometry.outer_conformity - 1.0) * geometry.ball_diameter
    angles = np.linspace(0.01, 1.2, 20001)
    stretch = distance * (1.0 / np.cos(angles) - 1.0)  # no clearance: the free angle is zero
    load = stretch**1.5 / (inner.coefficient ** (-2.0 / 3.0) + outer.coefficient ** (-2.0 / 3.0)) ** 1.5
    reach = angles + np.arcsin(np.minimum(2.0 * inner.semi_axes(load)[1] / geometry.ball_diameter, 1.0))
    at = int(np.argmax(reach > math.acos(1.0 - height / geometry.inner_conformity)))
    by_hand = geometry.balls * load[at] * math.sin(angles[at])
    assert low == pytest.approx(by_hand, rel=3e-3)  # of the bisection, and of steps of 6e-5 rad


PAIR = BEARING.format(name="right", kind="7208B", more='mirrored = true\naxial_offset = "-10 um"')


def preloaded(amplitude="1 N", radial=0.0):
    model = machine(
        "angular contact", radial, 0.0, amplitude=amplitude, more='axial_offset = "10 um"', others=PAIR, law="hertz"
    )
    return model


def test_lift_off_of_a_preloaded_pair_is_that_of_the_least_loaded_ball():
    """A static load more, solved again: loads of all balls, in a thousandth of the preload."""
    model = preloaded(radial=100.0)
    balance = equilibrium(model.system, model.operation)
    place = balance.system.select(OnRings)[0]
    rule = lifting(balance, place)
    assert rule.of == "ball" and rule.static.size == ball_estimate("7208B").balls
    system = preloaded(radial=100.5).system
    other = equilibrium(system, model.operation, balance.displacement, tolerance=1e-13)
    connected = balance.system.elements[place]
    before, after = (
        connected.element.element_loads(connected.transform @ one.displacement, model.operation)
        for one in (balance, other)
    )
    force = other.forces[place] - balance.forces[place]
    # of a step of a newton beside a preload of a kilonewton
    np.testing.assert_allclose(rule.by_force @ -force, after - before, atol=5e-3 * np.abs(after - before).max())


def test_linear_analyses_say_where_a_ball_of_a_preloaded_pair_lifts_off():
    """The least loaded ball goes long before the force on the ring is that at rest; quasi-static at 1 Hz."""
    model = preloaded(radial=100.0)
    balance = equilibrium(model.system, model.operation)
    places = balance.system.select(OnRings)
    # forces on both rings by a push, the pair solved as two springs in parallel
    x = np.linalg.solve(balance.stiffness, [0.0, 1.0, 0.0])
    shares = []
    for place in places:
        rule, moved = lifting(balance, place), balance.system.elements[place].transform @ x
        force = balance.element_stiffness[place] @ moved
        shares.append(np.max(np.abs(rule.by_force @ force) / rule.static))
    most = 1.0 / max(shares)
    for part, lifts in ((0.9, False), (1.1, True)):
        found = lsa(preloaded(f"{part * most:.6g} N", 100.0), LsaSettings((1.0,)))
        told = [one for one in found.findings if one.cause is Cause.LIFT_OFF]
        assert bool(told) == lifts
        assert not lifts or "the dynamic load of a ball, " in told[0].words
        swept = sweep(found.model, SweepSettings(SweepRange(10.0, 11.0, 2)))
        (over,) = swept.findings
        assert [one.bearing for one in over if one.cause is Cause.LIFT_OFF] == [one.bearing for one in told]
        assert not lifts or found.dataset.attrs["warnings"].count("contacts lift off") == len(told)
        assert len(told) == len(found.lifting)
    assert 0.5 * most < 0.7 * np.linalg.norm(balance.forces[places[0]][:3])


UNBALANCE = """
[[unbalances]]
name = "rest"
on = "rotor"
moment = "{moment} kg m"
"""


@pytest.mark.parametrize("kind", ["cylindrical", "deep groove", "angular contact", "tapered", "ribs"])
def test_critical_says_where_unbalances_lift_contacts_off(kind):
    """m r omega^2 at 1000 rad/s is 100 kN of 0.1 kg m, and 10 N of a ten-thousandth, beside 2 kN at rest."""
    speeds = SweepSettings(SweepRange(100.0, 1000.0, 4))
    for moment, lifts in ((0.1, True), (1e-5, False)):
        others = UNBALANCE.format(moment=moment)
        found = critical(machine(kind, 2e3, 2e3, law="hertz:1.25e-5 s", others=others), speeds)
        told = [one for one in found.findings if one.cause is Cause.LIFT_OFF]
        assert [one.bearing for one in told] == ["left"] * lifts
        assert not lifts or "order 1: the dynamic load of " in told[0].words
        assert not lifts or "contacts lift off: small motions no more; see mbs runup" in told[0].words
        assert ("lift off" in found.dataset.attrs.get("warnings", "")) == lifts


def test_gyroscopic_sliding_is_a_note_of_every_analysis():
    """M_g goes with the square of the speed: traction over load, above 0.05 of fast light balls."""
    fast = preloaded()
    for speed, slides in ((100.0, False), (2000.0, True)):
        found = modes(fast, Operation(speed)).findings
        told = [one for one in found if one.cause is Cause.SLIDING]
        assert [one.bearing for one in told] == ["left", "right"] * slides
        judged = Judged([("", found)])
        assert judged.status == 0 and len(judged.last) == len(told)
        assert all(line.startswith("note: ") and "balls may slide" in line for line in judged.last)

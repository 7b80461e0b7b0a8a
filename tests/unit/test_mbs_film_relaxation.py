"""Films that relax: the limits of slow and quick motion, energy, steps in time, and few states for many slices."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.maps.law import ContactLaw
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.laws import hertz
from mbs.bearings.roller_contacts import RollerContacts
from mbs.bearings.roller_element import RollerElement
from mbs.linearised.dynamic import TOLERANCE, film_states, together
from mbs.model.elements import Operation
from mbs.model.relaxation import Relaxation
from tests.cases.c_functions import approach_at
from tests.cases.laws import CONTACTS, OIL, SMALL_FIELD

BEARING = Bearing.named("NU308", clearance=20e-6, slices=7)
AT = Operation(speed=100.0, angle=0.3)
WARM = 330.0
POSE = np.array([0.0, 18e-6, 4e-6, 0.0, 2e-5, -1e-5])


@functools.cache
def law(kind="series"):
    contacts = CONTACTS if kind == "series" else [c for c in CONTACTS if c.name == kind]
    return ContactLaw(kind, contacts, OIL, SMALL_FIELD, "clamp")


def massless(films="memory", bearing=BEARING, **others):
    return BearingElement("a", "shaft", "ground", bearing, BearingForce(bearing, law()), WARM, films=films, **others)


def bodies(films="memory"):
    contacts = RollerContacts(BEARING, law("inner"), law("outer"))
    return RollerElement(massless("slow"), contacts, "rollers", films)


def at_rest(element):
    """An element and its ports at rest."""
    if isinstance(element, BearingElement):
        return element, POSE
    plain = element.plain
    conditions = {
        "cage_angle": plain.cage_angle(AT),
        "entrainment_speed": plain.entrainment_speed(AT),
        "temperature": WARM,
    }
    return element, element.contacts.settled(POSE, **conditions)


CASES = [at_rest(massless()), at_rest(bodies())]
NAMES = ["massless", "bodies"]


def stiffness(element, ports, s):
    """Z(s), its K and C, and what relaxes."""
    forces = element.evaluate(ports, np.zeros_like(ports), AT)
    relaxation = element.relaxation(ports, AT)
    slow = forces.stiffness + s[:, None, None] * forces.damping
    return slow + relaxation.more(s), forces, relaxation


@pytest.mark.parametrize(("element", "ports"), CASES, ids=NAMES)
def test_slow_motion_has_stiffness_and_damping_of_the_map(element, ports):
    _, forces, relaxation = stiffness(element, ports, np.array([1.0j]))
    # Each slice has its c as a damper in series: together they are C, to rounding.
    np.testing.assert_allclose(relaxation.damping, forces.damping, atol=1e-12 * np.abs(forces.damping).max())
    omega = 1e-6 / relaxation.times.max()
    z, _, _ = stiffness(element, ports, np.array([1j * omega]))
    expected = omega * forces.damping
    # What relaxes is a part omega theta of the damping.
    np.testing.assert_allclose(z[0].imag, expected, atol=2e-6 * np.abs(expected).max())
    np.testing.assert_allclose(z[0].real, forces.stiffness, atol=1e-6 * np.abs(expected).max())


def test_quick_motion_has_the_stiffness_of_locked_films():
    element, ports = CASES[0]
    z, _, _ = stiffness(element, ports, np.array([1e9j / element.relaxation(POSE, AT).times.min()]))
    at = law().at(element.entrainment_speed(AT), WARM)
    rollers = element.loads(ports, AT)
    table = at.memory.table
    total = np.zeros(2)
    for angle, row in zip(rollers.angle, rollers.load_per_length, strict=True):
        for load in row[row > 0.0]:
            # 1/k_s is the slope of what answers at once.
            step = 1e-4 * load
            stiff = 2.0 * step / (instant(table, load + step) - instant(table, load - step))
            total += stiff * BEARING.slice_length * np.array([math.cos(angle), math.sin(angle)]) ** 2
    # The table's cubics of the states and of a over the load differ by some 1e-4 in their slopes.
    assert np.diag(z[0].real)[1:3] == pytest.approx(total, rel=1e-3)


def instant(table, load):
    """Approach that answers at once [m]."""
    return approach_at(table, load)[0]


@pytest.mark.parametrize(("element", "ports"), CASES, ids=NAMES)
def test_energy_is_taken_up_at_every_frequency(element, ports):
    times = element.relaxation(ports, AT).times
    omega = np.geomspace(1e-3 / times.max(), 1e3 / times.min(), 200)
    z, forces, _ = stiffness(element, ports, 1j * omega)
    loss = z.imag / omega[:, None, None]
    # A hundred times the rounding of C, in which the dampers cancel.
    assert np.linalg.eigvalsh(loss).min() > -1e-14 * len(ports) * np.abs(forces.damping).max()
    # Stiffness rises with the frequency.
    rises = np.diff(z.real, axis=0)
    assert np.linalg.eigvalsh(rises).min() > -1e-12 * np.abs(z).max()


def test_what_does_not_relax():
    assert massless("slow").relaxation(POSE, AT) is None
    assert bodies("slow").relaxation(at_rest(bodies())[1], AT) is None
    dry = BearingElement("a", "shaft", "ground", BEARING, BearingForce(BEARING, hertz(BEARING)), WARM)
    assert dry.film_relaxation(POSE, AT) is None
    contacts = RollerContacts(BEARING, hertz(BEARING).single(), hertz(BEARING).single())
    assert RollerElement(massless("slow"), contacts, "rollers").film_relaxation(np.zeros(contacts.size), AT) is None
    assert massless("slow", centrifugal=True).relaxation(POSE, AT) is None


def test_memory_takes_no_centrifugal_load():
    with pytest.raises(InputError, match=r"bearing 'a', films: got 'memory' with centrifugal = true; allowed: films"):
        massless(centrifugal=True)


@pytest.mark.parametrize(("element", "ports"), CASES, ids=NAMES)
def test_few_states_act_like_all_slices(element, ports):
    all_slices = element.relaxation(ports, AT)
    few = film_states(all_slices)
    assert few.size < np.count_nonzero(np.any(all_slices.rows != 0.0, axis=1))
    assert few.relaxation.times.min() > 0.0
    assert few.relaxation.times.max() <= few.slowest * (1.0 + 1e-12)
    np.testing.assert_allclose(few.lift.T @ few.lift, np.eye(few.size), atol=1e-12)
    damping = all_slices.damping
    np.testing.assert_allclose(few.relaxation.damping, damping, atol=1e-12 * np.abs(damping).max())
    # Off the frequencies at which it was looked for; ten times is room for those in between.
    s = 1j * np.geomspace(1e-1 / few.slowest, 1e1 / few.relaxation.times.min(), 97)
    springs = np.abs(all_slices.rows.T @ all_slices.rows).max()
    more = all_slices.more(s)
    size = springs * np.maximum(np.abs(s) * few.slowest, 1.0)[:, None, None]
    assert np.max(np.abs(few.relaxation.more(s) - more) / size) < 10.0 * TOLERANCE


def test_shapes_and_derivatives_of_a_relaxation():
    relaxation = massless().relaxation(POSE, AT)
    s = np.array([2e3 + 9e3j, -3e3 + 2e4j])
    step = 1e-4 * s
    quotient = (relaxation.more(s + step) - relaxation.more(s - step)) / (2.0 * step)[:, None, None]
    # A central difference quotient of step 1e-4.
    np.testing.assert_allclose(relaxation.slope(s), quotient, atol=1e-7 * np.abs(quotient).max())
    shapes = np.arange(12.0).reshape(6, 2) + 1j
    expected = np.einsum("kab,bk->ak", relaxation.more(s), shapes)
    np.testing.assert_allclose(relaxation.more_of(s, shapes), expected, atol=1e-12 * np.abs(expected).max())
    transform = np.eye(6)[:, ::-1]
    seen = relaxation.seen_by(transform)
    np.testing.assert_allclose(seen.more(s), transform.T @ relaxation.more(s) @ transform)


def test_no_films_no_states():
    nothing = film_states(Relaxation(np.zeros((5, 6)), np.ones(5)))
    assert nothing.size == 0 and nothing.lift.shape == (5, 0)
    assert together([]) is None

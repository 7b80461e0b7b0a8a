"""What films with memory leave out, as a law reads it from the responses of a map."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.generate import generate_in_memory
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.kernels.film_response import FilmResponse, FilmsOfContact, by_powers, law_stiffness
from ehdmaps.maps.law import ContactLaw
from tests.cases.laws import CONTACTS, NU308, OIL, SMALL_FIELD
from tests.unit.test_locked_film import Remembering

FREQUENCIES = np.array([0.5, 1.0, 2.0, 4.0, 8.0])


def films(differences, passing=0.7e-4):
    """Two loads of a contact, T = 0.1 ms."""
    return FilmsOfContact(
        stiffness=np.array([1e9, 2e9]),
        damping=np.array([1e5, 1e4]),
        times=np.array([2e-5, 5e-6]),
        natural=np.full(2, 1e-4),
        passing=np.full(2, passing),
        frequencies=FREQUENCIES,
        differences=np.asarray(differences, dtype=np.complex128),
    )


def alone(contact):
    return FilmResponse(contact.stiffness, contact.damping, contact.times, (contact,))


def test_at_the_frequencies_of_a_map_it_is_what_the_map_holds():
    random = np.random.default_rng(2)
    differences = 0.03 * (random.normal(size=(2, 5)) + 1j * random.normal(size=(2, 5)))
    found = alone(films(differences)).correction(1j * FREQUENCIES / 1e-4)
    assert found == pytest.approx(1.0 / (1.0 + differences.T) - 1.0, rel=1e-12)
    # above the last one it is held
    assert alone(films(differences)).correction(np.array([3e6j]))[0] == pytest.approx(found[-1], rel=1e-12)


def test_a_law_that_leaves_nothing_out_has_no_correction():
    s = np.array([1e2j, 1e4j, 1e6j, -2e3 + 3e4j])
    assert alone(films(np.zeros((2, 5)))).correction(s) == pytest.approx(np.zeros((4, 2)), abs=1e-14)


def test_slow_motion_is_that_of_the_map():
    """The law has k and c of slow motion: what it leaves out begins with the square of the frequency."""
    response = alone(films(np.full((2, 5), 0.02 + 0.01j), passing=0.0))
    slow, slower = np.abs(response.correction(np.array([2e2j, 1e2j])))
    assert slow / slower == pytest.approx(4.0, rel=0.02)


def test_a_film_that_answers_late_is_read_between_the_frequencies():
    """r = e W^2 exp(-i W t/T)/(1 + W^2), which a spline of its parts would not follow from 2 to 4."""
    place = np.array([0.3, 0.7, 1.4, 2.8, 5.6])

    def late(places):
        return 0.02 * places**2 * np.exp(-0.9j * places) / (1.0 + places**2)

    contact = films(np.tile(late(FREQUENCIES), (2, 1)), passing=0.9e-4)
    s = 1j * place / 1e-4
    found = contact.compliance(s) * law_stiffness(contact.stiffness, contact.damping, contact.times, s) - 1.0
    assert found == pytest.approx(np.tile(late(place)[:, None], (1, 2)), abs=3e-4)


def test_two_contacts_have_times_of_their_own():
    """Exact sums of compliances: one relaxation time of both is another law."""
    quick = films(np.zeros((2, 5)))
    slow = dataclasses.replace(quick, times=10.0 * quick.times)
    k, c, times = quick.stiffness / 2.0, quick.damping / 2.0, 5.5 * quick.times
    s = np.array([2e4j])
    both = sum(1.0 / law_stiffness(one.stiffness, one.damping, one.times, s) for one in (quick, slow))
    found = FilmResponse(k, c, times, (quick, slow)).correction(s)
    assert found == pytest.approx(1.0 / both / law_stiffness(k, c, times, s) - 1.0, rel=1e-12)
    assert np.abs(found).max() > 1e-2


def test_doubt_rises_with_the_frequency():
    found = films(np.zeros((2, 5))).doubt(1j * np.geomspace(1e2, 1e7, 40))
    assert np.all(np.diff(found, axis=0) >= 0.0) and found[0].max() < 1e-4
    assert by_powers(np.array(0.0), np.array([1.0, 2.0]), np.array([1.0, 4.0])) == 0.0


@pytest.fixture(scope="module")
def emap():
    """NU308 whose films answer as a law with one relaxation time does."""
    job = Job.build(
        lubricant=OIL, bearing=NU308, loads=[2e3, 2e5], entrainment_speeds=[0.8, 1.6], temperatures=[313.15]
    )
    made = generate_in_memory(job, 1, solver=Remembering(factor=1.7))
    return EHDMap(made.dataset, made.backbone)


@pytest.mark.parametrize(("kind", "least", "most"), [("inner", 0.0, 2e-3), ("series", 1e-2, 4e-2)])
def test_films_of_one_relaxation_time_leave_nothing_out(emap, kind, least, most):
    """But for the doubt of the fitted factor; two contacts with times of their own leave some per cent."""
    loads = np.array([3e3, 2e4, 1.5e5])
    response = emap.law(kind).film_response(loads, -1.1, 313.15)
    size = np.abs(response.correction(2j * np.pi * np.array([300.0, 3000.0])))
    assert least <= size.max() < most
    # the law of slow motion, as its table has it
    at = emap.law(kind, "clamp").at(1.1, 313.15)
    approaches = np.linspace(-1e-5, 1e-5, 8000)
    found, k, c = at(approaches, np.zeros_like(approaches))
    assert response.stiffness == pytest.approx(np.interp(loads, found, k), rel=1e-3)
    assert response.damping == pytest.approx(np.interp(loads, found, c), rel=1e-2)


def test_a_law_without_responses_says_nothing():
    law = ContactLaw("series", CONTACTS, OIL, SMALL_FIELD, "clamp")
    assert law.film_response(np.array([1e4]), 1.2, 330.0) is None

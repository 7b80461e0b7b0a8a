"""A contact over frequency: what film and solids give together, and how errors are carried over."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import FilmSolution, FilmSpectrum, Status, contact_solution, no_spectrum, slow_spectrum
from ehdmaps.physics.spectrum import MOST_FREQUENCIES, checked_frequencies, contact_spectrum

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
POINT = OperatingPoint(5e4, 1.0, 313.15)
FILM = FilmSolution(
    Status.CONVERGED,
    film_offset=1e-6,
    film_compliance=3e-12,
    loss_compliance=2e-15,
    film_offset_error=1e-3,
    film_compliance_error=2e-3,
    loss_compliance_error=-1e-3,
)
FREQUENCIES = np.geomspace(1.0, 1e4, 9)
ROUND_OFF = 1e-12


def test_stiffness_and_damping_are_the_parts_of_the_dynamic_stiffness() -> None:
    found = contact_spectrum(slow_spectrum(FILM, FREQUENCIES), CONTACT, POINT)
    omega = 2.0 * np.pi * FREQUENCIES
    dry = CONTACT.structural_compliance(POINT.load)
    assert 1.0 / (found.stiffness + 1j * omega * found.damping) == pytest.approx(
        dry + FILM.film_compliance - 1j * omega * FILM.loss_compliance, rel=ROUND_OFF
    )
    assert found.film_stiffness * found.film_compliance == pytest.approx(np.ones(9), rel=ROUND_OFF)
    assert found.solution == contact_solution(FILM, CONTACT, POINT)


def test_at_low_frequency_errors_are_those_of_slow_motion() -> None:
    found = contact_spectrum(slow_spectrum(FILM, np.array([1e-2])), CONTACT, POINT)
    slow = contact_solution(FILM, CONTACT, POINT)
    at = found.at(0)
    assert at.stiffness == pytest.approx(slow.stiffness, rel=1e-9)  # (omega loss/s)^2
    assert at.damping == pytest.approx(slow.damping, rel=1e-9)
    assert at.film_compliance_error == pytest.approx(slow.film_compliance_error, rel=1e-6)
    assert at.damping_error == pytest.approx(slow.damping_error, rel=1e-6)
    assert at.stiffness_error == pytest.approx(
        1.05 * slow.stiffness_error, rel=1e-6
    )  # a twentieth in case of cancelling
    assert (at.film_offset, at.status) == (slow.film_offset, slow.status)


def test_errors_are_those_of_the_exact_change() -> None:
    """A small dS, carried over to first order, against K of S + dS."""
    changes = 1e-17 * np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 9))
    base = slow_spectrum(FILM, FREQUENCIES)
    found = contact_spectrum(FilmSpectrum(FILM, FREQUENCIES, base.compliance, changes[:, None]), CONTACT, POINT)
    moved = FilmSpectrum(FILM, FREQUENCIES, base.compliance + changes, base.errors)
    change = contact_spectrum(moved, CONTACT, POINT).dynamic_stiffness - found.dynamic_stiffness
    # first order: dS over 1/K is 1e-6; and the twentieth comes on top
    for error, part in (
        (found.stiffness_error * np.abs(found.stiffness), np.abs(change.real)),
        (found.damping_error * np.abs(found.dynamic_stiffness.imag), np.abs(change.imag)),
    ):
        assert np.all(error >= part * (1.0 - 1e-5))
        assert np.all(error <= 1.05 * part + 0.05 * np.abs(change) * math.sqrt(2.0))
    assert found.dynamic_stiffness_error * np.abs(found.dynamic_stiffness) == pytest.approx(np.abs(change), rel=1e-5)


def test_of_several_estimates_the_largest_counts() -> None:
    base = slow_spectrum(FILM, FREQUENCIES)
    many = np.stack([base.errors[:, 0], 3.0 * base.errors[:, 0], 0.0 * base.errors[:, 0]], axis=1)
    one = contact_spectrum(base, CONTACT, POINT)
    most = contact_spectrum(FilmSpectrum(FILM, FREQUENCIES, base.compliance, many), CONTACT, POINT)
    assert most.stiffness_error == pytest.approx(3.0 * one.stiffness_error, rel=ROUND_OFF)
    assert most.damping_error == pytest.approx(3.0 * one.damping_error, rel=ROUND_OFF)


def test_a_film_without_a_solution_has_no_numbers() -> None:
    found = contact_spectrum(no_spectrum(FilmSolution(Status.FAILED, "why"), FREQUENCIES), CONTACT, POINT)
    assert (found.solution.status, found.solution.reason) == (Status.FAILED, "why")
    assert np.isnan(found.stiffness).all()
    assert np.isnan(found.damping_error).all()


@pytest.mark.parametrize(
    ("frequencies", "message"),
    [
        ([], r"frequencies: got an array of shape \(0,\); allowed: 1 to 2000"),
        (np.ones((2, 2)), r"frequencies: got an array of shape \(2, 2\)"),
        (np.ones(MOST_FREQUENCIES + 1), r"got an array of shape \(2001,\)"),
        ([1.0, math.nan], "frequencies: got nan Hz; allowed: 0.001 to 1e"),
        ([0.0], "frequencies: got 0.0 Hz"),
        ([-1.0], "frequencies: got -1.0 Hz"),
        ([math.inf], "frequencies: got inf Hz"),
    ],
)
def test_frequencies_that_are_refused(frequencies, message) -> None:
    with pytest.raises(InputError, match=message):
        checked_frequencies(frequencies)


def test_one_frequency_is_a_list_of_one() -> None:
    assert checked_frequencies(5).tolist() == [5.0]

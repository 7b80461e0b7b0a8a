"""Many frequencies from one run: the same as one by one, and those of the Reynolds equation."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.ehl.start import reynolds_start
from ehdmaps.openfoam.solver import OpenFoamSolver
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.spectrum import contact_spectrum
from tests.cases import openfoam_runs
from tests.cases.openfoam_points import OIL, Place

pytestmark = pytest.mark.openfoam

PLACE = Place("NU308", 0, 8.857e4, 1.7, 40.0)
"""M = 4.6, L = 20, with a pressure spike and a band of negative damping."""


def _frequencies(omegas: np.ndarray) -> np.ndarray:
    contact = PLACE.contact
    half = float(half_width(PLACE.load, contact.radius, contact.reduced_modulus))
    return omegas * PLACE.speed / (2.0 * math.pi * half)


def test_one_krylov_space_gives_what_each_frequency_gives_alone() -> None:
    settings = replace(openfoam_runs.parameters(5.0, 8.0, 120, 8), frequencies=(0.0, 1e3, 1e4, 3e4))
    together = openfoam_runs.run(settings).results
    for index, frequency in enumerate(settings.frequencies):
        alone = openfoam_runs.run(replace(settings, frequencies=(frequency,))).results
        # each space ends where its largest residual is 1e-8
        assert together.film_compliance[index] == pytest.approx(alone.film_compliance[0], rel=1e-6)
        assert together.loss_compliance[index] == pytest.approx(alone.loss_compliance[0], rel=1e-6)


def test_response_over_frequency_against_the_reynolds_equation() -> None:
    frequencies = _frequencies(np.array([0.01, 1.0, 5.0]))
    point = OperatingPoint(PLACE.load, PLACE.speed, PLACE.celsius + 273.15)
    film = OpenFoamSolver(starter=reynolds_start).film_spectrum(PLACE.contact, OIL, point, frequencies)
    cfd = contact_spectrum(film, PLACE.contact, point)
    plain = contact_spectrum(
        ReynoldsSolver().film_spectrum(PLACE.contact, OIL, point, frequencies), PLACE.contact, point
    )
    apart = np.abs(cfd.dynamic_stiffness / plain.dynamic_stiffness - 1.0)
    assert np.all(apart < 5e-4)  # grid errors of both, 1e-4 each by their estimates
    film_apart = np.abs(cfd.film_compliance / plain.film_compliance - 1.0)
    assert np.all(film_apart < 0.02)
    # what both programs state of themselves explains the difference, but for a factor of two
    assert np.all(film_apart < 2.0 * (cfd.film_compliance_error + plain.film_compliance_error))
    # and the response does change over these frequencies
    assert np.min(cfd.damping) < 0.0 < np.max(cfd.damping)
    assert cfd.damping[0] == pytest.approx(cfd.solution.damping, rel=1e-2)

"""A film does not depend on what it was started from, nor its stiffness on how it was linearised."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ehdmaps.openfoam.parameters import Flow
from ehdmaps.openfoam.results import Results
from tests.cases import openfoam_runs

pytestmark = pytest.mark.openfoam


def _numbers(results: Results) -> list[float]:
    return [
        results.central_film,
        results.minimum_film,
        results.film_offset,
        results.film_compliance[0],
        results.loss_compliance[0],
    ]


@pytest.mark.parametrize(("M", "L", "flow"), [
    (0.3, 12.0, "thin_film"), (5.0, 5.0, "full_stress"), (100.0, 2.0, "thin_film"),
])  # fmt: skip
def test_start_from_hertz(M: float, L: float, flow: Flow) -> None:
    """On the same mesh as from the Reynolds solution: a start only, no part of the equations."""
    warm, cold = (openfoam_runs.results(M, L, 400, 6, flow, hertz=hertz) for hertz in (False, True))
    # what Newton's method leaves after a last step of 1e-9, in a derivative that is a difference of large numbers
    assert _numbers(cold) == pytest.approx(_numbers(warm), rel=1e-6)


@pytest.mark.parametrize(("M", "L", "flow"), [
    (5.0, 5.0, "thin_film"), (5.0, 0.0, "thin_film"), (5.0, 5.0, "full_stress"),
])  # fmt: skip
def test_compliance_is_the_derivative_of_the_film_offset(M: float, L: float, flow: Flow) -> None:
    """Against solves at two loads, whose meshes grow with the Hertz width.

    Offsets are those over the dry contact of the same operator on the same mesh, so that meshes of different size may
    be compared.
    """
    settings = openfoam_runs.parameters(M, L, 400 if flow == "thin_film" else 200, 8, flow=flow)
    step = 1e-3
    above, below = (
        openfoam_runs.run(replace(settings, load=settings.load * (1.0 + side * step))).results.film_offset
        for side in (1.0, -1.0)
    )
    slope = (above - below) / (2.0 * step * settings.load)
    compliance = openfoam_runs.run(settings).results.film_compliance[0]
    # discretisation: the columns of the linear response stand, those of the two solves grow; the place of the film's
    # rupture among the columns is worth 1 % of the film compliance. The quotient itself is good to step^2.
    assert compliance == pytest.approx(-slope, rel=1e-2)

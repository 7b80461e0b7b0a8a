"""What a converged film conserves: mass along it, mass of every cell, and the load."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ehdmaps.openfoam.parameters import Flow
from ehdmaps.openfoam.run import RunError
from ehdmaps.physics.solution import Status
from tests.cases import openfoam_runs

pytestmark = pytest.mark.openfoam

POINTS = {"light and fast": (0.3, 12.0), "heavy and slow": (200.0, 4.0), "hot": (20.0, 5.0)}


@pytest.mark.parametrize("flow", ["thin_film", "full_stress"])
@pytest.mark.parametrize("point", POINTS)
def test_balances(point: str, flow: Flow) -> None:
    solution = openfoam_runs.run(openfoam_runs.parameters(*POINTS[point], columns=200, flow=flow))
    results, film = solution.results, solution.film
    assert results.status is Status.CONVERGED
    full = np.flatnonzero(film.liquid_fraction < 1.0)[0]
    assert 0 < full < film.x.size
    # what Newton's method leaves after a last step of 1e-9 of the unknowns
    assert np.ptp(film.flux[:full]) < 1e-8 * film.flux[0]
    assert results.flux_defect < 1e-8
    assert results.load_defect < 1e-8
    # the cavitated part is reported apart; its columns are equations like the others
    assert results.outlet_defect < 1e-8
    if flow == "full_stress":
        # of the film's mass flux: the same remainder, cell by cell
        assert results.cell_continuity < 1e-6


def test_a_pivot_of_zero_is_a_status(monkeypatch: pytest.MonkeyPatch) -> None:
    """A load whose numbers vanish makes the matrix singular: no crash, though OpenFOAM traps divisions by zero."""
    monkeypatch.setenv("FOAM_SIGFPE", "true")
    settings = openfoam_runs.parameters(5.0, 5.0, 60, 4, hertz=True)
    with pytest.raises(RunError, match="Newton's step has no finite length") as caught:
        openfoam_runs.run(replace(settings, load=1e-200 * settings.load))
    assert caught.value.status is Status.DIVERGED

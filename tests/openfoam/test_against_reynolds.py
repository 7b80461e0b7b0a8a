"""The CFD of the film against the Reynolds equation: two discretisations of one contact, each its own.

Bars, on 400 x 6 cells: films 0.1 % (0.2 % with all stresses), film compliance 5 % or 0.2 % of the whole contact's,
c 3 %. They bound the grid error of the CFD along the film; the film compliance is a small difference where the load is
high, and c inherits twice its error. The thin-film flow and the Reynolds equation are the same equation, so nothing
else is left; with all stresses, what is neglected is below 0.2 % at these points.
"""

import pytest

from ehdmaps.physics.solution import Status
from tests.cases.openfoam_points import PLACES, SPIKED, Place, agrees, compare

pytestmark = pytest.mark.openfoam


STRESSED = tuple(PLACES[index] for index in (7, 17))
"""The lightest, slowest and coldest place, and the fastest, heavy and hot: each bearing and each contact once."""

THIN = tuple(PLACES[index] for index in (2, 6, 11, 16, 19, 21))
"""Both bearings and contacts, with the heaviest, fastest, coldest and hottest places, and light and slow ones.

`python -m tests.benchmarks.bench_openfoam` compares all places in both ways.
"""


@pytest.mark.parametrize("place", THIN, ids=str)
def test_thin_film(place: Place) -> None:
    """The two agree."""
    found = compare(place, "thin_film")
    assert found.cfd.status is Status.CONVERGED, found.cfd.reason
    assert not agrees(found), found.row()


HEAVY = (
    Place("NU308", 0, 1e6, 0.05, 70.0),
    Place("NU308", 0, 1e6, 0.05, 120.0),
    Place("NU308", 0, 1e6, 0.4, 70.0),
    Place("NU308", 0, 1e6, 10.0, 120.0),
)
"""The heaviest load of a wide map, 2.6 GPa: films of 5 to 200 nm, with spikes a few columns wide before the exit."""


@pytest.mark.parametrize("place", HEAVY, ids=str)
def test_the_heaviest_films(place: Place) -> None:
    """A start whose spike stands between other columns, and columns that run empty on the way, lose no point.

    With the errors taken off that both programs state, which are signed, no more is left than they are.
    """
    found = compare(place, "thin_film")
    assert found.cfd.status is Status.CONVERGED, found.cfd.reason
    for name in ("film_offset", "film_compliance", "loss_compliance"):
        errors = [getattr(film, f"{name}_error") for film in (found.cfd, found.reynolds)]
        left = found.difference(name) - errors[0] + errors[1]
        assert abs(left) < sum(map(abs, errors)), (name, left, errors)


@pytest.mark.slow
@pytest.mark.parametrize("place", STRESSED, ids=str)
def test_full_stress(place: Place) -> None:
    """The two agree with all stresses too."""
    found = compare(place, "full_stress")
    assert found.cfd.status is Status.CONVERGED, found.cfd.reason
    assert not agrees(found), found.row()


@pytest.mark.slow
def test_error_estimates_explain_the_film() -> None:
    """What both programs say of their own grids is what they differ by."""
    for place in THIN:
        found = compare(place, "thin_film")
        stated = found.cfd.central_film_error + found.reynolds.central_film_error
        assert abs(found.difference("central_film")) < stated, found.row()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["film_compliance", "loss_compliance"])
def test_error_estimates_explain_the_responses(name: str) -> None:
    """At nine of ten places: two grids do not tell the error where their difference happens to change its sign."""
    found = [compare(place, "thin_film") for place in PLACES[::2]]
    others = [one.row() for one in found if not one.explained(name)]
    assert len(others) <= 0.1 * len(found), others


def test_the_newtonian_law_is_flagged_at_a_steep_spike() -> None:
    """Both thin films say that no oil is Newtonian there, and so does the reason why all stresses have no solution."""
    thin, full = compare(SPIKED[0], "thin_film"), compare(SPIKED[0], "full_stress", 200)
    assert not agrees(thin), thin.row()
    assert all("no oil is Newtonian there" in film.reason for film in (thin.cfd, thin.reynolds, full.cfd))
    assert full.cfd.status is Status.OUTSIDE_VALIDITY

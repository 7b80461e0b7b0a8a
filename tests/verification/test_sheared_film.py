"""Films of oils that are not Newtonian: against closed forms, other solutions, and at the ends of their range."""

from __future__ import annotations

import math
from collections import defaultdict
from functools import cache

import numpy as np
import pytest

from ehdmaps.ehl.column import sheared_column
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import InputError
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.rheology import CARREAU, EYRING, LIMITING, ShearLaw, eyring_stress, traction_coefficients
from ehdmaps.physics.solution import FilmSolution, Status, contact_solution
from tests.cases.laws import CONTACTS, OIL

NU308_INNER = CONTACTS[0]


def film(load: float, speed: float, celsius: float, solver: ReynoldsSolver) -> FilmSolution:
    """Film of the inner contact of NU308."""
    return solver.solve_line(NU308_INNER, OIL, (load,), speed, celsius + 273.15)[0]


@pytest.mark.parametrize("q", [0.03, 1.0, 6.0])
def test_eyring_column(q: float) -> None:
    """Pure rolling has mobility 3 (q cosh q - sinh q)/q^3, sliding the mean stress asinh(e q/sinh q): quadrature."""
    law = ShearLaw(EYRING, 1.0)
    rolling = sheared_column(law, 1.0, 2.0 * q, 0.0, 0.0)
    assert rolling.mobility == pytest.approx(3.0 * (q * math.cosh(q) - math.sinh(q)) / q**3, rel=1e-11)
    for sliding in (1e-3, 1.0, 1e5):
        wanted = math.asinh(sliding * q / math.sinh(q))
        assert sheared_column(law, 1.0, 2.0 * q, -sliding, -0.1).mean_stress == pytest.approx(-wanted, rel=1e-9)


@pytest.mark.parametrize("law", [ShearLaw(EYRING, 1.0), ShearLaw(CARREAU, 1.0, 0.0, 0.5), ShearLaw(LIMITING, 1.0, 0.5)])
@pytest.mark.parametrize(("pressure", "rise", "sliding"), [(1.0, 2.0, 3.0), (0.5, -3.0, 1e3), (2.0, 0.7, -0.2)])
def test_tangents_of_a_column(law: ShearLaw, pressure: float, rise: float, sliding: float) -> None:
    """Derivatives of both factors against central differences, which err by the square of their step."""
    at = np.array([rise, sliding, pressure])
    found = sheared_column(law, pressure, rise, sliding, 0.1)
    for place, step in enumerate(1e-5 * np.maximum(1.0, np.abs(at))):
        ends = []
        for sign in (1.0, -1.0):
            moved = at.copy()
            moved[place] += sign * step
            ends.append(sheared_column(law, moved[2], moved[0], moved[1], 0.1))
        for value, slope in ((0, 1 + place), (4, 5 + place)):
            quotient = (ends[0][value] - ends[1][value]) / (2.0 * step)
            assert found[slope] == pytest.approx(quotient, rel=1e-5, abs=1e-6 * abs(found[value]))


def test_strong_oil_is_newtonian() -> None:
    """An Eyring stress of 10 GPa changes the flow by its square, which the front of the spike alone feels."""
    strong = film(5e4, 2.0, 60.0, ReynoldsSolver(shear="eyring", shear_stress=1e10, slide_to_roll=0.1))
    plain = film(5e4, 2.0, 60.0, ReynoldsSolver())
    for name in ("film_offset", "central_film", "film_compliance", "loss_compliance"):
        assert getattr(strong, name) == pytest.approx(getattr(plain, name), rel=1e-6)
    # sinh(t)/t = 1 + t^2/6: at the front of the spike the stress is a tenth of Eyring's
    eased = (strong.wall_stress / 1e10) ** 2 / 6.0
    assert strong.max_pressure == pytest.approx(plain.max_pressure, rel=eased)


@pytest.mark.parametrize("shear", ["eyring", "limiting"])
def test_film_compliance_is_the_slope_of_the_film(shear: str) -> None:
    """Against the difference quotient over 2 % of the load: both carry the error of the grid, 1 % here."""
    solver = ReynoldsSolver(shear=shear)
    films = [film(5e4 * factor, 2.0, 60.0, solver) for factor in (0.99, 1.0, 1.01)]
    quotient = (films[0].film_offset - films[2].film_offset) / 1e3
    assert films[1].film_compliance == pytest.approx(quotient, rel=0.01)


def test_traction_of_eyring() -> None:
    """Against the closed form of the mean stress on the same film.

    Both sum a stress that rises tenfold within the width of few cells, one between nodes and the other at them: they
    err to opposite sides by the square of the cells, 0.2 and 0.4 % on this grid.
    """
    point, slip = OperatingPoint(5e4, 2.0, 333.15), 0.01
    solved, profile = ReynoldsSolver(13.0, shear="eyring", slide_to_roll=slip).film_profile(NU308_INNER, OIL, point)
    assert profile is not None
    slips = np.array([slip])
    closed = traction_coefficients(profile, OIL.at(333.15), point.load, 2.0, slips, eyring_stress(6e6))
    assert solved.traction / point.load == pytest.approx(closed[0], rel=1e-2)
    assert solved.wall_stress < 0.1 * solved.max_pressure
    back = film(5e4, 2.0, 60.0, ReynoldsSolver(13.0, shear="eyring", slide_to_roll=-slip))
    assert back.traction == pytest.approx(-solved.traction, rel=1e-6)
    assert film(5e4, 2.0, 60.0, ReynoldsSolver(shear="eyring")).traction == 0.0


def test_valley_is_no_property_of_real_oils() -> None:
    """21 N/mm, 4.125 m/s, 40 degC: damping -4.7e3 N s/m2 if Newtonian, +4.5e3 with 6 MPa (a prototype, to a tenth)."""
    damping = []
    for shear in ("newtonian", "eyring"):
        found = film(2.1e4, 4.125, 40.0, ReynoldsSolver(shear=shear))
        damping.append(contact_solution(found, NU308_INNER, OperatingPoint(2.1e4, 4.125, 313.15)).damping)
    assert damping[0] == pytest.approx(-4.7e3, rel=0.1)
    assert damping[1] == pytest.approx(4.5e3, rel=0.1)


@pytest.mark.parametrize("shear", ["eyring", "carreau", "limiting"])
def test_any_point_has_an_answer(shear: str) -> None:
    """A status for whatever is asked, and a film that is finite and positive where it is usable."""
    solver = ReynoldsSolver(shear=shear, slide_to_roll=-2.0)
    for load, speed, celsius in ((5e4, 0.0, 60.0), (5e4, 1e-3, 150.0), (1e-3, 20.0, -10.0), (2e6, 20.0, 150.0)):
        found = film(load, speed, celsius, solver)
        assert found.status.usable == math.isfinite(found.film_offset), found
        assert not found.status.usable or (found.film_offset >= 0.0 and found.wall_stress >= 0.0)
        assert found.status is not Status.FAILED


LIMITED = (
    (36400.0, 7.71, 66.8, 0.0),
    (28500.0, 0.793, 44.1, 0.272),
    (14200.0, 0.32, 26.9, 0.128),
    (18100.0, 1.32, 49.2, 0.067),
    (26200.0, 6.54, 71.8, 0.125),
    (215000.0, 0.664, 79.1, 0.0),
    (237000.0, 0.601, 85.6, 0.0),
    (123000.0, 0.358, 70.0, 0.055),
    (203000.0, 1.09, 89.7, 0.22),
)
"""Loads [N/m], speeds [m/s], temperatures [degC] and slide-to-roll ratios of films with a limiting stress.

The first five were drawn with M = 1 to 3, L = 15 to 25, where the response hangs on the ends of the part that yields;
the others with M = 20 to 80, L = 4 to 9, thin films without cells for a spike."""


@pytest.mark.slow
@pytest.mark.parametrize("name", ["stiffness", "damping", "film_offset", "central_film", "minimum_film"])
def test_errors_with_a_limiting_stress_and_their_estimates(name: str) -> None:
    """What is stated bounds what is wrong on grids whose nodes lie by chance at what is not smooth.

    References have four times the cells.
    """
    held = [stated >= wrong for stated, wrong in _limited_errors()[name]]
    # an estimate that bounds 95 % of all films bounds at least 46 of 54 drawn ones with 99.9 % probability
    assert len(held) == 54 and sum(held) >= 46, sum(held)


PLUGS = ((330e3, 0.55, 76.0, 0.25), (310e3, 0.3, 68.0, 0.28), (380e3, 0.6, 79.0, 0.2))
"""The same of thin films that slide as a plug, without cells for a spike; M = 60 to 80, L = 8 to 9."""


@pytest.mark.slow
def test_errors_of_films_that_slide_as_a_plug() -> None:
    """The film offset is of lower order where oil begins to yield between two nodes: six random grids at each place."""
    densities = np.random.default_rng(5).uniform(6.0, 7.0, 6)
    parts = []
    for load, speed, celsius, slip in PLUGS:
        exact, *found = (
            film(load, speed, celsius, ReynoldsSolver(density=density, shear="limiting", slide_to_roll=slip))
            for density in (26.0, *densities.tolist())
        )
        parts += [abs(one.film_offset / exact.film_offset - 1.0) / abs(one.film_offset_error) for one in found]
    # an estimate that bounds 95 % of all films bounds at least 15 of 18 with 98.9 % probability; of order four, seven
    assert np.count_nonzero(np.array(parts) <= 1.0) >= 15 and np.median(parts) > 0.1, parts


@cache
def _limited_errors() -> dict[str, list[tuple[float, float]]]:
    """Stated and true relative errors by name, each place on six grids of random density."""
    densities = np.random.default_rng(4).uniform(6.0, 7.0, 6)
    errors: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for load, speed, celsius, slip in LIMITED:
        point = OperatingPoint(load, speed, celsius + 273.15)
        exact, *found = (
            contact_solution(
                film(
                    load, speed, celsius, ReynoldsSolver(density=float(density), shear="limiting", slide_to_roll=slip)
                ),
                NU308_INNER,
                point,
            )
            for density in (26.0, *densities)
        )
        for each in found:
            for name in ("stiffness", "damping", "film_offset", "central_film", "minimum_film"):
                wrong = abs(getattr(each, name) / getattr(exact, name) - 1.0)
                errors[name].append((getattr(each, f"{name}_error"), wrong))
    return errors


def test_settings_name_what_changes_the_numbers() -> None:
    """Nothing where the film is Newtonian; the numbers of the law, chosen or not, where it is not."""
    assert ReynoldsSolver().settings() == ReynoldsSolver(shear="newtonian").settings()
    settings = ReynoldsSolver(shear="limiting", limiting_ratio=0.04, slide_to_roll=0.1).settings()
    chosen = {key: settings[key] for key in ("shear", "shear_stress", "limiting_ratio", "slide_to_roll")}
    assert chosen == {"shear": "limiting", "shear_stress": 2e6, "limiting_ratio": 0.04, "slide_to_roll": 0.1}
    with pytest.raises(InputError, match="allowed: newtonian, eyring, carreau, limiting"):
        ReynoldsSolver(shear="bingham")
    with pytest.raises(InputError, match=r"limiting_ratio: got 0\.1 with shear eyring"):
        ReynoldsSolver(shear="eyring", limiting_ratio=0.1)


@pytest.mark.parametrize(("load", "speed"), [(35e3, 4.0), (74e3, 4.0), (46220.0, 1.7748), (38565.0, 0.74995)])
def test_cold_loaded_films_with_a_limiting_stress(load: float, speed: float) -> None:
    """Fronts that yield over some cells: Newton overshoots, or its front stands between two cells of a grid.

    The wall stress is below that of the law; 2e-3 bounds the change of the film by cells 1.3 times as dense.
    """
    films = []
    for density in (6.5, 8.5):
        solver = ReynoldsSolver(shear="limiting", density=density)
        films += solver.solve_line(CONTACTS[0], OIL, (load,), speed, 313.15)
    assert [film.status for film in films] == [Status.CONVERGED] * 2
    assert films[0].central_film == pytest.approx(films[1].central_film, rel=2e-3)
    for film in films:
        assert film.wall_stress < 2e6 + 0.05 * film.max_pressure

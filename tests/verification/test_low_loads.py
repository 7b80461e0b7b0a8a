"""Laws below the lowest load of their map: fresh solves there, and what a law says where it does not know."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.jobs.make.generate import generate_in_memory
from ehdmaps.jobs.reader import parse_job
from ehdmaps.jobs.show.describe import describe
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.film_field import RIGID, known_from, load_at
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.solution import Status
from tests.cases.laws import CONTACTS, OIL, dataset_of

SPEED, KELVIN = 1.0, 313.15


@cache
def _map(lowest: int, backbone: str = "law") -> EHDMap:
    """Map of the inner contact of NU308 at one speed and temperature: its backbone is one line."""
    text = f"""
schema = 1
[contact]
radius = "{CONTACTS[0].radius * 1e3!r} mm"
roller_length = "15 mm"
[lubricant]
name = "FVA3"
[grid]
load = ["{lowest} N/mm", "{4 * lowest} N/mm", "400 N/mm"]
entrainment_speed = ["1 m/s"]
temperature = ["40 degC"]
[solver]
name = "reynolds"
structural_law = "iso16281"
backbone = "{backbone}"
films = "solved"
"""
    generated = generate_in_memory(parse_job(text, "low", "low"), workers=1)
    return EHDMap(generated.dataset, generated.backbone)


def _ratios(law: ContactLaw, loads: tuple[float, ...]) -> np.ndarray:
    """Load, stiffness and damping of a law over those of fresh solves at equal approach, (3, n)."""
    (contact,) = law.contacts
    films = ReynoldsSolver().solve_line(contact, OIL, loads, SPEED, KELVIN)
    solids = np.array([contact.structural_compliance(w) for w in loads])
    approach = np.array([contact.structural_approach(w) for w in loads]) - [film.film_offset for film in films]
    k = 1.0 / (solids + [film.film_compliance for film in films])
    c = k**2 * [film.loss_compliance for film in films]
    return np.stack(law(approach, 0.0, SPEED, KELVIN)) / [loads, k, c]


@pytest.mark.parametrize("lowest", [10, 50])
def test_a_law_is_right_below_the_lowest_load_of_its_map(lowest: int) -> None:
    """1 %: 0.3 % of the tail at its beginning, interpolation, and two solves' grid errors.

    By the tail from the lowest load they would be 0.16 and 1.2 (w), 0.16 and 1.2 (k), 0.06 and 0.02 (c) at 0.1 N/mm.
    """
    law = _map(lowest).law("line")
    loads = tuple(1e3 * w for w in (0.1, 0.15, 0.2, 0.3, 0.5, 1.0, 2.0, 4.0, 7.0, 9.9, 25.0, 49.0) if w < lowest)
    assert _ratios(law, loads) == pytest.approx(1.0, abs=0.01)
    assert law.low_loads is not None
    assert law.low_loads.guessed == 0.0
    assert law.low_loads.begins[0] == pytest.approx(load_at(law.contacts[0], OIL, RIGID, SPEED, KELVIN))
    assert law.excursions == ()
    assert law.guessed_below(SPEED, KELVIN) == 0.0


@pytest.mark.parametrize("lowest", [10, 50])
def test_rolling_is_right_below_the_lowest_load(lowest: int) -> None:
    """1e-3: interpolation over zeta, and the way to the rigid film from `RIGID` on."""
    emap = _map(lowest)
    assert emap.rolling_film is not None
    loads = (30.0, 100.0, 300.0, 1e3, 3e3, 9e3)
    films = ReynoldsSolver().solve_line(emap.contacts[0], OIL, loads, SPEED, KELVIN)
    for load, film in zip(loads, films, strict=True):
        force, flow = (
            f("line", load, SPEED, KELVIN) for f in (emap.rolling_film.rolling_force, emap.rolling_film.mass_flow)
        )
        assert force == pytest.approx(film.rolling_force, rel=1e-3)
        assert flow == pytest.approx(film.mass_flow, rel=1e-3)


def test_factors_of_the_locked_film_reach_below_the_map() -> None:
    factors = _map(50).law("line").locked_factors(SPEED, KELVIN)
    first = load_at(_map(50).contacts[0], OIL, RIGID, SPEED, KELVIN)
    assert np.exp(factors.lowest) == pytest.approx(first)


def test_a_law_says_where_it_guesses() -> None:
    """Without a backbone it begins at the lowest load; what it then met is told, and is no error."""
    emap = _map(10, "none")
    law = emap.law("line")
    assert law.low_loads is not None
    assert law.low_loads.guessed == 1.0
    assert law.guessed_below(SPEED, KELVIN) == 1e4
    words = "films are known down to 10 N/mm; below that they are continued as those of a rigid contact, a guess"
    assert law.low_loads.text.startswith(words)
    assert words in describe(emap, "low.nc")
    loads = np.array([1e3, 5e3])
    assert np.max(np.abs(_ratios(law, tuple(loads)) - 1.0)) > 0.5  # a guess indeed
    (told,) = law.excursions
    assert (told.axis, told.side, told.calls, told.limit) == ("load", "below", 2, 1e4)
    assert "below the map, which begins at 10000 N/m" in told.text
    assert not any(law.outside_counts.values())
    law.reset_counts()
    law.at(SPEED, KELVIN)(-1.0, 0.0)  # no load at all
    assert law.excursions == ()


def _without(emap: EHDMap, places: slice | int) -> EHDMap:
    """The same map with some points of its line unsolved."""
    assert emap.backbone is not None
    group = emap.backbone.copy(deep=True)
    group["status"].values[places] = int(Status.STAGNATED)
    for name, values in group.data_vars.items():
        if name != "status":
            values.values[places] = np.nan
    return EHDMap(emap.dataset, group)


def test_one_unsolved_point_of_a_line_is_bridged_and_told() -> None:
    """0.2 % of w and k, 3 % of c: a cubic over twice the step, in the middle of the valley."""
    whole, emap = _map(50), _without(_map(50), 40)
    loads = tuple(np.geomspace(200.0, 4e4, 15))
    ratios = _ratios(emap.law("line"), loads) / _ratios(whole.law("line"), loads)
    assert ratios[:2] == pytest.approx(1.0, abs=2e-3)
    assert ratios[2] == pytest.approx(1.0, abs=0.03)
    assert "1 of them without a solution: single ones are bridged" in describe(emap, "low.nc")
    assert "without a solution: single" not in describe(whole, "low.nc")


def test_where_the_lowest_points_are_unsolved_the_film_is_a_guess() -> None:
    """The law begins where the line does: right from there on, and told below."""
    emap = _without(_map(50), slice(0, 8))
    law = emap.law("line")
    assert law.low_loads is not None and law.low_loads.guessed == 1.0
    first = law.guessed_below(SPEED, KELVIN)
    assert first < 5e4
    assert _ratios(law, (1.05 * first, 3e4)) == pytest.approx(1.0, abs=0.01)
    assert law.excursions == ()
    law(-3e-6, 0.0, SPEED, KELVIN)
    assert [(one.axis, one.side) for one in law.excursions] == [("load", "below")]


def test_where_a_backbone_begins() -> None:
    zeta = np.array([-5.0, -4.5, -4.0, -3.5, -3.0])
    solved = np.ones((5, 2, 1), bool)
    assert known_from(zeta, solved) == RIGID
    solved[:3, 1, 0] = False
    assert known_from(zeta, solved) == -3.5


def test_a_map_without_films_guesses_nothing() -> None:
    dry = dataset_of(loads=(1e3, 1e4), speeds=(0.0,), temperatures=(313.15,))
    assert EHDMap(dry).low_loads is None

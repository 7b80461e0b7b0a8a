"""Pressures and films of the contacts of a roller: dry, by formula, and read from a map."""

from __future__ import annotations

import numpy as np
import pytest

from ehdmaps.errors import MapError
from ehdmaps.jobs import cli, solvers
from ehdmaps.jobs.reader import read_job
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import tip_words
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.contact_report import BearingContacts, spike_tip
from mbs.bearings.films import ContactState, DryContacts, FormulaFilms, MapFilms, error_of_smallest

ROUND_OFF = 1e-12
OIL = Lubricant.named("FVA3")
CONTACTS = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")

# Steps of the axes as those of the shipped jobs, over a window of their range.
JOB = """
schema = 1
{problem}
[lubricant]
name = "FVA3"
[grid]
load = {{ from = "46.4159 N/mm", to = "215.4435 N/mm", points = 5, spacing = "log" }}
entrainment_speed = {{ from = "1.31 m/s", to = "3.4284 m/s", points = 3, spacing = "log" }}
temperature = {temperatures}
[solver]
name = "{solver}"
structural_law = "iso16281"
{more}
"""


def a_map(folder, solver, problem='[bearing]\nname = "NU308"', temperatures='["40 degC", "60 degC"]'):
    more = 'backbone = "none"\nfilms = "solved"' if solver == "reynolds" else ""
    (folder / "job.toml").write_text(JOB.format(solver=solver, problem=problem, more=more, temperatures=temperatures))
    path = str(folder / "map.nc")
    assert cli.main(["generate", str(folder / "job.toml"), "-o", path, "--workers", "1"]) == 0
    return open_map(path)


def test_dry_contacts_have_the_pressure_of_hertz_and_no_film():
    load = np.array([0.0, 88571.4])
    state = DryContacts(CONTACTS).state(0, load, 1.0, 313.15)
    # Johnson, Contact Mechanics: p = sqrt(w E'/(2 pi R)); 768.0 MPa for R = 5.5152 mm
    np.testing.assert_allclose(state.hertz_pressure, [0.0, 768.0e6], rtol=1e-4)  # digits of the reference
    assert np.all(np.isnan(state.central_film)) and np.all(np.isnan(state.minimum_film))


@pytest.mark.parametrize("speed", [0.0, 0.05, 3.0])
@pytest.mark.parametrize("side", [0, 1])
def test_films_by_formula_are_those_of_the_solver_formula(side, speed):
    loads = np.geomspace(1e2, 1e6, 9)
    state = FormulaFilms(CONTACTS, OIL).state(side, loads, speed, 330.0)
    films = FormulaSolver().solve_line(CONTACTS[side], OIL, tuple(loads), speed, 330.0)
    for name in ("max_pressure", "central_film", "minimum_film"):
        np.testing.assert_allclose(getattr(state, name), [getattr(film, name) for film in films], rtol=ROUND_OFF)
    assert np.isnan(FormulaFilms(CONTACTS, OIL).state(side, np.zeros(1), speed, 330.0).central_film[0])


def test_a_map_of_the_formula_gives_the_formula_everywhere(tmp_path):
    films = MapFilms(a_map(tmp_path, "formula"))
    loads = np.array([0.0, 1e3, 50e3, 77e3, 500e3])  # the second and the last outside the map
    for speed, kelvin in ((1.0, 313.15), (2.0, 320.0), (9.0, 333.15)):
        got, wanted = (source.state(1, loads, speed, kelvin) for source in (films, FormulaFilms(CONTACTS, OIL)))
        np.testing.assert_allclose(got.central_film, wanted.central_film, rtol=1e-9)  # digits of the file's contacts
        np.testing.assert_allclose(got.max_pressure, wanted.max_pressure, rtol=1e-9)
    # Colder than the map: its edge.
    got, wanted = films.state(0, loads, 2.0, 250.0), FormulaFilms(CONTACTS, OIL).state(0, loads, 2.0, 313.15)
    np.testing.assert_allclose(got.central_film, wanted.central_film, rtol=1e-9)
    at_rest = films.state(0, loads, 0.0, 313.15)
    np.testing.assert_array_equal(at_rest.central_film[1:], 0.0)


def test_films_between_the_points_of_a_map_against_fresh_solutions(tmp_path):
    emap = a_map(tmp_path, "reynolds")
    films, solver = MapFilms(emap), solvers.build("reynolds", {})
    rng = np.random.default_rng(7)
    errors = []
    for index in range(24):
        load = float(np.exp(rng.uniform(np.log(50e3), np.log(200e3))))
        speed, kelvin = float(np.exp(rng.uniform(np.log(1.31), np.log(3.42)))), float(rng.uniform(313.15, 333.15))
        side = index % 2
        (fresh,) = solver.solve_line(emap.contacts[side], emap.lubricant, (load,), speed, kelvin)
        read = films.state(side, np.array([load]), speed, kelvin)
        errors.append(
            [
                getattr(read, name)[0] / getattr(fresh, name) - 1.0
                for name in ("central_film", "minimum_film", "max_pressure")
            ]
        )
    worst = np.max(np.abs(errors), axis=0)
    # Interpolation; over the whole shipped map of NU308 150 points were within 1.0 %, 0.5 % and 23 %. The pressure is
    # that of the spike, which the grid of the solver does not resolve.
    assert np.all(worst < [0.012, 0.006, 0.30]), worst
    assert worst[0] > 0.0


def test_stated_errors_are_those_of_the_map(tmp_path):
    """At a point of the map its own; by a formula there is no spike, and an older map states nothing."""
    emap = a_map(tmp_path, "reynolds")
    data = emap.dataset.isel(contact=1, load=1, entrainment_speed=-1, temperature=0)
    at = np.array([float(data["load"])]), float(data["entrainment_speed"]), float(data["temperature"])
    state = MapFilms(emap).state(1, *at)
    assert state.pressure_error[0] == pytest.approx(float(data["max_pressure_error"]), rel=1e-9)
    assert state.film_error[0] == pytest.approx(float(data["minimum_film_error"]), rel=1e-9)
    formula = FormulaFilms(CONTACTS, OIL).state(1, *at)
    assert formula.pressure_error[0] == 0.0 and formula.film_error is None
    older = MapFilms(EHDMap(emap.dataset.drop_vars(["max_pressure_error", "minimum_film_error"]))).state(1, *at)
    assert np.isnan(older.pressure_error[0]) and np.isnan(older.film_error[0])


def test_the_stated_error_of_a_smallest_film_is_its_own():
    """Not that of another film, nor of a place without one."""
    film = np.array([[3.0, np.nan], [1.0, 2.0]])
    assert error_of_smallest(film, np.array([[0.1, 0.2], [0.3, 0.4]])) == 0.3
    assert np.isnan(error_of_smallest(film, None)) and np.isnan(error_of_smallest(film * np.nan, film))


def test_a_spike_whose_tip_is_missing_is_said():
    """Of the two raceways the one that lacks more; one sentence for all programs."""
    one = np.ones((1, 2))

    def contacts(inner, outer):
        sides = ((inner, 2.0 * one), (outer, one))
        return BearingContacts(*(ContactState(one, high * [[1.0, 2.0]], one, one, one, error) for error, high in sides))

    sharp, calm, unknown = np.array([[0.9, 1.4]]), np.array([[0.8, 0.05]]), np.full((1, 2), np.nan)
    assert spike_tip(contacts(sharp, calm)) == tip_words(1.4) != ""
    assert spike_tip(contacts(calm, calm)) == spike_tip(contacts(unknown, unknown)) == ""
    assert spike_tip(contacts(unknown, sharp)) == tip_words(1.4)


def test_axes_of_one_value_and_maps_of_a_bare_contact(tmp_path):
    one = MapFilms(a_map(tmp_path, "formula", temperatures='["40 degC"]'))
    assert one.state(0, np.array([1e5]), 2.0, 313.15).central_film[0] > 0.0
    (tmp_path / "bare").mkdir()
    bare = a_map(tmp_path / "bare", "formula", problem='[contact]\nradius = "5 mm"\nroller_length = "10 mm"')
    with pytest.raises(MapError, match="got the map of a bare contact; allowed: a map of a bearing"):
        MapFilms(bare)


def test_films_of_a_map_with_holes_go_on_from_the_last_known_point(tmp_path):
    """Their ratios to the formula are those of the last known point of each line, whatever the hole would have had."""
    whole = a_map(tmp_path, "formula").dataset
    loads, speed, kelvin = (
        whole["load"].values,
        *(float(whole[axis][0]) for axis in ("entrainment_speed", "temperature")),
    )
    dataset, held = whole.copy(deep=True), whole.copy(deep=True)
    dataset["central_film"].values[1, 3:, 0, 0] = np.nan
    formula = FormulaFilms(EHDMap(whole).contacts, EHDMap(whole).lubricant).state(1, loads, speed, kelvin).central_film
    held["central_film"].values[1, 3:, 0, 0] = formula[3:] * float(whole["central_film"][1, 2, 0, 0]) / formula[2]
    found, wanted = (
        MapFilms(EHDMap(one)).state(1, np.geomspace(loads[0], loads[-1], 9), speed * 1.1, kelvin).central_film
        for one in (dataset, held)
    )
    assert found == pytest.approx(wanted, rel=1e-12)  # round-off
    dataset["central_film"].values[1] = np.nan
    with pytest.raises(
        MapError, match="films: the map has no two loads at any speed and temperature with max_pressure"
    ):
        MapFilms(EHDMap(dataset))


def test_the_shipped_jobs_have_the_steps_of_the_test():
    job = read_job("nu308")
    steps = [np.diff(np.log(axis)) for axis in (job.loads, job.entrainment_speeds)]
    assert np.max(steps[0]) == pytest.approx(np.log(215.4435 / 46.4159) / 4, rel=0.01)  # digits of the job above
    assert np.max(steps[1]) == pytest.approx(np.log(3.4284 / 1.31) / 2, rel=0.01)


def test_formula_films_on_a_layer():
    """Light contacts have the layer, loaded ones their film; nothing without load, pressures up to that of Hertz."""
    supply = OilSupply(1e-6)
    loads = np.array([0.0, 1.0, 1e3, 1e6])
    flooded, layered = (FormulaFilms(CONTACTS, OIL, given).state(0, loads, 2.0, 313.15) for given in (FLOODED, supply))
    assert np.isnan(layered.central_film[0]) and layered.max_pressure[0] == 0.0
    assert layered.central_film[1] == pytest.approx(1e-6, rel=0.05) and flooded.central_film[1] > 1e-4
    # 0.67 um needs 0.82 um of oil: 2.5 % less by the rounded corner.
    assert layered.central_film[3] == pytest.approx(flooded.central_film[3], rel=0.03)
    assert np.all(layered.max_pressure <= flooded.hertz_pressure)
    assert np.all(FormulaFilms(CONTACTS, OIL, supply).state(0, loads, 0.0, 313.15).central_film[1:] == 0.0)
    assert FormulaFilms(CONTACTS, OIL, supply).words.endswith("oil layer 1 um")


def test_formula_law_on_a_layer_ends_where_the_gap_is_wider():
    ranges = {"load": (1e3, 1e5), "entrainment_speed": (1.0, 2.0), "temperature": (310.0, 320.0)}
    supply = OilSupply(2e-6)
    it = laws.formula(Bearing.named("NU308", clearance=0.0), OIL, **ranges, supply=supply)
    assert it.supply is supply
    w = it.at(1.5, 315.0)([-4.1e-6, -3.5e-6], [0.0, 0.0])[0]
    assert w[0] == 0.0 < w[1]

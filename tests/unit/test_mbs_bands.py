"""Bands from the errors that a map states: derivatives beside systems that are solved again, and what is told."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from ehdmaps.errors import InputError
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.law_errors import LawBounds, LawChange
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solids import STEEL
from mbs.analyses.campbell import campbell, law_changes, with_changed_laws
from mbs.analyses.lsa import LsaSettings, lsa
from mbs.analyses.modes import modes
from mbs.analyses.ramp import silent_run
from mbs.linearised.bands import KINDS, law_bands
from mbs.linearised.dynamic import dynamic_stiffness
from mbs.linearised.film_part import CondensedBearing
from mbs.linearised.linear import frequency_response, input_matrix, responses, seen_of_loads, sensor_matrix
from mbs.linearised.modes import state_modes, undamped_modes
from mbs.linearised.sweep import along_load
from mbs.model.elements import Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.on_rings import NO_MAP, error_words
from mbs.model.relaxation import Relaxation
from mbs.output.model_text import band_lines
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene
from tests.cases.laws import dataset_of
from tests.unit.test_law_errors import CHECKED

SPEED = 100.0
"""[rad/s]; with the bearings of both scenes within the maps below."""

SCENES = ("nu308_rigid", "n1014_rigid")
"""Massless rollers, and rollers as bodies."""

SMALL = 0.1
"""Part of a change that is taken where a system is solved again. Changes of at most 1 % leave an error of second order
of a thousandth; the few states of relaxing films (1e-8 of what they add) leave less than that of it."""


@pytest.fixture(scope="module")
def maps():
    """Maps of a closed form that state errors of their laws."""
    found = {}
    for scene, name in zip(SCENES, ("NU308", "N1014"), strict=True):
        geometry = BearingGeometry.named(name)
        dataset = dataset_of(
            contacts=geometry.contacts(STEEL, "iso16281"),
            bearing=geometry,
            loads=tuple(np.geomspace(1e2, 1e6, 13)),
            speeds=(0.6, 2.4, 4.8),
            temperatures=(303.15, 323.15),
        )
        found[scene] = EHDMap(dataset.assign_attrs(CHECKED))
    return found


@pytest.fixture(scope="module")
def models(maps):
    """Scenes with films that relax, by name."""
    return {scene: assemble(read_scene(scene), "map", maps[scene]) for scene in SCENES}


def changed(balance, laws, change, part):
    """The equilibrium with stiffness, damping and relaxation of its slices changed by a part of a change."""
    stiffness, damping = [list(given) for given in (balance.element_stiffness, balance.element_damping)]
    relaxations = list(balance.relaxations)
    whole_k, whole_c = balance.stiffness.copy(), balance.damping.copy()
    for one in laws.bearings:
        at, by = one.condensed.contacts, one.condensed.slopes.contacts
        rows = (at.feel @ one.condensed.pose).reshape(-1, one.transform.shape[0])
        k, c, t = (part * more[change].ravel() for more in (by.stiffness, by.damping, by.times))
        dk, dc = rows.T @ (k[:, None] * rows), rows.T @ (c[:, None] * rows)
        stiffness[one.element], damping[one.element] = stiffness[one.element] + dk, damping[one.element] + dc
        whole_k, whole_c = (
            whole + one.transform.T @ more @ one.transform for whole, more in ((whole_k, dk), (whole_c, dc))
        )
        times, loss = at.times.ravel() + t, at.damping.ravel() + c
        relaxes = (loss > 0.0) & (times > 0.0)
        springs = np.sqrt(np.where(relaxes, loss, 0.0) / np.where(relaxes, times, 1.0))
        relaxations[one.element] = Relaxation(rows * springs[:, None], np.where(relaxes, times, times.max()))
    other = dataclasses.replace(
        balance,
        stiffness=whole_k,
        damping=whole_c,
        element_stiffness=tuple(stiffness),
        element_damping=tuple(damping),
    )
    other.__dict__["relaxations"] = tuple(relaxations)
    return other


def states_of(balance):
    return state_modes(balance, undamped_modes(balance))


def nearest(values, wanted):
    return values[np.argmin(np.abs(values[:, None] - wanted), axis=0)]


@pytest.mark.parametrize("scene", SCENES)
def test_derivatives_are_those_of_systems_solved_again(models, scene):
    """Eigenvalues, undamped frequencies, responses and k and c of bearings, for each kind of change."""
    balance = equilibrium(models[scene].system, Operation(SPEED))
    laws, states, n = law_bands(balance), states_of(balance), balance.system.size
    kept = np.flatnonzero(states.oscillates)
    values = states.eigenvalues[kept]
    found = laws.eigenvalue_changes(values, states.right[:n, kept], states.left[kept, n : 2 * n])
    model_scene = read_scene(scene)
    inputs, sensors = model_scene.inputs, model_scene.sensors
    frequencies = np.geomspace(30.0, 5e3, 7)
    direct = frequency_response(balance, inputs, sensors, frequencies)
    back = seen_of_loads(balance, states, sensors, frequencies, np.eye(n))
    np.testing.assert_allclose(back @ input_matrix(balance, inputs), direct, rtol=1e-4)  # the few states of the films
    back = seen_of_loads(balance, states, sensors, frequencies, laws.ports)
    motion = laws.ports @ responses(balance, inputs, frequencies)
    for index, kind in enumerate(KINDS):
        assert laws.change_of(laws.bearings[0].element, kind) == index
        only, other = laws.only(index), changed(balance, laws, index, SMALL)
        again = states_of(other)
        moved = (nearest(again.eigenvalues, values + SMALL * found[index]) - values) / SMALL
        scale = np.abs(found[index]) + 1e-2 * np.abs(found[index]).max()
        assert np.max(np.abs(moved - found[index]) / scale) < 5e-3
        plain, after = undamped_modes(balance), undamped_modes(other)
        swings = plain.frequency > 1.0
        shift = np.abs(after.frequency - plain.frequency)[swings] / SMALL
        band = only.of_undamped(plain.frequency, plain.shapes)[swings]
        np.testing.assert_allclose(np.sort(shift), np.sort(band), rtol=5e-3, atol=1e-3 * band.max(initial=1e-9))
        level = (np.abs(frequency_response(other, inputs, sensors, frequencies)) - np.abs(direct)) / SMALL
        band, _ = only.of_responses(frequencies, motion, back, direct)
        np.testing.assert_allclose(band, np.abs(level), rtol=5e-3, atol=1e-3 * band.max())
        sides = np.abs(along_load(other)[1:] - along_load(balance)[1:]) / SMALL
        np.testing.assert_allclose(only.of_bearings(), sides, rtol=5e-3, atol=1e-6 * sides.max())


class Even:
    """Errors of a law that has a film error alone, the same at all loads."""

    words = "even"

    def __init__(self, film):
        self.film = film

    def bounds(self, names, loads, speed, temperature, added=None):
        nothing = np.zeros(loads.shape)
        return LawBounds(nothing, nothing, nothing + self.film)


def test_a_thicker_film_moves_the_equilibrium(models, monkeypatch):
    """Against the law with films 0.1 nm thicker everywhere, from its equilibrium on: a second way."""
    model = models["nu308_rigid"]
    balance = equilibrium(model.system, Operation(SPEED))
    states, n, film = states_of(balance), balance.system.size, 1e-10
    # Both bearings are alike and share the map: their changes of this kind together, for a film that is even.
    names = [bearing.name for bearing in model.bearings]
    even = with_changed_laws(model, {name: (LawChange(film=film),) for name in names}, (1.0, 1.0, 1.0))
    after = states_of(equilibrium(even.system, Operation(SPEED)))
    for bearing in model.bearings:
        monkeypatch.setattr(bearing.force.law, "errors", Even(film))
    uniform = law_bands(balance)
    kept = np.flatnonzero(states.oscillates)
    values = states.eigenvalues[kept]
    found = uniform.eigenvalue_changes(values, states.right[:n, kept], states.left[kept, n : 2 * n])[2::3].sum(axis=0)
    moved = nearest(after.eigenvalues, values + found) - values
    scale = np.abs(found) + 1e-2 * np.abs(found).max()
    # Kinks of the table's curvature from slice to slice: its splines are cubic.
    assert np.max(np.abs(moved - found) / scale) < 5e-2


def test_bands_are_told(models):
    model = models["nu308_rigid"]
    result = modes(model, Operation(SPEED))
    data, bands = result.dataset, result.modes.bands
    np.testing.assert_array_equal(data["frequency_error"], bands.frequency)
    np.testing.assert_array_equal(data["damping_ratio_error"], bands.damping_ratio)
    # k within 0.1 %, c within 1 %: a frequency by about half of the first, and by some of the second where c stiffens
    light = result.modes.damping_ratio < 0.3
    by_map = bands.frequency - bands.by_films[0]
    assert 0.0 < (by_map / result.modes.frequency)[light].max() < 2e-3
    assert "95 % of 100 checked points" in data.attrs["bands"]
    (line,) = band_lines(model, bands.film_share)
    assert data.attrs["bands"] in line
    found = lsa(model, LsaSettings((50.0, 500.0), Operation(SPEED)))
    assert found.level_error.shape == found.responses.shape == found.dataset["response_level_error"].shape
    assert 0.0 < found.level_error.max() < 1.0


def test_laws_without_a_map_state_no_errors():
    model = assemble(read_scene("nu308_rigid"), "hertz")
    result = modes(model, Operation(SPEED))
    assert result.modes.bands is None
    assert np.all(np.isnan(result.dataset["frequency_error"]))
    assert result.dataset.attrs["bands"] == NO_MAP
    assert NO_MAP in band_lines(model)[0]
    assert law_changes(model, [SPEED]) is None


def test_at_standstill_a_map_states_no_errors(models):
    model = models["nu308_rigid"]
    assert law_bands(equilibrium(model.system, Operation(0.0))) is None
    assert law_changes(model, [0.0]) is None


def test_laws_of_samples_are_wrong_by_the_bounds(models):
    """k of all slices by the bound: so is that of the bearing, at the same pose."""
    for scene in SCENES:
        model = models[scene]
        changes = law_changes(model, [0.5 * SPEED, SPEED])
        for of_bearing in changes.values():
            for change in of_bearing:
                # 95 % quantiles of the check, and no numerical errors; two contacts have shares that differ.
                assert change.stiffness == pytest.approx(1e-3, rel=1e-6)
                assert 0.01 * (1.0 - 1e-9) <= change.damping <= 0.01 + 2.0 * 1e-3
        other = with_changed_laws(model, changes, (1.0, 0.0, 0.0))
        for plain, stiffer in zip(model.system.elements[:1], other.system.elements[:1], strict=True):
            at = np.zeros(plain.transform.shape[0])
            at[1] = 3e-6
            first, second = (one.element.evaluate(at, np.zeros_like(at), Operation(SPEED)) for one in (plain, stiffer))
            np.testing.assert_allclose(second.stiffness, 1.001 * first.stiffness, rtol=1e-5, atol=1e-6)


def test_runs_of_bands_are_limited():
    model = assemble(read_scene("nu308_rigid"), "hertz")
    with pytest.raises(InputError, match=r"bands: got 9 runs; allowed: 0 to 8"):
        campbell(model, bands=9)


def loudness(model):
    """Stiffness of the first bearing in a pose, which takes the place of what a run would find."""
    first = model.system.elements[0]
    at = np.zeros(first.transform.shape[0])
    at[1] = 3e-6
    return float(first.element.evaluate(at, np.zeros_like(at), Operation(SPEED)).stiffness[1, 1])


def test_the_band_of_a_level_is_the_largest_difference_of_its_runs(models, monkeypatch):
    """Runs as loud as a bearing is stiff: k wrong by 0.1 % is 20 log10(1.001) or 20 log10(1/0.999)."""
    model = models["nu308_rigid"]
    plain, told = loudness(model), []

    def run(wrong, course, sensors, progress, marks):
        silent = silent_run(course)
        part = loudness(wrong) / plain
        told.append(part)
        values = part * np.sin(2.0 * np.pi * 1000.0 * silent.time)
        return SimpleNamespace(time=silent.time, speed=silent.speed, angle=silent.angle, signals=values[:, None])

    monkeypatch.setattr("mbs.analyses.campbell.recorded_run", run)
    monkeypatch.setattr("mbs.analyses.campbell.step_check", lambda *given: None)  # made-up runs have no step
    monkeypatch.setattr("mbs.analyses.campbell.findings_in_run", lambda *given: ())  # and no forces
    found = campbell(model, bands=2)
    change = law_changes(model, [0.5 * found.course.speed.at(found.course.duration)[0]])["bearing_left"][0]
    assert len(told) == 3
    expected = 20.0 * np.abs(np.log10(np.array(told[1:]))).max()
    # Both films and k of a sample have the same sign; a film of a thousandth of the approach counts as k does.
    assert expected > 20.0 * np.log10(1.0 + change.stiffness)
    np.testing.assert_allclose(found.runs[0].level_error[0], expected, rtol=1e-6)
    np.testing.assert_allclose(found.dataset["sum_level_error"][0], expected, rtol=1e-6)
    assert campbell(model).runs[0].level_error is None
    assert len(told) == 4


@pytest.fixture(scope="module")
def with_response():
    """A machine whose law holds the response of its films."""
    return assemble(read_scene("nu308_rigid"), "table")


@pytest.fixture
def sure(monkeypatch):
    """Films of which what they leave out is known without a doubt."""
    plain = CondensedBearing.left_out

    def left_out(bearing, *asked):
        part, doubt = plain(bearing, *asked)
        return part, 0.0 * doubt

    monkeypatch.setattr(CondensedBearing, "left_out", left_out)


def more_of(balance, laws, s, size):
    """Dynamic stiffness with a part of what the films leave out, shape (n, n)."""
    added = dynamic_stiffness(balance, np.array([s]))[0]
    for one in laws.films.bearings:
        own, _ = one.left_out(np.array([s]), *[one.transform.astype(np.complex128)[None]] * 2)
        added = added + size * own[0]
    return added


def test_what_films_leave_out_is_that_of_systems_solved_again(with_response, sure):
    """Eigenvalues, and sizes of responses, of the system with a tenth of it; the second order is a thousandth."""
    balance = equilibrium(with_response.system, Operation(SPEED))
    laws, states, n = law_bands(balance), states_of(balance), balance.system.size
    kept = np.flatnonzero(states.oscillates)
    own = states.at_own_frequency(balance, kept)
    right, left = states.right[:n, kept], states.left[kept, n : 2 * n]
    found, doubt = laws.films.eigenvalue_changes(own.eigenvalues, right, left)
    assert not np.any(doubt) and np.all(found != 0.0)
    for k, s in enumerate(own.eigenvalues):
        # Z of the other system, read by the vectors of this one: Z of this one leaves nothing there.
        matrix, turned = more_of(balance, laws, s, 1.0), np.linalg.solve(balance.system.mass, left[k])
        assert -turned @ matrix @ right[:, k] == pytest.approx(found[k], rel=2e-2, abs=1e-3 * np.abs(found).max())
    inputs, sensors = with_response.scene.inputs, with_response.scene.sensors
    frequencies = np.geomspace(30.0, 5e3, 30)
    direct = frequency_response(balance, inputs, sensors, frequencies)
    back = seen_of_loads(balance, states, sensors, frequencies, laws.ports)
    motion = laws.ports @ responses(balance, inputs, frequencies)
    _, by_films = laws.of_responses(frequencies, motion, back, direct)
    places, forces = sensor_matrix(balance, sensors), input_matrix(balance, inputs)
    orders = np.array([{"displacement": 0, "velocity": 1, "acceleration": 2}[sensor.quantity] for sensor in sensors])
    for f, frequency in enumerate(frequencies):
        s = 2j * np.pi * frequency
        again = places @ np.linalg.solve(more_of(balance, laws, s, SMALL), forces) * (s**orders)[:, None]
        level = np.abs(np.abs(again) - np.abs(direct[f])) / SMALL
        # 12 places a decade for the splines of what the slices leave out
        np.testing.assert_allclose(by_films[f], level, rtol=2e-2, atol=1e-2 * by_films[f].max())


def test_bands_hold_what_films_with_memory_leave_out(models, with_response):
    """With and without a response of the films; more of the stiffness at higher frequencies."""
    frequencies = np.array([100.0, 1e3, 4e3])
    for model in (models["nu308_rigid"], with_response):
        found = modes(model, Operation(SPEED))
        bands, laws = found.modes.bands, law_bands(found.balance)
        swings = found.modes.eigenvalues.imag > 0.0
        assert np.all(bands.by_films[:, swings] > 0.0) and not np.any(bands.by_films[:, ~swings])
        assert np.all(bands.damping_ratio[swings] > bands.by_films[1, swings]) and 0.0 < bands.film_share < 1.0
        assert "one relaxation time" in found.dataset.attrs["bands"]
        for one in laws.films.bearings:
            along = np.eye(6, dtype=np.complex128)[None, :, 1:2]
            part, doubt = one.left_out(2j * np.pi * frequencies, along, along)
            size = np.abs(part[:, 0, 0]) + np.abs(doubt[:, 0, 0])
            assert size[0] > 0.0 and np.all(np.diff(size) > 0.0)
        loud = lsa(model, LsaSettings((50.0, 4e3), Operation(SPEED)))
        assert 0.0 < loud.film_share < 1.0 and "one relaxation time" in loud.dataset.attrs["bands"]
    law = found.modes.film_law
    some = np.isfinite(law.damping_ratio)
    # The part has its sign there and its size here: what is added is its possible error, and the second order.
    assert np.all(bands.damping_ratio[some] > 0.9 * np.abs(law.damping_ratio[some]))


def test_slow_films_leave_out_no_memory(maps):
    model = assemble(read_scene("nu308_rigid"), "map", maps["nu308_rigid"], films="slow")
    found = modes(model, Operation(SPEED))
    assert not np.any(found.modes.bands.by_films) and found.modes.bands.film_share == 0.0
    assert found.dataset.attrs["bands"].endswith("how films relax is not in it")
    assert lsa(model, LsaSettings((50.0, 500.0), Operation(SPEED))).film_share == 0.0


def test_the_largest_source_of_bands_comes_first(models):
    system = models["nu308_rigid"].system
    large, small = (error_words(system, share) for share in (0.8, 0.2))
    assert large.startswith("what one relaxation time of a slice leaves out (80 % of the median band), then numerical")
    assert small.endswith("then what one relaxation time of a slice leaves out (20 % of the median band)")

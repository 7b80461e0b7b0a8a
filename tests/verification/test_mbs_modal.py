"""Modal identification against closed forms, other methods, and the eigenvalues of the system that was hit."""

from __future__ import annotations

import dataclasses
import functools

import numpy as np
import pytest

from mbs.linearised.linear import frequency_response, state_space
from mbs.linearised.modes import modes
from mbs.modal.estimation import estimate, needed_decay, transfer
from mbs.modal.fit import identify
from mbs.modal.records import Channel, Responses
from mbs.modal.residues import laplace
from mbs.model.equilibrium import equilibrium
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene
from mbs.transient.hammer import OVERSAMPLING, HammerTest, linear_hits, nonlinear_hits, suggested_duration
from tests.cases.modal import (
    DAMPING,
    OMEGA,
    ORDERS,
    POLES,
    REFERENCE,
    SAMPLES,
    SHAPES,
    STEP,
    hits,
    impulse_responses,
    measured,
    responses_at,
)

# estimation


def test_coherence_of_known_noise():
    """White noise of power N on the response: coherence is 1/(1 + N/S), H1 is true, H2 is too large by 1 + N/S."""
    random = np.random.default_rng(0)
    count, samples, ratio = 4000, 32, 0.25
    force = random.standard_normal((count, samples))
    response = 3.0 * force + 3.0 * np.sqrt(ratio) * random.standard_normal((count, samples))
    for swapped, first, second in ((False, 1.0, 1.0 + ratio), (True, 1.0 / (1.0 + ratio), 1.0)):
        # Noise on the force instead: H1 is too small, H2 is true.
        f, x = (response / 3.0, 3.0 * force) if swapped else (force, response)
        H1, gamma = transfer(f, x[:, None])
        H2, _ = transfer(f, x[:, None], "h2")
        # 4000 averages: deviation of coherence about sqrt(2/n) gamma^0.5 (1 - gamma) = 0.4 %, five of them.
        np.testing.assert_allclose(gamma[0], 1.0 / (1.0 + ratio), rtol=0.025)
        # Of H, sqrt((1 - c)/(2 n c)) = 0.6 %, five of them.
        np.testing.assert_allclose(H1[0], 3.0 * first, rtol=0.03)
        np.testing.assert_allclose(H2[0], 3.0 * second, rtol=0.03)


def test_exponential_window_moves_the_line_of_evaluation():
    """Force and response windowed alike give H(j omega + 1/tau), which is what a shift of the poles means.

    The records are sampled: sum over samples of h exp(-s t) is a geometric series for each mode, summed in closed form.
    """
    decay = 12.0
    found = estimate([hits(3)], decay=decay).responses
    s = laplace(found.frequency, decay)
    damped = OMEGA * np.sqrt(1.0 - DAMPING**2)
    expected = 0.0
    for k in range(3):
        residue = SHAPES[:, k] * SHAPES[0, k] / (2j * damped[k])
        for pole, r in ((POLES[k], residue), (POLES[k].conjugate(), residue.conj())):
            expected = expected + r[:, None] / (1.0 - np.exp((pole - s) * STEP))
    # What is cut off at the end of the record: exp(-(12 + zeta omega) T) with zeta omega >= 15.6 1/s.
    scale = np.abs(expected).max()
    np.testing.assert_allclose(found.response, expected, atol=1e-10 * scale)


# poles


def test_modes_residues_and_residual_terms():
    fit = identify(measured(), band=(200.0, 900.0), order=12)
    np.testing.assert_allclose(fit.poles, POLES, rtol=1e-8)  # noiseless, refined: round-off
    # Residue of a mode of unit mass: phi_i phi_k/(2 j omega_d).
    expected = (SHAPES * SHAPES[0]).T / (2j * OMEGA * np.sqrt(1.0 - DAMPING**2))[:, None]
    np.testing.assert_allclose(fit.parts.residues, expected, rtol=1e-6)
    assert np.all(fit.error < 1e-8)
    frequency = np.linspace(250.0, 800.0, 11)
    np.testing.assert_allclose(fit.synthesise(frequency), responses_at(2j * np.pi * frequency), rtol=1e-6)


def test_modes_outside_the_band_are_residual_terms():
    fit = identify(measured(), band=(500.0, 900.0), order=10)
    # The mode at 310 Hz is no mode of this band; of its skirt, L/s^2 leaves the part (310/500)^2 squared.
    assert fit.poles.size == 2
    np.testing.assert_allclose(fit.frequency, OMEGA[1:] / (2.0 * np.pi), rtol=1e-4)
    np.testing.assert_allclose(fit.damping_ratio, DAMPING[1:], rtol=2e-2)


def test_refinement_takes_the_bias_out():
    """Mean over seeds: p-LSCF alone lowers the damping of a weak mode in noise, the refined poles do not."""
    kept = {True: [], False: []}
    for seed in range(8):
        for refined, found in kept.items():
            fit = identify(measured(noise=0.1, seed=seed), band=(200.0, 900.0), refined=refined)
            if fit.poles.size == 3:
                found.append(np.abs(fit.damping_ratio / DAMPING - 1.0))
    assert min(len(found) for found in kept.values()) >= 6
    assert np.mean(kept[True]) < 0.7 * np.mean(kept[False])


def random_structure(seed, modes=6, rows=4, noise=0.05):
    """Poles of a structure that nobody chose, and its accelerances with noise; two more modes lie outside the band."""
    random = np.random.default_rng(seed)
    frequency = np.array([*np.sort(random.uniform(115.0, 920.0, modes)), 50.0, 1600.0])
    damping = np.exp(random.uniform(np.log(0.002), np.log(0.04), modes + 2))
    poles = 2.0 * np.pi * frequency * (-damping + 1j * np.sqrt(1.0 - damping**2))
    residues = random.standard_normal((rows, modes + 2)) * random.standard_normal(modes + 2) / (2j * poles.imag)
    lines = np.linspace(100.0, 1000.0, 900)
    s = 2j * np.pi * lines
    response = s**2 * (residues @ (1.0 / (s - poles[:, None])) + residues.conj() @ (1.0 / (s - poles.conj()[:, None])))
    size = noise * np.sqrt(np.mean(np.abs(response) ** 2, axis=1, keepdims=True) / 2.0)
    response = response + size * (random.standard_normal(response.shape) + 1j * random.standard_normal(response.shape))
    pairs = tuple((Channel(f"S{row}", row, 1, "acceleration"), REFERENCE) for row in range(rows))
    return poles[:modes], Responses(lines, response, np.full(response.shape, np.nan), pairs)


@pytest.mark.slow
def test_modes_of_random_structures():
    """Five per cent of noise: nearly all modes are found, and none that is not there."""
    found = 0
    for seed in range(6):
        poles, responses = random_structure(seed)
        fit = identify(responses)
        nearest = np.argmin(np.abs(fit.poles[:, None] - poles), axis=1)
        assert np.unique(nearest).size == fit.poles.size
        assert np.all(np.abs(fit.poles - poles[nearest]) < -poles[nearest].real)  # within its half width
        found += fit.poles.size
    # Some have no residue that stands out of the noise.
    assert found >= 30


def test_uncertainties_are_those_that_are_found():
    """Error over stated standard deviation, squared, has the mean 1.

    Records with white noise in time; both real and imaginary parts of three poles, over twelve tests.
    """
    ratios = []
    for seed in range(12):
        records = hits(6, noise=0.01, seed=seed)
        fit = identify(estimate([records]).responses, band=(200.0, 900.0))
        if fit.poles.size == 3:
            error = fit.poles - POLES
            ratios += [*(error.real / fit.deviation[:, 0]), *(error.imag / fit.deviation[:, 1])]
    assert len(ratios) >= 60
    # Mean of 60 to 72 squares of unit variance: standard deviation 0.18; within four, and coherence of six hits is
    # itself uncertain by some per cent.
    assert 0.3 < np.mean(np.square(ratios)) < 1.7


def test_uncertainties_where_noise_grows_with_the_response():
    """The same for responses with noise of 5 % of each value, and no coherence that would say so."""
    ratios = []
    for seed in range(8):
        clean, random = measured(), np.random.default_rng(seed)
        noise = random.standard_normal((2, *clean.response.shape)) * 0.05 / np.sqrt(2.0)
        noisy = dataclasses.replace(clean, response=clean.response * (1.0 + noise[0] + 1j * noise[1]))
        fit = identify(noisy, band=(200.0, 900.0))
        if fit.poles.size == 3:
            error = fit.poles - POLES
            ratios += [*(error.real / fit.deviation[:, 0]), *(error.imag / fit.deviation[:, 1])]
    assert len(ratios) >= 24
    # 24 to 48 squares of unit variance scatter by 0.2 to 0.3; by the mean error of all lines the mean would be 19.
    assert 0.3 < np.mean(np.square(ratios)) < 2.5


# simulated hammer tests


@functools.cache
def at_equilibrium(name, law):
    scene = read_scene(name)
    model = assemble(scene, law)
    return scene, equilibrium(model.system, model.operation)


def struck(name, law, highest, **keywords):
    scene, balance = at_equilibrium(name, law)
    test = HammerTest(highest, suggested_duration(modes(balance), highest), **keywords)
    return scene, balance, test, linear_hits(balance, scene.inputs, scene.sensors, test)


def test_records_have_the_response_of_the_linear_system():
    scene, balance, _, records = struck("nu308_rigid", "constant:cfd", 3000.0, noise=0.0, hits=2)
    decay = needed_decay(records[0].response, records[0].step)
    assert decay > 0.0
    found = estimate(records, decay=decay).responses.within(100.0, 3000.0)
    space = state_space(balance, scene.inputs, scene.sensors)
    s = laplace(found.frequency, decay)
    expected = np.stack([(space.C @ np.linalg.solve(z * np.eye(len(space.A)) - space.A, space.B) + space.D) for z in s])
    # The half-sine folds back from beyond half the computed rate, 0.25 %, and a hundredth of slow modes is cut off
    # at the end of the records, which are loudest at the lower end of the band.
    seen = found.frequency > 1000.0
    size = np.abs(expected[seen, :, 0].T)
    assert np.all(np.abs(found.response[:, seen] - expected[seen, :, 0].T) < 0.005 * size)
    # And at s = j omega that is what `frequency_response` gives.
    direct = frequency_response(balance, scene.inputs, scene.sensors, np.array([1600.0]))
    z = 2j * np.pi * 1600.0
    again = space.C @ np.linalg.solve(z * np.eye(len(space.A)) - space.A, space.B) + space.D
    np.testing.assert_allclose(again, direct[0], rtol=1e-8)


@pytest.mark.parametrize(
    ("name", "law", "highest", "band", "expected", "seed"),
    [
        ("n1014_testrig", "hertz", 3000.0, (900.0, 2600.0), (1099.3, 2281.3), 0),
        ("nu308_rigid", "constant:cfd", 3000.0, (1300.0, 1900.0), (1606.39, 1630.23), 1),
        ("n1014_rigid", "constant:cfd", 4000.0, (2600.0, 3300.0), (2915.78,), 0),
        ("n1014_rigid", "constant:cfd", 800.0, (200.0, 400.0), (287.373,), 1),
    ],
)
def test_hammer_test_finds_the_eigenvalues(name, law, highest, band, expected, seed):
    """One per cent of noise on every channel: f within 0.1 %, zeta within 5 % of the eigenvalues.

    `expected` only says which eigenvalues the place hit excites and the sensor sees. A further one that is found is an
    eigenvalue too, within four of its standard uncertainties.
    """
    _, balance, _, records = struck(name, law, highest, seed=seed)
    found = modes(balance)
    decay = max(needed_decay(entry.response, entry.step) for entry in records)
    fit = identify(estimate(records, decay=decay).responses, band=band)
    assert len(expected) <= fit.poles.size <= len(expected) + 1
    exact = 2.0 * np.pi * found.frequency * (-found.damping_ratio + 1j * np.sqrt(1.0 - found.damping_ratio**2))
    for pole, deviation in zip(fit.poles, fit.deviation, strict=True):
        if all(abs(abs(pole) / (2.0 * np.pi * near) - 1.0) > 1e-3 for near in expected):
            error = pole - exact[np.argmin(np.abs(exact - pole))]
            assert abs(error.real) < 4.0 * deviation[0] and abs(error.imag) < 4.0 * deviation[1]
    for near in expected:
        mode, k = (int(np.argmin(np.abs(each - near))) for each in (found.frequency, fit.frequency))
        np.testing.assert_allclose(fit.frequency[k], found.frequency[mode], rtol=1e-3)
        np.testing.assert_allclose(fit.damping_ratio[k], found.damping_ratio[mode], rtol=0.05)


def test_undamped_system_needs_the_window():
    """Dry Hertz has no damping: without a window the records are cut off at full size."""
    _, balance, _, records = struck("nu308_rigid", "hertz", 10000.0)
    found = modes(balance)
    decay = needed_decay(records[0].response, records[0].step)
    fit = identify(estimate(records, decay=decay).responses, band=(4000.0, 5500.0))
    seen = found.frequency[-2:]
    np.testing.assert_allclose(fit.frequency, seen, rtol=1e-4)
    # Damping is known to a part of what the window adds, 7.2 1/s of 3e4 1/s.
    assert np.all(np.abs(fit.damping_ratio) < 0.05 * decay / (2.0 * np.pi * seen))


def test_small_hits_on_the_nonlinear_system_are_linear():
    """Second method for the linear records: time integration; hits of 1 N against preloads of 141 N."""
    scene, balance = at_equilibrium("nu308_rigid", "constant:cfd")
    test = HammerTest(6000.0, 0.02, hits=1, noise=0.0, spread=0.0)
    (linear,) = linear_hits(balance, scene.inputs, scene.sensors, test)
    (full,), outside = nonlinear_hits(balance, scene.inputs, scene.sensors, test)
    assert not any(outside.values())
    np.testing.assert_allclose(full.force, linear.force, atol=1e-12)
    size = np.abs(linear.response).max(axis=2, keepdims=True)
    # Phase error of the trapezoidal rule: (omega h)^2/12 omega t, 3 % at 1630 Hz and 0.02 s; the stiffness of
    # a unilateral constant law does not change.
    omega, h = 2.0 * np.pi * 1630.0, test.step / OVERSAMPLING
    bound = (omega * h) ** 2 / 12.0 * omega * test.samples * test.step
    assert np.all(np.abs(full.response - linear.response) < 2.0 * bound * size)


def test_impulse_responses_of_the_cases_are_their_frequency_responses():
    """The cases that the tests lean on: the transform of the impulse responses against the sum of modes."""
    fine = impulse_responses()
    spectrum = STEP * np.fft.rfft(fine, axis=1)
    frequency = np.fft.rfftfreq(SAMPLES, STEP)
    seen = (frequency > 250.0) & (frequency < 800.0)
    expected = responses_at(2j * np.pi * frequency[seen]) / (2j * np.pi * frequency[seen]) ** ORDERS[:, None]
    # Sampling at 4096 Hz folds the skirts beyond 2 kHz back: (omega/omega_N)^2 of them, below 1 % of the peaks.
    assert np.max(np.abs(spectrum[:, seen] - expected)) < 0.01 * np.abs(expected).max()

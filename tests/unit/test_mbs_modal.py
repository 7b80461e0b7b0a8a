"""Modal identification, piece by piece."""

from __future__ import annotations

import dataclasses
import sys

import numpy as np
import pytest

from ehdmaps.errors import AnalysisError, DependencyError, InputError
from mbs.modal.estimation import (
    estimate,
    exponential_window,
    force_window,
    needed_decay,
    pulse,
    relative_deviation,
    second_pulses,
    transfer,
    without_window,
)
from mbs.modal.fit import identify
from mbs.modal.records import Channel, Hits
from mbs.modal.stabilisation import stabilise
from mbs.modal.uff import LARGEST, Measurement, read_uff, write_uff
from mbs.timedata.uff_file import read_time_uff
from tests.cases.modal import (
    DAMPING,
    OMEGA,
    POLES,
    REFERENCE,
    SAMPLES,
    SENSORS,
    STEP,
    hits,
    impulse_responses,
    measured,
    responses_at,
)


def changed(entry, **keywords):
    return dataclasses.replace(entry, **keywords)


# records


def test_channels_say_where_they_are():
    assert Channel("S1", 3, -2, "acceleration").label == "S1:3-y"
    assert Channel("", 3, 5, "displacement").label == "node:3+theta_y"
    assert Channel("S1", 3, 5, "displacement").rotational


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"step": 0.0}, "step: got 0.0 s; allowed: finite and > 0"),
        ({"step": float("nan")}, "allowed: finite and > 0"),
        ({"force": np.zeros(32)}, "got force of shape (32,)"),
        ({"force": np.zeros((6, 30))}, "records of equal length"),
        ({"sensors": ()}, "at least one of each"),
    ],
)
def test_hits_that_do_not_fit_together(change, words):
    with pytest.raises(InputError) as caught:
        changed(hits(), **change)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"frequency": np.arange(1001.0)[::-1]}, "not finite, >= 0 Hz and rising"),
        ({"frequency": np.array([1.0])}, "allowed: a list of 2"),
        ({"coherence": np.zeros((1, 3))}, "coherence of shape (1, 3)"),
        ({"response": np.full((2, 1001), np.nan + 0j)}, "values that are not finite"),
        ({"decay": -1.0}, "decay: got -1.0 1/s"),
    ],
)
def test_responses_that_do_not_fit_together(change, words):
    with pytest.raises(InputError) as caught:
        changed(measured(), **change)
    assert words in str(caught.value)


def test_band_without_lines():
    with pytest.raises(InputError, match=r"got 2000 Hz to 3000 Hz, with 0 lines"):
        measured().within(2000.0, 3000.0)


# windows


def test_exponential_window_and_its_limits():
    np.testing.assert_allclose(exponential_window(3, 0.5, 2.0), np.exp([0.0, -1.0, -2.0]), rtol=1e-15)
    assert np.all(exponential_window(5, 0.1, 0.0) == 1.0)
    for decay, words in ((-1.0, "finite and >= 0"), (np.inf, "finite and >= 0"), (100.0, "longer than the step")):
        with pytest.raises(InputError, match=words):
            exponential_window(10, 0.1, decay)


def test_common_correction_is_the_first_order_of_the_exact_one():
    tau = 0.3
    seen = POLES - 1.0 / tau
    exact = without_window(seen, 1.0 / tau)
    np.testing.assert_allclose(exact, POLES, rtol=1e-14)
    common = -seen.real / np.abs(seen) - 1.0 / (tau * np.abs(seen))
    # Its error is of second order, zeta/(tau omega)^2-like, below 1e-6 here.
    np.testing.assert_allclose(common, -POLES.real / np.abs(POLES), atol=1e-6)


def test_force_window_keeps_the_pulse_and_nothing_far_from_it():
    force = np.zeros(400)
    force[100:110] = np.sin(np.pi * (np.arange(10) + 0.5) / 10)
    assert pulse(force) == (100, 109)
    window = force_window(force)
    assert np.all(window[100:110] == 1.0)
    assert np.all(window[:60] == 0.0) and np.all(window[150:] == 0.0)


def test_needed_decay():
    t = np.arange(1000) * 1e-3
    assert needed_decay(np.exp(-10.0 * t)[None], 1e-3) == 0.0
    assert needed_decay(np.zeros((2, 1000)), 1e-3) == 0.0
    np.testing.assert_allclose(needed_decay(np.cos(50.0 * t)[None], 1e-3), np.log(100.0), rtol=1e-12)


# estimation


def spoilt():
    """Six hits of which four are not fit for use."""
    good = hits(6, noise=1e-3)
    force, response = good.force.copy(), good.response.copy()
    force[:, 1] = 0.5 * force[:, 0]
    force[1, 300] = 0.3 * force[1, 0]
    response[2, 1] = np.clip(response[2, 1], -0.3 * response[2, 1].max(), 0.3 * response[2, 1].max())
    force[3] = np.random.default_rng(0).standard_normal(force.shape[1])
    response[4, 0, 7] = np.nan
    return changed(good, force=force, response=response)


def test_spoilt_hits_are_left_out_and_reported():
    found = estimate([spoilt()])
    assert [(one.hit, one.reason) for one in found.rejected] == [
        (2, "double hit"),
        (3, "overload"),
        (4, "no hit"),
        (5, "not finite"),
    ]
    assert found.used == (2,)
    assert "second pulse of 30" in found.rejected[0].detail
    assert found.rejected[0].reference == REFERENCE
    with pytest.raises(AnalysisError, match="none is left"):
        estimate([changed(spoilt(), force=np.ones((6, SAMPLES)))])


def test_places_must_share_step_and_length():
    with pytest.raises(InputError, match="same step and length for all places"):
        estimate([hits(), changed(hits(), step=2.0 * STEP)])
    with pytest.raises(InputError, match="no place"):
        estimate([])


def test_a_single_hit_has_no_coherence():
    one = hits(1)
    H, gamma = transfer(one.force, one.response)
    assert np.all(np.isnan(gamma)) and np.all(np.isfinite(H))


def test_nothing_measured_gives_zero_and_no_warning():
    H, gamma = transfer(np.zeros((2, 32)), np.zeros((2, 1, 32)), "h2")
    assert np.all(H == 0.0) and np.all(gamma == 0.0)


def test_relative_deviation_of_no_and_full_coherence():
    assert relative_deviation(np.array([1.0]), 8)[0] == 0.0
    assert np.isfinite(relative_deviation(np.array([0.0]), 8)[0])


def struck(seconds=(), noise=0.0, decay=0.0, force_decays=False):
    """Hits of a soft tip at sample 50, with second pulses (sample, part), and what an analyser's window makes of them.

    The responses are a discrete convolution with the closed impulse responses: their ratio has nothing but these.
    """
    random = np.random.default_rng(3)
    force = np.zeros((3, SAMPLES))
    for hit, height in enumerate((80.0, 100.0, 120.0)):
        for at, part in ((50, 1.0), *seconds):
            force[hit, at : at + 4] += part * height * np.array([0.4, 1.0, 0.8, 0.2])
    clean = np.stack([[np.convolve(one, h)[:SAMPLES] for h in impulse_responses()] for one in force])
    window = exponential_window(SAMPLES, STEP, decay)
    peaks = np.abs(clean).max(axis=2, keepdims=True)
    response = window * (clean + noise * peaks * random.standard_normal(clean.shape))
    shown = force * window if force_decays else force
    shown = shown + noise * 100.0 * random.standard_normal(force.shape)
    sensors = tuple(Channel(c.name, c.node, c.direction, "displacement") for c in SENSORS)
    return Hits(STEP, shown, response, REFERENCE, sensors)


def damping_of(records, decay=0.0):
    return identify(estimate([records], decay=decay).responses, band=(200.0, 900.0), order=10, modes=3).damping_ratio


@pytest.mark.parametrize("force_decays", [False, True])
@pytest.mark.parametrize("ours", [0.0, 3.0])
def test_a_window_of_the_analyser_is_taken_out(force_decays, ours):
    """With 20 1/s a mode of 310 Hz seems to have more than twice its damping; declared, it has what it has."""
    decay = 20.0
    there = struck(decay=decay, force_decays=force_decays)
    wrong = damping_of(there, ours)
    np.testing.assert_allclose(wrong, DAMPING + decay / OMEGA, rtol=0.01)  # of second order in the damping
    declared = changed(there, decay=decay, force_decays=force_decays)
    # A sampled impulse response has aliases, which are none of a continuous one.
    np.testing.assert_allclose(damping_of(declared, ours), DAMPING, rtol=1e-3)


def test_windows_of_all_places_are_one():
    with pytest.raises(InputError, match=r"been through windows of none, 0\.05 s; allowed: one for all places"):
        estimate([struck(), changed(struck(decay=20.0), decay=20.0)])
    with pytest.raises(InputError, match=r"hits at .*, decay: got -1\.0 1/s; allowed: finite"):
        changed(struck(), decay=-1.0)


def test_a_small_second_hit_is_taken_with_the_first():
    """A bounce of 9 % bends the damping by percents where the force forgets it."""
    there = struck([(140, 0.09)], noise=1e-4)
    found = estimate([there])
    assert found.used == (3,) and len(found.bounced) == 3
    assert found.bounced[0].detail.startswith("a second pulse of 8.98 % of the first one, at 0.03")  # with noise
    np.testing.assert_allclose(damping_of(there), DAMPING, rtol=2e-3)  # noise of 1e-4
    forgotten = there.force.copy()
    forgotten[:, 100:] = 0.0
    bent = damping_of(changed(there, force=forgotten)) / DAMPING - 1.0
    assert np.max(np.abs(bent)) > 0.01
    assert estimate([struck(noise=1e-4)]).bounced == ()
    # Noise that is everywhere is no bounce.
    assert second_pulses(np.random.default_rng(0).standard_normal(500)) == []
    assert second_pulses(np.zeros(20)) == []
    silent = np.zeros(400)
    silent[[0, 200]] = 1.0, 0.05
    assert second_pulses(silent) == [(200, 0.05)]


# stabilisation


def followed(lists):
    return stabilise(
        [np.array(poles, dtype=complex) for poles in lists],
        range(1, len(lists) + 1),
        (1.0, 1000.0),
        lambda poles: np.ones((poles.size, 1), dtype=complex),
    )


def test_steady_poles_are_modes_and_wandering_ones_are_not():
    random = np.random.default_rng(0)
    steady = -10.0 + 2000.0j
    lists = [
        [steady * (1.0 + 1e-4 * random.standard_normal()), -5.0 + 1j * random.uniform(10, 6000)] for _ in range(12)
    ]
    lists[4] = lists[4][1:]  # missing for an order
    found = followed(lists)
    assert found.counts == (11,)
    assert abs(found.poles[0] - steady) < 1e-3 * abs(steady)
    assert sum(entry.stable for entry in found.candidates) == 10


def test_what_low_orders_make_of_two_modes_is_none():
    lists = [[-40.0 + 2000.0j]] * 7 + [[-10.0 + 1980.0j, -10.0 + 2020.0j]] * 13
    found = followed(lists)
    np.testing.assert_allclose(found.poles, [-10.0 + 1980.0j, -10.0 + 2020.0j])


def test_growing_overdamped_and_outside_poles_are_no_candidates():
    lists = [[10.0 + 2000.0j, -1900.0 + 2000.0j, -1.0 + 1e5j, -1.0 - 2000.0j, -3.0 + 0.0j]] * 10
    found = followed(lists)
    assert found.candidates == () and found.poles.size == 0


def test_shapes_must_agree():
    """A pole whose shape is another one in each order is no mode; one whose shapes change once is one with two."""
    for shape, counts in ((lambda k: k, ()), (lambda k: k // 6, (12,))):
        turn = iter(range(12))
        found = stabilise(
            [np.array([-10.0 + 2000.0j])] * 12,
            range(1, 13),
            (1.0, 1000.0),
            lambda poles, shape=shape, turn=turn: np.eye(12, dtype=complex)[[shape(next(turn))]],
        )
        assert found.counts == counts
    assert stabilise([np.zeros(0, complex)] * 3, range(3), (1.0, 2.0), lambda poles: poles[:, None]).poles.size == 0


# the fit


@pytest.mark.parametrize(
    ("keywords", "words"),
    [
        ({"band": (500.0, 400.0)}, "band: got 500.0 Hz to 400.0 Hz"),
        ({"band": (np.nan, 400.0)}, "band: got nan Hz"),
        ({"band": (400.0, 402.0)}, "allowed: 8 or more"),
        ({"order": 0}, "order: got 0"),
        ({"order": 10**9}, "order: got 1000000000"),
        ({"modes": -1}, "modes: got -1"),
    ],
)
def test_fits_that_are_not_possible(keywords, words):
    with pytest.raises(InputError) as caught:
        identify(measured(), **keywords)
    assert words in str(caught.value)


def test_noise_has_no_modes():
    random = np.random.default_rng(1)
    noise = random.standard_normal((2, 1001)) + 1j * random.standard_normal((2, 1001))
    with pytest.raises(AnalysisError, match="no stable mode from 1 Hz to 1000 Hz"):
        identify(changed(measured(), response=noise), order=10)


def test_the_strongest_modes_are_kept():
    fit = identify(measured(noise=1e-3), band=(100.0, 900.0), order=10, modes=2)
    assert fit.poles.size == 2


def test_pieces_of_a_structure_that_are_not_there():
    silent = changed(measured(), response=measured().response * np.array([[1.0], [0.0]]))
    fit = identify(silent)
    np.testing.assert_allclose(fit.poles, POLES, rtol=1e-6)  # noiseless: round-off of the fit
    assert fit.error[1] == 0.0


# p-LSCF


def test_uneven_lines_are_fitted():
    """The library wants the lines of a transform: those of a stepped sine are interpolated for it, not for the fit."""
    there = measured(noise=1e-3)
    lines = np.geomspace(200.0, 900.0, 700)
    responses = responses_at(2j * np.pi * lines)
    uneven = changed(there, frequency=lines, response=responses, coherence=np.full(responses.shape, np.nan))
    np.testing.assert_allclose(identify(uneven, order=12).poles, POLES, rtol=1e-8)  # noiseless, refined: round-off


def test_libraries_that_are_missing(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "sdypy.EMA", None)
    monkeypatch.setitem(sys.modules, "pyuff", None)
    with pytest.raises(DependencyError, match=r"the package sdypy-EMA cannot be loaded .*ehdmaps\[modal\]"):
        identify(measured())
    with pytest.raises(DependencyError, match=r"the package pyuff cannot be loaded .*ehdmaps\[modal\]"):
        read_uff(tmp_path / "a.uff")


# universal files


def test_hits_come_back(tmp_path):
    path = tmp_path / "hits.uff"
    first = hits(3, noise=0.01)
    second = changed(first, reference=Channel("a place with a long name", 7, 0, "force"))
    write_uff(path, Measurement("title ü", (first, second)))
    back = read_uff(path)
    assert back.title == "title ?" and back.responses is None and back.notes == ()
    for there, here in zip(back.hits, (first, second), strict=True):
        np.testing.assert_allclose(there.step, here.step, rtol=5e-6)  # six digits of the step
        np.testing.assert_allclose(there.force, here.force, rtol=1e-10, atol=1e-12)  # twelve digits of a value
        np.testing.assert_allclose(there.response, here.response, rtol=1e-10, atol=1e-16)
        assert [c.quantity for c in there.sensors] == ["displacement", "displacement"]
    assert back.hits[1].reference.name == "a place wi"


def test_windows_of_hits_come_back(tmp_path):
    path = tmp_path / "a.uff"
    for force_decays in (False, True):
        write_uff(path, Measurement("", (changed(hits(2), decay=2.5, force_decays=force_decays),)))
        back = read_uff(path).hits[0]
        assert (back.decay, back.force_decays) == (2.5, force_decays)
    text = path.read_text().replace("exponential window, decay 2.5 1/s", "exponential window, decay 3.5 1/s", 2)
    path.write_text(text)
    with pytest.raises(InputError, match="got records with different exponential windows"):
        read_uff(path)


QUALIFIERS = """
record_num octave_format measurement_run weighting_type amplitude_units normalization_method
abscissa_data_type_qualifier ordinate_numerator_data_type_qualifier ordinate_denominator_data_type_qualifier
z_axis_data_type_qualifier sampling_type z_rpm_value z_time_value z_order_value num_of_samples user_value_1
user_value_2 user_value_3 user_value_4 exponential_window_damping_factor
"""
"""Fields of a dataset 1858 as pyuff names them."""


def test_a_window_that_the_file_tells_of(tmp_path):
    import pyuff

    path = tmp_path / "a.uff"
    write_uff(path, Measurement("", (hits(2),)))
    qualifiers = dict.fromkeys(QUALIFIERS.split(), 0) | {"type": 1858, "window_type": 6}
    pyuff.UFF(str(path)).write_sets(qualifiers | {"response_direction": "Z+", "reference_direction": "Z+"}, mode="add")
    assert "dataset 1858: records have been through an exponential window" in read_uff(path).notes[0]
    path.write_text(path.read_text().replace("  1858", "  1858\nx"))
    assert read_uff(path).hits[0].decay == 0.0


def test_responses_come_back(tmp_path):
    path = tmp_path / "frf.uff"
    there = changed(measured(decay=2.5), coherence=np.stack([np.full(1001, np.nan), np.linspace(0.0, 1.0, 1001)]))
    write_uff(path, Measurement("", (), there))
    back = read_uff(path).responses
    np.testing.assert_allclose(back.response, there.response, rtol=1e-10, atol=1e-22)
    np.testing.assert_allclose(back.coherence, there.coherence, atol=1e-11)
    assert (back.decay, back.derivatives, back.labels) == (2.5, (0, 2), there.labels)
    assert back.pairs == there.pairs


def test_uneven_lines_come_back(tmp_path):
    there = measured()
    there = changed(there, frequency=there.frequency + 0.2 * np.sin(there.frequency))
    write_uff(tmp_path / "a.uff", Measurement("", (), there))
    back = read_uff(tmp_path / "a.uff").responses
    np.testing.assert_allclose(back.frequency, there.frequency, rtol=5e-6, atol=5e-6)  # six digits of the abscissa


def test_units_of_the_file_are_respected(tmp_path):
    path = tmp_path / "a.uff"
    moment = Channel("m", 4, 6, "force")
    pairs = ((SENSORS[0], REFERENCE), (SENSORS[1], moment))
    there = changed(measured(), pairs=pairs)
    write_uff(path, Measurement("", (), there))
    millimetre = path.read_text().replace(
        "   1.0000000000000000D+00   1.0000000000000000D+00", "   1.0000000000000000D+03   2.0000000000000000D+00", 1
    )
    (tmp_path / "mm.uff").write_text(millimetre)
    back = read_uff(tmp_path / "mm.uff").responses
    # In mm and half newtons: displacement per force shrinks by 1000/2, acceleration per moment by 1000/(2 1000).
    np.testing.assert_allclose(back.response, there.response / np.array([[500.0], [0.5]]), rtol=1e-10, atol=1e-20)


def test_a_file_without_units_is_taken_for_si_and_says_so(tmp_path):
    import pyuff

    path = tmp_path / "a.uff"
    write_uff(path, Measurement("", (), measured()))
    sets = [entry for entry in pyuff.UFF(str(path)).read_sets() if entry["type"] == 58]
    sets.append(sets[0] | {"func_type": 9})
    for entry in sets:
        entry["data"], entry["x"] = np.array(entry["data"]), np.array(entry["x"])
    pyuff.UFF(str(tmp_path / "b.uff")).write_sets(sets, mode="overwrite")
    back = read_uff(tmp_path / "b.uff")
    assert back.notes == ("no dataset 164: values are taken for SI", "1 functions of type 9 are left out")


def test_hits_are_counted_by_their_order_where_the_file_does_not(tmp_path):
    path = tmp_path / "a.uff"
    write_uff(path, Measurement("", (hits(3),)))
    text = path.read_text()
    for hit in (1, 2, 3):
        text = text.replace(f"    1         0{hit:5d}         0", "    1         0    0         0")
    path.write_text(text)
    np.testing.assert_allclose(read_uff(path).hits[0].force[:, 0], hits(3).force[:, 0], rtol=1e-10)


WIDTHS = {
    # real single and double, complex single and double; width of an abscissa and of a value, pairs or values a line
    (2, True): (0, 13, 6), (4, True): (0, 20, 4), (5, True): (0, 13, 3), (6, True): (0, 20, 2),
    (2, False): (13, 13, 3), (4, False): (13, 20, 2), (5, False): (13, 13, 2),
}  # fmt: skip


def block(form, even, function, kind, axis, values, fill):
    """Text of a dataset 58, as the format is published; its last line filled up with zeros, or not."""
    across, width, a_line = WIDTHS[form, even]
    lost = -len(axis) % a_line if fill else 0
    rows = zip([*axis, *[0.0] * lost], [*values, *[0.0] * lost], strict=True)
    parts = [
        (f"{x:13.5E}" if across else "")
        + "".join(f"{part:{width}.{width - 8}E}" for part in ((v.real, v.imag) if form > 4 else (v.real,)))
        for x, v in rows
    ]
    lines = ["".join(parts[k : k + a_line]) for k in range(0, len(parts), a_line)]
    place = f"{'NONE':10s}{1:10d}{3:4d}"
    head = ["    -1", "    58", *["NONE"] * 5, f"{function:5d}{0:10d}{1:5d}{0:10d} {place} {place}"]
    head.append(f"{form:10d}{len(axis):10d}{even:10d}{axis[0]:13.5E}{axis[1] - axis[0]:13.5E}{0:13.5E}")
    head += [f"{t:10d}{0:5d}{0:5d}{0:5d} {'NONE':20s} {'NONE':20s}" for t in (17, kind, 13 * (function == 4), 0)]
    return "\n".join([*head, *lines, "    -1", ""])


@pytest.mark.parametrize(("form", "even"), WIDTHS)
def test_a_last_line_that_is_filled_up_is_cut_off(tmp_path, form, even):
    axis = 0.5 * np.arange(31.0)
    values = np.sin(axis + 1.0) + (1j * np.cos(axis) if form > 4 else 0.0)
    for fill in (False, True):
        path = tmp_path / f"{fill}.uff"
        if form > 4:
            path.write_text(block(form, even, 4, 12, axis, values, fill))
            found, there = read_uff(path).responses.response[0], read_uff(path).responses.frequency
        else:
            path.write_text("".join(block(form, even, 1, kind, axis, values, fill) for kind in (13, 12)))
            found, there = read_uff(path).hits[0].response[0, 0], read_time_uff(path).records[0].time
            np.testing.assert_array_equal(read_time_uff(path).records[0].values[:, 1], found)
        np.testing.assert_allclose(found, values, atol=5e-6)  # six digits of single precision
        np.testing.assert_allclose(there, axis, atol=1e-9)
    # A whole line more is no filling.
    text = path.read_text().replace(f"{31:10d}{int(even):10d}", f"{31 - WIDTHS[form, even][2]:10d}{int(even):10d}")
    path.write_text(text)
    with pytest.raises(InputError, match="of another record"):
        read_uff(path)


def hostile(folder):
    """Files that are none, with what is said about them."""
    good = folder / "good.uff"
    write_uff(good, Measurement("x", (hits(2, samples=64),)))
    text = good.read_text()
    blocks = text.split("    -1\n    -1\n")
    first_value = next(line for line in text.splitlines() if line.count("e+") == 4)
    force_type = "        13    0    1    0"
    return {
        "": "no datasets 58",
        "    -1\n" * 100_000: "no datasets 58",
        "\x00\xff" * 5000: "no datasets 58",
        text[: len(text) // 2]: "the file is cut off",
        text.replace(first_value + "\n", "", 1): "as its header says; the file is cut off",
        text.replace(first_value, " " * 17 + "nan" + first_value[20:], 1): "values that are not finite",
        text.replace("2.44141e-04", "0.00000e+00"): "an abscissa that does not rise",
        text.replace("        64         1", "      9999         1", 1): "as its header says",
        text.replace("1.0000000000000000D+00", "0.0000000000000000D+00"): "dataset 164: got the factors 0",
        text.replace("1.0000000000000000D+00", "x.0000000000000000D+00"): "dataset 2, of type 164, cannot be read",
        text.replace(force_type, "         8    1    0    0"): "0 of a force",
        "    -1\n    -1\n".join(blocks[:-1]) + "    -1\n": "allowed: one of each for each hit",
        "    -1\n    -1\n".join(blocks[:2]) + "    -1\n": "none of them a time record",
    }


def test_hostile_files(tmp_path):
    path = tmp_path / "hostile.uff"
    for text, words in hostile(tmp_path).items():
        path.write_text(text)
        with pytest.raises(InputError) as caught:
            read_uff(path)
        assert words in str(caught.value), text[:200]


def test_files_that_cannot_be_read_or_written(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_uff(tmp_path / "nowhere.uff")
    with pytest.raises(InputError, match=r"cannot be read \(it is a folder\); allowed: a universal file"):
        read_uff(tmp_path)
    huge = tmp_path / "huge.uff"
    with huge.open("wb") as file:
        file.truncate(LARGEST + 1)
    with pytest.raises(InputError, match=r"longer than 536870912 bytes .*; allowed: a universal file"):
        read_uff(huge)
    with pytest.raises(InputError, match="no is no folder"):
        write_uff(tmp_path / "no" / "a.uff", Measurement("", (hits(1),)))
    bad = hits(1)
    bad.response[0, 0, 0] = np.inf
    with pytest.raises(InputError, match="not finite"):
        write_uff(tmp_path / "a.uff", Measurement("", (bad,)))
    assert not (tmp_path / "a.uff").exists()


def test_sensors_that_share_a_place_are_told_apart(tmp_path):
    there = hits(2)
    names = ("accelerometer left", "accelerometer right")
    there = changed(there, sensors=tuple(Channel(name, 1, 2, "acceleration") for name in names))
    write_uff(tmp_path / "a.uff", Measurement("", (there,)))
    back = read_uff(tmp_path / "a.uff").hits[0]
    assert len({sensor.name for sensor in back.sensors}) == 2
    np.testing.assert_allclose(back.response, there.response, rtol=1e-10, atol=1e-16)

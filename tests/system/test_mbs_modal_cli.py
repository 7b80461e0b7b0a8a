"""`mbs hammer` and `mbs modal-fit` as a person or a script meets them."""

from __future__ import annotations

import dataclasses
import multiprocessing
import os
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from ehdmaps.outputs import MARK
from mbs.modal.uff import read_uff
from mbs.scene.reader import read_scene
from tests.cases.commands import run
from tests.cases.modal import DAMPING, FREQUENCY, hits, measured

LAWS = ("hertz", "constant:cfd")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(path, **what):
    from mbs.modal.uff import Measurement, write_uff

    write_uff(path, Measurement("a case", what.get("hits", ()), what.get("responses")))


def test_several_laws_side_by_side(here, capsys):
    """Each law has a file of its own, the same as alone and however many processes there are."""
    options = ("--nonlinear", "--hits", "1", "--duration", "25 ms", "--highest", "3 kHz")
    status, out, err = run(
        capsys, "hammer", "nu308_rigid", *(part for law in LAWS for part in ("--law", law)), *options,
        "--workers", "2", "-o", "h.uff",
    )  # fmt: skip
    assert status == 0
    assert "2 of 2 hits" in err
    assert out.count("  case: ") == 2
    for k, law in enumerate(LAWS):
        assert f"h-{k + 1}.uff: written" in out
        assert run(capsys, "hammer", "nu308_rigid", "--law", law, *options, "-o", f"alone{k}.uff")[0] == 0
        beside, alone = read_uff(Path(f"h-{k + 1}.uff")).hits[0], read_uff(Path(f"alone{k}.uff")).hits[0]
        np.testing.assert_array_equal(beside.response, alone.response)
    assert not Path("h.uff").exists()
    Path("h-2.uff").write_text("my own\n")
    given = ("hammer", "nu308_rigid", "--law", LAWS[0], "--law", LAWS[1], *options, "-o", "h.uff")
    status, _, err = run(capsys, *given)
    assert status == 2
    assert "h-2.uff, which is there and is not" in err


def test_from_a_scene_to_its_modes(here, capsys):
    scene = ("nu308_rigid", "--law", "constant:cfd")
    status, out, err = run(capsys, "hammer", *scene, "--highest", "3 kHz", "--hits", "4", "-o", "h.uff")
    assert (status, err) == (0, "")
    assert "4 hits at each of 1 places, 2 sensors, linearised at the equilibrium" in out
    assert "standard deviation 1 % of the peak of each channel" in out
    assert "1606.39 Hz   damping ratio 0.00419" in out
    again = ("modal-fit", "h.uff", "--band", "1.3 kHz", "1.9 kHz", "--order", "16")
    files = ("-o", "fit.nc", "--plot", "fit.png", "--responses", "frf.uff")
    status, out, err = run(capsys, *again, *files)
    assert (status, err) == (0, "")
    for words in ("4 of 4 averaged", "estimator H1", "had not decayed", "p-LSCF, orders 1 to 16", "frf.uff: written"):
        assert words in out
    with xr.open_dataset("fit.nc") as data:
        for name, variable in data.data_vars.items():
            assert "long_name" in variable.attrs, name
            assert "units" in variable.attrs or variable.dtype.kind in "OUS", name
        # five standard deviations of what the noise of 1 % does, which the fit states, and half of the last digit; at
        # most 0.1 % and 5 %, what a test with so much noise is asked for
        for name, true, digit, most in (
            ("frequency", [1606.39, 1630.23], 0.01, 0.001),
            ("damping_ratio", [0.004191, 0.004254], 1e-6, 0.05),
        ):
            value = data[name].values
            room = 5.0 * data[f"{name}_uncertainty"].values + 0.5 * digit
            assert np.all(np.abs(value - true) < np.minimum(room, most * np.array(true)))
        assert np.all(data["coherence"] <= 1.0)
        found = data["damping_ratio"].values
    assert (here / "fit.png").stat().st_size > 50_000
    # The responses of the first command, window and all, give the same again; without coherence of single lines lost.
    status, out, _ = run(capsys, "modal-fit", "frf.uff", "--band", "1.3 kHz", "1.9 kHz", "--order", "16", "-o", "b.nc")
    assert status == 0 and "taken out of the damping" in out
    with xr.open_dataset("b.nc") as data:
        np.testing.assert_allclose(data["damping_ratio"], found, rtol=0.03)


def test_measured_hits(here, capsys):
    write(here / "a.uff", hits=(hits(5, noise=0.005),))
    status, out, _ = run(
        capsys, "modal-fit", "a.uff", "--band", "200 Hz", "900 Hz", "--estimator", "h2", "--window-decay", "0.1 s"
    )
    assert status == 0
    assert "estimator H2; window: exponential window of 0.1 s" in out
    for frequency in FREQUENCY:
        assert any(abs(float(line.split()[1]) / frequency - 1.0) < 1e-3 for line in out.splitlines() if is_mode(line))


def is_mode(line):
    return len(line.split()) == 6 and line.split()[0].isdigit()


def test_measured_responses(here, capsys):
    write(here / "a.uff", responses=measured(noise=0.01))
    options = ("--band", "200 Hz", "900 Hz", "--window-decay", "none", "--modes", "1", "--no-refine")
    status, out, _ = run(capsys, "modal-fit", "a.uff", *options)
    assert status == 1  # one mode of three leaves too much
    assert "medians over the orders" in out and "more than 20 %" in out
    assert len([line for line in out.splitlines() if is_mode(line)]) == 1


def test_a_wrong_window_is_a_wrong_damping(here, capsys):
    write(here / "a.uff", responses=measured(decay=5.0))
    status, out, _ = run(capsys, "modal-fit", "a.uff", "--band", "200 Hz", "900 Hz", "--window-decay", "none")
    ratios = [float(line.split()[3]) for line in out.splitlines() if is_mode(line)]
    # Left in, 1/tau adds 1/(tau omega).
    np.testing.assert_allclose(ratios, DAMPING + 5.0 / (2.0 * np.pi * FREQUENCY), rtol=5e-3)
    assert status == 0


def test_windows_of_an_analyser_are_declared(here, capsys):
    """By a time constant or by what is left at the end, of hits as of responses."""
    there = hits(3, noise=1e-4)
    decay = np.log(100.0) / there.duration
    window = np.exp(-decay * there.step * np.arange(there.force.shape[1]))
    write(here / "a.uff", hits=(dataclasses.replace(there, response=there.response * window),))
    write(here / "b.uff", responses=measured(decay=decay))
    for name, given, words in (
        ("a.uff", "1 %", "the responses have been through a window of 0.2171 s, taken out of the damping"),
        ("a.uff", f"{1.0 / decay:.6g} s", "taken out of the damping"),
        ("b.uff", "1 %", "exponential window of 0.2171 s taken out of the damping"),
    ):
        status, out, err = run(capsys, "modal-fit", name, "--band", "200 Hz", "900 Hz", "--windowed", given)
        assert status == 0, err
        assert words in out
        ratios = [float(line.split()[3]) for line in out.splitlines() if is_mode(line)]
        np.testing.assert_allclose(ratios, DAMPING, rtol=3e-3)  # noise of 1e-4, aliases
    bounced = there.force.copy()
    bounced[1, 900] = 0.05 * bounced[1, 0]
    write(here / "c.uff", hits=(dataclasses.replace(there, force=bounced),))
    out = run(capsys, "modal-fit", "c.uff", "--band", "200 Hz", "900 Hz")[1]
    assert "hit 2 at hammer:1+y bounced: a second pulse of 5 % of the first one, at 0.2197 s, taken with it" in out


@pytest.mark.slow
def test_nonlinear_hits(here, capsys):
    options = ("--nonlinear", "--highest", "3 kHz", "--duration", "10 ms", "--hits", "1", "-o", "a.uff")
    status, out, _ = run(capsys, "hammer", "nu308_rigid", *options)
    assert status == 0
    assert "1 hits at each of 1 places, 2 sensors, nonlinear" in out
    assert (here / "a.uff").stat().st_size > 5_000


def test_no_mode_is_status_1(here, capsys):
    silent = measured()
    random = np.random.default_rng(0)
    silent.response[:] = random.standard_normal(silent.response.shape)
    write(here / "a.uff", responses=silent)
    status, out, err = run(capsys, "modal-fit", "a.uff", "--order", "8")
    assert (status, out) == (1, "")
    assert "mbs modal-fit: 1 problem" in err and "no stable mode" in err


@pytest.mark.slow
def test_bad_input_lists_every_problem_and_writes_nothing(here, capsys):
    text = read_scene("nu308_rigid").text
    (here / "a.toml").write_text(text[: text.index("[[inputs]]")])
    (here / "b.uff").write_text("nothing")
    write(here / "c.uff", responses=measured())
    before = sorted(here.iterdir())
    for arguments, words in (
        (("modal-fit", "nowhere.uff"), ("nowhere.uff: cannot be read",)),
        (("modal-fit", "b.uff"), ("no datasets 58",)),
        (
            ("modal-fit", "b.uff", "--band", "5 kHz", "3", "--window-decay", "5 Hz", "-o", "no/a.nc"),
            ("--band: got '3' without a unit", "--window-decay: got the unit 'Hz'", "-o: got no/a.nc"),
        ),
        (("modal-fit", "b.uff", "--band", "5 kHz", "1 kHz"), ("allowed: rising",)),
        (("modal-fit", "b.uff", "--window-decay", "0 s"), ("above 0 s, or none",)),
        (
            ("modal-fit", "b.uff", "--windowed", "0 s"),
            ("--windowed: got '0 s'; allowed: above 0 s, or what it leaves",),
        ),
        (("modal-fit", "b.uff", "--windowed", "100 %"), ("--windowed: got '100 %'; allowed: above 0 %, below 100 %",)),
        (("modal-fit", "b.uff", "--windowed", "x %"), ("--windowed: got 'x %'",)),
        (("modal-fit", "b.uff", "--windowed", "1 s", "x"), ("--windowed: got 'x' behind the time; allowed: force",)),
        (
            ("modal-fit", "c.uff", "--windowed", "1 s", "--window-decay", "1 s"),
            ("--window-decay, --windowed: got both for frequency responses",),
        ),
        (("hammer", "a.toml", "-o", "h.uff"), ("[[inputs]] missing", "[[sensors]] missing")),
        (("hammer", "nu308_rigid", "-o", "h.uff", "--hits", "0", "--noise", "7"), ("hits: got 0", "noise: got 7.0")),
        (
            ("hammer", "nu308_rigid", "-o", "no/h.uff", "--highest", "0 Hz"),
            ("above 0 Hz", "-o: got no/h.uff, but no is no folder"),
        ),
        (("hammer", "nu308_rigid", "--plot", "a.png"), ("records are not drawn", "-o: missing")),
        (("hammer", "nowhere", "-o", "h.uff"), ("shipped system",)),
    ):
        status, out, err = run(capsys, *arguments)
        assert (status, out) == (2, ""), arguments
        for word in words:
            assert word in err
    assert sorted(here.iterdir()) == before


def test_no_output_is_written_over_what_was_measured(here, capsys):
    assert run(capsys, "hammer", "n1014_testrig", "--law", "hertz", "-o", "hits.uff", "--hits", "1")[0] == 0
    measured = (here / "hits.uff").read_bytes()
    os.link(here / "hits.uff", here / "again.uff")
    (here / "other.uff").write_bytes(measured.replace(MARK.encode(), b"a test rig     "))
    for option, name, words in (
        ("-o", "hits.uff", "written over hits.uff, which is read"),
        ("--responses", "hits.uff", "written over hits.uff, which is read"),
        ("--responses", "again.uff", "written over hits.uff, which is read"),
        ("--responses", "other.uff", "is not a universal file of mbs"),
        ("--plot", "hits.uff", "allowed: a file that ends in .png"),
    ):
        status, out, err = run(capsys, "modal-fit", "hits.uff", option, name)
        assert (status, out) == (2, "")
        assert words in err
    assert (here / "hits.uff").read_bytes() == measured
    status, _, err = run(capsys, "hammer", "n1014_testrig", "-o", "other.uff")
    assert status == 2 and "is not a universal file of mbs" in err


def _write_often(seed):
    for _ in range(5):
        write("same.uff", hits=(hits(1, seed=seed),))


def test_several_processes_leave_a_whole_file(here):
    context = multiprocessing.get_context("fork")
    writers = [context.Process(target=_write_often, args=(seed,)) for seed in range(4)]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join()
        assert writer.exitcode == 0
    assert len(read_uff(here / "same.uff").hits) == 1
    assert os.listdir(here) == ["same.uff"]

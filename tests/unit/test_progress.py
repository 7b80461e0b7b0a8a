import io
import sys

import pytest
from numba import njit

from ehdmaps.compiling import NOTE, Compiling
from ehdmaps.jobs.make import status
from ehdmaps.jobs.make.status import Bar, Lines, Pace, duration


class Clock:
    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_nobody_knows_the_pace_before_the_third_piece_of_work():
    clock = Clock()
    pace = Pace(100, clock)
    pace.taken_over(10)
    assert (pace.rate, pace.seconds_left, pace.text("point")) == (None, None, "")
    clock.now += 26.0  # compiles
    pace.solved(1)
    assert (pace.rate, pace.seconds_left, pace.text("point")) == (None, None, "")
    clock.now += 2.0
    pace.solved(4)
    assert (pace.rate, pace.seconds_left, pace.text("point")) == (None, None, "")
    clock.now += 2.0
    pace.solved(4)
    assert (pace.rate, pace.seconds_left) == (2.0, 40.5)
    assert pace.text("step") == "2 steps/s, 40 s left"


def test_no_time_left_is_told_while_a_later_piece_of_work_compiles():
    clock = Clock()
    pace = Pace(100_000, clock)
    told = []
    for seconds in (15.0, 12.0, 0.01, 0.01, 0.01):  # two processes compile, one after the other
        clock.now += seconds
        pace.solved(1)
        told.append(pace.text("point"))
    assert told == [""] * 5  # else 14 days
    for _ in range(10_000):
        clock.now += 0.01
        pace.solved(1)
    assert pace.rate == pytest.approx(89.3, rel=1e-3)  # 10,004 in 112.03 s; rounding of the number here
    clock.now += 200.0
    pace.solved(1)
    assert pace.text("point") == ""


def test_what_is_told_in_one_go_is_one_piece_of_work():
    clock = Clock()
    pace = Pace(3000, clock)
    clock.now += 10.0
    for _ in range(1000):
        clock.now += 1e-6
        pace.solved(1)
    assert pace.rate is None
    for _ in range(2):
        assert pace.rate is None
        clock.now += 2.0
        pace.solved(500)
        clock.now += 1e-12
        pace.solved(500)
    assert pace.rate == pytest.approx(500.0, rel=1e-12)  # round-off


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.0, "0 s"), (119.0, "119 s"), (121.0, "2.0 min"), (7000.0, "117 min"), (7300.0, "2.0 h"), (1e6, "12 days")],
)
def test_durations_are_readable(seconds, text):
    assert duration(seconds) == text


@pytest.mark.parametrize("unit", ["point", "step", "hit"])
def test_progress_on_a_terminal_is_a_bar(monkeypatch, unit):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    bar = status.progress(100, unit)
    assert isinstance(bar, Bar)
    bar.taken_over(40)
    bar.solved(60)
    assert f"40/100 {unit}s" in terminal.getvalue() and f"100/100 {unit}s" in terminal.getvalue()


def test_a_bar_knows_its_pace_from_the_third_piece_of_work_on(monkeypatch):
    clock, terminal = Clock(), Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    bar = Bar(100, "step")
    bar._pace = Pace(100, clock)
    bar.begin()
    for seconds in (30.0, 1.0, 1.0):
        clock.now += seconds
        bar.solved(10)
        bar._bar.refresh()
    lines = terminal.getvalue().split("\r")
    assert not any("left" in line for line in lines if any(f" {done}/100" in line for done in (0, 10, 20)))
    assert "10 steps/s, 7 s left" in terminal.getvalue()
    bar._bar.close()


@pytest.mark.parametrize("unit", ["point", "step", "hit"])
def test_progress_elsewhere_is_lines(monkeypatch, capsys, unit):
    monkeypatch.setattr(status, "LINE_SECONDS", 0.0)
    lines = status.progress(12, unit)
    assert isinstance(lines, Lines)
    clock = Clock()
    lines._pace = Pace(12, clock)
    lines.taken_over(4)
    for _ in range(4):
        clock.now += 0.5
        lines.solved(2)
    err = capsys.readouterr().err.splitlines()
    assert err == [
        f"4 of 12 {unit}s taken over",
        f"6 of 12 {unit}s",
        f"8 of 12 {unit}s",
        f"10 of 12 {unit}s, 4 {unit}s/s, 0 s left",
        f"12 of 12 {unit}s, 4 {unit}s/s, 0 s left",
    ]


class Broken(Terminal):
    def write(self, text):
        raise OSError("no space left on device")


@pytest.mark.parametrize("stream", [None, Broken()], ids=["closed", "full"])
@pytest.mark.parametrize("kind", [Bar, Lines])
def test_nobody_to_tell_is_no_reason_to_stop(monkeypatch, stream, kind):
    monkeypatch.setattr(sys, "stderr", stream)
    if kind is Bar and stream is None:
        assert isinstance(status.progress(2), Lines)
        return
    told = kind(2)
    told.taken_over(0)
    told.solved(1)
    told.solved(1)


def test_what_this_process_compiles_is_said_once_and_counts_for_no_rate():
    clock, said = Clock(), []
    compiling = Compiling(said.append, clock)
    pace = Pace(100, clock, lambda: compiling.seconds)
    for _ in range(3):
        clock.now += 1.0
        pace.solved(1)
    compiling.on_start(None)
    clock.now += 0.9
    compiling.on_start(None)  # a function that the first one calls
    clock.now += 500.0
    assert said == []
    compiling.on_end(None)
    compiling.on_start(None)
    assert said == [NOTE]
    compiling.on_end(None)
    compiling.on_end(None)
    clock.now += 1.0
    pace.solved(1)
    assert compiling.seconds == pytest.approx(500.9)
    assert pace.text("step") == "1 steps/s, 96 s left"  # one a second, as before


def test_numba_is_heard_while_it_compiles(capsys):
    heard = []
    compiling = Compiling(heard.append)
    compiling.listen()
    njit(lambda x: x + 1.0)(1.0)
    spent = compiling.seconds
    compiling.end()
    compiling.end()  # of no harm
    njit(lambda x: x + 2.0)(1.0)
    assert spent > 0.0
    assert compiling.seconds == spent
    assert heard == []  # that was no long wait

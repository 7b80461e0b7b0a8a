"""Cases in processes of their own: order, progress, errors, dead processes, Ctrl-C."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time

import pytest

from ehdmaps.errors import AnalysisError, InputError
from mbs.analyses.case import Failed, side_by_side
from tests.cases.interruptible import start

LAMBDA = {"a function that cannot be pickled": lambda value: value * value}


def square(index, told):
    told(1)
    time.sleep(0.02 * (3 - index % 4))  # later ones are done before
    told(2)
    return os.getpid(), LAMBDA["a function that cannot be pickled"](index)


def name(index):
    return f"case {index}"


@pytest.mark.parametrize("workers", [1, 3])
def test_results_are_the_same_in_the_same_order(workers):
    told = []
    found = list(side_by_side(square, range(6), [2] * 6, workers, lambda done, total: told.append((done, total)), name))
    assert [value for _, value in found] == [0, 1, 4, 9, 16, 25]
    assert len({pid for pid, _ in found}) == (1 if workers == 1 else 6)
    assert (os.getpid() in {pid for pid, _ in found}) == (workers == 1)
    assert told == sorted(told)
    assert (told[0], told[-1]) == ((0, 12), (12, 12))


@pytest.mark.parametrize("workers", [1, 2])
def test_errors_of_this_distribution_are_results(workers):
    def work(index, told):
        if index == 1:
            raise InputError(["one problem", "another"])
        return index

    found = list(side_by_side(work, range(3), [1, 1, 1], workers, None, name))
    assert isinstance(found[1], Failed)
    assert isinstance(found[1].error, InputError)
    assert found[1].error.problems == ("one problem", "another")
    assert found[::2] == [0, 2]


@pytest.mark.parametrize("workers", [1, 2])
def test_other_exceptions_are_bugs(workers):
    def work(index, told):
        raise ZeroDivisionError("nobody thought of it")

    with pytest.raises(ZeroDivisionError, match="nobody thought of it"):
        list(side_by_side(work, range(3), [1, 1, 1], workers, None, name))


def test_a_process_that_dies_costs_its_own_case():
    def work(index, told):
        if index == 1:
            os.kill(os.getpid(), signal.SIGKILL)
        return index

    found = list(side_by_side(work, range(3), [1, 1, 1], 2, None, name))
    assert found[::2] == [0, 2]
    assert isinstance(found[1].error, AnalysisError)
    assert str(found[1].error) == (
        "case 1: its process died (killed, or out of memory); the same command tries again, with --workers 1 in one "
        "process"
    )


def test_leaving_early_ends_all():
    def work(index, told):
        if index:
            time.sleep(60.0)
        return os.getpid()

    found = side_by_side(work, range(3), [1, 1, 1], 3, None, name)
    begin = time.monotonic()
    next(found)
    found.close()
    assert time.monotonic() - begin < 20.0


INTERRUPTED = """
import os, time
from mbs.analyses.case import side_by_side

def work(index, told):
    os.write(1, f"{os.getpid()}\\n".encode())
    time.sleep(60.0)

try:
    list(side_by_side(work, range(2), [1, 1], 2, None, str))
except KeyboardInterrupt:
    print("stopped", flush=True)
"""


def test_ctrl_c_ends_all_processes():
    child = start([sys.executable, "-c", INTERRUPTED], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    workers = [int(child.stdout.readline()) for _ in range(2)]
    stopping = threading.Timer(60.0, child.kill)
    stopping.start()
    child.send_signal(signal.SIGINT)
    out, err = child.communicate()
    stopping.cancel()
    assert (out, err, child.returncode) == ("stopped\n", "", 0)
    for pid in workers:
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)

import os
import random
import signal
import subprocess
import sys
import threading
import time

import pytest

from ehdmaps.interrupts import careful_interrupts, deaf_children
from ehdmaps.workers import start_worker
from tests.cases.interruptible import start

LOOP = """
import sys
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.interrupts import careful_interrupts
from ehdmaps.jobs.reader import read_job
from ehdmaps.jobs.make.tasks import line_tasks

job = read_job("nu308")
task = line_tasks(job, ReynoldsSolver())[0]
task.run()
with careful_interrupts():
    for trial in range(TRIALS):
        try:
            print("solving", flush=True)
            while True:
                task.run()
        except KeyboardInterrupt:
            pass
print("done", flush=True)
"""


@pytest.mark.slow
def test_interrupts_at_any_moment_of_compiled_solves_do_no_harm():
    # Without care most of them end the process with a segmentation fault or a SystemError.
    trials, moments = 40, random.Random(7)
    child = start([sys.executable, "-c", LOOP.replace("TRIALS", str(trials))], stdout=subprocess.PIPE,
                  stderr=subprocess.PIPE, text=True)  # fmt: skip
    for _ in range(trials):
        if child.stdout.readline() != "solving\n":
            break
        time.sleep(moments.uniform(0.0, 0.04))
        child.send_signal(signal.SIGINT)
    out, err = child.communicate(timeout=60)
    assert (child.returncode, out, err) == (0, "done\n", "")


@pytest.fixture
def heard(monkeypatch):
    """Interrupts as a program in the foreground has them."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupt():
    signal.raise_signal(signal.SIGINT)


def test_our_own_code_is_interrupted_at_once(heard):
    reached = False
    with pytest.raises(KeyboardInterrupt), careful_interrupts():
        interrupt()
        reached = True
    assert not reached


def test_sigterm_is_heard_like_ctrl_c(heard):
    assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL
    with pytest.raises(KeyboardInterrupt), careful_interrupts() as stopped:
        assert stopped.status == 130
        signal.raise_signal(signal.SIGTERM)
    assert stopped.status == 143
    assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL


@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
def test_a_forked_process_ends_at_once_by_sigterm(heard):
    with careful_interrupts():
        child = os.fork()
        if child == 0:
            signal.raise_signal(signal.SIGTERM)
            os._exit(1)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 143


def test_delicate_code_comes_to_its_end(heard):
    places = []
    # Frames are known by the name of their module; numba calls such code without expecting an exception.
    numba = {"__name__": "numba.core.somewhere", "interrupt": interrupt, "places": places}
    ours = {"__name__": "ehdmaps.somewhere", "places": places}
    exec("def typeof():\n    interrupt()\n    places.append('numba')\n", numba)
    ours["typeof"] = numba["typeof"]
    exec("def solve():\n    typeof()\n    places.append('ours')\n", ours)
    with pytest.raises(KeyboardInterrupt), careful_interrupts():
        ours["solve"]()
    assert places == ["numba"]
    assert sys.gettrace() is None


def test_a_second_interrupt_does_not_wait():
    script = (
        "import signal, sys\nfrom ehdmaps.interrupts import careful_interrupts\n"
        "numba = {'__name__': 'numba.x', 'raise_signal': signal.raise_signal}\n"
        "exec('def compile():\\n    raise_signal(2)\\n    raise_signal(2)\\n    print(1)', numba)\n"
        "ours = {'__name__': 'mbs.x', 'compile': numba['compile']}\n"
        "exec('def work():\\n    compile()\\n', ours)\n"
        "with careful_interrupts():\n    ours['work']()\n"
    )
    child = start([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    out, err = child.communicate(timeout=60)
    assert (child.returncode, out, err) == (130, "", "\nstopped\n")


def test_ignored_interrupts_stay_ignored():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with careful_interrupts(last=True):
            interrupt()
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)  # at the end of the process it ends that at once


def test_threads_and_handlers_of_others_are_left_alone(heard):
    def mine(*_):
        raise AssertionError

    signal.signal(signal.SIGINT, mine)
    with careful_interrupts():
        assert signal.getsignal(signal.SIGINT) is mine
    signal.signal(signal.SIGINT, signal.default_int_handler)
    found = []

    def work():
        with careful_interrupts():
            found.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert found == [signal.default_int_handler]


@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
def test_a_signal_to_a_process_that_begins_waits_for_it(heard):
    """A fork forgets signals that a handler of Python has taken before it is itself; blocked ones stay."""
    with careful_interrupts(), deaf_children(signal.SIGTERM):
        child = os.fork()
        if child == 0:
            os.kill(os.getpid(), signal.SIGTERM)
            start_worker()
            os._exit(1)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == -signal.SIGTERM


def test_children_can_be_deaf(heard):
    blocked = "import signal; print(signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, []))"
    with deaf_children():
        out = subprocess.run([sys.executable, "-c", blocked], capture_output=True, text=True, check=True).stdout
    assert out == "True\n"
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, [])

"""Code that all worker processes share: who starts and ends them, how many there are, and why they died.

A process of a `worker_pool` is silent until it begins its first task: before, it runs the script of its parent again
and imports what the task needs. What Python prints of one that does not get so far is kept for the one sentence that
its parent says.

It stays beside loky, which would replace the part that starts processes. What that leaves undone is what most lines
here are for: a worker of loky goes on for as long as its task takes when its parent is killed; the error for one that
died tells its exit status, but not what it printed; nothing keeps Ctrl-C from it, or lets one say for all that it
compiles. Engines of others are another thing, see `ehdmaps.jobs.executors`.
"""

from __future__ import annotations

import contextlib
import functools
import multiprocessing
import os
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import reduction
from multiprocessing.connection import wait as wait_for_process
from multiprocessing.process import BaseProcess
from typing import IO, Any, ParamSpec, TypeVar

from ehdmaps.errors import WorkerError
from ehdmaps.interrupts import deaf_children
from ehdmaps.program import plain, tell

P = ParamSpec("P")
T = TypeVar("T")

_THREAD_VARIABLES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")

_RUN_AGAIN = "_fixup_main_from"
"""Begins the names of the functions of `multiprocessing` that run the script again: they stand in its traceback."""

_LONGEST_CAUSE = 10_000
"""Bytes at the end of what silent processes printed."""

_LONGEST_WAIT = 1.0
"""For the end of a process [s], and then for its exit status."""

_ADVICE = (
    "look after memory, limits (ulimit -a) and the libraries of this Python, or take one worker; what was solved is "
    "kept: the same command goes on"
)

_silent: list[tuple[Any, int | None]] = []
"""In a worker that has not begun a task: the count of those that have, and the stderr of its parent."""


class WorkersDied(BrokenProcessPool):
    """A process of a pool died.

    Attributes
    ----------
    begun : bool
        Whether one of the pool had begun a task.
    cause : str
        Cause of its end, in words.
    error : WorkerError
        What is said where the work ends by it: with the cause, or that it is in the script that each process runs
        again.
    """

    def __init__(self, begun: bool, cause: str, script: bool = False) -> None:
        self.begun = begun
        self.cause = cause = cause or "nobody says why"
        when = "in their first task" if begun else "before they do anything"
        text = f"worker processes die {when} ({cause}); {_ADVICE}"
        if script:
            again = getattr(sys.modules["__main__"], "__file__", "the script")
            text = (
                f"worker processes: each runs {again} again before it works, which fails ({cause}); allowed: a script "
                'that starts them under `if __name__ == "__main__":`; put that around it, or take one worker'
            )
        self.error = WorkerError(text)
        super().__init__(text)


def available_cores() -> int:
    """Return the cores that this process may use, which may be fewer than the machine has."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextlib.contextmanager
def worker_pool(workers: int) -> Iterator[WorkerPool]:
    """Start worker processes of one thread each; on any error stop them at once, else when they are done.

    Parameters
    ----------
    workers : int
        How many.

    Yields
    ------
    WorkerPool
        Takes tasks.

    Raises
    ------
    WorkersDied
        If one of them died.
    WorkerError
        If they cannot be started.
    """
    before = {name: os.environ.get(name) for name in _THREAD_VARIABLES}
    # Workers read these when they import numpy; they are spawned, so they inherit the environment of their
    # start.
    os.environ.update(dict.fromkeys(_THREAD_VARIABLES, "1"))
    try:
        with WorkerPool(workers) as pool:
            yield pool
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


class WorkerPool:
    """Worker processes; see `worker_pool`, which makes them."""

    def __init__(self, workers: int) -> None:
        self._others = set(multiprocessing.active_children())
        self._children: set[BaseProcess] = set()
        self._printed: IO[bytes] | None = None
        self._stderr: int | None = None
        with contextlib.suppress(OSError):  # no folder to write to, or a closed stderr: they are not silent then
            self._printed = tempfile.TemporaryFile()  # noqa: SIM115  # closed at the end of the pool
            self._stderr = os.dup(2)
        try:
            context = multiprocessing.get_context("spawn")
            self._begun, told = context.Value("i", 0), context.Value("b", False)
            start = functools.partial(_start_silent_worker, told, self._begun, _Inherited(self._stderr))
            self._executor = ProcessPoolExecutor(workers, context, start)
        except OSError as error:
            self._close()
            raise _not_started(error) from error

    def __enter__(self) -> WorkerPool:
        return self

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        try:
            if error is None:
                self._executor.shutdown()
            if isinstance(error, BrokenProcessPool):
                self._executor.shutdown(wait=False, cancel_futures=True)
                raise self._died() from error
        finally:
            if error is not None:
                for child in self._children:
                    child.terminate()
                # It waits for its thread, which closes a pipe that the end of the program writes to.
                self._executor.shutdown(cancel_futures=True)
            self._close()

    def submit(self, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Hand out a task; a process is started for it where none is idle.

        Parameters
        ----------
        function : callable
            What to call; picklable.
        *args, **kwargs
            Arguments of it; picklable.

        Raises
        ------
        WorkerError
            If the process cannot be started.
        """
        try:
            with deaf_children(), self._silenced():
                return self._executor.submit(_begin, function, args, kwargs)
        except OSError as error:
            raise _not_started(error) from error
        finally:
            self._children |= set(multiprocessing.active_children()) - self._others

    @contextlib.contextmanager
    def _silenced(self) -> Iterator[None]:
        """Give processes that are started in the block a stderr that is kept."""
        if self._printed is None or self._stderr is None:
            yield
            return
        os.dup2(self._printed.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(self._stderr, 2)

    def _died(self) -> WorkersDied:
        """Report why a process died, as far as it says so: the last line that it printed, or its signal."""
        ends = []
        for child in self._children:
            end = _exit_status(child)
            if end is not None and end not in (0, -signal.SIGTERM):  # by which others are ended
                ends.append(end)
        cause = next((f"signal {signal.Signals(-end).name}" for end in ends if end < 0), "")
        printed = ""
        if self._printed is not None:
            self._printed.seek(max(self._printed.seek(0, os.SEEK_END) - _LONGEST_CAUSE, 0))
            printed = self._printed.read().decode(errors="replace").strip()
        if printed:
            cause = plain(printed.splitlines()[-1].strip())[:200]
        return WorkersDied(bool(self._begun.value), cause, _RUN_AGAIN in printed)

    def _close(self) -> None:
        """Close the files."""
        if self._printed is not None:
            self._printed.close()
        if self._stderr is not None:
            os.close(self._stderr)


def _exit_status(child: BaseProcess) -> int | None:
    """Exit status of a process that ends; None while it lives.

    The thread of the executor asks the system, too: the one that asks second is told by the first, a moment later.
    """
    child.join(_LONGEST_WAIT)
    until = time.monotonic() + _LONGEST_WAIT
    while child.exitcode is None and wait_for_process([child.sentinel], 0.0) and time.monotonic() < until:
        time.sleep(0.01)
    return child.exitcode


class _Inherited:
    """A descriptor that a spawned process gets a copy of."""

    def __init__(self, descriptor: int | None) -> None:
        self._descriptor = descriptor

    def __reduce__(self) -> tuple[Any, ...]:
        return _received, (None if self._descriptor is None else reduction.DupFd(self._descriptor),)


def _received(copy: Any) -> int | None:
    """The copy, in the spawned process."""
    return None if copy is None else int(copy.detach())


def _not_started(error: OSError) -> WorkerError:
    """Make the error for processes that the system does not start."""
    return WorkerError(f"worker processes cannot be started ({error.strerror or error}); {_ADVICE}")


def start_worker(told: Any = None) -> None:
    """Leave Ctrl-C to the parent, end where it says so, and with it even when it is killed.

    Parameters
    ----------
    told : multiprocessing.Value, optional
        Whether some worker has said that it compiles: the first one does, once for all.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGTERM])
    threading.Thread(target=_end_with_parent, daemon=True).start()
    if told is not None:
        from ehdmaps.compiling import Compiling

        Compiling(lambda note: _say_once(note, told)).listen()


def _start_silent_worker(told: Any, begun: Any, stderr: Any) -> None:
    """Start a worker that says nothing before its first task."""
    _silent.append((begun, stderr))
    start_worker(told)


def _begin(function: Callable[..., T], args: tuple[Any, ...], kwargs: dict[str, Any]) -> T:
    """Do a task; the first one of a process ends its silence."""
    if _silent:
        begun, stderr = _silent.pop()
        with begun.get_lock():
            begun.value += 1
        if stderr is not None:
            sys.stderr.flush()
            os.dup2(stderr, 2)
            os.close(stderr)
    return function(*args, **kwargs)


def _say_once(note: str, told: Any) -> None:
    """Say something that no other worker has said."""
    with told.get_lock():
        first, told.value = not told.value, True
    if first:
        tell(note)


def _end_with_parent() -> None:
    """Wait for the parent's end; without this, the workers of a killed job would wait for tasks for ever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        wait_for_process([parent.sentinel])
        os._exit(1)

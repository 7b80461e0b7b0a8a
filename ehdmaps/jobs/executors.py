"""Engines of others that solve the points of a map, or compute the cases of an analysis, by a name on the command line.

=======================  ==============================================================================================
`dask:ADDRESS`           workers of a running dask scheduler, such as `dask:tcp://head:8786`
`executorlib:local`      processes of executorlib on this machine
`executorlib:slurm`      processes of executorlib in the Slurm job that the command runs in, started by `srun`
`mpi`                    ranks of `mpiexec -n N python -m mpi4py.futures -m ehdmaps generate ...`
=======================  ==============================================================================================

A task carries what it needs by value: no file is read where it runs. What is solved is kept here. A task that an engine
loses is handed out once more; after that, and where this process is stopped, the same command goes on. Workers need the
same version of ehdmaps and one thread each.
"""

from __future__ import annotations

import contextlib
import functools
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import dataclass
from typing import Any, TypeVar

from ehdmaps.errors import InputError
from ehdmaps.extras import needs
from ehdmaps.maps.kernels.kept_tables import KeptPickles, key_of
from ehdmaps.workers import available_cores

ALLOWED = "dask:ADDRESS of a scheduler, such as dask:tcp://head:8786, executorlib:local, executorlib:slurm, mpi"

_ANSWERS_WITHIN = "15s"
"""Time in which a scheduler has to answer."""

MOST_OUT = 2000
"""Tasks handed out, of an executor of which nobody knows how many workers it has."""

VARIABLE = "EHDMAPS_CASES"
"""Environment variable that names the folder of `kept_results`; ``off`` keeps nothing."""

MOST_KEPT = 200
"""Results that are kept; the oldest ones make room."""

_LOOKS = 1.0
"""Longest time between two calls of `waited` [s]."""

Item = TypeVar("Item")
Result = TypeVar("Result")


@dataclass(frozen=True)
class Lost:
    """Reason why a task has no result: its executor lost it."""

    reason: str


@dataclass(frozen=True)
class _Raised:
    """An exception of a task, which is a bug: told apart from one by which an executor says that it lost the task."""

    error: Exception


def _caught(function: Callable[[Item], Result], item: Item) -> Result | _Raised:
    """Run one task where another machine may do it."""
    try:
        return function(item)
    except Exception as error:
        return _Raised(error)


def handed_out(
    executor: Executor,
    function: Callable[[Item], Result],
    items: Sequence[Item],
    tell: Callable[[str], None],
    name: Callable[[Item], str],
    waited: Callable[[], None] = lambda: None,
) -> Generator[tuple[Item, Result | Lost], None, None]:
    """Run tasks by an executor; what it loses is handed out once more, then given up for this time.

    Parameters
    ----------
    executor : concurrent.futures.Executor
        What runs them; it stays open.
    function : callable
        What is done with each item; it and its result have to be picklable, as the items.
    items : sequence
        What the tasks are.
    tell : callable
        Told what was lost.
    name : callable
        Name of an item, for people.
    waited : callable
        Called about once a second.

    Yields
    ------
    (item, result or Lost)
        Items with their results, as these come.
    """
    waiting = deque((item, True) for item in items)
    running: dict[Future[Result | _Raised], tuple[Item, bool]] = {}
    task: Callable[[Item], Result | _Raised] = functools.partial(_caught, function)
    try:
        while waiting or running:
            while waiting and len(running) < MOST_OUT:
                try:
                    future = executor.submit(task, waiting[0][0])
                except Exception as error:  # of any kind: it is broken, or was shut down
                    reason = f"the executor takes no task any more ({error!s:.200}); the same command tries again"
                    yield from ((left, Lost(reason)) for left, _ in waiting)
                    waiting.clear()
                    break
                running[future] = waiting.popleft()
            done, _ = wait(running, timeout=_LOOKS, return_when=FIRST_COMPLETED)
            waited()
            for future in done:
                item, first = running.pop(future)
                try:
                    outcome = future.result()
                except Exception as error:  # of the executor's own kind, which is not known here
                    if first:
                        tell(f"the executor lost {name(item)} ({error!s:.200}): handed out again")
                        waiting.append((item, False))
                    else:
                        reason = f"the executor lost the task twice ({error!s:.200}); the same command tries again"
                        yield item, Lost(reason)
                    continue
                if isinstance(outcome, _Raised):
                    raise outcome.error
                yield item, outcome
    finally:
        for future in running:
            future.cancel()


def kept_results(work: Any, items: Sequence[Any]) -> KeptPickles:
    """Results that an engine computed, kept by their index until all of a command are there: a killed one goes on.

    Parameters
    ----------
    work : object
        What is done with each item.
    items : sequence
        What it is done with; the result of one that cannot be pickled is not kept.
    """
    return KeptPickles("cases", VARIABLE, MOST_KEPT, [key_of(work, item) for item in items])


def executor_problem(text: str) -> str:
    """Say what is wrong with the name of an engine; empty where nothing is.

    Parameters
    ----------
    text : str
        What was typed.

    Examples
    --------
    >>> executor_problem("executorlib:local")
    ''
    """
    engine, _, where = text.partition(":")
    good = bool(where) if engine == "dask" else text in ("executorlib:local", "executorlib:slurm", "mpi")
    return "" if good else f"--executor: got {text!r:.60}; allowed: {ALLOWED}"


@contextlib.contextmanager
def named_executor(text: str | None, workers: int | None = None) -> Iterator[Executor | None]:
    """Open the executor of an engine, and close it behind; None without a name.

    Parameters
    ----------
    text : str or None
        Name of the engine.
    workers : int or None
        Processes of executorlib or MPI; all cores if None.

    Raises
    ------
    InputError
        If the engine is unknown, or no scheduler answers.
    DependencyError
        If the package of the engine is not installed.
    """
    if text is None:
        yield None
        return
    if problem := executor_problem(text):
        raise InputError(problem)
    engine, _, where = text.partition(":")
    open_engine: Callable[[str, int | None], Any] = {"dask": _dask, "executorlib": _executorlib, "mpi": _mpi}[engine]
    with open_engine(where, workers) as executor:
        yield executor


@contextlib.contextmanager
def _dask(address: str, _: int | None) -> Iterator[Executor]:
    """Executor of a dask cluster."""
    with needs("cluster", "distributed", "--executor dask"):
        from distributed import Client
    try:
        client = Client(address, timeout=_ANSWERS_WITHIN, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError, TypeError) as error:
        raise InputError(
            f"--executor: no dask scheduler answers at {address!r:.60} ({error!s:.100}); start one with `dask "
            "scheduler`, and workers with `dask worker ADDRESS --nworkers N --nthreads 1`"
        ) from error
    with client, client.get_executor(pure=False) as executor:  # type: ignore[no-untyped-call]
        yield executor


def _executorlib(where: str, workers: int | None) -> Any:
    """Executor of executorlib; its processes stay from task to task."""
    with needs("cluster", "executorlib", "--executor executorlib"):
        from executorlib import SingleNodeExecutor, SlurmJobExecutor
    if where == "slurm":
        return SlurmJobExecutor(max_workers=workers, block_allocation=True)
    return SingleNodeExecutor(max_workers=workers or available_cores(), block_allocation=True)


def _mpi(_: str, workers: int | None) -> Any:
    """Executor of the ranks of MPI."""
    with needs("mpi", "mpi4py", "--executor mpi"):
        from mpi4py.futures import MPIPoolExecutor
    return MPIPoolExecutor(max_workers=workers)

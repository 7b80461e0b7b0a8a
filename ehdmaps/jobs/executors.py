"""Engines of others that solve the points of a map, by a name on the command line.

=======================  ==============================================================================================
`dask:ADDRESS`           workers of a running dask scheduler, such as `dask:tcp://head:8786`
`executorlib:local`      processes of executorlib on this machine
`executorlib:slurm`      processes of executorlib in the Slurm job that the command runs in, started by `srun`
`mpi`                    ranks of `mpiexec -n N python -m mpi4py.futures -m ehdmaps generate ...`
=======================  ==============================================================================================

What is solved is kept here, in the store of the map. A task that an engine loses is handed out once more; after that,
and where this process is stopped, the same command goes on. Workers need the same version of ehdmaps and one thread
each.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from typing import Any

from ehdmaps.errors import InputError
from ehdmaps.extras import needs
from ehdmaps.workers import available_cores

ALLOWED = "dask:ADDRESS of a scheduler, such as dask:tcp://head:8786, executorlib:local, executorlib:slurm, mpi"

_ANSWERS_WITHIN = "15s"
"""Time in which a scheduler has to answer."""


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

"""Run tasks over all cores, past dead workers, solver errors and Ctrl-C; every result goes into the store.

The sweep does not know what a task computes. It is the only place where solver errors are caught, and only
their own types: any other exception is a bug and stops the sweep, with everything solved so far in the store.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import dataclass, field
from typing import Protocol

from ehdmaps.errors import SolverError, WorkerError
from ehdmaps.jobs.executors import Lost, handed_out
from ehdmaps.jobs.make.store import COMMIT_SECONDS, Arrays, Results, Site
from ehdmaps.program import lack
from ehdmaps.workers import WorkersDied, worker_pool

_AHEAD = 3
"""Tasks handed out per worker, so that none waits for the next; few, so that few are lost on Ctrl-C."""

_MOST_DEATHS = 4
"""Processes that die one after the other before any finishes a task: what one task does to its process, or somebody
who kills one, is no reason to stop. Half as many where none of them begins a task."""


class Task(Protocol):
    """A unit of work; picklable, and the same numbers whatever ran before it."""

    @property
    def key(self) -> str:
        """Hash of everything that changes its numbers."""
        ...

    @property
    def site(self) -> Site:
        """Its site, where another task may have left its numbers but for round-off."""
        ...

    @property
    def points(self) -> int:
        """Number of points in it, for progress and counts."""
        ...

    @property
    def by(self) -> str:
        """Name of who computes it: a run solves points besides those of the map."""
        ...

    @property
    def slow(self) -> bool:
        """True where its result is worth a trip to the disk of its own."""
        ...

    def run(self) -> Arrays:
        """Compute its arrays; may raise SolverError."""
        ...

    def failed(self, reason: str) -> Arrays:
        """Return the arrays that say it failed."""
        ...

    def is_final(self, arrays: Arrays) -> bool:
        """Tell whether a result is kept; one that is not is tried again by the next run."""
        ...

    def where(self, points: Sequence[int]) -> str:
        """Say for people which of its points these are."""
        ...


class Progress(Protocol):
    """Listener that the sweep tells how far it is."""

    def taken_over(self, points: int) -> None:
        """So many points were in the store already."""
        ...

    def solved(self, points: int) -> None:
        """So many more points are solved."""
        ...


class NoProgress:
    """Tells nobody."""

    def taken_over(self, points: int) -> None:
        """Do nothing."""

    def solved(self, points: int) -> None:
        """Do nothing."""


class Watch(Protocol):
    """Who looks at every result."""

    def found(self, task: Task, arrays: Arrays, now: bool) -> None:
        """Look at the arrays of a task, which were found now or were in the store already.

        Parameters
        ----------
        task : Task
            What was solved, or found in the store.
        arrays : Arrays
            Result of the task.
        now : bool
            True if it was solved now, False if the store had it.
        """
        ...

    def told(self, words: str) -> None:
        """Hear what happened to the processes that do the work."""
        ...


@dataclass
class SweepResult:
    """Results of a sweep, and how they came about.

    Attributes
    ----------
    arrays : dict
        Arrays by key of the task.
    taken_over, solved : int
        Points that were in the store, and points that were solved now.
    wall_seconds : float
        Time of the sweep.
    damaged : int
        Entries of the store that were unreadable and so solved again.
    """

    arrays: dict[str, Arrays] = field(default_factory=dict)
    taken_over: int = 0
    solved: int = 0
    wall_seconds: float = 0.0
    damaged: int = 0

    def add(self, later: SweepResult) -> None:
        """Take in what a later sweep over the same store found."""
        self.arrays |= later.arrays
        self.taken_over += later.taken_over
        self.solved += later.solved
        self.wall_seconds += later.wall_seconds
        self.damaged = max(self.damaged, later.damaged)


def sweep(
    tasks: Sequence[Task],
    store: Results,
    workers: int,
    progress: Progress | None = None,
    watches: Sequence[Watch] = (),
    executor: Executor | None = None,
) -> SweepResult:
    """Take over what the store has, run the rest, and keep every result in the store.

    Parameters
    ----------
    tasks : sequence of Task
        What to do; the order of results does not depend on it.
    store : Results
        An open `Store`, or `NoStore`.
    workers : int
        Number of processes; 1 runs in this one.
    progress : Progress, optional
        Told about points.
    watches : sequence of Watch
        Shown every result.
    executor : concurrent.futures.Executor, optional
        What runs the tasks in place of processes that are started here; it stays open, and belongs to the caller. A
        task that it loses is handed out once more.

    Returns
    -------
    SweepResult
        The result with the arrays of every task.

    Raises
    ------
    StoreError
        If a result cannot be kept.
    WorkerError
        If processes cannot be started, or die before any finishes a task; what is solved is kept.
    DiskFullError
        If a task has no room for its files; neither it nor those beside it count as tried, and what is solved is kept.
    KeyboardInterrupt
        On Ctrl-C, after the workers are stopped and the store is committed.
    """
    counter = progress or NoProgress()

    def tell(words: str) -> None:
        for watch in watches:
            watch.told(words)

    begin = time.monotonic()
    result = SweepResult()
    todo: list[Task] = []
    for task in tasks:
        known = store.get(task.key, task.site)
        if known is None:
            todo.append(task)
        else:
            result.arrays[task.key] = known
            result.taken_over += task.points
            for watch in watches:
                watch.found(task, known, now=False)
    result.damaged = store.damaged
    counter.taken_over(result.taken_over)
    if executor is not None:
        outcomes = _in_executor(todo, executor, store, tell)
    else:
        outcomes = _in_process(todo) if workers <= 1 else _in_pool(todo, min(workers, len(todo)), store, tell)
    try:
        for task, arrays, final in outcomes:
            if final and task.is_final(arrays):
                store.put(task.key, arrays, at_once=task.slow, site=task.site)
            result.arrays[task.key] = arrays
            result.solved += task.points
            counter.solved(task.points)
            for watch in watches:
                watch.found(task, arrays, now=True)
    except WorkerError as error:
        error.kept = result.taken_over + result.solved
        raise
    except (MemoryError, OSError) as error:
        if not (problem := lack(error)):
            raise
        kept = result.taken_over + result.solved
        raise WorkerError(f"{problem}; what was solved is kept: the same command goes on", kept) from error
    finally:
        outcomes.close()
        store.commit()
    result.wall_seconds = time.monotonic() - begin
    return result


def _run(task: Task) -> Arrays:
    """Run one task; a solver that gave up is a result too."""
    try:
        return task.run()
    except SolverError as error:
        return task.failed(str(error))


_Tell = Callable[[str], None]
"""Takes what happened to the processes that do the work."""

_Outcomes = Generator[tuple[Task, Arrays, bool], None, None]
"""Task, its arrays, and whether they are kept: not those of a dead worker, so the next run tries again."""


def _in_process(tasks: Sequence[Task]) -> _Outcomes:
    """Run tasks one after the other in this process."""
    for task in tasks:
        yield task, _run(task), True


def _import(task: Task) -> None:
    """Do nothing: a worker that receives a task has imported what the task needs."""


class _Deaths:
    """Counts processes that died before any finished a task."""

    def __init__(self) -> None:
        self.finished, self._count = False, 0

    def add(self, died: WorkersDied) -> None:
        """Count one; the error by which the sweep ends is raised where there are too many."""
        self._count += 1 if died.begun else 2
        if not self.finished and self._count >= _MOST_DEATHS:
            raise died.error from None


def _in_pool(tasks: Sequence[Task], workers: int, store: Results, tell: _Tell) -> _Outcomes:
    """Run tasks in worker processes; those that were out when a worker died are tried again alone.

    The first task runs alone while the other workers import. In a fresh installation it compiles a solver for all, and
    they load that from numba's cache; else each worker would compile the same. Slow tasks do not wait for each other.
    """
    waiting = deque(tasks)
    compiled = any(task.slow for task in tasks)
    deaths = _Deaths()
    while waiting:
        running: dict[Future[Arrays], Task] = {}
        try:
            with worker_pool(workers) as pool:
                if not compiled:
                    running[pool.submit(_run, waiting[0])] = waiting[0]
                    for _ in range(workers - 1):  # a worker starts with every task that finds none idle
                        pool.submit(_import, waiting[0])
                    waiting.popleft()
                while waiting or running:
                    while compiled and waiting and len(running) < workers * _AHEAD:
                        running[pool.submit(_run, waiting[0])] = waiting[0]
                        waiting.popleft()
                    done, _ = wait(running, timeout=COMMIT_SECONDS, return_when=FIRST_COMPLETED)
                    compiled = compiled or bool(done)
                    store.commit_if_due()
                    for future in done:
                        arrays = future.result()
                        deaths.finished = True
                        yield running.pop(future), arrays, True
        except WorkersDied as died:
            deaths.add(died)
            out = sum(task.points for task in running.values())
            tell(f"a worker process died ({died.cause}): the {out} points that were out are tried again one at a time")
            # Nobody knows which task killed the worker: those that were out run one at a time.
            yield from _alone(list(running.values()), deaths, tell)


def _in_executor(tasks: Sequence[Task], executor: Executor, store: Results, tell: _Tell) -> _Outcomes:
    """Run tasks by an executor of the caller's."""
    out = handed_out(executor, _run, tasks, tell, lambda task: task.where(range(task.points)), store.commit_if_due)
    try:
        for task, outcome in out:
            if isinstance(outcome, Lost):
                yield task, task.failed(outcome.reason), False
            else:
                yield task, outcome, True
    finally:
        out.close()


def _alone(tasks: Sequence[Task], deaths: _Deaths, tell: _Tell) -> _Outcomes:
    """Run tasks one at a time, in a process that each may take down with it; the next one gets another then."""
    waiting = deque(tasks)
    while waiting:
        try:
            with worker_pool(1) as pool:
                while waiting:
                    arrays = pool.submit(_run, waiting[0]).result()
                    deaths.finished = True
                    yield waiting.popleft(), arrays, True
        except WorkersDied as died:
            deaths.add(died)
            reason = "the worker process died twice (killed, or out of memory); the same command tries again"
            task = waiting.popleft()
            tell(f"a worker process died ({died.cause}) at {task.where(range(task.points))}")
            yield task, task.failed(reason), False

"""Cases that an analysis compares (laws, scenes, models with labels), computed side by side in processes of their own.

A process is a fork of this one: it has the models, and what is imported, from the beginning, and gives back its result
alone. Where there are no forks, or one process is asked for, cases run one after another in this one. An executor gets
each case by value; its results are kept until all are there (`ehdmaps.jobs.executors`).
"""

from __future__ import annotations

import math
import multiprocessing
import signal
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any, Generic, TypeVar

from ehdmaps.errors import AnalysisError, EhdmapsError, InputError
from ehdmaps.interrupts import deaf_children
from ehdmaps.program import tell as say
from ehdmaps.workers import start_worker
from mbs.scene.assembly import Model
from mbs.scene.subject import Subject

Progress = Callable[[int, int], None]
"""Called with what is done and what there is to do in all: first with (0, total), last with (total, total)."""


def silent(done: int, total: int) -> None:
    """Tell nobody."""


@dataclass(frozen=True, eq=False)
class Case:
    """One of the models that are compared.

    Attributes
    ----------
    label : str
        Difference from the other cases; the law if there is none.
    model : Model
        Scene with its law, clearance and loads.
    clearance : float
        Diametral clearance [m]; NaN if the bearings have not all the same.
    load_factor : float
        Factor of all loads of the scene.
    start_angle : float or None
        Angle at which all cages start instead of the scene's angles [rad].
    subject : Subject or None
        What the model was made from, where that is known.
    """

    label: str
    model: Model
    clearance: float
    load_factor: float = 1.0
    start_angle: float | None = None
    subject: Subject | None = None


def common_clearance(model: Model) -> float:
    """Diametral clearance of all bearings [m]; NaN if they have not all the same."""
    found = {entry.geometry.diametral_clearance for entry in model.scene.bearings}
    found |= model.scene.located_clearances
    return found.pop() if len(found) == 1 else math.nan


def as_cases(models: Model | Case | Sequence[Model | Case]) -> tuple[Case, ...]:
    """One or more models as cases; a model is called by its law.

    Parameters
    ----------
    models : Model, Case, or a sequence of them
        Models, at least one. Those of one law that differ in something else have to be cases, each with a label.

    Raises
    ------
    InputError
        If there is none, or two of the same law are given without labels.
    """
    given = [models] if isinstance(models, (Model, Case)) else list(models)
    cases = tuple(
        entry if isinstance(entry, Case) else Case(entry.label, entry, common_clearance(entry)) for entry in given
    )
    labels = [case.label for case in cases]
    # Who gives cases has chosen their labels.
    chosen = bool(given) and all(isinstance(entry, Case) for entry in given)
    if not chosen and len(set(labels)) < max(len(labels), 1):
        raise InputError(
            f"models: got {len(labels)} with the labels {', '.join(labels) or 'none'}; allowed: at least one, and each "
            "label once; give a Case with a label of its own for each model"
        )
    return cases


Item = TypeVar("Item")
Result = TypeVar("Result")

Work = Callable[[Item, Callable[[int], None]], Result]
"""Computes the result of a case; tells how much of it is done."""

Workers = int | Executor
"""Processes that compute cases, or what does in their place."""

_TELL_SECONDS = 0.1


@dataclass(frozen=True)
class Failed:
    """Reason why a case has no result."""

    error: EhdmapsError


@dataclass
class _Running:
    """A case that is being computed."""

    process: Any
    pipe: Connection


@dataclass(frozen=True)
class _Bug:
    """An exception that nobody expects."""

    error: BaseException


def side_by_side(
    work: Work[Item, Result],
    items: Sequence[Item],
    sizes: Sequence[int],
    workers: Workers,
    progress: Progress | None,
    label: Callable[[int], str],
) -> Iterator[Result | Failed]:
    """Compute all cases; results come in the order of the cases.

    Parameters
    ----------
    work : callable
        Computes a case; what it returns has to be picklable, and with an executor `work` itself, too.
    items : sequence
        What each case is; picklable with an executor.
    sizes : sequence of int
        How much there is to do of each case; one that has ended counts as done.
    workers : int or concurrent.futures.Executor
        How many processes at most, or what computes cases in their place; it stays open.
    progress : callable, optional
        Called with how much is done of all cases together, in the units of `work`, and how much there is.
    label : callable
        Name of a case, for messages.

    Yields
    ------
    result or Failed
        Result of each case, or the error of this distribution that it ended with.

    Raises
    ------
    KeyboardInterrupt
        On Ctrl-C, after all processes have been ended.
    """
    tell, total = progress or silent, sum(sizes)
    tell(0, total)

    def told(done: int) -> None:
        tell(done, total)

    if isinstance(workers, Executor):
        yield from _by_executor(work, items, sizes, workers, told, label)
        return
    if min(workers, len(sizes)) <= 1 or "fork" not in multiprocessing.get_all_start_methods():
        yield from _one_by_one(work, items, sizes, told)
        return
    yield from _Forks(work, items, sizes, workers, told, label).results()


def _by_executor(
    work: Work[Item, Result],
    items: Sequence[Item],
    sizes: Sequence[int],
    executor: Executor,
    told: Callable[[int], None],
    label: Callable[[int], str],
) -> Iterator[Result | Failed]:
    """Compute all cases by an executor, but those that an earlier run has kept."""
    from ehdmaps.jobs.executors import Lost, handed_out, kept_results

    found: dict[int, Result | Failed] = {}
    kept, whole = kept_results(work, items), True
    for index in range(len(items)):
        if (known := kept.get(index)) is not None:
            found[index] = known
    due = [(index, items[index]) for index in range(len(items)) if index not in found]
    coming = handed_out(executor, _Computed(work), due, say, lambda entry: label(entry[0]))
    try:
        for index in range(len(items)):
            while index not in found:
                (place, _), result = next(coming)
                if isinstance(result, Lost):
                    whole = False
                    found[place] = Failed(AnalysisError(f"{label(place)}: {result.reason}"))
                else:
                    found[place] = result
                    kept.put(place, result)
                told(sum(sizes[one] for one in found))
            yield found[index]
    finally:
        coming.close()
    if whole:
        kept.clear()


@dataclass(frozen=True)
class _Computed(Generic[Item, Result]):
    """The work on a case, by its index and itself; an error of this distribution is a result."""

    work: Work[Item, Result]

    def __call__(self, entry: tuple[int, Item]) -> Result | Failed:
        try:
            return self.work(entry[1], lambda amount: None)
        except EhdmapsError as error:
            return Failed(error)


def _one_by_one(
    work: Work[Item, Result], items: Sequence[Item], sizes: Sequence[int], told: Callable[[int], None]
) -> Iterator[Result | Failed]:
    """Compute all cases in this process."""
    before = 0

    def tell(amount: int) -> None:
        told(before + amount)

    found: Result | Failed
    for item, size in zip(items, sizes, strict=True):
        try:
            found = work(item, tell)
        except EhdmapsError as error:
            found = Failed(error)
        before += size
        told(before)
        yield found


class _Forks(Generic[Item, Result]):
    """Processes that compute cases."""

    def __init__(
        self,
        work: Work[Item, Result],
        items: Sequence[Item],
        sizes: Sequence[int],
        workers: int,
        told: Callable[[int], None],
        label: Callable[[int], str],
    ) -> None:
        self._work, self._items, self._sizes = work, items, sizes
        self._workers, self._told, self._label = workers, told, label
        self._context = multiprocessing.get_context("fork")
        self._said = self._context.Value("b", False)
        self._running: dict[int, _Running] = {}
        self._found: dict[int, Any] = {}
        self._done = [0] * len(sizes)
        self._next = 0

    def results(self) -> Iterator[Result | Failed]:
        """Results in the order of the cases."""
        try:
            for index in range(len(self._sizes)):
                while index not in self._found:
                    self._begin()
                    self._listen()
                found = self._found.pop(index)
                if isinstance(found, _Bug):
                    raise found.error
                yield found
        finally:
            for entry in self._running.values():
                entry.process.terminate()
            for entry in self._running.values():
                entry.process.join()

    def _begin(self) -> None:
        """Begin as many cases as there is room for."""
        while self._next < len(self._sizes) and len(self._running) < self._workers:
            ours, theirs = self._context.Pipe(duplex=False)
            process = self._context.Process(
                target=_compute, args=(self._work, self._items[self._next], theirs, self._said), daemon=True
            )
            with deaf_children(signal.SIGTERM), warnings.catch_warnings():
                # Of threads that a fork leaves behind none is needed in it.
                warnings.simplefilter("ignore", DeprecationWarning)
                process.start()
            theirs.close()
            self._running[self._next] = _Running(process, ours)
            self._next += 1

    def _listen(self) -> None:
        """Wait until some process says something, and take it."""
        pipes = {entry.pipe: index for index, entry in self._running.items()}
        for pipe in wait(list(pipes)):
            assert isinstance(pipe, Connection)
            index = pipes[pipe]
            try:
                said = pipe.recv()
            except EOFError:
                self._end(index, Failed(AnalysisError(
                    f"{self._label(index)}: its process died (killed, or out of memory); the same command tries "
                    "again, with --workers 1 in one process"
                )))  # fmt: skip
                continue
            if isinstance(said, int):
                self._tell(index, said)
            else:
                self._end(index, said[0])

    def _end(self, index: int, found: Any) -> None:
        """Take the result of a case."""
        entry = self._running.pop(index)
        entry.process.join()
        entry.pipe.close()
        self._found[index] = found
        self._tell(index, self._sizes[index])

    def _tell(self, index: int, done: int) -> None:
        """Tell how much is done of all cases."""
        self._done[index] = done
        self._told(sum(self._done))


def _compute(work: Work[Item, Result], item: Item, pipe: Connection, said: Any) -> None:
    """Compute a case in a process of its own."""
    start_worker(said)
    last = -_TELL_SECONDS

    def told(amount: int) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= _TELL_SECONDS:
            pipe.send(amount)
            last = now

    found: Any
    try:
        found = work(item, told)
    except EhdmapsError as error:
        found = Failed(error)
    except Exception as error:  # a bug, which the parent raises
        found = _Bug(error)
    pipe.send((found,))
    pipe.close()

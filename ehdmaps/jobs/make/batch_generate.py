"""Maps made for a batch: those with films from the film table, and those that are solved one by one.

The maps of a batch as a table: for readers, and as CSV for programs.
"""

from __future__ import annotations

import csv
import hashlib
import io
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future, as_completed
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import xarray as xr

from ehdmaps.errors import DiskFullError, EhdmapsError, InputError, WorkerError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.batch import SUMMARY, Batch, Member
from ehdmaps.jobs.make.generate import Within, generate, planned_tasks, read_map
from ehdmaps.jobs.make.law_check import unmet
from ehdmaps.jobs.make.log import RunLog
from ehdmaps.jobs.make.report import holes, unsolved
from ehdmaps.jobs.make.status import StatusFile, duration
from ehdmaps.jobs.make.store import Store, store_path
from ehdmaps.jobs.make.sweep import Progress, SweepResult
from ehdmaps.jobs.make.table_films import unserved
from ehdmaps.jobs.make.tasks import LineTask, solver_version
from ehdmaps.maps import schema
from ehdmaps.maps.records import record_json
from ehdmaps.maps.schema import SCHEMA_VERSION
from ehdmaps.netcdf_structure import DAMAGE, opened
from ehdmaps.outputs import MAP, MARK, TABLE, Output, name_problem, output_problems, root_attributes, write_text
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.table.solver import TableSolver
from ehdmaps.workers import WorkersDied, available_cores, worker_pool


@dataclass(frozen=True)
class Planned:
    """One map of a batch.

    Attributes
    ----------
    member : Member
        Which one.
    job : Job
        What is made: its laws are checked if it is one of those for which the batch wants that.
    """

    member: Member
    job: Job

    @cached_property
    def solver(self) -> ContactSolver:
        """Solver that gives its films."""
        return solvers.of_map(self.job)

    @property
    def reads(self) -> bool:
        """True where its films are to be read from the film table, if that serves."""
        return isinstance(self.solver, TableSolver)

    @cached_property
    def fingerprint(self) -> str:
        """Hash of all that shapes the map, by which a map that is there is known to be it."""
        solver = record_json([self.solver.name, self.solver.settings(), solver_version(self.solver)])
        parts = str(SCHEMA_VERSION), self.job.sha256, solver, str(self.job.law_check)
        return hashlib.sha256("\0".join(parts).encode()).hexdigest()

    @property
    def tasks(self) -> tuple[LineTask, ...]:
        """All that is known to be solved for it; nothing of a map that is read, which is made in less than a second."""
        return planned_tasks(self.job) if unserved(self.job, self.solver) else ()


def plan_batch(batch: Batch) -> tuple[Planned, ...]:
    """Lay out the maps of a batch, in its order.

    Parameters
    ----------
    batch : Batch
        The batch.
    """
    maps = [Planned(member, member.job) for member in batch.members]
    groups: dict[tuple[str, str], list[int]] = {}
    for index, planned in enumerate(maps):
        if planned.reads:
            groups.setdefault((planned.member.oil, planned.member.override), []).append(index)
    for indices in groups.values():
        # from the smallest radius to the largest
        ordered = sorted(indices, key=lambda index: (maps[index].job.contacts[0].radius, index))
        count = min(batch.checked, len(ordered))
        places = np.unique(np.linspace(0, len(ordered) - 1, count).round().astype(int)) if count else ()
        for index in set(indices) - {ordered[place] for place in places}:
            maps[index] = Planned(maps[index].member, replace(maps[index].job, law_check=0))
    return tuple(maps)


MADE, KEPT, FAILED = "made", "kept", "failed"
"""What became of a map: kept is one that was there from an earlier run, and is the same."""

READ, SOLVED = "film table", "solved"
"""Where the films of a map come from."""

BATCH, FINGERPRINT = "batch", "batch_fingerprint"
"""Attributes of a map of a batch: its name, and the hash of all that shapes the map."""

_PIECES = 16
"""Pieces of work for each worker, into which maps are cut."""

_LONGEST_PIECE = 10
"""Maps of one piece, which is lost as a whole when its process is killed."""

_DIED = "the worker process died (killed, or out of memory); the same command tries again"

_Item = TypeVar("_Item")
_Result = TypeVar("_Result")


_FOLDER = "allowed: a folder for the maps, which may be there or be made; choose another"


@dataclass(frozen=True)
class Outcome:
    """Outcome of making one map.

    Attributes
    ----------
    member : Member
        Which one.
    output : Path
        File of the map.
    state : str
        `MADE`, `KEPT` or `FAILED`.
    films : str
        `READ` or `SOLVED`.
    lost : int
        Points without a solution.
    missed : tuple of str
        What its laws miss, in words, where they were checked.
    figures : mapping
        Numbers at the middle of its axes, SI, by names with their units.
    reason : str
        Why it failed.
    seconds : float
        What it took.
    """

    member: Member
    output: Path
    state: str
    films: str = ""
    lost: int = 0
    missed: tuple[str, ...] = ()
    figures: Mapping[str, float] = field(default_factory=dict)
    reason: str = ""
    seconds: float = 0.0

    @property
    def good(self) -> bool:
        """True where the map is there, without holes, and its laws miss nothing."""
        return self.state != FAILED and not self.lost and not self.missed


@dataclass
class BatchResult:
    """The maps of a batch, in the order of its members, and how they came about."""

    batch: Batch
    outcomes: tuple[Outcome, ...]
    sweep: SweepResult
    wall_seconds: float

    @property
    def status(self) -> int:
        """Exit status of the command."""
        return 0 if all(outcome.good for outcome in self.outcomes) else 1


def batch_path(batch: Batch, folder: Path) -> Path:
    """Path that the store and the status of a batch are named after.

    Parameters
    ----------
    batch : Batch
        The batch.
    folder : Path
        Folder of its maps.
    """
    return folder / f"{batch.name}.batch"


def make_folder(folder: Path) -> None:
    """Make the folder of the maps, and those that it lies in, where they are not there.

    Parameters
    ----------
    folder : Path
        The folder, which -o names.

    Raises
    ------
    InputError
        If it cannot be made, or something else stands there.
    """
    if problem := folder_problem(folder, "-o"):
        raise InputError(problem)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"-o: got {folder}, which cannot be made ({error.strerror}); {_FOLDER}") from error


def folder_problem(folder: Path, option: str) -> str:
    """Tell in one sentence why a folder of maps can be neither used nor made; empty if it may.

    Parameters
    ----------
    folder : Path
        The folder.
    option : str
        That names it.
    """
    if problem := name_problem(folder):
        return f"{option}: got {str(folder)!r:.300}, {problem}"
    there = next((place for place in (folder, *folder.parents) if place.exists()), Path())
    if not there.is_dir():
        return f"{option}: got {str(folder)!r:.300}, which is no folder and cannot be made; {_FOLDER}"
    return ""


def generate_batch(
    batch: Batch,
    folder: Path,
    workers: int | None = None,
    fresh: bool = False,
    progress: Callable[[int], Progress] | None = None,
    executor: Executor | None = None,
    told: Callable[[int], Progress] | None = None,
) -> BatchResult:
    """Make all maps of a batch; what is there and is the same is kept, and a map that fails does not stop the others.

    Parameters
    ----------
    batch : Batch
        The batch.
    folder : Path
        Folder of the maps and of the store; made if it is not there.
    workers : int, optional
        Number of processes; all cores if left out.
    fresh : bool
        Make everything anew.
    progress : callable, optional
        Takes a number of points, gives the `Progress` to tell.
    executor : concurrent.futures.Executor, optional
        What solves the points in place of processes that are started here. Maps are put together here in any case.
    told : callable, optional
        The same for maps that are put together.

    Raises
    ------
    InputError, StoreError
        If nothing can be made at all.
    """
    begin = time.monotonic()
    make_folder(folder)
    plan = plan_batch(batch)
    processes = workers or available_cores()
    outcomes: dict[str, Outcome] = {}
    place = batch_path(batch, folder)
    with Store(store_path(place), fresh) as store:
        due = [planned for planned in plan if _is_due(planned, batch, folder, fresh, outcomes)]
        about = f"batch {batch.name}, {len(batch.members)} maps"
        log = RunLog(place, [about], 0, processes, fresh)
        with StatusFile(place, about, 0, processes) as status, log:
            run = _Run(batch, folder, store, status, log, processes, progress, executor, told)
            alone = run.read([planned for planned in due if planned.reads], outcomes)
            alone += [planned for planned in due if not planned.reads]
            points = sum(task.points for planned in alone for task in planned.tasks)
            status.more(points)
            log.more(points)
            for planned in alone:
                outcomes[planned.member.name] = run.alone(planned)
            log.finish("\n".join(_lines(outcomes.values())))
    ordered = tuple(outcomes[member.name] for member in batch.members)
    return BatchResult(batch, ordered, run.result, time.monotonic() - begin)


def _lines(outcomes: Iterable[Outcome]) -> Iterator[str]:
    """Number of maps of each state, and why some failed."""
    found = list(outcomes)
    for state in (MADE, KEPT, FAILED):
        yield f"maps {state}: {sum(outcome.state == state for outcome in found)}"
    yield from (f"{outcome.output}: {outcome.reason}" for outcome in found if outcome.state == FAILED)


def _is_due(planned: Planned, batch: Batch, folder: Path, fresh: bool, outcomes: dict[str, Outcome]) -> bool:
    """Tell whether a map is to be made: not if it is there already, nor if something else stands in its place."""
    member = planned.member
    output = folder / f"{member.name}.nc"
    there = root_attributes(output) if output.is_file() else {}
    if not fresh and there.get(BATCH) == batch.name and there.get(FINGERPRINT) == planned.fingerprint:
        kept = _kept(member, output)
        if kept is not None:
            outcomes[member.name] = kept
            return False
    problems = output_problems([Output("", output, MAP)])
    if there and not problems and there.get(BATCH) != batch.name:
        problems = [
            f"{output}: is a map that this batch did not make; allowed: a new file, or a map of this batch; move it "
            "away, or choose another folder with -o"
        ]
    if problems:
        outcomes[member.name] = Outcome(member, output, FAILED, reason="; ".join(problems))
    return not problems


def _kept(member: Member, output: Path) -> Outcome | None:
    """Outcome to report of a map that is there; None where it cannot be read."""
    try:
        with opened(output) as file:
            lines = schema.BACKBONE in file.groups
        with xr.open_dataset(output, engine="netcdf4") as dataset:
            return _outcome(member, output, KEPT, dataset, lines, 0.0)
    except DAMAGE:
        return None


def _outcome(member: Member, output: Path, state: str, dataset: xr.Dataset, lines: bool, seconds: float) -> Outcome:
    """Outcome of a map that is there."""
    films = READ if schema.FILM_TABLE in dataset.attrs else SOLVED
    without_solution = holes(dataset) + unsolved(dataset)
    missed = tuple(unmet(dataset, lines))
    return Outcome(member, output, state, films, int(without_solution), missed, _figures(dataset), "", seconds)


def _figures(dataset: xr.Dataset) -> dict[str, float]:
    """Numbers of the first contact in the middle of the axes."""
    places = {name: dataset.sizes[name] // 2 for name in ("load", "entrainment_speed", "temperature")}
    middle = dataset.isel({"contact": 0, **places})
    units = {"load": "N/m", "entrainment_speed": "m/s", "temperature": "K"}
    figures = {f"{name} [{unit}]": float(middle[name]) for name, unit in units.items()}
    wanted = {"stiffness": "N/m2", "damping": "N s/m2", "central_film": "m", "minimum_film": "m"}
    return figures | {f"{name} [{unit}]": float(middle[name]) for name, unit in wanted.items()}


def _marks(batch: Batch, fingerprint: str) -> dict[str, str | int]:
    """Attributes of a map of a batch."""
    return {BATCH: batch.name, FINGERPRINT: fingerprint}


@dataclass
class _Run:
    """One run over a batch: what all of its maps have in common."""

    batch: Batch
    folder: Path
    store: Store
    status: StatusFile
    log: RunLog
    workers: int
    progress: Callable[[int], Progress] | None
    executor: Executor | None
    told: Callable[[int], Progress] | None
    result: SweepResult = field(default_factory=SweepResult)

    def alone(self, planned: Planned) -> Outcome:
        """Make a map whose films are solved."""
        member, begin = planned.member, time.monotonic()
        output = self.folder / f"{member.name}.nc"
        within = Within(self.store, self.status, self.log, _marks(self.batch, planned.fingerprint))
        try:
            made = generate(
                planned.job, output, self.workers, False, self.progress, executor=self.executor, within=within
            )
        except (WorkerError, DiskFullError):  # nothing of this map alone
            raise
        except EhdmapsError as error:
            return Outcome(member, output, FAILED, reason=str(error))
        # without its arrays: those of a thousand maps need more memory than there is
        self.result.add(replace(made.sweep, arrays={}))
        seconds = time.monotonic() - begin
        return _outcome(member, output, MADE, made.dataset, made.backbone is not None, seconds)

    def read(self, due: Sequence[Planned], outcomes: dict[str, Outcome]) -> list[Planned]:
        """Make the maps whose films the film table has; gives back those that it does not serve."""
        size = max(1, min(_LONGEST_PIECE, len(due) // (self.workers * _PIECES)))
        pieces = [_Piece(self.batch, tuple(due[i : i + size]), self.folder) for i in range(0, len(due), size)]
        counter = self.told(len(due)) if self.told and due else None
        if counter:
            counter.taken_over(0)
        left = []
        for piece, of_piece in _each(_made, pieces, self.workers):
            died = [Outcome(m.member, self.folder / f"{m.member.name}.nc", FAILED, reason=_DIED) for m in piece.maps]
            for planned, outcome in zip(piece.maps, of_piece or died, strict=True):
                if outcome is None:
                    left.append(planned)
                else:
                    outcomes[planned.member.name] = outcome
            self.status.write()
            if counter:
                counter.solved(len(piece.maps))
        return left


@dataclass(frozen=True)
class _Piece:
    """Some maps with films from the film table."""

    batch: Batch
    maps: tuple[Planned, ...]
    folder: Path


def _made(piece: _Piece) -> list[Outcome | None]:
    """Make some maps; None for each that the film table does not serve."""
    outcomes: list[Outcome | None] = []
    for planned in piece.maps:
        member, begin = planned.member, time.monotonic()
        output = piece.folder / f"{member.name}.nc"
        try:
            dataset = read_map(planned.job, output, _marks(piece.batch, planned.fingerprint))
        except EhdmapsError as error:
            outcomes.append(Outcome(member, output, FAILED, reason=str(error)))
        else:
            seconds = time.monotonic() - begin
            outcomes.append(_outcome(member, output, MADE, dataset, False, seconds) if dataset is not None else None)
    return outcomes


def _each(
    function: Callable[[_Item], _Result], items: Sequence[_Item], workers: int
) -> Iterator[tuple[_Item, _Result | None]]:
    """Do something with each item, in worker processes where there are several; None where its process died."""
    if workers <= 1 or len(items) <= 1:
        for item in items:
            yield item, function(item)
        return
    running: dict[Future[_Result], _Item] = {}
    try:
        with worker_pool(min(workers, len(items))) as pool:
            for item in items:
                running[pool.submit(function, item)] = item
            for future in as_completed(list(running)):
                result = future.result()
                yield running.pop(future), result
    except WorkersDied as died:
        if not died.begun:
            raise died.error from None
        for item in running.values():
            yield item, None


_SHOWN = 30
"""Maps that are not good and that are named on a terminal; all stand in the table."""

_COLUMNS = ("map", "bearing", "oil", "override", "state", "films", "points_without_solution", "laws_miss", "seconds")


def write_table(result: BatchResult, folder: Path) -> Path:
    """Write the table of all maps into their folder, and return its file.

    Parameters
    ----------
    result : BatchResult
        What became of the maps.
    folder : Path
        Folder of the maps.

    Raises
    ------
    InputError
        If it may not be replaced, or cannot be written.
    """
    path = folder / SUMMARY
    write_text(path, table(result), TABLE)
    return path


def table(result: BatchResult) -> str:
    """Return the table as CSV: a comment with the mark of the program, a header with units, one line a map.

    Parameters
    ----------
    result : BatchResult
        What became of the maps.
    """
    figures = next((tuple(outcome.figures) for outcome in result.outcomes if outcome.figures), ())
    out = io.StringIO()
    out.write(
        f"# {MARK}: maps of the batch {result.batch.name}; numbers of the first contact at the middle of the axes\n"
    )
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([*_COLUMNS, *figures, "reason"])
    for outcome in result.outcomes:
        member = outcome.member
        writer.writerow(
            [
                outcome.output.name,
                member.bearing,
                member.oil,
                member.override,
                outcome.state,
                outcome.films,
                outcome.lost if outcome.state != FAILED else "",
                "; ".join(outcome.missed),
                f"{outcome.seconds:.2f}",
                *(f"{outcome.figures[name]:.6g}" if name in outcome.figures else "" for name in figures),
                " ".join(outcome.reason.split()),
            ]
        )
    return out.getvalue()


def table_dataset(result: BatchResult) -> xr.Dataset:
    """Return the table as a dataset over the names of the maps.

    Parameters
    ----------
    result : BatchResult
        What became of the maps.
    """
    outcomes = result.outcomes
    texts = {
        "file": [str(outcome.output) for outcome in outcomes],
        "bearing": [outcome.member.bearing for outcome in outcomes],
        "oil": [outcome.member.oil for outcome in outcomes],
        "override": [outcome.member.override for outcome in outcomes],
        "state": [outcome.state for outcome in outcomes],
        "films": [outcome.films for outcome in outcomes],
        "laws_miss": ["; ".join(outcome.missed) for outcome in outcomes],
        "reason": [outcome.reason for outcome in outcomes],
    }
    values: dict[str, tuple[str, Any, dict[str, str]]] = {name: ("map", column, {}) for name, column in texts.items()}
    values["points_without_solution"] = ("map", [outcome.lost for outcome in outcomes], {})
    values["seconds"] = ("map", [outcome.seconds for outcome in outcomes], {"units": "s"})
    for name in next((tuple(outcome.figures) for outcome in outcomes if outcome.figures), ()):
        word, _, unit = name.removesuffix("]").partition(" [")
        values[word] = ("map", [outcome.figures.get(name, np.nan) for outcome in outcomes], {"units": unit})
    return xr.Dataset(values, coords={"map": [outcome.member.name for outcome in outcomes]})


def summary(result: BatchResult, written: Path) -> str:
    """Return what is printed after a run.

    Parameters
    ----------
    result : BatchResult
        What became of the maps.
    written : Path
        File of the table.
    """
    return "\n".join(_summary_lines(result, written))


def _summary_lines(result: BatchResult, written: Path) -> Iterator[str]:
    """Yield the lines of the summary."""
    counts = Counter(outcome.state for outcome in result.outcomes)
    states = ", ".join(f"{count} {state}" for state, count in sorted(counts.items(), reverse=True))
    yield f"{result.batch.name}: {len(result.outcomes)} maps: {states}"
    if read := sum(outcome.films == READ for outcome in result.outcomes):
        yield f"films: {read} maps read from the film table"
    yield f"points: {result.sweep.taken_over} taken over, {result.sweep.solved} solved now"
    if result.sweep.damaged:
        yield f"store: {result.sweep.damaged} damaged entries were solved again"
    bad = [outcome for outcome in result.outcomes if not outcome.good]
    for outcome in bad[:_SHOWN]:
        yield f"{outcome.output.name}: {_words(outcome)}"
    if len(bad) > _SHOWN:
        yield f"and {len(bad) - _SHOWN} more, see the table"
    yield f"wall time: {duration(result.wall_seconds)}"
    yield f"table: {written}"


def _words(outcome: Outcome) -> str:
    """Shortcomings of a map, in words."""
    if outcome.state == FAILED:
        return f"failed: {outcome.reason}"
    shortcomings = [f"{outcome.lost} points without a solution"] if outcome.lost else []
    return "; ".join([*shortcomings, *outcome.missed])

"""From a batch file to its maps: the lines of families first, then one map after the other, all from one store."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future, as_completed
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

import xarray as xr

from ehdmaps.errors import EhdmapsError, InputError, WorkerError
from ehdmaps.jobs.batch import OWN, SHARED, Batch, Member
from ehdmaps.jobs.batch_plan import Alone, Shared, plan_batch
from ehdmaps.jobs.correction_report import unsolved
from ehdmaps.jobs.family_maps import Checked, Solved, check_member, make_map
from ehdmaps.jobs.generate import MOST_HALVINGS, Within, generate
from ehdmaps.jobs.law_check import HALVED, unmet
from ehdmaps.jobs.refinement import MOST_LINE_POINTS
from ehdmaps.jobs.report import holes
from ehdmaps.jobs.status import StatusFile
from ehdmaps.jobs.store import Store, store_path
from ehdmaps.jobs.sweep import Progress, SweepResult, sweep
from ehdmaps.maps import schema
from ehdmaps.maps.backbone_plan import Axis
from ehdmaps.netcdf_structure import DAMAGE
from ehdmaps.outputs import MAP, Output, name_problem, output_problems, root_attributes
from ehdmaps.workers import WorkersDied, available_cores, worker_pool

MADE, KEPT, FAILED = "made", "kept", "failed"
"""What became of a map: kept is one that was there from an earlier run, and is the same."""

BATCH, FINGERPRINT, FILMS = "batch", "batch_fingerprint", "batch_films"
"""Attributes of a map of a batch: its name, the hash of all that shapes the map, and whether its films are shared."""

_PIECES = 16
"""Pieces of work for each worker, into which the maps of a family are cut."""

_LONGEST_PIECE = 10
"""Maps of one piece, which is lost as a whole when its process is killed."""

_DIED = "the worker process died (killed, or out of memory); the same command tries again"

_Item = TypeVar("_Item")
_Found = TypeVar("_Found")


_FOLDER = "allowed: a folder for the maps, in one that is there and may be written; choose another"


@dataclass(frozen=True)
class Outcome:
    """What became of one map.

    Attributes
    ----------
    member : Member
        Which one.
    output : Path
        File of the map.
    state : str
        `MADE`, `KEPT` or `FAILED`.
    films : str
        "shared" where its points were read from the lines of a family, else "own".
    lost : int
        Points without a solution.
    missed : tuple of str
        What its laws miss, in words, where they were checked.
    figures : mapping
        Numbers at the middle of its axes, SI, by names with their units.
    reason : str
        Why it failed.
    seconds : float
        What it took besides the lines that it shares.
    """

    member: Member
    output: Path
    state: str
    films: str
    lost: int = 0
    missed: tuple[str, ...] = ()
    figures: Mapping[str, float] = field(default_factory=dict)
    reason: str = ""
    seconds: float = 0.0

    @property
    def good(self) -> bool:
        """Whether the map is there, without holes, and its laws miss nothing."""
        return self.state != FAILED and not self.lost and not self.missed


@dataclass
class BatchResult:
    """The maps of a batch, in the order of its members, and how they came about."""

    batch: Batch
    outcomes: tuple[Outcome, ...]
    sweep: SweepResult
    families: tuple[tuple[int, int], ...]
    wall_seconds: float

    @property
    def status(self) -> int:
        """Exit status of the command."""
        return 0 if all(outcome.good for outcome in self.outcomes) else 1


def batch_path(batch: Batch, folder: Path) -> Path:
    """What the store and the status of a batch are named after.

    Parameters
    ----------
    batch : Batch
        The batch.
    folder : Path
        Folder of its maps.
    """
    return folder / f"{batch.name}.batch"


def make_folder(folder: Path, option: str = "-o") -> None:
    """Make the folder of the maps, where it is not there.

    Parameters
    ----------
    folder : Path
        The folder; the one that it lies in is there.
    option : str
        That names it, for messages.

    Raises
    ------
    InputError
        If it cannot be made, or something else stands there.
    """
    if problem := folder_problem(folder, option):
        raise InputError(problem)
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise InputError(f"{option}: got {folder}, which cannot be made ({error.strerror}); {_FOLDER}") from error


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
    if not folder.is_dir() and (folder.exists() or not folder.parent.is_dir()):
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
        todo = [_due(shared, batch, folder, fresh, outcomes) for shared in plan.shared]
        alone = [one for one in plan.alone if _is_due(one.member, one.fingerprint, batch, folder, OWN, fresh, outcomes)]
        total = sum(s.family.points for s, due in zip(plan.shared, todo, strict=True) if due)
        total += sum(one.points for one in alone)
        about = f"batch {batch.name}, {len(batch.members)} maps"
        with StatusFile(place, about, total, processes) as status:
            run = _Run(batch, folder, store, status, processes, progress, executor, told)
            families = []
            for shared, due in zip(plan.shared, todo, strict=True):
                if due:
                    points, left = run.family(shared, due, outcomes)
                    families.append((len(shared.members), points))
                    alone += left
            for one in alone:
                outcomes[one.member.name] = run.alone(one)
    ordered = tuple(outcomes[member.name] for member in batch.members)
    return BatchResult(batch, ordered, run.result, tuple(families), time.monotonic() - begin)


def _due(shared: Shared, batch: Batch, folder: Path, fresh: bool, outcomes: dict[str, Outcome]) -> list[int]:
    """Members of a family whose maps are to be made; of the others the outcome is noted."""
    return [
        index
        for index, member in enumerate(shared.members)
        if _is_due(member, shared.fingerprint(index), batch, folder, SHARED, fresh, outcomes)
    ]


def _is_due(
    member: Member, fingerprint: str, batch: Batch, folder: Path, films: str, fresh: bool, outcomes: dict[str, Outcome]
) -> bool:
    """Whether a map is to be made: not where it is there already, nor where something else stands in its place."""
    output = folder / f"{member.name}.nc"
    there = root_attributes(output) if output.is_file() else {}
    if not fresh and there.get(BATCH) == batch.name and there.get(FINGERPRINT) == fingerprint:
        kept = _kept(member, output, str(there.get(FILMS, films)))
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
        outcomes[member.name] = Outcome(member, output, FAILED, films, reason="; ".join(problems))
    return not problems


def _kept(member: Member, output: Path, films: str) -> Outcome | None:
    """What is to be said of a map that is there; None where it does not read."""
    import netCDF4

    try:
        with netCDF4.Dataset(output) as file:
            lines = schema.BACKBONE in file.groups
        with xr.open_dataset(output, engine="netcdf4") as dataset:
            return _outcome(member, output, KEPT, films, dataset, lines, 0.0)
    except (*DAMAGE, KeyError):
        return None


def _outcome(
    member: Member, output: Path, state: str, films: str, dataset: xr.Dataset, lines: bool, seconds: float
) -> Outcome:
    """What became of a map that is there."""
    lost = holes(dataset) + unsolved(dataset)
    missed = tuple(unmet(dataset, lines))
    return Outcome(member, output, state, films, int(lost), missed, _figures(dataset), "", seconds)


def _figures(dataset: xr.Dataset) -> dict[str, float]:
    """Numbers of the first contact in the middle of the axes."""
    places = {name: dataset.sizes[name] // 2 for name in ("load", "entrainment_speed", "temperature")}
    middle = dataset.isel({"contact": 0, **places})
    units = {"load": "N/m", "entrainment_speed": "m/s", "temperature": "K"}
    figures = {f"{name} [{unit}]": float(middle[name]) for name, unit in units.items()}
    wanted = {"stiffness": "N/m2", "damping": "N s/m2", "central_film": "m", "minimum_film": "m"}
    return figures | {f"{name} [{unit}]": float(middle[name]) for name, unit in wanted.items()}


def _marks(batch: Batch, fingerprint: str, films: str) -> dict[str, str]:
    """Attributes of a map of a batch."""
    return {BATCH: batch.name, FINGERPRINT: fingerprint, FILMS: films}


@dataclass
class _Run:
    """One run over a batch: what all of its maps have in common."""

    batch: Batch
    folder: Path
    store: Store
    status: StatusFile
    workers: int
    progress: Callable[[int], Progress] | None
    executor: Executor | None
    told: Callable[[int], Progress] | None
    result: SweepResult = field(default_factory=SweepResult)

    def alone(self, one: Alone) -> Outcome:
        """Make a map at its own points."""
        member, output, begin = one.member, self.folder / f"{one.member.name}.nc", time.monotonic()
        within = Within(self.store, self.status, _marks(self.batch, one.fingerprint, OWN))
        try:
            made = generate(
                member.job, output, self.workers, False, self.progress, executor=self.executor, within=within
            )
        except WorkerError:  # nothing of this map alone
            raise
        except EhdmapsError as error:
            return Outcome(member, output, FAILED, OWN, reason=str(error))
        self._count(made.sweep)
        seconds = time.monotonic() - begin
        return _outcome(member, output, MADE, OWN, made.dataset, made.backbone is not None, seconds)

    def family(self, shared: Shared, due: Sequence[int], outcomes: dict[str, Outcome]) -> tuple[int, list[Alone]]:
        """Make the maps of a family; the points of its lines, and members whose lines cannot be read."""
        try:
            solved, halved = self._solved(shared)
        except WorkerError:
            raise
        except EhdmapsError:  # a line with too few solved points: each map stands on its own then
            left = [Alone(shared.members[index]) for index in due]
            self.status.more(sum(one.points for one in left))
            return shared.family.lines.points, left
        attributes = {HALVED: ", ".join(halved)} if halved else {}
        size = max(1, min(_LONGEST_PIECE, len(due) // (self.workers * _PIECES)))
        pieces = [
            _Piece(
                self.batch,
                solved,
                tuple((i, shared.members[i], shared.fingerprint(i)) for i in due[start : start + size]),
                self.folder,
                attributes,
            )
            for start in range(0, len(due), size)
        ]
        counter = self.told(len(due)) if self.told else None
        if counter:
            counter.taken_over(0)
        for piece, found in _each(_made, pieces, self.workers):
            made = found or [
                Outcome(m, self.folder / f"{m.name}.nc", FAILED, SHARED, reason=_DIED) for _, m, _ in piece.members
            ]
            outcomes.update({outcome.member.name: outcome for outcome in made})
            self.status.write()
            if counter:
                counter.solved(len(made))
        return solved.family.lines.points, []

    def _solved(self, shared: Shared) -> tuple[Solved, list[Axis]]:
        """Lines and checks of a family solved, with lines halved as long as checked laws miss their bars."""
        family = shared.family
        halved: list[Axis] = []
        found = dict(self._sweep(shared.family.tasks))
        while True:
            solved = Solved(family, {task.key: found[task.key] for task in family.tasks}, {})
            solved.films  # noqa: B018  # lines that cannot be read are told before anything is made of them
            checks = [(solved, index, check) for index, check in family.checks]
            by_member: dict[int, Checked] = {}
            for (_, index, _), checked in _each(_checked, checks, self.workers):
                if checked is not None:
                    by_member[index] = checked
            coarse = [by_member[index].coarse for index in sorted(by_member) if by_member[index].coarse]
            names = {family.jobs[index].name: found.attributes for index, found in sorted(by_member.items())}
            solved = replace(solved, checked=names)
            if not coarse or len(halved) == MOST_HALVINGS or coarse[0] is None:
                return solved, halved
            finer = family.with_steps(family.lines.steps.finer(coarse[0]))
            if finer.lines.points > MOST_LINE_POINTS:
                return solved, halved
            family = finer
            halved.append(coarse[0])
            new = [task for task in family.lines.tasks if task.key not in found]
            self.status.more(sum(task.points for task in new))
            found |= self._sweep(new)

    def _sweep(self, tasks: Sequence[Any]) -> Mapping[str, Any]:
        """Solve tasks."""
        points = sum(task.points for task in tasks)
        told = self.progress(points) if self.progress else None
        result = sweep(tasks, self.store, self.workers, told, [self.status], self.executor)
        self.status.write()
        self._count(result)
        return result.arrays

    def _count(self, result: SweepResult) -> None:
        """Count a sweep, without keeping its arrays: those of a thousand maps need more memory than there is."""
        self.result.add(replace(result, arrays={}))


@dataclass(frozen=True)
class _Piece:
    """Some maps of a family: index of each, member and fingerprint."""

    batch: Batch
    solved: Solved
    members: tuple[tuple[int, Member, str], ...]
    folder: Path
    attributes: Mapping[str, Any]


def _made(piece: _Piece) -> list[Outcome]:
    """Make some maps of a family."""
    outcomes = []
    for index, member, fingerprint in piece.members:
        output, begin = piece.folder / f"{member.name}.nc", time.monotonic()
        marks = {**_marks(piece.batch, fingerprint, SHARED), **piece.attributes}
        try:
            dataset = make_map(piece.solved, index, output, marks)
            seconds = time.monotonic() - begin
            outcomes.append(_outcome(member, output, MADE, SHARED, dataset, True, seconds))
        except EhdmapsError as error:
            outcomes.append(Outcome(member, output, FAILED, SHARED, reason=str(error)))
    return outcomes


def _checked(what: tuple[Solved, int, Any]) -> Checked:
    """Check the laws of a member."""
    return check_member(*what)


def _each(
    function: Callable[[_Item], _Found], items: Sequence[_Item], workers: int
) -> Iterator[tuple[_Item, _Found | None]]:
    """Do something with each item, in worker processes where there are several; None where its process died."""
    if workers <= 1 or len(items) <= 1:
        for item in items:
            yield item, function(item)
        return
    running: dict[Future[_Found], _Item] = {}
    try:
        with worker_pool(min(workers, len(items))) as pool:
            for item in items:
                running[pool.submit(function, item)] = item
            for future in as_completed(list(running)):
                found = future.result()
                yield running.pop(future), found
    except WorkersDied as died:
        if not died.begun:
            raise died.error from None
        for item in running.values():
            yield item, None

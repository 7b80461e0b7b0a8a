"""Shards of a job or a batch: each process solves its part into a store of its own; merging brings the parts together.

Shard i of n takes every n-th of the tasks that are known before anything is solved, so that dear and cheap ones are
spread evenly. It writes no map. Nothing is shared between shards but the files that they read: they need no network,
no locks over machines, and any of them may be killed and begun again.

A store of a shard stands where that of the map would, with the shard in its name. Beside the results it holds one entry
that says what it belongs to.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.jobs.status import StatusFile
from ehdmaps.jobs.store import Arrays, Store, store_path
from ehdmaps.jobs.sweep import Progress, SweepResult, Task, sweep
from ehdmaps.version import version
from ehdmaps.workers import available_cores

MOST_SHARDS = 100_000

ABOUT = "about"
"""Key of the entry that says what a store of a shard belongs to."""

_NAME = re.compile(r"(?P<output>.+)\.shard-(?P<index>\d{1,6})-of-(?P<of>\d{1,6})\.store(?P<status>\.status)?")
_SHOWN = 20


@dataclass(frozen=True, order=True)
class Shard:
    """Part `index` of `of`, counted from one."""

    of: int
    index: int

    def __str__(self) -> str:
        return f"{self.index}/{self.of}"

    def part(self, tasks: Iterable[Task]) -> tuple[Task, ...]:
        """The tasks of this shard; of tasks with equal keys only the first one counts.

        Parameters
        ----------
        tasks : iterable of Task
            All tasks, in the order that every shard has them in.
        """
        return unique(tasks)[self.index - 1 :: self.of]


def unique(tasks: Iterable[Task]) -> tuple[Task, ...]:
    """Tasks without those whose key was there before.

    Parameters
    ----------
    tasks : iterable of Task
        All tasks.
    """
    found: dict[str, Task] = {}
    for task in tasks:
        found.setdefault(task.key, task)
    return tuple(found.values())


def read_shard(text: str) -> Shard:
    """Read a shard of a command line, "3/40".

    Parameters
    ----------
    text : str
        What was given.

    Raises
    ------
    ArgumentTypeError
        For anything but i/n with i from 1 to n.
    """
    match = re.fullmatch(r"(\d{1,6})/(\d{1,6})", text, re.ASCII)
    index, of = (int(part) for part in match.groups()) if match else (0, 0)
    if not 1 <= index <= of <= MOST_SHARDS:
        raise argparse.ArgumentTypeError(
            f"got {text[:40]!r}; allowed: i/n with i from 1 to n and n up to {MOST_SHARDS}, such as 3/40"
        )
    return Shard(of, index)


def shard_path(output: Path, shard: Shard) -> Path:
    """What the store and the status of a shard are named after.

    Parameters
    ----------
    output : Path
        What those of the whole are named after: the map, or `batch_path`.
    shard : Shard
        The shard.
    """
    return output.with_name(f"{output.name}.shard-{shard.index}-of-{shard.of}")


def found_shards(output: Path) -> dict[Shard, Path]:
    """Stores of shards that are there, by their shards in order.

    Parameters
    ----------
    output : Path
        What those of the whole are named after.
    """
    found = {}
    for path in output.parent.iterdir() if output.parent.is_dir() else ():
        match = _NAME.fullmatch(path.name)
        if match and match["output"] == output.name and not match["status"] and path.is_file():
            found[Shard(int(match["of"]), int(match["index"]))] = path
    return dict(sorted(found.items()))


def whole_of(name: str) -> str | None:
    """What the store or the status of a shard belongs to: the name of the map or the batch; None of other files.

    Parameters
    ----------
    name : str
        Name of a file.
    """
    match = _NAME.fullmatch(name)
    return None if match is None else match["output"]


def not_begun(shards: Iterable[Shard]) -> tuple[Shard, ...]:
    """Shards that are missing among those of the same counts.

    Parameters
    ----------
    shards : iterable of Shard
        Those that are there.
    """
    there = set(shards)
    counts = sorted({shard.of for shard in there})
    return tuple(Shard(of, index) for of in counts for index in range(1, of + 1) if Shard(of, index) not in there)


def solve_shard(
    tasks: Iterable[Task],
    output: Path,
    shard: Shard,
    what: str,
    sha256: str,
    workers: int | None = None,
    fresh: bool = False,
    progress: Callable[[int], Progress] | None = None,
    executor: Executor | None = None,
) -> SweepResult:
    """Solve one part of all tasks into the store of the shard.

    Parameters
    ----------
    tasks : iterable of Task
        All tasks.
    output : Path
        What the store of the whole is named after.
    shard : Shard
        Which part.
    what, sha256 : str
        What is made, in words, and the hash of its file.
    workers, fresh, progress, executor
        The same as for `generate`.

    Raises
    ------
    StoreError
        If the store cannot be read or written.
    """
    part = shard.part(tasks)
    points = sum(task.points for task in part)
    processes = workers or available_cores()
    place = shard_path(output, shard)
    with (
        Store(store_path(place), fresh) as store,
        StatusFile(place, f"{what}, shard {shard}", points, processes, stays=True) as status,
    ):
        store.put(ABOUT, _about(sha256), at_once=True)
        told = progress(points) if progress else None
        result = sweep(part, store, processes, told, [status], executor)
        return SweepResult({}, result.taken_over, result.solved, result.wall_seconds, result.damaged)


def _about(sha256: str) -> Arrays:
    """The entry that says what a store belongs to."""
    return {"sha256": np.array(sha256), "version": np.array(version("ehdmaps"))}


@dataclass(frozen=True)
class Merged:
    """What merging found.

    Attributes
    ----------
    shards : tuple of Shard
        Stores that were read.
    missing : tuple of Shard
        Shards without a store.
    incomplete : tuple of (Shard, int, int)
        Shards that are not finished, with the tasks that they have and should have.
    taken, wanted : int
        Tasks that the store of the whole has now, and all.
    """

    shards: tuple[Shard, ...]
    missing: tuple[Shard, ...]
    incomplete: tuple[tuple[Shard, int, int], ...]
    taken: int
    wanted: int

    @property
    def whole(self) -> bool:
        """Whether every task has its result."""
        return self.taken == self.wanted


def check_found(output: Path) -> dict[Shard, Path]:
    """Stores of shards, of which there must be some.

    Parameters
    ----------
    output : Path
        What those of the whole are named after.

    Raises
    ------
    InputError
        If there is none.
    """
    found = found_shards(output)
    if not found:
        raise InputError(
            f"{output}: no store of a shard is beside it; allowed: stores that `ehdmaps generate --shard i/n` made in "
            "that folder"
        )
    return found


def merge_shards(tasks: Sequence[Task], output: Path, sha256: str, store: Store) -> Merged:
    """Take what the stores of shards have into the store of the whole; they stay as they are.

    Parameters
    ----------
    tasks : sequence of Task
        All tasks.
    output : Path
        What the store of the whole is named after.
    sha256 : str
        Hash of the file of the job or batch.
    store : Store
        Store of the whole.

    Raises
    ------
    InputError
        If there is no store of a shard, or one belongs to something else: nothing is merged then.
    StoreError
        If a store cannot be read, or another process is busy with it.
    """
    all_tasks = unique(tasks)
    found = check_found(output)
    _refuse_foreign(found, all_tasks, sha256)
    incomplete = []
    for shard, path in found.items():
        part = shard.part(all_tasks)
        had = 0
        with Store(path) as other:
            for task in part:
                arrays = other.get(task.key)
                if arrays is not None:
                    had += 1
                    if store.get(task.key) is None:
                        store.put(task.key, arrays)
        if had < len(part):
            incomplete.append((shard, had, len(part)))
    store.commit()
    taken = sum(store.get(task.key) is not None for task in all_tasks)
    return Merged(tuple(found), not_begun(found), tuple(incomplete), taken, len(all_tasks))


def _refuse_foreign(found: dict[Shard, Path], tasks: Sequence[Task], sha256: str) -> None:
    """Raise where a store holds the results of another job, or of another version of the program."""
    here = version("ehdmaps")
    problems = []
    for shard, path in found.items():
        if not 1 <= shard.index <= shard.of:
            problems.append(f"{path}: is called shard {shard}, which there is none of; remove it")
            continue
        with Store(path) as other:
            about = other.get(ABOUT)
            if about is None:  # killed before its first result
                continue
            job, made = str(about.get("sha256", "")), str(about.get("version", ""))
            known = any(other.get(task.key) is not None for task in shard.part(tasks))
        if job != sha256:
            problems.append(
                f"{path}: holds results of another job file (or of this one before it was edited); allowed: the same "
                "file; move the store away, or solve the shard again"
            )
        elif made != here and not known:
            problems.append(
                f"{path}: holds results of ehdmaps {made:.60}, and here is {here}; allowed: the same version; solve "
                "the shard again"
            )
    if problems:
        raise InputError(problems)


def merged_text(merged: Merged, source: str) -> str:
    """Return what merging found, in words.

    Parameters
    ----------
    merged : Merged
        What was found.
    source : str
        The job or batch, as the command was given it.
    """
    lines = [f"{source}: {merged.taken} of {merged.wanted} tasks from the stores of {len(merged.shards)} shards"]
    if merged.missing:
        lines.append(f"missing shards: {listed(merged.missing)}")
    for shard, had, wanted in merged.incomplete[:_SHOWN]:
        lines.append(f"shard {shard}: not finished, {had} of {wanted} tasks; run `--shard {shard}` again")
    if len(merged.incomplete) > _SHOWN:
        lines.append(f"and {len(merged.incomplete) - _SHOWN} more that are not finished")
    return "\n".join(lines)


def listed(shards: Sequence[Shard]) -> str:
    """Name some shards, and say how many more there are.

    Parameters
    ----------
    shards : sequence of Shard
        The shards.
    """
    more = f", and {len(shards) - _SHOWN} more" if len(shards) > _SHOWN else ""
    return ", ".join(map(str, shards[:_SHOWN])) + more

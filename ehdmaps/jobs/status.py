"""How far a map is, for others to look at: a small file beside the store while the map is being made.

The process that makes the map holds a lock on the file, which the operating system drops with the process, however it
ends: a file that nobody holds is one of a run that was interrupted. Every version of the file is a new one, locked
before it gets its name, so that whoever looks at it never gets into the way of the run. At the end of a run that
finishes, the file is deleted: the map is there.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import platform
import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.progress import Pace
from ehdmaps.jobs.store import Arrays, store_path
from ehdmaps.jobs.sweep import Task
from ehdmaps.outputs import MARK, Kind, Output, has_mark, new_part, output_problems
from ehdmaps.physics.solution import Status

WRITE_SECONDS = 2.0
"""Between two versions of the file, but for points that take long themselves."""

STATUS = Kind("a status of ehdmaps", (), has_mark)

_LONGEST = 100_000
_MOST = 10**15
"""Largest count of anything; beyond it shares and rates are no numbers any more."""

_TRIALS = 10


@dataclass(frozen=True)
class RunStatus:
    """How far a map was when the file was written.

    Attributes
    ----------
    job : str
        What is made, in words.
    process, host, workers
        Who works on it.
    begun, written : str
        Dates and times, UTC, of the run's begin and of this status.
    total, done, taken_over : int
        Points: all, those that have a result, and those of them that an earlier run left.
    failed : dict
        Points without a solution so far, by the word of their status.
    rate : float or None
        Points a second; None as long as nobody can know.
    """

    job: str
    process: int
    host: str
    workers: int
    begun: str
    written: str
    total: int
    done: int = 0
    taken_over: int = 0
    failed: Mapping[str, int] = field(default_factory=dict)
    rate: float | None = None


@dataclass(frozen=True)
class Seen:
    """A status, and whether a process works on the map now.

    `known` is False where that cannot be told: on another machine, or a file system without locks, a lock that is not
    seen may be held. Only the time of the last sign tells something then.
    """

    status: RunStatus
    running: bool
    known: bool = True


class StatusFile:
    """Keeps the file of a map that is being made; use it in a `with` statement, while the store is held.

    It never ends the run: where the file cannot be written, there is none.

    Parameters
    ----------
    output : Path
        The map.
    about : str
        What is made, see `about`.
    total : int
        Number of points.
    workers : int
        Number of processes.
    """

    def __init__(self, output: Path, about: str, total: int, workers: int) -> None:
        self._path = status_path(output)
        self._about = {
            "job": about,
            "process": os.getpid(),
            "host": platform.node(),
            "workers": workers,
            "begun": _now(),
            "total": total,
        }
        self._pace = Pace(total)
        self._taken_over = 0
        self._failed: Counter[int] = Counter()
        self._held: int | None = None
        self._allowed = not output_problems([Output("", self._path, STATUS)])
        self._last = -WRITE_SECONDS

    def __enter__(self) -> Self:
        self.write()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is not None:
            self.write()
        elif self._held is not None:
            with contextlib.suppress(OSError):
                self._path.unlink()
        if self._held is not None:
            os.close(self._held)

    def more(self, points: int) -> None:
        """There are so many more points to solve than was said."""
        self._pace.total += points
        self._about["total"] = self._pace.total
        self.write()

    def found(self, task: Task, arrays: Arrays, now: bool) -> None:
        """Count a result, and write now and then.

        Parameters
        ----------
        task : Task
            What was solved, or found in the store.
        arrays : Arrays
            Result of the task.
        now : bool
            True if it was solved now, False if the store had it.
        """
        if now:
            self._pace.solved(task.points)
        else:
            self._pace.taken_over(task.points)
            self._taken_over += task.points
        values, counts = np.unique(arrays["status"], return_counts=True)
        self._failed.update(dict(zip(values.tolist(), counts.tolist(), strict=True)))
        if time.monotonic() - self._last >= WRITE_SECONDS or (now and task.slow):
            self.write()

    def write(self) -> None:
        """Write the file."""
        self._last = time.monotonic()
        if not self._allowed:
            return
        failed = {Status(value).word: count for value, count in self._failed.items() if not Status(value).usable}
        status = RunStatus(
            **self._about,  # type: ignore[arg-type]
            written=_now(),
            done=self._pace.done,
            taken_over=self._taken_over,
            failed=failed,
            rate=self._pace.rate,
        )
        with contextlib.suppress(OSError):
            self._replace(json.dumps({"mark": MARK, **asdict(status)}).encode())

    def _replace(self, content: bytes) -> None:
        """Write a new file, locked before it gets the name."""
        aside, descriptor = new_part(self._path)
        try:
            with contextlib.suppress(OSError):  # a file system without locks: the file still tells how far it is
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            os.write(descriptor, content)
            aside.replace(self._path)
        except OSError:
            os.close(descriptor)
            aside.unlink(missing_ok=True)
            raise
        if self._held is not None:
            os.close(self._held)
        self._held = descriptor


def about(job: Job) -> str:
    """What is made, in words."""
    return f"{job.title}, {job.lubricant.title}, solver {job.solver}"


def status_path(output: Path) -> Path:
    """Return the file that tells how far a map is."""
    store = store_path(output)
    return store.with_name(f"{store.name}.status")


def look(output: Path) -> Seen | None:
    """Look at how far a map is, without getting into the way of who makes it.

    Parameters
    ----------
    output : Path
        The map.

    Returns
    -------
    Seen or None
        None if no run is under way, nor was interrupted.

    Raises
    ------
    InputError
        If the file is none of ours.
    """
    path = status_path(output)
    try:
        for _ in range(_TRIALS):
            with path.open("rb") as file:
                content = file.read(_LONGEST)
                running = _is_held(file.fileno())
                # One that was replaced since it was opened is not held any more.
                if running or os.path.samestat(os.fstat(file.fileno()), path.stat()):
                    status = _parsed(path, content)
                    known = running is not None and (running or status.host == platform.node())
                    return Seen(status, bool(running), known)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); see to its permissions") from error
    return Seen(_parsed(path, content), running=True)  # it was replaced every time


def _is_held(descriptor: int) -> bool | None:
    """Whether another process holds the lock of an open file; None where the file system has no locks."""
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return None
    return False


def _parsed(path: Path, content: bytes) -> RunStatus:
    """Read a status."""
    try:
        values: dict[str, Any] = json.loads(content)
        del values["mark"]
        status = RunStatus(**values)
        numbers = (
            status.process,
            status.workers,
            status.total,
            status.done,
            status.taken_over,
            *status.failed.values(),
        )
        texts = (status.job, status.host, *status.failed)
        sound = all(type(value) is int and 0 <= value <= _MOST for value in numbers)
        sound = sound and all(type(text) is str for text in texts)
        sound = sound and (status.rate is None or (type(status.rate) is float and 0.0 < status.rate < np.inf))
        for moment in (status.begun, status.written):
            sound = sound and datetime.fromisoformat(moment).tzinfo is not None
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        sound = False
    if not sound:
        raise InputError(
            f"{path}: is not the status of a map that is being made; allowed: a file written by `ehdmaps generate`; "
            "remove it"
        )
    return status


def _now() -> str:
    """Date and time."""
    return datetime.now(UTC).isoformat(timespec="seconds")

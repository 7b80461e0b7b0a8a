"""Progress of a map: on stderr for the one who waits, and in a small file beside the store for others.

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
import sys
import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from math import inf
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np

from ehdmaps.compiling import Compiling
from ehdmaps.errors import InputError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.store import Arrays, store_path
from ehdmaps.jobs.make.sweep import Task
from ehdmaps.outputs import MARK, Kind, Output, has_mark, new_part, output_problems
from ehdmaps.physics.solution import Status
from ehdmaps.program import tell

LINE_SECONDS = 10.0
"""Between two plain lines; a log of a night stays readable."""

FIRST_SECONDS = 0.05
"""What is told this soon after the first piece of work belongs to it: runs in time tell many steps at once."""

LONGEST_SHARE = 0.5 + 1e-9
"""Of the time counted that one wait may make up where a rate is stated; two equal waits are enough of them."""

_BAR = "{percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt} {unit}s [{elapsed}{postfix}]"

_DURATIONS = ((120.0, 1.0, "s"), (7200.0, 60.0, "min"), (172800.0, 3600.0, "h"), (inf, 86400.0, "days"))
"""Up to which time [s] which unit [s] is shown."""


class Pace:
    """Pace of the work, and the time that it will take.

    It counts from the end of the first piece of work on, and leaves out what this process compiles. There is no
    estimate as long as one wait makes up more than half of the time counted: other processes may compile, too, and what
    that takes says nothing about the rest.

    Parameters
    ----------
    total : int
        Points, steps or hits.
    clock : callable
        Gives the time [s].
    compiled : callable, optional
        Gives what has been spent on compiling so far [s]; nothing if left out.
    """

    def __init__(
        self, total: int, clock: Callable[[], float] = time.monotonic, compiled: Callable[[], float] | None = None
    ) -> None:
        self.total = total
        self.done = 0
        self._clock = clock if compiled is None else lambda: clock() - compiled()
        self._first_told: float | None = None
        self._since = self._last = 0.0, 0
        self._longest = 0.0

    def taken_over(self, count: int) -> None:
        """Count what was there."""
        self.done += count

    def solved(self, count: int) -> None:
        """Count what is done now."""
        self.done += count
        now = self._clock()
        waited = now - self._last[0]
        self._last = now, self.done
        if self._first_told is None:
            self._first_told = now
        if now <= self._first_told + FIRST_SECONDS:
            self._since = self._last
        else:
            self._longest = max(self._longest, waited)

    @property
    def rate(self) -> float | None:
        """Number a second [1/s]; None as long as nobody can know."""
        seconds, count = self._last[0] - self._since[0], self._last[1] - self._since[1]
        return count / seconds if seconds > 0.0 and self._longest <= LONGEST_SHARE * seconds else None

    @property
    def seconds_left(self) -> float | None:
        """Expected time to the end [s]; None as long as nobody can know."""
        if self.done >= self.total:
            return 0.0
        return None if self.rate is None else (self.total - self.done) / self.rate

    def text(self, unit: str) -> str:
        """Rate and time left in words; empty as long as nobody can know."""
        if self.rate is None or self.seconds_left is None:
            return ""
        return f"{self.rate:.3g} {unit}s/s, {duration(self.seconds_left)} left"


class Bar:
    """A tqdm bar with rate and time left; what was taken over does not count for the rate."""

    def __init__(self, total: int, unit: str = "point") -> None:
        self._compiling = Compiling(self._say)
        self._pace = Pace(total, compiled=lambda: self._compiling.seconds)
        self._unit = unit
        self._bar: Any = None
        self._compiling.listen()

    def begin(self) -> None:
        """Begin with nothing."""
        self.taken_over(0)

    def taken_over(self, count: int) -> None:
        """Begin at what was there."""
        from tqdm import tqdm

        self._pace.taken_over(count)
        self._bar = tqdm(
            total=self._pace.total, initial=count, file=_Stderr(), dynamic_ncols=True, bar_format=_BAR, unit=self._unit
        )

    def solved(self, count: int) -> None:
        """Advance."""
        self._pace.solved(count)
        self._bar.set_postfix_str(self._pace.text(self._unit), refresh=False)
        self._bar.update(count)
        if self._bar.n >= self._bar.total:
            self._bar.close()
            self._compiling.end()

    def _say(self, text: str) -> None:
        """Say something above the bar."""
        if self._bar is None:
            tell(text)
        else:
            self._bar.write(text, file=_Stderr())


class Lines:
    """One line at the beginning, one every `LINE_SECONDS`, one at the end."""

    def __init__(self, total: int, unit: str = "point") -> None:
        self._compiling = Compiling(tell)
        self._pace = Pace(total, compiled=lambda: self._compiling.seconds)
        self._unit = unit
        self._last = time.monotonic()
        self._compiling.listen()

    def begin(self) -> None:
        """Begin with nothing, which is not worth a line."""

    def taken_over(self, count: int) -> None:
        """Say how much was there."""
        self._pace.taken_over(count)
        tell(f"{count} of {self._pace.total} {self._unit}s taken over")

    def solved(self, count: int) -> None:
        """Count, and say so now and then."""
        self._pace.solved(count)
        now = time.monotonic()
        if self._pace.done >= self._pace.total or now - self._last >= LINE_SECONDS:
            pace = self._pace.text(self._unit)
            tell(f"{self._pace.done} of {self._pace.total} {self._unit}s{pace and ', '}{pace}")
            self._last = now
        if self._pace.done >= self._pace.total:
            self._compiling.end()


class _Stderr:
    """Stderr for a bar, which must not end a run because nobody can see it."""

    encoding = property(lambda _: sys.stderr.encoding)

    def write(self, text: str) -> None:
        """Write, if it is possible."""
        with contextlib.suppress(OSError, ValueError):
            sys.stderr.write(text)

    def flush(self) -> None:
        """Flush, if it is possible."""
        with contextlib.suppress(OSError, ValueError):
            sys.stderr.flush()

    def isatty(self) -> bool:
        """Tell whether it is a terminal."""
        return sys.stderr.isatty()

    def fileno(self) -> int:
        """Return its number, for its width."""
        return sys.stderr.fileno()


def progress(total: int, unit: str = "point") -> Bar | Lines:
    """Return what suits stderr.

    Parameters
    ----------
    total : int
        How many there are.
    unit : str
        What is counted, in the singular: point, step, hit.
    """
    terminal = sys.stderr is not None and sys.stderr.isatty()
    return Bar(total, unit) if terminal else Lines(total, unit)


def duration(seconds: float) -> str:
    """Return a time in the unit that a reader would choose, such as "12 min"."""
    size, unit = next((size, unit) for limit, size, unit in _DURATIONS if seconds < limit)
    value = seconds / size
    return f"{value:.0f} {unit}" if value >= 10.0 or unit == "s" else f"{value:.1f} {unit}"


WRITE_SECONDS = 2.0
"""Between two versions of the file, but for points that take long themselves."""

STATUS = Kind("a status of ehdmaps", (), has_mark)

_LONGEST = 100_000
_MOST = 10**15
"""Largest count of anything; beyond it shares and rates are no numbers any more."""

_TRIALS = 10


@dataclass(frozen=True)
class RunStatus:
    """Progress of a map when the file was written.

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
        Points without a solution so far, by the word of their status and the solver.
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
        self._failed: Counter[str] = Counter()
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
        """Count a result, and write now and then; arguments as of `Watch.found`."""
        if now:
            self._pace.solved(task.points)
        else:
            self._pace.taken_over(task.points)
            self._taken_over += task.points
        found = map(Status, arrays["status"].tolist())
        self._failed.update(f"{status.word} by {task.by}" for status in found if not status.usable)
        if time.monotonic() - self._last >= WRITE_SECONDS or (now and task.slow):
            self.write()

    def told(self, words: str) -> None:
        """Nothing of it is in the file."""

    def write(self) -> None:
        """Write the file."""
        self._last = time.monotonic()
        if not self._allowed:
            return
        status = RunStatus(
            **self._about,  # type: ignore[arg-type]
            written=_now(),
            done=self._pace.done,
            taken_over=self._taken_over,
            failed=dict(self._failed),
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
    """Description of what is made, in words."""
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
    """Tell whether another process holds the lock of an open file; None where the file system has no locks."""
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

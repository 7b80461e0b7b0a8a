"""The log of a map: what happened in all runs that worked on it, for whoever looks in the morning.

It stands beside the map and its store and is the store's story: every run of the same command adds to it, one with
`--fresh` begins both anew. A run that was killed writes no end; the next one says so. Every line is with the system
before the work goes on, so that kill -9 loses none. The log never ends a run: a full disk only makes it shorter.
"""

from __future__ import annotations

import contextlib
import os
import platform
import shlex
import shutil
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Self

from ehdmaps.errors import EhdmapsError, InputError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.assemble import package_versions
from ehdmaps.jobs.make.status import Pace, about, duration
from ehdmaps.jobs.make.store import Arrays
from ehdmaps.jobs.make.sweep import Task
from ehdmaps.jobs.make.tasks import solver_version
from ehdmaps.outputs import MARK, Kind, Output, check_outputs, has_mark
from ehdmaps.physics.solution import ContactSolver, Status
from ehdmaps.program import plain

LOG = Kind("a log of ehdmaps", (), has_mark)

PACE_SECONDS = 600.0
"""Between two lines that say how far the run is."""

_BEGIN, _END = "begin: ", "end: "
_TIME = len("2026-01-01T00:00:00+00:00")


def log_path(output: Path) -> Path:
    """Return the log that belongs to a map file."""
    return output.with_name(output.name + ".log")


def job_lines(job: Job, *solvers: ContactSolver | None) -> Iterator[str]:
    """Yield what is made and by which solvers, for the beginning of a log.

    Parameters
    ----------
    job : Job
        What is made.
    *solvers : ContactSolver or None
        What solves it, and what corrects that.
    """
    yield f"job: {about(job)}; sha256 {job.sha256}"
    for solver in filter(None, solvers):
        settings = ", ".join(f"{name} {value}" for name, value in solver.settings().items())
        yield f"solver {solver.name}: {settings}; version {solver_version(solver)}"
    yield from (f"| {line}".rstrip() for line in job.text.splitlines())


class RunLog:
    """Log of a run, which adds to those of earlier runs; use it in a `with` statement, while the store is held.

    Parameters
    ----------
    output : Path
        The map.
    about : iterable of str
        Lines on what is made.
    total : int
        Number of points.
    workers : int
        Number of processes.
    fresh : bool
        Begin the file anew, as the store is.

    Raises
    ------
    InputError
        If something else stands in its place, or it cannot be written.
    """

    def __init__(self, output: Path, about: Iterable[str], total: int, workers: int, fresh: bool = False) -> None:
        self.path = log_path(output)
        self._about = (*_process_lines(output, workers), f"points: {total}", *about)
        self._pace = Pace(total)
        self._fresh = fresh
        self._taken_over = 0
        self._began = self._told = time.monotonic()
        self._summary: list[str] = []

    def __enter__(self) -> Self:
        check_outputs([Output("log", self.path, LOG)])
        killed = False
        try:
            if self._fresh:
                self.path.unlink(missing_ok=True)
            elif self.path.exists():
                killed = _has_no_end(self.path)
            with self.path.open("a", encoding="utf-8") as file:
                if file.tell() == 0:
                    file.write(f"# {MARK}: what happened in every run that worked on this map\n")
        except OSError as error:
            raise InputError(
                f"log {self.path}: cannot be written ({error.strerror}); allowed: a file in a folder that may be "
                "written, with space on the disk"
            ) from error
        if killed:
            self.told(f"{_END}the run before wrote none: it was killed, or the machine went down")
        self.told(f"{_BEGIN}{_command()}", self._about)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._tell_taken_over()
        taken = f"after {duration(time.monotonic() - self._began)}"
        if error is None:
            self.told(f"{_END}finished {taken}", self._summary)
        elif isinstance(error, KeyboardInterrupt):
            self.told(f"{_END}stopped {taken}, by Ctrl-C or SIGTERM; the same command goes on")
        else:
            name = "" if isinstance(error, EhdmapsError) else f"{type(error).__name__}: "
            self.told(f"{_END}failed {taken}: {name}{_line(error)}")

    def finish(self, summary: str) -> None:
        """Keep the summary of a run that is done, for the end of the log."""
        self._summary = summary.splitlines()

    def more(self, points: int) -> None:
        """There are so many more points to solve than was said."""
        if points:
            self._pace.total += points
            self.told(f"{points} more points to solve")

    def found(self, task: Task, arrays: Arrays, now: bool) -> None:
        """Tell of points that have no solution, and of what a point that took long has noted; now and then the pace.

        The story of a point that the store had was told when it was solved; arguments as of `Watch.found`.
        """
        if not now:
            self._pace.taken_over(task.points)
            self._taken_over += task.points
            return
        self._tell_taken_over()
        self._pace.solved(task.points)
        for (code, reason), index in _causes(arrays).items():
            status = Status(code)
            if not status.usable or (task.slow and reason):
                self.told(f"{status.word}: {task.where(index)}, by {task.by}: {reason or 'no cause given'}")
        if time.monotonic() - self._told >= PACE_SECONDS:
            self._told = time.monotonic()
            self.told(f"{self._pace.done} of {self._pace.total} points, {self._pace.text('point')}".rstrip(", "))

    def told(self, words: str, further: Sequence[str] = ()) -> None:
        """Write a line with the time, and lines below it.

        Parameters
        ----------
        words : str
            What happened.
        further : sequence of str
            What stands below.
        """
        text = "".join([f"{_now()} {_line(words)}\n", *(f"  {plain(line)}\n" for line in further)])
        with contextlib.suppress(OSError), self.path.open("a", encoding="utf-8", errors="backslashreplace") as file:
            file.write(text)

    def _tell_taken_over(self) -> None:
        """Say how many points the store had, before anything else is said."""
        count, self._taken_over = self._taken_over, 0
        if count:
            self.told(f"{count} points taken over from the store")


def _causes(arrays: Arrays) -> dict[tuple[int, str], list[int]]:
    """Points of a task by status and reason."""
    causes: dict[tuple[int, str], list[int]] = {}
    for index, (status, reason) in enumerate(zip(arrays["status"].tolist(), arrays["reason"].tolist(), strict=True)):
        causes.setdefault((status, reason), []).append(index)
    return causes


def _command() -> str:
    """The command of this process; of a script its name."""
    name, *arguments = sys.argv or [""]
    return shlex.join([Path(name).name, *arguments])


def _process_lines(output: Path, workers: int) -> Iterator[str]:
    """Who works, with what, and where there is how much space."""
    yield f"process {os.getpid()} on {platform.node()} with {workers} workers, in {Path.cwd()}"
    yield f"versions: {', '.join(f'{name} {version}' for name, version in package_versions().items())}"
    places = {"temporary files": Path(tempfile.gettempdir()), "map and store": output.absolute().parent}
    for words, folder in places.items():
        with contextlib.suppress(OSError):
            yield f"space for {words}: {shutil.disk_usage(folder).free / 1e9:.3g} GB free in {folder}"


def _has_no_end(path: Path) -> bool:
    """Tell whether the last run in a log wrote no end."""
    begun = False
    with path.open(encoding="utf-8", errors="replace") as file:
        for line in file:
            if not line.startswith(" "):
                words = line[_TIME + 1 :]
                begun = words.startswith(_BEGIN) or (begun and not words.startswith(_END))
    return begun


def _line(words: object) -> str:
    """Words in one line."""
    return plain(" ".join(str(words).split()))


def _now() -> str:
    """Date and time."""
    return datetime.now(UTC).isoformat(timespec="seconds")

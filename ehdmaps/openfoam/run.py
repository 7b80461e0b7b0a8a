"""One program in one case: what it left behind, or why it failed."""

from __future__ import annotations

import os
import re
import signal
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ehdmaps.errors import SolverError
from ehdmaps.openfoam.pyfoam import Runner
from ehdmaps.physics.solution import Status

LOG_LINES = 4
"""Last lines of a log that a message quotes."""

LONGEST_QUOTE = 120
"""Characters of each of them."""

SHORTEST = 0.1
"""Seconds that a run has at least."""

_FROM_OUTSIDE = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
_FRAME = re.compile(r"#\d+\s")
_FATAL = re.compile(r"FOAM FATAL (?:IO )?ERROR")


@dataclass
class TimeLimit:
    """Time that a point has, all its runs together, less the time in which these wait for a processor.

    Attributes
    ----------
    seconds : float
        The time [s].
    began : float
        When it began, by the clock `time.monotonic` [s].
    waited : float
        Time in which its runs waited for a processor so far [s].
    """

    seconds: float
    began: float = field(default_factory=time.monotonic)
    waited: float = 0.0

    @property
    def left(self) -> float:
        """Rest of the time, at least a tenth of a second [s]."""
        return max(self.seconds + self.waited - (time.monotonic() - self.began), SHORTEST)


class RunError(SolverError):
    """A run that gave no solution.

    Parameters
    ----------
    message : str
        What happened, the last lines of the log, and the log's path.
    status : Status
        Status of the point.
    iterations : int
        Done until then.
    case : Path, optional
        Folder of the case, where that is left.
    """

    def __init__(
        self, message: str, status: Status = Status.FAILED, iterations: int = 0, case: Path | None = None
    ) -> None:
        super().__init__(message)
        self.status = status
        self.iterations = iterations
        self.case = case


class KilledError(RunError):
    """A run whose process was killed by somebody else; it may be tried again."""


def run(program: Path, case: Path, environment: Mapping[str, str], limit: TimeLimit) -> Path:
    """Run a program of OpenFOAM in a case; its log is `log.NAME.logfile` there.

    The program ends with this process, however that ends, and with Ctrl-C.

    Parameters
    ----------
    program : Path
        Takes ``-case``.
    case : Path
        The case folder.
    environment : mapping
        Environment variables of the program.
    limit : TimeLimit
        Limit after which it is killed; what it waits for a processor is added to it.

    Returns
    -------
    Path
        The log.

    Raises
    ------
    RunError
        If it cannot be started, crashes, or does not end in time.
    KilledError
        If it was killed from outside.
    KeyboardInterrupt
        On Ctrl-C.
    """
    name = program.name
    command = ["setpriv", "--pdeathsig", "KILL", str(program), "-case", str(case)]
    try:
        runner = Runner(command, name, case, {**environment, "PWD": str(case)}, limit.left)
    except OSError as error:
        raise RunError(f"{name} cannot be started: {error.strerror}; case {case}") from error
    runner.complete()
    child = runner.run
    limit.waited += child.waited
    code = child.process.returncode
    log = Path(runner.logName())
    tail = log_tail(log)
    if child.stopped:
        raise RunError(f"{name} {child.stopped}; {tail}")
    if code < 0:
        kind = KilledError if -code in _FROM_OUTSIDE else RunError
        word = "was killed by" if kind is KilledError else "crashed with"
        raise kind(f"{name} {word} signal {-code} ({signal.Signals(-code).name}); {tail}")
    if code != 0 or not runner.runOK():
        raise RunError(f"{name} ended with status {code}; {tail}")
    return log


def log_tail(log: Path) -> str:
    """Return the last lines of a log, from the fatal error on if it has one, and its path, on one line.

    The calls that a crash lists say nothing to a reader; what stands before them does.
    """
    with log.open("rb") as file:
        file.seek(max(log.stat().st_size - 20_000, 0), os.SEEK_SET)
        lines = [line.strip() for line in file.read().decode("utf-8", "replace").splitlines() if line.strip()]
    lines = [line for line in lines if not _FRAME.match(line)]
    fatal = next((i for i, line in enumerate(lines) if _FATAL.search(line)), None)
    chosen = lines[-LOG_LINES:] if fatal is None else lines[fatal + 1 : fatal + 1 + LOG_LINES]
    quote = " | ".join(line[:LONGEST_QUOTE] for line in chosen) or "none"
    quote = "".join(character if character.isprintable() else "?" for character in quote)
    return f"last lines of the log: {quote}; log {log}"

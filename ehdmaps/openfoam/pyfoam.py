"""The only door to PyFoam: runs a program without a shell, and parses small dictionaries.

PyFoam on its own passes command lines to a shell, keeps a log in the user's home, writes tables of its grammar into the
folder for temporary files and imports such tables from wherever Python looks, and prints on stdout.
"""

from __future__ import annotations

import io
import logging
import os
import signal
import subprocess
import sys
import tempfile
import threading
import warnings
from collections.abc import Mapping, Sequence
from contextlib import redirect_stdout, suppress
from functools import partial
from pathlib import Path
from time import time
from typing import Any

from ehdmaps.errors import SolverError
from ehdmaps.extras import needs

with needs("openfoam", "PyFoam", "the solver 'openfoam'"), warnings.catch_warnings():
    warnings.simplefilter("ignore")  # escape sequences in its regular expressions
    from PyFoam.Basics import PlyParser
    from PyFoam.Execution.BasicRunner import BasicRunner
    from PyFoam.Execution.FoamThread import FoamThread
    from PyFoam.Infrastructure import Logging
    from PyFoam.RunDictionary.ParsedParameterFile import ParsedBoundaryDict, ParsedParameterFile

LONGEST_LINE = 10_000
"""Characters after which a line of output is broken."""

LONGEST_OUTPUT = 50_000_000
"""Characters of output after which a program is stopped."""

SOME = 0.01
"""Part of its time that a program must have waited for a processor to be given that time once more."""

LARGEST_DICTIONARY = 1_000_000
"""Bytes of a dictionary that is parsed; fields are read without PyFoam."""

PlyParser.yacc.yacc = partial(PlyParser.yacc.yacc, write_tables=False)
PlyParser.getUserTempDir = tempfile.gettempdir
sys.modules["PlyParser_FoamFileParser_parsetab"] = None  # type: ignore[assignment]
if "general" not in Logging._definedLoggers:
    # PyFoam gives a logger that it does not know a file in the user's home
    Logging._definedLoggers.append("general")
    logging.getLogger("general").addHandler(logging.NullHandler())
    logging.getLogger("general").propagate = False


class Child(FoamThread):  # type: ignore[misc]
    """The process of a runner: started without a shell, in a process group of its own, for a limited time.

    The thread waits for its end; the runner reads its output.
    """

    def __init__(
        self, runner: BasicRunner, command: Sequence[str], environment: Mapping[str, str], seconds: float
    ) -> None:
        super().__init__(" ".join(command), runner)
        self.seconds = seconds
        self.waited = 0.0
        self.stopped = ""
        self.printed = 0
        self.process = subprocess.Popen(
            command,
            cwd=runner.dir,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            errors="replace",
            start_new_session=True,
        )

    def run(self) -> None:
        """Wait for the end of the process, or of its time."""
        self.timeStart = time()
        self.hasSomethingToSay = True
        self.stateLock.release()
        self._let_run(self.seconds)
        with suppress(ChildProcessError):  # another thread has seen its end
            os.waitid(os.P_PID, self.process.pid, os.WEXITED | os.WNOWAIT)
        self._look()
        self.process.wait()  # wait with a timeout looks only every 50 ms
        self._alarm.cancel()
        self.timeEnd = time()

    def _let_run(self, seconds: float) -> None:
        """Give it some more time."""
        self._alarm = threading.Timer(seconds, self._late)
        self._alarm.daemon = True
        self._alarm.start()

    def _late(self) -> None:
        """Its time is over, but for that in which it waited for a processor."""
        before = self.waited
        self._look()
        if self.waited - before > SOME * self.seconds:
            self._let_run(self.waited - before)
        else:
            self.kill(f"did not end within the {self.seconds:.3g} s that it had and was stopped")

    def _look(self) -> None:
        """Note how long it has waited for a processor; nothing new where it is gone."""
        self.waited = max(waited_for_processor(self.process.pid), self.waited)

    def read(self) -> None:
        """Read a line of output; at the end of it the state becomes false."""
        assert self.process.stdout is not None
        line = self.process.stdout.readline(LONGEST_LINE)
        self.printed += len(line)
        if self.printed > LONGEST_OUTPUT:
            self.kill(f"printed more than {LONGEST_OUTPUT // 1_000_000} MB and was stopped")
        self.line = line.rstrip()
        self.hasSomethingToSay = bool(line)

    def interrupt(self, pass_int: bool = False) -> None:
        """End at once: Ctrl-C."""
        self.kill("was interrupted")
        self.hasSomethingToSay = False

    def kill(self, why: str) -> None:
        """End the process and its children."""
        if self.process.poll() is None:
            self.stopped = why
            with suppress(ProcessLookupError):
                os.killpg(self.process.pid, signal.SIGKILL)

    def close(self) -> None:
        """Leave no process, thread or pipe behind."""
        self.kill("was interrupted")
        if self.is_alive():
            self.join()
        self.process.wait()
        if self.process.stdout is not None:
            self.process.stdout.close()


def waited_for_processor(process: int) -> float:
    """Time in which a process could have run, but others had the processors [s]; 0 where the system does not tell.

    Parameters
    ----------
    process : int
        Process number.
    """
    try:
        return 1e-9 * int(Path(f"/proc/{process}/schedstat").read_text().split()[1])
    except (OSError, ValueError, IndexError):
        return 0.0


class Runner(BasicRunner):  # type: ignore[misc]
    """PyFoam's runner with a `Child`: a log in the case folder, nothing printed, no files of state.

    Parameters
    ----------
    command : sequence of str
        Program and arguments.
    name : str
        Name of the log, "log.NAME.logfile".
    case : Path
        The case folder, where the program runs.
    environment : mapping
        Environment variables of the program.
    seconds : float
        Time after which the program is killed, without that in which it waits for a processor [s].

    Raises
    ------
    OSError
        If the program cannot be started.
    """

    def __init__(
        self, command: Sequence[str], name: str, case: Path, environment: Mapping[str, str], seconds: float
    ) -> None:
        super().__init__(argv=[name, "-case", str(case)], silent=True, logname=f"log.{name}", writeState=False)
        self.run = Child(self, command, environment, seconds)

    def complete(self) -> None:
        """Run to the end.

        Raises
        ------
        KeyboardInterrupt
            On Ctrl-C, when the program is dead.
        """
        try:
            data = self.start()
            # the output has ended; a program that closed it and goes on still has its time
            self.run.join()
        finally:
            self.run.close()
        if data["keyboardInterrupt"]:
            raise KeyboardInterrupt


def parse(path: Path, boundary: bool = False) -> Mapping[str, Any]:
    """Parse a small dictionary; macros are not expanded.

    Parameters
    ----------
    path : Path
        The dictionary.
    boundary : bool
        Whether it is a list of patches, as polyMesh/boundary is.

    Raises
    ------
    SolverError
        If there is no such file, or it is no dictionary.
    """
    try:
        if path.stat().st_size > LARGEST_DICTIONARY:
            raise SolverError(f"{path}: longer than {LARGEST_DICTIONARY} bytes; allowed: a small dictionary")
        with redirect_stdout(io.StringIO()):  # where the parser prints what it could not read
            parsed = ParsedBoundaryDict(str(path)) if boundary else ParsedParameterFile(str(path))
        return dict(parsed.content)
    except FileNotFoundError as error:
        raise SolverError(f"{path}: is not there") from error
    except SolverError:
        raise
    except Exception as error:  # garbage makes the parser raise anything
        raise SolverError(f"{path}: is no OpenFOAM dictionary ({type(error).__name__})") from error

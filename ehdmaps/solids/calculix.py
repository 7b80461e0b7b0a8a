"""CalculiX as a program: whether it is here, its version, and a run of a deck."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

from ehdmaps.errors import AnalysisError, InputError

LONGEST_RUN = 600.0
"""Seconds after which CalculiX is stopped."""

LOG_LINES = 4
"""Last lines of its output that a message quotes."""

_VERSION = re.compile(r"Version\s+(\S+)")


def program(purpose: str) -> str:
    """Path of CalculiX.

    Parameters
    ----------
    purpose : str
        What needs it, for the message.

    Raises
    ------
    InputError
        If it is missing.
    """
    path = shutil.which("ccx")
    if path is None:
        raise InputError(f"CalculiX: ccx is not in PATH; {purpose} needs it: on Debian apt-get install calculix-ccx")
    return path


def version(purpose: str) -> str:
    """Version of CalculiX.

    Parameters
    ----------
    purpose : str
        What needs it, for the message.

    Raises
    ------
    InputError
        If it is missing.
    """
    result = subprocess.run([program(purpose), "-v"], capture_output=True, text=True, check=False, timeout=60.0)
    match = _VERSION.search(result.stdout)
    return match[1] if match else "unknown"


def run_deck(text: str, folder: Path, job: str, purpose: str, longest: float | None = None) -> None:
    """Run CalculiX on a deck in a folder; its files JOB.dat, JOB.frd and so on are there after.

    Parameters
    ----------
    text : str
        The deck.
    folder : Path
        Folder of the deck and of the files of CalculiX.
    job : str
        Name of the files without ending.
    purpose : str
        What needs CalculiX, for the message.
    longest : float, optional
        Seconds after which it is stopped; `LONGEST_RUN` without.

    Raises
    ------
    InputError
        If CalculiX is missing.
    AnalysisError
        If it fails.
    """
    (folder / f"{job}.inp").write_text(text, "ascii")
    log = folder / f"{job}.log"
    command, longest = [program(purpose), "-i", job], LONGEST_RUN if longest is None else longest
    try:
        with log.open("wb") as output:
            result = subprocess.run(
                command,
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                timeout=longest,
                check=False,
                # Threads pay for larger models only, and change the last digits.
                env={**os.environ, "OMP_NUM_THREADS": "1"},
            )
    except subprocess.TimeoutExpired as error:
        raise AnalysisError(f"CalculiX: not done after {longest:.0f} s; take larger elements; {_tail(log)}") from error
    except OSError as error:
        raise AnalysisError(f"CalculiX: {command[0]} cannot be started: {error.strerror}") from error
    if result.returncode != 0:
        raise AnalysisError(f"CalculiX: ended with status {result.returncode}; {_tail(log)}")


def _tail(log: Path) -> str:
    """Last lines of the log in one line."""
    lines = [" ".join(line.split()) for line in log.read_text("utf-8", "replace").splitlines() if line.strip()]
    return "last lines of its output: " + (" | ".join(lines[-LOG_LINES:]) or "none")

"""Folders of runs that were killed: how the next run tells them from those that somebody works in, or keeps.

A folder in work holds a file that its process has locked; the lock goes with the process, however that ends. A folder
of our own with such a file and no lock on it was left by a killed run. One that is kept, as that of a failed run is,
has no such file; neither has one that somebody else made.
"""

from __future__ import annotations

import fcntl
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

CLAIM = ".in-work"
"""File that is locked as long as somebody works in its folder."""

PREFIX = "ehdmaps-openfoam-"
"""Temporary folders of this package have names that begin so."""


@contextmanager
def claimed(folder: Path) -> Iterator[None]:
    """Hold the claim of a folder; behind it the folder is one that is kept, if it is still there.

    Where the file system knows no locks there is no claim, and the folder of a killed run stays.

    Parameters
    ----------
    folder : Path
        A folder that this process has made.

    Raises
    ------
    OSError
        If nothing can be written there.
    """
    unlocked, claim = folder / f"{CLAIM}.new", folder / CLAIM
    with unlocked.open("xb") as file:
        try:
            with suppress(OSError):
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                unlocked.rename(claim)  # locked before anybody can find it
            yield
        finally:
            for path in (unlocked, claim):
                path.unlink(missing_ok=True)


@cache
def remove_leftovers(parent: Path) -> None:
    """Remove the folders that killed runs left in a folder for temporary files; a process looks there once.

    Parameters
    ----------
    parent : Path
        The folder for temporary files.
    """
    with suppress(OSError):
        for folder in list(parent.glob(f"{PREFIX}{os.getuid()}-*")):
            if _abandoned(folder):
                shutil.rmtree(folder, ignore_errors=True)


def _abandoned(folder: Path) -> bool:
    """Whether a folder is ours, with a claim that no process holds."""
    try:
        if folder.is_symlink() or folder.stat().st_uid != os.getuid():
            return False
        descriptor = os.open(folder / CLAIM, os.O_RDONLY | os.O_NOFOLLOW)
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        # released between opening and locking it: then it is kept, and its claim is gone
        return os.path.samestat(os.fstat(descriptor), (folder / CLAIM).stat())
    except OSError:
        return False
    finally:
        os.close(descriptor)

"""A working folder for one run, copied from the template; folders of runs that were killed; disks that are full.

A folder in work holds a file that its process has locked; the lock goes with the process, however that ends. A folder
of our own with such a file and no lock on it was left by a killed run. One that is kept, as that of a failed run is,
has no such file; neither has one that somebody else made.
"""

from __future__ import annotations

import errno
import fcntl
import itertools
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import cache
from pathlib import Path

from ehdmaps.errors import DiskFullError, SolverError
from ehdmaps.openfoam.run import RunError

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
    """Tell whether a folder is ours, with a claim that no process holds."""
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


ROOM = 1_000_000
"""Bytes that a disk must still take beside a run that failed, else that is why: programs do not always say so. A case
with 400 x 6 cells takes 0.1 MB, with its fields 0.8 MB."""

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""Errors of the system: the disk, or what this user may have of it, is used up, or a file may not grow (ulimit -f)."""

PARAMETER_FILE = Path("constant") / "ehlProperties"

_PARTS = ("system", "0", "constant")
_SCRIPTS = ("Allrun", "Allclean")
"""What runs a case by hand: a folder that stays can be tried again, and changed, where it lies."""

_RUNS = itertools.count()
_LEFT_OUT = shutil.ignore_patterns("polyMesh", "ehlProperties")


@contextmanager
def working_case(template: Path, parameters: str, name: str, keep: Path | None = None) -> Iterator[Path]:
    """Make a case folder; when the work in it is done it is removed, unless it failed or is to be kept.

    The first one of a process removes what killed runs left beside it.

    Parameters
    ----------
    template : Path
        The case that runs by hand; its system, 0, constant and scripts are copied, its mesh and results are not.
    parameters : str
        Text of the one file that differs.
    name : str
        Name of a kept folder; a number is added where it exists.
    keep : Path, optional
        Folder for cases that are kept; None: the system's folder for temporary files, for failed ones only.

    Yields
    ------
    Path
        The case folder; one that has failed (SolverError) stays, and a RunError knows it then.

    Raises
    ------
    SolverError
        If it cannot be made.
    DiskFullError
        If it cannot be made, or the work in it failed, for want of room on the disk; the folder is removed.
    """
    parent = Path(tempfile.gettempdir()) if keep is None else keep
    if keep is None:
        remove_leftovers(parent)
    with ExitStack() as work:
        folder = None
        try:
            folder = _new_folder(parent, _own_name() if keep is None else name)
            if keep is None:
                work.enter_context(claimed(folder))
            for part in _PARTS:
                if (template / part).is_dir():
                    shutil.copytree(template / part, folder / part, ignore=_LEFT_OUT)
            for script in _SCRIPTS:
                if (template / script).is_file():
                    shutil.copy(template / script, folder / script)
            (folder / PARAMETER_FILE).write_text(parameters, encoding="ascii")
        except OSError as error:
            full = _full(parent, error)
            if folder is not None:
                shutil.rmtree(folder, ignore_errors=True)
            raise full or SolverError(
                f"a case cannot be made in {parent} ({error.strerror or error}); "
                "allowed: a folder that may be written, with space on the disk"
            ) from error
        removed = keep is None
        try:
            yield folder
        except (SolverError, OSError) as error:
            if full := _full(parent, error):
                removed = True
                raise full from error
            removed = removed and not isinstance(error, SolverError)
            if isinstance(error, RunError):
                error.case = folder
            raise
        finally:
            if removed:
                shutil.rmtree(folder, ignore_errors=True)


def _full(parent: Path, error: Exception) -> DiskFullError | None:
    """Error to raise in place of one that a full disk is behind; None where the disk still takes `ROOM`."""
    causes = [error] if isinstance(error, OSError) else []
    try:
        with tempfile.TemporaryFile(dir=parent) as file:
            os.posix_fallocate(file.fileno(), 0, ROOM)
    except OSError as refused:
        causes.append(refused)
    cause = next((cause for cause in causes if cause.errno in _FULL), None)
    if cause is None:
        return None
    free = ""
    with suppress(OSError):
        free = f", {shutil.disk_usage(parent).free / 1e6:.3g} MB are free"
    return DiskFullError(
        f"{parent}: no room for the case of a point ({cause.strerror}{free}); allowed: {ROOM / 1e6:g} MB or more for "
        f"each worker; free space there (folders {PREFIX}* are cases of points that failed), or choose another folder "
        "with TMPDIR or --keep-cases; the same command goes on: what was solved is kept"
    )


def _own_name() -> str:
    """Name of a temporary folder; only numbers differ, so that failures of many points read as one cause."""
    return f"{PREFIX}{os.getuid()}-{os.getpid()}-{next(_RUNS)}"


def _new_folder(parent: Path, name: str) -> Path:
    """Make a folder that nobody else has; others cannot write there."""
    parent.mkdir(parents=True, exist_ok=True)
    for count in itertools.count():
        folder = parent.absolute() / (f"{name}-{count}" if count else name)
        try:
            folder.mkdir(mode=0o700)
        except FileExistsError:
            continue
        return folder
    raise AssertionError  # pragma: no cover - count() has no end

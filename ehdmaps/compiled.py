"""The film solvers as numba compiles them, and where their machine code is kept: by a hash of what it is made from.

numba keeps compiled code beside the source file and looks at that one file only. A function whose callee changed in
another file would go on calling the old callee, and an installation could not be removed whole. So `njit` here keeps
compiled code in the user's folder for caches, in a folder named by the hash of the compiler and of all sources that
compiled code depends on (`ehdmaps.provenance.compiled_hash`) and by the processor. Another state of these finds another
folder.

Where that folder cannot be written, in containers and for users of services, a private folder for temporary files
takes its place, and where that cannot be written either, compiled code stays in memory. One line says so.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import multiprocessing
import os
import re
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar, overload

import numba
from llvmlite import binding
from numba.core import config, runtime

from ehdmaps.compiling import begin_waiting
from ehdmaps.outputs import cache_folder, own_folder
from ehdmaps.program import tell
from ehdmaps.provenance import compiled_hash

try:
    import fcntl
except ImportError:  # not on Windows, where two processes that compile at once may each compile the same
    fcntl = None  # type: ignore[assignment]

FOLDER_VARIABLE = "NUMBA_CACHE_DIR"
"""Environment variable of numba that names another folder."""

MOST_KEPT = 4
"""Folders of other states of the sources that are kept; each takes up to some 100 MB."""

USED_AGAIN = 3600.0
"""Seconds after which a use of a folder is noted once more."""

_config: Any = config
_runtime: Any = runtime

COMPILES = not _config.DISABLE_JIT
"""Whether functions are compiled; not under ``NUMBA_DISABLE_JIT=1``, for debuggers and for coverage of the solvers."""

_NAME = re.compile(r"[0-9a-f]{16}-[0-9a-f]{8}")


_F = TypeVar("_F", bound=Callable[..., Any])


@overload
def njit(function: _F, /) -> _F: ...


@overload
def njit(*, cache: bool = True, **options: Any) -> Callable[[_F], _F]: ...


def njit(function: Callable[..., Any] | None = None, /, *, cache: bool = True, **options: Any) -> Any:
    """Compile a function with numba, and keep its machine code for later processes; as `numba.njit`.

    Parameters
    ----------
    function : callable, optional
        The function; left out where options are given, ``@njit(error_model="numpy")``.
    cache : bool
        Whether the machine code is kept on disk. Not for a function that calls what is no part of this distribution.
    **options
        Other options of `numba.njit`, as they are.

    Returns
    -------
    numba dispatcher
        What to call. Under ``NUMBA_DISABLE_JIT=1`` it is the function itself, for debuggers and coverage.
    """
    if function is None:
        return functools.partial(njit, cache=cache, **options)
    # `_nrt=False` leaves out the counts of references to arrays, which cost as much as a kernel that makes none; where
    # nothing is said numba takes it from the function that calls
    options.setdefault("_nrt", True)
    folder = _folder() if cache else None
    if folder is None:
        return numba.njit(**options)(function)
    before, _config.CACHE_DIR = _config.CACHE_DIR, str(folder)
    try:
        dispatcher = numba.njit(cache=True, **options)(function)
    finally:
        _config.CACHE_DIR = before
    kept = dispatcher._cache
    if not Path(kept.cache_path).is_relative_to(folder):  # it can no longer be written, and numba chose another one
        return numba.njit(**options)(function)
    known = all(hasattr(kept, name) for name in ("_guard_against_spurious_io_errors", "_load_overload"))
    read = functools.partial(_read, kept) if known else kept.load_overload
    kept.load_overload = functools.partial(_load, read, kept.flush)
    kept.save_overload = functools.partial(_save, kept.save_overload, folder)
    return dispatcher


def in_python(function: Any) -> Any:
    """Return the Python function of a compiled one; under ``NUMBA_DISABLE_JIT=1`` that is the function itself."""
    return getattr(function, "py_func", function)


def _load(load: Callable[..., Any], flush: Callable[[], None], *arguments: Any) -> Any:
    """Read kept code; what is damaged, or was removed meanwhile, is forgotten and compiled again."""
    try:
        return load(*arguments)
    except Exception:  # a damaged pickle raises anything
        with contextlib.suppress(OSError):
            flush()
        return None


def _read(kept: Any, signature: Any, context: Any) -> Any:
    """Read kept code as `load_overload` of numba does, but for what it prepares for compiling: a fifth of a second.

    Whatever compiles later prepares that itself. Kept code needs numba's counts of references alone. A numba that reads
    in another way than those of today does it by its own `load_overload`.
    """
    _runtime.rtsys.initialize(context)
    with kept._guard_against_spurious_io_errors():
        return kept._load_overload(signature, context)


def _save(save: Callable[..., Any], folder: Path, *arguments: Any) -> None:
    """Keep code, one process at a time; on a full disk, and in a folder that was removed, it stays in memory."""
    with contextlib.suppress(OSError), _alone(folder):
        save(*arguments)


@contextlib.contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Wait for other processes that write there: numba would give the code of two of them the same name."""
    if fcntl is None:
        yield
        return
    with (folder / "lock").open("ab") as file:
        with contextlib.suppress(OSError):  # a file system without locks
            fcntl.flock(file, fcntl.LOCK_EX)
        yield


@functools.cache
def _folder() -> Path | None:
    """Folder in which this process keeps compiled code; None for nowhere."""
    if not COMPILES:
        return None
    why = "no folder for caches can be written ($XDG_CACHE_HOME, ~/.cache)"
    for place in (_user_folder, _temporary_folder):
        try:
            folder = place() / f"{compiled_hash()}-{_processor()}"
            _use(folder)
        except PermissionError as error:  # of our own check, without a number: others could give us code to run
            why = why if error.errno or place is not _user_folder else str(error)
        except (OSError, RuntimeError):  # no home folder is a RuntimeError
            continue
        else:
            if place is not _user_folder:
                _say(why, f"compiled code is kept in {folder.parent}")
            return folder
    _say(why, "compiled code is not kept, and each process compiles anew")
    return None


def _say(why: str, what: str) -> None:
    """Tell once what becomes of compiled code; the processes that a program starts say nothing."""
    if multiprocessing.parent_process() is None:
        tell(f"ehdmaps: {why}: {what}; ${FOLDER_VARIABLE} names another folder")


def _user_folder() -> Path:
    """Our folder in the user's folder for caches."""
    return cache_folder("compiled", FOLDER_VARIABLE, os.environ)


def _temporary_folder() -> Path:
    """Our folder among those for temporary files; nobody else may have put code there for us to run."""
    folder = Path(tempfile.gettempdir()) / f"ehdmaps-compiled-{os.getuid() if hasattr(os, 'getuid') else 'user'}"
    return own_folder(folder)


def _use(folder: Path) -> None:
    """Make a folder that can be written, note that it is used, and remove what was not used for longest."""
    new = not folder.is_dir()
    own_folder(folder)
    with (folder / "lock").open("ab"):
        pass
    if new:
        _remove_old(folder)
    if time.time() - folder.stat().st_mtime > USED_AGAIN:
        os.utime(folder)


def _remove_old(folder: Path) -> None:
    """Remove the folders of other states of the sources but for the last ones used; nothing that is not ours."""
    others = [path for path in folder.parent.iterdir() if _NAME.fullmatch(path.name) and path != folder]
    with contextlib.suppress(OSError):  # another process removes them too
        others.sort(key=lambda path: path.stat().st_mtime, reverse=True)
    for path in others[MOST_KEPT:]:
        shutil.rmtree(path, ignore_errors=True)


def _processor() -> str:
    """Eight digits of the processor that code is compiled for: homes are shared by nodes that differ."""
    features = binding.get_host_cpu_features().flatten()
    return hashlib.sha256(f"{binding.get_host_cpu_name()} {features}".encode()).hexdigest()[:8]


begin_waiting()

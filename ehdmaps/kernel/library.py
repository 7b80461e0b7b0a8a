"""Finds the library, has it built where it does not fit the C files, and calls it.

The library stands beside this file. Where it is missing, or made of another state of the C files, it is compiled:
beside this file, or, where that folder cannot be written, in the user's folder for caches, else in a private one for
temporary files. A library that does not fit is never run.

`EHDMAPS_KERNEL` names another kind of it (`ehdmaps.kernel.building.OPTIONS`), such as ``debug`` for a debugger.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import os
import platform
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

from ehdmaps.errors import KernelError
from ehdmaps.kernel import building
from ehdmaps.outputs import cache_folder, others_may_write, own_folder

KIND_VARIABLE = "EHDMAPS_KERNEL"
"""Environment variable that names a kind of the library."""

FOLDER_VARIABLE = "EHDMAPS_KERNEL_FOLDER"
"""Environment variable that names the folder of libraries that cannot stand beside this file."""

HOME = Path(__file__).parent
"""Folder of the library."""

_ADVICE = (
    "install a C compiler, for example with apt-get install gcc, or the package ziglang with pip; the library is then "
    "built by itself"
)

_Class = TypeVar("_Class", bound=type[ctypes.Structure])


@functools.cache
def library() -> ctypes.CDLL:
    """Return the library of this process. Calls of its functions release Python's lock.

    Returns
    -------
    ctypes.CDLL
        The library; see `function` for its functions.

    Raises
    ------
    KernelError
        If there is none that fits the C files, and none can be built.
    """
    kind = os.environ.get(KIND_VARIABLE, "")
    if kind not in building.OPTIONS:
        allowed = ", ".join(filter(None, building.OPTIONS))
        raise KernelError(f"{KIND_VARIABLE}: got {kind!r}; allowed: nothing, for the usual library, or {allowed}")
    return found(HOME, kind)


def found(home: Path, kind: str = "") -> ctypes.CDLL:
    """Load the library of a folder, after it was built where that is needed.

    Parameters
    ----------
    home : Path
        Folder of the library, with that of the C files.
    kind : str
        Kind of the library, a key of `building.OPTIONS`.

    Raises
    ------
    KernelError
        If there is none that fits the C files, and none can be built.
    """
    name, sources = building.file_name(kind), home / "c"
    number, why = building.state(sources), ""
    for folder in _folders(home, number):
        if building.state_of(folder / name) == number and (folder == home or not others_may_write(folder)):
            with contextlib.suppress(OSError):  # of another system, or where nothing may be run
                return _loaded(folder / name, number)
    for folder in _folders(home, number):
        try:
            if folder != home:
                own_folder(folder)
            return _loaded(folder / name, building.build(folder / name, os.environ, kind, sources))
        except building.BuildError as error:
            why = str(error)
            break
        except OSError as error:  # it cannot be written, or nothing there may be run
            why = why or f"{folder}: {error.strerror or error}"
    raise KernelError(f"ehdmaps.kernel: no library fits the C files in {sources}, and none is built: {why}; {_ADVICE}")


def _loaded(path: Path, number: str) -> ctypes.CDLL:
    """Load a library; one that was replaced meanwhile, or that this process had loaded before that, is refused."""
    loaded = ctypes.CDLL(str(path))
    loaded.ehd_interface.restype = ctypes.c_char_p
    if number.encode() not in loaded.ehd_interface():
        raise OSError(0, "the library was replaced while it was loaded")
    return loaded


def _folders(home: Path, number: str) -> Iterator[Path]:
    """Folders in which the library may stand, in turn."""
    yield home
    own = f"{number}-{platform.machine()}"
    with contextlib.suppress(RuntimeError):  # no home folder
        yield cache_folder("kernel", FOLDER_VARIABLE, os.environ) / own
    user = os.getuid() if hasattr(os, "getuid") else "user"
    yield Path(tempfile.gettempdir()) / f"ehdmaps-kernel-{user}"


def function(name: str, *arguments: Any, result: Any = ctypes.c_int) -> Callable[..., Any]:
    """Return a function of the library, with the types of what it takes and returns.

    Parameters
    ----------
    name : str
        Name of the function, such as "ehd_interface".
    *arguments : ctypes type
        Types of the arguments. `ctypes.c_void_p` takes an address as an integer and is the cheapest for pointers.
    result : ctypes type or None
        Type of what it returns.
    """
    called = getattr(library(), name)
    called.argtypes, called.restype = arguments, result
    return called  # type: ignore[no-any-return]


def checked(record: _Class, name: str) -> _Class:
    """Return a struct's class after it was compared with that in C.

    Parameters
    ----------
    record : type
        Class of the struct, see `ehdmaps.kernel.record`.
    name : str
        Name of the struct in C, such as "ehd_law_data": the library has a function of this name with "_size".

    Raises
    ------
    KernelError
        If the two have not the same size.
    """
    size = function(f"{name}_size", result=ctypes.c_size_t)()
    if ctypes.sizeof(record) != size:
        raise KernelError(
            f"ehdmaps.kernel: {record.__name__} has {ctypes.sizeof(record)} bytes, {name} in C has {size}: the fields "
            "of one were changed without those of the other"
        )
    return record

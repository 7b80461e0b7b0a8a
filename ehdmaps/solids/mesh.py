"""gmsh as a guest of this process: loaded when something is meshed, and gone after."""

from __future__ import annotations

import importlib
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

from ehdmaps.errors import DependencyError, InputError
from ehdmaps.extras import needs

DEBIAN_PACKAGES = ("libgl1", "libglu1-mesa", "libgomp1", "libxcursor1", "libxft2", "libxinerama1")
"""What the gmsh of PyPI needs of Debian 12 besides what every machine has."""


def load_gmsh(purpose: str) -> ModuleType:
    """Return gmsh.

    Parameters
    ----------
    purpose : str
        What needs it, for the message.

    Raises
    ------
    DependencyError
        If it is not installed, or a library of the system that it needs is not.
    """
    try:
        with needs("solids", "gmsh", purpose):
            return importlib.import_module("gmsh")
    except DependencyError as error:
        raise DependencyError(f"{error}; on Debian also apt-get install {' '.join(DEBIAN_PACKAGES)}") from error


@contextmanager
def gmsh_session(purpose: str) -> Iterator[ModuleType]:
    """Gmsh with an empty model, quiet, one thread; all is gone after.

    Parameters
    ----------
    purpose : str
        What needs it, for messages.

    Raises
    ------
    DependencyError
        If gmsh is missing.
    InputError
        If it is in use already.
    """
    gmsh = load_gmsh(purpose)
    if gmsh.isInitialized():
        raise InputError(f"gmsh is already in use in this process; allowed: gmsh.finalize() before {purpose}")
    # No configuration files of the user, and Ctrl-C stays Python's.
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    _keep_broken_pipes_errors()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        gmsh.model.add("solid")
        yield gmsh
    finally:
        gmsh.finalize()


def _keep_broken_pipes_errors() -> None:
    """Take SIGPIPE back from gmsh, with which a worker that dies would take its parent along."""
    # Only the main thread may; Python itself sets the signal there.
    if hasattr(signal, "SIGPIPE") and threading.current_thread() is threading.main_thread():
        before = signal.getsignal(signal.SIGPIPE)
        if before is not None:
            signal.signal(signal.SIGPIPE, before)

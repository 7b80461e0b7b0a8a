"""Packages and names that are loaded when they are needed.

An extra of the distribution installs a package that only a part of the programs needs, and messages name it. Public
names of our own packages are loaded when they are first used.
"""

from __future__ import annotations

import importlib
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ehdmaps.errors import DependencyError


@contextmanager
def needs(extra: str, package: str, purpose: str) -> Iterator[None]:
    """Import a package of an extra in the block of this context.

    Parameters
    ----------
    extra : str
        Name of the extra in `pyproject.toml`.
    package : str
        Name of the package for pip.
    purpose : str
        What needs it, with which the message begins.

    Raises
    ------
    DependencyError
        If the package is not installed, or a library of the system that it needs is not.
    """
    try:
        yield
    # OSError: a shared library that it links to
    except (ImportError, OSError) as error:
        raise DependencyError(
            f"{purpose}: the package {package} cannot be loaded ({error}); "
            f'install it: pip install "ehdmaps[{extra}]", or pip install {package}'
        ) from error


def lacking(extra: str, package: str, purpose: str) -> tuple[str, ...]:
    """Return the problem of a package that cannot be loaded, in a sentence; nothing if it can.

    Parameters
    ----------
    extra, package, purpose : str
        The same as for `needs`; the package is imported by its name for pip.
    """
    try:
        with needs(extra, package, purpose):
            importlib.import_module(package)
    except DependencyError as error:
        return error.problems
    return ()


def public_names(package: str, file: str) -> tuple[list[str], Callable[[str], object], Callable[[], list[str]]]:
    """Return `__all__`, `__getattr__` and `__dir__` of a package whose names are loaded when they are first used.

    Parameters
    ----------
    package, file : str
        `__name__` and `__file__` of the package; the stub beside it has a line for each name, with its module.

    Examples
    --------
    >>> names, load, _ = public_names("ehdmaps", sys.modules["ehdmaps"].__file__)
    >>> "open_map" in names, load("Status").__module__
    (True, 'ehdmaps.physics.solution')
    """
    stub = Path(file).with_name("__init__.pyi").read_text(encoding="utf-8")
    homes = {name: module for module, name in re.findall(r"^from (\S+) import \w+ as (\w+)$", stub, re.MULTILINE)}

    def load(name: str) -> object:
        if name == "__version__":
            value: object = importlib.import_module("ehdmaps.version").version()
        elif name in homes:
            value = getattr(importlib.import_module(homes[name]), name)
        else:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        setattr(sys.modules[package], name, value)
        return value

    return sorted(homes), load, lambda: sorted(homes)

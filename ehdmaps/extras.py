"""Packages that only a part of the programs needs: an extra of the distribution installs them, and messages name it."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import contextmanager

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

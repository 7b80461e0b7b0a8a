"""A working folder for one run, copied from the template."""

from __future__ import annotations

import itertools
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from ehdmaps.errors import SolverError
from ehdmaps.openfoam.leftovers import PREFIX, claimed, remove_leftovers
from ehdmaps.openfoam.run import RunError

PARAMETER_FILE = Path("constant") / "ehlProperties"

_PARTS = ("system", "0", "constant")
_RUNS = itertools.count()
_LEFT_OUT = shutil.ignore_patterns("polyMesh", "ehlProperties")


@contextmanager
def working_case(template: Path, parameters: str, name: str, keep: Path | None = None) -> Iterator[Path]:
    """Make a case folder; when the work in it is done it is removed, unless it failed or is to be kept.

    The first one of a process removes what killed runs left beside it.

    Parameters
    ----------
    template : Path
        The case that runs by hand; its system, 0 and constant are copied, its mesh and results are not.
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
            (folder / PARAMETER_FILE).write_text(parameters, encoding="ascii")
        except OSError as error:
            if folder is not None:
                shutil.rmtree(folder, ignore_errors=True)
            raise SolverError(
                f"a case cannot be made in {parent} ({error.strerror or error}); "
                "allowed: a folder that may be written, with space on the disk"
            ) from error
        failed = False
        try:
            yield folder
        except SolverError as error:
            failed = True
            if isinstance(error, RunError):
                error.case = folder
            raise
        finally:
            if keep is None and not failed:
                shutil.rmtree(folder, ignore_errors=True)


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

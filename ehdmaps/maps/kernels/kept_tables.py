"""Tables of laws that were made before, in the user's folder for caches: a second process reads them in some 20 ms.

A table is kept under a hash over all that it is made from: films, contacts, oil, ranges, and the files of this
distribution that make it. It holds numbers alone, and what is damaged is made again. `EHDMAPS_LAW_TABLES` names another
folder; ``off`` keeps nothing.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import os
import pickle
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel import building
from ehdmaps.maps.kernels.tables import ApproachTable
from ehdmaps.outputs import cache_folder, new_part, others_may_write, own_folder
from ehdmaps.provenance import code_hash

VARIABLE = "EHDMAPS_LAW_TABLES"
"""Environment variable that names the folder."""

MOST = 100
"""Tables that are kept, of some 5 MB each; the oldest ones make room."""

_ARRAYS = ("coefficients", "place")
_DATA = Path(__file__).parents[2] / "table" / "film_table.nc"


def keeping() -> bool:
    """Tell whether tables are kept."""
    return os.environ.get(VARIABLE) != "off"


@functools.cache
def _code() -> bytes:
    """Hash of all files that a table is made by and from."""
    digest = hashlib.sha256(f"{code_hash()} {building.state()}".encode())
    with contextlib.suppress(OSError):
        digest.update(_DATA.read_bytes())
    return digest.digest()


def key_of(*inputs: Any) -> str:
    """Hash over values and the code; empty for values that cannot be written down.

    Parameters
    ----------
    *inputs
        The values.
    """
    try:
        content = pickle.dumps(inputs, protocol=5)
    except Exception:  # whatever cannot be pickled raises anything
        return ""
    return hashlib.sha256(_code() + content).hexdigest()


def kept_table(key: str, make: Callable[[], ApproachTable]) -> ApproachTable:
    """Read a table, or make and keep it.

    Parameters
    ----------
    key : str
        Hash of what it is made from; nothing is kept without one.
    make : callable
        Maker of the table.
    """
    if not (key and keeping()):
        return make()
    with contextlib.suppress(RuntimeError):  # no home folder
        path = cache_folder("laws", VARIABLE, os.environ) / f"{key}.npz"
        if (read := _read(path)) is not None:
            return read
        made = make()
        with contextlib.suppress(OSError):  # a full disk, a folder that cannot be written
            _write(path, made)
        return made
    return make()


def _read(path: Path) -> ApproachTable | None:
    """A table from its file; None where there is none that is whole, or others may have written it."""
    if not path.is_file() or others_may_write(path.parent) or others_may_write(path):
        return None
    try:
        with path.open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            arrays = {name: np.ascontiguousarray(file[name], np.float64) for name in _ARRAYS}
            numbers = [float(value) for value in file["numbers"]]
    except (OSError, EOFError, ValueError, KeyError, zipfile.BadZipFile):
        return None
    coefficients, place = arrays["coefficients"], arrays["place"]
    if coefficients.ndim != 3 or place.shape != (*coefficients.shape[:2], 2) or len(numbers) != 6:
        return None
    return ApproachTable(coefficients, place, *numbers)


def _write(path: Path, table: ApproachTable) -> None:
    """Write a table into its file, whole or not at all, and remove the oldest ones that are too many."""
    own_folder(path.parent)
    numbers: FloatArray = np.array([getattr(table, name) for name in ApproachTable._fields[2:]])
    part, descriptor = new_part(path)
    try:
        with os.fdopen(descriptor, "wb") as file:
            np.savez(file, coefficients=table.coefficients, place=table.place, numbers=numbers)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
    kept = sorted(path.parent.glob("*.npz"), key=lambda file: file.stat().st_mtime)
    for old in kept[: max(0, len(kept) - MOST)]:
        old.unlink(missing_ok=True)

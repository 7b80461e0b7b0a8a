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
from collections.abc import Callable, Sequence
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


class KeptPickles:
    """Values that were made before, in a folder of the user's for caches, by hashes of what they are made from.

    What is damaged, or what others may have written, is made again.

    Parameters
    ----------
    name : str
        Name of the folder.
    variable : str
        Environment variable that names another one; its value ``off`` keeps nothing.
    most : int
        How many are kept; the oldest ones make room.
    keys : sequence of str
        Hashes of the values; of one with an empty hash nothing is kept.
    """

    def __init__(self, name: str, variable: str, most: int, keys: Sequence[str]) -> None:
        self._most = most
        self._paths: list[Path | None] = [None] * len(keys)
        with contextlib.suppress(RuntimeError):  # no home folder
            if os.environ.get(variable) != "off":
                folder = cache_folder(name, variable, os.environ)
                self._paths = [folder / f"{key}.pickle" if key else None for key in keys]

    @property
    def keeps(self) -> bool:
        """True where something is kept."""
        return any(path is not None for path in self._paths)

    def get(self, index: int) -> Any:
        """Value by its number; None where there is none that is whole.

        Parameters
        ----------
        index : int
            Number of its hash.
        """
        path = self._paths[index]
        if path is None or not path.is_file() or others_may_write(path.parent) or others_may_write(path):
            return None
        try:
            return pickle.loads(path.read_bytes())
        except Exception:  # a damaged pickle raises anything
            return None

    def put(self, index: int, value: Any) -> None:
        """Keep a value; on a full disk, and in a folder that cannot be written, it is not kept.

        Parameters
        ----------
        index : int
            Number of its hash.
        value : object
            What is kept; picklable.
        """
        path = self._paths[index]
        if path is None:
            return
        with contextlib.suppress(OSError):
            own_folder(path.parent)
            part, descriptor = new_part(path)
            try:
                with os.fdopen(descriptor, "wb") as file:
                    pickle.dump(value, file, protocol=5)
                part.replace(path)
            finally:
                part.unlink(missing_ok=True)
            kept = sorted(path.parent.glob("*.pickle"), key=lambda file: file.stat().st_mtime)
            for old in kept[: max(0, len(kept) - self._most)]:
                old.unlink(missing_ok=True)

    def clear(self) -> None:
        """Remove the values."""
        for path in self._paths:
            if path is not None:
                with contextlib.suppress(OSError):
                    path.unlink(missing_ok=True)


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

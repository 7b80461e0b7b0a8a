"""Results solved already: arrays by key, in one SQLite file beside the map.

The file survives kill -9 at any moment (SQLite rolls half-written work back), and SQLite's own exclusive
lock, which the operating system drops with the process, keeps a second job out. The store knows keys and
arrays, and of a key the site, if it has one: numbers that another key may have but for their round-off, as the same
point on two axes. What is found by its site is as good: no result changes by more than round-off allows.
"""

from __future__ import annotations

import hashlib
import io
import sqlite3
import struct
import time
import zipfile
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from ehdmaps.errors import StoreError

Arrays = dict[str, npt.NDArray[Any]]
"""What a task returns: arrays by name, none of object type."""

Site = tuple[str, tuple[float, ...]]
"""Site of a task: the hash of all that shapes its result but some numbers, and these. Two tasks of one hash whose
numbers agree within `SAME` have the same result."""

COMMIT_SECONDS = 0.25
"""Results are brought to the disk this often; shorter would wait for the disk more than it computes."""

SAME = 1e-9
"""Relative difference up to which numbers of two sites are the same: far above round-off, far below what anything is
solved to."""

_TABLES = (
    "CREATE TABLE IF NOT EXISTS results (key TEXT PRIMARY KEY, checksum TEXT NOT NULL, content BLOB NOT NULL)",
    "CREATE TABLE IF NOT EXISTS sites (key TEXT PRIMARY KEY, checksum TEXT NOT NULL, family TEXT NOT NULL, "
    "first REAL NOT NULL, last REAL NOT NULL, numbers BLOB NOT NULL)",
    "CREATE INDEX IF NOT EXISTS by_site ON sites (family, first, last)",
)

_APPLICATION_ID = 0x45484D31  # "EHM1"
_ID_AT = 68
"""Where SQLite keeps it, see its file format."""

_BUSY = (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED)
_BROKEN = (sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_CORRUPT)


class NoStore:
    """Keeps nothing: for results that stay in memory, with the sweep that found them."""

    damaged = 0

    def get(self, key: str, site: Site | None = None) -> Arrays | None:
        """Return None: nothing is solved already."""
        return None

    def put(
        self, key: str, arrays: Mapping[str, npt.NDArray[Any]], at_once: bool = False, site: Site | None = None
    ) -> None:
        """Do nothing; arguments as of `Store.put`."""

    def commit_if_due(self) -> None:
        """Do nothing."""

    def commit(self) -> None:
        """Do nothing."""


def store_path(output: Path) -> Path:
    """Return the store that belongs to a map file."""
    return output.with_name(output.name + ".store")


class Store:
    """Open store of solved tasks, held exclusively until closed; use it in a `with` statement.

    Parameters
    ----------
    path : Path
        File of the store; made if absent.
    fresh : bool
        Drop what is in it, readable or not.

    Attributes
    ----------
    damaged : int
        Entries whose checksum did not match; they count as not solved.

    Raises
    ------
    StoreError
        If another job holds it, or it cannot be read or written.
    """

    def __init__(self, path: Path, fresh: bool = False) -> None:
        self.path = path
        self.damaged = 0
        self._last_commit = time.monotonic()
        if path.exists() and not path.is_dir() and not path.is_file():
            # SQLite would wait for ever for a pipe to be filled.
            raise self._foreign("it is no regular file")
        try:
            self._database = self._open()
        except sqlite3.Error as error:
            if not (fresh and _code(error) in _BROKEN):
                raise self._unusable(error) from error
            if not _is_ours(path):
                raise self._foreign("it does not begin as one") from error
            self._drop()
            try:
                self._database = self._open()
            except sqlite3.Error as again:
                raise self._unusable(again) from again
        if fresh:
            self._write("DELETE FROM results", ())
            self._write("DELETE FROM sites", ())
            self.commit()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            if not isinstance(error, StoreError):
                self.commit()
        finally:
            self._database.close()

    def get(self, key: str, site: Site | None = None) -> Arrays | None:
        """Return the arrays of a key, or of another one at the same site, or None if neither is solved.

        Parameters
        ----------
        key : str
            Key of a task.
        site : Site, optional
            Site of the task.

        Raises
        ------
        StoreError
            If the store cannot be read.
        """
        arrays = self._of_key(key)
        if arrays is None and site is not None:
            found = (self._of_key(other) for other in self._at(site))
            arrays = next((other for other in found if other is not None), None)
        return arrays

    def _at(self, site: Site) -> list[str]:
        """Keys at a site; an entry that is damaged is none."""
        family, wanted = site
        ranges = [bound for number in (wanted[0], wanted[-1]) for bound in _range(number)]
        query = (
            "SELECT CAST(key AS BLOB), CAST(checksum AS BLOB), CAST(numbers AS BLOB) FROM sites "
            "WHERE family = ? AND first BETWEEN ? AND ? AND last BETWEEN ? AND ? ORDER BY key"
        )
        try:
            rows = self._database.execute(query, (family, *ranges)).fetchall()
        except sqlite3.Error as error:
            raise self._unusable(error) from error
        sound = [
            (key.decode(), numbers)
            for key, checksum, numbers in rows
            if None not in (key, checksum, numbers) and _site_checksum(key, family, numbers).encode() == checksum
        ]
        return [key for key, numbers in sound if _same(numbers, wanted)]

    def _of_key(self, key: str) -> Arrays | None:
        """Arrays of a key; None if it is not solved."""
        try:
            # As bytes: what was damaged may be no text, or another kind of value.
            row = self._database.execute(
                "SELECT CAST(checksum AS BLOB), CAST(content AS BLOB) FROM results WHERE key = ?", (key,)
            ).fetchone()
        except (sqlite3.Error, UnicodeDecodeError) as error:
            raise self._unusable(error) from error
        if row is None:
            return None
        checksum, content = row
        if content is None or _checksum(key, content).encode() != checksum:
            self.damaged += 1
            return None
        return unpack(content)

    def put(
        self, key: str, arrays: Mapping[str, npt.NDArray[Any]], at_once: bool = False, site: Site | None = None
    ) -> None:
        """Keep the arrays of a key; on disk within `COMMIT_SECONDS` of the next call, or `at_once`.

        Parameters
        ----------
        key : str
            Key of a task.
        arrays : mapping of str to ndarray
            What to keep, by name.
        at_once : bool
            Whether it is on disk when this returns.
        site : Site, optional
            Site of the task, by which others find it.

        Raises
        ------
        StoreError
            If the store cannot be written.
        """
        content = pack(arrays)
        self._write(
            "INSERT OR REPLACE INTO results VALUES (?, ?, ?)",
            (key, _checksum(key, content), content),
        )
        if site is not None:
            family, numbers = site
            packed = struct.pack(f"<{len(numbers)}d", *numbers)
            checksum = _site_checksum(key.encode(), family, packed)
            self._write(
                "INSERT OR REPLACE INTO sites VALUES (?, ?, ?, ?, ?, ?)",
                (key, checksum, family, numbers[0], numbers[-1], packed),
            )
        if at_once:
            self.commit()
        else:
            self.commit_if_due()

    def commit_if_due(self) -> None:
        """Bring what was put to the disk if `COMMIT_SECONDS` have passed since it last was."""
        if time.monotonic() - self._last_commit >= COMMIT_SECONDS:
            self.commit()

    def commit(self) -> None:
        """Bring what was put to the disk.

        Raises
        ------
        StoreError
            If the disk does not take it.
        """
        try:
            self._database.commit()
        except sqlite3.Error as error:
            raise self._unusable(error) from error
        self._last_commit = time.monotonic()

    def _write(self, statement: str, values: tuple[object, ...]) -> None:
        """Run one writing statement."""
        try:
            self._database.execute(statement, values)
        except (sqlite3.Error, UnicodeDecodeError) as error:
            raise self._unusable(error) from error

    def _open(self) -> sqlite3.Connection:
        """Open, lock and check the file."""
        database = sqlite3.connect(self.path, timeout=0.0)
        try:
            # Exclusive mode keeps the lock that the first write takes until the file is closed.
            database.execute("PRAGMA locking_mode = EXCLUSIVE")
            database.execute("BEGIN EXCLUSIVE")
            (application_id,) = database.execute("PRAGMA application_id").fetchone()
            (tables,) = database.execute("SELECT count(*) FROM sqlite_master").fetchone()
            if tables and application_id != _APPLICATION_ID:
                raise sqlite3.DatabaseError("a database of another program")
            if not tables:
                database.execute(f"PRAGMA application_id = {_APPLICATION_ID}")
            (verdict,) = database.execute("PRAGMA quick_check(1)").fetchone()
            if verdict != "ok":
                raise sqlite3.DatabaseError(verdict)
            for statement in _TABLES:  # those of sites are missing in stores that are older than they
                database.execute(statement)
            database.commit()
        except sqlite3.Error:
            database.close()
            raise
        except UnicodeDecodeError as error:
            # What SQLite says names a table or an index by what stands in the file.
            database.close()
            raise sqlite3.DatabaseError("malformed database schema") from error
        return database

    def _drop(self) -> None:
        """Delete an unreadable store and SQLite's own files beside it."""
        for path in (self.path, Path(f"{self.path}-journal"), Path(f"{self.path}-wal")):
            path.unlink(missing_ok=True)

    def _foreign(self, cause: str) -> StoreError:
        """Say that something else stands in the place of the store."""
        return StoreError(
            f"{self.path}: is no store of ehdmaps ({cause}), and left as it is; allowed: a new file; move it away, or "
            "choose another output with -o"
        )

    def _unusable(self, error: Exception) -> StoreError:
        """Say what went wrong with the store, and what to do."""
        code = _code(error)
        if code in _BUSY:
            return StoreError(
                f"{self.path}: is in use by another job; allowed: one job a store; wait for it, or "
                "choose another output with -o"
            )
        if code == sqlite3.SQLITE_FULL:
            return StoreError(
                f"{self.path}: the disk is full; free space and run the same command again: "
                "what was solved until a second ago is kept"
            )
        if code in (
            sqlite3.SQLITE_CANTOPEN,
            sqlite3.SQLITE_READONLY,
            sqlite3.SQLITE_PERM,
            sqlite3.SQLITE_IOERR,
        ):
            return StoreError(
                f"{self.path}: cannot be written ({error}); allowed: a folder that exists and may "
                "be written; choose another output with -o"
            )
        cause = " ".join(str(error).split())
        if not _is_ours(self.path):
            return self._foreign(cause)
        return StoreError(
            f"{self.path}: is not a readable store ({cause}); the map beside it is untouched; move the store "
            "away or start again with --fresh"
        )


Results = Store | NoStore
"""What is solved already, by key."""


def _is_ours(path: Path) -> bool:
    """Tell from the header of a file whether it was made as a store, readable or not."""
    try:
        with path.open("rb") as file:
            head = file.read(_ID_AT + 4)
    except OSError:
        return False
    return head.startswith(b"SQLite format 3\0") and head[_ID_AT:] == _APPLICATION_ID.to_bytes(4, "big")


def _code(error: Exception) -> int:
    """Return SQLite's primary result code; a file of another kind counts as not a database."""
    code = getattr(error, "sqlite_errorcode", None)
    return sqlite3.SQLITE_NOTADB if code is None else int(code) & 0xFF


def _checksum(key: str, content: bytes) -> str:
    """Return the checksum of an entry: of its key too, so that damage gives no key the arrays of another."""
    return hashlib.sha256(key.encode() + b"\0" + content).hexdigest()


def _site_checksum(key: bytes, family: str, numbers: bytes) -> str:
    """Return the checksum of a site."""
    return hashlib.sha256(key + b"\0" + family.encode() + b"\0" + numbers).hexdigest()


def _range(number: float) -> tuple[float, float]:
    """Return the bounds of what is the same number."""
    return number - SAME * abs(number), number + SAME * abs(number)


def _same(packed: bytes, numbers: tuple[float, ...]) -> bool:
    """Tell whether the numbers of a site are these."""
    if len(packed) != 8 * len(numbers):
        return False
    others = struct.unpack(f"<{len(numbers)}d", packed)
    return all(low <= other <= high for other, (low, high) in zip(others, map(_range, numbers), strict=True))


def pack(arrays: Mapping[str, npt.NDArray[Any]]) -> bytes:
    """Write arrays as the bytes of an npz file."""
    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **{name: np.asarray(array) for name, array in arrays.items()})
    return buffer.getvalue()


def unpack(content: bytes) -> Arrays:
    """Read arrays from the bytes of an npz file.

    Raises
    ------
    StoreError
        If they are not the bytes of an npz file.
    """
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (ValueError, OSError, zipfile.BadZipFile) as error:
        raise StoreError(f"store: an entry cannot be read ({error}); start again with --fresh") from error

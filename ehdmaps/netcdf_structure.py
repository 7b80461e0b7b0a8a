"""The structure of a netCDF file, looked at before the library opens it: damage that would hang it or fill the memory.

The C libraries below netCDF check most of what they read. Three things they do not: the objects of a global heap of
HDF5, in which texts stand, may have a size with which their reader never comes to the end of the heap; what points to a
text is believed as to its length; and the header of a classic file is believed as to how many dimensions, attributes
and variables follow. Memory is taken for all that they say.

References
----------
The HDF Group, HDF5 File Format Specification 3.0, section III.E (global heap). Unidata, NetCDF Classic Format
Specification (CDF-1, 2 and 5).
"""

from __future__ import annotations

import mmap
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

DAMAGE = (OSError, RuntimeError, ValueError, LookupError, AttributeError, TypeError, MemoryError)
"""What netCDF4 raises on damaged files, depending on what its C library stumbles over."""


@contextmanager
def opened(path: str | Path) -> Iterator[Any]:
    """A netCDF file by its library, once its structure was looked at: the one door to files that others made.

    Parameters
    ----------
    path : str or Path
        The file.

    Raises
    ------
    OSError, or another one of `DAMAGE`
        If it is no regular file, is damaged, or is none of netCDF; callers say what they wanted to read.
    """
    from netCDF4 import Dataset

    if not stat.S_ISREG(Path(path).stat().st_mode):
        raise OSError("no regular file")
    if damage := structure_problem(path):
        raise OSError(damage)
    with Dataset(path) as file:
        yield file


_HDF5 = b"\x89HDF\r\n\x1a\n"
_HEAP = b"GCOL\x01\x00\x00\x00"
"""A global heap collection: signature, version 1, three reserved bytes."""

_HEAD = 16
"""Bytes of the head of a heap, and of each object in it."""

_LONG = 2**24
"""Length from which a text is looked at [bytes]: the library takes memory for it before it looks for the text."""

_MOST_SOUGHT = 2**31
"""Bytes that are looked through for what points to a heap, all heaps together: a second at most."""

_TYPE_BYTES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8, 7: 1, 8: 2, 9: 4, 10: 8, 11: 8}
"""Bytes of a value, by the number of its type in a classic file."""

_DIMENSIONS, _VARIABLES, _ATTRIBUTES = 10, 11, 12
"""Tags of the lists of a classic header."""


def structure_problem(path: str | Path) -> str:
    """Say why the library must not open a file; empty where it may, whether it is a netCDF file or not.

    Parameters
    ----------
    path : str or Path
        A regular file that can be read.
    """
    with open(path, "rb") as file:
        start = file.read(len(_HDF5))
        if start == _HDF5:
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
                return _heap_problem(content)
        if start[:3] == b"CDF":
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
                return _Header(content).problem()
    return ""


def _heap_problem(content: mmap.mmap) -> str:
    """Fault in the global heaps of an HDF5 file."""
    place, heaps = content.find(_HEAP), 0
    while place >= 0:
        size = int.from_bytes(content[place + 8 : place + _HEAD], "little")
        if not _HEAD <= size <= len(content) - place:
            return f"the heap at byte {place} is said to have {size} bytes; the file is damaged"
        here, lengths = place + _HEAD, {}
        while here + _HEAD <= place + size:
            index = int.from_bytes(content[here : here + 2], "little")
            length = int.from_bytes(content[here + 8 : here + _HEAD], "little")
            # Free space, object 0, counts its head; objects are filled up to 8 bytes.
            step = _HEAD + (length + 7) // 8 * 8 if index else length
            if not _HEAD <= step <= place + size - here:
                return f"an object of the heap at byte {place} is said to have {length} bytes; the file is damaged"
            lengths[index] = length
            here += step
        heaps += 1
        if heaps * len(content) < _MOST_SOUGHT and _long_text(content, place, lengths):
            return f"a text of the heap at byte {place} is said to be longer than it is; the file is damaged"
        place = content.find(_HEAP, place + size)
    return ""


def _long_text(content: mmap.mmap, place: int, lengths: dict[int, int]) -> bool:
    """Tell whether a text is said to be far longer than the object of the heap in which it stands.

    What points to a text has its length, the address of its heap and the number of the object, of 4, 8 and 4 bytes.
    """
    address = place.to_bytes(8, "little")
    at = content.find(address)
    while at >= 0:
        length = int.from_bytes(content[max(at - 4, 0) : at], "little")
        index = int.from_bytes(content[at + 8 : at + 12], "little")
        if index and index in lengths and length > _LONG and length > lengths[index]:
            return True
        at = content.find(address, at + 8)
    return False


class _BeyondError(Exception):
    """A header promises more than the file has."""


class _Header:
    """Reads the header of a classic file from its beginning on.

    Parameters
    ----------
    content : mmap
        The file.
    """

    def __init__(self, content: mmap.mmap) -> None:
        self._content = content
        # CDF-5 counts with 8 bytes, CDF-2 and 5 have addresses of 8 bytes.
        version = content[3] if len(content) > 3 else 0
        self._count_bytes, self._address_bytes = (8 if version == 5 else 4), (4 if version == 1 else 8)
        self._here = 4

    def problem(self) -> str:
        """Description of its fault; empty where there is none."""
        try:
            self._number(self._count_bytes)  # records
            for _ in range(self._entries(_DIMENSIONS)):
                self._name()
                self._number(self._count_bytes)
            self._attributes()
            for _ in range(self._entries(_VARIABLES)):
                self._name()
                self._skip(self._number(self._count_bytes), self._count_bytes)
                self._attributes()
                self._skip(1, 4 + self._count_bytes + self._address_bytes)
        except _BeyondError:
            return f"its header promises more than the {len(self._content)} bytes of the file; the file is damaged"
        return ""

    def _attributes(self) -> None:
        """Pass over a list of attributes."""
        for _ in range(self._entries(_ATTRIBUTES)):
            self._name()
            # What is of no known type, the library says.
            bytes_each = _TYPE_BYTES.get(self._number(4), 1)
            count = self._number(self._count_bytes)
            self._skip((count * bytes_each + 3) // 4, 4)

    def _entries(self, tag: int) -> int:
        """Number of entries of a list; each has 8 bytes at least."""
        read_tag = self._number(4)
        count = self._number(self._count_bytes)
        if (count and read_tag != tag) or 8 * count > len(self._content) - self._here:
            raise _BeyondError
        return count

    def _name(self) -> None:
        """Pass over a name, filled up to 4 bytes."""
        self._skip((self._number(self._count_bytes) + 3) // 4, 4)

    def _number(self, length: int) -> int:
        """Read a number."""
        self._skip(1, length)
        return int.from_bytes(self._content[self._here - length : self._here], "big")

    def _skip(self, count: int, length: int) -> None:
        """Pass over so many things of so many bytes."""
        self._here += count * length
        if self._here > len(self._content):
            raise _BeyondError

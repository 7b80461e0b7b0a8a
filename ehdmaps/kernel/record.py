"""Structs: numbers and arrays of Python as C sees them."""

from __future__ import annotations

import ctypes
import functools
import math
import operator
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

numbers = ctypes.POINTER(ctypes.c_double)
"""Type of a field or argument ``double *``: an array of float64."""

integers = ctypes.POINTER(ctypes.c_int64)
"""Type of a field or argument ``int64_t *``: an array of int64."""

_TYPES = {numbers: np.dtype(np.float64), integers: np.dtype(np.int64)}


class Record(ctypes.Structure):
    """A struct of C whose pointers are arrays of numpy, which it keeps alive.

    A subclass lists `_fields_` as `ctypes.Structure` does: `ctypes.c_int64` and `ctypes.c_double`; `numbers` and
    `integers` for pointers to arrays; another record, or an array of so many numbers, that lies within the struct; and
    `ctypes.POINTER` of another record. A field that is left out is zero, a null pointer. It is compared with C by
    `ehdmaps.kernel.library.checked`.

    Records are copied and pickled by their values; pointers are made anew.

    Parameters
    ----------
    **values
        Values of fields by their names: numbers, arrays, records.

    Attributes
    ----------
    shapes : mapping of str to tuple of str or int
        Lengths along the axes of arrays, as numbers or names of fields; each array that is listed is compared with it,
        so that C does not read beyond one.

    Examples
    --------
    >>> class Table(Record):
    ...     _fields_ = (("rows", ctypes.c_int64), ("values", numbers))
    ...     shapes = {"values": ("rows", 2)}
    >>> table = Table(rows=3, values=np.ones((3, 2)))
    >>> table.values[5], table.given("values").shape
    (1.0, (3, 2))
    """

    shapes: ClassVar[Mapping[str, tuple[str | int, ...]]] = {}

    def __init__(self, **values: Any) -> None:
        super().__init__()
        self._kept: dict[str, Any] = {}
        self.put(**values)

    def put(self, **values: Any) -> None:
        """Set fields, arrays among them; a number alone is also set as an attribute.

        Parameters
        ----------
        **values
            Values of fields by their names.

        Raises
        ------
        TypeError
            If there is no such field, or a value is not what the field takes: an array of another type, or one that
            is not contiguous.
        ValueError
            If an array has not the lengths that `shapes` says.
        """
        types = _types(type(self))
        for name, value in values.items():
            if name not in types:
                raise TypeError(f"{type(self).__name__} has no field {name!r}; it has {', '.join(types)}")
            self._put(name, types[name], value)
        for name, shape in self.shapes.items():
            if (array := self._kept.get(name)) is not None:
                wanted = math.prod([size if isinstance(size, int) else getattr(self, size) for size in shape])
                if array.size != wanted:
                    raise ValueError(
                        f"{type(self).__name__}.{name}: got {array.size} numbers; allowed: {wanted}, as many as "
                        f"{' x '.join(map(str, shape))}"
                    )

    def _put(self, name: str, kind: Any, value: Any) -> None:
        """Set one field."""
        if kind in _TYPES:
            place = None if value is None else address(value, _TYPES[kind], f"{type(self).__name__}.{name}")
            ctypes.c_void_p.from_buffer(self, getattr(type(self), name).offset).value = place
            self._kept[name] = value
        elif isinstance(value, Record):
            setattr(self, name, ctypes.pointer(value) if hasattr(kind, "contents") else value)
            self._kept[name] = value
        elif kind is ctypes.c_int64:
            setattr(self, name, operator.index(value))
        elif kind is ctypes.c_double:
            setattr(self, name, float(value))
        elif isinstance(value, np.ndarray):
            setattr(self, name, kind(*value.tolist()))
        else:
            setattr(self, name, value)
            self._kept.pop(name, None)

    @property
    def address(self) -> int:
        """Address of the struct, for `ctypes.c_void_p`; good as long as the record is."""
        return ctypes.addressof(self)

    def given(self, name: str) -> Any:
        """Return the array or record that a field was given; None without."""
        return self.__dict__.get("_kept", {}).get(name)

    def values_by_name(self) -> dict[str, Any]:
        """Return the values of all fields by their names, from which an equal record is made."""
        return _values(self, self)

    def __reduce__(self) -> tuple[Any, ...]:
        return _remade, (type(self), self.values_by_name())


def room(record: type[Record], sizes: Mapping[str, int]) -> dict[str, Any]:
    """Make arrays of zeros for all fields of a record whose shapes are known.

    Parameters
    ----------
    record : type of Record
        The struct.
    sizes : mapping of str to int
        Lengths that `Record.shapes` names.
    """
    types = _types(record)
    return {
        name: np.zeros([size if isinstance(size, int) else sizes[size] for size in shape], dtype=_TYPES[types[name]])
        for name, shape in record.shapes.items()
    }


def address(array: Any, dtype: np.dtype[Any], where: str) -> int:
    """Return the address of an array's numbers, for `ctypes.c_void_p`, after it was checked.

    Parameters
    ----------
    array : array
        An array, which must be kept alive as long as the address is used.
    dtype : dtype
        Type of its numbers.
    where : str
        What it is for; begins the message.

    Raises
    ------
    TypeError
        If it is no array of this type, or not contiguous.
    """
    if not isinstance(array, np.ndarray) or array.dtype != dtype:
        got = f"an array of {array.dtype}" if isinstance(array, np.ndarray) else type(array).__name__
        raise TypeError(f"{where}: got {got}; allowed: an array of {dtype}")
    if not (array.flags.c_contiguous and array.flags.aligned):
        raise TypeError(f"{where}: got an array that is not contiguous; allowed: one of numpy.ascontiguousarray")
    return array.ctypes.data


def at(array: Any) -> int:
    """Return the address of the numbers of an array that its caller has made contiguous; quick, checks nothing.

    Parameters
    ----------
    array : array
        An array, which must be kept alive as long as the address is used.
    """
    return array.__array_interface__["data"][0]  # type: ignore[no-any-return]


@functools.cache
def _types(record: Any) -> dict[str, Any]:
    """Types of the fields of a struct by their names, those of its base classes first."""
    found: dict[str, Any] = {}
    for kind in reversed(record.__mro__):
        found.update({field[0]: field[1] for field in kind.__dict__.get("_fields_", ())})
    return found


def _values(record: Any, owner: Any) -> dict[str, Any]:
    """Values of a struct's fields; arrays are those that its owner, or a record within, was given."""
    found: dict[str, Any] = {}
    for name, kind in _types(record.__class__).items():
        kept, value = owner.given(name), getattr(record, name)
        if isinstance(value, Record):
            # numbers in it may have been set meanwhile; its arrays are those of the record that was put there
            found[name] = _remade(type(value), _values(value, kept if kept is not None else _NOTHING))
        elif hasattr(kind, "contents"):
            found[name] = kept
        elif issubclass(kind, ctypes.Array):
            found[name] = np.array(value)
        else:
            found[name] = value
    return found


class _Nothing:
    """An owner of no arrays."""

    def given(self, name: str) -> None:
        """Nothing."""


_NOTHING = _Nothing()


def _remade(record: type[Record], values: dict[str, Any]) -> Record:
    """A record of its values."""
    return record(**values)

"""The functions of a kind of elements as a run calls them: addresses, of C functions or of such that call Python.

A function of a kind (`mbs.model.blocks.Kind`) is one of these:

- the name of a function in the C library, for the kinds of this package;
- an address as an integer, a ctypes function, or an object that has it as `address`, as `numba.cfunc` makes it: any
  function of the types in `ehdmaps/kernel/c/run/block.h`, which takes the address of the block's data;
- any other callable: it is called from the run with the data themselves and with arrays of numpy, as
  `mbs.model.blocks.Kind` says. This costs some 10 us each time, and holds Python's lock.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np

from ehdmaps.kernel.library import library
from ehdmaps.kernel.record import Record
from mbs.model.blocks import STOPPED, Answers, Kind, Moment
from mbs.transient.run_arrays import BlockRow


class _Moment(ctypes.Structure):
    """`ehd_moment` of `block.h`."""

    _fields_ = (
        ("step", ctypes.c_int64),
        *((name, ctypes.c_double) for name in ("time", "speed", "angle", "by_q", "by_v")),
    )

    def moment(self) -> Moment:
        """As Python has it."""
        return Moment(self.step, self.time, self.speed, self.angle, self.by_q, self.by_v)


class _Answers(ctypes.Structure):
    """`ehd_answers` of `block.h`."""

    _fields_ = (
        *((name, ctypes.c_void_p) for name in ("force", "slopes", "outside")),
        ("m", ctypes.c_int64),
    )


_AT, _OF_ALL = ctypes.POINTER(_Moment), ctypes.POINTER(_Answers)
_ANSWER = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, _AT, ctypes.c_void_p, _OF_ALL)
_ACCEPT = ctypes.CFUNCTYPE(None, ctypes.c_void_p, _AT)
_POWERS = ctypes.CFUNCTYPE(None, ctypes.c_void_p, _AT, ctypes.c_void_p, _OF_ALL, ctypes.c_void_p)
_C_FUNCTION: Any = _ANSWER.__base__  # of functions of all libraries


class BlockFunctions:
    """Functions of one block during a run.

    Parameters
    ----------
    kind : Kind
        Kind of its elements.
    elements : int
        Number of all elements of the run.
    raised : list of BaseException
        What Python functions raised is added here.
    """

    def __init__(self, kind: Kind, elements: int, raised: list[BaseException]) -> None:
        self._elements, self._raised, self._data = elements, raised, None
        self._views: dict[tuple[int, ...], tuple[Any, ...]] = {}
        self._answer_of: Any = kind.answer
        self._accept_of: Any = kind.accept
        self._powers_of: Any = kind.powers
        self._kept = [
            _function(kind.answer, self._answer, _ANSWER),
            _function(kind.accept, self._accept, _ACCEPT),
            _function(kind.powers, self._powers, _POWERS),
        ]
        self._addresses = [_address(one) for one in self._kept]

    def row(self, data: Any) -> BlockRow:
        """The block with its data for some steps.

        Parameters
        ----------
        data : Record, ctypes.Structure, array, int, None or anything
            What the functions take: C has the address of a struct or of an array's numbers, or the integer.
        """
        self._data = data
        return BlockRow(*self._addresses, _data_address(data))

    def _answer(self, data: Any, at: Any, motion: int, answers: Any) -> int:
        """Call a Python function for answers."""
        if self._raised:
            return STOPPED
        try:
            felt, found, _ = self._seen(motion, answers.contents, 0)
            return int(self._answer_of(self._data, at.contents.moment(), felt, found))
        except BaseException as error:  # an interrupt, too: it is raised again after the steps
            self._raised.append(error)
            return STOPPED

    def _accept(self, data: Any, at: Any) -> None:
        """Call a Python function that is told of a step."""
        try:
            self._accept_of(self._data, at.contents.moment())
        except BaseException as error:
            self._raised.append(error)

    def _powers(self, data: Any, at: Any, motion: int, answers: Any, out: int) -> None:
        """Call a Python function for powers."""
        try:
            felt, found, powers = self._seen(motion, answers.contents, out)
            self._powers_of(self._data, at.contents.moment(), felt, found, powers)
        except BaseException as error:
            self._raised.append(error)

    def _seen(self, motion: int, answers: Any, out: int) -> tuple[Any, ...]:
        """Arrays over what C has: motion (2, m), answers, powers (elements, 3)."""
        key = motion, answers.force, answers.slopes, answers.outside, out
        if key not in self._views:
            m, count = answers.m, self._elements
            found = Answers(
                _view(answers.force, (m,)), _view(answers.slopes, (m, m)), _view(answers.outside, (count,), np.int64)
            )
            powers = _view(out, (count, 3)) if out else None
            self._views[key] = _view(motion, (2, m)), found, powers
        return self._views[key]


def _view(address: int, shape: tuple[int, ...], dtype: Any = np.float64) -> Any:
    """An array over numbers that C has."""
    size = int(np.prod(shape)) * 8
    numbers: Any = (ctypes.c_char * size).from_address(address)
    return np.frombuffer(numbers, dtype=dtype).reshape(shape)


def _function(given: Any, through: Callable[..., Any], called: Any) -> Any:
    """Function that is called: as given, or one of C that calls Python."""
    native = given is None or isinstance(given, str | int | _C_FUNCTION) or hasattr(given, "address")
    return given if native else called(through)


def _address(given: Any) -> int | None:
    """Address of a function."""
    if given is None or isinstance(given, int):
        return given
    if hasattr(given, "address"):
        return int(given.address)
    found = getattr(library(), given) if isinstance(given, str) else given
    return ctypes.cast(found, ctypes.c_void_p).value


def _data_address(data: Any) -> int | None:
    """Address of data."""
    if data is None or isinstance(data, int):
        return data
    if isinstance(data, Record | ctypes.Structure):
        return ctypes.addressof(data)
    return data.ctypes.data if isinstance(data, np.ndarray) else None

"""Functions of a kind of elements in C, asked from Python as a run asks them."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.kernel.library import function
from ehdmaps.kernel.record import at
from mbs.model.blocks import Answers, Kind, Moment
from mbs.transient.block_functions import _Answers, _Moment


def answer(kind: Kind, data: Any, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Have a kind answer to a motion (2, m) by its function; the status."""
    asked = np.ascontiguousarray(motion)
    called = function(str(kind.answer), *(ctypes.c_void_p,) * 4)
    of = _of(answers)
    return int(called(data.address, _at(_Moment(*moment)), at(asked), _at(of)))


def accept(kind: Kind, data: Any, moment: Moment) -> None:
    """Tell a kind that a step is made."""
    function(str(kind.accept), ctypes.c_void_p, ctypes.c_void_p, result=None)(data.address, _at(_Moment(*moment)))


def powers(kind: Kind, data: Any, moment: Moment, motion: FloatArray, answers: Answers) -> FloatArray:
    """Powers of all elements after an answer, shape (elements, 3)."""
    asked, out = np.ascontiguousarray(motion), np.zeros((answers.outside.size, 3))
    called = function(str(kind.powers), *(ctypes.c_void_p,) * 5, result=None)
    called(data.address, _at(_Moment(*moment)), at(asked), _at(_of(answers)), at(out))
    return out


def _of(answers: Answers) -> _Answers:
    """Answers as C has them."""
    return _Answers(*map(at, answers), answers.force.size)


def _at(struct: Any) -> Any:
    """A struct as an argument, which keeps it alive."""
    return ctypes.byref(struct)

"""A block of elements in C, asked at single moments instead of by a run."""

from __future__ import annotations

import ctypes

import numpy as np

from ehdmaps.kernel.library import library
from mbs.model.blocks import Answers
from mbs.transient.block_functions import _ACCEPT, _ANSWER, _POWERS, _Answers, _Moment


class AskedBlock:
    """Functions of a kind in C with the data of a block."""

    def __init__(self, kind, data, felt, elements=1):
        self._data = ctypes.addressof(data)
        names = ((_ANSWER, kind.answer), (_ACCEPT, kind.accept), (_POWERS, kind.powers))
        self._functions = [form((name, library())) if name else None for form, name in names]
        self.found = Answers(np.zeros(felt), np.zeros((felt, felt)), np.zeros(elements, dtype=np.int64))
        self._answers = _Answers(*(one.ctypes.data for one in self.found), felt)

    def answer(self, moment, motion):
        """Status; `found` is written."""
        given = np.ascontiguousarray(motion, dtype=np.float64)
        return self._functions[0](self._data, _Moment(*moment), given.ctypes.data, self._answers)

    def accept(self, moment):
        self._functions[1](self._data, _Moment(*moment))

    def powers(self, moment, motion):
        """Powers (elements, 3)."""
        given, out = np.ascontiguousarray(motion, dtype=np.float64), np.zeros((self.found.outside.size, 3))
        at = _Moment(*moment)
        self._functions[2](self._data, at, given.ctypes.data, self._answers, out.ctypes.data)
        return out

"""Types of arrays and of formulas over them: the one home of their names."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
IntArray = npt.NDArray[np.int64]
IndexArray = npt.NDArray[np.intp]
BoolArray = npt.NDArray[np.bool_]
ByteArray = npt.NDArray[np.uint8]


Values = TypeVar("Values", float, FloatArray)


def as_given(result: Any, given: Values) -> Values:
    """The result as a float if the argument was one, else as an array."""
    return np.asarray(result, dtype=np.float64) if isinstance(given, np.ndarray) else float(result)

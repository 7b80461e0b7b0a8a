"""Types of arrays and of formulas over them: the one home of their names; and arrays as variables of datasets."""

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


def variable(dims: str | tuple[str, ...], values: Any, units: str, words: str) -> tuple[Any, Any, dict[str, str]]:
    """A variable, or coordinate, of a labelled dataset as xarray takes it.

    Parameters
    ----------
    dims : str or tuple of str
        Names of the axes.
    values : array_like
        Values of the variable, one axis a name.
    units : str
        SI unit; empty for what has none, such as a text.
    words : str
        Meaning of the variable.

    Examples
    --------
    >>> variable("mode", [93.1], "Hz", "frequency")
    ('mode', [93.1], {'units': 'Hz', 'long_name': 'frequency'})
    """
    return dims, values, {"units": units, "long_name": words} if units else {"long_name": words}

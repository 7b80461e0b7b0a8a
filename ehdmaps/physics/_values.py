"""Types of the formulas: a float in gives a float out, an array in an array out."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

from ehdmaps.arrays import FloatArray

Values = TypeVar("Values", float, FloatArray)


def as_given(result: Any, given: Values) -> Values:
    """The result as a float if the argument was one, else as an array."""
    return np.asarray(result, dtype=np.float64) if isinstance(given, np.ndarray) else float(result)

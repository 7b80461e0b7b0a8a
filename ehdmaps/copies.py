"""Copies within what numba compiles.

For ``out[:] = values`` numba compiles the text of an error about shapes too: some seconds for each process and each
kind of slice, a tenth of all that is compiled.
"""

from __future__ import annotations

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit


@njit(error_model="numpy", forceinline=True)
def put(values: FloatArray, out: FloatArray) -> None:
    """Copy one row into another, as long as the latter.

    Parameters
    ----------
    values : array, shape (n,)
        What is copied; its length is not looked at.
    out : array, shape (n,)
        Row that is overwritten.
    """
    for i in range(out.size):
        out[i] = values[i]

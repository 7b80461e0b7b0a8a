"""Arguments of a contact law: arrays of doubles, of one shape, finite; messages name the one that is wrong."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError


def floats(**values: npt.ArrayLike) -> dict[str, FloatArray]:
    """Arrays of doubles by name.

    Raises
    ------
    InputError
        If one of them holds what is no number.
    """
    arrays = {}
    for name, value in values.items():
        try:
            arrays[name] = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError):
            raise InputError(f"contact law, {name}: got {value!r}; allowed: real numbers") from None
    return arrays


def broadcast(named: Mapping[str, FloatArray]) -> tuple[tuple[int, ...], list[FloatArray]]:
    """Common shape of arrays, and flat arrays of it that compiled code takes: contiguous and writeable.

    Parameters
    ----------
    named : mapping of str to array
        Arrays of doubles by name, of any shapes that broadcast.

    Raises
    ------
    InputError
        If their shapes do not broadcast.
    """
    try:
        shape = np.broadcast_shapes(*(array.shape for array in named.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in named.items())
        raise InputError(f"contact law: got shapes that do not broadcast: {shapes}") from None
    flat = []
    for array in named.values():
        ready = array.shape == shape and array.flags.c_contiguous and array.flags.writeable
        full = array if ready else np.empty(shape)
        if not ready:
            full[...] = array
        flat.append(full.reshape(-1))
    return shape, flat


def check_finite(named: Mapping[str, FloatArray]) -> None:
    """Refuse values that are no finite numbers.

    Parameters
    ----------
    named : mapping of str to array
        Arrays of doubles by name.

    Raises
    ------
    InputError
        With every array that holds one.
    """
    problems = [
        f"contact law, {name}: got {values[~np.isfinite(values)].flat[0]} "
        f"({np.count_nonzero(~np.isfinite(values))} of {values.size}); allowed: finite numbers"
        for name, values in named.items()
        if not np.all(np.isfinite(values))
    ]
    if problems:
        raise InputError(problems)

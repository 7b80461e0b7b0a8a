"""Which choices no other one beats: the front of a measurement of cost and error."""

from __future__ import annotations

import math
from collections.abc import Sequence


def front(cost: Sequence[float], error: Sequence[float]) -> tuple[int, ...]:
    """Indices of the choices that no other one beats, by rising cost.

    Parameters
    ----------
    cost : sequence of float
        Cost of each choice.
    error : sequence of float
        Error of each choice; one whose cost or error is not finite is never on the front.

    Returns
    -------
    tuple of int
        Each further one costs more than the one before, and has a smaller error.

    Examples
    --------
    >>> front([1.0, 2.0, 3.0, 2.5], [0.5, 0.1, 0.2, math.nan])
    (0, 1)
    """
    known = [index for index in range(len(cost)) if math.isfinite(cost[index]) and math.isfinite(error[index])]
    found: list[int] = []
    for index in sorted(known, key=lambda index: (cost[index], error[index])):
        if not found or error[index] < error[found[-1]]:
            found.append(index)
    return tuple(found)

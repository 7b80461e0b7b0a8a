"""Forces or pressures of a contact without friction and tension, by the set of its places that touch."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError

_MOST_CHANGES = 100


def touching(
    compliance: FloatArray, gap: FloatArray, rigid: FloatArray, shares: FloatArray, wanted: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Forces >= 0 where gaps are closed, zero where they are open, under given loads.

    The set of touching places is changed at once wherever it pulls or overlaps, until nothing changes.

    Parameters
    ----------
    compliance : array (n, n)
        Approach of the surfaces at each place by a force at each other one.
    gap : array (n,)
        Gap at each place before bodies move or yield [m].
    rigid : array (n, r)
        How far each rigid motion closes each gap.
    shares : array (n,)
        What a force counts for in the loads.
    wanted : array (r,)
        Load that each rigid motion does its work against.

    Returns
    -------
    forces : array (n,)
        Forces, in the unit that belongs to `compliance`.
    motions : array (r,)
        The rigid motions.

    Raises
    ------
    AnalysisError
        If the set does not settle.
    """
    active = gap <= np.quantile(gap, 0.5)
    count = wanted.size
    for _ in range(_MOST_CHANGES):
        inside = np.flatnonzero(active)
        size = inside.size
        system = np.zeros((size + count, size + count))
        system[:size, :size] = compliance[np.ix_(inside, inside)]
        system[:size, size:] = -rigid[inside]
        system[size:, :size] = (rigid[inside] * shares[inside, None]).T
        # Rows of loads and of gaps, and columns of forces and of motions, differ by many powers of ten.
        rows, columns = np.abs(system).max(axis=1), np.abs(system).max(axis=0)
        if not (np.all(rows > 0.0) and np.all(columns > 0.0)):
            break
        right = np.concatenate([-gap[inside], wanted]) / rows
        try:
            found = np.linalg.solve(system / rows[:, None] / columns, right) / columns
        except np.linalg.LinAlgError:  # a row of places cannot bear a moment
            break
        forces = np.zeros(gap.size)
        forces[inside] = found[:size]
        left = gap - rigid @ found[size:] + compliance @ forces
        new = np.where(active, forces > 0.0, left < 0.0)
        if np.array_equal(new, active):
            return forces, found[size:]
        active = new
    raise AnalysisError(
        f"contact: the places that touch did not settle in {_MOST_CHANGES} changes; the load may lie outside the "
        "roller, or be no load"
    )

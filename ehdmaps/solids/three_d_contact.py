"""Forces or pressures of a contact without friction and tension, by the set of its places that touch."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError

_MOST_CHANGES = 200


def touching(
    compliance: FloatArray, gap: FloatArray, rigid: FloatArray, shares: FloatArray, wanted: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Forces >= 0 where gaps are closed, zero where they are open, under given loads.

    Places that pull leave the set of those that touch; once none pulls, those that overlap join it, until none does.

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

    References
    ----------
    J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, Kluwer, 1990: the algorithm NORM.
    """
    active = gap <= np.quantile(gap, 0.5)
    count = wanted.size
    unit, largest, spans = float(np.abs(compliance).max()), float(shares.max()), np.abs(rigid).max(axis=0)
    for _ in range(_MOST_CHANGES):
        inside = np.flatnonzero(active)
        size = inside.size
        # Forces are measured by what they yield, motions by themselves, loads by the largest share: all near one.
        system = np.zeros((size + count, size + count))
        system[:size, :size] = compliance[np.ix_(inside, inside)] / unit
        system[:size, size:] = -rigid[inside] / spans
        system[size:, :size] = (rigid[inside] / spans * (shares[inside, None] / largest)).T
        right = np.concatenate([-gap[inside], wanted / spans * (unit / largest)])
        try:
            found = np.linalg.solve(system, right)
        except np.linalg.LinAlgError:  # places in a row bear no moment
            break
        motions = found[size:] / spans
        forces = np.zeros(gap.size)
        forces[inside] = found[:size] / unit
        pulling = active & (forces <= 0.0)
        # New places only where none pulls: both at once may go round in circles.
        if np.any(pulling):
            active = active & ~pulling
            continue
        left = gap - rigid @ motions + compliance @ forces
        overlapping = ~active & (left < 0.0)
        if not np.any(overlapping):
            return forces, motions
        active = active | overlapping
    raise AnalysisError(
        f"contact: the places that touch did not settle in {_MOST_CHANGES} changes; the load may lie outside the "
        "roller, or be no load"
    )

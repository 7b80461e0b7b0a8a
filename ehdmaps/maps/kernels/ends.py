"""Loads at which the films of a map end, over speed and temperature.

An array (1 + n_u, 1 + n_T) holds them [N/m], with ln u of speeds in the first column and temperatures [K] in
the first row. Between these ln of the load is straight over ln u and T, outside it is held.
"""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray, IndexArray


def one_end(load: float) -> FloatArray:
    """Ends that are the same load at all speeds and temperatures.

    Parameters
    ----------
    load : float
        [N/m].
    """
    return np.array([[0.0, 0.0], [0.0, load]])


def ends_at(ends: FloatArray, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
    """Loads at which films end [N/m], (n_u, n_T).

    Parameters
    ----------
    ends : array
        Ends of the loads.
    speeds, temperatures : array (n_u,), (n_T,)
        u [m/s], > 0, and T [K].
    """
    return ends_of(ends, np.asarray(speeds, np.float64)[:, None], np.asarray(temperatures, np.float64))


def ends_of(ends: FloatArray, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
    """Loads at which films end [N/m], at speeds and temperatures that broadcast.

    Parameters
    ----------
    ends : array
        Ends of the loads.
    speeds, temperatures : array
        u [m/s], > 0, and T [K].
    """
    loads = ends[1:, 1:]
    i, up, a = _between(ends[1:, 0], np.log(speeds))
    j, on, b = _between(ends[0, 1:], temperatures)
    corner, beside, above, across = loads[i, j], loads[i, on], loads[up, j], loads[up, on]
    low = (1.0 - b) * np.log(corner) + b * np.log(beside)
    high = (1.0 - b) * np.log(above) + b * np.log(across)
    alike = (beside == corner) & (above == corner) & (across == corner)
    return np.where(alike, corner, np.exp((1.0 - a) * low + a * high))


def _between(nodes: FloatArray, places: FloatArray) -> tuple[IndexArray, IndexArray, FloatArray]:
    """Nodes beside places, and the weights of the second ones."""
    last = nodes.size - 1
    i = np.clip(np.searchsorted(nodes, places, side="right") - 1, 0, last)
    up = np.minimum(i + 1, last)
    inside = (places > nodes[0]) & (places < nodes[last])
    width = np.where(up > i, nodes[up] - nodes[i], 1.0)
    return i, np.where(inside, up, i), np.where(inside, (places - nodes[i]) / width, 0.0)

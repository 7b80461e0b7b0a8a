"""Response over frequency between the natural frequencies at which the table of points holds it.

k and c are even in the frequency: they are read as cubics in ln(1 + Omega^2), Omega = omega sqrt(a^2 + 2 h Rx)/u, from
slow motion on. What that leaves is told by cubics through all but the nearest frequency.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import FloatArray
from ehdmaps.table.points.films import PointFilms

_AT = 1e-9


class ReadResponse(NamedTuple):
    """k and c of a point over frequency, each (k,); NaN above the highest frequency that is held.

    Attributes
    ----------
    stiffness, damping : ndarray
        [N/m], [N s/m].
    stiffness_error, damping_error : ndarray
        Relative to abs(k) and abs(c).
    """

    stiffness: FloatArray
    damping: FloatArray
    stiffness_error: FloatArray
    damping_error: FloatArray


def read_response(films: PointFilms, frequencies: FloatArray) -> ReadResponse:
    """Response of one point.

    Parameters
    ----------
    films : PointFilms
        Films of one point: arrays without dims, or of one entry.
    frequencies : ndarray, shape (k,)
        [Hz], >= 0.
    """
    held = np.r_[0.0, films.frequencies.ravel()]
    if not math.isfinite(held[-1]):  # dry: no film, one stiffness
        stiffness = np.full(frequencies.size, float(films.stiffness.item()))
        none = np.zeros(frequencies.size)
        return ReadResponse(stiffness, none, none, none)
    unit = held[1] * 2.0  # Omega of the first frequency is a half
    places, wanted = (np.log1p(np.square(x / unit)) for x in (held, frequencies))
    found: list[FloatArray] = []
    errors: list[FloatArray] = []
    for name in ("stiffness", "damping"):
        slow, fast = getattr(films, name).item(), getattr(films, f"response_{name}").ravel()
        values = np.r_[slow, fast]
        stated = np.r_[films.errors[name].item() * abs(slow), films.errors[f"response_{name}"].ravel() * np.abs(fast)]
        read = CubicSpline(places, values)(wanted)
        left = np.array([_without(places, values, x, y) for x, y in zip(wanted, read, strict=True)])
        above = np.clip(np.searchsorted(places, wanted), 1, places.size - 1)
        wrong = np.maximum(stated[above - 1], stated[above]) + left
        beyond = wanted > places[-1] + _AT
        found.append(np.where(beyond, math.nan, read))
        errors.append(np.where(beyond, math.nan, wrong / np.abs(read)))
    return ReadResponse(found[0], found[1], errors[0], errors[1])


def _without(places: FloatArray, values: FloatArray, wanted: float, read: float) -> float:
    """Difference of a cubic through all but the nearest place; nothing at a place itself."""
    nearest = int(np.argmin(np.abs(places - wanted)))
    if abs(places[nearest] - wanted) < _AT:
        return 0.0
    inner = min(max(nearest, 1), places.size - 2)
    rest = np.delete(np.arange(places.size), inner)
    return abs(float(CubicSpline(places[rest], values[rest])(wanted)) - read)

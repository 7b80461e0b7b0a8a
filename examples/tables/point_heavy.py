"""Films of points under loads that the grids do not resolve: numbers go on along the logarithm of the load.

Where a contact is heavy, its film is made in a strip at its edges that narrows with the film, and all of it is that
strip on another scale: films, the approach that they take, and damping become powers of the load, one after the other
lost to the grids. Films and film offset go on with the slope of their last nodes. Damping tends to the change of the
film over the load, held for the time in which oil passes the contact, and so to the slope of the film offset: it goes
on with the mean of that and its own. The largest pressure is that of Hertz times a factor that stays, stiffness that of
the dry contact.

How wrong that is, is measured: lines are cut short and continued, and held against what was solved beyond the cut. That
error goes with the distance in ln M.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IndexArray
from ehdmaps.table.points.nodes import FIELDS

HEAVY = 3.0
"""zeta above which numbers may be continued."""

RESOLVED = 0.2
"""Stated error of a film, the film offset or damping above which it is continued from lighter loads."""

SPAN = 1.4
"""Units of zeta over which slopes are taken."""

COVERED = 95.0
"""Part of the cut lines that lie within the error that is stated, in per cent."""

_NAMES = tuple(field.name for field in FIELDS)
_OFFSET, _DAMPING = _NAMES.index("film_offset"), _NAMES.index("damping")
_OWN = tuple(_NAMES.index(name) for name in ("film_offset", "central_film", "minimum_film"))
_AS_STATED = np.array([name not in ("damping", *(_NAMES[i] for i in _OWN)) for name in _NAMES])
_STIFF = tuple(i for i, name in enumerate(_NAMES) if name.startswith("stiffness"))


class Continued(NamedTuple):
    """Numbers at the nodes, those continued among them.

    Attributes
    ----------
    values : ndarray, shape (n_zeta, ..., fields)
        Forms of the fields; NaN where there is neither a film nor a lighter one to go on from.
    stated : ndarray, shape (n_zeta, ..., errors)
        What the solver states of them, or of what they go on from.
    growth : ndarray, shape (n_zeta, ..., errors)
        What continuing adds to that.
    continued : ndarray of bool, shape (n_zeta, ...)
        Nodes with a number that is not the one that was solved.
    rates : ndarray, shape (fields,)
        Growth of the errors by a unit of zeta.
    """

    values: FloatArray
    stated: FloatArray
    growth: FloatArray
    continued: BoolArray
    rates: FloatArray


def continued_lines(zeta: FloatArray, values: FloatArray, stated: FloatArray) -> Continued:
    """Continue what is not resolved under heavy loads.

    Parameters
    ----------
    zeta : ndarray, shape (n_zeta,)
        The nodes.
    values : ndarray, shape (n_zeta, ..., fields)
        Forms of the fields; NaN where there is no film.
    stated : ndarray, shape (n_zeta, ..., errors)
        Errors that the solver states.
    """
    count = len(FIELDS)
    lines, errors = (x.reshape(zeta.size, -1, x.shape[-1]).copy() for x in (values, stated))
    good = np.isfinite(lines) & ((errors[..., :count] <= RESOLVED) | _AS_STATED)
    good[zeta < HEAVY] = True  # what is missing there stays a hole
    last = np.sum(np.logical_and.accumulate(good, axis=0), axis=0) - 1
    rates = _rates(zeta, lines, last)
    growth = np.zeros_like(errors)
    moved = np.zeros(lines.shape[:2], dtype=bool)
    for line, ends in enumerate(last):
        known, wrong = lines[:, line].copy(), errors[:, line].copy()
        for field, end in enumerate(ends):
            beyond = slice(end + 1, None)
            apart = zeta[beyond] - zeta[end]
            lines[beyond, line, field] = known[end, field] + _slope(zeta, known, ends, field, end) * apart
            errors[beyond, line, field] = wrong[end, field]
            growth[beyond, line, field] = rates[field] * apart
            if not _AS_STATED[field]:
                moved[beyond, line] = True
        errors[ends[_OFFSET] + 1 :, line, count:] = wrong[ends[_OFFSET], count:]
    return Continued(
        lines.reshape(values.shape),
        errors.reshape(stated.shape),
        growth.reshape(stated.shape),
        moved.reshape(values.shape[:-1]),
        rates,
    )


def _slope(zeta: FloatArray, line: FloatArray, ends: IndexArray, field: int, end: int) -> float:
    """Slope by zeta with which a number goes on from a node of a line."""
    if field in _STIFF:
        return 1.0 / 3.0
    if field not in (*_OWN, _DAMPING):
        return 0.0
    start = int(np.argmin(np.abs(zeta[:end] - zeta[end] + SPAN)))
    own = float((line[end, field] - line[start, field]) / (zeta[end] - zeta[start]))
    if field != _DAMPING:
        return own
    return 0.5 * (own + _slope(zeta, line, ends, _OFFSET, min(end, int(ends[_OFFSET]))))


def _rates(zeta: FloatArray, lines: FloatArray, last: IndexArray) -> FloatArray:
    """Differences of lines that were cut and continued from what was solved, a unit of zeta, (fields,)."""
    found: list[list[float]] = [[] for _ in FIELDS]
    # as heavy as where the first line is lost
    lost = np.where(_AS_STATED, HEAVY, np.maximum(zeta[last.min(axis=0)] - SPAN, HEAVY))
    first = np.searchsorted(zeta, lost)
    for line, ends in enumerate(last):
        held = lines[:, line]
        for field, end in enumerate(ends):
            for cut in range(int(first[field]), end):
                apart = zeta[cut + 1 : end + 1] - zeta[cut]
                wrong = held[cut + 1 : end + 1, field] - held[cut, field]
                wrong = np.abs(wrong - _slope(zeta, held, ends, field, cut) * apart) / apart
                found[field] += wrong[np.isfinite(wrong)].tolist()
    return np.array([np.percentile(each, COVERED) if each else np.inf for each in found])

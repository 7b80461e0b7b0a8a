"""A small table of a contact law in one file of C, for programs in real time.

The grid of `ehdmaps.exports.resampled`, with few nodes, between which cubics are read: 140 kB of numbers, no state, the
same time for each call. It has films of slow motion; outside the map it refuses.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError
from ehdmaps.exports.c.text import array, comment, define, renamed, template
from ehdmaps.exports.resampled import QUANTITIES, Grid, Resampled, differences, resampled
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.kernels.tables import COLDEST
from ehdmaps.outputs import Kind, Output, check_outputs, has_mark, write_text

KIND = Kind("a small table of ehdmaps", (".c",), has_mark)

GRID = Grid((60, 12, 8), (16, 10))
"""Nodes of the table, and of the alignment."""

_DIGITS, _ALIGNED = 4, 7
"""Digits behind the point of logarithms, and digits of what aligns them."""


class Small(Resampled):
    """A contact law on a grid between whose nodes cubics are read, as `small.c` does."""

    @property
    def zero(self) -> int:
        """Node of the bottom of the damping valley."""
        return int(np.argmin(np.abs(self.axes[0])))

    def at(self, approach: FloatArray, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Read load, stiffness and damping.

        Parameters
        ----------
        approach, speed, temperature : array, shape (n,)
            [m], [m/s], [K]; speed and temperature within the map.

        Returns
        -------
        array, shape (3, n)
            [N/m], [N/m2], [N s/m2]; NaN above the highest load.
        """
        where = (np.log(np.abs(speed)), -1.0 / (temperature - COLDEST))
        offset, scale, top = _cubic(self.alignment, [_about(*one) for one in zip(self.fine_axes, where, strict=True)])
        s = np.arcsinh((approach - offset) / scale)
        p = np.maximum(s / np.where(s > 0.0, top, self.bottom), -1.0)
        others = [_about(*one) for one in zip(self.axes[1:], where, strict=True)]
        values, (places, _, _) = np.full((3, p.size), np.nan), self.axes
        for part, first, last in ((p < 0.0, 0, self.zero), ((p >= 0.0) & (p <= 1.0), self.zero, places.size - 1)):
            along = _about(places[first : last + 1], p[part])
            here = [(along[0] + first, along[1]), *((start[part], weight[:, part]) for start, weight in others)]
            values[:, part] = np.exp(_cubic(self.logarithms, here))
        return values


def _about(axis: FloatArray, at: FloatArray) -> tuple[IntArray, FloatArray]:
    """First nodes of the cubics about places, shape (n,), and their weights, shape (4 or fewer, n)."""
    count = min(axis.size, 4)
    first = np.clip(np.searchsorted(axis, at, side="right") - 2, 0, axis.size - count)
    nodes = axis[first + np.arange(count)[:, None]]
    weights = np.ones((count, at.size))
    for a in range(count):
        for b in set(range(count)) - {a}:
            weights[a] *= (at - nodes[b]) / (nodes[a] - nodes[b])
    return first, weights


def _cubic(tables: FloatArray, places: list[tuple[IntArray, FloatArray]]) -> FloatArray:
    """Tables, whose first axis is theirs, at places, shape (tables, n)."""
    total = np.zeros((len(tables), places[0][0].size))
    for nodes in np.ndindex(*(len(weights) for _, weights in places)):
        share = np.prod([weights[node] for node, (_, weights) in zip(nodes, places, strict=True)], axis=0)
        at = tuple(first + node for node, (first, _) in zip(nodes, places, strict=True))
        total += share * tables[(slice(None), *at)]
    return total


def _faded(table: Small, lowest: float) -> FloatArray:
    """Logarithms that go on straight below a small part of the lowest load [N/m], in place of those of zeros."""
    logarithms, places = table.logarithms.copy(), table.axes[0]
    first = np.argmax(logarithms[0] > np.log(lowest) - _FADING, axis=0)
    for at in np.ndindex(first.shape):
        k, rows = int(first[at]), logarithms[(slice(None), slice(None), *at)]
        slope = (rows[:, k + 1] - rows[:, k]) / (places[k + 1] - places[k])
        rows[:, :k] = rows[:, k, None] + slope[:, None] * (places[:k] - places[k])
    return logarithms


_FADING = 3.0
"""Logarithm of the lowest load of the map over that below which a small table decays exponentially."""


def small_text(table: Small, header: Iterable[str], prefix: str) -> str:
    """Text of the file.

    Parameters
    ----------
    table : Small
        The law.
    header : iterable of str
        Lines that tell its origin, and how exact it is.
    prefix : str
        What all names begin with, in lower case.
    """
    axes = dict(zip(("p", "u", "t", "fine_u", "fine_t"), (*table.axes, *table.fine_axes), strict=True))
    sizes = zip(("NP", "NU", "NT", "FU", "FT"), axes.values(), strict=True)
    parts = [
        comment(header),
        *(define(f"EHD_{name}", axis.size, "nodes") for name, axis in sizes),
        define("EHD_ZERO", table.zero, "node of the bottom of the damping valley"),
        define("EHD_BOTTOM", table.bottom, "-s at the place -1"),
        define("EHD_COLDEST", COLDEST, "K"),
        *(array(f"ehd_{name}", axis) for name, axis in axes.items()),
        array("ehd_place", table.alignment),
        array("ehd_log", table.logarithms),
        template("ehdmaps.exports.c", "small.c"),
    ]
    return renamed("".join(parts), prefix)


def write_small(emap: EHDMap, path: Path, output: Path, header: Iterable[str], prefix: str, kind: str | None) -> str:
    """Write the small table of a map; return what is printed.

    Parameters
    ----------
    emap : EHDMap
        The map.
    path, output : Path
        File of the map, and the one that is written.
    header : iterable of str
        Lines that tell its origin.
    prefix : str
        What all names begin with.
    kind : str, optional
        Which contact; a roller between both raceways, or a bare line, if left out.
    """
    check_outputs([Output("-o", output, KIND)], [path])
    law = emap.law(kind or ("series" if emap.bearing is not None else "line"))  # type: ignore[arg-type]
    if not law.speed_range[1] > 0.0:
        raise InputError(f"-o: {output}: a map of standstill alone; allowed: one over speed; export it as csv")
    table = resampled(law, GRID, Small)
    short = np.vectorize(lambda value: float(f"{value:.{_ALIGNED}g}"))
    logarithms = np.round(_faded(table, law.load_range[0]), _DIGITS)
    table = replace(table, alignment=short(table.alignment), logarithms=logarithms)
    words = [
        f"{name}: median {100.0 * median:.2g} %, 95 % within {100.0 * usual:.2g} %, largest {100.0 * largest:.3g} %"
        for name, (median, usual, largest) in zip(QUANTITIES, differences(table, law).values(), strict=True)
    ]
    text = small_text(table, (*header, *_NOTES, "off the law of the map at 2000 places:", *words), prefix)
    write_text(output, text, KIND)
    return "\n".join([f"{output}: written, {len(text) / 1e3:.0f} kB; off the law of the map at 2000 places", *words])


_NOTES = (
    "int ehd_small(approach [m], rate [m/s], entrainment speed [m/s], temperature [K], result)",
    "result: load [N/m], stiffness [N/m2] and damping [N s/m2] at rest, films of slow motion, per length of contact",
    "returns 0; 1 and NaN outside the map, and below its lowest speed",
)

"""Reach of contact laws: the loads, at each speed and temperature, between which the points of a map are known.

A point without a solution ends the loads there, at its own speed and temperature, as the axis of the map ends them
elsewhere: what lies beyond is outside the map, and the policies of a law act. Of a line of loads that misses some in
the middle the longer part is kept. Between speeds and temperatures of the map the ends are straight in ln of load and
speed, and in temperature, as the films are that a law reads there. A speed or a temperature at which some line has
fewer than two known loads is left out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import BoolArray, FloatArray, IndexArray
from ehdmaps.maps.kernels.ends import ends_at, one_end
from ehdmaps.units import LOAD, SPEED, TEMPERATURE, span

Axes = tuple[FloatArray, FloatArray, FloatArray]
"""Loads [N/m], entrainment speeds [m/s] and temperatures [K] of a map."""

_Scalar = TypeVar("_Scalar", np.bool_, np.float64)

_SHOWN = 6
"""Places that are named for each load at which loads end early."""


@dataclass(frozen=True, eq=False)
class Reach:
    """Loads, speeds and temperatures at which the films of a law are known.

    Attributes
    ----------
    axes : tuple of array
        Loads [N/m], entrainment speeds [m/s] and temperatures [K] of the map.
    rows, columns : array (n_u,), (n_T,)
        Places of the speeds, all above zero, and temperatures that are read.
    first, last : array (n_u, n_T)
        Lowest and highest known load there [N/m].
    """

    axes: Axes
    rows: IndexArray
    columns: IndexArray
    first: FloatArray
    last: FloatArray

    @property
    def _heights(self) -> slice:
        """Places of the loads that are read."""
        low, high = np.searchsorted(self.axes[0], self.load_range)
        return slice(int(low), int(high) + 1)

    @property
    def loads(self) -> FloatArray:
        """Loads that are read [N/m], at some speed and temperature."""
        return self.axes[0][self._heights]

    @property
    def speeds(self) -> FloatArray:
        """Speeds that are read [m/s]."""
        return self.axes[1][self.rows]

    @property
    def temperatures(self) -> FloatArray:
        """Temperatures that are read [K]."""
        return self.axes[2][self.columns]

    @property
    def whole(self) -> bool:
        """True where all of the map is known."""
        loads, speeds, temperatures = self.axes
        every = self.rows.size == np.count_nonzero(speeds > 0.0) and self.columns.size == temperatures.size
        return every and bool(np.all(self.first == loads[0]) and np.all(self.last == loads[-1]))

    def part(self, values: npt.NDArray[_Scalar]) -> npt.NDArray[_Scalar]:
        """Values at the loads, speeds and temperatures that are read.

        Parameters
        ----------
        values : array (..., loads, speeds, temperatures)
            A variable of the map.
        """
        return np.ascontiguousarray(values[..., self._heights, :, :][..., self.rows, :][..., self.columns])

    @property
    def load_range(self) -> tuple[float, float]:
        """Lowest and highest load that is known at some speed and temperature [N/m]; those of a map at a standstill."""
        if not self.rows.size:
            return float(self.axes[0][0]), float(self.axes[0][-1])
        return float(np.min(self.first)), float(np.max(self.last))

    def first_loads(self, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """Lowest known load [N/m], (n_u, n_T), at speeds [m/s], > 0, and temperatures [K]; held at the edges.

        Parameters
        ----------
        speeds, temperatures : array (n_u,), (n_T,)
            u [m/s], > 0, and T [K].
        """
        return ends_at(self._ends(self.first), speeds, temperatures)

    @property
    def ends(self) -> FloatArray:
        """Highest known loads, as of `ehdmaps.maps.kernels.ends`."""
        return self._ends(self.last)

    def _ends(self, loads: FloatArray) -> FloatArray:
        """Loads with their speeds and temperatures."""
        if np.all(loads == loads[0, 0]):
            return one_end(float(loads[0, 0]))
        axis = np.concatenate(([0.0], np.log(self.speeds)))[:, None]
        return np.hstack((axis, np.vstack((self.temperatures, loads))))

    def loads_at(self, speed: float, temperature: float) -> tuple[float, float]:
        """Lowest and highest known load at one speed and temperature [N/m]; those of the map at a standstill.

        Parameters
        ----------
        speed, temperature : float
            u [m/s], >= 0, and T [K].
        """
        if speed == 0.0:
            return float(self.axes[0][0]), float(self.axes[0][-1])
        at = np.array([speed]), np.array([temperature])
        return float(self.first_loads(*at)[0, 0]), float(ends_at(self.ends, *at)[0, 0])

    @property
    def text(self) -> str:
        """In words, such as '0.1 to 1000 N/mm, 0.05 to 10 m/s, 20 to 120 degC; up to 72 N/mm at 10 m/s and 20 degC'."""
        return "; ".join(self.parts)

    @property
    def parts(self) -> tuple[str, ...]:
        """Parts of `text`: the ranges, places of the map where loads end early or begin late, and what is left out."""
        speeds = self.speeds if self.rows.size else np.zeros(1)
        axes = (np.array(self.load_range), LOAD), (speeds, SPEED), (self.temperatures, TEMPERATURE)
        parts = [", ".join(span(values, display) for values, display in axes)]
        parts += self._early(self.last, self.load_range[1], "up to")
        parts += self._early(self.first, self.load_range[0], "from")
        moving = np.flatnonzero(self.axes[1] > 0.0)
        for axis, at, kept, display in (
            (self.axes[1], moving, self.rows, SPEED),
            (self.axes[2], np.arange(self.axes[2].size), self.columns, TEMPERATURE),
        ):
            values = axis[np.setdiff1d(at, kept)]
            if values.size:
                parts.append(f"without {', '.join(display.text(float(value)) for value in values)}")
        return tuple(parts)

    def _early(self, ends: FloatArray, usual: float, word: str) -> list[str]:
        """Places where the loads end early, or begin late: for each load those where it does, the worst load first."""
        parts = []
        loads = np.unique(ends[ends != usual])
        for load in sorted(loads.tolist(), key=lambda one: -abs(float(np.log(one / usual)))):
            places = [
                f"{span(self.speeds[rows], SPEED)} and {TEMPERATURE.text(float(kelvin))}"
                for k, kelvin in enumerate(self.temperatures)
                for rows in _neighbours(np.flatnonzero(ends[:, k] == load))
                if rows.size
            ]
            more = f" and {len(places) - _SHOWN} more places" if len(places) > _SHOWN else ""
            parts.append(f"{word} {LOAD.text(load)} at {', '.join(places[:_SHOWN])}{more}")
        return parts


def whole_reach(axes: Axes) -> Reach:
    """Reach of a map of which all is known.

    Parameters
    ----------
    axes : tuple of array
        Axes of the map; only speeds above zero are read.
    """
    rows, columns = np.flatnonzero(axes[1] > 0.0), np.arange(axes[2].size)
    first, last = (np.full((rows.size, columns.size), float(end)) for end in (axes[0][0], axes[0][-1]))
    return Reach(axes, rows, columns, first, last)


def known_runs(known: BoolArray) -> BoolArray:
    """Longest run of known points along the loads of each line; of equal ones that of lower loads.

    Parameters
    ----------
    known : array (n_contacts, n_w, n_u, n_T)
        Which points are known.
    """
    runs = np.zeros_like(known)
    for place in np.ndindex(known.shape[0], *known.shape[2:]):
        line = np.concatenate(([0], known[place[0], :, *place[1:]].astype(np.int8), [0]))
        begins, ends = np.flatnonzero(np.diff(line) == 1), np.flatnonzero(np.diff(line) == -1)
        if begins.size:
            i = int(np.argmax(ends - begins))
            runs[place[0], begins[i] : ends[i], *place[1:]] = True
    return runs


def reach_of(runs: BoolArray, axes: Axes) -> Reach | None:
    """Reach of a law that needs all of some contacts; None where there is none. A map of a standstill alone is known.

    Parameters
    ----------
    runs : array (n_contacts, n_w, n_u, n_T)
        Known points, one run on each line, as of `known_runs`.
    axes : tuple of array
        Axes of the map.
    """
    loads, moving = axes[0], np.flatnonzero(axes[1] > 0.0)
    if not moving.size:  # a dry contact, of which all is known
        return whole_reach(axes)
    both: BoolArray = np.logical_and.reduce(runs[:, :, moving])
    first = loads[np.argmax(both, axis=0)]
    last = loads[loads.size - 1 - np.argmax(both[::-1], axis=0)]
    enough = np.count_nonzero(both, axis=0) >= min(2, loads.size)
    while True:
        rows, columns = _kept(enough)
        if not rows.size or not columns.size:
            return None
        at = np.ix_(rows, columns)
        if loads.size == 1 or np.max(first[at]) < np.min(last[at]):
            return Reach(axes, moving[rows], columns, first[at], last[at])
        # all lines of a law have some loads in common
        i, j = np.unravel_index(int(np.argmin(last[at])), last[at].shape)
        enough[rows[i], columns[j]] = False


def continued_lines(logs: FloatArray, log_loads: FloatArray) -> FloatArray:
    """Lines over the loads with what is not known of them: straight beyond one known stretch, (n_w, lines).

    Parameters
    ----------
    logs : array (n_w, lines)
        Logarithms of a variable; NaN where it is not known, which is at one load or more on each line.
    log_loads : array (n_w,)
        Logarithms of the loads.
    """
    found = logs.copy()
    for column in np.flatnonzero(~np.isfinite(logs).all(axis=0)):
        known = np.flatnonzero(np.isfinite(logs[:, column]))
        places, line = log_loads[known], logs[known, column]
        held = np.clip(log_loads, places[0], places[-1])
        slopes = np.gradient(line, places) if known.size > 1 else np.zeros(1)
        found[:, column] = np.interp(held, places, line) + np.interp(held, places, slopes) * (log_loads - held)
    return found


def _kept(enough: BoolArray) -> tuple[IndexArray, IndexArray]:
    """Rows and columns without a place that is not enough, the one with most such places left out first."""
    rows, columns = np.arange(enough.shape[0]), np.arange(enough.shape[1])
    while rows.size and columns.size and not np.all(enough[np.ix_(rows, columns)]):
        lacking = ~enough[np.ix_(rows, columns)]
        of_row, of_column = lacking.mean(axis=1), lacking.mean(axis=0)
        # of equal shares the shorter line goes
        if (np.max(of_row), -columns.size) >= (np.max(of_column), -rows.size):
            rows = np.delete(rows, int(np.argmax(of_row)))
        else:
            columns = np.delete(columns, int(np.argmax(of_column)))
    return rows, columns


def _neighbours(places: IndexArray) -> Iterator[IndexArray]:
    """Yield places that follow one another together."""
    yield from np.split(places, np.flatnonzero(np.diff(places) > 1) + 1)

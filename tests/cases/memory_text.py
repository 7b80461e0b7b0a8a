"""Films with memory as a scalar text: what `ehdmaps/kernel/c/film/film.c` is compared with at random places."""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.maps.kernels.memory_table import LOAD_ROWS, ROWS, MemoryTable


def cell_of(a: float, rows: int) -> tuple[int, float]:
    """Cell of a number a >= 1, 32 to each doubling, and what a is above its lower end."""
    octaves = rows // 32
    held = min(a, math.nextafter(2.0**octaves, 0.0))
    octave = math.frexp(held)[1] - 1
    part = int((held / 2.0**octave - 1.0) * 32.0)
    return 32 * octave + part, held - 2.0**octave * (1.0 + part / 32.0)


def cubic(c: np.ndarray, t: float) -> tuple[float, float]:
    """Value and slope of a cubic."""
    return float(c[0] + t * (c[1] + t * (c[2] + t * c[3]))), float(c[1] + t * (2.0 * c[2] + 3.0 * t * c[3]))


class Cells:
    """The cells of a table.

    Parameters
    ----------
    table : MemoryTable
        The table.
    """

    def __init__(self, table: MemoryTable) -> None:
        self.table, self.cells, self.load_cells = table, table.cells, table.load_cells

    def equilibrium(self, xi: float) -> tuple[float, ...]:
        """p, y and G at a state, each with its slope."""
        per = self.table.inverse_scale
        z = (xi - self.table.centre) * per
        row, above = cell_of(1.0 + abs(z), ROWS)
        c, t = self.cells[row if z >= 0.0 else row + ROWS], above if z >= 0.0 else -above
        found: list[float] = []
        for first in (0, 4, 8):
            value, slope = cubic(c[first : first + 4], t)
            found += [value, slope * per]
        return tuple(found)

    def stretch(self, load: float) -> tuple[float, float]:
        """a of a load, and its slope."""
        row, t = cell_of(1.0 + load, LOAD_ROWS)
        return cubic(self.load_cells[row], t)

    def advanced(
        self, h: float, last_h: float, delta: float, before: float, last: float, start: float
    ) -> tuple[float, float, float]:
        """Load, its slope and the state at the end of a step, by bisection.

        Parameters
        ----------
        h, last_h : float
            Length of the step and of the last one [s].
        delta : float
            Approach at its end [m].
        before, last : float
            G at its beginning, and its change over the last step [N s/m2].
        start : float
            State at its beginning [m].
        """
        low = self.table.lift_off
        high = max(delta, start, low)
        high += high - low
        for _ in range(80):
            xi = 0.5 * (low + high)
            short = self._end(h, last_h, delta, before, last, xi)[2]
            low, high = (xi, high) if short > 0.0 else (low, xi)
        w, tangent, _ = self._end(h, last_h, delta, before, last, xi)
        return w, tangent, xi

    def _end(
        self, h: float, last_h: float, delta: float, before: float, last: float, xi: float
    ) -> tuple[float, float, float]:
        """Load, tangent, and what is left of the approach, at a state."""
        p, dp, y, dy, g, dg = self.equilibrium(xi)
        ahead, back = 1.0, 0.0
        if last_h > 0.0 and h <= 1.2 * last_h:
            r = h / last_h
            ahead, back = (1.0 + 2.0 * r) / (1.0 + r), r * r / (1.0 + r)
        change = g - before
        t = min(1.5 * abs(change) / (abs(last) + 1e-30), 1.0)
        x = (ahead * change - back * last * t * t * (3.0 - 2.0 * t)) / h
        sign = 1.0 if change * last >= 0.0 else -1.0
        dx = (ahead - back * sign * 9.0 * t * (1.0 - t)) / h * dg
        root = math.sqrt(x * x + p * p + 1e-60)
        w = x + root if x >= 0.0 else p * p / (root - x)
        slope = (w * dx + p * dp) / root
        a, da = self.stretch(w)
        rise = da * slope + dy
        return w, slope / rise if slope > 0.0 and rise > 0.0 else 0.0, delta - a - y

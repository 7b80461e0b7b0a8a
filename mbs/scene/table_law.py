"""Contact law by points that a user has measured or computed: approach, line load and damping of a roller.

Between the points the curve is a monotone cubic (PCHIP: F. N. Fritsch and R. E. Carlson, SIAM Journal on Numerical
Analysis 17 (1980) 238). It is brought into the cells of `mbs.bearings.cylinder`, centred where the load begins, so that
compiled code reads it as it reads the table of a map. Cells are 3 % of their distance from the first point wide, but
not less than 4e-6 of the whole range: a bend of the curve that is sharper than a cell is rounded within it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.maps.kernels.tables import LOAD_TOLERANCE, nodes_of
from mbs.bearings.cylinder import CELLS, ROWS, LawNumbers
from mbs.bearings.laws import DryLaw, unilateral_forces

if TYPE_CHECKING:
    from ehdmaps.maps.law import OutsidePolicy

_LAST_NODE = ROWS - 32
"""The last point lies one doubling before the end of the cells, which go on straight from there."""

_A = nodes_of(ROWS)

_LIMITS = {
    "approach": ("m", -1.0, 1.0, 1e-15),
    "load": ("N/m", 0.0, 1e12, 1e-9),
    "damping": ("N s/m2", 0.0, 1e18, None),
}
"""Unit, smallest and largest value, and least rise from point to point: far beyond any roller, and products of these
numbers are still numbers."""


@dataclass(frozen=True, eq=False)
class TableLaw(DryLaw):
    """Load and damping of a roller by points; zero below the first point, held on the tangent above the last one.

    Attributes
    ----------
    name : str
        Name for messages and provenance.
    kind : {"series", "single"}
        A roller between both raceways, or one contact.
    approach : array (n,)
        Rising strictly [m].
    line_load : array (n,)
        Load per unit length of a roller [N/m]; 0 at the first point, then rising strictly.
    line_damping : array (n,)
        Damping per unit length of a roller [N s/m2], none negative.
    roller_length : float
        Length by which lines become rollers [m].
    outside : {"error", "clamp", "asymptote"}
        What happens above the last point, as for a map: an error, or the tangent, and calls there are counted.

    Raises
    ------
    InputError
        For points that are no such curve.
    """

    name: str
    kind: Literal["series", "single"]
    approach: FloatArray
    line_load: FloatArray
    line_damping: FloatArray
    roller_length: float
    outside: OutsidePolicy = "error"

    @property
    def highest_load(self) -> float:
        """Load per unit length of the last point [N/m]."""
        return float(self.line_load[-1])

    def __post_init__(self) -> None:
        if problems := curve_problems(self.approach, self.line_load, self.line_damping):
            raise InputError([f"law {self.name!r}, {line}" for line in problems])

    def single(self) -> TableLaw:
        """Law of one of the two contacts of the roller, which takes half of the approach at the same load."""
        if self.kind == "single":
            return self
        return self._stretched("single", 0.5)

    def series(self) -> TableLaw:
        """Law of a roller between two such contacts."""
        return self if self.kind == "series" else self._stretched("series", 2.0)

    def _stretched(self, kind: Literal["series", "single"], by: float) -> TableLaw:
        """The law whose approach is so many times as large at the same load."""
        return replace(self, kind=kind, approach=by * self.approach, line_damping=self.line_damping / by)

    @cached_property
    def _prepared(self) -> tuple[LawNumbers, FloatArray]:
        """Numbers and cells of the law per unit length."""
        from scipy.interpolate import PchipInterpolator  # laws by points alone need it

        first, last = float(self.approach[0]), float(self.approach[-1])
        inverse = (_A[_LAST_NODE] - 1.0) / (last - first)
        at = np.minimum(first + (_A - 1.0) / inverse, last)
        load, damping = (
            PchipInterpolator(self.approach, self.line_load),
            PchipInterpolator(self.approach, self.line_damping),
        )
        above = np.maximum(_A - _A[_LAST_NODE], 0.0)
        dw, dc = load.derivative()(at) / inverse, damping.derivative()(at) / inverse
        dw, dc[_LAST_NODE:] = np.maximum(dw, 0.0), 0.0
        w, c = load(at) + dw[-1] * above, np.maximum(damping(at), 0.0)
        h = np.diff(_A)
        # Slopes are bound as those of tables of maps, so that no cell falls or has negative damping.
        rise = 3.0 * np.diff(w) / h
        dw[:-1], dw[1:] = np.minimum(dw[:-1], rise), np.minimum(dw[1:], rise)
        dc[:-1], dc[1:] = np.maximum(dc[:-1], -3.0 * c[:-1] / h), np.minimum(dc[1:], 3.0 * c[1:] / h)
        cells = np.zeros((2 * ROWS, 4, 2))
        for f, value, slope in ((0, w, dw), (1, c, dc)):
            secant = np.diff(value) / h
            cells[:ROWS, 0, f], cells[:ROWS, 1, f] = value[:-1], slope[:-1]
            cells[:ROWS, 2, f] = (3.0 * secant - 2.0 * slope[:-1] - slope[1:]) / h
            cells[:ROWS, 3, f] = (slope[:-1] + slope[1:] - 2.0 * secant) / h**2
        numbers = LawNumbers(
            kind=CELLS, coefficient=0.0, exponent=0.0, damping=0.0, damping_time=0.0, centre=first,
            inverse_scale=inverse, highest=float(w[_LAST_NODE]) * (1.0 + LOAD_TOLERANCE), safe_approach=last,
            lift_off=first, slope=inverse, held_approach=last, held_load=float(w[_LAST_NODE]),
            held_stiffness=float(dw[_LAST_NODE]) * inverse, held_damping=float(c[_LAST_NODE]),
        )  # fmt: skip
        return numbers, cells

    def prepared(self, length: float) -> tuple[LawNumbers, FloatArray]:
        """Numbers and cells of the law per unit length; the length is that of the roller, which the points know."""
        return self._prepared

    def _at_rest(self, delta: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Load, damping and their slopes per unit length, from the cells that compiled code reads."""
        numbers, cells = self._prepared
        z = (delta - numbers.centre) * numbers.inverse_scale
        loaded, above = z > 0.0, np.maximum(delta - numbers.held_approach, 0.0)
        a = 1.0 + np.clip(z, 0.0, _A[_LAST_NODE] - 1.0)
        row = np.clip(np.searchsorted(_A, a, side="right") - 1, 0, _LAST_NODE - 1)
        t, cell = a - _A[row], cells[row]
        states = []
        for f in (0, 1):
            a0, a1, a2, a3 = (cell[..., k, f] for k in range(4))
            value, slope = a0 + t * (a1 + t * (a2 + t * a3)), a1 + t * (2.0 * a2 + 3.0 * t * a3)
            states += [np.where(loaded, value, 0.0), np.where(loaded, slope * numbers.inverse_scale, 0.0)]
        w, dw, c, dc = states
        held = above > 0.0
        dw = np.where(held, numbers.held_stiffness, dw)
        return w + numbers.held_stiffness * above, dw, c, np.where(held, 0.0, dc)

    def load(self, delta: npt.ArrayLike) -> FloatArray:
        """Load of the roller at rest [N] at the approach delta [m]."""
        return np.asarray(self._at_rest(np.asarray(delta, dtype=np.float64))[0] * self.roller_length)

    def evaluate(self, delta: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Load of the roller and its derivatives, as a `PowerLaw` gives them [N], [N/m], [N s/m]."""
        w, dw, c, dc = (self.roller_length * part for part in self._at_rest(delta))
        return unilateral_forces(w, dw, c, dc, rate)

    def is_above(self, delta: FloatArray) -> bool:
        """Tell whether an approach [m] lies above the last point."""
        return bool(np.max(delta, initial=-np.inf) > self.approach[-1])

    def energy(self, delta: FloatArray) -> FloatArray:
        """Energy of the roller at rest [J]: the exact integral of the cells over the approach."""
        numbers, cells = self._prepared
        h = np.diff(_A)[:_LAST_NODE]
        cell = cells[:_LAST_NODE, :, 0]

        def inside(part: FloatArray, t: FloatArray) -> FloatArray:
            terms = part[..., 0] + t * (part[..., 1] / 2.0 + t * (part[..., 2] / 3.0 + t * part[..., 3] / 4.0))
            return np.asarray(t * terms)

        sums = np.concatenate([[0.0], np.cumsum(inside(cell, h))])
        z = np.clip((delta - numbers.centre) * numbers.inverse_scale, 0.0, _A[_LAST_NODE] - 1.0)
        row = np.clip(np.searchsorted(_A, 1.0 + z, side="right") - 1, 0, _LAST_NODE - 1)
        whole = (sums[row] + inside(cell[row], 1.0 + z - _A[row])) / numbers.inverse_scale
        above = np.maximum(delta - numbers.held_approach, 0.0)
        beyond = above * (numbers.held_load + 0.5 * numbers.held_stiffness * above)
        return np.asarray((whole + beyond) * self.roller_length)


def curve_problems(approach: FloatArray, load: FloatArray, damping: FloatArray) -> list[str]:
    """List problems with the points of a law: each line says at which point, what was got and what is allowed.

    Parameters
    ----------
    approach, load, damping : array (n,)
        [m], [N/m], [N s/m2].
    """
    if approach.size < 2:
        return [f"points: got {approach.size}; allowed: two or more"]
    problems = []
    for (name, (unit, low, high, rise)), values in zip(_LIMITS.items(), (approach, load, damping), strict=True):
        wrong, allowed = ~((values >= low) & (values <= high)), f"{low:g} to {high:g} {unit}"
        if not wrong.any() and rise is not None:
            wrong = np.append(False, np.diff(values) < rise)
            allowed = f"at least {rise:g} {unit} more than at the point before"
        if wrong.any():
            at = int(np.argmax(wrong))
            problems.append(f"{name} at point {at + 1}: got {values[at]:.9g} {unit}; allowed: {allowed}")
    if not problems and load[0] != 0.0:
        problems.append(f"load at point 1: got {load[0]:.9g} N/m; allowed: 0, where the load begins")
    return problems

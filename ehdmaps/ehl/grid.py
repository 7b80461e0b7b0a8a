"""Nodes of one line contact by a smooth map from a uniform index, and the elastic deflection of half-spaces on them.

Nodes of one line contact: a smooth map from a uniform index, so that the scheme keeps its order on a graded grid.

x(s) is defined by its inverse s(x), a sum of asinh terms: uniform within the width of a term, logarithmic outside.
One term sits in the inlet, one at the exit, one over the Hertz zone, and, when its place is known, one at the pressure
spike, which is far narrower than anything else in the contact.

All lengths are in Hertz half-widths b. The grid is fixed to the exit of the film: x = X - X_exit <= 0, because the
exit is an unknown and the elastic kernel depends on differences only.

Elastic deflection of two half-spaces under a line pressure: the logarithmic kernel on a graded grid.

The gap grows by -(1/pi) Int P(S) ln|X - S| dS (lengths in b, pressures in p_H, gap in b^2/R). In the uniform index s of
the grid the integral is a trapezoidal sum; the singular node gets its own weight and a second-difference correction,
which makes the error O(ds^5) where P is smooth (Sidi & Israeli, J. Sci. Comput. 3 (1988) 201-231, with the
Euler-Maclaurin constant zeta'(-2)). Both ends of the sum need nothing: P and dP/dX vanish at the exit, and the inlet is
far away.

Points across a film, at which temperatures stand: Lobatto's, each with a cell as high as its weight. Integrals and
conduction are those of the polynomial through them, what oil carries from cell to cell is that of a parabola. The
temperature of the cell that it comes from would leave an error of first order where oil carries a thousand times the
heat that it conducts, as in the eddies of an inlet.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.ehl.limits import USUAL_SHAPE, GridShape

RIGID_EXIT_SQUARED = 0.226
"""X_exit^2/(2 H) of rigid surfaces and constant viscosity: c^2 with c = 0.475, the root of
Int_-inf^c (x^2 - c^2)/(1 + x^2)^3 dx = 0, which is Reynolds' condition in a parabolic gap."""

THIN_EXIT = 0.25
"""How far the exit of a thin film lies behind Hertz' edge, in H^(2/3). With M from 3 to 200 solutions have 0.1 to
0.45, the more the higher M and L are: it is a guess for the grid and for a cold start, since the exit is an unknown."""

INLET_SHIFT, EXIT_SHIFT = 0.3, 0.45
"""Centres of the finest cells, inside of the Hertz zone's edge and before the exit, in widths of those zones."""

BLUR = 0.1
"""Length over which the term of the Hertz zone is rounded at its ends, in the contact's own length."""

LEAST_INLET = 6.0
"""Inlet of a film without thickness [b]; `Resolution.inlet` comes to it."""


class Grid(NamedTuple):
    """Nodes and metric of one grid.

    Attributes
    ----------
    x : ndarray, shape (n + 1,)
        Node positions relative to the exit, increasing, x[-1] = 0 [b].
    step : ndarray, shape (n + 1,)
        dx/ds at the nodes, s counted in cells [b].
    face : ndarray, shape (n,)
        Positions half-way (in s) between the nodes [b].
    face_step : ndarray, shape (n,)
        dx/ds half-way between the nodes [b].
    """

    x: FloatArray
    step: FloatArray
    face: FloatArray
    face_step: FloatArray


@dataclass(frozen=True)
class Spike:
    """Position of the pressure spike relative to the exit, and the width within which cells are finest [b]."""

    position: float
    width: float


def thick_film_exit(film: float) -> float:
    """Exit coordinate X_exit of a film H [b^2/R]: near 1 for thin films, 0.475 sqrt(2H) for rigid surfaces."""
    thin = math.pow(film, 2 / 3)
    return math.sqrt(1.0 + RIGID_EXIT_SQUARED * 2.0 * film) + THIN_EXIT * thin / (1.0 + thin)


@dataclass(frozen=True)
class Layout:
    """The map s(x) of one contact; any number of cells can be laid on it.

    Attributes
    ----------
    film : float
        Film H for which it is laid [b^2/R].
    length : float
        Distance from the inlet end to the exit [b].
    inlet_edge, blur, core : float
        Start of the Hertz zone, length over which its term is rounded [b], and its weight.
    terms : ndarray, shape (3, k)
        Centres [b], widths [b] and weights of the asinh terms.
    starved : bool
        Whether the inlet ends at a meniscus, before which there is no film.
    """

    film: float
    length: float
    inlet_edge: float
    blur: float
    core: float
    terms: FloatArray
    starved: bool = False

    @property
    def span(self) -> float:
        """s(exit) - s(inlet end): how many e-folds of distance the grid has to resolve."""
        return float(_span(self.length, self.inlet_edge, self.blur, self.core, self.terms))

    def with_moved_spike(self, shift: float) -> Layout:
        """The same with its spike, the last term, shifted towards the exit [b]."""
        terms = self.terms.copy()
        terms[0, -1] += shift
        return replace(self, terms=terms)

    def grid(self, cells: int) -> Grid:
        """Nodes at equal steps of s."""
        return Grid(*_cells(cells, self.length, self.inlet_edge, self.blur, self.core, self.terms))


def lay_out(
    film: float,
    inlet_length: float,
    shape: GridShape = USUAL_SHAPE,
    spike: Spike | None = None,
    length: float | None = None,
) -> Layout:
    """Layout for a contact whose film is about `film`.

    Parameters
    ----------
    film : float
        Expected film H = h R/b^2; sets the widths of inlet and exit.
    inlet_length : float
        Length of the inlet in units of sqrt(2 H).
    shape, spike
        Weights of the terms, and the pressure spike if there is one.
    length : float, optional
        Distance from the meniscus of a starved contact to the exit [b], instead of the length of a flooded inlet.
    """
    film_length = math.sqrt(2.0 * film)
    zone = zone_width(film)
    # the pressure of a thick film rises over half of the film's length, that of a thin one at the edge of Hertz' zone
    edge = math.sqrt(1.0 + (0.5 * film_length) ** 2)
    inlet_edge = -(thick_film_exit(film) + edge)
    centres = [inlet_edge + INLET_SHIFT * zone, -EXIT_SHIFT * zone]
    widths = [shape.inlet_width * zone, shape.exit_width * zone]
    weights = [shape.inlet, shape.exit]
    if spike is not None:
        centres.append(spike.position)
        widths.append(spike.width)
        weights.append(shape.spike)
    return Layout(
        film=film,
        length=-inlet_edge + LEAST_INLET + inlet_length * film_length if length is None else length,
        inlet_edge=inlet_edge,
        blur=BLUR * math.sqrt(1.0 + film_length**2),
        core=shape.core / edge,
        terms=np.array([centres, widths, weights]),
        starved=length is not None,
    )


def zone_width(film: float) -> float:
    """Width of inlet and exit zones [b]: H^(2/3) for thin films, sqrt(2H) for thick ones."""
    thin = math.pow(film, 2 / 3)
    return thin / (1.0 + thin / math.sqrt(2.0 * film))


@njit
def _index(x: float, edge: float, blur: float, core: float, terms: FloatArray) -> tuple[float, float, float]:
    """The uniform index s at x, and its first and second derivative."""
    left = 1.0 / math.sqrt((x - edge) * (x - edge) + blur * blur)
    right = 1.0 / math.sqrt(x * x + blur * blur)
    index = core * (1.0 / left - 1.0 / right)
    slope = core * ((x - edge) * left - x * right)
    bend = core * blur * blur * (left * left * left - right * right * right)
    for k in range(terms.shape[1]):
        narrow = 1.0 / terms[1, k]
        ratio = (x - terms[0, k]) * narrow
        root = math.sqrt(1.0 + ratio * ratio)
        index += math.copysign(terms[2, k] * math.log(abs(ratio) + root), ratio)  # asinh, in a third of its time
        flat = narrow / root
        slope += terms[2, k] * flat
        bend -= terms[2, k] * flat * flat * ratio / root
    return index, slope, bend


@njit
def _nodes(
    count: int, length: float, edge: float, blur: float, core: float, terms: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Invert s(x) at equal steps, from the exit inwards: from the cubic through two nodes, by Halley in a bracket."""
    first, steep, _ = _index(-length, edge, blur, core, terms)
    last, slope, _ = _index(0.0, edge, blur, core, terms)
    spacing = (last - first) / count
    x = np.empty(count + 1)
    step = np.empty(count + 1)
    x[0], step[0] = -length, spacing / steep
    x[count], step[count] = 0.0, spacing / slope
    for i in range(count - 1, 0, -1):
        target = first + i * spacing
        low, high = -length, x[i + 1]
        trial = high - step[i + 1]
        if i + 2 <= count:
            trial = 5.0 * x[i + 2] - 2.0 * step[i + 2] - 4.0 * x[i + 1] - 4.0 * step[i + 1]
        if not low < trial < high:
            trial = 0.5 * (low + high)
        for _ in range(60):
            index, slope, bend = _index(trial, edge, blur, core, terms)
            if index > target:
                high = trial
            else:
                low = trial
            move = (target - index) / slope
            move -= 0.5 * bend / slope * move * move
            trial += move
            if not low <= trial <= high:
                trial = 0.5 * (low + high)
            elif abs(move) * slope < 2e-4 * spacing:  # what is left is its third power
                slope += bend * move
                break
        x[i] = trial
        step[i] = spacing / slope
    return x, step


@njit
def _span(length: float, edge: float, blur: float, core: float, terms: FloatArray) -> float:
    """s(exit) - s(inlet end)."""
    last: float = _index(0.0, edge, blur, core, terms)[0]
    return last - _index(-length, edge, blur, core, terms)[0]


@njit
def _cells(
    cells: int, length: float, edge: float, blur: float, core: float, terms: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """The fields of `Grid`: nodes at even half steps, faces at odd ones."""
    x, step = _nodes(2 * cells, length, edge, blur, core, terms)
    return x[::2].copy(), 2.0 * step[::2], x[1::2].copy(), 2.0 * step[1::2]


ZETA_PRIME_MINUS_TWO = -0.030448457058393270780
"""zeta'(-2) = -zeta(3)/(4 pi^2): weight of the second difference at the singular node."""

DRY_DATUM = -0.25 * (1.0 + 2.0 * math.log(2.0))
"""H0 of the dry Hertz contact for this kernel: H(X) = H0 + X^2/2 - (1/pi) Int P ln|X - S| dS vanishes for |X| <= 1."""


@njit(error_model="numpy", fastmath={"contract"})
def _take_logarithms(values: FloatArray, mantissa: FloatArray, power: FloatArray) -> None:
    """Put the natural logarithms of positive numbers in their place, to the last digit; a loop that runs on vectors.

    Method and coefficients are those of Sun's fdlibm, e_log.c: ln 2^k (1 + f) with s = f/(2 + f).

    The other two arrays, of the same length, are scratch.
    """
    bits, low, high = values.view(np.int64), mantissa.view(np.int64), power.view(np.int64)
    for i in range(bits.size):
        kept = (bits[i] + 0x00095F619980C433) & 0x7FF0000000000000  # from sqrt(2) on to the next power of two
        low[i] = bits[i] - kept + 0x3FF0000000000000
        high[i] = (kept >> 52) | 0x4330000000000000
    for i in range(values.size):
        f, k = mantissa[i] - 1.0, power[i] - 4503599627371519.0  # 2^52 + 1023
        s = f / (2.0 + f)
        z, half = s * s, 0.5 * f * f
        r = 0.1531383769920937332 + z * 0.1479819860511658591
        r = 0.2222219843214978396 + z * (0.1818357216161805012 + z * r)
        r = z * (0.6666666666666735130 + z * (0.3999999999940941908 + z * (0.2857142874366239149 + z * r)))
        values[i] = k * 6.93147180369123816490e-01 - ((half - (s * (half + r) + k * 1.90821492927058770002e-10)) - f)


@njit
def log_kernel(x: FloatArray, step: FloatArray) -> FloatArray:
    """Matrix K with (K P)_i = (1/pi) Int P ln|x_i - S| dS.

    Parameters
    ----------
    x, step : ndarray, shape (n,)
        Nodes and dx/ds [b].

    Returns
    -------
    ndarray, shape (n, n)
    """
    n = x.size
    kernel, row, scratch = np.empty((n, n)), np.empty(n), np.empty((2, n))
    weight = step / math.pi
    correction = ZETA_PRIME_MINUS_TWO
    for i in range(n):
        for j in range(i):
            row[j] = x[i] - x[j]
        _take_logarithms(row[:i], scratch[0, :i], scratch[1, :i])
        for j in range(i):
            kernel[i, j] = row[j] * weight[j]
            kernel[j, i] = row[j] * weight[i]
    for i in range(n):
        kernel[i, i] = (math.log(step[i] / (2.0 * math.pi)) - 2.0 * correction) * weight[i]
        if i > 0:
            kernel[i, i - 1] += correction * weight[i - 1]
        if i < n - 1:
            kernel[i, i + 1] += correction * weight[i + 1]
    return kernel


class Across(NamedTuple):
    """k points across a film, from the lower wall at 0 to the upper one at 1, each with a cell as high as its weight.

    Attributes
    ----------
    heights : ndarray, shape (k,)
        Places of the points.
    weights : ndarray, shape (k,)
        Heights of the cells, weights of the integral over the film.
    integral : ndarray, shape (k, k)
        Integrals from the lower wall to each point, of the polynomial through values at the points.
    conduction : ndarray, shape (k, k)
        Int v' T' dzeta of the polynomials through values at the points: each row is what one gives to the others.
    parabola : ndarray, shape (k,)
        6 zeta (1 - zeta), whose integral is one.
    rising, falling : ndarray, shape (k - 1, k)
        Value at the face above each point of what goes up or down with the oil: a parabola through three points, two
        of them where the oil comes from; at a wall through the three points next to it.
    """

    heights: FloatArray
    weights: FloatArray
    integral: FloatArray
    conduction: FloatArray
    parabola: FloatArray
    rising: FloatArray
    falling: FloatArray


ACROSS = 9
"""Points across the film with which a solution begins, both walls included; more are taken where heat asks for them."""


@lru_cache(maxsize=8)
def points_across(points: int) -> Across:
    """Lobatto's points, both walls included.

    Parameters
    ----------
    points : int
        Number k of points, >= 3.
    """
    legendre = np.polynomial.legendre
    x = _places(points)
    to_series = np.linalg.inv(legendre.legvander(x, points - 1))
    slope = 2.0 * legendre.legvander(x, points - 2) @ legendre.legder(to_series)
    integral = np.ascontiguousarray(0.5 * legendre.legvander(x, points) @ legendre.legint(to_series, lbnd=-1))
    heights, weights = 0.5 * (x + 1.0), integral[-1].copy()
    rising = _carried_up(heights, np.cumsum(weights)[:-1])
    return Across(
        heights,
        weights,
        integral,
        np.ascontiguousarray(slope.T @ (weights[:, None] * slope)),
        6.0 * heights * (1.0 - heights),
        rising,
        np.ascontiguousarray(rising[::-1, ::-1]),
    )


def _places(points: int) -> FloatArray:
    """Lobatto's points on -1 .. 1."""
    inner = np.polynomial.legendre.Legendre.basis(points - 1).deriv().roots().real
    return np.concatenate([[-1.0], np.sort(inner), [1.0]])


def _carried_up(heights: FloatArray, faces: FloatArray) -> FloatArray:
    """Value at the faces of cells of what rises with the oil: of a parabola through a point above and two below."""
    k = heights.size
    carried = np.zeros((k - 1, k))
    for j in range(k - 1):
        nodes = np.arange(3) + max(j - 1, 0)
        for i in nodes:
            others = nodes[nodes != i]
            carried[j, i] = np.prod((faces[j] - heights[others]) / (heights[i] - heights[others]))
    return carried


def moved_across(values: FloatArray, points: int) -> FloatArray:
    """Values at other points across of the polynomial through those at given ones.

    Parameters
    ----------
    values : ndarray, shape (n, k)
        Values at k points.
    points : int
        Number of the other points.
    """
    if values.shape[1] == points:
        return values
    legendre = np.polynomial.legendre
    k = values.shape[1]
    to_series = np.linalg.inv(legendre.legvander(_places(k), k - 1))
    return np.asarray(values @ (legendre.legvander(_places(points), k - 1) @ to_series).T)

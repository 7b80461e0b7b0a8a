"""The contact law on a grid that linear interpolation reads: for programs that have `interpn` and no cubic splines.

Three axes make its linear interpolation fine:

- The place p of the approach, from -1 (no load) over 0 (the bottom of the damping valley) to 1 (the highest load): of
  s = asinh((approach - offset)/scale) as the law has it, whose parts s < 0 and s > 0 are divided by their ends. Its
  nodes stand where the law bends.
- The logarithm of the entrainment speed.
- -1/(T - 170 K), in which the logarithm of an oil's viscosity is nearly straight.

Offset, scale and the end of s follow speed and temperature. They are read by linear interpolation, too, on a finer
grid: an error of the offset is one of the approach. Load, stiffness and damping are held as logarithms.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, TypeVar

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.kernels.tables import COLDEST, EDGE_TOLERANCE, LOAD_TOLERANCE
from ehdmaps.maps.law import ContactLaw

Quantity = Literal["load", "stiffness", "damping"]
QUANTITIES: tuple[Quantity, ...] = ("load", "stiffness", "damping")

READING = (
    "% approach [m], speed [m/s], temperature [K]: columns of one length; both signs of the speed are the same",
    "law = map.law;",
    "a = log(abs(speed));  b = -1 ./ (temperature - 170);",
    "at = @(table) interp2(law.fine_axis_temperature, law.fine_axis_speed, table, b, a);",
    "s = asinh((approach - at(law.offset)) ./ at(law.scale));",
    "p = s ./ ((s > 0) .* at(law.top) + (s <= 0) .* law.bottom);  p(p < -1) = -1;",
    "out = isnan(p);  p(out) = 2;  a(out) = 0;  b(out) = 0;  % outside: a place of NaN would not come to an end",
    "field = @(table) exp(interpn(law.axis_place, law.axis_speed, law.axis_temperature, table, p, a, b));",
    "w = field(law.log_load);  k = field(law.log_stiffness);  c = field(law.log_damping);",
)
"""How Octave and MATLAB read it: load [N/m], stiffness [N/m2] and damping [N s/m2] at rest; NaN outside the map.

`interpn` of Octave 7 does not return for a place that is NaN.
"""

_LEAST = 1e-300
"""What stands for zero under a logarithm."""

_SPEEDS, _FINE, _FINE_TEMPERATURES = 0.2, 1.25, 0.625
"""Nodes of the other axes for each of the approach: speeds and temperatures, and those of the finer grid."""

_TRIED, _TRIED_SPEEDS, _TRIED_TEMPERATURES = 2001, 8, 5
"""Nodes from which it is seen where the law bends."""

_EVENLY = 0.05
"""Share of the nodes that is spread evenly, for what bends elsewhere than where it was looked at."""

_FADED = 5.0
"""Logarithms that lie lower by more than this than those at the lowest load are not looked at: they end at zero."""

_CHECKED, _ALONG = 2000, 401
"""Places at which the errors are measured, and nodes from which the approach of a load is found there."""


@dataclass(frozen=True, eq=False)
class Resampled:
    """A contact law on a grid.

    Attributes
    ----------
    kind : str
        Which law it is, as of `ContactLaw`.
    axes : tuple of array
        Places p of the approach, ln of the speed, -1/(T - 170 K); rising.
    fine_axes : tuple of array
        ln of the speed and -1/(T - 170 K) of the alignment.
    alignment : array, shape (3, speeds, temperatures)
        Offset [m], scale [m] and end of s, on the fine axes.
    bottom : float
        -s at the place -1.
    logarithms : array, shape (3, places, speeds, temperatures)
        ln of load [N/m], stiffness [N/m2] and damping [N s/m2], at rest.
    """

    kind: str
    axes: tuple[FloatArray, FloatArray, FloatArray]
    fine_axes: tuple[FloatArray, FloatArray]
    alignment: FloatArray
    bottom: float
    logarithms: FloatArray

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of nodes along the axes."""
        return tuple(axis.size for axis in self.axes)

    def at(self, approach: FloatArray, speed: FloatArray, temperature: FloatArray) -> FloatArray:
        """Read load, stiffness and damping in the way of `READING`.

        Parameters
        ----------
        approach, speed, temperature : array, shape (n,)
            [m], [m/s], [K].

        Returns
        -------
        array, shape (3, n)
            [N/m], [N/m2], [N s/m2]; NaN outside the map.
        """
        where = (np.log(np.abs(speed)), _cold(temperature))
        offset, scale, top = (_linear(self.fine_axes, table, where) for table in self.alignment)
        s = np.arcsinh((approach - offset) / scale)
        p = np.maximum(s / np.where(s > 0.0, top, self.bottom), -1.0)
        return np.exp([_linear(self.axes, table, (p, *where)) for table in self.logarithms])


class Grid(NamedTuple):
    """Nodes along approach, speed and temperature, and those of the alignment along speed and temperature."""

    nodes: tuple[int, int, int]
    fine: tuple[int, int]

    @classmethod
    def of(cls, count: int) -> Grid:
        """Nodes in proportion to those along the approach, at least 20."""
        others = round(_SPEEDS * count)
        return cls((count, others, others), (round(_FINE * count), round(_FINE_TEMPERATURES * count)))


R = TypeVar("R", bound=Resampled)


def resampled(law: ContactLaw, grid: Grid, made: type[R]) -> R:
    """Resample a law.

    Parameters
    ----------
    law : ContactLaw
        The law, with the policy "error"; some speed of it is above zero.
    grid : Grid
        How many nodes.
    made : type
        `Resampled`, or a class of it that is read in another way.
    """
    bottom = -float(law.plain_table.own.start)
    axes = (_placed(law, bottom, grid.nodes[0]), *_axes(law, *grid.nodes[1:]))
    fine = _axes(law, *grid.fine)
    alignment = np.array([[_alignment(law, u, T) for T in _kelvins(fine[1])] for u in np.exp(fine[0]).tolist()])
    return made(law.kind, axes, fine, np.moveaxis(alignment, -1, 0), bottom, _logarithms(law, bottom, *axes))


def differences(table: Resampled, law: ContactLaw) -> dict[Quantity, FloatArray]:
    """Measure how far linear interpolation is from the law, at random places that are the same each time.

    They are spread evenly over the logarithms of load and speed and over temperature, within the map.

    Parameters
    ----------
    table : Resampled
        The grid.
    law : ContactLaw
        The law that it was made from.

    Returns
    -------
    dict of str to array, shape (3,)
        Relative differences of load, stiffness and damping: median, 95 % quantile, largest.
    """
    random = np.random.default_rng(1)
    along_speed, (cold, hot), low = table.axes[1], law.temperature_range, np.log(law.load_range[0])
    speeds = np.exp(random.uniform(along_speed[0], along_speed[-1], _CHECKED))
    kelvins, parts = random.uniform(cold, hot, _CHECKED), random.uniform(0.0, 1.0, _CHECKED)
    ends = np.log([law.known_load(u, T) for u, T in zip(speeds.tolist(), kelvins.tolist(), strict=True)])
    loads = low + (ends - low) * parts
    approaches, wanted = np.empty(_CHECKED), np.empty((3, _CHECKED))
    for place, (u, T, load) in enumerate(zip(speeds.tolist(), kelvins.tolist(), loads.tolist(), strict=True)):
        along = _approaches(law, table.bottom, u, T, np.linspace(-1.0, 1.0, _ALONG))
        at = law.at(u, T)
        values = np.log(np.maximum(at(along, 0.0)[0], _LEAST))
        approaches[place] = np.interp(load, values, along)
        wanted[:, place] = at(approaches[place], 0.0)
    read = table.at(approaches, speeds, kelvins)
    # where points of the map are missing, the end of the table cuts the corners of that of the law
    inside = np.isfinite(read).all(axis=0)
    read, wanted = read[:, inside], wanted[:, inside]
    # A damping that is zero everywhere is read as 1e-300: no difference.
    largest = np.max(wanted, axis=1, keepdims=True)
    apart = np.abs(read - wanted) / np.maximum(wanted, np.where(largest > 0.0, 1e-12 * largest, 1.0))
    return {
        name: np.append(np.quantile(values, [0.5, 0.95]), np.max(values))
        for name, values in zip(QUANTITIES, apart, strict=True)
    }


def struct(table: Resampled, apart: dict[Quantity, FloatArray]) -> dict[str, Any]:
    """Return the struct `map.law` of a MATLAB file as nested dictionaries.

    Parameters
    ----------
    table : Resampled
        The grid.
    apart : dict of str to array
        Differences from the law, see `differences`.
    """
    offset, scale, top = table.alignment
    fields = {
        "axis_place": table.axes[0][:, None],
        "axis_speed": table.axes[1][:, None],
        "axis_temperature": table.axes[2][:, None],
        "fine_axis_speed": table.fine_axes[0][:, None],
        "fine_axis_temperature": table.fine_axes[1][:, None],
        "offset": offset,
        "scale": scale,
        "top": top,
        "bottom": table.bottom,
        **{f"log_{name}": values for name, values in zip(QUANTITIES, table.logarithms, strict=True)},
    }
    return {
        "contact": table.kind,
        **fields,
        "error": {name: values[:, None] for name, values in apart.items()},
        "meaning": _MEANING,
        "reading": np.array(READING, dtype=object)[:, None],
    }


_MEANING = {
    "contact": "series: a roller between both raceways; line: a bare contact; all per unit length of contact",
    "axis_place": "place of the approach, from -1 (no load) to 1 (the highest load of the map)",
    "axis_speed": "log of the entrainment speed in m/s",
    "axis_temperature": "-1/(T - 170 K), T in K",
    "fine_axis_speed": "axis of offset, scale and top",
    "fine_axis_temperature": "axis of offset, scale and top",
    "offset": "m; s = asinh((approach - offset)/scale)",
    "scale": "m",
    "top": "s at the highest load; the place is s/top above zero",
    "bottom": "the place is s/bottom below zero",
    "log_load": "log of N/m; the load of the approach at rest, 1e-300 is zero",
    "log_stiffness": "log of N/m^2; d load/d approach",
    "log_damping": "log of N s/m^2; d load/d rate; films of slow motion",
    "error": "relative differences of linear interpolation from the law at 2000 random places: median, 95 %, largest",
    "reading": "lines for Octave and MATLAB; NaN outside the map, below its lowest speed, next to missing points",
}


def _linear(axes: Sequence[FloatArray], table: FloatArray, where: Sequence[FloatArray]) -> FloatArray:
    """Interpolate as `interp2` and `interpn` do; NaN outside."""
    read = RegularGridInterpolator(tuple(axes), table, bounds_error=False, fill_value=np.nan)
    return np.asarray(read(np.column_stack(where)), dtype=np.float64)


def _cold(temperature: FloatArray) -> FloatArray:
    """Return the axis of temperatures [1/K]."""
    return -1.0 / (temperature - COLDEST)


def _kelvins(cold: FloatArray) -> list[float]:
    """Return temperatures [K] of the axis."""
    kelvins: list[float] = (COLDEST - 1.0 / cold).tolist()
    return kelvins


def _axes(law: ContactLaw, speeds: int, temperatures: int) -> tuple[FloatArray, FloatArray]:
    """Nodes over speed and temperature, beyond the map by half of what the law lets pass; two for a single value."""
    table, (cold, hot) = law.plain_table, law.temperature_range
    low, high = max(law.speed_range[0], table.lowest_speed), law.speed_range[1]
    beyond = np.array([1.0 - 0.5 * EDGE_TOLERANCE, 1.0 + 0.5 * EDGE_TOLERANCE])
    (first, last), (begin, end) = np.log(beyond * [low, high]), _cold(beyond * [cold, hot])
    return (
        np.linspace(first, last, speeds if high > low else 2),
        np.linspace(begin, end, temperatures if hot > cold else 2),
    )


def _alignment(law: ContactLaw, speed: float, temperature: float) -> tuple[float, float, float]:
    """Offset, scale and end of s; that is above the highest load by half of what the law lets pass."""
    point = law.at(speed, temperature).point
    line, back = point.own, 0.5 * LOAD_TOLERANCE * point.highest_load / point.held_stiffness
    top = np.arcsinh((point.held_approach - back - line.offset) * line.inverse_scale)
    return float(line.offset), 1.0 / float(line.inverse_scale), float(top)


def _approaches(law: ContactLaw, bottom: float, speed: float, temperature: float, places: FloatArray) -> FloatArray:
    """Approaches [m] of places."""
    offset, scale, top = _alignment(law, speed, temperature)
    return offset + scale * np.sinh(places * np.where(places > 0.0, top, bottom))


def _logarithms(
    law: ContactLaw, bottom: float, places: FloatArray, log_speeds: FloatArray, colds: FloatArray
) -> FloatArray:
    """Logarithms of load, stiffness and damping on a grid."""
    values = np.empty((3, places.size, log_speeds.size, colds.size))
    for i, u in enumerate(np.exp(log_speeds).tolist()):
        for j, T in enumerate(_kelvins(colds)):
            values[:, :, i, j] = law.at(u, T)(_approaches(law, bottom, u, T, places), 0.0)
    return np.log(np.maximum(values, _LEAST))


def _placed(law: ContactLaw, bottom: float, count: int) -> FloatArray:
    """Places p, as dense as the root of the largest bend there; below the lowest load it counts less and less."""
    places = np.linspace(-1.0, 1.0, _TRIED)
    tried = _logarithms(law, bottom, places, *_axes(law, _TRIED_SPEEDS, _TRIED_TEMPERATURES))
    weight = np.minimum(np.exp(tried[0]) / law.load_range[0], 1.0)
    floor = np.min(np.where(weight < 1.0, np.inf, tried), axis=(1, 2, 3), keepdims=True)
    tried = np.maximum(tried, floor - _FADED)
    bend = np.zeros((3, *weight.shape))
    bend[:, 1:-1] = np.abs(np.diff(tried, n=2, axis=1))
    density = np.sqrt(np.max(bend * weight, axis=(0, 2, 3)))
    # The valley is not just where it was looked for.
    near = np.ones(_TRIED // 100)
    density = np.maximum(density, np.convolve(density, near / near.size, mode="same"))
    density += _EVENLY * max(float(density.mean()), _LEAST)
    reached = np.append(0.0, np.cumsum(0.5 * (density[1:] + density[:-1])))
    nodes = np.interp(np.linspace(0.0, reached[-1], count), reached, places)
    nodes[np.argmin(np.abs(nodes))] = 0.0
    return nodes

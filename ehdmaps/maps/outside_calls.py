"""Arguments of a law, and its points outside the map: counted over its calls, noted, refused where nothing is held."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError, OutsideMapError, Problems
from ehdmaps.maps.kernels.tables import EDGE_TOLERANCE, LOAD, LOAD_TOLERANCE, NOT_FINITE, SPEED, TEMPERATURE

Axis = Literal["load", "entrainment_speed", "temperature"]
Side = Literal["above", "below"]

UNITS = {"load": "N/m", "entrainment_speed": "m/s", "temperature": "K"}


@dataclass(frozen=True)
class Excursion:
    """Calls beyond one end of one axis of the map.

    Attributes
    ----------
    axis : {"load", "entrainment_speed", "temperature"}
    side : {"above", "below"}
        Speeds are never below: films of lower ones are part of the law. Loads are where the film there is a guess, see
        `ehdmaps.maps.film_field`.
    calls : int
        How many points.
    extreme : float
        The one farthest outside [N/m], [m/s], [K]; loads without the part of damping.
    limit : float
        End of the map on this axis.
    """

    axis: Axis
    side: Side
    calls: int
    extreme: float
    limit: float

    @property
    def text(self) -> str:
        """In words, such as 'load 1.2e+06 N/m above the map, which ends at 1e+06 N/m'."""
        unit, ends = UNITS[self.axis], "ends" if self.side == "above" else "begins"
        about = f"{self.extreme:.6g} {unit}"
        return f"{self.axis} {about} {self.side} the map, which {ends} at {self.limit:.6g} {unit}"

    def __add__(self, other: Excursion) -> Excursion:
        farther = other.extreme > self.extreme if self.side == "above" else other.extreme < self.extreme
        return replace(other if farther else self, calls=self.calls + other.calls)


@dataclass(frozen=True)
class Range:
    """Range that is known along an axis; `low` is -inf where nothing can be below."""

    axis: Axis
    low: float
    high: float

    def excursions(self, values: FloatArray) -> list[Excursion]:
        """Excursions of some values beyond the range."""
        tolerance = LOAD_TOLERANCE if self.axis == "load" else EDGE_TOLERANCE
        values = np.abs(values) if self.axis == "entrainment_speed" else values
        above = values[values > self.high * (1.0 + tolerance)]
        # no load at all is no question of films
        below = values[(values < self.low * (1.0 - tolerance)) & (values > 0.0)] if self.low > 0.0 else values[:0]
        found = []
        if above.size:
            found.append(Excursion(self.axis, "above", int(above.size), float(np.max(above)), self.high))
        if below.size:
            found.append(Excursion(self.axis, "below", int(below.size), float(np.min(below)), self.low))
        return found


def floats(**values: npt.ArrayLike) -> dict[str, FloatArray]:
    """Arrays of doubles by name.

    Raises
    ------
    InputError
        If one of them holds what is no number.
    """
    arrays = {}
    for name, value in values.items():
        try:
            arrays[name] = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError):
            raise InputError(f"contact law, {name}: got {value!r}; allowed: real numbers") from None
    return arrays


def broadcast(named: Mapping[str, FloatArray]) -> tuple[tuple[int, ...], list[FloatArray]]:
    """Common shape of arrays, and flat arrays of it that C takes: contiguous and writeable.

    Parameters
    ----------
    named : mapping of str to array
        Arrays of doubles by name, of any shapes that broadcast.

    Raises
    ------
    InputError
        If their shapes do not broadcast.
    """
    try:
        shape = np.broadcast_shapes(*(array.shape for array in named.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in named.items())
        raise InputError(f"contact law: got shapes that do not broadcast: {shapes}") from None
    flat = []
    for array in named.values():
        ready = array.shape == shape and array.flags.c_contiguous and array.flags.writeable
        full = array if ready else np.empty(shape)
        if not ready:
            full[...] = array
        flat.append(full.reshape(-1))
    return shape, flat


def check_finite(named: Mapping[str, FloatArray]) -> None:
    """Refuse values that are no finite numbers.

    Parameters
    ----------
    named : mapping of str to array
        Arrays of doubles by name.

    Raises
    ------
    InputError
        With every array that holds one.
    """
    problems = Problems(
        f"contact law, {name}: got {values[~np.isfinite(values)].flat[0]} "
        f"({np.count_nonzero(~np.isfinite(values))} of {values.size}); allowed: finite numbers"
        for name, values in named.items()
        if not np.all(np.isfinite(values))
    )
    problems.check()


_CAUSES: Mapping[Axis, int] = {"load": LOAD, "entrainment_speed": SPEED, "temperature": TEMPERATURE}


class OutsideCalls:
    """Record of the calls of a law outside its map so far.

    Parameters
    ----------
    kind : str
        Kind of the law, for messages.
    refused : bool
        Whether calls outside the map are errors.
    ends : mapping
        End of the map by axis: highest load [N/m] and speed [m/s], lowest and highest temperature [K]; -inf where
        nothing can be below.

    Attributes
    ----------
    counts : array (4,)
        Points by cause, as C counts them.
    """

    def __init__(self, kind: str, refused: bool, ends: Mapping[Axis, tuple[float, float]]) -> None:
        self._kind, self._refused, self._ends = kind, refused, ends
        self._ranges = {axis: Range(axis, *ends[axis]) for axis in get_args(Axis)}
        self._excursions: dict[tuple[str, str], Excursion] = {}
        self.counts: IntArray = np.zeros(4, dtype=np.int64)

    def emptied(self) -> OutsideCalls:
        """Another one of the same map that has counted nothing."""
        return OutsideCalls(self._kind, self._refused, self._ends)

    @property
    def by_cause(self) -> dict[str, int]:
        """Number of points that were outside, by axis."""
        return {axis: int(self.counts[index]) for axis, index in _CAUSES.items()}

    @property
    def excursions(self) -> tuple[Excursion, ...]:
        """Excursions outside, one for each axis and side."""
        return tuple(self._excursions[key] for key in sorted(self._excursions))

    def reset(self) -> None:
        """Start counting again from zero."""
        self.counts[:] = 0
        self._excursions.clear()

    def keep(self, excursions: Sequence[Excursion]) -> None:
        """Add up excursions."""
        for found in excursions:
            key = found.axis, found.side
            self._excursions[key] = self._excursions[key] + found if key in self._excursions else found

    def note(self, axis: Axis, values: FloatArray) -> list[Excursion]:
        """Keep what of some values lies outside the map, and return it.

        Parameters
        ----------
        axis : {"load", "entrainment_speed", "temperature"}
            Axis of the map.
        values : array (n,)
            [N/m], [m/s] or [K].
        """
        found = self._ranges[axis].excursions(values)
        self.keep(found)
        return found

    def settle(
        self,
        counts: IntArray,
        named: Mapping[str, FloatArray],
        flat: Sequence[FloatArray],
        loads_at_rest: Callable[[Sequence[FloatArray]], FloatArray],
        known_loads: Callable[[FloatArray, FloatArray], FloatArray],
    ) -> None:
        """Add up the counts of a call, and raise what they ask for.

        Nothing but the extremes is worked out here.

        Parameters
        ----------
        counts : array (4,)
            Points outside by cause, and those that are no numbers.
        named : mapping
            Arguments of the call by name.
        flat : sequence of array (n,)
            Approach, rate, speed, temperature and centrifugal load of each point; of no length where the call gave
            speed, temperature and centrifugal load only.
        loads_at_rest : callable
            Loads on the inner contact at rest [N/m], (n,), of such arrays.
        known_loads : callable
            Loads up to which films are known [N/m], (n,), at speeds and temperatures (n,).

        Raises
        ------
        InputError
            For arguments that are no finite numbers.
        OutsideMapError
            Outside the map, where that is refused.
        """
        if counts[NOT_FINITE]:
            check_finite(named)
        self.counts += counts
        if not np.any(counts[[LOAD, SPEED, TEMPERATURE]]):
            return
        problems = self._problems(counts, named, flat, loads_at_rest, known_loads)
        if self._refused:
            raise OutsideMapError(
                "\n".join(f"contact law {self._kind!r}, {problem}" for problem in problems)
                + "\nmake a map that reaches there, or take a law with outside='clamp' or outside='asymptote'"
            )

    def _problems(
        self,
        counts: IntArray,
        named: Mapping[str, FloatArray],
        flat: Sequence[FloatArray],
        loads_at_rest: Callable[[Sequence[FloatArray]], FloatArray],
        known_loads: Callable[[FloatArray, FloatArray], FloatArray],
    ) -> list[str]:
        """Note what was outside, and say it."""
        problems = []
        if counts[LOAD] and len(flat) < 5:
            at = (named[axis].reshape(-1) for axis in ("entrainment_speed", "temperature"))
            ends = f"{float(known_loads(*at)[0]):.6g} N/m"
            problems.append(f"load: got more than is mapped in the outer contact, above the map, which ends at {ends}")
        elif counts[LOAD]:
            problems.append(self._load_problem(int(counts[LOAD]), flat, loads_at_rest(flat), known_loads(*flat[2:4])))
        axes: tuple[Axis, ...] = "entrainment_speed", "temperature"
        for place, axis in enumerate(axes, start=2):
            if not counts[_CAUSES[axis]]:
                continue
            full = flat[place] if len(flat) == 5 else named[axis].reshape(-1)
            problems += [f"{axis}: got {one.text.removeprefix(axis).strip()}" for one in self.note(axis, full)]
        return problems

    def _load_problem(self, count: int, flat: Sequence[FloatArray], loads: FloatArray, known: FloatArray) -> str:
        """Note the loads that are too high, and say which."""
        for highest in np.unique(known):
            self.keep(Range("load", -np.inf, float(highest)).excursions((loads + flat[4])[known == highest]))
        worst = int(np.argmax(loads / known))
        return (
            f"load: got about {loads[worst]:.6g} N/m above the map, which ends at {known[worst]:.6g} N/m, "
            f"at the approach {flat[0][worst]:.6g} m, {flat[2][worst]:.6g} m/s, {flat[3][worst]:.6g} K "
            f"({count} of {flat[0].size} points above)"
        )

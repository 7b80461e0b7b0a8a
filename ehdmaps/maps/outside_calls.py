"""Points of a law outside its map, as they add up over its calls: counted, noted, and refused where nothing is held."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import get_args

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import OutsideMapError
from ehdmaps.maps.excursions import Axis, Excursion, Range
from ehdmaps.maps.law_arguments import check_finite
from ehdmaps.maps.tables import LOAD, NOT_FINITE, SPEED, TEMPERATURE

_CAUSES: Mapping[Axis, int] = {"load": LOAD, "entrainment_speed": SPEED, "temperature": TEMPERATURE}


class OutsideCalls:
    """What of the calls of a law was outside its map so far.

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
        Points by cause, as the compiled functions count them.
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
        """How many points were outside, by axis."""
        return {axis: int(self.counts[index]) for axis, index in _CAUSES.items()}

    @property
    def excursions(self) -> tuple[Excursion, ...]:
        """What was outside, one for each axis and side."""
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
        problems = self._problems(counts, named, flat, loads_at_rest)
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
    ) -> list[str]:
        """Note what was outside, and say it."""
        problems = []
        if counts[LOAD]:
            problems.append(self._load_problem(int(counts[LOAD]), flat, loads_at_rest))
        axes: tuple[Axis, ...] = "entrainment_speed", "temperature"
        for place, axis in enumerate(axes, start=2):
            if not counts[_CAUSES[axis]]:
                continue
            full = flat[place] if len(flat) == 5 else named[axis].reshape(-1)
            problems += [f"{axis}: got {one.text.removeprefix(axis).strip()}" for one in self.note(axis, full)]
        return problems

    def _load_problem(
        self, count: int, flat: Sequence[FloatArray], loads_at_rest: Callable[[Sequence[FloatArray]], FloatArray]
    ) -> str:
        """Note the loads that are too high, and say which."""
        highest = self._ranges["load"].high
        if len(flat) < 5:
            return f"load: got more than is mapped in the outer contact, above the map, which ends at {highest:.6g} N/m"
        loads = loads_at_rest(flat)
        self.note("load", loads + flat[4])
        worst = int(np.argmax(loads))
        return (
            f"load: got about {loads[worst]:.6g} N/m above the map, which ends at {highest:.6g} N/m, "
            f"at the approach {flat[0][worst]:.6g} m, {flat[2][worst]:.6g} m/s, {flat[3][worst]:.6g} K "
            f"({count} of {flat[0].size} points above)"
        )

"""An export in C as a library for Python: what compiles it, and what calls it."""

from __future__ import annotations

import ctypes
import subprocess
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from tests.cases.programs import needed

STRICT = ["-std=c99", "-O0", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Werror"]
"""Without optimisation, which takes four times as long: the library of the kernel, of the same files, has it."""

_D, _P = ctypes.c_double, ctypes.c_void_p
_ARGUMENTS = {
    "law": [_D] * 5 + [_P],
    "at": [_P, _D, _D, _D],
    "law_at": [_P, _D, _D, _P],
    "bearing_make": [_P, _D, ctypes.c_int, _P],
    "prepare": [_P, _D, _D, _D],
    "bearing_at": [_P, _P, _P, _P, _D, _P],
    "bearing_call": [_P, _P, _P, _P, _D, _D, _D, _D, _P],
    "film_at": [_P, _D, _D],
    "film_settled": [_P, _D, _P],
    "film_advance": [_P, _D, _D, _D, _P, _P, _P],
    "film_rate": [_P, _D, _D, _P],
    "bearing_settled": [_P, _P, _P, _D, _P],
    "bearing_advance": [_P, _P, _D, _D, _P, _D, _P, _P, _P],
    "bearing_rates": [_P, _P, _P, _D, _P, _P, _P],
}


def compiled(
    folder: Path,
    *more: str,
    compiler: str | Sequence[str] = "gcc",
    name: str = "libehd.so",
    link: bool = True,
) -> Path:
    """Compile a source of an export, with what else there is, into a file of the folder."""
    output = folder / name
    start = [needed(compiler)] if isinstance(compiler, str) else compiler
    result = subprocess.run(
        [*start, *STRICT, *more, str(folder / "ehd.c"), "-o", str(output), *(["-lm"] if link else [])],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert result.returncode == 0, result.stderr
    return output


class Kernel:
    """A law, and a bearing where there is one."""

    def __init__(self, library: Path) -> None:
        self._library = ctypes.CDLL(str(library))
        for name, arguments in _ARGUMENTS.items():
            if hasattr(self._library, f"ehd_{name}"):
                getattr(self._library, f"ehd_{name}").argtypes = arguments
        self._room = {}
        for name in ("point", "bearing", "prepared", "film"):
            if hasattr(self._library, f"ehd_{name}_size"):
                size = getattr(self._library, f"ehd_{name}_size")
                size.restype = ctypes.c_size_t
                self._room[name] = ctypes.create_string_buffer(size())

    def law(self, delta: float, rate: float, u: float, T: float, q: float = 0.0) -> tuple[int, FloatArray]:
        """Status, and load, stiffness, damping."""
        found = np.empty(3)
        return self._library.ehd_law(delta, rate, u, T, q, found.ctypes.data), found

    def at(self, u: float, T: float, q: float = 0.0) -> int:
        """Go to a speed, temperature and centrifugal load."""
        return int(self._library.ehd_at(self._room["point"], u, T, q))

    def law_at(self, delta: float, rate: float) -> tuple[int, FloatArray]:
        """Status, and load, stiffness, damping there."""
        found = np.empty(3)
        return self._library.ehd_law_at(self._room["point"], delta, rate, found.ctypes.data), found

    def make(self, clearance: float, slices: int, profile: FloatArray | None = None) -> int:
        """Cut the bearing into slices."""
        given = None if profile is None else np.ascontiguousarray(profile).ctypes.data
        return int(self._library.ehd_bearing_make(self._room["bearing"], clearance, slices, given))

    def deviate(self, added: FloatArray) -> None:
        """Add approaches to the rollers (Z, 2, 2), by the pointer at the end of the bearing; they are kept."""
        self.added = np.ascontiguousarray(added)
        room = self._room["bearing"]
        _P.from_buffer(room, len(room) - ctypes.sizeof(_P)).value = self.added.ctypes.data

    def prepare(self, u: float, T: float, q: float = 0.0) -> int:
        """Prepare the law for the bearing."""
        return int(self._library.ehd_prepare(self._room["prepared"], u, T, q))

    def force(self, pose: FloatArray, velocity: FloatArray, cage_angle: float) -> tuple[int, FloatArray]:
        """Status, and force, stiffness and damping in rows (13, 6)."""
        found, both = np.empty((13, 6)), np.ascontiguousarray([pose, velocity], dtype=np.float64)
        at = both[0].ctypes.data, both[1].ctypes.data
        return self._library.ehd_bearing_at(
            self._room["bearing"], self._room["prepared"], *at, cage_angle, found.ctypes.data
        ), found

    def call(self, pose: FloatArray, u: float, T: float) -> tuple[int, FloatArray]:
        """As `prepare` and `force` at rest."""
        found, given = np.empty((13, 6)), np.ascontiguousarray(pose, dtype=np.float64)
        return self._library.ehd_bearing_call(
            self._room["bearing"], self._room["prepared"], given.ctypes.data, None, 0.0, u, T, 0.0, found.ctypes.data
        ), found

    def film_at(self, u: float, T: float) -> int:
        """Go to a speed and temperature with films that have a memory."""
        return int(self._library.ehd_film_at(self._room["film"], u, T))

    def film_settled(self, delta: float) -> tuple[int, FloatArray]:
        """Status, and the state of a film in equilibrium: approach, change, load."""
        state = np.empty(3)
        return self._library.ehd_film_settled(self._room["film"], delta, state.ctypes.data), state

    def film_advance(
        self, state: FloatArray, delta: float, step: float, last: float
    ) -> tuple[int, FloatArray, FloatArray]:
        """Status, load and stiffness at the end of a step, and the state there."""
        found, after, before = np.empty(3), np.empty(3), np.ascontiguousarray(state)
        at = before.ctypes.data, after.ctypes.data, found.ctypes.data
        return self._library.ehd_film_advance(self._room["film"], step, last, delta, *at), found[:2], after

    def film_rate(self, delta: float, state: float) -> tuple[int, FloatArray]:
        """Status; load and its derivatives by approach and state, rate of the state and its derivatives."""
        found = np.empty(6)
        return self._library.ehd_film_rate(self._room["film"], delta, state, found.ctypes.data), found

    def settled(self, pose: FloatArray, cage_angle: float, slices: int) -> tuple[int, FloatArray]:
        """Status, and states of all films in equilibrium (n, 3)."""
        states, given = np.empty((slices, 3)), np.ascontiguousarray(pose, dtype=np.float64)
        room = self._room["bearing"], self._room["film"]
        return self._library.ehd_bearing_settled(*room, given.ctypes.data, cage_angle, states.ctypes.data), states

    def advance(
        self, states: FloatArray, pose: FloatArray, cage_angle: float, step: float, last: float
    ) -> tuple[int, FloatArray, FloatArray]:
        """Status, force and stiffness in rows (7, 6) at the end of a step, and the states there."""
        found, given, after = np.empty((13, 6)), np.ascontiguousarray(pose, dtype=np.float64), np.empty_like(states)
        before = np.ascontiguousarray(states)
        status = self._library.ehd_bearing_advance(
            self._room["bearing"], self._room["film"], step, last, given.ctypes.data, cage_angle,
            before.ctypes.data, after.ctypes.data, found.ctypes.data,
        )  # fmt: skip
        return status, found[:7], after

    def rates(self, pose: FloatArray, cage_angle: float, states: FloatArray) -> tuple[int, FloatArray, FloatArray]:
        """Status, force and stiffness in rows (7, 6) of an instant, and what `film_rate` has, for all films (n, 6)."""
        found, given, rates = (
            np.empty((13, 6)),
            np.ascontiguousarray(pose, dtype=np.float64),
            np.empty((states.size, 6)),
        )
        held = np.ascontiguousarray(states)
        status = self._library.ehd_bearing_rates(
            self._room["bearing"], self._room["film"], given.ctypes.data, cage_angle,
            held.ctypes.data, rates.ctypes.data, found.ctypes.data,
        )  # fmt: skip
        return status, found[:7], rates

"""A bearing of balls or tapered rollers in C as a library for Python: what compiles it, and what calls it."""

from __future__ import annotations

import ctypes
import subprocess
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray
from tests.cases.c_kernel import STRICT
from tests.cases.programs import needed

_D, _P = ctypes.c_double, ctypes.c_void_p
_ARGUMENTS = {
    "bearing_make": [_P, _D, ctypes.c_int],
    "prepare": [_P, _D],
    "bearing_at": [_P, _P, _P, _P, _P, _D, _D, _D, _P],
    "bearing_call": [_P, _P, _P, _P, _P, _D, _D, _D, _P],
}


def compiled_balls(source: Path) -> Path:
    """Compile a source with all warnings as errors, into a library beside it."""
    library = source.with_suffix(".so")
    command = [needed("gcc"), *STRICT, "-shared", "-fPIC", str(source), "-o", str(library), "-lm"]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    return library


class BallKernel:
    """A bearing, with the laws and the balls, or rollers, of its last call."""

    def __init__(self, library: Path, prefix: str, bodies: str = "balls") -> None:
        self._functions = {}
        loaded = ctypes.CDLL(str(library))
        for name, arguments in _ARGUMENTS.items():
            if bodies != "balls" and name == "bearing_at":
                continue
            self._functions[name] = getattr(loaded, f"{prefix}_{name}")
            self._functions[name].argtypes = arguments
        self._room = {}
        self._bodies = bodies
        for name in ("bearing", "law", bodies):
            size = getattr(loaded, f"{prefix}_{name}_size")
            size.restype = ctypes.c_size_t
            self._room[name] = ctypes.create_string_buffer(size())
        self.text = getattr(loaded, f"{prefix}_status_text")
        self.text.restype = ctypes.c_char_p

    def make(self, clearance: float, mirrored: bool = False) -> int:
        """Make the bearing, with balls that start from nothing."""
        ctypes.memset(self._room[self._bodies], 0, len(self._room[self._bodies]))
        return int(self._functions["bearing_make"](self._room["bearing"], clearance, int(mirrored)))

    def prepare(self, u: float) -> int:
        """Make the laws of an entrainment speed."""
        return int(self._functions["prepare"](self._room["law"], u))

    def at(
        self, pose: FloatArray, velocity: FloatArray, angle: float, cage: float, outer: float
    ) -> tuple[int, FloatArray]:
        """Status; force, K and C in rows (13, 6) at given speeds of cage and outer ring."""
        return self._asked("bearing_at", pose, velocity, angle, cage, outer)

    def call(
        self, pose: FloatArray, velocity: FloatArray, angle: float, inner: float, outer: float
    ) -> tuple[int, FloatArray]:
        """The same at speeds of the rings, with the cage that they ask for."""
        return self._asked("bearing_call", pose, velocity, angle, inner, outer)

    def _asked(self, name: str, pose: FloatArray, velocity: FloatArray, *numbers: float) -> tuple[int, FloatArray]:
        found, given = np.empty(79), np.ascontiguousarray([pose, velocity], dtype=np.float64)
        places = given[0].ctypes.data, given[1].ctypes.data
        room = [self._room[each] for each in ("bearing", "law", self._bodies)]
        status = self._functions[name](*room, *places, *numbers, found.ctypes.data)
        self.cage_speed = float(found[78])
        return int(status), found[:78].reshape(13, 6)

"""The linear part of a system for compiled runs: inverses for steps of some sizes, about the speeds of a run."""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from mbs.transient.run_arrays import Linear
from mbs.transient.stepping import Method

THIRD_ORDER = 1e-13
"""What the expansion of the inverse over the speed may leave out, as a part of it."""


class LinearPart:
    """The linear part in M-orthonormal modes.

    Parameters
    ----------
    eigenvalues : array, shape (n,)
        Diagonal of the stiffness by the modes [1/s2].
    damping, gyroscopic : array, shape (n, n)
        D and G by the modes [1/s], [1/rad].
    ports : array, shape (m, n)
        What the elements feel of the modes.
    physical : array, shape (n, n) or (0, n)
        Coordinates by the modes, where errors of steps are asked for.
    method : Method
        Method of the steps.
    alone : int
        How many ports at the beginning move only by their own forces.
    """

    def __init__(
        self,
        eigenvalues: FloatArray,
        damping: FloatArray,
        gyroscopic: FloatArray,
        ports: FloatArray,
        physical: FloatArray,
        method: Method,
        alone: int = 0,
    ) -> None:
        self._eigenvalues, self._damping, self._gyroscopic = eigenvalues, damping, gyroscopic
        self._ports, self._physical, self._method, self._alone = ports, physical, method, alone
        self._turning = bool(np.any(gyroscopic))
        self._made: dict[float, tuple[Linear, float]] = {}

    def about(self, h: float, speeds: FloatArray) -> tuple[Linear, int]:
        """The linear part for steps of length h [s] at the first of some speeds [rad/s], and for how many of them."""
        if h in self._made:
            linear, width = self._made[h]
            count = _leading(np.abs(speeds - linear.reference) <= width)
            if count:
                return linear, count
            low, high = np.minimum.accumulate(speeds), np.maximum.accumulate(speeds)
            # A little less than twice the width, for rounding.
            last = max(_leading(high - low <= 1.9 * width), 1) - 1
            reference = 0.5 * float(low[last] + high[last])
        else:
            reference = float(speeds[0])
        linear, width = self._make(h, reference)
        self._made[h] = linear, width
        return linear, max(_leading(np.abs(speeds - reference) <= width), 1)

    def _make(self, h: float, reference: float) -> tuple[Linear, float]:
        """The linear part about a speed, and how far from it the expansion is good.

        With L = L0 + (speed - reference) by_v G the inverse is L0^-1 - S L0^-1 + S^2 L0^-1 ..., S the relative change.
        """
        by_q, by_v = self._method.weights(h)
        damping = self._damping + reference * self._gyroscopic
        inverse = np.linalg.inv(np.diag(1.0 + by_q * self._eigenvalues) + by_v * damping)
        change = -by_v * inverse @ self._gyroscopic
        inverses = np.stack((inverse, change @ inverse, change @ change @ inverse))
        reach = np.ascontiguousarray(np.swapaxes(inverses @ self._ports.T, 1, 2))
        receptance = np.ascontiguousarray(self._ports @ np.swapaxes(reach, 1, 2))
        size = float(np.linalg.norm(change))
        linear = Linear(
            n=self._eigenvalues.size,
            m=self._ports.shape[0],
            coordinates=self._physical.shape[0],
            alone=self._alone,
            turning=self._turning,
            reference=reference,
            eigenvalues=self._eigenvalues,
            damping=damping,
            gyroscopic=self._gyroscopic,
            inverse=inverses,
            ports=self._ports,
            reach=reach,
            receptance=receptance,
            size=self._ports @ self._ports.T,
            physical=self._physical,
        )
        return linear, math.inf if size == 0.0 else THIRD_ORDER ** (1.0 / 3.0) / size


def _leading(marks: BoolArray) -> int:
    """Number of marks at the beginning that are set."""
    return marks.size if np.all(marks) else int(np.argmin(marks))

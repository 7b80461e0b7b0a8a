"""Stiffness that needs time: springs in series with dampers, beside the stiffness and damping of slow motion.

An element whose parts relax answers an oscillation e^(s t) of its ports with

    Z(s) = K + s C - sum_i v_i v_i' s^2 theta_i^2/(1 + s theta_i),

K and C of slow motion, which it keeps exactly at low frequency. Each part i is a damper of v v' theta, which belongs to
C, in series with a spring of v v': it moves slowly like the damper, and at high frequency like the spring. So the
element takes up energy at every frequency if C is at least the sum of v v' theta.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray

Films = Literal["slow", "memory"]
"""Whether films have stiffness and damping of slow motion at any frequency, or relax."""

NOTABLE = 0.05
"""Error of the dynamic stiffness of a bearing from which on it is told and shaded."""

DEFAULT_FILMS: Films = "memory"
"""Which films linear analyses have where none are asked for."""

FILM_WORDS: dict[Films, str] = {"memory": "films with memory", "slow": "slow films"}
"""How people are told that films relax, or that they have stiffness and damping of slow motion at any frequency."""


@dataclass(frozen=True, eq=False)
class Relaxation:
    """Springs in series with dampers, in the ports of an element or in the coordinates of a system.

    Attributes
    ----------
    rows : array, shape (r, m)
        v of each: root of its spring's stiffness times what it feels of the m displacements [(N/m)^0.5].
    times : array, shape (r,)
        theta of each [s], > 0.
    """

    rows: FloatArray
    times: FloatArray

    def more(self, s: ComplexArray) -> ComplexArray:
        """Term that is added to K + s C at complex frequencies s (k,) [1/s], shape (k, m, m)."""
        place = np.multiply.outer(s, self.times)
        return self._summed(np.asarray(-(place**2) / (1.0 + place), dtype=np.complex128))

    def more_of(self, s: ComplexArray, shapes: ComplexArray) -> ComplexArray:
        """`more` times a shape (m,) at each frequency s (k,), in columns: shapes (m, k), result (m, k)."""
        place = np.multiply.outer(self.times, s)
        return np.asarray(self.rows.T @ (-(place**2) / (1.0 + place) * (self.rows @ shapes)), dtype=np.complex128)

    def slope(self, s: ComplexArray) -> ComplexArray:
        """Derivative of `more` by s, shape (k, m, m)."""
        place = np.multiply.outer(s, self.times)
        weights = -self.times * place * (2.0 + place) / (1.0 + place) ** 2
        return self._summed(np.asarray(weights, dtype=np.complex128))

    @property
    def damping(self) -> FloatArray:
        """Part of C that the dampers have, shape (m, m)."""
        return np.asarray((self.rows.T * self.times) @ self.rows)

    def seen_by(self, transform: FloatArray) -> Relaxation:
        """The same, by the coordinates (n,) that move the displacements by a transform (m, n)."""
        return Relaxation(self.rows @ transform, self.times)

    def _summed(self, weights: ComplexArray) -> ComplexArray:
        """Sum of v v' with weights (k, r), shape (k, m, m)."""
        m = self.rows.shape[1]
        if weights.shape[0] < m:  # all products of rows are dearer than a few sums
            sums = np.empty((weights.shape[0], m, m), dtype=np.complex128)
            for own, weight in zip(sums, weights, strict=True):
                own.real = (self.rows.T * weight.real) @ self.rows
                own.imag = (self.rows.T * weight.imag) @ self.rows
            return sums
        products = (self.rows[:, :, None] * self.rows[:, None, :]).reshape(-1, m * m)
        return np.asarray((weights @ products).reshape(-1, m, m), dtype=np.complex128)


def relaxing(rows: FloatArray, damping: FloatArray, times: FloatArray) -> Relaxation:
    """Contacts whose films relax; those that do not have a row of zeros.

    Parameters
    ----------
    rows : array, shape (r, m)
        Approach of each contact by the displacements of the ports.
    damping, times : array, shape (r,)
        c of each contact [N s/m] and theta [s].
    """
    relaxes = (damping > 0.0) & (times > 0.0)
    some = float(times[relaxes].max()) if relaxes.any() else 1.0
    times = np.where(relaxes, times, some)
    return Relaxation(rows * np.sqrt(np.where(relaxes, damping, 0.0) / times)[:, None], times)

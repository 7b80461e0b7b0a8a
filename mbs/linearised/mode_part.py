"""Part that modes lack, true less found: what a change of their eigenvalues is in frequency and damping ratio."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray, IntArray


class ModePart(NamedTuple):
    """Part that modes lack, true less found, shape (modes,) each; of a sweep (speeds, modes).

    Attributes
    ----------
    frequency : array
        Part in |eigenvalue|/(2 pi) [Hz].
    damping_ratio : array
        Part in the damping ratio.
    """

    frequency: FloatArray
    damping_ratio: FloatArray

    def of(self, which: IntArray | BoolArray) -> ModePart:
        """The part of some of the modes."""
        return ModePart(self.frequency[..., which], self.damping_ratio[..., which])

    @property
    def sizes(self) -> FloatArray:
        """Sizes of both, shape (2, modes)."""
        return np.abs(np.array(self))


def moved(eigenvalues: ComplexArray, change: ComplexArray) -> ModePart:
    """The part that a change of eigenvalues is; NaN where the change is.

    Parameters
    ----------
    eigenvalues, change : array, shape (modes,)
        [1/s].
    """
    size, other = np.abs(eigenvalues), np.abs(eigenvalues + change)
    before, after = (
        -values.real / np.where(of == 0.0, 1.0, of)
        for values, of in ((eigenvalues, size), (eigenvalues + change, other))
    )
    return ModePart((other - size) / (2.0 * np.pi), after - before)

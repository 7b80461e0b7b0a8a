"""A smooth function of several coordinates through few points, and its spread by leaving each of them out.

The function is a constant plus a sum of radial functions, one around each point: (1 + q + q^2/3) exp(-q), with q the
square root of five times the distance, whose unit along each coordinate is a length. Where its slope along the first
coordinate is known too the derivatives of these functions are added, so that value and slope that come back belong
together exactly. Points need not be met: an observation has a noise, so many times that of the best one.

Lengths and noises are those by which the points, each left out in turn, are predicted best: the log density of leaving
out of C. E. Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning, MIT Press, 2006, section 5.4.2, in
closed form. So is the spread: the squares of the errors of leaving out are, on the average, those stated for them.
Since lengths and noises were chosen to keep these small, what is stated elsewhere is larger, by the number of points
over what is left of it after one for each number that was chosen.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize, minimize_scalar

from ehdmaps.arrays import FloatArray

_LENGTHS, _FIRST_LENGTHS = (0.6, 20.0), (0.15, 20.0)
"""Limits of the lengths, over the range of the coordinate; few points could not tell what is narrow in several
coordinates from noise, so that only the first may be short."""

_NOISES = (1e-7, 1.0)
"""Limits of the variance of noise over that of the function; of a slope, over that of its slope."""

_BEGIN_LENGTHS, _BEGIN_NOISES = (0.3, 1.2), (1.0, 1e-3)
"""From where lengths, and noises of slopes, are improved."""

_CONSTANT = 1e2
"""Variance of the constant over that of the rest: nothing is known of it before."""

_LEAST = 1e-14
"""Smallest variance: differences of 1e-7 are round-off of a solver."""


@dataclass(frozen=True, eq=False)
class Smooth:
    """A smooth function through noisy values.

    Attributes
    ----------
    places : array (n, d)
        Coordinates of the points at which it was observed.
    observed : array (1, n) or (2, n)
        Values, and slopes along the first coordinate where they are known.
    doubts : array (1, n) or (2, n)
        Standard deviation of the noise of each of them over that of one without doubt, at least one.
    lengths : array (d,)
        Lengths, in the units of the coordinates.
    noises : array (1,) or (2,)
        Variances of the noise of values, and of slopes, over those of the function.
    chosen : int
        How many of these numbers were chosen by leaving out.
    """

    places: FloatArray
    observed: FloatArray
    doubts: FloatArray
    lengths: FloatArray
    noises: FloatArray
    chosen: int

    @classmethod
    def fitted(cls, places: FloatArray, ranges: FloatArray, observed: FloatArray, doubts: FloatArray) -> Smooth:
        """Choose lengths and noises by leaving out.

        Parameters
        ----------
        places : array (n, d)
            Coordinates of the points.
        ranges : array (d,)
            Ranges of the coordinates, of which the lengths are multiples.
        observed, doubts : array (2, n)
            Observed values and slopes, and their doubts.
        """
        scales = np.where(ranges > 0.0, ranges, 1.0)

        def made(logarithms: FloatArray) -> Smooth:
            numbers = np.exp(logarithms)
            return cls(places, observed, doubts, scales * numbers[:-2], numbers[-2:], numbers.size)

        later = scales.size - 1
        limits = np.log([_FIRST_LENGTHS, *[_LENGTHS] * later, _NOISES, _NOISES])
        starts = [
            np.log([first, *[2.0 * first] * later, 1e-3, noise])
            for first, noise in itertools.product(_BEGIN_LENGTHS, _BEGIN_NOISES)
        ]
        found = [
            minimize(lambda numbers: -made(numbers).density, start, method="L-BFGS-B", bounds=limits)
            for start in starts
        ]
        return made(min(found, key=lambda one: one.fun).x)

    def alike(self, observed: FloatArray, doubts: FloatArray) -> Smooth:
        """Another function at the same places that changes over the same lengths, without slopes; its noise is chosen.

        Parameters
        ----------
        observed, doubts : array (1, n)
            Observed values, and their doubts.
        """

        def made(logarithm: float) -> Smooth:
            return replace(self, observed=observed, doubts=doubts, noises=np.exp([logarithm]), chosen=1)

        found = minimize_scalar(lambda noise: -made(noise).density, bounds=np.log(_NOISES), method="bounded")
        return made(found.x)

    def at(self, places: FloatArray) -> FloatArray:
        """Value, and slope along the first coordinate where slopes were observed, shape (1, m) or (2, m).

        Parameters
        ----------
        places : array (m, d)
            Coordinates of the points that are asked for.
        """
        weights = cho_solve(self._factor, self.observed.ravel())
        return np.asarray(self._covariance(places) @ weights).reshape(-1, len(places))

    def spread(self, places: FloatArray, doubts: FloatArray) -> FloatArray:
        """Covariance of one more observation from the function, shape (m, 1, 1) or (m, 2, 2).

        Parameters
        ----------
        places : array (m, d)
            Coordinates of the points that are asked for.
        doubts : array (1, m) or (2, m)
            Doubts of these observations.
        """
        cross = self._covariance(places)
        known = np.einsum("amn,nbm->mab", cross.reshape(*doubts.shape, -1), cho_solve(self._factor, cross.T).reshape(
            -1, *doubts.shape
        ))  # fmt: skip
        own = np.diag(self._scales + [_CONSTANT, 0.0][: len(doubts)])
        noise = (self.noises * self._scales * doubts.T**2)[:, :, None] * np.eye(len(doubts))
        return np.asarray(self._variance * self.freedom * (own - known + noise))

    @property
    def freedom(self) -> float:
        """Points over those that remain after one for each number that was chosen."""
        return len(self.places) / max(len(self.places) - self.chosen, 1)

    @property
    def left_out(self) -> FloatArray:
        """Predictions of each point by the others, shape of `observed`."""
        return np.asarray(self.observed - self._left_out[0].T)

    @property
    def density(self) -> float:
        """Logarithm of the density that is predicted for the points, each left out, but for a constant."""
        _, spreads = self._left_out
        return -0.5 * float(np.sum(np.linalg.slogdet(spreads)[1]) + self.observed.size * np.log(self._variance))

    @property
    def _scales(self) -> FloatArray:
        """Variances of value and slope over that of the function."""
        return np.array([1.0, 5.0 / (3.0 * self.lengths[0] ** 2)])[: len(self.observed)]

    @cached_property
    def _variance(self) -> float:
        """Variance of the function, by which the errors of leaving out are on the average what is stated for them."""
        errors, spreads = self._left_out
        squares = np.einsum("ia,iab,ib->i", errors, np.linalg.inv(spreads), errors)
        return max(float(np.mean(squares)) / len(self.observed), _LEAST)

    @cached_property
    def _factor(self) -> tuple[FloatArray, bool]:
        """Cholesky factor of the covariance of the observations."""
        noise = self.noises[:, None] * self._scales[:, None] * self.doubts**2
        factor, lower = cho_factor(self._covariance(self.places) + np.diag(noise.ravel()), lower=True)
        return np.asarray(factor), bool(lower)

    @cached_property
    def _left_out(self) -> tuple[FloatArray, FloatArray]:
        """Errors of each point left out, (n, kinds), and their covariances over the variance, (n, kinds, kinds)."""
        inverse = cho_solve(self._factor, np.eye(self.observed.size))
        own = np.einsum("aibi->iab", inverse.reshape(self.observed.shape * 2))
        spreads = np.linalg.inv(own)
        return np.einsum("iab,bi->ia", spreads, (inverse @ self.observed.ravel()).reshape(self.observed.shape)), spreads

    def _covariance(self, places: FloatArray) -> FloatArray:
        """Covariance of values, and behind them slopes, at some places with the observations."""
        apart = (places[:, None, :] - self.places[None, :, :]) / self.lengths
        q = np.sqrt(5.0 * np.sum(apart**2, axis=2))
        fading, along = np.exp(-q), apart[:, :, 0]
        value = (1.0 + q + q**2 / 3.0) * fading + _CONSTANT
        if len(self.observed) == 1:
            return np.asarray(value)
        bent = 5.0 / 3.0 * (1.0 + q) * fading * along / self.lengths[0]
        both = self._scales[1] * fading * (1.0 + q - 5.0 * along**2)
        return np.block([[value, bent], [-bent, both]])

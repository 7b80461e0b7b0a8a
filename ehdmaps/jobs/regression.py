"""A smooth function through few points, with what it is uncertain by: regression by a Gaussian process.

The values are those of a constant plus a process of zero mean with the covariance of Matern, nu = 5/2, of the distance
of two places in units of three lengths, one for each coordinate. Where the slope of the function along the first
coordinate is known too, it is one more observation of the same process: value and slope of what comes back belong
together exactly.

Not all observations are equally good, or matter equally. Each has a doubt: its noise is so many times that of the best.

The lengths, and the shares of noise in values and slopes, are those among `LENGTHS` and `NOISES` for which what is left
out one point at a time was most likely: the log predictive density of leave-one-out of C. E. Rasmussen, C. K. I.
Williams, Gaussian Processes for Machine Learning, MIT Press, 2006, section 5.4.2. They are improved in turn, one after
the other, until none changes, once from little noise and once from much. The variance follows in closed form, such that
the squares of the errors of leaving out are, on the average, the variances that were stated for them. Since the
settings were chosen to keep these errors small, what is stated elsewhere is larger, by the number of observations over
what is left of it after one for each setting.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from ehdmaps.arrays import FloatArray

LENGTHS = (0.15, 0.3, 0.6, 1.2, 2.5, 5.0, 20.0)
"""Lengths that are tried, over the range of the coordinate; at the last one it hardly matters."""

LATER_LENGTHS = LENGTHS[2:]
"""The same for all coordinates but the first: few points could not tell what is narrow in several from noise."""

NOISES = (1e-7, 1e-6, 1e-4, 1e-3, 1e-2, 1e-1, 1.0)
"""Variances of the noise that are tried, over that of the process; of a slope, over that of the process' slope."""

_BEGIN_LENGTH, _BEGIN_NOISES = 1.2, (1e-3, 1.0)
_CONSTANT = 1e2
"""Variance of the constant over that of the process: nothing is known of it before."""

_LEAST = 1e-14
"""Smallest variance of the process: differences of 1e-7 are round-off of a solver."""

_MOST_ROUNDS = 6


@dataclass(frozen=True)
class Settings:
    """Settings of a regression.

    Attributes
    ----------
    lengths : tuple of float
        One for each coordinate, in its unit.
    noises : tuple of float
        Variance of the noise of values, and of slopes where they are known, over that of the process.
    """

    lengths: tuple[float, ...]
    noises: tuple[float, ...]


@dataclass(frozen=True)
class LeftOut:
    """Predictions of a regression for each of its own points once it is left out.

    Attributes
    ----------
    value, slope : array (n,)
        Predicted values and slopes; the slope is NaN where slopes are not observed.
    squares : array (n,)
        Squares of the errors over the variances stated for them: one on the average.
    """

    value: FloatArray
    slope: FloatArray
    squares: FloatArray


@dataclass(frozen=True, eq=False)
class Regression:
    """Smooth function through noisy values.

    Attributes
    ----------
    places : array (n, d)
        Coordinates of the points at which it was observed.
    observed : array (n,) or (2 n,)
        Values, and behind them the slopes along the first coordinate, where they are known.
    doubts : array (n,) or (2 n,)
        Standard deviation of the noise of each of them over that of one without doubt, at least one.
    settings : Settings
        Lengths and noises.
    """

    places: FloatArray
    observed: FloatArray
    doubts: FloatArray
    settings: Settings

    @classmethod
    def fitted(
        cls,
        places: FloatArray,
        ranges: FloatArray,
        values: FloatArray,
        doubts: FloatArray,
        slopes: FloatArray | None = None,
        slope_doubts: FloatArray | None = None,
    ) -> Regression:
        """Choose the settings by leaving out.

        Parameters
        ----------
        places : array (n, d)
            Coordinates of the points at which the function was observed.
        ranges : array (d,)
            Ranges of the coordinates, of which the lengths are multiples.
        values, doubts : array (n,)
            Values of the function, and their doubts.
        slopes, slope_doubts : array (n,), optional
            Slopes of the function along the first coordinate, and their doubts.
        """
        observed = values if slopes is None else np.concatenate([values, slopes])
        of_all = doubts if slope_doubts is None else np.concatenate([doubts, slope_doubts])
        kinds = 1 if slopes is None else 2
        coordinates = places.shape[1]
        allowed = [LENGTHS, *([LATER_LENGTHS] * (coordinates - 1)), *([NOISES] * kinds)]
        scales = np.where(ranges > 0.0, ranges, 1.0)
        free = [which for which in range(len(allowed)) if which >= coordinates or ranges[which] > 0.0]

        def made(numbers: tuple[float, ...]) -> Regression:
            lengths = tuple((np.array(numbers[:coordinates]) * scales).tolist())
            return cls(places, observed, of_all, Settings(lengths, numbers[coordinates:]))

        def improved(numbers: tuple[float, ...]) -> Regression:
            best = made(numbers)
            for _ in range(_MOST_ROUNDS):
                before = numbers
                for which in free:
                    for value in allowed[which]:
                        changed = (*numbers[:which], value, *numbers[which + 1 :])
                        tried = made(changed)
                        if tried.likelihood > best.likelihood:
                            best, numbers = tried, changed
                if numbers == before:
                    break
            return best

        starts = [(*([_BEGIN_LENGTH] * coordinates), *([noise] * kinds)) for noise in _BEGIN_NOISES]
        return max((improved(numbers) for numbers in starts), key=lambda regression: regression.likelihood)

    @property
    def with_slopes(self) -> bool:
        """True where slopes are observed."""
        return len(self.settings.noises) > 1

    @cached_property
    def count(self) -> int:
        """Number of observations."""
        return self.observed.size

    @cached_property
    def variance(self) -> float:
        """Variance of the process, by which the squares of `LeftOut` are one on the average."""
        errors, spreads = self._left_out
        return max(float(np.mean(_squares(errors, spreads))), _LEAST)

    @cached_property
    def likelihood(self) -> float:
        """Logarithm of the density that is predicted for the points, each left out, but for a constant."""
        _, spreads = self._left_out
        return -0.5 * float(np.sum(np.linalg.slogdet(spreads)[1])) - 0.5 * self.observed.size * math.log(self.variance)

    def at(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Value and slope along the first coordinate, each of shape (m,).

        Parameters
        ----------
        places : array (m, d)
            Coordinates of the points that are asked for.
        """
        value, slope = _covariance(places, self.places, self.settings.lengths, True, self.with_slopes).reshape(
            2, len(places), -1
        )
        return value @ self._weights, slope @ self._weights

    def spread(self, places: FloatArray, doubts: FloatArray | None = None) -> FloatArray:
        """Covariance of value and slope, shape (m, 2, 2).

        Parameters
        ----------
        places : array (m, d)
            Coordinates of the points that are asked for.
        doubts : array (m, 2), optional
            Doubts of one more observation of value and slope there, whose noise is then counted in; that of the
            function itself if left out. A slope that is not observed has no noise of its own.
        """
        cross = _covariance(places, self.places, self.settings.lengths, True, self.with_slopes).reshape(
            2, len(places), -1
        )
        known = np.einsum("amn,nbm->mab", cross, cho_solve(self._factor, cross.reshape(-1, cross.shape[2]).T).reshape(
            -1, 2, len(places)
        ))  # fmt: skip
        own = np.diag([1.0 + _CONSTANT, self._slope_variance])
        variance = self.variance * self.freedom
        spread = variance * (own - known)
        if doubts is not None:
            spread = spread + variance * np.eye(2) * (np.array([*self._noises, 0.0][:2]) * doubts**2)[:, None, :]
        return np.asarray(spread)

    @cached_property
    def left_out(self) -> LeftOut:
        """Predictions of each point by the others."""
        errors, spreads = self._left_out
        predicted = self.observed.reshape(errors.shape[1], -1).T - errors
        slope = predicted[:, 1] if self.with_slopes else np.full(len(predicted), np.nan)
        return LeftOut(predicted[:, 0], slope, _squares(errors, spreads) / self.variance)

    def and_at(self, places: FloatArray) -> Regression:
        """The same with more points, for which it holds what it says there: only its spread is smaller.

        Parameters
        ----------
        places : array (m, d)
            Coordinates of the points that are asked for.
        """
        value, slope = self.at(places)
        mine = self.observed.reshape(-1, len(self.places))
        more = np.stack([value, slope])[: len(mine)]
        doubts = np.concatenate([self.doubts.reshape(mine.shape), np.ones(more.shape)], axis=1)
        known = Regression(
            np.vstack([self.places, places]),
            np.concatenate([mine, more], axis=1).ravel(),
            doubts.ravel(),
            self.settings,
        )
        known.__dict__.update(variance=self.variance, count=self.count)
        return known

    @property
    def freedom(self) -> float:
        """Observations over those that remain after one for each setting."""
        chosen = len(self.settings.lengths) + len(self.settings.noises)
        return self.count / max(self.count - chosen, 1)

    @property
    def _slope_variance(self) -> float:
        """Variance of the slope over that of the process."""
        return 5.0 / (3.0 * self.settings.lengths[0] ** 2)

    @property
    def _noises(self) -> tuple[float, ...]:
        """Variances of the noise over that of the process, of values and slopes."""
        return tuple(n * s for n, s in zip(self.settings.noises, (1.0, self._slope_variance), strict=False))

    @cached_property
    def _factor(self) -> tuple[FloatArray, bool]:
        """Cholesky factor of the covariance of the observations."""
        covariance = _covariance(self.places, self.places, self.settings.lengths, self.with_slopes, self.with_slopes)
        noise = np.repeat(self._noises, len(self.places)) * self.doubts**2
        factor, lower = cho_factor(covariance + np.diag(noise), lower=True)
        return np.asarray(factor), bool(lower)

    @cached_property
    def _weights(self) -> FloatArray:
        """Weights of the observations."""
        return np.asarray(cho_solve(self._factor, self.observed))

    @cached_property
    def _left_out(self) -> tuple[FloatArray, FloatArray]:
        """Errors of each point left out, (n, q), and their covariances over the variance, (n, q, q)."""
        count = len(self.places)
        kinds = self.observed.size // count
        inverse = cho_solve(self._factor, np.eye(self.observed.size)).reshape(kinds, count, kinds, count)
        own = np.einsum("aibi->iab", inverse)
        spreads = np.linalg.inv(0.5 * (own + own.transpose(0, 2, 1)))
        return np.einsum("iab,bi->ia", spreads, self._weights.reshape(kinds, count)), spreads


def _squares(errors: FloatArray, spreads: FloatArray) -> FloatArray:
    """Squares of errors over their covariances, a point, on the average of its observations."""
    return np.asarray(np.einsum("ia,iab,ib->i", errors, np.linalg.inv(spreads), errors) / errors.shape[1])


def _covariance(
    one: FloatArray, other: FloatArray, lengths: tuple[float, ...], slopes: bool, other_slopes: bool
) -> FloatArray:
    """Covariance of values, and behind them slopes if they are wanted, at some places and others."""
    scales = np.array(lengths)
    apart = (one[:, None, :] - other[None, :, :]) / scales
    q = np.sqrt(5.0 * np.sum(apart**2, axis=2))
    fading = np.exp(-q)
    along = apart[:, :, 0] / scales[0]
    bent = 5.0 / 3.0 * (1.0 + q) * fading * along
    rows = {
        (False, False): (1.0 + q + q**2 / 3.0) * fading + _CONSTANT,
        (False, True): bent,
        (True, False): -bent,
        (True, True): 5.0 / 3.0 * fading * ((1.0 + q) / scales[0] ** 2 - 5.0 * along**2),
    }
    mine, theirs = (False, True)[: 1 + slopes], (False, True)[: 1 + other_slopes]
    return np.asarray(np.block([[rows[a, b] for b in theirs] for a in mine]))

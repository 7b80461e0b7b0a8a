"""Least squares from many starts: logarithmic residuals of what was measured, weighted by its noise.

Of a response H(p) beside the measured H_m, whose complex value has the relative deviation sigma,

    r = sqrt(2)/sigma ln(H(p)/H_m),

both parts; of modes the logarithms of frequencies and damping ratios over their relative deviations; of what is known
beforehand (p - p_0)/deviation. It is always ln of the ratio, never a difference of logarithms, which has a branch cut.

Peaks that are far from each other do not feel each other. So starts are scored, and the best of them refined, on
thinned lines with deviations widened to `WIDENED` first, by a robust loss, then as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from scipy.optimize import least_squares

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import AnalysisError, InputError
from mbs.analyses.case import Failed, Workers, side_by_side
from mbs.identification.free import Free
from mbs.identification.machine import Machine, looked
from mbs.identification.measured import Measured, MeasuredModes, MeasuredResponses
from mbs.scene.scene import Scene

WIDENED = 0.28
"""Relative deviation that every line has in the first stages."""

STARTS, KEPT = 24, 3
"""Random starts that are scored, and how many of them are refined."""

COARSE, FINE = 60, 400
"""Lines of each measurement, at most, in the first stages and in the last."""

STEP = 1e-4
"""Step of differences, as a part of the range of an unknown."""

_NONE = 3.0
"""Residual of a logarithm where the machine finds no equilibrium, or has no such mode."""

_MOST_STEPS = 60
"""Steps of each stage of a refinement."""


@dataclass(frozen=True, eq=False)
class Question:
    """Question to the data: unknowns of a machine, and what was measured of it.

    Attributes
    ----------
    machine : Machine
        The machine.
    scene : Scene
        Scene of the machine, with all that is held fixed.
    free : tuple of Free
        Unknowns of the machine.
    measured : tuple of MeasuredResponses or MeasuredModes
        What was measured.
    """

    machine: Machine
    scene: Scene
    free: tuple[Free, ...]
    measured: tuple[Measured, ...]
    low: FloatArray = field(init=False)
    width: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        ends = np.array([one.ends for one in self.free])
        object.__setattr__(self, "low", ends[:, 0])
        object.__setattr__(self, "width", ends[:, 1] - ends[:, 0])

    @property
    def start(self) -> FloatArray:
        """Values of the scene, as parts of their ranges."""
        own = np.array([one.coordinate(one.start) for one in self.free])
        return np.clip((own - self.low) / self.width, 0.0, 1.0)

    def coordinates(self, parts: FloatArray) -> FloatArray:
        """Coordinates of the search, of parts of the ranges."""
        return np.asarray(self.low + self.width * parts)

    def values(self, parts: FloatArray) -> list[float]:
        """Values [SI], of parts of the ranges."""
        return [one.value(x) for one, x in zip(self.free, self.coordinates(parts), strict=True)]

    def thinned(self, most: int) -> Question:
        """The question with fewer lines."""
        return self.of([one.thinned(most) if isinstance(one, MeasuredResponses) else one for one in self.measured])

    def of(self, measured: Sequence[Measured]) -> Question:
        """The question with other measurements."""
        return Question(self.machine, self.scene, self.free, tuple(measured))

    def residuals(self, parts: FloatArray, widened: float = 0.0, scene: Scene | None = None) -> FloatArray:
        """Residuals of all measurements, then of what is known beforehand.

        Parameters
        ----------
        parts : array, shape (unknowns,)
            Unknowns as parts of their ranges.
        widened : float
            Relative deviation that every line gets beside its own.
        scene : Scene, optional
            Another machine, as it is held fixed.
        """
        return self.residuals_of(self.looks(parts, scene), parts, widened)

    def looks(self, parts: FloatArray, scene: Scene | None = None) -> list[ComplexArray | None]:
        """Logarithms of what the machine has in place of each measurement; None where it has no equilibrium.

        Parameters
        ----------
        parts : array, shape (unknowns,)
            Unknowns as parts of their ranges.
        scene : Scene, optional
            Another machine, as it is held fixed.
        """
        values = self.values(parts)
        return [self.look(values, one, scene) for one in self.measured]

    def residuals_of(self, looks: Sequence[ComplexArray | None], parts: FloatArray, widened: float = 0.0) -> FloatArray:
        """Residuals of looks at the machine.

        Parameters
        ----------
        looks : sequence of array or None
            Logarithms that `looks` finds.
        parts : array, shape (unknowns,)
            Unknowns as parts of their ranges.
        widened : float
            Relative deviation that every line gets beside its own.
        """
        found = [residual_of(look, one, widened) for look, one in zip(looks, self.measured, strict=True)]
        return np.concatenate([*found, self.before(parts)])

    def look(self, values: Sequence[float], measured: Measured, scene: Scene | None = None) -> ComplexArray | None:
        """Logarithms of what the machine has in place of a measurement; None where it has no equilibrium.

        Parameters
        ----------
        values : sequence of float
            Values of the unknowns [SI].
        measured : MeasuredResponses or MeasuredModes
            Measurement that is looked for.
        scene : Scene, optional
            Another machine, as it is held fixed.
        """
        try:
            return looked(self.machine, scene or self.scene, self.free, values, measured)
        except (AnalysisError, InputError):
            return None

    def before(self, parts: FloatArray) -> FloatArray:
        """Residuals of what is known beforehand."""
        own = zip(self.free, self.coordinates(parts), strict=True)
        return np.array([(x - one.coordinate(one.prior[0])) / one.prior[1] for one, x in own if one.prior])


def residual_of(found: ComplexArray | None, measured: Measured, widened: float = 0.0) -> FloatArray:
    """Residuals of a measurement, real.

    Parameters
    ----------
    found : array of complex or None
        Logarithms of the machine's.
    measured : MeasuredResponses or MeasuredModes
        What was measured.
    widened : float
        Relative deviation beside that of each value.
    """
    if isinstance(measured, MeasuredModes):
        pairs = (
            (measured.frequency, measured.frequency_deviation),
            (measured.damping_ratio, measured.damping_deviation),
        )
        own = np.full((2, measured.frequency.size), np.nan) if found is None else found.real
        parts = []
        for row, (value, deviation) in zip(own, pairs, strict=True):
            weight = 1.0 / np.hypot(deviation / value, widened)
            apart = np.where(np.isfinite(row), row - np.log(value), _NONE)
            parts.append(np.where(np.isfinite(weight), weight * apart, 0.0))
        return np.concatenate(parts)
    weights = measured.weights(widened)
    if found is None:
        apart = np.full(measured.response.shape, _NONE + 1j * _NONE)
    else:
        with np.errstate(all="ignore"):
            # The phase of the ratio lies within half a turn.
            apart = np.log(np.exp(found) / measured.response)
        apart = np.where(np.isfinite(apart), apart, _NONE + 1j * _NONE)
    return np.concatenate([(apart.real * weights).ravel(), (apart.imag * weights).ravel()])


@dataclass(frozen=True, eq=False)
class Fit:
    """The best fit.

    Attributes
    ----------
    question : Question
        What was sought.
    parts : array, shape (unknowns,)
        Unknowns found, as parts of their ranges.
    residuals : array, shape (N,)
        Residuals there.
    jacobian : array, shape (N, unknowns)
        Their derivatives by the parts.
    costs : tuple of float
        Cost of the fits from the best starts, rising.
    agreed : int
        How many of these ended at the same place.
    stopped : bool
        Whether the search was stopped before its end.
    """

    question: Question
    parts: FloatArray
    residuals: FloatArray
    jacobian: FloatArray
    costs: tuple[float, ...]
    agreed: int
    stopped: bool = False

    @property
    def values(self) -> list[float]:
        """Values found [SI]."""
        return self.question.values(self.parts)

    @property
    def count(self) -> int:
        """Residuals that count."""
        return int(np.count_nonzero(self.residuals))

    @property
    def chi2(self) -> float:
        """Sum of the squares of the residuals over what noise alone makes of it."""
        return float(self.residuals @ self.residuals) / max(self.count - self.parts.size, 1)


Progress = Callable[[int, int], None]


def search(
    question: Question,
    starts: int = STARTS,
    kept: int = KEPT,
    seed: int = 0,
    progress: Progress = lambda done, total: None,
    workers: Workers = 1,
) -> Fit:
    """Find the unknowns.

    Parameters
    ----------
    question : Question
        What is sought.
    starts : int
        Random starts beside the values of the scene.
    kept : int
        How many of the starts are refined.
    seed : int
        Seed of these.
    progress : callable
        Told how much is done, and of how much.
    workers : int or concurrent.futures.Executor
        Number of processes among which the starts are divided, or what computes them in their place.

    Returns
    -------
    Fit
        The best one. Where the search is stopped by Ctrl-C after the first fit, the best so far.

    Raises
    ------
    AnalysisError
        If the machine finds no equilibrium at any start.
    """
    rng = np.random.default_rng(seed)
    count = len(question.free)
    places = [question.start, *rng.uniform(0.05, 0.95, (starts, count))]
    total = len(places) + 2 * kept
    coarse, fine = question.thinned(COARSE), question.thinned(FINE)
    scored, stands = [], False
    looks = side_by_side(
        partial(_looked, coarse),
        places,
        [1] * len(places),
        workers,
        lambda done, _: progress(done, total),
        lambda k: f"start {k + 1}",
    )
    for k, look in enumerate(looks):
        if isinstance(look, Failed):
            raise look.error
        scored.append((look[0], k))
        stands = stands or look[1]
    if not stands:
        raise AnalysisError("no equilibrium at any start: look at `mbs statics` of the scene, and at the ranges")
    found: list[tuple[float, FloatArray]] = []
    stopped = False
    chosen = [places[k] for _, k in sorted(scored)[:kept]]
    refined = side_by_side(
        partial(_twice_refined, coarse, fine),
        chosen,
        [2] * len(chosen),
        workers,
        lambda done, _: progress(len(places) + done, total),
        lambda n: f"refinement {n + 1}",
    )
    try:
        for one in refined:
            if isinstance(one, Failed):
                raise one.error
            found.append(one)
    except KeyboardInterrupt:
        if not found:
            raise
        stopped = True
    found.sort(key=lambda one: one[0])
    best = found[0][1]
    residuals, jacobian = jacobian_at(fine, best)
    same = sum(bool(np.max(np.abs(place - best)) < 0.02) for _, place in found)
    return Fit(fine, best, residuals, jacobian, tuple(cost for cost, _ in found), same, stopped)


def _looked(question: Question, place: FloatArray, _: Callable[[int], None]) -> tuple[float, bool]:
    """Score of a start, and whether the machine has an equilibrium there."""
    looks = question.looks(place)
    score = _score(question.residuals_of(looks, place, WIDENED))
    return score, any(look is not None for look in looks)


def _twice_refined(
    coarse: Question, fine: Question, place: FloatArray, told: Callable[[int], None]
) -> tuple[float, FloatArray]:
    """The place at which the search from a start ends, and its cost."""
    first = _refined(coarse, place, WIDENED, 1.0)
    told(1)
    second = _refined(fine, first, 0.0, 3.0)
    return float(np.sum(_soft(fine.residuals(second)))), second


def _soft(residuals: FloatArray) -> FloatArray:
    """Robust squares of residuals."""
    return np.asarray(9.0 * (np.sqrt(1.0 + (residuals / 3.0) ** 2) - 1.0))


def _score(residuals: FloatArray) -> float:
    """Score of a start: squares, none of which counts above 9."""
    return float(np.sum(np.minimum(residuals**2, 9.0)))


def _refined(question: Question, start: FloatArray, widened: float, scale: float) -> FloatArray:
    """The unknowns at the least of the squares, from a start."""
    found = least_squares(
        lambda parts: question.residuals(parts, widened),
        np.clip(start, 1e-6, 1.0 - 1e-6),
        bounds=(0.0, 1.0),
        loss="soft_l1",
        f_scale=scale,
        diff_step=STEP,
        xtol=1e-6,
        ftol=1e-7,
        max_nfev=_MOST_STEPS,
    )
    return np.asarray(found.x, dtype=np.float64)


def jacobian_at(question: Question, parts: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Residuals, and their derivatives by the parts of the ranges.

    Parameters
    ----------
    question : Question
        What is sought.
    parts : array, shape (unknowns,)
        Unknowns as parts of their ranges.
    """
    residuals = question.residuals(parts)
    columns = []
    for k in range(parts.size):
        step = STEP if parts[k] < 0.5 else -STEP
        moved = parts.copy()
        moved[k] += step
        columns.append((question.residuals(moved) - residuals) / step)
    return residuals, np.stack(columns, axis=1)

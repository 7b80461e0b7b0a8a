"""Certainty of unknowns that were found: noise by the Jacobian, and trials of what the model holds fixed.

Errors of a model are larger than noise, and most of them leave no trace in what is left over: with loads 5 % off a
clearance moves by several micrometres at an unchanged chi^2. So each assumption is changed, and the unknowns follow by
Gauss-Newton steps with the Jacobian that there is:

    band = sqrt((2 s max(1, chi))^2 + sum over trials (t shift)^2),    s^2 = diag (J'J)^-1,

either side for itself. An assumption that leaves more than noise and what is left over allow, |d|^2 > S, is
contradicted by the data: of a spread the part t = sqrt(S/|d|^2) remains, of what is one thing or another nothing. Here
d is the change of what is left over, and S = max(|r|^2 - n, 0) + 3 sqrt(2 n) for n degrees of freedom: a machine that
is not the scene's leaves more over, and then nothing is excluded.

Trials are what a scene leaves open (`mbs.unknowns.held_open`) but for what was found, and
besides: loads, damping of bodies, cut-off and slices.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from mbs.analyses.case import Failed, Workers, side_by_side
from mbs.identification.machine import changed
from mbs.identification.search import Fit
from mbs.scene.changes import cutoff_of, with_cutoff, with_damping_ratio, with_loads
from mbs.scene.scene import Scene
from mbs.scene.specs import HIGHEST_DAMPING_RATIO, FlexibleSpec, ShaftSpec
from mbs.unknowns.held_open import held_open
from mbs.unknowns.statement import tolerance_of
from mbs.unknowns.unknown import Unknown

LOADS, DAMPING = 0.05, 2.0
"""Part by which loads may be off that state nothing, and the factor of the damping ratios of bodies."""

APART = 0.9
"""Correlation from which on two unknowns are not told apart."""

_STEPS, _FARTHEST = 3, 0.15
"""Steps of a trial, and the longest of them as a part of a range."""

_NOT_TRIED = ("cage_angle", "supply")
"""Groups that are no trial: means over a pitch hold the first, the second is another machine."""


@dataclass(frozen=True, eq=False)
class Trial:
    """Shifts of the unknowns by one assumption.

    Attributes
    ----------
    name : str
        The assumption.
    shifts : array, shape (ways, unknowns)
        Shift of each coordinate, for each way that it may be wrong.
    left : float
        Part of the spread that the data leave, 0 to 1.
    """

    name: str
    shifts: FloatArray
    left: float = 1.0

    @property
    def rise(self) -> FloatArray:
        """By how much each may be larger."""
        return np.asarray(np.max(np.maximum(self.shifts, 0.0), axis=0))

    @property
    def fall(self) -> FloatArray:
        """By how much each may be smaller."""
        return np.asarray(np.max(np.maximum(-self.shifts, 0.0), axis=0))


@dataclass(frozen=True, eq=False)
class Certainty:
    """Knowledge of the unknowns, in the coordinates of the search.

    Attributes
    ----------
    deviation : array, shape (unknowns,)
        Standard deviation by noise.
    correlation : array, shape (unknowns, unknowns)
        Correlations by noise.
    trials : tuple of Trial
        Shifts by assumptions.
    chi2 : float
        Squares of what is left over, over those of noise.
    lost : tuple of str
        Assumptions that could not be tried, each with the reason.
    stopped : bool
        Whether Ctrl-C left assumptions untried.
    """

    deviation: FloatArray
    correlation: FloatArray
    trials: tuple[Trial, ...]
    chi2: float
    lost: tuple[str, ...] = ()
    stopped: bool = False

    @property
    def noise(self) -> FloatArray:
        """Half-width by noise, twice the deviation, wider where noise does not explain what is left over."""
        return np.asarray(2.0 * self.deviation * max(1.0, float(np.sqrt(self.chi2))))

    @property
    def rise(self) -> FloatArray:
        """Distance to the upper end of the band."""
        return np.asarray(np.sqrt(self.noise**2 + sum((one.rise**2 for one in self.trials), np.zeros(1))))

    @property
    def fall(self) -> FloatArray:
        """Distance to the lower end of the band."""
        return np.asarray(np.sqrt(self.noise**2 + sum((one.fall**2 for one in self.trials), np.zeros(1))))

    def untold(self, width: FloatArray) -> list[int]:
        """Unknowns of which the data say no more than their range does.

        Parameters
        ----------
        width : array, shape (unknowns,)
            Ranges in the coordinates.
        """
        return np.flatnonzero(2.0 * self.deviation > 0.5 * width).tolist()

    def groups(self) -> list[list[int]]:
        """Unknowns that are not told apart, together; those that are, in none."""
        together = np.abs(self.correlation) > APART
        np.fill_diagonal(together, False)
        found: list[set[int]] = []
        for i, j in zip(*np.nonzero(together), strict=True):
            joined = {int(i), int(j)}.union(*(one for one in found if one & {int(i), int(j)}))
            found = [one for one in found if not one & joined] + [joined]
        return [sorted(one) for one in found]


def covariance(jacobian: FloatArray, width: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Standard deviations in the coordinates, and correlations.

    Unknowns that nothing measured depends on have an infinite deviation.

    Parameters
    ----------
    jacobian : array, shape (N, unknowns)
        Derivatives of the residuals by the parts of the ranges.
    width : array, shape (unknowns,)
        Ranges in the coordinates.
    """
    # A range is what is known before anything is measured; so weak a statement moves nothing that is measured.
    curvature = jacobian.T @ jacobian + 1e-6 * np.eye(width.size)
    scale = np.sqrt(np.diag(curvature))
    inverse = np.linalg.pinv(curvature / np.outer(scale, scale), hermitian=True) / np.outer(scale, scale)
    deviation = np.sqrt(np.maximum(np.diag(inverse), 0.0))
    return deviation * width, inverse / np.maximum(np.outer(deviation, deviation), 1e-300)


def certainty(
    fit: Fit, progress: Callable[[int, int], None] = lambda done, total: None, workers: Workers = 1
) -> Certainty:
    """Find how well the unknowns of a fit are known.

    Parameters
    ----------
    fit : Fit
        The fit.
    progress : callable
        Told how many trials are done, and of how many.
    workers : int or concurrent.futures.Executor
        Number of processes among which the trials are divided, or what computes them in their place.
    """
    question = fit.question
    deviation, correlation = covariance(fit.jacobian, question.width)
    solved: FloatArray = np.asarray(np.linalg.pinv(fit.jacobian), dtype=np.float64)
    trials: list[Trial] = []
    lost: list[str] = []
    asked = list(assumptions(question.scene, [one.group for one in question.free], fit))
    # Looks at another viscosity are looks at another temperature, which is found.
    warm = "viscosity" if any(one.name == "temperature" for one in question.free) else None
    work, sizes, tried = partial(_tried, fit, solved, warm), [1] * len(asked), 0
    try:
        for found in side_by_side(work, asked, sizes, workers, progress, lambda k: asked[k].name):
            if isinstance(found, Failed):
                raise found.error
            tried += 1
            trial, reason = found
            trials += [trial] if trial is not None else []
            lost += [reason] if reason else []
    except KeyboardInterrupt:
        words = f"stopped before {len(asked) - tried} of {len(asked)} assumptions were tried"
        return Certainty(deviation, correlation, tuple(trials), fit.chi2, (*lost, words), stopped=True)
    return Certainty(deviation, correlation, tuple(trials), fit.chi2, tuple(lost))


def _tried(
    fit: Fit, solved: FloatArray, warm: str | None, unknown: Unknown, _: Callable[[int], None]
) -> tuple[Trial | None, str]:
    """Shifts by an assumption, None where the machine cannot be so, and what could not be tried of it, in words."""
    warmth = warm == unknown.group
    ways = [_warmth(fit, scene) if warmth else _shift(fit, solved, scene) for scene in unknown.looks]
    shifts = [one for one in ways if one is not None]
    reason = ""
    if len(shifts) < len(ways):
        reason = f"{unknown.name} {unknown.held}: no equilibrium, or other laws than the machine can have"
    if not shifts:
        return None, reason
    # What is one thing or another is there, or it is not; of a spread a part remains.
    parts = [float(part == 1.0) if unknown.is_member else part for _, part in shifts]
    moved = np.array([part * shift for (shift, _), part in zip(shifts, parts, strict=True)])
    both = np.concatenate([moved, -moved[:1]]) if unknown.reflected else moved
    return Trial(unknown.name, both * fit.question.width, max(parts)), reason


def _shift(fit: Fit, solved: FloatArray, scene: Scene) -> tuple[FloatArray, float] | None:
    """Shift of the parts where another assumption is true, and which part of it the data leave.

    None where the machine cannot be so.
    """
    parts = fit.parts
    values = fit.question.values(parts)
    if any(fit.question.look(values, one, scene) is None for one in fit.question.measured):
        return None
    for _ in range(_STEPS):
        step = -solved @ fit.question.residuals(parts, scene=scene)
        step *= min(1.0, _FARTHEST / max(float(np.max(np.abs(step))), 1e-300))
        parts = np.clip(parts + step, 0.0, 1.0)
    extra = float(np.sum((fit.question.residuals(parts, scene=scene) - fit.residuals) ** 2))
    return np.asarray(parts - fit.parts), min(1.0, math.sqrt(_slack(fit) / max(extra, 1e-300)))


def _slack(fit: Fit) -> float:
    """Squares that an assumption may leave, by what noise may leave and what is left over."""
    free = max(fit.count - fit.parts.size, 1)
    return max(float(fit.residuals @ fit.residuals) - free, 0.0) + 3.0 * math.sqrt(2.0 * free)


def _warmth(fit: Fit, scene: Scene) -> tuple[FloatArray, float]:
    """Shift of the parts by an oil of another viscosity: the temperature alone, at which it is as viscous."""
    question = fit.question
    place = next(k for k, one in enumerate(question.free) if one.name == "temperature")
    shift = np.zeros(fit.parts.size)
    shift[place] = (scene.temperature - fit.values[place]) / question.width[place]
    return shift, 1.0


def assumptions(scene: Scene, found: Sequence[str], fit: Fit) -> Iterator[Unknown]:
    """List what a model holds fixed, and the machines that it may be as well.

    Parameters
    ----------
    scene : Scene
        The scene, with what is held fixed.
    found : sequence of str
        Groups of the unknowns that were found.
    fit : Fit
        The fit: changes are made to the machine that was found.
    """
    free = fit.question.free
    machine = changed(scene, free, fit.values)
    clearances = {f"clearance of {one.of}" for one in free if one.group == "clearance"}
    named = {one.name for one in free}
    for unknown in held_open(machine, fit.question.machine.model.has_films):
        taken = unknown.name in clearances or (unknown.group in found and unknown.group != "clearance")
        if unknown.looks and not unknown.beside and not taken and unknown.group not in _NOT_TRIED:
            yield unknown
    stated = tolerance_of(scene, "load")
    part = LOADS if stated is None else stated.size
    if part and scene.loads and "load" not in found:
        looks = tuple(with_loads(machine, 1.0 + by) for by in (-part, part))
        yield Unknown("loads", "load", f"+-{100.0 * part:.3g} %", "assumed", looks)
    held = [
        body
        for body in scene.bodies
        if isinstance(body, (ShaftSpec, FlexibleSpec))
        and body.damping_ratio > 0.0
        and f"{body.name}.damping_ratio" not in named
    ]
    for body in held:
        looks = tuple(
            with_damping_ratio(machine, body.name, min(factor * body.damping_ratio, HIGHEST_DAMPING_RATIO))
            for factor in (1.0 / DAMPING, DAMPING)
        )
        yield Unknown(f"damping of {body.name}", "", "half to twice", "assumed", looks)
    if (cutoff := cutoff_of(machine)) is not None:
        try:
            yield Unknown("cut-off", "", "twice", "modes left out", (with_cutoff(machine, 2.0 * cutoff),))
        except InputError:
            return

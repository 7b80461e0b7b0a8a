"""Results that a user looks at in a linear system: frequencies, damping ratios, heights of responses, contact loads.

Two systems are compared mode by mode. Modes belong together by their shapes in the coordinates that both systems have,
weighted with the mass (modal assurance); a mode without a partner is said to be lost, and is in no error.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
import scipy

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import AnalysisError
from mbs.analyses.operating import operating
from mbs.linearised.averaged import mean_equilibrium
from mbs.linearised.linear import frequency_response, with_peaks
from mbs.linearised.modes import Modes, modes
from mbs.linearised.pairs import partners
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium
from mbs.scene.assembly import Model
from mbs.settings import CAGE_ANGLES

MOST_DAMPED = 0.5
"""Damping ratio up to which a mode is looked at: above, a response has hardly a peak by it."""

AROUND = 0.1
"""Part of its frequency within which the height of a peak is looked for."""

_PROMINENCE = 3.0
_LEFT_OVER = 1e-9


@dataclass(frozen=True, eq=False)
class LinearLook:
    """A linear system at an operating point.

    Attributes
    ----------
    balance : Equilibrium
        Equilibrium at which it was linearised.
    modes : Modes
        Complex modes of the system.
    frequencies : array, shape (frequencies,)
        Frequencies of the responses [Hz].
    levels : array, shape (frequencies, responses)
        Response of each sensor to each input [dB re 1 of its unit].
    loads : array, shape (bearings,)
        Load of the most loaded contact of each bearing: per length of a slice [N/m], or of a ball [N].
    bearings : tuple of str
        Names of these bearings.
    seconds : float
        Processor time of equilibrium, modes and responses [s].
    """

    balance: Equilibrium
    modes: Modes
    frequencies: FloatArray
    levels: FloatArray
    loads: FloatArray
    bearings: tuple[str, ...]
    seconds: float


@dataclass(frozen=True, eq=False)
class LinearDifferences:
    """A linear system beside a reference, NaN where there is nothing to compare.

    Attributes
    ----------
    frequency, damping : array, shape (modes,)
        Relative differences of frequencies and damping ratios of the modes of the reference.
    height : array, shape (peaks,)
        Differences of the heights of the peaks of the reference [dB].
    load : array, shape (bearings,)
        Relative differences of the largest loads.
    """

    frequency: FloatArray
    damping: FloatArray
    height: FloatArray
    load: FloatArray

    @classmethod
    def worst(cls, several: Sequence[LinearDifferences]) -> LinearDifferences:
        """Largest of each difference of several systems; NaN where one has nothing to compare.

        Parameters
        ----------
        several : sequence of LinearDifferences
            Differences of at least one system, all beside the same reference.
        """
        parts = (np.array([getattr(one, entry.name) for one in several]) for entry in fields(cls))
        return cls(*(_largest(part) for part in parts))


@dataclass(frozen=True, eq=False)
class LinearReference:
    """A linear system beside which others are looked at.

    Attributes
    ----------
    look : LinearLook
        The system.
    chosen : array of int, shape (modes,)
        Which of its modes are looked at.
    peaks : tuple of (int, float)
        Response, and frequency [Hz], of each peak.
    """

    look: LinearLook
    chosen: IntArray
    peaks: tuple[tuple[int, float], ...]

    @classmethod
    def of(cls, look: LinearLook, highest: float) -> LinearReference:
        """Choose modes and peaks.

        Parameters
        ----------
        look : LinearLook
            The system.
        highest : float
            Frequency up to which they are looked at [Hz].
        """
        found = look.modes
        seen = (found.frequency <= highest) & (found.damping_ratio <= MOST_DAMPED) & (found.frequency > 1.0)
        peaks = []
        for column in range(look.levels.shape[1]):
            places, _ = scipy.signal.find_peaks(look.levels[:, column], prominence=_PROMINENCE)
            peaks += [(column, float(look.frequencies[k])) for k in places if look.frequencies[k] <= highest]
        return cls(look, np.asarray(np.flatnonzero(seen), dtype=np.int64), tuple(peaks))

    def beside(self, other: LinearLook) -> LinearDifferences:
        """Compare another system with this one.

        Parameters
        ----------
        other : LinearLook
            The other system; it may have other coordinates.
        """
        own = self.look.modes
        partner = self._partners(other)
        there = partner >= 0
        frequency = np.full(partner.size, np.nan)
        damping = np.full(partner.size, np.nan)
        which = self.chosen[there]
        frequency[there] = other.modes.frequency[partner[there]] / own.frequency[which] - 1.0
        ratios = own.damping_ratio[which]
        damped = ratios > 0.0
        damping[there] = np.where(
            damped, other.modes.damping_ratio[partner[there]] / np.where(damped, ratios, 1.0) - 1.0, np.nan
        )
        height = [_highest(other, column, at) - _highest(self.look, column, at) for column, at in self.peaks]
        load = other.loads / self.look.loads - 1.0
        # What an equilibrium leaves over is no difference.
        return LinearDifferences(frequency, damping, np.array(height), np.where(np.abs(load) > _LEFT_OVER, load, 0.0))

    def _partners(self, other: LinearLook) -> IntArray:
        """The mode of another system that each chosen mode is; -1 where there is none."""
        own = self.look
        shapes = own.modes.shapes[:, self.chosen]
        return partners(own.balance.system, shapes, other.balance.system, other.modes.shapes)


def linear_look(model: Model, angle: float = 0.0, cage_angles: int = CAGE_ANGLES) -> LinearLook:
    """Look at the linear system of a model at its operating speed.

    Parameters
    ----------
    model : Model
        Scene with its law; without inputs, sensors or frequencies it has no responses.
    angle : float
        Angle that the system has turned, with its cages [rad].
    cage_angles : int
        Cage angles over which stiffness and damping of the bearings are averaged, the first of them at `angle`.

    Raises
    ------
    AnalysisError
        If there is no equilibrium.
    """
    begin = time.process_time()
    scene = model.scene
    model = operating(model, scene.speed)
    balance = mean_equilibrium(model.system, Operation(scene.speed, angle), cage_angles)
    found = modes(balance)
    asked = np.array(scene.frequencies) if scene.inputs and scene.sensors else np.zeros(0)
    frequencies = with_peaks(asked, found.eigenvalues)
    responses = np.abs(frequency_response(balance, scene.inputs, scene.sensors, frequencies))
    seconds = time.process_time() - begin
    found_loads = model.largest_loads(balance.displacement, balance.operation)
    known = ~np.isnan(found_loads)
    if not np.all(found_loads[known] > 0.0):
        raise AnalysisError("a bearing carries no load at its equilibrium, so that nothing can be compared with it")
    levels = 20.0 * np.log10(np.maximum(responses, 1e-300)).reshape(frequencies.size, math.prod(responses.shape[1:]))
    names = tuple(entry.name for entry, there in zip(model.on_rings, known, strict=True) if there)
    return LinearLook(balance, found, frequencies, np.asarray(levels), found_loads[known], names, seconds)


def _largest(values: FloatArray) -> FloatArray:
    """Value of largest size in each column, with its sign; NaN where one is."""
    if not values.size:
        return np.zeros(values.shape[1:])
    at = np.argmax(np.where(np.isnan(values), np.inf, np.abs(values)), axis=0)
    return np.asarray(np.take_along_axis(values, at[None], axis=0)[0])


def _highest(look: LinearLook, column: int, frequency: float) -> float:
    """Highest level of a response around a frequency [dB]; between two frequencies where none is near."""
    near = np.abs(look.frequencies - frequency) <= AROUND * frequency
    if not near.any():
        return float(np.interp(frequency, look.frequencies, look.levels[:, column]))
    return float(np.max(look.levels[near, column]))

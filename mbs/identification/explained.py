"""Tell whether a fit explains what was measured: channels that are wrong, and films or a constant damper.

A channel of the wrong sign, in another unit, or of a hit elsewhere than stated is no noise: such a fit is refused with
what looks wrong, and never given as a result.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ehdmaps.units import Display
from mbs.analyses.case import Workers
from mbs.identification.free import Free
from mbs.identification.measured import MeasuredResponses
from mbs.identification.search import Fit, Question, search

TURNED, SCALED, ALIKE = 2.6, 1.2, 0.35
"""Median phase [rad] and logarithm of a factor from which on a channel has another sign or unit, and the spread of the
latter up to which it is the channel and not the machine."""

MOST_CHI2 = 10.0
"""chi^2 above which a machine is not the one that was measured: wrong damping of a shaft makes 10, a cage angle 2."""

SURE, GOOD = 10.0, 2.0
"""Distance that the squares of two laws must have, and the chi^2 that the better one may have, for it to be named."""

FILMS, DAMPER, NOT_TOLD = "films", "a constant damper", "not told"

_SHORTEST, _LONGEST, _START = 1e-7, 1e-3, 1e-5


@dataclass(frozen=True)
class WrongChannel:
    """A channel that is not what it is called.

    Attributes
    ----------
    channel : str
        Which one.
    words : str
        What looks wrong.
    """

    channel: str
    words: str


def wrong_channels(fit: Fit) -> list[WrongChannel]:
    """Find channels whose sign or unit is another one than stated.

    Parameters
    ----------
    fit : Fit
        The best fit.
    """
    found = []
    for one in fit.question.measured:
        own = fit.question.look(fit.values, one)
        if not isinstance(one, MeasuredResponses) or own is None:
            continue
        ratio = one.response / np.exp(own)
        weights = one.weights()
        for row, channel in enumerate(one.channels):
            used = (weights[:, row] > 0.0) & np.isfinite(ratio[:, row]) & (np.abs(ratio[:, row]) > 0.0)
            if not np.any(used):
                continue
            turns = np.angle(ratio[used, row])
            sizes = np.log(np.abs(ratio[used, row]))
            factor = float(np.median(sizes))
            spread = float(np.median(np.abs(sizes - factor)))
            if float(np.median(np.abs(turns))) > TURNED:
                found.append(WrongChannel(channel, "has the sign of the other direction"))
            elif abs(factor) > SCALED and spread < ALIKE:
                times = f"{math.exp(factor):.3g} times"
                found.append(WrongChannel(channel, f"is {times} what the machine has: another unit"))
    return found


@dataclass(frozen=True, eq=False)
class OtherLaw:
    """The same data by films, and by dry contacts with a damper that is a time of their stiffness.

    Attributes
    ----------
    films, damper : float
        chi^2 of both.
    time : float
        Time of the damper [s].
    count : int
        Number of residuals.
    """

    films: float
    damper: float
    time: float
    count: int

    @property
    def explained_by(self) -> str:
        """Law that explains the damping: `FILMS`, `DAMPER` or `NOT_TOLD`."""
        apart = self.count * (self.damper - self.films)
        if abs(apart) > SURE and min(self.films, self.damper) < GOOD:
            return FILMS if apart > 0.0 else DAMPER
        return NOT_TOLD


def damper(fit: Fit, progress: Callable[[int, int], None] = lambda done, total: None, workers: Workers = 1) -> OtherLaw:
    """Fit the same data by dry contacts with a constant damper.

    Parameters
    ----------
    fit : Fit
        The fit by films.
    progress : callable
        Told how much is done.
    workers : int or concurrent.futures.Executor
        Number of processes, or what computes in their place.
    """
    question = fit.question
    kept = [k for k, one in enumerate(question.free) if one.name not in ("temperature", "alpha")]
    time = Free(
        name="damping time",
        unit="s",
        display=Display("us", 1e6),
        low=_SHORTEST,
        high=_LONGEST,
        start=_START,
        log=True,
        law="hertz:{:.9g} s",
    )
    free = (*(_begun(question.free[k], fit.values[k]) for k in kept), time)
    asked = Question(question.machine, question.scene, free, question.measured)
    found = search(asked, starts=3, kept=2, progress=progress, workers=workers)
    return OtherLaw(fit.chi2, found.chi2, found.values[-1], fit.count)


def _begun(one: Free, value: float) -> Free:
    """An unknown that begins at another value."""
    return dataclasses.replace(one, start=value)

"""The film at the lowest loads: rigid and isoviscous, w ~ 1/h, faded to nothing at a thick film.

With the film offset h1 and the film compliance s1 at the lowest known load w1, see `ehdmaps.maps.low_loads`,

    w = Q(h) A/(h - hs),    A = w1^2 s1,    hs = h1 - w1 s1,

which joins what is known with equal value and slope. Q is the quintic that falls from 1 at ha = max(0.005 R, h1) to
0 at 4 ha. The damping of the contact follows

    c = Q(h) c1 v^1.5 exp((n1 - 1.5)(v^3 - 1)/3),    v = w1 s1/(h - hs),

n1 = d ln c/d ln w at w1: equal value and slope at w1 (v = 1), and c ~ h^-1.5 of a rigid film where v is small.
c/w does not contain Q, so that it stays finite where both vanish.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray

THICK_FILM = 0.005
"""h/R at which the fade begins, unless the map itself reaches thicker films."""

FADE_RATIO = 4.0
"""Film at which the fade ends, over that at which it begins."""

_LEAST_COMPLIANCE = 1e-3
_JOIN_POWER = 3.0
_NEWTON_STEPS = 60
_CLOSE = 1e-9


@dataclass(frozen=True)
class Tail:
    """Film below the lowest known load, for every pair of speed and temperature.

    Attributes
    ----------
    load : array (n_u, n_T)
        w1 [N/m].
    film_offset, film_compliance : array (n_u, n_T)
        h1 [m] and s1 [m2/N] at w1.
    damping, damping_exponent : array (n_u, n_T)
        c [N s/m2] and d ln c/d ln w at w1.
    radius : float
        R [m].
    """

    load: FloatArray
    film_offset: FloatArray
    film_compliance: FloatArray
    damping: FloatArray
    damping_exponent: FloatArray
    radius: float

    @property
    def fade_film(self) -> FloatArray:
        """Film ha at which the fade begins [m]; it ends at 4 ha."""
        return np.maximum(THICK_FILM * self.radius, self.film_offset)

    @property
    def fade_load(self) -> FloatArray:
        """Load at ha [N/m]."""
        return self.strength / (self.fade_film - self.pole)

    @property
    def _compliance(self) -> FloatArray:
        """s1, kept above zero where the noise of a heavily loaded map has eaten it."""
        return np.maximum(self.film_compliance, _LEAST_COMPLIANCE * self.film_offset / self.load)

    @property
    def strength(self) -> FloatArray:
        """A [N]: w (h - hs) of the film that does not fade."""
        return self.load**2 * self._compliance

    @property
    def pole(self) -> FloatArray:
        """hs [m]."""
        return self.film_offset - self.load * self._compliance

    def films(self, root: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Film at given cube roots of the load.

        Parameters
        ----------
        root : array (n, n_u, n_T)
            g = w^(1/3), <= w1^(1/3). Negative values continue the film smoothly beyond 4 ha; there is no load.

        Returns
        -------
        film_offset : array
            h [m].
        slope : array
            dh/dg, negative.
        log_ratio : array
            ln(c/w), c/w in s/m.
        """
        strength, pole, fade = self.strength, self.pole, self.fade_film
        # Above the fade the hyperbola is inverted at once; in the fade tau goes from 1 at ha to 0 at 4 ha.
        unfaded = root >= np.cbrt(self.fade_load)
        safe = np.where(unfaded, root, 1.0)
        film = pole + strength / safe**3
        slope = -3.0 * strength / safe**4

        faded = np.nonzero(~unfaded)
        lines = faded[1:]
        start = fade[lines]
        span, reach = (FADE_RATIO - 1.0) * start, FADE_RATIO * start - pole[lines]
        unit = np.cbrt(strength[lines])
        tau = _faded_place(root[faded] / unit, span, reach)
        _, tau_slope = _faded_root(tau, span, reach)
        film[faded] = FADE_RATIO * start - span * tau
        slope[faded] = -span / (unit * tau_slope)

        part = self.load * self._compliance / (film - pole)
        log_ratio = (
            np.log(self.damping / self.load)
            + 0.5 * np.log(part)
            + (self.damping_exponent - 1.5) * (part**_JOIN_POWER - 1.0) / _JOIN_POWER
        )
        return film, slope, log_ratio


def _faded_root(tau: FloatArray, span: FloatArray, reach: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Cube root of Q(tau)/(h - hs) with h - hs = reach - span tau, and its derivative by tau.

    Q = tau^3 (10 - 15 tau + 6 tau^2): its cube root goes through zero without a kink.
    """
    shape = 10.0 - 15.0 * tau + 6.0 * tau**2
    distance = reach - span * tau
    value = tau * np.cbrt(shape / distance)
    log_slope = (12.0 * tau - 15.0) / shape + span / distance
    return value, np.cbrt(shape / distance) + value * log_slope / 3.0


def _faded_place(wanted: FloatArray, span: FloatArray, reach: FloatArray) -> FloatArray:
    """Solve `_faded_root` = wanted for tau <= 1, by Newton's method inside a closing bracket."""
    top, _ = _faded_root(np.ones_like(span), span, reach)
    high = np.ones_like(wanted)
    # For tau < 0 the root lies below its tangent at zero, since span < reach.
    low = np.minimum(0.0, wanted / np.cbrt(10.0 / reach)) - 1e-9
    tau = np.clip(wanted / top, low, high)
    for _ in range(_NEWTON_STEPS):
        value, slope = _faded_root(tau, span, reach)
        above = value > wanted
        high, low = np.where(above, tau, high), np.where(above, low, tau)
        newton = tau - (value - wanted) / np.where(slope > 0.0, slope, np.inf)
        following = np.where((newton >= low) & (newton <= high), newton, 0.5 * (low + high))
        moved = float(np.max(np.abs(following - tau), initial=0.0))
        tau = following
        if moved < _CLOSE:
            break
    return tau

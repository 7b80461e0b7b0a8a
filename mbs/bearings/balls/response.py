"""Films of a ball's contact over frequency, as springs in series with dampers beside the stiffness of slow motion.

The film table of points holds k and c at five natural frequencies Omega = omega sqrt(a^2 + 2 h Rx)/u from 1/2 to 8.
Beside k of slow motion a contact has dampers c_r in series with springs c_r/theta_r,

    Z(s) = k + sum_r s c_r/(1 + s theta_r),    c_r >= 0,    sum_r c_r = c,

so that slow motion is exact and energy is taken up at every frequency. The theta_r are given, `TIMES`; the c_r are the
non-negative ones whose Z is closest to the table's, by least squares of the relative difference. Above Omega = 8
nothing is known: Z tends to a stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import nnls

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.table.points.file import shipped_point_table
from ehdmaps.table.points.films import PointFilms

TIMES = np.array([0.01, 0.16, 1.0])
"""The times theta_r of all contacts in that of the natural frequency 1. Of all threes on a grid of five in a decade
none is much better for 95 of 100 loaded contacts; others are worse for those that hardly carry."""

_EXACT = 1e3
"""Weight of the sum of the dampers."""


class Springs(NamedTuple):
    """Dampers in series with springs, of contacts at some loads.

    Attributes
    ----------
    shares : array (n, r)
        Parts of the damping of slow motion, their sum is one.
    times : array (n, r)
        theta [s].
    misfit : array (n,)
        Largest |dZ/Z| at the frequencies of the table.
    stated : array (n,)
        Largest stated error of the table's Z there, as a part of it.
    """

    shares: FloatArray
    times: FloatArray
    misfit: FloatArray
    stated: FloatArray


@dataclass(frozen=True, eq=False)
class ContactResponse:
    """Response of a contact over frequency, at one speed and temperature.

    Attributes
    ----------
    contact : Ellipse
        The dry contact.
    oil : Lubricant
        The oil.
    entrainment_speed, temperature : float
        u [m/s], T [K].
    loads : array (n,)
        Loads at which the table has films, rising [N].
    """

    contact: Ellipse
    oil: Lubricant
    entrainment_speed: float
    temperature: float
    loads: FloatArray

    def films(self, load: FloatArray) -> PointFilms:
        """Films at loads (k,) [N]; where there are none, those of the nearest load that has some.

        Parameters
        ----------
        load : array (k,)
            Loads [N].
        """
        table, at = shipped_point_table(), (self.entrainment_speed, self.temperature)
        asked = np.clip(load, self.loads[0], self.loads[-1])
        found = table.films(self.contact, self.oil, asked, *at)
        if np.all(found.usable):
            return found
        places = np.log(self.loads)
        nearest = self.loads[np.abs(np.log(asked)[:, None] - places).argmin(axis=1)]
        return table.films(self.contact, self.oil, np.where(found.usable, asked, nearest), *at)

    def springs(self, load: FloatArray) -> Springs:
        """Dampers in series with springs at loads (k,) [N], see the module.

        Parameters
        ----------
        load : array (k,)
            Loads [N].
        """
        films = self.films(load)
        omega = 2.0 * np.pi * films.frequencies
        held = films.response_stiffness + 1j * omega * films.response_damping
        times = TIMES / (2.0 * omega[:, :1])  # the first frequency is a half
        wrong = np.hypot(
            films.errors["response_stiffness"] * films.response_stiffness,
            films.errors["response_damping"] * omega * films.response_damping,
        )
        shares, misfit = np.empty(times.shape), np.empty(load.size)
        for i, theta in enumerate(times):
            shares[i], misfit[i] = _closest(films.stiffness[i], films.damping[i], theta, 1j * omega[i], held[i])
        return Springs(shares, times, misfit, np.asarray((wrong / np.abs(held)).max(axis=1)))


def _closest(
    stiffness: float, damping: float, times: FloatArray, s: ComplexArray, held: ComplexArray
) -> tuple[FloatArray, float]:
    """Shares of dampers whose response is closest to one at frequencies s, and the largest difference."""
    size = np.abs(held)
    columns = (s[:, None] * damping / (1.0 + np.multiply.outer(s, times))) / size[:, None]
    left = (held - stiffness) / size
    matrix = np.vstack([columns.real, columns.imag, np.full((1, times.size), _EXACT)])
    found, _ = nnls(matrix, np.r_[left.real, left.imag, _EXACT])
    shares = found / found.sum()
    return shares, float(np.abs(columns @ shares - left).max())

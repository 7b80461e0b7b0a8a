"""Part that films with memory leave out: how far their complex stiffness is from that of the film solver.

A law with memory gives a roller one relaxation time. The film solver has none: oil takes the time b/u to pass half of
the Hertz zone, so that a loaded film answers late, and the two contacts of a roller relax in times of their own. A map
holds the answer of the solver at natural frequencies W = omega T, T = sqrt(b^2 + 2 h R)/u, at every point of its
backbone. There the law of a single contact is wrong by the part

    r = Z_law Y - 1,    Y the complex compliance of the solver.

Between these frequencies r exp(i W t/T), t = b/u, is a cubic spline over W that begins with zero and slope zero; above
the last one r is held. Compliances of contacts in series add. At frequencies s off the imaginary axis, those of modes,
the same formulas hold with W = T s/i.

It knows what the map does: films that are flooded, smooth and of constant temperature. Films on an oil layer, and rough
ones, are taken to leave out as much as these at the same load.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import ComplexArray, FloatArray, IntArray

_PLACES = np.array([0.1, 0.3, 0.7, 1.4, 2.8, 5.6, 10.0, 14.0, 30.0])
_DOUBT = np.array([1e-4, 4e-4, 4e-4, 6e-4, 1.8e-3, 9.1e-3, 3.0e-2, 3.1e-2, 7.2e-2])
"""Error of r as it is read between the frequencies of a map and above them: 95 of 100 random contacts of NU308 and
N1014 are below, with three oils of 12 to 30 1/GPa, 20 to 100 degC (`python -m tests.benchmarks.film_memory`)."""


def by_powers(place: FloatArray, places: FloatArray, values: FloatArray) -> FloatArray:
    """Straight between points in logarithms, and beyond them; 0 at a place of 0.

    Parameters
    ----------
    place : array
        Place that is read, >= 0.
    places, values : array (k,)
        Points, > 0; the places rise.

    Examples
    --------
    >>> round(float(by_powers(np.array(4.0), np.array([1.0, 2.0]), np.array([1.0, 4.0]))), 9)
    16.0
    """
    x, steps = np.log(np.clip(place, 1e-30, 1e30)), np.log(places)
    cell = np.clip(np.searchsorted(steps, x) - 1, 0, steps.size - 2)
    slope = np.diff(np.log(values)) / np.diff(steps)
    found = np.exp(np.log(values)[cell] + slope[cell] * (x - steps[cell]))
    return np.asarray(np.where(place > 0.0, found, 0.0))


@dataclass(frozen=True, eq=False)
class FilmsOfContact:
    """Films of a contact at rest at some loads, in a law of its own.

    Attributes
    ----------
    stiffness, damping, times : array (n,)
        k [N/m2], c [N s/m2] and relaxation time [s].
    natural, passing : array (n,)
        Natural time T, and time b/u in which oil passes half of the Hertz zone [s].
    frequencies : array (k,)
        Natural frequencies W of the map, rising.
    differences : complex array (n, k)
        r there.
    """

    stiffness: FloatArray
    damping: FloatArray
    times: FloatArray
    natural: FloatArray
    passing: FloatArray
    frequencies: FloatArray
    differences: ComplexArray

    def compliance(self, s: ComplexArray) -> ComplexArray:
        """Complex compliance of the film solver at frequencies s (m,) [1/s], shape (m, n) [m2/N]."""
        return np.asarray((1.0 + self._difference(s)) / law_stiffness(self.stiffness, self.damping, self.times, s))

    def doubt(self, s: ComplexArray) -> FloatArray:
        """Possible error of r as it is read, shape (m, n)."""
        return by_powers(np.abs(np.multiply.outer(s, self.natural)), _PLACES, _DOUBT)

    @cached_property
    def _knots(self) -> FloatArray:
        """Places of the spline."""
        return np.concatenate([[0.0], self.frequencies])

    @cached_property
    def _cubics(self) -> ComplexArray:
        """Coefficients of r exp(i W t/T), highest power first, shape (4, k, n)."""
        ratio = self.passing / self.natural
        turned = self.differences.T * np.exp(1j * np.multiply.outer(self.frequencies, ratio))
        values = np.concatenate([np.zeros((1, ratio.size)), turned])
        flat = np.zeros_like(values[0])
        return np.asarray(CubicSpline(self._knots, values, bc_type=((1, flat), (2, flat))).c)

    def _difference(self, s: ComplexArray) -> ComplexArray:
        """r at frequencies s (m,), shape (m, n)."""
        place = np.multiply.outer(s / 1j, self.natural)
        size, last = np.abs(place), self._knots[-1]
        place = place * np.where(size > last, last / np.where(size > last, size, 1.0), 1.0)
        cell: IntArray = np.clip(np.searchsorted(self._knots, np.abs(place)) - 1, 0, self._knots.size - 2)
        along = place - self._knots[cell]
        value = np.zeros_like(place)
        for power in self._cubics:
            value = value * along + power[cell, np.arange(self.natural.size)]
        return np.asarray(value * np.exp(-1j * place * self.passing / self.natural))


@dataclass(frozen=True, eq=False)
class FilmResponse:
    """Part that the law of one contact or several in series leaves out, at some loads.

    Attributes
    ----------
    stiffness, damping, times : array (n,)
        Law of all contacts together: k [N/m2], c [N s/m2] and relaxation time [s].
    contacts : tuple of FilmsOfContact
        The contacts.
    """

    stiffness: FloatArray
    damping: FloatArray
    times: FloatArray
    contacts: tuple[FilmsOfContact, ...]

    def correction(self, s: ComplexArray) -> ComplexArray:
        """Relative correction of the complex stiffness of the law to that of the film solver.

        Parameters
        ----------
        s : complex array (m,)
            Frequencies [1/s], such as i omega.

        Returns
        -------
        complex array (m, n)
            Z/Z_law - 1 at each frequency and load.
        """
        whole = np.sum([contact.compliance(s) for contact in self.contacts], axis=0)
        return np.asarray(1.0 / (law_stiffness(self.stiffness, self.damping, self.times, s) * whole) - 1.0)

    def doubt(self, s: ComplexArray) -> FloatArray:
        """Possible error of `correction`, shape (m, n): that of 95 of 100 contacts."""
        return np.asarray(np.max([contact.doubt(s) for contact in self.contacts], axis=0))


def law_stiffness(k: FloatArray, c: FloatArray, times: FloatArray, s: ComplexArray) -> ComplexArray:
    """Complex stiffness k + s c/(1 + s theta) of a law with memory, shape (m, n).

    Parameters
    ----------
    k, c, times : array (n,)
        Stiffness, damping and relaxation time theta [s].
    s : complex array (m,)
        Frequencies [1/s].
    """
    rate = s[:, None]
    return np.asarray(k + rate * c / (1.0 + rate * times))

"""Films of a ball's contact over frequency, as springs in series with dampers beside the stiffness of slow motion.

The film table of points holds k and c at five natural frequencies Omega = omega sqrt(a^2 + 2 h Rx)/u from 1/2 to 8.
Beside k of slow motion a contact has dampers c_r in series with springs c_r/theta_r,

    Z(s) = k + sum_r s c_r/(1 + s theta_r),    c_r >= 0,    sum_r c_r = c,

so that slow motion is exact and energy is taken up at every frequency. The theta_r are given, `TIMES`; the c_r are the
non-negative ones whose Z is closest to the table's, by least squares of the relative difference. Above Omega = 8
nothing is known: Z tends to a stiffness. Between loads the parts of c are straight over ln of the load.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray
from ehdmaps.table.points.films import PointFilms

TIMES = np.array([0.01, 0.16, 1.0])
"""The times theta_r of all contacts in that of the natural frequency 1. Of all threes on a grid of five in a decade
none is much better for 95 of 100 loaded contacts; others are worse for those that hardly carry."""


class Springs(NamedTuple):
    """Dampers in series with springs, of contacts at some loads.

    Attributes
    ----------
    shares : array (n, r)
        Parts of the damping of slow motion, their sum is one.
    times : array (n, r)
        theta [s].
    """

    shares: FloatArray
    times: FloatArray


@dataclass(frozen=True, eq=False)
class ContactResponse:
    """Response of a contact over frequency, at one speed and temperature.

    Attributes
    ----------
    loads : array (n,)
        Loads, rising [N].
    films : PointFilms
        Films there.
    """

    loads: FloatArray
    films: PointFilms

    def springs(self, load: FloatArray) -> Springs:
        """Dampers in series with springs at loads (k,) [N]; beyond the ends those of the ends.

        Parameters
        ----------
        load : array (k,)
            Loads [N], > 0.
        """
        places, asked = np.log(self.loads), np.log(load)
        shares = np.stack([np.interp(asked, places, column) for column in self._shares.T], axis=1)
        unit = np.exp(np.interp(asked, places, np.log(self._unit)))
        return Springs(shares, np.multiply.outer(unit, TIMES))

    def bounds(self, load: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Errors that the table states of slow motion at loads: of k and c, as parts of them, and of the film [m].

        Parameters
        ----------
        load : array (n,)
            Loads, > 0 [N]; beyond the ends errors are those of the ends.
        """
        places, asked, films = np.log(self.loads), np.log(load), self.films
        stated = (films.errors["stiffness"], films.errors["damping"], films.errors["film_offset"] * films.film_offset)
        stiffness, damping, film = (np.interp(asked, places, part) for part in stated)
        return stiffness, damping, film

    @cached_property
    def misfit(self) -> FloatArray:
        """Largest |dZ/Z| at the frequencies of the table, of each load (n,)."""
        columns, left = self._relative
        return np.asarray(np.abs((columns @ self._shares[:, :, None])[..., 0] - left).max(axis=1))

    @cached_property
    def stated(self) -> FloatArray:
        """Largest error of Z there that the table states, as a part of it, of each load (n,)."""
        films = self.films
        size = np.abs(self._held)
        stiffness = films.errors["response_stiffness"] * films.response_stiffness
        return np.asarray((np.hypot(stiffness, films.errors["response_damping"] * self._held.imag) / size).max(axis=1))

    @property
    def _unit(self) -> FloatArray:
        """Time of the natural frequency 1 [s]; the first one that the table holds is a half."""
        return np.asarray(0.25 / (np.pi * self.films.frequencies[:, 0]))

    @cached_property
    def _held(self) -> ComplexArray:
        """Z of the table, (n, 5)."""
        films = self.films
        return np.asarray(films.response_stiffness + 2j * np.pi * films.frequencies * films.response_damping)

    @cached_property
    def _relative(self) -> tuple[ComplexArray, ComplexArray]:
        """Z of each damper alone (n, 5, r), and Z less k (n, 5), as parts of Z."""
        s, size = 2j * np.pi * self.films.frequencies[..., None], np.abs(self._held)
        times = (self._unit[:, None] * TIMES)[:, None, :]
        columns = s * self.films.damping[:, None, None] / (1.0 + s * times) / size[..., None]
        return columns, (self._held - self.films.stiffness[:, None]) / size

    @cached_property
    def _shares(self) -> FloatArray:
        """Parts of c (n, r): the best of those with each choice of dampers that are none, and none negative."""
        columns, left = self._relative
        matrix, right = np.concatenate([columns.real, columns.imag], 1), np.concatenate([left.real, left.imag], 1)
        best, error = np.zeros((self.loads.size, TIMES.size)), np.full(self.loads.size, np.inf)
        for count in range(1, TIMES.size + 1):
            for chosen in itertools.combinations(range(TIMES.size), count):
                found = np.zeros_like(best)
                found[:, chosen] = _of_sum_one(matrix[..., chosen], right)
                wrong = np.sum(((matrix @ found[:, :, None])[..., 0] - right) ** 2, axis=1)
                better: BoolArray = np.all(found >= 0.0, axis=1) & (wrong < error)
                best[better], error[better] = found[better], wrong[better]
        return best


def _of_sum_one(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Least squares of matrices (n, m, r) whose unknowns (n, r) have the sum one."""
    last = matrix[..., -1:]
    rest, left = matrix[..., :-1] - last, right - last[..., 0]
    across = np.swapaxes(rest, 1, 2)
    found = np.linalg.solve(across @ rest, across @ left[..., None])[..., 0]
    return np.concatenate([found, 1.0 - found.sum(axis=1, keepdims=True)], axis=1)

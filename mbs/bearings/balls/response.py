"""Films of a ball's contact over frequency, as springs in series with dampers beside the stiffness of slow motion.

The film table of points holds k and c at five natural frequencies Omega = omega sqrt(a^2 + 2 h Rx)/u from 1/2 to 8.
Beside k of slow motion a contact has dampers c_r in series with springs c_r/theta_r,

    Z(s) = k + sum_r s c_r/(1 + s theta_r),    c_r >= 0,    sum_r c_r = c,

so that slow motion is exact and energy is taken up at every frequency. The theta_r are given, `TIMES`; the c_r are the
non-negative ones whose Z is closest to the table's, by least squares of the relative difference. Above Omega = 8
nothing is known: Z tends to a stiffness. Between loads the parts of c are straight over ln of the load.
"""

from __future__ import annotations

import dataclasses
import itertools
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import BoolArray, ComplexArray, FloatArray
from ehdmaps.table.points.films import PointFilms

TIMES = np.array([0.01, 0.16, 1.0])
"""The times theta_r of all contacts in that of the natural frequency 1. Of all threes on a grid of five in a decade
none is much better for 95 of 100 loaded contacts; others are worse for those that hardly carry."""

SHORTER = tuple(float(time / TIMES[-1]) for time in TIMES)
"""The same over the longest one."""


_FINE = np.geomspace(0.0625, 8.0, 57)
"""Natural frequencies at which it is worked out what springs and dampers leave out."""


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

    def with_errors(self, stiffness: FloatArray, damping: FloatArray) -> ContactResponse:
        """The same response with larger errors of slow motion.

        Parameters
        ----------
        stiffness, damping : array (n,)
            What comes to the errors of k and film offset, and of c.
        """
        errors = dict(self.films.errors)
        for name, more in (("stiffness", stiffness), ("film_offset", stiffness), ("damping", damping)):
            errors[name] = errors[name] + more
        return ContactResponse(self.loads, dataclasses.replace(self.films, errors=errors))

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

    def in_time(self, load: FloatArray, damping: FloatArray) -> FloatArray:
        """Springs K_r [N/m] and the longest of their times [s] at loads, shape (n, r + 1).

        Parameters
        ----------
        load, damping : array (n,)
            Load [N] and damping of slow motion [N s/m].
        """
        found = self.springs(np.maximum(load, 1e-300))
        return np.column_stack([found.shares * damping[:, None] / found.times, found.times[:, -1]])

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

    def left_out(self, load: FloatArray, s: ComplexArray) -> tuple[ComplexArray, FloatArray]:
        """Part of Z that springs and dampers leave out of the table's, and its possible error, as parts of Z.

        k and c of the table are cubics over ln(1 + Omega^2), as in `ehdmaps.table.points.response`. The possible error
        is what the table states of Z beyond its errors of k and c of slow motion, and what a cubic without the nearest
        frequency says otherwise. Above the last frequency the part is held, and the error grows so that both together
        are in proportion to Omega: an assumption.

        Parameters
        ----------
        load : array (n,)
            Loads, > 0 [N]; beyond the ends those of the ends.
        s : array (k,)
            Complex frequencies [1/s]; parts are those of their size on the imaginary axis.

        Returns
        -------
        array, array
            Shape (k, n) each.
        """
        loads, asked = np.log(self.loads), np.log(load)
        part, doubt = (
            np.stack([np.interp(asked, loads, column) for column in given.T], axis=1) for given in self._left_out
        )
        unit = np.exp(np.interp(asked, loads, np.log(self._unit)))
        place = np.multiply.outer(np.abs(s), unit)
        along = np.log(np.clip(place, _FINE[0], _FINE[-1]) / _FINE[0]) / np.log(_FINE[1] / _FINE[0])
        cell = np.minimum(along.astype(np.int64), _FINE.size - 2)
        weight, column = np.minimum(along - cell, 1.0), np.arange(load.size)
        missing, possible = (
            (1.0 - weight) * one[column, cell] + weight * one[column, cell + 1] for one in (part, doubt)
        )
        below, beyond = np.minimum(place / _FINE[0], 1.0) ** 2, np.maximum(place / _FINE[-1], 1.0)
        error = below * possible.real * beyond + np.abs(missing) * (beyond - 1.0)
        return np.asarray(below * missing), np.asarray(error)

    @cached_property
    def _left_out(self) -> tuple[ComplexArray, FloatArray]:
        """Parts and possible errors of `left_out` at the loads, at the natural frequencies of `_FINE`, (n, f) each."""
        films, errors = self.films, self.films.errors
        held = np.r_[0.0, 2.0 * np.pi * films.frequencies[0] * self._unit[0]]
        nodes, places = np.log1p(held**2), np.log1p(_FINE**2)
        nearest = np.clip(np.argmin(np.abs(nodes[:, None] - places), axis=0), 1, nodes.size - 2)
        omega = _FINE / self._unit[:, None]
        read, wrong, slow = [], [], []
        for name in ("stiffness", "damping"):
            at_rest, moving = getattr(films, name), getattr(films, f"response_{name}")
            values = np.column_stack([at_rest, moving])
            stated = np.abs(values) * np.column_stack([errors[name], errors[f"response_{name}"]])
            found = CubicSpline(nodes, values, axis=1)(places)
            otherwise = found.copy()
            for node in range(1, nodes.size - 1):
                rest, on = np.delete(np.arange(nodes.size), node), nearest == node
                otherwise[:, on] = CubicSpline(nodes[rest], values[:, rest], axis=1)(places[on])
            at_node = np.isclose(places[:, None], nodes).any(axis=1)
            apart = np.where(at_node, 0.0, np.abs(found - otherwise))
            read.append(found)
            wrong.append(np.array([np.interp(places, nodes, row) for row in stated]) + apart)
            slow.append(stated[:, :1])
        table = read[0] + 1j * omega * read[1]
        place = (1j * _FINE)[:, None]
        own = films.stiffness[:, None] + (films.damping / self._unit)[:, None] * (
            self._shares @ (place / (1.0 + place * TIMES)).T
        )
        doubt = np.hypot(wrong[0], omega * wrong[1]) - np.hypot(slow[0], omega * slow[1])
        return np.asarray(table / own - 1.0), np.asarray(np.maximum(doubt, 0.0) / np.abs(table))

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

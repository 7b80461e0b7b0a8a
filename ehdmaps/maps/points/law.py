"""Contact law of a ball: load over approach, rate, entrainment speed and temperature, read from the table of points.

At one speed and temperature the table gives the film offset h and damping c over the load F, so that

    approach = Hertz(F) - h(F),    load = F(approach) + c(F) rate,

never a tension. Between the loads that are read, h and c/k^2 are cubics in the logarithms (between rough surfaces h is
one itself, as the distance of the mean planes may be below zero); below the lightest and above the heaviest one they go
on straight. `series` is a ball between both raceways in line, without mass: approaches add,
and so do 1/k and c/k^2.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, MapError, OutsideMapError
from ehdmaps.maps.points.layers import PointPlace, films_under
from ehdmaps.physics.heat import heat_data
from ehdmaps.physics.hertz import POINT_LIMIT
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import PLAIN, FilmConditions
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.table.points.file import shipped_point_table
from ehdmaps.table.points.films import PointFilms

KINDS = ("series", "inner", "outer")

LIGHTEST = 1e-3
"""Lightest load that is read [N]; the heaviest one has the Hertz pressure of the static limit."""

_LOADS, _NEWTON, _NEAR = 240, 60, 1e-13
_KEPT = 64


@dataclass(frozen=True, eq=False)
class PointLawAt:
    """The law at one entrainment speed and temperature.

    Attributes
    ----------
    loads : ndarray, shape (n,)
        Loads that were read [N].
    films : tuple of PointFilms
        Films of the contacts in series at these, with errors and status.
    contacts : tuple of Ellipse
        The dry contacts.
    """

    loads: FloatArray
    films: tuple[PointFilms, ...]
    contacts: tuple[Ellipse, ...]

    def __post_init__(self) -> None:
        places, offsets = np.log(self.loads), [film.film_offset for film in self.films]
        logs = all(bool(np.all(offset > 0.0)) for offset in offsets)
        curves = [
            CubicSpline(
                places, np.column_stack([np.log(offset) if logs else offset, np.log(film.loss_compliance)]), axis=0
            )
            for offset, film in zip(offsets, self.films, strict=True)
        ]
        object.__setattr__(self, "_curves", curves)
        object.__setattr__(self, "_logs", logs)
        object.__setattr__(self, "_approaches", self.static(self.loads)[0])

    def static(self, load: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Approach [m], compliance 1/k [m/N] and loss compliance c/k^2 [m s/N] at loads, each (k,).

        Parameters
        ----------
        load : ndarray, shape (k,)
            F [N], > 0.
        """
        places = np.log(load)
        inside = np.clip(places, np.log(self.loads[0]), np.log(self.loads[-1]))
        approach, compliance, loss = (np.zeros(load.size) for _ in range(3))
        for contact, curve in zip(self.contacts, self._curves, strict=True):  # type: ignore[attr-defined]
            slopes = curve(inside, 1)
            values = curve(inside) + slopes * (places - inside)[:, None]
            offset = np.exp(values[:, 0]) if self._logs else values[:, 0]  # type: ignore[attr-defined]
            by_log = slopes[:, 0] * offset if self._logs else slopes[:, 0]  # type: ignore[attr-defined]
            approach += contact.approach(load) - offset
            compliance += 1.0 / np.asarray(contact.stiffness(load)) - by_log / load
            loss += np.exp(values[:, 1])
        return approach, compliance, loss

    def __call__(self, delta: npt.ArrayLike, rate: npt.ArrayLike) -> tuple[Any, Any, Any]:
        """Load [N] and its derivatives by approach [N/m] and rate [N s/m], in the shape of both.

        Parameters
        ----------
        delta, rate : float or ndarray
            Approach [m] and its rate [m/s].
        """
        shape, (wanted, speeds) = _flat(delta, rate)
        places = self._inverted(wanted)
        load = np.exp(places)
        _, compliance, loss = self.static(load)
        # c and its change with the load, by a small step: both curves are smooth
        step = 1e-5
        _, more, lossy = self.static(load * np.exp(step))
        stiffness, damping = 1.0 / compliance, loss / compliance**2
        change = (lossy / more**2 - damping) / (load * np.expm1(step))
        total = load + damping * speeds
        slope = stiffness * (1.0 + change * speeds)
        pulled = total < 0.0
        total, slope, damping = (np.where(pulled, 0.0, x) for x in (total, slope, damping))
        force, by_delta, by_rate = (x.reshape(shape)[()] for x in (total, slope, damping))
        return force, by_delta, by_rate

    def _inverted(self, wanted: FloatArray) -> FloatArray:
        """ln F of approaches."""
        places = np.log(self.loads)
        approaches: FloatArray = self._approaches  # type: ignore[attr-defined]
        found = np.interp(wanted, approaches, places)
        for _ in range(_NEWTON):
            load = np.exp(found)
            approach, compliance, _ = self.static(load)
            # a rigid contact is a power of the film, an elastic one of the approach: steps in ln F are kept short
            step = np.clip((wanted - approach) / (compliance * load), -1.0, 1.0)
            found = found + step
            if np.max(np.abs(step), initial=0.0) < _NEAR:
                break
        return found


@dataclass(frozen=True)
class DryLawAt:
    """The law of surfaces at rest: Hertz in series, no damping.

    Attributes
    ----------
    contacts : tuple of Ellipse
        The dry contacts.
    """

    contacts: tuple[Ellipse, ...]

    def __call__(self, delta: npt.ArrayLike, rate: npt.ArrayLike) -> tuple[Any, Any, Any]:
        """Load [N] and its derivatives, see `PointLawAt`.

        Parameters
        ----------
        delta, rate : float or ndarray
            Approach [m] and its rate [m/s].
        """
        shape, (wanted, _) = _flat(delta, rate)
        unit = sum(float(contact.approach(1.0)) for contact in self.contacts)
        share = np.maximum(wanted, 0.0) / unit
        load, by_delta = share**1.5, 1.5 * np.sqrt(share) / unit
        return load.reshape(shape)[()], by_delta.reshape(shape)[()], np.zeros(shape)[()]


class PointLaw:
    """Load of a ball's contact, or of a ball between both raceways, over approach, rate, speed and temperature.

    Make one by `ehdmaps.law("6208", "FVA3")`. It rises with the approach, and is never a tension.

    Parameters
    ----------
    geometry : BallGeometry
        The bearing.
    lubricant : Lubricant
        The oil.
    kind : {"series", "inner", "outer"}
        Contact, or the ball between both.
    material : Material
        Material of balls and rings.
    conditions : FilmConditions
        Heat in the inlet, oil supply and surfaces.

    Raises
    ------
    InputError
        For another kind, and for heat of an oil whose conductivity is not known.
    """

    def __init__(
        self,
        geometry: BallGeometry,
        lubricant: Lubricant,
        kind: str = "series",
        material: Material = STEEL,
        conditions: FilmConditions = PLAIN,
    ) -> None:
        if kind not in KINDS:
            raise InputError(f"contact law of a ball, kind: got {kind!r:.40}; allowed: {', '.join(KINDS)}")
        inner, outer = geometry.contacts(material)
        if conditions.inlet_heat:
            heat_data(lubricant, material)
        self.geometry, self.lubricant, self.kind, self.conditions = geometry, lubricant, kind, conditions
        self.contacts: tuple[Ellipse, ...] = {"series": (inner, outer), "inner": (inner,), "outer": (outer,)}[kind]
        self.at = lru_cache(maxsize=_KEPT)(self._at)

    def _at(self, entrainment_speed: float, temperature: float) -> PointLawAt | DryLawAt:
        """The law at one speed and temperature.

        Parameters
        ----------
        entrainment_speed : float
            u [m/s], >= 0.
        temperature : float
            T [K].

        Raises
        ------
        OutsideMapError
            Where the table has no films: with the reason.
        """
        if entrainment_speed == 0.0:
            return DryLawAt(self.contacts)
        heaviest = min(float((POINT_LIMIT / contact.max_pressure(1.0)) ** 3) for contact in self.contacts)
        loads, heat = np.geomspace(LIGHTEST, heaviest, _LOADS), self.conditions.inlet_heat
        films_at, at = shipped_point_table().films, (entrainment_speed, temperature, heat)
        read = [films_at(one, self.lubricant, loads, *at) for one in self.contacts]
        usable = np.all([film.usable & (film.film_offset > 0.0) for film in read], axis=0)
        first = _LOADS - int(np.argmin(np.r_[usable[::-1], False]))  # of those without a gap up to the heaviest
        if _LOADS - first < _LOADS // 4:
            reasons = {str(reason) for film in read for reason in film.reason[~usable]}
            raise OutsideMapError(
                f"contact law of a ball: {entrainment_speed:.4g} m/s, {temperature:.5g} K: {'; '.join(sorted(reasons))}"
            )
        kept = loads[first:]
        films = tuple(
            films_under(
                PointPlace(one, self.lubricant, *at[:2]),
                self.conditions,
                kept,
                films_at(one, self.lubricant, kept, *at),
            )
            for one in self.contacts
        )
        found = PointLawAt(kept, films, self.contacts)
        if not np.all(np.diff(found.static(kept)[0]) > 0.0):
            raise MapError("contact law of a ball: the approach falls with the load; take another speed or temperature")
        return found

    def __call__(
        self,
        delta: npt.ArrayLike,
        rate: npt.ArrayLike,
        entrainment_speed: npt.ArrayLike,
        temperature: npt.ArrayLike,
    ) -> tuple[Any, Any, Any]:
        """Load and its derivatives; every pair of speed and temperature is read once.

        Parameters
        ----------
        delta, rate : float or ndarray
            Approach [m] and its rate [m/s]; for `series` of both contacts together.
        entrainment_speed, temperature : float or ndarray
            u [m/s], of either sign, and T [K].

        Returns
        -------
        load, by_delta, by_rate : float or ndarray
            [N], [N/m], [N s/m], in the shape to which the arguments broadcast.

        Raises
        ------
        InputError
            For arguments that are no finite numbers.
        OutsideMapError
            Where the table has no films.
        """
        shape, (d, v, u, T) = _flat(delta, rate, entrainment_speed, temperature)
        forces = np.empty((3, d.size))
        pairs, index = np.unique(np.column_stack([np.abs(u), T]), axis=0, return_inverse=True)
        for k, (speed, degrees) in enumerate(pairs):
            here = index.ravel() == k
            forces[:, here] = self.at(float(speed), float(degrees))(d[here], v[here])
        load, by_delta, by_rate = (x.reshape(shape)[()] for x in forces)
        return load, by_delta, by_rate


def _flat(*values: npt.ArrayLike) -> tuple[tuple[int, ...], list[FloatArray]]:
    """Shape to which arguments broadcast, and each of them flat."""
    arrays = np.broadcast_arrays(*(np.asarray(value, dtype=float) for value in values))
    if not all(np.all(np.isfinite(array)) for array in arrays):
        raise InputError("contact law of a ball: got an argument that is no finite number; allowed: finite numbers")
    return arrays[0].shape, [np.asarray(array, dtype=float).ravel() for array in arrays]

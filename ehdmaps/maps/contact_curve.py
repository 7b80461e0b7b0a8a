"""Approach and damping of one contact over load: mapped range, low-load tail, continuation above.

The curves are over g = w^(1/3), the cube root of the load. At the end of the tail, where the load goes to zero as
the cube of the approach, everything is smooth in g, through zero and on to negative g, where there is no load.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import MapError
from ehdmaps.maps.film_field import FilmField
from ehdmaps.maps.tail import Tail
from ehdmaps.physics.contact import LineContact

_SMALL_STEP = 1e-4


@dataclass(frozen=True)
class Curve:
    """Samples of a curve over g = w^(1/3); the sum of two curves is two contacts in series.

    Attributes
    ----------
    approach : array (n, n_u, n_T)
        delta [m].
    slope : array (n, n_u, n_T)
        d(delta)/dg [m/(N/m)^(1/3)], positive and finite also where the stiffness vanishes.
    loss_ratio : array (n, n_u, n_T)
        c/w [s/m], positive.
    """

    approach: FloatArray
    slope: FloatArray
    loss_ratio: FloatArray

    def __add__(self, other: Curve) -> Curve:
        """Contacts in series at equal load: approaches add, the rate divides as the slopes do."""
        slope = self.slope + other.slope
        ratio = self.loss_ratio * (self.slope / slope) ** 2 + other.loss_ratio * (other.slope / slope) ** 2
        return Curve(self.approach + other.approach, slope, ratio)


@dataclass(frozen=True)
class _Edge:
    """Film at one end of the load range: offset h, compliance s, damping c, n = d ln c/d ln w; (n_u, n_T) each."""

    load: FloatArray
    film_offset: FloatArray
    film_compliance: FloatArray
    damping: FloatArray
    damping_exponent: FloatArray


class ContactCurve:
    """Approach, its slope and c/w of one contact over g, at each pair of speed and temperature.

    Parameters
    ----------
    field : FilmField
        Where the film comes from.
    contact : LineContact
        Its structural law.
    speeds, temperatures : array (n_u,), (n_T,)
        Entrainment speeds [m/s], > 0, and temperatures [K].

    Raises
    ------
    MapError
        If the approach does not rise with load, or a damping is not positive.
    """

    def __init__(self, field: FilmField, contact: LineContact, speeds: FloatArray, temperatures: FloatArray) -> None:
        self._field = field
        self._contact = contact
        self._speeds = speeds
        self._temperatures = temperatures
        self._first = field.first_loads(speeds, temperatures)
        low, self._high = self._edge(self._first, 1.0), self._edge(np.full_like(self._first, field.load_range[1]), -1.0)
        self._tail = Tail(
            self._first, low.film_offset, low.film_compliance, low.damping, low.damping_exponent, contact.radius
        )

    @property
    def first_load(self) -> FloatArray:
        """Load below which the tail holds [N/m], (n_u, n_T)."""
        return self._first

    @property
    def fade_load(self) -> FloatArray:
        """Load below which the tail fades out [N/m], (n_u, n_T)."""
        return self._tail.fade_load

    def below(self, root: FloatArray) -> Curve:
        """Tail: at and below the first load; `root` is g (n, n_u, n_T)."""
        film, film_slope, log_ratio = self._tail.films(root)
        load = np.maximum(root, 0.0) ** 3
        with np.errstate(invalid="ignore"):
            dry_slope = np.where(root > 0.0, 3.0 * root**2 * self._contact.structural_compliance(load), 0.0)
        curve = Curve(self._contact.structural_approach(load) - film, dry_slope - film_slope, np.exp(log_ratio))
        return self._checked(curve, load)

    def mapped(self, load: FloatArray) -> Curve:
        """From the first load to the highest one of the map [N/m], (n, n_u, n_T)."""
        film, film_compliance, loss = self._field.films(self._contact.name, load, self._speeds, self._temperatures)
        compliance = self._contact.structural_compliance(load) + film_compliance
        curve = Curve(
            self._contact.structural_approach(load) - film,
            3.0 * np.cbrt(load) ** 2 * compliance,
            loss / compliance**2 / load,
        )
        return self._checked(curve, load)

    def above(self, load: FloatArray) -> Curve:
        """Above the mapped loads: film offset and c go on with their exponents at the end of the map."""
        edge = self._high
        ratio = load / edge.load
        exponent = -edge.film_compliance * edge.load / edge.film_offset
        film = edge.film_offset * ratio**exponent
        compliance = self._contact.structural_compliance(load) - exponent * film / load
        curve = Curve(
            self._contact.structural_approach(load) - film,
            3.0 * np.cbrt(load) ** 2 * compliance,
            edge.damping * ratio**edge.damping_exponent / load,
        )
        return self._checked(curve, load)

    def _edge(self, load: FloatArray, direction: float) -> _Edge:
        """Film and damping at an end of the range; the exponent of c from inside it, to second order."""
        loads = load * np.exp(direction * _SMALL_STEP * np.arange(3.0))[:, None, None]
        film, film_compliance, loss = self._field.films(self._contact.name, loads, self._speeds, self._temperatures)
        damping = loss / (self._contact.structural_compliance(loads) + film_compliance) ** 2
        logs = np.log(damping)
        exponent = direction * (-1.5 * logs[0] + 2.0 * logs[1] - 0.5 * logs[2]) / _SMALL_STEP
        return _Edge(load, film[0], film_compliance[0], damping[0], exponent)

    def _checked(self, curve: Curve, load: FloatArray) -> Curve:
        """Refuse what no law can be made from."""
        for values, what in ((curve.slope, "stiffness"), (curve.loss_ratio, "damping")):
            wrong = ~(values > 0.0)  # NaN too
            if bool(np.any(wrong)):
                i, j, k = (int(index[0]) for index in np.nonzero(wrong))
                raise MapError(
                    f"law of the contact {self._contact.name!r}: its {what} is not positive at "
                    f"{load[i, j, k]:.4g} N/m, {self._speeds[j]:.4g} m/s, {self._temperatures[k]:.2f} K; "
                    "a law needs a positive one everywhere; look at that part of the map, "
                    "solve it again with a finer grid"
                )
        return curve

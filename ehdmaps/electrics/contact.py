"""Capacitance and breakdown of lubricated contacts: by the film tables, or by films that are known.

C = eps0 (eps_p zone + eps (beside - full outlet + what is left of it)): the zone has the oil under pressure. The band
is that of the outlet, from gas alone to oil everywhere, and of the errors of rule and films.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.electrics.dielectric import FIELDS, OUTLETS, VACUUM, Dielectric, under_pressure
from ehdmaps.electrics.gaps import Integral, line_integral, point_integral
from ehdmaps.errors import InputError
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import Ellipse


@dataclass(frozen=True, eq=False)
class ContactElectrics:
    """Electric properties of contacts, arrays of the shape of the points; NaN where there is no film.

    Attributes
    ----------
    capacitance, low, high : array
        Capacitance and its band [F]; of lines a length [F/m].
    minimum_film : array
        Smallest film [m].
    time_constant : float
        R C [s]; NaN where no conductivity is known.
    """

    capacitance: FloatArray
    low: FloatArray
    high: FloatArray
    minimum_film: FloatArray
    time_constant: float

    @property
    def resistance(self) -> FloatArray:
        """R [ohm], of lines times a length; NaN where no conductivity is known."""
        return np.asarray(self.time_constant / self.capacitance)

    @property
    def breakdown(self) -> FloatArray:
        """Band of the voltage at which the film breaks down, (..., 2) [V]."""
        return np.asarray(self.minimum_film[..., None] * np.array(FIELDS))


def point_capacitance(
    ellipse: Ellipse,
    lubricant: Lubricant,
    load: npt.ArrayLike,
    speed: npt.ArrayLike,
    temperature: float,
    permittivity: float | Dielectric,
    outer_gap: float | None = None,
) -> ContactElectrics:
    """Capacitance of point contacts, by the films of the table of points.

    Parameters
    ----------
    ellipse : Ellipse
        The contact.
    lubricant : Lubricant
        The oil.
    load, speed : float or array
        Loads [N] and entrainment speeds [m/s], broadcast.
    temperature : float
        T [K].
    permittivity : float or Dielectric
        Relative permittivity at that temperature, or all that is known of the oil.
    outer_gap : float, optional
        Gap at which the oil ends [m]; that of the dielectric where it is left out.

    Raises
    ------
    InputError
        If no outer gap is given, or there is no such permittivity.

    Examples
    --------
    >>> found = point_capacitance(Ellipse(5e-3, 5e-3, 231e9), Lubricant.named("FVA3"), 200.0, 2.0, 333.15, 2.2, 1e-4)
    >>> bool(15e-12 < found.low < found.capacitance < found.high < 30e-12)
    True
    """
    from ehdmaps.table.points.file import shipped_point_table  # with the table

    oil = permittivity if isinstance(permittivity, Dielectric) else Dielectric(permittivity)
    gap = oil.outer_gap if outer_gap is None else outer_gap
    if gap is None:
        raise InputError("point contact, outer gap: got none; allowed: the gap at which the oil ends [m], > 0")
    F, u = np.broadcast_arrays(np.asarray(load, dtype=float), np.asarray(speed, dtype=float))
    films = shipped_point_table().films(ellipse, lubricant, F, u, temperature)
    known = films.central_film > 0.0
    central, minimum, offset = (x[known] for x in (films.central_film, films.minimum_film, films.film_offset))
    whole = point_integral(ellipse, F[known], central, minimum, offset, gap)
    # the logarithm beside the zone moves by at most a relative change of the film
    wrong = films.errors["central_film"][known] + films.errors["film_offset"][known]
    pressure = np.asarray(ellipse.max_pressure(F[known]))
    zone = under_pressure(oil.at(lubricant, temperature), lubricant, temperature, pressure, "point")
    return _placed(electrics_of(whole, oil, lubricant, temperature, zone, wrong, films.minimum_film[known]), known)


def line_capacitance(
    contact: LineContact,
    lubricant: Lubricant,
    load: npt.ArrayLike,
    speed: npt.ArrayLike,
    temperature: float,
    permittivity: float | Dielectric,
) -> ContactElectrics:
    """Capacitance a length of line contacts, by the films of the film table.

    Parameters
    ----------
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil.
    load, speed : float or array
        Loads per length [N/m] and entrainment speeds [m/s], broadcast.
    temperature : float
        T [K].
    permittivity : float or Dielectric
        Relative permittivity at that temperature, or all that is known of the oil.

    Raises
    ------
    InputError
        If there is no such permittivity.
    """
    from ehdmaps.table.file import shipped_tables  # with the tables

    oil = permittivity if isinstance(permittivity, Dielectric) else Dielectric(permittivity)
    w, u = np.broadcast_arrays(np.asarray(load, dtype=float), np.asarray(speed, dtype=float))
    films = shipped_tables().of(lubricant).films(contact, lubricant, w, u, temperature)
    known = films.central_film > 0.0
    numbers = (w, films.central_film, films.minimum_film, films.film_offset)
    whole = line_integral(contact, *(x[known] for x in numbers))
    pressure = np.asarray(max_pressure(w[known], contact.radius, contact.reduced_modulus))
    zone = under_pressure(oil.at(lubricant, temperature), lubricant, temperature, pressure, "line")
    wrong = films.errors["central_film"][known] + films.errors["film_offset"][known]
    return _placed(electrics_of(whole, oil, lubricant, temperature, zone, wrong, films.minimum_film[known]), known)


def electrics_of(
    whole: Integral,
    oil: Dielectric,
    lubricant: Lubricant,
    temperature: float,
    zone: FloatArray,
    error: FloatArray | float,
    minimum: FloatArray,
) -> ContactElectrics:
    """Electric properties of contacts by their integrals.

    Parameters
    ----------
    whole : Integral
        Integral of dA/h.
    oil : Dielectric
        The oil as a dielectric.
    lubricant : Lubricant
        The oil.
    temperature : float
        T [K].
    zone : array (n,)
        Permittivity of the Hertz zone.
    error : array (n,) or float
        Relative error of the films.
    minimum : array (n,)
        Smallest films [m].
    """
    outside = oil.at(lubricant, temperature)
    full, *left = whole.outlet(outside)
    by_outlet = dict(zip(OUTLETS, (*left, full), strict=True))
    each = {
        name: VACUUM * (zone * whole.zone + outside * (whole.beside - full + part)) for name, part in by_outlet.items()
    }
    reach = whole.error + error
    return ContactElectrics(
        each[oil.outlet], each["gas"] * (1.0 - reach), each["oil"] * (1.0 + reach), minimum, oil.time_constant
    )


def _placed(found: ContactElectrics, known: npt.NDArray[np.bool_]) -> ContactElectrics:
    """Results in the shape of what was asked."""

    def whole(values: FloatArray) -> FloatArray:
        out = np.full(known.shape, np.nan)
        out[known] = values
        return out

    low, high, minimum = map(whole, (found.low, found.high, found.minimum_film))
    return ContactElectrics(whole(found.capacitance), low, high, minimum, found.time_constant)

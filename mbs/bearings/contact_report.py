"""What the contacts of a bearing feel at the loads of its rollers, and where that leaves what the laws hold for."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.maps.kernel import LOAD_TOLERANCE
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.peak import tip_words
from ehdmaps.physics.thermal import inlet_shear_heating_factor, thermal_loading, viscosity_slope
from ehdmaps.units import LOAD, PRESSURE, SPEED, TEMPERATURE
from mbs.bearings.bearing import STATIC_LIMIT
from mbs.bearings.films import SIDES, ContactState, FilmSource
from mbs.bearings.laws import DryLaw, Law
from mbs.bearings.roller_loads import RollerLoads
from mbs.bearings.table_law import TableLaw


@dataclass(frozen=True, eq=False)
class BearingContacts:
    """Both contacts of all slices of all rollers.

    Attributes
    ----------
    inner, outer : ContactState
        Arrays (Z, n): rollers, slices.
    """

    inner: ContactState
    outer: ContactState

    @property
    def sides(self) -> tuple[ContactState, ContactState]:
        """Inner and outer, as in `SIDES`."""
        return self.inner, self.outer

    @property
    def hertz_pressure(self) -> FloatArray:
        """Largest Hertz pressure of each side, (2,) [Pa]."""
        return np.array([float(np.max(side.hertz_pressure)) for side in self.sides])

    @property
    def max_pressure(self) -> FloatArray:
        """Largest pressure of each side, (2,) [Pa]."""
        return np.array([float(np.max(side.max_pressure)) for side in self.sides])

    @property
    def central_film(self) -> FloatArray:
        """Smallest central film of each side, (2,) [m]; NaN where no film is known."""
        return np.array([_smallest(side.central_film) for side in self.sides])

    @property
    def minimum_film(self) -> FloatArray:
        """Smallest film of each side, (2,) [m]; NaN where no film is known."""
        return np.array([_smallest(side.minimum_film) for side in self.sides])


def bearing_contacts(
    films: FilmSource,
    rollers: RollerLoads,
    entrainment_speed: float,
    temperature: float,
    centrifugal_load: float = 0.0,
) -> BearingContacts:
    """Pressures and films at the loads of all slices.

    Parameters
    ----------
    films : FilmSource
        What knows them.
    rollers : RollerLoads
        Loads on the inner raceway.
    entrainment_speed, temperature, centrifugal_load : float
        u [m/s], T [K], q [N/m]; the outer raceway carries q besides.
    """
    inner = rollers.load_per_length
    outer = np.maximum(inner + centrifugal_load, 0.0)
    return BearingContacts(
        films.state(0, inner, entrainment_speed, temperature), films.state(1, outer, entrainment_speed, temperature)
    )


def overload(contacts: BearingContacts) -> str:
    """A sentence where a pressure is beyond the static limit; empty otherwise."""
    found = contacts.hertz_pressure
    worst = int(np.argmax(found))
    if found[worst] <= STATIC_LIMIT:
        return ""
    return (
        f"Hertz pressure of {PRESSURE.text(found[worst])} ({SIDES[worst]} raceway) is above "
        f"{PRESSURE.text(STATIC_LIMIT)}, the static limit of ISO 76: permanent deformation; elastic contacts and films "
        "no longer hold"
    )


def extrapolated(contacts: BearingContacts, oil: Lubricant | None) -> str:
    """A sentence where the viscosity is used above the pressures to which it holds; empty otherwise."""
    highest = float(np.max(contacts.max_pressure))
    if oil is None or not math.isfinite(_smallest(contacts.central_film)) or highest <= oil.fitted_pressure:
        return ""
    return (
        f"the viscosity of {oil.title} is extrapolated above {PRESSURE.text(oil.fitted_pressure)} "
        f"(largest pressure {PRESSURE.text(highest)})"
        + ("; that its law reaches so far is assumed, not stated" if oil.reach_assumed else "")
    )


def spike_tip(contacts: BearingContacts) -> str:
    """A sentence where the largest pressure is that of a sharp spike, whose tip stands higher; empty otherwise."""
    errors = [side.pressure_error.flat[int(np.argmax(side.max_pressure))] for side in contacts.sides]
    return tip_words(float(np.max(np.nan_to_num(errors))))


def outside_map(law: Law, load: float, entrainment_speed: float, temperature: float) -> list[str]:
    """Which axis of a law's map a point leaves, with its value, what is done there, and what to do.

    Parameters
    ----------
    law : Law
        The law of a contact.
    load : float
        w [N/m].
    entrainment_speed : float
        u [m/s].
    temperature : float
        T [K].
    """
    fate = "where the law is held at its edge; make a map that reaches there"
    if isinstance(law, TableLaw):
        fate = "where the law goes on straight; add points that reach there"
    return [f"{axis}, {fate}" for axis in axes_left(law, load, entrainment_speed, temperature)]


def axes_left(law: Law, load: float, entrainment_speed: float, temperature: float) -> list[str]:
    """Which axis of a law's map a point leaves, with its value; a film that fades to rest is inside.

    Parameters
    ----------
    law : Law
        Law of a map or formula, or by points; other dry laws have no end.
    load, entrainment_speed, temperature : float
        Largest load of a slice [N/m], u [m/s], T [K].
    """
    if isinstance(law, TableLaw):
        last = float(law.line_load[-1])
        above = load > last * (1.0 + LOAD_TOLERANCE)
        return [f"load per length of {LOAD.text(load)} is above the last point of the law, {LOAD.text(last)}"] * above
    if isinstance(law, DryLaw):
        return []
    axes = (
        ("load per length", load, (0.0, law.load_range[1]), law.load_range, LOAD),
        ("entrainment speed", abs(entrainment_speed), (0.0, law.speed_range[1]), law.speed_range, SPEED),
        ("temperature", temperature, law.temperature_range, law.temperature_range, TEMPERATURE),
    )
    return [
        f"{name} of {display.text(value)} is outside the map ({display.value(mapped[0]):.4g} to "
        f"{display.text(mapped[1])})"
        for name, value, (low, high), mapped, display in axes
        if not low - _near(low) <= value <= high + _near(high)
    ]


def fading(law: Law, entrainment_speed: float) -> str:
    """A sentence where the speed is below the map, so that the film fades to the dry contact; empty otherwise."""
    if isinstance(law, DryLaw) or not 0.0 < abs(entrainment_speed) < law.speed_range[0] * (1.0 - 1e-9):
        return ""
    fate = "stiffness and damping fade to those of dry contacts from there on"
    if not law.surface.smooth:
        fate = "the law goes on at constant Moes number to a tenth of it, and from there into the rough dry contact"
    return (
        f"entrainment speed of {SPEED.text(abs(entrainment_speed))} is below the lowest mapped one, "
        f"{SPEED.text(law.speed_range[0])}: {fate}, and films are continued by Moes' formula"
    )


def guessed(law: Law, loads: FloatArray, entrainment_speed: float, temperature: float) -> str:
    """A sentence where loaded slices lie below the loads whose films are known; empty otherwise.

    Parameters
    ----------
    law : Law
        The law of a contact.
    loads : array
        Loads of the slices [N/m].
    entrainment_speed, temperature : float
        u [m/s], T [K].
    """
    limit = 0.0 if isinstance(law, DryLaw) else law.guessed_below(entrainment_speed, temperature)
    low = (loads > 0.0) & (loads < limit)
    if not np.any(low):
        return ""
    return (
        f"{np.count_nonzero(low)} of {loads.size} slices carry less than {LOAD.text(limit)}, down to "
        f"{LOAD.text(float(loads[low].min()))}: their film is a guess, that of a rigid contact; make a map with a "
        "backbone, or with lower loads"
    )


def heated(
    contacts: BearingContacts, oil: Lubricant | None, modulus: float, entrainment_speed: float, temperature: float
) -> str:
    """A sentence where inlet heating would thin the isothermal films noticeably; empty otherwise.

    Parameters
    ----------
    contacts : BearingContacts
        Contacts with their films.
    oil : Lubricant or None
        Oil, whose conductivity has to be known.
    modulus, entrainment_speed, temperature : float
        E' [Pa], u [m/s], T [K].
    """
    conductivity = None if oil is None else oil.thermal_conductivity
    if oil is None or conductivity is None or not math.isfinite(_smallest(contacts.central_film)):
        return ""
    try:
        loading = thermal_loading(viscosity_slope(oil, temperature), entrainment_speed, conductivity)
        pressure = float(np.max(contacts.hertz_pressure))
        factor = inlet_shear_heating_factor(pressure, modulus, loading)
    except InputError:
        return "films are isothermal and too thick: the inlet heats up by more than the formula of Gupta et al. covers"
    if factor > _NOTICEABLE:
        return ""
    return (
        f"films are isothermal: inlet heating makes them about {100.0 * (1.0 - factor):.0f} % thinner at the highest "
        "pressure (Gupta et al. 1992)"
    )


_NOTICEABLE = 0.95


def _near(value: float) -> float:
    """Round-off of a number from a file."""
    return 1e-9 * abs(value)


def _smallest(values: FloatArray) -> float:
    """Smallest number; NaN if there is none."""
    known = values[np.isfinite(values)]
    return float(known.min()) if known.size else math.nan

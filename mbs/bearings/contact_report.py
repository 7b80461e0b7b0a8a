"""The contacts of a bearing at the loads of its rollers: what they feel, what rolling costs, where laws no longer hold.

In the frame of the cage every contact stands still, and both of its surfaces run through it at the entrainment speed u.
Each wall feels half of the rolling force F [N/m] against its motion, so that a slice of length l takes the power F u l,
whatever the radii are. The rings drive the rollers, and the rollers drive nothing: what the films take comes in as the
torque M of one ring against the other,

    M |omega_i - omega_o| = sum over rollers, slices and both contacts of F u l.

Rollers are taken to roll without slip where no clearance of the cage's pockets is known. A roller turns against the
rolling forces of both its contacts by tractions of the same size, which need some slip: of a loaded roller a few
thousandths of u, whose power is that small a part. An idle roller in thick films needs a slip as large as u, by which
it takes about half of the power, see `mbs.bearings.roller_spin`.

Left out: sliding at flanges and in the cage, seals, churning of the oil, tractions by skew and by larger slip, elastic
hysteresis. The films are those of the map: isothermal and fully flooded.

Where the friction of the films is not known, or not all of it, catalogue formulas stand for the whole bearing.

References
----------
A. Palmgren, Ball and Roller Bearing Engineering, SKF, 1959.
T. A. Harris, M. N. Kotzalas, Essential Concepts of Bearing Technology, CRC, 2007, chapter on friction. Factors of
cylindrical roller bearings with a cage, from memory: f0 0.6 to 1 with grease and 2.2 to 4 in an oil bath, f1 2e-4 to
4e-4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.kernels.tables import LOAD_TOLERANCE
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.heat import inlet_heats
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.rollers.ratings import cylindrical_ratings
from ehdmaps.physics.solution import tip_words
from ehdmaps.physics.surface import Surface
from ehdmaps.units import LOAD, PRESSURE, SPEED, TEMPERATURE
from mbs.bearings.bearing import Bearing
from mbs.bearings.films import ContactState, FilmSource, error_of_smallest
from mbs.bearings.force_at_point import RollerLoads
from mbs.bearings.laws import DryLaw, Law
from mbs.model.findings import RingPoint


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

    @property
    def film_error(self) -> FloatArray:
        """Stated error of the smallest film of each side, over it, (2,); NaN where none is stated."""
        return np.array([error_of_smallest(side.minimum_film, side.film_error) for side in self.sides])


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
    """Name the axis of a law's map that a point leaves, with its value, what is done there, and what to do.

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
    if isinstance(law, DryLaw):
        fate = "where the law goes on straight; add points that reach there"
    return [f"{axis}, {fate}" for axis in axes_left(law, load, entrainment_speed, temperature)]


def axes_left(law: Law, load: float, entrainment_speed: float, temperature: float) -> list[str]:
    """Name the axis of a law's map that a point leaves, with its value; a film that fades to rest is inside.

    Parameters
    ----------
    law : Law
        Law of a map or formula, or by points; other dry laws have no end.
    load, entrainment_speed, temperature : float
        Largest load of a slice [N/m], u [m/s], T [K].
    """
    if isinstance(law, DryLaw):
        last = law.highest_load
        above = load > last * (1.0 + LOAD_TOLERANCE)
        return [f"load per length of {LOAD.text(load)} is above the last point of the law, {LOAD.text(last)}"] * above
    loads = law.load_range[0], law.known_load(entrainment_speed, temperature)
    axes = (
        ("load per length", load, (0.0, loads[1]), loads, LOAD),
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
    """A sentence where the speed is below the map, so that the film is continued or fades; empty otherwise."""
    if isinstance(law, DryLaw) or not 0.0 < abs(entrainment_speed) < law.speed_range[0] * (1.0 - 1e-9):
        return ""
    fate = "stiffness and damping fade to those of dry contacts from there on"
    if law.continued is not None or not law.surface.smooth:
        fate = "the law goes on at the same groups to a tenth of it, and from there into the dry contact"
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


def heated(contact: LineContact, oil: Lubricant | None, load: float, entrainment_speed: float, kelvin: float) -> str:
    """A sentence where heat in the inlet would thin isothermal films noticeably; empty otherwise.

    Parameters
    ----------
    contact : LineContact
        The contact.
    oil : Lubricant or None
        Oil, whose conductivity has to be known.
    load, entrainment_speed, kelvin : float
        w [N/m], u [m/s], T [K].
    """
    if oil is None or oil.thermal_conductivity is None or not load > 0.0 < abs(entrainment_speed):
        return ""
    at = (np.array([value]) for value in (load, abs(entrainment_speed), kelvin))
    factor = float(inlet_heats(contact, oil, *at).factor[0])
    if factor > _NOTICEABLE:
        return ""
    return (
        f"films are isothermal: heat in the inlet makes them about {100.0 * (1.0 - factor):.0f} % thinner at the "
        "highest load"
    )


_NOTICEABLE = 0.95


def _near(value: float) -> float:
    """Round-off of a number from a file."""
    return 1e-9 * abs(value)


def _smallest(values: FloatArray) -> float:
    """Smallest number; NaN if there is none."""
    known = values[np.isfinite(values)]
    return float(known.min()) if known.size else math.nan


_STIFF_OIL = 2000.0
_RPM = 30.0 / math.pi


def viscous_torque(f0: float, viscosity: float, speed: float, pitch_diameter: float) -> float:
    """Palmgren's torque of the oil in a bearing, whatever its load [N m].

    M_0 = 1e-7 f0 (nu n)^(2/3) d_m^3 in N mm, mm2/s, rpm and mm, with nu n of 2000 at least.

    Parameters
    ----------
    f0 : float
        Factor of the kind of bearing and lubrication.
    viscosity : float
        Kinematic viscosity nu [m2/s] at the temperature of operation.
    speed : float
        Speed of one ring against the other [rad/s], of either sign.
    pitch_diameter : float
        d_m [m].

    Examples
    --------
    An NU308 in a bath of 95 mm2/s, at 1500 rpm:

    >>> round(1e3 * viscous_torque(2.2, 95e-6, 1500.0 / _RPM, 66e-3), 1)
    172.6
    """
    product = max(viscosity * 1e6 * abs(speed) * _RPM, _STIFF_OIL)
    torque: float = 1e-3 * 1e-7 * f0 * product ** (2.0 / 3.0) * (1e3 * pitch_diameter) ** 3
    return torque


def load_torque(f1: float, load: float, pitch_diameter: float) -> float:
    """Palmgren's torque of the load, M_1 = f1 F d_m [N m].

    Parameters
    ----------
    f1 : float
        Factor of the kind of bearing.
    load : float
        Radial force F [N].
    pitch_diameter : float
        d_m [m].
    """
    return f1 * abs(load) * pitch_diameter


IDLE = 0.05
"""A roller counts as idle if it carries less than this part of the highest roller load: films load all a little."""


@dataclass(frozen=True, eq=False)
class RollingLoss:
    """Cost of rolling in a bearing; NaN where no rolling force is known.

    Attributes
    ----------
    power : array (2, Z)
        Power that the films of each roller take at the inner and at the outer raceway [W].
    ring_speed : float
        Speed of one ring against the other, without sign [rad/s].
    idle : float
        Part of the power of rollers that carry less than `IDLE` of the highest roller load; NaN without power.
    slowest : float
        Speed of the slowest roller over that of rolling.
    sliding : float
        Power of balls that drill, and of roller ends at ribs, at a traction of `TRACTION` of their loads [W].
    """

    power: FloatArray
    ring_speed: float
    idle: float
    slowest: float = 1.0
    sliding: float = 0.0

    @property
    def total(self) -> float:
        """Power of all films [W]."""
        return float(self.power.sum())

    @property
    def torque(self) -> float:
        """Rolling torque between the rings [N m]; zero at standstill."""
        return self.total / self.ring_speed if self.ring_speed > 0.0 else 0.0 * self.total

    @property
    def sliding_torque(self) -> float:
        """Torque between the rings by what slides [N m]; zero at standstill."""
        return self.sliding / self.ring_speed if self.ring_speed > 0.0 else 0.0


def rolling_loss(
    bearing: Bearing,
    films: FilmSource,
    contacts: BearingContacts,
    rollers: RollerLoads,
    entrainment_speed: float,
    ring_speed: float,
    temperature: float,
    centrifugal_load: float = 0.0,
) -> RollingLoss:
    """Compute the cost of rolling at given contacts, of rollers that turn as the clearance of their pockets says.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    films : FilmSource
        What knows the oil.
    contacts : BearingContacts
        Contacts with their rolling forces.
    rollers : RollerLoads
        Loads on the inner raceway.
    entrainment_speed, ring_speed : float
        u [m/s], and speed of one ring against the other [rad/s], of either sign.
    temperature, centrifugal_load : float
        T [K], and q [N/m], which the outer raceway carries besides.
    """
    u, slowest = abs(entrainment_speed), 1.0
    force = np.stack([side.rolling_force.sum(axis=1) for side in contacts.sides])
    power = force * bearing.slice_length * u
    if bearing.pocket_clearance is not None and films.lubricant is not None and np.all(np.isfinite(force)) and u > 0.0:
        from mbs.bearings.roller_spin import driven_rollers

        inner = rollers.load_per_length
        loads = inner, np.maximum(inner + centrifugal_load, 0.0)
        driven = driven_rollers(bearing, contacts.sides, loads, films.lubricant.at(temperature), u)
        power, slowest = driven.power, float(driven.spin.min())
    return loss_of(power, rollers.load, ring_speed, slowest)


TRACTION = 0.05
"""Traction of what slides in a full film of mineral oil, over its load [-]: that of SKF's catalogue. Fast, warm or thin
films have less, rubbing surfaces two to three times as much."""


def loss_of(
    power: FloatArray, load: FloatArray, ring_speed: float, slowest: float = 1.0, sliding: float = 0.0
) -> RollingLoss:
    """Loss of a bearing by what its rolling elements take.

    Parameters
    ----------
    power : array (2, Z)
        Power that the films of each element take at the inner and at the outer raceway [W]; NaN where none is known.
    load : array (Z,)
        Loads of the elements on the inner raceway [N].
    ring_speed : float
        Speed of one ring against the other [rad/s], of either sign.
    slowest : float
        Speed of the slowest element over that of rolling.
    sliding : float
        Power of what slides [W].
    """
    total = float(power.sum())
    idle = float(power[:, load < IDLE * np.max(load)].sum()) / total if total > 0.0 else math.nan
    return RollingLoss(power, abs(ring_speed), idle, slowest, sliding)


@dataclass(frozen=True, eq=False, kw_only=True)
class BearingPoint(RingPoint):
    """A cylindrical roller bearing in equilibrium.

    Attributes
    ----------
    bearing : Bearing
        Geometry, clearance, profile, slices.
    entrainment_speed, temperature : float
        u [m/s], T [K].
    contacts : BearingContacts
        Pressures and films of all slices.
    loss : RollingLoss
        What rolling costs.
    """

    bearing: Bearing
    entrainment_speed: float
    temperature: float
    elements: RollerLoads
    contacts: BearingContacts
    loss: RollingLoss

    @property
    def geometry(self) -> BearingGeometry:
        """Geometry of the bearing."""
        return self.bearing.geometry

    @property
    def ratings(self) -> tuple[float, float]:
        """C of ISO 281 and C0 of ISO 76 by the inner geometry [N]."""
        return cylindrical_ratings(self.geometry)

    @property
    def smallest_film(self) -> float:
        """Smallest film of all contacts [m]; NaN where no film is known."""
        return float(np.min(self.contacts.minimum_film))

    @property
    def most_loaded(self) -> int:
        """Index of the roller with the highest load."""
        return int(np.argmax(self.elements.load))

    def film_parameter(self, roughness: float) -> float:
        """Lambda: smallest film of all contacts over the combined rms roughness [m]; NaN where no film is known."""
        return self.smallest_film / roughness

    def film_share(self, surface: Surface, lubricant: Lubricant) -> float:
        """Share of the film in the load of the most loaded roller, of the contact where it is less; NaN without films.

        By its central films; 1 between smooth surfaces.

        Parameters
        ----------
        surface : Surface
            Surfaces of the contacts.
        lubricant : Lubricant
            The oil.
        """
        return self.load_sharing(surface, lubricant)[0]

    def load_sharing(self, surface: Surface, lubricant: Lubricant) -> tuple[float, str]:
        """`film_share`, and what is to be said where mean planes overlap in a slice, see `ehdmaps.maps.rough_layer`.

        Parameters
        ----------
        surface, lubricant
            Arguments of `film_share`.
        """
        if self.failed:
            return math.nan, ""
        if surface.smooth:
            return 1.0, ""
        from ehdmaps.maps.rough_layer import LEAST_SPEED, MeanPlanes, RoughLayer, load_sharing

        loads = self.elements.load_per_length[self.most_loaded]
        loaded = loads > 0.0
        contacts = self.bearing.geometry.contacts(self.bearing.material, "iso16281")
        place = loads[loaded], np.array([self.entrainment_speed]), np.array([self.temperature])
        shares, planes = [], [MeanPlanes.APART]
        for contact, side in zip(contacts, self.contacts.sides, strict=True):
            film = side.central_film[self.most_loaded][loaded][:, None, None]
            layer = RoughLayer(surface, contact, lubricant, max(self.entrainment_speed, LEAST_SPEED))
            part, distance = (values[:, 0, 0] for values in load_sharing(layer, film, *place))
            planes += [MeanPlanes.of(*each) for each in zip(part.tolist(), distance.tolist(), strict=True)]
            shares.append(float(np.sum(part * loads[loaded]) / np.sum(loads)) if loaded.any() else math.nan)
        worst = next(kind for kind in reversed(MeanPlanes) if kind in planes)
        return min(shares), worst.value

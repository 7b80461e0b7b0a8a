"""Parts of a scene that follow the angle: tables [[unbalances]] and [[excitations]], and the loads that they become."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.units import LENGTH, RPM, Display
from mbs.model.elements import GROUND
from mbs.model.turning import TurningLoad, unbalance
from mbs.scene import fields
from mbs.scene.fields import DEGREE
from mbs.scene.specs import BodySpec, RigidSpec, ShaftSpec

if TYPE_CHECKING:
    from ehdmaps.jobs.table import Table
    from mbs.model.system import Places

HIGHEST_ORDER = 1e5
"""Of an excitation."""

_UNBALANCE = Display("g mm", 1e6)
_FULL_TURN = 4.0 * math.pi


@dataclass(frozen=True)
class Unbalance:
    """A mass off the axis of a body that spins.

    Attributes
    ----------
    name : str
        Name for messages and results.
    on : str
        Place on the axis; the body alone with `at`.
    moment : float
        Mass times radius [kg m].
    angle : float
        Angle from y towards z when the system has turned by zero [rad].
    at : float or None
        Place along x from the position of the body [m]; None where `on` is the place.
    """

    name: str
    on: str
    moment: float
    angle: float = 0.0
    at: float | None = None

    @property
    def place(self) -> str:
        """The place at which it sits."""
        return self.on if self.at is None else f"{self.on}:{self.name}"

    def load(self, places: Places) -> TurningLoad:
        """The load that it is.

        Parameters
        ----------
        places : Places
            Places of the system, with that of `at`.

        Raises
        ------
        InputError
            If the body does not spin.
        """
        spin = places.spin(self.place)
        if spin == 0.0:
            raise InputError(
                f"unbalance {self.name!r}: {self.on} does not spin, so that an unbalance does nothing; allowed: a body "
                "with a spin, such as spin = 1"
            )
        return unbalance(self.name, self.place, self.moment, self.angle, spin)


@dataclass(frozen=True, eq=False)
class OrderLoad:
    """A load that pulsates so many times for each turn of a body, such as the ripple of a motor.

    Attributes
    ----------
    name : str
        Name for messages and results.
    on, against : str
        Places of the load; `against` gets the opposite.
    amplitude : array, shape (6,)
        Three forces [N] and three moments [N m]; the load is amplitude sin(order angle + phase).
    order : float
        How often for each turn of the body `of`.
    of : str or None
        Name of a body; None for the system.
    phase : float
        [rad].
    reference_speed : float or None
        Speed of the system at which the amplitude holds, which grows by the square of the speed [rad/s]; None for an
        amplitude that holds at any speed.
    """

    name: str
    on: str
    amplitude: FloatArray
    order: float
    against: str = GROUND
    of: str | None = None
    phase: float = 0.0
    reference_speed: float | None = None

    def load(self, places: Places) -> TurningLoad:
        """The load that it is.

        Parameters
        ----------
        places : Places
            Places of the system.

        Raises
        ------
        InputError
            If the body does not exist or does not spin.
        """
        spin = 1.0
        if self.of is not None:
            if found := places.body_problem(self.of):
                raise InputError(f"excitation {self.name!r}, of: {found}")
            spin = places.spin(self.of)
        if spin == 0.0:
            raise InputError(
                f"excitation {self.name!r}, of: {self.of} does not spin, so that its orders excite nothing; allowed: a "
                "body with a spin, or no `of` for the orders of the system"
            )
        # sin(x) = Re(-i exp(i x)).
        vector = -1j * np.exp(1j * self.phase) * self.amplitude
        if self.reference_speed is None:
            return TurningLoad(self.name, self.on, vector, self.order * spin, constant=1.0, against=self.against)
        growth = 1.0 / self.reference_speed**2
        return TurningLoad(self.name, self.on, vector, self.order * spin, by_square=growth, against=self.against)


def read_unbalance(section: Table, name: str) -> Unbalance | None:
    """Read an unbalance; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    name : str
        Name of the unbalance.
    """
    on = fields.place(section, "on")
    at = section.quantity("at", "m", -100.0, 100.0, LENGTH)
    if at is not None and on is not None and ":" in on:
        section.note("at", f"stands beside on = {on!r}, which is a place already; allowed: one of both; delete one")
        return None
    moment = section.quantity("moment", "kg m", 0.0, 1e6, _UNBALANCE)
    mass = section.quantity("mass", "kg", 0.0, 1e6, Display("kg"))
    radius = section.quantity("radius", "m", 0.0, 100.0, LENGTH)
    angle = section.quantity("angle", "rad", -_FULL_TURN, _FULL_TURN, DEGREE)
    given = ("mass" in section, "radius" in section)
    if "moment" in section and any(given):
        section.note("moment", "stands beside mass or radius; allowed: moment, or mass and radius; delete one")
    elif any(given) and not all(given):
        section.note("mass", "mass and radius go together; allowed: both, or moment alone")
    elif "moment" not in section and not any(given):
        section.note("moment", 'missing; allowed: mass times radius, such as "10 g mm", or mass and radius')
    if mass is not None and radius is not None:
        moment = mass * radius
    if on is None or moment is None:
        return None
    return Unbalance(name, on, moment, angle or 0.0, at)


def read_excitation(section: Table, name: str) -> OrderLoad | None:
    """Read an excitation by an order; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    name : str
        Name of the excitation.
    """
    on, against = fields.places(section)
    wrench = fields.wrench(section)
    order = section.number("order", 1e-6, HIGHEST_ORDER, required=True)
    phase = section.quantity("phase", "rad", -100.0, 100.0, DEGREE)
    of = fields.place(section, "of") if "of" in section else None
    growth = section.choice("over_speed", ("constant", "square")) or "constant"
    reference = section.quantity("reference_speed", "rad/s", 1e-3, 1e5, RPM, required=growth == "square")
    if growth == "constant" and "reference_speed" in section:
        section.note("reference_speed", 'stands without over_speed = "square"; allowed: with it only; delete it')
    if on is None or wrench is None or order is None:
        return None
    return OrderLoad(name, on, wrench, order, against, of, phase or 0.0, reference)


def with_places(bodies: Iterable[BodySpec], unbalances: Sequence[Unbalance]) -> tuple[BodySpec, ...]:
    """Bodies with a frame at each place that an unbalance has by `at`.

    Parameters
    ----------
    bodies : iterable of RigidSpec, ShaftSpec, FlexibleSpec or Body
        The bodies of a scene.
    unbalances : sequence of Unbalance
        All unbalances.

    Raises
    ------
    InputError
        If a body has no axis along which a place could be, or has a frame of that name.
    """
    problems = Problems()
    changed = list(bodies)
    names = [body.name for body in changed]
    for entry in unbalances:
        if entry.at is None or entry.on not in names:
            continue  # the system says that there is no such body
        index = names.index(entry.on)
        body = changed[index]
        with problems.after(f"unbalance {entry.name!r}: "):
            if entry.name in getattr(body, "frames", {}):
                raise InputError("the body has a frame of that name; allowed: a name of its own")
            if isinstance(body, RigidSpec):
                frames = {**body.frames, entry.name: (entry.at, 0.0, 0.0)}
                changed[index] = dataclasses.replace(body, frames=frames)
            elif isinstance(body, ShaftSpec):
                changed[index] = dataclasses.replace(body, frames={**body.frames, entry.name: entry.at})
            else:
                raise InputError("at: allowed on rigid bodies and shafts; name a frame of the body as `on`")
    problems.check()
    return tuple(changed)


def turning_loads(
    unbalances: Iterable[Unbalance], excitations: Iterable[OrderLoad], places: Places
) -> tuple[list[TurningLoad], list[str]]:
    """The loads of all unbalances and excitations, and what is wrong with them.

    Parameters
    ----------
    unbalances, excitations : iterable
        Those of a scene.
    places : Places
        Places of its bodies.
    """
    loads, problems = [], Problems()
    entries: list[Unbalance | OrderLoad] = [*unbalances, *excitations]
    for entry in entries:
        word, on = ("unbalance", entry.place) if isinstance(entry, Unbalance) else ("excitation", entry.on)
        if found := places.problem(on):
            problems.append(f"{word} {entry.name!r}: {found}")
            continue
        with problems:
            loads.append(entry.load(places))
    return loads, problems

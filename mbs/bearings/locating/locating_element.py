"""A bearing that carries axial load in a machine: quasi-static, with the films of the speed that the system has.

The angle of the cage goes evenly, by pure rolling at the nominal contact angle. Films have the stiffness and damping of
slow motion, or a memory. What a kind has of its own is in its force, `LocatingForce`.
"""

from __future__ import annotations

import dataclasses
import math
from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, EhdmapsError
from ehdmaps.units import RPM
from mbs.bearings.contact_energy import over_parts
from mbs.bearings.locating.film_memory import FilmsInTime
from mbs.bearings.locating.locating_force import LAST, Settled
from mbs.model.elements import Excitation, Forces, OnRings, Operation, Port, Powers, check_apart
from mbs.model.findings import Cause, Finding, Gauge
from mbs.model.relaxation import Films, Relaxation

if TYPE_CHECKING:
    from mbs.bearings.contact_report import BearingContacts, RollingLoss
    from mbs.bearings.deviating.tables import DeviationData, Deviations
    from mbs.model.condensed import Condensed

HARMONICS = 3
"""Multiples of the passing frequency of the rolling elements that are worth following."""

SAMPLES = 4
"""Samples in each part of a run of which it is known what changes of the speed brought into films."""

MOST_SPEEDS = 64
"""Speeds whose films are kept."""


class LocatingStates(NamedTuple):
    """States of a bearing after a step in time.

    Attributes
    ----------
    time : float
        End of the step [s].
    last : array, shape (Z, LAST)
        What `LocatingForce.works` keeps of it.
    dissipated, driven : float
        What contacts take up, and what cage and speed bring in [W].
    spent : float
        What films with memory took up over the step [J].
    rows : array, shape (Z, ...)
        Numbers of the elements, see `LocatingForce.last_rows`.
    films : FilmsInTime or None
        Films with memory; None where none are known.
    """

    time: float
    last: FloatArray
    dissipated: float
    driven: float
    spent: float
    rows: FloatArray
    films: Any = None


@dataclass(frozen=True, eq=False)
class LocatingElement(OnRings):
    """A bearing that carries axial load, between an inner and an outer ring, of any kind.

    Attributes
    ----------
    name : str
        Name for messages and results.
    inner, outer : str
        Places at the middle of the bearing, of tapered rollers in the plane of the middles of the rollers.
    force : LocatingForce
        The force, dry.
    inner_spin, outer_spin : float
        Speeds of the rings as multiples of the system's.
    start_angle : float
        Angle of the first rolling element from y at the beginning [rad].
    axial_offset : float
        Way of the inner ring along x against the outer one where both places have not moved [m]: preload by
        displacement, or play.
    films : callable or None
        Law with the films at two speeds of the rings [rad/s]; None for the dry law. Bearings whose `films` are equal
        share them.
    memory : {"slow", "memory"}
        Whether films have stiffness and damping of slow motion, or relax; "memory" in time, too.
    deviations : Deviations or None
        Deviations from its form, which excite runs in time.
    """

    locating: ClassVar[bool] = True
    name: str
    inner: str
    outer: str
    force: Any
    inner_spin: float = 1.0
    outer_spin: float = 0.0
    start_angle: float = 0.0
    axial_offset: float = 0.0
    films: Callable[[float, float], Any] | None = None
    memory: Films = "slow"
    deviations: Deviations | None = None
    _made: OrderedDict[float, Any] = field(default_factory=OrderedDict, init=False, repr=False)

    @property
    def rolling_element(self) -> str:
        """See `OnRings.rolling_element`."""
        return str(self.force.rolling_element)

    @property
    def kind(self) -> type:
        """Class by which `mbs.transient.kinds` has its functions in C: that of the force."""
        return type(self.force)

    @property
    def film_key(self) -> tuple[object, ...]:
        """Key that bearings with the same law at all speeds have in common."""
        law = id(self.force.dry_law) if self.films is None else self.films
        return (law, self.inner_spin, self.outer_spin, self.relaxes)

    @property
    def varies(self) -> bool:
        """Tell whether it has films that change with the speed."""
        return self.films is not None and self.inner_spin != self.outer_spin

    @property
    def relaxes(self) -> bool:
        """See `OnRings.relaxes`."""
        return self.memory == "memory" and self.films is not None

    def law_at(self, speed: float) -> Any:
        """The law at a speed of the system [rad/s]; dry where nothing rolls.

        Raises
        ------
        AnalysisError
            Where there are no films at that speed.
        """
        if self.films is None or abs(speed) * abs(self.inner_spin - self.outer_spin) == 0.0:
            return self.force.dry_law
        try:
            return self.films(self.inner_spin * abs(speed), self.outer_spin * abs(speed))
        except EhdmapsError as error:
            raise AnalysisError(
                f"bearing {self.name!r}: no films at {RPM.text(abs(speed))} of the system ({error}); take another oil, "
                "temperature or speed, or dry contacts: --law 'hertz:1.25e-5 s'"
            ) from error

    def force_at(self, operation: Operation) -> Any:
        """The force with the films of a speed; errors as of `law_at`."""
        speed = abs(operation.speed)
        if self.films is None:
            return self.force
        if speed not in self._made:
            self._made[speed] = self.force.with_films(self.law_at(speed))
            if len(self._made) > MOST_SPEEDS:
                self._made.popitem(last=False)
        return self._made[speed]

    @property
    def ports(self) -> tuple[Port, ...]:
        """Displacement of the inner ring against the outer one."""
        return (Port(self.inner, self.outer),)

    @property
    def count(self) -> int:
        """See `OnRings.count`."""
        return int(self.force.angles.size)

    @property
    def excitation(self) -> Excitation | None:
        """The passing of the rolling elements; None for a cage that stands."""
        order = self.count * abs(self.cage_turn)
        return Excitation(order, HARMONICS, rank=1) if order > 0.0 else None

    def passed(self, part: float) -> Self:
        """See `OnRings.passed`; with the films that are made already."""
        turn = 2.0 * math.pi * part / self.count
        other = dataclasses.replace(self, start_angle=self.start_angle + turn * float(np.sign(self.cage_turn)))
        other._made.update(self._made)
        return other

    @cached_property
    def cage_turn(self) -> float:
        """Speed of the cage as a multiple of the system's, by the nominal contact angle."""
        return float(self.force.geometry.cage_speed(self.inner_spin, self.outer_spin))

    def forget(self, operation: Operation) -> None:
        """See `OnRings.forget`."""
        self.force_at(operation).forget()

    def deviate(self, added: FloatArray | None) -> None:
        """See `OnRings.deviate`; of the force at the speed of the last call."""
        for force in (self.force, *self._made.values()):
            force.deviate(added)

    @cached_property
    def deviation_data(self) -> DeviationData | None:
        """Tables of its deviations; None without any."""
        if self.deviations is None:
            return None
        from mbs.bearings.deviating.tables import deviation_data  # with what few scenes state

        spins = self.inner_spin, self.outer_spin
        return deviation_data(self.deviations, self.force.geometry, spins, self.start_angle, self.force.angles)

    @property
    def entrainment_rate(self) -> float:
        """See `OnRings.entrainment_rate`."""
        return float(self.force.geometry.entrainment_speed(self.inner_spin, self.outer_spin))

    def conditions(self, operation: Operation) -> dict[str, float]:
        """Angle of the cage and speeds, by the names that the force takes."""
        return {
            "cage_angle": self.start_angle + self.cage_turn * operation.angle,
            "inner_speed": self.inner_spin * operation.speed,
            "outer_speed": self.outer_spin * operation.speed,
        }

    def pose(self, displacement: FloatArray) -> FloatArray:
        """Pose of the inner ring in the outer one by their displacement (6,)."""
        pose = displacement.copy()
        pose[0] += self.axial_offset
        return pose

    def settled(self, displacement: FloatArray, operation: Operation) -> Settled:
        """The bearing at rest at a displacement (6,) of the inner ring against the outer one.

        Whatever was asked before: results do not depend on the places from which a search started.
        """
        self.forget(operation)
        force, pose, conditions = self.force_at(operation), self.pose(displacement), self.conditions(operation)
        return Settled(force, pose, conditions, force.loads(pose, **conditions))

    def loads(self, displacement: FloatArray, operation: Operation) -> Any:
        """State of all rolling elements at rest at the displacement (6,) of the inner ring against the outer one."""
        return self.settled(displacement, operation).loads

    def element_loads(self, displacement: FloatArray, operation: Operation) -> FloatArray:
        """See `OnRings.element_loads`."""
        return np.array(self.settled(displacement, operation).loads.load[0])

    def largest_load(self, displacement: FloatArray, operation: Operation) -> float:
        """See `OnRings.largest_load`."""
        return float(self.settled(displacement, operation).loads.largest)

    def film_relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """See `OnRings.film_relaxation`; where nothing rolls, contacts have springs without stiffness."""
        if self.films is None:
            return None
        at = self.settled(displacement, operation)
        found: Relaxation = at.force.relaxation(at.loads, at.conditions)
        return found

    @property
    def slowest_film(self) -> float:
        """See `OnRings.slowest_film`."""
        return float(getattr(self.films, "slowest", 0.0))

    @property
    def film_source(self) -> str:
        """See `OnRings.film_source`."""
        return str(getattr(self.films, "source", ""))

    @property
    def error_words(self) -> str:
        """See `OnRings.error_words`."""
        return str(getattr(self.films, "error_words", ""))

    def small_motions(self, displacement: FloatArray, operation: Operation) -> Condensed | None:
        """See `OnRings.small_motions`."""
        at = self.settled(displacement, operation)
        found: Condensed | None = at.force.condensed(at.loads, at.conditions, self.relaxes)
        return found

    def gauge(self, displacement: FloatArray, operation: Operation) -> Gauge:
        """See `OnRings.gauge`; with what is to be known of the films."""
        at = self.settled(displacement, operation)
        found: Gauge = at.force.gauge(at.loads)
        speed = abs(operation.speed)
        note = getattr(self.films, "note", None)  # films of one's own may have none
        words = note(self.inner_spin * speed, self.outer_spin * speed) if note is not None else ""
        return found._replace(own=(*found.own, Finding(Cause.FILM, words))) if words else found

    def felt(self, displacement: FloatArray, operation: Operation) -> tuple[BearingContacts, RollingLoss]:
        """See `OnRings.felt`."""
        at = self.settled(displacement, operation)
        found: tuple[BearingContacts, RollingLoss] = at.force.felt(at.loads, self.films, at.speeds)
        return found

    def evaluate(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> Forces:
        """Force on the inner ring, stiffness and damping; whether loads are beyond those of the films.

        Parameters
        ----------
        displacement, velocity, operation
            What `Element.evaluate` takes.
        """
        force = self.force_at(operation)
        answer: tuple[FloatArray, FloatArray, FloatArray] = force(
            self.pose(displacement), velocity, **self.conditions(operation)
        )
        return Forces(*answer, bool(force.last_loads.max() > force.film_loads[1]))

    def advance(
        self, states: Any, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> tuple[Forces, Any]:
        """The same at the end of a step in time, see `Element.advance`.

        Parameters
        ----------
        states : LocatingStates or None
            States after the last step; None at the beginning.
        displacement, velocity, operation
            What `Element.advance` takes.

        Raises
        ------
        AnalysisError
            Where the rings have come apart.
        """
        force, pose, conditions = self.force_at(operation), self.pose(displacement), self.conditions(operation)
        most = force.shape.most_travel, force.shape.most_tilt
        check_apart(self.name, pose, most, operation.time, beyond=force.beyond(pose))
        films, step = None if states is None else states.films, 0.0 if states is None else operation.time - states.time
        last = np.zeros((force.angles.size, LAST)) if states is None else states.last.copy()
        force.held = None if films is None else films.held(step, force.shorter)
        try:
            with self.deviating(operation):
                answer = self.evaluate(displacement, velocity, operation)
                work, taken = force.works((conditions["inner_speed"], conditions["outer_speed"]), last)
        finally:
            force.held = None
        spent = 0.0
        if self.relaxes:
            before, films = films, FilmsInTime.at_rest(force) if films is None else films.after(step, force)
            spent = taken - films.stored + before.stored if before is not None and step > 0.0 else 0.0
        slowed = answer.damping @ velocity
        at_rest, dissipated, brought = answer.force + slowed, float(velocity @ slowed), 0.0
        if self.deviation_data is not None:
            by, (own, pressed) = force.by_rates[:6], force.by_rates[6:].tolist()
            taken = -float(velocity @ by)
            at_rest -= by
            dissipated, brought = dissipated + 2.0 * taken + own, pressed + taken + own
        turning = turned_by(pose, at_rest) * self.cage_turn * operation.speed
        return answer, LocatingStates(
            time=operation.time,
            last=last,
            dissipated=dissipated,
            driven=turning + brought + (work / step if step > 0.0 else 0.0),
            spent=spent,
            rows=force.last_rows.copy(),
            films=films,
        )

    def powers(
        self, states: Any, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> Powers | None:
        """Power that contacts dissipate, and that cage, deviations and speed bring in, see `Element.powers`."""
        return Powers(states.dissipated, states.driven, states.spent)

    def stored(self, states: Any, displacement: FloatArray, operation: Operation) -> float | None:
        """Energy of its contacts at rest, and of the springs of films with memory [J], see `Element.stored`."""
        springs = 0.0 if states.films is None else float(states.films.stored)
        return float(self.force_at(operation).stored(states.rows)) + springs

    def brought_by_speed(self, displacements: FloatArray, operations: Sequence[Operation]) -> float:
        """Energy that changes of the speed brought into its films, see `mbs.bearings.contact_energy`."""
        if not self.varies:
            return 0.0

        def change(begin: int, end: int, inside: FloatArray) -> float:
            low, high = (self.force_at(operations[at]) for at in (begin, end))
            speed, total = operations[(begin + end) // 2].speed, 0.0
            chosen = inside[:: -(-inside.size // SAMPLES)].astype(int).tolist()
            for index in chosen:
                at = self.settled(displacements[index], operations[index]._replace(speed=speed))
                rows = at.force.last_rows
                total += high.stored(rows) - low.stored(rows)
            return total / len(chosen)

        return over_parts([one.speed for one in operations], change)


def turned_by(pose: FloatArray, force: FloatArray) -> float:
    """Moment that the bearing asks of its cage [N m], by pose and force at rest of its inner ring, (6,) each."""
    radial: float = pose[1] * force[2] - pose[2] * force[1]
    tilts: float = pose[4] * force[5] - pose[5] * force[4]
    return radial + tilts

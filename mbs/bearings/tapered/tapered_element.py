"""A bearing of tapered rollers, or of rollers between ribs, in a machine: quasi-static, with the films of its speed.

Films have the stiffness and damping of slow motion, or a memory: of small oscillations about rest see
`mbs.bearings.tapered.rollers_in_balance`, in time `mbs.bearings.tapered.tapered_memory`.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, EhdmapsError
from ehdmaps.units import RPM
from mbs.bearings.balls.ball_speed import turned_by
from mbs.bearings.tapered.line_film import DRY_LINES, LineFilms, cylinder_of
from mbs.bearings.tapered.roller_findings import roller_gauge
from mbs.bearings.tapered.tapered_bearing import TaperedForce, TaperedLoads
from mbs.bearings.tapered.tapered_energy import TaperedStates, dry_energy, place_work
from mbs.bearings.tapered.tapered_memory import FilmsOfRollers
from mbs.model.elements import Excitation, Forces, OnRings, Operation, Port, Powers, check_apart
from mbs.model.findings import Gauge
from mbs.model.relaxation import Films, Relaxation

if TYPE_CHECKING:
    from mbs.bearings.contact_report import BearingContacts, RollingLoss
    from mbs.model.condensed import Condensed

HARMONICS = 3
"""Multiples of the passing frequency of the rollers that are worth following."""

MOST_SPEEDS = 64
"""Speeds whose films are kept."""


@dataclass(frozen=True, eq=False)
class TaperedElement(OnRings):
    """A tapered roller bearing between an inner and an outer ring, or one of rollers between ribs.

    Attributes
    ----------
    name : str
        Name for messages and results.
    inner, outer : str
        Places in the plane of the middles of the rollers.
    force : TaperedForce
        The force, dry.
    inner_spin, outer_spin : float
        Speeds of the rings as multiples of the system's.
    start_angle : float
        Angle of the first roller from y at the beginning [rad].
    axial_offset : float
        Way of the inner ring along x against the outer one where both places have not moved [m]: preload by
        displacement, or play.
    films : callable or None
        Law of both lines at two speeds of the rings [rad/s]; None for dry lines. Bearings whose `films` are equal share
        them.
    memory : {"slow", "memory"}
        Whether films have stiffness and damping of slow motion, or relax; "memory" in time, too.
    """

    locating: ClassVar[bool] = True
    name: str
    inner: str
    outer: str
    force: TaperedForce
    inner_spin: float = 1.0
    outer_spin: float = 0.0
    start_angle: float = 0.0
    axial_offset: float = 0.0
    films: Callable[[float, float], LineFilms] | None = None
    memory: Films = "slow"
    _made: OrderedDict[float, TaperedForce] = field(default_factory=OrderedDict, init=False, repr=False)

    @property
    def film_key(self) -> tuple[object, ...]:
        """Key that bearings with the same law at all speeds have in common."""
        law = (None,) if self.films is None else (self.films,)
        return (*law, self.inner_spin, self.outer_spin, self.relaxes)

    @property
    def varies(self) -> bool:
        """Tell whether it has films that change with the speed."""
        return self.films is not None and self.inner_spin != self.outer_spin

    @property
    def relaxes(self) -> bool:
        """Tell whether its films have a memory."""
        return self.memory == "memory" and self.films is not None

    def law_at(self, speed: float) -> LineFilms:
        """The law of both lines at a speed of the system [rad/s]; dry where nothing rolls.

        Raises
        ------
        AnalysisError
            Where there are no films at that speed.
        """
        if self.films is None or abs(speed) * abs(self.inner_spin - self.outer_spin) == 0.0:
            return DRY_LINES
        try:
            return self.films(self.inner_spin * abs(speed), self.outer_spin * abs(speed))
        except EhdmapsError as error:
            raise AnalysisError(
                f"bearing {self.name!r}: no films at {RPM.text(abs(speed))} of the system ({error}); take another oil, "
                "temperature or speed, or dry contacts: --law 'hertz:1.25e-5 s'"
            ) from error

    def force_at(self, operation: Operation) -> TaperedForce:
        """The force with the films of a speed; errors as of `law_at`."""
        speed = abs(operation.speed)
        if self.films is None:
            return self.force
        if speed not in self._made:
            self._made[speed] = self.force.with_films(self.law_at(speed))
            if len(self._made) > MOST_SPEEDS:
                self._made.popitem(last=False)
        return self._made[speed]

    def relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """Relaxation of the films of both lines of all rollers, where they relax, see `Element.relaxation`."""
        if not self.relaxes:
            return None
        return self.film_relaxation(displacement, operation)

    def film_relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """See `OnRings.film_relaxation`; at rest, lines have springs without stiffness."""
        if self.films is None:
            return None
        from mbs.bearings.tapered.rollers_in_balance import line_relaxation  # with kernels that runs do not need

        return line_relaxation(*self._at(displacement, operation))

    @property
    def error_words(self) -> str:
        """See `OnRings.error_words`."""
        return str(getattr(self.films, "error_words", ""))

    def small_motions(self, displacement: FloatArray, operation: Operation) -> Condensed | None:
        """See `OnRings.small_motions`."""
        if self.force_at(operation).films.dry:
            return None
        from mbs.bearings.tapered.rollers_in_balance import rollers_in_balance

        return rollers_in_balance(*self._at(displacement, operation), relaxes=self.memory == "memory")

    def _at(self, displacement: FloatArray, operation: Operation) -> tuple[TaperedForce, float]:
        """The force after a call at a displacement, and the angle of the cage [rad]."""
        force, conditions = self.force_at(operation), self.conditions(operation)
        force(self.pose(displacement), **conditions)
        return force, conditions.get("cage_angle", 0.0)

    @property
    def ports(self) -> tuple[Port, ...]:
        """Displacement of the inner ring against the outer one."""
        return (Port(self.inner, self.outer),)

    @property
    def excitation(self) -> Excitation | None:
        """The passing of the rollers; None for a cage that stands."""
        order = self.force.geometry.rollers * abs(self.cage_turn)
        return Excitation(order, HARMONICS, rank=1) if order > 0.0 else None

    @cached_property
    def cage_turn(self) -> float:
        """Speed of the cage as a multiple of the system's."""
        return self.force.geometry.cage_speed(self.inner_spin, self.outer_spin)

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

    def rollers(self, displacement: FloatArray, operation: Operation) -> TaperedLoads:
        """Loads of all rollers at rest at the displacement (6,) of the inner ring against the outer one."""
        return self.force_at(operation).rollers(self.pose(displacement), **self.conditions(operation))

    def element_loads(self, displacement: FloatArray, operation: Operation) -> FloatArray:
        """See `OnRings.element_loads`: those of the cone."""
        return np.array(self._at(displacement, operation)[0].last_rollers[:, 3])

    def gauge(self, displacement: FloatArray, operation: Operation) -> Gauge:
        """See `OnRings.gauge`."""
        return roller_gauge(self.force_at(operation), self.rollers(displacement, operation))

    def felt(self, displacement: FloatArray, operation: Operation) -> tuple[BearingContacts, RollingLoss]:
        """See `OnRings.felt`."""
        from mbs.bearings.films import DryContacts
        from mbs.bearings.reports.roller_report import roller_contacts

        conditions = self.conditions(operation)
        source = getattr(self.films, "lines", None)
        films = source or DryContacts(cylinder_of(self.force.geometry).contacts(self.force.material, "iso16281"))
        speeds = conditions["inner_speed"], conditions["outer_speed"]
        temperature = float(getattr(self.films, "temperature", 0.0))  # of dry lines nothing depends on it
        return roller_contacts(self.force, self.rollers(displacement, operation), films, speeds, temperature)

    @property
    def entrainment_rate(self) -> float:
        """See `OnRings.entrainment_rate`."""
        return self.force.geometry.entrainment_speed(self.inner_spin, self.outer_spin)

    def largest_load(self, displacement: FloatArray, operation: Operation) -> float:
        """See `OnRings.largest_load` [N/m]."""
        return float(self.rollers(displacement, operation).slices.max())

    def advance(
        self, states: Any, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> tuple[Forces, Any]:
        """The same at the end of a step in time, see `Element.advance`.

        Parameters
        ----------
        states : TaperedStates or None
            States after the last step.
        displacement, velocity, operation
            What `Element.advance` takes.

        Raises
        ------
        AnalysisError
            Where the rings have come apart.
        """
        shape = self.force.shape
        check_apart(self.name, self.pose(displacement), (shape.most_travel, shape.most_tilt), operation.time)
        films, force = None if states is None else states.films, self.force_at(operation)
        step = 0.0 if states is None else operation.time - states.time
        force.held = None if films is None else films.held(step)
        try:
            answer = self.evaluate(displacement, velocity, operation)
        finally:
            force.held = None
        rollers = force.last_rollers
        if self.relaxes:
            films = FilmsOfRollers.at_rest(force) if films is None else films.after(step, force)
        last = np.zeros((rollers.shape[0], 4)) if states is None else states.last.copy()
        conditions = self.conditions(operation)
        loads = self.force.speed_loads(conditions["inner_speed"], conditions["outer_speed"])
        work = place_work(rollers, loads, last)
        slowed = answer.damping @ velocity
        turning = turned_by(self.pose(displacement), answer.force + slowed) * self.cage_turn * operation.speed
        return answer, TaperedStates(
            time=operation.time,
            last=last,
            dissipated=float(velocity @ slowed),
            driven=turning + (work / step if step > 0.0 else 0.0),
            stored=dry_energy(self.force.laws, self.force.shape, rollers),
            films=films,
        )

    def powers(
        self, states: Any, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> Powers | None:
        """Power that contacts dissipate, and that cage and speed bring in; None with films, see `Element.powers`."""
        return None if self.films is not None else Powers(states.dissipated, states.driven)

    def stored(self, states: Any, displacement: FloatArray, operation: Operation) -> float | None:
        """Energy of its dry contacts [J]; None with films, see `Element.stored`."""
        return None if self.films is not None else float(states.stored)

    def evaluate(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> Forces:
        """Force on the inner ring, stiffness and damping; whether loads are beyond those of the films.

        Parameters
        ----------
        displacement, velocity, operation
            What `Element.evaluate` takes.
        """
        force = self.force_at(operation)
        answer = force(self.pose(displacement), velocity, **self.conditions(operation))
        outside = self.films is not None and bool(force.last_rollers[:, 3:5].max() > force.films.loads[1])
        return Forces(*answer, outside)

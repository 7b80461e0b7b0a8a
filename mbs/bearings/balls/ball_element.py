"""A ball bearing in a machine: quasi-static at the speed that the system has, with the speeds that its balls ask for.

The cage's angle goes evenly, by pure rolling at the nominal contact angle. The speeds by which balls have their
centrifugal load and gyroscopic moment are those of their own contact angles. Films have the stiffness and damping of
slow motion, or a memory: of small oscillations about rest see `mbs.bearings.balls.balls_in_balance`, in time
`mbs.bearings.balls.ball_memory`.
"""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, SolverError
from ehdmaps.units import RPM
from mbs.bearings.balls.ball_bearing import BallElement, BallForce, BallLoads
from mbs.bearings.balls.ball_findings import ball_gauge
from mbs.bearings.balls.ball_memory import FilmsOfBalls
from mbs.bearings.balls.ball_speed import dry_energy, speed_work, turned_by
from mbs.bearings.balls.laws import BallLaw
from mbs.bearings.balls.normal_law import nothing_held
from mbs.model.elements import Forces, Operation, Powers, check_apart
from mbs.model.findings import Gauge
from mbs.model.relaxation import Films, Relaxation

if TYPE_CHECKING:
    from mbs.bearings.contact_report import BearingContacts, RollingLoss
    from mbs.model.condensed import Condensed

MOST_SPEEDS = 64
"""Speeds whose films are kept."""


class Settled(NamedTuple):
    """A bearing at a pose.

    Attributes
    ----------
    force : BallForce
        The force with the films of the speed.
    pose : array, shape (6,)
        Pose of the inner ring in the outer one [m, rad].
    conditions : dict
        Angle of the cage [rad] and speeds [rad/s], by the names that the force takes.
    balls : BallLoads
        Loads, contact angles, approaches.
    """

    force: BallForce
    pose: FloatArray
    conditions: dict[str, Any]
    balls: BallLoads


class BallStates(NamedTuple):
    """States of a bearing after a step in time.

    Attributes
    ----------
    time : float
        End of the step [s].
    last : array, shape (Z, 4)
        What `mbs.bearings.balls.ball_speed.speed_work` keeps of it.
    dissipated, driven : float
        What contacts take up, and what cage and speed bring in [W].
    stored : float
        Energy of the contacts, which are dry [J].
    films : FilmsOfBalls or None
        Films with memory; None where none are known.
    """

    time: float
    last: FloatArray
    dissipated: float
    driven: float
    stored: float
    films: FilmsOfBalls | None = None


@dataclass(frozen=True, eq=False)
class MachineBalls(BallElement):
    """A ball bearing of a scene.

    Attributes
    ----------
    axial_offset : float
        Way of the inner ring along x against the outer one where both places have not moved [m]: preload by
        displacement.
    films : callable or None
        Law with the films at two speeds of the rings [rad/s]; None for the dry law. Bearings whose `films` are equal
        share them.
    memory : {"slow", "memory"}
        Whether films have stiffness and damping of slow motion, or relax; "memory" in time, too.
    """

    axial_offset: float = 0.0
    films: Callable[[float, float], BallLaw] | None = None
    memory: Films = "slow"
    _made: OrderedDict[float, BallForce] = field(default_factory=OrderedDict, repr=False)

    @property
    def film_key(self) -> tuple[object, ...]:
        """Key that bearings with the same law at all speeds have in common."""
        law = (id(self.force.law),) if self.films is None else (self.films,)
        return (*law, self.inner_spin, self.outer_spin, self.relaxes)

    @property
    def varies(self) -> bool:
        """Tell whether it has films that change with the speed."""
        return self.films is not None and self.inner_spin != self.outer_spin

    @property
    def relaxes(self) -> bool:
        """Tell whether its films have a memory."""
        return self.memory == "memory" and self.films is not None

    def law_at(self, speed: float) -> BallLaw:
        """The law at a speed of the system [rad/s]; dry where nothing rolls.

        Raises
        ------
        AnalysisError
            Where the film table has no films for a contact at that speed.
        """
        if self.films is None or abs(speed) * abs(self.inner_spin - self.outer_spin) == 0.0:
            return self.force.law
        try:
            return self.films(self.inner_spin * abs(speed), self.outer_spin * abs(speed))
        except SolverError as error:
            raise AnalysisError(
                f"bearing {self.name!r}: no films at {RPM.text(abs(speed))} of the system ({error}); take speeds, "
                "temperature and oil that the film table of points holds, or dry contacts: --law 'hertz:1.25e-5 s'"
            ) from error

    def force_at(self, operation: Operation) -> BallForce:
        """The force at a speed; errors as of `law_at`."""
        speed = abs(operation.speed)
        if self.films is None:
            return self.force
        if speed not in self._made:
            self._made[speed] = BallForce(self.force.geometry, self.law_at(speed), self.force.material)
            if len(self._made) > MOST_SPEEDS:
                self._made.popitem(last=False)
        return self._made[speed]

    def settled(self, displacement: FloatArray, operation: Operation) -> Settled:
        """The bearing at a displacement (6,) of the inner ring against the outer one."""
        force, pose = self.force_at(operation), displacement.copy()
        pose[0] += self.axial_offset
        conditions = self.conditions(operation)
        return Settled(force, pose, conditions, force.balls(pose, **conditions))

    def relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """Relaxation of the films of both contacts of all balls, where they relax, see `Element.relaxation`."""
        return self.film_relaxation(displacement, operation) if self.relaxes else None

    def film_relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """See `OnRings.film_relaxation`; at rest, balls have springs without stiffness."""
        if self.films is None:
            return None
        from mbs.bearings.balls.balls_in_balance import ball_relaxation

        at = self.settled(displacement, operation)
        return ball_relaxation(
            at.force.law, at.force.shape, at.force.last_balls, at.force.drive_at(**at.conditions), at.balls.angle
        )

    @property
    def error_words(self) -> str:
        """See `OnRings.error_words`."""
        return "" if self.films is None else "errors of the film table of points"

    def small_motions(self, displacement: FloatArray, operation: Operation) -> Condensed | None:
        """See `OnRings.small_motions`."""
        if not self.varies:
            return None
        from mbs.bearings.balls.balls_in_balance import balls_in_balance

        at = self.settled(displacement, operation)
        return balls_in_balance(at.force, at.balls, at.conditions, relaxes=self.relaxes)

    def balls(self, displacement: FloatArray, operation: Operation) -> BallLoads:
        """See `BallElement.balls`."""
        return self.settled(displacement, operation).balls

    def gauge(self, displacement: FloatArray, operation: Operation) -> Gauge:
        """See `OnRings.gauge`."""
        return ball_gauge(self.force_at(operation), self.balls(displacement, operation))

    def felt(self, displacement: FloatArray, operation: Operation) -> tuple[BearingContacts, RollingLoss]:
        """See `OnRings.felt`."""
        from mbs.bearings.reports.ball_report import ball_contacts

        at = self.settled(displacement, operation)
        speeds = at.conditions["inner_speed"], at.conditions["outer_speed"]
        return ball_contacts(at.force, at.balls, getattr(self.films, "points", None), speeds)

    @property
    def entrainment_rate(self) -> float:
        """See `OnRings.entrainment_rate`."""
        return self.force.geometry.entrainment_speed(self.inner_spin, self.outer_spin)

    def largest_load(self, displacement: FloatArray, operation: Operation) -> float:
        """See `OnRings.largest_load` [N]."""
        return float(self.balls(displacement, operation).load.max())

    def advance(
        self, states: Any, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> tuple[Forces, Any]:
        """The same at the end of a step in time, see `Element.advance`.

        Parameters
        ----------
        states : BallStates or None
            States after the last step; None at the beginning.
        displacement, velocity, operation
            What `Element.advance` takes.

        Raises
        ------
        AnalysisError
            Where the rings have come apart.
        """
        force, pose, conditions = self.force_at(operation), displacement.copy(), self.conditions(operation)
        pose[0] += self.axial_offset
        shape = force.shape
        # an angular contact bearing beyond its middle has no raceway
        beyond = shape.axial * (shape.axial + pose[0]) < 0.0
        check_apart(self.name, pose, (shape.most_travel, shape.most_tilt), operation.time, beyond=beyond)
        films, step = None if states is None else states.films, 0.0 if states is None else operation.time - states.time
        if films is not None:
            force.held = films.held(step)
        try:
            balls = force.balls(pose, **conditions)
            answer = self._answer(force, pose, velocity, conditions, balls)
        finally:
            force.held = nothing_held()
        last, rows = np.zeros((balls.angle.size, 4)) if states is None else states.last.copy(), force.last_balls
        work = speed_work(rows, force.shape.outer_arm, last)
        if self.relaxes:
            at_end = balls.approach.T
            films = FilmsOfBalls.at_rest(force.law, at_end) if films is None else films.after(step, force.law, at_end)
        slowed = answer.damping @ velocity
        turning = turned_by(pose, answer.force + slowed) * self.cage_turn * operation.speed
        return answer, BallStates(
            time=operation.time,
            last=last,
            dissipated=float(velocity @ slowed),
            driven=turning + (work / step if step > 0.0 else 0.0),
            stored=dry_energy(rows),
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
        at = self.settled(displacement, operation)
        return self._answer(at.force, at.pose, velocity, at.conditions, at.balls)

    @staticmethod
    def _answer(
        force: BallForce, pose: FloatArray, velocity: FloatArray, conditions: dict[str, Any], balls: BallLoads
    ) -> Forces:
        """Force, stiffness, damping, and whether loads are beyond those of the films."""
        at_rest, stiffness, damping = force(pose, velocity, **conditions)
        largest = force.law.loads[1]
        return Forces(at_rest, stiffness, damping, math.isfinite(largest) and bool(balls.load.max() > largest))

"""Bearing in Exudyn, the multibody program: a connector between two markers that calls our force element.

`add_system` adds a whole machine that vibrates about an equilibrium.

Exudyn has finite rotations and calls a Python function for the force of a connector. Here that function takes the pose
of the inner ring in the frame of the outer one, counts the angle through which it has turned, and asks `BearingForce`
or `BallForce`. With `films` "memory" the films of all slices go on from step to step: what was found last at a time is
taken as the begin of the next step, so that iterations and tries at one time do not count as steps.

Source of the interface: Exudyn's manual, ObjectConnectorRigidBodySpringDamper, springForceTorqueUserFunction.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.laws import DryLaw
from mbs.model.elements import Operation

if TYPE_CHECKING:
    from mbs.bearings.balls.ball_bearing import BallForce
    from mbs.model.elements import Forces
    from mbs.model.system import System

_SAME_SPEED = 1e-4
"""Change of the entrainment speed, as a part of it, up to which the law is not prepared anew; films go with its power
of some 0.7."""


class _Connector:
    """A bearing as a user function of Exudyn, and the time that goes on with the steps of the integrator."""

    def __init__(self, start_angle: float) -> None:
        self.start_angle = start_angle
        self._begin = self._last = _Moment()

    def add(self, system: Any, outer: Any, inner: Any) -> Any:
        """Add the connector to a system of Exudyn.

        Parameters
        ----------
        system : exudyn.MainSystem
            The system.
        outer, inner : MarkerIndex
            Markers of rigid bodies at the centre of the bearing, whose x axes are its axis.

        Returns
        -------
        ObjectIndex
            The connector.
        """
        from exudyn.utilities import ObjectConnectorRigidBodySpringDamper

        function: Any = self
        return system.AddObject(
            ObjectConnectorRigidBodySpringDamper(
                markerNumbers=[outer, inner],
                stiffness=np.zeros((6, 6)),
                damping=np.zeros((6, 6)),
                springForceTorqueUserFunction=function,
            )
        )

    def __call__(
        self,
        system: Any,
        time: float,
        item: Any,
        displacement: FloatArray,
        rotation: FloatArray,
        velocity: FloatArray,
        turning: FloatArray,
        *parameters: Any,
    ) -> FloatArray:
        """Force and moment that the connector has, (6,) [N], [N m]; arguments as Exudyn gives them."""
        cosines, sines = np.cos(rotation), np.sin(rotation)
        # Of the rotation x y z the entries that lean the axis of the inner ring.
        lean_y = sines[0] * sines[1] * cosines[2] + cosines[0] * sines[2]
        lean_z = sines[0] * sines[2] - cosines[0] * sines[1] * cosines[2]
        pose = np.array([*displacement, 0.0, -lean_z, lean_y])
        # A leaning axis goes round with the spin; that is no rate of its lean.
        rate = np.array([*velocity, 0.0, turning[1] - turning[0] * lean_y, turning[2] - turning[0] * lean_z])
        if time > self._last.time:
            self._begin = self._last
        elif time <= self._begin.time:
            self._begin = _Moment()  # another solution has begun
        # The rotation is known but for full turns.
        angle = self._begin.angle + math.remainder(float(rotation[0]) - self._begin.angle, 2.0 * math.pi)
        force, states = self._force(pose, rate, angle, float(turning[0]), time)
        self._last = _Moment(time, angle, states)
        return -force

    def _force(
        self, pose: FloatArray, rate: FloatArray, angle: float, speed: float, time: float
    ) -> tuple[FloatArray, Any]:
        """Force on the inner ring, which has turned by an angle [rad] and turns with a speed [rad/s]; states."""
        raise NotImplementedError


class ExudynBearing(_Connector):
    """A cylindrical roller bearing as a user function of Exudyn.

    The outer ring turns with the body of the first marker, the inner one with that of the second. The x axes of both
    markers are the axis of the bearing. The bearing has no force along x and no moment about it.

    Parameters
    ----------
    force : BearingForce
        The force element, with its clearance and its law.
    temperature : float
        Temperature of the raceways [K]; dry laws need none.
    films : {"slow", "memory"}
        Whether films follow at once, with stiffness and damping of slow motion, or relax; "memory" steps forward in
        time only, with the steps of the integrator.
    start_angle : float
        Angle of the first roller at the begin, from y towards z [rad].
    centrifugal : bool
        Whether rollers press on the outer ring as they go round; of laws of maps, with slow films.

    Raises
    ------
    InputError
        Where a dry law is to have films with memory, or films with memory centrifugal loads.

    Notes
    -----
    Speeds are those of the bodies: nothing is prescribed. Films follow the mean speed of the surfaces; for a change of
    less than 1e-4 of it the law is not prepared anew. Jacobians of Exudyn are differences of this force: in soft
    mounts let ``newton.numericalDifferentiation`` take steps of some 1e-12 m.

    Examples
    --------
    >>> from mbs import Bearing, BearingForce
    >>> from mbs.bearings import laws
    >>> bearing = Bearing.named("NU308", clearance=20e-6)
    >>> connector = ExudynBearing(BearingForce(bearing, laws.hertz(bearing)))
    >>> still, level = np.zeros(3), np.eye(3)
    >>> f = connector(None, 0.0, 0, np.array([0.0, 15e-6, 0.0]), still, still, still, None, None, level, level, None)
    >>> bool(f[1] > 0.0)
    True
    """

    def __init__(
        self,
        force: BearingForce,
        temperature: float = math.nan,
        films: Literal["slow", "memory"] = "slow",
        start_angle: float = 0.0,
        centrifugal: bool = False,
    ) -> None:
        if films == "memory" and isinstance(force.law, DryLaw):
            raise InputError("exudyn bearing, films: got 'memory' with a dry law; allowed: 'slow', or a law with films")
        if films == "memory" and centrifugal:
            raise InputError("exudyn bearing, centrifugal: got True with films 'memory'; allowed: with films 'slow'")
        self.force = force
        self.temperature = temperature
        super().__init__(start_angle)
        self.films = films
        self.centrifugal = centrifugal
        self._speed = math.nan

    def _force(
        self, pose: FloatArray, rate: FloatArray, angle: float, speed: float, time: float
    ) -> tuple[FloatArray, Any]:
        """Force by the law at the speed, with films of the last step if they have memory."""
        cage = self.start_angle + self.force.bearing.cage_angle(angle)
        conditions: dict[str, float] = {}
        if not isinstance(self.force.law, DryLaw):
            geometry = self.force.bearing.geometry
            entrainment = float(geometry.entrainment_speed(speed))
            if not abs(entrainment - self._speed) <= _SAME_SPEED * self._speed:
                self._speed = entrainment
            conditions = {"entrainment_speed": self._speed, "temperature": self.temperature}
        if self.centrifugal:
            conditions["centrifugal_load"] = float(self.force.bearing.centrifugal_load(speed))
        if self.films == "slow":
            found, films = self.force.evaluate(pose, rate, cage_angle=cage, **conditions), None
        elif self._begin.states is None:  # the begin, or statics
            found = self.force.evaluate(pose, cage_angle=cage, **conditions)
            films = self.force.in_time(self._speed, self.temperature, 0.0).settled(pose, cage)
        else:
            step = time - self._begin.time
            found, films = self.force.advance(self._begin.states, pose, step, cage_angle=cage, **conditions)
        return found.force, films


class ExudynBallBearing(_Connector):
    """A ball bearing as a user function of Exudyn, in five freedoms.

    The outer ring stands with the body of the first marker, the inner one turns with that of the second. The x axes of
    both markers are the axis of the bearing, their origins its middle. There is no moment about the axis.

    Parameters
    ----------
    force : BallForce
        The force element, with its clearance and its laws: dry, or with films at one speed.
    start_angle : float
        Angle of the first ball at the begin, from y towards z [rad].

    Notes
    -----
    Speeds are those of the bodies; the cage rolls at the contact angles of the step before, as in `mbs`. Films of a law
    stay those of its speed.

    Examples
    --------
    >>> from ehdmaps.physics.point.ball_catalogue import ball_estimate
    >>> from mbs.bearings.balls.ball_bearing import BallForce
    >>> from mbs.bearings.balls.laws import dry_law
    >>> connector = ExudynBallBearing(BallForce(ball_estimate("6208"), dry_law(ball_estimate("6208"))))
    >>> still, level = np.zeros(3), np.eye(3)
    >>> f = connector(None, 0.0, 0, np.array([0.0, 15e-6, 0.0]), still, still, still, None, None, level, level, None)
    >>> bool(f[1] > 0.0)
    True
    """

    def __init__(self, force: BallForce, start_angle: float = 0.0) -> None:
        from mbs.bearings.locating.locating_element import LocatingElement

        super().__init__(start_angle)
        self.force = force
        self._balls = LocatingElement("bearing", "inner", "outer", force, start_angle=start_angle)

    def _force(
        self, pose: FloatArray, rate: FloatArray, angle: float, speed: float, time: float
    ) -> tuple[FloatArray, Any]:
        """Force at the speed, with the cage of the last step."""
        found, states = self._balls.advance(self._begin.states, pose, rate, Operation(speed, angle, time))
        return found.force, states


@dataclass(frozen=True, eq=False)
class _Moment:
    """A time [s], the angle through which the inner ring has turned until then [rad], and states of the bearing."""

    time: float = -math.inf
    angle: float = 0.0
    states: Any = None


def add_system(there: Any, system: System, operation: Operation, start: FloatArray, in_time: bool = False) -> Any:
    """Add a system of ours to one of Exudyn: its matrices, and a function for bearings, meshes and all other elements.

    Parameters
    ----------
    there : exudyn.MainSystem
        The system of Exudyn.
    system : System
        The system with its n coordinates.
    operation : Operation
        Speed of the shafts, which stays, and their angle at time 0.
    start : array, shape (n,)
        Coordinates at the begin [m, rad]; the system rests there.
    in_time : bool
        False for statics and modes: the angle stays, films follow at once. True for a solution in time: shafts and
        cages turn, and films with memory go from step to step, as of `ExudynBearing`.

    Returns
    -------
    NodeIndex
        The node with the n coordinates.
    """
    from exudyn.utilities import NodeGenericODE2, ObjectGenericODE2

    elements = _Elements(system, operation, in_time)
    still = np.zeros(system.size)
    node = there.AddNode(NodeGenericODE2("", still, start, still, system.size))
    damping = system.damping + operation.speed * system.gyroscopic
    box: Any = ObjectGenericODE2("", [node], system.mass, system.stiffness, damping)
    box.forceUserFunction = lambda _, t, item, q, v: system.loads(t) + elements.summed(t, q, v, "force")
    box.jacobianUserFunction = lambda _, t, item, q, v, by_q, by_v: (
        by_q * elements.summed(t, q, v, "stiffness") + by_v * elements.summed(t, q, v, "damping")
    )
    there.AddObject(box)
    return node


class _Elements:
    """Forces of the elements of a system at the times that Exudyn asks for; of its steps the last answer counts."""

    def __init__(self, system: System, operation: Operation, in_time: bool) -> None:
        self._system, self._operation, self._in_time = system, operation, in_time
        self._begin, self._states = -math.inf, [None] * len(system.elements)
        self._time, self._tried = -math.inf, list(self._states)

    def summed(self, time: float, q: Any, v: Any, name: str) -> FloatArray:
        """Force, stiffness or damping of all elements, in the coordinates."""
        size = self._system.size
        total = np.zeros((size,) if name == "force" else (size, size))
        for connected, element in zip(self._system.elements, self._found(time, np.array(q), np.array(v)), strict=True):
            part = connected.transform.T @ getattr(element, name)
            total += part if name == "force" else part @ connected.transform
        return total

    def _found(self, time: float, q: FloatArray, v: FloatArray) -> Sequence[Forces]:
        """Answers of all elements."""
        if not self._in_time:
            return self._system.evaluate(q, v, self._operation)
        if time > self._time:
            self._begin, self._states = self._time, self._tried
        elif time <= self._begin:
            self._begin, self._states = -math.inf, [None] * len(self._states)  # another solution has begun
        angle = self._operation.angle + self._operation.speed * time
        here = self._operation._replace(angle=angle, time=time)
        found = [
            each.element.advance(before, each.transform @ q, each.transform @ v, here)
            for each, before in zip(self._system.elements, self._states, strict=True)
        ]
        self._time, self._tried = time, [state for _, state in found]
        return [forces for forces, _ in found]

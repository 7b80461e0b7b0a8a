"""The system: bodies, springs, loads and elements put together; its places and its weight.

M q'' + (D + speed G) q' + K q = loads(t) + turning loads(speed, angle) + forces of the elements(q, q', operation)

All displacements are small; spins are prescribed. A torque that drives a spin acts along the shaft's own axis, so
that a change of speed brings no lateral term.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import Problems
from ehdmaps.units import closest, short
from mbs.model.body import CENTRE, Body, Frame
from mbs.model.elements import GROUND, Element, Forces, Load, Operation, Port, Spring
from mbs.model.profiles import Constant, LoadProfile
from mbs.model.turning import TurningLoad, put_together

_SMALL = 1e-6
"""Part that may be rounding: of a translation of frames, of the stiffness that it strains."""


def load_by_gravity(body: Body) -> FloatArray | None:
    """Load on the coordinates of a body by gravity along x, y, z of 1 m/s2, shape (n, 3) [kg or kg m].

    Parameters
    ----------
    body : Body
        Rigid, a shaft, or of finite elements. A freedom that a body does not have carries its share unseen.

    Returns
    -------
    array or None
        None for a body of finite elements that are held themselves: how its mass is spread over what moves is not in
        its reduced matrices.

    Notes
    -----
    A rigid body says so itself. Of any other, M r is the load, where r are the coordinates of a translation. Static
    shapes of interfaces have that translation exactly, and modes with held interfaces have no part in it.
    """
    if body.gravity is not None:
        return body.gravity
    frames = list(body.frames.values())
    if not frames:
        return np.zeros((body.size, 3))
    transforms = np.concatenate([frame.transform for frame in frames])
    translations = np.zeros((transforms.shape[0], 3))
    for place in range(len(frames)):
        translations[6 * place : 6 * place + 3] = np.eye(3)
    plain = np.array([unit != "1" for unit in body.units])
    translation = np.zeros((body.size, 3))
    free = np.any(transforms[:, plain] != 0.0, axis=1)
    translation[plain] = np.linalg.lstsq(transforms[np.ix_(free, plain)], translations[free], rcond=None)[0]
    missed = np.max(np.abs(transforms[free] @ translation - translations[free]), initial=0.0)
    energy = np.einsum("id,ij,jd->d", translation, body.stiffness, translation)
    stiff = np.einsum("id,i,id->d", translation, np.abs(np.diag(body.stiffness)), translation)
    if missed > _SMALL or np.any(energy > _SMALL * stiff):
        return None
    return np.asarray(body.mass @ translation)


class Places:
    """Places on some bodies, written "body:frame", or "body" for its frame "centre", or "ground".

    Parameters
    ----------
    bodies : sequence of Body
        All bodies of a system.
    """

    def __init__(self, bodies: Sequence[Body]) -> None:
        self._by_name = {body.name: body for body in bodies}

    def problem(self, place: str) -> str:
        """Return what is wrong about a place, in words; empty if it exists."""
        body, _, frame = place.partition(":")
        if place == GROUND:
            return ""
        if body not in self._by_name:
            names = (*self._by_name, GROUND)
            return f"got the body {short(body)}{closest(body, names)}; allowed: {', '.join(names)}"
        frames = self._by_name[body].frames
        if (frame or CENTRE) not in frames:
            return f"got the frame {short(frame or CENTRE)} of {body!r}; allowed: {', '.join(frames)}"
        return ""

    def body_problem(self, body: str) -> str:
        """Return what is wrong about the name of a body, in words; empty if it exists."""
        names = tuple(self._by_name)
        return "" if body in names else f"got the body {short(body)}{closest(body, names)}; allowed: {', '.join(names)}"

    def frame(self, place: str) -> Frame:
        """The frame of a place on a body."""
        body, _, frame = place.partition(":")
        return self._by_name[body].frames[frame or CENTRE]

    def position(self, place: str) -> FloatArray:
        """Position of a place on a body, shape (3,) [m]."""
        return self.frame(place).position

    def spin(self, place: str) -> float:
        """Spin of the body of a place; 0 on the ground."""
        return 0.0 if place == GROUND else self._by_name[place.partition(":")[0]].spin


COINCIDENT = 1e-6
"""How far two places that an element connects may lie apart [m]."""


@dataclass(frozen=True, eq=False)
class Connected:
    """An element, and how its ports follow the coordinates of the system.

    Attributes
    ----------
    element : Element
        What makes the force.
    transform : array, shape (m, n)
        Displacement of the ports by the coordinates.
    """

    element: Element
    transform: FloatArray

    def evaluate(self, q: FloatArray, v: FloatArray, operation: Operation) -> Forces:
        """Force, stiffness and damping of the element in its ports, and whether it lies outside a map.

        Parameters
        ----------
        q : ndarray
            Coordinates of the system, shape (n,).
        v : ndarray
            Their rates, shape (n,).
        operation : Operation
            Speed, angle and time.
        """
        return self.element.evaluate(self.transform @ q, self.transform @ v, operation)


class System:
    """Bodies and what connects them.

    Parameters
    ----------
    bodies : sequence of Body
        Bodies, at least one.
    springs : sequence of Spring
        Linear springs and dampers.
    loads : sequence of Load
        Prescribed forces.
    elements : sequence of Element
        Nonlinear elements: bearings, gear meshes.
    turning : sequence of TurningLoad
        Unbalances, and excitations by an order of a spin.
    gravity : sequence of float, shape (3,)
        Acceleration of gravity [m/s2], which acts on all bodies.

    Attributes
    ----------
    coordinates, units : tuple of str
        Names such as "shaft.y", and "m", "rad" or "1"; size n.
    mass, damping, gyroscopic, stiffness : array, shape (n, n)
        M, D, G (per speed of the system) and K of bodies and springs.
    linear_parts : dict of str to array, shape (n, n)
        K by flexible body and spring.
    damping_parts : dict of str to array, shape (n, n)
        D by flexible body and spring, of those that damp.
    elements : tuple of Connected
        The nonlinear elements.
    turning : tuple of Turning
        Loads that follow the angle, put together.
    weightless : tuple of str
        Bodies on which gravity acts, but whose weight is not known, see `mbs.model.system`.

    Raises
    ------
    InputError
        With every name that is used twice, every place that does not exist, and every connection of places that
        are apart.
    """

    def __init__(
        self,
        bodies: Sequence[Body],
        springs: Sequence[Spring] = (),
        loads: Sequence[Load] = (),
        elements: Sequence[Element] = (),
        turning: Sequence[TurningLoad] = (),
        gravity: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> None:
        self.bodies = tuple(bodies)
        self._by_name = {body.name: body for body in self.bodies}
        self._places = Places(self.bodies)
        self._check(springs, loads, elements, turning)
        self._first = dict(
            zip(self._by_name, np.cumsum([0, *(body.size for body in self.bodies)])[:-1].tolist(), strict=True)
        )
        self.coordinates = tuple(f"{body.name}.{key}" for body in self.bodies for key in body.coordinates)
        self.units = tuple(unit for body in self.bodies for unit in body.units)
        self.mass, self.damping, self.gyroscopic, self.stiffness = (np.zeros((self.size, self.size)) for _ in range(4))
        self.linear_parts: dict[str, FloatArray] = {}
        self.damping_parts: dict[str, FloatArray] = {}
        for body in self.bodies:
            here = self._slice(body)
            self.mass[here, here] = body.mass
            self.gyroscopic[here, here] = body.spin * body.gyroscopic
            self.damping[here, here] = body.damping
            self.stiffness[here, here] = body.stiffness
            if np.any(body.stiffness):
                self.linear_parts[body.name] = np.zeros((self.size, self.size))
                self.linear_parts[body.name][here, here] = body.stiffness
            if np.any(body.damping):
                self.damping_parts[body.name] = np.zeros((self.size, self.size))
                self.damping_parts[body.name][here, here] = body.damping
        for spring in springs:
            transform = self.relative(spring.on, spring.against)
            part = transform.T @ spring.stiffness @ transform
            self.linear_parts[spring.name] = part
            self.stiffness += part
            if np.any(spring.damping):
                self.damping_parts[spring.name] = transform.T @ spring.damping @ transform
                self.damping += self.damping_parts[spring.name]
        given = [
            (self.relative(load.on, load.against).T @ np.asarray(load.force, dtype=np.float64), load.profile)
            for load in loads
        ]
        self._steady = sum((load for load, profile in given if isinstance(profile, Constant)), np.zeros(self.size))
        self._varying = tuple((load, profile) for load, profile in given if not isinstance(profile, Constant))
        self.turning = put_together([(load, self.relative(load.on, load.against).T @ load.vector) for load in turning])
        self.weightless: tuple[str, ...] = ()
        if any(gravity):
            self._add_weight(np.asarray(gravity, dtype=np.float64))
        self.elements = tuple(
            Connected(element, np.concatenate([self._port(port) for port in element.ports])) for element in elements
        )

    def select(self, kind: type) -> tuple[int, ...]:
        """Indices of the elements that are of a kind, such as `mbs.bearings.bearing_element.RingElement`."""
        return tuple(i for i, connected in enumerate(self.elements) if isinstance(connected.element, kind))

    def evaluate(self, q: FloatArray, v: FloatArray, operation: Operation) -> tuple[Forces, ...]:
        """Forces of all elements in their ports, in the order of `elements`.

        Parameters
        ----------
        q, v : array, shape (n,)
            Coordinates [m or rad] and their rates.
        operation : Operation
            Speed, angle and time.
        """
        return tuple(connected.evaluate(q, v, operation) for connected in self.elements)

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return len(self.coordinates)

    @property
    def steady_loads(self) -> FloatArray:
        """Generalised loads that do not vary, shape (n,) [N or N m]."""
        return self._steady

    @property
    def varying_loads(self) -> tuple[tuple[FloatArray, LoadProfile], ...]:
        """Generalised loads that vary, (n,) [N or N m], each with its factor over time."""
        return self._varying

    def with_load(self, load: FloatArray, profile: LoadProfile) -> System:
        """The system with one more generalised load (n,) [N or N m], and its factor over time."""
        loaded = copy.copy(self)
        loaded._varying = (*self._varying, (load, profile))
        return loaded

    def with_elements(self, elements: Sequence[Element]) -> System:
        """The system with other elements, each on the ports of the one in its place."""
        changed = copy.copy(self)
        changed.elements = tuple(
            Connected(element, connected.transform) for element, connected in zip(elements, self.elements, strict=True)
        )
        return changed

    def loads(self, time: float) -> FloatArray:
        """Generalised loads at a time [s], shape (n,) [N or N m]."""
        total = self._steady.copy()
        for load, profile in self._varying:
            total += profile(time) * load
        return total

    def turning_loads(self, speed: float, angle: float, rate: float) -> FloatArray:
        """Generalised loads that follow the angle, shape (n,) [N or N m].

        Parameters
        ----------
        speed, angle, rate : float
            Speed of the system, its angle and the rate of its speed [rad/s, rad, rad/s2].
        """
        total = np.zeros(self.size)
        for load in self.turning:
            total += load.at(speed, angle, rate)
        return total

    def relative(self, on: str, against: str = GROUND) -> FloatArray:
        """Displacement of a place against another by the coordinates, shape (6, n)."""
        return self._place(on) - self._place(against)

    def body(self, name: str) -> Body:
        """The body of that name."""
        return self._by_name[name]

    def own(self, body: str) -> slice:
        """Slice of the coordinates of a body."""
        return self._slice(self._by_name[body])

    def _add_weight(self, gravity: FloatArray) -> None:
        """Add the weight of all bodies to the steady loads."""
        unknown = []
        for body in self.bodies:
            weight = load_by_gravity(body)
            if weight is None:
                unknown.append(body.name)
            else:
                self._steady[self._slice(body)] += weight @ gravity
        self.weightless = tuple(unknown)

    def _slice(self, body: Body) -> slice:
        """Slice of the coordinates of a body."""
        first = self._first[body.name]
        return slice(first, first + body.size)

    def _place(self, place: str) -> FloatArray:
        """Displacement of a place by the coordinates, shape (6, n)."""
        matrix = np.zeros((6, self.size))
        if place != GROUND:
            body = self._by_name[place.partition(":")[0]]
            matrix[:, self._slice(body)] = self._places.frame(place).transform
        return matrix

    def _port(self, port: Port) -> FloatArray:
        """Displacement of a port by the coordinates."""
        if port.coordinates:
            return np.eye(self.size)[self.own(port.on)]
        return self.relative(port.on, port.against)

    def _check(
        self,
        springs: Sequence[Spring],
        loads: Sequence[Load],
        elements: Sequence[Element],
        turning: Sequence[TurningLoad],
    ) -> None:
        """Raise with all that does not fit together."""
        problems = Problems([] if self.bodies else ["system, bodies: got none; allowed: at least one body"])
        seen: set[str] = {GROUND}
        names = [thing.name for group in (self.bodies, springs, loads, elements, turning) for thing in group]
        for name in names:
            if name in seen:
                problems.append(f"{name!r}: is there twice; bodies, springs, loads and bearings have names apart")
            seen.add(name)
        problems += [
            f"{element.name!r}, {member}: missing; allowed: {words}, or None; an element inherits that from "
            "mbs.model.elements.ElementDefaults"
            for element in elements
            for member, words in (("excitation", "how often it excites"), ("relaxation", "what of it needs time"))
            if not hasattr(element, member)
        ]
        for where, on, against in _connections(springs, (*loads, *turning), elements):
            wrong = [problem for place in (on, against) if (problem := self._places.problem(place))]
            problems += [f"{where}: {problem}" for problem in wrong]
            if not wrong and GROUND not in (on, against):
                apart = float(np.linalg.norm(self._places.position(on) - self._places.position(against)))
                if apart > COINCIDENT:
                    problems.append(
                        f"{where}: {on} and {against} are {apart * 1e3:.4g} mm apart; allowed: the same point; give "
                        "one of the bodies a frame there"
                    )
        problems.check()


def _connections(
    springs: Sequence[Spring], loads: Sequence[Load | TurningLoad], elements: Sequence[Element]
) -> Iterator[tuple[str, str, str]]:
    """Yield name and both places of everything that connects places."""
    for spring in springs:
        yield f"spring {spring.name!r}", spring.on, spring.against
    for load in loads:
        yield f"load {load.name!r}", load.on, load.against
    for element in elements:
        for port in element.ports:
            if not port.coordinates:
                yield f"element {element.name!r}", port.on, port.against

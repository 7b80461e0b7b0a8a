"""Connections between bodies: linear springs, loads, and nonlinear elements such as bearings; and sensors.

A place is written "body:frame", or "body" for its frame "centre", or "ground". Two places that an element connects
are at the same point of the system, so that forces and moments balance without lever arms.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, Protocol

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError
from mbs.model.findings import Gauge
from mbs.model.profiles import Constant, LoadProfile
from mbs.model.relaxation import Relaxation

if TYPE_CHECKING:
    from mbs.model.condensed import Condensed

GROUND = "ground"
"""The place that does not move."""

MESH = "mesh:"
"""What the place of an input begins with that is a gear mesh; the name of the pair follows."""


class Operation(NamedTuple):
    """Operating point of a system on its prescribed course.

    Attributes
    ----------
    speed : float
        Speed of the system [rad/s].
    angle : float
        What it has turned since the beginning [rad].
    time : float
        [s].
    """

    speed: float = 0.0
    angle: float = 0.0
    time: float = 0.0


@dataclass(frozen=True)
class Port:
    """Motion that a nonlinear element feels: the displacement of a place against another, or a body's own coordinates.

    Attributes
    ----------
    on : str
        A place; or the name of a body, with `coordinates`.
    against : str
        A place at the same point; "ground" for the absolute displacement.
    coordinates : bool
        Whether the port is the vector of all coordinates of the body instead of six displacements.
    """

    on: str
    against: str = GROUND
    coordinates: bool = False


class Forces(NamedTuple):
    """Answer of a nonlinear element to a motion of its ports.

    Attributes
    ----------
    force : array, shape (m,)
        Generalised force on the `on` side of each port [N or N m]; the `against` side gets the opposite.
    stiffness, damping : array, shape (m, m)
        -d force/d displacement and -d force/d velocity.
    outside : bool
        Whether a contact was outside its map, in load, speed or temperature, and its law held at the edge; False for
        an element without a map.
    """

    force: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    outside: bool = False


class Powers(NamedTuple):
    """Sinks and sources of the power that an element exchanges, besides what it stores.

    Attributes
    ----------
    dissipated : float
        What it takes up for good, such as by its dampers [W].
    driven : float
        What its prescribed course brings in, such as the turning of a cage or a transmission error [W].
    spent : float
        What it took up for good over the last step, besides [J]: of states that follow within a step.
    """

    dissipated: float
    driven: float
    spent: float = 0.0


class Excitation(NamedTuple):
    """Orders at which an element excites its system, for what follows orders.

    Attributes
    ----------
    order : float
        How often for each turn of the system, > 0.
    harmonics : int
        How many multiples are worth following.
    rank : int
        Rank among the elements of a system: only the highest is followed, because gear meshes drown the rollers that
        pass.
    """

    order: float
    harmonics: int
    rank: int


class Element(Protocol):
    """A nonlinear element. Its force is linear algebra in its ports; what happens in there is its own.

    An element has every member; a class that inherits from `ElementDefaults` leaves out what it does not do. Runs in
    time call it from Python, unless `mbs.transient.kinds` lists it with a block for compiled code.
    """

    @property
    def name(self) -> str:
        """For messages and results."""
        ...

    @property
    def ports(self) -> tuple[Port, ...]:
        """Ports that it feels; the displacements of all ports make one vector of size m."""
        ...

    @property
    def excitation(self) -> Excitation | None:
        """Orders at which it excites the system; None for an element that does not by itself."""
        ...

    def evaluate(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> Forces:
        """Generalised force on the ports, how it falls with their motion, and whether it lies outside a map.

        Parameters
        ----------
        displacement, velocity : array, shape (m,)
            Motion of all ports, one after the other [m or rad, and per s].
        operation : Operation
            Speed, angle and time.

        Raises
        ------
        OutsideMapError
            Outside a map whose law has the policy "error".
        """
        ...

    def advance(
        self, states: Any, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> tuple[Forces, Any]:
        """The same at the end of a step in time, for an element with states of its own.

        Parameters
        ----------
        states : object
            What the element returned at the end of the last step that was made; None at the beginning of a run.
        displacement, velocity, operation
            What `evaluate` takes, at the end of the step.
        """
        ...

    def powers(
        self, states: Any, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> Powers | None:
        """Power that it dissipates, and that its prescribed course brings in; None for an element that does not say.

        With U of `stored`, at a steady speed, the power of its force on its ports is driven - dissipated - dU/dt.

        Parameters
        ----------
        states : object
            States that `advance` returned.
        force : array, shape (m,)
            Force that it returned.
        displacement, velocity, operation
            What it took.
        """
        ...

    def stored(self, states: Any, displacement: FloatArray, operation: Operation) -> float | None:
        """Energy that it stores [J]; None for an element that does not say.

        Parameters
        ----------
        states, displacement, operation
            What `advance` returned and took.
        """
        ...

    def brought_by_speed(self, displacements: FloatArray, operations: Sequence[Operation]) -> float:
        """Energy that changes of the speed brought into it by changing its law, over a run [J].

        Parameters
        ----------
        displacements : array, shape (samples, m)
            Displacements of all ports.
        operations : sequence of Operation
            Speed, angle and time of each sample.
        """
        ...

    def relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """Part of its stiffness that needs time, for small oscillations about rest; None for K and C at any frequency.

        Parameters
        ----------
        displacement : array, shape (m,)
            Displacements of all ports, at rest [m or rad].
        operation : Operation
            Speed, angle and time.
        """
        ...


class ElementDefaults:
    """Answers of an element that has no states, excites nothing and does not relax, to inherit from."""

    def advance(
        self, states: Any, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> tuple[Forces, Any]:
        """Return what `evaluate` says: there are no states; see `Element.advance`."""
        return self.evaluate(displacement, velocity, operation), None

    def evaluate(self, displacement: FloatArray, velocity: FloatArray, operation: Operation) -> Forces:
        """Forces that each element has of its own, see `Element.evaluate`."""
        raise NotImplementedError

    @property
    def excitation(self) -> Excitation | None:
        """None: it answers motion only."""
        return None

    def powers(
        self, states: Any, force: FloatArray, displacement: FloatArray, velocity: FloatArray, operation: Operation
    ) -> Powers | None:
        """None: it does not say; see `Element.powers`."""
        return None

    def stored(self, states: Any, displacement: FloatArray, operation: Operation) -> float | None:
        """None: it does not say; see `Element.stored`."""
        return None

    def brought_by_speed(self, displacements: FloatArray, operations: Sequence[Operation]) -> float:
        """None at all: its law is the same at any speed."""
        return 0.0

    def relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """None: stiffness and damping are the same at any frequency."""
        return None


class OnRings(ElementDefaults):
    """Element whose first six displacements are those of an inner ring: a bearing of rollers or of balls.

    Attributes
    ----------
    locating : bool
        Whether it holds the ring along the axis, once its clearance is taken up.
    deviation_data : DeviationData or None
        Deviations from its form, see `mbs.bearings.deviating.tables`; None of a perfect bearing.
    memory_words : str
        What describes films with memory, and leaves the rest of their response out.
    """

    locating: ClassVar[bool] = False
    deviation_data: Any = None
    memory_words: ClassVar[str] = "springs and dampers of films with memory leave"

    if TYPE_CHECKING:  # a property at run time would be the default of the fields of this name

        @property
        def name(self) -> str:
            """Name of the element."""

    @property
    def rolling_element(self) -> str:
        """Name of one of its rolling elements: roller, ball."""
        return "roller"

    @property
    def count(self) -> int:
        """Number of its rolling elements that a cage carries past a place in a turn; 0 where none are known."""
        return 0

    @property
    def relaxes(self) -> bool:
        """Sign of films with memory."""
        return False

    @property
    def entrainment_rate(self) -> float:
        """Entrainment speed of its contacts by the speed of the system [m]; 0 where nothing rolls, or none is known."""
        return 0.0

    @property
    def slowest_film(self) -> float:
        """Entrainment speed from which on its law has films [m/s]; 0 where it has none, or at any speed."""
        return 0.0

    @property
    def film_source(self) -> str:
        """Source of its films in words; empty where it is that of the law of the system."""
        return ""

    def forget(self, operation: Operation) -> None:
        """Drop what the last call left as a start for the next one, so that results do not depend on it.

        Parameters
        ----------
        operation : Operation
            Speed of the calls to come.
        """

    def deviate(self, added: FloatArray | None) -> None:
        """Add approaches, and their rates, to its contacts until it is told otherwise.

        Parameters
        ----------
        added : array (Z, 2, 2) or None
            Approach [m] and rate [m/s] of the inner and the outer contact of each rolling element.
        """
        raise NotImplementedError

    @contextlib.contextmanager
    def deviating(self, operation: Operation) -> Iterator[None]:
        """The bearing with its deviations where the system has turned so far.

        Parameters
        ----------
        operation : Operation
            Speed and angle.
        """
        if self.deviation_data is None:
            yield
            return
        self.deviate(self.deviation_data.at(operation.angle, operation.speed))
        try:
            yield
        finally:
            self.deviate(None)

    def passed(self, part: float) -> OnRings:
        """The same bearing, its cage further on by a part of the pitch of its rolling elements.

        Itself where no cage turns, and where rolling elements have coordinates, which belong to one place.

        Parameters
        ----------
        part : float
            Part of the pitch, in the direction in which the cage turns.
        """
        return self

    def felt(self, displacement: FloatArray, operation: Operation) -> tuple[Any, Any]:
        """Pressures and films of its contacts at rest, and what rolling costs, by the law in force.

        `BearingContacts` and `RollingLoss` of `mbs.bearings.contact_report`.

        Parameters
        ----------
        displacement : array (6,)
            Displacement of the inner ring against the outer one.
        operation : Operation
            Speed and angle.
        """
        raise NotImplementedError

    def largest_load(self, displacement: FloatArray, operation: Operation) -> float:
        """Load of its most loaded contact at rest, in the unit of its law; NaN where none is known.

        Parameters
        ----------
        displacement : array (6,)
            Displacement of the inner ring against the outer one.
        operation : Operation
            Speed and angle.

        Returns
        -------
        float
            Load of a ball [N], or load per length of a slice of a roller [N/m].
        """
        return math.nan

    def loads(self, displacement: FloatArray, operation: Operation) -> Any:
        """State of its rolling elements at rest: their angles, `angle`, and loads, `load`, by the law in force.

        Parameters
        ----------
        displacement, operation
            The same as of `felt`.
        """
        raise NotImplementedError

    def element_loads(self, displacement: FloatArray, operation: Operation) -> FloatArray | None:
        """Loads of all rolling elements on the inner raceway at rest, shape (Z,) [N]; None where none are known.

        Parameters
        ----------
        displacement : array, shape (m,)
            Displacements of its ports.
        operation : Operation
            Speed and angle.
        """
        return None

    def gauge(self, displacement: FloatArray, operation: Operation) -> Gauge | None:
        """Measure what its contacts feel at rest, and what is beyond their limits; None where none are known.

        Parameters
        ----------
        displacement, operation
            The same as of `element_loads`.
        """
        return None

    @property
    def error_words(self) -> str:
        """Name the errors that its law states, for people; empty for laws that state none."""
        return ""

    def sides(self, displacement: FloatArray, operation: Operation) -> tuple[Any, ...]:
        """Its slices at rest by laws whose errors are known slice by slice; none of other bearings.

        Parameters
        ----------
        displacement, operation
            The same as of `small_motions`.

        Returns
        -------
        tuple of Side
            Slices of each side, see `mbs.bearings.slices_in_balance`.
        """
        return ()

    def small_motions(self, displacement: FloatArray, operation: Operation) -> Condensed | None:
        """Condense its rolling elements for small motions, with what errors of its law change; None without films.

        Parameters
        ----------
        displacement : array, shape (m,)
            Displacements of its ports, at rest [m or rad].
        operation : Operation
            Speed, angle and time.
        """
        return None

    def film_relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """Find how its films would relax, whether linear analyses are to see that or not; None without films.

        Parameters
        ----------
        displacement, operation
            The same as of `small_motions`.
        """
        return None

    def relaxation(self, displacement: FloatArray, operation: Operation) -> Relaxation | None:
        """Relaxation of its films, where they relax, see `Element.relaxation`."""
        return self.film_relaxation(displacement, operation) if self.relaxes else None


def check_apart(name: str, pose: FloatArray, most: tuple[float, float], time: float, *, beyond: bool = False) -> None:
    """Refuse rings of a locating bearing that nothing holds together any more; values that are none pass.

    Parameters
    ----------
    name : str
        Name of the bearing, for messages.
    pose : array (6,)
        Pose of the inner ring in the outer one.
    most : (float, float)
        Largest displacement [m] and tilt [rad] at which rolling bodies are between raceways.
    time : float
        Time [s].
    beyond : bool
        Whether the inner ring is where it has no raceway, however near.

    Raises
    ------
    AnalysisError
        For such rings.
    """
    if beyond or np.any(np.abs(pose[:3]) > most[0]) or np.any(np.abs(pose[4:]) > most[1]):
        raise AnalysisError(
            f"bearing {name!r}: its rings are apart by {1e6 * pose[0]:.4g} um along and "
            f"{1e6 * math.hypot(pose[1], pose[2]):.4g} um across at {time:.6g} s, where no raceway is: preload is "
            "lost; take more preload, a stop, or smaller loads"
        )


@dataclass(frozen=True, eq=False)
class Spring:
    """A linear spring and damper between two places.

    Attributes
    ----------
    name : str
        Name for messages and results.
    on, against : str
        Both places.
    stiffness, damping : array, shape (6, 6)
        Matrices of the six displacements of `on` against `against` [N/m, N m/rad; with s]; symmetric.
    assumed : bool
        Whether nobody stated its stiffness.
    """

    name: str
    on: str
    against: str
    stiffness: FloatArray
    damping: FloatArray = field(default_factory=lambda: np.zeros((6, 6)))
    assumed: bool = False


@dataclass(frozen=True, eq=False)
class Load:
    """A force and moment at a place, with its reaction at another.

    Attributes
    ----------
    name : str
        Name for messages and results.
    on : str
        Place of the load.
    force : array, shape (6,)
        Three forces [N] and three moments [N m].
    against : str
        Place that gets the opposite.
    profile : LoadProfile
        Factor over time.
    """

    name: str
    on: str
    force: FloatArray
    against: str = GROUND
    profile: LoadProfile = field(default_factory=Constant)


Quantity = Literal["displacement", "velocity", "acceleration"]


@dataclass(frozen=True, eq=False)
class Sensor:
    """Motion of a place along a direction, absolute or against another place.

    Attributes
    ----------
    name : str
        Name for messages and results.
    on, against : str
        Places, anywhere; the output is the difference.
    direction : array, shape (6,)
        Weights of the six displacements, such as (0, 1, 0, 0, 0, 0) for y.
    quantity : {"displacement", "velocity", "acceleration"}
        What is sensed.
    """

    name: str
    on: str
    direction: FloatArray
    quantity: Quantity = "displacement"
    against: str = GROUND

    @property
    def order(self) -> int:
        """Order of the derivative of the displacement that it senses: 0, 1 or 2."""
        return ("displacement", "velocity", "acceleration").index(self.quantity)


@dataclass(frozen=True, eq=False)
class Input:
    """A load that a linear analysis varies.

    Attributes
    ----------
    name : str
        Name for messages and results.
    on, against : str
        Both places; `against` gets the opposite.
    direction : array, shape (6,)
        Load at amplitude 1 N or 1 N m.
    amplitude : float
        How large it is in operation [N or N m]; a linear analysis is compared with static loads at this size.
    """

    name: str
    on: str
    direction: FloatArray
    against: str = GROUND
    amplitude: float = 1.0

    @property
    def unit(self) -> str:
        """Unit of the amplitude: N, or N m of a moment."""
        return "N m" if np.any(self.direction[3:]) else "N"

    @property
    def places(self) -> tuple[str, ...]:
        """Places at which it acts."""
        return self.on, self.against


@dataclass(frozen=True, eq=False)
class MeshInput(Input):
    """A gear mesh that a linear analysis varies; `on` is `mesh:NAME` of a gear pair, and there is no direction.

    Attributes
    ----------
    quantity : {"force", "transmission_error"}
        What is varied: a force along the line of action [N], or the transmission error [m].
    """

    quantity: Literal["force", "transmission_error"] = "force"

    @property
    def pair(self) -> str:
        """Name of the gear pair."""
        return self.on.removeprefix(MESH)

    @property
    def unit(self) -> str:
        """N, or m of a transmission error."""
        return "m" if self.quantity == "transmission_error" else "N"

    @property
    def places(self) -> tuple[str, ...]:
        """None: the places are those of the gears."""
        return ()

"""The bearing force at one speed, temperature and centrifugal load: the law is prepared once and then called fast.

Loads, approaches and films of the rollers are there to look at.
"""

from __future__ import annotations

import ctypes
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError, OutsideMapError, Problems
from ehdmaps.maps.kernels.tables import POWER_LAW
from mbs.bearings import cylinder as table
from mbs.bearings.bearing import Bearing
from mbs.bearings.cylinder import (
    ABOVE_LOAD,
    GROWING,
    NO_LOADS,
    NOT_FINITE,
    TOO_FAR,
    WHOLE,
    WITHOUT_KNOTS,
    Arrays,
    Cylinder,
    functions,
)
from mbs.bearings.laws import DryLaw, FlatLaw, Law, unilateral_forces
from mbs.model.elements import Forces
from mbs.model.findings import CARRIES

if TYPE_CHECKING:
    from ehdmaps.maps.law import ContactLaw
    from ehdmaps.physics.bearing import BearingGeometry
    from mbs.life import ReferenceLife


@dataclass(frozen=True, eq=False)
class RollerLoads:
    """State of all rollers at one pose.

    Attributes
    ----------
    angle : array (Z,)
        Angles of the rollers in O, from y towards z, within -pi to pi [rad].
    load : array (Z,)
        Load of each roller on the inner raceway [N].
    moment : array (Z,)
        Tilting moment of each roller's load about its middle [N m].
    load_per_length : array (Z, n)
        Load of the slices on the inner raceway [N/m].
    damping : array (Z, n)
        Damping of the slices at rest, per unit length [N s/m2].
    approach : array (Z, n)
        Total approach of both contacts of the slices [m]; below zero a gap, or a film. Of coupled slices the part that
        belongs to their own load.
    position : array (n,)
        Middles of the slices along the roller [m].
    row : array (Z,)
        Places of the rows of the rollers along x [m].
    """

    angle: FloatArray
    load: FloatArray
    moment: FloatArray
    load_per_length: FloatArray
    damping: FloatArray
    approach: FloatArray
    position: FloatArray
    row: FloatArray

    @property
    def loaded(self) -> int:
        """Number of rollers that carry more than 1 % of the highest roller load: films load all a little."""
        return int(np.count_nonzero(self.load > CARRIES * self.load.max()))

    def life(self, geometry: BearingGeometry, inner_turns: bool) -> ReferenceLife:
        """Equivalent load and life of ISO/TS 16281, by the rating of ISO 281.

        Parameters
        ----------
        geometry : BearingGeometry
            Geometry of the bearing.
        inner_turns : bool
            Whether the inner ring turns against the load.
        """
        from ehdmaps.physics.rollers.ratings import cylindrical_ratings  # where lives are asked for
        from mbs.life import roller_reference_life

        slices = self.load_per_length * geometry.roller_length / self.position.size
        rating, both, rows = cylindrical_ratings(geometry)[0], np.stack([slices, slices]), geometry.row_count
        return roller_reference_life(both, rating, geometry.gamma, 0.0, inner_turns=inner_turns, rows=rows)


def roller_loads(
    bearing: Bearing,
    states: FloatArray,
    rollers: FloatArray,
    cage_angle: float,
    own: FloatArray | None = None,
) -> RollerLoads:
    """Make the record from what a call leaves.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    states : array (4, Z, n)
        States of the slices, see `mbs.bearings.cylinder.Arrays.states`.
    rollers : array (4, Z)
        Motion of the rollers, see `mbs.bearings.cylinder.Arrays.rollers`.
    cage_angle : float
        Angle of the first roller [rad].
    own : array (Z, n), optional
        Approaches that the law takes, of slices that are coupled [m]; their loads are those at rest.
    """
    x, profile = bearing.slice_positions, 2.0 * bearing.profile_depths
    gap, tilt, gap_rate, tilt_rate = (part[:, None] for part in rollers)
    approach = gap + x * tilt - profile
    rate = gap_rate + x * tilt_rate
    if own is None:
        load, _, _ = unilateral_forces(states[0], states[1], states[2], states[3], rate)
    else:
        load, approach = states[0].copy(), own.copy()
    angle = cage_angle + bearing.roller_angles
    return RollerLoads(
        angle=np.arctan2(np.sin(angle), np.cos(angle)),
        load=load.sum(axis=1) * bearing.slice_length,
        moment=(load * x).sum(axis=1) * bearing.slice_length,
        load_per_length=load,
        damping=states[2].copy(),
        approach=approach,
        position=x.copy(),
        row=bearing.row_places,
    )


Triple = tuple[FloatArray, FloatArray, FloatArray]
"""Force, stiffness, damping."""

_WHOLE_ROLLERS = ("iso16281", "palmgren")
_SIX = (6,)
_KIND = table.LawNumbers._fields.index("kind")
_BEYOND = 2 + 4
"""Parts of a status: a speed and a temperature outside the map."""


@dataclass(frozen=True)
class ForceAddress:
    """A bearing force in C, for programs that call it themselves; good as long as its `ForceAtPoint` is.

    `PROTOTYPE` is the type of the function for `ctypes`, which numba's compiled code calls as well: ``int
    ehd_cylinder_force(const void *data)``. It takes `ForceAtPoint.state`, fills `ForceAtPoint.answer`, and returns 0,
    or how the bearing lies outside the map, or what is wrong about its pose (then the answer stays as it was); see
    `ehdmaps/kernel/c/cylinder/cylinder.h`. One thread at a time.

    Attributes
    ----------
    function, data : int
        Addresses of the function and of what it takes.
    """

    function: int
    data: int

    PROTOTYPE: ClassVar = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)


class ForceAtPoint:
    """A `BearingForce` at one speed, temperature and centrifugal load; make it by `BearingForce.at`.

    Parameters
    ----------
    bearing : Bearing
        Geometry, clearance, profile, slices.
    flat_law : FlatLaw
        The law.
    conditions : (float, float, float)
        u [m/s], T [K], centrifugal load [N/m].
    work : Arrays, optional
        Arrays that elements at one point after the other use: the table then gets its cells as slices need them. New
        ones, with a whole table, if left out.

    Attributes
    ----------
    conditions : (float, float, float)
        u [m/s], T [K], centrifugal load [N/m]; NaN where a dry law was given none.
    state : array (13,)
        Pose (6), velocity (6) and angle of the cage of the last call [m], [rad], [m/s], [rad/s].
    answer : array (13, 6)
        Force, six rows of stiffness, six rows of damping of the last call.
    """

    def __init__(
        self,
        bearing: Bearing,
        flat_law: FlatLaw,
        conditions: tuple[float, float, float],
        work: Arrays | None = None,
    ) -> None:
        self.conditions = conditions
        self._bearing, self._flat_law = bearing, flat_law
        self._work = work or Arrays(bearing, coupling_beside(bearing, flat_law.law))
        self._passing = work is not None
        self._outside = False
        law, centrifugal_load = flat_law.law, conditions[2]
        if isinstance(law, DryLaw):
            if centrifugal_load != 0.0:
                raise InputError(
                    f"bearing force, centrifugal_load: got {centrifugal_load!r} N/m with the law {law.name!r}; "
                    "allowed: 0; only a map's law brings rollers into equilibrium"
                )
            self._work.numbers[:], cells = law.prepared(bearing.geometry.roller_length)
            if cells is not None:
                self._work.array("cells")[:] = cells
        else:
            self._prepare(law)
        self._force, self._call = functions().force, self._work.call.address
        self.state, self.answer = self._work.state, self._work.answer
        self._pose, self._velocity = self.state[:6], self.state[6:12]

    def __reduce__(self) -> tuple[Any, ...]:
        """For other processes: as it was made, see `BearingForce`."""
        return ForceAtPoint, (self._bearing, FlatLaw(self._flat_law.law), self.conditions)

    def __repr__(self) -> str:
        """Bearing, conditions and law."""
        u, T, q = self.conditions
        law = self._flat_law.law
        return f"<ForceAtPoint {self._bearing.geometry.title} at {u:.4g} m/s, {T:.4g} K, {q:.4g} N/m: {law!r}>"

    def __call__(self, pose: npt.ArrayLike, velocity: npt.ArrayLike | None = None, cage_angle: float = 0.0) -> Triple:
        """Force, stiffness and damping; as calling the `BearingForce`. The arrays are new ones each time."""
        out, _ = self._found(pose, velocity, cage_angle)
        return out[0], out[1:7], out[7:]

    def evaluate(self, pose: npt.ArrayLike, velocity: npt.ArrayLike | None = None, cage_angle: float = 0.0) -> Forces:
        """As a call, and whether a slice was outside the map.

        Parameters
        ----------
        pose, velocity : array (6,)
            Pose of the inner ring in O [m], [rad], and its rate; at rest if there is no velocity.
        cage_angle : float
            Angle of the first roller [rad].
        """
        out, outside = self._found(pose, velocity, cage_angle)
        return Forces(out[0], out[1:7], out[7:], outside)

    def _found(self, pose: npt.ArrayLike, velocity: npt.ArrayLike | None, cage_angle: float) -> tuple[FloatArray, bool]:
        """Force, stiffness and damping in rows (13, 6), and whether a slice was outside the map."""
        self._pose[...] = pose if type(pose) is np.ndarray and pose.shape == _SIX else six_numbers("pose", pose)
        if velocity is None:
            self._velocity[...] = 0.0
        elif type(velocity) is np.ndarray and velocity.shape == _SIX:
            self._velocity[...] = velocity
        else:
            self._velocity[...] = six_numbers("velocity", velocity)
        self.state[12] = cage_angle
        status = self._force(self._call)
        outside = self._settle(status) if status != 0 or self._outside else False
        return self.answer.copy(), outside

    @property
    def address(self) -> ForceAddress:
        """The force for programs that call C: they write `state`, call, and read `answer`.

        Examples
        --------
        >>> import ehdmaps
        >>> from mbs import Bearing, BearingForce
        >>> from mbs.bearings.laws import formula
        >>> bearing = Bearing.named("NU308")
        >>> force = BearingForce(bearing, formula(bearing, ehdmaps.Lubricant.named("FVA3"))).at(1.7, 313.15)
        >>> force.state[2], at = 1e-5, force.address
        >>> at.PROTOTYPE(at.function)(at.data)
        0
        >>> bool(force.answer[0, 2] == force([0.0, 0.0, 1e-5, 0.0, 0.0, 0.0])[0][2])
        True
        """
        function = ctypes.cast(self._force, ctypes.c_void_p).value  # type: ignore[arg-type]
        return ForceAddress(function or 0, self._call)

    @property
    def numbers(self) -> FloatArray:
        """Numbers of its law, (NUMBERS,), see `mbs.bearings.cylinder.LawNumbers`."""
        return self._work.numbers

    @property
    def cells(self) -> FloatArray | None:
        """Cells of its law, (2 ROWS, 4, 2); None of a law that needs none."""
        cells: FloatArray | None = self._work.law.given("cells")
        return cells

    @property
    def knots(self) -> FloatArray | None:
        """Approaches at which the cells of a faded film begin [m], (2 ROWS,); None of other laws."""
        knots: FloatArray | None = self._work.law.given("knots")
        return knots

    @property
    def outside(self) -> bool:
        """True where speed or temperature lie outside the map, so that every call counts."""
        return self._outside

    def rollers(
        self, pose: npt.ArrayLike, velocity: npt.ArrayLike | None = None, cage_angle: float = 0.0
    ) -> RollerLoads:
        """Loads and approaches of all rollers and slices, to look at.

        Parameters
        ----------
        pose : array_like
            Pose of the inner ring in O, shape (6,) [m], [rad].
        velocity : array_like, optional
            Rate of the pose, shape (6,) [m/s], [rad/s]; at rest if left out.
        cage_angle : float
            Angle at which the cage stands [rad].
        """
        self(pose, velocity, cage_angle)
        work = self._work
        states = work.states()
        if self.numbers[_KIND] == table.BY_SLICES and work.coupling is None:
            self._velocity[...] = 0.0  # the rates are in the loads
        return roller_loads(self._bearing, states, work.rollers(), cage_angle, work.own)

    def _prepare(self, law: ContactLaw) -> None:
        """Make the law of this point ready, with all its cells, or with those that slices need."""
        work, coupled = self._work, self._work.coupling is not None
        u, T, q = check_conditions(self.conditions)
        if not 0.0 <= q < law.load_range[1]:
            law.at(u, T, q)  # which refuses it
        asked = WITHOUT_KNOTS if coupled else GROWING if self._passing else WHOLE
        status = work.prepare(self._flat_law.data(law, q > 0.0), (u, T, q), asked)
        self._outside = status != 0
        if status != 0 and (law.outside == "error" or status & ~_BEYOND):
            law.at(u, T, q)  # which refuses it

    def _settle(self, status: int) -> bool:
        """Raise what a status asks for. Whether outside the map."""
        work, law = self._work, self._flat_law.law
        if status & NO_LOADS:
            raise AnalysisError(
                f"bearing force, coupled slices: no loads of a roller at the pose {work.state[:6].tolist()}; its "
                "contacts are wider than at the static limit, for which the coupling is made, or slices are too many; "
                "take fewer slices, or slices that are not coupled"
            )
        if status & (NOT_FINITE | TOO_FAR):
            raise_state(work.state, work.shape, bool(status & NOT_FINITE))
        if status & ABOVE_LOAD and law.outside == "error":
            highest = float(np.max(work.states()[0]))
            if isinstance(law, DryLaw):
                raise OutsideMapError(
                    f"bearing force, load: got about {highest:.6g} N/m in a slice at the pose "
                    f"{work.state[:6].tolist()}; the law {law.name!r} has points up to "
                    f"{table.LawNumbers(*work.numbers).held_load:.6g} N/m; give it points that reach there"
                )
            raise OutsideMapError(
                f"bearing force, load: got about {highest:.6g} N/m in a slice at the pose {work.state[:6].tolist()}; "
                f"mapped: up to {law.known_load(*self.conditions[:2]):.6g} N/m\n"
                "make a map that reaches there, or take a law with outside='clamp' or outside='asymptote'"
            )
        return True


def coupling_beside(bearing: Bearing, law: Law) -> FloatArray | None:
    """Compliances between the slices of a bearing beside its law, (slices, slices) [m2/N]; None where there are none.

    The laws of ISO 16281 and Palmgren, and dry laws, hold for whole rollers: their ends are in them already.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    law : Law
        Law of a roller between both raceways.
    """
    if not bearing.coupled:
        return None
    from ehdmaps.solids.slices import without_ends

    plane = not isinstance(law, DryLaw) and all(
        contact.structural_law not in _WHOLE_ROLLERS for contact in law.contacts
    )
    return bearing.coupling if plane else without_ends(bearing.coupling)


def check_conditions(conditions: tuple[float, float, float]) -> tuple[float, float, float]:
    """Refuse conditions that are missing or not finite; the same as numbers.

    Parameters
    ----------
    conditions : (float, float, float)
        u [m/s], T [K], centrifugal load [N/m].

    Raises
    ------
    InputError
        With every problem.
    """
    problems = Problems()
    for name, value in zip(("entrainment_speed", "temperature", "centrifugal_load"), conditions, strict=True):
        try:
            finite = math.isfinite(value)
        except TypeError:
            problems.append(f"bearing force, {name}: got {value!r}; allowed: a finite number")
            continue
        if not finite:
            problems.append(f"bearing force, {name}: got {value!r}; the law of a map needs a finite number; give it")
    problems.check()
    u, T, q = conditions
    return float(u), float(T), float(q)


def is_one_power(law: ContactLaw) -> bool:
    """Tell whether the dry contacts of a law in series are one power law."""
    structure = law.plain_table.structure
    return bool(np.all(structure[:, 0] == POWER_LAW) and np.ptp(structure[:, 2]) < 1e-12)


def six_numbers(name: str, given: Any) -> FloatArray:
    """Six numbers of a pose or a velocity, or an error."""
    return real_numbers(f"bearing force, {name}", given, ("six ", 6, "in the order x y z theta_x theta_y theta_z"))


def real_numbers(where: str, given: Any, wanted: tuple[str, int, str]) -> FloatArray:
    """Numbers of a vector, or an error.

    Parameters
    ----------
    where : str
        What takes them; begins the message.
    given : object
        What was given.
    wanted : (str, int, str)
        How many they are, in words and as a number, and what they are.

    Raises
    ------
    InputError
        For anything else.
    """
    words, size, order = wanted
    try:
        values = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{where}: got {given!r}; allowed: {words}real numbers") from None
    if values.shape != (size,):
        raise InputError(f"{where}: got an array of shape {values.shape}; allowed: ({size},), {order}")
    return values


def raise_state(state: FloatArray, shape: Cylinder, not_finite: bool) -> None:
    """Say what is wrong about pose, velocity or cage angle.

    Parameters
    ----------
    state : array (13,)
        Pose (6), velocity (6), cage angle.
    shape : Cylinder
        The bearing.
    not_finite : bool
        Whether some are no finite numbers; else they are too large.

    Raises
    ------
    InputError
        Always.
    """
    named = {"pose": state[:6], "velocity": state[6:12], "cage_angle": state[12:]}
    if not_finite:
        raise InputError(
            [
                f"bearing force, {name}: got {values.tolist()}; allowed: finite numbers"
                for name, values in named.items()
                if not np.all(np.isfinite(values))
            ]
            or "bearing force: got numbers whose sum is not finite; allowed: finite numbers of a reasonable size"
        )
    raise InputError(
        f"bearing force, pose: got y = {state[1]:.6g} m, z = {state[2]:.6g} m, theta_y = {state[4]:.6g} rad, "
        f"theta_z = {state[5]:.6g} rad; allowed: within {shape.most_travel:.6g} m (the roller diameter) and "
        f"{shape.most_tilt} rad; check units and the step of the solver"
    )

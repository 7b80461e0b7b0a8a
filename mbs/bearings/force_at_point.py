"""The bearing force at one speed, temperature and centrifugal load: the law is prepared once and then called fast.

Loads, approaches and films of the rollers are there to look at.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import in_python
from ehdmaps.errors import AnalysisError, InputError, MapError, OutsideMapError
from ehdmaps.maps.kernels.kernel import film_part
from ehdmaps.maps.kernels.tables import LOAD_TOLERANCE, POWER_LAW, Point
from mbs.bearings import slice_table as table
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_kernel import force_of_arrays, force_of_point_arrays
from mbs.bearings.laws import DryLaw, FlatLaw, Law, tabulate_law, unilateral_forces
from mbs.bearings.slice_table import fade
from mbs.bearings.slices import NOT_FINITE, Sizes, rollers_of_arrays
from mbs.bearings.special_kernels import CELLS_MISSING, NO_LOADS, NO_TABLE, changed_force, coupled_arrays, remade_force
from mbs.model.elements import Forces

if TYPE_CHECKING:
    from ehdmaps.maps.emap import EHDMap
    from ehdmaps.maps.law import ContactLaw, LawAtPoint


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
        Middles of the slices [m].
    """

    angle: FloatArray
    load: FloatArray
    moment: FloatArray
    load_per_length: FloatArray
    damping: FloatArray
    approach: FloatArray
    position: FloatArray

    def load_zone(self, share: float = 0.0) -> FloatArray:
        """Angles of the rollers that carry more than a share of the highest roller load, sorted [rad]."""
        return np.sort(self.angle[self.load > share * float(np.max(self.load))])

    def films(
        self,
        emap: EHDMap,
        entrainment_speed: float,
        temperature: float,
        centrifugal_load: float = 0.0,
        variable: str = "central_film",
    ) -> FloatArray:
        """Film of each roller at the inner and the outer race, (Z, 2) [m], at its mean load per length.

        It is read from the map between its points, linearly in the logarithms; NaN for a load, speed or temperature
        outside the map, so for unloaded rollers too.

        Parameters
        ----------
        emap : EHDMap
            Map of this bearing.
        entrainment_speed, temperature, centrifugal_load : float
            u [m/s], T [K], q [N/m].
        variable : {"central_film", "minimum_film"}
            Which film.

        Raises
        ------
        InputError
            For another variable.
        MapError
            For a map without the contacts of a roller.
        """
        from scipy.interpolate import RegularGridInterpolator  # films of a map alone need it

        if variable not in ("central_film", "minimum_film"):
            raise InputError(f"rollers, film: got {variable!r}; allowed: central_film, minimum_film")
        if emap.bearing is None:
            raise MapError("rollers, film: got the map of a bare contact; allowed: a map of the bearing")
        mean = np.mean(self.load_per_length, axis=1)
        out = np.full((mean.size, 2), np.nan)
        data = emap.dataset[variable].transpose("contact", "load", "entrainment_speed", "temperature")
        data = data.sel(entrainment_speed=data["entrainment_speed"] > 0.0)
        axes = (np.log(data["load"].values), np.log(data["entrainment_speed"].values), data["temperature"].values)
        size = abs(entrainment_speed)
        for i, contact in enumerate(("inner", "outer")):
            loads = mean + (centrifugal_load if contact == "outer" else 0.0)
            loaded = loads > 0.0
            if size == 0.0 or not np.any(loaded):
                continue
            kept = tuple(axis.size > 1 for axis in axes)
            with np.errstate(divide="ignore"):
                values = np.log(data.sel(contact=contact).values)
            places = np.stack(
                [np.log(loads[loaded]), np.full(loaded.sum(), math.log(size)), np.full(loaded.sum(), temperature)],
                axis=1,
            )
            log_film = RegularGridInterpolator(
                tuple(axis for axis, keep in zip(axes, kept, strict=True) if keep), values.squeeze(), bounds_error=False
            )(places[:, kept])
            for axis, keep, place in zip(axes, kept, places.T, strict=True):
                if not keep:
                    log_film = np.where(np.abs(place - axis[0]) < 1e-9 * max(1.0, abs(axis[0])), log_film, np.nan)
            out[loaded, i] = np.exp(log_film)
        return out


def roller_loads(
    bearing: Bearing,
    slices: FloatArray,
    states: FloatArray,
    rollers: FloatArray,
    cage_angle: float,
    own: FloatArray | None = None,
) -> RollerLoads:
    """Make the record from what a call of `bearing_force` leaves.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    slices : array (2, n)
        Positions of the slices, and twice the profile there [m].
    states : array (4, Z, n)
        States of the slices, see `mbs.bearings.slices.Work`.
    rollers : array (4, Z)
        Motion of the rollers, see `mbs.bearings.slices.rollers_of_arrays`.
    cage_angle : float
        Angle of the first roller [rad].
    own : array (Z, n), optional
        Approaches that the law takes, of slices that are coupled [m]; their loads are those at rest.
    """
    count = bearing.geometry.rollers
    x, profile = slices
    gap, tilt, gap_rate, tilt_rate = (part[:, None] for part in rollers)
    approach = gap + x * tilt - profile
    rate = gap_rate + x * tilt_rate
    if own is None:
        load, _, _ = unilateral_forces(states[0], states[1], states[2], states[3], rate)
    else:
        load, approach = states[0].copy(), own.copy()
    angle = cage_angle + 2.0 * math.pi * np.arange(count) / count
    return RollerLoads(
        angle=np.arctan2(np.sin(angle), np.cos(angle)),
        load=load.sum(axis=1) * bearing.slice_length,
        moment=(load * x).sum(axis=1) * bearing.slice_length,
        load_per_length=load,
        damping=states[2].copy(),
        approach=approach,
        position=x.copy(),
    )


Triple = tuple[FloatArray, FloatArray, FloatArray]
"""Force, stiffness, damping."""

_MOST_TILT = 0.5
_WHOLE_ROLLERS = ("iso16281", "palmgren")
_SIX, _OUT = (6,), (13, 6)
_POWER = table.LawNumbers(
    kind=table.POWER, coefficient=0.0, exponent=0.0, damping=0.0, damping_time=0.0, centre=0.0, inverse_scale=0.0,
    highest=0.0, safe_approach=0.0, lift_off=0.0, slope=1.0, held_approach=math.inf, held_load=math.inf,
    held_stiffness=0.0, held_damping=0.0,
)  # fmt: skip
_BY_SLICES = _POWER._replace(lift_off=-math.inf, safe_approach=math.inf)
"""Where the law is called for each slice, slopes are whole and loads are counted there."""


class Arrays:
    """Arrays of one element: its constants for compiled code, and work space.

    Parameters
    ----------
    bearing : Bearing
        Geometry, clearance, profile, slices.
    coupling : array (slices, slices), optional
        Compliances between slices [m2/N]; none for slices on their own.
    """

    def __init__(self, bearing: Bearing, coupling: FloatArray | None = None) -> None:
        geometry = bearing.geometry
        rollers, slices = geometry.rollers, bearing.slices
        self.sizes = Sizes(
            half_clearance=0.5 * geometry.diametral_clearance,
            slice_length=bearing.slice_length,
            most_travel=geometry.roller_diameter,
            most_tilt=_MOST_TILT,
            half_length=0.5 * geometry.roller_length,
            least_profile=2.0 * float(np.min(bearing.profile_depths)),
        )
        self.slices = np.stack((bearing.slice_positions, 2.0 * bearing.profile_depths))
        angles = 2.0 * math.pi * np.arange(rollers) / rollers
        self.angles = np.stack((np.cos(angles), np.sin(angles)))
        self.state = np.zeros(13)
        self.motion = (self.state, self.state[:6], self.state[6:12])
        self.conditions = np.zeros(4)
        self.rows = np.zeros((rollers, slices), dtype=np.int64)
        self.states = np.zeros((4, rollers, slices))
        self.numbers = np.zeros(table.NUMBERS)
        self.shape = (self.state, np.array(self.sizes), self.slices, self.angles, self.numbers)
        self.cells, self.knots, self.film = np.zeros((1, 8)), np.zeros(1), np.zeros((1, 8))
        self.nodes, self.marks = np.zeros((4, 1)), np.zeros((2, 1), dtype=np.uint8)
        self.counts = np.zeros(4, dtype=np.int64)
        self.coupling = coupling
        self.own = np.zeros((rollers, slices)) if coupling is not None else np.zeros((0, 0))

    def make_room(self) -> None:
        """Make the arrays that only a tabulated law needs."""
        if self.cells.shape[0] == 1:
            self.cells, self.nodes = np.empty((2 * table.ROWS, 8)), np.empty((4, table.NODES))
            self.marks = np.zeros((2, table.NODES), dtype=np.uint8)

    def make_knots(self) -> None:
        """Make the arrays that only a faded film needs."""
        if self.film.shape[0] == 1:
            self.film, self.knots = np.empty((2 * table.ROWS, 8)), np.empty(2 * table.ROWS)


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
    arrays : tuple
        All arguments of `mbs.bearings.bearing_kernel.force_of_arrays` but the last, for other compiled code, which
        takes them from an element with arrays of its own.
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
        self._law: LawAtPoint | None = None
        self._by_slices, self._passing = False, work is not None
        self._coupled = self._work.coupling is not None
        self._outside = False
        self._growing: tuple[Any, ...] | None = None
        law, numbers, centrifugal_load = flat_law.law, self._work.numbers, conditions[2]
        if isinstance(law, DryLaw):
            if centrifugal_load != 0.0:
                raise InputError(
                    f"bearing force, centrifugal_load: got {centrifugal_load!r} N/m with the law {law.name!r}; "
                    "allowed: 0; only a map's law brings rollers into equilibrium"
                )
            numbers[:], cells = law.prepared(bearing.geometry.roller_length)
            if cells is not None:
                self._work.make_room()
                self._work.cells[:] = cells
        else:
            self._prepare(law)
        self._apart = self._by_slices or self._coupled
        w = self._work
        self.arrays = (*w.shape, w.cells, w.knots, w.rows, w.states)

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
        state, own_pose, own_velocity = self._work.motion
        own_pose[...] = pose if type(pose) is np.ndarray and pose.shape == _SIX else six_numbers("pose", pose)
        if velocity is None:
            own_velocity[...] = 0.0
        elif type(velocity) is np.ndarray and velocity.shape == _SIX:
            own_velocity[...] = velocity
        else:
            own_velocity[...] = six_numbers("velocity", velocity)
        state[12] = cage_angle
        out: FloatArray = np.empty(_OUT)
        if self._growing is not None:
            status = self._from_growing(self._growing, out)
        else:
            status = self._from_law(out) if self._apart else force_of_arrays(*self.arrays, out)
        outside = self._settle(status, out) if status != 0 or self._outside else False
        return out, outside

    @property
    def tabulated(self) -> bool:
        """True where `arrays` hold the law; else it is called for each slice, or slices are coupled."""
        return not self._apart

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
        w = self._work
        rollers = rollers_of_arrays(*w.shape[:4])
        own = w.own if self._coupled else None
        return roller_loads(self._bearing, w.slices, w.states, rollers, cage_angle, own)

    def _prepare(self, law: ContactLaw) -> None:
        """Make the law of this point ready for compiled code."""
        work = self._work
        u, T, q = check_conditions(self.conditions)
        if self._passing and not self._coupled and _is_within(law, u, T, q):
            # A table is begun, whose cells are made as slices need them.
            work.make_room()
            work.conditions[:] = (*self.conditions, 0.0)
            self._growing = (*self._flat_law.arrays(law, q > 0.0), work.conditions, work.nodes, work.counts, work.marks)
            return
        part, faded = part_of_film(law, u), is_faded(law, u)
        if part == 0.0 and q == 0.0 and is_one_power(law):
            # Dry contacts in series: delta = (a_1 + a_2) w^b.
            point = self._point(law)
            b = float(point.structure[0, 2])
            a = float(np.sum(point.structure[:, 1]))
            _set_power(work.numbers, a ** (-1.0 / b), 1.0 / b, point.highest_load * (1.0 + LOAD_TOLERANCE), point)
            return
        if 0.0 <= q < law.load_range[1] and not (self._coupled and faded) and self._tabulate(law, part, faded):
            return
        self._point(law)
        self._by_slices = True
        work.numbers[:] = _BY_SLICES

    def _from_growing(self, growing: tuple[Any, ...], out: FloatArray) -> int:
        """Call with a table whose cells are made as slices need them."""
        status: int = CELLS_MISSING
        if self._work.conditions[3] == 1.0:
            status = remade_force(self._work.marks, *self.arrays, out)
        if status == CELLS_MISSING:
            given: tuple[Any, ...] = (*growing, *self.arrays, out)
            status = changed_force(*given)
        if status != NO_TABLE:
            return status
        law = self._flat_law.law
        assert not isinstance(law, DryLaw)
        self._growing, self._by_slices, self._apart = None, True, True
        return self._from_slices(law, out)

    def _tabulate(self, law: ContactLaw, part: float, faded: bool) -> bool:
        """Make the table of the law with a part of its film; whether there is one."""
        work = self._work
        arrays, workspace = self._flat_law.arrays(law, self.conditions[2] > 0.0)
        counts = np.zeros(4, dtype=np.int64)
        work.make_room()
        if faded:
            work.make_knots()
        cells = work.film if faded else work.cells
        conditions = np.array(self.conditions, dtype=np.float64)
        fits: bool = tabulate_law(arrays, workspace, conditions, work.nodes, work.marks, cells, work.numbers, counts)
        self._outside = bool(counts.any())
        if fits and faded:
            fade(work.film, work.numbers.copy(), part, work.cells, work.knots, work.numbers)
        return fits and not (self._outside and law.outside == "error")

    def _point(self, law: ContactLaw) -> Point:
        """The law at this point, for the calls that no table answers."""
        if self._law is None:
            self._law = law.at(*self.conditions)
            self._outside = self._law.outside
        return self._law.point

    def _from_slices(self, law: ContactLaw, out: FloatArray) -> int:
        """Call the law for each slice."""
        w = self._work
        w.numbers[:] = _BY_SLICES
        status: int = force_of_point_arrays(self._point(law), *w.shape, w.states, w.counts, out)
        w.state[6:12] = 0.0  # the rates are in the loads, should someone look at the rollers
        return status

    def _from_law(self, out: FloatArray) -> int:
        """Call the law for each slice, at conditions that no table fits; solve for the loads of coupled slices."""
        w, law = self._work, self._flat_law.law
        if w.coupling is None:
            assert not isinstance(law, DryLaw)
            return self._from_slices(law, out)
        point = self._point(law) if self._by_slices and not isinstance(law, DryLaw) else None
        status: int = coupled_arrays(point, *w.shape, w.cells, w.rows, w.states, w.coupling, w.own, w.counts, out)
        return status

    def _settle(self, status: int, out: FloatArray) -> bool:
        """Raise what a status asks for; above the load of the table ask the law itself. Whether outside the map."""
        work, law = self._work, self._flat_law.law
        if status == NO_LOADS:
            raise AnalysisError(
                f"bearing force, coupled slices: no loads of a roller at the pose {work.state[:6].tolist()}; its "
                "contacts are wider than at the static limit, for which the coupling is made, or slices are too many; "
                "take fewer slices, or slices that are not coupled"
            )
        if status < 0:
            raise_state(work.state, work.sizes, status == NOT_FINITE)
        if status == 0 and not self._outside:
            return False
        if status > 0 and law.outside == "error":
            highest = float(np.max(work.states[0]))
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


def _is_within(law: ContactLaw, entrainment_speed: float, temperature: float, centrifugal_load: float) -> bool:
    """Tell whether the whole film is there, and nothing is outside the map."""
    table = law.plain_table
    within = table.film_speed <= abs(entrainment_speed) <= table.counted_speed
    within = within and table.counted_cold <= temperature <= table.counted_hot
    return within and 0.0 <= centrifugal_load < law.load_range[1]


def is_faded(law: ContactLaw, entrainment_speed: float) -> bool:
    """Tell whether a speed [m/s] lies below those with the whole film."""
    return bool(abs(entrainment_speed) < law.plain_table.film_speed)


def part_of_film(law: ContactLaw, entrainment_speed: float) -> float:
    """Part of the film of a law that is there at a speed [m/s]."""
    return float(in_python(film_part)(abs(entrainment_speed), law.plain_table.film_speed))


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
    problems = []
    for name, value in zip(("entrainment_speed", "temperature", "centrifugal_load"), conditions, strict=True):
        try:
            finite = math.isfinite(value)
        except TypeError:
            problems.append(f"bearing force, {name}: got {value!r}; allowed: a finite number")
            continue
        if not finite:
            problems.append(f"bearing force, {name}: got {value!r}; the law of a map needs a finite number; give it")
    if problems:
        raise InputError(problems)
    u, T, q = conditions
    return float(u), float(T), float(q)


def _set_power(
    numbers: FloatArray,
    coefficient: float,
    exponent: float,
    highest: float,
    point: Point | None = None,
) -> None:
    """Write a law w = a delta^b; held where that of a point is."""
    power = _POWER._replace(
        coefficient=coefficient,
        exponent=exponent,
        highest=highest,
        safe_approach=(highest / coefficient) ** (1.0 / exponent),
    )
    if point is not None:
        power = power._replace(
            safe_approach=min(power.safe_approach, point.held_approach),
            held_approach=point.held_approach,
            held_load=point.held_load,
            held_stiffness=point.held_stiffness,
            held_damping=point.held_damping,
        )
    numbers[:] = power


def is_one_power(law: ContactLaw) -> bool:
    """Tell whether the dry contacts of a law in series are one power law."""
    structure = law.plain_table.structure
    return bool(np.all(structure[:, 0] == POWER_LAW) and np.ptp(structure[:, 2]) < 1e-12)


def six_numbers(name: str, given: Any) -> FloatArray:
    """Six numbers of a pose or a velocity, or an error.

    Parameters
    ----------
    name : str
        pose or velocity, for messages.
    given : object
        What was given.

    Raises
    ------
    InputError
        For anything else.
    """
    try:
        values = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"bearing force, {name}: got {given!r}; allowed: six real numbers") from None
    if values.shape != _SIX:
        raise InputError(
            f"bearing force, {name}: got an array of shape {values.shape}; "
            "allowed: (6,), in the order x y z theta_x theta_y theta_z"
        )
    return values


def raise_state(state: FloatArray, sizes: Sizes, not_finite: bool) -> None:
    """Say what is wrong about pose, velocity or cage angle.

    Parameters
    ----------
    state : array (13,)
        Pose (6), velocity (6), cage angle.
    sizes : Sizes
        Sizes of the bearing.
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
        f"theta_z = {state[5]:.6g} rad; allowed: within {sizes.most_travel:.6g} m (the roller diameter) and "
        f"{sizes.most_tilt} rad; check units and the step of the solver"
    )

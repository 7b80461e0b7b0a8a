"""One ball bearing at an operating point: where its inner ring comes to rest, and what its balls feel there.

The outer ring is held in its place, the inner one moves along x, y and z, and tilts if it may. Pressures are those of
dry Hertz. Films are those that were solved, where the law has them. Else they are those of the formula of Hamrock and
Dowson at the load and entrainment speed of each contact; they tell how thick the film is and move nothing.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_dynamic_rating, ball_static_rating
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.film_formulas import hamrock_dowson_central, hamrock_dowson_minimum
from ehdmaps.units import written
from mbs.bearings.balls.ball_bearing import BallForce, BallLoads
from mbs.bearings.balls.ball_element import MachineBalls
from mbs.bearings.balls.ball_findings import ball_gauge, ball_pressures
from mbs.bearings.balls.ball_motion import Motion, ball_motion
from mbs.life import ReferenceLife, ball_reference_life
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.model.findings import Finding, WithFindings
from mbs.model.system import System

if TYPE_CHECKING:
    from mbs.bearings.balls.films import BallFilms

_RING, _TURNING = "inner ring", Operation(1.0)
"""The ring; speeds are those of the rings at a speed of the system of one."""


@dataclass(frozen=True, eq=False)
class BallPoint(WithFindings):
    """A ball bearing in equilibrium.

    Attributes
    ----------
    force : BallForce
        Geometry and laws.
    load : array (3,)
        Load on the inner ring, x, y and z [N].
    inner_speed, outer_speed : float
        [rad/s].
    motion : Motion
        Entrainment, slip and spin of the contacts.
    pose : array (6,)
        Pose of the inner ring in the outer one.
    stiffness, damping : array (6, 6)
        -d force/d pose and -d force/d velocity.
    balls : BallLoads
        Loads, contact angles, approaches, speeds.
    pressure, central_film, minimum_film : array (2, Z)
        Hertz pressure [Pa] and films [m] of the inner and outer contacts; NaN for films of contacts without load,
        and for those wider than the gap is a paraboloid.
    film_errors : array (2, 4)
        Largest stated errors of film offset, central and smallest film, and damping, of the inner and outer contacts
        that carry more than 1 % of the highest load; NaN where films come from formulas, or there are none.
    findings : tuple of Finding
        What is beyond its laws, and what else is to be known.
    failed : bool
        Whether it has no answer: numbers are NaN, and `problems` say why.
    """

    force: BallForce
    load: FloatArray
    inner_speed: float
    outer_speed: float
    motion: Motion
    pose: FloatArray
    stiffness: FloatArray
    damping: FloatArray
    balls: BallLoads
    pressure: FloatArray
    central_film: FloatArray
    minimum_film: FloatArray
    film_errors: FloatArray
    findings: tuple[Finding, ...]
    failed: bool = False

    @property
    def cage_speed(self) -> float:
        """Mean speed of the balls by their loads [rad/s]."""
        return self.balls.cage_speed

    @property
    def entrainment_speed(self) -> float:
        """Mean of the entrainment speeds of both raceways, by the loads of their balls [m/s]."""
        return float(self.motion.mean(self.balls).mean())

    @property
    def centrifugal_load(self) -> float:
        """Largest centrifugal load of a ball [N]."""
        return float(self.balls.centrifugal.max())

    @property
    def gyroscopic_traction(self) -> float:
        """Largest traction that holds a gyroscopic moment, over the load of its ball at the outer raceway."""
        return self.balls.gyroscopic_traction

    @property
    def geometry(self) -> BallGeometry:
        """Geometry of the bearing."""
        return self.force.geometry

    @property
    def ratings(self) -> tuple[float, float]:
        """C of ISO 281 and C0 of ISO 76 by the inner geometry [N]."""
        return ball_dynamic_rating(self.geometry), ball_static_rating(self.geometry)

    @property
    def reference(self) -> ReferenceLife:
        """Equivalent load and life of ISO/TS 16281, by the rating of ISO 281."""
        turns = abs(self.inner_speed) >= abs(self.outer_speed)
        return ball_reference_life(self.geometry, self.balls.load, self.ratings[0], inner_turns=turns)

    @property
    def size(self) -> float:
        """Size of the radial load [N]."""
        return math.hypot(self.load[1], self.load[2])

    @property
    def axial(self) -> float:
        """Axial load [N]."""
        return float(self.load[0])

    @property
    def loaded(self) -> int:
        """Number of balls that carry more than 1 % of the highest inner load."""
        return self.balls.loaded

    @property
    def axes(self) -> FloatArray:
        """Unit vectors along and across the radial load, (2, 3); along y without one."""
        y, z = (self.load[1:] / self.size) if self.size > 0.0 else (1.0, 0.0)
        return np.array([[0.0, y, z], [0.0, -z, y]])

    def along_across(self, matrix: FloatArray) -> tuple[float, float, float]:
        """Entries of a matrix (6, 6) along the radial load, across it, and along the axis."""
        along, across = self.axes
        part = matrix[:3, :3]
        return float(along @ part @ along), float(across @ part @ across), float(part[0, 0])

    @property
    def smallest_film(self) -> float:
        """Smallest of all minimum films [m]; NaN where none is known."""
        known = self.minimum_film[np.isfinite(self.minimum_film)]
        return float(known.min()) if known.size else math.nan


def ball_point(
    force: BallForce,
    load: Sequence[float],
    inner_speed: float,
    outer_speed: float = 0.0,
    *,
    tilts: bool = False,
    oil: Lubricant | None = None,
    temperature: float = 313.15,
    films: BallFilms | None = None,
) -> BallPoint:
    """Equilibrium of a ball bearing.

    Parameters
    ----------
    force : BallForce
        Geometry and laws.
    load : (float, float, float)
        Load on the inner ring, x, y and z [N].
    inner_speed, outer_speed : float
        Speeds of the rings [rad/s].
    tilts : bool
        Whether the inner ring tilts freely, without a moment; else it is held.
    oil : Lubricant, optional
        Oil of the films; no films without one.
    temperature : float
        Temperature of the raceways, and so of the oil [K].
    films : BallFilms, optional
        Films that were solved, in place of the formula's.

    Raises
    ------
    InputError
        For loads that are no finite numbers, or all zero.
    AnalysisError
        Where no equilibrium is found.
    """
    given = np.array(load, dtype=np.float64)
    if given.shape != (3,) or not np.all(np.isfinite(given)) or not np.any(given):
        raise InputError(f"ball point, load: got {load!r} N; allowed: three finite numbers, x, y, z, not all zero")
    free = ["x", "y", "z", "theta_y", "theta_z"] if tilts else ["x", "y", "z"]
    ring = rigid_body(_RING, [Inertia(1.0, 1.0, 1.0)], free)
    loads = [Load("load", _RING, np.array([*given, 0.0, 0.0, 0.0]))]
    pose = np.zeros(6)
    element = MachineBalls("bearing", _RING, "ground", force, inner_speed, outer_speed)
    balance = _balance(System([ring], loads=loads, elements=[element]), given, force)
    pose[[0, 1, 2, 4, 5][: len(free)]] = balance.displacement
    balls = element.loads(pose, _TURNING)
    contacts, pressure = force.geometry.contacts(force.material), ball_pressures(force, balls)
    motion = ball_motion(force, balls, inner_speed, outer_speed)
    central, minimum = np.full((2, *pressure.shape), np.nan)
    film_errors = np.full((2, 4), np.nan)
    if films is not None:
        for side, solved in enumerate(films.sides):
            carries = balls.load[side] > 0.0
            (offset, thick, thin, _), _ = solved.read(balls.load[side][carries])
            held = offset <= contacts[side].widest_film
            central[side, carries], minimum[side, carries] = np.where(held, (thick, thin), np.nan)
            heavy = balls.load[side] > 0.01 * balls.load[side].max()
            film_errors[side] = solved.largest_errors(balls.load[side][heavy])
    elif oil is not None and inner_speed != outer_speed:
        state = oil.at(temperature)
        for side, contact in enumerate(contacts):
            carries = balls.load[side] > 0.0
            numbers = (
                state.viscosity
                * motion.entrainment[side][carries]
                / (contact.reduced_modulus * contact.rolling_radius),
                balls.load[side][carries] / (contact.reduced_modulus * contact.rolling_radius**2),
                state.pressure_viscosity.pressure_viscosity * contact.reduced_modulus,
                contact.ellipticity,
            )
            thick, thin = (
                contact.rolling_radius * np.asarray(formula(*numbers))
                for formula in (hamrock_dowson_central, hamrock_dowson_minimum)
            )
            held = thick <= contact.widest_film
            central[side, carries], minimum[side, carries] = np.where(held, (thick, thin), np.nan)
    return BallPoint(
        force=force,
        load=given,
        inner_speed=inner_speed,
        outer_speed=outer_speed,
        motion=motion,
        pose=pose,
        stiffness=balance.element_stiffness[0],
        damping=balance.element_damping[0],
        balls=balls,
        pressure=pressure,
        central_film=central,
        minimum_film=minimum,
        film_errors=film_errors,
        findings=(
            *ball_gauge(force, balls).findings,
            *filter(None, [force.reach_of(balls.load)]),
        ),
    )


def ball_dynamic_stiffness(point: BallPoint, omega: FloatArray) -> ComplexArray:
    """Dynamic stiffness K + i omega C of films with memory, shape (n, 6, 6); that of slow motion without responses.

    Parameters
    ----------
    point : BallPoint
        The equilibrium.
    omega : array (n,)
        Circular frequencies of small oscillations [rad/s].
    """
    from mbs.bearings.balls.balls_in_balance import ball_relaxation

    force, s = point.force, np.asarray(1j * omega, dtype=np.complex128)
    speeds = {"inner_speed": point.inner_speed, "outer_speed": point.outer_speed}
    relaxation = ball_relaxation(force, force.loads(point.pose, **speeds), speeds)
    return np.asarray(point.stiffness + s[:, None, None] * point.damping + relaxation.more(s))


def _balance(system: System, load: FloatArray, force: BallForce) -> Equilibrium:
    """The equilibrium, or what to do where there is none."""
    try:
        return equilibrium(system, _TURNING)
    except AnalysisError as error:
        geometry = force.geometry
        words = (
            f"no equilibrium of {geometry.name} under {written(load[0])} N axial, {math.hypot(*load[1:]):.4g} N radial"
        )
        if geometry.contact_angle:
            way = "positive" if geometry.contact_angle > 0.0 else "negative"
            words += (
                f"; an angular contact bearing falls apart without a {way} axial load, of about the radial one times "
                "the tangent of its contact angle"
            )
        raise AnalysisError(f"{words}: {error.__cause__ or error}") from error

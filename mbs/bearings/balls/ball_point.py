"""One ball bearing at an operating point: where its inner ring comes to rest, and what its balls feel there.

The outer ring is held in its place, the inner one moves along x, y and z, and tilts if it may. Pressures are those of
dry Hertz. Films are those that were solved, where the law has them. Else they are those of the formula of Hamrock and
Dowson at the load and entrainment speed of each contact; they tell how thick the film is and move nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ball_catalogue import ball_dynamic_rating, ball_static_rating
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.film_formulas import hamrock_dowson_central, hamrock_dowson_minimum
from mbs.bearings.balls.ball_bearing import BallForce, BallLoads
from mbs.bearings.balls.ball_element import MachineBalls
from mbs.bearings.balls.ball_findings import ball_gauge, ball_pressures
from mbs.bearings.balls.ball_motion import Motion, ball_motion
from mbs.bearings.locating.locating_point import RING, LocatingPoint, ring_at_rest, ring_load
from mbs.life import ReferenceLife

if TYPE_CHECKING:
    from mbs.bearings.balls.films import BallFilms


@dataclass(frozen=True, eq=False, kw_only=True)
class BallPoint(LocatingPoint):
    """A ball bearing in equilibrium, see `LocatingPoint`; films wider than the gap is a paraboloid are NaN.

    Attributes
    ----------
    motion : Motion
        Entrainment, slip and spin of the contacts.
    balls : BallLoads
        Loads, contact angles, approaches, speeds.
    film_errors : array (2, 4)
        Largest stated errors of film offset, central and smallest film, and damping, of the inner and outer contacts
        that carry more than 1 % of the highest load; NaN where films come from formulas, or there are none.
    """

    force: BallForce
    motion: Motion
    balls: BallLoads
    film_errors: FloatArray

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
        return self.balls.life(self.geometry, abs(self.inner_speed) >= abs(self.outer_speed))

    @property
    def loaded(self) -> int:
        """Number of balls that carry more than 1 % of the highest inner load."""
        return self.balls.loaded


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
    geometry, advice = force.geometry, ""
    if geometry.contact_angle:
        way = "positive" if geometry.contact_angle > 0.0 else "negative"
        advice = (
            f"; an angular contact bearing falls apart without a {way} axial load, of about the radial one times the "
            "tangent of its contact angle"
        )
    element = MachineBalls("bearing", RING, "ground", force, inner_speed, outer_speed)
    given, pose, balls, balance = ring_at_rest(element, ring_load(load), advice, tilts=tilts)
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

"""One ball bearing at an operating point: where its inner ring comes to rest, and what its balls feel there.

The outer ring is held in its place, the inner one moves along x, y and z, and tilts if it may. Pressures are those of
dry Hertz. Films are those that were solved, where the law has them. Else they are those of the formula of Hamrock and
Dowson at the load and entrainment speed of each contact; they tell how thick the film is and move nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.physics.point.film_formulas import film_of, hamrock_dowson_central, hamrock_dowson_minimum
from mbs.bearings.balls.ball_bearing import BallForce, BallLoads
from mbs.bearings.balls.ball_findings import ball_pressures
from mbs.bearings.balls.ball_motion import Motion, ball_motion
from mbs.bearings.locating.locating_force import Settled
from mbs.bearings.locating.locating_point import Course, LocatingPoint


@dataclass(frozen=True, eq=False, kw_only=True)
class BallPoint(LocatingPoint):
    """A ball bearing in equilibrium, see `LocatingPoint`; films wider than the gap is a paraboloid are NaN.

    Attributes
    ----------
    motion : Motion
        Entrainment, slip and spin of the contacts.
    film_offset : array (2, Z)
        Film offsets of the contacts [m]; their central films where these come from formulas.
    film_errors : array (2, 4)
        Largest stated errors of film offset, central and smallest film, and damping, of the inner and outer contacts
        that carry more than 1 % of the highest load; NaN where films come from formulas, or there are none.
    """

    force: BallForce
    elements: BallLoads
    motion: Motion
    film_offset: FloatArray
    film_errors: FloatArray

    @staticmethod
    def start(force: BallForce, load: FloatArray) -> FloatArray | None:
        """Place of thrust bearings, see `LocatingPoint.start`: balls that nothing presses have none of their own."""
        way = math.copysign(1.0, force.geometry.contact_angle)
        if not (force.geometry.thrust and load[0] * way > 0.0):
            return None
        from ehdmaps.physics.point.row_catalogue import pressed_by  # with what few bearings need

        return np.array([way * pressed_by(force.geometry, abs(load[0]), force.material), 0.0, 0.0])

    @staticmethod
    def advice(force: BallForce, load: FloatArray, speeds: tuple[float, float]) -> str:
        """Advice on the axial load, see `LocatingPoint.advice`."""
        angle = force.geometry.contact_angle
        if not angle or len({row.way for row in force.geometry.rows}) > 1:
            return ""
        if force.geometry.thrust:
            return f"; a thrust bearing carries a {'positive' if angle > 0.0 else 'negative'} axial load alone"
        return (
            f"; an angular contact bearing falls apart without a {'positive' if angle > 0.0 else 'negative'} axial "
            "load, of about the radial one times the tangent of its contact angle"
        )

    @staticmethod
    def own(at: Settled, course: Course) -> dict[str, Any]:
        """See `LocatingPoint.own`."""
        force, balls = at.force, at.loads
        pressure, motion = ball_pressures(force, balls), ball_motion(force, balls, *course.speeds)
        central, minimum, moved = np.full((3, *pressure.shape), np.nan)
        film_errors = np.full((2, 4), np.nan)
        oil = course.oil if course.speeds[0] != course.speeds[1] else None
        for side, contact in enumerate(force.geometry.contacts(force.material)):
            load, carries = balls.load[side], balls.load[side] > 0.0
            if course.films is not None:
                solved = course.films.sides[side]
                (offset, thick, thin, _), _ = solved.read(load[carries])
                film_errors[side] = solved.largest_errors(load[load > 0.01 * load.max()])
            elif oil is not None:
                state = oil.at(course.temperature)
                at_ball = contact, state, load[carries], motion.entrainment[side][carries]
                thick, thin = film_of(hamrock_dowson_central, *at_ball), film_of(hamrock_dowson_minimum, *at_ball)
                offset = thick
            else:
                continue
            held = offset <= contact.widest_film
            films = np.where(held, (thick, thin, offset), np.nan)
            central[side, carries], minimum[side, carries], moved[side, carries] = films
        return {
            "motion": motion,
            "pressure": pressure,
            "central_film": central,
            "minimum_film": minimum,
            "film_offset": moved,
            "film_errors": film_errors,
            "film_error": film_errors[:, 2],
        }

    @property
    def cage_speed(self) -> float:
        """Mean speed of the balls by their loads [rad/s]."""
        return self.elements.cage_speed

    @property
    def entrainment_speed(self) -> float:
        """Mean of the entrainment speeds of both raceways, by the loads of their balls [m/s]."""
        return float(self.motion.mean(self.elements).mean())

    @property
    def centrifugal_load(self) -> float:
        """Largest centrifugal load of a ball [N]."""
        return float(self.elements.centrifugal.max())

    @property
    def gyroscopic_traction(self) -> float:
        """Largest traction that holds a gyroscopic moment, over the load of its ball at the same raceway."""
        return self.elements.gyroscopic_traction

    @property
    def race_control(self) -> float:
        """Harris' criterion of all balls: what resists drilling at the outer raceway over that at the inner one.

        Q_o a_o E_o cos(a_i - a_o) over Q_i a_i E_i with the longer semi-axes a and elliptic integrals E: above 1 the
        outer raceway controls a ball, below it the inner one. NaN without load.
        """
        inner, outer = (
            load * np.asarray(ellipse.semi_axes(load)[1]) * float(ellipse.numbers.second_integral)
            for load, ellipse in zip(self.elements.load, self.force.geometry.contacts(self.force.material), strict=True)
        )
        first, second = self.elements.contact_angle
        return float(np.sum(outer * np.cos(first - second)) / np.sum(inner)) if np.any(inner > 0.0) else math.nan


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

"""Ball bearings for tests, their rest under loads, and an independent way: Newton's laws of each ball in space."""

from __future__ import annotations

import dataclasses
import math
from typing import NamedTuple

import numpy as np
from scipy import optimize

from ehdmaps.physics.point.ball_geometry import BISECTOR, INNER, NO_MOMENT, OUTER, BallGeometry
from ehdmaps.physics.solids import STEEL
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.laws import dry_law
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.system import System

FREEDOMS = ("x", "y", "z", "theta_x", "theta_y", "theta_z")
FREE = [0, 1, 2, 4, 5]
DEEP = BallGeometry("6305", 11.5e-3, 43.5e-3, 7, 0.52, 0.53)
LOOSE = dataclasses.replace(DEEP, clearance=10e-6)
TIGHT = dataclasses.replace(DEEP, clearance=-6e-6)
ANGULAR = BallGeometry("218", 22.225e-3, 125.26e-3, 16, 0.5232, 0.5232, math.radians(40.0))
OTHER_WAY = dataclasses.replace(ANGULAR, contact_angle=-ANGULAR.contact_angle)
STEEP = dataclasses.replace(ANGULAR, contact_angle=math.radians(60.0))
BEARINGS = {"deep": DEEP, "loose": LOOSE, "tight": TIGHT, "angular": ANGULAR, "other way": OTHER_WAY, "steep": STEEP}


def rest(geometry, load, speed=0.0, free=FREE, law=None, arm=None, outer_speed=0.0):
    """Pose (6,) of the inner ring under a load (6,), the equilibrium, and its balls."""
    force = BallForce(geometry, law or dry_law(geometry))
    if arm is not None:
        force.shape = force.shape._replace(arm=arm)
    element = LocatingElement("bearing", "ring", "ground", force, outer_spin=outer_speed / speed if speed else 0.0)
    ring = rigid_body("ring", [Inertia(1.0, 1.0, 1.0)], [FREEDOMS[i] for i in free])
    given = Load("load", "ring", np.array(load, dtype=float))
    found = equilibrium(System([ring], loads=[given], elements=[element]), Operation(speed))
    pose = np.zeros(6)
    pose[free] = found.displacement
    return pose, found, element.loads(pose, Operation(speed))


def in_space(geometry, pose, inner_speed=0.0, outer_speed=0.0):
    """Force on the inner ring (6,) by vectors in space; see `balls_in_space`."""
    return balls_in_space(geometry, pose, inner_speed, outer_speed)[0]


def cross(a, b):
    """Vector product; numpy's own takes ten times as long."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def rolls(spot, touches, speeds, hypothesis=OUTER):
    """Speed of a ball around x, its spin in space (3,), and what velocities are left, by velocities alone.

    The middle of the ball is at `spot`, the middles of the contacts stand at `touches` from there, inner and outer.
    The surfaces do not slip at either, along the ring or across it, and do not drill at the raceway that controls the
    ball; or its axis, seen from the cage, stands across the middle of both normals. Five equations for four unknowns,
    which they fulfil.
    """
    axis, rows, right = np.array([1.0, 0.0, 0.0]), [], []
    around = cross(axis, spot) / np.linalg.norm(spot)
    for touch, speed in zip(touches, speeds, strict=True):
        for along in (around, cross(touch, around) / np.linalg.norm(touch)):
            rows.append([along @ cross(axis, spot), *cross(touch, along)])
            right.append(speed * along @ cross(axis, spot + touch))
    inner, outer = (touch / np.linalg.norm(touch) for touch in touches)
    normal = {OUTER: outer, INNER: inner}.get(hypothesis, (outer - inner) / np.linalg.norm(outer - inner))
    ring = {OUTER: speeds[1], INNER: speeds[0]}.get(hypothesis)
    rows.append([-normal @ axis if ring is None else 0.0, *normal])
    right.append(0.0 if ring is None else ring * axis @ normal)
    size = np.array([np.linalg.norm(spot), *3 * [np.linalg.norm(touches[0])]])
    matrix, right = np.array(rows) / size, np.array(right)
    found = np.linalg.lstsq(matrix, right, rcond=None)[0]
    return found[0] / size[0], found[1:] / size[1:], np.max(np.abs(matrix @ found - right))


class InSpace(NamedTuple):
    """A ball in balance: velocity that is left, speed around the axis, spin in space, angles, loads, traction, F_c."""

    left: float
    speed: float
    spin: np.ndarray
    angles: tuple[float, float]
    loads: tuple[float, float]
    traction: float
    centrifugal: float


def balls_in_space(geometry, pose, inner_speed=0.0, outer_speed=0.0, material=STEEL, only=None):
    """Force on the inner ring (6,) and its balls, by vectors in space: Jones' and Harris' balance.

    Unknowns: the two coordinates of each ball. Its speed around the axis and its spin come from the velocities of the
    surfaces. Traction at the outer raceway, or at both as the hypothesis has it, is what gives the ball the change of
    its spin that its way around the axis asks for. Nothing of the product but geometry and Hertz coefficients. `only`
    is the number of balls that count.
    """
    coefficient = [contact.coefficient for contact in geometry.contacts(material)]
    diameter, pitch = geometry.ball_diameter, geometry.pitch_diameter
    mass = material.density * math.pi / 6.0 * diameter**3
    found_balls = []
    ring_axis = np.array([1.0, 0.0, 0.0])
    tilt = np.array([0.0, pose[4], pose[5]])
    force, moment = np.zeros(3), np.zeros(3)
    apart = geometry.groove_distance * math.sin(geometry.contact_angle)
    arm = geometry.inner_groove_radius
    for j in range(geometry.balls if only is None else only):
        angle = 2.0 * math.pi * j / geometry.balls
        out = np.array([0.0, math.cos(angle), math.sin(angle)])
        outer_centre = (arm - geometry.radial_distance) * out
        lever = arm * out
        inner_centre = lever + np.array([apart, 0.0, 0.0]) + pose[:3] + cross(tilt, lever)
        # what leads along the ring does not move grooves of revolution
        across = cross(ring_axis, out)
        inner_centre = inner_centre - across * (across @ inner_centre)

        def parts(place, out=out, outer_centre=outer_centre, inner_centre=inner_centre):
            ball = outer_centre + place[0] * ring_axis + place[1] * out
            pulls = []
            for centre, conformity, factor, side in (
                (inner_centre, geometry.inner_conformity, coefficient[0], 0),
                (outer_centre, geometry.outer_conformity, coefficient[1], 1),
            ):
                way = centre - ball
                distance = math.sqrt(way @ way)
                depth = distance - (conformity - 0.5) * diameter
                pulls.append((factor * max(depth, 0.0) ** 1.5, way / distance, side))
            (qi, ei, _), (qo, eo, _) = pulls
            around = cross(ring_axis, out)
            # from the ball's centre to the raceways
            touches = -0.5 * diameter * ei, -0.5 * diameter * eo
            speed, spin, left = rolls(0.5 * pitch * out, touches, (inner_speed, outer_speed), geometry.hypothesis)
            change = (geometry.hypothesis != NO_MOMENT) * cross(speed * ring_axis, 0.1 * mass * diameter**2 * spin)
            # traction lies in the plane, across the normal; its moment about the ball's centre is the change
            inner = {INNER: 2.0, BISECTOR: 1.0}.get(geometry.hypothesis, 0.0) * qi / (qi + qo) if qi > 0.0 else 0.0
            tractions = []
            for touch, e, share in zip(touches, (ei, eo), (inner, 1.0 - inner), strict=True):
                direction = cross(around, e)
                tractions.append(share * direction * (change @ around) / (cross(touch, direction) @ around))
            centrifugal = 0.5 * mass * pitch * speed**2 * out
            angles = (math.atan2(ei @ ring_axis, ei @ out), math.atan2(-eo @ ring_axis, -eo @ out))
            ball = InSpace(
                left, speed, spin, angles, (qi, qo), float(np.linalg.norm(tractions[1])), float(centrifugal @ out)
            )
            return qi * ei + qo * eo + sum(tractions) + centrifugal, qi * ei + tractions[0], ball

        def unbalanced(place, parts=parts, out=out):
            total = parts(place)[0]
            return [total @ ring_axis, total @ out]

        way = inner_centre - outer_centre
        depth = math.sqrt(way @ way)
        half = (0.5 * geometry.groove_distance + 0.5 * (depth - geometry.groove_distance)) / depth * way
        best = None
        lone = [0.0, (geometry.outer_conformity - 0.5) * diameter + 5e-6]
        for guess in ([half @ ring_axis, half @ out], lone):
            found = optimize.root(unbalanced, guess, method="hybr", tol=1e-13)
            size = float(np.linalg.norm(unbalanced(found.x)))
            if best is None or size < best[0]:
                best = size, found.x
            if size < 1e-9:
                break
        _, pull, ball = parts(best[1])
        assert ball.left <= 1e-12 * max(abs(inner_speed), abs(outer_speed)) * pitch
        found_balls.append(ball)
        force -= pull
        moment -= cross(lever, pull)
    return np.array([*force, 0.0, moment[1], moment[2]]), found_balls

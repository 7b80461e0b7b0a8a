"""Ball bearings for tests, their rest under loads, and an independent way: Newton's laws of each ball in space."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
from scipy import optimize

from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.solids import STEEL
from mbs.bearings.balls.ball_bearing import BallElement, BallForce
from mbs.bearings.balls.laws import dry_law
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
    element = BallElement("bearing", "ring", "ground", force, outer_spin=outer_speed / speed if speed else 0.0)
    ring = rigid_body("ring", [Inertia(1.0, 1.0, 1.0)], [FREEDOMS[i] for i in free])
    given = Load("load", "ring", np.array(load, dtype=float))
    found = equilibrium(System([ring], loads=[given], elements=[element]), Operation(speed))
    pose = np.zeros(6)
    pose[free] = found.displacement
    return pose, found, element.balls(pose, Operation(speed))


def in_space(geometry, pose, inner_speed=0.0, outer_speed=0.0, start=None, damping_time=0.0):
    """Force on the inner ring (6,) by vectors in space: each ball in a cage that turns, its spin from the raceways.

    Unknowns: the two coordinates of each ball. Traction at the outer raceway is what gives the ball the change of its
    spin that the turning cage asks for. Nothing of the product but geometry, Hertz coefficients and cage speed.
    """
    coefficient = [contact.coefficient for contact in geometry.contacts(STEEL)]
    diameter, pitch = geometry.ball_diameter, geometry.pitch_diameter
    mass = STEEL.density * math.pi / 6.0 * diameter**3
    cage = np.array([geometry.cage_speed(inner_speed, outer_speed), 0.0, 0.0])
    ring_axis = np.array([1.0, 0.0, 0.0])
    tilt = np.array([0.0, pose[4], pose[5]])
    force, moment = np.zeros(3), np.zeros(3)
    apart = geometry.groove_distance * math.sin(geometry.contact_angle)
    arm = geometry.inner_groove_radius
    for j in range(geometry.balls):
        angle = 2.0 * math.pi * j / geometry.balls
        out = np.array([0.0, math.cos(angle), math.sin(angle)])
        outer_centre = (arm - geometry.radial_distance) * out
        lever = arm * out
        inner_centre = lever + np.array([apart, 0.0, 0.0]) + pose[:3] + np.cross(tilt, lever)
        # what leads along the ring does not move grooves of revolution
        across = np.cross(ring_axis, out)
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
            touch = -eo * 0.5 * diameter  # from the ball's centre to the outer raceway
            # spin against the cage: no slip along the ring, no drilling at the outer raceway
            relative = np.array([outer_speed, 0.0, 0.0]) - cage
            around = np.cross(ring_axis, out)
            radius = 0.5 * pitch + touch @ out
            slip = relative[0] * radius
            matrix = np.array([np.cross(touch, around) * -1.0, eo, around])
            # (spin x touch).around = slip;  spin.eo = relative.eo;  no spin along the ring
            matrix[0] = np.cross(touch, around)
            spin = np.linalg.solve(matrix, np.array([slip, relative @ eo, 0.0]))
            change = np.cross(cage, 0.1 * mass * diameter**2 * (spin + cage))
            # traction lies in the plane, across the normal; its moment about the ball's centre is the change
            direction = np.cross(around, eo)
            traction = direction * (change @ around) / (np.cross(touch, direction) @ around)
            centrifugal = 0.5 * mass * pitch * cage[0] ** 2 * out
            return qi * ei + qo * eo + traction + centrifugal, qi * ei

        def unbalanced(place, parts=parts, out=out):
            total, _ = parts(place)
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
        _, pull = parts(best[1])
        force -= pull
        moment -= np.cross(lever, pull)
    return np.array([*force, 0.0, moment[1], moment[2]])

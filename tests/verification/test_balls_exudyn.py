"""A rotor on a preloaded pair of angular contact bearings in Exudyn, which calls our force of the balls.

The rotor there has six freedoms and finite rotations, and really turns. Assembly, gyroscopic terms, the other way round
of the second bearing, rest, modes and time are checked by foreign code; the force of the balls is ours on both sides.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from ehdmaps.physics.point.ball_catalogue import ball_estimate
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.bearings.balls.laws import dry_law
from mbs.bearings.locating.locating_element import LocatingElement
from mbs.exports.exudyn import ExudynBallBearing
from mbs.linearised.modes import undamped_modes
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Course, SpeedProfile
from mbs.model.system import System
from mbs.settings import Settings
from tests.cases.bearings import integrate

exu = pytest.importorskip("exudyn", reason="Exudyn is a dependency of the tests alone, and has no wheel everywhere")
utilities = pytest.importorskip("exudyn.utilities", reason="as above")
pytestmark = pytest.mark.filterwarnings("ignore")

SPEED = 6000.0 * math.pi / 30.0
MASS, POLAR, TRANSVERSE = 8.0, 0.01, 0.05
PLACES = {"front": -0.05, "back": 0.08}
PRELOAD, RADIAL = 12e-6, 300.0
"""Way by which each outer ring is pushed [m], and a load across the shaft [N]."""

WAY = {"front": -1.0, "back": 1.0}
"""Sign of the contact angle, and of the way of the inner ring against the outer one."""

PULSE = Course((0.0, 0.001, 0.002, 0.003), (0.0, 60.0, 60.0, 0.0))
PUSH = np.array([0.6, 1.0, 0.0, 0.0, 0.0, 0.0])


def force(name):
    """The bearing of a place."""
    geometry = ball_estimate("7208B")
    geometry = dataclasses.replace(geometry, contact_angle=WAY[name] * geometry.contact_angle)
    return BallForce(geometry, dry_law(geometry, damping_time=1e-5))


def system(*loads):
    """The rotor here, under the load across it and others.

    Rotations are small here, so that preload keeps its lever where the rotor leans. A spring gives it what it has in
    space, F x by each bearing; F changes by 5 % in a run, or 1e-5 of the stiffness against tilts.
    """
    freedoms = ("x", "y", "z", "theta_y", "theta_z")
    frames = {name: (x, 0.0, 0.0) for name, x in PLACES.items()}
    rotor = rigid_body("rotor", [Inertia(MASS, POLAR, TRANSVERSE)], freedoms, frames=frames, spin=1.0)
    elements = [
        LocatingElement(name, f"rotor:{name}", "ground", force(name), axial_offset=WAY[name] * PRELOAD)
        for name in PLACES
    ]
    across = Load("across", "rotor", np.array([0.0, RADIAL, 0.0, 0.0, 0.0, 0.0]))
    preload = elements[1].force([elements[1].axial_offset, 0.0, 0.0, 0.0, 0.0, 0.0], inner_speed=SPEED)[0][0]
    lever = preload * (PLACES["back"] - PLACES["front"])
    leaning = Spring("lever", "rotor", "ground", np.diag([0.0, 0.0, 0.0, 0.0, lever, lever]))
    return System([rotor], springs=[leaning], loads=[across, *loads], elements=elements)


class There:
    """The same in Exudyn, from a displacement of the rotor (3,)."""

    def __init__(self, start, lean=(0.0, 0.0), speed=0.0, pulse=None):
        self.container = exu.SystemContainer()
        self.mbs = mbs = self.container.AddSystem()
        ground = mbs.CreateGround()
        level = utilities.RotXYZ2RotationMatrix([0.0, *lean])
        self.rotor = mbs.CreateRigidBody(
            inertia=utilities.RigidBodyInertia(mass=MASS, inertiaTensor=np.diag([POLAR, TRANSVERSE, TRANSVERSE])),
            nodeType=exu.NodeType.RotationEulerParameters,
            initialAngularVelocity=list(level @ [speed, 0.0, 0.0]),
            initialDisplacement=list(start),
            referenceRotationMatrix=level,
        )
        centre = mbs.AddMarker(utilities.MarkerBodyRigid(bodyNumber=self.rotor))
        origin = mbs.AddMarker(utilities.MarkerBodyRigid(bodyNumber=ground))
        if not speed:
            held = [0, 0, 0, 1, 0, 0]
            mbs.AddObject(utilities.ObjectJointGeneric(markerNumbers=[origin, centre], constrainedAxes=held))
        for name, x in PLACES.items():
            outer = utilities.MarkerBodyRigid(bodyNumber=ground, localPosition=[x - WAY[name] * PRELOAD, 0.0, 0.0])
            inner = utilities.MarkerBodyRigid(bodyNumber=self.rotor, localPosition=[x, 0.0, 0.0])
            ExudynBallBearing(force(name)).add(mbs, mbs.AddMarker(outer), mbs.AddMarker(inner))

        def pushed(mbs, time, load):
            way = np.array([0.0, RADIAL, 0.0])
            return list(way if pulse is None else way + PUSH[:3] * pulse(time))

        mbs.AddLoad(utilities.Force(markerNumber=centre, loadVector=[0.0, RADIAL, 0.0], loadVectorUserFunction=pushed))
        kind = exu.OutputVariableType.Displacement
        self.sensor = mbs.AddSensor(
            utilities.SensorBody(bodyNumber=self.rotor, storeInternal=True, outputVariableType=kind)
        )
        mbs.Assemble()
        self.settings = exu.SimulationSettings()
        self.settings.solutionSettings.writeSolutionToFile = False
        self.settings.timeIntegration.verboseMode = 0
        self.settings.staticSolver.verboseMode = 0
        for solver in (self.settings.staticSolver, self.settings.timeIntegration):
            solver.newton.numericalDifferentiation.relativeEpsilon = 1e-10
            solver.newton.numericalDifferentiation.minimumCoordinateSize = 1e-2


def test_rest_and_modes():
    """Newton methods stop at 1e-8 of the load; the spring of the lever holds to 1e-5."""
    balance = equilibrium(system(), Operation())
    there = There([0.0, 1e-6, 0.0])
    assert there.mbs.SolveStatic(there.settings, updateInitialValues=True)
    found = there.mbs.GetObjectOutputBody(there.rotor, exu.OutputVariableType.Displacement)
    np.testing.assert_allclose(found, balance.displacement[:3], atol=1e-5 * np.abs(balance.displacement[:3]).max())
    values, *_ = there.mbs.ComputeODE2Eigenvalues(there.settings)
    theirs = np.sort(np.sqrt(np.abs(np.asarray(values))) / (2.0 * math.pi))[-5:]
    np.testing.assert_allclose(theirs, undamped_modes(balance).frequency, rtol=1e-5)


@pytest.mark.slow
def test_a_pulse_at_6000_rpm():
    """Both integrate by the generalised-alpha method with equal steps, so that their error is common to both.

    Not that of the turning axis, 5e-5 with twice the step; the lever's spring is 1e-5, and the even spin is 1e-6.
    """
    step, duration = 1e-5, 0.003
    balance = equilibrium(system(), Operation(SPEED))
    machine = system(Load("pulse", "rotor", PUSH, profile=PULSE))
    run = integrate(machine, SpeedProfile.constant(SPEED), duration, Settings(step, step, 0.6), balance.displacement)
    there = There(balance.displacement[:3], balance.displacement[3:], SPEED, PULSE)
    there.settings.timeIntegration.numberOfSteps = round(duration / step)
    there.settings.timeIntegration.endTime = duration
    there.settings.timeIntegration.generalizedAlpha.spectralRadius = 0.6
    there.settings.solutionSettings.sensorsWritePeriod = step
    assert there.mbs.SolveDynamic(there.settings)
    theirs = there.mbs.GetSensorStoredData(there.sensor)[:, 1:4]
    moved = run.states.displacement[:, :3] - balance.displacement[:3]
    assert np.abs(moved).max() > 1e-7
    assert np.abs(theirs - balance.displacement[:3] - moved).max() < 3e-5 * np.abs(moved).max()

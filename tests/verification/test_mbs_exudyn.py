"""The shaft-bearing system in another multibody program, Exudyn, which calls our bearing force.

Bodies there have six freedoms and finite rotations, the shaft really turns; joints take away what our system does not
have. So assembly, gyroscopic terms, statics, modes and time integration are checked by foreign code; the bearing force
itself is ours on both sides.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from ehdmaps.errors import InputError
from mbs.exports.exudyn import ExudynBearing, add_system
from mbs.linearised.modes import undamped_modes
from mbs.model.elements import Load, Operation
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Course, SpeedProfile
from mbs.model.system import System
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene
from mbs.settings import Settings
from tests.cases.bearings import integrate

exu = pytest.importorskip("exudyn", reason="Exudyn is a dependency of the tests alone, and has no wheel everywhere")
pytestmark = pytest.mark.filterwarnings("ignore")

SPEED = 500.0 * math.pi / 30.0
SCENE = read_scene("nu308_rigid")
SIDES = (("left", -0.07), ("right", 0.07))


class Exudyn:
    """The system of the scene nu308_rigid there, at rest or turning; the load goes with `factor(t)`."""

    def __init__(self, model, speed=0.0, extra=None, start=(0.0, 0.0), films="slow"):
        from exudyn.utilities import RigidBodyInertia

        self.container = exu.SystemContainer()
        self.mbs = mbs = self.container.AddSystem()
        shaft_body = model.system.body("shaft")
        mass, tilt = shaft_body.mass[0, 0], shaft_body.mass[2, 2]
        ground = mbs.CreateGround()
        # The polar inertia is the gyroscopic block for each unit of speed.
        polar = shaft_body.gyroscopic[2, 3]
        self.shaft = mbs.CreateRigidBody(
            inertia=RigidBodyInertia(mass=mass, inertiaTensor=np.diag([polar, tilt, tilt])),
            nodeType=exu.NodeType.RotationEulerParameters,
            initialAngularVelocity=[speed, 0.0, 0.0],
            initialDisplacement=[0.0, *start],
        )
        centre = mbs.AddMarker(exu.utilities.MarkerBodyRigid(bodyNumber=self.shaft))
        origin = mbs.AddMarker(exu.utilities.MarkerBodyRigid(bodyNumber=ground))
        free = [1, 0, 0, 0, 0, 0] if speed else [1, 0, 0, 1, 0, 0]
        mbs.AddObject(exu.utilities.ObjectJointGeneric(markerNumbers=[origin, centre], constrainedAxes=free))
        self.rings = []
        for (side, x), bearing in zip(SIDES, model.bearings, strict=True):
            ring_mass = model.system.body(f"ring_{side}").mass[0, 0]
            ring = mbs.CreateRigidBody(
                inertia=RigidBodyInertia(mass=ring_mass, inertiaTensor=1e-3 * np.eye(3)),
                referencePosition=[x, 0.0, 0.0],
            )
            self.rings.append(ring)
            at_ground = mbs.AddMarker(exu.utilities.MarkerBodyRigid(bodyNumber=ground, localPosition=[x, 0.0, 0.0]))
            at_ring = mbs.AddMarker(exu.utilities.MarkerBodyRigid(bodyNumber=ring))
            at_shaft = mbs.AddMarker(exu.utilities.MarkerBodyRigid(bodyNumber=self.shaft, localPosition=[x, 0.0, 0.0]))
            mbs.AddObject(
                exu.utilities.ObjectJointGeneric(markerNumbers=[at_ground, at_ring], constrainedAxes=[1, 0, 0, 1, 1, 1])
            )
            mbs.AddObject(
                exu.utilities.ObjectConnectorCartesianSpringDamper(
                    markerNumbers=[at_ground, at_ring], stiffness=[0.0, 1e5, 1e5], damping=[0.0, 0.0, 0.0]
                )
            )
            ExudynBearing(bearing.force, 313.15, films).add(mbs, at_ring, at_shaft)
            for marker, sign in ((at_shaft, 1.0), (at_ring, -1.0)):
                mbs.AddLoad(exu.utilities.Force(markerNumber=marker, loadVector=[0.0, 100.0 * sign, 100.0 * sign]))
        if extra is not None:
            vector = exu.utilities.Force(
                markerNumber=centre,
                loadVector=[0.0, 0.0, 0.0],
                loadVectorUserFunction=lambda mbs, t, load: [0.0, extra(t), 0.0],
            )
            mbs.AddLoad(vector)
        mbs.Assemble()
        self.settings = exu.SimulationSettings()
        self.settings.solutionSettings.writeSolutionToFile = False
        self.settings.timeIntegration.verboseMode = 0
        self.settings.staticSolver.verboseMode = 0
        for solver in (self.settings.staticSolver, self.settings.timeIntegration):
            # Differences of 1e-12 m: soft mounts must not drown in the error of the stiff contacts.
            solver.newton.numericalDifferentiation.relativeEpsilon = 1e-10
            solver.newton.numericalDifferentiation.minimumCoordinateSize = 1e-2

    def state(self):
        """Displacements of shaft y z, then of the rings."""
        bodies = (self.shaft, *self.rings)
        kind = exu.OutputVariableType.Displacement
        return np.concatenate([self.mbs.GetObjectOutputBody(body, kind)[1:3] for body in bodies])


@pytest.fixture(scope="module")
def model():
    return assemble(SCENE, "hertz", clearance=10e-6)


def test_statics_and_modes(model):
    """Rest, and the frequencies about it."""
    balance = equilibrium(model.system, Operation())
    there = Exudyn(model, start=(6e-6, 6e-6))
    there.mbs.SolveStatic(there.settings, updateInitialValues=True)
    found = there.state()
    ours = balance.displacement[[0, 1, 4, 5, 6, 7]]
    # Both Newton methods stop at 1e-8 of the load or less.
    np.testing.assert_allclose(found[:2] - found[2:4], ours[:2] - ours[2:4], rtol=1e-7)
    values, *_ = there.mbs.ComputeODE2Eigenvalues(there.settings)
    theirs = np.sort(np.sqrt(np.abs(np.asarray(values))) / (2.0 * math.pi))[-8:]
    frequency = undamped_modes(balance).frequency
    # The stiffness there is a difference over 1e-12 m: its rounding is felt where the rings move on their soft mounts.
    np.testing.assert_allclose(theirs[:4], frequency[:4], rtol=1e-3)
    np.testing.assert_allclose(theirs[4:], frequency[4:], rtol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(("law", "films", "duration"), [("hertz", "slow", 0.05), ("formula", "memory", 0.01)])
def test_response_in_time(law, films, duration):
    """A pulse of 50 N on the shaft at 500 rpm.

    Both integrate by the generalised-alpha method with equal steps, so the error of the steps is common to both (the
    order of ours is tested by itself), and only the Newton methods differ, which stop at 1e-8 of the forces. The cage
    turns there with the body, which the pulse turns a little out of its even spin: some 1e-6 of the motion.
    """
    model = assemble(SCENE, law, clearance=10e-6, films=films)
    times, factors = (0.0, 0.002, 0.004, 0.006), (0.0, 50.0, 50.0, 0.0)
    pulse = Course(times, factors)
    step, bar = 5e-5, 3e-6
    y = np.array([0.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    system = System(
        model.system.bodies, SCENE.springs, (*SCENE.loads, Load("pulse", "shaft", y, profile=pulse)), model.bearings
    )
    balance = equilibrium(model.system, Operation(SPEED))
    run = integrate(system, SpeedProfile.constant(SPEED), duration, Settings(step, step, 0.6), balance.displacement)
    there = Exudyn(model, SPEED, pulse, start=balance.displacement[:2], films=films)
    names = []
    kind = exu.OutputVariableType.Displacement
    for body in (there.shaft, *there.rings):
        names.append(
            there.mbs.AddSensor(exu.utilities.SensorBody(bodyNumber=body, storeInternal=True, outputVariableType=kind))
        )
    there.mbs.Assemble()
    there.settings.timeIntegration.numberOfSteps = round(duration / step)
    there.settings.timeIntegration.endTime = duration
    there.settings.timeIntegration.generalizedAlpha.spectralRadius = 0.6
    there.settings.solutionSettings.sensorsWritePeriod = step
    assert there.mbs.SolveDynamic(there.settings)
    shaft, left, right = (there.mbs.GetSensorStoredData(name)[:, 2:4] for name in names)
    ours = run.states.displacement
    for theirs, mine in ((shaft, ours[:, :2]), (left, ours[:, 4:6]), (right, ours[:, 6:8])):
        assert np.abs(theirs - mine).max() < bar * np.abs(mine).max()
    theirs, mine = shaft - left, ours[:, :2] - ours[:, 4:6]
    moved = mine - mine[0]
    assert np.abs(theirs - mine).max() < bar * np.abs(moved).max()


@pytest.mark.parametrize(
    ("law", "options", "says"),
    [
        ("hertz", {"films": "memory"}, r"films: got 'memory' with a dry law; allowed: 'slow', or a law with films"),
        ("formula", {"films": "memory", "centrifugal": True}, r"centrifugal: got True with films 'memory'; allowed"),
    ],
)
def test_what_a_connector_cannot_have_is_refused(law, options, says):
    with pytest.raises(InputError, match=says):
        ExudynBearing(assemble(SCENE, law).bearings[0].force, 313.15, **options)


def test_an_angle_is_counted_through_full_turns_and_a_retried_step_is_not_a_step():
    """Cage angle by the ratio of the cage: rounding."""
    bearing = assemble(SCENE, "hertz").bearings[0]
    connector = ExudynBearing(bearing.force)
    still, level, y = np.zeros(3), np.eye(3), np.array([0.0, 20e-6, 3e-6])
    for turn in np.linspace(0.0, 30.0, 61):
        for angle in (turn + 0.3, turn):  # a try of the solver, then what it keeps
            turned = np.array([math.remainder(angle, 2.0 * math.pi), 0.0, 0.0])
            found = connector(None, turn, 0, y, turned, still, still, None, None, level, level, None)
    pose = np.array([*y, 0.0, 0.0, 0.0])
    wanted, _, _ = bearing.force(pose, np.zeros(6), cage_angle=bearing.bearing.cage_angle(30.0))
    np.testing.assert_allclose(found, -wanted, rtol=1e-9, atol=1e-9 * np.abs(wanted).max())


@pytest.mark.slow
def test_a_whole_machine_goes_on_in_time_as_ours_and_begins_anew():
    """2 ms at 500 rpm from a place 1 % away, films with memory, twice: parabolas of films, which slices take in turns.

    They are wrong by some 1e-5; Newton's methods go on to where they are no part of it.

    Films that follow at once are another machine: by more than 1e-3 of what moves.
    """
    ran = {}
    for films in ("memory", "slow"):
        system = assemble(SCENE, "formula", clearance=10e-6, films=films).system
        start, step = 1.01 * equilibrium(system, Operation(SPEED)).displacement, 5e-5
        settings = Settings(step, step, 0.6, residual=1e-12)
        run = integrate(system, SpeedProfile.constant(SPEED), 40 * step, settings, start)
        ran[films] = run.states.displacement[1:]
    system = assemble(SCENE, "formula", clearance=10e-6, films="memory").system
    there = exu.SystemContainer().AddSystem()
    node = add_system(there, system, Operation(SPEED), start, in_time=True)
    kind = exu.OutputVariableType.Coordinates
    sensor = there.AddSensor(exu.utilities.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=kind))
    there.Assemble()
    settings = exu.SimulationSettings()
    settings.solutionSettings.writeSolutionToFile = False
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 40, 40 * step
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.6
    settings.timeIntegration.newton.relativeTolerance = 1e-10
    settings.solutionSettings.sensorsWritePeriod = step
    for _ in range(2):
        assert there.SolveDynamic(settings)
        theirs = np.asarray(there.GetSensorStoredData(sensor))[1:, 1:]
        moved = np.max(np.abs(ran["memory"] - start))
        assert np.max(np.abs(theirs - ran["memory"])) < 1e-5 * moved
    assert np.max(np.abs(ran["slow"] - ran["memory"])) > 1e-3 * moved

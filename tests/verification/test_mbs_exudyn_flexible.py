"""A flexible shaft in another multibody program, Exudyn: its own reduction, body, solvers and integration.

The finite-element matrices come from scikit-fem and go to both programs. There the shaft is a floating frame of
reference with finite rotations and the modes of a Hurty-Craig-Bampton reduction made there. The bearing force is ours
on both sides. On bearings the shaft itself does not spin, as our reduced solid has no gyroscopic terms: cages turn and
films are those of 2000 rpm by numbers that are given. On linear springs it spins, against our shaft of beams, and
there the two programs share nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
import skfem
from scipy import sparse
from skfem.helpers import dot
from skfem.models.elasticity import lame_parameters, linear_elasticity

from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from mbs.bearings import laws
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.flexible.finite_elements import FiniteElementModel
from mbs.flexible.reduced_body import to_body
from mbs.flexible.reduction import Interface, reduce
from mbs.flexible.shaft import flexible_shaft
from mbs.flexible.shaft_parts import Section
from mbs.linearised.modes import modes, undamped_modes
from mbs.model.body import FREEDOMS
from mbs.model.elements import Load, Operation, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Course, SpeedProfile
from mbs.model.system import System
from mbs.settings import Settings
from tests.cases.bearings import integrate

exu = pytest.importorskip("exudyn", reason="Exudyn is a dependency of the tests alone, and has no wheel everywhere")
items, fem = pytest.importorskip("exudyn.utilities"), pytest.importorskip("exudyn.FEM")
pytestmark = pytest.mark.filterwarnings("ignore:.*deprecated:DeprecationWarning")

LENGTH, RADIUS = 0.24, 0.02
SEATS = {"left": 0.04, "right": 0.20}
MIDDLE = 0.12
PLACES = ("left", "middle", "right")
CUTOFF = 15e3
SOLID_MODES = 9
"""As many modes does the solid shaft have up to the cut-off, its seats held in the mean; the next is at 15.7 kHz."""

ATTEMPTS = 20
SPEED = 2000.0 * math.pi / 30.0
TEMPERATURE = 313.15
PRELOAD = np.array([0.0, 100.0, 100.0])
DURATION, STEP, RADIUS_AT_INFINITY = 0.02, 2e-5, 0.8
PULSE = Load(
    "pulse",
    "shaft:middle",
    np.array([0.0, 200.0, 80.0, 0.0, 0.0, 0.0]),
    profile=Course((0.0, 0.001, 0.002, 0.003), (0.0, 1.0, 1.0, 0.0)),
)

AXIAL = np.diag([1e6, 0.0, 0.0, 1e3, 0.0, 0.0])
"""What holds the shaft along its axis and against turning [N/m, N m/rad]: bearings do not."""


@dataclass(frozen=True, eq=False)
class Solid:
    """Matrices of the shaft, the three displacements of one node after the other, and where the nodes are."""

    stiffness: sparse.csr_matrix
    mass: sparse.csr_matrix
    positions: np.ndarray

    def nodes_at(self, x):
        """Nodes of a cross-section."""
        return np.flatnonzero(np.abs(self.positions[:, 0] - x) < 1e-9)

    @property
    def middle(self):
        """The node in the middle of the axis."""
        return int(np.argmin(np.linalg.norm(self.positions - [MIDDLE, 0.0, 0.0], axis=1)))


@pytest.fixture(scope="module")
def solid():
    """Quadratic hexahedra: a bar of square section, 2 x 2 x 12 elements, whose section is mapped to a disc."""
    sides = np.linspace(-1.0, 1.0, 3)
    bar = skfem.MeshHex2.from_mesh(skfem.MeshHex.init_tensor(np.linspace(0.0, LENGTH, 13), sides, sides))
    x, u, v = bar.doflocs
    disc = np.stack([x, RADIUS * u * np.sqrt(1.0 - 0.5 * v**2), RADIUS * v * np.sqrt(1.0 - 0.5 * u**2)])
    basis = skfem.Basis(skfem.MeshHex2(disc, bar.t), skfem.ElementVector(skfem.ElementHex2()), intorder=5)
    elasticity = linear_elasticity(*lame_parameters(STEEL.youngs_modulus, STEEL.poisson_ratio))
    inertia = skfem.BilinearForm(lambda u, v, w: STEEL.density * dot(u, v))
    groups = (basis.nodal_dofs, basis.edge_dofs, basis.facet_dofs, basis.interior_dofs)
    rows = np.concatenate([group.T.ravel() for group in groups])
    stiffness, mass = (skfem.asm(form, basis)[rows][:, rows].tocsr() for form in (elasticity, inertia))
    return Solid(stiffness, mass, basis.doflocs[:, rows[::3]].T.copy())


def reduced_body(solid, kind):
    """The shaft by our reduction."""
    count = len(solid.positions)
    model = FiniteElementModel(
        stiffness=sparse.csc_array(solid.stiffness),
        mass=sparse.csc_array(solid.mass),
        nodes=np.repeat(np.arange(count), 3),
        directions=np.tile(np.arange(3), count),
        numbers=np.arange(count),
        positions=solid.positions,
    )
    interfaces = {name: Interface(np.array([x, 0.0, 0.0]), solid.nodes_at(x), kind) for name, x in SEATS.items()}
    reduced = reduce(model, interfaces, {"middle": np.array([MIDDLE, 0.0, 0.0])}, CUTOFF)
    return to_body(reduced, "shaft", (0.0, 0.0, 0.0), 0.0)


class Exudyn:
    """The shaft there: free, with all its own modes up to the cut-off, `shapes` in number; `spin` [rad/s]."""

    def __init__(self, solid, kind, shapes, spin=0.0):
        interface = fem.FEMinterface()
        interface.nodes = {"Position": solid.positions}
        interface.massMatrix, interface.stiffnessMatrix = solid.mass, solid.stiffness
        sections = {name: solid.nodes_at(x) for name, x in SEATS.items()}
        mode = {"rigid": fem.HCBstaticModeSelection.RBE2, "averaging": fem.HCBstaticModeSelection.RBE3}[kind]
        for _ in range(ATTEMPTS):
            interface.ComputeHurtyCraigBamptonModes(list(sections.values()), nEigenModes=shapes, computationMode=mode)
            # Lanczos' method begins at random there. Of four equal modes, those of the two overhangs in y and z, it
            # sometimes misses one, and has one above the cut-off in its place.
            if np.max(interface.GetEigenFrequenciesHz()) <= CUTOFF:
                break
        else:
            pytest.fail(f"{shapes} modes up to {CUTOFF} Hz were not found in {ATTEMPTS} attempts")
        self.container = exu.SystemContainer()
        self.mbs = mbs = self.container.AddSystem()
        body = fem.ObjectFFRFreducedOrderInterface(interface).AddObjectFFRFreducedOrder(
            mbs, initialAngularVelocity=[spin, 0.0, 0.0]
        )["oFFRFreducedOrder"]
        self.ground = mbs.CreateGround()
        self.markers = {
            name: mbs.AddMarker(
                items.MarkerSuperElementRigid(
                    bodyNumber=body, meshNodeNumbers=nodes, weightingFactors=np.full(len(nodes), 1.0 / len(nodes))
                )
            )
            for name, nodes in sections.items()
        }
        self.markers["middle"] = mbs.AddMarker(
            items.MarkerSuperElementPosition(bodyNumber=body, meshNodeNumbers=[solid.middle], weightingFactors=[1.0])
        )
        self.rolls = False
        """Whether time goes on: static solutions have a time too, in which no cage turns and no pulse comes."""

    def spring(self, place, stiffness, force=0):
        """A linear spring (6, 6) from the ground to a seat, or whatever force a function gives."""
        at_ground = self.mbs.AddMarker(
            items.MarkerBodyRigid(bodyNumber=self.ground, localPosition=[SEATS[place], 0.0, 0.0])
        )
        self.mbs.AddObject(
            items.ObjectConnectorRigidBodySpringDamper(
                markerNumbers=[at_ground, self.markers[place]],
                stiffness=stiffness,
                damping=np.zeros((6, 6)),
                springForceTorqueUserFunction=force,
            )
        )

    def bearing(self, place, element):
        """Our bearing force, its outer ring fixed: there it acts on the first marker, the ground."""

        def force(mbs, t, item, displacement, rotation, velocity, turning, stiffness, damping, r0, r1, offset):
            # Tait-Bryan angles x y z: tilts are entries of the rotation matrix; the shaft does not spin here.
            cx, sx = math.cos(rotation[0]), math.sin(rotation[0])
            sy = math.sin(rotation[1])
            cz, sz = math.cos(rotation[2]), math.sin(rotation[2])
            pose = np.array([*displacement, 0.0, cx * sy * cz - sx * sz, sx * sy * cz + cx * sz])
            rate = np.array([*velocity, 0.0, turning[1], turning[2]])
            return -element.evaluate(pose, rate, Operation(SPEED, SPEED * t * self.rolls, t))[0]

        self.spring(place, np.zeros((6, 6)), force)

    def load(self, place, force, factor=None):
        """A force (3,) at a place, times a function of time if one is given."""
        vector = list(force)
        if factor is None:
            load = items.Force(markerNumber=self.markers[place], loadVector=vector)
        else:
            load = items.Force(
                markerNumber=self.markers[place],
                loadVector=[0.0, 0.0, 0.0],
                loadVectorUserFunction=lambda mbs, t, zero: [factor(t) * self.rolls * part for part in vector],
            )
        self.mbs.AddLoad(load)

    def finish(self):
        """Assemble it, with a sensor at each place."""
        self.sensors = [
            self.mbs.AddSensor(
                items.SensorMarker(
                    markerNumber=self.markers[name],
                    storeInternal=True,
                    outputVariableType=exu.OutputVariableType.Displacement,
                )
            )
            for name in PLACES
        ]
        self.mbs.Assemble()
        self.settings = exu.SimulationSettings()
        self.settings.solutionSettings.writeSolutionToFile = False
        for solver in (self.settings.staticSolver, self.settings.timeIntegration):
            solver.verboseMode = 0
            # Differences over 1e-11 m: less drowns in rounding, more bends with the films.
            solver.newton.numericalDifferentiation.relativeEpsilon = 1e-9
            solver.newton.numericalDifferentiation.minimumCoordinateSize = 1e-2
        return self

    def settle(self):
        """Displacements y and z of the places at rest, shape (3, 2) [m]; later solutions begin there."""
        self.mbs.SolveStatic(self.settings, updateInitialValues=True)
        return np.array([self.mbs.GetSensorValues(sensor)[1:] for sensor in self.sensors])

    def frequencies(self):
        """Undamped frequencies [Hz], rising."""
        values, _ = self.mbs.ComputeODE2Eigenvalues(self.settings)
        return np.sort(np.sqrt(np.abs(values))) / (2.0 * math.pi)

    def eigenvalues(self):
        """Complex eigenvalues by rising size [1/s], one of each pair."""
        values, _ = self.mbs.ComputeODE2Eigenvalues(
            self.settings, computeComplexEigenvalues=True, useAbsoluteValues=False
        )
        values = np.asarray(values)
        values = values[values.imag >= 0.0]
        return values[np.argsort(np.abs(values))]

    def run(self, duration, step, radius, every=1):
        """Displacements y and z of the places over time, shape (3, samples, 2) [m]."""
        self.rolls = True
        self.settings.timeIntegration.numberOfSteps = round(duration / step)
        self.settings.timeIntegration.endTime = duration
        self.settings.timeIntegration.generalizedAlpha.spectralRadius = radius
        self.settings.timeIntegration.newton.useModifiedNewton = True
        self.settings.solutionSettings.sensorsWritePeriod = every * step
        assert self.mbs.SolveDynamic(self.settings)
        return np.array([self.mbs.GetSensorStoredData(sensor)[:, 2:4] for sensor in self.sensors])


@pytest.fixture(scope="module")
def elements():
    """Two NU308 with a clearance of 20 um and the law of the film formula; their outer rings are fixed."""
    bearing = Bearing.named("NU308", clearance=20e-6)
    oil = {"entrainment_speed": (1.0, 5.0), "temperature": (303.15, 333.15), "outside": "clamp"}
    law = laws.formula(bearing, Lubricant.named("FVA3"), load=(1e2, 1e6), **oil)
    return [
        BearingElement(f"bearing_{name}", f"shaft:{name}", "ground", bearing, BearingForce(bearing, law), TEMPERATURE)
        for name in SEATS
    ]


def system_of(body, elements, extra=()):
    """Our system; the flexible body does not spin, the bearings roll at the speed of the system."""
    loads = [Load(f"preload_{name}", f"shaft:{name}", np.concatenate([PRELOAD, np.zeros(3)])) for name in SEATS]
    return System([body], [Spring("hold", "shaft:left", "ground", AXIAL)], [*loads, *extra], elements)


def the_same_there(solid, kind, shapes, elements, pulse=None):
    """The system of `system_of` in Exudyn; `pulse` is a load at the middle."""
    there = Exudyn(solid, kind, shapes)
    there.spring("left", AXIAL)
    for name, element in zip(SEATS, elements, strict=True):
        there.bearing(name, element)
        there.load(name, PRELOAD)
    if pulse:
        there.load("middle", pulse.force[:3], pulse.profile)
    return there.finish()


def transverse(system, q):
    """Displacements y and z of the places, shape (3, ..., 2) [m], of coordinates (..., n)."""
    return np.array([q @ system.relative(f"shaft:{name}")[1:3].T for name in PLACES])


def bend(places):
    """Displacement of the middle against the seats, of `transverse`."""
    left, middle, right = places
    return middle - 0.5 * (left + right)


def tilt(places):
    """Displacement of one seat against the other, of `transverse`."""
    return places[2] - places[0]


def plane(course):
    """Angle from y to z [rad] of the plane of vibration in the last 100 samples of displacements (samples, 2)."""
    y, z = course[-100:].T
    return 0.5 * math.atan2(2.0 * np.sum(y * z), np.sum(y * y) - np.sum(z * z))


def own_modes(body):
    """Number of modes that our reduction kept besides the motion of the two seats; there as many are taken."""
    return body.size - 12


@pytest.mark.parametrize("kind", ["rigid", "averaging"])
def test_statics_and_modes(solid, elements, kind):
    """Rest, undamped modes and complex modes.

    The bearings damp some modes by a tenth of critical, which complex modes show too.
    """
    body = reduced_body(solid, kind)
    there = the_same_there(solid, kind, own_modes(body), elements)
    balance = equilibrium(system_of(body, elements), Operation(SPEED))
    # Both Newton methods stop at 1e-8 of the load or less.
    np.testing.assert_allclose(there.settle(), transverse(balance.system, balance.displacement), rtol=1e-7)
    # The stiffness there is a difference over 1e-11 m, which bends by some 1e-6 with the films.
    np.testing.assert_allclose(there.frequencies(), undamped_modes(balance).frequency, rtol=3e-5)
    ours, theirs = modes(balance).eigenvalues, there.eigenvalues()
    # So is the damping, of which rounding takes 1e-5; a difference in damping ratio counts like one in frequency.
    assert np.all(np.abs(theirs - ours) < 1e-4 * np.abs(ours))


def shaft_of_beams(freedoms):
    """The shaft made of beams."""
    section = Section(0.0, LENGTH, 2.0 * RADIUS, 0.0, STEEL.youngs_modulus, STEEL.poisson_ratio, STEEL.density)
    places = {**SEATS, "middle": MIDDLE}
    return flexible_shaft("shaft", [section], [], freedoms, (0.0, 0.0, 0.0), places, spin=1.0, cutoff=2.0 * CUTOFF)


def test_modes_of_the_shaft_of_beams(solid, elements):
    """The shaft made of beams here against the solid one there, below the second bending.

    Bounds the error of the beams (plane sections, 0.1 % at the first bending of this shaft) and of the mesh, whose
    section has 0.14 % less area and 0.3 % less moment of inertia than a circle.
    """
    balance = equilibrium(system_of(shaft_of_beams(FREEDOMS), elements), Operation(SPEED))
    there = the_same_there(solid, "averaging", SOLID_MODES, elements)
    there.settle()
    ours = undamped_modes(balance).frequency
    ours = ours[ours < 5e3]
    assert ours[-1] > 3e3, "the first bending is among them"
    np.testing.assert_allclose(there.frequencies()[: ours.size], ours, rtol=3e-3)


@pytest.mark.slow
def test_spinning_shaft_of_beams(solid):
    """Gyroscopic moments turn the plane of a free vibration, which a force along y has begun.

    The shaft spins at 20000 rpm on linear springs. There its modes turn with it and nothing is called gyroscopic; here
    it is made of beams. Angles of the planes of tilt and of bend after 4 ms are compared, which feel small
    differences of frequency less than the displacements do.
    """
    spin, duration, step, sample = 20000.0 * math.pi / 30.0, 0.004, 5e-6, 1e-5
    seat, hold = np.diag([0.0, 2e7, 2e7, 0.0, 0.0, 0.0]), np.diag([1e6, 0.0, 0.0, 0.0, 0.0, 0.0])
    force, factor = np.array([0.0, 500.0, 0.0]), Course((0.0, 2e-4, 4e-4), (0.0, 1.0, 0.0))
    there = Exudyn(solid, "averaging", SOLID_MODES, spin)
    for name in SEATS:
        there.spring(name, seat)
    there.spring("left", hold)
    there.load("left", force, factor)
    theirs = there.finish().run(duration, step, 1.0, every=2)
    system = System(
        [shaft_of_beams(("x", "y", "z", "theta_y", "theta_z"))],
        [Spring("hold", "shaft:left", "ground", hold)]
        + [Spring(f"seat_{name}", f"shaft:{name}", "ground", seat) for name in SEATS],
        [Load("pulse", "shaft:left", np.concatenate([force, np.zeros(3)]), profile=factor)],
    )
    run = integrate(system, SpeedProfile.constant(spin), duration, Settings(step, sample, 1.0))
    ours = transverse(system, run.states.displacement)
    # The error of the steps there, in a frame that turns: 0.3 % of the tilt at some 0.7 kHz, 2.2 % of the bend at
    # 3 kHz, which fall with the square of the step.
    assert plane(tilt(ours)) > 0.1
    assert plane(tilt(theirs)) == pytest.approx(plane(tilt(ours)), rel=0.01)
    assert plane(bend(ours)) > 0.2
    assert plane(bend(theirs)) == pytest.approx(plane(bend(ours)), rel=0.04)


@pytest.fixture(scope="module")
def pulsed(solid, elements):
    """The system with a pulse of 200 N at the middle of the shaft, where it rests before it, and ours over 20 ms."""
    system = system_of(reduced_body(solid, "rigid"), elements, [PULSE])
    balance = equilibrium(system, Operation(SPEED))
    run = integrate(
        system, SpeedProfile.constant(SPEED), DURATION, Settings(STEP, STEP, RADIUS_AT_INFINITY), balance.displacement
    )
    return system, transverse(system, run.states.displacement)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("finer", "tolerance"),
    [
        # With the same method and steps only the Newton methods differ, which stop at 1e-8 of the forces.
        pytest.param(1, 1e-6, id="equal steps"),
        # With half the steps there: three quarters of the error of our steps, as the methods are of second order.
        pytest.param(2, 0.01, id="half the step there"),
    ],
)
def test_response_in_time(solid, elements, pulsed, finer, tolerance):
    """20 ms of the seats, the middle, and the bend between them while the cages turn."""
    system, ours = pulsed
    there = the_same_there(solid, "rigid", own_modes(system.body("shaft")), elements, PULSE)
    there.settle()
    theirs = there.run(DURATION, STEP / finer, RADIUS_AT_INFINITY, every=finer)
    assert theirs.shape == ours.shape
    for mine, other in zip((*ours, bend(ours)), (*theirs, bend(theirs)), strict=True):
        moved = np.abs(mine - mine[0]).max()
        assert moved > 5e-7, "the pulse moves films of less than a micrometre"
        assert np.abs(other - mine).max() < tolerance * moved

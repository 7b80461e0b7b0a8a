"""Laws and the bearing element at the extremes: random poses, rates, clearances, tilts, slices and speeds of a NU308.

Ranges go a decade beyond use: displacements to 300 um (some ten times the rated load), tilts to 10 mrad, rates to
1 m/s, clearances of -20 to 200 um, 1 to 401 slices, speeds of zero, of a film that fades, and beyond the law.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import OutsideMapError
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.lubricant import Lubricant
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.contact_energy import energy_at_rest
from mbs.bearings.laws import Law, formula, hertz
from mbs.laboratory.extremes.check import Check, Verdict, checked
from mbs.model.elements import Operation

NAME = "NU308"
SLICES = (1, 2, 3, 5, 11, 41, 101, 401)
TEMPERATURE = 313.15
_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
_MIRROR_Z = np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
_MIRROR_X = np.array([-1.0, 1.0, 1.0, 1.0, -1.0, -1.0])
_ROUNDING = 1e-9

Laws = Callable[[Bearing], dict[str, Law]]


@dataclass(frozen=True)
class Case:
    """A bearing somewhere, as it is drawn.

    Attributes
    ----------
    element : BearingElement
        The bearing.
    pose, velocity : array (6,)
        Pose of its inner ring [m], [rad], and its rate.
    operation : Operation
        Speed and angle.
    words : str
        All of it.
    """

    element: BearingElement
    pose: FloatArray
    velocity: FloatArray
    operation: Operation
    words: str

    def force(self, pose: FloatArray, velocity: FloatArray) -> FloatArray:
        """Force at another motion (6,)."""
        return self.element.evaluate(pose, velocity, self.operation).force


def usual_laws(bearing: Bearing) -> dict[str, Law]:
    """Dry contacts with a damping in proportion to the stiffness, and films by formula; the latter takes seconds."""
    film = formula(bearing, Lubricant.named("FVA3"), outside="asymptote")
    return {"hertz": hertz(bearing, damping_time=1.25e-5), "formula": film}


def element_checks(runs: int, seed: int, laws: Laws = usual_laws) -> Iterator[Check]:
    """Try laws and bearing element at random.

    Parameters
    ----------
    runs : int
        Cases of each check and law.
    seed : int
        Seed of the search.
    laws : callable
        Laws by name, for a bearing.

    Yields
    ------
    Check
        One for each law and rule.
    """
    for name, law in laws(Bearing.named(NAME)).items():
        draws = _Draws(law, seed)
        for words, rule, judge in _CHECKS:
            if judge is not _cycle_with_memory or isinstance(law, ContactLaw):
                yield checked(f"bearing: {name}, {words}", rule, _judged(runs, draws, judge))


class _Draws:
    """Random cases of a law."""

    def __init__(self, law: Law, seed: int) -> None:
        self._law, self.random = law, np.random.default_rng(seed)

    def case(self) -> Case:
        """Another one."""
        random = self.random
        slices, clearance = int(random.choice(SLICES)), float(random.uniform(-20e-6, 200e-6))
        speed = float(random.choice([0.0, 1.0, -1.0])) * 10.0 ** random.uniform(-2.0, 4.0)
        bearing = Bearing.named(NAME, clearance=clearance, slices=slices)
        force = BearingForce(bearing, self._law)
        element = BearingElement("bearing", "inner", "outer", bearing, force, TEMPERATURE)
        radius, angle = 10.0 ** random.uniform(-8.0, math.log10(3e-4)), random.uniform(0.0, 2.0 * math.pi)
        pose, velocity = np.zeros(6), np.zeros(6)
        pose[1:3] = radius * np.array([math.cos(angle), math.sin(angle)])
        pose[4:6] = 10.0 ** random.uniform(-6.0, -2.0) * random.standard_normal(2).clip(-1.0, 1.0)
        velocity[1:3] = 10.0 ** random.uniform(-6.0, 0.0) * random.standard_normal(2)
        velocity[4:6] = 10.0 ** random.uniform(-5.0, 1.0) * random.standard_normal(2)
        operation = Operation(speed, float(random.uniform(0.0, 7.0)))
        words = (
            f"clearance {1e6 * clearance:.4g} um, {slices} slices, speed {speed:.4g} rad/s, "
            f"angle {operation.angle:.4g}, pose {pose.tolist()}, velocity {velocity.tolist()}"
        )
        return Case(element, pose, velocity, operation, words)


Judge = Callable[[Case, np.random.Generator], tuple[float, str]]
"""How much of its bound a case takes, above 1 where it fails, and the number in words."""


def _judged(runs: int, draws: _Draws, judge: Judge) -> Iterator[Verdict]:
    """Judge some cases."""
    for _ in range(runs):
        case = draws.case()
        try:
            share, words = judge(case, draws.random)
        except OutsideMapError:
            yield Verdict(refused="outside the map")
            continue
        yield Verdict(f"{words}; {case.words}", share) if share <= 1.0 else Verdict(case.words, wrong=words)


_DERIVATIVES = (
    "force, K and C are finite and symmetric; along a random line of 1 nm to 1 um and of some rate, the force changes "
    "by the integral of K and C over it, to 10 times what Gauss's rule in 8, 16 and 32 cells changes (at lift-off the "
    "stiffness has a cusp), and 1e-9"
)


def _derivatives(case: Case, random: np.random.Generator) -> tuple[float, str]:
    """Check whether K and C are those of the force, which is continuous."""
    found = case.element.evaluate(case.pose, case.velocity, case.operation)
    for matrix in (found.stiffness, found.damping):
        if not (np.all(np.isfinite(found.force)) and np.all(np.isfinite(matrix))):
            return math.inf, "not finite"
        size = float(np.max(np.abs(matrix)))
        if float(np.max(np.abs(matrix - matrix.T))) > _ROUNDING * size:
            return math.inf, "not symmetric"
    moved, turned = np.zeros(6), np.zeros(6)
    moved[1:3], moved[4:6] = 1e-6 * random.standard_normal(2), 1e-5 * random.standard_normal(2)
    moved *= 10.0 ** random.uniform(-3.0, 0.0)
    turned[1:3] = 0.3 * random.standard_normal(2) * float(np.linalg.norm(case.velocity[1:3]))
    change = case.force(case.pose + moved, case.velocity + turned) - found.force
    sums, scale = [], np.abs(found.force) + np.abs(change)
    for cells in (8, 16, 32):
        total = np.zeros(6)
        for place, weight in zip(_PLACES, _WEIGHTS, strict=True):
            for cell in range(cells):
                t = (cell + 0.5 * (1.0 + place)) / cells
                at = case.element.evaluate(case.pose + t * moved, case.velocity + t * turned, case.operation)
                slope = at.stiffness @ moved + at.damping @ turned
                total -= 0.5 * weight / cells * slope
                scale = np.maximum(scale, np.abs(slope))
        sums.append(total)
    missed = np.max(np.abs(np.diff(sums, axis=0)), axis=0)
    sizes = np.repeat([float(np.max(scale[:3])), float(np.max(scale[3:]))], 3)
    bound = 10.0 * missed + _ROUNDING * sizes + 1e-30
    share = float(np.max(np.abs(change - sums[-1]) / bound))
    return share, f"the force differs from the integral of its derivatives by {share:.3g} of the bound"


_REFLECTIONS = (
    "the force is the same mirrored in the planes z = 0 and x = 0, a pitch of the cage on, and at reversed speed, to "
    "1e-9 of the forces of the rollers"
)


def _reflections(case: Case, random: np.random.Generator) -> tuple[float, str]:
    """Check whether mirrored motion has mirrored force."""
    element, op = case.element, case.operation
    there = case.force(case.pose, case.velocity)
    pitch = 2.0 * math.pi / (element.bearing.geometry.rollers * abs(element.rates[0]))
    others = (
        (_MIRROR_Z, op._replace(angle=-op.angle)),
        (_MIRROR_X, op),
        (np.ones(6), op._replace(angle=op.angle + pitch)),
        (np.ones(6), op._replace(speed=-op.speed)),
    )
    # Loads of rollers against each other are larger than their sum.
    stiff = element.evaluate(case.pose, case.velocity, op).stiffness
    far = float(np.linalg.norm(case.pose[1:3])) + 1e-6
    size = np.array([1.0, 1.0, 1.0, 0.01, 0.01, 0.01]) * (float(np.max(np.abs(stiff[1:3, 1:3]))) * far + 1e-12)
    worst = 0.0
    for mirror, operation in others:
        mirrored = element.evaluate(mirror * case.pose, mirror * case.velocity, operation).force
        worst = max(worst, float(np.max(np.abs(mirrored - mirror * there) / size)))
    return worst / _ROUNDING, f"{worst:.3g} of the loads"


_DAMPERS = "(f(v) - f(0)) . v <= 0: what the rate adds to the force never gives power, to 1e-12 of its size"


def _dampers(case: Case, random: np.random.Generator) -> tuple[float, str]:
    """Check whether dampers take up power."""
    more = case.force(case.pose, case.velocity) - case.force(case.pose, np.zeros(6))
    power = float(more @ case.velocity)
    size = float(np.abs(case.force(case.pose, case.velocity)) @ np.abs(case.velocity))
    return max(power, 0.0) / (1e-12 * size + 1e-300), f"power {power:.3g} W of {size:.3g} W"


_CYCLES = (
    "over a closed random path at rest the work is zero, and between its ends the change of the stored energy, to 10 "
    "times what the trapezoidal rule of 256 steps changes against 512, and 1e-9 of the stored energy"
)


def _path(case: Case, random: np.random.Generator) -> Callable[[float], FloatArray]:
    """A closed path around the pose: three harmonics of random sizes, by its part 0 to 1."""
    sizes = np.zeros((2, 3, 6))
    sizes[:, :, 1:3] = 10.0 ** random.uniform(-8.0, -4.5) * random.standard_normal((2, 3, 2))
    sizes[:, :, 4:6] = 10.0 ** random.uniform(-6.0, -3.5) * random.standard_normal((2, 3, 2))
    orders = np.arange(1, 4)

    def at(part: float) -> FloatArray:
        turned = 2.0 * math.pi * orders * part
        return np.asarray(case.pose + np.sin(turned) @ sizes[0] + (np.cos(turned) - 1.0) @ sizes[1])

    return at


def _cycle_at_rest(case: Case, random: np.random.Generator) -> tuple[float, str]:
    """Check that the force at rest has a potential, which is the stored energy."""
    path, still, element = _path(case, random), np.zeros(6), case.element
    works, largest = [], 0.0
    for steps in (256, 512):
        poses = [path(i / steps) for i in range(steps + 1)]
        forces = [case.force(pose, still) for pose in poses]
        parts = [-0.5 * float((forces[i] + forces[i + 1]) @ (poses[i + 1] - poses[i])) for i in range(steps)]
        works.append((sum(parts), sum(parts[: steps // 2])))
    conditions = element.entrainment_speed(case.operation), TEMPERATURE, 0.0
    stored = [
        energy_at_rest(element.force.law, conditions, element.bearing, element.loads(pose, case.operation).approach)
        for pose in (path(0.0), path(0.5))
    ]
    largest = max(*stored, abs(works[1][1]))
    wrong = (abs(works[1][0]), abs(works[1][1] - (stored[1] - stored[0])))
    bounds = [10.0 * abs(fine - coarse) + _ROUNDING * largest + 1e-18 for coarse, fine in zip(*works, strict=True)]
    share = max(error / bound for error, bound in zip(wrong, bounds, strict=True))
    return share, f"net work {works[1][0]:.3g} J, {wrong[1]:.3g} J beside a stored energy of {largest:.3g} J"


_MEMORY = (
    "films never give energy: over a closed path of 10 Hz to 5 kHz run three times, films in equilibrium at the "
    "beginning, the work put in less the change of the stored energy is what films took up, and not negative, to 10 "
    "times what it changes from 256 to 512 steps a turn, 1e-3 of the work to and fro at most, and 1e-7 of it; from "
    "1024 to 2048 where these are too few"
)


def _cycle_with_memory(case: Case, random: np.random.Generator) -> tuple[float, str]:
    """Check that films with memory never give energy."""
    path, frequency = _path(case, random), 10.0 ** random.uniform(1.0, 3.7)
    share, words = _energy_of_films(case, path, frequency, 256)
    # What films gave would stay with finer steps, what the trapezoidal rule gave goes.
    return (share, words) if share <= 1.0 else _energy_of_films(case, path, frequency, 1024)


def _energy_of_films(
    case: Case, path: Callable[[float], FloatArray], frequency: float, coarse_steps: int
) -> tuple[float, str]:
    """Energy that films took up over a path run three times, beside its bound, by a number of steps and its double."""
    element = case.element
    force = element.force
    conditions = {"entrainment_speed": element.entrainment_speed(case.operation), "temperature": TEMPERATURE}
    memory, length, angle = force.in_time(**conditions).law.memory, element.bearing.slice_length, case.operation.angle
    found = []
    for steps in (coarse_steps, 2 * coarse_steps):
        pose, h = path(0.0), 1.0 / (frequency * steps)
        last, state = force.advance(None, pose, 1e6, cage_angle=angle, **conditions)
        first, spent, work, size = float(np.sum(memory.stored(state))), 0.0, 0.0, 0.0
        for i in range(3 * steps):
            following = path((i + 1) / steps)
            forces, after = force.advance(state, following, h, cage_angle=angle, **conditions)
            part = 0.5 * float((last.force + forces.force) @ (following - pose))
            work, size = work - part, size + abs(part)
            spent += float(np.sum(memory.spent(state, after)))
            last, state, pose = forces, after, following
        end = float(np.sum(memory.stored(state)))
        found.append((work, spent * length, (end - first) * length, size))
    (coarse, _, before, _), (work, spent, change, size) = found
    taken = work - change
    bound = min(10.0 * abs(taken - coarse + before), 1e-3 * size) + 1e-7 * size + 1e-18
    share = max(abs(taken - spent), -spent, -taken) / bound
    return share, f"{frequency:.4g} Hz: {taken:.4g} J taken up, {spent:.4g} J by films, {size:.3g} J to and fro"


_CHECKS: tuple[tuple[str, str, Judge], ...] = (
    ("derivatives", _DERIVATIVES, _derivatives),
    ("reflections", _REFLECTIONS, _reflections),
    ("dampers take up", _DAMPERS, _dampers),
    ("cycles at rest", _CYCLES, _cycle_at_rest),
    ("cycles with memory", _MEMORY, _cycle_with_memory),
)
"""What is asked, when it counts as right, and what judges it."""

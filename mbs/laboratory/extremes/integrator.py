"""The integrator at the extremes: stiffness and damping over many decades, and what machines are not meant for.

The measure is the energy: a linear system without loads never has more than it began with, and a balance closes the
better, the smaller the steps are. Explicit methods are the control: they have to fail where the theory says.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError
from mbs.laboratory.extremes.check import Check, Verdict, checked
from mbs.model.body import Inertia, rigid_body
from mbs.model.elements import Load, Operation, Spring
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Course, Harmonic, SpeedProfile
from mbs.model.system import System
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene
from mbs.settings import Settings
from mbs.transient.energy import EnergyBalance
from mbs.transient.run import WITH_STATES, run

STEP = 1e-5
SCENE = "nu308_rigid"
_MASS, _STEPS = 2.0, 300
_ROUNDING = 1e-9
_ACCURATE = 0.01


def integrator_checks(runs: int, seed: int) -> Iterator[Check]:
    """Try the integrator at random.

    Parameters
    ----------
    runs : int
        Cases of each check of an oscillator; a quarter of them for each scenario of the shipped scene.
    seed : int
        Seed of the search.

    Yields
    ------
    Check
        Oscillators, explicit methods as the control, and each scenario.
    """
    random = np.random.default_rng(seed)
    products: list[float] = []
    yield checked(
        "integrator: stiffness and damping",
        "a mass on a spring, omega h of 1e-4 to 1e6, damping ratio 0 or 1e-6 to 1e4, spectral radius 0 to 1: finite; "
        "at the end no more energy than at the beginning; undamped, between them no more than (1 + omega h/4)^2 times "
        "it, the overshoot of methods of this family where they do not resolve a mode; the balance closes; all to "
        "1e-9 and to the rounding of q = q0 + beta h^2 a, 1e-15 (omega h)^2, of the largest energy",
        _oscillators(runs, random, products),
        lambda: _resolved(products),
    )
    for name, step, limit in (
        ("central differences", _central_differences, 2.0),
        ("Runge-Kutta of fourth order", _runge_kutta, math.sqrt(8.0)),
    ):
        yield checked(
            f"control: {name}",
            f"an undamped oscillator keeps within 100 times its energy below omega h = {limit:.4g}, and not above: "
            "explicit methods fail there, and the measure sees it; 1 % around the limit is left out",
            _limits(step, limit, runs, random),
        )
    for name, make in SCENARIOS.items():
        steps: list[float] = []
        yield checked(
            f"integrator: {name}",
            f"{SCENE}, dry, clearance 0 to 200 um, c/k of 1e-7 to 3e-4 s, steps of {1e6 * _COARSE:g} us halved "
            f"{_HALVINGS} times: finite; the energy residual at the finest step is below 5 % of what went through, and "
            "a third of that of the coarsest or below 0.1 %; no solution is refused with a reason",
            _scenarios(make, max(runs // 4, 1), random, steps),
            partial(_largest_steps, steps),
        )


def _resolved(products: Sequence[float]) -> str:
    """Up to which omega h little was taken."""
    if not products:
        return ""
    return (
        f"; undamped with the spectral radius 0.8, up to omega h = {max(products):.3g} less than 1 % was taken in "
        f"{_STEPS} steps"
    )


def _largest_steps(steps: Sequence[float]) -> str:
    """Steps that are short enough."""
    if not steps:
        return ""
    shown = ", ".join(f"{1e6 * float(np.quantile(steps, part)):.3g}" for part in (0.0, 0.5, 1.0))
    return f"; largest step with a residual of 1 %, least, median, most of the cases: {shown} us (0: none)"


def _oscillator(stiffness: float, damping: float) -> System:
    """A mass on a spring with a damper."""
    spring = np.diag([0.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    body = rigid_body("mass", [Inertia(_MASS, 0.01, 0.02)], ("y",))
    return System([body], [Spring("spring", "mass", "ground", stiffness * spring, damping * spring)])


def _oscillators(runs: int, random: np.random.Generator, products: list[float]) -> Iterator[Verdict]:
    """The generalised-alpha method from soft to stiff, undamped to overdamped; `products`: each omega h it resolves."""
    for _ in range(runs):
        omega, radius = 10.0 ** random.uniform(-4.0, 6.0) / STEP, float(random.choice([0.0, 0.5, 0.8, 1.0]))
        ratio = float(random.choice([0.0, 1.0])) * 10.0 ** random.uniform(-6.0, 4.0)
        stiffness, damping = _MASS * omega**2, 2.0 * ratio * _MASS * omega
        settings = Settings(step=STEP, sample=STEP, spectral_radius=radius)
        case = f"omega h {omega * STEP:.3g}, damping ratio {ratio:.3g}, spectral radius {radius:g}"
        system = _oscillator(stiffness, damping)
        record = run(
            system, SpeedProfile.constant(0.0), _STEPS * STEP, settings, displacement=np.array([1e-6]),
            options=WITH_STATES,
        )  # fmt: skip
        states = record.states
        energy = 0.5 * stiffness * states.displacement[:, 0] ** 2 + 0.5 * _MASS * states.velocity[:, 0] ** 2
        product, first, largest = omega * STEP, float(energy[0]), float(np.max(energy))
        left, bound = abs(record.energy.residual) / largest, _ROUNDING + 1e-15 * product**2
        words = (
            f"{largest / first:.6g} times the energy at most, {energy[-1] / first:.6g} at the end, residual {left:.2g}"
        )
        if not (
            np.all(np.isfinite(energy))
            and energy[-1] - first <= bound * largest
            and (ratio > 0.0 or largest <= first * ((1.0 + 0.25 * product) ** 2 + bound))
            and left <= bound
        ):
            yield Verdict(case, wrong=words)
            continue
        yield Verdict(f"{case}: {words}", left / bound)
        if ratio == 0.0 and radius == 0.8 and abs(record.energy.numerical) < _ACCURATE * first:
            products.append(product)


Stepping = Callable[[float, float, float, float], tuple[float, float]]
"""A step of an explicit method: displacement, velocity, omega, h -> displacement and velocity."""


def _central_differences(q: float, v: float, omega: float, h: float) -> tuple[float, float]:
    """Central differences, as half steps of the velocity around the displacement."""
    half = v - 0.5 * h * omega**2 * q
    end = q + h * half
    return end, half - 0.5 * h * omega**2 * end


def _runge_kutta(q: float, v: float, omega: float, h: float) -> tuple[float, float]:
    """The classical method of fourth order."""

    def slope(x: FloatArray) -> FloatArray:
        return np.array([x[1], -(omega**2) * x[0]])

    x = np.array([q, v])
    first = slope(x)
    second = slope(x + 0.5 * h * first)
    third = slope(x + 0.5 * h * second)
    fourth = slope(x + h * third)
    end = x + h / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
    return float(end[0]), float(end[1])


def _limits(step: Stepping, limit: float, runs: int, random: np.random.Generator) -> Iterator[Verdict]:
    """An explicit method: bounded below its limit, and not above; this shows that the measure sees instability."""
    for _ in range(runs):
        product = 10.0 ** random.uniform(-2.0, 1.5)
        if abs(product / limit - 1.0) < 0.01:
            yield Verdict(refused="at the limit")
            continue
        omega = product / STEP
        q, v, bounded = 1e-6, 0.0, True
        for _ in range(2 * _STEPS):
            q, v = step(q, v, omega, STEP)
            if not (omega * q) ** 2 + v**2 < 100.0 * (omega * 1e-6) ** 2:
                bounded = False
                break
        case = f"omega h {product:.4g}"
        if bounded is (product < limit):
            yield Verdict(case, 1.0 - min(abs(product / limit - 1.0), 1.0))
        else:
            yield Verdict(case, wrong="bounded" if bounded else "not bounded")


@dataclasses.dataclass(frozen=True)
class Scenario:
    """Conditions that a scene is put through.

    Attributes
    ----------
    system : System
        The system that is run.
    speed : SpeedProfile
        Speed of the shaft over time.
    displacement, velocity : array (n,)
        Motion at the beginning.
    duration : float
        [s].
    words : str
        What is drawn of it.
    """

    system: System
    speed: SpeedProfile
    displacement: FloatArray
    velocity: FloatArray
    duration: float
    words: str


def _model(random: np.random.Generator) -> tuple[System, str]:
    """The scene with a dry law, clearance and damping of some size."""
    clearance, time = float(random.uniform(0.0, 200e-6)), 10.0 ** random.uniform(-7.0, -3.5)
    model = assemble(read_scene(SCENE), law=f"hertz:{time:.6e} s", clearance=clearance)
    return model.system, f"clearance {1e6 * clearance:.3g} um, damping time {time:.3g} s"


def _rest(system: System, speed: float) -> FloatArray:
    """Equilibrium at a speed."""
    return equilibrium(system, Operation(speed)).displacement


def _from_rest(random: np.random.Generator) -> Scenario:
    """Loads that act at once on a shaft in the middle, while it runs up steeply."""
    system, words = _model(random)
    end = float(random.uniform(-500.0, 500.0))
    zero = np.zeros(system.size)
    speed = SpeedProfile(Course((0.0, 0.005), (0.0, end)))
    return Scenario(system, speed, zero, zero, 0.02, f"{words}, to {end:.3g} rad/s")


def _reversal(random: np.random.Generator) -> Scenario:
    """A speed that turns round within some steps."""
    system, words = _model(random)
    speed, time = float(random.uniform(50.0, 1000.0)), 10.0 ** random.uniform(-5.0, -2.5)
    course = SpeedProfile(Course((0.0, 0.005, 0.005 + time), (speed, speed, -speed)))
    return Scenario(
        system,
        course,
        _rest(system, speed),
        np.zeros(system.size),
        0.01,
        f"{words}, {speed:.3g} rad/s within {time:.3g} s",
    )


def _unbalance(random: np.random.Generator) -> Scenario:
    """A force that turns, up to a hundred times the steady loads."""
    system, words = _model(random)
    size = float(np.max(np.abs(system.steady_loads))) * 10.0 ** random.uniform(0.0, 2.0)
    frequency = float(random.uniform(10.0, 500.0))
    loads = (
        Load("across", "shaft", np.array([0, 1.0, 0, 0, 0, 0]), profile=Harmonic(frequency, 0.5 * math.pi)),
        Load("along", "shaft", np.array([0, 0, 1.0, 0, 0, 0]), profile=Harmonic(frequency)),
    )
    start = _rest(system, 2.0 * math.pi * frequency)
    for load in loads:
        system = system.with_load(size * system.relative("shaft").T @ load.force, load.profile)
    speed = SpeedProfile.constant(2.0 * math.pi * frequency)
    words = f"{words}, {size:.3g} N at {frequency:.3g} Hz"
    return Scenario(system, speed, start, np.zeros(system.size), 0.01, words)


def _impact(random: np.random.Generator) -> Scenario:
    """A shaft that is thrown through its clearance, into separation and contact again."""
    system, words = _model(random)
    thrown = 10.0 ** random.uniform(-3.0, 0.3)
    motion = system.relative("shaft")[1]
    start = np.asarray(np.zeros(system.size))
    velocity = thrown * motion / float(motion @ motion)
    speed = SpeedProfile.constant(float(random.uniform(0.0, 300.0)))
    return Scenario(system, speed, start, velocity, 0.01, f"{words}, {thrown:.3g} m/s")


SCENARIOS: dict[str, Callable[[np.random.Generator], Scenario]] = {
    "start from rest": _from_rest,
    "sudden reversal": _reversal,
    "unbalance": _unbalance,
    "impact": _impact,
}
"""What the shipped scene is put through, by name."""

_COARSE, _HALVINGS = 8e-5, 4


def _scenarios(
    make: Callable[[np.random.Generator], Scenario], runs: int, random: np.random.Generator, steps: list[float]
) -> Iterator[Verdict]:
    """A scenario with steps from coarse to fine; the largest step of each case that is short enough."""
    for _ in range(runs):
        scenario = make(random)
        try:
            balances = [_balance(scenario, _COARSE / 2**halved) for halved in range(_HALVINGS + 1)]
        except AnalysisError:
            yield Verdict(refused="no solution with steps halved ten times")
            continue
        left = [balance.relative_residual for balance in balances]
        words = f"residuals {', '.join(f'{part:.2g}' for part in left)}"
        if not all(math.isfinite(part) for part in left):
            yield Verdict(scenario.words, wrong="not finite")
        elif left[-1] > 0.05 or left[-1] > max(left[0] / 3.0, 1e-3):
            yield Verdict(scenario.words, wrong=words)
        else:
            yield Verdict(f"{scenario.words}: {words}", left[-1] / 0.05)
        good = [_COARSE / 2**halved for halved, part in enumerate(left) if part <= _ACCURATE]
        steps.append(max(good, default=0.0))


def _balance(scenario: Scenario, step: float) -> EnergyBalance:
    """The balance of a run."""
    settings = Settings(step=step, sample=10.0 * step)
    return run(
        scenario.system, scenario.speed, scenario.duration, settings, displacement=scenario.displacement,
        velocity=scenario.velocity,
    ).energy  # fmt: skip

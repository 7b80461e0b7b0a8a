"""Speed of a compiled run beside its error: a surrogate gearbox over a ramp of the speed; all in one run.

Run: python -m tests.benchmarks.bench_run [MAP.nc] [SECONDS]

Two flexible shafts with gears of 21 and 23 teeth, four NU308 of 12 rollers x 21 slices with 20 um of clearance, and a
housing of 60 modes from 600 Hz to 12 kHz whose shapes at the bearing seats are random: of the size of a gearbox, not
one. 82 N m, from 500 to 2500 rpm in 5 s; the first SECONDS of that are run (0.2 if left out). The error is that of the
acceleration of the housing over the last half, as a part of its root mean square, against half the step with 41
slices; and against half the step with 21 slices, which leaves the error of the steps alone. The period error is that
of the method at 5 kHz. Without a map file the law is dry Hertz.
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np

import ehdmaps
from mbs import laws
from mbs.bearing import Bearing
from mbs.bearing_element import BearingElement
from mbs.bearing_force import BearingForce
from mbs.body import Body, Frame, Inertia
from mbs.elements import Load, Operation, Sensor, Spring
from mbs.flexible.shaft import flexible_shaft
from mbs.flexible.shaft_parts import Disc, Section
from mbs.gear import GearPair, gear_mesh
from mbs.laws import Law
from mbs.profiles import Course, SpeedProfile
from mbs.run import Recording, run
from mbs.statics import equilibrium
from mbs.stepping import Method, Settings
from mbs.system import System

RPM = math.pi / 30.0
TEETH = (21, 23)
CENTRE = np.array([0.0, 0.099, 0.0])
SEATS = {"left": 40e-3, "right": 200e-3}
TEMPERATURE = 333.15
SAMPLE = 6e-5
PAIR = GearPair(
    name="mesh",
    on="shaft_1:gear",
    against="shaft_2:gear",
    teeth=TEETH,
    module=4.5e-3,
    pressure_angle=math.radians(20.0),
    face_width=25e-3,
    stiffness=14e9,
    backlash=1e-4,
    damping=1e3,
    transmission_error=(5e-7,),
)


def shaft(number: int) -> Body:
    """A shaft d40 x 240 mm with its gear in the middle."""
    diameter = 4.5e-3 * TEETH[number - 1]
    return flexible_shaft(
        f"shaft_{number}",
        [Section(0.0, 240e-3, 40e-3)],
        [Disc(0.0, Inertia.cylinder(107.5e-3, 132.5e-3, diameter, 40e-3))],
        ["y", "z", "theta_x", "theta_y", "theta_z"],
        (number - 1) * CENTRE,
        {**SEATS, "gear": 120e-3},
        spin=1.0 if number == 1 else -TEETH[0] / TEETH[1],
        cutoff=12e3,
        damping_ratio=0.005,
    )


def housing(size: int = 60, mass: float = 12.0) -> Body:
    """Modes with random shapes, which have the size of a body of that mass."""
    rng = np.random.default_rng(3)
    omega = 2.0 * math.pi * np.geomspace(600.0, 12e3, size)
    frames = {}
    for name, place in (
        *((f"{side}_{k}", (x, 0.0, 0.0) + (k - 1) * CENTRE) for k in (1, 2) for side, x in SEATS.items()),
        ("top", (0.12, 0.05, 0.1)),
    ):
        shapes = rng.normal(size=(6, size)) / math.sqrt(mass)
        shapes[3:] *= 10.0  # a wave has about a tenth of a metre
        frames[name] = Frame(np.asarray(place, dtype=float), shapes)
    return Body(
        name="housing",
        coordinates=tuple(f"mode {k + 1}" for k in range(size)),
        units=("1",) * size,
        mass=np.eye(size),
        gyroscopic=np.zeros((size, size)),
        damping=np.diag(2.0 * 0.02 * omega),
        stiffness=np.diag(omega**2),
        frames=frames,
    )


def gearbox(law: Law | None, slices: int) -> System:
    """The surrogate."""
    bodies = [shaft(1), shaft(2), housing()]
    bearing = Bearing.named("NU308", clearance=20e-6).with_slices(slices)
    chosen = laws.hertz(bearing, 50.0) if law is None else law
    elements = [
        BearingElement(
            name=f"{side}_{k}",
            inner=f"shaft_{k}:{side}",
            outer=f"housing:{side}_{k}",
            bearing=bearing,
            force=BearingForce(bearing, chosen),
            temperature=TEMPERATURE,
            inner_spin=bodies[k - 1].spin,
        )
        for k in (1, 2)
        for side in SEATS
    ]
    places = [(k * CENTRE).tolist() for k in (0, 1)]
    mesh = gear_mesh(PAIR, *places, 1.0, bodies[1].spin)
    brake = Spring("brake", "shaft_2:right", "ground", np.diag([0.0, 0.0, 0.0, 2e4, 0.0, 0.0]))
    drive = Load("drive", "shaft_1:left", np.array([0.0, 0.0, 0.0, 82.0, 0.0, 0.0]))
    return System(bodies, [brake], [drive], [*elements, mesh])


def made(law: Law | None, slices: int, step: float, seconds: float) -> tuple[Recording, float, int]:
    """Run; recording, seconds of the processor for it, and the number of coordinates."""
    system = gearbox(law, slices)
    speed = SpeedProfile(Course((0.0, 5.0), (500.0 * RPM, 2500.0 * RPM)))
    start = equilibrium(system, Operation(500.0 * RPM)).displacement
    sensor = Sensor("top", "housing:top", np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]), "acceleration")
    begin = time.process_time()
    found = run(system, speed, seconds, Settings(step, SAMPLE), [sensor], start)
    return found, time.process_time() - begin, system.size


def period_error(step: float, frequency: float = 5e3, spectral_radius: float = 0.8) -> float:
    """By how much a period comes out longer, from the amplification of the free oscillation over a step."""
    method, omega = Method(spectral_radius), 2.0 * math.pi * frequency
    by_q, by_v = method.weights(step)
    rows = []
    for q, v, a, carried in np.eye(4):
        known = (method.alpha_f * a - method.alpha_m * carried) / (1.0 - method.alpha_m)
        q0 = q + step * v + step**2 * ((0.5 - method.beta) * carried + method.beta * known)
        v0 = v + step * ((1.0 - method.gamma) * carried + method.gamma * known)
        new = -(omega**2) * q0 / (1.0 + omega**2 * by_q)
        rows.append([q0 + by_q * new, v0 + by_v * new, new, known + method.ratio * new])
    values = np.linalg.eigvals(np.array(rows).T)
    angle = np.abs(np.angle(values[np.argmax(np.abs(values) * (np.abs(values.imag) > 1e-9))]))
    return float(omega * step / angle - 1.0)


def main() -> None:
    """Print the table."""
    law = ehdmaps.open_map(sys.argv[1]).law("series", "clamp") if len(sys.argv) > 1 else None
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 0.2
    made(law, 21, 3e-5, SAMPLE)  # compiles
    print(f"{gearbox(law, 21).size} coordinates, law {'hertz' if law is None else 'map'}, {seconds} s of 5 s")
    print(
        f"{'step us':>8} {'slices':>7} {'steps':>8} {'us a step':>10} {'Newton':>7} {'5 s take s':>11} "
        f"{'error':>9} {'of steps':>9} {'period at 5 kHz':>16}"
    )
    for step in (3e-5, 2e-5, 1.5e-5, 1e-5):
        found, spent, _ = made(law, 21, step, seconds)
        signals = [found.signals[:, 0]] + [
            made(law, slices, 0.5 * step, seconds)[0].signals[:, 0] for slices in (41, 21)
        ]
        late = slice(signals[0].size // 2, None)
        level = float(np.std(signals[1][late]))
        errors = [float(np.sqrt(np.mean((signals[0][late] - other[late]) ** 2))) / level for other in signals[1:]]
        print(
            f"{step * 1e6:8.1f} {21:7d} {found.steps:8d} {1e6 * spent / found.steps:10.1f} "
            f"{found.iterations / found.steps:7.2f} {spent / seconds * 5.0:11.1f} {errors[0]:9.2%} {errors[1]:9.2%} "
            f"{period_error(step):16.2%}"
        )


if __name__ == "__main__":
    main()

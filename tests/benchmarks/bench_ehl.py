"""How fast the Reynolds solver is, beside the error it makes; and against plain ways to solve the same equations.

Run: python -m tests.benchmarks.bench_ehl [--points N] [--beside TREE]

One process, one thread. Points are drawn along load lines of the NU308 map, as a sweep solves them. Errors are against
four times the default density of cells. The plain solvers get the same grid and the same start
(the interpolated coarse solution), and solve the fine grid's equations only: no linear response, no coarse grid, no
estimate. --beside TREE has `JOBS` solved in turn by another checkout of this project and by this one: ratio of
processor times, and the largest difference of any number from the largest of its kind.
"""

from __future__ import annotations

import argparse
import os
import pickle
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import fsolve
from threadpoolctl import threadpool_limits

from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.newton import newton
from ehdmaps.ehl.profile import Profile, refined
from ehdmaps.ehl.reynolds import FITTED_STEP, LineProblem, residual
from ehdmaps.ehl.solver import ReynoldsSolver, line_problem
from ehdmaps.ehl.ways import LOAD
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.isotherm import density as density_over_pressure
from ehdmaps.physics.isotherm import log_viscosity
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import contact_solution

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
OIL = Lubricant.named("FVA3")
DENSITIES = (4.5, 6.5, 10.0)


def numpy_residual(problem: LineProblem, profile: Profile, unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The equations of ehdmaps.ehl.reynolds once more, in plain numpy, with matrices instead of loops."""
    grid, kernel = profile.grid, profile.kernel
    n = grid.x.size - 1
    pressure = np.concatenate([[0.0], unknowns[: n - 1], [0.0]])
    p = np.maximum(pressure, 0.0)
    log_eta, slope = log_viscosity(problem.isotherm, p)
    slope = np.where(pressure >= 0.0, slope, 0.0)
    gap = unknowns[n + 1] + 0.5 * (unknowns[n] + grid.x) ** 2 - kernel @ pressure
    by_unknowns = np.column_stack([-kernel[:, 1:n], np.zeros(n + 1), unknowns[n] + grid.x, np.ones(n + 1)])
    rows, inner = np.arange(n), np.zeros((n + 1, n + 2))
    inner[np.arange(1, n), np.arange(n - 1)] = 1.0  # d pressure / d unknowns
    # cell flow: ln(eta/rho) is a parabola through both ends and the middle of a cell
    rho, rho_slope = density_over_pressure(problem.isotherm, p)
    halfway = np.maximum(0.5 * (pressure[1:] + pressure[:-1]), 0.0)
    middle_eta, middle_eta_slope = log_viscosity(problem.isotherm, halfway)
    middle_rho, middle_rho_slope = density_over_pressure(problem.isotherm, halfway)
    middle_slope = middle_eta_slope - middle_rho_slope / middle_rho
    rho_slope = np.where(pressure >= 0.0, rho_slope, 0.0)
    kinematic, slope = log_eta - np.log(rho), slope - rho_slope / rho
    d = np.clip(np.diff(kinematic), -300.0, 300.0)
    small = np.abs(d) < 1e-2
    safe = np.where(small, 1.0, d)
    phi = np.where(small, 1.0 - d / 2 + d * d / 6 - d**3 / 24, -np.expm1(-safe) / safe)
    dphi = np.where(small, -0.5 + d / 3 - d * d / 8, (np.exp(-safe) * (safe + 1.0) - 1.0) / safe**2)
    bend = 4.0 * (kinematic[1:] + kinematic[:-1]) - 8.0 * (middle_eta - np.log(middle_rho))
    even = np.abs(d) < 0.1
    size = np.where(even, 1.0, d)
    coth = 1.0 / np.tanh(0.5 * size)
    weight = np.where(even, 1.0 / 6.0 - d * d / 360.0 + d**4 / 15120.0, coth / size - 2.0 / size**2)
    by_d = np.where(even, -d / 180.0 + d**3 / 3780.0, 0.5 * (1.0 - coth**2) / size - coth / size**2 + 4.0 / size**3)
    mean, rise = np.exp(0.5 * bend * weight - kinematic[:-1]) * phi, np.diff(pressure)
    flow, by_step = mean * rise, dphi / phi + 0.5 * bend * by_d
    left = mean * ((2.0 * weight * (slope[:-1] - middle_slope) - slope[:-1] * (1.0 + by_step)) * rise - 1.0)
    right = mean * ((2.0 * weight * (slope[1:] - middle_slope) + slope[1:] * by_step) * rise + 1.0)
    by_flow = left[:, None] * inner[:-1] + right[:, None] * inner[1:]
    by_jump = slope[1:, None] * inner[1:] - slope[:-1, None] * inner[:-1]
    # fourth-order correction
    middle = np.minimum(rows, n - 2)
    middle[0] = 1
    curvature = flow[middle + 1] - 2.0 * flow[middle] + flow[middle - 1]
    by_curvature = by_flow[middle + 1] - 2.0 * by_flow[middle] + by_flow[middle - 1]
    jumps = d[middle - 1] ** 2 + d[middle] ** 2 + d[middle + 1] ** 2
    by_jumps = 2.0 * sum(d[middle + k][:, None] * by_jump[middle + k] for k in (-1, 0, 1))
    fade = 1.0 / (1.0 + jumps**2 / FITTED_STEP**4)
    fade[0] = 0.0
    gradient = flow - fade * curvature / 24.0
    by_gradient = by_flow - (fade[:, None] * by_curvature) / 24.0
    by_gradient += (curvature * fade**2 * 2.0 * jumps / FITTED_STEP**4 / 24.0)[:, None] * by_jumps
    # films at the faces
    central, upwind = np.zeros((n, n + 1)), np.zeros((n, n + 1))
    for f in range(n):
        if f == 0:
            central[f, :2] = upwind[f, :2] = 0.5
            continue
        upwind[f, max(f - 2, 0) : f + 2] = (-2, 12, 6) if f == 1 else (1, -5, 15, 5)
        upwind[f] /= 16.0
        if f == n - 1:
            central[f] = upwind[f]
        else:
            central[f, f - 1 : f + 3] = np.array([-1, 9, 9, -1]) / 16.0
    face = central @ gap
    conductance = face**3 / (problem.wedge * grid.face_step)
    flux = conductance * gradient
    mass = rho * gap
    by_mass = rho[:, None] * by_unknowns + (rho_slope * gap)[:, None] * inner
    out, jacobian = np.empty(n + 2), np.zeros((n + 2, n + 2))
    out[:n] = flux - upwind @ mass + unknowns[n - 1]
    jacobian[:n] = conductance[:, None] * by_gradient + (3.0 * flux / face)[:, None] * (central @ by_unknowns)
    jacobian[:n] -= upwind @ by_mass
    jacobian[:n, n - 1] += 1.0
    out[n], jacobian[n] = mass[n] - unknowns[n - 1], by_mass[n]
    jacobian[n, n - 1] -= 1.0
    out[n + 1], jacobian[n + 1, : n - 1] = grid.step[1:n] @ unknowns[: n - 1] - LOAD, grid.step[1:n]
    return out, jacobian


def numpy_newton(problem: LineProblem, profile: Profile, start: np.ndarray) -> np.ndarray:
    """Dense Newton with numpy only, no damping."""
    unknowns = start.copy()
    for _ in range(30):
        out, jacobian = numpy_residual(problem, profile, unknowns)
        step = np.linalg.solve(jacobian, -out)
        unknowns += step
        if np.max(np.abs(step)) < 1e-9:
            break
    return unknowns


def scipy_fsolve(problem: LineProblem, profile: Profile, start: np.ndarray) -> np.ndarray:
    """scipy.optimize.fsolve on the compiled residual, Jacobian by its own differences."""
    grid = profile.grid
    waste = np.empty((start.size, start.size))

    def equations(unknowns: np.ndarray) -> np.ndarray:
        out = np.empty(start.size)
        residual(problem, grid.x, grid.step, grid.face_step, profile.kernel, unknowns, LOAD, out, waste)
        return out

    return np.asarray(fsolve(equations, start, xtol=1e-9))


def lines(
    points: int,
    a_line: int = 25,
    loads: tuple[float, float] = (1e2, 1e6),
    speeds: tuple[float, float] = (0.05, 10.0),
    celsius: tuple[float, float] = (20.0, 120.0),
) -> list[tuple[tuple[float, ...], float, float]]:
    """Load lines of the NU308 map, so many that they hold about `points` points, or of a part of it."""
    rng = np.random.default_rng(3)
    count = max(1, round(points / a_line))
    line = tuple(float(w) for w in np.geomspace(*loads, a_line))
    low, high = np.log10(speeds)
    return [(line, float(10 ** rng.uniform(low, high)), float(273.15 + rng.uniform(*celsius))) for _ in range(count)]


JOBS: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "lines of the map": ({}, {}),
    "thin films": ({"loads": (3e4, 1e6), "speeds": (0.05, 0.3), "celsius": (80.0, 120.0)}, {}),
    "thick films": ({"loads": (1e2, 1e4), "speeds": (3.0, 10.0), "celsius": (20.0, 60.0)}, {}),
    "cold, high loads": ({"loads": (1e5, 1e6), "speeds": (0.3, 10.0), "celsius": (0.0, 20.0)}, {}),
    "5 loads a line": ({"a_line": 5}, {}),
    "100 loads a line": ({"a_line": 100}, {}),
    "limiting stress": ({}, {"shear": "limiting"}),
    "sliding": ({}, {"slide_to_roll": 0.1}),
}
"""Arguments of `lines` and settings of the solver, for --beside."""


def errors(solver: ReynoldsSolver, sample: list[tuple[tuple[float, ...], float, float]]) -> str:
    """Median and 95 % quantile of the error in k and c (of the contact) and film offset and film compliance."""
    fine = ReynoldsSolver(density=26.0)
    found = []
    for loads, speed, temperature in sample:
        pair = (s.solve_line(CONTACT, OIL, loads[::5], speed, temperature) for s in (solver, fine))
        for load, film, exact in zip(loads[::5], *pair, strict=True):
            point = OperatingPoint(load, speed, temperature)
            one, two = contact_solution(film, CONTACT, point), contact_solution(exact, CONTACT, point)
            found.append(
                [
                    abs(film.film_offset / exact.film_offset - 1.0),
                    abs(film.film_compliance / exact.film_compliance - 1.0),
                    abs(one.stiffness / two.stiffness - 1.0),
                    abs(one.damping / two.damping - 1.0),
                ]
            )
    table = np.array(found)
    table = table[np.all(np.isfinite(table), axis=1)]
    return "  ".join(
        f"{m:7.1e} {q:7.1e}" for m, q in zip(np.median(table, 0), np.quantile(table, 0.95, 0), strict=True)
    )


def _best(run: Callable[[], object]) -> float:
    """Shortest of three processor times [s]: shared machines are slow now and then, never fast."""
    times = []
    for _ in range(3):
        started = time.process_time()
        run()
        times.append(time.process_time() - started)
    return min(times)


def solve_in_turn(points: int) -> None:
    """Solve a job for each name in the input: its processor time [s] and its films, pickled, as answer."""
    for name in sys.stdin:
        where, settings = JOBS[name.strip()]
        sample, solver = lines(points, **where), ReynoldsSolver(**settings)
        begun = time.process_time()
        films = [film for line in sample for film in solver.solve_line(CONTACT, OIL, *line)]
        seconds = time.process_time() - begun
        numbers = [{k: v for k, v in vars(film).items() if isinstance(v, float)} for film in films]
        pickle.dump((seconds, numbers), sys.stdout.buffer)
        sys.stdout.buffer.flush()


def beside(tree: Path, points: int, rounds: int = 9) -> None:
    """Print how much longer another checkout takes for the same lines, and how far its numbers are."""
    runs: list[subprocess.Popen[bytes]] = []
    for place in (tree.resolve(), Path(__file__).parents[2]):
        environment = os.environ | {"PYTHONPATH": str(place), "OPENBLAS_NUM_THREADS": "1"}
        command = [sys.executable, "-P", __file__, "--points", str(points), "--in-turn"]
        runs.append(subprocess.Popen(command, cwd=place, env=environment, stdin=-1, stdout=-1))

    def asked(run: subprocess.Popen[bytes], name: str) -> tuple[float, list[dict[str, float]]]:
        assert run.stdin is not None and run.stdout is not None
        run.stdin.write(f"{name}\n".encode())
        run.stdin.flush()
        answer: tuple[float, list[dict[str, float]]] = pickle.load(run.stdout)
        return answer

    print(
        f"processor time of {points} points in another checkout and here, least and median ratio of {rounds} in turn;"
    )
    print("largest difference of a number and of a stated error, from the largest of its kind")
    print(f"{'':20s}  s there   s here   ratio   number    error")
    for name in JOBS:
        (_, there), (_, here) = (asked(run, name) for run in runs)  # compiled
        pairs = [tuple(asked(run, name)[0] for run in runs) for _ in range(rounds)]
        least = "   ".join(f"{min(times):6.3f}" for times in zip(*pairs, strict=True))
        ratio = statistics.median(one / other for one, other in pairs)
        apart = {False: 0.0, True: 0.0}
        for number in there[0].keys() - {"solve_seconds"}:
            one, other = (np.array([film[number] for film in films]) for films in (there, here))
            away = np.nanmax(np.abs(one - other), initial=0.0) / (np.nanmax(np.abs(one), initial=0.0) or 1.0)
            apart[number.endswith("error")] = max(apart[number.endswith("error")], float(away))
        print(f"{name:20s}   {least}  {ratio:6.2f}  {apart[False]:7.0e}  {apart[True]:7.0e}", flush=True)
    for run in runs:
        run.communicate()


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=300)
    parser.add_argument("--beside", type=Path, metavar="TREE", help="another checkout, in turn with this one")
    parser.add_argument("--in-turn", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.in_turn:
        solve_in_turn(arguments.points)
        return
    if arguments.beside is not None:
        beside(arguments.beside, arguments.points)
        return
    sample = lines(arguments.points)
    ReynoldsSolver().solve_line(CONTACT, OIL, (1e3, 1e4, 1e5), 1.0, 313.15)  # compile
    print("ehdmaps.ehl.solver.ReynoldsSolver: film, k, c, error estimates; one core")
    print("density  points/s   error, median and 95 %: film offset     film compliance   k                 c")
    rates: dict[float, float] = {}
    for density in DENSITIES:
        solver = ReynoldsSolver(density=density)
        count = sum(len(line[0]) for line in sample)
        rates[density] = count / _best(
            lambda solver=solver: [solver.solve_line(CONTACT, OIL, *line) for line in sample]
        )
        print(f"{density:7.1f}  {rates[density]:8.0f}                          {errors(solver, sample)}")
    print("\nfilm only, one fine grid, from the same coarse solution; time relative to ehdmaps' own Newton")
    starts = []
    for loads, speed, temperature in sample:
        for load in loads[::6]:
            problem, M, L = line_problem(CONTACT, OIL.at(temperature), load, speed)
            found = solve_groups(problem, M, L, Resolution())
            if found.profile is not None and found.rough is not None:
                starts.append((problem, found.profile, refined(found.rough, found.profile.grid)))
    starts = [s for s in starts if s[1].spike is None][:12] or starts[:12]

    def own(problem: LineProblem, profile: Profile, start: np.ndarray) -> np.ndarray:
        grid = profile.grid
        return newton(problem, grid.x, grid.step, grid.face_step, profile.kernel, start, LOAD, 1e-6, 60).unknowns

    solvers: dict[str, Callable[[LineProblem, Profile, np.ndarray], np.ndarray]] = {
        "ehdmaps": own,
        "numpy dense Newton": numpy_newton,
        "scipy fsolve": scipy_fsolve,
    }
    own_time = 0.0
    for name, solve in solvers.items():
        solve(*starts[0])
        results = [solve(*start) for start in starts]
        elapsed = _best(lambda solve=solve: [solve(*start) for start in starts]) / len(starts)
        own_time = own_time or elapsed
        worst = max(
            float(np.max(np.abs(r[-3:] - s[1].unknowns[-3:]) / np.abs(s[1].unknowns[-3:])))
            for r, s in zip(results, starts, strict=True)
        )
        print(f"{name:20s} {elapsed * 1e3:9.2f} ms  x{elapsed / own_time:8.1f}   distance to the solution {worst:.1e}")


if __name__ == "__main__":
    with threadpool_limits(1):
        main()

"""Errors of the Reynolds solver at steep pressure spikes, beside the errors that it states of itself.

Run: python -m tests.benchmarks.bench_spikes [--points N] [--seed S] [--density D]

Random points with M from 3 to 400 and L from 12 to 45, both logarithmic, of both catalogue oils and two oils of
Roelands' law at 20 to 120 degC, up to a Hertz pressure of 4 GPa. Film, compliance and damping are compared with four
times the default density of cells with its longer inlet; the column "references" is how far that reference is from one
with 2.8 times the density. The tip of a spike is 1e-5 half-widths wide and less: the largest pressure is compared with
grids whose cells at the spike are narrowed step by step to 1e-6 half-widths, at two densities; its column "references"
is the scatter of their last steps.
"""

from __future__ import annotations

import argparse
import math
import time
from typing import NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from ehdmaps.ehl.grid import Spike, lay_out
from ehdmaps.ehl.group_solution import GroupSolution
from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.newton import CONVERGED
from ehdmaps.ehl.profile import Profile, front, moved
from ehdmaps.ehl.reynolds import LineProblem
from ehdmaps.ehl.solver import line_problem
from ehdmaps.ehl.ways import LOOSE_TOLERANCE, converged
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import Structured, structured
from ehdmaps.physics.hertz import half_width, max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from tests.cases.moes import load_and_speed

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
OILS = (
    Lubricant.named("FVA3"),
    Lubricant.named("Spirax MA 80W"),
    Lubricant.roelands(viscosity=0.03, pressure_viscosity=12e-9, roelands_z=0.5, density=870.0),
    Lubricant.roelands(viscosity=0.12, pressure_viscosity=30e-9, roelands_z=0.7, density=870.0),
)
LOADS, OIL_NUMBERS = (3.0, 400.0), (12.0, 45.0)
HEAVIEST = 4e9
REFERENCE, SECOND_REFERENCE = Resolution(density=26.0), Resolution(density=18.0)
TIP_DENSITIES, TIP_INLET, TIP_WIDTH, TIP_RATIO, TIP_MOVES = (14.0, 20.0), 100.0, 1e-6, 3.0, 6
LAST_STEPS = 3
"""Steps of narrowing from which the largest pressure is taken."""

NAMES = ("film offset", "film compliance", "central film", "minimum film", "k", "c", "approach", "max pressure")


class Point(NamedTuple):
    """One point: its groups, load [N/m], speed [m/s] and Hertz pressure [Pa]."""

    problem: LineProblem
    M: float
    L: float
    load: float
    speed: float
    peak: float


def random_points(seed: int, count: int) -> list[Point]:
    """Points of the ranges above, log-uniform, without those above the heaviest Hertz pressure."""
    rng = np.random.default_rng(seed)
    points: list[Point] = []
    while len(points) < count:
        oil = OILS[int(rng.integers(len(OILS)))]
        state = oil.at(float(rng.uniform(293.15, 393.15)))
        M, L = (float(np.exp(rng.uniform(*np.log(limits)))) for limits in (LOADS, OIL_NUMBERS))
        alpha = state.pressure_viscosity.pressure_viscosity
        load, speed = load_and_speed(M, L, state.viscosity, alpha, CONTACT.radius, CONTACT.reduced_modulus)
        peak = float(max_pressure(load, CONTACT.radius, CONTACT.reduced_modulus))
        if peak <= HEAVIEST:
            points.append(Point(line_problem(CONTACT, state, load, speed)[0], M, L, load, speed, peak))
    return points


def in_contact(point: Point, found: GroupSolution) -> Structured[float]:
    """Approach, k and c of the whole contact."""
    half = float(half_width(point.load, CONTACT.radius, CONTACT.reduced_modulus))
    compliance = half / (point.peak * CONTACT.radius)
    return structured(
        CONTACT,
        point.load,
        found.film_offset * half * half / CONTACT.radius,
        found.film_compliance * compliance,
        found.loss * compliance * half / point.speed,
        found.film_compliance.error,
        found.loss.error,
    )


def values(point: Point, found: GroupSolution) -> np.ndarray:
    """All that is compared but for the largest pressure."""
    contact = in_contact(point, found)
    return np.array(
        [
            found.film_offset,
            found.film_compliance,
            found.central_film,
            found.minimum_film,
            contact.stiffness,
            contact.damping,
            contact.approach,
        ]
    )


def stated(point: Point, found: GroupSolution) -> np.ndarray:
    """Relative errors that the solution states of the same and of the largest pressure."""
    contact = in_contact(point, found)
    half = float(half_width(point.load, CONTACT.radius, CONTACT.reduced_modulus))
    offset = abs(found.film_offset.error * found.film_offset * half * half / CONTACT.radius)
    return np.array(
        [
            abs(found.film_offset.error),
            abs(found.film_compliance.error),
            found.central_film.error,
            found.minimum_film.error,
            contact.stiffness_error,
            contact.damping_error,
            offset / abs(contact.approach),
            found.max_pressure.error,
        ]
    )


def narrowed(profile: Profile, density: float, width: float) -> Profile | None:
    """The solution on a grid whose finest cells around the spike have another width."""
    layout = profile.layout
    for _ in range(TIP_MOVES):
        spike = Spike(front(profile)[0], width)
        layout = lay_out(layout.film, TIP_INLET, spike=spike)
        grid = layout.grid(math.ceil(0.5 * density * layout.span))
        start = moved(profile, grid, by_index=False)
        for tolerance in (LOOSE_TOLERANCE, Resolution().tolerance):
            trial, *_ = converged(profile.problem, layout, grid, start, spike, tolerance)
            if trial is None:
                return None
            profile, start = trial, trial.unknowns
        if abs(front(profile)[0] - spike.position) < 0.5 * width:
            break
    return profile


def tip_pressures(point: Point, density: float) -> list[float]:
    """Largest pressures [p_H] of the last steps, while the cells around the spike are narrowed."""
    coarse = solve_groups(point.problem, point.M, point.L, Resolution(density=density, inlet_length=TIP_INLET)).rough
    found: list[float] = []
    profile = coarse
    width = 0.0 if profile is None or profile.spike is None else profile.spike.width
    while profile is not None and width > TIP_WIDTH:
        found.append(float(np.max(profile.pressure)))
        width /= TIP_RATIO
        profile = narrowed(profile, density, width)
    return found[-LAST_STEPS:] if found or coarse is None else [float(np.max(coarse.pressure))]


def compare(points: list[Point], density: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """True errors, scatter of the references and stated errors, shape (points, names); points without a solution."""
    table, missing = [], 0
    for point in points:
        found, exact, second = (
            solve_groups(point.problem, point.M, point.L, resolution)
            for resolution in (Resolution(density=density), REFERENCE, SECOND_REFERENCE)
        )
        tips = [tip for each in TIP_DENSITIES for tip in tip_pressures(point, each)]
        if any(each.outcome != CONVERGED for each in (found, exact, second)) or not tips:
            missing += 1
            continue
        best, tip = values(point, exact), float(np.median(tips))
        true = np.append(np.abs(values(point, found) / best - 1.0), abs(found.max_pressure - tip) / found.max_pressure)
        scatter = np.append(np.abs(values(point, second) / best - 1.0), 0.5 * (max(tips) - min(tips)) / tip)
        table.append([true, scatter, stated(point, found)])
    true, scatter, said = np.moveaxis(np.array(table), 1, 0)
    return true, scatter, said, missing


def cost(points: list[Point], densities: tuple[float, ...]) -> None:
    """Print processor time a point, cold, and how many points have no solution."""
    for density in densities:
        started = time.process_time()
        found = [solve_groups(p.problem, p.M, p.L, Resolution(density=density)) for p in points]
        spent = (time.process_time() - started) / len(points)
        missing = sum(each.outcome != CONVERGED for each in found)
        print(f"density {density:4.1f}: {spent * 1e3:6.1f} ms a point, cold; without a solution {missing}")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=300)
    parser.add_argument("--seed", type=int, default=2)
    parser.add_argument("--density", type=float, default=Resolution().density)
    arguments = parser.parse_args()
    points = random_points(arguments.seed, arguments.points)
    true, scatter, said, missing = compare(points, arguments.density)
    print(
        f"{len(points)} points, seed {arguments.seed}, density {arguments.density:g}; "
        f"{missing} without a solution or a reference"
    )
    print("                  true error          references  stated over true   covered")
    print("                  median    95 %      95 %        median   least")
    ratio = said / np.maximum(true, 1e-300)
    for j, name in enumerate(NAMES):
        print(
            f"{name:<16s}  {np.median(true[:, j]):7.1e}  {np.quantile(true[:, j], 0.95):7.1e}   "
            f"{np.quantile(scatter[:, j], 0.95):7.1e}   {np.median(ratio[:, j]):6.1f}  {np.min(ratio[:, j]):8.3f}   "
            f"{100.0 * np.mean(ratio[:, j] >= 1.0):5.1f} %"
        )
    cost(points[:100], (6.5, 16.0, 26.0))


if __name__ == "__main__":
    with threadpool_limits(1):
        main()

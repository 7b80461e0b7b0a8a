"""Starved films of the Reynolds solver, and the rule of the contact law for contacts on an oil layer beside them.

Run: python -m tests.benchmarks.bench_supply_rule [--table]

Inner contact of NU308, FVA 3: 0.5 to 200 N/mm, 0.2 to 10 m/s, 20 to 100 degC, up to L = 30; at each point layers that
bring 0.99 to 0.1 of the flooded flow. The solver finds the place of the meniscus. With --table all points are printed:
film over r times the flooded film, and the other quantities over those of the flooded contact. Then the errors of the
rule (`ehdmaps.physics.oil_supply`, without the rounding of its corner at r = 1):

- film offset h = r h_flooded F(r);
- stiffness k at a given layer, the meniscus following: the slope of that film over the load, in series with the solids;
- damping c, the meniscus where it is: film compliance and loss compliance of the flooded film times those ratios of the
  rigid contact to the power of n = -d ln(h)/d ln(w), in series with the solids;
- rolling force.

The last lines are c by Grubin's inlet before the Hertz zone, cut off at the held meniscus, which no law has. The gap of
that inlet is h (1 + X^1.5), X in l = (h/kappa)^(2/3), kappa = 2 sqrt(2 b)/(3 R), and r^(4/3) = J(X)/J(inf) with
J = Int x^1.5/(1 + x^1.5)^3 dx. A heavier load moves the edge of the zone, at b, towards the meniscus, so that with
A = d ln r/d ln X

    s = (h/w) (n + A (b/(2 X l) - 1/6))/(1 + 2 A/3),        loss = s b/u + e r/(1 + 2 A/3),

e what the flooded loss has above its compliance times b/u: the edge that moves against the oil.
"""

from __future__ import annotations

import argparse
import math
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.integrate import cumulative_trapezoid
from threadpoolctl import threadpool_limits

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.solver import ReynoldsSolver, line_problem
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply, compliance_ratio, damping_ratio, film_ratio, rolling_ratio
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import FilmSolution

CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
OIL = Lubricant.named("FVA3")
SOLVER = ReynoldsSolver()
LOADS = (0.5e3, 2e3, 5e3, 20e3, 50e3, 200e3)
SPEEDS = (0.2, 1.0, 2.0, 10.0)
TEMPERATURES = (293.15, 333.15, 373.15)
RATIOS = (0.99, 0.9, 0.75, 0.5, 0.25, 0.1)
LARGEST_OIL_NUMBER = 30.0
STEP = 0.01
"""Step of the load for the slope of the rule's film, relative."""

REGIMES = (("M < 0.3", 0.0, 0.3), ("M 0.3 to 3", 0.3, 3.0), ("M > 3", 3.0, math.inf))
NAMES = ("film", "k", "c", "rolling force")


class Row(NamedTuple):
    """One point: Moes' M and L, ratios of the solver and of the rule to the flooded contact, and what else is shown."""

    point: OperatingPoint
    M: float
    L: float
    ratio: float
    meniscus: float
    solved: tuple[float, ...]
    ruled: tuple[float, ...]
    compliance: float
    loss: float
    loaded: float


def main() -> None:
    """Print the table, if asked for, and the errors."""
    parser = argparse.ArgumentParser(description="Rule for contacts on an oil layer beside the Reynolds solver.")
    parser.add_argument("--table", action="store_true", help="print all points")
    table = parser.parse_args().table
    with threadpool_limits(1):
        rows, missing = solve_all()
    if table:
        print(f"{'N/mm':>6} {'m/s':>5} {'degC':>5} {'M':>8} {'L':>5} {'r':>5} {'meniscus':>9}", end="")
        print("".join(f"{name:>9} {'rule':>7}" for name in ("h/r", "k", "c", "force")) + f"{'s':>9} {'b':>8}")
        for row in rows:
            print(line_of(row))
    print(f"{len(rows)} starved points, {missing} without a solution")
    print(f"{'error of the rule [%]':22s}" + "".join(f"{name:>26s}" for name in NAMES))
    print(f"{'':22s}" + f"{'median':>12s}{'95 %':>7s}{'worst':>7s}" * len(NAMES))
    for r_name, chosen in (("r >= 0.5", lambda row: row.ratio >= 0.5), ("all r", lambda _: True)):
        for name, low, high in REGIMES:
            print(f"{name + ', ' + r_name:22s}" + errors([row for row in rows if low <= row.M < high and chosen(row)]))

    print(f"{'c by a loaded inlet [%]':24s}{'median':>10s}{'95 %':>7s}{'worst':>7s}{'mean':>9s}")
    for r_name, least in (("r >= 0.5", 0.5), ("all r", 0.0)):
        chosen_rows = [row for row in rows if REGIMES[-1][1] <= row.M and row.ratio >= least]
        error = 100.0 * np.array([row.loaded / row.solved[2] - 1.0 for row in chosen_rows])
        size = np.abs(error)
        numbers = f"{np.median(size):10.1f}{np.quantile(size, 0.95):7.1f}{size.max():7.1f}{error.mean():+9.1f}"
        print(f"{f'M > 3, {r_name}':24s}{numbers}")


def line_of(row: Row) -> str:
    """One point as printed: film over r times the flooded film; k, c, force, film and loss compliance over flooded."""
    first = f"{row.point.load / 1e3:6g} {row.point.entrainment_speed:5g} {row.point.temperature - 273.15:5.0f}"
    pairs = list(zip(row.solved, row.ruled, strict=True))
    pairs[0] = (pairs[0][0] / row.ratio, pairs[0][1] / row.ratio)
    values = "".join(f"{a:9.4f} {b:7.4f}" for a, b in pairs)
    place = f"{1e6 * row.meniscus:7.1f}um"
    return f"{first} {row.M:8.4g} {row.L:5.1f} {row.ratio:5g} {place}{values}{row.compliance:9.3f} {row.loss:8.3f}"


def errors(rows: list[Row]) -> str:
    """Median, 95 % quantile and worst relative error of the rule, each quantity."""
    found = np.abs(np.array([row.ruled for row in rows]) / np.array([row.solved for row in rows]) - 1.0)
    cells = (np.median(found, axis=0), np.quantile(found, 0.95, axis=0), np.max(found, axis=0))
    return "".join(f"{100 * a:12.1f}{100 * b:7.1f}{100 * c:7.1f}" for a, b, c in zip(*cells, strict=True))


def solve_all() -> tuple[list[Row], int]:
    """All starved points, and the number of those without a solution."""
    rows: list[Row] = []
    missing = 0
    for temperature in TEMPERATURES:
        state = OIL.at(temperature)
        for speed in SPEEDS:
            for load in LOADS:
                _, M, L = line_problem(CONTACT, state, load, speed)
                if L > LARGEST_OIL_NUMBER:
                    continue
                near = (load, (1.0 - STEP) * load, (1.0 + STEP) * load)
                flooded = [SOLVER.solve_line(CONTACT, OIL, (weight,), speed, temperature)[0] for weight in near]
                if not all(film.status.usable for film in flooded):
                    missing += len(RATIOS)
                    continue
                point = OperatingPoint(load, speed, temperature)
                for ratio in RATIOS:
                    layer = ratio * flooded[0].mass_flow / (state.density * speed)
                    row = compared(point, M, L, ratio, OilSupply(layer), flooded)
                    missing += row is None
                    rows += [] if row is None else [row]
    return rows, missing


def compared(
    point: OperatingPoint, M: float, L: float, ratio: float, supply: OilSupply, flooded: list[FilmSolution]
) -> Row | None:
    """One layer; `flooded` are the films at the load, and at a little less and more."""
    found = SOLVER.supplied_film(CONTACT, OIL, point, supply)
    film, full = found.film, flooded[0]
    if not film.status.usable:
        return None
    dry = float(CONTACT.structural_compliance(point.load))
    damping = film.loss_compliance / (dry + film.film_compliance) ** 2
    full_damping = full.loss_compliance / (dry + full.film_compliance) ** 2
    full_stiffness = 1.0 / (dry + full.film_compliance)
    root = np.array(math.sqrt(ratio))
    heights = [
        part * near.film_offset * float(film_ratio(np.array(math.sqrt(part)))[0])
        for near in flooded
        for part in [min(1.0, ratio * full.mass_flow / near.mass_flow)]
    ]
    slope = (heights[1] - heights[2]) / (2.0 * STEP * point.load)
    return Row(
        point,
        M,
        L,
        ratio,
        found.meniscus,
        (
            film.film_offset / full.film_offset,
            1.0 / (dry + found.supplied_compliance) / full_stiffness,
            damping / full_damping,
            film.rolling_force / full.rolling_force,
        ),
        (
            heights[0] / full.film_offset,
            1.0 / (dry + slope) / full_stiffness,
            held_damping(full, dry, point.load, root) / full_damping,
            float(rolling_ratio(root, flow_exponent(flooded, point.load))),
        ),
        film.film_compliance / full.film_compliance,
        film.loss_compliance / full.loss_compliance,
        loaded_damping(full, dry, point, supply.oil_layer, ratio) / full_damping,
    )


def flow_exponent(flooded: list[FilmSolution], load: float) -> float:
    """-d ln(m)/d ln(w) of the flooded contact, 0 to 1; of its films at a load, a little less, and more."""
    _, less, more = flooded
    return min(max(math.log(less.mass_flow / more.mass_flow) / math.log((1.0 + STEP) / (1.0 - STEP)), 0.0), 1.0)


@cache
def inlet() -> tuple[FloatArray, FloatArray, FloatArray]:
    """X of a meniscus before Grubin's inlet, rising, the flow ratio r there, and d ln r/d ln X."""
    t = np.concatenate((np.linspace(0.0, 2.0, 4001)[1:-1], np.geomspace(2.0, 1e4, 8001)))  # X = t^2
    part = cumulative_trapezoid(2.0 * t**4 / (1.0 + t**3) ** 3, t, initial=0.0) + 0.4 * t[0] ** 5
    ratio = (part / part[-1]) ** 0.75
    return t**2, ratio, np.gradient(np.log(ratio), np.log(t**2))


def loaded_damping(flooded: FilmSolution, dry: float, point: OperatingPoint, layer: float, ratio: float) -> float:
    """c of film and solids by Grubin's inlet, cut off at a meniscus that is held; `layer` is that of the oil [m]."""
    places, ratios, slopes = inlet()
    place, steep = float(np.interp(ratio, ratios, places)), float(np.interp(ratio, ratios, slopes))
    half = float(half_width(point.load, CONTACT.radius, CONTACT.reduced_modulus))
    length = (1.5 * layer * CONTACT.radius / math.sqrt(2.0 * half)) ** (2.0 / 3.0)
    exponent = flooded.film_compliance * point.load / flooded.film_offset
    time, held = half / point.entrainment_speed, 1.0 + 2.0 * steep / 3.0
    falls = (exponent + steep * (0.5 * half / (place * length) - 1.0 / 6.0)) / held
    compliance = ratio * flooded.film_offset / point.load * falls
    edge = flooded.loss_compliance - flooded.film_compliance * time
    return (compliance * time + edge * ratio / held) / (dry + compliance) ** 2


def held_damping(flooded: FilmSolution, dry: float, load: float, root: FloatArray) -> float:
    """c of film and solids by the rule, the meniscus held; `root` is sqrt(r)."""
    exponent = min(max(flooded.film_compliance * load / flooded.film_offset, 0.0), 1.0)
    softer = float(compliance_ratio(root) * root**2)
    loss = float(damping_ratio(root) / root**1.5) * softer**2
    return flooded.loss_compliance * loss**exponent / (dry + flooded.film_compliance * softer**exponent) ** 2


if __name__ == "__main__":
    main()

"""Starved films of the Reynolds solver, and the rule of the contact law for contacts on an oil layer beside them.

Run: python -m tests.benchmarks.bench_supply_rule [--table]

Inner contact of NU308, FVA 3: 0.5 to 200 N/mm, 0.2 to 10 m/s, 20 to 100 degC, up to L = 30; at each point layers that
bring 0.99 to 0.1 of the flooded flow. The solver finds the place of the meniscus. With --table all points are printed:
film over r times the flooded film, and the other quantities over those of the flooded contact. Then the errors of the
rule (`ehdmaps.physics.oil_supply`, without the rounding of its corner at r = 1):

- film offset h = r h_flooded F(r);
- stiffness k at a given layer, the meniscus following: the slope of that film over the load, in series with the solids;
- damping c, the meniscus where it is: film compliance and loss compliance of the flooded film times those ratios of the
  rigid contact to the power of n = -d ln(h)/d ln(w), with those by the edge of a loaded contact, in series with the
  solids;
- rolling force.

`--other` takes another bearing, contact, oil, and other points: the outer contact of N1014, 200 mPa s at 40 degC after
Roelands, 0.3 to 300 N/mm, 0.1 to 3 m/s. Nothing was chosen by them.
"""

from __future__ import annotations

import argparse
import math
from typing import NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.solver import ReynoldsSolver, line_problem
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import (
    OilSupply,
    compliance_ratio,
    damping_ratio,
    edge_compliance,
    film_ratio,
    rolling_ratio,
)
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import FilmSolution

SOLVER = ReynoldsSolver()


class Places(NamedTuple):
    """Points: a contact, an oil, loads [N/m], speeds [m/s], temperatures [K], and parts of the flooded flow."""

    contact: LineContact
    oil: Lubricant
    loads: tuple[float, ...]
    speeds: tuple[float, ...]
    temperatures: tuple[float, ...]
    ratios: tuple[float, ...]


USUAL = Places(
    BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0],
    Lubricant.named("FVA3"),
    (0.5e3, 2e3, 5e3, 20e3, 50e3, 200e3),
    (0.2, 1.0, 2.0, 10.0),
    (293.15, 333.15, 373.15),
    (0.99, 0.9, 0.75, 0.5, 0.25, 0.1),
)
OTHER = Places(
    BearingGeometry.named("N1014").contacts(STEEL, "iso16281")[1],
    Lubricant.roelands(viscosity=0.2, pressure_viscosity=2.2e-8, roelands_z=0.67, density=880.0),
    (0.3e3, 1e3, 3e3, 10e3, 30e3, 100e3, 300e3),
    (0.1, 0.5, 3.0),
    (313.15,),
    (0.95, 0.8, 0.6, 0.4, 0.2),
)
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


def main() -> None:
    """Print the table, if asked for, and the errors."""
    parser = argparse.ArgumentParser(description="Rule for contacts on an oil layer beside the Reynolds solver.")
    parser.add_argument("--table", action="store_true", help="print all points")
    parser.add_argument("--other", action="store_true", help="other points, of another bearing and oil")
    given = parser.parse_args()
    table = given.table
    with threadpool_limits(1):
        rows, missing = solve_all(OTHER if given.other else USUAL)
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


def solve_all(places: Places) -> tuple[list[Row], int]:
    """All starved points, and the number of those without a solution."""
    rows: list[Row] = []
    missing = 0
    for temperature in places.temperatures:
        state = places.oil.at(temperature)
        for speed in places.speeds:
            for load in places.loads:
                _, M, L = line_problem(places.contact, state, load, speed)
                if L > LARGEST_OIL_NUMBER:
                    continue
                near = (load, (1.0 - STEP) * load, (1.0 + STEP) * load)
                flooded = [
                    SOLVER.solve_line(places.contact, places.oil, (weight,), speed, temperature)[0] for weight in near
                ]
                if not all(film.status.usable for film in flooded):
                    missing += len(places.ratios)
                    continue
                point = OperatingPoint(load, speed, temperature)
                for ratio in places.ratios:
                    layer = ratio * flooded[0].mass_flow / (state.density * speed)
                    row = compared(places, point, M, L, ratio, OilSupply(layer), flooded)
                    missing += row is None
                    rows += [] if row is None else [row]
    return rows, missing


def compared(
    places: Places,
    point: OperatingPoint,
    M: float,
    L: float,
    ratio: float,
    supply: OilSupply,
    flooded: list[FilmSolution],
) -> Row | None:
    """One layer; `flooded` are the films at the load, and at a little less and more."""
    found = SOLVER.supplied_film(places.contact, places.oil, point, supply)
    film, full = found.film, flooded[0]
    if not film.status.usable:
        return None
    dry = float(places.contact.structural_compliance(point.load))
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
            held_damping(places.contact, full, point, heights[0], root) / full_damping,
            float(rolling_ratio(root, flow_exponent(flooded, point.load))),
        ),
        film.film_compliance / full.film_compliance,
        film.loss_compliance / full.loss_compliance,
    )


def flow_exponent(flooded: list[FilmSolution], load: float) -> float:
    """-d ln(m)/d ln(w) of the flooded contact, 0 to 1; of its films at a load, a little less, and more."""
    _, less, more = flooded
    return min(max(math.log(less.mass_flow / more.mass_flow) / math.log((1.0 + STEP) / (1.0 - STEP)), 0.0), 1.0)


def held_damping(
    contact: LineContact, flooded: FilmSolution, point: OperatingPoint, film: float, root: FloatArray
) -> float:
    """c of film and solids by the rule, the meniscus held; `root` is sqrt(r), `film` the one on the layer [m]."""
    exponent = min(max(flooded.film_compliance * point.load / flooded.film_offset, 0.0), 1.0)
    half = np.asarray(half_width(point.load, contact.radius, contact.reduced_modulus))
    edge = float(edge_compliance(root, np.array(exponent), np.array(film), np.array(point.load), half, contact.radius))
    softer = float(compliance_ratio(root) * root**2)
    loss = flooded.loss_compliance * (float(damping_ratio(root) / root**1.5) * softer**2) ** exponent
    loss += edge * float(half) / point.entrainment_speed
    dry = float(contact.structural_compliance(point.load))
    return float(loss / (dry + flooded.film_compliance * softer**exponent + edge) ** 2)


if __name__ == "__main__":
    main()

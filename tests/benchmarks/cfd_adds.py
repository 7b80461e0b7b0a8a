"""What the CFD of the film adds to the Reynolds equation, over load and speed: all stresses, inertia, temperatures.

Run: python -m tests.benchmarks.cfd_adds [--parts stress inertia heat] [--plot FIG.png]

Points are a grid over loads and speeds of the shipped map nu308, inner contact, at some temperatures. Differences are
of the central film, and of k and c of the whole contact.

stress: flow full_stress beside thin_film, on the same columns and rows, Newtonian and isothermal. Films above 1 % of
the radius, whose gap is no parabola, are counted and not compared.

inertia: `tests.cases.inertia`, to first order; its force from the fields of full_stress beside it, and simpleFoam,
which carries momentum, in rigid gaps of the same Re*.

heat: thin_film with temperatures across the film beside its own film without, with a limiting stress. Beside it the
rule of heat in the inlet (`physics = "inlet-heat"`), and `reynolds` with temperatures.

It takes some five minutes of processor time.
"""

from __future__ import annotations

import argparse
import math
import tempfile
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ehdmaps.ehl.start import reynolds_start
from ehdmaps.figures import WARNING, typeset
from ehdmaps.openfoam.installation import installation
from ehdmaps.openfoam.solver import LEAST_LENGTHS, LONGEST_INLET, OpenFoamSolver
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.closed_form import THIN_FILM_LIMIT
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import Status
from tests.cases.inertia import RigidGap, force_of_fields, inertia
from tests.cases.openfoam_points import OIL
from tests.cases.physics_ways import SOLVERS, Answer, answer, solver_of

PARTS = ("stress", "inertia", "heat")
CONTACT = BearingGeometry.named("NU308").contacts(STEEL, "iso16281")[0]
LOADS = tuple(np.geomspace(1e2, 1e6, 6).tolist())
SPEEDS = tuple(np.geomspace(0.05, 10.0, 5).tolist())
TEMPERATURES, HEATED = (20.0, 70.0, 120.0), (20.0, 70.0)
FAST = SPEEDS[-2:]
"""Speeds at which inertia is shown; it falls with the square of the speed and faster."""

LOAD_STEP = 1.02
"""Ratio of loads from which the film compliance that inertia adds is taken."""

LARGE = ((1e2, 0.70710678, 20.0), (630.95734, 0.18803015, 20.0), (25118.864, 10.0, 70.0))
CELLS = ((400, 6), (800, 6), (400, 12))
"""Loads [N/m], speeds [m/s] and temperatures [degC] where all stresses count most, and grids: is it the grid?"""

FIELDS = ((25118.864, 10.0, 20.0), (25118.864, 10.0, 70.0), (3981.0717, 10.0, 70.0), (630.95734, 10.0, 70.0))
RIGID = ((1e2, 10.0, 120.0), (1e2, 2.6591479, 120.0), (630.95734, 10.0, 70.0), (630.95734, 10.0, 20.0))
"""Loads [N/m], speeds [m/s] and temperatures [degC] for the fields of the CFD, and of films as of rigid surfaces."""

GAP_CELLS = (200, 24)
"""Cells along and across the gaps of simpleFoam."""


def point_of(load: float, speed: float, celsius: float) -> OperatingPoint:
    """An operating point of a temperature in degC."""
    return OperatingPoint(load, speed, celsius + 273.15)


def grid(celsius: float) -> list[OperatingPoint]:
    """All loads and speeds at a temperature, the speeds of a load together."""
    return [point_of(load, speed, celsius) for load in LOADS for speed in SPEEDS]


def where(point: OperatingPoint) -> str:
    """Load and speed of a point in words."""
    return f"{point.load / 1e3:.4g} N/mm {point.entrainment_speed:.3g} m/s"


def all_of(point: OperatingPoint) -> str:
    """Load, speed and temperature of a point in words."""
    return f"{where(point)} {point.temperature - 273.15:.0f} degC"


@dataclass(frozen=True)
class Difference:
    """Relative differences of central film, k and c of one answer from another at a point; NaN where one has none."""

    point: OperatingPoint
    film: float = math.nan
    k: float = math.nan
    c: float = math.nan

    @classmethod
    def between(cls, point: OperatingPoint, mine: Answer, other: Answer) -> Difference:
        """Of two answers with solutions."""
        if not (mine.usable and other.usable):
            return cls(point)
        assert mine.film is not None and other.film is not None
        k, its_k = (each.stiffness(CONTACT, point.load) for each in (mine, other))
        c, its_c = (each.damping(CONTACT, point.load) for each in (mine, other))
        return cls(
            point, mine.film.central_film / other.film.central_film - 1.0, k / its_k - 1.0, (c - its_c) / abs(its_c)
        )


def spread(found: Iterable[Difference], name: str) -> str:
    """Median and largest size of a difference [%], and where the largest is."""
    sizes = [(abs(getattr(each, name)), each.point) for each in found if not math.isnan(getattr(each, name))]
    if not sizes:
        return f"{'-':>15}{'':<22}"
    largest, point = max(sizes, key=lambda each: each[0])
    return f"{100 * float(np.median([size for size, _ in sizes])):7.3f} {100 * largest:7.3f} {where(point):<22}"


def main() -> None:
    """Print the tables, and draw."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS)
    parser.add_argument("--plot", type=Path, metavar="FIG.png", help="maps of the differences over load and speed")
    options = parser.parse_args()
    installation()  # what is missing is said before anything is solved
    print(
        f"NU308 inner, FVA 3: {len(LOADS)} loads of {LOADS[0] / 1e3:g} to {LOADS[-1] / 1e3:g} N/mm, "
        f"{len(SPEEDS)} speeds of {SPEEDS[0]:g} to {SPEEDS[-1]:g} m/s"
    )
    panels: list[tuple[str, Sequence[float]]] = []
    for name, part in (("stress", stress), ("inertia", of_inertia), ("heat", heat)):
        if name in options.parts:
            panels += part()
    if options.plot:
        draw(panels, options.plot)


def stress() -> Iterator[tuple[str, list[float]]]:
    """Table of all stresses beside those of a thin film; yields panels of the figure."""
    thin, full = (solver_of(flow, "newtonian") for flow in ("thin_film", "full_stress"))
    print(f"\n{'all stresses less thin film, %':<32}{'film: median, largest':<39}{'k':<39}c")
    for celsius in TEMPERATURES:
        found, causes, thick = [], Counter[str](), 0
        for point in grid(celsius):
            its, mine = (answer(solver, CONTACT, OIL, point) for solver in (thin, full))
            found.append(Difference.between(point, mine, its))
            if not mine.usable:
                causes[cause(mine, its)] += 1
            elif mine.film is not None and mine.film.status is Status.ASYMPTOTE:
                thick += 1
                found[-1] = Difference(point)
        compared = sum(not math.isnan(each.film) for each in found)
        print(
            f"{f'{celsius:g} degC, {compared} of {len(found)} points':<32}"
            + " ".join(spread(found, name) for name in ("film", "k", "c")).rstrip()
        )
        causes["film above 1 % of the radius"] += thick
        print("    others: " + ", ".join(f"{count} {word}" for word, count in causes.most_common() if count))
        if celsius == TEMPERATURES[0]:
            yield f"c: all stresses less thin film, %, {celsius:g} degC", [each.c for each in found]
    print(f"\n{'film and c on finer grids, %':<32}" + "".join(f"{f'{cells[0]} x {cells[1]}':>18}" for cells in CELLS))
    for place in LARGE:
        cells = [on_cells(point_of(*place), *each) for each in CELLS]
        texts = [f"{100 * each.film:+.3f} {100 * each.c:+.3f}" for each in cells]
        print(f"{all_of(cells[0].point):<32}" + "".join(f"{text:>18}" for text in texts), flush=True)


def on_cells(point: OperatingPoint, columns: int, rows: int) -> Difference:
    """All stresses beside a thin film on so many cells."""
    thin, full = (
        answer(solver_of(flow, "newtonian", columns=columns, rows=rows), CONTACT, OIL, point)
        for flow in ("thin_film", "full_stress")
    )
    return Difference.between(point, full, thin)


def cause(full: Answer, thin: Answer) -> str:
    """Why there is no solution with all stresses."""
    assert full.film is not None
    if not thin.usable:
        return "by neither flow"
    if "wall stress" in full.film.reason:
        return "spike too steep for a Newtonian oil"
    return "film above 1 % of the radius" if "of the radius" in full.film.reason else "stagnated"


def of_inertia() -> Iterator[tuple[str, list[float]]]:
    """Tables of inertia; yields panels of the figure."""
    whole = LONGEST_INLET * CONTACT.radius
    shown = [(celsius, speed) for celsius in TEMPERATURES for speed in FAST]
    films, numbers, slow, changes = {}, [], [], []
    for celsius in TEMPERATURES:
        for point in grid(celsius):
            drowned = inertia(CONTACT, OIL, point, whole)
            if drowned is None or drowned.central_film > THIN_FILM_LIMIT * CONTACT.radius:
                continue
            short = inertia(CONTACT, OIL, point, min(whole, short_inlet(drowned.central_film)))
            assert short is not None
            films[point] = (drowned.film, short.film)
            numbers.append((drowned.reynolds, point))
            if point.entrainment_speed < FAST[0]:
                slow.append(Difference(point, film=drowned.film))
            else:
                changes.append(Difference(point, k=stiffening(point, whole)))
    print(
        "\nfilm by inertia, %, of the oil within half a radius (within three lengths sqrt(2 h R), where that is less)"
    )
    print(
        f"{'N/mm':>8}" + "".join(f"{f'{celsius:g} degC {speed:.3g} m/s':>19}" for celsius, speed in shown) + "   k, %"
    )
    for load in LOADS:
        cells = [films.get(point_of(load, speed, celsius)) for celsius, speed in shown]
        texts = ["-" if cell is None else f"{100 * cell[0]:+.2f} ({100 * cell[1]:+.2f})" for cell in cells]
        stiffer = max(abs(each.k) for each in changes if each.point.load == load)
        print(f"{load / 1e3:8.4g}" + "".join(f"{text:>19}" for text in texts) + f"{100 * stiffer:7.2f}")
    largest, at = max(numbers, key=lambda each: each[0])
    print(f"largest Re*: {largest:.2g} at {where(at)} {at.temperature - 273.15:.0f} degC; k: the largest of a row")
    print(f"film at {SPEEDS[-3]:.2g} m/s and below, %: median, largest {spread(slow, 'film')}".rstrip())
    print(f"\n{'film, %, by the force':<32}{'in closed form':>18}{'of the fields of full_stress':>32}")
    for place in FIELDS:
        print(fields_row(point_of(*place)), flush=True)
    print(f"\n{'load of a rigid, isoviscous gap, %':<36}{'Re*':>6}{'inlet':>16}{'first order':>14}{'simpleFoam':>13}")
    for place in RIGID:
        point = point_of(*place)
        found = inertia(CONTACT, OIL, point, whole)
        assert found is not None
        for inlet in (whole, short_inlet(found.central_film)):
            if inlet <= whole:
                print(rigid_row(point, found.central_film, inlet), flush=True)
    yield (
        f"film: inertia, inlet of R/2, %, {TEMPERATURES[1]:g} degC",
        [films.get(point, (math.nan,))[0] for point in grid(TEMPERATURES[1])],
    )


def short_inlet(film: float) -> float:
    """The shortest inlet of full_stress [m]."""
    return LEAST_LENGTHS * math.sqrt(2.0 * film * CONTACT.radius)


def stiffening(point: OperatingPoint, inlet: float) -> float:
    """Relative change of k by inertia, from the slope of the film offset that it adds; NaN where there is no film."""
    loads = point.load / LOAD_STEP, point.load * LOAD_STEP
    near = [
        inertia(CONTACT, OIL, OperatingPoint(load, point.entrainment_speed, point.temperature), inlet) for load in loads
    ]
    base = answer(solver_of("reynolds", "newtonian"), CONTACT, OIL, point)
    if not base.usable or near[0] is None or near[1] is None:
        return math.nan
    added = -(near[1].offset - near[0].offset) / (loads[1] - loads[0])
    return -added * base.stiffness(CONTACT, point.load)


def fields_row(point: OperatingPoint) -> str:
    """Film by inertia whose force comes from the film, and from the fields of the CFD."""
    _, solved = OpenFoamSolver(flow="full_stress", starter=reynolds_start).solve_fields(CONTACT, OIL, point, True)
    assert solved is not None and solved.fields is not None
    force = force_of_fields(solved.fields, solved.film.x.size)
    closed, own = (inertia(CONTACT, OIL, point, -float(force[0][0]), each) for each in (None, force))
    assert closed is not None and own is not None
    return f"{all_of(point):<32}{100 * closed.film:+18.3f}{100 * own.film:+32.3f}"


def rigid_row(point: OperatingPoint, film: float, inlet: float) -> str:
    """Load of a gap as thick as a film, to first order and by simpleFoam."""
    state = OIL.at(point.temperature)
    gap = RigidGap(film, CONTACT.radius, inlet, state.density, state.viscosity, point.entrainment_speed)
    with tempfile.TemporaryDirectory() as folder:
        measured = gap.by_simple_foam(Path(folder), *GAP_CELLS)
    lengths = f"{inlet / math.sqrt(2.0 * film * CONTACT.radius):.1f} lengths"
    return f"{all_of(point):<36}{gap.reynolds:6.3f}{lengths:>16}{100 * gap.first_order():+14.2f}{100 * measured:+13.2f}"


def heat() -> Iterator[tuple[str, list[float]]]:
    """Table of films with temperatures; yields panels of the figure."""
    cold, warm = (solver_of("thin_film", way) for way in ("limiting", "thermal, limiting"))
    rule, temperatures = (
        SOLVERS["reynolds"](physics="inlet-heat", shear="limiting"),
        solver_of("reynolds", "thermal, limiting"),
    )
    print(f"\n{'heat, %: film':<36}{'median, largest':<40}k")
    for celsius in HEATED:
        taken, by_rule, beside, silent, rises = [], [], [], [], []
        for point in grid(celsius):
            base, mine, closed, other = (answer(each, CONTACT, OIL, point) for each in (cold, warm, rule, temperatures))
            taken.append(Difference.between(point, mine, base))
            by_rule.append(Difference.between(point, closed, mine))
            beside.append(Difference.between(point, other, mine))
            if mine.usable and mine.film is not None:
                rises.append((mine.film.film_temperature - point.temperature, point))
                if not closed.usable:
                    silent.append(taken[-1])
        solved = len(rises)
        for name, differences in (
            (f"{celsius:g} degC, taken by heat, {solved} of {len(taken)}", taken),
            (f"    where the rule is silent, {len(silent)}", silent),
            (f"    rule of the inlet beside it, {count(by_rule)}", by_rule),
            (f"    reynolds beside it, {count(beside)}", beside),
        ):
            print(f"{name:<36}" + " ".join(spread(differences, each) for each in ("film", "k")).rstrip())
        hottest, at = max(rises, key=lambda each: each[0])
        print(f"    hottest: {hottest:.0f} K above the surfaces far away, at {where(at)}")
        if celsius == HEATED[0]:
            yield f"film: temperatures less none, %, {celsius:g} degC", [each.film for each in taken]
            yield f"film: rule of the inlet less temperatures, %, {celsius:g} degC", [each.film for each in by_rule]


def count(found: Iterable[Difference]) -> int:
    """Of so many points both have a film."""
    return sum(not math.isnan(each.film) for each in found)


def draw(panels: Sequence[tuple[str, Sequence[float]]], path: Path) -> None:
    """Each panel a table over load and speed, coloured by the size of the difference; grey where there is none."""
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot
    from matplotlib.colors import LinearSegmentedColormap, LogNorm

    colours = LinearSegmentedColormap.from_list("sizes", ["white", WARNING])
    colours.set_bad("0.85")
    colours.set_under("white")
    figure, axes = pyplot.subplots(
        math.ceil(len(panels) / 2), 2, figsize=(9.0, 1.3 + 1.45 * len(panels)), layout="constrained", squeeze=False
    )
    for axis, (title, values) in zip(axes.flat, panels, strict=False):
        table = 100.0 * np.reshape(values, (len(LOADS), len(SPEEDS))).T
        image = axis.pcolormesh(np.abs(table), norm=LogNorm(0.01, 100.0), cmap=colours, edgecolor="white")
        for row, column in np.ndindex(table.shape):
            value = table[row, column]
            if not math.isnan(value):
                text = f"{value:+.0f}" if abs(value) >= 9.5 else f"{value:+.2f}"
                axis.text(column + 0.5, row + 0.5, text, ha="center", va="center", fontsize=8)
        axis.set_xticks(np.arange(len(LOADS)) + 0.5, [f"{load / 1e3:.4g}" for load in LOADS])
        axis.set_yticks(np.arange(len(SPEEDS)) + 0.5, [f"{speed:.2g}" for speed in SPEEDS])
        axis.set_xlabel("load, N/mm")
        axis.set_ylabel("entrainment speed, m/s")
        axis.set_title(typeset(title), fontsize=9)
    for axis in axes.flat[len(panels) :]:
        axis.set_axis_off()
    figure.colorbar(image, ax=axes, label="size of the difference, %; grey: a solution is missing", shrink=0.8)
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    main()

"""The CFD of the film against `reynolds` with the same physics, at points of both maps: differences and cost.

Run: python -m tests.benchmarks.bench_openfoam [--columns N] [--rows N] [--ways "WAY;..."] [--points N] [--only TEXT]
     python -m tests.benchmarks.bench_openfoam --random N [--seed N] [--ways "WAY;..."]

With --random the points are drawn even in the logarithms over the axes of the shipped jobs nu308 and n1014, as in
`bench_physics`; what has no solution is listed with its reason.

newtonian: isothermal, Newtonian. limiting: with the limiting shear stress of `ehdmaps.physics.rheology`, isothermal.
thermal, limiting: with heat besides. A combination that a solver does not know is a row that says so.

Times are processor times of a point, of children too. A CFD point is two grids with stiffness and damping on both,
meshing, start from the Reynolds equation and reading of the results included; a Reynolds point is the quickest of three
runs.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ehdmaps.openfoam.installation import installation
from ehdmaps.openfoam.parameters import Flow
from ehdmaps.physics.contact import OperatingPoint
from tests.benchmarks.bench_physics import drawn
from tests.cases.openfoam_points import OIL, PLACES, SPIKED, THICK, Comparison, Place, agrees
from tests.cases.physics_ways import Answer, answer, solver_of

FLOWS: tuple[Flow, ...] = ("thin_film", "full_stress")
WAYS = ("newtonian", "limiting", "thermal, limiting")
GROUPS = {
    "25 points drawn over both maps": PLACES,
    "steep spikes: no oil is Newtonian there": SPIKED,
    "thick films: slopes of the surfaces are not small": THICK,
}

HEADING = (
    f"{'':<42} {'M':>7} {'L':>5}  {'':<17} | {'reynolds: h/nm':>14} {'T/degC':>7} {'c/(N s/m2)':>11} {'':>11} |"
    + " |".join(f" {flow + ', %: h':>18} {'f.compl':>7} {'T rise':>7} {'c':>7} {'':>10}" for flow in FLOWS)
)


@dataclass
class Found:
    """Comparisons of a flow with physics of a way, and the times of both solvers [s]."""

    compared: list[Comparison] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    reynolds_seconds: list[float] = field(default_factory=list)
    asked: int = 0
    solved: int = 0
    known: bool = True
    unsolved: list[str] = field(default_factory=list)


def main() -> None:
    """Print the table and the costs."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--columns", type=int, default=400)
    parser.add_argument("--rows", type=int, default=6)
    parser.add_argument("--ways", default=";".join(WAYS), help="separated by semicolons")
    parser.add_argument("--points", type=int, default=len(PLACES), help="how many points of each group")
    parser.add_argument("--random", type=int, default=0, metavar="N", help="N points at random instead")
    parser.add_argument("--seed", type=int, default=15, help="of the random points")
    parser.add_argument("--only", default="", help="points with this text in their line")
    options = parser.parse_args()
    installation()  # what is missing is said before anything is solved
    ways = options.ways.split(";")
    print(f"{options.columns} x {options.rows} cells, and half as many each way for the estimates")
    print(HEADING)
    grid = {"columns": options.columns, "rows": options.rows}
    found = {(way, flow): Found() for way in ways for flow in FLOWS}
    groups = {f"{options.random} points, seed {options.seed}": at_random(options.random, options.seed)}
    for title, places in (groups if options.random else GROUPS).items():
        most = len(places) if options.random else options.points
        chosen = [place for place in places[:most] if options.only in str(place)]
        if chosen:
            print(title)
        for place in chosen:
            for way in ways:
                solved(place, way, grid, found, counted=bool(options.random) or places is PLACES)
    print()
    for (way, flow), each in found.items():
        print(summary(way, flow, each))
        for line in each.unsolved:
            print(f"    {line}")


def at_random(count: int, seed: int) -> tuple[Place, ...]:
    """Places over the axes of the shipped jobs, of three digits."""
    return tuple(
        Place(
            case.bearing,
            case.side,
            *(float(f"{value:.3g}") for value in (case.point.load, case.point.entrainment_speed)),
            float(f"{case.point.temperature - 273.15:.3g}"),
        )
        for case in drawn(count, seed)
    )


def solved(place: Place, way: str, grid: dict[str, int], found: dict[tuple[str, Flow], Found], counted: bool) -> None:
    """Solve a point by all solvers with physics of a way, and print its row."""
    contact, point = place.contact, OperatingPoint(place.load, place.speed, place.celsius + 273.15)
    reynolds = answer(solver_of("reynolds", way), contact, OIL, point, repeats=3)
    M, L = place.groups
    cells = [reynolds_cell(reynolds, place)]
    for flow in FLOWS:
        solver = solver_of(flow, way, timeout=300.0, **grid)
        cfd = answer(solver, contact, OIL, point)
        here = found[way, flow]
        if counted:
            here.asked += 1
            here.known = solver is not None
        if counted and cfd.usable:
            here.solved += 1
        elif counted and cfd.film is not None:
            here.unsolved.append(f"{place}: {cfd.word}: {cfd.film.reason:.300}")
        if not cfd.usable or not reynolds.usable:
            cells.append(unlike_cell(cfd, place))
            continue
        assert cfd.film is not None and reynolds.film is not None
        compared = Comparison(place, flow, cfd.film, reynolds.film, way)
        cells.append(cfd_cell(compared, cfd.seconds))
        if counted:
            here.compared.append(compared)
            here.seconds.append(cfd.seconds)
            here.reynolds_seconds.append(reynolds.seconds)
    print(f"{place!s:<42} {M:7.3g} {L:5.1f}  {way:<17} |{' |'.join(cells)}".rstrip(), flush=True)


def reynolds_cell(found: Answer, place: Place) -> str:
    """Central film, largest temperature, damping and time of `reynolds`."""
    if not found.usable:
        return f" {found.word:<46}"
    assert found.film is not None
    damping = found.damping(place.contact, place.load)
    warmest = found.film.film_temperature - 273.15
    warm = "-" if math.isnan(warmest) else f"{warmest:.1f}"
    return f" {1e9 * found.film.central_film:14.1f} {warm:>7} {damping:11.4g} {found.seconds:9.4f} s"


def cfd_cell(found: Comparison, seconds: float) -> str:
    """Differences from `reynolds` [%], with a mark where one is beyond its bar, and the time."""
    at = found.place.celsius + 273.15
    rise = (found.cfd.film_temperature - at) / (found.reynolds.film_temperature - at) - 1.0
    warm = "-" if math.isnan(rise) else f"{100 * rise:+.2f}"
    differences = [100.0 * found.difference("central_film"), 100.0 * found.difference("film_compliance")]
    mark = "!" if agrees(found) else " "
    return (
        f" {differences[0]:+18.2f} {differences[1]:+7.2f} {warm:>7} {100 * found.damping:+7.2f} {seconds:6.2f} s {mark}"
    )


def unlike_cell(found: Answer, place: Place) -> str:
    """Status and time of a point that is not solved, or what is solved where `reynolds` has nothing beside it."""
    if not found.usable:
        took = f"{found.seconds:.2f} s" if found.film is not None else ""
        return f" {found.word:<30} {took:>20} {'':1}"
    assert found.film is not None
    values = f"h {1e9 * found.film.central_film:.1f} nm, c {found.damping(place.contact, place.load):.4g} N s/m2"
    return f" {values:<41} {found.seconds:6.2f} s  "


def summary(way: str, flow: Flow, found: Found) -> str:
    """What a flow solves of the points drawn, how near it comes, and what it costs."""
    if not found.known:
        return f"{way}, {flow}: not there"
    if not found.compared:
        return f"{way}, {flow}: {found.solved} of {found.asked} solved, none of them by reynolds"
    film = _median([abs(each.difference("central_film")) for each in found.compared])
    damping = _median([abs(each.damping) for each in found.compared])
    beyond = sum(bool(agrees(each)) for each in found.compared)
    seconds, reynolds = _median(found.seconds), _median(found.reynolds_seconds)
    return (
        f"{way}, {flow}: {found.solved} of {found.asked} solved, median {seconds:.2f} s a point, "
        f"{seconds / reynolds:.0f} times reynolds; median differences of {len(found.compared)} by both: "
        f"film {100 * film:.3f} %, "
        f"c {100 * damping:.2f} %; beyond the bars (!): {beyond}; within what both state: "
        + ", ".join(f"{words} {_share(found.compared, name)}" for words, name in _STATED)
    )


_STATED = (
    ("film offset", "film_offset"),
    ("film compliance", "film_compliance"),
    ("loss compliance", "loss_compliance"),
)


def _share(found: Sequence[Comparison], name: str) -> str:
    """Share of differences that the stated errors of both programs explain."""
    return f"{100.0 * np.mean([each.explained(name) for each in found]):.0f} %"


def _median(values: Sequence[float]) -> float:
    """Median of a few numbers."""
    return float(np.median(values))


if __name__ == "__main__":
    main()

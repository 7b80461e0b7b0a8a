"""The CFD of the film against the Reynolds equation: differences, the CFD's own error estimates, and what they cost.

Run: python -m tests.benchmarks.bench_openfoam [--columns N] [--rows N]

One process and one thread at a time. A CFD point is two grids with stiffness and damping on both, meshing, start from
the Reynolds equation and reading of the results included; a Reynolds point is solved alone, by itself.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.openfoam.parameters import Flow
from tests.cases.openfoam_points import (
    HEADING,
    OIL,
    PLACES,
    SPIKED,
    THICK,
    UNSOLVED,
    Comparison,
    agrees,
    compare,
    thickness,
)

FLOWS: tuple[Flow, ...] = ("thin_film", "full_stress")


def main() -> None:
    """Print the table and the costs."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--columns", type=int, default=400)
    parser.add_argument("--rows", type=int, default=6)
    options = parser.parse_args()
    print(f"{options.columns} x {options.rows} cells, and half as many each way for the estimates")
    print(HEADING)
    found: dict[Flow, list[Comparison]] = {flow: [] for flow in FLOWS}
    for place in PLACES:
        for flow in FLOWS:
            comparison = compare(place, flow, options.columns, options.rows)
            found[flow].append(comparison)
            print(comparison.row(), ", ".join(agrees(comparison)), flush=True)
    print("steep spikes: slow flow with all stresses is not elliptic")
    for place in SPIKED:
        for flow in FLOWS:
            print(compare(place, flow, options.columns, options.rows).row(), flush=True)
    print("drawn with the points above, but not solved with all stresses")
    for place in UNSOLVED:
        for flow in FLOWS:
            print(compare(place, flow, options.columns, options.rows).row(), flush=True)
    print("thick films: slopes of the surfaces are not small")
    for place in THICK:
        for flow in FLOWS:
            print(compare(place, flow, options.columns, options.rows).row(), f" h/R {thickness(place):.4f}", flush=True)

    solver = ReynoldsSolver()
    times = []
    for place in PLACES:
        began = time.perf_counter()
        solver.solve_line(place.contact, OIL, (place.load,), place.speed, place.celsius + 273.15)
        times.append(time.perf_counter() - began)
    reynolds = float(np.median(times))
    print(f"\nmedian of a point: reynolds {1e3 * reynolds:.1f} ms")
    for flow, comparisons in found.items():
        solved = [c for c in comparisons if c.cfd.status.usable]
        median = float(np.median([c.cfd.solve_seconds for c in solved]))
        film = np.median([abs(c.difference("central_film")) for c in solved])
        damping = np.median([abs(c.damping) for c in solved])
        print(
            f"{flow}: {len(solved)} of {len(comparisons)} converged, median {median:.2f} s a point, "
            f"{median / reynolds:.0f} times reynolds; median differences: film {100 * film:.2f} %, "
            f"c {100 * damping:.2f} %; all within the bars: {all(not agrees(c) for c in comparisons)}"
        )


if __name__ == "__main__":
    main()

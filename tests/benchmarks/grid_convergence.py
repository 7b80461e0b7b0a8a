"""Where CFD and Reynolds equation differ, on finer and finer grids: is it the grid, or the physics?

Run: python -m tests.benchmarks.grid_convergence
"""

from __future__ import annotations

from tests.cases.openfoam_points import HEADING, PLACES, SPIKED, THICK, compare, thickness


def main() -> None:
    """Print one row a grid."""
    print(f"{'cells':<11}{HEADING}")
    for place in (SPIKED[1], THICK[1], PLACES[6]):
        print(f"h/R {thickness(place):.5f}")
        for columns, rows in ((200, 6), (400, 6), (800, 6), (400, 12)):
            print(f"{columns:>4} x {rows:<4}{compare(place, 'thin_film', columns, rows).row()}", flush=True)


if __name__ == "__main__":
    main()

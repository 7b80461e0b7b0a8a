"""Wall stress over pressure of isothermal, Newtonian films, on finer and finer grids: where no oil is Newtonian.

Run: python -m tests.benchmarks.wall_stress

Oils bear some hundredths of their pressure as shear stress. At the front of a pressure spike the ratio rises with the
cells, so that what a grid shows is a lower bound.
"""

from __future__ import annotations

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.rheology import wall_stress_share
from tests.cases.openfoam_points import OIL, PLACES, SPIKED

FINER = (1, 2, 4)
"""Densities of cells over the default one."""

SHOWN = (PLACES[4], PLACES[15], PLACES[23], PLACES[8], SPIKED[2], SPIKED[0])


def main() -> None:
    """Print a row for each point."""
    usual = ReynoldsSolver().density
    print(f"{'wall stress/pressure, reynolds at':<44}" + "".join(f"{count * usual:9g}" for count in FINER) + "  cells")
    for place in SHOWN:
        point = OperatingPoint(place.load, place.speed, place.celsius + 273.15)
        shares = []
        for count in FINER:
            _, profile = ReynoldsSolver(density=count * usual).film_profile(place.contact, OIL, point)
            assert profile is not None, f"{place}: no solution"
            shares.append(wall_stress_share(profile.x, profile.pressure, profile.film))
        print(f"{place!s:<44}" + "".join(f"{share:9.3f}" for share in shares))


if __name__ == "__main__":
    main()

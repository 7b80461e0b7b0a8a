"""How wrong the law of a roller is at the mean temperature of both raceways.

    python -m tests.benchmarks.raceway_difference nu308.nc

The walls of the inner contact are a quarter of the difference between the raceways warmer than their mean, those of the
outer contact as much colder. Its two laws at these temperatures, in series by hand, are the truth that is compared.
"""

from __future__ import annotations

import sys
from itertools import product

import numpy as np
from scipy.optimize import brentq

from ehdmaps.maps.emap import open_map
from ehdmaps.maps.law import ContactLaw

LOADS = (5e3, 2e4, 5e4, 2e5)
SPEEDS = (0.2, 0.8, 2.5, 5.0)
TEMPERATURES = (313.15, 333.15, 353.15)
DIFFERENCES = (5.0, 10.0, 20.0)


def at_load(law: ContactLaw, load: float, speed: float, temperature: float) -> np.ndarray:
    """Approach [m], compliance [m2/N] and loss compliance [m2 s/N] of a law at a load per length."""
    approach = brentq(lambda delta: float(law(delta, 0.0, speed, temperature)[0]) - load, -2e-4, 3e-4, xtol=1e-14)
    _, stiffness, damping = (float(part) for part in law(approach, 0.0, speed, temperature))
    return np.array([approach, 1.0 / stiffness, damping / stiffness**2])


def main(path: str) -> None:
    """Print the errors for each difference of the raceways."""
    emap = open_map(path)
    series, inner, outer = (emap.law(kind, outside="clamp") for kind in ("series", "inner", "outer"))
    print("  between the raceways   approach, um: median, largest   stiffness: largest   damping: median, largest")
    for difference in DIFFERENCES:
        errors = []
        for load, speed, mean in product(LOADS, SPEEDS, TEMPERATURES):
            plain = at_load(series, load, speed, mean)
            apart = at_load(inner, load, speed, mean + 0.25 * difference)
            apart += at_load(outer, load, speed, mean - 0.25 * difference)
            damping = (plain[2] / plain[1] ** 2) / (apart[2] / apart[1] ** 2)
            errors.append((1e6 * abs(plain[0] - apart[0]), abs(apart[1] / plain[1] - 1.0), abs(damping - 1.0)))
        found = np.array(errors)
        middle, most = np.median(found, axis=0), found.max(axis=0)
        print(
            f"  {difference:17.3g} K   {middle[0]:19.2g}, {most[0]:7.2g}   {most[1]:18.2%}   "
            f"{middle[2]:15.2%}, {most[2]:7.2%}"
        )


if __name__ == "__main__":
    main(sys.argv[1])

"""How far stiffness and damping of the low-frequency limit hold: c and k at omega b/u beside those at zero.

Run: python -m tests.benchmarks.frequency_limit

Contacts of NU308 and N1014 with FVA 3 over load, speed and temperature, by the Reynolds solver. Where the low-frequency
damping is not positive, at the bottom of the damping valley, there is no ratio; these points are counted.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.jobs.reader import read_job
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.spectrum import contact_spectrum

LOADS = (5e3, 2e4, 5e4, 1e5, 3e5, 8e5)
SPEEDS = (0.4, 1.7, 6.0)
TEMPERATURES = (313.15, 353.15)
RATIOS = (0.1, 0.3, 0.5, 1.0, 2.0)


def main() -> None:
    """Print the table."""
    solver = ReynoldsSolver()
    found, without = [], 0
    for name, load, speed, temperature in itertools.product(("nu308", "n1014"), LOADS, SPEEDS, TEMPERATURES):
        job = read_job(name)
        point = OperatingPoint(load, speed, temperature)
        for contact in job.contacts:
            time = float(half_width(load, contact.radius, contact.reduced_modulus)) / speed
            frequencies = np.array(RATIOS) / time / (2.0 * math.pi)
            found_here = contact_spectrum(
                solver.film_spectrum(contact, job.lubricant, point, frequencies), contact, point
            )
            slow = found_here.solution
            if not slow.damping > 0.0:
                without += 1
                continue
            found.append(np.array([found_here.damping / slow.damping, found_here.stiffness / slow.stiffness]))
    table = np.array(found)
    print(f"{table.shape[0]} points, and {without} without positive damping at zero")
    print(f"{'omega b/u':>10s}{'c/c(0): median':>18s}{'5 to 95 %':>16s}{'k/k(0): median':>18s}{'5 to 95 %':>16s}")
    for index, ratio in enumerate(RATIOS):
        cells = ""
        for values in (table[:, 0, index], table[:, 1, index]):
            low, middle, high = np.quantile(values, (0.05, 0.5, 0.95))
            cells += f"{middle:18.2f}{f'{low:.2f} to {high:.2f}':>16s}"
        print(f"{ratio:10.1f}{cells}")


if __name__ == "__main__":
    main()

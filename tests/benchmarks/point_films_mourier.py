"""A circular contact beside the films and pressures of Mourier and others (2006), as digitised by others.

Run: python -m tests.benchmarks.point_films_mourier FOLDER

FOLDER is `data/Mourier_2006` of the public repository ErikHansenGit/EHL, whose setup of study A has the numbers of the
contact: a ball of 12.5 mm on a plane, 15 N, 0.09 m/s, E' 110 GPa, 0.25 Pa s, 22 /GPa. Compared are the film and the
pressure along the middle, in pure rolling, while the dimple is still outside (1): computed by them, and measured.

References
----------
L. Mourier, D. Mazuyer, A. A. Lubrecht, C. Donnet, Transient increase of film thickness in micro-textured EHL contacts,
Tribology International 39 (12), 2006, 1745-1756.
E. Hansen, A. Kacan, B. Frohnapfel, A. Codrignani, An EHL extension of the unsteady FBNS algorithm, Tribology Letters
70, 2022.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.point import solve

BALL = Ellipse(12.5e-3, 12.5e-3, 110e9)
OIL = Lubricant.roelands(viscosity=0.25, pressure_viscosity=22e-9, density=850.0)
LOAD, SPEED, TEMPERATURE = 15.0, 0.09, 313.15
MIDDLE, WITHIN = 40e-6, 0.85
"""Half of the middle over which the central film is averaged [m], and the part of the contact that is compared."""

FILES = (("film, computed", "sim_1_h", "film", 1e-9), ("film, measured", "exp_1", "film", 1e-9),
         ("pressure, computed", "sim_1_p", "pressure", 1e6))  # fmt: skip


def main(folder: str) -> None:
    """Print the differences.

    Parameters
    ----------
    folder : str
        Folder of the digitised curves.
    """
    found = solve(BALL, OIL, LOAD, SPEED, TEMPERATURE)
    assert found.field is not None
    half = float(BALL.semi_axes(LOAD)[0])
    print(f"M {found.load_number:.4g}, L {found.oil_number:.4g}, a {1e6 * half:.4g} um, p_H "
          f"{1e-6 * float(BALL.max_pressure(LOAD)):.4g} MPa: central film {1e9 * found.central_film:.4g} nm "
          f"+-{100 * found.central_film.error:.1f} %")  # fmt: skip
    print(f"{'':20s}{'theirs':>12s}{'difference':>12s}{'over the middle of the contact, |x| < 0.85 a':>48s}")
    for label, name, quantity, unit in FILES:
        x, theirs = np.loadtxt(Path(folder) / f"mourier_ssr0_{name}.csv", delimiter=",", skiprows=1).T
        x, theirs = 1e-6 * x, unit * theirs
        ours = CubicSpline(found.field.x, getattr(found.field, quantity)[:, 0])
        near, inside = np.abs(x) < MIDDLE, np.abs(x) < WITHIN * half
        centre = float(np.mean(theirs[near]))
        apart = float(np.mean(ours(x[near]) / theirs[near])) - 1.0
        spread = np.percentile(np.abs(ours(x[inside]) / theirs[inside] - 1.0), (50, 100))
        print(f"{label:20s}{centre / unit:9.1f} {'nm' if unit < 1 else 'MPa':3s}{100 * apart:10.1f} %"
              f"{'median':>24s} {100 * spread[0]:.1f} %, most {100 * spread[1]:.1f} %")  # fmt: skip
        if quantity == "film":
            behind = x > 0.5 * half
            k = np.argmin(np.where(behind, theirs, np.inf))
            place = np.linspace(0.7 * half, 1.1 * half, 2001)
            least = int(np.argmin(ours(place)))
            print(f"  at the exit: {theirs[k] / unit:.1f} nm at {1e6 * x[k]:.1f} um, ours "
                  f"{float(ours(place[least])) / unit:.1f} nm at {1e6 * place[least]:.1f} um")  # fmt: skip


if __name__ == "__main__":
    main(sys.argv[1])

"""Line contacts with temperatures in the film over isothermal ones: what the rule of inlet heat was fitted to, and not.

`python -m tests.benchmarks.warm_lines` solves them by `reynolds` with physics thermal, writes
`tests/references/warm_lines.toml`, and fits the numbers of `ehdmaps.physics.heat` to the oils that are not `LEFT_OUT`.
"""

from __future__ import annotations

import dataclasses
import math
import tomllib
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.heat import viscosity_slope
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups
from ehdmaps.physics.solids import STEEL

FILE = Path(__file__).parents[1] / "references" / "warm_lines.toml"

CONDUCTIVITY = 0.134
RADIUS = 8e-3

OILS = (("ISO VG 22", 50.0, 85.0), ("ISO VG 68", 75.0, 105.0), ("FVA3", 60.0, 95.0))
"""Oils with two temperatures [degC]: thick and thin, of high and of low L."""

LEFT_OUT = "FVA3"
"""The oil that the rule has not seen."""

LOADINGS = (0.15, 0.5, 1.2, 2.2, 3.0), (0.15, 0.6, 1.5, 3.0)
LOAD_NUMBERS = (0.3, 2.0, 5.0, 15.0, 60.0), (0.4, 2.5, 8.0, 50.0)
"""QL and M at either temperature; around M = 1 there is the valley, where no factor of the losses holds."""

BEYOND, LOADS_BEYOND = (5.0, 8.0), (2.5, 8.0, 30.0)
"""QL, and M, of lines with more heat than those which made the rule, at the first temperature."""

NAMES = ("central_film", "film_offset", "film_compliance", "loss_compliance")


def solved(name: str, celsius: float, loading: float, load_number: float) -> dict[str, float | str] | None:
    """Warm over cold numbers of a line; None where one is not solved."""
    oil = dataclasses.replace(Lubricant.named(name), thermal_conductivity=CONDUCTIVITY)
    contact = LineContact("line", RADIUS, STEEL, "half_space", reference_depth=RADIUS)
    T = celsius + 273.15
    state = oil.at(T)
    speed = math.sqrt(-loading * CONDUCTIVITY / viscosity_slope(oil, T))
    alpha = state.pressure_viscosity.pressure_viscosity
    one, L = moes_groups(1.0, speed, state.viscosity, alpha, contact.radius, contact.reduced_modulus)
    load = load_number / float(one)
    cold, warm = (
        ReynoldsSolver(physics=physics).solve_line(contact, oil, (load,), speed, T)[0]
        for physics in ("isothermal", "thermal")
    )
    if not (cold.status.usable and warm.status.usable):
        return None
    part = cold.film_compliance * load / cold.film_offset  # -d ln h/d ln w of the cold film
    given = {"oil": name, "celsius": celsius, "QL": loading, "M": load_number, "L": round(float(L), 2)}
    ratios = {key: round(getattr(warm, key) / getattr(cold, key), 5) for key in NAMES}
    return {**given, "fall": round(part, 5), **ratios}


def fitted(rows: list[dict[str, float]]) -> FloatArray:
    """Heating at QL = M = 1, exponents of QL and M, and the M of half the heating, of what made the rule."""
    kept = [row for row in rows if row["oil"] != LEFT_OUT and row["QL"] < BEYOND[0]]
    M, QL, film = (np.array([row[key] for row in kept]) for key in ("M", "QL", "central_film"))

    def wrong(p: FloatArray) -> FloatArray:
        return -np.log1p(p[0] * QL ** p[1] * M ** (1.0 + p[2]) / (M + p[3])) - np.log(film)

    return np.asarray(least_squares(wrong, [0.2, 0.7, 0.1, 0.2]).x)


def main() -> None:
    """Solve, write, fit."""
    rows = []
    for name, *temperatures in OILS:
        for celsius, loadings, load_numbers in zip(temperatures, LOADINGS, LOAD_NUMBERS, strict=True):
            for loading in loadings:
                rows += filter(None, (solved(name, celsius, loading, M) for M in load_numbers))
        more = (solved(name, temperatures[0], loading, M) for loading in BEYOND for M in LOADS_BEYOND)
        rows += filter(None, more)
    texts = ["".join(f"{key} = {value!r}\n".replace("'", '"') for key, value in row.items()) for row in rows]
    FILE.write_text(
        "# Films with temperatures over isothermal ones, by `python -m tests.benchmarks.warm_lines`.\n"
        f"# Steel, radius {RADIUS:g} m; fall is -d ln(film offset)/d ln(load) of the isothermal film.\n\n"
        + "\n".join(f"[[lines]]\n{text}" for text in texts),
        encoding="utf-8",
    )
    print("HEATING, BY_LOADING, BY_LOAD, LIGHTEST:", np.round(fitted(tomllib.loads(FILE.read_text())["lines"]), 4))


if __name__ == "__main__":
    main()

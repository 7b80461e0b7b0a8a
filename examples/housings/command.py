"""Command `python -m examples.housings`: its arguments, and what it makes of them."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.outputs import FIGURE, Output, output_problems, write_figure
from ehdmaps.units import LENGTH, quantity
from examples.housings.designs import Housing, housing
from examples.housings.geometry import check_size
from examples.housings.make import Made, check_cutoff, make
from examples.housings.picture import housing_figure
from mbs.flexible.reduced_file import REDUCED, write_reduced

_FACTORS = (1.5, 1.0, 0.75)
"""Sizes of the table of convergence, of the shipped one."""

_FREQUENCIES = 5


def run(arguments: argparse.Namespace) -> str:
    """Read the arguments, do what they ask, and say what came out.

    Raises
    ------
    InputError
        With all problems of the arguments, or a missing program.
    AnalysisError
        If meshing or solving fails.
    """
    problems: list[str] = []
    chosen: Housing | None = None
    size = cutoff = 0.0
    try:
        chosen = housing(arguments.name)
        size, cutoff = chosen.size, chosen.cutoff
    except InputError as error:
        problems += error.problems
    try:
        if arguments.size is not None:
            size = quantity(arguments.size, "m")
        if chosen is not None or arguments.size is not None:
            for factor in _FACTORS if arguments.convergence else (1.0,):
                check_size(factor * size)
    except InputError as error:
        problems += [f"--size: {problem}" for problem in error.problems]
    try:
        if arguments.cutoff is not None:
            cutoff = quantity(arguments.cutoff, "Hz")
            check_cutoff(cutoff)
    except InputError as error:
        problems += [f"--cutoff: {problem}" for problem in error.problems]
    output = Path(arguments.output or f"{arguments.name}.nc")
    problems += output_problems([Output("-o", output, REDUCED), Output("--picture", arguments.picture, FIGURE)])
    if problems or chosen is None:
        raise InputError(problems)
    if arguments.convergence:
        return _convergence(chosen, size, cutoff)
    begin = time.monotonic()
    made = make(chosen, size, cutoff, Path(arguments.keep) if arguments.keep else None)
    lines = _described(chosen, made, cutoff)
    if arguments.picture:
        write_figure(housing_figure(chosen, made.mesh), arguments.picture)
        lines.append(f"{arguments.picture}: written")
    write_reduced(output, made.reduced)
    lines.append(f"{output}: written, {output.stat().st_size / 1e3:.0f} kB, after {time.monotonic() - begin:.0f} s")
    return "\n".join(lines)


def _described(chosen: Housing, made: Made, cutoff: float) -> list[str]:
    """Lines on a housing that was made."""
    below = made.frequencies < 0.5 * cutoff
    apart = made.reduced_frequencies[below] / made.frequencies[below] - 1.0
    lines = [
        f"{chosen.title}: {made.reduced.attributes['mesh']}",
        f"  mass {made.reduced.attributes['total_mass']}; {made.reduced.attributes['material']}",
        f"  {len(made.reduced.coordinates) - made.modes} coordinates of the seats and {made.modes} modes up to "
        f"{cutoff:.6g} Hz",
        "  lowest frequencies, feet held, seats free: " + made.reduced.attributes["clamped_frequencies"],
    ]
    if below.any():
        lines.append(
            f"  the reduced body is up to {100.0 * float(abs(apart).max()):.2g} % away from the {below.sum()} of them "
            "below half the cutoff"
        )
    lines += [f"  {name}: {value / 1e6:.4g} N/um along z" for name, value in made.seat_stiffness.items()]
    return lines


def _convergence(chosen: Housing, size: float, cutoff: float) -> str:
    """Table of frequencies and seat stiffness over mesh sizes."""
    seat = next(iter(chosen.seats))
    heads = " ".join(f"{f'f{k + 1}/Hz':>9}" for k in range(_FREQUENCIES))
    lines = [f"{chosen.title}", f"  {'size':>8} {'coordinates':>12} {'mass/kg':>9} {heads}   {seat} along z, N/um"]
    for factor in _FACTORS:
        made = make(chosen, factor * size, cutoff)
        values = " ".join(f"{value:9.2f}" for value in made.frequencies[:_FREQUENCIES])
        mass = made.mesh.volume * chosen.material.density
        lines.append(
            f"  {LENGTH.text(factor * size):>8} {made.coordinates:12d} {mass:9.4f} {values}   "
            f"{made.seat_stiffness[seat] / 1e6:.4g}"
        )
    return "\n".join(lines)

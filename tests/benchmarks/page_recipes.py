"""How the figures of a block follow from what its commands print.

A recipe is a function of the printed texts. It gives the lines of a block (`printed`), or the numbers of a text in
their order: figures, times, and numbers that are given, which must stand as they are. Words on a page are written by
hand; a recipe does not look at them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from tests.benchmarks.benchmark_recipes import cutoffs, gearbox_runs, periods, speed_sweep
from tests.benchmarks.contact_recipes import (
    contact_over_speed,
    share_of_damping,
    show_of_a_map,
    solvers,
)
from tests.benchmarks.machine_recipes import (
    amplitudes_of_the_rig,
    bushings_of_the_rigid,
    constants_of_the_rigid,
    damping_of_bearings,
    dry_shift,
    energy_theorem,
    films_beside_dry,
    formula_beside_films,
    hammer_test,
    housing_modes,
    level_of_the_formula,
    levels_of_laws,
    loads_of_the_flexible,
    loads_of_the_gearbox,
    own_laws_of_the_rigid,
    peaks_dry,
    peaks_with_films,
    readme_of_the_gearbox,
    rig_over_speed_and_clearance,
    rigid_over_speed_and_load,
    run_of_flexible,
    shaft_bearing_modes,
    shaft_mode_of_the_rigid,
    slow_and_memory,
    stiffness_of_bearings,
    stiffness_of_the_flexible,
    widths_of_resonances,
    without_clearance,
)
from tests.benchmarks.page_block import Block, Compared, Figure, compared_in_order, compared_texts, with_figures
from tests.benchmarks.printed_tables import Output
from tests.benchmarks.thesis_recipes import (
    dry_laws_of_the_rigid,
    height_of_the_rigid,
    last_peak_of_the_flexible,
    oil_of_the_thesis,
    rig_at_high_speed,
)

TIMES = tuple(
    re.compile(pattern)
    for pattern in (
        r"\b(\d[\d.]*) (?:ms|s|us)\b(?! of)",  # with its unit
        r"^ +\d+\.\d +(\d+)  ",  # points a second, of bench_ehl
        r"\bx +(\d[\d.]*)  ",  # ratio of times, of bench_ehl
        r"   x (\d[\d.]*)(?:;|$)",  # ratio of times, of bench_physics
        r"^(?:law|scipy|xarray)[^\d\n]*?(?:grid 25x12x6)? +(\d[\d.]* +\d[\d.]*)",  # bench_law
        r"(\d+) times reynolds",
        r" (\d\S*) +\d+/\d+(?: |$)",  # beside what was solved, of a trade
        r"distance to the solution (\S+)",  # round-off
        r"made (\d{4}-\S+)",  # date of a map
        r"kill -9 at (\d+) of",  # where a run is killed, and what the next one finds
        r"^ +(\d+) of \d+ points taken over",
        r"(\d+) of them taken over",
        r"^ .* N/mm((?: +[\d.]+ \( *\d+\))+)",  # times over load and speed
    )
)
"""What is exempt in printed texts: times, ratios of times, and what round-off leaves."""

RECIPES: dict[str, Callable[[Sequence[Output]], list[Figure]]] = {
    recipe.__name__.replace("_", "-"): recipe
    for recipe in (
        shaft_bearing_modes,
        without_clearance,
        stiffness_of_bearings,
        damping_of_bearings,
        dry_shift,
        loads_of_the_gearbox,
        energy_theorem,
        housing_modes,
        run_of_flexible,
        loads_of_the_flexible,
        amplitudes_of_the_rig,
        constants_of_the_rigid,
        shaft_mode_of_the_rigid,
        own_laws_of_the_rigid,
        bushings_of_the_rigid,
        rigid_over_speed_and_load,
        rig_over_speed_and_clearance,
        stiffness_of_the_flexible,
        widths_of_resonances,
        contact_over_speed,
        hammer_test,
        films_beside_dry,
        levels_of_laws,
        level_of_the_formula,
        formula_beside_films,
        share_of_damping,
        slow_and_memory,
        solvers,
        show_of_a_map,
        gearbox_runs,
        peaks_with_films,
        peaks_dry,
        readme_of_the_gearbox,
        periods,
        cutoffs,
        speed_sweep,
        oil_of_the_thesis,
        last_peak_of_the_flexible,
        dry_laws_of_the_rigid,
        rig_at_high_speed,
        height_of_the_rigid,
    )
}
"""Recipes that give figures in their order; beside them `printed[FROM:TO]`, lines of what one command prints."""


def printed(block: Block, outputs: Sequence[Output]) -> str:
    """Lines of what a command prints, in a fence; which ones says its recipe, as slices: `printed[0:2,7:]`.

    Raises
    ------
    ValueError
        The block has several commands.
    """
    if len(outputs) != 1:
        raise ValueError(f"{block.place}: got {len(outputs)} commands; allowed: one for printed lines")
    lines = outputs[0].text.rstrip("\n").splitlines()
    slices = block.recipe.partition("[")[2].rstrip("]") or ":"
    bounds = [[int(bound) if bound else None for bound in each.split(":")] for each in slices.split(",")]
    lines = [line for first, last in bounds for line in lines[first:last]]
    text = "\n".join(line.rstrip() for line in lines).strip("\n")
    opening = block.text.lstrip().partition("\n")[0]
    return f"{opening}\n{text}\n```\n" if opening.startswith("```") else f"{text}\n"


def rewritten(block: Block, outputs: Sequence[Output]) -> str:
    """The text of a block with the figures that its commands give now."""
    if block.recipe.startswith("printed"):
        return printed(block, outputs)
    return with_figures(block.text, RECIPES[block.recipe](outputs))


def compared(block: Block, outputs: Sequence[Output]) -> Compared:
    """Compare a block as it stands with the figures that its commands give now."""
    if block.recipe.startswith("printed"):
        return compared_texts(block.text, printed(block, outputs), TIMES)
    return compared_in_order(block.text, RECIPES[block.recipe](outputs))

"""Outside witnesses: measured and makers' data beside what this program says with its defaults.

Run: python -m tests.benchmarks.witnesses [--points] [--plot FIG.png]

A row a series: number of points, median and range of ours over theirs. With --points all points. The picture has all
points of all series.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from tests.cases.witnesses import (
    Series,
    centre_line,
    gmn_pairs,
    hamrock_dowson,
    iso_16281,
    measured_capacitance,
    measured_films,
    thin_pairs,
)


def table(series: Sequence[Series]) -> list[str]:
    """Lines of a table, a series each."""
    lines = [f"{'ours over theirs':54s} points    median    smallest   largest"]
    for one in series:
        ratio = one.ratio
        digits = 5 if "16281" in one.name else 3
        lines.append(
            f"{one.name:54s} {ratio.size:6d} {np.median(ratio):9.{digits}f} {ratio.min():11.{digits}f} "
            f"{ratio.max():9.{digits}f}"
        )
    return lines


def points(series: Sequence[Series]) -> list[str]:
    """Lines of all points."""
    lines = []
    for one in series:
        lines += [f"{one.name}, {one.unit}: theirs, ours"]
        lines += [
            f"  {label:24s} {theirs:10.5g} {ours:10.5g}"
            for label, theirs, ours in zip(one.labels, one.theirs, one.ours, strict=True)
        ]
    return lines


def between_grooves(default: Series, loose: Series) -> str:
    """A line on the points that lie between what both grooves give."""
    held = np.mean((loose.ratio <= 1.0) & (default.ratio >= 1.0))
    near = np.mean((loose.ratio <= 1.03) & (default.ratio >= 0.97))
    return (
        f"pairs between both grooves: {100 * held:.0f} % of the points, with 3 % more on each side {100 * near:.0f} %"
    )


def drawing(groups: Sequence[tuple[str, Sequence[tuple[str, Series]]]], path: Path) -> None:
    """Draw ours over theirs for every point, a panel for each witness."""
    figure, axes = plt.subplots(1, len(groups), figsize=(15.0, 3.6), layout="constrained")
    for axis, (title, group) in zip(axes, groups, strict=True):
        for label, one in group:
            axis.plot(one.theirs, one.ratio, "o", markersize=3.5, alpha=0.8, label=label)
        axis.axhline(1.0, color="0.5", linewidth=0.8)
        axis.set(xlabel=f"theirs, {group[0][1].unit}", title=title)
        axis.title.set_fontsize(10)
        axis.legend(fontsize=7)
    axes[0].set_ylabel("ours over theirs")
    figure.savefig(path, dpi=120)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--points", action="store_true")
    parser.add_argument("--plot", type=Path)
    asked = parser.parse_args()
    pairs, films, line, iso = gmn_pairs(), measured_films(), centre_line(), iso_16281()
    electric = measured_capacitance()
    every = [*pairs, *thin_pairs(), *films, *line, hamrock_dowson(), *electric, *iso]
    print("\n".join([*table(every), between_grooves(*pairs)]))
    if asked.points:
        print("\n".join(points(every)))
    if asked.plot:
        plateaus = [one for one in line if one.ratio.size > 1]
        grooves = "grooves 0.515, 0.52, the default", "grooves 0.52, 0.53"
        degrees = (one.name.partition(" at ")[2].partition(",")[0] for one in films)
        groups = (
            ("axial rigidity of pairs, GMN (228)", [*zip(grooves, pairs, strict=True)]),
            ("axial rigidity of pairs 719 (400)", [*zip(("GMN", "NSK"), thin_pairs()[:2], strict=True)]),
            ("central films of FVA 3 (29)", [*zip(degrees, films, strict=True)]),
            ("plateau along a centre line, Mourier", [(one.name.partition(", ")[2], one) for one in plateaus]),
            ("smallest films (8)", [("Hamrock and Dowson", hamrock_dowson())]),
            ("capacitance of a contact (3)", [*zip(("all the oil", "plates of Hertz"), electric, strict=True)]),
        )
        drawing(groups, asked.plot)


if __name__ == "__main__":
    main()

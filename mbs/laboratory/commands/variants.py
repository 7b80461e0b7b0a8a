"""`mbs variants`: how far a difference between two contact laws depends on what was assumed, as a table."""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Sequence

from ehdmaps.errors import InputError, Problems
from ehdmaps.units import RPM, closest
from mbs.analyses.reach import axes_outside, outside_lines
from mbs.commands.cases import read_compared
from mbs.commands.common import Told, chosen_workers, read_band, write
from mbs.laboratory.variants import Variant, VariantsResult, Variation, variants
from mbs.output.model_text import clearance_text, common_supply, held_lines, temperature_text, weight_text
from mbs.scene.choices import VARIED
from mbs.scene.fields import HERTZ
from mbs.scene.scene import Scene
from mbs.scene.subject import LawChoice
from mbs.settings import CampbellSettings
from mbs.spectral.levels import Reference

_COLUMNS = " median   5 to 95 % of the windows   mean energy   highest"


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Run up with two laws, and again with each change."""
    scene, laws, clearance, settings, variations = _asked(arguments)
    with chosen_workers(arguments) as workers:
        found = variants(scene, laws, variations, clearance, settings, Told("step"), keep_partial=True, workers=workers)
    lines = [*_heading(found), *_tables(found), *_ranges(found), *_warnings(found)]
    title = f"{scene.title}\n{_base(found)}; one change at a time"
    figure = None
    if arguments.plot:
        from mbs.output.campbell_plot import variants_figure

        figure = variants_figure(title, found.dataset, found.labels)
    lines += write(arguments, found.dataset, figure)
    return "\n".join(lines), 1 if any(row.problem or row.outside for row in found.variants) else 0


def _asked(
    arguments: argparse.Namespace,
) -> tuple[Scene, tuple[LawChoice, LawChoice], float | None, CampbellSettings, list[Variation]]:
    """Read what is compared, and what is varied; all problems at once."""
    problems = Problems()
    band = read_band(arguments, problems)
    variations = _variations(arguments.vary, problems)
    scene, laws, clearance = read_compared(arguments, problems)
    if len(laws) != 2 and not problems:
        got = ", ".join(law.label for law in laws)
        problems.append(
            f"--law, --map, --films, --supply: got {len(laws)} laws ({got}); allowed: two, the reference first, such "
            "as --law hertz --map MAP.nc"
        )
    if problems or scene is None:
        raise InputError(problems)
    return scene, (laws[0], laws[1]), clearance, dataclasses.replace(scene.campbell, **band), variations


def _variations(given: Sequence[Sequence[str]], problems: Problems) -> list[Variation]:
    """Read what was given for --vary."""
    found = []
    for name, *texts in given:
        key = VARIED.get(name)
        if key is None:
            problems.append(f"--vary: got {name!r:.40}{closest(name, tuple(VARIED))}; allowed: {', '.join(VARIED)}")
            continue
        if not texts:
            problems.append(f"--vary {name}: got no value; allowed: one or more, such as {key.example!r}")
        for text in texts:
            with problems.after(f"--vary {name}: "):
                found.append(Variation(name, key.read(text)))
    return list(dict.fromkeys(found))


def _base(found: VariantsResult) -> str:
    """Description of the base, in words."""
    course, supply = found.course, common_supply(found.models)
    return (
        f"run-up from {RPM.text(course.speed.at(0.0)[0])} to {RPM.text(course.speed.at(course.duration)[0])} in "
        f"{course.duration:.4g} s, {temperature_text(found.models[1])}, clearance "
        f"{clearance_text(found.models[1]) or 'none'}" + (f", {supply}" if supply else "")
    )


def _heading(found: VariantsResult) -> list[str]:
    """Lines on what is compared."""
    scene = found.models[0].scene
    return [
        f"{scene.title}: {_base(found)}, {weight_text(found.models[1])}",
        f"  first law: {found.models[0].law}",
        f"  second law: {found.models[1].law}",
        *held_lines(found.models[1]),
        f"  {len(found.variants) - 1} changes, one at a time, {found.runs} runs; sum level up to "
        f"{HERTZ.text(found.settings.highest)} of the second law minus that of the first, dB: at the same speed, of "
        "the mean energies, of the highest of each at any speed",
    ]


def _tables(found: VariantsResult) -> list[str]:
    """A table for each sensor."""
    lines = []
    widths = [max(len(text) for text in texts) for texts in zip(*(_names(row) for row in found.variants), strict=True)]
    for column, sensor in enumerate(found.sensors):
        lines.append(f"sensor {sensor.name}, {Reference.of(sensor).text}")
        lines.append(f"  {'varied':{widths[0]}s}  {'value':{widths[1]}s}  {_COLUMNS}")
        lines += [_row(row, column, widths) for row in found.variants]
    return lines


def _names(row: Variant) -> tuple[str, str]:
    """Key and value as the table has them."""
    return row.key or "base", row.value or "-"


def _row(row: Variant, column: int, widths: Sequence[int]) -> str:
    """A change at a sensor."""
    key, value = _names(row)
    begin = f"  {key:{widths[0]}s}  {value:{widths[1]}s} "
    if not row.differences:
        return f"{begin} no result: {row.problem}"
    one = row.differences[column]
    windows = f"{one.low:.1f} to {one.high:.1f}"
    return f"{begin} {one.median:7.1f} {windows:>26s} {one.energy:13.1f} {one.highest:9.1f}"


def _ranges(found: VariantsResult) -> list[str]:
    """Lines on the range over all changes, for each sensor and over all."""
    columns = range(len(found.sensors))
    named = [(f"sensor {sensor.name}", [k]) for k, sensor in enumerate(found.sensors)]
    if len(named) > 1:
        named.append(("all sensors", list(columns)))
    lines = [f"range over the base and {len(found.found) - sum(not row.key for row in found.found)} changes"]
    for words, which in named:
        entries = [row.differences[k] for row in found.found for k in which]
        parts = [
            f"{part_words} {min(values):.1f} to {max(values):.1f} dB"
            for part_words, values in (
                ("median", [entry.median for entry in entries]),
                ("mean energy", [entry.energy for entry in entries]),
                ("highest", [entry.highest for entry in entries]),
            )
        ]
        lines.append(f"  {words}: {', '.join(parts)}")
    return lines


def _warnings(found: VariantsResult) -> list[str]:
    """Lines on what has no result, and on what lies outside the map."""
    lines = list(dict.fromkeys(line for model in found.models for line in model.warnings))
    lines += [f"warning: {row.words}: {row.problem}" for row in found.variants if row.problem]
    speeds = found.course.speed.course.values
    axes = axes_outside(found.models[1], max(abs(speed) for speed in speeds))
    for row in found.variants:
        lines += outside_lines(row.outside, "{} calls outside the map", axes if not row.key else {}, row.words)
    return lines

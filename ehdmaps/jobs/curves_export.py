"""Target `csv` of `ehdmaps export`: curves over load of a contact law, as a table."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.exports.target import Target
from ehdmaps.jobs.export import Chosen, table
from ehdmaps.maps.emap import EHDMap
from ehdmaps.outputs import TABLE, Output, check_outputs, write_text
from ehdmaps.units import SPEED, TEMPERATURE, Display, quantity
from ehdmaps.workers import processes


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what chooses the curves."""
    parser.add_argument("--speed", help='entrainment speed, such as "1.7 m/s"; default: all of the map')
    parser.add_argument("--temperature", help='of the raceways, such as "40 degC"; default: all of the map')
    parser.add_argument(
        "--contact", metavar="NAME", help="series | inner | outer | line; default: series, of a bare contact line"
    )
    parser.add_argument("--points", metavar="N", type=processes, default=200, help="loads of a curve; default: 200")


def _write(emap: EHDMap, path: Path, output: Path | None, arguments: argparse.Namespace) -> str:
    """Write the table; by default beside the map."""
    output = output or path.with_suffix(".csv")
    check_outputs([Output("-o", output, TABLE)], [path])
    write_text(output, table(emap, _chosen(arguments, emap), path.name), TABLE)
    return f"{output}: written"


def _chosen(arguments: argparse.Namespace, emap: EHDMap) -> Chosen:
    """Read what is asked for; all problems at once."""
    problems: list[str] = []
    names = [contact.name for contact in emap.contacts]
    kinds = ["series", *names] if "inner" in names else names
    kind = arguments.contact or kinds[0]
    if kind not in kinds:
        problems.append(f"--contact: got {kind!r:.60}; allowed in this map: {', '.join(kinds)}")

    def read(option: str, text: str | None, unit: str, axis: str, display: Display) -> tuple[float, ...]:
        values = emap.dataset[axis].values
        if text is None:
            return tuple(map(float, values))
        try:
            value = quantity(text, unit)
        except InputError as error:
            problems.append(f"{option}: {error.problems[0]}")
            return ()
        # A standstill is a point of some maps, but between it and the lowest speed films fade by another rule.
        low, high = float(min(values[values > 0.0], default=0.0)), float(values[-1])
        if not low <= value <= high and value not in values:
            problems.append(f"{option}: got {text!r}; allowed in this map: {display.text(low)} to {display.text(high)}")
        return (value,)

    speeds = read("--speed", arguments.speed, "m/s", "entrainment_speed", SPEED)
    temperatures = read("--temperature", arguments.temperature, "K", "temperature", TEMPERATURE)
    if arguments.points < 2:
        problems.append(f"--points: got {arguments.points}; allowed: 2 to 1024")
    if problems:
        raise InputError(problems)
    return Chosen(kind, speeds, temperatures, arguments.points)


TARGET = Target(
    summary="curves over load of stiffness, damping, approach and films",
    writes="MAP.csv",
    read_back_by="numpy",
    add_arguments=_add_arguments,
    write=_write,
)

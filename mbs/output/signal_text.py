"""Signals of sensors in words: mean, root mean square and largest value of each."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ehdmaps.units import MOTIONS, RPM, Display
from mbs.timedata.records import TimeRecord


def signal_lines(records: Sequence[TimeRecord]) -> list[str]:
    """A short table, a line a sensor and run; none without sensors.

    Parameters
    ----------
    records : sequence of TimeRecord
        Runs of the same channels, with their speed where it is known.
    """
    named = len(records) > 1
    widths = [max(map(len, [*texts, "sensor"])) for texts in ([c.name for c in records[0].sensors], _labels(records))]
    if not records[0].sensors:
        return []
    run = f"  {'run':<{widths[1]}}" if named else ""
    lines = [f"  {'sensor':<{widths[0]}}{run}         mean   rms about it    largest, at             unit"]
    for channel in records[0].sensors:
        for record in records:
            shown = MOTIONS.get(channel.unit, Display(channel.unit))
            values = shown.factor * record.column(channel)
            mean = float(values.mean())
            at = int(np.argmax(np.abs(values)))
            where = f"{record.time[at]:.4g} s"
            if record.speed is not None:
                where += f", {RPM.text(abs(float(record.speed[at])))}"
            of = f"  {record.label:<{widths[1]}}" if named else ""
            lines.append(
                f"  {channel.name:<{widths[0]}}{of} {mean:12.4g} {np.sqrt(np.mean((values - mean) ** 2)):14.4g} "
                f"{values[at]:10.4g}, {where:<18} {shown.unit}"
            )
    return lines


def _labels(records: Sequence[TimeRecord]) -> list[str]:
    """Labels of the runs."""
    return [record.label for record in records]

"""Lines of the excitation by bearings: variables of a dataset, and a table for people."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ehdmaps.arrays import variable
from ehdmaps.units import MOTIONS, RPM, written
from mbs.linearised.excitation import Excited
from mbs.linearised.linear import sensor_unit
from mbs.model.elements import Sensor
from mbs.output.results import MOTION_UNITS

MOST_ROWS = 12
"""Lines that are shown; datasets have all that were kept."""


def with_lines(
    dataset: xr.Dataset, found: Sequence[Excited | None], sensors: Sequence[Sensor], over: str = ""
) -> xr.Dataset:
    """The dataset with the excitation by bearings; the same without any.

    Parameters
    ----------
    dataset : Dataset
        Result of a linear analysis.
    found : sequence of Excited or None
        The lines of each of some cases, of one without `over`.
    sensors : sequence of Sensor
        What sees them.
    over : str
        Dim of the cases; what a case has not is not a number.
    """
    parts = [xr.Dataset() if one is None else _variables(one, sensors) for one in found]
    if not any(parts):
        return dataset
    return dataset.merge(xr.concat(parts, over, data_vars="all", join="outer") if over else parts[0])


def _variables(found: Excited, sensors: Sequence[Sensor]) -> xr.Dataset:
    """The lines of one case."""
    names = [f"{line.bearing}: {line.name} ({line.source})" for line in found.lines]
    dims = ("line_speed", "line", "sensor")
    words = "part of the signal: it is Re[signal exp(i order angle)]"
    return (
        xr.Dataset()
        .assign_coords(
            line=names,
            line_speed=variable("line_speed", found.speeds, "rad/s", "speed of the system"),
            sensor=[sensor.name for sensor in sensors],
        )
        .assign(
            line_order=variable("line", [line.order for line in found.lines], "1", "oscillations a turn of the system"),
            line_force=variable(
                dims[:2],
                np.linalg.norm(found.forces[..., :3], axis=2),
                "N",
                "amplitude of the force on the inner ring at held places, all directions",
            ),
            line_real=variable(dims, found.seen.real, MOTION_UNITS, f"real {words}"),
            line_imaginary=variable(dims, found.seen.imag, MOTION_UNITS, f"imaginary {words}"),
        )
    )


def line_rows(found: Excited | None, sensors: Sequence[Sensor]) -> list[str]:
    """Table of the largest lines; over several speeds each at the speed where it is largest.

    Parameters
    ----------
    found : Excited or None
        The lines.
    sensors : sequence of Sensor
        What sees them.
    """
    if found is None:
        return []
    several = found.speeds.size > 1
    shown = [MOTIONS[sensor_unit(sensor)] for sensor in sensors]
    heads = "".join(f"  {f'{sensor.name}/{unit.unit}':>12s}  deg" for sensor, unit in zip(sensors, shown, strict=True))
    place = "speed/rpm" if several else "frequency/Hz"
    largest = np.max(np.linalg.norm(found.forces[..., :3], axis=2), axis=0)
    rows = [f"excitation by bearings, largest{' over the speeds' if several else ''}: order, {place}, force/N{heads}"]
    for i in sorted(np.argsort(-largest)[:MOST_ROWS].tolist()):
        line, seen = found.lines[i], found.seen[:, i]
        at = int(np.argmax(np.max(np.abs(seen), axis=1, initial=0.0))) if several else 0
        where = RPM.value(float(found.speeds[at])) if several else line.order * found.speeds[at] / (2.0 * np.pi)
        cells = "".join(
            f"  {written(unit.factor * abs(value), 3):>12s} {np.degrees(np.angle(value)):4.0f}"
            for unit, value in zip(shown, seen[at].tolist(), strict=True)
        )
        force = np.linalg.norm(found.forces[at, i, :3])
        rows.append(f"  {line.order:9.4f} {where:9.5g} {force:9.3g}{cells}  {line.bearing}: {line.name}, {line.source}")
    return rows

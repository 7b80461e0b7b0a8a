"""Levels of run-ups: as labelled datasets with units, in words, and as differences between two laws."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray, variable
from ehdmaps.units import RPM, Display
from mbs.spectral.campbell import RunUpSpectra
from mbs.spectral.levels import Reference, level
from mbs.spectral.orders import OrderPeak

_PEAK = (
    ("order", "1", "order of a peak along the orders, strongest first"),
    ("speed", "rad/s", "speed of the system at the peak"),
    ("frequency", "Hz", "order times speed at the peak"),
    ("level", "dB", "level of the order at the peak"),
)


def campbell_dataset(
    laws: Sequence[str], results: Sequence[RunUpSpectra], reference: Reference, sensor: str
) -> xr.Dataset:
    """Levels over speed and frequency, sum level, mean spectrum over orders, single orders and their peaks.

    Parameters
    ----------
    laws : sequence of str
        Names of the contact laws.
    results : sequence of RunUpSpectra
        Spectra of each law, all of the same run, so that speeds, frequencies and orders are the same.
    reference : Reference
        Reference of the levels.
    sensor : str
        Whose signal it is.

    Raises
    ------
    ValueError
        If the results are not of the same run.
    """
    first = results[0]
    for result in results[1:]:
        if not np.array_equal(result.campbell.speeds, first.campbell.speeds):
            raise ValueError(
                "campbell_dataset: the results have different speeds; allowed: results of one speed profile"
            )
    unit, by_law = reference.text, ("law", "speed")
    lines, sums = (np.stack([getattr(one.campbell, name) for one in results]) for name in ("level", "sum_level"))
    of_turns = np.stack([level(one.spectra.mean(), reference.value) for one in results])
    variables: dict[str, Any] = {
        "level": variable((*by_law, "frequency"), lines, unit, "level of the lines, root mean square of a sine"),
        "sum_level": variable(by_law, sums, unit, "level of the root mean square of all lines together"),
        "time": variable("speed", first.campbell.time, "s", "middle of the window"),
        "order_level": variable(
            ("law", "order"), of_turns, unit, "level over orders, mean square of all windows over turns"
        ),
    }
    coordinates: dict[str, Any] = {
        "law": list(laws),
        "speed": variable("speed", first.campbell.speeds, "rad/s", "speed of the system"),
        "frequency": variable("frequency", first.campbell.frequencies, "Hz", "frequency"),
        "order": variable("order", first.spectra.orders, "1", "periods a turn of the system"),
    }
    if first.tracks is not None:
        tracks = np.stack([one.tracks.level(reference.value) for one in results if one.tracks is not None])
        words = "level of single orders; not a number above the band"
        variables["track_level"] = variable(("law", "track_speed", "track"), tracks, unit, words)
        coordinates |= {
            "track_speed": variable("track_speed", first.tracks.speeds, "rad/s", "speed of the system"),
            "track": variable("track", first.tracks.orders, "1", "periods a turn of the system"),
        }
        variables |= {
            f"peak_{name}": variable(("law", "peak"), _peaks(results, name), unit if name == "level" else of, words)
            for name, of, words in _PEAK
        }
    attributes = {
        "sensor": sensor,
        "quantity": reference.quantity,
        "reference": f"{reference.value:.0e} {reference.unit} (ISO 1683)",
        "window_s": first.campbell.window,
        "line_width_hz": first.campbell.line_width,
        "smear_of_the_highest_order_hz": first.campbell.smear,
        "order_window_turns": first.spectra.window,
    }
    if first.tracks is not None:
        attributes["track_window_turns"] = first.tracks.window
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)


def of_sensors(parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Datasets of several sensors as one, with the dim sensor in front; that of one sensor stays as it is.

    Parameters
    ----------
    parts : sequence of xarray.Dataset
        Datasets of `campbell_dataset`, one a sensor, of the same runs.
    """
    if len(parts) == 1:
        return parts[0]
    names = [str(part.attrs["sensor"]) for part in parts]
    units = {str(part["sum_level"].attrs["units"]) for part in parts}
    most = max(part.sizes.get("peak", 0) for part in parts)
    # A sensor with fewer peaks than another is filled with not a number.
    parts = [part.pad(peak=(0, most - part.sizes["peak"])) if "peak" in part.sizes else part for part in parts]
    joined = xr.concat(parts, "sensor", data_vars="all", coords="minimal", compat="override", combine_attrs="override")
    joined = joined.assign_coords(sensor=("sensor", np.array(names, dtype=np.str_)))
    joined["time"] = parts[0]["time"]
    attributes = {"long_name": "what the sensor measures, and the reference of its levels"}
    words = [f"{part.attrs['quantity']}, {part.attrs['reference']}" for part in parts]
    joined["sensor_reference"] = ("sensor", np.array(words, dtype=np.str_), attributes)
    if len(units) > 1:
        for variable in joined.data_vars.values():
            if str(variable.attrs.get("units", "")).startswith("dB re"):
                variable.attrs["units"] = "dB re the reference of the sensor"
    joined.attrs = {key: value for key, value in parts[0].attrs.items() if key not in ("quantity", "reference")}
    return joined.assign_attrs(sensor=", ".join(names))


def with_measured(dataset: xr.Dataset, measured: xr.Dataset) -> xr.Dataset:
    """The dataset with that of a measured run, whose variables and dims are called measured_...

    Parameters
    ----------
    dataset : xarray.Dataset
        Levels of simulated runs.
    measured : xarray.Dataset
        Levels of the measured run, from `of_sensors`; it has speeds and frequencies of its own.
    """
    alone = measured.isel(law=0, drop=True)
    own = [str(name) for name in (*alone.variables, *alone.dims) if name != "sensor"]
    renamed = alone.rename({name: f"measured_{name}" for name in dict.fromkeys(own)})
    if "sensor" in alone.dims and "sensor" in dataset.dims:
        renamed = renamed.drop_vars("measured_sensor_reference")
    attributes = {f"measured_{key}": value for key, value in measured.attrs.items()}
    return dataset.merge(renamed, join="outer", combine_attrs="override").assign_attrs(attributes)


def _peaks(results: Sequence[RunUpSpectra], name: str) -> FloatArray:
    """A value of all peaks, shape (laws, peaks); NaN where a law has fewer than another."""
    values = np.full((len(results), max(len(result.peaks) for result in results)), np.nan)
    for row, result in zip(values, results, strict=True):
        row[: len(result.peaks)] = [getattr(peak, name) for peak in result.peaks]
    return values


PEAKS = "  peaks along the orders: order   speed/rpm   frequency/Hz   level/dB   above its valleys/dB"
"""Heading of the lines of peaks."""

_HERTZ, _MILLISECOND = Display("Hz"), Display("ms", 1e3)


def resolution_lines(spectra: RunUpSpectra, highest: float) -> list[str]:
    """Tell how finely speed and frequency are resolved.

    Parameters
    ----------
    spectra : RunUpSpectra
        Spectra of one run.
    highest : float
        Highest frequency that was asked for [Hz].
    """
    campbell = spectra.campbell
    return [
        f"band {_HERTZ.text(campbell.frequencies[0])} to {_HERTZ.text(highest)}; windows of "
        f"{_MILLISECOND.text(campbell.window)}: lines are {campbell.line_width:.3g} Hz wide, the highest order sweeps "
        f"by {campbell.smear:.3g} Hz in one; order spectra over {spectra.spectra.window:.3g} turns"
        + (f", single orders over {spectra.tracks.window:.3g} turns" if spectra.tracks else "")
    ]


def highest_line(spectra: RunUpSpectra) -> str:
    """The highest sum level, and where.

    Parameters
    ----------
    spectra : RunUpSpectra
        Spectra of one run.
    """
    campbell = spectra.campbell
    at = int(np.argmax(campbell.sum_level))
    return f"highest sum level {campbell.sum_level[at]:.1f} dB at {RPM.text(float(campbell.speeds[at]))}"


def peak_line(peak: OrderPeak) -> str:
    """Line of a peak, below `PEAKS`.

    Parameters
    ----------
    peak : OrderPeak
        The peak.
    """
    return (
        f"  {peak.order:29.5g} {RPM.value(peak.speed):11.1f} {peak.frequency:14.5g} {peak.level:10.1f} "
        f"{peak.prominence:22.1f}"
    )


def peak_lines(spectra: RunUpSpectra) -> list[str]:
    """Lines of all peaks along the orders; none where no order was followed.

    Parameters
    ----------
    spectra : RunUpSpectra
        Spectra of one run.
    """
    if spectra.peaks:
        return [PEAKS, *map(peak_line, spectra.peaks)]
    return ["  no peak along the orders"] if spectra.tracks else []


def sensor_line(name: str, reference: Reference, spectra: RunUpSpectra) -> str:
    """One line on a sensor among several: highest sum level, and strongest peak along the orders.

    Parameters
    ----------
    name : str
        Name of the sensor.
    reference : Reference
        Reference of its levels.
    spectra : RunUpSpectra
        Levels of the sensor.
    """
    line = f"  {name} ({reference.text}): {highest_line(spectra)}"
    if not spectra.peaks:
        return line
    best = max(spectra.peaks, key=lambda peak: peak.level)
    return (
        f"{line}; strongest peak along the orders {best.level:.1f} dB, order {best.order:.5g} at "
        f"{RPM.text(best.speed)}, {best.frequency:.5g} Hz"
    )

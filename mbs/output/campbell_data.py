"""Campbell diagrams of one run-up with several contact laws, as a labelled dataset with units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray
from mbs.spectral.campbell import RunUpSpectra
from mbs.spectral.levels import Reference, level

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
    unit = reference.text
    variables: dict[str, Any] = {
        "level": (
            ("law", "speed", "frequency"),
            np.stack([result.campbell.level for result in results]),
            {"units": unit, "long_name": "level of the lines, root mean square of a sine"},
        ),
        "sum_level": (
            ("law", "speed"),
            np.stack([result.campbell.sum_level for result in results]),
            {"units": unit, "long_name": "level of the root mean square of all lines together"},
        ),
        "time": ("speed", first.campbell.time, {"units": "s", "long_name": "middle of the window"}),
        "order_level": (
            ("law", "order"),
            np.stack([level(result.spectra.mean(), reference.value) for result in results]),
            {"units": unit, "long_name": "level over orders, mean square of all windows over turns"},
        ),
    }
    coordinates: dict[str, Any] = {
        "law": list(laws),
        "speed": ("speed", first.campbell.speeds, {"units": "rad/s", "long_name": "speed of the system"}),
        "frequency": ("frequency", first.campbell.frequencies, {"units": "Hz", "long_name": "frequency"}),
        "order": ("order", first.spectra.orders, {"units": "1", "long_name": "periods a turn of the system"}),
    }
    if first.tracks is not None:
        tracks = [result.tracks for result in results if result.tracks is not None]
        variables["track_level"] = (
            ("law", "track_speed", "track"),
            np.stack([track.level(reference.value) for track in tracks]),
            {"units": unit, "long_name": "level of single orders; not a number above the band"},
        )
        coordinates |= {
            "track_speed": ("track_speed", first.tracks.speeds, {"units": "rad/s", "long_name": "speed of the system"}),
            "track": ("track", first.tracks.orders, {"units": "1", "long_name": "periods a turn of the system"}),
        }
        variables |= {
            f"peak_{name}": (
                ("law", "peak"),
                _peaks(results, name),
                {"units": unit if name == "level" else of, "long_name": words},
            )
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


def _peaks(results: Sequence[RunUpSpectra], name: str) -> FloatArray:
    """A value of all peaks, shape (laws, peaks); NaN where a law has fewer than another."""
    values = np.full((len(results), max(len(result.peaks) for result in results)), np.nan)
    for row, result in zip(values, results, strict=True):
        row[: len(result.peaks)] = [getattr(peak, name) for peak in result.peaks]
    return values

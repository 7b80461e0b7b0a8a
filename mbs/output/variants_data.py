"""Differences between two contact laws under single changes, as a labelled dataset with units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
import xarray as xr

from mbs.model.elements import Sensor
from mbs.spectral.levels import LevelDifference, Reference

_QUANTITIES = (
    ("median_difference", "median", "median of the differences of the sum level at the same speed"),
    ("low_difference", "low", "5 % of the windows differ by less"),
    ("high_difference", "high", "95 % of the windows differ by less"),
    ("energy_difference", "energy", "difference of the mean energies of all windows"),
    ("highest_difference", "highest", "difference of the highest sum levels, at any speed"),
)


class VariantRow(Protocol):
    """What is written of a change: see `mbs.analyses.variants.Variant`."""

    @property
    def key(self) -> str:
        """What was changed."""
        ...

    @property
    def value(self) -> str:
        """To what."""
        ...

    @property
    def differences(self) -> tuple[LevelDifference, ...]:
        """One a sensor, or none."""
        ...

    @property
    def problem(self) -> str:
        """Why there is none."""
        ...

    @property
    def outside(self) -> dict[str, int]:
        """Calls outside the map."""
        ...


def variants_dataset(rows: Sequence[VariantRow], sensors: Sequence[Sensor]) -> xr.Dataset:
    """The table of all changes and sensors; NaN where there is no result.

    Parameters
    ----------
    rows : sequence of VariantRow
        The base and all changes.
    sensors : sequence of Sensor
        The sensors, in the order of `VariantRow.differences`.
    """
    variables = {
        name: (
            ("variant", "sensor"),
            np.array(
                [
                    [getattr(entry, part) for entry in row.differences] if row.differences else [np.nan] * len(sensors)
                    for row in rows
                ],
                dtype=np.float64,
            ),
            {"units": "dB", "long_name": f"{words}, second law minus first"},
        )
        for name, part, words in _QUANTITIES
    }
    texts = {
        name: ("variant", [str(getattr(row, name)) for row in rows], {"long_name": words})
        for name, words in (
            ("key", "what was changed; empty for the base"),
            ("value", "to what it was changed"),
            ("problem", "why there is no result"),
        )
    }
    calls = np.array([sum(row.outside.values()) for row in rows], dtype=np.int64)
    outside = {"outside_calls": ("variant", calls, {"units": "1", "long_name": "law calls outside the map"})}
    return xr.Dataset(
        {**variables, **texts, **outside},
        coords={"sensor": [sensor.name for sensor in sensors]},
        attrs={"reference": "; ".join(dict.fromkeys(Reference.of(sensor).text for sensor in sensors))},
    )

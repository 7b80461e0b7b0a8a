"""Amplitude spectra about chosen speeds as variables of a dataset."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from mbs.spectral.spectra import AmplitudeSpectrum


def with_spectra(dataset: xr.Dataset, spectra: Sequence[Sequence[Sequence[AmplitudeSpectrum]]]) -> xr.Dataset:
    """The dataset of a run with spectra about some speeds; over the dim law where there is more than one run.

    Parameters
    ----------
    dataset : xarray.Dataset
        With the dim sensor, and law of several runs.
    spectra : sequence of sequence of sequence of AmplitudeSpectrum
        About each speed, of each run, of each sensor; all with one window.
    """
    if not spectra:
        return dataset
    values = np.array([[[found.amplitude for found in run] for run in about] for about in spectra])
    values = np.moveaxis(values, 1, 0)
    dims: tuple[str, ...] = ("law", "spectrum_speed", "sensor", "spectrum_frequency")
    if values.shape[0] == 1:
        values, dims = values[0], dims[1:]
    first = [about[0][0] for about in spectra]
    words = "amplitude of a sine at each line"
    window = f"window of {first[0].window:.6g} s about the speed"
    return dataset.assign(
        spectrum_amplitude=(dims, values, {"units": "by signal_unit", "long_name": f"{words}, {window}"}),
        spectrum_time=(
            "spectrum_speed",
            np.array([found.time for found in first]),
            {"units": "s", "long_name": "middle of the window"},
        ),
    ).assign_coords(
        spectrum_speed=(
            "spectrum_speed",
            np.array([found.speed for found in first]),
            {"units": "rad/s", "long_name": "speed in the middle of the window"},
        ),
        spectrum_frequency=("spectrum_frequency", first[0].frequencies, {"units": "Hz", "long_name": "frequency"}),
    )

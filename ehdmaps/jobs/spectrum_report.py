"""The response of contacts over frequency in words: a table a contact, and plain values as JSON has them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.jobs.job import Job
from ehdmaps.jobs.report import NONE_STATED
from ehdmaps.physics.solution import Status
from ehdmaps.units import COMPLIANCE, DAMPER, DAMPING, LENGTH, LOAD, SPEED, SPRING, STIFFNESS, TEMPERATURE

_COMPLEX = ("film_compliance", "film_stiffness", "dynamic_stiffness")


def spectrum_record(dataset: xr.Dataset, contact: str) -> dict[str, Any]:
    """Return the response of one contact as plain values, SI; None where there is no number.

    Complex variables become two lists, with `_real` and `_imaginary` behind their names.

    Parameters
    ----------
    dataset : xarray.Dataset
        See `ehdmaps.jobs.spectrum.spectrum_dataset`.
    contact : str
        Name of the contact.
    """
    chosen = dataset.sel(contact=contact)
    record: dict[str, Any] = {
        "status": Status(int(chosen["status"])).word,
        "reason": str(chosen["reason"].values),
        **{name: _plain(chosen[name].values[None])[0] for name in ("slow_stiffness", "slow_damping")},
        "frequency": dataset["frequency"].values.tolist(),
    }
    for name, entry in chosen.data_vars.items():
        if entry.dims != ("frequency",):
            continue
        if name in _COMPLEX:
            record[f"{name}_real"] = _plain(entry.values.real)
            record[f"{name}_imaginary"] = _plain(entry.values.imag)
        else:
            record[str(name)] = _plain(entry.values)
    return record


def _plain(values: np.ndarray) -> list[float | None]:
    """Numbers for JSON, which has no NaN."""
    return [value if math.isfinite(value) else None for value in values.tolist()]


def spectrum_table(job: Job, dataset: xr.Dataset, length: float | None) -> str:
    """Return the printed table: a block a contact, a line a frequency.

    Parameters
    ----------
    job : Job
        What the contacts belong to.
    dataset : xarray.Dataset
        See `ehdmaps.jobs.spectrum.spectrum_dataset`.
    length : float or None
        Length of a slice [m].
    """
    place = spectrum_place(dataset)
    if length is not None:
        place += f", slice of {LENGTH.text(length)} ({dataset.attrs['load'] * length:.5g} N)"
    law = job.contacts[0].structural_law
    head = f"{job.title}, {job.lubricant.title}, solver {dataset.attrs['solver']}, structural law {law}"
    lines = [head, *job.estimates, place]
    for contact in dataset["contact"].values.tolist():
        lines.extend(["", *_block(dataset.sel(contact=contact), contact, length)])
    return "\n".join(lines)


def spectrum_place(dataset: xr.Dataset) -> str:
    """Return the operating point of a response in words.

    Parameters
    ----------
    dataset : xarray.Dataset
        See `ehdmaps.jobs.spectrum.spectrum_dataset`.
    """
    load, speed, temperature = (dataset.attrs[name] for name in ("load", "entrainment_speed", "temperature"))
    return f"{LOAD.text(load)}, {SPEED.text(speed)}, {TEMPERATURE.text(temperature)}"


def _block(chosen: xr.Dataset, contact: str, length: float | None) -> list[str]:
    """The lines of a contact."""
    status, reason = Status(int(chosen["status"])), str(chosen["reason"].values)
    if not status.usable:
        return [f"{contact}: {status.word}; {reason}"]
    stiffness, damping = (float(chosen[f"slow_{name}"]) for name in ("stiffness", "damping"))
    slow = f"slow motion: k {STIFFNESS.text(stiffness, 5)}, c {DAMPING.text(damping, 5)}"
    lines = [f"{contact}: {status.word}; {slow}{f'; {reason}' if reason else ''}"]
    heads = ["frequency", "omega b/u", "k", "error", "c", "error", "S real", "S imag.", "error"]
    units = ["Hz", "", STIFFNESS.unit, "", DAMPING.unit, "", COMPLIANCE.unit, COMPLIANCE.unit, ""]
    names = ("frequency", "omega_b_over_u", "stiffness", "stiffness_error", "damping", "damping_error")
    columns = [chosen[name].values for name in names]
    k, c = columns[2], columns[4]
    columns[2], columns[4] = STIFFNESS.factor * k, DAMPING.factor * c
    film = COMPLIANCE.factor * chosen["film_compliance"].values
    columns += [film.real, film.imag, chosen["film_compliance_error"].values]
    if length is not None:
        heads[6:6] = ["k x length", "c x length"]
        units[6:6] = [SPRING.unit, DAMPER.unit]
        columns[6:6] = [SPRING.factor * k * length, DAMPER.factor * c * length]
    lines += ["".join(f"{word:>12s}" for word in words) for words in (heads, units)]
    for row in zip(*columns, strict=True):
        cells = (_error(value) if head == "error" else f"{value:12.5g}" for head, value in zip(heads, row, strict=True))
        lines.append("".join(cells) + ("  negative damping" if row[4] < 0.0 else ""))
    return lines


def _error(value: float) -> str:
    """An error in its column, in words where there is none."""
    return f"{NONE_STATED:>12s}" if math.isnan(value) else f"{value:12.1e}"

"""The response of contacts over frequency: one solution a contact; as a dataset, in words, and as JSON has it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.errors import InputError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.report import NONE_STATED
from ehdmaps.maps import schema
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolver, Status
from ehdmaps.physics.spectrum import ContactSpectrum, checked_frequencies, contact_spectrum
from ehdmaps.units import COMPLIANCE, DAMPER, DAMPING, LENGTH, SPRING, STIFFNESS, point_text

_VARIABLES: dict[str, tuple[str, str]] = {
    "film_compliance": ("m2 N-1", "complex film compliance S; 1/K = compliance of the solids + S"),
    "film_compliance_error": ("1", "estimated error of the film compliance, relative to abs(S)"),
    "film_stiffness": ("N m-2", "complex stiffness of the film alone, 1/S; its relative error is that of S"),
    "dynamic_stiffness": ("N m-2", "complex stiffness of film and solids, K = k + i omega c"),
    "dynamic_stiffness_error": ("1", "estimated error of the dynamic stiffness, relative to abs(K)"),
    "stiffness": ("N m-2", "stiffness k per unit length at the frequency"),
    "stiffness_error": ("1", "estimated error of k, relative to abs(k)"),
    "damping": ("N s m-2", "damping c per unit length at the frequency; negative where the film feeds the oscillation"),
    "damping_error": ("1", "estimated error of c, relative to abs(c)"),
}
"""Over contact and frequency: attributes of `ContactSpectrum` with their units and names."""


def spectrum_dataset(
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    point: OperatingPoint,
    frequencies: Sequence[float] | np.ndarray,
    solver: ContactSolver,
) -> xr.Dataset:
    """Solve contacts at one operating point and give their response over frequency.

    Parameters
    ----------
    contacts : sequence of LineContact
        Contacts with names apart.
    lubricant : Lubricant
        The oil.
    point : OperatingPoint
        Load, speed and temperature.
    frequencies : sequence of float or ndarray, shape (k,)
        [Hz].
    solver : ContactSolver
        What solves them.

    Returns
    -------
    xarray.Dataset
        Response over contact and frequency. A contact without a solution has NaN, a status and a reason.

    Raises
    ------
    InputError
        For frequencies that are not allowed, no contacts, or two of one name.
    """
    values = checked_frequencies(frequencies)
    names = [contact.name for contact in contacts]
    if not names or len(set(names)) < len(names):
        raise InputError(f"contacts: got {', '.join(names) or 'none'}; allowed: at least one, with names apart")
    spectra = [contact_spectrum(solver.film_spectrum(c, lubricant, point, values), c, point) for c in contacts]
    return xr.Dataset(
        {
            **{name: _over_both(spectra, name, *words) for name, words in _VARIABLES.items()},
            "omega_b_over_u": (("contact", "frequency"), _reduced(contacts, point, values), {"units": "1"}),
            **{f"slow_{name}": _slow(spectra, name) for name in ("stiffness", "damping")},
            "status": ("contact", [int(s.solution.status) for s in spectra], schema.variable("status").attributes()),
            "reason": ("contact", np.array([s.solution.reason for s in spectra], dtype=object)),
        },
        coords={
            "contact": ("contact", np.array(names, dtype=object)),
            "frequency": ("frequency", values, {"units": "Hz", "long_name": "frequency of a small oscillation"}),
        },
        attrs={
            "title": f"response over frequency, {lubricant.title}, by the solver {solver.name}",
            "solver": solver.name,
            "load": point.load,
            "entrainment_speed": point.entrainment_speed,
            "temperature": point.temperature,
        },
    )


def _over_both(spectra: Sequence[ContactSpectrum], name: str, unit: str, words: str) -> tuple[Any, ...]:
    """An attribute of all contacts over frequency."""
    values = np.stack([getattr(spectrum, name) for spectrum in spectra])
    return ("contact", "frequency"), values, {"units": unit, "long_name": words}


def _slow(spectra: Sequence[ContactSpectrum], name: str) -> tuple[Any, ...]:
    """A number of all contacts in the limit of slow motion."""
    values = [getattr(spectrum.solution, name) for spectrum in spectra]
    return "contact", values, schema.variable(name).attributes()


def _reduced(contacts: Sequence[LineContact], point: OperatingPoint, frequencies: np.ndarray) -> np.ndarray:
    """Omega b/u, shape (contacts, frequencies); infinite at a standstill."""
    widths = np.array([half_width(point.load, contact.radius, contact.reduced_modulus) for contact in contacts])
    with np.errstate(divide="ignore"):
        return np.asarray(2.0 * math.pi * frequencies * (widths / np.float64(point.entrainment_speed))[:, None])


_COMPLEX = ("film_compliance", "film_stiffness", "dynamic_stiffness")


def spectrum_record(dataset: xr.Dataset, contact: str) -> dict[str, Any]:
    """Return the response of one contact as plain values, SI; None where there is no number.

    Complex variables become two lists, with `_real` and `_imaginary` behind their names.

    Parameters
    ----------
    dataset : xarray.Dataset
        See `ehdmaps.jobs.solve.spectrum.spectrum_dataset`.
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
        See `ehdmaps.jobs.solve.spectrum.spectrum_dataset`.
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
        See `ehdmaps.jobs.solve.spectrum.spectrum_dataset`.
    """
    return point_text(*(dataset.attrs[name] for name in ("load", "entrainment_speed", "temperature")))


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

"""The response of contacts over frequency as a dataset: one solution a contact, all frequencies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.errors import InputError
from ehdmaps.maps import schema
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.physics.spectrum import ContactSpectrum, checked_frequencies, contact_spectrum

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

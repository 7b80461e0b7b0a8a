"""Films of a map -> approach, stiffness and damping, by the structural law of its contacts.

A map holds films. What contains the solids too is derived here, in one place: for a file that lacks it, for another
structural law, and to hold a file to what it states.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.maps import schema
from ehdmaps.maps.records import contacts_json
from ehdmaps.physics.contact import LineContact, Structured, structured

DERIVED = Structured._fields
"""Variables that are derived."""

MODEL_ERRORS = ("stiffness_model_error", "damping_model_error")
"""What remains to the solver that corrected a map, of quantities that contain the solids; see `_model_errors`."""

SAME = 1e-9
"""Relative difference up to which a derived variable is what its film and structural law say: far above the round-off
of a few operations and powers, far below any error of a solver."""

_FILM = ("film_offset", "film_compliance", "loss_compliance", "film_compliance_error", "loss_compliance_error")
_FILMS_SINCE = schema.variable("film_compliance").since


def derived(
    contacts: Sequence[LineContact], loads: FloatArray, films: Mapping[str, FloatArray]
) -> dict[str, FloatArray]:
    """Approach, stiffness and damping with their errors, by name.

    Parameters
    ----------
    contacts : sequence of LineContact
        Contacts in the order of the first axis of the films.
    loads : array
        w [N/m], that broadcasts to the films of one contact.
    films : mapping of str to array (contacts, ...)
        film_offset [m], film_compliance [m2/N], loss_compliance [m2 s/N], film_compliance_error, loss_compliance_error.
    """
    by_contact = [structured(contact, loads, *(films[name][i] for name in _FILM)) for i, contact in enumerate(contacts)]
    return {name: np.stack([getattr(one, name) for one in by_contact]) for name in DERIVED}


def completed(dataset: xr.Dataset, contacts: Sequence[LineContact]) -> xr.Dataset:
    """A map with all that follows from what it holds: of an old one the films, of others what is derived.

    Parameters
    ----------
    dataset : xarray.Dataset
        A valid map, of any version.
    contacts : sequence of LineContact
        Contacts of the map.
    """
    if schema.version_of(dataset) < _FILMS_SINCE:
        return dataset.assign(_typed(_films_of_old(dataset, contacts)))
    lacking = [name for name in DERIVED if name not in dataset]
    return dataset.assign(_typed(_derived(dataset, contacts, lacking))) if lacking else dataset


def restructured(dataset: xr.Dataset, contacts: Sequence[LineContact]) -> xr.Dataset:
    """The same films between solids of another structural law: a map of the latest version, with its attributes.

    Parameters
    ----------
    dataset : xarray.Dataset
        A map with its films, see `completed`.
    contacts : sequence of LineContact
        The contacts, with the other structural law.

    Raises
    ------
    InputError
        If that law does not hold for the loads of the map.
    """
    values = _derived(dataset, contacts, DERIVED)
    if all(name in dataset for name in MODEL_ERRORS):
        values |= _model_errors(dataset, values["stiffness"])
    return dataset.assign(_typed(values)).assign_attrs(
        schema_version=schema.SCHEMA_VERSION,
        structural_law=contacts[0].structural_law,
        structural_scaling=contacts[0].structural_scaling,
        contacts=contacts_json(contacts),
    )


def contradictions(dataset: xr.Dataset, contacts: Sequence[LineContact]) -> Iterator[str]:
    """Yield which derived variables are not what the films and the structural law of a map say.

    Parameters
    ----------
    dataset : xarray.Dataset
        A map whose variables are all of their shapes and types.
    contacts : sequence of LineContact
        Contacts of the map.
    """
    if schema.version_of(dataset) < _FILMS_SINCE:  # its films follow from what others derive: they cannot contradict
        yield from _load_problems(dataset, contacts)
        return
    stated = {contact.structural_law for contact in contacts}
    if stated != {dataset.attrs["structural_law"]}:
        yield (
            f"attribute structural_law is {dataset.attrs['structural_law']!r:.60}; the attribute contacts has "
            f"{', '.join(sorted(stated))}; they must be alike; generate the map again"
        )
        return
    too_wide = list(_load_problems(dataset, contacts))
    if too_wide:
        yield from too_wide
        return
    held = [name for name in DERIVED if name in dataset]
    expected = _derived(dataset, contacts, held)
    scales = {name: np.abs(values) for name, values in expected.items()}
    if "approach" in held:  # a difference, which may be nearly zero
        scales["approach"] = scales["approach"] + np.abs(dataset["film_offset"].values)
    for name in held:
        found = dataset[name].values
        with np.errstate(invalid="ignore"):
            alike = np.abs(found - expected[name]) <= SAME * scales[name]
        wrong = np.count_nonzero(~(alike | (np.isnan(found) & np.isnan(expected[name]))))
        if wrong:
            yield (
                f"variable {name} contradicts the films: {wrong} of {found.size} values are not what film_compliance, "
                f"loss_compliance, film_offset and the structural law {dataset.attrs['structural_law']} give; delete "
                f"{', '.join(DERIVED)} to have them derived again, or generate the map again"
            )


def _load_problems(dataset: xr.Dataset, contacts: Sequence[LineContact]) -> Iterator[str]:
    """Yield why a structural law does not hold for the highest load of a map."""
    for contact in contacts:
        try:
            contact.structural_approach(float(dataset["load"].values[-1]))
        except InputError as error:
            yield from error.problems


def _films_of_old(dataset: xr.Dataset, contacts: Sequence[LineContact]) -> dict[str, FloatArray]:
    """Film and loss compliance of version 1, which had stiffness and damping in their place; no error of the loss."""
    loads = dataset["load"].values.astype(np.float64)
    dry = np.array([contact.structural_compliance(loads) for contact in contacts])[:, :, None, None]
    stiffness = dataset["stiffness"].values.astype(np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        return {
            "film_compliance": 1.0 / stiffness - dry,
            "loss_compliance": dataset["damping"].values / stiffness**2,
            "loss_compliance_error": np.full(stiffness.shape, np.nan),
        }


def _derived(dataset: xr.Dataset, contacts: Sequence[LineContact], names: Sequence[str]) -> dict[str, FloatArray]:
    """Derived variables of a map."""
    loads = dataset["load"].values.astype(np.float64)[:, None, None]
    films = {name: dataset[name].values.astype(np.float64) for name in _FILM}
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        values = derived(contacts, loads, films)
    return {name: values[name] for name in names}


def _model_errors(dataset: xr.Dataset, stiffness: FloatArray) -> dict[str, FloatArray]:
    """Model errors by another structural law: that of k is k times that of the film compliance, which stays.

    That of c is made of independent ones, of the loss compliance, which stays, and of k^2.
    """
    of_k, of_c = (dataset[name].values.astype(np.float64) for name in MODEL_ERRORS)
    new = of_k * stiffness / dataset["stiffness"].values
    return dict(zip(MODEL_ERRORS, (new, np.sqrt(np.maximum(of_c**2 - 4.0 * of_k**2, 0.0) + 4.0 * new**2)), strict=True))


def _typed(values: Mapping[str, Any]) -> dict[str, xr.Variable]:
    """Variables of the table."""
    return {name: schema.typed(schema.variable(name), array) for name, array in values.items()}

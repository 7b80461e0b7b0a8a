"""Contacts, bearing and oil as the records in a map's attributes; from films to stiffness by the structural law.

A map holds films. What contains the solids too is derived here, in one place: for a file that lacks it, for another
structural law, and to hold a file to what it states.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, MapError
from ehdmaps.maps import schema
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact, Structured, structured
from ehdmaps.physics.lubricant import HEAT_CAPACITY, Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.surface import Surface
from ehdmaps.physics.viscosity import AstmViscosity, ConstantViscosity, ViscosityLaw, VogelViscosity, law_from_record

if TYPE_CHECKING:
    import xarray as xr

_UNREADABLE = (ValueError, KeyError, TypeError, AttributeError, ArithmeticError, RecursionError, InputError)
"""What reading an invalid record raises."""

_RADII, _MODULI = (1e-7, 1e3), (1e4, 1e14)
"""Reduced radii [m] and moduli [Pa]: far outside of every contact, what lies beyond is damage."""


def read_json(text: str, attribute: str) -> Any:
    """Value of an attribute in JSON; finite numbers and printable texts only.

    Parameters
    ----------
    text : str
        Text of the attribute.
    attribute : str
        Name of the attribute, for the message.

    Raises
    ------
    MapError
        If it is no such JSON.
    """
    try:
        value = json.loads(text, parse_constant=_refused)
        _check_texts(value)
        return value
    except _UNREADABLE as error:
        raise _broken(attribute, error) from error


def record_from_json(text: str, attribute: str) -> dict[str, Any]:
    """Record of an attribute in JSON, empty for null.

    Raises
    ------
    MapError
        If it is neither.
    """
    record = read_json(text, attribute)
    if record is not None and not isinstance(record, dict):
        raise _broken(attribute, TypeError(f"got a {type(record).__name__}"))
    return record or {}


def contacts_from_json(text: str) -> tuple[LineContact, ...]:
    """Contacts of a map, from its attribute `contacts`: a list of the fields of each `LineContact`.

    Raises
    ------
    MapError
        If the text is no such list.
    """
    try:
        return tuple(_contact(record) for record in read_json(text, "contacts"))
    except _UNREADABLE as error:
        raise _broken("contacts", error) from error


def contact_record(contact: LineContact) -> dict[str, Any]:
    """One contact as a record, see `contacts_from_json`.

    What heat needs of the material is left out where it is that of steel, and the approach by finite elements where
    there is none: records that were made before there was any are those of today.
    """
    record = asdict(contact)
    for name in ("conductivity", "heat_capacity"):
        if record["material"][name] == getattr(STEEL, name):
            del record["material"][name]
    if record["fe_approach"] is None:
        del record["fe_approach"]
    return record


def contacts_json(contacts: Sequence[LineContact]) -> str:
    """The attribute `contacts` of a map, see `contacts_from_json`."""
    records = [contact_record(contact) for contact in contacts]
    return json.dumps(records, sort_keys=True, allow_nan=False, ensure_ascii=False)


def reference_json(contact: LineContact) -> str:
    """The attribute `reference_contact` of a backbone."""
    return contacts_json((contact,))[1:-1]


def contacts_of(dataset: xr.Dataset) -> tuple[LineContact, ...]:
    """Contacts of a map, in the order of its contact axis.

    Raises
    ------
    MapError
        If its attribute `contacts` does not read, or has other names than the axis.
    """
    contacts = contacts_from_json(dataset.attrs["contacts"])
    axis = tuple(str(name) for name in np.atleast_1d(dataset["contact"].values))
    names = tuple(contact.name for contact in contacts)
    if names != axis:
        raise MapError(
            f"map, attribute contacts: names {', '.join(names)}; the contact axis has {', '.join(axis)}; "
            "they must be alike; generate the map again"
        )
    return contacts


_COUNT = re.compile(r"(number of rollers) (?=\d)")


def bearing_from_json(text: str) -> BearingGeometry | None:
    """Bearing of a map, from its attribute `geometry`: the fields of a `BearingGeometry`, or null.

    Raises
    ------
    MapError
        If the text is neither.
    """
    try:
        record = read_json(text, "geometry")
        if record is None:
            return None
        if record.get("estimated"):  # older maps say "number of rollers 1"
            record["estimated"] = _COUNT.sub(r"\1 +-", record["estimated"])
        return BearingGeometry(**record)
    except _UNREADABLE as error:
        raise _broken("geometry", error) from error


def lubricant_from_json(text: str) -> Lubricant:
    """Oil of a map, from its attribute `lubricant`: what `Lubricant.record` gives, "inf" for infinity.

    Raises
    ------
    MapError
        If the text is no such record.

    Examples
    --------
    >>> oil = Lubricant.roelands(viscosity=0.04, pressure_viscosity=1.7e-8, density=870.0, fitted_pressure=1e9)
    >>> lubricant_from_json(json.dumps(oil.record())) == oil
    True
    """
    try:
        record: dict[str, Any] = {
            key: float("inf") if value == "inf" else value for key, value in read_json(text, "lubricant").items()
        }
        return Lubricant(
            name=record["name"],
            verified=record["verified"],
            viscosity=_viscosity(record),
            pressure_viscosity=law_from_record(record),
            density_15=record["density_15"],
            density_slope=record["density_slope"],
            density_law=record["density_law"],
            fitted_pressure=record["fitted_pressure"],
            thermal_conductivity=record.get("thermal_conductivity"),
            heat_capacity=record.get("heat_capacity", HEAT_CAPACITY),
            correlation=record.get("correlation"),
            stated_coefficient=record.get("stated_coefficient"),
            stated_temperature=record.get("stated_temperature"),
            assumed=record.get("assumed", ""),
            label=record.get("label"),
            fitted_pressure_stated=record.get("fitted_pressure_stated") is True,
        )
    except _UNREADABLE as error:
        raise _broken("lubricant", error) from error


def supply_from_json(text: str) -> OilSupply:
    """Oil supply of a map, from its attribute `oil_supply`: the fields of an `OilSupply`, "inf" for infinity.

    Raises
    ------
    MapError
        If the text is no such record.

    Examples
    --------
    >>> supply_from_json('{"lubrication": "flooded", "oil_layer": "inf"}').flooded
    True
    """
    try:
        record = read_json(text, "oil_supply")
        if set(record) != {"oil_layer", "lubrication"}:
            raise KeyError(", ".join(map(str, record)))
        layer = math.inf if record["oil_layer"] == "inf" else record["oil_layer"]
        if isinstance(layer, bool):
            raise TypeError(f"got the layer {layer!r}")
        return OilSupply(layer, record["lubrication"])
    except _UNREADABLE as error:
        raise _broken("oil_supply", error) from error


def record_json(record: object) -> str:
    """Write a record of plain values or a dataclass as JSON, the same text for the same values.

    Infinity, which JSON does not know, becomes the word "inf".
    """
    if is_dataclass(record) and not isinstance(record, type):
        record = asdict(record)
    return json.dumps(_plain(record), sort_keys=True, allow_nan=False, ensure_ascii=False)


def _plain(value: object) -> object:
    """Return a value with every float finite or a word."""
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value


def surface_from_json(text: str) -> Surface:
    """Surfaces of a map, from its attribute `surface`: the fields of a `Surface`.

    Raises
    ------
    MapError
        If the text is no such record.

    Examples
    --------
    >>> surface_from_json('{"roughness": 2e-07}').label
    'roughness 0.2 um'
    """
    try:
        return Surface(**read_json(text, "surface"))
    except _UNREADABLE as error:
        raise _broken("surface", error) from error


def check_oil(lubricant: Lubricant, temperatures: Iterable[float]) -> None:
    """Refuse an oil that has no state at the temperatures of its map [K].

    Raises
    ------
    MapError
        If its record holds something else than numbers, or numbers that no oil has.
    """
    try:
        for temperature in temperatures:
            state = lubricant.at(temperature)
            numbers = (state.viscosity, state.density_ratio(1e8))
            alpha = state.pressure_viscosity.pressure_viscosity  # 0 of an isoviscous oil
            if not all(math.isfinite(number) and number > 0.0 for number in numbers) or not 0.0 <= alpha < math.inf:
                raise ValueError(f"viscosity, density and alpha of {(*numbers, alpha)} at {temperature:g} K")
    except _UNREADABLE as error:
        raise _broken("lubricant", error) from error


def _contact(record: Mapping[str, Any]) -> LineContact:
    """One contact, with lengths and moduli that the formulas stand."""
    contact = LineContact(**{**record, "material": Material(**record["material"])})
    _check_named(contact.name)
    for what, value, (low, high) in (("radius", contact.radius, _RADII), ("E'", contact.reduced_modulus, _MODULI)):
        if not low <= value <= high:
            raise ValueError(f"{what} of {value:g}; allowed: {low:g} to {high:g}")
    if not math.isfinite(contact.structural_approach(1.0)):
        raise ValueError("lengths of which no approach can be made")
    return contact


def _viscosity(record: Mapping[str, Any]) -> ViscosityLaw:
    """Viscosity over temperature."""
    word = record["viscosity_over_temperature"]
    if word == "constant":
        return ConstantViscosity(record["viscosity"])
    if word == "astm-d341":
        return AstmViscosity(record["viscosity_40"], record["viscosity_100"])
    if word == "vogel":
        return VogelViscosity(record["vogel_factor"], record["vogel_slope"], record["vogel_offset"])
    raise KeyError(word)


def _refused(constant: str) -> float:
    """Refuse NaN and Infinity, which are no JSON."""
    raise ValueError(f"got {constant}")


def _check_texts(value: Any) -> None:
    """Refuse control characters: what a record holds is printed."""
    if isinstance(value, dict):
        for key, entry in value.items():
            _check_texts(key)
            _check_texts(entry)
    elif isinstance(value, list):
        for entry in value:
            _check_texts(entry)
    elif isinstance(value, str) and not value.isprintable():
        raise ValueError(f"control characters in {value!r:.60}")


def _check_named(name: object) -> None:
    """Refuse a name that is no text."""
    if not isinstance(name, str):
        raise TypeError(f"got the name {name!r:.60}")


def _broken(attribute: str, error: Exception) -> MapError:
    """Say that an attribute does not read."""
    return MapError(
        f"map, attribute {attribute}: does not read ({type(error).__name__}: {error!s:.300}); "
        "expected the record that `ehdmaps generate` writes; generate the map again"
    )


DERIVED = Structured._fields
"""Variables that are derived."""

MODEL_ERRORS = ("stiffness_model_error", "damping_model_error")
"""What remains to the solver that corrected a map, of quantities that contain the solids; see `_model_errors`."""

SPACING_ERRORS = ("film_offset_spacing_error", "stiffness_spacing_error", "damping_spacing_error")
"""What laws lose between the points of a map that has no lines, see `ehdmaps.jobs.make.spacing`."""

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
    if all(name in dataset for name in SPACING_ERRORS):
        values |= _spacing_errors(dataset, values["stiffness"])
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


def _spacing_errors(dataset: xr.Dataset, stiffness: FloatArray) -> dict[str, FloatArray]:
    """Spacing errors of k and c by another structural law; that of c has the one of k^2, at worst with its sign."""
    _, of_k, of_c = (dataset[name].values.astype(np.float64) for name in SPACING_ERRORS)
    new = of_k * stiffness / dataset["stiffness"].values
    return dict(zip(SPACING_ERRORS[1:], (new, np.maximum(of_c - 2.0 * of_k, 0.0) + 2.0 * new), strict=True))


def _typed(values: Mapping[str, Any]) -> dict[str, xr.Variable]:
    """Variables of the table."""
    return {name: schema.typed(schema.variable(name), array) for name, array in values.items()}

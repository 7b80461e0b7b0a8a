"""Contacts, bearing and oil from the records in a map's attributes, so that a map stands alone."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from ehdmaps.errors import InputError, MapError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.pressure_viscosity import Barus, Fva3, PressureViscosityLaw, Roelands
from ehdmaps.physics.solids import Material
from ehdmaps.physics.viscosity import AstmViscosity, ConstantViscosity, ViscosityLaw, VogelViscosity


def contacts_from_json(text: str) -> tuple[LineContact, ...]:
    """Contacts of a map, from its attribute `contacts`: a list of the fields of each `LineContact`.

    Raises
    ------
    MapError
        If the text is no such list.
    """
    try:
        return tuple(_contact(record) for record in json.loads(text))
    except (ValueError, KeyError, TypeError, InputError) as error:
        raise _broken("contacts", error) from error


def bearing_from_json(text: str) -> BearingGeometry | None:
    """Bearing of a map, from its attribute `geometry`: the fields of a `BearingGeometry`, or null.

    Raises
    ------
    MapError
        If the text is neither.
    """
    try:
        record = json.loads(text)
        return None if record is None else BearingGeometry(**record)
    except (ValueError, TypeError, InputError) as error:
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
            key: float("inf") if value == "inf" else value for key, value in json.loads(text).items()
        }
        return Lubricant(
            name=record["name"],
            verified=record["verified"],
            viscosity=_viscosity(record),
            pressure_viscosity=_isotherms(record),
            density_15=record["density_15"],
            density_slope=record["density_slope"],
            density_law=record["density_law"],
            fitted_pressure=record["fitted_pressure"],
            thermal_conductivity=record.get("thermal_conductivity"),
            correlation=record.get("correlation"),
            label=record.get("label"),
        )
    except (ValueError, KeyError, TypeError, AttributeError, InputError) as error:
        raise _broken("lubricant", error) from error


def _contact(record: Mapping[str, Any]) -> LineContact:
    """One contact."""
    return LineContact(**{**record, "material": Material(**record["material"])})


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


def _isotherms(record: Mapping[str, Any]) -> PressureViscosityLaw:
    """Viscosity over pressure."""
    cold, hot = record.get("pressure_viscosity_40"), record.get("pressure_viscosity_100")
    word = record["viscosity_law"]
    if word == "barus":
        return Barus(record["pressure_viscosity_40"], record["pressure_viscosity_100"])
    if word == "roelands":
        return Roelands(record.get("roelands_z"), cold, hot)
    if word == "fva3":
        numbers = {key: record[key] for key in ("a1", "a2", "b1", "b2")}
        return Fva3(**numbers, pressure_viscosity_40=cold, pressure_viscosity_100=hot)
    raise KeyError(word)


def _broken(attribute: str, error: Exception) -> MapError:
    """Say that an attribute does not read."""
    return MapError(
        f"map, attribute {attribute}: does not read ({type(error).__name__}: {error}); "
        "expected the record that `ehdmaps generate` writes; generate the map again"
    )

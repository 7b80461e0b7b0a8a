"""The text of a job file from values in SI: the way back from `reader`."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BEARINGS, BearingGeometry
from ehdmaps.physics.catalogue import estimate
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import LUBRICANTS, Lubricant
from ehdmaps.physics.solids import Material

Entry = str | int | float | bool

_BEARING_LENGTHS = ("inner_raceway_diameter", "outer_raceway_diameter", "roller_diameter", "roller_length")
_OIL_UNITS = {
    "viscosity": "Pa s",
    "viscosity_40": "m^2/s",
    "viscosity_100": "m^2/s",
    "pressure_viscosity_40": "1/Pa",
    "pressure_viscosity_100": "1/Pa",
    "density_slope": "kg/(m^3 K)",
    "fitted_pressure": "Pa",
}


def job_text(
    solids: BearingGeometry | LineContact,
    material: Material,
    lubricant: Lubricant,
    axes: Sequence[Iterable[float]],
    solver: Mapping[str, Entry],
) -> str:
    """Write a job file.

    Parameters
    ----------
    solids : BearingGeometry or LineContact
        Geometry for [bearing] or [contact].
    material : Material
        Material for [material].
    lubricant : Lubricant
        Oil for [lubricant].
    axes : sequence of three iterables of float
        Loads [N/m], entrainment speeds [m/s], temperatures [K].
    solver : mapping
        All keys of [solver].

    Raises
    ------
    InputError
        For an estimated bearing whose designation is not known.
    """
    name, keys = ("contact", _contact(solids)) if isinstance(solids, LineContact) else ("bearing", _bearing(solids))
    loads, speeds, temperatures = axes
    tables: dict[str, dict[str, Entry | list[str]]] = {
        name: dict(keys),
        "material": {
            "youngs_modulus": _quantity(material.youngs_modulus, "Pa"),
            "poisson_ratio": material.poisson_ratio,
            "density": _quantity(material.density, "kg/m^3"),
        },
        "lubricant": dict(_lubricant(lubricant)),
        "grid": {
            "load": [_quantity(value, "N/m") for value in loads],
            "entrainment_speed": [_quantity(value, "m/s") for value in speeds],
            "temperature": [_quantity(value, "K") for value in temperatures],
        },
        "solver": dict(solver),
    }
    lines = ["schema = 1"]
    for name, table in tables.items():
        lines += ["", f"[{name}]", *(f"{key} = {_toml(value)}" for key, value in table.items())]
    return "\n".join(lines) + "\n"


def _toml(value: object) -> str:
    """Return a value as TOML; its basic strings, numbers, switches and lists of strings are those of JSON."""
    return json.dumps(value, ensure_ascii=False)


def _quantity(value: float, unit: str) -> str:
    """Return a number with its unit, with all its digits; the reader keeps 15 of them."""
    return f"{float(value)!r} {unit}"


def _label(label: str | None) -> Iterator[tuple[str, Entry]]:
    """Yield a label where there is one."""
    if label is not None:
        yield "label", label


def _bearing(geometry: BearingGeometry) -> Iterator[tuple[str, Entry]]:
    """Yield the keys of [bearing]."""
    plain = replace(geometry, diametral_clearance=0.0)
    yield from _label(geometry.label)
    if plain == BEARINGS.get(geometry.name):
        yield "name", geometry.name
    elif geometry.estimated is None:
        for key in _BEARING_LENGTHS:
            yield key, _quantity(getattr(geometry, key), "m")
        yield "rollers", geometry.rollers
    elif _is_estimate(plain):
        yield "estimate", geometry.name
    else:
        raise InputError(
            f"bearing: got {geometry.name!r}, estimated from more than its designation; allowed: a bearing of known "
            "geometry, or one estimated by its designation; write a job file with estimate for this one"
        )
    yield "diametral_clearance", _quantity(geometry.diametral_clearance, "m")


def _is_estimate(plain: BearingGeometry) -> bool:
    """Whether a bearing is what its designation alone gives."""
    try:
        return estimate(plain.name) == plain
    except InputError:
        return False


def _contact(contact: LineContact) -> Iterator[tuple[str, Entry]]:
    """Yield the keys of [contact]."""
    yield "radius", _quantity(contact.radius, "m")
    for key, value in (("reference_depth", contact.reference_depth), ("roller_length", contact.roller_length)):
        if value is not None:
            yield key, _quantity(value, "m")


def _lubricant(oil: Lubricant) -> Iterator[tuple[str, Entry]]:
    """Yield the keys of [lubricant]: the name of a known oil, or the data of an own one."""
    yield from _label(oil.label)
    if oil.name in LUBRICANTS and oil == Lubricant.named(oil.name):
        yield "name", oil.name
        return
    record = oil.record()
    yield "viscosity_law", str(record["viscosity_law"])
    yield "density", _quantity(oil.density_15, "kg/m^3")
    yield "density_law", oil.density_law
    if oil.correlation is not None:
        yield "pressure_viscosity", oil.correlation
    if "roelands_z" in record:
        yield "roelands_z", float(record["roelands_z"])
    for key, unit in _OIL_UNITS.items():
        if key in record and not (oil.correlation and key.startswith("pressure_viscosity")):
            yield from _oil_quantity(key, float(record[key]), unit)


def _oil_quantity(key: str, value: float, unit: str) -> Iterator[tuple[str, Entry]]:
    """Yield a quantity of an oil; an isoviscous one has a key of its own."""
    if key.startswith("pressure_viscosity") and value == 0.0:
        if key.endswith("40"):
            yield "pressure_viscosity", "0 1/Pa"
    else:
        yield key, _quantity(value, unit)

"""The text of a job file from values in SI: the way back from `reader`."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from ehdmaps.errors import InputError
from ehdmaps.jobs.solids import solids_keys
from ehdmaps.jobs.supply import supply_keys, surface_keys
from ehdmaps.maps.backbone_plan import Steps
from ehdmaps.physics.bearing import BEARINGS, BearingGeometry
from ehdmaps.physics.catalogue import estimate, estimate_from_dimensions, static_rating
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.designations.clearance import MOUNTED
from ehdmaps.physics.lubricant import LUBRICANTS, Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.surface import Surface
from ehdmaps.physics.viscosity import PRESSURE_LAWS
from ehdmaps.units import quantity

Entry = str | int | float | bool
Value = Entry | Sequence[str] | Mapping[str, str] | Mapping[str, Entry]
BearingKeys = dict[str, Entry | Mapping[str, str]]

_BEARING_LENGTHS = ("inner_raceway_diameter", "outer_raceway_diameter", "roller_diameter", "roller_length")
_NAMED_SIZES = re.compile(r"bearing (\S+) x (\S+) x (\S+) mm")
"""Name of a bearing that was estimated from dimensions."""

_BARE = re.compile(r"[A-Za-z0-9_-]+")
"""Keys that TOML takes without quotes."""

_OIL_UNITS = {
    "viscosity": "Pa s",
    "viscosity_40": "m^2/s",
    "viscosity_100": "m^2/s",
    "pressure_viscosity_40": "1/Pa",
    "pressure_viscosity_100": "1/Pa",
    "density_slope": "kg/(m^3 K)",
    "fitted_pressure": "Pa",
}
_OIL_HEAT_UNITS = {"thermal_conductivity": "W/(m K)", "heat_capacity": "J/(kg K)"}


def job_text(
    solids: BearingGeometry | LineContact,
    material: Material,
    lubricant: Lubricant,
    axes: Sequence[Iterable[float]],
    solver: Mapping[str, Entry | Mapping[str, Entry]],
    supply: OilSupply | None = None,
    surface: Surface | None = None,
    correction: Mapping[str, Entry] | None = None,
    fe_approaches: Mapping[str, float] | None = None,
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
    supply : OilSupply, optional
        Oil supply for [supply]; no such table if left out.
    surface : Surface, optional
        Surfaces for [surface]; no such table if left out, or smooth.
    correction : mapping, optional
        All keys of [correction]; no such table if left out, or empty.
    fe_approaches : mapping of str to float, optional
        Approaches by finite elements for [solids] [m]; no such table if left out, or empty.

    Raises
    ------
    InputError
        For an estimated bearing, see `bearing_keys`.
    """
    loads, speeds, temperatures = axes
    tables: dict[str, Mapping[str, Value]] = {}
    if isinstance(solids, LineContact):
        tables["contact"] = dict(_contact(solids))
    else:
        tables["bearing"] = bearing_keys(solids)
    tables |= {
        "material": {
            "youngs_modulus": _quantity(material.youngs_modulus, "Pa"),
            "poisson_ratio": material.poisson_ratio,
            "density": _quantity(material.density, "kg/m^3"),
            **_solid_heat(material),
        },
        "lubricant": lubricant_keys(lubricant),
        **({} if supply is None else {"supply": supply_keys(supply)}),
        **({} if surface is None or surface.smooth else {"surface": surface_keys(surface)}),
        **({"solids": solids_keys(fe_approaches)} if fe_approaches else {}),
        "grid": {
            "load": [_quantity(value, "N/m") for value in loads],
            "entrainment_speed": [_quantity(value, "m/s") for value in speeds],
            "temperature": [_quantity(value, "K") for value in temperatures],
        },
        "solver": dict(solver),
        **({"correction": dict(correction)} if correction else {}),
    }
    lines = ["schema = 1"]
    for name, table in tables.items():
        lines += table_lines(name, table)
    return "\n".join(lines) + "\n"


def table_lines(name: str, table: Mapping[str, Value]) -> list[str]:
    """Return the lines of a table, with an empty one before it.

    Parameters
    ----------
    name : str
        Name of the table.
    table : mapping
        Keys with their values.
    """
    return ["", f"[{name}]", *(f"{_key(key)} = {_toml(value)}" for key, value in table.items())]


def tables_text(values: Mapping[str, object]) -> str:
    """Return the text of a job file from its tables as they were read: `tomllib`'s way back.

    Parameters
    ----------
    values : mapping
        Tables, and keys that stand before the first of them, by name. What no job file may hold (dates, lists of
        tables) becomes a text that its reader refuses.
    """
    lines = [f"{_key(key)} = {_toml(value)}" for key, value in values.items() if not isinstance(value, Mapping)]
    for key, value in values.items():
        if isinstance(value, Mapping):
            lines += table_lines(_key(key), value)
    return "\n".join(lines) + "\n"


def _key(key: str) -> str:
    """Return a key as it is, or in quotes where TOML wants them."""
    return key if _BARE.fullmatch(key) else _toml(key)


def _toml(value: object) -> str:
    """Return a value as TOML; its basic strings, numbers, switches and lists of strings are those of JSON."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {_toml(entry)}' for key, entry in value.items())} }}"
    # JSON escapes all that TOML wants escaped, but for this one.
    return json.dumps(value, ensure_ascii=False, default=str).replace("\x7f", "\\u007f")


def _quantity(value: float, unit: str) -> str:
    """Return a number with its unit, with all its digits; the reader keeps 15 of them."""
    return f"{float(value)!r} {unit}"


def _label(label: str | None) -> Iterator[tuple[str, Entry]]:
    """Yield a label where there is one."""
    if label is not None:
        yield "label", label


def steps_keys(steps: Steps) -> dict[str, Entry]:
    """Return the keys of line_steps in [solver].

    Parameters
    ----------
    steps : Steps
        Largest steps of refinement lines.
    """
    return {
        "load": steps.load,
        "entrainment_speed": steps.entrainment_speed,
        "temperature": _quantity(steps.temperature, "K"),
    }


def bearing_keys(geometry: BearingGeometry) -> BearingKeys:
    """Return the keys of [bearing].

    Parameters
    ----------
    geometry : BearingGeometry
        A named bearing, one by dimensions, or an estimated one.

    Raises
    ------
    InputError
        For an estimated bearing that is not what a designation, or dimensions and a rating, give.
    """
    plain, known, reach = geometry.without_clearance, BEARINGS.get(geometry.name), geometry.clearance_range
    if known is not None and plain == known.without_clearance:
        keys: BearingKeys = {"name": geometry.name}
    elif geometry.estimated is None:
        keys = {key: _quantity(getattr(geometry, key), "m") for key in _BEARING_LENGTHS}
        keys["rollers"] = geometry.rollers
        if geometry.row_distance is not None:
            keys["row_distance"] = _quantity(geometry.row_distance, "m")
    else:
        keys = _estimate_keys(plain)
    by_designation = reach is not None and reach.taken == MOUNTED and geometry.diametral_clearance == reach.clearance
    if reach is None or not by_designation or "rollers" in keys:
        keys["diametral_clearance"] = _quantity(geometry.diametral_clearance, "m")
    elif reach.typed:
        key = "name" if "name" in keys else "estimate"
        keys[key] = f"{keys[key]} {reach.name}"
    return dict(_label(geometry.label)) | keys


def _estimate_keys(plain: BearingGeometry) -> BearingKeys:
    """Return the keys of an estimated bearing, found back from its name and its rollers, and tried."""
    # The static rating is what gave the roller length; a rating is not stated to more than nine digits.
    rating = float(f"{static_rating(plain):.9g}")
    sizes = _NAMED_SIZES.fullmatch(plain.name)
    keys: BearingKeys = {"basic_static_rating": _quantity(rating, "N")}
    if sizes:
        bore, outside, width = (quantity(f"{size} mm", "m") for size in sizes.groups())
        keys["estimate"] = {
            key: f"{size} mm" for key, size in zip(("bore", "outside_diameter", "width"), sizes.groups(), strict=True)
        }
        if _gives(plain, lambda: estimate_from_dimensions(bore, outside, width, rating)):
            return keys
    elif _gives(plain, lambda: estimate(plain.name)):
        return {"estimate": plain.name}
    elif _gives(plain, lambda: estimate(plain.name, rating)):
        return {**keys, "estimate": plain.name}
    raise InputError(
        f"bearing: got {plain.name!r}, estimated from more than its designation, or dimensions, and its static rating; "
        "allowed: a bearing of known geometry, or one estimated from these; write a job file with estimate for this one"
    )


def _gives(plain: BearingGeometry, make: Callable[[], BearingGeometry]) -> bool:
    """Tell whether an estimate gives this bearing."""
    try:
        return make().without_clearance == plain
    except InputError:
        return False


def _contact(contact: LineContact) -> Iterator[tuple[str, Entry]]:
    """Yield the keys of [contact]."""
    yield "radius", _quantity(contact.radius, "m")
    for key, value in (("reference_depth", contact.reference_depth), ("roller_length", contact.roller_length)):
        if value is not None:
            yield key, _quantity(value, "m")


def lubricant_keys(oil: Lubricant) -> dict[str, Entry]:
    """Return the keys of [lubricant]: the name of a known oil, or the data of an own one.

    Parameters
    ----------
    oil : Lubricant
        The oil. What a job file cannot say of it is left out, see `ehdmaps.jobs.job.check_oil`.
    """
    return dict(_lubricant(oil))


def _lubricant(oil: Lubricant) -> Iterator[tuple[str, Entry]]:
    """Yield the keys of [lubricant]: the name of a known oil, or the data of an own one."""
    yield from _label(oil.label)
    record = oil.record()
    if oil.name in LUBRICANTS or oil.oil_class is not None:
        named = Lubricant.named(oil.name)
        heat = {key: getattr(oil, key) for key in _OIL_HEAT_UNITS if getattr(oil, key) != getattr(named, key)}
        if replace(named, **heat) == oil and None not in heat.values():
            yield "name", oil.name
            for key, value in heat.items():
                yield key, _quantity(value, _OIL_HEAT_UNITS[key])
            return
    assumed = oil.assumed.split(", ")
    yield "viscosity_law", str(record["viscosity_law"])
    yield "density", _quantity(oil.density_15, "kg/m^3")
    yield "density_law", oil.density_law
    if oil.stated_coefficient is not None and oil.stated_temperature is not None:
        yield "pressure_viscosity", _quantity(oil.stated_coefficient, "1/Pa")
        if "pressure_viscosity_temperature" not in assumed:
            yield "pressure_viscosity_temperature", _quantity(oil.stated_temperature, "K")
    elif "pressure_viscosity" in assumed:
        yield "pressure_viscosity", _quantity(float(record["pressure_viscosity_40"]), "1/Pa")
    elif oil.correlation is not None:
        yield "pressure_viscosity", oil.correlation
    for parameter in PRESSURE_LAWS[str(record["viscosity_law"])].parameters:
        if parameter.key in record:
            value = float(record[parameter.key])
            yield parameter.key, _quantity(value, parameter.unit) if parameter.unit else value
    for key, unit in _OIL_UNITS.items():
        estimated = oil.correlation is not None or "pressure_viscosity" in assumed
        derived = (
            (estimated and key.startswith("pressure_viscosity"))
            or (key == "fitted_pressure" and oil.reach_assumed)
            or key in assumed
        )
        if key in record and not derived:
            yield from _oil_quantity(key, float(record[key]), unit)
    for key, unit in _OIL_HEAT_UNITS.items():
        if key in record:
            yield key, _quantity(float(record[key]), unit)


def _solid_heat(material: Material) -> dict[str, Entry]:
    """Return what [material] says of heat: what is not that of steel."""
    units = {"conductivity": "W/(m K)", "heat_capacity": "J/(kg K)"}
    values = {key: getattr(material, key) for key in units}
    return {key: _quantity(value, units[key]) for key, value in values.items() if value != getattr(STEEL, key)}


def _oil_quantity(key: str, value: float, unit: str) -> Iterator[tuple[str, Entry]]:
    """Yield a quantity of an oil; an isoviscous one has a key of its own."""
    if key.startswith("pressure_viscosity") and value == 0.0:
        if key.endswith("40"):
            yield "pressure_viscosity", "0 1/Pa"
    else:
        yield key, _quantity(value, unit)

"""Heat and fits of a bearing: `thermal`, `fit` and `expansion` of [[bearings]] are read."""

from __future__ import annotations

from ehdmaps.jobs.table import Table
from ehdmaps.physics.contact import OIL_TEMPERATURES
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.units import LENGTH, PRESSURE, TEMPERATURE, Display
from mbs.bearings.thermal import EXPANSIONS, STEEL_EXPANSION, GivenTemperatures, HeatPaths, Mounting, Seat
from mbs.scene.fields import MICROMETRE

CONDUCTANCE = Display("W/K")
POWER = Display("W")
EXPANSION = Display("1/K")

_MOST_CONDUCTANCE, _MOST_POWER = 1e6, 1e6
_TIGHTEST = 1e-3
_CONDUCTANCES = ("shaft", "housing", "oil_flow", "raceways_to_oil", "between_raceways")
_SURROUNDINGS = ("shaft_temperature", "housing_temperature", "oil_inlet")
_FRICTION = {"load_friction": 0.1, "palmgren": 100.0}


def read_thermal(section: Table) -> GivenTemperatures | HeatPaths | None:
    """Read `thermal` of a bearing: temperatures of its raceways, or where its heat goes; None if absent or wrong.

    Parameters
    ----------
    section : Table
        The table of the bearing.
    """
    table = section.table("thermal", f"{section.where} thermal")
    if table is None:
        return None
    before = len(section.problems)
    inner, outer = (table.quantity(key, "K", *OIL_TEMPERATURES, TEMPERATURE) for key in ("inner_ring", "outer_ring"))
    paths = {key: table.quantity(key, "W/K", 0.0, _MOST_CONDUCTANCE, CONDUCTANCE) for key in _CONDUCTANCES}
    around = {key: table.quantity(key, "K", *OIL_TEMPERATURES, TEMPERATURE) for key in _SURROUNDINGS}
    friction = {key: table.number(key, 0.0, largest) for key, largest in _FRICTION.items()}
    power = table.quantity("constant_power", "W", 0.0, _MOST_POWER, POWER)
    table.close()
    rings = [key for key in ("inner_ring", "outer_ring") if key in table]
    balance = [key for key in (*_CONDUCTANCES, *_SURROUNDINGS, *_FRICTION, "constant_power") if key in table]
    idle = [
        f"{temperature} without {path}"
        for path, temperature in zip(("shaft", "housing", "oil_flow"), _SURROUNDINGS, strict=True)
        if temperature in table and path not in table
    ]
    if rings and balance:
        table.note(
            "",
            f"got {', '.join(rings)} and {', '.join(balance)}; allowed: temperatures of the rings, or paths "
            "of heat from which they follow",
        )
    elif not rings and not balance:
        table.note("", "got nothing; allowed: inner_ring and outer_ring, or paths of heat: " + ", ".join(_CONDUCTANCES))
    elif idle:
        table.note("", f"got {', '.join(idle)}; allowed: a temperature of what has a path of heat")
    if len(section.problems) > before:
        return None
    if rings:
        return GivenTemperatures(inner, outer)
    values = {**paths, **around, **friction, "constant_power": power}
    given = {key: value for key, value in values.items() if value is not None}
    return table.made(lambda: HeatPaths(**given))


def read_mounting(section: Table) -> Mounting | None:
    """Read `fit` and `expansion` of a bearing; None if both are absent, or wrong.

    Parameters
    ----------
    section : Table
        The table of the bearing.
    """
    expansion = _expansion(section)
    if "expansion" in section and "fit" not in section and "thermal" not in section:
        section.note("expansion", "has no effect; allowed: with thermal or fit")
    table = section.table("fit", f"{section.where} fit")
    if table is None:
        return None if expansion is None else Mounting(expansion=expansion)
    shaft = _seat(table, "inner", "bore", required=False)
    housing = _seat(table, "outer", "diameter", required=True)
    if "inner" not in table and "outer" not in table:
        table.note("", "got nothing; allowed: inner = { interference, seat }, outer = { interference, seat, diameter }")
    table.close()
    return Mounting(shaft, housing, STEEL_EXPANSION if expansion is None else expansion)


def _seat(fit: Table, key: str, far: str, *, required: bool) -> Seat | None:
    """Read the seat of a ring; `far` is the key of the bore of a shaft, or of the outside of a housing."""
    table = fit.table(key, f"{fit.where} {key}")
    if table is None:
        return None
    interference = table.quantity("interference", "m", -_TIGHTEST, _TIGHTEST, MICROMETRE, required=True)
    seat = table.quantity("seat", "m", 1e-5, 100.0, LENGTH, required=True)
    far_diameter = table.quantity(far, "m", 0.0, 100.0, LENGTH, required=required)
    modulus = table.quantity("youngs_modulus", "Pa", 1e6, 1e13, PRESSURE)
    ratio = table.number("poisson_ratio", -0.99, 0.499)
    expansion = _expansion(table)
    table.close()
    if interference is None or seat is None or (required and far_diameter is None):
        return None
    material = Material(
        STEEL.youngs_modulus if modulus is None else modulus, STEEL.poisson_ratio if ratio is None else ratio
    )
    return Seat(interference, seat, far_diameter or 0.0, material, STEEL_EXPANSION if expansion is None else expansion)


def _expansion(table: Table) -> float | None:
    """Read a coefficient of thermal expansion."""
    return table.quantity("expansion", "1/K", *EXPANSIONS, EXPANSION)

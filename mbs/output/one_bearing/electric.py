"""Electric numbers of one bearing of any kind: columns, lines, and a subcircuit for SPICE."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

from ehdmaps.electrics.dielectric import FIELDS, USUAL_FIELD
from ehdmaps.outputs import MARK, Kind, has_mark, write_text
from ehdmaps.units import FILM, written
from mbs.electrics import BearingElectrics, bearing_electrics
from mbs.output.one_bearing.kind import Column, Description, Number, Row, shown

CIRCUITS = Kind("a subcircuit of SPICE made by ehdmaps", (".cir",), has_mark)

_ROUGH = 3.0
"""Films over roughness below which asperities let a current through."""


def _number(name: str, unit: str, words: str, read: Callable[[BearingElectrics], float]) -> Number:
    """An electric number."""
    return Number(name, unit, words, lambda point, description: read(electrics(point, description)))


ELECTRIC = (
    Number("temperature", "K", "temperature of the raceways", lambda _, description: description.temperature),
    _number("capacitance", "F", "capacitance between the rings", lambda found: found.capacitance),
    _number("capacitance_low", "F", "its band: gas behind the contacts, errors of films", lambda found: found.low),
    _number("capacitance_high", "F", "its band: oil everywhere, errors of films", lambda found: found.high),
    _number("idle_capacitance", "1", "part of it of elements without load", lambda found: found.idle),
    _number("resistance", "ohm", "resistance between the rings; none without a conductivity", lambda f: f.resistance),
    _number("breakdown_film", "m", "film that breaks down first", lambda found: found.film),
    _number("breakdown_low", "V", f"breakdown at {FIELDS[0] / 1e6:g} V/um there", lambda found: found.breakdown[0]),
    _number("breakdown_high", "V", f"breakdown at {FIELDS[1] / 1e6:g} V/um there", lambda found: found.breakdown[1]),
)
"""Numbers of a bearing whose oil has a permittivity."""


def electrics(point: Any, description: Description) -> BearingElectrics:
    """Electric properties of a point.

    Parameters
    ----------
    point : object
        The point.
    description : Description
        Description with an oil and its dielectric.
    """
    assert description.oil is not None and description.dielectric is not None
    return _electrics(point, description.oil, description.temperature, description.dielectric)


_electrics = lru_cache(maxsize=4)(bearing_electrics)


def electric_lines(description: Description, row: Row) -> list[str]:
    """Lines on capacitance, time constant and breakdown of one point.

    Parameters
    ----------
    description : Description
        Description with its dielectric.
    row : mapping
        Numbers of the point.
    """
    oil = description.dielectric
    assert oil is not None
    if math.isnan(row["capacitance"]):
        return ["no capacitance: at rest, and without a film that is known, metal touches"]
    at, time = f"permittivity {oil.permittivity:g}", oil.time_constant
    if oil.temperature is not None:
        at += f" at {oil.temperature - 273.15:.4g} degC"
    capacitance, low, high = (1e12 * row[name] for name in ("capacitance", "capacitance_low", "capacitance_high"))
    constant = "R C not known without a conductivity"
    if not math.isnan(time):
        constant = f"R C {time:.3g} s, R {row['resistance']:.3g} ohm"
    rough = description.roughness * _ROUGH > row["breakdown_film"]
    return [
        f"capacitance {capacitance:.4g} pF ({low:.4g} to {high:.4g}: oil or gas behind the contacts, errors of films), "
        f"{row['idle_capacitance']:.0%} of it of elements without load; {at}, {constant}",
        f"breakdown at {_volts(row)} V, {row['breakdown_low'] * USUAL_FIELD / FIELDS[0]:.3g} V at the usual "
        f"{USUAL_FIELD / 1e6:g} V/um ({FIELDS[0] / 1e6:g} to {FIELDS[1] / 1e6:g} V/um of the smallest film, "
        f"{FILM.text(row['breakdown_film'])}; literature on bearing currents)"
        + (f"; that film is below {_ROUGH:g} times the roughness: asperities conduct at times" if rough else ""),
    ]


def _volts(row: Row) -> str:
    """Band of the breakdown."""
    if math.isnan(row["breakdown_low"]):
        return "-"
    return f"{written(row['breakdown_low'], 3)} to {written(row['breakdown_high'], 3)}"


COLUMNS = (
    Column("C", "pF", 8, lambda row: shown(1e12 * row["capacitance"], 4)),
    Column("breakdown", "V", 12, _volts),
)
"""Their columns in the table of several points."""


def circuit_text(name: str, heads: list[str], found: BearingElectrics) -> str:
    """Subcircuit of a bearing: capacitance, resistance, and a switch that closes when the film breaks down.

    Parameters
    ----------
    name : str
        Name of the bearing.
    heads : list of str
        What was computed.
    found : BearingElectrics
        Electric properties of the bearing.
    """
    resistance = found.resistance if math.isfinite(found.resistance) else _INSULATOR
    unknown = "" if math.isfinite(found.resistance) else "; no conductivity was stated"
    label = re.sub(r"[^A-Za-z0-9]+", "_", name).upper()
    low, high = found.breakdown
    return "\n".join(
        [
            f"* subcircuit {MARK}: bearing {name} between shaft and housing",
            *(f"* {line.strip()}" for line in heads),
            f"* capacitance {1e12 * found.low:.4g} to {1e12 * found.high:.4g} pF, breakdown {low:.4g} to {high:.4g} V: "
            "set vbd and c for the ends",
            f"* conduction: R{unknown}. After a breakdown the arc has ron, and goes out below vout.",
            f".subckt BEARING_{label} shaft housing c={found.capacitance:.6g} r={resistance:.6g} "
            f"vbd={found.usual_breakdown:.6g} ron=5 vout={0.05 * found.usual_breakdown:.6g}",
            "C1 shaft housing {c}",
            "R1 shaft housing {r}",
            "S1 shaft housing shaft housing FORWARD",
            "S2 shaft housing housing shaft FORWARD",
            ".model FORWARD sw vt={0.5*(vbd+vout)} vh={0.5*(vbd-vout)} ron={ron} roff={1e3*r}",
            ".ends",
            "",
        ]
    )


_INSULATOR = 1e12
"""Resistance of a bearing whose oil has no conductivity that is known [ohm]."""


def write_circuit(path: str | Path, name: str, heads: list[str], found: BearingElectrics) -> str:
    """Write the subcircuit, and return what was written in words.

    Parameters
    ----------
    path : str or Path
        The file, .cir.
    name : str
        Name of the bearing.
    heads : list of str
        What was computed.
    found : BearingElectrics
        Electric properties of the bearing.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    write_text(path, circuit_text(name, heads, found), CIRCUITS)
    return f"{path}: written (SPICE)"

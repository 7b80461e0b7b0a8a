"""The physical half of a job file: [bearing] or [contact], [material], [lubricant], and the axes of the grid."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, cast

from ehdmaps.errors import InputError, label_problem
from ehdmaps.jobs.solids import NO_SOLIDS, SolidsKeys, fe_approaches
from ehdmaps.jobs.table import Table
from ehdmaps.physics.approach import StructuralLaw
from ehdmaps.physics.bearing import BEARINGS, BearingGeometry
from ehdmaps.physics.catalogue import designated, estimate, estimate_from_dimensions
from ehdmaps.physics.contact import OIL_TEMPERATURES, LineContact
from ehdmaps.physics.designations.reader import ROLLERS, plain_name
from ehdmaps.physics.lubricant import DENSITY_LAWS, Lubricant
from ehdmaps.physics.own_oil import CORRELATIONS, Stated, stated_problems
from ehdmaps.physics.solids import STEEL, Material
from ehdmaps.physics.viscosity import PRESSURE_LAWS, Parameter
from ehdmaps.units import LENGTH, LOAD, RPM, SPEED, TEMPERATURE, Display, closest, short

MOST_VALUES = 100_000
"""Values on one axis; the product of the axes has its own limit."""


@dataclass(frozen=True)
class AxisRule:
    """Values that one axis of the grid may hold.

    Attributes
    ----------
    key, unit : str
        Name in [grid], SI unit.
    low, high : float
        Allowed values; wide enough for every bearing, tight enough to catch a wrong unit.
    display : Display
        Unit and format for messages.
    spacing : str, optional
        Spacing of an axis that states none; it must state one if left out.
    """

    key: str
    unit: str
    low: float
    high: float
    display: Display
    spacing: str | None = None


LOAD_AXIS = AxisRule("load", "N/m", 1.0, 1e7, LOAD)
SPEED_AXIS = AxisRule("entrainment_speed", "m/s", 0.0, 200.0, SPEED)
RING_SPEED_AXIS = AxisRule("inner_ring_speed", "rad/s", 0.0, 1e5, RPM)
TEMPERATURE_AXIS = AxisRule("temperature", "K", *OIL_TEMPERATURES, TEMPERATURE)


def read_speeds(grid: Table, bearing: BearingGeometry | None, known: bool = True) -> tuple[float, ...] | None:
    """Read the speed axis of [grid]: entrainment speeds, or speeds of the inner ring of a bearing.

    Parameters
    ----------
    grid : Table
        [grid].
    bearing : BearingGeometry or None
        Whose inner ring turns, the outer one fixed; None where there is none, or it was wrong already.
    known : bool
        False where the bearing was wrong already, which need not be said again.

    Returns
    -------
    tuple of float or None
        Rising entrainment speeds [m/s]; None where a problem was noted.
    """
    ring, own = RING_SPEED_AXIS.key, SPEED_AXIS.key
    if ring not in grid:
        return read_axis(grid, SPEED_AXIS)
    speeds = read_axis(grid, RING_SPEED_AXIS)
    if own in grid:
        grid.get(own)
        grid.note(ring, f"stands beside {own}; allowed: one of the two; delete one")
        return None
    if bearing is None and not known:
        return None
    if bearing is None:
        grid.note(ring, f"got no bearing to turn; allowed: with a [bearing]; give {own} in m/s for a bare contact")
        return None
    entrainment = tuple(bearing.entrainment_speed(speed) for speed in speeds or ())
    if entrainment and entrainment[-1] > SPEED_AXIS.high:
        limit = RPM.text(bearing.inner_speed(SPEED_AXIS.high))
        grid.note(ring, f"got {RPM.text((speeds or (0.0,))[-1])}; allowed: up to {limit} for this bearing")
        return None
    return entrainment or None


def read_axis(grid: Table, rule: AxisRule) -> tuple[float, ...] | None:
    """Read one axis of [grid].

    Returns
    -------
    tuple of float or None
        Rising values in SI; None where a problem was noted.
    """
    form = '{ from = "...", to = "...", points = ..., spacing = "log" } or a list of strings'
    value = grid.get(rule.key, required=form)
    if rule.key not in grid:
        return None
    if isinstance(value, dict):
        return _spaced(Table(value, f"{grid.where} {rule.key}", grid.problems), rule)
    if isinstance(value, list):
        return _listed(value, grid, rule)
    grid.note(rule.key, f"got {short(value)}; allowed: {form}")
    return None


def _spaced(table: Table, rule: AxisRule) -> tuple[float, ...] | None:
    """Read the from-to-points form."""
    before = len(table.problems)
    first = table.quantity("from", rule.unit, rule.low, rule.high, rule.display, required=True)
    last = table.quantity("to", rule.unit, rule.low, rule.high, rule.display, required=True)
    points = table.integer("points", 2, MOST_VALUES, required=True)
    spacing = table.choice("spacing", ("log", "linear"), required=rule.spacing is None) or rule.spacing
    table.close()
    if first is not None and last is not None and not first < last:
        table.note("from", f"got {rule.display.text(first)}, not below to = {rule.display.text(last)}; exchange them")
    if first is not None and first <= 0 and spacing == "log":
        table.note(
            "from",
            f'got {rule.display.text(first)}; a log axis starts above zero; raise it or use spacing = "linear"',
        )
    if len(table.problems) > before or first is None or last is None or points is None:
        return None
    steps = [index / (points - 1) for index in range(1, points - 1)]
    if spacing == "log":
        inside = [first * math.exp(step * math.log(last / first)) for step in steps]
    else:
        inside = [first + step * (last - first) for step in steps]
    values = (first, *inside, last)
    if any(b <= a for a, b in pairwise(values)):
        table.note("points", f"got {points}; the values fall together; use fewer, or a wider range")
        return None
    return values


def _listed(entries: list[object], grid: Table, rule: AxisRule) -> tuple[float, ...] | None:
    """Read the list form."""
    if not entries:
        grid.note(rule.key, "got an empty list; allowed: at least one value")
        return None
    if len(entries) > MOST_VALUES:
        grid.note(rule.key, f"got {len(entries)} values; allowed: at most {MOST_VALUES}")
        return None
    before = len(grid.problems)
    values = [
        grid.quantity_of(entry, f"{rule.key}[{index}]", rule.unit, rule.low, rule.high, rule.display)
        for index, entry in enumerate(entries)
    ]
    known = [value for value in values if value is not None]
    if len(grid.problems) > before or len(known) < len(values):
        return None
    for index in range(1, len(known)):
        if known[index] <= known[index - 1]:
            word = "twice" if known[index] == known[index - 1] else "after " + rule.display.text(known[index - 1])
            grid.note(
                rule.key,
                f"got {rule.display.text(known[index])} {word}; allowed: rising values, each once; sort the list",
            )
            return None
    return tuple(known)


_BEARING_LENGTHS = ("inner_raceway_diameter", "outer_raceway_diameter", "roller_diameter", "roller_length")
_ROLLER_KEYS = (*_BEARING_LENGTHS, "rollers", "row_distance")
_BEARING_KEYS = (*_ROLLER_KEYS, "diametral_clearance")

_CATALOGUE_LENGTHS = ("bore", "outside_diameter", "width")
_CATALOGUE_FORM = '{ bore = "30 mm", outside_diameter = "62 mm", width = "16 mm" } with basic_static_rating'

_VISCOSITY = Display("mPa s", 1e3)
_KINEMATIC = Display("mm^2/s", 1e6)
_COEFFICIENT = Display("1/GPa", 1e9)
_GPA = Display("GPa", 1e-9)
_DENSITY = Display("kg/m^3")
_CONDUCTIVITY = Display("W/(m K)")
_HEAT_CAPACITY = Display("J/(kg K)")

_OIL_HEAT: dict[str, tuple[str, float, float, Display]] = {
    "thermal_conductivity": ("W/(m K)", 1e-2, 10.0, _CONDUCTIVITY),
    "heat_capacity": ("J/(kg K)", 100.0, 1e4, _HEAT_CAPACITY),
}
"""Keys that may stand beside the name of an oil: nobody knows them of every named one."""

_OIL_QUANTITIES: dict[str, tuple[str, float, float, Display]] = {
    "viscosity": ("Pa s", 1e-5, 1e3, _VISCOSITY),
    "viscosity_40": ("m^2/s", 1e-7, 1e-1, _KINEMATIC),
    "viscosity_100": ("m^2/s", 1e-7, 1e-1, _KINEMATIC),
    "pressure_viscosity_40": ("1/Pa", 1e-10, 1e-7, _COEFFICIENT),
    "pressure_viscosity_100": ("1/Pa", 1e-10, 1e-7, _COEFFICIENT),
    "pressure_viscosity_temperature": ("K", 243.15, 473.15, TEMPERATURE),
    "density": ("kg/m^3", 300.0, 3000.0, _DENSITY),
    "density_slope": ("kg/(m^3 K)", -5.0, 0.0, Display("kg/(m^3 K)")),
    "fitted_pressure": ("Pa", 1e7, 1e10, _GPA),
}
_LAW_PARAMETERS = {parameter.key: parameter for law in PRESSURE_LAWS.values() for parameter in law.parameters}
_OIL_KEYS = ("viscosity_law", *_OIL_QUANTITIES, "pressure_viscosity", *_LAW_PARAMETERS, "density_law")
_OIL_STATED = (
    "viscosity", "viscosity_40", "viscosity_100",
    "pressure_viscosity", "pressure_viscosity_40", "pressure_viscosity_100", "pressure_viscosity_temperature",
)  # fmt: skip
"""Keys of `Stated`, in its order."""

_ISOVISCOUS = ("0 1/GPa", "0 1/Pa")


def read_contacts(
    top: Table, law: str | None, solids: SolidsKeys = NO_SOLIDS, key: str = "law"
) -> tuple[BearingGeometry | None, tuple[LineContact, ...]]:
    """Read [bearing] or [contact], and [material].

    Parameters
    ----------
    top : Table
        The whole file.
    law : str or None
        Structural law; None where it was wrong already.
    solids : SolidsKeys
        What [solids] says.
    key : str
        Name of the key with the law, for messages.

    Returns
    -------
    bearing, contacts
        The bearing (None for a [contact]); no contacts where a problem was noted.
    """
    section = top.table("material", "[material]")
    material = _material(section) if section else STEEL
    bare = top.table("contact", "[contact]")
    rolling = top.table("bearing", "[bearing]")
    if bare and rolling:
        top.note("[contact]", "stands beside [bearing]; allowed: one of the two; delete one")
    if not bare and not rolling and "contact" not in top and "bearing" not in top:
        top.note("bearing", "missing; allowed: [bearing] with a name or dimensions, or [contact] with a radius")
    # A law that was wrong already must not hide problems of the geometry.
    checked = cast(StructuralLaw, law or "half_space")
    bearing = _bearing(rolling) if rolling else None
    if bare:
        contact = _contact(bare, material or STEEL, checked, law is not None, solids.approaches.get("line"))
        return bearing, (contact,) if contact and not rolling else ()
    if bearing is None:
        return None, ()
    approaches = solids.approaches
    if approaches and set(approaches) != {"inner", "outer"}:  # `check_solids` says so
        return bearing, ()
    if checked == "fe":
        try:
            approaches = fe_approaches(solids, bearing, material or STEEL, key)
        except InputError as error:
            top.problems.extend(error.problems)
            return bearing, ()
    return bearing, bearing.contacts(material or STEEL, checked, approaches)


def _material(section: Table) -> Material | None:
    """Read [material]."""
    modulus = section.quantity("youngs_modulus", "Pa", 1e8, 2e12, _GPA)
    ratio = section.number("poisson_ratio", 0.0, 0.499)
    density = section.quantity("density", "kg/m^3", 500.0, 25000.0, _DENSITY)
    conductivity = section.quantity("conductivity", "W/(m K)", 0.1, 1e4, _CONDUCTIVITY)
    capacity = section.quantity("heat_capacity", "J/(kg K)", 10.0, 1e4, _HEAT_CAPACITY)
    section.close()
    return section.made(
        lambda: Material(
            STEEL.youngs_modulus if modulus is None else modulus,
            STEEL.poisson_ratio if ratio is None else ratio,
            STEEL.density if density is None else density,
            STEEL.conductivity if conductivity is None else conductivity,
            STEEL.heat_capacity if capacity is None else capacity,
        ),
    )


def _bearing(section: Table) -> BearingGeometry | None:
    """Read [bearing]: a name, or dimensions."""
    label = _label(section)
    if "estimate" in section:
        return _estimate(section, "estimate", label)
    if "name" in section:
        known = _known(section)
        if known is None:
            return _estimate(section, "name", label)
        clearance = _clearance(section)
        for key in _ROLLER_KEYS:
            if key in section:
                section.get(key)
                section.note(key, "stands beside name; allowed: a name, or dimensions without a name; delete one")
        section.close(others=("estimate", *_BEARING_KEYS))
        named = replace(known, label=label)
        return named if clearance is None else section.made(lambda: named.with_clearance(clearance))
    if not any(key in section for key in _BEARING_KEYS):
        section.note(
            "name", f"missing; allowed: a designation such as 'NU206'; or give {', '.join(_BEARING_KEYS)}, or estimate"
        )
        section.close(others=("name", "estimate", "basic_static_rating", *_BEARING_KEYS))
        return None
    lengths = [section.quantity(key, "m", 1e-5, 100.0, LENGTH, required=True) for key in _BEARING_LENGTHS]
    rollers = section.integer("rollers", 1, 10000, required=True)
    apart = section.quantity("row_distance", "m", 1e-5, 100.0, LENGTH)
    play = _clearance(section)
    if "diametral_clearance" not in section:
        section.note("diametral_clearance", 'missing; allowed: a length; "0 mm" if unknown')
    section.close(others=("name", "estimate", "basic_static_rating"))
    inner, outer, diameter, length = lengths
    if inner is None or outer is None or diameter is None or length is None or rollers is None or play is None:
        return None
    roller = f"{diameter * 1e3:g} x {length * 1e3:g} mm"
    name = f"bearing {inner * 1e3:g}/{outer * 1e3:g} mm, {rollers} rollers {roller}"
    return section.made(
        lambda: BearingGeometry(name, inner, outer, diameter, length, rollers, play, label, row_distance=apart),
    )


def _known(section: Table) -> BearingGeometry | None:
    """Read the name of a bearing whose inner geometry is known; None for any other."""
    name = section.get("name")
    if not isinstance(name, str) or plain_name(name, ROLLERS) not in BEARINGS:
        return None
    return section.made(lambda: designated(name), "name") or BEARINGS[plain_name(name, ROLLERS)]


def _estimate(section: Table, word: str, label: str | None) -> BearingGeometry | None:
    """Read a bearing that is estimated: by its designation, or a table of its catalogue dimensions.

    It stands under the key `word`: estimate; or name, which takes a designation alone.
    """
    value = section.get(word)
    rating = section.quantity("basic_static_rating", "N", 1e2, 1e9, Display("kN", 1e-3))
    clearance = _clearance(section)
    for key in ("name", *_ROLLER_KEYS):
        if key in section and key != word:
            section.get(key)
            section.note(key, f"stands beside {word}; allowed: one of the two; delete one")
    section.close(others=("name", "estimate", *_BEARING_KEYS))
    if isinstance(value, dict) and word == "estimate":
        table = Table(value, f"{section.where} estimate", section.problems)
        sizes = [table.quantity(key, "m", 1e-3, 10.0, LENGTH, required=True) for key in _CATALOGUE_LENGTHS]
        table.close()
        if rating is None and "basic_static_rating" not in section:
            section.note(
                "basic_static_rating", 'missing; allowed: C0 of the catalogue beside a table of dimensions, "78 kN"'
            )
        bore, outside, width = sizes
        if bore is None or outside is None or width is None or rating is None:
            return None
        made = section.made(lambda: estimate_from_dimensions(bore, outside, width, rating))
    elif isinstance(value, str):
        made = section.made(lambda: estimate(value, rating), word)
        if rating is None and "basic_static_rating" in section:
            return None
    else:
        more = f", or {_CATALOGUE_FORM}" if word == "estimate" else ""
        section.note(word, f'got {short(value)}; allowed: a designation such as "NU206"{more}')
        return None
    if made is None or (clearance is None and "diametral_clearance" in section):
        return None
    estimated = replace(made, label=label)
    return estimated if clearance is None else section.made(lambda: estimated.with_clearance(clearance))


def _label(section: Table) -> str | None:
    """Read a label; None where there is none, or a problem was noted."""
    label = section.get("label")
    if "label" not in section:
        return None
    problems = label_problem(label)
    for problem in problems:
        section.note("label", problem)
    return None if problems else str(label)


def _clearance(section: Table) -> float | None:
    """Read the clearance; an interference is a negative one."""
    return section.quantity("diametral_clearance", "m", -1e-2, 1e-2, LENGTH)


def _contact(
    section: Table, material: Material, law: StructuralLaw, law_known: bool, fe_approach: float | None
) -> LineContact | None:
    """Read [contact]."""
    radius = section.quantity("radius", "m", 1e-5, 100.0, LENGTH, required=True)
    depth = section.quantity("reference_depth", "m", 1e-5, 100.0, LENGTH)
    length = section.quantity("roller_length", "m", 1e-5, 100.0, LENGTH)
    section.close()
    given_wrong = ("reference_depth" in section and depth is None) or ("roller_length" in section and length is None)
    if radius is None or given_wrong or not law_known:
        return None
    return section.made(lambda: LineContact("line", radius, material, law, length, depth, fe_approach))


def read_lubricant(section: Table) -> Lubricant | None:
    """Read [lubricant]: a name, or a viscosity law with its data.

    Returns
    -------
    Lubricant or None
        None where a problem was noted.
    """
    label = _label(section)
    stated_heat = {key: section.quantity(key, *rule) for key, rule in _OIL_HEAT.items()}
    heat: dict[str, Any] = {key: value for key, value in stated_heat.items() if value is not None}
    if "name" in section:
        name = section.get("name")
        for key in _OIL_KEYS:
            if key in section:
                section.get(key)
                section.note(key, "stands beside name; allowed: a name, or data without a name; delete one")
        section.close(others=_OIL_KEYS)
        if not isinstance(name, str):
            section.note("name", f"got {short(name)}; allowed: the name of an oil, such as 'FVA3' or 'ISO VG 46'")
            return None
        return section.made(lambda: replace(Lubricant.named(name), label=label, **heat))
    law = section.choice("viscosity_law", tuple(PRESSURE_LAWS), required=True)
    values: dict[str, Any] = {
        key: section.quantity(key, *rule, required=key == "density") for key, rule in _OIL_QUANTITIES.items()
    }
    values["pressure_viscosity"] = _pressure_viscosity(section)
    density_law = section.choice("density_law", DENSITY_LAWS)
    numbers = {parameter.key: _law_parameter(section, parameter, law) for parameter in _LAW_PARAMETERS.values()}
    if density_law is not None:
        values["density_law"] = density_law
    section.close(others=("name",))
    read = values | numbers | stated_heat
    wrong = [key for key in read if key in section and read[key] is None]
    if law is None or wrong or values["density"] is None:
        whole = Stated(*(math.nan if key in wrong else values[key] for key in _OIL_STATED))
        for problem in stated_problems("own oil", law, whole):
            section.note("", problem)
        return None
    given = {key: value for key, value in values.items() if value is not None}
    stated = {_LAW_PARAMETERS[key].field: value for key, value in numbers.items() if value is not None}
    return section.made(lambda: replace(Lubricant.own(law, stated, **given, **heat), label=label))


def _law_parameter(section: Table, parameter: Parameter, law: str | None) -> float | None:
    """Read a number of the law over pressure; note it where it belongs to another one."""
    key = parameter.key
    if law is None or parameter in PRESSURE_LAWS[law].parameters:
        needed = law is not None and PRESSURE_LAWS[law].coefficient == "none"
        if not parameter.unit:
            return section.number(key, parameter.low, parameter.high, required=needed)
        display = Display(*parameter.shown)
        return section.quantity(key, parameter.unit, parameter.low, parameter.high, display, required=needed)
    if key in section:
        section.get(key)
        owners = [repr(word) for word, kind in PRESSURE_LAWS.items() if parameter in kind.parameters]
        allowed = f"with {' or '.join(owners)} only"
        section.note(key, f"stands beside viscosity_law = {law!r}; allowed: {allowed}; delete it")
    return None


def _pressure_viscosity(section: Table) -> float | str | None:
    """Read alpha: a quantity, zero for an isoviscous oil, or the name of a correlation."""
    text = section.get("pressure_viscosity")
    if "pressure_viscosity" not in section:
        return None
    if isinstance(text, str) and text in CORRELATIONS:
        return text
    if text in _ISOVISCOUS:
        return 0.0
    if isinstance(text, str) and text[:1].isalpha():
        allowed = tuple(CORRELATIONS)
        names = ", ".join(repr(name) for name in allowed)
        section.note(
            "pressure_viscosity",
            f'got {short(text)}{closest(text, allowed)}; allowed: a quantity such as "22.4 1/GPa", "0 1/GPa" for an '
            f"isoviscous oil, or a correlation: {names}",
        )
        return None
    return section.quantity_of(text, "pressure_viscosity", "1/Pa", 1e-10, 1e-7, _COEFFICIENT)

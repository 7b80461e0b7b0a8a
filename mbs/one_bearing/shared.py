"""Options that bearings of several kinds have in common: loads and speeds, refusals, the damper of the law, the oil."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ehdmaps.choices import read_option, texts_of
from ehdmaps.errors import InputError, Problems, problems_after
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OIL_TEMPERATURES
from ehdmaps.physics.designations.clearance import clearance_range
from ehdmaps.physics.heat import ISOTHERMAL, heat_data, heat_in_force
from ehdmaps.physics.lubricant import DEFAULT_OIL, Lubricant
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.surface import CrownedProfile, TabulatedProfile
from ehdmaps.units import RPM, TEMPERATURE, Display, closest, quantity, short, whole_number
from mbs.one_bearing.family import Family, Operating
from mbs.output.one_bearing.table import WIDE_RANGE
from mbs.scene.choices import OPTIONS
from mbs.scene.contact_laws import HERTZ_FORMS, Damper, hertz_damper
from mbs.scene.fields import FORCE, MICROMETRE
from mbs.scene.map_set import TABLE_LAW

if TYPE_CHECKING:
    from ehdmaps.electrics.dielectric import Dielectric
    from ehdmaps.physics.point.ball_geometry import BallGeometry
    from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry

CELSIUS_40 = 313.15
"""Temperature of the raceways that is assumed where nothing is given [K]."""


MOST_POINTS = 500

LOADS, SPEEDS = (1e-3, 1e7), (0.0, 1e5 * math.pi / 30.0)
"""Smallest and largest load [N] and speed [rad/s]."""

SLOWEST = 1e-6
"""Smallest speed that is not zero [rad/s]: a turn in two months. Groups of films are no numbers below."""


def read_choices(arguments: argparse.Namespace, problems: Problems) -> dict[str, Any]:
    """Values that were chosen, once each, by the names of the choices."""
    chosen: dict[str, Any] = {}
    for choice in OPTIONS:
        texts = texts_of(arguments, choice)
        if len(texts) > 1:
            problems.append(
                f"--{choice.name}: got {len(texts)} of them; allowed: one; run the command again for another"
            )
        for value in choice.values(texts[:1], problems):
            chosen[choice.name] = value
    for one in chosen.get("know", ()):
        if one.bearing:
            problems.append(f"--know: got {short(one.text)}; allowed: without a bearing, as there is one")
        if one.value is not None:
            chosen[one.group] = one.value
    return chosen


def read_direction(given: Sequence[str] | None, problems: Problems) -> tuple[float, float]:
    """Unit vector of the load: an angle from y towards z, or two components."""
    allowed = 'an angle from y towards z, such as "30 deg", or two numbers, the parts along y and z, not both zero'
    texts = list(given or ["0 deg"])
    try:
        if len(texts) == 1:
            angle = math.radians(float(texts[0])) if _is_number(texts[0]) else quantity(texts[0], "rad")
            parts = (math.cos(angle), math.sin(angle))
        else:
            y, z = (float(text) for text in texts)
            size = math.hypot(y, z)
            parts = (y / size, z / size)
    except (ValueError, ZeroDivisionError, InputError):
        parts = (math.nan, math.nan)
    if not np.all(np.isfinite(parts)):
        problems.append(f"--direction: got {' '.join(texts)!r:.80}; allowed: {allowed}")
        return 1.0, 0.0
    # No part of a load along an axis by round-off.
    clean = [0.0 if abs(part) < 1e-15 else part for part in parts]
    return clean[0], clean[1]


def _is_number(text: str) -> bool:
    """Tell whether a text is a bare number."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def read_values(
    option: str,
    given: Sequence[Sequence[str]],
    unit: str,
    limits: tuple[float, float],
    display: Display,
    problems: Problems,
) -> tuple[float, ...]:
    """Rising values of an option: single ones, and ranges FROM TO POINTS, evenly spaced, wide ones in the logarithm.

    Parameters
    ----------
    option : str
        Name of the option; begins the messages.
    given : sequence of sequences of str
        What was given for it, once for each time that it was given.
    unit : str
        Unit of the values.
    limits : (float, float)
        Smallest and largest allowed value [unit].
    display : Display
        How messages show values.
    problems : Problems
        Takes what is wrong.
    """
    found: list[float] = []
    for texts in given:
        if len(texts) not in (1, 3):
            problems.append(
                f"{option}: got {len(texts)} values ({' '.join(texts)!r:.60}); allowed: one, or FROM TO POINTS; give "
                "the option more than once for a list"
            )
            continue
        before = len(problems)
        read = [_quantity(option, text, unit, limits, display, problems) for text in texts[:2]]
        ends = [value for value in read if value is not None]
        if len(texts) == 1:
            found += ends
            continue
        points = read_whole(f"{option}, POINTS", texts[2], 2, MOST_POINTS, problems)
        if len(problems) > before:
            continue
        low, high = ends
        if not low < high:
            problems.append(f"{option}: got {texts[0]!r} to {texts[1]!r}; allowed: rising")
            continue
        space = np.geomspace if 0.0 < WIDE_RANGE * low < high else np.linspace
        # Numbers as they were typed, and not one bit beside.
        found += [float(f"{value:.12g}") for value in space(low, high, points)]
    return tuple(sorted(set(found)))


def read_one(
    option: str,
    text: str | None,
    unit: str,
    limits: tuple[float, float],
    display: Display,
    default: float,
    problems: Problems,
) -> float:
    """One value, or its default where none was given, or where a problem was noted.

    Parameters
    ----------
    option : str
        Name of the option; begins the messages.
    text : str or None
        Text that was given.
    unit : str
        Unit of the value.
    limits : (float, float)
        Smallest and largest allowed value [unit].
    display : Display
        Form in which messages show values.
    default : float
        Value where none was given [unit].
    problems : Problems
        List that takes what is wrong.
    """
    value = None if text is None else _quantity(option, text, unit, limits, display, problems)
    return default if value is None else value


def _quantity(
    option: str, text: str, unit: str, limits: tuple[float, float], display: Display, problems: Problems
) -> float | None:
    """One quantity within its limits, of which speeds are zero or no longer next to it; None with the problem noted."""
    value = read_option(option, text, unit, limits, display, problems)
    if value is not None and unit == "rad/s" and 0.0 < abs(value) < SLOWEST:
        problems.append(f"{option}: got {short(text)}; allowed: zero, or from {display.text(SLOWEST)} up")
        return None
    return value


def read_whole(option: str, text: str, low: int, high: int, problems: Problems) -> int:
    """A whole number; the lowest one where a problem was noted.

    Parameters
    ----------
    option, text : str
        Name of the option, and what was given.
    low, high : int
        Smallest and largest allowed number.
    problems : Problems
        List that takes what is wrong.
    """
    with problems.after(f"{option}: "):
        return whole_number(text, low, high)
    return low


def read_operating(arguments: argparse.Namespace, problems: Problems, *, axial: bool = True) -> Operating:
    """Loads and speeds, of which there may not be too many.

    Parameters
    ----------
    arguments : Namespace
        Options as they were parsed.
    problems : Problems
        What is wrong; added to.
    axial : bool
        Whether the bearing takes an axial load and a speed of its outer ring.
    """
    pushed, outer = (arguments.axial, arguments.outer_speed) if axial else (None, None)
    along = read_one("--axial", pushed, "N", (-LOADS[1], LOADS[1]), FORCE, 0.0, problems)
    loads = read_values("--load", arguments.load, "N", (0.0 if along else LOADS[0], LOADS[1]), FORCE, problems)
    speeds = read_values("--speed", arguments.speed, "rad/s", SPEEDS, RPM, problems)
    turning = read_one("--outer-speed", outer, "rad/s", (-SPEEDS[1], SPEEDS[1]), RPM, 0.0, problems)
    if len(loads) * len(speeds) > MOST_POINTS:
        problems.append(f"--load, --speed: got {len(loads) * len(speeds)} points; allowed: at most {MOST_POINTS}")
    return Operating(loads, along, read_direction(arguments.direction, problems), speeds, turning)


def refuse_others(arguments: argparse.Namespace, chosen: Mapping[str, Any], family: Family, problems: Problems) -> None:
    """Note options that are for bearings of other families.

    Parameters
    ----------
    arguments : Namespace
        Options as they were parsed.
    chosen : mapping of str to object
        Choices that were given, by their names.
    family : Family
        Family of the bearing.
    problems : Problems
        What is wrong; added to.
    """
    given = [f"--{name}" for name in chosen if name not in (*family.taken, "know")]
    given += [
        f"--{name}"
        for name, usual in _OWN.items()
        if name not in family.own and getattr(arguments, name.replace("-", "_")) != usual
    ]
    if given:
        axial = ("axial", "outer-speed", "tilts") if family.kind.axial else ()
        allowed = ", ".join(f"--{name}" for name in (*family.taken, *family.own, "oil", *axial, "direction", "plot"))
        problems.append(f"{', '.join(given)}: not for {family.words}s; allowed: {allowed} and -o; leave it out")


_OWN = {
    "ring-temperatures": None,
    "profile": "iso",
    "slices": "41",
    "coupled": False,
}
"""Options that some families take, as they are where nothing is given."""


def read_law(chosen: Mapping[str, Any], family: Family, problems: Problems) -> tuple[str, Damper | None]:
    """The law, that of the map or the film table if none is chosen, and its damper; None where a problem was noted.

    Parameters
    ----------
    chosen : mapping of str to object
        Choices by their names.
    family : Family
        Family of the bearing.
    problems : Problems
        What is wrong; added to.
    """
    law: str = chosen.get("law", "map" if "map" in family.film_laws and "map" in chosen else TABLE_LAW)
    if law in family.film_laws:
        return law, Damper()
    if (own := family.own_law(law)) is not None:
        problems += own
        return law, Damper()
    damper: Damper | None = None
    with problems:
        damper = hertz_damper(law)
        if damper is None:
            near = closest(law, ("hertz", *family.film_laws))
            more = "".join(f", {name}" for name in family.film_laws) + family.beside_laws
            raise InputError(f"--law: got {short(law)}{near} for a {family.words}; allowed: hertz, {HERTZ_FORMS}{more}")
    return law, damper


def read_rings(arguments: argparse.Namespace, chosen: Mapping[str, Any], problems: Problems) -> tuple[float, float]:
    """Temperatures of the inner and the outer raceway [K], that of --temperature where they have none of their own.

    Parameters
    ----------
    arguments : Namespace
        Options as they were parsed.
    chosen : mapping of str to object
        Choices by their names.
    problems : Problems
        What is wrong; added to.
    """
    around, given = float(chosen.get("temperature", CELSIUS_40)), arguments.ring_temperatures
    if "temperature" in chosen and given is not None:
        problems.append(
            f"--temperature: got {TEMPERATURE.text(around)} with --ring-temperatures; allowed: one of the two"
        )
    inner, outer = (
        read_one("--ring-temperatures", text, "K", OIL_TEMPERATURES, TEMPERATURE, around, problems)
        for text in given or (None, None)
    )
    return inner, outer


def read_profile_text(
    text: str, geometry: BearingGeometry | None, problems: Problems
) -> str | CrownedProfile | TabulatedProfile:
    """The profile of cylindrical rollers; "iso" where a problem was noted.

    Parameters
    ----------
    text : str
        Value as a scene writes it.
    geometry : BearingGeometry or None
        Geometry of the bearing; None where a problem of it was noted.
    problems : Problems
        What is wrong; added to.
    """
    if text in ("iso", "straight"):
        return text
    from ehdmaps.jobs.profiles import profile_from_text  # with the reader of tables, which names do not need

    return profile_from_text(text, geometry, problems)


def assumed_clearance(geometry: BearingGeometry | BallGeometry | TaperedGeometry, given: bool) -> list[str]:
    """The clearance in words, where it is one that nobody stated.

    Parameters
    ----------
    geometry : BearingGeometry, BallGeometry or TaperedGeometry
        The bearing.
    given : bool
        Whether the option --clearance was given.
    """
    reach = clearance_range(geometry)
    if given or geometry.thrust:
        return []
    return ["no clearance" if reach is None else reach.words]


def read_oil(
    name: str | None, temperature: float, problems: Problems, usual: Lubricant | None = None
) -> Lubricant | None:
    """The oil, which must suit the temperature; None where a problem was noted.

    Parameters
    ----------
    name : str or None
        Name as it was typed; None for the usual oil.
    temperature : float
        Temperature of the raceways [K].
    problems : Problems
        What is wrong; added to.
    usual : Lubricant, optional
        The usual oil; FVA 3 if left out.
    """
    with problems:
        with problems_after("--oil: "):
            oil = usual if name is None and usual is not None else Lubricant.named(name or DEFAULT_OIL)
        with problems_after("--temperature: "):
            oil.at(temperature)
        return oil
    return None


def read_dielectric(text: str | None, problems: Problems) -> Dielectric | None:
    """The oil as a dielectric; None where none was given, or a problem was noted.

    Parameters
    ----------
    text : str or None
        A permittivity, or a table in braces.
    problems : Problems
        List that takes what is wrong.

    Examples
    --------
    >>> read_dielectric('{ value = 2.2, at = "40 degC", outlet = "series" }', Problems()).outlet
    'series'
    """
    if text is None:
        return None
    from ehdmaps.electrics.dielectric import CONDUCTIVITIES, LARGEST, OUTLETS, Dielectric  # with what only it needs
    from ehdmaps.jobs.table import Table, inline

    option = "--permittivity"
    value = inline(text, option, problems) if text.lstrip().startswith("{") else {"value": _number_or_text(text)}
    if value is None:
        return None
    noted: list[str] = []
    table = Table(value, option, noted)
    permittivity = table.number("value", 1.0, LARGEST, required=True)
    known_at = table.quantity("at", "K", *OIL_TEMPERATURES, TEMPERATURE)
    conductivity = table.quantity("conductivity", "S/m", *CONDUCTIVITIES, Display("S/m"))
    chosen = table.choice("outlet", OUTLETS)
    gap = table.quantity("outer_gap", "m", 1e-7, 1e-2, MICROMETRE)
    table.close()
    problems += noted
    if noted or permittivity is None:
        return None
    with problems.after(f"{option}: "):
        outlet = next((one for one in OUTLETS if one == chosen), OUTLETS[0])
        return Dielectric(permittivity, known_at, conductivity, outlet, gap)
    return None


def _number_or_text(text: str) -> float | str:
    """A number where the text is one."""
    return float(text) if _is_number(text) else text


def read_heat(chosen: Mapping[str, Any], oil: Lubricant | None, lack: str, problems: Problems) -> bool:
    """Tell whether heat in the inlet thins the films, as --physics says it.

    Parameters
    ----------
    chosen : mapping of str to object
        Values of the choices.
    oil : Lubricant or None
        Oil of the films, whose conductivity has to be known.
    lack : str
        Why films have none of it, and what is allowed; empty where they may.
    problems : Problems
        List that takes what is wrong.
    """
    physics = chosen.get("physics")
    if physics is not None and lack:
        problems.append(f"--physics: got {physics} {lack}")
    heat = not lack and heat_in_force(None if physics is None else physics != ISOTHERMAL, oil)
    if heat and oil is not None:
        with problems.after("--physics: "):
            heat_data(oil, STEEL)
    return heat

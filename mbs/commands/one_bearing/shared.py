"""Options that bearings of several kinds have in common: loads and speeds, refusals, the damper of the law, the oil."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.designations.clearance import clearance_range
from ehdmaps.physics.lubricant import DEFAULT_OIL, Lubricant
from ehdmaps.physics.surface import SMOOTH, CrownedProfile, Surface, TabulatedProfile
from ehdmaps.units import RPM
from mbs.commands.one_bearing.values import LOADS, MOST_POINTS, SPEEDS, read_direction, read_one, read_values
from mbs.scene.contact_laws import HERTZ_FORMS, Damper, hertz_damper
from mbs.scene.fields import FORCE, MICROMETRE

if TYPE_CHECKING:
    from ehdmaps.physics.point.ball_geometry import BallGeometry
    from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry

CELSIUS_40, ROUGHNESS = 313.15, 0.3e-6
"""Assumed where nothing is given: the temperature of the raceways [K], the combined rms roughness [m]."""


class Operating(NamedTuple):
    """Loads and speeds that are asked for.

    Attributes
    ----------
    loads : tuple of float
        Sizes of the radial load on the inner ring [N].
    axial : float
        Axial load on the inner ring [N].
    way : (float, float)
        Direction of the radial load, y and z; a unit vector.
    speeds : tuple of float
        Speeds of the inner ring [rad/s].
    outer_speed : float
        Speed of the outer ring [rad/s].
    """

    loads: tuple[float, ...]
    axial: float
    way: tuple[float, float]
    speeds: tuple[float, ...]
    outer_speed: float


def read_operating(arguments: argparse.Namespace, problems: list[str], *, axial: bool = True) -> Operating:
    """Loads and speeds, of which there may not be too many.

    Parameters
    ----------
    arguments : Namespace
        Options as they were parsed.
    problems : list of str
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


def refuse_others(
    arguments: argparse.Namespace,
    chosen: Sequence[str],
    taken: Sequence[str],
    kind: str,
    problems: list[str],
    own: Sequence[str] = (),
) -> None:
    """Note options that are for cylindrical roller bearings.

    Parameters
    ----------
    arguments : Namespace
        Options as they were parsed.
    chosen, taken : sequence of str
        Choices that were given, and those that the bearing takes.
    kind : str
        Kind of the bearing, in words.
    problems : list of str
        What is wrong; added to.
    own : sequence of str
        Further options that the bearing takes: profile, slices.
    """
    given = [f"--{name}" for name in chosen if name not in taken]
    given += [
        f"--{side}-ring-temperature"
        for side in ("inner", "outer")
        if getattr(arguments, f"{side}_ring_temperature") is not None
    ]
    for name, usual in (("profile", "iso"), ("slices", "41")):
        given += [f"--{name}"] * (name not in own and getattr(arguments, name) != usual)
    given += ["--coupled"] * bool(arguments.coupled)
    if given:
        names = (*taken, *own, "oil", "axial", "outer-speed", "tilts", "direction", "plot")
        allowed = ", ".join(f"--{name}" for name in names)
        problems.append(f"{', '.join(given)}: not for {kind}s; allowed: {allowed} and -o; leave it out")


def read_damper(law: str, kind: str, more: str, problems: list[str]) -> Damper | None:
    """Damper of the law hertz; None where a problem was noted.

    Parameters
    ----------
    law : str
        Law as it was typed.
    kind, more : str
        Kind of the bearing, and what else is allowed, in words.
    problems : list of str
        What is wrong; added to.
    """
    try:
        damper = hertz_damper(law)
    except InputError as error:
        problems += error.problems
        return None
    if damper is None:
        problems.append(f"--law: got {law!r:.60} for a {kind}; allowed: hertz, {HERTZ_FORMS}{more}")
    return damper


def read_surface(chosen: Mapping[str, Any]) -> tuple[Surface, float, list[str]]:
    """Surfaces as they were chosen, the roughness of Lambda [m], and a line where that is only assumed.

    Parameters
    ----------
    chosen : mapping of str to object
        Choices by their names.
    """
    surface: Surface = chosen.get("roughness", SMOOTH)
    if surface.smooth:
        return SMOOTH, ROUGHNESS, [f"combined rms roughness {MICROMETRE.text(ROUGHNESS)} (for Lambda only)"]
    return surface, surface.roughness, []


def read_profile_text(
    text: str, geometry: BearingGeometry | None, problems: list[str]
) -> str | CrownedProfile | TabulatedProfile:
    """The profile of cylindrical rollers; "iso" where a problem was noted.

    Parameters
    ----------
    text : str
        Value as a scene writes it.
    geometry : BearingGeometry or None
        Geometry of the bearing; None where a problem of it was noted.
    problems : list of str
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
    return [] if given else ["no clearance" if reach is None else reach.words]


def read_oil(
    name: str | None, temperature: float, problems: list[str], usual: Lubricant | None = None
) -> Lubricant | None:
    """The oil, which must suit the temperature; None where a problem was noted.

    Parameters
    ----------
    name : str or None
        Name as it was typed; None for the usual oil.
    temperature : float
        Temperature of the raceways [K].
    problems : list of str
        What is wrong; added to.
    usual : Lubricant, optional
        The usual oil; FVA 3 if left out.
    """
    option = "--oil"
    try:
        oil = usual if name is None and usual is not None else Lubricant.named(DEFAULT_OIL if name is None else name)
        option = "--temperature"
        oil.at(temperature)
    except InputError as error:
        problems += [f"{option}: {problem}" for problem in error.problems]
        return None
    return oil

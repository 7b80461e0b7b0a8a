"""Ball bearings by their keys: a catalogue bearing with what is known of it better, or all of its inner geometry.

The same keys stand in [bearing] of a file, in `geometry` of a scene and, in braces, as BEARING of a command.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from typing import Any

from ehdmaps.errors import InputError, Problems, short
from ehdmaps.inputs import read_text
from ehdmaps.jobs import table
from ehdmaps.jobs.table import Table, inline
from ehdmaps.physics.designations.estimates import without_parts
from ehdmaps.physics.designations.reader import BALLS, plain_name
from ehdmaps.physics.point.ball_catalogue import ball_estimate
from ehdmaps.physics.point.ball_geometry import HYPOTHESES, LARGEST_ANGLE, MOST_BALLS, BallGeometry
from ehdmaps.physics.solids import SILICON_NITRIDE, STEEL, Material
from ehdmaps.units import LENGTH, Display

MATERIALS = {"steel": STEEL, "silicon nitride": SILICON_NITRIDE}
"""Materials of balls and rings by name."""

_OWN = ("balls", "ball_diameter", "pitch_diameter", "inner_groove_radius", "outer_groove_radius")
_KEYS = (
    *("name", *_OWN, "contact_angle", "diametral_clearance", "preload"),
    *("ball_material", "ring_material", "hypothesis"),
)
_LONGEST = 100_000
_WIDEST = 1e-2


def balls_of(text: str) -> BallGeometry | None:
    """A ball bearing by its designation, by keys in braces, or by a file with [bearing]; None for other bearings.

    Parameters
    ----------
    text : str
        What was typed.

    Raises
    ------
    InputError
        With every problem of a ball bearing.

    Examples
    --------
    >>> balls_of('{ name = "6208", outer_groove_radius = 0.53 }').outer_conformity
    0.53
    >>> balls_of("NU308") is None
    True
    """
    if "\0" not in text and os.path.isfile(text):
        if not text.lower().endswith(".toml"):
            return None
        values: Any = table.parse(read_text(text, _LONGEST, "a TOML file with [bearing]"), text).get("bearing")
        where = f"{text}: [bearing]"
    elif text.lstrip().startswith("{"):
        problems = Problems()
        values, where = inline(text, "BEARING", problems), "BEARING"
        problems.check()
    else:
        return ball_estimate(text) if plain_name(text, BALLS) else None
    if not says_balls(values):
        return None
    found: list[str] = []
    geometry = read_balls(Table(values, where, found))
    if geometry is None:
        raise InputError(found)
    return geometry


def says_balls(values: object) -> bool:
    """Tell whether keys of a bearing are those of balls.

    Parameters
    ----------
    values : object
        What stands for [bearing] or `geometry`.
    """
    if not isinstance(values, Mapping):
        return False
    name = values.get("name")
    return any(key in values for key in _OWN) or (isinstance(name, str) and bool(plain_name(name, BALLS)))


def read_balls(section: Table) -> BallGeometry | None:
    """Read a ball bearing by its keys; None where a problem was noted.

    Parameters
    ----------
    section : Table
        [bearing] or `geometry`; it is closed.
    """
    before = len(section.problems)
    name = section.get("name")
    base = None
    if isinstance(name, str) and plain_name(name, BALLS):
        base = section.made(lambda: ball_estimate(name), "name")
    elif "name" in section and not isinstance(name, str):
        section.note("name", f"got {short(name)}; allowed: a designation, or any name in quotes")
    lacking = base is None
    lengths = {
        key: section.quantity(key, "m", 1e-5, 10.0, LENGTH, required=lacking)
        for key in ("ball_diameter", "pitch_diameter")
    }
    values: dict[str, Any] = {
        "balls": section.integer("balls", 3, MOST_BALLS, required=lacking),
        **lengths,
        **{
            f"{side}_conformity": _groove(section, side, lengths, base, required=lacking) for side in ("inner", "outer")
        },
        "contact_angle": section.quantity("contact_angle", "rad", -LARGEST_ANGLE, LARGEST_ANGLE, _DEGREE),
        "ball_material": _material(section, "ball_material"),
        "ring_material": _material(section, "ring_material"),
        "hypothesis": section.choice("hypothesis", HYPOTHESES) if "hypothesis" in section else None,
    }
    clearance = section.quantity("diametral_clearance", "m", -_WIDEST, _WIDEST, _MICROMETRE)
    preload = section.quantity("preload", "N", 0.0, 1e9, Display("N"))
    section.close(others=_KEYS)
    known = {key: value for key, value in values.items() if value is not None}
    if len(section.problems) > before:
        return None

    def made() -> BallGeometry:
        if base is None:
            text = name if isinstance(name, str) else f"{known['balls']} balls of {1e3 * known['ball_diameter']:g} mm"
            geometry = BallGeometry(text, **{"contact_angle": 0.0, "clearance": 0.0, **known})
        else:
            geometry = base.known(known, without_parts(base.estimated or "", known))
        if preload is not None:
            from ehdmaps.physics.point.row_catalogue import preloaded  # with what few bearings need

            geometry = preloaded(geometry, preload)
        return geometry if clearance is None else geometry.with_clearance(clearance)

    return section.made(made)


def _groove(
    section: Table, side: str, lengths: Mapping[str, float | None], base: BallGeometry | None, *, required: bool
) -> float | None:
    """Radius of a groove over the ball diameter: a bare number, or a length."""
    key = f"{side}_groove_radius"
    if not isinstance(section.get(key), str):
        return section.number(key, 0.5, 1.0, required=required)
    radius = section.quantity(key, "m", 1e-6, 10.0, LENGTH)
    diameter = lengths["ball_diameter"] or (base.ball_diameter if base is not None else math.nan)
    return None if radius is None else radius / diameter


def _material(section: Table, key: str) -> Material | None:
    """Material of balls or rings: by name, or by its numbers."""
    given = section.get(key)
    if isinstance(given, str):
        name = section.choice(key, tuple(MATERIALS))
        return None if name is None else MATERIALS[name]
    own = section.table(key, f"{section.where} {key}")
    if own is None:
        return None
    modulus = own.quantity("youngs_modulus", "Pa", 1e8, 2e12, _GPA, required=True)
    ratio = own.number("poisson_ratio", 0.0, 0.499, required=True)
    density = own.quantity("density", "kg/m^3", 500.0, 25000.0, Display("kg/m3"))
    own.close()
    if modulus is None or ratio is None:
        return None
    return Material(modulus, ratio, STEEL.density if density is None else density)


_DEGREE, _MICROMETRE, _GPA = Display("deg", 180.0 / math.pi), Display("um", 1e6), Display("GPa", 1e-9)

"""Job without a file, or with one that says little: what is taken where nothing is said, and what of it is told.

A job needs its bearing; oil, axes and solver have defaults. They are those of the shipped jobs.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.catalogue import designated
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.designations.reader import ROLLERS, read_designation
from ehdmaps.physics.lubricant import DEFAULT_OIL, Lubricant
from ehdmaps.physics.moes import moes_groups

GRID: Mapping[str, Any] = {
    "load": {"from": "0.1 N/mm", "to": "1000 N/mm", "points": 25, "spacing": "log"},
    "entrainment_speed": {"from": "0.05 m/s", "to": "10 m/s", "points": 12, "spacing": "log"},
    "temperature": ["20 degC", "40 degC", "60 degC", "80 degC", "100 degC", "120 degC"],
}
"""Axes where none are said."""

SOLVER = {"name": "reynolds", "structural_law": "iso16281"}
"""Keys of [solver] where they are not said."""

_WORDS = {
    "load": "load 0.1 to 1000 N/mm",
    "entrainment_speed": "entrainment speed 0.05 to 10 m/s",
    "temperature": "temperature 20 to 120 degC, as far as the laws of the oil hold and films are known",
}


@dataclass(frozen=True)
class Completed:
    """Tables of a job with all that they need.

    Attributes
    ----------
    values : mapping
        The tables.
    assumed : tuple of str
        What was not said, in words.
    temperatures : bool
        Whether the temperatures are assumed.
    """

    values: Mapping[str, Any]
    assumed: tuple[str, ...]
    temperatures: bool


def complete(values: Mapping[str, Any]) -> Completed:
    """Tables of a job with what they leave out.

    Parameters
    ----------
    values : mapping
        Tables as they were read; what is no table is left as it is.
    """
    assumed = []
    added: dict[str, Any] = {"schema": values.get("schema", 1)}
    if "lubricant" not in values:
        added["lubricant"] = {"name": DEFAULT_OIL}
        assumed.append(f"oil {DEFAULT_OIL}")
    grid, solver, solids = (values.get(name, {}) for name in ("grid", "solver", "solids"))
    missing = []
    if isinstance(grid, Mapping):
        missing = [key for key in GRID if key not in grid]
        if "inner_ring_speed" in grid:
            missing = [key for key in missing if key != "entrainment_speed"]
        added["grid"] = {**grid, **{key: GRID[key] for key in missing}}
        assumed += [_WORDS[key] for key in missing]
    if isinstance(solver, Mapping):
        law_elsewhere = isinstance(solids, Mapping) and "law" in solids
        lacking = [key for key in SOLVER if key not in solver and not (key == "structural_law" and law_elsewhere)]
        added["solver"] = {**solver, **{key: SOLVER[key] for key in lacking}}
        assumed += [f"{'solver' if key == 'name' else 'structural law'} {SOLVER[key]}" for key in lacking]
    return Completed({**values, **added}, tuple(assumed), "temperature" in missing)


def served(
    oil: Lubricant, temperatures: tuple[float, ...], contacts: Sequence[LineContact], fastest: float
) -> tuple[float, ...]:
    """Temperatures at which the laws of an oil hold, and films are known; all of them where that is nowhere.

    A thick cold oil at a speed that no bearing has there is beyond the film table, and beyond its solver: nobody who
    leaves the temperatures out has asked for that.

    Parameters
    ----------
    oil : Lubricant
        The oil.
    temperatures : tuple of float
        Temperatures [K].
    contacts : sequence of LineContact
        Contacts that films are wanted of.
    fastest : float
        Highest entrainment speed [m/s].
    """
    found = tuple(temperature for temperature in temperatures if _holds(oil, temperature, contacts, fastest))
    return found or temperatures


def _holds(oil: Lubricant, temperature: float, contacts: Sequence[LineContact], fastest: float) -> bool:
    """Tell whether the laws of an oil hold at a temperature, with an oil number L that the film table knows."""
    try:
        state = oil.at(temperature)
    except InputError:
        return False
    if not contacts or fastest == 0.0:
        return True
    from ehdmaps.table.file import film_table  # with all that reads films

    alpha, (R, E) = state.pressure_viscosity.pressure_viscosity, min((c.radius, c.reduced_modulus) for c in contacts)
    return moes_groups(1.0, fastest, state.viscosity, alpha, R, E)[1] <= film_table(oil).largest_oil_number


@dataclass(frozen=True)
class DesignatedJob:
    """Job of a bearing and an oil by their names: its text, and its name."""

    text: str
    name: str


def designated_job(source: str) -> DesignatedJob | None:
    """Job that a designation stands for, with an oil behind a comma; None where the text is no designation.

    Parameters
    ----------
    source : str
        Such as "NU210" or "NU210, ISO VG 46"; a file of that name, and the name of a shipped job, go first.

    Examples
    --------
    >>> designated_job("NU 210, VG46").name, designated_job("nu308")
    ('NU210_ISO_VG_46', None)
    """
    bearing, comma, oil = source.partition(",")
    given = read_designation(bearing)
    if given is None or given.kind not in ROLLERS or source in SHIPPED or os.path.exists(source):
        return None
    designated(bearing)
    lines = ["schema = 1", "", "[bearing]", f"name = {json.dumps(given.text)}"]
    words = [given.text]
    if comma:
        name = Lubricant.named(oil.strip()).name
        lines += ["", "[lubricant]", f"name = {json.dumps(name)}"]
        words.append(name)
    return DesignatedJob("\n".join(lines) + "\n", re.sub(r"[^A-Za-z0-9.+-]+", "_", "_".join(words)))


SHIPPED = ("nu308", "n1014")
"""Shipped jobs whose names are designations, too."""


def bearing_source(bearing: str | None, oil: str | None, given: object, needed: bool = True) -> str | None:
    """Source of a job that the options --bearing and --oil ask for; None where they are not given.

    Parameters
    ----------
    bearing, oil : str or None
        What was given.
    given : object
        A job or map that was given besides; None for none.
    needed : bool
        Whether one of them has to be.

    Raises
    ------
    InputError
        If both or none are given, or there is no such bearing or oil.
    """
    problems = Problems()
    if bearing is None and oil is not None:
        problems.append(f"--oil: got {oil!r:.60} without --bearing; allowed: with it; a job states its own oil")
    if bearing is None and given is None and needed:
        problems.append("JOB: missing; allowed: a job or map, or --bearing with a designation, such as NU210")
    if bearing is not None and given is not None:
        problems.append(f"--bearing: got {bearing!r:.60} beside a job or map; allowed: one of the two; leave one out")
    for option, text, read in (("--bearing", bearing, designated), ("--oil", oil, Lubricant.named)):
        with problems.after(f"{option}: "):
            if text is not None:
                read(text)
    problems.check()
    if bearing is None:
        return None
    given = read_designation(bearing)
    name = bearing if given is None else given.text
    return name if oil is None else f"{name}, {oil}"

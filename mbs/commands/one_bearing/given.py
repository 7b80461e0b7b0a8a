"""The bearing argument of `mbs bearing` of cylindrical rollers: a designation, a shipped job, or a file."""

from __future__ import annotations

import os

from ehdmaps.errors import InputError
from ehdmaps.inputs import first_bytes, read_text
from ehdmaps.physics.bearing import BEARINGS
from ehdmaps.physics.catalogue import designated, designations, plain_designation
from ehdmaps.physics.rollers.needle_catalogue import needle_designations
from ehdmaps.physics.solids import STEEL
from ehdmaps.units import closest, short
from mbs.commands.one_bearing.shared import Given


def read_given(source: str, problems: list[str]) -> Given | None:
    """The bearing of a name, a shipped job or a file; None where a problem was noted.

    Parameters
    ----------
    source : str
        The argument.
    problems : list of str
        List that takes what is wrong.
    """
    from ehdmaps.jobs.defaults import SHIPPED  # with the readers of all tables of a job

    is_file = "\0" not in source and os.path.isfile(source)
    if plain_designation(source) and not is_file and source not in SHIPPED:
        try:
            return Given(designated(source), STEEL)
        except InputError as error:
            problems += [f"BEARING: {problem}" for problem in error.problems]
            return None
    from ehdmaps.jobs.reader import shipped_jobs

    allowed = "a designation such as NU308 or NU210, or a TOML file with [bearing], such as a job"
    if source not in shipped_jobs() and not is_file:
        near = closest(source.upper(), (*BEARINGS, *designations(), *needle_designations()))
        problems.append(f"BEARING: got {short(source)}{near}; allowed: {allowed}")
        return None
    try:
        return _from_file(source)
    except InputError as error:
        problems += error.problems
        return None


def _from_file(source: str) -> Given:
    """The bearing of a job, or of a file that holds no more than the bearing, material, oil, supply and surfaces."""
    from ehdmaps.jobs.reader import read_job, shipped_jobs

    if source not in shipped_jobs():
        alone = _alone(source)
        if alone is not None:
            return alone
    job = read_job(source)
    if job.bearing is None:
        raise InputError(f"{source}: is the job of a bare [contact]; allowed: one with [bearing]")
    return Given(job.bearing, job.contacts[0].material, job.lubricant, job.supply, job.surface)


def _alone(source: str) -> Given | None:
    """The bearing of a file without [grid] and [solver]; None for a job or a map, which have a reader of their own."""
    from ehdmaps.jobs import table
    from ehdmaps.jobs.problem import read_contacts, read_lubricant
    from ehdmaps.jobs.reader import LONGEST_FILE
    from ehdmaps.jobs.supply import read_supply, read_surface
    from ehdmaps.jobs.table import Table

    allowed = "a TOML file with [bearing]"
    if first_bytes(source, 4, allowed).startswith((b"CDF", b"\x89HDF")):
        return None
    values = table.parse(read_text(source, LONGEST_FILE, allowed), source)
    if "grid" in values or "solver" in values:
        return None
    problems: list[str] = []
    top = Table(values, "bearing file", problems)
    top.get("schema")
    geometry, contacts = read_contacts(top, "iso16281")
    section = top.table("lubricant", "[lubricant]")
    oil = read_lubricant(section) if section else None
    supply = top.optional("supply", "[supply]", read_supply)
    surface = top.optional("surface", "[surface]", read_surface)
    top.close(others=("schema", "bearing", "material", "lubricant", "supply", "surface"))
    if geometry is None and not problems:
        problems.append("bearing file: has [contact]; allowed: [bearing] with a name or dimensions")
    if problems or geometry is None:
        raise InputError([f"{source}: {problem}" for problem in problems])
    return Given(geometry, contacts[0].material, oil, supply, surface)

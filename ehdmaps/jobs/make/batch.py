"""A batch file: the maps of a catalogue, bearings x oils x overrides, from one file.

A batch file is a job file with lists in the places of [bearing] and [lubricant]::

    schema = 1

    [batch]
    bearings = ["NU308", "N1014"]               # names, or tables with the keys of [bearing] and a label
    estimates = ["NU206", "NU2310"]             # designations whose inner geometry is estimated
    oils = ["FVA3", { label = "VG32", ... }]    # names, or tables with the keys of [lubricant] and a label

    [[overrides]]                               # each changes keys of the tables below; left out: none
    name = "rough"
    surface = { roughness = "0.3 um" }

    [grid]                                      # and all other tables of a job file: for every member

Each combination is a job of its own, whose text is written out and read as any job file is.
"""

from __future__ import annotations

import hashlib
import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from ehdmaps import inputs
from ehdmaps.errors import InputError
from ehdmaps.jobs import table
from ehdmaps.jobs.defaults import designated_job
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.job_text import tables_text
from ehdmaps.jobs.reader import LONGEST_FILE, parse_job, shipped_jobs
from ehdmaps.jobs.table import Table
from ehdmaps.units import short

MOST_MEMBERS = 20_000
"""Maps of one batch, 20 GB of them; more is a slip in the file, or several batches."""

LONGEST_NAME = 120
"""Characters of the name of a member, which becomes the name of a file."""

SUMMARY = "summary.csv"
"""File with the table of all maps of a batch, in their folder."""

DEFAULT_CHECKED = 0
"""Maps of one oil whose laws are checked where a batch says nothing: those of the film table were when it was made."""

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9.+-]*")
_NAMES = "letters, digits, '.', '+' and '-', beginning with a letter or a digit"
_REPLACED = ("bearing", "lubricant")
_OF_JOB = ("schema", "material", "supply", "surface", "solids", "grid", "solver", "correction")
_SHOWN = 20


@dataclass(frozen=True)
class Member:
    """One map of a batch.

    Attributes
    ----------
    name : str
        Name of the map's file, without its ending.
    bearing, oil, override : str
        What the name is made of; no override is empty.
    job : Job
        What is made.
    """

    name: str
    bearing: str
    oil: str
    override: str
    job: Job


@dataclass(frozen=True)
class Batch:
    """Jobs that are made together.

    Attributes
    ----------
    name : str
        Name of the batch: that of its file, without the ending.
    text : str
        Text of the file.
    members : tuple of Member
        Bearing by bearing, oil by oil.
    checked : int
        Number of maps of one oil, with films from the film table, whose laws are checked as the jobs say.
    """

    name: str
    text: str
    members: tuple[Member, ...]
    checked: int = DEFAULT_CHECKED

    @property
    def sha256(self) -> str:
        """Hash of the text of the file."""
        return hashlib.sha256(self.text.encode()).hexdigest()


def is_batch(source: str | PathLike[str]) -> bool:
    """Tell whether a file is a batch file: TOML with a table [batch]; no problem of a file is reported here.

    Parameters
    ----------
    source : str or path
        Path of a file, or the name of a shipped job.
    """
    if fspath(source) in shipped_jobs() or designated_job(fspath(source)) is not None:
        return False
    try:
        if not inputs.first_bytes(Path(source), 1, ""):
            return False
        text = inputs.read_text(Path(source), LONGEST_FILE, "", "", "")
        return "batch" in table.parse(text, "")
    except InputError:
        return False


def read_batch(source: str | PathLike[str], solver: str | None = None, to_run: bool = False) -> Batch:
    """Read a batch file.

    Parameters
    ----------
    source : str or path
        The file.
    solver : str, optional
        Takes the place of the solver of every job, as for `read_job`.
    to_run : bool
        Whether the jobs are to be run here.

    Raises
    ------
    InputError
        With every problem found; one that several members have is told once.
    """
    where = fspath(source)
    advice = "write long axes as from, to, points"
    text = inputs.read_text(Path(source), LONGEST_FILE, "a batch file in TOML", advice, where)
    return parse_batch(text, Path(source).stem, where, solver, to_run)


def parse_batch(text: str, name: str, where: str, solver: str | None = None, to_run: bool = False) -> Batch:
    """Read a batch from the text of its file.

    Parameters
    ----------
    text, name, where
        Text of the file, name of the batch, and how messages call the file.
    solver, to_run
        The same as for `read_batch`.

    Raises
    ------
    InputError
        With every problem found.
    """
    values = table.parse(text, where)
    problems: list[str] = []
    top = Table(values, "batch file", problems)
    section = top.table("batch", "[batch]", required="a table with bearings and oils")
    lists = _Lists.read(section) if section else None
    overrides = _overrides(top)
    for key in _REPLACED:
        if key in top:
            top.get(key)
            top.note(key, "stands beside [batch], which lists them; allowed: bearings and oils of [batch]; delete it")
    if not _NAME.fullmatch(name.replace("_", "-")):
        problems.append(f"batch file: is called {short(name)}; allowed: a name of {_NAMES}; rename it")
    for key in _OF_JOB:  # their own reader reads them, for each member
        top.get(key)
    top.close()
    if problems or lists is None or overrides is None:
        raise InputError([f"{where}: {problem}" for problem in problems])
    count = len(lists.bearings) * len(lists.oils) * len(overrides)
    if count > MOST_MEMBERS:
        raise InputError(
            f"{where}: [batch]: got {len(lists.bearings)} bearings x {len(lists.oils)} oils x {len(overrides)} "
            f"overrides = {count} maps; allowed: at most {MOST_MEMBERS}; make several batches of it"
        )
    base = {key: value for key, value in values.items() if key in _OF_JOB}
    members = _members(lists, overrides, base, where, solver, to_run)
    return Batch(name, text, members, lists.checked)


@dataclass(frozen=True)
class _Lists:
    """Content of [batch]: bearings and oils by their names, as tables of jobs."""

    bearings: Mapping[str, Mapping[str, Any]]
    oils: Mapping[str, Mapping[str, Any]]
    checked: int

    @classmethod
    def read(cls, section: Table) -> _Lists:
        """Read [batch]; empty lists where a problem was noted."""
        named = _entries(section, "bearings", "name", required="estimates" not in section)
        estimated = _entries(section, "estimates", "estimate", required=False)
        for name in named.keys() & estimated.keys():
            section.note("estimates", f"got {name!r}, which bearings has, too; allowed: each name once; give labels")
        oils = _entries(section, "oils", "name", required=True)
        if "films" in section:
            section.get("films")
            section.note("films", 'is no key of [batch] any more; allowed: films = "table" or "solved" of [solver]')
        checked = section.integer("checked", 0, MOST_MEMBERS)
        section.close()
        return cls({**named, **estimated}, oils, DEFAULT_CHECKED if checked is None else checked)


def _entries(section: Table, key: str, word: str, required: bool) -> dict[str, Mapping[str, Any]]:
    """Read a list of names, or of tables with a label, a name or an estimate."""
    form = "a list of names, or of tables with a label"
    values = section.get(key, form if required else "")
    if key not in section:
        return {}
    if not isinstance(values, list):
        section.note(key, f"got {short(values)}; allowed: {form}")
        return {}
    if not values:
        section.note(key, "got an empty list; allowed: at least one")
    entries: dict[str, Mapping[str, Any]] = {}
    seen: Counter[str] = Counter()
    for index, value in enumerate(values[: MOST_MEMBERS + 1]):
        table = {word: value} if isinstance(value, str) else value
        if not isinstance(table, dict):
            section.note(f"{key}[{index}]", f"got {short(value)}; allowed: a name in quotes, or a table with a label")
            continue
        name = next((table[k] for k in ("label", "name", "estimate") if isinstance(table.get(k), str)), None)
        if name is None:
            section.note(f"{key}[{index}]", "has no label; allowed: a table with one, which names its maps")
        elif not _NAME.fullmatch(name) or len(name) > LONGEST_NAME:
            section.note(
                f"{key}[{index}]",
                f"got {short(name)}, which becomes a part of a file's name; allowed: {_NAMES}; give a label of these",
            )
        elif seen[name.casefold()]:
            section.note(f"{key}[{index}]", f"got {name!r} again; allowed: each name once; give another label")
        else:
            entries[name] = table
        if name is not None:
            seen[name.casefold()] += 1
    return entries


def _overrides(top: Table) -> dict[str, Mapping[str, Any]] | None:
    """Read [[overrides]]; one without a name and keys where there are none, None where a problem was noted."""
    values = top.get("overrides")
    if "overrides" not in top:
        return {"": {}}
    before = len(top.problems)
    form = "tables [[overrides]], each with a name and keys of a job"
    if not isinstance(values, list) or not values:
        top.note("overrides", f"got {short(values)}; allowed: {form}")
        return None
    overrides: dict[str, Mapping[str, Any]] = {}
    for index, value in enumerate(values[: MOST_MEMBERS + 1]):
        where = f"overrides[{index}]"
        if not isinstance(value, dict):
            top.note(where, f"got {short(value)}; allowed: {form}")
            continue
        name = value.get("name")
        changes = {key: change for key, change in value.items() if key != "name"}
        if not isinstance(name, str) or not _NAME.fullmatch(name) or len(name) > LONGEST_NAME:
            top.note(where, f"name: got {short(name)}; allowed: {_NAMES}, in quotes")
        elif name.casefold() in {known.casefold() for known in overrides}:
            top.note(where, f"name: got {name!r} again; allowed: each name once")
        else:
            overrides[name] = changes
        for key, change in changes.items():
            if key in _REPLACED or key not in _OF_JOB or not isinstance(change, dict):
                allowed = ", ".join(k for k in _OF_JOB if k != "schema")
                top.note(where, f"{short(key)[1:-1]}: got {short(change)}; allowed: a table, one of {allowed}")
    return overrides if len(top.problems) == before else None


def _members(
    lists: _Lists,
    overrides: Mapping[str, Mapping[str, Any]],
    base: Mapping[str, Any],
    where: str,
    solver: str | None,
    to_run: bool,
) -> tuple[Member, ...]:
    """Read the job of each combination."""
    members: list[Member] = []
    problems: dict[str, list[str]] = {}
    names: dict[str, str] = {}
    for bearing, oil, override in product(lists.bearings, lists.oils, overrides):
        name = "_".join(part for part in (bearing, oil, override) if part)
        if len(name) > LONGEST_NAME:
            problems.setdefault(f"its name has more than {LONGEST_NAME} characters; give shorter labels", []).append(
                name
            )
            continue
        if name.casefold() in names:  # parts hold no "_", so that this is a slip of this program
            problems.setdefault(f"has the name of {names[name.casefold()]}, too; give other labels", []).append(name)
            continue
        names[name.casefold()] = name
        tables = {**base, "bearing": lists.bearings[bearing], "lubricant": lists.oils[oil]}
        for key, changes in overrides[override].items():
            own = tables.get(key)
            tables[key] = {**own, **changes} if isinstance(own, dict) else changes
        try:
            job = parse_job(tables_text(tables), name, "", solver, to_run)
        except InputError as error:
            for problem in error.problems:
                problems.setdefault(problem.removeprefix(": "), []).append(name)
            if len(problems) > _SHOWN:
                break
        else:
            members.append(Member(name, bearing, oil, override, job))
    if problems:
        raise InputError(
            [
                f"{where}, {affected[0]}{f' and {len(affected) - 1} more' if len(affected) > 1 else ''}: {problem}"
                for problem, affected in problems.items()
            ]
        )
    return tuple(members)

"""Read a job: a TOML file, the name of a shipped job, or a map that carries its job."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping, Sequence
from importlib import resources
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from ehdmaps import inputs
from ehdmaps.errors import InputError, Problems
from ehdmaps.jobs import defaults, solvers, table
from ehdmaps.jobs.job import DEFAULT_CORRECTION_POINTS, MOST_CHECKS, MOST_POINTS, CorrectedBy, Job
from ehdmaps.jobs.problem import LOAD_AXIS, TEMPERATURE_AXIS, read_axis, read_contacts, read_lubricant, read_speeds
from ehdmaps.jobs.solids import NO_SOLIDS, check_solids, read_solids
from ehdmaps.jobs.supply import read_supply, read_surface
from ehdmaps.jobs.table import Table
from ehdmaps.maps.backbone_plan import STEP_LIMITS, STEPS, Steps
from ehdmaps.netcdf_structure import DAMAGE, opened
from ehdmaps.physics.approach import STRUCTURAL_LAWS
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.designations.families import words_for_lines
from ehdmaps.physics.heat import ISOTHERMAL, heat_data
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.units import KELVIN, OF_JOBS, OF_OILS, Tolerance, closest, read_tolerances, split, without_tolerance

LONGEST_FILE = 1_000_000
"""Bytes of a job file; axes of a hundred thousand values still fit."""

FEWEST_CORRECTION_POINTS, MOST_CORRECTION_POINTS = 4, 200
"""Points of the dearer solver; beyond that a map of its own is the better use of them."""

_ONE = "allowed: one of the two"
_SIGNATURES = (b"CDF", b"\x89HDF")
_PROBLEM = ("bearing", "contact", "material", "lubricant", "supply", "surface", "solids")
_TABLES = ("schema", *_PROBLEM, "grid", "solver", "correction", "tolerances")


def shipped_jobs() -> tuple[str, ...]:
    """Return the names of the jobs that come with the package."""
    folder = resources.files("ehdmaps.jobs") / "shipped"
    return tuple(sorted(entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml")))


def read_job(
    source: str | PathLike[str], solver: str | None = None, to_run: bool = False, finding_solids: bool = False
) -> Job:
    """Read a job.

    Parameters
    ----------
    source : str or path
        Name of a shipped job ("nu308"), path of a job file, or path of a map file, whose job is read again; or a
        designation with an oil behind a comma, "NU210, ISO VG 46".
    solver : str, optional
        Takes the place of the job's solver: it keeps physics, shear and sliding, its other keys have their defaults.
    to_run : bool
        Whether the job is to be run here: what its solver lacks on this machine is a problem then.
    finding_solids : bool
        Whether the approaches that the law fe needs are about to be found: the contacts have the law half_space then.

    Raises
    ------
    InputError
        With every problem found.
    """
    source = fspath(source)
    by_designation = defaults.designated_job(source)
    if by_designation is not None:
        return parse_job(by_designation.text, by_designation.name, source, solver, to_run, finding_solids)
    if source in shipped_jobs():
        text = (resources.files("ehdmaps.jobs") / "shipped" / f"{source}.toml").read_text(encoding="utf-8")
        return parse_job(text, source, f"{source} (shipped)", solver, to_run, finding_solids)
    path = Path(source)
    if not os.path.exists(path) and (words := words_for_lines(source)):
        raise InputError(words)
    known = shipped_jobs()
    allowed = (
        f"a job file, a map file, or a shipped job: {', '.join(known)}{closest(source, known)}; or --bearing with a "
        "designation, such as NU210"
    )
    if inputs.first_bytes(path, 8, allowed, source).startswith(_SIGNATURES):
        text, name, of_map = _job_of_map(path)
        return parse_job(text, name, f"{source} (job of the map)", solver or of_map, to_run, finding_solids)
    advice = "write long axes as from, to, points"
    text = inputs.read_text(path, LONGEST_FILE, "a job file in TOML, or a map file", advice, source)
    return parse_job(text, path.stem, source, solver, to_run, finding_solids)


def parse_job(
    text: str,
    name: str,
    where: str,
    solver: str | None = None,
    to_run: bool = False,
    finding_solids: bool = False,
) -> Job:
    """Read a job from the text of its file.

    Parameters
    ----------
    text : str
        Text of the job, in TOML.
    name : str
        Name of the job.
    where : str
        How messages call the file.
    solver : str, optional
        Takes the place of the job's solver.
    to_run, finding_solids : bool
        The same as for `read_job`.

    Raises
    ------
    InputError
        With every problem found, each beginning with `where`.
    """
    values = table.parse(text, where)
    if "batch" in values:
        raise InputError(
            f"{where}: is a batch file, of many jobs; allowed: one job; `ehdmaps generate`, `check` and "
            "`status` take a batch"
        )
    if "operation" in values and "grid" not in values:
        raise InputError(f"{where}: is a scene of mbs, no job; allowed: a job; scenes are for `mbs run`, `mbs check`")
    problems: list[str] = []
    if not name.isprintable():
        problems.append(f"is called {name!r:.80}; allowed: printable characters, which its map can carry; rename it")
    plain, stated = taken_out(values, problems)
    completed = defaults.complete(plain)
    top = Table(completed.values, "job file", problems)
    job = _job(top, text, name, solver, to_run, finding_solids, completed, stated)
    if problems or job is None:
        raise InputError([f"{where}: {problem}" for problem in problems])
    return job


def taken_out(values: dict[str, Any], problems: list[str]) -> tuple[dict[str, Any], dict[str, Tolerance]]:
    """Tables of a job with plain values in place of values with tolerances, and these tolerances.

    Parameters
    ----------
    values : dict
        The tables as they were parsed.
    problems : list of str
        List that takes what is wrong.

    Notes
    -----
    The clearance of [bearing], viscosities of [lubricant] and the only temperature of [grid] may have one.
    """
    changed, found = dict(values), dict[str, Tolerance]()
    for name, keys in (("bearing", {"diametral_clearance": "clearance"}), ("lubricant", OF_OILS)):
        if name in values:
            changed[name], stated = without_tolerance(values[name], keys, f"[{name}]", problems)
            found.update(stated)
    grid = values.get("grid")
    only = grid.get("temperature") if isinstance(grid, dict) else None
    if isinstance(only, list) and len(only) == 1 and isinstance(only[0], str) and all(split(only[0])):
        one, stated = without_tolerance({"temperature": only[0]}, {"temperature": "temperature"}, "[grid]", problems)
        changed["grid"], found = {**values["grid"], "temperature": [one["temperature"]]}, {**found, **stated}
    return changed, found


def _job(
    top: Table,
    text: str,
    name: str,
    override: str | None,
    to_run: bool,
    finding_solids: bool,
    completed: defaults.Completed,
    stated: dict[str, Tolerance],
) -> Job | None:
    """Read all tables; None where a problem was noted."""
    schema = top.get("schema")
    if "schema" in top and (isinstance(schema, bool) or schema != 1):
        top.note("schema", f"got {schema!r:.60}; allowed: 1; this version of ehdmaps reads no other")

    section = top.table("solver", "[solver]", required="a table with name and structural_law")
    solids_section = top.table("solids", "[solids]")
    solids = read_solids(solids_section) if solids_section else NO_SOLIDS
    law_elsewhere = solids_section is not None and "law" in solids_section
    solver, options, law, rest = _solver(section, top, law_elsewhere) if section else (None, {}, None, {})
    law_key = "[solver] structural_law"
    if law_elsewhere and section and "structural_law" in section:
        top.note("[solids] law", f"stands beside structural_law of [solver], which says the same; {_ONE}; delete one")
    elif law_elsewhere:
        law_key, law = "[solids] law", solids.law
    if override is not None and override not in solvers.SOLVER_NAMES:
        top.note("--solver", f"got {override!r:.60}; allowed: {', '.join(solvers.SOLVER_NAMES)}")
    elif override is not None and override != solver:
        options = solvers.carried(options, override)
        heat = options.get("physics")
        if heat is not None and not solvers.takes(override, "physics", str(heat)):
            top.note("--solver", f"got {override!r}, which knows no physics = {heat!r} of the job")
        solver, rest = override, {**rest, "corrected_by": None}
    if to_run and solver is not None:
        by: CorrectedBy | None = rest["corrected_by"]
        for key, needed in (("name", solver), *([("corrected_by", by.solver)] if by else [])):
            for problem in solvers.SOLVERS[needed].missing():
                top.note(f"[solver] {key}", f"got {needed!r}, which needs more than is here: {problem}")

    bearing, contacts = read_contacts(top, "half_space" if law == "fe" and finding_solids else law, solids, law_key)
    if solids_section is not None:
        check_solids(solids_section, bare="contact" in top)
        solids_section.close()
    oil_section = top.table("lubricant", "[lubricant]", required="a table with the name of an oil, or its data")
    oil = read_lubricant(oil_section) if oil_section else None
    if oil is not None and contacts:
        _check_heat(top, oil, contacts, options, rest.get("corrected_by"))
    supply = top.optional("supply", "[supply]", read_supply)
    surface = top.optional("surface", "[surface]", read_surface)
    tolerances = top.optional("tolerances", "[tolerances]", lambda section: read_tolerances(section, OF_JOBS))

    axes: list[tuple[float, ...] | None] = [None, None, None]
    grid = top.table("grid", "[grid]", required="a table with load, entrainment_speed and temperature")
    if grid:
        axes = _grid(grid, len(contacts) or 2, bearing, known=bearing is not None or "bearing" not in top)
        if oil is not None and axes[2] is not None:
            if completed.temperatures:
                axes[2] = defaults.served(oil, axes[2], contacts, max(axes[1] or (0.0,)))
            _check_temperatures(oil, axes[2], grid)
        _check_loads(contacts, axes[0], grid)
    top.close(others=_TABLES)

    loads, speeds, temperatures = axes
    if top.problems or solver is None or oil is None or loads is None or speeds is None or temperatures is None:
        return None
    return Job(
        name=name,
        text=text,
        bearing=bearing,
        contacts=contacts,
        lubricant=oil,
        supply=supply,
        surface=surface,
        solids=solids,
        loads=loads,
        entrainment_speeds=speeds,
        temperatures=temperatures,
        solver=solver,
        solver_options=options,
        assumed=completed.assumed,
        tolerances={**(tolerances or {}), **stated},
        **rest,
    )


def _solver(
    section: Table, top: Table, law_elsewhere: bool
) -> tuple[str | None, dict[str, object], str | None, dict[str, Any]]:
    """Read [solver]: name, its own keys, structural law, and the keys that every solver has; and [correction]."""
    name = section.choice("name", solvers.SOLVER_NAMES, required=True)
    law = section.choice("structural_law", STRUCTURAL_LAWS, required=not law_elsewhere)
    rest: dict[str, Any] = {
        "fill": section.choice("fill", ("neighbours", "none")) or "neighbours",
        "backbone": section.choice("backbone", ("law", "none")) or "law",
        "law_check": section.integer("law_check", 0, MOST_CHECKS) or 0,
        "line_steps": section.optional("line_steps", "[solver] line_steps", _line_steps) or STEPS,
        "corrected_by": None,
    }
    top.get("correction")
    options: dict[str, object] = {}
    if name is not None:
        options = solvers.read_options(name, section)
        rest["corrected_by"] = _corrected_by(section, top, name, options)
        section.close()
    return name, options, law, rest


def _corrected_by(section: Table, top: Table, name: str, options: dict[str, object]) -> CorrectedBy | None:
    """Read by what the films are corrected, and the keys of that solver in [correction], which repeats the physics."""
    with_films = tuple(known for known in solvers.SOLVER_NAMES if known != "hertz")
    by = section.choice("corrected_by", with_films)
    points = section.integer("correction_points", FEWEST_CORRECTION_POINTS, MOST_CORRECTION_POINTS)
    own = top.table("correction", "[correction]")
    if "corrected_by" not in section:
        for table, key in ((section, "correction_points"), (top, "correction")):
            if key in table:
                table.note(key, "stands without corrected_by of [solver]; allowed: with it; delete it, or add that")
        return None
    if by is None:
        return None
    stated = {} if own is None else solvers.read_options(by, own)
    if own is not None:
        own.close()
    physics = solvers.carried(options, by)
    if "physics" in physics and not solvers.takes(by, "physics", str(physics["physics"])):
        del physics["physics"]
    of_corrector = {**physics, **stated}
    if name == "hertz":
        section.note("corrected_by", "stands beside name = 'hertz', which has no film to correct; delete it")
    elif by == name and of_corrector == options:
        section.note(
            "corrected_by",
            f"got {by!r}, the solver of the map with the same keys, which corrects nothing; allowed: another solver, "
            "or other keys in [correction]",
        )
    return CorrectedBy(by, points or DEFAULT_CORRECTION_POINTS, of_corrector)


def _line_steps(section: Table) -> Steps:
    """Read the steps of refinement lines; those that are absent or wrong are the usual ones."""
    return Steps(
        load=section.number("load", *STEP_LIMITS.load) or STEPS.load,
        entrainment_speed=section.number("entrainment_speed", *STEP_LIMITS.entrainment_speed)
        or STEPS.entrainment_speed,
        temperature=section.quantity("temperature", "K", *STEP_LIMITS.temperature, KELVIN) or STEPS.temperature,
    )


def _check_loads(contacts: Sequence[LineContact], loads: Sequence[float] | None, grid: Table) -> None:
    """Note loads for which the contacts are too wide for the law of finite elements."""
    for contact in contacts:
        if contact.structural_law == "fe" and loads:
            try:
                contact.structural_approach(loads[-1])
            except InputError as error:
                grid.note("load", f"contact {contact.name}: {error.problems[0]}")


def _grid(grid: Table, contacts: int, bearing: BearingGeometry | None, known: bool) -> list[tuple[float, ...] | None]:
    """Read [grid]."""
    axes = [read_axis(grid, LOAD_AXIS), read_speeds(grid, bearing, known), read_axis(grid, TEMPERATURE_AXIS)]
    grid.close()
    points = contacts
    for axis in axes:
        points *= len(axis) if axis else 1
    if points > MOST_POINTS:
        lengths = " x ".join([str(contacts), *(str(len(axis)) for axis in axes if axis)])
        grid.note(
            "",
            f"got {lengths} = {points} points; allowed: at most {MOST_POINTS}; use fewer points on the axes",
        )
    return axes


def _check_heat(
    top: Table,
    oil: Lubricant,
    contacts: tuple[LineContact, ...],
    options: Mapping[str, object],
    by: CorrectedBy | None,
) -> None:
    """Note what heat needs and nobody stated, where a solver of the job knows heat."""
    own = options.get("physics", ISOTHERMAL)
    dearer = by.options.get("physics", ISOTHERMAL) if by else own
    if own == dearer == ISOTHERMAL:
        return
    if own != dearer and len(contacts) > 1:
        top.note(
            "[correction] physics",
            f"got {dearer!r} for films that are {own}; contacts of a bearing share what they are corrected by, and "
            "heat is not theirs in common; allowed: the same physics in [solver], or a bare [contact]",
        )
    top.made(lambda: heat_data(oil, contacts[0].material), "[lubricant]")


def _check_temperatures(oil: Lubricant, temperatures: tuple[float, ...], grid: Table) -> None:
    """Note where the oil's laws do not hold on the temperature axis (its first and last such value)."""
    found = Problems()
    for temperature in temperatures:
        with found:
            oil.at(temperature)
    for problem in dict.fromkeys((found[0], found[-1]) if found else ()):
        grid.note("temperature", problem)


def is_map(source: str) -> bool:
    """Tell whether a job was given as a map file."""
    try:
        given = source in shipped_jobs() or defaults.designated_job(source) is not None
        return not given and inputs.first_bytes(source, 8, "").startswith(_SIGNATURES)
    except InputError:
        return False


def _job_of_map(path: Path) -> tuple[str, str, str | None]:
    """Return the job's text and name, and the solver's name, that a map carries."""
    try:
        with opened(path) as file:
            attributes = {name: file.getncattr(name) for name in file.ncattrs()}
    except DAMAGE as error:
        raise InputError(
            f"{path}: looks like a map file but cannot be read ({error!s:.300}); generate it again"
        ) from error
    text, digest, solver, name = (attributes.get(key) for key in ("job_toml", "job_sha256", "solver", "job_name"))
    if not isinstance(text, str):
        raise InputError(f"{path}: carries no job (attribute job_toml); allowed: a map written by `ehdmaps generate`")
    if hashlib.sha256(text.encode()).hexdigest() != digest:
        raise InputError(
            f"{path}: its job does not match its job_sha256; the file was edited; use the job file instead"
        )
    return text, str(name or path.stem), solver if isinstance(solver, str) else None

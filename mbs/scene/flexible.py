"""Bodies of finite elements of a scene: a table [[flexible]] is read, and becomes a body.

The table names a reduced file, or matrices, mesh and interfaces; no file of it is read before the body is built.
"""

from __future__ import annotations

import dataclasses
import math
import re
from pathlib import Path
from typing import TYPE_CHECKING

from ehdmaps.errors import InputError
from ehdmaps.inputs import read_text
from ehdmaps.jobs import table
from ehdmaps.jobs.table import Table
from ehdmaps.units import LENGTH, short
from mbs.flexible.plan import (
    AXES,
    FORMATS,
    KINDS,
    NASTRAN_NAMES,
    TOLERANCE,
    UNIT_SYSTEMS,
    Attached,
    CylinderSurface,
    NodeList,
    PlaneSurface,
    PlannedInterface,
    PlannedPoint,
    ReductionPlan,
    Surface,
    Triple,
    Turn,
    attach,
    check_reduced,
    rotation_of,
)
from mbs.model.body import FREEDOMS, Body
from mbs.scene import fields
from mbs.scene.fields import DEGREE, HERTZ, LONGEST_FILE
from mbs.scene.specs import HIGHEST_DAMPING_RATIO, ORIGIN, FlexibleSpec

if TYPE_CHECKING:
    from mbs.flexible.reduced_body import ReducedBody


_SURFACES = ("nodes", "cylinder", "plane")
_AXES: dict[str, Triple] = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_MATRIX_KEYS = ("matrices", "mesh", "units", "cutoff", "interfaces", "points")


def read_flexible(section: Table, name: str, folder: Path | None) -> FlexibleSpec | None:
    """Read a flexible body of a scene; its files must be there, and are read when the system is put together.

    Parameters
    ----------
    section : Table
        Keys: `reduced`, or `matrices`, `mesh`, `units`, `cutoff`, `interfaces`, `points`; and `position`,
        `rotation`, `damping_ratio`, `attached`.
    name : str
        Name of the body.
    folder : Path or None
        Folder in which relative paths begin; None for that of the shipped systems.

    Returns
    -------
    FlexibleSpec or None
        None where a problem was noted.
    """
    before = len(section.problems)
    position = fields.lengths(section, "position", section.get("position")) if "position" in section else ORIGIN
    ratio = section.number("damping_ratio", 0.0, HIGHEST_DAMPING_RATIO) if "damping_ratio" in section else 0.0
    source: Path | ReductionPlan | None
    if "reduced" in section:
        source = fields.file_path(section, "reduced", folder)
        for key in _MATRIX_KEYS:
            if key in section:
                section.get(key)
                section.note(key, "stands beside reduced, which has all of it; allowed: one of the two")
        if source is not None:
            path = source
            section.made(lambda: check_reduced(path))
    else:
        source = read_reduction(section, folder, "reduced, or matrices = { format, stiffness, mass, dofs }")
        for problem in source.file_problems() if source is not None else ():
            section.note("", problem)
    attached = read_attached(section)
    rotation = _rotation(section)
    if source is None or position is None or ratio is None or attached is None or len(section.problems) > before:
        return None
    return FlexibleSpec(name, source, position, ratio, attached, rotation)


def _rotation(section: Table) -> tuple[Turn, ...]:
    """Read how the body is turned: one turn, or several in their order; none where a problem was noted."""
    given = section.get("rotation")
    if "rotation" not in section:
        return ()
    entries = given if isinstance(given, list) else [given]
    turns = []
    for index, values in enumerate(entries):
        if not isinstance(values, dict):
            section.note(
                "rotation", f'got {short(given)}; allowed: {{ about = "z", angle = "90 deg" }}, or a list of such'
            )
            return ()
        table = Table(values, f"{section.where} rotation[{index}]", section.problems)
        about = table.choice("about", AXES, required=True)
        angle = table.quantity("angle", "rad", -7.0, 7.0, DEGREE, required=True)
        table.close()
        if about is not None and angle is not None:
            turns.append(Turn(about, angle))
    return tuple(turns)


def read_reduction(
    section: Table, folder: Path | None, required: str = "{ format, stiffness, mass, dofs }"
) -> ReductionPlan | None:
    """Read what is reduced and how; the files themselves are not opened.

    Parameters
    ----------
    section : Table
        Keys: `matrices`, `mesh`, `units`, `cutoff`, `interfaces`, `points`.
    folder : Path or None
        Folder in which relative paths begin; None for that of the shipped systems.
    required : str
        What a message says is missing where there are no matrices.

    Returns
    -------
    ReductionPlan or None
        None where a problem was noted.
    """
    before = len(section.problems)
    files: dict[str, Path | None] = {}
    form, names = None, NASTRAN_NAMES
    matrices = section.table("matrices", f"{section.where} matrices", required)
    if matrices:
        form = matrices.choice("format", FORMATS, required=True)
        # Abaqus and Nastran name the degrees of freedom in the matrix itself; Abaqus may.
        needed = ("stiffness", "mass") if form in ("abaqus", "nastran") else ("stiffness", "mass", "dofs")
        files = {key: fields.file_path(matrices, key, folder) for key in needed}
        if form == "abaqus":
            files["dofs"] = fields.file_path(matrices, "dofs", folder) if "dofs" in matrices else None
        if form == "nastran":
            names = (
                _entry_name(matrices, "stiffness_name", NASTRAN_NAMES[0]),
                _entry_name(matrices, "mass_name", NASTRAN_NAMES[1]),
            )
        matrices.close(("dofs", "stiffness_name", "mass_name"))
    mesh = fields.file_path(section, "mesh", folder)
    units = section.choice("units", UNIT_SYSTEMS) if "units" in section else "SI"
    cutoff = section.quantity("cutoff", "Hz", 1.0, 1e6, HERTZ, required=True)
    interfaces: dict[str, PlannedInterface] = {}
    table = section.table(
        "interfaces", f"{section.where} interfaces", "{ left = { at = [...], cylinder = {...} }, ... }"
    )
    if table is not None and not table.entries():
        section.note("interfaces", "got none; allowed: at least one place where forces act")
    for key in table.entries() if table else ():
        entry = table.table(key, f"{section.where} interfaces {key}") if table else None
        planned = _interface(entry) if entry and fields.named(entry, key) else None
        if planned:
            interfaces[key] = planned
    points: dict[str, PlannedPoint] = {}
    table = section.table("points", f"{section.where} points")
    for key in table.entries() if table else ():
        point = _point(table, key) if table and fields.named(table, key) else None
        if point is not None:
            points[key] = point
    stiffness, mass = files.get("stiffness"), files.get("mass")
    if len(section.problems) > before or form is None or units is None or cutoff is None:
        return None
    if stiffness is None or mass is None or mesh is None:
        return None
    return ReductionPlan(form, stiffness, mass, mesh, files.get("dofs"), units, cutoff, interfaces, points, names=names)


def _entry_name(section: Table, key: str, otherwise: str) -> str:
    """Read the name of a DMIG entry, which Nastran writes in capitals."""
    name = section.get(key)
    if key not in section:
        return otherwise
    if not (isinstance(name, str) and re.fullmatch(r"[A-Za-z][A-Za-z0-9]{0,7}", name)):
        section.note(key, f"got {short(name)}; allowed: a name of a DMIG, such as {otherwise!r}")
        return otherwise
    return name.upper()


def _interface(section: Table) -> PlannedInterface | None:
    """Read an interface."""
    before = len(section.problems)
    given = section.get("at", 'three lengths, x y z, such as ["70 mm", "0 mm", "0 mm"]')
    position = fields.lengths(section, "at", given)
    kind = section.choice("kind", KINDS) if "kind" in section else "averaging"
    freedoms = fields.words(section, "freedoms", FREEDOMS) if "freedoms" in section else FREEDOMS
    if freedoms is not None and (not freedoms or len(set(freedoms)) < len(freedoms)):
        section.note("freedoms", f"got {list(freedoms)!r:.80}; allowed: some of {', '.join(FREEDOMS)}, each once")
    surfaces = [key for key in _SURFACES if key in section]
    if len(surfaces) != 1:
        for key in surfaces:
            section.get(key)
        section.note("", f"got {', '.join(surfaces) or 'no surface'}; allowed: one of {', '.join(_SURFACES)}")
        surface = None
    else:
        surface = {"nodes": _nodes, "cylinder": _cylinder, "plane": _plane}[surfaces[0]](section)
    section.close(_SURFACES)
    if len(section.problems) > before or position is None or surface is None or freedoms is None:
        return None
    return PlannedInterface(position, surface, "rigid" if kind == "rigid" else "averaging", freedoms)


def _nodes(section: Table) -> Surface | None:
    """Read a list of nodes."""
    value = section.get("nodes")
    whole = isinstance(value, list) and all(isinstance(node, int) and not isinstance(node, bool) for node in value)
    if not whole or not value or not all(1 <= node <= 10**12 for node in value):
        section.note("nodes", f"got {short(value)}; allowed: a list of node numbers such as [12, 13, 14]")
        return None
    return NodeList(tuple(value))


def _cylinder(section: Table) -> Surface | None:
    """Read a cylindrical surface about an axis through the place."""
    table = section.table("cylinder", f"{section.where} cylinder")
    assert table is not None
    axis = _axis(table)
    diameter = table.quantity("diameter", "m", 1e-6, 100.0, LENGTH, required=True)
    begin = table.quantity("from", "m", -100.0, 100.0, LENGTH, required=True)
    end = table.quantity("to", "m", -100.0, 100.0, LENGTH, required=True)
    tolerance = _tolerance(table)
    table.close()
    if axis is None or diameter is None or begin is None or end is None or tolerance is None:
        return None
    if not begin <= end:
        table.note("from", f"got {LENGTH.text(begin)}, after to = {LENGTH.text(end)}; allowed: from <= to")
        return None
    return CylinderSurface(axis, diameter, begin, end, tolerance)


def _plane(section: Table) -> Surface | None:
    """Read a plane surface through the place, up to a diameter about it if one is given."""
    table = section.table("plane", f"{section.where} plane")
    assert table is not None
    axis = _axis(table)
    diameter = table.quantity("diameter", "m", 1e-6, 1000.0, LENGTH) if "diameter" in table else math.inf
    tolerance = _tolerance(table)
    table.close(("diameter",))
    if axis is None or diameter is None or tolerance is None:
        return None
    return PlaneSurface(axis, diameter, tolerance)


def _axis(table: Table) -> Triple | None:
    """Read the direction of an axis."""
    word = table.choice("axis", tuple(_AXES), required=True)
    return None if word is None else _AXES[word]


def _tolerance(table: Table) -> float | None:
    """Read how far off a surface its nodes may lie."""
    return table.quantity("tolerance", "m", 1e-9, 1.0, LENGTH) if "tolerance" in table else TOLERANCE


def _point(section: Table, key: str) -> PlannedPoint | None:
    """Read a point: a place, a node, or a surface whose mean is observed."""
    value = section.get(key)
    if isinstance(value, dict):
        entry = section.table(key, f"{section.where} {key}")
        return _interface(entry) if entry else None
    if isinstance(value, int) and not isinstance(value, bool):
        if not 1 <= value <= 10**12:
            section.note(key, f"got {value}; allowed: a node number from 1")
            return None
        return value
    return fields.lengths(section, key, value)


def content_of(source: Path | ReductionPlan | ReducedBody) -> str | None:
    """Hash of what is in the files of a source; None of a reduced body that is at hand.

    Parameters
    ----------
    source : Path, ReductionPlan or ReducedBody
        What a body is made from.

    Raises
    ------
    InputError
        If a file cannot be read.
    """
    from mbs.flexible.carry_out import file_digest, plan_key

    if isinstance(source, ReductionPlan):
        return plan_key(source)
    if not isinstance(source, Path):
        return None
    check_reduced(source)
    return f"{source.suffix}:{file_digest(source)}"


def build_flexible(spec: FlexibleSpec) -> Body:
    """The body of a reduced body, with what is fixed to it.

    Parameters
    ----------
    spec : FlexibleSpec
        The body.

    Raises
    ------
    InputError
        With everything that does not fit together.
    AnalysisError
        If the modes or static shapes of a reduction are not found.
    """
    from mbs.flexible.carry_out import reduced_body
    from mbs.flexible.reduced_body import to_body
    from mbs.flexible.reduced_file import read_reduced

    source = spec.source
    if isinstance(source, ReductionPlan):
        reduced = reduced_body(source)
    else:
        reduced = read_reduced(source) if isinstance(source, Path) else source
    turned = rotation_of(spec.rotation) if spec.rotation else None
    body = to_body(reduced, spec.name, spec.position, spec.damping_ratio, rotation=turned)
    return attach(body, spec.attached)


def read_attached(section: Table) -> tuple[Attached, ...] | None:
    """Read hollow cylinders on frames; none if the key is absent, None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table of the body.
    """
    before = len(section.problems)
    parts = []
    for part in section.tables("attached", "a list of tables with at, from, to, diameter"):
        frame = part.get("at", 'the name of a frame, such as "left"')
        inertia = fields.cylinder(part)
        if "at" in part and not isinstance(frame, str):
            part.note("at", f"got {short(frame)}; allowed: the name of a frame")
        elif inertia is not None and "at" in part:
            parts.append(Attached(frame, inertia))
    return tuple(parts) if len(section.problems) == before else None


def read_body_file(path: Path) -> ReductionPlan:
    """Read a file that says what is reduced and how.

    Parameters
    ----------
    path : Path
        TOML with the keys of a `[[flexible]]` table that has matrices, at top level.

    Raises
    ------
    InputError
        With every problem found, each beginning with the path.
    """
    values = table.parse(read_text(path, LONGEST_FILE, "a body file in TOML"), str(path))
    problems: list[str] = []
    top = Table(values, "body file", problems)
    plan = read_reduction(top, path.parent)
    # What is an assumption concerns the reader of the file only.
    top.get("assumed")
    top.close()
    if problems or plan is None:
        raise InputError([f"{path}: {problem}" for problem in problems])
    return dataclasses.replace(plan, source=path)

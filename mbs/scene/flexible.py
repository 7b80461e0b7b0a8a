"""How a flexible body is read from a file: a reduced one, or matrices, mesh and interfaces, which are reduced then."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError
from ehdmaps.jobs.table import Table
from ehdmaps.units import LENGTH, short
from mbs.flexible.calculix import check_deck, read_calculix
from mbs.flexible.extent import extent
from mbs.flexible.finite_elements import FiniteElementModel
from mbs.flexible.matrix_files import (
    UNIT_SYSTEMS,
    assemble_model,
    read_abaqus_matrix,
    read_matrix_market,
    without_fixed,
)
from mbs.flexible.mesh import DECKS, read_mesh_nodes
from mbs.flexible.reduced_body import ReducedBody, to_body
from mbs.flexible.reduced_file import read_reduced
from mbs.flexible.reduction import NEAREST, Point, reduce
from mbs.flexible.spiders import KINDS, Interface, Kind, nodes_in_plane, nodes_on_cylinder
from mbs.model.body import FREEDOMS, Body
from mbs.scene import fields
from mbs.scene.fields import HERTZ

FORMATS = ("calculix", "matrix-market", "abaqus")

TOLERANCE = 1e-4
"""How far off its surface a node of an interface may lie, if the file does not say [m]."""

_SURFACES = ("nodes", "cylinder", "plane")
_AXES = ("x", "y", "z")
_MATRIX_KEYS = ("matrices", "mesh", "units", "cutoff", "interfaces", "points")

Picked = Callable[[FiniteElementModel], IntArray]
"""Finds the nodes of an interface on a model."""


@dataclass(frozen=True)
class PlannedInterface:
    """An interface before its nodes are found: position [m], how to find nodes, kind, freedoms."""

    position: tuple[float, ...]
    pick: Picked
    kind: Kind
    freedoms: tuple[str, ...]

    def on(self, model: FiniteElementModel, name: str) -> Interface:
        """The interface on a model; InputError if no node is there."""
        nodes = self.pick(model)
        if nodes.size == 0:
            raise InputError(
                f"interface {name!r}: no node of the mesh is on its surface; allowed: a surface of the mesh; check at, "
                "axis, diameter, units and tolerance"
            )
        self._check_place(model, nodes, name)
        return Interface(np.array(self.position), nodes, self.kind, self.freedoms)

    def _check_place(self, model: FiniteElementModel, nodes: IntArray, name: str) -> None:
        """Refuse a place further from the nodes than they are from each other: a slip in a unit, or in a number."""
        known = [model.position(node) for node in nodes.tolist() if model.has_position(node)]
        if len(known) < nodes.size:
            return  # said when their displacements are looked for
        lower, upper = np.min(known, axis=0), np.max(known, axis=0)
        place = np.array(self.position)
        away = float(np.linalg.norm(place - np.clip(place, lower, upper)))
        # A single node may have a place beside it, as a point may.
        allowed = max(float(np.linalg.norm(upper - lower)), NEAREST * float(np.max(np.ptp(model.positions, axis=0))))
        if away > allowed:
            raise InputError(
                f"interface {name!r}, at: got {_shown(place)}, {LENGTH.text(away)} from its {nodes.size} nodes, whose "
                f"centroid is at {_shown(np.mean(known, axis=0))}; allowed: up to {LENGTH.text(allowed)} from them; "
                "check at, the nodes and units"
            )


@dataclass(frozen=True)
class Reduction:
    """What a table says about matrices and how to reduce them.

    Attributes
    ----------
    form : str
        One of FORMATS.
    stiffness, mass, mesh : Path
        Files.
    dofs : Path or None
        What the rows of the matrices are.
    units : str
        One of UNIT_SYSTEMS.
    cutoff : float
        [Hz].
    interfaces : mapping of str to PlannedInterface
        Where forces act.
    points : mapping
        Where the body is observed: places [m], node numbers, or averaging interfaces.
    source : Path or None
        The file that says all this, if it is one of its own.
    """

    form: str
    stiffness: Path
    mass: Path
    mesh: Path
    dofs: Path | None
    units: str
    cutoff: float
    interfaces: Mapping[str, PlannedInterface]
    points: Mapping[str, PlannedInterface | tuple[float, ...] | int] = field(default_factory=dict)
    source: Path | None = None

    @property
    def files(self) -> tuple[Path, ...]:
        """All files that are read for it."""
        named = (self.source, self.stiffness, self.mass, self.dofs, self.mesh)
        return tuple(path for path in named if path is not None)

    def model(self) -> FiniteElementModel:
        """Read the files; InputError with file and line."""
        nodes = read_mesh_nodes(self.mesh)
        if self.form == "abaqus":
            stiffness, mass = (read_abaqus_matrix(path, self.dofs) for path in (self.stiffness, self.mass))
            return assemble_model(*without_fixed(stiffness, mass), nodes, self.units)
        assert self.dofs is not None
        if self.form == "matrix-market":
            stiffness, mass = (read_matrix_market(path, self.dofs) for path in (self.stiffness, self.mass))
            return assemble_model(stiffness, mass, nodes, self.units)
        if self.mesh.suffix.lower() in DECKS:
            check_deck(self.mesh)
        return read_calculix(self.stiffness, self.mass, self.dofs, nodes, self.units)

    def carry_out(self, attributes: Mapping[str, str] | None = None) -> ReducedBody:
        """Read the files and reduce; InputError or AnalysisError."""
        return self.reduced(self.model(), attributes)

    def reduced(self, model: FiniteElementModel, attributes: Mapping[str, str] | None = None) -> ReducedBody:
        """Reduce what was read; InputError or AnalysisError."""
        problems: list[str] = []

        def found(name: str, planned: PlannedInterface) -> Interface | None:
            try:
                return planned.on(model, name)
            except InputError as error:
                problems.extend(error.problems)
                return None

        interfaces = {name: found(name, planned) for name, planned in self.interfaces.items()}
        points: dict[str, Point | None] = {
            name: found(name, planned) if isinstance(planned, PlannedInterface) else planned
            for name, planned in self.points.items()
        }
        if problems:
            # Often it is the unit.
            raise InputError([*problems, *(f"{self.mesh}: {words}" for words in extent(model).warnings(self.units))])
        return reduce(
            model,
            {name: entry for name, entry in interfaces.items() if entry is not None},
            {name: entry for name, entry in points.items() if entry is not None},
            self.cutoff,
            {"mesh": self.mesh.name, "matrices": self.form, **(attributes or {})},
        )


def read_flexible(section: Table, name: str, folder: Path | None, files: list[Path]) -> Body | None:
    """Read a flexible body of a scene.

    Parameters
    ----------
    section : Table
        Keys: `reduced`, or `matrices`, `mesh`, `units`, `cutoff`, `interfaces`, `points`; and `position`,
        `damping_ratio`. Matrices are reduced anew at every reading; `mbs reduce` does it once.
    name : str
        Of the body.
    folder : Path or None
        Where relative paths begin; None for the folder of the shipped systems.
    files : list of Path
        All files that are read for the body are added to it.

    Returns
    -------
    Body or None
        None where a problem was noted.
    """
    before = len(section.problems)
    position = fields.lengths(section, "position", section.get("position")) if "position" in section else (0.0,) * 3
    ratio = section.number("damping_ratio", 0.0, 0.99) if "damping_ratio" in section else 0.0
    if "reduced" in section:
        path = _path(section, "reduced", folder)
        for key in _MATRIX_KEYS:
            if key in section:
                section.get(key)
                section.note(key, "stands beside reduced, which has all of it; allowed: one of the two")
        files += [path] if path is not None else []
        reduced = fields.built(section, lambda: read_reduced(path)) if path is not None else None
    else:
        plan = read_reduction(section, folder, "reduced, or matrices = { format, stiffness, mass, dofs }")
        files += plan.files if plan is not None else ()
        reduced = fields.built(section, plan.carry_out) if plan is not None else None
    if reduced is None or position is None or ratio is None or len(section.problems) > before:
        return None
    return fields.built(section, lambda: to_body(reduced, name, position, ratio))


def read_reduction(
    section: Table, folder: Path | None, required: str = "{ format, stiffness, mass, dofs }"
) -> Reduction | None:
    """Read what is reduced and how; the files themselves are not opened.

    Parameters
    ----------
    section : Table
        Keys: `matrices`, `mesh`, `units`, `cutoff`, `interfaces`, `points`.
    folder : Path or None
        Where relative paths begin; None for the folder of the shipped systems.
    required : str
        What a message says is missing where there are no matrices.

    Returns
    -------
    Reduction or None
        None where a problem was noted.
    """
    before = len(section.problems)
    files: dict[str, Path | None] = {}
    form = None
    matrices = section.table("matrices", f"{section.where} matrices", required)
    if matrices:
        form = matrices.choice("format", FORMATS, required=True)
        # Only Abaqus may name the degrees of freedom in the matrix itself.
        needed = ("stiffness", "mass") if form == "abaqus" else ("stiffness", "mass", "dofs")
        files = {key: _path(matrices, key, folder) for key in needed}
        if form == "abaqus":
            files["dofs"] = _path(matrices, "dofs", folder) if "dofs" in matrices else None
        matrices.close(("dofs",))
    mesh = _path(section, "mesh", folder)
    units = section.choice("units", UNIT_SYSTEMS) if "units" in section else "SI"
    cutoff = section.quantity("cutoff", "Hz", 1.0, 1e6, HERTZ, required=True)
    interfaces: dict[str, PlannedInterface] = {}
    table = section.table(
        "interfaces", f"{section.where} interfaces", "{ left = { at = [...], cylinder = {...} }, ... }"
    )
    for key in table.entries() if table else ():
        entry = table.table(key, f"{section.where} interfaces {key}") if table else None
        planned = _interface(entry) if entry and _named(entry, key) else None
        if planned:
            interfaces[key] = planned
    points: dict[str, PlannedInterface | tuple[float, ...] | int] = {}
    table = section.table("points", f"{section.where} points")
    for key in table.entries() if table else ():
        point = _point(table, key) if table and _named(table, key) else None
        if point is not None:
            points[key] = point
    stiffness, mass = files.get("stiffness"), files.get("mass")
    if len(section.problems) > before or form is None or units is None or cutoff is None:
        return None
    if stiffness is None or mass is None or mesh is None:
        return None
    return Reduction(form, stiffness, mass, mesh, files.get("dofs"), units, cutoff, interfaces, points)


def _shown(place: FloatArray) -> str:
    """A place in words."""
    return ", ".join(LENGTH.text(value) for value in place.tolist())


def _path(section: Table, key: str, folder: Path | None) -> Path | None:
    """Read the path of a file."""
    value = section.get(key, "the path of a file")
    if key not in section:
        return None
    if not isinstance(value, str) or not 1 <= len(value) <= 1000 or "\0" in value:
        section.note(key, f"got {short(value)}; allowed: the path of a file, beside this one or absolute")
        return None
    beside = Path(str(resources.files("mbs") / "systems")) if folder is None else folder
    return beside / value


def _named(section: Table, key: str) -> bool:
    """Whether a name is one; notes a problem."""
    good = 1 <= len(key) <= 100 and ":" not in key and "." not in key
    if not good:
        section.note("", f"got the name {short(key)}; allowed: a short name without : and .")
    return good


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
        pick = None
    else:
        pick = {"nodes": _nodes, "cylinder": _cylinder, "plane": _plane}[surfaces[0]](section, position or (0.0,) * 3)
    section.close(_SURFACES)
    if len(section.problems) > before or position is None or pick is None or freedoms is None:
        return None
    return PlannedInterface(position, pick, "rigid" if kind == "rigid" else "averaging", freedoms)


def _nodes(section: Table, position: tuple[float, ...]) -> Picked | None:
    """Read a list of nodes."""
    value = section.get("nodes")
    whole = isinstance(value, list) and all(isinstance(node, int) and not isinstance(node, bool) for node in value)
    if not whole or not value or not all(1 <= node <= 10**12 for node in value):
        section.note("nodes", f"got {short(value)}; allowed: a list of node numbers such as [12, 13, 14]")
        return None
    return lambda model: np.array(value, dtype=np.int64)


def _cylinder(section: Table, position: tuple[float, ...]) -> Picked | None:
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
    return lambda model: nodes_on_cylinder(model, position, axis, 0.5 * diameter, begin, end, tolerance)


def _plane(section: Table, position: tuple[float, ...]) -> Picked | None:
    """Read a plane surface through the place, up to a diameter about it if one is given."""
    table = section.table("plane", f"{section.where} plane")
    assert table is not None
    axis = _axis(table)
    diameter = table.quantity("diameter", "m", 1e-6, 1000.0, LENGTH) if "diameter" in table else np.inf
    tolerance = _tolerance(table)
    table.close(("diameter",))
    if axis is None or diameter is None or tolerance is None:
        return None
    return lambda model: nodes_in_plane(model, position, axis, tolerance, 0.5 * diameter)


def _axis(table: Table) -> tuple[float, ...] | None:
    """Read the direction of an axis."""
    word = table.choice("axis", _AXES, required=True)
    return None if word is None else tuple(float(word == name) for name in _AXES)


def _tolerance(table: Table) -> float | None:
    """Read how far off a surface its nodes may lie."""
    return table.quantity("tolerance", "m", 1e-9, 1.0, LENGTH) if "tolerance" in table else TOLERANCE


def _point(section: Table, key: str) -> PlannedInterface | tuple[float, ...] | int | None:
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

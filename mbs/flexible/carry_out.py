"""Carries out a plan of a reduction, and keeps it: what was reduced once is not reduced again.

A reduction is known by its content: a hash of the bytes of all files, of what is planned, and of the code that carries
it out. It is kept in the memory of the process, and as a file in the folder of `kept_folder`. That folder may be
removed at any time. What cannot be read there is made again, and where nothing can be written nothing is kept.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError, Problems
from ehdmaps.inputs import check_input
from ehdmaps.outputs import Kind, cache_folder, others_may_write, own_folder
from ehdmaps.provenance import code_hash
from ehdmaps.units import LENGTH
from mbs.flexible.finite_elements import FiniteElementModel, extent
from mbs.flexible.matrix_files import (
    assemble_model,
    check_deck,
    read_abaqus_matrix,
    read_calculix,
    read_matrix_market,
    without_fixed,
)
from mbs.flexible.mesh_files import DECKS, read_mesh_nodes
from mbs.flexible.nastran_files import read_nastran
from mbs.flexible.number_table import LONGEST_FILE
from mbs.flexible.plan import CylinderSurface, NodeList, PlannedInterface, ReductionPlan
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.reduced_file import read_reduced, write_reduced
from mbs.flexible.reduction import NEAREST, Interface, Point, nodes_in_plane, nodes_on_cylinder, reduce
from mbs.flexible.skin import read_skin


def carry_out(plan: ReductionPlan) -> ReducedBody:
    """Read the files of a plan and reduce the body.

    Raises
    ------
    InputError
        For files that do not read or do not fit together, and interfaces that are not on the body.
    AnalysisError
        If the modes or static shapes are not found.
    """
    return reduce_model(plan, read_model(plan))


def read_model(plan: ReductionPlan) -> FiniteElementModel:
    """Read the files of a plan.

    Raises
    ------
    InputError
        With file and line.
    """
    if plan.form == "nastran":
        return read_nastran(plan.stiffness, plan.mass, plan.mesh, plan.names, plan.units)
    nodes = read_mesh_nodes(plan.mesh)
    if plan.form == "abaqus":
        stiffness, mass = (read_abaqus_matrix(path, plan.dofs) for path in (plan.stiffness, plan.mass))
        return assemble_model(*without_fixed(stiffness, mass), nodes, plan.units)
    if plan.dofs is None:
        raise InputError(f"matrices, dofs: got none; the format {plan.form} needs a file of its degrees of freedom")
    if plan.form == "matrix-market":
        stiffness, mass = (read_matrix_market(path, plan.dofs) for path in (plan.stiffness, plan.mass))
        return assemble_model(stiffness, mass, nodes, plan.units)
    if plan.mesh.suffix.lower() in DECKS:
        check_deck(plan.mesh)
    return read_calculix(plan.stiffness, plan.mass, plan.dofs, nodes, plan.units)


def reduce_model(
    plan: ReductionPlan, model: FiniteElementModel, attributes: Mapping[str, str] | None = None
) -> ReducedBody:
    """Reduce what was read.

    Parameters
    ----------
    plan : ReductionPlan
        Interfaces, points and cut-off.
    model : FiniteElementModel
        What its files hold.
    attributes : mapping of str to str, optional
        Provenance, added to the result's own.

    Raises
    ------
    InputError
        For interfaces and points that are not on the body.
    AnalysisError
        If the modes or static shapes are not found.
    """
    problems = Problems()

    def interface(name: str, planned: PlannedInterface) -> Interface | None:
        with problems:
            return _interface(planned, model, name)
        return None

    interfaces = {name: interface(name, planned) for name, planned in plan.interfaces.items()}
    points: dict[str, Point | None] = {
        name: interface(name, planned) if isinstance(planned, PlannedInterface) else planned
        for name, planned in plan.points.items()
    }
    if problems:
        # Often it is the unit.
        raise InputError([*problems, *(f"{plan.mesh}: {words}" for words in extent(model).warnings(plan.units))])
    return reduce(
        model,
        {name: entry for name, entry in interfaces.items() if entry is not None},
        {name: entry for name, entry in points.items() if entry is not None},
        plan.cutoff,
        {"mesh": plan.mesh.name, "matrices": plan.form, **(attributes or {})},
        read_skin(plan.mesh),
    )


def _interface(planned: PlannedInterface, model: FiniteElementModel, name: str) -> Interface:
    """The interface on a model; InputError if no node is there."""
    nodes = interface_nodes(planned, model)
    if nodes.size == 0:
        raise InputError(
            f"interface {name!r}: no node of the mesh is on its surface; allowed: a surface of the mesh; check at, "
            "axis, diameter, units and tolerance"
        )
    _check_place(planned, model, nodes, name)
    return Interface(np.array(planned.position), nodes, planned.kind, planned.freedoms)


def interface_nodes(planned: PlannedInterface, model: FiniteElementModel) -> IntArray:
    """Numbers of the nodes on the surface of an interface.

    Parameters
    ----------
    planned : PlannedInterface
        The interface.
    model : FiniteElementModel
        The body.
    """
    place, surface = planned.position, planned.surface
    if isinstance(surface, NodeList):
        return np.array(surface.numbers, dtype=np.int64)
    radius = 0.5 * surface.diameter
    if isinstance(surface, CylinderSurface):
        ends = (surface.begin, surface.end)
        return nodes_on_cylinder(model, place, surface.axis, radius, *ends, surface.tolerance)
    return nodes_in_plane(model, place, surface.axis, surface.tolerance, radius)


def _check_place(planned: PlannedInterface, model: FiniteElementModel, nodes: IntArray, name: str) -> None:
    """Refuse a place further from the nodes than they are from each other: a slip in a unit, or in a number."""
    known = [model.position(node) for node in nodes.tolist() if model.has_position(node)]
    if len(known) < nodes.size:
        return  # said when their displacements are looked for
    lower, upper = np.min(known, axis=0), np.max(known, axis=0)
    place = np.array(planned.position)
    away = float(np.linalg.norm(place - np.clip(place, lower, upper)))
    # A single node may have a place beside it, as a point may.
    allowed = max(float(np.linalg.norm(upper - lower)), NEAREST * float(np.max(np.ptp(model.positions, axis=0))))
    if away > allowed:
        raise InputError(
            f"interface {name!r}, at: got {_shown(place)}, {LENGTH.text(away)} from its {nodes.size} nodes, whose "
            f"centroid is at {_shown(np.mean(known, axis=0))}; allowed: up to {LENGTH.text(allowed)} from them; "
            "check at, the nodes and units"
        )


def _shown(place: FloatArray) -> str:
    """A place in words."""
    return ", ".join(LENGTH.text(value) for value in place.tolist())


FOLDER_VARIABLE = "EHDMAPS_REDUCED"
"""Environment variable that names another folder."""

MOST_IN_MEMORY = 16
"""Bodies; each takes some megabytes at most."""

_KEPT = Kind("a reduction that mbs keeps", (".npz",), lambda path: True)
"""All that stands in our own folder is ours, whatever became of it."""

_memory: dict[str, ReducedBody] = {}


def reduced_body(plan: ReductionPlan) -> ReducedBody:
    """Return the reduced body of a plan, kept from before or reduced now.

    Raises
    ------
    InputError
        For files that do not read or do not fit together, and interfaces that are not on the body.
    AnalysisError
        If the modes or static shapes are not found.
    """
    key = plan_key(plan)
    body = _memory.get(key) or _from_disk(key)
    if body is None:
        body = carry_out(plan)
        if plan_key(plan) != key:  # a file was changed meanwhile: nobody knows what was read
            return body
        _to_disk(key, body)
    _memory[key] = body
    while len(_memory) > MOST_IN_MEMORY:
        del _memory[next(iter(_memory))]
    return body


def plan_key(plan: ReductionPlan) -> str:
    """Hash of all that a reduction depends on: content of the files, plan and code; in hexadecimal digits.

    Raises
    ------
    InputError
        If a file cannot be read.
    """
    digest = hashlib.sha256(code_hash().encode())
    for name in ("stiffness", "mass", "dofs", "mesh"):
        path = getattr(plan, name)
        digest.update(f"\0{name}:{file_digest(path) if path is not None else ''}".encode())
    # The ending of a mesh says its format, and its name stands in the result.
    settings = (
        plan.form,
        plan.names,
        plan.units,
        plan.cutoff,
        plan.mesh.name,
        list(plan.interfaces.items()),
        list(plan.points.items()),
    )
    digest.update(repr(settings).encode())
    return digest.hexdigest()


def file_digest(path: Path) -> str:
    """Hash of the content of a file.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    check_input(path, LONGEST_FILE, "a file of the body", "take a coarser mesh")
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        cause = error.strerror or str(error)
        raise InputError(f"{path}: cannot be read ({cause}); allowed: a file of the body") from error


def kept_folder(environment: Mapping[str, str]) -> Path:
    """Return where reductions are kept: $EHDMAPS_REDUCED, or in the user's folder for caches."""
    return cache_folder("reduced", FOLDER_VARIABLE, environment)


def _from_disk(key: str) -> ReducedBody | None:
    """Read what was kept; None where there is nothing, or nothing that can be read."""
    try:
        folder = kept_folder(os.environ)
        return None if others_may_write(folder) else read_reduced(folder / f"{key}.npz")
    except (InputError, RuntimeError):  # no home folder is a RuntimeError
        return None


def _to_disk(key: str, body: ReducedBody) -> None:
    """Keep a reduction, where it can be written."""
    with contextlib.suppress(InputError, OSError, RuntimeError):
        folder = own_folder(kept_folder(os.environ))
        write_reduced(folder / f"{key}.npz", body, _KEPT)

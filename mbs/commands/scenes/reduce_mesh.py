"""`mbs reduce MESH`: a housing from its mesh, with seats and feet by groups or by coordinates."""

from __future__ import annotations

import argparse
import math
import re
import tempfile
import time
from pathlib import Path

import numpy as np

from ehdmaps.choices import read_option
from ehdmaps.errors import InputError, Problems, closest, short
from ehdmaps.extras import lacking
from ehdmaps.jobs.make.status import duration
from ehdmaps.outputs import Output, output_problems
from ehdmaps.physics.solids import MATERIALS, Material
from ehdmaps.program import tell
from ehdmaps.solids.calculix import program
from ehdmaps.units import quantity
from mbs.flexible.carry_out import read_model, reduce_model
from mbs.flexible.finite_elements import COARSER, FiniteElementModel, extent
from mbs.flexible.plan import (
    CylinderSurface,
    Kind,
    NodeList,
    PlaneSurface,
    PlannedInterface,
    PlannedPoint,
    ReductionPlan,
    Surface,
    Triple,
)
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.reduced_file import REDUCED
from mbs.flexible.solid_mesh import UNITS, SolidMesh, assembled, materials_of, read_solid
from mbs.scene.fields import HERTZ

SEAT = "'NAME = X Y Z mm, DIAMETER mm x WIDTH mm, AXIS', or NAME=GROUP"
FOOT = "'NAME = X Y Z mm, DIAMETER mm, AXIS', or NAME=GROUP"
POINT = "'NAME = X Y Z mm', or NAME=GROUP"

CUTOFF = 10e3
"""Highest frequency of the modes that are kept where none is stated [Hz]."""

TOLERANCE = 0.02
"""How far off a surface a node may lie, as a part of its diameter: chords of a coarse mesh lie inside."""

_AXES: dict[str, Triple] = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_NUMBER = r"[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?"
_PLACE = re.compile(rf"\s*({_NUMBER})[ ,;]+({_NUMBER})[ ,;]+({_NUMBER})\s*(m|mm)\s*")


def reduced_mesh(arguments: argparse.Namespace) -> tuple[ReductionPlan, FiniteElementModel, ReducedBody, list[str]]:
    """Read a mesh, have CalculiX assemble it, and reduce it.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.

    Returns
    -------
    plan : ReductionPlan
        Plan of the reduction; its files are gone.
    model : FiniteElementModel
        The assembled body.
    reduced : ReducedBody
        The reduced body.
    lines : list of str
        What was read, and taken.

    Raises
    ------
    InputError
        With every problem.
    AnalysisError
        If CalculiX or the reduction fails.
    """
    path = Path(arguments.body)
    problems = Problems(lacking("flexible", "meshio", f"{path}"))
    with problems:
        program("assembling a mesh")  # said before a large file is read
    found = read_option("--cutoff", arguments.cutoff, "Hz", (1.0, 1e6), HERTZ, problems)
    cutoff = CUTOFF if found is None else found
    if not arguments.seat:
        problems.append(f"--seat: got none; allowed: {SEAT}")
    target = Path(arguments.output or path.with_suffix(".nc"))
    problems += output_problems([Output("-o", target, REDUCED)], [path])
    unit, materials, words = 1.0, dict[str, Material](), ""
    with problems:
        unit, materials, words = _materials(path, arguments.units, arguments.material)
    problems.check()
    began = time.process_time()
    mesh = read_solid(path, unit)
    problems += [
        f"--material: got the group {name!r:.60}{closest(name, tuple(mesh.parts))}; allowed: "
        f"{', '.join(mesh.parts) or 'no group: the mesh has none of elements'}"
        for name in materials
        if name and name not in mesh.parts
    ]
    interfaces: dict[str, PlannedInterface] = {}
    points: dict[str, PlannedPoint] = {}
    for option, texts, kind in (("seat", arguments.seat, "averaging"), ("foot", arguments.foot, "rigid")):
        for text in texts or ():
            with problems:
                name, planned = _interface(mesh, text, option, kind)
                if name in interfaces:
                    raise InputError(f"--{option}: got {name!r:.40} twice")
                interfaces[name] = planned
    for text in arguments.point or ():
        with problems:
            name, place = _point(mesh, text)
            points[name] = place
    problems.check()
    words_of_effort, memory = _effort(mesh)
    if memory > (there := _available()):
        raise InputError(f"{path}: {words_of_effort}; allowed: the {there:.2g} GB that are free; {COARSER}")
    tell(f"{path}: {words_of_effort}")
    with tempfile.TemporaryDirectory(prefix="mbs-reduce-") as folder:
        stiffness, mass, dofs, deck = assembled(mesh, materials, Path(folder))
        tell(f"{path}: assembled by CalculiX")
        plan = ReductionPlan("calculix", stiffness, mass, deck, dofs, "SI", cutoff, interfaces, points)
        model = read_model(plan)
        about = {"command": f"mbs reduce {path.name}", "mesh": path.name, "material": words}
        reduced = reduce_model(plan, model, about)
    sizes = extent(model)
    tell(f"{path}: reduced")
    lines = [
        f"{path}: {mesh.count} elements, {len(mesh.positions)} nodes; {words}",
        *([f"  left out: {', '.join(mesh.left_out)}"] if mesh.left_out else []),
        *(f"  {name}: {_count(planned, model)} nodes" for name, planned in interfaces.items()),
        f"  {sizes.mass:.6g} kg; assembled and reduced in {time.process_time() - began:.3g} s beside CalculiX",
    ]
    return plan, model, reduced, lines


_FIXED, _EACH, _TIME, _SIZE, _POWER = 0.5, 15.5e-6, 27.0, 39e3, 1.25
"""Memory [GB] of any body and of each degree of freedom, from boxes of 13 000 and 332 000 nodes; processor time [s] of
the former, and a power between those of reading (1) and of factors (4/3)."""


def _available() -> float:
    """Memory that programs may take before the system swaps [GB]; infinite where it is not told."""
    try:
        found = re.search(r"MemAvailable:\s*(\d+) kB", Path("/proc/meminfo").read_text("ascii"))
    except OSError:
        found = None
    return 1024e-9 * int(found[1]) if found else math.inf


def _effort(mesh: SolidMesh) -> tuple[str, float]:
    """Size of a mesh, and about how long it takes and how much memory; the latter [GB]."""
    size = 3 * len(mesh.positions)
    lasting, memory = duration(_TIME * (size / _SIZE) ** _POWER), _FIXED + _EACH * size
    words = f"{mesh.count} elements, {size} degrees of freedom; about {lasting} and {memory:.2g} GB beside CalculiX"
    return words, memory


def _count(planned: PlannedInterface, model: FiniteElementModel) -> int:
    """Number of nodes of an interface."""
    from mbs.flexible.carry_out import interface_nodes

    return int(interface_nodes(planned, model).size)


def _materials(path: Path, units: str | None, given: list[str] | None) -> tuple[float, dict[str, Material], str]:
    """Unit of the lengths of a mesh, its materials in SI by groups of elements, and both in words."""
    if units is not None and units not in UNITS:
        raise InputError(f"--units: got {units!r:.40}{closest(units, tuple(UNITS))}; allowed: {', '.join(UNITS)}")
    if given:
        if units is None:
            raise InputError(f"--units: got none; allowed: {' or '.join(UNITS)}, the unit of the lengths of {path}")
        found: dict[str, Material] = {}
        for text in given:
            group, _, name = (part.strip() for part in text.rpartition("="))
            if name not in MATERIALS:
                allowed = f"{', '.join(MATERIALS)}, or 'GROUP = MATERIAL' for elements of a group"
                raise InputError(f"--material: got {short(name)}{closest(name, tuple(MATERIALS))}; allowed: {allowed}")
            if group in found:
                raise InputError(f"--material: got {short(group or 'all')} twice; allowed: one for each group")
            found[group] = MATERIALS[name]
        told = [f"{group or 'all others' if given[1:] else ''} {name}".strip() for group, name in _told(given)]
        return UNITS[units], found, f"{', '.join(told)} as stated, {_each(found)}"
    stated = materials_of(path)
    if not stated:
        raise InputError(f"--material: got none, and {path} has no material; allowed: {', '.join(MATERIALS)}")
    # Young's moduli of metals: 1e10 Pa and more, in N/mm2 1e4 and more.
    largest = max(one.youngs_modulus for one in stated.values())
    in_mm = largest < 1e8
    if units is not None and in_mm != (units == "mm"):
        raise InputError(
            f"--units: got {units!r}, but E is {largest:.4g} in {path}; allowed: {'mm' if in_mm else 'm'}, in which "
            "that is a metal; or state --material"
        )
    # In mm, t, s: N/mm2 and t/mm3.
    factor, heavier = (1e6, 1e12) if in_mm else (1.0, 1.0)
    own = {
        name: Material(factor * one.youngs_modulus, one.poisson_ratio, heavier * one.density)
        for name, one in stated.items()
    }
    unit = "mm" if in_mm else "m"
    return UNITS[unit], own, f"material of the file, {_each(own)}; lengths in {unit}"


def _told(given: list[str]) -> list[tuple[str, str]]:
    """Groups and names of materials."""
    return [(group.strip(), name.strip()) for group, _, name in (text.rpartition("=") for text in given)]


def _each(materials: dict[str, Material]) -> str:
    """Materials in words."""
    return "; ".join(f"{f'{name}: ' if name else ''}{_words(one)}" for name, one in materials.items())


def _words(material: Material) -> str:
    """A material in words."""
    return f"E {material.youngs_modulus / 1e9:.4g} GPa, nu {material.poisson_ratio:.3g}, {material.density:.4g} kg/m3"


def _named(text: str, option: str, form: str) -> tuple[str, str]:
    """Name and place of an option."""
    name, equals, place = (part.strip() for part in text.partition("="))
    if not equals or not place or not re.fullmatch(r"[A-Za-z_]\w*", name):
        raise InputError(f"--{option}: got {short(text)}; allowed: {form}")
    return name, place


def _interface(mesh: SolidMesh, text: str, option: str, kind: Kind | str) -> tuple[str, PlannedInterface]:
    """A seat or a foot."""
    form = SEAT if option == "seat" else FOOT
    name, place = _named(text, option, form)
    tie: Kind = "rigid" if kind == "rigid" else "averaging"
    if place in mesh.groups:
        nodes = mesh.groups[place]
        there = mesh.positions[nodes - 1]
        middle = 0.5 * (there.min(axis=0) + there.max(axis=0))
        return name, PlannedInterface(_triple(middle), NodeList(tuple(nodes.tolist())), tie)
    parts = [part.strip() for part in place.split(",")]
    found = _PLACE.fullmatch(",".join(parts[:-2])) if len(parts) >= 3 else None
    axis = _AXES.get(parts[-1])
    if found is None or axis is None:
        groups = tuple(mesh.groups)
        raise InputError(
            f"--{option}: got {short(text)}{closest(place, groups)}; allowed: {form}; groups of the mesh: "
            f"{', '.join(groups) or 'none'}"
        )
    at = _scaled(found)
    sizes = [part.strip() for part in parts[-2].split(" x ")]
    lengths = [quantity(size, "m") for size in sizes]
    surface: Surface
    if option == "seat" and len(lengths) == 2:
        diameter, width = lengths
        surface = CylinderSurface(axis, diameter, -0.5 * width, 0.5 * width, TOLERANCE * diameter)
    elif option == "foot" and len(lengths) == 1:
        surface = PlaneSurface(axis, lengths[0], TOLERANCE * lengths[0])
    else:
        raise InputError(f"--{option}: got {short(text)}; allowed: {form}")
    if not all(length > 0.0 for length in lengths):
        raise InputError(f"--{option}: got {short(text)}; allowed: sizes above 0")
    return name, PlannedInterface(at, surface, tie)


def _point(mesh: SolidMesh, text: str) -> tuple[str, PlannedPoint]:
    """A place where the body is observed: the nearest node, or the mean of a group."""
    name, place = _named(text, "point", POINT)
    if place in mesh.groups:
        nodes = mesh.groups[place]
        return name, PlannedInterface(
            _triple(mesh.positions[nodes - 1].mean(axis=0)), NodeList(tuple(nodes.tolist())), "averaging"
        )
    found = _PLACE.fullmatch(place)
    if found is None:
        raise InputError(f"--point: got {short(text)}; allowed: {POINT}")
    apart = np.linalg.norm(mesh.positions - np.array(_scaled(found)), axis=1)
    return name, int(np.argmin(apart)) + 1


def _scaled(found: re.Match[str]) -> Triple:
    """A place [m]."""
    unit = UNITS[found[4]]
    return unit * float(found[1]), unit * float(found[2]), unit * float(found[3])


def _triple(values: np.ndarray) -> Triple:
    """A place as plain numbers."""
    x, y, z = values.tolist()
    return x, y, z

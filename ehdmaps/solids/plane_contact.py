"""The contact of a roller and a ring solved by CalculiX: no pressure is assumed, unlike in `ehdmaps.solids.plane`.

It is the second method by which the law of the approach is checked: a quarter of the roller stands on half of the ring,
the plane through the roller's axis is pressed down, and CalculiX finds the pressure and the width of the contact.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import AnalysisError
from ehdmaps.physics.solids import Material
from ehdmaps.solids.calculix import run_deck
from ehdmaps.solids.mesh_plane import PlaneMesh

PURPOSE = "the contact of a roller and a ring"

STIFFNESS = 1e9
"""Pressure over overclosure of the contact [N/mm3]: 1 GPa presses the surfaces 1 nm into each other."""

_JOB = "contact"
_MM = 1e3
_MPA = 1e-6
_PER_LINE = 12
_FORCE = re.compile(r"total force \(fx,fy,fz\) for set MIDDLE.*\n\s*\n?\s*(\S+)\s+(\S+)\s+(\S+)")


def contact_loads(
    roller: PlaneMesh, ring: PlaneMesh, material: Material, approaches: Sequence[float], reach: float
) -> FloatArray:
    """Loads at given approaches between the plane through the roller's axis and the seat of the ring.

    Parameters
    ----------
    roller : PlaneMesh
        Quarter of the roller.
    ring : PlaneMesh
        Half of the ring, which is held at its seat.
    material : Material
        Material of both.
    approaches : sequence of float
        Approaches [m], rising.
    reach : float
        Distance from the middle within which the surfaces may touch [m].

    Returns
    -------
    array, shape (approaches,)
        w [N/m].

    Raises
    ------
    InputError
        If CalculiX is missing.
    AnalysisError
        If it finds no contact.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        text = "\n".join(_deck(roller, ring, material, approaches, reach)) + "\n"
        run_deck(text, folder, _JOB, PURPOSE)
        path = folder / f"{_JOB}.dat"
        forces = _FORCE.findall(path.read_text("utf-8", "replace")) if path.is_file() else []
    if len(forces) != len(approaches):
        raise AnalysisError(
            f"CalculiX: {path.name} holds {len(forces)} of {len(approaches)} forces; take smaller elements"
        )
    return 2.0 * _MM * np.abs([float(force[1]) for force in forces])


def _deck(
    roller: PlaneMesh, ring: PlaneMesh, material: Material, approaches: Sequence[float], reach: float
) -> Iterator[str]:
    """The deck in mm, N and MPa, line by line; the thickness of the plane is 1 mm."""
    inside = ring.far < ring.surface
    positions, elements = roller.positions.copy(), roller.elements
    if inside:  # the roller stands on the ring: its contact is turned downwards
        positions[:, 1] *= -1.0
        elements = elements[:, [0, 2, 1, 5, 4, 3]]
    positions[:, 1] += ring.surface + (roller.surface if inside else -roller.surface)
    count = len(roller.positions)
    yield "*NODE, NSET=ALL"
    # CalculiX reads no more than 20 characters a number
    for number, (x, y) in enumerate(np.concatenate([positions, ring.positions]).tolist(), start=1):
        yield f"{number},{_MM * x:.12e},{_MM * y:.12e},0."
    first = 1
    for name, part in (("ROLLER", elements + 1), ("RING", ring.elements + 1 + count)):
        yield f"*ELEMENT, TYPE=CPE6, ELSET={name}"
        for number, nodes in enumerate(part.tolist(), start=first):
            yield ",".join(map(str, [number, *nodes]))
        first += len(part)
    yield from ("*MATERIAL, NAME=MATERIAL", "*ELASTIC")
    yield f"{_MPA * material.youngs_modulus:.12e},{material.poisson_ratio:.12e}"
    for name in ("ROLLER", "RING"):
        yield from (f"*SOLID SECTION, ELSET={name}, MATERIAL=MATERIAL", "1.")
    # an element that is turned keeps its edges under other numbers, so edges are found in the elements as written
    for name, part, mesh, start in (
        ("SLAVE", elements, roller, 1),
        ("MASTER", ring.elements, ring, 1 + len(elements)),
    ):
        yield f"*SURFACE, NAME={name}, TYPE=ELEMENT"
        for element, face in _faces(part, mesh, reach):
            yield f"{element + start},S{face}"
    yield from ("*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR")
    yield f"{STIFFNESS:.6e},1.e-3,1.e-3"
    yield from ("*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "SLAVE,MASTER")
    yield from _set("MIDDLE", np.flatnonzero(roller.on_axis(1)))
    yield from _set("SEAT", np.flatnonzero(ring.on_circle(ring.far)) + count)
    symmetric = np.concatenate([np.flatnonzero(roller.on_axis(0)), np.flatnonzero(ring.on_axis(0)) + count])
    yield from _set("SYMMETRIC", symmetric)
    yield from ("*BOUNDARY", "SYMMETRIC,1,1", "SEAT,1,2", "MIDDLE,2,2")
    for approach in approaches:
        yield from ("*STEP, NLGEOM=NO, INC=200", "*STATIC", "1.,1.")
        yield from ("*BOUNDARY", f"MIDDLE,2,2,{(-_MM if inside else _MM) * approach:.12e}")
        yield from ("*NODE PRINT, NSET=MIDDLE, TOTALS=ONLY, FREQUENCY=1000", "RF", "*END STEP")


def _faces(elements: IntArray, mesh: PlaneMesh, reach: float) -> Iterator[tuple[int, int]]:
    """Yield element and face, counted from 0 and 1, of the edges on the surface within reach of the contact."""
    near = mesh.on_circle(mesh.surface) & (mesh.positions[:, 1] > 0.0) & (mesh.positions[:, 0] <= reach)
    for face, corners in enumerate(((0, 1), (1, 2), (2, 0)), start=1):
        for element in np.flatnonzero(near[elements[:, corners]].all(axis=1)):
            yield int(element), face


def _set(name: str, nodes: IntArray) -> Iterator[str]:
    """Lines of a set of nodes, whose indices count from 0."""
    yield f"*NSET, NSET={name}"
    numbers = (nodes + 1).tolist()
    for first in range(0, len(numbers), _PER_LINE):
        yield ",".join(map(str, numbers[first : first + _PER_LINE]))

"""The same bricks in CalculiX, with its own contact by penalty: a second program for the load of an approach."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import AnalysisError
from ehdmaps.physics.solids import Material
from ehdmaps.solids.calculix import run_deck
from ehdmaps.solids.three_d_mesh import Block

PURPOSE = "checking the contact of a roller of finite length"

_JOB = "length"
_PENALTY = 5e7
"""Stiffness of the contact in CalculiX [N/mm3]: 0.03 um at 1.5 GPa."""

_PER_LINE = 12
_TOTAL = re.compile(r"total force \(fx,fy,fz\) for set STANDS.*\n\s*\n\s*(\S+)\s+(\S+)\s+(\S+)")


def load_by_calculix(
    roller: Block, race: Block, depths: FloatArray, material: Material, approach: float, folder: Path
) -> float:
    """Load of the whole roller at an approach [N], of a quarter model that CalculiX solves.

    Parameters
    ----------
    roller, race : Block
        The bodies, see `quarter_meshes`.
    depths : array (ny,)
        Profile of the roller in its layers [m].
    material : Material
        Material of both bodies.
    approach : float
        How far the middle plane of the roller comes nearer to the ground [m].
    folder : Path
        Empty, for the files of CalculiX.

    Raises
    ------
    InputError
        If CalculiX is missing.
    AnalysisError
        If it fails, or prints no load.
    """
    text = "\n".join(_deck(roller, race, depths, material, approach)) + "\n"
    run_deck(text, folder, _JOB, PURPOSE)
    found = _TOTAL.findall((folder / f"{_JOB}.dat").read_text("utf-8", "replace"))
    if not found:
        raise AnalysisError(f"CalculiX: {_JOB}.dat holds no total force; the contact may not have converged")
    return -4.0 * float(found[-1][2])


def _deck(roller: Block, race: Block, depths: FloatArray, material: Material, approach: float) -> Iterator[str]:
    """The deck in N and mm, in which the limits of its contact search are made."""
    shaped = roller.positions.copy()
    # The profile moves the surface, and the columns below less and less.
    top, surface = shaped[:, :, -1:, 2], shaped[:, :, :1, 2]
    shaped[..., 2] += depths[:, None, None] * (top - shaped[..., 2]) / (top - surface)
    first = shaped.size // 3
    positions = np.concatenate([shaped.reshape(-1, 3), race.positions.reshape(-1, 3)])
    yield "*NODE, NSET=ALL"
    for number, (x, y, z) in enumerate((1e3 * positions).tolist(), start=1):
        yield f"{number},{x:.11e},{y:.11e},{z:.11e}"
    yield "*ELEMENT, TYPE=C3D8I, ELSET=SOLID"
    bricks = [_elements(roller, 0), _elements(race, first)]
    for number, nodes in enumerate((np.concatenate([part.reshape(-1, 8) for part in bricks]) + 1).tolist(), start=1):
        yield ",".join(map(str, [number, *nodes]))
    held = np.concatenate([roller.held.reshape(-1, 3), race.held.reshape(-1, 3)])
    stands = np.flatnonzero(held[:first, 2])
    yield from _node_set("STANDS", stands)
    yield from _node_set("GROUND", first + np.flatnonzero(held[first:, 2]))
    yield from _node_set("ACROSS", np.flatnonzero(held[:, 0]))
    yield from _node_set("ALONG", np.flatnonzero(held[:, 1]))
    numbers = [np.arange(1, len(part.reshape(-1, 8)) + 1).reshape(part.shape[:-1]) for part in bricks]
    numbers[1] += numbers[0].size
    columns = int(roller.touching[0].any(axis=1).sum()) - 1
    layers = roller.positions.shape[0]
    yield "*SURFACE, NAME=SLAVE"
    yield from (f"{number},S1" for number in numbers[0][:, :columns, 0].ravel())
    yield "*SURFACE, NAME=MASTER"
    yield from (f"{number},S2" for number in numbers[1][:layers, : columns + 1, -1].ravel())
    modulus = 1e-6 * material.youngs_modulus
    yield from ("*MATERIAL, NAME=MATERIAL", "*ELASTIC", f"{modulus:.12e},{material.poisson_ratio:.12e}")
    yield "*SOLID SECTION, ELSET=SOLID, MATERIAL=MATERIAL"
    yield "*SURFACE INTERACTION, NAME=CONTACT"
    yield from ("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{_PENALTY:.6e}")
    yield from ("*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE", "SLAVE,MASTER")
    yield from ("*BOUNDARY", "ACROSS,1,1", "ALONG,2,2", "GROUND,3,3")
    yield from ("*STEP, INC=50", "*STATIC", "1.,1.,1e-3", "*BOUNDARY", f"STANDS,3,3,{-1e3 * approach:.10e}")
    yield from ("*NODE PRINT, NSET=STANDS, TOTALS=ONLY", "RF", "*END STEP")


def _elements(block: Block, first: int) -> IntArray:
    """Nodes of all elements, (layers, columns, rows, 8), counted from `first`."""
    layers, nx, nz, _ = block.positions.shape
    steps = (first + nx * nz * np.arange(layers - 1))[:, None, None]
    return np.asarray((block.layer_elements()[None] + steps).reshape(layers - 1, nx - 1, nz - 1, 8))


def _node_set(name: str, nodes: IntArray) -> Iterator[str]:
    """A set of nodes."""
    yield f"*NSET, NSET={name}"
    numbers = (nodes + 1).tolist()
    for start in range(0, len(numbers), _PER_LINE):
        yield ",".join(map(str, numbers[start : start + _PER_LINE]))

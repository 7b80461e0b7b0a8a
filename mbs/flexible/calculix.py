"""Matrices that CalculiX writes for `*FREQUENCY, SOLVER=MATRIXSTORAGE`.

job.sti, job.mas    lines "row column value", counted from 1, of one half of K and M
job.dof             lines "node.direction", one for each row

Degrees of freedom that are fixed (*BOUNDARY), and those that follow others (*EQUATION, *TIE), are not in the matrices:
CalculiX has worked the others' share into the rows that are. So a node that is missing may be fixed or may follow, and
can be no interface. The rotations of a *RIGID BODY appear as displacements of an auxiliary node, and *TRANSFORM turns
the directions of a node: decks with these are refused.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ehdmaps.arrays import IntArray
from ehdmaps.errors import InputError
from mbs.flexible.finite_elements import FiniteElementModel
from mbs.flexible.matrix_files import NodePositions, assemble_model, checked_labels, read_triplets
from mbs.flexible.number_table import check_file, read_numbers

_REFUSED = ("RIGIDBODY", "TRANSFORM", "MPC", "DISTRIBUTINGCOUPLING", "KINEMATIC", "DISTRIBUTING", "COUPLING")
_ROW = re.compile(r"([0-9]{1,20})\.([0-9]{1,20})")


def read_calculix(
    stiffness: Path, mass: Path, dofs: Path, nodes: NodePositions, units: str = "SI"
) -> FiniteElementModel:
    """Read the matrices of a CalculiX run.

    Parameters
    ----------
    stiffness, mass, dofs : Path
        Files job.sti, job.mas and job.dof of one run.
    nodes : NodePositions
        Nodes of its mesh; see `mbs.flexible.mesh`.
    units : {"SI", "mm-t-s"}
        Units of deck and matrices.

    Raises
    ------
    InputError
        With file and line.
    """
    labels = read_dofs(dofs)
    return assemble_model(read_triplets(stiffness, *labels), read_triplets(mass, *labels), nodes, units)


def read_dofs(path: Path) -> tuple[IntArray, IntArray]:
    """Read a .dof file.

    Returns
    -------
    nodes, directions : array of int, shape (N,)
        Directions counted from 0.

    Raises
    ------
    InputError
        With file and line.
    """
    # As numbers first, for length, line and finiteness; "12.10" would be direction 1 as a number, so as text then.
    table = read_numbers(path, 1, "#")
    with path.open(encoding="utf-8", errors="replace") as file:
        found = [_ROW.fullmatch(text) for line in file if (text := line.partition("#")[0].strip())]
    if None in found:
        raise table.problem(found.index(None), 'allowed: "node.direction", such as 12.1')
    whole = np.array([[int(part) for part in match.groups()] for match in found if match], dtype=object)
    huge = np.flatnonzero((whole > 10**12).any(axis=1))
    if huge.size:
        raise table.problem(int(huge[0]), "allowed: a node from 1 and a direction from 1 to 6")
    return checked_labels(table, whole.astype(np.int64))


def check_deck(path: Path) -> None:
    """Raise InputError if a deck has constraints that make its matrices unreadable: see the head of this module."""
    check_file(path)
    wrong = []
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, start=1):
            if line.startswith("*") and not line.startswith("**"):
                keyword = line[1:].partition(",")[0].strip().upper()
                if keyword.replace(" ", "") in _REFUSED:
                    wrong.append(
                        f"{path}, line {number}: got *{keyword}; allowed: solid elements, fixed nodes, ties; "
                        "interfaces follow by a spider of this program instead"
                    )
    if wrong:
        raise InputError(wrong)

"""Springs and bearings of a scene that are given by matrices of stiffness and damping, constant or over speed."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.jobs.table import Table
from ehdmaps.units import RPM, short
from mbs.model.elements import GROUND, Spring
from mbs.model.matrices import MOST_SPEEDS, MatrixElement
from mbs.scene import fields
from mbs.scene.shafts.standing import read_rings

if TYPE_CHECKING:
    from mbs.scene.surroundings import Built, Surroundings


ASSUMED = 3e8
"""Stiffness along each axis of a seat or foot of which nobody knows it [N/m]; see `mbs.unknowns.held_open`."""

_PARTS = 32
"""Lines in place of a cubic between two speeds: they leave a thousandth of its bulge."""


@dataclass(frozen=True, eq=False)
class MatrixSpec:
    """A spring or bearing by matrices.

    Attributes
    ----------
    name : str
        Name for messages and results.
    on, against : str
        Places at the same point; of a bearing those of its inner and of its outer ring.
    stiffness, damping : array, shape (speeds, 6, 6)
        Matrices of the displacements of `on` against `against` [N/m, N/rad, N m/rad; with s].
    speeds : array, shape (speeds,)
        Speeds of the system, rising [rad/s].
    """

    name: str
    on: str
    stiffness: FloatArray
    damping: FloatArray
    against: str = GROUND
    speeds: FloatArray = field(default_factory=lambda: np.zeros(1))


def read_spring(section: Table, name: str) -> Spring | MatrixSpec | None:
    """Read a spring; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    name : str
        Name of the spring.

    Returns
    -------
    Spring, MatrixSpec or None
        A spring where both matrices are symmetric and hold at any speed.
    """
    on, against = fields.places(section)
    assumed = section.get("stiffness") == "assumed" and "speeds" not in section
    found = _read(section, assumed)
    if on is None or found is None:
        return None
    speeds, stiffness, damping = found
    if speeds.size == 1 and all(np.array_equal(table[0], table[0].T) for table in (stiffness, damping)):
        return Spring(name, on, against, stiffness[0], damping[0], assumed)
    return MatrixSpec(name, on, stiffness, damping, against, speeds)


def read_table_bearing(section: Table, name: str) -> MatrixSpec | None:
    """Read a bearing by matrices, with kind = "table"; None where a problem was noted.

    Parameters
    ----------
    section : Table
        The table; the caller closes it.
    name : str
        Name of the bearing.
    """
    inner, outer = read_rings(section, name)
    found = _read(section)
    if inner is None or outer is None or found is None:
        return None
    speeds, stiffness, damping = found
    return MatrixSpec(name, inner, stiffness, damping, outer, speeds)


def matrix_problems(spec: MatrixSpec, surroundings: Surroundings) -> list[str]:
    """Problems with matrices besides places that do not exist: nothing may move between them.

    Parameters
    ----------
    spec : MatrixSpec
        The spring or bearing.
    surroundings : Surroundings
        What it is built into.
    """
    if spec.on.partition(":")[0] == spec.against.partition(":")[0]:
        return [f"{spec.name!r}: got {spec.on} and {spec.against}; allowed: places on two bodies, or one on the ground"]
    return []


def build_matrices(spec: MatrixSpec, surroundings: Surroundings) -> Built:
    """The element of a spring or bearing by matrices.

    Parameters
    ----------
    spec : MatrixSpec
        The spring or bearing; its places exist.
    surroundings : Surroundings
        What it is built into.

    Raises
    ------
    InputError
        For matrices that do not belong to the speeds.
    """
    from mbs.scene.surroundings import Built

    element = MatrixElement(spec.name, spec.on, spec.stiffness, spec.damping, spec.against, spec.speeds)
    return Built(element, element)


def _read(section: Table, assumed: bool = False) -> tuple[FloatArray, FloatArray, FloatArray] | None:
    """Read speeds and both matrices, or take an assumed stiffness."""
    speeds = _speeds(section)
    count = 1 if speeds is None else speeds.size
    section.get("stiffness", '{ y = "1e7 N/m", y_z = "2e6 N/m", z = ... }')
    if assumed:
        stiffness: FloatArray | None = np.diag([ASSUMED] * 3 + [0.0] * 3)[None]
    else:
        stiffness = fields.matrices(section, "stiffness", "N/m", "N m/rad", count)
    damping = fields.matrices(section, "damping", "N s/m", "N m s/rad", count, least=0.0)
    between = section.choice("between", ("line", "cubic"))
    if between is not None and "speeds" not in section:
        section.note("between", "stands without speeds; allowed: with a table over speed; delete it")
    if speeds is None or stiffness is None or damping is None:
        return None
    return _on_cubics(speeds, stiffness, damping) if between == "cubic" and count > 1 else (speeds, stiffness, damping)


def _on_cubics(
    speeds: FloatArray, stiffness: FloatArray, damping: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Speeds and tables on cubics through the values, so close that straight lines between them show nothing."""
    from scipy.interpolate import make_interp_spline

    parts = max(min(_PARTS, (MOST_SPEEDS - 1) // (speeds.size - 1)), 1)
    fine = np.interp(np.arange(parts * (speeds.size - 1) + 1) / parts, np.arange(speeds.size), speeds)
    # A table of three speeds lies on a parabola, one of two on a line.
    curves = [make_interp_spline(speeds, table, k=min(3, speeds.size - 1)) for table in (stiffness, damping)]
    return fine, curves[0](fine), curves[1](fine)


def _speeds(section: Table) -> FloatArray | None:
    """Read the speeds of the tables; one speed without any, None where a problem was noted."""
    given = section.get("speeds")
    if "speeds" not in section:
        return np.zeros(1)
    if not isinstance(given, list) or not 2 <= len(given) <= MOST_SPEEDS:
        section.note(
            "speeds", f'got {short(given)}; allowed: a list of 2 to {MOST_SPEEDS}, such as ["0 rpm", "1e3 rpm"]'
        )
        return None
    read = [section.quantity_of(part, f"speeds[{k}]", "rad/s", -1e5, 1e5, RPM) for k, part in enumerate(given)]
    speeds = np.array([part for part in read if part is not None])
    if speeds.size < len(given):
        return None
    if np.any(np.diff(speeds) <= 0.0):
        section.note("speeds", f"got {short(given)}; allowed: each above the last")
        return None
    return speeds

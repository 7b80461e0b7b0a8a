"""The story of a housing: mesh, matrices, reduction, and what a reader of the file should know about its making."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.linalg import eigh

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.solids import calculix
from ehdmaps.solids.mesh_plane import load_gmsh
from ehdmaps.units import LENGTH
from ehdmaps.version import version
from examples.housings import solve
from examples.housings.designs import Housing, Seat
from examples.housings.geometry import PURPOSE, mesh_housing
from examples.housings.mesh import Mesh
from mbs.flexible.finite_elements import FiniteElementModel
from mbs.flexible.reduced_body import ReducedBody
from mbs.flexible.reduction import Interface, nodes_on_cylinder, reduce

FREEDOMS = ("y", "z", "theta_y", "theta_z")
"""Of a seat: all that a cylindrical roller bearing passes on."""

SHOWN = 10
"""Frequencies of the clamped housing that are found by CalculiX itself."""

COMMAND = "python -m examples.housings"
"""Makes a housing, from the root of a clone."""

LOWEST_CUTOFF, HIGHEST_CUTOFF = 100.0, 30e3
"""Allowed cutoff [Hz]; above, the elements of the shipped sizes are longer than the waves."""

MOST_COORDINATES = 120_000
"""Of the mesh; more take gigabytes and an hour, and move the frequencies by less than the assumed dimensions do."""

_ON_SEAT = 1e-6
"""How far off its cylinder a node of a seat may lie [m]."""


@dataclass(frozen=True, eq=False)
class Made:
    """A housing that was made.

    Attributes
    ----------
    mesh : Mesh
        Mesh of its solid.
    reduced : ReducedBody
        The reduced body, with its provenance.
    coordinates : int
        Number of coordinates of the finite-element model, feet held.
    frequencies : array, shape (k,)
        Lowest of the housing with its feet held and its seats free, by CalculiX [Hz].
    reduced_frequencies : array, shape (k,)
        The same of the reduced body [Hz].
    seat_stiffness : mapping of str to float
        Force for a displacement of a seat along z, the others free [N/m].
    """

    mesh: Mesh
    reduced: ReducedBody
    coordinates: int
    frequencies: FloatArray
    reduced_frequencies: FloatArray
    seat_stiffness: dict[str, float]

    @property
    def modes(self) -> int:
        """Number of modes kept."""
        return sum(unit == "1" for unit in self.reduced.units)


def make(housing: Housing, size: float, cutoff: float, keep: Path | None = None) -> Made:
    """Mesh, solve and reduce a housing.

    Parameters
    ----------
    housing : Housing
        What is made.
    size : float
        Size of the elements [m].
    cutoff : float
        Modes with the seats held are kept up to here [Hz].
    keep : Path, optional
        Folder in which the files of CalculiX stay; they are deleted if left out.

    Raises
    ------
    InputError
        For values that are not allowed, or where gmsh or CalculiX is missing.
    AnalysisError
        If meshing or solving fails.
    """
    check_cutoff(cutoff)
    calculix.program(solve.PURPOSE)
    mesh = mesh_housing(housing, size)
    if mesh.positions.size > MOST_COORDINATES:
        raise InputError(
            f"size of the elements: got {LENGTH.text(size)}, which makes {mesh.positions.size} coordinates; allowed: "
            f"up to {MOST_COORDINATES}; take larger elements"
        )
    clamped = mesh.near_height(housing.ground)
    with _folder(keep) as folder:
        for name in ("matrices", "frequencies"):
            (folder / name).mkdir()
        model = solve.matrices(mesh, housing.material, clamped, folder / "matrices")
        frequencies = solve.own_frequencies(mesh, housing.material, clamped, SHOWN, folder / "frequencies")
    interfaces = {name: _interface(model, mesh, name, seat) for name, seat in housing.seats.items()}
    attributes = _attributes(housing, mesh, model, size, cutoff, frequencies)
    reduced = reduce(model, interfaces, housing.sensors, cutoff, attributes, mesh.surface[:, :3] + 1)
    return Made(
        mesh,
        reduced,
        model.size,
        frequencies,
        own_frequencies(reduced)[:SHOWN],
        seat_stiffness(reduced, tuple(housing.seats)),
    )


def own_frequencies(reduced: ReducedBody) -> FloatArray:
    """Frequencies of a reduced body with its interfaces free [Hz], rising."""
    values = eigh(reduced.stiffness, reduced.mass, eigvals_only=True)
    return np.asarray(np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi))


def seat_stiffness(reduced: ReducedBody, names: tuple[str, ...]) -> dict[str, float]:
    """Force for a displacement of each of some interfaces along z, the others free [N/m]."""
    stiffness = {}
    for name in names:
        along_z = reduced.frames[name].transform[2]
        stiffness[name] = float(1.0 / (along_z @ np.linalg.solve(reduced.stiffness, along_z)))
    return stiffness


def check_cutoff(cutoff: float) -> None:
    """Refuse a cutoff that is not allowed."""
    if not LOWEST_CUTOFF <= cutoff <= HIGHEST_CUTOFF:
        raise InputError(
            f"cutoff: got {cutoff:.4g} Hz; allowed: {LOWEST_CUTOFF:.0f} Hz to {HIGHEST_CUTOFF / 1e3:.0f} kHz"
        )


def _interface(model: FiniteElementModel, mesh: Mesh, name: str, seat: Seat) -> Interface:
    """Mean of a seat's surface."""
    half = 0.5 * seat.width
    nodes = nodes_on_cylinder(model, seat.centre, (1.0, 0.0, 0.0), 0.5 * seat.diameter, -half, half, _ON_SEAT)
    areas = mesh.areas(nodes - 1)
    if not nodes.size or not np.all(areas > 0.0):
        raise AnalysisError(f"seat {name!r}: the mesh does not follow its surface; try another size of the elements")
    return Interface(np.array(seat.centre), nodes, "averaging", FREEDOMS, areas)


def _attributes(
    housing: Housing, mesh: Mesh, model: FiniteElementModel, size: float, cutoff: float, frequencies: FloatArray
) -> dict[str, str]:
    """Facts that a reader of the file should know."""
    material = housing.material
    return {
        "title": housing.title,
        "command": f'{COMMAND} {housing.name} --size "{LENGTH.text(size)}" --cutoff "{cutoff:.6g} Hz"',
        "versions": f"ehdmaps {version()}, gmsh {load_gmsh(PURPOSE).__version__}, "
        f"CalculiX {calculix.version(solve.PURPOSE)}",
        "dimensions": f"assumed; m: {housing.shape}",
        "material": f"E {material.youngs_modulus / 1e9:.6g} GPa, nu {material.poisson_ratio:.6g}, density "
        f"{material.density:.6g} kg/m3",
        "mesh": f"{len(mesh.elements)} second-order tetrahedra (C3D10) of {LENGTH.text(size)}, {len(mesh.positions)} "
        f"nodes, {model.size} coordinates",
        "clamped": f"undersides of the feet, z = {LENGTH.text(housing.ground)}: all displacements held",
        "total_mass": f"{mesh.volume * material.density:.6g} kg, with the clamped nodes",
        "clamped_frequencies": ", ".join(f"{value:.6g}" for value in frequencies) + " Hz, by CalculiX, seats free",
    }


@contextmanager
def _folder(keep: Path | None) -> Iterator[Path]:
    """A new folder for files: deleted after, unless it is to be kept."""
    if keep is None:
        with tempfile.TemporaryDirectory(prefix="ehdmaps-housing-") as name:
            yield Path(name)
        return
    try:
        keep.mkdir(parents=True, exist_ok=True)
        full = any(keep.iterdir())
    except OSError as error:
        raise InputError(f"--keep: {keep} cannot be made ({error.strerror}); allowed: a new or empty folder") from error
    if full:
        raise InputError(f"--keep: {keep} is not empty; allowed: a new or empty folder")
    yield keep

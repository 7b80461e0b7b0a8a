"""Meshes of roller and rings across the bearing's axis by gmsh: second-order triangles, graded to the contact.

The contact is at (0, `surface`), its load acts along y, and the line x = 0 is a line of symmetry: half of a ring is
meshed, and a quarter of a roller. The size of the elements grows in proportion to their distance from the contact, so
that one mesh serves contacts of any width: `grading` is the size over the distance.
"""

from __future__ import annotations

import importlib
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from types import ModuleType

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray, IntArray
from ehdmaps.errors import AnalysisError, DependencyError, InputError
from ehdmaps.extras import needs

DEBIAN_PACKAGES = ("libgl1", "libglu1-mesa", "libgomp1", "libxcursor1", "libxft2", "libxinerama1")
"""What the gmsh of PyPI needs of Debian 12 besides what every machine has."""


def load_gmsh(purpose: str) -> ModuleType:
    """Return gmsh.

    Parameters
    ----------
    purpose : str
        What needs it, for the message.

    Raises
    ------
    DependencyError
        If it is not installed, or a library of the system that it needs is not.
    """
    try:
        with needs("solids", "gmsh", purpose):
            return importlib.import_module("gmsh")
    except DependencyError as error:
        raise DependencyError(f"{error}; on Debian also apt-get install {' '.join(DEBIAN_PACKAGES)}") from error


@contextmanager
def gmsh_session(purpose: str) -> Iterator[ModuleType]:
    """Gmsh with an empty model, quiet, one thread; all is gone after.

    Parameters
    ----------
    purpose : str
        What needs it, for messages.

    Raises
    ------
    DependencyError
        If gmsh is missing.
    InputError
        If it is in use already.
    """
    gmsh = load_gmsh(purpose)
    if gmsh.isInitialized():
        raise InputError(f"gmsh is already in use in this process; allowed: gmsh.finalize() before {purpose}")
    # No configuration files of the user, and Ctrl-C stays Python's.
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    _keep_broken_pipes_errors()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        gmsh.model.add("solid")
        yield gmsh
    finally:
        gmsh.finalize()


def _keep_broken_pipes_errors() -> None:
    """Take SIGPIPE back from gmsh, with which a worker that dies would take its parent along."""
    # Only the main thread may; Python itself sets the signal there.
    if hasattr(signal, "SIGPIPE") and threading.current_thread() is threading.main_thread():
        before = signal.getsignal(signal.SIGPIPE)
        if before is not None:
            signal.signal(signal.SIGPIPE, before)


PURPOSE = "meshing roller and rings"

_MM = 1e3
_TRIANGLES = 9
"""gmsh's number of second-order triangles."""

_LARGEST_SHARE = 0.25
"""Largest elements over the thickness of the body."""


@dataclass(frozen=True, eq=False)
class PlaneMesh:
    """Second-order triangles.

    Attributes
    ----------
    positions : array, shape (nodes, 2)
        x and y [m].
    elements : array of int, shape (elements, 6)
        Three corners, anticlockwise, then the nodes on the edges 1-2, 2-3, 3-1.
    surface : float
        Radius of the raceway or of the roller [m]; the contact is at (0, surface).
    far : float
        Radius where the body ends [m]: seat of a ring, bore of a roller or 0.
    """

    positions: FloatArray
    elements: IntArray
    surface: float
    far: float

    @cached_property
    def radii(self) -> FloatArray:
        """Distance of the nodes from the axis [m], shape (nodes,)."""
        return np.asarray(np.hypot(*self.positions.T))

    def on_circle(self, radius: float) -> BoolArray:
        """True for nodes that lie on a circle about the axis [m]."""
        return np.asarray(np.abs(self.radii - radius) < 1e-7 * self.surface)

    def on_axis(self, direction: int) -> BoolArray:
        """True for nodes that lie where x (direction 0) or y (direction 1) is zero."""
        return np.asarray(np.abs(self.positions[:, direction]) < 1e-9 * self.surface)


def roller_mesh(radius: float, bore_radius: float, smallest: float, grading: float) -> PlaneMesh:
    """Quarter of a roller.

    Parameters
    ----------
    radius, bore_radius : float
        Radii of the roller and of its bore [m]; 0 for a solid roller.
    smallest : float
        Size of the elements at the contact [m].
    grading : float
        Size of an element over its distance from the contact.

    Raises
    ------
    InputError
        If gmsh is missing or in use.
    AnalysisError
        If it finds no mesh.
    """

    def draw(gmsh: ModuleType) -> None:
        _annulus(gmsh, bore_radius, radius, (0.0, 0.0))

    return _meshed(draw, radius, bore_radius, radius - bore_radius, smallest, grading)


def ring_mesh(surface: float, far: float, smallest: float, grading: float, interface: float | None = None) -> PlaneMesh:
    """Half of a ring, with shaft or housing.

    Parameters
    ----------
    surface : float
        Radius of the raceway [m].
    far : float
        Radius where ring, or shaft or housing, end [m]: smaller than the raceway inside, larger outside; 0 for a solid
        shaft.
    smallest, grading
        The same as for `roller_mesh`.
    interface : float, optional
        Radius of the seat between ring and shaft [m]: edges of elements lie on it.

    Raises
    ------
    InputError
        If gmsh is missing or in use.
    AnalysisError
        If it finds no mesh.
    """
    inside, outside = sorted((surface, far))

    def draw(gmsh: ModuleType) -> None:
        if interface is None:
            _annulus(gmsh, inside, outside, (0.0, -outside))
        else:
            parts = [_annulus(gmsh, a, b, (0.0, -outside)) for a, b in ((inside, interface), (interface, outside))]
            gmsh.model.occ.fragment([(2, parts[0])], [(2, parts[1])])

    return _meshed(draw, surface, far, outside - inside, smallest, grading)


def _annulus(gmsh: ModuleType, inside: float, outside: float, corner: tuple[float, float]) -> int:
    """Part of an annulus with x and y above a corner [m]."""
    occ = gmsh.model.occ
    body = occ.addDisk(0.0, 0.0, 0.0, outside * _MM, outside * _MM)
    if inside > 0.0:
        hole = occ.addDisk(0.0, 0.0, 0.0, inside * _MM, inside * _MM)
        body = occ.cut([(2, body)], [(2, hole)])[0][0][1]
    x, y = corner
    frame = occ.addRectangle(x * _MM, y * _MM, 0.0, (outside - x) * _MM, (outside - y) * _MM)
    part: int = occ.intersect([(2, body)], [(2, frame)])[0][0][1]
    return part


def _meshed(
    draw: Callable[[ModuleType], None], surface: float, far: float, thickness: float, smallest: float, grading: float
) -> PlaneMesh:
    """Mesh what is drawn."""
    with gmsh_session(PURPOSE) as gmsh:
        try:
            draw(gmsh)
            gmsh.model.occ.synchronize()
            largest = max(_LARGEST_SHARE * thickness, smallest) * _MM
            field = gmsh.model.mesh.field
            contact = gmsh.model.occ.addPoint(0.0, surface * _MM, 0.0)
            gmsh.model.occ.synchronize()
            field.add("Distance", 1)
            field.setNumbers(1, "PointsList", [contact])
            field.add("MathEval", 2)
            field.setString(2, "F", f"{smallest * _MM:.17g} + {grading:.17g} * F1")
            field.setAsBackgroundMesh(2)
            gmsh.option.setNumber("Mesh.MeshSizeMax", largest)
            for source in ("FromPoints", "FromCurvature", "ExtendFromBoundary"):
                gmsh.option.setNumber(f"Mesh.MeshSize{source}", 0)
            gmsh.option.setNumber("Mesh.Algorithm", 6)
            gmsh.option.setNumber("Mesh.ElementOrder", 2)
            gmsh.option.setNumber("Mesh.HighOrderOptimize", 0)
            gmsh.model.mesh.generate(2)
            return _arrays(gmsh, surface, far)
        # gmsh raises bare exceptions with its own message
        except Exception as error:
            if isinstance(error, (AnalysisError, InputError)):
                raise
            raise AnalysisError(f"gmsh: no mesh of a body of {thickness:.4g} m ({error}); try another size") from error


def _arrays(gmsh: ModuleType, surface: float, far: float) -> PlaneMesh:
    """The mesh of the model, with nodes renumbered from 0."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, connectivity = gmsh.model.mesh.getElementsByType(_TRIANGLES)
    if not len(connectivity):
        raise AnalysisError("gmsh: the mesh has no triangles; try another size")
    used, elements = np.unique(np.asarray(connectivity, dtype=np.int64), return_inverse=True)
    order = np.argsort(tags)
    rows = order[np.searchsorted(tags, used, sorter=order)]
    positions = np.asarray(coordinates, dtype=np.float64).reshape(-1, 3)[rows, :2] / _MM
    return PlaneMesh(positions, elements.reshape(-1, 6), surface, far)

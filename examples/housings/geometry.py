"""Solids of the housings and their meshes, by gmsh.

gmsh is a separate program library, loaded when a housing is drawn and not before. Its own lengths are millimetres
here: the tolerances of its geometry kernel are absolute and fit them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from types import ModuleType

import numpy as np

from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.solids.mesh_plane import gmsh_session
from ehdmaps.units import LENGTH
from examples.housings.designs import GearboxShape, Housing, PedestalShape, Place
from examples.housings.mesh import Mesh

SMALLEST, LARGEST = 5e-3, 40e-3
"""Sizes of elements [m]: below, there are far too many; above, they no longer know the walls."""

ELEMENTS_AROUND = 20
"""Least number of elements around a circle: fewer turn elements inside out where they curve."""

PURPOSE = "drawing a housing"
"""What needs gmsh, for messages."""

_MM = 1e3
_ON_FACE = 1e-4
_TETRAHEDRA = 11
"""gmsh's number of second-order tetrahedra."""

_ORDER = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]
"""gmsh's nodes of such an element in the order of CalculiX: the last two edges change places."""

Solid = tuple[int, int]
"""gmsh's name of a solid: (3, tag)."""


def mesh_housing(housing: Housing, size: float) -> Mesh:
    """Mesh a housing; a node lies at each of its sensors.

    Parameters
    ----------
    housing : Housing
        What is meshed.
    size : float
        Size of the elements [m].

    Raises
    ------
    InputError
        For a size that is not allowed, or where gmsh is missing.
    AnalysisError
        If gmsh finds no mesh.
    """
    shape = housing.shape
    draw = _gearbox if isinstance(shape, GearboxShape) else _pedestals
    return tetrahedra(lambda gmsh: draw(gmsh, shape), size, tuple(housing.sensors.values()))  # type: ignore[arg-type]


def tetrahedra(
    draw: Callable[[ModuleType], Solid], size: float, points: Sequence[Place] = (), around: int = ELEMENTS_AROUND
) -> Mesh:
    """Mesh a solid by second-order tetrahedra.

    Parameters
    ----------
    draw : callable
        Draws one solid in gmsh's geometry kernel, in mm, and returns it.
    size : float
        Size of the elements [m], from `SMALLEST` to `LARGEST`.
    points : sequence of tuple of float
        Places on the surface where a node must lie [m].
    around : int
        Least number of elements around a circle.

    Returns
    -------
    Mesh
        The mesh, with curved edges at curved surfaces. It is the same for the same input and version of gmsh.

    Raises
    ------
    InputError
        For a size that is not allowed, or where gmsh is missing.
    AnalysisError
        If gmsh finds no mesh.
    """
    check_size(size)
    with gmsh_session(PURPOSE) as gmsh:
        try:
            solid = draw(gmsh)
            gmsh.model.occ.synchronize()
            if gmsh.model.getEntities(3) != [solid]:
                raise AnalysisError(f"gmsh: the drawing has {len(gmsh.model.getEntities(3))} solids; allowed: one")
            for point in points:
                _embed(gmsh, solid, point)
            gmsh.option.setNumber("Mesh.MeshSizeMax", size * _MM)
            gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", around)
            gmsh.option.setNumber("Mesh.ElementOrder", 2)
            # Its optimisation of curved elements gives other digits each time, and may abort the process.
            gmsh.option.setNumber("Mesh.HighOrderOptimize", 0)
            gmsh.model.mesh.generate(3)
            mesh = _arrays(gmsh)
        # gmsh raises bare exceptions with its own message
        except Exception as error:
            if isinstance(error, (AnalysisError, InputError)):
                raise
            raise AnalysisError(
                f"gmsh: no mesh with elements of {LENGTH.text(size)} ({error}); try another size"
            ) from error
    if mesh.least_quality() <= 0.0:
        raise AnalysisError(f"gmsh: an element of {LENGTH.text(size)} is turned inside out; try another size")
    return mesh


def check_size(size: float) -> None:
    """Refuse a size of elements [m] that is not allowed."""
    if not SMALLEST <= size <= LARGEST:
        raise InputError(
            f"size of the elements: got {LENGTH.text(size)}; allowed: {LENGTH.text(SMALLEST)} to {LENGTH.text(LARGEST)}"
        )


def _arrays(gmsh: ModuleType) -> Mesh:
    """The mesh of the model, with nodes renumbered from 0."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, connectivity = gmsh.model.mesh.getElementsByType(_TETRAHEDRA)
    if not len(connectivity):
        raise AnalysisError("gmsh: the mesh has no tetrahedra; try another size")
    used, elements = np.unique(np.asarray(connectivity, dtype=np.int64), return_inverse=True)
    order = np.argsort(tags)
    rows = order[np.searchsorted(tags, used, sorter=order)]
    positions = np.asarray(coordinates, dtype=np.float64).reshape(-1, 3)[rows] / _MM
    return Mesh(positions, elements.reshape(-1, len(_ORDER))[:, _ORDER])


def _embed(gmsh: ModuleType, solid: Solid, place: Place) -> None:
    """Make a node lie at a place on a face of the solid."""
    at = [value * _MM for value in place]
    for _, face in gmsh.model.getBoundary([solid], oriented=False):
        # isInside looks along the face only: whether the place lies on it, its closest point says.
        closest, _ = gmsh.model.getClosestPoint(2, face, at)
        if math.dist(closest, at) < _ON_FACE and gmsh.model.isInside(2, face, at):
            point = gmsh.model.occ.addPoint(*at)
            gmsh.model.occ.synchronize()
            gmsh.model.mesh.embed(0, [point], 2, face)
            return
    raise InputError(f"point at {place!r} m: is on no face of the solid; allowed: inside a face")


def _box(gmsh: ModuleType, x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Solid:
    """Box from and to along each axis [m]."""
    begin = [part[0] * _MM for part in (x, y, z)]
    length = [(part[1] - part[0]) * _MM for part in (x, y, z)]
    return 3, gmsh.model.occ.addBox(*begin, *length)


def _cylinder(gmsh: ModuleType, x: tuple[float, float], y: float, z: float, diameter: float) -> Solid:
    """Cylinder along x [m]."""
    tag = gmsh.model.occ.addCylinder(x[0] * _MM, y * _MM, z * _MM, (x[1] - x[0]) * _MM, 0.0, 0.0, 0.5 * diameter * _MM)
    return 3, tag


def _prism(gmsh: ModuleType, corners: Sequence[Place], along: Place) -> Solid:
    """A plane polygon drawn out along a vector [m]."""
    occ = gmsh.model.occ
    points = [occ.addPoint(*(value * _MM for value in corner)) for corner in corners]
    lines = [occ.addLine(a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True)]
    face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    return _drawn_out(gmsh, face, along)


def _drawn_out(gmsh: ModuleType, face: int, along: Place) -> Solid:
    """A face drawn out along a vector [m]."""
    swept = gmsh.model.occ.extrude([(2, face)], *(value * _MM for value in along))
    solid: Solid = next(entry for entry in swept if entry[0] == 3)
    return solid


def _one(solids: Sequence[Solid]) -> Solid:
    """The only solid that is left after one was joined to, or cut from, another."""
    if len(solids) != 1:
        raise AnalysisError(f"gmsh: {len(solids)} solids are left of the drawing; allowed: one")
    return solids[0]


def _gearbox(gmsh: ModuleType, shape: GearboxShape) -> Solid:
    """Box with bosses, bores, feet and ribs between feet and side walls."""
    occ = gmsh.model.occ
    half = shape.half_length
    outer_y, outer_z = shape.outer_y, shape.outer_z
    inside = half - shape.end_wall
    box = _box(gmsh, (-half, half), outer_y, outer_z)
    hollow, _ = occ.cut([box], [_box(gmsh, (-inside, inside), shape.inner_y, shape.inner_z)])
    added: list[Solid] = []
    bores: list[Solid] = []
    for middle in (-0.5 * shape.span, 0.5 * shape.span):
        for y in (0.0, shape.centre_distance):
            ends = (middle - 0.5 * shape.seat_width, middle + 0.5 * shape.seat_width)
            added.append(_cylinder(gmsh, ends, y, 0.0, shape.boss_diameter))
            bores.append(_cylinder(gmsh, ends, y, 0.0, shape.seat_diameter))
    top_of_foot = shape.ground + shape.foot_height
    for begin in (-half, half - shape.foot_length):
        for wall, outwards in ((outer_y[0], -1.0), (outer_y[1], 1.0)):
            inner = wall - outwards * shape.side_wall
            outer = wall + outwards * shape.foot_reach
            ends = (begin, begin + shape.foot_length)
            added.append(_box(gmsh, ends, (min(inner, outer), max(inner, outer)), (shape.ground, top_of_foot)))
            rib = begin + 0.5 * (shape.foot_length - shape.gusset)
            added.append(
                _prism(
                    gmsh,
                    [
                        (rib, wall, top_of_foot),
                        (rib, outer, top_of_foot),
                        (rib, wall, top_of_foot + shape.foot_reach),
                    ],
                    (shape.gusset, 0.0, 0.0),
                )
            )
    joined, _ = occ.fuse(hollow, added)
    bored, _ = occ.cut(joined, bores)
    return _one(bored)


def _pedestals(gmsh: ModuleType, shape: PedestalShape) -> Solid:
    """Plate with pads, two pedestals with flanks tangent to their heads, a rib at the inner side of each."""
    occ = gmsh.model.occ
    top = -shape.axis_height
    under = top - shape.plate_thickness
    half_x, half_y = 0.5 * shape.plate_length, 0.5 * shape.plate_width
    plate = _box(gmsh, (-half_x, half_x), (-half_y, half_y), (under, top))
    pads = [
        _box(gmsh, (x, x + shape.foot_size), (y, y + shape.foot_size), (shape.ground, under))
        for x in (-half_x, half_x - shape.foot_size)
        for y in (-half_y, half_y - shape.foot_size)
    ]
    added = list(pads)
    for side in (-1.0, 1.0):
        added.append(_pedestal(gmsh, shape, side * 0.5 * shape.span - 0.5 * shape.seat_width))
        face = side * 0.5 * (shape.span - shape.seat_width)
        corners = [
            (face, -0.5 * shape.gusset_thickness, top),
            (face - side * shape.gusset_length, -0.5 * shape.gusset_thickness, top),
            (face, -0.5 * shape.gusset_thickness, top + shape.gusset_height),
        ]
        added.append(_prism(gmsh, corners, (0.0, shape.gusset_thickness, 0.0)))
    joined, _ = occ.fuse([plate], added)
    return _one(joined)


def _pedestal(gmsh: ModuleType, shape: PedestalShape, begin: float) -> Solid:
    """One pedestal from x = `begin` on, with its bore."""
    occ = gmsh.model.occ
    radius, half = 0.5 * shape.head_diameter, 0.5 * shape.base_width
    # The flank from the corner (half, -axis_height) touches the head where the radius is at a right angle to it.
    distance = math.hypot(half, shape.axis_height)
    angle = math.acos(radius / distance) - math.atan2(shape.axis_height, half)
    touch_y, touch_z = radius * math.cos(angle), radius * math.sin(angle)
    x = begin * _MM

    def point(y: float, z: float) -> int:
        tag: int = occ.addPoint(x, y * _MM, z * _MM)
        return tag

    left, right = point(-half, -shape.axis_height), point(half, -shape.axis_height)
    left_touch, right_touch = point(-touch_y, touch_z), point(touch_y, touch_z)
    centre, crown = point(0.0, 0.0), point(0.0, radius)
    loop = occ.addCurveLoop(
        [
            occ.addLine(left, right),
            occ.addLine(right, right_touch),
            occ.addCircleArc(right_touch, centre, crown),
            occ.addCircleArc(crown, centre, left_touch),
            occ.addLine(left_touch, left),
        ]
    )
    face = occ.addPlaneSurface([loop])
    body = _drawn_out(gmsh, face, (shape.seat_width, 0.0, 0.0))
    ends = (begin, begin + shape.seat_width)
    bored, _ = occ.cut([body], [_cylinder(gmsh, ends, 0.0, 0.0, shape.seat_diameter)])
    return _one(bored)

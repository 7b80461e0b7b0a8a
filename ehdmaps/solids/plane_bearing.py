"""The plane model of a bearing: both contacts of a roller, and how far its numbers can be trusted.

The contact of a roller and a ring solved by CalculiX: no pressure is assumed, unlike in `ehdmaps.solids.plane`.

It is the second method by which the law of the approach is checked: a quarter of the roller stands on half of the ring,
the plane through the roller's axis is pressed down, and CalculiX finds the pressure and the width of the contact.
"""

from __future__ import annotations

import math
import re
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import AnalysisError
from ehdmaps.physics.approach import FE_LOAD
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solids import Material, reduced_modulus
from ehdmaps.solids import calculix
from ehdmaps.solids.calculix import run_deck
from ehdmaps.solids.law import LawFit, PlaneSeries, fitted, series_of
from ehdmaps.solids.mesh_plane import PlaneMesh, ring_mesh, roller_mesh
from ehdmaps.solids.plane import Plane, PlaneYield, body_yield
from ehdmaps.solids.sections import HOUSING_RATIO, Sections

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


GRADING = 0.1
"""Size of an element over its distance from the contact, by default."""

GRADINGS = (0.2, 0.1, 0.05)
"""The three meshes of a study of convergence."""

_WIDTHS = np.geomspace(0.2, 5.0, 9)
"""Half-widths of a series over the one of Hertz at `FE_LOAD`."""

_CHECKED = [2, 4, 6]
"""Places in the series at which CalculiX solves the contact."""

_WIDEST = 0.2
_CHECK_GRADING = 0.2
_REACH = 8.0


@dataclass(frozen=True, eq=False)
class PlaneContact:
    """One contact of a roller in the plane model.

    Attributes
    ----------
    name : {"inner", "outer"}
        Which of both.
    radius : float
        Reduced radius R [m].
    fit : LawFit
        The law.
    series : PlaneSeries
        Loads from which it was made.
    roller_share : float
        What the roller adds to the compliance of roller and ring, at the width of `FE_LOAD`.
    neighbour_share : float
        How far the raceway yields, under the load of this roller, where the next roller stands; over the compliance of
        roller and ring. The law leaves it out: it belongs to the ring as a whole.
    nodes : int
        Nodes of both meshes.
    """

    name: str
    radius: float
    fit: LawFit
    series: PlaneSeries
    roller_share: float
    neighbour_share: float
    nodes: int


@dataclass(frozen=True)
class Convergence:
    """Approach at `FE_LOAD` by finer and finer meshes.

    Attributes
    ----------
    gradings : tuple of float
        Sizes of elements over their distance from the contact, each half of the one before.
    approaches : tuple of float
        delta_0 [m].
    order : float
        Order of convergence that the last three show.
    limit : float
        Richardson's extrapolation [m].
    """

    gradings: tuple[float, ...]
    approaches: tuple[float, ...]
    order: float
    limit: float


@dataclass(frozen=True)
class ContactCheck:
    """Loads of the same approaches by the law's series and by CalculiX' contact.

    Attributes
    ----------
    approaches : tuple of float
        delta [m].
    loads, contact_loads : tuple of float
        w by the energy of Hertz' pressure and by CalculiX [N/m].
    """

    approaches: tuple[float, ...]
    loads: tuple[float, ...]
    contact_loads: tuple[float, ...]

    @property
    def difference(self) -> float:
        """Largest relative difference of the loads."""
        return max(abs(b / a - 1.0) for a, b in zip(self.loads, self.contact_loads, strict=True))


def solve_contact(
    bearing: BearingGeometry, sections: Sections, name: str, grading: float = GRADING, plane: Plane = "strain"
) -> PlaneContact:
    """Solve one contact of a bearing in the plane.

    Parameters
    ----------
    bearing : BearingGeometry
        The bearing, for the reduced radii and the pitch of the rollers.
    sections : Sections
        Bodies of the bearing.
    name : {"inner", "outer"}
        Which contact.
    grading : float
        Size of an element over its distance from the contact.
    plane : {"strain", "stress"}
        Plane strain; or plane stress, which is a bound.

    Raises
    ------
    DependencyError
        If gmsh or scikit-fem is missing.
    AnalysisError
        If there is no mesh.
    """
    radius = bearing.inner_radius if name == "inner" else bearing.outer_radius
    modulus = reduced_modulus(sections.material, sections.material)
    if plane == "stress":
        modulus *= 1.0 - sections.material.poisson_ratio**2
    widths = _half_widths(radius, modulus)
    smallest = 0.5 * grading * float(widths[0])
    roller = roller_mesh(0.5 * sections.roller_diameter, 0.5 * sections.roller_bore, smallest, grading)
    of_roller = body_yield(roller, sections.material, widths, plane, roller=True)
    ring, shaft_radius = _ring(sections, name, smallest, grading)
    of_ring = body_yield(ring, sections.material, widths, plane, shaft_radius)
    compliance = of_roller.compliance + of_ring.compliance
    series = series_of(widths, compliance, radius, modulus)
    middle = len(widths) // 2
    return PlaneContact(
        name=name,
        radius=radius,
        fit=fitted(series, compliance, radius, modulus),
        series=series,
        roller_share=float(of_roller.compliance[middle] / compliance[middle]),
        neighbour_share=_at_pitch(of_ring, middle, bearing.rollers) / float(compliance[middle]),
        nodes=len(roller.positions) + len(ring.positions),
    )


def converge(bearing: BearingGeometry, sections: Sections, name: str) -> Convergence:
    """Solve one contact by the three meshes of `GRADINGS`.

    Parameters
    ----------
    bearing, sections, name
        The same as for `solve_contact`.
    """
    values = [solve_contact(bearing, sections, name, grading).fit.fe_approach for grading in GRADINGS]
    coarse, fine = values[1] - values[0], values[2] - values[1]
    order = math.log2(coarse / fine) if coarse * fine > 0.0 else math.nan
    limit = values[2] + fine / (2.0**order - 1.0) if order > 0.0 else values[2]
    return Convergence(GRADINGS, tuple(values), order, limit)


def check_contact(bearing: BearingGeometry, sections: Sections, name: str) -> ContactCheck:
    """Solve one contact on a rigid seat both ways; takes a minute.

    Parameters
    ----------
    bearing, sections, name
        The same as for `solve_contact`; the seat is rigid whatever that of the sections.

    Raises
    ------
    InputError
        If CalculiX is missing.
    AnalysisError
        If it finds no contact.
    """
    fixed = replace(sections, seat="rigid")
    series = solve_contact(bearing, fixed, name).series
    widths, approaches = series.half_width[_CHECKED], series.approach[_CHECKED]
    smallest = 0.1 * float(widths[0])
    roller = roller_mesh(0.5 * fixed.roller_diameter, 0.5 * fixed.roller_bore, smallest, _CHECK_GRADING)
    ring, _ = _ring(fixed, name, smallest, _CHECK_GRADING)
    loads = contact_loads(roller, ring, fixed.material, approaches.tolist(), _REACH * float(widths[-1]))
    return ContactCheck(tuple(approaches.tolist()), tuple(series.load[_CHECKED].tolist()), tuple(loads.tolist()))


def contact_meshes(sections: Sections, name: str, grading: float) -> tuple[PlaneMesh, PlaneMesh]:
    """Meshes of roller and ring, fine enough for contacts of a hundredth of the roller's radius and more.

    Parameters
    ----------
    sections : Sections
        The bodies.
    name : {"inner", "outer"}
        Which contact.
    grading : float
        Size of an element over its distance from the contact.
    """
    smallest = 5e-3 * grading * sections.roller_diameter
    roller = roller_mesh(0.5 * sections.roller_diameter, 0.5 * sections.roller_bore, smallest, grading)
    return roller, _ring(sections, name, smallest, grading)[0]


def seats(sections: Sections) -> Iterator[tuple[str, Sections]]:
    """Yield the same bearing on other seats, with their names: what the seat is worth.

    Parameters
    ----------
    sections : Sections
        Bodies of the bearing.
    """
    d, D = sections.bore, sections.outside_diameter
    elastic = replace(sections, seat="elastic", shaft_bore=0.0, housing_diameter=HOUSING_RATIO * D)
    yield "rigid seats", replace(sections, seat="rigid")
    yield "shaft solid, housing 1.25 D", replace(elastic, housing_diameter=1.25 * D)
    yield "shaft solid, housing 1.5 D", elastic
    yield "shaft solid, housing 2 D", replace(elastic, housing_diameter=2.0 * D)
    yield "shaft bore d/2, housing 1.5 D", replace(elastic, shaft_bore=0.5 * d)


def _half_widths(radius: float, modulus: float) -> FloatArray:
    """Half-widths of a series [m]."""
    widths = math.sqrt(8.0 * FE_LOAD * radius / (math.pi * modulus)) * _WIDTHS
    # of small rollers the widest contacts are wider than the law allows
    return np.asarray(widths * min(1.0, _WIDEST * radius / float(widths[-1])))


def _ring(sections: Sections, name: str, smallest: float, grading: float) -> tuple[PlaneMesh, float | None]:
    """Ring of a contact with what it sits on, and the radius of a shaft that takes the load."""
    elastic = sections.seat == "elastic"
    if name == "outer":
        far = sections.housing_diameter if elastic else sections.outside_diameter
        return ring_mesh(0.5 * sections.outer_raceway_diameter, 0.5 * far, smallest, grading), None
    raceway, seat = 0.5 * sections.inner_raceway_diameter, 0.5 * sections.bore
    if elastic:
        return ring_mesh(raceway, 0.5 * sections.shaft_bore, smallest, grading, seat), seat
    return ring_mesh(raceway, seat, smallest, grading), None


def _at_pitch(of_ring: PlaneYield, width: int, rollers: int) -> float:
    """Displacement of the raceway where the next roller stands, over the load [m2/N]; 0 for a roller alone."""
    if rollers < 2:
        return 0.0
    return float(np.interp(2.0 * math.pi / rollers, of_ring.angles, of_ring.surface[width]))


CONTACTS = ("inner", "outer")


def bearing_record(
    bearing: BearingGeometry,
    sections: Sections,
    *,
    meshes: bool = False,
    contact: bool = False,
    tell: Callable[[str], None] = lambda _: None,
) -> dict[str, Any]:
    """Solve both contacts of a bearing, in SI units.

    Parameters
    ----------
    bearing : BearingGeometry
        The bearing.
    sections : Sections
        Bodies of the bearing.
    meshes : bool
        Solve by three meshes, and on other seats, too.
    contact : bool
        Solve by CalculiX' contact, too: a minute each.
    tell : callable
        Takes a line about how far it is.

    Returns
    -------
    dict
        geometry, sections, versions; contacts by their names; approaches on other seats, where they were asked for.

    Raises
    ------
    DependencyError
        If gmsh or scikit-fem is missing.
    InputError
        If CalculiX is missing.
    AnalysisError
        If one of them fails.
    """
    record: dict[str, Any] = {
        "geometry": bearing.record(),
        "sections": sections.record(),
        "versions": {name: version(name) for name in ("gmsh", "scikit-fem")},
        "contacts": {},
    }
    if contact:
        record["versions"]["CalculiX"] = calculix.version("the check of the contact")
    for name in CONTACTS:
        tell(f"{name} contact")
        solved = solve_contact(bearing, sections, name)
        entry = contact_record(solved)
        free = solve_contact(bearing, sections, name, plane="stress")
        entry["plane_stress_approach"] = free.fit.fe_approach
        if meshes:
            tell(f"{name} contact by three meshes")
            entry["convergence"] = asdict(converge(bearing, sections, name))
        if contact:
            tell(f"{name} contact by CalculiX")
            check = check_contact(bearing, sections, name)
            entry["contact_check"] = {**asdict(check), "difference": check.difference}
        record["contacts"][name] = entry
    if meshes:
        record["seats"] = {
            label: {name: solve_contact(bearing, other, name).fit.fe_approach for name in CONTACTS}
            for label, other in seats(sections)
        }
    return record


def contact_record(contact: PlaneContact) -> dict[str, Any]:
    """One contact as plain values.

    Parameters
    ----------
    contact : PlaneContact
        The contact.
    """
    return {
        "radius": contact.radius,
        **asdict(contact.fit),
        "roller_share": contact.roller_share,
        "neighbour_share": contact.neighbour_share,
        "nodes": contact.nodes,
        "loads": contact.series.load.tolist(),
        "half_widths": contact.series.half_width.tolist(),
        "approaches": contact.series.approach.tolist(),
        "compliances": contact.series.compliance.tolist(),
    }

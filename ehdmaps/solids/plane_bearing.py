"""The plane model of a bearing: both contacts of a roller, and how far its numbers can be trusted."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from importlib.metadata import version
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.approach import FE_LOAD
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.solids import reduced_modulus
from ehdmaps.solids import calculix
from ehdmaps.solids.law import LawFit, PlaneSeries, fitted, series_of
from ehdmaps.solids.mesh_plane import PlaneMesh, ring_mesh, roller_mesh
from ehdmaps.solids.plane import Plane, PlaneYield, body_yield
from ehdmaps.solids.plane_contact import contact_loads
from ehdmaps.solids.sections import HOUSING_RATIO, Sections

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

"""Everything that the plane model finds of a bearing, as plain values: what `ehdmaps solids` writes and ships."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from importlib.metadata import version
from typing import Any

from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.solids import calculix
from ehdmaps.solids.plane_bearing import PlaneContact, check_contact, converge, seats, solve_contact
from ehdmaps.solids.sections import Sections

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
    found: dict[str, Any] = {
        "geometry": bearing.record(),
        "sections": sections.record(),
        "versions": {name: version(name) for name in ("gmsh", "scikit-fem")},
        "contacts": {},
    }
    if contact:
        found["versions"]["CalculiX"] = calculix.version("the check of the contact")
    for name in CONTACTS:
        tell(f"{name} contact")
        solved = solve_contact(bearing, sections, name)
        record = contact_record(solved)
        free = solve_contact(bearing, sections, name, plane="stress")
        record["plane_stress_approach"] = free.fit.fe_approach
        if meshes:
            tell(f"{name} contact by three meshes")
            record["convergence"] = asdict(converge(bearing, sections, name))
        if contact:
            tell(f"{name} contact by CalculiX")
            check = check_contact(bearing, sections, name)
            record["contact_check"] = {**asdict(check), "difference": check.difference}
        found["contacts"][name] = record
    if meshes:
        found["seats"] = {
            label: {name: solve_contact(bearing, other, name).fit.fe_approach for name in CONTACTS}
            for label, other in seats(sections)
        }
    return found


def contact_record(found: PlaneContact) -> dict[str, Any]:
    """One contact as plain values.

    Parameters
    ----------
    found : PlaneContact
        The contact.
    """
    return {
        "radius": found.radius,
        **asdict(found.fit),
        "roller_share": found.roller_share,
        "neighbour_share": found.neighbour_share,
        "nodes": found.nodes,
        "loads": found.series.load.tolist(),
        "half_widths": found.series.half_width.tolist(),
        "approaches": found.series.approach.tolist(),
        "compliances": found.series.compliance.tolist(),
    }

"""Elastohydrodynamic contact maps for roller bearings: stiffness, damping, approach and film.

::

    import ehdmaps

    emap = ehdmaps.open_map("nu308.nc")
    law = emap.law("series")
    w, dw_ddelta, dw_drate = law(delta, rate, entrainment_speed, temperature)

=================  =================================================================================
open_map           a map file, as `EHDMap`
solve              one contact at one operating point, without a map
physics types      `BearingGeometry`, `LineContact`, `Material`, `STEEL`, `Lubricant`, `OperatingPoint`,
                   `ContactSolution`, `Status`
law                `EHDMap`, `ContactLaw`, `LawAtPoint`
=================  =================================================================================

The names are loaded when they are first used, so that importing the package is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    __version__: str
    from ehdmaps.maps.emap import EHDMap, open_map
    from ehdmaps.maps.law import ContactLaw, LawAtPoint
    from ehdmaps.physics.bearing import BearingGeometry
    from ehdmaps.physics.contact import LineContact
    from ehdmaps.physics.lubricant import Lubricant
    from ehdmaps.physics.operating_point import OperatingPoint
    from ehdmaps.physics.solids import STEEL, Material
    from ehdmaps.physics.solution import ContactSolution, ContactSolver, Status

__all__ = [
    "STEEL",
    "BearingGeometry",
    "ContactLaw",
    "ContactSolution",
    "EHDMap",
    "LawAtPoint",
    "LineContact",
    "Lubricant",
    "Material",
    "OperatingPoint",
    "Status",
    "open_map",
    "solve",
]

_HOMES = {
    "EHDMap": "maps.emap",
    "open_map": "maps.emap",
    "ContactLaw": "maps.law",
    "LawAtPoint": "maps.law",
    "BearingGeometry": "physics.bearing",
    "LineContact": "physics.contact",
    "Lubricant": "physics.lubricant",
    "OperatingPoint": "physics.operating_point",
    "STEEL": "physics.solids",
    "Material": "physics.solids",
    "ContactSolution": "physics.solution",
    "Status": "physics.solution",
}


def solve(
    contact: LineContact,
    lubricant: Lubricant,
    point: OperatingPoint,
    solver: str | ContactSolver = "reynolds",
) -> ContactSolution:
    """Solve one contact at one operating point.

    Parameters
    ----------
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil.
    point : OperatingPoint
        Load, entrainment speed and temperature.
    solver : str or ContactSolver
        Name of a solver with its default settings ("hertz", "formula", "reynolds", "openfoam"), or a solver.

    Returns
    -------
    ContactSolution
        With a status: numbers are NaN where it is not usable.

    Raises
    ------
    InputError
        For a solver that does not exist.
    """
    from ehdmaps.errors import InputError
    from ehdmaps.physics.solution import contact_solution

    if isinstance(solver, str):
        from ehdmaps.jobs.solvers import SOLVER_NAMES, build

        if solver not in SOLVER_NAMES:
            raise InputError(f"solver: got {solver!r}; allowed: {', '.join(SOLVER_NAMES)}")
        solver = build(solver, {})
    (film,) = solver.solve_line(contact, lubricant, (point.load,), point.entrainment_speed, point.temperature)
    return contact_solution(film, contact, point)


def __getattr__(name: str) -> object:
    """Load a name from its module when it is first used; `__version__` is looked up then."""
    value: object
    if name == "__version__":
        value = import_module("ehdmaps.version").version()
    elif name in _HOMES:
        value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the public names."""
    return sorted(__all__)

"""Elastohydrodynamic contact maps for roller bearings: stiffness, damping, approach and film.

::

    import ehdmaps

    emap = ehdmaps.open_map("nu308.nc")
    law = emap.law("series")
    w, dw_ddelta, dw_drate = law(delta, rate, entrainment_speed, temperature)

==================  ================================================================================
open_map            a map file, as `EHDMap`
generate            make a map: of a job file, a shipped job, or a `Job`; `read_job`, `Job.build`
generate_batch      make the maps of a batch file
law                 a contact law without a map: films from the film table; `law("NU210", "ISO VG 46")`
compare             two maps, as a `Comparison`
solve               one contact at one operating point, without a map
solve_points        contacts at many operating points: dataset in, dataset out
frequency_response  stiffness and damping of contacts over frequency, as a dataset
physics types       `BearingGeometry`, `LineContact`, `Material`, `STEEL`, `Lubricant`, `OperatingPoint`,
                    `ContactSolution`, `Status`
laws                `EHDMap`, `ContactLaw`, `LawAtPoint`
==================  ================================================================================

The names are loaded when they are first used, so that importing the package is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    __version__: str
    from ehdmaps.jobs.calls import compare, frequency_response, generate, generate_batch, solve, solve_points
    from ehdmaps.jobs.job import Job
    from ehdmaps.jobs.make.table_law import law
    from ehdmaps.jobs.reader import read_job
    from ehdmaps.jobs.show.compare import Comparison
    from ehdmaps.maps.emap import EHDMap, open_map
    from ehdmaps.maps.law import ContactLaw, LawAtPoint
    from ehdmaps.physics.bearing import BearingGeometry
    from ehdmaps.physics.contact import LineContact, OperatingPoint
    from ehdmaps.physics.lubricant import Lubricant
    from ehdmaps.physics.solids import STEEL, Material
    from ehdmaps.physics.solution import ContactSolution, Status

__all__ = [
    "STEEL",
    "BearingGeometry",
    "Comparison",
    "ContactLaw",
    "ContactSolution",
    "EHDMap",
    "Job",
    "LawAtPoint",
    "LineContact",
    "Lubricant",
    "Material",
    "OperatingPoint",
    "Status",
    "compare",
    "frequency_response",
    "generate",
    "generate_batch",
    "law",
    "open_map",
    "read_job",
    "solve",
    "solve_points",
]

_HOMES = {
    "compare": "jobs.calls",
    "frequency_response": "jobs.calls",
    "generate": "jobs.calls",
    "generate_batch": "jobs.calls",
    "law": "jobs.make.table_law",
    "solve": "jobs.calls",
    "solve_points": "jobs.calls",
    "Comparison": "jobs.show.compare",
    "Job": "jobs.job",
    "read_job": "jobs.reader",
    "EHDMap": "maps.emap",
    "open_map": "maps.emap",
    "ContactLaw": "maps.law",
    "LawAtPoint": "maps.law",
    "BearingGeometry": "physics.bearing",
    "LineContact": "physics.contact",
    "Lubricant": "physics.lubricant",
    "OperatingPoint": "physics.contact",
    "STEEL": "physics.solids",
    "Material": "physics.solids",
    "ContactSolution": "physics.solution",
    "Status": "physics.solution",
}


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

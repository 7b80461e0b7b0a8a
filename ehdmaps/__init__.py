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

from ehdmaps.extras import public_names

__all__, __getattr__, __dir__ = public_names(__name__, __file__)

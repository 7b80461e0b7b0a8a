"""The maps of a scene's law in a report, with the operating points of its bearings marked."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ehdmaps.figures import typeset
from ehdmaps.jobs.show.map_charts import MapCurves, Operated
from ehdmaps.jobs.show.map_report import accuracy, curve_sections, limits
from ehdmaps.jobs.show.plot import what_is_mapped
from ehdmaps.maps.emap import EHDMap
from ehdmaps.report.page import Section
from mbs.report.examination import Examination
from mbs.scene.assembly import ring_motions


@dataclass(frozen=True, eq=False)
class UsedMap:
    """A map with the points at which a machine uses it.

    Attributes
    ----------
    emap : EHDMap
        The map, with the surfaces of the model.
    operated : tuple of Operated
        Operating points of its bearings; those at the same speed and temperature together.
    capped : bool
        Whether an oil supply caps the films of some bearing.
    """

    emap: EHDMap
    operated: tuple[Operated, ...]
    capped: bool


def used_maps(found: Examination) -> Iterator[UsedMap]:
    """Yield the maps of the law.

    Parameters
    ----------
    found : Examination
        What was found.
    """
    model, balance = found.model, found.statics.balance
    for emap in found.maps.maps if found.maps is not None else ():
        points: dict[tuple[str, str], Operated] = {}
        for bearing, motion in ring_motions(model, balance.displacement):
            if found.maps is None or found.maps.of(bearing.bearing.geometry) is not emap:
                continue
            speed = abs(float(bearing.entrainment_speed(balance.operation)))
            highest = float(bearing.rollers(motion, balance.operation).load_per_length.max())
            loads = {"inner": highest, "outer": highest + float(bearing.centrifugal_load(balance.operation))}
            place = f"{speed:.3g}", f"{bearing.temperature:.4g}"
            before = points.get(place)
            if before is not None:
                loads = {name: max(load, before.loads[name]) for name, load in loads.items()}
            label = bearing.name if before is None else f"{before.label}, {bearing.name}"
            points[place] = Operated(label, loads, speed, bearing.temperature)
        surface = model.surface
        capped = any(not supply.flooded for supply in model.supplies.values())
        yield UsedMap(emap if surface is None else emap.with_surface(surface), tuple(points.values()), capped)


def map_sections(used: UsedMap, prefix: str, several: bool) -> list[Section]:
    """Return the sections on a map: curves of each contact, limits, accuracy.

    Parameters
    ----------
    used : UsedMap
        The map.
    prefix : str
        Begins the names of sections and charts.
    several : bool
        Whether the report has more maps than this one.
    """
    title = f" ({what_is_mapped(used.emap)[0]})" if several else ""
    return [
        *curve_sections(MapCurves(used.emap), used.operated, prefix, title, used.capped),
        Section(f"{prefix}-limits", typeset(f"Where the map is limited, and why{title}"), [limits(used.emap, prefix)]),
        Section(f"{prefix}-accuracy", f"How accurate the map is{title}", [accuracy(used.emap)]),
    ]

"""The machine of a report and what limits its law, in sentences; the maps of its law with the points marked."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ehdmaps.figures import typeset
from ehdmaps.jobs.show.map_charts import MapCurves, Operated
from ehdmaps.jobs.show.map_report import accuracy, curve_sections, limits
from ehdmaps.jobs.show.plot import what_is_mapped
from ehdmaps.maps.emap import EHDMap
from ehdmaps.report.chart import number, shown
from ehdmaps.report.page import Markup, Section, joined, pairs, table, tag
from ehdmaps.units import FILM, LENGTH, PRESSURE, RPM
from mbs.analyses.film_errors import film_errors
from mbs.analyses.reach import fade_lines, outside_at
from mbs.model.elements import GROUND
from mbs.model.findings import Severity
from mbs.model.relaxation import NOTABLE
from mbs.output.model_text import (
    LITTLE_DAMPING,
    OTHER_DAMPING,
    assumed_words,
    clearance_text,
    temperature_text,
    weight_text,
)
from mbs.output.one_bearing.located import located
from mbs.output.one_bearing.table import regime
from mbs.output.result_text import kinds
from mbs.output.state_text import class_lines, flooded_note, largest_torque, state_lines
from mbs.report.bearings import loaded
from mbs.report.examination import Examination
from mbs.scene.assembly import ring_motions
from mbs.scene.contact_laws import supply_words
from mbs.scene.fields import FORCE, HERTZ
from mbs.scene.oils import by_oil
from mbs.unknowns.held_open import held_open_of
from mbs.unknowns.words import open_words


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
            highest = float(bearing.loads(motion, balance.operation).load_per_length.max())
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


def machine(found: Examination) -> Markup:
    """Return what is examined: speed, law, bearings and loads.

    Parameters
    ----------
    found : Examination
        What was found.
    """
    model = found.model
    scene = model.scene
    rows = [
        ("speed", shown(RPM, scene.speed)),
        ("contact law", model.law),
        ("temperature", typeset(temperature_text(model))),
        ("diametral clearance", typeset(clearance_text(model) or "none")),
        *(("", typeset(line.strip())) for line in class_lines(scene)),
        ("equilibrium", typeset(weight_text(model))),
        *_oil(found),
        *([("oil supply", typeset(supply_words(model.supplies)))] if model.supplies else []),
        *([("surfaces", typeset(model.surface.label))] if model.surface else []),
        *([("assumed", assumed)] if (assumed := assumed_words(scene)) else []),
        *(("" if k else "held open", typeset(line)) for k, line in enumerate(open_words(held_open_of(model)))),
    ]
    bearings = [
        (
            entry.name,
            entry.geometry.title,
            f"{entry.geometry.rolling_elements}",
            number(LENGTH.value(entry.geometry.roller_diameter), 5),
            number(LENGTH.value(entry.geometry.roller_length), 5),
            f"{entry.inner} in {entry.outer}",
        )
        for entry in scene.bearings
    ]
    loads = [
        (
            load.name,
            load.on if load.against == GROUND else f"{load.on} against {load.against}",
            *(", ".join(number(value, 4) for value in part) for part in (load.force[:3], load.force[3:])),
        )
        for load in scene.loads
    ]
    return joined(
        pairs(rows),
        *(tag("p", typeset(line.strip())) for line in state_lines(model.states)),
        table(
            ("bearing", "type", "rollers", "roller diameter, mm", "roller length, mm", "where"),
            bearings,
            "Roller bearings",
            (0, 1, 5),
        )
        if bearings
        else None,
        table(("load", "at", "force x, y, z, N", "moment x, y, z, N m"), loads, "Loads", (0, 1)) if loads else None,
    )


def _oil(examination: Examination) -> list[tuple[str, str]]:
    """The oil of the bearings, or that of the scene where the law has none."""
    used = by_oil(examination.model.oils)
    if not used:
        lubricant = examination.model.scene.lubricant
        return [("oil", lubricant.title)] if lubricant else []
    words = [oil.title + (f" ({', '.join(names)})" if len(used) > 1 else "") for oil, names in used.items()]
    return [("oil", typeset("; ".join(words)))]


def in_short(found: Examination) -> Iterator[str]:
    """Yield what a reader has to know first.

    Parameters
    ----------
    found : Examination
        What was found.
    """
    model, balance = found.model, found.statics.balance
    motions = ring_motions(model, balance.displacement)
    if motions:
        forces = [float(np.hypot(*balance.forces[index][1:3])) for index in range(len(motions))]
        most = int(np.argmax(forces))
        rollers = motions[most][0].loads(motions[most][1], balance.operation)
        contacts = found.statics.contacts[most]
        yield (
            f"Bearing {motions[most][0].name} carries most: {shown(FORCE, forces[most])} on "
            f"{loaded(rollers).size} of {rollers.load.size} rollers, up to "
            f"{shown(FORCE, float(rollers.load.max()))} on one, with a Hertz pressure of "
            f"{shown(PRESSURE, float(contacts.hertz_pressure.max()))}."
        )
    elif not model.on_rings:
        yield "The scene has no bearing of rollers or balls."
    for _, element, at in located(model, balance):
        yield (
            f"Bearing {element.name} has {at.loads.loaded} of {at.loads.angle.size} {element.rolling_element}s loaded, "
            f"up to {shown(FORCE, float(at.loads.load[0].max()))} on one."
        )
    films = [float(np.min(state.minimum_film)) for state in found.statics.contacts]
    if np.isfinite(films).any():
        thin = int(np.nanargmin(films))
        words = f"The thinnest film is {shown(FILM, films[thin])}, in bearing {model.on_rings[thin].name}"
        if model.surface is not None and not model.surface.smooth:
            parameter = films[thin] / model.surface.roughness
            words += f": Λ = {number(parameter)} ({regime(parameter)})"
        yield f"{words}."
    elif films:
        yield "The law knows no film: contacts are dry."
    if isinstance(found.modes, str):
        yield f"There are no modes: {found.modes}"
    else:
        _, _, swinging = kinds(found.modes.modes)
        if swinging.size:
            all_modes = found.modes.modes
            first = ", ".join(shown(HERTZ, float(all_modes.frequency[k])) for k in swinging[:3])
            ratios = all_modes.damping_ratio[swinging[:3]]
            yield (
                f"The lowest oscillating modes are at {first}, with damping ratios of {number(float(ratios.min()), 2)} "
                f"to {number(float(ratios.max()), 2)}."
            )
            if float(ratios.min()) < LITTLE_DAMPING:
                yield f"{OTHER_DAMPING[0].upper()}{OTHER_DAMPING[1:]}."
            if float(all_modes.eigenvalues.real.max()) > 1e-6 * float(np.abs(all_modes.eigenvalues).max()):
                yield "Warning: a motion grows: the equilibrium is not stable."


def warnings(found: Examination) -> list[str]:
    """Return what is to be warned of beside the findings: what a law does not reach, motions that nothing holds.

    Parameters
    ----------
    found : Examination
        What was found.
    """
    balance, model = found.statics.balance, found.model
    lines = [
        *model.warnings,
        *found.statics.free,
        *outside_at(model, balance),
        *fade_lines(model, np.array([model.scene.speed])),
    ]
    return [line.removeprefix("warning: ") for line in lines]


def notes(found: Examination) -> list[str]:
    """Return what else limits the numbers: estimates, films in quick motion, oil supply.

    Parameters
    ----------
    found : Examination
        What was found.
    """
    balance, model = found.statics.balance, found.model
    geometry = {entry.geometry.estimated: entry.geometry.title for entry in model.scene.bearings}
    torque = largest_torque(found.statics.losses)
    return [
        *(f"{name}: {words}" for words, name in geometry.items() if words),
        *(one.told for one in found.findings if one.severity is Severity.NOTE),
        *(
            f"{entry.bearing}: stiffness and damping of slow motion are off by more than {100.0 * NOTABLE:g} % from "
            f"{shown(HERTZ, entry.frequency)} on (estimated)"
            for entry in film_errors(model, balance.displacement, balance.operation, "slow")
            if math.isfinite(entry.frequency)
        ),
        *(line.removeprefix("note: ") for line in flooded_note(torque, model.supplies.values())),
        *(
            f"The weight of {name} is left out: its finite elements are held themselves"
            for name in model.system.weightless
        ),
    ]

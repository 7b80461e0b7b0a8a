"""List of all that a scene leaves open: unknowns with their half-widths, taken as uniform, and the sources of these.

=====================  ======================  =====================================================================
unknown                half-width              source
=====================  ======================  =====================================================================
clearance, not stated  class of ISO 5753-1     `ehdmaps.physics.designations.clearance`; each bearing its own
clearance, stated      5 um                    k5 in a ring of class P0: 2 to 25 um of interference; 5 K between
                                               the rings of a bore of 40 mm: 4 um
temperature            5 K, all together       assumed
viscosity, of a class  10 %, all together      ISO 3448
pressure-viscosity     25 % of a correlation,  So and Klaus: 17 % rms, 10 % of it too high; that of a correlation
                       10 % where stated       through a stated value by what other correlations have; FVA 3 is
                                               a fit whose source states no error: that of any stated value
oil layer              half to twice           what brings oil back to a track is not known better
inner geometry         what an estimate states `mbs.unknowns.geometry`
profile of rollers     iso, or straight        assumed
preload of springs     20 %                    assumed; loads with "preload" in their name, and axial offsets
stiffness, assumed     a third to three times  of seats and feet that nobody stated: orders of bolted joints, no source
cage angle             a pitch, each bearing   cages stand anywhere
loads                  none                    held, and said
oil supply             alternatives, no band   flooded where none is stated; beside it oil bath, oil air, grease
axis of balls          alternatives, no band   other hypotheses in place of outer race control
=====================  ======================  =====================================================================

Whatever states a tolerance replaces its row, see `mbs.unknowns.statement`. The viscosity of a class is a shift of
temperature to an equal viscosity: no new law is needed for it.
"""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from ehdmaps.errors import InputError
from ehdmaps.physics.designations.clearance import STATED, clearance_range
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from mbs.scene.changes import warmed, with_bearing, with_clearance_of, with_layers, with_loads
from mbs.scene.fields import DEGREE, MICROMETRE
from mbs.scene.scene import Scene
from mbs.scene.specs import BearingSpec, LocatingSpec
from mbs.unknowns.geometry import geometries, profiles
from mbs.unknowns.statement import tolerance_of
from mbs.unknowns.unknown import Unknown, looks_of

if TYPE_CHECKING:
    from mbs.scene.assembly import Model

LOOSER, WARMER = 5e-6, 5.0
"""Half-widths of a clearance [m] and of a temperature [K] that are stated without a tolerance."""

CLASS, ESTIMATED_ALPHA, STATED_ALPHA, PRELOAD = 0.10, 0.25, 0.10, 0.20
"""Half-widths of the viscosity of a class, of alpha by a correlation and as stated, and of a preload, as parts."""

LAYER = 2.0
"""Factor by which an oil layer may be thicker or thinner."""

CAGES = 8
"""Machines with cages at other angles."""

_AS_STATED = "as stated"


SOFTER = 3.0
"""Factor by which an assumed stiffness may be smaller or larger."""

SUPPLIES = ("oil bath", "oil air", "grease")
"""Oil supplies that a machine may have where none is stated, so that its films are flooded."""


def held_open_of(model: Model) -> tuple[Unknown, ...]:
    """List all that a model leaves open: what its law feels, and other oil supplies and axes of balls beside it.

    Parameters
    ----------
    model : Model
        The model.
    """
    flooded = all(supply.flooded for supply in model.supplies.values())  # that of the job of a map is stated
    supplies = other_supplies(model.scene) if model.has_films and flooded else ()
    return (*held_open(model.scene, model.has_films), *supplies, *hypotheses(model.scene))


def held_open(scene: Scene, films: bool = True) -> tuple[Unknown, ...]:
    """List all that a scene leaves open; what is stated to be exact is not among it.

    Parameters
    ----------
    scene : Scene
        The scene, with the clearances and temperatures in force: that of a `Model`.
    films : bool
        Whether its law has films: a dry one feels no oil, and a temperature only by fits and warm rings.
    """
    if not scene.has_bearings:
        return ()
    oil = (*_viscosity(scene, scene.lubricant), *_alpha(scene, scene.lubricant)) if films and scene.lubricant else ()
    warm = films or any(entry.thermal is not None or entry.mounting is not None for entry in scene.bearings)
    return (
        *_clearances(scene),
        *(_temperature(scene) if warm else ()),
        *oil,
        *(_layers(scene) if films else ()),
        *geometries(scene),
        *profiles(scene),
        *_preload(scene),
        *_springs(scene),
        *_loads(scene),
        *_cages(scene),
    )


def other_supplies(scene: Scene) -> Iterator[Unknown]:
    """List other oil supplies beside flooded films, where none is stated.

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    if scene.supply is None and all(getattr(entry, "supply", None) is None for entry in scene.of_all_kinds):
        for text in SUPPLIES:
            changed = dataclasses.replace(scene, supply=OilSupply.named(text))
            yield Unknown(text, "supply", "in place of flooded", "not stated: assumed", (changed,), beside=True)


def _clearances(scene: Scene) -> Iterator[Unknown]:
    """The clearance of each bearing that has one."""
    for entry in scene.of_all_kinds:
        if (value := clearance_of(entry)) is None:
            continue
        name, stated = f"clearance of {entry.name}", tolerance_of(scene, "clearance", entry.name)
        reach = clearance_range(entry.geometry)
        if stated is not None:
            half, why = stated.half_width(value), _AS_STATED
            least, largest, held = value - half, value + half, f"{MICROMETRE.text(value)} +-{MICROMETRE.text(half)}"
        elif reach is not None and reach.taken != STATED:
            (least, largest), why = reach.reach, reach.why
            held = f"{1e6 * least:.4g} to {MICROMETRE.text(largest)}"
        elif value == 0.0 and entry.of_points and getattr(entry.geometry, "contact_angle", None):
            why = "not stated: set when it is mounted, by springs and axial offsets"
            yield Unknown(name, "clearance", "0 um, held", why)
            continue
        else:
            least, largest, why = value - LOOSER, value + LOOSER, "stated bare: fits and warmth of rings"
            held = f"{MICROMETRE.text(value)} +-{MICROMETRE.text(LOOSER)}"
        if least < largest:
            looks, one = looks_of([_at(with_clearance_of, scene, entry.name, end) for end in (least, largest)])
            yield Unknown(name, "clearance", held, why, looks, one)


def _temperature(scene: Scene) -> Iterator[Unknown]:
    """The temperature of all bearings together."""
    stated = tolerance_of(scene, "temperature")
    half = WARMER if stated is None else stated.size
    if half:
        why = "stated bare: assumed" if stated is None else _AS_STATED
        looks, one = looks_of([_at(warmed, scene, by) for by in (-half, half)])
        yield Unknown("temperature", "temperature", f"+-{half:g} K", why, looks, one)


def _viscosity(scene: Scene, oil: Lubricant) -> Iterator[Unknown]:
    """The viscosity of an oil by its class."""
    stated = tolerance_of(scene, "viscosity")
    part = stated.size if stated is not None else CLASS if oil.oil_class is not None else 0.0
    if not part:
        return
    why = "class of ISO 3448" if stated is None else _AS_STATED
    try:
        cold, hot = (oil.at(scene.temperature + by).viscosity for by in (-1.0, 1.0))
    except InputError:
        return
    kelvin = part / (0.5 * math.log(cold / hot)) if cold > hot else 0.0
    makers = [_at(warmed, scene, by) for by in (kelvin, -kelvin)] if kelvin else []
    made = [oil.thickened(1.0 + sign * part) for sign in (-1.0, 1.0)]
    if all(made):
        makers = [_at(dataclasses.replace, scene, lubricant=end) for end in made]
    looks, one = looks_of(makers)
    yield Unknown("viscosity", "viscosity", f"+-{100.0 * part:.3g} %", why, looks, one)


def _alpha(scene: Scene, oil: Lubricant) -> Iterator[Unknown]:
    """The pressure-viscosity of an oil."""
    stated, temperature = tolerance_of(scene, "pressure_viscosity"), scene.temperature
    if stated is not None:
        part, why = stated.size, _AS_STATED
    elif oil.correlation is None:
        part, why = STATED_ALPHA, "stated bare: assumed"
    elif oil.stated_coefficient is None:
        part, why = ESTIMATED_ALPHA, f"estimated by {oil.correlation}"
    else:
        beside = math.sqrt(3.0) * oil.coefficient_error(temperature)
        part, why = min(math.hypot(STATED_ALPHA, beside), ESTIMATED_ALPHA), "stated at another temperature"
    if not part:
        return
    try:
        changed = oil.with_alpha(1.0 + part, temperature)
    except InputError:  # at the end of the oil's temperatures
        changed = None
    if changed is None:
        yield Unknown("pressure-viscosity", "pressure_viscosity", "as measured, held", "by the numbers of its law")
        return
    looks = (dataclasses.replace(scene, lubricant=changed),)
    yield Unknown("pressure-viscosity", "pressure_viscosity", f"+-{100.0 * part:.3g} %", why, looks, True)


def _layers(scene: Scene) -> Iterator[Unknown]:
    """The oil layers of all bearings together, where there are some."""
    found = [scene.supply, *(getattr(entry, "supply", None) for entry in scene.of_all_kinds)]
    layers = dict.fromkeys(1e6 * one.oil_layer for one in found if one is not None and not one.flooded)
    stated = tolerance_of(scene, "oil_layer")
    if not layers or (stated is not None and stated.exact):
        return
    least, most = (1.0 / LAYER, LAYER) if stated is None else (1.0 - stated.size, 1.0 + stated.size)
    why = "known to a factor of two at best" if stated is None else _AS_STATED
    held = ", ".join(f"{least * layer:.3g} to {most * layer:.3g} um" for layer in layers)
    looks, one = looks_of([_at(with_layers, scene, factor) for factor in (least, most)])
    yield Unknown("oil layer", "oil_layer", held, why, looks, one)


def hypotheses(scene: Scene) -> Iterator[Unknown]:
    """Other axes of all balls together, where those of the default are in force."""
    if not scene.has_points:
        return
    from ehdmaps.physics.point.ball_geometry import HYPOTHESES

    usual, *others = HYPOTHESES
    names = [entry.name for entry in scene.located if getattr(entry.geometry, "hypothesis", "") == usual]
    for text in others if names else ():
        changed = scene
        for name in names:
            changed = with_bearing(changed, name, functools.partial(_about, hypothesis=text))
        yield Unknown(text, "hypothesis", f"in place of {usual}", "no rule of balls is sure", (changed,), beside=True)


def _about(entry: LocatingSpec, *, hypothesis: str) -> LocatingSpec:
    """A ball bearing whose balls turn about another axis."""
    return dataclasses.replace(entry, geometry=dataclasses.replace(entry.geometry, hypothesis=hypothesis))


def _preload(scene: Scene) -> Iterator[Unknown]:
    """Loads that preload bearings, and axial offsets of rings."""
    stated = tolerance_of(scene, "preload")
    why = "stated bare: assumed" if stated is None else _AS_STATED

    def ends(size: float) -> tuple[float, str]:
        part = PRELOAD if stated is None else stated.half_width(size) / size
        return part, f"+-{100.0 * part:.3g} %"

    for load in scene.loads:
        size = float(math.hypot(*load.force[:3]))
        if "preload" not in load.name.lower() or not size:
            continue
        part, held = ends(size)
        if part:
            looks = tuple(
                dataclasses.replace(
                    scene,
                    loads=[
                        dataclasses.replace(one, force=(1.0 + by) * one.force) if one is load else one
                        for one in scene.loads
                    ],
                )
                for by in (-part, part)
            )
            yield Unknown(load.name if load.name == "preload" else f"preload {load.name}", "preload", held, why, looks)
    for entry in scene.located:
        if not entry.axial_offset or (stated is not None and not stated.part):
            continue
        part, held = ends(entry.axial_offset)
        if part:
            offsets = [(1.0 + by) * entry.axial_offset for by in (-part, part)]
            looks, one = looks_of([_at(_with_offset, scene, entry.name, offset) for offset in offsets])
            yield Unknown(f"axial offset of {entry.name}", "preload", held, why, looks, one)


def _springs(scene: Scene) -> Iterator[Unknown]:
    """Springs whose stiffness nobody stated."""
    stated = tolerance_of(scene, "stiffness")
    least, most = (1.0 / SOFTER, SOFTER) if stated is None else (1.0 - stated.size, 1.0 + stated.size)
    why = "not stated: assumed" if stated is None else _AS_STATED
    for spring in scene.springs if most > 1.0 else ():
        if spring.assumed:
            softer, stiffer = (dataclasses.replace(spring, stiffness=by * spring.stiffness) for by in (least, most))
            looks = tuple(
                dataclasses.replace(scene, springs=[end if one is spring else one for one in scene.springs])
                for end in (softer, stiffer)
            )
            held = f"{1e-6 * least * spring.stiffness[0, 0]:.3g} to {1e-6 * most * spring.stiffness[0, 0]:.3g} N/um"
            yield Unknown(f"stiffness of {spring.name}", "stiffness", held, why, looks)


def _loads(scene: Scene) -> Iterator[Unknown]:
    """All loads together, where a tolerance is stated."""
    stated = tolerance_of(scene, "load")
    if stated is not None and stated.size and scene.loads:
        looks = tuple(with_loads(scene, 1.0 + by) for by in (-stated.size, stated.size))
        yield Unknown("loads", "load", f"+-{100.0 * stated.size:.3g} %", _AS_STATED, looks)


def _cages(scene: Scene) -> Iterator[Unknown]:
    """Angles of the cages, each bearing its own: machines that spread evenly over all of them."""
    stated = tolerance_of(scene, "cage_angle")
    if stated is not None and stated.exact:
        return
    looks = []
    for k in range(CAGES):
        changed = scene
        for index, entry in enumerate(scene.of_all_kinds):
            # a lattice: no two cages go round together
            place = (k / CAGES * (1, 3, 5, 7)[index % 4] + 0.5 / CAGES) % 1.0
            pitch = 2.0 * math.pi / entry.geometry.rolling_elements
            by = place * pitch if stated is None else (2.0 * place - 1.0) * min(stated.size, 0.5 * pitch)
            changed = with_bearing(changed, entry.name, _turned(entry.start_angle + by))
        looks.append(changed)
    held = "anywhere" if stated is None else f"+-{DEGREE.text(stated.size)}"
    why = "cages stand as they come to rest" if stated is None else _AS_STATED
    yield Unknown("cage angle", "cage_angle", held, why, tuple(looks), frozen_cage=True)


def _turned(angle: float) -> Callable[[BearingSpec | LocatingSpec], BearingSpec | LocatingSpec]:
    """Change of a bearing to another angle of its cage."""
    return lambda entry: dataclasses.replace(entry, start_angle=angle)


def _with_offset(scene: Scene, bearing: str, offset: float) -> Scene:
    """The scene with another axial offset of a bearing [m]."""
    return with_bearing(scene, bearing, lambda entry: dataclasses.replace(entry, axial_offset=offset))


def _at(change: Callable[..., Scene], *values: object, **fields: object) -> Callable[[], Scene]:
    """Maker of a changed scene, called when it is asked for."""
    return lambda: change(*values, **fields)


def clearance_of(entry: BearingSpec | LocatingSpec) -> float | None:
    """Diametral clearance of a bearing [m]; None for tapered rollers, whose play is set along the axis, and washers."""
    found: float | None = entry.geometry.clearance
    return found if entry.geometry.has_clearance else None

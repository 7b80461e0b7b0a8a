"""Physics of films that matters at the operating points that a scene visits, each with the size of leaving it out.

The criteria are those of `mbs.planning.criteria`, each taken at its worst over both contacts of all bearings, over the
speeds of the scene, and over the loads of the rollers that carry it, `SHARES` of the highest load at rest. Rollers that
carry less take less than that part in stiffness. The oil supply is looked at down to idle rollers, whose films are the
thick ones. Of balls nothing is weighed: their films are Newtonian, with what is asked for of heat, supply, roughness.

`automatic` is an analysis that chooses its physics: films of the film table, with what the scene requires of memory and
heat.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.heat import INLET_HEAT, ISOTHERMAL, VALLEY_OIL_NUMBER
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import THICKEST, THINNEST, OilSupply
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.surface import FINEST
from ehdmaps.units import SPEED
from mbs.bearings.tapered.line_film import cylinder_of
from mbs.model.relaxation import Films
from mbs.planning.criteria import (
    TOUCHING,
    ClosedContact,
    closed_contact,
    heat_effect,
    heat_refused,
    memory_effect,
    roughness_effect,
    stress_felt,
    supply_effect,
)
from mbs.planning.plan import Needed, PlanSettings, plan
from mbs.scene.assembly import Model
from mbs.scene.choices import CHOICES
from mbs.scene.fields import HERTZ, MICROMETRE
from mbs.scene.scene import Scene
from mbs.scene.subject import Subject, named_law

TOLERANCE = 0.05
"""Change of a stiffness or damping of a contact above which physics matters, as a part of it."""

MOST_TOLERANCE = 9.0
"""A tenfold stiffness or damping, 20 dB."""

MOST_TOLD = 9.0
"""Change, as a part, above which its size is not told: what grows tenfold is another contact."""

SHARES = (0.1, 1.0)
"""Loads of rollers that carry a bearing, over the highest one at rest."""

MAKE_A_MAP = "a map by `mbs plan SCENE -o JOB.toml` and `ehdmaps generate JOB.toml` with {key} has it"
"""What is to be done where the film table cannot have it."""

_LOADS, _SPEEDS, _LAYERS = 9, 5, 241


@dataclass(frozen=True, kw_only=True)
class AutoSettings:
    """Settings of an analysis that chooses its physics; what is stated here is not chosen.

    Attributes
    ----------
    tolerance : float
        Change of a stiffness or damping, as a part of it, above which physics matters.
    highest : float or None
        Highest frequency that matters [Hz]; None for that of [linear] of the scene, else of [campbell]; 0 for none.
    clearance : float or None
        Diametral clearance of all bearings [m]; None for those of the scene.
    films : {"slow", "memory"} or None
        Films that are asked for.
    supply : OilSupply or None
        Oil supply of all bearings; None for those of the scene.
    physics : {"isothermal", "inlet-heat"} or None
        What films are to know of heat.

    Raises
    ------
    InputError
        For a tolerance out of range.
    """

    tolerance: float = TOLERANCE
    highest: float | None = None
    clearance: float | None = None
    films: Films | None = None
    supply: OilSupply | None = None
    physics: str | None = None

    def __post_init__(self) -> None:
        if not 0.0 < self.tolerance <= MOST_TOLERANCE:
            raise InputError(
                f"auto, tolerance: got {self.tolerance!r}; allowed: above 0 up to {MOST_TOLERANCE:g}, a part of a "
                "stiffness or damping"
            )


@dataclass(frozen=True)
class Verdict:
    """Verdict on one kind of physics of the films.

    Attributes
    ----------
    physics : str
        Which: "film memory", "oil supply", "roughness", "inlet heat", "limiting shear stress".
    on : bool
        Whether films have it.
    size : float
        How much it changes a stiffness or damping at most, as a part of it. NaN where that is not known.
    words : str
        The same for people, and where.
    matters : bool
        Whether that is more than the tolerance.
    fails : bool
        Whether the rule by which films have it does not hold somewhere.
    """

    physics: str
    on: bool
    size: float
    words: str
    matters: bool
    fails: bool = False

    @property
    def line(self) -> str:
        """The verdict in a line."""
        return f"{self.physics}: {'on' if self.on else 'off'}, {self.words}"


def verdicts(scene: Scene, settings: AutoSettings | None = None) -> tuple[Verdict, ...]:
    """Judge the physics of the films of a scene.

    Parameters
    ----------
    scene : Scene
        The scene as the analysis visits it, see `mbs.planning.question`, with bearings and a lubricant.
    settings : AutoSettings, optional
        Tolerance, frequency, and what is not to be chosen.

    Returns
    -------
    tuple of Verdict
        Memory, where there is a frequency, supply, roughness, heat, limiting stress; none of balls alone.

    Raises
    ------
    InputError
        With everything because of which ranges cannot be told.
    AnalysisError
        If a bearing carries no load or does not roll, or there is no equilibrium.

    Examples
    --------
    >>> from mbs import read_scene
    >>> [verdict.physics for verdict in verdicts(read_scene("nu308_rigid")) if verdict.matters]
    ['film memory', 'inlet heat', 'limiting shear stress']
    """
    settings = settings or AutoSettings()
    # raceways of their own temperatures are looked at with that of the scene
    cold = scene.with_bearings(dataclasses.replace(entry, thermal=None) for entry in scene.bearings)
    found, oil = plan(cold, PlanSettings(settings.clearance)), scene.lubricant
    assert oil is not None  # the plan saw to it
    carrying: list[ClosedContact] = []
    idle: list[ClosedContact] = []
    for entry in (*found.needed, *found.seen):
        lightest, most = SHARES[0] * entry.static_load, SHARES[1] * entry.static_load
        loads = np.geomspace(lightest, most, _LOADS), np.geomspace(min(entry.load[0], lightest), lightest, _LOADS)
        for speed in np.unique(np.geomspace(*entry.entrainment_speed, _SPEEDS)).tolist():
            for contact in _lines(entry):
                at = (closed_contact(contact, oil, each, speed, entry.temperature) for each in loads)
                for states, state in zip((carrying, idle), at, strict=True):
                    states.append(state)
    if not carrying:
        return ()
    highest = settings.highest
    if highest is None:
        highest = max(scene.frequencies, default=scene.campbell.highest)
    tolerance = settings.tolerance
    return (
        *([_memory(carrying, highest, settings, _without_memory(scene))] if highest > 0.0 else []),
        _supply([*carrying, *idle], _stated_supplies(scene, settings.supply), tolerance),
        _roughness(carrying, scene, oil),
        _heat(carrying, oil, settings.physics, tolerance),
        _stress(carrying),
    )


def switched(found: Sequence[Verdict]) -> Mapping[str, str]:
    """Values of choices by which films have what is on, by the names of the choices (`mbs.scene.choices`).

    Parameters
    ----------
    found : sequence of Verdict
        Verdicts on films.
    """
    on = {verdict.physics: verdict.on for verdict in found}
    chosen = {}
    if "film memory" in on:
        chosen["films"] = "memory" if on["film memory"] else "slow"
    if "inlet heat" in on:
        chosen["physics"] = INLET_HEAT if on["inlet heat"] else ISOTHERMAL
    return chosen


def _lines(entry: Needed) -> tuple[LineContact, ...]:
    """The inner and the outer contact of a bearing; none of balls, whose contacts are points."""
    if entry.of_points:
        return ()
    return (entry.geometry if entry.mapped else cylinder_of(entry.geometry)).contacts(STEEL, "iso16281")


def _worst(
    states: Sequence[ClosedContact], effect: Callable[[ClosedContact], FloatArray]
) -> tuple[float, ClosedContact]:
    """The largest effect, NaN where one is not known, and where it is."""
    return max(((float(np.max(effect(state))), state) for state in states), key=lambda entry: entry[0])


def _memory(states: Sequence[ClosedContact], frequency: float, settings: AutoSettings, without: str) -> Verdict:
    """Judge whether films need their memory."""
    size, state = _worst(states, lambda entry: memory_effect(entry, frequency))
    matters = size > settings.tolerance
    words = (
        f"films of slow motion are wrong by {up_to(size)} in k + i omega c of a contact at {HERTZ.text(frequency)} and "
        f"{SPEED.text(state.speed)}{f'; with {without} there is none' if without else ''}"
    )
    on = settings.films == "memory" if settings.films else matters and not without
    return Verdict("film memory", on, size, words, matters)


def _supply(states: Sequence[ClosedContact], stated: Sequence[OilSupply], tolerance: float) -> Verdict:
    """Tell what the stated oil supply changes; without one, which layer would."""
    name = "oil supply"
    layers = [supply.oil_layer for supply in stated if not supply.flooded]
    if not layers:
        tried = np.geomspace(THINNEST, THICKEST, _LAYERS)
        sizes = np.max([np.max(supply_effect(one, tried[:, None]), axis=1) for one in states], axis=0)
        thickest = float(np.max(tried[sizes > tolerance], initial=THINNEST))
        words = f"none is stated; a layer below {MICROMETRE.text(thickest, 3)} would matter"
        return Verdict(name, False, math.nan, words, False)
    thinnest = min(layers)
    size, _ = _worst(states, lambda entry: supply_effect(entry, thinnest))
    words = f"a layer of {MICROMETRE.text(thinnest, 3)} changes k or c of a contact by {up_to(size)}"
    return Verdict(name, True, size, words, size > tolerance)


def _roughness(states: Sequence[ClosedContact], scene: Scene, oil: Lubricant) -> Verdict:
    """Tell what the stated roughness changes; without one, which would."""
    name, surface = "roughness", scene.surface
    thinnest, state = min(((float(np.min(one.minimum_film)), one) for one in states), key=lambda entry: entry[0])
    if surface is None or surface.smooth:
        least = max(thinnest / TOUCHING, FINEST)
        words = f"none is stated; above {MICROMETRE.text(least, 2)} asperities would touch"
        return Verdict(name, False, math.nan, words, False)
    share = thinnest / surface.roughness
    # of asperities no more is known than their usual range
    sizes = [
        np.max([np.max(roughness_effect(one, corner, oil), axis=1) for one in states], axis=0)
        for corner in surface.corners
    ]
    k, c = np.max(sizes, axis=0).tolist()
    words = (
        f"Lambda down to {share:.2g} at {SPEED.text(state.speed)}, and asperities touch below {TOUCHING:g}; it changes "
        f"k of a contact by {up_to(k)}, c by {up_to(c)}"
    )
    return Verdict(name, True, max(k, c), words, share < TOUCHING)


def _heat(states: Sequence[ClosedContact], oil: Lubricant, asked: str | None, tolerance: float) -> Verdict:
    """Judge heat in the inlet, which films of the table have by its rule."""
    name = "inlet heat"
    if oil.thermal_conductivity is None:
        words = f"unknown: no thermal conductivity of {oil.title} is known; films are isothermal"
        return Verdict(name, asked == INLET_HEAT, math.nan, words, False)
    size, state = _worst(states, lambda entry: np.maximum(*heat_effect(entry, oil)))
    matters = size > tolerance
    refused = next(filter(None, (heat_refused(one, oil) for one in states)), "") if matters else ""
    on = asked != ISOTHERMAL
    words = f"it changes k or c of a contact by {up_to(size)} at {SPEED.text(state.speed)}"
    if refused:
        words += f"; its rule fails where {refused}: the errors of the films say so; "
        words += MAKE_A_MAP.format(key='physics = "thermal"')
    if matters and not on:
        words += f"; --physics {INLET_HEAT} has it"
    return Verdict(name, on, size, words, matters, fails=bool(refused))


def _stress(states: Sequence[ClosedContact]) -> Verdict:
    """Tell whether a limiting shear stress is felt, which films of the table have not."""
    name = "limiting shear stress"
    felt = [state for state in states if np.any(stress_felt(state))]
    if not felt:
        return Verdict(name, False, math.nan, "hardly felt: no carrying roller is in a deep damping valley", False)
    state = max(felt, key=lambda entry: entry.oil_number)
    words = (
        f"carrying rollers are in the damping valley with L = {state.oil_number:.3g}, above {VALLEY_OIL_NUMBER:g}, at "
        f"{SPEED.text(state.speed)}, where c without it is no number to rely on; "
        + MAKE_A_MAP.format(key='shear = "limiting"')
    )
    return Verdict(name, False, math.nan, words, True)


def _stated_supplies(scene: Scene, asked: OilSupply | None) -> list[OilSupply]:
    """Oil supplies that are stated."""
    every = [asked or entry.supply or scene.supply for entry in scene.bearings]
    every += [asked or scene.supply] * bool(scene.located)
    return [supply for supply in every if supply is not None]


def _without_memory(scene: Scene) -> str:
    """Name the part of a scene that films with memory do not go with; empty where they do."""
    bearings = scene.bearings
    if any(entry.centrifugal and not entry.rollers_as_bodies for entry in bearings):
        return "a centrifugal load of massless rollers"
    return "coupled slices" if any(entry.slices_coupled for entry in bearings) else ""


def up_to(part: float) -> str:
    """The largest of some changes, for people.

    Parameters
    ----------
    part : float
        The part, >= 0.

    Examples
    --------
    >>> up_to(0.55), up_to(2.32), up_to(5820.6)
    ('up to 55 %', 'a factor of up to 3.3', 'a factor of more than 10')
    """
    if part <= 1.0:
        return f"up to {100.0 * part:.2g} %" if part < 0.995 else f"up to {100.0 * part:.0f} %"
    return f"a factor of up to {1.0 + part:.2g}" if part <= MOST_TOLD else f"a factor of more than {1.0 + MOST_TOLD:g}"


R = TypeVar("R")


@dataclass(frozen=True, eq=False)
class Automatic(Generic[R]):
    """An analysis with the physics that was chosen for it.

    Attributes
    ----------
    result : R
        What the analysis gave.
    subject : Subject
        Scene and law that it was made with.
    verdicts : tuple of Verdict
        Which physics is on, and why, see `mbs.planning.physics.verdicts`.
    """

    result: R
    subject: Subject
    verdicts: tuple[Verdict, ...]


def automatic(
    scene: Scene,
    analysis: Callable[[Model], R],
    settings: AutoSettings | None = None,
    planned_for: Scene | None = None,
) -> Automatic[R]:
    """Analyse a scene with the physics that it requires.

    Parameters
    ----------
    scene : Scene
        Scene with bearings and a lubricant.
    analysis : callable
        One of `mbs.statics`, `modes`, `lsa`, `sweep`, `critical`, `runup`, `campbell`, `hammer`, or a function that
        calls one.
    settings : AutoSettings, optional
        Tolerance, frequencies, and what is not to be chosen.
    planned_for : Scene, optional
        The scene as the analysis visits it, such as `mbs.planning.question.at_one_speed(scene)` for statics; the scene
        with all its speeds if left out.

    Raises
    ------
    InputError
        With everything because of which ranges cannot be told, or films cannot be had.
    AnalysisError
        If there is no equilibrium, or what the analysis raises.

    Examples
    --------
    >>> from mbs import automatic, modes, read_scene
    >>> found = automatic(read_scene("nu308_rigid"), modes)
    >>> found.verdicts[0].physics, found.verdicts[0].on, found.subject.law.films
    ('film memory', True, 'memory')
    """
    settings = settings or AutoSettings()
    found = verdicts(planned_for or scene, settings)
    law = dataclasses.replace(named_law(None, scene), supply=settings.supply)
    subject = Subject(scene, law, settings.clearance)
    for name, value in switched(found).items():
        subject = CHOICES[name].chosen(subject, value)
    return Automatic(analysis(subject.model()), subject, found)

"""Error budget of a machine: by how much results are wrong where a source of error is left out or not known.

Laws, oil supplies, and what a scene states or leaves open are each beside the film with its memory, by linear looks:
one equilibrium with its modes and responses. What a user looks at are frequencies, damping ratios, heights of
responses and contact loads. Two systems are compared mode by mode. Modes belong together by their shapes in the
coordinates that both systems have, weighted with the mass (modal assurance); a mode without a partner is said to be
lost, and is in no error.
"""

from __future__ import annotations

import contextlib
import dataclasses
import functools
import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields

import numpy as np
import scipy

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.choices import supply_from_text
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.physics.heat import ISOTHERMAL
from ehdmaps.physics.surface import Surface
from ehdmaps.trade.record import Choice, Entry, ErrorSummary, Group, Judged, Source, Trade
from ehdmaps.units import RPM
from mbs.analyses.operating import operating, settled
from mbs.bearings.laws import FORMULAS
from mbs.linearised.averaged import mean_equilibrium
from mbs.linearised.linear import frequency_response, with_peaks
from mbs.linearised.modes import Modes, modes
from mbs.linearised.pairs import partners
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium
from mbs.scene.assembly import Model
from mbs.scene.changes import with_clearance_of
from mbs.scene.choices import CHOICES
from mbs.scene.contact_laws import law_label
from mbs.scene.fields import HERTZ
from mbs.scene.map_set import TABLE_LAW
from mbs.scene.scene import Scene
from mbs.scene.subject import LawChoice, Subject, named_law
from mbs.settings import CAGE_ANGLES
from mbs.unknowns.held_open import SUPPLIES, clearance_of, held_open, hypotheses
from mbs.unknowns.unknown import Unknown

MOST_DAMPED = 0.5
"""Damping ratio up to which a mode is looked at: above, a response has hardly a peak by it."""

AROUND = 0.1
"""Part of its frequency within which the height of a peak is looked for."""

_PROMINENCE = 3.0
_LEFT_OVER = 1e-9


@dataclass(frozen=True, eq=False)
class LinearLook:
    """A linear system at an operating point.

    Attributes
    ----------
    balance : Equilibrium
        Equilibrium at which it was linearised.
    modes : Modes
        Complex modes of the system.
    frequencies : array, shape (frequencies,)
        Frequencies of the responses [Hz].
    levels : array, shape (frequencies, responses)
        Response of each sensor to each input [dB re 1 of its unit].
    loads : array, shape (bearings,)
        Load of the most loaded contact of each bearing: per length of a slice [N/m], or of a ball [N].
    bearings : tuple of str
        Names of these bearings.
    seconds : float
        Processor time of equilibrium, modes and responses [s]; modes without bounds of their errors.
    """

    balance: Equilibrium
    modes: Modes
    frequencies: FloatArray
    levels: FloatArray
    loads: FloatArray
    bearings: tuple[str, ...]
    seconds: float


@dataclass(frozen=True, eq=False)
class LinearDifferences:
    """A linear system beside a reference, NaN where there is nothing to compare.

    Attributes
    ----------
    frequency, damping : array, shape (modes,)
        Relative differences of frequencies and damping ratios of the modes of the reference.
    height : array, shape (peaks,)
        Differences of the heights of the peaks of the reference [dB].
    load : array, shape (bearings,)
        Relative differences of the largest loads.
    """

    frequency: FloatArray
    damping: FloatArray
    height: FloatArray
    load: FloatArray

    @classmethod
    def worst(cls, several: Sequence[LinearDifferences]) -> LinearDifferences:
        """Largest of each difference of several systems; NaN where one has nothing to compare.

        Parameters
        ----------
        several : sequence of LinearDifferences
            Differences of at least one system, all beside the same reference.
        """
        parts = (np.array([getattr(one, entry.name) for one in several]) for entry in fields(cls))
        return cls(*(_largest(part) for part in parts))


@dataclass(frozen=True, eq=False)
class LinearReference:
    """A linear system beside which others are looked at.

    Attributes
    ----------
    look : LinearLook
        The system.
    chosen : array of int, shape (modes,)
        Which of its modes are looked at.
    peaks : tuple of (int, float)
        Response, and frequency [Hz], of each peak.
    """

    look: LinearLook
    chosen: IntArray
    peaks: tuple[tuple[int, float], ...]

    @classmethod
    def of(cls, look: LinearLook, highest: float) -> LinearReference:
        """Choose modes and peaks.

        Parameters
        ----------
        look : LinearLook
            The system.
        highest : float
            Frequency up to which they are looked at [Hz].
        """
        found = look.modes
        seen = (found.frequency <= highest) & (found.damping_ratio <= MOST_DAMPED) & (found.frequency > 1.0)
        peaks = []
        for column in range(look.levels.shape[1]):
            places, _ = scipy.signal.find_peaks(look.levels[:, column], prominence=_PROMINENCE)
            peaks += [(column, float(look.frequencies[k])) for k in places if look.frequencies[k] <= highest]
        return cls(look, np.asarray(np.flatnonzero(seen), dtype=np.int64), tuple(peaks))

    def beside(self, other: LinearLook) -> LinearDifferences:
        """Compare another system with this one.

        Parameters
        ----------
        other : LinearLook
            The other system; it may have other coordinates.
        """
        own = self.look.modes
        partner = self._partners(other)
        there = partner >= 0
        frequency = np.full(partner.size, np.nan)
        damping = np.full(partner.size, np.nan)
        which = self.chosen[there]
        frequency[there] = other.modes.frequency[partner[there]] / own.frequency[which] - 1.0
        ratios = own.damping_ratio[which]
        damped = ratios > 0.0
        damping[there] = np.where(
            damped, other.modes.damping_ratio[partner[there]] / np.where(damped, ratios, 1.0) - 1.0, np.nan
        )
        height = [_highest(other, column, at) - _highest(self.look, column, at) for column, at in self.peaks]
        load = other.loads / self.look.loads - 1.0
        # What an equilibrium leaves over is no difference.
        return LinearDifferences(frequency, damping, np.array(height), np.where(np.abs(load) > _LEFT_OVER, load, 0.0))

    def _partners(self, other: LinearLook) -> IntArray:
        """The mode of another system that each chosen mode is; -1 where there is none."""
        own = self.look
        shapes = own.modes.shapes[:, self.chosen]
        return partners(own.balance.system, shapes, other.balance.system, other.modes.shapes)


def linear_look(model: Model, angle: float = 0.0, cage_angles: int = CAGE_ANGLES) -> LinearLook:
    """Look at the linear system of a model at its operating speed.

    Parameters
    ----------
    model : Model
        Scene with its law; without inputs, sensors or frequencies it has no responses.
    angle : float
        Angle that the system has turned, with its cages [rad].
    cage_angles : int
        Cage angles over which stiffness and damping of the bearings are averaged, the first of them at `angle`.

    Raises
    ------
    AnalysisError
        If there is no equilibrium.
    """
    begin = time.process_time()
    scene = model.scene
    model = operating(model, scene.speed)
    balance = mean_equilibrium(model.system, Operation(scene.speed, angle), cage_angles)
    found = modes(balance, errors=False)  # 1e-7 of a frequency is no difference of a choice
    asked = np.array(scene.frequencies) if scene.inputs and scene.sensors else np.zeros(0)
    frequencies = with_peaks(asked, found.eigenvalues)
    responses = np.abs(frequency_response(balance, scene.inputs, scene.sensors, frequencies))
    seconds = time.process_time() - begin
    found_loads = model.largest_loads(balance.displacement, balance.operation)
    known = ~np.isnan(found_loads)
    if not np.all(found_loads[known] > 0.0):
        raise AnalysisError("a bearing carries no load at its equilibrium, so that nothing can be compared with it")
    levels = 20.0 * np.log10(np.maximum(responses, 1e-300)).reshape(frequencies.size, math.prod(responses.shape[1:]))
    names = tuple(entry.name for entry, there in zip(model.on_rings, known, strict=True) if there)
    return LinearLook(balance, found, frequencies, np.asarray(levels), found_loads[known], names, seconds)


def _largest(values: FloatArray) -> FloatArray:
    """Value of largest size in each column, with its sign; NaN where one is."""
    if not values.size:
        return np.zeros(values.shape[1:])
    at = np.argmax(np.where(np.isnan(values), np.inf, np.abs(values)), axis=0)
    return np.asarray(np.take_along_axis(values, at[None], axis=0)[0])


def _highest(look: LinearLook, column: int, frequency: float) -> float:
    """Highest level of a response around a frequency [dB]; between two frequencies where none is near."""
    near = np.abs(look.frequencies - frequency) <= AROUND * frequency
    if not near.any():
        return float(np.interp(frequency, look.frequencies, look.levels[:, column]))
    return float(np.max(look.levels[near, column]))


FREQUENCY, DAMPING, HEIGHT, LOAD = "frequency", "damping ratio", "response peak", "contact load"

LINEAR = (Judged(FREQUENCY), Judged(DAMPING), Judged(HEIGHT, "dB"), Judged(LOAD))
"""What is compared in a linear analysis."""

DAMPER = "hertz:1.25e-5 s"
"""A dry contact with the damper in the middle of the usual range."""

ROUGH = Surface(2e-7)
"""A surface in place of a smooth one."""


UNKNOWN = "what is held open"
"""Group of what a scene leaves open, or states and may be wrong."""


Tried = Entry[Subject]
"""A choice that is measured, in a group with what it is compared with."""


def model_choices(base: Subject, model: Model) -> list[Tried]:
    """Choices of laws, of supplies, and of what is stated, each beside the most complete model.

    Parameters
    ----------
    base : Subject
        The scene with films that have their memory.
    model : Model
        Model of the scene.
    """
    return [*_laws(base), *_supplies(base), *_others(base, model)]


def open_rows(base: Subject, model: Model, beside: LinearReference) -> list[Choice]:
    """Rows of the linear analysis for all that a scene leaves open: of each the larger change at both of its ends.

    Parameters
    ----------
    base : Subject
        The scene with films that have their memory.
    model : Model
        Model of the scene.
    beside : LinearReference
        Reference of the rows.
    """
    group, rows = Group(UNKNOWN, base), []
    for unknown in held_open(model.scene):
        looks = []
        for scene in unknown.looks:
            with contextlib.suppress(AnalysisError, InputError):  # what has no equilibrium has no error either
                looks.append(linear_look(model.again(scene), cage_angles=1 if unknown.frozen_cage else CAGE_ANGLES))
        if looks:
            entry = Entry(group, _label(unknown), base)
            differences = LinearDifferences.worst([beside.beside(look) for look in looks])
            rows.append(differences_row(entry, sum(look.seconds for look in looks), beside, differences))
    return rows


def open_runs(base: Subject, model: Model) -> list[Tried]:
    """Choices of what a scene leaves open for runs in time: the upper ends of its temperature, and of all clearances.

    Parameters
    ----------
    base : Subject
        The scene with films that have their memory.
    model : Model
        Model of the scene.
    """
    group, unknowns = Group(UNKNOWN, base), held_open(model.scene)
    clearances = [one for one in unknowns if one.group == "clearance" and one.looks]
    found = [(_label(one), one.looks[-1]) for one in unknowns if one.group == "temperature" and one.looks]
    if clearances:
        loose = functools.reduce(_looser, (one.looks[-1] for one in clearances))
        found.append((_label(clearances[0]) if len(clearances) == 1 else "all clearances at their upper ends", loose))
    return [Entry(group, label, dataclasses.replace(base, scene=scene, clearance=None)) for label, scene in found]


def _looser(scene: Scene, other: Scene) -> Scene:
    """The scene with the clearances of another one of the same bearings, where these are larger."""
    for own, entry in zip(scene.of_all_kinds, other.of_all_kinds, strict=True):
        least, value = clearance_of(own), clearance_of(entry)
        if value is not None and least is not None and value > least:
            scene = with_clearance_of(scene, entry.name, value)
    return scene


def _label(unknown: Unknown) -> str:
    """Name of a row, with how far it may be off."""
    return f"{unknown.name} {unknown.held}"


def model_sources(base: Subject, choices: Sequence[Choice]) -> list[Source]:
    """Sources of error of the model: what a law leaves out, what a scene states and may be wrong.

    Parameters
    ----------
    base : Subject
        The scene with films that have their memory.
    choices : sequence of Choice
        What was measured.
    """
    memory, open_groups = f"{base.law.label}, memory", [f"{kind}: {UNKNOWN}" for kind in ("linear", "run-up")]
    return [
        Source("films, their stiffness and damping", law_label("hertz"), memory),
        Source("film memory", f"{base.law.label}, slow films", memory),
        *(Source(f"oil supply: {text}", text) for text in SUPPLIES),
        *(Source(label, label) for label in dict.fromkeys(one.label for one in choices if one.group in open_groups)),
    ]


def error_budget(subject: Subject, highest: float) -> Trade:
    """Look at a machine with each source of error, at its operating speed.

    Parameters
    ----------
    subject : Subject
        The scene with its law; one without films is held against the film table.
    highest : float
        Frequency up to which modes and peaks count [Hz].

    Raises
    ------
    AnalysisError
        If the scene has no equilibrium.
    InputError
        If it has no law with films.
    """
    scene, law = subject.scene, subject.law
    if not law.has_films:
        law = named_law(TABLE_LAW if scene.lubricant is not None else "formula", scene)
    base = dataclasses.replace(subject, law=dataclasses.replace(law, films="memory"))
    base, model = settled_base(base, highest)
    beside = LinearReference.of(linear_look(model), highest)
    choices = []
    for one in model_choices(base, model):
        try:
            found = beside.look if one.way is base else linear_look(one.way.model())
        except (AnalysisError, InputError):
            continue  # what has no equilibrium has no error either
        choices.append(linear_row(one, found, beside))
    choices += open_rows(base, model, beside)
    counted = f"{beside.chosen.size} modes and {len(beside.peaks)} peaks"
    sample = f"{counted} up to {HERTZ.text(highest)} at {RPM.text(scene.speed)}"
    return Trade(
        level="system",
        title=f"Error budget of {scene.title}",
        cost="s",
        reference=f"{base.law.label} with memory of its films",
        judged=LINEAR,
        choices=tuple(choices),
        frame=(
            f"{sample}, one equilibrium and linear analysis a line, against {base.law.label} with memory; "
            "mbs tradeoff measures more.",
        ),
        sources=tuple(model_sources(base, choices)),
        shown=(FREQUENCY, DAMPING, HEIGHT) if beside.peaks else (FREQUENCY, DAMPING),
    )


def settled_base(base: Subject, highest: float) -> tuple[Subject, Model]:
    """The subject and its model, with the clearances in force, and cut-offs that modes do not feel.

    Parameters
    ----------
    base : Subject
        The scene with its law.
    highest : float
        Frequency up to which modes count [Hz].
    """
    model = settled([base.model()], base.scene.speed, highest)[0]
    return dataclasses.replace(base, scene=model.scene, clearance=None), model


def _others(base: Subject, model: Model) -> Iterator[Tried]:
    """Alternatives of what a scene states, which have no range."""
    group = Group(UNKNOWN, base)
    stated: list[tuple[str, str | Surface, str]] = []
    if base.law.maps is not None:
        structure = base.law.maps.maps[0].structural_law
        other = "iso16281" if structure == "half_space" else "half_space"
        stated.append(("structural-law", other, f"structural law {other} in place of {structure}"))
    films, maps = base.law.may_relax, () if base.law.maps is None else base.law.maps.maps
    if films and base.law.inlet_heat is not False and (base.law.name == TABLE_LAW or any(m.inlet_heat for m in maps)):
        stated.append(("physics", ISOTHERMAL, "films without heat in the inlet"))
    if model.surface is not None and model.surface.smooth:
        stated.append(("roughness", ROUGH, ROUGH.label))
    for key, value, label in stated:
        with contextlib.suppress(InputError):
            yield Entry(group, label, CHOICES[key].change(base, value))
    for one in hypotheses(base.scene):
        yield Entry(group, f"axis of balls: {one.name}", dataclasses.replace(base, scene=one.looks[0]))
    if model.surface is not None and not model.surface.smooth and model.surface.corners[0] != model.surface:
        soft = dataclasses.replace(base.scene, surface=model.surface.corners[0])
        yield Entry(group, "softest usual asperities", dataclasses.replace(base, scene=soft))


def _laws(base: Subject) -> Iterator[Tried]:
    """Laws from dry to the most complete one."""
    memory, group = base.law, Group("law", base)
    has_map = memory.name not in FORMULAS
    has_formula = has_map and not base.scene.has_points  # balls have none
    laws = [
        (LawChoice(law_label("hertz"), "hertz"), not has_map),
        (LawChoice(f"{law_label('hertz')}, usual damper", DAMPER), False),
        *([(LawChoice(law_label("formula"), "formula", films="memory"), False)] if has_formula else []),
        (dataclasses.replace(memory, label=f"{memory.label}, slow films", films="slow"), False),
        (dataclasses.replace(memory, label=f"{memory.label}, memory"), has_map),
    ]
    for law, default in laws:
        same = law.name == memory.name and law.films == memory.films
        subject = base if same else dataclasses.replace(base, law=law)
        yield Entry(group, law.label, subject, default=default)


def _supplies(base: Subject) -> Iterator[Tried]:
    """Oil supplies, by the reference law."""
    given, group = set(base.model().supplies.values()), Group("oil supply", base)
    for text in ("flooded", *SUPPLIES):
        supply = supply_from_text(text)
        same = given == {supply}
        subject = base if same else dataclasses.replace(base, law=dataclasses.replace(base.law, supply=supply))
        yield Entry(group, text, subject, default=same)


def linear_row(entry: Tried, found: LinearLook, beside: LinearReference) -> Choice:
    """Make the row of a linear analysis.

    Parameters
    ----------
    entry : Entry
        The choice.
    found : LinearLook
        What was found.
    beside : LinearReference
        The reference.
    """
    return differences_row(entry, found.seconds, beside, beside.beside(found))


def differences_row(entry: Tried, seconds: float, beside: LinearReference, parts: LinearDifferences) -> Choice:
    """Make a row from its errors at the modes, peaks and bearings of the reference.

    Parameters
    ----------
    entry : Entry
        The choice.
    seconds : float
        Processor time [s].
    beside : LinearReference
        The reference.
    parts : LinearDifferences
        The errors.
    """
    modes = [HERTZ.text(value) for value in beside.look.modes.frequency[beside.chosen]]
    peaks = [HERTZ.text(at) for _, at in beside.peaks]
    missing = tuple(
        f"no mode like that of {name}" for name, value in zip(modes, parts.frequency, strict=True) if np.isnan(value)
    )
    errors = {
        FREQUENCY: ErrorSummary.of(parts.frequency, modes),
        DAMPING: ErrorSummary.of(parts.damping, modes),
        HEIGHT: ErrorSummary.of(parts.height, peaks),
        LOAD: ErrorSummary.of(parts.load, list(beside.look.bearings)),
    }
    count = len(modes)
    return entry.choice("linear: ", seconds, errors, solved=count - len(missing), asked=count, lost=missing)

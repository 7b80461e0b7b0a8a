"""A model, and what is found at it, in words: headings, temperatures, clearances, weight, bands, films.

Commands, reports and figures say these things alike, by the functions here.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from ehdmaps.units import RPM, TEMPERATURE, written
from mbs.bearings.thermal import HeatPaths
from mbs.model.equilibrium import ROLLER
from mbs.model.on_rings import error_words
from mbs.model.relaxation import FILM_WORDS, NOTABLE
from mbs.output.state_text import class_lines, state_lines
from mbs.scene.assembly import Model
from mbs.scene.contact_laws import supply_words
from mbs.scene.fields import MICROMETRE
from mbs.scene.scene import Scene
from mbs.settings import ROUND_OFF

if TYPE_CHECKING:
    from mbs.linearised.validity import FilmError
    from mbs.model.system import System


def clearance_text(model: Model) -> str:
    """The diametral clearances of all bearings in words, such as ``20 um``; empty without bearings.

    Parameters
    ----------
    model : Model
        Those of a model in operation are its own, else those that the scene states.
    """
    if model.states:
        return span([1e6 * state.clearance.operating for state in model.states], MICROMETRE.unit)
    found = {entry.geometry.diametral_clearance for entry in model.scene.bearings}
    clearances = sorted(found | model.scene.located_clearances)
    words = " stated" if any(entry.changes_in_operation for entry in model.scene.bearings) else ""
    return ", ".join(MICROMETRE.text(value) for value in clearances) + words


def temperature_text(model: Model) -> str:
    """The temperatures of the raceways of all bearings in words, such as ``40 degC``.

    Parameters
    ----------
    model : Model
        Those of a model in operation are its own, else that of the scene.
    """
    if model.states:
        raceways = [TEMPERATURE.value(kelvin) for state in model.states for kelvin in (state.inner, state.outer)]
        return f"raceways at {span(raceways, TEMPERATURE.unit)}"
    words = " around the bearings" if any(entry.changes_in_operation for entry in model.scene.bearings) else ""
    return TEMPERATURE.text(model.scene.temperature) + words


def weight_text(model: Model) -> str:
    """Tell in words whether the weight of the bodies is in what an analysis finds.

    Parameters
    ----------
    model : Model
        Scene with its law.
    """
    return model.scene.weight


def span(values: Sequence[float], unit: str) -> str:
    """The range of some values, such as "20 to 30 um".

    Parameters
    ----------
    values : sequence of float
        The values, in the unit.
    unit : str
        Unit as it is written.
    """
    low, high = written(min(values)), written(max(values))
    return f"{low} {unit}" if low == high else f"{low} to {high} {unit}"


def common_supply(models: Iterable[Model]) -> str:
    """The oil supply of all models whose law has films, for titles; empty where they differ, and without films."""
    supplies = {supply_words(model.supplies) for model in models if model.supplies}
    return f"films {supplies.pop()}" if len(supplies) == 1 else ""


def heading(model: Model, speed: float | None = None) -> list[str]:
    """Tell what was analysed, and which of its numbers are assumptions."""
    from mbs.unknowns.held_open import held_open_of  # analyses take words from here, and no heading
    from mbs.unknowns.words import open_lines

    at = "" if speed is None else f"{RPM.text(speed)}, "
    state = f"{at}{temperature_text(model)}, clearance {clearance_text(model) or 'none'}, {weight_text(model)}"
    # Most of what was chosen is in these words and in those of the law.
    chosen = [f", {name} {text}" for name, text in model.chosen.items() if text not in state and text not in model.law]
    assumed = assumed_words(model.scene)
    return [
        f"{model.scene.title}: law {model.law}",
        f"  {state}{''.join(chosen)}{f'; assumed: {assumed}' if assumed else ''}",
        *class_lines(model.scene),
        *open_lines(held_open_of(model)),
        *_estimated(model),
        *(
            f"  the weight of {name} is left out: its finite elements are held themselves, so that it bears on no "
            "other body"
            for name in model.system.weightless
        ),
        *(
            f"  rollers of {entry.name} are bodies: linear analyses have its cage where it starts, no mean over angles"
            for entry in model.scene.bearings
            if entry.rollers_as_bodies
        ),
        *state_lines(model.states),
        *model.warnings,
    ]


def assumed_words(scene: Scene) -> str:
    """Words on what a scene marks as assumed; "nothing" only where nothing is held open, else empty."""
    if scene.assumed:
        return f"{len(scene.assumed)} keys of the scene, marked there"
    return "" if scene.has_bearings else "nothing"


def _estimated(model: Model) -> list[str]:
    """A line for each kind of bearing with suffixes, or with an estimated inner geometry, and for estimated gears."""
    kinds: dict[tuple[str, str], list[str]] = {}
    named = [(entry.name, entry.geometry) for entry in model.scene.bearings]
    named += [(entry.name, entry.geometry) for entry in model.scene.located]
    for bearing, geometry in named:
        spelled = geometry.spelled or ""
        for words in (spelled if "; " in spelled else "", geometry.estimated):
            if words:
                kinds.setdefault((geometry.name, words), []).append(bearing)
    lines = [f"  {name} ({', '.join(bearings)}): {words}" for (name, words), bearings in kinds.items()]
    return lines + [f"  {pair.estimate}" for pair in model.scene.gears if pair.estimate]


def band_lines(model: Model, film_share: float = 0.0, beside: bool = False) -> list[str]:
    """A line on what the numerics of a result hold; none without bearings.

    Parameters
    ----------
    model : Model
        The model.
    film_share : float
        Part of the bands that is what films with memory leave out; 0 if that is not in them.
    beside : bool
        Whether bands of what is not known stand beside them.
    """
    words = error_words(model.system, film_share)
    return [f"  {'numerics' if beside else 'bands (+-)'}: {words}"] if words else []


def film_law_line(model: Model, known: bool) -> list[str]:
    """A line on what films leave out of modes, and of their bands; none for laws without films, and at rest.

    Parameters
    ----------
    model : Model
        The model.
    known : bool
        Whether it is listed beside each mode.
    """
    if not model.scene.speed or not (model.supplies or known):
        return []
    if known:
        memory = "springs and dampers of films leave" if model.balls else "one relaxation time of a slice leaves"
        holds = "map or film table hold" if model.balls else "map holds"
        return [
            f"  film law: what {memory} out of the response of the film solver, which the {holds}: true less printed, "
            "to first order; its size is in the bands"
        ]
    if model.memory == "slow":
        return ["  film law: not known; films of slow motion leave out how films relax (--films memory has it)"]
    return ["  film law: not known; the law holds no response of the film solver"]


LITTLE_DAMPING = 0.01
"""Damping ratio below which parts of a machine that no scene has are likely to add as much, and more."""

OTHER_DAMPING = (
    "damping is that of films, and of what the scene states; joints, seats, seals and material of a machine add to it, "
    "so that ratios below 1 % are lower limits"
)
"""Said where a damping ratio is printed that is below `LITTLE_DAMPING`."""


def clean(value: float) -> float:
    """The value, or 0 where it is round-off: of parts and ratios.

    Parameters
    ----------
    value : float
        A damping ratio, or a relative change.
    """
    return float(value) if abs(value) > ROUND_OFF else 0.0


def free_words(count: int, system: System) -> str:
    """Words for free motions, which have no frequency and no damping ratio.

    Parameters
    ----------
    count : int
        How many there are.
    system : System
        System with the motions; one with rollers as bodies may have unloaded ones.
    """
    what = "1 free motion" if count == 1 else f"{count} free motions"
    rollers = ", such as unloaded rollers" if any(ROLLER in name for name in system.coordinates) else ""
    return f"{what} at 0 Hz without strain energy{rollers}"


def film_lines(errors: Sequence[FilmError], frequencies: Iterable[float], words: str = "") -> list[str]:
    """Lines on the estimated error of the films of each bearing at the highest frequency; none where there is none.

    Parameters
    ----------
    errors : sequence of FilmError
        Errors of the bearings.
    frequencies : iterable of float
        Frequencies of the result [Hz].
    words : str
        What follows the frequency, such as a speed.
    """
    highest = max(frequencies, default=0.0)
    lines = []
    for entry in errors:
        if entry.at_rest:
            lines.append(
                f"warning: {entry.bearing}: at rest no film: the stiffness is that of dry contacts, no damping"
            )
        elif highest > 0.0:
            lines.append(_film_line(entry, highest, words))
    return lines


def _film_line(entry: FilmError, frequency: float, words: str) -> str:
    """A line on one bearing; a warning where the error is notable."""
    error = entry.at(frequency)
    line = (
        f"{entry.bearing}: {FILM_WORDS[entry.films]}; estimated error of the dynamic stiffness along the load at "
        f"{frequency:.5g} Hz{words}: {100.0 * error:.2g} %"
        + (f", by the response that the {entry.held_by} holds" if entry.held_by else "")
    )
    if error <= NOTABLE:
        return line
    more = f"warning: {line}, from {entry.frequency:.4g} Hz on more than {100.0 * NOTABLE:g} %"
    hint = entry.films == "slow"
    return more + ("; with --films memory films follow at their own frequency" if hint else "")


def held_lines(model: Model) -> list[str]:
    """A line on the temperatures of a run in time, where they follow from heat.

    Parameters
    ----------
    model : Model
        The model of the run.
    """
    if not any(isinstance(bearing.thermal, HeatPaths) for bearing in model.scene.bearings):
        return []
    return [f"  temperatures and clearances are held at those of {RPM.text(model.scene.speed)}, of [operation]"]

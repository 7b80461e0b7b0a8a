"""What an analysis compares: models with their labels."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.units import TEMPERATURE
from mbs.analyses.varied import Subject
from mbs.scene.assembly import Model
from mbs.scene.contact_laws import supply_words
from mbs.scene.fields import MICROMETRE


@dataclass(frozen=True, eq=False)
class Case:
    """One of the models that are compared.

    Attributes
    ----------
    label : str
        Difference from the other cases; the law if there is none.
    model : Model
        Scene with its law, clearance and loads.
    clearance : float
        Diametral clearance [m]; NaN if the bearings have not all the same.
    load_factor : float
        Factor of all loads of the scene.
    start_angle : float or None
        Angle at which all cages start instead of the scene's angles [rad].
    subject : Subject or None
        What the model was made from, where that is known.
    """

    label: str
    model: Model
    clearance: float
    load_factor: float = 1.0
    start_angle: float | None = None
    subject: Subject | None = None


def clearance_text(model: Model) -> str:
    """The diametral clearances of all bearings in words, such as ``20 um``; empty without bearings.

    Parameters
    ----------
    model : Model
        Those of a model in operation are its own, else those that the scene states.
    """
    if model.states:
        return span([1e6 * state.clearance.operating for state in model.states], MICROMETRE.unit)
    clearances = sorted({entry.geometry.diametral_clearance for entry in model.scene.bearings})
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
    """Whether the weight of the bodies is in what an analysis finds, in words.

    Parameters
    ----------
    model : Model
        Scene with its law.
    """
    along = np.array(model.scene.gravity)
    if not along.any():
        return "without weight (no gravity in [operation])"
    axes = [f"{'-' if value < 0.0 else ''}{name}" for name, value in zip("xyz", along, strict=True) if value]
    words = f"along {axes[0]}" if len(axes) == 1 else f"in {', '.join(axes)}"
    return f"with weight ({np.linalg.norm(along):.4g} m/s2 {words})"


def span(values: Sequence[float], unit: str) -> str:
    """The range of some values, such as "20 to 30 um".

    Parameters
    ----------
    values : sequence of float
        The values, in the unit.
    unit : str
        Unit as it is written.
    """
    low, high = f"{min(values):.4g}", f"{max(values):.4g}"
    return f"{low} {unit}" if low == high else f"{low} to {high} {unit}"


def common_supply(models: Iterable[Model]) -> str:
    """The oil supply of all models whose law has films, for titles; empty where they differ, and without films."""
    found = {supply_words(model.supplies) for model in models if model.supplies}
    return f"films {found.pop()}" if len(found) == 1 else ""


def common_clearance(model: Model) -> float:
    """Diametral clearance of all bearings [m]; NaN if they have not all the same."""
    found = {entry.geometry.diametral_clearance for entry in model.scene.bearings}
    return found.pop() if len(found) == 1 else math.nan


def as_cases(models: Model | Case | Sequence[Model | Case]) -> tuple[Case, ...]:
    """One or more models as cases; a model is called by its law.

    Parameters
    ----------
    models : Model, Case, or a sequence of them
        Models, at least one. Those of one law that differ in something else have to be cases, each with a label.

    Raises
    ------
    InputError
        If there is none, or two of the same law are given without labels.
    """
    given = [models] if isinstance(models, (Model, Case)) else list(models)
    cases = tuple(
        entry if isinstance(entry, Case) else Case(entry.label, entry, common_clearance(entry)) for entry in given
    )
    labels = [case.label for case in cases]
    # Who gives cases has chosen their labels.
    chosen = bool(given) and all(isinstance(entry, Case) for entry in given)
    if not chosen and len(set(labels)) < max(len(labels), 1):
        raise InputError(
            f"models: got {len(labels)} with the labels {', '.join(labels) or 'none'}; allowed: at least one, and each "
            "label once; give a Case with a label of its own for each model"
        )
    return cases

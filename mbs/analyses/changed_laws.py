"""Models whose contact laws are wrong by the errors that their map states, for samples of nonlinear runs.

What a linear analysis takes from each slice at its own load is here one change of a whole law: the bounds of the slices
at rest, in the mean with their stiffness (of damping: with their damping) as weight, the largest one of some speeds.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.law import ContactLaw
from ehdmaps.maps.law_change import LawChange
from mbs.analyses.operating import operating
from mbs.bearings.bearing_element import BearingElement, RingElement, RollerElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.roller_contacts import RollerContacts
from mbs.linearised.steady import steady_system
from mbs.model.elements import Element, Operation
from mbs.model.equilibrium import equilibrium
from mbs.scene.assembly import Model

SIGNS = (
    (1.0, 1.0, 1.0),
    (-1.0, -1.0, -1.0),
    (1.0, -1.0, 1.0),
    (-1.0, 1.0, -1.0),
    (1.0, 1.0, -1.0),
    (-1.0, -1.0, 1.0),
    (1.0, -1.0, -1.0),
    (-1.0, 1.0, 1.0),
)
"""Signs of the changes of stiffness, damping and film of each sample: all corners, each beside the opposite one."""

Changes = dict[str, tuple[LawChange, ...]]
"""By the names of the bearings: a change for each law of a bearing, that of massless rollers, or both of rollers."""


def law_changes(model: Model, speeds: Sequence[float]) -> Changes | None:
    """By how much the laws of each bearing may be wrong; None where a law states no errors.

    Parameters
    ----------
    model : Model
        Scene with its law.
    speeds : sequence of float
        Speeds of the system [rad/s]; that of standstill is passed over, as there are no films.

    Raises
    ------
    AnalysisError
        If there is no equilibrium at a speed.
    """
    found: dict[str, list[list[LawChange]]] = {}
    for speed in speeds:
        if speed == 0.0:
            continue
        operation = Operation(speed)
        balance = equilibrium(steady_system(operating(model, speed).system), operation)
        for index in balance.system.select(RingElement):
            connected = balance.system.elements[index]
            assert isinstance(connected.element, RingElement)
            groups = connected.element.contact_groups(connected.transform @ balance.displacement, operation)
            changes = []
            for group in groups:
                load, stiffness, damping, _ = group.state()
                bounds = group.law.bounds(load)
                if bounds is None:
                    return None
                changes.append(
                    LawChange(
                        _mean(bounds.stiffness, stiffness),
                        _mean(bounds.damping, damping),
                        _mean(bounds.film_offset, stiffness),
                    )
                )
            if not changes:
                return None
            found.setdefault(connected.element.name, []).append(changes)
    if not found:
        return None
    return {
        name: tuple(LawChange(*np.max(of_law, axis=0).tolist()) for of_law in zip(*at_speeds, strict=True))
        for name, at_speeds in found.items()
    }


def _mean(values: FloatArray, weights: FloatArray) -> float:
    """Mean with weights; that of all where nothing has any."""
    total = float(weights.sum())
    return float(values @ weights / total) if total > 0.0 else float(values.mean())


def with_changed_laws(model: Model, changes: Changes, signs: tuple[float, float, float]) -> Model:
    """The model with laws that are wrong on purpose.

    Parameters
    ----------
    model : Model
        Scene with its law, for a run in time.
    changes : Changes
        What `law_changes` finds.
    signs : tuple of float
        Factors of the changes of stiffness, damping and film, such as one of `SIGNS`.
    """
    made: dict[tuple[int, LawChange], ContactLaw] = {}

    def changed(law: object, change: LawChange) -> ContactLaw:
        assert isinstance(law, ContactLaw)  # others state no errors
        key = id(law), change
        if key not in made:
            made[key] = law.changed(change)
        return made[key]

    elements: list[Element] = [connected.element for connected in model.system.elements]
    bearings = list(model.bearings)
    for index, bearing in enumerate(bearings):
        own, element = [change.times(signs) for change in changes[bearing.name]], elements[index]
        if isinstance(element, RollerElement):
            laws = [changed(law, change) for law, change in zip(element.contacts.laws, own, strict=True)]
            contacts = RollerContacts(element.contacts.bearing, *laws)
            elements[index] = dataclasses.replace(element, contacts=contacts)
            continue
        assert isinstance(element, BearingElement) and isinstance(element.force, BearingForce)
        force = BearingForce(element.force.bearing, changed(element.force.law, own[0]))
        elements[index] = bearings[index] = dataclasses.replace(element, force=force)
    return dataclasses.replace(model, system=model.system.with_elements(elements), bearings=tuple(bearings))

"""Combinations of choices: a scene with each law, and with each value of what else was chosen."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ehdmaps.choices import SUPPLY
from ehdmaps.errors import InputError
from mbs.scene.choices import CHOICES, LACKS, LAWS, LOCATED_LACK, SceneChoice, Subject


@dataclass(frozen=True, eq=False)
class Combination:
    """A subject that was chosen, among others.

    Attributes
    ----------
    subject : Subject
        Scene and law; the label of the law tells it from the other laws.
    words : tuple of str
        What tells it from others of the same law.
    values : mapping of str to object
        What was chosen of the scene, by the names of the choices.
    """

    subject: Subject
    words: tuple[str, ...] = ()
    values: Mapping[str, Any] = field(default_factory=dict)


def combinations(
    subjects: Sequence[Subject], values: Mapping[str, Sequence[Any]], problems: list[str]
) -> list[Combination]:
    """Combine subjects with all values that were chosen; a law that a choice does not concern stands once.

    Parameters
    ----------
    subjects : sequence of Subject
        Scene with each of the laws.
    values : mapping of str to sequence
        Values of the other choices, by their names; left out: nothing was chosen.
    problems : list of str
        What is wrong is appended.
    """
    found = [Combination(subject if subjects[1:] else _with_label(subject)) for subject in subjects]
    for choice in CHOICES.values():
        several = values.get(choice.name, ()) if choice.name not in LAWS else ()
        if choice.name == SUPPLY.name and not several:
            found = [dataclasses.replace(one, subject=_with_stated_supply(one.subject)) for one in found]
        if not several:
            continue
        if choice.concerned in LACKS and not any(choice.concerns(one.subject) for one in found):
            got, scene = ", ".join(map(choice.text, several)), found[0].subject.scene
            of_others = not scene.bearings and scene.located and choice.concerned not in ("relaxing", "heat")
            lacks = LOCATED_LACK if of_others else LACKS[choice.concerned]
            problems.append(f"--{choice.name}: got {got} {lacks}")
            continue
        found = [entry for one in found for entry in _each(one, choice, several, problems)]
    return found


def _with_label(subject: Subject) -> Subject:
    """A subject whose law is not called dry where the scene has no roller bearing; several laws keep their names."""
    from mbs.scene.contact_laws import NO_LAW

    if subject.scene.has_bearings or subject.law.has_films:
        return subject
    return dataclasses.replace(subject, law=dataclasses.replace(subject.law, label=NO_LAW))


def _each(one: Combination, choice: SceneChoice, several: Sequence[Any], problems: list[str]) -> list[Combination]:
    """A combination with each value of a choice."""
    if len(several) > 1 and not choice.concerns(one.subject):
        return [one]
    found = []
    for value in several:
        try:
            subject = choice.chosen(one.subject, value)
        except InputError as error:
            problems += [f"--{choice.name}: {problem}" for problem in error.problems]
            continue
        words = choice.words(value)
        if subject.law is one.subject.law:
            told = (words,) if len(several) > 1 else ()
            found.append(Combination(subject, (*one.words, *told), {**one.values, choice.name: value}))
            continue
        if words and subject.law.may_relax and (len(several) > 1 or not choice.usual(value)):
            law = dataclasses.replace(subject.law, label=f"{subject.law.label}, {words}")
            subject = dataclasses.replace(subject, law=law)
        found.append(Combination(subject, one.words, one.values))
    return found


def _with_stated_supply(subject: Subject) -> Subject:
    """A subject whose law is called by the oil supply that scene or map state."""
    from mbs.scene.contact_laws import ContactLaws, law_in_force

    law = subject.law
    words = ContactLaws(law_in_force(law.name, law.maps, subject.scene)[0], subject.scene, law.maps).supply_label
    return dataclasses.replace(subject, law=dataclasses.replace(law, label=law.label + words)) if words else subject

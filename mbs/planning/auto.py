"""An analysis that chooses its physics: films of the film table, with what the scene requires of memory and heat."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from mbs.planning.physics import AutoSettings, Verdict, switched, verdicts
from mbs.scene.assembly import Model
from mbs.scene.choices import CHOICES
from mbs.scene.scene import Scene
from mbs.scene.subject import Subject, named_law

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

"""`--tolerance` of `campbell` and `runup`: a level whose step, slices and cut-off are chosen by short trials."""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Sequence

from ehdmaps.errors import InputError
from mbs.analyses.case import Case
from mbs.commands.common import Told
from mbs.instruments.kept_choice import kept_within
from mbs.instruments.tolerance import Tolerated, read_tolerance
from mbs.settings import CampbellSettings


def asked_tolerance(arguments: argparse.Namespace, problems: list[str]) -> float | None:
    """Read the level of --tolerance [dB]; None where there is none.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    problems : list of str
        Appended to.
    """
    text = getattr(arguments, "tolerance", None)
    if text is None:
        return None
    try:
        return read_tolerance(text)
    except InputError as error:
        problems.append(f"--tolerance: {error.problems[0]}")
    return None


def several_problems(tolerance: float | None, cases: Sequence[Case]) -> list[str]:
    """List problems with a tolerance of several cases.

    Parameters
    ----------
    tolerance : float or None
        The tolerance [dB].
    cases : sequence of Case
        The cases.
    """
    if tolerance is None or len(cases) == 1:
        return []
    return [
        f"--tolerance: got {len(cases)} combinations of laws, films and the like; allowed: one, for which step, "
        "slices and cut-off are chosen"
    ]


def tolerated_case(
    cases: Sequence[Case], tolerance: float | None, settings: CampbellSettings | None = None
) -> tuple[list[Case], Tolerated | None]:
    """Cases with the settings that are chosen for a tolerance, or were chosen before; as they came without one.

    Parameters
    ----------
    cases : sequence of Case
        The cases; one alone beside a tolerance.
    tolerance : float or None
        The tolerance [dB].
    settings : CampbellSettings, optional
        What is looked at; [campbell] of the scene if left out. Then the states of the run are recorded as seldom as
        the scene says, to a whole step.

    Raises
    ------
    InputError, AnalysisError
        As `mbs.instruments.tolerance.within` does.
    """
    if tolerance is None or cases[0].subject is None:
        return list(cases), None
    subject = cases[0].subject
    tolerated = kept_within(subject, tolerance, settings, Told("trial"))
    changed = tolerated.subject
    given, course = subject.scene.run_up, changed.scene.run_up
    if settings is None and given is not None and course is not None:
        step = course.settings.step
        sample = step * max(round(given.settings.sample / step), 1)
        course = dataclasses.replace(course, settings=dataclasses.replace(course.settings, sample=sample))
        changed = dataclasses.replace(changed, scene=dataclasses.replace(changed.scene, run_up=course))
    return [dataclasses.replace(cases[0], model=changed.model(), subject=changed)], tolerated

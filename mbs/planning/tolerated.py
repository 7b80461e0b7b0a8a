"""`--tolerance` of `campbell` and `runup`: a level for which step and slices are chosen by short trials."""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Callable, Sequence

from ehdmaps.errors import InputError
from mbs.analyses.case import Case, Progress
from mbs.analyses.step_error import StepCheck
from mbs.planning.tolerance import Found, Tolerated, read_tolerance, within
from mbs.scene.choices import Subject
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
        f"--tolerance: got {len(cases)} combinations of laws, films and the like; allowed: one, for which step "
        "and slices are chosen"
    ]


def tolerated_run(
    cases: Sequence[Case],
    tolerance: float | None,
    run: Callable[[list[Case]], tuple[Found, StepCheck | None]],
    settings: CampbellSettings | None = None,
    progress: Progress | None = None,
) -> tuple[Found, Tolerated | None]:
    """Make a run, with the settings that are chosen for a tolerance; as cases came without one.

    Parameters
    ----------
    cases : sequence of Case
        The cases; one alone beside a tolerance.
    tolerance : float or None
        The tolerance [dB].
    run : callable
        Runs cases; the result, and the errors of its step.
    settings : CampbellSettings, optional
        What is looked at; if left out the sensor of [campbell] and all frequencies. Then the states of the run are
        recorded as seldom as the scene says, to a whole step.
    progress : callable, optional
        Told how many trials are done, and of how many at most.

    Raises
    ------
    InputError, AnalysisError
        As `mbs.planning.tolerance.within` does.
    """
    subject = cases[0].subject
    if tolerance is None or subject is None:
        return run(list(cases))[0], None
    given = subject.scene.run_up
    seldom = settings is None
    if settings is None:
        # What twice the step has samples for.
        highest = 0.25 / given.settings.step if given is not None else subject.scene.campbell.highest
        settings = dataclasses.replace(subject.scene.campbell, highest=highest)

    def made(changed: Subject) -> tuple[Found, StepCheck | None]:
        course = changed.scene.run_up
        if seldom and given is not None and course is not None:
            step = course.settings.step
            sample = step * max(round(given.settings.sample / step), 1)
            course = dataclasses.replace(course, settings=dataclasses.replace(course.settings, sample=sample))
            changed = dataclasses.replace(changed, scene=dataclasses.replace(changed.scene, run_up=course))
        return run([dataclasses.replace(cases[0], model=changed.model(), subject=changed)])

    tolerated, found = within(subject, tolerance, made, settings, progress)
    return found, tolerated

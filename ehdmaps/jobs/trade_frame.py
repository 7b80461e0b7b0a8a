"""What a reader of a measurement of contacts must know besides: sample, scales, references and where they fail."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.jobs.answers import COMPLIANCE_SHARE, DAMPING_SHARE, Answer, Question, scales
from ehdmaps.jobs.contact_ways import ContactModel
from ehdmaps.jobs.contestants import OPENFOAM_REFINEMENT, RULE_REFINEMENT, Group
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.sampling import VALLEY_SHARE
from ehdmaps.units import LOAD, SPEED, TEMPERATURE

NATURAL_FREQUENCIES = (0.1, 10.0)
"""Range of omega sqrt(b^2 + 2 h R)/u from which the frequency of a point is drawn."""

_STATED = ("stiffness", "damping", "film offset")


@dataclass(frozen=True)
class Asked:
    """What a model answered.

    Attributes
    ----------
    answers : tuple of Answer
        One a question.
    seconds : float
        Processor time of a question [s].
    """

    answers: tuple[Answer, ...]
    seconds: float


@dataclass(frozen=True)
class Truth:
    """The reference of a group, and what it answered.

    Attributes
    ----------
    group : Group
        The group.
    asked : Asked
        Answers at all points.
    """

    group: Group
    asked: Asked


def reference_words(truths: Sequence[Truth]) -> str:
    """Name the reference of the groups that have none of their own, with its cost.

    Parameters
    ----------
    truths : sequence of Truth
        References of all groups.
    """
    own = {truth.group.truth: truth for truth in truths if not truth.group.reference}
    return "; ".join(f"{_solver(model)} ({own[model].asked.seconds:.2g} s a point)" for model in own) or "as told there"


def _solver(model: ContactModel) -> str:
    """The solver of a model, with its grid."""
    solver = getattr(model, "solver", None)
    settings = {} if solver is None else solver.settings()
    told = [f"{key.replace('_', ' ')} {settings[key]:g}" for key in ("density", "inlet_length") if key in settings]
    return ", ".join([getattr(solver, "name", type(model).__name__), *told])


def sample_words(job: Job, count: int, seed: int) -> tuple[str, ...]:
    """Say what the sample is, and what errors are relative to.

    Parameters
    ----------
    job : Job
        Job over whose range points were drawn.
    count, seed : int
        Number of the points, and their seed.
    """
    speeds = [speed for speed in job.entrainment_speeds if speed > 0.0]
    axes = ((job.loads, LOAD), (speeds, SPEED), (job.temperatures, TEMPERATURE))
    ranges = ", ".join(f"{display.text(min(values))} to {display.text(max(values))}" for values, display in axes)
    low, high = NATURAL_FREQUENCIES
    return (
        f"{count} random points, seed {seed}: {ranges}; {VALLEY_SHARE:.0%} of them in the damping valley, where the "
        "job reaches it",
        "each point is solved on its own; processor time, without compilation",
        f"errors of damping are relative to {DAMPING_SHARE:g} k b/u at least, of film compliance to "
        f"{COMPLIANCE_SHARE:g}/k at least, of the approach to dry approach and film offset together",
        f"frequencies: omega sqrt(b^2 + 2 h R)/u of {low:g} to {high:g}",
        "finest solution of a model: of reynolds the reference, of rules and poles that on films of "
        f"{RULE_REFINEMENT:g} times the density, of openfoam that of {OPENFOAM_REFINEMENT:g} times the cells each way",
    )


def openfoam_words(count: int, missing: Sequence[str]) -> tuple[str, ...]:
    """Say why OpenFOAM takes no part, or at how few points it is asked.

    Parameters
    ----------
    count : int
        Points that were asked for.
    missing : sequence of str
        What this machine lacks, one sentence each.
    """
    if count <= 0:
        return ("openfoam: left out, as asked",)
    if missing:
        return tuple(f"openfoam: left out; {problem}" for problem in missing)
    return (f"openfoam: at the first {count} of the points, since each takes seconds",)


def truth_words(truths: Sequence[Truth], questions: Sequence[Question]) -> tuple[str, ...]:
    """Say what the references state of themselves, and name every point at which one of them has no solution.

    Parameters
    ----------
    truths : sequence of Truth
        References of all groups.
    questions : sequence of Question
        What they were asked.
    """
    lines = []
    groups: dict[ContactModel, list[Truth]] = {}
    for truth in truths:
        groups.setdefault(truth.group.truth, []).append(truth)
    for alike in groups.values():
        name = f"reference of {', '.join(truth.group.name for truth in alike)}"
        pairs = list(zip(questions, alike[0].asked.answers, strict=True))
        stated = _stated(pairs)
        if stated:
            lines.append(f"{name}: states errors of {stated} (medians)")
        below = sum(answer.values.get("damping", math.inf) <= 0.0 for _, answer in pairs)
        if below:
            lines.append(
                f"{name}: damping is not above zero at {below} of {len(pairs)} points; compared as solved, contact "
                "laws take zero there"
            )
        lost = [f"  {question.place}: {answer.lost}" for question, answer in pairs if answer.lost]
        if lost:
            lines += [
                f"{name}: without a solution at {len(lost)} of {len(pairs)} points; nothing compared there",
                *lost,
            ]
    return tuple(lines)


def _stated(pairs: Sequence[tuple[Question, Answer]]) -> str:
    """Medians of the errors that a reference states."""
    words = []
    for name in _STATED:
        errors = [
            answer.stated[name] / scales(answer, question)[name] for question, answer in pairs if name in answer.stated
        ]
        if errors:
            words.append(f"{name} {float(np.median(errors)):.1e}")
    return ", ".join(words)

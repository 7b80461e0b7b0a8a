"""Speed against accuracy of contacts: solvers, settings and physics at random points, against a fine solve."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ehdmaps.jobs import solvers
from ehdmaps.jobs.budget.contact_ways import COMPLIANCE_SHARE, DAMPING_SHARE, Answer, ContactModel, Question, scales
from ehdmaps.jobs.budget.entries import TABLE, ContactEntry, sources
from ehdmaps.jobs.budget.measured import (
    JUDGED,
    NATURAL_FREQUENCIES,
    SHOWN,
    Asked,
    Measured,
    Told,
    drawn,
    measured,
    sample_words,
)
from ehdmaps.jobs.job import Job
from ehdmaps.trade.record import Group, Scope, Trade
from mbs.laboratory.tradeoff.contestants import OPENFOAM_REFINEMENT, RULE_REFINEMENT, contestants

_SOLVING = ("closed forms", TABLE, "reynolds")
"""Groups whose choices answer one question: the flooded, smooth film in slow motion. The few points of openfoam say
nothing of 95 %."""

POINTS, OPENFOAM_POINTS, SEED = 60, 3, 1
"""Size of the sample, points of it that are asked of the slow solvers, and seed, where nothing is said."""


def measure(
    job: Job,
    points: int = POINTS,
    seed: int = SEED,
    openfoam: int = OPENFOAM_POINTS,
    entries: Sequence[ContactEntry] | None = None,
    tell: Told = lambda line: None,
) -> Trade:
    """Measure solvers, settings and physics at random points of a job.

    Parameters
    ----------
    job : Job
        Job over whose range points are drawn.
    points : int
        How many.
    seed : int
        Seed of the points.
    openfoam : int
        How many of them are asked of what takes seconds a point; 0 leaves it out.
    entries : sequence of Entry, optional
        Who is measured; all of `mbs.laboratory.tradeoff.contestants.contestants` if left out.
    tell : callable
        Is told what is being measured.

    Raises
    ------
    InputError
        If the job has no speed above zero.
    """
    questions = drawn(job, points, seed)
    missing = solvers.SOLVERS["openfoam"].missing()
    chosen = tuple(contestants(job, openfoam > 0 and not missing) if entries is None else entries)
    found = measured(chosen, questions, openfoam, tell)
    low, high = NATURAL_FREQUENCIES
    return Trade(
        level="contact",
        title=f"{job.title}, {job.lubricant.title}: contacts by solvers, settings and physics",
        cost="s a point",
        reference=_reference_words(found),
        judged=JUDGED,
        choices=found.choices,
        frame=(
            sample_words(job, len(questions), seed),
            "each point is solved on its own; processor time, without compilation",
            f"errors of damping are relative to {DAMPING_SHARE:g} k b/u at least, of film compliance to "
            f"{COMPLIANCE_SHARE:g}/k at least, of the approach to dry approach and film offset together",
            f"frequencies: omega sqrt(b^2 + 2 h R)/u of {low:g} to {high:g}",
            "finest solution of a model: of reynolds the reference, of rules and poles that on films of "
            f"{RULE_REFINEMENT:g} times the density, of openfoam that of {OPENFOAM_REFINEMENT:g} times the cells each "
            "way",
            *(_openfoam_words(openfoam, missing) if entries is None else ()),
            *_truth_words(found, questions),
            *found.gaps,
        ),
        scopes=(Scope("a contact in slow motion", (_SOLVING,), SHOWN),),
        sources=sources(chosen),
        shown=SHOWN,
    )


def _reference_words(found: Measured) -> str:
    """Name the reference of the groups that have none of their own, with its cost."""
    own = {group.truth: asked for group, asked in found.truths if not group.reference}
    words = (f"{_solver(model)} ({asked.seconds:.2g} s a point)" for model, asked in own.items())
    return "; ".join(words) or "as stated there"


def _solver(model: ContactModel) -> str:
    """The solver of a model, with its grid."""
    solver = getattr(model, "solver", None)
    settings = {} if solver is None else solver.settings()
    grid = [f"{key.replace('_', ' ')} {settings[key]:g}" for key in ("density", "inlet_length") if key in settings]
    return ", ".join([getattr(solver, "name", type(model).__name__), *grid])


def _openfoam_words(count: int, missing: Sequence[str]) -> tuple[str, ...]:
    """Say why OpenFOAM takes no part, or at how few points it is asked."""
    if count <= 0:
        return ("openfoam: left out, as asked",)
    if missing:
        return tuple(f"openfoam: left out; {problem}" for problem in missing)
    return (f"openfoam: at the first {count} of the points, since each takes seconds",)


def _truth_words(found: Measured, questions: Sequence[Question]) -> tuple[str, ...]:
    """Say what the references state of themselves, and name every point at which one of them has no solution."""
    lines = []
    alike: dict[ContactModel, list[tuple[Group[ContactModel], Asked]]] = {}
    for group, asked in found.truths:
        alike.setdefault(group.truth, []).append((group, asked))
    for groups in alike.values():
        name = f"reference of {', '.join(group.name for group, _ in groups)}"
        pairs = list(zip(questions, groups[0][1].answers, strict=True))
        stated = _stated(pairs)
        if stated:
            lines.append(f"{name}: states errors of {stated} (medians)")
        below = sum(answer.values.get("damping", math.inf) <= 0.0 for _, answer in pairs)
        if below:
            lines.append(
                f"{name}: damping is not above zero at {below} of {len(pairs)} points; compared as solved, contact "
                "laws take zero there"
            )
        unanswered = [f"  {question.place}: {answer.lost}" for question, answer in pairs if answer.lost]
        if unanswered:
            lines += [
                f"{name}: without a solution at {len(unanswered)} of {len(pairs)} points; nothing compared there",
                *unanswered,
            ]
    return tuple(lines)


def _stated(pairs: Sequence[tuple[Question, Answer]]) -> str:
    """Medians of the errors that a reference states."""
    words = []
    for name in SHOWN:
        errors = [
            answer.stated[name] / scales(answer, question)[name] for question, answer in pairs if name in answer.stated
        ]
        if errors:
            words.append(f"{name} {float(np.median(errors)):.1e}")
    return ", ".join(words)

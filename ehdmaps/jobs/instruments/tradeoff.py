"""Speed against accuracy of contacts, measured: solvers, settings, physics at random points, against a fine solve.

Numerical error is what a choice differs by from the finest affordable solution of its own model; error of the model is
what that one differs by from the reference. Both are relative to the reference, see `answers`, so
that at each point they add up to the error.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiling import cpu_seconds
from ehdmaps.errors import InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.instruments.answers import COMPLIANCE_SHARE, DAMPING_SHARE, QUANTITIES, Answer, Question, scales
from ehdmaps.jobs.instruments.contact_ways import ContactModel
from ehdmaps.jobs.instruments.contestants import (
    OPENFOAM_REFINEMENT,
    RULE_REFINEMENT,
    TABLE,
    Entry,
    Group,
    contestants,
    sources,
)
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.sampling import VALLEY_SHARE, SamplePoint, draw_sample, log_uniform
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.solution import natural_to_hertz
from ehdmaps.physics.spectrum import HIGHEST_FREQUENCY, LOWEST_FREQUENCY
from ehdmaps.trade.record import Choice, ErrorSummary, Judged, Scope, Trade
from ehdmaps.units import LOAD, SPEED, TEMPERATURE

NATURAL_FREQUENCIES = (0.1, 10.0)
"""Range of omega sqrt(b^2 + 2 h R)/u from which the frequency of a point is drawn."""

_STATED = _SHOWN = ("stiffness", "damping", "film offset")

_SOLVING = ("closed forms", TABLE, "reynolds")
"""Groups whose choices answer one question: the flooded, smooth film in slow motion. The few points of openfoam say
nothing of 95 %."""


@dataclass(frozen=True)
class Asked:
    """Answers of a model.

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
    return (
        "; ".join(f"{_solver(model)} ({own[model].asked.seconds:.2g} s a point)" for model in own) or "as stated there"
    )


def _solver(model: ContactModel) -> str:
    """The solver of a model, with its grid."""
    solver = getattr(model, "solver", None)
    settings = {} if solver is None else solver.settings()
    grid = [f"{key.replace('_', ' ')} {settings[key]:g}" for key in ("density", "inlet_length") if key in settings]
    return ", ".join([getattr(solver, "name", type(model).__name__), *grid])


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
    for name in _STATED:
        errors = [
            answer.stated[name] / scales(answer, question)[name] for question, answer in pairs if name in answer.stated
        ]
        if errors:
            words.append(f"{name} {float(np.median(errors)):.1e}")
    return ", ".join(words)


POINTS, OPENFOAM_POINTS, SEED = 60, 3, 1
"""Size of the sample, points of it that are asked of the slow solvers, and seed, where nothing is said."""

Told = Callable[[str], None]
"""Takes a line of progress."""


def measure(
    job: Job,
    points: int = POINTS,
    seed: int = SEED,
    openfoam: int = OPENFOAM_POINTS,
    entries: Sequence[Entry] | None = None,
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
        Who is measured; all of `ehdmaps.jobs.instruments.contestants.contestants` if left out.
    tell : callable
        Is told what is being measured.

    Raises
    ------
    InputError
        If the job has no speed above zero.
    """
    questions = _questions(job, points, seed)
    missing = solvers.SOLVERS["openfoam"].missing()
    with_openfoam = openfoam > 0 and not missing
    chosen = tuple(contestants(job, with_openfoam) if entries is None else entries)
    few = questions[: min(openfoam, len(questions))]
    known: dict[tuple[ContactModel, int], Asked] = {}

    def asked(model: ContactModel, at: Sequence[Question], words: str) -> Asked:
        if (model, len(at)) not in known:
            tell(f"{words}: {len(at)} points")
            known[model, len(at)] = _ask(model, at)
        return known[model, len(at)]

    choices, groups = [], dict.fromkeys(entry.group for entry in chosen)
    truths, gaps = {group.truth for group in groups}, list[str]()
    for entry in chosen:
        at = few if entry.few else questions
        # the truth is asked at all points once, the few are the first of them
        truth = asked(entry.group.truth, questions, f"reference of {entry.group.name}").answers[: len(at)]
        own = asked(entry.model, at, entry.label)
        finest = None
        if entry.finest == entry.group.truth:
            finest = truth
        elif entry.finest is not None:
            longer = (entry.finest, len(questions)) in known
            finest = asked(entry.finest, questions if longer else at, f"finest of {entry.label}").answers[: len(at)]
            if entry.finest not in truths:  # whose gaps are told besides
                gaps += [
                    f"no numerical error told apart: finest of {entry.label} at {question.place}: {answer.lost}"
                    for question, answer in zip(at, finest, strict=True)
                    if answer.lost
                ]
        choices.append(_choice(entry, at, own, truth, finest))
    references = [Truth(group, known[group.truth, len(questions)]) for group in groups]
    return Trade(
        level="contact",
        title=f"{job.title}, {job.lubricant.title}: contacts by solvers, settings and physics",
        cost="s a point",
        reference=reference_words(references),
        judged=tuple(Judged(name) for name in QUANTITIES),
        choices=tuple(choices),
        frame=(
            *sample_words(job, len(questions), seed),
            *(openfoam_words(openfoam, missing) if entries is None else ()),
            *truth_words(references, questions),
            *dict.fromkeys(gaps),  # several choices may have one finest solution
        ),
        scopes=(Scope("a contact in slow motion", (_SOLVING,), _SHOWN),),
        sources=sources(chosen),
        shown=_SHOWN,
    )


def _questions(job: Job, points: int, seed: int) -> tuple[Question, ...]:
    """Random points of a job, with a frequency each."""
    if not any(speed > 0.0 for speed in job.entrainment_speeds):
        raise InputError(
            f"tradeoff, entrainment_speed of {job.name}: got 0 m/s only; allowed: a job with a speed above zero, since "
            "a dry contact needs no film"
        )
    rng = np.random.default_rng(seed)
    sample = draw_sample(job, points, rng)
    return tuple(_question(job, point, log_uniform(rng, *NATURAL_FREQUENCIES)) for point in sample)


def _question(job: Job, sample: SamplePoint, natural: float) -> Question:
    """One point, at a natural frequency of the film of Moes' formula."""
    contact, *values = sample
    point = OperatingPoint(*values)
    (film,) = FormulaSolver("moes", thickest_film=math.inf).solve_line(
        contact, job.lubricant, (point.load,), point.entrainment_speed, point.temperature
    )
    frequency = float(natural_to_hertz((natural,), film, contact, point)[0])
    return Question(contact, job.lubricant, point, min(max(frequency, LOWEST_FREQUENCY), HIGHEST_FREQUENCY))


def _ask(model: ContactModel, questions: Sequence[Question]) -> Asked:
    """Answers to all questions, and what one took; a first answer that compiles is not in it."""
    # a slow answer is too expensive to be given twice; programs of their own compile nothing here
    if questions and not getattr(getattr(model, "solver", None), "slow", False):
        model(questions[0])
    began = cpu_seconds()
    many = getattr(model, "many", None)  # a table is read at all points at once
    answers = tuple(model(question) for question in questions) if many is None else many(questions)
    spent = cpu_seconds() - began
    return Asked(answers, spent / len(questions) if questions else math.nan)


def _choice(
    entry: Entry,
    questions: Sequence[Question],
    answered: Asked,
    truth: Sequence[Answer],
    finest: Sequence[Answer] | None,
) -> Choice:
    """One row: errors at the points that both the choice and the reference answer."""
    units = [
        scales(answer, question, entry.group.least_film) for answer, question in zip(truth, questions, strict=True)
    ]
    places = [question.place for question in questions]
    judged = [name for name in QUANTITIES if any(name in answer.values for answer in answered.answers)]

    def summed(first: Sequence[Answer], second: Sequence[Answer], stated: bool) -> dict[str, ErrorSummary]:
        summaries = {}
        for name in judged:
            unit = _column([scale.get(name, math.nan) for scale in units])
            errors = (_values(first, name) - _values(second, name)) / unit
            own = _column([answer.stated.get(name, math.nan) for answer in first]) / unit if stated else None
            summary = ErrorSummary.of(errors, places, own)
            if summary.points:
                summaries[name] = summary
        return summaries

    errors = summed(answered.answers, truth, True)
    numerical: Mapping[str, ErrorSummary] = {}
    model: Mapping[str, ErrorSummary] = errors if entry.closed else {}
    if finest is not None:
        numerical = summed(answered.answers, finest, True)
        if finest is not truth:
            model = summed(finest, truth, False)
    unanswered = tuple(
        f"{question.place}: {answer.lost}"
        for question, answer in zip(questions, answered.answers, strict=True)
        if answer.lost
    )
    return Choice(
        group=entry.group.name,
        label=entry.label,
        seconds=answered.seconds,
        errors=errors,
        numerical=numerical,
        model=model,
        solved=len(questions) - len(unanswered),
        asked=len(questions),
        lost=unanswered,
        default=entry.default,
        reference=entry.group.reference,
    )


def _values(answers: Sequence[Answer], name: str) -> FloatArray:
    """One quantity of all answers; NaN where there is none."""
    return _column([answer.values.get(name, math.nan) for answer in answers])


def _column(values: Sequence[float]) -> FloatArray:
    """Numbers as an array."""
    return np.array(values, dtype=np.float64)

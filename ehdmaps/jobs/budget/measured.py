"""Contacts measured at random points of a job: ways of computing them beside others, and what each costs.

Numerical error is what a choice differs by from the finest affordable solution of its own model; error of the model is
what that one differs by from the reference. Both are relative to the reference, see `answers`, so
that at each point they add up to the error.

Error budget of a map at few random points, for its report: films of the film table, rules, some fresh solves.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import get_args

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiling import cpu_seconds
from ehdmaps.errors import EhdmapsError, InputError
from ehdmaps.jobs.budget.contact_ways import QUANTITIES, Answer, ContactModel, Question, scales
from ehdmaps.jobs.budget.entries import ContactEntry, quick, sources
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.sampling import VALLEY_SHARE, SamplePoint, draw_sample, log_uniform
from ehdmaps.jobs.reader import parse_job
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.law import ContactLaw, LawKind
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.oil_supply import FLOODED
from ehdmaps.physics.solution import natural_to_hertz
from ehdmaps.physics.spectrum import HIGHEST_FREQUENCY, LOWEST_FREQUENCY
from ehdmaps.physics.surface import SMOOTH
from ehdmaps.program import plain
from ehdmaps.trade.record import Choice, ErrorSummary, Group, Judged, Trade
from ehdmaps.units import LOAD, SPEED, TEMPERATURE

NATURAL_FREQUENCIES = (0.1, 10.0)
"""Range of omega sqrt(b^2 + 2 h R)/u from which the frequency of a point is drawn."""

JUDGED = tuple(Judged(name) for name in QUANTITIES)
SHOWN = ("stiffness", "damping", "film offset")
"""What is compared, and what is shown first."""

Told = Callable[[str], None]
"""Takes a line of progress."""


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
class Measured:
    """Ways of computing contacts, measured.

    Attributes
    ----------
    choices : tuple of Choice
        The rows.
    truths : tuple of (Group, Asked)
        The reference of each group, and what it answered at all points.
    gaps : tuple of str
        Points at which no numerical error was told apart.
    """

    choices: tuple[Choice, ...]
    truths: tuple[tuple[Group[ContactModel], Asked], ...]
    gaps: tuple[str, ...]


def measured(
    entries: Sequence[ContactEntry], questions: Sequence[Question], few: int = 0, tell: Told = lambda line: None
) -> Measured:
    """Ask ways of computing contacts, and hold each against the truth of its group.

    Parameters
    ----------
    entries : sequence of Entry
        Who is measured.
    questions : sequence of Question
        What is asked.
    few : int
        How many of the questions those get whose points take seconds.
    tell : callable
        Is told what is being measured.
    """
    known: dict[tuple[ContactModel, int], Asked] = {}

    def asked(model: ContactModel, at: Sequence[Question], words: str) -> Asked:
        if (model, len(at)) not in known:
            tell(f"{words}: {len(at)} points")
            known[model, len(at)] = _ask(model, at)
        return known[model, len(at)]

    choices, groups = [], dict.fromkeys(entry.group for entry in entries)
    truths, gaps = {group.truth for group in groups}, list[str]()
    for entry in entries:
        at = questions[:few] if entry.few else questions
        # the truth is asked at all points once, the few are the first of them
        truth = asked(entry.group.truth, questions, f"reference of {entry.group.name}").answers[: len(at)]
        own = asked(entry.way, at, entry.label)
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
    return Measured(
        tuple(choices),
        tuple((group, known[group.truth, len(questions)]) for group in groups),
        tuple(dict.fromkeys(gaps)),  # several choices may have one finest solution
    )


def sample_words(job: Job, count: int, seed: int) -> str:
    """Say what the sample is.

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
    return (
        f"{count} random points, seed {seed}: {ranges}; {VALLEY_SHARE:.0%} of them in the damping valley, where the "
        "job reaches it"
    )


def drawn(job: Job, points: int, seed: int) -> tuple[Question, ...]:
    """Random points of a job, with a frequency each.

    Parameters
    ----------
    job : Job
        Job over whose range points are drawn.
    points, seed : int
        How many, and their seed.

    Raises
    ------
    InputError
        If the job has no speed above zero.
    """
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
    entry: ContactEntry,
    questions: Sequence[Question],
    answered: Asked,
    truth: Sequence[Answer],
    finest: Sequence[Answer] | None,
) -> Choice:
    """One row: errors at the points that both the choice and the reference answer."""
    pairs = zip(truth, questions, strict=True)
    units = [scales(answer, question, entry.group.least_film) for answer, question in pairs]
    places = [question.place for question in questions]
    judged = [name for name in QUANTITIES if any(name in answer.values for answer in answered.answers)]

    def summed(first: Sequence[Answer], second: Sequence[Answer], stated: bool) -> dict[str, ErrorSummary]:
        summaries = {}
        for name in judged:
            unit = _column(units, name)
            errors = (_values(first, name) - _values(second, name)) / unit
            own = _column([answer.stated for answer in first], name) / unit if stated else None
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
    lost = tuple(
        f"{question.place}: {answer.lost}"
        for question, answer in zip(questions, answered.answers, strict=True)
        if answer.lost
    )
    count = len(questions)
    return entry.choice(
        "", answered.seconds, errors, numerical=numerical, model=model, solved=count - len(lost), asked=count, lost=lost
    )


def _values(answers: Sequence[Answer], name: str) -> FloatArray:
    """One quantity of all answers; NaN where there is none."""
    return _column([answer.values for answer in answers], name)


def _column(rows: Sequence[Mapping[str, float]], name: str) -> FloatArray:
    """Numbers of one name as an array; NaN where there is none."""
    return np.array([row.get(name, math.nan) for row in rows], dtype=np.float64)


POINTS, SEED = 12, 1
"""Size of the sample, and its seed."""


def map_budget(emap: EHDMap) -> Trade | str:
    """Measure sources of error at some points of a map; or say why that cannot be.

    Parameters
    ----------
    emap : EHDMap
        The map.
    """
    try:
        name = plain(emap.dataset.attrs.get("job_name", "map"))
        job = parse_job(str(emap.dataset.attrs["job_toml"]), name, "job of the map", emap.dataset.attrs.get("solver"))
        questions, entries = drawn(job, POINTS, SEED), quick(job, _laws(emap))
        found = measured(entries, questions)
    except EhdmapsError as error:
        return str(error)
    sample = f"{sample_words(job, len(questions), SEED)}; ehdmaps tradeoff takes more points, and finer solutions."
    return Trade(
        level="contact",
        title=f"Error budget of {job.title}",
        cost="s a point",
        reference="what is known cheaply",
        judged=JUDGED,
        choices=found.choices,
        frame=(f"Against what is known cheaply. {sample}",),
        sources=sources(entries),
        shown=SHOWN,
    )


def _laws(emap: EHDMap) -> dict[str, ContactLaw]:
    """Flooded, smooth laws of the contacts of a map; none where none can be made."""
    try:
        return {
            kind: emap.law(kind, outside="asymptote", supply=FLOODED, surface=SMOOTH)
            for kind in get_args(LawKind)
            if kind in {contact.name for contact in emap.contacts}
        }
    except EhdmapsError:
        return {}

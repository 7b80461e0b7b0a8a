"""The contact solvers over all that inputs may declare, and a decade beyond: a right value, or a status with a reason.

A value is right where it is near what theory says of it: Hertz' pressure, the film of Martin, the asymptotes of Moes;
where a hair more load, speed or temperature changes it by a hair; where more load brings the bodies nearer; and where a
solve on a finer grid differs by no more than was stated.
"""

from __future__ import annotations

import contextlib
import math
import time
import warnings
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import EhdmapsError, InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.sampling import SamplePoint
from ehdmaps.jobs.problem import LOAD_AXIS
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.solution import ContactSolution, ContactSolver, FilmSolution, contact_solution
from mbs.laboratory.extremes.check import Check, Verdict, checked
from mbs.laboratory.extremes.contact_points import (
    DECADE,
    HAIR,
    JUMP,
    Tried,
    WildPoint,
    error_ratios,
    film_problem,
    jump,
    refusals,
    stated_size,
    status_problem,
    tried_solvers,
    wild_point,
)

MOST_SECONDS = 20.0
"""Processor time that a point may take with a solver that is not slow."""

LINES_PER_POINT, PAIRS_PER_POINT, REFINED_PER_POINT = 1.0 / 500.0, 1.0 / 20.0, 1.0 / 250.0
"""Lines of loads, pairs a hair apart and refined solves for each point of a search."""

LOADS_OF_A_LINE = 41

Judge = Callable[[WildPoint], tuple[str, float, str]]
"""Fault of a point, its part of the bound, and why it has no value; empty texts where there is none."""


def contact_checks(
    job: Job, points: int, seed: int, openfoam: int = 0, tell: Callable[[str], None] = print
) -> Iterator[Check]:
    """Search contacts for values that are wrong.

    Parameters
    ----------
    job : Job
        Job whose contacts and oil are among those that are tried.
    points : int
        Points, each by every solver that is not slow; lines, pairs and refined solves are in proportion to them.
    seed : int
        Seed of the search.
    openfoam : int
        Points by the solver openfoam, of the ranges of the job.
    tell : callable
        Takes a line of progress.

    Yields
    ------
    Check
        One for each thing that is looked at.
    """
    if points:
        rows = tried_solvers()
        quick = [row for row in rows if row.share == 1.0]
        for row in quick:  # what is compiled is no part of any point
            row.solver.solve_line(job.contacts[0], job.lubricant, (1e5,), 1.0, 313.15)
        for row in rows:
            if count := round(points * row.share):
                tell(f"{count} points by {row.name}")
                verdicts = _points(job, seed, count, partial(_judge_value, row))
                yield checked(f"contact: {row.name}, value or status", row.rule, verdicts)
        lines = max(2, round(points * LINES_PER_POINT))
        tell(f"{lines} lines of {LOADS_OF_A_LINE} loads, by each solver")
        for row in quick:
            verdicts = _points(job, seed + 1, lines, partial(_judge_line, row), "the line of ")
            yield checked(f"contact: {row.name}, more load", _LINES, verdicts)
        pairs = max(5, round(points * PAIRS_PER_POINT))
        tell(f"{pairs} pairs of points a hair apart, by each solver")
        for row in quick:
            verdicts = _points(job, seed + 2, pairs, partial(_judge_pair, row))
            yield checked(f"contact: {row.name}, a hair apart", _PAIRS, verdicts)
        refined = max(2, round(points * REFINED_PER_POINT))
        tell(f"{refined} points by reynolds on a finer grid")
        yield checked("contact: reynolds, refined", _REFINED, _refined(job, refined, seed + 3))
        yield checked("contact: what is no point", _REFUSED, _refused(job, quick))
    if openfoam:
        tell(f"{openfoam} points by openfoam")
        try:
            judge = partial(_judge_openfoam, solvers.build("openfoam", {}))
        except InputError as error:
            yield Check(_OPENFOAM, 0, 0, 0, f"not tried: {error}")
        else:
            yield checked(_OPENFOAM, _OPENFOAM_RULE, _by_openfoam(job, openfoam, seed + 4, judge, tell))


_LINES = (
    "the approach rises from load to load, but for the stated errors of the films, and the stiffness is above "
    f"zero; where the status changes between usable ones, loads {HAIR:g} apart differ as points a hair apart may"
)
_PAIRS = (
    f"load, speed and temperature each {HAIR:g} (0.001 K) apart change film, stiffness and damping by {JUMP:g} and "
    "twice the stated error at most"
)
_REFINED = (
    "four times the cells change film, stiffness and damping by no more than three times their stated errors, which "
    "are meant for 95 of 100 points"
)
_REFUSED = "zero, negative, infinite and no number are refused in words"
_OPENFOAM = "contact: openfoam, value or status"
_OPENFOAM_RULE = (
    "film and pressure as limits of theory have them, and within three times the stated errors of openfoam and "
    "reynolds, and 2 % for what differs between the two models"
)


def _points(job: Job, seed: int, count: int, judge: Judge, place: str = "") -> Iterator[Verdict]:
    """Draw points, and judge them."""
    for number in range(count):
        wild = _drawn(job, seed, number)
        yield Verdict(refused=wild) if isinstance(wild, str) else _verdict(wild, judge, place)


def _verdict(wild: WildPoint, judge: Judge, place: str = "") -> Verdict:
    """Judge a point; an error of our own type is a refusal, any other one a fault."""
    where = f"{place}{wild.label}"
    try:
        wrong, share, refusal = judge(wild)
    except EhdmapsError as error:
        return Verdict(refused=_words(error))
    except Exception as error:
        return _slip(where, error)
    return Verdict(where if wrong else f"{100.0 * share:.3g} % of the bound at {where}", share, wrong, refusal)


def _slip(where: str, error: Exception) -> Verdict:
    """An error of a class that this program does not raise on purpose."""
    return Verdict(where, wrong=f"{type(error).__name__}: {error!s:.200}")


def _judge_value(row: Tried, wild: WildPoint) -> tuple[str, float, str]:
    """Judge a value beside the limits of theory, and the time that it takes."""
    began = time.process_time()
    film, whole = _solved(row.solver, wild)
    wrong, share = ("", 0.0) if whole is None else row.judge(wild, film, whole)
    seconds = time.process_time() - began
    wrong = wrong or status_problem(film) or (f"took {seconds:.3g} s" if seconds > MOST_SECONDS else "")
    return wrong, share, _unsolved(film)


def _judge_line(row: Tried, wild: WildPoint) -> tuple[str, float, str]:
    """Judge a line of loads: more load brings the bodies nearer, and a change of the status changes no number."""
    loads = np.geomspace(LOAD_AXIS.low / DECADE, LOAD_AXIS.high * DECADE, LOADS_OF_A_LINE)
    wrong, share, usable = _line_problem(row.solver, wild, tuple(map(float, loads)))
    return wrong, share, "" if usable >= 2 else "fewer than two loads with a solution"


def _judge_pair(row: Tried, wild: WildPoint) -> tuple[str, float, str]:
    """Judge points beside one another: a hair more of anything changes the answer by a hair."""
    contact, load, speed, temperature = wild.point
    beside = (load * (1.0 + HAIR), speed, temperature), (load, speed * (1.0 + HAIR), temperature)
    first, whole = _solved(row.solver, wild)
    wrong, share, compared = "", 0.0, 0
    for place in (*beside, (load, speed, temperature + 1e-3)):
        other, its = _solved(row.solver, wild._replace(point=SamplePoint(contact, *place)))
        if whole is None or its is None:
            continue
        changed, by = jump(wild, (first, whole), (other, its))
        wrong, share, compared = wrong or changed, max(share, by), compared + 1
    return wrong, share, "" if compared else f"{first.status.word}: {_alike(first.reason)}"


def _refined(job: Job, points: int, seed: int) -> Iterator[Verdict]:
    """Solve points on a grid of four times the cells, and compare with the stated errors."""
    coarse = ReynoldsSolver()
    fine = replace(coarse, density=4.0 * coarse.density)
    number = solved = 0
    while solved < points and number < 40 * points:
        wild = _drawn(job, seed, number)
        number += 1
        if isinstance(wild, str):
            continue
        try:
            film, whole = _solved(coarse, wild)
            if whole is None or film.film_offset == 0.0:
                continue
            exact, best = _solved(fine, wild)
        except EhdmapsError:
            continue
        except Exception as error:
            yield _slip(wild.label, error)
            continue
        solved += 1
        if best is None:
            yield Verdict(refused=f"finer grid {exact.status.word}: {_alike(exact.reason)}")
            continue
        ratios = error_ratios(wild, (film, whole), (exact, best))
        name, ratio = max(ratios.items(), key=lambda entry: entry[1])
        words = f"{name} is off by {ratio:.3g} times its stated error"
        yield Verdict(wild.label, wrong=words) if ratio > 3.0 else Verdict(f"{words} at {wild.label}", ratio)


def _refused(job: Job, quick: Iterable[Tried]) -> Iterator[Verdict]:
    """Give what no number may come of."""
    for row in quick:
        for label, make in refusals(job, row.solver):
            where = f"{row.name}: {label}"
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                try:
                    made = make()
                except InputError:
                    yield Verdict(refused="an error in words")
                    continue
                except Exception as error:
                    yield _slip(where, error)
                    continue
            if isinstance(made, FilmSolution) and not made.status.usable and made.reason:
                yield Verdict(refused="a status with a reason")
            else:
                yield Verdict(where, wrong=f"gives {made!r:.200}")


def _by_openfoam(job: Job, points: int, seed: int, judge: Judge, tell: Callable[[str], None]) -> Iterator[Verdict]:
    """Judge points of the job's own ranges, and a decade beyond, by openfoam."""
    for number in range(points):
        yield _verdict(_within(job, seed, number), judge)
        tell(f"openfoam: {number + 1} of {points}")


def _judge_openfoam(solver: ContactSolver, wild: WildPoint) -> tuple[str, float, str]:
    """Judge a film of openfoam beside theory, and beside reynolds."""
    film, whole = _solved(solver, wild)
    beside, its = _solved(ReynoldsSolver(), wild)
    wrong, share = ("", 0.0) if whole is None else film_problem(wild, film, whole)
    if not wrong and whole is not None and its is not None and film.film_offset > 0.0:
        apart = abs(film.film_offset / beside.film_offset - 1.0)
        bound = 0.02 + 3.0 * (abs(film.film_offset_error) + abs(beside.film_offset_error))
        share = max(share, apart / bound)
        wrong = f"film {apart:.3g} off that of reynolds" if apart > bound else ""
    return wrong or status_problem(film), share, _unsolved(film)


def _unsolved(film: FilmSolution) -> str:
    """Reason why a film has no solution; empty where it has one."""
    return "" if film.status.usable else f"{film.status.word}: {_alike(film.reason)}"


def _drawn(job: Job, seed: int, number: int) -> WildPoint | str:
    """A point, or why it was refused."""
    try:
        wild = wild_point(job, seed, number)
        wild.oil.at(wild.point.temperature)
    except InputError as error:
        return _words(error)
    return wild


def _within(job: Job, seed: int, number: int) -> WildPoint:
    """A point of the job's own contacts and oil, within its axes and a decade beyond."""
    rng = np.random.default_rng([seed, number])
    contact = job.contacts[int(rng.integers(len(job.contacts)))]
    speeds = [speed for speed in job.entrainment_speeds if speed > 0.0]
    ends = [(min(job.loads), max(job.loads)), (min(speeds), max(speeds))]
    load, speed = (float(np.exp(rng.uniform(np.log(low / DECADE), np.log(high * DECADE)))) for low, high in ends)
    temperature = float(rng.uniform(job.temperatures[0], job.temperatures[-1]))
    words = f"seed {seed}, number {number}: {contact.name}, {load:.6g} N/m, {speed:.6g} m/s, {temperature:.6g} K"
    return WildPoint(SamplePoint(contact, load, speed, temperature), job.lubricant, words)


def _solved(solver: ContactSolver, wild: WildPoint) -> tuple[FilmSolution, ContactSolution | None]:
    """A film and its contact, None where it has no solution; a warning is an error."""
    contact, load, speed, temperature = wild.point
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (film,) = solver.solve_line(contact, wild.oil, (load,), speed, temperature)
        if not film.status.usable:
            return film, None
        return film, contact_solution(film, contact, OperatingPoint(load, speed, temperature))


def _line_problem(solver: ContactSolver, wild: WildPoint, loads: tuple[float, ...]) -> tuple[str, float, int]:
    """Fault of a line of loads, the share of its bound that it takes, and the number of loads with a solution."""
    contact, _, speed, temperature = wild.point
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        films = solver.solve_line(contact, wild.oil, loads, speed, temperature)
        solved = []
        for load, film in zip(loads, films, strict=True):
            if film.status.usable:
                with contextlib.suppress(InputError):  # the structural law may not hold there
                    solved.append(
                        (load, film, contact_solution(film, contact, OperatingPoint(load, speed, temperature)))
                    )
    share = 0.0
    for (load, film, whole), (heavier, after, then) in pairwise(solved):
        allowed = sum(stated_size(entry.film_offset_error) * abs(entry.film_offset) for entry in (film, after))
        allowed += 1e-12 * max(abs(whole.approach), abs(film.film_offset))
        if not whole.stiffness > 0.0:
            return f"a stiffness of {whole.stiffness:.4g} N/m2 at {load:.6g} N/m", 0.0, len(solved)
        fall = whole.approach - then.approach
        if fall > allowed:
            return f"approach falls by {fall:.3g} m from {load:.6g} to {heavier:.6g} N/m", 0.0, len(solved)
        if film.status is not after.status:
            wrong, by = _border_problem(solver, wild, load, heavier)
            share = max(share, by)
            if wrong:
                return wrong, by, len(solved)
    return "", share, len(solved)


def _border_problem(solver: ContactSolver, wild: WildPoint, low: float, high: float) -> tuple[str, float]:
    """Jump where the status changes between two loads, and the share of the bound that it takes."""

    def at(load: float) -> tuple[WildPoint, FilmSolution, ContactSolution | None]:
        place = wild._replace(point=wild.point._replace(load=load))
        return (place, *_solved(solver, place))

    first, last = at(low), at(high)
    while high / low - 1.0 > HAIR:
        middle = math.sqrt(low * high)
        between = at(middle)
        if between[1].status is first[1].status:
            low, first = middle, between
        else:
            high, last = middle, between
    if first[2] is None or last[2] is None:
        return "", 0.0
    wrong, by = jump(wild, (first[1], first[2]), (last[1], last[2]))
    return (f"{wrong} where the status changes at {low:.9g} N/m" if wrong else ""), by


def _words(error: EhdmapsError) -> str:
    """Reason for a refusal, in words that are alike for alike points."""
    return _alike(str(error).splitlines()[0])


def _alike(text: str) -> str:
    """A text without its numbers, and without what repeats a point."""
    if text.startswith("seed "):
        text = text.split(": ", 2)[-1]
    return " ".join(word for word in text.split() if not any(letter.isdigit() for letter in word))[:80]

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
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.errors import EhdmapsError, InputError
from ehdmaps.jobs import solvers
from ehdmaps.jobs.instruments.stability_points import (
    DECADE,
    HAIR,
    JUDGES,
    JUMP,
    RULES,
    Judge,
    WildPoint,
    error_ratios,
    film_problem,
    jump,
    refusals,
    stated_size,
    status_problem,
    wild_point,
)
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.sampling import SamplePoint
from ehdmaps.jobs.problem import LOAD_AXIS
from ehdmaps.physics.closed_form import FormulaSolver, HertzSolver
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.heat import INLET_HEAT, THERMAL
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolution, ContactSolver, FilmSolution, contact_solution
from ehdmaps.stability.findings import Check, Tally

MOST_SECONDS = 20.0
"""Processor time that a point may take with a solver that is not slow."""

LINES_PER_POINT, PAIRS_PER_POINT, REFINED_PER_POINT = 1.0 / 500.0, 1.0 / 20.0, 1.0 / 250.0
"""Lines of loads, pairs a hair apart and refined solves for each point of a search."""

PHYSICS_PER_POINT, THERMAL_PER_POINT = 1.0 / 10.0, 1.0 / 1000.0
"""Points by solvers with shear laws or heat in the inlet, and with temperatures, for each point of a search."""

LOADS_OF_A_LINE = 41


def contact_checks(
    job: Job, points: int, seed: int, openfoam: int = 0, tell: Callable[[str], None] = print
) -> list[Check]:
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

    Returns
    -------
    list of Check
        One for each thing that is looked at.
    """
    if not points:
        return [openfoam_check(job, openfoam, seed, tell)] if openfoam else []
    quick = quick_solvers()
    for solver in quick.values():  # what is compiled is no part of any point
        solver.solve_line(job.contacts[0], job.lubricant, (1e5,), 1.0, 313.15)
    checks = []
    for name, solver in quick.items():
        tell(f"{points} points by {name}")
        checks.append(value_check(name, solver, JUDGES[name], (_drawn(job, seed, n) for n in range(points))))
    for name, (solver, share) in solvers_with_physics().items():
        others = round(points * share)
        if others:
            tell(f"{others} points by {name}")
            checks.append(value_check(name, solver, JUDGES[name], (_drawn(job, seed, n) for n in range(others))))
    lines = max(2, round(points * LINES_PER_POINT))
    tell(f"{lines} lines of {LOADS_OF_A_LINE} loads, by each solver")
    checks += [line_check(name, solver, job, lines, seed) for name, solver in quick.items()]
    pairs = max(5, round(points * PAIRS_PER_POINT))
    tell(f"{pairs} pairs of points a hair apart, by each solver")
    checks += [pair_check(name, solver, job, pairs, seed) for name, solver in quick.items()]
    refined = max(2, round(points * REFINED_PER_POINT))
    tell(f"{refined} points by reynolds on a finer grid")
    checks.append(refined_check(job, refined, seed))
    checks.append(refusal_check(job, quick))
    if openfoam:
        tell(f"{openfoam} points by openfoam")
        checks.append(openfoam_check(job, openfoam, seed, tell))
    return checks


def quick_solvers() -> Mapping[str, ContactSolver]:
    """Return the solvers of which a point takes milliseconds, by what they are called in a check."""
    formulas = {f"formula {name}": FormulaSolver(name) for name in ("moes", "dowson-toyoda", "pan-hamrock")}
    return {"hertz": HertzSolver(), **formulas, "reynolds": ReynoldsSolver()}


def solvers_with_physics() -> Mapping[str, tuple[ContactSolver, float]]:
    """Return solvers whose films have a limiting stress, or heat, by their names in a check, and their share of points.

    The one with temperatures takes minutes to be compiled, and is no part of a small search.
    """
    return {
        "reynolds, limiting": (ReynoldsSolver(shear="limiting"), PHYSICS_PER_POINT),
        "reynolds, inlet-heat": (ReynoldsSolver(physics=INLET_HEAT), PHYSICS_PER_POINT),
        "reynolds, thermal": (ReynoldsSolver(physics=THERMAL), THERMAL_PER_POINT),
    }


def value_check(name: str, solver: ContactSolver, judge: Judge, drawn: Iterable[WildPoint | str]) -> Check:
    """Solve points, and judge what comes of them.

    Parameters
    ----------
    name : str
        How the check calls the solver.
    solver : ContactSolver
        The solver.
    judge : callable
        Knows the limits of theory.
    drawn : iterable
        Points, or why one was refused when it was drawn.
    """
    tally = Tally(f"contact: {name}, value or status", RULES[name])

    def judged(wild: WildPoint) -> _Verdict:
        began = time.process_time()
        film, whole = _solved(solver, wild)
        wrong, share = ("", 0.0) if whole is None else judge(wild, film, whole)
        seconds = time.process_time() - began
        wrong = wrong or status_problem(film) or (f"took {seconds:.3g} s" if seconds > MOST_SECONDS else "")
        return _Verdict(wrong, share, "" if film.status.usable else f"{film.status.word}: {_alike(film.reason)}")

    for wild in drawn:
        _count(tally, wild, judged)
    return tally.check()


def line_check(name: str, solver: ContactSolver, job: Job, lines: int, seed: int) -> Check:
    """Solve lines of loads: more load brings the bodies nearer, and a change of the status changes no number.

    Parameters
    ----------
    name : str
        How the check calls the solver.
    solver : ContactSolver
        The solver.
    job : Job
        Job whose contacts and oil are among those that are tried.
    lines : int
        How many lines.
    seed : int
        Seed of the search.
    """
    tally = Tally(
        f"contact: {name}, more load",
        "the approach rises from load to load, but for the stated errors of the films, and the stiffness is above "
        f"zero; where the status changes between usable ones, loads {HAIR:g} apart differ as points a hair apart may",
    )
    loads = tuple(float(w) for w in np.geomspace(LOAD_AXIS.low / DECADE, LOAD_AXIS.high * DECADE, LOADS_OF_A_LINE))

    def judged(wild: WildPoint) -> _Verdict:
        wrong, share, usable = _line_problem(solver, wild, loads)
        return _Verdict(wrong, share, "" if usable >= 2 else "fewer than two loads with a solution")

    for number in range(lines):
        _count(tally, _drawn(job, seed + 1, number), judged, "the line of ")
    return tally.check()


def pair_check(name: str, solver: ContactSolver, job: Job, pairs: int, seed: int) -> Check:
    """Solve points beside one another: a hair more of anything changes the answer by a hair.

    Parameters
    ----------
    name, solver, job
        The arguments of `line_check`.
    pairs : int
        How many pairs.
    seed : int
        Seed of the search.
    """
    tally = Tally(
        f"contact: {name}, a hair apart",
        f"load, speed and temperature each {HAIR:g} (0.001 K) apart change film, stiffness and damping by {JUMP:g} and "
        "twice the stated error at most",
    )

    def judged(wild: WildPoint) -> _Verdict:
        contact, load, speed, temperature = wild.point
        beside = (load * (1.0 + HAIR), speed, temperature), (load, speed * (1.0 + HAIR), temperature)
        first, whole = _solved(solver, wild)
        wrong, share, compared = "", 0.0, 0
        for place in (*beside, (load, speed, temperature + 1e-3)):
            other, its = _solved(solver, wild._replace(point=SamplePoint(contact, *place)))
            if whole is None or its is None:
                continue
            changed, by = jump(wild, first, whole, other, its)
            wrong, share, compared = wrong or changed, max(share, by), compared + 1
        return _Verdict(wrong, share, "" if compared else f"{first.status.word}: {_alike(first.reason)}")

    for number in range(pairs):
        _count(tally, _drawn(job, seed + 2, number), judged)
    return tally.check()


def refined_check(job: Job, points: int, seed: int) -> Check:
    """Solve points on a grid of four times the cells, and compare with the stated errors.

    Parameters
    ----------
    job : Job
        Job whose contacts and oil are among those that are tried.
    points : int
        How many.
    seed : int
        Seed of the search.
    """
    tally = Tally(
        "contact: reynolds, refined",
        "four times the cells change film, stiffness and damping by no more than three times their "
        "stated errors, which are meant for 95 of 100 points",
    )
    coarse = ReynoldsSolver()
    fine = replace(coarse, density=4.0 * coarse.density)
    number = solved = 0
    while solved < points and number < 40 * points:
        wild = _drawn(job, seed + 3, number)
        number += 1
        if isinstance(wild, str):
            continue
        try:
            film, whole = _solved(coarse, wild)
            exact, best = _solved(fine, wild) if whole is not None else (film, None)
        except EhdmapsError:
            continue
        except Exception as error:
            tally.failed(wild.label, f"{type(error).__name__}: {error!s:.200}")
            continue
        if whole is None or film.film_offset == 0.0:
            continue
        solved += 1
        if best is None:
            tally.refused(f"finer grid {exact.status.word}: {_alike(exact.reason)}")
            continue
        ratios = error_ratios(wild, film, whole, exact, best)
        name, ratio = max(ratios.items(), key=lambda entry: entry[1])
        if ratio > 3.0:
            tally.failed(wild.label, f"{name} is off by {ratio:.3g} times its stated error")
        else:
            tally.right(f"{name} is off by {ratio:.3g} times its stated error at {wild.label}", ratio)
    return tally.check()


def refusal_check(job: Job, quick: Mapping[str, ContactSolver]) -> Check:
    """Give what no number may come of.

    Parameters
    ----------
    job : Job
        Job with a contact and an oil that are good.
    quick : mapping of str to ContactSolver
        The solvers.
    """
    tally = Tally("contact: what is no point", "zero, negative, infinite and no number are refused in words")

    for name, solver in quick.items():

        def use(
            contact: LineContact,
            oil: Lubricant,
            load: float,
            speed: float,
            temperature: float,
            by: ContactSolver = solver,
        ) -> object:
            return by.solve_line(contact, oil, (load,), speed, temperature)[0]

        for entry in refusals(job, use):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                try:
                    made = entry.make()
                except InputError as error:
                    tally.refused("an error in words" if error.problems else "")
                    continue
                except Exception as error:
                    tally.failed(f"{name}: {entry.label}", f"{type(error).__name__}: {error!s:.200}")
                    continue
            if isinstance(made, FilmSolution) and not made.status.usable and made.reason:
                tally.refused("a status with a reason")
            else:
                tally.failed(f"{name}: {entry.label}", f"gives {made!r:.200}")
    return tally.check()


def openfoam_check(job: Job, points: int, seed: int, tell: Callable[[str], None]) -> Check:
    """Solve points of the job's own ranges, and a decade beyond, by openfoam, beside reynolds.

    Parameters
    ----------
    job, points, seed
        The arguments of `refined_check`.
    tell : callable
        Takes a line of progress.
    """
    tally = Tally(
        "contact: openfoam, value or status",
        "film and pressure as limits of theory have them, and within three times the stated errors of openfoam and "
        "reynolds, and 2 % for what differs between the two models",
    )
    try:
        solver = solvers.build("openfoam", {})
    except InputError as error:
        return Check("contact: openfoam, value or status", 0, 0, 0, f"not tried: {error}")
    reynolds = ReynoldsSolver()
    for number in range(points):
        wild = _within(job, seed + 4, number)
        try:
            film, whole = _solved(solver, wild)
            beside, its = _solved(reynolds, wild)
            wrong, share = ("", 0.0) if whole is None else film_problem(wild, film, whole)
        except EhdmapsError as error:
            tally.refused(_words(error))
            continue
        except Exception as error:
            tally.failed(wild.label, f"{type(error).__name__}: {error!s:.200}")
            continue
        if not wrong and whole is not None and its is not None and film.film_offset > 0.0:
            apart = abs(film.film_offset / beside.film_offset - 1.0)
            bound = 0.02 + 3.0 * (abs(film.film_offset_error) + abs(beside.film_offset_error))
            share = max(share, apart / bound)
            wrong = f"film {apart:.3g} off that of reynolds" if apart > bound else ""
        wrong = wrong or status_problem(film)
        if wrong:
            tally.failed(wild.label, wrong)
        elif not film.status.usable:
            tally.refused(f"{film.status.word}: {_alike(film.reason)}")
        else:
            tally.right(f"{100.0 * share:.3g} % of the bound at {wild.label}", share)
        tell(f"openfoam: {number + 1} of {points}")
    return tally.check()


class _Verdict(NamedTuple):
    """Fault of a case, its part of the bound, and the reason why it has no value; empty texts where there is none."""

    wrong: str
    share: float
    refusal: str


def _count(tally: Tally, wild: WildPoint | str, judged: Callable[[WildPoint], _Verdict], place: str = "") -> None:
    """Judge a point and count it; a point that could not be drawn, and an error of our own type, are refusals."""
    if isinstance(wild, str):
        tally.refused(wild)
        return
    where = f"{place}{wild.label}"
    try:
        verdict = judged(wild)
    except EhdmapsError as error:
        tally.refused(_words(error))
        return
    except Exception as error:
        tally.failed(where, f"{type(error).__name__}: {error!s:.200}")
        return
    if verdict.wrong:
        tally.failed(where, verdict.wrong)
    elif verdict.refusal:
        tally.refused(verdict.refusal)
    else:
        tally.right(f"{100.0 * verdict.share:.3g} % of the bound at {where}", verdict.share)


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
    wrong, by = jump(wild, first[1], first[2], last[1], last[2])
    return (f"{wrong} where the status changes at {low:.9g} N/m" if wrong else ""), by


def _words(error: EhdmapsError) -> str:
    """Reason for a refusal, in words that are alike for alike points."""
    return _alike(str(error).splitlines()[0])


def _alike(text: str) -> str:
    """A text without its numbers, and without what repeats a point."""
    if text.startswith("seed "):
        text = text.split(": ", 2)[-1]
    return " ".join(word for word in text.split() if not any(letter.isdigit() for letter in word))[:80]

"""Films of one solver corrected by a few points of a dearer one.

What is corrected is regressed over the places of `correction_design`, on what the two solvers say of the same points:

- a = ln(h_dear/h_cheap) of the film offset h, together with its slope along zeta, which at constant speed is that along
  ln w: -d ln h/d ln w = S w/h, so that the film compliances S of both solvers are observations of that slope. The
  corrected film compliance is minus the derivative of the corrected film offset, exactly, as a contact law has it. No
  ratio of two compliances is taken: both nearly vanish at the bottom of the damping valley.
- arsinh(q/0.06) of the loss q = B u w/(h b), B the loss compliance and b the half-width, dear less cheap: the
  coordinate in which backbones are interpolated. It is ln(q) away from the valley, so that its difference is the
  logarithm of a ratio, and it takes the losses below zero that are solved in it.
- The logarithms of the ratios of central and minimum film, rolling force and mass flow, where both solvers have them.

Noise counts as far as it changes stiffness and damping: at heavy loads, where the film is a hundredth of the
compliance, its slope and its loss are solved ten times worse and matter not at all; see `_doubts`.

The largest pressure is left as it is: its spike is resolved by no solver. So are the numerical errors that the cheaper
solver states.

The points of the map, the lines of its backbone and the points of the check of its laws are corrected in the same way,
each film by itself, before anything is made of them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import ceil
from typing import Any, NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.errors import MapError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.correction_design import Candidates, candidates, free, per_zeta, places_of, spread_out, usable
from ehdmaps.jobs.make.law_check import SMALL_DAMPING
from ehdmaps.jobs.make.sampling import SamplePoint
from ehdmaps.jobs.make.store import Arrays
from ehdmaps.jobs.make.tasks import SPECTRUM_FIELDS, LineTask, with_later_fields
from ehdmaps.jobs.regression import Regression
from ehdmaps.maps.backbone import LOSS_SCALE
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width, natural_time
from ehdmaps.physics.solution import ContactSolver, Status
from ehdmaps.units import LOAD, SPEED, TEMPERATURE

FEWEST = 4
"""Points with a solution by both solvers that a correction needs."""

MOST_OWN = 64
"""Points of a map that correct its lines, at most: more hardly change a difference that is smooth."""

ALSO = ("central_film", "minimum_film", "rolling_force", "mass_flow")
"""Positive quantities that are corrected besides, where both solvers have them."""

JUDGED = ("film_offset", "stiffness", "damping")
"""Of what errors are told."""

RIGID_MEMORY = 0.946
"""Natural time after which a rigid film has followed, over sqrt(b^2 + 2 h R)/u: S = s/(1 + 0.946 i omega T)."""

_FIRST, _LATER = 2, 8
"""A half of the points fills the range, an eighth is chosen at a time."""


class Films(NamedTuple):
    """Film offset [m], film compliance [m2/N] and loss compliance [m2 s/N] of some points."""

    offset: FloatArray
    compliance: FloatArray
    loss: FloatArray


class Place(NamedTuple):
    """Loads [N/m] and half-widths [m] of some points, and their speeds [m/s]; arrays that broadcast."""

    load: FloatArray
    width: FloatArray
    speed: FloatArray | float


@dataclass(frozen=True, eq=False)
class Correction:
    """Terms to be added to the films of the cheaper solver.

    Attributes
    ----------
    points : tuple of SamplePoint
        Points at which the dearer solver was asked, in this order.
    statuses, reasons : tuple
        How each of them ended, by the dearer solver, or by the cheaper one where only that one has no solution.
    seconds : float
        Time in which the dearer solver solved them [s], all cores.
    offset, loss : Regression
        Regressions of ln(h) with its slope along zeta, and of the loss.
    also : mapping of str to Regression
        Regressions of the logarithms of `ALSO`.
    applied : tuple of bool
        Whether film offset and compliance, and the loss, are corrected: only where leaving out points one by one says
        that they are better then, also with what the settings that were chosen by it make it too small by.
    before, left_out : mapping of str to array (n,)
        Signed relative errors of `JUDGED` of the cheaper solver against the dearer one at the points with a solution,
        and of the corrected one, each of these points left out of the correction in turn.
    shares : array (n,)
        Part of the job's range that is nearest to each of these points.
    witnesses : mapping of str to array (n,)
        Signed relative errors of the corrected solver at points that are no part of the correction; empty without any.
    """

    points: tuple[SamplePoint, ...]
    statuses: tuple[Status, ...]
    reasons: tuple[str, ...]
    seconds: float
    offset: Regression
    loss: Regression
    also: Mapping[str, Regression]
    applied: tuple[bool, bool]
    before: Mapping[str, FloatArray]
    left_out: Mapping[str, FloatArray]
    shares: FloatArray
    witnesses: Mapping[str, FloatArray] = field(default_factory=dict)

    def corrected(self, task: LineTask, arrays: Arrays) -> Arrays:
        """The arrays of a task of the cheaper solver with the correction.

        Parameters
        ----------
        task : LineTask
            What was solved.
        arrays : Arrays
            What was found.
        """
        films = Films(*(arrays[name] for name in ("film_offset", "film_compliance", "loss_compliance")))
        known = _known(arrays)
        if task.entrainment_speed == 0.0 or not known.any():
            return arrays
        loads = np.array(task.loads)
        places = places_of(task.contact, task.lubricant, loads, task.entrainment_speed, task.temperature)
        where = Place(loads, _width(task.contact, loads), task.entrainment_speed)
        new_films = self.films(films, places, where)
        result = dict(arrays)
        for name, old, new in zip(("film_offset", "film_compliance", "loss_compliance"), films, new_films, strict=True):
            result[name] = np.where(known, new, old)
        for name, regression in self.also.items() if self.applied[0] else ():
            if name in arrays:
                result[name] = arrays[name] * np.where(known, np.exp(regression.at(places)[0]), 1.0)
        if task.natural_frequencies:
            added = _slow_change(task, loads, films, new_films)
            for name, part in zip(SPECTRUM_FIELDS, (added.real, added.imag), strict=False):
                result[name] = arrays[name] + np.where(known[:, None], part, 0.0)
        return result

    def films(self, films: Films, places: FloatArray, where: Place) -> Films:
        """Films with the correction.

        Parameters
        ----------
        films : Films
            Those of the cheaper solver.
        places : array (n, 3)
            Their places.
        where : Place
            Loads, half-widths and speeds.
        """
        value, slope = self.offset.at(places)
        return _applied(films, where, value, slope * per_zeta(places), self.loss.at(places)[0], self.applied)

    def model_errors(
        self, contact: LineContact, films: Films, places: FloatArray, where: Place
    ) -> tuple[FloatArray, FloatArray]:
        """Standard deviations of k and of c from those of the dearer solver, relative.

        Parameters
        ----------
        contact : LineContact
            The contact, with its structural law.
        films : Films
            Corrected films.
        places : array (n, 3)
            Their places.
        where : Place
            Loads, half-widths and speeds.
        """
        per_load = films.offset / where.load
        steep = films.compliance / per_load
        share = per_load / (contact.structural_compliance(where.load) + films.compliance)
        of_slope, doubt_of_loss = _doubts(share, _share(films, where))
        sure, stretched = np.ones(share.shape), per_zeta(places)
        spread = self.offset.spread(places, np.column_stack([sure, of_slope / stretched]))
        of_loss = self.loss.spread(places, np.column_stack([doubt_of_loss, sure]))[:, 0, 0]
        if not self.applied[0]:
            known = np.column_stack(self.offset.at(places))
            spread = spread + known[:, :, None] * known[:, None, :]
        if not self.applied[1]:
            of_loss = of_loss + self.loss.at(places)[0] ** 2
        to_zeta = np.column_stack([sure, stretched])
        spread = spread * to_zeta[:, :, None] * to_zeta[:, None, :]
        of_compliance = per_load**2 * (steep**2 * spread[:, 0, 0] - 2.0 * steep * spread[:, 0, 1] + spread[:, 1, 1])
        stiffness = 1.0 / (contact.structural_compliance(where.load) + films.compliance)
        of_stiffness = stiffness**2 * np.maximum(of_compliance, 0.0)
        unit = per_load * where.width / where.speed
        with np.errstate(divide="ignore", invalid="ignore"):
            per_loss = unit / films.loss
            loss_variance = per_loss**2 * (LOSS_SCALE**2 + (films.loss / unit) ** 2) * of_loss + spread[:, 0, 0]
        return np.sqrt(of_stiffness), np.sqrt(loss_variance + 4.0 * of_stiffness)

    @property
    def usable(self) -> int:
        """Number of points with a solution."""
        return sum(status.usable for status in self.statuses)

    def record(self) -> dict[str, Any]:
        """Record of the correction that a map keeps, in plain values."""
        return {
            "asked": len(self.points),
            "usable": self.usable,
            "solve_seconds": self.seconds,
            "not_applied": [
                name for name, used in zip(("film_offset", "loss_compliance"), self.applied, strict=True) if not used
            ],
            "before": {name: quantiles(self.before[name], self.shares) for name in JUDGED},
            **(
                {"witnesses": {name: quantiles(self.witnesses[name], _even(self.witnesses[name])) for name in JUDGED}}
                if self.witnesses
                else {}
            ),
            "leave_one_out": {name: quantiles(self.left_out[name], self.shares) for name in JUDGED},
            "lengths": {
                name: dict(zip(("arsinh(zeta/0.3)", "ln(1+L)", "temperature"), one.settings.lengths, strict=True))
                for name, one in (("film_offset", self.offset), ("loss", self.loss))
            },
            "points": [
                {
                    "contact": point.contact.name,
                    "load": point.load,
                    "entrainment_speed": point.speed,
                    "temperature": point.temperature,
                    "status": status.word,
                    **({"reason": reason} if reason else {}),
                }
                for point, status, reason in zip(self.points, self.statuses, self.reasons, strict=True)
            ],
        }


@dataclass
class _Sample:
    """Points that both solvers were asked for, by their indices among the candidates, and what they found."""

    chosen: list[int]
    cheap: list[Arrays]
    dear: list[Arrays]


def correction(
    job: Job,
    cheap: ContactSolver,
    dear: ContactSolver,
    count: int,
    solve: Callable[[Sequence[LineTask]], Mapping[str, Arrays]],
) -> Correction:
    """Choose points in turn, have both solvers solve them, and regress what they differ by.

    The first half of the points fills the range of the job. Then an eighth at a time goes where the variances of film
    offset, stiffness and loss are largest in sum, each multiplied by the mean of one and of what the error of leaving
    out the nearest point is to the one stated for it, squared. A point that the dearer solver cannot solve counts as
    known in this choice, so that no second one is tried beside it.

    Parameters
    ----------
    job : Job
        What is made.
    cheap, dear : ContactSolver
        The solver of the map, and the one that corrects it.
    count : int
        How many points the dearer one is asked for, at most.
    solve : callable
        Takes tasks, gives their arrays by key.

    Raises
    ------
    MapError
        If too few points have a solution by both.
    """
    among = candidates(job)
    sample = _Sample([], [], [])
    first = min(max(ceil(count / _FIRST), FEWEST), count, len(among.points))
    chosen = spread_out(among, first) if first else []
    while chosen:
        _ask(sample, job, (cheap, dear), among, chosen, solve)
        both = _both(sample)
        left = min(count, len(among.points)) - len(sample.chosen)
        if left <= 0 or not both.any():
            break
        size = min(ceil(count / _LATER), left)
        chosen = (
            _next(among, sample, both, size) if np.count_nonzero(both) >= FEWEST else _farthest(among, sample, size)
        )
    both = _both(sample)
    if np.count_nonzero(both) < FEWEST:
        raise MapError(_too_few(cheap, dear, among, sample, both))
    return _regressed(job, among, sample, both)


def correction_by_points(
    job: Job, points: Sequence[SamplePoint], cheap: Sequence[Arrays], dear: Sequence[Arrays]
) -> Correction | None:
    """Regress what two solvers differ by at points that both were asked for anyway; None with too few solutions.

    At most `MOST_OWN` of the points with a solution are taken, which fill the range. The others are witnesses.

    Parameters
    ----------
    job : Job
        What is made.
    points : sequence of SamplePoint
        The points, with speeds above zero.
    cheap, dear : sequence of Arrays
        What both solvers found, a point each.

    """
    every = _Sample([], [with_later_fields(one) for one in cheap], [with_later_fields(one) for one in dear])
    good = {points[i]: i for i in np.flatnonzero(_both(every)).tolist()}
    among = usable(job, tuple(good))
    if len(among.points) < FEWEST:
        return None
    chosen = spread_out(among, MOST_OWN)
    at = [good[among.points[i]] for i in chosen]
    sample = _Sample(chosen, [every.cheap[i] for i in at], [every.dear[i] for i in at])
    made = _regressed(job, among, sample, np.ones(len(at), dtype=bool))
    others = free(among, chosen)
    if not others.size:
        return made
    left, where = [among.points[i] for i in others], _place([among.points[i] for i in others])
    films = [_films([found[good[point]] for point in left]) for found in (every.cheap, every.dear)]
    errors = _errors(left, where, made.films(films[0], among.places[others], where), films[1])
    return replace(made, witnesses=errors)


def error_of(contact: LineContact, where: Place, films: Films, true: Films) -> dict[str, FloatArray]:
    """Relative errors of `JUDGED`, signed; that of damping over `SMALL_DAMPING` where damping is below it.

    Parameters
    ----------
    contact : LineContact
        The contact, with its structural law.
    where : Place
        Loads, half-widths and speeds.
    films, true : Films
        What is judged, and by what.
    """
    dry = contact.structural_compliance(where.load)
    k, true_k = 1.0 / (dry + films.compliance), 1.0 / (dry + true.compliance)
    c, true_c = films.loss * k**2, true.loss * true_k**2
    scale = np.maximum(true_c, SMALL_DAMPING * true_k * where.width / where.speed)
    return {
        "film_offset": films.offset / true.offset - 1.0,
        "stiffness": k / true_k - 1.0,
        "damping": (c - true_c) / scale,
    }


def quantiles(errors: FloatArray, shares: FloatArray) -> dict[str, float]:
    """Median, 95 % quantile and largest size of errors at points that stand for shares of a range.

    Parameters
    ----------
    errors : array (n,)
        Signed errors.
    shares : array (n,)
        Share of each; they sum to one.
    """
    sizes = np.abs(errors)
    order = np.argsort(sizes)
    reached = np.cumsum(shares[order])
    at = [int(np.searchsorted(reached, level * reached[-1] * (1.0 - 1e-12))) for level in (0.5, 0.95)]
    return {
        "median": float(sizes[order[at[0]]]),
        "95 %": float(sizes[order[at[1]]]),
        "largest": float(sizes[order[-1]]),
    }


def _even(values: FloatArray) -> FloatArray:
    """Equal shares that sum to one."""
    return np.full(values.size, 1.0 / values.size)


def point_words(point: SamplePoint) -> str:
    """Say where a point lies."""
    place = f"{LOAD.text(point.load)}, {SPEED.text(point.speed)}, {TEMPERATURE.text(point.temperature)}"
    return f"{point.contact.name} at {place}"


def _ask(
    sample: _Sample,
    job: Job,
    pair: tuple[ContactSolver, ContactSolver],
    among: Candidates,
    chosen: list[int],
    solve: Callable[[Sequence[LineTask]], Mapping[str, Arrays]],
) -> None:
    """Have both solvers solve some more candidates."""
    tasks = [
        [LineTask(p.contact, job.lubricant, (p.load,), p.speed, p.temperature, solver) for solver in pair]
        for p in (among.points[i] for i in chosen)
    ]
    results = solve([task for both in tasks for task in both])
    sample.chosen += chosen
    sample.cheap += [with_later_fields(results[cheap.key]) for cheap, _ in tasks]
    sample.dear += [with_later_fields(results[dear.key]) for _, dear in tasks]


def _known(arrays: Arrays) -> BoolArray:
    """True where a point has a film that can be corrected, or correct."""
    usable = np.isin(arrays["status"], [int(status) for status in Status if status.usable])
    for name in ("film_offset", "film_compliance", "loss_compliance"):
        usable &= np.isfinite(arrays[name])
    return np.asarray(usable & (arrays["film_offset"] > 0.0))


def _both(sample: _Sample) -> BoolArray:
    """True where both solvers have solved a point."""
    pairs = zip(sample.cheap, sample.dear, strict=True)
    return np.array([bool(_known(cheap)[0] and _known(dear)[0]) for cheap, dear in pairs], dtype=bool)


def _films(results: Sequence[Arrays]) -> Films:
    """Films of single points."""
    names = ("film_offset", "film_compliance", "loss_compliance")
    return Films(*(np.array([float(arrays[name][0]) for arrays in results]) for name in names))


def _place(points: Sequence[SamplePoint]) -> Place:
    """Loads, half-widths and speeds of single points."""
    return Place(
        np.array([p.load for p in points]),
        np.array([_width(p.contact, np.array(p.load)) for p in points]),
        np.array([p.speed for p in points]),
    )


def _width(contact: LineContact, loads: FloatArray) -> FloatArray:
    """Half-widths [m]."""
    return np.asarray(half_width(loads, contact.radius, contact.reduced_modulus))


def _loss(films: Films, where: Place) -> FloatArray:
    """The loss in the coordinate of a backbone."""
    return np.arcsinh(_share(films, where) / LOSS_SCALE)


def _share(films: Films, where: Place) -> FloatArray:
    """The loss q = B u w/(h b)."""
    return np.asarray(films.loss * where.speed * where.load / (films.offset * where.width))


def _doubts(stiffness_share: FloatArray, loss_share: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Doubts of the slope of ln(h) and of the loss: what they are worth in k, and in c as `error_of` relates it.

    Parameters
    ----------
    stiffness_share : array (n,)
        k h/w.
    loss_share : array (n,)
        B u w/(h b).
    """
    smallest = SMALL_DAMPING / stiffness_share
    of_loss = np.sqrt((loss_share**2 + smallest**2) / (loss_share**2 + LOSS_SCALE**2))
    return np.sqrt(1.0 + stiffness_share**-2.0), np.maximum(of_loss, 1.0)


def _applied(
    films: Films, where: Place, value: FloatArray, slope: FloatArray, loss: FloatArray, applied: tuple[bool, bool]
) -> Films:
    """Films with a correction of ln(h), of its slope along zeta, and of the loss, as far as it is to be applied."""
    value, slope, loss = value * applied[0], slope * applied[0], loss * applied[1]
    with np.errstate(invalid="ignore"):
        ratio = np.exp(value)
        offset = ratio * films.offset
        compliance = ratio * films.compliance - offset / where.load * slope
        share = LOSS_SCALE * np.sinh(_loss(films, where) + loss)
    return Films(offset, compliance, share * offset * where.width / (where.load * where.speed))


def _slow_change(task: LineTask, loads: FloatArray, old: Films, new: Films) -> Any:
    """Change of the slow film's response by its correction, complex, shape (n, k) [m2/N].

    To first order in frequency it is that of film and loss compliance. It dies out as a rigid film forgets, since how a
    locked film answers does not depend on how thick it is, in natural frequencies.
    """
    modulus, radius = task.contact.reduced_modulus, task.contact.radius
    compliance = new.compliance - old.compliance
    per_time = [
        film.loss / natural_time(loads, film.offset, task.entrainment_speed, radius, modulus) for film in (old, new)
    ]
    loss = per_time[1] - per_time[0]
    at = 1j * np.array(task.natural_frequencies)
    first = (2.0 * RIGID_MEMORY * compliance - loss)[:, None] * at
    return (compliance[:, None] + first) / (1.0 + RIGID_MEMORY * at) ** 2


def _regressions(among: Candidates, sample: _Sample, both: BoolArray) -> tuple[Regression, Regression]:
    """Regressions of film offset and loss, over the points that both solvers have solved."""
    kept = np.flatnonzero(both)
    chosen = [sample.chosen[i] for i in kept]
    cheap, dear = (_films([results[i] for i in kept]) for results in (sample.cheap, sample.dear))
    where, places = _place([among.points[i] for i in chosen]), among.places[chosen]
    slopes = [films.compliance * where.load / films.offset for films in (cheap, dear)]
    largest = np.maximum(np.abs(_share(cheap, where)), np.abs(_share(dear, where)))
    of_slope, of_loss = _doubts(among.stiffness_shares[chosen], largest)
    value, slope, stretched = np.log(dear.offset / cheap.offset), slopes[0] - slopes[1], per_zeta(places)
    sure = np.ones(value.size)
    offset = Regression.fitted(places, among.ranges, value, sure, slope / stretched, of_slope / stretched)
    loss = Regression.fitted(places, among.ranges, _loss(dear, where) - _loss(cheap, where), of_loss)
    return offset, loss


def _next(among: Candidates, sample: _Sample, both: BoolArray, size: int) -> list[int]:
    """The next points: where what is not known, and was told too small nearby, is largest."""
    solved = [among.places[i] for i, known in zip(sample.chosen, both, strict=True) if known]
    tried = among.places[[i for i, known in zip(sample.chosen, both, strict=True) if not known]]
    nearest = among.nearest(np.array(solved))
    offset, loss = _regressions(among, sample, both)
    weights = [0.5 + 0.5 * one.left_out.squares[nearest] for one in (offset, loss)]
    weights[1] /= loss.doubts[nearest] ** 2
    if len(tried):
        offset, loss = offset.and_at(tried), loss.and_at(tried)
    chosen: list[int] = []
    for _ in range(size):
        spread = offset.spread(among.places)
        of_offset = spread[:, 0, 0] + (among.stiffness_shares * per_zeta(among.places)) ** 2 * spread[:, 1, 1]
        unknown = weights[0] * of_offset + weights[1] * loss.spread(among.places)[:, 0, 0]
        open_ones = free(among, [*sample.chosen, *chosen])
        chosen.append(int(open_ones[np.argmax(unknown[open_ones])]))
        here = among.places[chosen[-1:]]
        offset, loss = offset.and_at(here), loss.and_at(here)
    return chosen


def _farthest(among: Candidates, sample: _Sample, size: int) -> list[int]:
    """The next points where nothing can be regressed yet: far from all that were asked."""
    chosen: list[int] = []
    for _ in range(size):
        taken = [*sample.chosen, *chosen]
        apart = np.min(np.sum((among.scaled[:, None] - among.scaled[taken][None]) ** 2, axis=2), axis=1)
        chosen.append(int(np.argmax(apart)))
    return chosen


def _regressed(job: Job, among: Candidates, sample: _Sample, both: BoolArray) -> Correction:
    """The correction from all points."""
    kept = np.flatnonzero(both)
    chosen = [sample.chosen[i] for i in kept]
    points, places = [among.points[i] for i in chosen], among.places[chosen]
    cheap, dear = (_films([results[i] for i in kept]) for results in (sample.cheap, sample.dear))
    where = _place(points)
    offset, loss = _regressions(among, sample, both)
    without = offset.left_out
    before, shares = _errors(points, where, cheap, dear), among.shares(places)

    def left_out(applied: tuple[bool, bool]) -> dict[str, FloatArray]:
        slope = without.slope * per_zeta(places)
        predicted = _applied(cheap, where, without.value, slope, loss.left_out.value, applied)
        return _errors(points, where, predicted, dear)

    def better(new: tuple[bool, bool], old: tuple[bool, bool], names: tuple[str, ...], freedom: float) -> bool:
        # By size and by square, since one point far off decides the one, and many that agree by chance the other; a
        # damping that is wrong altogether is not worse for being so by ten times itself.
        sizes = [np.minimum(np.abs([left_out(applied)[name] for name in names]), 1.0) for applied in (new, old)]
        squares = [freedom * sizes[0] ** 2, sizes[1] ** 2]
        means = [[float(np.sum(errors**power @ shares)) for power in (0.5, 1.0)] for errors in squares]
        return means[0][0] < means[1][0] and means[0][1] < means[1][1]

    of_films = better((True, False), (False, False), JUDGED[:2], offset.freedom)
    of_loss = better((of_films, True), (of_films, False), JUDGED[2:], loss.freedom)
    also = {}
    for name in ALSO:
        pair = [np.array([float(results[i][name][0]) for i in kept]) for results in (sample.cheap, sample.dear)]
        if all(np.all(np.isfinite(values) & (values > 0.0)) for values in pair):
            also[name] = Regression.fitted(places, among.ranges, np.log(pair[1] / pair[0]), np.ones(len(kept)))
    statuses, reasons = zip(*(_ended(*pair) for pair in zip(sample.cheap, sample.dear, strict=True)), strict=True)
    return Correction(
        points=tuple(among.points[i] for i in sample.chosen),
        statuses=statuses,
        reasons=reasons,
        seconds=float(sum(np.nansum(arrays["solve_seconds"]) for arrays in sample.dear)),
        offset=offset,
        loss=loss,
        also=also,
        applied=(of_films, of_loss),
        before=before,
        left_out=left_out((of_films, of_loss)),
        shares=shares,
    )


def _errors(points: Sequence[SamplePoint], where: Place, films: Films, true: Films) -> dict[str, FloatArray]:
    """Errors at points of several contacts."""
    errors = {name: np.empty(len(points)) for name in JUDGED}
    for contact in {point.contact for point in points}:
        here = np.array([point.contact == contact for point in points])
        at = Place(where.load[here], where.width[here], np.asarray(where.speed)[here])
        for name, values in error_of(contact, at, *(Films(*(v[here] for v in f)) for f in (films, true))).items():
            errors[name][here] = values
    return errors


def _ended(cheap: Arrays, dear: Arrays) -> tuple[Status, str]:
    """Status and reason of a point: of the dearer solver, or where that has solved it, of the cheaper one."""
    for arrays, whose in ((dear, ""), (cheap, "by the solver of the map: ")):
        status = Status(int(arrays["status"][0]))
        if not status.usable:
            return status, f"{whose}{arrays['reason'][0]}"
        if not _known(arrays)[0]:
            return Status.OUTSIDE_VALIDITY, f"{whose}no positive film offset"
    return Status(int(dear["status"][0])), ""


def _too_few(cheap: ContactSolver, dear: ContactSolver, among: Candidates, sample: _Sample, both: BoolArray) -> str:
    """Reason why there is no correction."""
    causes = Counter(
        (status.word, reason)
        for pair, solved in zip(zip(sample.cheap, sample.dear, strict=True), both, strict=True)
        if not solved
        for status, reason in [_ended(*pair)]
    )
    first = next((i for i, solved in zip(sample.chosen, both, strict=True) if not solved), None)
    where = f", the first {point_words(among.points[first])}" if first is not None else ""
    listed = "; ".join(f"{n} {word}{': ' if reason else ''}{reason}" for (word, reason), n in causes.most_common(3))
    return (
        f"correction of {cheap.name} by {dear.name}: {np.count_nonzero(both)} of {both.size} points have a solution by "
        f"both; at least {FEWEST} are needed{where}{'; ' if listed else ''}{listed}; no map is written, and all that "
        "was solved is kept; change the keys of [correction], ask for more correction_points, or delete corrected_by"
    )

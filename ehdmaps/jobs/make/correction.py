"""Films of one solver corrected by a few points of a dearer one.

What is corrected is a smooth function of the places of `correction_design`, through what the two solvers say of points
that fill the range of the job:

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
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.errors import MapError
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.make.correction_design import Candidates, candidates, per_zeta, places_of, spread_out, usable
from ehdmaps.jobs.make.law_check import SMALL_DAMPING
from ehdmaps.jobs.make.sampling import SamplePoint
from ehdmaps.jobs.make.store import Arrays
from ehdmaps.jobs.make.tasks import SPECTRUM_FIELDS, LineTask, with_later_fields
from ehdmaps.jobs.smooth import Smooth
from ehdmaps.maps.backbone import LOSS_SCALE
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width, natural_time
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolver, Status, usable_points
from ehdmaps.units import point_text

FEWEST = 4
"""Points with a solution by both solvers that a correction needs."""

MOST_OWN = 64
"""Points of a map that correct its lines, at most: more hardly change a difference that is smooth."""

FILMS = ("film_offset", "film_compliance", "loss_compliance")
"""The fields of `Films`, as a map has them."""

ALSO = ("central_film", "minimum_film", "rolling_force", "mass_flow")
"""Positive quantities that are corrected besides, where both solvers have them."""

_USED = (*FILMS, *ALSO, "status", "reason", "solve_seconds")

JUDGED = ("film_offset", "stiffness", "damping")
"""Of what errors are told."""

RIGID_MEMORY = 0.946
"""Natural time after which a rigid film has followed, over sqrt(b^2 + 2 h R)/u: S = s/(1 + 0.946 i omega T)."""


class Films(NamedTuple):
    """Film offset [m], film compliance [m2/N] and loss compliance [m2 s/N] of some points."""

    offset: FloatArray
    compliance: FloatArray
    loss: FloatArray

    @classmethod
    def of(cls, arrays: Mapping[str, Any]) -> Films:
        """Films of a line of points."""
        return cls(*(np.asarray(arrays[name]) for name in FILMS))


class Place(NamedTuple):
    """Place of some points: `places_of`, loads [N/m], speeds [m/s], half-widths [m], structural compliances [m2/N]."""

    at: FloatArray
    load: FloatArray
    speed: FloatArray
    width: FloatArray
    dry: FloatArray

    @classmethod
    def of(
        cls, contact: LineContact, lubricant: Lubricant, loads: FloatArray, speed: float, temperature: float
    ) -> Place:
        """The place of a line of loads; arguments as of `places_of`."""
        width = half_width(loads, contact.radius, contact.reduced_modulus)
        at, dry = places_of(contact, lubricant, loads, speed, temperature), contact.structural_compliance(loads)
        return cls(at, loads, np.full(loads.shape, speed), np.asarray(width), np.asarray(dry))


@dataclass(frozen=True, eq=False)
class Correction:
    """Terms to be added to the films of the cheaper solver.

    Attributes
    ----------
    offset, loss : Smooth
        What is added to ln(h), with its slope along s, and to the loss.
    also : mapping of str to Smooth
        What is added to the logarithms of `ALSO`.
    applied : tuple of bool
        Whether film offset and compliance, and the loss, are corrected: only where leaving out points one by one says
        that they are better then, also with what the lengths and noises that were chosen by it make it too small by.
    record : mapping
        What a map keeps of it, in plain values: points that were asked for, how each ended, what was not applied, and
        median, 95 % quantile and largest size of relative errors of `JUDGED` against the dearer solver: at the points
        with a solution `before` the correction, and by `leave_one_out`, each left out of it in turn; each weighed by
        the part of the job's range that is nearest to it. `witnesses` are points that are no part of it.
    """

    offset: Smooth
    loss: Smooth
    also: Mapping[str, Smooth]
    applied: tuple[bool, bool]
    record: Mapping[str, Any]

    def corrected(self, task: LineTask, arrays: Arrays) -> Arrays:
        """The arrays of a task of the cheaper solver with the correction.

        Parameters
        ----------
        task : LineTask
            What was solved.
        arrays : Arrays
            What was found.
        """
        known = _known(arrays)
        if task.entrainment_speed == 0.0 or not known.any():
            return arrays
        loads, films = np.array(task.loads), Films.of(arrays)
        where = Place.of(task.contact, task.lubricant, loads, task.entrainment_speed, task.temperature)
        new_films = self.films(films, where)
        result = dict(arrays)
        for name, old, new in zip(FILMS, films, new_films, strict=True):
            result[name] = np.where(known, new, old)
        for name, one in self.also.items() if self.applied[0] else ():
            if name in arrays:
                result[name] = arrays[name] * np.where(known, np.exp(one.at(where.at)[0]), 1.0)
        if task.natural_frequencies:
            added = _slow_change(task, loads, films, new_films)
            for name, part in zip(SPECTRUM_FIELDS, (added.real, added.imag), strict=False):
                result[name] = arrays[name] + np.where(known[:, None], part, 0.0)
        return result

    def films(self, films: Films, where: Place) -> Films:
        """Films with the correction.

        Parameters
        ----------
        films : Films
            Those of the cheaper solver.
        where : Place
            Place of the films.
        """
        return _applied(films, where, self.offset.at(where.at), self.loss.at(where.at)[0], self.applied)

    def model_errors(self, films: Films, where: Place) -> tuple[FloatArray, FloatArray]:
        """Standard deviations of k and of c from those of the dearer solver, relative.

        Parameters
        ----------
        films : Films
            Corrected films.
        where : Place
            Place of the films.
        """
        per_load = films.offset / where.load
        steep = films.compliance / per_load
        offset, loss = (
            # What is not applied is unknown as far as it was found.
            one.spread(where.at, doubts) + (0.0 if applied else np.einsum("am,bm->mab", *[one.at(where.at)] * 2))
            for one, doubts, applied in zip((self.offset, self.loss), _doubts(films, where), self.applied, strict=True)
        )
        to_zeta = np.column_stack([np.ones(where.load.shape), per_zeta(where.at)])
        offset = offset * to_zeta[:, :, None] * to_zeta[:, None, :]
        of_compliance = per_load**2 * (steep**2 * offset[:, 0, 0] - 2.0 * steep * offset[:, 0, 1] + offset[:, 1, 1])
        of_stiffness = np.maximum(of_compliance, 0.0) / (where.dry + films.compliance) ** 2
        with np.errstate(divide="ignore", invalid="ignore"):
            of_loss = (1.0 + (LOSS_SCALE / _share(films, where)) ** 2) * loss[:, 0, 0] + offset[:, 0, 0]
        return np.sqrt(of_stiffness), np.sqrt(of_loss + 4.0 * of_stiffness)


def correction(
    job: Job,
    cheap: ContactSolver,
    dear: ContactSolver,
    count: int,
    solve: Callable[[Sequence[LineTask]], Mapping[str, Arrays]],
) -> Correction:
    """Have both solvers solve points that fill the range of the job, and correct the one by the other.

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
    points = [among.points[i] for i in spread_out(among, count)]
    tasks = [
        [LineTask(p.contact, job.lubricant, (p.load,), p.speed, p.temperature, solver) for p in points]
        for solver in (cheap, dear)
    ]
    found = solve([*tasks[0], *tasks[1]]) if points else {}
    results = [_joined([found[task.key] for task in ones]) for ones in tasks]
    if np.count_nonzero(_known(results[0]) & _known(results[1])) < FEWEST:
        raise MapError(f"correction of {cheap.name} by {dear.name}: {_too_few(points, *results)}")
    return _fitted(job, among, points, *results)


def correction_by_points(
    job: Job, points: Sequence[SamplePoint], cheap: Sequence[Arrays], dear: Sequence[Arrays]
) -> Correction | None:
    """Correct one solver by points that both were asked for anyway; None with too few solutions.

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
    results = [_joined(found) for found in (cheap, dear)]
    good = {points[i]: i for i in np.flatnonzero(_known(results[0]) & _known(results[1])).tolist()}
    among = usable(job, tuple(good))
    if len(among.points) < FEWEST:
        return None
    chosen = spread_out(among, MOST_OWN)
    own, others = (
        [among.points[i] for i in some] for some in (chosen, np.setdiff1d(np.arange(len(among.points)), chosen))
    )
    made = _fitted(job, among, own, *(_at(found, [good[point] for point in own]) for found in results))
    if not others:
        return made
    where = _places(job, others)
    films, true = (Films.of(_at(found, [good[point] for point in others])) for found in results)
    errors = error_of(where, made.films(films, where), true)
    return replace(made, record={**made.record, "witnesses": quantiles(errors)})


def error_of(where: Place, films: Films, true: Films) -> dict[str, FloatArray]:
    """Relative errors of `JUDGED`, signed; that of damping over `SMALL_DAMPING` where damping is below it.

    Parameters
    ----------
    where : Place
        Place of the films.
    films, true : Films
        What is judged, and by what.
    """
    k, true_k = 1.0 / (where.dry + films.compliance), 1.0 / (where.dry + true.compliance)
    c, true_c = films.loss * k**2, true.loss * true_k**2
    scale = np.maximum(true_c, SMALL_DAMPING * true_k * where.width / where.speed)
    return {
        "film_offset": films.offset / true.offset - 1.0,
        "stiffness": k / true_k - 1.0,
        "damping": (c - true_c) / scale,
    }


def quantiles(errors: Mapping[str, FloatArray], shares: FloatArray | None = None) -> dict[str, dict[str, float]]:
    """Median, 95 % quantile and largest size of errors at points that stand for shares of a range.

    Parameters
    ----------
    errors : mapping of str to array (n,)
        Signed errors.
    shares : array (n,), optional
        Share of each point; they sum to one. Equal ones if left out.
    """
    levels, found = {"median": 0.5, "95 %": 0.95, "largest": 1.0}, {}
    for name, signed in errors.items():
        order = np.argsort(np.abs(signed))
        reached = np.cumsum(np.full(signed.size, 1.0 / signed.size) if shares is None else shares[order])
        at = np.searchsorted(reached, np.array(list(levels.values())) * reached[-1] * (1.0 - 1e-12))
        found[name] = dict(zip(levels, np.abs(signed)[order][at].tolist(), strict=True))
    return found


def _joined(results: Sequence[Arrays]) -> Arrays:
    """Results of points one by one, as those of one line."""
    found = [with_later_fields(one) for one in results]
    return (
        {name: np.concatenate([one[name] for one in found]) for name in _USED}
        if found
        else dict.fromkeys(_USED, np.empty(0))
    )


def _at(arrays: Arrays, indices: Sequence[int] | BoolArray) -> Arrays:
    """Some of the points of a line."""
    return {name: values[indices] for name, values in arrays.items()}


def _places(job: Job, points: Sequence[SamplePoint]) -> Place:
    """Place of points one by one."""
    rows = [Place.of(p.contact, job.lubricant, np.array([p.load]), p.speed, p.temperature) for p in points]
    return Place(*(np.concatenate(values) for values in zip(*rows, strict=True)))


def _known(arrays: Arrays) -> BoolArray:
    """True where a point has a film that can be corrected, or correct."""
    finite = np.all(np.isfinite(Films.of(arrays)), axis=0)
    return np.asarray(usable_points(arrays["status"]) & finite & (arrays["film_offset"] > 0.0))


def _share(films: Films, where: Place) -> FloatArray:
    """The loss q = B u w/(h b)."""
    return np.asarray(films.loss * where.speed * where.load / (films.offset * where.width))


def _loss(films: Films, where: Place) -> FloatArray:
    """The loss in the coordinate of a backbone."""
    return np.arcsinh(_share(films, where) / LOSS_SCALE)


def _doubts(films: Films, where: Place) -> tuple[FloatArray, FloatArray]:
    """Doubts of ln(h) and its slope along s, (2, n), and of the loss, (1, n): what they are worth in k and c."""
    stiffness_share = films.offset / where.load / (where.dry + films.compliance)
    of_slope = np.sqrt(1.0 + stiffness_share**-2.0) / per_zeta(where.at)
    square = _share(films, where) ** 2
    of_loss = np.sqrt((square + (SMALL_DAMPING / stiffness_share) ** 2) / (square + LOSS_SCALE**2))
    return np.array([np.ones(of_slope.shape), of_slope]), np.maximum(of_loss, 1.0)[None]


def _applied(films: Films, where: Place, offset: FloatArray, loss: FloatArray, applied: Sequence[bool]) -> Films:
    """Films with a correction of ln(h) and its slope along s, (2, n), and of the loss, as far as it is applied."""
    (value, slope), loss = offset * applied[0], loss * applied[1]
    with np.errstate(invalid="ignore"):
        thicker = np.exp(value) * films.offset
        compliance = np.exp(value) * films.compliance - thicker / where.load * slope * per_zeta(where.at)
        share = LOSS_SCALE * np.sinh(_loss(films, where) + loss)
    return Films(thicker, compliance, share * thicker * where.width / (where.load * where.speed))


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


def _ends(points: Sequence[SamplePoint], cheap: Arrays, dear: Arrays) -> list[dict[str, Any]]:
    """End of each point: by the dearer solver, or where that has solved it, by the cheaper one."""
    told = []
    for i, point in enumerate(points):
        status, reason = Status(int(dear["status"][i])), ""
        for arrays, whose in ((cheap, "by the solver of the map: "), (dear, "")):
            one = Status(int(arrays["status"][i]))
            if not one.usable:
                status, reason = one, f"{whose}{arrays['reason'][i]}"
            elif not _known(arrays)[i]:
                status, reason = Status.OUTSIDE_VALIDITY, f"{whose}no positive film offset"
        place = {"load": point.load, "entrainment_speed": point.speed, "temperature": point.temperature}
        end = {"status": status.word, **({"reason": reason} if reason else {})}
        told.append({"contact": point.contact.name, **place, **end})
    return told


def _too_few(points: Sequence[SamplePoint], cheap: Arrays, dear: Arrays) -> str:
    """Reason why there is no correction."""
    solved, ends = _known(cheap) & _known(dear), _ends(points, cheap, dear)
    lost = [i for i in range(len(points)) if not solved[i]]
    where = "".join(f", the first {points[i].contact.name} at {point_text(*points[i][1:])}" for i in lost[:1])
    causes = Counter(": ".join(filter(None, (ends[i]["status"], ends[i].get("reason")))) for i in lost)
    listed = "".join(f"; {count} {cause}" for cause, count in causes.most_common(3))
    return (
        f"{np.count_nonzero(solved)} of {solved.size} points have a solution by both; at least {FEWEST} are needed"
        f"{where}{listed}; no map is written, and all that was solved is kept; change the keys of [correction], ask "
        "for more correction_points, or delete corrected_by"
    )


def _fitted(job: Job, among: Candidates, points: Sequence[SamplePoint], cheap: Arrays, dear: Arrays) -> Correction:
    """The correction from all points."""
    solved = _known(cheap) & _known(dear)
    where = _places(job, [point for point, known in zip(points, solved, strict=True) if known])
    found = [_at(arrays, solved) for arrays in (cheap, dear)]
    old, new = map(Films.of, found)

    of_offset, of_loss = _doubts(old._replace(loss=np.maximum(np.abs(old.loss), np.abs(new.loss))), where)
    slope = (old.compliance / old.offset - new.compliance / new.offset) * where.load / per_zeta(where.at)
    observed = np.array([np.log(new.offset / old.offset), slope])
    offset = Smooth.fitted(where.at, among.ranges, observed, of_offset)
    loss = offset.alike((_loss(new, where) - _loss(old, where))[None], of_loss)
    both = {name: np.array([arrays[name] for arrays in found]) for name in ALSO}
    also = {
        name: offset.alike(np.log(values[1:] / values[:1]), of_offset[:1])
        for name, values in both.items()
        if np.all(np.isfinite(values) & (values > 0.0))
    }
    shares = among.shares(where.at)

    def left_out(*applied: bool) -> dict[str, FloatArray]:
        return error_of(where, _applied(old, where, offset.left_out, loss.left_out[0], applied), new)

    def better(
        one: Mapping[str, FloatArray], other: Mapping[str, FloatArray], names: Sequence[str], by: Smooth
    ) -> bool:
        # By size and by square, since one point far off decides the one, and many that agree by chance the other; a
        # damping that is wrong altogether is not worse for being so by ten times itself.
        sizes = [np.minimum(np.abs([errors[name] for name in names]), 1.0) for errors in (one, other)]
        means = [[float(np.sum(size**power @ shares)) for power in (1, 2)] for size in sizes]
        return means[0][0] * by.freedom**0.5 < means[1][0] and means[0][1] * by.freedom < means[1][1]

    films = better(left_out(True, False), left_out(False, False), JUDGED[:2], offset)
    applied = films, better(left_out(films, True), left_out(films, False), JUDGED[2:], loss)
    record = {
        "asked": len(points),
        "usable": where.load.size,
        "solve_seconds": float(np.nansum(dear["solve_seconds"])),
        "not_applied": [name for name, used in zip(FILMS[::2], applied, strict=True) if not used],
        "before": quantiles(error_of(where, old, new), shares),
        "leave_one_out": quantiles(left_out(*applied), shares),
        "points": _ends(points, cheap, dear),
    }
    return Correction(offset, loss, also, applied, record)

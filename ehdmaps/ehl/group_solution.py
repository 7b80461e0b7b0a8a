"""The equations to first order about a profile, whose grid follows the spike and begins at a meniscus that is held."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.compiled import njit
from ehdmaps.ehl.grid import zone_width
from ehdmaps.ehl.limits import Resolution
from ehdmaps.ehl.linearisation import GridShift, Linearisation, Neighbour, Response, linearised
from ehdmaps.ehl.newton import CONVERGED, STAGNATED
from ehdmaps.ehl.profile import Profile, front, front_node
from ehdmaps.ehl.warm_response import WarmLinearisation, warm_linearised
from ehdmaps.ehl.ways import LOAD
from ehdmaps.physics.isotherm import Isotherm, log_viscosity
from ehdmaps.physics.rheology import LIMITING, NEWTONIAN
from ehdmaps.physics.solution import UNKNOWN, Estimate, peak_sampling_error

SPIKE_SHIFT = 1e-4
"""Shift of the spike, in its widths, over which the effect of the grid's motion is differenced."""

LENGTH_SHIFT = 1e-5
"""Change of a starved inlet's length over which the effect of its end is differenced, relative to the length, or to the
film where that is less: nodes that move by more change the gap of a thin film."""


def linearised_profile(profile: Profile, follows: bool = True) -> Linearisation | WarmLinearisation:
    """The equations to first order about a profile, its grid following the spike where there is one.

    The meniscus of a starved contact is held where it is.

    Parameters
    ----------
    profile : Profile
        A converged solution.
    follows : bool
        Whether the grid follows the spike; else it stands still.
    """
    neighbour, longer = None, None
    spike, laid = profile.spike, profile.layout
    if spike is not None and follows:
        shift = SPIKE_SHIFT * spike.width
        neighbour = Neighbour(laid.with_moved_spike(shift).grid(profile.cells), shift, front_node(profile))
    if profile.warmth is not None:
        rises, first = profile.warmth.rises, profile.warmth.first
        return warm_linearised(profile.problem, profile.grid, profile.unknowns, rises, first, LOAD, neighbour)
    if laid.starved:
        shift = LENGTH_SHIFT * min(laid.length, laid.film)
        longer = GridShift(replace(laid, length=laid.length + shift).grid(profile.cells), shift)
    return linearised(profile.problem, profile.grid, profile.kernel, profile.unknowns, LOAD, neighbour, longer)


FOURTH, THIRD, SECOND = 1.5 / 15.0, 1.5 / 7.0, 1.5 / 3.0
"""Share of the difference between both grids that is left where the order p is four, three or two: 1/(2^p - 1), and
half as much again for safety."""

FIRST_ORDER = 1.5
"""Share of the difference between both grids that is left where the order is one, half as much again for safety."""

FILM_LOST, COMPLIANCE_LOST, LOSS_LOST, ROLLING_GAINED = 3.0, 6.0, 7.5, 1.5
"""Bounds of what an inlet of X film lengths takes away of film and mass flow, film compliance and loss, or adds to the
rolling force, in 1/X^2. Of a rigid film, of which it takes most, it is 2.47, 4.95, 6.25 and 1.22."""

STEEP = 0.2
"""Fall of pressure at the exit, in p_H per width of its zone, above which an oil that is not Newtonian has kinks there:
a third of what gives a spike cells of its own, see `Resolution.spike_steepness`."""

YIELDS, PLUG = 0.99, 0.8
"""Part of its limiting stress from which on oil counts as yielding by sliding, and part of the load carried by such oil
from which on a film counts as a plug. Film offsets of plugs have orders of 2.3 to 4, others of thin films four."""

_log_viscosity = njit(log_viscosity)

_TIPS = 199
"""Steps up to `MOST_TIP` between which ln eta is taken as straight."""

MOST_TIP = 5.0
"""Pressure of a tip over that of its cell to which an estimate goes: an oil with a largest viscosity has no limit."""


@dataclass(frozen=True)
class GroupSolution:
    """Film of one point in units of b, p_H, b^2/R and b/u, each number with its estimated error.

    The rolling force has the unit p_H b^2/R, the mass flow b^2/R times density at rest and u. Rises are those of the
    highest temperatures in the film and of its surfaces [K], NaN of an isothermal film; their errors are in K.
    Errors of film offset, film compliance and loss are positive where the value is too large, the others always.
    `profile` is the fine solution and `rough` the coarse one, `linear` and `rough_linear` the equations about them;
    None where there is none.
    """

    outcome: int
    profile: Profile | None
    rough: Profile | None = None
    linear: Linearisation | WarmLinearisation | None = None
    rough_linear: Linearisation | WarmLinearisation | None = None
    film_offset: Estimate = UNKNOWN
    film_compliance: Estimate = UNKNOWN
    loss: Estimate = UNKNOWN
    central_film: Estimate = UNKNOWN
    minimum_film: Estimate = UNKNOWN
    max_pressure: Estimate = UNKNOWN
    rolling_force: Estimate = UNKNOWN
    mass_flow: Estimate = UNKNOWN
    film_rise: float = math.nan
    surface_rise: float = math.nan
    film_rise_error: float = math.nan
    surface_rise_error: float = math.nan
    steps: int = 0


def assembled(
    M: float,
    L: float,
    fine: Profile,
    coarse: Profile,
    resolution: Resolution,
    steps: int,
    witness: Profile | None = None,
) -> GroupSolution:
    """Response, numbers and error estimates from the fine and the coarse solution.

    Parameters
    ----------
    M, L : float
        Moes' load and lubricant parameters of the point.
    fine, coarse : Profile
        Converged solutions, one with twice the cells of the other.
    resolution : Resolution
        Settings of the solve that gave them.
    steps : int
        Newton steps that they took.
    witness : Profile, optional
        The coarse solution with other points across the film, of one with temperatures: their error is added.
    """
    linear, rough_linear = linearised_profile(fine), linearised_profile(coarse)
    if linear.singular or rough_linear.singular:
        return GroupSolution(outcome=STAGNATED, profile=None, steps=steps)
    response, rough = linear.slow_response(), rough_linear.slow_response()
    starved = fine.layout.starved
    # the pressure rises from a meniscus with a kink, where sums are of second order
    by_offset = SECOND if starved else THIRD if _plug(fine) else _offset_share(M, fine.spike is not None)
    by_response = SECOND if starved else max(response_share(M, L, fine.spike is not None), _sliding_share(fine))
    inlet = 0.0 if starved else 1.0 / resolution.inlet**2
    central, minimum = fine.measures[:2]
    # the coarse grid of a starved contact has the same part of its own flooded flow; films go with the layer
    scale = fine.mass_flow / coarse.mass_flow if starved else 1.0
    central_error, minimum_error = _film_errors(fine, coarse, scale, by_offset)

    def estimate(
        value: float, rough_value: float, share: float, lost: float, least: float = 0.0, front: float = 0.0
    ) -> Estimate:
        """The value with its error, > 0 where refinement lowers it.

        `least` is a difference of grids that this value shares at least, `lost` what the inlet's end takes away, and
        `front` what a front adds.
        """
        grid = (rough_value - value) * share / value
        size = max(abs(grid), abs(least * share / value)) + abs(front / value)
        return Estimate(value, _with_inlet(math.copysign(size, grid), lost * inlet))

    # parts of one complex number: where a spike between two nodes hides the error of the loss, the compliance shows it
    hidden = rough.compliance - response.compliance if fine.spike is not None or starved else 0.0
    hidden_too = rough.loss - response.loss if starved else 0.0
    fronts = [
        _front_error(each, of, its) for each, of, its in ((fine, linear, response), (coarse, rough_linear, rough))
    ]
    at_front = _Front(*(max(values) for values in zip(*fronts, strict=True)))
    # of the coarse grid half a cell, which is one of the fine grid
    held = max(fronts[0].offset, 0.5 * fronts[1].offset)
    by_front = held / abs(fine.film_offset)
    film_error, surface_error = _rise_errors(fine, coarse)
    flow_error = 0.0 if starved else abs(estimate(fine.mass_flow, coarse.mass_flow, FOURTH, FILM_LOST).error)
    solution = GroupSolution(
        outcome=CONVERGED,
        profile=fine,
        rough=coarse,
        linear=linear,
        rough_linear=rough_linear,
        film_offset=estimate(fine.film_offset, scale * coarse.film_offset, by_offset, FILM_LOST, front=held),
        film_compliance=estimate(
            response.compliance, rough.compliance, by_response, COMPLIANCE_LOST, hidden_too, at_front.compliance
        ),
        loss=estimate(response.loss, rough.loss, by_response, LOSS_LOST, hidden, at_front.loss),
        central_film=Estimate(central, central_error + by_front + FILM_LOST * inlet),
        minimum_film=Estimate(minimum, minimum_error + by_front + FILM_LOST * inlet),
        max_pressure=Estimate(np.max(fine.pressure), _peak_error(fine, coarse)),
        rolling_force=Estimate(fine.rolling_force, _rolling_error(fine, coarse) + ROLLING_GAINED * inlet),
        mass_flow=Estimate(fine.mass_flow, flow_error),
        film_rise=math.nan if fine.warmth is None else float(np.max(fine.warmth.rises)),
        surface_rise=math.nan if fine.warmth is None else float(np.max(fine.warmth.rises[:, [0, -1]])),
        film_rise_error=film_error,
        surface_rise_error=surface_error,
        steps=steps,
    )
    if witness is None:
        return solution
    return _with_error_across(solution, coarse, rough, witness)


POINTS_ORDER = 3.0
"""Order of what the points across a film leave of its numbers."""


def points_share(points: int, others: int) -> float:
    """Share of the difference between films with some points across and with others that is left with the former.

    Half as much again for safety as the order says of the one with more points.

    Parameters
    ----------
    points, others : int
        Points across.
    """
    ratio = max(points, others) / min(points, others)
    left = float(1.5 / (ratio**POINTS_ORDER - 1.0))
    return left if points > others else 1.0 + left


def left_across(profile: Profile, witness: Profile) -> float:
    """Relative error of a film offset by the points across the film, always positive.

    Parameters
    ----------
    profile, witness : Profile
        Two solutions on the same grid with temperatures at different points across.
    """
    share = points_share(profile.points, witness.points)
    return share * abs(witness.film_offset / profile.film_offset - 1.0)


def _with_error_across(
    solution: GroupSolution, profile: Profile, response: Response, witness: Profile
) -> GroupSolution:
    """The same with the errors of its points across, from those of the coarse solution and its witness."""
    other = linearised_profile(witness).slow_response()
    share = points_share(profile.points, witness.points)
    towards = 1.0 if profile.points < witness.points else -1.0

    def signed(value: Estimate, here: float, there: float) -> Estimate:
        """A number with what the points leave of it in its error, > 0 where the value is too large."""
        stated, left = value.error, towards * share * (here - there) / value
        return Estimate(value, math.copysign(abs(stated) + abs(left), stated if abs(stated) > abs(left) else left))

    def sized(value: Estimate, here: float, there: float) -> Estimate:
        """The same without the sign of the error."""
        return Estimate(value, abs(signed(value, here, there).error))

    def added_rise(name: str, where: slice | list[int]) -> float:
        """Stated error of a rise of temperature with what the points leave of it [K]."""
        here, there = (float(np.max(each.warmth.rises[:, where])) for each in (profile, witness) if each.warmth)
        return float(getattr(solution, f"{name}_error")) + share * abs(here - there)

    (central, minimum), (other_central, other_minimum) = (each.measures[:2] for each in (profile, witness))
    peak, other_peak = (float(np.max(each.pressure)) for each in (profile, witness))
    return replace(
        solution,
        film_offset=signed(solution.film_offset, profile.film_offset, witness.film_offset),
        film_compliance=signed(solution.film_compliance, response.compliance, other.compliance),
        loss=signed(solution.loss, response.loss, other.loss),
        central_film=sized(solution.central_film, central, other_central),
        minimum_film=sized(solution.minimum_film, minimum, other_minimum),
        max_pressure=sized(solution.max_pressure, peak, other_peak),
        rolling_force=sized(solution.rolling_force, profile.rolling_force, witness.rolling_force),
        mass_flow=sized(solution.mass_flow, profile.mass_flow, witness.mass_flow),
        film_rise_error=added_rise("film_rise", slice(None)),
        surface_rise_error=added_rise("surface_rise", [0, -1]),
    )


class _Front(NamedTuple):
    """Errors by the front of an oil that yields, without signs: of compliance, loss and film offset."""

    compliance: float
    loss: float
    offset: float


def _front_error(profile: Profile, linear: Linearisation | WarmLinearisation, response: Response) -> _Front:
    """Errors by the front of an oil that yields; zero of others.

    The oil yields over many cells before the spike and stops within one: where that happens between two nodes is chance
    on both grids, which may agree by chance. In the limit of fine grids neither film nor response depend on how the
    grid stands: so what the response changes where the grid does not follow is what the front has not resolved. The
    same over how far the front moves by load is what the film changes where the grid moves: a cell may be wrong.
    """
    if profile.spike is None or profile.problem.shear.form != LIMITING:
        return _Front(0.0, 0.0, 0.0)
    standing = linearised_profile(profile, follows=False).slow_response()
    changed = abs(standing.compliance - response.compliance)
    state = linear.static() if isinstance(linear, WarmLinearisation) else linear.solve(linear.unit)
    moves, x, cell_at = abs(float(state[linear.height + 1])), profile.grid.x, profile.front_cell
    cell = float(x[cell_at + 1] - x[cell_at])
    return _Front(changed, abs(standing.loss - response.loss), changed * cell / moves if moves > 0.0 else 0.0)


def _sliding_share(profile: Profile) -> float:
    """Share of the difference of both grids that is left as error of the response where sliding makes the oil yield.

    The ends of that are narrower than a cell: order two, and one where no heat smooths them. Zero of other films.
    """
    problem = profile.problem
    if profile.spike is None or problem.shear.form != LIMITING or problem.slide == 0.0:
        return 0.0
    return FIRST_ORDER if profile.warmth is None else SECOND


def _rise_errors(fine: Profile, coarse: Profile) -> tuple[float, float]:
    """Errors of the highest temperatures of film and surfaces [K]; NaN of an isothermal film.

    The difference of both grids to first order, and what may stand between two faces: how far the hottest one is above
    the cooler one beside it.
    """
    if fine.warmth is None or coarse.warmth is None:
        return math.nan, math.nan
    errors = []
    for here in (slice(None), [0, -1]):
        hottest, rough = (each.warmth.rises[:, here].max(axis=1) for each in (fine, coarse) if each.warmth is not None)
        at = int(np.argmax(hottest))
        beside = min(hottest[max(at - 1, 0)], hottest[min(at + 1, hottest.size - 1)])
        errors.append(float(FIRST_ORDER * abs(hottest[at] - rough.max()) + hottest[at] - beside))
    return errors[0], errors[1]


def _unresolved(profile: Profile) -> bool:
    """True where an oil that is not Newtonian has a steep front behind the Hertz zone, without cells of its own.

    Its stress bounds the fall of the pressure there, and where that begins and ends the pressure has kinks. A Newtonian
    film whose pressure falls as much gets cells for its spike, or carries them over from a lighter load.
    """
    if profile.spike is not None or profile.problem.shear.form == NEWTONIAN:
        return False
    return front(profile)[1] * zone_width(profile.layout.film) > STEEP


def _plug(profile: Profile) -> bool:
    """True where sliding makes a plug of most of a film without cells of its own at the ends of that.

    There the oil begins and ceases to yield within a cell, at the inlet too, which makes the film. Both grids agree by
    chance then.
    """
    law = profile.problem.shear
    if profile.spike is not None or law.form != LIMITING or profile.problem.slide == 0.0:
        return False
    middle = 0.5 * (profile.pressure[1:] + profile.pressure[:-1])
    carried = np.maximum(middle, 0.0) * profile.grid.face_step
    yielding = np.abs(profile.stresses[0]) >= YIELDS * (law.stress + law.ratio * middle)
    return float(carried[yielding].sum()) > PLUG * float(carried.sum())


def _with_inlet(grid: float, lost: float) -> float:
    """Error of cells, with its sign, and of an inlet that ends: the latter lowers a value by up to `lost`.

    Where the cells raise it, the error lies between both, and is no larger than the larger one.
    """
    return max(grid, lost) if grid > 0.0 else grid - lost


def _film_errors(fine: Profile, coarse: Profile, scale: float, share: float) -> tuple[float, float]:
    """Relative errors of the central and the smallest film; `share` is that of the film offset.

    Films of the coarse grid count `scale` times.

    Behind a spike the smallest film follows the spike's place, which is found to first order, and it moves with the
    whole film, to second order.
    """
    (central, minimum), (rough, rough_minimum) = fine.measures[:2], coarse.measures[:2]
    moved_by, narrowed = abs(scale * rough / central - 1.0), abs(scale * rough_minimum / minimum - 1.0)
    if fine.spike is None and not _unresolved(fine):
        return share * moved_by, share * narrowed
    return share * moved_by, FIRST_ORDER * narrowed + 0.5 * moved_by


_peak_sampling_error = njit(peak_sampling_error)


def _peak_error(fine: Profile, coarse: Profile) -> float:
    """Relative error of the largest pressure, which is that of a node.

    What stands between two nodes; the difference between both grids: of the nodes where there is a spike, whose tip is
    resolved to first order at best, else of the peaks by parabolas, whose order is four; and what the tip of a spike
    may rise above its cell.
    """
    highest, spiked = float(np.max(fine.pressure)), fine.spike is not None
    between = _peak_sampling_error(fine.position, fine.pressure, spiked)
    if spiked:
        apart = abs(float(np.max(coarse.pressure)) / highest - 1.0)
        return between + FIRST_ORDER * apart + max(tip_pressure(fine) / highest - 1.0, 0.0)
    rough = float(np.max(coarse.pressure)) * (1.0 + _peak_sampling_error(coarse.position, coarse.pressure, False))
    return 1.5 * between + 1.5 / 15.0 * abs(rough / highest - 1.0 - between)


def tip_pressure(profile: Profile) -> float:
    """Pressure that the tip of a spike may have above the cell that holds it [p_H].

    Before a spike the oil is a plug, behind it Q = Int dP/eta falls with the square of the distance x, so that there
    ln eta ~ -2 ln x, and upstream about -ln x. This goes on down to x = 1/sqrt(pi lambda eta/H^3), where the flow by
    pressure in the plug is what the film behind takes: with -ln x from the cell to the tip, ln eta rises from that of
    the highest node of the front by twice the logarithm of the cell over that width. An estimate of size, not a bound.

    Parameters
    ----------
    profile : Profile
        A solution with a spike.
    """
    law, wedge = profile.problem.isotherm, profile.problem.wedge
    return float(_tip(law, wedge, profile.pressure, profile.grid.x, profile.film, profile.front_cell))


@njit
def _tip(law: Isotherm, wedge: float, pressure: FloatArray, x: FloatArray, gap: FloatArray, cell: int) -> float:
    """The same in arrays: the pressure at which ln eta is what it asks for."""
    first = max(cell - 2, 1)
    top = first + np.argmax(pressure[first : cell + 2])
    highest: float = pressure[top]
    below = value = _log_viscosity(law, highest)[0]
    width = x[top + 1] - x[top]
    wanted = 2.0 * value + math.log(math.pi * wedge / gap[top] ** 3 * width * width)
    for k in range(_TIPS):
        value = _log_viscosity(law, highest * (1.0 + (MOST_TIP - 1.0) * (k + 1) / _TIPS))[0]
        if value >= wanted:
            share: float = k + max(wanted - below, 0.0) / (value - below)
            return highest * (1.0 + (MOST_TIP - 1.0) * share / _TIPS)
        below = value
    return highest * MOST_TIP


def _rolling_error(fine: Profile, coarse: Profile) -> float:
    """Relative error of the rolling force.

    Order four; behind a spike the film falls where the pressure does, within few cells and to first order only: there a
    tenth of what the terms of fourth order change comes to it. Where an exit falls within one cell both grids may agree
    by chance: all of that change is what the cell leaves open. At a meniscus the pressure rises where the film is
    thickest, which is as rough.
    """
    moved_by = abs(coarse.rolling_force / fine.rolling_force - 1.0)
    unresolved = _unresolved(fine)
    if fine.spike is None and not fine.layout.starved and not unresolved:
        return FOURTH * moved_by
    return FIRST_ORDER * moved_by + (1.0 if unresolved else 0.1) * fine.fourth_order_share


def _offset_share(M: float, spike: bool) -> float:
    """Share that is left as error of the film offset: p = 4, and 2 where a front narrower than a cell carries load."""
    return SECOND if spike and M < 20.0 else FOURTH


def response_share(M: float, L: float, spike: bool) -> float:
    """Share of the difference between both grids that is left as error of the response on the finer one.

    p = 4; p = 2 at a front narrower than a cell (L > 12), and at the valley, where the response is a small difference
    of large parts whose errors have either sign.

    Parameters
    ----------
    M, L : float
        Moes' load and lubricant parameters of the point.
    spike : bool
        Whether the grid has a spike term.
    """
    if 0.6 < M < 2.0 or L > 30.0 or (spike and L > 12.0):
        return 1.0 / 3.0
    if 0.2 < M < 0.6:
        return 1.5 * FOURTH
    return FOURTH

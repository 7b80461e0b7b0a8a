"""From the curves of the contacts to the table of a law: load and damping over approach, speed and temperature.

Three choices make a small table exact enough:

- The approach axis is stretched and aligned: s = asinh((delta - offset)/scale), with an offset and a scale that
  follow the film over speed and temperature: approach, and the dry contact's change with load, at the bottom of the
  damping valley. The valley stays at nearly constant s, and s is finest there.
- The load is held as its cube root g: it fades out as the cube of the approach, so that g goes straight through
  zero, and w = max(g, 0)^3 is smooth and never negative.
- The damping is held as ln(c/w), so that c is never negative.

Both are tensor products of B-splines, cubic over s and quadratic over ln u and 1/(T - `COLDEST`), in which they are
smooth: C1 with a stencil of 3 x 3 x 4, whose coefficients for both lie side by side in memory.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import MapError
from ehdmaps.maps.contact_curve import ContactCurve, Curve
from ehdmaps.maps.film_field import FilmField, valley_loads
from ehdmaps.maps.kernels.ends import ends_at
from ehdmaps.maps.kernels.splines import law_nodes, spline_coefficients
from ehdmaps.maps.kernels.tables import COLDEST, HALF_SPACE, POWER_LAW, ApproachTable
from ehdmaps.maps.oil_layer import oil_layer
from ehdmaps.maps.rolling_film import RollingFilm
from ehdmaps.maps.rough_layer import RoughLayer
from ehdmaps.physics.approach import highest_fe_load
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import FLOODED, OilSupply
from ehdmaps.physics.surface import SMOOTH, Surface

_SCALE = 0.25
_LAYERED_STEP, _ROOT_STEP = 0.02, 0.1
_FOOT = 0.1
_MARGIN = 4
_BEYOND = 2.0
_SHARED = 0.98
_WIDEST_CONTACT = 0.9


@dataclass(frozen=True)
class Resolution:
    """Spacing of the nodes of a table.

    Attributes
    ----------
    approach : float
        Distance of nodes of the stretched approach s.
    log_speed : float
        Largest distance of nodes of ln u.
    temperature : float
        Largest distance of nodes of 1000 K/(T - `COLDEST`).
    log_load : float
        Distance of the samples of ln w from which the table is made.
    """

    approach: float = 0.08
    log_speed: float = 0.13
    temperature: float = 0.18
    log_load: float = 0.02


OF_TABLE = Resolution(approach=0.04, log_speed=0.26)
"""Of laws with films from the film table, which follow the bottom of the damping valley more closely: nodes are dear
where each is mixed from 36 lines, and cheap here. Distances of ln u twice as long make k wrong by 6e-6 in the median
and 3e-5 at 95 % (NU308, FVA 3), less than films that are read are."""


def highest_structural_load(contact: LineContact) -> float:
    """Load [N/m] up to which the structural law of a contact may be continued; inf for the power laws."""
    if contact.structural_law == "fe" and contact.fe_approach is not None:
        return highest_fe_load(contact.fe_approach, contact.radius, contact.reduced_modulus)
    if contact.structural_law != "half_space" or contact.reference_depth is None:
        return math.inf
    width = _WIDEST_CONTACT * contact.reference_depth
    return math.pi * contact.reduced_modulus * width**2 / (8.0 * contact.radius)


def structural_parameters(contact: LineContact) -> tuple[float, float, float]:
    """Structural law of a contact for a kernel: kind and two parameters.

    POWER_LAW: delta = a w^b. HALF_SPACE: delta = a w (b - ln(w)/2), which is
    (4 w/(pi E')) [ln(2 d*/b_Hertz) + 1/2] with the half-width b_Hertz ~ sqrt(w); the law fe has this form too.
    """
    if contact.structural_law in ("half_space", "fe"):
        slope = 4.0 / (math.pi * contact.reduced_modulus)
        return HALF_SPACE, slope, contact.structural_approach(1.0) / slope
    at_one = contact.structural_approach(1.0)
    return POWER_LAW, at_one, contact.structural_compliance(1.0) / at_one


def compile_table(
    field: FilmField,
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    speeds: tuple[float, float],
    held_load: float,
    resolution: Resolution | None = None,
    supply: OilSupply = FLOODED,
    rolling: RollingFilm | None = None,
    surface: Surface = SMOOTH,
    slowest: float | None = None,
    temperatures: tuple[float, float] | None = None,
) -> ApproachTable:
    """Table of one contact, or of several in series, without centrifugal load.

    Parameters
    ----------
    field : FilmField
        Film of each contact.
    contacts : sequence of LineContact
        Contacts in series.
    lubricant : Lubricant
        Oil for the alignment of the table.
    speeds : (float, float)
        Lowest and highest entrainment speed [m/s], > 0.
    held_load : float
        Highest load [N/m] at which the table must be exact.
    resolution : Resolution, optional
        Spacing of nodes.
    supply : OilSupply, optional
        Oil before each contact.
    rolling : RollingFilm, optional
        Mass flow of the contacts, where it is known.
    surface : Surface
        Roughness of the surfaces.
    slowest : float, optional
        Speed [m/s] down to which nodes are laid below the lowest one, beside those that are there without it.
    temperatures : (float, float), optional
        Temperatures [K] to which nodes are laid likewise; those of the field if left out.

    Raises
    ------
    MapError
        If the approach does not rise with load.
    """
    resolution = resolution or (Resolution() if supply.flooded else Resolution(approach=_LAYERED_STEP))
    log_speeds = _axis(math.log(speeds[0]), math.log(speeds[1]), resolution.log_speed)
    log_speeds, rows = _longer(log_speeds, math.log(slowest or speeds[0]), math.log(speeds[1]), resolution.log_speed)
    low, high = (1.0 / (temperature - COLDEST) for temperature in field.temperature_range)
    cold, hot = (1.0 / (temperature - COLDEST) for temperature in temperatures or field.temperature_range)
    colds = _axis(high, low, 1e-3 * resolution.temperature)
    colds, columns = _longer(colds, hot, cold, 1e-3 * resolution.temperature)
    kelvins = COLDEST + 1.0 / colds
    us, layer = np.exp(log_speeds), supply.oil_layer
    loads, scale = _alignment(contacts, lubricant, us, kelvins, surface.roughness)
    slowest, rough = field.speed_range[0], () if surface.smooth else contacts
    sharing = [RoughLayer(surface, contact, lubricant, slowest) for contact in rough]
    root, curve = _sampled(field, contacts, us, kelvins, held_load, resolution, layer, rolling, sharing)
    offset = _approach_at(np.cbrt(loads), root, curve)
    if layer < math.inf:  # the lift-off from a layer is at one s
        least = 0.0 if surface.smooth else _FOOT
        mapped = curve.approach[:, rows, columns]
        distance = np.maximum(offset - float(np.min(mapped[root[:, rows, columns] >= least])), scale)
        scale = distance * float(np.min((scale / distance)[rows, columns]))

    stretched = np.arcsinh((curve.approach - offset) / scale)
    root_slope = scale * np.sqrt(1.0 + ((curve.approach - offset) / scale) ** 2) / curve.slope
    lifted = int(np.count_nonzero(root[:, 0, 0] < 0.0))
    start = float(np.min(stretched[lifted][rows, columns])) - _MARGIN * resolution.approach
    # nodes beyond the map come besides those that the map has without them
    lowest = float(np.min(stretched[lifted])) - _MARGIN * resolution.approach
    start -= resolution.approach * max(0, math.ceil((start - lowest) / resolution.approach - 1e-9))
    end = float(np.max(stretched[root <= np.cbrt(held_load)])) + _MARGIN * resolution.approach
    nodes: FloatArray = start + resolution.approach * np.arange(math.ceil((end - start) / resolution.approach) + 1.0)

    logs = np.log(curve.loss_ratio)
    values = np.empty((log_speeds.size, kelvins.size, nodes.size, 2))
    falling = np.any(~(np.diff(stretched, axis=0) > 0.0), axis=0)
    for i, j in np.argwhere(falling)[:1]:
        raise MapError(
            f"law: the approach of the contacts {', '.join(c.name for c in contacts)} does not rise with "
            f"load at {math.exp(log_speeds[i]):.4g} m/s, {kelvins[j]:.2f} K; a law needs that; "
            "look at that part of the map, solve it again with a finer grid"
        )
    if supply.flooded:
        law_nodes((stretched, root, root_slope, logs), nodes, -1, values)
    else:
        for i, j in np.ndindex(log_speeds.size, kelvins.size):
            line, roots, slopes, ratios = (part[:, i, j] for part in (stretched, root, root_slope, logs))
            foot = lifted if surface.smooth else int(np.searchsorted(roots, _FOOT))
            line, roots, slopes, ratios = line[foot:], roots[foot:], slopes[foot:], ratios[foot:]
            held = 0 if surface.smooth else 2
            if surface.smooth:
                slopes = _slackened(line, roots, slopes, resolution.approach)
            else:
                line, roots, slopes = _without_foot(line, roots, slopes, resolution.approach)
                ratios = np.concatenate((np.full(2, ratios[0]), ratios))
            law_nodes((line, roots, slopes, ratios), nodes, held, values[i, j])

    coefficients = values
    place = np.stack((offset, 1.0 / scale), axis=-1)
    for axis in (0, 1):
        coefficients = spline_coefficients(coefficients, axis, 2)
        place = spline_coefficients(place, axis, 2)
    coefficients = spline_coefficients(coefficients, 2, 3)
    if not (supply.flooded or surface.smooth):
        coefficients[..., 0] = _rising(coefficients[..., 0])
    return ApproachTable(
        coefficients=coefficients.reshape(*coefficients.shape[:2], -1),
        place=place,
        log_speed_start=float(log_speeds[0]),
        log_speed_step=_inverse_step(log_speeds),
        temperature_start=float(colds[0]),
        temperature_step=_inverse_step(colds),
        start=start,
        step=1.0 / resolution.approach,
    )


def _axis(low: float, high: float, largest_step: float) -> FloatArray:
    """Uniform nodes from low to high, at least eight; one if both are alike."""
    if high <= low:
        return np.array([low])
    return np.linspace(low, high, max(8, math.ceil((high - low) / largest_step) + 1))


def _longer(nodes: FloatArray, low: float, high: float, largest_step: float) -> tuple[FloatArray, slice]:
    """Uniform nodes with more of them on either side, as far as from low to high, and the place of the given ones."""
    step = largest_step if nodes.size == 1 else float(nodes[-1] - nodes[0]) / (nodes.size - 1)
    below, above = (max(0, math.ceil(gap / step - 1e-9)) for gap in (float(nodes[0]) - low, high - float(nodes[-1])))
    longer = np.concatenate(
        (nodes[0] - step * np.arange(below, 0, -1.0), nodes, nodes[-1] + step * np.arange(1.0, above + 1.0))
    )
    return longer, slice(below, below + nodes.size)


def _inverse_step(nodes: FloatArray) -> float:
    """1/distance of uniform nodes; 0 for a single one."""
    return 0.0 if nodes.size == 1 else float((nodes.size - 1) / (nodes[-1] - nodes[0]))


def _alignment(
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    speeds: FloatArray,
    temperatures: FloatArray,
    roughness: float,
) -> tuple[FloatArray, FloatArray]:
    """Load at the bottom of the valley [N/m], and scale of the stretched approach there [m]; (n_u, n_T) each.

    Where films are thinner than the roughness, that sets the scale.
    """
    most = min(highest_structural_load(contact) for contact in contacts)
    valleys = [valley_loads(contact, lubricant, speeds, temperatures) for contact in contacts]
    loads = np.minimum(np.exp(np.mean(np.log(valleys), axis=0)), most)
    compliance = sum(np.asarray(contact.structural_compliance(loads)) for contact in contacts)
    return loads, np.hypot(_SCALE * loads * compliance, len(contacts) * roughness)


def _approach_at(wanted: FloatArray, root: FloatArray, curve: Curve) -> FloatArray:
    """Approach at one root g of each pair of speed and temperature, (n_u, n_T); held beyond the samples.

    A closed form of the film would miss the valley by some per cent of the film, and by other per cents elsewhere: then
    the valley wanders over s from node to node of speed and temperature, where it is narrower than it wanders.
    """
    offset = np.empty_like(wanted)
    for place in np.ndindex(offset.shape):
        offset[place] = np.interp(wanted[place], root[:, *place], curve.approach[:, *place])
    return offset


def _sampled(
    field: FilmField,
    contacts: Sequence[LineContact],
    speeds: FloatArray,
    temperatures: FloatArray,
    held_load: float,
    resolution: Resolution,
    layer: float = math.inf,
    rolling: RollingFilm | None = None,
    sharing: Sequence[RoughLayer] = (),
) -> tuple[FloatArray, Curve]:
    """Samples of g and of the summed curve, from below lift-off to beyond the held load."""
    curves = [ContactCurve(field, contact, speeds, temperatures) for contact in contacts]
    lowest, highest = field.load_range
    begins, ends = field.first_loads(speeds, temperatures), ends_at(field.ends, speeds, temperatures)
    # loads that all lines share; where lines end at loads of their own, every line goes on beyond them
    if np.max(begins) > lowest:
        lowest = float(np.max(begins)) / _SHARED
    if np.min(ends) < highest:
        highest = float(np.min(ends)) * _SHARED
    first = np.cbrt(begins)
    faded = 0.7 * np.cbrt(np.min([curve.fade_load for curve in curves], axis=0))
    linear = np.linspace(-0.6, 1.0, 97)[:, None, None] * faded
    if sharing:
        linear = _dense_at_zero(faded, min(rough.least_root for rough in sharing))
    tail_range = float(np.max(np.log(first / faded)))
    count = max(8, math.ceil(3.0 * tail_range / (2.0 * resolution.log_load)))
    part = np.linspace(0.0, 1.0, count + 1)[1:-1, None, None]
    tail = np.concatenate((linear, faded * (first / faded) ** part))

    lows, highs = np.full_like(begins, lowest), np.full_like(ends, highest)
    low_loads, mapped, high_loads = (
        _log_lines(low, high, resolution.log_load) for low, high in ((begins, lows), (lows, highs), (highs, ends))
    )
    known = np.concatenate((low_loads[:-1], mapped, high_loads[1:]))
    most = min(highest_structural_load(contact) for contact in contacts)
    beyond = _log_lines(ends, np.full_like(ends, min(_BEYOND * held_load, most)), resolution.log_load)[1:]
    films = [curve.film(tail, known, beyond) for curve in curves]
    if layer < math.inf:
        films = [
            oil_layer(contact, layer, curve.tail, rolling, speeds, temperatures, field)(film)
            for contact, curve, film in zip(contacts, curves, films, strict=True)
        ]
    if sharing:
        films = [rough(film, speeds, temperatures) for rough, film in zip(sharing, films, strict=True)]
    total = _summed([curve.with_structure(film) for curve, film in zip(curves, films, strict=True)])
    return films[0].root, total


def _dense_at_zero(end: FloatArray, unit: float) -> FloatArray:
    """Values of g from -0.6 end through zero to `end` (n_u, n_T): even steps about zero, then even in the logarithm.

    Asperities begin to carry within the unit.
    """
    below, above = (np.arcsinh(part * end / unit) for part in (0.6, 1.0))
    counts = (max(2, math.ceil(float(np.max(reach)) / _ROOT_STEP)) for reach in (below, above))
    shares = [np.linspace(0.0, 1.0, count + 1)[1:, None, None] for count in counts]
    lower, upper = (unit * np.sinh(share * reach) for share, reach in zip(shares, (below, above), strict=True))
    return np.concatenate((-lower[::-1], np.zeros((1, *end.shape)), upper))


def _log_lines(lows: FloatArray, highs: FloatArray, step: float) -> FloatArray:
    """Values from each low to its high (n_u, n_T), uniform in their logarithm, as many for each; one of equal ones."""
    reach = float(np.max(np.log(highs / lows)))
    if not reach > 0.0:
        return highs[None]
    values: FloatArray = np.geomspace(lows, highs, max(2, math.ceil(reach / step) + 1))
    return values


def _summed(curves: Sequence[Curve]) -> Curve:
    """Contacts in series."""
    total = curves[0]
    for curve in curves[1:]:
        total = total + curve
    return total


def _slackened(line: FloatArray, root: FloatArray, slope: FloatArray, step: float) -> FloatArray:
    """Slopes dg/ds of samples from lift-off, g = 0, the first one no steeper than over two nodes of a table.

    Where a layer ends, g rises with an almost vertical tangent, which no table resolves.
    """
    over_two = float(np.interp(line[0] + 2.0 * step, line, root)) / (2.0 * step)
    return np.concatenate(([min(float(slope[0]), over_two)], slope[1:]))


def _without_foot(
    line: FloatArray, root: FloatArray, slope: FloatArray, step: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Samples of s, g and dg/ds, from two nodes below the first one with the slope that g has over the next two.

    On a layer, asperities give g a foot of less than a thousandth of 1 N/m, with a knee at its end that no table
    resolves.
    """
    over_two = (float(np.interp(line[0] + 2.0 * step, line, root)) - float(root[0])) / (2.0 * step)
    below = -step * np.array([2.0, 1.0])
    return (
        np.concatenate((line[0] + below, line)),
        np.concatenate((root[0] + over_two * below, root)),
        np.concatenate((np.full(2, over_two), slope)),
    )


def _rising(coefficients: FloatArray) -> FloatArray:
    """Coefficients of g that nowhere fall along s, the last axis: then g nowhere falls, at any speed and temperature.

    Where a layer is about as thick as the asperities are high, these carry up to some 0.1 N/m before the layer ends: at
    that knee a cubic rings, and g would fall.
    """
    return np.minimum.accumulate(coefficients[..., ::-1], axis=-1)[..., ::-1]

"""Films that have to be solved for a contact law: axes and lines of the backbone, see `backbone`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np

from ehdmaps.maps.film_field import RIGID
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups, valley_load_number

OUTER_STEP = 0.45
"""Step of zeta outside the valley."""

VALLEY = (-1.1, 1.5)
"""zeta of the valley: from where film compliance and loss begin to fall to where they have recovered."""

Axis = Literal["load", "entrainment_speed", "temperature"]

NEIGHBOURS = 6
"""Lines in each direction that the interpolation between lines uses."""

NAME = "backbone"
"""Name of the reference contact."""


@dataclass(frozen=True)
class Steps:
    """Largest steps of a backbone.

    Attributes
    ----------
    load : float
        Step of zeta in the valley.
    entrainment_speed : float
        Step of ln(reference speed).
    temperature : float
        Step of the temperature [K].
    """

    load: float = 0.06
    entrainment_speed: float = 0.66
    temperature: float = 17.0

    def finer(self, axis: Axis) -> Steps:
        """Half of the step along one axis.

        Parameters
        ----------
        axis : {"load", "entrainment_speed", "temperature"}
            Which one.
        """
        return replace(self, **{axis: 0.5 * getattr(self, axis)})


STEPS = Steps()
"""Where a backbone begins for which a job says nothing."""


class StepLimits(NamedTuple):
    """Smallest and largest step along each axis, in the units of `Steps`."""

    load: tuple[float, float] = (0.005, 1.0)
    entrainment_speed: tuple[float, float] = (0.05, 10.0)
    temperature: tuple[float, float] = (1.0, 1000.0)


STEP_LIMITS = StepLimits()


@dataclass(frozen=True)
class BackboneLine:
    """One line of the backbone: loads of the reference contact at one speed and temperature.

    Attributes
    ----------
    place : tuple of int
        Indices of the first load on the zeta axis, of the speed and of the temperature.
    loads : tuple of float
        [N/m].
    speed, temperature : float
        [m/s], [K].
    """

    place: tuple[int, int, int]
    loads: tuple[float, ...]
    speed: float
    temperature: float


@dataclass(frozen=True)
class BackbonePlan:
    """Axes and lines of a backbone.

    Attributes
    ----------
    contact : LineContact
        The reference contact.
    zeta, speeds, temperatures : tuple of float
        Axes; speeds [m/s] of the reference contact, temperatures [K].
    lines : tuple of BackboneLine
        What has to be solved.
    """

    contact: LineContact
    zeta: tuple[float, ...]
    speeds: tuple[float, ...]
    temperatures: tuple[float, ...]
    lines: tuple[BackboneLine, ...]


def plan_backbone(
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    loads: Sequence[float],
    speeds: Sequence[float],
    temperatures: Sequence[float],
    steps: Steps = STEPS,
    zeta: tuple[float, ...] | None = None,
) -> BackbonePlan | None:
    """Backbone that covers the axes of a map for all its contacts; None where no speed is positive.

    Parameters
    ----------
    contacts : sequence of LineContact
        Contacts of the map; all of one material.
    lubricant : Lubricant
        The oil.
    loads, speeds, temperatures : sequence of float
        Axes of the map [N/m], [m/s], [K].
    steps : Steps
        Largest steps of the backbone.
    zeta : tuple of float, optional
        Axis of zeta that covers what is needed; made if left out.
    """
    positive = [u for u in speeds if u > 0.0]
    if not positive:
        return None
    reference = replace(contacts[0], name=NAME)
    # the same L needs u/R equal
    ratios = [reference.radius / c.radius for c in contacts]
    speed_axis = _log_axis(min(positive) * min(ratios), max(positive) * max(ratios), steps.entrainment_speed)
    temperature_axis = _linear_axis(min(temperatures), max(temperatures), steps.temperature)
    span = {}
    for j, u in enumerate(speed_axis):
        for k, T in enumerate(temperature_axis):
            low, high = zeta_span(contacts, lubricant, reference, loads, u, T)
            span[j, k] = min(low, RIGID), high
    if zeta is None:
        zeta = zeta_axis(min(low for low, _ in span.values()), max(high for _, high in span.values()), steps.load)
    reach = NEIGHBOURS // 2
    lines = []
    for k, T in enumerate(temperature_axis):
        state = lubricant.at(T)
        for j, u in enumerate(speed_axis):
            # what any line of a stencil needs, this line has to have
            near = [
                span[(p, q)]
                for p in range(max(0, j - reach), min(len(speed_axis), j + reach + 1))
                for q in range(max(0, k - reach), min(len(temperature_axis), k + reach + 1))
            ]
            low, high = min(a for a, _ in near), max(b for _, b in near)
            first = max(int(np.searchsorted(zeta, low)) - 2, 0)
            last = min(int(np.searchsorted(zeta, high)) + 2, len(zeta))
            unit, L = moes_groups(
                1.0,
                u,
                state.viscosity,
                state.pressure_viscosity.pressure_viscosity,
                reference.radius,
                reference.reduced_modulus,
            )
            valley = float(valley_load_number(L))
            lines.append(
                BackboneLine(
                    place=(first, j, k),
                    loads=tuple(float(math.exp(z)) * valley / unit for z in zeta[first:last]),
                    speed=u,
                    temperature=T,
                )
            )
    return BackbonePlan(reference, zeta, speed_axis, temperature_axis, tuple(lines))


def plan_own_lines(
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    loads: Sequence[float],
    speeds: Sequence[float],
    temperatures: Sequence[float],
    steps: Steps = STEPS,
) -> tuple[BackbonePlan, ...]:
    """A backbone for each contact, on common axes: for films that are no functions of M and L alone.

    Parameters
    ----------
    contacts, lubricant, loads, speeds, temperatures, steps
        The arguments of `plan_backbone`.
    """
    axes = loads, speeds, temperatures, steps
    plans = [plan_backbone((contact,), lubricant, *axes) for contact in contacts]
    ends = [(plan.zeta[0], plan.zeta[-1]) for plan in plans if plan is not None]
    if not ends:
        return ()
    zeta = zeta_axis(min(low for low, _ in ends), max(high for _, high in ends), steps.load)
    own = (plan_backbone((contact,), lubricant, *axes, zeta) for contact in contacts)
    return tuple(plan for plan in own if plan is not None)


def zeta_span(
    contacts: Sequence[LineContact],
    lubricant: Lubricant,
    reference: LineContact,
    loads: Sequence[float],
    u: float,
    T: float,
) -> tuple[float, float]:
    """Range of zeta that the loads of a map cover at one reference speed and temperature, over all contacts.

    Parameters
    ----------
    contacts : sequence of LineContact
        The contacts.
    lubricant : Lubricant
        The oil.
    reference : LineContact
        The reference contact.
    loads : sequence of float
        Loads of the map [N/m]; only the lowest and the highest count.
    u, T : float
        Speed of the reference contact [m/s] and temperature [K].
    """
    state = lubricant.at(T)
    ends = []
    for contact in contacts:
        speed = u * contact.radius / reference.radius
        unit, L = moes_groups(
            1.0,
            speed,
            state.viscosity,
            state.pressure_viscosity.pressure_viscosity,
            contact.radius,
            contact.reduced_modulus,
        )
        valley = float(valley_load_number(L))
        ends += [math.log(w * unit / valley) for w in (min(loads), max(loads))]
    return min(ends), max(ends)


def _log_axis(low: float, high: float, step: float) -> tuple[float, ...]:
    """Log-uniform axis with at most `step` between logs."""
    if high <= low * (1.0 + 1e-12):
        return (low,)
    count = max(NEIGHBOURS, 1 + math.ceil(math.log(high / low) / step))
    return tuple(float(v) for v in np.geomspace(low, high, count))


def _linear_axis(low: float, high: float, step: float) -> tuple[float, ...]:
    """Uniform axis with at most `step` between values."""
    if high <= low:
        return (low,)
    count = max(NEIGHBOURS, 1 + math.ceil((high - low) / step))
    return tuple(float(v) for v in np.linspace(low, high, count))


def zeta_axis(low: float, high: float, step: float) -> tuple[float, ...]:
    """Axis of zeta with fine steps in the valley and coarse ones outside.

    Parameters
    ----------
    low, high : float
        What it covers at least.
    step : float
        Step in the valley.
    """
    axis = list(np.arange(VALLEY[0], VALLEY[1] + 0.5 * step, step))
    while axis[0] > low:
        axis.insert(0, axis[0] - min(OUTER_STEP, 1.25 * (axis[1] - axis[0])))
    while axis[-1] < high:
        axis.append(axis[-1] + min(OUTER_STEP, 1.25 * (axis[-1] - axis[-2])))
    return tuple(float(z) for z in axis)

"""Safety of each bearing of a report: pressure, least load, film and life beside what is allowed or asked for."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from ehdmaps.figures import typeset
from ehdmaps.report.chart import known, number
from ehdmaps.report.page import Markup, joined, sentences, table
from ehdmaps.units import FILM, PRESSURE, RPM
from mbs.model.findings import Gauge
from mbs.output.one_bearing.located import located
from mbs.output.one_bearing.table import ROUGHNESS, regime
from mbs.report.examination import Examination
from mbs.scene.assembly import ring_motions

LEAST_LOAD = {"ball": 0.01, "roller": 0.02}
"""Least equivalent load over C by the rolling element, below which it may slide (smearing of ISO 15243, 5.2.3.2): the
general guideline of SKF, Rolling bearings, 2018, requisite minimum load."""


class Safety(NamedTuple):
    """Margins of a bearing; NaN where one is not known.

    Attributes
    ----------
    name, kind : str
        The bearing, and its rolling element.
    axial, radial : float
        Load on the inner ring [N].
    pressure, static_limit : float
        Largest Hertz pressure, and that of the static rating of ISO 76 [Pa].
    equivalent, least : float
        Equivalent load of ISO/TS 16281, and the least load that the bearing should have [N].
    film, film_parameter : float
        Smallest film [m], and that over the roughness.
    revolutions, hours : float
        Life L10r [millions], [h].
    """

    name: str
    kind: str
    axial: float
    radial: float
    pressure: float
    static_limit: float
    equivalent: float
    least: float
    film: float
    film_parameter: float
    revolutions: float
    hours: float


def safety_of(found: Examination) -> Iterator[Safety]:
    """Yield the margins of each bearing at the equilibrium.

    Parameters
    ----------
    found : Examination
        What was found.
    """
    model, balance = found.model, found.statics.balance
    roughness = _roughness(found)
    states: list[tuple[Any, Any, Any]] = [
        (bearing, bearing.bearing.geometry, bearing.loads(motion, balance.operation))
        for bearing, motion in ring_motions(model, balance.displacement)
    ]
    states += [(element, at.force.geometry, at.loads) for _, element, at in located(model, balance)]
    for place, contacts, (element, geometry, loads) in zip(
        model.ring_places, found.statics.contacts, states, strict=True
    ):
        motion = model.system.relative(element.inner, element.outer) @ balance.displacement
        gauge: Gauge | None = element.gauge(motion, balance.operation)
        kind, force = element.rolling_element, balance.forces[place]
        turns = abs(element.inner_spin - element.outer_spin) * abs(balance.operation.speed) / (2.0 * math.pi)
        equivalent = least = life = math.nan
        if hasattr(loads, "life"):
            equivalent, life = loads.life(geometry, abs(element.inner_spin) >= abs(element.outer_spin))
            if math.isfinite(life):
                power = 3.0 if kind == "ball" else 10.0 / 3.0
                least = LEAST_LOAD.get(kind, LEAST_LOAD["roller"]) * equivalent * life ** (1.0 / power)
        film = float(np.min(contacts.minimum_film))
        yield Safety(
            element.name,
            kind,
            float(force[0]),
            math.hypot(force[1], force[2]),
            float(np.max(contacts.hertz_pressure)),
            math.nan if gauge is None else gauge.static_limit,
            equivalent,
            least,
            film,
            film / roughness,
            life,
            life * 1e6 / (3600.0 * turns) if turns > 0.0 else math.nan,
        )


def _roughness(found: Examination) -> float:
    """Combined roughness [m]; that which is assumed where the scene states none, or smooth surfaces."""
    surface = found.model.surface
    return ROUGHNESS if surface is None or surface.smooth else float(surface.roughness)


def safety(found: Examination) -> Markup | None:
    """Return the table of all bearings, and what is little about them in sentences; None without bearings.

    Parameters
    ----------
    found : Examination
        What was found.
    """
    margins = list(safety_of(found))
    if not margins:
        return None
    rows = [
        (
            one.name,
            number(one.axial, 4) if abs(one.axial) > 1e-6 else "0",
            number(one.radial, 4),
            f"{known(PRESSURE.value(one.pressure))} of {known(PRESSURE.value(one.static_limit), 2)}",
            f"{known(one.equivalent)} of {known(one.least)}",
            known(one.equivalent / one.least),
            known(FILM.value(one.film)),
            known(one.film_parameter),
            known(one.revolutions),
            known(one.hours),
        )
        for one in margins
    ]
    heads = (
        "bearing", "axial, N", "radial, N", "pressure of limit, GPa", "load of least, N", "ratio", f"film, {FILM.unit}",
        "Λ", "L10r, 1e6", "hours",
    )  # fmt: skip
    assumed = found.model.surface is None or found.model.surface.smooth
    said = f"Λ is the smallest film over {FILM.text(_roughness(found))} of roughness"
    lines = [
        f"Limit of pressure: static rating of ISO 76. Least load: {100.0 * LEAST_LOAD['ball']:g} % of C for balls, "
        f"{100.0 * LEAST_LOAD['roller']:g} % for rollers, as catalogues ask; below, elements slide and may smear (ISO "
        f"15243). {said}{', which is assumed: no surface is stated' if assumed else ''}. L10r of ISO/TS 16281, C of "
        f"ISO 281 by inner geometry, at {RPM.text(found.model.scene.speed)} all the time.",
        *_judged(margins),
    ]
    told = table(tuple(map(typeset, heads)), rows, "Bearings at the operating speed", (0,))
    return joined(told, sentences(map(typeset, lines)))


def _judged(margins: list[Safety]) -> Iterator[str]:
    """Sentences on what is too much or too little."""
    for one in margins:
        if one.pressure > one.static_limit:
            yield f"{one.name}: the pressure is above the static limit."
        if one.equivalent < one.least:
            yield f"{one.name}: carries {number(one.equivalent / one.least, 2)} of the least load; preload helps."
        if math.isfinite(one.film_parameter) and one.film_parameter < 3.0:
            yield f"{one.name}: Λ {number(one.film_parameter)}, {regime(one.film_parameter)}."

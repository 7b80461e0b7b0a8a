"""Charts of a map for a report: stiffness, damping, approach and films over load, with what they say in sentences.

Where the map makes contact laws, curves are those of its laws, and known at any speed and temperature; elsewhere they
join the solved points. Both are read off by the cursor of the report.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import MapError
from ehdmaps.exports.map_curves import curves, film_between, rough_layers
from ehdmaps.figures import WARNING, spread, typeset
from ehdmaps.maps.emap import EHDMap
from ehdmaps.maps.film_field import FilmField, known_at
from ehdmaps.maps.rough_layer import BOUNDARY, FILM_PARAMETER, MIXED
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.solution import Status, usable_points
from ehdmaps.report.axis import Axis, log_axis, symlog_axis
from ehdmaps.report.chart import GREY, SEQUENCE, Chart, Curve, Points, Shade, figure, number, shown
from ehdmaps.report.page import Markup, tag
from ehdmaps.units import DAMPING, FILM, LOAD, PRESSURE, SPEED, STIFFNESS, TEMPERATURE, Display

MOST_CURVES = 6
"""Speeds, or temperatures, of a chart: more cannot be told apart."""

LAW_POINTS = 110
"""Loads of a curve besides those of the map."""

SHOWN_TEMPERATURE = 313.15
"""Charts are at the mapped temperature nearest to this one [K], where no scene asks for another."""

LINEAR_APPROACH = 1.0
"""Approach [um] up to which its axis is linear."""

_PLAIN = Display("")
_OF_POINTS = ("central_film", "minimum_film")
_FLOOR = {"stiffness": 1e-3, "damping": 1e-5}
"""Share of the largest value below which nobody reads."""

_NAMES = {
    "stiffness": ("stiffness k", STIFFNESS),
    "damping": ("damping c", DAMPING),
    "approach": ("approach", FILM),
    "central_film": ("central film", FILM),
    "minimum_film": ("minimum film", FILM),
    FILM_PARAMETER: ("film parameter Λ", _PLAIN),
}
_VALLEY = 0.7
"""Share of the damping on both sides below which a valley is one."""

_LINE = 1.015
"""Ratio of the ends of a shade that is drawn as a line."""

_DASHES = ("", "7 3", "2 3", "9 3 2 3")


@dataclass(frozen=True)
class Operated:
    """Part of a map that a machine uses.

    Attributes
    ----------
    label : str
        Name of a bearing, or of several that do the same; foreign text.
    loads : dict of str to float
        Highest load of each contact, by its name [N/m].
    speed, temperature : float
        Entrainment speed [m/s], temperature of the raceways [K].
    """

    label: str
    loads: dict[str, float]
    speed: float
    temperature: float


@dataclass(frozen=True, eq=False)
class MapCurves:
    """The curves of a map.

    Attributes
    ----------
    emap : EHDMap
        The map.
    """

    emap: EHDMap

    @cached_property
    def field(self) -> FilmField | None:
        """Films of its contact laws; None where it makes none."""
        try:
            self.emap.check_usable()
            return self.emap.film_field()
        except MapError:
            return None

    @cached_property
    def loads(self) -> FloatArray:
        """Loads of all curves [N/m]: those of the map, and between them where a law knows more."""
        axis = self.emap.dataset["load"].values.astype(np.float64)
        if axis.size == 1 or self.field is None:
            return axis
        between = np.geomspace(axis[0], axis[-1], LAW_POINTS)
        far = np.min(np.abs(np.log(between[:, None] / axis)), axis=1) > np.log(axis[-1] / axis[0]) / LAW_POINTS / 3.0
        return np.sort(np.concatenate([axis, between[far]]))

    @cached_property
    def speeds(self) -> FloatArray:
        """Entrainment speeds above zero, or all if there is none [m/s]."""
        axis = self.emap.dataset["entrainment_speed"].values.astype(np.float64)
        return axis[axis > 0.0] if np.any(axis > 0.0) else axis

    @property
    def temperatures(self) -> FloatArray:
        """Temperatures [K]."""
        return np.asarray(self.emap.dataset["temperature"].values, dtype=np.float64)

    def values(
        self, name: str, contact: LineContact, speed: float, temperature: float, loads: FloatArray | None = None
    ) -> FloatArray:
        """Values of a variable over load, in SI; NaN where nothing is known.

        Parameters
        ----------
        name : str
            stiffness, damping, approach, central_film, minimum_film or film_parameter.
        contact : LineContact
            One of the map.
        speed, temperature : float
            u [m/s], T [K], within the map; without laws one of its own.
        loads : ndarray, optional
            [N/m]; `loads` if left out.
        """
        at = self.loads if loads is None else loads
        if name == FILM_PARAMETER:
            return self.values("minimum_film", contact, speed, temperature, loads) / self.emap.surface.roughness
        if self.field is None:
            here = self.emap.dataset.sel(contact=contact.name)
            here = here.sel(entrainment_speed=speed, temperature=temperature, method="nearest")
            return np.asarray(np.interp(np.log(at), np.log(here["load"].values), here[name].values))
        if name in _OF_POINTS:
            try:
                return film_between(self.emap, name, contact.name, at, speed, temperature)
            except (FloatingPointError, ValueError):
                return np.full(at.size, np.nan)
        curve = curves(self.field, (contact,), at, speed, temperature, rough_layers(self.emap))
        return np.where(known_at(self.field, at, speed, temperature), getattr(curve, name), np.nan)


def contact_charts(of: MapCurves, contact: LineContact, operated: Sequence[Operated], prefix: str) -> Markup:
    """Return all charts of one contact.

    Parameters
    ----------
    of : MapCurves
        The map.
    contact : LineContact
        One of its contacts.
    operated : sequence of Operated
        Operating points of a machine that uses the map; may be empty.
    prefix : str
        Begins the names of the charts: letters, digits and hyphens.
    """
    names = ["stiffness", "damping", "approach", "central_film", "minimum_film"]
    if not of.emap.surface.smooth:
        names.append(FILM_PARAMETER)
    temperature, speed = shown_temperature(of, operated), shown_speed(of, operated)
    drawn = [
        _chart(of, contact, name, f"{prefix}-{name}-speed".replace("_", "-"), operated, temperature=temperature)
        for name in names
    ]
    if of.temperatures.size > 1 and not operated:
        drawn += [
            _chart(of, contact, name, f"{prefix}-{name}-temperature".replace("_", "-"), operated, speed=speed)
            for name in ("stiffness", "damping", "minimum_film")
        ]
    return tag("div", *(figure(one) for one in drawn), class_="charts")


def shown_temperature(of: MapCurves, operated: Sequence[Operated]) -> float:
    """Return the temperature at which curves of several speeds are shown [K].

    Parameters
    ----------
    of : MapCurves
        The map.
    operated : sequence of Operated
        Operating points of a machine; the first one decides.
    """
    axis = of.temperatures
    if operated and of.field is not None:
        return float(np.clip(operated[0].temperature, axis[0], axis[-1]))
    wanted = operated[0].temperature if operated else SHOWN_TEMPERATURE
    return float(axis[np.argmin(np.abs(axis - wanted))])


def shown_speed(of: MapCurves, operated: Sequence[Operated]) -> float:
    """Return the entrainment speed at which curves of several temperatures are shown [m/s].

    Parameters
    ----------
    of : MapCurves
        The map.
    operated : sequence of Operated
        Operating points of a machine; the first one decides.
    """
    axis = of.speeds
    if operated and of.field is not None:
        return float(np.clip(abs(operated[0].speed), axis[0], axis[-1]))
    return float(axis[axis.size // 2])


def _spread(axis: FloatArray) -> FloatArray:
    """Some values of an axis, both ends among them."""
    return axis[spread(axis.size, MOST_CURVES)]


def _chart(
    of: MapCurves,
    contact: LineContact,
    name: str,
    place: str,
    operated: Sequence[Operated],
    temperature: float | None = None,
    speed: float | None = None,
) -> Chart:
    """One variable over load: curves of several speeds at a temperature, or of several temperatures at a speed."""
    label, display = _NAMES[name]
    unit = typeset(display.unit)
    loads = of.loads
    if speed is None and temperature is not None:
        varied, axis = _spread(of.speeds), SPEED
        lines = [of.values(name, contact, float(value), temperature) for value in varied]
        where = f"at {shown(TEMPERATURE, temperature)}, by entrainment speed"
    else:
        varied, axis = _spread(of.temperatures), TEMPERATURE
        lines = [of.values(name, contact, float(speed or 0.0), float(value)) for value in varied]
        where = f"at {shown(SPEED, float(speed or 0.0))}, by temperature of the raceways"
    colours = [SEQUENCE[round(i * (len(SEQUENCE) - 1) / max(varied.size - 1, 1))] for i in range(varied.size)]
    drawn = [
        Curve(shown(axis, float(value)), display.factor * values, colour)
        for value, values, colour in zip(varied, lines, colours, strict=True)
    ]
    points = (
        []
        if speed is not None or temperature not in of.temperatures
        else list(_marks(of, contact, name, varied, colours, float(temperature or 0.0)))
    )
    if name == "stiffness":
        dry = display.factor / contact.structural_compliance(loads)
        drawn.append(Curve("dry contact", dry, GREY, "5 3", 1.2))
    for index, one in enumerate(operated):
        curve, point = _operated(of, contact, name, one, display, _DASHES[index % len(_DASHES)])
        drawn.append(curve)
        points += point
    return Chart(
        place,
        f"{label[0].upper()}{label[1:]} of the {contact.name} contact {where}",
        " ".join(_says(of, name, loads, varied, axis, lines)),
        log_axis("load", LOAD.unit, LOAD.factor * loads),
        _axis(name, label, unit, [curve.values for curve in drawn]),
        LOAD.factor * loads,
        drawn,
        points,
        _shades(of, contact, temperature) if speed is None else [],
        [(BOUNDARY, "Λ = 1"), (MIXED, "Λ = 3")] if name == FILM_PARAMETER else [],
    )


def _axis(name: str, label: str, unit: str, values: Sequence[FloatArray]) -> Axis:
    """The vertical axis of a variable."""
    everything = np.concatenate(values)
    if name == "approach":
        return symlog_axis(label, unit, everything, LINEAR_APPROACH)
    if name == FILM_PARAMETER:
        return log_axis(label, unit, np.clip(np.append(everything, [0.8, 4.0]), 0.01, 1000.0))
    return log_axis(label, unit, everything, _FLOOR.get(name, 0.0), 1.25)


def _marks(
    of: MapCurves, contact: LineContact, name: str, speeds: FloatArray, colours: Sequence[str], temperature: float
) -> Iterator[Points]:
    """The solved points of the curves, and those that are none."""
    if name == FILM_PARAMETER:
        return
    _, display = _NAMES[name]
    here = of.emap.dataset.sel(contact=contact.name, temperature=temperature)
    loads = LOAD.factor * here["load"].values
    for speed, colour in zip(speeds, colours, strict=True):
        line = here.sel(entrainment_speed=speed)
        values, status = display.factor * line[name].values, line["status"].values
        filled = line["filled"].values.astype(bool)
        unsolved = ~usable_points(status)
        limit = status == int(Status.ASYMPTOTE)
        plain = ~unsolved & ~limit & np.isfinite(values)
        yield Points("", loads[plain], values[plain], "dot", colour)
        for label, chosen, shape, paint in (
            ("limit of thin films", limit, "triangle", colour),
            ("no solution, filled", unsolved & filled, "ring", WARNING),
            ("no solution", unsolved & ~filled, "cross", WARNING),
        ):
            if chosen.any():
                yield Points(label, loads[chosen], values[chosen], shape, paint)


def _operated(
    of: MapCurves, contact: LineContact, name: str, one: Operated, display: Display, dash: str
) -> tuple[Curve, list[Points]]:
    """The curve of an operating point, and the point on it."""
    speed = float(np.clip(abs(one.speed), of.speeds[0], of.speeds[-1]))
    temperature = float(np.clip(one.temperature, of.temperatures[0], of.temperatures[-1]))
    values = display.factor * of.values(name, contact, speed, temperature)
    words = f"{one.label}: {shown(SPEED, speed)}, {shown(TEMPERATURE, temperature)}"
    curve = Curve(words, values, WARNING, dash, 2.4)
    load = one.loads.get(contact.name, np.nan)
    if not of.loads[0] <= load <= of.loads[-1]:
        return curve, []
    at = display.factor * of.values(name, contact, speed, temperature, np.array([load]))
    return curve, [Points("highest load in operation", np.array([LOAD.factor * load]), at, "diamond", "#5a0010")]


def _shades(of: MapCurves, contact: LineContact, temperature: float | None) -> list[Shade]:
    """Shades where the viscosity is extrapolated at some speed; a line alone where its reach is assumed."""
    here = of.emap.dataset.sel(contact=contact.name).sel(temperature=temperature, method="nearest")
    beyond = here["viscosity_extrapolated"].transpose("load", ...).values.max(axis=1) > 0
    if not beyond.any():
        return []
    loads = LOAD.factor * here["load"].values
    begin, oil = float(loads[beyond][0]), of.emap.lubricant
    if not oil.reach_assumed:
        return [Shade("viscosity extrapolated", begin, float(loads[-1]))]
    words = f"right of it above {shown(PRESSURE, oil.fitted_pressure)}: assumed reach of the viscosity law"
    return [Shade(words, begin, _LINE * begin)]


def _says(
    of: MapCurves, name: str, loads: FloatArray, varied: FloatArray, axis: Display, lines: Sequence[FloatArray]
) -> Iterator[str]:
    """Yield what the curves say, in sentences."""
    label, display = _NAMES[name]
    middle = int(np.argmin(np.abs(np.log(loads / np.sqrt(loads[0] * loads[-1])))))
    first, last = float(lines[0][middle]), float(lines[-1][middle])
    at = shown(LOAD, float(loads[middle]))
    if not (np.isfinite(first) and np.isfinite(last)):
        yield f"At {at} there is no solution at one end of the curves."
        return
    symbol = label.split()[-1] if name in ("stiffness", "damping") else f"the {label}"
    ends = f"{shown(axis, float(varied[0]))} and {shown(axis, float(varied[-1]))}"
    yield (
        f"At {at} {symbol} is {shown(display, first)}."
        if varied.size == 1
        else f"At {at} {symbol} is {shown(display, first)} and {shown(display, last)} at {ends}."
    )
    half = lines[len(lines) // 2]
    at_half = shown(axis, float(varied[len(lines) // 2]))
    if name == "stiffness":
        change = half[-1] / half[0] if half[0] > 0.0 else np.nan
        if loads.size > 1 and np.isfinite(change):
            yield f"At {at_half} it grows {number(float(change))} times from the lowest to the highest load."
    elif name == "damping":
        yield from _valley(half, loads, at_half)
    elif name == "approach":
        crossed = np.flatnonzero((half[:-1] < 0.0) & (half[1:] >= 0.0))
        if crossed.size:
            load = float(loads[crossed[-1] + 1])
            yield f"Below {shown(LOAD, load)} the film at {at_half} is thicker than the bodies give way."
    elif name in _OF_POINTS and axis is SPEED and varied.size > 1 and min(first, last, varied[0]) > 0.0:
        power = np.log(last / first) / np.log(varied[-1] / varied[0])
        yield f"Between these speeds it grows about as the speed to the power {power:.2f}."
    elif name == FILM_PARAMETER:
        yield from _lambda_words(loads, varied, axis, lines)


def _valley(values: FloatArray, loads: FloatArray, at: str) -> Iterator[str]:
    """Yield where damping has its valley: a minimum inside the curve."""
    if values.size < 3 or not np.all(np.isfinite(values)):
        return
    before, after = np.maximum.accumulate(values), np.maximum.accumulate(values[::-1])[::-1]
    deep = np.flatnonzero(values < _VALLEY * np.minimum(before, after))
    if deep.size:
        lowest = int(deep[np.argmin(values[deep])])
        load, least = shown(LOAD, float(loads[lowest])), shown(DAMPING, float(values[lowest]))
        yield f"At {at} it has a valley near {load}, where it falls to {least}."


def _lambda_words(loads: FloatArray, varied: FloatArray, axis: Display, lines: Sequence[FloatArray]) -> Iterator[str]:
    """Yield where Lambda is below 1 and 3 on these curves."""
    for limit, words in ((BOUNDARY, "boundary lubrication"), (MIXED, "mixed lubrication")):
        below = [shown(axis, float(value)) for value, curve in zip(varied, lines, strict=True) if (curve < limit).any()]
        if not below:
            yield f"Λ is nowhere below {limit:g} here ({words})."
            continue
        lowest = [float(loads[curve < limit][0]) for curve in lines if (curve < limit).any()]
        yield f"Λ is below {limit:g} ({words}) from {shown(LOAD, min(lowest))} on, at {', '.join(below)}."

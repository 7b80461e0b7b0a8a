"""Choice of what is looked at in a run: sensors of some names or the first of an acceleration, and orders to follow."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ehdmaps.errors import InputError
from ehdmaps.units import closest
from mbs.model.elements import OnRings, Sensor
from mbs.scene.assembly import Model
from mbs.scene.scene import Scene
from mbs.settings import CampbellSettings, RunUp

ALL_SENSORS = "all"
"""Stands for all sensors of a scene, or of a file."""


def looked_at(scene: Scene, settings: CampbellSettings) -> tuple[Sensor, ...]:
    """The sensor of a diagram, then all others of an acceleration.

    Parameters
    ----------
    scene : Scene
        The scene.
    settings : CampbellSettings
        The sensor's name, if one is named.

    Raises
    ------
    InputError
        If there is no such sensor.
    """
    problems: list[str] = []
    sensor = _sensor(settings.sensor, scene, problems)
    if sensor is None:
        raise InputError(problems)
    others = (other for other in scene.sensors if other.quantity == "acceleration" and other.name != sensor.name)
    return sensor, *others


def chosen_sensors(scene: Scene, settings: CampbellSettings, names: Sequence[str], problems: list[str]) -> list[Sensor]:
    """The sensors of some names, without doubles.

    Parameters
    ----------
    scene : Scene
        The scene.
    settings : CampbellSettings
        Settings whose sensor is taken where no name is given.
    names : sequence of str
        Names, or `ALL_SENSORS` for all of the scene.
    problems : list of str
        What is wrong about them is appended.
    """
    if ALL_SENSORS in names and scene.sensors and all(sensor.name != ALL_SENSORS for sensor in scene.sensors):
        return list(scene.sensors)
    found = [_sensor(name, scene, problems) for name in names or (settings.sensor,)]
    return list({sensor.name: sensor for sensor in found if sensor is not None}.values())


def _sensor(name: str | None, scene: Scene, problems: list[str]) -> Sensor | None:
    """The sensor of a name, or the first one of an acceleration."""
    names = tuple(sensor.name for sensor in scene.sensors)
    if name is not None:
        for sensor in scene.sensors:
            if sensor.name == name:
                return sensor
        problems.append(
            f"{scene.name}: sensor {name!r:.60} is not there{closest(name, names)}; allowed: "
            f"{', '.join(names) or 'none'}"
        )
        return None
    for sensor in scene.sensors:
        if sensor.quantity == "acceleration":
            return sensor
    problems.append(
        f"{scene.name}: has no sensor of an acceleration; allowed: one of {', '.join(names) or 'none'} with --sensor, "
        "or a [[sensors]] more"
    )
    return None


_LEAST_ORDER = 1.0 - 1e-9
"""Of a load that turns, to be followed where no orders are asked for."""

_LEAST_PERIODS = 20.0
"""Of such a load in the run: a window, a tenth of a short run, holds two of them."""


def followed_orders(model: Model, settings: CampbellSettings, course: RunUp) -> list[tuple[float, str]]:
    """Orders to follow, with their names: those of the settings, else what the model excites.

    Parameters
    ----------
    model : Model
        Scene with a law.
    settings : CampbellSettings
        Orders, if any are named, and the highest frequency.
    course : RunUp
        The run.
    """
    if settings.orders:
        return [(order, f"{order:g}") for order in settings.orders]
    # None that lies above the band at every speed.
    slowest = min(abs(course.speed.at(at)[0]) for at in (0.0, course.duration))
    return orders_in_band(excited_orders(model, _turns(course)), settings.highest, slowest)


def orders_in_band(orders: Sequence[tuple[float, str]], highest: float, slowest: float) -> list[tuple[float, str]]:
    """Those of some orders that do not lie above a band at every speed.

    Parameters
    ----------
    orders : sequence of (float, str)
        Orders, with their names.
    highest : float
        Highest frequency [Hz].
    slowest : float
        Lowest speed of the run [rad/s].

    Examples
    --------
    >>> orders_in_band([(2.0, "2"), (200.0, "200")], 1000.0, 62.8)
    [(2.0, '2')]
    """
    top = 2.0 * math.pi * highest / slowest if slowest > 0.0 else math.inf
    return [(order, name) for order, name in orders if order < top]


def excited_orders(model: Model, turns: float) -> list[tuple[float, str]]:
    """Orders that a model excites itself, with their names: of gears, else of passing rollers, and of turning loads.

    Parameters
    ----------
    model : Model
        Scene with a law.
    turns : float
        Turns of the system in the run.

    Notes
    -----
    Of unbalances and excitations, those of less than one period a turn of the system, or of less than 20 periods in
    the run, are left out: the windows of all orders would have to be longer for them. Bearings with deviations from
    their form have that of the cage, too, in a run of 20 of its turns. Weight stands still, and has
    no order; how rollers pass under it is in theirs.
    """
    given = [
        (entry.element.name, one) for entry in model.system.elements if (one := entry.element.excitation) is not None
    ]
    highest_rank = max((one.rank for _, one in given), default=0)
    found: dict[float, list[str]] = {}
    for name, one in given:
        for k in range(1, (one.harmonics if one.rank == highest_rank else 0) + 1):
            # Rounded, for bearings that differ in the last bit only.
            found.setdefault(round(k * round(one.order, 9), 9), []).append(name)
    fewest = _LEAST_PERIODS / turns if turns > 0.0 else math.inf
    least = max(_LEAST_ORDER, fewest)
    for element in (entry.element for entry in model.system.elements if isinstance(entry.element, OnRings)):
        if element.deviation_data is None:
            continue
        for name, order in element.deviation_data.named_orders().items():
            known = found.setdefault(round(order, 9), []) if order >= fewest else []
            known[:] = [f"{element.name} {name}", *(one for one in known if one != element.name)]
    for load in model.system.turning:
        if abs(load.order) >= least:
            found.setdefault(round(abs(load.order), 9), [])
    return [(order, _order_name(order, found[order])) for order in sorted(found)]


def _order_name(order: float, elements: Sequence[str]) -> str:
    """Order with what excites it: a gear mesh or bearing, the first of several."""
    others = f" +{len(elements) - 1}" if elements[1:] else ""
    return f"{order:.4g}" + (f" {elements[0]}{others}" if elements else "")


def _turns(course: RunUp) -> float:
    """Turns of the system in a run."""
    return abs(course.speed.at(course.duration)[1] - course.speed.at(0.0)[1]) / (2.0 * math.pi)

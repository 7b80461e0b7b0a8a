"""Sensors whose levels are looked at: those of some names, or the first one of an acceleration."""

from __future__ import annotations

from collections.abc import Sequence

from ehdmaps.errors import InputError
from ehdmaps.units import closest
from mbs.model.elements import Sensor
from mbs.scene.scene import Scene
from mbs.settings import CampbellSettings

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

"""A scene with one thing changed: what comparisons vary. Each function gives a new scene and leaves the old one."""

from __future__ import annotations

import dataclasses

from ehdmaps.errors import InputError
from mbs.model.profiles import Course, SpeedProfile
from mbs.scene.scene import Scene
from mbs.scene.specs import HIGHEST_DAMPING_RATIO, FlexibleSpec
from mbs.settings import RunUp


def with_loads(scene: Scene, factor: float) -> Scene:
    """The scene with all its loads multiplied."""
    loads = tuple(dataclasses.replace(load, force=factor * load.force) for load in scene.loads)
    return dataclasses.replace(scene, loads=loads) if factor != 1.0 else scene


def with_start_angle(scene: Scene, angle: float) -> Scene:
    """The scene with all cages at another angle [rad]."""
    return scene.with_bearings(dataclasses.replace(entry, start_angle=angle) for entry in scene.bearings)


def with_slices(scene: Scene, slices: int) -> Scene:
    """The scene with another number of slices of all rollers."""
    return scene.with_bearings(dataclasses.replace(entry, slices=slices) for entry in scene.bearings)


def with_temperature(scene: Scene, temperature: float) -> Scene:
    """The scene with raceways of another temperature [K]."""
    return dataclasses.replace(scene, temperature=temperature)


def with_housing_damping(scene: Scene, factor: float) -> Scene:
    """The scene with the damping ratios of its bodies of finite elements multiplied.

    Parameters
    ----------
    scene : Scene
        The scene.
    factor : float
        Factor of the ratios.

    Raises
    ------
    InputError
        If there is no such body with damping, or a ratio were above `HIGHEST_DAMPING_RATIO`.
    """
    bodies = [body for body in scene.bodies if isinstance(body, FlexibleSpec) and body.damping_ratio > 0.0]
    if not bodies:
        raise InputError("the scene has no [[flexible]] body with a damping_ratio; allowed: for scenes that have one")
    highest = max(body.damping_ratio for body in bodies)
    if factor * highest > HIGHEST_DAMPING_RATIO:
        raise InputError(
            f"got the factor {factor:g} on a damping_ratio of {highest:g}; allowed: up to "
            f"{HIGHEST_DAMPING_RATIO / highest:.4g}, for ratios up to {HIGHEST_DAMPING_RATIO}"
        )
    changed = [
        dataclasses.replace(body, damping_ratio=factor * body.damping_ratio) if isinstance(body, FlexibleSpec) else body
        for body in scene.bodies
    ]
    return dataclasses.replace(scene, bodies=changed)


def with_duration(scene: Scene, duration: float) -> Scene:
    """The scene with its run-up stretched or shortened to another duration [s].

    Raises
    ------
    InputError
        If the scene has no run-up.
    """
    course = _run_up(scene)
    given = course.speed.course
    factor = duration / course.duration
    speed = SpeedProfile(Course(tuple(factor * time for time in given.times), given.values))
    return dataclasses.replace(scene, run_up=dataclasses.replace(course, speed=speed, duration=duration))


def with_step(scene: Scene, step: float) -> Scene:
    """The scene with another time step of its run-up [s], and a sample a step.

    Raises
    ------
    InputError
        If the scene has no run-up.
    """
    course = _run_up(scene)
    settings = dataclasses.replace(course.settings, step=step, sample=step)
    return dataclasses.replace(scene, run_up=dataclasses.replace(course, settings=settings))


def _run_up(scene: Scene) -> RunUp:
    """The run-up of a scene, which must have one."""
    if scene.run_up is None:
        raise InputError("the scene has no [runup]; allowed: for scenes that have one")
    return scene.run_up

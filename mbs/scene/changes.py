"""A scene with one thing changed: what comparisons vary. Each function gives a new scene and leaves the old one."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ehdmaps.errors import InputError, Problems
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.units import of_all
from mbs.model.drive import DrivenSpeed
from mbs.model.profiles import Advanced, Constant, Course, SpeedProfile
from mbs.scene.fields import HERTZ
from mbs.scene.scene import Scene
from mbs.scene.specs import HIGHEST_DAMPING_RATIO, BodySpec, FlexibleSpec, ShaftSpec
from mbs.settings import RunUp


def with_loads(scene: Scene, factor: float) -> Scene:
    """The scene with all its loads multiplied."""
    loads = tuple(dataclasses.replace(load, force=factor * load.force) for load in scene.loads)
    return dataclasses.replace(scene, loads=loads) if factor != 1.0 else scene


def with_start_angle(scene: Scene, angle: float) -> Scene:
    """The scene with all cages at another angle [rad]."""
    changed = scene.with_bearings(dataclasses.replace(entry, start_angle=angle) for entry in scene.bearings)
    return changed.with_located(lambda entry: dataclasses.replace(entry, start_angle=angle))


def with_slices(scene: Scene, slices: int) -> Scene:
    """The scene with another number of slices of all rollers."""
    changed = scene.with_bearings(dataclasses.replace(entry, slices=slices) for entry in scene.bearings)
    return changed.with_located(lambda entry: entry.sliced(lambda _: slices))


def with_supply(scene: Scene, supply: OilSupply) -> Scene:
    """The scene with another oil supply of all bearings; what single bearings state is outdone by it."""
    changed = scene.with_bearings(dataclasses.replace(entry, supply=None) for entry in scene.bearings)
    return dataclasses.replace(changed, supply=supply)


def with_layers(scene: Scene, factor: float) -> Scene:
    """The scene with all its oil layers thicker by a factor; what is flooded stays so.

    Raises
    ------
    InputError
        If a layer is none any more.
    """

    def scaled(supply: OilSupply | None) -> OilSupply | None:
        if supply is None or supply.flooded:
            return supply
        return dataclasses.replace(supply, oil_layer=factor * supply.oil_layer)

    changed = scene.with_bearings(dataclasses.replace(entry, supply=scaled(entry.supply)) for entry in scene.bearings)
    return dataclasses.replace(changed, supply=scaled(scene.supply))


def with_temperature(scene: Scene, temperature: float) -> Scene:
    """The scene with raceways of another temperature [K]."""
    return dataclasses.replace(scene, temperature=temperature)


def warmed(scene: Scene, kelvin: float) -> Scene:
    """The scene with all its temperatures higher: of raceways, and of what is around bearings with heat paths [K]."""
    changed = []
    for entry in scene.bearings:
        thermal = entry.thermal
        changed.append(entry if thermal is None else dataclasses.replace(entry, thermal=thermal.warmed(kelvin)))
    return with_temperature(scene.with_bearings(changed), scene.temperature + kelvin)


def with_clearance(scene: Scene, clearance: float) -> Scene:
    """The scene with another diametral clearance of all bearings that have one [m].

    What single bearings state of theirs is outdone by it.

    Parameters
    ----------
    scene : Scene
        The scene.
    clearance : float
        Clearance [m].

    Raises
    ------
    InputError
        For each bearing that cannot have it.
    """
    problems = Problems()
    for entry in scene.of_all_kinds:
        with problems:
            scene = with_clearance_of(scene, entry.name, clearance)
    problems.check()
    return dataclasses.replace(scene, tolerances=of_all(scene.tolerances, "clearance"))


def with_clearance_of(scene: Scene, bearing: str, clearance: float) -> Scene:
    """The scene with another diametral clearance of one bearing [m].

    Parameters
    ----------
    scene : Scene
        The scene.
    bearing : str
        Name of the bearing.
    clearance : float
        Clearance [m].

    Raises
    ------
    InputError
        If no such bearing can have it.
    """
    return with_bearing(
        scene, bearing, lambda entry: dataclasses.replace(entry, geometry=entry.geometry.with_clearance(clearance))
    )


def with_bearing(scene: Scene, bearing: str, change: Callable[[Any], Any]) -> Scene:
    """The scene with one of its bearings changed.

    Parameters
    ----------
    scene : Scene
        The scene.
    bearing : str
        Name of the bearing.
    change : callable
        Makes another `BearingSpec` or `LocatingSpec` of it.
    """
    there = {entry.name for entry in scene.of_all_kinds} & {bearing}
    changed = [change(entry) if getattr(entry, "name", "") in there else entry for entry in scene.elements]
    return dataclasses.replace(scene, elements=changed)


def with_speed(scene: Scene, speed: float) -> Scene:
    """The scene at another operating speed [rad/s]."""
    return dataclasses.replace(scene, speed=speed)


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


def with_damping_ratio(scene: Scene, body: str, ratio: float) -> Scene:
    """The scene with another damping ratio of one shaft, or one body of finite elements.

    Parameters
    ----------
    scene : Scene
        The scene.
    body : str
        Name of the body.
    ratio : float
        Damping ratio of its free modes.
    """
    bodies = [
        dataclasses.replace(one, damping_ratio=ratio)
        if isinstance(one, (ShaftSpec, FlexibleSpec)) and one.name == body
        else one
        for one in scene.bodies
    ]
    return dataclasses.replace(scene, bodies=bodies)


def with_duration(scene: Scene, duration: float) -> Scene:
    """The scene with its run-up stretched or shortened to another duration [s].

    Raises
    ------
    InputError
        If the scene has no run-up.
    """
    course = _run_up(scene)
    if isinstance(course.speed, DrivenSpeed):
        raise InputError("the scene has a [drive], whose torques make the length of the run-up; change those instead")
    given = course.speed.course
    factor = duration / course.duration
    speed = SpeedProfile(Course(tuple(factor * time for time in given.times), given.values))
    return dataclasses.replace(scene, run_up=dataclasses.replace(course, speed=speed, duration=duration))


def hurried(scene: Scene, factor: float) -> Scene:
    """The scene with its whole run-up in a part of its time, to a whole step; a drive's by motor and load alone.

    Parameters
    ----------
    scene : Scene
        The scene.
    factor : float
        Part of the time, up to 1.

    Raises
    ------
    InputError
        If the scene has no run-up.
    """
    course = _run_up(scene)
    step = course.settings.step
    prescribed = dataclasses.replace(course, speed=SpeedProfile(course.speed.course))
    scene = dataclasses.replace(scene, run_up=prescribed)
    return with_step(with_duration(scene, max(round(factor * course.duration / step), 1) * step), step)


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


def with_part(scene: Scene, begin: float, end: float) -> Scene:
    """The scene with a part of its run-up alone; loads that vary are those of that time.

    Parameters
    ----------
    scene : Scene
        The scene.
    begin, end : float
        Times of the run-up [s], 0 <= begin < end.

    Raises
    ------
    InputError
        If the scene has no run-up.
    """
    course = _run_up(scene)
    part = dataclasses.replace(course, speed=course.speed.part(begin, end), duration=end - begin)
    loads = tuple(
        load
        if isinstance(load.profile, Constant) or begin == 0.0
        else dataclasses.replace(load, profile=Advanced(load.profile, begin))
        for load in scene.loads
    )
    return dataclasses.replace(scene, run_up=part, loads=loads)


def cutoff_of(scene: Scene) -> float | None:
    """Highest cut-off of the flexible bodies of a scene [Hz]; None where no body has one.

    That of a body from a reduced file is the frequency of its highest mode.
    """
    return max((found for body in scene.bodies if (found := _cutoff(body)) is not None), default=None)


def with_cutoff(scene: Scene, cutoff: float) -> Scene:
    """The scene with modes of its flexible bodies up to another frequency.

    Parameters
    ----------
    scene : Scene
        The scene.
    cutoff : float
        Frequency [Hz]. Shafts and bodies of finite elements are reduced again; of a body that is read from a reduced
        file modes are left out, or all are kept where they end below it.

    Raises
    ------
    InputError
        If no body has a cut-off, or no body can follow one so high, or modes cannot be left out.
    """
    bodies = [body for body in scene.bodies if _cutoff(body) is not None]
    if not bodies:
        raise InputError("the scene has no flexible body with a cut-off; allowed: for scenes that have one")
    if not any(_may_rise(body) or cutoff <= (_cutoff(body) or 0.0) for body in bodies):
        raise InputError(
            f"got {HERTZ.text(cutoff)}; allowed: up to {HERTZ.text(max(_cutoff(body) or 0.0 for body in bodies))}, the "
            "highest mode of the reduced files; reduce the bodies again with a higher cut-off for more"
        )
    return dataclasses.replace(scene, bodies=[_cut(body, cutoff) for body in scene.bodies])


def _may_rise(body: BodySpec) -> bool:
    """Tell whether a body can be reduced to more modes than it has."""
    from mbs.flexible.plan import ReductionPlan  # with all that reduces bodies

    return isinstance(body, ShaftSpec) or (isinstance(body, FlexibleSpec) and isinstance(body.source, ReductionPlan))


def _cutoff(body: BodySpec) -> float | None:
    """Frequency up to which a body has modes [Hz]; None where it has none, or all."""
    from mbs.flexible.plan import ReductionPlan
    from mbs.flexible.reduced_body import mode_frequencies
    from mbs.flexible.reduced_file import read_reduced

    if isinstance(body, ShaftSpec):
        return body.cutoff
    if not isinstance(body, FlexibleSpec):
        return None
    if isinstance(body.source, ReductionPlan):
        return body.source.cutoff
    found = mode_frequencies(read_reduced(body.source) if isinstance(body.source, Path) else body.source)
    return float(np.nanmax(found)) if np.isfinite(found).any() else None


def _cut(body: BodySpec, cutoff: float) -> BodySpec:
    """A body with another cut-off."""
    from mbs.flexible.plan import ReductionPlan
    from mbs.flexible.reduced_body import up_to
    from mbs.flexible.reduced_file import read_reduced

    if isinstance(body, ShaftSpec):
        return body if body.cutoff is None else dataclasses.replace(body, cutoff=cutoff, cutoff_stated=True)
    if not isinstance(body, FlexibleSpec):
        return body
    if isinstance(body.source, ReductionPlan):
        return dataclasses.replace(body, source=dataclasses.replace(body.source, cutoff=cutoff))
    source = read_reduced(body.source) if isinstance(body.source, Path) else body.source
    less = up_to(source, cutoff)
    # Where nothing is left out the body stays known by its file.
    return body if less is source else dataclasses.replace(body, source=less)


def _run_up(scene: Scene) -> RunUp:
    """The run-up of a scene, which must have one."""
    if scene.run_up is None:
        raise InputError("the scene has no [runup]; allowed: for scenes that have one")
    return scene.run_up

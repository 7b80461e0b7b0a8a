"""Question that an analysis asks of a scene: of all speeds that a scene file states, those that the analysis visits.

Loads, films and the physics that matters follow from these. `at_one_speed` is for statics, modes, responses and hammer
tests, `over_speeds` for sweeps and critical speeds, `in_time` for run-ups.
"""

from __future__ import annotations

import dataclasses

from mbs.scene.scene import Scene
from mbs.settings import SweepRange


def at_one_speed(scene: Scene) -> Scene:
    """The scene as an analysis at its operating speed visits it.

    Parameters
    ----------
    scene : Scene
        The scene. One that stands still in [operation] keeps its other speeds: at rest no film is there to be judged.

    Examples
    --------
    >>> from mbs import read_scene
    >>> at_one_speed(read_scene("nu308_rigid")).run_up is None
    True
    """
    return scene if scene.speed == 0.0 else dataclasses.replace(scene, run_up=None, sweep=None)


def over_speeds(scene: Scene, speeds: SweepRange | None, and_operation: bool = False) -> Scene:
    """The scene as an analysis over speed visits it.

    Parameters
    ----------
    scene : Scene
        The scene.
    speeds : SweepRange or None
        The speeds; None for those of [sweep].
    and_operation : bool
        Whether the operating speed is visited as well.
    """
    swept = speeds or scene.sweep
    if swept is None:
        return at_one_speed(scene)
    return dataclasses.replace(scene, run_up=None, sweep=swept, speed=scene.speed if and_operation else swept.end)


def in_time(scene: Scene) -> Scene:
    """The scene as a run-up visits it.

    Parameters
    ----------
    scene : Scene
        The scene, with [runup].
    """
    if scene.run_up is None:
        return scene
    fastest = max(scene.run_up.speed.course.values, key=abs)
    return dataclasses.replace(scene, sweep=None, speed=fastest)

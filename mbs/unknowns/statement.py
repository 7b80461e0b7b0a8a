"""Statements on how well a number of a scene is known: the nearest one wins.

A command (`--know`) is nearer than a bearing ("25 um +- 5 um"), and a bearing nearer than the table [tolerances].
A scene keeps them in one mapping, `Scene.tolerances`: "clearance of drive" of one bearing, "clearance" of all.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ehdmaps.jobs.tolerances import Tolerance

if TYPE_CHECKING:
    from mbs.scene.scene import Scene


def of_bearing(group: str, bearing: str) -> str:
    """Key of a statement on one bearing."""
    return f"{group} of {bearing}"


def tolerance_of(scene: Scene, group: str, bearing: str = "") -> Tolerance | None:
    """The nearest tolerance that is stated; None where none is.

    Parameters
    ----------
    scene : Scene
        The scene.
    group : str
        A key of [tolerances].
    bearing : str
        Name of a bearing; empty for what all share.
    """
    found = scene.tolerances.get(of_bearing(group, bearing)) if bearing else None
    return found or scene.tolerances.get(group)

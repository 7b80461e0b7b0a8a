"""Rigid parts fixed to the frames of a flexible body, such as the outer rings in a housing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ehdmaps.errors import InputError
from mbs.model.body import Body, Inertia, lever_arm


@dataclass(frozen=True)
class Attached:
    """A rigid part on a frame.

    Attributes
    ----------
    frame : str
        Name of the frame.
    inertia : Inertia
        Mass and moments of inertia; the offset is that of the centre of mass from the frame, along x.
    """

    frame: str
    inertia: Inertia


def attach(body: Body, parts: Sequence[Attached]) -> Body:
    """The body with rigid parts fixed to its frames; they add mass, and stiffen nothing.

    Parameters
    ----------
    body : Body
        The reduced body. Modes that it was reduced to stay its coordinates, so parts much heavier than what they sit on
        ask for a higher cut-off.
    parts : sequence of Attached
        Parts on frames whose six displacements are known.

    Raises
    ------
    InputError
        For frames that the body does not have.
    """
    problems = [
        f"body {body.name!r}, attached: got the frame {part.frame!r}; allowed: {', '.join(body.frames)}"
        for part in parts
        if part.frame not in body.frames
    ]
    if problems:
        raise InputError(problems)
    mass, gyroscopic = body.mass.copy(), body.gyroscopic.copy()
    for part in parts:
        m, polar, transverse = part.inertia.mass, part.inertia.polar, part.inertia.transverse
        transform = lever_arm((part.inertia.offset, 0.0, 0.0)) @ body.frames[part.frame].transform
        mass += transform.T @ np.diag([m, m, m, polar, transverse, transverse]) @ transform
        about_y, about_z = transform[4], transform[5]
        gyroscopic += polar * (np.outer(about_y, about_z) - np.outer(about_z, about_y))
    return replace(body, mass=mass, gyroscopic=gyroscopic)

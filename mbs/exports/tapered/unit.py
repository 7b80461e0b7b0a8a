"""A bearing of tapered rollers, or of cylindrical ones between ribs, as a Functional Mock-up Unit, by the C kernel."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path

from ehdmaps.exports.fmu.variables import Variable
from ehdmaps.physics.rollers.ribbed_geometry import RibbedGeometry
from mbs.bearings.tapered.tapered_bearing import TaperedForce
from mbs.exports.balls.speed_laws import SpeedLaws
from mbs.exports.balls.unit import BALL_VARIABLES, MEMORY_STEPS, write_bearing_unit
from mbs.exports.tapered.source import exported_play, source_texts

_OFFSET = Variable(
    "axial_offset",
    "parameter",
    "m",
    "Way of the inner ring along x against the outer one in the pose zero, which preloads",
)
_MIRRORED = "1: the bearing stands the other way round; else 0"

MOTION = (
    "x is the axis of the bearing; the frame is that of the outer ring, in the plane of the middles of the rollers, "
    "and does not spin. There is no moment about x. In the pose zero tapered rollers just touch and cylindrical ones "
    "are in the middle of their play; tapered rollers and NJ carry an axial force on the inner ring in +x, mirrored "
    "ones in -x. Inputs start at rest under the load of the export.",
    "pose, velocity and force are those of the inner ring, right-handed. The derivatives of the outputs by the pose "
    "are -K, by the velocity -C, at speeds that are held; those by the others are quotients of differences.",
    "The rollers stand where the spins bring them, with a cage in pure rolling; the first one stands on the y axis at "
    "spins of zero. Each is in balance at once between raceways and ribs, with its centrifugal load and gyroscopic "
    "moment.",
)
"""Axes, signs and what is left out, for people."""

SLOW = "Films follow at once: there are no states."
"""What units without memory say."""

_KEEPS = (
    "Films need time to follow: each slice of both raceways has a spring in series with a damper, which begin at rest"
)


def variables_of(force: TaperedForce) -> tuple[Variable, ...]:
    """Those of a ball bearing; a tapered one has an axial offset in place of the clearance.

    Parameters
    ----------
    force : TaperedForce
        The bearing.
    """
    own = {"mirrored": _MIRRORED}
    named = [dataclasses.replace(variable, words=own.get(variable.name, variable.words)) for variable in BALL_VARIABLES]
    if isinstance(force.geometry, RibbedGeometry):
        return tuple(named)
    return tuple(_OFFSET if variable.name == "clearance" else variable for variable in named)


def write_tapered_unit(
    path: str | Path, force: TaperedForce, laws: SpeedLaws, start: Mapping[str, float], header: Sequence[str]
) -> str:
    """Write a unit, and return what was written in words.

    Parameters
    ----------
    path : str or Path
        File of the unit; `NAME.fmi3.fmu` is one by FMI 3.0, others are by FMI 2.0.
    force : TaperedForce
        The bearing, dry.
    laws : SpeedLaws
        Laws of both lines, of `line_speed_laws`.
    start : mapping of str to float
        Pose and speeds at the start, by the names of the variables; zero where they are left out.
    header : sequence of str
        Lines that say where it comes from.

    Raises
    ------
    InputError
        If a compiler fails, or the file may not be written.
    """
    ribbed = isinstance(force.geometry, RibbedGeometry)
    begin = {**start, "clearance": exported_play(force)} if ribbed else start
    title = f"{'Cylindrical' if ribbed else 'Tapered'} roller bearing {force.geometry.title}"
    texts = source_texts(force, laws, header)
    sentences = (*MOTION, f"{_KEEPS}; {MEMORY_STEPS}" if laws.memory else SLOW)
    return write_bearing_unit(
        path, title, texts, variables_of(force), begin, sentences, header, exchanges=not laws.memory
    )

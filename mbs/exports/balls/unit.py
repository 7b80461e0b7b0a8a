"""A ball bearing as a Functional Mock-up Unit, by the kernel in C: variables, and what the unit says of itself."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from ehdmaps.exports.c.text import number, template
from ehdmaps.exports.fmu.unit import Content, write_unit
from ehdmaps.exports.fmu.variables import LAG, VARIABLES, Variable
from mbs.bearings.balls.ball_bearing import BallForce
from mbs.exports.balls.source import source_texts
from mbs.exports.balls.speed_laws import SpeedLaws

_RING = "of the inner ring in the frame of the outer one"
_OF_ROLLERS = {variable.name: variable for variable in VARIABLES}

BALL_VARIABLES = (
    _OF_ROLLERS["time"],
    Variable("pose.x", "input", "m", f"Displacement {_RING}, axial"),
    *(_OF_ROLLERS[f"pose.{name}"] for name in ("y", "z", "theta_y", "theta_z")),
    Variable("velocity.x", "input", "m/s", "Rate of pose.x"),
    *(_OF_ROLLERS[f"velocity.{name}"] for name in ("y", "z", "theta_y", "theta_z")),
    *(_OF_ROLLERS[name] for name in ("spin.inner", "spin.outer", "speed.inner", "speed.outer", "clearance")),
    Variable("mirrored", "parameter", "1", "1: an angular contact bearing stands the other way round; else 0"),
    Variable("force.x", "output", "N", "Axial force on the inner ring; the outer one gets the opposite"),
    *(_OF_ROLLERS[name] for name in ("force.y", "force.z", "moment.y", "moment.z")),
)
"""Those of a roller bearing, with what goes along the axis; in the order of `component.h`."""

MOTION = (
    "x is the axis of the bearing; the frame is that of the outer ring and does not spin. There is no moment about x. "
    "In the pose zero angular contact bearings without clearance just touch; they carry an axial force on the inner "
    "ring in +x, mirrored ones in -x. Inputs start at rest under the load of the export.",
    "pose, velocity and force are those of the inner ring, right-handed. The derivatives of the outputs by the pose "
    "are -K, by the velocity -C, at speeds of the rings that are held; those by the others are quotients of "
    "differences.",
    "The balls stand where the spins bring them, with a cage in pure rolling at the nominal contact angle; the first "
    "one stands on the y axis at spins of zero. Their centrifugal load and gyroscopic moment are those of balls that "
    "roll at both raceways, by the contact angles of the pose, and do not drill at the outer one.",
)
"""Axes, signs and what is left out, for people."""

SLOW = "Each ball is in balance at once and films follow at once: there are no states."
"""What units without memory say."""

MEMORY_STEPS = (
    "Co-Simulation alone has them. The inputs that are set before a step are those of "
    "its end: the ring moves there from the inputs of the last step (of the initialization at first), along a cubic by "
    "the velocities, or straight where they are not given, and the unit takes steps of up to 5 us of its own. The "
    "derivatives by the pose are those of films that have no time to give way, those by the velocity are zero."
)
"""How units with memory make steps."""

MEMORY = (
    "Each ball is in balance at once. Films need time to follow: each contact has three springs in series with "
    f"dampers, which begin at rest; {MEMORY_STEPS}"
)
"""What units with memory say."""

BEYOND = (
    "Poses where no raceway is are discarded. Slower and faster than the speeds of the export its films are held, and "
    "above their loads they go on straight in the logarithms, with a warning in the log."
)
"""What happens outside of what the law was made for, for people."""

VERSIONS = {".fmi2": "2", ".fmi3": "3"}
"""Versions of the standard by what stands before the ending of a name; 2 where there is nothing."""


def write_ball_unit(
    path: str | Path,
    force: BallForce,
    laws: SpeedLaws,
    start: Mapping[str, float],
    header: Sequence[str],
) -> str:
    """Write a unit, and return what was written in words.

    Parameters
    ----------
    path : str or Path
        File of the unit; `NAME.fmi3.fmu` is one by FMI 3.0, others are by FMI 2.0.
    force : BallForce
        Geometry and material.
    laws : SpeedLaws
        Laws of the contacts.
    start : mapping of str to float
        Pose and speeds at the start, by the names of the variables; zero where they are left out.
    header : sequence of str
        Lines that say where it comes from.

    Raises
    ------
    InputError
        If a compiler fails, or the file may not be written.
    """
    texts, title = source_texts(force, laws, header), f"Ball bearing {force.geometry.title}"
    begin = {**start, "clearance": force.geometry.clearance}
    sentences = (*MOTION, MEMORY if laws.memory else SLOW)
    return write_bearing_unit(path, title, texts, BALL_VARIABLES, begin, sentences, header, exchanges=not laws.memory)


def write_bearing_unit(
    path: str | Path,
    title: str,
    texts: Mapping[str, str],
    variables: tuple[Variable, ...],
    start: Mapping[str, float],
    sentences: tuple[str, ...],
    header: Sequence[str],
    *,
    exchanges: bool = True,
) -> str:
    """Write a unit of a bearing by its kernel in C, and return what was written in words.

    Parameters
    ----------
    path : str or Path
        File of the unit.
    title : str
        What it is.
    texts : mapping of str to str
        Texts of the header, `h`, and of the source, `c`.
    variables : tuple of Variable
        Variables, in the order of `component.h`.
    start : mapping of str to float
        Values at the start, by the names of the variables; zero where they are left out.
    sentences : tuple of str
        Axes, signs and what is left out, for people.
    header : sequence of str
        Lines that say where it comes from.
    exchanges : bool
        Whether there is Model Exchange, beside Co-Simulation.

    Raises
    ------
    InputError
        If a compiler fails, or the file may not be written.
    """
    place = Path(path)
    values = ", ".join(number(start.get(variable.name, 0.0)) for variable in variables)
    content = Content(
        words=title,
        checksum=hashlib.sha256(texts["c"].encode()).hexdigest(),
        variables=variables,
        start=start,
        films=(),
        sources={
            "bearing.h": texts["h"],
            "bearing.c": texts["c"],
            **{name: template("mbs.exports.balls", f"unit_files/{name}") for name in ("component.c", "component.h")},
        },
        defines=f"#define FMU_START {{{values}}} /* of all variables */\n",
        sentences=(*sentences, LAG),
        exchanges=exchanges,
        beyond=BEYOND,
        header=tuple(header),
    )
    return write_unit(place, content, VERSIONS.get(Path(place.stem).suffix.lower(), "2"))

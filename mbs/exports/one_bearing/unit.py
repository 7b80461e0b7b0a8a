"""A bearing as a Functional Mock-up Unit, by the kernel in C: variables, and what the unit says of itself."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ehdmaps.exports.c.text import number, template
from ehdmaps.exports.fmu.unit import Content, write_unit
from ehdmaps.exports.fmu.variables import DEVIATING, LAG, VARIABLES, Variable
from mbs.bearings.deviating.tables import DeviationData
from mbs.exports.one_bearing.kind import ExportKind
from mbs.exports.one_bearing.source import source_texts
from mbs.exports.one_bearing.speed_laws import SpeedLaws

_RING = "of the inner ring in the frame of the outer one"
_OF_ROLLERS = {variable.name: variable for variable in VARIABLES}

_VARIABLES = (
    _OF_ROLLERS["time"],
    Variable("pose.x", "input", "m", f"Displacement {_RING}, axial"),
    *(_OF_ROLLERS[f"pose.{name}"] for name in ("y", "z", "theta_y", "theta_z")),
    Variable("velocity.x", "input", "m/s", "Rate of pose.x"),
    *(_OF_ROLLERS[f"velocity.{name}"] for name in ("y", "z", "theta_y", "theta_z")),
    *(_OF_ROLLERS[name] for name in ("spin.inner", "spin.outer", "speed.inner", "speed.outer", "clearance")),
    Variable("mirrored", "parameter", "1", "1: the bearing stands the other way round; else 0"),
    Variable("force.x", "output", "N", "Axial force on the inner ring; the outer one gets the opposite"),
    *(_OF_ROLLERS[name] for name in ("force.y", "force.z", "moment.y", "moment.z")),
)
"""Those of a roller bearing, with what goes along the axis; in the order of `variables.h`."""

_MEMORY_STEPS = (
    "Co-Simulation alone has them. The inputs that are set before a step are those of "
    "its end: the ring moves there from the inputs of the last step (of the initialization at first), along a cubic by "
    "the velocities, or straight where they are not given, and the unit takes steps of up to 5 us of its own. The "
    "derivatives by the pose are those of films that have no time to give way, those by the velocity are zero."
)
"""How units with memory make steps."""

BEYOND = (
    "Poses where no raceway is are discarded. Slower and faster than the speeds of the export its films are held, and "
    "above their loads they go on straight in the logarithms, with a warning in the log."
)
"""What happens outside of what the law was made for, for people."""

VERSIONS = {".fmi2": "2", ".fmi3": "3"}
"""Versions of the standard by what stands before the ending of a name; 2 where there is nothing."""


def variables_of(kind: ExportKind) -> tuple[Variable, ...]:
    """Variables of the units of a kind, in the order of `variables.h`.

    Parameters
    ----------
    kind : ExportKind
        Kind of the bearing.
    """
    named = [
        dataclasses.replace(variable, name=kind.play_name) if variable.name == "clearance" else variable
        for variable in _VARIABLES
    ]
    return tuple(
        dataclasses.replace(variable, words=kind.own_words.get(variable.name, variable.words)) for variable in named
    )


def write_bearing_unit(
    kind: ExportKind,
    path: str | Path,
    force: Any,
    laws: SpeedLaws,
    start: Mapping[str, float],
    header: Sequence[str],
    deviations: DeviationData | None = None,
) -> str:
    """Write a unit of a bearing by its kernel in C, and return what was written in words.

    Parameters
    ----------
    kind : ExportKind
        Kind of the bearing.
    path : str or Path
        File of the unit; `NAME.fmi3.fmu` is one by FMI 3.0, others are by FMI 2.0.
    force : BallForce or TaperedForce
        The bearing, dry.
    laws : SpeedLaws
        Laws of the contacts.
    start : mapping of str to float
        Pose and speeds at the start, by the names of the variables; zero where they are left out.
    header : sequence of str
        Lines that say where it comes from.
    deviations : DeviationData or None
        Deviations of the bearing from its form.

    Raises
    ------
    InputError
        If a compiler fails, or the file may not be written.
    """
    place, geometry = Path(path), force.geometry
    texts, variables = source_texts(kind, force, laws, header, deviations=deviations), variables_of(kind)
    start = {**start, kind.play_name: kind.play(geometry)}
    values = ", ".join(number(start.get(variable.name, 0.0)) for variable in variables)
    files = {name: template("mbs.exports.one_bearing", f"unit_files/{name}") for name in ("motion.c", "variables.h")}
    content = Content(
        words=kind.title(geometry),
        checksum=hashlib.sha256(texts["c"].encode()).hexdigest(),
        variables=variables,
        start=start,
        films=(),
        sources={"bearing.h": texts["h"], "bearing.c": texts["c"], **files},
        defines=f"#define FMU_START {{{values}}} /* of all variables */\n",
        sentences=(
            *kind.motion,
            *([DEVIATING] if deviations else []),
            f"{kind.memory}; {_MEMORY_STEPS}" if laws.memory else kind.slow,
            LAG,
        ),
        exchanges=not laws.memory,
        beyond=BEYOND,
        header=tuple(header),
    )
    return write_unit(place, content, VERSIONS.get(Path(place.stem).suffix.lower(), "2"))

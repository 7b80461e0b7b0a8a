"""Files of a bearing for linear programs: its stiffness and damping around a load, by the ending of the file."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.outputs import MARK, Output, write_text
from ehdmaps.units import RPM
from ehdmaps.version import version
from mbs.output.files import result_kind
from mbs.scene.fields import FORCE

if TYPE_CHECKING:
    from mbs.exports.linear_bearing import Format

LINEAR = (".toml", ".bdf", ".inp", ".txt")
"""Endings of files for linear programs: ROSS, Nastran, CalculiX or Abaqus, Ansys; see `mbs.exports.linear_bearing`."""


def ending_of(path: str | None) -> str:
    """Ending of a path, in lower case; empty without one."""
    return "" if path is None else Path(path).suffix.lower()


def is_linear(path: str | None) -> bool:
    """Tell whether a result is a file for a linear program, by the path of -o."""
    return ending_of(path) in LINEAR


def linear_outputs(path: str | None, others: Sequence[str] = ()) -> tuple[Output, ...]:
    """File that -o asks for: a result, or a file for a linear program.

    Parameters
    ----------
    path : str or None
        Path of -o.
    others : sequence of str
        Further endings that a message names.
    """
    if path is not None and is_linear(path):
        return (Output("-o", path, _format(path).kind),)
    kind = result_kind(path)
    if ".nc" in kind.endings:
        kind = dataclasses.replace(kind, endings=(*kind.endings, *LINEAR, *others))
    return (Output("-o", path, kind),)


def count_problems(path: str | None, loads: int, speeds: int, *, of_one_load: bool = False) -> list[str]:
    """Problems with more loads or speeds than a file for another program has.

    Parameters
    ----------
    path : str or None
        Path of -o.
    loads, speeds : int
        How many there are.
    of_one_load : bool
        Whether a file that is for no linear program has one load, too.
    """
    one_speed = path is not None and is_linear(path) and _format(path).one_speed
    if not (is_linear(path) or of_one_load) or (loads <= 1 and (speeds <= 1 or not one_speed)):
        return []
    return [
        f"-o: got {path} for {loads} loads and {speeds} speeds; allowed: one load"
        + (", one speed" if one_speed else "")
        + ", or a file .nc or .csv"
    ]


def header_of(heading: Sequence[str]) -> tuple[str, ...]:
    """Lines that say where a file comes from; the first one carries the mark of our files.

    Parameters
    ----------
    heading : sequence of str
        What was computed, as it is told to people.
    """
    from ehdmaps.exports.target import BEARING_AXES  # with maps, which points do not need

    return (f"{MARK} {version()}", *BEARING_AXES, *(line.strip() for line in heading))


def around(points: Sequence[Any]) -> tuple[str, ...]:
    """The load of points over speed, and what is to be known of them.

    Parameters
    ----------
    points : sequence
        Points at one load.
    """
    point = points[0]
    return (
        f"linear around: radial {FORCE.text(point.size)}, axial {FORCE.text(point.axial)} on the inner ring",
        *dict.fromkeys(line for point in points for line in (*point.problems, *point.notes)),
    )


class Oscillating(NamedTuple):
    """Stiffness and damping of points for oscillations, in place of those of slow motion.

    Attributes
    ----------
    words : str
        Frequencies, for people.
    frequencies : array (m,)
        Frequencies [Hz]; zero alone where each speed has its own.
    matrices : array (points, 2, m, 6, 6)
        K and C.
    """

    words: str
    frequencies: FloatArray
    matrices: FloatArray


def write_linear(
    path: str,
    name: str,
    heading: Sequence[str],
    points: Sequence[Any],
    outer_speed: float,
    oscillating: Oscillating | None = None,
) -> str:
    """Write stiffness and damping over speed for a linear program, and return what was written in words.

    Parameters
    ----------
    path : str
        Path of -o; `is_linear` holds.
    name : str
        Name of the bearing.
    heading : sequence of str
        What was computed, as it is told to people.
    points : sequence
        Points at the one load, over the speeds.
    outer_speed : float
        Speed of the outer ring [rad/s].
    oscillating : Oscillating or None
        K and C for oscillations; None for those of slow motion.

    Raises
    ------
    InputError
        If it cannot be written, or the format cannot hold it.
    """
    from mbs.exports.linear_bearing import LinearBearing

    program = _format(path)
    load, *notes = around(points)
    if oscillating is None:
        matrices = np.array([[point.stiffness, point.damping] for point in points])[:, :, None]
        oscillating = Oscillating("of slow motion", np.zeros(1), matrices)
    motion = f"K and C {oscillating.words}; the outer ring turns with {RPM.text(outer_speed)}"
    speeds, matrices = np.array([point.inner_speed for point in points]), oscillating.matrices
    bearing = LinearBearing(name, speeds, oscillating.frequencies, matrices[:, 0], matrices[:, 1])
    write_text(path, program.plain(bearing, (*header_of(heading), load, motion, *notes)), program.kind)
    return f"{path}: written"


def _format(path: str) -> Format:
    """Format of a linear program."""
    from mbs.exports.linear_bearing import format_of

    return format_of(ending_of(path))

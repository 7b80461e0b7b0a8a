"""Target `ansys`: stiffness and damping over speed, as the bearing file of Ansys Mechanical APDL.

Format: Ansys Rotordynamic Analysis Guide, appendix A, "Bearing Characteristics File Format": three titles (A80),
number of steps and keys of units (3I10), and for each speed its number and value (I10, F10.2), K11, K12, K21, K22 and
C11, C12, C21, C22 (4E15.7). Both keys are 0 here: SI, no conversion. A number with its point may have more digits than
F10.2 says.
"""

from __future__ import annotations

import argparse

from ehdmaps.errors import Problems
from ehdmaps.outputs import Kind, has_mark
from mbs.exports.linear_bearing import Format, LinearBearing
from mbs.exports.linear_table import target

KIND = Kind("a bearing file for Ansys made by ehdmaps", (".txt",), has_mark)

_TITLE = 80
_FASTEST = 99999.9999
"""Speed that fits its field [rad/s]."""


def _text(bearing: LinearBearing, header: tuple[str, ...], _: argparse.Namespace) -> str:
    """Write the file; what does not fit its three titles stands behind the numbers, which Ansys does not read."""
    problems = Problems()
    if bearing.frequencies.size > 1:
        problems.append(
            f"--frequency: got {bearing.frequencies.size} values; allowed: one, since Ansys' file has speeds only"
        )
    if bearing.speeds[-1] > _FASTEST:
        problems.append(f"--speed: got {bearing.speeds[-1]:.6g} rad/s; allowed: up to {_FASTEST:.6g} rad/s")
    problems.check()
    titles = (
        header[0],
        f"bearing {bearing.name}; 1 is y, 2 is z, both radial; N/m, N s/m, rad/s",
        "the rest: at the end",
    )
    lines = [title[:_TITLE] for title in titles]
    lines.append(f"{bearing.speeds.size:10d}{0:10d}{0:10d}")
    for index, speed in enumerate(bearing.speeds):
        lines.append(f"{index + 1:10d}{speed:10.4f}")
        for matrix in (bearing.stiffness[index, 0], bearing.damping[index, 0]):
            lines.append("".join(f"{matrix[i, j]:15.7E}" for i in (1, 2) for j in (1, 2)))
    left_out = ("left out: stiffness and damping along the axis and of tilts",) if bearing.axial else ()
    return "\n".join([*lines, "", *header, *bearing.left_out(axial_terms=True), *left_out]) + "\n"


FORMAT = Format(KIND, "bearing characteristics over speed of Mechanical APDL", "", _text)
TARGET = target(FORMAT)

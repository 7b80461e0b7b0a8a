"""Target `matrices`: K and C of a bearing over speed and frequency as columns of numbers, with their errors.

Rotor programs read such columns from a file, or have a sheet into which they are pasted: rpm, the four terms of K and
the four of C in the radial plane, row by row. Their x is our y, their y is our z.
"""

from __future__ import annotations

import argparse

import numpy as np

from ehdmaps.outputs import Kind, has_mark
from ehdmaps.units import RPM
from mbs.exports.linear_bearing import Format, LinearBearing
from mbs.exports.linear_table import target

KIND = Kind("matrices of a bearing made by ehdmaps", (".csv",), has_mark)

COLUMNS = (
    "speed [rpm]",
    *(f"K{i}{j} [N/m]" for i in "yz" for j in "yz"),
    *(f"C{i}{j} [N s/m]" for i in "yz" for j in "yz"),
    "frequency [Hz]",
    "|dZ/Z| [1]",
)


def _text(bearing: LinearBearing, header: tuple[str, ...], _: argparse.Namespace) -> str:
    """Write a row for each speed and frequency."""
    errors = bearing.dynamic_error()
    lines = [f"# {line}" for line in header]
    lines += [
        "# columns 1 to 9, as rotor programs take them: speed, Kxx Kxy Kyx Kyy, Cxx Cxy Cyx Cyy; x there is y, y is z",
        "# |dZ/Z|: estimated error of the dynamic stiffness along the load at the frequency",
        ",".join(COLUMNS),
    ]
    for index, speed in enumerate(bearing.speeds):
        for at, frequency in enumerate(bearing.frequencies):
            terms = [matrices[index, at, 1:3, 1:3].ravel() for matrices in (bearing.stiffness, bearing.damping)]
            row = [RPM.value(float(speed)), *np.concatenate(terms), frequency, errors[index, at]]
            lines.append(",".join(f"{value:.12g}" for value in row))
    return "\n".join(lines) + "\n"


FORMAT = Format(KIND, "K and C over speed and frequency as columns, with errors, for other rotor programs", "", _text)
TARGET = target(FORMAT)

"""Tip relief of a pair of gears: lines of contact with relieved ends under a load, as a varying stiffness and an error.

Each place of a line of contact is a spring of equal stiffness c, and is in contact where the approach x of the flanks
exceeds the relief e there. Under the force F

    sum of c (x - e) over all places with x > e = F,

so that near it the mesh has the stiffness k = sum of c, and the transmission error sum of c e / k, over the places in
contact. Both vary with the phase of the mesh. Where the relief begins at the end of the double contact and is as large
as one pair yields under F, a spur pair turns evenly under that load (S. L. Harris, Dynamic loads on the teeth of spur
gears, Proc. Instn. Mech. Engrs. 172, 1958, 87-112).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError

_PHASES, _SLICES = 1024, 33
"""Phases of a mesh, and slices of the face of helical gears, at which it is looked at."""

LARGEST = 1e-3
"""Largest relief [m]."""


@dataclass(frozen=True)
class Relief:
    """Linear relief of the tips.

    Attributes
    ----------
    amounts : (float, float)
        What is taken away at the tips of both gears, normal to the flanks in the transverse section [m].
    lengths : tuple of float
        How far it reaches from the tips along the path of contact [m]; none: half of the double contact.

    Raises
    ------
    InputError
        For values that no relief has.
    """

    amounts: tuple[float, ...]
    lengths: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if len(self.amounts) != 2 or not all(0.0 <= value <= LARGEST for value in self.amounts):
            raise InputError(
                f"gear pair, tip_relief: got {self.amounts!r:.60} m; allowed: two, those of both gears, 0 to 1 mm"
            )
        if len(self.lengths) not in (0, 2) or not all(0.0 < value < math.inf for value in self.lengths):
            raise InputError(
                f"gear pair, relief_length: got {self.lengths!r:.60} m; allowed: two above 0, or none, for half of the "
                "double contact"
            )


class Course(NamedTuple):
    """Mesh over a pitch, at evenly spaced phases from the middle of the most lines of contact on.

    Attributes
    ----------
    stiffness : array, shape (phases,)
        Length in contact over the mean length of all lines [1].
    error : array, shape (phases,)
        Transmission error [m].
    """

    stiffness: FloatArray
    error: FloatArray


def course_under_load(
    relief: Relief, ratios: tuple[float, float], base_pitch: float, stiffness: float, force: float
) -> Course:
    """Stiffness and transmission error over a pitch under a load.

    Parameters
    ----------
    relief : Relief
        Relief of the tips; the first gear drives.
    ratios : (float, float)
        Transverse contact ratio and overlap ratio.
    base_pitch : float
        Pitch on the base circle of the transverse section [m].
    stiffness : float
        Mean stiffness of the unrelieved mesh [N/m].
    force : float
        Force along the line of action in the transverse section [N], > 0.
    """
    transverse, overlap = ratios
    part = transverse - math.floor(transverse)
    slices = _SLICES if overlap else 1
    lag = overlap * ((np.arange(slices) + 0.5) / slices - 0.5)
    each = stiffness / transverse / slices
    # of a whole contact ratio, which has no part of a pair more: half a pitch
    lengths = relief.lengths or (0.5 * (part or 1.0) * base_pitch,) * 2
    held, errors = np.zeros(_PHASES), np.zeros(_PHASES)
    for k in range(_PHASES):
        first = np.mod(k / _PHASES + lag + 0.5 * part, 1.0)
        all_pairs = (first[:, None] + np.arange(math.ceil(transverse) + 1)).ravel()
        places = base_pitch * all_pairs[all_pairs < transverse]
        # a pair begins at the tip of the driven gear, and ends at that of the driving one
        end = transverse * base_pitch - places
        relieved = relief.amounts[1] * np.maximum(1.0 - places / lengths[1], 0.0)
        relieved += relief.amounts[0] * np.maximum(1.0 - end / lengths[0], 0.0)
        relieved.sort()
        # the approach if the n least relieved places are in contact; n is right where the next one is not
        count = np.arange(1, relieved.size + 1)
        approach = (force / each + np.cumsum(relieved)) / count
        after = np.append(relieved[1:], np.inf)
        n = int(np.flatnonzero(approach <= after)[0]) + 1
        held[k], errors[k] = n * each / stiffness, float(relieved[:n].mean())
    return Course(held, errors)


def harmonics_of(course: FloatArray, count: int) -> tuple[float, FloatArray, FloatArray]:
    """Mean of a course over a pitch, amplitudes and phases [rad] of its harmonics: mean + sum a cos(j phase + phi).

    Parameters
    ----------
    course : array, shape (phases,)
        Values at evenly spaced phases.
    count : int
        How many harmonics.
    """
    found = np.fft.rfft(course)[1 : count + 1] * 2.0 / course.size
    return float(course.mean()), np.abs(found), np.angle(found)

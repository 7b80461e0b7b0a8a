"""Numbers of bearings of tapered rollers, or of cylindrical ones between ribs: lengths, and laws of contacts."""

from __future__ import annotations

from typing import NamedTuple

from ehdmaps.arrays import BoolArray, FloatArray
from mbs.bearings.locating.normal_law import NormalLaw


class Ribs(NamedTuple):
    """Ribs that the end of a roller may lean on, m of them.

    Attributes
    ----------
    normals : array (m, 2)
        Normals, axial and radial.
    levers, plays : array (m,)
        Levers of the normals about the middle of the roller, and distances from the ends where nothing moved [m].
    laws : array (m,)
        C of each [N/m^1.5].
    outer : array (m,), of bool
        Whether it is a rib of the cup.
    """

    normals: FloatArray
    levers: FloatArray
    plays: FloatArray
    laws: FloatArray
    outer: BoolArray


class TaperedShape(NamedTuple):
    """Numbers of a bearing that do not change.

    Attributes
    ----------
    pitch_radius : float
        Distance of the middles of rollers from the axis [m].
    cup, cone : (float, float)
        Normals of the lines: axial, radial.
    ribs : Ribs
        What holds a roller along its axis.
    levers, profile : array (n,)
        Levers of the slices of both lines, and depths of the profile on one side with the play there [m].
    cos, sin : array (Z,)
        Directions of the rollers in the cage, y and z.
    most_travel, most_tilt : float
        Largest accepted displacement [m] and tilt [rad] of the ring.
    """

    pitch_radius: float
    cup: tuple[float, float]
    cone: tuple[float, float]
    ribs: Ribs
    levers: FloatArray
    profile: FloatArray
    cos: FloatArray
    sin: FloatArray
    most_travel: float
    most_tilt: float


class RollerLaws(NamedTuple):
    """Laws of the contacts of a roller.

    Attributes
    ----------
    cup, cone : float
        C of the whole roller [N/m^(10/9)].
    damping : float
        Constant damping of each contact while it carries load [N s/m]; of lines, for the whole roller.
    damping_time : float
        Damping over stiffness of each contact [s].
    cup_film, cone_film : NormalLaw
        Tables of a whole roller with films; without a table for dry lines.
    relaxes : bool
        Whether films have a memory over a step, see `mbs.bearings.tapered.tapered_memory`.
    """

    cup: float
    cone: float
    damping: float
    damping_time: float
    cup_film: NormalLaw
    cone_film: NormalLaw
    relaxes: bool

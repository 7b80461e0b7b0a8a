"""A ball bearing as the C library has it (`ehdmaps/kernel/c/ball/ball.h`): lengths, speeds, laws, rows of balls."""

from __future__ import annotations

import ctypes
from typing import ClassVar, NamedTuple

from ehdmaps.kernel.record import Record, numbers
from mbs.bearings.balls.ball_speed import Drive
from mbs.bearings.balls.response import SHORTER
from mbs.bearings.locating.film_memory import rows_of
from mbs.bearings.locating.locating_force import BY_RATES
from mbs.bearings.locating.normal_law import LawData

COLUMNS = 28
"""Numbers that are kept of a ball: `ehd_ball_found`. Force on the ball (2), stiffness (4) and damping (4) of the pair,
loads of the inner and the outer contact [N], contact angles, approaches [m], directions e_i (2) and e_o (2), places of
the contacts on their tables; speed around the axis [rad/s], centrifugal load, tractions at the outer and at the inner
raceway [N]; what the memory of films adds to the loads at rest [N]."""

START = 10
"""Numbers by which a ball begins: `ehd_ball_start`, its centre, that of the inner groove there, S (4), and what
deviations added to both contacts (2)."""


class BallShape(NamedTuple):
    """Numbers of a bearing that do not change.

    Attributes
    ----------
    axial, radial : float
        Places of the inner groove's centre against the outer one, of rings in their middle [m].
    arm : float
        Distance of the inner groove's centre from the axis [m].
    inner_arm, outer_arm : float
        Distances of a groove's centre and the centre of a ball that touches it, l_i and l_o [m].
    most_travel, most_tilt : float
        Largest accepted displacement [m] and tilt [rad] of the ring.
    """

    axial: float
    radial: float
    arm: float
    inner_arm: float
    outer_arm: float
    most_travel: float
    most_tilt: float


class ShapeData(Record):
    """Lengths of a bearing: `ehd_ball_shape`, see `BallShape`."""

    _fields_ = tuple((name, ctypes.c_double) for name in BallShape._fields)


class DriveData(Record):
    """Speeds and masses of a bearing: `ehd_ball_drive`, see `Drive`."""

    _fields_ = tuple((name, ctypes.c_double) for name in Drive._fields)


class BallData(Record):
    """A bearing at a time: `ehd_ball_data`."""

    _fields_ = (
        ("shape", ShapeData),
        ("drive", DriveData),
        ("cage_angle", ctypes.c_double),
        ("rest", ctypes.c_double),
        ("balls", ctypes.c_int64),
        ("cosine", numbers),
        ("sine", numbers),
        ("rows", numbers),
        ("held", numbers),
        ("inner", LawData),
        ("outer", LawData),
        ("added", numbers),
        ("by_rates", numbers),
    )
    shapes: ClassVar = {
        "cosine": ("balls",),
        "sine": ("balls",),
        "rows": ("balls", 4),
        "held": ("balls", 2, rows_of(len(SHORTER))),
        "added": ("balls", 2, 2),
        "by_rates": (BY_RATES,),
    }

"""What rolling costs in a bearing: power that the films of all contacts take, and the torque that it needs.

In the frame of the cage every contact stands still, and both of its surfaces run through it at the entrainment speed u.
Each wall feels half of the rolling force F [N/m] against its motion, so that a slice of length l takes the power F u l,
whatever the radii are. The rings drive the rollers, and the rollers drive nothing: what the films take comes in as the
torque M of one ring against the other,

    M |omega_i - omega_o| = sum over rollers, slices and both contacts of F u l.

Rollers are taken to roll without slip. A roller turns against the rolling forces of both its contacts by tractions of
the same size, which need some slip: of a loaded roller a few thousandths of u, whose power is that small a part. An
idle roller in thick films would need a slip as large as u. Held by its cage, and driven by its films alone, it turns
at 0.11 of the speed of rolling and takes 0.55 of the power (rigid surfaces): what is found for idle rollers is about
twice too much.

Left out: sliding at flanges and in the cage, seals, churning of the oil, tractions by skew and by larger slip, elastic
hysteresis. The films are those of the map: isothermal and fully flooded.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.contact_report import BearingContacts

IDLE = 0.05
"""A roller counts as idle if it carries less than this part of the highest roller load: films load all a little."""


@dataclass(frozen=True, eq=False)
class RollingLoss:
    """What rolling costs in a bearing; NaN where no rolling force is known.

    Attributes
    ----------
    power : array (2, Z)
        Power that the films of each roller take at the inner and at the outer raceway [W].
    ring_speed : float
        Speed of one ring against the other, without sign [rad/s].
    idle : float
        Part of the power of rollers that carry less than `IDLE` of the highest roller load; NaN without power.
    """

    power: FloatArray
    ring_speed: float
    idle: float

    @property
    def total(self) -> float:
        """Power of all films [W]."""
        return float(self.power.sum())

    @property
    def torque(self) -> float:
        """Rolling torque between the rings [N m]; zero at standstill."""
        return self.total / self.ring_speed if self.ring_speed > 0.0 else 0.0 * self.total


def rolling_loss(
    contacts: BearingContacts, roller_load: FloatArray, slice_length: float, entrainment_speed: float, ring_speed: float
) -> RollingLoss:
    """What rolling costs at given contacts.

    Parameters
    ----------
    contacts : BearingContacts
        Contacts with their rolling forces.
    roller_load : array (Z,)
        Load of each roller [N].
    slice_length : float
        Length of a slice [m].
    entrainment_speed, ring_speed : float
        u [m/s], and speed of one ring against the other [rad/s], of either sign.
    """
    force = np.stack([side.rolling_force.sum(axis=1) for side in contacts.sides])
    power = force * slice_length * abs(entrainment_speed)
    total = float(power.sum())
    idle = float(power[:, roller_load < IDLE * np.max(roller_load)].sum()) / total if total > 0.0 else math.nan
    return RollingLoss(power, abs(ring_speed), idle)

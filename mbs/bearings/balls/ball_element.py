"""A ball bearing in a machine, with the speeds that its balls ask for: what differs from `LocatingElement`.

The speeds by which balls have their centrifugal load and gyroscopic moment are those of their own contact angles. Small
oscillations about rest: `mbs.bearings.balls.balls_in_balance`; films with memory in time:
`mbs.bearings.balls.ball_memory`.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ehdmaps.arrays import FloatArray
from mbs.bearings.balls.ball_findings import ball_gauge
from mbs.bearings.balls.ball_memory import FilmsOfBalls
from mbs.bearings.balls.laws import BallLaw
from mbs.bearings.locating.locating_element import LocatingElement, Settled
from mbs.model.findings import Gauge
from mbs.model.relaxation import Relaxation

if TYPE_CHECKING:
    from mbs.bearings.contact_report import BearingContacts, RollingLoss
    from mbs.model.condensed import Condensed


@dataclass(frozen=True, eq=False)
class MachineBalls(LocatingElement):
    """A ball bearing, see `LocatingElement`; its law is a `BallLaw`."""

    rolling_element = "ball"
    of_points = True
    in_time = FilmsOfBalls

    @property
    def dry_law(self) -> BallLaw:
        """The law of the force."""
        law: BallLaw = self.force.law
        return law

    @property
    def same_films(self) -> object:
        """See `LocatingElement.same_films`."""
        geometry = self.force.geometry
        return dataclasses.replace(geometry, clearance=0.0, contact_angle=abs(geometry.contact_angle))

    def beyond(self, pose: FloatArray) -> bool:
        """Tell whether an angular contact bearing is beyond its middle, where it has no raceway."""
        axial = self.force.shape.axial
        return bool(axial * (axial + pose[0]) < 0.0)

    def relaxation_at(self, at: Settled) -> Relaxation:
        """See `LocatingElement.relaxation_at`."""
        from mbs.bearings.balls.balls_in_balance import ball_relaxation

        return ball_relaxation(at.force, at.loads, at.conditions)

    def condensed_at(self, at: Settled) -> Condensed | None:
        """See `LocatingElement.condensed_at`."""
        from mbs.bearings.balls.balls_in_balance import balls_in_balance

        return balls_in_balance(at.force, at.loads, at.conditions, relaxes=self.relaxes)

    def gauge_at(self, at: Settled) -> Gauge:
        """See `LocatingElement.gauge_at`."""
        return ball_gauge(at.force, at.loads)

    def felt_at(self, at: Settled) -> tuple[BearingContacts, RollingLoss]:
        """See `LocatingElement.felt_at`."""
        from mbs.bearings.balls.ball_report import ball_contacts

        return ball_contacts(at.force, at.loads, getattr(self.films, "points", None), at.speeds)

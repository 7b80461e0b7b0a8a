"""A bearing of tapered rollers, or of rollers between ribs, in a machine: what differs from `LocatingElement`.

Small oscillations about rest: `mbs.bearings.tapered.rollers_in_balance`; films with memory in time:
`mbs.bearings.tapered.tapered_memory`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from mbs.bearings.locating.locating_element import LocatingElement, Settled
from mbs.bearings.tapered.line_film import DRY_LINES, LineFilms, cylinder_of
from mbs.bearings.tapered.roller_findings import roller_gauge
from mbs.bearings.tapered.tapered_memory import FilmsOfRollers
from mbs.model.findings import Gauge
from mbs.model.relaxation import Relaxation

if TYPE_CHECKING:
    from mbs.bearings.contact_report import BearingContacts, RollingLoss
    from mbs.model.condensed import Condensed


@dataclass(frozen=True, eq=False)
class TaperedElement(LocatingElement):
    """A bearing of tapered rollers, or of rollers between ribs, see `LocatingElement`; its law is a `LineFilms`."""

    in_time = FilmsOfRollers

    @property
    def dry_law(self) -> LineFilms:
        """Lines without films."""
        return DRY_LINES

    @property
    def same_films(self) -> object:
        """See `LocatingElement.same_films`."""
        return cylinder_of(self.force.geometry)

    def relaxation_at(self, at: Settled) -> Relaxation:
        """See `LocatingElement.relaxation_at`."""
        from mbs.bearings.tapered.rollers_in_balance import line_relaxation  # with kernels that runs do not need

        return line_relaxation(at.force, at.conditions["cage_angle"])

    def condensed_at(self, at: Settled) -> Condensed | None:
        """See `LocatingElement.condensed_at`."""
        from mbs.bearings.tapered.rollers_in_balance import rollers_in_balance

        return rollers_in_balance(at.force, at.conditions["cage_angle"], relaxes=self.relaxes)

    def gauge_at(self, at: Settled) -> Gauge:
        """See `LocatingElement.gauge_at`."""
        return roller_gauge(at.force, at.loads)

    def felt_at(self, at: Settled) -> tuple[BearingContacts, RollingLoss]:
        """See `LocatingElement.felt_at`."""
        from mbs.bearings.films import DryContacts
        from mbs.bearings.tapered.roller_report import roller_contacts

        source = getattr(self.films, "lines", None)
        films = source or DryContacts(cylinder_of(self.force.geometry).contacts(self.force.material, "iso16281"))
        temperature = float(getattr(self.films, "temperature", 0.0))  # of dry lines nothing depends on it
        return roller_contacts(at.force, at.loads, films, at.speeds, temperature)

"""The contacts of a bearing at rest, for analyses that go through them one by one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.bearings.film_relaxation import relaxation_times

if TYPE_CHECKING:
    from ehdmaps.maps.film_response import FilmResponse
    from ehdmaps.maps.law import LawAtPoint


@dataclass(frozen=True, eq=False)
class ContactGroup:
    """Slices of a bearing that have the same law, all rollers after each other.

    Attributes
    ----------
    law : LawAtPoint
        The law at the speed and temperature of the bearing.
    rows : array, shape (r, m)
        Approach of each slice by the displacements of the ports of the bearing.
    approach : array, shape (r,)
        Approaches at rest [m].
    length : float
        Length of a slice [m].
    relaxes : bool
        Whether the films relax in linear analyses.
    """

    law: LawAtPoint
    rows: FloatArray
    approach: FloatArray
    length: float
    relaxes: bool

    def state(self, shift: FloatArray | float = 0.0) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Load [N/m], stiffness [N/m], damping [N s/m] and relaxation time [s] of each slice, shape (r,) each.

        Parameters
        ----------
        shift : float or array, shape (r,)
            Added to the approaches [m]. Times are 0 for films that do not relax.
        """
        approach = self.approach + shift
        load, stiffness, damping = self.law(approach, np.zeros_like(approach))
        times = relaxation_times(self.law, approach) if self.relaxes else np.zeros_like(approach)
        return load, stiffness * self.length, damping * self.length, times

    def film_response(self) -> FilmResponse | None:
        """What the law of its slices leaves out with memory; None where nothing is known of films that oscillate."""
        loads = self.state()[0]
        return self.law.law.film_response(loads, self.law.entrainment_speed, self.law.temperature)

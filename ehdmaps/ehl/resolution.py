"""What decides accuracy and cost of a solve: density and reach of its grid, cells at the spike, tolerance."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from ehdmaps.ehl.grid import GridShape

SEARCH_DENSITY = 6.5
"""Density of cells up to which a spike is looked for from afar; finer grids start from the solution there. Newton moves
a front by one cell a step, and a narrower cell lets it move less far."""


@dataclass(frozen=True)
class Resolution:
    """What decides accuracy and cost of a solve.

    Attributes
    ----------
    density : float
        Cells of the fine grid per e-fold of distance from inlet, exit and spike (about 100 cells a contact at 7);
        the error is estimated against the grid with half as many.
    inlet_length : float
        Length of the inlet in units of sqrt(2 h R).
    tolerance : float
        Newton tolerance on the last step; convergence is quadratic, so what remains is about its square.
    spike_width : float
        Width of the finest cells around the pressure spike [b], see `finest_spike`; less where inlet and exit zones are
        narrower.
    spike_steepness : float
        Fall of pressure behind the spike, in p_H per width of the exit zone, above which the spike gets cells of its
        own and the linearised grid follows it; M/100 times as much above M = 100, where the edge of the Hertz
        zone alone is that steep.
    shape : GridShape
        Distribution of the grid's cells.
    """

    density: float = 6.5
    inlet_length: float = 300.0
    tolerance: float = 1e-6
    spike_width: float = 0.1
    spike_steepness: float = 0.6
    shape: GridShape = field(default_factory=GridShape)

    @property
    def finest_spike(self) -> float:
        """Width of the finest cells around the pressure spike [b] for this density.

        Where the spike stands between two nodes is an error of the order of its cell. On finer grids the width falls
        with the square of the density, so that this error falls with the third power.
        """
        return self.spike_width * self._narrowing

    @property
    def _narrowing(self) -> float:
        """How much narrower the finest cells around the spike are than on a coarse grid."""
        return min(1.0, SEARCH_DENSITY / self.density) ** 2

    @property
    def with_wide_spike(self) -> Resolution:
        """The same but for a spike whose finest cells are as wide as on a coarse grid."""
        return replace(self, spike_width=self.spike_width / self._narrowing)

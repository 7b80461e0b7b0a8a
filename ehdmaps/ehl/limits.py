"""Settings of the solver `reynolds`: allowed ones, and those of its grids.

For the solver, the reader of job files and whoever must know a film's settings without solving; imports nothing heavy.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

SETTING_LIMITS: Mapping[str, tuple[float, float]] = {
    "density": (3.0, 60.0),
    "inlet_length": (20.0, 1e5),
    "tolerance": (1e-12, 1e-3),
    "slide_to_roll": (-2.0, 2.0),
}
"""Smallest and largest value of each setting of `ReynoldsSolver`."""

SEARCH_DENSITY = 6.5
"""Density of cells up to which a spike is looked for from afar; finer grids start from the solution there. Newton moves
a front by one cell a step, and a narrower cell lets it move less far."""

USUAL_DENSITY, USUAL_INLET = 6.5, 200.0
"""Default density of cells, and the inlet that goes with it: what its end loses of a thick film, 2.4/150^2, is half of
what the cells add. A longer one changes no error for the better, a shorter one loses more than cells add."""


@dataclass(frozen=True)
class GridShape:
    """Distribution of the cells of a grid; dimensionless weights, the same for every operating point.

    Weights and widths, as the lengths above, are a choice: they decide how many cells an error takes. What a grid is
    worth is measured at every point, by the difference to a grid of half as many cells.

    Attributes
    ----------
    inlet, exit, core, spike : float
        Weights of the terms: cells in proportion.
    inlet_width, exit_width : float
        Widths within which cells are finest, in those of the zones.
    """

    inlet: float = 1.0
    exit: float = 0.4
    core: float = 0.25
    spike: float = 0.5
    inlet_width: float = 1.0
    exit_width: float = 0.45


USUAL_SHAPE = GridShape()
"""Default distribution of the cells."""


@dataclass(frozen=True)
class Resolution:
    """Settings that decide accuracy and cost of a solve.

    Attributes
    ----------
    density : float
        Cells of the fine grid per e-fold of distance from inlet, exit and spike (about 100 cells a contact at 7);
        the error is estimated against the grid with half as many.
    inlet_length : float, optional
        Length of the inlet in units of sqrt(2 h R); left out, see `inlet`.
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

    density: float = USUAL_DENSITY
    inlet_length: float | None = None
    tolerance: float = 1e-6
    spike_width: float = 0.1
    spike_steepness: float = 0.6
    shape: GridShape = field(default_factory=GridShape)

    @property
    def inlet(self) -> float:
        """Length of the inlet in units of sqrt(2 h R), where none is given with the square of the density.

        What the end of the inlet loses falls with the square of its length, the error of the cells with the fourth
        power of their density: both fall together.
        """
        if self.inlet_length is not None:
            return self.inlet_length
        return USUAL_INLET * (self.density / USUAL_DENSITY) ** 2

    @property
    def finest_spike(self) -> float:
        """Width of the finest cells around the pressure spike [b] for this density.

        Where the spike stands between two nodes is an error of the order of its cell. On finer grids the width falls
        with the square of the density, so that this error falls with the third power.
        """
        return self.spike_width * self._narrowing

    @property
    def _narrowing(self) -> float:
        """Width of the finest cells around the spike relative to that on a coarse grid."""
        return min(1.0, SEARCH_DENSITY / self.density) ** 2

    @property
    def with_wide_spike(self) -> Resolution:
        """The same but for a spike whose finest cells are as wide as on a coarse grid."""
        return replace(self, spike_width=self.spike_width / self._narrowing)

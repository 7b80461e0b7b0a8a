"""A point contact to first order about its steady film: stiffness and damping, and the response over frequency.

With J the derivatives of the equations and S the oil that the film stores, a load that oscillates with
Omega = omega a/u moves pressures and H0 by (J + i Omega S) z = e. The factors of J are those of the last Newton step;
nodes that cavitate stay as they are, which to first order they do. For slow motion H0 answers with -A + i Omega B, so
that k = 1/A and c = B/A^2 in units of p_H Rx and p_H Rx a/u; over frequency the Krylov space of J^-1 S serves all.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.ehl.spectrum import FilmSpace, arnoldi
from ehdmaps.point.equations import Equations, Factors
from ehdmaps.point.newton import PointState

LEFT = 1e-10
"""What solves with factors of another step leave of a response."""


class SlowResponse(NamedTuple):
    """Response of the approach to slow motion of the load.

    Attributes
    ----------
    compliance : float
        A, film and solids [1/(p_H Rx)].
    loss : float
        B = c A^2 [a/(u p_H Rx)].
    """

    compliance: float
    loss: float


@dataclass(frozen=True, eq=False)
class Tangent:
    """The linearised equations of a converged state.

    Attributes
    ----------
    state : PointState
        The state.
    equations : Equations
        Equations of the solution.
    factors : Factors
        Factors of them, or of a step nearby.
    """

    state: PointState
    equations: Equations
    factors: Factors

    @classmethod
    def of(cls, state: PointState) -> Tangent:
        """The tangent of a state that is solved.

        Parameters
        ----------
        state : PointState
            A state with status CONVERGED.
        """
        assert state.equations is not None and state.factors is not None
        return cls(state, state.equations, state.factors)

    def exact(self) -> Tangent:
        """The same with factors of its own equations, in double precision: for many solves."""
        if self.factors.double and self.factors.found is self.equations.found:
            return self
        factors = self.equations.factorised(double=True)
        assert factors is not None  # they were solved in the last step
        return replace(self, factors=factors)

    def solved(self, right: FloatArray) -> FloatArray:
        """J^-1 of a right-hand side, shape (k + 1,).

        Parameters
        ----------
        right : ndarray, shape (k + 1,)
            Right-hand side: free nodes, then the load.
        """
        found = self.equations.solved(right, self.factors, LEFT)
        return self.exact().solved(right) if found is None else found

    def static(self) -> FloatArray:
        """Change of free pressures and H0 by the load, shape (k + 1,)."""
        load = np.zeros(np.count_nonzero(self.state.free) + 1)
        load[-1] = 1.0
        return self.solved(load)

    def stored(self, change: FloatArray) -> FloatArray:
        """S z: what each equation asks for where pressures and H0 change at a rate, shape (k + 1,).

        The tail is squeezed too: at the far nodes, and in the load.

        Parameters
        ----------
        change : ndarray, shape (k + 1,)
            Rates of free pressures and H0.
        """
        state, found = self.state, self.equations.found
        grid, wedge = state.grid, state.problem.wedge
        pressure = np.zeros(grid.shape)
        pressure[state.free] = change[:-1]
        film = grid.deflection(pressure) + change[-1]
        rate = grid.areas * (found.density * film + found.density_slope * pressure * state.film)
        rate = np.where(grid.tail.far, grid.tail.squeezing * wedge * film / state.film**2, rate)
        return np.asarray(np.r_[rate[state.free], wedge * grid.tail.squeeze * change[-1]])

    def moved(self, change: FloatArray) -> FloatArray:
        """J^-1 S z, shape (k + 1,).

        Parameters
        ----------
        change : ndarray, shape (k + 1,)
            Rates of free pressures and H0.
        """
        return self.solved(self.stored(change))

    def slow(self) -> SlowResponse:
        """Response to slow motion."""
        static = self.static()
        compliance = -float(static[-1])
        return SlowResponse(compliance, -float(self.moved(static)[-1]) + self.squeezed * compliance)

    def _space(self, fastest: float) -> FilmSpace:
        """Krylov space that serves all frequencies up to a highest one."""
        static = self.static()
        return arnoldi(self.moved, static, static.size - 1, fastest)

    def motions(self, frequencies: FloatArray) -> ComplexArray:
        """H0 by a load of one, over frequency, shape (k,).

        Parameters
        ----------
        frequencies : ndarray, shape (k,)
            Omega = omega a/u, > 0.
        """
        wanted = np.ascontiguousarray(frequencies, dtype=float)
        found = self.exact()._space(float(np.max(wanted))).motions(wanted)
        return np.asarray(found * (1.0 - 1j * wanted * self.squeezed))

    @property
    def squeezed(self) -> float:
        """Deflection of the contact by the squeezed tail outside of the grid, by dH/dT of one."""
        state = self.state
        return state.problem.wedge * state.grid.elasticity * state.grid.tail.squeeze_deflection

"""Factors of a symmetric matrix, in an order of elimination: by SuperLU, of large bodies by PARDISO.

SuperLU keeps both triangles and fills some 40 GB for a million degrees of freedom; PARDISO keeps one, in 7 GB.
"""

from __future__ import annotations

import importlib.util
from typing import Any, Protocol

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import AnalysisError
from ehdmaps.extras import needs

SMALL, LARGE = 300_000, 1_200_000
"""Degrees of freedom that SuperLU factorises, and PARDISO."""

COARSER = "take a coarser mesh"


def most_freedoms() -> int:
    """Degrees of freedom that are taken: more where PARDISO is installed."""
    return LARGE if importlib.util.find_spec("pypardiso") else SMALL


def too_many() -> str:
    """Words on what is allowed, and what to do."""
    beyond = "" if most_freedoms() > SMALL else f'; or pip install "ehdmaps[large]", for {LARGE}'
    return f"allowed: at most {most_freedoms()}; {COARSER}{beyond}"


class Factor(Protocol):
    """Factors of a matrix."""

    @property
    def not_positive(self) -> int | None:
        """Number of eigenvalues that are not above 0 (Sylvester); None if that is not known."""
        ...

    def solve(self, force: FloatArray) -> FloatArray:
        """Solution for forces in columns, (N, c)."""
        ...

    def free(self) -> None:
        """Give the memory back; nothing can be solved any more."""
        ...


def factors(matrix: sparse.csc_array, order: IntArray, *, positive: bool) -> Factor:
    """Factorise a symmetric matrix, with pivots on the diagonal.

    Parameters
    ----------
    matrix : sparse array, shape (N, N)
        The matrix.
    order : array of int, shape (N,)
        Order of elimination.
    positive : bool
        Whether it is to be positive definite.

    Raises
    ------
    AnalysisError
        If it cannot be factorised.
    """
    try:
        return _Pardiso(matrix, positive) if matrix.shape[0] > SMALL else _SuperLU(matrix, order)
    except (RuntimeError, MemoryError) as error:
        raise AnalysisError(
            f"reduction: the matrices cannot be factorised ({error}); check them, or {COARSER}"
        ) from error


class _SuperLU:
    """Factors L and U."""

    def __init__(self, matrix: sparse.csc_array, order: IntArray) -> None:
        self._order = order
        ordered = sparse.csc_matrix(sparse.csc_array(matrix)[order][:, order])
        self._factor = splu(ordered, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})

    @property
    def not_positive(self) -> int | None:
        """See `Factor.not_positive`: None where rows were exchanged."""
        kept = np.array_equal(self._factor.perm_r, self._factor.perm_c)
        return int(np.sum(self._factor.U.diagonal() <= 0.0)) if kept else None

    def solve(self, force: FloatArray) -> FloatArray:
        """See `Factor.solve`."""
        result = np.empty_like(force)
        if force.size:
            result[self._order] = self._factor.solve(np.ascontiguousarray(force[self._order]))
        return result

    def free(self) -> None:
        """See `Factor.free`."""
        self._factor = None


class _Pardiso:
    """Factors of one triangle, in an order of PARDISO's own."""

    def __init__(self, matrix: sparse.csc_array, positive: bool) -> None:
        with needs("large", "pypardiso", "reduction of a large finite-element body"):
            from pypardiso import PyPardisoSolver
            from pypardiso.pardiso_wrapper import PyPardisoError
        self._upper = sparse.csr_matrix(sparse.triu(matrix, format="csr"))
        self._upper.sort_indices()
        self._solver: Any = PyPardisoSolver(mtype=2 if positive else -2)
        self._error, self._positive = PyPardisoError, positive
        self._solver.set_iparm(1, 1)
        self._solver.set_iparm(2, 2)  # nested dissection
        self._run(12, np.zeros((matrix.shape[0], 1)))

    def _run(self, phase: int, force: FloatArray) -> FloatArray:
        """Carry out a phase."""
        self._solver.set_phase(phase)
        try:
            return np.asarray(self._solver._call_pardiso(self._upper, np.asfortranarray(force)))
        except self._error as error:
            raise RuntimeError(str(error)) from error

    @property
    def not_positive(self) -> int | None:
        """See `Factor.not_positive`."""
        return 0 if self._positive else int(self._solver.get_iparm(23))

    def solve(self, force: FloatArray) -> FloatArray:
        """See `Factor.solve`."""
        return self._run(33, force) if force.size else force

    def free(self) -> None:
        """See `Factor.free`."""
        self._solver.free_memory(everything=True)

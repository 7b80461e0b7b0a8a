"""A finite-element body whose interfaces are held: its modes, and its shape when they are moved a little.

Averages of an interface are held by B x = p with a few rows B, which touch many nodes. In place of the indefinite
matrix [[K, B'], [B, 0]] we factorise K + a M alone, which is positive definite for any body, even a free one, and as
sparse as the mesh; the few multipliers follow from the small dense matrix B (K + a M)^-1 B'. What the shift a takes
away is given back in two steps: exactly in the span of the computed modes, by iteration in the rest, where it shrinks
by a/(a + omega^2) with omega above the cut-off.

Matrices are factorised by SuperLU, which keeps both triangles; large ones by CHOLMOD, which keeps one.
Lanczos' method may pass over one of two modes at the same frequency: it is asked again, from another start, for a mode
apart from those that it found.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy import linalg, sparse
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh, splu

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.extras import needs
from mbs.flexible.finite_elements import COARSER, MOST_BY_LU

MOST_MODES = 300

_DENSE = 600
"""Up to this size all modes are computed at once."""

_FREE = 1e-12
"""A mode with omega^2 below this fraction of the typical K/M of a degree of freedom is taken as a rigid-body mode."""

_DEPENDENT = 1e-11
"""Eigenvalue of the scaled multiplier matrix below which averages depend on each other."""

_NO_BODY = (
    "finite-element body: stiffness and mass are not those of a body: the one has to be positive semi-definite, the "
    "other positive definite; check units, signs, and that the files belong together"
)

_AGAIN = 1e-8
"""Residual of a mode that is looked for again, as a part of its 1/(omega^2 + a)."""

_MISSES = 2
"""Searches with modes passed over before it is given up."""

_ITERATIONS = 40
_ENOUGH, _GOOD = 1e-13, 1e-8
"""Change of the static shapes, as a part of them, at which iteration may stop, and must have arrived."""


class Factor(Protocol):
    """Factors of a positive definite matrix."""

    def solve(self, force: FloatArray) -> FloatArray:
        """Solution for forces in columns, (N, c)."""
        ...


def factors(matrix: sparse.csc_array, order: IntArray) -> Factor:
    """Factorise a symmetric, positive definite matrix.

    Parameters
    ----------
    matrix : sparse array, shape (N, N)
        The matrix.
    order : array of int, shape (N,)
        Order of elimination.

    Raises
    ------
    InputError
        If it is not positive definite.
    AnalysisError
        If it cannot be factorised.
    DependencyError
        If it has more than `MOST_BY_LU` rows, and cvxopt is not installed.
    """
    try:
        return (_Cholmod if matrix.shape[0] > MOST_BY_LU else _SuperLU)(matrix, order)
    except (RuntimeError, MemoryError) as error:
        raise AnalysisError(
            f"reduction: the matrices cannot be factorised ({error}); check them, or {COARSER}"
        ) from error


class _SuperLU:
    """Factors L and U, with pivots on the diagonal."""

    def __init__(self, matrix: sparse.csc_array, order: IntArray) -> None:
        self._order = order
        ordered = sparse.csc_matrix(sparse.csc_array(matrix)[order][:, order])
        self._factor = splu(ordered, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        exchanged = not np.array_equal(self._factor.perm_r, self._factor.perm_c)
        if exchanged or np.any(self._factor.U.diagonal() <= 0.0):
            raise InputError(_NO_BODY)

    def solve(self, force: FloatArray) -> FloatArray:
        """See `Factor.solve`."""
        result = np.empty_like(force)
        if force.size:
            result[self._order] = self._factor.solve(np.ascontiguousarray(force[self._order]))
        return result


class _Cholmod:
    """Cholesky's factor by dense blocks: half the memory of L and U, and a fraction of their time."""

    def __init__(self, matrix: sparse.csc_array, order: IntArray) -> None:
        with needs("large", "cvxopt", f"reduction of more than {MOST_BY_LU} degrees of freedom"):
            from cvxopt import cholmod, spmatrix
            from cvxopt import matrix as dense

        self._dense, self._solve = dense, cholmod.solve
        lower = sparse.coo_array(sparse.tril(matrix))
        places = (dense(index.astype(np.int64)) for index in (lower.row, lower.col))
        entries = spmatrix(dense(lower.data), *places, lower.shape)
        cholmod.options["supernodal"] = 2  # by blocks; it is one of the module, which others may have set
        self._factor = cholmod.symbolic(entries, p=dense(order.astype(np.int64)), uplo="L")
        try:
            cholmod.numeric(entries, self._factor)
        except ArithmeticError as error:
            raise InputError(_NO_BODY) from error

    def solve(self, force: FloatArray) -> FloatArray:
        """See `Factor.solve`."""
        if not force.size:
            return np.empty_like(force)
        result = self._dense(np.asarray(force, dtype=np.float64))
        self._solve(self._factor, result)
        return np.array(result)


class HeldBody:
    """Stiffness and mass of what moves, held by linear conditions B x = p.

    Parameters
    ----------
    stiffness, mass : sparse array, shape (N, N)
        Matrices without the degrees of freedom that are prescribed one by one.
    averages : array, shape (m, N)
        Matrix B; no rows if there are no averages.
    groups : array of int, shape (N,)
        Degrees of freedom with the same number belong to the same node; for the order of elimination.
    cutoff : float
        [Hz], up to which modes are wanted.

    Attributes
    ----------
    squares : array, shape (modes,)
        omega^2 of the modes up to the cut-off [1/s2], rising.
    shapes : array, shape (N, modes)
        Their shapes with phi' M phi = 1, the largest entry positive.

    Raises
    ------
    InputError
        If the matrices are not those of a body, the averages depend on each other, the held body can still move, or
        there are more modes than MOST_MODES.
    AnalysisError
        If the modes are not found.
    """

    def __init__(
        self,
        stiffness: sparse.csc_array,
        mass: sparse.csc_array,
        averages: FloatArray,
        groups: IntArray,
        cutoff: float,
    ) -> None:
        self.stiffness, self.mass, self.averages = stiffness, mass, averages
        if stiffness.shape[0] == 0:
            # All degrees of freedom are coordinates already.
            self.squares, self.shapes = np.zeros(0), np.zeros((0, 0))
            return
        self._typical = float(np.median(stiffness.diagonal() / mass.diagonal()))
        if not self._typical > 0.0:
            raise InputError(
                "finite-element body, stiffness: most degrees of freedom have none; allowed: the matrix of an elastic "
                "body"
            )
        self._limit = (2.0 * np.pi * cutoff) ** 2
        # Far above rounding, not far above the modes that are wanted.
        self._shift = float(np.clip(self._limit, 1e-8 * self._typical, 1e-4 * self._typical))
        self._order = elimination_order(stiffness, groups)
        self._factor = factors(sparse.csc_array(stiffness + self._shift * mass), self._order)
        self._spread = self._solve_free(averages.T)
        self._multipliers = self._multiplier_factor()
        self.squares, self.shapes = self._modes()

    def static(self, force: FloatArray, prescribed: FloatArray) -> FloatArray:
        """Shapes at rest under forces and prescribed averages.

        Parameters
        ----------
        force : array, shape (N, c)
            Forces, in columns.
        prescribed : array, shape (m, c)
            Prescribed displacements p, in columns.

        Returns
        -------
        array, shape (N, c)
            x with K x + B' multipliers = force, B x = prescribed.

        Raises
        ------
        AnalysisError
            If they are not found to the accuracy of the modes.
        """
        if force.size == 0:
            return force
        shapes = self._solve(force, prescribed)
        before = np.inf
        for _ in range(_ITERATIONS):
            soft = self.shapes @ ((self.shapes.T @ (force - self.stiffness @ shapes)) / self.squares[:, None])
            shapes += soft
            rest = self._solve(force - self.stiffness @ shapes, prescribed - self.averages @ shapes)
            shapes += rest
            # Size of the correction against the whole, in the mass norm, the worst column.
            part, whole = (np.sqrt(np.maximum(np.einsum("ik,ik->k", x, self.mass @ x), 0.0)) for x in (rest, shapes))
            change = float(np.max(part / np.where(whole > 0.0, whole, 1.0), initial=0.0))
            if change <= _ENOUGH or (change <= _GOOD and change > 0.5 * before):
                return shapes
            before = change
        raise AnalysisError(
            f"reduction: the static shapes still change by {change:.2g} after {_ITERATIONS} corrections; the matrices "
            "are too badly conditioned: look for elements that are much smaller or stiffer than the others"
        )

    def _solve_free(self, force: FloatArray) -> FloatArray:
        """(K + a M)^-1 force."""
        return self._factor.solve(force)

    def _multiplier_factor(self) -> tuple[FloatArray, FloatArray] | None:
        """Scale and Cholesky factor of B (K + a M)^-1 B'."""
        if self.averages.shape[0] == 0:
            return None
        flexibility = self.averages @ self._spread
        scale = 1.0 / np.sqrt(np.diag(flexibility))
        scaled = scale[:, None] * (0.5 * (flexibility + flexibility.T)) * scale
        if np.linalg.eigvalsh(scaled)[0] < _DEPENDENT:
            raise InputError(
                "interfaces: the mean displacements of averaging interfaces depend on each other; allowed: interfaces "
                "of nodes apart, no two on the same surface"
            )
        return scale, np.asarray(np.linalg.cholesky(scaled), dtype=np.float64)

    def _solve(self, force: FloatArray, prescribed: FloatArray | None = None) -> FloatArray:
        """x with (K + a M) x + B' multipliers = force, B x = prescribed (zero if left out)."""
        free = self._solve_free(force)
        if self._multipliers is None:
            return free
        scale, factor = self._multipliers
        short = self.averages @ free
        if prescribed is not None:
            short = short - prescribed
        multipliers: FloatArray = scale[:, None] * linalg.cho_solve((factor, True), scale[:, None] * short)
        return free - self._spread @ multipliers

    def _modes(self) -> tuple[FloatArray, FloatArray]:
        """omega^2 and shapes up to the cut-off."""
        free = self.stiffness.shape[0] - self.averages.shape[0]
        if free <= 0:
            return np.zeros(0), np.zeros((self.stiffness.shape[0], 0))
        try:
            squares, shapes = self._all_modes() if free <= _DENSE else self._lowest_modes(free)
        except linalg.LinAlgError as error:
            # A mass that is not positive definite.
            raise InputError(_NO_BODY) from error
        if squares[0] < _FREE * self._typical:
            still = int(np.sum(squares < _FREE * self._typical))
            raise InputError(
                f"interfaces: with all of them held the body can still move in {still} way{'s' if still > 1 else ''}; "
                "allowed: interfaces that hold the body together; add an interface or keep more of its freedoms, and "
                "look for parts of the mesh that are not connected"
            )
        kept = squares <= self._limit
        if kept.sum() > MOST_MODES:
            raise InputError(
                f"cutoff: keeps {int(kept.sum())} modes; allowed: at most {MOST_MODES}; lower it: twice the highest "
                "frequency of interest is enough"
            )
        squares, shapes = squares[kept], shapes[:, kept]
        largest = np.argmax(np.abs(shapes), axis=0) if shapes.size else np.zeros(0, dtype=np.int64)
        return squares, shapes * np.sign(shapes[largest, np.arange(largest.size)])

    def _all_modes(self) -> tuple[FloatArray, FloatArray]:
        """All modes of a small body."""
        basis = linalg.null_space(self.averages) if self.averages.shape[0] else np.eye(self.stiffness.shape[0])
        squares, inner = linalg.eigh(basis.T @ (self.stiffness @ basis), basis.T @ (self.mass @ basis))
        return squares, basis @ inner

    def _lowest_modes(self, free: int) -> tuple[FloatArray, FloatArray]:
        """Modes up to the first one above the cut-off, by Lanczos' method about the shift."""
        wanted, missed = 20, 0
        while True:
            squares, shapes = self._lanczos(wanted, np.zeros((self.stiffness.shape[0], 0)))
            # A rotation within the span: clean shapes also where frequencies lie close together.
            squares, inner = linalg.eigh(shapes.T @ (self.stiffness @ shapes), shapes.T @ (self.mass @ shapes))
            shapes = shapes @ inner
            if squares[-1] > self._limit:
                if not self._passed_over(shapes):
                    return squares, shapes
                missed += 1
            elif wanted > MOST_MODES:
                return squares, shapes
            if missed == _MISSES:
                raise AnalysisError(
                    "reduction: modes of the held body were passed over, and more searching did not find them; choose "
                    "another cut-off, or a slightly coarser mesh"
                )
            wanted = min(2 * wanted, MOST_MODES + 1, free - 1)

    def _lanczos(self, wanted: int, known: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The lowest modes apart from some that are known, by Lanczos' method about the shift."""
        size = self.stiffness.shape[0]
        weighed = self.mass @ known

        def inverse(force: FloatArray) -> FloatArray:
            moved = self._solve(force.reshape(size, -1))
            return np.asarray((moved - known @ (weighed.T @ moved)).reshape(force.shape))

        start = inverse(self.mass @ np.random.default_rng(known.shape[1]).standard_normal(size))
        try:
            found: tuple[FloatArray, FloatArray] = eigsh(
                self.stiffness,
                wanted,
                M=self.mass,
                sigma=-self._shift,
                OPinv=LinearOperator((size, size), matvec=inverse),
                which="LM",
                v0=start,
                tol=_AGAIN if known.size else 0.0,
            )
        except ArpackError as error:
            raise AnalysisError(f"reduction: the modes of the held body were not found ({error})") from error
        return found

    def _passed_over(self, shapes: FloatArray) -> bool:
        """Tell whether there is a mode up to the cut-off beside those that were found."""
        return bool(self._lanczos(1, shapes)[0][0] <= self._limit)


def elimination_order(matrix: sparse.csc_array, groups: IntArray) -> IntArray:
    """Order of elimination that fills little: nested dissection of the graph of the nodes.

    Parameters
    ----------
    matrix : sparse array, shape (N, N)
        Symmetric matrix.
    groups : array of int, shape (N,)
        Degrees of freedom with the same number stay together.

    Returns
    -------
    array of int, shape (N,)
        Degrees of freedom, first to last.

    Raises
    ------
    DependencyError
        If pymetis is not installed.
    """
    # Only here: reduced files are read without it.
    with needs("flexible", "pymetis", "reduction of a finite-element body"):
        import pymetis

    _, group = np.unique(groups, return_inverse=True)
    size = matrix.shape[0]
    gather = sparse.csr_array((np.ones(size), (group, np.arange(size))))
    graph = sparse.csr_array(gather @ abs(matrix) @ gather.T)
    graph.setdiag(0.0)
    graph.eliminate_zeros()
    if graph.nnz == 0:
        return np.arange(size)
    _, place = pymetis.nested_dissection(pymetis.CSRAdjacency(graph.indptr, graph.indices))
    return np.argsort(np.asarray(place)[group], kind="stable")

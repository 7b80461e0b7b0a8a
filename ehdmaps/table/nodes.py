"""One part of a table: what is known at its nodes, how it is read between them, and how wrong that is.

The errors are measured ones, a number for each cell between the nodes, see `examples.tables.lines.measured`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import ByteArray, FloatArray
from ehdmaps.table.fields import FIELDS, FILMS, LAW, RESPONSES, Field
from ehdmaps.table.interpolation import Axes, Place, coefficients
from ehdmaps.table.interpolation import read as read_fields

BEYOND_HEAVY, BEYOND_FLAT, BEYOND_LIGHT = 0.1, 0.05, 5e-3
"""What smooth forms are wrong by, a unit of zeta above solved films; at size 0 below them; far below the lowest zeta.

Measured there, down to M = 1e-8: largest pressures 4e-3, as nodes of a grid sample them; films and compliances 2e-4."""

FARTHEST = 3.0
"""Units of zeta above solved films up to which their ends are taken."""

CODES = 255
LEAST_ERROR, LARGEST_ERROR = 1e-7, 1e2
"""Errors are held in a byte each, as logarithms between these."""

OTHER_FILMS = FILMS[len(LAW) :]


@dataclass(frozen=True, eq=False)
class Nodes:
    """Films at the nodes of one part of a table.

    Attributes
    ----------
    axes : Axes
        The nodes.
    values : ndarray of float32, shape (n_zeta, n_size, n_alpha, n_bend, fields)
        Smooth forms of `FIELDS` there.
    codes : ndarray of uint8, shape (n_zeta - 1, n_size - 1, n_alpha - 1, n_bend - 1, fields)
        Their errors in each cell, see `decoded`.
    """

    axes: Axes
    values: npt.NDArray[np.float32]
    codes: ByteArray

    @cached_property
    def _law(self) -> FloatArray:
        return self._coefficients(LAW)

    @cached_property
    def _others(self) -> FloatArray:
        return self._coefficients(OTHER_FILMS)

    @cached_property
    def _responses(self) -> FloatArray:
        return self._coefficients(RESPONSES)

    def _coefficients(self, fields: tuple[Field, ...]) -> FloatArray:
        """Coefficients of neighbouring fields."""
        first = FIELDS.index(fields[0])
        return coefficients(self.axes, self.values[..., first : first + len(fields)].astype(float))

    def read(self, place: Place, fields: tuple[Field, ...]) -> FloatArray:
        """Smooth forms at points, shape (n, fields).

        Parameters
        ----------
        place : Place
            The points.
        fields : tuple of Field
            `LAW`, `OTHER_FILMS` or `RESPONSES`.
        """
        name = {LAW: "_law", OTHER_FILMS: "_others", RESPONSES: "_responses"}[fields]
        return read_fields(place, getattr(self, name), fields)

    def errors(self, place: Place, fields: tuple[Field, ...]) -> FloatArray:
        """Errors of these, shape (n, fields)."""
        first = FIELDS.index(fields[0])
        codes = self.codes.reshape(-1, len(FIELDS))[place.cell, first : first + len(fields)]
        beyond = BEYOND_HEAVY * place.above - BEYOND_FLAT * place.flatter - BEYOND_LIGHT * np.expm1(place.below)
        return np.asarray(decoded(codes) + beyond[:, None])


def nodes_problem(
    axes: Sequence[FloatArray], values: npt.NDArray[np.float32], fields: int, codes: ByteArray, errors: int
) -> str:
    """Say why numbers of a file make no table; empty where they do.

    Parameters
    ----------
    axes : sequence of ndarray
        Nodes along each coordinate.
    values : ndarray
        Should be finite numbers at all nodes, the fields along the last axis.
    fields : int
        How many numbers a node has.
    codes : ndarray
        Should be bytes in all cells, the errors along the last axis.
    errors : int
        How many errors a cell has.
    """
    for nodes in axes:
        if nodes.ndim != 1 or nodes.size < 2 or not (np.all(np.isfinite(nodes)) and np.all(np.diff(nodes) > 0.0)):
            return "an axis that does not rise from number to number"
    sizes = [nodes.size for nodes in axes]
    for array, shape in ((values, (*sizes, fields)), (codes, (*(size - 1 for size in sizes), errors))):
        if array.shape != shape:
            return f"{' x '.join(map(str, array.shape))} numbers where its axes have {' x '.join(map(str, shape))}"
    if codes.dtype != np.uint8 or values.dtype.kind != "f":
        return "numbers of another type"
    return "" if np.all(np.isfinite(values)) else "values that are no finite numbers"


def decoded(codes: ByteArray) -> FloatArray:
    """Errors of their bytes.

    Parameters
    ----------
    codes : ndarray of uint8
        Bytes that stand for errors from `LEAST_ERROR` to `LARGEST_ERROR`, evenly in their logarithms.
    """
    return np.asarray(_DECODED[codes])


_DECODED = LEAST_ERROR * (LARGEST_ERROR / LEAST_ERROR) ** (np.arange(CODES + 1) / CODES)

"""The solution over the length beside the finite elements: on the same nodes, and how far apart they are."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.hertz import LINE_LIMIT
from ehdmaps.solids.finite_line import FiniteLine
from ehdmaps.solids.slices import slice_coupling
from tests.finite_length.reference import LengthCase, LengthReference, profile_depths
from tests.finite_length.slice_loads import balanced_loads, plane_law
from tests.finite_length.solution import LengthSolution, solve_length

CELLS = (12, 80)
"""Cells of the solution over half the width and along the roller."""

SLICES = 41

_POINTS = 20001


class SliceLoads(NamedTuple):
    """Slices of a roller under a load.

    Attributes
    ----------
    places, load_per_length : array (slices,)
        Middles of the slices [m], loads [N/m].
    approach, tilt : float
        Approach in the middle [m], tilt.
    """

    places: FloatArray
    load_per_length: FloatArray
    approach: float
    tilt: float


@dataclass(frozen=True, eq=False)
class LengthComparison:
    """A case by finite elements, and the solution under the same load.

    Attributes
    ----------
    case : LengthCase
        The case by finite elements.
    solution : LengthSolution
        The solution by the elasticity of half spaces.
    load_per_length, peak_pressure : array (n,)
        The solution at the nodes of the case, averaged as nodes average [N/m], [Pa].
    inside : array of bool (n,)
        Places at least a half-width of the contact away from the end faces.
    coupled, alone : SliceLoads
        Solution by `SLICES` slices that know of their neighbours, and by as many that do not, with the same plane law.
    """

    case: LengthCase
    solution: LengthSolution
    load_per_length: FloatArray
    peak_pressure: FloatArray
    inside: BoolArray
    coupled: SliceLoads
    alone: SliceLoads

    @property
    def load_error(self) -> float:
        """Largest difference of loads per length away from the end faces, over them or the mean if that is more."""
        difference = np.abs(self.load_per_length - self.case.load_per_length)
        return float((difference / np.maximum(self.case.load_per_length, _mean(self.case)))[self.inside].max())

    @property
    def edge_error(self) -> float:
        """The same within a half-width of the end faces, over the load there."""
        there = ~self.inside & (self.case.load_per_length > 0.2 * _mean(self.case))
        if not np.any(there):
            return 0.0
        errors = np.abs(self.load_per_length / np.where(there, self.case.load_per_length, 1.0) - 1.0)
        return float(errors[there].max())

    @property
    def pressure_error(self) -> float:
        """Relative difference of the largest pressure away from the end faces."""
        return float(self.peak_pressure[self.inside].max() / self.case.peak_pressure[self.inside].max() - 1.0)


def compare_lengths(
    reference: LengthReference, bearing: BearingGeometry, cells: tuple[int, int] = CELLS
) -> list[LengthComparison]:
    """All cases of the finest mesh beside the solution.

    Parameters
    ----------
    reference : LengthReference
        The finite elements.
    bearing : BearingGeometry
        The bearing.
    cells : (int, int)
        Cells of the solution.
    """
    model = reference.model
    line = FiniteLine(model.reduced_radius, model.roller_length, 0.5 * model.roller_diameter, model.race_depth)
    law = plane_law(line)
    coupling = slice_coupling(line, SLICES, line.half_width_of(LINE_LIMIT))
    comparisons = []
    for case in reference.finest:
        profile = partial(profile_depths, case.profile, bearing)
        solution = solve_length(line, profile, case.load, case.moment, cells)
        width = line.half_width(_mean(case))
        inside = np.abs(case.places) <= 0.5 * line.length - width
        comparisons.append(
            LengthComparison(
                case,
                solution,
                at_nodes(solution, solution.load_per_length, case.places),
                at_nodes(solution, solution.peak_pressure, case.places),
                inside,
                SliceLoads(*balanced_loads(line, law, coupling, profile, case.load, case.moment)),
                SliceLoads(*balanced_loads(line, law, np.zeros_like(coupling), profile, case.load, case.moment)),
            )
        )
    return comparisons


def mesh_change(reference: LengthReference) -> float:
    """Largest change of the load per length from the mesh before the finest one to that, over its mean.

    It is taken at the nodes of the coarser one, but for the two at each end.

    Parameters
    ----------
    reference : LengthReference
        The finite elements.
    """
    fine, before = (reference.cases[level] for level in sorted(reference.cases)[:2])
    changes = []
    for new, old in zip(fine, before, strict=True):
        difference = np.abs(np.interp(old.places, new.places, new.load_per_length) - old.load_per_length)
        changes.append(float(difference[2:-2].max()) / _mean(new))
    return max(changes)


def at_nodes(solution: LengthSolution, values: FloatArray, nodes: FloatArray) -> FloatArray:
    """Means of values that are even in cells, weighted as the forces of nodes weight them: by hats.

    Parameters
    ----------
    solution : LengthSolution
        Has the cells.
    values : array
        A value a cell.
    nodes : array (n,)
        Places of the nodes from end to end [m].
    """
    edges = np.concatenate([[nodes[0]], nodes[0] + np.cumsum(solution.widths)])
    fine = np.linspace(nodes[0], nodes[-1], _POINTS)
    fine = 0.5 * (fine[1:] + fine[:-1])
    here = values[np.clip(np.searchsorted(edges, fine) - 1, 0, values.size - 1)]
    cell = np.clip(np.searchsorted(nodes, fine) - 1, 0, nodes.size - 2)
    part = (fine - nodes[cell]) / np.diff(nodes)[cell]
    sums = [
        np.bincount(cell, (1.0 - part) * factor, nodes.size) + np.bincount(cell + 1, part * factor, nodes.size)
        for factor in (here, np.ones_like(here))
    ]
    return np.asarray(sums[0] / sums[1])


def _mean(case: LengthCase) -> float:
    """Mean load per length of a case [N/m]."""
    return case.load / float(np.ptp(case.places))

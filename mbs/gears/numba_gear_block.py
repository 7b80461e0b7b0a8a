"""Gear meshes in compiled runs: each feels the compressions of its two flanks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.compiled import njit
from mbs.gears.gear import GearMesh
from mbs.gears.numba_gear_kernel import BY_RATE, FORCE, SLOPE, mesh_force, mesh_powers
from mbs.model.blocks import FOUND, Answers, Kind, Member, Moment, SteadyBlock


class Meshes(NamedTuple):
    """Gear meshes as arrays.

    Attributes
    ----------
    firsts, places : array (meshes,), of int
        First of what each mesh feels, and its place among all elements.
    constants, series : array (meshes, 5), (meshes, 4, harmonics)
        Arrays for `mesh_force`.
    """

    firsts: IntArray
    places: IntArray
    constants: FloatArray
    series: FloatArray


@njit(error_model="numpy")
def meshes_answer(meshes: Meshes, moment: Moment, motion: FloatArray, answers: Answers) -> int:
    """Forces and slopes of all flanks; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    meshes : Meshes
        The gear meshes.
    moment : Moment
        Angle, speed, weights of the slopes.
    motion : array (2, m)
        Compressions and their rates, among what all elements feel.
    answers : Answers
        Answers of all elements, filled.
    """
    if meshes.firsts.size == 0:
        return FOUND
    x, y = motion[0], motion[1]
    flanks = np.empty((2, 3))
    for g in range(meshes.firsts.size):
        first = meshes.firsts[g]
        constants, series = meshes.constants[g], meshes.series[g]
        compressions, rates = x[first : first + 2], y[first : first + 2]
        mesh_force(constants, series, moment.angle, moment.speed, compressions, rates, flanks)
        for i in range(2):
            answers.force[first + i] = -flanks[i, FORCE]
            slope = moment.by_q * flanks[i, SLOPE] + moment.by_v * flanks[i, BY_RATE]
            answers.slopes[first + i, first + i] = slope
    return FOUND


@njit(error_model="numpy")
def meshes_powers(meshes: Meshes, moment: Moment, motion: FloatArray, answers: Answers, out: FloatArray) -> None:
    """Write what flanks dissipate, and what stiffness and error bring in; see `mbs.model.blocks.Kind`.

    Parameters
    ----------
    meshes, moment, motion, answers
        The same as of `meshes_answer`.
    out : array (elements, 3)
        Powers of all elements; written.
    """
    x, y = motion[0], motion[1]
    for g in range(meshes.firsts.size):
        first, place = meshes.firsts[g], meshes.places[g]
        compressions, rates = x[first : first + 2], y[first : first + 2]
        out[place, 0], out[place, 1] = mesh_powers(
            meshes.constants[g], meshes.series[g], moment.angle, moment.speed, compressions, rates
        )


def _gather(members: Sequence[Member]) -> SteadyBlock:
    """Arrays of some meshes; series as long as the longest."""
    arrays = [member.element.arrays for member in members]
    series = np.zeros((len(arrays), 4, max((part.shape[1] for _, part in arrays), default=0)))
    for row, (_, part) in zip(series, arrays, strict=True):
        row[:, : part.shape[1]] = part
    constants = np.array([part for part, _ in arrays]).reshape(len(arrays), 5)
    firsts, places = (np.array([getattr(m, key) for m in members], dtype=np.int64) for key in ("first", "place"))
    return SteadyBlock(Meshes(firsts, places, constants, series))


def _compressions(mesh: GearMesh) -> FloatArray:
    """Rows of both flanks."""
    return mesh.rows


GEAR_MESHES = Kind(arrays=Meshes, answer=meshes_answer, feels=_compressions, gather=_gather, powers=meshes_powers)
"""For `mbs.transient.kinds`."""

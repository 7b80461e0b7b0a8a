"""Elements as arrays for `mbs.transient.run_kernel`: bearings with their laws over the speed, and gear meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeGuard

import numpy as np
import scipy.linalg

from ehdmaps.arrays import FloatArray
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.force_at_point import Work
from mbs.gears.gear import GearMesh
from mbs.model.elements import Element
from mbs.model.system import Connected
from mbs.transient.run_arrays import Elements
from mbs.transient.run_kernel import PORTS
from mbs.transient.speed_tables import SpeedTables


def is_known(element: Element) -> bool:
    """Whether compiled code has this element."""
    return type(element) is GearMesh or (type(element) is BearingElement and type(element.force) is BearingForce)


@dataclass(frozen=True, eq=False)
class RunElements:
    """All elements of a run.

    Attributes
    ----------
    arrays : Elements
        Arrays for compiled code.
    expand : array, shape (felt, ports)
        What elements feel of their ports: four displacements of a bearing, two compressions of a gear mesh; and, on
        the other side, forces in the ports by those that the elements make.
    films : tuple of SpeedTables
        Laws, shared by bearings that have the same at the same speed.
    forces : tuple of BearingForce
        Forces of the bearings, which count calls outside the map.
    """

    arrays: Elements
    expand: FloatArray
    films: tuple[SpeedTables, ...]
    forces: tuple[BearingForce, ...]

    @classmethod
    def of(cls, connected: Sequence[Connected]) -> RunElements:
        """Elements that `is_known` knows."""
        felt = [_felt(entry.element) for entry in connected]
        expand = scipy.linalg.block_diag(*felt) if felt else np.zeros((0, 0))
        firsts = np.cumsum([0, *(part.shape[0] for part in felt)]).tolist()
        bearings = _Bearings()
        meshes: list[tuple[int, GearMesh]] = []
        for entry, first in zip(connected, firsts[:-1], strict=True):
            if isinstance(entry.element, GearMesh):
                meshes.append((first, entry.element))
            elif _is_bearing(entry.element):
                bearings.add(entry.element, first)
        arrays = bearings.arrays(*_mesh_arrays(meshes))
        return cls(arrays, np.asarray(expand, dtype=np.float64), tuple(bearings.films), tuple(bearings.forces))

    def hand_over_counts(self) -> None:
        """Give the calls outside the map to the bearings, and begin to count anew."""
        for index, force in enumerate(self.forces):
            force.outside_calls += int(self.arrays.counts[index])
        self.arrays.counts[:] = 0


class _Bearings:
    """Bearings put into pools one after the other."""

    def __init__(self) -> None:
        self.films: list[SpeedTables] = []
        self.forces: list[BearingForce] = []
        self._film_of: dict[tuple[object, ...], int] = {}
        self._entries: list[list[int]] = []
        self._numbers: list[FloatArray] = []
        self._slices: list[FloatArray] = []
        self._angles: list[FloatArray] = []
        self._at = np.zeros(4, dtype=np.int64)

    def add(self, element: BearingElement, first: int) -> None:
        """Add a bearing whose ports begin at `first`."""
        force = element.force
        assert isinstance(force, BearingForce)
        cage, by_speed, centrifugal = element.rates
        key = (id(force.law), element.temperature, by_speed, centrifugal)
        if key not in self._film_of:
            self._film_of[key] = len(self.films)
            self.films.append(SpeedTables(force, element.temperature, (by_speed, centrifugal)))
        work = Work(force.bearing)
        rollers, slices = work.angles.shape[1], work.slices.shape[1]
        self.forces.append(force)
        self._entries.append([first, self._film_of[key], rollers, slices, *self._at.tolist()])
        self._numbers.append(np.concatenate(([element.start_angle, cage], work.geometry)))
        self._slices.append(work.slices.reshape(-1))
        self._angles.append(work.angles.reshape(-1))
        self._at += np.array([2 * slices, 2 * rollers, rollers * slices, rollers])

    def arrays(self, mesh_ports: FloatArray, constants: FloatArray, series: FloatArray) -> Elements:
        """All as arrays, with those of the meshes."""
        count = len(self.forces)
        _, _, cells, rollers = self._at.tolist()
        return Elements(
            bearings=np.array(self._entries, dtype=np.int64).reshape(count, 8),
            bearing_numbers=np.array(self._numbers).reshape(count, 8),
            slices=np.concatenate([np.zeros(0), *self._slices]),
            angles=np.concatenate([np.zeros(0), *self._angles]),
            states=np.zeros(4 * cells),
            rows=np.zeros(cells, dtype=np.int64),
            rollers=np.zeros(7 * rollers),
            sums=np.zeros(8 * rollers),
            counts=np.zeros(count, dtype=np.int64),
            mesh_ports=mesh_ports.astype(np.int64),
            mesh_constants=constants,
            mesh_series=series,
        )


def _mesh_arrays(meshes: Sequence[tuple[int, GearMesh]]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """First ports, constants and series of gear meshes, the latter with as many harmonics as the longest has."""
    made = [mesh.arrays for _, mesh in meshes]
    series = np.zeros((len(made), 4, max((part.shape[1] for _, part in made), default=0)))
    for row, (_, part) in zip(series, made, strict=True):
        row[:, : part.shape[1]] = part
    constants = np.array([part for part, _ in made]).reshape(len(made), 5)
    return np.array([first for first, _ in meshes], dtype=np.float64), constants, series


def _is_bearing(element: Element) -> TypeGuard[BearingElement]:
    """Whether an element is a bearing."""
    return isinstance(element, BearingElement)


def _felt(element: Element) -> FloatArray:
    """What an element feels of its ports."""
    return element.rows if isinstance(element, GearMesh) else np.eye(6)[PORTS]

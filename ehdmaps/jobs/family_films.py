"""The points of a map read from the lines of its family: every field of a film, scaled back by its groups.

Film offset, film compliance and loss compliance are read as contact laws read them, see `BackboneField`. The other
fields are functions of M and L too, once divided by what they scale with: films by R sqrt(Us), the largest pressure by
that of Hertz, rolling force and mass flow by their groups; the wall stress is the same as it is. Their logarithms are
read from the same lines.

Each numerical error is that of the nearest solved point, plus what the reading changes by if it is made from four
lines instead of six along speed and temperature: that is more than six lines are wrong by where they converge.

A place whose lines have no solution beside it, or that the solver refuses, is not read; it has to be solved.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.jobs.family import Family
from ehdmaps.jobs.refinement import backbone_group
from ehdmaps.jobs.store import Arrays
from ehdmaps.jobs.tasks import FILM_FIELDS, FOUND_BY_SOME, LineTask, film_arrays, with_later_fields
from ehdmaps.maps.backbone import BackboneField
from ehdmaps.maps.backbone_plan import NEIGHBOURS
from ehdmaps.maps.rolling_film import rolling_units
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.film_limits import THICK_NOTE, THICKEST_FILM, THIN_FILM_LIMIT
from ehdmaps.physics.hertz import max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_speed_number
from ehdmaps.physics.solution import FilmSolution, Status

STEP = 0.02
"""Step of zeta to which the logarithms of the other fields are refined: linear between these they are within 1e-5."""

LAW_FIELDS = ("film_offset", "film_compliance", "loss_compliance")
OTHERS = ("central_film", "minimum_film", "max_pressure", "rolling_force", "mass_flow", "wall_stress")
"""Fields that are read as logarithms of their groups."""

FEWER = 4
"""Lines along each axis by which a reading is tried."""

_SAFE = 0.9
"""Share of the thickest film up to which a reading is sure not to be beyond it."""

_LEAST = 1e-300


class _Line(NamedTuple):
    """One line as it was solved: zeta (n,), and arrays over it by the names of `FilmSolution`."""

    zeta: FloatArray
    arrays: Arrays
    usable: BoolArray


class FamilyFilms:
    """Films of any contact of a family.

    Parameters
    ----------
    family : Family
        The family.
    results : mapping
        Arrays of its lines by key.

    Raises
    ------
    MapError
        If a line has too few solved points to be read.
    """

    def __init__(self, family: Family, results: Mapping[str, Arrays]) -> None:
        (self._plan,) = family.lines.plans
        self._oil: Lubricant = family.jobs[0].lubricant
        self.group = backbone_group(family.lines, results)
        self.reference = reference = self._plan.contact
        loads = [load for job in family.jobs for load in job.loads]
        self._field = BackboneField(
            self.group,
            reference,
            (reference,),
            self._oil,
            (min(loads), max(loads)),
            (self._plan.speeds[0], self._plan.speeds[-1]),
            (self._plan.temperatures[0], self._plan.temperatures[-1]),
        )
        zeta = np.array(self._plan.zeta)
        self._first = float(zeta[0])
        self._nodes = 2 + math.ceil((zeta[-1] - zeta[0]) / STEP)
        shape = len(self._plan.speeds), len(self._plan.temperatures)
        self._lines: list[_Line] = [_Line(np.empty(0), {}, np.empty(0, bool))] * math.prod(shape)
        self._lattice = np.empty((math.prod(shape), self._nodes, len(OTHERS)))
        for line, task in zip(self._plan.lines, family.lines.tasks, strict=True):
            first, j, k = line.place
            index = j * shape[1] + k
            arrays = with_later_fields(results[task.key])
            usable = np.isin(arrays["status"], [int(known) for known in Status if known.usable])
            self._lines[index] = _Line(zeta[first : first + task.points], arrays, usable)
            self._lattice[index] = self._logarithms(self._lines[index], task)

    def _units(self, contact: LineContact, loads: FloatArray, speed: float, temperature: float) -> FloatArray:
        """What the fields of `OTHERS` scale with, shape (n, 6)."""
        state = self._oil.at(temperature)
        number = moes_speed_number(speed, state.viscosity, contact.radius, contact.reduced_modulus)
        film = contact.radius * math.sqrt(number)
        force, flow = rolling_units(contact, self._oil, speed, temperature)
        peak = max_pressure(loads, contact.radius, contact.reduced_modulus)
        return np.stack(np.broadcast_arrays(film, film, peak, force, flow, 1.0), axis=-1)

    def _logarithms(self, line: _Line, task: LineTask) -> FloatArray:
        """Logarithms of the other fields over their units on the common lattice, linear beyond the line's own ends."""
        values = np.stack([line.arrays[name] for name in OTHERS], axis=-1) / self._units(
            self.reference, np.array(task.loads), task.entrainment_speed, task.temperature
        )
        known = line.usable & np.all(values > 0.0, axis=1)
        spline = CubicSpline(line.zeta[known], np.log(values[known]))
        places = self._first + STEP * np.arange(self._nodes)
        inside = np.clip(places, line.zeta[known][0], line.zeta[known][-1])
        return np.asarray(spline(inside) + spline(inside, 1) * (places - inside)[:, None])

    def read(self, task: LineTask) -> tuple[Arrays, BoolArray]:
        """Films along a line of a member, and at which of its loads they are known.

        Parameters
        ----------
        task : LineTask
            The line.

        Returns
        -------
        arrays : Arrays
            Films as the solver's, by field.
        known : ndarray, shape (n,)
            False where the solver has to be asked.
        """
        contact, speed, temperature = task.contact, task.entrainment_speed, task.temperature
        loads = np.array(task.loads)
        if not speed > 0.0:
            return film_arrays([FilmSolution(Status.FAILED)] * loads.size), np.zeros(loads.size, bool)
        law = self._field.solved_films(contact, loads, speed, temperature)
        zeta = self._field.zeta(contact, loads, speed, temperature)
        units = self._units(contact, loads, speed, temperature)
        others = np.stack(
            [units * np.exp(self._mixed(contact, zeta, speed, temperature, n)) for n in (NEIGHBOURS, FEWER)]
        )
        arrays = {name: law[0, i] for i, name in enumerate(LAW_FIELDS)}
        arrays |= {name: others[0, :, i] for i, name in enumerate(OTHERS)}
        changes = dict(zip(LAW_FIELDS, _change(law), strict=True)) | dict(zip(OTHERS, _change(others).T, strict=True))
        lines, weights = self._field.stencil(contact, speed, temperature)
        nearest = self._lines[int(lines[int(np.argmax(np.abs(weights)))])]
        at = np.clip(np.rint(np.interp(zeta, nearest.zeta, np.arange(nearest.zeta.size))).astype(int), 0, None)
        below = np.clip(np.searchsorted(nearest.zeta, zeta) - 1, 0, nearest.zeta.size - 2)
        known = nearest.usable[below] & nearest.usable[below + 1]
        known &= (zeta >= nearest.zeta[0]) & (zeta <= nearest.zeta[-1])
        for name, change in changes.items():
            if name == "wall_stress":  # solvers state no error of it
                continue
            error = nearest.arrays[f"{name}_error"][at]
            arrays[f"{name}_error"] = error + np.copysign(change, error)
        thickness = arrays["film_offset"] / contact.radius
        known &= np.isfinite(law).all(axis=(0, 1))
        # close to what the solver refuses it is asked itself: a refusal has its own words
        known &= thickness < _SAFE * THICKEST_FILM
        thick = thickness > THIN_FILM_LIMIT
        status = np.where(thick, int(Status.ASYMPTOTE), int(Status.CONVERGED))
        arrays["status"] = np.where(known, status, int(Status.FAILED)).astype(np.int8)
        arrays["reason"] = _notes(nearest.arrays["reason"][at], thick)
        fitted = self._oil.at(temperature).fitted_pressure
        arrays["iterations"] = np.zeros(loads.size, np.int32)
        arrays["solve_seconds"] = np.zeros(loads.size)
        top = arrays["max_pressure"] * (1.0 + arrays["max_pressure_error"])
        arrays["viscosity_extrapolated"] = (top > fitted).astype(np.int8)
        for name in FOUND_BY_SOME:
            arrays.setdefault(name, nearest.arrays[name][at])
        return {name: arrays[name] for name in FILM_FIELDS}, known

    def _mixed(self, contact: LineContact, zeta: FloatArray, speed: float, temperature: float, most: int) -> FloatArray:
        """Logarithms of the other fields over their units, shape (n, 6)."""
        lines, weights = self._field.stencil(contact, speed, temperature, most)
        place = np.clip((zeta - self._first) / STEP, 0.0, self._nodes - 1)
        cell = np.minimum(place.astype(int), self._nodes - 2)
        part = (place - cell)[:, None]
        low, high = (np.tensordot(weights, self._lattice[lines[:, None], cell + side], axes=1) for side in (0, 1))
        return np.asarray(low + part * (high - low))


def _change(readings: FloatArray) -> FloatArray:
    """Relative change from the first reading to the second."""
    first, second = readings
    return np.asarray(np.abs(second - first) / np.maximum(np.abs(first), _LEAST))


def _notes(reasons: npt.NDArray[Any], thick: BoolArray) -> npt.NDArray[Any]:
    """Notes of the nearest solved points, with the one that hangs on the film over the radius as it is here."""
    return np.array(
        [
            "; ".join([THICK_NOTE] * bool(own) + [n for n in str(reason).split("; ") if n and n != THICK_NOTE])
            for reason, own in zip(reasons, thick, strict=True)
        ],
        dtype=np.str_,
    )

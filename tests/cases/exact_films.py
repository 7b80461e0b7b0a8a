"""Machines whose films answer by the film solver itself, at any complex frequency: no map, no closed formula.

At each load of a fine axis, and for both contacts of a roller, the Reynolds solver gives a steady film and the Krylov
space of its linear response, which has the compliance S at any frequency, real or complex. Both contacts in series give
the stiffness Z of a slice; between the loads it is read by a cubic spline over ln w. The loads of the slices are those
of the equilibrium. Modes are those of lambda^2 M + lambda (D + speed G) + K + sum of Z(w, lambda) b b', by Newton's
method of its own, with derivatives by differences.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.ehl.group_solution import linearised_profile
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.solver import ReynoldsSolver, line_problem
from ehdmaps.ehl.spectrum import FilmSpace, film_space
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from mbs.bearings.bearing_element import BearingElement
from mbs.model.equilibrium import Equilibrium

HIGHEST = 12e3
"""Frequency up to which films are exact [Hz]."""

LOADS = np.unique(
    np.concatenate(
        [
            np.geomspace(0.02, 1.0, 14),
            np.geomspace(1.0, 3e3, 48),
            np.geomspace(3e3, 3e4, 34),
            np.geomspace(3e4, 6e5, 26),
        ]
    )
)
"""Loads at which films are solved [N/m]. Between rigid surfaces the damping is as w^1.5, and so are lighter slices."""

RIGID_POWER = 1.5


class ExactFilm(NamedTuple):
    """One contact at one load.

    Attributes
    ----------
    space : FilmSpace
        Its response.
    time : float
        b/u [s].
    dry, unit : float
        Compliance of the structure, and the unit of that of the film [m2/N].
    """

    space: FilmSpace
    time: float
    dry: float
    unit: float


@dataclass(frozen=True, eq=False)
class ExactFilms:
    """Both contacts of a roller at one speed and temperature.

    Attributes
    ----------
    contacts : tuple of LineContact
        Inner and outer.
    oil : Lubricant
        The oil.
    speed, temperature : float
        u [m/s], T [K].
    """

    contacts: tuple[LineContact, ...]
    oil: Lubricant
    speed: float
    temperature: float

    @cached_property
    def films(self) -> list[ExactFilm]:
        """Inner contacts at all loads, then outer ones."""
        return [film for contact in self.contacts for film in self._of(contact)]

    def _of(self, contact: LineContact) -> list[ExactFilm]:
        resolution, found, previous = ReynoldsSolver().resolution, [], None
        for load in LOADS.tolist():
            problem, M, L = line_problem(contact, self.oil.at(self.temperature), load, self.speed)
            groups = solve_groups(problem, M, L, resolution, previous)
            assert groups.profile is not None, f"no film at {load} N/m, {self.speed} m/s"
            previous = groups.profile
            time = float(half_width(load, contact.radius, contact.reduced_modulus)) / self.speed
            space = film_space(linearised_profile(groups.profile), 2.0 * math.pi * HIGHEST * time)
            dry = float(contact.structural_compliance(load))
            found.append(ExactFilm(space, time, dry, 4.0 / contact.reduced_modulus))
        return found

    def stiffness(self, s: complex) -> ComplexArray:
        """Z of both contacts in series at a complex frequency [1/s], at `LOADS` [N/m2]."""
        each = [
            film.dry + film.unit * film.space.compliances(np.array([-1j * s * film.time]))[0] for film in self.films
        ]
        return np.asarray(1.0 / np.reshape(each, (len(self.contacts), -1)).sum(axis=0))

    def at(self, loads: FloatArray, s: complex) -> ComplexArray:
        """Z at any loads [N/m2]."""
        return read(CubicSpline(np.log(LOADS), self.stiffness(s)), loads)


def read(line: CubicSpline, loads: FloatArray) -> ComplexArray:
    """Z at loads [N/m2] from its line over ln of the load; none without a load."""
    assert np.max(loads, initial=0.0) <= LOADS[-1]
    inside = np.clip(loads, LOADS[0], LOADS[-1])
    return np.asarray(line(np.log(inside)) * np.minimum(loads / LOADS[0], 1.0) ** RIGID_POWER)


class Slices(NamedTuple):
    """The slices of a bearing.

    Attributes
    ----------
    name : str
        Of the bearing.
    rows : array, shape (r, n)
        Approach of each by the coordinates of the system.
    along : array, shape (r,)
        Approach of each by a displacement along the load of the bearing.
    loads : array, shape (r,)
        [N/m].
    length : float
        [m].
    films : ExactFilms
        Their films.
    """

    name: str
    rows: FloatArray
    along: FloatArray
    loads: FloatArray
    length: float
    films: ExactFilms

    def stiffness(self, s: complex) -> complex:
        """Dynamic stiffness of the bearing along its load [N/m]."""
        return complex(self.films.at(self.loads, s) @ self.along**2) * self.length


class ExactMachine:
    """A system at its equilibrium, with exact films.

    Parameters
    ----------
    balance : Equilibrium
        With bearings of massless rollers.
    oil : Lubricant
        The oil of all films.
    known : dict
        Films by entrainment speed and temperature, which are taken from here or added.
    """

    def __init__(self, balance: Equilibrium, oil: Lubricant, known: dict[tuple[float, float], ExactFilms]) -> None:
        self.mass, self.stiffness, self.damping = balance.system.mass, balance.stiffness.copy(), balance.damping.copy()
        self.bearings: list[Slices] = []
        for index, connected in enumerate(balance.system.elements):
            element, ports = connected.element, connected.transform
            if not isinstance(element, BearingElement):
                continue
            self.stiffness -= ports.T @ balance.element_stiffness[index] @ ports
            self.damping -= ports.T @ balance.element_damping[index] @ ports
            rollers = element.loads(ports @ balance.displacement, balance.operation)
            cos, sin = np.cos(rollers.angle)[:, None], np.sin(rollers.angle)[:, None]
            x = rollers.position
            parts = (0.0 * x, cos, sin, 0.0 * x, -sin * x, cos * x)
            rows = np.stack([part + 0.0 * cos * x for part in parts], axis=-1).reshape(-1, 6)
            force = balance.forces[index][1:3]
            along = rows[:, 1:3] @ (force / np.linalg.norm(force))
            key = (round(element.entrainment_speed(balance.operation), 9), element.temperature)
            if key not in known:
                contacts = element.bearing.geometry.contacts(element.bearing.material, "iso16281")
                known[key] = ExactFilms(contacts, oil, *key)
            loads = rollers.load_per_length.reshape(-1)
            self.bearings.append(
                Slices(element.name, rows @ ports, along, loads, element.bearing.slice_length, known[key])
            )

    def matrix(self, s: complex) -> ComplexArray:
        """Dynamic stiffness of the system, shape (n, n)."""
        found = s * (s * self.mass + self.damping) + self.stiffness
        # Bearings of one speed share their films.
        lines: dict[int, CubicSpline] = {}
        for slices in self.bearings:
            key = id(slices.films)
            if key not in lines:
                lines[key] = CubicSpline(np.log(LOADS), slices.films.stiffness(s))
            weights = read(lines[key], slices.loads) * slices.length
            found = found + (slices.rows.T * weights) @ slices.rows
        return np.asarray(found)

    def mode(self, s: complex, shape: ComplexArray, steps: int = 12) -> tuple[complex, ComplexArray] | None:
        """Eigenvalue and shape near a first guess; None if Newton's method does not converge."""
        n = shape.size
        shape = shape / np.linalg.norm(shape)
        norm = shape.conj()
        for _ in range(steps):
            aside = 1e-5 * abs(s)
            matrix = self.matrix(s)
            slope = (self.matrix(s + aside) - matrix) / aside
            bordered = np.block([[matrix, (slope @ shape)[:, None]], [norm[None, :], np.zeros((1, 1))]])
            scale = 1.0 / np.max(np.abs(bordered), axis=1)
            step = np.linalg.solve(bordered * scale[:, None], scale * np.append(matrix @ shape, norm @ shape - 1.0))
            shape, s = shape - step[:n], s - complex(step[n])
            if abs(step[n]) <= 1e-9 * abs(s):
                return s, shape / np.linalg.norm(shape)
        return None

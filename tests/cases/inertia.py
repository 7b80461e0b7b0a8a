"""Inertia of the oil, which no equation of the films here has: to first order, by the slow flow that they have.

Between surfaces that roll with the speed u the velocity along a film h is u + (q/h - u) 6 s (1 - s), s = y/h, with the
flow q. Its acceleration times -rho is a force on the oil. The flow that such a force drives is that of a pressure
gradient of its mean weighted with the parabola 6 s (1 - s),

    F = (6/35) rho u^2 (h'/h) (9 r^2 - r - 1),    r = q/(u h),

so that the Reynolds equation has p' - F where it had p'. Far from the contact, r to 0, the oil that both surfaces bring
turns round and presses; near the film, r to 1, it is sped up and sucks. Over the viscous gradient this is of the order
of the reduced Reynolds number Re* = rho u h^2/(eta l), l = sqrt(2 h R) (B. J. Hamrock, S. R. Schmid, B. O. Jacobson,
Fundamentals of Fluid Film Lubrication, 2nd ed., 2004: the modified Reynolds number). The oil is taken as
incompressible in F, which is right in the inlet, where inertia counts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.integrate import cumulative_simpson

from ehdmaps.arrays import FloatArray
from ehdmaps.ehl.line import solve_groups
from ehdmaps.ehl.linearisation import Linearisation
from ehdmaps.ehl.reynolds import face_films, oil
from ehdmaps.ehl.solver import ReynoldsSolver, line_problem
from ehdmaps.openfoam.fields import FilmFields
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import half_width, max_pressure
from ehdmaps.physics.lubricant import Lubricant
from tests.cases.simple_gap import gap_flow

RIGID_EXIT = 0.475
"""Where the film between rigid surfaces ruptures, over sqrt(2 h R): the load does not depend on it to first order."""


def inertial_force(density: float, speed: float, share: FloatArray, widening: FloatArray) -> FloatArray:
    """F [N/m3] of a density [kg/m3] and a speed u [m/s], of r and of h'/h [1/m] along the film."""
    return np.asarray(6.0 / 35.0 * density * speed**2 * widening * (9.0 * share**2 - share - 1.0))


def reduced_reynolds(density: float, speed: float, viscosity: float, film: float, radius: float) -> float:
    """Re* of a film h on a radius R."""
    return density * speed * film * film / (viscosity * math.sqrt(2.0 * film * radius))


@dataclass(frozen=True)
class Inertia:
    """What inertia does to a film, to first order.

    Attributes
    ----------
    film, offset : float
        Change of the central film over itself, and of the film offset [m], at the same load.
    central_film : float
        Central film without inertia [m].
    reynolds : float
        Re*.
    local : float
        Largest rho u h |h'|/eta0 where a force was taken.
    """

    film: float
    offset: float
    central_film: float
    reynolds: float
    local: float


def inertia(
    contact: LineContact,
    lubricant: Lubricant,
    point: OperatingPoint,
    inlet: float,
    force: tuple[FloatArray, FloatArray] | None = None,
) -> Inertia | None:
    """Change of a film by inertia: one more right-hand side of the equations that `reynolds` is linearised to.

    Parameters
    ----------
    contact, lubricant, point
        What is solved, isothermal and Newtonian; None where it has no solution.
    inlet : float
        Distance from the contact centre to which there is oil with inertia [m].
    force : tuple of ndarray, optional
        Places [m] and F there [N/m3], in place of that of the film itself.
    """
    state, speed, radius = lubricant.at(point.temperature), point.entrainment_speed, contact.radius
    problem, M, L = line_problem(contact, state, point.load, speed)
    solved = solve_groups(problem, M, L, ReynoldsSolver().resolution)
    profile = solved.profile
    if profile is None or not isinstance(solved.linear, Linearisation):
        return None
    half = float(half_width(point.load, radius, contact.reduced_modulus))
    peak = float(max_pressure(point.load, radius, contact.reduced_modulus))
    unit = half * half / radius
    x, gap, n = half * profile.position, profile.film, profile.cells
    log_eta, _, rho, _ = oil(problem, profile.pressure)
    slope = np.gradient(gap, x)
    if force is None:
        along = inertial_force(state.density, speed, profile.mass_flow / (rho * gap), slope / gap)
    else:
        along = np.interp(x, *force, left=0.0, right=0.0)
    # the part of a cell that is in the inlet: cells are long there
    within = np.clip((x[1:] + inlet) / (x[1:] - x[:-1]), 0.0, 1.0)
    fluid = rho / np.exp(log_eta)
    force_here, fluid_here = (0.5 * (each[1:] + each[:-1]) for each in (along * half / peak, fluid))
    right = np.zeros(solved.linear.size)
    right[:n] = face_films(gap) ** 3 / problem.wedge * fluid_here * force_here * within
    change = solved.linear.solve(right)
    pressure = np.concatenate([[0.0], change[: n - 1], [0.0]])
    # the nodes hang on the exit: what a node sees is not what a place sees
    thicker = change[n + 1] + profile.position * change[n] - profile.kernel @ pressure - half * slope * change[n]
    centre = int(np.argmin(np.abs(x)))
    local = state.density * speed * unit**2 * gap * np.abs(slope) / state.viscosity
    return Inertia(
        film=float(thicker[centre] / gap[centre]),
        offset=float(unit * change[n + 1]),
        central_film=unit * solved.central_film,
        reynolds=reduced_reynolds(state.density, speed, state.viscosity, unit * solved.central_film, radius),
        local=float(np.max(local, where=x >= -inlet, initial=0.0)),
    )


def force_of_fields(fields: FilmFields, columns: int) -> tuple[FloatArray, FloatArray]:
    """Places [m] and F there [N/m3] of the velocities and densities of a film that rolls, as CFD has them."""
    rows = fields.corners.shape[0] // columns
    corners = fields.points[fields.corners].reshape(columns, rows, 4, 3)
    x = corners[..., 0].mean(axis=(1, 2))
    height = np.sort(corners[..., 1].reshape(columns, rows, 4), axis=2)
    low, high = height[:, 0, :2].mean(axis=1), height[:, -1, 2:].mean(axis=1)
    speed = fields.U.reshape(columns, rows, 3)
    density = fields.rho.reshape(columns, rows)
    u, v = speed[..., 0], speed[..., 1]
    share = (np.arange(rows) + 0.5) / rows
    y = low[:, None] + (high - low)[:, None] * share
    # surfaces roll: both with the same speed along themselves
    walls = np.full((columns, 1), np.median(u[np.abs(x) < 0.1 * np.abs(x[0])]))
    s = np.concatenate([[0.0], share, [1.0]])
    across = np.gradient(np.hstack([walls, u, walls]), s, axis=1)[:, 1:-1] / (high - low)[:, None]
    along = np.gradient(u, x, axis=0) - across * np.gradient(y, x, axis=0)
    weight = 6.0 * share * (1.0 - share)
    return x, -(density * (u * along + v * across) * weight).sum(axis=1) / weight.sum()


@dataclass(frozen=True)
class RigidGap:
    """A parabolic gap between rigid surfaces that roll: h = film + x^2/(2 R), full of oil from inlet to exit.

    Attributes
    ----------
    film, radius : float
        [m].
    inlet : float
        Distance of the inlet [m].
    density, viscosity, speed : float
        [kg/m3], [Pa s], [m/s].
    """

    film: float
    radius: float
    inlet: float
    density: float
    viscosity: float
    speed: float

    @property
    def reynolds(self) -> float:
        """Re*."""
        return reduced_reynolds(self.density, self.speed, self.viscosity, self.film, self.radius)

    def _angles(self, count: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Places x = l tan(angle), fine where the pressure is; shape (count,) each: angle, x [m], dx/d angle [m]."""
        length = math.sqrt(2.0 * self.film * self.radius)
        angle = np.linspace(-math.atan(self.inlet / length), math.atan(RIGID_EXIT), count)
        return angle, length * np.tan(angle), length / np.cos(angle) ** 2

    def first_order(self) -> float:
        """Change of the load by inertia, over itself, of slow flow and the force of its inertia."""
        angle, x, step = self._angles(4001)
        gap = self.film + x * x / (2.0 * self.radius)

        def whole(values: FloatArray) -> FloatArray:
            return np.asarray(cumulative_simpson(values * step, x=angle, initial=0.0))

        def pressure(flow: float, force: FloatArray) -> FloatArray:
            return 12.0 * self.viscosity * (self.speed * whole(gap**-2.0) - flow * whole(gap**-3.0)) + whole(force)

        def flow_of(force: FloatArray) -> float:
            return float(pressure(0.0, force)[-1] / (12.0 * self.viscosity * whole(gap**-3.0)[-1]))

        still = np.zeros_like(gap)
        slow = flow_of(still)
        force = inertial_force(self.density, self.speed, slow / (self.speed * gap), x / (self.radius * gap))
        loads = [float(whole(pressure(flow_of(each), each))[-1]) for each in (still, force)]
        return loads[1] / loads[0] - 1.0

    def by_simple_foam(self, folder: Path, columns: int, rows: int, program: str | Path = "simpleFoam") -> float:
        """The same by simpleFoam, which carries momentum: beside its own flow of an oil of a millionth of the density.

        Both surfaces are bent alike.
        """
        x = self._angles(columns + 1)[1]
        gap = self.film + x * x / (2.0 * self.radius)
        points = np.empty((columns + 1, 2, rows + 1, 3))
        points[..., 0] = x[:, None, None]
        points[..., 1] = (gap[:, None] * (np.arange(rows + 1) / rows - 0.5))[:, None, :]
        points[..., 2] = np.array([0.0, self.film])[None, :, None]
        loads = [
            gap_flow(
                folder / f"density{density:g}",
                points,
                (self.speed, self.speed),
                (0.0, 0.0),
                density,
                self.viscosity,
                convection="linearUpwind grad(U)",
                relaxed=0.9,
                program=program,
            ).pressure
            @ np.diff(x)
            for density in (1e-6 * self.density, self.density)
        ]
        return float(loads[1] / loads[0] - 1.0)

"""Point and line contacts with temperatures in the film: a reference of its own for the rule of inlet heat.

Half of the contact on cells, pressure constant over each; the solids deform by Love's closed form for rectangles, or by
the logarithm of a line. Reynolds' equation with second-order flow along the rolling, pressures by an active set, Newton
with dense matrices. The film has layers across its half, for pure rolling is symmetric: each layer has the velocity of
the flow with its own viscosities, heat of shear and of compression, convection along, across the contact and between
layers by the flow of the same cells, conduction to the walls, and walls that are moving half-spaces with the heat of
their row (Jaeger). Viscosity is that of the oil at each pressure and temperature, density goes by pressure and by the
mean temperature across the film. Slow motion adds what each cell stores: oil, heat, and heat in the walls. Nothing is
taken from the solvers, tables or rules of the package but laws of the oil over pressure and temperature.

`python -m tests.benchmarks.warm_point` writes `tests/references/warm_points.toml`: heated over isothermal films; with
`slow` it writes `slow_points.toml`.
"""

from __future__ import annotations

import math
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import RectBivariateSpline
from scipy.sparse.linalg import splu
from scipy.special import ellipe, ellipk

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.lubricant import Lubricant

MODULUS, RADIUS = 230.769e9, 8e-3
"""E' [Pa] and radius along the rolling [m] of all cases."""

CONDUCTIVITY, CAPACITY = 0.134, 2000.0
SOLID_CONDUCTIVITY, SOLID_CAPACITY, SOLID_DENSITY = 46.0, 460.0, 7850.0
"""Those of oil and steel [W/(m K)], [J/(kg K)], [kg/m3]."""

FILE = Path(__file__).parents[1] / "references" / "warm_points.toml"

CASES = (
    # oil, degC, kappa (0: a line), M, QL
    *(("ISO VG 68", 105.0, 1.0, 60.0, QL) for QL in (0.3, 1.2)),
    *(("FVA3", 85.0, 8.0, 60.0, QL) for QL in (0.3, 1.2)),
    *(("FVA3", 60.0, 0.0, 12.0, QL) for QL in (0.3, 1.2)),
    *(("FVA3", 100.0, 4.5, 120.0, QL) for QL in (0.3, 1.2, 3.0)),
    *(("ISO VG 32", 90.0, 8.0, 400.0, QL) for QL in (0.3, 1.2)),
)

NAMES = ("central_film", "minimum_film", "film_offset")


def elliptic(kappa: float) -> tuple[float, float, float]:
    """g = p_H Rx/(E* a), D = Rx/Ry and K of an ellipse."""
    if kappa == 1.0:
        return 2.0 / math.pi, 1.0, math.pi / 2.0
    m = 1.0 - kappa**-2
    first, second = float(ellipk(m)), float(ellipe(m))
    below = kappa**2 * second - first
    return (kappa**2 - 1.0) / (2.0 * below), (first - second) / below, first


@dataclass
class Grid:
    """Cells of half of a contact, in half-widths a."""

    x: FloatArray
    y: FloatArray
    faces: FloatArray
    dx: FloatArray
    dy: FloatArray
    line: bool

    @property
    def cells(self) -> int:
        return self.x.size * self.y.size


def growing(start: float, end: float, width: float, growth: float, widest: float) -> list[float]:
    """Faces from a start to beyond an end, each cell wider than the one before."""
    found = [start]
    while found[-1] < end:
        found.append(found[-1] + width)
        width = min(width * growth, widest)
    return found


def grid_of(kappa: float, width: float, inlet: float) -> Grid:
    """Cells; a line has one row."""
    inner = np.arange(-1.3, 1.3 + 0.5 * width, width)
    left = -np.array(growing(1.3, inlet, width, 1.14, 2.0))[::-1]
    right = np.array(growing(float(inner[-1]), 1.9, width, 1.1, 0.2))
    faces = np.r_[left[:-1], inner, right[1:]]
    if kappa == 0.0:
        across = np.array([0.0, 0.5])
    else:
        step = 1.25 * width * min(kappa, 2.5)
        within = np.arange(0.0, 1.15 * kappa + 0.5 * step, step)
        across = np.r_[within, growing(float(within[-1]), 6.0 * max(1.0, 0.6 * kappa), step, 1.25, 3.0)[1:]]
    middles = [0.5 * (f[1:] + f[:-1]) for f in (faces, across)]
    return Grid(middles[0], middles[1], faces, np.diff(faces), np.diff(across), kappa == 0.0)


def deformed(grid: Grid, factor: float) -> FloatArray:
    """Matrix from pressures to displacement in a^2/Rx."""
    faces = grid.faces
    if grid.line:
        far = lambda u: u * np.log(np.abs(u)) - u  # noqa: E731
        return -(far(faces[None, 1:] - grid.x[:, None]) - far(faces[None, :-1] - grid.x[:, None])) / math.pi

    def corner(u: FloatArray, v: FloatArray) -> FloatArray:
        tiny = 1e-300
        long, wide = np.maximum(np.abs(u), tiny), np.maximum(np.abs(v), tiny)
        return u * np.arcsinh(v / long) + v * np.arcsinh(u / wide)

    rows = grid.y.size
    x, y = (np.repeat(grid.x, rows), np.tile(grid.y, grid.x.size))
    x1, x2 = np.repeat(faces[:-1], rows), np.repeat(faces[1:], rows)
    half = 0.5 * np.tile(grid.dy, grid.x.size)
    found = np.empty((x.size, x.size))
    for at in range(x.size):
        u1, u2, total = x1 - x[at], x2 - x[at], 0.0
        for middle in (y, -y):
            v1, v2 = middle - half - y[at], middle + half - y[at]
            total = total + corner(u2, v2) - corner(u1, v2) - corner(u2, v1) + corner(u1, v1)
        found[at] = total
    return found * factor / math.pi


@dataclass
class Film:
    """Numbers of a film in Hertz' units, and the temperatures by layer [K above]."""

    central_film: float
    minimum_film: float
    film_offset: float
    warmest: float = 0.0


class WarmPoint:
    """One contact at a speed and load; kappa 0 is a line.

    Load M of Moes, with QL = -(d eta0/dT) u^2/k_f, which is the speed.
    """

    def __init__(self, oil: str, celsius: float, kappa: float, M: float, QL: float, width: float = 0.1,
                 layers: int = 8, inlet: float = 12.0) -> None:  # fmt: skip
        lubricant, T = Lubricant.named(oil), celsius + 273.15
        self.state = state = lubricant.at(T)
        self.QL, self.M, self.kappa = QL, M, kappa
        slope = (lubricant.at(T + 0.1).viscosity - lubricant.at(T - 0.1).viscosity) / 0.2
        self.speed = math.sqrt(QL * CONDUCTIVITY / -slope)
        number = 2.0 * state.viscosity * self.speed / (MODULUS * RADIUS)
        self.L = state.pressure_viscosity.pressure_viscosity * MODULUS * number**0.25
        self.dry = 0.25 * (1.0 + 2.0 * math.log(2.0))  # beside the same datum
        if kappa == 0.0:
            load = M * MODULUS * RADIUS * math.sqrt(number)
            a = math.sqrt(8.0 * load * RADIUS / (math.pi * MODULUS))
            self.peak, self.curvature, self.factor = MODULUS * a / (4.0 * RADIUS), 0.0, 0.5
            self.weight = 0.5 * math.pi * 0.5
        else:
            self.factor, self.curvature, first = elliptic(kappa)
            load = M * MODULUS * RADIUS**2 * number**0.75
            a = (1.5 * load * RADIUS / (math.pi * kappa * 0.5 * MODULUS * self.factor)) ** (1.0 / 3.0)
            self.peak = self.factor * 0.5 * MODULUS * a / RADIUS
            self.weight, self.dry = 2.0 * math.pi * kappa / 3.0 * 0.5, self.factor * first
        self.given, self.a = load, a
        self.wedge = 12.0 * state.viscosity * self.speed * RADIUS**2 / (a**3 * self.peak)
        self.grid = grid = grid_of(kappa, width, inlet)
        self.layers = layers
        rows = grid.y.size
        self.x, self.y = np.repeat(grid.x, rows), np.tile(grid.y, grid.x.size)
        self.area = np.outer(grid.dx, grid.dy).ravel()
        self.base = 0.5 * self.x**2 + 0.5 * self.curvature * self.y**2
        self.kernel = deformed(grid, self.factor)
        pressures = np.linspace(0.0, 1.6 * self.peak, 60)
        rises = np.linspace(-15.0, 120.0, 46)
        states = [lubricant.at(T + rise) for rise in rises]
        logs = [math.log(warm.viscosity) + warm.pressure_viscosity.log_ratio(pressures) for warm in states]
        self.log_eta = RectBivariateSpline(pressures / self.peak, rises, np.array(logs).T - math.log(state.viscosity))
        # heat: conduction, shear and compression over what the flow carries
        carried = state.density * CAPACITY
        self.conduction = CONDUCTIVITY * RADIUS**2 / (carried * self.speed * a**3)
        self.expansion = -lubricant.density_slope / state.density
        self.compression = self.peak / carried
        self.temperature = T
        taken = SOLID_DENSITY * SOLID_CAPACITY * SOLID_CONDUCTIVITY
        self.wall = CONDUCTIVITY * RADIUS / a**2 * math.sqrt(a / (math.pi * taken * self.speed))
        behind = np.sqrt(np.maximum(grid.x[:, None] - grid.faces[None, :], 0.0))
        self.jaeger = 2.0 * (behind[:, :-1] - behind[:, 1:])
        self._operators()
        self.mobility = np.zeros(grid.cells)  # ln of the flow over that of the cold film
        self.shares = np.zeros((grid.cells, layers)) + self._shares(np.zeros((grid.cells, layers)))[0]
        self.pressure: FloatArray | None = None
        self.gap = 0.0
        self.warm = np.zeros((grid.cells, layers))
        self.surface = np.zeros(grid.cells)
        self.content_rate, self.pressure_rate = np.zeros(grid.cells), np.zeros(grid.cells)
        self.warm_rate, self.surface_rate = np.zeros((grid.cells, layers)), np.zeros(grid.cells)
        self.thinned = np.ones(grid.cells)  # mean density across the film over the cold one

    def _operators(self) -> None:
        """Gradients and means at the faces between cells, and the flow with the surfaces."""
        grid, rows, n = self.grid, self.grid.y.size, self.grid.cells
        number = np.arange(n).reshape(grid.x.size, rows)
        near = [number[:-1].ravel(), number[:, :-1].ravel()]
        far = [number[1:].ravel(), number[:, 1:].ravel()]
        lengths = [
            np.repeat(0.5 * (grid.dx[1:] + grid.dx[:-1]), rows),
            np.tile(0.5 * (grid.dy[1:] + grid.dy[:-1]), grid.x.size),
        ]
        widths = [np.tile(grid.dy, grid.x.size - 1), np.repeat(grid.dx, rows - 1)]
        self.near, self.far = np.concatenate(near), np.concatenate(far)
        self.along = near[0].size
        self.ratio = np.concatenate(widths) / np.concatenate(lengths)
        count = self.near.size
        face = np.arange(count)
        ones = np.ones(count)
        self.gradient = sp.csr_matrix((np.r_[-ones, ones], (np.r_[face, face], np.r_[self.near, self.far])), (count, n))
        self.mean = abs(self.gradient) * 0.5
        edges = [(number[0], grid.dx[0] / 2, grid.dy), (number[-1], grid.dx[-1] / 2, grid.dy)]
        if not grid.line:
            edges.append((number[:, -1], grid.dy[-1] / 2, grid.dx))
        self.edge = np.concatenate([cells for cells, _, _ in edges])
        self.edge_ratio = np.concatenate([np.broadcast_to(w / d, cells.shape) for cells, d, w in edges])
        # content at the faces across the rolling: straight from the two cells before
        count_x = grid.x.size
        at = sp.lil_matrix((count_x + 1, count_x))
        at[0, 0] = 1.0
        for i in range(count_x):
            before = max(i - 1, 0)
            share = (grid.faces[i + 1] - grid.x[i]) / (grid.x[max(i, 1)] - grid.x[max(i, 1) - 1]) if i else 0.0
            at[i + 1, i] += 1.0 + share
            at[i + 1, before] -= share
        self.at_faces = sp.kron(at.tocsr(), sp.diags(grid.dy)).tocsr()
        rest = sp.kron(sp.eye(count_x + 1).tocsr()[1:] - sp.eye(count_x + 1).tocsr()[:-1], sp.eye(rows))
        self.carried = (rest @ self.at_faces).tocsr()

    def _shares(self, ratio: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Parts of the pressure flow by layer, ln of the flow, and of the dissipation; ratio is ln(eta/eta_cold)."""
        edges = np.linspace(0.0, 1.0, self.layers + 1)
        fluid = np.exp(-ratio)
        squares = fluid * (edges[1:] ** 3 - edges[:-1] ** 3) / 3.0  # Int s^2/eta of each layer
        slopes = fluid * (edges[1:] ** 2 - edges[:-1] ** 2) / 2.0
        above = (
            np.cumsum(slopes[:, ::-1], axis=1)[:, ::-1] - slopes
        )  # Int s/eta from the layer's upper edge to the wall
        # mean over a layer of Int_s^1 s/eta ds
        inner = fluid * (edges[1:] ** 2 * np.diff(edges) / 2.0 - (edges[1:] ** 3 - edges[:-1] ** 3) / 6.0)
        flow = above * np.diff(edges) + inner
        total = flow.sum(axis=1, keepdims=True)
        return flow / total, np.log(3.0 * total[:, 0]), squares

    def _density(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Density over that at rest, and its slope."""
        p = np.maximum(pressure, 0.0) * self.peak
        slope = self.state.density_ratio_slope(p) * self.peak
        return self.thinned * self.state.density_ratio(p), self.thinned * slope

    def _cold(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """ln(eta/eta0) of the supplied oil, and its slope."""
        p, none = np.maximum(pressure, 0.0), np.zeros(pressure.size)
        return self.log_eta.ev(p, none), self.log_eta.ev(p, none, dx=1)

    def solved(self, heat: bool = True, settled: float = 1e-3) -> Film:
        """Film with heat or without; ln of the flow changes by less than `settled` at the end."""
        if self.pressure is None:
            inside = np.maximum(1.0 - self.x**2 - (self.y / self.kappa if self.kappa else 0.0) ** 2, 0.0)
            pressure = np.sqrt(inside)
            pressure *= self.weight / (self.area @ pressure)
            least = float(np.min(self.base + self.kernel @ pressure))
            for thickness in (0.3, 0.15):
                self.pressure, self.gap = pressure, thickness - least
                try:
                    film = self._newton()
                    break
                except RuntimeError:
                    continue
            else:
                raise RuntimeError("no film")
        else:
            film = self._newton()
        for turn in range(60 if heat else 0):
            change = self._heated(0.6 if turn < 12 else 0.25)
            film = self._newton()
            if change < settled:
                break
        else:
            if heat:
                raise RuntimeError(f"temperatures are not settled, {change:.2g}")
        film.warmest = float(self.warm.max())
        return film

    def slow_motion(self, heat: bool) -> tuple[float, float]:
        """Film compliance and loss compliance where the load moves slowly; in Hertz' units, of a point contact.

        Mass, heat and pressure of every cell move as those of the films at neighbouring loads do, and what the film
        offset gives way to that rate at the held load is the loss compliance.
        """
        settled = 1e-5 if heat else 1.0
        self.solved(heat, settled)
        step, given, states = 0.01, self.weight, []
        for load in (1.0 + step, 1.0 - step):
            self.weight = given * load
            film = self.solved(heat, settled)
            offset = film.film_offset + self.dry * (load ** (2.0 / 3.0) - 1.0)
            states.append((offset, self.rho * self.H, self.warm.copy(), self.pressure.copy(), self.surface.copy()))
        self.weight = given
        falls, *rates = ((above - below) / (2.0 * step) for above, below in zip(*states, strict=True))
        rate, offsets = 0.05, []
        for towards in (rate, -rate):
            self._moving(*(towards * each for each in rates))
            offsets.append(self.solved(heat, settled).film_offset)
        self._moving(*(0.0 * each for each in rates))
        return float(-falls), float(offsets[0] - offsets[1]) / (2.0 * rate)

    def _moving(self, content: FloatArray, warm: FloatArray, pressure: FloatArray, surface: FloatArray) -> None:
        """Take rates of oil, temperatures and pressures, over the time that the oil needs for a half-width."""
        self.content_rate, self.warm_rate, self.pressure_rate, self.surface_rate = content, warm, pressure, surface

    def _newton(self) -> Film:
        """Pressures with the temperatures that are known."""
        n, weight = self.grid.cells, self.weight
        P, gap = self.pressure.copy(), self.gap
        empty = np.zeros(n, dtype=bool)
        for turn in range(80):
            H = np.maximum(gap + self.base + self.kernel @ P, 1e-4)
            e, de = self._cold(P)
            rho, drho = self._density(P)
            mean_H, mean_rho = self.mean @ H, self.mean @ rho
            mob = mean_rho * mean_H**3 * np.exp(-(self.mean @ (e - self.mobility))) / self.wedge * self.ratio
            flow = mob * (self.gradient @ P)
            out = (
                rho[self.edge] * H[self.edge] ** 3 * np.exp(self.mobility - e)[self.edge] / self.wedge * self.edge_ratio
            )
            lost = np.zeros(n)
            np.add.at(lost, self.edge, out)
            residual = -(self.gradient.T @ flow) - lost * P - self.carried @ (rho * H) - self.area * self.content_rate
            by_P = -(self.gradient.T @ (
                sp.diags(mob) @ self.gradient
                + sp.diags(flow) @ self.mean @ sp.diags(-de)
                + sp.diags(flow / mean_rho) @ self.mean @ sp.diags(drho)
            )) - sp.diags(lost * (1.0 - P * de)) - self.carried @ sp.diags(drho * H)  # fmt: skip
            by_H = -(self.gradient.T @ (sp.diags(3.0 * flow / mean_H) @ self.mean)) - sp.diags(3.0 * lost * P / H)
            by_H = by_H - self.carried @ sp.diags(rho)
            J = by_H @ self.kernel + by_P.toarray()
            J = np.asarray(J)
            by_gap = np.asarray(by_H.sum(axis=1)).ravel()
            if turn < 30:  # then the cells without pressure stay those
                empty = P - residual / np.minimum(np.diag(J), -1e-12) <= 0.0
            J[empty] = 0.0
            J[empty, empty] = 1.0
            whole = np.zeros((n + 1, n + 1))
            whole[:n, :n], whole[:n, n], whole[n, :n] = J, np.where(empty, 0.0, by_gap), self.area
            right = -np.r_[np.where(empty, P, residual), self.area @ P - weight]
            step = np.linalg.solve(whole, right)
            dP, dgap = step[:-1], step[-1]
            dH, full = dgap + self.kernel @ dP, ~empty
            steep = np.abs(de * dP)[full].max()
            falling = dH < 0.0
            short = min(1.0, 4.0 / max(steep, 1e-9), 0.6 / max(np.max(-dH[falling] / H[falling], initial=0.0), 1e-9))
            P, gap = P + short * dP, gap + short * dgap
            if short == 1.0:
                P = np.where(empty, 0.0, P)
                if np.abs(dP).max() < 1e-7 and abs(dgap) < 1e-7:
                    break
        else:
            raise RuntimeError("no film")
        self.pressure, self.gap, self.flow = P, gap, flow
        self.H, self.rho = gap + self.base + self.kernel @ P, self._density(P)[0]
        centre = int(np.argmin(np.abs(self.x) + np.abs(self.y)))
        near = (np.abs(self.x) < 1.5) & (P > 0.0)
        offset = gap + self.dry
        return Film(float(self.H[centre]), float(self.H[near].min()), float(offset))

    def _heated(self, rate: float) -> float:
        """Temperatures of the flow that is known, and by how much ln of the flow changes at most where it matters."""
        n, layers, P, H = self.grid.cells, self.layers, self.pressure, self.H
        thin = 1.0 / layers
        shares, near, far = self.shares, self.near, self.far
        face = 0.5 * (shares[near] + shares[far])
        # pressure flow runs down the gradient; surfaces carry the content at the faces
        flows = -self.flow[:, None] * face
        rows = self.grid.y.size
        flows[: self.along] += (self.at_faces @ (self.rho * H))[rows:-rows, None] * thin
        flows *= 0.5  # of half of the film
        net = np.zeros((n, layers))
        np.add.at(net, near, -flows)
        np.add.at(net, far, flows)
        ends = np.arange(rows)
        net[ends] += 0.5 * (self.at_faces @ (self.rho * H))[:rows, None] * thin
        net[n - 1 - ends[::-1]] -= 0.5 * (self.at_faces @ (self.rho * H))[-rows:, None] * thin
        half = 0.5 * thin * self.area
        net -= (half * self.content_rate)[:, None]
        rising = np.cumsum(net, axis=1)[:, :-1]  # from each layer to the one above it
        number = np.arange(n * layers).reshape(n, layers)
        entries: list[tuple[FloatArray, FloatArray, FloatArray]] = []

        def exchange(a: FloatArray, b: FloatArray, a_to_b: FloatArray, both: FloatArray | float) -> None:
            """Flow from a to b, and conduction both ways."""
            into_b, into_a = np.maximum(a_to_b, 0.0) + both, np.maximum(-a_to_b, 0.0) + both
            entries.extend(((b, a, into_b), (b, b, -into_b), (a, b, into_a), (a, a, -into_a)))

        exchange(number[near].ravel(), number[far].ravel(), flows.ravel(), 0.0)
        conduction = self.conduction * self.area / (0.5 * H * thin)
        exchange(number[:, :-1].ravel(), number[:, 1:].ravel(), rising.ravel(), np.repeat(conduction, layers - 1))
        top = number[:, -1]
        entries.append((top, top, -2.0 * conduction))
        inlet = number[ends].ravel()
        entering = np.maximum(0.5 * (self.at_faces @ (self.rho * H))[:rows, None] * thin * np.ones(layers), 0.0).ravel()
        entries.append((inlet, inlet, -entering))
        # the velocities times the gradient of the pressure
        falls = 0.5 * flows * (P[far] - P[near])[:, None]
        power = np.zeros((n, layers))
        np.add.at(power, near, falls)
        np.add.at(power, far, falls)
        power += (half * H * self.pressure_rate)[:, None]
        stored = (half * self.rho * H)[:, None] * self.warm_rate
        # what the pressure flow loses at each face is heat of the cells beside it
        lost = -0.25 * self.flow * (P[far] - P[near])
        sheared = np.bincount(near, np.abs(lost), n) + np.bincount(far, np.abs(lost), n)
        cold = self._cold(P)[0]
        right, matrix = np.zeros((n, layers)), None
        for _ in range(3):
            log_ratio = self._log_ratio(P, cold)
            _, _, squares = self._shares(log_ratio)
            share = squares / squares.sum(axis=1, keepdims=True)
            right = self.compression * (sheared[:, None] * share + self.expansion * self.temperature * power)
            right[:, -1] += 2.0 * conduction * self.surface
            right -= stored
            if matrix is None:
                row, column, value = (np.concatenate([np.broadcast_to(entry[k], entry[0].shape) for entry in entries])
                                      for k in range(3))  # fmt: skip
                matrix = sp.csc_matrix((value, (row, column)), (n * layers, n * layers))
                solver = splu(matrix)
            found = np.clip(solver.solve(-right.ravel()).reshape(n, layers), -14.0, 110.0)
            self.warm = 0.5 * (self.warm + found)
            flux = 2.0 * (self.warm[:, -1] - self.surface) / (0.5 * H * thin)
            memory = 0.5 * np.cumsum(np.repeat(self.grid.dx, rows).reshape(-1, rows)
                                     * self.surface_rate.reshape(-1, rows), axis=0)  # fmt: skip
            self.surface = (self.wall * (self.jaeger @ flux.reshape(-1, rows)) - memory).ravel()
        shares, mobility, _ = self._shares(self._log_ratio(P, cold))
        change = float(np.max(np.abs(mobility - self.mobility)[P > 1e-3]))
        thinned = 1.0 - self.expansion * np.where(P > 1e-3, np.mean(self.warm, axis=1), 0.0)
        self.thinned = (1.0 - rate) * self.thinned + rate * thinned
        self.shares = (1.0 - rate) * self.shares + rate * shares
        self.mobility = (1.0 - rate) * self.mobility + rate * mobility
        return change

    def _log_ratio(self, pressure: FloatArray, cold: FloatArray) -> FloatArray:
        """ln of the viscosities of all layers over the cold one."""
        p = np.broadcast_to(np.maximum(pressure, 0.0)[:, None], self.warm.shape)
        return self.log_eta.ev(p, self.warm) - cold[:, None]


def compared(case: tuple[str, float, float, float, float], width: float, layers: int = 8) -> dict[str, float | str]:
    """A case, and its heated over its isothermal numbers."""
    oil, celsius, kappa, M, QL = case
    point = WarmPoint(*case, width=width, layers=layers)
    cold, warm = point.solved(heat=False), point.solved()
    found = {"oil": oil, "celsius": celsius, "kappa": kappa, "M": M, "QL": QL, "L": round(point.L, 2),
             "speed": round(point.speed, 3), "load": float(f"{point.given:.6g}"),
             "peak": round(point.peak / 1e9, 3), "warmest": round(warm.warmest, 1)}  # fmt: skip
    return found | {name: round(getattr(warm, name) / getattr(cold, name), 5) for name in NAMES}


SLOW = (
    *(("FVA3", 100.0, 4.5, 120.0, QL) for QL in (1.2, 3.0)),
    ("FVA3", 85.0, 8.0, 60.0, 0.3),
    *(("ISO VG 32", 90.0, 8.0, 400.0, QL) for QL in (1.2, 5.0)),
    ("ISO VG 22", 70.0, 6.0, 150.0, 2.0),
    ("ISO VG 68", 105.0, 1.0, 60.0, 1.2),
)
"""Cases whose slow motion is solved."""

SLOW_FILE = FILE.with_name("slow_points.toml")

SLOW_WIDTH = 0.16


def slow_motions() -> None:
    """Write heated over isothermal film compliances and losses, and the compliance of dry contacts."""
    head = (
        "# Film compliance and loss compliance with temperatures, over those of isothermal films, and that of the dry\n"
        "# contact over that of the isothermal film: `python -m tests.benchmarks.warm_point slow`.\n"
        f"# Radius {RADIUS:g} m along the rolling, E' {MODULUS:g} Pa; cells of {SLOW_WIDTH:g} half-widths, 8 layers.\n"
    )
    SLOW_FILE.write_text(head, encoding="utf-8")
    for case in SLOW:
        point = WarmPoint(*case, width=SLOW_WIDTH)
        cold, warm = point.slow_motion(heat=False), point.slow_motion(heat=True)
        rows = dict(zip(("oil", "celsius", "kappa", "M", "QL"), case, strict=True)) | {
            "speed": round(point.speed, 3),
            "load": float(f"{point.given:.6g}"),
            "film_compliance": round(warm[0] / cold[0], 4),
            "loss_compliance": round(warm[1] / cold[1], 4),
            "dry_compliance": round(point.dry * 2.0 / 3.0 / cold[0], 3),
        }
        text = "".join(f"{key} = {value!r}\n".replace("'", '"') for key, value in rows.items())
        print(text, flush=True)
        with SLOW_FILE.open("a", encoding="utf-8") as file:
            file.write(f"\n[[points]]\n{text}")


def written(width: float) -> None:
    """Solve all cases and write them, one after another."""
    start = time.process_time()
    head = (
        "# Films with temperatures over isothermal ones, by `python -m tests.benchmarks.warm_point`; kappa 0: a line.\n"
        f"# Radius {RADIUS:g} m along the rolling, E' {MODULUS:g} Pa; cells of {width:g} half-widths, 8 layers.\n"
    )
    FILE.write_text(head, encoding="utf-8")
    for case in CASES:
        found = compared(case, width * (0.4 if case[2] == 0.0 else 1.0))
        print(found, f"{time.process_time() - start:.0f} s", flush=True)
        text = "".join(f"{key} = {value!r}\n".replace("'", '"') for key, value in found.items())
        with FILE.open("a", encoding="utf-8") as file:
            file.write(f"\n[[points]]\n{text}")


if __name__ == "__main__":
    if sys.argv[1:] == ["slow"]:
        slow_motions()
    else:
        written(float(sys.argv[1]) if len(sys.argv) > 1 else 0.11)

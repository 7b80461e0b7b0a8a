"""Point contacts on an oil layer over flooded ones: a reference of its own for the rule of layers.

The cells, solids and oils of `tests.benchmarks.warm_point`, isothermal, with oil that is conserved where it does not
fill the gap: each cell either is full, with a pressure, or carries less than it holds, without one (Jakobsson, Floberg
and Olsson). The layer comes in at the first row of cells. Damping is by a source of oil that is that of an approach.

`python -m tests.benchmarks.starved_points` writes `tests/references/starved_points.toml`.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from tests.benchmarks.warm_point import MODULUS, RADIUS, Film, WarmPoint

FILE = Path(__file__).parents[1] / "references" / "starved_points.toml"

CASES = (
    # oil, degC, kappa, M, QL, which is the speed, inlet in half-widths
    ("FVA3", 80.0, 2.0, 60.0, 0.05, 14.0),
    ("ISO VG 68", 90.0, 4.5, 150.0, 0.1, 12.0),
    ("FVA3", 90.0, 8.0, 80.0, 0.1, 12.0),
    ("ISO VG 32", 60.0, 6.0, 20.0, 0.1, 30.0),
    ("ISO VG 32", 60.0, 6.0, 5.0, 0.1, 60.0),
    ("ISO VG 32", 60.0, 1.0, 10.0, 0.1, 30.0),
)

LAYERS = (4.0, 2.0, 1.3, 1.0, 0.7, 0.5)

NAMES = ("central_film", "minimum_film", "film_offset")


class StarvedPoint(WarmPoint):
    """A contact that may have a layer of oil before it."""

    def on_layer(self, layer: float) -> Film:
        """Film on a layer, over density at rest and a^2/Rx, from the film that was solved last."""
        n, rows, weight = self.grid.cells, self.grid.y.size, self.weight
        if not hasattr(self, "void"):
            self.void, self.full = np.zeros(n), self.pressure > 0.0
        count = self.grid.x.size
        rest = sp.eye(count) - sp.eye(count, k=-1)
        upwind = sp.kron(rest, sp.diags(self.grid.dy)).tocsr()
        columns = upwind.toarray()
        first = np.arange(rows)
        P, gap, D, full = self.pressure.copy(), self.gap, self.void.copy(), self.full.copy()
        entering = np.zeros(n)
        entering[first] = self.grid.dy
        for turn in range(120):
            H = np.maximum(gap + self.base + self.kernel @ P, 1e-4)
            e, de = self._cold(P)
            rho, drho = self._density(P)
            mean_H, mean_rho = self.mean @ H, self.mean @ rho
            mob = mean_rho * mean_H**3 * np.exp(-(self.mean @ e)) / self.wedge * self.ratio
            flow = mob * (self.gradient @ P)
            carried = self.carried @ (rho * H)
            residual = -(self.gradient.T @ flow) - carried + upwind @ D + entering * (layer - rho * H)
            by_P = -(self.gradient.T @ (
                sp.diags(mob) @ self.gradient
                + sp.diags(flow) @ self.mean @ sp.diags(-de)
                + sp.diags(flow / mean_rho) @ self.mean @ sp.diags(drho)
            )) - self.carried @ sp.diags(drho * H) - sp.diags(entering * drho * H)  # fmt: skip
            by_H = -(self.gradient.T @ (sp.diags(3.0 * flow / mean_H) @ self.mean)) - self.carried @ sp.diags(rho)
            by_H = by_H - sp.diags(entering * rho)
            J = np.asarray(by_H @ self.kernel + by_P.toarray())
            by_gap = np.asarray(by_H.sum(axis=1)).ravel()
            if turn < 90:
                full = np.where(full, P - residual / np.minimum(np.diag(J), -1e-12) > 0.0, D < 0.0)
            fixed_P, fixed_D = np.where(full, 0.0, -P), np.where(full, -D, 0.0)
            whole = np.zeros((n + 1, n + 1))
            whole[:n, :n] = np.where(full, J, columns)
            whole[:n, n], whole[n, :n] = by_gap, np.where(full, self.area, 0.0)
            right = -np.r_[residual + J @ fixed_P + columns @ fixed_D, self.area @ (P + fixed_P) - weight]
            step = np.linalg.solve(whole, right)
            dP, dD, dgap = np.where(full, step[:-1], fixed_P), np.where(full, fixed_D, step[:-1]), step[-1]
            dH = dgap + self.kernel @ dP
            steep, falling = np.abs(de * dP)[full].max(), dH < 0.0
            short = min(1.0, 4.0 / max(steep, 1e-9), 0.6 / max(np.max(-dH[falling] / H[falling], initial=0.0), 1e-9))
            P, gap, D = P + short * dP, gap + short * dgap, D + short * dD
            if short == 1.0 and np.abs(dP).max() < 1e-7 and abs(dgap) < 1e-7:
                break
        else:
            raise RuntimeError("no film")
        self.pressure, self.gap, self.void, self.full = P, gap, D, full
        self.H, self.rho = gap + self.base + self.kernel @ P, self._density(P)[0]
        centre = int(np.argmin(np.abs(self.x) + np.abs(self.y)))
        near = (np.abs(self.x) < 1.5) & (P > 0.0)
        return Film(float(self.H[centre]), float(self.H[near].min()), float(gap + self.dry))

    @property
    def content(self) -> float:
        """Film in the middle times its density over that at rest."""
        centre = int(np.argmin(np.abs(self.x) + np.abs(self.y)))
        return float(self.rho[centre] * self.H[centre])


def written(width: float) -> None:
    """Solve all cases and write them, one after another."""
    start = time.process_time()
    FILE.write_text(
        "# Films on an oil layer over flooded ones, by `python -m tests.benchmarks.starved_points`; r: layer over the\n"
        "# content of the flooded film, part: central film over film offset of the flooded contact.\n"
        f"# Radius {RADIUS:g} m along the rolling, E' {MODULUS:g} Pa; cells of {width:g} half-widths.\n",
        encoding="utf-8",
    )
    for *case, inlet in CASES:
        point = StarvedPoint(*case, width=width, inlet=inlet)
        flooded = point.solved(heat=False)
        whole, part = point.content, flooded.central_film / flooded.film_offset
        for ratio in LAYERS:
            try:
                film = point.on_layer(ratio * whole)
            except RuntimeError as error:
                print(case, ratio, error, flush=True)
                break
            found = {"kappa": case[2], "M": case[3], "L": round(point.L, 2), "r": ratio, "part": round(part, 4)}
            found |= {name: round(getattr(film, name) / getattr(flooded, name), 5) for name in NAMES}
            print(found, f"{point.grid.cells} cells, {time.process_time() - start:.0f} s", flush=True)
            text = "".join(f"{key} = {value!r}\n" for key, value in found.items())
            with FILE.open("a", encoding="utf-8") as file:
                file.write(f"\n[[points]]\n{text}")


if __name__ == "__main__":
    written(float(sys.argv[1]) if len(sys.argv) > 1 else 0.13)

"""Speed of the contact law beside its error, against the interpolators at hand; all in one run.

Run: python -m tests.benchmarks.bench_law

The film is a closed form with a narrow damping valley, known everywhere, so that the error of each way is known too;
a quarter of the checked points lie in the valley. The interpolators get load and damping of both contacts in series
over approach, speed and temperature on a grid of 25 x 12 x 6, its approach axis asinh-spaced; the error of pchip is
left out, it would take minutes. The law is shown made from the field itself, as from a refined map, and from the films
of a grid of 25 x 12 x 6.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import xarray as xr
from scipy.interpolate import RegularGridInterpolator

from ehdmaps.maps.grid_field import GridField
from ehdmaps.maps.kernels.law_in_c import LawInC
from ehdmaps.maps.law import ContactLaw
from tests.cases.laws import CONTACTS, OIL, ValleyField, exact_law

POINTS = 200_000
CHECKS = 400
FIELD = ValleyField()
LOADS = np.geomspace(*FIELD.load_range, 25)
SPEEDS = np.geomspace(*FIELD.speed_range, 12)
TEMPERATURES = np.linspace(*FIELD.temperature_range, 6)


def best_of(call: Callable[[], object], points: int, repeats: int = 3) -> float:
    """Shortest time of a few [us a point]."""
    call()
    times = []
    for _ in range(repeats):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return min(times) / points * 1e6


def grid_field() -> GridField:
    """What a solver would leave on the grid."""
    shape = (LOADS.size, SPEEDS.size, TEMPERATURES.size)
    loads = np.broadcast_to(LOADS[:, None, None], shape).copy()
    arrays = [FIELD.films(name, loads, SPEEDS, TEMPERATURES) for name in FIELD.contacts]
    film, compliance, loss = (np.stack(values) for values in zip(*arrays, strict=True))
    return GridField(CONTACTS, OIL, LOADS, SPEEDS, TEMPERATURES, film, compliance, loss)


def checks() -> dict[str, np.ndarray]:
    """Points at which the law of the field is known exactly; a quarter of them in the valley."""
    random = np.random.default_rng(20240607)
    rows = []
    for i in range(CHECKS):
        speed = float(np.exp(random.uniform(*np.log(FIELD.speed_range))))
        temperature = float(random.uniform(*FIELD.temperature_range))
        if i % 4 == 0:
            state = OIL.at(temperature)
            valley = [2.5 * np.sqrt(c.reduced_modulus * c.radius * 2.0 * speed * state.viscosity) for c in CONTACTS]
            load = float(np.clip(np.exp(random.uniform(-0.4, 0.4)) * np.mean(valley), *FIELD.load_range))
        else:
            load = float(np.exp(random.uniform(*np.log(FIELD.load_range))))
        delta, k, c = exact_law(FIELD, CONTACTS, np.array([load]), speed, temperature)
        rows.append((load, speed, temperature, delta[0], k[0], c[0]))
    names = ("w", "u", "T", "delta", "k", "c")
    return dict(zip(names, np.array(rows).T, strict=True))


def errors(check: dict[str, np.ndarray], w: np.ndarray, k: np.ndarray | None, c: np.ndarray) -> str:
    """Median and 95 % quantile of the relative errors."""
    cells = []
    for got, wanted in ((w, check["w"]), (k, check["k"]), (c, check["c"])):
        if got is None:
            cells.append(f"{'-':>17}")
            continue
        error = np.abs(got / wanted - 1.0)
        cells.append(f"{np.median(error):8.1e} {np.quantile(error, 0.95):8.1e}")
    return "  ".join(cells)


def main() -> None:
    """Print the table."""
    check = checks()
    random = np.random.default_rng(1)
    pick = random.integers(0, CHECKS, POINTS)
    delta, u, T = check["delta"][pick], check["u"][pick], check["T"][pick]
    u = np.clip(u * np.exp(random.normal(0.0, 0.05, POINTS)), *FIELD.speed_range)
    T = np.clip(T + random.normal(0.0, 1.0, POINTS), *FIELD.temperature_range)
    delta = np.minimum(delta, 3e-5)
    rate = random.normal(0.0, 1e-4, POINTS)

    rows = []
    start = time.process_time()
    law = ContactLaw("series", CONTACTS, OIL, FIELD)
    made = time.process_time() - start
    grid = grid_field()
    start = time.process_time()
    coarse = ContactLaw("series", CONTACTS, OIL, grid)
    made_coarse = time.process_time() - start
    for name, each in (("law, refined map", law), ("law, grid 25x12x6", coarse)):
        w, k, c = each(check["delta"], 0.0, check["u"], check["T"])
        rows.append((name, best_of(lambda each=each: each(delta, rate, u, T), POINTS), errors(check, w, k, c)))
    point = law.at(1.0, 330.0)
    w, k, c = np.array(
        [
            law.at(speed, temperature)(approach, 0.0)
            for approach, speed, temperature in zip(check["delta"], check["u"], check["T"], strict=True)
        ]
    ).T
    rows.append(("law.at", best_of(lambda: point(delta, rate), POINTS), errors(check, w, k, c)))
    slow = law.at(0.02, 330.0)
    rows.append(("law.at, u < map", best_of(lambda: slow(delta, rate), POINTS), ""))
    loaded = law.at(1.0, 330.0, 300.0)
    rows.append(("law.at, centrifugal", best_of(lambda: loaded(delta, rate), POINTS), ""))

    # The interpolators: w and c on a rectangular grid of the approach, from the exact law.
    ends = np.array([check["delta"].min(), check["delta"].max()])
    deltas = 2e-7 * np.sinh(np.linspace(*np.arcsinh(ends / 2e-7), LOADS.size))
    deltas[[0, -1]] = ends
    mesh = np.meshgrid(deltas, SPEEDS, TEMPERATURES, indexing="ij")
    load, _, damping = ContactLaw("series", CONTACTS, OIL, FIELD, "clamp")(mesh[0], 0.0, mesh[1], mesh[2])
    axes = (deltas, np.log(SPEEDS), TEMPERATURES)
    places, check_places = (
        np.stack((d, np.log(s), t), axis=1)
        for d, s, t in ((np.clip(delta, *ends), u, T), (check["delta"], check["u"], check["T"]))
    )
    for method, count in (("linear", POINTS), ("cubic", 2000), ("pchip", 20)):
        both = [RegularGridInterpolator(axes, values, method=method, bounds_error=False) for values in (load, damping)]
        chosen = places[:count]
        rows.append(
            (
                f"scipy {method}, w and c",
                best_of(lambda both=both, chosen=chosen: [each(chosen) for each in both], count, 1),
                errors(check, both[0](check_places), None, both[1](check_places)) if method != "pchip" else "",
            )
        )
    dataset = xr.Dataset(
        {"w": (("delta", "u", "T"), load), "c": (("delta", "u", "T"), damping)},
        coords={"delta": axes[0], "u": axes[1], "T": axes[2]},
    )

    def by_xarray(at: np.ndarray) -> xr.Dataset:
        return dataset.interp({name: ("p", at[:, i]) for i, name in enumerate(("delta", "u", "T"))})

    found = by_xarray(check_places)
    rows.append(
        (
            "xarray.interp, w and c",
            best_of(lambda: by_xarray(places), POINTS, 1),
            errors(check, found["w"].values, None, found["c"].values),
        )
    )
    rows.append(("xarray.interp, one point", best_of(lambda: by_xarray(places[:1]), 1), ""))

    first = rows[0][1]
    print(f"a law is made in {made:.2f} s (refined), {made_coarse:.2f} s (grid); table {table_size(law):.1f} MB")
    head = f"{'median, 95 % error of w':>17}  {'k':>17}  {'c':>17}"
    print(f"{'':26} {'us a point':>11} {'ratio':>9}   {head}")
    for name, cost, error in rows:
        print(f"{name:26} {cost:11.4f} {cost / first:9.1f}   {error:>17}")
    print(f"law at one speed and temperature, made: {collapse_cost(law):.2f} us")


def table_size(law: ContactLaw) -> float:
    """Size of the table of a law [MB]."""
    return law.table.own.coefficients.nbytes / 1e6


def collapse_cost(law: ContactLaw) -> float:
    """Time of the law at a new speed [us]."""
    in_c = LawInC(law.table, centrifugal=False)

    def many() -> None:
        for i in range(1000):
            in_c.point(0.5 + 1e-4 * i, 330.0, 0.0)

    return best_of(many, 1000)


if __name__ == "__main__":
    main()

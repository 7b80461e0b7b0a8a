"""How often the modes of a fine map lie in the bands that a coarse map of the same bearing states.

Run: python -m tests.benchmarks.bench_bands COARSE.nc FINE.nc SCENE [SCENE ...]

Each scene is linearised with both maps at all of `SPEEDS` and `TEMPERATURES` that lie in both. Modes of the one are
those of the other with the most alike shape (mass-weighted MAC, at least `LEAST_LIKENESS`). Counted are modes that
oscillate, below `HIGHEST`, with at least `LEAST_SHARE` of their strain energy in bearings. A difference is covered
where it is at most the band of the coarse map; beside it that of the fine one is added, which is wrong too. Told is the
share that is covered, of frequencies and of damping ratios, and how large the differences are as parts of the band: a
band that covers all, and of which differences are a thousandth, is of no use either. The same for k and c of the
bearings along their load. Last, what the bands cost beside equilibrium and modes, as a ratio of processor times in one
run.
"""

from __future__ import annotations

import argparse
import itertools
import time

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.units import RPM, TEMPERATURE
from mbs.linearised.bands import law_bands
from mbs.linearised.modes import Modes, modes
from mbs.linearised.steady import steady_system
from mbs.linearised.sweep_point import along_load
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.scene.assembly import Model, assemble
from mbs.scene.changes import with_temperature
from mbs.scene.reader import read_scene

SPEEDS = tuple(rpm / RPM.factor for rpm in (500.0, 1000.0, 1500.0, 2000.0, 2500.0))
TEMPERATURES = tuple(celsius + 273.15 for celsius in (35.0, 40.0, 55.0, 65.0))
HIGHEST = 12e3
LEAST_SHARE, LEAST_LIKENESS = 0.05, 0.9


def analysed(scene: str, emap: EHDMap, speed: float, temperature: float) -> tuple[Model, Equilibrium, Modes]:
    """A scene with a map at a speed [rad/s] and temperature [K]."""
    model = assemble(with_temperature(read_scene(scene), temperature), "map", emap)
    balance = equilibrium(steady_system(model.system), Operation(speed))
    return model, balance, modes(balance)


def paired(first: Modes, second: Modes, mass: FloatArray, bearings: list[str]) -> list[tuple[int, int]]:
    """Modes of the first that are counted, each with the one of the second whose shape is most alike."""
    rows = [first.parts.index(name) for name in bearings]
    counted = (
        (first.eigenvalues.imag > 0.0) & (first.frequency < HIGHEST) & (first.shares[rows].sum(axis=0) >= LEAST_SHARE)
    )
    sizes = [np.sum((found.shapes.conj() * (mass @ found.shapes)).real, axis=0) for found in (first, second)]
    likeness = np.abs(first.shapes.conj().T @ mass @ second.shapes) ** 2 / np.outer(*sizes)
    likeness[:, second.eigenvalues.imag <= 0.0] = 0.0
    best = np.argmax(likeness, axis=1)
    return [(int(k), int(best[k])) for k in np.flatnonzero(counted) if likeness[k, best[k]] >= LEAST_LIKENESS]


def within(emap: EHDMap, model: Model, speed: float, temperature: float) -> bool:
    """Whether the map has the speed and the temperature."""
    low, high = emap.dataset["temperature"].values[[0, -1]]
    speeds = emap.dataset["entrainment_speed"].values
    slowest = float(speeds[speeds > 0.0][0])
    entrained = [bearing.entrainment_speed(Operation(speed)) for bearing in model.bearings]
    return bool(low <= temperature <= high and slowest <= min(entrained) and max(entrained) <= speeds[-1])


def told(words: str, differences: FloatArray, bands: FloatArray, fine: FloatArray, values: FloatArray) -> None:
    """A line on how many differences are covered, and how large they are."""
    parts = np.abs(differences) / np.maximum(bands, 1e-300)
    both = np.abs(differences) <= bands + fine
    middle, most = np.quantile(parts, [0.5, 0.95])
    print(
        f"  {words:14} {differences.size:5d} covered {100.0 * np.mean(parts <= 1.0):6.1f} % (with the band of the fine "
        f"map {100.0 * np.mean(both):5.1f} %); difference over band: median {middle:.2g}, 95 % {most:.2g}, "
        f"largest {parts.max():.2g}; band: median {100.0 * np.median(bands / np.abs(values)):.2g} %, "
        f"difference: median {100.0 * np.median(np.abs(differences / values)):.2g} %, largest "
        f"{100.0 * np.max(np.abs(differences / values)):.2g} %"
    )


def compared(scene: str, coarse: EHDMap, fine: EHDMap) -> None:
    """Print what of a scene is covered."""
    rows: list[list[float]] = []
    sides: list[list[float]] = []
    for speed, temperature in itertools.product(SPEEDS, TEMPERATURES):
        if not within(coarse, assemble(read_scene(scene)), speed, temperature):
            continue
        model, balance, first = analysed(scene, coarse, speed, temperature)
        _, other, second = analysed(scene, fine, speed, temperature)
        assert first.bands is not None and second.bands is not None
        names = [bearing.name for bearing in model.bearings]
        for k, j in paired(first, second, balance.system.mass, names):
            rows.append(
                [
                    *(first.frequency[k], second.frequency[j]),
                    *(first.bands.frequency[k], second.bands.frequency[j]),
                    *(first.damping_ratio[k], second.damping_ratio[j]),
                    *(first.bands.damping_ratio[k], second.bands.damping_ratio[j]),
                ]
            )
        bands = [law_bands(entry) for entry in (balance, other)]
        assert bands[0] is not None and bands[1] is not None
        found = [along_load(balance)[1:], bands[0].of_bearings(), along_load(other)[1:], bands[1].of_bearings()]
        sides += np.vstack(found).T.tolist()
    print(scene)
    table = np.array(rows)
    for words, at in (("frequency", 0), ("damping ratio", 4)):
        value, true, band, of_fine = table[:, at : at + 4].T
        told(words, value - true, band, of_fine, true)
    table = np.array(sides)
    for words, at in (("bearing k", 0), ("bearing c", 1)):
        told(words, table[:, at] - table[:, at + 4], table[:, at + 2], table[:, at + 6], table[:, at + 4])


def cost(scene: str, emap: EHDMap) -> None:
    """Print what the bands cost beside equilibrium and modes."""
    model = assemble(read_scene(scene), "map", emap)
    spent = []
    for _ in range(5):
        begin = time.process_time()
        balance = equilibrium(steady_system(model.system), model.operation)
        found = modes(balance)
        middle = time.process_time()
        band = law_bands(balance)
        assert band is not None
        n = balance.system.size
        band.of_modes(found.eigenvalues, found.shapes, np.ones((found.eigenvalues.size, n), dtype=complex))
        spent.append((middle - begin, time.process_time() - middle))
    whole, own = np.min(np.array(spent), axis=0)
    print(f"  bands take {100.0 * own / (whole - own):.1f} % of equilibrium and modes without them")


def main() -> None:
    """Compare."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("coarse")
    parser.add_argument("fine")
    parser.add_argument("scenes", nargs="+")
    given = parser.parse_args()
    coarse, fine = open_map(given.coarse), open_map(given.fine)
    print(f"coarse: {coarse.law_errors.words}")
    print(f"speeds {', '.join(map(RPM.text, SPEEDS))}; temperatures {', '.join(map(TEMPERATURE.text, TEMPERATURES))}")
    for scene in given.scenes:
        compared(scene, coarse, fine)
        cost(scene, fine)


if __name__ == "__main__":
    main()

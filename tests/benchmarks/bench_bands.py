"""How often the modes of a fine map lie in the bands that a coarse map of the same bearing states.

Run: python -m tests.benchmarks.bench_bands COARSE.nc FINE.nc SCENE [SCENE ...] [--cost]

Each scene is linearised with both maps at all of `SPEEDS` within the coarse one, and `TEMPERATURES` held at its ends.
Modes of the one are those of the other with the most alike shape (mass-weighted MAC of at least `LEAST_LIKENESS`).
Counted are modes that oscillate, below `HIGHEST`, with at least `LEAST_SHARE` of their strain energy in bearings. A
difference is covered where it is at most the band of the coarse map; beside it that of the fine one is added, which is
wrong too. Told is the share that is covered, of frequencies and of damping ratios, and how large the differences are as
parts of the band: a band that covers all, and of which differences are a thousandth, is of no use either. The same for
k and c of the bearings along their load. With --cost also what the bands cost, as ratios of processor times.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.law import ContactLaw
from ehdmaps.units import RPM, TEMPERATURE
from mbs.analyses.lsa import lsa
from mbs.analyses.modes import modes as modes_of_model
from mbs.analyses.sweep import SweepSettings, sweep
from mbs.bearings.bearing_element import BearingElement, RollerElement
from mbs.linearised.averaged import steady_system
from mbs.linearised.bands import law_bands
from mbs.linearised.modes import Modes, modes
from mbs.linearised.sweep import along_load
from mbs.model.elements import Element, Operation
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.scene.assembly import Model, assemble
from mbs.scene.changes import with_temperature
from mbs.scene.reader import read_scene
from mbs.settings import SweepRange

SPEEDS = tuple(rpm / RPM.factor for rpm in (500.0, 1000.0, 1500.0, 2000.0, 2500.0))
TEMPERATURES = tuple(celsius + 273.15 for celsius in (35.0, 40.0, 55.0, 65.0))
HIGHEST = 12e3
LEAST_SHARE, LEAST_LIKENESS = 0.05, 0.9


def warm(scene: str, emap: EHDMap, temperature: float) -> Model:
    """A scene with a map at a temperature [K]."""
    return assemble(with_temperature(read_scene(scene), temperature), "map", emap)


def analysed(model: Model, speed: float) -> tuple[Equilibrium, Modes]:
    """Equilibrium and modes at a speed [rad/s]."""
    balance = equilibrium(steady_system(model.system), Operation(speed))
    return balance, modes(balance)


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


def within(emap: EHDMap, model: Model, speed: float) -> bool:
    """Whether the map has the speed."""
    speeds = emap.dataset["entrainment_speed"].values
    slowest = float(speeds[speeds > 0.0][0])
    entrained = [bearing.entrainment_speed(Operation(speed)) for bearing in model.bearings]
    return bool(slowest <= min(entrained) and max(entrained) <= speeds[-1])


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


def _one(model: Model, reference: Model, speed: float, rows: list[list[float]], sides: list[list[float]]) -> None:
    """Add modes and bearings at a speed: values, then bands."""
    balance, first = analysed(model, speed)
    other, second = analysed(reference, speed)
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


def compared(scene: str, coarse: EHDMap, fine: EHDMap) -> None:
    """Print what of a scene is covered."""
    rows: list[list[float]] = []
    sides: list[list[float]] = []
    for temperature in TEMPERATURES:
        low, high = coarse.dataset["temperature"].values[[0, -1]]
        model, reference = (warm(scene, emap, float(np.clip(temperature, low, high))) for emap in (coarse, fine))
        for speed in SPEEDS:
            if within(coarse, model, speed):
                _one(model, reference, speed, rows, sides)
    print(scene)
    table = np.array(rows)
    for words, at in (("frequency", 0), ("damping ratio", 4)):
        value, true, band, of_fine = table[:, at : at + 4].T
        told(words, value - true, band, of_fine, true)
    table = np.array(sides)
    for words, at in (("bearing k", 0), ("bearing c", 1)):
        told(words, table[:, at] - table[:, at + 4], table[:, at + 2], table[:, at + 6], table[:, at + 4])


def cost(scene: str, emap: EHDMap) -> None:
    """Print what the bands cost: processor time of each analysis beside that with laws that state no errors."""
    model = assemble(read_scene(scene), "map", emap)
    laws = [law for connected in model.system.elements for law in laws_of(connected.element)]
    stated = [law.errors for law in laws]
    speeds = SweepSettings(SweepRange(SPEEDS[0], SPEEDS[-1], 3))
    for name, analysis in (
        ("modes", lambda: modes_of_model(model)),
        ("lsa", lambda: lsa(model)),
        ("sweep", lambda: sweep(model, speeds)),
    ):
        analysis()
        ratios = []
        for _ in range(3):
            spent = []
            for errors in (stated, [None] * len(laws)):
                for law, of_law in zip(laws, errors, strict=True):
                    law.errors = of_law
                begin = time.process_time()
                analysis()
                spent.append(time.process_time() - begin)
            ratios.append(spent[0] / spent[1])
        for law, of_law in zip(laws, stated, strict=True):
            law.errors = of_law
        print(f"  {name} with bands takes {np.median(ratios):.3f} of the time without ({spent[1]:.3f} s)")


def laws_of(element: Element) -> list[ContactLaw]:
    """Laws of a bearing that is made from a map."""
    if isinstance(element, RollerElement):
        found = list(element.contacts.laws)
    else:
        found = [element.force.law] if isinstance(element, BearingElement) else []
    return [law for law in found if isinstance(law, ContactLaw)]


def main() -> None:
    """Compare."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("coarse")
    parser.add_argument("fine")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--cost", action="store_true")
    given = parser.parse_args()
    coarse, fine = open_map(given.coarse), open_map(given.fine)
    print(f"coarse: {coarse.law_errors.words}")
    print(f"speeds {', '.join(map(RPM.text, SPEEDS))}; temperatures {', '.join(map(TEMPERATURE.text, TEMPERATURES))}")
    for scene in given.scenes:
        compared(scene, coarse, fine)
        if given.cost:
            cost(scene, fine)


if __name__ == "__main__":
    main()

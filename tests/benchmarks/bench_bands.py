"""How often the modes of a fine map lie in the bands that a coarse map of the same bearing states.

Run: python -m tests.benchmarks.bench_bands COARSE.nc FINE.nc SCENE [SCENE ...] [--cost]

Each scene is linearised with both maps at all of `SPEEDS` within the coarse one, and `TEMPERATURES` held at its ends.
Modes of the one are those of the other with the most alike shape (mass-weighted MAC of at least `LEAST_LIKENESS`).
Counted are modes that oscillate, below `HIGHEST`, with at least `LEAST_SHARE` of their strain energy in bearings. A
difference is covered where it is at most the band of the coarse map; beside it that of the fine one is added, which is
wrong too. Told is the share that is covered, of frequencies and of damping ratios, and how large the differences are as
parts of the band: a band that covers all, and of which differences are a thousandth, is of no use either. The same for
k and c of the bearings along their load. With --cost also what the bands cost, as ratios of processor times.

Run: python -m tests.benchmarks.bench_bands --exact [--machine NAME ...] [--oil NAME ...] [--random SEED]

Modes with films of the table beside those of films by the film solver itself, at their own complex frequency
(`tests.cases.exact_films`), for `MACHINES`, `OILS`, `RPM_OF` and `CLEARANCES`: how often the band covers what is true,
and the band of the map alone, without what films with memory leave out. Rollers are massless, and the loads of the
slices are those of the equilibrium of the table for both: so the part of the film offset is not tested. With --random
speed and clearance are drawn between the ends of these instead, two for each machine and oil.
"""

from __future__ import annotations

import argparse
import dataclasses
import time
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.units import RPM, TEMPERATURE
from mbs.analyses.lsa import lsa
from mbs.analyses.modes import modes as modes_of_model
from mbs.analyses.sweep import SweepSettings, sweep
from mbs.bearings.bearing_element import BearingElement
from mbs.bearings.roller_element import RollerElement
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
from tests.cases.exact_films import ExactFilms, ExactMachine

SPEEDS = tuple(rpm / RPM.factor for rpm in (500.0, 1000.0, 1500.0, 2000.0, 2500.0))
TEMPERATURES = tuple(celsius + 273.15 for celsius in (35.0, 40.0, 55.0, 65.0))
MACHINES = ("nu308_rigid", "n1014_rigid", "gearbox", "nu2210_shaft")
"""Scenes; the geometry of NU2210 is estimated from the catalogue."""

OILS = {
    "FVA3": Lubricant.named("FVA3"),
    "VG 32": Lubricant.roelands(viscosity=0.032, pressure_viscosity=18e-9, density=865.0),
    "VG 320": Lubricant.roelands(viscosity=0.32, pressure_viscosity=26e-9, density=895.0),
    "PAO": Lubricant.roelands(viscosity=0.031, pressure_viscosity=13e-9, density=830.0),
}
"""At the temperature of each scene."""

RPM_OF, CLEARANCES = (300.0, 1500.0, 6000.0), (0.0, 20e-6, 60e-6)

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


class Beside(NamedTuple):
    """A mode beside the true one: differences, bands, and parts of the bands by films; frequency, damping ratio."""

    true: FloatArray
    difference: FloatArray
    bands: FloatArray
    by_films: FloatArray


def beside_exact(
    scene: str, oil: Lubricant, rpm: float, clearance: float, known: dict[tuple[float, float], ExactFilms]
) -> Iterator[Beside | None]:
    """The modes of a machine beside those with exact films; None for a mode that has none."""
    read = read_scene(scene)
    massless = read.with_bearings(
        dataclasses.replace(entry, rollers_as_bodies=False, centrifugal=False) for entry in read.bearings
    )
    speed = rpm / RPM.factor
    model = assemble(dataclasses.replace(massless, lubricant=oil, speed=speed), "table", None, clearance)
    balance, found = analysed(model, speed)
    bands = found.bands
    assert bands is not None
    share = found.shares[[found.parts.index(entry.name) for entry in model.bearings]].sum(axis=0)
    exact = ExactMachine(balance, oil, known)
    for k in np.flatnonzero((found.eigenvalues.imag > 0.0) & (share >= LEAST_SHARE) & (found.frequency < HIGHEST)):
        true = exact.mode(complex(found.eigenvalues[k]), found.shapes[:, k])
        if true is None or true[0].imag <= 0.0:
            yield None
            continue
        size = abs(true[0])
        values = np.array([size / (2.0 * np.pi), -true[0].real / size])
        ours = np.array([found.frequency[k], found.damping_ratio[k]])
        yield Beside(values, ours - values, np.array([part[k] for part in bands[:2]]), bands.by_films[:, k])


def exact_line(words: str, modes_beside: Sequence[Beside | None]) -> None:
    """A line on how many modes are covered, of frequencies and of damping ratios."""
    there = [entry for entry in modes_beside if entry is not None]
    line = f"{words:28}{len(there):6d}{len(modes_beside) - len(there):5d}"
    for place in range(2) if there else ():
        true, wrong, band, films = (
            np.array([getattr(entry, name)[place] for entry in there])
            for name in ("true", "difference", "bands", "by_films")
        )
        wrong = np.maximum(np.abs(wrong), 1e-12 * np.abs(true))
        parts = 100.0 * np.mean(wrong <= band), 100.0 * np.mean(wrong <= band - films)
        middle, most = 100.0 * np.quantile(wrong / np.abs(true), [0.5, 0.95])
        line += f"   |{parts[0]:6.1f}{parts[1]:7.1f}{np.median(band / wrong):8.2g}{middle:8.2g}{most:7.2g}"
    print(line, flush=True)


def exactly(machines: Sequence[str], oils: Sequence[str], seed: int | None) -> None:
    """Print what is covered beside exact films."""
    head = "   |covered  map  st/true  true %   95 %"
    print(f"{'machine, oil':28}{'modes':>6}{'none':>5}{head}{head}\n{'':39}   |frequency{'':32}|damping ratio")
    rng = np.random.default_rng(seed)
    every: list[Beside | None] = []
    films: dict[tuple[str, str], dict[tuple[float, float], ExactFilms]] = {}
    for machine in machines:
        for oil in oils:
            cases = [(rpm, clearance) for rpm in RPM_OF for clearance in CLEARANCES]
            if seed is not None:
                drawn = rng.uniform(size=(2, 2))
                cases = [
                    (RPM_OF[0] * (RPM_OF[-1] / RPM_OF[0]) ** float(x), CLEARANCES[-1] * float(y)) for x, y in drawn
                ]
            known = films.setdefault((machine, oil), {})
            rows = [one for case in cases for one in beside_exact(machine, OILS[oil], *case, known)]
            exact_line(f"{machine}, {oil}", rows)
            every += rows
    exact_line("all", every)


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
    parser.add_argument("coarse", nargs="?")
    parser.add_argument("fine", nargs="?")
    parser.add_argument("scenes", nargs="*")
    parser.add_argument("--cost", action="store_true")
    parser.add_argument("--exact", action="store_true")
    parser.add_argument("--machine", action="append", choices=MACHINES)
    parser.add_argument("--oil", action="append", choices=OILS)
    parser.add_argument("--random", type=int)
    given = parser.parse_args()
    if given.exact:
        with threadpool_limits(1):
            exactly(given.machine or MACHINES, given.oil or tuple(OILS), given.random)
        return
    coarse, fine = open_map(given.coarse), open_map(given.fine)
    print(f"coarse: {coarse.law_errors.words}")
    print(f"speeds {', '.join(map(RPM.text, SPEEDS))}; temperatures {', '.join(map(TEMPERATURE.text, TEMPERATURES))}")
    for scene in given.scenes:
        compared(scene, coarse, fine)
        if given.cost:
            cost(scene, fine)


if __name__ == "__main__":
    main()

"""How reliable the criteria of physics are: their verdicts beside laws with and without the physics, at random.

    python -m tests.benchmarks.bench_auto_criteria nu308.nc [--contacts 400] [--seed 1]

For each criterion of `mbs.planning.criteria`, at tolerances of 5 % and of 1 dB (12 %): a roller at a random load, speed
and temperature (log-uniform, log-uniform, uniform; within the map), frequency (100 Hz to 10 kHz), oil layer and
roughness. Full: k + i omega c of the law of the map with and without memory, k and c with and without the layer, with
and without roughness; the verdict is that of the worse contact.

hit: it is said to matter, and does. rejected: it is not, and does not. false alarm: it is, and does not. miss: it is
not, and does; "worst miss" is by how much it did. Layers are 0.5 to 20 um, roughness is 0.05 to 0.8 um.

Heat in the inlet stands beside solutions of a thermal solver that is no part of this package (inner contact of NU308,
FVA 3, Newtonian but for the one marked in the source; three points of rollers at 35 N/mm), to which its rule is fitted.
The other criteria are closed forms without a number that was fitted to any of these cases.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from ehdmaps.maps.emap import EHDMap, open_map
from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.physics.surface import Surface
from mbs.bearings.slices_in_balance import relaxation_times
from mbs.planning.criteria import (
    TOUCHING,
    closed_contact,
    heat_effect,
    memory_effect,
    supply_effect,
)

TOLERANCES = (0.05, 10.0 ** (1.0 / 20.0) - 1.0)
LAYERS = (0.5e-6, 1e-6, 2e-6, 5e-6, 10e-6, 20e-6)
ROUGH = (0.05e-6, 0.1e-6, 0.2e-6, 0.4e-6, 0.8e-6)
CLEARANCES = (0.0, 10e-6, 30e-6, 60e-6)
FREQUENCIES = (100.0, 1e4)
BEARING_LOADS = (200.0, 1e4)

THERMAL = (
    # N/mm, m/s, degC, c over that of the isothermal contact; 50 N/mm at 2 m/s and 20 degC with Eyring's stress
    (5, 0.2, 20, 0.998), (50, 0.2, 20, 0.989), (200, 0.2, 20, 0.989), (5, 2, 20, 1.021), (50, 2, 20, 0.768),
    (200, 2, 20, 0.770), (5, 2, 60, 0.992), (50, 2, 60, 0.965), (200, 2, 60, 0.957), (5, 10, 60, 0.993),
    (50, 10, 60, 0.776), (200, 10, 60, 0.665), (5, 10, 100, 0.991), (50, 10, 100, 0.903), (200, 10, 100, 0.874),
    (35, 0.8251, 40, 0.979), (35, 2.4753, 40, 0.914), (35, 4.1255, 40, 0.793),
)  # fmt: skip


class Compared(NamedTuple):
    """One case: the size by the criterion, over which it switches on, and the full change of k or c, as a part."""

    size: float
    limit: float
    full: float


class Laws(NamedTuple):
    """Laws of a roller: plain, on each layer, with each roughness."""

    plain: ContactLaw
    layers: dict[float, ContactLaw]
    rough: dict[float, ContactLaw]


def laws_of(emap: EHDMap) -> Laws:
    """All laws of a map."""
    return Laws(
        emap.law("series", outside="clamp"),
        {layer: emap.law("series", outside="clamp", supply=OilSupply(layer)) for layer in LAYERS},
        {rq: emap.law("series", outside="clamp", surface=Surface(rq)) for rq in ROUGH},
    )


def at_load(law: ContactLaw, load: float, speed: float, temperature: float) -> tuple[float, float, float]:
    """Approach [m], k [N/m2] and c [N s/m2] of a law at a load per length."""
    at = law.at(speed, temperature)
    approach = brentq(lambda delta: float(at(delta, 0.0)[0]) - load, -5e-3, 3e-4, xtol=1e-14)
    _, k, c = (float(part) for part in at(approach, 0.0))
    return approach, k, c


def larger_change(plain: Sequence[float], other: Sequence[float]) -> float:
    """The largest change of some numbers, as a part."""
    return max(abs(b / a - 1.0) for a, b in zip(plain, other, strict=True))


def contact_cases(emap: EHDMap, made: Laws, count: int, rng: np.random.Generator) -> dict[str, list[Compared]]:
    """Rollers at random points of the map."""
    found: dict[str, list[Compared]] = {"film memory": [], "oil supply": [], "roughness": []}
    law = made.plain
    for _ in range(count):
        load, speed = (float(np.exp(rng.uniform(*np.log(ends)))) for ends in (law.load_range, law.speed_range))
        temperature = float(rng.uniform(*law.temperature_range))
        frequency = float(np.exp(rng.uniform(*np.log(FREQUENCIES))))
        layer, rq = float(rng.choice(LAYERS)), float(rng.choice(ROUGH))
        closed = [
            closed_contact(contact, emap.lubricant, np.array([load]), speed, temperature) for contact in emap.contacts
        ]
        approach, k, c = at_load(law, load, speed, temperature)
        theta = float(relaxation_times(law.at(speed, temperature), np.array([approach]))[0])
        omega = 2.0 * math.pi * frequency
        followed = k + 1j * omega * c / (1.0 + 1j * omega * theta)
        size = max(float(memory_effect(state, frequency)[0]) for state in closed)
        found["film memory"].append(Compared(size, math.nan, abs(k + 1j * omega * c - followed) / abs(followed)))
        size = max(float(supply_effect(state, layer)[0]) for state in closed)
        full = larger_change((k, c), at_load(made.layers[layer], load, speed, temperature)[1:])
        found["oil supply"].append(Compared(size, math.nan, full))
        size = min(float(state.minimum_film[0] / rq) for state in closed)
        full = larger_change((k, c), at_load(made.rough[rq], load, speed, temperature)[1:])
        found["roughness"].append(Compared(-size, -TOUCHING, full))
    return found


def thermal_cases(contact: LineContact) -> list[Compared]:
    """Inlet heating of the inner contact, beside thermal solutions."""
    oil = Lubricant.named("FVA3")
    found = []
    for load, speed, celsius, ratio in THERMAL:
        state = closed_contact(contact, oil, np.array([1e3 * load]), float(speed), celsius + 273.15)
        found.append(Compared(float(heat_effect(state, oil)[1][0]), math.nan, abs(ratio - 1.0)))
    return found


def line(name: str, cases: Sequence[Compared], tolerance: float) -> str:
    """A row of the table."""
    on = np.array([case.size > (tolerance if math.isnan(case.limit) else case.limit) for case in cases])
    matters = np.array([case.full > tolerance for case in cases])
    missed = [case.full for case, off, much in zip(cases, ~on, matters, strict=True) if off and much]
    counts = [np.count_nonzero(both) for both in (on & matters, ~on & ~matters, on & ~matters, ~on & matters)]
    hit, rejected, alarm, miss = (int(count) for count in counts)
    worst = f"{100.0 * max(missed):9.2g} %" if missed else "          -"
    return f"{name:14s} {100.0 * tolerance:9.3g} % {len(cases):6d} {hit:6d} {rejected:9d} {alarm:12d} {miss:6d} {worst}"


def main() -> None:
    """Draw the cases, and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("map")
    parser.add_argument("--contacts", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    emap = open_map(asked.map)
    made, rng = laws_of(emap), np.random.default_rng(asked.seed)
    tables = {
        "contacts": contact_cases(emap, made, asked.contacts, rng),
        "contacts, beside thermal solutions": {"inlet heat": thermal_cases(emap.contacts[0])},
    }
    print(f"seed {asked.seed}")
    for title, table in tables.items():
        print(f"{title}\n{'':14s} {'tolerance':>11s} {'cases':>6s} {'hit':>6s} {'rejected':>9s} {'false alarm':>12s} "
              f"{'miss':>6s} {'worst miss':>11s}")  # fmt: skip
        for name, cases in table.items():
            for tolerance in TOLERANCES:
                print(line(name, cases, tolerance))


if __name__ == "__main__":
    main()

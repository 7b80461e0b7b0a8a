"""Rollers as bodies beside massless rollers, in the gearbox: modes, whether rollers follow, and run-ups.

Run: python -m tests.benchmarks.bench_rollers MAP.nc [--run-up [--begin 0] [--duration 2.5]]

Modes are those of films with memory, each at its own complex frequency. `light` are rollers as bodies of a hundredth
of their mass: they differ from massless ones by the model alone, in which the slices of a roller balance as a whole and
not each for itself. `centrifugal` are rollers of their full mass with their centrifugal load, which massless rollers
with memory do not have. A mode is the one whose shape is nearest in the coordinates of the machine.

Rollers that follow: what a roller moves by for what it would move by without mass, between rings that move as they
please, (Z_i + Z_o)/(Z_i + Z_o - m omega^2) with the dynamic stiffness of both contacts; 1 for a roller without mass.

--run-up: a part of the ramp of the scene in time instead, with films with memory. Differences of the level of S1 from
that with massless rollers, in windows of 50 ms and bands: median, 5 %, 95 %, least, largest. `start moved` begins 10 nm
aside: so far windows may differ without a reason. A step is processor time on one core.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import time
from dataclasses import dataclass

import numpy as np

import ehdmaps
from ehdmaps.maps.emap import EHDMap
from mbs.bearings.roller_element import RollerElement
from mbs.linearised.dynamic import element_dynamic_stiffness
from mbs.linearised.modes import Modes, modes
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.model.profiles import Course, SpeedProfile
from mbs.model.system import System
from mbs.scene.assembly import assemble
from mbs.scene.reader import read_scene
from mbs.scene.scene import Scene
from mbs.spectral.levels import level
from mbs.spectral.run_signal import RunSignal
from mbs.spectral.spectra import short_time_spectra
from mbs.transient.run import Recording, run

RPM = math.pi / 30.0
SPEEDS = (500.0, 1500.0, 2500.0)
LIGHT = 1e-2
FREQUENCIES = (500.0, 1000.0, 2500.0, 4000.0)
ALONG = (2.4e3, 4e3)
"""Where the modes along the load lie [Hz]."""

SHARE = 0.25
"""Part of the strain energy that bearings have in the modes that are shown."""


WINDOW = 0.05
BANDS = ((200.0, 5e3), (200.0, 1e3), (1e3, 2.4e3), (2.4e3, 5e3))
"""The first is that of the sum level [Hz]."""

FORGOTTEN = 0.1
"""What is left out at the beginning [s]."""


@dataclass(frozen=True)
class Rollers:
    """What the rollers are: massless or bodies, with what part of their mass, with centrifugal load; a start aside."""

    name: str
    bodies: bool = True
    mass: float = 1.0
    centrifugal: bool = False
    nudge: float = 0.0


MASSLESS = Rollers("massless", bodies=False)
BODIES = Rollers("bodies")
CENTRIFUGAL = Rollers("centrifugal", centrifugal=True)
VARIANTS = (MASSLESS, Rollers("light", mass=LIGHT), BODIES, CENTRIFUGAL)
RUNS = (MASSLESS, Rollers("start moved", bodies=False, nudge=1e-8), BODIES, CENTRIFUGAL)


def scene_of(base: Scene, rollers: Rollers) -> Scene:
    """The scene with such rollers."""
    return base.with_bearings(
        dataclasses.replace(entry, rollers_as_bodies=rollers.bodies, centrifugal=rollers.centrifugal)
        for entry in base.bearings
    )


def system_of(base: Scene, emap: EHDMap, rollers: Rollers) -> System:
    """The system with such rollers, and films with memory."""
    system = assemble(scene_of(base, rollers), None, emap, films="memory").system
    for entry in base.bearings if rollers.bodies else ():
        rows = system.own(f"{entry.name}_rollers")
        system.mass[rows, rows] *= rollers.mass
    return system


@dataclass(frozen=True, eq=False)
class Found:
    """Modes of a system at a speed, and its equilibrium."""

    balance: Equilibrium
    modes: Modes

    @property
    def bearings(self) -> np.ndarray:
        """Part of the strain energy of each mode that the bearings have."""
        rows = [i for i, part in enumerate(self.modes.parts) if part.startswith("bearing")]
        return np.asarray(self.modes.shares[rows].sum(axis=0))

    def nearest(self, other: Found, k: int) -> tuple[int, float]:
        """Mode that is nearest to a mode k of another system with the same machine, and their MAC."""
        n = min(self.balance.system.size, other.balance.system.size)
        mass = other.balance.system.mass[:n, :n]
        shapes, shape = self.modes.shapes[:n], other.modes.shapes[:n, k]
        seen = mass @ shape.conj()
        sizes = np.sum(shapes.conj() * (mass @ shapes), axis=0).real
        mac = np.abs(seen @ shapes) ** 2 / sizes / float((seen @ shape).real)
        # Modes of rollers alone have hardly a shape in the machine, but perhaps the same one.
        near = np.abs(np.log(self.modes.frequency / other.modes.frequency[k])) < 0.1
        best = int(np.argmax(np.where(near & (self.modes.damping_ratio < 0.4), mac, 0.0)))
        return best, float(mac[best])


def found_modes(base: Scene, emap: EHDMap, rollers: Rollers, speed: float) -> Found:
    """Modes with such rollers at a speed [rpm]."""
    balance = equilibrium(system_of(base, emap, rollers), Operation(speed * RPM))
    return Found(balance, modes(balance))


def modes_table(speed: float, found: dict[str, Found]) -> None:
    """Frequencies and damping ratios, and what changes against massless rollers."""
    plain = found[MASSLESS.name]
    others = [name for name in found if name != MASSLESS.name]
    print(f"\n{speed:.0f} rpm: f [Hz], zeta [%] of modes with more than {SHARE:.0%} of their strain energy in bearings")
    print(f"{'massless':>16} " + "".join(f"{name + ': change of f, zeta [%], MAC':>44}" for name in others))
    worst = dict.fromkeys(others, 0.0)
    for k in np.flatnonzero((plain.bearings > SHARE) & (plain.modes.frequency < 5e3)):
        f, zeta = plain.modes.frequency[k], plain.modes.damping_ratio[k]
        text = f"{f:8.0f} {100 * zeta:6.2f}  "
        for name in others:
            best, mac = found[name].nearest(plain, int(k))
            other_f, other_zeta = found[name].modes.frequency[best], found[name].modes.damping_ratio[best]
            change = 100.0 * (other_zeta / zeta - 1.0)
            if ALONG[0] < f < ALONG[1]:
                worst[name] = max(worst[name], abs(change))
            row = f"{other_f:8.0f} {100 * other_zeta:6.2f} {100 * (other_f / f - 1):+6.2f} {change:+6.1f} {mac:6.3f}"
            text += f"{row:>44}"
        print(text)
    print(
        f"largest change of zeta from {ALONG[0] / 1e3:g} to {ALONG[1] / 1e3:g} kHz: "
        + ", ".join(f"{name} {value:.1f} %" for name, value in worst.items())
    )


def following_table(speed: float, found: Found) -> None:
    """How far the rollers of the first bearing follow."""
    balance = found.balance
    index = next(i for i, one in enumerate(balance.system.elements) if one.element.name == "bearing_1_left")
    element = balance.system.elements[index].element
    assert isinstance(element, RollerElement)
    count, mass = element.plain.bearing.geometry.rollers, element.plain.bearing.roller_mass
    place = balance.system.elements[index].transform @ balance.displacement
    loads = element.plain.loads(place[:6] - place[6:12], balance.operation).load
    s = 2j * math.pi * np.array(FREQUENCIES)
    rollers = np.arange(12, 12 + count)
    both = element_dynamic_stiffness(balance, index, s)[:, rollers, rollers]
    follows = both / (both + mass * (s**2)[:, None])
    print(f"{speed:.0f} rpm, rollers of bearing_1_left ({1e3 * mass:.1f} g): what they move by, for 1 without mass")
    print(f"{'load N':>10}" + "".join(f"{f / 1e3:>9g} kHz" for f in FREQUENCIES))
    for j in np.argsort(-loads):
        print(f"{loads[j]:10.2f}" + "".join(f"{abs(z):7.2f} {np.degrees(np.angle(z)):+5.0f}" for z in follows[:, j]))


def run_up(base: Scene, emap: EHDMap, rollers: Rollers, duration: float, begin: float = 0.0) -> tuple[Recording, float]:
    """A part of the ramp of the scene with such rollers, and the processor time of a step [s]."""
    ramp = base.run_up
    assert ramp is not None
    first, last = (ramp.speed.at(at)[0] for at in (begin, begin + duration))
    speed = SpeedProfile(Course((0.0, duration), (first, last)))
    system = system_of(base, emap, rollers)
    sensor = next(sensor for sensor in base.sensors if sensor.name == "S1")
    start = equilibrium(system, Operation(first)).displacement
    start[: rollers_begin(system)] += rollers.nudge
    run(system, speed, 10.0 * ramp.settings.sample, ramp.settings, [sensor], start)  # what is made once
    clock = time.process_time()
    found = run(system, speed, duration, ramp.settings, [sensor], start)
    return found, (time.process_time() - clock) / found.steps


def rollers_begin(system: System) -> int:
    """Number of coordinates of the machine, which come before those of rollers."""
    return sum(body.size for body in system.bodies if not body.name.endswith("_rollers"))


def levels(record: Recording) -> np.ndarray:
    """Level of S1 in each window and band [dB], shape (bands, windows)."""
    found = RunSignal(record.time, record.speed, record.angle, record.signals[:, 0])
    found = found.part(round(FORGOTTEN * found.rate), found.time.size)
    spectra = short_time_spectra(found, WINDOW, BANDS[0])
    line, rows = float(spectra.frequencies[1] - spectra.frequencies[0]), []
    for low, high in BANDS:
        inside = (spectra.frequencies >= low) & (spectra.frequencies < high)
        rows.append(level(spectra.power[:, inside].sum(axis=1) * line / spectra.noise_bandwidth, 1e-6))
    return np.array(rows)


def run_table(base: Scene, emap: EHDMap, duration: float, begin: float) -> None:
    """Print the differences of run-ups."""
    print(f"run-up from {begin:g} s on, {duration:g} s; S1, level less that with massless rollers [dB]:")
    print("median, 5 %, 95 %, least, largest of windows")
    heads = "".join(f"{f'{low:g} to {high:g} Hz':>34}" for low, high in BANDS)
    print(f"{'':14}{'us a step':>10}{'Newton':>8}{heads}")
    plain = None
    for rollers in RUNS:
        record, step = run_up(base, emap, rollers, duration, begin)
        found = levels(record)
        plain = found if plain is None else plain
        cells = ""
        for row in found - plain:
            numbers = (np.median(row), *np.percentile(row, [5, 95]), row.min(), row.max())
            cells += f"{' '.join(f'{number:+.2f}' for number in numbers):>34}"
        print(f"{rollers.name:14}{1e6 * step:10.1f}{record.iterations / record.steps:8.2f}{cells}", flush=True)
    assert plain is not None
    print(f"highest sum level with massless rollers: {plain[0].max():.1f} dB")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description="Rollers as bodies beside massless rollers in the gearbox.")
    parser.add_argument("map", help="Reynolds map of the NU308, by `ehdmaps generate nu308`")
    parser.add_argument("--run-up", action="store_true", help="the ramp in time, a minute a second")
    parser.add_argument("--begin", type=float, default=0.0, help="where on the ramp the run begins [s]")
    parser.add_argument("--duration", type=float, default=2.5, help="how long it is [s]")
    given = parser.parse_args()
    base, emap = read_scene("gearbox"), ehdmaps.open_map(given.map)
    if given.run_up:
        run_table(base, emap, given.duration, given.begin)
        return
    for speed in SPEEDS:
        found = {rollers.name: found_modes(base, emap, rollers, speed) for rollers in VARIANTS}
        modes_table(speed, found)
        following_table(speed, found[BODIES.name])


if __name__ == "__main__":
    main()

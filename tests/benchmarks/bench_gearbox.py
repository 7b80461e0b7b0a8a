"""Run-ups of the shipped gearbox: their cost beside their error, over step, slices, damping of the method and modes.

Run: python -m tests.benchmarks.bench_gearbox MAP.nc [--duration 0.5 | --whole] [--housing FILE.nc] [--films KIND]

The ramp is that of the scene, 400 rpm each second: a piece of it around 1500 rpm, or with --whole all of its 5 s with
fewer rows. Each row is one run beside another that differs by what the table is about. Its columns:

us a step, CPU, wall    what a step took on one core; seconds for 5 s of run-up, of the processor and of the clock
Newton                  iterations a step
signal                  root mean square of the difference of S1 as a part of the signal, both below 1, 2.5, 5 kHz
dB                      differences of the level of S1 in third octaves, median and largest of all windows of 50 ms in
                        bands from 200 Hz to 1 kHz, to 2.5 kHz, to 5 kHz, which lie up to 30 dB below the sum level
sum                     of the sum level over speed, 200 Hz to 5 kHz: median and largest
mean                    of third octaves as means over the whole piece: median and largest

The first fifth of a piece is left out: there the machine forgets how it was started. Signals are limited to their band
and then sampled each 40 us; `sampling` shows what it costs to leave that out. Where motion is chaotic, runs that begin
a little apart stay apart; `start moved` shows whether they do. Signals and single windows of such runs cannot be
compared, only `mean`, and that no finer than in this row.

With --waits instead: what a step costs from rest on, where films fade, beside a step with whole films; the steps that
ran in compiled code; and the largest difference of the bearing forces from steps in Python over the first ones.
"""

from __future__ import annotations

import argparse
import dataclasses
import functools
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import get_args

import numpy as np
import scipy.linalg
from scipy.signal import butter, resample_poly, sosfiltfilt

import ehdmaps
from ehdmaps.maps.emap import EHDMap
from mbs.linearised.modes import undamped_modes
from mbs.model.body import Body, Frame
from mbs.model.elements import Operation, Sensor
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import Course, SpeedProfile
from mbs.model.relaxation import DEFAULT_FILMS, Films
from mbs.model.system import System
from mbs.scene.assembly import Model, assemble, build_bodies
from mbs.scene.reader import parse_scene, read_scene
from mbs.scene.scene import Scene
from mbs.settings import RunUp, Settings
from mbs.spectral.levels import Reference, level
from mbs.spectral.run_signal import RunSignal
from mbs.spectral.spectra import short_time_spectra
from mbs.transient.run import Options, Recording, run

RPM = math.pi / 30.0
MIDDLE = 1500.0 * RPM
SAMPLE, COMMON = 1e-5, 4e-5
WINDOW = 0.05
HIGHEST = 5e3
EDGES = np.minimum(1e3 * 2.0 ** ((np.arange(-7, 8) - 0.5) / 3.0), HIGHEST)
"""Of third octaves, from that of 200 Hz on."""
GROUPS = (1.2e3, 2.9e3, HIGHEST)
"""Ends of the groups of third octaves: the edges above 1 kHz, 2.5 kHz and 5 kHz."""
HEARD = 30.0
FORGOTTEN = 0.2
SHORTEST, LONGEST = 0.2, 2.0


@dataclass(frozen=True)
class Variant:
    """How a run is made: step [s], cut-offs [Hz], and by how much the start is moved [m or rad]."""

    law: str
    step: float = 1e-5
    slices: int = 21
    radius: float = 0.9
    housing: float = 8e3
    shafts: float = 8e3
    nudge: float = 0.0
    residual: float = 1e-10


@dataclass(frozen=True, eq=False)
class Made:
    """A run and what it cost [s]."""

    record: Recording
    processor: float
    clock: float
    size: int


def truncated(body: Body, cutoff: float) -> Body:
    """A reduced body without the modes, interfaces held, above a frequency: rows and columns are left out."""
    high = np.array([name.startswith("mode ") for name in body.coordinates])
    keep = np.flatnonzero(~high | (np.diag(body.stiffness) <= (2.0 * math.pi * cutoff) ** 2))
    square = np.ix_(keep, keep)
    return dataclasses.replace(
        body,
        coordinates=tuple(body.coordinates[k] for k in keep),
        units=tuple(body.units[k] for k in keep),
        mass=body.mass[square],
        gyroscopic=body.gyroscopic[square],
        damping=body.damping[square],
        stiffness=body.stiffness[square],
        frames={name: Frame(frame.position, frame.transform[:, keep]) for name, frame in body.frames.items()},
    )


@dataclass(frozen=True, eq=False)
class Bench:
    """The scene, the map, which part of the ramp is run, and a housing with more modes if there is one."""

    scene: Scene
    emap: EHDMap
    duration: float
    whole: bool
    housing: str | None
    films: Films

    @property
    def ramp(self) -> RunUp:
        """Of the scene."""
        assert self.scene.run_up is not None
        return self.scene.run_up

    @property
    def speed(self) -> SpeedProfile:
        """The whole ramp, or the piece around the middle speed."""
        begin, end = (self.ramp.speed.at(at)[0] for at in (0.0, self.ramp.duration))
        if self.whole:
            return self.ramp.speed
        half = 0.5 * (end - begin) / self.ramp.duration * self.duration
        return SpeedProfile(Course((0.0, self.duration), (MIDDLE - half, MIDDLE + half)))

    @property
    def sensor(self) -> Sensor:
        """S1."""
        return next(sensor for sensor in self.scene.sensors if sensor.name == "S1")

    def model(self, variant: Variant) -> Model:
        """The gearbox of a variant."""
        text = self.scene.text.replace('cutoff = "8 kHz"', f'cutoff = "{variant.shafts} Hz"')
        if self.housing:
            text = text.replace("gearbox_housing.nc", str(Path(self.housing).resolve()))
        scene = parse_scene(text, self.scene.name, self.scene.name)
        scene = scene.with_bearings(dataclasses.replace(entry, slices=variant.slices) for entry in scene.bearings)
        bodies = [truncated(body, variant.housing) for body in build_bodies(scene.bodies)]
        films = self.films if variant.law == "map" else None
        return assemble(dataclasses.replace(scene, bodies=bodies), variant.law, self.emap, films=films)

    @functools.cache  # noqa: B019 - one bench a process
    def made(self, variant: Variant) -> Made:
        """Run a variant, once."""
        system, speed = self.model(variant).system, self.speed
        start = equilibrium(system, Operation(speed.at(0.0)[0])).displacement + variant.nudge
        sample = max(variant.step, SAMPLE)
        settings = Settings(variant.step, sample, variant.radius, residual=variant.residual)
        run(system, speed, 10.0 * sample, settings, [self.sensor], start)  # what is made once
        processor, clock = time.process_time(), time.perf_counter()
        record = run(system, speed, self.duration, settings, [self.sensor], start)
        return Made(record, time.process_time() - processor, time.perf_counter() - clock, system.size)


def signal(record: Recording) -> RunSignal:
    """The sensor, limited to its band and sampled each 40 us; without the beginning."""
    every = round(COMMON / float(record.time[1] - record.time[0]))
    values = record.signals[:, 0]
    limited = resample_poly(values, 1, every)[: (values.size - 1) // every + 1] if every > 1 else values
    return _late(RunSignal(record.time[::every], record.speed[::every], record.angle[::every], limited))


def picked(record: Recording, sample: float) -> RunSignal:
    """The sensor with samples left out and nothing done against aliasing."""
    every = round(sample / float(record.time[1] - record.time[0]))
    return _late(
        RunSignal(*(part[::every] for part in (record.time, record.speed, record.angle, record.signals[:, 0])))
    )


def _late(found: RunSignal) -> RunSignal:
    """Without the beginning."""
    return found.part(round(min(FORGOTTEN * found.duration, FORGOTTEN) * found.rate), found.time.size)


def signal_errors(first: RunSignal, second: RunSignal) -> list[float]:
    """Relative difference below each of the frequencies."""
    found = []
    for highest in (1e3, 2.5e3, 5e3):
        sos = butter(6, highest, fs=first.rate, output="sos")
        a, b = (sosfiltfilt(sos, each.signal)[250:-250] for each in (first, second))  # 10 ms: ends of the filter
        found.append(float(np.linalg.norm(a - b) / np.linalg.norm(b - b.mean())))
    return found


def third_octaves(found: RunSignal) -> np.ndarray:
    """Mean squares, shape (windows, bands)."""
    spectra = short_time_spectra(found, WINDOW, (float(EDGES[0]), HIGHEST))
    line = float(spectra.frequencies[1] - spectra.frequencies[0])
    band = np.digitize(spectra.frequencies, EDGES[1:-1])
    sums = [spectra.power[:, band == k].sum(axis=1) for k in range(EDGES.size - 1)]
    return np.stack(sums, axis=1) * line / spectra.noise_bandwidth


def level_differences(first: RunSignal, second: RunSignal) -> list[np.ndarray]:
    """Absolute differences [dB]: of third octaves by group, of the sum level, and of third octaves over the piece."""
    powers = [third_octaves(each) for each in (first, second)]
    group = np.searchsorted(GROUPS, EDGES[1:] * (1.0 - 1e-9))
    change, heard, sums = _bands(*powers)
    means = _bands(*(power.mean(axis=0, keepdims=True) for power in powers))
    return [*(change[heard & (group == k)[None, :]] for k in range(len(GROUPS))), sums, means[0][means[1]]]


def _bands(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Differences of the bands, which bands are heard, and differences of the sums."""
    bands = [level(power, 1e-6) for power in (first, second)]
    sums = [level(power.sum(axis=1), 1e-6) for power in (first, second)]
    return np.abs(bands[0] - bands[1]), bands[1] >= sums[1][:, None] - HEARD, np.abs(sums[0] - sums[1])


def _decibels(found: Sequence[np.ndarray]) -> str:
    """Median and largest of each."""
    return "  ".join(f"{np.median(part):5.2f} {part.max():5.2f}" if part.size else "    -     -" for part in found)


HEAD = (
    f"{'':22} {'us/step':>8} {'CPU 5 s':>8} {'wall':>6} {'Newton':>7}   {'signal 1':>8} {'2.5':>8} {'5 kHz':>8}   "
    f"{'dB to 1k':>11}  {'to 2.5k':>11}  {'to 5k':>11}  {'sum':>11}  {'mean':>11}"
)


def row(bench: Bench, label: str, variant: Variant, against: Variant) -> None:
    """Print a row."""
    made, other = bench.made(variant), bench.made(against)
    a, b = signal(made.record), signal(other.record)
    steps, whole = made.record.steps, bench.ramp.duration / bench.duration
    errors = " ".join(f"{100.0 * error:7.3g}%" for error in signal_errors(a, b))
    print(
        f"{label:22} {1e6 * made.processor / steps:8.1f} {made.processor * whole:8.1f} {made.clock * whole:6.1f} "
        f"{made.record.iterations / steps:7.2f}   {errors:>26}   {_decibels(level_differences(a, b))}",
        flush=True,
    )


def separation(bench: Bench, variant: Variant) -> str:
    """How much of the time the loaded flanks are apart, and the others touch."""
    forces = np.abs(bench.made(variant).record.forces[-1])
    loaded = int(np.argmax(forces.mean(axis=0)))
    apart, other = np.mean(forces[:, loaded] == 0.0), np.mean(forces[:, 1 - loaded] > 0.0)
    return f"loaded flanks apart {apart:.2%} of the time, the others touch {other:.2%}"


def run_tables(bench: Bench, law: str) -> None:
    """Step, slices, spectral radius and start, each alone; then as shipped beside the finest."""
    plain = Variant(law)
    # Steps of 2.5 us would take minutes over the whole ramp.
    finest = Variant(law, 5e-6 if bench.whole else 2.5e-6, 41)
    steps = (2e-5, 1e-5) if bench.whole else (4e-5, 2e-5, 1e-5, 5e-6)
    print(f"\nlaw {law}: {bench.made(plain).size} coordinates; {separation(bench, plain)}\n{HEAD}")
    row(bench, "shipped: 10 us, 21", plain, finest)
    row(bench, "start moved by 10 nm", dataclasses.replace(plain, nudge=1e-8), plain)
    print(f"step, beside {1e6 * finest.step:g} us (41 slices)")
    for step in steps:
        row(bench, f"  {1e6 * step:g} us", dataclasses.replace(finest, step=step), finest)
    if bench.whole:
        return
    print("slices, beside 81 (10 us)")
    for slices in (11, 21, 41):
        row(bench, f"  {slices} slices", Variant(law, slices=slices), Variant(law, slices=81))
    print(f"spectral radius, beside {1e6 * finest.step:g} us and 0.9 (10 us, 41 slices)")
    for radius in (0.6, 0.8, 0.9, 1.0):
        row(bench, f"  {radius}", Variant(law, slices=41, radius=radius), finest)
    print("what Newton leaves over, beside 1e-12 of the forces with the same step (21 slices)")
    for step in (2e-5, 1e-5):
        for residual in (1e-10, 1e-8, 1e-6):
            variant = Variant(law, step, residual=residual)
            row(bench, f"  {1e6 * step:g} us, {residual:g}", variant, dataclasses.replace(variant, residual=1e-12))


def sampling_table(bench: Bench, law: str) -> None:
    """Samples left out without a filter."""
    record = bench.made(Variant(law)).record
    print(f"\nlaw {law}: sampling without a filter beside a sample each step of 10 us, dB as above")
    for sample in (2e-5, 4e-5, 8e-5):
        found = level_differences(picked(record, sample), picked(record, SAMPLE))
        print(f"  each {1e6 * sample:g} us ({1e-3 / sample:g} kHz): {_decibels(found)}")


def table_error(bench: Bench, duration: float = 5e-3) -> None:
    """Compiled steps with blended tables beside steps in Python with the law at each speed."""
    system, speed = bench.model(Variant("map")).system, bench.speed
    start = equilibrium(system, Operation(speed.at(0.0)[0])).displacement
    settings = Settings(1e-5, SAMPLE, 0.9)
    begin, records = time.process_time(), []
    for compiled in (True, False):
        records.append(
            run(system, speed, duration, settings, [bench.sensor], start, options=Options(compiled=compiled))
        )
    spent = time.process_time() - begin
    a, b = (record.signals[:, 0] for record in records)
    print(
        f"\nblending of speed tables: compiled beside Python, {1e3 * duration:g} ms: largest difference of S1 "
        f"{np.abs(a - b).max() / np.std(b):.1e} of its standard deviation ({spent:.1f} s for both)"
    )


def period_rule(step: float, radius: float, frequency: float) -> float:
    """By how much a period is too long, by the rule that `mbs.transient.run` gives."""
    s = (1.0 - radius) / (1.0 + radius)
    return float((2.0 * math.pi * frequency * step) ** 2 * (1.0 / 12.0 + 0.375 * s**2))


def peak_table(bench: Bench) -> None:
    """Spectral peak of the housing alone, struck in its mode nearest to 5 kHz, beside that of a step of 0.5 us."""
    body = bench.model(Variant("hertz")).system.body("housing")
    values, shapes = scipy.linalg.eigh(body.stiffness, body.mass)
    nearest = int(np.argmin(np.abs(np.sqrt(values) - 2.0 * math.pi * HIGHEST)))
    frequency = float(np.sqrt(values[nearest])) / (2.0 * math.pi)
    system, still = System([body]), SpeedProfile(Course((0.0,), (0.0,)))

    def peak(step: float, radius: float) -> float:
        """Frequency of the highest line, of lines 0.1 Hz apart."""
        found = run(
            system, still, 0.012, Settings(step, COMMON, radius), [bench.sensor], velocity=1e-3 * shapes[:, nearest]
        )
        values = found.signals[:, 0] * np.hanning(found.time.size)
        size = round(10.0 / COMMON)
        return float(np.argmax(np.abs(np.fft.rfft(values, size)))) / (size * COMMON)

    exact = peak(5e-7, 0.9)
    print(f"\nperiod of a mode of {frequency:.0f} Hz (housing alone, damped by 1 %): too long by")
    print(f"  {'step us':>7} {'radius':>7} {'rule':>8} {'spectral peak':>14}")
    for step in (4e-5, 2e-5, 1e-5, 5e-6):
        for radius in (0.6, 0.8, 0.9, 1.0):
            rule, shift = period_rule(step, radius, frequency), exact / peak(step, radius) - 1.0
            print(f"  {1e6 * step:7g} {radius:7} {rule:8.3%} {shift:14.3%}")


def frequencies(bench: Bench, variant: Variant) -> np.ndarray:
    """Undamped natural frequencies up to 5 kHz at the middle speed [Hz], rising."""
    found = undamped_modes(equilibrium(bench.model(variant).system, Operation(MIDDLE))).frequency
    return np.sort(found[found <= 1.05 * HIGHEST])


def coordinates_table(bench: Bench, law: str) -> None:
    """Fewer modes of the housing, and more of the shafts."""
    most = 12e3 if bench.housing else 8e3
    full = Variant(law, housing=most)
    expected = frequencies(bench, full)
    expected = expected[expected <= HIGHEST]
    print(f"\nlaw {law}: cut-off of the housing beside {most / 1e3:g} kHz (10 us, 21 slices)\n{HEAD}")
    cases = [(f"housing {cutoff / 1e3:g} kHz", Variant(law, housing=cutoff)) for cutoff in (4e3, 5e3, 6e3, 8e3)]
    cases += [(f"shafts {cutoff / 1e3:g} kHz", dataclasses.replace(full, shafts=cutoff)) for cutoff in (2e4, 3e4)]
    shifts = []
    for label, variant in cases:
        row(bench, f"{label}: {bench.made(variant).size}", variant, full)
        found = frequencies(bench, variant)
        if found.size >= expected.size:
            change = found[: expected.size] / expected - 1.0
            below = [np.abs(change[expected <= end]) for end in (1e3, 2.5e3, HIGHEST)]
            text = "  ".join(f"{100 * part.max():.3f}% (median {100 * np.median(part):.3f}%)" for part in below)
        else:
            text = f"{expected.size - found.size} of {expected.size} are missing"
        shifts.append(f"  {label}: {text}")
    print("largest change of the natural frequencies up to 1, 2.5, 5 kHz, in rising order", *shifts, sep="\n")


WAITS = (0.0, 10.0, 20.0, 30.0, 1000.0)
"""Where pieces of the ramp begin [rpm]."""

WAIT_STEPS, COMPARED_STEPS = 400, 20


def waits_table(bench: Bench) -> None:
    """What a step takes where films fade, in alternating pieces of a ramp."""
    print("films    from rpm   us a step   beside the last row   compiled   forces beside Python")
    for films in get_args(Films):
        system = assemble(bench.scene, "map", bench.emap, films=films).system
        pieces, differences = [], []
        for begin in WAITS:
            speed = SpeedProfile(Course((0.0, 1.0), (begin * RPM, (begin + 400.0) * RPM)))
            start = equilibrium(system, Operation(speed.at(0.0)[0])).displacement
            pieces.append((speed, start))
            settings = Settings(SAMPLE, SAMPLE, residual=1e-12)
            ways = [
                run(system, speed, COMPARED_STEPS * SAMPLE, settings, (), start, options=Options(compiled=compiled))
                for compiled in (True, False)
            ]
            pairs = zip(ways[0].forces[:-1], ways[1].forces[:-1], strict=True)  # the mesh comes last
            differences.append(max(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs))
        spent, share = np.full((3, len(WAITS)), np.inf), [0.0] * len(WAITS)
        for turn in range(3):
            for place, (speed, start) in enumerate(pieces):
                begun = time.process_time()
                record = run(system, speed, WAIT_STEPS * SAMPLE, Settings(SAMPLE, SAMPLE), (), start)
                spent[turn, place] = 1e6 * (time.process_time() - begun) / record.steps
                share[place] = record.compiled / record.steps
        best = spent.min(axis=0)
        for begin, cost, compiled, difference in zip(WAITS, best.tolist(), share, differences, strict=True):
            print(
                f"{films:8} {begin:8g} {cost:11.0f} {cost / float(best[-1]):21.2f} {100.0 * compiled:8.0f} % "
                f"{difference:22.1e}"
            )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description="Run-ups of the shipped gearbox: cost beside error.")
    parser.add_argument("map", help="Reynolds map of the NU308, by `ehdmaps generate nu308`")
    parser.add_argument("--duration", type=float, default=0.5, help="of the piece of the ramp around 1500 rpm [s]")
    parser.add_argument("--whole", action="store_true", help="the whole ramp of 5 s; fewer rows")
    parser.add_argument("--housing", help="the same housing with modes up to 12 kHz, by `python -m examples.housings`")
    parser.add_argument("--films", choices=get_args(Films), default=DEFAULT_FILMS, help="of the map")
    parser.add_argument("--waits", action="store_true", help="what steps cost from rest on, instead")
    given = parser.parse_args()
    if not SHORTEST <= given.duration <= LONGEST:
        parser.error(f"--duration: got {given.duration:g} s; allowed: {SHORTEST:g} to {LONGEST:g} s")
    scene = read_scene("gearbox")
    assert scene.run_up is not None
    duration = scene.run_up.duration if given.whole else given.duration
    bench = Bench(scene, ehdmaps.open_map(given.map), duration, given.whole, given.housing, given.films)
    if given.waits:
        waits_table(bench)
        return
    begin, end = (bench.speed.at(at)[0] / RPM for at in (0.0, duration))
    print(f"{scene.title}: {begin:.0f} to {end:.0f} rpm in {duration:g} s; levels {Reference.of(bench.sensor).text}")
    for law in ("map", "hertz"):
        run_tables(bench, law)
        sampling_table(bench, law)
    if not given.whole:
        coordinates_table(bench, "map")
        table_error(bench)
        peak_table(bench)


if __name__ == "__main__":
    main()

"""How many true machines are inside the bands of what is not known, and how wide these are.

Run: python -m tests.benchmarks.coverage [balls rollers mixed] [--draws 40] [--seed 7] [--critical]

Three machines whose scenes stand here: two balls with a spring, two estimated roller bearings, and a ball and a roller
bearing in a housing on feet. Of each, true machines are drawn (`tests.benchmarks.coverage.draws`) and solved whole;
bands are those of `mbs modes`, `lsa` and `statics`, with --critical those of `mbs critical`. Told are the share inside
of all values, that of the worst one, and the median of the width of bands over the range from 5 to 95 % of the draws.
Bars: 85 to 98 % inside, none under 70 %, a width of at most 1.5. True machines have the numerics of the bands, which
their spread does not show: share and width without numerics are told, too.
"""

from __future__ import annotations

import argparse
import dataclasses
import time
from pathlib import Path

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from mbs import assemble, lsa, modes, read_scene, statics
from mbs.unknowns.looks import Band
from tests.benchmarks.coverage.critical import Bounds, measured
from tests.benchmarks.coverage.draws import drawn, truth

MACHINES = ("balls", "rollers", "mixed")

HEAD = """                                             without numerics
                   inside   worst   width      inside   width  half-width    lost"""

HIGHEST = 2500.0
"""Frequency up to which modes count [Hz]."""


def line(label: str, band: Band | Bounds, truths: FloatArray) -> str:
    """Share inside of values (draws, ...) a band (...), the worst of them, and the width beside that of the draws."""
    known = np.isfinite(truths) & np.isfinite(band.low)
    spread = np.nanquantile(truths, 0.95, axis=0) - np.nanquantile(truths, 0.05, axis=0)

    def told(one: Band | Bounds) -> tuple[BoolArray, float]:
        slack = 1e-9 * np.abs(one.value)
        wide = np.median((one.high - one.low)[spread > 0.0] / spread[spread > 0.0])
        return (truths >= one.low - slack) & (truths <= one.high + slack), float(wide)

    exact = dataclasses.replace(band, numerics=np.zeros_like(band.value)) if isinstance(band, Band) else band
    (inside, wide), (bare, narrow) = told(band), told(exact)
    each = np.array([inside[:, k][known[:, k]].mean() for k in range(truths.shape[1]) if known[:, k].any()])
    half = np.median(0.5 * (band.high - band.low) / np.abs(band.value))
    return (
        f"  {label:16s} {inside[known].mean():6.2f}  {each.min():6.2f}  {wide:6.2f}  {bare[known].mean():10.2f}  "
        f"{narrow:6.2f}  {100.0 * half:8.1f} %  {np.mean(~np.isfinite(truths)):6.2f}"
    )


def measure(name: str, draws: int, seed: int) -> list[str]:
    """Lines on one machine."""
    scene = read_scene(str(Path(__file__).with_name(f"{name}.toml")))
    begin = time.process_time()
    found = modes(assemble(scene), highest=HIGHEST)
    bands = found.bands_to(HIGHEST)
    spent = time.process_time() - begin
    machine = found.model.scene
    peaks, rest = lsa(assemble(scene)).bands, statics(assemble(scene)).bands
    random = np.random.default_rng(seed)
    truths = [truth(drawn(machine, random), found.balance, found.modes, bands.chosen) for _ in range(draws)]
    values = np.array([one.modes for one in truths])
    matrices = np.array([one.matrices for one in truths])
    lines = [
        f"{name}: {draws} draws; bands of modes take {spent:.1f} s, with {bands.frequency.looks} looks",
        HEAD,
        line("frequency", bands.frequency, values[:, 0]),
        line("damping ratio", bands.damping_ratio, values[:, 1]),
    ]
    bearings = np.repeat(np.arange(matrices.shape[1]), 2)
    axes = np.tile([1, 2], matrices.shape[1])
    for label, variable, place in (("K", "bearing_stiffness", 0), ("C", "bearing_damping", 1)):
        lines.append(line(label, rest[variable].of((bearings, axes, axes)), matrices[:, :, place].reshape(draws, -1)))
    of_first = [k for k, (_, sensor, entry) in enumerate(peaks.places) if sensor == entry == 0]
    own = [int(np.argmin(np.abs(bands.frequency.value - peaks.frequency.value[k]))) for k in of_first]
    if of_first:
        heights = 20.0 * np.log10(np.array([one.peaks for one in truths])[:, own])
        lines.append(line("peak", peaks.level.of(of_first), heights))
    return lines


def measure_critical(name: str, draws: int, seed: int) -> list[str]:
    """Lines on the first critical speed of one machine, and on its largest response to an unbalance."""
    found = measured(read_scene(str(Path(__file__).with_name(f"{name}.toml"))), draws, seed)
    return [
        f"{name}: {draws} draws",
        HEAD,
        line("critical speed", *found.speed),
        line("damping ratio", *found.ratio),
        line("response", *found.response),
    ]


def main() -> None:
    """Measure the machines that are named."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("machines", nargs="*", default=MACHINES)
    parser.add_argument("--draws", type=int, default=40)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--critical", action="store_true", help="critical speeds and responses to an unbalance")
    given = parser.parse_args()
    for name in given.machines:
        make = measure_critical if given.critical else measure
        print("\n".join(make(name, given.draws, given.seed)), flush=True)


if __name__ == "__main__":
    main()

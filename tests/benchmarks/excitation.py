"""Excitation by bearings: vibration of a 6205 by clearance and oil, the envelope of a spall, cost of a step.

python -m tests.benchmarks.excitation [--only spindle|spall|cost] [--figure docs/excitation.png]
"""

from __future__ import annotations

import argparse
import time

import numpy as np
from matplotlib.figure import Figure

from mbs import assemble, parse_scene
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.settings import Settings
from mbs.transient.run import run
from mbs.vibration import BANDS, SPEED, band_levels, envelope_spectrum, ring_vibration
from tests.conformance.machines import KINDS

BEARING, AXIAL, MASS = "6205", 150.0, 0.06
WAVES = """
waviness = [{ on = "inner", waves = [2, 500], amplitude = "0.2 um", seed = 1 }, \
{ on = "outer", waves = [2, 500], amplitude = "0.2 um", seed = 2 }, \
{ on = "elements", waves = [2, 100], amplitude = "0.05 um", seed = 3 }]
"""
FEWER = WAVES.replace("500", "60").replace("100", "20")
UNFELT = FEWER.replace("0.2 um", "1e-6 um").replace("0.05 um", "1e-6 um")
SPALL = """
waviness = [{ on = "inner", waves = [2, 500], amplitude = "0.02 um", seed = 1 }, \
{ on = "outer", waves = [2, 500], amplitude = "0.02 um", seed = 2 }]
spall = [{ on = "outer", length = "0.5 mm", depth = "20 um" }]
"""
FILMS, DRY = "table", "hertz:1.25e-5 s"
NAMES = {FILMS: "films", DRY: "dry"}


def spindle(figure: Figure) -> None:
    """Bands of ISO 15242 over clearance and oil."""
    given = {"clearances": [5e-6, 10e-6, 20e-6], "temperatures": [293.15, 313.15, 343.15]}
    found = ring_vibration(BEARING, WAVES, AXIAL, MASS, **given)
    perfect = ring_vibration(BEARING, "waviness = []", AXIAL, MASS, clearances=[10e-6], temperatures=[313.15])
    print(f"{BEARING}, {AXIAL:g} N along the axis, 1800 rpm: velocity of the outer ring in um/s, least to largest over")
    print("clearances of 5, 10, 20 um and FVA3 at 20, 40, 70 degC; perfect bearing at 10 um, 40 degC")
    axes = figure.add_subplot(1, 2, 1)
    for index, law in enumerate((FILMS, DRY)):
        low, high = 1e6 * found.band(law)
        alone = 1e6 * perfect.band(law)[0]
        for (first, last), least, most, own in zip(BANDS, low, high, alone, strict=True):
            print(f"  {NAMES[law]:6s} {first:6.0f} to {last:6.0f} Hz: {least:8.3g} to {most:8.3g}; perfect {own:8.2g}")
        places = np.arange(3) + 0.3 * (index - 0.5)
        axes.bar(places, high - low + 1e-3 * high, 0.25, low, label=NAMES[law])
    axes.set_xticks(range(3), [f"{low:.0f} to\n{high:.0f} Hz" for low, high in BANDS])
    axes.set_yscale("log")
    axes.set_ylim(0.7e6 * found.bands.min(), 1.4e6 * found.bands.max())
    axes.set_ylabel("velocity of the outer ring, rms [um/s]")
    axes.legend()


def spall(figure: Figure) -> None:
    """Envelope spectrum of a spall of the outer ring."""
    found = ring_vibration(BEARING, SPALL, AXIAL, MASS)
    axes = figure.add_subplot(1, 2, 2)
    for signal, case in zip(found.signals, found.cases, strict=True):
        frequency, amplitude = envelope_spectrum(signal, found.rate, (2000.0, 10000.0))
        shown = frequency < 600.0
        axes.plot(frequency[shown], 1e6 * amplitude[shown], label=NAMES[case[2]], linewidth=0.8)
        place = int(np.argmax(amplitude[frequency > 20.0])) + int(np.sum(frequency <= 20.0))
        level = 1e6 * band_levels(signal, found.rate)[2]
        order = 2.0 * np.pi * frequency[place] / SPEED
        print(
            f"spall of the outer ring, {NAMES[case[2]]}: largest line of the envelope at {frequency[place]:.1f} Hz, "
            f"order {order:.4g}, {1e6 * amplitude[place]:.3g} um/s; high band {level:.3g} um/s"
        )
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("envelope, 2 to 10 kHz [um/s]")
    axes.legend()


def cost() -> None:
    """Processor time of a step with waviness and without, least of five, in turn, and Newton iterations of each.

    Waves of 1e-6 um cost what it costs to have them; the motion is that of the perfect bearing, which hardly moves.
    """
    for law in (FILMS, DRY):
        for kind in (
            kind for kind in KINDS if kind.name in ("cylindrical", "rollers as bodies", "deep groove", "tapered")
        ):
            text = kind.text((300.0, -2000.0, 150.0))
            texts = text, *(text.replace("[[bearings]]\n", f"[[bearings]]{waves}") for waves in (UNFELT, FEWER))
            models = [assemble(parse_scene(one, "one", "one"), law) for one in texts]
            start = equilibrium(models[0].system, models[0].operation).displacement
            best, turns = [float("inf")] * 3, [0.0] * 3
            for _ in range(5):
                for index, model in enumerate(models):
                    began, settings = time.process_time(), Settings(step=2e-5, sample=1e-3)
                    made = run(model.system, SpeedProfile.constant(157.0), 0.1, settings, displacement=start)
                    turns[index] = made.iterations / made.steps
                    best[index] = min(best[index], time.process_time() - began)
            times = f"{200.0 * best[0]:.1f} us, with waves unfelt {best[1] / best[0]:.2f} times, with waviness"
            words = f"{times} {best[2] / best[0]:.2f} times; iterations {turns[0]:.2f}, {turns[1]:.2f}, {turns[2]:.2f}"
            print(f"step of {kind.name}, {NAMES[law]}: {words}", flush=True)


def main() -> None:
    """Print all, or a part; draw it."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.excitation")
    parser.add_argument("--only", choices=("spindle", "spall", "cost"))
    parser.add_argument("--figure", help="file of a picture")
    given = parser.parse_args()
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    if given.only in (None, "spindle"):
        spindle(figure)
    if given.only in (None, "spall"):
        spall(figure)
    if given.figure:
        figure.savefig(given.figure, dpi=110)
    if given.only in (None, "cost"):
        cost()


if __name__ == "__main__":
    main()

"""`mbs hammer`: a simulated hammer test of a scene, written as a universal file."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.extras import lacking
from ehdmaps.outputs import Output, output_problems
from ehdmaps.units import quantity
from mbs.analyses.hammer import HIGHEST, HammerSettings, hammer, hammer_problems
from mbs.commands.auto import Looked, analysed
from mbs.commands.cases import load_model
from mbs.commands.common import Told, clean, film_lines, free_words, heading, outside_at
from mbs.linearised.modes import Modes
from mbs.modal.uff import UFF, Measurement
from mbs.modal.uff_writing import write_uff
from mbs.scene.contact_laws import FILM_WORDS
from mbs.scene.fields import MILLISECOND
from mbs.transient.hammer import HammerTest


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Hit, and write the records."""
    highest, duration = _options(arguments)
    settings = HammerSettings(highest, duration, arguments.hits, arguments.noise, arguments.seed, arguments.nonlinear)
    done = analysed(
        arguments,
        lambda given: load_model(given, UFF, hammer_problems),
        lambda model: hammer(model, settings, Told("hit")),
        lambda model: Looked(model.scene, highest or max(model.scene.frequencies, default=HIGHEST)),
    )
    found = done.result
    model = found.model
    scene, test, hits = model.scene, found.test, found.hits
    outside = [
        *outside_at(model, found.balance),
        *(f"warning: {name}: {n} calls outside the map" for name, n in found.outside_hits.items() if n),
    ]
    path = Path(arguments.output)
    films = FILM_WORDS[model.memory]
    # The file stands alone: it says films and oil supply also where they are the default.
    flooded = model.supplies and all(supply.flooded for supply in model.supplies.values())
    parts = (films if found.errors else "", "flooded" if flooded else "")
    label = ", ".join([model.label, *(part for part in parts if part and part not in model.label)])
    title = f"{scene.name}, {label}: {test.hits} hits, simulated"
    write_uff(path, Measurement(title, hits))
    lines = [
        *done.lines,
        *heading(model, scene.speed),
        f"{test.hits} hits at each of {len(hits)} places, {len(scene.sensors)} sensors, "
        + ("nonlinear" if arguments.nonlinear else "linearised at the equilibrium"),
        f"  records of {test.samples * test.step:.4g} s, {test.samples} samples at {1.0 / test.step:.6g} Hz; "
        f"half-sines of {MILLISECOND.text(test.pulse)}, up to {test.highest:.6g} Hz; seed {test.seed}",
        f"  noise: standard deviation {100.0 * test.noise:.3g} % of the peak of each channel",
        *_expected(found.modes, test),
        *film_lines(found.errors, [test.highest]),
        *outside,
        f"{path}: written",
    ]
    return "\n".join(lines), 1 if outside else done.status


def _options(arguments: argparse.Namespace) -> tuple[float | None, float | None]:
    """Read highest frequency and duration; -o has to be there."""
    problems = []
    found: list[float | None] = []
    for option, text, unit in (("--highest", arguments.highest, "Hz"), ("--duration", arguments.duration, "s")):
        found.append(None)
        if text is not None:
            try:
                found[-1] = quantity(text, unit)
            except InputError as error:
                problems.append(f"{option}: {error.problems[0]}")
            else:
                if not found[-1]:
                    problems.append(f"{option}: got {text!r:.60}; allowed: above 0 {unit}")
    if arguments.plot:
        problems.append(f"--plot: got {arguments.plot}, but records are not drawn; see `mbs modal-fit --plot`")
    if not arguments.output:
        problems.append("-o: missing; give the universal file that the records are written to, such as hits.uff")
    problems += [*output_problems([Output("-o", arguments.output, UFF)]), *lacking("modal", "pyuff", "-o")]
    if problems:
        raise InputError(problems)
    return found[0], found[1]


def _expected(found: Modes, test: HammerTest) -> list[str]:
    """Lines of the eigenvalues that the test should find."""
    lines = ["  eigenvalues of the same linearised system up to there (a test shows those that are hit and sensed):"]
    seen = np.nonzero((found.eigenvalues.imag > 0.0) & ~found.free & (found.frequency <= test.highest))[0]
    lines += [
        f"  {k + 1:4d} {found.frequency[k]:14.6g} Hz   damping ratio {clean(found.damping_ratio[k]):.4g}" for k in seen
    ]
    free = int(np.count_nonzero(found.free))
    return [*lines, f"  {free_words(free)}"] if free else lines

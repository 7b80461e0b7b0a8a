"""`mbs hammer`: a simulated hammer test of a scene with each law, written as universal files."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from ehdmaps.errors import InputError, Problems
from ehdmaps.extras import lacking
from ehdmaps.outputs import Output, check_outputs, output_problems
from ehdmaps.units import quantity
from mbs.analyses.case import Case
from mbs.analyses.hammer import HIGHEST, HammerResult, HammerSettings, hammer_problems, hammers
from mbs.analyses.reach import outside_at, source_of
from mbs.analyses.soundness import Judged
from mbs.commands.auto import analysed
from mbs.commands.cases import files_read, load_cases
from mbs.commands.common import Looked, Told, chosen_workers
from mbs.linearised.modes import Modes
from mbs.modal.uff import UFF, Measurement, write_uff
from mbs.model.relaxation import FILM_WORDS
from mbs.model.system import System
from mbs.output.model_text import clean, film_lines, free_words, heading
from mbs.planning.question import at_one_speed
from mbs.scene.fields import MILLISECOND
from mbs.transient.hammer import HammerTest


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Hit with each law, and write the records, a file a law."""
    highest, duration = _options(arguments)
    settings = HammerSettings(highest, duration, arguments.hits, arguments.noise, arguments.seed, arguments.nonlinear)
    told = Told("hit") if arguments.nonlinear else None
    with chosen_workers(arguments) as workers:
        done = analysed(
            arguments,
            _asked,
            lambda cases: (hammers(cases, settings, told, workers=workers), [case.label for case in cases]),
            lambda cases: _looks_at(cases, highest),
        )
    found, labels = done.result
    paths = dict(zip(labels, _files(arguments.output, len(labels)), strict=True))
    judged = Judged([(label, entry.findings) for label, entry in zip(found.labels, found.results, strict=True)])
    lines = [*judged.first, *done.lines]
    outside = bool(judged.status)
    for label, entry in zip(found.labels, found.results, strict=True):
        words, warned = _report(entry, label if labels[1:] else "", settings.nonlinear)
        _write(paths[label], entry, label if labels[1:] else entry.model.label)
        lines += [*words, f"{paths[label]}: written"]
        outside = outside or warned
    lines += [*judged.last, *(f"warning: {line}" for line in found.failed)]
    return "\n".join(lines), 1 if outside or found.failed else 0


def _asked(arguments: argparse.Namespace) -> list[Case]:
    """A case for each law, map, kind of films, oil supply and clearance; of several all files are looked at."""
    cases = load_cases(arguments, kind=UFF, needs=hammer_problems)
    if cases[1:]:
        read = files_read(arguments, cases[0].model.scene)
        check_outputs([Output("-o", path, UFF) for path in _files(arguments.output, len(cases))], read)
    return cases


def _looks_at(cases: list[Case], highest: float | None) -> Looked:
    """The scene at its operating speed, and the highest frequency of the test."""
    scene = cases[0].model.scene
    return Looked(at_one_speed(scene), highest or max(scene.frequencies, default=HIGHEST))


def _files(path: str, count: int) -> list[Path]:
    """The file of each case: the one that was named, or of several numbered ones, such as hits-1.uff."""
    place = Path(path)
    return [place] if count == 1 else [place.with_stem(f"{place.stem}-{k + 1}") for k in range(count)]


def _write(path: Path, found: HammerResult, label: str) -> None:
    """Write the records of a case."""
    model, test = found.model, found.test
    films = FILM_WORDS[model.memory]
    # The file stands alone: it says films and oil supply also where they are the default.
    flooded = model.supplies and all(supply.flooded for supply in model.supplies.values())
    parts = (films if found.errors else "", "flooded" if flooded else "")
    words = ", ".join([label, *(part for part in parts if part and part not in label)])
    write_uff(path, Measurement(f"{model.scene.name}, {words}: {test.hits} hits, simulated", found.hits))


def _report(found: HammerResult, label: str, nonlinear: bool) -> tuple[list[str], bool]:
    """Lines of one case, whose label is empty if it is the only one; and whether it was outside its map."""
    model, test = found.model, found.test
    scene = model.scene
    outside = [
        *outside_at(model, found.balance),
        *(f"warning: {name}: {n} calls outside {source_of(model)}" for name, n in found.outside_hits.items() if n),
    ]
    lines = [
        *heading(model, scene.speed),
        *([f"  case: {label}"] if label else []),
        f"{test.hits} hits at each of {len(found.hits)} places, {len(scene.sensors)} sensors, "
        + ("nonlinear" if nonlinear else "linearised at the equilibrium"),
        f"  records of {test.samples * test.step:.4g} s, {test.samples} samples at {1.0 / test.step:.6g} Hz; "
        f"half-sines of {MILLISECOND.text(test.pulse)}, up to {test.highest:.6g} Hz; seed {test.seed}",
        f"  noise: standard deviation {100.0 * test.noise:.3g} % of the peak of each channel",
        *_expected(found.modes, test, model.system),
        *film_lines(found.errors, [test.highest]),
        *outside,
    ]
    return lines, bool(outside)


def _options(arguments: argparse.Namespace) -> tuple[float | None, float | None]:
    """Read highest frequency and duration; -o has to be there."""
    problems = Problems()
    found: list[float | None] = []
    for option, text, unit in (("--highest", arguments.highest, "Hz"), ("--duration", arguments.duration, "s")):
        found.append(None)
        if text is not None:
            with problems.after(f"{option}: "):
                found[-1] = quantity(text, unit)
                if not found[-1]:
                    raise InputError(f"got {text!r:.60}; allowed: above 0 {unit}")
    if arguments.plot:
        problems.append(f"--plot: got {arguments.plot}, but records are not drawn; see `mbs modal-fit --plot`")
    if not arguments.output:
        problems.append("-o: missing; give the universal file that the records are written to, such as hits.uff")
    problems += [*output_problems([Output("-o", arguments.output, UFF)]), *lacking("modal", "pyuff", "-o")]
    problems.check()
    return found[0], found[1]


def _expected(found: Modes, test: HammerTest, system: System) -> list[str]:
    """Lines of the eigenvalues that the test should find."""
    lines = ["  eigenvalues of the same linearised system up to there (a test shows those that are hit and sensed):"]
    seen = np.nonzero((found.eigenvalues.imag > 0.0) & ~found.free & (found.frequency <= test.highest))[0]
    lines += [
        f"  {k + 1:4d} {found.frequency[k]:14.6g} Hz   damping ratio {clean(found.damping_ratio[k]):.4g}" for k in seen
    ]
    free = int(np.count_nonzero(found.free))
    return [*lines, f"  {free_words(free, system)}"] if free else lines

"""`mbs sweep`: modes, bearings and frequency responses over speed, for one or more laws, clearances and loads."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import Problems
from ehdmaps.units import DAMPER, RPM, SPRING, quantity, whole_number
from mbs.analyses.case import Case
from mbs.analyses.film_errors import film_errors
from mbs.analyses.operating import operating
from mbs.analyses.reach import axes_outside, fade_lines, outside_lines, sources_of
from mbs.analyses.soundness import Judged
from mbs.analyses.sweep import SweepSettings, sweep, sweep_problems, waterfall_problems
from mbs.commands.auto import analysed
from mbs.commands.cases import load_cases
from mbs.commands.common import Looked, chosen_workers, read_cage_angles, with_bands, write, write_plot
from mbs.linearised.linear import response_display
from mbs.linearised.modes import free_motions
from mbs.linearised.sweep_result import Sweep, exchanged
from mbs.model.elements import Operation
from mbs.model.system import System
from mbs.output.band_text import DECIDED, HEAD, about_lines, bounds_text, exact_text
from mbs.output.excitation.table import line_rows
from mbs.output.model_text import (
    band_lines,
    clean,
    film_lines,
    free_words,
    heading,
)
from mbs.output.reduction_text import reduction_lines
from mbs.output.state_text import flooded_note, state_lines
from mbs.planning.question import over_speeds
from mbs.scene.assembly import Model
from mbs.scene.scene import Scene
from mbs.settings import MOST_SPEEDS, ROUND_OFF, SweepRange
from mbs.unknowns.held_open import held_open_of
from mbs.unknowns.over_speed import SpeedBands

_LEAST_SHARE = 0.05
_PEAKS = 5
_LEAST_ASSURANCE = 0.5


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Sweep over speed."""
    with chosen_workers(arguments) as workers:
        done = analysed(
            arguments,
            lambda given: _Asked(*_read(given)),
            lambda asked: sweep(asked.cases, asked.settings, workers=workers),
            _looks_at,
        )
    result = done.result
    banded = with_bands(arguments, []) and len(result.cases) == 1 and result.cases[0].model.scene.has_bearings
    cases, found = result.cases, result.sweeps
    judged = Judged(list(zip([case.label for case in cases], result.findings, strict=True)))
    lines = [*judged.first, *done.lines]
    outside: list[str] = []
    torques = result.dataset["rolling_torque"].values
    each = zip(cases, found, result.outside, torques, result.lines, strict=True)
    for case, entry, calls, torque, lines_of_case in each:
        outside += _outside(case, entry, calls)
        lines += [
            *heading(case.model),
            *([f"  case: {case.label}"] if len(cases) > 1 else []),
            *_course(entry),
            *_states(case.model, entry),
            *_films(case.model),
            *_bearings(entry, torque),
            *(f"  {line}" for line in flooded_note(_largest(torque), case.model.supplies.values())),
            *_undamped(entry, case.model.system),
            *_complex(entry),
            *_reduction(entry, case.model),
            *(_complex_bands(entry, result.bands[0], case.model) if banded else []),
            *_responses(entry),
            *line_rows(lines_of_case, case.model.scene.sensors),
            *band_lines(case.model, entry.film_share),
            *_exchanged(entry),
            *_unsure(entry),
            *_lost(entry),
            *_film_errors(case.model, entry),
            *fade_lines(case.model, entry.speeds),
        ]
    figure = result.plot(banded) if arguments.plot else None
    lines += judged.last + outside + write(arguments, result.bounded() if banded else result.dataset, figure)
    if arguments.waterfall:
        lines += write_plot(result.waterfall(), arguments.waterfall)
    return "\n".join(lines), 1 if outside or judged.status else 0


class _Asked(NamedTuple):
    """Cases that are swept, and the speeds."""

    settings: SweepSettings
    cases: list[Case]


def _looks_at(asked: _Asked) -> Looked:
    """The scene with the speeds and the largest loads of the sweep; modes and responses up to those of [linear]."""
    scene = max(asked.cases, key=lambda case: case.load_factor).model.scene
    speeds = over_speeds(scene, asked.settings.speeds)
    return Looked(speeds, max(scene.frequencies, default=scene.campbell.highest))


def _read(arguments: argparse.Namespace) -> tuple[SweepSettings, list[Case]]:
    """Read speeds, number of cage angles, and cases; all problems at once."""
    problems = Problems()
    speeds: SweepRange | None = None
    cases: list[Case] = []
    with problems:
        speeds = read_speeds(arguments.speed) if arguments.speed else None
    angles = read_cage_angles(arguments, problems)
    with_bands(arguments, problems)
    with problems:
        cases = load_cases(arguments, needs=lambda scene: _needs(arguments, scene), speeds=speeds)
    problems.check()
    return SweepSettings(speeds, angles), cases


def _needs(arguments: argparse.Namespace, scene: Scene) -> list[str]:
    """List what a scene lacks for what is asked for."""
    return [
        *([] if arguments.speed else sweep_problems(scene)),
        *(waterfall_problems(scene) if arguments.waterfall else []),
    ]


def read_speeds(texts: Sequence[str]) -> SweepRange:
    """Read FROM TO POINTS of `--speed`.

    Parameters
    ----------
    texts : sequence of str
        The three texts.

    Raises
    ------
    InputError
        With every problem.
    """
    problems = Problems()
    ends = []
    for text in texts[:2]:
        with problems.after("--speed: "):
            ends.append(quantity(text, "rad/s"))
    with problems.after("--speed, POINTS: "):
        points = whole_number(texts[2], 2, MOST_SPEEDS)
    if len(ends) == 2 and not 0.0 <= ends[0] < ends[1] <= 1e5:
        problems.append(f"--speed: got from {texts[0]!r:.40} to {texts[1]!r:.40}; allowed: rising, from 0 rpm on")
    problems.check()
    return SweepRange(ends[0], ends[1], points)


def _course(result: Sweep) -> list[str]:
    """A line on how the sweep went."""
    between = f"; {result.between} more put in between to follow the modes" if result.between else ""
    error = result.responses.error
    shown = f"; responses within {error.max():.1g} of direct solutions" if result.responses.values.size else ""
    return [f"  {result.speeds.size} speeds from {_first(result)} to {_last(result)}{between}{shown}"]


def _films(model: Model) -> list[str]:
    """A line on which numbers have films of which frequency, where films have memory."""
    if model.memory != "memory":
        return []
    return [
        "  k and c of bearings and undamped modes are those of slow motion; complex modes and responses have films of "
        "their own frequency"
    ]


def _states(model: Model, result: Sweep) -> list[str]:
    """Lines on bearings whose temperatures and clearances are those of the speed, at the first and the last one."""
    lines = []
    for speed in (float(result.speeds[0]), float(result.speeds[-1])):
        found = state_lines(operating(model, speed).states)
        lines += [f"  at {RPM.text(speed)}:", *(f"  {line}" for line in found)] if found else []
    return lines


def _bearings(result: Sweep, torque: FloatArray) -> list[str]:
    """Lines of stiffness, damping and rolling torque (speeds, bearings) of the bearings at the first and last speed."""
    lines = []
    entry = result.bearings
    for index, name in enumerate(entry.names):
        load, k, c = (values[[0, -1], index] for values in (entry.load, entry.stiffness, entry.damping))
        changed = (
            f"{load[0]:.5g} N" if abs(load[1] - load[0]) <= 1e-3 * load[0] else f"{load[0]:.5g} to {load[1]:.5g} N"
        )
        wide = 100.0 * float(entry.stiffness_spread[:, index].max())  # NaN without a load
        told = entry.angles > 1 and math.isfinite(wide)
        spread = f"; mean of {entry.angles} cage angles, k within {wide:.2g} % of it" if told else ""
        stiff = (
            f"along the load k {SPRING.value(k[0]):.4g} to {SPRING.text(k[1])} ({_change(*k)}), "
            f"c {DAMPER.value(c[0]):.4g} to {DAMPER.text(c[1])} ({_change(*c)})"
        )
        stiff = stiff if np.all(np.isfinite(k)) else "no radial load, along which it would have a stiffness"
        lines.append(
            f"  {name}: {changed}; {stiff}{spread}"
            + _band("; k", entry.stiffness_error[:, index], entry.stiffness[:, index])
            + _band(", c", entry.damping_error[:, index], entry.damping[:, index])
        )
        if np.all(np.isfinite(torque[:, index])):
            lines.append(
                f"  {name}: rolling torque {1e3 * torque[0, index]:.4g} to {1e3 * torque[-1, index]:.4g} N mm "
                "(films only)"
            )
    return lines


def _largest(torque: FloatArray) -> float:
    """Largest rolling torque of all speeds and bearings, 0 where none is known."""
    return float(np.nan_to_num(torque).max(initial=0.0))


def _undamped(result: Sweep, system: System) -> list[str]:
    """Lines on how the undamped modes with strain energy in the bearings change."""
    found = result.undamped
    free = free_motions(found.frequency.max(axis=0))
    shown = np.nonzero((found.bearing_share.max(axis=0) >= _least(result)) & ~free)[0]
    if not shown.size and not free.any():
        return ["  no undamped mode with strain energy in the bearings"]
    lines = [
        "  undamped modes      frequency/Hz        change  by energy: summed, one step   damping ratio   "
        "energy in the bearings"
    ]
    for k in shown:
        f, z, s = (values[[0, -1], k] for values in (found.frequency, found.damping_ratio, found.bearing_share))
        lines.append(
            f"  {k + 1:4d} {f[0]:12.5g} to {f[1]:9.5g} {_change(*f):>11} {_percent(found.summed_shift[-1, k]):>16}, "
            f"{_percent(found.direct_shift[k]):>10} {clean(z[0]):9.3g} to {clean(z[1]):.3g} "
            f"{s[0]:12.2f} to {s[1]:.2f}"
            + _band("; frequency", found.frequency_error[:, k], found.frequency[:, k])
            + _over_pitch(result, found.frequency_spread[:, k], found.frequency[:, k], "frequency")
        )
    return [*lines, f"  {free_words(int(np.count_nonzero(free)), system)}"] if free.any() else lines


def _complex(result: Sweep) -> list[str]:
    """Lines on the complex modes with strain energy in the bearings."""
    found = result.damped
    free = free_motions(np.nanmax(found.frequency, axis=0, initial=0.0))
    shares = np.nanmax(found.bearing_share, axis=0, initial=0.0)
    shown = np.nonzero((shares >= _least(result)) & ~free)[0].tolist()
    if not len(shown):
        return ["  no oscillating complex mode with strain energy in the bearings"]
    lines = [
        "  complex modes       frequency/Hz        change   damping ratio   whirl d omega/d Omega   oscillates"
        "   (numbers: nearest undamped mode)"
    ]
    for k in sorted(shown, key=lambda k: int(found.number[k])):
        there = np.nonzero(np.isfinite(found.frequency[:, k]))[0][[0, -1]]
        f, z, w = (values[there, k] for values in (found.frequency, found.damping_ratio, found.whirl))
        begin, end = (RPM.text(float(result.speeds[i])) for i in there)
        whole = there[0] == 0 and there[1] == result.speeds.size - 1
        lines.append(
            f"  {found.number[k] + 1:4d} {f[0]:12.5g} to {f[1]:9.5g} {_change(*f):>11} "
            f"{clean(z[0]):10.3g} to {clean(z[1]):.3g} "
            f"{clean(w[1]):+14.2g}           {'everywhere' if whole else f'{begin} to {end}'}"
            + _band("; frequency", found.frequency_error[:, k], found.frequency[:, k])
            + _band(", damping ratio", found.damping_ratio_error[:, k], found.damping_ratio[:, k])
            + _over_pitch(result, found.frequency_spread[:, k], found.frequency[:, k], "frequency")
            + _over_pitch(result, found.damping_ratio_spread[:, k], found.damping_ratio[:, k], "damping ratio")
        )
    return lines


def _reduction(result: Sweep, model: Model) -> list[str]:
    """Lines on what the reduction of bodies leaves out of the complex modes up to the highest frequency."""
    highest = max(model.scene.frequencies, default=model.scene.campbell.highest)
    found = result.damped
    return reduction_lines(
        model.system,
        np.where(found.frequency <= highest, found.frequency, np.nan),
        found.damping_ratio,
        found.reduction,
    )


def _complex_bands(result: Sweep, bands: SpeedBands, model: Model) -> list[str]:
    """Lines on what the complex modes with strain energy in the bearings may be, at each speed that was looked at."""
    found = result.damped
    shares = np.nanmax(found.bearing_share, axis=0, initial=0.0)
    lines = []
    for place, at, tracks in zip(bands.places, bands.at, bands.tracks, strict=True):
        shown = [k for k in np.flatnonzero((shares >= _least(result)) & (tracks >= 0)).tolist()]
        rows = [
            f"  {found.number[k] + 1:4d} {bounds_text(at.frequency, tracks[k]):24s} "
            f"{bounds_text(at.damping_ratio, tracks[k]):30s} {exact_text(at.frequency, tracks[k])}"
            for k in sorted(shown, key=lambda k: int(found.number[k]))
        ]
        at_speed = RPM.text(float(result.speeds[place]))
        lines += [f"  at {at_speed}, {HEAD}: frequency/Hz, damping ratio; frequency {DECIDED}", *rows] if rows else []
    return [*lines, *about_lines(model.scene, held_open_of(model), bands.told)] if lines else []


def _responses(result: Sweep) -> list[str]:
    """Lines on the highest peaks of each response at the first and last speed."""
    found = result.responses
    lines = []
    for s, i in np.ndindex(found.values.shape[2:]) if found.frequencies.size else ():
        sensor, entry = found.sensors[s], found.inputs[i]
        display = response_display(sensor, entry)
        size = display.factor * found.peak_size[:, :, s, i]
        ends = [_peaks(found.peak_frequency[k, :, s, i], size[k]) for k in (0, -1)]
        if not any(ends):
            continue
        at = [
            f"{', '.join(words) or 'none'} at {RPM.text(float(result.speeds[k]))}"
            for k, words in zip((0, -1), ends, strict=True)
        ]
        lines.append(f"  {sensor.name} by {entry.name}, peaks [{display.unit}]: {'; '.join(at)}")
    return lines


def _peaks(frequency: FloatArray, size: FloatArray) -> list[str]:
    """The highest peaks of a response, each with its frequency, in the order of these; not those that are NaN."""
    there = np.flatnonzero(np.isfinite(size))
    highest = np.sort(there[np.argsort(-size[there], kind="stable")][:_PEAKS])
    return [f"{size[k]:.3g} ({frequency[k]:.5g} Hz)" for k in highest]


def _exchanged(result: Sweep) -> list[str]:
    """Lines on undamped modes that turn away from each other and exchange their shapes."""
    found = result.undamped
    shown = found.bearing_share.max(axis=0) >= _least(result)
    lines = []
    for k, other in exchanged(found):
        if not shown[[k, other]].any():
            continue
        gap = np.abs(found.frequency[:, k] - found.frequency[:, other])
        near = int(np.argmin(gap))
        lines.append(
            f"  undamped modes {k + 1} and {other + 1} come within {gap[near]:.2g} Hz at "
            f"{RPM.text(float(result.speeds[near]))}: modes turn away there and exchange their shapes; the shape of "
            f"mode {k + 1} at {_first(result)} is that of mode {other + 1} at {_last(result)}"
        )
    return lines


def _least(result: Sweep) -> float:
    """Part of the strain energy in the bearings from which a mode is listed; without bearings all are."""
    return _LEAST_SHARE if result.bearings.names else 0.0


def _unsure(result: Sweep) -> list[str]:
    """A line if an undamped mode could not be followed surely."""
    found = result.undamped
    lost = (found.assurance < _LEAST_ASSURANCE) & (found.bearing_share >= _least(result))
    if not lost.any():
        return []
    shown = np.where(lost, found.assurance, 1.0)
    worst = RPM.text(float(result.speeds[np.argmin(shown.min(axis=1))]))
    names = ", ".join(str(k + 1) for k in np.nonzero(lost.any(axis=0))[0])
    return [
        f"warning: undamped modes {names} exchange their shapes between two speeds (least assurance "
        f"{shown.min():.2f} before {worst}): which is which is not sure there; take more points"
    ]


def _outside(case: Case, result: Sweep, calls: Mapping[str, int]) -> list[str]:
    """Lines on bearings whose equilibria lie outside the map."""
    words = f"lies outside the map at {{}} of {result.speeds.size} speeds"
    fastest = float(np.abs(result.speeds).max())
    return outside_lines(
        calls, words, axes_outside(operating(case.model, fastest), fastest), case.label, sources_of(case.model)
    )


def _film_errors(model: Model, result: Sweep) -> list[str]:
    """A line for each bearing: estimated error of its films at the highest mode in it, at the worst speed."""
    worst: dict[str, tuple[float, list[str]]] = {}
    found = result.undamped
    for index, speed in enumerate(result.speeds.tolist()):
        inside = found.frequency[index][found.bearing_share[index] >= _LEAST_SHARE]
        highest = float(inside.max(initial=0.0))
        for entry in film_errors(operating(model, speed), result.displacement[index], Operation(speed)):
            error = entry.at(highest)
            if not entry.at_rest and error > worst.get(entry.bearing, (-1.0,))[0]:
                worst[entry.bearing] = error, film_lines([entry], [highest], f" and {RPM.text(speed)}")
    return [line for _, lines in worst.values() for line in lines]


def _lost(result: Sweep) -> list[str]:
    """Lines on complex modes that could not be brought to the films of their own frequency."""
    count: dict[str, int] = {}
    for entry in (one for lost in result.damped.lost for one in lost):
        count[entry.reason.value] = count.get(entry.reason.value, 0) + 1
    return [
        f"warning: {number} times a complex mode could not be brought to the films of its own frequency ({reason}); it "
        "is missing there"
        for reason, number in count.items()
    ]


def _over_pitch(result: Sweep, spread: FloatArray, values: FloatArray, words: str) -> str:
    """Variation of a value over the angles of the cage; nothing for one angle."""
    return _band(f"; over the pitch {words}", spread, values) if result.bearings.angles > 1 else ""


def _band(words: str, errors: FloatArray, values: FloatArray) -> str:
    """The largest band over the speeds, in per cent of the value there; nothing where none is stated."""
    there = np.isfinite(errors) & (np.abs(values) > ROUND_OFF)
    if not there.any():
        return ""
    part = 100.0 * float(np.max(errors[there] / np.abs(values[there])))
    return f"{words} +- {part:.2g} %" if part < 99.5 else f"{words} +- {part:.0f} %"


def _change(begin: float, end: float) -> str:
    """Relative change in per cent."""
    return _percent(end / begin - 1.0) if begin > 0.0 else "-"


def _percent(part: float) -> str:
    """A part in per cent, with its sign."""
    return f"{100.0 * clean(part):+.2f} %"


def _first(result: Sweep) -> str:
    """The first speed."""
    return RPM.text(float(result.speeds[0]))


def _last(result: Sweep) -> str:
    """The last speed."""
    return RPM.text(float(result.speeds[-1]))

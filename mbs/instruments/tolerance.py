"""Step, slices and cut-off of a run-up that keep its sum level within a tolerance, found by short trials.

Two parts of the ramp are run again and again: the loudest one, as a run through the whole ramp in an eighth of its
time shows it, and the fastest one. First with the settings of the scene, and with half its step, twice its slices and
all modes. Where that changes the level by less than the tolerance, the settings stay: no part has helped to choose
them, and both confirm them. Else the step is halved from the longest one that the highest frequency allows on, until
the sum level at equal speed hardly changes; then slices are doubled from a few on, and modes are added, by twice that
step. What was chosen has to prove itself on the loudest part of the ramp that was not used to choose, beside half the
step, twice the slices and all modes. Where it fails, that part helps to choose, and another one is asked.

A method of second order that changes by d from one step to its half is 4/3 d away from the limit. The step may take
three quarters of the tolerance, slices half of what it leaves, the cut-off the rest.

A run that does not forget its start, such as one of rollers that lift off without damping, has no level at a speed that
a shorter step would come closer to: what rounding changes grows to the size of the signal. So that is tried first: two
runs through the whole shortened ramp begin 1 pm apart. Where they come together all is well. Where they drift apart
between any two times, they do so the longer the slower the ramp is, and rounding with them.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.units import RPM
from mbs.analyses.case import Progress, silent
from mbs.analyses.operating import held
from mbs.analyses.ramp import recorded_run, run_course
from mbs.analyses.sensors import looked_at
from mbs.instruments.ramp_parts import WINDOWS, PartRun, Ramp, RampPart, compressed, ramp_of, run_part
from mbs.scene.changes import cutoff_of
from mbs.scene.choices import CHOICES, Subject
from mbs.scene.fields import MILLISECOND
from mbs.scene.scene import Scene
from mbs.settings import CampbellSettings
from mbs.spectral.campbell import campbell
from mbs.spectral.run_signal import RunSignal

LEAST, MOST = 0.01, 20.0
"""Limits of a tolerance [dB]: less is the rounding of the tables of a law over speed, more is no accuracy."""

ALLOWED = f"above 0 dB, from {LEAST:g} dB up to {MOST:g} dB, such as '1 dB'"

QUANTILE = 0.95
"""Part of the windows that have to keep the tolerance."""

HALVINGS = 3
"""How often the step of the scene is halved at most."""

SLICES = (6, 11, 21, 41, 81, 161)
"""Slices that are tried: each has twice the intervals of the one before."""

FRESH = 3
"""Parts that are asked to confirm, one after the other."""

NUDGE = 1e-12
"""How far two runs begin apart to see whether they forget it [m or rad]."""

ROUNDING = 1e-13
"""By which part of the signal two runs that have forgotten their start differ: rounding."""

_STRETCHES = 24
"""Into which the shortened ramp is cut to see how its two runs drift apart."""

SCOUT = 1.0 / 8.0
"""Time of the run that looks for the loudest part, as a part of that of the run-up."""

LEAST_SCOUT = 0.25
"""Shortest such run [s], as long as bodies ring; a ramp that is shorter is run as it is."""

LEAST_PARTS = 6
"""Parts of a ramp: two to choose by, one to confirm, and none of them neighbours."""

_ORDER = 4.0
_LIMIT = _ORDER / (_ORDER - 1.0)
_SHARES = {"step": 0.75, "slices": 0.5, "cutoff": 1.0}
"""What each may take of the tolerance that those before it leave."""

KEYS = ("step", "slices", "cutoff")
"""The fields of `Numerics`, which are names of `mbs.scene.choices.CHOICES`."""


@dataclass(frozen=True)
class Numerics:
    """Choices of a user about accuracy of a run-up.

    Attributes
    ----------
    step : float
        Time step [s].
    slices : int or None
        Slices of all rollers; None without bearings.
    cutoff : float or None
        Frequency up to which flexible bodies have modes [Hz]; None without such bodies.
    """

    step: float
    slices: int | None
    cutoff: float | None

    @classmethod
    def of(cls, scene: Scene) -> Numerics:
        """Those of a scene: its largest number of slices, and its highest cut-off.

        Raises
        ------
        InputError
            If the scene has no run-up.
        """
        if scene.run_up is None:
            raise InputError(f"{scene.name}: [runup] missing; a run-up needs from, to, duration and step")
        slices = max((entry.slices for entry in scene.bearings), default=None)
        return cls(scene.run_up.settings.step, slices, cutoff_of(scene))

    def applied(self, subject: Subject) -> Subject:
        """A subject with these settings; what they leave open stays as it is.

        Parameters
        ----------
        subject : Subject
            Scene and law.

        Raises
        ------
        InputError
            If they do not fit the scene.
        """
        for key in KEYS:
            value = getattr(self, key)
            subject = subject if value is None else CHOICES[key].change(subject, value)
        return subject

    def but(self, **values: float | int | None) -> Numerics:
        """The same settings with some of them changed."""
        return dataclasses.replace(self, **values)  # type: ignore[arg-type]

    @property
    def text(self) -> str:
        """The settings in words, such as "step 10 us, 21 slices, modes up to 8000 Hz"."""
        return ", ".join(words for key in KEYS if (words := self.words(key)))

    def words(self, key: str) -> str:
        """One of the settings in words; empty where it is left open.

        Parameters
        ----------
        key : str
            One of `KEYS`.
        """
        value = getattr(self, key)
        return "" if value is None else CHOICES[key].words(value)


@dataclass(frozen=True)
class Tolerated:
    """A subject whose numerical settings were chosen for a tolerance.

    Attributes
    ----------
    subject : Subject
        Scene and law with the settings that were chosen; as they came where none could be.
    numerics : Numerics
        These settings.
    lines : tuple of str
        What was chosen, by which trials, at which cost, and where it could not.
    met : bool
        Whether a part of the ramp that was not used to choose has confirmed them.
    confirmed : float
        Difference there beside finer settings, with what that leaves [dB]; NaN where none was measured.
    seconds : float
        Processor time of all trials [s].
    """

    subject: Subject
    numerics: Numerics
    lines: tuple[str, ...]
    met: bool
    confirmed: float
    seconds: float


def read_tolerance(text: str) -> float:
    """Read a tolerance of levels [dB].

    Parameters
    ----------
    text : str
        Such as "1 dB".

    Raises
    ------
    InputError
        For anything that is no tolerance.

    Examples
    --------
    >>> read_tolerance("0.5 dB")
    0.5
    """
    number, _, unit = text.strip().partition(" ")
    if not unit and number.endswith("dB"):
        number, unit = number.removesuffix("dB"), "dB"
    try:
        value = float(number)
    except ValueError:
        value = math.nan
    if unit.strip() != "dB" or not LEAST <= value <= MOST:
        raise InputError(f"got {text!r:.60}; allowed: {ALLOWED}")
    return value


def within(
    subject: Subject,
    tolerance: float,
    settings: CampbellSettings | None = None,
    progress: Progress | None = None,
) -> Tolerated:
    """Choose step, slices and cut-off so that the sum level of a run-up keeps a tolerance.

    Parameters
    ----------
    subject : Subject
        Scene and law.
    tolerance : float
        Difference of the sum level at equal speed from that of finer settings that is allowed, in 95 % of the
        windows [dB].
    settings : CampbellSettings, optional
        Sensor, highest frequency and window; [campbell] of the scene if left out.
    progress : callable, optional
        Told how many trials are done, and of how many at most.

    Returns
    -------
    Tolerated
        The choice, with `met` False where it could not be met or not be confirmed; `lines` say why.

    Raises
    ------
    InputError
        If the tolerance is none, or run, sensor or settings are not possible.
    AnalysisError
        If the bearings find no temperatures at the operating speed.

    Notes
    -----
    The cut-off is only lowered: modes that the bodies of the scene do not have cannot be judged.
    """
    if not LEAST <= tolerance <= MOST:
        raise InputError(f"tolerance: got {tolerance!r} dB; allowed: {ALLOWED}")
    settings = settings or subject.scene.campbell
    numerics = Numerics.of(subject.scene)
    ramp = ramp_of(subject.model(), settings, looked_at(subject.scene, settings))
    head = (
        f"tolerance {tolerance:g} dB of the sum level of {ramp.sensors[0].name} at equal speed, in "
        f"{100.0 * QUANTILE:g} % of windows of {MILLISECOND.text(ramp.window)}"
    )
    trials = _Trials(subject, ramp, progress or silent)
    try:
        numerics, found, difference = _chosen(trials, tolerance, numerics)
        met = True
    except _CouldNotError as reason:
        found, difference, met = [f"warning: could not: {reason}"], reason.difference, False
        numerics = reason.numerics or numerics
    trials.finish()
    cost = f"  {trials.count} trials of {trials.steps} steps in all took {trials.seconds:.3g} s of processor time"
    return Tolerated(
        numerics.applied(subject), numerics, (head, *trials.told, *found, cost), met, difference, trials.seconds
    )


class _CouldNotError(Exception):
    """Reason why a tolerance is not met, with the settings that are best nevertheless."""

    def __init__(self, reason: str, numerics: Numerics | None = None, difference: float = math.nan) -> None:
        super().__init__(reason)
        self.numerics = numerics
        self.difference = difference


@dataclass
class _Trials:
    """Runs of parts that were made, none of them twice, and what they cost."""

    subject: Subject
    ramp: Ramp
    tell: Progress
    count: int = 0
    steps: int = 0
    seconds: float = 0.0
    told: list[str] = field(default_factory=list)
    made: dict[tuple[Numerics, RampPart], PartRun | None] = field(default_factory=dict)

    most: int = 2 * (len(SLICES) + 4 + HALVINGS) * (FRESH + 1)
    """Trials at most, for the progress."""

    def run(self, numerics: Numerics, part: RampPart) -> PartRun | None:
        """The run of a part with some settings; None where it finds no solution."""
        key = (numerics, part)
        if key not in self.made:
            begin = time.process_time()
            try:
                found = run_part(numerics.applied(self.subject), self.ramp, part)
                self.steps += found.steps
            except AnalysisError:
                found = None
            self.made[key] = found
            self._counted(time.process_time() - begin)
        return self.made[key]

    def scout(self, factor: float, step: float, nudge: float = 0.0) -> RunSignal | None:
        """The signal of the whole ramp in a part of its time; None where there is no solution."""
        begin = time.process_time()
        scene = compressed(self.subject.scene, factor, step)
        sensor = self.ramp.sensors[0]
        found = None
        course = run_course(scene, self.ramp.highest, [])
        if course is not None:
            model = held(Subject(scene, self.subject.law, self.subject.clearance).model())
            try:
                record = recorded_run(model, course, (sensor,), nudge=nudge)
                self.steps += record.steps
                found = RunSignal(record.time, record.speed, record.angle, record.signals[:, 0])
            except AnalysisError:
                # Such a step is too long for it, and says nothing about shorter ones.
                found = None
        self._counted(time.process_time() - begin)
        return found

    def difference(self, one: Numerics, other: Numerics, parts: Sequence[RampPart]) -> tuple[float, float]:
        """Difference of the sum levels in most windows of some parts: of the sensor, and the largest of all [dB]."""
        found = []
        for part in parts:
            # The cheaper one first: where it finds no solution the other one is not asked for.
            first = self.run(one, part)
            second = self.run(other, part) if first is not None else None
            if first is None or second is None:
                return math.inf, math.inf
            found.append(np.abs(second.differences(first)))
        sizes = np.quantile(np.concatenate(found, axis=1), QUANTILE, axis=1)
        return float(sizes[0]), float(sizes.max())

    def finish(self) -> None:
        """Say that no trial will follow."""
        self.tell(self.most, self.most)

    def _counted(self, seconds: float) -> None:
        self.count += 1
        self.seconds += seconds
        self.tell(min(self.count, self.most - 1), self.most)


def _chosen(trials: _Trials, tolerance: float, given: Numerics) -> tuple[Numerics, list[str], float]:
    """The settings that keep the tolerance, how they were found, and the difference that confirms them."""
    parts = trials.ramp.parts
    if len(parts) < LEAST_PARTS:
        raise _CouldNotError(
            f"the ramp has {len(parts)} parts of {MILLISECOND.text(WINDOWS * trials.ramp.window)}, too few to choose "
            f"by and to confirm; taken: {given.text}; take a slower ramp, or a higher --highest"
        )
    by_level = _by_level(trials.ramp, _scouted(trials, tolerance, given))
    fastest = max(parts, key=lambda part: abs(sum(part.speeds)))
    loudest = next(part for part in by_level if part is not fastest)
    used = [loudest, fastest]
    trials.told.append(f"  tried on {_rpm(loudest)} (loudest), {_rpm(fastest)} (fastest)")
    for asked in ([loudest], used):
        difference = _LIMIT * trials.difference(given, _finer(given, given), asked)[0]
        if difference > tolerance:
            break
    words = f"{_decibel(difference)} beside {_finer(given, given).text}"
    if difference <= tolerance:
        return given, [f"  chosen: {given.text}, as the scene has it; confirmed on both parts: {words}"], difference
    trials.told.append(f"  {given.text}, as the scene has it: {words}")
    share, before = 1.0, None
    failed: list[str] = []
    difference = math.nan
    for _ in range(FRESH):
        numerics, lines = _searched(trials, share * tolerance, given, used)
        if numerics == before:
            # Each of them keeps its share, and yet all together do not keep the whole.
            share *= 0.5
            numerics, lines = _searched(trials, share * tolerance, given, used)
        fresh = next((part for part in by_level if not any(_near(part, other) for other in used)), None)
        if fresh is None:
            break
        difference, others = trials.difference(numerics, _finer(numerics, given), [fresh])
        difference, others = _LIMIT * difference, _LIMIT * others
        words = f"{_rpm(fresh)}, not used to choose: {difference:.2g} dB beside {_finer(numerics, given).text}" + (
            f", up to {others:.2g} dB at other sensors" if len(trials.ramp.sensors) > 1 else ""
        )
        if difference <= tolerance:
            return numerics, [*failed, *lines, f"  chosen: {numerics.text}; confirmed on {words}"], difference
        failed.append(f"  {numerics.text} not confirmed on {words}; that part helps to choose now")
        used.append(fresh)
        before = numerics
    trials.told += failed
    raise _CouldNotError(
        f"no settings were confirmed on {len(failed)} parts of the ramp; the last ones that were chosen are taken, "
        f"{numerics.text}",
        numerics,
        difference,
    )


def _scouted(trials: _Trials, tolerance: float, given: Numerics) -> RunSignal | None:
    """The signal of the shortened ramp, made sure that it forgets its start; None where there is no such run."""
    assert trials.subject.scene.run_up is not None
    factor = min(max(SCOUT, LEAST_SCOUT / trials.subject.scene.run_up.duration), 1.0)
    step = min(trials.ramp.coarsest, 4.0 * given.step)
    signal = trials.scout(factor, step)
    nudged = trials.scout(factor, step, NUDGE) if signal is not None else None
    if signal is None or nudged is None:
        return signal
    apart = drift(signal.signal, nudged.signal)
    # A level changes by 8.7 dB times a small relative change of the signal.
    scatter = 20.0 / math.log(10.0) * ROUNDING * math.exp(min(apart / factor, 100.0))
    if scatter > tolerance:
        raise _CouldNotError(
            f"two runs that begin 1 pm apart drift {math.exp(apart):.2g} times farther apart in a run of "
            f"{factor * trials.subject.scene.run_up.duration:.3g} s, so that in the whole one rounding grows to the "
            "size of the signal and no step gives the level at a speed: the run does not forget its start, as rollers "
            f"that lift off without damping do not; taken: {given.text}; compare medians over the ramp, or take a law "
            "with damping",
            given,
        )
    return signal


def drift(signal: FloatArray, other: FloatArray) -> float:
    """Natural logarithm of how much farther apart two signals come between any time and a later one; 0 if they do not.

    Parameters
    ----------
    signal, other : array, shape (samples,)
        Signals that begin next to each other, at least 24 samples.

    Examples
    --------
    >>> import numpy as np
    >>> times = np.linspace(0.0, 1.0, 2401)[:-1]
    >>> round(drift(np.zeros(2400), 1e-9 * np.exp(5.0 * times)), 2)  # from the first to the last of 24 stretches
    4.79
    >>> drift(np.zeros(2400), 1e-9 * np.exp(-5.0 * times))
    0.0
    """
    length = signal.size // _STRETCHES
    apart = (other - signal)[: length * _STRETCHES].reshape(_STRETCHES, length)
    sizes = np.log(np.maximum(np.sqrt(np.mean(apart**2, axis=1)), np.finfo(np.float64).tiny))
    return float(np.max(sizes - np.minimum.accumulate(sizes)))


def _by_level(ramp: Ramp, signal: RunSignal | None) -> list[RampPart]:
    """All parts, the loudest first; from the fastest one on where that is not known."""
    try:
        found = None if signal is None else campbell(signal, 1.0, ramp.highest)
    except InputError:
        found = None  # too short for its spectra
    if found is None:
        return sorted(ramp.parts, key=lambda part: -abs(sum(part.speeds)))
    order = np.argsort(found.speeds)
    speeds, levels = found.speeds[order], found.sum_level[order]

    def highest(part: RampPart) -> float:
        first, last = (abs(speed) for speed in part.speeds)
        return float(np.max(np.interp(np.linspace(first, last, 9), speeds, levels)))

    return sorted(ramp.parts, key=highest, reverse=True)


def _near(part: RampPart, other: RampPart) -> bool:
    """Tell whether two parts are one, or neighbours, whose windows are about the same resonances."""
    return abs(part.begin - other.begin) < 1.5 * (part.end - part.begin)


def _searched(
    trials: _Trials, tolerance: float, given: Numerics, parts: Sequence[RampPart]
) -> tuple[Numerics, list[str]]:
    """The coarsest settings whose differences together keep the tolerance on some parts."""
    lines = []
    numerics, left = given, tolerance
    for key, ladder in _ladders(trials.ramp, given).items():
        share = _SHARES[key] * left
        seen = []
        for value, finer in ladder:
            # What slices and modes do hardly depends on the step, and twice the step costs half.
            tried = numerics if key == "step" else numerics.but(step=min(2.0 * numerics.step, trials.ramp.coarsest))
            one, other = tried.but(**{key: value}), tried.but(**{key: finer})
            difference = trials.difference(one, other, parts)[0] * (1.0 if key == "cutoff" else _LIMIT)
            if difference <= share:
                break
            seen.append(f"{one.words(key)} {_decibel(difference)}")
        else:
            if key == "step":
                raise _CouldNotError(
                    f"the sum level still changes too much by {one.words(key)}, the shortest that is tried: "
                    f"{', '.join(seen)}, allowed {share:.2g} dB",
                    one,
                    difference,
                )
            # All modes there are; or the most slices that are tried, and what they still change.
            one, difference = other, 0.0 if key == "cutoff" else difference / _ORDER
        numerics = numerics.but(**{key: getattr(one, key)})
        left -= difference
        words = _decibel(difference) if difference else "all there are"
        lines.append(f"  {numerics.words(key)}: {words}" + (f" (before: {', '.join(seen)})" if seen else ""))
    return numerics, lines


def _ladders(ramp: Ramp, given: Numerics) -> dict[str, list[tuple[float | int, float | int]]]:
    """Values tried for each setting, from coarse to fine, each with the one that it is compared with."""
    steps = [ramp.coarsest]
    while steps[-1] > given.step * 0.5**HALVINGS * 1.5:
        steps.append(0.5 * steps[-1])
    found: dict[str, list[tuple[float | int, float | int]]] = {"step": _pairs(steps)}
    if given.slices is not None:
        found["slices"] = _pairs(SLICES)
    if given.cutoff is not None:
        cutoffs = [ramp.highest * 2.0 ** (0.5 * k) for k in range(20)]
        found["cutoff"] = [(cutoff, given.cutoff) for cutoff in cutoffs if cutoff < 0.95 * given.cutoff]
    return {key: ladder for key, ladder in found.items() if ladder}


def _pairs(values: Sequence[float | int]) -> list[tuple[float | int, float | int]]:
    """Each value with the next one."""
    return list(pairwise(values))


def _finer(numerics: Numerics, given: Numerics) -> Numerics:
    """Settings that are finer in everything."""
    more = None if numerics.slices is None else 2 * numerics.slices - 1
    return Numerics(0.5 * numerics.step, more, given.cutoff)


def _rpm(part: RampPart) -> str:
    """The speeds of a part in words."""
    first, last = (abs(speed) for speed in part.speeds)
    return f"{RPM.value(first):.4g} to {RPM.text(last)}"


def _decibel(value: float) -> str:
    """A difference in words."""
    return f"{value:.2g} dB" if math.isfinite(value) else "no solution"

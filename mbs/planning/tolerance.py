"""Step and slices of a run-up that keep its sum level within a tolerance: short trials propose, the run confirms.

A trial is the whole ramp in a small part of its time, so that all resonances are passed. Trials with twice and four
times the step of the scene are held side by side, and one with its slices beside one with about twice as many. Where
that keeps the tolerance the settings stay; else one with the step itself is made, the step is halved, and slices are
doubled. Then the run is made. It states the error of its step itself, from parts of it (`mbs.analyses.step_error`), and
that is what confirms the choice, at no cost but that of any run. Where it does not, the run is made again with a
shorter step.

A method of second order whose levels change by d with twice the step is d/3 away from its limit, d/12 with a step that
is half as long as both, and 4/3 d where d is the change by half of it. The step may take three quarters of the
tolerance, slices the rest. Modes of flexible bodies stay as they are: those that a scene has cost less than a trial
would.

A run that does not forget its start, such as one of rollers that lift off without damping, has no level at a speed that
a shorter step would come closer to: what rounding changes grows to the size of the signal. So where the step of the
scene does not keep the tolerance two longer trials are made that begin 1 pm apart. Where they come together all is
well. Where they drift apart between any two times, they do so the longer the slower the ramp is, and rounding with
them.

`tolerated_run` is `--tolerance` of `campbell` and `runup`.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from mbs.analyses.case import Case, Progress, silent
from mbs.analyses.operating import held
from mbs.analyses.ramp import recorded_run
from mbs.analyses.sensors import looked_at
from mbs.analyses.step_error import StepCheck, level_change, up_to, window_sizes
from mbs.model.elements import Sensor
from mbs.scene.changes import cutoff_of, hurried
from mbs.scene.choices import CHOICES
from mbs.scene.fields import HERTZ, MILLISECOND
from mbs.scene.scene import Scene
from mbs.scene.subject import Subject
from mbs.settings import CampbellSettings

LEAST, MOST = 0.01, 20.0
"""Limits of a tolerance [dB]: less is the rounding of the tables of a law over speed, more is no accuracy."""

ALLOWED = f"above 0 dB, from {LEAST:g} dB up to {MOST:g} dB, such as '1 dB'"

WINDOWS = 40
"""Windows of a run, and of a trial, one beside the other, whose levels are looked at."""

QUANTILE = 0.95
"""Part of the windows that have to keep the tolerance."""

HALVINGS = 3
"""How often the step of the scene is halved at most."""

MOST_SLICES = 161
"""Most slices that are tried."""

TRIAL = 1.0 / 24.0
"""Time of a trial, as a part of that of the run-up."""

LEAST_PERIODS = 2.5
"""Fewest periods of the highest frequency in a window of a trial: a short ramp is hurried less, or not at all."""

DRIFT, LEAST_DRIFT = 1.0 / 8.0, 0.25
"""Time of a trial that looks whether runs forget their start, as a part of that of the run-up, and at least [s]."""

NUDGE = 1e-12
"""How far two trials begin apart to see whether they forget it [m or rad]."""

ROUNDING = 1e-13
"""By which part of the signal two runs that have forgotten their start differ: rounding."""

_STRETCHES = 24
"""Into which a trial is cut to see how two of them drift apart."""

_ORDER = 4.0
_STEP_SHARE = 0.75

_PROGRESS = 0.75
"""Part of the error that a run stated with twice the step, above which a shorter one has brought nothing: of second
order it is a quarter. So it is where signals are as small as what restarts of films shake."""

KEYS = ("step", "slices", "cutoff")
"""The fields of `Numerics`, which are names of `mbs.scene.choices.CHOICES`."""

Found = TypeVar("Found")


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
        """A subject with these settings; what they leave open, and what it has already, stays as it is.

        Parameters
        ----------
        subject : Subject
            Scene and law.

        Raises
        ------
        InputError
            If they do not fit the scene.
        """
        had = Numerics.of(subject.scene)
        for key in KEYS:
            value = getattr(self, key)
            subject = subject if value in (None, getattr(had, key)) else CHOICES[key].change(subject, value)
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
        Whether the run has confirmed them.
    confirmed : float
        Error of the level that the run states for its step, with that of the slices by trials [dB]; NaN where none was
        measured.
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
    run: Callable[[Subject], tuple[Found, StepCheck | None]],
    settings: CampbellSettings | None = None,
    progress: Progress | None = None,
) -> tuple[Tolerated, Found]:
    """Choose step and slices so that the sum level of a run-up keeps a tolerance, and make the run.

    Parameters
    ----------
    subject : Subject
        Scene and law.
    tolerance : float
        Difference of the sum level at equal speed from that of finer settings that is allowed, in 95 % of the
        windows [dB].
    run : callable
        Makes the run-up of a subject; its result, and the errors of the step that it states.
    settings : CampbellSettings, optional
        Sensor and highest frequency; [campbell] of the scene if left out.
    progress : callable, optional
        Told how many trials are done, and of how many at most.

    Returns
    -------
    Tolerated, Found
        The choice, with `met` False where it could not be met or not be confirmed; `lines` say why. And the run.

    Raises
    ------
    InputError
        If the tolerance is none, or run, sensor or settings are not possible.
    AnalysisError
        If the bearings find no temperatures at the operating speed, or the run finds no solution.
    """
    if not LEAST <= tolerance <= MOST:
        raise InputError(f"tolerance: got {tolerance!r} dB; allowed: {ALLOWED}")
    settings = settings or subject.scene.campbell
    given = Numerics.of(subject.scene)
    trials = _Trials(subject, looked_at(subject.scene, settings)[0], settings.highest, progress or silent)
    numerics, change, could_not = _chosen(trials, tolerance, given)
    trials.finish()
    lines, before = trials.told, math.inf
    while True:
        chosen = numerics.applied(subject)
        found, check = run(chosen)
        error = math.nan if check is None else float(check.by_level.max(axis=0)[check.names.index(trials.sensor.name)])
        met = not could_not and error + change <= tolerance
        if met or could_not or not error + change > tolerance or numerics.step < 1.5 * _finest(given):
            break
        if error > _PROGRESS * before:
            could_not = (
                f"half of the step leaves {error:.2g} of {before:.2g} dB that the run states: that is no error of "
                "the step alone, and no shorter one is tried"
            )
            break
        before = error
        lines.append(f"  {numerics.words('step')}: {error:.2g} dB by the run, so that it is made again with half of it")
        numerics = numerics.but(step=0.5 * numerics.step)
    same = ", as the scene has it" if numerics == given else ""
    lines.append(f"  chosen: {numerics.text}{same}")
    of_slices = "" if numerics.slices is None else f", slices {change:.2g} dB by trials"
    parts = f"step {error:.2g} dB by parts that it made again{of_slices}"
    if met:
        lines.append(f"  confirmed by the run, its {trials.of_what} within {error + change:.2g} dB: {parts}")
    else:
        reason = could_not or f"the run does not confirm it: {parts}"
        lines.append(f"warning: could not: {reason}")
    lines.append(
        f"  {trials.count} trials of {trials.steps} steps in all took {trials.seconds:.3g} s of processor time"
    )
    head = f"tolerance {tolerance:g} dB of the {trials.of_what}"
    return Tolerated(chosen, numerics, (head, *lines), met, error + change, trials.seconds), found


@dataclass
class _Trials:
    """Trials that were made, none of them twice, and what they cost."""

    subject: Subject
    sensor: Sensor
    highest: float
    tell: Progress
    count: int = 0
    steps: int = 0
    seconds: float = 0.0
    told: list[str] = field(default_factory=list)
    made: dict[tuple[Numerics, float, float], FloatArray | None] = field(default_factory=dict)

    most: int = 12
    """Trials at most, for the progress."""

    @property
    def scene(self) -> Scene:
        """The scene that is tried."""
        return self.subject.scene

    @property
    def of_what(self) -> str:
        """Level that is looked at, in words."""
        assert self.scene.run_up is not None
        window = MILLISECOND.text(self.scene.run_up.duration / WINDOWS)
        return (
            f"sum level of {self.sensor.name} up to {HERTZ.text(self.highest)}, at equal speed in "
            f"{100.0 * QUANTILE:g} % of windows of {window}"
        )

    def factor(self, part: float, least: float) -> float:
        """A part of the time of the run; more of a short one, so that a trial has at least a length [s]."""
        assert self.scene.run_up is not None
        return min(max(part, least / self.scene.run_up.duration), 1.0)

    def run(self, numerics: Numerics, factor: float, nudge: float = 0.0) -> FloatArray | None:
        """The signal of a trial with some settings in a part of the time; None where it finds no solution."""
        key = (numerics, factor, nudge)
        if key not in self.made:
            begin = time.process_time()
            self.made[key] = self._signal(numerics, factor, nudge)
            self.count += 1
            self.seconds += time.process_time() - begin
            self.tell(min(self.count, self.most - 1), self.most)
        return self.made[key]

    def _signal(self, numerics: Numerics, factor: float, nudge: float) -> FloatArray | None:
        subject = numerics.applied(self.subject)
        scene = hurried(subject.scene, factor)
        assert scene.run_up is not None
        try:
            model = held(Subject(scene, subject.law, subject.clearance).model())
            record = recorded_run(model, scene.run_up, (self.sensor,), nudge=nudge)
        except AnalysisError:
            return None  # such a step is too long for it, and says nothing about shorter ones
        self.steps += record.steps
        return record.signals[:, 0] if np.all(np.isfinite(record.signals)) else None

    def difference(self, one: Numerics, other: Numerics) -> float:
        """Difference of the levels of two trials that most windows keep [dB]; infinite where one has no solution."""
        longest = max(one.step, other.step)
        factor = self.factor(TRIAL, WINDOWS * LEAST_PERIODS / self.highest)
        sizes = []
        for numerics in (one, other):
            signal = self.run(numerics, factor)
            if signal is None:
                return math.inf
            seen = up_to(signal[:, None], numerics.step, min(self.highest, 0.25 / longest))
            sizes.append(window_sizes(seen, WINDOWS))
        return float(np.quantile(level_change(*sizes), QUANTILE))

    def finish(self) -> None:
        """Say that no trial will follow."""
        self.tell(self.most, self.most)


def _chosen(trials: _Trials, tolerance: float, given: Numerics) -> tuple[Numerics, float, str]:
    """The settings that keep the tolerance in trials, the error left by their slices [dB], and why they could not."""
    numerics, could_not = given, ""
    twice = given.but(step=2.0 * given.step)
    # Much cheaper than a trial with the step itself, and the run will tell whether it holds.
    error = trials.difference(given.but(step=4.0 * given.step), twice) / (_ORDER - 1.0) / _ORDER
    enough = error <= _STEP_SHARE * tolerance
    while True:
        if not enough:
            error = trials.difference(numerics.but(step=2.0 * numerics.step), numerics) / (_ORDER - 1.0)
        trials.told.append(f"  {numerics.words('step')}: {_decibel(error)}")
        if error <= _STEP_SHARE * tolerance:
            break
        if numerics == given and (could_not := _forgetful(trials, tolerance, given)):
            return given, math.nan, could_not
        if numerics.step < 1.5 * _finest(given):
            could_not = (
                f"the sum level still changes too much by {numerics.words('step')}, the shortest that is tried: "
                f"{_decibel(error)}, allowed {_STEP_SHARE * tolerance:.2g} dB"
            )
            return numerics, math.nan, could_not
        numerics = numerics.but(step=0.5 * numerics.step)
    change = 0.0
    while numerics.slices is not None and 2 * numerics.slices - 1 <= MOST_SLICES:
        # What slices do hardly depends on the step, and twice the step costs half.
        tried = numerics.but(step=2.0 * numerics.step)
        more = tried.but(slices=2 * numerics.slices - 1)
        change = trials.difference(tried, more) * _ORDER / (_ORDER - 1.0)
        trials.told.append(f"  {numerics.words('slices')}: {_decibel(change)}")
        if error + change <= tolerance:
            break
        numerics = numerics.but(slices=more.slices)
    else:
        if error + change > tolerance:
            # A shorter step is no cure for that.
            could_not = (
                f"the sum level still changes too much by slices: {_decibel(change)} up to {numerics.words('slices')}"
            )
    return numerics, change, could_not


def _forgetful(trials: _Trials, tolerance: float, given: Numerics) -> str:
    """Say that runs do not forget their start; empty where they do, and where that is not known."""
    tried = given.but(step=2.0 * given.step)
    factor = trials.factor(DRIFT, LEAST_DRIFT)
    signal, nudged = trials.run(tried, factor), trials.run(tried, factor, NUDGE)
    if signal is None or nudged is None:
        return ""
    apart = drift(signal, nudged)
    # A level changes by 8.7 dB times a small relative change of the signal.
    scatter = 20.0 / math.log(10.0) * ROUNDING * math.exp(min(apart / factor, 100.0))
    if scatter <= tolerance:
        return ""
    assert trials.scene.run_up is not None
    return (
        f"two runs that begin 1 pm apart drift {math.exp(apart):.2g} times farther apart in a run of "
        f"{factor * trials.scene.run_up.duration:.3g} s, so that in the whole one rounding grows to the "
        "size of the signal and no step gives the level at a speed: the run does not forget its start, as rollers "
        f"that lift off without damping do not; taken: {given.text}; compare medians over the ramp, or take a law "
        "with damping"
    )


def _finest(given: Numerics) -> float:
    """Shortest step that is tried [s]."""
    return given.step * 0.5**HALVINGS


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


def _decibel(value: float) -> str:
    """A difference in words."""
    return f"{value:.2g} dB" if math.isfinite(value) else "no solution"


def asked_tolerance(arguments: argparse.Namespace, problems: list[str]) -> float | None:
    """Read the level of --tolerance [dB]; None where there is none.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    problems : list of str
        Appended to.
    """
    text = getattr(arguments, "tolerance", None)
    if text is None:
        return None
    try:
        return read_tolerance(text)
    except InputError as error:
        problems.append(f"--tolerance: {error.problems[0]}")
    return None


def several_problems(tolerance: float | None, cases: Sequence[Case]) -> list[str]:
    """List problems with a tolerance of several cases.

    Parameters
    ----------
    tolerance : float or None
        The tolerance [dB].
    cases : sequence of Case
        The cases.
    """
    if tolerance is None or len(cases) == 1:
        return []
    return [
        f"--tolerance: got {len(cases)} combinations of laws, films and the like; allowed: one, for which step "
        "and slices are chosen"
    ]


def tolerated_run(
    cases: Sequence[Case],
    tolerance: float | None,
    run: Callable[[list[Case]], tuple[Found, StepCheck | None]],
    settings: CampbellSettings | None = None,
    progress: Progress | None = None,
) -> tuple[Found, Tolerated | None]:
    """Make a run, with the settings that are chosen for a tolerance; as cases came without one.

    Parameters
    ----------
    cases : sequence of Case
        The cases; one alone beside a tolerance.
    tolerance : float or None
        The tolerance [dB].
    run : callable
        Runs cases; the result, and the errors of its step.
    settings : CampbellSettings, optional
        What is looked at; if left out the sensor of [campbell] and all frequencies. Then the states of the run are
        recorded as seldom as the scene says, to a whole step.
    progress : callable, optional
        Told how many trials are done, and of how many at most.

    Raises
    ------
    InputError, AnalysisError
        As `mbs.planning.tolerance.within` does.
    """
    subject = cases[0].subject
    if tolerance is None or subject is None:
        return run(list(cases))[0], None
    given = subject.scene.run_up
    seldom = settings is None
    if settings is None:
        # What twice the step has samples for.
        highest = 0.25 / given.settings.step if given is not None else subject.scene.campbell.highest
        settings = dataclasses.replace(subject.scene.campbell, highest=highest)

    def made(changed: Subject) -> tuple[Found, StepCheck | None]:
        course = changed.scene.run_up
        if seldom and given is not None and course is not None:
            step = course.settings.step
            sample = step * max(round(given.settings.sample / step), 1)
            course = dataclasses.replace(course, settings=dataclasses.replace(course.settings, sample=sample))
            changed = dataclasses.replace(changed, scene=dataclasses.replace(changed.scene, run_up=course))
        return run([dataclasses.replace(cases[0], model=changed.model(), subject=changed)])

    tolerated, found = within(subject, tolerance, made, settings, progress)
    return found, tolerated

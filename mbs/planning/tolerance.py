"""Step and slices of a run-up that keep its sum level within a tolerance: the run itself says whether they do.

A run states the error of its step from parts of it that it makes again (`mbs.analyses.step_error`), at no cost but that
of any run. Where that takes more than three quarters of the tolerance the run is made again with half the step. The
rest is for slices, which are tried: the whole ramp in a small part of its time, so that all resonances are passed, with
twice the step. A trial with the slices is held beside one with about twice as many; where they have to be more the run
is made once more. Of second order in the slices, 4/3 d is the error where d is the change by half of their width. Modes
of flexible bodies stay as they are.

A run that does not forget its start, such as one of rollers that lift off without damping, has no level at a speed that
a shorter step would come closer to: what rounding changes grows to the size of the signal. Half the step brings nothing
there, and no shorter one is tried.

`tolerated_run` is `--tolerance` of `campbell` and `runup`.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError, Problems
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

_ORDER = 4.0
_STEP_SHARE = 0.75
_MOST_TRIALS = 9

_PROGRESS = 0.75
"""Part of the error that a run stated with twice the step, above which a shorter one has brought nothing: of second
order it is a quarter. So it is where signals are as small as what restarts of films shake."""

Found = TypeVar("Found")


class Numerics(NamedTuple):
    """Choices of a user about accuracy of a run-up, by their names in `mbs.scene.choices.CHOICES`.

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
        for key, had, value in zip(self._fields, Numerics.of(subject.scene), self, strict=True):
            subject = subject if value in (None, had) else CHOICES[key].change(subject, value)
        return subject

    def words(self, *keys: str) -> str:
        """The settings, or some of them, in words, such as "step 10 us, 21 slices, modes up to 8000 Hz".

        Parameters
        ----------
        *keys : str
            Names of fields; all if left out.
        """
        named = zip(self._fields, self, strict=True)
        return ", ".join(
            CHOICES[key].words(value) for key, value in named if value is not None and key in (keys or self._fields)
        )


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
    """

    subject: Subject
    numerics: Numerics
    lines: tuple[str, ...]
    met: bool
    confirmed: float


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
    number = text.strip()
    try:
        value = float(number.removesuffix("dB")) if number.endswith("dB") else math.nan
    except ValueError:
        value = math.nan
    if not LEAST <= value <= MOST:
        raise InputError(f"--tolerance: got {text!r:.60}; allowed: {ALLOWED}")
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
    given = numerics = Numerics.of(subject.scene)
    trials = _Trials(subject, looked_at(subject.scene, settings)[0], settings.highest, progress or silent)
    allowed = tolerance * (1.0 if given.slices is None else _STEP_SHARE)
    change, before, could_not, lines = 0.0, math.inf, "", list[str]()
    while True:
        found, error = trials.made(run, numerics)
        step = numerics.words("step")
        if not error > allowed:
            break
        if error > _PROGRESS * before:
            could_not = (
                f"half of the step leaves {error:.2g} of {before:.2g} dB that the run states: that is no error of "
                "the step alone, and no shorter one is tried; where rollers lift off without damping the run does not "
                "forget its start: compare medians over the ramp, or take a law with damping"
            )
        elif numerics.step < 1.5 * given.step * 0.5**HALVINGS:
            could_not = f"the sum level still changes too much by {step}, the shortest that is tried: {error:.2g} dB"
        if could_not:
            break
        lines.append(f"  {step}: {error:.2g} dB by the run, so that it is made again with half of it")
        before, numerics = error, numerics._replace(step=0.5 * numerics.step)
    if error <= allowed:
        more, change, tried = _with_slices(trials, tolerance - error, numerics)
        lines += tried
        if error + change > tolerance:
            could_not = (
                f"the sum level still changes too much by slices: {_decibel(change)} up to {more.words('slices')}"
            )
        elif more != numerics:
            numerics, (found, error) = more, trials.made(run, more)
    met = not could_not and error + change <= tolerance
    lines.append(f"  chosen: {numerics.words()}{', as the scene has it' if numerics == given else ''}")
    of_slices = f", slices {change:.2g} dB by trials" if trials.count else ""
    parts = f"step {error:.2g} dB by parts that it made again{of_slices}"
    lines.append(
        f"  confirmed by the run, its {trials.of_what} within {error + change:.2g} dB: {parts}"
        if met
        else f"warning: could not: {could_not or f'the run does not confirm it: {parts}'}"
    )
    if trials.count:
        lines.append(
            f"  {trials.count} trials of {trials.steps} steps in all took {trials.seconds:.3g} s of processor time"
        )
    head = f"tolerance {tolerance:g} dB of the {trials.of_what}"
    return Tolerated(numerics.applied(subject), numerics, (head, *lines), met, error + change), found


@dataclass
class _Trials:
    """Runs, and trials of slices with twice the step, and what these cost."""

    subject: Subject
    sensor: Sensor
    highest: float
    tell: Progress
    count: int = 0
    steps: int = 0
    seconds: float = 0.0

    @property
    def of_what(self) -> str:
        """Level that is looked at, in words."""
        assert self.subject.scene.run_up is not None  # `Numerics.of` saw to it
        window = MILLISECOND.text(self.subject.scene.run_up.duration / WINDOWS)
        return (
            f"sum level of {self.sensor.name} up to {HERTZ.text(self.highest)}, at equal speed in "
            f"{100.0 * QUANTILE:g} % of windows of {window}"
        )

    def made(self, run: Callable[[Subject], tuple[Found, StepCheck | None]], numerics: Numerics) -> tuple[Found, float]:
        """A run with some settings, and the error of its step that it states [dB], NaN where it states none."""
        found, check = run(numerics.applied(self.subject))
        if check is None:
            return found, math.nan
        return found, float(check.by_level.max(axis=0)[check.names.index(self.sensor.name)])

    def sizes(self, numerics: Numerics) -> FloatArray:
        """Sizes of the signal in the windows of a trial; NaN where it finds no solution."""
        subject = numerics.applied(self.subject)
        assert subject.scene.run_up is not None
        # More of a short run, so that windows have some periods.
        least = WINDOWS * LEAST_PERIODS / self.highest / subject.scene.run_up.duration
        scene = hurried(subject.scene, min(max(TRIAL, least), 1.0))
        assert scene.run_up is not None
        self.count += 1
        self.tell(min(self.count, _MOST_TRIALS), _MOST_TRIALS)
        begin = time.process_time()
        try:
            model = held(dataclasses.replace(subject, scene=scene).model())
            record = recorded_run(model, scene.run_up, (self.sensor,))
        except AnalysisError:
            return np.full((WINDOWS, 1), np.nan)
        self.steps, self.seconds = self.steps + record.steps, self.seconds + time.process_time() - begin
        return window_sizes(up_to(record.signals, numerics.step, min(self.highest, 0.25 / numerics.step)), WINDOWS)


def _with_slices(trials: _Trials, allowed: float, chosen: Numerics) -> tuple[Numerics, float, list[str]]:
    """Slices that keep an error, the error that they leave [dB], and what was tried."""
    # What slices do hardly depends on the step, and twice the step costs half.
    numerics, change, lines, sizes = chosen._replace(step=2.0 * chosen.step), 0.0, [], None
    while numerics.slices is not None and 2 * numerics.slices - 1 <= MOST_SLICES:
        sizes = trials.sizes(numerics) if sizes is None else sizes
        more = numerics._replace(slices=2 * numerics.slices - 1)
        finer = trials.sizes(more)
        change = float(np.quantile(level_change(sizes, finer), QUANTILE)) * _ORDER / (_ORDER - 1.0)
        change = math.inf if math.isnan(change) else change
        lines.append(f"  {numerics.words('slices')}: {_decibel(change)}")
        if change <= allowed:
            break
        numerics, sizes = more, finer
    if trials.count:
        trials.tell(_MOST_TRIALS, _MOST_TRIALS)
    return numerics._replace(step=chosen.step), change, lines


def _decibel(value: float) -> str:
    """A difference in words."""
    return f"{value:.2g} dB" if math.isfinite(value) else "no solution"


def asked_tolerance(arguments: argparse.Namespace, problems: Problems) -> float | None:
    """Read the level of --tolerance [dB]; None where there is none.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    problems : Problems
        Appended to.
    """
    text, value = getattr(arguments, "tolerance", None), None
    with problems:
        value = None if text is None else read_tolerance(text)
    return value


def several_problems(tolerance: float | None, cases: Sequence[Case]) -> list[str]:
    """List problems with a tolerance of several cases.

    Parameters
    ----------
    tolerance : float or None
        The tolerance [dB].
    cases : sequence of Case
        The cases.
    """
    wrong = tolerance is not None and len(cases) > 1
    return [
        f"--tolerance: got {len(cases)} combinations of laws, films and the like; allowed: one, for which step "
        "and slices are chosen"
    ] * wrong


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
    given, asked = subject.scene.run_up, settings
    if asked is None:
        # What twice the step has samples for.
        highest = 0.25 / given.settings.step if given is not None else subject.scene.campbell.highest
        asked = dataclasses.replace(subject.scene.campbell, highest=highest)

    def made(changed: Subject) -> tuple[Found, StepCheck | None]:
        course = changed.scene.run_up
        if settings is None and given is not None and course is not None:
            sample = course.settings.step * max(round(given.settings.sample / course.settings.step), 1)
            course = dataclasses.replace(course, settings=dataclasses.replace(course.settings, sample=sample))
            changed = dataclasses.replace(changed, scene=dataclasses.replace(changed.scene, run_up=course))
        return run([dataclasses.replace(cases[0], model=changed.model(), subject=changed)])

    tolerated, found = within(subject, tolerance, made, asked, progress)
    return found, tolerated

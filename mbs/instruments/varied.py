"""Table of what comparisons vary, one row a key: how values are read and told, what each changes; numerical settings.

A key more is a row more of `VARIED`.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

from ehdmaps.errors import InputError
from ehdmaps.jobs.supply import supply_from_text
from ehdmaps.physics.contact import OIL_TEMPERATURES
from ehdmaps.units import TEMPERATURE, Display, closest, quantity
from mbs.analyses.case import LawChoice, Subject
from mbs.model.relaxation import Films
from mbs.scene import changes
from mbs.scene.changes import cutoff_of
from mbs.scene.contact_laws import law_label
from mbs.scene.fields import DEGREE, HERTZ, MICROMETRE
from mbs.scene.scene import Scene

Value = float | int | str

WIDEST = 1e-2
"""Largest clearance, either way [m]."""

MOST_FACTOR = 1e3
MOST_SLICES = 10_000

_SECOND, _MICROSECOND = Display("s"), Display("us", 1e6)


@dataclass(frozen=True)
class VariedKey:
    """Something that a comparison varies.

    Attributes
    ----------
    name : str
        Name of the key, as --vary takes it.
    example : str
        A value, for people.
    of : {"both", "first", "films"}
        Which of the compared laws it concerns: both, the reference, or those with films.
    read : callable
        Reader of a text, which gives a value; raises `InputError` with what was got and what is allowed.
    text : callable
        A value for people.
    change : callable
        A subject with that value; raises `InputError` where it does not fit.
    """

    name: str
    example: str
    of: Literal["both", "first", "films"]
    read: Callable[[str], Value]
    text: Callable[[Value], str]
    change: Callable[[Subject, Value], Subject]

    def changed(self, subject: Subject, value: Value, first: bool) -> Subject:
        """A subject with a value of this key; the same where the key does not concern it.

        Parameters
        ----------
        subject : Subject
            Scene and law.
        value : float, int or str
            What `read` gives.
        first : bool
            Whether it is the reference.

        Raises
        ------
        InputError
            Where the value does not fit the scene.
        """
        concerned = self.of == "both" or (first if self.of == "first" else subject.law.has_films)
        return self.change(subject, value) if concerned else subject


def _between(unit: str, low: float, high: float, display: Display) -> Callable[[str], Value]:
    """A reader of a quantity."""

    def read(text: str) -> Value:
        value = quantity(text, unit)
        if not low <= value <= high:
            raise InputError(f"got {text!r:.60}; allowed: {display.text(low)} to {display.text(high)}")
        return value

    return read


def _either_way(unit: str, most: float, words: str) -> Callable[[str], Value]:
    """A reader of a quantity of either sign."""

    def read(text: str) -> Value:
        value = quantity(text, unit)
        if not abs(value) <= most:
            raise InputError(f"got {text!r:.60}; allowed: {words}")
        return value

    return read


def _factor(text: str) -> Value:
    """Read a factor."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value <= MOST_FACTOR:
        raise InputError(f"got {text!r:.40}; allowed: above 0 up to {MOST_FACTOR:g}, such as 1.5")
    return value


def _slices(text: str) -> Value:
    """Read a number of slices."""
    if not (text.isdecimal() and len(text) < 10 and 1 <= int(text) <= MOST_SLICES):
        raise InputError(f"got {text!r:.40}; allowed: a whole number from 1 to {MOST_SLICES}")
    return int(text)


def _films(text: str) -> Value:
    """Read the kind of the films."""
    if text not in get_args(Films):
        raise InputError(f"got {text!r:.60}{closest(text, get_args(Films))}; allowed: {', '.join(get_args(Films))}")
    return text


def _with_films(subject: Subject, value: Value) -> Subject:
    """A subject with other films."""
    films: Films = "memory" if value == "memory" else "slow"
    return dataclasses.replace(subject, law=dataclasses.replace(subject.law, films=films))


def _supply(text: str) -> Value:
    """Read an oil supply; the value is its text."""
    supply_from_text(text)
    return text


def _with_supply(subject: Subject, value: Value) -> Subject:
    """A subject with another oil supply of all bearings."""
    law = dataclasses.replace(subject.law, supply=supply_from_text(str(value)))
    return dataclasses.replace(subject, law=law)


def _with_law(subject: Subject, value: Value) -> Subject:
    """A subject with another law, without a map."""
    return dataclasses.replace(subject, law=LawChoice(law_label(str(value)), str(value)))


def _of_scene(change: Callable[[Scene, float], Scene]) -> Callable[[Subject, Value], Subject]:
    """A change of the scene by a number."""
    return lambda subject, value: dataclasses.replace(subject, scene=change(subject.scene, float(value)))


def _shown(display: Display) -> Callable[[Value], str]:
    """Tell a value by its display."""
    return lambda value: display.text(float(value))


def _times(value: Value) -> str:
    """Tell a factor."""
    return f"{value:g} x"


VARIED = {
    key.name: key
    for key in (
        VariedKey(
            "clearance",
            "15 um",
            "both",
            _either_way("m", WIDEST, f"within {MICROMETRE.text(WIDEST)} either way"),
            _shown(MICROMETRE),
            lambda subject, value: dataclasses.replace(subject, clearance=float(value)),
        ),
        # Laws without films know no oil, so that their run is the same.
        VariedKey(
            "temperature",
            "100 degC",
            "films",
            _between("K", *OIL_TEMPERATURES, TEMPERATURE),
            _shown(TEMPERATURE),
            _of_scene(changes.with_temperature),
        ),
        VariedKey("films", "slow", "films", _films, str, _with_films),
        VariedKey("supply", "oil air", "films", _supply, str, _with_supply),
        VariedKey("housing-damping", "0.5", "both", _factor, _times, _of_scene(changes.with_housing_damping)),
        VariedKey(
            "ramp",
            "10 s",
            "both",
            _between("s", 1e-9, 1e6, _SECOND),
            _shown(_SECOND),
            _of_scene(changes.with_duration),
        ),
        VariedKey(
            "start-angle",
            "7.5 deg",
            "both",
            _either_way("rad", 2.0 * math.pi, "a turn either way, such as '7.5 deg'"),
            _shown(DEGREE),
            _of_scene(changes.with_start_angle),
        ),
        VariedKey("load-factor", "1.5", "both", _factor, _times, _of_scene(changes.with_loads)),
        VariedKey(
            "step",
            "5 us",
            "both",
            _between("s", 1e-9, 1.0, _MICROSECOND),
            _shown(_MICROSECOND),
            _of_scene(changes.with_step),
        ),
        VariedKey(
            "slices",
            "41",
            "both",
            _slices,
            str,
            lambda subject, value: dataclasses.replace(subject, scene=changes.with_slices(subject.scene, int(value))),
        ),
        VariedKey(
            "cutoff",
            "6 kHz",
            "both",
            _between("Hz", 1.0, 1e6, HERTZ),
            _shown(HERTZ),
            _of_scene(changes.with_cutoff),
        ),
        VariedKey("law", "hertz:1.25e-5 s", "first", str, lambda value: law_label(str(value)), _with_law),
    )
}
"""What can be varied, by its key."""


KEYS = ("step", "slices", "cutoff")
"""The fields of `Numerics`, which are keys of `mbs.instruments.varied.VARIED`."""


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
            subject = subject if value is None else VARIED[key].change(subject, value)
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
        if value is None:
            return ""
        text = VARIED[key].text(value)
        return {"step": f"step {text}", "slices": f"{text} slices", "cutoff": f"modes up to {text}"}[key]

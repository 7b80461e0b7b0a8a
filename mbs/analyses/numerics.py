"""The numerical settings of a run-up: time step, slices of the rollers, cut-off of flexible bodies."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

from ehdmaps.errors import InputError
from mbs.analyses.case import Subject
from mbs.analyses.varied import VARIED
from mbs.scene.changes import cutoff_of
from mbs.scene.scene import Scene

KEYS = ("step", "slices", "cutoff")
"""The fields of `Numerics`, which are keys of `mbs.analyses.varied.VARIED`."""


@dataclass(frozen=True)
class Numerics:
    """What a user chooses about accuracy of a run-up.

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

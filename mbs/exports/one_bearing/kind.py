"""A kind of bearing as C sources and units: what differs between kinds is a row."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from mbs.bearings.locating.normal_law import PairLaw
from mbs.exports.one_bearing.speed_laws import STEP, SpeedLaws, dry_speed_laws, film_speed_laws


@dataclass(frozen=True)
class ExportKind:
    """Sources and units of a kind of bearing: what they have of their own.

    Attributes
    ----------
    words : str
        How a bearing is called in messages.
    title : callable
        (geometry) -> what a unit is.
    element : str
        What stands before names that begin with no letter.
    files : str
        Begin of the names of its templates, `FILES_bearing` and `FILES_films`.
    kernel : tuple of str
        Files of the kernel beside the laws of contacts, `.h` and `.c`.
    mirrored : callable
        (geometry) -> whether it carries along -x alone.
    public, private : callable
        (force) -> constants that callers may read, and those that only the functions read.
    play : callable
        (geometry) -> play of the export, as `ehd_bearing_make` has it [m].
    motion : tuple of str
        Axes, signs and what is left out of a unit, for people.
    slow, memory : str
        What units without and with memory say.
    film_kernel : tuple of str
        Further files of the kernel for films with memory.
    own_words : mapping
        Words of variables that differ, by their names.
    play_name : str
        Name of the variable of the play.
    dry_approach : callable or None
        (force) -> approach [m] of a dry contact by its load [N]; None for that of balls.
    step : float
        Largest distance of two speeds in ln u.
    of_largest : bool
        Whether errors of the damping are told as parts of its largest value.
    """

    words: str
    title: Callable[[Any], str]
    element: str
    files: str
    kernel: tuple[str, ...]
    mirrored: Callable[[Any], bool]
    public: Callable[[Any], str]
    private: Callable[[Any], str]
    play: Callable[[Any], float]
    motion: tuple[str, ...]
    slow: str
    memory: str
    film_kernel: tuple[str, ...] = ()
    own_words: Mapping[str, str] = field(default_factory=dict)
    play_name: str = "clearance"
    dry_approach: Callable[[Any], Callable[[float], float]] | None = None
    step: float = STEP
    of_largest: bool = False

    def speed_laws(
        self,
        force: Any,
        films: Callable[[float], PairLaw] | None = None,
        ends: tuple[float, float] = (0.0, 0.0),
        *,
        memory: bool = False,
    ) -> SpeedLaws:
        """Laws of the contacts over the speed.

        Parameters
        ----------
        force : BallForce or TaperedForce
            The bearing, dry.
        films : callable, optional
            Law with the films of an entrainment speed [m/s]; dry contacts if left out.
        ends : (float, float)
            Lowest and highest of these speeds [m/s], > 0.
        memory : bool
            Whether films have a memory.

        Raises
        ------
        SolverError, InputError
            If a speed has no films, or none over frequency for a memory.
        """
        if films is None:
            return dry_speed_laws(*force.dry_law.sides)
        dry = None if self.dry_approach is None else self.dry_approach(force)
        return film_speed_laws(films, *ends, shorter=force.shorter if memory else (), dry=dry, step=self.step)

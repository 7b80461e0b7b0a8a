"""A simulated hammer test of a scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ehdmaps.errors import InputError
from mbs.analyses.film_errors import film_errors
from mbs.analyses.operating import operating
from mbs.analyses.progress import Progress, silent
from mbs.linearised.modes import Modes, modes
from mbs.linearised.steady import steady_system
from mbs.linearised.validity import FilmError
from mbs.modal.records import Hits
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.scene.assembly import Model
from mbs.scene.scene import Scene
from mbs.transient.hammer import HammerTest, linear_hits, nonlinear_hits, suggested_duration

HIGHEST = 5000.0
"""Highest frequency of a scene that names none [Hz]."""


@dataclass(frozen=True)
class HammerSettings:
    """How a scene is hit.

    Attributes
    ----------
    highest : float or None
        Highest frequency of interest [Hz]; None for that of [linear] in the scene, else `HIGHEST`.
    duration : float or None
        Length of a record [s]; None for as long as the slowest mode needs to decay.
    hits : int
        Number of hits at each input of the scene.
    noise : float
        Standard deviation over the peak of a channel.
    seed : int
        Seed of heights and noise.
    nonlinear : bool
        Whether the nonlinear system is integrated for each hit, instead of the one linearised at the equilibrium.
    """

    highest: float | None = None
    duration: float | None = None
    hits: int = 8
    noise: float = 0.01
    seed: int = 0
    nonlinear: bool = False


@dataclass(frozen=True, eq=False)
class HammerResult:
    """Records of a simulated test.

    Attributes
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium at which the system is hit, gear meshes with their mean stiffness.
    modes : Modes
        Modes of the same system linearised there: what a test should find.
    test : HammerTest
        How the test was made.
    hits : tuple of Hits
        Records of force and responses, one an input; `mbs.modal.fit` takes them.
    errors : tuple of FilmError
        How wrong the films of each bearing are estimated to be; empty for laws without films.
    outside_hits : mapping of str to int
        How often each element was evaluated outside its map during nonlinear hits, by name.
    """

    model: Model
    balance: Equilibrium
    modes: Modes
    test: HammerTest
    hits: tuple[Hits, ...]
    errors: tuple[FilmError, ...]
    outside_hits: Mapping[str, int]


def hammer(model: Model, settings: HammerSettings | None = None, progress: Progress | None = None) -> HammerResult:
    """Hit a scene at its inputs, and record its sensors.

    Parameters
    ----------
    model : Model
        Scene with its law, with inputs and sensors.
    settings : HammerSettings, optional
        How it is hit.
    progress : callable, optional
        Told how many hits of a nonlinear test are done, and of how many.

    Raises
    ------
    InputError
        With everything that is missing or not possible.
    AnalysisError
        If there is no equilibrium, or a time step finds no solution.

    Examples
    --------
    >>> from mbs import HammerSettings, assemble, hammer, read_scene
    >>> model = assemble(read_scene("nu308_rigid"))
    >>> found = hammer(model, HammerSettings(hits=2, duration=0.05))
    >>> len(found.hits), found.test.samples
    (1, 1280)
    """
    settings = settings or HammerSettings()
    scene = model.scene
    missing = hammer_problems(scene)
    if missing:
        raise InputError(missing)
    model = operating(model, model.operation.speed)
    balance = equilibrium(steady_system(model.system), model.operation)
    found = modes(balance)
    highest = settings.highest or (scene.frequencies[-1] if scene.frequencies else HIGHEST)
    duration = settings.duration or suggested_duration(found, highest)
    test = HammerTest(highest, duration, settings.hits, settings.noise, settings.seed)
    hits, outside = _hit(model, balance, test, settings.nonlinear, progress or silent)
    return HammerResult(
        model=model,
        balance=balance,
        modes=found,
        test=test,
        hits=hits,
        errors=tuple(film_errors(model, balance.displacement, balance.operation)),
        outside_hits=outside,
    )


def hammer_problems(scene: Scene) -> list[str]:
    """What a scene lacks for a hammer test.

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    return [
        f"{scene.name}: [[{key}]] missing; a hammer test needs {words}"
        for key, there, words in (
            ("inputs", scene.inputs, "places to hit"),
            ("sensors", scene.sensors, "at least one sensor"),
        )
        if not there
    ]


def _hit(
    model: Model, balance: Equilibrium, test: HammerTest, nonlinear: bool, tell: Progress
) -> tuple[tuple[Hits, ...], dict[str, int]]:
    """Make the hits; with how often each element was outside its map."""
    inputs, sensors = tuple(model.scene.inputs), tuple(model.scene.sensors)
    if not nonlinear:
        return linear_hits(balance, inputs, sensors, test), {}
    done, total = 0, test.hits * len(inputs)

    def told() -> None:
        nonlocal done
        done += 1
        tell(done, total)

    tell(0, total)
    return nonlinear_hits(balance, inputs, sensors, test, told)

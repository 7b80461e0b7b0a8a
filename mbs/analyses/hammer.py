"""A simulated hammer test of a scene."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ehdmaps.errors import AnalysisError, Problems
from mbs.analyses.case import Case, Failed, Progress, Workers, side_by_side, silent
from mbs.analyses.film_errors import film_errors
from mbs.analyses.operating import operating
from mbs.analyses.soundness import findings_at_rest, with_findings
from mbs.linearised.averaged import steady_system
from mbs.linearised.modes import Modes, modes
from mbs.linearised.validity import FilmError
from mbs.modal.records import Hits
from mbs.model.equilibrium import Equilibrium, equilibrium
from mbs.model.findings import Finding
from mbs.output.files import described
from mbs.scene.assembly import Model, law_attributes
from mbs.scene.scene import Scene
from mbs.transient.hammer import HammerTest, linear_hits, nonlinear_hits, suggested_duration

if TYPE_CHECKING:
    import xarray as xr

    from mbs.output.files import Figure

HIGHEST = 5000.0
"""Highest frequency of a scene that names none [Hz]."""


@dataclass(frozen=True)
class HammerSettings:
    """Settings by which a scene is hit.

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
    findings : tuple of Finding
        What is beyond the laws of its bearings at the equilibrium.
    """

    model: Model
    balance: Equilibrium
    modes: Modes
    test: HammerTest
    hits: tuple[Hits, ...]
    errors: tuple[FilmError, ...]
    outside_hits: Mapping[str, int]
    findings: tuple[Finding, ...] = ()

    @cached_property
    def dataset(self) -> xr.Dataset:
        """Records of force and responses over time, for each input of the scene and each hit."""
        import xarray as xr

        sensors = self.model.scene.sensors
        found = xr.Dataset(
            {
                "force": (
                    ("input", "hit", "time"),
                    np.stack([entry.force for entry in self.hits]),
                    {"units": "N", "long_name": "force of the hammer, or its moment in N m"},
                ),
                "response": (
                    ("input", "hit", "sensor", "time"),
                    np.stack([entry.response for entry in self.hits]),
                    {"units": "SI", "long_name": "response, in the unit of the quantity of its sensor"},
                ),
                "quantity": ("sensor", [sensor.quantity for sensor in sensors]),
            },
            {
                "input": [entry.name for entry in self.model.scene.inputs],
                "sensor": [sensor.name for sensor in sensors],
                "time": ("time", self.hits[0].step * np.arange(self.hits[0].force.shape[1]), {"units": "s"}),
            },
        )
        return with_findings(described(found, **law_attributes(self.model)), self.findings)

    def plot(self) -> Figure:
        """Figure of the frequency responses that the hits give, by H1 up to the highest frequency of interest."""
        from mbs.modal.estimation import estimate, needed_decay
        from mbs.output.response_plot import Curves, response_figure

        decay = max(needed_decay(entry.response, entry.step) for entry in self.hits)
        found = estimate(self.hits, "h1", decay).responses
        inside = (found.frequency > 0.0) & (found.frequency <= self.test.highest)
        scene = self.model.scene
        rows = found.response[:, inside].reshape(len(scene.inputs), len(scene.sensors), -1)
        curves = Curves("hits", found.frequency[inside], np.moveaxis(rows, 2, 0).swapaxes(1, 2))
        return response_figure(self.model, curves, ["responses of simulated hits, with their noise"])


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
    >>> model = assemble(read_scene("nu308_rigid"), "hertz")
    >>> found = hammer(model, HammerSettings(hits=2, duration=0.05))
    >>> len(found.hits), found.test.samples
    (1, 1280)
    """
    tell = progress or silent
    prepared = _prepare(model, settings or HammerSettings())
    total = _size(prepared)

    def told(done: int) -> None:
        if prepared.nonlinear:
            tell(done, total)

    told(0)
    return _result(prepared, *_hit(prepared, told))


class Hammers(NamedTuple):
    """Tests of one scene with several laws.

    Attributes
    ----------
    labels : tuple of str
        What each is called.
    results : tuple of HammerResult
        Those that came to the end.
    failed : tuple of str
        Why the others did not, each with its label.
    """

    labels: tuple[str, ...]
    results: tuple[HammerResult, ...]
    failed: tuple[str, ...]


def hammers(
    cases: Sequence[Case],
    settings: HammerSettings | None = None,
    progress: Progress | None = None,
    *,
    workers: Workers = 1,
) -> Hammers:
    """Hit one scene with several laws, each with the same heights and noise.

    Parameters
    ----------
    cases : sequence of Case
        Models, with their labels.
    settings : HammerSettings, optional
        How each is hit. A duration that is left out is that of each law's own slowest mode.
    progress : callable, optional
        Told how many hits are done, and of how many, over all laws.
    workers : int or concurrent.futures.Executor
        Number of processes among which the laws are divided, or what computes them in their place.

    Raises
    ------
    InputError
        As `hammer` does.
    AnalysisError
        If no law has a result.

    Examples
    --------
    >>> from mbs import Case, HammerSettings, assemble, read_scene
    >>> scene = read_scene("nu308_rigid")
    >>> cases = [Case(law, assemble(scene, law), 0.0) for law in ("hertz", "constant:hertz")]
    >>> hammers(cases, HammerSettings(hits=1, duration=0.05)).labels
    ('hertz', 'constant:hertz')
    """
    prepared: dict[int, _Prepared] = {}
    failed: dict[int, str] = {}
    found: dict[int, HammerResult] = {}

    def lost(index: int, error: Exception) -> None:
        if not (isinstance(error, AnalysisError) and cases[1:]):
            raise error
        failed[index] = f"{cases[index].label}: {error}"

    for index, case in enumerate(cases):
        try:
            prepared[index] = _prepare(case.model, settings or HammerSettings())
        except AnalysisError as error:
            lost(index, error)
    places = list(prepared)
    made = side_by_side(
        _hit,
        list(prepared.values()),
        [_size(prepared[index]) for index in places],
        workers,
        progress,
        lambda place: cases[places[place]].label,
    )
    for index, each in zip(places, made, strict=True):
        if isinstance(each, Failed):
            lost(index, each.error)
        else:
            found[index] = _result(prepared[index], *each)
    words = tuple(failed[index] for index in sorted(failed))
    if not found:
        raise AnalysisError("\n".join(f"warning: {line}" for line in words))
    return Hammers(tuple(cases[index].label for index in found), tuple(found.values()), words)


def hammer_problems(scene: Scene) -> list[str]:
    """List what a scene lacks for a hammer test.

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
    ] + [
        f"{scene.name}: input {entry.name!r} is a gear mesh; allowed: a place of a body, which a hammer can hit"
        for entry in scene.inputs
        if not entry.places
    ]


class _Prepared(NamedTuple):
    """A model at the equilibrium at which it is hit."""

    model: Model
    balance: Equilibrium
    modes: Modes
    test: HammerTest
    nonlinear: bool


def _prepare(model: Model, settings: HammerSettings) -> _Prepared:
    """Equilibrium, modes and test of a model."""
    scene = model.scene
    Problems(hammer_problems(scene)).check()
    model = operating(model, model.operation.speed)
    balance = equilibrium(steady_system(model.system), model.operation)
    found = modes(balance)
    highest = settings.highest or (scene.frequencies[-1] if scene.frequencies else HIGHEST)
    duration = settings.duration or suggested_duration(found, highest)
    test = HammerTest(highest, duration, settings.hits, settings.noise, settings.seed)
    return _Prepared(model, balance, found, test, settings.nonlinear)


def _size(prepared: _Prepared) -> int:
    """Hits in all."""
    return prepared.test.hits * len(prepared.model.scene.inputs)


def _hit(prepared: _Prepared, told: Callable[[int], None]) -> tuple[tuple[Hits, ...], dict[str, int]]:
    """Make the hits, and tell how many are done; with how often each element was outside its map."""
    scene, balance, test = prepared.model.scene, prepared.balance, prepared.test
    inputs, sensors = tuple(scene.inputs), tuple(scene.sensors)
    if not prepared.nonlinear:
        return linear_hits(balance, inputs, sensors, test), {}
    done = 0

    def one() -> None:
        nonlocal done
        done += 1
        told(done)

    return nonlinear_hits(balance, inputs, sensors, test, one)


def _result(prepared: _Prepared, hits: tuple[Hits, ...], outside: Mapping[str, int]) -> HammerResult:
    """The records with what they were made from."""
    model, balance = prepared.model, prepared.balance
    return HammerResult(
        model=model,
        balance=balance,
        modes=prepared.modes,
        test=prepared.test,
        hits=hits,
        errors=tuple(film_errors(model, balance.displacement, balance.operation)),
        outside_hits=outside,
        findings=findings_at_rest(model, balance.displacement, balance.operation),
    )

"""A scene over speed, with one or more laws: modes, bearings, frequency responses; critical speeds, orders."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import AnalysisError, InputError
from ehdmaps.figures import typeset
from ehdmaps.units import RPM
from mbs.analyses.case import Case, Failed, Progress, Workers, as_cases, side_by_side
from mbs.analyses.film_errors import notable_from
from mbs.analyses.losses import losses_over_speed
from mbs.analyses.operating import operating, settled, states_of
from mbs.analyses.reach import fade_of
from mbs.analyses.sensors import excited_orders
from mbs.analyses.soundness import Judged, findings_over_speed, with_findings
from mbs.linearised.critical import (
    CriticalSpeed,
    OrderResponse,
    critical_speeds,
    order_responses,
    orders,
    turning_orders,
    turning_places,
    with_critical,
)
from mbs.linearised.excitation import Excited, excited
from mbs.linearised.linear import response_display
from mbs.linearised.sweep import sweep as sweep_system
from mbs.linearised.sweep_result import Sweep
from mbs.linearised.validity import DynamicLoad
from mbs.model.elements import OnRings
from mbs.model.findings import Cause, Finding
from mbs.model.system import System
from mbs.output.excitation.table import with_lines
from mbs.output.files import described
from mbs.output.model_text import clearance_text, common_supply, temperature_text
from mbs.output.results import with_states
from mbs.output.sweep_data import LARGEST, critical_dataset, largest_responses, side_by_side_laws, sweep_dataset
from mbs.scene.assembly import Model, law_attributes, laws_attributes
from mbs.scene.scene import Scene
from mbs.settings import CAGE_ANGLES, SweepRange

if TYPE_CHECKING:
    from mbs.output.files import Figure
    from mbs.unknowns.looks import Band
    from mbs.unknowns.over_speed import SpeedBands


_DRAWN = 200
"""Parts of the range of speeds at whose ends responses to loads that turn are drawn."""

_LEAST_SIZE = 1e-300
"""Of a response that has a level."""


@dataclass(frozen=True)
class SweepSettings:
    """Over what is swept.

    Attributes
    ----------
    speeds : SweepRange or None
        None for [sweep] of the scene.
    cage_angles : int
        Angles within one pitch of the rollers over which stiffness and damping of the bearings are averaged, for
        modes and responses too; 1 for the start angle of the cages alone.
    besides : tuple of float
        Speeds at which responses to loads that turn are found besides, as far as they lie within [rad/s].
    """

    speeds: SweepRange | None = None
    cage_angles: int = CAGE_ANGLES
    besides: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class SweepResult:
    """Sweeps of one or more models over the same speeds.

    Attributes
    ----------
    cases : tuple of Case
        The models with their labels.
    sweeps : tuple of Sweep
        One a case.
    outside : tuple of mapping of str to int
        Number of speeds at which each bearing lies outside the map, one a case.
    dataset : xarray.Dataset
        What `mbs sweep -o` writes.
    findings : tuple of tuple of Finding
        What is beyond the laws of the bearings, one a case.
    lines : tuple of Excited or None
        Excitation by bearings, one a case; None without deviations of them.
    """

    cases: tuple[Case, ...]
    sweeps: tuple[Sweep, ...]
    outside: tuple[Mapping[str, int], ...]
    dataset: xr.Dataset
    findings: tuple[tuple[Finding, ...], ...] = ()
    lines: tuple[Excited | None, ...] = ()

    @cached_property
    def bands(self) -> tuple[SpeedBands, ...]:
        """Bands of what is not known of the modes of each case; found when they are asked for."""
        from mbs.unknowns.over_speed import bands_over_speed

        highest = max(self.cases[0].model.scene.frequencies, default=self.cases[0].model.scene.campbell.highest)
        return tuple(
            bands_over_speed(case.model, found, highest) for case, found in zip(self.cases, self.sweeps, strict=True)
        )

    def bounded(self) -> xr.Dataset:
        """The data set with bounds of frequencies and damping ratios of complex modes."""
        from mbs.unknowns.bounds import with_sides

        found = self.dataset
        for name in ("frequency", "damping_ratio"):
            value = found[f"complex_{name}"].values
            fall, rise = np.full((2, *value.shape), np.nan)
            for case, bands in enumerate(self.bands):
                parts = getattr(bands, name)
                fall[case, :, : parts.shape[2]], rise[case, :, : parts.shape[2]] = parts
            found = with_sides(found, f"complex_{name}", np.maximum(value * (1.0 - fall), 0.0), value * (1.0 + rise))
        return found

    def plot(self, banded: bool = False) -> Figure:
        """Figure that `mbs sweep --plot` writes: modes, bearings and responses over speed, what is not valid marked.

        Parameters
        ----------
        banded : bool
            Whether what is not known of complex modes is shaded.
        """
        from mbs.output.sweep_plot import sweep_figure

        cases, found = self.cases, self.sweeps
        scene = cases[0].model.scene
        one_law = len({case.model.law for case in cases}) == 1
        clearances = {entry.geometry.diametral_clearance for case in cases for entry in case.model.scene.bearings}
        words = [
            f"law {cases[0].model.law}" if one_law else "laws side by side",
            *([supply] if not one_law and (supply := common_supply(case.model for case in cases)) else []),
            temperature_text(cases[0].model),
            *([f"clearance {clearance_text(cases[0].model)}"] if len(clearances) == 1 else []),
            *([f"{cases[0].load_factor:g} x load"] if len(cases) == 1 and cases[0].load_factor != 1.0 else []),
            f"mean of {found[0].bearings.angles} cage angles" if found[0].bearings.angles > 1 else "cages held",
        ]
        fades = [fade for case in cases if (fade := fade_of(case.model)) is not None]
        return sweep_figure(
            scene.title,
            "; ".join(words),
            found,
            [case.label for case in cases],
            [
                notable_from(case.model, entry.speeds, entry.displacement)
                for case, entry in zip(cases, found, strict=True)
            ],
            max((fade.speed for fade in fades), default=0.0),
            [case.model.memory == "memory" for case in cases],
            self.bands if banded else (),
        )

    def waterfall(self) -> Figure:
        """Figure that `mbs sweep --waterfall` writes: the first response of each case, with the orders of the machine.

        Raises
        ------
        InputError
            If the scene has no responses.
        """
        from mbs.output.waterfall_plot import Waterfall, waterfall_figure

        model, responses = self.cases[0].model, self.sweeps[0].responses
        if not responses.values.size:
            raise InputError(waterfall_problems(model.scene))
        display = response_display(responses.sensors[0], responses.inputs[0])
        cases = [
            Waterfall(
                case.label,
                found.speeds,
                found.responses.frequencies,
                20.0 * np.log10(np.maximum(display.factor * found.responses.largest(0, 0), _LEAST_SIZE)),
            )
            for case, found in zip(self.cases, self.sweeps, strict=True)
        ]
        look = model.scene.campbell
        orders = [(order, f"{order:g}") for order in look.orders] or excited_orders(model, math.inf)
        words = f"{responses.sensors[0].name} by {responses.inputs[0].name}"
        return waterfall_figure(
            f"{model.scene.title}\nresponse {words}", cases, f"{words}, dB re 1 {typeset(display.unit)}", orders
        )


def waterfall_problems(scene: Scene) -> list[str]:
    """List what a scene lacks for a waterfall of its responses.

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    if scene.frequencies and scene.inputs and scene.sensors:
        return []
    return [f"{scene.name}: got no responses; allowed with --waterfall: [linear] with frequencies, inputs and sensors"]


def sweep(
    models: Model | Case | Sequence[Model | Case],
    settings: SweepSettings | None = None,
    progress: Progress | None = None,
    workers: Workers = 1,
) -> SweepResult:
    """Sweep over speed.

    Parameters
    ----------
    models : Model, Case, or a sequence of them
        One scene with one or more laws, clearances or loads.
    settings : SweepSettings, optional
        Speeds and cage angles; the speeds of the scene if left out.
    progress : callable, optional
        Told how many models are done, and of how many.
    workers : int or concurrent.futures.Executor
        Number of processes among which the models are divided, or what computes them in their place.

    Raises
    ------
    InputError
        If there are no speeds, or what is asked for is more than memory should hold.
    AnalysisError
        If there is no equilibrium at a speed.

    Examples
    --------
    >>> from mbs import SweepRange, SweepSettings, assemble, read_scene, sweep
    >>> model = assemble(read_scene("nu308_rigid"))
    >>> found = sweep(model, SweepSettings(SweepRange(100.0, 200.0, 3)))
    >>> dict(found.dataset.sizes)["speed"]
    3
    """
    cases = as_cases(models)
    settings = settings or SweepSettings()
    speeds = settings.speeds or cases[0].model.scene.sweep
    if speeds is None:
        raise InputError(sweep_problems(cases[0].model.scene))
    models = settled([case.model for case in cases], speeds.end)
    cases = tuple(dataclasses.replace(case, model=model) for case, model in zip(cases, models, strict=True))
    found: list[Sweep] = []
    for entry in side_by_side(
        partial(_one, speeds, settings.cage_angles),
        cases,
        [1] * len(cases),
        workers,
        progress,
        lambda index: cases[index].label,
    ):
        if isinstance(entry, Failed):
            raise entry.error
        found.append(entry)
    outside = tuple({name: int(np.count_nonzero(there)) for name, there in entry.outside.items()} for entry in found)
    findings = tuple(findings_over_speed(case.model, entry) for case, entry in zip(cases, found, strict=True))
    judged = Judged(list(zip([case.label for case in cases], findings, strict=True)))
    lines = tuple(_lines(case, speeds, settings.cage_angles) for case in cases)
    dataset = with_lines(judged.marked(_dataset(cases, found)), lines, cases[0].model.scene.sensors, "case")
    return SweepResult(cases, tuple(found), outside, dataset, findings, lines)


def _lines(case: Case, speeds: SweepRange, cage_angles: int) -> Excited | None:
    """Excitation by the bearings of a model."""
    sensors = case.model.scene.sensors
    return excited(lambda speed: operating(case.model, speed).system, speeds.speeds.tolist(), sensors, cage_angles)


def sweep_problems(scene: Scene) -> list[str]:
    """List what a scene lacks for a sweep without speeds of its own.

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    if scene.sweep is not None:
        return []
    return [
        f'{scene.name}: no speeds; allowed: --speed "500 rpm" "2500 rpm" 40, or a table [sweep] in the scene with '
        "from, to and points"
    ]


def _one(speeds: SweepRange, cage_angles: int, case: Case, _: Callable[[int], None]) -> Sweep:
    """Sweep one model."""
    scene = case.model.scene
    try:
        return sweep_system(
            lambda speed: operating(case.model, speed).system,
            speeds.speeds,
            0.0,
            scene.inputs,
            scene.sensors,
            np.array(scene.frequencies),
            cage_angles,
        )
    except AnalysisError as error:
        raise AnalysisError(f"{case.label}: {error}") from error


def _dataset(cases: Sequence[Case], found: Sequence[Sweep]) -> xr.Dataset:
    """All sweeps, with what the law of each is."""
    dataset = sweep_dataset(
        found,
        [case.label for case in cases],
        [case.model.law for case in cases],
        [case.clearance for case in cases],
        [case.load_factor for case in cases],
    )
    models = [[operating(case.model, speed) for speed in found[0].speeds.tolist()] for case in cases]
    losses = [
        losses_over_speed(there, entry.speeds, entry.displacement) for there, entry in zip(models, found, strict=True)
    ]
    for name, unit, words, part in (
        ("rolling_torque", "N m", "torque that rolling takes", 0),
        ("rolling_power", "W", "power that the films of all rollers or balls take", 1),
    ):
        values = np.stack([both[part] for both in losses])
        attributes = {"units": unit, "long_name": f"{words}; films only; none of laws without rolling forces"}
        dataset[name] = (("case", "speed", "bearing"), values, attributes)
    laws = laws_attributes([case.label for case in cases], [case.model for case in cases]) if cases[1:] else {}
    dataset = with_states(dataset, [[states_of(there) for there in row] for row in models], ("case", "speed"))
    return described(dataset, **{**law_attributes(cases[0].model), **laws})


@dataclass(frozen=True, eq=False)
class CriticalResult:
    """Critical speeds and responses of a model.

    Attributes
    ----------
    model : Model
        Scene with its law.
    sweep : Sweep
        Modes over the speeds that were asked for.
    found : tuple of CriticalSpeed
        Critical speeds, for each order in turn.
    speeds : array, shape (speeds,)
        Speeds of the responses: those of the sweep, and some around each critical one, of all laws [rad/s].
    responses : tuple of OrderResponse
        Response to all loads of each order; none without unbalances and excitations.
    dataset : xarray.Dataset
        What `mbs critical -o` writes.
    findings : tuple of Finding
        What is beyond the laws of the bearings.
    lines : Excited or None
        Excitation by its bearings; None without deviations of them.
    """

    model: Model
    sweep: Sweep
    found: tuple[CriticalSpeed, ...]
    speeds: FloatArray
    responses: tuple[OrderResponse, ...]
    dataset: xr.Dataset
    findings: tuple[Finding, ...] = ()
    lines: Excited | None = None

    @cached_property
    def bands(self) -> SpeedBands:
        """Bands of what is not known of modes and of the largest responses; found when they are asked for."""
        from mbs.unknowns.over_speed import Responses, bands_over_speed

        highest = 1.05 * max((abs(entry.eigenvalue) for entry in self.found), default=0.0) / (2.0 * math.pi)
        own = Responses(self._row(self.responses), self._row) if self.responses else None
        return bands_over_speed(self.model, self.sweep, highest, own, self.found)

    @cached_property
    def bounds(self) -> FloatArray:
        """Bounds of what is not known of the critical speeds [rad/s] and damping ratios there, shape (critical, 4).

        They are low and high speed, low and high ratio, 90 % of what is not known; found when they are asked for.
        """
        own = self.bands.critical
        return np.array([own.low[0], own.high[0], own.low[1], own.high[1]]).T

    @property
    def largest(self) -> Mapping[str, Band]:
        """Bands of the largest responses over speed by their names in the data set; none without loads that turn."""
        found, first = {}, 0
        for name, values in self._largest(self.responses).items():
            found[name] = self.bands.responses.of(first + np.arange(values.size).reshape(values.shape))
            first += values.size
        return found

    def _largest(self, responses: Sequence[OrderResponse]) -> dict[str, FloatArray]:
        """Largest responses over speed."""
        return largest_responses(self.model.system, self.model.scene.sensors, self.speeds, responses)

    def _row(self, responses: Sequence[OrderResponse]) -> FloatArray:
        """All of them in one row."""
        return np.concatenate([values.reshape(-1) for values in self._largest(responses).values()])

    def bounded(self) -> xr.Dataset:
        """The data set with these bounds, and with the largest responses over speed and theirs."""
        from mbs.unknowns.bounds import with_bounds, with_sides

        speed, ratio = self.bounds[:, :2].T, self.bounds[:, 2:].T
        found = with_sides(with_sides(self.dataset, "critical_speed", *speed), "critical_damping_ratio", *ratio)
        for name, own in self.largest.items():
            dims, attributes = LARGEST[name]
            found = with_bounds(found.assign({name: (dims, own.value, attributes)}), name, own)
        return found

    def plot(self) -> Figure:
        """Figure that `mbs critical --plot` writes: modes with the orders, and the responses over speed."""
        return critical_plot([self.model.label], [self])

    @property
    def outside(self) -> Mapping[str, int]:
        """Number of speeds of the sweep at which each bearing lies outside its map."""
        return {name: int(np.count_nonzero(there)) for name, there in self.sweep.outside.items()}


def critical(model: Model, settings: SweepSettings | None = None) -> CriticalResult:
    """Find critical speeds, and the response to unbalances and excitations by orders over speed.

    Parameters
    ----------
    model : Model
        Scene with its law.
    settings : SweepSettings, optional
        Speeds and cage angles; those of [sweep] of the scene if left out.

    Raises
    ------
    InputError
        If there are no speeds, or no body spins.
    AnalysisError
        If there is no equilibrium at a speed.

    Notes
    -----
    Orders are those of the unbalances and excitations, and without any the spins of the bodies. Bearings and gear
    meshes have their mean stiffness.

    Examples
    --------
    >>> from mbs import SweepRange, SweepSettings, assemble, critical, read_scene
    >>> model = assemble(read_scene("nu308_rigid"))
    >>> found = critical(model, SweepSettings(SweepRange(100.0, 200.0, 3)))
    >>> found.dataset.sizes["critical"]
    0
    """
    return critical_of([model], settings)[0]


def critical_of(models: Sequence[Model], settings: SweepSettings | None = None) -> list[CriticalResult]:
    """Find critical speeds and responses of one scene with several laws, responses at the same speeds.

    Parameters
    ----------
    models : sequence of Model
        Scene with each law. Speeds around the critical ones of any of them are added for all.
    settings : SweepSettings, optional
        Speeds and cage angles; those of [sweep] of the scene if left out.

    Raises
    ------
    InputError
        If there are no speeds, or no body spins.
    AnalysisError
        If there is no equilibrium at a speed.
    """
    settings = settings or SweepSettings()
    speeds = settings.speeds or models[0].scene.sweep
    found = [_swept(model, settings) for model in (models if speeds is None else settled(models, speeds.end))]
    swept = found[0].sweep.speeds
    besides = [speed for speed in settings.besides if swept[0] <= speed <= swept[-1]]
    turning = turning_orders(models[0].system)
    around = [with_critical(entry.sweep.speeds, entry.found, turning) for entry in found]
    refined = np.unique(np.concatenate([besides, *around]))
    return [_responded(entry, refined) for entry in found]


class _Swept(NamedTuple):
    """A model with its modes over speed."""

    model: Model
    system_at: Callable[[float], System]
    sweep: Sweep
    found: tuple[CriticalSpeed, ...]


def _swept(model: Model, settings: SweepSettings) -> _Swept:
    """Modes and critical speeds of one model."""
    speeds = settings.speeds or model.scene.sweep
    if speeds is None:
        raise InputError(sweep_problems(model.scene))
    if not turning_places(model.system):
        raise InputError(
            f"{model.scene.name}: no body spins, so that no speed is critical; allowed: a body with a spin, such as "
            "spin = 1"
        )

    def system_at(speed: float) -> System:
        return operating(model, speed).system

    sweep = sweep_system(system_at, speeds.speeds, cage_angles=settings.cage_angles)
    found = critical_speeds(system_at, sweep.speeds, sweep.damped, orders(model.system), settings.cage_angles)
    return _Swept(model, system_at, sweep, found)


def _responded(swept: _Swept, speeds: FloatArray) -> CriticalResult:
    """The responses of one model at some speeds."""
    model, system_at, sweep, found = swept
    responses: tuple[OrderResponse, ...] = ()
    if model.system.turning:
        try:
            responses = order_responses(system_at, speeds, sweep.bearings.angles, _DRAWN)
        except np.linalg.LinAlgError as error:
            raise AnalysisError(
                "responses: one of the speeds is just that of an undamped resonance, where there is none; move the "
                "speeds, or add damping"
            ) from error
    dataset = critical_dataset(model.system, model.scene.sensors, sweep, found, speeds, responses)
    lines = excited(system_at, speeds.tolist(), model.scene.sensors, sweep.bearings.angles)
    dataset = with_lines(dataset, [lines], model.scene.sensors)
    findings = (*findings_over_speed(model, sweep), *_lift_off(model, sweep, speeds, responses))
    dataset = with_findings(described(dataset, **law_attributes(model)), findings)
    return CriticalResult(model, sweep, found, speeds, responses, dataset, findings, lines)


def _lift_off(model: Model, sweep: Sweep, speeds: FloatArray, responses: Sequence[OrderResponse]) -> Iterator[Finding]:
    """Contacts that the loads of an order lift off, each from the first speed where they do."""
    names = [model.system.elements[index].element.name for index in model.system.select(OnRings)]
    for response, (index, name) in itertools.product(responses, enumerate(names)):
        dynamic, static = response.lifting[:, index].T
        above = np.flatnonzero(dynamic > static)
        if not above.size:
            continue
        first = int(above[0])
        of = response.lifted[first][index]
        load = DynamicLoad(name, "", float(dynamic[first]), float(static[first]), 0.0, of)
        begin = f"{RPM.value(float(speeds[first])):.5g} rpm"
        words = (
            f"order {response.order:.4g}: {load.words} from {begin} on, where contacts lift off: small motions no "
            "more; see mbs runup"
        )
        yield Finding(Cause.LIFT_OFF, words, name, float(np.max(dynamic[above] / np.maximum(static[above], 1e-300))))


def dataset_of_laws(labels: Sequence[str], results: Sequence[CriticalResult]) -> xr.Dataset:
    """Data set that `mbs critical -o` writes: of one law its result, of several all of them over the dim law.

    There are as many critical speeds as the law with most of them has; what a law has not is not a number.

    Parameters
    ----------
    labels : sequence of str
        What each is called.
    results : sequence of CriticalResult
        Results of `critical_of`.
    """
    if len(results) == 1:
        return results[0].dataset
    joined = side_by_side_laws(labels, [result.dataset for result in results])
    return joined.assign_attrs(laws_attributes(labels, [result.model for result in results]))


def critical_plot(labels: Sequence[str], results: Sequence[CriticalResult], banded: bool = False) -> Figure:
    """Figure of critical speeds and responses, of one law or several.

    Parameters
    ----------
    labels : sequence of str
        What each law is called.
    results : sequence of CriticalResult
        One a law.
    banded : bool
        Whether critical speeds have what is not known of them.
    """
    from mbs.output.sweep_plot import CriticalCurves, critical_figure

    return critical_figure(
        [
            CriticalCurves(
                label,
                entry.model,
                entry.sweep,
                entry.found,
                entry.speeds,
                entry.responses,
                orders(entry.model.system),
                entry.bounds if banded else None,
            )
            for label, entry in zip(labels, results, strict=True)
        ]
    )

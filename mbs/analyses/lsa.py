"""State space and frequency responses of the system linearised at its equilibrium."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import Problems
from mbs.analyses.film_errors import film_errors
from mbs.analyses.operating import operating, settled, states_of
from mbs.analyses.soundness import findings_at_rest, lift_off, with_findings
from mbs.linearised.averaged import AveragedEquilibrium, mean_equilibrium
from mbs.linearised.excitation import Excited, excited_at
from mbs.linearised.linear import StateSpace, frequency_response, level_bands, sensed, state_space, with_peaks
from mbs.linearised.linear import responses as responses_of
from mbs.linearised.modes import Modes, StateModes, modes_of, state_modes, undamped_modes
from mbs.linearised.validity import DynamicLoad, FilmError, dynamic_loads
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium
from mbs.model.findings import Finding
from mbs.output.excitation.table import with_lines
from mbs.output.files import described
from mbs.output.results import linear_dataset, of_laws, with_states
from mbs.scene.assembly import Model, law_attributes, laws_attributes
from mbs.scene.scene import Scene
from mbs.settings import CAGE_ANGLES, check_cage_angles

if TYPE_CHECKING:
    from mbs.output.files import Figure
    from mbs.unknowns.of_peaks import PeakBands


@dataclass(frozen=True)
class LsaSettings:
    """Choice of what is computed of a linear system.

    Attributes
    ----------
    frequencies : tuple of float or None
        Frequencies of the responses [Hz]; None for those of [linear] in the scene. More are added around lightly damped
        modes.
    operation : Operation or None
        Speed, angle and time of the loads; None for the operating speed of the scene.
    cage_angles : int
        Angles within one pitch of the rollers over which stiffness and damping are averaged, from 1 to `MOST_ANGLES`;
        1 for the start angle of the cages alone. Responses and state space are those of the mean.
    """

    frequencies: tuple[float, ...] | None = None
    operation: Operation | None = None
    cage_angles: int = CAGE_ANGLES


@dataclass(frozen=True, eq=False)
class LsaResult:
    """A linear system, and its responses.

    Attributes
    ----------
    model : Model
        Scene with its law.
    balance : Equilibrium
        Equilibrium at which the system was linearised, gear meshes and bearings with their mean stiffness.
    space : StateSpace
        State space from the inputs of the scene to its sensors.
    states : StateModes
        Modes of its state space, by which responses are found.
    modes : Modes
        Complex modes, around which there are more frequencies.
    asked : int
        How many frequencies were asked for; the others are around lightly damped modes.
    frequencies : array, shape (frequencies,)
        [Hz].
    responses : array of complex, shape (frequencies, sensors, inputs)
        Responses in the unit of the sensor's quantity, per N or N m.
    level_error : array, shape (frequencies, sensors, inputs), or None
        Bands of the levels of the responses, either way [dB], from errors of known size; None for laws that state none.
    film_share : float
        Median part of these bands that is what films with memory leave out.
    pitch_range : array, shape (2, frequencies, sensors, inputs), or None
        Least and largest size of the responses at each single angle of the cage; None for one angle.
    errors : tuple of FilmError
        How wrong the films of each bearing are estimated to be; empty for laws without films.
    lifting : tuple of DynamicLoad
        Loads that exceed the static ones, so that contacts lift off.
    dataset : xarray.Dataset
        What `mbs lsa -o` writes.
    findings : tuple of Finding
        What is beyond the laws of its bearings.
    lines : Excited or None
        Excitation by its bearings; None without deviations of them.
    """

    model: Model
    balance: Equilibrium
    space: StateSpace
    states: StateModes
    modes: Modes
    asked: int
    frequencies: FloatArray
    responses: ComplexArray
    level_error: FloatArray | None
    film_share: float
    pitch_range: FloatArray | None
    errors: tuple[FilmError, ...]
    lifting: tuple[DynamicLoad, ...]
    dataset: xr.Dataset
    findings: tuple[Finding, ...] = ()
    lines: Excited | None = None

    @cached_property
    def bands(self) -> PeakBands:
        """Bands of what is not known of the peaks of the responses; found when they are asked for."""
        from mbs.unknowns.of_peaks import peak_bands

        sizes = np.abs(self.responses)
        return peak_bands(self.model, self.balance, self.modes, self.frequencies, sizes, self._level_error_at)

    def _level_error_at(self, frequencies: FloatArray) -> FloatArray | None:
        """Bands of the levels of the responses at other frequencies, as `level_error`."""
        scene, balance = self.model.scene, self.balance
        motion = responses_of(balance, scene.inputs, frequencies)
        responses = sensed(balance, scene.sensors, frequencies, motion)
        return level_bands(balance, self.states, scene.sensors, frequencies, motion, responses)[0]

    def bounded(self) -> xr.Dataset:
        """The data set with the peaks of the responses and their bounds."""
        from mbs.unknowns.bounds import with_bounds

        bands, found = self.bands, self.dataset
        names = [[entry.name for entry in entries] for entries in (self.model.scene.sensors, self.model.scene.inputs)]
        for name, column, places in (("peak_sensor", 1, names[0]), ("peak_input", 2, names[1])):
            of = np.array([places[k] for k in bands.places[:, column]], dtype=np.str_)
            found = found.assign({name: ("peak", of, {"long_name": f"{name.partition('_')[2]} of the peak"})})
        for name, unit, own in (("peak_frequency", "Hz", bands.frequency), ("peak_level", "dB", bands.level)):
            attributes = {"units": unit, "long_name": f"{name.partition('_')[2]} of the peak of a response"}
            found = with_bounds(found.assign({name: ("peak", own.value, attributes)}), name, own)
        return found

    def plot(self, banded: bool = False) -> Figure:
        """Figure that `mbs lsa --plot` writes: magnitude and phase of the responses.

        Parameters
        ----------
        banded : bool
            Whether peaks have what is not known of them.
        """
        return lsa_figure([self.model.label], [self], banded)


def lsa_problems(scene: Scene) -> list[str]:
    """List what a scene lacks for a linear analysis.

    Parameters
    ----------
    scene : Scene
        The scene.
    """
    return [
        f"{scene.name}: {key} missing; a linear analysis needs {words}"
        for key, there, words in (
            ("[[inputs]]", scene.inputs, "at least one input"),
            ("[[sensors]]", scene.sensors, "at least one sensor"),
            ("[linear] frequencies", scene.frequencies, "frequencies"),
        )
        if not there
    ]


def lsa(model: Model, settings: LsaSettings | None = None) -> LsaResult:
    """Linearise, and compute the responses over frequency.

    Parameters
    ----------
    model : Model
        Scene with its law, with inputs and sensors.
    settings : LsaSettings, optional
        Frequencies and operation; those of the scene if left out.

    Raises
    ------
    InputError
        With everything that is missing.
    AnalysisError
        If there is no equilibrium, or its matrices are not finite.

    Examples
    --------
    >>> from mbs import LsaSettings, assemble, lsa, read_scene
    >>> found = lsa(assemble(read_scene("nu308_rigid")), LsaSettings(frequencies=(100.0, 200.0)))
    >>> found.dataset["response_real"].dims
    ('frequency', 'sensor', 'input')
    """
    return lsa_of([model], settings)[0]


def lsa_of(models: Sequence[Model], settings: LsaSettings | None = None) -> list[LsaResult]:
    """Linearise several models of one scene, and compute their responses at the same frequencies.

    Parameters
    ----------
    models : sequence of Model
        Scene with each law. Frequencies around the lightly damped modes of any of them are added for all.
    settings : LsaSettings, optional
        Frequencies and operation; those of the scene if left out.

    Raises
    ------
    InputError
        With everything that is missing.
    AnalysisError
        If there is no equilibrium, or its matrices are not finite.
    """
    settings = settings or LsaSettings()
    operation = settings.operation or models[0].operation
    highest = None if settings.frequencies is None else max(settings.frequencies, default=None)
    found = [_linearised(model, settings) for model in settled(models, operation.speed, highest)]
    frequencies = np.unique(np.concatenate([entry.frequencies for entry in found]))
    return [_responded(entry, frequencies) for entry in found]


class _Linearised(NamedTuple):
    """A model at its equilibrium, and the frequencies that its modes ask for."""

    model: Model
    balance: Equilibrium
    states: StateModes
    modes: Modes
    asked: int
    frequencies: FloatArray


def _linearised(model: Model, settings: LsaSettings) -> _Linearised:
    """Linearise one model."""
    scene = model.scene
    asked = scene.frequencies if settings.frequencies is None else settings.frequencies
    Problems(lsa_problems(dataclasses.replace(scene, frequencies=tuple(asked)))).check()
    check_cage_angles("lsa", settings.cage_angles)
    operation = settings.operation or model.operation
    model = operating(model, operation.speed)
    balance = mean_equilibrium(model.system, operation, settings.cage_angles)
    states = state_modes(balance, undamped_modes(balance))
    modes = modes_of(balance, states)
    frequencies = with_peaks(np.array(asked), modes.eigenvalues)
    return _Linearised(model, balance, states, modes, len(asked), frequencies)


def _responded(found: _Linearised, frequencies: FloatArray) -> LsaResult:
    """The responses of a linearised model at some frequencies."""
    model, balance, states, modes, asked, _ = found
    scene = model.scene
    motion = responses_of(balance, scene.inputs, frequencies)
    responses = sensed(balance, scene.sensors, frequencies, motion)
    level_error, film_share = level_bands(balance, states, scene.sensors, frequencies, motion, responses)
    space = state_space(balance, scene.inputs, scene.sensors)
    lifting = tuple(load for load in dynamic_loads(balance, scene.inputs, frequencies, motion) if load.exceeds)
    pitch_range = _pitch_range(balance, scene, frequencies)
    dataset = linear_dataset(
        balance, space, responses, frequencies, scene.inputs, scene.sensors, level_error, film_share
    )
    if pitch_range is not None:
        for name, words, values in zip(("least", "most"), ("least", "largest"), pitch_range, strict=True):
            attributes = {
                **dataset["response_real"].attrs,
                "long_name": f"{words} size of the response at one cage angle",
            }
            dataset[f"response_{name}"] = (dataset["response_real"].dims, values, attributes)
    lines = excited_at([balance], scene.sensors)
    dataset = with_lines(dataset, [lines], scene.sensors)
    findings = (
        *findings_at_rest(model, balance.displacement, balance.operation),
        *(lift_off(load, scene) for load in lifting),
    )
    return LsaResult(
        model=model,
        balance=balance,
        space=space,
        states=states,
        modes=modes,
        asked=asked,
        frequencies=frequencies,
        responses=responses,
        level_error=level_error,
        film_share=film_share,
        pitch_range=pitch_range,
        errors=tuple(film_errors(model, balance.displacement, balance.operation)),
        lifting=lifting,
        dataset=with_findings(described(with_states(dataset, states_of(model)), **law_attributes(model)), findings),
        findings=findings,
        lines=lines,
    )


def _pitch_range(balance: Equilibrium, scene: Scene, frequencies: FloatArray) -> FloatArray | None:
    """Least and largest size of the responses over the angles of the cage; None for one angle."""
    if not isinstance(balance, AveragedEquilibrium):
        return None
    sizes = [np.abs(frequency_response(entry, scene.inputs, scene.sensors, frequencies)) for entry in balance.over]
    return np.array([np.min(sizes, axis=0), np.max(sizes, axis=0)])


def lsa_dataset(labels: Sequence[str], results: Sequence[LsaResult]) -> xr.Dataset:
    """Data set that `mbs lsa -o` writes: of one law its result, of several all of them over the dim law.

    State spaces have as many states as the law with most of them; what a law has not is not a number.

    Parameters
    ----------
    labels : sequence of str
        What each is called.
    results : sequence of LsaResult
        Results of `lsa_of`, at the same frequencies.
    """
    parts = [result.dataset for result in results]
    if len(parts) == 1:
        return parts[0]
    joined = of_laws(labels, parts, ("quantity", "amplitude"))
    # Joined names of states are sorted; those of the law with most of them are in their order.
    most = max(parts, key=lambda part: part.sizes["state"])
    joined = joined.reindex(state=most["state"], of_state=most["of_state"])
    for name in ("residual", "newton_steps"):
        joined = joined.assign({name: ("law", [part.attrs[name] for part in parts], {"units": "1", "long_name": name})})
    bands = "; ".join(f"{label}: {part.attrs['bands']}" for label, part in zip(labels, parts, strict=True))
    kept = {key: value for key, value in joined.attrs.items() if key not in ("residual", "newton_steps")}
    joined.attrs = {**kept, "bands": bands, **laws_attributes(labels, [result.model for result in results])}
    return joined


def lsa_figure(labels: Sequence[str], results: Sequence[LsaResult], banded: bool = False) -> Figure:
    """Figure of the responses of one case, or of several side by side.

    Parameters
    ----------
    labels : sequence of str
        What each case is called.
    results : sequence of LsaResult
        One a case.
    banded : bool
        Whether peaks have what is not known of them.
    """
    from mbs.output.response_plot import Curves, comparison_figure, response_figure

    curves = [
        Curves(
            label,
            entry.frequencies,
            entry.responses,
            min((error.frequency for error in entry.errors), default=math.inf),
            entry.level_error,
            entry.pitch_range,
            entry.bands if banded else None,
        )
        for label, entry in zip(labels, results, strict=True)
    ]
    several = len(results) > 1
    notes = [
        note
        for label, entry in zip(labels, results, strict=True)
        for note in _lifting_notes(entry.lifting, label if several else "")
    ]
    first = results[0].model
    return comparison_figure(first, curves, notes) if several else response_figure(first, curves[0], notes)


def _lifting_notes(loads: Sequence[DynamicLoad], label: str) -> list[str]:
    """Notes below the figure on loads that lift off, a line for each frequency and input."""
    names: dict[tuple[str, str], list[str]] = {}
    for load in loads:
        names.setdefault((f"{load.frequency:.4g} Hz", load.input), []).append(load.element)
    begin = f"{label}: " if label else ""
    return [
        f"{begin}contacts lift off near {at} with the amplitude of {entry}, a linear analysis is not valid there: "
        + ", ".join(elements)
        for (at, entry), elements in names.items()
    ]

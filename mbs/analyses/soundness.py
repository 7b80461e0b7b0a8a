"""Findings about the bearings of a machine: at rest, over speed, with the motion of a linear analysis, in a run.

Every analysis of every kind of bearing asks here. Causes, words and limits are those of `mbs.model.findings`; what the
contacts feel is told by `OnRings.gauge`. Figures of an unsound result belong to no machine at all: commands say so in
their first line, end with the status 1, and files have the attribute `unsound`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.units import MOTIONS, RPM, Display
from mbs.model.elements import Operation
from mbs.model.findings import MEANINGLESS, Cause, Finding, Severity, worst_of
from mbs.model.on_rings import ring_motion
from mbs.scene.assembly import Model

if TYPE_CHECKING:
    import xarray as xr

    from mbs.linearised.sweep_result import Sweep
    from mbs.linearised.validity import DynamicLoad
    from mbs.scene.scene import Scene
    from mbs.transient.run import Recording

MOST_RESIDUAL = 0.1
"""Part of the energy that went through a run that may be missing; lines warn from a hundredth on."""

MOST_OUTSIDE = 0.5
"""Part of the calls of a bearing in a run that may lie outside its map."""

_SAMPLES = 9
"""Samples of a run that are looked at, besides the one with the largest force of each bearing."""


def findings_at_rest(model: Model, displacement: FloatArray, operation: Operation) -> tuple[Finding, ...]:
    """Find what is beyond the laws of the bearings at an equilibrium; empty where nothing is.

    Parameters
    ----------
    model : Model
        The machine with its law, in operation.
    displacement : array, shape (n,)
        Displacement of all coordinates.
    operation : Operation
        Speed and angle.
    """
    found: list[Finding] = []
    for bearing in model.on_rings:
        motion = model.system.relative(bearing.inner, bearing.outer) @ displacement
        gauge = bearing.gauge(motion, operation)
        found += () if gauge is None else gauge.findings_of(bearing.name)
    return tuple(found)


def findings_over_speed(model: Model, found: Sweep) -> tuple[Finding, ...]:
    """Find what is beyond the laws of the bearings in a sweep, each by its worst speed.

    Parameters
    ----------
    model : Model
        The machine with its law.
    found : Sweep
        Sweep of the machine.
    """
    from mbs.analyses.operating import operating

    speeds = found.speeds.tolist()
    each = [
        findings_at_rest(operating(model, speed), displacement, Operation(speed))
        for speed, displacement in zip(speeds, found.displacement, strict=True)
    ]
    for index, loads in enumerate(found.lifted):
        each[index] += tuple(lift_off(load, model.scene) for load in loads)
    return worst_of(each, [RPM.text(speed) for speed in speeds], "speeds")


def lift_off(load: DynamicLoad, scene: Scene) -> Finding:
    """Contacts that lift off at the amplitude of an input.

    Parameters
    ----------
    load : DynamicLoad
        Load that exceeds the static one.
    scene : Scene
        Scene with the input.
    """
    given = next(entry for entry in scene.inputs if entry.name == load.input)
    amplitude = MOTIONS.get(given.unit, Display(given.unit)).text(given.amplitude)
    words = (
        f"{load.words} at {load.frequency:.4g} Hz (input {load.input} at its amplitude of {amplitude}): contacts lift "
        "off, a linear analysis is not valid there"
    )
    return Finding(Cause.LIFT_OFF, words, load.element, load.dynamic / max(load.static, 1e-300))


def findings_in_run(model: Model, record: Recording) -> tuple[Finding, ...]:
    """Find what is beyond the laws of the bearings in a run, and whether the run itself is sound.

    A run shows itself how contacts lose their load and get it again.

    Parameters
    ----------
    model : Model
        The machine with its law.
    record : Recording
        The run.
    """
    found: list[Finding] = []
    for bearing, index in zip(model.on_rings, model.ring_places, strict=True):
        if not record.forces:
            break
        forces, motions = record.forces[index], ring_motion(record.motions[index])
        samples = np.linspace(0, forces.shape[0] - 1, _SAMPLES).astype(int)
        most = int(np.argmax(np.linalg.norm(forces[:, :3], axis=1)))
        each, places = [], []
        for sample in np.unique([*samples, most]).tolist():
            at = Operation(float(record.speed[sample]), float(record.angle[sample]), float(record.time[sample]))
            gauge = bearing.gauge(motions[sample], at)
            known = () if gauge is None else gauge.findings_of(bearing.name)
            each.append([one for one in known if one.cause is not Cause.UNLOADED])
            places.append(f"{at.time:.4g} s")
        found += worst_of(each, places, "samples that were looked at")
    left = record.energy.relative_residual
    if left > MOST_RESIDUAL:
        words = (
            f"{100.0 * left:.2g} % of the energy that went through the run is missing or too much (allowed: "
            f"{100.0 * MOST_RESIDUAL:g} %)"
        )
        found.append(Finding(Cause.ENERGY, words, excess=left / MOST_RESIDUAL))
    for bearing in model.on_rings:
        part = record.outside.get(bearing.name, 0) / max(record.iterations, 1)
        if part > MOST_OUTSIDE:
            words = (
                f"{100.0 * min(part, 1.0):.0f} % of the calls lie outside the map (allowed: "
                f"{100.0 * MOST_OUTSIDE:g} %), where the law is held at its edge"
            )
            found.append(Finding(Cause.OUTSIDE, words, bearing.name, part / MOST_OUTSIDE))
    return tuple(found)


class Judged:
    """Findings of the results of a command: its lines, its exit status, its mark in the file.

    Parameters
    ----------
    found : sequence of (str, sequence of Finding)
        Each case by its label, with its findings. The label is told where there are several.
    """

    def __init__(self, found: Sequence[tuple[str, Sequence[Finding]]]) -> None:
        several = len(found) > 1
        self._cases = [(f"{label}: " if several else "", findings) for label, findings in found]

    @property
    def first(self) -> list[str]:
        """First lines: a line for each case whose figures mean nothing."""
        lines = []
        for label, findings in self._cases:
            words = "; ".join(one.told for one in findings if one.severity is Severity.UNSOUND)
            lines += [f"{Severity.UNSOUND.word}: {label}{MEANINGLESS}{words}"] if words else []
        return lines

    @property
    def last(self) -> list[str]:
        """Last lines: warnings, then notes; those that say the same of several cases once."""
        told = [
            f"{grave.word}: {label}{one.told}"
            for grave in (Severity.BEYOND, Severity.WARNING, Severity.NOTE)
            for label, findings in self._cases
            for one in findings
            if one.severity is grave
        ]
        return list(dict.fromkeys(told))

    @property
    def status(self) -> int:
        """Exit status."""
        return max((one.severity.status for _, findings in self._cases for one in findings), default=0)

    def marked(self, dataset: xr.Dataset) -> xr.Dataset:
        """A result with the attributes `unsound`, `warnings` and `notes`, where there is a reason.

        Parameters
        ----------
        dataset : xarray.Dataset
            The result of all cases.
        """
        if self._cases[1:]:  # without those of the first case alone
            kept = {name: value for name, value in dataset.attrs.items() if name not in ("unsound", "notes")}
            dataset = dataset.copy(deep=False)
            dataset.attrs = kept
        told = [(one.severity, f"{label}{one.told}") for label, findings in self._cases for one in findings]
        return with_words(dataset, told)


def with_findings(dataset: xr.Dataset, found: Iterable[Finding]) -> xr.Dataset:
    """The result with the attributes `unsound`, `warnings` and `notes`, where there is a reason.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result; what else it has of the attributes is kept.
    found : iterable of Finding
        What was found.
    """
    return with_words(dataset, [(one.severity, one.told) for one in found])


def with_words(dataset: xr.Dataset, told: Iterable[tuple[Severity, str]]) -> xr.Dataset:
    """The same of words, each with how grave it is.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result.
    told : iterable of (Severity, str)
        What was found.
    """
    attributes = dict(dataset.attrs)
    for severity, words in told:
        name, joint = _ATTRIBUTES[severity]
        before = str(attributes.get(name, ""))
        if words not in before:
            attributes[name] = joint.join(filter(None, (before, words)))
    return dataset.assign_attrs(attributes)


_ATTRIBUTES = {
    Severity.UNSOUND: ("unsound", "; "),
    Severity.BEYOND: ("warnings", "\n"),
    Severity.WARNING: ("warnings", "\n"),
    Severity.NOTE: ("notes", "\n"),
}
"""Attribute of a result that has the words, and what stands between them."""

"""Results whose own checks failed so grossly that their figures mean nothing, and why.

Warnings say where a result is less exact than one may think. What is found here is another thing: figures that belong
to no machine at all. Commands say so in their first line, end with the status 1, and files have the attribute
`unsound`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.surface import HARDNESS
from ehdmaps.units import PRESSURE
from mbs.bearings.bearing_element import BearingElement, ring_motion
from mbs.bearings.bearing_force import BearingForce
from mbs.model.elements import Operation
from mbs.scene.assembly import Model, ring_motions

if TYPE_CHECKING:
    import xarray as xr

    from mbs.linearised.sweep_result import Sweep
    from mbs.transient.run import Recording

MOST_RESIDUAL = 0.1
"""Part of the energy that went through a run that may be missing; lines warn from a hundredth on."""

MOST_OUTSIDE = 0.5
"""Part of the calls of a bearing in a run that may lie outside its map."""

_SPEEDS = 9
"""Speeds of a sweep that are looked at."""


class Cause(Enum):
    """Check that failed."""

    PRESSURE = "pressure"
    ENERGY = "energy"
    OUTSIDE = "outside"


@dataclass(frozen=True)
class Unsound:
    """Reason why figures mean nothing.

    Attributes
    ----------
    cause : Cause
        Check that failed.
    words : str
        The same for people, with what was found and what is allowed.
    """

    cause: Cause
    words: str


def unsound_at_rest(model: Model, displacement: FloatArray, operation: Operation) -> tuple[Unsound, ...]:
    """Find why the figures of an equilibrium mean nothing; empty where they are sound.

    Parameters
    ----------
    model : Model
        The machine with its law.
    displacement : array, shape (n,)
        Displacement of all coordinates.
    operation : Operation
        Speed and angle.
    """
    found = (_crushed(bearing, motion, operation) for bearing, motion in ring_motions(model, displacement))
    return tuple(entry for entry in found if entry is not None)


def unsound_over_speed(model: Model, found: Sweep) -> tuple[Unsound, ...]:
    """Find why the figures of a sweep mean nothing, by its first speed where that is so.

    Parameters
    ----------
    model : Model
        The machine with its law.
    found : Sweep
        Sweep of the machine.
    """
    for index in np.unique(np.linspace(0, found.speeds.size - 1, _SPEEDS).astype(int)).tolist():
        reasons = unsound_at_rest(model, found.displacement[index], Operation(float(found.speeds[index])))
        if reasons:
            return reasons
    return ()


def unsound_run(model: Model, record: Recording) -> tuple[Unsound, ...]:
    """Find why the figures of a run mean nothing; empty where they are sound.

    Parameters
    ----------
    model : Model
        The machine with its law.
    record : Recording
        The run.
    """
    found: list[Unsound | None] = []
    for bearing, forces, motions in zip(model.bearings, record.forces, record.motions, strict=False):
        sample = int(np.argmax(np.hypot(forces[:, 1], forces[:, 2])))
        motion = ring_motion(motions[sample])
        at = Operation(float(record.speed[sample]), float(record.angle[sample]), float(record.time[sample]))
        found.append(_crushed(bearing, motion, at))
    left = record.energy.relative_residual
    if left > MOST_RESIDUAL:
        found.append(
            Unsound(
                Cause.ENERGY,
                f"{100.0 * left:.2g} % of the energy that went through the run is missing or too much (allowed: "
                f"{100.0 * MOST_RESIDUAL:g} %)",
            )
        )
    for bearing in model.bearings:
        part = record.outside.get(bearing.name, 0) / max(record.iterations, 1)
        if part > MOST_OUTSIDE:
            found.append(
                Unsound(
                    Cause.OUTSIDE,
                    f"{bearing.name}: {100.0 * min(part, 1.0):.0f} % of the calls lie outside the map (allowed: "
                    f"{100.0 * MOST_OUTSIDE:g} %), where the law is held at its edge",
                )
            )
    return tuple(entry for entry in found if entry is not None)


def with_unsound(dataset: xr.Dataset, found: Iterable[Unsound]) -> xr.Dataset:
    """The result with the attribute `unsound`, where there is a reason.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result.
    found : iterable of Unsound
        Reasons why its figures mean nothing.
    """
    words = "; ".join(entry.words for entry in found)
    return dataset.assign_attrs(unsound=words) if words else dataset


def _crushed(bearing: BearingElement, motion: FloatArray, operation: Operation) -> Unsound | None:
    """A pressure that no contact carries; None where there is none."""
    if not isinstance(bearing.force, BearingForce):
        return None
    load = float(bearing.rollers(motion, operation).load_per_length.max(initial=0.0))
    contacts = bearing.bearing.geometry.contacts(bearing.bearing.material, "iso16281")
    inner = min(contacts, key=lambda contact: contact.radius)
    half = half_width(load, inner.radius, inner.reduced_modulus)
    pressure = 2.0 * load / (np.pi * half) if half > 0.0 else 0.0
    if pressure <= HARDNESS:
        return None
    return Unsound(
        Cause.PRESSURE,
        f"{bearing.name}: Hertz pressure of {PRESSURE.text(pressure)} is above {PRESSURE.text(HARDNESS)}, the hardness "
        "of bearing steel, which no contact carries",
    )

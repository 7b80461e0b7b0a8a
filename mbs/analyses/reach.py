"""Reach of a law: speeds below its films, where it fades to the dry contact, and what lies outside its map."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.units import LOAD, RPM
from mbs.bearings.contact_report import axes_left
from mbs.bearings.laws import DryLaw
from mbs.model.elements import Operation
from mbs.model.equilibrium import Equilibrium
from mbs.model.matrices import MatrixElement
from mbs.scene.assembly import Model, ring_motions


@dataclass(frozen=True)
class Fade:
    """Speed at which the films of a law begin; between rest and there they are blended with the dry contact.

    Attributes
    ----------
    speed : float
        Speed of the system below which a bearing lies below the lowest speed of its law [rad/s].
    entrainment_speed : float
        That lowest speed [m/s].
    source : str
        What begins there: "the map", or "the table of the film formula".
    """

    speed: float
    entrainment_speed: float
    source: str

    def below(self, speeds: npt.ArrayLike) -> BoolArray:
        """True for speeds of the system [rad/s] that lie in the fade; of the shape of `speeds`."""
        return np.asarray(np.abs(np.asarray(speeds, dtype=np.float64)) < self.speed)


POINTS = "the points of its law"
"""What is left by a bearing whose dry law is given by points."""


def source_of(model: Model) -> str:
    """Source that a law is read from, in words: "the map", "the table of the film formula", or `POINTS`.

    Parameters
    ----------
    model : Model
        Model with its law.
    """
    if model.law.startswith("table "):
        return POINTS
    return "the map" if model.law.startswith(("map ", "maps ")) else "the table of the film formula"


_LOADS = "the loads that "
"""Begin of what is left by a bearing that carries axial load, whose films are known up to a load: behind it they go on
straight in the logarithms."""

SPEED_TABLE = "its table of speeds"
"""What is left by a bearing or spring of matrices over speed."""


def sources_of(model: Model) -> dict[str, str]:
    """Source that each element reads, in words.

    `source_of` the laws of bearings, `SPEED_TABLE` of matrices over speed, and what films of bearings that carry axial
    load are read from.

    Parameters
    ----------
    model : Model
        Model with its law.
    """
    elements = [entry.element for entry in model.system.elements]
    source = source_of(model)
    kinds = {entry.name: SPEED_TABLE for entry in elements if isinstance(entry, MatrixElement)}
    for other in model.located:
        held = f"{_LOADS}{other.film_source or 'the film table'} holds"
        kinds[other.name] = source if other.films is None else held
    return {entry.name: kinds.get(entry.name, source) for entry in elements}


def fade_of(model: Model) -> Fade | None:
    """Find where the films of the model begin; None for laws without films, and for bearings that do not turn."""
    found: list[Fade] = []
    for bearing in model.on_rings:
        lowest, rate = bearing.slowest_film, bearing.entrainment_rate
        if rate > 0.0 and lowest > 0.0:
            found.append(Fade(lowest / rate, lowest, bearing.film_source or source_of(model)))
    return max(found, key=lambda fade: fade.speed, default=None)


def share_below(model: Model, speeds: FloatArray) -> float:
    """Part of some speeds [rad/s] that lies below the law's films, from 0 to 1; 0 for laws without films."""
    fade = fade_of(model)
    return float(np.mean(fade.below(speeds))) if fade is not None and speeds.size else 0.0


def axes_outside(model: Model, speed: float, loads: Mapping[str, float] | None = None) -> dict[str, str]:
    """Find where each bearing leaves the map, if it does: the axis with its value, or where its load ends.

    Parameters
    ----------
    model : Model
        Model with its temperature.
    speed : float
        Speed of the system [rad/s]; the highest one of a run.
    loads : mapping of str to float, optional
        Largest load of a slice [N/m] by bearing; of a run it is not recorded.
    """
    found = {}
    for bearing in model.bearings:
        law = bearing.force.law
        if isinstance(law, DryLaw) and math.isinf(law.highest_load):
            continue
        load = (loads or {}).get(bearing.name, 0.0)
        u = bearing.entrainment_speed(Operation(speed))
        axes = axes_left(law, load, u, bearing.temperature)
        if isinstance(law, DryLaw):
            end = f"{LOAD.text(law.highest_load)}, the last one"
        else:
            end = f"{LOAD.text(law.known_load(u, bearing.temperature))}, where the map ends"
        words = "; ".join(axes) or f"a load above {end}"
        found[bearing.name] = words.replace("the map", source_of(model))
    return found


def fade_lines(model: Model, speeds: FloatArray, of: str = "the speeds") -> list[str]:
    """A line where some of the speeds lie below the films of the law.

    Parameters
    ----------
    model : Model
        The machine with its law.
    speeds : array, shape (n,)
        Speeds of the system [rad/s].
    of : str
        What the speeds are, in words.
    """
    fade = fade_of(model)
    if fade is None or not np.any(fade.below(speeds)):
        return []
    begin = RPM.text(float(np.abs(speeds).min()))
    one = speeds.size == 1
    where = f"{begin} lies" if one else f"{begin.removesuffix(' rpm')} to {RPM.text(fade.speed)} lie"
    share = "" if one else f"{_percent(share_below(model, speeds))} of {of}; "
    return [
        f"warning: {where} below {fade.source} ({share}entrainment speed below {fade.entrainment_speed:.4g} m/s"
        + (f", {RPM.text(fade.speed)}" if one else "")
        + "): the film fades to the dry contact there"
    ]


_ADVICE = {
    "the map": "make a map that reaches there",
    SPEED_TABLE: "give it these speeds too",
    POINTS: "add points that reach there",
}


def outside_lines(
    calls: Mapping[str, int],
    words: str,
    axes: Mapping[str, str],
    case: str = "",
    sources: Mapping[str, str] | None = None,
) -> list[str]:
    """A line for each bearing whose law was called outside its map: every command says it by this function.

    Parameters
    ----------
    calls : mapping of str to int
        How often, by bearing; none where it is 0.
    words : str
        What happened so often, such as "lies outside the map at {} of 40 speeds".
    axes : mapping of str to str
        How it is left, as `axes_outside` says it.
    case : str
        Begins the line, where several are compared.
    sources : mapping of str to str
        What is left, by bearing, as `mbs.analyses.reach.sources_of` calls it; "the map" if left out.
    """
    begin = f"{case}: " if case else ""
    lines = []
    for name, count in calls.items():
        if not count:
            continue
        source = (sources or {}).get(name, "the map")
        left = words.format(count).replace("the map", source)
        axis = f" ({axes[name]})" if name in axes else ""
        held = "it is held at its edge" if source == SPEED_TABLE else "the law is held at its edge"
        if source == POINTS or source.startswith(_LOADS):
            held = "the law goes on straight"
        otherwise = (
            "smaller loads or more speed lie inside"
            if source.startswith(_LOADS)
            else "a map may reach there, `mbs plan` writes its job"
        )
        advice = _ADVICE.get(source, otherwise)
        lines.append(f"warning: {begin}{name}: {left}{axis}, where {held}; {advice}")
    return lines


def _percent(part: float) -> str:
    """A part in per cent, with two digits."""
    return f"{100.0 * part:.2g} %"


def outside_at(model: Model, balance: Equilibrium) -> list[str]:
    """Lines on bearings whose equilibrium lies outside the map.

    Parameters
    ----------
    model : Model
        The machine with its law.
    balance : Equilibrium
        The equilibrium.
    """
    if not any(balance.outside.values()):
        return []
    loads = {
        bearing.name: float(bearing.loads(motion, balance.operation).load_per_length.max())
        for bearing, motion in ring_motions(model, balance.displacement)
    }
    axes = axes_outside(model, balance.operation.speed, loads)
    return outside_lines(balance.outside, "lies outside the map", axes, sources=sources_of(model))

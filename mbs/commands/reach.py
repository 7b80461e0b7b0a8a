"""How far a law reaches: speeds below the lowest of its films, where it fades to the dry contact, and calls outside."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ehdmaps.maps.law import ContactLaw
from ehdmaps.physics._values import FloatArray
from ehdmaps.units import LOAD
from mbs.assembly import Model
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.contact_report import axes_left
from mbs.elements import Operation
from mbs.reading.fields import RPM


@dataclass(frozen=True)
class Fade:
    """Where the films of a law begin; between rest and there they are blended with the dry contact.

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

    def below(self, speeds: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Which speeds of the system [rad/s] lie in the fade; of the shape of `speeds`."""
        return np.asarray(np.abs(np.asarray(speeds, dtype=np.float64)) < self.speed)


def fade_of(model: Model) -> Fade | None:
    """Where the films of the model begin; None for laws without films, and for bearings that do not turn."""
    found: list[Fade] = []
    for bearing in model.bearings:
        law = bearing.force.law if isinstance(bearing.force, BearingForce) else None
        if not isinstance(law, ContactLaw) or not bearing.rates[1] > 0.0 or not law.speed_range[0] > 0.0:
            continue
        lowest = law.speed_range[0]
        source = "the map" if model.law.startswith("map ") else "the table of the film formula"
        found.append(Fade(lowest / bearing.rates[1], lowest, source))
    return max(found, key=lambda fade: fade.speed, default=None)


def share_below(model: Model, speeds: FloatArray) -> float:
    """Part of some speeds [rad/s] that lies below the law's films, from 0 to 1; 0 for laws without films."""
    fade = fade_of(model)
    return float(np.mean(fade.below(speeds))) if fade is not None and speeds.size else 0.0


def fade_lines(model: Model, speeds: FloatArray, of: str = "the speeds") -> list[str]:
    """A line where some of the speeds [rad/s] lie below the films of the law; `of` says what the speeds are."""
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


def axes_outside(model: Model, speed: float, loads: Mapping[str, float] | None = None) -> dict[str, str]:
    """Where each bearing leaves the map, if it does: the axis with its value, or where its load ends.

    Parameters
    ----------
    model : Model
        With its temperature.
    speed : float
        Of the system [rad/s]; the highest one of a run.
    loads : mapping of str to float, optional
        Largest load of a slice [N/m] by bearing; of a run it is not recorded.
    """
    found = {}
    for bearing in model.bearings:
        law = bearing.force.law if isinstance(bearing.force, BearingForce) else None
        if not isinstance(law, ContactLaw):
            continue
        load = (loads or {}).get(bearing.name, 0.0)
        axes = axes_left(law, load, bearing.entrainment_speed(Operation(speed)), bearing.temperature)
        found[bearing.name] = "; ".join(axes) or f"a load above {LOAD.text(law.load_range[1])}, where the map ends"
    return found


def outside_lines(calls: Mapping[str, int], words: str, axes: Mapping[str, str], case: str = "") -> list[str]:
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
    """
    begin = f"{case}: " if case else ""
    return [
        f"warning: {begin}{name}: {words.format(count)}"
        + (f" ({axes[name]})" if name in axes else "")
        + ", where the law is held at its edge; make a map that reaches there"
        for name, count in calls.items()
        if count
    ]


def _percent(part: float) -> str:
    """A part in per cent, with two digits."""
    return f"{100.0 * part:.2g} %"

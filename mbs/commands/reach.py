"""Lines on how far a law reaches: where its films fade to the dry contact, and calls outside the map."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.units import RPM
from mbs.analyses.reach import POINTS, SPEED_TABLE, fade_of, share_below
from mbs.scene.assembly import Model


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
        if source == POINTS:
            held = "the law goes on straight"
        advice = _ADVICE.get(source, "a map may reach there, `mbs plan` writes its job")
        lines.append(f"warning: {begin}{name}: {left}{axis}, where {held}; {advice}")
    return lines


def _percent(part: float) -> str:
    """A part in per cent, with two digits."""
    return f"{100.0 * part:.2g} %"

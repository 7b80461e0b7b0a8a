"""Lines on how far a law reaches: where its films fade to the dry contact, and calls outside the map."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.units import RPM
from mbs.analyses.reach import fade_of, share_below
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


def outside_lines(
    calls: Mapping[str, int], words: str, axes: Mapping[str, str], case: str = "", source: str = "the map"
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
    source : str
        What is left, as `mbs.analyses.reach.source_of` calls it.
    """
    begin = f"{case}: " if case else ""
    advice = (
        "make a map that reaches there" if source == "the map" else "a map may reach there, `mbs plan` writes its job"
    )
    return [
        f"warning: {begin}{name}: {words.format(count)}".replace("the map", source)
        + (f" ({axes[name]})" if name in axes else "")
        + f", where the law is held at its edge; {advice}"
        for name, count in calls.items()
        if count
    ]


def _percent(part: float) -> str:
    """A part in per cent, with two digits."""
    return f"{100.0 * part:.2g} %"

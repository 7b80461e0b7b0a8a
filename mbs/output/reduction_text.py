"""Errors of modes by the reduction of bodies, in words."""

from __future__ import annotations

import math

import numpy as np

from ehdmaps.arrays import FloatArray
from mbs.linearised.mode_part import ModePart
from mbs.linearised.reduction import REACH, cut_off, unknown_ends
from mbs.model.system import System
from mbs.scene.fields import HERTZ
from mbs.settings import ROUND_OFF


def reduction_lines(system: System, frequency: FloatArray, ratio: FloatArray, part: ModePart | None) -> list[str]:
    """Lines on what the reduction of bodies leaves out of modes; none where no body is reduced.

    Parameters
    ----------
    system : System
        The system.
    frequency, ratio : array, shape (...,)
        Frequencies [Hz] and damping ratios of the modes that are shown; NaN where there is none.
    part : ModePart or None
        What is left out of them, of the same shape.
    """
    cut = cut_off(system)
    if not math.isfinite(cut):
        return []
    lines = []
    if part is not None and np.isfinite(frequency).any():
        values = np.array([frequency, ratio])
        known = (values > ROUND_OFF) & np.isfinite(frequency)  # a motion without a frequency has a damping ratio of one
        sizes = np.divide(np.abs(np.array(part)), values, out=np.zeros_like(values), where=known)
        words = [_largest(size, frequency) for size in sizes]
        lines.append(
            f"  reduction: without modes of bodies above {HERTZ.text(cut)}, which change frequencies by up to "
            f"{words[0]}, damping ratios by up to {words[1]}"
        )
        if np.nanmax(frequency) > REACH * cut:
            lines.append(
                f"warning: modes above {HERTZ.text(REACH * cut)} meet those that bodies leave out; raise their cut-off"
            )
    names = unknown_ends(system)
    if names:
        lines.append(
            f"  reduction: what the end of the file of {', '.join(names)} leaves out is not known; reduce it again to "
            "know it"
        )
    return lines


def _largest(sizes: FloatArray, frequency: FloatArray) -> str:
    """The largest part, and of which mode."""
    at = int(np.nanargmax(sizes))
    value = 100.0 * float(sizes.flat[at])
    return f"{value:.2g} %" + (f" (at {HERTZ.text(float(frequency.flat[at]))})" if value >= 0.01 else "")

"""Modes in words: which kinds there are, and where their strain energy is."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import IntArray
from mbs.linearised.modes import Modes

_LEAST_SHARE = 0.05


def kinds(found: Modes) -> tuple[IntArray, IntArray, IntArray]:
    """Return which modes are free, which creep back without oscillating, and which oscillate.

    Parameters
    ----------
    found : Modes
        The modes.
    """
    free = found.free
    creeping = (found.eigenvalues.imag <= 0.0) & ~free
    return np.flatnonzero(free), np.flatnonzero(creeping), np.flatnonzero(~free & ~creeping)


def share_words(found: Modes, mode: int) -> str:
    """Return the parts that have most of the strain energy of a mode.

    Parameters
    ----------
    found : Modes
        The modes.
    mode : int
        Which one, from 0 on.
    """
    order = np.argsort(-found.shares[:, mode], kind="stable")
    shares = [
        f"{found.parts[i]} {100.0 * found.shares[i, mode]:.3g} %"
        for i in order
        if found.shares[i, mode] >= _LEAST_SHARE
    ]
    return ", ".join(shares) or "none"

"""The equations to first order about a profile, whose grid follows the spike and begins at a meniscus that is held."""

from __future__ import annotations

from dataclasses import replace

from ehdmaps.ehl.grid import Spike, lay_out
from ehdmaps.ehl.linearisation import GridShift, Linearisation, Neighbour, linearised
from ehdmaps.ehl.one_grid import LOAD
from ehdmaps.ehl.profile import Profile, front_node
from ehdmaps.ehl.resolution import Resolution
from ehdmaps.ehl.warm_response import WarmLinearisation, warm_linearised

SPIKE_SHIFT = 1e-4
"""Shift of the spike, in its widths, over which the effect of the grid's motion is differenced."""

LENGTH_SHIFT = 1e-5
"""Change of a starved inlet's length over which the effect of its end is differenced, relative to the length, or to the
film where that is less: nodes that move by more change the gap of a thin film."""


def linearised_profile(profile: Profile, resolution: Resolution) -> Linearisation | WarmLinearisation:
    """The equations to first order about a profile, its grid following the spike where there is one.

    The meniscus of a starved contact is held where it is.

    Parameters
    ----------
    profile : Profile
        A converged solution.
    resolution : Resolution
        Settings of the solve that gave it.
    """
    neighbour, longer = None, None
    spike, laid = profile.spike, profile.layout
    if spike is not None:
        shift = SPIKE_SHIFT * spike.width
        moved_spike = Spike(spike.position + shift, spike.width)
        length = laid.length if laid.starved else None
        layout = lay_out(laid.film, resolution.inlet_length, resolution.shape, moved_spike, length)
        neighbour = Neighbour(layout.grid(profile.cells), shift, front_node(profile))
    if profile.warmth is not None:
        rises, first = profile.warmth.rises, profile.warmth.first
        return warm_linearised(profile.problem, profile.grid, profile.unknowns, rises, first, LOAD, neighbour)
    if laid.starved:
        shift = LENGTH_SHIFT * min(laid.length, laid.film)
        longer = GridShift(replace(laid, length=laid.length + shift).grid(profile.cells), shift)
    return linearised(profile.problem, profile.grid, profile.kernel, profile.unknowns, LOAD, neighbour, longer)

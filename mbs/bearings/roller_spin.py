"""Speed at which rollers turn, by the torques of their films and of the oil in the pockets of the cage.

In the frame of the cage both raceways run past a roller at u, and its own surface at s u. A film is dragged along by
the mean speed (1 + s) u/2 and sheared by the difference (1 - s) u. With F the rolling force of pure rolling,
proportional to the mean speed in a given gap, and G = Int eta/h dx of the film, the ring and the oil turn the roller by

    G (1 - s) u - F (1 + s)/4

per length: the traction less the share of one wall in the rolling force. The pocket stands still and brakes by P s u.
The sum over both contacts and all slices is zero at

    s = (G u - F/4)/(G u + F/4 + P u).

Between rigid surfaces G = 2.849 eta sqrt(R/h) and F = 9.202 eta u sqrt(R/h): without a pocket s is 0.1065 in any gap.
A loaded contact adds (eta(p) - eta0) 2 b/h, at the mean Hertz pressure p over the width 2 b, and s is near 1.

The pocket is two flat bars, each at half of the clearance c from a roller of diameter D, their gaps full of oil of
ambient pressure: P = 2 pi eta sqrt(2 D/c).

The slower the roller the thinner its films: the gap of both contacts together stays, and so does the centrifugal load q
between them. In each slice w h/(1 + s) stays, as between rigid surfaces, so that with S = h_i + h_o

    (1 + s) (w_i h_i)/(2 h_i') + q = (1 + s) (w_o h_o)/(2 h_o'),        h_i' + h_o' = S.

F and G go with h'^(-1/2). Where one contact carries nothing, the film of the other goes with 1 + s.

Limits: the cage turns at the speed of rolling. Laws of shear, heat in the film and the shorter inlet of a starved film
are not in G: each makes it smaller. A contact that needs them is a loaded one, whose slip is thousandths.

References
----------
B. J. Hamrock, Fundamentals of Fluid Film Lubrication, McGraw-Hill, 1994: forces of rigid cylinders that roll and slide.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.physics.lubricant import LubricantState
from mbs.bearings.bearing import Bearing
from mbs.bearings.films import ContactState

SHEAR_CONSTANT = 2.848722
"""Int dx/h over sqrt(R/h0), of a parabolic gap up to the exit by Reynolds' condition, at 0.475130 sqrt(2 R h0)."""

MOST_VISCOUS = 1e12
"""Largest viscosity that a film is given [Pa s]: at such ones rollers roll."""

ROUNDS, ROUND_OFF = 60, 1e-12
"""Rounds in which films and speeds are found together, and the change of the speed at which they are."""


@dataclass(frozen=True, eq=False)
class DrivenRollers:
    """Rollers whose speed follows from the torques on them.

    Attributes
    ----------
    spin : array (Z,)
        Speed s of each over that of rolling.
    power : array (2, Z)
        What the films at the inner and at the outer raceway take, each with half of that of the pocket [W].
    """

    spin: FloatArray
    power: FloatArray


def driven_rollers(
    bearing: Bearing,
    sides: tuple[ContactState, ContactState],
    loads: tuple[FloatArray, FloatArray],
    oil: LubricantState,
    speed: float,
) -> DrivenRollers:
    """Speeds of the rollers, and what their films take.

    Parameters
    ----------
    bearing : Bearing
        The bearing; without a clearance of its pockets the films alone turn the rollers.
    sides : (ContactState, ContactState)
        Inner and outer contacts of all slices of rollers that roll, arrays (Z, n).
    loads : (array, array)
        Their loads, (Z, n) [N/m].
    oil : LubricantState
        The oil at the temperature of the raceways.
    speed : float
        Entrainment speed u of rolling, > 0 [m/s].
    """
    contacts = bearing.geometry.contacts(bearing.material, "iso16281")
    radius, modulus = (
        np.array([getattr(contact, name) for contact in contacts])[:, None, None]
        for name in ("radius", "reduced_modulus")
    )
    weights, central = np.stack(loads), np.stack([side.central_film for side in sides])
    there = (weights > 0.0) & (central > 0.0)
    gaps = np.where(there, central, 1.0)
    pressure = np.stack([side.hertz_pressure for side in sides])
    thickened = np.minimum(oil.viscosity_at(0.25 * math.pi * pressure), MOST_VISCOUS) - oil.viscosity
    shear = (
        SHEAR_CONSTANT * oil.viscosity * np.sqrt(radius / gaps) + 8.0 * radius * pressure / modulus * thickened / gaps
    )
    shear = np.where(there, shear, 0.0)
    rolling = np.where(there, np.stack([side.rolling_force for side in sides]), 0.0)
    brake = pocket_drag(bearing, oil.viscosity) * gaps.shape[2]
    spin = np.ones(gaps.shape[1])
    for _ in range(ROUNDS):
        films = _films(gaps, there, weights, 0.5 * (1.0 + spin)[:, None])
        held, dragged = (np.sqrt(gaps / films) * of_film for of_film in (shear, rolling))
        drives, resists = held.sum(axis=(0, 2)) * speed, 0.25 * dragged.sum(axis=(0, 2))
        all_of_them = np.maximum(drives + resists + brake * speed, _TINY)
        before, spin = spin, np.where(drives > 0.0, np.maximum(drives - resists, 0.0) / all_of_them, 1.0)
        if np.max(np.abs(spin - before)) < ROUND_OFF:
            break
    taken = held.sum(axis=2) * ((1.0 - spin) * speed) ** 2 + dragged.sum(axis=2) * (0.5 * (1.0 + spin)) ** 2 * speed
    in_pocket = np.where(drives > 0.0, brake * (spin * speed) ** 2, 0.0)
    return DrivenRollers(spin, bearing.slice_length * (taken + 0.5 * in_pocket))


def pocket_drag(bearing: Bearing, viscosity: float) -> float:
    """Force by which the pocket brakes a roller, over its length and the speed of its surface [Pa s].

    Parameters
    ----------
    bearing : Bearing
        The bearing; without a clearance of its pockets there is none.
    viscosity : float
        eta of the oil at ambient pressure [Pa s].
    """
    if bearing.pocket_clearance is None:
        return 0.0
    return 2.0 * math.pi * viscosity * math.sqrt(2.0 * bearing.geometry.roller_diameter / bearing.pocket_clearance)


def _films(gaps: FloatArray, there: BoolArray, weights: FloatArray, drag: FloatArray) -> FloatArray:
    """Films (2, Z, n) [m] at a mean speed of `drag` (Z, 1), from those of rolling, where it is 1, and their loads."""
    together, thrown = gaps.sum(axis=0), weights[1] - weights[0]
    inner, outer = drag * weights * gaps
    # q h^2 + (inner + outer - q S) h - inner S = 0 for the inner film h, between zero and S
    middle = inner + outer - thrown * together
    root = np.sqrt(middle**2 + 4.0 * thrown * inner * together)
    with np.errstate(divide="ignore", invalid="ignore"):
        film = np.where(middle > 0.0, 2.0 * inner * together / (root + middle), (root - middle) / (2.0 * thrown))
    return np.where(there.all(axis=0), np.stack([film, together - film]), drag * gaps)


_TINY = 1e-300

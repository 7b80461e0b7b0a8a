"""Slices of cylindrical rollers at rest, for small motions: films that relax, and errors of their law.

In linear analyses each slice answers at its own frequency: its film moves like a damper as long as it can follow, and
is locked at high frequency: stiffness and damping k and c of the map become k + s c/(1 + s theta), with the relaxation
time theta of `ehdmaps.maps.kernels.memory_table`. That is the law which films with memory follow in time, for small
oscillations about an equilibrium. A stiffer or more damped slice keeps the stiffness of its locked film.

A slice follows the ports of its bearing: massless rollers, with both contacts in series, the pose of the inner ring;
the inner and the outer contacts of rollers that are bodies both rings and the rollers.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.maps.kernels.memory_table import equilibrium_at
from ehdmaps.physics.hertz import half_width
from mbs.bearings.force_at_point import RollerLoads
from mbs.model.condensed import Condensed
from mbs.model.contacts import Contacts, LawSlopes, Slopes, followed, law_slopes
from mbs.model.relaxation import Relaxation, relaxing

if TYPE_CHECKING:
    from ehdmaps.maps.law_films import LawAtPoint

_SMALL = 1e-10
"""Step of the approach by which the law is differentiated once more [m]."""


class Side(NamedTuple):
    """Slices of rollers that have the same law: massless ones, or one side of rollers that are bodies.

    Attributes
    ----------
    law : LawAtPoint
        The law at the speed and temperature of the bearing.
    pose : array (Z, 2, p)
        Approach of the middle of each roller, and how it grows along it, by the ports of the bearing.
    approach : array (Z, n)
        Approaches at rest [m].
    positions : array (n,) or (Z, n)
        Places of the slices where rollers grow by [m].
    length : float
        Length of a slice [m].
    """

    law: LawAtPoint
    pose: FloatArray
    approach: FloatArray
    positions: FloatArray
    length: float

    def state(self, step: float = 0.0) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Load [N/m], stiffness [N/m] and damping [N s/m] of each slice, shape (Z, n) each.

        Parameters
        ----------
        step : float
            Added to the approaches [m].
        """
        approach = self.approach + step
        load, stiffness, damping = self.law(approach, np.zeros_like(approach))
        return load, stiffness * self.length, damping * self.length

    @property
    def feel(self) -> FloatArray:
        """Approach of each slice by that of the middle of its roller and its growth, shape (Z, n, 2)."""
        along = np.stack([np.ones_like(self.positions), self.positions], axis=-1)
        return np.broadcast_to(along, (*self.approach.shape, 2))


def relaxation_times(law: LawAtPoint, approach: FloatArray) -> FloatArray:
    """Relaxation times theta of contacts at rest [s], in the shape of their approaches [m]; 0 without load or film.

    Parameters
    ----------
    law : LawAtPoint
        The law at a speed and temperature; with centrifugal load times are those without it, as an estimate.
    approach : array
        Approaches [m].
    """
    _, k, _, dy, _, dg = (np.asarray(read) for read in equilibrium_at(_thrown_by_none(law).memory.table, approach))
    # k_s = k/(1 - dy) and G' = c k_s/(k_s - k) make theta = c/(k_s - k) = G'/k_s.
    return np.divide(dg * (1.0 - dy), k, out=np.zeros_like(k), where=k > 0.0)  # type: ignore[no-any-return]


def natural_times(law: LawAtPoint, approach: FloatArray) -> FloatArray:
    """Natural times sqrt(b^2 + 2 h R)/u of contacts at rest [s], in the shape of their approaches; infinite at rest.

    h is the film of each contact in series, from which the little is left out by which oil stiffens the structure.

    Parameters
    ----------
    law : LawAtPoint
        The law at a speed and temperature; with centrifugal load times are those without it, as an estimate.
    approach : array
        Approaches [m].
    """
    loads, _, y, _, _, _ = equilibrium_at(_thrown_by_none(law).memory.table, approach)
    films = np.maximum(-y, 0.0)
    contacts = law.law.contacts
    radius = sum(contact.radius for contact in contacts) / len(contacts)
    half = half_width(np.maximum(loads, 0.0), radius, contacts[0].reduced_modulus)
    size = np.sqrt(half**2 + 2.0 * films / len(contacts) * radius)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(size / abs(law.entrainment_speed))


def massless_side(law: LawAtPoint, rollers: RollerLoads, length: float) -> Side:
    """Slices of massless rollers, by the pose of the inner ring (6,).

    Parameters
    ----------
    law : LawAtPoint
        The law at the speed and temperature.
    rollers : RollerLoads
        The rollers at rest.
    length : float
        Length of a slice [m].
    """
    c, s = np.cos(rollers.angle), np.sin(rollers.angle)
    pose = np.zeros((rollers.angle.size, 2, 6))
    pose[:, 0, 1], pose[:, 0, 2], pose[:, 1, 4], pose[:, 1, 5] = c, s, -s, c
    pose[:, 0] += rollers.row[:, None] * pose[:, 1]
    return Side(law, pose, rollers.approach, rollers.position, length)


def slice_relaxation(sides: Sequence[Side], damping: Sequence[FloatArray] | None = None) -> Relaxation:
    """Springs in series with the dampers of all slices, by the ports of their bearing.

    Parameters
    ----------
    sides : sequence of Side
        The sides of its contacts.
    damping : sequence of array (Z, n), optional
        Damping of the slices of each side [N s/m], where the bearing has that of another table; of the law if left out.
    """
    if damping is None:
        damping = [side.state()[2] for side in sides]
    rows = [(side.feel @ side.pose).reshape(-1, side.pose.shape[2]) for side in sides]
    times = [relaxation_times(side.law, side.approach).ravel() for side in sides]
    return relaxing(np.concatenate(rows), np.concatenate([part.ravel() for part in damping]), np.concatenate(times))


def slices_in_balance(sides: Sequence[Side], *, relaxes: bool) -> Condensed | None:
    """Condense the slices of a bearing; None where nothing rolls, so that there are no films.

    Parameters
    ----------
    sides : sequence of Side
        The sides of its contacts, at least one.
    relaxes : bool
        Whether films have a memory.
    """
    if any(side.law.entrainment_speed == 0.0 for side in sides):
        return None
    loads, *numbers = zip(*(side.state() for side in sides), strict=True)
    k, c = (np.concatenate(parts) for parts in numbers)
    times = np.concatenate([relaxation_times(side.law, side.approach) for side in sides])
    natural = np.concatenate([natural_times(side.law, side.approach) for side in sides])
    feel, pose = (np.concatenate([getattr(side, name) for side in sides]) for name in ("feel", "pose"))
    nothing, ones = np.zeros((k.shape[0], 2, 2)), np.ones((*k.shape, 1))
    contacts = Contacts(feel, nothing, k, c, ones, times[..., None])
    responses = [
        (side.law.law.film_response(load[load > 0.0], *side.law.conditions[:2]), load > 0.0)
        for side, load in zip(sides, loads, strict=True)
    ]

    def left_out(s: ComplexArray) -> tuple[ComplexArray, FloatArray]:
        part, doubt = np.zeros((s.size, *k.shape), dtype=np.complex128), np.zeros((s.size, *k.shape))
        first = 0
        for response, on in responses:
            assert response is not None
            own = slice(first, first + on.shape[0])
            part[:, own][:, on], doubt[:, own][:, on] = response.correction(s), response.doubt(s)
            first = own.stop
        return part, doubt

    known = all(response is not None for response, _ in responses)
    slopes = _slopes(sides, loads, contacts, pose, relaxes)
    return Condensed(contacts, pose, relaxes, slopes, natural, left_out if known else None)


def _slopes(
    sides: Sequence[Side], loads: Sequence[FloatArray], contacts: Contacts, pose: FloatArray, relaxes: bool
) -> Slopes | None:
    """Derivatives of slices under loads (Z, n) [N/m] of each side; None where a law states no errors."""
    bounds = [side.law.bounds(load.ravel()) for side, load in zip(sides, loads, strict=True)]
    stated = [one for one in bounds if one is not None]
    if len(stated) < len(bounds):
        return None
    k, c, times = contacts.stiffness, contacts.damping, contacts.times[..., 0]
    _, k_ahead, c_ahead = (np.concatenate(parts) for parts in zip(*(side.state(_SMALL) for side in sides), strict=True))
    ahead = [relaxation_times(side.law, side.approach + _SMALL) for side in sides] if relaxes else [times]
    nearby = (k_ahead, k), (c_ahead, c), (np.concatenate(ahead), times)
    k_rise, c_rise, times_rise = ((after - now) / _SMALL for after, now in nearby)
    stiffness, damping, films = (
        np.concatenate([getattr(one, name) for one in stated]).reshape(k.shape)
        for name in ("stiffness", "damping", "film_offset")
    )
    no_shares = np.zeros(contacts.shares.shape)
    law = LawSlopes(k_rise, c_rise, no_shares, times_rise[..., None], stiffness, damping, films)
    return law_slopes(contacts, followed(contacts, pose, films), law, locked=True)


def _thrown_by_none(law: LawAtPoint) -> LawAtPoint:
    """The law without centrifugal load."""
    return law if law.centrifugal_load == 0.0 else law.law.at(law.entrainment_speed, law.temperature)

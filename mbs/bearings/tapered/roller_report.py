"""Pressures and films of tapered rollers, and of rollers between ribs, at rest, and the cost of rolling.

Hertz pressures are those at the radius of each slice. Films and rolling forces are those at the radius and speed of the
middle of a roller, as in the balance, see `mbs.bearings.tapered.line_film`. Ends of rollers slide on ribs in the
direction of rolling, at one traction.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from mbs.bearings.contact_report import TRACTION, BearingContacts, RollingLoss, loss_of
from mbs.bearings.films import DryContacts
from mbs.bearings.tapered.line_film import cylinder_of
from mbs.bearings.tapered.tapered_bearing import TaperedForce, TaperedLoads


def roller_contacts(
    force: TaperedForce, rollers: TaperedLoads, films: Any, speeds: tuple[float, float]
) -> tuple[BearingContacts, RollingLoss]:
    """Pressures and films of all slices, and the loss of rolling.

    Parameters
    ----------
    force, rollers : TaperedForce, TaperedLoads
        The bearing, and its loads at rest.
    films : callable or None
        Films over the speed, of which `lines`, a `FilmSource`, knows those of lines of the middle of a roller at their
        `temperature`; None for dry lines.
    speeds : (float, float)
        Speeds of the inner and the outer ring [rad/s].
    """
    geometry, u = force.geometry, abs(force.geometry.entrainment_speed(*speeds))
    dry = DryContacts(cylinder_of(geometry).contacts(force.material, "iso16281"))
    source, temperature = getattr(films, "lines", dry), float(getattr(films, "temperature", 0.0))
    sides = []
    for side, contact in enumerate(geometry.contacts(force.material)):
        state = source.state(side, rollers.slices[side], u, temperature)
        radii = np.array([geometry.radius_at(place, side) for place in force.positions.tolist()])
        pressure = np.sqrt(rollers.slices[side] * contact.reduced_modulus / (2.0 * np.pi * radii))
        higher = np.where(state.hertz_pressure > 0.0, pressure / np.maximum(state.hertz_pressure, 1e-300), 1.0)
        sides.append(dataclasses.replace(state, hertz_pressure=pressure, max_pressure=higher * state.max_pressure))
    rolling = np.stack([side.rolling_force.sum(axis=1) for side in sides])
    power = rolling * geometry.roller_length / force.positions.size * u
    sliding = 0.0
    for rib, load in zip(force.ribs, rollers.ribs, strict=True):
        ring, end = geometry.rib_speeds(*speeds, outer=rib.outer, radius=rib.radius)
        sliding += TRACTION * float(load.sum()) * abs(ring - end)
    return BearingContacts(*sides), loss_of(power, rollers.load[0], speeds[0] - speeds[1], sliding=sliding)

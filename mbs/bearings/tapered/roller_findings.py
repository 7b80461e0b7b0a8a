"""Findings of rollers with ribs alone, tapered or not: too little axial load, strength of ribs, loads at the ends."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.hertz import LINE_LIMIT, max_pressure
from ehdmaps.physics.rollers.ribbed_geometry import LARGEST_SHARE, RibbedGeometry, axial_limit
from mbs.bearings.tapered.tapered_bearing import TaperedForce, TaperedLoads
from mbs.model.findings import CARRIES, OPEN, Cause, Finding, Gauge


def roller_gauge(force: TaperedForce, rollers: TaperedLoads) -> Gauge:
    """Measure what the rollers feel, and what is beyond their limits.

    Parameters
    ----------
    force : TaperedForce
        The bearing.
    rollers : TaperedLoads
        Loads of rollers, slices and ribs.
    """
    pressure = np.array([float(np.max(side)) for side in line_pressures(force, rollers)])
    own = (_slack(force, rollers), _limits(force, rollers), _edges(force, rollers))
    return Gauge("roller", rollers.load[:2], pressure, LINE_LIMIT, tuple(one for one in own if one is not None))


def line_pressures(force: TaperedForce, rollers: TaperedLoads) -> FloatArray:
    """Largest Hertz pressures of the slices of cone and cup, each with its own radius, shape (2, Z) [Pa].

    Parameters
    ----------
    force : TaperedForce
        The bearing.
    rollers : TaperedLoads
        Loads of the slices.
    """
    geometry = force.geometry
    pressure = np.zeros((2, rollers.angle.size))
    for side, contact in enumerate(geometry.contacts(force.material)):
        radii = np.array([geometry.radius_at(place, side) for place in force.positions.tolist()])
        # pressure goes with the root of load over radius
        worst = np.max(rollers.slices[side] / radii, axis=1)
        pressure[side] = np.asarray(max_pressure(worst, 1.0, contact.reduced_modulus))
    return pressure


def _slack(force: TaperedForce, rollers: TaperedLoads) -> Finding | None:
    """Less than half of the tapered rollers carry load."""
    if not force.geometry.contact_angle:
        return None
    cone = rollers.load[0]
    share = np.count_nonzero(cone > CARRIES * cone.max()) / cone.size
    if share >= 0.45 or not np.any(cone > OPEN):
        return None
    words = (
        f"{100.0 * share:.3g} % of the rollers carry load, less than half: the axial load is below 0.5 Fr/Y, which a "
        "mounted bearing gets from the other one"
    )
    return Finding(Cause.SLACK, words, excess=0.5 / max(share, 1e-3))


def _limits(force: TaperedForce, rollers: TaperedLoads) -> Finding | None:
    """An axial load beyond what catalogues allow ribs."""
    if not isinstance(force.geometry, RibbedGeometry):
        return None
    along, across = 0.0, rollers.load[0]
    for rib, load in zip(force.ribs, rollers.ribs, strict=True):
        if not rib.outer:
            along, across = along + rib.normal[0] * float(load.sum()), across + rib.normal[1] * load
    axial, radial = abs(along), abs(complex(across @ np.exp(1j * rollers.angle)))
    limit, most = axial_limit(force.geometry.name), LARGEST_SHARE * radial
    found = [(axial / max(most, 1e-300), f"{LARGEST_SHARE:g} Fr = {most:.4g} N")] if axial > max(most, OPEN) else []
    if limit is not None and axial > limit:
        found.append((axial / limit, f"{limit:.4g} N, the strength of ribs"))
    if not found:
        return None
    words = f"axial load of {axial:.4g} N is above what SKF allows: {' and '.join(part for _, part in found)}"
    return Finding(Cause.RIB, words, excess=max(part for part, _ in found))


def _edges(force: TaperedForce, rollers: TaperedLoads) -> Finding | None:
    """Loads that crowd at an end of the rollers."""
    carries = rollers.load[:2] > CARRIES * rollers.load[:2].max()
    off = float(np.max(np.abs(np.where(carries, rollers.centre, 0.0)))) / force.geometry.roller_length
    if off < 1.0 / 6.0:
        return None
    words = f"loads lie {100.0 * off:.3g} % of the length beside the middle of rollers: they crowd at an end"
    return Finding(Cause.EDGE, words, excess=6.0 * off)

"""Integrals of dA/h over solved fields: the oracle of `ehdmaps.electrics`, which shares no rule with it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.integrate import trapezoid

from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.point import solve
from ehdmaps.point.two_grids import Resolution


def point_field_integral(solution: Any, outer_gap: float) -> float:
    """Int dA/h of a solved point up to a gap [m]: its field, and rays with the load as a point beyond the grid."""
    field, ellipse = solution.field, solution.ellipse
    x, y, film = (np.asarray(values) for values in (field.x, field.y, field.film))
    inside = 2.0 * trapezoid(trapezoid(1.0 / film, y, axis=1), x)
    angles = (np.arange(360) + 0.5) * math.pi / 360.0
    beyond = 0.0
    for angle in angles:
        c, s = math.cos(angle), math.sin(angle)
        edge = min((x[-1] if c > 0.0 else -x[0]) / max(abs(c), 1e-12), y[-1] / max(s, 1e-12))
        bend = 0.5 * (c * c / ellipse.rolling_radius + s * s / ellipse.transverse_radius)
        r = np.geomspace(edge, math.sqrt((outer_gap + solution.approach) / bend), 400)
        gap = bend * r * r - solution.approach + 2.0 * solution.load / (math.pi * ellipse.reduced_modulus * r)
        beyond += float(trapezoid(r * r / gap, np.log(r))) * math.pi / angles.size
    return float(inside + 2.0 * beyond)


def fine_point(ellipse: Ellipse, oil: Any, load: float, speed: float, temperature: float) -> tuple[Any, Any]:
    """The contact on the usual grid, and on a finer one."""
    usual = Resolution()
    coarse, fine = (solve(ellipse, oil, load, speed, temperature, resolution=each) for each in (usual, usual.finer))
    return coarse, fine


def line_field_integral(profile: Any, half: float, radius: float) -> float:
    """Int dx/h of a solved line: its field, and the gap of the dry contact beyond it, opened by the film there."""
    x, film = np.asarray(profile.x), np.asarray(profile.film)
    total = float(trapezoid(1.0 / film, x))
    for end, there in ((x[-1], film[-1]), (-x[0], film[0])):
        place = np.geomspace(max(end, 1.0001 * half) / half, 1e4 * radius / half, 4000)
        root = np.sqrt(place**2 - 1.0)
        gap = half**2 / (2.0 * radius) * (place * root - np.log(place + root))
        total += float(trapezoid(half / (gap - gap[0] + there), place))
    return total

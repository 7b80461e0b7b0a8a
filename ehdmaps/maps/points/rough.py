"""Asperities of rough surfaces and the film of a point contact share its load, as those of a line do.

A film that carries the share s of the pressure on the shape of the whole pressure is that of the viscosity eta0/s and
the pressure-viscosity alpha s: M s^(3/4) and L s^(3/4), lengths by s^(-1/2). The same oil has it at the load F s^3 and
the speed u s^3, where pressures are s times as high and lengths s^2 times as long,

    h(s) = s^(-2) h(F s^3, u s^3),

so that the film table of points is read there: exact for any law of viscosity and density over pressure. Both leave the
same gap, see `ehdmaps.maps.rough_layer`:

    h(s) = sigma (phi(x) + x Phi(x)),    p_a(x) = (1 - s) (2/3) p_H,

2/3 p_H the mean Hertz pressure of an ellipse; x sigma takes the place of the film offset.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from ehdmaps.arrays import FloatArray
from ehdmaps.maps.rough_layer import LOG_STEP, asperities_of
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.surface import Surface
from ehdmaps.table.points.file import shipped_point_table

SHARES = np.geomspace(1.0, 0.03, 15)
"""Shares at which the table is read; films go on straight in the logarithms where it ends."""

THINNER = -0.14
"""d ln h/d ln s of a film that the table does not hold: 0.53 - 0.67 of Hamrock and Dowson's exponents."""

_HALVINGS = 60


def shared_films(ellipse: Ellipse, oil: Lubricant, load: FloatArray, speed: float, temperature: float) -> FloatArray:
    """ln h(s)/h(1) of film offsets at `SHARES`, shape (n, 15).

    Parameters
    ----------
    ellipse, oil
        Contact and oil.
    load : ndarray, shape (n,)
        F [N], > 0.
    speed, temperature : float
        u [m/s], > 0, and T [K].
    """
    cube = SHARES**3
    films = shipped_point_table().films(ellipse, oil, load[:, None] * cube, speed * cube, temperature)
    with np.errstate(invalid="ignore"):
        logs = np.where(films.usable, np.log(films.film_offset) - 2.0 * np.log(SHARES), np.nan)
    logs -= logs[:, :1]
    steps = np.diff(np.log(SHARES))
    for k in range(1, SHARES.size):
        slope = THINNER if k == 1 else (logs[:, k - 1] - logs[:, k - 2]) / steps[k - 2]
        straight = (logs[:, k - 1] if k > 1 else 0.0) + slope * steps[k - 1]
        logs[:, k] = np.where(np.isfinite(logs[:, k]), logs[:, k], straight)
    logs[:, 0] = 0.0
    return np.asarray(logs)


def load_shares(
    surface: Surface, ellipse: Ellipse, load: FloatArray, film: FloatArray, thicker: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Share s of the film in the load, and the distance x sigma of the mean planes [m], each (n,).

    Parameters
    ----------
    surface : Surface
        A rough one.
    ellipse : Ellipse
        The contact.
    load, film : ndarray, shape (n,)
        F [N], > 0, and film offset between smooth surfaces [m].
    thicker : ndarray, shape (n, 15)
        What `shared_films` gives.
    """
    asperities, sigma = asperities_of(surface, ellipse.reduced_modulus), surface.roughness
    mean = np.log((2.0 / 3.0) * np.asarray(ellipse.max_pressure(load)))
    low, high = np.full(load.size, asperities.start), np.maximum(mean, asperities.start)
    wanted, places, rows = np.log(film / sigma), np.log(SHARES[::-1]), np.arange(load.size)
    curves = CubicSpline(places, thicker[:, ::-1], axis=1).c  # (4, 14, n)
    tables = asperities.distance, asperities.log_gap
    slopes = asperities.distance_slope, asperities.log_gap_slope

    def read(which: int, logs: FloatArray) -> FloatArray:
        """Distance (0) or ln of the gap (1) of asperities at ln of their pressure; cubics."""
        values, slope = tables[which], LOG_STEP * slopes[which]
        at = np.clip((logs - asperities.start) / LOG_STEP, 0.0, values.size - 1.0)
        cell = np.minimum(at.astype(np.int64), values.size - 2)
        t, change = at - cell, values[cell + 1] - values[cell]
        rise, fall = slope[cell], slope[cell + 1]
        return np.asarray(
            values[cell] + t * (rise + t * (3.0 * change - 2.0 * rise - fall + t * (rise + fall - 2.0 * change)))
        )

    def share_of(logs: FloatArray) -> FloatArray:
        return np.asarray(-np.expm1(np.minimum(logs - mean, 0.0)))

    def film_at(share: FloatArray) -> FloatArray:
        """ln h(s)/h(1); straight below the lowest share."""
        asked = np.log(np.maximum(share, 1e-300))
        held = np.clip(asked, places[0], 0.0)
        cell = np.clip(np.searchsorted(places, held, side="right") - 1, 0, places.size - 2)
        third, second, first, begin = curves[:, cell, rows]
        step = held - places[cell]
        slope = first + step * (2.0 * second + step * 3.0 * third)
        return np.asarray(begin + step * (first + step * (second + step * third)) + slope * (asked - held))

    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        # the gap of asperities falls as they carry more, that of the film grows
        wide = read(1, middle) > wanted + film_at(share_of(middle))
        low, high = np.where(wide, middle, low), np.where(wide, high, middle)
    found = 0.5 * (low + high)
    apart = wanted >= asperities.log_gap[0]  # no asperity reaches the other surface
    return np.where(apart, 1.0, share_of(found)), np.where(apart, film, sigma * read(0, found))

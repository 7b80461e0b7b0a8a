"""Films of both raceways of a tapered roller bearing at one speed, as tables that its kernel reads.

Any law of lines serves: of a map, of the film table, of a formula. It is asked for a cylindrical roller bearing whose
two reduced radii and roller length are those of the middle of a roller, `cylinder_of`, at the speed of the middle.
Radius and speed grow towards the large end, by some 5 % at its very end, and films with them: that is left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.rollers.tapered_geometry import TaperedGeometry
from mbs.bearings.locating.normal_law import NormalLaw, PairLaw, on_rows

if TYPE_CHECKING:
    from ehdmaps.maps.law import ContactLaw
    from ehdmaps.maps.law_films import LawAtPoint

NODES, KNEE = 1200, 0.3e-6
"""Nodes, and the width about approach zero in which they lie dense: films begin to carry there [m]."""

LOADS = (1e2, 2e6)
"""Lowest and highest load of the tables [N/m]; they go on straight in the logarithms."""

_FAR = 1e-3

_TRIED, _ZOOMS = 65, 10
"""Places among which the ends of a table are looked for at once, and how often, until they are apart by round-off."""


@dataclass(frozen=True, eq=False)
class LineFilms(PairLaw):
    """Laws of both lines of a whole roller at cone and cup at one speed, see `PairLaw`.

    Attributes
    ----------
    points : tuple of LawAtPoint
        Laws of which both were made, inner and outer; none for dry lines.
    """

    points: tuple[LawAtPoint, ...] = ()

    def springs_on(self, side: int, law: NormalLaw, table: FloatArray) -> FloatArray:
        """K [N/m] and theta [s] of a spring in series with the damper of slow motion, see `PairLaw.springs_on`."""
        from mbs.bearings.slices_in_balance import relaxation_times  # with the kernels of films with memory

        approach, _, damping = on_rows(law, table)
        times = relaxation_times(self.points[side], approach)
        relaxes = times > 0.0
        if not np.any(relaxes):
            return np.column_stack([times, np.ones_like(times)])
        # between rows with theta and without, K goes to zero, not theta
        whole = np.interp(np.arange(times.size), np.flatnonzero(relaxes), times[relaxes])
        return np.column_stack([np.where(relaxes, damping / whole, 0.0), whole])


DRY_LINES = LineFilms(NormalLaw(1.0), NormalLaw(1.0))
"""Lines without films."""


def cylinder_of(geometry: TaperedGeometry) -> BearingGeometry:
    """Cylindrical roller bearing with the reduced radii of the middle of a roller.

    Parameters
    ----------
    geometry : TaperedGeometry
        The tapered roller bearing.

    Examples
    --------
    >>> bearing = TaperedGeometry("a", 10e-3, 15e-3, 60e-3, 17, 0.25)
    >>> abs(cylinder_of(bearing).inner_radius / bearing.radius_at(0.0, 0) - 1.0) < 1e-12
    True
    """
    inner, outer = (geometry.radius_at(0.0, side) for side in (0, 1))
    diameter = inner + outer
    pitch = diameter * diameter / (outer - inner)
    return BearingGeometry(
        f"lines of {geometry.name}",
        pitch - diameter,
        pitch + diameter,
        diameter,
        geometry.roller_length,
        geometry.rollers,
        0.0,
    )


def line_films(
    laws: tuple[ContactLaw, ContactLaw], length: float, entrainment_speed: float, temperature: float
) -> LineFilms:
    """Laws of both lines at a speed; dry ones where nothing rolls.

    Parameters
    ----------
    laws : (ContactLaw, ContactLaw)
        Laws of the contacts of `cylinder_of` a bearing, "inner" and "outer".
    length : float
        Length of the roller [m].
    entrainment_speed, temperature : float
        u [m/s], T [K].

    Raises
    ------
    InputError
        If a law has no load that rises through the range of the table.
    """
    if entrainment_speed == 0.0:
        return DRY_LINES
    inner, outer = (line_film(law, length, entrainment_speed, temperature) for law in laws)
    points = tuple(law.at(entrainment_speed, temperature) for law in laws)
    return LineFilms(inner, outer, (LOADS[0] * length, LOADS[1] * length), points)


def line_film(law: ContactLaw, length: float, entrainment_speed: float, temperature: float) -> NormalLaw:
    """Table of one contact at a speed: load, stiffness and damping of a whole roller over the approach.

    Parameters
    ----------
    law : ContactLaw
        Law of the contact, "inner" or "outer".
    length : float
        Length of the roller [m].
    entrainment_speed, temperature : float
        u [m/s], T [K].

    Raises
    ------
    InputError
        If the law has no load that rises through the range of the table.
    """
    point = law.at(entrainment_speed, temperature)

    ends = []
    for target in LOADS:
        low, high = -_FAR, _FAR
        for _ in range(_ZOOMS):
            tried = np.linspace(low, high, _TRIED)
            above = int(np.searchsorted(point.evaluate(tried, np.zeros(_TRIED))[0], target))
            low, high = float(tried[max(above - 1, 0)]), float(tried[min(above, _TRIED - 1)])
        ends.append(0.5 * (low + high))
    if not -0.9 * _FAR < ends[0] < ends[1] < 0.9 * _FAR:
        raise InputError(f"line film: got no approach with {LOADS[0]:g} to {LOADS[1]:g} N/m; allowed: a law that has")
    first, last = (float(np.arcsinh(end / KNEE)) for end in ends)
    nodes: FloatArray = np.linspace(first, last, NODES)
    place = KNEE * np.sinh(nodes)
    w, k, c = (np.asarray(values) * length for values in point.evaluate(place, np.zeros_like(place))[:3])
    if not (np.all(w > 0.0) and np.all(k > 0.0) and np.all(c > 0.0)):
        raise InputError("line film: got loads, stiffness or damping that are not positive; allowed: positive ones")
    width = float(nodes[1] - nodes[0])
    # the kernel's law is F = g^(3/2)
    rise = (2.0 / 3.0) * k / w * KNEE * np.cosh(nodes) * width
    logs = np.log(c)
    table = np.stack((np.log(w) * (2.0 / 3.0), rise, logs, np.gradient(logs)), axis=1)
    return NormalLaw(1.0, 0.0, 0.0, 0.0, KNEE, first, width, np.ascontiguousarray(table))

"""Load sharing of film and asperities with solved films: what the rule of rough contact laws is measured against.

A film that carries the share g of the pressure is that of solids with the modulus g E' under the load g w (K. L.
Johnson, J. A. Greenwood, S. Y. Poon, Wear 19, 1972, 91). `ehdmaps.maps.rough_layer` scales it from the film between
smooth surfaces by a formula; here every film on the way is solved. Asperities are those of `ehdmaps.maps.rough_layer`
in both.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from scipy.optimize import brentq

from ehdmaps.errors import SolverError
from ehdmaps.maps.rough_layer import asperity_pressure, mean_gap
from ehdmaps.physics.contact import LineContact, OperatingPoint
from ehdmaps.physics.hertz import max_pressure
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solution import ContactSolver
from ehdmaps.physics.surface import Surface

LEAST_SHARE = 1e-3
"""Share of the film below which no balance is sought."""

THICK = 8.0
"""Film over the roughness from which on asperities carry nothing that a double can hold beside the load."""

STEP = 0.01
"""Step of the load for the compliance, relative; its error is of second order."""

_FARTHEST, _DEEPEST = 14.0, -35.0
_NEAR = 0.3
_CLOSE = 1e-9


@dataclass(frozen=True)
class SolvedSharing:
    """A rough contact whose film is solved.

    Attributes
    ----------
    share : float
        Part of the load that the film carries.
    offset : float
        Distance of the mean planes, what the film offset becomes [m]; below zero where they overlap.
    compliance : float
        -d(offset)/dw [m2/N].
    """

    share: float
    offset: float
    compliance: float


def solved_sharing(
    solver: ContactSolver, contact: LineContact, lubricant: Lubricant, point: OperatingPoint, surface: Surface
) -> SolvedSharing:
    """Share the load between a solved film and asperities.

    Parameters
    ----------
    solver : ContactSolver
        What solves the films between smooth surfaces.
    contact : LineContact
        The contact.
    lubricant : Lubricant
        The oil.
    point : OperatingPoint
        Load, speed and temperature.
    surface : Surface
        Rough surfaces.

    Raises
    ------
    SolverError
        Where a film has no solution, or it carries less than `LEAST_SHARE`.
    """
    film = _Film(solver, contact, lubricant, point, surface)
    share = film.share(point.load, LEAST_SHARE, 1.0)
    low, high = max(LEAST_SHARE, share * (1.0 - _NEAR)), min(1.0, share * (1.0 + _NEAR))
    less, more = ((1.0 + sign * STEP) * point.load for sign in (-1.0, 1.0))
    thick, thin = (film.offset(load, film.share(load, low, high)) for load in (less, more))
    return SolvedSharing(share, film.offset(point.load, share), (thick - thin) / (more - less))


@dataclass(frozen=True)
class _Film:
    """Films of soft solids at one speed and temperature."""

    solver: ContactSolver
    contact: LineContact
    lubricant: Lubricant
    point: OperatingPoint
    surface: Surface

    def thickness(self, load: float, share: float) -> float:
        """Film that carries a share of a load [m]."""
        material = self.contact.material
        soft = replace(self.contact, material=replace(material, youngs_modulus=share * material.youngs_modulus))
        speed, temperature = self.point.entrainment_speed, self.point.temperature
        (film,) = self.solver.solve_line(soft, self.lubricant, (share * load,), speed, temperature)
        if not film.status.usable:
            raise SolverError(f"film of the share {share:.3g}: {film.status.word}; {film.reason}")
        return film.film_offset

    def offset(self, load: float, share: float) -> float:
        """Distance of the mean planes at which a film of this share is the mean gap [m]."""
        sigma = self.surface.roughness
        film = self.thickness(load, share)
        if film > THICK * sigma:
            return film
        return sigma * float(brentq(lambda x: float(mean_gap(x)[0]) - film / sigma, _DEEPEST, _FARTHEST, xtol=1e-12))

    def share(self, load: float, low: float, high: float) -> float:
        """Share at which film and asperities carry the load, between two others."""
        pressure = 0.25 * math.pi * float(max_pressure(load, self.contact.radius, self.contact.reduced_modulus))

        def excess(log_share: float) -> float:
            share = math.exp(log_share)
            distance = self.offset(load, share) / self.surface.roughness
            if distance > THICK:
                return share - 1.0
            carried = float(asperity_pressure(self.surface, distance, self.contact.reduced_modulus)[0])
            return carried / pressure + share - 1.0

        ends = math.log(low), math.log(high)
        if high == 1.0 and excess(0.0) == 0.0:
            return 1.0
        if excess(ends[0]) > 0.0:
            raise SolverError(f"the film carries less than {low:.3g} of the load")
        return math.exp(brentq(excess, *ends, xtol=_CLOSE))

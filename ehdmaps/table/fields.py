"""The numbers of the table: what each is divided by, and in which form it is smooth.

Reduced by its unit, every number of a film is a function of the coordinates of `ehdmaps.table.coordinates` alone. What
has one sign is held as a logarithm. Film compliance, loss compliance and response run through zero in the damping
valley: they are held as asinh(x/scale), a logarithm of large numbers that is linear for small ones. The scale is one at
which what dives through the valley is a smooth wave; errors of what a law is made from are judged at a smaller one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.hertz import half_width, max_pressure

NATURAL_FREQUENCIES = (0.5, 1.0, 2.0, 4.0, 8.0)
"""omega sqrt(b^2 + 2 h R)/u of the responses: those of the backbone of a map."""


@dataclass(frozen=True)
class Field:
    """One number of a film.

    Attributes
    ----------
    name : str
        Attribute of `ehdmaps.physics.solution.FilmSolution`; of a response, where it stands in the table.
    scale : float
        Scale of asinh; 0 for a logarithm.
    rigid_slope : float
        d ln|x|/d ln M of the reduced number x of a rigid film, the limit of light loads.
    fades : bool
        Whether it goes to zero as a power of the load where this is high, though it is held as asinh.
    judged : float
        Scale of the asinh in which a law's errors are told; 0 for the form in which it is held.
    """

    name: str
    scale: float
    rigid_slope: float
    fades: bool = False
    judged: float = 0.0

    def lifted(self, reduced: FloatArray) -> FloatArray:
        """Smooth form of reduced numbers; NaN of what has none."""
        if self.scale:
            return np.arcsinh(reduced / self.scale)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.where(reduced > 0.0, np.log(reduced), np.nan)

    def reduced(self, lifted: FloatArray) -> FloatArray:
        """Reduced numbers of their smooth form."""
        return self.scale * np.sinh(lifted) if self.scale else np.exp(lifted)

    def lifted_error(self, reduced: FloatArray, relative: FloatArray) -> FloatArray:
        """Error of the smooth form from a relative error of the number."""
        if not self.scale:
            return np.abs(relative)
        return np.abs(relative * reduced) / np.hypot(reduced, self.scale)

    def relative_error(self, reduced: FloatArray, lifted: FloatArray) -> FloatArray:
        """Relative error of the number from one of its smooth form."""
        if not self.scale:
            return np.expm1(lifted)
        with np.errstate(divide="ignore"):
            return lifted * np.hypot(reduced, self.scale) / np.abs(reduced)

    def judged_error(self, reduced: FloatArray, lifted: FloatArray) -> FloatArray:
        """Error of asinh(x/judged) from one of the smooth form."""
        if not self.judged:
            return lifted
        return lifted * np.hypot(reduced, self.scale) / np.hypot(reduced, self.judged)


FILMS = (
    Field("film_offset", 0.0, -1.0),
    Field("film_compliance", 1.0, -2.0, True, 0.3),
    Field("loss_compliance", 2.0, -3.0, True, 0.5),
    Field("central_film", 0.0, -1.0),
    Field("minimum_film", 0.0, -1.0),
    Field("max_pressure", 0.0, 1.0),
    Field("rolling_force", 0.0, 0.0),
    Field("mass_flow", 0.0, -1.0),
    Field("wall_stress", 0.0, 0.0),
)
"""Films at rest, and their response to slow motion."""

LAW = FILMS[:3]
"""What a contact law is made from."""

RESPONSES = tuple(
    Field(f"response_{part}_{natural:g}", 1.0, -2.0)
    for natural in NATURAL_FREQUENCIES
    for part in ("real", "imaginary")
)
"""Film compliance at the natural frequencies, real and imaginary part."""

FIELDS = FILMS + RESPONSES


class Units(NamedTuple):
    """Units by which the numbers of films are divided, arrays over points.

    Attributes
    ----------
    film : ndarray
        R sqrt(Us) [m].
    compliance : ndarray
        1/E' [m2/N].
    loss : ndarray
        b/(u E') [m2 s/N].
    pressure : ndarray
        Largest pressure of Hertz [Pa].
    force : ndarray
        sqrt(eta u w) [N/m].
    flow : ndarray
        rho u R sqrt(Us) [kg/(m s)].
    stress : ndarray
        p_H b/R [Pa].
    """

    film: FloatArray
    compliance: FloatArray
    loss: FloatArray
    pressure: FloatArray
    force: FloatArray
    flow: FloatArray
    stress: FloatArray

    def of(self, field: Field) -> FloatArray:
        """Unit of a field.

        Parameters
        ----------
        field : Field
            One of `FIELDS`.
        """
        return getattr(self, _UNITS.get(field.name, "compliance"))  # type: ignore[no-any-return]


_UNITS = {
    "film_offset": "film",
    "loss_compliance": "loss",
    "central_film": "film",
    "minimum_film": "film",
    "max_pressure": "pressure",
    "rolling_force": "force",
    "mass_flow": "flow",
    "wall_stress": "stress",
}


def units(
    load: FloatArray,
    speed: FloatArray,
    viscosity: FloatArray,
    density: FloatArray,
    radius: float,
    reduced_modulus: float,
) -> Units:
    """Units of the films of points; arguments of one shape.

    Parameters
    ----------
    load, speed : ndarray
        w [N/m] and u [m/s], > 0.
    viscosity, density : ndarray
        eta0 [Pa s] and rho0 [kg/m3].
    radius, reduced_modulus : float
        R [m] and E' [Pa].
    """
    film = radius * np.sqrt(2.0 * viscosity * speed / (reduced_modulus * radius))
    half, peak = half_width(load, radius, reduced_modulus), max_pressure(load, radius, reduced_modulus)
    return Units(
        film=film,
        compliance=np.full_like(film, 1.0 / reduced_modulus),
        loss=half / (speed * reduced_modulus),
        pressure=peak,
        force=np.sqrt(viscosity * speed * load),
        flow=density * speed * film,
        stress=peak * half / radius,
    )

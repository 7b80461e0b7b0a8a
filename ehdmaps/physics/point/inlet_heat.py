"""Heat in the inlet of point contacts, as a layer over isothermal films: the rule of lines at an equal line.

The equal line has the radius along the rolling and the Hertz pressure of the contact, so that its load number is

    M_e = 2 pi (g/2)^2 q^(2/3),    q = 3 M/(pi kappa g),

with g = p_H Rx/(E* a) of the ellipse; a line itself has M_e = M. Oil that passes the sides of the contact does not turn
back: a circle heats less. The rule of `ehdmaps.physics.heat` is taken where the oil cannot, kappa of 3 and more; below,
its error says so. Moes' M and L of the contact are kept, since a hotter oil or a lower speed in their place has wrong
stiffness and damping.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.heat import (
    LARGEST_LOADING,
    InletHeat,
    beyond_rule,
    heat_by_factor,
    heat_loading,
    inlet_heat_factor,
)
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import Ellipse

ROUNDEST = 3.0
"""Ellipticity below which the sides of the contact let oil pass, so that it heats less than a line."""

OFFSET = 0.74
"""Exponent with which the film offset of a point goes with the factor of its film; the sides of a contact are lifted by
a film that is less heated. From own films with temperatures, kappa 4.5: `tests/references/warm_points.toml`."""

LOSS = 1.2
"""Exponent of the loss compliance of high loads, from own films with temperatures in slow motion, M_e 2.4 to 8:
`tests/references/slow_points.toml`. That of inlets between cold walls, kappa 6 and 10, is 1.8 at M_e of 6 to 60."""

LIGHTEST_LINE = 2.0
"""M_e below which the contact is near the knee of its stiffness and damping, or a rigid one."""


def equal_line(ellipse: Ellipse, load_number: FloatArray) -> FloatArray:
    """Load number M_e of the line with the radius and the Hertz pressure of a point contact.

    Parameters
    ----------
    ellipse : Ellipse
        The contact.
    load_number : ndarray
        Moes' M of the point contact, > 0.
    """
    g = float(ellipse.numbers.pressure_factor)
    q = 3.0 * load_number / (np.pi * ellipse.ellipticity * g)
    return np.asarray(2.0 * np.pi * (0.5 * g) ** 2 * q ** (2.0 / 3.0))


def line_number(
    ellipse: Ellipse, viscosity: FloatArray | float, load: FloatArray, speed: FloatArray | float
) -> FloatArray:
    """Load number of the equal line.

    Parameters
    ----------
    ellipse : Ellipse
        The contact.
    viscosity, load, speed : ndarray
        eta0 [Pa s], F [N] > 0, u [m/s] > 0.
    """
    modulus, radius = ellipse.reduced_modulus, ellipse.rolling_radius
    number = 2.0 * viscosity * speed / (modulus * radius)
    return equal_line(ellipse, load / (modulus * radius**2) * number**-0.75)


def point_heats(
    ellipse: Ellipse, lubricant: Lubricant, load: FloatArray, speed: FloatArray, temperature: FloatArray
) -> InletHeat:
    """Effect of heat in the inlet on isothermal films of a point contact; arrays of one shape.

    Nothing is refused: the factors go on smoothly where no factor is known, and the errors are as large as the effect.

    Parameters
    ----------
    ellipse : Ellipse
        The contact.
    lubricant : Lubricant
        The oil, whose conductivity has to be known.
    load, speed, temperature : ndarray
        F [N] > 0, u [m/s] > 0 and T [K].

    Raises
    ------
    InputError
        Without the conductivity of the oil.
    """
    loading, viscosity = heat_loading(lubricant, speed, temperature), np.empty(load.shape)
    for kelvin in np.unique(temperature).tolist():
        viscosity[temperature == kelvin] = lubricant.at(kelvin).viscosity
    M = line_number(ellipse, viscosity, load, speed)
    factor = inlet_heat_factor(M, loading)
    unknown = (loading > LARGEST_LOADING) | (ellipse.ellipticity < ROUNDEST)
    return heat_by_factor(M, factor, load, unknown, M < LIGHTEST_LINE, loading, 2.0 / 3.0, LOSS, OFFSET)


def heat_note(ellipse: Ellipse, lubricant: Lubricant, load: float, speed: float, temperature: float) -> str:
    """Remark on one film with heat in its inlet; empty where heat changes it by less than a per cent, and at rest.

    Parameters
    ----------
    ellipse, lubricant
        Contact and oil.
    load, speed, temperature : float
        F [N], u [m/s], T [K].
    """
    if not (load > 0.0 and speed > 0.0):
        return ""
    at = [np.array([x]) for x in (load, speed, temperature)]
    beyond = beyond_rule(lubricant, speed, temperature)
    return "; ".join(filter(None, (point_heats(ellipse, lubricant, *at).of(0).note, beyond)))


WARM = (
    *("approach", "film_offset", "stiffness", "damping", "film_compliance", "loss_compliance"),
    *("central_film", "minimum_film"),
)
"""Numbers of a point contact that heat changes."""

_FILMS = ("central_film", "minimum_film")


def heated_point(numbers: Mapping[str, Any], heat: InletHeat, dry_stiffness: Any) -> dict[str, Any]:
    """Numbers of an isothermal point contact, and their relative errors, with heat in its inlet.

    Parameters
    ----------
    numbers : mapping of str to float or ndarray
        Those of `WARM`, each with its error as NAME_error; what else it holds is left out.
    heat : InletHeat
        The heat of the same point.
    dry_stiffness : float or ndarray
        Stiffness of the dry contact [N/m].
    """
    offset, dry = numbers["film_offset"], 1.0 / dry_stiffness
    warm_offset = offset * heat.offset_factor
    film = heat.compliance(numbers["film_compliance"], offset)
    loss = numbers["loss_compliance"] * heat.loss_factor
    stiffness = 1.0 / (dry + film)
    approach = numbers["approach"] + offset - warm_offset
    found = {
        "approach": approach,
        "film_offset": warm_offset,
        "stiffness": stiffness,
        "damping": loss * stiffness**2,
        "film_compliance": film,
        "loss_compliance": loss,
        **{name: numbers[name] * heat.factor for name in _FILMS},
    }
    with np.errstate(divide="ignore", invalid="ignore"):
        offset_error = numbers["film_offset_error"] + heat.film_error
        more = heat.loss_error * np.abs(film) * stiffness
        stiffness_error = numbers["stiffness_error"] + more
        errors = {
            "approach": offset_error * np.abs(warm_offset / approach),
            "film_offset": offset_error,
            "stiffness": stiffness_error,
            "damping": numbers["damping_error"] + heat.loss_error + 2.0 * more,
            "film_compliance": stiffness_error / np.abs(film * stiffness),
            "loss_compliance": numbers["loss_compliance_error"] + heat.loss_error,
            **{name: numbers[f"{name}_error"] + heat.film_error for name in _FILMS},
        }
    return found | {f"{name}_error": error for name, error in errors.items()}

"""Films of the table of points with heat in the inlet: its isothermal numbers by the rule, over frequency too."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.heat import InletHeat
from ehdmaps.physics.point.inlet_heat import heated_point


def heated_films(found: Mapping[str, FloatArray], heat: InletHeat, dry_stiffness: FloatArray) -> dict[str, FloatArray]:
    """Numbers of films with heat, and their relative errors, in place of isothermal ones.

    Over frequency the real part of the film compliance goes as that of slow motion, the imaginary part as the loss
    compliance: known in the limit of slow motion only, an assumption at high frequencies.

    Parameters
    ----------
    found : mapping of str to ndarray
        Isothermal numbers (n,), each with its error as NAME_error; frequencies, response_stiffness, response_damping
        (n, 5), with theirs.
    heat : InletHeat
        Heat of the points, arrays (n,).
    dry_stiffness : ndarray, shape (n,)
        Stiffness of the dry contacts [N/m].
    """
    warm = heated_point(found, heat, dry_stiffness)
    rate = 2.0 * np.pi * found["frequencies"]
    cold = found["response_stiffness"], rate * found["response_damping"]
    compliance = 1.0 / (cold[0] + 1j * cold[1]) - 1.0 / dry_stiffness[:, None]
    every = heat.of((slice(None), None))
    film = every.compliance(compliance.real, found["film_offset"][:, None]) + 1j * every.loss_factor * compliance.imag
    stiffness = 1.0 / (1.0 / dry_stiffness[:, None] + film)
    wrong = every.loss_error * np.abs(film * stiffness**2)
    for name, part, size in zip(("stiffness", "damping"), cold, (stiffness.real, stiffness.imag), strict=True):
        stated = found[f"response_{name}_error"] * np.abs(part) + wrong
        warm[f"response_{name}_error"] = stated / np.abs(size)
    return warm | {"response_stiffness": stiffness.real, "response_damping": stiffness.imag / rate}

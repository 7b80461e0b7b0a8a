"""Loads and speeds by the groups of Moes."""

from __future__ import annotations

import math


def load_and_speed(
    load_number: float,
    oil_number: float,
    viscosity: float,
    pressure_viscosity: float,
    radius: float,
    reduced_modulus: float,
) -> tuple[float, float]:
    """Load w [N/m] and entrainment speed u [m/s] at which a given oil and contact have the groups M and L.

    The inverse of `moes_groups`.

    """
    speed_number = (oil_number / (pressure_viscosity * reduced_modulus)) ** 4
    load = load_number * reduced_modulus * radius * math.sqrt(speed_number)
    return load, speed_number * reduced_modulus * radius / (2.0 * viscosity)

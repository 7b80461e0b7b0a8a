"""Data that heat in a contact needs besides the laws of oil and solids, in one place."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from ehdmaps.errors import InputError


@dataclass(frozen=True)
class HeatData:
    """How oil and surfaces take and lead heat; constant over temperature and pressure.

    Attributes
    ----------
    oil_conductivity : float
        k_f [W/(m K)].
    oil_heat_capacity : float
        c_p of the oil [J/(kg K)]; 2000 of the default is assumed.
    solid_conductivity : float
        k_s of both bodies [W/(m K)].
    solid_heat_capacity : float
        c_s [J/(kg K)].
    solid_density : float
        rho_s [kg/m3].

    Raises
    ------
    InputError
        With every value that is not finite and above zero.
    """

    oil_conductivity: float = 0.134
    oil_heat_capacity: float = 2000.0
    solid_conductivity: float = 46.0
    solid_heat_capacity: float = 460.0
    solid_density: float = 7850.0

    def __post_init__(self) -> None:
        values = ((entry.name, getattr(self, entry.name)) for entry in fields(self))
        problems = [
            f"heat, {name}: got {value!r}; allowed: finite and > 0"
            for name, value in values
            if not (math.isfinite(value) and value > 0)
        ]
        if problems:
            raise InputError(problems)

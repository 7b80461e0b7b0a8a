"""Data that heat in a contact needs besides the laws of oil and solids, in one place."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from ehdmaps.errors import InputError
from ehdmaps.physics.lubricant import HEAT_CAPACITY, Lubricant
from ehdmaps.physics.solids import STEEL, Material

ISOTHERMAL, INLET_HEAT, THERMAL = "isothermal", "inlet-heat", "thermal"
PHYSICS = (ISOTHERMAL, INLET_HEAT, THERMAL)
"""Words for what a solver knows of heat, in jobs and on command lines: nothing, heat in the inlet by a formula laid
over isothermal films, or temperatures in the film."""


@dataclass(frozen=True)
class HeatData:
    """How oil and surfaces take and lead heat; constant over temperature and pressure.

    Attributes
    ----------
    oil_conductivity : float
        k_f [W/(m K)].
    oil_heat_capacity : float
        c_p of the oil [J/(kg K)].
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
    oil_heat_capacity: float = HEAT_CAPACITY
    solid_conductivity: float = STEEL.conductivity
    solid_heat_capacity: float = STEEL.heat_capacity
    solid_density: float = STEEL.density

    def __post_init__(self) -> None:
        values = ((entry.name, getattr(self, entry.name)) for entry in fields(self))
        problems = [
            f"heat, {name}: got {value!r}; allowed: finite and > 0"
            for name, value in values
            if not (math.isfinite(value) and value > 0)
        ]
        if problems:
            raise InputError(problems)


def heat_data(lubricant: Lubricant, material: Material) -> HeatData:
    """Heat data of a contact.

    Parameters
    ----------
    lubricant : Lubricant
        The oil.
    material : Material
        Material of both bodies.

    Raises
    ------
    InputError
        If nobody stated the conductivity of the oil.

    Examples
    --------
    >>> heat_data(Lubricant.named("FVA3"), STEEL) == HeatData()
    True
    """
    if lubricant.thermal_conductivity is None:
        raise InputError(
            f"lubricant {lubricant.name!r}, thermal_conductivity: got none; films with heat need it; give it in "
            "[lubricant], mineral oils have about 0.13 W/(m K), or choose physics isothermal"
        )
    return HeatData(
        oil_conductivity=lubricant.thermal_conductivity,
        oil_heat_capacity=lubricant.heat_capacity,
        solid_conductivity=material.conductivity,
        solid_heat_capacity=material.heat_capacity,
        solid_density=material.density,
    )

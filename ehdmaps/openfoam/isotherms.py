"""An oil over temperature for `ehlFoam`: its isotherms at equal steps, between which the solver interpolates."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ehdmaps.errors import InputError
from ehdmaps.physics.lubricant import Lubricant, LubricantState

STEP = 4.0
"""From one isotherm to the next [K].

The cubic through four of them errs in ln(eta) by at most 1e-5 at ambient pressure and 1e-4 at 1 GPa from 20 degC up
with any law, by 5e-4 at 1 GPa near -10 degC, where the law of FVA 3 ends.
"""

BELOW, ABOVE = 60.0, 400.0
"""How far the isotherms reach below and above the temperature of the surfaces, where the laws of the oil do [K]."""

FEWEST = 4
"""Isotherms of one cubic."""


@dataclass(frozen=True)
class Isotherms:
    """States of an oil at equal steps of temperature.

    Attributes
    ----------
    first : float
        Temperature of the first [K].
    states : tuple of LubricantState
        All with the same law over pressure; at least `FEWEST`.
    """

    first: float
    states: tuple[LubricantState, ...]


def isotherms(lubricant: Lubricant, temperature: float) -> Isotherms:
    """Isotherms of an oil about a temperature [K], which is one of them, as far as its laws hold.

    Raises
    ------
    InputError
        If the laws break down at the temperature itself, or hold over too few kelvin about it.
    """
    middle = lubricant.at(temperature)
    kind = middle.pressure_viscosity.case_name

    def outwards(direction: float, reach: float) -> Iterator[LubricantState]:
        """States away from the temperature until the laws end."""
        for k in range(1, int(reach / STEP) + 1):
            try:
                state = lubricant.at(temperature + direction * k * STEP)
            except InputError:
                return
            if state.pressure_viscosity.case_name != kind:
                return
            yield state

    colder, hotter = list(outwards(-1.0, BELOW)), list(outwards(1.0, ABOVE))
    states = (*reversed(colder), middle, *hotter)
    if len(states) < FEWEST or not hotter:
        raise InputError(
            f"lubricant {lubricant.name!r}, temperature: got {temperature:.6g} K, about which its laws hold over "
            f"{STEP * (len(states) - 1):g} K; allowed with heat: at least {STEP * (FEWEST - 1):g} K, and some above it"
        )
    return Isotherms(temperature - STEP * len(colder), states)

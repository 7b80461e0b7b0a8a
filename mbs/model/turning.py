"""Loads that follow the angle of the system: unbalances, and excitations by an order of a spin.

    F(t) = Re[vector (constant + by_square w^2 + by_rate w') exp(i order phi)]

with the speed w of the system, its rate w' and the angle phi that it has turned. The mean over a turn is zero, so that
such a load has no part in an equilibrium. At a steady speed it is an oscillation at the frequency |order| w.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray
from ehdmaps.errors import InputError
from mbs.model.elements import GROUND


@dataclass(frozen=True, eq=False)
class TurningLoad:
    """A load that follows the angle of the system.

    Attributes
    ----------
    name : str
        Name for messages and results.
    on : str
        Place of the load.
    vector : array, shape (6,), complex
        Three forces and three moments by the coefficients; of a force that turns from y to z the direction (y - i z).
    order : float
        How often it goes round, or to and fro, for each turn of the system; negative: against it.
    constant, by_square, by_rate : complex
        Coefficients of the size: at any speed; by the square of the speed [s2/rad2]; by the rate of the speed [s2/rad].
    against : str
        Place that gets the opposite.

    Raises
    ------
    InputError
        For an order of zero, or numbers that are not finite.
    """

    name: str
    on: str
    vector: ComplexArray
    order: float
    constant: complex = 0.0
    by_square: complex = 0.0
    by_rate: complex = 0.0
    against: str = GROUND

    def __post_init__(self) -> None:
        numbers = [self.order, *self.coefficients, *np.asarray(self.vector, dtype=np.complex128).tolist()]
        if not np.all(np.isfinite(numbers)) or self.order == 0.0:
            raise InputError(
                f"{self.name!r}: got the order {self.order!r} and the size {np.max(np.abs(self.vector)):.4g}; allowed: "
                "a finite order other than 0, and finite sizes; a body that does not spin makes no excitation"
            )

    @property
    def coefficients(self) -> tuple[complex, complex, complex]:
        """Coefficients at any speed, by its square, by its rate."""
        return self.constant, self.by_square, self.by_rate


def unbalance(name: str, on: str, moment: float, angle: float, spin: float) -> TurningLoad:
    """A mass that sits off the axis of a body: it pulls outwards, and against the turning while that gets faster.

    Parameters
    ----------
    name : str
        Name for messages and results.
    on : str
        Place of the axis at which it sits.
    moment : float
        Mass times radius [kg m].
    angle : float
        Angle of the mass from y towards z when the system has turned by zero [rad].
    spin : float
        Speed of the body about x as a multiple of the system's; not 0.

    Raises
    ------
    InputError
        For a body that does not spin, and numbers that are not finite.

    Notes
    -----
    At the angle theta = spin phi + angle the mass is displaced by r (cos theta, sin theta) in y and z. With the speed
    w = spin phi' its inertia is m r (w^2 cos theta + w' sin theta) along y, m r (w^2 sin theta - w' cos theta) along z.
    The mass itself belongs to the body.
    """
    towards = np.zeros(6, dtype=np.complex128)
    towards[1], towards[2] = 1.0, -1.0j
    return TurningLoad(
        name,
        on,
        moment * np.exp(1j * angle) * towards,
        spin,
        by_square=spin**2,
        by_rate=-1j * spin,
    )


class Turning(NamedTuple):
    """Turning loads of one order and growth, put together.

    Attributes
    ----------
    vector : array, shape (n,), complex
        Generalised load by the coefficients [N or N m].
    order : float
        How often for each turn of the system.
    coefficients : tuple of complex
        Coefficients at any speed, by its square, by its rate.
    names : tuple of str
        Names of the loads.
    """

    vector: ComplexArray
    order: float
    coefficients: tuple[complex, complex, complex]
    names: tuple[str, ...]

    def amplitude(self, speed: float) -> ComplexArray:
        """Generalised load F at a steady speed [rad/s], shape (n,): it is Re[F exp(i |order speed| t)].

        Parameters
        ----------
        speed : float
            Speed of the system [rad/s].
        """
        constant, by_square, _ = self.coefficients
        load = self.vector * (constant + by_square * speed**2)
        return np.asarray(load if self.order * speed >= 0.0 else load.conj())

    def factors(self, speeds: FloatArray, angles: FloatArray, rates: FloatArray) -> ComplexArray:
        """Factors by which the vector is multiplied, before its real part is taken; arguments and result of one shape.

        Parameters
        ----------
        speeds, angles, rates : array
            Speed, angle and rate of the speed [rad/s, rad, rad/s2].
        """
        constant, by_square, by_rate = self.coefficients
        size = constant + by_square * speeds**2 + by_rate * rates
        return np.asarray(size * np.exp(1j * self.order * angles))

    def at(self, speed: float, angle: float, rate: float) -> FloatArray:
        """Generalised load at an instant, shape (n,) [N or N m].

        Parameters
        ----------
        speed, angle, rate : float
            Speed, angle and rate of the speed [rad/s, rad, rad/s2].
        """
        constant, by_square, by_rate = self.coefficients
        size = constant + by_square * speed**2 + by_rate * rate
        turned = self.order * angle
        factor = size * complex(math.cos(turned), math.sin(turned))
        return np.asarray(self.vector.real * factor.real - self.vector.imag * factor.imag)


def put_together(loads: Sequence[tuple[TurningLoad, ComplexArray]]) -> tuple[Turning, ...]:
    """Add up loads of the same order and growth.

    Parameters
    ----------
    loads : sequence of (TurningLoad, array (n,))
        Each with its vector by the coordinates of the system.
    """
    groups: dict[tuple[float, tuple[complex, complex, complex]], list[tuple[str, ComplexArray]]] = {}
    for load, vector in loads:
        groups.setdefault((load.order, load.coefficients), []).append((load.name, vector))
    return tuple(
        Turning(np.sum([vector for _, vector in parts], axis=0), *key, tuple(name for name, _ in parts))
        for key, parts in groups.items()
    )

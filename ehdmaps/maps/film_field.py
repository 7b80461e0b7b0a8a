"""What a contact law is made from: the film of each contact as a smooth field over load, speed, temperature."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ehdmaps.arrays import ComplexArray, FloatArray

LOSS_FLOOR = 1e-4
"""Smallest loss compliance of a field, as a share of b/(u k): a tenth of what the solver's damping is good to."""


def lifted_loss(
    loss: FloatArray, half_width: FloatArray, speed: FloatArray | float, compliance: FloatArray
) -> FloatArray:
    """The larger one of a loss compliance and its floor, smoothly: a contact law is passive, and takes logarithms.

    Nothing lies below the floor: a logarithm that fell further, where a solved damping is negative, would make the
    splines of the law ring on both sides of it.

    Parameters
    ----------
    loss : array
        Loss compliance c/k^2 [m2 s/N]; below zero at the bottom of some damping valleys.
    half_width, speed, compliance : arrays that broadcast
        b [m], u [m/s] and 1/k [m2/N].
    """
    floor = LOSS_FLOOR * half_width / speed * compliance
    lifted: FloatArray = 0.5 * (loss + floor + np.hypot(loss - floor, 2.0 * floor))
    return lifted


class FilmField(Protocol):
    """Film offset, film compliance and loss compliance at any load, speed and temperature of a map.

    The film compliance is the exact derivative of the film offset: -d(film_offset)/dw. Film offset and loss
    compliance are positive, unless `dry`. Loads and speeds beyond the ranges are continued smoothly, by the
    trend at the end of the range and at constant Moes number M in speed; temperatures are never outside.
    """

    @property
    def contacts(self) -> tuple[str, ...]:
        """Names of the contacts."""
        ...

    @property
    def load_range(self) -> tuple[float, float]:
        """Lowest and highest load [N/m]."""
        ...

    @property
    def speed_range(self) -> tuple[float, float]:
        """Lowest entrainment speed above zero, and highest [m/s]."""
        ...

    @property
    def temperature_range(self) -> tuple[float, float]:
        """Lowest and highest temperature [K]."""
        ...

    @property
    def dry(self) -> bool:
        """Whether no contact has any film anywhere; `films` is then of no use."""
        ...

    def films(
        self, contact: str, loads: FloatArray, speeds: FloatArray, temperatures: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Film of one contact.

        Parameters
        ----------
        contact : str
            One of `contacts`.
        loads : array (n, n_u, n_T)
            Loads w [N/m], > 0, of each pair of speed and temperature.
        speeds : array (n_u,)
            Entrainment speeds [m/s], > 0.
        temperatures : array (n_T,)
            [K].

        Returns
        -------
        film_offset, film_compliance, loss_compliance : array (n, n_u, n_T)
            [m], [m2/N], [m2 s/N].
        """
        ...

    def first_loads(self, speeds: FloatArray, temperatures: FloatArray) -> FloatArray:
        """Loads from which on the film of every contact is known [N/m], (n_u, n_T): that of `load_range` or lower.

        Parameters
        ----------
        speeds : array (n_u,)
            Entrainment speeds [m/s], > 0.
        temperatures : array (n_T,)
            [K].
        """
        ...

    def locked_factors(self, contact: str, loads: FloatArray, speed: float, temperature: float) -> FloatArray | None:
        """Factors of the closed formula of the locked film, see `ehdmaps.maps.locked_fit`.

        Parameters
        ----------
        contact : str
            One of `contacts`.
        loads : array (n,)
            [N/m], > 0.
        speed, temperature : float
            [m/s], > 0, and [K].

        Returns
        -------
        array (n,) or None
            None where nothing is known of films that oscillate: the closed formula then stands as it is.
        """
        ...

    def film_differences(
        self, contact: str, loads: FloatArray, speed: float, temperature: float
    ) -> tuple[FloatArray, ComplexArray] | None:
        """What films with memory leave out of the complex stiffness, see `ehdmaps.maps.film_response`.

        Parameters
        ----------
        contact, loads, speed, temperature
            The same as for `locked_factors`.

        Returns
        -------
        natural, differences : array (k,), complex array (n, k), or None
            Natural frequencies omega T, and how far the law is from the film solver there, relatively. None where
            nothing is known of films that oscillate.
        """
        ...

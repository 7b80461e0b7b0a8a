"""Numbers as people read them."""

from __future__ import annotations

from ehdmaps.figures import typeset
from ehdmaps.units import Display


def number(value: float, digits: int = 3) -> str:
    """Return a number with some digits, without an exponent where people do not need one.

    Parameters
    ----------
    value : float
        The number.
    digits : int
        How many digits count.

    Examples
    --------
    >>> number(14123.4), number(0.01239), number(1.2e-7)
    ('14100', '0.0124', '1.2e-07')
    """
    return f"{float(f'{value:.{digits}g}'):.10g}"


def shown(display: Display, value: float, digits: int = 3) -> str:
    """Return a number with its unit.

    Parameters
    ----------
    display : Display
        Unit of the number.
    value : float
        Value in SI.
    digits : int
        How many digits count.

    Examples
    --------
    >>> from ehdmaps.units import FILM
    >>> shown(FILM, 1.23456e-6)
    '1.23 µm'
    """
    return typeset(f"{number(display.value(value), digits)} {display.unit}".rstrip())

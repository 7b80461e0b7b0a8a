"""A contact law that is a little wrong on purpose: its table with another stiffness, damping and film."""

from __future__ import annotations

import math
from typing import NamedTuple

from ehdmaps.maps.tables import ApproachTable


class LawChange(NamedTuple):
    """What is changed of a law, at all loads, speeds and temperatures alike.

    Attributes
    ----------
    stiffness, damping : float
        Relative changes of k and c at an approach, above -1; the load at it changes by as much as k.
    film : float
        What films are thicker by [m]: contacts touch at an approach that is so much less.
    """

    stiffness: float = 0.0
    damping: float = 0.0
    film: float = 0.0

    def times(self, signs: tuple[float, float, float]) -> LawChange:
        """The change with a factor for each of its three parts."""
        return LawChange(*(sign * part for sign, part in zip(signs, self, strict=True)))


def changed_table(table: ApproachTable, change: LawChange) -> ApproachTable:
    """The table of a changed law; exact, as its splines take factors and constants as they are.

    Parameters
    ----------
    table : ApproachTable
        Table of the law as it is.
    change : LawChange
        Change of the law.
    """
    coefficients, place = table.coefficients.copy(), table.place.copy()
    coefficients[..., 0::2] *= math.cbrt(1.0 + change.stiffness)
    coefficients[..., 1::2] += math.log((1.0 + change.damping) / (1.0 + change.stiffness))
    place[..., 0] -= change.film
    return table._replace(coefficients=coefficients, place=place)

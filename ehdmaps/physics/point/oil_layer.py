"""Film of a point contact on an oil layer, over that of the flooded one.

With r = layer/(rho h), rho the density in the middle over that at rest, the film over the flooded one is

    q = (1 + r^-g + 0.224 g kappa^-0.95 r^-1.6)^(-1/g),    g = 4 kappa^0.39,

that of the layer towards r = 0 and that of the flooded film towards a thick layer. Chevalier's form is the first two
parts; the third is the part of the inlet that a far meniscus leaves out, which falls as a power of its distance. The
film offset, to which the sides of the contact belong, keeps less where the oil has left the sides,

    offset = q (1 - (1 - h/offset_flooded) 1.3/(r^1.5 + 1.3)).

At the frequencies of noise the meniscus has no time to move, and damping is that of the flooded contact within a fifth
down to r = 1; below it is more. Slow loads find a film that the layer pins: stiffness is by the slope of the offset.

References
----------
F. Chevalier, A. A. Lubrecht, P. M. E. Cann, F. Colin, G. Dalmaz, Film thickness in starved EHL point contacts, Journal
of Tribology 120, 1998, 126-133: the form of q, with one number g for each contact.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.point.inlet_heat import LIGHTEST_LINE

CORNER, BY_SHAPE = 4.0, 0.39
"""g of a circle, and its exponent of kappa."""

FAR, FAR_BY_SHAPE, FAR_BY_LAYER = 0.224, -0.95, -1.6
"""What a far meniscus takes of a circle at r = 1, and its exponents of kappa and r."""

SIDES = 1.3
"""r^1.5 at which half of what the sides hold is left."""

DAMPING_ERROR, THIN_LAYER = 0.2, 1.25
"""Errors of the damping down to r = 1, and what comes to it by 1 - r below."""


class Layered(NamedTuple):
    """Film on a layer over the flooded one, arrays (n,).

    Attributes
    ----------
    film, offset : ndarray
        Central and smallest film, and film offset, over those of the flooded contact.
    errors : ndarray, shape (n, 4)
        Relative errors of film offset, central and smallest film, and damping.
    """

    film: FloatArray
    offset: FloatArray
    errors: FloatArray


def layered(ellipticity: float, ratio: FloatArray, part: FloatArray, line: FloatArray) -> Layered:
    """Film on a layer over the flooded one.

    Parameters
    ----------
    ellipticity : float
        kappa, >= 1.
    ratio : ndarray, shape (n,)
        r, layer over content of the flooded film, > 0; infinite where it is flooded.
    part : ndarray, shape (n,)
        Central film over film offset of the flooded contact.
    line : ndarray, shape (n,)
        Load number of the equal line, see `ehdmaps.physics.point.inlet_heat.equal_line`.

    Notes
    -----
    Made from four contacts of other work, kappa 1 to 6. Against own mass-conserving solutions of six more
    (`tests/references/starved_points.toml`, kappa 1 to 8, r 0.5 to 4) central films are within 1.5 %, offsets within
    3 %, of a circle 5.5 %, for line load numbers of 2.5 and more. Smallest films are thicker by up to 11 % at r = 0.5.
    Nearer to the knee between rigid and elastic contacts films are wrong by 7 %, offsets by 17 %.

    Examples
    --------
    >>> four = np.full(4, 5.0)
    >>> [round(float(x), 3) for x in layered(6.0, np.array([4.0, 2.0, 1.0, 0.6]), 0.8 + 0.0 * four, four).film]
    [0.996, 0.987, 0.9, 0.598]
    """
    corner = CORNER * ellipticity**BY_SHAPE
    far = corner * FAR * ellipticity**FAR_BY_SHAPE
    with np.errstate(over="ignore", invalid="ignore"):
        # by powers of r where they are small, so that nothing overflows
        thin = ratio * (1.0 + ratio**corner + far * ratio ** (corner + FAR_BY_LAYER)) ** (-1.0 / corner)
        film = np.where(ratio < 1.0, thin, (1.0 + ratio**-corner + far * ratio**FAR_BY_LAYER) ** (-1.0 / corner))
        gone = SIDES / (ratio**1.5 + SIDES)
    offset = film * (1.0 - (1.0 - np.minimum(part, 1.0)) * gone)
    taken, lost, thinner = 1.0 - film, 1.0 - offset, np.maximum(1.0 - ratio, 0.0)
    knee = np.where(line < LIGHTEST_LINE, np.minimum(5.0 * lost, 0.07), 0.0)
    central = np.minimum(0.3 * taken, 0.015) + knee
    errors = (
        np.minimum(lost, 0.03 + 0.03 / ellipticity**2) + 2.0 * knee,
        central,
        np.minimum(0.3 * taken, 0.02) + 0.25 * thinner + 2.0 * knee,
        np.minimum(np.minimum(6.0 * taken, DAMPING_ERROR) + THIN_LAYER * thinner, 1.0),
    )
    return Layered(film, offset, np.column_stack(errors))

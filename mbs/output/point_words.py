"""Numbers, findings and Lambda of points of a bearing in words, the same for bearings of all kinds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.units import DAMPER, RPM, SPRING, written
from mbs.model.findings import MEANINGLESS, Severity, WithFindings

if TYPE_CHECKING:
    from mbs.model.equilibrium import Equilibrium
    from mbs.output.point_kind import Description


WIDE_RANGE = 20.0
"""A range of loads whose end is further above its beginning is spaced, and drawn, in the logarithm."""

REGIMES = ((1.0, "boundary: the surfaces touch"), (3.0, "mixed: asperities touch"), (math.inf, "full film"))
"""What is usually said of Lambda below these values."""


def regime(film_parameter: float) -> str:
    """Lubrication regime by Lambda, in usual words."""
    return next(words for limit, words in REGIMES if film_parameter < limit or limit == math.inf)


def lambda_line(film_parameter: float, roughness: str) -> str:
    """A line on Lambda and the regime of lubrication.

    Parameters
    ----------
    film_parameter : float
        Parameter Lambda; NaN where no film is known.
    roughness : str
        Roughness in words.

    Examples
    --------
    >>> lambda_line(5.0, "0.3 um"), lambda_line(math.nan, "0.3 um")
    ('  Lambda 5 (smallest film over 0.3 um of roughness; full film)', '  no film is known, and so no Lambda')
    """
    if math.isnan(film_parameter):
        return "  no film is known, and so no Lambda"
    return f"  Lambda {film_parameter:.3g} (smallest film over {roughness} of roughness; {regime(film_parameter)})"


def hole_line(load: float, speed: float) -> str:
    """Line of a table for a point without an answer, at a load [N] and a speed [rad/s]."""
    return f"{load:10.5g} {RPM.value(speed):8.5g} {'no answer, see below':>29s} !"


def warning_lines(points: Sequence[WithFindings]) -> list[str]:
    """Each warning and note once, with how many points it is about.

    Parameters
    ----------
    points : sequence of WithFindings
        The points.
    """
    graves = (Severity.BEYOND, Severity.WARNING, Severity.NOTE)
    return [f"{grave.word}: {words}" for grave in graves for words in _of_several(points, grave)]


def unsound_lines(points: Sequence[WithFindings]) -> list[str]:
    """The first line of points whose figures mean nothing, with the reasons; none of others.

    Parameters
    ----------
    points : sequence of WithFindings
        The points.
    """
    words = "; ".join(_of_several(points, Severity.UNSOUND))
    return [f"{Severity.UNSOUND.word}: {MEANINGLESS}{words}"] if words else []


def _of_several(points: Sequence[WithFindings], severity: Severity) -> list[str]:
    """Words of findings of a severity, each kind once."""
    # The number in a sentence differs from point to point; the last one is shown.
    groups: dict[str, list[str]] = {}
    for point in points:
        for finding in point.findings:
            if finding.severity is severity:
                groups.setdefault(without_numbers(finding.words), []).append(finding.words)
    return [
        words[-1] + (f" ({len(words)} of {len(points)} points, the last of them here)" if len(points) > 1 else "")
        for words in groups.values()
    ]


def without_numbers(sentence: str) -> str:
    """A sentence without its numbers, by which warnings of one kind are known.

    Examples
    --------
    >>> without_numbers("5.1 GPa is too much") == without_numbers("40 GPa is too much")
    True
    """
    return "".join(letter for letter in sentence if not (letter.isdigit() or letter in ".-+"))


def smallest(values: FloatArray) -> float:
    """Smallest number; NaN if there is none.

    Parameters
    ----------
    values : ndarray
        Any of them may be NaN.
    """
    known = values[np.isfinite(values)]
    return float(known.min()) if known.size else math.nan


def shown(value: float, digits: int = 5) -> str:
    """A number; a dash where there is none.

    Parameters
    ----------
    value : float
        The number, or NaN.
    digits : int
        Digits that count.
    """
    return "-" if math.isnan(value) else written(value, digits)


def no_dust(value: float) -> float:
    """Zero in place of round-off."""
    return 0.0 if abs(value) < 1e-9 else value


def tilting(description: Description, element: str) -> str:
    """Tell how the load acts, and whether the ring tilts.

    Parameters
    ----------
    description : Description
        What all points have in common.
    element : str
        Name of a rolling element.
    """
    return (
        f"load at {description.direction:.4g} deg from y (a {element}) towards z, inner ring "
        f"{'tilts freely' if description.tilts else 'does not tilt'}"
    )


def matrix_line(balance: Equilibrium, index: int) -> str:
    """Stiffness and damping of an element of a machine along x, y and z.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium of the machine.
    index : int
        Which of its elements.
    """
    parts = (
        ", ".join(f"{axis} {display.factor * matrix[k, k]:.5g}" for k, axis in enumerate("xyz")) + f" {display.unit}"
        for matrix, display in (
            (balance.element_stiffness[index], SPRING),
            (balance.element_damping[index], DAMPER),
        )
    )
    return "  K " + "; C ".join(parts)

"""From finite elements to the law of the approach over load, for one contact of a roller.

Of bodies that yield linearly, the energy of a contact with the pressure of Hertz over the half-width b under the load
w is (1/2) w^2 G(b) + w b^2/(8 R): G is what `ehdmaps.solids.plane` gives for roller and ring together, the second part
lies in the gap between the curved surfaces. The width is the one with the least energy, and the approach is the
derivative of that energy:

    w = -b/(2 R G'(b)),    delta = w G(b) + b^2/(8 R)

Both are exact to second order in what the true pressure differs from that of Hertz. In a half space G has the slope
-4/(pi E' b) and Hertz' width comes out. G of real bodies differs by a constant and, where b is no longer small, by a
term with b^2; `fitted` finds both, and then the one number delta_0 of `ehdmaps.physics.approach.finite_elements`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.approach import FE_LOAD, finite_elements, finite_elements_compliance


@dataclass(frozen=True, eq=False)
class PlaneSeries:
    """Approach of one contact over a series of loads, by finite elements.

    Attributes
    ----------
    half_width : array, shape (loads,)
        b [m].
    load : array, shape (loads,)
        w [N/m].
    approach : array, shape (loads,)
        delta [m].
    compliance : array, shape (loads,)
        d(delta)/dw [m2/N].
    """

    half_width: FloatArray
    load: FloatArray
    approach: FloatArray
    compliance: FloatArray


@dataclass(frozen=True)
class LawFit:
    """The law of a contact and how well it meets the series that it was made from.

    Attributes
    ----------
    fe_approach : float
        delta_0, the approach at `FE_LOAD` [m].
    approach_error, compliance_error : float
        Largest relative differences between law and series over its loads.
    slope_error : float
        Relative difference of the slope of G over ln b, where it is left free, from -4/(pi E'): what the mesh at the
        contact is good for.
    gap_curvature : float
        Relative change of 1/R that the gap of finite bodies has at `FE_LOAD`, beside that between half spaces under the
        same pressure; it grows with the load. Films between half spaces leave it out.
    """

    fe_approach: float
    approach_error: float
    compliance_error: float
    slope_error: float
    gap_curvature: float


def series_of(half_widths: FloatArray, compliance: FloatArray, radius: float, reduced_modulus: float) -> PlaneSeries:
    """Loads and approaches from the compliance of roller and ring over the width of the contact.

    Parameters
    ----------
    half_widths : array, shape (widths,)
        b [m].
    compliance : array, shape (widths,)
        G [m2/N], of roller and ring together.
    radius : float
        Reduced radius R [m].
    reduced_modulus : float
        E' [Pa].
    """
    slope = 4.0 / (math.pi * reduced_modulus)
    bend, constant = np.polyfit(half_widths**2, compliance + slope * np.log(half_widths), 1)
    load = half_widths / (2.0 * radius) / (slope / half_widths - 2.0 * bend * half_widths)
    approach = load * compliance + half_widths**2 / (8.0 * radius)
    # d(delta)/dw = G + w G' db/dw + b/(4 R) db/dw, with w G' = -b/(2 R) and db/dw from the width of least energy
    width_slope = 2.0 * radius * (slope - 2.0 * bend * half_widths**2) ** 2 / (2.0 * slope * half_widths)
    smooth = constant - slope * np.log(half_widths) + bend * half_widths**2
    return PlaneSeries(half_widths, load, approach, smooth - half_widths / (4.0 * radius) * width_slope)


def fitted(series: PlaneSeries, compliance: FloatArray, radius: float, reduced_modulus: float) -> LawFit:
    """Fit the law to a series: delta_0 is the mean of what each of its loads gives.

    Parameters
    ----------
    series : PlaneSeries
        Loads and approaches.
    compliance : array, shape (widths,)
        G [m2/N] of which the series was made.
    radius, reduced_modulus : float
        R [m] and E' [Pa].
    """
    slope = 2.0 / (math.pi * reduced_modulus)
    secants = series.approach / series.load - slope * np.log(FE_LOAD / series.load)
    fe_approach = FE_LOAD * float(np.mean(secants))
    law = finite_elements(series.load, fe_approach, radius, reduced_modulus)
    tangent = finite_elements_compliance(series.load, fe_approach, radius, reduced_modulus)
    b = series.half_width
    bend = float(np.polyfit(b**2, compliance + 2.0 * slope * np.log(b), 1)[0])
    free = np.linalg.lstsq(np.stack([np.ones_like(b), np.log(b), b**2], axis=1), compliance, rcond=None)[0]
    return LawFit(
        fe_approach,
        float(np.max(np.abs(law / series.approach - 1.0))),
        float(np.max(np.abs(tangent / series.compliance - 1.0))),
        float(-free[1] / (2.0 * slope) - 1.0),
        # what a kernel adds with k (x - x')^2 adds k b^2/2 to G, and 2 k w to the curvature of the gap
        4.0 * bend * FE_LOAD * radius,
    )

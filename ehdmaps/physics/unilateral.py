"""The rule by which damping acts in a contact that cannot pull: load, stiffness and damping of a moving contact.

At rest a contact carries w(delta) >= 0, and damps small motions by c(delta). As w + c rate the damping would pull the
bodies together when they part quickly. The rule bends that straight line: with x = c rate/w

    F = w (1 + x)       for x >= -1/2,
    F = -w/(4 x)        for x <  -1/2.

The lower branch is the hyperbola that meets the straight line at x = -1/2 with the value w/2 and the slope
dF/d rate = c: F is C1. It stays positive and falls to zero as the bodies part faster, and dF/d rate = c/(4 x^2)
is never negative, so that the damping takes up power at any rate. Without load at rest there is none in motion: w = 0
needs c = 0 here. With ' for the derivative by the approach,

    dF/d delta = w' + c' rate                       for x >= -1/2,
    dF/d delta = -w'/(2 x) + c' rate/(4 x^2)        for x <  -1/2,

which is continuous at x = -1/2 as well.

The function is plain Python that branches on numbers and calls nothing. Each kernel compiles it with its own settings
of numba, which this package does not import.
"""

from __future__ import annotations

Force = tuple[float, float, float]


def unilateral_force(w: float, dw: float, c: float, dc: float, rate: float) -> Force:
    """Load of a contact in motion, never a tension, and its derivatives by approach and rate.

    Parameters
    ----------
    w, dw : float
        Load at rest, >= 0, and its derivative by the approach [N/m], [N/m2]. All may be per unit length, as here, or
        of a whole body.
    c, dc : float
        Damping, >= 0, and its derivative by the approach [N s/m2], [N s/m3]; zero where w is.
    rate : float
        Rate of the approach [m/s].

    Returns
    -------
    load, stiffness, damping : float
        F [N/m], dF/d delta [N/m2], dF/d rate [N s/m2].

    Examples
    --------
    >>> unilateral_force(8.0, 2.0, 4.0, 0.0, rate=-1.0)
    (4.0, 2.0, 4.0)
    >>> unilateral_force(8.0, 2.0, 4.0, 0.0, rate=-4.0)
    (1.0, 0.5, 0.25)
    """
    part = c * rate
    if part >= -0.5 * w:
        return w + part, dw + dc * rate, c
    ratio = w / part
    return -0.25 * w * ratio, 0.25 * ratio * (ratio * dc * rate - 2.0 * dw), 0.25 * ratio * ratio * c

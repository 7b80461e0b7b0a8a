"""Contact laws of a ball bearing: load, stiffness and damping of the normal approach, for both raceways.

A law is what the kernel reads, `NormalLaw`: dry by Hertz, with a damper if wanted, or with a film. A film moves the
approach of each load by its offset h, approach = dry(F) - h(F), and brings a damping of its own:

    F = C g^(3/2),    approach = g - h(F),    1/k = d approach/dF,

so that g(approach) tells all; the table holds ln g and ln c over asinh of the approach, exact at its nodes, with the
exact slope there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError, SolverError
from ehdmaps.physics.point.ball_geometry import BallGeometry
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.solids import STEEL, Material
from mbs.bearings.locating.normal_law import NormalLaw, PairLaw, on_rows

if TYPE_CHECKING:
    from mbs.bearings.balls.response import ContactResponse

NODES = 400


@dataclass(frozen=True, eq=False)
class BallLaw(PairLaw):
    """Laws of both contacts of a ball, see `PairLaw`.

    Attributes
    ----------
    responses : tuple of ContactResponse
        Films of the inner and of the outer contact over frequency; none where they are not known.
    """

    responses: tuple[ContactResponse, ...] = ()

    def springs_on(self, side: int, law: NormalLaw, table: FloatArray) -> FloatArray:
        """Springs of `ContactResponse.in_time`, see `PairLaw.springs_on`.

        Raises
        ------
        SolverError
            If films over frequency are not known.
        """
        if not self.responses:
            raise SolverError("films of balls with memory: some have no response over frequency; take --law table")
        _, load, damping = on_rows(law, table)
        return self.responses[side].in_time(load, damping)


def dry_law(
    geometry: BallGeometry, material: Material = STEEL, damping: float = 0.0, damping_time: float = 0.0
) -> BallLaw:
    """Hertz at both raceways, with a damper at each contact if wanted.

    Parameters
    ----------
    geometry : BallGeometry
        The bearing.
    material : Material
        Material of balls and rings.
    damping : float
        Constant damping of each contact while it carries load [N s/m], >= 0.
    damping_time : float
        Damping over stiffness of each contact [s], >= 0.

    Raises
    ------
    InputError
        For damping that is negative or no number.

    Examples
    --------
    >>> law = dry_law(BallGeometry("6305", 11.5e-3, 43.5e-3, 7, 0.52, 0.53))
    >>> f"{law.inner.coefficient:.4g} {law.outer.coefficient:.4g}"
    '3.074e+10 2.898e+10'
    """
    for name, value, unit in (("damping", damping, "N s/m"), ("damping_time", damping_time, "s")):
        if not (isinstance(value, int | float) and math.isfinite(value) and value >= 0.0):
            raise InputError(f"ball law, {name}: got {value!r:.60} {unit}; allowed: finite and >= 0")
    inner, outer = (
        NormalLaw(contact.coefficient, float(damping), float(damping_time)) for contact in geometry.contacts(material)
    )
    return BallLaw(inner, outer)


FilmCurve = Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray]]
"""Loads [N] to film offset h [m], its slope dh/d ln F [m], and damping c [N s/m]."""


def film_normal_law(contact: Ellipse, curve: FilmCurve, loads: tuple[float, float]) -> NormalLaw:
    """Law of a contact with a film, between two loads; straight in the table's logarithms beyond.

    Parameters
    ----------
    contact : Ellipse
        The dry contact.
    curve : callable
        Film offset and damping over load, see `FilmCurve`.
    loads : (float, float)
        Lowest and highest load [N].

    Raises
    ------
    InputError
        If the offset rises with the load so fast that the approach falls, or damping is not positive.
    """
    rough = np.geomspace(*loads, 4 * NODES)
    dry = np.asarray(contact.approach(rough))
    offset, _, damping = curve(rough)
    approach = dry - offset
    if not (np.all(np.isfinite(approach)) and np.all(np.diff(approach) > 0.0) and np.all(damping > 0.0)):
        raise InputError("ball law: got a film whose approach falls with the load, or no damping; allowed: neither")
    scale = max(float(np.median(offset)), 1e-3 * float(dry.max()))
    centre = float(np.interp(0.5 * scale, dry, approach))
    first, last = (math.asinh((end - centre) / scale) for end in (approach[0], approach[-1]))
    nodes = np.linspace(first, last, NODES)
    target = centre + scale * np.sinh(nodes)
    logs = np.interp(target, approach, np.log(rough))
    for _ in range(50):  # Newton for ln F at the nodes
        load = np.exp(logs)
        offset, slope, damping = curve(load)
        rate = contact.approach(load) * (2.0 / 3.0) - slope
        step = (target - contact.approach(load) + offset) / rate
        logs = np.clip(logs + np.clip(step, -0.5, 0.5), math.log(loads[0]), math.log(loads[1]))
        if np.max(np.abs(step[1:-1])) < 1e-13:
            break
    load = np.exp(logs)
    offset, slope, damping = curve(load)
    # d ln g/dz = (2/3) d ln F/d approach * scale cosh z
    rise = (2.0 / 3.0) / (contact.approach(load) * (2.0 / 3.0) - slope) * scale * np.cosh(nodes)
    width = float(nodes[1] - nodes[0])
    logs_g, logs_c = np.log(contact.approach(load)), np.log(damping)
    table = np.stack((logs_g, rise * width, logs_c, np.gradient(logs_c)), axis=1)
    return NormalLaw(contact.coefficient, 0.0, 0.0, centre, scale, first, width, np.ascontiguousarray(table))

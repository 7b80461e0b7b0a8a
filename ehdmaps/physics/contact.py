"""One line contact: radius, solids, structural law, operating point; a film between solids that cannot pull.

The rule by which damping acts in a contact that cannot pull: load, stiffness and damping of a moving contact.

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

The function is plain Python that branches on numbers and calls nothing. `law.c` of `ehdmaps.kernel` has the same in C.

A contact is a film between solids: approach, stiffness and damping from the film and the structural law.

approach = delta_el(w) - h_eff,    1/k = d(delta_el)/dw + film compliance,    c = loss compliance k^2

in the limit of slow motion; for other frequencies see `ehdmaps.physics.spectrum`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Generic, NamedTuple

from ehdmaps.arrays import Values
from ehdmaps.errors import Problems
from ehdmaps.physics import approach
from ehdmaps.physics.approach import STRUCTURAL_LAWS, StructuralLaw
from ehdmaps.physics.solids import STEEL, Material, reduced_modulus

OIL_TEMPERATURES = (213.15, 573.15)
"""Lowest and highest temperature that an input may give to an oil, -60 and 300 degC [K]: a number beyond stands in
the wrong unit. The laws of an oil break down earlier, and say so."""


@dataclass(frozen=True)
class OperatingPoint:
    """One point of a map.

    Attributes
    ----------
    load : float
        Load per unit length w [N/m], > 0.
    entrainment_speed : float
        Mean u of the two surface speeds [m/s], >= 0 (the contact does not care about the sign).
    temperature : float
        Temperature of both surfaces, and so of the oil between them [K], > 0.

    Raises
    ------
    InputError
        If a value is no number, not finite or out of these limits.
    """

    load: float
    entrainment_speed: float
    temperature: float

    def __post_init__(self) -> None:
        problems = Problems()
        for name, unit, allowed, standstill in (
            ("load", "N/m", "finite and > 0", False),
            ("entrainment_speed", "m/s", "finite and >= 0; give its magnitude", True),
            ("temperature", "K", "finite and > 0 K", False),
        ):
            value = getattr(self, name)
            try:
                possible = math.isfinite(value) and (value > 0 or (standstill and value == 0))
            except (TypeError, OverflowError):
                problems.append(f"{name}: got {value!r:.60}, no number of type float; allowed: [{unit}], {allowed}")
            else:
                if not possible:
                    problems.append(f"{name}: got {value!r} {unit}; allowed: {allowed}")
        problems.check()


Force = tuple[float, float, float]


@dataclass(frozen=True)
class LineContact:
    """Two bodies of one material in line contact, per unit length.

    Attributes
    ----------
    name : str
        "inner" or "outer" in a bearing, "line" for a bare contact.
    radius : float
        Reduced radius R [m].
    material : Material
        Material of both bodies.
    structural_law : {"iso16281", "palmgren", "half_space", "fe"}
        Law of the elastic part of the approach, see `ehdmaps.physics.approach`.
    roller_length : float, optional
        Length of the whole roller [m]; iso16281 and palmgren need it.
    reference_depth : float, optional
        d* [m]; half_space needs it.
    fe_approach : float, optional
        Approach at `ehdmaps.physics.approach.FE_LOAD` by finite elements [m]; fe needs it.

    Raises
    ------
    InputError
        With every value that is missing or out of its limits.
    """

    name: str
    radius: float
    material: Material
    structural_law: StructuralLaw
    roller_length: float | None = None
    reference_depth: float | None = None
    fe_approach: float | None = None

    def __post_init__(self) -> None:
        where = f"contact {self.name!r}"
        problems = Problems()
        for key, value in (
            ("radius", self.radius),
            ("roller_length", self.roller_length),
            ("reference_depth", self.reference_depth),
            ("fe_approach", self.fe_approach),
        ):
            if value is not None and not (math.isfinite(value) and value > 0):
                problems.append(f"{where}, {key}: got {value!r} m; allowed: finite and > 0")
        if self.structural_law not in STRUCTURAL_LAWS:
            problems.append(
                f"{where}, structural_law: got {self.structural_law!r}; allowed: {', '.join(STRUCTURAL_LAWS)}"
            )
        elif self.structural_law == "half_space":
            if self.reference_depth is None:
                problems.append(
                    f"{where}, reference_depth: got none; the half_space law needs it; "
                    "give the depth d* [m] of the point whose approach is meant, or choose another "
                    "structural_law"
                )
        elif self.structural_law == "fe":
            if self.fe_approach is None:
                problems.append(
                    f"{where}, fe_approach: got none; the fe law needs it; give the approach [m] at "
                    f"{approach.FE_LOAD:g} N/m that `ehdmaps solids` finds, or choose another structural_law"
                )
        elif self.roller_length is None:
            problems.append(
                f"{where}, roller_length: got none; the {self.structural_law} law needs it; "
                "give the length of the whole roller [m], or choose half_space with reference_depth"
            )
        problems.check()

    @property
    def reduced_modulus(self) -> float:
        """E' of the pair [Pa]."""
        return reduced_modulus(self.material, self.material)

    def structural_approach(self, load: Values) -> Values:
        """Elastic part of the approach [m] at the load w [N/m].

        Zero at zero load; negative loads are taken as zero.
        """
        if self.structural_law == "half_space":
            return approach.half_space(load, self._depth, self.radius, self.reduced_modulus)
        if self.structural_law == "fe":
            return approach.finite_elements(load, self._fe_approach, self.radius, self.reduced_modulus)
        if self.structural_law == "palmgren":
            return approach.palmgren(load, self._length, self.reduced_modulus)
        return approach.iso16281(load, self._length, self.reduced_modulus)

    def structural_compliance(self, load: Values) -> Values:
        """Derivative of `structural_approach` with respect to the load [m2/N].

        It is inf at zero load, where every law has a vertical tangent, and below: no contact, no stiffness.
        """
        if self.structural_law == "half_space":
            return approach.half_space_compliance(load, self._depth, self.radius, self.reduced_modulus)
        if self.structural_law == "fe":
            return approach.finite_elements_compliance(load, self._fe_approach, self.radius, self.reduced_modulus)
        if self.structural_law == "palmgren":
            return approach.palmgren_compliance(load, self._length, self.reduced_modulus)
        return approach.iso16281_compliance(load, self._length, self.reduced_modulus)

    @property
    def structural_scaling(self) -> float:
        """Factor on the structural approach of steel; 1 for half_space and fe, which know the material."""
        if self.structural_law in ("half_space", "fe"):
            return 1.0
        load = 1e5  # any: the laws are power laws of the load
        return self.structural_approach(load) / replace(self, material=STEEL).structural_approach(load)

    @property
    def _length(self) -> float:
        """Roller length; its presence was checked when the contact was made."""
        return math.nan if self.roller_length is None else self.roller_length

    @property
    def _depth(self) -> float:
        """Reference depth; its presence was checked when the contact was made."""
        return math.nan if self.reference_depth is None else self.reference_depth

    @property
    def _fe_approach(self) -> float:
        """Approach by finite elements; its presence was checked when the contact was made."""
        return math.nan if self.fe_approach is None else self.fe_approach


class Structured(NamedTuple, Generic[Values]):
    """Quantities that depend on the structural law, per unit length; numbers or arrays.

    Attributes
    ----------
    approach : float or array
        delta_el(w) - h_eff [m], > 0 when the bodies come together.
    stiffness : float or array
        k [N/m2].
    damping : float or array
        c [N s/m2].
    stiffness_error, damping_error : float or array
        Estimated relative numerical errors.
    """

    approach: Values
    stiffness: Values
    damping: Values
    stiffness_error: Values
    damping_error: Values


def structured(
    contact: LineContact,
    load: Values,
    film_offset: Values,
    film_compliance: Values,
    loss_compliance: Values,
    film_compliance_error: Values,
    loss_compliance_error: Values,
) -> Structured[Values]:
    """Add the solids of a contact to its film.

    Errors are carried over to first order: 1/k has the absolute error of the film compliance, and c = loss k^2 has that
    of the loss plus twice that of k, with their signs, and a twentieth of both magnitudes in case they cancel.

    Parameters
    ----------
    contact : LineContact
        The contact, with its structural law.
    load : float or array
        w [N/m].
    film_offset : float or array
        h_eff [m].
    film_compliance : float or array
        -d(h_eff)/dw [m2/N].
    loss_compliance : float or array
        c/k^2 [m2 s/N].
    film_compliance_error, loss_compliance_error : float or array
        Estimated relative errors with their signs; only the sign of one against the other matters.
    """
    compliance = contact.structural_compliance(load) + film_compliance
    stiffness_error = -film_compliance * film_compliance_error / compliance
    both = abs(loss_compliance_error) + 2.0 * abs(stiffness_error)
    return Structured(
        approach=contact.structural_approach(load) - film_offset,
        stiffness=1.0 / compliance,
        damping=loss_compliance / compliance**2,
        stiffness_error=abs(stiffness_error),
        damping_error=abs(loss_compliance_error + 2.0 * stiffness_error) + 0.05 * both,
    )

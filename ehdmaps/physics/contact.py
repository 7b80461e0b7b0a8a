"""One line contact: its reduced radius, its solids, and the law of its structural approach."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ehdmaps.errors import InputError
from ehdmaps.physics import approach
from ehdmaps.physics._values import Values
from ehdmaps.physics.approach import STRUCTURAL_LAWS, StructuralLaw
from ehdmaps.physics.solids import STEEL, Material, reduced_modulus


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
        problems = []
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
        if problems:
            raise InputError(problems)

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

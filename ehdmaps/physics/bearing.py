"""Geometry of a cylindrical roller bearing: reduced radii, entrainment speed, contacts of a roller."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import ClassVar

from ehdmaps.errors import InputError, label_problem
from ehdmaps.physics.approach import StructuralLaw, roller_reference_depth, shipped_approaches, shipped_names
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.designations.clearance import ClearanceRange, Named, class_range
from ehdmaps.physics.designations.reader import CYLINDRICAL
from ehdmaps.physics.solids import Material


@dataclass(frozen=True)
class BearingGeometry(Named):
    """A cylindrical roller bearing.

    Attributes
    ----------
    name : str
        Name for provenance and messages.
    inner_raceway_diameter, outer_raceway_diameter : float
        Nominal raceway diameters [m].
    roller_diameter, roller_length : float
        D and L [m], L the effective length.
    rollers : int
        Number Z of rollers of a row.
    diametral_clearance : float
        P_d [m], < 0 for a preloaded bearing. It is an input of its own and not checked against the raceways.
    label : str or None
        Free text shown instead of the name; no part of what makes bearings equal.
    estimated : str or None
        How its inner geometry was estimated and how well, see `ehdmaps.physics.catalogue`; None where it is known.
    clearance_range : ClearanceRange or None
        What the clearance may be by the designation; no part of what makes bearings equal, nor of records. None where
        it is stated.
    spelled : str or None
        What each part of the designation means; no part of what makes bearings equal, nor of records.
    row_distance : float or None
        Distance between the middles of two rows of such rollers, which stand side by side [m]; None for one row.

    Raises
    ------
    InputError
        With every problem of the geometry.

    Examples
    --------
    >>> nu308 = BearingGeometry.named("NU308")
    >>> round(1e3 * nu308.inner_radius, 4), round(1e3 * nu308.outer_radius, 4)
    (5.5152, 8.4848)
    """

    clearance_field: ClassVar[str] = "diametral_clearance"
    name: str
    inner_raceway_diameter: float
    outer_raceway_diameter: float
    roller_diameter: float
    roller_length: float
    rollers: int
    diametral_clearance: float
    label: str | None = field(default=None, compare=False)
    estimated: str | None = None
    clearance_range: ClearanceRange | None = field(default=None, compare=False)
    spelled: str | None = field(default=None, compare=False)
    row_distance: float | None = None

    def __post_init__(self) -> None:
        problems = _problems(self)
        if problems:
            raise InputError(problems)

    @classmethod
    def named(cls, name: str) -> BearingGeometry:
        """One of the bearings of `BEARINGS`, with a clearance in the middle of what CN leaves a mounted one.

        Raises
        ------
        InputError
            If there is no bearing of that name.
        """
        try:
            return BEARINGS[name]
        except KeyError:
            raise InputError(
                f"bearing name: got {name!r}; allowed: {', '.join(BEARINGS)}; give other bearings by their dimensions"
            ) from None

    @property
    def row_count(self) -> int:
        """Number of its rows."""
        return len(self.row_places)

    @property
    def row_places(self) -> tuple[float, ...]:
        """Places of its rows along the axis [m]."""
        return (0.0,) if self.row_distance is None else (-0.5 * self.row_distance, 0.5 * self.row_distance)

    @property
    def row_words(self) -> str:
        """Its rows in words, behind the number of rollers; empty for one."""
        return "" if self.row_distance is None else f" in 2 rows, {1e3 * self.row_distance:.4g} mm apart"

    @property
    def rolling_elements(self) -> int:
        """Number of its rollers, of all rows."""
        return self.rollers * self.row_count

    @property
    def pitch_diameter(self) -> float:
        """d_m, mean of the raceway diameters [m]."""
        return 0.5 * (self.inner_raceway_diameter + self.outer_raceway_diameter)

    @property
    def gamma(self) -> float:
        """Ratio D/d_m."""
        return self.roller_diameter / self.pitch_diameter

    @property
    def lean(self) -> float:
        """Cosine of the angle between the axes of rollers and bearing: 1."""
        return 1.0

    @property
    def inner_radius(self) -> float:
        """Reduced radius of the inner contact, (D/2)(1 - gamma) [m]."""
        return 0.5 * self.roller_diameter * (1.0 - self.gamma)

    @property
    def outer_radius(self) -> float:
        """Reduced radius of the outer contact, (D/2)(1 + gamma) [m]."""
        return 0.5 * self.roller_diameter * (1.0 + self.gamma)

    def entrainment_speed(self, inner_speed: float, outer_speed: float = 0.0) -> float:
        """Entrainment speed u = (d_m/4) abs(omega_i - omega_o) (1 - gamma^2) [m/s].

        Pure rolling is taken; u is then the same at both races.

        Parameters
        ----------
        inner_speed, outer_speed : float
            Speeds of the rings [rad/s].

        Examples
        --------
        500 rpm:

        >>> round(BearingGeometry.named("NU308").entrainment_speed(500 * 2 * math.pi / 60), 3)
        0.825
        """
        return 0.25 * self.pitch_diameter * abs(inner_speed - outer_speed) * (1.0 - self.gamma**2)

    def inner_speed(self, entrainment_speed: float) -> float:
        """Speed of the inner ring [rad/s] that gives an entrainment speed [m/s], outer ring fixed, pure rolling.

        Examples
        --------
        >>> round(BearingGeometry.named("NU308").inner_speed(0.8251) * 60 / (2 * math.pi))
        500
        """
        return entrainment_speed / self.entrainment_speed(1.0)

    def contacts(
        self,
        material: Material,
        structural_law: StructuralLaw,
        fe_approaches: Mapping[str, float] | None = None,
    ) -> tuple[LineContact, LineContact]:
        """The contacts "inner" and "outer" of a roller.

        Roller length and reference depth d* = D/e are given to both, whichever of them the law uses.

        Parameters
        ----------
        material : Material
            Material of both bodies.
        structural_law : {"iso16281", "palmgren", "half_space", "fe"}
            Law of the elastic part of the approach.
        fe_approaches : mapping of str to float, optional
            Approaches of both contacts by finite elements [m], see `LineContact`; for the law fe those that come with
            the package if left out.

        Raises
        ------
        InputError
            If the law is fe and there are no such approaches.
        """
        known = fe_approaches or (self.fe_approaches(material) if structural_law == "fe" else {})
        inner, outer = (
            LineContact(
                name=name,
                radius=radius,
                material=material,
                structural_law=structural_law,
                roller_length=self.roller_length,
                reference_depth=roller_reference_depth(self.roller_diameter),
                fe_approach=known.get(name),
            )
            for name, radius in (("inner", self.inner_radius), ("outer", self.outer_radius))
        )
        return inner, outer

    def fe_approaches(self, material: Material) -> dict[str, float]:
        """Approaches of both contacts by finite elements that come with the package, by their names [m].

        Parameters
        ----------
        material : Material
            Material of all bodies.

        Raises
        ------
        InputError
            If none come with it for this bearing and material.
        """
        found = shipped_approaches(self.record(), material)
        if found is None:
            raise InputError(
                f"law fe: got the bearing {self.name!r}, E = {material.youngs_modulus / 1e9:g} GPa, nu = "
                f"{material.poisson_ratio:g}; allowed: {', '.join(shipped_names())} with nu = 0.3, whose finite "
                "elements come with the package; for others run `ehdmaps solids JOB` and add the lines that it prints"
            )
        return found


def with_law(contact: LineContact, structural_law: StructuralLaw, bearing: BearingGeometry | None) -> LineContact:
    """The same contact by another structural law.

    Parameters
    ----------
    contact : LineContact
        The contact, with the lengths that its laws need.
    structural_law : {"iso16281", "palmgren", "half_space", "fe"}
        The law.
    bearing : BearingGeometry or None
        Bearing of the contact, for the law fe of a contact that does not know its approach; None for a bare contact.

    Raises
    ------
    InputError
        If the law lacks what it needs.
    """
    known = contact.fe_approach
    if bearing is not None:
        if structural_law == "fe" and known is None:
            known = bearing.fe_approaches(contact.material)[contact.name]
        elif structural_law != "fe" and known is not None:
            # what comes with the package is no part of a contact by another law
            shipped = shipped_approaches(bearing.record(), contact.material) or {}
            known = None if shipped.get(contact.name) == known else known
    return replace(contact, structural_law=structural_law, fe_approach=known)


def _problems(bearing: BearingGeometry) -> list[str]:
    """All that is impossible about a geometry, in words."""
    where = f"bearing {bearing.name!r}"
    problems = [f"{where}, label: {problem}" for problem in label_problem(bearing.label)]
    lengths_known = True
    for key in ("inner_raceway_diameter", "outer_raceway_diameter", "roller_diameter", "roller_length"):
        value = getattr(bearing, key)
        if not (math.isfinite(value) and value > 0):
            problems.append(f"{where}, {key}: got {value!r} m; allowed: finite and > 0")
            lengths_known = False
    rollers = bearing.rollers
    rollers_known = isinstance(rollers, int) and not isinstance(rollers, bool) and rollers >= 1
    if not rollers_known:
        problems.append(f"{where}, rollers: got {rollers!r}; allowed: a whole number >= 1")
    clearance_known = math.isfinite(bearing.diametral_clearance)
    if not clearance_known:
        problems.append(
            f"{where}, diametral_clearance: got {bearing.diametral_clearance!r} m; allowed: finite; use 0 if unknown"
        )
    if not lengths_known:
        return problems

    apart = bearing.row_distance
    if apart is not None and not bearing.roller_length < apart < math.inf:
        problems.append(
            f"{where}, row_distance: got {apart!r} m; allowed: finite, and more than the roller_length "
            f"{bearing.roller_length!r} m, lest rows overlap; leave it out for one row"
        )
    diameter, pitch = bearing.roller_diameter, bearing.pitch_diameter
    if bearing.outer_raceway_diameter <= bearing.inner_raceway_diameter:
        problems.append(
            f"{where}, outer_raceway_diameter: got {bearing.outer_raceway_diameter!r} m; "
            f"allowed: > the inner_raceway_diameter {bearing.inner_raceway_diameter!r} m; exchange them?"
        )
    if diameter >= pitch:
        problems.append(
            f"{where}, roller_diameter: got {diameter!r} m; allowed: < the pitch diameter {pitch:.6g} m "
            "(mean of the raceway diameters)"
        )
    elif rollers_known and rollers > 1 and pitch * math.sin(math.pi / rollers) < diameter:
        most = int(math.pi / math.asin(diameter / pitch))
        problems.append(
            f"{where}, rollers: got {rollers}, which overlap on the pitch circle of {pitch:.6g} m; "
            f"allowed: at most {most} rollers of {diameter!r} m"
        )
    if clearance_known and abs(bearing.diametral_clearance) >= diameter:
        problems.append(
            f"{where}, diametral_clearance: got {bearing.diametral_clearance!r} m; "
            f"allowed: smaller than the roller_diameter {diameter!r} m; check its unit"
        )
    return problems


BEARINGS: dict[str, BearingGeometry] = {
    bearing.name: bearing
    for bearing in (
        BearingGeometry(
            name="N1014",
            inner_raceway_diameter=82e-3,
            outer_raceway_diameter=100e-3,
            roller_diameter=9e-3,
            roller_length=9e-3,
            rollers=24,
            diametral_clearance=0.0,
        ).delivered(class_range(CYLINDRICAL, 70e-3)),
        BearingGeometry(
            name="NU308",
            inner_raceway_diameter=52e-3,
            outer_raceway_diameter=80e-3,
            roller_diameter=14e-3,
            roller_length=15e-3,
            rollers=12,
            diametral_clearance=0.0,
        ).delivered(class_range(CYLINDRICAL, 40e-3)),
    )
}

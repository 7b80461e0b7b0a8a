"""Radial clearance of a bearing whose clearance is not stated: by the class of its designation, C2 to C5, else CN.

Makers deliver a class of ISO 5753-1. A fit and the warmth of the inner ring take a part of it; where the fit is not
known, a mounted bearing may have anything from some way below the least clearance of its class, but not below zero, up
to the largest. The middle of that is taken, and the range told beside it.

Needle bearings with an inner ring have the classes of cylindrical roller bearings. Without one the shaft makes the
clearance: the raceway of series 49 has F6, cages run in housings G6, and shafts for a normal clearance have h5. That of
angular contact and of tapered bearings is set when they are mounted.

References
----------
ISO 5753-1, Rolling bearings - Internal clearance - Part 1: Radial internal clearance for radial bearings, cylindrical
bore: values as printed in makers' tables, which agree (SKF for rollers; SKF, NSK, Fujian Huafeng for balls).
ISO 286-2: F6, F8, G6 and h5. Which of them: catalogues of INA and IKO for cages, of SKF for series 49, ISO 3245 for
drawn cups, in a ring gauge.
"""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

from ehdmaps.errors import InputError, short
from ehdmaps.physics.designations.affixes import REFUSED
from ehdmaps.physics.designations.reader import (
    ANGULAR,
    BALLS,
    CYLINDRICAL,
    DEEP_GROOVE,
    DOUBLE_ROW,
    DRAWN_CUP,
    FOUR_POINT,
    NEEDLE,
    SELF_ALIGNING,
    TAPERED,
    THRUST,
    Designation,
    read_designation,
    table,
)

CLASSES = ("C2", "CN", "C3", "C4", "C5")
NORMAL = "CN"
"""Class of a bearing whose designation has none."""

_BALLS, _ROLLERS = table("clearance")["balls"], table("clearance")["rollers"]
_TABLES = {DEEP_GROOVE: _BALLS, CYLINDRICAL: _ROLLERS, NEEDLE: _ROLLERS}
_FIT = {CYLINDRICAL: 20e-6, NEEDLE: 20e-6, DEEP_GROOVE: 10e-6}
"""Most of a clearance that fits and warmth take where they are not stated [m]: a rule of our own. k5 in the ring of
class P0 with a bore of 40 mm has 2 to 25 um of interference, of which three quarters arrive at the raceway; rings of
that bore lose 4 um where the inner one is 5 K warmer."""

# largest diameter [mm]; F6, G6: least and largest deviation of a hole, F8: largest; h5: tolerance of a shaft below its
# diameter [um]
_SHAFTS = (
    (10, 13, 22, 5, 14, 35, 6),
    (18, 16, 27, 6, 17, 43, 8),
    (30, 20, 33, 7, 20, 53, 9),
    (50, 25, 41, 9, 25, 64, 11),
    (80, 30, 49, 10, 29, 76, 13),
    (120, 36, 58, 12, 34, 90, 15),
)
_AXIAL = {DOUBLE_ROW: ("double_row", 20e-6), FOUR_POINT: ("four_point", 14e-6)}
"""Tables of axial clearances, and the most that fits and warmth take of them [m]."""

_OWN = {**_AXIAL, SELF_ALIGNING: ("self_aligning", 10e-6)}
"""The same, and of kinds that have a radial one by a table of their own."""

_MOUNTED = {
    ANGULAR: "the play of angular contact bearings is set when they are mounted",
    TAPERED: "the play of tapered bearings is set when they are mounted",
    THRUST: "washers of thrust ball bearings have none",
}
_NO_RING = "without an inner ring, shaft and needles make the clearance"

_TOLD = ("clearance_range", "spelled")
"""Fields of a geometry that are no part of records: what is told of it."""

MOUNTED, DELIVERED, STATED = "mounted", "delivered", "stated"
"""What a bearing has of a range: what a fit that is not known leaves of it; all of it, before it is mounted; neither,
for a clearance that is stated beside it counts."""


class ClearanceRange(NamedTuple):
    """Radial clearance that a bearing may have by its designation.

    Attributes
    ----------
    name : str
        Class of ISO 5753-1; or the tolerances of what makes the clearance, such as "F6/h5".
    least, largest : float
        Range before mounting [m].
    fit : float
        Most that fits and warmth take of it [m].
    typed : bool
        Whether the class stands in the designation.
    taken : {"mounted", "delivered", "stated"}
        What the bearing has of it, see `MOUNTED`.
    axial : str
        Whose table has it, for a clearance that is axial; empty for a radial one.
    """

    name: str
    least: float
    largest: float
    fit: float
    typed: bool = False
    taken: str = MOUNTED
    axial: str = ""

    @property
    def reach(self) -> tuple[float, float]:
        """Least and largest clearance that the bearing may have [m]."""
        least = max(self.least - self.fit, 0.0) if self.taken == MOUNTED else self.least
        # 30 um less 20 um are 1e-5 m, and not one bit beside
        return float(f"{least:.9g}"), self.largest

    @property
    def clearance(self) -> float:
        """Clearance that is taken where none is stated, the middle [m]."""
        return float(f"{0.5 * sum(self.reach):.9g}")

    @property
    def unmounted(self) -> ClearanceRange:
        """The same for a bearing whose fit is known: what it has before it is mounted."""
        return self._replace(taken=DELIVERED) if self.taken == MOUNTED else self

    @property
    def source(self) -> str:
        """Name of what gives the range."""
        if self.axial:
            return f"{self.name} of {self.axial}, axial"
        return f"{self.name} of ISO {'5753-1' if self.name in CLASSES else '286-2'}"

    @property
    def why(self) -> str:
        """Reason why the clearance is open."""
        less = ", less a fit" if self.taken == MOUNTED and self.fit else ""
        return f"not stated: {self.source}{less}"

    @property
    def words(self) -> str:
        """Clearance that was taken, and the range beside it."""
        by = f"{self.axial}'s table, axial" if self.axial else "ISO 5753-1"
        delivered = f"{_reach(self.least, self.largest)} by {by}, before mounting"
        if self.taken == STATED:
            return f"clearance as stated: {self.name} of the designation would be {delivered}"
        return f"clearance {self.why}: {1e6 * self.clearance:.4g} um, the middle of {_reach(*self.reach)}"


def _reach(least: float, largest: float) -> str:
    """A range in words."""
    return f"{1e6 * least:.4g} to {1e6 * largest:.4g} um"


class Named:
    """Geometry of a bearing with a name: how it is told, what is kept of it, and its clearance; a frozen dataclass."""

    clearance_field: ClassVar[str] = ""
    """Name of the field of its clearance; empty where it has none."""

    if TYPE_CHECKING:
        name: str
        label: str | None
        rollers: int
        spelled: str | None

    @property
    def rolling_elements(self) -> int:
        """Number of its rolling elements."""
        return self.rollers

    @property
    def bodies(self) -> int:
        """Number of its rolling elements; balls with four contacts count once."""
        return self.rolling_elements

    @property
    def row_elements(self) -> int:
        """Number of the rolling elements of a row."""
        return self.rollers

    @property
    def title(self) -> str:
        """Name of the bearing in titles: its label, else its name; `estimated` is for a line of its own."""
        return self.label or self.name

    @property
    def thrust(self) -> bool:
        """Tell whether its contacts carry along the axis alone."""
        return False

    @property
    def has_clearance(self) -> bool:
        """Tell whether it has one."""
        return bool(self.clearance_field)

    @property
    def clearance(self) -> float | None:
        """Diametral clearance [m]; None where what presses or loosens rollers is an axial displacement."""
        return getattr(self, self.clearance_field) if self.clearance_field else None

    def record(self) -> dict[str, float | str]:
        """Everything that defines the bearing, for provenance; SI units; what is not given is left out."""
        own: Any = self
        values = {entry.name: getattr(self, entry.name) for entry in fields(own) if entry.name not in _TOLD}
        return {name: value for name, value in values.items() if value is not None}

    def typed(self, designation: str) -> Self:
        """The same bearing with what each part of its designation means.

        Parameters
        ----------
        designation : str
            Designation as it was typed.
        """
        own: Any = self
        found = read_designation(designation)
        changed: Self = replace(own, spelled=None if found is None else found.words)
        return changed

    def delivered(self, clearance: ClearanceRange | None) -> Self:
        """The same bearing with a clearance that is not stated: the middle of a range, zero without one [m]."""
        return self._with(0.0 if clearance is None else clearance.clearance, clearance)

    def with_clearance(self, clearance: float) -> Self:
        """The same bearing with a clearance that is stated [m]; as it is where it has none."""
        if not self.clearance_field:
            return self
        return self._with(clearance, stated(getattr(self, "clearance_range", None)))

    @property
    def without_clearance(self) -> Self:
        """The same bearing with a clearance of zero: bearings that agree in it have the same contacts."""
        return self._with(0.0, None)

    def _with(self, clearance: float, reach: ClearanceRange | None) -> Self:
        """The same bearing with a clearance and its range."""
        own: Any = self
        changed: Self = replace(own, **{self.clearance_field: clearance, "clearance_range": reach})
        return changed


def class_range(kind: str, bore: float, name: str = NORMAL, *, typed: bool = False) -> ClearanceRange | None:
    """Range of a class of clearance; None for kinds and bores that have no classes.

    Parameters
    ----------
    kind : str
        Kind of the bearing, of `ehdmaps.physics.designations.reader`.
    bore : float
        Bore [m].
    name : str
        Class, one of `CLASSES`.
    typed : bool
        Whether the class stands in the designation.

    Examples
    --------
    >>> class_range(DEEP_GROOVE, 40e-3, "C3").words
    'clearance not stated: C3 of ISO 5753-1, less a fit: 19 um, the middle of 5 to 33 um'
    """
    for largest_bore, *limits in _TABLES.get(kind, ()):
        if bore <= 1e-3 * largest_bore * (1.0 + 1e-9):
            place = 2 * CLASSES.index(name)
            return ClearanceRange(name, limits[place] / 1e6, limits[place + 1] / 1e6, _FIT[kind], typed)
    return None


def shaft_range(kind: str, raceway: float) -> ClearanceRange | None:
    """Range of needles whose raceway is a shaft of h5; None for diameters beyond those of needle bearings.

    Parameters
    ----------
    kind : str
        Needle bearing, of series 49, needle cage, or drawn cup.
    raceway : float
        Diameter of the shaft [m].

    Examples
    --------
    >>> shaft_range(NEEDLE, 48e-3).words
    'clearance not stated: F6/h5 of ISO 286-2, less a fit: 28.5 um, the middle of 5 to 52 um'
    """
    for largest, *hole, shaft in _SHAFTS:
        if raceway <= 1e-3 * largest * (1.0 + 1e-9):
            if kind == NEEDLE:  # whose outer ring sits in a housing
                return ClearanceRange("F6/h5", hole[0] / 1e6, (hole[1] + shaft) / 1e6, _FIT[kind])
            if kind == DRAWN_CUP:  # measured in a ring gauge; a tighter housing takes more
                return ClearanceRange("F8/h5", hole[0] / 1e6, (hole[4] + shaft) / 1e6, _FIT[NEEDLE])
            return ClearanceRange("G6/h5", hole[2] / 1e6, (hole[3] + shaft) / 1e6, 0.0)
    return None


def own_range(found: Designation, bore: float) -> ClearanceRange | None:
    """Clearance of a bearing of two rows by its designation, mostly axial; None for bores that have no classes.

    A radial fit of the size that deep groove bearings are given takes the cotangent of the contact angle of it.

    Parameters
    ----------
    found : Designation
        Parts of its designation.
    bore : float
        Bore [m].

    Raises
    ------
    InputError
        For a class that its table does not have.
    """
    key, taken = _OWN[found.kind]
    name = found.clearance or NORMAL
    for largest_bore, *limits in table("clearance")[key]:
        if bore <= 1e-3 * largest_bore * (1.0 + 1e-9):
            names = CLASSES[: len(limits) // 2]
            if name not in names:
                raise InputError(
                    f"bearing designation: got {short(found.text)}; allowed: one of the classes {', '.join(names)}; "
                    f"state the clearance and leave {name} out"
                )
            place = 2 * names.index(name)
            least, most = limits[place] / 1e6, limits[place + 1] / 1e6
            return ClearanceRange(name, least, most, taken, bool(found.clearance), axial="SKF" * (found.kind in _AXIAL))
    return None


def refuse_affixes(designation: str, found: Designation) -> None:
    """Refuse what stands before or behind a designation, changes forces and is not served.

    Parameters
    ----------
    designation : str
        Designation as it was typed.
    found : Designation
        Parts of it.

    Raises
    ------
    InputError
        For such a part.
    """
    refused = [one.words for one in found.affixes if one.effect == REFUSED]
    if found.hybrid and found.kind not in BALLS:
        refused.append("rollers of silicon nitride: not yet")
    if refused:
        raise InputError(
            f"bearing designation: got {short(designation)}, {'; '.join(refused)}; allowed: without it, for the "
            "bearing that has none of it"
        )


def delivered(designation: str, bore: float | None, raceway: float = 0.0) -> ClearanceRange | None:
    """Clearance of a bearing by its designation; None for kinds whose clearance is set when they are mounted.

    Parameters
    ----------
    designation : str
        Designation as it was typed.
    bore : float or None
        Bore of the inner ring [m]; None where there is no ring.
    raceway : float
        Diameter of the shaft, where that is the raceway [m].

    Raises
    ------
    InputError
        For a class where there is none, for several classes, for those of a maker's own, and for suffixes that change
        forces in a way that is not served.

    Examples
    --------
    >>> [round(1e6 * delivered(name, 40e-3).clearance, 3) for name in ("6208", "6208 C3", "NU208")]
    [10.0, 19.0, 27.5]
    """
    found = read_designation(designation)
    if found is None:
        return None
    where, name = f"bearing designation: got {short(designation)}", found.clearance
    refuse_affixes(designation, found)
    if not name:
        return shaft_range(found.kind, raceway) if bore is None else class_range(found.kind, bore)
    why = _MOUNTED.get(found.kind, "" if bore is not None else _NO_RING)
    if why:
        raise InputError(f"{where}; allowed: no class of radial clearance: {why}; leave {name} out")
    if name not in CLASSES:
        raise InputError(
            f"{where}; allowed: one of the classes {', '.join(CLASSES)} of ISO 5753-1; state the clearance and leave "
            f"{name} out"
        )
    return class_range(found.kind, float(bore or 0.0), name, typed=True)


def clearance_range(geometry: object) -> ClearanceRange | None:
    """Range of the clearance of a bearing by its designation; None where it is stated, and where there is no class.

    Parameters
    ----------
    geometry : object
        Geometry of a bearing of any kind.
    """
    found: ClearanceRange | None = getattr(geometry, "clearance_range", None)
    return found


def stated(beside: ClearanceRange | None) -> ClearanceRange | None:
    """Range beside a clearance that is stated: words where the designation has a class, else nothing.

    Parameters
    ----------
    beside : ClearanceRange or None
        Clearance by the designation.
    """
    return beside._replace(taken=STATED) if beside is not None and beside.typed else None

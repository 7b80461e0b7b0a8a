"""Radial clearance of a bearing as it is delivered: the classes C2 to C5 of ISO 5753-1, by the bore.

A designation with a class has the middle of its range, which is a guess within it. One without a class, and without a
clearance that is stated, has none here: bearings are delivered with CN then, of which fits and heat take most, or all.

Needle bearings with an inner ring have the classes of cylindrical roller bearings. Without one the shaft makes the
clearance. That of angular contact and of tapered bearings is set when they are mounted.

References
----------
ISO 5753-1, Rolling bearings - Internal clearance - Part 1: Radial internal clearance for radial bearings, cylindrical
bore: values as printed in makers' tables, which agree (SKF for rollers; SKF, NSK, Fujian Huafeng for balls).
"""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

from ehdmaps.errors import InputError, short
from ehdmaps.physics.designations.reader import ANGULAR, CYLINDRICAL, DEEP_GROOVE, NEEDLE, TAPERED, read_designation
from ehdmaps.physics.designations.tables import table

CLASSES = ("C2", "CN", "C3", "C4", "C5")
NORMAL = "CN"
"""Class of a bearing whose designation has none."""

_BALLS, _ROLLERS = table("clearance")["balls"], table("clearance")["rollers"]
_TABLES = {DEEP_GROOVE: _BALLS, CYLINDRICAL: _ROLLERS, NEEDLE: _ROLLERS}
_FIT, _FITS = 20e-6, {DEEP_GROOVE: 10e-6}
"""What fits and warmth take of a clearance at most, where neither is stated [m]: a rule of our own. k5 in the ring of
class P0 with a bore of 40 mm has 2 to 25 um of interference, of which three quarters arrive at the raceway."""
_MOUNTED = {
    ANGULAR: "the play of angular contact bearings is set when they are mounted",
    TAPERED: "the play of tapered bearings is set when they are mounted",
}
_NO_RING = "without an inner ring, shaft and needles make the clearance"


class ClearanceRange(NamedTuple):
    """Radial clearance that a bearing may have as it is delivered, not mounted.

    Attributes
    ----------
    name : str
        Class of ISO 5753-1.
    least, largest : float
        Range of the class [m].
    taken : {"middle", "zero", "stated"}
        What the bearing has: the middle of the class of its designation; none, where neither a class nor a clearance
        is stated; or a clearance that is stated beside a class, which counts.
    fit : float
        What fits and warmth take of it at most [m].
    """

    name: str
    least: float
    largest: float
    taken: str
    fit: float = 20e-6

    @property
    def mounted(self) -> tuple[float, float]:
        """Range of a bearing that is mounted with a fit that is not known [m]."""
        return max(self.least - self.fit, 0.0), self.largest

    @property
    def clearance(self) -> float:
        """Clearance that a bearing has by its designation alone [m]."""
        # a middle of 24 um is 24e-6, and not one bit beside
        return float(f"{0.5 * (self.least + self.largest):.9g}") if self.taken == "middle" else 0.0

    @property
    def words(self) -> str:
        """Clearance that was taken, and the range beside it."""
        reach = f"{1e6 * self.least:.4g} to {1e6 * self.largest:.4g} um by ISO 5753-1, before mounting"
        if self.taken == "middle":
            return f"clearance in the middle of {self.name}: {reach}"
        if self.taken == "zero":
            return f"no clearance, an assumption: {self.name} would be {reach}"
        return f"clearance as stated: {self.name} of the designation would be {reach}"


class Named:
    """Geometry of a bearing with a name: how it is told, what is kept of it, and its clearance; a frozen dataclass."""

    clearance_field: ClassVar[str] = ""
    """Name of the field of its clearance; empty where it has none."""

    if TYPE_CHECKING:
        name: str
        label: str | None

    @property
    def title(self) -> str:
        """Name of the bearing in titles: its label, else its name; `estimated` is for a line of its own."""
        return self.label or self.name

    def record(self) -> dict[str, float | str]:
        """Everything that defines the bearing, for provenance; SI units; what is not given is left out."""
        own: Any = self
        values = {entry.name: getattr(self, entry.name) for entry in fields(own) if entry.name != "clearance_range"}
        return {name: value for name, value in values.items() if value is not None}

    def delivered(self, clearance: ClearanceRange | None) -> Self:
        """The same bearing with the clearance of its designation, and the range of it."""
        return self._with(0.0 if clearance is None else clearance.clearance, clearance)

    def with_clearance(self, clearance: float) -> Self:
        """The same bearing with a clearance that is stated [m]; as it is where it has none."""
        if not self.clearance_field:
            return self
        return self._with(clearance, stated(getattr(self, "clearance_range", None)))

    def _with(self, clearance: float, reach: ClearanceRange | None) -> Self:
        """The same bearing with a clearance and its range."""
        own: Any = self
        changed: Self = replace(own, **{self.clearance_field: clearance, "clearance_range": reach})
        return changed


def class_range(kind: str, bore: float, name: str, taken: str = "middle") -> ClearanceRange | None:
    """Range of a class of clearance; None for kinds and bores that have no classes.

    Parameters
    ----------
    kind : str
        Kind of the bearing, of `ehdmaps.physics.designations.reader`.
    bore : float
        Bore [m].
    name : str
        Class, one of `CLASSES`.
    taken : str
        What the bearing has of it, see `ClearanceRange`.

    Examples
    --------
    >>> class_range(DEEP_GROOVE, 40e-3, "C3").words
    'clearance in the middle of C3: 15 to 33 um by ISO 5753-1, before mounting'
    """
    for largest_bore, *limits in _TABLES.get(kind, ()):
        if bore <= 1e-3 * largest_bore * (1.0 + 1e-9):
            place = 2 * CLASSES.index(name)
            return ClearanceRange(name, limits[place] / 1e6, limits[place + 1] / 1e6, taken, _FITS.get(kind, _FIT))
    return None


def delivered(designation: str, bore: float | None) -> ClearanceRange | None:
    """Clearance of a bearing by its designation; None for kinds that have no classes.

    Parameters
    ----------
    designation : str
        Designation as it was typed.
    bore : float or None
        Bore of the inner ring [m]; None where there is no ring.

    Raises
    ------
    InputError
        For a class where there is none, for several classes, and for those of a maker's own.

    Examples
    --------
    >>> round(1e6 * delivered("6208 C3", 40e-3).clearance, 3), delivered("6208", 40e-3).clearance
    (24.0, 0.0)
    """
    found = read_designation(designation)
    if found is None:
        return None
    where, name = f"bearing designation: got {short(designation)}", found.clearance
    if not name:
        return None if bore is None else class_range(found.kind, bore, NORMAL, "zero")
    why = _MOUNTED.get(found.kind, "" if bore is not None else _NO_RING)
    if why:
        raise InputError(f"{where}; allowed: no class of radial clearance: {why}; leave {name} out")
    if name not in CLASSES:
        raise InputError(
            f"{where}; allowed: one of the classes {', '.join(CLASSES)} of ISO 5753-1; state the clearance and leave "
            f"{name} out"
        )
    return class_range(found.kind, float(bore or 0.0), name)


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
    return None if beside is None or beside.taken == "zero" else beside._replace(taken="stated")

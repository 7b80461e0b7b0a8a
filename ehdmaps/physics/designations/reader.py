"""Kind, plain name and class of radial clearance of a designation, for all kinds that are served; rows of catalogues.

Blanks, hyphens and the suffixes of seals, cages and accuracy do not matter. Those of the radial clearance do: they
stand for themselves (C3), or behind a class of accuracy (P63).
"""

from __future__ import annotations

import re
import tomllib
from functools import cache
from importlib import resources
from typing import Any, NamedTuple

CYLINDRICAL, NEEDLE, NEEDLE_CAGE, DEEP_GROOVE, ANGULAR, TAPERED = (
    "cylindrical roller bearing",
    "needle roller bearing",
    "needle cage",
    "deep groove ball bearing",
    "angular contact ball bearing",
    "tapered roller bearing",
)
BALLS, ROLLERS, NEEDLES = (DEEP_GROOVE, ANGULAR), (CYLINDRICAL, NEEDLE, NEEDLE_CAGE), (NEEDLE, NEEDLE_CAGE)

# classes of clearance and of accuracy, which every kind has behind its own suffixes
_EVERY = r"C[2-5]|CN|CM|P[2-6][2-5]?"
_SEALS = r"2?RS[HLRJ]?[12]?|2?Z|ZZ|DDU|LLU|LLB|VV"
_CAGES = r"T[VN]?H?P?|TN9?|M|MA|JEM"


class _Kind(NamedTuple):
    """Beginning of the designations of a kind, and its own suffixes."""

    kind: str
    base: str
    suffixes: str


_KINDS = (
    _Kind(
        CYLINDRICAL,
        r"(NUP|NU|NJ|N)[ -]*(10|22|23|2|3)[ -]?(\d\d)(?:[ .-]*E[A-Z]{0,3})?",
        "XL|TVP[2-5]?|M1A?|JP[1-3]",
    ),
    _Kind(CYLINDRICAL, r"(NCF)[ -]*(30)[ -]?(\d\d)(?:[ -]?C?V)?", "XL"),
    _Kind(NEEDLE, r"(R?NAV?)[ -]?(49)[ -]?(\d\d)", r"2?RSR?|XL|TN"),
    _Kind(NEEDLE_CAGE, r"(K) ?(\d+[X*]\d+[X*]\d+)(?:[ -]?TN)?", ""),
    _Kind(DEEP_GROOVE, r"(6[0234])[ -]?(\d\d)", rf"C(?![A-Z0-9])|{_SEALS}|NR?|{_CAGES}"),
    _Kind(ANGULAR, r"(7[023])[ -]?(\d\d)[ .-]?(AC|C|B)[ED]?(?:CB|[PMJY])?[PMJY]?", rf"{_SEALS}|NR?|{_CAGES}"),
    _Kind(
        TAPERED, r"(?:HR ?)?(302|303|313|320|322|323)[ -]?(\d\d)(?:[ -]?X)?", "J[2R]?|A|XL|Q|JR|DY|CL7[AC]"
    ),
)  # fmt: skip
_PATTERNS = tuple(
    (row.kind, re.compile(row.base + rf"((?:[ .,/-]*(?:{'|'.join(filter(None, (row.suffixes, _EVERY)))}))*)"))
    for row in _KINDS
)
_CLASS = re.compile(r"C([2-5NM])|P[2-6]([2-5])")


class Designation(NamedTuple):
    """A designation in its parts.

    Attributes
    ----------
    kind : str
        Kind of the bearing: one of those of this module.
    parts : tuple of str
        Type, series, bore code and suffix of the contact angle, as far as the kind has them.
    clearance : str
        Class of radial clearance, such as "C3"; empty where the designation has none. Several behind each other where
        it has several.
    """

    kind: str
    parts: tuple[str, ...]
    clearance: str

    @property
    def name(self) -> str:
        """Designation without blanks and suffixes, such as "NU210" or "K40x48x20"."""
        name = "".join(self.parts)
        return re.sub("[X*]", "x", name) if self.kind == NEEDLE_CAGE else name

    @property
    def text(self) -> str:
        """The same with its class of clearance, such as "NU210 C3"."""
        return f"{self.name} {self.clearance}".rstrip()


def read_designation(text: str) -> Designation | None:
    """The parts of a designation; None where it is of no kind that is served.

    Parameters
    ----------
    text : str
        Designation as it was typed.

    Examples
    --------
    >>> [read_designation(text).text for text in ("nu 308 ecp/C4", "6205-2RSH/C3", "6208 P63", "HR 32008 XJ")]
    ['NU308 C4', '6205 C3', '6208 C3', '32008']
    >>> read_designation("22208")
    """
    upper = text.strip().upper()
    for kind, pattern in _PATTERNS:
        if match := pattern.fullmatch(upper):
            *parts, suffixes = match.groups()
            classes = dict.fromkeys("C" + (own or behind) for own, behind in _CLASS.findall(suffixes))
            return Designation(kind, tuple(parts), " ".join(classes))
    return None


def bore_code(bore: float) -> str:
    """Bore code of a bore [mm].

    Examples
    --------
    >>> bore_code(40), bore_code(17)
    ('08', '03')
    """
    return {10: "00", 12: "01", 15: "02", 17: "03"}.get(int(bore), f"{int(bore) // 5:02d}")


def plain_name(text: str, kinds: tuple[str, ...]) -> str:
    """Designation without blanks and suffixes, where it is of some kinds; else empty.

    Parameters
    ----------
    text : str
        Designation as it was typed.
    kinds : tuple of str
        Kinds of this module.

    Examples
    --------
    >>> plain_name("7208 becbp", BALLS), plain_name("NU208", BALLS)
    ('7208B', '')
    """
    found = read_designation(text)
    return found.name if found is not None and found.kind in kinds else ""


@cache
def _tables() -> dict[str, dict[str, Any]]:
    """The file, read once."""
    text = (resources.files("ehdmaps.physics") / "shipped" / "catalogues.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def table(kind: str) -> dict[str, Any]:
    """Return tables of catalogues and standards of a kind of bearing, by their names; each is a list of rows.

    Parameters
    ----------
    kind : str
        cylindrical, balls, needles, tapered, or clearance.

    Examples
    --------
    >>> table("clearance")["balls"][0][:3]
    [10, 0, 7]
    """
    return _tables()[kind]

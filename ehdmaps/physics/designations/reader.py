"""Kind, plain name and class of radial clearance of a designation, for all kinds that are served; rows of catalogues.

Prefixes and suffixes of makers are told one by one, see `affixes`. Those of the radial clearance count: they stand for
themselves (C3), or behind a class of accuracy (P63); and those of rolling elements of silicon nitride.
"""

from __future__ import annotations

import re
import tomllib
from functools import cache
from importlib import resources
from typing import Any, NamedTuple

from ehdmaps.physics.designations.affixes import CLEARANCE, HYBRID, REFUSED, SET, Affix, prefix, suffixes

CYLINDRICAL, NEEDLE, NEEDLE_CAGE, DEEP_GROOVE, ANGULAR, TAPERED, DOUBLE_ROW, FOUR_POINT, SELF_ALIGNING, DRAWN_CUP = (
    "cylindrical roller bearing",
    "needle roller bearing",
    "needle cage",
    "deep groove ball bearing",
    "angular contact ball bearing",
    "tapered roller bearing",
    "double row angular contact ball bearing",
    "four-point contact ball bearing",
    "self-aligning ball bearing",
    "drawn cup needle roller bearing",
)
THRUST = "thrust ball bearing"
OF_ROWS = (DOUBLE_ROW, FOUR_POINT, SELF_ALIGNING, THRUST)
NEEDLES = (NEEDLE, NEEDLE_CAGE, DRAWN_CUP)
BALLS, ROLLERS = (DEEP_GROOVE, ANGULAR, *OF_ROWS), (CYLINDRICAL, *NEEDLES)


class _Kind(NamedTuple):
    """Designations of a kind without prefixes and suffixes, and where their suffixes stand, if not with the kind."""

    kind: str
    base: str
    suffixes: str = ""


_PRECISE, _FULL = "precise cylindrical roller bearing", "full complement cylindrical roller bearing"
_KINDS = (
    _Kind(CYLINDRICAL, r"(NUP|NU|NJ|N)[ -]*(22|23|2|3)[ -]?(\d\d)"),
    _Kind(CYLINDRICAL, r"(NUP|NU|NJ|N)[ -]*(10)[ -]?(\d\d)", _PRECISE),
    _Kind(CYLINDRICAL, r"(NCF)[ -]*(22)[ -]?(40)", "high capacity cylindrical roller bearing"),
    _Kind(CYLINDRICAL, r"(NCF)[ -]*(18|22(?![ -]?40)|29|30)[ -]?(\d\d)(?:[ -]?C?V)?", _FULL),
    _Kind(CYLINDRICAL, r"(NN)[ -]*(30)[ -]?(\d\d)", _PRECISE),
    _Kind(CYLINDRICAL, r"(NNU)[ -]*(49)[ -]?(\d\d)(?:[ -]?B)?", _PRECISE),
    _Kind(CYLINDRICAL, r"(NNCF)[ -]*(50)[ -]?(\d\d)(?:[ -]?C?V)?", _FULL),
    _Kind(NEEDLE, r"(R?NAV?)[ -]?(49)[ -]?(\d\d)"),
    _Kind(DRAWN_CUP, r"(HK)[ -]?(\d\d)[ -]?(\d\d)(?:[CF]|TN|TV)?"),
    _Kind(NEEDLE_CAGE, r"(K) ?(\d+[X*]\d+[X*]\d+)"),
    _Kind(DEEP_GROOVE, r"(618|619|160|6[023489])[ -]?(\d\d)"),
    _Kind(ANGULAR, r"(718|719|7[02389])[ -]?(\d\d)[ .-]?U?(A5|AC|AD|C|B|E)"),
    _Kind(DOUBLE_ROW, r"(32|33|52|53)[ -]?(\d\d)[ -]?(A|B)?"),
    _Kind(FOUR_POINT, r"(QJ)[ -]?(10|2|3)[ -]?(\d\d)"),
    _Kind(SELF_ALIGNING, r"(12|13|22|23)[ -]?(\d\d)"),
    _Kind(THRUST, r"(511|512|513|514)[ -]?(\d\d)"),
    _Kind(TAPERED, r"(302|303|313|320|322|323)[ -]?(\d\d)(?:[ -]?X(?!L))?"),
)
_PATTERNS = tuple((row, re.compile(rf"(.*?){row.base}(?![0-9])(.*)")) for row in _KINDS)
_CLASS = re.compile(r"C([2-5NM])|P[2-6]([2-5])")
_WITHIN = {"V": "full complement", "CV": "full complement", "X": "dimensions of ISO 355", "U": "design of NTN"}
"""Meanings of what stands within a designation and is no part of its name."""

_ISO_NAMES = {"68": "618", "69": "619", "78": "718", "79": "719", "52": "32", "53": "33"}
"""Series of makers, and their names by ISO."""

_OF_GMN = re.compile(r"^S ?6(0|2|18|19) ?(\d\d) ?([CE])(?![0-9])")
"""Spindle bearings of GMN: S 6014 C is a 7014C, E has 25 degrees."""

MAKER = re.compile(r"^(SKF|SNFA|FAG|INA|Schaeffler|NSK|NTN|SNR|Koyo|JTEKT|Nachi|Timken|GMN)[ -]+(?=.)", re.IGNORECASE)
"""Name of a maker before a designation, which decides nothing."""

_OF_SPINDLES = ("B", "HCB", "XCB")
"""Prefixes of a maker whose suffix E is an angle of 25 degrees."""


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
    affixes : tuple of Affix
        What stands before and behind it.
    """

    kind: str
    parts: tuple[str, ...]
    clearance: str
    affixes: tuple[Affix, ...] = ()

    @property
    def name(self) -> str:
        """Designation without blanks and suffixes, such as "NU210" or "K40x48x20"; HC behind it for hybrid bearings."""
        name = re.sub("[X*]", "x", self._plain) if self.kind == NEEDLE_CAGE else self._plain
        return name + HC * self.hybrid + " " * bool(self.matched) + self.matched

    @property
    def text(self) -> str:
        """The same with its class of clearance, such as "NU210 C3"."""
        return f"{self.name} {self.clearance}".rstrip()

    @property
    def matched(self) -> str:
        """Arrangement and class of preload of a set of bearings, such as "DBL"; empty for one bearing."""
        return " ".join(one.text for one in self.affixes if one.effect == SET)

    @property
    def hybrid(self) -> bool:
        """True where its rolling elements are of silicon nitride."""
        return any(one.effect == HYBRID for one in self.affixes)

    @property
    def words(self) -> str:
        """Meaning of each part."""
        return "; ".join((f"{self._plain}: {self.kind}", *(one.words for one in self.affixes)))

    @property
    def single(self) -> str:
        """Designation of one bearing of a set, without its class of clearance."""
        return self._plain + HC * self.hybrid

    @property
    def _plain(self) -> str:
        """Its parts, as far as it has them."""
        return "".join(part or "" for part in self.parts)


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
    >>> [read_designation(text).text for text in ("B7005-C-T-P4S", "7014 CD/HCP4A", "HCB7014-E-T-P4S", "S 61914 C TA")]
    ['7005C', '7014C HC', '7014AC HC', '71914C']
    >>> read_designation("22208")
    """
    maker, rest = MAKER.match(text.strip()), MAKER.sub("", text.strip())
    upper = _OF_GMN.sub(r"B7\1\2\3", rest.upper())
    if len(upper) > _LONGEST:
        return None
    for row, pattern in _PATTERNS:
        kind, match = row.kind, pattern.fullmatch(upper)
        if match is None:
            continue
        before, *parts, behind = match.groups()
        inside = re.sub("[ .-]", "", upper[len(before) : len(upper) - len(behind)])
        for part in parts:
            inside = inside.replace(part or "", "", 1)
        first, last = prefix(before, kind) if before else None, suffixes(behind, row.suffixes or kind)
        if last is None or (before and first is None):
            continue
        if kind == ANGULAR:
            others = first is None or first.effect != REFUSED
            if parts[2] == "E" and before.strip(" -") not in _OF_SPINDLES and others:
                continue
            parts[2] = {"E": "AC", "A5": "AC", "AD": "AC"}.get(parts[2], parts[2])
        if kind in BALLS:  # names of makers, and those of ISO
            parts[0] = _ISO_NAMES.get(parts[0], parts[0])
        within = [Affix(inside, _WITHIN[inside], "")] if inside in _WITHIN else []
        whose = [Affix(maker[1], "name of the maker", "")] if maker else []
        affixes = (*whose, *([first] if first else []), *within, *last)
        named = [one.text for one in affixes if one.effect == CLEARANCE]
        classes = dict.fromkeys(
            "C" + "".join(found.groups("")) if (found := _CLASS.fullmatch(one)) else one for one in named
        )
        return Designation(kind, tuple(parts), " ".join(classes), affixes)
    return None


_LONGEST = 60
HC = " HC"
"""End of the names of bearings with balls of silicon nitride."""


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

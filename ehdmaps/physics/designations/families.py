"""Kinds of bearings that are known and not served, in words; and balls where lines are asked for."""

from __future__ import annotations

import re
from collections.abc import Iterable

from ehdmaps.errors import InputError, closest, short
from ehdmaps.physics.designations.reader import BALLS, MAKER, ROLLERS, TAPERED, plain_name

SERVED = (
    "deep groove balls 618, 619, 160, 60, 62, 63, 64; angular contact balls 718, 719, 70, 72, 73, two rows 32, 33, "
    "four-point QJ, self-aligning 12, 13, 22, 23, thrust balls 511 to 514; cylindrical rollers N, NU, NJ, NUP of 10, "
    "2, 22, 3, 23, NCF of 18, 22, 29, 30, two rows NN30, NNU49, NNCF50; needles K, NA49, HK; tapered rollers 302, 303, "
    "313, 320, 322, 323"
)
"""Kinds and series that are served, in words."""

_TAIL = r"(?![0-9])[A-Z0-9 /,.+-]*"
"""Suffixes of any kind."""

_FAMILIES = tuple(
    (re.compile(pattern + _TAIL), words)
    for pattern, words in (
        (r"(?:BS2-22|(?:WS)?2(?:[1-3]3|[23][0-2]|38|39|40|41))[ -]?(?:\d\d|/\d{3,4})", "spherical roller bearing"),
        (r"(?:292|293|294)[ -]?(?:\d\d|/\d{3,4})", "spherical roller thrust bearing"),
        (r"(?:NUTR|NUKR|NATR|NATV|PWT?R|PWKR|KRV?E?|R?STO|LRB?|CFE?|RNA22|NA22)[ -]?\d[\d./-]*", "track roller"),
        (r"T[1-7][A-G][B-E][ -]?\d{3}", "tapered roller bearing of another series"),
        (r"C[ -]?(?:22|23|30|31|32|39|40|41|49|50|59|60|69)[ -]?\d\d", "toroidal roller bearing"),
        (r"(?:112|113)[ -]?\d\d|1(?:08|26|27|29|35)", "self-aligning ball bearing of another series"),
        (r"(?:532|533|534|542|543|544)[ -]?\d\d", "thrust ball bearing with a spherical washer"),
        (r"(?:522|523|524)[ -]?\d\d", "thrust ball bearing of two directions"),
        (r"(?:811|812|893|894|874)[ -]?\d\d", "cylindrical roller thrust bearing"),
        (r"(?:AXK|AXW|AS|LS|AXZ) ?\d{4,}", "needle roller thrust bearing"),
        (r"(?:2344|2347|7602|7603|BSA|BSB|BSD|ZKLN|ZKLF|BTW|BTM)[ -]?\d*", "angular contact thrust ball bearing"),
        (r"(?:30|38|39)[ -]?\d\d", "double row angular contact ball bearing of another series"),
        (r"(?:42|43)[ -]?\d\d", "double row deep groove ball bearing"),
        (r"QJF[ -]?\d{3,4}", "four-point contact ball bearing"),
        (r"(?:NNU?|NNTR?)[ -]?\d{4,5}", "double row cylindrical roller bearing"),
        (r"(?:NNCF?|NNCL|NNF|NCF|NCL|NJG|NJF|SL|E(?=50))[ -]?\d{4,6}", "full complement cylindrical roller bearing"),
        (r"(?:RNU|RN|NF|NP|NH|NUH|NUB|NJP|NUJ|NFP)[ -]?\d{3,4}", "cylindrical roller bearing of another type"),
        (r"(?:BK|HN|RHNA?)[ -]?\d{4}", "drawn cup needle roller bearing"),
        (r"(?:NKI[ABS]?|NKS|NKXR?|NK|NXZ?|R?NAO|NAX[IRK]*)[ -]?\d[\dX*/-]*", "needle roller bearing of another type"),
        (r"R?NA[ -]?(?:48|69)[ -]?\d\d", "needle roller bearing of another series"),
        (r"(?:329|330|331|332|318|319|307|308|321|324)[ -]?\d\d", "tapered roller bearing of another series"),
        (r"(?:617|161|622|623|630|638|639)[ -]?\d\d?", "deep groove ball bearing of another series"),
        (r"67[ -]?\d\d", "deep groove ball bearing of another series"),
        (r"(?:6[0-3]|6[89])\d", "miniature deep groove ball bearing"),
        (r"(?:HCB|HSS?|XCB|B)?(?:708|709)[ -]?\d\d", "angular contact ball bearing of another series"),
        (r"(?:BNR|BER|BNC|BAR|BTR|BGR|\d\d(?:BNR|BER|BAR|BTR))[ -]?\d\d", "high speed angular contact ball bearing"),
        (r"(?:KH|SM|HYS?|HYKH|HYSM) ?6\d{3,4}", "high speed angular contact ball bearing"),
        (r"(?:JL?M?|LM?|HM|HH|EE|M)\d{5,6}(?:/(?:JL?M?|LM?|HM|HH|EE|M)\d{5,6})?", "tapered roller bearing in inches"),
        (r"(?:UCP?|UK|YAR|YET|YEL|SA|SB|ES?)[ -]?2\d\d", "insert ball bearing"),
        (r"(?:XSU|XU|XR|RB|RA|CRB[CHT]?|RU)[ -]?\d{3,}", "crossed roller bearing"),
    )
)  # fmt: skip


_ALL = (*BALLS, *ROLLERS, TAPERED)
_LONGEST = 60
_FILE = re.compile(r"\.[a-z]{2,}")
_NO_ANGLE = re.compile(r"(?:HC?B?|XCB|B)?7(?:1?[89]|[023]) ?\d\d" + _TAIL)


def not_served(text: str) -> str:
    """Words for a designation of a kind that is not served, beginning with "got"; empty for all other texts.

    Parameters
    ----------
    text : str
        What was typed.

    Examples
    --------
    >>> not_served("22208 E/C3")[:51], not_served("NU208"), not_served("housing")
    ("got '22208 E/C3', spherical roller bearing: not yet", '', '')
    """
    typed, plain = text.strip(), MAKER.sub("", text.strip())
    if len(typed) > _LONGEST or _FILE.search(typed.lower()) or plain_name(typed, _ALL):
        return ""
    upper = plain.upper()
    if _NO_ANGLE.fullmatch(upper):
        name = upper[:5].replace(" ", "")[:4]
        return (
            f"got {typed!r}, angular contact ball bearing without its contact angle; allowed: {name}C (15 degrees), "
            f"{name}AC (25), {name}B (40)"
        )
    words = next((words for pattern, words in _FAMILIES if pattern.fullmatch(upper)), "")
    return f"got {typed!r}, {words}: not yet; served are {SERVED}" if words else ""


def words_for_lines(text: str) -> str:
    """Words for a designation that was given where only line contacts are; empty for all other texts.

    Parameters
    ----------
    text : str
        What was typed.

    Examples
    --------
    >>> words_for_lines("NU208"), words_for_lines("6208-2RS")[:20]
    ('', '6208 is a ball beari')
    """
    name = plain_name(text, BALLS)
    if not name:
        return not_served(text)
    return (
        f"{name} is a ball bearing: its contacts are points, and this is for line contacts; take "
        f"`ehdmaps generate {name}` for a map of points, `ehdmaps solve {name}` for one, "
        f"`mbs bearing {name} --law films` for the bearing"
    )


def nearest(designation: str, known: Iterable[str]) -> str:
    """Say ' (did you mean ...?)' where a designation that is known is close and of the same type; else nothing.

    Parameters
    ----------
    designation : str
        Designation as it was typed.
    known : iterable of str
        Designations that are known.

    Examples
    --------
    >>> nearest("nu2O8", ("NU208", "NJ208")), nearest("KR22", ("HK2220", "NU222"))
    (" (did you mean 'NU208'?)", '')
    """
    text = MAKER.sub("", designation.strip()).upper()
    return closest(text, tuple(name for name in known if _type(name) == _type(text)))


def _type(name: str) -> str:
    """Letters at the beginning of a designation; of one without letters its first figure."""
    return re.match("[A-Z]+|.?", name).group()  # type: ignore[union-attr]


def not_known(designation: str, kind: str, known: Iterable[str], allowed: str, words: str = "") -> InputError:
    """The error of a designation that a catalogue does not have.

    Parameters
    ----------
    designation : str
        Designation as it was typed.
    kind : str
        Kind of the catalogue, in words.
    known : iterable of str
        Designations that it has.
    allowed : str
        What is allowed, in words.
    words : str
        What is known of the designation, in place of what it says here of kinds that are not served.
    """
    if words := words or not_served(designation):
        return InputError(f"bearing designation: {words}")
    near = nearest(designation, known)
    return InputError(f"{kind} designation: got {short(designation)}{near}; allowed: {allowed}")

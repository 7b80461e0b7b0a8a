"""Parts of an estimated inner geometry: how far each may be off, by the words in which the estimate says so.

These words are what scenes, jobs and map files keep of an estimate, see `ERRORS` of the catalogues of each kind.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

_PERCENT = re.compile(r"(roller diameter|roller length|row distance|ball diameter|pitch diameter) (?:to )?(\d+) %")
_RACEWAYS = re.compile(r"raceways to about (\d+) %")
_ANGLE = re.compile(r"contact angle to ([\d.]+) deg")
_GROOVES = re.compile(r"(inner |outer |)groove radi(?:i|us) ([\d.]+) to ([\d.]+)")
_GROOVE_WORDS = re.compile(r"groove radii ([\d.]+ to [\d.]+ of it)(?: \([^)]*\))?")
_COUNT = re.compile(r"number of (rollers|balls) \+-(\d+)")
_EVEN = ("roller diameter",)
"""Parts whose effect on stiffness and damping is even, to 2 %: one end tells the other; so are raceways and angles."""


class Part(NamedTuple):
    """Part of a geometry that may be off.

    Attributes
    ----------
    name : str
        What it is, such as "roller diameter".
    held : str
        How far it may be off, such as "+-12 %".
    ends : tuple of dict
        Fields of the geometry and their values at both ends [m], [rad], [1].
    even : bool
        Whether one end tells the other, with the opposite sign.
    """

    name: str
    held: str
    ends: tuple[dict[str, Any], dict[str, Any]]
    even: bool = False


def estimated_parts(geometry: Any, share: float = 1.0) -> Iterator[Part]:
    """Parts that an estimated geometry says may be off; none of one that is known.

    Parameters
    ----------
    geometry : BearingGeometry, BallGeometry, TaperedGeometry or RibbedGeometry
        The geometry.
    share : float
        Part of its own errors that is taken.

    Examples
    --------
    >>> from ehdmaps.physics.catalogue import estimate
    >>> [(part.name, part.held) for part in estimated_parts(estimate("NU206", 39e3))]
    [('raceways', '+-3 %'), ('roller diameter', '+-12 %'), ('roller length', '+-6 %'), ('roller count', '13 +-1')]
    """
    words: str = geometry.estimated or ""
    if found := _RACEWAYS.search(words):
        size = share * float(found[1]) / 100.0
        yield Part("raceways", f"+-{100.0 * size:.3g} %", (_wider(geometry, size), _wider(geometry, -size)), True)
    if found := _ANGLE.search(words):
        angle = share * float(found[1])
        ends = tuple({"contact_angle": geometry.contact_angle + math.radians(by)} for by in (angle, -angle))
        yield Part("contact angle", f"+-{angle:.3g} deg", (ends[0], ends[1]), True)
    for name, percent in _PERCENT.findall(words):
        key, size = name.replace(" ", "_"), share * float(percent) / 100.0
        above, below = ({key: getattr(geometry, key) * (1.0 + sign * size)} for sign in (1.0, -1.0))
        yield Part(name, f"+-{100.0 * size:.3g} %", (above, below), name in _EVEN)
    if found := _GROOVES.search(words):
        low_end, high_end = found[2], found[3]
        for side in (found[1].strip(),) if found[1] else ("inner", "outer"):
            key = f"{side}_conformity"
            value = getattr(geometry, key)
            low, high = (value + share * (float(end) - value) for end in (low_end, high_end))
            yield Part(f"{side} groove", f"{low:.4g} to {high:.4g} of the ball", ({key: low}, {key: high}))
    if found := _COUNT.search(words):
        key, most = found[1], int(found[2])
        count = getattr(geometry, key)
        yield Part(f"{key[:-1]} count", f"{count} +-{most}", ({key: count - most}, {key: count + most}))


def without_parts(words: str, known: Iterable[str]) -> str:
    """Words of an estimate of balls without parts that are known; empty where none is left.

    Parameters
    ----------
    words : str
        The words.
    known : iterable of str
        Fields that are known.

    Examples
    --------
    >>> from ehdmaps.physics.point.ball_catalogue import ball_estimate
    >>> without_parts(ball_estimate("6208").estimated, ["balls", "inner_conformity", "ball_diameter"])[-72:]
    '(ISO 76): pitch diameter to 2 %, outer groove radius 0.515 to 0.53 of it'
    """
    known = set(known)
    head, _, tail = words.rpartition(": ")
    open_sides = [side for side in ("inner", "outer") if f"{side}_conformity" not in known]
    left = {0: "", 1: f"{open_sides[0] if open_sides else ''} groove radius \\1"}.get(len(open_sides))
    if left is not None:
        tail = _GROOVE_WORDS.sub(left, tail)
    parts = [part.strip() for part in tail.split(", ")]
    gone = {"pitch_diameter": "pitch diameter", "ball_diameter": "ball diameter", "balls": "number of balls"}
    gone_words = [text for key, text in gone.items() if key in known]
    kept = [part for part in parts if part and not part.startswith(tuple(gone_words) or ("\0",))]
    return f"{head}: {', '.join(kept)}" if kept else ""


def _wider(geometry: Any, part: float) -> dict[str, float]:
    """Both raceways wider by a part of the inner one, the gap between them as it is; or the pitch circle wider."""
    if not hasattr(geometry, "inner_raceway_diameter"):
        return {"pitch_diameter": geometry.pitch_diameter * (1.0 + part)}
    inner, outer = geometry.inner_raceway_diameter, geometry.outer_raceway_diameter
    return {"inner_raceway_diameter": inner * (1.0 + part), "outer_raceway_diameter": outer + inner * part}

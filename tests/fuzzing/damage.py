"""Ways to damage good files, by a source of chance: text as text, other files as bytes.

Each way is a function of the content, the source of chance and another content of the same kind; `damage` takes one to
three of them in turn.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np

Way = Callable[[bytes, np.random.Generator, bytes], bytes]
Parts = TypeVar("Parts", bytes, list[bytes])

NUMBERS = (
    *("nan", "inf", "-inf", "1e999", "-1e999", "1e-999", "-0", "0", "-1", "1e308", "5e-324", "0.1", "2.5", "3"),
    *("2147483648", "9223372036854775808", "9" * 400, "1_000", "0x10", "1e", "--1", "1,5", "\u0663", "1e5j", "True"),
)
"""Texts that take the place of a number: no numbers, too large, too small, of other writing, of other meaning."""

UNITS = (
    *("mm", "um", "km", "N", "N/mm", "MPa", "GPa", "1/GPa", "degC", "K", "m/s", "rpm", "Hz", "s", "kg", "furlong", ""),
)

STRANGE = (
    *(b"\xef\xbb\xbf", b"\x00", b"\xff\xfe", b"\xed\xa0\x80", b"\x1b[2J", b"\r", b"\x85", b"\x0c", b"\x1a"),
    *(text.encode() for text in ("\u202e", "\u2028", "\u00a0", "\u0661", "\uff11", "e\u0301", "\U0001f600", "\u2212")),
)
"""Marks of byte order, zeros, escapes, ends of lines, what no UTF-8 is, and letters that look like others."""

SIZES = (0, 1, 0x7F, 0x80, 0xFFFF, 2**31 - 1, 2**31, 2**32 - 1, 2**40, 2**63 - 1, 2**63, 2**64 - 1)
"""Numbers that take the place of sizes and addresses in binary files."""

LONGEST_LINE = 200_000
DEEPEST = 5000
LARGEST = 4_000_000
"""Bytes that no damage goes beyond: what a reader makes of a small file is asked, not whether a disk is large."""

_MEANINGS = ("another number", "scaled number", "swapped numbers", "another unit", "line lost", "line twice")
"""Ways that mostly leave a file readable, so that what is read is looked at: they are taken more often."""

_NUMBER = re.compile(rb"[-+]?[0-9]+[.]?[0-9]*(?:[eE][-+]?[0-9]+)?")
_BEGIN = re.compile(rb"(?m)^.")
_UNIT = re.compile(rb"(?<=[0-9] )[A-Za-z][A-Za-z0-9/^ *]*(?=\")")


class Damaged(NamedTuple):
    """A content, and how it came about."""

    how: str
    content: bytes


def damage(content: bytes, text: bool, rng: np.random.Generator, other: bytes) -> Damaged:
    """Damage a file.

    Parameters
    ----------
    content : bytes
        What is in it.
    text : bool
        Whether it is text, of numbers and keys in lines.
    rng : numpy.random.Generator
        Source of chance.
    other : bytes
        Another content of the same kind, of which parts are taken.
    """
    ways = TEXT_WAYS if text else BINARY_WAYS
    # Mostly a single damage: what comes after two or three is often no file of the kind any more.
    drawn = [name for name in ways for _ in range(3 if name in _MEANINGS else 1)]
    names = [str(name) for name in rng.choice(drawn, size=int(rng.choice((1, 1, 1, 2, 2, 3))))]
    for name in names:
        content = ways[name](content, rng, other)[:LARGEST]
    return Damaged(" + ".join(names), content)


def _place(parts: Sequence[Any], rng: np.random.Generator) -> int:
    """Somewhere between the bytes, or the lines."""
    return int(rng.integers(len(parts) + 1))


def _span(parts: Parts, rng: np.random.Generator) -> tuple[int, int]:
    """Begin and end of a part of a file: a line; or some hundred bytes, or all from or up to a place."""
    begin, most = _place(parts, rng), len(parts)
    if isinstance(parts, list):
        return begin, begin + 1
    end = min(most, begin + int(rng.integers(1, 401)))
    return ((begin, end), (begin, end), (begin, most), (0, end))[rng.integers(4)]


def _lost(parts: Parts, rng: np.random.Generator, other: Parts) -> Parts:
    """A part lost."""
    begin, end = _span(parts, rng)
    return parts[:begin] + parts[end:]


def _twice(parts: Parts, rng: np.random.Generator, other: Parts) -> Parts:
    """A part twice, one after the other."""
    begin, end = _span(parts, rng)
    return parts[:end] + parts[begin:end] + parts[end:]


def _grafted(parts: Parts, rng: np.random.Generator, other: Parts) -> Parts:
    """A part of another file put in, or in the place of the rest."""
    begin, end = _span(other, rng)
    place = _place(parts, rng)
    return parts[:place] + other[begin:end] + (parts[place:] if rng.random() < 0.7 else parts[:0])


def _moved(parts: Parts, rng: np.random.Generator, other: Parts) -> Parts:
    """A part that takes the place of another one."""
    begin, end = _span(parts, rng)
    place = _place(parts, rng)
    return parts[:place] + parts[begin:end] + parts[place + end - begin :]


_PARTS: Mapping[str, Callable[..., Any]] = {"lost": _lost, "twice": _twice, "grafted": _grafted, "moved": _moved}
"""What happens to a part of a file: to bytes, or to lines."""


def _of_lines(way: Callable[..., list[bytes]]) -> Way:
    """The same of lines."""
    return lambda content, rng, other: b"".join(way(content.splitlines(True), rng, other.splitlines(True)))


def _put(choose: Callable[[np.random.Generator], bytes], over: bool = False) -> Way:
    """Something put in at a place, or over what stands there."""

    def put(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
        place, new = _place(content, rng) if rng.random() < 0.9 else 0, choose(rng)
        return content[:place] + new + content[place + over * len(new) :]

    return put


def _changed(change: Callable[[int, np.random.Generator], int]) -> Way:
    """Some bytes changed."""

    def changed(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
        new = bytearray(content)
        for place in rng.integers(len(new), size=int(rng.integers(1, 9))) if content else ():
            new[place] = change(new[place], rng)
        return bytes(new)

    return changed


def _rewritten(pattern: re.Pattern[bytes], choose: Callable[[list[bytes], bytes, np.random.Generator], bytes]) -> Way:
    """One of the places that fit a pattern rewritten, by all that fit it and what stands there."""

    def rewritten(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
        found = list(pattern.finditer(content))
        if not found:
            return content
        one = found[rng.integers(len(found))]
        return content[: one.start()] + choose([each[0] for each in found], one[0], rng) + content[one.end() :]

    return rewritten


def _one_of(texts: Sequence[str]) -> Callable[[list[bytes], bytes, np.random.Generator], bytes]:
    """One of some texts, whatever stands there."""
    return lambda found, old, rng: texts[int(rng.integers(len(texts)))].encode()


def _scaled(found: list[bytes], old: bytes, rng: np.random.Generator) -> bytes:
    """A number times a power of ten, or minus that."""
    return repr(float(old) * 10.0 ** float(rng.integers(-9, 10)) * float(rng.choice((1.0, -1.0)))).encode()


def _size(rng: np.random.Generator) -> bytes:
    """A number such as takes the place of a size or address."""
    length = int(rng.choice((2, 4, 8)))
    return (SIZES[rng.integers(len(SIZES))] % (1 << (8 * length))).to_bytes(
        length, "little" if rng.random() < 0.7 else "big"
    )


_FILLERS = (b"9", b" ", b"a", b"0.", b"1 ", b"\\", b'"', b"1,")
_OPENINGS = (b"[", b"{a = ", b"a.", b"[[", b"(", b"{", b"[a.")
_ENDS = (b"\r\n", b"\r", b"\n\n", b"")
_ENCODINGS = ("utf-16", "utf-16-be", "utf-32", "utf-7")

_ALL: Mapping[str, Way] = {
    "bits flipped": _changed(lambda old, rng: old ^ 1 << int(rng.integers(8))),
    "bytes set": _changed(lambda old, rng: int(rng.integers(256))),
    **{f"part {name}": way for name, way in _PARTS.items()},
    "emptied": lambda content, rng, other: content[: int(rng.integers(3))],
}

TEXT_WAYS: Mapping[str, Way] = {
    **_ALL,
    **{f"line {name}": _of_lines(way) for name, way in _PARTS.items()},
    "another number": _rewritten(_NUMBER, _one_of(NUMBERS)),
    "scaled number": _rewritten(_NUMBER, _scaled),
    "swapped numbers": _rewritten(_NUMBER, lambda found, old, rng: found[rng.integers(len(found))]),
    "another unit": _rewritten(_UNIT, _one_of(UNITS)),
    "renamed": _rewritten(_BEGIN, lambda found, old, rng: b"" if rng.random() < 0.5 else 2 * old),
    "strange letters": _put(lambda rng: STRANGE[rng.integers(len(STRANGE))] * int(rng.integers(1, 4))),
    "long line": _put(lambda rng: _FILLERS[rng.integers(8)] * int(rng.integers(1, LONGEST_LINE // 2))),
    "nested": _put(lambda rng: _OPENINGS[rng.integers(7)] * int(rng.integers(1, DEEPEST))),
    "line ends": lambda content, rng, other: content.replace(b"\n", _ENDS[rng.integers(4)]),
    "wide letters": lambda content, rng, other: content.decode("utf-8", "replace").encode(_ENCODINGS[rng.integers(4)]),
}
BINARY_WAYS: Mapping[str, Way] = {
    **_ALL,
    "flooded": _put(lambda rng: (b"\x00", b"\xff")[rng.integers(2)] * int(rng.integers(1, 401)), over=True),
    "size": _put(_size, over=True),
}

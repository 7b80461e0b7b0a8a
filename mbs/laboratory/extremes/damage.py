"""Ways to damage good files, by a source of chance: text as text, other files as bytes.

Each way is a function of the content, the source of chance and another content of the same kind; `damage` takes one to
three of them in turn.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

Way = Callable[[bytes, np.random.Generator, bytes], bytes]

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


def _place(content: bytes, rng: np.random.Generator) -> int:
    """Draw a place, the end included."""
    return int(rng.integers(len(content) + 1))


def _part(content: bytes, rng: np.random.Generator, longest: int = 400) -> tuple[int, int]:
    """Begin and end of a part."""
    begin = _place(content, rng)
    return begin, min(len(content), begin + int(rng.integers(1, longest + 1)))


def _changed(content: bytes, rng: np.random.Generator, change: Callable[[int], int]) -> bytes:
    """Change some bytes."""
    changed = bytearray(content)
    for place in rng.integers(len(changed), size=int(rng.integers(1, 9))) if content else ():
        changed[place] = change(changed[place])
    return bytes(changed)


def _cut_out(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """A part is lost."""
    begin, end = _part(content, rng)
    return content[:begin] + content[end:]


def _twice(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """A part stands there twice; now and then the whole."""
    if rng.random() < 0.1:
        return content + content
    begin, end = _part(content, rng)
    return content[:end] + content[begin:end] + content[end:]


def _grafted(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """A part of another file."""
    begin, end = _part(other, rng)
    place = _place(content, rng)
    return content[:place] + other[begin:end] + content[place:]


def _moved(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """A part over another place of the same file."""
    begin, end = _part(content, rng)
    place = _place(content, rng)
    return content[:place] + content[begin:end] + content[place + end - begin :]


def _flooded(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """A part all zeros, or all ones."""
    begin, end = _part(content, rng)
    return content[:begin] + (b"\x00", b"\xff")[int(rng.integers(2))] * (end - begin) + content[end:]


def _sized(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """A number of 2, 4 or 8 bytes that may be a size or an address."""
    length = int(rng.choice((2, 4, 8)))
    size = int(SIZES[rng.integers(len(SIZES))]) % (1 << (8 * length))
    number = size.to_bytes(length, "little" if rng.random() < 0.7 else "big")
    place = _place(content, rng)
    return content[:place] + number + content[place + length :]


def _rewritten(
    content: bytes, pattern: re.Pattern[bytes], rng: np.random.Generator, new: Callable[[bytes], str]
) -> bytes:
    """Another text in one of the places that a pattern finds; nothing where there is none."""
    places = list(pattern.finditer(content))
    if not places:
        return content
    chosen = places[rng.integers(len(places))]
    return content[: chosen.start()] + new(chosen[0]).encode() + content[chosen.end() :]


def _swapped_numbers(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """A number in the place of another."""
    numbers = list(_NUMBER.finditer(content))
    if len(numbers) < 2:
        return content
    first, second = (numbers[int(index)] for index in rng.integers(len(numbers), size=2))
    return content[: first.start()] + content[second.start() : second.end()] + content[first.end() :]


def _lines(content: bytes, rng: np.random.Generator) -> tuple[list[bytes], int]:
    """Lines with their ends, and the number of one of them."""
    lines = content.splitlines(keepends=True) or [b""]
    return lines, int(rng.integers(len(lines)))


def _line_lost(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """A line is lost, a key with its value in most files."""
    lines, number = _lines(content, rng)
    return b"".join(lines[:number] + lines[number + 1 :])


def _line_twice(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """A line stands at another place, too."""
    lines, number = _lines(content, rng)
    lines.insert(int(rng.integers(len(lines) + 1)), lines[number])
    return b"".join(lines)


def _foreign_line(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """A line of another file."""
    lines, number = _lines(content, rng)
    others, chosen = _lines(other, rng)
    lines.insert(number, others[chosen])
    return b"".join(lines)


def _renamed(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """A letter of a word at the beginning of a line is lost."""
    lines, number = _lines(content, rng)
    line = lines[number]
    lines[number] = line[1:] if rng.random() < 0.5 else line[:1] + line
    return b"".join(lines)


def _strange(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """Strange letters."""
    place = _place(content, rng) if rng.random() < 0.8 else 0
    return content[:place] + STRANGE[rng.integers(len(STRANGE))] * int(rng.integers(1, 4)) + content[place:]


def _long_line(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """A line without an end."""
    place = _place(content, rng)
    filler = (b"9", b" ", b"a", b"0.", b"1 ", b"\\", b'"', b"1,")[rng.integers(8)]
    return content[:place] + filler * int(rng.integers(1, LONGEST_LINE // len(filler))) + content[place:]


def _nested(content: bytes, rng: np.random.Generator, other: bytes) -> bytes:
    """Brackets within brackets."""
    place = _place(content, rng)
    opening = (b"[", b"{a = ", b"a.", b"[[", b"(", b"{", b"[a.")[rng.integers(7)]
    return content[:place] + opening * int(rng.integers(1, DEEPEST)) + content[place:]


_ENCODINGS = ("utf-16", "utf-16-be", "utf-32", "utf-7")

_ALL: Mapping[str, Way] = {
    "bits flipped": lambda content, rng, other: _changed(content, rng, lambda old: old ^ 1 << int(rng.integers(8))),
    "bytes set": lambda content, rng, other: _changed(content, rng, lambda old: int(rng.integers(256))),
    "cut off": lambda content, rng, other: content[: _place(content, rng)],
    "beginning lost": lambda content, rng, other: content[_place(content, rng) :],
    "part lost": _cut_out,
    "part twice": _twice,
    "spliced": lambda content, rng, other: content[: _place(content, rng)] + other[_place(other, rng) :],
    "grafted": _grafted,
    "moved": _moved,
    "emptied": lambda content, rng, other: content[: int(rng.integers(3))],
}

TEXT_WAYS: Mapping[str, Way] = {
    **_ALL,
    "another number": lambda content, rng, other: _rewritten(
        content, _NUMBER, rng, lambda old: NUMBERS[rng.integers(len(NUMBERS))]
    ),
    # off by powers of ten, or of the other sign
    "scaled number": lambda content, rng, other: _rewritten(
        content,
        _NUMBER,
        rng,
        lambda old: repr(float(old) * 10.0 ** float(rng.integers(-9, 10)) * float(rng.choice((1.0, -1.0)))),
    ),
    "swapped numbers": _swapped_numbers,
    "another unit": lambda content, rng, other: _rewritten(
        content, _UNIT, rng, lambda old: UNITS[rng.integers(len(UNITS))]
    ),
    "line lost": _line_lost,
    "line twice": _line_twice,
    "foreign line": _foreign_line,
    "renamed": _renamed,
    "strange letters": _strange,
    "long line": _long_line,
    "nested": _nested,
    "line ends": lambda content, rng, other: content.replace(b"\n", (b"\r\n", b"\r", b"\n\n", b"")[rng.integers(4)]),
    "wide letters": lambda content, rng, other: content.decode("utf-8", "replace").encode(_ENCODINGS[rng.integers(4)]),
}

BINARY_WAYS: Mapping[str, Way] = {**_ALL, "flooded": _flooded, "size": _sized}

"""The whole document: escaped markup, tables, head, style, script, sections, and the rule that nothing is loaded."""

from __future__ import annotations

import base64
import hashlib
import html
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

from ehdmaps.errors import InputError
from ehdmaps.outputs import MARK, Kind, has_mark, write_text

_LINES = "\n\t"
_NAMES = {"class_": "class", "for_": "for"}
_VOID = frozenset({"meta", "br", "hr", "input"})


class Markup(str):
    """A text that is markup already, made by `tag` and `joined` alone."""

    __slots__ = ()


Child = str | Markup | None
"""What a tag may contain; None is left out."""


def escaped(text: str) -> Markup:
    r"""Return a text as a browser shows it, letter by letter.

    Characters that cannot be printed, such as control characters and those that turn the direction of writing around,
    become U+FFFD; ends of lines and tabs stay.

    Parameters
    ----------
    text : str
        Any text; markup stays as it is.

    Examples
    --------
    >>> escaped("<b> & \x07'")
    '&lt;b&gt; &amp; \ufffd&#x27;'
    """
    if isinstance(text, Markup):
        return text
    shown = "".join(letter if letter.isprintable() or letter in _LINES else "\ufffd" for letter in text)
    return Markup(html.escape(shown))


def joined(*children: Child) -> Markup:
    """Return markup and texts one after the other.

    Parameters
    ----------
    *children : str or Markup or None
        Texts are escaped.
    """
    return Markup("".join(escaped(child) for child in children if child is not None))


def tag(element: str, /, *children: Child, **attributes: str | float | None) -> Markup:
    """Return an element.

    Parameters
    ----------
    element : str
        Name of the element.
    *children : str or Markup or None
        What it contains; texts are escaped.
    **attributes : str or float or None
        Attributes of the element; underscores in names become hyphens, numbers have four digits, None leaves one out.

    Examples
    --------
    >>> tag("p", "a < b", tag("b", "!"), class_="note")
    '<p class="note">a &lt; b<b>!</b></p>'
    """
    words = [element]
    for key, value in attributes.items():
        if value is not None:
            text = value if isinstance(value, str) else f"{value:.4g}"
            words.append(f'{_NAMES.get(key, key.replace("_", "-"))}="{escaped(text)}"')
    head = f"<{' '.join(words)}>"
    return Markup(head if element in _VOID else f"{head}{joined(*children)}</{element}>")


def table(heads: Sequence[Child], rows: Iterable[Sequence[Child]], caption: str, texts: Sequence[int] = (0,)) -> Markup:
    """Return a table.

    Parameters
    ----------
    heads : sequence of str
        Heads of the columns, with units.
    rows : iterable of sequence of str
        One text a column; the first names the row.
    caption : str
        What the table holds.
    texts : sequence of int
        Columns of text; the others hold numbers, which stand to the right.
    """

    def cell(name: str, index: int, child: Child, **more: str) -> Markup:
        # a number alone is not broken at its sign
        kind = "number" if " " in str(child) else "number one"
        return tag(name, child, class_=None if index in texts else kind, **more)

    body = [
        tag(
            "tr",
            *(
                cell("td", index, child) if index else cell("th", index, child, scope="row")
                for index, child in enumerate(row)
            ),
        )
        for row in rows
    ]
    head = tag("tr", *(cell("th", index, child, scope="col") for index, child in enumerate(heads)))
    return tag(
        "div",
        tag("table", tag("caption", caption), tag("thead", head), tag("tbody", *body)),
        class_="wide",
    )


def pairs(rows: Iterable[tuple[str, Child]]) -> Markup:
    """Return names with their values; a name that is empty goes on with the one before.

    Parameters
    ----------
    rows : iterable of (str, str)
        Names and values.
    """
    return tag(
        "dl", *(Markup((tag("dt", name) if name else "") + tag("dd", value)) for name, value in rows), class_="pairs"
    )


def sentences(lines: Iterable[Child]) -> Markup:
    """Return a list of sentences.

    Parameters
    ----------
    lines : iterable of str
        The sentences.
    """
    return tag("ul", *(tag("li", line) for line in lines), class_="sentences")


REPORT = Kind("a report of ehdmaps", (".html", ".htm"), has_mark)

LARGEST = 2_000_000
"""Bytes of a report: what every mail server takes."""


@dataclass(frozen=True)
class Section:
    """A section.

    Attributes
    ----------
    name : str
        Name in addresses: letters, digits and hyphens.
    title : str
        Heading of the section.
    content : sequence of str or Markup
        What it holds.
    """

    name: str
    title: str
    content: Sequence[Child]


class Moving(NamedTuple):
    """Style and script of a part of a page that moves."""

    style: str
    script: str


def document(title: str, lead: str, sections: Sequence[Section], moving: Sequence[Moving] = ()) -> str:
    """Return the text of the file.

    A browser is told to load nothing, and to execute these scripts and no other.

    Parameters
    ----------
    title, lead : str
        Heading, and the line below it; may hold foreign text.
    sections : sequence of Section
        The sections.
    moving : sequence of Moving
        Style and script of parts that move.
    """
    styles = [_resource("document.css"), *(part.style for part in moving)]
    scripts = [_resource("document.js"), *(part.script for part in moving)]
    allowed = (" ".join(map(_hash, texts)) for texts in (styles, scripts))
    policy = "default-src 'none'; style-src {}; script-src {}; base-uri 'none'; form-action 'none'".format(*allowed)
    head = tag(
        "head",
        tag("meta", charset="utf-8"),
        tag("meta", name="generator", content=MARK),
        Markup(f'<meta http-equiv="Content-Security-Policy" content="{policy}">'),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("title", title),
        *(Markup(f"<style>{style}</style>") for style in styles),
    )
    contents = tag(
        "nav",
        tag("ol", *(tag("li", tag("a", entry.title, href=f"#{entry.name}")) for entry in sections)),
        aria_label="contents",
    )
    hint = "Values: move over a chart, or select it and press the left and right arrow keys."
    body = tag(
        "body",
        tag("header", tag("h1", title), tag("p", lead), tag("p", hint, class_="hint")),
        contents,
        tag("main", *(_section(entry) for entry in sections)),
        *(Markup(f"<script>{script}</script>") for script in scripts),
    )
    return f'<!DOCTYPE html>\n<html lang="en">\n{head}\n{body}\n</html>\n'


def write_report(path: str | Path, text: str) -> None:
    """Write a report.

    Parameters
    ----------
    path : str or Path
        The file.
    text : str
        What `document` gave.

    Raises
    ------
    InputError
        If it is too large to be sent, may not be replaced, or cannot be written.
    """
    size = len(text.encode())
    if size > LARGEST:
        raise InputError(f"{path}: the report has {size} bytes; allowed: {LARGEST}; take a map with fewer points")
    write_text(path, text, REPORT)


def _section(entry: Section) -> Markup:
    """A section with its heading."""
    return tag(
        "section", tag("h2", entry.title, id=f"{entry.name}-heading"), joined(*entry.content), id=entry.name,
        aria_labelledby=f"{entry.name}-heading",
    )  # fmt: skip


@cache
def _resource(name: str) -> str:
    """Return the text of a file of this package."""
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


def _hash(text: str) -> str:
    """Return what allows exactly this text in a policy."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"

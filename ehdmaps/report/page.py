"""The whole document: head, style, script, sections, and the rule that nothing is loaded."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.outputs import MARK, Kind, has_mark, write_text
from ehdmaps.report.markup import Child, Markup, joined, tag

REPORT = Kind("a report of ehdmaps", (".html", ".htm"), has_mark)

LARGEST = 1_000_000
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


def document(title: str, lead: str, sections: Sequence[Section]) -> str:
    """Return the text of the file.

    A browser is told to load nothing, and to execute this script and no other.

    Parameters
    ----------
    title, lead : str
        Heading, and the line below it; may hold foreign text.
    sections : sequence of Section
        The sections.
    """
    style, script = _resource("document.css"), _resource("document.js")
    policy = (
        f"default-src 'none'; style-src {_hash(style)}; script-src {_hash(script)}; base-uri 'none'; form-action 'none'"
    )
    head = tag(
        "head",
        tag("meta", charset="utf-8"),
        tag("meta", name="generator", content=MARK),
        Markup(f'<meta http-equiv="Content-Security-Policy" content="{policy}">'),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("title", title),
        Markup(f"<style>{style}</style>"),
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
        Markup(f"<script>{script}</script>"),
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

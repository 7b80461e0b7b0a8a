"""Text and tags of HTML and SVG: every text that is not markup itself is escaped, wherever it comes from."""

from __future__ import annotations

import html

_LINES = "\n\t"
_NAMES = {"class_": "class", "for_": "for"}
_VOID = frozenset({"meta", "br", "hr"})


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

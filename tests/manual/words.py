"""Words of the pages that are written by hand. Run: python -m tests.manual.words.

Prints for each page its words, those in code, its sentences, and how many of them have 22 words or more. Left out are
blocks of figures, comments and pages that are made of the code. A word has a letter or a digit; of links it is the
text that counts.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from tests.manual.pages import PAGES

ROOT = Path(__file__).parents[2]
FOLDERS = (".", "docs", "ehdmaps", "mbs", "examples", "openfoam_cases")
LONG = 22

_FIGURES = re.compile(r"(?ms)^<!-- figures [\w-]+ -->\n.*?<!-- end of figures -->\n?|<!-- row [\w/-]+ -->[^\n]*")
_FENCE = re.compile(r"(?ms)^ *```[^\n]*\n(.*?)^ *```")


def pages() -> list[Path]:
    """Pages that are written by hand."""
    return sorted(page for folder in FOLDERS for page in (ROOT / folder).glob("*.md") if page not in PAGES)


def parts(text: str) -> tuple[str, str]:
    """Prose and code of a page, without figures and comments."""
    own = re.sub(r"(?s)<!--.*?-->", "", _FIGURES.sub("", text))
    return _FENCE.sub("", own), "\n".join(_FENCE.findall(own))


def words(text: str) -> list[str]:
    """Words of a text."""
    return [word for word in re.sub(r"\]\([^)]*\)", "]", text).split() if re.search(r"\w", word)]


def sentences(prose: str) -> Iterator[str]:
    """Sentences outside tables and headings; a name in backticks counts as one word."""
    text = re.sub(r"`[^`]*`", "CODE", re.sub(r"(?m)^[|#].*$", "\n", prose))
    for paragraph in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )", text):
        yield from filter(None, re.split(r"(?<=[.:;?!])\s+(?=[A-Z\"\[(*])", " ".join(paragraph.split())))


def main() -> None:
    """Print the table."""
    rows = []
    for page in pages():
        prose, code = parts(page.read_text(encoding="utf-8"))
        lengths = [len(words(sentence)) for sentence in sentences(prose)]
        counts = [len(words(prose)), len(words(code)), len(lengths), sum(length >= LONG for length in lengths)]
        rows.append((counts, str(page.relative_to(ROOT))))
    rows.append(([sum(counts[i] for counts, _ in rows) for i in range(4)], "together"))
    print(f" words in code sentences of {LONG} and more")
    for counts, name in sorted(rows):
        print(" ".join(f"{count:{width}d}" for count, width in zip(counts, (6, 7, 9, 14), strict=True)), "", name)


if __name__ == "__main__":
    main()

"""What pyproject.toml cannot say: README.md as a package index shows it."""

from __future__ import annotations

import re
from pathlib import Path

PLACES = "Files that are named here by their path are in the source distribution.\n"


def on_an_index(readme: str) -> str:
    """Return a text without what is relative to the repository: pictures go, links to files become their paths.

    Parameters
    ----------
    readme : str
        Text in Markdown.
    """

    def named(found: re.Match[str]) -> str:
        text, path = found[1], found[2].partition("#")[0]
        return text if path in text.strip("`") else f"{text} (`{path}`)"

    blocks = re.split(r"(^```.*?^```$)", readme, flags=re.MULTILINE | re.DOTALL)
    for place in range(0, len(blocks), 2):  # what is between blocks of code
        text = re.sub(r"<!--.*?-->\n?", "", blocks[place], flags=re.DOTALL)
        text = re.sub(r"!\[[^\]]*\]\((?!https?:)[^)]*\)\n*", "", text)
        blocks[place] = re.sub(r"(?<!!)\[([^\]]+)\]\((?!https?:|#)([^)]+)\)", named, text)
    return "".join(blocks).rstrip() + "\n\n" + PLACES


if __name__ == "__main__":
    from setuptools import setup

    text = Path(__file__).with_name("README.md").read_text(encoding="utf-8")
    setup(long_description=on_an_index(text), long_description_content_type="text/markdown")

"""What pyproject.toml cannot say: README.md as a package index shows it, and what a build holds beside the packages."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

CASES = (
    "COPYING",
    "README.md",
    "build",
    "ehlFoam/**/*.[CH]",
    "ehlFoam/Make/files",
    "ehlFoam/Make/options",
    "lineContact/All*",
    "lineContact/constant/ehlProperties",
    "lineContact/system/*",
)
"""Files of openfoam_cases in the package ehdmaps of an installation: what `ehdmaps openfoam` builds, and the case that
the solver copies."""

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


def bring_cases(folder: Path) -> None:
    """Copy the files of openfoam_cases that an installation has into a folder of that name in another one."""
    source = Path(__file__).with_name("openfoam_cases")
    for path in (found for pattern in CASES for found in sorted(source.glob(pattern))):
        target = folder / source.name / path.relative_to(source)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(path, target)


if __name__ == "__main__":
    from setuptools import setup
    from setuptools.command.build_py import build_py

    class Build(build_py):
        """The files of this state of the sources alone: those of older ones are left in build/lib by setuptools."""

        def run(self) -> None:
            """Empty the folder, fill it, and bring the cases for OpenFOAM."""
            if self.editable_mode:
                super().run()
                return
            shutil.rmtree(self.build_lib, ignore_errors=True)
            super().run()
            bring_cases(Path(self.build_lib, "ehdmaps"))

    text = Path(__file__).with_name("README.md").read_text(encoding="utf-8")
    setup(
        long_description=on_an_index(text),
        long_description_content_type="text/markdown",
        cmdclass={"build_py": Build},
    )

"""What pyproject.toml cannot say: README.md as a package index shows it, the C library, and the cases for OpenFOAM."""

from __future__ import annotations

import os
import re
import runpy
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


def build_library(folder: Path) -> Path:
    """Compile the C library into the package ehdmaps in a folder, and return its file.

    Parameters
    ----------
    folder : Path
        Folder that holds the package.
    """
    kernel = Path(__file__).parent / "ehdmaps" / "kernel"
    building = runpy.run_path(str(kernel / "building.py"))
    target = folder / "ehdmaps" / "kernel" / building["file_name"]()
    building["build"](target, os.environ)
    return target


def platform_tag(plain: str, needed: bytes) -> str:
    """Return the platform in the name of a wheel: of Linux of any kind where the library needs an old C library alone.

    Parameters
    ----------
    plain : str
        Platform as setuptools says it, such as "linux_x86_64".
    needed : bytes
        Contents of the library, which names the versions of the C library that it needs.
    """
    versions = [int(version) for version in re.findall(rb"GLIBC_2\.(\d+)", needed)]
    old = plain.startswith("linux_") and versions and max(versions) <= 17  # of manylinux2014
    return plain.replace("linux_", "manylinux_2_17_", 1) if old else plain


if __name__ == "__main__":
    from setuptools import Distribution, setup
    from setuptools.command.bdist_wheel import bdist_wheel
    from setuptools.command.build_py import build_py

    class Platform(Distribution):
        """A distribution of files that depend on the platform, though not on the version of Python."""

        def has_ext_modules(self) -> bool:
            """Say that there is compiled code, by which setuptools chooses the folders."""
            return True

    class Build(build_py):
        """The files of this state of the sources alone: those of older ones are left in build/lib by setuptools."""

        def run(self) -> None:
            """Empty the folder, fill it, compile the library, and bring the cases for OpenFOAM."""
            if self.editable_mode:
                super().run()
                build_library(Path(__file__).parent)
                return
            shutil.rmtree(self.build_lib, ignore_errors=True)
            super().run()
            build_library(Path(self.build_lib))
            bring_cases(Path(self.build_lib, "ehdmaps"))

    class Wheel(bdist_wheel):
        """One wheel for all versions of Python: the library is called by ctypes."""

        def get_tag(self) -> tuple[str, str, str]:
            """Return what the wheel is for: Python 3, of any kind, on a platform."""
            libraries = sorted(Path(self.bdist_dir).rglob("libehd.*"))
            return "py3", "none", platform_tag(super().get_tag()[2], b"".join(path.read_bytes() for path in libraries))

    text = Path(__file__).with_name("README.md").read_text(encoding="utf-8")
    setup(
        long_description=on_an_index(text),
        long_description_content_type="text/markdown",
        distclass=Platform,
        cmdclass={"build_py": Build, "bdist_wheel": Wheel},
        options={"build": {"build_lib": "build/lib"}},
    )

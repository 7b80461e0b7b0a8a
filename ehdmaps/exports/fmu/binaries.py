"""Compiling the sources of a unit, for each platform for which a compiler is there."""

from __future__ import annotations

import platform
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from ehdmaps.errors import InputError

_OPTIONS = ("-std=c99", "-O2", "-shared", "-fvisibility=hidden")


@dataclass(frozen=True)
class Platform:
    """A platform that the unit is compiled for.

    Attributes
    ----------
    name : str
        Name for people, which is also the folder of FMI 2.0.
    folder : str
        Folder of FMI 3.0.
    ending : str
        Ending of the binary.
    compiler : str
        The compiler; "" where this machine has none for it.
    options : tuple of str
        Options that only it needs.
    """

    name: str
    folder: str
    ending: str
    compiler: str
    options: tuple[str, ...]


def platforms() -> tuple[Platform, Platform]:
    """Return the platforms, with the compilers that this machine has."""
    native = sys.platform == "linux" and platform.machine() == "x86_64"
    linux = (shutil.which("gcc") or shutil.which("clang") or "") if native else ""
    windows = shutil.which("x86_64-w64-mingw32-gcc") or ""
    return (
        Platform("linux64", "x86_64-linux", ".so", linux, ("-fPIC",)),
        Platform("win64", "x86_64-windows", ".dll", windows, ("-static-libgcc",)),
    )


def compiled(target: Platform, folder: Path, sources: tuple[str, ...], name: str) -> bytes:
    """Compile sources into a library.

    Parameters
    ----------
    target : Platform
        Platform with a compiler.
    folder : Path
        Folder of the sources.
    sources : tuple of str
        Files to be compiled.
    name : str
        Name of the library without its ending.

    Raises
    ------
    InputError
        If the compiler fails.
    """
    library = folder / f"{name}.{target.name}{target.ending}"
    command = [target.compiler, *_OPTIONS, *target.options, *sources, "-o", str(library), "-lm"]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise InputError(
            f"export fmu: {target.compiler} failed for {target.name}: {result.stderr.strip()[-600:]}\n"
            "take --sources-only, and let the importing program compile the unit"
        )
    return library.read_bytes()

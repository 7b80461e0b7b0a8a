"""Compiling the sources of a unit: for this machine, and for other systems where the package ziglang is installed.

ziglang has the headers and libraries of all systems, and compiles for any processor of a kind; on Linux for the C
library of 2012 and later ones.
"""

from __future__ import annotations

import importlib.util
import platform
import shutil
import struct
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ehdmaps.errors import InputError

_OPTIONS = ("-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fvisibility=hidden")


@dataclass(frozen=True)
class Platform:
    """A platform that the unit is compiled for.

    Attributes
    ----------
    name : str
        Folder of FMI 2.0; "" where that has none.
    folder : str
        Folder of FMI 3.0, which is also the name for people.
    ending : str
        Ending of the binary.
    compiler : tuple of str
        Command that compiles for it; empty where this machine has none.
    """

    name: str
    folder: str
    ending: str
    compiler: tuple[str, ...]


_SYSTEMS = (
    ("linux64", "x86_64-linux", ".so", "x86_64-linux-gnu.2.17"),
    ("", "aarch64-linux", ".so", "aarch64-linux-gnu.2.17"),
    ("win64", "x86_64-windows", ".dll", "x86_64-windows-gnu"),
    ("darwin64", "x86_64-darwin", ".dylib", "x86_64-macos"),
    ("darwin64", "aarch64-darwin", ".dylib", "aarch64-macos"),
)
"""Folders of FMI 2.0 and 3.0, ending, and how ziglang calls the system."""


def platforms() -> tuple[Platform, ...]:
    """Return the platforms, with the compilers that this machine has; its own system comes first."""
    machine = platform.machine().lower()
    machine = {"arm64": "aarch64", "amd64": "x86_64"}.get(machine, machine)
    own = f"{machine}-{'windows' if sys.platform == 'win32' else sys.platform}"
    native = shutil.which("gcc") or shutil.which("clang")
    others, found = zig(), []
    for name, folder, ending, target in _SYSTEMS:
        compiler = (native,) if native and folder == own else (*others, "-target", target) if others else ()
        found.append(Platform(name, folder, ending, compiler))
    return tuple(sorted(found, key=lambda target: target.folder != own))


def zig() -> tuple[str, ...]:
    """Return the command of the compiler for any system; empty where its package is not installed."""
    return (sys.executable, "-m", "ziglang", "cc", "-s") if importlib.util.find_spec("ziglang") else ()


def compiled(target: Platform, folder: Path, sources: Sequence[str], name: str) -> bytes:
    """Compile sources into a library.

    Parameters
    ----------
    target : Platform
        Platform with a compiler.
    folder : Path
        Folder of the sources.
    sources : sequence of str
        Files to be compiled.
    name : str
        Name of the library without its ending.

    Raises
    ------
    InputError
        If the compiler fails.
    """
    library = folder / f"{name}.{target.folder}{target.ending}"
    position = () if target.ending == ".dll" else ("-fPIC",)
    command = [*target.compiler, *_OPTIONS, *position, *sources, "-o", str(library), "-lm"]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise InputError(
            f"export fmu: {target.compiler[0]} failed for {target.folder}: {result.stderr.strip()[-600:]}\n"
            "take --sources-only, and let the importing program compile the unit"
        )
    return library.read_bytes()


_ALIGNED = 14
"""Power of two at which the parts of a universal binary begin: a page of Apple's processors."""


def universal(parts: Sequence[bytes]) -> bytes:
    """Join libraries of macOS for several processors into one file, from which the system takes its own part.

    Parameters
    ----------
    parts : sequence of bytes
        Libraries in the format Mach-O, of 64 bits.
    """
    page = 1 << _ALIGNED
    head, body = struct.pack(">2I", 0xCAFEBABE, len(parts)), b""
    for part in parts:
        processor, model = struct.unpack_from("<2I", part, 4)
        head += struct.pack(">5I", processor, model, page + len(body), len(part), _ALIGNED)
        body += part.ljust(-(-len(part) // page) * page, b"\0")
    return head.ljust(page, b"\0") + body

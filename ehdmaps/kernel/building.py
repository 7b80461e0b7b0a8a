"""The C compiler, and which state of the C files a library was made of.

Imports the standard library alone, and nothing of this distribution: `setup.py` runs this file by its path, before
anything is installed.

The number of a state is a hash over the C files and the options of the compiler. It is compiled into the library, as
text, and read from the file without running anything of it.
"""

from __future__ import annotations

import contextlib
import hashlib
import importlib.util
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

SOURCES = Path(__file__).with_name("c")
"""Folder of the C files."""

UNIT = "kernel.c"
"""File that includes all others."""

ALWAYS = ("-std=c99", "-fno-math-errno", "-fno-trapping-math", "-ffp-contract=off", "-fno-semantic-interposition")
"""Options without which numbers or times are others: never `-ffast-math`, which takes finite numbers for granted."""

OPTIONS = {
    "": ("-O3",),
    "debug": ("-O0", "-g"),
    "sanitized": ("-O0", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer"),
    "coverage": ("-O0", "-g", "--coverage"),
}
"""Kinds of the library, by the word that asks for them, with their options; "" is the one for users. What `coverage`
counts, with gcc, stands beside the library when a process ends: `gcov -o ehdmaps/kernel ehdmaps/kernel/*.gcda`."""

LINES = ("-Wall", "-Wextra")
"""Warnings, which are shown where the compiler fails."""

COMPILERS = ("cc", "gcc", "clang")
"""Programs that are tried in turn, after the one that the environment variable CC names."""

OLDEST_GLIBC = "2.17"
"""Version of the C library of Linux for which ziglang builds: that of manylinux2014."""

_ENDINGS = {"darwin": ".dylib", "win32": ".dll"}
_NUMBER = re.compile(rb"ehdmaps kernel <([0-9a-f]{32})>")
_TRIAL = "#include <math.h>\n#include <stdint.h>\n#include <string.h>\ndouble half(double x) { return floor(x / 2); }\n"


class BuildError(Exception):
    """The library cannot be built; the message says what each compiler said."""


class NoCompilerError(BuildError):
    """No C compiler is found."""


def file_name(kind: str = "") -> str:
    """Return the name of the file of the library on this platform.

    Parameters
    ----------
    kind : str
        Kind of the library, a key of `OPTIONS`.
    """
    return "-".join(filter(None, ("libehd", kind))) + _ENDINGS.get(sys.platform, ".so")


def source_files(folder: Path = SOURCES) -> dict[str, bytes]:
    """Return the contents of the C files by their names, in order, with line ends of Unix.

    Parameters
    ----------
    folder : Path
        Folder of the C files.
    """
    paths = sorted(path for ending in ("c", "h") for path in folder.rglob(f"*.{ending}"))
    return {path.relative_to(folder).as_posix(): path.read_bytes().replace(b"\r\n", b"\n") for path in paths}


def state(folder: Path = SOURCES) -> str:
    """Return the number of the C files and of the options of the compiler: 32 hexadecimal digits.

    Parameters
    ----------
    folder : Path
        Folder of the C files.
    """
    digest = hashlib.sha256(repr((ALWAYS, sorted(OPTIONS.items()))).encode())
    for name, content in source_files(folder).items():
        digest.update(f"\0{name}\0{len(content)}\0".encode() + content)
    return digest.hexdigest()[:32]


def state_of(library: Path) -> str:
    """Return the number of the C files that a library was made of; empty without such a file, or a number in it.

    Parameters
    ----------
    library : Path
        File of the library, which is read and not run.
    """
    try:
        found = _NUMBER.search(library.read_bytes())
    except OSError:
        return ""
    return found[1].decode() if found else ""


def zig_target() -> tuple[str, ...]:
    """Return the options by which ziglang compiles for any processor of this machine's kind, and not for its own."""
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine().lower())
    if sys.platform == "linux":
        return "-target", f"{machine}-linux-{'musl' if _has_musl() else f'gnu.{OLDEST_GLIBC}'}"
    system = {"darwin": "macos", "win32": "windows-gnu"}.get(sys.platform)
    return ("-target", f"{machine}-{system}") if system else ("-mcpu=baseline",)


def _has_musl() -> bool:
    """Tell whether the C library of this Linux is musl."""
    return not platform.libc_ver()[0] and any(Path("/lib").glob("ld-musl-*"))


def compilers(environment: Mapping[str, str]) -> Iterator[list[str]]:
    """Give the C compilers of this machine, each as the start of a command.

    Parameters
    ----------
    environment : mapping of str to str
        The environment: `CC` names a compiler that comes first, `PATH` has the folders.

    Yields
    ------
    list of str
        A program with its arguments; the last one is the package ziglang, where it is installed.
    """
    path = environment.get("PATH", os.defpath)
    for words in filter(None, (shlex.split(environment.get("CC", "")), *([name] for name in COMPILERS))):
        if program := shutil.which(words[0], path=path):
            yield [program, *words[1:]]
    if importlib.util.find_spec("ziglang") is not None:
        yield [sys.executable, "-m", "ziglang", "cc", *zig_target()]


def usable_compiler(environment: Mapping[str, str]) -> list[str]:
    """Return the first compiler that compiles a small file which needs the headers of the C library; ziglang has them.

    Parameters
    ----------
    environment : mapping of str to str
        The environment, see `compilers`.

    Raises
    ------
    NoCompilerError
        If there is none.
    """
    said = []
    for compiler in compilers(environment):
        if "ziglang" in compiler:
            return compiler
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "trial.c").write_text(_TRIAL, encoding="ascii")
            said.append(_failure([*compiler, "-shared", *_position(), "trial.c", "-o", "trial.bin", "-lm"], folder))
        if not said[-1]:
            return compiler
    sought = f"sought are CC, {', '.join(COMPILERS)} and the package ziglang"
    raise NoCompilerError("; ".join((f"no C compiler is found: {sought}", *said[:1])))


def build(target: Path, environment: Mapping[str, str], kind: str = "", folder: Path = SOURCES) -> str:
    """Compile the library into a file, which is replaced whole or not at all; other processes may do so at once.

    Parameters
    ----------
    target : Path
        File of the library, in a folder that exists.
    environment : mapping of str to str
        The environment, see `compilers`.
    kind : str
        Kind of the library, a key of `OPTIONS`.
    folder : Path
        Folder of the C files.

    Returns
    -------
    str
        Number of the C files that it was made of.

    Raises
    ------
    BuildError
        If no compiler is found, or the one that is found fails.
    OSError
        If the file cannot be written.
    """
    target, folder = target.absolute(), folder.absolute()
    with tempfile.TemporaryDirectory(prefix=".ehd-", dir=target.parent) as aside, _alone(target.parent):
        wanted = state(folder)
        if state_of(target) == wanted:  # another process was faster
            return wanted
        compiler = usable_compiler(environment)
        made = Path(aside) / target.name
        while True:
            if failure := _failure(
                [*compiler, *_arguments(kind, wanted, folder, target.parent), "-o", str(made), "-lm"], aside
            ):
                raise BuildError(failure)
            if (now := state(folder)) == wanted:
                break
            wanted = now  # a file was changed meanwhile
        made.replace(target)
        return wanted


def say_compiler() -> None:
    """Print the compiler that a build here takes; nothing where it would have to be installed."""
    try:
        print(usable_compiler(os.environ)[0])  # noqa: T201
    except NoCompilerError:
        return


def _arguments(kind: str, number: str, folder: Path, home: Path) -> list[str]:
    """Arguments of the compiler but for the file that it makes and libraries."""
    counts = ["-dumpdir", f"{home}/libehd-coverage-"] if kind == "coverage" else []
    number = f"-DEHD_NUMBER={number}"
    return [*ALWAYS, *OPTIONS[kind], *LINES, *counts, number, "-shared", *_position(), str(folder / UNIT)]


def _position() -> tuple[str, ...]:
    """Options of code that may stand anywhere in memory."""
    return () if sys.platform == "win32" else ("-fPIC",)


def _failure(command: list[str], folder: str) -> str:
    """Run a compiler; what it says where it fails, or an empty text."""
    try:
        result = subprocess.run(command, cwd=folder, capture_output=True, text=True, errors="replace", check=False)
    except OSError as error:
        return f"{command[0]}: {error.strerror}"
    return f"{shlex.join(command)}\n{result.stderr.strip()[-2000:]}" if result.returncode else ""


@contextlib.contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Wait for other processes that build there; where a system has no locks, each of them builds."""
    try:
        import fcntl
    except ImportError:
        yield
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        with contextlib.suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


if __name__ == "__main__":
    say_compiler()

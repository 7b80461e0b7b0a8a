"""State of the sources that run: the commit of the clone, and one hash of all that a number is computed with.

The hash is the only thing that says whether two numbers come from the same code. Solved points
(`ehdmaps.jobs.make.tasks`) and reduced bodies (`mbs.flexible.carry_out`) are kept under it, and maps and results state
it. So nothing that an older version made is ever taken for the work of a newer one.

Compiled code (`ehdmaps.compiled`) is kept under a hash of fewer files: those that have compiled functions, and all that
these import from the packages, and so on. A compiled function has frozen in it what its module imported, and nothing
else of the packages. So an edit of a command, a report or a page does not compile anything anew.
"""

from __future__ import annotations

import functools
import glob
import hashlib
import os
import platform
import re
import subprocess
from collections.abc import Iterator, Mapping
from importlib import metadata
from pathlib import Path

PACKAGES = ("ehdmaps", "mbs")
"""Packages of the distribution."""

ROOT = Path(__file__).parents[1]
"""The folder that holds the packages: of a clone its top, of an installation its `site-packages`."""

DIGITS = 10
"""Of the commit and of the hash of a version: enough that no two states of a project share them."""

PATIENCE = 2.0
"""Seconds that git is given; it needs some milliseconds."""

_COMPUTE = ("numba", "llvmlite", "numpy", "scipy")
"""Distributions whose version may change the last digits of a number, or the compiled code."""


@functools.cache
def source_state(root: Path) -> str:
    """Return what tells this state of the sources from another, in the form of a local version (PEP 440).

    Parameters
    ----------
    root : Path
        The folder that holds the packages.

    Returns
    -------
    str
        State of the sources. In a clone it is the commit: "g19eceb2715", with ".dirty" and a hash of the packages'
        files where a file that git tracks was changed: "g19eceb2715.dirty.5d41402abc". Elsewhere, and where git
        is missing or refuses, the hash alone: "src.5d41402abc". Empty where there is neither. Found once a process, in
        some 20 ms.
    """
    commit = _commit(root)
    if commit and not commit.endswith(".dirty"):
        return commit
    digits = sources_hash(root)[:DIGITS]
    return ".".join(filter(None, (commit or (digits and "src"), digits)))


def sources_hash(root: Path = ROOT) -> str:
    """Return a hash over names and contents of the packages' Python files, the C files of `ehdmaps.kernel`, and data.

    Parameters
    ----------
    root : Path
        The folder that holds the packages.

    Returns
    -------
    str
        64 hexadecimal digits; empty where no file is found, or one cannot be read.
    """
    return _hashed(_sources(root))


def kernels_hash(root: Path = ROOT) -> str:
    """Return a hash over names and contents of the files that compiled code is made from.

    Parameters
    ----------
    root : Path
        The folder that holds the packages.

    Returns
    -------
    str
        64 hexadecimal digits; empty where no file is found, or one cannot be read.
    """
    sources = _sources(root)
    return _hashed({name: sources[name] for name in kernel_files(sources)})


def kernel_files(sources: Mapping[str, bytes]) -> list[str]:
    """Return the names of the files that speak of `njit`, and of all that they import at their left margin, and so on.

    Parameters
    ----------
    sources : mapping of str to bytes
        Contents of Python files by their names, such as "mbs/gears/pair.py".
    """
    found = {name for name, content in sources.items() if b"njit" in content and name.endswith(".py")}
    left = sorted(found)
    while left:
        for name in _imported(sources[left.pop()].decode("utf-8", "replace")):
            if name in sources and name not in found:
                found.add(name)
                left.append(name)
    return sorted(found)


_IMPORT = re.compile(r"^(?:from ([\w.]+) import (?:\(([^)]*)\)|([^\n#]*))|import ([\w.]+))", re.MULTILINE)


def _imported(text: str) -> Iterator[str]:
    """Names of files that a file may import: modules, and what may be a module of a package."""
    for module, listed, line, alone in _IMPORT.findall(text):
        place = (module or alone).replace(".", "/")
        for name in (place, *(f"{place}/{name}" for name in re.findall(r"\w+", listed or line))):
            yield f"{name}.py"
            yield f"{name}/__init__.py"


def _sources(root: Path) -> dict[str, bytes]:
    """Contents of the packages' Python, C and data files by their names, in order; none where one cannot be read."""
    data = ("ehdmaps/kernel/c/**/*.[ch]", "ehdmaps/physics/shipped/*.*", "ehdmaps/maps/*.toml")
    patterns = (*(f"{package}/**/*.py" for package in PACKAGES), *data)
    # texts, not paths: what is kept by this hash is read in a fraction of what objects for all files take
    found = (glob.glob(pattern, root_dir=root, recursive=True, include_hidden=True) for pattern in patterns)
    sources = {}
    try:
        for name in sorted(each.replace(os.sep, "/") for names in found for each in names):
            with open(os.path.join(root, name), "rb", buffering=0) as file:
                sources[name] = file.read()
    except OSError:
        return {}
    return sources


def _hashed(sources: Mapping[str, bytes]) -> str:
    """Hash of names and contents; empty without any."""
    digest = hashlib.sha256()
    for name, content in sources.items():
        digest.update(f"{name}\0{len(content)}\0".encode() + content)
    return digest.hexdigest() if sources else ""


@functools.cache
def code_hash() -> str:
    """Return the hash of all that a number is computed with.

    Returns
    -------
    str
        16 hexadecimal digits, over Python and C files of this distribution and the versions of Python, numba, LLVM's
        binding, numpy and scipy. The processor is not in it: points that the nodes of a cluster solve belong together.
    """
    return _with_versions(sources_hash())


@functools.cache
def compiled_hash() -> str:
    """Return the hash of all that compiled code is made from but the processor, 16 hexadecimal digits."""
    return _with_versions(kernels_hash())


def _with_versions(sources: str) -> str:
    """Hash of sources together with the versions of what computes."""
    versions = [f"{platform.python_implementation()} {platform.python_version()}"]
    for name in _COMPUTE:
        try:
            versions.append(f"{name} {metadata.version(name)}")
        except metadata.PackageNotFoundError:
            versions.append(f"{name} missing")
    return hashlib.sha256("\0".join((sources, *versions)).encode()).hexdigest()[:16]


def _commit(root: Path) -> str:
    """Commit of a clone with its top here; a clone further up, around a virtual environment, is another's."""
    if not (root / ".git").exists():
        return ""
    # A hook of git may have set where its repository is; this one is to be looked at, and nothing written into it.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    command = ["git", "-C", str(root), "describe", "--always", "--dirty", "--exclude=*", f"--abbrev={DIGITS}"]
    try:
        answer = subprocess.run(
            command,
            env=environment | {"GIT_OPTIONAL_LOCKS": "0"},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            check=True,
        )
    except (OSError, subprocess.SubprocessError, UnicodeDecodeError):
        return ""
    commit, _, mark = answer.stdout.strip().partition("-")
    return f"g{commit}" + (f".{mark}" if mark else "")

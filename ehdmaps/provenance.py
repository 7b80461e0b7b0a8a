"""Which state of the sources runs: the commit of the clone, or else a hash of what the packages contain."""

from __future__ import annotations

import functools
import hashlib
import os
import subprocess
from pathlib import Path

PACKAGES = ("ehdmaps", "mbs")
"""Packages of the distribution."""

DIGITS = 10
"""Of the commit and of the hash: enough that no two states of a project share them."""

PATIENCE = 2.0
"""Seconds that git is given; it needs some milliseconds."""


@functools.cache
def source_state(root: Path) -> str:
    """Return what tells this state of the sources from another, in the form of a local version (PEP 440).

    Parameters
    ----------
    root : Path
        The folder that holds the packages: of a clone its top, of an installation its `site-packages`.

    Returns
    -------
    str
        State of the sources. In a clone it is the commit: "g19eceb2715", with ".dirty" where a file that git tracks was
        changed. Elsewhere, and where git is missing or refuses, a hash of the packages' Python files: "src.5d41402abc".
        Empty where there is neither. Found once a process, in some 10 ms.
    """
    return _commit(root) or _hash(root)


def _commit(root: Path) -> str:
    """Commit of a clone with its top here; a clone further up, around a virtual environment, is another's."""
    if not (root / ".git").exists():
        return ""
    # A hook of git may have set where its repository is; this one is to be looked at, and nothing written into it.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    command = ["git", "-C", str(root), "describe", "--always", "--dirty", "--exclude=*", f"--abbrev={DIGITS}"]
    try:
        found = subprocess.run(
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
    commit, _, mark = found.stdout.strip().partition("-")
    return f"g{commit}" + (f".{mark}" if mark else "")


def _hash(root: Path) -> str:
    """Hash over names and contents of the Python files."""
    found = hashlib.sha256()
    names = sorted(
        path.relative_to(root).as_posix() for package in PACKAGES for path in root.glob(f"{package}/**/*.py")
    )
    try:
        for name in names:
            content = (root / name).read_bytes()
            found.update(f"{name}\0{len(content)}\0".encode() + content)
    except OSError:
        return ""
    return f"src.{found.hexdigest()[:DIGITS]}" if names else ""

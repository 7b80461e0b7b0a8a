"""Versions of this distribution and of what it computes with; the one place that looks them up."""

from __future__ import annotations

import functools
from pathlib import Path

from ehdmaps.provenance import source_state

NAME = "ehdmaps"
"""Of the distribution."""

NOT_INSTALLED = "not installed"


def version(package: str = NAME) -> str:
    """Return the version of a package.

    Parameters
    ----------
    package : str
        Name of a distribution; ours if left out.

    Returns
    -------
    str
        The version. Of another package that of its installation, or "not installed". Of ours number and state of the
        sources: "0.1.0+g19eceb2715" in a clone, "0.1.0+g19eceb2715.dirty" where files differ from that commit,
        "0.1.0+src.5d41402abc" elsewhere (`ehdmaps.provenance`). The number is that of the project file in a clone,
        else that of the installation.
    """
    if package != NAME:
        return _installed(package) or NOT_INSTALLED
    root = Path(__file__).parents[1]
    number = _of_the_clone(root) or _installed(NAME)
    return "+".join(filter(None, (number, source_state(root)))) if number else NOT_INSTALLED


@functools.cache
def _installed(package: str) -> str:
    """Version of an installed package, or an empty text: looked up once a process, which has loaded what it loaded."""
    from importlib import metadata

    try:
        # A damaged installation has a record without a version.
        return str(metadata.version(package) or "")
    except metadata.PackageNotFoundError:
        return ""


def _of_the_clone(root: Path) -> str:
    """Version in the project file beside the package, if it is ours."""
    import tomllib

    try:
        with (root / "pyproject.toml").open("rb") as file:
            project = tomllib.load(file).get("project", {})
    except (OSError, ValueError):
        return ""
    return str(project.get("version", "")) if project.get("name") == NAME else ""

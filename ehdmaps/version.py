"""Which version of this distribution runs, and of what it computes with; the one place that looks it up."""

from __future__ import annotations

from pathlib import Path

NAME = "ehdmaps"
"""Of the distribution."""

NOT_INSTALLED = "not installed"


def version(package: str = NAME) -> str:
    """Return the version of an installed package.

    Parameters
    ----------
    package : str
        Name of a distribution; ours if left out.

    Returns
    -------
    str
        Such as "0.1.0". Of one that is not installed: "not installed"; of ours, which runs from a clone then, the
        version that the clone gives itself: "0.1.0 (not installed)".
    """
    from importlib import metadata

    try:
        # A damaged installation has a record without a version.
        found = str(metadata.version(package) or "")
    except metadata.PackageNotFoundError:
        found = ""
    return found or (_of_the_clone() if package == NAME else NOT_INSTALLED)


def _of_the_clone() -> str:
    """Version in the project file beside the package."""
    import tomllib

    try:
        with (Path(__file__).parents[1] / "pyproject.toml").open("rb") as file:
            project = tomllib.load(file).get("project", {})
    except (OSError, ValueError):
        project = {}
    if project.get("name") != NAME or "version" not in project:
        return NOT_INSTALLED
    return f"{project['version']} ({NOT_INSTALLED})"

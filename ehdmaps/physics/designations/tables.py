"""Tables of catalogues and standards of bearings, which `ehdmaps/physics/shipped/catalogues.toml` has."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib import resources
from typing import Any


@cache
def _tables() -> dict[str, dict[str, Any]]:
    """The file, read once."""
    text = (resources.files("ehdmaps.physics") / "shipped" / "catalogues.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def table(kind: str) -> dict[str, Any]:
    """Return the tables of a kind of bearing, by their names; each is a list of rows.

    Parameters
    ----------
    kind : str
        cylindrical, balls, needles, tapered, or clearance.

    Examples
    --------
    >>> table("clearance")["balls"][0][:3]
    [10, 0, 7]
    """
    return _tables()[kind]

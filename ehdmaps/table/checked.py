"""Laws of the film table beside fresh solves: a fact of the release, recorded beside the table.

The file `checked.json` is made by `python -m tests.benchmarks.table_checked --write`; `ehdmaps generate JOB --check`
finds the same for one map.
"""

from __future__ import annotations

import json
from functools import cache
from importlib import resources
from typing import Any

FILE = "checked.json"

WITHIN = ("film_compliance", "damping")
"""Numbers that have bars, by their names in the attributes of a map."""


@cache
def checked_text(checksum: str) -> str:
    """Say how good laws of a film table are beside fresh solves; empty of a table that was not checked.

    Parameters
    ----------
    checksum : str
        That of the table.
    """
    found: dict[str, Any] = json.loads((resources.files(__package__) / FILE).read_text(encoding="utf-8"))
    if found["content_sha256"] != checksum:
        return ""
    rows = list(found["maps"].values())
    points = sum(row["law_check_usable"] for row in rows)
    parts = [
        f"{name.replace('_', ' ')} within its bar at "
        f"{sum(row['law_check_usable'] * row[f'law_{name}_within_bar'] for row in rows) / points:.2%}"
        for name in WITHIN
    ]
    return (
        f"laws of this table were held against fresh solves at {points} random points of {len(rows)} maps: "
        f"{', '.join(parts)}; --check does so for one map"
    )

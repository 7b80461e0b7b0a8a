"""`ehdmaps compare`: two maps, point by point."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.jobs.compare import compare, comparison_text
from ehdmaps.maps.emap import open_map


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Compare the points that both maps have."""
    first, second = Path(arguments.first), Path(arguments.second)
    found = compare(open_map(first).dataset, open_map(second).dataset, (str(first), str(second)))
    return comparison_text(found), 0

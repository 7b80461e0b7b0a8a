"""`ehdmaps compare`: two maps, point by point, and between points where these are not shared."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.jobs.show.compare import compare, comparison_json, comparison_text
from ehdmaps.maps.emap import open_map


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Compare two maps; the differences as a table or as JSON."""
    first, second = Path(arguments.first), Path(arguments.second)
    comparison = compare(open_map(first), open_map(second), (str(first), str(second)))
    return comparison_json(comparison) if arguments.json else comparison_text(comparison), 0

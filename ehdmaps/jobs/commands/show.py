"""`ehdmaps show`: what a map holds."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.jobs.show.describe import describe
from ehdmaps.jobs.show.opening import open_given


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Describe the map."""
    path = Path(arguments.map)
    return describe(open_given(path, arguments), path.name), 0

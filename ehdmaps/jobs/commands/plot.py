"""`ehdmaps plot`: a map on one page."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.jobs.opening import open_given
from ehdmaps.jobs.plot import plot_map
from ehdmaps.outputs import FIGURE, Output, check_outputs


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Draw the page and write it; by default beside the map, as PNG."""
    path = Path(arguments.map)
    output = Path(arguments.output) if arguments.output else path.with_suffix(".png")
    check_outputs([Output("-o", output, FIGURE)], [path])
    plot_map(open_given(path, arguments.structure), output)
    return f"{output}: written", 0

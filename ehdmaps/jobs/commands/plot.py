"""`ehdmaps plot`: a map on one page."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.jobs.show.opening import open_given
from ehdmaps.jobs.show.plot import plot_map
from ehdmaps.jobs.show.rough_plot import plot_roughness
from ehdmaps.outputs import FIGURE, Output, check_outputs


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Draw the page and write it; by default beside the map, as PNG."""
    path = Path(arguments.map)
    rough = arguments.roughness is not None and arguments.roughness != "smooth"
    usual = path.with_name(f"{path.stem}_roughness.png") if rough else path.with_suffix(".png")
    output = Path(arguments.output) if arguments.output else usual
    check_outputs([Output("-o", output, FIGURE)], [path])
    emap = open_given(path, arguments)
    (plot_roughness if rough else plot_map)(emap, output)
    return f"{output}: written", 0

"""`ehdmaps plot`: a map on one page."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.jobs.plot import plot_map
from ehdmaps.maps.emap import open_map


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Draw the page and write it; by default beside the map, as PNG."""
    path = Path(arguments.map)
    output = Path(arguments.output) if arguments.output else path.with_suffix(".png")
    emap = open_map(path)
    try:
        plot_map(emap, output)
    except (OSError, ValueError) as error:
        raise InputError(
            f"-o: {output} cannot be written ({error}); allowed: a .png, .pdf or .svg file in a folder "
            "that may be written"
        ) from error
    return f"{output}: written", 0

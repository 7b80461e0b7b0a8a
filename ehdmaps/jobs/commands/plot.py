"""`ehdmaps plot`: a map on one page, or some of its panels."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.jobs.show.opening import open_given
from ehdmaps.jobs.show.plot import chosen_panels, plot_map, plot_panels, write_drawn
from ehdmaps.jobs.show.rough_plot import plot_roughness
from ehdmaps.outputs import FIGURE, TABLE, Output, check_outputs


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Draw the page and write it; by default beside the map, as PNG."""
    path = Path(arguments.map)
    asked = arguments.quantity, arguments.contact, arguments.temperature
    rough = arguments.roughness is not None and arguments.roughness != "smooth"
    usual = path.with_name(f"{path.stem}_roughness.png") if rough else path.with_suffix(".png")
    output = Path(arguments.output) if arguments.output else usual
    as_table = output.suffix.lower() == ".csv"
    if rough and (as_table or any(text is not None for text in asked)):
        raise InputError(
            "--roughness: got it with --quantity, --contact, --temperature or a table; allowed: on the page of rough "
            "surfaces alone"
        )
    check_outputs([Output("-o", output, TABLE if as_table else FIGURE)], [path])
    emap = open_given(path, arguments)
    if as_table:
        write_drawn(emap, chosen_panels(emap, *asked), output)
    elif any(text is not None for text in asked):
        plot_panels(emap, chosen_panels(emap, *asked), output)
    else:
        (plot_roughness if rough else plot_map)(emap, output)
    return f"{output}: written", 0

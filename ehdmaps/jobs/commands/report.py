"""`ehdmaps report`: a map as one file of HTML that can be sent, read without a network, and printed."""

from __future__ import annotations

import argparse
import shlex
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.jobs.budget.measured import map_budget
from ehdmaps.jobs.show.map_report import map_report
from ehdmaps.jobs.show.opening import choice_words, open_given
from ehdmaps.outputs import Output, check_outputs
from ehdmaps.report.page import REPORT, write_report


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Write the report; by default beside the map."""
    if arguments.catalogue:
        return _catalogue(arguments)
    path = Path(arguments.map)
    output = Path(arguments.output) if arguments.output else path.with_suffix(".html")
    check_outputs([Output("-o", output, REPORT)], [path])
    emap = open_given(path, arguments)
    words = ["ehdmaps", "report", path.name, *choice_words(arguments)]
    command = shlex.join([*words, "-o", output.name])
    write_report(output, map_report(emap, path.name, command, map_budget(emap)))
    return f"{output}: written", 0


def _catalogue(arguments: argparse.Namespace) -> tuple[str, int]:
    """Write the page that reads the film tables, of all bearings that catalogues have."""
    if arguments.map is not None:
        raise InputError(f"--catalogue: stands beside a map, {arguments.map}; allowed: alone, with -o")
    from ehdmaps.jobs.show.catalogue_page import catalogue_page

    output = Path(arguments.output or "catalogue.html")
    check_outputs([Output("-o", output, REPORT)])
    write_report(output, catalogue_page())
    return f"{output}: written", 0

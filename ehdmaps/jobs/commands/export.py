"""`ehdmaps export`: a map in the format of another program."""

from __future__ import annotations

import argparse
from pathlib import Path

from ehdmaps.errors import InputError
from ehdmaps.exports.target import find, listing
from ehdmaps.jobs.show.opening import open_given


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Write the map as the target that is asked for, or list the targets."""
    if arguments.list:
        return listing(), 0
    if arguments.map is None:
        raise InputError("MAP.nc: it is missing; allowed: the path of a map, or --list for the targets alone")
    path = Path(arguments.map)
    target = find(arguments.to)
    emap = open_given(path, arguments)
    output = Path(arguments.output) if arguments.output else None
    return target.write(emap, path, output, arguments), 0

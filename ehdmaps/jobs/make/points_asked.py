"""Tell whether a command is about a ball bearing, or the map of one, without loading a library."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from ehdmaps.outputs import MADE_AS, root_attributes
from ehdmaps.physics.designations.reader import BALLS, plain_name

MADE = "map of points"
"""What files of such maps say that they are."""

ENDING = ".nc"


def points_source(arguments: argparse.Namespace) -> str:
    """Designation of a ball bearing, or file of its map, that a command was given; empty for all else.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of generate, show, plot or export.
    """
    named = list(arguments.jobs) if arguments.command == "generate" else [arguments.map]
    given = [source for source in (*named, arguments.bearing) if source is not None]
    if len(given) != 1:
        return ""
    (source,) = given
    if not os.path.exists(source):
        return source if plain_name(source.partition(",")[0], BALLS) else ""
    if arguments.command == "generate" or not source.endswith(ENDING):
        return ""
    path = Path(source)
    return source if path.is_file() and root_attributes(path).get(MADE_AS) == MADE else ""

"""Band and window of levels, `--highest` and `--window`."""

from __future__ import annotations

import argparse
from typing import Any

from mbs.commands.common import read_option
from mbs.scene.fields import HERTZ, MILLISECOND
from mbs.scene.reader import HIGHEST_HIGHEST, LONGEST, LOWEST_HIGHEST, SHORTEST


def read_band(arguments: argparse.Namespace, problems: list[str]) -> dict[str, Any]:
    """Read the fields of `CampbellSettings` that are given.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments with `highest` and `window`.
    problems : list of str
        What is wrong is appended.
    """
    limits = (LOWEST_HIGHEST, HIGHEST_HIGHEST)
    found = {
        "highest": read_option("--highest", arguments.highest, "Hz", limits, HERTZ, problems),
        "window": read_option("--window", arguments.window, "s", (SHORTEST, LONGEST), MILLISECOND, problems),
    }
    return {name: value for name, value in found.items() if value is not None}

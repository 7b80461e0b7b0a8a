"""`mbs tradeoff`: what the choices of a scene cost, and how wrong they are, as table, netCDF, JSON and picture."""

from __future__ import annotations

import argparse
import dataclasses

from ehdmaps.errors import InputError
from ehdmaps.trade.data import TRADE, trade_json, write_trade
from ehdmaps.trade.text import trade_text
from mbs.analyses.campbell import campbell_problems
from mbs.commands.cases import read_compared
from mbs.commands.common import Told, read_option
from mbs.instruments.tradeoff import TradeoffSettings, tradeoff
from mbs.scene.choices import LawChoice
from mbs.scene.fields import HERTZ, MILLISECOND
from mbs.scene.reader import HIGHEST_HIGHEST, LONGEST, LOWEST_HIGHEST, SHORTEST
from mbs.scene.scene import Scene


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Measure, print and write."""
    scene, laws, clearance, settings = _asked(arguments)
    found = tradeoff(scene, laws, clearance, settings, Told("measurement"))
    written = write_trade(found, arguments.output, arguments.plot, arguments.all)
    if arguments.json:
        # What is written stands in no line: the output is JSON and nothing else.
        return trade_json(found), 0
    return "\n".join([trade_text(found, arguments.all), *written]), 0


def _asked(arguments: argparse.Namespace) -> tuple[Scene, list[LawChoice], float | None, TradeoffSettings]:
    """Read what is measured; all problems at once."""
    problems: list[str] = []
    highest = read_option("--highest", arguments.highest, "Hz", (LOWEST_HIGHEST, HIGHEST_HIGHEST), HERTZ, problems)
    window = read_option("--window", arguments.window, "s", (SHORTEST, LONGEST), MILLISECOND, problems)
    scene, laws, clearance = read_compared(arguments, problems, TRADE)
    if scene is None:
        raise InputError(tuple(dict.fromkeys(problems)))
    settings = dataclasses.replace(
        scene.campbell,
        sensor=arguments.sensor or scene.campbell.sensor,
        highest=scene.campbell.highest if highest is None else highest,
        window=scene.campbell.window if window is None else window,
    )
    runs = not arguments.linear_only
    if runs:
        problems += [f"{problem}; or --linear-only" for problem in campbell_problems(scene, settings)]
    if problems:
        raise InputError(tuple(dict.fromkeys(problems)))
    return scene, [law for law in laws if law.maps is not None], clearance, TradeoffSettings(settings, runs)

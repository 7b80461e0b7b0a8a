"""`tradeoff` of both programs: what choices cost, and how wrong they are, as table, netCDF, JSON and picture."""

from __future__ import annotations

import argparse
import dataclasses

from ehdmaps.errors import InputError, Problems
from ehdmaps.jobs.reader import read_job
from ehdmaps.program import tell
from mbs.analyses.campbell import campbell_problems
from mbs.commands.cases import read_compared
from mbs.commands.common import Told, read_band
from mbs.laboratory.tradeoff.contacts import measure
from mbs.laboratory.tradeoff.data import TRADE, check_trade_files, trade_json, write_trade
from mbs.laboratory.tradeoff.machines import TradeoffSettings, tradeoff
from mbs.laboratory.tradeoff.text import trade_text
from mbs.scene.scene import Scene
from mbs.scene.subject import LawChoice


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """`mbs tradeoff`: measure, print and write."""
    found = tradeoff(*_asked(arguments), Told("measurement"))
    written = write_trade(found, arguments.output, arguments.plot, arguments.all)
    if arguments.json:
        # What is written stands in no line: the output is JSON and nothing else.
        return trade_json(found), 0
    return "\n".join([trade_text(found, arguments.all), *written]), 0


def run_contacts(arguments: argparse.Namespace) -> tuple[str, int]:
    """`ehdmaps tradeoff`: measure, write what is asked for, and print the tables or JSON."""
    check_trade_files(arguments.output, arguments.plot, [arguments.job])
    found = measure(read_job(arguments.job), arguments.points, arguments.seed, arguments.openfoam, tell=tell)
    for line in write_trade(found, arguments.output, arguments.plot, arguments.all):
        tell(line)
    return trade_json(found) if arguments.json else trade_text(found, arguments.all), 0


def _asked(arguments: argparse.Namespace) -> tuple[Scene, list[LawChoice], float | None, TradeoffSettings]:
    """Read what is measured of a scene; all problems at once."""
    problems = Problems()
    band = read_band(arguments, problems)
    scene, laws, clearance = read_compared(arguments, problems, TRADE)
    if scene is None:
        raise InputError(problems)
    sensor = arguments.sensor or scene.campbell.sensor
    settings = dataclasses.replace(scene.campbell, sensor=sensor, **band)
    runs = not arguments.linear_only
    if runs:
        problems += [f"{problem}; or --linear-only" for problem in campbell_problems(scene, settings)]
    problems.check()
    return scene, [law for law in laws if law.maps is not None], clearance, TradeoffSettings(settings, runs)

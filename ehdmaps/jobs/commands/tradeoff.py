"""`ehdmaps tradeoff`: speed against accuracy of solvers at random points of a job."""

from __future__ import annotations

import argparse

from ehdmaps.jobs.instruments.tradeoff import measure
from ehdmaps.jobs.reader import read_job
from ehdmaps.program import tell
from ehdmaps.trade.data import check_trade_files, trade_json, write_trade
from ehdmaps.trade.text import trade_text


def run(arguments: argparse.Namespace) -> tuple[str, int]:
    """Measure, write what is asked for, and print the tables or JSON."""
    check_trade_files(arguments.output, arguments.plot, [arguments.job])
    job = read_job(arguments.job)
    trade = measure(job, arguments.points, arguments.seed, arguments.openfoam, tell=tell)
    for line in write_trade(trade, arguments.output, arguments.plot, arguments.all):
        tell(line)
    return trade_json(trade) if arguments.json else trade_text(trade, arguments.all), 0

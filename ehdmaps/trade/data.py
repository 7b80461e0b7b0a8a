"""A measurement of speed against accuracy as a labelled dataset, and as JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.outputs import FIGURE, MADE_AS, Output, check_outputs, dataset_kind, write_figure, written_aside
from ehdmaps.trade.answer import answer_lines, budget, budget_lines
from ehdmaps.trade.record import ErrorSummary, Trade

_PARTS = (
    ("errors", "", "error against the reference"),
    ("numerical", "numerical_", "numerical error, which a finer solution of the same model takes away"),
    ("model", "model_", "error of the model, which stays with its finest solution"),
)
_NUMBERS = {
    "points": "points compared",
    "median": "median of the sizes of the",
    "high": "95 % quantile of the sizes of the",
    "largest": "largest size of the",
    "bias": "median of the signed",
    "stated": "median that the choice states of itself, beside the",
    "covered": "share of the points at which the stated one is not below the",
}


def trade_dataset(trade: Trade) -> xr.Dataset:
    """Return a measurement as a dataset over choice and quantity.

    Parameters
    ----------
    trade : Trade
        The measurement.

    Returns
    -------
    xarray.Dataset
        Variables such as `median`, `numerical_median` and `model_median` (choice, quantity), NaN where nothing was
        compared, in the unit of `unit` (quantity); `seconds`, `solved`, `asked`, `default` and `group` (choice).
    """
    variables: dict[str, Any] = {
        "unit": ("quantity", [judged.unit for judged in trade.judged], {"long_name": "unit of the errors"}),
        "group": ("choice", [choice.group for choice in trade.choices], {"long_name": "what is chosen"}),
        "seconds": ("choice", [choice.seconds for choice in trade.choices], {"units": "s", "long_name": trade.cost}),
        "solved": ("choice", [choice.solved for choice in trade.choices], {"units": "1", "long_name": "points solved"}),
        "asked": ("choice", [choice.asked for choice in trade.choices], {"units": "1", "long_name": "points asked"}),
        "default": (
            "choice",
            np.array([choice.default for choice in trade.choices], dtype=np.int8),
            {"units": "1", "long_name": "1: what is used where nothing is said"},
        ),
        "against": (
            "choice",
            np.array([choice.reference for choice in trade.choices], dtype=object),
            {"long_name": "what the errors are relative to where that is not the reference of the measurement"},
        ),
        "lost": (
            "choice",
            np.array(["\n".join(choice.lost) for choice in trade.choices], dtype=object),
            {"long_name": "points without an answer"},
        ),
    }
    for part, prefix, words in _PARTS:
        table = [[getattr(choice, part).get(judged.name) for judged in trade.judged] for choice in trade.choices]
        for name, long_name in _NUMBERS.items():
            values = [[math.nan if cell is None else float(getattr(cell, name)) for cell in row] for row in table]
            variables[prefix + name] = (
                ("choice", "quantity"),
                np.array(values, dtype=np.float64),
                {"long_name": f"{long_name} {words}"},
            )
    worst = [
        [choice.errors[j.name].worst if j.name in choice.errors else "" for j in trade.judged]
        for choice in trade.choices
    ]
    variables["worst"] = (
        ("choice", "quantity"),
        np.array(worst, dtype=object),
        {"long_name": "place of the largest error"},
    )
    return xr.Dataset(
        variables,
        coords={
            "choice": [choice.label for choice in trade.choices],
            "quantity": [judged.name for judged in trade.judged],
        },
        attrs={
            "title": trade.title,
            "level": trade.level,
            "reference": trade.reference,
            "frame": "\n".join(trade.frame),
            "answer": "\n".join(answer_lines(trade)),
            "budget": "\n".join(budget_lines(trade)),
        },
    )


def trade_json(trade: Trade) -> str:
    """Return a measurement as JSON: fields of `Trade`, the answer, the error budget; null for what is not known.

    Parameters
    ----------
    trade : Trade
        The measurement.
    """
    record = {entry.name: getattr(trade, entry.name) for entry in fields(trade)}
    for name in ("judged", "scopes", "sources"):
        record[name] = [asdict(entry) for entry in getattr(trade, name)]
    record["answer"] = [*answer_lines(trade)]
    record["budget"] = [
        {
            "source": bar.name,
            "cost": _finite(bar.cost),
            "against": bar.against,
            "errors": {name: _summary(found) for name, found in bar.errors.items()},
        }
        for bar in budget(trade)
    ]
    record["choices"] = [
        {
            **{entry.name: getattr(choice, entry.name) for entry in fields(choice)},
            **{
                part: {name: _summary(summary) for name, summary in getattr(choice, part).items()}
                for part, *_ in _PARTS
            },
            "seconds": _finite(choice.seconds),
        }
        for choice in trade.choices
    ]
    return json.dumps(record, indent=2, allow_nan=False, ensure_ascii=False)


def _summary(summary: ErrorSummary) -> dict[str, object]:
    """The numbers of a summary."""
    return {name: _finite(value) for name, value in asdict(summary).items()}


def _finite(value: object) -> object:
    """A value, or None for a number that JSON does not know."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


_MADE_AS = "trade of ehdmaps"
TRADE = dataset_kind("a trade of ehdmaps", _MADE_AS)


def check_trade_files(output: str | None, plot: str | None, read: Iterable[str | Path]) -> None:
    """Make sure, before anything is computed, that the files may be written.

    Parameters
    ----------
    output, plot : str or None
        Paths given for -o and --plot.
    read : iterable of str or Path
        Files that the command reads.

    Raises
    ------
    InputError
        With what is wrong about them.
    """
    check_outputs([Output("-o", output, TRADE), Output("--plot", plot, FIGURE)], read)


def write_trade(trade: Trade, output: str | None, plot: str | None, everything: bool = False) -> list[str]:
    """Write what -o and --plot ask for; a line for each file.

    Parameters
    ----------
    trade : Trade
        The measurement.
    output, plot : str or None
        Paths of the netCDF file and of the picture.
    everything : bool
        Whether the picture has all choices in place of the error budget.

    Raises
    ------
    InputError
        If one cannot be written, or something else stands there.
    """
    lines = []
    if output is not None:
        with written_aside(output, TRADE) as aside:
            trade_dataset(trade).assign_attrs({MADE_AS: _MADE_AS}).to_netcdf(aside, engine="netcdf4", mode="w")
        lines.append(f"{output}: written")
    if plot is not None:
        from ehdmaps.trade.figure import RESOLUTION, trade_figure

        write_figure(trade_figure(trade, everything), plot, RESOLUTION)
        lines.append(f"{plot}: written")
    return lines

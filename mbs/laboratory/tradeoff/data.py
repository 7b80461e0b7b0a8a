"""A measurement of speed against accuracy as a labelled dataset, and as JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import is_dataclass
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray
from ehdmaps.outputs import FIGURE, MADE_AS, Output, check_outputs, dataset_kind, write_figure, written_aside
from ehdmaps.trade.record import Choice, ErrorSummary, Trade, budget
from mbs.laboratory.tradeoff.answer import answer_lines, budget_lines

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

    def each(value: Callable[[Choice], object], words: str, unit: str = "", kind: Any = None) -> tuple[Any, ...]:
        attributes = {"units": unit, "long_name": words} if unit else {"long_name": words}
        return "choice", np.array([value(choice) for choice in trade.choices], dtype=kind), attributes

    def cells(part: str, value: Callable[[ErrorSummary], Any], missing: Any, kind: Any) -> FloatArray:
        table = [[getattr(choice, part).get(judged.name) for judged in trade.judged] for choice in trade.choices]
        return np.array([[missing if one is None else value(one) for one in row] for row in table], dtype=kind)

    against = "what the errors are relative to where that is not the reference of the measurement"
    variables: dict[str, Any] = {
        "unit": ("quantity", [judged.unit for judged in trade.judged], {"long_name": "unit of the errors"}),
        "group": each(lambda choice: choice.group, "what is chosen"),
        "seconds": each(lambda choice: choice.seconds, trade.cost, "s"),
        "solved": each(lambda choice: choice.solved, "points solved", "1"),
        "asked": each(lambda choice: choice.asked, "points asked", "1"),
        "default": each(lambda choice: choice.default, "1: what is used where nothing is said", "1", np.int8),
        "against": each(lambda choice: choice.reference, against, kind=object),
        "lost": each(lambda choice: "\n".join(choice.lost), "points without an answer", kind=object),
    }
    for part, prefix, words in _PARTS:
        for name, long_name in _NUMBERS.items():
            values = cells(part, attrgetter(name), math.nan, np.float64)
            variables[prefix + name] = ("choice", "quantity"), values, {"long_name": f"{long_name} {words}"}
    worst = cells("errors", attrgetter("worst"), "", object)
    variables["worst"] = ("choice", "quantity"), worst, {"long_name": "place of the largest error"}
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
    bars = [
        {"source": bar.name, "cost": bar.cost, "against": bar.against, "errors": bar.errors} for bar in budget(trade)
    ]
    record = {**vars(trade), "answer": [*answer_lines(trade)], "budget": bars}
    return json.dumps(_plain(record), indent=2, allow_nan=False, ensure_ascii=False)


def _plain(value: Any) -> Any:
    """A value as JSON knows it; None for a number that is not finite."""
    if is_dataclass(value):
        value = vars(value)
    if isinstance(value, Mapping):
        return {name: _plain(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
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
        from mbs.laboratory.tradeoff.figure import trade_figure

        write_figure(trade_figure(trade, everything), plot)
        lines.append(f"{plot}: written")
    return lines

"""Files of a measurement of speed against accuracy, by the rule of all files that are written."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ehdmaps.outputs import FIGURE, MADE_AS, Output, check_outputs, dataset_kind, write_figure, written_aside
from ehdmaps.trade.data import trade_dataset
from ehdmaps.trade.record import Trade

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


def write_trade(trade: Trade, output: str | None, plot: str | None) -> list[str]:
    """Write what -o and --plot ask for; a line for each file.

    Parameters
    ----------
    trade : Trade
        The measurement.
    output, plot : str or None
        Paths of the netCDF file and of the picture.

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

        write_figure(trade_figure(trade), plot, RESOLUTION)
        lines.append(f"{plot}: written")
    return lines

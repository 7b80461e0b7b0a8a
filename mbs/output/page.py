"""Parts that the figures of the analyses share: heading, panels, grid, shade."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.patches import Patch
from matplotlib.ticker import ScalarFormatter

from ehdmaps.arrays import FloatArray
from ehdmaps.figures import SHADE, SHADE_ALPHA, typeset, write_heading
from mbs.model.relaxation import NOTABLE
from mbs.output.model_text import clearance_text, temperature_text
from mbs.scene.assembly import Model

_SIZE = (9.0, 5.5)

BAND_ALPHA = 0.2
"""Opacity of the bands of errors."""

BAND_WORDS = "band by errors of known size"
"""How figures call them."""

ESTIMATED = f"estimated error of the films above {100.0 * NOTABLE:g} %"
"""How figures call the range in which the films that an analysis has are notably wrong."""


def page(model: Model, words: str, panels: int, stacked: bool = False) -> tuple[Figure, list[Axes]]:
    """A figure with its heading and rows, or a stack, of at least so many panels; `words` follow the law.

    Parameters
    ----------
    model : Model
        What was computed, for the heading.
    words : str
        What the heading says after the law.
    panels : int
        Smallest number of panels.
    stacked : bool
        One panel above the other instead of rows.
    """
    figure = headed(model, words)
    rows = panels if stacked else max(round(math.sqrt(panels / 1.5)), 1)
    axes = figure.subplots(rows, math.ceil(panels / rows), sharex=stacked, squeeze=False)
    return figure, list(axes.ravel())


def headed(model: Model, words: str, size: tuple[float, float] = _SIZE, law: str | None = None) -> Figure:
    """A figure with its heading: title, law, `words`, temperature, clearance.

    Parameters
    ----------
    model : Model
        What was computed, for the heading.
    words : str
        What the heading says after the law.
    size : tuple[float, float]
        Width and height [inches].
    law : str, optional
        What the heading calls the law; that of the model if left out.
    """
    clearance = clearance_text(model)
    at = [
        *([words] if words else []),
        typeset(temperature_text(model)),
        *([f"clearance {typeset(clearance)}"] if clearance else []),
    ]
    figure = Figure(figsize=size, layout="constrained")
    # What a bearing is in operation takes a line of its own.
    end = "\n" if model.states else "; "
    write_heading(figure, f"{model.scene.title}\n{law or model.law}{end}{', '.join(at)}", 10)
    return figure


def grid(panel: Axes) -> None:
    """A quiet grid."""
    panel.grid(color="0.88", lw=0.5)
    panel.set_axisbelow(True)
    panel.tick_params(labelsize=8)


def shade(panel: Axes, begin: float, end: float, bottom: float = 0.0) -> None:
    """Shade a range of the horizontal axis behind what is drawn, from a part of the height on.

    Parameters
    ----------
    panel : Axes
        The panel.
    begin : float
        Left end of the range, in units of the axis.
    end : float
        Right end.
    bottom : float
        Part of the height at which the shade begins, 0 to 1.
    """
    panel.axvspan(begin, end, bottom, 1.0, color=SHADE, alpha=SHADE_ALPHA, lw=0.0, zorder=0)


def shade_handle(label: str) -> Patch:
    """Entry of a legend for the shade."""
    return Patch(color=SHADE, alpha=SHADE_ALPHA, lw=0.0, label=label)


_LOGARITHMIC = 0.8
"""Middle frequency over the mean of both ends, below which an axis goes as its frequencies, by factors."""


def frequency_scale(frequencies: FloatArray) -> str:
    """Scale of an axis of frequencies: logarithmic where they lie so, else linear.

    Parameters
    ----------
    frequencies : array
        Frequencies [Hz], rising.
    """
    first, middle, last = (float(frequencies[at]) for at in (0, frequencies.size // 2, -1))
    return "log" if first > 0.0 and middle < _LOGARITHMIC * 0.5 * (first + last) else "linear"


def left_out(figure: FigureBase, handles: Sequence[Artist], missing: int, columns: int = 3) -> None:
    """A legend below a figure, with a line on sensors that are not drawn; nothing where there is neither.

    Parameters
    ----------
    figure : matplotlib.figure.FigureBase
        The figure.
    handles : sequence of matplotlib.artist.Artist
        Entries of the legend.
    missing : int
        How many sensors are not drawn.
    columns : int
        Entries beside each other.
    """
    if handles or missing:
        figure.legend(
            handles=handles,
            title=f"{missing} more sensors not drawn" if missing else None,
            title_fontsize=7,
            loc="outside lower center",
            ncols=columns,
            fontsize=7,
            frameon=False,
        )


def whole_numbers(panel: Axes) -> None:
    """Write the numbers of a linear vertical axis in full: an offset or power of ten beside the axis is overlooked."""
    formatter = ScalarFormatter(useOffset=False)
    formatter.set_scientific(False)
    panel.yaxis.set_major_formatter(formatter)

"""Texts of a picture as boxes: those that run out of it, and titles that lie on each other."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from unittest.mock import patch

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

ROOM = 1.0
"""Pixels by which a box may stand out: letters are measured with their hints."""


@contextmanager
def drawn() -> Iterator[list[Figure]]:
    """Collect the figures that are saved."""
    found: list[Figure] = []
    save = Figure.savefig

    def saved(figure, *arguments, **more):
        found.append(figure)
        save(figure, *arguments, **more)

    with patch.object(Figure, "savefig", saved):
        yield found


def _boxes(figure: Figure) -> list[tuple[str, Bbox]]:
    """Boxes of all texts that can be seen but labels of ticks."""
    figure.canvas if isinstance(figure.canvas, FigureCanvasAgg) else FigureCanvasAgg(figure)
    figure.canvas.draw()
    ticks = {id(label) for axes in figure.axes for label in _tick_labels(axes)}  # also those beyond the axis
    texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
    return [(text.get_text(), text.get_window_extent()) for text in texts if id(text) not in ticks]


def _tick_labels(axes: Axes) -> list[Text]:
    """All labels of the ticks of a panel."""
    axis = [getattr(axes, name) for name in ("xaxis", "yaxis", "zaxis") if hasattr(axes, name)]
    return [text for one in axis for text in one.findobj(Text) if text is not one.label]


def cut_off(figure: Figure) -> list[str]:
    """Texts that are not all within the picture."""
    page = figure.bbox.padded(ROOM)
    return [
        words
        for words, box in _boxes(figure)
        if box.x0 < page.x0 or box.y0 < page.y0 or box.x1 > page.x1 or box.y1 > page.y1
    ]


def titles(figure: Figure) -> list[tuple[str, Bbox]]:
    """Heading, titles of panels, and lines at the foot, with their boxes."""
    _boxes(figure)
    found: list[Text] = [text for part in (figure, *figure.subfigs) for text in part.texts]
    for axes in figure.axes:
        found += [axes.title, axes._left_title, axes._right_title]
    return [(text.get_text(), text.get_window_extent()) for text in found if text.get_text().strip()]


def on_each_other(boxes: Sequence[tuple[str, Bbox]]) -> list[tuple[str, str]]:
    """Pairs of texts whose boxes overlap."""
    return [
        (first, second)
        for (first, box), (second, other) in itertools.combinations(boxes, 2)
        if Bbox.intersection(box.padded(-ROOM), other.padded(-ROOM)) is not None
    ]

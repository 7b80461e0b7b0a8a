"""Code that all commands share: options with a unit, the heading of the output, warnings, writing files."""

from __future__ import annotations

import argparse
import contextlib
import warnings
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from ehdmaps.choices import read_option
from ehdmaps.errors import Problems
from ehdmaps.outputs import write_figure
from ehdmaps.units import whole_number
from mbs.output.files import write_dataset
from mbs.scene.fields import HERTZ, MILLISECOND
from mbs.scene.scene import Scene
from mbs.settings import (
    CAGE_ANGLES,
    HIGHEST_HIGHEST,
    LONGEST,
    LOWEST_HIGHEST,
    MOST_ANGLES,
    NUMERICS,
    SHORTEST,
)

ALL = USUAL_BANDS = "all"
"""What `--bands` is called that finds bands of what is not known, and what is found where nothing is asked."""


def read_band(arguments: argparse.Namespace, problems: Problems) -> dict[str, Any]:
    """Read the fields of `CampbellSettings` that are given.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments, with `highest` and `window` where the command has them.
    problems : Problems
        What is wrong is appended.
    """
    found = {
        name: read_option(f"--{name}", getattr(arguments, name, None), unit, limits, display, problems)
        for name, unit, limits, display in (
            ("highest", "Hz", (LOWEST_HIGHEST, HIGHEST_HIGHEST), HERTZ),
            ("window", "s", (SHORTEST, LONGEST), MILLISECOND),
        )
    }
    return {name: value for name, value in found.items() if value is not None}


@contextlib.contextmanager
def chosen_workers(arguments: argparse.Namespace) -> Iterator[int | Executor]:
    """Processes of this machine that compute cases, or the engine that is named in their place, open in the block.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments, with `workers` and `executor`.

    Raises
    ------
    InputError
        If the engine is unknown, or does not answer.
    """
    from ehdmaps.jobs.executors import named_executor
    from ehdmaps.workers import available_cores

    with named_executor(arguments.executor, arguments.workers) as executor:
        yield (arguments.workers or available_cores()) if executor is None else executor


R = TypeVar("R")

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from ehdmaps.jobs.make.status import Bar, Lines


@dataclass(frozen=True, eq=False)
class Done(Generic[R]):
    """The result of a command's analysis, with what is to be said of the physics of its films.

    Attributes
    ----------
    result : R
        What the analysis gave.
    lines : tuple of str
        Lines for the beginning of the output.
    """

    result: R
    lines: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Looked:
    """Scope of an analysis, as far as the physics of its films depends on it.

    Attributes
    ----------
    scene : Scene
        The scene with the speeds, loads and clearances of the analysis.
    highest : float
        Highest frequency that matters [Hz]; 0 for an equilibrium.
    """

    scene: Scene
    highest: float


class Told:
    """Progress of an analysis on stderr: a callable that is told how much is done, and of how much.

    Parameters
    ----------
    unit : str
        What is counted, in the singular: step, hit.
    """

    def __init__(self, unit: str) -> None:
        self._unit = unit
        self._bar: Bar | Lines | None = None
        self._done = 0

    def __call__(self, done: int, total: int) -> None:
        """Begin with the first call; advance by what is new."""
        if self._bar is None:
            from ehdmaps.jobs.make.status import progress

            self._bar = progress(total, self._unit)
            self._bar.begin()
        if done > self._done:
            self._bar.solved(done - self._done)
            self._done = done


def write(arguments: argparse.Namespace, dataset: xr.Dataset | None, figure: Figure | None) -> list[str]:
    """Write what -o and --plot ask for; a line for each file.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments with `output` and `plot`.
    dataset : xarray.Dataset or None
        The result; it may be left out without -o.
    figure : matplotlib.figure.Figure or None
        The figure; None where there is none to draw.
    """
    lines = []
    if arguments.output and dataset is not None:
        path = Path(arguments.output)
        write_dataset(dataset, path)
        lines.append(f"{path}: written")
    if arguments.plot and figure is not None:
        lines += write_plot(figure, arguments.plot)
    return lines


def write_plot(figure: Figure, path: str) -> list[str]:
    """Write a figure; a line that says so, and what the library warned of.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    path : str
        The file.
    """
    from matplotlib.text import Text

    # Names of a scene are no formulas.
    for text in figure.findobj(Text):
        text.set_text(text.get_text().replace("$", r"\$"))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        write_figure(figure, path)
    return [f"{path}: written", *dict.fromkeys(f"warning: {path}: {entry.message}" for entry in caught)]


def read_cage_angles(arguments: argparse.Namespace, problems: Problems) -> int:
    """Read the number of cage angles of a linear analysis; that of the analysis where none is given.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments with `cage_angles`, or without it.
    problems : Problems
        Appended to.
    """
    text = getattr(arguments, "cage_angles", None)
    if text is not None:
        with problems.after("--cage-angles: "):
            return whole_number(text, 1, MOST_ANGLES)
    return CAGE_ANGLES


def with_bands(arguments: argparse.Namespace, problems: list[str]) -> bool:
    """Tell whether a command is to find the bands of what is not known: it is, but for `--bands numerics`.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments with `bands`, or without it.
    problems : list of str
        Appended to.
    """
    text = getattr(arguments, "bands", None) or USUAL_BANDS
    if text not in (ALL, NUMERICS):
        problems.append(f"--bands: got {text!r:.40}; allowed: {ALL}, {NUMERICS}; a number of runs with campbell alone")
    return bool(text != NUMERICS)


def out_of_place(arguments: argparse.Namespace, names: Iterable[str], words: str) -> list[str]:
    """Problems of options that are given where they mean nothing.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments of the command.
    names : iterable of str
        Options, by their attributes.
    words : str
        What is wrong, and what is allowed.
    """
    return [f"--{name.replace('_', '-')}: {words}" for name in names if getattr(arguments, name, None)]

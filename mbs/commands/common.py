"""What all commands share: the heading of the output, warnings, writing files."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from ehdmaps.errors import InputError
from ehdmaps.jobs.progress import Bar, Lines, progress
from ehdmaps.outputs import write_figure
from ehdmaps.units import RPM, Display, quantity
from mbs.analyses.case import clearance_text, temperature_text, weight_text
from mbs.analyses.film_errors import notable_from
from mbs.analyses.reach import axes_outside, sources_of
from mbs.analyses.resolution import Resolution
from mbs.analyses.rings import ring_motions
from mbs.analyses.soundness import Unsound
from mbs.bearings.bearing_force import BearingForce
from mbs.bearings.heat import HeatPaths
from mbs.commands.reach import outside_lines
from mbs.linearised.bands import error_words
from mbs.linearised.validity import NOTABLE, FilmError
from mbs.model.equilibrium import Equilibrium
from mbs.output.results import write_dataset
from mbs.output.state_text import state_lines
from mbs.scene.assembly import Model
from mbs.scene.contact_laws import FILM_WORDS
from mbs.scene.fields import HERTZ, MILLISECOND
from mbs.transient.numerical_damping import RESOLVED

if TYPE_CHECKING:
    from matplotlib.figure import Figure

RESOLUTION = 150

MICROSECOND = Display("us", 1e6)

ROUND_OFF = 1e-12
"""Size below which a part or a ratio is shown as zero: round-off."""


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
            self._bar = progress(total, self._unit)
            self._bar.begin()
        if done > self._done:
            self._bar.solved(done - self._done)
            self._done = done


def heading(model: Model, speed: float | None = None) -> list[str]:
    """What was analysed, and which of its numbers are assumptions."""
    at = "" if speed is None else f"{RPM.text(speed)}, "
    return [
        f"{model.scene.title}: law {model.law}",
        f"  {at}{temperature_text(model)}, clearance {clearance_text(model) or 'none'}, {weight_text(model)}; assumed: "
        + (f"{len(model.scene.assumed)} keys of the scene, marked there" if model.scene.assumed else "nothing"),
        *_estimated(model),
        *(
            f"  the weight of {name} is left out: its finite elements are held themselves, so that it bears on no "
            "other body"
            for name in model.system.weightless
        ),
        *state_lines(model.states),
        *model.warnings,
    ]


def _estimated(model: Model) -> list[str]:
    """A line for each kind of bearing whose inner geometry is an estimate."""
    found: dict[tuple[str, str], list[str]] = {}
    for entry in model.scene.bearings:
        if entry.geometry.estimated:
            found.setdefault((entry.geometry.name, entry.geometry.estimated), []).append(entry.name)
    return [f"  {name} ({', '.join(bearings)}): {words}" for (name, words), bearings in found.items()]


def held_lines(model: Model) -> list[str]:
    """A line on the temperatures of a run in time, where they follow from heat.

    Parameters
    ----------
    model : Model
        The model of the run.
    """
    if not any(isinstance(bearing.thermal, HeatPaths) for bearing in model.scene.bearings):
        return []
    return [f"  temperatures and clearances are held at those of {RPM.text(model.scene.speed)}, of [operation]"]


def band_lines(model: Model) -> list[str]:
    """A line on what the bands of a result hold; none without bearings.

    Parameters
    ----------
    model : Model
        The model.
    """
    words = error_words(model.system)
    return [f"  bands (+-): {words}"] if words else []


def unsound_lines(found: Iterable[Unsound], label: str = "") -> list[str]:
    """The first line of a result whose figures mean nothing, with the reasons; none of others.

    Parameters
    ----------
    found : iterable of Unsound
        Reasons why its figures mean nothing.
    label : str
        Which case, where several are compared.
    """
    words = "; ".join(entry.words for entry in found)
    return [f"error: {f'{label}: ' if label else ''}the figures below mean nothing: {words}"] if words else []


def marked(dataset: xr.Dataset, unsound: Sequence[str]) -> xr.Dataset:
    """A result of several cases with the attribute `unsound`, where lines say that figures mean nothing.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result.
    unsound : sequence of str
        Lines of `unsound_lines`.
    """
    return dataset.assign_attrs(unsound="; ".join(unsound)) if unsound else dataset


def film_law_line(model: Model, known: bool) -> list[str]:
    """A line on what films leave out of modes, and of their bands; none for laws without films, and at rest.

    Parameters
    ----------
    model : Model
        The model.
    known : bool
        Whether it is listed beside each mode.
    """
    if not model.scene.speed or not model.supplies:
        return []
    if known:
        return [
            "  film law: what one relaxation time of a slice leaves out of the response of the film solver, which the "
            "map holds: true less printed, to first order; in no band"
        ]
    if model.memory == "slow":
        return ["  film law: not known; films of slow motion leave out how films relax (--films memory has it)"]
    return ["  film law: not known; the law holds no response of the film solver, and no band holds this part"]


def clean(value: float) -> float:
    """The value, or 0 where it is round-off: of parts and ratios.

    Parameters
    ----------
    value : float
        A damping ratio, or a relative change.
    """
    return float(value) if abs(value) > ROUND_OFF else 0.0


def free_words(count: int) -> str:
    """How free motions are told, which have no frequency and no damping ratio.

    Parameters
    ----------
    count : int
        How many there are.
    """
    what = "1 free motion" if count == 1 else f"{count} free motions"
    return f"{what} at 0 Hz without strain energy, such as unloaded rollers"


def film_lines(errors: Sequence[FilmError], frequencies: Iterable[float], words: str = "") -> list[str]:
    """Lines on the estimated error of the films of each bearing at the highest frequency; none where there is none.

    Parameters
    ----------
    errors : sequence of FilmError
        Errors of the bearings.
    frequencies : iterable of float
        Frequencies of the result [Hz].
    words : str
        What follows the frequency, such as a speed.
    """
    highest = max(frequencies, default=0.0)
    lines = []
    for entry in errors:
        if entry.at_rest:
            lines.append(
                f"warning: {entry.bearing}: at rest no film: the stiffness is that of dry contacts, no damping"
            )
        elif highest > 0.0:
            lines.append(_film_line(entry, highest, words))
    return lines


def _film_line(entry: FilmError, frequency: float, words: str) -> str:
    """A line on one bearing; a warning where the error is notable."""
    error = entry.at(frequency)
    line = (
        f"{entry.bearing}: {FILM_WORDS[entry.films]}; estimated error of the dynamic stiffness along the load at "
        f"{frequency:.5g} Hz{words}: {100.0 * error:.2g} %"
        + (", by the response that the map holds" if entry.contacts else "")
    )
    if error <= NOTABLE:
        return line
    more = f"warning: {line}, from {entry.frequency:.4g} Hz on more than {100.0 * NOTABLE:g} %"
    return more + ("; with --films memory films follow at their own frequency" if entry.films == "slow" else "")


def step_lines(found: Resolution) -> list[str]:
    """Lines on what the steps of a run resolve, and on what the method takes from oscillations.

    Parameters
    ----------
    found : Resolution
        What they resolve.
    """
    high = min(found.highest, found.looked_at)
    losses = " and ".join(_lost(found, part * high) for part in (0.5, 1.0))
    taken = (
        "the method of integration takes no energy (spectral radius 1)"
        if found.spectral_radius == 1.0
        else f"numerical damping (spectral radius {found.spectral_radius:g}) takes {losses} of the energy of an "
        "oscillation in 1 s"
    )
    step = MICROSECOND.text(found.step) if found.step < 1e-3 else MILLISECOND.text(found.step)
    lines = [f"steps of {step}: {RESOLVED:g} a period at {HERTZ.text(found.highest)}; {taken}"]
    if found.unresolved:
        needed = MICROSECOND.text(found.needed, 3) if found.needed < 1e-3 else MILLISECOND.text(found.needed, 3)
        lines.append(
            f"warning: steps of {step} do not resolve what moves here: {', and '.join(found.unresolved)}; this run "
            f"is a row of equilibria at best; take steps of {needed} or less in [runup]"
        )
    return lines


def _lost(found: Resolution, frequency: float) -> str:
    """What an oscillation loses in a second, and the damping ratio that takes as much."""
    part = found.lost(frequency)
    words = f"{100.0 * part:.3g} %" if 1e-6 < part < 0.9995 else "less than 0.0001 %" if part < 0.5 else "all"
    return f"{words} at {HERTZ.text(frequency)} (a damping ratio of {found.ratio(frequency):.2g})"


def film_course(model: Model, speeds: Iterable[float]) -> list[str]:
    """A line on the frequencies up to which the films are nowhere notably wrong, at some speeds [rad/s]."""
    shown = []
    for speed in speeds:
        if speed == 0.0:
            continue
        (frequency,) = notable_from(model, np.array([speed]))
        if not np.isnan(frequency):
            words = f"{frequency:.4g} Hz" if np.isfinite(frequency) else "1 MHz and more"
            shown.append(f"{words} at {RPM.text(abs(speed))}")
    if not shown:
        return []
    return [
        f"{FILM_WORDS[model.memory]}: dynamic stiffness along the load with an estimated error of up to "
        f"{100.0 * NOTABLE:g} % up to {', '.join(shown)}"
    ]


def read_option(
    option: str, text: str | None, unit: str, limits: tuple[float, float], display: Display, problems: list[str]
) -> float | None:
    """Read a quantity of the command line within limits; None if absent or wrong, with the problem noted.

    Parameters
    ----------
    option : str
        Name of the option, such as "--highest".
    text : str or None
        What was given; None if it was left out.
    unit : str
        SI unit of the value.
    limits : (float, float)
        Smallest and largest value that is allowed, in SI.
    display : Display
        How messages show them.
    problems : list of str
        Appended to.
    """
    if text is None:
        return None
    try:
        value = quantity(text, unit)
    except InputError as error:
        problems.append(f"{option}: {error.problems[0]}")
        return None
    if not limits[0] <= value <= limits[1]:
        problems.append(f"{option}: got {text!r:.60}; allowed: {display.text(limits[0])} to {display.text(limits[1])}")
        return None
    return value


def outside_at(model: Model, balance: Equilibrium) -> list[str]:
    """Lines on bearings whose equilibrium lies outside the map.

    Parameters
    ----------
    model : Model
        The machine with its law.
    balance : Equilibrium
        The equilibrium.
    """
    if not any(balance.outside.values()):
        return []
    loads = {
        bearing.name: float(bearing.rollers(motion, balance.operation).load_per_length.max())
        for bearing, motion in ring_motions(model, balance.displacement)
        if isinstance(bearing.force, BearingForce)
    }
    axes = axes_outside(model, balance.operation.speed, loads)
    return outside_lines(balance.outside, "lies outside the map", axes, sources=sources_of(model))


def write(arguments: argparse.Namespace, dataset: xr.Dataset, figure: Figure | None) -> list[str]:
    """Write what -o and --plot ask for; a line for each file.

    Parameters
    ----------
    arguments : argparse.Namespace
        Arguments with `output` and `plot`.
    dataset : xarray.Dataset
        The result.
    figure : matplotlib.figure.Figure or None
        The figure; None where there is none to draw.
    """
    lines = []
    if arguments.output:
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
        write_figure(figure, path, RESOLUTION)
    return [f"{path}: written", *dict.fromkeys(f"warning: {path}: {entry.message}" for entry in caught)]

"""Modes of a report: their table, and Campbell diagrams from the linearised system or from a saved result."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ehdmaps.arrays import FloatArray, IntArray
from ehdmaps.errors import InputError
from ehdmaps.figures import COLOURS
from ehdmaps.netcdf_structure import DAMAGE, structure_problem
from ehdmaps.report.axis import linear_axis
from ehdmaps.report.chart import GREY, WIDE, Chart, Curve, Points, figure, number, shown
from ehdmaps.report.page import Markup, joined, table, tag
from ehdmaps.units import RPM
from mbs.analyses.modes import ModesResult
from mbs.linearised.sweep_result import Sweep
from mbs.output.band_text import about_lines, bounds_text, lost_lines, share_words, term_words, value_text
from mbs.output.files import RESULT
from mbs.output.model_text import band_lines, clean, film_law_line, film_lines, free_words
from mbs.output.reduction_text import reduction_lines
from mbs.output.result_text import kinds
from mbs.scene.assembly import Model
from mbs.scene.fields import HERTZ
from mbs.unknowns.held_open import held_open_of

MOST = 60
"""Modes that are listed."""


def mode_table(found: ModesResult, highest: float, banded: bool, names: Mapping[int, str]) -> Markup:
    """Return the oscillating modes up to a frequency.

    Parameters
    ----------
    found : ModesResult
        The modes.
    highest : float
        Highest frequency that is listed [Hz].
    banded : bool
        Whether bands of what is not known stand beside them.
    names : mapping of int to str
        Names of the modes by their indices.
    """
    all_modes = found.modes
    free, creeping, swinging = kinds(all_modes)
    listed = swinging[all_modes.frequency[swinging] <= highest][:MOST]
    if banded:
        return _banded_table(found, listed, highest, names)
    bands, law = all_modes.bands, all_modes.film_law
    rows = [
        (
            f"{k + 1}",
            names.get(int(k), ""),
            number(float(all_modes.frequency[k]), 5),
            *([number(float(bands.frequency[k]), 2)] if bands is not None else []),
            *([_part(float(law.frequency[k]))] if law is not None else []),
            number(clean(float(all_modes.damping_ratio[k])), 3),
            *([number(float(bands.damping_ratio[k]), 2)] if bands is not None else []),
            *([_part(float(law.damping_ratio[k]))] if law is not None else []),
            share_words(all_modes, int(k)),
        )
        for k in listed
    ]
    error = (*(("±",) if bands is not None else ()), *(("film law",) if law is not None else ()))
    heads = ("mode", "where", "frequency, Hz", *error, "damping ratio", *error, "strain energy")
    remarks = [
        f"{swinging.size - listed.size} more modes up to "
        f"{shown(HERTZ, float(all_modes.frequency[swinging].max(initial=0.0)))} are not listed."
        if swinging.size > listed.size
        else "",
        f"{creeping.size} motions creep back without oscillating." if creeping.size else "",
        f"{free_words(int(free.size), found.model.system)}." if free.size else "",
        f"{len(all_modes.lost)} modes could not be brought to the films of their own frequency and are not listed."
        if all_modes.lost
        else "",
        *(
            line.strip() + "."
            for line in (
                *band_lines(found.model, 0.0 if bands is None else bands.film_share),
                *film_law_line(found.model, law is not None),
                *reduction_lines(
                    found.balance.system,
                    all_modes.frequency[listed],
                    all_modes.damping_ratio[listed],
                    None if all_modes.reduction is None else all_modes.reduction.of(listed),
                ),
            )
        ),
        *film_lines(found.errors, all_modes.frequency[listed]),
    ]
    return joined(
        table(heads, rows, "Complex modes; the frequency is |eigenvalue|/(2π)", (0, 1, len(heads) - 1))
        if listed.size
        else tag("p", f"No mode oscillates below {shown(HERTZ, highest)}."),
        *(tag("p", remark, class_="says") for remark in remarks if remark),
    )


def _banded_table(found: ModesResult, listed: IntArray, highest: float, names: Mapping[int, str]) -> Markup:
    """The modes with what is not known of them, and what decides that."""
    bands, rows = found.bands_to(highest), []
    for k in listed.tolist():
        place, cells = bands.place(k), []
        for band, value in (
            (bands.frequency, found.modes.frequency[k]),
            (bands.damping_ratio, found.modes.damping_ratio[k]),
        ):
            cells += [number(float(value), 3) if place is None else value_text(band, place)]
            cells += ["-" if place is None else bounds_text(band, place)]
        decided = "-" if place is None else term_words(bands.frequency.largest(place))
        rows.append((f"{k + 1}", names.get(k, ""), *cells, decided, share_words(found.modes, k)))
    heads = ("mode", "where", "frequency, Hz", "90 %", "damping ratio", "90 %", "frequency decided by", "strain energy")
    lines = [
        *about_lines(found.model.scene, held_open_of(found.model), bands.told),
        *lost_lines(bands.frequency, [f"mode {k + 1}" for k in bands.chosen]),
    ]
    if not listed.size:
        return tag("p", f"No mode oscillates below {shown(HERTZ, highest)}.")
    words = "Complex modes; the frequency is |eigenvalue|/(2π); 90 % of what is not known of the machine"
    return joined(
        table(heads, rows, words, (0, 1, len(heads) - 2, len(heads) - 1)),
        *(tag("p", f"{line.strip()}.", class_="says") for line in lines),
        *(tag("p", line, class_="says") for line in film_lines(found.errors, found.modes.frequency[listed])),
    )


def _part(value: float) -> str:
    """Part that the film law leaves out; a dash where that is not known."""
    return number(value, 2) if math.isfinite(value) else "-"


LEAST_SHARE = 0.05
"""Part of the strain energy in bearings above which a mode has a colour."""

MOST_NAMED, MOST_ORDERS = 12, 10
MOST_DAMPED = 0.5
"""Damping ratio up to which a crossing is told: above, a response has hardly a peak by the mode."""

MOST_CASES = 6
"""Cases or laws of a result that are drawn."""

_SPEEDS, _FREQUENCIES, _CLASS = 70, 90, 6.0
"""Cells of a drawing of levels, and decibels of a class."""

_LEVELS = ("#f7f7f7", "#d9e4ef", "#b3cbe3", "#85abd3", "#5585bf", "#305f9e", "#1a3d73", "#0a1f44")


@dataclass(frozen=True, eq=False)
class Lines:
    """Frequencies of modes over speed.

    Attributes
    ----------
    speeds : ndarray, shape (n,)
        [rad/s].
    frequency, damping_ratio, share : ndarray, shape (n, modes)
        [Hz], [1], part of the strain energy in bearings [1]; NaN where a mode does not oscillate.
    number : ndarray, shape (modes,)
        Numbers of the modes, from 0 on.
    names : tuple of str
        Their names; empty, or none at all, where they are not known.
    """

    speeds: FloatArray
    frequency: FloatArray
    damping_ratio: FloatArray
    share: FloatArray
    number: FloatArray
    names: tuple[str, ...] = ()

    def told(self, mode: int) -> str:
        """Name of a mode, or its number.

        Parameters
        ----------
        mode : int
            Place of the mode, from 0 on.
        """
        return (self.names[mode] if self.names else "") or f"mode {int(self.number[mode]) + 1}"


@dataclass(frozen=True)
class Place:
    """Place of a diagram among several of a result.

    Attributes
    ----------
    number : int
        Number of the diagram, from 0 on.
    case : str
        Name of its case.
    begins : str
        Beginning of what is said.
    """

    number: int = 0
    case: str = ""
    begins: str = ""

    @property
    def name(self) -> str:
        """Name on the page."""
        return f"campbell-{self.number + 1}" if self.number else "campbell"


def lines_of(found: Sweep, names: tuple[str, ...] = ()) -> Lines:
    """Return the complex modes of a sweep.

    Parameters
    ----------
    found : Sweep
        The sweep.
    names : tuple of str
        Their names.
    """
    damped = found.damped
    return Lines(
        found.speeds,
        damped.frequency,
        damped.damping_ratio,
        damped.bearing_share,
        np.asarray(damped.number, dtype=np.float64),
        names,
    )


def read_result(path: str) -> xr.Dataset:
    """Read a result of `mbs sweep` or `mbs campbell`.

    Parameters
    ----------
    path : str
        The file.

    Raises
    ------
    InputError
        If it is none of them.
    """
    allowed = "allowed: a result of `mbs sweep -o` or `mbs campbell -o`"
    try:
        problem = "" if Path(path).is_file() else "no file"
        if problem or (problem := structure_problem(path)):
            raise OSError(problem)
        with xr.open_dataset(path, engine="netcdf4") as dataset:
            result = dataset.load()
    except DAMAGE as error:
        cause = " ".join(str(error).split()) or type(error).__name__
        raise InputError(f"--result: {path}: cannot be read ({cause:.200}); {allowed}") from error
    dims = {"complex_frequency": ("case", "speed", "complex_mode"), "level": ("law", "speed", "frequency")}
    fits = any(name in result and result[name].dims == order for name, order in dims.items())
    if not (RESULT.ours(Path(path)) and fits):
        raise InputError(f"--result: {path} holds no modes and no levels over speed; {allowed}")
    return result


def saved_campbell(dataset: xr.Dataset, orders: Sequence[tuple[float, str]], highest: float, source: str) -> Markup:
    """Return the diagram of a result that was saved.

    Parameters
    ----------
    dataset : xarray.Dataset
        What `read_result` gave.
    orders : sequence of (float, str)
        Orders that excite, with their names.
    highest : float
        Highest frequency that is drawn [Hz].
    source : str
        Name of the file.
    """
    dim, drawn = ("law", _levels) if "level" in dataset else ("case", _modes)
    names = [str(name) for name in dataset[dim].values]
    diagrams = [drawn(dataset.isel({dim: n}), orders, highest, source, n) for n in range(min(len(names), MOST_CASES))]
    left = tag("p", f"Not drawn: {', '.join(names[MOST_CASES:])}.") if len(names) > MOST_CASES else None
    return joined(*diagrams, left)


def _modes(one: xr.Dataset, orders: Sequence[tuple[float, str]], highest: float, source: str, n: int) -> Markup:
    """The modes over speed of a case."""
    lines = Lines(
        np.asarray(one["speed"].values, dtype=np.float64),
        one["complex_frequency"].values,
        one["complex_damping_ratio"].values,
        one["complex_bearing_share"].values,
        np.asarray(one["complex_number"].values, dtype=np.float64),
    )
    return campbell(lines, orders, highest, None, Place(n, str(one["case"].values), f"From {source}. "))


def campbell(
    lines: Lines, orders: Sequence[tuple[float, str]], highest: float, speed: float | None, place: Place | None = None
) -> Markup:
    """Return the diagram of modes over speed, with what excites them.

    Parameters
    ----------
    lines : Lines
        The modes.
    orders : sequence of (float, str)
        Orders that excite, with their names.
    highest : float
        Highest frequency that is drawn [Hz].
    speed : float or None
        Operating speed, which is marked [rad/s].
    place : Place or None
        Place among several diagrams.
    """
    place = place or Place()
    rpm = RPM.factor * lines.speeds
    inside = np.flatnonzero(np.any(lines.frequency <= highest, axis=0))
    with_bearings = bool(np.nanmax(lines.share, initial=0.0) > 0.0)
    shares = np.nanmax(lines.share, axis=0, initial=0.0)
    coloured = [int(k) for k in inside if not with_bearings or shares[k] >= LEAST_SHARE]
    coloured.sort(key=lambda k: float(np.nanmin(lines.frequency[:, k])))
    named = coloured[:MOST_NAMED]
    curves = [
        Curve(lines.told(k), lines.frequency[:, k], COLOURS[i % len(COLOURS)],
              ("", "8 3")[i // len(COLOURS) % 2], 1.8)
        for i, k in enumerate(named)
    ]  # fmt: skip
    others = [int(k) for k in inside if int(k) not in named]
    curves += [
        Curve("other modes" if i == 0 else "", lines.frequency[:, k], "#a8a8a8", "", 0.9, read=False)
        for i, k in enumerate(others)
    ]
    drawn = [(order, name) for order, name in orders if order * lines.speeds[0] / (2.0 * np.pi) < highest]
    drawn = drawn[:MOST_ORDERS]
    curves += _order_curves(lines.speeds, drawn)
    points = []
    crossings = _crossings(lines, drawn, named)
    if crossings:
        places = np.array([(at, frequency) for at, frequency, *_ in crossings])
        points.append(
            Points("order meets mode", RPM.factor * places[:, 0], places[:, 1], "ring", "#9b0d22"),
        )
    if speed is not None and lines.speeds[0] <= speed <= lines.speeds[-1]:
        curves.append(Curve("", np.full(rpm.size, np.nan), GREY, read=False))
        points.append(
            Points("operating speed", np.array([RPM.factor * speed]), np.array([np.nan]), "diamond", "#5a0010")
        )
    chart = Chart(
        place.name,
        "Frequencies of the modes over speed" + (f", {place.case}" if place.case else ""),
        place.begins + " ".join(_says(lines, crossings, speed)),
        linear_axis("speed", "rpm", rpm, from_zero=False),
        linear_axis("frequency", "Hz", np.array([0.0, highest])),
        rpm,
        curves,
        points,
        frame=WIDE,
    )
    return tag("div", figure(chart), class_="single")


def named_orders(model: Model) -> list[tuple[float, str]]:
    """Orders that a machine excites, with names: its loads that turn, meshes, what passes raceways, cages.

    Parameters
    ----------
    model : Model
        Scene with a law.

    Notes
    -----
    A standing outer ring is passed by rolling elements so often as BPFO says, a standing inner one as BPFI.
    """
    found: dict[float, list[str]] = {}

    def add(order: float, name: str) -> None:
        if math.isfinite(order) and order > 0.0:
            # rounded, for bearings that differ in the last bit only
            found.setdefault(round(order, 6), []).append(name)

    for load in model.system.turning:
        add(abs(load.order), f"{abs(load.order):g}x {', '.join(load.names)}")
    if not found:
        add(1.0, "1x")
    gears = {element.name for element in model.scene.gears}
    for connected in model.system.elements:
        one = connected.element.excitation
        element: Any = getattr(connected.element, "plain", connected.element)  # rollers that are bodies hold a bearing
        if one is None:
            continue
        if element.name in gears:
            words = element.name if "mesh" in element.name else f"mesh {element.name}"
            add(one.order, words)
            add(2.0 * one.order, f"2 {words}")
            continue
        passing = "BPFO" if not getattr(element, "outer_spin", 0.0) else "BPFI"
        spins = getattr(element, "inner_spin", 0.0), getattr(element, "outer_spin", 0.0)
        passing = passing if 0.0 in spins else "passing"
        add(one.order, f"{passing} {element.name}")
        add(one.order / element.count, f"cage {element.name}")
    return [(order, _names(names)) for order, names in sorted(found.items())]


def _names(names: Sequence[str]) -> str:
    """Names of one order: those of a kind share its word."""
    kinds: dict[str, list[str]] = {}
    for name in names:
        kind, _, own = name.rpartition(" ")
        kinds.setdefault(kind, []).append(own)
    return "; ".join(f"{kind} {', '.join(own)}".strip() for kind, own in kinds.items())


def _order_curves(speeds: FloatArray, orders: Sequence[tuple[float, str]]) -> list[Curve]:
    """Lines of the orders."""
    return [
        Curve(f"order {name}", order * speeds / (2.0 * np.pi), "#1a1a1a", f"{2 + 2 * i} 4", 1.0, False, name)
        for i, (order, name) in enumerate(orders)
    ]


def _crossings(
    lines: Lines, orders: Sequence[tuple[float, str]], modes: Sequence[int]
) -> list[tuple[float, float, str, str]]:
    """Crossings of orders with modes that are not much damped: speed [rad/s], frequency [Hz], order, mode."""
    crossings = []
    for order, name in orders:
        for k in modes:
            gap = lines.frequency[:, k] - order * lines.speeds / (2.0 * np.pi)
            for i in np.flatnonzero(np.isfinite(gap[:-1] * gap[1:]) & (gap[:-1] * gap[1:] <= 0.0)):
                if lines.damping_ratio[i, k] > MOST_DAMPED or gap[i] == gap[i + 1]:
                    continue
                part = float(gap[i] / (gap[i] - gap[i + 1]))
                speed = float(lines.speeds[i] + part * (lines.speeds[i + 1] - lines.speeds[i]))
                crossings.append((speed, order * speed / (2.0 * np.pi), name, lines.told(k)))
    return sorted(crossings)


def _says(lines: Lines, crossings: Sequence[tuple[float, float, str, str]], speed: float | None) -> list[str]:
    """Tell what the diagram says."""
    words = [
        "Coloured modes have at least 5 % of their strain energy in bearings; modes are those of the system "
        "linearised at the equilibrium of each speed."
    ]
    if not crossings:
        return [*words, "No order that excites meets one of them here."]
    near = min(crossings, key=lambda one: abs(one[0] - speed)) if speed is not None else crossings[0]
    return [
        *words,
        f"Orders meet them {len(crossings)} times; nearest to the operating speed is order {near[2]} with "
        f"{near[3]} at {number(RPM.value(near[0]))} rpm and {shown(HERTZ, near[1])}."
        if speed is not None
        else f"Orders meet them {len(crossings)} times, first order {near[2]} with {near[3]} at "
        f"{number(RPM.value(near[0]))} rpm and {shown(HERTZ, near[1])}.",
    ]


def _levels(one: xr.Dataset, orders: Sequence[tuple[float, str]], highest: float, source: str, n: int) -> Markup:
    """The levels of a run with a law over speed and frequency, in classes."""
    speeds, frequencies = (np.asarray(one[name].values, dtype=np.float64) for name in ("speed", "frequency"))
    level = np.asarray(one["level"].values, dtype=np.float64)
    level = level[np.argsort(speeds)]
    speeds = np.sort(speeds)
    unit = str(one["level"].attrs.get("units", "dB"))
    across, along = (min(speeds.size, _SPEEDS), min(frequencies.size, _FREQUENCIES))
    columns, rows = (
        np.linspace(0, size, parts + 1).astype(int)
        for size, parts in ((speeds.size, across), (frequencies.size, along))
    )
    coarse = np.array(
        [[np.nanmax(level[a:b, c:d], initial=-np.inf) for c, d in pairwise(rows)]
         for a, b in pairwise(columns)]
    )  # fmt: skip
    top = _CLASS * np.ceil(float(coarse[np.isfinite(coarse)].max(initial=0.0)) / _CLASS)
    classes = np.clip(len(_LEVELS) - 1 - ((top - np.nan_to_num(coarse, neginf=-1e9)) // _CLASS), 0, len(_LEVELS) - 1)
    rpm = RPM.factor * speeds
    x, y = linear_axis("speed", "rpm", rpm, from_zero=False), linear_axis("frequency", "Hz", frequencies)
    left = WIDE.across(x, rpm[np.minimum(columns, speeds.size - 1)])
    high = WIDE.along(y, frequencies[np.minimum(rows, frequencies.size - 1)])
    cells = []
    for i in range(across):
        line = classes[i]
        for run in np.split(np.arange(along), np.flatnonzero(np.diff(line)) + 1):
            path = f"M{left[i]:.1f} {high[run[0]]:.1f}H{left[i + 1]:.1f}V{high[run[-1] + 1]:.1f}H{left[i]:.1f}z"
            cells.append((int(line[run[0]]), path))
    behind = joined(
        *(
            tag("path", d="".join(path for of, path in cells if of == kind), fill=colour)
            for kind, colour in enumerate(_LEVELS)
        )
    )
    sums = np.asarray(one["sum_level"].values, dtype=np.float64) if "sum_level" in one else np.array([np.nan])
    loudest = int(np.nanargmax(sums)) if np.isfinite(sums).any() else 0
    begins = np.asarray(one["speed"].values, dtype=np.float64)
    chart = Chart(
        Place(n).name,
        f"Levels of a run over speed, {one['law'].values}",
        f"From {source}. The darkest class is {top - _CLASS:g} to {top:g} {unit}, each lighter one {_CLASS:g} dB less. "
        f"The sum level is highest, {number(float(sums[loudest]), 4)} {unit}, at "
        f"{number(RPM.value(float(begins[loudest])))} rpm.",
        x,
        y,
        rpm,
        _order_curves(speeds, orders[:MOST_ORDERS]),
        behind=behind,
        frame=WIDE,
    )
    return tag("div", figure(chart), class_="single")

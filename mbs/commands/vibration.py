"""`mbs bearing --vibration MASS`: vibration of a bearing on a test spindle, as ISO 15242 measures it."""

from __future__ import annotations

import argparse
import math
from typing import Any

import numpy as np

from ehdmaps.choices import texts_of
from ehdmaps.errors import InputError, Problems, short
from ehdmaps.outputs import Output, output_problems
from ehdmaps.physics.lubricant import DEFAULT_OIL
from ehdmaps.units import TEMPERATURE, Display
from mbs.commands.common import out_of_place
from mbs.one_bearing.family import Family
from mbs.one_bearing.shared import LOADS, read_one
from mbs.output.files import RESULT, described, write_dataset
from mbs.scene.choices import OPTIONS
from mbs.scene.fields import FORCE, MICROMETRE
from mbs.vibration import BANDS, SPEED, RingVibration, envelope_spectrum, ring_vibration

TAKEN = ("law", "clearance", "temperature")
"""Choices that it takes, each more than once."""

_USUAL = {"law": ("table", "hertz:1.25e-5 s"), "temperature": (293.15, 313.15, 343.15)}
"""Films and dry contacts; oils from cold to warm."""

_MASS = Display("kg")
_NEAR = 0.01
"""Part of an order by which a line of an envelope may miss it."""

_PERFECT = "waviness = []"


def run_vibration(arguments: argparse.Namespace, keys: str, family: Family) -> tuple[str, int]:
    """Run the bearing and its perfect twin with each clearance, oil temperature and law; the bands in words.

    Parameters
    ----------
    arguments : Namespace
        Options as they were parsed.
    keys : str
        Keys of deviations as a scene has them; empty for none.
    family : Family
        Family of the bearing.

    Raises
    ------
    InputError
        With every problem.
    AnalysisError
        If a run finds no solution.
    """
    others = (
        "load",
        "speed",
        "direction",
        "outer_speed",
        "tilts",
        "ring_temperatures",
        "permittivity",
        "plot",
        "coupled",
    )
    problems = Problems(out_of_place(arguments, others, "has no part in --vibration; leave it out"))
    chosen: dict[str, Any] = {}
    for choice in OPTIONS:
        if not (texts := texts_of(arguments, choice)):
            continue
        if choice.name not in TAKEN:
            allowed = f"--{', --'.join(TAKEN)}, --oil, --axial"
            problems.append(f"--{choice.name}: has no part in --vibration; allowed: {allowed}")
        elif choice.name == "law":
            chosen["law"] = texts
        else:
            chosen[choice.name] = choice.values(texts, problems)
    mass = read_one("--vibration", arguments.vibration, "kg", (1e-4, 1e3), _MASS, 0.0, problems)
    axial = read_one("--axial", arguments.axial, "N", (-LOADS[1], LOADS[1]), FORCE, 0.0, problems)
    if not axial:
        problems.append(f"--axial: got {short(arguments.axial)}; allowed: the load along the axis, such as 150 N")
    problems += output_problems([Output("-o", arguments.output, RESULT)])
    asked = family.read(arguments, {}, problems) if family.kind.axial else None
    if not family.kind.axial:
        problems.append(f"--vibration: got a {family.words}; allowed: bearings that carry axial load")
    if problems or asked is None:
        raise InputError(problems)
    known = getattr(asked.geometry, "clearance_range", None)
    clearances = () if known is None else (known.least - known.fit, asked.geometry.clearance, known.largest)
    oil = arguments.oil or DEFAULT_OIL
    text = arguments.bearing
    name = f"geometry = {text}" if text.lstrip().startswith("{") else text
    given: dict[str, Any] = {
        "temperatures": chosen.get("temperature", _USUAL["temperature"]),
        "laws": chosen.get("law", _USUAL["law"]),
        "clearances": chosen.get("clearance", clearances) or (None,),
        "oil": oil,
    }
    found = ring_vibration(name, keys or _PERFECT, axial, mass, **given)
    middle = {key: given[key][len(given[key]) // 2 :][:1] for key in ("temperatures", "clearances")}
    perfect = ring_vibration(name, _PERFECT, axial, mass, **{**given, **middle})
    several = len(given["temperatures"]) * len(given["clearances"]) > 1
    plays = [f"{MICROMETRE.text(play)}" for play in given["clearances"] if play is not None]
    lines = [
        f"{text}: {SPEED * 30.0 / math.pi:.0f} rpm, {axial:g} N along the axis, rigid outer ring of {1e3 * mass:g} g "
        "(ISO 15242; bending of the ring, cage, seals and dirt are not there)",
        f"radial velocity of the outer ring, rms, um/s, {'least to largest over ' if several else ''}{oil} at "
        + ", ".join(TEMPERATURE.text(kelvin) for kelvin in given["temperatures"])
        + (f" and clearance{'s' if plays[1:] else ''} of {', '.join(plays)}" if plays else ""),
        f"  {'':26s}" + "".join(f"{f'{low:.0f} to {high:.0f} Hz':>22s}" for low, high in BANDS),
    ]
    for law in given["laws"]:
        lines += [_row(law, found, law), _row("  of the perfect bearing", perfect, law)]
    if "spall" in keys:
        lines += _envelopes(found)
    if arguments.output:
        write_dataset(vibration_dataset(found, text, axial, mass), arguments.output)
        lines.append(f"{arguments.output}: written")
    return "\n".join(lines), 0


def _row(words: str, found: RingVibration, law: str) -> str:
    """Bands of a law in a line."""
    bands = [[_speed(value) for value in band] for band in (1e6 * found.band(law)).T]
    texts = [low if low == high else f"{low} to {high}" for low, high in bands]
    return f"  {words:26s}" + "".join(f"{text:>22s}" for text in texts)


def _speed(value: float) -> str:
    """A velocity [um/s]; what no sensor sees, a tenth of a nanometre a second, is the round-off of a run."""
    return f"{value:.3g}" if value > 1e-4 else "0"


def _envelopes(found: RingVibration) -> list[str]:
    """Largest line of the envelope of the high band in each case."""
    lines = [f"largest line of the envelope of {BANDS[2][0]:.0f} to {BANDS[2][1]:.0f} Hz:"]
    for (play, kelvin, law), signal in zip(found.cases, found.signals, strict=True):
        frequency, amplitude = envelope_spectrum(signal, found.rate, BANDS[2])
        seen = frequency > 0.2 * SPEED / (2.0 * math.pi)
        place = int(np.argmax(np.where(seen, amplitude, 0.0)))
        order = 2.0 * math.pi * frequency[place] / SPEED
        near = [word for word, one in found.orders.items() if abs(order / one - 1.0) < _NEAR]
        words = f"{law}, {TEMPERATURE.text(kelvin)}" + (f", {MICROMETRE.text(play)}" if play is not None else "")
        size = 1e6 * amplitude[place]
        lines.append(f"  {words:40s} order {order:.4g}, {', '.join(near) or 'none of the bearing'}, {size:.3g} um/s")
    return lines


def vibration_dataset(found: RingVibration, bearing: str, axial: float, mass: float) -> Any:
    """Bands and signals of all cases as a dataset.

    Parameters
    ----------
    found : RingVibration
        The cases.
    bearing : str
        The bearing, as it was typed.
    axial, mass : float
        Load along the axis [N] and mass of the outer ring [kg].
    """
    import xarray as xr

    plays, kelvins, laws = zip(*found.cases, strict=True)
    time = np.arange(found.signals.shape[1]) / found.rate
    columns = {
        "velocity_band": (("case", "band"), found.bands, "m/s", "radial velocity of the outer ring, rms of a band"),
        "velocity": (("case", "time"), found.signals, "m/s", "radial velocity of the outer ring"),
        "lowest_frequency": (("band",), [low for low, _ in BANDS], "Hz", "lowest frequency of the band"),
        "highest_frequency": (("band",), [high for _, high in BANDS], "Hz", "highest frequency of the band"),
        "clearance": (("case",), [math.nan if play is None else play for play in plays], "m", "diametral clearance"),
        "temperature": (("case",), list(kelvins), "K", "temperature of the oil"),
        "time": (("time",), time, "s", "time after the beginning has died away"),
    }
    data = {
        name: (dims, values, {"units": unit, "long_name": words})
        for name, (dims, values, unit, words) in columns.items()
    }
    dataset = xr.Dataset({**data, "law": (("case",), list(laws), {"long_name": "law of the contacts"})})
    return described(dataset, bearing=bearing, axial_load=f"{axial!r} N", ring_mass=f"{mass!r} kg")

"""Bands of one bearing: it is taken as the only bearing of a scene, of which the list of what is open is known."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.oil_supply import OilSupply
from ehdmaps.units import DAMPER, FILM, PRESSURE, SPRING
from mbs.output.band_text import Quantity, about_lines, lost_lines, quantity_lines
from mbs.output.one_bearing.kind import Description, Kind, row_of
from mbs.scene.scene import Scene
from mbs.scene.specs import BearingSpec, LocatingSpec
from mbs.unknowns.looks import Band
from mbs.unknowns.of_variables import variable_bands
from mbs.unknowns.statement import known
from mbs.unknowns.unknown import Unknown
from mbs.unknowns.words import open_lines

NAME = "bearing"
"""How the bearing is called."""

_MATRICES = (("K", "stiffness", SPRING), ("C", "damping", DAMPER))
_BESIDE = (
    *(("K along", "stiffness_along"), ("K axial", "stiffness_axial")),
    *(("C along", "damping_along"), ("film", "minimum_film")),
)
"""Numbers of which it is told what other oil supplies, and other axes of balls, change."""

_ELECTRIC = ("capacitance", "breakdown_low", "breakdown_high")
_CONTACTS = (("pressure", "hertz_pressure", PRESSURE, np.argmax), ("film", "minimum_film", FILM, np.nanargmin))


def scene_of(spec: BearingSpec | LocatingSpec, oil: Lubricant, told: Description, supply: OilSupply | None) -> Scene:
    """A scene of a bearing alone, to ask what is not known of it; it has no bodies.

    Parameters
    ----------
    spec : BearingSpec or LocatingSpec
        The bearing.
    oil : Lubricant
        Oil of the bearing.
    told : Description
        Temperature of its raceways, and how well its numbers are known.
    supply : OilSupply or None
        Oil supply as it is stated; None where it is not.
    """
    scene = Scene(name=NAME, speed=0.0, temperature=told.temperature, lubricant=oil, bodies=(), elements=(spec,))
    scene = dataclasses.replace(scene, supply=supply)
    # values are in force already
    return known(scene, tuple(dataclasses.replace(one, value=None) for one in told.known))


def turned(direction: tuple[float, float], angle: float) -> tuple[float, float]:
    """Direction of a load as a cage sees it that starts at an angle [rad].

    Examples
    --------
    >>> [round(part, 3) for part in turned((1.0, 0.0), math.pi / 2.0)]
    [0.0, -1.0]
    """
    c, s = math.cos(angle), math.sin(angle)
    return c * direction[0] + s * direction[1], c * direction[1] - s * direction[0]


def point_bands(
    kind: Kind,
    description: Description,
    point: Any,
    unknowns: Sequence[Unknown],
    again: Callable[[Scene], tuple[Description, Any]],
) -> dict[str, Band]:
    """Bands of the numbers of a point.

    Parameters
    ----------
    kind : Kind
        Kind of the bearing.
    description : Description
        What is told of it.
    point : object
        The point.
    unknowns : sequence of Unknown
        What is not known of the bearing as a scene.
    again : callable
        Gives description and point of a changed scene.
    """

    def numbers(told: Description, found: Any) -> dict[str, FloatArray]:
        row = row_of(kind, told, found)
        names = [f"{name}_{way}" for _, name, _ in _MATRICES for way in ("along", "across", "axial")]
        names += [name for _, name, _, _ in _CONTACTS] + ["central_film", "highest_raceway_load", *_ELECTRIC]
        return {name: np.asarray(row[name], dtype=np.float64) for name in names if name in row}

    centre = numbers(description, point)
    return variable_bands(lambda changed, _: numbers(*again(changed)), centre, unknowns, _numerics(point, centre))


def _numerics(point: Any, centre: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """Sizes of what stated errors of laws and films leave open of the numbers of a point: of those that have any."""
    from mbs.linearised.bands import law_bands  # with what linear analyses need

    laws, found = law_bands(point.balance), {}
    for (_, name, _), sizes in zip(_MATRICES, () if laws is None else laws.of_matrices()[:, 0], strict=False):
        parts = np.abs(point.axes) @ sizes[:3, :3] @ np.abs(point.axes).T
        for way, size in (("along", parts[0, 0]), ("across", parts[1, 1]), ("axial", sizes[0, 0])):
            found[f"{name}_{way}"] = np.asarray(size)
    found["minimum_film"] = point.film_error * centre["minimum_film"]
    return {name: size for name, size in found.items() if name in centre}


def point_lines(bands: dict[str, Band], scene: Scene, unknowns: Sequence[Unknown]) -> list[str]:
    """Table of the bands of one point, and what they hold.

    Parameters
    ----------
    bands : dict of str to Band
        What `point_bands` finds.
    scene : Scene
        The bearing as a scene.
    unknowns : sequence of Unknown
        What is not known of it.
    """
    some = next(iter(bands.values()))
    refused = [line for line in lost_lines(some.of(None), [""]) if "not in the bands" in line]
    lines = [
        *quantity_lines(list(_quantities(bands))),
        *refused,
        *open_lines(unknowns, ""),
        *about_lines(scene, unknowns, {words: bands[name] for words, name in _BESIDE if name in bands}),
    ]
    return [line.replace(f" of {NAME}", "") for line in lines]  # there is no other


def _quantities(bands: dict[str, Band]) -> Iterator[Quantity]:
    """K and C, pressure and film of the worse contact, and the highest load."""
    for letter, name, shown in _MATRICES:
        for way in ("along", "across", "axial"):
            if (found := bands.get(f"{name}_{way}")) is not None:
                yield Quantity("", f"{letter} {way}", shown.unit, found.scaled(shown.factor))
    for words, name, shown, worst in _CONTACTS:
        if name in bands and np.isfinite(bands[name].value).any():
            yield Quantity("", words, shown.unit, bands[name].of(int(worst(bands[name].value))).scaled(shown.factor))
    yield Quantity("", "highest load", "N", bands["highest_raceway_load"])
    if "capacitance" in bands and np.isfinite(bands["capacitance"].value).all():
        yield Quantity("", "capacitance", "pF", bands["capacitance"].scaled(1e12))

"""What films do to the modes of a rotor on ball bearings: by their thickness, or by their stiffness.

Run: python -m tests.benchmarks.bench_ball_angle [SPEED in rpm]

The machine is the shipped electric drive. Its modes are compared with dry contacts, with the films of the table, and
with two halves of these: the film offset as it is at the mean load of the balls, the same at all loads, so that the
contact keeps its dry stiffness at a load, and only geometry, contact angle and preload change; and what the offset
changes with the load beside that, film stiffness alone. Preloaded by a spring, and with the ring held where the dry
spring pushes it.

References
----------
Y. H. Wijnant, J. A. Wensing, G. C. van Nijen, The influence of lubrication on the dynamic behaviour of ball bearings,
Journal of Sound and Vibration 222 (4), 1999, 579-596: eigenfrequencies change mainly as the contact angle does.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from unittest.mock import patch

import numpy as np

import mbs.bearings.balls.films as ball_films_module
from ehdmaps.arrays import FloatArray
from mbs import assemble, parse_scene, read_scene
from mbs.analyses.modes import modes
from mbs.bearings.balls.laws import FilmCurve, film_normal_law
from mbs.model.elements import Operation
from mbs.scene.locating.ball_films import _film_law as made_film_law
from mbs.scene.locating.ball_films import _films_at as read_films

MEAN_LOAD = 100.0
"""Load of a ball at which the offset is held [N]."""

LOWEST, HIGHEST, WALL = 10.0, 2500.0, 1e10
"""Modes that are shown [Hz], and the spring that holds the ring [N/m]."""

LAWS = ("dry", "offset alone", "stiffness alone", "films")


def split(law: str) -> Callable[..., object]:
    """`film_normal_law` with one half of the film."""

    def made(contact: object, curve: FilmCurve, loads: tuple[float, float]) -> object:
        (held,), _, _ = curve(np.array([MEAN_LOAD]))

        def part(load: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
            offset, slope, damping = curve(load)
            if law == "offset alone":
                return np.full_like(offset, held), np.zeros_like(slope), damping
            return offset - held, slope, damping

        return film_normal_law(contact, curve if law == "films" else part, loads)  # type: ignore[arg-type]

    return made


def main(speed: float = 6000.0) -> None:
    """Print the modes of each law, and what the films change.

    Parameters
    ----------
    speed : float
        Of the shaft [rpm].
    """
    scene = read_scene("electric_drive")
    places: dict[str, float] = {}
    for held in (False, True):
        print("ring held where the dry preload pushes it" if held else "preload of 300 N by the wave spring")
        dry = np.zeros(0)
        for law in LAWS:
            used = scene
            if held:
                text = scene.text.replace('{ x = "1e5 N/m" }', f'{{ x = "{WALL:g} N/m" }}')
                text = text.replace('"300 N"', f'"{WALL * places[LAWS[0]]:.9g} N"')
                used = parse_scene(text, scene.name, "electric_drive.toml")
            made_film_law.cache_clear()
            read_films.cache_clear()  # laws are kept by their oil, speed and temperature
            with patch.object(ball_films_module, "film_normal_law", split(law)):
                model = assemble(used, "hertz" if law == LAWS[0] else "table")
                found = modes(model, Operation(speed * math.pi / 30.0))
            moved = found.balance.displacement
            ring = model.system.relative("ring", "ground") @ moved
            places.setdefault(law, float(ring[0]))
            bearing = model.balls[0]
            balls = bearing.loads(
                model.system.relative(bearing.inner, bearing.outer) @ found.balance.displacement,
                found.balance.operation,
            )
            frequency = np.array(found.modes.frequency)
            frequency = frequency[(frequency > LOWEST) & (frequency < HIGHEST)]
            dry = frequency if law == LAWS[0] else dry
            if frequency.size != dry.size:
                apart = "other modes"
            else:
                apart = " ".join(f"{100.0 * x:+.2f}" for x in frequency / dry - 1.0)
            angle = float(np.degrees(np.mean(balls.contact_angle[0])))
            print(f"  {law:16s} ring {1e6 * ring[0]:7.2f} um, angle {angle:6.2f} deg; modes "
                  f"{' '.join(f'{x:.1f}' for x in frequency)} Hz; {apart} %")  # fmt: skip


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))

"""Films of tapered rollers of some shape, without an oil."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from mbs.bearings.tapered.line_film import LineFilms, line_film
from mbs.bearings.tapered.tapered_bearing import TaperedForce


def made_up_films(geometry):
    """Lines with films of some shape by the entrainment speed: offset, soft begin and damping."""
    length = geometry.roller_length
    stiff = TaperedForce(geometry).dry_law.inner.coefficient / length

    def made_up(u, temperature):
        def evaluate(delta, rate):
            x, bend = delta + 0.5e-6 * u**0.7, 0.2e-6 * u**0.5
            root = np.sqrt(x * x + bend * bend)
            g = 0.5 * (x + root)
            return stiff * g ** (10.0 / 9.0), stiff * 10.0 / 9.0 * g ** (10.0 / 9.0) / root, 2e5 + 4e9 * g / u + rate

        return SimpleNamespace(evaluate=evaluate)

    def films(u):
        made = line_film(SimpleNamespace(at=made_up), length, u, 313.15)
        return LineFilms(made, made, (1e2 * length, 2e6 * length))

    return films

"""Where a linear analysis is not valid: contacts that lift off, motion above the low-frequency limit of the films."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ehdmaps.arrays import FloatArray
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.solids import reduced_modulus
from mbs.bearings.bearing import Bearing
from mbs.bearings.bearing_element import RingElement
from mbs.linearised.dynamic import element_dynamic_stiffness
from mbs.linearised.linear import responses
from mbs.model.elements import Input
from mbs.model.equilibrium import Equilibrium

NOTABLE = 0.05
"""Error of the dynamic stiffness of a bearing above which it is told."""

HIGHEST_RATIO = 0.3
"""omega b/u above which stiffness and damping of the low-frequency limit are no longer valid."""


@dataclass(frozen=True)
class FilmLimit:
    """How quick an oscillation a film follows as in the low-frequency limit.

    Attributes
    ----------
    bearing : str
        Name of the bearing.
    half_width : float
        Hertz half-width b of the most loaded contact [m].
    entrainment_speed : float
        u [m/s].
    """

    bearing: str
    half_width: float
    entrainment_speed: float

    def ratio(self, frequency: float) -> float:
        """omega b/u at a frequency [Hz]; infinite at standstill."""
        if self.entrainment_speed == 0.0:
            return math.inf
        return 2.0 * math.pi * frequency * self.half_width / self.entrainment_speed

    @property
    def frequency(self) -> float:
        """Frequency at which omega b/u is 0.3 [Hz]."""
        if self.half_width == 0.0:
            return math.inf
        return HIGHEST_RATIO * self.entrainment_speed / (2.0 * math.pi * self.half_width)


@dataclass(frozen=True, eq=False)
class SlowFilmError:
    """How far stiffness and damping of slow motion are from those of films that relax, along the load of a bearing.

    Attributes
    ----------
    bearing : str
        Name of the bearing.
    stiffness, damping : float
        k [N/m] and c [N s/m] of slow motion.
    springs, times : array, shape (r,)
        Stiffness [N/m] and relaxation time [s] of each slice, as of `mbs.model.relaxation`.
    """

    bearing: str
    stiffness: float
    damping: float
    springs: FloatArray
    times: FloatArray

    def error(self, frequencies: FloatArray) -> FloatArray:
        """|Z of slow motion - Z|/|Z| at frequencies (k,) [Hz], Z with films that relax."""
        s = 2j * np.pi * np.asarray(frequencies, dtype=np.float64)
        place = np.multiply.outer(s, self.times)
        more = -(place**2 / (1.0 + place)) @ self.springs
        return np.asarray(np.abs(more) / np.abs(self.stiffness + s * self.damping + more), dtype=np.float64)

    def at(self, frequency: float) -> float:
        """The error at one frequency [Hz]."""
        return float(self.error(np.array([frequency]))[0])

    @property
    def frequency(self) -> float:
        """Lowest frequency at which the error is `NOTABLE` [Hz], between 1 Hz and 1 MHz; infinite if it never is."""
        grid = np.geomspace(1.0, 1e6, 601)
        above = np.flatnonzero(self.error(grid) > NOTABLE)
        return float(grid[above[0]]) if above.size else math.inf


def film_limit(name: str, bearing: Bearing, load: float, entrainment_speed: float) -> FilmLimit:
    """Limit of a bearing at the load per unit length of its most loaded contact [N/m] and a speed u [m/s].

    The outer contact is the wider one.

    Parameters
    ----------
    name : str
        Name of the bearing.
    bearing : Bearing
        The bearing.
    load : float
        Load of its most loaded contact, per unit length [N/m].
    entrainment_speed : float
        u [m/s].
    """
    modulus = reduced_modulus(bearing.material, bearing.material)
    width = half_width(load, bearing.geometry.outer_radius, modulus)
    return FilmLimit(name, width, entrainment_speed)


@dataclass(frozen=True)
class DynamicLoad:
    """Largest dynamic force of an element in a linear analysis, beside its static one.

    Attributes
    ----------
    element, input : str
        Which, and excited by what.
    dynamic, static : float
        Radial forces [N], at the amplitude of the input.
    frequency : float
        Frequency at which the dynamic load is largest [Hz].
    """

    element: str
    input: str
    dynamic: float
    static: float
    frequency: float

    @property
    def exceeds(self) -> bool:
        """Whether contacts would lift off, so that a linear analysis is not valid."""
        return self.dynamic > self.static


def dynamic_loads(balance: Equilibrium, inputs: Sequence[Input], frequencies: FloatArray) -> tuple[DynamicLoad, ...]:
    """Largest dynamic force of each bearing for each input.

    Parameters
    ----------
    balance : Equilibrium
        Equilibrium to linearise at.
    inputs : sequence of Input
        Inputs with their amplitudes.
    frequencies : array, shape (frequencies,)
        [Hz].
    """
    found: list[DynamicLoad] = []
    if not inputs or not frequencies.size:
        return ()
    s = np.asarray(2j * np.pi * frequencies, dtype=np.complex128)
    motion = responses(balance, inputs, frequencies) * np.array([entry.amplitude for entry in inputs])
    for index in balance.system.select(RingElement):
        connected = balance.system.elements[index]
        ports = np.einsum("mn,fni->fmi", connected.transform, motion)
        force = element_dynamic_stiffness(balance, index, s) @ ports
        # The first port of a bearing is the inner ring, its rows 1 and 2 are y and z.
        size = np.linalg.norm(force[:, 1:3], axis=1)
        static = float(np.linalg.norm(balance.forces[index][1:3]))
        for i, entry in enumerate(inputs):
            worst = int(np.argmax(size[:, i]))
            found.append(
                DynamicLoad(
                    connected.element.name, entry.name, float(size[worst, i]), static, float(frequencies[worst])
                )
            )
    return tuple(found)

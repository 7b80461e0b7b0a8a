"""Vibration of a bearing on a test spindle, as ISO 15242 measures it: velocity of its outer ring in three bands.

The inner ring turns on a rigid spindle, the outer one is pushed along the axis, and is otherwise free: a sensor has its
radial velocity. ISO 15242-2 runs radial ball bearings at 1800 rpm and takes root mean squares over 50 to 300 Hz, 300 to
1800 Hz and 1800 Hz to 10 kHz. Here the ring is rigid, so that its bending modes, which lie in the upper band of larger
bearings, are not there, and neither is noise of cage, seal and dirt.

References
----------
ISO 15242-1:2015 and ISO 15242-2:2015, Rolling bearings - Measuring methods for vibration, parts 1 and 2.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from ehdmaps.arrays import FloatArray
from ehdmaps.errors import InputError
from mbs.model.equilibrium import equilibrium
from mbs.model.profiles import SpeedProfile
from mbs.scene.assembly import assemble
from mbs.scene.reader import parse_scene
from mbs.settings import Settings
from mbs.transient.run import run

SPEED = 2.0 * math.pi * 30.0
"""Speed of the spindle, 1800 rpm [rad/s]."""

BANDS = ((50.0, 300.0), (300.0, 1800.0), (1800.0, 10000.0))
"""Low, medium and high band [Hz]."""

STEP, BEGINNING = 1e-5, 0.3
"""Length of a step, and of what is left out while the beginning dies away [s]."""

_SCENE = """
schema = 1
title = "test spindle"
[operation]
speed = "1800 rpm"
temperature = "{temperature} K"
[lubricant]
name = "{oil}"
[[bodies]]
name = "spindle"
freedoms = ["theta_x"]
spin = 1
mass = "1 kg"
polar_inertia = "1 kg m^2"
transverse_inertia = "1 kg m^2"
[[bodies]]
name = "ring"
freedoms = ["x", "y", "z", "theta_y", "theta_z"]
mass = "{mass} kg"
polar_inertia = "{polar} kg m^2"
transverse_inertia = "{across} kg m^2"
[[springs]]
name = "drive"
on = "spindle"
stiffness = {{ theta_x = "1e3 N m/rad" }}
[[loads]]
name = "push"
on = "ring"
force = ["{axial} N", "0 N", "0 N"]
[[sensors]]
name = "radial"
on = "ring"
direction = "y"
quantity = "velocity"
[[bearings]]
name = "tested"
inner = "spindle"
outer = "ring"
{bearing}
{clearance}
{keys}
"""


@dataclass(frozen=True, eq=False)
class RingVibration:
    """Velocity of the outer ring of a bearing in some cases.

    Attributes
    ----------
    cases : tuple of (float or None, float, str)
        Diametral clearance [m], None as the bearing has it; temperature of the oil [K]; law.
    bands : array (cases, 3)
        Root mean squares of the low, medium and high band [m/s].
    rate : float
        Samples a second of the signals [Hz].
    signals : array (cases, samples)
        Radial velocity of the outer ring [m/s].
    orders : mapping of str to float
        Orders of the bearing by their names, for each turn of the spindle.
    """

    cases: tuple[tuple[float | None, float, str], ...]
    bands: FloatArray
    rate: float
    signals: FloatArray
    orders: Mapping[str, float]

    def band(self, law: str) -> FloatArray:
        """Least and largest velocity of each band over all cases of a law, shape (2, 3) [m/s].

        Parameters
        ----------
        law : str
            The law.
        """
        own = self.bands[[case[2] == law for case in self.cases]]
        return np.array([own.min(axis=0), own.max(axis=0)])


def ring_vibration(
    bearing: str,
    deviations: str,
    axial: float,
    mass: float,
    *,
    clearances: Sequence[float | None] = (None,),
    temperatures: Sequence[float] = (303.15,),
    laws: Sequence[str] = ("table", "hertz:1.25e-5 s"),
    oil: str = "FVA3",
    duration: float = 1.0,
) -> RingVibration:
    """Run a bearing on the test spindle, with each clearance, temperature of the oil and law.

    Parameters
    ----------
    bearing : str
        Designation of a bearing that carries axial load, or its key `geometry` of `[[bearings]]`.
    deviations : str
        Keys `waviness`, `size_difference` and `spall` of `[[bearings]]` in a scene.
    axial : float
        Load along the axis [N].
    mass : float
        Mass of the outer ring [kg].
    clearances : sequence of float or None
        Diametral clearances [m]; None for that of the designation.
    temperatures : sequence of float
        Temperatures of the oil [K].
    laws : sequence of str
        Laws, by default with films and dry.
    oil : str
        Name of the oil.
    duration : float
        Time that is looked at [s].

    Raises
    ------
    InputError
        For what a scene does not take.
    AnalysisError
        If a run finds no solution.
    """
    if not (duration > 0.0 and axial != 0.0 and mass > 0.0):
        raise InputError(
            f"vibration: got {duration!r} s, {axial!r} N and {mass!r} kg; allowed: a duration > 0 s, an axial load "
            "other than 0 N and a mass of the outer ring > 0 kg"
        )
    cases = tuple((play, kelvin, law) for law in laws for kelvin in temperatures for play in clearances)
    signals = []
    for play, kelvin, law in cases:
        # a ring has its mass at a distance of some 25 mm: tilts have no part in the radial motion of its middle
        text = _SCENE.format(
            temperature=kelvin,
            oil=oil,
            mass=mass,
            polar=mass * 6e-4,
            across=mass * 3e-4,
            axial=-axial,
            bearing=bearing if "=" in bearing else f'bearing = "{bearing}"',
            clearance="" if play is None else f'diametral_clearance = "{1e6 * play} um"',
            keys=deviations,
        )
        model = assemble(parse_scene(text, "test spindle", "test spindle"), law)
        start = equilibrium(model.system, model.operation).displacement
        settings, course = Settings(step=STEP, sample=2.0 * STEP), SpeedProfile.constant(SPEED)
        found = run(model.system, course, BEGINNING + duration, settings, model.scene.sensors, start)
        signals.append(found.signals[found.time >= BEGINNING, 0])
    rate = 0.5 / STEP
    data: Any = getattr(model.system.elements[0].element, "deviation_data", None)
    orders = {} if data is None else data.named_orders()
    return RingVibration(cases, np.array([band_levels(one, rate) for one in signals]), rate, np.array(signals), orders)


def band_levels(signal: FloatArray, rate: float, bands: Sequence[tuple[float, float]] = BANDS) -> FloatArray:
    """Root mean square of a signal in some bands, by its spectrum, shape (bands,).

    Parameters
    ----------
    signal : array (samples,)
        The signal.
    rate : float
        Samples a second [Hz].
    bands : sequence of (float, float)
        Lowest and highest frequency of each [Hz].

    Examples
    --------
    >>> time = np.arange(20000) / 20000.0
    >>> [round(float(one), 3) for one in band_levels(np.sin(2.0 * np.pi * 500.0 * time), 20000.0)]
    [0.0, 0.707, 0.0]
    """
    window = scipy.signal.windows.hann(signal.size, sym=False)
    power = 2.0 * np.abs(np.fft.rfft(signal * window)) ** 2 / (signal.size * np.sum(window**2))
    frequency = np.fft.rfftfreq(signal.size, 1.0 / rate)
    return np.array([math.sqrt(float(np.sum(power[(low <= frequency) & (frequency < high)]))) for low, high in bands])


def envelope_spectrum(signal: FloatArray, rate: float, band: tuple[float, float]) -> tuple[FloatArray, FloatArray]:
    """Spectrum of the envelope of a signal in a band, where the blows of a spall ring: frequencies [Hz] and amplitudes.

    Parameters
    ----------
    signal : array (samples,)
        The signal.
    rate : float
        Samples a second [Hz].
    band : (float, float)
        Lowest and highest frequency of the band [Hz].

    References
    ----------
    R. B. Randall, J. Antoni, Rolling element bearing diagnostics - a tutorial, Mechanical Systems and Signal Processing
    25, 2011, 485-520, section 3.
    """
    frequency = np.fft.fftfreq(signal.size, 1.0 / rate)
    # the analytic signal of the band alone
    spectrum = np.where((band[0] <= frequency) & (frequency < band[1]), 2.0 * np.fft.fft(signal), 0.0)
    envelope = np.abs(np.fft.ifft(spectrum))
    window = scipy.signal.windows.hann(signal.size, sym=False)
    amplitude = 2.0 * np.abs(np.fft.rfft((envelope - envelope.mean()) * window)) / np.sum(window)
    return np.asarray(np.fft.rfftfreq(signal.size, 1.0 / rate), dtype=np.float64), amplitude

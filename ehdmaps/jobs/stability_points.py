"""Operating points over the whole range that inputs may declare, and a decade beyond: contact, oil, load, speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from ehdmaps.errors import InputError
from ehdmaps.jobs.axes import LOAD_AXIS, SPEED_AXIS
from ehdmaps.jobs.job import Job
from ehdmaps.jobs.sampling import SamplePoint, log_uniform
from ehdmaps.jobs.solids import FE_APPROACHES
from ehdmaps.physics.approach import STRUCTURAL_LAWS
from ehdmaps.physics.contact import OIL_TEMPERATURES, LineContact
from ehdmaps.physics.lubricant import DENSITY_LAWS, LUBRICANTS, Lubricant
from ehdmaps.physics.solids import Material
from ehdmaps.physics.viscosity import PRESSURE_LAWS

DECADE = 10.0
"""Factor by which every range is left at both ends."""

SLOWEST = 1e-9
"""Entrainment speed from which speeds above zero are drawn [m/s]."""

BEYOND = 36.0
"""Temperature by which the range of oils is left at both ends, a tenth of it [K]."""

_LENGTHS, _MODULI = (1e-5, 100.0), (1e8, 2e12)
_VISCOSITIES, _COEFFICIENTS, _DENSITIES = (1e-5, 1e3), (1e-10, 1e-7), (300.0, 3000.0)
_CONDUCTIVITIES = (1e-2, 10.0)
"""What a job file may state of contacts [m], solids [Pa] and oils [Pa s, 1/Pa, kg/m3, W/(m K)]."""


class WildPoint(NamedTuple):
    """A point with its oil, and the words that repeat it."""

    point: SamplePoint
    oil: Lubricant
    label: str


def wild_point(job: Job, seed: int, number: int) -> WildPoint:
    """Draw a point; the same one for the same arguments.

    Every second point has a contact and an oil of its own, the others a contact of the job and an oil of the catalogue.

    Parameters
    ----------
    job : Job
        Job with the contacts and the oil.
    seed : int
        Seed of the search.
    number : int
        Number of the point.

    Raises
    ------
    InputError
        If what was drawn is refused.
    """
    rng = np.random.default_rng([seed, number])
    load = log_uniform(rng, LOAD_AXIS.low / DECADE, LOAD_AXIS.high * DECADE)
    speed = 0.0 if rng.random() < 0.02 else log_uniform(rng, SLOWEST, SPEED_AXIS.high * DECADE)
    temperature = float(rng.uniform(OIL_TEMPERATURES[0] - BEYOND, OIL_TEMPERATURES[1] + BEYOND))
    words = f"seed {seed}, number {number}: w = {load:.6g} N/m, u = {speed:.6g} m/s, {temperature:.6g} K"
    try:
        if number % 2:
            contact, oil = own_contact(rng), own_oil(rng)
        else:
            contact = job.contacts[int(rng.integers(len(job.contacts)))]
            oils = (job.lubricant, *map(Lubricant.named, LUBRICANTS))
            oil = oils[int(rng.integers(len(oils)))]
    except InputError as error:
        raise InputError([f"{words}: {problem}" for problem in error.problems]) from error
    words += f", {contact.name} R = {contact.radius:.4g} m, E = {contact.material.youngs_modulus:.3g} Pa, {oil.name}"
    return WildPoint(SamplePoint(contact, load, speed, temperature), oil, words)


def own_contact(rng: np.random.Generator) -> LineContact:
    """Draw a bare contact.

    Raises
    ------
    InputError
        If what was drawn is refused.
    """
    material = Material(_beyond(rng, _MODULI), float(rng.uniform(0.0, 0.499)))
    law = STRUCTURAL_LAWS[int(rng.integers(len(STRUCTURAL_LAWS)))]
    radius, length, depth = (_beyond(rng, _LENGTHS) for _ in range(3))
    approach = log_uniform(rng, *FE_APPROACHES) if law == "fe" else None
    return LineContact("line", radius, material, law, length, depth, approach)


def own_oil(rng: np.random.Generator) -> Lubricant:
    """Draw an oil of any law.

    Raises
    ------
    InputError
        If what was drawn is refused.
    """
    word = list(PRESSURE_LAWS)[int(rng.integers(len(PRESSURE_LAWS)))]
    kind = PRESSURE_LAWS[word]
    numbers: dict[str, float] = {}
    if kind.coefficient == "none":
        numbers = {entry.field: float(rng.uniform(entry.low, entry.high)) for entry in kind.parameters}
    alpha: float | None = None if kind.coefficient == "none" else _beyond(rng, _COEFFICIENTS)
    if word == "barus" and rng.random() < 0.1:
        alpha = 0.0
    return Lubricant.own(
        word,
        numbers,
        viscosity=_beyond(rng, _VISCOSITIES),
        density=_beyond(rng, _DENSITIES),
        density_slope=float(rng.uniform(-5.0, 0.0)) if rng.random() < 0.2 else 0.0,
        density_law=DENSITY_LAWS[int(rng.integers(len(DENSITY_LAWS)))],
        name=word,
        thermal_conductivity=log_uniform(rng, *_CONDUCTIVITIES),
        **({} if alpha is None else {"pressure_viscosity": alpha}),
    )


def _beyond(rng: np.random.Generator, limits: tuple[float, float]) -> float:
    """Draw from a range and a decade around it."""
    return log_uniform(rng, limits[0] / DECADE, limits[1] * DECADE)


class Refusal(NamedTuple):
    """An input that has to be refused: what it is, and what makes something of it."""

    label: str
    make: Callable[[], object]


def refusals(job: Job, use: Callable[[LineContact, Lubricant, float, float, float], object]) -> list[Refusal]:
    """Return inputs that no number may come of: zero, negative, infinite, no number.

    Parameters
    ----------
    job : Job
        Job with a contact and an oil that are good.
    use : callable
        Takes contact, oil, load [N/m], speed [m/s] and temperature [K], and solves.
    """
    contact, oil = job.contacts[0], job.lubricant
    found = []
    for label, value in _WRONG:
        zero = value == 0.0
        found.append(Refusal(f"load {label}", partial(use, contact, oil, value, 1.0, 313.15)))
        found.append(Refusal(f"temperature {label}", partial(use, contact, oil, 1e5, 1.0, value)))
        if not zero:  # a contact at rest is one
            found.append(Refusal(f"speed {label}", partial(use, contact, oil, 1e5, value, 313.15)))
        found += [Refusal(f"{name} {label}", partial(_contact, contact, name, value)) for name in _LENGTH_NAMES]
        found.append(Refusal(f"modulus {label}", partial(Material, value, 0.3)))
        found += [Refusal(f"{name} {label}", partial(_barus, name, value)) for name in ("viscosity", "density")]
        if not zero:  # an isoviscous oil is one
            found.append(Refusal(f"pressure_viscosity {label}", partial(_barus, "pressure_viscosity", value)))
    found += [Refusal(f"Poisson ratio {nu}", partial(Material, 210e9, nu)) for nu in (0.5, -1.0, math.nan, math.inf)]
    return found


_LENGTH_NAMES = ("radius", "roller_length")

_WRONG: tuple[tuple[str, float], ...] = (
    ("zero", 0.0),
    ("below zero", -1.0),
    ("minus infinite", -math.inf),
    ("infinite", math.inf),
    ("no number", math.nan),
)


def _contact(good: LineContact, name: str, value: float) -> LineContact:
    """A contact with a value of its own."""
    values = {"radius": good.radius, "roller_length": 0.015} | {name: value}
    return LineContact("line", values["radius"], good.material, "iso16281", values["roller_length"])


def _barus(name: str, value: float) -> Lubricant:
    """An oil with a value of its own, at a temperature."""
    values = {"viscosity": 0.1, "density": 880.0, "pressure_viscosity": 2e-8} | {name: value}
    oil = Lubricant.barus(
        viscosity=values["viscosity"], density=values["density"], pressure_viscosity=values["pressure_viscosity"]
    )
    oil.at(313.15)
    return oil

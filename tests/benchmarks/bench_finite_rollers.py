"""Crowned and finite rollers: solved films beside slices with films of lines, and beside those of the ellipse.

Run: python -m tests.benchmarks.bench_finite_rollers [ellipses | ends | random]

The inner contact of NU308, FVA 3, 60 degC, 2 m/s. `ellipses` has rollers that are crowned all along, by the depth at
their ends; the ellipse of Hertz is longer than the roller where "b" is above 1. `ends` has profiles with a straight
middle that is rounded towards the ends, by its length and the depth at the ends.

Slices are 41 of ISO/TS 16281, each with the film of a line from the film table; their load per length is that of their
own law. Differences are those of slices, and of the ellipse, from the solved roller [%]: film in the middle, smallest
film, film offset (dry less lubricated approach), dry stiffness, stiffness, damping. "error" is what the solver states
of the smallest film and of the damping, "end" the smallest film over the smallest one across the middle, and its place
over half the length.

`random` solves rollers of 7 to 24 mm with three kinds of profiles, 10 to 400 N/mm, 0.3 to 15 m/s, 30 to 90 degC.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from ehdmaps.arrays import FloatArray
from ehdmaps.jobs.make.table_law import table_map
from ehdmaps.physics.bearing import BEARINGS
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.point.ellipse import Ellipse
from ehdmaps.physics.solids import STEEL, reduced_modulus
from ehdmaps.physics.surface import CrownedProfile, iso_profile
from ehdmaps.point import solve
from ehdmaps.point.finite_roller import AT_THE_END, FiniteRoller, RollerSolution, solve_roller
from mbs.bearings.films import MapFilms
from mbs.bearings.laws import roller_coefficient

GEOMETRY, OIL, SPEED, KELVIN = BEARINGS["NU308"], Lubricant.named("FVA3"), 2.0, 333.15
LENGTH, SLICES, DRY_STEP = GEOMETRY.roller_length, 41, 1e-8
DROPS, LOADS = (1e-6, 5e-6, 20e-6, 60e-6, 200e-6, 600e-6), (100.0, 500.0, 2000.0)
SEED, COUNT = 1, 80
STRAIGHT = ((0.6, 10e-6), (0.9, 10e-6), (0.96, 10e-6), (0.97, 50e-6))


class Numbers(NamedTuple):
    """Numbers of a contact, solved or by slices or an ellipse."""

    central_film: float
    minimum_film: float
    film_offset: float
    dry_stiffness: float
    stiffness: float
    damping: float


class Slices:
    """A contact by slices with films of lines."""

    def __init__(self) -> None:
        speeds, kelvin = (0.9 * SPEED, 1.1 * SPEED), (KELVIN, KELVIN)
        emap = table_map(GEOMETRY, OIL, (1.0, 2e6), speeds, kelvin)
        self._law = emap.law("inner", "clamp").at(SPEED, KELVIN)
        self._films = MapFilms(emap)
        self._places = ((np.arange(SLICES) + 0.5) / SLICES - 0.5) * LENGTH
        self._coefficient = 2.0 ** (10.0 / 9.0) * roller_coefficient(LENGTH, STEEL) / LENGTH

    def numbers(self, profile: Callable[[FloatArray], FloatArray], load: float) -> Numbers:
        """Numbers of a profile under a load."""
        depth, each = profile(self._places), LENGTH / SLICES

        def films(approach: float) -> FloatArray:
            return np.asarray(self._law.evaluate(approach - depth, np.zeros(SLICES))[:3]) * each

        def dry(approach: float) -> float:
            return float(np.sum(np.maximum(approach - depth, 0.0) ** (10.0 / 9.0))) * self._coefficient * each

        with_film = brentq(lambda at: float(np.sum(films(at)[0])) - load, -50e-6, 500e-6, xtol=1e-14)
        without = brentq(lambda at: dry(at) - load, 0.0, 500e-6, xtol=1e-14)
        w, k, c = films(with_film)
        state = self._films.state(0, w / each, SPEED, KELVIN)
        carries = w > 1e-3 * np.max(w)
        return Numbers(
            float(state.central_film[SLICES // 2]),
            float(np.min(state.minimum_film[carries])),
            without - with_film,
            (dry(without + DRY_STEP) - dry(without - DRY_STEP)) / (2.0 * DRY_STEP),
            float(np.sum(k)),
            float(np.sum(c)),
        )


def solved(profile: Callable[[FloatArray], FloatArray], load: float) -> RollerSolution:
    """The roller with its profile."""
    contact = GEOMETRY.contacts(STEEL, "iso16281")[0]
    roller = FiniteRoller(contact.radius, LENGTH, contact.reduced_modulus, profile)
    return solve_roller(roller, OIL, load, SPEED, KELVIN)


def of_ellipse(radius: float, load: float) -> tuple[Numbers | None, float]:
    """The ellipse of a crown, and its half-length over that of the roller."""
    contact = GEOMETRY.contacts(STEEL, "iso16281")[0]
    ellipse = Ellipse(contact.radius, radius, contact.reduced_modulus)
    share = float(ellipse.semi_axes(load)[1]) / (0.5 * LENGTH)
    found = solve(ellipse, OIL, load, SPEED, KELVIN)
    if not found.status.usable:
        return None, share
    dry = float(ellipse.stiffness(load))
    return Numbers(
        found.central_film, found.minimum_film, found.film_offset, dry, found.stiffness, found.damping
    ), share


def line(label: str, found: RollerSolution, others: list[Numbers | None]) -> str:
    """A row: what was solved, and how far others are from it."""
    if not found.status.usable:
        return f"{label}{found.reason}"
    own = Numbers(
        found.central_film, found.minimum_film, found.film_offset, found.dry_stiffness, found.stiffness, found.damping
    )
    end = f"{100.0 * (found.minimum_film / found.middle_film - 1.0):+6.1f} {found.minimum_place / (0.5 * LENGTH):5.2f}"
    text = f"{label}{1e6 * own.central_film:7.4f} {end} {100.0 * found.minimum_film.error:5.1f} "
    text += f"{100.0 * found.damping.error:5.1f} "
    for other in others:
        shares = [math.nan] * 6 if other is None else [100.0 * (b / a - 1.0) for a, b in zip(own, other, strict=True)]
        text += " |" + "".join(f"{share:+7.1f}" for share in shares)
    return text


HEAD = "   film     end place error error   |" + "     hc   hmin offset  k_dry      k      c"


def random_rollers(count: int) -> list[RollerSolution]:
    """Rollers, profiles and points at random."""
    random, found = np.random.default_rng(SEED), []
    for _ in range(count):
        diameter = math.exp(random.uniform(math.log(7e-3), math.log(24e-3)))
        length = diameter * random.uniform(0.9, 1.6)
        radius = diameter * (0.4, 0.6)[random.integers(2)]
        load, speed = np.exp(random.uniform(np.log([1e4, 0.3]), np.log([4e5, 15.0])))
        kelvin, kind = random.uniform(303.15, 363.15), random.integers(3)
        crown = CrownedProfile.of_drop(
            math.exp(random.uniform(math.log(4e-6), math.log(40e-6))),
            length,
            random.uniform(0.5, 0.95) * length if kind == 2 else 0.0,
        )
        profile = crown if kind else partial(iso_profile, roller_diameter=diameter, roller_length=length)
        roller = FiniteRoller(radius, length, reduced_modulus(STEEL, STEEL), profile)
        found.append(solve_roller(roller, OIL, float(load * length), float(speed), float(kelvin)))
    return found


def main(asked: list[str]) -> None:
    """Print all tables, or the one that is asked for."""
    if asked in ([], ["ellipses"]):
        slices = Slices()
        print("crowned all along; slices, then ellipse")
        print(f"{'drop um':>7} {'N':>5} {'GPa':>5} {'b':>5} {HEAD} |{HEAD.partition('|')[2]}")
        for drop in DROPS:
            profile = CrownedProfile.of_drop(drop, LENGTH)
            for load in LOADS:
                found = solved(profile, load)
                ellipse, share = of_ellipse(profile.radius, load)
                label = f"{1e6 * drop:7.0f} {load:5.0f} {1e-9 * found.max_pressure:5.2f} {share:5.2f} "
                print(line(label, found, [slices.numbers(profile, load), ellipse]))
    if asked in ([], ["ends"]):
        slices = Slices()
        print("straight in the middle, rounded towards the ends; slices")
        print(f"{'straight':>8} {'drop um':>7} {'N':>5} {'GPa':>5} {HEAD}")
        for load in LOADS:
            found = solved(lambda y: iso_profile(y, GEOMETRY.roller_diameter, LENGTH), load)
            numbers = slices.numbers(lambda y: iso_profile(y, GEOMETRY.roller_diameter, LENGTH), load)
            print(line(f"{'ISO':>8} {'':7} {load:5.0f} {1e-9 * found.max_pressure:5.2f} ", found, [numbers]))
        for share, drop in STRAIGHT:
            profile = CrownedProfile.of_drop(drop, LENGTH, share * LENGTH)
            for load in LOADS:
                found = solved(profile, load)
                label = f"{share:8.2f} {1e6 * drop:7.0f} {load:5.0f} {1e-9 * found.max_pressure:5.2f} "
                print(line(label, found, [slices.numbers(profile, load)]))
    if asked in ([], ["random"]):
        rollers = random_rollers(COUNT)
        usable = [each for each in rollers if each.status.usable]
        ends = sum(AT_THE_END in each.reason for each in rollers)
        print(f"{len(usable)} of {COUNT} solved; of the others the dry contact of {ends} reaches the end of the roller")
        widths = [each.roller.length / 2.0 / _half(each) for each in usable]
        print(f"length over width {min(widths):.0f} to {max(widths):.0f}, median {np.median(widths):.0f}")
        for name in ("central_film", "minimum_film", "damping"):
            errors = [100.0 * getattr(each, name).error for each in usable]
            print(
                f"stated error of {name}: median {np.median(errors):.1f}, nine of ten {np.percentile(errors, 90):.1f} %"
            )
        print(f"{np.mean([each.solve_seconds for each in rollers]):.2f} s each")


def _half(found: RollerSolution) -> float:
    """Half-width of the contact by the mean load per length."""
    roller = found.roller
    return float(half_width(found.load / roller.length, roller.radius, roller.reduced_modulus))


if __name__ == "__main__":
    main(sys.argv[1:])

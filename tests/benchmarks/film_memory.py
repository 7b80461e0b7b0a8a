"""The contact law with memory beside the film solver: complex stiffness over frequency, and loads over time.

Run: python -m tests.benchmarks.film_memory [--quick]

The numbers of the closed formula of the locked film were fitted with FVA 3. The other oils are two of Roelands' law,
with 12 and 30 1/GPa, with which no number was fitted. "memory" is the law of a map with film compliances at natural
frequencies, "formula" that of a map without.

Over frequency: random single contacts of NU308 and N1014, loads, speeds and temperatures. k and c are those of the
solver in the limit of slow motion, so that nothing but the memory is compared. The error is the largest one of the
complex stiffness, relative to its magnitude, from omega T = 0.01 to 10, where T = sqrt(b^2 + 2 h R)/u.

Over time: the nonlinear film under a load that is prescribed gives the approach; the laws are fed with it. Errors are
those of the load, root mean square, over that of the load's variation. Slow: load at rest plus c times rate, without
tension. Dry: the structure over a film that keeps its thickness. At rest: the law's curve beside the solver's, from 0.4
to 2 times the load. Where the exit of the film would run faster than the surfaces, the film solver ends.
--quick: a quarter of the points over frequency, and three of seven contacts an oil over time.
"""

from __future__ import annotations

import argparse

import numpy as np
from threadpoolctl import threadpool_limits

from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.contact import OperatingPoint
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.solids import STEEL
from tests.cases.film_memory import (
    COURSES,
    FVA3,
    LARGE_COURSES,
    PLACES,
    READ,
    THICK,
    THIN,
    Errors,
    NoSolutionError,
    Oil,
    Response,
    errors,
    law_at,
    response,
    rest_error,
    resting,
)

OILS = {"FVA 3": FVA3, "12 1/GPa": THIN, "30 1/GPa": THICK}
CONTACTS = [c for name in ("NU308", "N1014") for c in BearingGeometry.named(name).contacts(STEEL, "iso16281")]
SEED = 11

STATES = (
    Oil("FVA 3, 40 degC, 1 m/s", FVA3, 313.15, 1.0),
    Oil("FVA 3, 80 degC, 1 m/s", FVA3, 353.15, 1.0),
    Oil("12 1/GPa, 1 m/s", THIN, 313.15, 1.0),
    Oil("30 1/GPa, 0.4 m/s", THICK, 313.15, 0.4),
    Oil("30 1/GPa, 1.5 m/s", THICK, 313.15, 1.5),
)
PARTS = (0.12, 0.3, 0.6, 0.95, 1.3, 2.2, 4.0)
"""Loads over that at the bottom of the damping valley: rigid, transition, valley, elastic."""

QUICK_PARTS = (0.12, 0.6, 2.2)


def responses(oil: Lubricant, count: int) -> list[Response]:
    """Compare random contacts with an oil."""
    rng = np.random.default_rng(SEED)
    found: list[Response] = []
    while len(found) < count:
        contact = CONTACTS[rng.integers(len(CONTACTS))]
        temperature = float(rng.uniform(293.15, 373.15))
        load, speed = float(10 ** rng.uniform(2.5, 5.7)), float(10 ** rng.uniform(-1.0, 1.0))
        found.append(response(contact, oil, OperatingPoint(load, speed, temperature)))
    return found


def over_frequency(count: int) -> None:
    """Print the table of complex stiffness, and its worst points."""
    print("complex stiffness up to omega T = 10, largest error of a contact [%]: median, largest of all contacts")
    heads = f"{'memory':>14s}{'above 5 %':>11s}{'formula':>14s}{'slow':>14s}{'dry':>16s}{'solver':>9s}"
    print(f"{'oil':<10s}{'contacts':>9s}{heads}")
    worst, every = [], []
    for name, oil in OILS.items():
        found = responses(oil, count)
        every += found
        cells = ""
        for law, width, digits in (
            ("memory", 14, "1f"),
            ("formula", 14, "1f"),
            ("slow", 14, "1f"),
            ("dry", 16, "3g"),
        ):
            values = [100.0 * getattr(each, law) for each in found]
            cells += f"{f'{np.median(values):.1f} {max(values):.{digits}}':>{width}s}"
            if law == "memory":
                cells += f"{sum(value > 5.0 for value in values):11d}"
        stated = 100.0 * max(each.stated for each in found)
        print(f"{name:<10s}{count:9d}{cells}{stated:9.2f}", flush=True)
        worst += [(name, each) for each in sorted(found, key=lambda each: -each.memory)[:3]]
    print("law with memory over frequency [%]: median, 95 of 100 contacts, largest")
    wrong = 100.0 * np.array([each.at_places for each in every])
    for column, place in enumerate(PLACES):
        one = wrong[:, column]
        print(f"  omega T {place:4g}: {np.median(one):6.2f} {np.percentile(one, 95.0):6.2f} {one.max():6.2f}")
    print("that error as it is read from the natural frequencies of a map, what is wrong of it [%]: the same")
    read = 100.0 * np.array([each.read for each in every])
    for column, place in enumerate(READ):
        one = read[:, column]
        print(f"  omega T {place:4g}: {np.median(one):6.2f} {np.percentile(one, 95.0):6.2f} {one.max():6.2f}")
    print("worst points of the law with memory")
    for name, each in worst:
        print(f"  {name:<10s} M {each.M:.3g}, L {each.L:.3g}: {100 * each.memory:.1f} % at omega T = {each.worst:.2g}")


def over_time(parts: tuple[float, ...]) -> None:
    """Print the tables of loads over time."""
    print("\nloads over time, rms error over rms variation [%]: memory / slow / dry")
    found: list[tuple[str, str, bool, Errors]] = []
    ended, rest = 0, 0.0
    for oil in STATES:
        at = law_at(oil)
        unit, L = oil.groups
        for part in parts:
            film = resting(oil, oil.load(part))
            rest = max(rest, rest_error(at, film))
            place = f"{oil.name}, M {unit * film.load:.2f}, L {L:.0f}"
            print(place)
            for course in (*COURSES, *LARGE_COURSES):
                try:
                    wrong = errors(at, film.followed(course))
                except NoSolutionError as nothing:
                    print(f"  {nothing}")
                    ended += 1
                    continue
                found.append((place, course.name, course in COURSES, wrong))
                row = " /".join(f"{100.0 * value:7.1f}" for value in (wrong.memory, wrong.slow, wrong.dry))
                print(f"  {course.name:<24s}{row}", flush=True)
    print(f"\n{len(found)} courses, and {ended} on which the film solver has no solution up to the end")
    print(f"at rest law and solver agree within {100.0 * rest:.2f} % of the load")
    print(f"{'':<34s}{'courses':>8s}{'memory':>14s}{'above 5 %':>11s}{'slow':>14s}{'dry':>16s}   (median, largest)")
    for name in OILS:
        for small in (True, False):
            rows = [wrong for place, _, is_small, wrong in found if place.startswith(name) and is_small == small]
            title = f"{name}, {'courses' if small else 'larger amplitudes'}"
            cells = ""
            for law, width, digits in (("memory", 14, "1f"), ("slow", 14, "1f"), ("dry", 16, "3g")):
                values = [100.0 * getattr(wrong, law) for wrong in rows]
                cells += f"{f'{np.median(values):.1f} {max(values):.{digits}}':>{width}s}"
                if law == "memory":
                    cells += f"{sum(value > 5.0 for value in values):11d}"
            print(f"{title:<34s}{len(rows):8d}{cells}")
    print("worst courses of the law with memory")
    for place, name, _, wrong in sorted(found, key=lambda row: -row[3].memory)[:6]:
        print(f"  {place}, {name}: {100.0 * wrong.memory:.1f} %")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer points; one minute instead of three")
    quick = parser.parse_args().quick
    over_frequency(25 if quick else 100)
    over_time(QUICK_PARTS if quick else PARTS)


if __name__ == "__main__":
    with threadpool_limits(1):
        main()

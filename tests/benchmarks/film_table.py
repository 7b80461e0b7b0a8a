"""The film table beside fresh solves of a fine grid and beside the closed formula: errors and times.

Run: python -m tests.benchmarks.film_table [POINTS]

Points at random over the ranges of the shipped jobs, drawn by a seed, of bearings and oils from which the table was not
made. The reference is `reynolds` with density = 14 and inlet_length = 700. c is related to max(c, 0.02 k b/u), in
the damping valley as elsewhere; it is called valley where abs(zeta) < 0.7. "solved" is the share of points that
have no film in the table, or one with a larger error than `SURE`. Solves are kept in a folder where the
environment variable EHDMAPS_KEPT_SOLVES names one.
"""

from __future__ import annotations

import math
import os
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ehdmaps.arrays import BoolArray, FloatArray
from ehdmaps.ehl.solver import ReynoldsSolver
from ehdmaps.physics.bearing import BearingGeometry
from ehdmaps.physics.catalogue import estimate
from ehdmaps.physics.closed_form import FormulaSolver
from ehdmaps.physics.contact import LineContact
from ehdmaps.physics.hertz import half_width
from ehdmaps.physics.lubricant import Lubricant
from ehdmaps.physics.moes import moes_groups, valley_load_number
from ehdmaps.physics.solids import STEEL
from ehdmaps.physics.solution import Status
from ehdmaps.table.file import film_table
from ehdmaps.table.films import TableFilms

REFERENCE = ReynoldsSolver(density=14.0, inlet_length=700.0)
LOADS, SPEEDS, TEMPERATURES = (100.0, 1e6), (0.05, 10.0), (293.15, 393.15)
"""Ranges of the shipped jobs [N/m], [m/s], [K]."""

SURE = 0.05
"""`TableFilms.law_error` above which a film is counted as unsure: some per mille of a stiffness."""

VALLEY = 0.7
"""Distance in ln M from the bottom of the damping valley up to which a point counts as one in it."""

SQUALANE, GLYCOL, THINNEST = "Tait-Doolittle", "glycol, 3 /GPa", "isoviscous"
BESIDE = (SQUALANE, GLYCOL, THINNEST)
"""An oil that bends over pressure as no law of the table does, and two of hardly any piezoviscosity, or none: they are
told, but do not count among all."""

_NUMBERS = ("film_offset", "film_compliance", "loss_compliance", "central_film", "minimum_film", "max_pressure")
_MORE = ("rolling_force", "mass_flow", "wall_stress")


def bearings() -> Mapping[str, tuple[LineContact, ...]]:
    """Contacts of three bearings."""
    geometries = {name: BearingGeometry.named(name) for name in ("NU308", "N1014")}
    geometries["NU206 estimated"] = estimate("NU206")
    return {name: geometry.contacts(STEEL, "iso16281") for name, geometry in geometries.items()}


def oils() -> Mapping[str, Lubricant]:
    """Six oils as in the shipped jobs, and three at the border of the family."""
    return {
        "FVA 3": Lubricant.named("FVA3"),
        "VG 68, so-klaus": Lubricant.roelands(
            density=872.0, viscosity_40=68e-6, viscosity_100=8.7e-6, pressure_viscosity="so-klaus"
        ),
        "VG 320, 26 /GPa": Lubricant.roelands(
            density=870.0, viscosity_40=320e-6, viscosity_100=24e-6, pressure_viscosity=26e-9
        ),
        "PAO VG 32, 13 /GPa": Lubricant.roelands(
            density=870.0, viscosity_40=32e-6, viscosity_100=6e-6, pressure_viscosity=13e-9
        ),
        "Barus 20 /GPa": Lubricant.barus(
            density=870.0, viscosity_40=68e-6, viscosity_100=8.7e-6, pressure_viscosity=20e-9
        ),
        "own FVA law, 22 /GPa": Lubricant.own(
            "fva3",
            {},
            density=880.0,
            viscosity_40=150e-6,
            viscosity_100=15e-6,
            pressure_viscosity_40=22e-9,
            pressure_viscosity_100=16e-9,
        ),
        SQUALANE: Lubricant.own(
            "tait-doolittle",
            {
                "doolittle_slope": 4.5,
                "occupied_fraction": 0.66,
                "occupied_expansion": -1e-3,
                "volume_expansion": 8e-4,
                "bulk_modulus": 9e9,
                "bulk_modulus_decay": 6.5e-3,
                "bulk_modulus_slope": 11.0,
                "reference_temperature": 313.15,
            },
            density=870.0,
            viscosity_40=68e-6,
            viscosity_100=8.7e-6,
        ),
        GLYCOL: Lubricant.roelands(density=1080.0, viscosity_40=46e-6, viscosity_100=12e-6, pressure_viscosity=3e-9),
        THINNEST: Lubricant.roelands(density=870.0, viscosity_40=68e-6, viscosity_100=8.7e-6, pressure_viscosity=0.0),
    }


@dataclass(frozen=True, eq=False)
class Drawn:
    """Points of one contact with one oil, and their solved films, arrays over the points by name."""

    contact: LineContact
    oil: Lubricant
    load: FloatArray
    speed: FloatArray
    temperature: FloatArray
    solved: Mapping[str, FloatArray]


def drawn(contact: LineContact, oil: Lubricant, count: int, seed: int, label: str) -> Drawn:
    """Draw and solve points, or take them as they were kept."""
    random = np.random.default_rng(seed)
    w, u = (np.exp(random.uniform(math.log(ends[0]), math.log(ends[1]), count)) for ends in (LOADS, SPEEDS))
    T = random.uniform(*TEMPERATURES, count)
    folder = os.environ.get("EHDMAPS_KEPT_SOLVES", "")
    kept = Path(folder) / f"{label.replace('/', '_')}_{count}_{seed}.npz"
    if folder and kept.is_file():
        with np.load(kept) as file:
            return Drawn(contact, oil, w, u, T, dict(file))
    started = time.process_time()
    rows = [REFERENCE.line_spectra(contact, oil, (float(w[i]),), float(u[i]), float(T[i]))[0] for i in range(count)]
    solved = {name: np.array([getattr(row.film, name) for row in rows]) for name in (*_NUMBERS, *_MORE)}
    solved |= {
        f"{name}_error": np.array([getattr(row.film, f"{name}_error") for row in rows])
        for name in (*_NUMBERS, "rolling_force", "mass_flow")
    }
    solved["status"] = np.array([int(row.film.status) for row in rows])
    solved["response"] = np.array([row.compliance for row in rows])
    solved["response_error"] = np.array([row.largest_error for row in rows])
    solved["seconds"] = np.array(time.process_time() - started)
    if folder:
        np.savez(kept, **solved)  # type: ignore[arg-type]
    return Drawn(contact, oil, w, u, T, solved)


def all_drawn(count: int) -> list[tuple[str, str, Drawn]]:
    """Points of all bearings and oils, `count` of each contact and oil."""
    found = []
    for i, (bearing, contacts) in enumerate(bearings().items()):
        for j, (name, oil) in enumerate(oils().items()):
            for k, contact in enumerate(contacts):
                label = f"{bearing} {contact.name} {name}"
                found.append((bearing, name, drawn(contact, oil, count, 1000 * i + 100 * j + k, label)))
    return found


@dataclass(frozen=True, eq=False)
class Compared:
    """Errors of read films against solved ones, arrays over usable points.

    Attributes
    ----------
    k, c, film : ndarray
        Relative errors of stiffness, damping (by max(c, 0.02 k b/u)) and film offset.
    valley : ndarray of bool
        Which points lie in the damping valley.
    z : ndarray, shape (n, k)
        Relative errors of the complex stiffness at the natural frequencies.
    covered : dict of str to ndarray of bool
        By number: whether the stated error covers the difference, the solved film's own error taken off.
    formula : ndarray, shape (n, 3)
        By how much the closed formula is wrong, in the order k, c, film.
    unsure : ndarray of bool
        Which points with a solved film have none in the table, or one with a larger error than `SURE`.
    """

    k: FloatArray
    c: FloatArray
    film: FloatArray
    valley: BoolArray
    z: FloatArray
    covered: dict[str, BoolArray]
    formula: FloatArray
    unsure: BoolArray


def compared(points: Drawn, films: TableFilms) -> Compared:
    """Compare read films with solved ones where both have one."""
    contact, solved = points.contact, points.solved
    there = solved["status"] <= int(Status.ASYMPTOTE)
    ok = there & films.usable
    w, u = points.load[ok], points.speed[ok]
    solids = np.array([contact.structural_compliance(float(x)) for x in w])
    half = half_width(w, contact.radius, contact.reduced_modulus)

    def law(compliance: FloatArray, loss: FloatArray) -> tuple[FloatArray, FloatArray]:
        k = 1.0 / (solids + compliance)
        return k, np.maximum(loss * k * k, 0.0)

    k0, c0 = law(solved["film_compliance"][ok], solved["loss_compliance"][ok])
    scale = np.maximum(c0, 0.02 * k0 * half / u)
    film0 = solved["film_offset"][ok]
    k, c = law(films.film_compliance[ok], films.loss_compliance[ok])
    formula = [
        FormulaSolver().solve_line(contact, points.oil, (float(a),), float(b), float(t))[0]
        for a, b, t in zip(w, u, points.temperature[ok], strict=True)
    ]
    kf, cf = law(*(np.array([getattr(f, name) for f in formula]) for name in _NUMBERS[1:3]))
    hf = np.array([f.film_offset for f in formula])
    depth = [_depth(points, int(i)) for i in np.flatnonzero(ok)]
    covered = {}
    for name in (*_NUMBERS, *_MORE):
        value, read = solved[name][ok], getattr(films, name)[ok]
        own = np.abs(solved[f"{name}_error"][ok] * value) if f"{name}_error" in solved else 0.0
        covered[name] = np.abs(read - value) <= films.errors[name][ok] * np.abs(read) + own
    response = solved["response"][ok]
    whole = solids[:, None] + response
    z = np.abs(whole / (solids[:, None] + films.response[ok]) - 1.0)
    own = solved["response_error"][ok] * np.abs(response)
    apart = np.abs(films.response[ok] - response)
    covered["response"] = (apart <= films.errors["response"][ok] * np.abs(films.response[ok]) + own).ravel()
    return Compared(
        np.abs(k / k0 - 1.0),
        np.abs(c - c0) / scale,
        np.abs(films.film_offset[ok] / film0 - 1.0),
        np.abs(np.array(depth)) < VALLEY,
        z,
        covered,
        np.column_stack([np.abs(kf / k0 - 1.0), np.abs(cf - c0) / scale, np.abs(hf / film0 - 1.0)]),
        ~(films.usable & (films.law_error <= SURE))[there],
    )


def _depth(points: Drawn, i: int) -> float:
    """ln M above the bottom of the damping valley."""
    state, contact = points.oil.at(float(points.temperature[i])), points.contact
    alpha = state.pressure_viscosity.pressure_viscosity
    M, L = moes_groups(
        float(points.load[i]), float(points.speed[i]), state.viscosity, alpha, contact.radius, contact.reduced_modulus
    )
    return math.log(M / valley_load_number(L))


def _told(values: FloatArray) -> str:
    """Median, 95 % and largest of errors in per cent."""
    if not values.size:
        return 3 * f"{'-':>10s}"
    values = np.where(np.isfinite(values), values, np.inf)
    return "".join(f"{100.0 * x:10.3g}" for x in (np.median(values), np.quantile(values, 0.95), np.max(values)))


def main(count: int = 62) -> None:
    """Print the table."""
    found: dict[tuple[str, str], list[Compared]] = {}
    solve_seconds = read_seconds = 0.0
    points = usable = both = 0
    for bearing, oil, drawn_points in all_drawn(count):
        table = film_table(drawn_points.oil)
        arguments = drawn_points.contact, drawn_points.oil, drawn_points.load, drawn_points.speed
        table.films(*arguments, drawn_points.temperature, response=True)
        started = time.process_time()
        films = table.films(*arguments, drawn_points.temperature, response=True)
        read_seconds += time.process_time() - started
        solve_seconds += float(drawn_points.solved["seconds"])
        points += films.status.size
        solved = drawn_points.solved["status"] <= int(Status.ASYMPTOTE)
        usable += int(np.count_nonzero(solved))
        both += int(np.count_nonzero(solved & films.usable))
        found.setdefault((bearing, oil), []).append(compared(drawn_points, films))
    print(f"{points} points, {usable} with a solved film, {both} of these in the table")
    head = f"{'median':>10s}{'95 %':>10s}{'largest':>10s}"
    print(f"{'[%]':46s}{'k':^30s}{'c':^30s}{'c in the valley':^30s}{'film':^30s}{'Z at natural frequencies':^30s}")
    print(f"{'bearing, oil':32s}{'n':>6s}{'solved':>8s}" + 5 * head)
    rows = {", ".join(key): value for key, value in found.items()}
    rows["all"] = [one for (_, oil), value in found.items() for one in value if oil not in BESIDE]
    rows |= {f"all, {oil}": [one for key, value in found.items() for one in value if key[1] == oil] for oil in BESIDE}
    for name, parts in rows.items():
        k, c, film, z = (np.concatenate([getattr(p, x).ravel() for p in parts]) for x in ("k", "c", "film", "z"))
        valley = np.concatenate([p.valley for p in parts])
        unsure = 100.0 * np.mean(np.concatenate([p.unsure for p in parts]))
        print(f"{name:32s}{k.size:6d}{unsure:8.1f}" + "".join(map(_told, (k, c, c[valley], film, z))))
    formula = np.concatenate([p.formula for p in rows["all"]])
    valley = np.concatenate([p.valley for p in rows["all"]])
    k, c, film = formula.T
    print(f"{'closed formula, all':32s}{k.size:6d}{'':8s}" + "".join(map(_told, (k, c, c[valley], film))))
    told = ("all", *(f"all, {oil}" for oil in BESIDE))
    print(f"{'stated errors cover [%]:':24s}" + "".join(f"{name:>22s}" for name in told))
    for name in rows["all"][0].covered:
        shares = [100.0 * np.mean(np.concatenate([p.covered[name] for p in rows[key]])) for key in told]
        print(f"  {name:22s}" + "".join(f"{share:22.1f}" for share in shares))
    print(f"time a point: table {1e6 * read_seconds / points:.0f} us, solved {1e6 * solve_seconds / points:.0f} us")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))

"""Load and pressure over the length of a roller by four methods, in words."""

from __future__ import annotations

import numpy as np

from ehdmaps.arrays import FloatArray
from tests.finite_length.compare import SLICES, LengthComparison, mesh_change
from tests.finite_length.reference import LengthReference

_PLACES = 11


def length_text(reference: LengthReference, cases: list[LengthComparison]) -> list[str]:
    """Lines about all cases of a bearing.

    Parameters
    ----------
    reference : LengthReference
        The finite elements.
    cases : list of LengthComparison
        Cases of the reference beside the other solutions.
    """
    check = reference.check
    by_calculix = f"; CalculiX finds {check['load_by_calculix'] / check['load']:.2%} of a load" if check else ""
    lines = [
        f"{reference.bearing}: a roller with plane end faces on its inner raceway, which goes on beyond the ends; dry",
        f"  finite elements: {max(reference.unknowns.values())} unknowns; loads change by {mesh_change(reference):.1%} "
        f"of the mean from the mesh before{by_calculix}",
        f"  in three dimensions: half spaces with free end faces; slices: {SLICES}, law half_space of the same bodies",
    ]
    for entry in cases:
        lines += _case(entry)
    return lines


def _case(entry: LengthComparison) -> list[str]:
    """One case."""
    case = entry.case
    half = 0.5 * float(np.ptp(case.places))
    ends = (-1.0, 1.0) if case.moment else (0.0, 1.0)
    places = np.linspace(*ends, _PLACES) * half * 0.975
    tilted = f", tilting moment {case.moment:.3g} N m" if case.moment else ""
    ways = (
        ("finite elements", case.places, case.load_per_length, case),
        ("in three dimensions", case.places, entry.load_per_length, entry.solution),
        ("coupled slices", entry.coupled.places, entry.coupled.load_per_length, entry.coupled),
        ("slices on their own", entry.alone.places, entry.alone.load_per_length, entry.alone),
    )
    lines = [
        "",
        f"profile {case.profile}, {case.load:.5g} N{tilted}",
        f"  {'':20s} {'approach':>9s} {'tilt':>7s}   load per length, N/mm, at y, mm",
        f"  {'':20s} {'um':>9s} {'mrad':>7s} " + "".join(f"{1e3 * place:8.2f}" for place in places),
    ]
    for name, at, loads, solved in ways:
        lines.append(
            f"  {name:20s} {1e6 * solved.approach:9.3f} {_clean(1e3 * solved.tilt):7.3f} "
            + "".join(f"{1e-3 * load:8.1f}" for load in np.interp(places, at, loads))
        )
    for name, pressures in (("finite elements", case.peak_pressure), ("in three dimensions", entry.peak_pressure)):
        lines.append(
            f"  {name:20s} {'pressure, GPa':>17s} "
            + "".join(f"{1e-9 * value:8.3f}" for value in np.interp(places, case.places, pressures))
        )
    edge = f", {entry.edge_error:.1%} within a half-width of the end" if entry.edge_error else ""
    lines.append(
        f"  in three dimensions against finite elements: load per length within {entry.load_error:.1%}{edge}; largest "
        f"pressure {_signed(entry.pressure_error)}"
    )
    off = [f"{name} {_apart(case.places, case.load_per_length, at, loads):.1%}" for name, at, loads, _ in ways[2:]]
    lines.append(f"  largest difference of slices over the mean, but for the one at each end: {', '.join(off)}")
    return lines


def _apart(places: FloatArray, loads: FloatArray, at: FloatArray, other: FloatArray) -> float:
    """Largest difference of slices from loads at nodes, over their mean; without the slices at both ends."""
    largest = np.abs(other - np.interp(at, places, loads))[1:-1].max()
    return float(largest / (np.trapezoid(loads, places) / np.ptp(places)))


def _clean(value: float) -> float:
    """A number that is not printed as -0."""
    return value if abs(value) > 1e-6 else 0.0


def _signed(share: float) -> str:
    """A share with its sign."""
    return f"{share:+.1%}".replace("-0.0%", "+0.0%")

"""Result of an identification in words: a table of unknowns with their bands, what is not told apart, a plan."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ehdmaps.units import written
from mbs.identification.explained import DAMPER, FILMS
from mbs.identification.found import Identified
from mbs.identification.free import Free
from mbs.identification.planning import Step
from mbs.output.band_text import deserved

_WEAK = 0.05
"""Part of a band below which an assumption is not named."""

_NAMED = 3
"""Assumptions that are named beside an unknown, at most."""


def found_lines(found: Identified) -> list[str]:
    """Table of what was found, a line each, and what is to be said of it.

    Parameters
    ----------
    found : Identified
        The result.
    """
    fit, sure = found.fit, found.certainty
    wide = max(len(one.name) for one in found.free)
    lines = [f"  {'unknown':{wide}s}  {'found':>10s}  {'band':24s} {'noise':>9s}  {'scene':>9s}  unit     decided by"]
    ends = found.bands
    for k, one in enumerate(found.free):
        value, low, high = (one.display.value(x) for x in (fit.values[k], ends[0, k], ends[1, k]))
        side = max(min(value - low, high - value), 0.1 * max(value - low, high - value))
        noise = abs(one.display.factor) * sure.deviation[k] * (fit.values[k] if one.log else 1.0)
        bounds = f"{deserved(low, side)} to {deserved(high, side)}"
        lines.append(
            f"  {one.name:{wide}s}  {deserved(value, side):>10s}  {bounds:24s} {2.0 * noise:9.2g}  "
            f"{written(one.display.value(one.start)):>9s}  {one.display.unit or '1':7s}  {_decided(found, k)}"
        )
    stands = f"{fit.agreed} of {len(fit.costs)} fits from the best starts end there"
    lines.append(f"  chi2 {fit.chi2:.3g} over {fit.count} values (1: noise alone); {stands}")
    lines += [f"  at the end of its range, and so no result: {name}" for name in found.at_bounds]
    contradicted = [one.name for one in sure.trials if one.left == 0.0]
    if contradicted:
        lines.append(f"  contradicted by the data, and in no band: {', '.join(contradicted)} other than assumed")
    lines += [f"  not in the bands: {words}" for words in sure.lost]
    return lines + law_lines(found)


def law_lines(found: Identified) -> list[str]:
    """Lines on whether films or a constant damper explain what was measured."""
    other = found.other
    if other is None:
        return []
    numbers = f"chi2 {other.films:.3g} with films, {other.damper:.3g} with a damper of {1e6 * other.time:.3g} us"
    if other.explained_by == FILMS:
        return [f"  damping is explained by films ({numbers})"]
    if other.explained_by == DAMPER:
        return [
            f"  warning: damping is explained by a constant damper and not by films ({numbers}): fit --law hertz:TIME"
        ]
    return [f"  films or a constant damper: not told ({numbers})"]


def _decided(found: Identified, place: int) -> str:
    """Name what decides the band of an unknown."""
    sure = found.certainty
    total = max(float(sure.rise[place]), float(sure.fall[place]), 1e-300)
    parts = [(max(float(one.rise[place]), float(one.fall[place])) / total, one.name) for one in sure.trials]
    named = [name for part, name in sorted(parts, reverse=True) if part > _WEAK][:_NAMED]
    return ", ".join(named) or "noise"


def apart_lines(found: Identified, told: Step | None) -> list[str]:
    """Lines on unknowns that are not told apart, and what would tell.

    Parameters
    ----------
    found : Identified
        The result.
    told : Step or None
        The one channel more that tells best.
    """
    names = [one.name for one in found.free]
    untold = found.certainty.untold(found.fit.question.width)
    lines = [f"  not told by what was measured: {', '.join(names[k] for k in untold)}"] if untold else []
    for group in found.certainty.groups():
        size = np.abs(found.certainty.correlation[np.ix_(group, group)])
        np.fill_diagonal(size, 0.0)
        lines.append(
            f"  not told apart: {', '.join(names[k] for k in group)} (correlation up to {float(size.max()):.3f})"
        )
    if told is not None:
        i, j, left = told.closest
        lines.append(
            f"  would be told by: {told.channel.text}; then {names[i]} and {names[j]} are closest, at {abs(left):.2f}"
        )
    return lines


def plan_lines(free: Sequence[Free], steps: Sequence[Step]) -> list[str]:
    """Lines of a plan: what is measured, one channel after the other, and what is then known by noise alone.

    Parameters
    ----------
    free : sequence of Free
        Unknowns of the machine.
    steps : sequence of Step
        The plan.
    """
    lines = ["  deviations by noise of 2 % and 1 % of the median of each channel; whole bands are wider"]
    for n, step in enumerate(steps, start=1):
        i, j, closest = step.closest
        told = "told apart" if abs(closest) < 0.9 else "not told apart"
        pair = f"; closest {free[i].name}, {free[j].name} {closest:+.2f}: {told}" if len(free) > 1 else ""
        lines.append(f"  {n}. {step.channel.text}{pair}")
        lines.append(
            "     " + ", ".join(_known(one, float(size)) for one, size in zip(free, step.deviation, strict=True))
        )
    return lines


def _known(one: Free, deviation: float) -> str:
    """Deviation of an unknown in words."""
    if one.log:
        return f"{one.name} +-{100.0 * math.expm1(min(deviation, 5.0)):.2g} %"
    return f"{one.name} +-{abs(one.display.factor) * deviation:.2g} {one.display.unit}"

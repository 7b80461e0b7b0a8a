"""Identification against twins whose values are hidden: starts, noise, wrong assumptions, laws, what cannot be told.

    python -m tests.benchmarks.identify_twins [--draws 30] [--only starts|noise|wrong|law|apart]

Twins are of the product's own models: they show what the search and the bands do, and nothing about measured machines.
"""

from __future__ import annotations

import argparse
import dataclasses
import time

import numpy as np

from mbs.identification.certainty import certainty, covariance
from mbs.identification.explained import damper
from mbs.identification.search import Fit, Question, jacobian_at, search
from mbs.scene.changes import with_loads
from tests.cases.identify_twins import Twin, balls, rollers

TWINS = {"rollers": (rollers, (1000.0, 4000.0), 2500.0), "balls": (balls, (3000.0, 6000.0), 2000.0)}
FREQUENCIES = 8.0


def _responses(twin: Twin, name: str, seed: int):
    _, speeds, highest = TWINS[name]
    return twin.responses(speeds, np.arange(20.0, highest, FREQUENCIES), np.random.default_rng(seed))


def starts(name: str, twin: Twin) -> None:
    """Far starts, errors, processor time."""
    began = time.process_time()
    fit = search(twin.question(_responses(twin, name, 1)), kept=5, seed=1)
    seconds = time.process_time() - began
    off = np.array([one.coordinate(v) for one, v in zip(twin.free, fit.values, strict=True)]) - twin.truth
    print(f"{name}: {fit.agreed} of {len(fit.costs)} starts end in one minimum, chi2 {fit.chi2:.3f}, {seconds:.0f} s")
    for one, value, by in zip(twin.free, fit.values, off, strict=True):
        error = f"{100.0 * by:+.2f} %" if one.log else f"{one.display.factor * by:+.3g} {one.display.unit}"
        print(f"    {one.name:25s} {one.display.text(value)}  off {error}")


def _near(question: Question, twin: Twin, solved: np.ndarray, jacobian: np.ndarray) -> Fit:
    """The fit from the truth, by Gauss-Newton steps with one Jacobian."""
    parts = (twin.truth - question.low) / question.width
    for _ in range(4):
        parts = np.clip(parts - solved @ question.residuals(parts), 0.0, 1.0)
    return Fit(question, parts, question.residuals(parts), jacobian, (0.0,), 1)


def noise(name: str, twin: Twin, draws: int) -> None:
    """How often two deviations hold."""
    question = twin.question(_responses(twin, name, 99))
    _, jacobian = jacobian_at(question, (twin.truth - question.low) / question.width)
    solved = np.linalg.pinv(jacobian)
    deviation, _ = covariance(jacobian, question.width)
    off, chi2 = [], []
    for draw in range(draws):
        fit = _near(twin.question(_responses(twin, name, 100 + draw)), twin, solved, jacobian)
        off.append((question.coordinates(fit.parts) - twin.truth) / deviation)
        chi2.append(fit.chi2)
    inside = np.abs(np.array(off)) < 2.0
    print(
        f"{name}: {100.0 * inside.mean():.1f} % of {inside.size} within two deviations, least of an unknown "
        f"{100.0 * inside.mean(axis=0).min():.0f} %; rms {np.sqrt(np.mean(np.square(off))):.2f}; "
        f"chi2 {np.mean(chi2):.3f}"
    )


def wrong(name: str, twin: Twin, draws: int) -> None:
    """Whether whole bands hold with loads that are 5 % wrong."""
    held = []
    for draw in range(max(draws // 10, 1)):
        for factor in (0.95, 1.05):
            other = dataclasses.replace(twin, scene=with_loads(twin.scene, factor))
            question = twin.question(_responses(other, name, 300 + draw))
            parts = (twin.truth - question.low) / question.width
            for _ in range(3):
                residuals, jacobian = jacobian_at(question, parts)
                parts = np.clip(parts - np.linalg.pinv(jacobian) @ residuals, 0.0, 1.0)
            residuals, jacobian = jacobian_at(question, parts)
            sure = certainty(Fit(question, parts, residuals, jacobian, (0.0,), 1))
            off = twin.truth - question.coordinates(parts)
            held.append(np.where(off > 0.0, off <= sure.rise, -off <= sure.fall))
    inside = np.array(held)
    print(f"{name}: loads 5 % off, whole bands hold {100.0 * inside.mean():.1f} % of {inside.size} values")


def law(name: str, twin: Twin) -> None:
    """Which law is named."""
    for truth in ("", "hertz:1.25e-05 s"):
        other = dataclasses.replace(twin, law=truth)
        question = twin.question(_responses(other, name, 6))
        fit = search(question, starts=4, kept=2)
        told = damper(fit)
        both = f"chi2 films {told.films:.2f}, damper {told.damper:.2f}"
        print(f"{name}: truth {truth or 'films'}: {told.explained_by}; {both}")


def apart(name: str, twin: Twin) -> None:
    """Frequencies alone, at one speed and at three."""
    speeds = TWINS[name][1][-1]
    for at in ([speeds], [0.25 * speeds, 0.5 * speeds, speeds]):
        near = np.array([200.0, 450.0, 1000.0, 1500.0])
        question = twin.question(twin.modes(at, near, np.random.default_rng(3)))
        parts = (twin.truth - question.low) / question.width
        _, jacobian = jacobian_at(question, parts)
        deviation, correlation = covariance(jacobian, question.width)
        np.fill_diagonal(correlation, 0.0)
        print(
            f"{name}: frequencies at {', '.join(f'{x:g}' for x in at)} rpm: correlation up to "
            f"{np.abs(correlation).max():.3f}; deviations "
            + ", ".join(f"{one.name} {d:.2g}" for one, d in zip(twin.free, deviation, strict=True))
        )


def main() -> None:
    """Run what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=30)
    parser.add_argument("--only")
    asked = parser.parse_args()
    for name, (make, _, _) in TWINS.items():
        twin = make()
        if asked.only in (None, "starts"):
            starts(name, twin)
        if asked.only in (None, "noise"):
            noise(name, twin, asked.draws)
        if asked.only in (None, "wrong"):
            wrong(name, twin, asked.draws)
        if asked.only in (None, "law"):
            law(name, twin)
        if asked.only in (None, "apart"):
            apart(name, twin)


if __name__ == "__main__":
    main()

"""`ehdmaps export --to modelica`, compiled and simulated by rumoca.

`python -m tests.benchmarks.modelica_export` does the same with the whole map, more rates and tighter tolerances.
"""

from __future__ import annotations

import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ehdmaps
from ehdmaps.jobs.cli import main
from tests.cases.modelica_text import functions

rumoca = pytest.importorskip("rumoca", reason="rumoca is a dependency of the tests alone, and has no wheel everywhere")

RATE, BELOW = -1e-4, 2e-6
"""Of the approach [m/s], and how far below zero it begins [m]."""

SWEEP = f"""
  model Sweep
    Real place(start = 0.0, fixed = true);
    Real approach;
    Real w;
    Real k;
    Real c;
    Real dw;
    Real dk;
    Real dc;
  equation
    der(place) = 1.0;
    approach = -{BELOW} + (Table.highestApproach + {BELOW}) * place;
    (w, k, c) = force(approach, {RATE});
    (dw, dk, dc) = forceDerivative(approach, {RATE}, 1e-3, 1.0);
  end Sweep;
"""


@pytest.mark.slow
def test_rumoca_reads_the_package(small_map, tmp_path):
    """Law and derivative are those of Python: 1e-12, round-off. The example is that of DOP853 with the law in Python.

    The tolerance of rumoca, 1e-8 a step, leaves 1e-5 of what the mass moves.
    """
    file = tmp_path / "a.mo"
    at = ("--speed", "0.7 m/s", "--temperature", "30 degC")
    assert main(["export", small_map, "--to", "modelica", *at, "-o", str(file)]) == 0
    text, law = file.read_text(), ehdmaps.open_map(small_map).law("series").at(0.7, 303.15)
    end = text.rindex("end EhdContact;")
    session, settings = rumoca.Session(), rumoca.SimConfig(rtol=1e-8, atol=1e-14)
    sweep = session.loads(text[:end] + SWEEP + text[end:], model="EhdContact.Sweep").simulate(t=(0, 0.99), dt=0.11)
    approach = np.array(sweep["approach"])
    assert approach.size == 10
    derivative = functions(text)["forceDerivative"]
    rates = np.array([derivative(place, RATE, 1e-3, 1.0) for place in approach.tolist()]).T
    for name, wanted in zip(("w", "k", "c", "dw", "dk", "dc"), [*law(approach, RATE), *rates], strict=True):
        np.testing.assert_allclose(np.array(sweep[name]), wanted, rtol=1e-12, atol=1e-12 * np.max(np.abs(wanted)))

    mass, load, begin = (
        float(re.findall(pattern, text)[0])
        for pattern in (r"mass\(.*\) = (\S+) ", r"Real load\(.*\) = (\S+);", r"start = (\S+), fixed")
    )
    example = rumoca.Session().loads(text, model="EhdContact.Example")
    found = example.simulate(t=(0, 2e-3), dt=1e-4, config=settings)
    solved = solve_ivp(
        lambda t, y: [y[1], (load - law(y[0], y[1])[0]) / mass], (0.0, 2e-3), [begin, 0.0],
        method="DOP853", rtol=1e-11, atol=1e-18, t_eval=np.array(found.time),
    ).y[0]  # fmt: skip
    assert np.max(np.abs(np.array(found["approach"]) - solved)) < 1e-5 * np.ptp(solved)


@pytest.mark.slow
def test_rumoca_compiles_films_with_memory(small_map, tmp_path):
    """The example with memory is a balanced model; `tests.benchmarks.modelica_export` runs it."""
    file = tmp_path / "a.mo"
    at = ("--speed", "0.7 m/s", "--temperature", "30 degC", "--films", "memory")
    assert main(["export", small_map, "--to", "modelica", *at, "-o", str(file)]) == 0
    assert rumoca.Session().loads(file.read_text(), model="EhdContact.ExampleMemory")

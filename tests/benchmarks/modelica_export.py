"""A map of NU308 in Modelica: `ehdmaps export --to modelica`, compiled and simulated by rumoca.

python -m venv RUMOCA && RUMOCA/bin/pip install "rumoca>=0.10.2,<0.11"
python -m tests.benchmarks.modelica_export nu308.nc RUMOCA/bin/python

rumoca takes some seconds for each simulation of the table: `tests/system/test_export_modelica_read.py` makes two short
ones. Here the law is compared over the whole table at three rates, its derivative in time with the statements of the
package run by Python, which the unit tests compare with difference quotients, the examples with DOP853 on the law in
Python and with steps of its films, and an approach above the map has to stop the simulation.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

import ehdmaps
from ehdmaps.jobs.cli import main as export
from tests.cases.modelica_text import functions

SPEED, TEMPERATURE = 1.7, 313.15
RATES = (0.0, 1e-3, -1.0)
"""Of the approach [m/s]: at rest, together, and parting so fast that the contact cannot follow."""

FILMS = ("--films", "memory")
STEPS = 8
"""Steps of films in Python between two outputs of the example with memory."""

SWEEP = """
  model Sweep
    parameter Real rate = 0.0;
    Real place(start = 0.0, fixed = true);
    Real w;
    Real k;
    Real c;
    Real dw;
    Real dk;
    Real dc;
  equation
    der(place) = 1.0;
    (w, k, c) = force(-2e-6 + (Table.highestApproach + 2e-6) * place, rate);
    (dw, dk, dc) = forceDerivative(-2e-6 + (Table.highestApproach + 2e-6) * place, rate, 1e-3, 1.0);
  end Sweep;
"""

PROGRAM = """
import json, sys, rumoca
text, runs = json.load(sys.stdin)
found = []
for model, end, step, values in runs:
    try:
        settings = rumoca.SimConfig(rtol=1e-10, atol=1e-14)
        compiled = rumoca.Session().loads(text, model="EhdContact." + model)
        result = compiled.simulate(t=(0, end), dt=step, config=settings, params=values)
        found.append({name: [float(x) for x in result[name]] for name in result.names} | {
            "time": [float(x) for x in result.time]})
    except rumoca.RumocaError as error:
        found.append(str(error))
json.dump(found, sys.stdout)
"""


def main() -> None:
    """Print the differences."""
    parser = argparse.ArgumentParser(description="Modelica export of a map beside the law in Python.")
    parser.add_argument("map", help="map of the NU308, by `ehdmaps generate nu308`")
    parser.add_argument("python", help="of an environment with rumoca")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "law.mo"
        at = ("--speed", f"{SPEED} m/s", "--temperature", f"{TEMPERATURE} K")
        assert export(["export", given.map, "--to", "modelica", *at, *FILMS, "-o", str(file)]) == 0
        text = file.read_text()
    end = text.rindex("end EhdContact;")
    runs = [
        *(("Sweep", 0.999, 0.003, {"rate": rate}) for rate in RATES),
        ("Sweep", 1.2, 0.1, {}),
        ("ExampleMemory", 1e-3, 2e-6, {}),
        ("Example", 0.01, 1e-4, {}),
    ]
    asked = json.dumps([text[:end] + SWEEP + text[end:], runs])
    done = subprocess.run([given.python, "-c", PROGRAM], input=asked, capture_output=True, text=True, check=True)
    *sweeps, above, relaxing, example = json.loads(done.stdout)
    law = ehdmaps.open_map(given.map).law("series").at(SPEED, TEMPERATURE)
    derivative = functions(text)["forceDerivative"]
    (highest,) = (float(x) for x in re.findall(r"highestApproach.* = (\S+) ", text))
    for rate, found in zip(RATES, sweeps, strict=True):
        approaches = -2e-6 + (highest + 2e-6) * np.array(found["place"])
        derivatives = np.array([derivative(approach, rate, 1e-3, 1.0) for approach in approaches.tolist()]).T
        expected = [*law(approaches, rate), *derivatives]
        shown = []
        for name, values in zip(("w", "k", "c", "dw", "dk", "dc"), expected, strict=True):
            differences = np.abs(np.array(found[name]) - values)
            shown.append(f"{name} {np.max(differences / np.maximum(np.abs(values), 1e-12 * np.abs(values).max())):.1e}")
        print(f"rate {rate:g} m/s, {len(found['w'])} places: largest relative differences {', '.join(shown)}")
    assert isinstance(above, str) and "above the map" in above, above
    print(f"above the map: {above}")
    mass, load, start = (
        float(re.findall(pattern, text)[0])
        for pattern in (r"mass\(.*\) = (\S+) ", r"Real load\(.*\) = (\S+);", r"start = (\S+), fixed")
    )
    solved = solve_ivp(
        lambda t, y: [y[1], (load - law(y[0], y[1])[0]) / mass],
        (0.0, 0.01),
        [start, 0.0],
        method="DOP853",
        rtol=1e-12,
        atol=1e-18,
        t_eval=example["time"],
    )
    difference = np.abs(np.array(example["approach"]) - solved.y[0])
    relative, swing = float(np.max(difference / solved.y[0])), float(np.ptp(solved.y[0]))
    print(f"example over 10 ms: {relative:.1e} of the approach, {difference.max() / swing:.1e} of its change")
    memory, path = law.memory, CubicSpline(relaxing["time"], relaxing["approach"])
    film, loads = memory.settled(path(0.0)), [relaxing["w"][0]]
    each = (relaxing["time"][1] - relaxing["time"][0]) / STEPS
    for index in range(1, STEPS * (len(relaxing["time"]) - 1) + 1):
        load, _, film = memory.advance(film, path(index * each), each)
        loads.append(float(load))
    departs = np.abs(np.array(relaxing["w"]) - loads[::STEPS]).max() / np.ptp(relaxing["w"])
    print(
        f"example with memory over 1 ms: the load departs from steps of {1e6 * each:g} us by {departs:.1e} of its swing"
    )


if __name__ == "__main__":
    main()

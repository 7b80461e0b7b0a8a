"""`ehdmaps export --to modelica`: the numbers of the package are those of the law, and nothing else is written."""

from __future__ import annotations

import re

import numpy as np
import pytest

import ehdmaps
from ehdmaps.jobs.cli import main
from ehdmaps.jobs.make.generate import generate
from ehdmaps.jobs.reader import parse_job
from ehdmaps.physics.closed_form import FormulaSolver
from tests.cases.jobs import SMALL
from tests.cases.modelica_text import functions

AT = ("--speed", "0.7 m/s", "--temperature", "30 degC")


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("modelica") / "a.nc"
    generate(parse_job(SMALL, 'x"; end EhdContact; é', "map.toml"), path, workers=1, solver=FormulaSolver())
    return path


def number(text, name):
    return float(re.findall(rf"constant \w+ {name}(?:\(.*?\))? = (\S+?)[; ]", text)[0])


def test_the_table_gives_the_law(path, tmp_path, capsys):
    """The cubics by numpy, as a second reader of the text: 1e-12, round-off."""
    assert main(["export", str(path), "--to", "modelica", *AT, "-o", str(tmp_path / "a.mo")]) == 0
    text = (tmp_path / "a.mo").read_bytes().decode("ascii")
    assert "annotation(derivative = forceDerivative, smoothOrder = 1)" in text
    assert "contact: series, entrainment speed 0.7 m/s, temperature 30 degC" in text
    table = text.split("cubic[")[1].split("{\n")[1].split('"')[0]
    cubics = np.array([row.split(",") for row in re.findall(r"\{([^{}]+)\}", table)], dtype=float)
    assert len(cubics) == number(text, "cells")
    highest = number(text, "highestApproach")
    approach = np.linspace(-1e-6, highest, 400)
    s = np.arcsinh((approach - number(text, "offset")) * number(text, "inverseScale"))
    x = np.clip((s - number(text, "start")) * number(text, "step"), 0.0, len(cubics))
    cell = np.minimum(x.astype(int), len(cubics) - 1)
    t = (x - cell)[:, None] ** np.arange(4)
    g, log_ratio = (np.sum(cubics[cell, first : first + 4] * t, axis=1) for first in (0, 4))
    load = np.maximum(g, 0.0) ** 3
    w, _, c = ehdmaps.open_map(path).law("series").at(0.7, 303.15)(approach, 0.0)
    np.testing.assert_allclose(load, w, rtol=1e-12, atol=1e-12 * w.max())
    np.testing.assert_allclose(load * np.exp(log_ratio), c, rtol=1e-12, atol=1e-12 * c.max())
    assert w[-1] == pytest.approx(1e6, rel=1e-9), "the table ends where the map ends"


@pytest.fixture(scope="module")
def both(path, tmp_path_factory):
    """Functions of the package, its law, and approaches from below lift-off to the end of the map."""
    file = tmp_path_factory.mktemp("package") / "a.mo"
    assert main(["export", str(path), "--to", "modelica", *AT, "-o", str(file)]) == 0
    text = file.read_text()
    law = ehdmaps.open_map(path).law("series").at(0.7, 303.15)
    return functions(text), law, np.linspace(-4e-6, 0.999 * number(text, "highestApproach"), 60)


RATES = (0.0, 1e-3, -1e-4, -1.0)
"""At rest, together, slowly apart, and so fast that the contact cannot follow, which is another branch [m/s]."""


def test_the_functions_give_the_law(both):
    """The statements of the package, run: 1e-12, round-off; above the map they refuse."""
    package, law, approaches = both
    for rate in RATES:
        found = np.array([package["force"](approach, rate) for approach in approaches])
        for values, wanted in zip(found.T, law(approaches, rate), strict=True):
            np.testing.assert_allclose(values, wanted, rtol=1e-12, atol=1e-12 * np.max(wanted))
    with pytest.raises(ValueError, match="approach is above the map"):
        package["force"](1.0, 0.0)


def test_the_derivative(both):
    """By approach and by rate, and along both at once, against central quotients of the law.

    1e-5 is the error of the second order of their steps, 1e-14 of the values the round-off that is in a difference.
    """
    package, law, approaches = both
    for rate in RATES:
        for steps in ((1e-10, 0.0), (0.0, max(1e-3 * abs(rate), 1e-6)), (1e-10, 1e-3 * abs(rate))):
            found = np.array([package["forceDerivative"](approach, rate, *steps) for approach in approaches]).T
            sides = [law(approaches + side * steps[0], rate + side * steps[1]) for side in (1.0, -1.0)]
            for values, above, below in zip(found, *sides, strict=True):
                quotient = 0.5 * (above - below)
                assert np.all(np.abs(values - quotient) <= 1e-5 * np.abs(quotient) + 1e-14 * np.abs(above))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--temperature", "30 degC"), "--speed: missing"),
        (("--speed", "9 m/s", "--temperature", "30 degC"), "--speed: got '9 m/s'"),
        ((*AT, "--contact", "line"), "--contact: got 'line'"),
        ((*AT, "--name", "x; end"), "--name: got 'x; end'"),
        ((*AT, "--name", "model"), "--name: got 'model'"),
        ((*AT, "--name", "forceDerivative"), "--name: got 'forceDerivative'"),
    ],
)
def test_what_is_refused(path, tmp_path, capsys, options, said):
    assert main(["export", str(path), "--to", "modelica", *options, "-o", str(tmp_path / "a.mo")]) == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "a.mo").exists()


def test_films_with_memory(path, tmp_path):
    """Load and rate of the package beside a step of `FilmMemory` of 0.1 ns, of first order in it.

    Films are squeezed and relieved by up to 5 % of their approach.
    """
    file = tmp_path / "a.mo"
    assert main(["export", str(path), "--to", "modelica", *AT, "--films", "memory", "-o", str(file)]) == 0
    film = functions(file.read_text())["film"]
    memory, step = ehdmaps.open_map(path).law("series").at(0.7, 303.15).memory, 1e-10
    for state in np.linspace(0.3e-6, 12e-6, 25).tolist():
        for part in (-0.05, 0.02, 0.05):
            approach = state * (1.0 + part)
            w, rate = film(approach, state)
            load, _, after = memory.advance(memory.settled(state), approach, step)
            assert w == pytest.approx(float(load), rel=1e-5)
            assert rate == pytest.approx((float(after.approach) - state) / step, rel=1e-3)
    assert film(4e-6, 4e-6)[1] == pytest.approx(0.0, abs=1e-7)  # at rest; by what two cubics differ
    gone = memory.table.lift_off - 1e-6
    w, rate = film(gone, gone)
    assert w == 0.0
    assert rate == 0.0
